//! What the viewport knows of each kind of object: its handles, its outline, and the object after
//! one of the handles is moved.

use glam::{DVec2, DVec3};

use super::lines::Polyline;
use crate::{
    math::{Angle, trig},
    projection::Projection,
    scene::{
        CenteredTriangle, Checkerboard, Cuboid, FieldOwner, Shape, Sphere, Triangle,
        TriangleOutline, operate,
    },
    schema::{BOX, CHECKERBOARD, SPHERE, TRIANGLE, Value},
    syntax::tree::Operator,
    tracer::vertices,
};

/// Maximum distance of a handle from where it should be seen, in pixels.
pub const TOLERANCE: f64 = 0.5;

/// Message for a move that numbers have too few digits for, or that makes them too large.
pub const TOO_FAR: &str = "that is too far away";

/// A handle's name and its point in the world; `None` if it cannot be seen from the eye.
///
/// The name is that of the field that moves with the handle, followed by an axis if the handle
/// moves only along that axis.
pub type Handle = (&'static str, Option<DVec3>);

/// The axis or plane that a point moves along, instead of the plane through it that is parallel to
/// the view plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The axis x, y or z (0, 1 or 2).
    Axis(usize),
    /// The horizontal plane.
    Floor,
}

impl Along {
    /// Returns an axis, or the floor, by its name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "floor" => Some(Self::Floor),
            _ => AXES.iter().position(|axis| *axis == name).map(Self::Axis),
        }
    }
}

/// The fields of a triangle's vertices.
const CORNERS: [&str; 3] = [TRIANGLE.v0.name, TRIANGLE.v1.name, TRIANGLE.v2.name];

/// The handle of an object's middle, for all kinds that have one.
const CENTER: &str = BOX.center.name;

const AXES: [&str; 3] = ["x", "y", "z"];

/// The handles of a box's faces: for each axis the face of least coordinates, and the opposite one.
const FACES: [&str; 6] = ["min_x", "max_x", "min_y", "max_y", "min_z", "max_z"];

/// Number of sides of a sphere's outline.
const SIDES: u32 = 64;

/// Returns the handles of an object. That of a sphere's radius is on the side of a direction.
pub fn handles(shape: &Shape, projection: &Projection, towards: DVec3) -> Vec<Handle> {
    match shape {
        Shape::Sphere(sphere) => vec![
            (SPHERE.center.name, Some(sphere.center)),
            (
                SPHERE.radius.name,
                outline_point(sphere, projection.eye, towards),
            ),
        ],
        Shape::Box(Cuboid { min, max, .. }) => {
            let center = min.midpoint(*max);
            let mut handles = vec![(BOX.center.name, Some(center))];
            for (face, name) in FACES.into_iter().enumerate() {
                let mut at = center;
                at[face / 2] = [min, max][face % 2][face / 2];
                handles.push((name, Some(at)));
            }
            handles
        }
        Shape::Triangle(triangle) => match triangle.outline {
            TriangleOutline::Centered(own) => {
                let [.., apex] = vertices(triangle);
                let tip = own.centroid + unit(own.normal).0 * own.sides.z;
                vec![
                    (TRIANGLE.centroid.name, Some(own.centroid)),
                    (TRIANGLE.normal.name, Some(tip)),
                    (TRIANGLE.spin.name, Some(apex)),
                ]
            }
            TriangleOutline::Vertices(corners) => {
                let corners = CORNERS.into_iter().zip(corners.map(Some));
                // Vertices have no field for their centroid, which moves all of them.
                let center = [(CENTER, Some(triangle.outline.centroid()))];
                corners.chain(center).collect()
            }
        },
        Shape::Checkerboard(board) => {
            let met = projection.on_plane(projection.size / 2.0, DVec3::Y * board.y, DVec3::Y);
            vec![(CHECKERBOARD.y.name, met.map(|met| met.with_y(board.y)))]
        }
    }
}

/// Returns the direction on whose side the handles of an object are while one of them is dragged to
/// a point of the picture: a sphere's radius is held on the side of the pointer.
pub fn side_held(shape: &Shape, handle: &str, to: DVec2, projection: &Projection) -> DVec3 {
    match shape {
        Shape::Sphere(_) if handle == SPHERE.radius.name => projection.ray(to),
        Shape::Sphere(_) | Shape::Triangle(_) | Shape::Box(_) | Shape::Checkerboard(_) => {
            projection.right
        }
    }
}

