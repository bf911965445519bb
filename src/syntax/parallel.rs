//! A large file in parts, side by side.
//!
//! In: a source. Out: the items of each part in their order, if all of the file is right.

use std::{
    collections::BTreeMap,
    sync::{
        atomic::{AtomicBool, AtomicUsize, Ordering},
        mpsc,
    },
    thread,
};

use super::{
    parser::{CHUNK, STACK, TreeBuilder},
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

/// Parses a file in parts of at least so many bytes, side by side, and hands over the items of each in their order, so that
/// there is never a tree of the whole. Answers whether all went well; otherwise the file has mistakes, is short, `each`
/// wanted no more, or it was cancelled, and what was handed over does not count.
pub fn parse_in_parts<'s>(
    source: &'s Source,
    id: SourceId,
    bytes: usize,
    cancel: &AtomicBool,
    mut each: impl FnMut(Vec<Item<'s>>) -> bool,
) -> bool {
    /// What is done with the parts is done by one thread: more than these would wait for it.
    const MOST_THREADS: usize = 8;
    let text = source.text();
    if text.len() / 2 < bytes {
        return false;
    }
    let scan = Scan::of(text, source.bom_len(), cancel);
    if !scan.is_plain() {
        return false;
    }
    let parts = parts(source, bytes, &scan);
    let threads = threads::available().min(parts.len()).min(MOST_THREADS);
    let next = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    let words = Vocabulary::new(text);
    let work = |found: mpsc::SyncSender<_>| {
        while !stopped.load(Ordering::Relaxed) {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(part) = parts.get(index) else { break };
            let items = part_of(source, id, part, &words, cancel);
            if found.send((index, items)).is_err() {
                break;
            }
        }
    };
    thread::scope(|scope| {
        let (found, results) = mpsc::sync_channel(threads);
        for _ in 0..threads {
            let found = found.clone();
            let builder = thread::Builder::new().stack_size(STACK);
            // Without any thread there are no results.
            let _ = builder.spawn_scoped(scope, || work(found));
        }
        drop(found);
        let mut early = BTreeMap::new();
        let mut done = 0;
        for (index, items) in results {
            let Some(items) = items else { break };
            early.insert(index, items);
            while let Some(items) = early.remove(&done) {
                if cancel::is_set(cancel) || !each(items) {
                    stopped.store(true, Ordering::Relaxed);
                    return false;
                }
                done += 1;
            }
        }
        stopped.store(true, Ordering::Relaxed);
        done == parts.len()
    })
}

/// The parts of a text, each with the ends of its chunks.
fn parts(source: &Source, bytes: usize, scan: &Scan) -> Vec<Vec<usize>> {
    let mut parts = Vec::new();
    let (mut start, mut from) = (source.bom_len(), source.bom_len());
    let mut ends = vec![from];
    for &to in &scan.ends {
        let is_part = to - start >= bytes;
        if is_part || to - from >= CHUNK {
            ends.push(to);
            from = to;
        }
        if is_part {
            parts.push(std::mem::replace(&mut ends, vec![to]));
            start = to;
        }
    }
    ends.push(source.text().len());
    parts.push(ends);
    parts
}

/// The items of a part, if all of it is right.
fn part_of<'s>(
    source: &'s Source,
    id: SourceId,
    ends: &[usize],
    words: &Vocabulary<'s>,
    cancel: &AtomicBool,
) -> Option<Vec<Item<'s>>> {
    let text = source.text();
    let mut recovery = Recovery::new(source, id, words);
    let mut right = TreeBuilder::new(text, id, words);
    for chunk in ends.windows(2) {
        let &[start, end] = chunk else { return None };
        if cancel::is_set(cancel) {
            return None;
        }
        let (next, is_right) = right.items(start..end, &mut recovery);
        if !is_right || Lexer::past_comments(text, next).start < end {
            return None;
        }
    }
    recovery.problems.is_empty().then_some(recovery.items)
}
