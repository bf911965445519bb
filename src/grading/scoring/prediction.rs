//! Compares the light that the cells of a picture show with the light that they should show if a
//! hypothesis about the program is correct.

use std::{cell::OnceCell, sync::Arc};

use glam::{DVec2, DVec3};

use super::{
    grid::Grid,
    moments::{Moments, range},
};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    grading::hypotheses::{Curve, Effect, STEP, Tabulated, encoded_quickly, is_near},
};

/// Variance of one sample, in squared linear light, below which a pixel is treated as having one
/// colour. With this value, a black pixel with a white spot of about a billionth of its area still
/// counts as black.
pub const FLAT: f64 = 1e-9;

/// Light of a channel, from 0 to 1, above which the channel is treated as full, i.e. as possibly
/// clipped. Only the two greatest byte values, 254 and 255, are above 0.99.
const FULL: f64 = 0.99;
/// Light of a channel, from 0 to 1, below which the channel is not used to estimate the factor by
/// which a program multiplies light. Rounding to bytes changes a light of 0.01 by up to 3 %, and
/// darker light by more.
const EMPTY: f64 = 0.01;
/// Maximum relative difference between two factors that are treated as equal. A factor is the ratio
/// of observed to predicted light. The factor of each cell is compared with the median, and the
/// final factor with 1. Rounding to bytes changes a light of at least 0.01 ([`EMPTY`]) by at most
/// about 3 %.
const ALIKE: f64 = 0.03;

/// Mean change of a value that is truncated to 8 bits, in 8-bit steps. Truncation loses between 0
/// and 1 step.
const CUT_OFF: f64 = -0.5;

/// Predicted and observed light of the cells of a picture.
#[derive(Clone, Debug)]
pub struct Prediction<'a> {
    /// Observed light of the cells, decoded by `curve`; NaN in cells without a pixel to compare.
    pub observed: &'a [DVec3],
    /// Number of cells in a row.
    pub width: usize,
    /// Means and variances of the predicted light.
    pub moments: Arc<Moments>,
    /// Curve by which the program encodes light.
    pub curve: Curve,
    /// Whether the program truncates values to bytes instead of rounding them.
    pub is_cut_off: bool,
    /// Fitted factor by which the program multiplies light. It is 1 unless the program has the
    /// effect `Effect::Gain`.
    pub gain: f64,
    /// Differences between observed and predicted light if the program truncates bytes. Cached,
    /// because they take long to compute.
    of_cut_off: OnceCell<Vec<DVec3>>,
}

/// Blurs a picture of cells by a Gaussian with the variance `variance`, in squared cells. There are
/// `width` cells in a row.
///
/// The Gaussian is approximated by repeated blurring with a kernel of three cells. With the weights
/// a, 1 − 2a and a, this kernel has the variance 2a. Here a is at most 1/16.
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

/// Applies a curve to the mean of each channel, and multiplies the variance by the squared slope of
/// the curve. The slope is computed from `quick`, a fast approximation of the curve.
fn map_channels(
    mean: &mut [DVec3],
    variance: &mut [DVec3],
    curve: impl Fn(f64) -> f64,
    quick: impl Fn(f64) -> f64,
) {
    let slope_of = |mean: f64, variance: f64| {
        let mean = mean.clamp(0.0, 1.0);
        // The slope is the mean slope over the range of light that noise spans: one standard
        // deviation of a sample, but at least an 8-bit step, on both sides of the mean. If the
        // curve is clipped, a part of this range is flat, and the mean slope is too small. So the
        // slope is also computed over a quarter of the range, and the steeper slope is used.
        let slope = |part: f64| {
            let by = variance.sqrt().max(STEP) * part;
            let (low, high) = ((mean - by).max(0.0), (mean + by).min(1.0));
            (quick(high) - quick(low)) / (high - low)
        };
        slope(0.25).abs().max(slope(1.0).abs())
    };
    // Last argument and result of `curve`, for each channel. They are cached because most cells
    // equal the one before, and the curve may be slow.
    let mut known = [[f64::NAN; 2]; 3];
    for (mean, variance) in mean.iter_mut().zip(variance) {
        for i in 0..3 {
            if variance[i] != 0.0 {
                let slope = slope_of(mean[i], variance[i]);
                variance[i] *= slope * slope;
            }
            if known[i][0] != mean[i] {
                known[i] = [mean[i], curve(mean[i])];
            }
            mean[i] = known[i][1];
        }
    }
}

