//! A ray tracer as a class writes it, in plain `f64`, from the formulas of a textbook (Suffern
//! 2007, "Ray Tracing from the Ground Up", chapters 3, 4, 9 and 19). It shares no code with
//! Pinhole, so its pictures are independent evidence.
//!
//! In: a [`Program`], which is a scene and the way in which the program treats it. Out: a picture
//! in bytes. Many fields of a program select a mistake; the module `mistakes` lists the mistakes of
//! a class.

use std::array;

use glam::DVec3;
use image::{Pixel, Rgb, RgbImage, imageops};
use rand::{RngExt, SeedableRng, rngs::SmallRng};

/// A shape of a scene. Colours are in sRGB bytes.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A sphere: its centre and radius.
    Sphere(DVec3, f64),
    /// A triangle: the left and the right end of its base, and its apex.
    Triangle([DVec3; 3]),
    /// A box: its least and its greatest corner.
    Box(DVec3, DVec3),
    /// A checkerboard: its height, the side of its squares, and their second colour.
    Board(f64, f64, [u8; 3]),
}

/// An object of a scene: a shape with a name and a colour.
#[derive(Clone, Debug)]
pub struct Object {
    /// Name in the scene's text.
    pub name: &'static str,
    /// Shape of the object.
    pub shape: Shape,
    /// Colour of the object; of a board, its first colour.
    pub color: [u8; 3],
}

/// How the program converts light to a byte.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// Encodes by the curve of sRGB.
    Srgb,
    /// Does not encode: the byte is proportional to the light.
    None,
    /// Encodes the light by the sRGB curve, and the result once more.
    Twice,
    /// Encodes by a power whose exponent is the reciprocal of this number.
    Power(f64),
}

/// Which of the surfaces that a ray hits the program shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Visible {
    /// The nearest surface, which is correct.
    Nearest,
    /// The surface of the first object in the scene.
    First,
    /// The surface of the last object in the scene.
    Last,
    /// The farthest surface.
    Farthest,
}

/// How the program treats surfaces behind the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Behind {
    /// Surfaces behind the eye are not visible, which is correct.
    Unseen,
    /// Surfaces behind the eye are compared by their distance, as if they were before it.
    ByDistance,
    /// Surfaces behind the eye count as nearer than all surfaces before it.
    First,
}

/// How the program computes the number of a board's square from the two coordinates x and z, in
/// units of the square's side. Squares of odd number have the second colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Squares {
    /// Adds the two coordinates, each rounded down.
    Floored,
    /// Adds the two coordinates, each truncated.
    Truncated,
    /// Takes the remainder of the sum by 2, which is −1 for negative odd sums.
    Remainder,
    /// Compares the remainders of the two coordinates by 2; the number is odd if they differ.
    Remainders,
    /// Adds the two coordinates, each rounded to the nearest integer.
    Rounded,
    /// Adds the first coordinate, rounded to the nearest integer, and the second, rounded down.
    Moved,
    /// Adds the two coordinates and rounds the sum down.
    Sum,
    /// Takes the first coordinate, rounded down, so that the board has stripes.
    Stripes,
    /// The number is odd if at least one of the two coordinates, rounded down, is odd.
    BothEven,
    /// The number is odd if the product of the sines of the two coordinates is negative.
    Sines,
}

/// Mistake in the camera's axes or rays. The axes are u (right), v (up) and w (against the view
/// direction).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes {
    /// No mistake.
    Right,
    /// The roll computes v from the rolled u instead of the unrolled one.
    NewU,
    /// The up vector is used as v.
    UpAsV,
    /// The vector w is not normalised.
    LongW,
    /// w is computed from `lookat` without subtracting the eye.
    WithoutEye,
    /// Only the vector u is rolled.
    RolledU,
    /// A ray's angle grows linearly with the distance from the picture's middle.
    Fisheye,
    /// Rays are not normalised.
    LongRays,
    /// All rays have the direction −w.
    Parallel,
}

/// How the program places the samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// On a regular grid.
    Regular,
    /// At independent, uniform points.
    Random,
    /// At a random point in each cell of a grid.
    Jittered,
    /// At the points (i/n, φ₂(i)), the same in every pixel.
    Hammersley,
}

pub const SAMPLINGS: [Sampling; 4] = [
    Sampling::Random,
    Sampling::Jittered,
    Sampling::Regular,
    Sampling::Hammersley,
];

