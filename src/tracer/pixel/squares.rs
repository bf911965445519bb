//! In which squares of a checkerboard a pixel lies.

use std::array;

use super::{
    super::checkerboard::Checkerboard,
    local::{Here, Local, ROUNDINGS},
};
use crate::math::{UP, floor};

/// Squares of a checkerboard: N₀/ℓ and N₁/ℓ, rounded down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Squares {
    pub(super) across: [Local; 2],
    pub(super) below: Local,
    pub(super) odd: bool,
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
}

pub(super) fn is_odd(whole: f64) -> bool {
    // `ranges` answers for numbers far below 2^53.
    whole as i64 & 1 == 1
}
