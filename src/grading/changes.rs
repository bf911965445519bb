//! What mistakes change in a candidate. Each gives none where it changes nothing.

use glam::DVec3;

use super::{
    axes::radians,
    candidate::Candidate,
    light::{Average, Curve, Look},
    textbook::{Behind, Squares, Visible},
};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    math::Angle,
    scene::{Lens, Shape},
};

/// Samples lie so many half pixels to the right and down of where they should.
pub fn shifted(c: &mut Candidate, half_pixels: [i32; 2]) -> Option<()> {
    c.layout.half_pixels = half_pixels;
    Some(())
}

/// The picture is laid out otherwise.
pub fn layout(c: &mut Candidate, [mirrored, upside_down, transposed]: [bool; 3]) -> Option<()> {
    c.layout.is_mirrored ^= mirrored;
    c.layout.is_upside_down ^= upside_down;
    c.layout.is_transposed ^= transposed;
    Some(())
}

/// Something is done to the light.
pub fn look(c: &mut Candidate, look: Look) -> Option<()> {
    c.looks.push(look);
    Some(())
}

/// The channels are in another order.
pub fn channels(c: &mut Candidate, order: [usize; 3]) -> Option<()> {
    look(c, Look::Channels(order))
}

/// Light is encoded otherwise.
pub fn encoded(c: &mut Candidate, curve: Curve) -> Option<()> {
    (c.curve == Curve::Right).then_some(())?;
    c.curve = curve;
    Some(())
}

/// Gray by a mean of encoded values.
pub fn encoded_gray(c: &mut Candidate, weights: [f64; 3]) -> Option<()> {
    c.looks.extend([
        Look::Curve(linear_to_srgb),
        Look::Gray(weights),
        Look::Curve(srgb_to_linear),
    ]);
    Some(())
}

/// Something else than light is averaged.
pub fn averaged(c: &mut Candidate, average: Average, curve: Curve) -> Option<()> {
    c.average = average;
    encoded(c, curve)
}

/// Another surface is seen than the nearest.
pub fn visible(c: &mut Candidate, visible: Visible) -> Option<()> {
    (c.behaviour.visible != visible && c.scene.objects.len() > 1).then_some(())?;
    c.behaviour.visible = visible;
    Some(())
}

/// Surfaces behind the eye are seen.
pub fn behind(c: &mut Candidate, behind: Behind) -> Option<()> {
    c.behaviour.behind = behind;
    Some(())
}

/// The squares of a checkerboard are told otherwise.
pub fn squares(c: &mut Candidate, squares: Squares) -> Option<()> {
    let is_board = |object: &crate::scene::Object| matches!(object.shape, Shape::Checkerboard(_));
    c.scene.objects.iter().any(is_board).then_some(())?;
    c.behaviour.squares = squares;
    Some(())
}

/// The roll is another, which shows another picture.
pub fn roll(c: &mut Candidate, roll: Angle) -> Option<()> {
    (c.scene.camera.roll != roll && c.scene.camera.roll != -roll
        || c.scene.camera.roll == -roll && roll != Angle::default())
    .then_some(())?;
    c.scene.camera.roll = roll;
    Some(())
}

/// Another vector is up.
pub fn up(c: &mut Candidate, up: DVec3) -> Option<()> {
    (c.scene.camera.up != up).then_some(())?;
    // Without −0.
    c.scene.camera.up = up + DVec3::ZERO;
    Some(())
}

/// A lens with an angle whose half has a tangent so many times as large.
pub fn narrowed(angle: Angle, by: f64, lens: fn(Angle) -> Lens) -> Lens {
    let half = radians(angle) / 2.0;
    lens(Angle::from_degrees(
        (2.0 * libm::atan(by * libm::tan(half))).to_degrees(),
    ))
}

/// The view plane is so many times as far.
pub fn scaled(c: &mut Candidate, by: f64) -> Option<()> {
    c.scene.camera.lens = match c.scene.camera.lens {
        Lens::Distance(d) => Lens::Distance(d * by),
        Lens::Fov(angle) => Lens::Fov(angle / by),
        Lens::HorizontalFov(angle) => Lens::HorizontalFov(angle / by),
    };
    let is_less = |angle| radians(angle) < std::f64::consts::PI;
    match c.scene.camera.lens {
        Lens::Distance(_) => Some(()),
        Lens::Fov(angle) | Lens::HorizontalFov(angle) => is_less(angle).then_some(()),
    }
}

/// A box is moved by so many times its size.
pub fn moved(c: &mut Candidate, object: usize, by: DVec3) -> Option<()> {
    let Shape::Box(cuboid) = c.shape(object) else {
        return None;
    };
    let by = by * (cuboid.max - cuboid.min);
    (cuboid.min, cuboid.max) = (cuboid.min + by, cuboid.max + by);
    Some(())
}
