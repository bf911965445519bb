//! A ray tracer by the formulas of a textbook, with the mistakes of a program as switches.
//!
//! In: a scene, the switches, a part of its picture, and how many samples. Out: for each pixel of
//! the part the mean and the variance of what one sample in it sees, from so many at fixed places.
//! The exact picture decides what is right; this one compares hundreds of scenes with a picture in
//! a second, and can be wrong in the ways in which a program can.

use glam::{DVec2, DVec3};

use super::{light::Curve, moments::Moments};
use crate::{
    area::Area,
    color::Color,
    projection::Projection,
    reference::formulas::{by_vertices, corners, crossings, radians, vertices},
    scene::{Checkerboard, Cuboid, Scene, Shape, Sphere},
};

/// Which of the surfaces that a ray crosses is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Visible {
    /// The nearest before the eye, as it should be.
    #[default]
    Nearest,
    /// That of the last object in the file.
    Last,
    /// That of the first object in the file.
    First,
    /// The farthest.
    Farthest,
    /// The farthest behind the eye, or else the nearest.
    Behind,
    /// The nearest before the eye or behind it.
    NearestBothWays,
}

/// Which squares of a checkerboard have the first colour: that in which a point lies, told in
/// squares.
#[derive(Clone, Copy, Debug)]
pub struct Squares(pub fn(f64, f64) -> bool);

impl Default for Squares {
    /// As it should be: those where floor(x) + floor(z) is even.
    fn default() -> Self {
        Self(|x, z| is_even(floor(x), floor(z)))
    }
}

impl PartialEq for Squares {
    /// Two are the same if they tell the same of points all around the origin. A function may have
    /// several addresses, so these alone do not tell functions apart.
    fn eq(&self, other: &Self) -> bool {
        let coordinates = || (-6..6).map(|i| 0.25 + 0.5 * f64::from(i));
        std::ptr::fn_addr_eq(self.0, other.0)
            || coordinates().all(|x| coordinates().all(|z| self.0(x, z) == other.0(x, z)))
    }
}

/// The whole number that is not greater.
///
/// `f64::floor` is a call where a processor need not have an instruction for it, and each ray that
/// meets a board asks. Beyond what an i64 holds no square is told from another.
pub fn floor(x: f64) -> i64 {
    let towards_zero = x as i64;
    towards_zero.wrapping_sub(i64::from(towards_zero as f64 > x))
}

/// Whether a sum is even.
pub fn is_even(x: i64, z: i64) -> bool {
    x.wrapping_add(z) & 1 == 0
}

/// How rays are made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Rays {
    /// As they should be.
    #[default]
    Right,
    /// Up is taken for the picture's top.
    UpAsTop,
    /// The top of a rolled camera is made from the right that is rolled already.
    NewRight,
    /// The right alone is rolled, the top is not.
    RightAlone,
    /// They are parallel, and leave from a window whose pixels have the size that they have at this
    /// distance.
    Parallel(f64),
    /// Their angle with the view direction grows as the distance from the picture's middle does.
    Fisheye,
}

/// How spheres are hit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Spheres {
    /// As they should be.
    #[default]
    Right,
    /// By the formula for rays of length 1, with the view plane at this distance.
    UnitRays(f64),
    /// In the nearer of two points alone.
    LesserRoot,
}

/// What is wrong with how a shape is hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hit {
    /// One of the tests of a triangle's three edges is missing.
    WithoutEdge(usize),
    /// A triangle is taken for the parallelogram of its first two sides.
    Parallelogram,
    /// A box has no sides along an axis.
    WithoutAxis(usize),
}

/// As far as a box without sides along an axis reaches.
const FAR: f64 = 1e9;

/// Of the samples of a cell each of so many is asked first, which lie all over it.
const EACH: usize = 4;

/// A cell that shows one colour near its corners and in these samples shows no other: an edge that
/// passes between them cuts off a corner of a thousandth of it.
const CORNERS: [DVec2; 4] = [
    DVec2::new(0.04, 0.04),
    DVec2::new(0.96, 0.96),
    DVec2::new(0.96, 0.04),
    DVec2::new(0.04, 0.96),
];

