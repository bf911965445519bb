//! Removes the pixels without a sample.
//!
//! Samples at random over the whole picture leave some pixels empty: these show the background, or
//! black in some programs, and carry no information about the scene.

use std::sync::Arc;

use glam::DVec3;

use super::{
    hypotheses::{Curve, is_near},
    scoring::{DEVIATIONS, FLAT, Moments, Prediction},
};
use crate::film::Film;

/// Returns a picture whose empty pixels are NaN. Returns `None` if it has none. `empty` is the
/// colour of empty pixels.
///
/// A pixel that shows this colour and should not is empty if such pixels lie at random: no more
/// pairs of neighbours, beside or below each other, are empty than of independent pixels, and there
/// are no more of them than the noise of the others implies. Of n samples in a pixel on average, a
/// share of e⁻ⁿ of the pixels has none.
pub fn without_empty(film: &Film, moments: &Arc<Moments>, empty: [f64; 3]) -> Option<Film> {
    let width = film.width() as usize;
    let is_empty = |at: usize| is_near(film.pixels()[at], empty);
    let may_be_empty = |at: usize| !is_near(moments.mean[at].into(), empty);
    let is_flat = |at: usize| moments.variance[at].max_element() < FLAT;
    // Whether each pixel of one colour that should have another one than `empty` is empty.
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
    // A pair shares a pixel with six others, on which it depends: this is the factor by which the
    // count's variance exceeds that of independent pairs.
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
    // The noise corresponds to one over the mean of 1/n over the pixels that have samples, which is
    // less than n + 1.
    let samples = prediction.score().samples?;
    let expected = count * libm::exp(1.0 - samples);
    is_chance(found, expected).then_some(without)
}

/// Returns whether a count of independent events may be chance, by Chernoff's bound of the Poisson
/// distribution: P(X ≥ k) ≤ e^(k − m) (m / k)^k for k > m.
fn is_chance(count: f64, mean: f64) -> bool {
    count <= mean
        || count * libm::log(count / mean) - (count - mean) <= DEVIATIONS * DEVIATIONS / 2.0
}
