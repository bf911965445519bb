//! Answers are tried: samples as many as an error should take, or about as many, are taken.
//!
//! A line through the logarithms of a few errors is straight; the truth need not be, and its points are counts that most methods like better than
//! others. Where the samples were left to the plan and time is left of what it was given, each method renders a few times more: with as many samples as
//! the answer says, and, as that moves by what comes out, with some more and some fewer, each time with another seed. So the tries tell both where the
//! error lies and how much one render differs from the next. What takes the least time comes first.

use super::{
    measure::{Measurement, Point, run},
    plan::Plan,
    tried::{FEWEST_TRIES, Try},
};
use crate::render::{Control, RenderError};

/// Of the time left so much may be filled with estimates.
const FILLED: f64 = 0.9;

/// A picture has no more samples than this.
const MOST: f64 = (1_u64 << 53) as f64;

/// So many tries near an answer are wanted: with them it may be off by 2.8 times what one render differs from the next, with half of them by 5.0 times.
const WANTED: usize = 6;

/// No more than so many are made for an error, near or not.
const MOST_TRIES: usize = 12;

/// The counts that are tried, one after the other: the logarithms of what the answer is multiplied with.
const SPREAD: [f64; WANTED] = [0.0, 0.1, -0.1, 0.2, -0.2, 0.05];

/// The renders that are to be made.
#[derive(Debug)]
pub struct Tries<'a> {
    plan: &'a Plan<'a>,
    total: f64,
}

#[derive(Clone, Copy, Debug)]
struct Render {
    series: usize,
    wanted: f64,
    per_pixel: u64,
    /// The estimate.
    seconds: f64,
    /// So many more tries are wanted, this one among them.
    missing: usize,
}

impl Render {
    /// How long all that are wanted will take.
    fn in_all(&self) -> f64 {
        self.seconds * self.missing as f64
    }

    /// How long it takes until the tries tell anything.
    fn until_told(&self) -> f64 {
        let near = WANTED - self.missing;
        self.seconds * FEWEST_TRIES.saturating_sub(near).max(1) as f64
    }
}

impl<'a> Tries<'a> {
    /// Those that fit into the time that is left.
    pub fn new(plan: &'a Plan, measured: &Measurement) -> Self {
        let mut left = left(plan, measured);
        let renders = renders(measured).into_iter();
        let fit = renders.map(|render| render.in_all()).take_while(|seconds| {
            left -= seconds;
            left >= 0.0
        });
        Self {
            plan,
            total: fit.sum(),
        }
    }

    /// How long they will take at first, in nanoseconds: the whole of the progress.
    pub fn total(&self) -> u64 {
        (self.total * 1e9) as u64
    }

    /// Renders, and notes what came of it. When it is cancelled, the measurement is marked as interrupted.
    pub fn run(&self, measured: &mut Measurement, control: &Control) -> Result<(), RenderError> {
        let plan = self.plan;
        let pixels = plan.reference.bounds.len() as u64;
        loop {
            let left = left(plan, measured);
            let renders = renders(measured);
            let Some(render) = renders.iter().find(|render| render.until_told() <= left) else {
                break;
            };
            let mut point = Point::new(render.per_pixel, pixels);
            let nanoseconds = render.seconds * 1e9 / point.samples as f64;
            let control = Control {
                threads: plan.request.threads,
                progress: &|done| (control.progress)((done as f64 * nanoseconds) as u64),
                cancel: control.cancel,
            };
            let series = &mut measured.series[render.series];
            // No run that was planned has this seed. Seeds are below 2^53.
            let seed = (measured.seed + measured.runs + series.tries.len() as u64) % (1 << 53);
            match run(
                plan.scene,
                series.method,
                render.per_pixel,
                seed,
                &plan.reference.film,
                &control,
            ) {
                Err(RenderError::Cancelled) => {
                    measured.interrupted = true;
                    break;
                }
                done => {
                    point.add(done?.0);
                    let wanted = render.wanted;
                    series.tries.push(Try {
                        wanted,
                        seed,
                        point,
                    });
                }
            }
        }
        measured.seconds = plan.started.elapsed().as_secs_f64();
        Ok(())
    }
}

/// The seconds that may be filled.
fn left(plan: &Plan, measured: &Measurement) -> f64 {
    match plan.request.samples.is_empty() && !measured.interrupted {
        true => FILLED * plan.left().as_secs_f64(),
        // Whoever says how many samples are taken wants no others.
        false => 0.0,
    }
}

/// What is to be tried by what is known, in this order.
fn renders(measured: &Measurement) -> Vec<Render> {
    let render = |at: usize, wanted: f64| {
        let series = &measured.series[at];
        let tried = series.approach(wanted).filter(|_| measured.tells(wanted))?;
        let made = series.tries_for(wanted).count();
        // If none is near, the last one counts, which led to the place.
        let near = tried.near.len();
        if near >= WANTED || made >= MOST_TRIES {
            return None;
        }
        let per_pixel = libm::exp(tried.x + SPREAD[near]).round().max(1.0);
        if per_pixel * measured.reference.bounds.len() as f64 > MOST {
            return None;
        }
        Some(Render {
            series: at,
            wanted,
            per_pixel: per_pixel as u64,
            seconds: series.seconds_at(per_pixel)?.0,
            missing: WANTED - near,
        })
    };
    let errors = || measured.errors.iter();
    let mut renders: Vec<_> = (0..measured.series.len())
        .flat_map(|at| errors().filter_map(move |&wanted| render(at, wanted)))
        .collect();
    renders.sort_by(|a, b| a.in_all().total_cmp(&b.in_all()));
    renders
}
