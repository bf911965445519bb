//! A ray tracer by the formulas of a `textbook`, with the mistakes of a program as switches.
//!
//! In: a scene, the switches, a part of its picture, and how many samples. Out: for each pixel of the part the mean and the variance of what one sample in it
//! sees, from so many at fixed places. The exact picture decides what is right; this one compares hundreds of scenes with a picture in a second, and
//! can be wrong in the ways in which a program can.

use glam::DVec2;

use super::{light::Curve, moments::Moments};
use crate::{
    area::Area,
    color::Color,
    projection::Projection,
    scene::{Checkerboard, Cuboid, Scene, Shape},
    textbook::{by_vertices, corners, crossings, vertices},
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

/// Which squares of a checkerboard have the first colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Squares {
    /// As it should be: those where floor(x) + floor(z) is even.
    #[default]
    Floored,
    /// Those where trunc(x) + trunc(z) is even.
    Truncated,
    /// Those where the remainder of floor(x) + floor(z), which may be −1, is not 1.
    SignedSum,
    /// Those where the remainders of floor(x) and floor(z), which may be −1, are equal.
    SignedParts,
}

/// A cell that shows one colour near its corners and in the first samples shows no other: an edge that passes between them cuts off a corner
/// of a thousandth of it.
const CORNERS: [DVec2; 4] = [
    DVec2::new(0.04, 0.04),
    DVec2::new(0.96, 0.96),
    DVec2::new(0.96, 0.04),
    DVec2::new(0.04, 0.96),
];

/// How a program behaves; one without mistakes by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Behaviour {
    /// Which surface is seen.
    pub visible: Visible,
    /// How squares are told.
    pub squares: Squares,
    /// Whether the window is as wide as it is high, though the picture is not.
    pub is_squeezed: bool,
}

impl Behaviour {
    /// Whether it is that of a program without mistakes.
    pub fn is_right(self) -> bool {
        self == Self::default()
    }

    /// Whether what lies behind the eye is seen, too.
    pub fn sees_behind(self) -> bool {
        matches!(self.visible, Visible::Behind | Visible::NearestBothWays)
    }
}

impl Squares {
    /// Whether the square that a point lies in has the first colour.
    fn is_first(self, x: f64, z: f64) -> bool {
        // `f64::floor` is a call where a processor need not have an instruction for it, and each ray that meets a board asks. Beyond what an i64 holds no square is
        // told from another.
        let trunc = |x: f64| x as i64;
        let floor = |x: f64| trunc(x).wrapping_sub(i64::from(trunc(x) as f64 > x));
        match self {
            Self::Floored => floor(x).wrapping_add(floor(z)) & 1 == 0,
            Self::Truncated => trunc(x).wrapping_add(trunc(z)) & 1 == 0,
            Self::SignedSum => floor(x).wrapping_add(floor(z)) % 2 != 1,
            Self::SignedParts => floor(x) % 2 == floor(z) % 2,
        }
    }
}

/// An object prepared.
struct Traced {
    shape: Shape,
    /// The rectangle of the picture that it lies in, or all of it.
    bounds: [DVec2; 2],
    /// What is averaged of its first and its second colour.
    colors: [[f64; 3]; 3],
}

/// A scene prepared.
pub struct FaultyTracer {
    projection: Projection,
    behaviour: Behaviour,
    near: f64,
    far: f64,
    objects: Vec<Traced>,
    /// What is averaged of the background.
    background: [f64; 3],
}

