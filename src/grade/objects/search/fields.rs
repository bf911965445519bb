//! Fields of one object that are others, beside its place: one of its sizes, and how a triangle is turned.

use glam::DVec3;

use super::{Found, Sought};
use crate::{
    grade::{Idea, Make, fit::Fit, objects::with_shape},
    math::Angle,
    numbers::{found, found_near, found_vector, short, short_vector},
    render::RenderError,
    scene::{CenteredTriangle, Outline, Shape, Triangle},
};

/// Components of a normal that are within this share of its length of what they should be are right, and one that is not is the one that is
/// wrong. It is a choice: a fit knows a direction to about a tenth of a pixel, which is less of a triangle of a dozen pixels.
const RIGHT: f64 = 0.01;

impl Sought<'_> {
    /// With one size of a box that is another one, or one side of a triangle.
    pub(super) fn stretched(
        &self,
        side: usize,
        octaves: f64,
    ) -> Result<Option<Found>, RenderError> {
        let lengths = |shape: &Shape| match shape {
            Shape::Box(cuboid) => Some(cuboid.max - cuboid.min),
            Shape::Triangle(triangle) => match triangle.outline {
                Outline::Centered(triangle) => Some(triangle.sides),
                Outline::Vertices(_) => None,
            },
            Shape::Sphere(_) | Shape::Checkerboard(_) => None,
        };
        let Some(should) = lengths(&self.shape) else {
            return Ok(None);
        };
        let shape = |p: &[f64]| {
            let mut shape = self.shape;
            let factor = libm::exp2(p[0]);
            match &mut shape {
                Shape::Box(cuboid) => {
                    let more = should[side] * (factor - 1.0) / 2.0;
                    cuboid.min[side] -= more;
                    cuboid.max[side] += more;
                }
                Shape::Triangle(triangle) => {
                    if let Outline::Centered(triangle) = &mut triangle.outline {
                        triangle.sides[side] *= factor;
                    }
                }
                Shape::Sphere(_) | Shape::Checkerboard(_) => {}
            }
            // Sides of a triangle have to meet.
            let is_one = match (shape, lengths(&shape)) {
                (Shape::Triangle(_), Some(sides)) => {
                    2.0 * sides.max_element() < sides.element_sum()
                }
                _ => factor.is_finite() && factor > 0.0,
            };
            is_one.then_some(shape)
        };
        let make = |p: &[f64]| Some(with_shape(&self.case.full.scene, self.index, shape(p)?));
        let places = (-6..=6).map(|k| vec![f64::from(k) / 6.0]).collect();
        let Some(Fit { at, left }) = self.fit_from(places, &[octaves], &make)? else {
            return Ok(None);
        };
        let (Some(made), Some(is)) = (make(&at), shape(&at).as_ref().and_then(lengths)) else {
            return Ok(None);
        };
        let (what, help) = match self.shape {
            Shape::Triangle(_) => (
                ["side a", "side b", "side c"][side],
                "sides are (a, b, c): a from the base's left end to the apex, b from its right end, c the base",
            ),
            _ => (
                ["size along x", "size along y", "size along z"][side],
                "size is (x, y, z): the lengths of the edges along the three axes, half of each on either side of the center",
            ),
        };
        let message = format!(
            "{} has a wrong size: as if its {what} were {} instead of {}",
            self.name,
            found(is[side], should[side]),
            short(should[side])
        );
        let idea = Idea {
            mistake: "object_size",
            message,
            help: help.to_owned(),
            make: made,
        };
        Ok(Some((left, idea)))
    }

    /// With another spin, if it is a triangle.
    pub(super) fn spun(&self) -> Result<Option<Found>, RenderError> {
        let Some(triangle) = self.centered() else {
            return Ok(None);
        };
        let spun = |p: &[f64]| CenteredTriangle {
            spin: triangle.spin + Angle::from_degrees(p[0]),
            ..triangle
        };
        let make = |p: &[f64]| self.with_triangle(spun(p));
        // A fit finds what is off by less than a third of the way to the next place, about.
        // Of two that are as far to either side the first is taken, which is the positive one.
        let places = (-17..=18).rev().map(|k| vec![10.0 * f64::from(k)]);
        let width = self.half_a_pixel_of_turn().to_degrees();
        let Some(Fit { at, left }) = self.fit_from(places.collect(), &[width], &make)? else {
            return Ok(None);
        };
        let in_degrees = |angle: Angle| angle.degrees + angle.radians.to_degrees();
        let should = in_degrees(triangle.spin);
        let message = format!(
            "{} is spun wrongly: as if its spin were {} degrees instead of {}",
            self.name,
            found_near(in_degrees(spun(&at).spin), should),
            short(should)
        );
        let help = "spin turns counter-clockwise, seen from the tip of the normal";
        Ok(make(&at).map(|make| (left, oriented(message, help, make))))
    }

    /// With another normal, if it is a triangle.
    pub(super) fn facing(&self) -> Result<Option<Found>, RenderError> {
        let Some(triangle) = self.centered() else {
            return Ok(None);
        };
        let length = triangle.normal.length();
        let normal = triangle.normal / length;
        if !normal.is_finite() || !normal.is_normalized() {
            return Ok(None);
        }
        let (across, up) = normal.any_orthonormal_pair();
        let tilted = |p: &[f64]| {
            let tilted = normal + across * p[0] + up * p[1];
            tilted * (length / tilted.length())
        };
        let make = |p: &[f64]| {
            self.with_triangle(CenteredTriangle {
                normal: tilted(p),
                ..triangle
            })
        };
        // Tangents: up to 50 degrees to either side.
        let steps = || (-2..=2).map(|k| 0.6 * f64::from(k));
        let places = steps().flat_map(|x| steps().map(move |y| vec![x, y]));
        let width = self.half_a_pixel_of_turn();
        let Some(Fit { at, left }) = self.fit_from(places.collect(), &[width; 2], &make)? else {
            return Ok(None);
        };
        let is = said_of_normal(triangle.normal, tilted(&at));
        let message = format!("{} faces a wrong way: as if {is}", self.name);
        let help = "normal is (x, y, z), of any length, and points to the side from which the triangle is seen as it is described";
        Ok(make(&at).map(|make| (left, oriented(message, help, make))))
    }

    /// The angle that moves a corner by half a pixel, if it is seen from above.
    fn half_a_pixel_of_turn(&self) -> f64 {
        self.width() / self.radius
    }

    fn centered(&self) -> Option<CenteredTriangle> {
        match self.shape {
            Shape::Triangle(Triangle {
                outline: Outline::Centered(triangle),
                ..
            }) => Some(triangle),
            _ => None,
        }
    }

    fn with_triangle(&self, other: CenteredTriangle) -> Option<Make> {
        let Shape::Triangle(mut triangle) = self.shape else {
            return None;
        };
        triangle.outline = Outline::Centered(other);
        let is_one = other.normal.is_finite() && other.spin.degrees.is_finite();
        is_one.then(|| with_shape(&self.case.full.scene, self.index, Shape::Triangle(triangle)))
    }
}

fn oriented(message: String, help: &str, make: Make) -> Idea {
    Idea {
        mistake: "object_orientation",
        message,
        help: help.to_owned(),
        make,
    }
}

/// A normal in place of another one: only its direction is seen, so that one component is named if the others may be right.
fn said_of_normal(should: DVec3, is: DVec3) -> String {
    for (axis, letter) in [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")] {
        let others = DVec3::ONE - axis;
        let square = (is * others).length_squared();
        let times = (is * others).dot(should) / square;
        let scaled = is * times;
        let rest = ((scaled - should) * others).length();
        if times.is_finite() && times > 0.0 && rest < RIGHT * should.length() {
            return format!(
                "the {letter} of its normal were {} instead of {}",
                found_near(scaled.dot(axis), should.dot(axis)),
                short(should.dot(axis))
            );
        }
    }
    format!(
        "its normal were along {} instead of {}",
        found_vector(is, should, should.length()),
        short_vector(should)
    )
}
