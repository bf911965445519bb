//! A large file part by part.
//!
//! In: a source. Out: the items of each part in their order, if all of the file is right.

use std::sync::atomic::AtomicBool;

use super::{
    parser::{CHUNK, TreeBuilder, after, with_stack},
    recovery::Recovery,
    scan::Scan,
    tokens::Lexer,
    tree::Item,
    vocabulary::Vocabulary,
};
use crate::{
    cancel,
    source::{Source, SourceId},
};

/// Parses a file in parts of at least so many bytes, and hands over the items of each in their order, so that there is never a tree
/// of the whole. Answers whether all went well; otherwise the file has mistakes, is short, `each` wanted no more, or it was
/// cancelled, and what was handed over does not count.
pub fn parse_in_parts<'s>(
    source: &'s Source,
    id: SourceId,
    bytes: usize,
    cancel: &AtomicBool,
    mut each: impl FnMut(Vec<Item<'s>>) -> bool,
) -> bool {
    let text = source.text();
    if text.len() / 2 < bytes {
        return false;
    }
    let scan = Scan::of(text, source.bom_len(), cancel);
    if !scan.is_plain() {
        return false;
    }
    let words = Vocabulary::new(text);
    let mut start = source.bom_len();
    while start < text.len() {
        let part = with_stack(|| part_from(start, bytes, source, id, &scan, &words, cancel));
        let Some((items, end)) = part else {
            return false;
        };
        if !each(items) {
            return false;
        }
        start = end;
    }
    true
}

/// The items of the part from an offset on, and where it ends, if all of it is right.
fn part_from<'s>(
    start: usize,
    bytes: usize,
    source: &'s Source,
    id: SourceId,
    scan: &Scan,
    words: &Vocabulary<'s>,
    cancel: &AtomicBool,
) -> Option<(Vec<Item<'s>>, usize)> {
    let text = source.text();
    let mut recovery = Recovery::new(source, id, words);
    let mut right = TreeBuilder::new(text, id, words);
    let mut from = start;
    for &to in after(&scan.ends, start + 1).iter().chain([&text.len()]) {
        let is_part = to - start >= bytes || to == text.len();
        if !is_part && to - from < CHUNK {
            continue;
        }
        let (next, is_right) = right.items(from..to, &mut recovery);
        let is_read = is_right && Lexer::past_comments(text, next).start >= to;
        if cancel::is_set(cancel) || !is_read || !recovery.problems.is_empty() {
            return None;
        }
        from = to;
        if is_part {
            break;
        }
    }
    Some((recovery.items, from))
}
