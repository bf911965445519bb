//! The request and the results of a measurement: plain data, and numbers derived from it.

use std::time::Duration;

use super::{
    machine::Machine,
    mixture::Mixture,
    statistics::{self, median, root_mean_square, standard_error},
};
use crate::{area::Area, film::Film, render::Exact, scene::Method};

/// The measured scene, as the user named it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredScene {
    /// Name of the scene as the user gave it.
    pub name: String,
    /// Values of the scene that the command line overrides.
    pub overrides: Vec<String>,
}

/// What the user asks to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Methods to measure, possibly including `exact`.
    pub methods: Vec<Method>,
    /// Samples per pixel to measure; if empty, powers of 4, as many as the time permits.
    pub samples: Vec<u64>,
    /// Number of runs per method and number of samples; `None` for as many as the time permits.
    pub runs: Option<u64>,
    /// Errors for which samples and time are estimated, in linear light.
    pub errors: Vec<f64>,
    /// Time that the measurement may take, if the samples or the runs are not given.
    pub budget: Duration,
}

/// Results of measuring a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// The measured scene.
    pub subject: MeasuredScene,
    /// Machine on which the scene was measured.
    pub machine: Machine,
    /// Number of rendering threads.
    pub threads: usize,
    /// Seed of the scene, from which the runs' seeds are derived.
    pub seed: u64,
    /// Measured numbers of samples per pixel, in ascending order.
    pub rungs: Vec<u64>,
    /// Requested errors, in linear light.
    pub errors: Vec<f64>,
    /// The exact picture, with which all renders are compared.
    pub reference: Exact,
    /// Shares of the pixels in which a sampling method can err.
    pub mixture: Mixture,
    /// Renders by the exact method, if it was requested.
    pub exact: Option<Vec<Run>>,
    /// Results of the sampled methods, in the order of the methods in the language's reference.
    pub series: Vec<MethodSeries>,
    /// Whether the user interrupted the measurement.
    pub interrupted: bool,
}

/// Results of a sampled method on a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodSeries {
    /// Method that was measured.
    pub method: Method,
    /// Results for each number of samples per pixel, in ascending order.
    pub points: Vec<SeriesPoint>,
    /// Picture that a page shows to compare methods. Each method's number of samples takes about
    /// the same CPU time. `None` if the pictures were not rendered.
    pub picture: Option<MethodPicture>,
}

/// Results of a method with one number of samples per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesPoint {
    /// Samples per pixel; for `scatter` the mean number.
    pub per_pixel: u64,
    /// Timed renders with this number of samples per pixel.
    pub runs: Vec<Run>,
}

/// Slope of a method's error against the number of samples, both logarithmic, at the `end` of its
/// series. There, the error is proportional to the power `slope` of the number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct EndSlope {
    /// Slope of the line of least squares through the logarithms.
    pub slope: f64,
    /// Standard error of the slope, from the slopes of single runs; `None` for fewer than three
    /// runs.
    pub error: Option<f64>,
}

impl EndSlope {
    /// Minimum value of −`slope` at which the report says that more samples help. A smaller one may
    /// be noise of the measurement.
    const LEAST: f64 = 0.05;

    /// Returns the factor by which four times as many samples divide the error, 4^−`slope`. Returns
    /// `None` if more samples do not help.
    pub fn divisor(&self) -> Option<f64> {
        (self.slope < -Self::LEAST).then(|| libm::pow(4.0, -self.slope))
    }

    /// Returns the factor of samples that divides the error by ten, 10^(−1/`slope`). Returns `None`
    /// if more samples do not help.
    pub fn cost_of_a_tenth(&self) -> Option<f64> {
        (self.slope < -Self::LEAST).then(|| libm::pow(10.0, -1.0 / self.slope))
    }
}

