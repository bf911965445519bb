//! A ray tracer as in a textbook, in plain `f64`, with the mistakes of a program as switches.
//!
//! In: a scene, the switches, a part of its picture, and how many samples. Out: for each pixel of the part the mean and the variance of what one sample in it
//! sees, from so many at fixed places. The exact picture decides what is right; this one compares hundreds of scenes with a picture in a second, and
//! can be wrong in the ways in which a program can.

use glam::{BVec3, DVec2, DVec3};

use super::{axes::Axes, light::Curve, moments::Moments};
use crate::{
    area::Area,
    color::Color,
    scene::{Outline, Scene, Shape},
};

/// Which of the surfaces that a ray crosses is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visible {
    /// The nearest, as it should be.
    Nearest,
    /// That of the last object in the file.
    Last,
    /// That of the first object in the file.
    First,
    /// The farthest.
    Farthest,
}

/// Whether what lies behind the eye is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Behind {
    /// As it should be.
    Unseen,
    /// It is nearer than all that lies before the eye.
    First,
    /// It is as far away as it is.
    ByDistance,
}

/// Which squares of a checkerboard have the first colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Squares {
    /// As it should be: those where floor(x) + floor(z) is even.
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

/// How a program behaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Behaviour {
    /// Which surface is seen.
    pub visible: Visible,
    /// Whether surfaces behind the eye are seen, too.
    pub behind: Behind,
    /// How squares are told.
    pub squares: Squares,
    /// Whether the window is as wide as it is high, though the picture is not.
    pub is_squeezed: bool,
}

impl Behaviour {
    /// A program without mistakes.
    pub const RIGHT: Self = Self {
        visible: Visible::Nearest,
        behind: Behind::Unseen,
        squares: Squares::Floored,
        is_squeezed: false,
    };
}

impl Squares {
    /// Whether the square that a point lies in has the first colour.
    fn is_first(self, x: f64, z: f64) -> bool {
        // Beyond what an i64 holds no square is told from another.
        let odd = |x: f64| x as i64 & 1 == 1;
        // `f64::floor` is a call where a processor need not have an instruction for it, and each ray that meets a board asks.
        let floor = |x: f64| {
            let whole = x as i64;
            whole.wrapping_sub(i64::from(whole as f64 > x))
        };
        // A remainder of an odd negative number is −1.
        let remainder = |x: f64| if odd(x) { x.signum() } else { 0.0 };
        match self {
            Self::Floored => (floor(x) ^ floor(z)) & 1 == 0,
            Self::Truncated => odd(x.trunc()) == odd(z.trunc()),
            Self::SignedSum => remainder(x.floor() + z.floor()) != 1.0,
            Self::SignedParts => remainder(x.floor()) == remainder(z.floor()),
        }
    }
}

/// The corners of a box.
pub fn corners(min: DVec3, max: DVec3) -> [DVec3; 8] {
    std::array::from_fn(|corner| {
        let is_max = |bit: u32| corner >> bit & 1 == 1;
        DVec3::select(BVec3::new(is_max(0), is_max(1), is_max(2)), max, min)
    })
}

/// A shape as seen from the eye.
enum Prepared {
    Sphere {
        to: DVec3,
        /// The square of the distance less that of the radius.
        power: f64,
    },
    /// A plane n·p = h, and for each edge a normal in it and its value.
    Triangle {
        normal: DVec3,
        height: f64,
        edges: [(DVec3, f64); 3],
    },
    Box {
        min: DVec3,
        max: DVec3,
    },
    Board {
        y: f64,
        square: f64,
    },
}

/// A scene prepared.
pub struct Textbook {
    axes: Axes,
    behaviour: Behaviour,
    near: f64,
    far: f64,
    shapes: Vec<Prepared>,
    /// The part of the picture that each lies in, where that is known.
    bounds: Vec<[DVec2; 2]>,
    /// What is averaged of each object's first and second colour, the background's last.
    colors: Vec<[[f64; 3]; 2]>,
}

