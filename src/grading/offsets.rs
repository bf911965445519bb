//! Samples that lie on an even grid, but around another place than a pixel's middle.
//!
//! Half a pixel looks like a camera that looks a little elsewhere, and with one sample in a pixel like noise. But a program whose samples lie on an even grid shows the same
//! in each pixel as the faulty tracer with samples in the same places: if these are the right ones of no such grid and the shifted ones of one, that is no chance.

use glam::DVec2;

use super::{
    candidate::{Candidate, Mistake},
    faulty_tracer::FaultyTracer,
    judge::{Judge, Judged},
    light::{Curve, is_near},
    mistakes::ROWS,
};

/// Samples in a row of a pixel.
const SIDES: [u32; 5] = [1, 2, 3, 4, 5];

/// The share of pixels that may show something else: where an edge passes through a sample's place.
const OTHER: f64 = 0.004;

/// The share of pixels in which a shift has to make a difference.
const TELLS: f64 = 0.01;

/// A picture whose samples are shifted, told by its pixels.
pub fn regular(judge: &Judge) -> Option<Judged> {
    judge.fine.jpeg.is_none().then_some(())?;
    let right = Candidate::right(judge.scene);
    let rows = ROWS.iter().filter(|row| row.id == "half_pixel");
    let shifted: Vec<Candidate> = rows
        .filter_map(|row| right.with(Mistake::Row(row, None)))
        .collect();
    for side in SIDES {
        if differs(judge, &right, side, TELLS).is_none() {
            return None;
        }
        let mut found = shifted.iter();
        if let Some(found) = found.find(|one| differs(judge, one, side, OTHER).is_none()) {
            return judge.judged(found, &judge.edges);
        }
    }
    None
}

/// Whether more than a share of the pixels shows something else than so many samples in a row and in a column of each do; none if not.
fn differs(judge: &Judge, candidate: &Candidate, side: u32, share: f64) -> Option<()> {
    let grid = &judge.fine.grid;
    let seen = judge.fine.seen(Curve::Right);
    let half = candidate
        .layout
        .half_pixels
        .map(|half| 0.5 * f64::from(half));
    let mut unshifted = candidate.clone();
    unshifted.layout = Default::default();
    let scene = unshifted.drawn(grid);
    let tracer = FaultyTracer::new(&scene, candidate.behaviour, Curve::Right);
    let places = (0..side * side).map(|i| {
        let of = |k: u32| (f64::from(k) + 0.5) / f64::from(side);
        DVec2::new(of(i % side), of(i / side)) + DVec2::from(half)
    });
    let places: Vec<DVec2> = places.collect();
    let most = (share * seen.len() as f64) as usize;
    let mut count = 0;
    for (at, cell) in grid.cells.iter().enumerate() {
        if !seen[at][0].is_nan() && !is_near(tracer.mean(cell, &places), seen[at]) {
            count += 1;
            if count > most {
                judge.work.spend(at as f64 * f64::from(side * side));
                return Some(());
            }
        }
    }
    judge.work.spend(seen.len() as f64 * f64::from(side * side));
    None
}
