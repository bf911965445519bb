//! The request for a measurement, and its results. Also computes slopes, typical values of several
//! runs, and the number of samples that can be rendered in a given time.

use std::time::Duration;

use super::{
    machine::Machine,
    mixture::Mixture,
    statistics::{self, median, root_mean_square, standard_error},
};
use crate::{area::Area, film::Film, render::Exact, scene::Method};

/// The measured scene, as the user named it on the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredScene {
    /// Name of the scene's file.
    pub name: String,
    /// Overrides of the scene's values, i.e. `--set` arguments.
    pub overrides: Vec<String>,
}

/// What the user asks to be measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Methods to measure. They may include `exact`.
    pub methods: Vec<Method>,
    /// Numbers of samples per pixel to measure. If empty, 1, 4, 16, … are measured, as long as
    /// there is time.
    pub samples: Vec<u64>,
    /// Number of runs of each method with each number of samples. If `None`, runs are made as long
    /// as there is time.
    pub runs: Option<u64>,
    /// Values to which methods should reduce their errors, in linear light. For each value, the
    /// report estimates how many samples and how much time each method needs.
    pub errors: Vec<f64>,
    /// Time that the measurement may take. It has no effect if both `samples` and `runs` are given.
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
    /// Seed of the scene. The seeds of the runs are derived from it.
    pub seed: u64,
    /// Measured numbers of samples per pixel, in ascending order.
    pub rungs: Vec<u64>,
    /// Values to which methods should reduce their errors, in linear light. For each value, the
    /// report estimates how many samples and how much time each method needs.
    pub errors: Vec<f64>,
    /// The exact picture, which is computed without samples. All renders are compared with it.
    pub reference: Exact,
    /// Fractions of the picture's pixels that show several colours. Sampling methods can err only
    /// in these pixels.
    pub mixture: Mixture,
    /// Runs of the exact method; `None` if it was not requested.
    pub exact: Option<Vec<Run>>,
    /// Results of the sampling methods, in the order in which the language's reference lists them.
    pub series: Vec<MethodSeries>,
    /// Whether the user interrupted the measurement.
    pub interrupted: bool,
}

/// Results of measuring one sampling method.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodSeries {
    /// Method that was measured.
    pub method: Method,
    /// Results for each number of samples per pixel, in ascending order.
    pub points: Vec<SeriesPoint>,
    /// The method's picture on the HTML page, for comparing the methods. Its number of samples is
    /// chosen so that all methods take about the same CPU time. `None` if it was not rendered.
    pub picture: Option<MethodPicture>,
}

/// Results of one method with one number of samples per pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesPoint {
    /// Number of samples per pixel. For the method `scatter`, which spreads samples unevenly, it is
    /// the mean number.
    pub per_pixel: u64,
    /// Timed renders with this number of samples.
    pub runs: Vec<Run>,
}

/// Slope of the logarithm of a method's error over the logarithm of the number of samples, for the
/// last three measured numbers. If the slope is s, the error is about proportional to the number of
/// samples to the power s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndSlope {
    /// Slope of the logarithm of the error over the logarithm of the number of samples, fitted by
    /// least squares.
    pub slope: f64,
    /// Standard error of `slope`, computed from the slopes of single runs; `None` if there are
    /// fewer than three runs.
    pub error: Option<f64>,
    /// Whether the line of errors bends, i.e. its last two segments have clearly different slopes.
    /// In this case, `slope` is a mean of the two slopes, and does not predict the error for more
    /// samples.
    pub bends: bool,
}

impl EndSlope {
    /// Minimum value of −`slope` at which the report says that more samples reduce the error. A
    /// smaller value may be noise in the measurement. For independent samples, −`slope` is 0.5, far
    /// above this minimum.
    pub(super) const LEAST: f64 = 0.05;

    /// Returns the factor by which four times as many samples divide the error, 4^−`slope`. Returns
    /// `None` if more samples do not reduce the error, or if the line bends.
    pub fn divisor(&self) -> Option<f64> {
        self.settled().map(|slope| libm::pow(4.0, -slope))
    }

    /// Returns the factor by which the number of samples must grow to reduce the error to a tenth,
    /// 10^(−1/`slope`). Returns `None` if more samples do not reduce the error, or if the line
    /// bends.
    pub fn cost_of_a_tenth(&self) -> Option<f64> {
        self.settled().map(|slope| libm::pow(10.0, -1.0 / slope))
    }

    /// Returns the slope. Returns `None` if more samples do not reduce the error, or if the line
    /// bends, because the slope for more samples is then unknown.
    fn settled(&self) -> Option<f64> {
        (!self.bends && self.slope < -Self::LEAST).then_some(self.slope)
    }
}

/// Returns the last three of a method's results, or all if there are fewer. The other results would
/// distort the slope, because the errors of some methods decrease differently with few samples. For
/// example, `scatter` leaves pixels without samples, and the error of `n_rooks` decreases faster at
/// first.
pub fn end<T>(points: &[T]) -> &[T] {
    &points[points.len().saturating_sub(3)..]
}

