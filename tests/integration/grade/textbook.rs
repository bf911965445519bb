//! A ray tracer as a student writes it, in plain `f64`, with the formulas of a textbook (Suffern
//! 2007, "Ray Tracing from the Ground Up", chapters 3, 4, 9 and 19). It shares no code with
//! Pinhole, so its pictures are independent evidence.
//!
//! In: a [`Program`], i.e. a scene and the way in which a student's program treats it. Out: a
//! picture in bytes. A program has fields for the mistakes that it can make; the module `mistakes`
//! lists these mistakes.

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
    /// Name of the object in the text of the scene.
    pub name: &'static str,
    pub shape: Shape,
    /// Colour of the object; for a checkerboard, its first colour.
    pub color: [u8; 3],
}

/// The way in which a student's program converts light to a byte.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Encoding {
    /// Encodes the light by the curve of sRGB, which is correct.
    Srgb,
    /// Does not encode: the byte is proportional to the light, which is a mistake.
    None,
    /// Encodes the light by the curve of sRGB, and then the result once more, which is a mistake.
    Twice,
    /// Raises the light to the power 1/x, where x is the variant's value.
    Power(f64),
}

/// Choice of the surface that a student's program shows if a ray hits several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Visible {
    /// The nearest surface, which is correct.
    Nearest,
    /// The surface of the object that comes first in the scene, which is a mistake.
    First,
    /// The surface of the object that comes last in the scene, which is a mistake.
    Last,
    /// The farthest surface, which is a mistake.
    Farthest,
}

/// The way in which a student's program treats surfaces behind the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Behind {
    /// Surfaces behind the eye are not visible, which is correct.
    Unseen,
    /// Surfaces behind the eye are compared by their distance, as if they were in front of it.
    ByDistance,
    /// Surfaces behind the eye are regarded as nearer than all surfaces in front of it.
    First,
}

/// The way in which a student's program numbers the squares of a checkerboard. A square's number is
/// computed from the coordinates x and z of a point in it, in units of the square's side. Squares
/// with odd numbers have the second colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Squares {
    /// The number of the square at the point (x, z) is ⌊x⌋ + ⌊z⌋, which is correct.
    Floored,
    /// The number of the square at the point (x, z) is the sum of x and z, each truncated towards
    /// zero.
    Truncated,
    /// The number of the square at the point (x, z) is ⌊x⌋ + ⌊z⌋. The program regards it as odd if
    /// its remainder after division by 2 is 1. The remainder of a negative odd number is −1, so the
    /// program regards such a number as even.
    Remainder,
    /// The program regards the square at the point (x, z) as odd if ⌊x⌋ and ⌊z⌋ leave different
    /// remainders after division by 2. This fails if one of them is odd and positive and the other
    /// odd and negative: their remainders 1 and −1 differ.
    Remainders,
    /// The number of the square at the point (x, z) is the sum of x and z, each rounded to the
    /// nearest integer.
    Rounded,
    /// The number of the square at the point (x, z) is ⌊x + 1/2⌋ + ⌊z⌋: the program rounds x to the
    /// nearest integer. So the board is moved by half a square along x.
    Moved,
    /// The number of the square at the point (x, z) is ⌊x + z⌋.
    Sum,
    /// The number of the square at the point (x, z) is ⌊x⌋, so that the board has stripes.
    Stripes,
    /// The number of the square at the point (x, z) is ⌊z⌋, so that the board has stripes.
    StripesZ,
    /// The number of the square at the point (x, z) is t + ⌊z⌋; t is x truncated towards zero.
    TruncatedX,
    /// The number of the square at the point (x, z) is ⌊x⌋ + ⌊z + 1/2⌋: the program rounds z to the
    /// nearest integer. So the board is moved by half a square along z.
    MovedZ,
    /// The board is turned by 45 degrees. The number of a square is the sum of its coordinates on
    /// the turned board, each rounded down.
    Turned,
    /// The square at the point (x, z) gets the first colour only if ⌊x⌋ and ⌊z⌋ are both even.
    BothEven,
    /// A square gets the second colour if sin(x) · sin(z) is negative, where x and z are the
    /// coordinates in units of the square's side.
    Sines,
}

/// Roots of the quadratic equation of a sphere, a·t² + b·t + c = 0, that a student's program tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roots {
    /// Both roots. The nearest one that is visible is used, which is correct.
    Both,
    /// Only the nearer root.
    Lesser,
    /// Only the farther root.
    Greater,
    /// Both roots, but multiplied by the coefficient a of t² instead of divided by it.
    TimesA,
}

/// The way in which a student's program computes the camera's axes and rays. The axes are u
/// (right), v (up) and w (against the view direction).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes {
    /// The axes and rays are correct.
    Right,
    /// The roll computes the axis v from the rolled axis u instead of the unrolled one.
    NewU,
    /// The up vector itself is used as the axis v.
    UpAsV,
    /// The axis w is not normalised.
    LongW,
    /// The axis w is computed from `lookat` without subtracting the eye.
    WithoutEye,
    /// Only the axis u is rolled.
    RolledU,
    /// The angle of a ray to the view direction grows linearly with the distance from the picture's
    /// middle.
    Fisheye,
    /// The directions of rays are not normalised.
    LongRays,
    /// All rays have the same direction, −w, i.e. the view direction.
    Parallel,
    /// All rays are parallel, in the view direction. They pass through a window that is moved to
    /// `lookat` and enlarged, so that objects there appear in about the right size.
    ParallelFromLookat,
}

