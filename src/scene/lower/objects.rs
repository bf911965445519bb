//! Objects, once all fields have their values.

use super::{block::Block, lowering::Lowering};
use crate::{
    diagnostic::{Edit, Fix},
    math::predicates,
    numbers,
    scene::{
        error::error,
        model::{CenteredTriangle, Checkerboard, Cuboid, Object, Outline, Shape, Sphere, Triangle},
    },
    schema::Kind,
};

const VERTICES: [&str; 3] = ["v0", "v1", "v2"];

impl<'s> Lowering<'s> {
    /// Builds an object, with its place among those of its block. Answers whether that could be
    /// done: not if a value is missing or failed.
    pub(super) fn object(&mut self, block: &Block<'s>, indices: &[u32]) -> bool {
        let Some(shape) = self.shape(block) else {
            return false;
        };
        if let Shape::Checkerboard(board) = shape {
            self.boards.push((board, block.place("square")));
        }
        let name = block.name.map(|name| match indices {
            [] => name.text.to_owned(),
            _ => format!("{}[{}]", name.text, listed(indices)),
        });
        self.objects.push(Object {
            name,
            indices: indices.into(),
            shape,
            span: block.span,
        });
        true
    }

    /// What it is; none if a value is missing or failed.
    pub(super) fn shape(&mut self, block: &Block<'s>) -> Option<Shape> {
        Some(match block.row.kind {
            Kind::Sphere => Shape::Sphere(Sphere {
                center: block.vector("center")?,
                radius: block.number("radius")?,
                color: block.color("color")?,
            }),
            Kind::Triangle => Shape::Triangle(Triangle {
                outline: match VERTICES.iter().any(|name| block.given(name).is_some()) {
                    true => self.vertices(block)?,
                    false => self.centered(block)?,
                },
                color: block.color("color")?,
            }),
            Kind::Box => self.cuboid(block)?,
            Kind::Checkerboard => Shape::Checkerboard(Checkerboard {
                y: block.number("y")?,
                square: block.number("square")?,
                colors: block.colors("colors")?,
            }),
            Kind::Image | Kind::Camera | Kind::Sampler => return None,
        })
    }

    fn vertices(&mut self, block: &Block<'s>) -> Option<Outline> {
        let [a, b, c] = VERTICES.map(|name| block.vector(name));
        let vertices = [a?, b?, c?];
        if !predicates::are_on_one_line(vertices) {
            return Some(Outline::Vertices(vertices));
        }
        let message = "the vertices lie on one line, and form no triangle";
        self.problems.push(
            error("on_one_line", message)
                .at(block.place("v2"), "the third vertex")
                .at(block.place("v1"), "the second")
                .at(block.place("v0"), "the first")
                .help("move one of them, so that the three points are the corners of a triangle"),
        );
        None
    }

    fn centered(&mut self, block: &Block<'s>) -> Option<Outline> {
        let sides = block.vector("sides")?;
        if predicates::forms_triangle(sides.to_array()) {
            return Some(Outline::Centered(CenteredTriangle {
                centroid: block.vector("centroid")?,
                normal: block.vector("normal")?,
                sides,
                spin: block.angle("spin")?,
            }));
        }
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
        let message = format!("sides of {a}, {b} and {c} do not form a triangle");
        let help = format!(
            "make the {place} side shorter than the two others together, or each of them longer"
        );
        self.problems.push(
            error("not_a_triangle", message)
                .at(
                    block.place("sides"),
                    format!("{longest} is not less than {one} + {other}"),
                )
                .help(help),
        );
        None
    }

    fn cuboid(&mut self, block: &Block<'s>) -> Option<Shape> {
        let (min, max) = match block.given("min").or(block.given("max")) {
            Some(_) => (block.vector("min")?, block.vector("max")?),
            None => predicates::box_corners(block.vector("center")?, block.vector("size")?),
        };
        if !min.is_finite() || !max.is_finite() {
            self.problems.push(
                error("box_too_large", "the box reaches beyond the largest number")
                    .at(block.place("center"), "center ± size/2 is not finite")
                    .help("make it smaller, or move it nearer"),
            );
            return None;
        }
        let axes = ["x", "y", "z"]
            .into_iter()
            .zip(min.to_array())
            .zip(max.to_array());
        let mut empty = axes.filter(|((_, low), high)| low >= high);
        let Some(((axis, low), high)) = empty.next() else {
            return Some(Shape::Box(Cuboid {
                min,
                max,
                color: block.color("color")?,
                faces: match block.given("colors") {
                    Some(_) => Some(block.face_colors("colors")?),
                    None => None,
                },
            }));
        };
        let (low, high) = (numbers::beside(low, &[high]), numbers::beside(high, &[low]));
        let problem = error("empty_box", format!("the box has no extent along {axis}"));
        self.problems.push(match (block.given("min"), block.given("max")) {
            (Some(low_given), Some(high_given)) => {
                // Where they are equal on an axis, their order does not help.
                let in_order = min.cmpne(max).all().then(|| {
                    let corners = [(low_given, min.min(max)), (high_given, min.max(max))];
                    let edits = corners.map(|(given, corner)| Edit::new(given.span, exactly(corner)));
                    Fix::new("put the corners in order", edits)
                });
                problem
                    .at(high_given.span, format!("{high} along {axis}"))
                    .at(low_given.span, format!("{low} along {axis}"))
                    .help("make `max` greater than `min` on every axis")
                    .fixes(in_order)
            }
            _ => {
                let size = block.given("size").map_or(block.place("center"), |given| given.span);
                problem
                    .at(size, format!("lost in rounding beside {low}"))
                    .help("make it larger: so far from the origin, a number has no digits left for its size")
            }
        });
        None
    }
}

fn listed(indices: &[u32]) -> String {
    indices
        .iter()
        .map(u32::to_string)
        .collect::<Vec<_>>()
        .join(", ")
}

/// A vector with all its digits.
fn exactly(vector: glam::DVec3) -> String {
    let [x, y, z] = vector.to_array();
    format!("({x}, {y}, {z})")
}
