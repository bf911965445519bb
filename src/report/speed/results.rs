//! What is asked for and what was measured: plain data, and the numbers that follow from it.

use std::time::Duration;

use super::{
    machine::Machine,
    statistics::{PowerLaw, median, root_mean_square},
};
use crate::{area::Area, film::Film, render::Exact, scene::Method};

/// The scene that is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// What the user calls it.
    pub name: String,
    /// What the command line changes in it.
    pub overrides: Vec<String>,
}

/// What the user asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The methods, `exact` among them or not.
    pub methods: Vec<Method>,
    /// Samples per pixel; powers of 4 as far as the time goes if there are none.
    pub samples: Vec<u64>,
    /// Runs of each method and number of samples; as many as the time allows if this is `None`.
    pub runs: Option<u64>,
    /// The errors for which samples and time are told, in linear light.
    pub errors: Vec<f64>,
    /// How long it may take, as far as there is a choice.
    pub budget: Duration,
}

/// What came out.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// What was measured.
    pub subject: Subject,
    /// What it was measured on.
    pub machine: Machine,
    /// How many threads rendered.
    pub threads: usize,
    /// The scene's seed, of which the seeds of the runs are made.
    pub seed: u64,
    /// Samples per pixel, ascending.
    pub rungs: Vec<u64>,
    /// The errors that are asked for.
    pub errors: Vec<f64>,
    /// The exact picture.
    pub reference: Exact,
    /// The renders by the exact method, if that was measured.
    pub exact: Option<Vec<Run>>,
    /// The sampled methods that were measured, in the order of the language's table.
    pub series: Vec<Series>,
    /// Whether the user ended it.
    pub interrupted: bool,
}

/// What was measured of a sampled method.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The method.
    pub method: Method,
    /// By samples per pixel, ascending.
    pub points: Vec<Point>,
    /// What it renders in the same time as the others.
    pub picture: Option<Shown>,
}

/// What was measured of a method with a number of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Samples per pixel, of `scatter` on average.
    pub per_pixel: u64,
    /// Its renders.
    pub runs: Vec<Run>,
}

/// A render that was timed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Run {
    /// CPU time of the whole process in seconds, all threads together. NaN where the system does
    /// not tell.
    pub cpu: f64,
    /// From the beginning to the end by the clock, in seconds.
    pub wall: f64,
    /// The root of the mean squared difference to the exact picture, in linear light. NaN of the
    /// exact method, whose error has a bound instead.
    pub error: f64,
}

/// A picture to look at.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// Its samples per pixel.
    pub per_pixel: u64,
    /// The CPU time that it took, in seconds.
    pub cpu: f64,
    /// The error of the whole picture.
    pub rmse: f64,
    /// The part that is shown, the same of every method.
    pub part: Area,
    /// What is seen there.
    pub film: Film,
}

impl Run {
    /// Some renders as one: with the median times, and the error of all together, the root of the
    /// mean of their squares.
    pub fn typical(runs: &[Self]) -> Self {
        let all = |pick: fn(&Self) -> f64| runs.iter().map(pick).collect::<Vec<_>>();
        Self {
            cpu: median(&all(|run| run.cpu)),
            wall: median(&all(|run| run.wall)),
            error: root_mean_square(&all(|run| run.error)),
        }
    }
}

impl Point {
    /// Its renders as one.
    pub fn typical(&self) -> Run {
        Run::typical(&self.runs)
    }
}

impl Series {
    /// How the error falls with the samples, if it is not 0.
    pub fn fit(&self) -> Option<PowerLaw> {
        let points = self.points.iter();
        let points: Vec<_> = points
            .map(|point| (point.per_pixel as f64, point.typical().error))
            .collect();
        PowerLaw::fit(&points)
    }

    /// So many samples per pixel take about this CPU time, between the numbers of samples that were
    /// measured.
    pub fn samples_in(&self, cpu: f64) -> Option<u64> {
        let (first, last) = (self.points.first()?, self.points.last()?);
        let slower = |pair: &&[Point]| pair[1].typical().cpu > cpu;
        let Some([a, b]) = self.points.windows(2).find(slower) else {
            return Some(last.per_pixel);
        };
        let [less, more] = [a, b].map(|point| point.typical().cpu);
        let added = (cpu - less) / (more - less) * (b.per_pixel - a.per_pixel) as f64;
        Some((a.per_pixel as f64 + added).max(first.per_pixel as f64) as u64)
    }
}

impl Measurement {
    /// The picture's area.
    pub fn whole(&self) -> Area {
        Area::whole(self.reference.film.width(), self.reference.film.height())
    }

    /// How many runs were begun.
    pub fn runs(&self) -> usize {
        let sampled = self.series.iter().flat_map(|series| &series.points);
        let most = sampled.map(|point| point.runs.len()).max();
        let exact = self.exact.as_ref().map(Vec::len);
        most.max(exact).unwrap_or(0)
    }
}
