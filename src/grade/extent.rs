//! Where an object may be seen, from its place and size alone: a picture changes nowhere else when the object does.

use std::fmt;

use glam::{DVec2, DVec3};

use super::level::axes;
use crate::{
    area::Area,
    numbers::short,
    scene::{Outline, Scene, Shape},
    tracer::vertices,
};

/// What a camera sees of places.
pub struct View {
    axes: [DVec3; 3],
    pitch: f64,
    eye: DVec3,
    whole: Area,
}

impl View {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        let (axes, pitch) = axes(scene);
        Self {
            axes,
            pitch,
            eye: scene.camera.eye,
            whole: Area::whole(scene.image.width, scene.image.height),
        }
    }

    /// How far a shape's picture is from that of another one.
    pub fn off(&self, from: &Shape, to: &Shape) -> Option<Off> {
        let image = |shape: &Shape| {
            let (middle, radius) = ball(shape)?;
            let [u, v, w] = self.axes;
            let from = middle - self.eye;
            let depth = -from.dot(w);
            let pixels = 1.0 / (depth * self.pitch);
            let at = DVec2::new(from.dot(u), -from.dot(v)) * pixels;
            (depth > 0.0).then_some((at, radius * pixels))
        };
        let ((at, radius), (there, other)) = (image(from)?, image(to)?);
        // What has another shape is larger on some sides, or smaller on others.
        let outwards = if are_similar(from, to) {
            other - radius
        } else {
            0.0
        };
        Off::by(there - at, outwards)
    }

    /// A part of the picture in which all lies that is seen of two shapes, if there are two; `None` if that is nowhere.
    pub fn extents(&self, shapes: &[Option<Shape>; 2]) -> Option<Area> {
        let [a, b] = shapes.each_ref().map(|shape| self.extent(shape.as_ref()?));
        union(a, b)
    }

    /// The same of one shape, as it is without anything in front of it.
    pub fn extent(&self, shape: &Shape) -> Option<Area> {
        let Self {
            axes: [u, v, w],
            pitch,
            eye,
            whole,
        } = *self;
        let Some((middle, radius)) = ball(shape) else {
            return Some(whole);
        };
        let from = middle - eye;
        let depth = -from.dot(w);
        if depth + radius <= 0.0 {
            return None;
        }
        let nearest = depth - radius;
        if nearest <= 0.0 {
            return Some(whole);
        }
        let size = DVec2::new(f64::from(whole.width), f64::from(whole.height));
        // A ball lies between x − r and x + r, and between the depths d − r and d + r: its image between the quotients of those.
        let farthest = depth + radius;
        let ends = |at: f64| {
            let [low, high] = [at - radius, at + radius].map(|x| x / pitch);
            [
                (low / nearest).min(low / farthest),
                (high / nearest).max(high / farthest),
            ]
        };
        let [across, down] = [ends(from.dot(u)), ends(-from.dot(v))];
        // A pixel more for the roundings.
        let first = |low: f64, size: f64| (low + 0.5 * size).floor() - 1.0;
        let last = |high: f64, size: f64| (high + 0.5 * size).ceil() + 1.0;
        let span = |[low, high]: [f64; 2], size: f64| {
            let [from, to] =
                [first(low, size), last(high, size)].map(|x| x.clamp(0.0, size) as u32);
            (from, to - from)
        };
        let ((x, width), (y, height)) = (span(across, size.x), span(down, size.y));
        (width > 0 && height > 0).then_some(Area {
            x,
            y,
            width,
            height,
        })
    }
}

/// How far something is off in the picture, in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Off {
    /// How far its middle is displaced to the right.
    pub right: f64,
    /// And how far down.
    pub down: f64,
    /// How much farther from its middle its outline is.
    pub outwards: f64,
}

impl Off {
    /// By so much, if it can be seen.
    pub fn by(by: DVec2, outwards: f64) -> Option<Self> {
        let off = Self {
            right: by.x,
            down: by.y,
            outwards,
        };
        let all = [off.right, off.down, off.outwards];
        let is_seen = all.iter().all(|by| by.is_finite()) && all.iter().any(|by| by.abs() >= LEAST);
        is_seen.then_some(off)
    }
}

/// Less than this is not said, in pixels.
const LEAST: f64 = 0.05;

impl fmt::Display for Off {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let ways = [
            (self.right, ["to the right", "to the left"]),
            (self.down, ["down", "up"]),
            (self.outwards, ["larger all round", "smaller all round"]),
        ];
        let seen = ways.into_iter().filter(|(by, _)| by.abs() >= LEAST);
        let parts: Vec<_> = seen
            .map(|(by, [positive, negative])| {
                let way = if by > 0.0 { positive } else { negative };
                format!("{} {way}", pixels(by.abs()))
            })
            .collect();
        f.write_str(&parts.join(", "))
    }
}

/// So many pixels, in three digits.
pub fn pixels(number: f64) -> String {
    let rounded = format!("{number:.2e}").parse().unwrap_or(number);
    match rounded {
        1.0 => "1 pixel".to_owned(),
        many => format!("{} pixels", short(many)),
    }
}

