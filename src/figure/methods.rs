//! Draws the figure `methods`. It shows the sample points of each sampling method in a pixel, with
//! the same number of samples for all methods.

use glam::DVec2;

use super::canvas::{Canvas, WIDTH};
use crate::{
    math::SimdWidth,
    sampling::{Points, Sampling, Tiling, tilings},
    scene::{Count, Method, Sampler, Scene},
};

/// Maximum number of samples per pixel in a figure. With more samples, no figure is drawn, since
/// the dots would merge into a gray area.
const MOST: u64 = 1024;

/// Maximum number of rows and maximum number of columns of a grid of cells ([`Tiling`]) that is
/// drawn. The lines of a finer grid would merge into a gray area.
const MOST_LINES: usize = 64;

/// Side of the square that shows a pixel, in SVG units. Three of these squares fit beside each
/// other.
const SIDE: f64 = 196.0;

/// Distances between the corners of neighbouring squares, in SVG units: first horizontally, then
/// vertically. They leave space for the texts above each square.
const PITCH: DVec2 = DVec2::new(226.0, 262.0);

/// Rejects more than [`MOST`] samples in a pixel, since a figure could not show them clearly.
///
/// # Errors
///
/// Returns a sentence for the user if there are too many samples.
pub fn refuse_too_many(count: u64) -> Result<(), String> {
    if count <= MOST {
        Ok(())
    } else {
        Err(format!(
            "a figure shows at most {MOST} samples in a pixel, and there are {count}: try `--set sampler.per_pixel=16`"
        ))
    }
}

/// Draws the figure for the pixel in column `x` and row `y`.
pub fn draw(scene: &Scene, [x, y]: [u32; 2]) -> Result<String, String> {
    let count = Sampling::new(
        &Sampler {
            method: Method::Random,
            ..scene.sampler
        },
        scene.image.width,
        scene.image.height,
    )
    .samples_per_pixel();
    refuse_too_many(count)?;
    let mut canvas = Canvas::new(3.0 * PITCH.y + 14.0);
    let mut told = Vec::new();
    for (index, method) in Method::SAMPLED.into_iter().enumerate() {
        let corner = DVec2::new((index % 3) as f64, (index / 3) as f64) * PITCH;
        let corner = corner + DVec2::new((WIDTH - 2.0 * PITCH.x - SIDE) / 2.0, 58.0);
        let sampler = Sampler {
            method,
            count: Count::PerPixel(count),
            ..scene.sampler
        };
        let sampling = Sampling::new(&sampler, scene.image.width, scene.image.height);
        let own = sampling.count(x, y);
        let mut points = Points::default();
        sampling.place(SimdWidth::Baseline, [x, y], own, 0..own, &mut points);
        let kept = match method {
            Method::Scatter => format!("{own} fell here"),
            _ => kept(method, count),
        };
        let middle = corner + DVec2::new(SIDE / 2.0, 0.0);
        let above = |up: f64| middle - DVec2::new(0.0, up);
        canvas.text("ink strong", "middle", above(32.0), method.name());
        canvas.text("ink", "middle", above(10.0), &kept);
        strata(&mut canvas, method, count, corner, SIDE);
        let radius = (18.0 / (count as f64).sqrt()).clamp(2.0, 5.0);
        for offset in points.iter() {
            canvas.dot("red", corner + (offset + 0.5) * SIDE, radius);
        }
        told.push(format!("{}: {kept}", method.name()));
    }
    let told = told.join("; ");
    Ok(canvas.finish(
        &format!("Nine sampling methods, {count} samples in a pixel"),
        &format!("The samples of pixel ({x}, {y}) by each method, with the strata that hold one sample each. {told}."),
    ))
}

/// Describes in words how a method divides a pixel into cells, each of which contains one of the
/// `n` samples.
fn kept(method: Method, n: u64) -> String {
    let tilings = tilings(method, n);
    if tilings.len() > 3 {
        return format!("every box of 1/{n}");
    }
    let words = tilings.iter().map(|tiling| match tiling {
        // The method `regular` places each sample exactly in the middle of its cell.
        _ if method == Method::Regular => "middles of cells",
        tiling if tiling.is_columns() && tiling.is_rows() => "anywhere",
        tiling if tiling.is_columns() => "columns",
        tiling if tiling.is_rows() => "rows",
        _ => "cells",
    });
    match words.collect::<Vec<_>>()[..] {
        [] => "no strata".to_owned(),
        ref words => words.join(", "),
    }
}

