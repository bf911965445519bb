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
        all.sort_by(|(_, a), (_, b)| a.cpu.total_cmp(&b.cpu));
        all
    }
}

impl Series {
    /// Errors are taken to fall as a power of the samples: between two numbers of samples that were measured, by the line through both in
    /// logarithms; beyond the last, and before the first, from there with the fitted slope. Times are taken to grow evenly with the samples.
    pub fn needed(&self, error: f64) -> Option<Needed> {
        let points = &self.points;
        // From here on no error that was measured is greater.
        let enough = points.iter().rposition(|point| point.error() > error);
        let enough = enough.map_or(0, |last| last + 1);
        let at = |samples: f64, is_extrapolated: bool| {
            let per_pixel = samples.ceil().max(1.0);
            per_pixel.is_finite().then(|| Needed {
                per_pixel: Some(per_pixel),
                cpu: self.time_at(per_pixel, |point| point.times.cpu()),
                wall: self.time_at(per_pixel, |point| point.times.wall()),
                is_extrapolated,
            })
        };
        let point = points.get(enough).or(points.last())?;
        let samples = point.per_pixel as f64;
        if enough > 0 && enough < points.len() {
            let (few, many) = (&points[enough - 1], point);
            if many.error() == 0.0 {
                return at(samples, false);
            }
            let share = libm::log(few.error() / error) / libm::log(few.error() / many.error());
            let few = few.per_pixel as f64;
            return at(few * libm::pow(samples / few, share), false);
        }
        if enough == 0 && point.per_pixel == 1 {
            return at(1.0, false);
        }
        let slope = self
            .fit()
            .map(|fit| fit.slope)
            .filter(|&slope| slope < 0.0)?;
        at(
            samples * libm::pow(error / point.error(), 1.0 / slope),
            true,
        )
    }

    /// The time that so many samples take, by the line between the points on either side, or between the first and the last.
    fn time_at(&self, per_pixel: f64, time: fn(&Point) -> f64) -> f64 {
        let points = &self.points;
        let [first, .., last] = points.as_slice() else {
            return points.first().map_or(f64::NAN, time);
        };
        let around = |pair: &&[Point]| {
            (pair[0].per_pixel as f64..=pair[1].per_pixel as f64).contains(&per_pixel)
        };
        let (a, b) = match points.windows(2).find(around) {
            Some(pair) => (&pair[0], &pair[1]),
            None => (first, last),
        };
        let a_second = (time(b) - time(a)) / (b.per_pixel - a.per_pixel) as f64;
        (time(a) + a_second * (per_pixel - a.per_pixel as f64)).max(0.0)
    }
}