/// How a program behaves; one without mistakes by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Behaviour {
    /// Which surface is seen.
    pub visible: Visible,
    /// How squares are told.
    pub squares: Squares,
    /// How many times as wide as it is tall a pixel is.
    pub aspect: f64,
    /// How far apart samples lie, and how far from where they should, in pixels.
    pub spread: [f64; 2],
    pub offset: [f64; 2],
    /// How many times as wide as a pixel the square is that its samples lie in.
    pub pixel: f64,
    /// How rays are made.
    pub rays: Rays,
    /// Whether near and far are distances from the eye, not depths.
    pub clips_distances: bool,
    /// How spheres are hit.
    pub spheres: Spheres,
    /// An object that is hit wrongly.
    pub hit: Option<(usize, Hit)>,
}

impl Default for Behaviour {
    fn default() -> Self {
        Self {
            visible: Visible::default(),
            squares: Squares::default(),
            aspect: 1.0,
            spread: [1.0; 2],
            offset: [0.0; 2],
            pixel: 1.0,
            rays: Rays::default(),
            clips_distances: false,
            spheres: Spheres::default(),
            hit: None,
        }
    }
}

impl Behaviour {
    /// Whether it is that of a program without mistakes.
    pub fn is_right(self) -> bool {
        self == Self::default()
    }

    /// Whether objects are seen only where a right program shows them, or not at all.
    pub fn is_in_place(self) -> bool {
        let is_shifted = self.offset != [0.0; 2] || self.spread != [1.0; 2];
        !is_shifted
            && self.pixel == 1.0
            && !matches!(self.spheres, Spheres::UnitRays(_))
            && !self.sees_behind()
            && self.aspect == 1.0
            && self.rays == Rays::Right
            && self.hit.is_none()
    }

    /// Whether what lies behind the eye is seen, too.
    pub fn sees_behind(self) -> bool {
        matches!(self.visible, Visible::Behind | Visible::NearestBothWays)
    }
}

/// An object prepared.
struct Traced {
    shape: Shape,
    /// What is wrong with how it is hit.
    hit: Option<Hit>,
    /// The rectangle of the picture that it lies in, or all of it.
    bounds: [DVec2; 2],
    /// What is averaged of its first and its second colour.
    colors: [DVec3; 3],
}

/// A scene prepared.
pub struct FaultyTracer {
    projection: Projection,
    behaviour: Behaviour,
    near: f64,
    far: f64,
    objects: Vec<Traced>,
    /// What is averaged of the background.
    background: DVec3,
}

impl FaultyTracer {
    /// Prepares a scene, and what is averaged.
    pub fn new(scene: &Scene, behaviour: Behaviour, averaged: Curve) -> Self {
        let mut projection = Projection::quick(&scene.camera, &scene.image);
        let everywhere = [DVec2::NEG_INFINITY, DVec2::INFINITY];
        let right_projection = projection;
        let is_in_place = matches!(behaviour.rays, Rays::Right)
            && behaviour.aspect == 1.0
            && !matches!(behaviour.spheres, Spheres::UnitRays(_));
        let angle = radians(scene.camera.roll);
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let unrolled = cos * projection.right + sin * projection.top;
        let top = cos * projection.top - sin * projection.right;
        match behaviour.rays {
            Rays::Right | Rays::Parallel(_) | Rays::Fisheye => {}
            Rays::RightAlone => projection.top = top,
            Rays::UpAsTop => {
                let up = scene.camera.up.normalize_or(top);
                projection.right = cos * unrolled - sin * up;
                projection.top = sin * unrolled + cos * up;
            }
            Rays::NewRight => projection.top = sin * projection.right + cos * top,
        }
        let averaged =
            |color: Color| DVec3::from(color.to_linear()).map(|light| averaged.light(light));
        let objects = scene.objects.iter().enumerate().map(|(at, object)| {
            let mut shape = by_vertices(object.shape);
            let hit = behaviour
                .hit
                .filter(|(own, _)| *own == at)
                .map(|(_, hit)| hit);
            if let (Some(Hit::WithoutAxis(axis)), Shape::Box(cuboid)) = (hit, &mut shape) {
                (cuboid.min[axis], cuboid.max[axis]) = (-FAR, FAR);
            }
            let bounds = match is_in_place && hit.is_none() {
                true => bounds(&shape, &right_projection),
                false => None,
            };
            Traced {
                shape,
                hit,
                bounds: bounds.unwrap_or(everywhere),
                colors: shape.colors().map(averaged),
            }
        });
        Self {
            projection,
            behaviour,
            near: scene.camera.near,
            far: scene.camera.far.unwrap_or(f64::INFINITY),
            objects: objects.collect(),
            background: averaged(scene.image.background),
        }
    }

