//! The request and the results of a measurement: plain data, and numbers derived from it.

use std::time::Duration;

use super::{
    machine::Machine,
    statistics::{PowerLaw, median, root_mean_square},
};
use crate::{area::Area, film::Film, render::Exact, scene::Method};

/// The measured scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredScene {
    /// The user's name for it.
    pub name: String,
    /// The values that the command line overrides.
    pub overrides: Vec<String>,
}

/// The user's request.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The methods, possibly including `exact`.
    pub methods: Vec<Method>,
    /// Samples per pixel; if empty, powers of 4 as far as the time permits.
    pub samples: Vec<u64>,
    /// Runs per method and number of samples; `None` for as many as the time permits.
    pub runs: Option<u64>,
    /// The errors for which samples and time are estimated, in linear light.
    pub errors: Vec<f64>,
    /// The time available, as far as there is a choice.
    pub budget: Duration,
}

/// Results of a measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// The measured scene.
    pub subject: MeasuredScene,
    /// The machine.
    pub machine: Machine,
    /// Number of rendering threads.
    pub threads: usize,
    /// The scene's seed, from which the runs' seeds are derived.
    pub seed: u64,
    /// Samples per pixel, ascending.
    pub rungs: Vec<u64>,
    /// The requested errors.
    pub errors: Vec<f64>,
    /// The exact picture.
    pub reference: Exact,
    /// The renders by the exact method, if they were requested.
    pub exact: Option<Vec<Run>>,
    /// The sampled methods, in the order of the language's table.
    pub series: Vec<MethodSeries>,
    /// Whether the user interrupted it.
    pub interrupted: bool,
}

/// Results of a sampled method.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodSeries {
    /// The method.
    pub method: Method,
    /// By samples per pixel, ascending.
    pub points: Vec<SeriesPoint>,
    /// Its picture with the CPU time that all methods have.
    pub picture: Option<MethodPicture>,
}

/// Results of a method with one number of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct SeriesPoint {
    /// Samples per pixel, for `scatter` on average.
    pub per_pixel: u64,
    /// Its renders.
    pub runs: Vec<Run>,
}

/// A timed render.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Run {
    /// CPU time of the whole process in seconds, all threads added up. NaN if the system does not
    /// report it.
    pub cpu: f64,
    /// Elapsed time in seconds.
    pub wall: f64,
    /// Root mean square difference from the exact picture, in linear light. NaN for the exact
    /// method, whose error has a bound instead.
    pub error: f64,
}

/// A method's picture for comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodPicture {
    /// Samples per pixel.
    pub per_pixel: u64,
    /// CPU time of the render, in seconds.
    pub cpu: f64,
    /// Error of the whole picture.
    pub rmse: f64,
    /// The part that is shown, the same for every method.
    pub part: Area,
    /// Picture of that part.
    pub film: Film,
}

impl Run {
    /// Combines renders: the median times, and the root mean square of their errors.
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
    /// Returns its renders combined.
    pub fn typical(&self) -> Run {
        Run::typical(&self.runs)
    }
}

impl MethodSeries {
    /// Fits the error as a power of the samples; `None` if the error is 0.
    pub fn fit(&self) -> Option<PowerLaw> {
        let place = |point: &SeriesPoint| (point.per_pixel as f64, point.typical().error);
        let points: Vec<_> = self.points.iter().map(place).collect();
        PowerLaw::fit(&points)
    }

    /// Interpolates the samples per pixel that take this CPU time, within the measured range.
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
    /// Returns the picture's area.
    pub fn whole(&self) -> Area {
        Area::whole(self.reference.film.width(), self.reference.film.height())
    }

    /// Returns the number of runs that were started.
    pub fn runs(&self) -> usize {
        let sampled = self.series.iter().flat_map(|series| &series.points);
        let most = sampled.map(|point| point.runs.len()).max();
        let exact = self.exact.as_ref().map(Vec::len);
        most.max(exact).unwrap_or(0)
    }
}
