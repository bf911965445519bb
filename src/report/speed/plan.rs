//! What is measured, so that it fits into the time there is.
//!
//! The exact picture is computed, and every method renders twice, and once with more samples where that takes but a part of the time. That warms
//! the machine up and counts for nothing, unless nothing else gets measured; what it took decides how far the ladder of samples goes and how
//! many runs there are, where the user leaves that open. Where their times turn out to be noisy, there are more.

use std::{
    num::NonZero,
    time::{Duration, Instant},
};

use super::{
    measure::{Measurement, Run, Subject, computed, run},
    notes::noisy,
};
use crate::{
    render::{Control, Exact, RenderError},
    scene::{Method, Scene},
};

/// The longest ladder that is chosen: powers of 4, which suit every method, so many from 1 on.
const MOST_RUNGS: u32 = 6;

/// The shortest one: a slope through fewer points has no uncertainty.
const FEWEST_RUNGS: u32 = 3;

/// The samples per pixel of the warm-up.
const WARM: u64 = 4;

/// So many times as many samples tell what a sample takes, and what the rest, ...
const MORE: u64 = 8;

/// ... where that takes no more than this share of the time.
const MORE_SHARE: f64 = 0.15;

/// So much of a time with many samples is theirs, whatever a noisy machine says.
pub(super) const LEAST_SHARE: f64 = 0.25;

/// So many runs are wanted, and no more than so many are made.
const RUNS: (u64, u64) = (3, 9);

/// So much of the time left is planned: the rest is for comparing, drawing and estimates that were too low.
const PLANNED: f64 = 0.9;

/// The same where the samples are chosen: the rest is for tries, too.
const PLANNED_CHOICE: f64 = 0.7;

/// What the user asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The methods, `exact` among them or not.
    pub methods: Vec<Method>,
    /// Samples per pixel; chosen if there are none.
    pub samples: Vec<u64>,
    /// Runs of each method and number of samples; chosen if this is `None`.
    pub runs: Option<u64>,
    /// The errors for which the needed samples and time are told, in linear light.
    pub errors: Vec<f64>,
    /// How long it may take, as far as there is a choice.
    pub budget: Duration,
    /// How many threads render; as many as there are processors if this is `None`.
    pub threads: Option<NonZero<usize>>,
}

impl Request {
    /// The progress of [`Plan::new`] in all: the pixels of the exact picture, and as many for the warm-up of each sampled method.
    pub fn preparations(&self, scene: &Scene) -> u64 {
        pixels(scene) * (1 + sampled(self).count() as u64)
    }
}

/// A report that is decided on.
#[derive(Debug)]
pub struct Plan<'a> {
    pub(super) subject: &'a Subject,
    pub(super) scene: &'a Scene,
    pub(super) request: &'a Request,
    pub(super) started: Instant,
    /// The exact picture.
    pub(super) reference: Exact,
    pub(super) is_limited: bool,
    /// The samples per pixel of the warm-up.
    pub(super) warm: u64,
    /// Samples per pixel, ascending.
    pub(super) rungs: Vec<u64>,
    pub(super) runs: u64,
    /// How long the exact picture took.
    pub(super) exact_seconds: f64,
    /// What each sampled method did before anything counted.
    pub(super) warm_up: Vec<Warm>,
}

/// The warm-up of a method.
#[derive(Debug)]
pub(super) struct Warm {
    pub(super) method: Method,
    /// Each with the seed of the scene and few samples.
    pub(super) runs: Vec<Run>,
    /// The estimate: seconds a sample, ...
    rate: f64,
    /// ... and seconds that do not depend on their number.
    fixed: f64,
}

impl Warm {
    /// How long it should take to render with so many samples in all.
    pub(super) fn seconds(&self, samples: f64) -> f64 {
        self.fixed + self.rate * samples
    }
}

impl<'a> Plan<'a> {
    /// Computes the exact picture, warms up, and decides; progress is that of [`Request::preparations`]. Cancelled after the exact picture,
    /// it has warmed up as many methods as it came to.
    pub fn new(
        subject: &'a Subject,
        scene: &'a Scene,
        request: &'a Request,
        control: &Control,
    ) -> Result<Self, RenderError> {
        let started = Instant::now();
        let control = &Control {
            threads: request.threads,
            ..*control
        };
        let silent = Control {
            progress: &|_| {},
            ..*control
        };
        let (reference, exact_seconds) = computed(scene, control)?;
        let warm = match request.samples.iter().min() {
            Some(&least) => least.min(WARM),
            None => WARM,
        };
        let mut plan = Self {
            subject,
            scene,
            request,
            started,
            reference,
            is_limited: false,
            warm,
            rungs: request.samples.clone(),
            runs: request.runs.unwrap_or(0),
            exact_seconds,
            warm_up: Vec::new(),
        };
        for method in sampled(request) {
            match plan.warmed(method, &silent) {
                Err(RenderError::Cancelled) => break,
                warmed => plan.warm_up.push(warmed?),
            }
            (control.progress)(pixels(scene));
        }
        plan.choose();
        Ok(plan)
    }

