//! In which squares of a checkerboard a pixel lies.

use std::array;

use super::{
    super::{
        checkerboard::Checkerboard,
        object::Object,
        world::{Level, World},
    },
    local::{Here, Local, ROUNDINGS},
};
use crate::{
    area::Area,
    math::{UP, floor},
};

/// Squares of a checkerboard: N₀/ℓ and N₁/ℓ, rounded down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Squares {
    pub(super) across: [Local; 2],
    pub(super) below: Local,
    pub(super) odd: bool,
}

/// What a part of the picture shows of a checkerboard that is all that may be seen in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tiling {
    /// One square; whether that has the second colour.
    One { odd: bool },
    /// Several, of which a pixel may show but one.
    Several,
    /// So many that hardly a pixel shows but one.
    Dust,
}

impl World {
    /// Whether a part of the picture, in which a checkerboard is all that may be seen, shows but one of its squares, and then whether
    /// that has the second colour.
    pub fn only_square(&self, part: Area, object: usize) -> Option<bool> {
        self.squares(part, object)?.only()
    }

    /// What a part of the picture shows of a checkerboard that is all that may be seen in it.
    pub fn tiling(&self, part: Area, object: usize) -> Tiling {
        let Some(squares) = self.squares(part, object) else {
            return Tiling::Several;
        };
        match squares.only() {
            Some(odd) => Tiling::One { odd },
            None if squares.are_dust(part) => Tiling::Dust,
            None => Tiling::Several,
        }
    }

    fn squares(&self, part: Area, object: usize) -> Option<Squares> {
        match &*f64::object(self, object) {
            Object::Checkerboard(board) => {
                let here = Here::new(&f64::frame(self).camera, part);
                Some(Squares::new(board, &here))
            }
            _ => None,
        }
    }
}

/// The corners of a pixel, or of a part of the picture, from its middle.
const CORNERS: [(f64, f64); 4] = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];

impl Squares {
    pub(super) fn new(board: &Checkerboard<f64>, here: &Here) -> Self {
        Self {
            across: board.across.each_ref().map(|form| form.local(here)),
            below: board.below.local(here),
            odd: board.odd,
        }
    }

    /// Whether there is but one for certain, and then whether that has the second colour.
    fn only(&self) -> Option<bool> {
        let [(x, last_x), (z, last_z)] = self.ranges()?;
        (x == last_x && z == last_z).then(|| self.odd ^ is_odd(x) ^ is_odd(z))
    }

    /// From which to which square there are any in the pixel, in x and in z: perhaps one square more than there are. `None` if that
    /// is not certain.
    pub(super) fn ranges(&self) -> Option<[(f64, f64); 2]> {
        let least = self.below.factors[2] - self.below.spread() * UP;
        if least <= 4.0 * self.below.rad {
            return None;
        }
        let inverse = CORNERS.map(|(x, y)| 1.0 / self.below.at(x, y));
        let [x, z] = self.across.each_ref().map(|across| {
            // A ratio of linear forms is the greatest and the least at corners.
            let values: [f64; 4] = array::from_fn(|i| {
                let (x, y) = CORNERS[i];
                across.at(x, y) * inverse[i]
            });
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let size = low.abs().max(high.abs());
            let slack = (across.rad + size * self.below.rad) * 4.0 / least + size * ROUNDINGS;
            (slack < 0.25).then(|| (floor(low - slack), floor(high + slack)))
        });
        Some([x?, z?])
    }

    /// Whether a pixel is as long as a square in x or in z where a part of the picture shows the nearest, and so the largest of them.
    fn are_dust(&self, part: Area) -> bool {
        let nearness = |&(x, y): &(f64, f64)| self.below.at(x, y);
        let nearest = CORNERS
            .into_iter()
            .max_by(|p, q| nearness(p).total_cmp(&nearness(q)));
        let Some((x, y)) = nearest else { return false };
        let below = self.below.at(x, y);
        let pixels = [part.width, part.height].map(f64::from);
        self.across.iter().any(|across| {
            let value = across.at(x, y) / below;
            // The derivatives of a ratio of two forms: (a' − v b')/b.
            let along =
                |i: usize| (across.factors[i] - value * self.below.factors[i]).abs() / pixels[i];
            along(0) + along(1) >= below
        })
    }
}

pub(super) fn is_odd(whole: f64) -> bool {
    // `ranges` answers for numbers far below 2^53.
    whole as i64 & 1 == 1
}
