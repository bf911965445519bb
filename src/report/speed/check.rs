//! Predictions are tried: the samples that an error should take are taken.
//!
//! A line through the logarithms of a few errors is straight; the truth need not be. Where the samples were left to the plan and time is
//! left of what it was given, the methods render once more: first where the line was extrapolated, with a few more samples than it says,
//! and again if that was too few; then with what the lines between two points say, until one of them is close. Of each the fastest come
//! first. What comes out are further points: what an error takes then lies between two of them.

use super::{
    measure::{Measurement, Point, run},
    needed::{Check, Needed, fitting},
    plan::Plan,
};
use crate::render::{Control, RenderError};

/// Of the time left so much may be filled with estimates.
const FILLED: f64 = 0.9;

/// Beyond what was measured so many times as many samples are taken as the line says: most lines flatten.
const MARGIN: f64 = 1.1;

/// Between two points the line is trusted where it may be off by this part at most.
pub(super) const CLOSE: f64 = 0.01;

/// A picture has no more samples than this.
const MOST: f64 = (1_u64 << 53) as f64;

/// So often samples are taken for an error.
const TRIES: usize = 3;

/// The renders that are to be made.
#[derive(Debug)]
pub struct Checks<'a> {
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
    is_extrapolated: bool,
}

impl<'a> Checks<'a> {
    /// Those that fit into the time that is left.
    pub fn new(plan: &'a Plan, measured: &Measurement) -> Self {
        let mut left = left(plan, measured);
        let renders = renders(measured).into_iter();
        let fit = renders.map(|render| render.seconds).take_while(|seconds| {
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
        while let Some(render) = renders(measured).first() {
            if render.seconds > left(plan, measured) {
                break;
            }
            let mut point = Point::new(render.per_pixel, pixels);
            let nanoseconds = render.seconds * 1e9 / point.samples as f64;
            let control = Control {
                threads: plan.request.threads,
                progress: &|done| (control.progress)((done as f64 * nanoseconds) as u64),
                cancel: control.cancel,
            };
            let series = &mut measured.series[render.series];
            match run(
                plan.scene,
                series.method,
                render.per_pixel,
                measured.seed,
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
                    series.checks.push(Check { wanted, point });
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
    let mut renders = Vec::new();
    for (at, series) in measured.series.iter().enumerate() {
        for &wanted in &measured.errors {
            let tries = series.checks.iter().filter(|check| check.wanted == wanted);
            let needed = measured.needed(series, wanted);
            let is_open = |needed: &Needed| needed.is_extrapolated || needed.sag > CLOSE;
            let needed = needed.filter(|needed| is_open(needed) && tries.count() < TRIES);
            let render = needed.and_then(|needed| {
                let per_pixel = match needed.is_extrapolated {
                    true => fitting(series.method, (MARGIN * needed.per_pixel).ceil()),
                    false => needed.per_pixel,
                };
                let is_measured = |point: &&Point| point.per_pixel as f64 == per_pixel;
                if per_pixel * measured.reference.bounds.len() as f64 > MOST
                    || series.curve().iter().any(is_measured)
                {
                    return None;
                }
                Some(Render {
                    series: at,
                    wanted,
                    per_pixel: per_pixel as u64,
                    seconds: series.seconds_at(per_pixel)?.0,
                    is_extrapolated: needed.is_extrapolated,
                })
            });
            renders.extend(render);
        }
    }
    // Those that lie beyond all that was measured may be off by the most.
    renders.sort_by(|a, b| {
        let by_kind = b.is_extrapolated.cmp(&a.is_extrapolated);
        by_kind.then(a.seconds.total_cmp(&b.seconds))
    });
    renders
}
