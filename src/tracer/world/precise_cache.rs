//! The cache of objects in a higher precision.
//!
//! In: an object's index, and how it is prepared. Out: the object, prepared now or kept since it
//! was last asked for.

use std::{
    ops::Deref,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use crate::{math::Real, tracer::object::Object};

/// As many objects are kept as people write by hand and more. It is a prime number, so that objects
/// in rows, whose indices often are a power of two or of ten apart, do not take each other's.
pub const KEPT: usize = 4093;

/// Objects in one precision, each prepared when it is first asked for and kept, of many until
/// another takes its place.
///
/// To prepare an object takes far longer than to ask it; but where one sample point is in doubt,
/// those beside it often are, about the same objects. However many a scene has, only so many take
/// memory.
#[derive(Debug)]
pub struct Kept<T: Real>(Vec<Mutex<Option<Arc<Prepared<T>>>>>);

/// An object that was prepared.
#[derive(Debug)]
pub struct Prepared<T: Real> {
    /// Its index in the file.
    index: usize,
    object: Object<T>,
}

/// An object that stays where it is, or one that was prepared and is kept for as long as it is
/// held.
#[derive(Debug)]
pub enum Held<'a, T: Real> {
    Always(&'a Object<T>),
    Shared(Arc<Prepared<T>>),
}

impl<T: Real> Deref for Held<'_, T> {
    type Target = Object<T>;

    #[inline]
    fn deref(&self) -> &Object<T> {
        match self {
            Self::Always(object) => object,
            Self::Shared(prepared) => &prepared.object,
        }
    }
}

impl<T: Real> Kept<T> {
    /// Places for the objects of a scene, of which there are so many.
    pub fn new(objects: usize) -> Self {
        Self((0..objects.min(KEPT)).map(|_| Mutex::default()).collect())
    }

    /// The object with an index.
    pub fn object(&self, index: usize, prepare: impl FnOnce() -> Object<T>) -> Held<'_, T> {
        let place = &self.0[index % self.0.len()];
        let kept = lock(place).clone();
        if let Some(kept) = kept
            && kept.index == index
        {
            return Held::Shared(kept);
        }
        // Not while others wait for the place; two threads that want the same object may both
        // prepare it.
        let object = prepare();
        let prepared = Arc::new(Prepared { index, object });
        *lock(place) = Some(prepared.clone());
        Held::Shared(prepared)
    }

    /// How many there are.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.0.iter().filter(|place| lock(place).is_some()).count()
    }
}

/// What is in a place is whole even if a thread has panicked: it is put there in one step.
fn lock<T>(place: &Mutex<T>) -> MutexGuard<'_, T> {
    place.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracer::convex::Convex;

    #[test]
    fn an_object_is_prepared_once_until_another_takes_its_place() {
        let kept = Kept::<f64>::new(3 * KEPT);
        let times = |index| {
            let mut times = 0;
            kept.object(index, || {
                times += 1;
                Object::Convex(Convex::nothing())
            });
            times
        };
        assert_eq!([1, 2, 1, 2].map(times), [1, 1, 0, 0]);
        assert_eq!([KEPT + 1, 1, 1, 2].map(times), [1, 1, 0, 0]);
        assert_eq!(kept.len(), 2);
    }
}