/// Returns the four edges of a box along an axis; other shapes have none.
pub fn edges_along(shape: &Shape, axis: usize) -> Vec<[DVec3; 2]> {
    let Some(&Cuboid { min, max, .. }) = shape.cuboid() else {
        return Vec::new();
    };
    let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
    let edges = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(j, k)| {
        let mut from = min;
        from[second] = [min, max][j][second];
        from[third] = [min, max][k][third];
        let mut to = from;
        to[axis] = max[axis];
        [from, to]
    });
    edges.into()
}

/// Returns the outline of a shape.
pub fn outline(projection: &Projection, shape: &Shape) -> Vec<Polyline> {
    match shape {
        Shape::Sphere(sphere) => {
            let points: Option<Vec<DVec3>> = circle(projection, sphere).collect();
            points.map_or_else(Vec::new, |points| projection.line(&points))
        }
        Shape::Triangle(triangle) => {
            let [a, b, c] = vertices(triangle);
            projection.line(&[a, b, c, a])
        }
        Shape::Box(_) => {
            let edges = (0..3).flat_map(|axis| edges_along(shape, axis));
            edges.flat_map(|edge| projection.line(&edge)).collect()
        }
        Shape::Checkerboard(board) => square(projection, board),
    }
}

/// Returns the points where rays from the eye touch a sphere, all around; `None`s if the eye is
/// inside.
fn circle(projection: &Projection, sphere: &Sphere) -> impl Iterator<Item = Option<DVec3>> {
    let axis = (sphere.center - projection.eye).normalize_or(projection.ahead);
    let (first, second) = axis.any_orthonormal_pair();
    (0..=SIDES).map(move |side| {
        let angle = Angle::from_degrees(360.0 * f64::from(side) / f64::from(SIDES));
        let towards = first * trig::cos(angle) + second * trig::sin(angle);
        outline_point(sphere, projection.eye, towards)
    })
}

/// Returns the square of a checkerboard that the view axis meets.
fn square(projection: &Projection, board: &Checkerboard) -> Vec<Polyline> {
    let met = projection.on_plane(projection.size / 2.0, DVec3::Y * board.y, DVec3::Y);
    met.map_or_else(Vec::new, |met| {
        let side = board.square;
        let corner = ((met / side).floor() * side).with_y(board.y);
        let [x, z] = [DVec3::X * side, DVec3::Z * side];
        projection.line(&[corner, corner + x, corner + x + z, corner + z, corner])
    })
}

/// Returns the point where a ray from the eye touches a sphere, on the side of a direction; `None`
/// if the eye is inside the sphere.
///
/// With c from the eye to the centre, k = r/|c| and t the direction across c, of length 1, the
/// point is (1 − k²) c + r √(1 − k²) t.
fn outline_point(sphere: &Sphere, eye: DVec3, towards: DVec3) -> Option<DVec3> {
    let (axis, distance) = unit(sphere.center - eye);
    let across = towards - axis * towards.dot(axis);
    let k = sphere.radius / distance;
    let rest = (1.0 - k) * (1.0 + k);
    let side = unit(across).0 * (sphere.radius * rest.sqrt());
    let at = eye + axis * (distance * rest) + side;
    (k < 1.0 && at.is_finite()).then_some(at)
}

/// Returns the vector of length 1 in a direction, and the length, without overflow.
pub fn unit(v: DVec3) -> (DVec3, f64) {
    let greatest = v.abs().max_element();
    let scaled = v / greatest;
    (scaled.normalize(), scaled.length() * greatest)
}

