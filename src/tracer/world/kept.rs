//! The objects that were asked for last in a higher precision.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::{math::Real, tracer::object::Object};

/// Places for as many objects as people write by hand and more. It is a prime number, so that objects in rows, whose indices often are a
/// power of two or of ten apart, do not take each other's.
const PLACES: usize = 4093;

/// Objects in one precision, each prepared when it is first asked for and kept until another takes its place.
///
/// To prepare an object takes far longer than to ask it; but where one sample point is in doubt, those beside it often are, about the same
/// objects. However many a scene has, only so many take memory.
#[derive(Debug)]
pub struct Kept<T: Real>(Vec<Place<T>>);

type Place<T> = Mutex<Option<Arc<Prepared<T>>>>;

/// An object that was prepared.
#[derive(Debug)]
pub struct Prepared<T: Real> {
    /// Its index in the file.
    index: usize,
    pub object: Object<T>,
}

impl<T: Real> Kept<T> {
    /// Places for the objects of a scene, of which there are so many.
    pub fn new(objects: usize) -> Self {
        Self((0..objects.min(PLACES)).map(|_| Mutex::default()).collect())
    }

    /// No places: each object is prepared each time.
    pub fn none() -> Self {
        Self(Vec::new())
    }

    /// The object with an index.
    pub fn object(&self, index: usize, prepare: impl FnOnce() -> Object<T>) -> Arc<Prepared<T>> {
        let place = self.0.get(index % PLACES);
        let kept = place.and_then(|place| lock(place).clone());
        if let Some(kept) = kept
            && kept.index == index
        {
            return kept;
        }
        // Not while others wait for the place; two threads that want the same object may both prepare it.
        let object = prepare();
        let prepared = Arc::new(Prepared { index, object });
        if let Some(place) = place {
            *lock(place) = Some(prepared.clone());
        }
        prepared
    }

    /// How many there are.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        let is_taken = |place: &&Place<T>| lock(place).is_some();
        self.0.iter().filter(is_taken).count()
    }
}

/// What is in a place is whole even if a thread has panicked: it is put there in one step.
fn lock<T>(place: &Mutex<T>) -> MutexGuard<'_, T> {
    place.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_is_prepared_once_until_another_takes_its_place() {
        let kept = Kept::<f64>::new(3 * PLACES);
        let asked = |index: usize| {
            let mut times = 0;
            let prepared = kept.object(index, || {
                times += 1;
                Object::EdgeOn
            });
            assert_eq!(prepared.index, index);
            times
        };
        assert_eq!([1, 2, 1, 2].map(asked), [1, 1, 0, 0]);
        assert_eq!([PLACES + 1, 1, 1, 2].map(asked), [1, 1, 0, 0]);
        assert_eq!(kept.len(), 2);
    }

    #[test]
    fn objects_that_are_few_all_have_places() {
        let kept = Kept::<f64>::new(3);
        let ask = |index: usize| kept.object(index, || Object::EdgeOn).index;
        assert_eq!([0, 1, 2].map(ask), [0, 1, 2]);
        assert_eq!(kept.len(), 3);
        assert_eq!(Kept::<f64>::none().object(7, || Object::EdgeOn).index, 7);
    }
}
