//! The scene prepared for one picture, and the nearest surface at a point of it.

use std::{cmp::Ordering, collections::HashMap, ops::Deref, sync::OnceLock};

use glam::{DVec2, DVec3};
use rayon::{ThreadPool, ThreadPoolBuilder, prelude::*};

use super::{
    camera::{Basis, Camera, Direction, Point},
    crossing::{Crossing, Part},
    form::Form,
    hierarchy::{Grid, Hierarchy, Item, Nearness},
    object::Object,
    outlook::Live,
    sphere::Sphere,
};
use crate::{
    color::Color,
    math::{Ball, Ball3, Big, Double, Doubt, Real},
    scene::{self, Scene, Shape},
};

/// The scene prepared for one picture: made once, then asked at any sample point from any thread.
#[derive(Debug)]
pub struct World {
    basis: Basis,
    /// What the objects are prepared from.
    numbers: Vec<Numbers>,
    /// The objects for `f64`.
    objects: Vec<Object<f64>>,
    pub(super) hierarchy: Hierarchy,
    pub(super) fast: Frame<f64>,
    double: Frame<Double>,
    big: Frame<Big>,
    colors: Colors,
}

/// The numbers of the scene that an object is prepared from.
#[derive(Debug)]
enum Numbers {
    /// A sphere's centre and radius.
    Sphere(DVec3, f64),
    /// All of any other shape.
    Other(Box<Shape>),
}

/// The colours of the objects.
#[derive(Debug)]
struct Colors {
    /// The distinct ones, and the background.
    palette: Vec<Color>,
    /// The distinct pairs of slots of the palette: an object's colour, and a checkerboard's second one.
    pairs: Vec<[usize; 2]>,
    /// For each object its pair.
    of_objects: Vec<u32>,
}

/// The camera and some objects in one precision.
#[derive(Debug)]
pub(super) struct Frame<T: Real> {
    pub camera: Camera<T>,
    /// The first objects, each filled in when it is first asked for.
    kept: Vec<OnceLock<Box<Object<T>>>>,
    pub near: Option<Form<T>>,
    pub far: Option<Form<T>>,
}

/// The precisions, as what may be asked for by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// `f64` alone: may be in doubt.
    Single,
    /// Double-double alone: may be in doubt.
    Double,
    /// Big numbers: decides everything.
    Big,
}

/// What is seen at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Seen {
    object: usize,
    /// Whether it is the object's second crossing, the first being nearer than the near plane.
    second: bool,
    /// Whether it is a checkerboard's second colour.
    odd: bool,
}

/// The nearest crossing so far.
#[derive(Debug)]
struct Nearest<T: Real> {
    object: usize,
    /// Whether it is the object's second one.
    second: bool,
    crossing: Crossing<T>,
}

/// So many objects are kept in the higher precisions once they were asked for: all that people write by hand. Others are prepared each time,
/// which costs little beside what is done with them, and so take no memory.
const KEPT: usize = 1 << 12;

/// With fewer objects it takes no longer to prepare them than to start threads for it.
const MANY: usize = 1 << 10;

/// A crossing of a ray with a surface, for people: numbers are right to the last bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The object's index in the file.
    pub object: usize,
    /// The distance from the eye, in metres.
    pub t: f64,
    /// The distance along the view direction, in metres.
    pub depth: f64,
    /// The point, in the world.
    pub point: DVec3,
    /// The colour there.
    pub color: Color,
    /// Whether it is the one that is seen.
    pub visible: bool,
}

impl World {
    /// Prepares a scene for the sample points of its picture.
    pub fn new(scene: &Scene) -> Self {
        let size = DVec2::new(f64::from(scene.image.width), f64::from(scene.image.height));
        Self::reaching(scene, size / 2.0)
    }

