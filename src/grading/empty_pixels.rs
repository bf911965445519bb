//! Finds the pixels without a sample, and removes them.
//!
//! If samples are spread at random over the whole picture, some pixels get none. Such a pixel shows
//! the background, or black in some programs, and says nothing about the scene.

use std::sync::Arc;

use glam::DVec3;

use super::{
    hypotheses::{Curve, is_near},
    scoring::{DEVIATIONS, FLAT, Moments, Prediction},
};
use crate::film::Film;

/// Replaces pixels without a sample by NaN. `moments` describes the exact picture, and `empty` is
/// the colour that a program writes into a pixel without a sample. Returns `None` if no pixel seems
/// to lack a sample.
///
/// A pixel is suspected if it has the colour `empty` and the exact picture has another colour
/// there. The suspicion is dropped in two cases. First, if suspects are neighbours more often than
/// by chance. Second, if there are more suspects than expected: with n samples per pixel on
/// average, a fraction e⁻ⁿ of the pixels has none. Here n is estimated from the noise of the other
/// pixels.
pub fn without_empty(film: &Film, moments: &Arc<Moments>, empty: [f64; 3]) -> Option<Film> {
    let width = film.width() as usize;
    let is_empty = |at: usize| is_near(film.pixels()[at], empty);
    let may_be_empty = |at: usize| !is_near(moments.mean[at].into(), empty);
    let is_flat = |at: usize| moments.variance[at].max_element() < FLAT;
    // `Some(true)` for a pixel that seems to lack a sample, `Some(false)` for a pixel that has one.
    // `None` if this cannot be seen: several colours meet in the pixel, or the pixel should show
    // `empty`.
    let states: Vec<Option<bool>> = (0..moments.mean.len())
        .map(|at| (is_flat(at) && may_be_empty(at)).then(|| is_empty(at)))
        .collect();
    let count = states.iter().flatten().count() as f64;
    let found = states.iter().filter(|state| **state == Some(true)).count() as f64;
    if found == 0.0 {
        return None;
    }
    let share = found / count;
    let (mut pairs, mut empty_pairs) = (0.0, 0.0);
    for (at, one) in states.iter().enumerate() {
        let beside = states.get(at + 1).filter(|_| (at + 1) % width != 0);
        for other in beside.into_iter().chain(states.get(at + width)) {
            if let (Some(one), Some(other)) = (one, other) {
                pairs += 1.0;
                empty_pairs += f64::from(u8::from(*one && *other));
            }
        }
    }
    let both = share * share;
    // Two neighbouring pixels form a pair. Pairs that share a pixel are not independent, and each
    // pair shares a pixel with six others. So the number of pairs without a sample has a larger
    // variance than a Poisson variable of the same mean. `more` is the quotient of this variance
    // and the mean. The observed and the expected number of such pairs are both divided by it, so
    // that the bound for a Poisson variable applies.
    let more = 1.0 - both + 6.0 * share * (1.0 - share);
    if !is_chance(empty_pairs / more, pairs * both / more) {
        return None;
    }
    let mut without = film.clone();
    for (at, pixel) in without.pixels_mut().iter_mut().enumerate() {
        if is_empty(at) && may_be_empty(at) {
            *pixel = [f64::NAN; 3];
        }
    }
    let seen: Vec<DVec3> = without.pixels().iter().copied().map(DVec3::from).collect();
    let prediction = Prediction::new(&seen, width, Arc::clone(moments), Curve::Correct);
    // `samples` is estimated from the noise. It is therefore the harmonic mean of the sample counts
    // of all pixels that have samples. Their arithmetic mean is n/(1 − e⁻ⁿ), where n is the mean
    // sample count of all pixels. A harmonic mean is at most the arithmetic one, so `samples` is
    // less than n + 1. So the expected fraction of empty pixels, e⁻ⁿ, is less than e^(1 −
    // `samples`).
    let samples = prediction.score().samples?;
    let expected = count * libm::exp(1.0 - samples);
    is_chance(found, expected).then_some(without)
}

/// Returns whether `count` independent events may be chance if `mean` are expected. Uses Chernoff's
/// bound for a Poisson variable X with the mean m: P(X ≥ k) ≤ e^(k − m) (m/k)^k for k > m.
fn is_chance(count: f64, mean: f64) -> bool {
    count <= mean
        || count * libm::log(count / mean) - (count - mean) <= DEVIATIONS * DEVIATIONS / 2.0
}
