//! Triangles, by their vertices or by centroid, normal and sides.

use super::{Block, Lowering, fields::Fields};
use crate::{
    math::predicates,
    numbers,
    scene::{self, CenteredTriangle, Outline, Shape, error::Problem},
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
        let [a, b, c] = vertices;
        let equal = [
            ("v1", "v0", a == b),
            ("v2", "v0", a == c),
            ("v2", "v1", b == c),
        ];
        let equal = equal.into_iter().find(|(.., are_equal)| *are_equal);
        let [first, second, third] =
            VERTICES.map(|name| block.given(name).map_or(block.keyword, |given| given.span));
        self.problems.push(Problem::OnOneLine {
            message: match equal {
                Some((one, other, _)) => format!("`{one}` and `{other}` are the same point"),
                None => "the vertices lie on one line, and form no triangle".to_owned(),
            },
            span: third,
            second,
            first,
        });
        None
    }

    fn centered(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Outline> {
        let sides = fields.vector("sides")?;
        if !predicates::forms_triangle(sides.to_array()) {
            let [a, b, c] = sides.to_array();
            let (longest, [one, other], place) = if a >= b && a >= c {
                (a, [b, c], "first")
            } else if b >= c {
                (b, [a, c], "second")
            } else {
                (c, [a, b], "third")
            };
            let long = numbers::beside(longest, &[one + other, one, other]);
            let [one, other] = [(one, other), (other, one)]
                .map(|(x, y)| (x, numbers::beside(x, &[longest - y, longest])));
            let shown = |x: f64| match x {
                x if x == longest => long.clone(),
                x if x == one.0 => one.1.clone(),
                _ => other.1.clone(),
            };
            self.problems.push(Problem::NotATriangle {
                a: shown(a),
                b: shown(b),
                c: shown(c),
                help: format!(
                    "make the {place} side shorter than the two others together, or each of them longer"
                ),
                span: block.given("sides").map_or(block.keyword, |given| given.span),
                label: format!("{long} is not less than {} + {}", one.1, other.1),
            });
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