/// A ball around a shape; none around a checkerboard.
pub fn ball(shape: &Shape) -> Option<(DVec3, f64)> {
    match shape {
        Shape::Sphere(sphere) => Some((sphere.center, sphere.radius)),
        Shape::Triangle(triangle) => {
            let middle = triangle.outline.centroid();
            let far = |vertex: DVec3| (vertex - middle).length();
            let radius = vertices(triangle).map(far).into_iter().fold(0.0, f64::max);
            Some((middle, radius))
        }
        Shape::Box(cuboid) => {
            let middle = (cuboid.min + cuboid.max) / 2.0;
            Some((middle, (cuboid.max - middle).length()))
        }
        Shape::Checkerboard(_) => None,
    }
}

/// Whether one shape is the other displaced and enlarged: then its outline is as much farther out all round.
fn are_similar(shape: &Shape, other: &Shape) -> bool {
    let is_enlarged = |from: DVec3, to: DVec3| {
        let factors = to / from;
        factors.max_element() - factors.min_element() <= ROUNDINGS * factors.max_element()
    };
    match (shape, other) {
        (Shape::Sphere(_), Shape::Sphere(_)) => true,
        (Shape::Triangle(one), Shape::Triangle(other)) => match (one.outline, other.outline) {
            (Outline::Centered(one), Outline::Centered(other)) => {
                is_enlarged(one.sides, other.sides)
                    && one.normal == other.normal
                    && one.spin == other.spin
            }
            _ => false,
        },
        (Shape::Box(one), Shape::Box(other)) => {
            is_enlarged(one.max - one.min, other.max - other.min)
        }
        _ => false,
    }
}

/// Factors of lengths differ by so much of them where only roundings do: those of a few operations on coordinates that are up to a million
/// times as large as a shape.
const ROUNDINGS: f64 = 1e-9;

/// The smallest part with both.
fn union(a: Option<Area>, b: Option<Area>) -> Option<Area> {
    let (Some(a), Some(b)) = (a, b) else {
        return a.or(b);
    };
    Some(a.with(b))
}

/// Sums of some number of each pixel over parts of a picture, each in a moment.
pub struct Differences {
    width: usize,
    /// Of what lies above a row's upper edge and to the left of a column's left edge.
    sums: Vec<f64>,
    /// In how many pixels it is not 0.
    pub pixels: u64,
}

impl Differences {
    /// Of a picture's size.
    pub fn new([width, height]: [u32; 2], number: impl Fn(u32, u32) -> f64) -> Self {
        let row_length = width as usize + 1;
        let mut sums = vec![0.0; row_length];
        let mut pixels = 0;
        for y in 0..height {
            let above = sums.len() - row_length;
            let mut row = 0.0;
            sums.push(0.0);
            for x in 0..width {
                let own = number(x, y);
                pixels += u64::from(own != 0.0);
                row += own;
                sums.push(sums[above + x as usize + 1] + row);
            }
        }
        Self {
            width: row_length,
            sums,
            pixels,
        }
    }

    /// The share of all of them that lies in a part; 0, if all are 0.
    pub fn share(&self, part: Area) -> f64 {
        let at = |x: u32, y: u32| self.sums[y as usize * self.width + x as usize];
        let (right, bottom) = (part.x + part.width, part.y + part.height);
        let sum = at(right, bottom) - at(part.x, bottom) - at(right, part.y) + at(part.x, part.y);
        let all = self.sums.last().copied().unwrap_or(0.0);
        match all > 0.0 {
            true => (sum / all).clamp(0.0, 1.0),
            false => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{film::Film, grade::scene_of};

    #[test]
    fn nothing_of_an_object_is_seen_outside_its_extent() {
        let camera = "image { width 60 height 40 background black } camera { eye (1, 2, 6) lookat (0, 1, 0) roll 15deg d 2 }
             sampler { method exact }";
        for object in [
            "sphere { center (0, 1, 0) color white }",
            "sphere { center (-2.5, 2, 1) radius 0.7 color white }",
            "sphere { center (1, 2, 6) radius 3 color white }",
            "box { center (1, 0, 2) size (1, 3, 0.4) color white }",
            "triangle { centroid (0, 2, 0) normal (0.4, 0.1, 1) sides (2, 2, 3) color white }",
            "sphere { center (0, 1, 40) color white }",
        ] {
            let (scene, film) = scene_of(&format!("{camera} {object}"));
            let part = View::of(&scene).extent(&scene.objects[0].shape);
            for (x, y) in Area::whole(60, 40).iter() {
                let is_in = part.is_some_and(|part| {
                    (part.x..part.x + part.width).contains(&x)
                        && (part.y..part.y + part.height).contains(&y)
                });
                assert!(
                    is_in || film.pixel(x, y) == [0.0; 3],
                    "{object} at {x}, {y}"
                );
            }
        }
    }

    #[test]
    fn shares_are_those_of_a_sum() {
        let a = Film::from_fn(7, 5, |x, y| [f64::from(x * y) / 30.0; 3]).unwrap();
        let b = Film::from_fn(7, 5, |x, _| [f64::from(x) / 30.0; 3]).unwrap();
        let part = Area {
            x: 2,
            y: 1,
            width: 3,
            height: 4,
        };
        let square = |x: u32, y: u32| {
            let (p, q) = (a.pixel(x, y)[0], b.pixel(x, y)[0]);
            (p - q) * (p - q)
        };
        let sum: f64 = part.iter().map(|(x, y)| square(x, y)).sum();
        let all: f64 = Area::whole(7, 5).iter().map(|(x, y)| square(x, y)).sum();
        let found = Differences::new([7, 5], square).share(part);
        assert!((found - sum / all).abs() < 1e-12);
    }
}
