//! The shape `box`. This file builds it from its block, gives access to its fields, computes its
//! extent, and describes it.

use glam::DVec3;

use crate::{
    color::Color,
    diagnostic::{Edit, Fix, Problems},
    math::predicates,
    numbers::{self, short_vector},
    scene::{error::error, lowered_block::LoweredBlock},
    schema::{BOX, BoxFields, FieldValue},
};

/// A closed, axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// The corner of least coordinates.
    pub min: DVec3,
    /// The corner of greatest coordinates, > min on every axis.
    pub max: DVec3,
    /// The colour, unless the faces have colours of their own.
    pub color: Color,
    /// The colours of the faces perpendicular to x, y and z. `None` if all faces have the colour
    /// `color`.
    pub faces: Option<[Color; 3]>,
}

impl Cuboid {
    pub(super) fn lower(block: &LoweredBlock<'_>, problems: &mut Problems) -> Option<Self> {
        let BoxFields {
            center,
            size,
            min,
            max,
            color,
            colors,
        } = BOX;
        let (min, max) = if block.given(min).or(block.given(max)).is_some() {
            (block.value(min)?, block.value(max)?)
        } else {
            predicates::box_corners(block.value(center)?, block.value(size)?)
        };
        if !min.is_finite() || !max.is_finite() {
            error("box_too_large", "the box reaches beyond the largest number")
                .at(block.place(center), "center ± size/2 is not finite")
                .help("make it smaller, or move it nearer")
                .report(problems);
            return None;
        }
        if min.cmpge(max).any() {
            empty(block, min, max, problems);
            return None;
        }
        Some(Self {
            min,
            max,
            color: block.value(color)?,
            faces: match block.given(colors) {
                Some(_) => Some(block.value(colors)?),
                None => None,
            },
        })
    }

    /// Returns the value of the field `name` if this is `center` or `size`, and otherwise `None`.
    /// The value is computed from the corners, which causes rounding errors. It is rounded to
    /// fifteen digits to remove them.
    pub(in crate::scene) fn center_or_size(&self, name: &str) -> Option<DVec3> {
        if name == BOX.center.name {
            Some(tidy(self.min.midpoint(self.max)))
        } else if name == BOX.size.name {
            Some(tidy(self.max - self.min))
        } else {
            None
        }
    }

    /// Sets the field `name` of the box, `center` or `size`, to the value `to` by changing the
    /// corners. Returns `false` and changes nothing if `name` is another field.
    pub(in crate::scene) fn set_center_or_size(&mut self, name: &str, to: DVec3) -> bool {
        let (center, half) = if name == BOX.center.name {
            (to, (self.max - self.min) / 2.0)
        } else if name == BOX.size.name {
            (tidy(self.min.midpoint(self.max)), to / 2.0)
        } else {
            return false;
        };
        (self.min, self.max) = (center - half, center + half);
        true
    }

    pub(super) fn field_mut(&mut self, name: &str) -> Option<&mut dyn FieldValue> {
        let field = BOX.min.of(name, &mut self.min);
        let field = field.or(BOX.max.of(name, &mut self.max));
        field.or(match &mut self.faces {
            Some(faces) => BOX.colors.of(name, faces),
            None => BOX.color.of(name, &mut self.color),
        })
    }

    pub(super) fn is_possible(&self) -> bool {
        self.min.cmplt(self.max).all() && self.min.is_finite() && self.max.is_finite()
    }

    pub(super) fn colors(&self) -> [Color; 3] {
        self.faces.unwrap_or([self.color; 3])
    }

    pub(super) fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        let center = self.min.midpoint(self.max);
        Some((center, center.distance(self.max)))
    }

    pub(super) fn greatest_length(&self, from: DVec3) -> f64 {
        let far = |point: DVec3| (point - from).abs().max_element();
        far(self.min).max(far(self.max))
    }

    pub(super) fn summary(&self) -> String {
        let (min, max) = (short_vector(self.min), short_vector(self.max));
        match self.faces {
            None => format!("from {min} to {max}, {}", self.color),
            Some([x, y, z]) => format!("from {min} to {max}, {x}, {y} and {z}"),
        }
    }
}

/// Reports a box that has no extent along an axis.
fn empty(block: &LoweredBlock<'_>, min: DVec3, max: DVec3, problems: &mut Problems) {
    let axes = ["x", "y", "z"].into_iter();
    let mut axes = axes.zip(min.to_array()).zip(max.to_array());
    let Some(((axis, low), high)) = axes.find(|((_, low), high)| low >= high) else {
        return;
    };
    let (low, high) = (
        numbers::comparable(low, &[high]),
        numbers::comparable(high, &[low]),
    );
    let problem = error("empty_box", format!("the box has no extent along {axis}"));
    problems.push(match (block.given(BOX.min), block.given(BOX.max)) {
        (Some(low_given), Some(high_given)) => {
            // The fix swaps coordinates so that each coordinate of `max` is the greater one. It is
            // not offered if `min` and `max` have an equal coordinate, since the box would still
            // have no extent along that axis.
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
            let size = block.given(BOX.size);
            problem
                .at(
                    size.map_or(block.place(BOX.center), |given| given.span),
                    format!("lost in rounding beside {low}"),
                )
                .help("make it larger: so far from the origin, a number has no digits left for its size")
        }
    });
}

/// Returns the text of a vector with all digits of its coordinates.
fn exactly(vector: DVec3) -> String {
    let [x, y, z] = vector.to_array();
    format!("({x}, {y}, {z})")
}

/// Rounds each coordinate to fifteen significant digits.
fn tidy(v: DVec3) -> DVec3 {
    let tidy = |x: f64| format!("{x:.14e}").parse().unwrap_or(x);
    DVec3::from(v.to_array().map(tidy))
}
