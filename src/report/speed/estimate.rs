//! Estimates how many samples and how much time each method needs to reduce its error to a given
//! value. Ranks the methods by CPU time.

use super::results::{
    EndSlope, LEAST_BEND, Measurement, MethodSeries, Run, SeriesPoint, bend, end_slope,
};
use crate::scene::Method;

/// Estimate of the samples and the time that a method needs to reduce its error to a given value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Samples per pixel; `None` for the exact method, which uses no samples.
    pub per_pixel: Option<f64>,
    /// Estimated CPU time, in seconds.
    pub cpu: f64,
    /// Least and greatest CPU time, in seconds. They are taken over `cpu` and the estimates from
    /// each single run.
    pub cpu_runs: [f64; 2],
    /// Estimated elapsed time, in seconds.
    pub wall: f64,
    /// Whether the estimate is extrapolated, because even with the largest measured number of
    /// samples, the error is above the given value.
    pub is_extrapolated: bool,
}

impl Estimate {
    /// Returns whether this method may be as fast as the `fastest` one. It may be if the CPU time
    /// of either method lies within the range of the other method's single runs.
    fn is_as_fast_as(&self, fastest: &Self) -> bool {
        self.cpu <= fastest.cpu_runs[1] || self.cpu_runs[0] <= fastest.cpu
    }
}

/// Ranking of the methods that can reduce their error to a given value, by the CPU time that they
/// need.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranking {
    /// The method with the least CPU time, and the methods that may be equally fast because their
    /// CPU times do not clearly differ from it.
    pub fastest: Vec<(Method, Estimate)>,
    /// The other methods, sorted by CPU time.
    pub others: Vec<(Method, Estimate)>,
}

impl Measurement {
    /// Estimates the samples and the time that a method needs to reduce its error to `error`.
    /// Returns `None` if more samples do not reduce the method's error. Also returns `None` if
    /// `error` is at most the root mean square of the exact picture's error bounds, since such
    /// small errors cannot be measured.
    pub fn estimate(&self, series: &MethodSeries, error: f64) -> Option<Estimate> {
        self.tells(error).then(|| series.estimate(error)).flatten()
    }

    /// Estimates the time that the exact method needs. Returns `None` if it was not measured, or if
    /// `error` is at most the root mean square of the exact picture's error bounds.
    pub fn exact_estimate(&self, error: f64) -> Option<Estimate> {
        let runs = self.exact.as_ref().filter(|_| self.tells(error))?;
        let Run { cpu, wall, .. } = Run::typical(runs);
        Some(Estimate {
            per_pixel: None,
            cpu,
            cpu_runs: range(cpu, runs.iter().map(|run| run.cpu)),
            wall,
            is_extrapolated: false,
        })
    }

    fn tells(&self, error: f64) -> bool {
        error > self.reference.root_mean_square_bound()
    }

    /// Ranks the methods that can reduce their error to `error` by the CPU time that they need.
    /// Methods with extrapolated estimates come last, since these estimates are uncertain.
    pub fn ranking(&self, error: f64) -> Ranking {
        let estimate = |it: &MethodSeries| Some((it.method, self.estimate(it, error)?));
        let sampled = self.series.iter().filter_map(estimate);
        let exact = self.exact_estimate(error).map(|it| (Method::Exact, it));
        let mut all: Vec<_> = sampled.chain(exact).collect();
        // If the system does not report CPU times, all estimates are NaN, so no methods are ranked.
        all.retain(|(_, estimate)| estimate.cpu.is_finite());
        all.sort_by(|(_, a), (_, b)| {
            let measured_first = a.is_extrapolated.cmp(&b.is_extrapolated);
            measured_first.then(a.cpu.total_cmp(&b.cpu))
        });
        let first = all.first().map(|&(_, first)| first);
        let (fastest, others) = all.into_iter().partition(|(_, it)| {
            first.is_some_and(|first| {
                it.is_extrapolated == first.is_extrapolated && it.is_as_fast_as(&first)
            })
        });
        Ranking { fastest, others }
    }
}

/// A number of samples per pixel, with the times and the error that were measured for it.
type Measured = (f64, Run);

impl MethodSeries {
    /// Estimates the samples and the time that the method needs to reduce its error to `error`.
    /// Returns the smallest measured number of samples if it suffices. Returns `None` if more
    /// samples do not reduce the error.
    ///
    /// The error is assumed to be proportional to a power of the number of samples, so it is a
    /// straight line on logarithmic axes. Between two measured numbers of samples, this line goes
    /// through both points. Beyond the last measured number, it starts at the last point, and its
    /// slope is fitted to the last three points. Times are assumed to grow linearly with the number
    /// of samples.
    pub fn estimate(&self, error: f64) -> Option<Estimate> {
        let estimate = |run: &dyn Fn(&SeriesPoint) -> Run| {
            let step = |point: &SeriesPoint| (point.per_pixel as f64, run(point));
            let steps: Vec<_> = self.points.iter().map(step).collect();
            self.estimate_by(&steps, error)
        };
        let of_all = estimate(&SeriesPoint::typical)?;
        let runs = self.points.iter().map(|point| point.runs.len()).min()?;
        let of_each = (0..runs).filter_map(|run| estimate(&|point| point.runs[run]));
        Some(Estimate {
            cpu_runs: range(of_all.cpu, of_each.map(|it| it.cpu)),
            ..of_all
        })
    }