impl Textbook {
    /// Prepares a scene, and what is averaged.
    pub fn new(scene: &Scene, behaviour: Behaviour, averaged: Curve) -> Self {
        let eye = scene.camera.eye;
        let shapes = scene.objects.iter().map(|object| match object.shape {
            Shape::Sphere(sphere) => {
                let to = sphere.center - eye;
                Prepared::Sphere {
                    to,
                    power: to.length_squared() - sphere.radius * sphere.radius,
                }
            }
            Shape::Triangle(triangle) => {
                let points = vertices(&triangle.outline).map(|vertex| vertex - eye);
                let normal = (points[1] - points[0]).cross(points[2] - points[0]);
                let edges = [0, 1, 2].map(|i| {
                    let inward = normal.cross(points[(i + 1) % 3] - points[i]);
                    (inward, inward.dot(points[i]))
                });
                Prepared::Triangle {
                    normal,
                    height: normal.dot(points[0]),
                    edges,
                }
            }
            Shape::Box(cuboid) => Prepared::Box {
                min: cuboid.min - eye,
                max: cuboid.max - eye,
            },
            Shape::Checkerboard(board) => Prepared::Board {
                y: board.y - eye.y,
                square: board.square,
            },
        });
        let shapes = shapes.collect();
        let axes = Axes::new(&scene.camera, &scene.image);
        let everywhere = [DVec2::NEG_INFINITY, DVec2::INFINITY];
        let objects = scene.objects.iter();
        let bounds = objects.map(|object| bounds(&object.shape, &axes).unwrap_or(everywhere));
        let bounds = bounds.collect();
        let objects = scene.objects.iter();
        let colors = objects.map(|object| object.shape.colors());
        let averaged = |color: Color| color.to_linear().map(|light| averaged.light(light));
        let colors = colors
            .chain([[scene.image.background; 2]])
            .map(|two| two.map(averaged));
        Self {
            axes,
            behaviour,
            near: scene.camera.near,
            far: scene.camera.far.unwrap_or(f64::INFINITY),
            shapes,
            bounds,
            colors: colors.collect(),
        }
    }

    /// What the pixels of a part of the picture show, with so many samples in each.
    pub fn moments(&self, part: Area, samples: usize) -> Moments {
        let places = lattice(samples);
        let count = places.len() as f64;
        let pixel = |(x, y): (u32, u32)| {
            let corner = DVec2::new(f64::from(x), f64::from(y));
            // To ask the corners first is more work than a few samples are.
            if places.len() > CORNERS.len() + 1 {
                let first = self.color(corner + places[0]);
                let is_flat = |probe: &DVec2| self.color(corner + *probe) == first;
                // Squares of the size of half a cell show the same in all corners.
                let mut probes = CORNERS.iter().chain(&places[1..8]);
                if probes.all(is_flat) {
                    return (first, [0.0; 3]);
                }
            }
            let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
            for &place in &places {
                let color = self.color(corner + place);
                for i in 0..3 {
                    sums[i] += color[i];
                    squares[i] += color[i] * color[i];
                }
            }
            let mean = sums.map(|sum| sum / count);
            let variance = [0, 1, 2].map(|i| (squares[i] / count - mean[i] * mean[i]).max(0.0));
            (mean, variance)
        };
        Moments::exact(part.iter().map(pixel))
    }

    fn color(&self, place: DVec2) -> [f64; 3] {
        let size = 2.0 * self.axes.middle;
        let moved = match self.behaviour.is_squeezed {
            true => {
                let middle = self.axes.middle.x;
                DVec2::new(middle + (place.x - middle) * size.y / size.x, place.y)
            }
            false => place,
        };
        let (object, second) = self.seen(moved).unwrap_or((self.shapes.len(), false));
        self.colors[object][usize::from(second)]
    }

    /// The object that is seen at a place, and whether it is a board's second colour.
    fn seen(&self, place: DVec2) -> Option<(usize, bool)> {
        let ray = self.axes.ray(place);
        let mut best: Option<(usize, f64, f64)> = None;
        for (object, (shape, [least, most])) in self.shapes.iter().zip(&self.bounds).enumerate() {
            if place.x < least.x || place.x > most.x || place.y < least.y || place.y > most.y {
                continue;
            }
            let Some(t) = self.crossing(shape, ray) else {
                continue;
            };
            let order = match self.behaviour.visible {
                Visible::Nearest => self.order(t),
                Visible::First => object as f64,
                Visible::Last => -(object as f64),
                Visible::Farthest => -t,
            };
            if best.is_none_or(|(_, _, least)| order < least) {
                best = Some((object, t, order));
            }
        }
        let (object, t, _) = best?;
        let second = match self.shapes[object] {
            Prepared::Board { square, .. } => {
                let point = self.axes.eye + t * ray;
                !self
                    .behaviour
                    .squares
                    .is_first(point.x / square, point.z / square)
            }
            _ => false,
        };
        Some((object, second))
    }

