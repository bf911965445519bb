//! A ray tracer as a class writes it, from the formulas of a textbook (Suffern 2007, "Ray Tracing
//! from the Ground Up", chapters 3, 4, 9 and 19), in plain `f64`. It shares nothing with Pinhole,
//! so that its pictures can judge the grading of pictures.
//!
//! In: a [`Program`], that is a scene and what the program does with it. Out: a picture in bytes.
//! What a program may do wrong are its fields; the mistakes that a class makes stand in `mistakes`.

use std::array;

use glam::DVec3;
use image::{Pixel, Rgb, RgbImage, imageops};
use rand::{RngExt, SeedableRng, rngs::SmallRng};

/// A thing of a scene. Colours are in sRGB bytes.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Centre and radius.
    Sphere(DVec3, f64),
    /// The base's left end, its right end, and the apex.
    Triangle([DVec3; 3]),
    /// The least corner and the greatest one.
    Box(DVec3, DVec3),
    /// The plane at this height, with squares of this side and a second colour.
    Board(f64, f64, [u8; 3]),
}

/// A shape, its name and its colour.
#[derive(Clone, Debug)]
pub struct Object {
    /// In the scene's text.
    pub name: &'static str,
    /// What it is.
    pub shape: Shape,
    /// Of a board, the first one.
    pub color: [u8; 3],
}

/// How light becomes a byte.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// By the curve of sRGB.
    Srgb,
    /// Not at all.
    None,
    /// By this curve twice.
    Twice,
    /// By one over a power.
    Power(f64),
}

/// Which of the surfaces that a ray hits is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Visible {
    /// The nearest.
    Nearest,
    /// That of the first object.
    First,
    /// That of the last object.
    Last,
    /// The farthest.
    Farthest,
}

/// Whether what lies behind the eye is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Behind {
    /// It is not.
    Unseen,
    /// As far away as it is.
    ByDistance,
    /// Before everything that lies before the eye.
    First,
}

/// How the number of a square of the board is told, which is 1 for its second colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Squares {
    /// By the sum of two coordinates that are rounded down.
    Floored,
    /// By the sum of two that are cut off.
    Truncated,
    /// By the remainder of their sum, which is -1 for a negative odd one.
    Remainder,
    /// By whether their two remainders differ.
    Remainders,
    /// By the sum of two that are rounded to the nearest.
    Rounded,
    /// By the sum of two of which the first is rounded to the nearest, and the other down.
    Moved,
    /// By their sum, rounded down.
    Sum,
    /// By the first one, rounded down.
    Stripes,
    /// By whether one of two that are rounded down is odd.
    BothEven,
    /// By the sign of the product of their sines.
    Sines,
}

/// What is wrong with the camera's axes and rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes {
    /// Nothing.
    Right,
    /// The new u stands for the old one in the roll.
    NewU,
    /// Up stands for v.
    UpAsV,
    /// w has not the length 1.
    LongW,
    /// w is made of lookat alone.
    WithoutEye,
    /// u alone is rolled.
    RolledU,
    /// The angle of a ray grows as the distance from the picture's middle does.
    Fisheye,
    /// Rays are not divided by their length.
    LongRays,
    /// All rays have the direction −w.
    Parallel,
}

/// Where the samples of a pixel lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// An even grid.
    Regular,
    /// Independent ones.
    Random,
    /// One in each cell of a grid.
    Jittered,
    /// The points (i/n, φ₂(i)), the same in each pixel.
    Hammersley,
}

pub const SAMPLINGS: [Sampling; 4] = [
    Sampling::Random,
    Sampling::Jittered,
    Sampling::Regular,
    Sampling::Hammersley,
];

