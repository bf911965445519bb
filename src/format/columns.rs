//! Aligns the parts of entries, i.e. of definitions, blocks and fields, in columns.
//!
//! A group is a sequence of lines without a blank line. In a group, four things are aligned:
//! - the `=` of definitions,
//! - the names and braces of objects that each stand on one line,
//! - the values of a block's fields,
//! - the fields of objects of one kind, up to the first field whose name differs.
//!
//! A line of comments separates groups of objects. The braces of `image`, `camera` and `sampler`
//! are aligned wherever these blocks stand, since they belong together by their meaning. If the
//! texts before a column differ much in width, the column is split in several, since a single
//! column would need many blanks.

use super::{
    entries::{BlockEntry, Entry, EntryKind},
    token_stream::{has_line_end, width},
};
use crate::schema;

/// Maximum difference, in characters, between the widths of the texts before a shared column, such
/// as the names of fields before their values. A text whose width differs by more starts a new
/// column. Without a limit, one wide text would move the whole column far to the right. The
/// language's reference states the number.
const MAX_WIDTH_DIFFERENCE: usize = 20;

/// Minimum number of consecutive blocks of one kind, each written on one line, that form a table.
/// The blocks of a table stay on one line each even if some are up to a fifth wider than the
/// maximum width of a line. The language's reference states the number.
const MIN_TABLE_ROWS: usize = 3;

