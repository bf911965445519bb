//! The scene prepared for one picture, and the nearest surface at a point of the picture.
//!
//! In: a scene, and then sample points. Out: the colour that is seen at a point, as an index into
//! the palette. A ray is tested against the objects that the quadtree lists for it, or against
//! given nearby objects. If rounding errors leave a decision uncertain in `f64`, it is made in
//! double-double, and if it is still uncertain, in the highest precision, big numbers.

mod colors;
pub(super) mod depth_order;
mod precise_cache;
mod precision;
mod prepare;

pub(crate) use self::{
    precise_cache::{CACHE_SLOTS, ObjectRef},
    precision::{Geometry, Precision},
};

use std::{cmp::Ordering, convert::Infallible, fmt, sync::atomic::AtomicBool};

use glam::DVec2;

use self::{colors::Colors, precision::first_certain, prepare::prepare};
use super::{
    camera::{Basis, Direction, PicturePoint},
    crossing::Crossing,
    object::Object,
    pieces::{Faces, Pieces},
    quadtree::{BoundedObject, Nearness, Quadtree},
};
use crate::{
    area::Area,
    cancel::{self, Cancelled},
    color::Color,
    diagnostic::Mistakes,
    math::{Doubt, Real},
    scene::Scene,
};

/// The scene prepared for one picture. It is built once and can then be queried at any sample point
/// from any thread.
pub struct World {
    basis: Basis,
    pub(crate) geometry: Geometry,
    pub(super) quadtree: Quadtree,
    colors: Colors,
    pieces: Pieces,
}

/// The crossing that is seen at a point of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct VisibleCrossing {
    pub(super) object: usize,
    /// Whether the ray's second crossing with the object is seen, because the near plane cuts off
    /// the first crossing.
    pub(super) second: bool,
    /// Whether the crossing shows a checkerboard's second colour.
    odd: bool,
}

/// The nearest crossing of a ray found so far.
#[derive(Debug)]
struct Nearest<T: Real> {
    object: usize,
    /// Whether the crossing is the ray's second one with the object.
    second: bool,
    crossing: Crossing<T>,
}

/// Writes the picture's area, the number of objects and the palette.
impl fmt::Debug for World {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = f.debug_struct("World");
        fields.field("picture", &self.picture());
        fields.field("objects", &self.object_count());
        fields
            .field("palette", &self.palette())
            .finish_non_exhaustive()
    }
}

impl World {
    /// Checks a scene that was made or changed in code, and prepares it for the sample points of
    /// its picture.
    ///
    /// # Errors
    ///
    /// Fails if a condition of the language is broken, for example if a radius is not greater than
    /// 0.
    pub fn try_new(scene: &Scene) -> Result<Self, Mistakes> {
        scene.check()?;
        Ok(Self::new(scene))
    }

    /// Prepares a scene for the sample points of its picture. The scene must have been read from a
    /// file, or must fulfil the conditions of the language; [`try_new`](Self::try_new) checks them.
    ///
    /// # Panics
    ///
    /// If a condition of the language is broken, this function may panic, or the picture may be
    /// wrong.
    pub fn new(scene: &Scene) -> Self {
        Self::build(scene, Faces::Seen, reach(scene), &cancel::NEVER)
    }

    /// Prepares a scene for the sample points of its picture. Stops soon after the flag `cancel` is
    /// set.
    ///
    /// # Errors
    ///
    /// Fails if the flag is set.
    ///
    /// # Panics
    ///
    /// May panic if a condition of the language is broken, like [`new`](Self::new).
    pub fn new_unless(scene: &Scene, cancel: &AtomicBool) -> Result<Self, Cancelled> {
        let world = Self::build(scene, Faces::Seen, reach(scene), cancel);
        cancel::unless_set(cancel, world)
    }

    /// Prepares a scene as [`new`](Self::new) does, for [`ray`](super::ray()), which returns all
    /// crossings of a ray. Rays must go through points of the picture plane that are at most
    /// `reach` pixels from the picture's centre in x and y.
    pub fn for_rays(scene: &Scene, reach: DVec2) -> Self {
        Self::build(scene, Faces::All, reach, &cancel::NEVER)
    }

