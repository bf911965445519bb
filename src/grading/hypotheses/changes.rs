//! Functions that apply the mistakes of the table in `mistakes` to a hypothesis about a program.

use glam::DVec3;

use super::{
    behaviour::{HitFault, SeenSurface, Spheres, SquareRule},
    candidate::Candidate,
    light::{Curve, Effect},
};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    math::Angle,
    reference::formulas::vertices,
    scene::{Cuboid, Lens, Shape, TriangleOutline, View},
};

/// Makes the picture gray: each channel becomes the same weighted mean of the sRGB-encoded
/// channels.
pub fn gray_of_encoded(c: &mut Candidate, weights: [f64; 3]) {
    c.effects.extend([
        Effect::PerChannel(linear_to_srgb),
        Effect::Gray(weights),
        Effect::PerChannel(srgb_to_linear),
    ]);
}

/// Lets the program apply a function to the light of each channel. Does nothing if the program has
/// another effect on light already.
pub fn map_channels(c: &mut Candidate, curve: fn(f64) -> f64) {
    if c.effects.is_empty() {
        c.effects.push(Effect::PerChannel(curve));
    }
}

/// Lets the program multiply each channel by a factor, which is fitted to the picture. The first of
/// `functions` is applied before the multiplication, the second after it. Does nothing if the
/// program has another effect on light already.
pub fn multiply(c: &mut Candidate, functions: [fn(f64) -> f64; 2]) {
    if c.effects.is_empty() {
        c.effects.push(Effect::Gain(functions));
    }
}

/// Reverses the normal of a triangle, if the scene describes the triangle by its normal.
pub fn reverse_normal(c: &mut Candidate, object: usize) {
    if let Some(Shape::Triangle(triangle)) = shapes(c).nth(object)
        && let TriangleOutline::Centered(centered) = &mut triangle.outline
    {
        centered.normal = -centered.normal;
    }
}

/// Returns whether a checkerboard is drawn.
pub fn has_board(c: &Candidate) -> bool {
    let mut drawn = c.scene.objects.iter().zip(&c.is_drawn);
    drawn.any(|(object, is_drawn)| *is_drawn && object.shape.checkerboard().is_some())
}

/// Offsets the samples by some pixels to the right and down. The directions are those of the
/// program's picture, which may be mirrored or turned.
pub fn shift(c: &mut Candidate, by: [f64; 2]) {
    c.behaviour.offset = c.layout.source_direction(by);
}

/// Widens the spacing of the samples. The program then seems to divide the window into one column
/// and one row too few, so that its pixels are too large.
pub fn spread_by_one_less(c: &mut Candidate) {
    c.behaviour.spread = sides(c).map(|side| side / (side - 1.0).max(1.0));
}

pub fn is_square(c: &Candidate) -> bool {
    c.scene.image.width == c.scene.image.height
}

/// Returns the distance of the view plane from the eye, in metres.
pub fn distance(c: &Candidate) -> f64 {
    let height = c.scene.camera.view_height;
    let half = |angle: Angle| libm::tan(angle.in_radians() / 2.0);
    let [width, tall] = sides(c);
    match c.scene.camera.lens {
        Lens::Distance(d) => d,
        Lens::Fov(angle) => height / (2.0 * half(angle)),
        Lens::HorizontalFov(angle) => height * width / tall / (2.0 * half(angle)),
    }
}

pub fn sides(c: &Candidate) -> [f64; 2] {
    [c.scene.image.width, c.scene.image.height].map(f64::from)
}

/// Sets the ratio of the width to the height of the window, i.e. of the rectangle in space that the
/// picture shows. Does nothing if an earlier mistake has set the ratio, or if `aspect` is the
/// correct ratio.
pub fn set_aspect(c: &mut Candidate, aspect: f64) {
    let [width, height] = sides(c);
    let by = aspect * height / width;
    if c.behaviour.aspect == 1.0 && (by - 1.0).abs() > 1e-3 {
        c.behaviour.aspect = by;
    }
}

/// Sets a fault in how rays are intersected with spheres. Does nothing if the scene has no sphere.
pub fn set_sphere_fault(c: &mut Candidate, spheres: Spheres) {
    if shapes(c).any(|shape| matches!(shape, Shape::Sphere(_))) {
        c.behaviour.spheres = spheres;
    }
}

/// Sets a fault in how rays are intersected with an object. Does nothing if the object's shape
/// cannot have this fault, or if some object has a fault already.
pub fn set_hit_fault(c: &mut Candidate, object: usize, hit: HitFault) {
    let of_box = matches!(hit, HitFault::WithoutAxis(_));
    let kind = if of_box { "box" } else { "triangle" };
    if c.scene.objects[object].shape.kind() == kind && c.behaviour.hit.is_none() {
        c.behaviour.hit = Some((object, hit));
    }
}

/// Lets the program encode light by a wrong curve, unless an earlier mistake has set a wrong curve.
pub fn set_encoding(c: &mut Candidate, curve: Curve) {
    if c.curve == Curve::Correct {
        c.curve = curve;
    }
}

/// Lets the program decode colours and encode their average by the same wrong curve, unless an
/// earlier mistake has set a wrong curve for encoding.
pub fn set_averaging(c: &mut Candidate, curve: Curve) {
    if c.curve == Curve::Correct {
        (c.decoding, c.curve) = (curve, curve);
    }
}

