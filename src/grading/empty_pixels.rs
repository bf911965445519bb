//! Pixels without a sample.
//!
//! Samples at random over the whole picture leave some pixels empty: these show the background, or
//! black in some programs, and say nothing of the scene.

use std::sync::Arc;

use glam::DVec3;

use super::{
    light::{Curve, is_near},
    moments::Moments,
    prediction::{FLAT, Prediction},
    strays::DEVIATIONS,
};
use crate::film::Film;

/// A picture without its empty pixels, which have no number in it; none if it has none. `empty` is
/// what these show.
///
/// A pixel that should show no such colour and does is empty if such pixels lie at random, so that
/// not more pairs of neighbours, beside or below each other, are empty than of independent pixels,
/// and if there are not more than the noise of the others lets expect: of n samples in a pixel on
/// an average, a share of e⁻ⁿ of the pixels has none.
pub fn without_empty(film: &Film, moments: &Arc<Moments>, empty: [f64; 3]) -> Option<Film> {
    let width = film.width() as usize;
    let is_empty = |at: usize| is_near(film.pixels()[at], empty);
    let may_be_empty = |at: usize| !is_near(moments.mean[at].into(), empty);
    let is_flat = |at: usize| moments.variance[at].max_element() < FLAT;
    // Of those that tell, whether they are empty.
    let told: Vec<Option<bool>> = (0..moments.mean.len())
        .map(|at| (is_flat(at) && may_be_empty(at)).then(|| is_empty(at)))
        .collect();
    let count = told.iter().flatten().count() as f64;
    let found = told.iter().filter(|told| **told == Some(true)).count() as f64;
    if found == 0.0 {
        return None;
    }
    let share = found / count;
    let (mut pairs, mut empty_pairs) = (0.0, 0.0);
    for (at, one) in told.iter().enumerate() {
        let beside = told.get(at + 1).filter(|_| (at + 1) % width != 0);
        for other in beside.into_iter().chain(told.get(at + width)) {
            if let (Some(one), Some(other)) = (one, other) {
                pairs += 1.0;
                empty_pairs += f64::from(u8::from(*one && *other));
            }
        }
    }
    let both = share * share;
    // A pair has a pixel in common with six others, from which it is not independent: so much more
    // the count varies than one of independent pairs.
    let more = 1.0 - both + 6.0 * share * (1.0 - share);
    is_chance(empty_pairs / more, pairs * both / more).then_some(())?;
    let mut without = film.clone();
    for (at, pixel) in without.pixels_mut().iter_mut().enumerate() {
        if is_empty(at) && may_be_empty(at) {
            *pixel = [f64::NAN; 3];
        }
    }
    let seen: Vec<DVec3> = without.pixels().iter().copied().map(DVec3::from).collect();
    let prediction = Prediction::new(&seen, width, Arc::clone(moments), Curve::Right);
    // The noise is that of as many samples as one over the mean of 1/n over the pixels that have
    // some, which is less than one more than n.
    let samples = prediction.score().samples?;
    let expected = count * libm::exp(1.0 - samples);
    is_chance(found, expected).then_some(without)
}

/// Whether a count of independent events may be so large by chance, by Chernoff's bound of the
/// Poisson distribution: P(X ≥ k) ≤ e^(k − m) (m / k)^k for k > m.
fn is_chance(count: f64, mean: f64) -> bool {
    count <= mean
        || count * libm::log(count / mean) - (count - mean) <= DEVIATIONS * DEVIATIONS / 2.0
}