/// Returns the last three of a method's results, or all if there are fewer. With few samples,
/// errors may fall at another rate than later: `scatter` then leaves pixels empty, and `n_rooks`
/// falls as steeply as strata in two dimensions, but ends like independent samples.
pub fn end<T>(points: &[T]) -> &[T] {
    &points[points.len().saturating_sub(3)..]
}

/// Times and error of a render.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Run {
    /// CPU time of the whole process in seconds, summed over all threads. NaN if the system does
    /// not report it.
    pub cpu: f64,
    /// Elapsed time in seconds.
    pub wall: f64,
    /// Root mean square difference from the exact picture, in linear light. NaN for the exact
    /// method, whose error has a bound instead.
    pub error: f64,
}

/// A method's picture that a page shows next to those of other methods.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MethodPicture {
    /// Samples per pixel of the picture.
    pub per_pixel: u64,
    /// CPU time of the render, in seconds.
    pub cpu: f64,
    /// Root mean square error of the whole picture, in linear light.
    pub rmse: f64,
    /// Part of the picture that the page shows; it is the same for every method.
    pub part: Area,
    /// Pixels of the part of the picture that the page shows.
    pub film: Film,
    /// Heat map of the difference between this part and the exact picture.
    pub difference: Film,
}

impl Run {
    /// Combines renders into one: their median times, and the root mean square of their errors.
    pub fn typical(runs: &[Self]) -> Self {
        let all = |pick: fn(&Self) -> f64| runs.iter().map(pick).collect::<Vec<_>>();
        Self {
            cpu: median(&all(|run| run.cpu)),
            wall: median(&all(|run| run.wall)),
            error: root_mean_square(&all(|run| run.error)),
        }
    }
}

impl SeriesPoint {
    /// Returns the median times and the root mean square error of the runs.
    pub fn typical(&self) -> Run {
        Run::typical(&self.runs)
    }
}

impl MethodSeries {
    /// Returns the slope of the error at the end of the series. Returns `None` if fewer than two
    /// numbers of samples were measured, or an error is 0.
    pub fn slope(&self) -> Option<EndSlope> {
        let slope = |error: &dyn Fn(&SeriesPoint) -> f64| {
            let points = end(&self.points).iter();
            let points = points.map(|point| (point.per_pixel as f64, error(point)));
            statistics::slope(&points.collect::<Vec<_>>())
        };
        let runs = end(&self.points).iter().map(|point| point.runs.len()).min();
        let of_each = (0..runs?).filter_map(|run| slope(&|point| point.runs[run].error));
        Some(EndSlope {
            slope: slope(&|point| point.typical().error)?,
            error: standard_error(&of_each.collect::<Vec<_>>()),
        })
    }

    /// Returns the samples per pixel that take the CPU time `cpu`, by linear interpolation between
    /// the measured numbers. Outside their range, returns the least or the greatest. Returns `None`
    /// if nothing was measured.
    pub fn samples_in(&self, cpu: f64) -> Option<u64> {
        let (first, last) = (self.points.first()?, self.points.last()?);
        let slower = |pair: &&[SeriesPoint]| pair[1].typical().cpu > cpu;
        let Some([a, b]) = self.points.windows(2).find(slower) else {
            return Some(last.per_pixel);
        };
        let [less, more] = [a, b].map(|point| point.typical().cpu);
        let added = (cpu - less) / (more - less) * (b.per_pixel - a.per_pixel) as f64;
        Some((a.per_pixel as f64 + added).max(first.per_pixel as f64) as u64)
    }
}

impl Measurement {
    /// Returns the area of the whole picture.
    pub fn whole(&self) -> Area {
        Area::whole(self.reference.film.width(), self.reference.film.height())
    }

    /// Returns the greatest number of runs with the same method and the same number of samples.
    pub fn runs(&self) -> usize {
        let sampled = self.series.iter().flat_map(|series| &series.points);
        let most = sampled.map(|point| point.runs.len()).max();
        let exact = self.exact.as_ref().map(Vec::len);
        most.max(exact).unwrap_or(0)
    }
}
