//! Where an object's handles are, and what the object becomes where one is moved.

use glam::{DVec2, DVec3};

use super::projection::Projection;
use crate::{
    math::{Angle, trig},
    scene::{CenteredTriangle, Outline, Shape, Sphere, Triangle},
    tracer::vertices,
};

/// So far, in pixels, something may be seen from where it should be.
pub const TOLERANCE: f64 = 0.5;

/// A handle, and where it is in the world; nowhere if it cannot be seen from where the eye is.
#[derive(Clone, Copy, Debug)]
pub struct Handle {
    pub name: &'static str,
    pub at: Option<DVec3>,
}

/// What a point moves along, other than the plane through it that is parallel to the view plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The axis x, y or z (0, 1 or 2).
    Axis(usize),
    /// The plane of equal y.
    Floor,
}

const CORNERS: [&str; 3] = ["v0", "v1", "v2"];

/// The faces of a box: of each axis the one of least coordinates, and the other.
const FACES: [&str; 6] = ["min_x", "max_x", "min_y", "max_y", "min_z", "max_z"];

/// The handles of an object.
pub fn handles(shape: &Shape, projection: &Projection) -> Vec<Handle> {
    let handle = |(name, at): (&'static str, DVec3)| Handle { name, at: Some(at) };
    match shape {
        Shape::Sphere(sphere) => vec![
            handle(("center", sphere.center)),
            Handle {
                name: "radius",
                at: outline_point(sphere, projection.eye, projection.right),
            },
        ],
        Shape::Box(cuboid) => {
            let center = cuboid.min.midpoint(cuboid.max);
            let faces = FACES.iter().enumerate().map(|(face, name)| {
                let mut at = center;
                at[face / 2] = [cuboid.min, cuboid.max][face % 2][face / 2];
                (*name, at)
            });
            let center = [("center", center)].into_iter();
            center.chain(faces).map(handle).collect()
        }
        Shape::Triangle(triangle) => match triangle.outline {
            Outline::Centered(CenteredTriangle {
                centroid,
                normal,
                sides,
                ..
            }) => {
                let [.., apex] = vertices(triangle);
                let tip = centroid + unit(normal).0 * sides.z;
                let handles = [("centroid", centroid), ("normal", tip), ("spin", apex)];
                handles.map(handle).into()
            }
            Outline::Vertices(corners) => {
                let corners = CORNERS.into_iter().zip(corners);
                let center = [("center", triangle.outline.centroid())];
                corners.chain(center).map(handle).collect()
            }
        },
        Shape::Checkerboard(board) => {
            let Projection { eye, ahead, .. } = *projection;
            let depth = (board.y - eye.y) / ahead.y;
            let met = (depth > 0.0).then(|| (eye + ahead * depth).with_y(board.y));
            vec![Handle {
                name: "y",
                at: met.filter(|met| met.is_finite()),
            }]
        }
    }
}

/// Where a ray from the eye touches a sphere, on the side of a direction; nowhere from inside it.
///
/// With c from the eye to the centre, k = r/|c| and t the direction across c, of length 1, this is (1 − k²) c + r √(1 − k²) t.
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

/// An object with a handle moved to where it is to be seen at a point of the picture, or as near to that as it can be.
pub fn moved(
    shape: &Shape,
    handle: &str,
    to: DVec2,
    along: Option<Along>,
    projection: &Projection,
) -> Result<Shape, String> {
    let mut handles = handles(shape, projection).into_iter();
    let Some(Handle { name, at }) = handles.find(|known| known.name == handle) else {
        let kind = shape.kind();
        return Err(format!("a {kind} of this form has no handle `{handle}`"));
    };
    let at = || at.ok_or_else(|| format!("the handle `{name}` is not in front of the eye"));
    let shift = |along| Ok::<_, String>(moved_point(at()?, to, along, projection)? - at()?);
    let mut moved = *shape;
    match (&mut moved, name) {
        (Shape::Sphere(sphere), "radius") => {
            let (axis, distance) = unit(sphere.center - projection.eye);
            let (ray, _) = unit(projection.ray(to));
            sphere.radius = ray.cross(axis).length() * distance;
            // From the surface, or from inside, no outline is seen.
            if ray.dot(axis) <= 0.0 || sphere.radius >= distance {
                return Err("the outline of a sphere cannot come so far".to_owned());
            }
        }
        (Shape::Sphere(sphere), _) => sphere.center += shift(along)?,
        (Shape::Box(cuboid), "center") => {
            let shift = shift(along)?;
            cuboid.min += shift;
            cuboid.max += shift;
        }
        (Shape::Box(cuboid), face) => {
            let face = FACES.iter().position(|name| *name == face).unwrap_or(0);
            let axis = face / 2;
            let shift = shift(Some(Along::Axis(axis)))?[axis];
            match face % 2 {
                0 => cuboid.min[axis] += shift,
                _ => cuboid.max[axis] += shift,
            }
            if cuboid.min[axis] >= cuboid.max[axis] {
                let axis = ["x", "y", "z"][axis];
                return Err(format!("the box would have no extent along {axis}"));
            }
        }
        (Shape::Triangle(triangle), "spin") => {
            let spin = spun(triangle, to, projection)?;
            if let Outline::Centered(centered) = &mut triangle.outline {
                centered.spin = spin;
            }
        }
        (Shape::Triangle(triangle), _) => match (&mut triangle.outline, name) {
            (Outline::Centered(centered), "normal") => {
                centered.normal = turned_normal(centered, to, projection)?;
            }
            (Outline::Centered(centered), _) => centered.centroid += shift(along)?,
            (Outline::Vertices(corners), name) => {
                let shift = shift(along)?;
                for (corner, known) in corners.iter_mut().zip(CORNERS) {
                    if name == "center" || name == known {
                        *corner += shift;
                    }
                }
            }
        },
        (Shape::Checkerboard(board), _) => board.y += shift(Some(Along::Axis(1)))?.y,
    }
    Ok(moved)
}

/// A point moved to where it is seen at a point of the picture, or as near to that as what it moves along allows.
fn moved_point(
    point: DVec3,
    to: DVec2,
    along: Option<Along>,
    projection: &Projection,
) -> Result<DVec3, String> {
    let ray = projection.ray(to);
    let (moved, goal) = match along {
        None => match projection.depth(point) {
            depth if depth > 0.0 => (projection.eye + ray * depth, to),
            _ => return Err("it is not in front of the eye".to_owned()),
        },
        Some(Along::Floor) => match (point.y - projection.eye.y) / ray.y {
            depth if depth > 0.0 => ((projection.eye + ray * depth).with_y(point.y), to),
            _ => return Err("the plane that it moves in is not seen there".to_owned()),
        },
        Some(Along::Axis(axis)) => along_axis(point, to, DVec3::AXES[axis], projection)?,
    };
    // Very far away, numbers have too few digits.
    let seen = projection.point(moved);
    match seen.is_some_and(|seen| seen.distance(goal) <= TOLERANCE) {
        true => Ok(moved),
        false => Err("that is too far away".to_owned()),
    }
}

/// A point moved along an axis, to where it is seen nearest to a point of the picture; and where that is.
fn along_axis(
    point: DVec3,
    to: DVec2,
    axis: DVec3,
    projection: &Projection,
) -> Result<(DVec3, DVec2), String> {
    // The plane of the eye and the axis through the point cuts the picture in a line; its normal, in the camera's axes, has that line's coefficients.
    let plane = unit((point - projection.eye).cross(axis)).0;
    let normal = DVec2::new(plane.dot(projection.right), -plane.dot(projection.top));
    let offset = projection.ray(to).dot(plane) / (normal.length_squared() * projection.pitch);
    let nearest = to - normal * offset;
    let ray = projection.ray(nearest);
    // p + s a lies on the ray t where (p + s a) × t = 0.
    let across = axis.cross(ray);
    let step = -(point - projection.eye).cross(ray).dot(across) / across.length_squared();
    let moved = point + axis * step;
    match moved.is_finite() {
        true if projection.depth(moved) > 0.0 => Ok((moved, nearest)),
        true => Err("the axis does not come so far in the picture".to_owned()),
        false => Err("the axis is seen end-on".to_owned()),
    }
}

/// The normal whose tip is seen at a point of the picture, on the side of the centroid where it is now; or that whose tip comes nearest.
fn turned_normal(
    triangle: &CenteredTriangle,
    to: DVec2,
    projection: &Projection,
) -> Result<DVec3, String> {
    let reach = triangle.sides.z;
    let (ray, _) = unit(projection.ray(to));
    let center = triangle.centroid - projection.eye;
    // Where the ray is nearest to the centroid, and from there to the sphere of all tips.
    let foot = ray * center.dot(ray) - center;
    let (normal, length) = unit(triangle.normal);
    let rest = (reach - foot.length()) * (reach + foot.length());
    let side = match normal.dot(ray) > 0.0 {
        true => ray,
        false => -ray,
    };
    let tip = foot + side * rest.max(0.0).sqrt();
    match tip == DVec3::ZERO || !tip.is_finite() {
        true => Err("the normal cannot point there".to_owned()),
        false => Ok(unit(tip).0 * length),
    }
}

/// The spin with which the apex is seen in the direction of a point of the picture from the centroid.
fn spun(triangle: &Triangle, to: DVec2, projection: &Projection) -> Result<Angle, String> {
    let Outline::Centered(centered) = triangle.outline else {
        return Err("a triangle with vertices has no spin".to_owned());
    };
    let normal = unit(centered.normal).0;
    let ray = projection.ray(to);
    let depth = (centered.centroid - projection.eye).dot(normal) / ray.dot(normal);
    if !(depth > 0.0 && depth.is_finite()) {
        return Err("the plane of the triangle is not seen there".to_owned());
    }
    let [.., apex] = vertices(triangle);
    let wanted = projection.eye + ray * depth - centered.centroid;
    let current = apex - centered.centroid;
    let (sine, cosine) = (current.cross(wanted).dot(normal), current.dot(wanted));
    let turn = trig::atan2(sine, cosine).in_degrees();
    Ok(within_half_turn(centered.spin, turn))
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
