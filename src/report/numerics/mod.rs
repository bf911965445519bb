//! Measures the accuracy of the arithmetic in hard cases.
//!
//! A hard case generates scenes in which rounding errors easily cause wrong answers, for example by
//! rays that touch surfaces, horizons, shared edges, eyes on surfaces, or very large numbers. An
//! input is a scene and a point of its picture. What is seen at the point is computed three times:
//! by the [`oracle`](crate::reference::oracle), a reference tracer with at least 512 bits; by the
//! [`textbook`](crate::reference::textbook) formulas in `f64`; and by the tracer that renders
//! pictures. Answers that differ from the oracle's are counted. At every 16th input, the errors of
//! the distance and of the seen point's coordinates are also measured. The tracer is called for one
//! ray at a time. Tests verify that SIMD rays give bit-identical pictures.
//!
//! By default, the points lie close to boundaries between colours: at the neighbouring `f64`s on
//! both sides, and at distances that are uniform on a logarithmic scale. An input depends only on
//! its case and its index, so the number of threads does not affect it.
//!
//! Samplers and films are not tested here, because they have tests of their own. Scenes that the
//! language rejects, such as those with negative sizes, are not tested either.

mod board;
mod camera;
mod case;
mod cuboid;
mod inputs;
mod sphere;
mod table;
mod trial;
mod triangle;

use std::sync::atomic::Ordering;

use rayon::prelude::*;

use self::inputs::CaseRng;
pub use self::{
    case::Case,
    table::{CaseResult, NumericsTable},
    trial::CaseTally,
};
use crate::{
    render::Control,
    threads::{self, NoThreads},
};

/// Returns all hard cases, in the order of the report.
pub fn cases() -> impl Iterator<Item = &'static Case> {
    let families = [
        sphere::CASES,
        board::CASES,
        cuboid::CASES,
        triangle::CASES,
        camera::CASES,
    ];
    families.into_iter().flatten()
}

/// Number of inputs of a case that are tested in the same scene by one thread. Preparing a scene is
/// slow, so a scene is used for many inputs. With a larger number, there would be fewer different
/// scenes.
const BLOCK: u64 = 100;

/// Tests `inputs_per_case` inputs of every case. Reports the progress as a number of inputs. If the
/// run is cancelled, returns the results so far, with about equally many inputs of every case.
///
/// # Errors
///
/// Fails if no thread can be started.
pub fn run(inputs_per_case: u64, control: &Control) -> Result<NumericsTable, NoThreads> {
    let cases: Vec<_> = cases().collect();
    let blocks = inputs_per_case.div_ceil(BLOCK);
    let count = cases.len() as u64;
    // The blocks of different cases alternate, so that all cases progress evenly.
    let ask = |mut tallies: Vec<CaseTally>, index| {
        let (block, at) = (index / count, (index % count) as usize);
        let inputs = BLOCK.min(inputs_per_case - block * BLOCK);
        let random = &mut CaseRng::new(cases[at].id, block);
        // A tally counts its inputs, and measures the errors of every 16th. Each block of inputs
        // has its own tally. So the same inputs are measured, whichever thread tests a block.
        let mut tally = CaseTally::default();
        cases[at].ask(random, inputs, &mut tally);
        tallies[at] = tallies[at].plus(tally);
        (control.progress)(inputs);
        tallies
    };
    let none = || vec![CaseTally::default(); cases.len()];
    let tallies = threads::install(control.threads, || {
        (0..count * blocks)
            .into_par_iter()
            .take_any_while(|_| !control.cancel.load(Ordering::Relaxed))
            .fold(none, ask)
            .reduce(none, |mut a, b| {
                for (a, b) in a.iter_mut().zip(b) {
                    *a = a.plus(b);
                }
                a
            })
    })?;
    let rows = cases.into_iter().zip(tallies);
    let rows = rows.map(|(case, tally)| CaseResult { case, tally });
    Ok(NumericsTable {
        rows: rows.filter(|row| row.tally.inputs > 0).collect(),
        planned: inputs_per_case.saturating_mul(count),
    })
}
