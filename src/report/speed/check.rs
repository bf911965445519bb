//! Predictions are tried: the samples that an error should take are taken, where that was extrapolated.
//!
//! A line through the logarithms of a few errors is straight; the truth need not be. Where the samples were left to the plan and time is
//! left of what it was given, the methods render once more, the fastest first, with as many samples as the line says. What they leave of
//! the error stands beside the prediction, which it does not change, and at the ends of the charts' lines.

use super::{
    measure::{Measurement, run},
    needed::Check,
    plan::Plan,
};
use crate::render::{Control, RenderError};

/// Of the time left so much may be filled with estimates.
const FILLED: f64 = 0.9;

/// The renders that are to be made.
#[derive(Debug)]
pub struct Checks<'a> {
    plan: &'a Plan<'a>,
    renders: Vec<Render>,
}

#[derive(Clone, Copy, Debug)]
struct Render {
    series: usize,
    wanted: f64,
    per_pixel: u64,
    /// The estimate.
    seconds: f64,
}

impl<'a> Checks<'a> {
    /// Those that fit into the time that is left.
    pub fn new(plan: &'a Plan, measured: &Measurement) -> Self {
        let mut renders = Vec::new();
        for (series, of) in measured.series.iter().enumerate() {
            for &wanted in &measured.errors {
                let needed = of.needed(wanted).filter(|needed| needed.is_extrapolated);
                renders.extend(needed.map(|needed| Render {
                    series,
                    wanted,
                    per_pixel: needed.per_pixel as u64,
                    seconds: needed.seconds,
                }));
            }
        }
        renders.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let mut left = match plan.request.samples.is_empty() && !measured.interrupted {
            true => FILLED * plan.left().as_secs_f64(),
            // Whoever says how many samples are taken wants no others.
            false => 0.0,
        };
        let fit = renders.iter().take_while(|render| {
            left -= render.seconds;
            left >= 0.0
        });
        let fit = fit.count();
        renders.truncate(fit);
        Self { plan, renders }
    }

    /// How long they will take, in nanoseconds: the whole of the progress.
    pub fn total(&self) -> u64 {
        let seconds: f64 = self.renders.iter().map(|render| render.seconds).sum();
        (seconds * 1e9) as u64
    }

    /// Renders, and notes what came of it. When it is cancelled, the measurement is marked as interrupted.
    pub fn run(&self, measured: &mut Measurement, control: &Control) -> Result<(), RenderError> {
        let plan = self.plan;
        let reference = &plan.reference.film;
        for render in &self.renders {
            let samples = render.per_pixel as f64 * plan.reference.bounds.len() as f64;
            let nanoseconds = render.seconds * 1e9 / samples;
            let control = Control {
                threads: plan.request.threads,
                progress: &|done| (control.progress)((done as f64 * nanoseconds) as u64),
                cancel: control.cancel,
            };
            let series = &mut measured.series[render.series];
            let per_pixel = render.per_pixel;
            match run(
                plan.scene,
                series.method,
                per_pixel,
                measured.seed,
                reference,
                &control,
            ) {
                Err(RenderError::Cancelled) => {
                    measured.interrupted = true;
                    break;
                }
                done => {
                    let (run, _) = done?;
                    series.checks.push(Check {
                        wanted: render.wanted,
                        per_pixel,
                        seconds: run.seconds,
                        rmse: run.rmse,
                        largest: run.largest,
                    });
                }
            }
        }
        measured.seconds = plan.started.elapsed().as_secs_f64();
        Ok(())
    }
}
