//! What tries say of an error: where it lies, and how far one render differs from the next.

use super::{
    fit::{certainty, log_error, median, root_mean_square},
    ladder::{Found, Line, ln_samples},
    measure::{Point, Series},
    notes::spread,
};
use crate::scene::Method;

/// So many tries near an answer tell how much one render differs from the next.
pub(super) const FEWEST_TRIES: usize = 3;

/// A try is near a place if the logarithms of their samples are no farther apart than this, or its samples no more than one farther.
const NEAR: f64 = 0.3;

/// The logarithm of an answer lies no farther than this from the middle of the tries that it rests on: a single one may have hit the exact picture by luck.
const STRIDE: f64 = 1.4;

/// Samples taken because an error should take about so many.
#[derive(Clone, Debug, PartialEq)]
pub struct Try {
    /// The error that was asked for.
    pub wanted: f64,
    /// The seed of its run, which no other run of the method has.
    pub seed: u64,
    /// What came of it, in a single run.
    pub point: Point,
}

/// A place by tries.
pub(super) struct Tried<'a> {
    /// ln of the samples.
    pub(super) x: f64,
    /// ln of how many the tries near it have, in the mean.
    pub(super) middle: f64,
    /// The tries near the place before the last of them, or that one if none was: those that it rests on.
    pub(super) near: Vec<&'a Point>,
}

impl Series {
    /// The tries for an error, in the order in which they were made.
    pub fn tries_for(&self, wanted: f64) -> impl Iterator<Item = &Try> {
        self.tries.iter().filter(move |it| it.wanted == wanted)
    }

    /// Where tries for an error say that it lies, and which of them are near; none if no line leads there.
    pub(super) fn approach(&self, error: f64) -> Option<Tried<'_>> {
        match self.by_points(error)? {
            Found::Point(_) => None,
            Found::Line(line) => Some(self.tried(error, &line)),
        }
    }

    /// Follows the tries for an error from where the line says that it lies: after each one it lies where those near the place, or that one if none is, say by
    /// the line's slope.
    pub(super) fn tried(&self, error: f64, line: &Line) -> Tried<'_> {
        let tries: Vec<_> = self.tries_for(error).map(|it| &it.point).collect();
        let mut tried = Tried {
            x: line.x,
            middle: line.x,
            near: Vec::new(),
        };
        for made in 1..=tries.len() {
            let is_near = |point: &&Point| is_near(point, tried.x);
            let mut near: Vec<_> = tries[..made].iter().copied().filter(is_near).collect();
            if near.is_empty() {
                near.push(tries[made - 1]);
            }
            let middle =
                near.iter().map(|point| ln_samples(point)).sum::<f64>() / near.len() as f64;
            let left = root_mean_square(&alike(&near, middle, line.slope));
            let way = (libm::log(left) - libm::log(error)) / line.slope.abs();
            tried = Tried {
                x: (middle + way.clamp(-STRIDE, STRIDE)).max(0.0),
                middle,
                near,
            };
        }
        tried
    }

    /// How far a place by tries may be off, if that is known: by how much renders with about so many samples differ from each other, whether it is the seed
    /// or the count that makes the difference, and as far as it is from the middle of the tries, since the slope might be twice or half of the line's.
    pub(super) fn doubt(&self, tried: &Tried, line: &Line) -> Option<f64> {
        let k = tried.near.len();
        // What one render differs from the next, and surely no more.
        let surely = |errors: &[f64]| {
            let runs = errors.len();
            Some(certainty(runs - 1) * log_error(errors)? * (runs as f64).sqrt())
        };
        let theirs = match k {
            1 => None,
            _ => Some(surely(&alike(&tried.near, tried.middle, line.slope))?),
        };
        let differs = match k < FEWEST_TRIES {
            false => theirs?,
            // As much as runs of the last planned point differ besides: two tries may be alike by luck.
            true => {
                let last = self.points.last().filter(|_| self.is_independent())?;
                surely(&last.rmse)?.max(theirs.unwrap_or(0.0))
            }
        };
        let render = differs * (1.0 + 1.0 / k as f64).sqrt() / line.slope.abs();
        let doubt = libm::hypot(render, tried.x - tried.middle);
        Some(doubt).filter(|_| self.method != Method::Regular)
    }

    /// The time of a number of samples by tries with about as many, in the median, and how far they spread.
    pub(super) fn seconds_by(&self, near: &[&Point], per_pixel: f64) -> (f64, f64) {
        let times = near
            .iter()
            .map(|point| point.seconds() * per_pixel / point.per_pixel as f64);
        let times: Vec<_> = times.collect();
        let spread = match times.len() {
            1 => self.time_spread(near[0]),
            _ => spread(&times),
        };
        (median(&times), spread)
    }
}

fn is_near(point: &Point, x: f64) -> bool {
    let samples = point.per_pixel as f64;
    (libm::exp(x - NEAR) - 1.0..=libm::exp(x + NEAR) + 1.0).contains(&samples)
}

/// The errors that points would have with e to the `middle` samples, if they lay on lines of this slope.
fn alike(points: &[&Point], middle: f64, slope: f64) -> Vec<f64> {
    let moved = points.iter().map(|point| {
        let way = middle - ln_samples(point);
        point.error() * libm::exp(slope * way)
    });
    moved.collect()
}