    /// Prepares a scene for the points of its picture plane at most `reach` pixels from the picture's centre.
    pub fn reaching(scene: &Scene, reach: DVec2) -> Self {
        let basis = Basis::new(&scene.camera, &scene.image);
        let few = scene.objects.len().min(KEPT);
        let double = Frame::new(&basis, scene, reach, few);
        let fast = Frame::new(&basis, scene, reach, 0);
        let grid = Grid::new(&fast.camera.window);
        let prepare = |(index, object): (usize, &scene::Object)| {
            let (object, extent) = Object::with_extent(&double.camera, &fast.camera, &object.shape);
            (object, extent.and_then(|extent| grid.item(index, &extent)))
        };
        let threads = threads_for(scene.objects.len());
        let (mut objects, mut items) = (Vec::new(), Vec::new());
        match &threads {
            Some(threads) => threads.install(|| {
                let prepared = scene.objects.par_iter().enumerate().map(prepare);
                prepared.unzip_into_vecs(&mut objects, &mut items);
            }),
            None => (objects, items) = scene.objects.iter().enumerate().map(prepare).unzip(),
        }
        let items: Vec<Item> = items.into_iter().flatten().collect();
        Self {
            big: Frame::new(&basis, scene, reach, few),
            basis,
            numbers: scene.objects.iter().map(Numbers::new).collect(),
            objects,
            hierarchy: Hierarchy::new(grid, items, threads.as_ref()),
            fast,
            double,
            colors: Colors::new(scene),
        }
    }

    /// The camera's axes.
    pub fn basis(&self) -> &Basis {
        &self.basis
    }

    /// The distinct colours that can be seen: the objects' in the order of the file, the background last.
    pub fn palette(&self) -> &[Color] {
        &self.colors.palette
    }

    /// Which colour of the palette is seen at a sample point: the pixel in column `x` and row `y` from the top left, and
    /// the offset from that pixel's centre, x to the right and y down, each in [−1/2, 1/2).
    #[inline]
    pub fn slot_at(&self, x: u32, y: u32, offset: DVec2) -> usize {
        let point = self.fast.camera.sample_point(x, y, offset);
        match self.seen_fast(&point) {
            Ok(seen) => self.slot(seen),
            Err(Doubt) => self.slot(self.seen_after_doubt(&point)),
        }
    }

