//! The shape `triangle`. This file builds it from its block, gives access to its fields, computes
//! its extent, and describes it.

use glam::DVec3;

use crate::{
    color::Color,
    diagnostic::Problems,
    math::{Angle, predicates},
    numbers::{self, short, short_vector},
    scene::{error::error, lowered_block::LoweredBlock},
    schema::{FieldValue, TRIANGLE, TriangleFields},
};

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// The vertices.
    pub outline: TriangleOutline,
    /// The colour.
    pub color: Color,
}

/// Vertices of a triangle, in either of the language's two forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TriangleOutline {
    /// The vertices themselves. They do not lie on one line.
    Vertices([DVec3; 3]),
    /// Centroid, normal, sides and spin.
    Centered(CenteredTriangle),
}

/// A triangle that is given by centroid, normal, sides and spin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CenteredTriangle {
    /// The mean of the vertices.
    pub centroid: DVec3,
    /// The normal, not zero, of any length.
    pub normal: DVec3,
    /// Lengths (a, b, c) of the sides in metres; c is the base. They satisfy the triangle
    /// inequality.
    pub sides: DVec3,
    /// Rotation in the triangle's plane about the centroid, counter-clockwise as seen from the tip
    /// of the normal.
    pub spin: Angle,
}

impl TriangleOutline {
    /// Returns the mean of the vertices, with rounding errors.
    pub fn centroid(&self) -> DVec3 {
        match self {
            // Each vertex is divided first, so that the sum does not overflow.
            Self::Vertices(vertices) => vertices.iter().map(|vertex| *vertex / 3.0).sum(),
            Self::Centered(centered) => centered.centroid,
        }
    }
}

impl Triangle {
    pub(super) fn lower(block: &LoweredBlock<'_>, problems: &mut Problems) -> Option<Self> {
        let TriangleFields {
            centroid,
            normal,
            sides,
            spin,
            v0,
            v1,
            v2,
            color,
        } = TRIANGLE;
        let outline = if [v0, v1, v2].iter().any(|it| block.given(*it).is_some()) {
            let vertices = [block.value(v0)?, block.value(v1)?, block.value(v2)?];
            if predicates::are_on_one_line(vertices) {
                on_one_line(block, problems);
                return None;
            }
            TriangleOutline::Vertices(vertices)
        } else {
            let lengths = block.value(sides)?;
            if !predicates::forms_triangle(lengths.to_array()) {
                not_a_triangle(block, lengths, problems);
                return None;
            }
            TriangleOutline::Centered(CenteredTriangle {
                centroid: block.value(centroid)?,
                normal: block.value(normal)?,
                sides: lengths,
                spin: block.value(spin)?,
            })
        };
        Some(Self {
            outline,
            color: block.value(color)?,
        })
    }

    pub(super) fn field_mut(&mut self, name: &str) -> Option<&mut dyn FieldValue> {
        let field = TRIANGLE.color.of(name, &mut self.color);
        match &mut self.outline {
            TriangleOutline::Vertices([v0, v1, v2]) => {
                let field = field.or(TRIANGLE.v0.of(name, v0));
                field
                    .or(TRIANGLE.v1.of(name, v1))
                    .or(TRIANGLE.v2.of(name, v2))
            }
            TriangleOutline::Centered(own) => {
                let field = field.or(TRIANGLE.centroid.of(name, &mut own.centroid));
                let field = field.or(TRIANGLE.normal.of(name, &mut own.normal));
                let field = field.or(TRIANGLE.sides.of(name, &mut own.sides));
                field.or(TRIANGLE.spin.of(name, &mut own.spin))
            }
        }
    }

    pub(super) fn is_possible(&self) -> bool {
        match self.outline {
            TriangleOutline::Vertices([a, b, c]) => (b - a).cross(c - a).length_squared() > 0.0,
            TriangleOutline::Centered(own) => {
                let [a, b, c] = own.sides.to_array();
                let is_triangle = a < b + c && b < a + c && c < a + b;
                own.normal.length_squared() > 0.0 && is_triangle && own.centroid.is_finite()
            }
        }
    }

    pub(super) fn colors(&self) -> [Color; 3] {
        [self.color; 3]
    }

    pub(super) fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        let centroid = self.outline.centroid();
        let radius = match self.outline {
            TriangleOutline::Vertices(vertices) => {
                let distances = vertices.map(|vertex| vertex.distance(centroid));
                distances.into_iter().fold(0.0, f64::max)
            }
            // The distance from the centroid to a vertex is at most the length of the longest side,
            // so a sphere of this radius contains the triangle.
            TriangleOutline::Centered(triangle) => triangle.sides.max_element(),
        };
        Some((centroid, radius))
    }

    pub(super) fn greatest_length(&self, from: DVec3) -> f64 {
        let far = |point: DVec3| (point - from).abs().max_element();
        match self.outline {
            TriangleOutline::Vertices(vertices) => {
                vertices.map(far).into_iter().fold(0.0, f64::max)
            }
            TriangleOutline::Centered(own) => far(own.centroid).max(own.sides.max_element()),
        }
    }

    pub(super) fn summary(&self, vertices: [DVec3; 3]) -> String {
        let ([a, b, c], color) = (vertices.map(short_vector), self.color);
        match self.outline {
            TriangleOutline::Centered(_) => format!("base {a} to {b}, apex {c}, {color}"),
            TriangleOutline::Vertices(_) => format!("vertices {a}, {b}, {c}, {color}"),
        }
    }
}

fn on_one_line(block: &LoweredBlock<'_>, problems: &mut Problems) {
    let message = "the vertices lie on one line, and form no triangle";
    error("on_one_line", message)
        .at(block.place(TRIANGLE.v2), "the third vertex")
        .at(block.place(TRIANGLE.v1), "the second")
        .at(block.place(TRIANGLE.v0), "the first")
        .help("move one of them, so that the three points are the corners of a triangle")
        .report(problems);
}

fn not_a_triangle(block: &LoweredBlock<'_>, sides: DVec3, problems: &mut Problems) {
    let [a, b, c] = sides.to_array();
    let (place, longest, one, other) = if a >= b && a >= c {
        ("first", a, b, c)
    } else if b >= c {
        ("second", b, a, c)
    } else {
        ("third", c, a, b)
    };
    let [a, b, c] = [a, b, c].map(short);
    let longest = numbers::comparable(longest, &[one + other]);
    let [one, other] = [one, other].map(short);
    let message = format!("sides of {a}, {b} and {c} do not form a triangle");
    let label = format!("{longest} is not less than {one} + {other}");
    let help = format!(
        "make the {place} side shorter than the two others together, or each of them longer"
    );
    error("not_a_triangle", message)
        .at(block.place(TRIANGLE.sides), label)
        .help(help)
        .report(problems);
}
