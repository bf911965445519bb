//! The number of threads, and pools of threads. If work inside a pool asks for as many threads as
//! the pool has, it runs on the same pool.

use std::{
    num::NonZero,
    sync::{
        LazyLock,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

pub(crate) use rayon::prelude;
use rayon::{
    ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder,
    iter::{ParallelBridge, ParallelIterator},
};
use thiserror::Error;

/// Error if the system cannot start threads.
#[derive(Debug, Error)]
#[error(transparent)]
pub struct NoThreads(#[from] ThreadPoolBuildError);

/// Maximum number of threads that a user can request; a greater request is reduced to it. Few
/// machines have more processors, and threads beyond the number of processors gain nothing.
const MAX_THREADS: usize = 1024;

/// Maximum number of threads of the process; 0 if there is no limit. The limit is global state, but
/// it affects only running times, never results.
static LIMIT: AtomicUsize = AtomicUsize::new(0);

/// Number of processors that this process may use. It is stored because asking the system takes
/// longer than rendering a small picture.
static PROCESSORS: LazyLock<usize> =
    LazyLock::new(|| thread::available_parallelism().map_or(1, NonZero::get));

/// Limits the number of threads of this process, for all work that does not itself specify a
/// number.
pub fn limit(threads: NonZero<usize>) {
    LIMIT.store(threads.get().min(MAX_THREADS), Ordering::Relaxed);
}

/// Returns the number of threads to use: the limit of the process, or one per processor if there is
/// no limit. Environment variables are ignored.
pub(crate) fn available() -> usize {
    match LIMIT.load(Ordering::Relaxed) {
        0 => *PROCESSORS,
        limit => limit,
    }
}

/// Threads on which work runs.
pub(crate) enum Threads {
    /// A pool that was started for the work.
    Started(ThreadPool),
    /// The pool in which the caller already runs. For example, hundreds of pictures that are
    /// rendered in one pool share its threads. Starting a pool for each picture would take longer.
    Current,
}

impl Threads {
    /// Starts a pool of `threads` threads, or of `available()` threads if `threads` is `None`. If
    /// the caller already runs in a pool of this size, returns that pool instead. If the system
    /// cannot start threads, work runs on the threads of the caller.
    ///
    /// # Errors
    ///
    /// Returns an error if not even the calling thread can be used.
    pub(crate) fn new(threads: Option<NonZero<usize>>) -> Result<Self, NoThreads> {
        let wanted = threads.map_or_else(available, |threads| threads.get().min(MAX_THREADS));
        match rayon::current_thread_index() {
            Some(_) if rayon::current_num_threads() == wanted => Ok(Self::Current),
            _ => Self::started(ThreadPoolBuilder::new().num_threads(wanted).build()),
        }
    }

    /// Returns the pool `built`. If the system could not start it, for instance because too many
    /// threads are running, returns the pool in which the caller runs. If the caller runs in no
    /// pool, makes a new pool with the calling thread as its only thread. Rayon then keeps this
    /// thread in the new pool permanently.
    fn started(built: Result<ThreadPool, ThreadPoolBuildError>) -> Result<Self, NoThreads> {
        match built {
            Ok(pool) => Ok(Self::Started(pool)),
            Err(_) if rayon::current_thread_index().is_some() => Ok(Self::Current),
            Err(_) => {
                let alone = ThreadPoolBuilder::new().num_threads(1);
                Ok(Self::Started(alone.use_current_thread().build()?))
            }
        }
    }

    /// Runs `work` on the threads, and returns its result.
    pub(crate) fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match self {
            Self::Started(pool) => pool.install(work),
            Self::Current => work(),
        }
    }
}

/// Runs `work` on `threads` threads, or on the available number if `threads` is `None`. Returns the
/// result of `work`.
///
/// # Errors
///
/// Returns an error if not even the calling thread can be used.
pub(crate) fn install<R: Send>(
    threads: Option<NonZero<usize>>,
    work: impl FnOnce() -> R + Send,
) -> Result<R, NoThreads> {
    Ok(Threads::new(threads)?.install(work))
}

/// Calls `work` for each item, in any order, on `threads` threads, or on the available number if
/// `threads` is `None`. `work` also gets a state, such as a buffer, that `state` makes. A state is
/// reused for many items, but only one thread uses it. A single item is handled on the calling
/// thread, since starting threads takes longer than rendering a small picture.
///
/// # Errors
///
/// Returns an error if not even the calling thread can be used.
pub(crate) fn for_each<T: Send, S>(
    threads: Option<NonZero<usize>>,
    mut items: impl Iterator<Item = T> + Send,
    state: impl Fn() -> S + Sync + Send,
    work: impl Fn(&mut S, T) + Sync + Send,
) -> Result<(), NoThreads> {
    let (first, second) = (items.next(), items.next());
    if second.is_none() {
        first.into_iter().for_each(|only| work(&mut state(), only));
        return Ok(());
    }
    let items = first.into_iter().chain(second).chain(items);
    install(threads, || {
        items
            .par_bridge()
            .for_each_init(state, |state, item| work(state, item));
    })
}

#[cfg(test)]
mod tests {
    use std::{io, sync::Mutex};

    use super::{prelude::*, *};
    use crate::lock::{lock, unpoisoned};

    /// Tries a system that cannot start threads: all work must run on the calling thread. The first
    /// run puts the calling thread into a pool, so that the second run tests a thread that already
    /// belongs to a pool.
    #[test]
    fn where_no_thread_can_be_started_the_calling_one_does_it() {
        for _ in 0..2 {
            let unsupported = |_| Err(io::ErrorKind::Unsupported.into());
            let builder = ThreadPoolBuilder::new().spawn_handler(unsupported);
            let threads = Threads::started(builder.num_threads(2).build());
            let threads = threads.expect("this thread can be had");
            let caller = thread::current().id();
            let work = || {
                let here = (0..1000).into_par_iter();
                here.filter(|_| thread::current().id() == caller).count()
            };
            assert_eq!(threads.install(work), 1000);
        }
    }

    #[test]
    fn a_single_item_is_handled_by_the_calling_thread() {
        let caller = thread::current().id();
        for count in [0, 1, 2, 100] {
            let handled = Mutex::new(Vec::new());
            let handle = |(): &mut (), item| lock(&handled).push((item, thread::current().id()));
            for_each(NonZero::new(2), 0..count, || (), handle).expect("threads can be had");
            let mut handled = unpoisoned(handled.into_inner());
            handled.sort_by_key(|&(item, _)| item);
            assert!(handled.iter().map(|&(item, _)| item).eq(0..count));
            let is_here = |&(_, thread): &(u32, _)| thread == caller;
            assert_eq!(handled.iter().all(is_here), count <= 1, "{count}");
        }
    }

    #[test]
    fn what_is_done_on_as_many_threads_starts_no_others() {
        let [two, three] = [2, 3].map(NonZero::new);
        let is_current = |threads| matches!(Threads::new(threads), Ok(Threads::Current));
        assert!(!is_current(two));
        let inside = install(two, || [is_current(two), is_current(three)]);
        assert!(matches!(inside, Ok([true, false])));
    }
}
