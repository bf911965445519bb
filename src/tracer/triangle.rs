//! The triangle: three edges, each a line in the view plane.
//!
//! In: the triangle's numbers and the camera. Out: a [`Convex`] object of one face and three edges,
//! and the triangle's corners. The form of an edge is the determinant of the edge's two ends and
//! the ray.

use std::{array, cmp::Ordering};

use glam::DVec3;

use super::{
    camera::Camera,
    convex::Convex,
    form::{Form, inverse_depth},
};
use crate::{
    math::{Ball, Ball3, Big, Dyadic, Dyadic3, Radius, Real, cross, sin_cos},
    scene::{self, CenteredTriangle, TriangleOutline},
};

/// Prepares a triangle. Returns it with its corners relative to the eye, along the camera's axes.
/// Returns `None` if the triangle's plane contains the eye, which then sees nothing of the
/// triangle.
pub fn prepare<T: Real>(
    camera: &Camera<T>,
    shape: &scene::Triangle,
) -> Option<(Convex<T>, [Ball3<T>; 3])> {
    match &shape.outline {
        TriangleOutline::Vertices(vertices) => by_vertices(camera, vertices),
        TriangleOutline::Centered(triangle) => by_centroid(camera, triangle),
    }
}

/// Prepares a triangle that is given by its vertices. Two triangles that share an edge compute the
/// edge from the same two points. For a ray near this edge, their decisions therefore agree
/// exactly. Returns `None` if the triangle's plane contains the eye.
fn by_vertices<T: Real>(
    camera: &Camera<T>,
    vertices: &[DVec3; 3],
) -> Option<(Convex<T>, [Ball3<T>; 3])> {
    let plane = SeenPlane::through(camera, vertices)?;
    let corners = vertices.map(|vertex| camera.turned(&camera.relative(vertex)));
    let edge = |a: usize, b: usize| edge(camera, &corners[a], vertices[a], vertices[b]);
    let triangle = plane.with_edges(camera, [edge(0, 1), edge(1, 2), edge(2, 0)]);
    Some((triangle, corners))
}

/// Returns a normal of the plane through the eye and the edge from `a` to `b`, in the camera's
/// axes: the cross product of the two ends relative to the eye. `corner` is the first end relative
/// to the eye. The normal may have any length, because only the sign of its scalar product with
/// rays matters.
fn edge<T: Real>(camera: &Camera<T>, corner: &Ball3<T>, a: DVec3, b: DVec3) -> Ball3<T> {
    if !T::LAST {
        // a × b is computed as a × (b − a), where a and b are relative to the eye. The difference b
        // − a is computed without cancellation.
        let along: Ball3<T> = array::from_fn(|i| Ball::difference(b[i], a[i]));
        let along = camera.turned(&scaled_to_one(&along));
        let normal = cross(&scaled_to_one(corner), &along);
        let is_certain = |x: &Ball<T>| x.is_precise() && x.sign().is_ok();
        if normal.iter().all(is_certain) {
            return normal;
        }
    }
    // If vertices are very far away, their directions from the eye may agree in hundreds of binary
    // digits. The normal is then computed exactly.
    let [a, b] = [a, b].map(|corner| Dyadic::between(camera.eye, corner));
    let normal = Dyadic::cross(&a, &b).map(|x| Ball::<Big>::from_big(&x.to_big()));
    camera.turned(&scaled_to_one(&normal).map(|x| Ball::from_big(&x.mid)))
}

