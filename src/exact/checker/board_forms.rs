//! A checkerboard in the coordinates of pixels and of parts of them: three linear forms, whose ratios are places on the board.
//!
//! In: the board, and a sub-pixel or eight pixels. Out: the forms N₀, N₁ and ℓ, moved to a corner of squares near to the pixel, with bounds on their
//! errors: for one sub-pixel in any precision, by [`SubPixelFrame::board_forms`]; for eight pixels in double-double, by the same operations on
//! plain arrays, which the compiler makes vectors of. When two corners of squares are equally near to the pixel, the two ways may choose different ones.

use glam::DVec2;
use multiversion::multiversion;

use crate::{
    math::{Big, Double, ROUND, Real},
    tracer::{LOOSE_LINE, Object, Precision, SubPixel, SubPixelFrame, World},
};

/// So many pixels at a time: as many numbers as the widest vectors have.
pub const PIXELS: usize = 8;

/// Forms are prepared here if their largest factors are between this and its inverse, so that products of five neither overflow nor vanish.
const SMALL: f64 = 1e-60;

/// From how many squares on a pixel's nearest one is not told here: far below 2^51, up to which [`ROUND`] rounds.
const FAR: f64 = 1e9;

/// A checkerboard in a sub-pixel: the point (x, y) shows the board's point (N₀/ℓ, N₁/ℓ), in squares from
/// a corner of squares near to the sub-pixel, where ℓ > 0.
#[derive(Clone, Copy, Debug)]
pub struct Board {
    /// The factors of x, y and 1 in N₀ and N₁.
    pub across: [[f64; 3]; 2],
    /// Those of ℓ.
    pub below: [f64; 3],
    /// How far a value of each of these forms may be from the true one, but for the rounding of the factors.
    pub rads: [f64; 3],
    /// Whether the square [0, 1)² has the second colour.
    pub odd: bool,
}

/// What all pixels have in common of a checkerboard.
#[derive(Clone, Debug)]
pub struct Boards {
    /// N₀, N₁ and ℓ: the factors of X, Y and 1.
    forms: [[Double; 3]; 3],
    /// Their factors of x and y in a pixel.
    slopes: [[Double; 2]; 3],
    /// How far their values may be from the true ones.
    rads: [f64; 3],
    pitch: Double,
    /// Half the picture's sides.
    half: DVec2,
    odd: bool,
}

/// A checkerboard in some pixels, as [`Board`] has it, but for a common factor of its forms.
#[derive(Clone, Debug, Default)]
pub struct Views {
    /// The factors of x, y and 1 in N₀ and N₁.
    pub across: [[[f64; PIXELS]; 3]; 2],
    /// Those of ℓ.
    pub below: [[f64; PIXELS]; 3],
    /// How far a value of these forms may be from the true one, but for the rounding of the factors; infinite where [`board`] should
    /// be asked.
    pub rad: [f64; PIXELS],
    /// −1 where the square [0, 1)² has the second colour, else 1.
    pub sign: [f64; PIXELS],
}

/// An object in pixels, if it is a checkerboard.
pub fn boards(world: &World, object: usize) -> Option<Boards> {
    let object = Double::object(&world.geometry, object);
    let Object::Checkerboard(board) = &*object else {
        return None;
    };
    let camera = &Double::frame(&world.geometry).camera;
    let [a, b] = &board.across;
    let forms = [a, b, &board.below];
    Some(Boards {
        forms: forms.map(|form| *form.factors()),
        slopes: forms.map(|form| {
            let [x, y, _] = form.factors();
            [x, y].map(|factor| factor.times(&camera.pitch))
        }),
        rads: forms.map(|form| form.rad()),
        pitch: camera.pitch,
        half: camera.half,
        odd: board.odd,
    })
}

/// An object's squares in a sub-pixel, if it is a checkerboard.
pub fn board(world: &World, object: usize, sub_pixel: SubPixel) -> Option<Board> {
    let board = board_in::<Double>(world, object, sub_pixel)?;
    match board.doubt() < LOOSE_LINE {
        true => Some(board),
        false => board_in::<Big>(world, object, sub_pixel),
    }
}

