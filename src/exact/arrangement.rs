//! Divides a sub-pixel (a pixel or a square part of one) into convex cells if its boundaries are
//! all straight lines.
//!
//! In: the lines that pass through the sub-pixel. Out: the cells, each with a point inside, added
//! to [`Regions`]. The sub-pixel starts as one cell; each line in turn cuts the cells that it
//! crosses. The error bound includes the area whose colour is uncertain: a strip along each line,
//! as wide as the line's position error, and each cell that is too small or too thin.

use std::mem;

use glam::DVec2;

use crate::{math::Real, tracer::BoundaryLine};

use super::{
    clip::{PIXEL, measure, split},
    region::{Region, Regions, Shares},
};

/// Minimum area of a cell, a polygon between lines, in square pixels. A smaller cell is not cut any
/// further. Rounding can create tiny cells that do not exist in exact arithmetic, and each further
/// line could double their number. The whole area of such a cell is added to the error bound. The
/// point at which its colour is determined may lie outside the cell because of rounding. A square
/// of this area has sides of 2⁻²³ pixels, about 10⁹ unit roundoffs.
const MIN_AREA: f64 = 1.0 / (1u64 << 46) as f64;

/// Factor k of the area limit k·n·e of a cell, a polygon between lines. If the area, in square
/// pixels, is larger, the cell's centre is certainly on the correct side of each line. Here, n is
/// the number of the cell's vertices, and e is the maximum error of a value of a line's form a·x +
/// b·y + c.
///
/// Derivation: the form has the same sign at all vertices, and its value at the centre is the mean
/// of its values at the vertices. If the centre may be on the wrong side, the absolute value there
/// is at most e, so the absolute values at the vertices are at most n·e. All vertices are then
/// within 2n·e of the line, because the larger of |a| and |b| is at least 1/2. The cell is at most
/// √2 long, so that its area is at most 2·√2·n·e, and 2·√2 < 3.
const MAX_AREA_PER_HEIGHT: f64 = 3.0;

/// Maximum rounding error of the form a·x + b·y + c of a line at a vertex. If the absolute value of
/// the form is not larger, its sign is uncertain. The form is computed with four roundings of terms
/// that are at most 2, because the larger of |a| and |b| is about 1.
const ROUNDING: f64 = 8.0 * f64::UNIT;

/// Returns the fraction of a sub-pixel's area that shows each colour. `lines` cut the sub-pixel
/// into cells, and `regions` collects the cells.
pub fn shares(lines: &[BoundaryLine], mut regions: Regions) -> Shares {
    let mut polygons = vec![PIXEL.to_vec()];
    let mut worst = 0.0_f64;
    for line in lines {
        let rad = line.rad + ROUNDING;
        worst = worst.max(rad);
        // `rad` is the maximum error of a·x + b·y + c, the form of the line, at a vertex. The
        // larger of |a| and |b| is at least 1/2, so the true line is within 2·`rad` of the computed
        // line. The line is at most √2 long in the pixel. The area between the true and the
        // computed line is therefore at most 2·√2·`rad`, which is less than 3·`rad`.
        regions.add_doubtful_area(3.0 * rad);
        for polygon in mem::take(&mut polygons) {
            if regions.budget.is_spent() {
                return regions.finish();
            }
            if area(&polygon) < MIN_AREA {
                polygons.push(polygon)
            } else {
                polygons.extend(cut(polygon, line))
            }
        }
    }
    for polygon in &polygons {
        if regions.budget.is_spent() {
            return regions.finish();
        }
        let area = area(polygon);
        let inside = center(polygon);
        // The cell's colour is determined at the point `inside`. If this point is close to a line,
        // it or the whole cell may be on the wrong side of the line because of rounding. The cell's
        // colour is then uncertain.
        let may_be_thin = || area <= MAX_AREA_PER_HEIGHT * polygon.len() as f64 * worst;
        let is_near_line = || {
            lines
                .iter()
                .any(|line| height(line, &inside).abs() <= line.rad + ROUNDING)
        };
        if area < MIN_AREA || (may_be_thin() && is_near_line()) {
            regions.add_doubtful_area(area);
        }
        if area > 0.0 {
            regions.add(&Region {
                polygon,
                arcs: &[],
                area,
                inside,
            });
        }
    }
    regions.finish()
}

/// Cuts a convex polygon along a line. Returns the two parts, or only the polygon itself if it lies
/// on one side of the line.
fn cut(polygon: Vec<DVec2>, line: &BoundaryLine) -> Vec<Vec<DVec2>> {
    let heights = || polygon.iter().map(|p| height(line, p));
    if heights().all(|h| h >= 0.0) || heights().all(|h| h <= 0.0) {
        return vec![polygon];
    }
    let [mut below, mut above] = [0; 2].map(|_| Vec::with_capacity(polygon.len() + 1));
    split(&polygon, |p| height(line, &p), &mut below, &mut above);
    vec![below, above]
}

fn height(line: &BoundaryLine, p: &DVec2) -> f64 {
    let [a, b, c] = line.factors;
    a * p.x + b * p.y + c
}

fn area(polygon: &[DVec2]) -> f64 {
    measure(polygon).0.abs()
}

fn center(polygon: &[DVec2]) -> DVec2 {
    polygon.iter().sum::<DVec2>() / polygon.len() as f64
}

#[cfg(test)]
mod tests;