    /// Prepares a scene as [`new`](Self::new) does, but as if each object, even a checkerboard, had
    /// one colour of its own. The palette index of this colour is the object's index in the file.
    pub fn by_object(scene: &Scene) -> Self {
        let mut world = Self::new(scene);
        let pieces = 0..world.object_count();
        world.colors = Colors::by_object(pieces.map(|piece| world.owner(piece)));
        world
    }

    /// Prepares a scene as [`new`](Self::new) does, but as if each surface had one colour of its
    /// own. A surface is an object, even a checkerboard, or a coloured face of a box.
    #[doc(hidden)]
    pub fn by_surface(scene: &Scene) -> Self {
        let mut world = Self::new(scene);
        world.colors = Colors::by_object(0..world.object_count());
        world
    }

    fn build(scene: &Scene, faces: Faces, reach: DVec2, cancel: &AtomicBool) -> Self {
        let basis = Basis::new(&scene.camera, &scene.image);
        let (scene, pieces) = Pieces::of(scene, faces);
        let (geometry, quadtree) = prepare(&scene, &pieces, &basis, reach, cancel);
        let objects = &scene.objects[..geometry.numbers.len()];
        Self {
            colors: Colors::new(objects, scene.image.background),
            basis,
            geometry,
            quadtree,
            pieces,
        }
    }

    /// Returns the camera's axes and scale.
    pub fn basis(&self) -> &Basis {
        &self.basis
    }

    /// Returns the area of all pixels of the picture.
    pub fn picture(&self) -> Area {
        let half = self.geometry.fast.camera.half;
        Area::whole((2.0 * half.x) as u32, (2.0 * half.y) as u32)
    }

    /// Returns the distinct colours that can be seen: those of the objects in file order, then the
    /// background.
    pub fn palette(&self) -> &[Color] {
        &self.colors.palette
    }

    /// Returns the palette index of the colour that is seen at a sample point. The point lies in
    /// the pixel in column `x` and row `y`, at `offset` from the pixel's centre in pixels, x to the
    /// right and y down, each in [−1/2, 1/2). For a point outside of the picture, the answer may be
    /// wrong.
    #[inline]
    pub fn color_index_at(&self, x: u32, y: u32, offset: DVec2) -> usize {
        self.color_index_near(x, y, offset, None)
    }

    /// Returns the palette index of the colour that is seen at a sample point, as
    /// [`color_index_at`](World::color_index_at) does. The search is faster if `nearby` contains
    /// the objects near the point, as [`nearby`](super::nearby) returns them.
    #[inline]
    pub(crate) fn color_index_near(
        &self,
        x: u32,
        y: u32,
        offset: DVec2,
        nearby: Option<&[BoundedObject]>,
    ) -> usize {
        let point = self.geometry.fast.camera.sample_point(x, y, offset);
        match self.seen_fast(&point, nearby) {
            Ok(seen) => self.color_index(seen),
            Err(Doubt) => self.color_index_after_doubt(&point),
        }
    }

    /// Returns the index in the file of the object that is seen at the centre of a pixel. Returns
    /// `None` for the background, and for a pixel outside of the picture.
    pub fn object_at(&self, x: u32, y: u32) -> Option<usize> {
        if !Area::pixel(x, y).lies_in(self.picture()) {
            return None;
        }
        let point = self.geometry.fast.camera.sample_point(x, y, DVec2::ZERO);
        let seen = match self.seen_fast(&point, None) {
            Ok(seen) => seen.map(|seen| seen.object),
            Err(Doubt) => {
                let among = self.candidates(&point);
                self.object_among(&point, among.iter().copied()).0
            }
        };
        seen.map(|piece| self.owner(piece))
    }

    /// Returns the index in the file of the object to which a prepared object belongs. A prepared
    /// object is a whole object of the file, or one face of a box.
    pub(super) fn owner(&self, piece: usize) -> usize {
        self.pieces.owner(piece)
    }

    /// Returns the palette index of the colour that would be seen at a sample point if the scene
    /// consisted only of the objects `among`, which are in file order. The other parameters are
    /// those of [`color_index_at`](World::color_index_at).
    pub fn color_index_among(
        &self,
        x: u32,
        y: u32,
        offset: DVec2,
        among: impl Iterator<Item = usize> + Clone,
    ) -> usize {
        let point = self.geometry.fast.camera.sample_point(x, y, offset);
        self.color_index_of(&point, among)
    }

