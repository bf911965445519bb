//! Parses a large file in parts, on several threads.
//!
//! In: a source, and a function that converts a list of items. Out: the function's result for each
//! part, in the order of the file. If the file has a mistake, the results are invalid, and the
//! caller must parse the file as a whole.

use std::{
    ops::Range,
    sync::{atomic::AtomicBool, mpsc},
    thread,
};

use super::{
    parser::{STACK_BYTES, TreeBuilder},
    plain,
    recovery::Recovery,
    scan::Scan,
    tokens::{Lexer, TokenKind},
    tree::Item,
    vocabulary::Vocabulary,
};
use crate::{
    cancel,
    source::{Source, SourceId},
    threads,
};

/// Maximum number of threads that parse one file. One thread alone collects the results, so more
/// parsing threads would only wait for it.
const MOST_THREADS: usize = 4;

/// Parses a file in parts of at least `bytes` bytes. Calls `prepare` with the items of each part,
/// on the thread that parsed the part, and passes the results to `each` on the caller's thread, in
/// the order of the file. The whole tree is never in memory. Returns `true` if all parts were
/// passed. Returns `false` if the file has mistakes or is too short for two parts, if `each`
/// returned `false`, or if parsing was cancelled; the caller must then discard what was passed.
pub fn parse_in_parts<'s, R: Send>(
    source: &'s Source,
    id: SourceId,
    bytes: usize,
    cancel: &AtomicBool,
    prepare: impl Fn(Vec<Item<'s>>) -> R + Sync,
    mut each: impl FnMut(R) -> bool,
) -> bool {
    let text = source.text();
    if text.len() / 2 < bytes {
        return false;
    }
    let parts = ranges(source, bytes);
    let words = Vocabulary::new(text);
    // Returns the result for a part. Returns `None` if the part does not follow the grammar, or if
    // its last item or comment continues beyond the part's end. If no part gives `None`, every part
    // ends after a whole item, so the next part starts at the next item.
    let read = |part: &Range<usize>| {
        let text = text.get(..part.end)?;
        let is_wanted = || !cancel::is_set(cancel);
        if let Some(items) = plain::blocks(text, id, &words, part.start) {
            return is_wanted().then(|| prepare(items));
        }
        if !Scan::of(text, id, part.start, cancel).is_plain(text) {
            return None;
        }
        let mut recovery = Recovery::new(source, id, &words);
        let mut builder = TreeBuilder::new(source.text(), id, &words);
        let (next, is_agreed) = builder.items(part.clone(), &mut recovery);
        let is_read = is_agreed && Lexer::new(text, next).seen_token().kind == TokenKind::End;
        let is_right = is_read && recovery.problems.is_empty() && is_wanted();
        is_right.then(|| prepare(recovery.items))
    };
    let count = threads::available().min(parts.len()).min(MOST_THREADS);
    thread::scope(|scope| {
        // Thread i parses the parts i, i + count, i + 2·count and so on, where count is the number
        // of threads. Its channel holds one result. Until the receiver takes this result, the
        // thread parses at most one further part and then waits.
        let parsed: Vec<mpsc::Receiver<_>> = (0..count)
            .map(|first| {
                let (found, results) = mpsc::sync_channel(1);
                let (parts, read) = (&parts, &read);
                let work = move || {
                    for part in parts.iter().skip(first).step_by(count) {
                        let result = read(part);
                        let is_right = result.is_some();
                        if found.send(result).is_err() || !is_right {
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
            Ok(Some(result)) => !cancel::is_set(cancel) && each(result),
            _ => false,
        })
    })
}

/// Returns the byte ranges of the parts. Each part ends with a line whose last character is a `}`,
/// which usually ends a block. Each has at least `bytes` bytes, except the last one. This function
/// does not look for comments, so a part may also end within a comment.
fn ranges(source: &Source, bytes: usize) -> Vec<Range<usize>> {
    let text = source.text().as_bytes();
    let (mut parts, mut from) = (Vec::new(), source.bom_len());
    while from < text.len() {
        let rest = text.get(from + bytes..).unwrap_or_default();
        let mut ends = memchr::memchr_iter(b'\n', rest).map(|at| from + bytes + at);
        let is_after_brace = |&end: &usize| {
            let line = text.get(from..end).unwrap_or_default();
            line.trim_ascii_end().ends_with(b"}")
        };
        let to = ends.find(is_after_brace).map_or(text.len(), |end| end + 1);
        parts.push(from..to);
        from = to;
    }
    parts
}
