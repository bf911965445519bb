//! How many threads there are: for a render, and for what is done in parallel without being asked, which is to read a long text and to
//! prepare many objects.

use std::{
    num::NonZero,
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// More threads than this are not started, whatever is asked for: no machine has as many processors for one picture.
const MOST: usize = 1024;

/// What the process was limited to; 0 where it was not. This is the one thing that is kept for a whole process, as processors are; it changes how long
/// things take and nothing else.
static LIMIT: AtomicUsize = AtomicUsize::new(0);

/// From now on this process starts no more threads at once than this, unless it is told otherwise for something.
pub fn limit(threads: NonZero<usize>) {
    LIMIT.store(threads.get().min(MOST), Ordering::Relaxed);
}

/// One thread for each processor, or as many as the process is limited to, whatever variables of the environment say.
pub(crate) fn available() -> usize {
    match LIMIT.load(Ordering::Relaxed) {
        0 => thread::available_parallelism().map_or(1, NonZero::get),
        limit => limit,
    }
}

/// Does something on so many threads, or on as many as are available. They are started for it, but where it is already done on so many:
/// what starts hundreds of renders has them done on the same threads.
///
/// # Errors
///
/// If the system starts none.
pub(crate) fn install<R: Send>(
    threads: Option<NonZero<usize>>,
    work: impl FnOnce() -> R + Send,
) -> Result<R, ThreadPoolBuildError> {
    let wanted = number(threads);
    match rayon::current_thread_index() {
        Some(_) if rayon::current_num_threads() == wanted => Ok(work()),
        _ => Ok(pool(threads)?.install(work)),
    }
}

/// So many threads, or as many as are available.
///
/// # Errors
///
/// If the system starts none.
pub(crate) fn pool(threads: Option<NonZero<usize>>) -> Result<ThreadPool, ThreadPoolBuildError> {
    ThreadPoolBuilder::new()
        .num_threads(number(threads))
        .build()
}

fn number(threads: Option<NonZero<usize>>) -> usize {
    threads.map_or_else(available, |threads| threads.get().min(MOST))
}