    /// Renders twice by a method.
    fn warmed(&self, method: Method, control: &Control) -> Result<Warm, RenderError> {
        let film = &self.reference.film;
        let seed = self.scene.sampler.seed;
        let run = |per_pixel| run(self.scene, method, per_pixel, seed, film, control);
        // The first run finds the machine cold: the second one is the estimate, unless something else delays it.
        let runs = vec![run(self.warm)?.0, run(self.warm)?.0];
        let seconds = runs[0].seconds.min(runs[1].seconds);
        let samples = self.warm as f64 * self.reference.bounds.len() as f64;
        let mut warm = Warm {
            method,
            runs,
            rate: seconds / samples,
            fixed: 0.0,
        };
        let methods = sampled(self.request).count() as f64;
        let is_short =
            seconds * MORE as f64 * methods <= MORE_SHARE * self.request.budget.as_secs_f64();
        if self.request.samples.is_empty() && is_short {
            let more = run(MORE * self.warm)?.0.seconds;
            let theirs = (more - seconds).max(LEAST_SHARE * more);
            warm.rate = theirs / (samples * (MORE - 1) as f64);
            warm.fixed = (more - warm.rate * samples * MORE as f64).max(0.0);
        }
        Ok(warm)
    }

    /// How long the measuring will take at first, in nanoseconds: the whole of the progress.
    pub fn total(&self) -> u64 {
        (self.round_seconds(&self.rungs) * self.runs as f64 * 1e9) as u64
    }

    /// What is left of the time that it may take.
    pub(super) fn left(&self) -> Duration {
        self.request.budget.saturating_sub(self.started.elapsed())
    }

    /// So many seconds of those that are left may be planned.
    fn planned(&self) -> f64 {
        let share = match self.request.samples.is_empty() {
            true => PLANNED_CHOICE,
            false => PLANNED,
        };
        self.left().as_secs_f64() * share
    }

    /// How many runs there is time for besides those that were made, if there are fewer than wanted or their times are noisy: the warm-up, too,
    /// may have been slower than the rest. None where somebody says how many there are.
    pub(super) fn further_runs(&self, measured: &Measurement) -> u64 {
        let (wanted, most) = RUNS;
        let runs = measured.rounds() as u64;
        let is_open = self.is_limited && !measured.interrupted && measured.is_measured();
        if !is_open || (runs >= wanted && noisy(measured) == 0) {
            return 0;
        }
        let fit = (self.planned() / measured.round_seconds().max(1e-9)) as u64;
        odd((runs + fit).min(most)).saturating_sub(runs)
    }

    fn choose(&mut self) {
        let left = self.planned();
        let (wanted, most) = RUNS;
        if self.rungs.is_empty() && !self.warm_up.is_empty() {
            let runs = self.request.runs.unwrap_or(wanted) as f64;
            let ladder = |rungs| (0..rungs).map(|rung| 1 << (2 * rung)).collect::<Vec<_>>();
            let rungs = (FEWEST_RUNGS..=MOST_RUNGS)
                .rev()
                .find(|&rungs| self.round_seconds(&ladder(rungs)) * runs <= left);
            self.rungs = ladder(rungs.unwrap_or(FEWEST_RUNGS));
        }
        self.rungs.sort_unstable();
        self.rungs.dedup();
        self.is_limited = self.request.runs.is_none();
        if self.is_limited {
            let fit = (left / self.round_seconds(&self.rungs).max(1e-9)) as u64;
            self.runs = odd(fit.clamp(1, most));
        }
    }

    /// How long one run of everything takes.
    fn round_seconds(&self, rungs: &[u64]) -> f64 {
        let pixels = self.reference.bounds.len() as f64;
        let of_method = |warm: &Warm| {
            let seconds = rungs.iter().map(|&rung| warm.seconds(rung as f64 * pixels));
            seconds.sum::<f64>()
        };
        let sampled: f64 = self.warm_up.iter().map(of_method).sum();
        let exact = match self.request.methods.contains(&Method::Exact) {
            true => self.exact_seconds,
            false => 0.0,
        };
        sampled + exact
    }
}

/// Of an odd number of runs the median is one of them: no more than these, unless they are few.
fn odd(runs: u64) -> u64 {
    match runs {
        0..=2 => runs,
        many => (many - 1) / 2 * 2 + 1,
    }
}

fn pixels(scene: &Scene) -> u64 {
    u64::from(scene.image.width) * u64::from(scene.image.height)
}

/// The methods that take samples, each once, in the order of the language's table.
fn sampled(request: &Request) -> impl Iterator<Item = Method> {
    let asked = |method: &Method| request.methods.contains(method);
    Method::SAMPLED.into_iter().filter(asked)
}
