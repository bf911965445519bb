//! The cache of objects in a higher precision.
//!
//! In: an object's index, and how it is prepared. Out: the object, prepared now or kept since it was last asked for.

use std::{
    ops::Deref,
    sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError},
};

use crate::{math::Real, tracer::object::Object};

/// Places for as many objects as people write by hand and more. It is a prime number, so that objects in rows, whose indices often are a
/// power of two or of ten apart, do not take each other's.
const SLOTS: usize = 4093;

/// Objects in one precision, each prepared when it is first asked for and kept, of many until another takes its place.
///
/// To prepare an object takes far longer than to ask it; but where one sample point is in doubt, those beside it often are, about the same
/// objects. However many a scene has, only so many take memory.
#[derive(Debug)]
pub enum Kept<T: Real> {
    /// No places: each object is prepared each time.
    None,
    /// A place for each object, which threads read without waiting for each other.
    All(Vec<OnceLock<Object<T>>>),
    /// Places that several objects share.
    Last(Vec<CacheSlot<T>>),
}

type CacheSlot<T> = Mutex<Option<Arc<Prepared<T>>>>;

/// An object that was prepared.
#[derive(Debug)]
pub struct Prepared<T: Real> {
    /// Its index in the file.
    index: usize,
    object: Object<T>,
}

/// An object that stays where it is, or one that was prepared and is kept for as long as it is held.
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
        match objects <= SLOTS {
            true => Self::All((0..objects).map(|_| OnceLock::new()).collect()),
            false => Self::Last((0..SLOTS).map(|_| Mutex::default()).collect()),
        }
    }

    /// The object with an index.
    pub fn object(&self, index: usize, prepare: impl FnOnce() -> Object<T>) -> Held<'_, T> {
        let made = |object| Arc::new(Prepared { index, object });
        let places = match self {
            Self::None => return Held::Shared(made(prepare())),
            Self::All(places) => return Held::Always(places[index].get_or_init(prepare)),
            Self::Last(places) => places,
        };
        let place = &places[index % SLOTS];
        let kept = lock(place).clone();
        if let Some(kept) = kept
            && kept.index == index
        {
            return Held::Shared(kept);
        }
        // Not while others wait for the place; two threads that want the same object may both prepare it.
        let prepared = made(prepare());
        *lock(place) = Some(prepared.clone());
        Held::Shared(prepared)
    }

    /// How many there are.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        match self {
            Self::None => 0,
            Self::All(places) => places.iter().filter(|place| place.get().is_some()).count(),
            Self::Last(places) => places.iter().filter(|place| lock(place).is_some()).count(),
        }
    }
}

/// What is in a place is whole even if a thread has panicked: it is put there in one step.
fn lock<T>(place: &Mutex<T>) -> MutexGuard<'_, T> {
    place.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often an object is prepared when it is asked for.
    fn times(kept: &Kept<f64>, index: usize) -> usize {
        let mut times = 0;
        kept.object(index, || {
            times += 1;
            Object::EdgeOn
        });
        times
    }

    #[test]
    fn an_object_is_prepared_once_until_another_takes_its_place() {
        let kept = Kept::new(3 * SLOTS);
        let asked = |index| times(&kept, index);
        assert_eq!([1, 2, 1, 2].map(asked), [1, 1, 0, 0]);
        assert_eq!([SLOTS + 1, 1, 1, 2].map(asked), [1, 1, 0, 0]);
        assert_eq!(kept.len(), 2);
    }

    #[test]
    fn objects_that_are_few_all_have_places() {
        let kept = Kept::new(3);
        let asked = |index| times(&kept, index);
        assert_eq!([0, 1, 2, 0, 1, 2].map(asked), [1, 1, 1, 0, 0, 0]);
        assert_eq!(kept.len(), 3);
        assert_eq!([7, 7].map(|index| times(&Kept::None, index)), [1, 1]);
    }
}
