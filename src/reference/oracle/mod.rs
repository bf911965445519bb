//! The oracle: a tracer that decides by textbook formulas what is seen at a sample point, in
//! arithmetic of 512 to 3000 bits.
//!
//! The oracle shares nothing with the tracer. It uses world coordinates instead of the view plane,
//! the quadratic formula, signed areas, and slabs with divisions. A sum is treated as zero if it is
//! at most 2^(−5/14·b) times as large as its terms, where b is the number of bits: 2^−182 for 512
//! bits, 2^−500 for 1400. This limit is far above the rounding errors. It is far below 2^−90, the
//! relative difference up to which the language treats depths as equal.

mod number;

use std::cmp::Ordering;

use dashu_int::IBig;
use glam::{DVec2, dvec2};

pub use self::number::{N, Number, V, length};
use self::number::{abs, axpy, cross, dot, scale, size, sub, unit};
use crate::{
    math::Angle,
    scene::{Lens, Scene, Shape, TriangleOutline, View},
};

/// Number of bits that suffices for the oracle's arithmetic if a scene's numbers have any size in
/// the range of `f64`. More bits would only take longer.
pub const ALL_SIZES: usize = 1400;

/// Number of bits that suffices for the oracle's arithmetic if a view is extremely wide or narrow.
/// The side of a pixel and the distance of the view plane then differ by a factor of about 2^1000.
pub const ALL_VIEWS: usize = 3000;

/// Number of bits that suffices for the oracle's arithmetic if a scene's numbers differ by factors
/// of at most about 2^100. More bits would take more time.
pub const USUAL_SIZES: usize = 512;

/// A scene prepared for the oracle, a reference tracer that computes with 512 to 3000 bits.
#[derive(Debug)]
pub struct Oracle {
    /// Arithmetic with the oracle's number of bits.
    pub number: Number,
    scene: Scene,
    surfaces: Vec<PreparedShape>,
    eye: V,
    /// The camera's axes: the directions to the picture's right and to its top, and the direction
    /// opposite to the view.
    pub axes: [V; 3],
    /// Distance between the eye and the view plane.
    d: N,
    /// Side of a pixel in the view plane.
    pixel: N,
}

/// Values of a shape that do not depend on the ray and are computed only once.
#[derive(Debug)]
enum PreparedShape {
    /// A sphere: `f` is eye − centre, `square` is f·f, and `c` is f·f − radius².
    Sphere { f: V, square: N, c: N },
    /// A triangle: its vertices, and its normal n. `height` is n·(p − eye) for a point p of the
    /// triangle; it is 0 if the eye lies in the triangle's plane. `scale` is the vertices' part of
    /// an upper bound of the terms from which signed areas are computed. An area that is far
    /// smaller than this bound is treated as 0.
    Triangle {
        vertices: Box<[V; 3]>,
        normal: V,
        height: N,
        scale: N,
    },
    /// A box: the vectors from the eye to its least corner and to its greatest corner.
    Box { lo: V, hi: V },
    /// A checkerboard: its height above the eye, and the side of a square.
    Checkerboard { height: N, square: N },
}

/// The point at which a ray hits the object that is seen, in the oracle's arithmetic.
#[derive(Clone, Debug)]
pub struct OracleHit {
    /// Index of the object in the scene.
    pub object: usize,
    /// Whether a checkerboard shows its second colour.
    pub odd: bool,
    /// Parameter t of the intersection, which lies at eye + t·direction.
    pub t: N,
}

impl Oracle {
    /// Prepares a scene for arithmetic of `bits` bits. The scene's up vector must not be parallel
    /// to the view direction.
    pub fn new(scene: &Scene, bits: usize) -> Self {
        let number = Number { bits };
        let n = |x| number.exact(x);
        let camera = &scene.camera;
        let eye = number.vector(camera.eye);
        let forward = match camera.view {
            View::Lookat(at) => sub(&number.vector(at), &eye),
            View::Direction(direction) => number.vector(direction),
        };
        let w = scale(&n(-1.0), &unit(&forward));
        let u = unit(&cross(&number.vector(camera.up), &w));
        let top = cross(&w, &u);
        let (s, c) = number.sin_cos(camera.roll);
        let rolled_u = axpy(&scale(&c, &u), &-s.clone(), &top);
        let rolled_v = axpy(&scale(&s, &u), &c, &top);
        let twice_tan_of_half = |angle: Angle| {
            let (s, c) = number.sin_cos(angle * 0.5);
            n(2.0) * s / c
        };
        let [width, height] = [scene.image.width, scene.image.height].map(|side| n(side.into()));
        let d = match camera.lens {
            Lens::Distance(d) => n(d),
            Lens::Fov(angle) => n(camera.view_height) / twice_tan_of_half(angle),
            Lens::HorizontalFov(angle) => {
                width / height.clone() * n(camera.view_height) / twice_tan_of_half(angle)
            }
        };
        let surface = |shape: &Shape| PreparedShape::new(number, shape, &eye);
        let surfaces = scene.objects.iter().map(|o| surface(&o.shape)).collect();
        Self {
            number,
            surfaces,
            eye,
            axes: [rolled_u, rolled_v, w],
            d,
            pixel: n(camera.view_height) / height,
            scene: scene.clone(),
        }
    }

