//! Renders are timed and compared with the exact picture.
//!
//! A round runs every method with every number of samples once, in an order that is shuffled anew by a fixed rule: what else the
//! machine does then falls on all of them alike. A run has a seed of its own, the scene's plus the number of the round. What is timed
//! is the way from the scene in memory to the film in memory: preparing the objects and the samples, starting the threads, rendering.
//! Neither reading the scene nor comparing nor encoding is.

use std::{num::NonZero, ops::Range, sync::atomic::Ordering, time::Instant};

use super::{
    Machine,
    fit::{Fit, log_error, median, root_mean_square},
    plan::Plan,
    tried::Try,
};
use crate::{
    area::Area,
    film::{Film, Recipe},
    render::{Control, Exact, RenderError, render_and_count, render_exact},
    sampling::{
        Sampling,
        rng::{Key, scale},
    },
    scene::{Count, Method, Sampler, Scene},
    threads,
    tracer::World,
};

/// What is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// What the user calls the scene.
    pub name: String,
    /// Its text and the overrides.
    pub recipe: Recipe,
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
    /// The seed of the first run; each further one has the next.
    pub seed: u64,
    /// Samples per pixel, ascending.
    pub rungs: Vec<u64>,
    /// How many runs were planned, at first or because of noise.
    pub runs: u64,
    /// The errors that are asked for.
    pub errors: Vec<f64>,
    /// The exact picture.
    pub reference: Exact,
    /// How long the exact one takes, if that is asked for.
    pub exact: Option<Computed>,
    /// The sampled methods, in the order of the language's table.
    pub series: Vec<Series>,
    /// The number of samples per pixel of the pictures that are kept.
    pub shown: u64,
    /// Whether the user ended it.
    pub interrupted: bool,
    /// Whether it was ended before a run was over, so that these are the runs of the warm-up.
    pub is_warm_up: bool,
    /// How long it took in all, in seconds.
    pub seconds: f64,
}

/// What was measured of the exact method.
#[derive(Clone, Debug, PartialEq)]
pub struct Computed {
    /// Seconds, run by run.
    pub times: Vec<f64>,
}

/// What was measured of a sampled method.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The method.
    pub method: Method,
    /// By samples per pixel, ascending; those without a run are left out.
    pub points: Vec<Point>,
    /// The picture of the first run with the number of samples that is shown.
    pub picture: Option<Film>,
    /// What came of taking about as many samples as errors should take.
    pub tries: Vec<Try>,
}

/// What was measured of a method with a number of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Samples per pixel, of `scatter` on average.
    pub per_pixel: u64,
    /// Samples of the whole picture.
    pub samples: u64,
    /// How many of these were traced in the first run: the others lie in pixels that are certain to show one colour.
    pub rays: u64,
    /// Seconds, run by run.
    pub times: Vec<f64>,
    /// The root of the mean of the squared differences to the exact picture, over all pixels and channels in linear light, run by run.
    pub rmse: Vec<f64>,
    /// The largest difference of all runs.
    pub largest: f64,
}

/// What came out of a single run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub(super) rays: u64,
    pub(super) seconds: f64,
    pub(super) rmse: f64,
    pub(super) largest: f64,
}

impl Point {
    pub(super) fn new(per_pixel: u64, pixels: u64) -> Self {
        Self {
            per_pixel,
            samples: per_pixel.saturating_mul(pixels),
            rays: 0,
            times: Vec::new(),
            rmse: Vec::new(),
            largest: 0.0,
        }
    }

    pub(super) fn add(&mut self, run: Run) {
        if self.times.is_empty() {
            self.rays = run.rays;
        }
        self.times.push(run.seconds);
        self.rmse.push(run.rmse);
        self.largest = self.largest.max(run.largest);
    }

    /// The median time in seconds.
    pub fn seconds(&self) -> f64 {
        median(&self.times)
    }

    /// The error of all runs together.
    pub fn error(&self) -> f64 {
        root_mean_square(&self.rmse)
    }

    /// How many samples are taken a second: whether they are traced, or known to show one colour without.
    pub fn samples_per_second(&self) -> f64 {
        self.samples as f64 / self.seconds()
    }

    /// How many of them are traced a second.
    pub fn rays_per_second(&self) -> f64 {
        self.rays as f64 / self.seconds()
    }
}

impl Series {
    /// The line through the logarithms of samples and error, if there are errors. Runs have seeds of their own, and their errors spread. What was
    /// tried has other numbers of samples in each method, and is left out of the line, but not of how far that may be off.
    pub fn fit(&self) -> Option<Fit> {
        let points: Vec<_> = self
            .points
            .iter()
            .map(|point| (point.per_pixel as f64, point.error()))
            .collect();
        let errors: Vec<_> = self
            .points
            .iter()
            .map(|point| log_error(&point.rmse))
            .collect();
        Fit::of_measured(&points, &errors).map(|fit| fit.bent(&self.slopes()))
    }
}