    /// What the pixels of a part of the picture show, with so many samples in each.
    pub fn moments(&self, part: Area, samples: usize) -> Moments {
        // Around the pixel's middle.
        let of_pixel = |place: DVec2| 0.5 + (place - 0.5) * self.behaviour.pixel;
        let places: Vec<DVec2> = lattice(samples).into_iter().map(of_pixel).collect();
        let corners = CORNERS.map(of_pixel);
        let count = places.len() as f64;
        // Whether the cells of the row above show one colour, and of this row those to the left.
        let mut is_flat = vec![false; part.width as usize];
        let pixel = |(x, y): (u32, u32)| {
            let corner = DVec2::new(f64::from(x), f64::from(y));
            // From the first on, so that what shows one colour has just that, and no variance.
            let first = self.color(corner + places[0]);
            let column = (x - part.x) as usize;
            let is_beside = is_flat[column] || column > 0 && is_flat[column - 1];
            // Squares of the size of half a cell may show the same in all of these places, which
            // are asked only beside a cell of one colour. To ask them first is more work than a few
            // samples are.
            let mut probes = corners.iter().chain(places.iter().step_by(EACH));
            let is_first = |probe: &DVec2| self.color(corner + *probe) == first;
            if is_beside && places.len() > 8 && probes.all(is_first) {
                is_flat[column] = true;
                return (first, DVec3::ZERO);
            }
            let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
            for &place in &places[1..] {
                let more = self.color(corner + place) - first;
                (sum, squares) = (sum + more, squares + more * more);
            }
            let more = sum / count;
            is_flat[column] = squares == DVec3::ZERO;
            (
                first + more,
                (squares / count - more * more).max(DVec3::ZERO),
            )
        };
        Moments::exact(part.iter().map(pixel))
    }

    fn color(&self, place: DVec2) -> DVec3 {
        let [spread, offset] = [self.behaviour.spread, self.behaviour.offset].map(DVec2::from);
        let place = place * spread + offset;
        let middle = self.projection.size.x / 2.0;
        let x = match self.behaviour.aspect {
            1.0 => place.x,
            aspect => middle + (place.x - middle) * aspect,
        };
        let moved = DVec2::new(x, place.y);
        self.seen(moved).unwrap_or(self.background)
    }

    /// The colour of the object that is seen at a place.
    fn seen(&self, place: DVec2) -> Option<DVec3> {
        let (mut eye, mut ray) = (self.projection.eye, self.projection.ray(place));
        if let Rays::Parallel(distance) = self.behaviour.rays {
            let ahead = self.projection.ahead;
            (eye, ray) = (eye + distance * (ray - ahead), ahead);
        }
        if self.behaviour.rays == Rays::Fisheye {
            let across = ray - self.projection.ahead;
            let angle = across.length();
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            ray = cos * self.projection.ahead + sin * across.normalize_or_zero();
        }
        let length = match (self.behaviour.clips_distances, self.behaviour.rays) {
            (true, _) => ray.length(),
            // How far ahead such rays lead.
            (false, Rays::UpAsTop | Rays::Fisheye) => ray.dot(self.projection.ahead),
            (false, _) => 1.0,
        };
        let mut best: Option<(&Traced, f64, f64)> = None;
        for (at, object) in self.objects.iter().enumerate() {
            let [least, most] = object.bounds;
            if place.x < least.x || place.x > most.x || place.y < least.y || place.y > most.y {
                continue;
            }
            let crossings = match (object.hit, &object.shape) {
                (_, Shape::Sphere(sphere)) => match self.behaviour.spheres {
                    Spheres::UnitRays(distance) => with_unit_rays(sphere, distance, eye, ray),
                    Spheres::LesserRoot => {
                        crossings(&object.shape, eye, ray, 0.0).map(|[lesser, _]| [lesser; 2])
                    }
                    Spheres::Right => crossings(&object.shape, eye, ray, 0.0),
                },
                (Some(hit), Shape::Triangle(triangle)) => {
                    on_plane(&vertices(&triangle.outline), hit, eye, ray)
                }
                _ => crossings(&object.shape, eye, ray, 0.0),
            };
            let first = |crossings| self.first(crossings, length);
            let Some(t) = crossings.and_then(first) else {
                continue;
            };
            let order = match self.behaviour.visible {
                Visible::First => at as f64,
                Visible::Last => -(at as f64),
                Visible::Farthest => -t,
                _ => self.order(t),
            };
            if best.is_none_or(|(_, _, least)| order < least) {
                best = Some((object, t, order));
            }
        }
        let (object, t, _) = best?;
        let point = eye + t * ray;
        let color = match object.shape {
            Shape::Checkerboard(Checkerboard { square, .. }) => {
                let [x, z] = [point.x, point.z].map(|at| at / square);
                usize::from(!(self.behaviour.squares.0)(x, z))
            }
            Shape::Box(Cuboid { min, max, .. }) => {
                // That of the nearest face.
                let off = (point - min).abs().min((point - max).abs());
                off.min_position()
            }
            Shape::Sphere(_) | Shape::Triangle(_) => 0,
        };
        Some(object.colors[color])
    }