    fn color_index_of(
        &self,
        point: &PicturePoint,
        among: impl Iterator<Item = usize> + Clone,
    ) -> usize {
        let among = || among.clone();
        let (mut seen, is_sure) = first_certain!(&self.geometry, point, |r| self.seen(r, among()));
        if !is_sure {
            // The lower precisions were uncertain, so the highest precision has decided. If it
            // cannot distinguish a ray from one that hits an object, it counts the ray as a hit,
            // even outside of the object's bounds in the quadtree. Some callers pass only objects
            // whose bounds contain the ray, and others pass all objects. To give all callers the
            // same answer, objects whose bounds do not contain the ray are left out.
            let near = self.candidates(point);
            let is_near = |object: &usize| near.binary_search(object).is_ok();
            if !among().all(|object| is_near(&object)) {
                let among = || among().filter(is_near);
                (seen, _) = first_certain!(&self.geometry, point, |r| self.seen(r, among()));
            }
        }
        self.color_index(seen)
    }

    /// Returns which of the objects `among`, which are in file order, is seen at a point (`None`
    /// for the background), and whether the answer is certain. An uncertain answer was decided in
    /// the highest precision.
    pub(super) fn object_among(
        &self,
        point: &PicturePoint,
        among: impl Iterator<Item = usize> + Clone,
    ) -> (Option<usize>, bool) {
        let among = || among.clone();
        let (nearest, is_sure) = first_certain!(&self.geometry, point, |r| {
            let nearest = self.nearest(r, among());
            nearest.map(|nearest| nearest.map(|nearest| nearest.object))
        });
        (nearest, is_sure)
    }

    /// Returns the palette indices of an object's two colours. They are equal unless the object is
    /// a checkerboard.
    ///
    /// # Panics
    ///
    /// Panics if there is no such object: `object` must be less than
    /// [`object_count`](Self::object_count).
    pub fn color_indices(&self, object: usize) -> [usize; 2] {
        self.colors.of_objects[object].map(|color_index| color_index as usize)
    }

    /// Returns the palette index of the background.
    pub fn background(&self) -> usize {
        self.palette().len() - 1
    }

    /// Returns the number of objects. Each face of a box with coloured faces is an object of its
    /// own.
    pub fn object_count(&self) -> usize {
        self.geometry.objects.len()
    }

    /// Returns the crossing that is seen at a point. Tests the objects `nearby` if they are given,
    /// otherwise those that the quadtree lists for the ray. Returns `None` if the ray hits no
    /// object. Fails if rounding errors leave a decision uncertain in `f64`.
    #[inline]
    fn seen_fast(
        &self,
        point: &PicturePoint,
        nearby: Option<&[BoundedObject]>,
    ) -> Result<Option<VisibleCrossing>, Doubt> {
        let r = self.geometry.fast.camera.direction(point);
        let mut nearest = None;
        // Rounded inverse depth of the nearest crossing so far. Objects entirely behind this depth
        // are hidden.
        let mut hidden = Nearness::NONE;
        let visit = |index| {
            if self.meet(&r, index, &mut nearest)?
                && let Some(Nearest { crossing, .. }) = &nearest
            {
                hidden = Nearness::below(crossing.inverse_depth.mid - crossing.inverse_depth.rad);
            }
            Ok(hidden)
        };
        let visited = match nearby {
            Some(nearby) => self.quadtree.visit_nearby(&r, nearby, visit),
            None => self.quadtree.visit(&r, visit),
        };
        visited.ok_or(Doubt)??;
        self.with_color(&r, nearest)
    }

    #[cold]
    fn color_index_after_doubt(&self, point: &PicturePoint) -> usize {
        self.color_index_of(point, self.candidates(point).iter().copied())
    }

    /// Returns the objects that the ray through a point may hit, in file order.
    pub(super) fn candidates(&self, point: &PicturePoint) -> Vec<usize> {
        let r = self.geometry.fast.camera.direction(point);
        let mut candidates = Vec::new();
        let visited = self.quadtree.visit(&r, |index| {
            candidates.push(index);
            Ok::<_, Infallible>(Nearness::NONE)
        });
        if visited.is_none() {
            return (0..self.object_count()).collect();
        }
        candidates.sort_unstable();
        candidates
    }

