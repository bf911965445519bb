//! The arrangement of lines in a sub-pixel whose boundaries are all straight.
//!
//! In: the lines that pass through a sub-pixel, limited in number by `mod`. Out: the convex cells
//! of the sub-pixel, which are added to [`Regions`], each with a point inside. Each line cuts the
//! cells of the lines before it. The bound counts the error of each line times its length, and the
//! area of all cells that are too small to determine their colour.

use std::mem;

use glam::DVec2;

use crate::{math::Real, tracer::BoundaryLine};

use super::{
    clip::{PIXEL, measure, split},
    region::{Region, Regions, Shares},
};

/// Area, in square pixels, below which the colour of a cell is not certain, because the point whose
/// colour is determined might lie outside the cell. Smaller cells are not cut either: slivers that
/// exist only by rounding would double in number with each line. A polygon of 2⁻⁴⁶ square pixels
/// has sides about 10⁹ roundings long.
const MIN_AREA: f64 = 1.0 / (1u64 << 46) as f64;

/// Maximum area of a polygon that a line does not cut, divided by n·|h|, where h is the mean of the
/// line's form over the n vertices. The values at the vertices have the same sign, so that each is
/// at most n·|h|. Each vertex is therefore at most 2n·|h| from the line, because the larger factor
/// of the form is at least 1/2. The polygon is at most √2 long.
const MAX_AREA_PER_HEIGHT: f64 = 3.0;

/// Maximum value of a line's form at a vertex that roundings can put on the wrong side of the line.
/// The form has four roundings of terms that are at most 2, and its larger factor is about 1.
const ROUNDING: f64 = 8.0 * f64::UNIT;

/// Returns the shares of the colours in a sub-pixel that lines cut.
pub fn shares(lines: &[BoundaryLine], mut regions: Regions) -> Shares {
    let mut polygons = vec![PIXEL.to_vec()];
    let mut worst = 0.0_f64;
    for line in lines {
        let rad = line.rad + ROUNDING;
        worst = worst.max(rad);
        // The true line is within 2·`rad` of the computed one, because the larger factor is at
        // least 1/2; the line is at most √2 long in the pixel. The rounding of vertices on both
        // sides of it is included.
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
        // If the point is close to a line, it may lie on the wrong side, and so may the whole
        // polygon.
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

/// Cuts a convex polygon along a line. Returns both parts, or the polygon itself if it lies on one
/// side.
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
