//! What the cells of a level should show if a candidate is right, beside what they show.

use std::{cell::OnceCell, sync::Arc};

use glam::{DVec2, DVec3};

use super::{
    grid::Grid,
    light::{Curve, Look, STEP, Tabulated, encoded_quickly, is_near},
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
    pub seen: &'a [DVec3],
    /// How many cells are in a row.
    pub width: usize,
    /// Means and variances of what is expected.
    pub moments: Arc<Moments>,
    /// How light is encoded.
    pub curve: Curve,
    /// Whether bytes are cut off, not rounded.
    pub is_cut_off: bool,
    /// The differences where they are, which are asked for again and again and take long.
    of_cut_off: OnceCell<Vec<DVec3>>,
}

/// Means of cells in rows of a width with those beside them, spread by a variance in cells squared.
///
/// Weights a, 1 − 2a, a have the variance 2a. They are applied again and again, with an a of at
/// most a sixteenth, so that they reach as far as those of a bell curve do.
fn blurred(mut cells: Vec<DVec3>, width: usize, variance: f64) -> Vec<DVec3> {
    let height = cells.len() / width;
    let rounds = (8.0 * variance).ceil();
    let weight = variance / (2.0 * rounds.max(1.0));
    for _ in 0..rounds as usize {
        for [count, step, lines, next] in [[width, 1, height, width], [height, width, width, 1]] {
            for line in 0..lines {
                let at = |i: usize| line * next + i * step;
                let mut before = cells[at(0)];
                for i in 0..count {
                    let own = cells[at(i)];
                    let after = cells[at((i + 1).min(count - 1))];
                    cells[at(i)] = own + weight * (before + after - 2.0 * own);
                    before = own;
                }
            }
        }
    }
    cells
}