    /// Whether a crossing counts.
    fn counts(&self, t: f64) -> bool {
        let is_ahead = t > self.near && t < self.far;
        let is_behind = self.behaviour.behind != Behind::Unseen && t < 0.0;
        is_ahead || (is_behind && -t < self.far)
    }

    /// Of two crossings that of lesser order is seen.
    fn order(&self, t: f64) -> f64 {
        match self.behaviour.behind {
            Behind::ByDistance => t.abs(),
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

    fn crossing(&self, shape: &Prepared, ray: DVec3) -> Option<f64> {
        match *shape {
            Prepared::Sphere { to, power } => {
                let (a, b) = (ray.length_squared(), ray.dot(to));
                let root = b * b - a * power;
                if root <= 0.0 {
                    return None;
                }
                let root = root.sqrt();
                self.first([(b - root) / a, (b + root) / a])
            }
            Prepared::Triangle {
                normal,
                height,
                edges,
            } => {
                let t = height / normal.dot(ray);
                let is_inside = self.counts(t)
                    && edges
                        .iter()
                        .all(|(inward, least)| inward.dot(t * ray) >= *least);
                is_inside.then_some(t)
            }
            Prepared::Box { min, max } => {
                let (one, other) = (min / ray, max / ray);
                let (first, last) = (one.min(other).max_element(), one.max(other).min_element());
                (first <= last).then(|| self.first([first, last]))?
            }
            Prepared::Board { y, .. } => {
                let t = y / ray.y;
                self.counts(t).then_some(t)
            }
        }
    }
}

/// The rectangle of the picture that a shape lies in, if all of it lies before the eye, or behind it.
pub fn bounds(shape: &Shape, axes: &Axes) -> Option<[DVec2; 2]> {
    let (min, max) = match shape {
        Shape::Sphere(sphere) => (sphere.center - sphere.radius, sphere.center + sphere.radius),
        Shape::Box(cuboid) => (cuboid.min, cuboid.max),
        Shape::Triangle(triangle) => {
            let [a, b, c] = vertices(&triangle.outline);
            (a.min(b).min(c), a.max(b).max(c))
        }
        Shape::Checkerboard(_) => return None,
    };
    let corners = corners(min, max).map(|corner| axes.projected(corner));
    let is_before = corners[0].1 > 0.0;
    let is_on_one_side = |(_, depth): &(_, f64)| *depth != 0.0 && is_before == (*depth > 0.0);
    corners.iter().all(is_on_one_side).then_some(())?;
    let places = || corners.into_iter().map(|(place, _)| place);
    let least = places().fold(DVec2::INFINITY, DVec2::min);
    let most = places().fold(DVec2::NEG_INFINITY, DVec2::max);
    // Room for roundings.
    Some([least - 1e-6, most + 1e-6])
}

/// The vertices of a triangle: left and right base end, apex.
pub fn vertices(outline: &Outline) -> [DVec3; 3] {
    match outline {
        Outline::Vertices(vertices) => *vertices,
        Outline::Centered(triangle) => {
            let n = triangle.normal.normalize_or(DVec3::Z);
            let right = match n.x == 0.0 && n.z == 0.0 {
                true => DVec3::NEG_Z.cross(n),
                false => DVec3::Y.cross(n),
            };
            let right = right.normalize_or(DVec3::X);
            let top = n.cross(right);
            let spin = triangle.spin.in_radians();
            let (sin, cos) = (libm::sin(spin), libm::cos(spin));
            let (right, top) = (cos * right + sin * top, cos * top - sin * right);
            let [a, b, c] = triangle.sides.to_array();
            let x = (a * a - b * b + c * c) / (2.0 * c);
            let height = (a * a - x * x).max(0.0).sqrt();
            let [left, end, apex] = [(0.0, 0.0), (c, 0.0), (x, height)];
            let middle = ((c + x) / 3.0, height / 3.0);
            [left, end, apex]
                .map(|(x, y)| triangle.centroid + (x - middle.0) * right + (y - middle.1) * top)
        }
    }
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
