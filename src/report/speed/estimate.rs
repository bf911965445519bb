//! What an error takes of each method, and which methods take the least time.

use super::{
    results::{Measurement, Point, Run, Series},
    statistics::PowerLaw,
};
use crate::scene::Method;

/// What an error takes of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Samples per pixel; none of the exact method.
    pub per_pixel: Option<f64>,
    /// CPU time in seconds.
    pub cpu: f64,
    /// The least and the greatest CPU time that a single run says.
    pub cpu_runs: [f64; 2],
    /// Wall time in seconds.
    pub wall: f64,
    /// Whether it lies beyond what was measured.
    pub is_extrapolated: bool,
}

impl Estimate {
    /// Whether two times are so close that the runs do not tell which is less: one lies within the
    /// spread of the other's runs.
    fn is_as_fast_as(&self, fastest: &Self) -> bool {
        self.cpu <= fastest.cpu_runs[1] || self.cpu_runs[0] <= fastest.cpu
    }
}

/// The methods that come to an error.
pub struct Ranking {
    /// The one with the least CPU time, and those that are about as fast.
    pub fastest: Vec<(Method, Estimate)>,
    /// The others, by CPU time.
    pub others: Vec<(Method, Estimate)>,
}

impl Measurement {
    /// What an error takes of a sampled method. None if more samples do not help, or if the
    /// reference is not known well enough to tell such an error from none: by the root of the
    /// mean of its bounds' squares, since errors are such means.
    pub fn estimate(&self, series: &Series, error: f64) -> Option<Estimate> {
        self.tells(error).then(|| series.estimate(error)).flatten()
    }

    /// The same of the exact method, if that was measured.
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

    /// The methods that come to an error. What is extrapolated comes after all that was measured,
    /// however fast it seems.
    pub fn ranking(&self, error: f64) -> Ranking {
        let sampled = self.series.iter();
        let sampled = sampled.filter_map(|it| Some((it.method, self.estimate(it, error)?)));
        let exact = self.exact_estimate(error);
        let exact = exact.map(|estimate| (Method::Exact, estimate));
        let mut all: Vec<_> = sampled.chain(exact).collect();
        // Where the system does not tell the CPU time, no method has the least.
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

/// A number of samples per pixel and what it came to, in one run or in all.
type Step = (f64, Run);

impl Series {
    /// Errors are taken to fall as a power of the samples: between two numbers of samples that were
    /// measured by the line in logarithms through both, beyond the last with the slope of the
    /// line through the last three, as with few samples errors may fall at another rate: `scatter`
    /// leaves pixels empty then. Times are taken to grow evenly with the samples. Where the
    /// least number is enough, it is that.
    pub fn estimate(&self, error: f64) -> Option<Estimate> {
        let estimate = |run: &dyn Fn(&Point) -> Run| {
            let steps = self.points.iter();
            let steps = steps.map(|point| (point.per_pixel as f64, run(point)));
            self.estimate_by(&steps.collect::<Vec<_>>(), error)
        };
        let of_all = estimate(&Point::typical)?;
        let runs = self.points.iter().map(|point| point.runs.len()).min()?;
        let of_each = (0..runs).filter_map(|run| estimate(&|point| point.runs[run]));
        Some(Estimate {
            cpu_runs: range(of_all.cpu, of_each.map(|it| it.cpu)),
            ..of_all
        })
    }

    fn estimate_by(&self, steps: &[Step], error: f64) -> Option<Estimate> {
        let (&(first, _), &(last, last_run)) = (steps.first()?, steps.last()?);
        // From here on no error that was measured is greater.
        let enough = steps.iter().rposition(|(_, run)| run.error > error);
        let enough = enough.map_or(0, |last| last + 1);
        let per_pixel = match steps.get(enough) {
            // Fewer may be enough, too, but nobody has tried.
            Some(_) if enough == 0 => first,
            Some(many) => self.between(&steps[enough - 1], many, error),
            None => {
                let many = &steps[steps.len().saturating_sub(3)..];
                let errors = many.iter().map(|(per_pixel, run)| (*per_pixel, run.error));
                let slope = PowerLaw::fit(&errors.collect::<Vec<_>>())?.slope;
                let more = libm::pow(error / last_run.error, 1.0 / slope);
                (slope < 0.0).then(|| (last * more).ceil())?
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

    /// The samples that an error takes between that of a few, which is greater, and that of many,
    /// which is not.
    fn between(&self, (few, of_few): &Step, (many, of_many): &Step, error: f64) -> f64 {
        let share = match of_many.error == 0.0 {
            // Without any error, these are enough for whatever is asked for.
            true => 1.0,
            false => libm::log(of_few.error / error) / libm::log(of_few.error / of_many.error),
        };
        let per_pixel = (few * libm::pow(many / few, share)).ceil();
        match self.method {
            Method::MultiJittered => oblong(per_pixel).min(*many),
            _ => per_pixel,
        }
    }
}

/// The next number of samples that is a square or the product of two neighbours. What lies between
/// such numbers holds for them alone where the method makes a grid of as many cells, which of a
/// prime number is a single row.
fn oblong(per_pixel: f64) -> f64 {
    let root = per_pixel.sqrt().floor();
    let grids = [
        root * root,
        root * (root + 1.0),
        (root + 1.0) * (root + 1.0),
    ];
    let mut grids = grids.into_iter();
    grids.find(|&grid| grid >= per_pixel).unwrap_or(per_pixel)
}

/// The time that so many samples take, no fewer than the first step's: by the line between the
/// steps on either side, or between the first and the last.
fn time_at(steps: &[Step], per_pixel: f64, time: fn(&Run) -> f64) -> f64 {
    let times = steps.iter().map(|(per_pixel, run)| (*per_pixel, time(run)));
    let times: Vec<_> = times.collect();
    let [first, .., last] = times.as_slice() else {
        return times.first().map_or(f64::NAN, |first| first.1);
    };
    let around = |pair: &&[(f64, f64)]| (pair[0].0..=pair[1].0).contains(&per_pixel);
    let slope = |a: &(f64, f64), b: &(f64, f64)| (b.1 - a.1) / (b.0 - a.0);
    match times.windows(2).find(around) {
        Some([a, b]) => a.1 + slope(a, b) * (per_pixel - a.0),
        // More samples take no less time.
        _ => last.1 + slope(first, last).max(0.0) * (per_pixel - last.0),
    }
}

/// The least and the greatest of some values.
fn range(value: f64, others: impl Iterator<Item = f64>) -> [f64; 2] {
    others.fold([value; 2], |[low, high], other| {
        [low.min(other), high.max(other)]
    })
}
