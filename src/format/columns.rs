//! What stands under what.
//!
//! In a group (lines without a blank one between) these are aligned: the `=` of definitions, the
//! names and braces of objects that stand on one line each, the values of a block's fields, and the
//! fields of equal objects as far as their names are the same. Objects on both sides of a line of
//! comments are no group. The braces of `image`, `camera` and `sampler` are aligned wherever they
//! stand, as they are one group by their meaning. Lines that would have to be filled with many
//! blanks do not share a column.

use super::{
    entries::{Block, Entry, What},
    token_stream::{has_line_end, width},
};
use crate::schema;

/// Parts that differ in their widths by more than this do not share a column.
const SLACK: usize = 20;

/// So many blocks of one kind are a table.
const LEAST_ROWS: usize = 3;

/// Decides the columns of a file's entries.
pub fn align(entries: &mut [Entry<'_>]) {
    keep_rows(entries);
    settings(entries);
    for run in runs(entries, class_in_file) {
        if class_in_file(&entries[run[0]]) == Class::Definition {
            starts(entries, &run);
        }
    }
    for run in runs(entries, class_of_objects) {
        if class_in_file(&entries[run[0]]) == Class::Object {
            objects(entries, &run);
        }
    }
    for entry in entries {
        if let What::Block(block) = &mut entry.what
            && !block.on_one_line
        {
            for run in runs(&block.entries, class_in_block) {
                starts(&mut block.entries, &run);
            }
        }
    }
}

/// Neighbours of one kind that are written on a line each stay so, even if some of them are a
/// little too wide: a table of them is read at a glance.
fn keep_rows(entries: &mut [Entry<'_>]) {
    for rows in entries.chunk_by_mut(|a, b| !b.blank && is_row_beside(a, b)) {
        if rows.len() < LEAST_ROWS {
            continue;
        }
        for entry in rows {
            if let What::Block(block) = &mut entry.what {
                block.on_one_line = true;
            }
        }
    }
}

/// Whether both are blocks of one kind, each written on one line.
fn is_row_beside(a: &Entry<'_>, b: &Entry<'_>) -> bool {
    let is_row = |block: &Block<'_>| block.on_one_line || block.is_nearly_one_line;
    match (block(a), block(b)) {
        (Some(a), Some(b)) => a.kind == b.kind && is_row(a) && is_row(b),
        _ => false,
    }
}

/// What is aligned with what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Class {
    Definition,
    Object,
    Field,
    /// Not aligned, but what stands on both sides of it may be.
    Odd,
    /// Ends a group.
    End,
}

fn class_in_file(entry: &Entry<'_>) -> Class {
    match &entry.what {
        What::Definition(head, rest) => {
            let odd = has_line_end(head) || rest.first().is_some_and(|w| has_line_end(&[*w]));
            match odd || !entry.leading.is_empty() {
                true => Class::Odd,
                false => Class::Definition,
            }
        }
        What::Block(block) if is_setting(block) || !block.on_one_line => Class::End,
        What::Block(block) => match is_plain(entry, block) {
            true => Class::Object,
            false => Class::Odd,
        },
        What::Comments | What::Field(..) => Class::Odd,
    }
}

/// Objects on both sides of a line of comments, or of an object of another layout, are too far
/// apart to pad each other.
fn class_of_objects(entry: &Entry<'_>) -> Class {
    match class_in_file(entry) {
        Class::Odd => Class::End,
        class => class,
    }
}

fn class_in_block(entry: &Entry<'_>) -> Class {
    match entry.what {
        What::Field(..) if entry.leading.is_empty() => Class::Field,
        _ => Class::Odd,
    }
}

fn is_setting(block: &Block<'_>) -> bool {
    schema::block(block.kind).is_some_and(|block| !block.is_object)
}

/// Whether nothing but kind and name stands before a block's `{`.
fn is_plain(entry: &Entry<'_>, block: &Block<'_>) -> bool {
    let words = 1 + usize::from(block.name.is_some());
    entry.leading.is_empty() && block.head.len() == words
}

/// Groups of entries of one class, by their indices.
fn runs(entries: &[Entry<'_>], class: fn(&Entry<'_>) -> Class) -> Vec<Vec<usize>> {
    let mut runs: Vec<Vec<usize>> = Vec::new();
    // The class of the run that can go on.
    let mut open = Class::End;
    for (index, entry) in entries.iter().enumerate() {
        if entry.blank {
            open = Class::End;
        }
        match class(entry) {
            Class::Odd => {}
            Class::End => open = Class::End,
            this => {
                if open != this {
                    runs.push(Vec::new());
                }
                open = this;
                if let Some(run) = runs.last_mut() {
                    run.push(index);
                }
            }
        }
    }
    runs
}

/// The longest parts of a list whose widths differ by no more than the slack. What has no width
/// belongs to any.
pub fn shared(list: &[usize], width: impl Fn(usize) -> Option<usize>) -> Vec<(&[usize], usize)> {
    let mut parts = Vec::new();
    let (mut from, mut least, mut most) = (0, usize::MAX, 0);
    for (index, &item) in list.iter().enumerate() {
        let Some(width) = width(item) else { continue };
        if width.max(most) - width.min(least) > SLACK {
            parts.push((&list[from..index], most));
            (from, least, most) = (index, width, width);
        }
        (least, most) = (least.min(width), most.max(width));
    }
    parts.push((&list[from..], most));
    parts
}

/// Aligns what follows the first part of each entry.
fn starts(entries: &mut [Entry<'_>], run: &[usize]) {
    let width = |entry: &Entry<'_>| match &entry.what {
        What::Definition(head, _) => width(head),
        What::Field(name, _) => name.len(),
        What::Block(block) => width(&block.head),
        What::Comments => 0,
    };
    for (part, most) in shared(run, |index| Some(width(&entries[index]))) {
        for &index in part {
            entries[index].column = most + 1;
        }
    }
}

fn settings(entries: &mut [Entry<'_>]) {
    let is_aligned = |entry: &Entry<'_>| {
        block(entry).is_some_and(|it| is_setting(it) && is_plain(entry, it) && it.name.is_none())
    };
    let aligned = (0..entries.len()).filter(|&index| is_aligned(&entries[index]));
    let aligned: Vec<usize> = aligned.collect();
    starts(entries, &aligned);
}

fn block<'e, 's>(entry: &'e Entry<'s>) -> Option<&'e Block<'s>> {
    match &entry.what {
        What::Block(block) => Some(block),
        _ => None,
    }
}

/// Aligns the names and braces of objects, and the fields of those that are alike.
fn objects(entries: &mut [Entry<'_>], run: &[usize]) {
    let filled = |index: usize| block(&entries[index]).filter(|block| !block.is_empty());
    let parts = shared(run, |index| Some(width(&filled(index)?.head)));
    for (part, _) in parts {
        let blocks = part.iter().filter_map(|&index| block(&entries[index]));
        let named = blocks.clone().filter(|block| block.name.is_some());
        let name_column = named.map(|block| block.kind.len() + 1).max().unwrap_or(0);
        let head = |block: &Block<'_>| match block.name {
            Some(name) => name_column + name.len(),
            None => block.kind.len(),
        };
        let filled = blocks.filter(|block| !block.is_empty());
        let column = filled.map(|block| head(block) + 1).max().unwrap_or(0);
        for &index in part {
            entries[index].column = column;
            if let What::Block(block) = &mut entries[index].what {
                block.name_column = name_column;
            }
        }
        table(entries, part, 0);
    }
}

/// Aligns the field behind the one with an index in objects of which the fields up to that one are
/// aligned, as far as the objects are of one kind and the fields have one name.
fn table(entries: &mut [Entry<'_>], rows: &[usize], field: usize) {
    let alike = |&a: &usize, &b: &usize| {
        let (a, b) = (cell(&entries[a], field), cell(&entries[b], field));
        matches!((a, b), (Some(a), Some(b)) if (a.0, a.1) == (b.0, b.1))
    };
    let groups: Vec<Vec<usize>> = rows.chunk_by(alike).map(<[usize]>::to_vec).collect();
    for group in groups {
        let width = |index: usize| cell(&entries[index], field).map(|(_, _, width)| width);
        if width(group[0]).is_none() {
            continue;
        }
        for (part, most) in shared(&group, width) {
            for &index in part {
                if let What::Block(block) = &mut entries[index].what {
                    block.entries[field].next = most + 2;
                }
            }
            table(entries, part, field + 1);
        }
    }
}

/// The kind of an object, and name and width of a field of it, if another field follows.
fn cell<'a>(entry: &'a Entry<'_>, field: usize) -> Option<(&'a str, &'a str, usize)> {
    let block = block(entry)?;
    block.entries.get(field + 1)?;
    let field = block.entries.get(field)?;
    let What::Field(name, _) = field.what else {
        return None;
    };
    Some((block.kind, name, field.width_in_line()))
}
