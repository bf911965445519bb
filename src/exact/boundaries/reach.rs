//! A convex part of a sub-pixel in which all rays are that meet an object: where two objects cross each other matters only in both their parts.
//!
//! In: the lines of an outline. Out: a convex polygon, cut by them from the sub-pixel (Sutherland and Hodgman, 1974). Errors: each line is moved
//! outwards by its own and by [`MARGIN`].

use glam::DVec2;

use crate::{
    exact::clip::{PIXEL, split},
    math::{Real, UP},
    tracer::{Curve, Line},
};

/// A value of a line's form counts as negative only if it is below −(error + this). That is much more than all roundings
/// of a polygon's vertices come to: each lies on a side that is cut to within a few of them, and no form's slopes are greater than 2.
const MARGIN: f64 = 4096.0 * f64::UNIT;

/// A part of a sub-pixel in which all the rays are that meet an object.
#[derive(Debug)]
pub(super) struct Reach {
    /// A convex polygon, its vertices in order.
    polygon: Vec<DVec2>,
    /// The lines that cut it from the sub-pixel: their forms are not negative where the object is met.
    sides: Vec<Line>,
}

impl Reach {
    /// All of the sub-pixel.
    pub fn whole() -> Self {
        Self {
            polygon: PIXEL.to_vec(),
            sides: Vec::new(),
        }
    }

    /// What the lines of an outline leave of the sub-pixel. The forms of all of them are positive inside.
    pub fn within(outline: Vec<Curve>) -> Self {
        let mut reach = Self::whole();
        for curve in outline {
            if let Curve::Line(line) = curve {
                let is_all_inside = line.over_pixel().low > 0.0;
                if !is_all_inside {
                    reach.polygon = cut(&reach.polygon, &line);
                    reach.sides.push(line);
                }
            }
        }
        reach
    }

    /// Whether no ray meets both this object and another one.
    pub fn is_apart(&self, other: &Self) -> bool {
        let excludes = |a: &Self, b: &Self| {
            let excludes = |line: &Line| b.polygon.iter().all(|at| at_most(line, *at) < 0.0);
            a.polygon.is_empty() || a.sides.iter().any(excludes)
        };
        excludes(self, other) || excludes(other, self)
    }

    /// Whether a line may pass where the object is met.
    pub fn is_crossed_by(&self, line: &Line) -> bool {
        let opposite = Line {
            factors: line.factors.map(|factor| -factor),
            ..*line
        };
        ![line, &opposite].into_iter().any(|line| {
            let mut vertices = self.polygon.iter();
            vertices.all(|at| at_most(line, *at) < 0.0)
        })
    }
}

/// The part of a polygon where a form may not be negative. NaN leaves all of it.
fn cut(polygon: &[DVec2], line: &Line) -> Vec<DVec2> {
    let form = |at| {
        let most = at_most(line, at);
        if most.is_nan() { 0.0 } else { most }
    };
    let mut part = Vec::with_capacity(polygon.len() + 1);
    split(polygon, form, &mut Vec::new(), &mut part);
    part
}

/// The form's value at a point, and as much more as may be missing: it is negative where the true one is for certain.
fn at_most(line: &Line, at: DVec2) -> f64 {
    let [a, b, c] = line.factors;
    a * at.x + b * at.y + c + (line.rad * UP + MARGIN)
}