impl Measurement {
    /// The picture's area.
    pub fn whole(&self) -> Area {
        Area::whole(self.reference.film.width(), self.reference.film.height())
    }

    /// Whether all runs of everything are over, whatever was interrupted.
    pub(super) fn is_measured(&self) -> bool {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let complete = |point: &Point| point.times.len() as u64 == self.runs;
        let rungs = |series: &Series| series.points.len() == self.rungs.len();
        self.rounds() as u64 == self.runs && points().all(complete) && self.series.iter().all(rungs)
    }

    /// How long one run of everything took, in the median.
    pub(super) fn round_seconds(&self) -> f64 {
        let points = self.series.iter().flat_map(|series| &series.points);
        let exact = self.exact.iter().map(|exact| median(&exact.times));
        points.map(Point::seconds).chain(exact).sum()
    }

    /// How many runs were begun.
    pub fn rounds(&self) -> usize {
        let runs = self.series.iter().flat_map(|series| &series.points);
        let most = runs.map(|point| point.times.len()).max().unwrap_or(0);
        most.max(self.exact.as_ref().map_or(0, |exact| exact.times.len()))
    }
}

/// What a round runs.
#[derive(Clone, Copy)]
enum Task {
    Exact,
    /// The place of the series and of the point.
    Sampled(usize, usize),
}

/// Measures what was planned. When it is cancelled, what was measured until then comes out, marked as interrupted. Progress is told in
/// estimated nanoseconds.
pub fn measure(plan: &Plan, control: &Control) -> Result<Measurement, RenderError> {
    let mut measured = empty(plan);
    rounds(0..plan.runs, plan, control, &mut measured)?;
    if measured.interrupted && !any_run(&measured) {
        warmed_up(plan, &mut measured);
    }
    for series in &mut measured.series {
        series.points.retain(|point| !point.times.is_empty());
    }
    measured.series.retain(|series| !series.points.is_empty());
    measured.exact = measured.exact.filter(|exact| !exact.times.is_empty());
    measured.seconds = plan.started.elapsed().as_secs_f64();
    Ok(measured)
}

/// The further runs that there should be after those that were planned: how many, and how many nanoseconds they will take.
pub fn further(plan: &Plan, measured: &Measurement) -> (u64, u64) {
    let runs = plan.further_runs(measured);
    (runs, (runs as f64 * measured.round_seconds() * 1e9) as u64)
}

/// Makes so many further runs of all that was planned.
pub fn measure_further(
    runs: u64,
    plan: &Plan,
    control: &Control,
    measured: &mut Measurement,
) -> Result<(), RenderError> {
    let made = measured.runs;
    measured.runs += runs;
    rounds(made..measured.runs, plan, control, measured)?;
    measured.seconds = plan.started.elapsed().as_secs_f64();
    Ok(())
}

/// Runs everything once for each of these numbers, unless the time is up before.
fn rounds(
    numbers: Range<u64>,
    plan: &Plan,
    control: &Control,
    measured: &mut Measurement,
) -> Result<(), RenderError> {
    let mut tasks = Vec::new();
    if measured.exact.is_some() {
        tasks.push(Task::Exact);
    }
    for series in 0..measured.series.len() {
        tasks.extend((0..plan.rungs.len()).map(|point| Task::Sampled(series, point)));
    }
    for round in numbers {
        let started = Instant::now();
        shuffle(&mut tasks, round);
        for &task in &tasks {
            match perform(task, round, plan, control, measured) {
                Err(RenderError::Cancelled) => {
                    measured.interrupted = true;
                    return Ok(());
                }
                done => done?,
            }
        }
        let next_ends = plan.started.elapsed() + started.elapsed();
        if plan.is_limited && next_ends > plan.request.budget {
            break;
        }
    }
    Ok(())
}

fn empty(plan: &Plan) -> Measurement {
    let machine = Machine::here();
    let pixels = plan.reference.bounds.len() as u64;
    let series = plan.warm_up.iter().map(|warm| Series {
        method: warm.method,
        points: plan
            .rungs
            .iter()
            .map(|&rung| Point::new(rung, pixels))
            .collect(),
        picture: None,
        tries: Vec::new(),
    });
    // Enough samples for the methods to differ, few enough for the eye to see it.
    let shown = plan.rungs.iter().find(|&&rung| rung >= 16);
    let shown = shown.or(plan.rungs.last()).copied().unwrap_or(0);
    let has_exact = plan.request.methods.contains(&Method::Exact);
    Measurement {
        subject: plan.subject.clone(),
        threads: plan
            .request
            .threads
            .map_or_else(threads::available, NonZero::get),
        machine,
        seed: plan.scene.sampler.seed,
        rungs: plan.rungs.clone(),
        runs: plan.runs,
        errors: plan.request.errors.clone(),
        reference: plan.reference.clone(),
        exact: has_exact.then(|| Computed { times: Vec::new() }),
        series: series.collect(),
        shown,
        interrupted: false,
        is_warm_up: false,
        seconds: 0.0,
    }
}

