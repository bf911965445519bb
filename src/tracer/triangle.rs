//! The triangle: three edges, each a line in the view plane.
//!
//! In: the triangle's numbers and the camera. Out: three edge forms and the form of its plane's inverse depth; for a ray, its crossing. A ray
//! meets the triangle where no edge form is negative: the edge functions of Olano and Greer ("Triangle scan conversion using 2D homogeneous
//! coordinates", 1997). Errors: each form's own bound.

use std::{array, cmp::Ordering};

use glam::DVec3;

use super::{
    camera::{Camera, Direction, Window},
    crossing::{Crossing, SurfacePart},
    form::{Form, inverse_depth},
    interval::{Cover, Patch},
};
use crate::{
    math::{Ball, Ball3, Big, Double, Doubt, Exact, Radius, Real, cross, sin_cos},
    scene::{self, CenteredTriangle, Outline},
};

/// A triangle prepared for one picture.
#[derive(Clone, Debug)]
pub struct Triangle<T: Real> {
    /// For each edge the form that is ≥ 0 on the triangle's side of it: the determinant of the edge's ends and the ray.
    pub edges: [Form<T>; 3],
    /// The inverse depth of its plane.
    pub plane: Form<T>,
}

/// The corners of a triangle in the camera's axes, their lengths times a power of two.
#[derive(Clone, Debug)]
pub struct Vertices<T: Real> {
    /// Left base end, right base end, apex.
    pub points: [Ball3<T>; 3],
    /// That power's exponent.
    pub exponent: i32,
}

impl<T: Real> Triangle<T> {
    /// Prepares a triangle; `None` if its plane holds the eye, which sees it edge-on: not at all.
    pub fn new(camera: &Camera<T>, shape: &scene::Triangle) -> Option<Self> {
        Self::with_corners(camera, shape).map(|(triangle, _)| triangle)
    }

    /// Prepares a triangle, and tells where its corners are.
    pub fn with_corners(
        camera: &Camera<T>,
        shape: &scene::Triangle,
    ) -> Option<(Self, Vertices<T>)> {
        match &shape.outline {
            Outline::Vertices(vertices) => Self::by_vertices(camera, vertices),
            Outline::Centered(triangle) => Self::by_centroid(camera, triangle),
        }
    }

    /// Two triangles that share an edge have the same two points for it, so that of every ray they know exactly the same.
    fn by_vertices(camera: &Camera<T>, vertices: &[DVec3; 3]) -> Option<(Self, Vertices<T>)> {
        let (normal, height, side) = plane_through(camera, vertices);
        if side.is_eq() {
            return None;
        }
        let from_eye = vertices.map(|vertex| camera.relative(vertex));
        let exponents = from_eye.each_ref().map(|v| exponent_of(array::from_ref(v)));
        let exponent = -exponents.into_iter().fold(i32::MIN, i32::max);
        let points = from_eye.map(|v| camera.turned(&v.map(|x| x.scaled(exponent))));
        // a × b = a × (b − a). The edges' forms matter by their signs alone, so each may have a scale of its own.
        let edge = |a: usize, b: usize| {
            let along: Ball3<T> =
                array::from_fn(|i| Ball::difference(vertices[b][i], vertices[a][i]));
            let own = -exponent_of(array::from_ref(&along));
            let along = camera.turned(&along.map(|x| x.scaled(own)));
            let n = cross(&points[a], &along);
            Form::new(camera, &facing(n, side))
        };
        let triangle = Self {
            edges: [edge(0, 1), edge(1, 2), edge(2, 0)],
            plane: inverse_depth(camera, &normal, &height),
        };
        Some((triangle, Vertices { points, exponent }))
    }