/// Maximum relative difference between an estimated factor and a power of 2 at which the factor is
/// replaced by this power. Rounding to bytes changes the estimate by less than this difference.
const POWER: f64 = 0.005;

/// Estimates the factor by which a program multiplies light, after applying `function`. In each
/// channel of each cell that should show one colour, the factor is the ratio of observed to
/// predicted light. The result is a mean of the ratios close to their median. It is 1 if less than
/// half of the ratios are close, or if the mean is close to 1. Channels that are full, i.e.
/// clipped, are ignored. If all are full, the result is the least factor that makes all of them
/// full.
fn gain(observed: &[DVec3], mean: &[DVec3], variance: &[DVec3], function: &Tabulated) -> f64 {
    let flat = (0..mean.len()).filter(|&at| variance[at].max_element() < FLAT);
    let pairs = flat.flat_map(|at| [0, 1, 2].map(|i| [observed[at][i], mean[at][i]]));
    let pairs = pairs.filter(|[seen, mean]| !seen.is_nan() && *mean > EMPTY);
    let (full, pairs): (Vec<_>, Vec<_>) = pairs.partition(|[seen, _]| *seen > FULL);
    let pairs = pairs
        .into_iter()
        .map(|pair| pair.map(|light| function.at(light)));
    let pairs: Vec<_> = pairs.collect();
    let mut ratios: Vec<f64> = pairs.iter().map(|[seen, mean]| seen / mean).collect();
    if ratios.is_empty() {
        let least = full.iter().map(|[_, mean]| 1.0 / function.at(*mean));
        return least.fold(1.0, f64::max);
    }
    let middle = ratios.len() / 2;
    let median = *ratios.select_nth_unstable_by(middle, f64::total_cmp).1;
    let is_near = |[seen, mean]: &&[f64; 2]| (seen / mean / median - 1.0).abs() < ALIKE;
    let near: Vec<_> = pairs.iter().filter(is_near).collect();
    if 2 * near.len() < pairs.len() {
        return 1.0;
    }
    let [seen, mean] = near
        .iter()
        .fold([0.0; 2], |sums, pair| [0, 1].map(|i| sums[i] + pair[i]));
    let gain = seen / mean;
    // Programs that divide by a wrong number of samples usually multiply light by a power of 2. So
    // an estimate close to such a power is replaced by it.
    let power = libm::exp2(libm::log2(gain).round());
    let is_power = (gain / power - 1.0).abs() < POWER;
    match gain {
        _ if (gain - 1.0).abs() < ALIKE => 1.0,
        _ if is_power => power,
        _ => gain,
    }
}

impl<'a> Prediction<'a> {
    /// Creates a prediction for a program that encodes light by `curve`.
    pub fn new(observed: &'a [DVec3], width: usize, moments: Arc<Moments>, curve: Curve) -> Self {
        Self {
            observed,
            width,
            moments,
            curve,
            is_cut_off: false,
            gain: 1.0,
            of_cut_off: OnceCell::new(),
        }
    }

