//! The accuracy of the arithmetic, measured with a catalogue of hard cases.
//!
//! A case generates inputs around a singularity: tangents, horizons, shared edges, eyes on
//! surfaces, numbers of all sizes. What is seen there is decided three times: by the
//! [`oracle`](crate::reference::oracle) in hundreds of bits, by the
//! [`textbook`](crate::reference::textbook) formulas in `f64`, and by the tracer that renders
//! pictures, one ray at a time. (Tests verify that SIMD rays give bit-identical pictures.)
//! Decisions that differ from the oracle's are counted. Distances and points are measured for one
//! input of 16. Unless the case says otherwise, inputs lie at the neighbouring `f64`s on both sides
//! of a boundary, and at distances from the boundary that are uniform on a logarithmic scale.
//!
//! Inputs depend only on the case and on their own number, so that they are the same for any number
//! of threads.
//!
//! The catalogue leaves out what the tests of the samplers and of the film cover. It also leaves
//! out what the language rejects, such as negative sizes, empty clip ranges, and numbers that are
//! not finite.

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

/// Returns all cases of the catalogue, in order.
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

/// Number of inputs of a case that share a scene, which is prepared once for all of them. They are
/// generated and tested one after the other by one thread.
const BLOCK: u64 = 100;

/// Tests `inputs_per_case` inputs of every case, and reports progress in inputs. If the run is
/// cancelled, the result contains the inputs tested until then: about equally many of every case,
/// and at least one.
///
/// # Errors
///
/// No thread can be started.
pub fn run(inputs_per_case: u64, control: &Control) -> Result<NumericsTable, NoThreads> {
    let cases: Vec<_> = cases().collect();
    let blocks = inputs_per_case.div_ceil(BLOCK);
    let count = cases.len() as u64;
    // Blocks alternate between all cases, so that all cases progress evenly.
    let ask = |mut tallies: Vec<CaseTally>, index| {
        let (block, at) = (index / count, (index % count) as usize);
        let inputs = BLOCK.min(inputs_per_case - block * BLOCK);
        let random = &mut CaseRng::new(cases[at].id, block);
        // Each block has a tally of its own, so that the choice of measured inputs does not depend
        // on how the threads share the blocks.
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
