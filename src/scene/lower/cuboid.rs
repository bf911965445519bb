//! Boxes, by centre and size or by two corners.

use super::{Block, Given, Lowering, fields::Fields};
use crate::{
    math::predicates,
    numbers,
    scene::{self, Shape, error::error},
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
            self.problems.push(
                error("box_too_large", "the box reaches beyond the largest number")
                    .at(span("center"), "center ± size/2 is not finite")
                    .help("make it smaller, or move it nearer"),
            );
            return None;
        }
        if let Some(&(axis, low, high)) = axes.iter().find(|(_, low, high)| low >= high) {
            let (low, high) = (numbers::beside(low, &[high]), numbers::beside(high, &[low]));
            let problem = error("empty_box", format!("the box has no extent along {axis}"));
            let problem = match (block.given("min"), block.given("max")) {
                (Some(low_given), Some(high_given)) => problem
                    .at(high_given.span, format!("{high} along {axis}"))
                    .at(low_given.span, format!("{low} along {axis}"))
                    .help("make `max` greater than `min` on every axis")
                    .fixes(self.in_order([low_given, high_given], [min, max])),
                _ => problem
                    .at(
                        block.given("size").map_or(span("center"), |g| g.span),
                        format!("lost in rounding beside {low}"),
                    )
                    .help("make it larger: so far from the origin, a number has no digits left for its size"),
            };
            self.problems.push(problem);
            return None;
        }
        Some(Shape::Box(scene::Cuboid {
            min,
            max,
            color: color?,
        }))
    }
}
