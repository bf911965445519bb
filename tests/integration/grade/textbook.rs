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
    /// Takes the second coordinate, rounded down.
    StripesZ,
    /// Adds the first coordinate, truncated, and the second, rounded down.
    TruncatedX,
    /// Adds the first coordinate, rounded down, and the second, rounded to the nearest integer.
    MovedZ,
    /// Adds the two coordinates, each rounded down, of a board that is turned by 45 degrees.
    Turned,
    /// The number is odd if at least one of the two coordinates, rounded down, is odd.
    BothEven,
    /// The number is odd if the product of the sines of the two coordinates is negative.
    Sines,
}

/// The roots of a sphere that are tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roots {
    /// Both, the nearer one first.
    Both,
    /// The nearer one.
    Lesser,
    /// The farther one.
    Greater,
    /// Both, multiplied by a instead of divided by it.
    TimesA,
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
    pub roots: Roots,
    /// Whether boxes have no faces perpendicular to z.
    pub misses_axis: bool,
    /// Distance from the origin, along x and z, at which boards end.
    pub reach: f64,
    /// Whether boards have y and z exchanged.
    pub is_upright: bool,
    /// Share of a colour's light that is seen, by the normal towards the eye and the ray.
    pub shade: fn(DVec3, DVec3) -> f64,
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
                let (color, share) = self.trace(from, ray, -w.normalize());
                sum += share * DVec3::from(color.map(|byte| light[usize::from(byte)]));
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

/// Reads rows that are `by` pixels longer or shorter than those that were written.
pub fn with_stride(picture: &RgbImage, by: i64) -> RgbImage {
    let [width, height] = [picture.width(), picture.height()].map(i64::from);
    RgbImage::from_fn(picture.width(), picture.height(), |x, y| {
        let at = (i64::from(y) * (width + by) + i64::from(x)).rem_euclid(width * height);
        *picture.get_pixel((at % width) as u32, (at / width) as u32)
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