/// Moves a handle of an object to where it is seen at a point of the picture, or as near to that as
/// it can be.
///
/// # Errors
///
/// Why the handle cannot be moved there, in a sentence.
pub fn moved(
    shape: Shape,
    handle: &str,
    to: DVec2,
    along: Option<Along>,
    projection: &Projection,
) -> Result<FieldOwner, String> {
    let owner = FieldOwner::Shape(shape);
    let no_handle = || {
        let kind = shape.kind();
        format!("a {kind} of this form has no handle `{handle}`")
    };
    let mut handles = handles(&shape, projection, projection.right).into_iter();
    let found = handles.find(|(known, _)| *known == handle);
    let (_, at) = found.ok_or_else(no_handle)?;
    let value = match shape {
        Shape::Sphere(sphere) if handle == SPHERE.radius.name => {
            Some(Value::Number(radius(&sphere, to, projection)?))
        }
        Shape::Triangle(Triangle {
            outline: TriangleOutline::Centered(own),
            ..
        }) => match at {
            _ if handle == TRIANGLE.normal.name => {
                Some(Value::Vector(turned_normal(&own, to, projection)))
            }
            Some(apex) if handle == TRIANGLE.spin.name => {
                Some(Value::Angle(spun(&own, apex, to, projection)?))
            }
            _ => None,
        },
        Shape::Sphere(_) | Shape::Triangle(_) | Shape::Box(_) | Shape::Checkerboard(_) => None,
    };
    if let Some(value) = value {
        return owner.with(handle, value).ok_or_else(no_handle);
    }
    let Some(at) = at.filter(|at| projection.depth(*at) > 0.0) else {
        return Err(format!("the handle `{handle}` is not in front of the eye"));
    };
    let (field, axis) = handle.split_once('_').unwrap_or((handle, handle));
    let along = Along::named(axis).or(along);
    let by = moved_point(at, to, along, projection)? - at;
    // A centre moves by its corners: as a field, the centre of a box is rounded, and vertices have
    // none.
    let fields = match shape {
        Shape::Box(_) if field == CENTER => &[BOX.min.name, BOX.max.name][..],
        Shape::Triangle(_) if field == CENTER => &CORNERS,
        Shape::Sphere(_) | Shape::Triangle(_) | Shape::Box(_) | Shape::Checkerboard(_) => &[field],
    };
    let moved = fields.iter().try_fold(owner, |owner, field| {
        let by = match owner.value(field)? {
            Value::Number(_) => Value::Number(by.y),
            _ => Value::Vector(by),
        };
        owner.with(field, operate(Operator::Add, owner.value(field)?, by)?)
    });
    moved.ok_or_else(no_handle)
}

/// Moves a point to where it is seen at a point of the picture, or as near to that as what it moves
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
            // The picture of the axis is a line. The points seen across it from `to` form a plane
            // with the eye, which the axis meets at the nearest point.
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
    if left.length() <= TOLERANCE {
        Ok(moved)
    } else {
        Err(TOO_FAR.to_owned())
    }
}

/// Returns the radius with which a sphere's outline passes through a point of the picture.
fn radius(sphere: &Sphere, to: DVec2, projection: &Projection) -> Result<f64, String> {
    let (axis, distance) = unit(sphere.center - projection.eye);
    let (ray, _) = unit(projection.ray(to));
    let radius = ray.cross(axis).length() * distance;
    // From the surface or from inside, no outline is seen.
    if ray.dot(axis) > 0.0 && radius < distance {
        Ok(radius)
    } else {
        Err("the outline of a sphere cannot come so far".to_owned())
    }
}

/// Returns the normal whose tip is seen at a point of the picture, on the same side of the centroid
/// as now; or else the normal whose tip comes nearest.
fn turned_normal(triangle: &CenteredTriangle, to: DVec2, projection: &Projection) -> DVec3 {
    let reach = triangle.sides.z;
    let (ray, _) = unit(projection.ray(to));
    let center = triangle.centroid - projection.eye;
    // The point of the ray nearest to the centroid, and from there to the sphere of all tips.
    let foot = ray * center.dot(ray) - center;
    let (normal, length) = unit(triangle.normal);
    let rest = (reach - foot.length()) * (reach + foot.length());
    let tip = foot + ray * rest.max(0.0).sqrt().copysign(normal.dot(ray));
    unit(tip).0 * length
}

/// Returns the spin with which the apex is seen from the centroid in the direction of a point of
/// the picture.
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

/// Adds degrees to an angle. If the sum is more than half a turn, whole turns are taken away.
pub fn within_half_turn(angle: Angle, degrees: f64) -> Angle {
    let whole = angle.in_degrees() + degrees;
    let turns = if whole.abs() > 180.0 {
        (whole / 360.0).round()
    } else {
        0.0
    };
    angle + Angle::from_degrees(degrees - 360.0 * turns)
}
