//! A long text, part by part: on all processors, and without a tree of the whole.
//!
//! Where the text is taken apart is a guess, behind a `}` here and there (`comments::walk` makes it). It is checked: a part is
//! parsed with the rest of the text before it, as everything is, and counts only if one of its pieces ends exactly where the
//! next part starts, so that all parts together are the pieces of the whole. And no part may hold a mistake: then what was read
//! before matters nowhere, as every part ends with a whole block. A text of which this does not hold is parsed as a whole.

use std::{
    collections::BTreeMap,
    ops::Range,
    sync::{
        atomic::{AtomicBool, AtomicUsize, Ordering},
        mpsc,
    },
    thread,
};

use super::{Parser, STACK};
use crate::{
    cancel,
    source::{Source, SourceId},
    syntax::{
        comments::{self, Start},
        tree::Item,
    },
    threads,
};

/// What is done with the parts is done by one thread: more than these would wait for it.
const MOST_THREADS: usize = 8;

/// Parses a file in parts of at least so many bytes, and hands over the items of each in their order. Answers whether all went
/// well; otherwise the file has mistakes, is short, `each` wanted no more, or it was cancelled, and what was handed over does not
/// count.
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
    let parts = parts(source, bytes, cancel);
    if parts.is_empty() {
        return false;
    }
    let threads = threads::available().min(parts.len()).min(MOST_THREADS);
    let next = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    let work = |found: mpsc::SyncSender<_>| {
        while !stopped.load(Ordering::Relaxed) {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(part) = parts.get(index) else { break };
            let items = Parser::of_part(text, id, part.clone(), cancel);
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

/// The parts of a text; none if something was found that is a mistake or hides one.
fn parts(source: &Source, bytes: usize, cancel: &AtomicBool) -> Vec<Range<usize>> {
    let text = source.text();
    let start = source.bom_len();
    let rest = text.get(start..).unwrap_or_default();
    let mut walk = comments::walk(rest, Start::Items, cancel);
    walk.shift(start);
    if walk.unclosed
        || !walk.foreign.is_empty()
        || !walk.deep.is_empty()
        || !walk.odd_spaces.is_empty()
    {
        return Vec::new();
    }
    let mut parts = Vec::new();
    let mut from = start;
    for to in walk.braces {
        if to - from >= bytes {
            parts.push(from..to);
            from = to;
        }
    }
    parts.push(from..text.len());
    parts
}

impl<'s> Parser<'s> {
    /// The items of a part, if it holds no mistake and ends with a piece.
    fn of_part(
        text: &'s str,
        id: SourceId,
        part: Range<usize>,
        cancel: &AtomicBool,
    ) -> Option<Vec<Item<'s>>> {
        let mut parser = Self::new(text, id, part.start);
        let ends = parser.pieces(part.end, cancel);
        (ends && parser.problems.is_empty()).then_some(parser.items)
    }
}
