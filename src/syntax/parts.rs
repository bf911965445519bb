//! Parses a large file in parts, on several threads.
//!
//! In: a source. Out: the items of each part, in the order of the file, if the whole file follows
//! the grammar.

use std::{
    ops::Range,
    sync::{atomic::AtomicBool, mpsc},
    thread,
};

use super::{
    parser::{CHUNK_BYTES, STACK_BYTES, TreeBuilder, first_from},
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

/// Maximum number of threads that parse one file. One thread alone turns the parsed items into a
/// scene, so more parsing threads would only wait for it.
const MOST_THREADS: usize = 4;

/// Parses a file in parts of at least `bytes` bytes and passes the items of each part to `each`, in
/// the order of the file. The whole tree is never in memory. Returns `true` if all parts were
/// passed. Returns `false` if the file has mistakes or is too short for two parts, if `each`
/// returned `false`, or if parsing was cancelled; the caller must then discard the items that were
/// passed.
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
    // Returns the items of a part; `None` if the part does not follow the grammar or its last item
    // continues beyond its end.
    let read = |part: &Range<usize>| {
        let mut recovery = Recovery::new(source, id, &words);
        let mut right = TreeBuilder::new(text, id, &words);
        let mut from = part.start;
        while from < part.end {
            let to = first_from(&scan.split_points, from + CHUNK_BYTES).unwrap_or(part.end);
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
        // Thread i parses the parts i, i + count, i + 2·count and so on, where count is the number
        // of threads. Its channel holds one result, so while this result is not taken, the thread
        // parses one further part and then waits.
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
                // If a thread does not start, its channel is closed, `recv` fails, and the caller
                // parses the file as a whole.
                let builder = thread::Builder::new().stack_size(STACK_BYTES);
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

/// Returns the byte ranges of the parts. Each part ends where the text can be split, after a `}` or
/// before a `let`. Each has at least `bytes` bytes, except the last one.
fn ranges(source: &Source, bytes: usize, scan: &Scan) -> Vec<Range<usize>> {
    let (mut parts, mut from) = (Vec::new(), source.bom_len());
    while let Some(to) = first_from(&scan.split_points, from + bytes.max(1)) {
        parts.push(from..to);
        from = to;
    }
    if from < source.text().len() {
        parts.push(from..source.text().len());
    }
    parts
}