/// A scene, and the way in which the program treats it.
#[derive(Clone, Debug)]
pub struct Program {
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    pub background: [u8; 3],
    pub eye: DVec3,
    pub lookat: DVec3,
    pub up: DVec3,
    /// Roll in radians.
    pub roll: f64,
    /// Distance of the view plane from the eye, in the scene's unit, as [`Self::view_height`].
    pub distance: f64,
    pub view_height: f64,
    pub near: f64,
    pub far: f64,
    /// Objects of the scene, in the order of the text.
    pub objects: Vec<Object>,
    pub sampling: Sampling,
    /// Number of samples per pixel, a square.
    pub samples: u32,
    /// Whether the window's height is used as its width.
    pub is_wide: bool,
    /// Whether the window is as wide as it is high.
    pub is_squeezed: bool,
    /// Ratio of the window's width to its correct width.
    pub aspect: f64,
    pub axes: Axes,
    /// Factor by which all light is multiplied; 1 is correct.
    pub gain: f64,
    /// Whether the near and far depths are compared with distances instead of depths.
    pub clips_distances: bool,
    /// Whether the test of one of a triangle's edges is missing.
    pub misses_edge: bool,
    pub is_parallelogram: bool,
    /// Whether the greater root of a sphere's quadratic equation, its far side, is not tried.
    pub misses_root: bool,
    /// Whether boxes have no faces perpendicular to z.
    pub misses_axis: bool,
    /// Colours of the boxes' faces perpendicular to x, y and z; `None` if faces have the box's
    /// colour.
    pub faces: Option<[[u8; 3]; 3]>,
    /// Side of the square in which a pixel's samples lie, in pixels; 1 is correct.
    pub pixel: f64,
    /// Shift of the samples to the right and down, in pixels; 0 is correct.
    pub offset: f64,
    pub behind: Behind,
    pub visible: Visible,
    pub squares: Squares,
    /// Number that is added to the number of each square ([`Squares`]), so that 1 swaps the board's
    /// colours; 0 is correct.
    pub parity: i64,
    pub encoding: Encoding,
    /// Whether the program averages encoded colours instead of light.
    pub averages_encoded: bool,
    /// Whether bytes are truncated instead of rounded.
    pub cuts_bytes: bool,
    /// Change that is applied to each pixel's bytes.
    pub change: fn([u8; 3]) -> [u8; 3],
    /// Change that is applied to the whole picture at the end.
    pub afterwards: Option<fn(&RgbImage) -> RgbImage>,
}

impl Program {
    /// Returns the object with the name `name`, or `None` if the scene lacks it.
    pub fn object(&mut self, name: &str) -> Option<&mut Object> {
        self.objects.iter_mut().find(|object| object.name == name)
    }

    /// Returns the shape of the object with the name `name`, or `None` if the scene lacks it.
    pub fn shape(&mut self, name: &str) -> Option<&mut Shape> {
        self.object(name).map(|object| &mut object.shape)
    }

    /// Renders the picture of the scene as this program does.
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
        let wide = if self.is_squeezed {
            self.view_height / f64::from(width)
        } else {
            self.aspect * pixel
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
                let encoded = if self.averages_encoded {
                    part
                } else {
                    self.encode(part)
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

    /// Decodes a channel of a colour to light. The program encodes light by the inverse function,
    /// unless `encoding` is [`Encoding::None`] or [`Encoding::Twice`].
    fn decode(&self, part: f64) -> f64 {
        match self.encoding {
            Encoding::Power(power) => libm::pow(part, power),
            _ => light(part),
        }
    }

    fn encode(&self, light: f64) -> f64 {
        let srgb = |light: f64| {
            if light <= 0.003_130_8 {
                12.92 * light
            } else {
                1.055 * libm::pow(light, 1.0 / 2.4) - 0.055
            }
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

    /// Returns the colour of the surface that a ray from the point `from` shows, or the background.
    /// `view` is the view direction.
    fn trace(&self, from: DVec3, ray: DVec3, view: DVec3) -> [u8; 3] {
        // Of two surfaces, the one with the smaller value counts as nearer. With [`Behind::First`],
        // surfaces behind the eye, where t is negative, come first.
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

    /// Returns the ray parameters at which a ray hits a shape.
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
                let is_within = if self.is_parallelogram {
                    beta <= 1.0 && gamma <= 1.0
                } else {
                    beta + gamma <= 1.0
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

/// Sharpens a picture: adds to each pixel its difference from the mean of the 3 × 3 pixels around
/// it.
pub fn sharpened(picture: &RgbImage) -> RgbImage {
    let around = imageops::filter3x3(picture, &[1.0; 9]);
    let [columns, rows] = [picture.width(), picture.height()].map(|side| 1..side - 1);
    RgbImage::from_fn(picture.width(), picture.height(), |x, y| {
        let own = picture.get_pixel(x, y);
        let mean = if columns.contains(&x) && rows.contains(&y) {
            around.get_pixel(x, y)
        } else {
            own
        };
        own.map2(mean, |own, mean| {
            (2 * i16::from(own) - i16::from(mean)).clamp(0, 255) as u8
        })
    })
}

/// Decodes a channel of sRGB, from 0 to 1, to linear light.
pub fn light(part: f64) -> f64 {
    if part <= 0.04045 {
        part / 12.92
    } else {
        libm::pow((part + 0.055) / 1.055, 2.4)
    }
}