    /// Returns the nearest crossing of the ray with the objects `among`, which are in file order.
    /// Only crossings between the near and the far plane are considered. If several crossings have
    /// equal depths, returns that of the first object. Returns `None` if there is no crossing, and
    /// a [`Doubt`] if rounding errors leave a decision uncertain.
    #[inline]
    pub(super) fn seen<T: Precision>(
        &self,
        r: &Direction<T>,
        among: impl Iterator<Item = usize>,
    ) -> Result<Option<VisibleCrossing>, Doubt> {
        let nearest = self.nearest(r, among)?;
        self.with_color(r, nearest)
    }

    /// Completes the nearest crossing: determines which of the object's two colours the ray sees.
    /// Returns a [`Doubt`] if rounding errors leave this uncertain.
    #[inline]
    fn with_color<T: Precision>(
        &self,
        r: &Direction<T>,
        nearest: Option<Nearest<T>>,
    ) -> Result<Option<VisibleCrossing>, Doubt> {
        let Some(Nearest { object, second, .. }) = nearest else {
            return Ok(None);
        };
        let odd = T::object(&self.geometry, object).is_odd(r)?;
        Ok(Some(VisibleCrossing {
            object,
            second,
            odd,
        }))
    }

    #[inline]
    fn nearest<T: Precision>(
        &self,
        r: &Direction<T>,
        among: impl Iterator<Item = usize>,
    ) -> Result<Option<Nearest<T>>, Doubt> {
        let mut nearest = None;
        for index in among {
            self.meet(r, index, &mut nearest)?;
        }
        Ok(nearest)
    }

    /// Tests an object. If its crossing is nearer than `nearest`, or is as near and belongs to an
    /// object earlier in the file, stores the crossing in `nearest` and returns `true`. Otherwise
    /// returns `false`. Returns a [`Doubt`] if rounding errors leave the comparison uncertain.
    #[inline]
    fn meet<T: Precision>(
        &self,
        r: &Direction<T>,
        index: usize,
        nearest: &mut Option<Nearest<T>>,
    ) -> Result<bool, Doubt> {
        let object = T::object(&self.geometry, index);
        let Some(first) = object.first(r)? else {
            return Ok(false);
        };
        let Some((second, crossing)) = self.clip(index, first, &object, r)? else {
            return Ok(false);
        };
        if let Some(best) = nearest {
            match depth_order::order(
                &self.geometry,
                (index, &crossing),
                (best.object, &best.crossing),
            )? {
                Ordering::Greater => {}
                Ordering::Equal if index < best.object => {}
                _ => return Ok(false),
            }
        }
        *nearest = Some(Nearest {
            object: index,
            second,
            crossing,
        });
        Ok(true)
    }

    /// Returns the ray's nearest crossing with an object, and whether it is the second crossing.
    /// Only crossings between the near and the far plane are considered. `first` is the object's
    /// first crossing. Returns `None` if neither crossing lies between the planes, and a [`Doubt`]
    /// if rounding errors leave this uncertain.
    #[inline]
    fn clip<T: Precision>(
        &self,
        index: usize,
        first: Crossing<T>,
        object: &Object<T>,
        r: &Direction<T>,
    ) -> Result<Option<(bool, Crossing<T>)>, Doubt> {
        let frame = T::frame(&self.geometry);
        let mut chosen = (false, first);
        if let Some(near) = &frame.near
            && depth_order::order_to_clip(&self.geometry, index, &chosen.1, near, r)?
                != Ordering::Less
        {
            let Some(second) = object.second(r) else {
                return Ok(None);
            };
            if depth_order::order_to_clip(&self.geometry, index, &second, near, r)?
                != Ordering::Less
            {
                return Ok(None);
            }
            chosen = (true, second);
        }
        if let Some(far) = &frame.far
            && depth_order::order_to_clip(&self.geometry, index, &chosen.1, far, r)?
                != Ordering::Greater
        {
            return Ok(None);
        }
        Ok(Some(chosen))
    }

    #[inline]
    pub(super) fn color_index(&self, seen: Option<VisibleCrossing>) -> usize {
        match seen {
            None => self.background(),
            Some(seen) => self.color_indices(seen.object)[usize::from(seen.odd)],
        }
    }
}

/// Returns half of the picture's width and height, in pixels.
fn reach(scene: &Scene) -> DVec2 {
    DVec2::new(f64::from(scene.image.width), f64::from(scene.image.height)) / 2.0
}
