//! Takes the place of `threads.rs` on targets without threads, such as browsers. The calling thread
//! does all work. Rayon is not used: without threads, it would only make the program larger.

use std::num::NonZero;

use thiserror::Error;

/// Error of starting threads. It does not occur on targets without threads.
#[derive(Debug, Error)]
pub enum NoThreads {}

/// Does nothing: there are no threads to limit.
pub fn limit(_: NonZero<usize>) {}

pub(crate) fn available() -> usize {
    1
}

/// The calling thread, which does all work.
pub(crate) struct Threads;

impl Threads {
    pub(crate) fn new(_: Option<NonZero<usize>>) -> Result<Self, NoThreads> {
        Ok(Self)
    }

    pub(crate) fn install<R>(&self, work: impl FnOnce() -> R) -> R {
        work()
    }
}

pub(crate) fn install<R>(
    _: Option<NonZero<usize>>,
    work: impl FnOnce() -> R,
) -> Result<R, NoThreads> {
    Ok(work())
}

pub(crate) fn for_each<T, S>(
    _: Option<NonZero<usize>>,
    items: impl Iterator<Item = T>,
    state: impl Fn() -> S,
    work: impl Fn(&mut S, T),
) -> Result<(), NoThreads> {
    let mut state = state();
    items.for_each(|item| work(&mut state, item));
    Ok(())
}

/// Sequential versions of the parallel loops of rayon.
pub mod prelude {
    use std::slice;

    pub trait Loop: Iterator + Sized {
        fn unzip_into_vecs<A, B>(self, a: &mut Vec<A>, b: &mut Vec<B>)
        where
            Self: Iterator<Item = (A, B)>,
        {
            (*a, *b) = self.unzip();
        }
    }

    impl<I: Iterator> Loop for I {}

    pub trait IntoLoop: IntoIterator + Sized {
        fn into_par_iter(self) -> Self::IntoIter {
            self.into_iter()
        }
    }

    impl<I: IntoIterator> IntoLoop for I {}

    pub trait SliceLoop<T> {
        fn par_iter(&self) -> slice::Iter<'_, T>;
    }

    impl<T> SliceLoop<T> for [T] {
        fn par_iter(&self) -> slice::Iter<'_, T> {
            self.iter()
        }
    }
}
