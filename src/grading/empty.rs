//! Pixels without a sample.
//!
//! Samples at random over the whole picture leave some pixels empty, which show the background, or are found in other programs. They say nothing of the scene.

use super::{
    light::{Curve, is_near},
    score::{DEVIATIONS, FLAT, Model, score},
    textbook::Moments,
};
use crate::film::Film;

/// A picture without its empty pixels, which have no number in it; none if it has none. `empty` is what these show.
///
/// A pixel that should show no such colour and does is empty if such pixels lie at random, so that not more pairs of neighbours are empty than of independent
/// pixels, and if there are not more than the noise of the others lets expect: of n samples in a pixel on an average, a share of e⁻ⁿ of the pixels has none.
pub fn without_empty(film: &Film, moments: &Moments, empty: [f64; 3]) -> Option<Film> {
    let width = film.width() as usize;
    let is_empty = |at: usize| is_near(film.pixels()[at], empty);
    let may_be_empty = |at: usize| !is_near(moments.mean[at], empty);
    let is_flat = |at: usize| moments.variance[at].iter().all(|one| *one < FLAT);
    let count = moments.mean.len();
    let judged: Vec<usize> = (0..count)
        .filter(|&at| is_flat(at) && may_be_empty(at))
        .collect();
    let found = judged.iter().filter(|&&at| is_empty(at)).count() as f64;
    if found == 0.0 {
        return None;
    }
    let share = found / judged.len() as f64;
    let (mut pairs, mut empty_pairs) = (0.0, 0.0);
    for pair in judged.windows(2) {
        if let [left, right] = *pair
            && right == left + 1
            && right % width != 0
        {
            pairs += 1.0;
            empty_pairs += f64::from(u8::from(is_empty(left) && is_empty(right)));
        }
    }
    let both = share * share;
    // Two pairs with a pixel in common are not independent.
    let variance = pairs * both * (1.0 - both + 2.0 * share * (1.0 - share));
    let are_at_random = empty_pairs - pairs * both <= DEVIATIONS * libm::sqrt(variance);
    are_at_random.then_some(())?;
    let mut without = film.clone();
    for (at, pixel) in without.pixels_mut().iter_mut().enumerate() {
        if is_empty(at) && may_be_empty(at) {
            *pixel = [f64::NAN; 3];
        }
    }
    let model = Model {
        moments: moments.clone(),
        doubt: Vec::new(),
        cut: 0.0,
        curve: Curve::Right,
    };
    // The noise is that of as many samples as one over the mean of 1/n over the pixels that have some, which is less than one more than n.
    let samples = score(without.pixels(), &model).samples?;
    let expected = judged.len() as f64 * libm::exp(1.0 - samples);
    (found - expected <= DEVIATIONS * libm::sqrt(expected)).then_some(without)
}