fn board_in<T: Precision>(world: &World, object: usize, sub_pixel: SubPixel) -> Option<Board> {
    let object = T::object(&world.geometry, object);
    let Object::Checkerboard(board) = &*object else {
        return None;
    };
    let frame = SubPixelFrame::new(&T::frame(&world.geometry).camera, sub_pixel);
    let [a, b] = &board.across;
    let (lines, is_moved) = frame.board_forms([a, b], &board.below);
    let rads = lines.each_ref().map(|line| line.rad);
    let factors = lines.map(|line| line.factors);
    let [a, b, below] = factors.map(|factors| factors.map(|c| c.hi));
    Some(Board {
        across: [a, b],
        below,
        rads,
        odd: board.odd ^ is_moved,
    })
}

impl Board {
    /// How far the value of a form may be from the true one, by the size of its terms; infinite where squares are too small for the range of
    /// `f64`.
    pub fn doubt(&self) -> f64 {
        let [a, b] = &self.across;
        let forms = [a, b, &self.below].into_iter().zip(self.rads);
        forms.fold(0.0, |doubt, ([x, y, z], rad)| {
            let size = 0.5 * (x.abs() + y.abs()) + z.abs();
            match size.is_finite() && size > 0.0 {
                true => doubt.max(rad / size),
                false => f64::INFINITY,
            }
        })
    }
}

impl Boards {
    /// What the pixels of these columns and rows see.
    pub fn at(&self, columns: &[u32; PIXELS], rows: &[u32; PIXELS], out: &mut Views) {
        see_simd(self, columns, rows, out);
    }

    /// As `SubPixelFrame::board_forms` has it, step by step.
    #[inline(always)]
    fn see(&self, columns: &[u32; PIXELS], rows: &[u32; PIXELS], out: &mut Views) {
        const ONE: u64 = 1.0f64.to_bits();
        // Copies, of which the compiler knows that nothing that is written is one of them.
        let Self {
            forms,
            slopes,
            rads,
            pitch,
            half,
            odd,
        } = self.clone();
        let below = slopes[2];
        let corner = below.map(|slope| 0.5_f64.copysign(slope.hi));
        let steepest = below[0].hi.abs().max(below[1].hi.abs());
        let (mut x, mut y, mut level) = (Doubles::new(), Doubles::new(), Doubles::new());
        let (mut sizes, mut rad) = ([0.0; PIXELS], [0.0; PIXELS]);
        for i in 0..PIXELS {
            // Half-integers below 2^21: exact.
            let column = f64::from(columns[i]) + 0.5 - half.x;
            let row = f64::from(rows[i]) + 0.5 - half.y;
            x.set(i, Double::from_f64(column).times(&pitch));
            y.set(i, Double::from_f64(row).times(&pitch));
            let [a, b, c] = &forms[2];
            let middle = a.times(&x.get(i)).plus(&b.times(&y.get(i))).plus(c);
            level.set(i, middle);
            let steep = corner[0] * below[0].hi + corner[1] * below[1].hi + middle.hi;
            sizes[i] = steepest.max(middle.hi.abs());
            rad[i] = if steep > 0.0 { rads[2] } else { f64::INFINITY };
        }
        let mut bits = [ONE | u64::from(odd) << 63; PIXELS];
        for form in 0..2 {
            let ([a, b, c], slopes, own_rad) = (&forms[form], &slopes[form], rads[form]);
            let of_corner = corner[0] * slopes[0].hi + corner[1] * slopes[1].hi;
            let of_below = corner[0] * below[0].hi + corner[1] * below[1].hi;
            let mut factors = [[0.0; PIXELS]; 3];
            for i in 0..PIXELS {
                let middle = a.times(&x.get(i)).plus(&b.times(&y.get(i))).plus(c);
                let times = (of_corner + middle.hi) / (of_below + level.hi[i]);
                let rounded = times + ROUND;
                bits[i] ^= rounded.to_bits() << 63;
                let whole = rounded - ROUND;
                let often = Double::from_f64(-whole);
                let first = slopes[0].plus(&below[0].times(&often)).hi;
                let second = slopes[1].plus(&below[1].times(&often)).hi;
                let third = middle.plus(&level.get(i).times(&often)).hi;
                (factors[0][i], factors[1][i], factors[2][i]) = (first, second, third);
                sizes[i] = sizes[i].max(first.abs()).max(second.abs()).max(third.abs());
                let moved = own_rad + rads[2] * (2.0 * whole.abs());
                let moved = if times.abs() < FAR {
                    moved
                } else {
                    f64::INFINITY
                };
                rad[i] = rad[i].max(moved);
            }
            out.across[form] = factors;
        }
        for i in 0..PIXELS {
            let size = sizes[i];
            let is_good = (rad[i] < LOOSE_LINE * size) & (size > SMALL) & (size < 1.0 / SMALL);
            rad[i] = if is_good { rad[i] } else { f64::INFINITY };
        }
        out.below = [[below[0].hi; PIXELS], [below[1].hi; PIXELS], level.hi];
        out.rad = rad;
        out.sign = bits.map(f64::from_bits);
    }
}