    /// Returns the direction of the ray through the point at `offset` pixels from the centre of the
    /// pixel in column `x` and row `y`.
    pub fn direction(&self, x: u32, y: u32, offset: DVec2) -> V {
        self.direction_through(dvec2(f64::from(x), f64::from(y)) + 0.5, offset)
    }

    /// Returns the direction of the ray through the point `pixels` + `offset`, in pixels from the
    /// picture's top left corner.
    pub fn direction_through(&self, pixels: DVec2, offset: DVec2) -> V {
        let n = |x| self.number.exact(x);
        let half = |pixels: u32| n(f64::from(pixels) / 2.0);
        let right = (n(pixels.x) + n(offset.x) - half(self.scene.image.width)) * &self.pixel;
        let up = (half(self.scene.image.height) - n(pixels.y) - n(offset.y)) * &self.pixel;
        let [u, v, w] = &self.axes;
        axpy(&axpy(&scale(&right, u), &up, v), &-self.d.clone(), w)
    }

    /// Returns the visible intersection of the ray with direction `r` from the eye, or `None` if
    /// the ray hits nothing between the clip planes.
    pub fn seen(&self, r: &V) -> Option<OracleHit> {
        let (camera, n) = (&self.scene.camera, |x| self.number.exact(x));
        let (near, far) = (n(camera.near), camera.far.map(n));
        let ahead = -dot(r, &self.axes[2]);
        let is_visible = |t: &N| {
            let depth = t * &ahead;
            self.order(&depth, &near) == Ordering::Greater
                && (far.as_ref()).is_none_or(|far| self.order(&depth, far) == Ordering::Less)
        };
        let seen = (0..self.surfaces.len()).filter_map(|object| {
            let crossings = self.crossings(object, r);
            Some((object, crossings.into_iter().find(is_visible)?))
        });
        // If two objects are at the same depth, the one that comes first in the file is seen.
        let (object, t) = seen.reduce(|best, next| match self.order(&next.1, &best.1) {
            Ordering::Less => next,
            _ => best,
        })?;
        let odd = match &self.surfaces[object] {
            PreparedShape::Checkerboard { square, .. } => {
                let p = self.point(&t, r);
                self.is_odd(&p[0], square) != self.is_odd(&p[2], square)
            }
            _ => false,
        };
        Some(OracleHit { object, odd, t })
    }

    /// Computes the point on a ray from the eye with the direction `r`, at the parameter `t`.
    pub fn point(&self, t: &N, r: &V) -> V {
        axpy(&self.eye, t, r)
    }

    /// Returns whether floor(`x`/`square`) is odd, for a coordinate `x` of a point on a
    /// checkerboard whose squares have the side `square`.
    fn is_odd(&self, x: &N, square: &N) -> bool {
        // Rounding may have made the quotient slightly smaller than an integer. A small number is
        // added, so that its floor is this integer. For example, floor(1/3 + 2/3) must not be 0.
        let close = self.number.exact(1.0) >> (self.number.bits as isize * 3 / 14);
        let cell = (x / square + close).floor();
        (cell.to_int().value() & IBig::ONE) == IBig::ONE
    }

    /// Returns all t > 0, in ascending order, at which the ray eye + t·`r` hits the object with the
    /// index `index`.
    pub fn crossings(&self, index: usize, r: &V) -> Vec<N> {
        match &self.surfaces[index] {
            PreparedShape::Sphere { f, square, c } => self.sphere(f, square, c, r),
            PreparedShape::Triangle {
                vertices,
                normal,
                height,
                scale,
            } => self
                .plane(normal, height, r)
                .filter(|t| self.is_in_triangle(vertices, normal, scale, &self.point(t, r)))
                .into_iter()
                .collect(),
            PreparedShape::Box { lo, hi } => self.cuboid(lo, hi, r),
            PreparedShape::Checkerboard { height, .. } => {
                let up = [0.0, 1.0, 0.0].map(|x| self.number.exact(x));
                self.plane(&up, height, r).into_iter().collect()
            }
        }
    }

    /// Intersects the ray with the direction `r` from the eye with a sphere. Returns the ray's
    /// parameters t > 0 at the crossings, the smaller first. The parameters are roots of a·t² +
    /// 2b·t + c = 0. The list is empty if the ray misses or only touches the sphere.
    fn sphere(&self, f: &V, square: &N, c: &N, r: &V) -> Vec<N> {
        let (a, b) = (dot(r, r), dot(f, r));
        let bb = &b * &b;
        let discriminant = &bb - &a * c;
        if self.sign(&discriminant, &bb) != Ordering::Greater {
            return Vec::new();
        }
        let root = discriminant.sqrt();
        let roots = [(-&b - &root) / &a, (-&b + &root) / &a];
        // If the eye is on the sphere's surface, one root is t = 0. Because of rounding errors, its
        // computed value may differ from 0, so this root is left out.
        if self.sign(c, square) == Ordering::Equal {
            let is_ahead = self.sign(&-&b, &square.sqrt()) == Ordering::Greater;
            return roots.into_iter().skip(1).filter(|_| is_ahead).collect();
        }
        roots.into_iter().filter(|t| *t > N::ZERO).collect()
    }