/// The way in which a student's program places the samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// The samples are on a regular grid.
    Regular,
    /// The samples are at independent, uniformly distributed points.
    Random,
    /// Each cell of a grid contains one sample at a random point.
    Jittered,
    /// Sample i of n is at the point ((i + 1/2)/n, φ₂(i)), where φ₂ is the radical inverse in base
    /// 2. The points are equal in every pixel.
    Hammersley,
    /// The samples of a pixel are at independent, uniformly distributed points, which are equal in
    /// every pixel. The number is the seed of the random numbers.
    SharedRandom(u64),
}

pub const SAMPLINGS: [Sampling; 4] = [
    Sampling::Random,
    Sampling::Jittered,
    Sampling::Regular,
    Sampling::Hammersley,
];

/// A scene, and the way in which a student's program treats it.
#[derive(Clone, Debug)]
pub struct Program {
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    pub background: [u8; 3],
    pub eye: DVec3,
    pub lookat: DVec3,
    pub up: DVec3,
    /// Roll of the camera, in radians.
    pub roll: f64,
    /// Distance of the view plane from the eye, in the scene's unit of length.
    pub distance: f64,
    pub view_height: f64,
    pub near: f64,
    pub far: f64,
    /// Objects of the scene, in the order of the text.
    pub objects: Vec<Object>,
    pub sampling: Sampling,
    /// Number of samples per pixel, which must be a square number.
    pub samples: u32,
    /// Whether the program confuses the window's height with its width: the window is as wide as it
    /// should be high. Its height is then wrong, too, because pixels stay square.
    pub is_wide: bool,
    /// Whether the program's window is square even if the picture is not, so that objects are
    /// distorted.
    pub is_squeezed: bool,
    /// Whether the centres of the outermost pixels lie on the window's border.
    pub reaches_borders: bool,
    /// Ratio of the window's width in the program to its correct width.
    pub aspect: f64,
    pub axes: Axes,
    /// Factor by which all light is multiplied; 1 is correct.
    pub gain: f64,
    /// Whether the program applies the near and the far plane to the distances of surfaces from the
    /// eye, instead of to their depths.
    pub clips_distances: bool,
    /// Whether the program forgets to test one of a triangle's edges.
    pub misses_edge: bool,
    pub is_parallelogram: bool,
    pub roots: Roots,
    /// Whether the program's boxes lack the faces perpendicular to z.
    pub misses_axis: bool,
    /// Distance from the origin, along x and z, at which the program's checkerboards end.
    pub reach: f64,
    /// Whether the program exchanges y and z of checkerboards, so that they stand upright.
    pub is_upright: bool,
    /// Function that returns the fraction of a colour's light that is seen. Its arguments are the
    /// surface normal towards the eye, and the ray.
    pub shade: fn(DVec3, DVec3) -> f64,
    /// Colours of a box's faces perpendicular to x, y and z. If it is `None`, all faces have the
    /// colour of the box.
    pub faces: Option<[[u8; 3]; 3]>,
    /// Side of the square, in pixels, over which the program spreads the samples of a pixel; 1 is
    /// correct.
    pub pixel: f64,
    /// Distance by which the program shifts all samples to the right and down, in pixels; 0 is
    /// correct.
    pub offset: f64,
    pub behind: Behind,
    pub visible: Visible,
    pub squares: Squares,
    /// Offset that the program adds to the number of each square ([`Squares`]); 0 is correct, and 1
    /// swaps the colours of a checkerboard.
    pub parity: i64,
    pub encoding: Encoding,
    /// Whether the program averages encoded colours instead of light.
    pub averages_encoded: bool,
    /// Whether the program truncates bytes instead of rounding them.
    pub cuts_bytes: bool,
    /// Change that the program applies to the bytes of each pixel.
    pub change: fn([u8; 3]) -> [u8; 3],
    /// Change that the program applies to the whole picture at the end.
    pub afterwards: Option<fn(&RgbImage) -> RgbImage>,
}

impl Program {
    /// Returns the object with the name `name`; `None` if the scene lacks it.
    pub fn object(&mut self, name: &str) -> Option<&mut Object> {
        self.objects.iter_mut().find(|object| object.name == name)
    }

    /// Returns the shape of the object with the name `name`; `None` if the scene lacks it.
    pub fn shape(&mut self, name: &str) -> Option<&mut Shape> {
        self.object(name).map(|object| &mut object.shape)
    }

    /// Renders the picture of the scene with the mistakes of the program.
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
        let [wide, pixel] = if self.reaches_borders {
            let wider = |side: u32| f64::from(side) / f64::from(side - 1);
            [wide * wider(width), pixel * wider(height)]
        } else {
            [wide, pixel]
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
                    Axes::ParallelFromLookat => {
                        let larger = self.eye.distance(self.lookat) / self.distance;
                        (self.eye + larger * across, -w)
                    }
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

    /// Decodes a channel of a colour, from 0 to 1, to light. If the program encodes light by a
    /// power, uses the inverse power, so that the colours of the scene reappear in the picture.
    /// Otherwise uses the curve of sRGB.
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
            Sampling::SharedRandom(seed) => {
                let mut shared = SmallRng::seed_from_u64(seed);
                let mut places = std::iter::repeat_with(|| [shared.random(), shared.random()]);
                places.nth(index as usize).unwrap_or_default()
            }
            Sampling::Hammersley => {
                let inverse = f64::from(index.reverse_bits()) / 4_294_967_296.0;
                [(f64::from(index) + 0.5) / n, inverse]
            }
        }
    }
}

/// Sharpens a picture. Adds to each pixel its difference from the mean of the 3 × 3 pixels around
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

/// Returns the picture that results if a program reads rows that are `by` pixels longer or shorter
/// than the rows that were written.
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
