//! How right the arithmetic is: a catalogue of hard cases, each asked many times.
//!
//! A case makes inputs around a singularity: tangents, horizons, shared edges, eyes on surfaces, numbers of all sizes. What is
//! seen there is decided three times: by the [`oracle`] in hundreds of bits, by the formulas of a [`textbook`] in `f64`, and by
//! the tracer that renders pictures, one ray at a time. (Rays in vectors give the same pictures to the bit, as tests see to.) Decisions that differ from the oracle's are counted, distances and points measured at one
//! input of 16. Inputs lie at the neighbouring `f64`s on both sides of a boundary and at distances from it that are spread evenly on a
//! logarithmic scale, or where the case says.
//!
//! Inputs are a function of the case and their number alone, so the same ones come out of any number of threads.
//!
//! Not here: what the tests of the samplers and of the film ask, and what the language rejects before it could become a picture (S6, K1 and F3:
//! negative sizes, empty clip ranges, numbers that are not finite).

mod board;
mod camera;
mod case;
mod clip;
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
    table::{Claim, Row, Table},
    trial::Tally,
};
use crate::{render::Control, threads};

/// The catalogue, each case with what is claimed of it.
pub fn cases() -> impl Iterator<Item = (Claim, &'static Case)> {
    let families = [
        (Claim::Ulps(1.0), sphere::CASES),
        (Claim::Ulps(2.0), board::CASES),
        (Claim::Ulps(2.0), cuboid::CASES),
        (Claim::Ulps(2.0), triangle::CASES),
        (Claim::Roundings(4.0), camera::AXES),
        (Claim::Ulps(2.0), camera::CASES),
        (Claim::Ulps(2.0), clip::CASES),
    ];
    let rows =
        |(claim, cases): (Claim, &'static [Case])| cases.iter().map(move |case| (claim, case));
    families.into_iter().flat_map(rows)
}

/// So many inputs of a case share a scene.
const BLOCK: u64 = 100;

/// Asks so many inputs of every case. The progress is told in inputs. When it is cancelled, what was asked until then comes out: of all
/// cases about as many, none that was asked nothing.
pub fn run(inputs_per_case: u64, control: &Control) -> Result<Table, ThreadPoolBuildError> {
    let cases: Vec<_> = cases().collect();
    let blocks = inputs_per_case.div_ceil(BLOCK);
    let tallies = threads::install(control.threads, || {
        (0..cases.len() as u64 * blocks)
            .into_par_iter()
            .take_any_while(|_| !control.cancel.load(Ordering::Relaxed))
            .fold(
                || vec![Tally::default(); cases.len()],
                |mut tallies, index| {
                    // Block by block of all cases, so that the progress is even.
                    let count = cases.len() as u64;
                    let (block, at) = (index / count, (index % count) as usize);
                    let count = BLOCK.min(inputs_per_case - block * BLOCK);
                    let mut tally = Tally::default();
                    let case = cases[at].1;
                    let random = &mut Random::new(case.id, block);
                    case.ask(random, count, &mut tally);
                    tallies[at] = tallies[at].plus(tally);
                    (control.progress)(count);
                    tallies
                },
            )
            .reduce(
                || vec![Tally::default(); cases.len()],
                |a, b| a.into_iter().zip(b).map(|(a, b)| a.plus(b)).collect(),
            )
    })?;
    let rows = cases.iter().zip(tallies).map(|((claim, case), tally)| Row {
        id: case.id,
        title: case.title,
        claim: *claim,
        tally,
    });
    Ok(Table {
        rows: rows.filter(|row| row.tally.inputs > 0).collect(),
        planned: inputs_per_case.saturating_mul(cases.len() as u64),
    })
}
