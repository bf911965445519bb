//! Boxes, by centre and size or by two corners.

use super::{Block, Given, Lowering, fields::Fields};
use crate::{
    math::predicates,
    numbers,
    scene::{self, Shape, error::Problem},
};

impl<'s> Lowering<'s> {
    pub(super) fn cuboid(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Shape> {
        let corners = block.given("min").or(block.given("max"));
        let (min, max) = match corners {
            Some(_) => (fields.vector("min"), fields.vector("max")),
            None => match (fields.vector("center"), fields.vector("size")) {
                (Some(center), Some(size)) => {
                    let (min, max) = predicates::box_corners(center, size);
                    (Some(min), Some(max))
                }
                _ => (None, None),
            },
        };
        let color = fields.color("color");
        let (min, max) = (min?, max?);
        let axes = [
            ("x", min.x, max.x),
            ("y", min.y, max.y),
            ("z", min.z, max.z),
        ];
        let span = |name| block.given(name).map_or(block.keyword, |g: Given| g.span);
        if !min.is_finite() || !max.is_finite() {
            let span = span("center");
            self.problems.push(Problem::BoxTooLarge { span });
            return None;
        }
        if let Some(&(axis, low, high)) = axes.iter().find(|(_, low, high)| low >= high) {
            let (low, high) = (numbers::beside(low, &[high]), numbers::beside(high, &[low]));
            let given = (block.given("min"), block.given("max"));
            self.problems.push(match given {
                (Some(low_given), Some(high_given)) => {
                    let is_greater = axes.map(|(_, low, high)| low > high);
                    let (one, other) = (min.min(max), min.max(max));
                    let can_be_swapped = axes.iter().all(|(_, low, high)| low != high)
                        && (low_given.parts.and(high_given.parts).is_some() || is_greater == [true; 3]);
                    Problem::EmptyBox {
                        axis,
                        help: match can_be_swapped {
                            true => format!(
                                "write the corners in order: `min {}  max {}`",
                                numbers::short_vector(one),
                                numbers::short_vector(other)
                            ),
                            false => format!("make `max` greater than `min` on every axis; along {axis} they are {high} and {low}"),
                        },
                        span: high_given.span,
                        label: format!("{high} along {axis}"),
                        other: Some(low_given.span),
                        other_label: format!("{low} along {axis}"),
                    }.with(match can_be_swapped {
                            true => vec![self.in_order([low_given, high_given], is_greater)],
                            false => Vec::new(),
                        })
                }
                _ => Problem::EmptyBox {
                    axis,
                    help: "make it larger: so far from the origin, a number has no digits left for its size".to_owned(),
                    span: block.given("size").map_or(span("center"), |g| g.span),
                    label: format!("lost in rounding beside {low}"),
                    other: None,
                    other_label: String::new(),
                }.into(),
            });
            return None;
        }
        Some(Shape::Box(scene::Cuboid {
            min,
            max,
            color: color?,
        }))
    }
}
