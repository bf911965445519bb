//! Finds the pixels in which a program took no sample, and removes them from the picture.
//!
//! If a program spreads its samples at random over the whole picture, some pixels get none. Such a
//! pixel shows the background, or black in some programs, and says nothing about the scene.

use std::sync::Arc;

use glam::DVec3;

use super::{
    hypotheses::{Curve, is_near},
    scoring::{DEVIATIONS, FLAT, Moments, Prediction},
};
use crate::film::Film;

/// Replaces pixels that seem to lack a sample by NaN. `moments` describes the exact picture, and
/// `empty` is the colour that the program writes into pixels without a sample. Returns `None` if no
/// pixel is replaced.
///
/// A pixel is suspected if it has the colour `empty` and the exact picture has another colour
/// there. No pixel is replaced in two cases. In the first case, suspected pixels are neighbours
/// more often than by chance. In the second case, there are more of them than expected. With n
/// samples per pixel on average, a fraction e⁻ⁿ of the pixels should have none. The number n is
/// estimated from the noise of the other pixels.
pub fn without_empty(film: &Film, moments: &Arc<Moments>, empty: [f64; 3]) -> Option<Film> {
    let width = film.width() as usize;
    let is_empty = |at: usize| is_near(film.pixels()[at], empty);
    let may_be_empty = |at: usize| !is_near(moments.mean[at].into(), empty);
    let is_flat = |at: usize| moments.variance[at].max_element() < FLAT;
    // State of each pixel: `Some(true)` if it seems to lack a sample, and `Some(false)` if it has
    // one. `None` if this cannot be seen, because several colours meet in the pixel, or because it
    // should show the colour `empty`.
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
    // Two neighbouring pixels form a pair. A pair is empty if both pixels lack a sample. Each pair
    // shares a pixel with six others, so pairs are not independent. The number of empty pairs
    // therefore has a larger variance than a Poisson variable of the same mean. `more` is this
    // variance divided by the mean. The observed and the expected number are divided by it, so that
    // the bound for Poisson variables applies.
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
    // Let n be the mean number of samples of all pixels. The expected fraction of empty pixels,
    // e⁻ⁿ, is less than e^(1 − `samples`), for the following reason. `samples` is estimated from
    // the noise, so it is the harmonic mean of the sample counts of the pixels that have samples.
    // It is at most their arithmetic mean, n/(1 − e⁻ⁿ), which is less than n + 1.
    let samples = prediction.score().samples?;
    let expected = count * libm::exp(1.0 - samples);
    is_chance(found, expected).then_some(without)
}

/// Returns whether `count` independent events may occur by chance if `mean` events are expected.
/// Uses Chernoff's bound for a Poisson variable X with the mean m. The probability of k or more
/// events, for k > m, is P(X ≥ k) ≤ e^(k − m) (m/k)^k.
fn is_chance(count: f64, mean: f64) -> bool {
    count <= mean
        || count * libm::log(count / mean) - (count - mean) <= DEVIATIONS * DEVIATIONS / 2.0
}
