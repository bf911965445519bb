//! Triangles, by their vertices or by centroid, normal and sides.

use super::{Block, Lowering, fields::Fields};
use crate::{
    math::predicates,
    numbers,
    scene::{self, CenteredTriangle, Outline, Shape, error::error},
};

const VERTICES: [&str; 3] = ["v0", "v1", "v2"];

impl<'s> Lowering<'s> {
    pub(super) fn triangle(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Shape> {
        let is_given = |name: &&str| block.given(name).is_some();
        let outline = match VERTICES.iter().any(is_given) {
            true => self.vertices(block, fields)?,
            false => self.centered(block, fields)?,
        };
        Some(Shape::Triangle(scene::Triangle {
            outline,
            color: fields.color("color")?,
        }))
    }

    fn vertices(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Outline> {
        let [a, b, c] = VERTICES.map(|name| fields.vector(name));
        let vertices = [a?, b?, c?];
        if !predicates::are_on_one_line(vertices) {
            return Some(Outline::Vertices(vertices));
        }
        let help = "move one of them, so that the three points are the corners of a triangle";
        let [first, second, third] =
            VERTICES.map(|name| block.given(name).map_or(block.keyword, |given| given.span));
        self.problems.push(
            error(
                "on_one_line",
                "the vertices lie on one line, and form no triangle",
            )
            .at(third, "the third vertex")
            .at(second, "the second")
            .at(first, "the first")
            .help(help),
        );
        None
    }

    fn centered(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Outline> {
        let sides = fields.vector("sides")?;
        if !predicates::forms_triangle(sides.to_array()) {
            let [a, b, c] = sides.to_array();
            let (place, longest, one, other) = if a >= b && a >= c {
                ("first", a, b, c)
            } else if b >= c {
                ("second", b, a, c)
            } else {
                ("third", c, a, b)
            };
            let [a, b, c] = [a, b, c].map(numbers::short);
            let longest = numbers::beside(longest, &[one + other]);
            let [one, other] = [one, other].map(numbers::short);
            let span = block
                .given("sides")
                .map_or(block.keyword, |given| given.span);
            let message = format!("sides of {a}, {b} and {c} do not form a triangle");
            let help = format!(
                "make the {place} side shorter than the two others together, or each of them longer"
            );
            self.problems.push(
                error("not_a_triangle", message)
                    .at(span, format!("{longest} is not less than {one} + {other}"))
                    .help(help),
            );
            return None;
        }
        Some(Outline::Centered(CenteredTriangle {
            centroid: fields.vector("centroid")?,
            normal: fields.vector("normal")?,
            sides,
            spin: fields.angle("spin")?,
        }))
    }
}
