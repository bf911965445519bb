//! Where an object's handles are, and what the object becomes where one is moved.

use glam::{DVec2, DVec3};

use crate::{
    math::{Angle, trig},
    projection::Projection,
    scene::{CenteredTriangle, Cuboid, Outline, Part, Shape, Sphere, Triangle, operate},
    schema::Value,
    syntax::tree::Operator,
    tracer::vertices,
};

/// So far, in pixels, something may be seen from where it should be.
pub const TOLERANCE: f64 = 0.5;

/// Why nothing is moved where numbers have too few digits, or are too large.
pub const TOO_FAR: &str = "that is too far away";

/// A handle's name, and where it is in the world; nowhere if it cannot be seen from where the eye
/// is. The name is that of the field that moves with it, with an axis behind it where it moves
/// along that alone.
pub type Handle = (&'static str, Option<DVec3>);

/// What a point moves along, other than the plane through it that is parallel to the view plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The axis x, y or z (0, 1 or 2).
    Axis(usize),
    /// The plane of equal y.
    Floor,
}

impl Along {
    /// An axis, or `floor`, by its name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "floor" => Some(Self::Floor),
            _ => AXES.iter().position(|axis| *axis == name).map(Self::Axis),
        }
    }
}

const CORNERS: [&str; 3] = ["v0", "v1", "v2"];

const AXES: [&str; 3] = ["x", "y", "z"];

/// The faces of a box: of each axis the one of least coordinates, and the other.
const FACES: [&str; 6] = ["min_x", "max_x", "min_y", "max_y", "min_z", "max_z"];

/// The handles of an object; that of a sphere's radius is on the side of a direction.
pub fn handles(shape: &Shape, projection: &Projection, towards: DVec3) -> Vec<Handle> {
    match shape {
        Shape::Sphere(sphere) => vec![
            ("center", Some(sphere.center)),
            ("radius", outline_point(sphere, projection.eye, towards)),
        ],
        Shape::Box(Cuboid { min, max, .. }) => {
            let center = min.midpoint(*max);
            let mut handles = vec![("center", Some(center))];
            for (face, name) in FACES.into_iter().enumerate() {
                let mut at = center;
                at[face / 2] = [min, max][face % 2][face / 2];
                handles.push((name, Some(at)));
            }
            handles
        }
        Shape::Triangle(triangle) => match triangle.outline {
            Outline::Centered(own) => {
                let [.., apex] = vertices(triangle);
                let tip = own.centroid + unit(own.normal).0 * own.sides.z;
                vec![
                    ("centroid", Some(own.centroid)),
                    ("normal", Some(tip)),
                    ("spin", Some(apex)),
                ]
            }
            Outline::Vertices(corners) => {
                let corners = CORNERS.into_iter().zip(corners.map(Some));
                let center = [("center", Some(triangle.outline.centroid()))];
                corners.chain(center).collect()
            }
        },
        Shape::Checkerboard(board) => {
            let met = projection.on_plane(projection.size / 2.0, DVec3::Y * board.y, DVec3::Y);
            vec![("y", met.map(|met| met.with_y(board.y)))]
        }
    }
}

/// Where a ray from the eye touches a sphere, on the side of a direction; nowhere from inside it.
///
/// With c from the eye to the centre, k = r/|c| and t the direction across c, of length 1, this is
/// (1 − k²) c + r √(1 − k²) t.
pub fn outline_point(sphere: &Sphere, eye: DVec3, towards: DVec3) -> Option<DVec3> {
    let (axis, distance) = unit(sphere.center - eye);
    let across = towards - axis * towards.dot(axis);
    let k = sphere.radius / distance;
    let rest = (1.0 - k) * (1.0 + k);
    let side = unit(across).0 * (sphere.radius * rest.sqrt());
    let at = eye + axis * (distance * rest) + side;
    (k < 1.0 && at.is_finite()).then_some(at)
}

/// A vector of length 1, and its length, which may be anything that a number can be.
pub fn unit(v: DVec3) -> (DVec3, f64) {
    let greatest = v.abs().max_element();
    let scaled = v / greatest;
    (scaled.normalize(), scaled.length() * greatest)
}

/// An object with a handle moved to where it is to be seen at a point of the picture, or as near to
/// that as it can be.
pub fn moved(
    shape: Shape,
    handle: &str,
    to: DVec2,
    along: Option<Along>,
    projection: &Projection,
) -> Result<Part, String> {
    let part = Part::Shape(shape);
    let no_handle = || {
        let kind = shape.kind();
        format!("a {kind} of this form has no handle `{handle}`")
    };
    let mut handles = handles(&shape, projection, projection.right).into_iter();
    let found = handles.find(|(known, _)| *known == handle);
    let (_, at) = found.ok_or_else(no_handle)?;
    let centered = match shape {
        Shape::Triangle(Triangle {
            outline: Outline::Centered(own),
            ..
        }) => Some(own),
        _ => None,
    };
    let moved = match (handle, shape, centered, at) {
        ("radius", Shape::Sphere(sphere), ..) => {
            part.with(handle, Value::Number(radius(&sphere, to, projection)?))
        }
        ("normal", _, Some(own), _) => {
            part.with(handle, Value::Vector(turned_normal(&own, to, projection)))
        }
        ("spin", _, Some(own), Some(apex)) => {
            part.with(handle, Value::Angle(spun(&own, apex, to, projection)?))
        }
        (.., Some(at)) if projection.depth(at) > 0.0 => {
            let (field, axis) = handle.split_once('_').unwrap_or((handle, handle));
            let along = Along::named(axis).or(along);
            let by = moved_point(at, to, along, projection)? - at;
            // What has corners moves by them: as a field, the centre of a box is rounded, and that
            // of three vertices is none.
            let fields = match (field, shape) {
                ("center", Shape::Box(_)) => &["min", "max"][..],
                ("center", Shape::Triangle(_)) => &CORNERS,
                _ => &[field],
            };
            fields.iter().try_fold(part, |part, field| {
                let by = match part.value(field)? {
                    Value::Number(_) => Value::Number(by.y),
                    _ => Value::Vector(by),
                };
                part.with(field, operate(Operator::Add, part.value(field)?, by)?)
            })
        }
        _ => return Err(format!("the handle `{handle}` is not in front of the eye")),
    };
    moved.ok_or_else(no_handle)
}

