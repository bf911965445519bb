//! The arrangement of lines in pixels whose boundaries are all straight.
//!
//! In: the lines that pass through a sub-pixel, limited in number by `mod`. Out: the convex cells
//! of the sub-pixel, which are added to [`Regions`] with a point inside each. Each line cuts the
//! cells of the lines before it. The bound counts the error of each line times its length, and all
//! cells that are too small to determine their colour.

use std::mem;

use glam::DVec2;

use crate::{math::Real, tracer::BoundaryLine};

use super::{
    clip::{PIXEL, measure, split},
    region::{Region, Regions, Shares},
};

/// Area, in square pixels, below which a cell's colour is not certain, because the point that is
/// asked might lie outside. Smaller cells are not cut either, since slivers made of roundings would
/// double with each line. A polygon of 2⁻⁴⁶ square pixels has sides about 10⁹ roundings long.
const MIN_AREA: f64 = 1.0 / (1u64 << 46) as f64;

/// Maximum area of an uncut polygon divided by n·|h|, where h is the mean of the line's form over
/// its n vertices. Each value is at most n·|h|, so each vertex is at most 2n·|h| from the line,
/// because the greater slope is at least 1/2; and the polygon is at most √2 long.
const MAX_AREA_PER_HEIGHT: f64 = 3.0;

/// Maximum value of a line's form that the roundings of a vertex can produce on the wrong side. The
/// form has four roundings of terms that are at most 2, and its greater slope is about 1.
const ROUNDING: f64 = 8.0 * f64::UNIT;

/// Returns the shares of a sub-pixel that is cut by lines.
pub fn shares(lines: &[BoundaryLine], mut regions: Regions) -> Shares {
    let mut polygons = vec![PIXEL.to_vec()];
    let mut worst = 0.0_f64;
    for line in lines {
        let rad = line.rad + ROUNDING;
        worst = worst.max(rad);
        // The true line is within 2·rad of the computed one, because the greater slope is at least
        // 1/2, along at most √2; and vertices on both sides of it are rounded.
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
        // Close to a line, the point may lie on the wrong side of it, and then all of the polygon
        // may.
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

/// Cuts a convex polygon along a line, unless it lies on one side.
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
