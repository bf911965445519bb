//! How many threads work is done on, and whether they are started for it: what is a part of other
//! work is done on the threads of that.

use std::{
    num::NonZero,
    sync::{
        LazyLock,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

/// Why there are no threads.
pub use rayon::ThreadPoolBuildError as NoThreads;
pub(crate) use rayon::prelude;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// More threads than this are not started, whatever is asked for: no machine has as many processors
/// for one picture.
const MOST: usize = 1024;

/// What the process was limited to; 0 where it was not. This and the number of processors are all
/// that is kept for a whole process; they change how long things take and nothing else.
static LIMIT: AtomicUsize = AtomicUsize::new(0);

/// As many as the process has: to ask the system takes longer than a small picture.
static PROCESSORS: LazyLock<usize> =
    LazyLock::new(|| thread::available_parallelism().map_or(1, NonZero::get));

/// From now on this process starts no more threads at once than this, unless it is told otherwise
/// for something.
pub fn limit(threads: NonZero<usize>) {
    LIMIT.store(threads.get().min(MOST), Ordering::Relaxed);
}

/// One thread for each processor, or as many as the process is limited to, whatever variables of
/// the environment say.
pub(crate) fn available() -> usize {
    match LIMIT.load(Ordering::Relaxed) {
        0 => *PROCESSORS,
        limit => limit,
    }
}

/// Threads to do something on.
pub(crate) enum Threads {
    /// Started for it.
    Started(ThreadPool),
    /// Those that do what it is a part of: what makes hundreds of pictures has them all made by the
    /// same threads.
    These,
}

impl Threads {
    /// So many, or as many as are available; those that this is already done on, if they are as
    /// many, or if the system starts none.
    ///
    /// # Errors
    ///
    /// If not even the calling thread can be had.
    pub(crate) fn new(threads: Option<NonZero<usize>>) -> Result<Self, NoThreads> {
        let wanted = threads.map_or_else(available, |threads| threads.get().min(MOST));
        match rayon::current_thread_index() {
            Some(_) if rayon::current_num_threads() == wanted => Ok(Self::These),
            _ => Self::started(ThreadPoolBuilder::new().num_threads(wanted).build()),
        }
    }

    /// A pool, or, where it could not be built, as where too many threads are started, those that
    /// this is done on: rayon takes a thread that is in no pool for one that is a pool by itself,
    /// for good.
    fn started(built: Result<ThreadPool, NoThreads>) -> Result<Self, NoThreads> {
        match built {
            Ok(pool) => Ok(Self::Started(pool)),
            Err(_) if rayon::current_thread_index().is_some() => Ok(Self::These),
            Err(_) => {
                let alone = ThreadPoolBuilder::new().num_threads(1);
                alone.use_current_thread().build().map(Self::Started)
            }
        }
    }

    /// Does it.
    pub(crate) fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match self {
            Self::Started(pool) => pool.install(work),
            Self::These => work(),
        }
    }
}

/// Does something on so many threads, or on as many as are available.
///
/// # Errors
///
/// If not even the calling thread can be had.
pub(crate) fn install<R: Send>(
    threads: Option<NonZero<usize>>,
    work: impl FnOnce() -> R + Send,
) -> Result<R, NoThreads> {
    Ok(Threads::new(threads)?.install(work))
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::{prelude::*, *};

    /// Twice, as the second time the calling thread is in a pool.
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
    fn what_is_done_on_as_many_threads_starts_no_others() {
        let [two, three] = [2, 3].map(NonZero::new);
        let is_these = |threads| matches!(Threads::new(threads), Ok(Threads::These));
        assert!(!is_these(two));
        let inside = install(two, || [is_these(two), is_these(three)]);
        assert!(matches!(inside, Ok([true, false])));
    }
}