/// Several numbers in double-double.
struct Doubles {
    hi: [f64; PIXELS],
    lo: [f64; PIXELS],
}

impl Doubles {
    #[inline(always)]
    fn new() -> Self {
        Self {
            hi: [0.0; PIXELS],
            lo: [0.0; PIXELS],
        }
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Double {
        Double {
            hi: self.hi[i],
            lo: self.lo[i],
        }
    }

    #[inline(always)]
    fn set(&mut self, i: usize, Double { hi, lo }: Double) {
        (self.hi[i], self.lo[i]) = (hi, lo);
    }
}

#[multiversion(targets = "simd")]
fn see_simd(boards: &Boards, columns: &[u32; PIXELS], rows: &[u32; PIXELS], out: &mut Views) {
    boards.see(columns, rows, out);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scene,
        source::{Source, Sources},
        tracer::SubPixel,
    };

    fn world(camera: &str) -> World {
        let text = format!(
            "image {{ width 640 height 480 background black }}\ncamera {{ {camera} }}\n\
             checkerboard {{ y 0.25 square 0.7 colors (gray, white) }}"
        );
        let sources = Sources::new(Source::from_text("a.scn", &text));
        World::new(&scene::read(&sources).scene.expect("a scene"))
    }

    #[test]
    fn pixels_together_see_what_each_sees_for_itself() {
        for (camera, known) in [
            ("eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75", 300),
            (
                "eye (-7, 0.5, 1e4) lookat (0, 0, 0) roll 30deg fov 140deg",
                200,
            ),
            ("eye (1e7, 2, 3) lookat (1e7, 0, 0) fov 60deg", 300),
            // So high that a pixel is far from all squares' corners.
            (
                "eye (0, 1e14, 0) lookat (1, 0, 0) up (0, 0, 1) fov 60deg",
                0,
            ),
        ] {
            let world = world(camera);
            let boards = boards(&world, 0).expect("a checkerboard");
            let mut views = Views::default();
            let mut compared = 0;
            for row in (0..480).step_by(8) {
                let columns = [1, 0, 9, 100, 319, 320, 600, 639];
                let rows = [0, 1, 2, 3, 4, 5, 6, 7].map(|k| row + k);
                boards.at(&columns, &rows, &mut views);
                for i in 0..PIXELS {
                    if views.rad[i].is_infinite() {
                        continue;
                    }
                    let one = board(&world, 0, SubPixel::pixel(columns[i], rows[i])).expect("it");
                    let scale = one.below[2] / views.below[2][i];
                    assert_eq!(libm::frexp(scale).0, 0.5, "a power of two");
                    let scaled = |form: &[[f64; PIXELS]; 3]| form.map(|factor| factor[i] * scale);
                    assert_eq!(views.across.each_ref().map(scaled), one.across);
                    assert_eq!(scaled(&views.below), one.below);
                    assert_eq!(
                        views.rad[i] * scale,
                        one.rads.into_iter().fold(0.0, f64::max)
                    );
                    assert_eq!(views.sign[i], if one.odd { -1.0 } else { 1.0 });
                    compared += 1;
                }
            }
            assert!(compared >= known, "{camera}: {compared}");
        }
    }
}