impl FaultyTracer {
    /// Prepares a scene, and what is averaged.
    pub fn new(scene: &Scene, behaviour: Behaviour, averaged: Curve) -> Self {
        let projection = Projection::quick(&scene.camera, &scene.image);
        let everywhere = [DVec2::NEG_INFINITY, DVec2::INFINITY];
        let averaged = |color: Color| color.to_linear().map(|light| averaged.light(light));
        let objects = scene.objects.iter().map(|object| {
            let shape = by_vertices(object.shape);
            Traced {
                shape,
                bounds: bounds(&shape, &projection).unwrap_or(everywhere),
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
        let places = lattice(samples);
        let count = places.len() as f64;
        let pixel = |(x, y): (u32, u32)| {
            let corner = DVec2::new(f64::from(x), f64::from(y));
            // From the first on, so that what shows one colour has just that, and no variance.
            let first = self.color(corner + places[0]);
            // Squares of the size of half a cell show the same in all corners. To ask these first is more work than a few samples are.
            let mut probes = CORNERS.iter().chain(places.iter().take(8));
            let is_first = |probe: &DVec2| self.color(corner + *probe) == first;
            if places.len() > 8 && probes.all(is_first) {
                return (first, [0.0; 3]);
            }
            let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
            for &place in &places[1..] {
                let color = self.color(corner + place);
                for i in 0..3 {
                    let more = color[i] - first[i];
                    sums[i] += more;
                    squares[i] += more * more;
                }
            }
            let more = sums.map(|sum| sum / count);
            let variance = [0, 1, 2].map(|i| (squares[i] / count - more[i] * more[i]).max(0.0));
            ([0, 1, 2].map(|i| first[i] + more[i]), variance)
        };
        Moments::exact(part.iter().map(pixel))
    }

    fn color(&self, place: DVec2) -> [f64; 3] {
        let size = self.projection.size;
        let moved = match self.behaviour.is_squeezed {
            true => {
                let middle = size.x / 2.0;
                DVec2::new(middle + (place.x - middle) * size.y / size.x, place.y)
            }
            false => place,
        };
        self.seen(moved).unwrap_or(self.background)
    }

    /// The colour of the object that is seen at a place.
    fn seen(&self, place: DVec2) -> Option<[f64; 3]> {
        let (eye, ray) = (self.projection.eye, self.projection.ray(place));
        let mut best: Option<(&Traced, f64, f64)> = None;
        for (at, object) in self.objects.iter().enumerate() {
            let [least, most] = object.bounds;
            if place.x < least.x || place.x > most.x || place.y < least.y || place.y > most.y {
                continue;
            }
            let crossings = crossings(&object.shape, eye, ray, 0.0);
            let Some(t) = crossings.and_then(|crossings| self.first(crossings)) else {
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
                usize::from(!self.behaviour.squares.is_first(x, z))
            }
            Shape::Box(Cuboid { min, max, .. }) => {
                // That of the nearest face.
                let off = (point - min).abs().min((point - max).abs());
                off.min_position()
            }
            _ => 0,
        };
        Some(object.colors[color])
    }

    /// Whether a crossing counts.
    fn counts(&self, t: f64) -> bool {
        let is_ahead = t > self.near && t < self.far;
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
    fn first(&self, crossings: [f64; 2]) -> Option<f64> {
        let counting = crossings.map(|t| Some(t).filter(|t| self.counts(*t)));
        match counting {
            [Some(one), Some(other)] if self.order(other) < self.order(one) => Some(other),
            [one, other] => one.or(other),
        }
    }
}

/// The rectangle of the picture that a shape lies in, if all of it lies before the eye, or behind it.
pub fn bounds(shape: &Shape, projection: &Projection) -> Option<[DVec2; 2]> {
    let (min, max) = match shape {
        Shape::Sphere(sphere) => (sphere.center - sphere.radius, sphere.center + sphere.radius),
        Shape::Box(cuboid) => (cuboid.min, cuboid.max),
        Shape::Triangle(triangle) => {
            let [a, b, c] = vertices(&triangle.outline);
            (a.min(b).min(c), a.max(b).max(c))
        }
        Shape::Checkerboard(_) => return None,
    };
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

/// Places in a unit square: a Fibonacci lattice of at least so many, whose rows and columns have one each, so that edges along the grid do no harm.
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