/// Whether anything of what counts was measured: a sampled method, if there are any.
fn any_run(measured: &Measurement) -> bool {
    match measured.series.is_empty() {
        true => measured.rounds() > 0,
        false => {
            let mut points = measured.series.iter().flat_map(|series| &series.points);
            points.any(|point| !point.times.is_empty())
        }
    }
}

/// The warm-up in place of runs, of which there are none.
fn warmed_up(plan: &Plan, measured: &mut Measurement) {
    measured.is_warm_up = true;
    measured.rungs = match plan.warm_up.is_empty() {
        true => Vec::new(),
        false => vec![plan.warm],
    };
    for (series, warm) in measured.series.iter_mut().zip(&plan.warm_up) {
        let mut point = Point::new(plan.warm, plan.reference.bounds.len() as u64);
        warm.runs.iter().for_each(|&run| point.add(run));
        series.points = vec![point];
    }
    if let Some(exact) = &mut measured.exact
        && exact.times.is_empty()
    {
        exact.times.push(plan.exact_seconds);
    }
}

fn perform(
    task: Task,
    round: u64,
    plan: &Plan,
    control: &Control,
    measured: &mut Measurement,
) -> Result<(), RenderError> {
    let pixels = plan.reference.bounds.len() as f64;
    let nanoseconds = match task {
        Task::Exact => plan.exact_seconds * 1e9 / pixels,
        Task::Sampled(series, point) => {
            let samples = plan.rungs[point] as f64 * pixels;
            plan.warm_up[series].seconds(samples) * 1e9 / samples
        }
    };
    let control = Control {
        threads: plan.request.threads,
        progress: &|done| (control.progress)((done as f64 * nanoseconds) as u64),
        cancel: control.cancel,
    };
    match task {
        Task::Exact => {
            let (_, seconds) = computed(plan.scene, &control)?;
            if let Some(exact) = &mut measured.exact {
                exact.times.push(seconds);
            }
        }
        Task::Sampled(series, point) => {
            let series = &mut measured.series[series];
            let point = &mut series.points[point];
            // Seeds are below 2^53.
            let seed = (measured.seed + round) % (1 << 53);
            let (scene, reference) = (plan.scene, &plan.reference.film);
            let (done, film) = run(
                scene,
                series.method,
                point.per_pixel,
                seed,
                reference,
                &control,
            )?;
            point.add(done);
            if round == 0 && point.per_pixel == measured.shown {
                series.picture = Some(film);
            }
        }
    }
    // Cancelled between the last tile and here: the run is whole, and the next one ends at once.
    if control.cancel.load(Ordering::Relaxed) {
        return Err(RenderError::Cancelled);
    }
    Ok(())
}

/// An order that depends on the number of the round alone (Fisher and Yates).
fn shuffle(tasks: &mut [Task], round: u64) {
    let key = Key::new(round, 0);
    for last in (1..tasks.len()).rev() {
        tasks.swap(last, scale(key.bits(last as u64), last as u64 + 1) as usize);
    }
}

/// Renders by a method, and says how long it took and how wrong it is.
pub(super) fn run(
    scene: &Scene,
    method: Method,
    per_pixel: u64,
    seed: u64,
    reference: &Film,
    control: &Control,
) -> Result<(Run, Film), RenderError> {
    let sampler = Sampler {
        method,
        count: Count::PerPixel(per_pixel),
        seed,
    };
    let (width, height) = (scene.image.width, scene.image.height);
    let started = Instant::now();
    let world = World::new_unless(scene, control.cancel)?;
    let sampling = Sampling::new(&sampler, width, height);
    let (film, rays) = render_and_count(&world, &sampling, Area::whole(width, height), control)?;
    let seconds = started.elapsed().as_secs_f64();
    let (rmse, largest) = difference(&film, reference);
    let run = Run {
        rays,
        seconds,
        rmse,
        largest,
    };
    Ok((run, film))
}

/// Computes the exact picture, and says in how many seconds.
pub(super) fn computed(scene: &Scene, control: &Control) -> Result<(Exact, f64), RenderError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let started = Instant::now();
    let world = World::new_unless(scene, control.cancel)?;
    let exact = render_exact(&world, whole, control)?;
    Ok((exact, started.elapsed().as_secs_f64()))
}

/// The root of the mean squared difference of two films of one size, over all pixels and channels, and the largest difference.
fn difference(film: &Film, reference: &Film) -> (f64, f64) {
    let (mut squares, mut largest) = (0.0, 0f64);
    for y in 0..film.height() {
        // Row by row: the sums stay short, and their rounding small.
        let mut row = 0.0;
        for (a, b) in film.row(y).iter().zip(reference.row(y)) {
            for (a, b) in a.iter().zip(b) {
                row += (a - b) * (a - b);
                largest = largest.max((a - b).abs());
            }
        }
        squares += row;
    }
    let channels = f64::from(film.width()) * f64::from(film.height()) * 3.0;
    ((squares / channels).sqrt(), largest)
}
