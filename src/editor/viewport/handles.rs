//! Computes the handles and the outlines of objects, and moves an object by one of its handles. A
//! handle is a point of an object that can be dragged in the picture.

use glam::{DVec2, DVec3};

use super::{
    lines::Polyline,
    silhouette::{self, circle},
};
use crate::{
    math::{Angle, trig, unit},
    projection::Projection,
    scene::{
        CenteredTriangle, Checkerboard, Cuboid, FieldOwner, Shape, Sphere, Triangle,
        TriangleOutline, operate,
    },
    schema::{BOX, CHECKERBOARD, SPHERE, TRIANGLE, Value},
    syntax::tree::Operator,
    tracer::vertices,
};

/// Maximum distance, in pixels of the picture, between the pointer and the handle that it drags. If
/// no text can bring the handle so near, the drag is refused. Half a pixel is not visible; a
/// smaller tolerance would need numbers with more digits in the text.
pub const TOLERANCE: f64 = 0.5;

/// Message about a drag that is refused because the new numbers would be too large for a scene, or
/// too large for `f64` to place the handle accurately.
pub const TOO_FAR: &str = "that is too far away";

/// Name of a handle, and its position in space. The position is `None` if the eye cannot see the
/// handle.
///
/// The name is the field that changes with the handle. If the handle moves only along one axis, the
/// name of that axis follows, as in `min_x`.
pub type Handle = (&'static str, Option<DVec3>);

/// Axis or plane along which a dragged point moves in space. If neither is given, the point moves
/// parallel to the view plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Along {
    /// One of the coordinate axes x, y and z, by its index 0, 1 or 2.
    Axis(usize),
    /// The horizontal plane through the point.
    Floor,
}

impl Along {
    /// Returns the axis `x`, `y` or `z`, or the plane `floor`. Returns `None` for any other name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "floor" => Some(Self::Floor),
            _ => AXES.iter().position(|axis| *axis == name).map(Self::Axis),
        }
    }
}

/// Names of the fields of a triangle's vertices.
const CORNERS: [&str; 3] = [TRIANGLE.v0.name, TRIANGLE.v1.name, TRIANGLE.v2.name];

/// Name of the handle at an object's centre, for all kinds of objects that have one.
const CENTER: &str = BOX.center.name;

/// Names of the coordinate axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Names of the handles in the middle of a box's six faces. For each axis, the face with the
/// smaller coordinate comes first.
const FACES: [&str; 6] = ["min_x", "max_x", "min_y", "max_y", "min_z", "max_z"];

