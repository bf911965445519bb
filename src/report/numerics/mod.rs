//! How right the arithmetic is: a catalogue of hard cases, each asked many times.
//!
//! A case makes inputs around a singularity: tangents, horizons, shared edges, eyes on surfaces,
//! numbers of all sizes. What is seen there is decided three times: by the [`oracle`] in hundreds
//! of bits, by the formulas of a [`textbook`] in `f64`, and by the tracer that renders pictures,
//! one ray at a time. (Rays in vectors give the same pictures to the bit, as tests see to.)
//! Decisions that differ from the oracle's are counted, distances and points measured at one
//! input of 16. Inputs lie at the neighbouring `f64`s on both sides of a boundary and at distances
//! from it that are spread evenly on a logarithmic scale, or where the case says.
//!
//! Inputs are a function of the case and their number alone, so the same ones come out of any
//! number of threads.
//!
//! Not here: what the tests of the samplers and of the film ask, and what the language rejects
//! before it could become a picture, such as negative sizes, empty clip ranges, and numbers that
//! are not finite.

mod board;
mod camera;
mod case;
mod cuboid;
mod inputs;
pub mod oracle;
pub mod scenes;
mod sphere;
mod table;
pub mod textbook;
mod trial;
mod triangle;

use std::sync::atomic::Ordering;

use rayon::{ThreadPoolBuildError, prelude::*};

use self::inputs::Random;
pub use self::{
    case::Case,
    table::{Row, Table},
    trial::Tally,
};
use crate::{render::Control, threads};

/// The catalogue.
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

/// So many inputs of a case share a scene.
const BLOCK: u64 = 100;

/// Asks so many inputs of every case. The progress is told in inputs. When it is cancelled, what
/// was asked until then comes out: of all cases about as many, none that was asked nothing.
pub fn run(inputs_per_case: u64, control: &Control) -> Result<Table, ThreadPoolBuildError> {
    let cases: Vec<_> = cases().collect();
    let blocks = inputs_per_case.div_ceil(BLOCK);
    let count = cases.len() as u64;
    // Block by block of all cases, so that the progress is even.
    let ask = |mut tallies: Vec<Tally>, index| {
        let (block, at) = (index / count, (index % count) as usize);
        let inputs = BLOCK.min(inputs_per_case - block * BLOCK);
        let random = &mut Random::new(cases[at].id, block);
        // A tally of its own, so that which inputs are measured does not depend on how the threads
        // share the blocks.
        let mut tally = Tally::default();
        cases[at].ask(random, inputs, &mut tally);
        tallies[at] = tallies[at].plus(tally);
        (control.progress)(inputs);
        tallies
    };
    let none = || vec![Tally::default(); cases.len()];
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
    let rows = rows.map(|(case, tally)| Row { case, tally });
    Ok(Table {
        rows: rows.filter(|row| row.tally.inputs > 0).collect(),
        planned: inputs_per_case.saturating_mul(count),
    })
}