/// A point moved to where it is seen at a point of the picture, or as near to that as what it moves
/// along allows.
fn moved_point(
    point: DVec3,
    to: DVec2,
    along: Option<Along>,
    projection: &Projection,
) -> Result<DVec3, String> {
    let mut across = DVec3::ZERO;
    let moved = match along {
        None => projection.on_plane(to, point, projection.ahead),
        Some(Along::Floor) => projection.on_plane(to, point, DVec3::Y),
        Some(Along::Axis(axis)) => {
            // The axis is seen as a line, and what is seen across it from `to` lies in a plane with
            // the eye, which the axis meets at the nearest point.
            let (axis, from_eye) = (DVec3::AXES[axis], point - projection.eye);
            let normal = unit(from_eye.cross(axis)).0;
            across = unit(normal.reject_from(projection.ahead)).0;
            let plane = projection.ray(to).cross(across);
            Some(point - axis * (from_eye.dot(plane) / axis.dot(plane)))
        }
    };
    let seen = moved.and_then(|moved| Some((moved, projection.point(moved)?)));
    let (moved, seen) = seen.ok_or_else(|| match along {
        Some(Along::Floor) => {
            let y = point.y;
            format!("the plane y = {y}, in which it moves, is not seen there: come nearer, or drag it freely")
        }
        Some(Along::Axis(axis)) => {
            let axis = AXES[axis];
            format!("its way along {axis} is not seen there: drag it along another axis, or freely")
        }
        None => TOO_FAR.to_owned(),
    })?;
    let across = DVec2::new(across.dot(projection.right), -across.dot(projection.top));
    let left = (seen - to) - across * (seen - to).dot(across);
    match left.length() <= TOLERANCE {
        true => Ok(moved),
        false => Err(TOO_FAR.to_owned()),
    }
}

/// The radius with which a sphere's outline passes through a point of the picture.
fn radius(sphere: &Sphere, to: DVec2, projection: &Projection) -> Result<f64, String> {
    let (axis, distance) = unit(sphere.center - projection.eye);
    let (ray, _) = unit(projection.ray(to));
    let radius = ray.cross(axis).length() * distance;
    // From the surface, or from inside, no outline is seen.
    match ray.dot(axis) > 0.0 && radius < distance {
        true => Ok(radius),
        false => Err("the outline of a sphere cannot come so far".to_owned()),
    }
}

/// The normal whose tip is seen at a point of the picture, on the side of the centroid where it is
/// now; or that whose tip comes nearest.
fn turned_normal(triangle: &CenteredTriangle, to: DVec2, projection: &Projection) -> DVec3 {
    let reach = triangle.sides.z;
    let (ray, _) = unit(projection.ray(to));
    let center = triangle.centroid - projection.eye;
    // Where the ray is nearest to the centroid, and from there to the sphere of all tips.
    let foot = ray * center.dot(ray) - center;
    let (normal, length) = unit(triangle.normal);
    let rest = (reach - foot.length()) * (reach + foot.length());
    let tip = foot + ray * rest.max(0.0).sqrt().copysign(normal.dot(ray));
    unit(tip).0 * length
}

/// The spin with which the apex is seen in the direction of a point of the picture from the
/// centroid.
fn spun(
    triangle: &CenteredTriangle,
    apex: DVec3,
    to: DVec2,
    projection: &Projection,
) -> Result<Angle, String> {
    let normal = unit(triangle.normal).0;
    let wanted = projection
        .on_plane(to, triangle.centroid, normal)
        .ok_or("the plane of the triangle is not seen there")?
        - triangle.centroid;
    let current = apex - triangle.centroid;
    let (sine, cosine) = (current.cross(wanted).dot(normal), current.dot(wanted));
    let turn = trig::atan2(sine, cosine).in_degrees();
    Ok(within_half_turn(triangle.spin, turn))
}

/// An angle and so many degrees more; by whole turns less where that is more than half a turn.
pub fn within_half_turn(angle: Angle, degrees: f64) -> Angle {
    let whole = angle.in_degrees() + degrees;
    let turns = match whole.abs() > 180.0 {
        true => (whole / 360.0).round(),
        false => 0.0,
    };
    angle + Angle::from_degrees(degrees - 360.0 * turns)
}
