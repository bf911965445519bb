//! What is wrong in a picture for certain, however it was sampled.

use glam::DVec3;

use super::{moments::range, prediction::Prediction};

/// How much a difference may be, in standard deviations, where that is known of what is random in
/// it: of a million normal errors one is greater.
pub const DEVIATIONS: f64 = 5.0;

/// In steps: half of one is rounding, and half of that another way to decode.
pub const WRONG: f64 = 0.75;

/// The pixels that no sampling of a candidate explains.
#[derive(Debug, Default)]
pub struct Strays {
    /// The pixels of one colour that show another, by more than an edge brings into them that is
    /// half a pixel off.
    pub pixels: Vec<usize>,
    /// Their squared difference.
    square: f64,
    /// The pixels of several colours, their squared difference, and that which is expected of one
    /// sample in each.
    edges: Vec<(usize, f64, f64)>,
}

impl Strays {
    /// The squared difference of the pixels of one colour, and of the others what is more than one
    /// sample in each makes.
    pub fn square(&self) -> f64 {
        let beyond = self
            .edges
            .iter()
            .map(|(_, square, variance)| square - variance);
        self.square + beyond.sum::<f64>().max(0.0)
    }

    /// Whether there are none, or no more pixels of one colour than are missed.
    pub fn are_no_more(&self, missed: usize) -> bool {
        let are_few = self.pixels.len() <= missed;
        let of_edges = Self {
            edges: self.edges.clone(),
            ..Self::default()
        };
        are_few && of_edges.are_empty(1, |_| Some(0)) == [true]
    }

    /// Whether there are none in each of some groups of pixels.
    pub fn are_empty(&self, groups: usize, group: impl Fn(usize) -> Option<usize>) -> Vec<bool> {
        let mut is_right = vec![true; groups];
        for group in self.pixels.iter().filter_map(|at| group(*at)) {
            is_right[group] = false;
        }
        let mut sums = vec![(0.0, 0.0); groups];
        for (at, square, variance) in &self.edges {
            if let Some(group) = group(*at) {
                let (squares, expected) = &mut sums[group];
                (*squares, *expected) = (*squares + square, *expected + variance);
            }
        }
        // Light is 1 at most, so the square of a pixel's sum over three channels is expected to be
        // no more than three times the sum, and its variance no more than that.
        let is_noise = |(squares, expected): (f64, f64)| {
            squares - expected <= DEVIATIONS * libm::sqrt(3.0 * expected)
        };
        let pairs = is_right.into_iter().zip(sums);
        pairs
            .map(|(is_right, sums)| is_right && is_noise(sums))
            .collect()
    }
}

impl Prediction<'_> {
    /// What is wrong for certain.
    pub fn strays(&self) -> Strays {
        let mut strays = Strays::default();
        for at in 0..self.seen.len() {
            let (difference, allowed) = (self.difference(at), self.allowed(at));
            let squares = difference * difference;
            if self.is_flat(at) {
                let beyond = difference.abs() - allowed;
                if beyond.max_element() > 0.0 && beyond.cmpgt(self.reach(at)).any() {
                    strays.pixels.push(at);
                    strays.square += squares.element_sum();
                }
            } else {
                let beyond = (squares - allowed * allowed).max(DVec3::ZERO);
                let expected = self.moments.variance[at].element_sum();
                strays.edges.push((at, beyond.element_sum(), expected));
            }
        }
        strays
    }

    /// How much the light of a pixel may change if edges move by half a pixel: half of how much the
    /// pixels around it differ, or the standard deviation of a sample in one of them, which
    /// half of each of two colours make half of their difference.
    fn reach(&self, at: usize) -> DVec3 {
        let [least, most] = range(&self.moments.mean, self.width, at, 1);
        let [_, variance] = range(&self.moments.variance, self.width, at, 1);
        ((most - least) / 2.0).max(variance.map(f64::sqrt))
    }

    /// What a pixel may differ by for its rounding and for what is not known of it.
    fn allowed(&self, at: usize) -> DVec3 {
        WRONG * self.steps(at) + DEVIATIONS * self.moments.doubt[at].map(f64::sqrt)
    }
}