    fn by_centroid(camera: &Camera<T>, shape: &CenteredTriangle) -> Option<(Self, Vertices<T>)> {
        let from_eye = camera.relative(shape.centroid);
        let (normal, height, side) = plane(camera, shape);
        if side.is_eq() {
            return None;
        }
        let plane = inverse_depth(camera, &normal, &height);

        // The eye sees each corner at c + o, c being the centroid. Both may be of any size beside each other.
        let offsets = offsets::<T>(shape);
        let [far, near] = [
            exponent_of(array::from_ref(&from_eye)),
            exponent_of(&offsets) + camera.exponent,
        ];
        let center = camera.turned(&from_eye.map(|x| x.scaled(-far)));
        let offsets =
            offsets.map(|offset| camera.turned(&offset.map(|x| x.scaled(camera.exponent - near))));
        let exponent = -far.max(near);
        let sum = |c: &Ball3<T>, o: &Ball3<T>| -> Ball3<T> {
            array::from_fn(|i| c[i].scaled(far + exponent) + o[i].scaled(near + exponent))
        };
        // The edges' forms matter by their signs alone, so lengths may be scaled. From the corners themselves little would be left of a
        // triangle far away beside its size: of a × b, a = c + o and b = c + p, that is c × (p − o) + o × p.
        let edge = |a: usize, b: usize| {
            let along: Ball3<T> = array::from_fn(|i| &offsets[b][i] - &offsets[a][i]);
            let n = sum(&cross(&center, &along), &cross(&offsets[a], &offsets[b]));
            Form::new(camera, &facing(n, side))
        };
        let triangle = Self {
            edges: [edge(0, 1), edge(1, 2), edge(2, 0)],
            plane,
        };
        let corners = Vertices {
            points: offsets.each_ref().map(|offset| sum(&center, offset)),
            exponent,
        };
        Some((triangle, corners))
    }

    /// The crossing, if the ray meets the closed triangle in front of the eye.
    #[inline]
    pub fn first(&self, r: &Direction<T>) -> Result<Option<Crossing<T>>, Doubt> {
        let (mut doubt, mut is_inside) = (false, false);
        for edge in &self.edges {
            match edge.at(r).sign() {
                Ok(Ordering::Less) => return Ok(None),
                Ok(sign) => is_inside |= sign.is_gt(),
                Err(Doubt) => doubt = true,
            }
        }
        if doubt {
            return Err(Doubt);
        }
        let inverse_depth = self.plane.at(r);
        // With all three determinants zero the ray lies in the plane, or, in the last precision, the triangle is too small or too nearly edge-on
        // to be told from nothing; else the sum of them, and so the depth, is positive.
        if !is_inside || inverse_depth.sign()? != Ordering::Greater {
            return Ok(None);
        }
        Ok(Some(Crossing {
            inverse_depth,
            part: SurfacePart::Plane(0),
        }))
    }
}

impl Triangle<f64> {
    /// How it stands to a rectangle; `None` if no ray through it meets the triangle.
    pub fn cover(&self, patch: &Patch) -> Option<Cover> {
        let mut is_whole = true;
        for edge in &self.edges {
            let range = edge.over(patch);
            if range.high < 0.0 {
                return None;
            }
            is_whole &= range.low > 0.0;
        }
        Some(Cover {
            is_whole,
            inverse_depth: self.plane.over(patch),
        })
    }
}

impl Triangle<Double> {
    /// The same triangle for `f64`.
    pub fn narrowed(&self, window: &Window<f64>) -> Triangle<f64> {
        Triangle {
            edges: self.edges.each_ref().map(|edge| edge.narrowed(window)),
            plane: self.plane.narrowed(window),
        }
    }
}

/// The exponent of the greatest coordinate.
fn exponent_of<T: Real>(points: &[Ball3<T>]) -> i32 {
    let sizes = points.iter().flatten().map(Ball::size);
    sizes.fold(T::Radius::ZERO, Radius::max).exponent()
}

/// An edge's form for a triangle of which the eye sees this side: seen from behind, its turn is the other way round.
fn facing<T: Real>(n: Ball3<T>, side: Ordering) -> Ball3<T> {
    if side.is_lt() { n.map(|x| -x) } else { n }
}

/// The vertices of a triangle in the world: as they are written, or left base end, right base end, apex, each coordinate rounded once.
pub fn vertices(shape: &scene::Triangle) -> [DVec3; 3] {
    let shape = match &shape.outline {
        Outline::Vertices(vertices) => return *vertices,
        Outline::Centered(triangle) => triangle,
    };
    let centroid = shape.centroid.to_array().map(Ball::<Big>::exact);
    offsets::<Big>(shape)
        .map(|offset| DVec3::from([0, 1, 2].map(|i| (&centroid[i] + &offset[i]).mid.to_f64())))
}

