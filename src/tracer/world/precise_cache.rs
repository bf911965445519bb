//! The cache of objects in a precision higher than `f64`.
//!
//! In: an object's index, and a function that prepares the object. Out: the object, either prepared
//! now or cached from an earlier request.

use std::{
    ops::Deref,
    sync::{Arc, Mutex},
};

use crate::{lock::lock, math::Real, tracer::object::Object};

/// Maximum number of objects that a cache keeps in one precision. If a scene has more objects,
/// several objects share a slot, which keeps the one that was requested last. Scenes written by
/// hand have fewer objects. The number is prime, because the indices of neighbouring objects often
/// differ by a power of two or of ten, and such objects must not share a slot.
pub const CACHE_SLOTS: usize = 4093;

/// A cache of objects in one precision. Each object is prepared when it is first requested, and
/// kept until another object takes its slot.
///
/// Objects are cached because preparing an object takes far longer than testing a ray against it.
/// If a decision about an object is uncertain in `f64` at one sample point, it is often uncertain
/// at neighbouring points, too. The fixed number of slots bounds the memory, however many objects a
/// scene has.
#[derive(Debug)]
pub struct ObjectCache<T: Real>(Vec<Mutex<Option<Arc<CachedObject<T>>>>>);

/// A cached object.
#[derive(Debug)]
pub struct CachedObject<T: Real> {
    /// The object's index in the file.
    index: usize,
    object: Object<T>,
}

/// A reference to an object: borrowed from the world, or shared with the cache.
#[derive(Debug)]
pub enum ObjectRef<'a, T: Real> {
    Borrowed(&'a Object<T>),
    Shared(Arc<CachedObject<T>>),
}

impl<T: Real> Deref for ObjectRef<'_, T> {
    type Target = Object<T>;

    #[inline]
    fn deref(&self) -> &Object<T> {
        match self {
            Self::Borrowed(object) => object,
            Self::Shared(prepared) => &prepared.object,
        }
    }
}

impl<T: Real> ObjectCache<T> {
    /// Creates an empty cache for a scene with `objects` objects.
    pub fn new(objects: usize) -> Self {
        let slots = objects.min(CACHE_SLOTS);
        Self((0..slots).map(|_| Mutex::default()).collect())
    }

    /// Returns the object with the index `index`. Calls `prepare` if the object is not cached.
    pub fn object(&self, index: usize, prepare: impl FnOnce() -> Object<T>) -> ObjectRef<'_, T> {
        let slot = &self.0[index % self.0.len()];
        let cached = lock(slot).clone();
        if let Some(cached) = cached
            && cached.index == index
        {
            return ObjectRef::Shared(cached);
        }
        // The slot is not locked while the object is prepared, so that no thread waits. Two threads
        // that need an object at the same time may both prepare it.
        let object = prepare();
        let prepared = Arc::new(CachedObject { index, object });
        *lock(slot) = Some(prepared.clone());
        ObjectRef::Shared(prepared)
    }

    /// Returns the number of cached objects.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.0.iter().filter(|slot| lock(slot).is_some()).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracer::convex::Convex;

    #[test]
    fn an_object_is_prepared_once_until_another_takes_its_place() {
        let kept = ObjectCache::<f64>::new(3 * CACHE_SLOTS);
        let times = |index| {
            let mut times = 0;
            kept.object(index, || {
                times += 1;
                Object::Convex(Convex::nothing())
            });
            times
        };
        assert_eq!([1, 2, 1, 2].map(times), [1, 1, 0, 0]);
        assert_eq!([CACHE_SLOTS + 1, 1, 1, 2].map(times), [1, 1, 0, 0]);
        assert_eq!(kept.len(), 2);
    }
}