/// Sets the columns at which the parts of a file's definitions, blocks and fields are aligned.
pub fn align(entries: &mut [Entry<'_>]) {
    keep_rows(entries);
    settings(entries);
    for run in runs(entries, alignment_in_file) {
        if alignment_in_file(&entries[run[0]]) == Alignment::Definition {
            starts(entries, &run);
        }
    }
    for run in runs(entries, alignment_of_objects) {
        if alignment_in_file(&entries[run[0]]) == Alignment::Object {
            objects(entries, &run);
        }
    }
    for entry in entries {
        if let EntryKind::Block(block) = &mut entry.what
            && !block.on_one_line
        {
            for run in runs(&block.entries, alignment_in_block) {
                starts(&mut block.entries, &run);
            }
        }
    }
}

/// Keeps neighbouring blocks of one kind on one line each, if each was written on one line and
/// there are at least [`MIN_TABLE_ROWS`] of them. Some lines may then be slightly too wide, but a
/// table of similar blocks is easy to read.
fn keep_rows(entries: &mut [Entry<'_>]) {
    for rows in entries.chunk_by_mut(|a, b| !b.blank && is_row_beside(a, b)) {
        if rows.len() < MIN_TABLE_ROWS {
            continue;
        }
        for entry in rows {
            if let EntryKind::Block(block) = &mut entry.what {
                block.on_one_line = true;
            }
        }
    }
}

/// Returns whether both entries are blocks of one kind, each written on one line and at most a
/// fifth wider than the maximum width of a line.
fn is_row_beside(a: &Entry<'_>, b: &Entry<'_>) -> bool {
    let is_row = |block: &BlockEntry<'_>| block.on_one_line || block.is_nearly_one_line;
    match (block(a), block(b)) {
        (Some(a), Some(b)) => a.kind == b.kind && is_row(a) && is_row(b),
        _ => false,
    }
}

/// Class of an entry, i.e. of a definition, a block or a field. In a group of lines without a blank
/// line between them, entries of the same class are aligned with each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Alignment {
    Definition,
    Object,
    Field,
    /// The entry is not aligned with others. Entries before and after it may still be aligned with
    /// each other.
    Unaligned,
    /// The entry is not aligned with others. Entries before it are not aligned with entries after
    /// it.
    End,
}

fn alignment_in_file(entry: &Entry<'_>) -> Alignment {
    match &entry.what {
        EntryKind::Block(block) if is_setting(block) || !block.on_one_line => Alignment::End,
        EntryKind::Block(block) if is_plain(entry, block) => Alignment::Object,
        EntryKind::Definition(head, rest)
            if entry.leading.is_empty()
                && !has_line_end(head)
                && !has_line_end(&rest[..rest.len().min(1)]) =>
        {
            Alignment::Definition
        }
        _ => Alignment::Unaligned,
    }
}

/// Classifies an entry for the alignment of objects. A line of comments or an object that spans
/// several lines ends a group: it separates the objects before it from the objects after it.
fn alignment_of_objects(entry: &Entry<'_>) -> Alignment {
    match alignment_in_file(entry) {
        Alignment::Unaligned => Alignment::End,
        class => class,
    }
}

fn alignment_in_block(entry: &Entry<'_>) -> Alignment {
    match entry.what {
        EntryKind::Field(..) if entry.leading.is_empty() => Alignment::Field,
        _ => Alignment::Unaligned,
    }
}

fn is_setting(block: &BlockEntry<'_>) -> bool {
    schema::block(block.kind).is_some_and(|block| !block.is_object)
}

/// Returns whether a block's head consists of its kind and name only, without comments.
fn is_plain(entry: &Entry<'_>, block: &BlockEntry<'_>) -> bool {
    let words = 1 + usize::from(block.name.is_some());
    entry.leading.is_empty() && block.head.len() == words
}

/// Returns the runs of entries that are aligned with each other: all entries of one class that no
/// blank line separates. A run is a list of indices of entries. `class` returns the class of an
/// entry.
fn runs(entries: &[Entry<'_>], class: fn(&Entry<'_>) -> Alignment) -> Vec<Vec<usize>> {
    let mut runs: Vec<Vec<usize>> = Vec::new();
    // Class of the entries in the last run. It is set to `End` when no more entries may be added to
    // this run.
    let mut open = Alignment::End;
    for (index, entry) in entries.iter().enumerate() {
        if entry.blank {
            open = Alignment::End;
        }
        match class(entry) {
            Alignment::Unaligned => {}
            Alignment::End => open = Alignment::End,
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

/// Splits `list`, which contains the indices of entries, into consecutive parts. Within a part, the
/// widths of the entries differ by at most [`MAX_WIDTH_DIFFERENCE`]. Each part is as long as
/// possible and is returned with its greatest width. `width` returns the width of an entry. An
/// entry for which it returns `None` belongs to the same part as the entry before it.
pub fn shared(list: &[usize], width: impl Fn(usize) -> Option<usize>) -> Vec<(&[usize], usize)> {
    let mut parts = Vec::new();
    let (mut from, mut least, mut most) = (0, usize::MAX, 0);
    for (index, &item) in list.iter().enumerate() {
        let Some(width) = width(item) else { continue };
        if width.max(most) - width.min(least) > MAX_WIDTH_DIFFERENCE {
            parts.push((&list[from..index], most));
            (from, least, most) = (index, width, width);
        }
        (least, most) = (least.min(width), most.max(width));
    }
    parts.push((&list[from..], most));
    parts
}

/// Aligns the second part of each entry of `run`: its value, `=` or `{`.
fn starts(entries: &mut [Entry<'_>], run: &[usize]) {
    let width = |entry: &Entry<'_>| match &entry.what {
        EntryKind::Definition(head, _) => width(head),
        EntryKind::Field(name, _) => name.len(),
        EntryKind::Block(block) => width(&block.head),
        EntryKind::Comments => 0,
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

fn block<'e, 's>(entry: &'e Entry<'s>) -> Option<&'e BlockEntry<'s>> {
    match &entry.what {
        EntryKind::Block(block) => Some(block),
        _ => None,
    }
}

/// Aligns the objects of `run`: their names, their braces, and the fields of consecutive objects of
/// one kind.
fn objects(entries: &mut [Entry<'_>], run: &[usize]) {
    let filled = |index: usize| block(&entries[index]).filter(|block| !block.is_empty());
    let parts = shared(run, |index| Some(width(&filled(index)?.head)));
    for (part, _) in parts {
        let blocks = part.iter().filter_map(|&index| block(&entries[index]));
        let named = blocks.clone().filter(|block| block.name.is_some());
        let name_column = named.map(|block| block.kind.len() + 1).max().unwrap_or(0);
        let head = |block: &BlockEntry<'_>| match block.name {
            Some(name) => name_column + name.len(),
            None => block.kind.len(),
        };
        let filled = blocks.filter(|block| !block.is_empty());
        let column = filled.map(|block| head(block) + 1).max().unwrap_or(0);
        for &index in part {
            entries[index].column = column;
            if let EntryKind::Block(block) = &mut entries[index].what {
                block.name_column = name_column;
            }
        }
        table(entries, part, 0);
    }
}

/// Aligns the fields of the objects `rows` from the index `field` on. The fields before this index
/// are aligned already. Fields of consecutive objects are aligned with each other if the objects
/// have the same kind and the fields have the same name.
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
                if let EntryKind::Block(block) = &mut entries[index].what {
                    block.entries[field].next = most + 2;
                }
            }
            table(entries, part, field + 1);
        }
    }
}

/// Describes the field of an object at the index `field`. Returns the object's kind, the field's
/// name and the field's width in characters. The width determines where the next field starts, so
/// returns `None` if there is no next field.
fn cell<'a>(entry: &'a Entry<'_>, field: usize) -> Option<(&'a str, &'a str, usize)> {
    let block = block(entry)?;
    block.entries.get(field + 1)?;
    let field = block.entries.get(field)?;
    let EntryKind::Field(name, _) = field.what else {
        return None;
    };
    Some((block.kind, name, field.width_in_line()))
}