    /// What [`slot_at`](World::slot_at) answers where some objects, in file order, are all that may be seen.
    pub fn slot_among<'a>(
        &self,
        x: u32,
        y: u32,
        offset: DVec2,
        among: impl Iterator<Item = &'a Live> + Clone,
    ) -> usize {
        let point = self.fast.camera.sample_point(x, y, offset);
        let among = || among.clone().map(|live| live.object);
        let seen = self.seen_among::<f64>(&point, among());
        let seen = seen.or_else(|Doubt| self.seen_among::<Double>(&point, among()));
        let seen = seen.or_else(|Doubt| self.seen_among::<Big>(&point, among()));
        // The last precision is never in doubt.
        self.slot(seen.unwrap_or_default())
    }

    /// What [`slot_at`](World::slot_at) answers in one precision alone and without the hierarchy, or `None` if that is in doubt.
    pub fn slot_in(&self, precision: Precision, x: u32, y: u32, offset: DVec2) -> Option<usize> {
        let point = self.fast.camera.sample_point(x, y, offset);
        let seen = match precision {
            Precision::Single => self.seen::<f64>(&point),
            Precision::Double => self.seen::<Double>(&point),
            Precision::Big => self.seen::<Big>(&point),
        };
        seen.ok().map(|seen| self.slot(seen))
    }

    /// The slots of the palette that an object's colour has, and a checkerboard's second one.
    pub fn slots(&self, object: usize) -> [usize; 2] {
        self.colors.pairs[self.colors.of_objects[object] as usize]
    }

    /// The slot of the background's colour.
    pub fn background(&self) -> usize {
        self.palette().len() - 1
    }

    /// How many objects there are.
    pub fn len(&self) -> usize {
        self.objects.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.objects.is_empty()
    }

    /// The ray through a point of the picture plane, in pixels from the picture's top left corner: its direction, of length
    /// 1, and all its crossings in front of the eye, the nearest first, equal ones in file order. The point must lie within
    /// the reach that the world was made for.
    pub fn ray(&self, pixels: DVec2) -> (DVec3, Vec<Hit>) {
        let camera = &self.big.camera;
        let point = camera.picture_point(pixels);
        let r = camera.direction(&point);
        let candidates = self.candidates(&point);
        let mut crossings = Vec::new();
        for &index in &candidates {
            let object = Big::object(self, index);
            let first = object.first(&r).unwrap_or_default();
            let second = first.as_ref().and_then(|_| object.second(&r));
            crossings.extend(first.map(|crossing| (index, false, crossing)));
            crossings.extend(second.map(|crossing| (index, true, crossing)));
        }
        self.sort(&mut crossings);

        let among = candidates.iter().copied();
        let seen = self.seen_in_direction(&r, among).unwrap_or_default();
        let along = [&r.x, &r.y, &r.z].map(rounded);
        let world: Ball3<Big> = [0, 1, 2].map(|i| {
            let part = |j: usize| &camera.axes[j][i] * &along[j];
            part(0) + part(1) + part(2)
        });
        let length = rounded(&r.square).sqrt();
        let direction = world.each_ref().map(|x| settled(&(x / &length))).into();
        let hit = |(index, second, crossing): (usize, bool, Crossing<Big>)| {
            let lambda = Ball::exact(1.0) / &crossing.inverse_depth;
            let lambda = lambda.scaled(-camera.exponent);
            let coordinate =
                |i: usize| settled(&(Ball::exact(camera.eye[i]) + &lambda * &world[i]));
            let odd = Big::object(self, index).is_odd(&r).unwrap_or_default();
            Hit {
                object: index,
                t: settled(&(&lambda * &length)),
                depth: settled(&(&lambda * &along[2])),
                point: [0, 1, 2].map(coordinate).into(),
                color: self.palette()[self.slots(index)[usize::from(odd)]],
                visible: seen.is_some_and(|seen| seen.object == index && seen.second == second),
            }
        };
        (direction, crossings.into_iter().map(hit).collect())
    }

    /// Sorts by depth; what cannot be told apart stands in file order.
    fn sort(&self, crossings: &mut [(usize, bool, Crossing<Big>)]) {
        // First by the computed depths, which is an order; then by pairs, as the tracer compares them.
        crossings.sort_by(|(.., a), (.., b)| {
            let difference = b.inverse_depth.mid.minus(&a.inverse_depth.mid);
            difference.to_f64().total_cmp(&0.0)
        });
        for end in 1..crossings.len() {
            let mut at = end;
            while at > 0 {
                let ((i, _, a), (j, _, b)) = (&crossings[at - 1], &crossings[at]);
                if i <= j || self.order((*i, a), (*j, b)) != Ok(Ordering::Equal) {
                    break;
                }
                crossings.swap(at - 1, at);
                at -= 1;
            }
        }
    }

    /// What is seen as far as `f64` can tell, by way of the hierarchy.
    #[inline]
    fn seen_fast(&self, point: &Point) -> Result<Option<Seen>, Doubt> {
        let r = self.fast.camera.direction(point);
        let Some(mut descent) = self.hierarchy.at(&r) else {
            return self.seen::<f64>(point);
        };
        let mut nearest = None;
        // All farther than this is hidden.
        let mut bar = Nearness::NONE;
        while let Some(mut list) = descent.next(bar) {
            while let Some(index) = list.next(bar) {
                if self.meet(&r, index, &mut nearest)?
                    && let Some(Nearest { crossing, .. }) = &nearest
                {
                    bar = Nearness::below(crossing.inverse_depth.mid - crossing.inverse_depth.rad);
                }
            }
        }
        self.with_color(&r, nearest)
    }

    #[cfg(test)]
    pub(super) fn double_camera(&self) -> &Camera<Double> {
        &self.double.camera
    }

    /// How much memory it takes by object, spheres alone being in it and none of them kept in a higher precision.
    #[cfg(test)]
    pub(super) fn bytes_per_object(&self) -> f64 {
        let each = size_of::<Object<f64>>() + size_of::<Numbers>() + size_of::<u32>();
        each as f64 + self.hierarchy.bytes() as f64 / self.len() as f64
    }

    /// What is seen where `f64` was in doubt.
    #[cold]
    fn seen_after_doubt(&self, point: &Point) -> Option<Seen> {
        let candidates = self.candidates(point);
        let among = || candidates.iter().copied();
        let r = self.double.camera.direction(point);
        match self.seen_in_direction(&r, among()) {
            Ok(seen) => seen,
            // The last precision is never in doubt.
            Err(Doubt) => {
                let r = self.big.camera.direction(point);
                self.seen_in_direction(&r, among()).unwrap_or_default()
            }
        }
    }

    /// The objects that the ray through a point may meet, in file order.
    pub(super) fn candidates(&self, point: &Point) -> Vec<usize> {
        let r = self.fast.camera.direction(point);
        let Some(mut descent) = self.hierarchy.at(&r) else {
            return (0..self.len()).collect();
        };
        let mut candidates = Vec::new();
        while let Some(mut list) = descent.next(Nearness::NONE) {
            candidates.extend(std::iter::from_fn(|| list.next(Nearness::NONE)));
        }
        candidates.sort_unstable();
        candidates
    }

    fn seen<T: Level>(&self, point: &Point) -> Result<Option<Seen>, Doubt> {
        let r = T::frame(self).camera.direction(point);
        self.seen_in_direction(&r, 0..self.len())
    }

    #[inline]
    fn seen_among<T: Level>(
        &self,
        point: &Point,
        among: impl Iterator<Item = usize>,
    ) -> Result<Option<Seen>, Doubt> {
        let r = T::frame(self).camera.direction(point);
        self.seen_in_direction(&r, among)
    }

    /// Of some objects, in file order, the nearest crossing between the near and the far plane; of equal ones the first object's.
    #[inline]
    fn seen_in_direction<T: Level>(
        &self,
        r: &Direction<T>,
        among: impl Iterator<Item = usize>,
    ) -> Result<Option<Seen>, Doubt> {
        let nearest = self.nearest_crossing(r, among)?;
        self.with_color(r, nearest)
    }

    /// Adds which of an object's colours is seen.
    #[inline]
    fn with_color<T: Level>(
        &self,
        r: &Direction<T>,
        nearest: Option<Nearest<T>>,
    ) -> Result<Option<Seen>, Doubt> {
        let Some(Nearest { object, second, .. }) = nearest else {
            return Ok(None);
        };
        let odd = T::object(self, object).is_odd(r)?;
        Ok(Some(Seen {
            object,
            second,
            odd,
        }))
    }

    /// Of some objects, in file order, the one with the nearest crossing, and whether that is its second one.
    #[inline]
    pub(super) fn nearest<T: Level>(
        &self,
        r: &Direction<T>,
        among: impl Iterator<Item = usize>,
    ) -> Result<Option<(usize, bool)>, Doubt> {
        let nearest = self.nearest_crossing(r, among)?;
        Ok(nearest.map(|nearest| (nearest.object, nearest.second)))
    }

    #[inline]
    fn nearest_crossing<T: Level>(
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

    /// Whether an object's crossing is nearer than the nearest so far, in whose place it is put then; of equal ones that of the object
    /// which comes first in the file is.
    #[inline]
    fn meet<T: Level>(
        &self,
        r: &Direction<T>,
        index: usize,
        nearest: &mut Option<Nearest<T>>,
    ) -> Result<bool, Doubt> {
        let object = T::object(self, index);
        let Some(first) = object.first(r)? else {
            return Ok(false);
        };
        let Some((second, crossing)) = self.clip(index, first, &object, r)? else {
            return Ok(false);
        };
        if let Some(best) = nearest {
            match self.order((index, &crossing), (best.object, &best.crossing))? {
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

    /// The first of an object's crossings that lies between the near and the far plane, and whether it is the second one.
    #[inline]
    fn clip<T: Level>(
        &self,
        index: usize,
        first: Crossing<T>,
        object: &Object<T>,
        r: &Direction<T>,
    ) -> Result<Option<(bool, Crossing<T>)>, Doubt> {
        let frame = T::frame(self);
        let mut chosen = (false, first);
        if let Some(near) = &frame.near
            && self.order_to_clip(index, &chosen.1, near, r)? != Ordering::Less
        {
            let Some(second) = object.second(r) else {
                return Ok(None);
            };
            if self.order_to_clip(index, &second, near, r)? != Ordering::Less {
                return Ok(None);
            }
            chosen = (true, second);
        }
        if let Some(far) = &frame.far
            && self.order_to_clip(index, &chosen.1, far, r)? != Ordering::Greater
        {
            return Ok(None);
        }
        Ok(Some(chosen))
    }

    /// Compares the inverse depths of two crossings. Those of one surface are equal, whatever their computed values.
    #[inline]
    fn order<T: Real>(
        &self,
        (i, a): (usize, &Crossing<T>),
        (j, b): (usize, &Crossing<T>),
    ) -> Result<Ordering, Doubt> {
        let order = a.inverse_depth.compare(&b.inverse_depth);
        match order {
            Err(Doubt) if self.is_same_surface((i, a.part), (j, b.part)) => Ok(Ordering::Equal),
            _ => order,
        }
    }

    /// Compares the inverse depth of a crossing with that of the near or the far plane.
    #[inline]
    fn order_to_clip<T: Real>(
        &self,
        index: usize,
        crossing: &Crossing<T>,
        clip: &Form<T>,
        r: &Direction<T>,
    ) -> Result<Ordering, Doubt> {
        let order = crossing.inverse_depth.compare(&clip.at(r));
        if order.is_ok() {
            return order;
        }
        let clips = [&self.double.near, &self.double.far];
        let object = Double::object(self, index);
        let plane = object.plane(crossing.part);
        let same = |clip: &&Option<Form<Double>>| match (plane, clip) {
            (Some(plane), Some(clip)) => plane.equals(clip),
            _ => false,
        };
        // A surface that lies in one of the two planes and is in doubt about the other would need them to be equal.
        if clips.iter().any(same) {
            return Ok(Ordering::Equal);
        }
        order
    }

    /// Whether two parts of objects are one surface: planes with the same form, or the same side of equal spheres.
    #[cold]
    fn is_same_surface(&self, (i, a): (usize, Part), (j, b): (usize, Part)) -> bool {
        match (&self.numbers[i], &self.numbers[j]) {
            (Numbers::Sphere(center, radius), Numbers::Sphere(other_center, other_radius)) => {
                a == b && center == other_center && radius == other_radius
            }
            _ => {
                let (first, second) = (Double::object(self, i), Double::object(self, j));
                match (first.plane(a), second.plane(b)) {
                    (Some(a), Some(b)) => a.equals(b),
                    _ => false,
                }
            }
        }
    }

    #[inline]
    fn slot(&self, seen: Option<Seen>) -> usize {
        match seen {
            None => self.background(),
            Some(seen) => self.slots(seen.object)[usize::from(seen.odd)],
        }
    }
}

impl<T: Real> Frame<T> {
    fn new(basis: &Basis, scene: &Scene, reach: DVec2, kept: usize) -> Self {
        let scene::Camera { near, far, .. } = scene.camera;
        let camera = Camera::new(basis, scene, reach);
        // A point λr has the depth λZ, so its inverse depth 1/λ at the depth n is Z/n.
        let clip = |depth: f64| {
            let zero = Ball::exact(0.0);
            let inverse = Ball::exact(1.0) / camera.length(depth);
            Form::new(&camera, &[zero.clone(), zero, inverse])
        };
        Self {
            near: (near > 0.0).then(|| clip(near)),
            far: far.map(clip),
            kept: (0..kept).map(|_| OnceLock::new()).collect(),
            camera,
        }
    }
}

/// A precision that the world is held in.
pub(super) trait Level: Real {
    fn frame(world: &World) -> &Frame<Self>;

    /// An object in this precision, prepared when it is asked for.
    fn object(world: &World, index: usize) -> Held<'_, Self> {
        let Frame { camera, kept, .. } = Self::frame(world);
        let made = || Box::new(world.numbers[index].object(camera));
        match kept.get(index) {
            Some(kept) => Held::Kept(kept.get_or_init(made)),
            None => Held::Made(made()),
        }
    }
}

/// An object that is kept, or was made for the one who asks.
#[derive(Debug)]
pub(super) enum Held<'a, T: Real> {
    Kept(&'a Object<T>),
    Made(Box<Object<T>>),
}

impl<T: Real> Deref for Held<'_, T> {
    type Target = Object<T>;

    #[inline]
    fn deref(&self) -> &Object<T> {
        match self {
            Self::Kept(object) => object,
            Self::Made(object) => object,
        }
    }
}

impl Numbers {
    fn new(object: &scene::Object) -> Self {
        match &object.shape {
            Shape::Sphere(sphere) => Self::Sphere(sphere.center, sphere.radius),
            other => Self::Other(Box::new(*other)),
        }
    }

    /// The object in one precision.
    fn object<T: Real>(&self, camera: &Camera<T>) -> Object<T> {
        match self {
            Self::Sphere(center, radius) => Object::Sphere(Sphere::new(camera, *center, *radius)),
            Self::Other(shape) => Object::new(camera, shape),
        }
    }
}

impl Level for f64 {
    #[inline]
    fn frame(world: &World) -> &Frame<Self> {
        &world.fast
    }

    #[inline]
    fn object(world: &World, index: usize) -> Held<'_, Self> {
        Held::Kept(&world.objects[index])
    }
}

