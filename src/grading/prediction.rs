//! What the cells of a level should show if a candidate is right, beside what they show.

use std::sync::Arc;

use glam::DVec2;

use super::{
    grid::Grid,
    light::{Curve, Look, STEP, is_near},
    moments::{Moments, range},
};
use crate::color::{linear_to_srgb, srgb_to_linear};

/// The variance below which a pixel shows one colour: a part of 1e-9 of it may be another.
pub const FLAT: f64 = 1e-9;

/// Half a step is what is lost on an average where bytes are cut off.
const CUT_OFF: f64 = -0.5;

/// What is expected, and what is seen.
#[derive(Clone, Debug)]
pub struct Prediction<'a> {
    /// What is seen, as light that was encoded by the curve; no numbers where that is not known.
    pub seen: &'a [[f64; 3]],
    /// How many cells are in a row.
    pub width: usize,
    /// Means and variances of what is expected.
    pub moments: Arc<Moments>,
    /// How light is encoded.
    pub curve: Curve,
    /// Whether bytes are cut off, not rounded.
    pub is_cut_off: bool,
}

impl Prediction<'_> {
    /// Does to the light what is done to it.
    pub fn look(&mut self, looks: &[Look], grid: &Grid) {
        if looks.is_empty() {
            return;
        }
        let seen = self.seen;
        let Moments { mean, variance, .. } = Arc::make_mut(&mut self.moments);
        for look in looks {
            match *look {
                Look::Channels(order) => {
                    for one in mean.iter_mut().chain(variance.iter_mut()) {
                        *one = order.map(|i| one[i]);
                    }
                }
                Look::Gray(weights) => {
                    for one in mean.iter_mut() {
                        *one = [(0..3).map(|i| weights[i] * one[i]).sum(); 3];
                    }
                    for one in variance.iter_mut() {
                        let deviation: f64 = (0..3).map(|i| weights[i] * one[i].sqrt()).sum();
                        *one = [deviation * deviation; 3];
                    }
                }
                Look::Curve(curve) => {
                    let changed = |mean: f64, variance: f64| {
                        // The slope over what noise of a step, of many samples or of one may
                        // reach, whichever is greater: light that is cut off has none beside
                        // where it is.
                        let slope = |part: f64| {
                            let by = variance.sqrt().max(STEP) * part;
                            let (low, high) = ((mean - by).max(0.0), mean + by);
                            (curve(high) - curve(low)) / (high - low)
                        };
                        let slope = slope(0.25).abs().max(slope(1.0).abs());
                        [curve(mean), variance * (slope * slope)]
                    };
                    // Most cells show what the one before shows, and a curve takes long.
                    let mut known = [[[f64::NAN; 2]; 2]; 3];
                    for (mean, variance) in mean.iter_mut().zip(variance.iter_mut()) {
                        for i in 0..3 {
                            let own = [mean[i], variance[i]];
                            if known[i][0] != own {
                                known[i] = [own, changed(mean[i], variance[i])];
                            }
                            [mean[i], variance[i]] = known[i][1];
                        }
                    }
                }
                Look::CutOff => self.is_cut_off = true,
                Look::Patch { light, area } => {
                    let [least, most] = area.map(DVec2::from);
                    let is_part = |at: usize| {
                        let place = grid.middle(at);
                        let is_within = place.cmpge(least).all() && place.cmplt(most).all();
                        is_within && is_near(seen[at], light)
                    };
                    for at in (0..seen.len()).filter(|&at| is_part(at)) {
                        // Its border is mixed with what is beside it.
                        for near in grid.around(at, 1) {
                            (mean[near], variance[near]) = (seen[near], [0.0; 3]);
                        }
                    }
                }
            }
        }
    }

    /// Whether a cell should show one colour.
    pub fn is_flat(&self, at: usize) -> bool {
        self.moments.variance[at].iter().all(|one| *one < FLAT)
    }

    /// The light of a step of the encoding in a cell.
    pub fn steps(&self, at: usize) -> [f64; 3] {
        self.moments.mean[at].map(|light| self.curve.step(light))
    }

    /// By how much a cell shows more light than is expected.
    pub fn difference(&self, at: usize) -> [f64; 3] {
        let (seen, mean) = (self.seen[at], self.moments.mean[at]);
        if seen[0].is_nan() {
            return [0.0; 3];
        }
        if !self.is_cut_off {
            return [0, 1, 2].map(|i| seen[i] - mean[i]);
        }
        let is_flat = self.is_flat(at);
        let encoded = |light| linear_to_srgb(self.curve.seen(light));
        [0, 1, 2].map(|i| {
            let by = (encoded(seen[i]) - encoded(mean[i])) / STEP;
            // A colour alone is cut off or not, by the last bit of its number; mixtures lose half a
            // step.
            let expected = match is_flat {
                true => by.clamp(2.0 * CUT_OFF, 0.0),
                false => CUT_OFF,
            };
            let cut = encoded(mean[i]) + expected * STEP;
            seen[i] - self.curve.light(srgb_to_linear(cut.max(0.0)))
        })
    }

    /// The differences of all cells, channel by channel, in the picture's own light.
    pub fn differences(&self) -> Vec<f64> {
        let own = |at: usize| match self.curve {
            Curve::Right => self.difference(at),
            curve => {
                let (difference, mean) = (self.difference(at), self.moments.mean[at]);
                let own = |light: f64| curve.seen_quickly(light);
                [0, 1, 2].map(|i| own(mean[i] + difference[i]) - own(mean[i]))
            }
        };
        (0..self.seen.len()).flat_map(own).collect()
    }

    /// The standard deviations that these may have, as the mean of a single sample: an edge may be
    /// one pixel off.
    pub fn deviations(&self) -> Vec<f64> {
        let cells = 0..self.seen.len();
        let deviations = cells.flat_map(|at| {
            let [_, variance] = range(&self.moments.variance, self.width, at, 1);
            let doubt = self.moments.doubt[at];
            [0, 1, 2].map(|i| (variance[i] + doubt[i] + STEP * STEP).sqrt())
        });
        deviations.collect()
    }
}