    /// Applies a program's effects on light to the prediction.
    pub fn apply(&mut self, effects: &[Effect], grid: &Grid) {
        if effects.is_empty() {
            return;
        }
        let observed = self.observed;
        let Moments { mean, variance, .. } = Arc::make_mut(&mut self.moments);
        for effect in effects {
            match *effect {
                Effect::Channels(order) => {
                    for one in mean.iter_mut().chain(variance.iter_mut()) {
                        let light = one.to_array();
                        let at = |i: usize| light.get(i).copied().unwrap_or(0.0);
                        *one = order.map(at).into();
                    }
                }
                Effect::Gray(weights) => {
                    for one in mean.iter_mut() {
                        *one = DVec3::splat(one.dot(weights.into()));
                    }
                    for one in variance.iter_mut() {
                        let deviation = one.map(f64::sqrt).dot(weights.into());
                        *one = DVec3::splat(deviation * deviation);
                    }
                }
                Effect::PerChannel(curve) => {
                    let quick = Tabulated::new(curve);
                    map_channels(mean, variance, curve, |light| quick.at(light));
                }
                Effect::Gain(functions) => {
                    let [to, from] = functions;
                    let quick = functions.map(Tabulated::new);
                    let gain = gain(observed, mean, variance, &quick[0]);
                    self.gain = gain;
                    let curve = |light| from((gain * to(light)).min(1.0));
                    let quick = |light| quick[1].at(gain * quick[0].at(light));
                    map_channels(mean, variance, curve, quick);
                }
                Effect::CutOff => self.is_cut_off = true,
                Effect::Sharpened => {
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
                            // Sharpening amplifies noise. The added standard deviation is estimated
                            // by the change of the cell's mean, so the square of this change is
                            // added to the variance.
                            let by = mean[at] - before;
                            variance[at] += by * by;
                        }
                    }
                }
                Effect::Blur(width) => {
                    // A square of the width w has the variance w²/12 along each axis. A correct
                    // pixel has the width 1. So the blur that widens it has the variance (w² −
                    // 1)/12.
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
                Effect::Patch { light, area } => {
                    let [least, most] = area.map(DVec2::from);
                    let is_part = |at: usize| {
                        let place = grid.middle(at);
                        let is_within = place.cmpge(least).all() && place.cmplt(most).all();
                        is_within && is_near(observed[at].into(), light)
                    };
                    for at in (0..observed.len()).filter(|&at| is_part(at)) {
                        // At the border of the patch, its colour mixes with the colours around it.
                        // So adjacent cells are replaced, too.
                        for near in grid.around(at, 1) {
                            (mean[near], variance[near]) = (observed[near], DVec3::ZERO);
                        }
                    }
                }
            }
        }
    }

    /// Returns whether a cell should show one colour.
    pub fn is_flat(&self, at: usize) -> bool {
        self.moments.variance[at].max_element() < FLAT
    }

    /// Returns the difference in light between neighbouring 8-bit values, at the predicted mean of
    /// a cell, for each channel.
    pub fn steps(&self, at: usize) -> DVec3 {
        self.moments.mean[at].map(|light| self.curve.step(light))
    }

    /// Returns the observed light of a cell minus the predicted light. Returns 0 in a cell without
    /// a pixel to compare.
    pub fn difference(&self, at: usize) -> DVec3 {
        if self.observed[at].x.is_nan() {
            return DVec3::ZERO;
        }
        if !self.is_cut_off {
            return self.observed[at] - self.moments.mean[at];
        }
        let all = self.of_cut_off.get_or_init(|| {
            let cells = 0..self.observed.len();
            cells.map(|at| self.difference_of_cut_off(at)).collect()
        });
        all[at]
    }

    /// Encodes light as the program does. The light and the result are from 0 to 1.
    pub fn encoded(&self, light: f64) -> f64 {
        match self.curve {
            Curve::Correct => encoded_quickly(light),
            curve => linear_to_srgb(curve.seen(light)),
        }
    }

    /// Returns the difference between the observed and the predicted light of a cell, if the
    /// program truncates bytes. In a cell of one colour, truncation drops the fraction of the byte.
    /// In other cells, it loses half a step on average.
    fn difference_of_cut_off(&self, at: usize) -> DVec3 {
        let (seen, mean) = (self.observed[at], self.moments.mean[at]);
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

    /// Returns the differences between observed and predicted light for each channel of each cell.
    /// Light is what viewers of the picture's file see.
    pub fn differences(&self) -> Vec<f64> {
        let own = |at: usize| match self.curve {
            Curve::Correct => self.difference(at),
            curve => {
                let (difference, mean) = (self.difference(at), self.moments.mean[at]);
                let own = |light: DVec3| light.map(|light| curve.seen_quickly(light));
                own(mean + difference) - own(mean)
            }
        };
        (0..self.observed.len())
            .flat_map(|at| own(at).to_array())
            .collect()
    }

    /// Returns for each channel of each cell the standard deviation of the difference between
    /// observed and predicted light if the cell had one sample. It is computed from the greatest
    /// variance of a sample in the cell and its neighbours, so that it is large enough even if
    /// edges are displaced by a cell.
    pub fn deviations(&self) -> Vec<f64> {
        let cells = 0..self.observed.len();
        let deviations = cells.flat_map(|at| {
            let [_, variance] = range(&self.moments.variance, self.width, at, 1);
            (variance + self.moments.mean_variance[at] + STEP * STEP)
                .map(f64::sqrt)
                .to_array()
        });
        deviations.collect()
    }
}