/// The triangle's plane as seen from the eye: n and h of n·q = h, and on which side of the plane the eye lies, as the sign of
/// h for the normal that the scene gives.
///
/// Here n is divided by its greatest component, and each number is a rounding of the true one: so triangles in one plane, with
/// normals of whatever lengths, get the same n and h, and planes along the axes those of a box's faces.
fn plane<T: Real>(camera: &Camera<T>, shape: &CenteredTriangle) -> (Ball3<T>, Ball<T>, Ordering) {
    let normal = shape.normal.to_array();
    let greatest = shape.normal.abs().max_element();
    let pivot = normal.into_iter().find(|x| x.abs() == greatest);
    let pivot = pivot.unwrap_or(1.0);
    let terms = [0, 1, 2]
        .map(|i| &Exact::difference(shape.centroid[i], camera.eye[i]) * &Exact::new(normal[i]));
    let h = &(&terms[0] + &terms[1]) + &terms[2];
    let n = normal.map(|x| Ball::quotient(x, pivot));
    let height = h
        .to_big()
        .over(&Big::from_f64(pivot))
        .scaled(camera.exponent);
    (n, Ball::from_big(&height), h.sign())
}

/// The same of the plane through three points, whose normal is (b − a) × (c − a).
fn plane_through<T: Real>(
    camera: &Camera<T>,
    vertices: &[DVec3; 3],
) -> (Ball3<T>, Ball<T>, Ordering) {
    let [a, b, c] = vertices;
    let along = |to: &DVec3| -> [Exact; 3] { array::from_fn(|i| Exact::difference(to[i], a[i])) };
    let (one, other) = (along(b), along(c));
    let normal: [Exact; 3] = array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &(&one[j] * &other[k]) - &(&one[k] * &other[j])
    });
    let terms: [Exact; 3] =
        array::from_fn(|i| &Exact::difference(a[i], camera.eye[i]) * &normal[i]);
    let h = &(&terms[0] + &terms[1]) + &terms[2];
    let parts = normal.each_ref().map(Exact::to_big);
    let greater = |a: Big, b: &Big| {
        if b.magnitude() > a.magnitude() {
            b.clone()
        } else {
            a
        }
    };
    let pivot = parts.iter().fold(Big::from_f64(0.0), greater);
    let n = parts.map(|x| Ball::from_big(&x.over(&pivot)));
    let height = h.to_big().over(&pivot).scaled(camera.exponent);
    (n, Ball::from_big(&height), h.sign())
}

/// The vertices as seen from the centroid, in the world's axes: left base end, right base end, apex.
///
/// In the triangle's plane, with the base along x from 0 to c, the apex lies at x = (a² − b² + c²)/(2c) and y = 2A/c, the
/// area A by Heron's formula, 16A² = (a+b+c)(−a+b+c)(a−b+c)(a+b−c).
fn offsets<T: Real>(shape: &CenteredTriangle) -> [Ball3<T>; 3] {
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

/// Unit vectors in the plane of a normal n: right = (Y × n)/|Y × n| and top = n/|n| × right, with (0, 0, −1) for Y where n
/// is parallel to it.
fn plane_axes<T: Real>(normal: DVec3) -> (Ball3<T>, Ball3<T>) {
    let [x, y, z] = normal.to_array();
    let (zero, one) = (Ball::exact(0.0), Ball::exact(1.0));
    if x == 0.0 && z == 0.0 {
        // (0, 0, −1) × (0, ±1, 0) = (±1, 0, 0), and (0, ±1, 0) × (±1, 0, 0) = (0, 0, −1).
        let right = [Ball::exact(1f64.copysign(y)), zero.clone(), zero.clone()];
        return (right, [zero.clone(), zero, -one]);
    }
    // Y × n = (z, 0, −x). Its length is formed apart from y, which may be larger by any factor.
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