impl Level for Double {
    fn frame(world: &World) -> &Frame<Self> {
        &world.double
    }
}

impl Level for Big {
    fn frame(world: &World) -> &Frame<Self> {
        &world.big
    }
}

/// A coordinate or the square of a ray's direction, with what its few roundings may have cost.
fn rounded(x: &Big) -> Ball<Big> {
    Ball {
        rad: x.magnitude() * (32.0 * Big::UNIT),
        mid: x.clone(),
    }
}

/// Threads to prepare so many objects; none if they are few, or if the system starts none.
fn threads_for(objects: usize) -> Option<ThreadPool> {
    (objects >= MANY)
        .then(|| ThreadPoolBuilder::new().build().ok())
        .flatten()
}

/// The nearest `f64`, and 0 for what cannot be told from it: a point on the plane y = 0 has no height of 1e-97.
fn settled(x: &Ball<Big>) -> f64 {
    match x.sign() {
        Ok(Ordering::Equal) => 0.0,
        _ => x.mid.to_finite(),
    }
}

impl Colors {
    /// The distinct colours of all objects in file order with the background behind them, and the places of the objects' among them.
    fn new(scene: &Scene) -> Self {
        let mut palette = Vec::new();
        let mut places = HashMap::new();
        let mut place = |color: Color| {
            *places
                .entry(color.srgb.map(f64::to_bits))
                .or_insert_with(|| {
                    palette.push(color);
                    palette.len() - 1
                })
        };
        let mut pairs = Vec::new();
        let mut places_of_pairs = HashMap::new();
        let pair = |object: &scene::Object| {
            let pair = match object.shape {
                Shape::Sphere(scene::Sphere { color, .. })
                | Shape::Triangle(scene::Triangle { color, .. })
                | Shape::Box(scene::Cuboid { color, .. }) => [place(color); 2],
                Shape::Checkerboard(scene::Checkerboard { colors, .. }) => colors.map(&mut place),
            };
            *places_of_pairs.entry(pair).or_insert_with(|| {
                pairs.push(pair);
                // No more than objects.
                (pairs.len() - 1) as u32
            })
        };
        let of_objects = scene.objects.iter().map(pair).collect();
        palette.push(scene.image.background);
        Self {
            palette,
            pairs,
            of_objects,
        }
    }
}
