//! What an error takes: samples and time, how far they can be trusted, and which method is the fastest.

use super::{
    measure::{Measurement, Point, Series},
    notes::spread,
};
use crate::scene::Method;

/// What an error takes of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needed {
    /// Samples per pixel.
    pub per_pixel: f64,
    /// The standard error of that as a factor, 1 or more: it may be so many times as many or as few. None where samples were measured
    /// and nothing was fitted, or the fit does not know.
    pub factor: Option<f64>,
    /// Seconds.
    pub seconds: f64,
    /// How far the measured times spread from which these seconds are: (greatest − least) / median.
    pub spread: f64,
    /// Whether it lies beyond what was measured.
    pub is_extrapolated: bool,
}

/// What came of taking the samples that an error should take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Check {
    /// The error that was asked for.
    pub wanted: f64,
    /// So many samples should take it there.
    pub per_pixel: u64,
    /// So many seconds they took.
    pub seconds: f64,
    /// The error that they left.
    pub rmse: f64,
    /// The largest difference that they left.
    pub largest: f64,
}

/// Which method is the fastest.
#[derive(Clone, Debug, PartialEq)]
pub enum Fastest {
    /// With the fewest samples that were measured every method comes there: nothing is known of fewer.
    All,
    /// These, the one with the least time first: those whose times cannot be told apart from its.
    Of(Vec<(Method, Needed)>),
}

impl Check {
    /// The same as a point of the method's line, in a picture of so many pixels.
    pub(super) fn point(&self, pixels: u64) -> Point {
        Point {
            per_pixel: self.per_pixel,
            samples: self.per_pixel.saturating_mul(pixels),
            times: vec![self.seconds],
            rmse: vec![self.rmse],
            largest: self.largest,
        }
    }
}

impl Needed {
    /// The time may be so many times as long or as short: the samples' factor and half of the spread.
    fn doubt(&self) -> f64 {
        self.factor.unwrap_or(1.0) * (1.0 + self.spread / 2.0)
    }
}

impl Series {
    /// What an error takes by the [`fit`](Self::fit); none if more samples do not help. Fewer samples than were measured are not asked
    /// for: they would not take less than the pixel's share of the rest.
    pub fn needed(&self, error: f64) -> Option<Needed> {
        let (first, last) = (self.points.first()?, self.points.last()?);
        if first.error() <= error {
            return Some(Needed {
                per_pixel: first.per_pixel as f64,
                factor: None,
                seconds: first.seconds(),
                spread: spread(&first.times),
                is_extrapolated: false,
            });
        }
        let fit = self.fit()?;
        let exact = fit.reaches(error)?;
        let per_pixel = exact.ceil().max(first.per_pixel as f64);
        let (seconds, spread) = self.seconds_at(per_pixel)?;
        Some(Needed {
            per_pixel,
            factor: fit.doubt(exact),
            seconds,
            spread,
            is_extrapolated: per_pixel > last.per_pixel as f64,
        })
    }

    /// The time of a number of samples, and its spread: on the straight line between the measured neighbours, beyond the last one in
    /// proportion.
    fn seconds_at(&self, per_pixel: f64) -> Option<(f64, f64)> {
        let last = self.points.last()?;
        let is_enough = |point: &Point| point.per_pixel as f64 >= per_pixel;
        Some(match self.points.iter().position(is_enough) {
            None => {
                let seconds = last.seconds() * per_pixel / last.per_pixel as f64;
                (seconds, spread(&last.times))
            }
            Some(0) => (self.points[0].seconds(), spread(&self.points[0].times)),
            Some(next) => {
                let (low, high) = (&self.points[next - 1], &self.points[next]);
                let width = (high.per_pixel - low.per_pixel) as f64;
                let share = (per_pixel - low.per_pixel as f64) / width;
                let seconds = low.seconds() + share * (high.seconds() - low.seconds());
                (seconds, spread(&low.times).max(spread(&high.times)))
            }
        })
    }

    /// What came of taking the samples that an error should take, if somebody did.
    pub fn check(&self, wanted: f64) -> Option<&Check> {
        self.checks.iter().find(|check| check.wanted == wanted)
    }
}

impl Measurement {
    /// The sampled methods that need the least time for an error; none if none comes there.
    pub fn fastest(&self, error: f64) -> Option<Fastest> {
        let is_first = |series: &Series| {
            let first = series.points.first();
            first.is_some_and(|point| point.error() <= error)
        };
        if self.series.len() > 1 && self.series.iter().all(is_first) {
            return Some(Fastest::All);
        }
        let needs = self.series.iter();
        let needs = needs.filter_map(|series| Some((series.method, series.needed(error)?)));
        let mut needs: Vec<_> = needs.collect();
        needs.sort_by(|(_, a), (_, b)| a.seconds.total_cmp(&b.seconds));
        let (_, best) = *needs.first()?;
        needs.retain(|(_, other)| {
            other.seconds / other.doubt() <= best.seconds * best.doubt() || *other == best
        });
        Some(Fastest::Of(needs))
    }
}