impl<'a> Prediction<'a> {
    /// Expects moments where light is seen that was encoded by a curve.
    pub fn new(seen: &'a [DVec3], width: usize, moments: Arc<Moments>, curve: Curve) -> Self {
        Self {
            seen,
            width,
            moments,
            curve,
            is_cut_off: false,
            of_cut_off: OnceCell::new(),
        }
    }

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
                        *one = order.map(|i| one[i]).into();
                    }
                }
                Look::Gray(weights) => {
                    for one in mean.iter_mut() {
                        *one = DVec3::splat(one.dot(weights.into()));
                    }
                    for one in variance.iter_mut() {
                        let deviation = one.map(f64::sqrt).dot(weights.into());
                        *one = DVec3::splat(deviation * deviation);
                    }
                }
                Look::Curve(curve) => {
                    let quick = Tabulated::new(curve);
                    let slope_of = |mean: f64, variance: f64| {
                        let mean = mean.clamp(0.0, 1.0);
                        // The slope over what noise of a step, of many samples or of one may
                        // reach, whichever is greater: light that is cut off has none beside
                        // where it is.
                        let slope = |part: f64| {
                            let by = variance.sqrt().max(STEP) * part;
                            let (low, high) = ((mean - by).max(0.0), (mean + by).min(1.0));
                            (quick.at(high) - quick.at(low)) / (high - low)
                        };
                        slope(0.25).abs().max(slope(1.0).abs())
                    };
                    // Most cells show what the one before shows, and a curve takes long.
                    let mut known = [[f64::NAN; 2]; 3];
                    for (mean, variance) in mean.iter_mut().zip(variance.iter_mut()) {
                        for i in 0..3 {
                            let slope = slope_of(mean[i], variance[i]);
                            variance[i] *= slope * slope;
                            if known[i][0] != mean[i] {
                                known[i] = [mean[i], curve(mean[i])];
                            }
                            mean[i] = known[i][1];
                        }
                    }
                }
                Look::CutOff => self.is_cut_off = true,
                Look::Sharpened => {
                    let encoded: Vec<DVec3> =
                        mean.iter().map(|light| light.map(linear_to_srgb)).collect();
                    let pixels = f64::from(grid.factor * grid.factor);
                    for (at, own) in encoded.iter().enumerate() {
                        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
                        for near in grid.around(at, 1) {
                            (sum, count) = (sum + encoded[near], count + 1.0);
                        }
                        let more = (*own - sum / count) / pixels;
                        if more != DVec3::ZERO {
                            let before = mean[at];
                            let sharp = (*own + more).clamp(DVec3::ZERO, DVec3::ONE);
                            mean[at] = sharp.map(srgb_to_linear);
                            // As noise is sharpened, too.
                            let by = mean[at] - before;
                            variance[at] += by * by;
                        }
                    }
                }
                Look::Blur(width) => {
                    // A square of the width w has the variance w²/12 in each direction.
                    let cell = f64::from(grid.factor);
                    let spread = (width * width - 1.0) / (12.0 * cell * cell);
                    let squares = variance.iter().zip(mean.iter());
                    let squares = squares
                        .map(|(variance, mean)| variance + mean * mean)
                        .collect();
                    let squares = blurred(squares, self.width, spread);
                    *mean = blurred(std::mem::take(mean), self.width, spread);
                    let both = variance.iter_mut().zip(squares.iter().zip(mean.iter()));
                    for (variance, (square, mean)) in both {
                        *variance = (square - mean * mean).max(DVec3::ZERO);
                    }
                }
                Look::Patch { light, area } => {
                    let [least, most] = area.map(DVec2::from);
                    let is_part = |at: usize| {
                        let place = grid.middle(at);
                        let is_within = place.cmpge(least).all() && place.cmplt(most).all();
                        is_within && is_near(seen[at].into(), light)
                    };
                    for at in (0..seen.len()).filter(|&at| is_part(at)) {
                        // Its border is mixed with what is beside it.
                        for near in grid.around(at, 1) {
                            (mean[near], variance[near]) = (seen[near], DVec3::ZERO);
                        }
                    }
                }
            }
        }
    }

    /// Whether a cell should show one colour.
    pub fn is_flat(&self, at: usize) -> bool {
        self.moments.variance[at].max_element() < FLAT
    }

    /// The light of a step of the encoding in a cell.
    pub fn steps(&self, at: usize) -> DVec3 {
        self.moments.mean[at].map(|light| self.curve.step(light))
    }

    /// By how much a cell shows more light than is expected.
    pub fn difference(&self, at: usize) -> DVec3 {
        if !self.is_cut_off {
            let seen = self.seen[at];
            return if seen.x.is_nan() {
                DVec3::ZERO
            } else {
                seen - self.moments.mean[at]
            };
        }
        let all = self.of_cut_off.get_or_init(|| {
            let cells = 0..self.seen.len();
            cells.map(|at| self.difference_of_cut_off(at)).collect()
        });
        all[at]
    }

    /// Encodes light as the picture's files do: sRGB from 0 to 1.
    pub fn encoded(&self, light: f64) -> f64 {
        match self.curve {
            Curve::Right => encoded_quickly(light),
            curve => linear_to_srgb(curve.seen(light)),
        }
    }

    /// Returns the difference of a cell whose bytes are cut off. A colour alone is cut off or not,
    /// by the last bit of its number; mixtures lose half a step on an average.
    fn difference_of_cut_off(&self, at: usize) -> DVec3 {
        let (seen, mean) = (self.seen[at], self.moments.mean[at]);
        if seen.x.is_nan() {
            return DVec3::ZERO;
        }
        let is_flat = self.is_flat(at);
        DVec3::from([0, 1, 2].map(|i| {
            let by = (self.encoded(seen[i]) - self.encoded(mean[i])) / STEP;
            let expected = match is_flat {
                true if (2.0 * CUT_OFF..=0.0).contains(&by) => return 0.0,
                true => by.clamp(2.0 * CUT_OFF, 0.0),
                false => CUT_OFF,
            };
            let cut = self.encoded(mean[i]) + expected * STEP;
            seen[i] - self.curve.light(srgb_to_linear(cut.max(0.0)))
        }))
    }

    /// The differences of all cells, channel by channel, in the picture's own light.
    pub fn differences(&self) -> Vec<f64> {
        let own = |at: usize| match self.curve {
            Curve::Right => self.difference(at),
            curve => {
                let (difference, mean) = (self.difference(at), self.moments.mean[at]);
                let own = |light: DVec3| light.map(|light| curve.seen_quickly(light));
                own(mean + difference) - own(mean)
            }
        };
        (0..self.seen.len())
            .flat_map(|at| own(at).to_array())
            .collect()
    }

    /// The standard deviations that these may have, as the mean of a single sample: an edge may be
    /// one pixel off.
    pub fn deviations(&self) -> Vec<f64> {
        let cells = 0..self.seen.len();
        let deviations = cells.flat_map(|at| {
            let [_, variance] = range(&self.moments.variance, self.width, at, 1);
            (variance + self.moments.doubt[at] + STEP * STEP)
                .map(f64::sqrt)
                .to_array()
        });
        deviations.collect()
    }
}