pub fn set_order(c: &mut Candidate, visible: SeenSurface) {
    if c.scene.objects.len() > 1 {
        set_seen_surface(c, visible);
    }
}

/// Sets a wrong rule for which surface is seen, unless an earlier mistake has set one.
pub fn set_seen_surface(c: &mut Candidate, visible: SeenSurface) {
    if c.behaviour.visible == SeenSurface::Nearest {
        c.behaviour.visible = visible;
    }
}

/// Sets a wrong rule for the colours of a checkerboard's squares. Does nothing if no board is
/// drawn, or if an earlier mistake has set a wrong rule.
pub fn set_square_rule(c: &mut Candidate, is_first: fn(f64, f64) -> bool) {
    if has_board(c) && c.behaviour.square_rule == SquareRule::default() {
        c.behaviour.square_rule = SquareRule(is_first);
    }
}

pub fn exchange_colors(c: &mut Candidate) {
    for shape in shapes(c) {
        if let Shape::Checkerboard(board) = shape {
            board.colors.reverse();
        }
    }
}

pub fn exchange_sides(c: &mut Candidate) {
    let [width, height] = sides(c);
    match c.scene.camera.lens {
        _ if width == height => {}
        Lens::HorizontalFov(_) => lengthen(c, height / width),
        Lens::Distance(_) | Lens::Fov(_) => lengthen(c, width / height),
    }
}

/// Multiplies the distance of the view plane from the eye by `by`. If the scene gives a field of
/// view instead of the distance, changes this angle so that the effect is the same.
pub fn lengthen(c: &mut Candidate, by: f64) {
    match &mut c.scene.camera.lens {
        Lens::Distance(d) => *d *= by,
        Lens::Fov(angle) | Lens::HorizontalFov(angle) => *angle = widened(*angle, 1.0 / by),
    }
}

/// Returns the angle β with tan(β/2) = `by` · tan(α/2), where α is `angle`.
fn widened(angle: Angle, by: f64) -> Angle {
    twice_arctan(by * libm::tan(angle.in_radians() / 2.0))
}

/// Returns the angle α with tan(α/2) = `tangent`.
pub fn twice_arctan(tangent: f64) -> Angle {
    Angle::from_degrees((2.0 * libm::atan(tangent)).to_degrees())
}

/// Shows the scene larger, as if the program did not divide the camera's right vector by its
/// length, the sine of the angle between the up vector and the view direction. The window then
/// shrinks by this factor. Dividing the distance of the view plane by the factor has the same
/// effect.
pub fn divide_by_sine_of_up(c: &mut Candidate) {
    let (from, to) = c.scene.camera.view.ends(c.scene.camera.eye);
    let [up, ahead] = [c.scene.camera.up, to - from].map(DVec3::normalize_or_zero);
    let length = up.cross(ahead).length();
    if length > 0.0 {
        lengthen(c, 1.0 / length);
    }
}

/// Multiplies the distance of the view plane from the eye by `by`. If the scene gives a field of
/// view instead, divides this angle by `by`. Does nothing if the result would be 180° or more.
pub fn zoom(c: &mut Candidate, by: f64) {
    let is_less = |angle: Angle| angle.in_radians() < std::f64::consts::PI;
    match &mut c.scene.camera.lens {
        Lens::Distance(d) => *d *= by,
        Lens::Fov(angle) | Lens::HorizontalFov(angle) if is_less(*angle / by) => {
            *angle = *angle / by
        }
        Lens::Fov(_) | Lens::HorizontalFov(_) => {}
    }
}

pub fn exchange_faces(c: &mut Candidate, object: usize, order: [usize; 3]) {
    if let Some(Shape::Box(Cuboid {
        faces: Some(faces), ..
    })) = shapes(c).nth(object)
    {
        *faces = order.map(|axis| faces[axis]);
    }
}

/// Moves a triangle as if the program placed the wrong point of it at the position that the scene
/// gives for the centroid. `point` computes the wrong point from the vertices. Does nothing unless
/// the scene describes the triangle by its centroid.
pub fn anchor(c: &mut Candidate, object: usize, point: fn([DVec3; 3]) -> DVec3) {
    if let Some(Shape::Triangle(triangle)) = shapes(c).nth(object) {
        let point = point(vertices(&triangle.outline));
        if let TriangleOutline::Centered(centered) = &mut triangle.outline {
            centered.centroid += centered.centroid - point;
        }
    }
}

/// Moves the least and the greatest corner of a box, each by a multiple of the box's size.
pub fn stretch(c: &mut Candidate, object: usize, by: [DVec3; 2]) {
    if let Some(Shape::Box(cuboid)) = shapes(c).nth(object) {
        let size = cuboid.max - cuboid.min;
        cuboid.min += by[0] * size;
        cuboid.max += by[1] * size;
    }
}

pub fn shapes(c: &mut Candidate) -> impl Iterator<Item = &mut Shape> {
    c.scene
        .objects_mut()
        .iter_mut()
        .map(|object| &mut object.shape)
}

pub fn look_back(c: &mut Candidate) {
    let camera = &mut c.scene.camera;
    camera.view = match camera.view {
        View::Lookat(point) => View::Lookat(2.0 * camera.eye - point),
        View::Direction(direction) => View::Direction(-direction),
    };
}