fn by_centroid<T: Real>(
    camera: &Camera<T>,
    shape: &CenteredTriangle,
) -> Option<(Convex<T>, [Ball3<T>; 3])> {
    let plane = SeenPlane::across(camera, shape)?;
    // A corner lies at c + o relative to the eye, where c is the centroid and o is the corner's
    // offset from the centroid. c and o may differ in size by any factor, so that each has its own
    // scale.
    let from_eye = camera.relative(shape.centroid);
    let offsets = offsets::<T>(shape);
    let [far, near] = [
        exponent_of(array::from_ref(&from_eye)),
        exponent_of(&offsets) + camera.exponent,
    ];
    let center = camera.turned(&from_eye.map(|x| x.scaled(-far)));
    let offsets =
        offsets.map(|offset| camera.turned(&offset.map(|x| x.scaled(camera.exponent - near))));
    let sum = |c: &Ball3<T>, o: &Ball3<T>, exponent: i32| -> Ball3<T> {
        array::from_fn(|i| c[i].scaled(far + exponent) + o[i].scaled(near + exponent))
    };
    // For the edge from the corner a to the corner b, computes a × b, the normal of the plane
    // through the eye and the edge. Let a = c + o and b = c + p, where c is the centroid, and o and
    // p are the offsets of a and b from the centroid. Then a × b = c × (p − o) + o × p. If a × b
    // were computed from a and b themselves, it would lose most digits for a small triangle that is
    // far away. The length of the normal does not matter, so it is scaled by a power of two to
    // about 1 at most.
    let edge = |a: usize, b: usize| {
        let along: Ball3<T> = array::from_fn(|i| &offsets[b][i] - &offsets[a][i]);
        let turn = cross(&offsets[a], &offsets[b]);
        sum(&cross(&center, &along), &turn, -far.max(near))
    };
    let triangle = plane.with_edges(camera, [edge(0, 1), edge(1, 2), edge(2, 0)]);
    Some((
        triangle,
        offsets.each_ref().map(|offset| sum(&center, offset, 0)),
    ))
}

/// Scales a vector by the power of two that brings its greatest coordinate to about 1.
fn scaled_to_one<T: Real>(v: &Ball3<T>) -> Ball3<T> {
    let exponent = exponent_of(array::from_ref(v));
    v.each_ref().map(|x| x.scaled(-exponent))
}

/// Returns the binary exponent of the greatest coordinate of all vectors `points`.
fn exponent_of<T: Real>(points: &[Ball3<T>]) -> i32 {
    let sizes = points.iter().flatten().map(Ball::size);
    sizes.fold(T::Radius::ZERO, Radius::max).exponent()
}

/// Returns the vertices of a triangle in world coordinates, as the scene gives them. For a triangle
/// given by its centroid, computes its vertices: the left end of the base, the right end, and the
/// apex. Each coordinate is rounded once.
pub fn vertices(shape: &scene::Triangle) -> [DVec3; 3] {
    let shape = match &shape.outline {
        TriangleOutline::Vertices(vertices) => return *vertices,
        TriangleOutline::Centered(triangle) => triangle,
    };
    let centroid = shape.centroid.to_array().map(Ball::<Big>::exact);
    offsets::<Big>(shape)
        .map(|offset| DVec3::from([0, 1, 2].map(|i| (&centroid[i] + &offset[i]).mid.to_f64())))
}

/// A plane n·q = h, with points q relative to the eye. n and h are divided by the greatest
/// component of n, and each number is then correctly rounded. All triangles in one plane therefore
/// get equal n and h, whatever the lengths of their normals. If a box's face lies in the plane, it
/// has the same n and h.
struct SeenPlane<T: Real> {
    normal: Ball3<T>,
    height: Ball<T>,
    /// Side of the plane on which the eye lies: the sign of n·q for a point q of the plane,
    /// relative to the eye. Here, n is the normal before it is divided by its greatest component,
    /// because the division may reverse it.
    side: Ordering,
}

impl<T: Real> SeenPlane<T> {
    /// Returns the plane through three points, with the normal (b − a) × (c − a). Returns `None` if
    /// the plane contains the eye.
    fn through(camera: &Camera<T>, [a, b, c]: &[DVec3; 3]) -> Option<Self> {
        let normal = Dyadic::cross(&Dyadic::between(*a, *b), &Dyadic::between(*a, *c));
        Self::new(camera, *a, &normal)
    }

    /// Returns the plane of a triangle that is given by its centroid. Returns `None` if the plane
    /// contains the eye.
    fn across(camera: &Camera<T>, shape: &CenteredTriangle) -> Option<Self> {
        Self::new(camera, shape.centroid, &Dyadic::vector(shape.normal))
    }

    fn new(camera: &Camera<T>, point: DVec3, normal: &Dyadic3) -> Option<Self> {
        let h = Dyadic::dot(&Dyadic::between(camera.eye, point), normal);
        let side = h.sign();
        let parts = normal.each_ref().map(Dyadic::to_big);
        let sizes = parts.each_ref().map(Real::magnitude);
        let pivot = (1..3).fold(0, |i, j| if sizes[j] > sizes[i] { j } else { i });
        let over_pivot = |x: &Big| x.over(&parts[pivot]);
        (!side.is_eq()).then(|| Self {
            normal: parts.each_ref().map(|x| Ball::from_big(&over_pivot(x))),
            height: Ball::from_big(&over_pivot(&h.to_big()).scaled(camera.exponent)),
            side,
        })
    }

