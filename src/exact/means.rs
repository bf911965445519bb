//! Means of the colours' values over a pixel.
//!
//! In: the fraction of a pixel that shows each colour, with an error bound. Out: the mean of each
//! value of the colours, with its bound.

use std::array;

use super::{ExactPixel, Integrator, checker::UNIT};
use crate::tracer::VisibilityCandidate;

impl<const N: usize> Integrator<'_, N> {
    /// Returns the mean of the colours' values over a pixel. `by_slot` contains the fraction of the
    /// pixel that shows each entry of the world's palette, and `bound` becomes the mean's bound.
    pub(super) fn mean(&self, by_slot: &[(usize, f64)], bound: f64) -> ExactPixel<N> {
        let mut mean = [0.0; N];
        match by_slot {
            [(color_index, _)] => mean = self.colors[*color_index],
            by_slot => {
                let total: f64 = by_slot.iter().map(|(_, share)| share).sum();
                for (color_index, share) in by_slot {
                    for (sum, channel) in mean.iter_mut().zip(self.colors[*color_index]) {
                        *sum += share * channel;
                    }
                }
                mean = mean.map(|sum| (sum / total).clamp(0.0, 1.0));
            }
        }
        ExactPixel { mean, bound }
    }

    /// Moves the mean of `pixel` to the middle of the range in which the true mean may lie, with
    /// half the range's width as the bound. The range is the mean plus or minus its bound, limited
    /// to the values of the colours that may be seen in the pixel.
    pub(super) fn center_in_range(
        &self,
        pixel: &ExactPixel<N>,
        candidates: &[VisibilityCandidate],
    ) -> ExactPixel<N> {
        let is_covered = candidates.iter().any(|candidate| candidate.is_whole);
        let background = (!is_covered).then(|| self.world.background());
        let color_indices = candidates
            .iter()
            .flat_map(|candidate| self.world.color_indices(candidate.object));
        let (mut low, mut high) = ([f64::INFINITY; N], [f64::NEG_INFINITY; N]);
        for color_index in color_indices.chain(background) {
            let color = self.colors[color_index];
            low = array::from_fn(|i| low[i].min(color[i]));
            high = array::from_fn(|i| high[i].max(color[i]));
        }
        let ExactPixel { mean, bound } = *pixel;
        let least: [f64; N] = array::from_fn(|i| (mean[i] - bound).max(low[i]));
        let greatest: [f64; N] = array::from_fn(|i| (mean[i] + bound).min(high[i]));
        let widths = (0..N).map(|i| greatest[i] - least[i]);
        ExactPixel {
            mean: array::from_fn(|i| least[i].midpoint(greatest[i])),
            // The two ends of the range are at most 1, and each causes at most two roundings of one
            // unit roundoff.
            bound: 0.5 * widths.fold(0.0, f64::max) + 4.0 * UNIT,
        }
    }
}

/// Returns the maximum rounding error of a mean of `colors` colours. The sum of the shares and the
/// sum of the products cause at most `colors` roundings each. The products and the quotient cause
/// one each. The mean of a single colour is exact.
pub(super) fn rounding(colors: usize) -> f64 {
    match colors {
        0..=1 => 0.0,
        _ => (2 * colors + 2) as f64 * UNIT,
    }
}