/// Returns the handles of an object. The handle of a sphere's radius lies on the silhouette, in the
/// direction `towards` from the centre.
pub fn handles(shape: &Shape, projection: &Projection, towards: DVec3) -> Vec<Handle> {
    match shape {
        Shape::Sphere(sphere) => vec![
            (SPHERE.center.name, Some(sphere.center)),
            (
                SPHERE.radius.name,
                silhouette::point(sphere, projection.eye, towards),
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
                // A triangle given by vertices has no field for its centroid. The handle there
                // moves all three vertices.
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

/// Returns the direction from an object's centre in which its radius handle is drawn while the
/// pointer drags `handle` to the point `to` of the picture. The handle stays on the pointer's side
/// of the centre. Only spheres have such a handle; for other shapes, the direction has no effect.
pub fn side_held(shape: &Shape, handle: &str, to: DVec2, projection: &Projection) -> DVec3 {
    match shape {
        Shape::Sphere(_) if handle == SPHERE.radius.name => projection.ray(to),
        Shape::Sphere(_) | Shape::Triangle(_) | Shape::Box(_) | Shape::Checkerboard(_) => {
            projection.right
        }
    }
}

/// Returns the four edges of a box that are parallel to the axis with the index `axis`. Returns an
/// empty list for any other shape.
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

/// Returns the outline of a shape in the picture. For a checkerboard, returns the outline of the
/// square that the view axis hits.
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

/// Returns the outline of the checkerboard's square that the view axis hits.
fn square(projection: &Projection, board: &Checkerboard) -> Vec<Polyline> {
    let met = projection.on_plane(projection.size / 2.0, DVec3::Y * board.y, DVec3::Y);
    met.map_or_else(Vec::new, |met| {
        let side = board.square;
        let corner = ((met / side).floor() * side).with_y(board.y);
        let [x, z] = [DVec3::X * side, DVec3::Z * side];
        projection.line(&[corner, corner + x, corner + x + z, corner + z, corner])
    })
}

/// Returns the object after the handle `handle` was dragged to the point `to` of the picture, or as
/// near to it as possible.
///
/// # Errors
///
/// Returns a sentence that says why the handle cannot be moved there.
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
                let (foot, reach) = (own.centroid, own.sides.z);
                let normal = turned_vector(foot, own.normal, reach, to, projection);
                Some(Value::Vector(normal))
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
    // The handle `center` of a box or triangle moves the corners or vertices, not a field `center`.
    // A triangle given by vertices has no such field, and the `center` of a box is only a rounded
    // mean of its corners.
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

/// Returns the new position in space of `point`, which is dragged to the point `to` of the picture.
/// The point moves along the axis or plane `along`. It then appears at `to` or, if it moves along
/// an axis, as near to `to` as possible.
///
/// # Errors
///
/// Returns a sentence if the new position would be behind the eye, or too far from `to` because of
/// rounding errors.
pub fn moved_point(
    point: DVec3,
    to: DVec2,
    along: Option<Along>,
    projection: &Projection,
) -> Result<DVec3, String> {
    let (moved, across) = match along {
        None => (
            projection.on_plane(to, point, projection.ahead),
            DVec3::ZERO,
        ),
        Some(Along::Floor) => (projection.on_plane(to, point, DVec3::Y), DVec3::ZERO),
        Some(Along::Axis(axis)) => {
            let (moved, across) = on_line(point, DVec3::AXES[axis], to, projection);
            (Some(moved), across)
        }
    };
    let unseen = || match along {
        Some(Along::Floor) => {
            let y = point.y;
            format!(
                "the plane y = {y}, in which it moves, is not seen there: come nearer, or drag it freely"
            )
        }
        Some(Along::Axis(axis)) => {
            let axis = AXES[axis];
            format!("its way along {axis} is not seen there: drag it along another axis, or freely")
        }
        None => TOO_FAR.to_owned(),
    };
    let moved = moved.filter(|moved| projection.point(*moved).is_some());
    let moved = moved.ok_or_else(unseen)?;
    if appears_at(moved, across, to, projection) {
        Ok(moved)
    } else {
        Err(TOO_FAR.to_owned())
    }
}

/// Returns the point of the line through `point` along `axis` that appears nearest to the point
/// `to` of the picture. Also returns the direction in space, parallel to the view plane, that is
/// perpendicular to the line in the picture.
pub fn on_line(point: DVec3, axis: DVec3, to: DVec2, projection: &Projection) -> (DVec3, DVec3) {
    // In the picture, the line's point nearest to `to` is on the perpendicular through `to`. All
    // points in space that appear on this perpendicular form a plane through the eye. The returned
    // point is where the line intersects this plane.
    let from_eye = point - projection.eye;
    let normal = unit(from_eye.cross(axis)).0;
    let across = unit(normal.reject_from(projection.ahead)).0;
    let plane = projection.ray(to).cross(across);
    let moved = point - axis * (from_eye.dot(plane) / axis.dot(plane));
    (moved, across)
}

/// Returns whether a point of space appears within [`TOLERANCE`] of the point `to` of the picture.
/// A difference in the direction `across`, which is parallel to the view plane, is ignored.
pub fn appears_at(point: DVec3, across: DVec3, to: DVec2, projection: &Projection) -> bool {
    let across = DVec2::new(across.dot(projection.right), -across.dot(projection.top));
    projection.point(point).is_some_and(|seen| {
        let left = (seen - to) - across * (seen - to).dot(across);
        left.length() <= TOLERANCE
    })
}

/// Returns the radius of a sphere with the same centre whose silhouette passes through the point
/// `to` of the picture.
///
/// # Errors
///
/// Returns a sentence if there is no such sphere, because the eye would be inside of it or `to` is
/// behind the centre.
fn radius(sphere: &Sphere, to: DVec2, projection: &Projection) -> Result<f64, String> {
    let (axis, distance) = unit(sphere.center - projection.eye);
    let (ray, _) = unit(projection.ray(to));
    let radius = ray.cross(axis).length() * distance;
    // A radius is returned only if the silhouette is in front of the eye and the eye is outside of
    // the sphere.
    if ray.dot(axis) > 0.0 && radius < distance {
        Ok(radius)
    } else {
        Err("the outline of a sphere cannot come so far".to_owned())
    }
}

/// Returns a vector as long as `vector`, turned so that its drawn arrow ends at the point `to` of
/// the picture. The arrow starts at the point `foot` in space and has the length `reach`. There may
/// be two such vectors: one points towards the eye, the other away from it. The result is the one
/// on the same side as `vector`. If there is none, returns the vector whose arrow ends nearest to
/// `to`.
pub fn turned_vector(
    foot: DVec3,
    vector: DVec3,
    reach: f64,
    to: DVec2,
    projection: &Projection,
) -> DVec3 {
    let (ray, _) = unit(projection.ray(to));
    let center = foot - projection.eye;
    // The new tip is where the ray through `to` meets the sphere with the radius `reach` around
    // the vector's foot. `nearest` is the vector from the foot to the nearest point of the ray.
    let nearest = ray * center.dot(ray) - center;
    let (direction, length) = unit(vector);
    let rest = (reach - nearest.length()) * (reach + nearest.length());
    let tip = nearest + ray * rest.max(0.0).sqrt().copysign(direction.dot(ray));
    unit(tip).0 * length
}

/// Returns the spin of a triangle (its rotation about its normal) with which the apex points from
/// the centroid towards the point that appears at `to`.
///
/// # Errors
///
/// Returns a sentence if the triangle's plane is not visible at `to`.
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

/// Adds degrees to an angle. If the sum is more than half a turn in either direction, whole turns
/// are removed.
pub fn within_half_turn(angle: Angle, degrees: f64) -> Angle {
    let whole = angle.in_degrees() + degrees;
    let turns = if whole.abs() > 180.0 {
        (whole / 360.0).round()
    } else {
        0.0
    };
    angle + Angle::from_degrees(degrees - 360.0 * turns)
}