/// Draws the cells into which a method divides a pixel, each of which contains one of the `n`
/// samples. The pixel is drawn as a square with the top left corner `corner` and the side `side`. A
/// method may divide the pixel in several ways at once ([`Tiling`]s), for example into cells, rows
/// and columns. If the first tiling is a grid of cells instead of whole rows or columns, its lines
/// are drawn stronger, so that cells are distinguished from rows and columns.
pub fn strata(canvas: &mut Canvas, method: Method, n: u64, corner: DVec2, side: f64) {
    let at = |x: f64, y: f64| corner + DVec2::new(x, y) * side;
    let tilings = if n > 0 { tilings(method, n) } else { vec![] };
    for (rank, tiling) in tilings.iter().enumerate().rev() {
        let is_cells = rank == 0 && !tiling.is_columns() && !tiling.is_rows();
        for line in lines(tiling) {
            let [from, to] = line.map(|[x, y]| at(x, y));
            canvas.line(if is_cells { "faint cell" } else { "faint" }, &[from, to]);
        }
    }
    let frame = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
    canvas.line("ink", &[&frame[..], &frame[..1]].concat());
}

/// Tints one stratum of each kind into which the method divides a pixel: a cell, a column or a row.
/// Returns the CSS class and the name of each tinted stratum.
pub fn tint_strata(
    canvas: &mut Canvas,
    method: Method,
    n: u64,
    corner: DVec2,
    side: f64,
) -> Vec<(&'static str, &'static str)> {
    let tilings = if n > 1 { tilings(method, n) } else { vec![] };
    let mut marked = Vec::new();
    for tiling in &tilings {
        let height = tiling
            .rows
            .first()
            .map_or(0.0, |cells| *cells as f64 / n as f64);
        // To keep the tinted strata apart, the last column, the last row and the first cell are
        // tinted.
        let (stratum, from, to) = match (tiling.is_columns(), tiling.is_rows()) {
            (true, _) => {
                let stratum = ("blue", "a column");
                (stratum, DVec2::new(1.0 - 1.0 / n as f64, 0.0), DVec2::ONE)
            }
            (_, true) => {
                let stratum = ("green", "a row");
                (stratum, DVec2::new(0.0, 1.0 - 1.0 / n as f64), DVec2::ONE)
            }
            _ => {
                let width = 1.0 / tiling.rows[0] as f64;
                (("red", "a cell"), DVec2::ZERO, DVec2::new(width, height))
            }
        };
        // If several tilings consist of cells, only a cell of the first tiling is tinted, since the
        // cells of this tiling are most nearly square.
        if marked.contains(&stratum) {
            continue;
        }
        let [from, to] = [from, to].map(|at| corner + at * side);
        let around = [from, from.with_x(to.x), to, from.with_y(to.y), from];
        canvas.tint(stratum.0, &around);
        marked.push(stratum);
    }
    marked
}

/// Returns the lines between the cells of a grid that divides the unit square.
fn lines(tiling: &Tiling) -> Vec<[[f64; 2]; 2]> {
    let n = tiling.rows.iter().sum::<u64>() as f64;
    let widest = tiling.rows.iter().copied().max().unwrap_or_default() as usize;
    if widest.max(tiling.rows.len()) > MOST_LINES {
        return Vec::new();
    }
    let (mut lines, mut above) = (Vec::new(), 0);
    for &cells in &tiling.rows {
        let (top, bottom) = (above as f64 / n, (above + cells) as f64 / n);
        if above > 0 {
            lines.push([[0.0, top], [1.0, top]]);
        }
        for i in 1..cells {
            let x = i as f64 / cells as f64;
            lines.push([[x, top], [x, bottom]]);
        }
        above += cells;
    }
    lines
}
