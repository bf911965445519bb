//! A large file part by part, parsed on all processors.
//!
//! In: a source. Out: the items of each part in their order, if all of the file is right.

use std::{
    ops::Range,
    sync::{atomic::AtomicBool, mpsc},
    thread,
};

use super::{
    parser::{CHUNK, STACK, TreeBuilder, first_from},
    recovery::Recovery,
    scan::Scan,
    tokens::Lexer,
    tree::Item,
    vocabulary::Vocabulary,
};
use crate::{
    cancel,
    source::{Source, SourceId},
    threads,
};

/// Maximum number of threads that parse: one thread lowers what they parse, and more would wait for
/// it.
const MOST_THREADS: usize = 4;

/// Parses a file in parts of at least so many bytes, and hands over the items of each in their
/// order, so that there is never a tree of the whole. Answers whether all went well; otherwise the
/// file has mistakes, is short, `each` wanted no more, or it was cancelled, and what was handed
/// over does not count.
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
    let scan = Scan::of(text, id, source.bom_len(), cancel);
    if !scan.is_plain(text) {
        return false;
    }
    let parts = ranges(source, bytes, &scan);
    let words = Vocabulary::new(text);
    // The items of a part, if all of it is right and no item goes on behind it.
    let read = |part: &Range<usize>| {
        let mut recovery = Recovery::new(source, id, &words);
        let mut right = TreeBuilder::new(text, id, &words);
        let mut from = part.start;
        while from < part.end {
            let to = first_from(&scan.ends, from + CHUNK).unwrap_or(part.end);
            let to = to.min(part.end);
            let (next, is_right) = right.items(from..to, &mut recovery);
            let is_read = is_right && Lexer::new(text, next).seen_token().start >= to;
            if cancel::is_set(cancel) || !is_read || !recovery.problems.is_empty() {
                return None;
            }
            from = to;
        }
        Some(recovery.items)
    };
    let count = threads::available().min(parts.len()).min(MOST_THREADS);
    thread::scope(|scope| {
        // Thread i parses the parts i, i + count, …, each a few parts ahead of what is asked of it.
        let parsed: Vec<mpsc::Receiver<_>> = (0..count)
            .map(|first| {
                let (found, results) = mpsc::sync_channel(1);
                let (parts, read) = (&parts, &read);
                let work = move || {
                    for part in parts.iter().skip(first).step_by(count) {
                        let items = read(part);
                        let is_right = items.is_some();
                        if found.send(items).is_err() || !is_right {
                            break;
                        }
                    }
                };
                // Without the thread nothing is received from it, and the file is parsed as a
                // whole.
                let builder = thread::Builder::new().stack_size(STACK);
                let _ = builder.spawn_scoped(scope, work);
                results
            })
            .collect();
        let mut in_order = parsed.iter().cycle().take(parts.len());
        in_order.all(|results| match results.recv() {
            Ok(Some(items)) => !cancel::is_set(cancel) && each(items),
            _ => false,
        })
    })
}

/// The parts of a text, each of which ends behind a block.
fn ranges(source: &Source, bytes: usize, scan: &Scan) -> Vec<Range<usize>> {
    let (mut parts, mut from) = (Vec::new(), source.bom_len());
    while let Some(to) = first_from(&scan.ends, from + bytes.max(1)) {
        parts.push(from..to);
        from = to;
    }
    if from < source.text().len() {
        parts.push(from..source.text().len());
    }
    parts
}
