//! What an error takes of each method, and which method takes the least time.

use super::measurement::{Measurement, Point, Series};
use crate::scene::Method;

/// What an error takes of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needed {
    /// Samples per pixel; none of the exact method.
    pub per_pixel: Option<f64>,
    /// CPU time in seconds.
    pub cpu: f64,
    /// Wall time in seconds.
    pub wall: f64,
    /// Whether it lies beyond what was measured.
    pub is_extrapolated: bool,
}

impl Measurement {
    /// What an error takes of a sampled method. None if more samples do not help, or if the reference is not known well enough to tell such an error
    /// from none: by the root of the mean of its bounds' squares, since errors are such means.
    pub fn needed(&self, series: &Series, error: f64) -> Option<Needed> {
        self.tells(error).then(|| series.needed(error)).flatten()
    }

    /// The same of the exact method, if that was measured.
    pub fn exact_needed(&self, error: f64) -> Option<Needed> {
        let exact = self.exact.as_ref().filter(|_| self.tells(error))?;
        Some(Needed {
            per_pixel: None,
            cpu: exact.cpu(),
            wall: exact.wall(),
            is_extrapolated: false,
        })
    }

    fn tells(&self, error: f64) -> bool {
        error > self.reference.root_mean_square_bound()
    }

    /// The methods that come to an error, the one with the least CPU time first.
    pub fn fastest(&self, error: f64) -> Vec<(Method, Needed)> {
        let sampled = self.series.iter();
        let sampled = sampled.filter_map(|it| Some((it.method, self.needed(it, error)?)));
        let exact = self
            .exact_needed(error)
            .map(|needed| (Method::Exact, needed));
        let mut all: Vec<_> = sampled.chain(exact).collect();
        // Where the system does not tell the CPU time, no method has the least.
        all.retain(|(_, needed)| needed.cpu.is_finite());
        all.sort_by(|(_, a), (_, b)| a.cpu.total_cmp(&b.cpu));
        all
    }
}

impl Series {
    /// Errors are taken to fall as a power of the samples: by the line in logarithms through the two numbers of samples that were measured on either
    /// side, or the last two of them. Times are taken to grow evenly with the samples. Where the least number is enough, it is that.
    pub fn needed(&self, error: f64) -> Option<Needed> {
        let points = &self.points;
        // From here on no error that was measured is greater.
        let enough = points.iter().rposition(|point| point.error() > error);
        let enough = enough.map_or(0, |last| last + 1);
        let (samples, is_extrapolated) = if enough == 0 {
            // Fewer may be enough, too, but nobody has tried.
            (points.first()?.per_pixel as f64, false)
        } else {
            let pair = enough.min(points.len().saturating_sub(1).max(1));
            let (few, many) = (points.get(pair - 1)?, points.get(pair)?);
            let falls = libm::log(few.error() / many.error());
            let samples = [few, many].map(|point| point.per_pixel as f64);
            // Without any error, these are enough for whatever is asked for.
            let share = libm::log(few.error() / error) / falls;
            let share = if many.error() == 0.0 { 1.0 } else { share };
            let is_falling = falls > 0.0;
            let samples = samples[0] * libm::pow(samples[1] / samples[0], share);
            (is_falling.then_some(samples)?, enough != pair)
        };
        let per_pixel = samples.ceil().max(1.0);
        per_pixel.is_finite().then(|| Needed {
            per_pixel: Some(per_pixel),
            cpu: self.time_at(per_pixel, |point| point.times.cpu()),
            wall: self.time_at(per_pixel, |point| point.times.wall()),
            is_extrapolated,
        })
    }

    /// The time that so many samples take, no fewer than the first point's: by the line between the points on either side, or between the first and the last.
    fn time_at(&self, per_pixel: f64, time: fn(&Point) -> f64) -> f64 {
        let points = &self.points;
        let [first, .., last] = points.as_slice() else {
            return points.first().map_or(f64::NAN, time);
        };
        let around = |pair: &&[Point]| {
            (pair[0].per_pixel as f64..=pair[1].per_pixel as f64).contains(&per_pixel)
        };
        let slope = |a: &Point, b: &Point| (time(b) - time(a)) / (b.per_pixel - a.per_pixel) as f64;
        let along = |a: &Point, slope: f64| time(a) + slope * (per_pixel - a.per_pixel as f64);
        if let Some([a, b]) = points.windows(2).find(around) {
            return along(a, slope(a, b));
        }
        // More samples take no less time.
        let slope = match slope(first, last) {
            falling if falling < 0.0 => 0.0,
            slope => slope,
        };
        along(last, slope)
    }
}
