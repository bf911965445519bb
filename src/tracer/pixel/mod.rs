//! Many samples of one pixel at once.
//!
//! In a pixel every boundary is a linear or a quadratic form of the offset from the pixel's centre, and each has one bound on the error
//! of all its values there. So the objects that may be seen in the pixel are written down as a few forms, those that have one sign all
//! over it are left out, and what is left is evaluated for all samples in plain arrays, which the compiler makes vectors of. A form is
//! divided by its error bound: beyond ±1 its sign is certain. A sample that is not certain is asked for again on its own, exactly, so
//! that nothing here can change what is seen: it only says it sooner.

mod lanes;
mod local;
mod mesh;
mod prepare;
mod squares;

use glam::DVec2;

use self::{
    lanes::{BACKGROUND, CHUNK, DOUBT, Lanes},
    local::Line,
    squares::Squares,
};
use super::{outlook::Live, world::World};
use crate::math::Vectors;

pub use self::{
    local::{Conic, Here, Local},
    mesh::Checks,
};

/// Fewer samples than this are not worth the preparation.
const FEW: usize = 4;

/// A pixel's objects, prepared for many samples. Kept from pixel to pixel for its room.
#[derive(Debug, Default)]
pub struct Pixel {
    /// The candidates.
    live: Vec<Live>,
    x: u32,
    y: u32,
    surfaces: Vec<Surface>,
    /// Of all surfaces.
    lines: Vec<Line>,
    /// How the surfaces lie, if that is to be looked at sample by sample.
    depths: Option<f64>,
    /// Of all surfaces, if they are looked at.
    planes: Vec<Local>,
    /// Whether samples are to be traced one by one.
    is_hard: bool,
    lanes: Lanes,
}

/// What a pixel shows of an object.
#[derive(Debug)]
struct Surface {
    /// Its place among the candidates.
    place: usize,
    /// Where its boundaries begin among all lines, and where they end: each is ≥ 0 where it is hit.
    edges: [usize; 2],
    /// The boundary of a sphere.
    conic: Option<Conic>,
    pattern: Pattern,
    depth: Depth,
}

/// Which of its colours an object shows.
#[derive(Debug)]
enum Pattern {
    /// The first or the second.
    Plain(f64),
    /// The first where the product of the lines up to `end`, behind the edges, is positive, if not `odd`.
    Lines { end: usize, odd: bool },
    /// Squares by division.
    Squares(Squares),
}

/// Where the inverse depth of a surface comes from.
#[derive(Debug)]
enum Depth {
    /// It is not asked for.
    Unknown,
    /// The least of some planes'.
    Least([usize; 2]),
    /// The greatest of them.
    Greatest([usize; 2]),
    /// That of the near side of a sphere, (b + √Q) · factor.
    Sphere { q: Conic, b: Local, factor: f64 },
}

impl World {
    /// Prepares a pixel, given the objects that may be seen there, in file order, and, if they are but a board and that is known, what
    /// is seen of it.
    pub fn look(
        &self,
        [x, y]: [u32; 2],
        live: &[Live],
        checks: Option<&Checks>,
        pixel: &mut Pixel,
    ) {
        (pixel.x, pixel.y) = (x, y);
        pixel.live.clear();
        pixel.live.extend_from_slice(live);
        let prepared = match checks {
            Some(checks) => pixel.prepare_checks(checks),
            None => pixel.prepare(self),
        };
        pixel.is_hard = prepared.is_err();
    }

    /// Counts what the samples at some offsets from the centre of a pixel see: `count` is told slots of the palette, each any number
    /// of times.
    pub fn count(
        &self,
        pixel: &mut Pixel,
        points: &[DVec2],
        vectors: Vectors,
        mut count: impl FnMut(usize, u64),
    ) {
        if pixel.is_hard || points.len() < FEW {
            for &point in points {
                count(
                    self.slot_among(pixel.x, pixel.y, point, pixel.live.iter()),
                    1,
                );
            }
            return;
        }
        for points in points.chunks(CHUNK) {
            pixel.chunk(points, vectors);
            let seen = &pixel.lanes.seen[..points.len()];
            let mut left = points.len() as u64;
            let mut tell = |code: f64, slot: usize| {
                let lanes = seen.iter().filter(|&&lane| lane == code).count() as u64;
                if lanes > 0 {
                    count(slot, lanes);
                    left -= lanes;
                }
            };
            for surface in &pixel.surfaces {
                let [first, second] = self.slots(pixel.live[surface.place].object);
                match surface.pattern {
                    Pattern::Plain(code) if code == surface.code(true) => tell(code, second),
                    Pattern::Plain(code) => tell(code, first),
                    _ => {
                        tell(surface.code(false), first);
                        tell(surface.code(true), second);
                    }
                }
            }
            tell(BACKGROUND, self.background());
            if left > 0 {
                for (&point, &lane) in points.iter().zip(seen) {
                    if lane == DOUBT {
                        let slot = self.slot_among(pixel.x, pixel.y, point, pixel.live.iter());
                        count(slot, 1);
                    }
                }
            }
        }
    }
}

impl Surface {
    /// What stands for one of its colours.
    fn code(&self, odd: bool) -> f64 {
        (2 * self.place + 1 + usize::from(odd)) as f64
    }
}