/// Minimum ratio of the largest to the smallest number of samples to which a slope is fitted. Over
/// a smaller range, the slope could depend more on noise than on the method. It could also depend
/// on how the method divides a pixel into a grid. For 17 samples, for example, the grid is a single
/// row.
pub const LEAST_SPAN: f64 = 4.0;

/// Minimum difference between the slopes of a line's last two segments at which the report says
/// that the line bends. In ordinary scenes, the slopes of methods with strata differ by up to 0.08,
/// so a smaller minimum would report bends there. Larger differences occur if a method, such as
/// `scatter`, leaves pixels without samples, or if a grid of samples is aligned with an edge.
pub const LEAST_BEND: f64 = 0.1;

/// Returns the slope at the end of the line through `points` on logarithmic axes, fitted to the
/// last three points. A point consists of a number of samples and an error. Returns `None` if there
/// are fewer than two points, if they span less than the factor [`LEAST_SPAN`], or if an error is
/// 0.
pub fn end_slope(points: &[(f64, f64)]) -> Option<f64> {
    let points = end(points);
    let (first, last) = (points.first()?.0, points.last()?.0);
    (last >= LEAST_SPAN * first)
        .then(|| statistics::slope(points))
        .flatten()
}

/// Returns the difference between the slopes of the last two segments of the line through `points`
/// on logarithmic axes. Returns `None` if there are fewer than three points, or if an error is 0.
pub fn bend(points: &[(f64, f64)]) -> Option<f64> {
    let [.., a, b, c] = *points else {
        return None;
    };
    Some(statistics::slope(&[b, c])? - statistics::slope(&[a, b])?)
}

/// Times and error of a render, or typical values of several renders.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Run {
    /// CPU time in seconds: the sum over all threads of the process. NaN if the system does not
    /// report it.
    pub cpu: f64,
    /// Elapsed time in seconds.
    pub wall: f64,
    /// Root mean square of the differences from the exact picture, in linear light. NaN for the
    /// exact method, which has an error bound instead.
    pub error: f64,
}

/// A method's picture on the HTML page, for comparing the methods.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodPicture {
    /// Samples per pixel of the picture.
    pub per_pixel: u64,
    /// CPU time of the render, in seconds.
    pub cpu: f64,
    /// Root mean square error of the whole picture, in linear light.
    pub rmse: f64,
    /// The area of the picture that the page shows. It is the same for all methods.
    pub part: Area,
    /// Pixels of the area `part`.
    pub film: Film,
}

impl Run {
    /// Returns typical values of several renders: the medians of their times, and the root mean
    /// square of their errors.
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
    /// Returns typical values of the runs: the medians of their times, and the root mean square of
    /// their errors.
    pub fn typical(&self) -> Run {
        Run::typical(&self.runs)
    }
}

impl MethodSeries {
    /// Returns the slope of the logarithm of the error over the logarithm of the number of samples,
    /// for the last three numbers of samples. Returns `None` if fewer than two were measured, if
    /// they span less than a factor of 4, or if an error is 0.
    pub fn slope(&self) -> Option<EndSlope> {
        let line = |error: &dyn Fn(&SeriesPoint) -> f64| -> Vec<(f64, f64)> {
            let points = self.points.iter();
            points
                .map(|point| (point.per_pixel as f64, error(point)))
                .collect()
        };
        let runs = end(&self.points)
            .iter()
            .map(|point| point.runs.len())
            .min()?;
        let of_each: Vec<_> = (0..runs)
            .map(|run| line(&|point| point.runs[run].error))
            .collect();
        let slopes: Vec<f64> = of_each.iter().filter_map(|line| end_slope(line)).collect();
        let bends: Vec<f64> = of_each.iter().filter_map(|line| bend(line)).collect();
        let all = line(&|point| point.typical().error);
        let noise = 2.0 * standard_error(&bends).unwrap_or(0.0);
        Some(EndSlope {
            slope: end_slope(&all)?,
            error: standard_error(&slopes),
            bends: bend(&all).is_some_and(|bend| bend.abs() > LEAST_BEND.max(noise)),
        })
    }

    /// Returns the number of samples per pixel that can be rendered in the CPU time `cpu`,
    /// interpolated linearly between the measured numbers. The result is at least the smallest and
    /// at most the greatest measured number. Returns `None` if nothing was measured.
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

    /// Returns the number of runs, i.e. how often each render was made. After an interruption,
    /// methods may have different numbers of runs, and the greatest is returned.
    pub fn runs(&self) -> usize {
        let sampled = self.series.iter().flat_map(|series| &series.points);
        let most = sampled.map(|point| point.runs.len()).max();
        let exact = self.exact.as_ref().map(Vec::len);
        most.max(exact).unwrap_or(0)
    }
}