    /// Intersects the ray with the direction `r` from the eye with a plane whose points p satisfy
    /// n·(p − eye) = `height`. Returns the ray's parameter t. Returns `None` if the eye lies in the
    /// plane, if the ray is parallel to the plane, or if the intersection is behind the eye.
    fn plane(&self, n: &V, height: &N, r: &V) -> Option<N> {
        let slope = dot(n, r);
        if *height == N::ZERO || self.sign(&slope, &(size(n) * size(r))) == Ordering::Equal {
            return None;
        }
        let t = height / slope;
        (t > N::ZERO).then_some(t)
    }

    /// Returns whether the point `p` of a triangle's plane lies inside the triangle or on its
    /// edges.
    fn is_in_triangle(&self, [a, b, c]: &[V; 3], normal: &V, scale: &N, p: &V) -> bool {
        let scale = scale + size(normal) * dot(p, p);
        [(a, b), (b, c), (c, a)].iter().all(|(a, b)| {
            let area = dot(normal, &cross(&sub(b, a), &sub(p, a)));
            self.sign(&area, &scale) != Ordering::Less
        })
    }

    /// Intersects the ray with the direction `r` from the eye with a box. A box is the intersection
    /// of three slabs, each between two parallel planes. The ray's line is inside of the box from
    /// the greatest t at which it enters a slab to the least t at which it leaves one. Returns the
    /// positive ones of these two t. The list is empty if the ray misses the box.
    fn cuboid(&self, lo: &V, hi: &V, r: &V) -> Vec<N> {
        let is_parallel = |axis: &usize| self.sign(&r[*axis], &size(r)) == Ordering::Equal;
        let (parallel, across): (Vec<_>, Vec<_>) = (0..3).partition(is_parallel);
        if (parallel.iter()).any(|&axis| lo[axis] > N::ZERO || hi[axis] < N::ZERO) {
            return Vec::new();
        }
        let slabs = across.into_iter().map(|axis| {
            let mut ends = [&lo[axis], &hi[axis]].map(|end| end / &r[axis]);
            ends.sort_unstable();
            ends
        });
        let common = slabs.reduce(|[enter, leave], [a, b]| [enter.max(a), leave.min(b)]);
        let common = common.filter(|[enter, leave]| self.order(enter, leave) != Ordering::Greater);
        let ends = common.into_iter().flatten();
        ends.filter(|t| *t > N::ZERO).collect()
    }

    /// Compares two numbers. They are treated as equal if their difference is negligible compared
    /// with the numbers themselves.
    fn order(&self, a: &N, b: &N) -> Ordering {
        self.sign(&(a - b), &(abs(a) + abs(b)))
    }

    fn sign(&self, x: &N, size: &N) -> Ordering {
        self.number.sign(x, size)
    }
}

impl PreparedShape {
    fn new(number: Number, shape: &Shape, eye: &V) -> Self {
        match shape {
            Shape::Sphere(sphere) => {
                let radius = number.exact(sphere.radius);
                let f = sub(eye, &number.vector(sphere.center));
                let square = dot(&f, &f);
                let c = &square - &radius * &radius;
                Self::Sphere { f, square, c }
            }
            Shape::Triangle(triangle) => {
                let (vertices, normal, point) = match &triangle.outline {
                    TriangleOutline::Centered(triangle) => (
                        number.vertices(triangle),
                        number.vector(triangle.normal),
                        number.vector(triangle.centroid),
                    ),
                    TriangleOutline::Vertices(vertices) => {
                        let [a, b, c] = vertices.map(|vertex| number.vector(vertex));
                        let normal = cross(&sub(&b, &a), &sub(&c, &a));
                        ([a.clone(), b, c], normal, a)
                    }
                };
                let from_eye = sub(&point, eye);
                let height = dot(&normal, &from_eye);
                let height = match number.sign(&height, &(size(&normal) * size(&from_eye))) {
                    Ordering::Equal => N::ZERO,
                    _ => height,
                };
                let [a, b, c] = vertices.each_ref().map(|v| dot(v, v));
                Self::Triangle {
                    scale: size(&normal) * (a + b + c),
                    vertices: Box::new(vertices),
                    normal,
                    height,
                }
            }
            Shape::Box(cuboid) => Self::Box {
                lo: sub(&number.vector(cuboid.min), eye),
                hi: sub(&number.vector(cuboid.max), eye),
            },
            Shape::Checkerboard(board) => Self::Checkerboard {
                height: number.exact(board.y) - &eye[1],
                square: number.exact(board.square),
            },
        }
    }
}