    fn estimate_by(&self, steps: &[Measured], error: f64) -> Option<Estimate> {
        let (&(first, _), &(last, last_run)) = (steps.first()?, steps.last()?);
        // Index of the first number of samples for which the error, and all later errors, are small
        // enough.
        let enough = steps.iter().rposition(|(_, run)| run.error > error);
        let enough = enough.map_or(0, |last| last + 1);
        let per_pixel = match steps.get(enough) {
            // Even the smallest measured number suffices. Fewer samples may suffice, too, but they
            // were not measured.
            Some(_) if enough == 0 => first,
            Some(many) => self.between(&steps[enough - 1], many, error),
            None => {
                let slope = slope_beyond(steps)?;
                (last * libm::pow(error / last_run.error, 1.0 / slope)).ceil()
            }
        };
        per_pixel.is_finite().then(|| Estimate {
            per_pixel: Some(per_pixel),
            cpu: time_at(steps, per_pixel, |run| run.cpu),
            cpu_runs: [f64::NAN; 2],
            wall: time_at(steps, per_pixel, |run| run.wall),
            is_extrapolated: enough == steps.len(),
        })
    }

    /// Interpolates the number of samples per pixel at which the error is `error`. The number lies
    /// between two measured ones: with `few` samples, the error is too large, and with `many`, it
    /// is small enough.
    fn between(&self, (few, of_few): &Measured, (many, of_many): &Measured, error: f64) -> f64 {
        let share = if of_many.error == 0.0 {
            // An error of 0 has no logarithm, so `many` samples are returned.
            1.0
        } else {
            libm::log(of_few.error / error) / libm::log(of_few.error / of_many.error)
        };
        let per_pixel = (few * libm::pow(many / few, share)).ceil();
        match self.method {
            Method::MultiJittered => oblong(per_pixel).min(*many),
            _ => per_pixel,
        }
    }
}

/// Returns the slope along which a line of errors is extrapolated beyond its last point. It is
/// fitted to the last three points or, if the line bends there, to the last two. Returns `None` if
/// the numbers of samples are too close to each other. Also returns `None` if more samples hardly
/// reduce the error, since a small slope may be noise.
fn slope_beyond(steps: &[Measured]) -> Option<f64> {
    let points = steps.iter().map(|(per_pixel, run)| (*per_pixel, run.error));
    let points: Vec<_> = points.collect();
    let whole = end_slope(&points)?;
    let slope = match bend(&points) {
        Some(bend) if bend.abs() > LEAST_BEND => {
            end_slope(&points[points.len().saturating_sub(2)..])?
        }
        _ => whole,
    };
    (slope < -EndSlope::LEAST).then_some(slope)
}

/// Returns the least number of samples that is at least `per_pixel` and equals n·n or n·(n + 1) for
/// an integer n. Multi-jittered sampling divides the pixel into a grid with a cell for each sample.
/// For the returned numbers, the grid is nearly square. For others, it may be a long strip, or for
/// a prime number a single row, and the error may then be larger than interpolated.
fn oblong(per_pixel: f64) -> f64 {
    let root = per_pixel.sqrt().floor();
    let next = root + 1.0;
    let grids = [root * root, root * next, next * next];
    let enough = grids.into_iter().find(|&grid| grid >= per_pixel);
    enough.unwrap_or(per_pixel)
}

/// Returns the time that `per_pixel` samples take. Between two measured numbers of samples in
/// `steps`, the time is interpolated linearly. Above the largest one, it is extrapolated along the
/// line through the first and the last measurement.
fn time_at(steps: &[Measured], per_pixel: f64, time: fn(&Run) -> f64) -> f64 {
    let times = steps.iter().map(|(per_pixel, run)| (*per_pixel, time(run)));
    let times: Vec<_> = times.collect();
    let [first, .., last] = times.as_slice() else {
        return times.first().map_or(f64::NAN, |first| first.1);
    };
    let around = |pair: &&[(f64, f64)]| (pair[0].0..=pair[1].0).contains(&per_pixel);
    let slope = |a: &(f64, f64), b: &(f64, f64)| (b.1 - a.1) / (b.0 - a.0);
    match times.windows(2).find(around) {
        Some([a, b]) => a.1 + slope(a, b) * (per_pixel - a.0),
        // More samples never need less time, but measured times may decrease by chance. So a
        // negative slope is replaced by 0.
        _ => last.1 + slope(first, last).max(0.0) * (per_pixel - last.0),
    }
}

/// Returns the least and the greatest of `value` and `others`.
fn range(value: f64, others: impl Iterator<Item = f64>) -> [f64; 2] {
    others.fold([value; 2], |[low, high], other| {
        [low.min(other), high.max(other)]
    })
}