    /// Whether a crossing counts, at so many lengths of a ray.
    fn counts(&self, t: f64, length: f64) -> bool {
        let is_ahead = t > 0.0 && t * length > self.near && t * length < self.far;
        is_ahead || (self.behaviour.sees_behind() && t < 0.0 && -t < self.far)
    }

    /// Of two crossings that of lesser order is seen.
    fn order(&self, t: f64) -> f64 {
        match self.behaviour.visible {
            Visible::NearestBothWays => t.abs(),
            _ => t,
        }
    }

    /// The one of two crossings, in order, that is seen, of those that count.
    fn first(&self, crossings: [f64; 2], length: f64) -> Option<f64> {
        let counting = crossings.map(|t| Some(t).filter(|t| self.counts(*t, length)));
        match counting {
            [Some(one), Some(other)] if self.order(other) < self.order(one) => Some(other),
            [one, other] => one.or(other),
        }
    }
}

/// Where a ray meets a sphere by −b ± √(b² − c), as if it had the length 1; it is so long that it
/// leads to the view plane at a distance.
fn with_unit_rays(sphere: &Sphere, distance: f64, eye: DVec3, ray: DVec3) -> Option<[f64; 2]> {
    let from = eye - sphere.center;
    let b = from.dot(distance * ray);
    let c = from.length_squared() - sphere.radius * sphere.radius;
    let discriminant = b * b - c;
    (discriminant >= 0.0)
        .then(|| [-1.0, 1.0].map(|sign| distance * (sign * discriminant.sqrt() - b)))
}

/// Where a ray meets a triangle's plane, if that lies within the edges that are asked.
fn on_plane([a, b, c]: &[DVec3; 3], hit: Hit, eye: DVec3, ray: DVec3) -> Option<[f64; 2]> {
    let (one, other) = (b - a, c - a);
    let normal = one.cross(other);
    let t = (a - eye).dot(normal) / ray.dot(normal);
    let point = eye + t * ray - a;
    let x = point.cross(other).dot(normal) / normal.length_squared();
    let y = one.cross(point).dot(normal) / normal.length_squared();
    let is_within = match hit {
        Hit::Parallelogram => (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y),
        Hit::WithoutEdge(edge) => {
            let inside = [x, y, 1.0 - x - y];
            (0..3).all(|i| i == edge || inside[i] >= 0.0)
        }
        Hit::WithoutAxis(_) => false,
    };
    is_within.then_some([t; 2])
}

/// The rectangle of the picture that a shape lies in, if all of it lies before the eye, or behind
/// it.
pub fn bounds(shape: &Shape, projection: &Projection) -> Option<[DVec2; 2]> {
    let [min, max] = shape.bounding_box(|triangle| vertices(&triangle.outline))?;
    let corners = corners(min, max);
    let depths = corners.map(|corner| projection.depth(corner));
    let is_on_one_side = |depth: &f64| *depth != 0.0 && (depths[0] > 0.0) == (*depth > 0.0);
    depths.iter().all(is_on_one_side).then_some(())?;
    let places = corners.map(|corner| projection.projected(corner));
    places.iter().all(|place| place.is_finite()).then_some(())?;
    let least = places.into_iter().fold(DVec2::INFINITY, DVec2::min);
    let most = places.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
    // Room for roundings.
    Some([least - 1e-6, most + 1e-6])
}

/// Places in a unit square: a Fibonacci lattice of at least so many, whose rows and columns have
/// one each, so that edges along the grid do no harm.
fn lattice(samples: usize) -> Vec<DVec2> {
    let (mut step, mut count) = (1, 1);
    while count < samples {
        (step, count) = (count, step + count);
    }
    let place = |i: usize| {
        let of = |k: usize| (k % count) as f64 + 0.5;
        DVec2::new(of(i), of(i * step)) / count as f64
    };
    (0..count).map(place).collect()
}