    /// Returns the triangle that lies in this plane. `edges` are normals of the planes through the
    /// eye and each edge. They must point inwards for an eye that sees the triangle from the front.
    /// If the eye sees it from behind, this function reverses them.
    fn with_edges(&self, camera: &Camera<T>, edges: [Ball3<T>; 3]) -> Convex<T> {
        let facing = |n: Ball3<T>| if self.side.is_lt() { n.map(|x| -x) } else { n };
        let edges = edges.into_iter().map(|n| Form::new(camera, &facing(n)));
        let plane = inverse_depth(camera, &self.normal, &self.height);
        Convex::new(edges.collect(), vec![(0, plane)], Vec::new())
    }
}

/// Returns the vertices relative to the centroid, along the axes of the world: the left end of the
/// base, the right end, and the apex.
fn offsets<T: Real>(shape: &CenteredTriangle) -> [Ball3<T>; 3] {
    // In the triangle's plane, with the base along x from 0 to c, the apex lies at
    //
    // x = (a² − b² + c²)/(2c) and y = 2A/c,
    //
    // where a, b and c are the sides. The area A follows from Heron's formula, 16A² =
    // (a+b+c)(−a+b+c)(a−b+c)(a+b−c).
    let exponent = libm::frexp(shape.sides.max_element()).1;
    let [a, b, c] = shape
        .sides
        .to_array()
        .map(|side| Ball::<T>::exact(side).scaled(-exponent));
    let two = Ball::exact(2.0);
    let three = Ball::exact(3.0);
    let apex_x = (&(&a - &b) * &(&a + &b) / &c + &c) / &two;
    let heron = (&a + &b + &c) * (&b + &c - &a) * (&a + &c - &b) * (&a + &b - &c);
    let apex_y = heron.sqrt() / (&two * &c);
    let mean_x = (&c + &apex_x) / &three;
    let mean_y = &apex_y / &three;

    let (sin, cos) = sin_cos::<T>(shape.spin);
    let (right, top) = plane_axes::<T>(shape.normal);
    [
        (-&mean_x, -&mean_y),
        (&c - &mean_x, -&mean_y),
        (&apex_x - &mean_x, &apex_y - &mean_y),
    ]
    .map(|(x, y)| {
        let turned_x = &cos * &x - &sin * &y;
        let turned_y = &sin * &x + &cos * &y;
        [0, 1, 2].map(|i| (&right[i] * &turned_x + &top[i] * &turned_y).scaled(exponent))
    })
}

/// Returns two perpendicular unit vectors in the plane with the normal n. The first, to the right,
/// is (Y × n)/|Y × n|. The second, to the top, is n/|n| × the first. Y is the y axis; if n is
/// parallel to the y axis, Y is (0, 0, −1).
fn plane_axes<T: Real>(normal: DVec3) -> (Ball3<T>, Ball3<T>) {
    let [x, y, z] = normal.to_array();
    let (zero, one) = (Ball::exact(0.0), Ball::exact(1.0));
    if x == 0.0 && z == 0.0 {
        // The normal is parallel to the y axis. (0, 0, −1) × (0, ±1, 0) = (±1, 0, 0), and (0, ±1,
        // 0) × (±1, 0, 0) = (0, 0, −1).
        let right = [Ball::exact(1f64.copysign(y)), zero.clone(), zero.clone()];
        return (right, [zero.clone(), zero, -one]);
    }
    // Y × n = (z, 0, −x). Its length is computed without y, which may be larger by any factor.
    let exponent = -libm::frexp(x.abs().max(z.abs())).1;
    let [sx, sz] = [x, z].map(|k| Ball::<T>::exact(k).scaled(exponent));
    let across = (&sx * &sx + &sz * &sz).sqrt();
    let right = [&sz / &across, zero, -&sx / &across];

    // n/|n| × right = (−s·x/|Y × n|, t, −s·z/|Y × n|) with s = y/|n| and t = |Y × n|/|n|.
    let scale = -libm::frexp(normal.abs().max_element()).1;
    let [nx, ny, nz] = [x, y, z].map(|k| Ball::<T>::exact(k).scaled(scale));
    let length = (&nx * &nx + &ny * &ny + &nz * &nz).sqrt();
    let s = &ny / &length;
    let t = across.scaled(scale - exponent) / &length;
    let top = [-(&s * &sx) / &across, t, -(&s * &sz) / &across];
    (right, top)
}