/// A scene, and what the program does with it.
#[derive(Clone, Debug)]
pub struct Program {
    /// Of the picture, in pixels.
    pub size: [u32; 2],
    pub background: [u8; 3],
    pub eye: DVec3,
    pub lookat: DVec3,
    pub up: DVec3,
    /// In radians.
    pub roll: f64,
    /// Of the view plane.
    pub distance: f64,
    pub view_height: f64,
    pub near: f64,
    pub far: f64,
    /// In the order of the text.
    pub objects: Vec<Object>,
    pub sampling: Sampling,
    /// A square number in each pixel.
    pub samples: u32,
    /// Whether the window's height is taken for its width.
    pub is_wide: bool,
    /// Whether the window is as wide as it is tall.
    pub is_squeezed: bool,
    /// The window is so many times as wide as it should be.
    pub aspect: f64,
    pub axes: Axes,
    /// What light is multiplied by.
    pub gain: f64,
    /// Whether near and far are distances.
    pub clips_distances: bool,
    /// Whether one test of a triangle is missing: of an edge's side, or that the point is on this
    /// side of the third edge.
    pub misses_edge: bool,
    pub is_parallelogram: bool,
    /// Whether the greater root of a sphere is not tried.
    pub misses_root: bool,
    /// Whether boxes have no sides across z.
    pub misses_axis: bool,
    /// The colours of a box's faces across x, y and z, in the place of its own.
    pub faces: Option<[[u8; 3]; 3]>,
    /// The side of the square that samples lie in, in pixels.
    pub pixel: f64,
    /// Added to each sample's place, in pixels.
    pub offset: f64,
    pub behind: Behind,
    pub visible: Visible,
    pub squares: Squares,
    /// Added to the number of a square.
    pub parity: i64,
    pub encoding: Encoding,
    /// Whether the mean is of encoded colours.
    pub averages_encoded: bool,
    /// Whether bytes are cut off, not rounded.
    pub cuts_bytes: bool,
    /// What is done to colours at the end.
    pub change: fn([u8; 3]) -> [u8; 3],
    /// What is done to the picture then.
    pub afterwards: Option<fn(&RgbImage) -> RgbImage>,
}

impl Program {
    /// One of its objects.
    pub fn object(&mut self, name: &str) -> &mut Object {
        let mut objects = self.objects.iter_mut();
        let found = objects.find(|object| object.name == name);
        found.expect("an object of this name")
    }

    /// The shape of one.
    pub fn shape(&mut self, name: &str) -> &mut Shape {
        &mut self.object(name).shape
    }

    /// The picture.
    pub fn render(&self) -> RgbImage {
        let [width, height] = self.size;
        let backward = match self.axes {
            Axes::WithoutEye => -self.lookat,
            _ => self.eye - self.lookat,
        };
        let mut w = backward.normalize();
        let u = self.up.cross(w).normalize();
        let v = match self.axes {
            Axes::UpAsV => self.up.normalize(),
            _ => w.cross(u),
        };
        let (sin, cos) = libm::sincos(self.roll);
        let new = cos * u - sin * v;
        let old = if self.axes == Axes::NewU { new } else { u };
        let (u, v) = match self.axes {
            Axes::RolledU => (new, v),
            _ => (new, sin * old + cos * v),
        };
        if self.axes == Axes::LongW {
            w = backward;
        }
        let pixel = self.view_height / f64::from(if self.is_wide { width } else { height });
        let wide = match self.is_squeezed {
            true => self.view_height / f64::from(width),
            false => self.aspect * pixel,
        };
        let light: [f64; 256] = array::from_fn(|byte| match byte as f64 / 255.0 {
            part if self.averages_encoded => part,
            part => self.decode(part),
        });
        let mut random = SmallRng::seed_from_u64(1);
        let picture = RgbImage::from_fn(width, height, |column, row| {
            let mut sum = DVec3::ZERO;
            for index in 0..self.samples {
                let place = self.place(index, &mut random);
                let [dx, dy] = place.map(|at| 0.5 + (at - 0.5) * self.pixel);
                let x = wide * (f64::from(column) + dx + self.offset - f64::from(width) / 2.0);
                let y = pixel * (f64::from(height) / 2.0 - f64::from(row) - dy - self.offset);
                let (across, ahead) = (x * u + y * v, -self.distance * w);
                let ray = match self.axes {
                    Axes::LongRays => across + ahead,
                    Axes::Fisheye => {
                        let angle = across.length() / self.distance;
                        libm::sin(angle) * across.normalize_or_zero() - libm::cos(angle) * w
                    }
                    _ => (across + ahead).normalize(),
                };
                let (from, ray) = match self.axes {
                    Axes::Parallel => (self.eye + across, -w),
                    _ => (self.eye, ray),
                };
                let color = self.trace(from, ray, -w.normalize());
                sum += DVec3::from(color.map(|byte| light[usize::from(byte)]));
            }
            let mean = (self.gain * sum / f64::from(self.samples)).to_array();
            let bytes = mean.map(|part| {
                let encoded = match self.averages_encoded {
                    true => part,
                    false => self.encode(part),
                };
                let half = if self.cuts_bytes { 0.0 } else { 0.5 };
                (255.0 * encoded + half) as u8
            });
            Rgb((self.change)(bytes))
        });
        match self.afterwards {
            Some(change) => change(&picture),
            None => picture,
        }
    }

