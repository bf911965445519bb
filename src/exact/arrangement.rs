//! Pixels whose boundaries are all straight: the arrangement of their lines.
//!
//! In: the lines that pass through a sub-pixel, at most as many as `mod` allows. Out: the
//! sub-pixel's convex cells, which are told to [`Regions`] with a point in each. Each line cuts the
//! cells that the lines before it left. The bound adds how far each line may be from the true one,
//! times its length, and cells too small to be asked for their colour.

use std::mem;

use glam::DVec2;

use crate::{math::Real, tracer::BoundaryLine};

use super::{
    clip::{PIXEL, measure, split},
    region::{Region, Regions, Shares},
};

/// A polygon of less area than this is not asked for its colour: the point to ask at might not lie
/// in it. Nor is it cut: slivers that are made of roundings would double with each line. 2⁻⁴⁶
/// square pixels are a polygon whose sides are some 10⁹ roundings long.
const SPECK: f64 = 1.0 / (1u64 << 46) as f64;

/// If h is the mean of a line's form over the n vertices of a polygon that the line does not cut,
/// the polygon has no more area than this times n·|h|: each value is at most n·|h|, so each vertex
/// is at most 2n·|h| from the line, as the greater slope is at least 1/2; and the polygon is no
/// longer than √2.
const WIDE: f64 = 3.0;

/// How far the roundings of a vertex may move it across its line: the form's value has four, of
/// terms that are 2 at most, and its greater slope is about 1.
const ROUNDING: f64 = 8.0 * f64::UNIT;

/// The shares of a pixel that is cut by some lines.
pub fn shares(lines: &[BoundaryLine], mut regions: Regions) -> Shares {
    let mut polygons = vec![PIXEL.to_vec()];
    let mut worst = 0.0_f64;
    for line in lines {
        let rad = line.rad + ROUNDING;
        worst = worst.max(rad);
        // The true line is within 2 rad of the computed one, the greater of whose slopes is at
        // least 1/2, over a length of at most √2; and on both sides of it vertices are
        // rounded.
        regions.doubt(3.0 * rad);
        for polygon in mem::take(&mut polygons) {
            if regions.is_given_up() {
                return regions.finish();
            }
            match area(&polygon) < SPECK {
                true => polygons.push(polygon),
                false => polygons.extend(cut(polygon, line)),
            }
        }
    }
    for polygon in &polygons {
        if regions.is_given_up() {
            return regions.finish();
        }
        let area = area(polygon);
        let inside = middle(polygon);
        // Next to a line the point may lie on the wrong side of it: then all of the polygon may.
        let is_low = || area <= WIDE * polygon.len() as f64 * worst;
        let is_beside = || {
            lines
                .iter()
                .any(|line| height(line, &inside).abs() <= line.rad + ROUNDING)
        };
        if area < SPECK || (is_low() && is_beside()) {
            regions.doubt(area);
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

/// The parts of a convex polygon on both sides of a line.
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

fn middle(polygon: &[DVec2]) -> DVec2 {
    polygon.iter().sum::<DVec2>() / polygon.len() as f64
}