    /// The light of a colour: flat colours come out as they were written, but where light is not
    /// encoded or encoded twice.
    fn decode(&self, part: f64) -> f64 {
        match self.encoding {
            Encoding::Power(power) => libm::pow(part, power),
            _ => light(part),
        }
    }

    fn encode(&self, light: f64) -> f64 {
        let srgb = |light: f64| match light <= 0.003_130_8 {
            true => 12.92 * light,
            false => 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055,
        };
        match self.encoding {
            Encoding::Srgb => srgb(light),
            Encoding::None => light,
            Encoding::Twice => srgb(srgb(light)),
            Encoding::Power(power) => libm::pow(light, 1.0 / power),
        }
    }

    fn place(&self, index: u32, random: &mut SmallRng) -> [f64; 2] {
        let side = self.samples.isqrt();
        let (n, cells) = (f64::from(self.samples), f64::from(side));
        let [i, j] = [index % side, index / side].map(f64::from);
        match self.sampling {
            Sampling::Regular => [(i + 0.5) / cells, (j + 0.5) / cells],
            Sampling::Random => [random.random(), random.random()],
            Sampling::Jittered => [i, j].map(|cell| (cell + random.random::<f64>()) / cells),
            Sampling::Hammersley => {
                let inverse = f64::from(index.reverse_bits()) / 4_294_967_296.0;
                [(f64::from(index) + 0.5) / n, inverse]
            }
        }
    }

    /// The colour in a direction.
    fn trace(&self, from: DVec3, ray: DVec3, view: DVec3) -> [u8; 3] {
        // What lies behind the eye is before everything, or counts as far away as it is.
        let order = |t: f64| {
            if self.behind == Behind::First {
                t
            } else {
                t.abs()
            }
        };
        let counts = |t: &f64| {
            let along = if self.clips_distances {
                1.0
            } else {
                ray.dot(view)
            };
            let depth = t.abs() * along;
            let is_before = self.behind != Behind::Unseen || *t > 1e-9;
            is_before && depth > self.near && depth < self.far
        };
        let mut seen: Option<(f64, &Object)> = None;
        for object in &self.objects {
            let hits = self.hits(&object.shape, from, ray).into_iter().flatten();
            let first = hits
                .filter(counts)
                .min_by(|a, b| order(*a).total_cmp(&order(*b)));
            let Some(t) = first else {
                continue;
            };
            let is_seen = seen.is_none_or(|(other, _)| match self.visible {
                Visible::Nearest => order(t) < order(other),
                Visible::First => false,
                Visible::Last => true,
                Visible::Farthest => t > other,
            });
            if is_seen {
                seen = Some((t, object));
            }
        }
        seen.map_or(self.background, |(t, object)| {
            self.color(object, from + t * ray)
        })
    }

    fn color(&self, object: &Object, at: DVec3) -> [u8; 3] {
        let (square, second) = match (&object.shape, self.faces) {
            (Shape::Board(_, square, second), _) => (*square, *second),
            (Shape::Box(least, greatest), Some(faces)) => {
                let off = (at - least).abs().min((at - greatest).abs());
                return faces[off.min_position()];
            }
            _ => return object.color,
        };
        let number = |x: f64| match self.squares {
            Squares::Truncated => (x / square) as i64,
            Squares::Rounded => (x / square).round() as i64,
            _ => (x / square).floor() as i64,
        };
        let moved = if self.squares == Squares::Moved {
            square / 2.0
        } else {
            0.0
        };
        let (i, k) = (number(at.x + moved), number(at.z) + self.parity);
        let is_second = match self.squares {
            Squares::Floored | Squares::Moved | Squares::Truncated | Squares::Rounded => {
                (i + k) % 2 != 0
            }
            Squares::Sum => ((at.x + at.z) / square).floor() as i64 % 2 != 0,
            Squares::BothEven => i % 2 != 0 || k % 2 != 0,
            Squares::Stripes => i % 2 != 0,
            Squares::Sines => libm::sin(at.x / square) * libm::sin(at.z / square) < 0.0,
            Squares::Remainder => (i + k) % 2 == 1,
            Squares::Remainders => i % 2 != k % 2,
        };
        if is_second { second } else { object.color }
    }

    /// The distances at which a ray meets a shape.
    fn hits(&self, shape: &Shape, eye: DVec3, ray: DVec3) -> [Option<f64>; 2] {
        match *shape {
            Shape::Sphere(center, radius) => {
                let from = eye - center;
                let (b, c) = (from.dot(ray), from.length_squared() - radius * radius);
                let root = (b * b - c).sqrt();
                let greater = Some(-b + root).filter(|_| !self.misses_root);
                [greater, Some(-b - root)].map(|t| t.filter(|t| !t.is_nan()))
            }
            Shape::Triangle([a, b, c]) => {
                let (ab, ac) = (b - a, c - a);
                let normal = ab.cross(ac);
                let t = (a - eye).dot(normal) / ray.dot(normal);
                let at = eye + t * ray - a;
                let area = normal.length_squared();
                let beta = at.cross(ac).dot(normal) / area;
                let gamma = ab.cross(at).dot(normal) / area;
                let is_within = match self.is_parallelogram {
                    true => beta <= 1.0 && gamma <= 1.0,
                    false => beta + gamma <= 1.0,
                };
                let is_in = beta >= 0.0 && (gamma >= 0.0 || self.misses_edge) && is_within;
                [Some(t).filter(|_| is_in), None]
            }
            Shape::Box(least, greatest) => {
                let far = if self.misses_axis {
                    1e9 * DVec3::Z
                } else {
                    DVec3::ZERO
                };
                let (a, b) = ((least - far - eye) / ray, (greatest + far - eye) / ray);
                let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
                [leave, enter].map(|t| Some(t).filter(|_| enter <= leave))
            }
            Shape::Board(y, ..) => {
                let t = (y - eye.y) / ray.y;
                [Some(t).filter(|t| t.is_finite()), None]
            }
        }
    }
}

/// A picture with what each pixel has more than the mean of those around it added once more.
pub fn sharpened(picture: &RgbImage) -> RgbImage {
    let around = imageops::filter3x3(picture, &[1.0; 9]);
    let [columns, rows] = [picture.width(), picture.height()].map(|side| 1..side - 1);
    RgbImage::from_fn(picture.width(), picture.height(), |x, y| {
        let own = picture.get_pixel(x, y);
        let mean = match columns.contains(&x) && rows.contains(&y) {
            true => around.get_pixel(x, y),
            false => own,
        };
        own.map2(mean, |own, mean| {
            (2 * i16::from(own) - i16::from(mean)).clamp(0, 255) as u8
        })
    })
}

/// The light of a part of 255.
pub fn light(part: f64) -> f64 {
    match part <= 0.04045 {
        true => part / 12.92,
        false => libm::pow((part + 0.055) / 1.055, 2.4),
    }
}
