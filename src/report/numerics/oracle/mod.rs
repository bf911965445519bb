//! What is seen at a sample point by the formulas of a textbook, in arithmetic of hundreds of bits.
//!
//! Nothing here is shared with the tracer: world coordinates instead of the view plane, the quadratic formula, signed areas and
//! slabs with divisions. What is smaller than its terms by 5/14 of the bits counts as zero (2^−500 with 1400 bits, 2^−182 with
//! 512): far beyond the 2^−90 where the language's ties begin, and far before the last bits.

mod number;

use std::cmp::Ordering;

use dashu_int::IBig;
use glam::DVec2;

pub use self::number::{N, V, length};
use self::number::{Number, abs, axpy, cross, dot, scale, size, sub, unit};
use crate::scene::{Lens, Outline, Scene, Shape, View};

/// Enough bits for scenes whose numbers are of whatever sizes an `f64` has.
pub const ALL_SIZES: usize = 1400;

/// Enough bits for views so wide or narrow that a step of one pixel and the distance of the view plane differ by some 2^1000 in size.
pub const ALL_VIEWS: usize = 3000;

/// Enough bits for scenes whose numbers differ by some 2^100 in size.
pub const USUAL_SIZES: usize = 512;

/// A scene, ready to be asked what is seen.
#[derive(Debug)]
pub struct Oracle {
    number: Number,
    scene: Scene,
    surfaces: Vec<Surface>,
    eye: V,
    /// The picture's right, its top, and against the view direction.
    axes: [V; 3],
    /// Distance of the view plane.
    d: N,
    /// The side of a pixel in it.
    pixel: N,
}

/// What a shape's formulas need that is the same for all rays.
#[derive(Debug)]
enum Surface {
    /// f = eye − centre, f·f and f·f − radius².
    Sphere { f: V, square: N, c: N },
    /// The vertices, the normal n, n·(centroid − eye), which is zero if the eye is in the plane, and the scale of areas.
    Triangle {
        vertices: Box<[V; 3]>,
        normal: V,
        height: N,
        scale: N,
    },
    /// min − eye and max − eye.
    Box { lo: V, hi: V },
    /// y − eye's y, and the side of a square.
    Checkerboard { height: N, square: N },
}

/// A point of a ray on a visible surface.
#[derive(Clone, Debug)]
pub struct Seen {
    /// The object's index in the scene.
    pub object: usize,
    /// Whether a checkerboard shows its second colour.
    pub odd: bool,
    /// The point is eye + t · direction.
    pub t: N,
}

impl Oracle {
    /// Prepares a scene. Its up vector must not be parallel to the view direction.
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
        let d = match camera.lens {
            Lens::Distance(d) => n(d),
            Lens::Fov(angle) => {
                let (s, c) = number.sin_cos(angle * 0.5);
                n(camera.view_height) * c / (n(2.0) * s)
            }
            Lens::HorizontalFov(angle) => {
                let (s, c) = number.sin_cos(angle * 0.5);
                let [width, height] =
                    [scene.image.width, scene.image.height].map(|pixels| n(f64::from(pixels)));
                n(camera.view_height) * width * c / (n(2.0) * height * s)
            }
        };
        let surface = |shape: &Shape| Surface::new(number, shape, &eye);
        let surfaces = scene.objects.iter().map(|o| surface(&o.shape)).collect();
        Self {
            number,
            surfaces,
            eye,
            axes: [rolled_u, rolled_v, w],
            d,
            pixel: n(camera.view_height) / n(f64::from(scene.image.height)),
            scene: scene.clone(),
        }
    }

    /// The picture's right, its top, and against the view direction.
    pub fn axes(&self) -> &[V; 3] {
        &self.axes
    }

    /// A number as the oracle's arithmetic has it.
    pub fn exact(&self, x: f64) -> N {
        self.number.exact(x)
    }

    /// The direction of the ray through an offset from the centre of the pixel in column `x` and row `y`.
    pub fn direction(&self, x: u32, y: u32, offset: DVec2) -> V {
        let n = |x| self.number.exact(x);
        let half = n(0.5);
        self.towards(
            n(f64::from(x)) + &half + n(offset.x),
            n(f64::from(y)) + &half + n(offset.y),
        )
    }

    /// The direction of the ray through a point so many pixels from the picture's top left corner.
    pub fn direction_through(&self, pixels: DVec2) -> V {
        self.towards(self.number.exact(pixels.x), self.number.exact(pixels.y))
    }

    fn towards(&self, x: N, y: N) -> V {
        let half = |pixels: u32| self.number.exact(f64::from(pixels) / 2.0);
        let right = (x - half(self.scene.image.width)) * &self.pixel;
        let up = (half(self.scene.image.height) - y) * &self.pixel;
        let [u, v, w] = &self.axes;
        axpy(&axpy(&scale(&right, u), &up, v), &-self.d.clone(), w)
    }

    /// What is seen along a direction.
    pub fn seen(&self, r: &V) -> Option<Seen> {
        let camera = &self.scene.camera;
        let (near, far) = (
            self.number.exact(camera.near),
            camera.far.map(|far| self.number.exact(far)),
        );
        let ahead = -dot(r, &self.axes[2]);
        let mut best: Option<(usize, N)> = None;
        for index in 0..self.scene.objects.len() {
            let visible = self.crossings(index, r).into_iter().find(|t| {
                let depth = t * &ahead;
                self.order(&depth, &near) == Ordering::Greater
                    && (far.as_ref()).is_none_or(|far| self.order(&depth, far) == Ordering::Less)
            });
            if let Some(t) = visible
                && (best.as_ref())
                    .is_none_or(|(_, nearest)| self.order(&t, nearest) == Ordering::Less)
            {
                best = Some((index, t));
            }
        }
        let (object, t) = best?;
        let odd = match &self.surfaces[object] {
            Surface::Checkerboard { square, .. } => {
                let p = self.point(&t, r);
                self.is_odd(&p[0], square) != self.is_odd(&p[2], square)
            }
            _ => false,
        };
        Some(Seen { object, odd, t })
    }

    /// eye + t · r.
    pub fn point(&self, t: &N, r: &V) -> V {
        axpy(&self.eye, t, r)
    }

    /// Whether a coordinate lies in an odd row of squares.
    fn is_odd(&self, x: &N, square: &N) -> bool {
        // What is so close to an integer is that integer: 1/3 + 2/3 is not 0.999….
        let close = self.number.exact(1.0) >> (self.number.bits as isize * 3 / 14);
        let cell = (x / square + close).floor();
        (cell.to_int().value() & IBig::ONE) == IBig::ONE
    }

    /// All t > 0 at which the ray eye + t · r meets an object, in order.
    pub fn crossings(&self, index: usize, r: &V) -> Vec<N> {
        match &self.surfaces[index] {
            Surface::Sphere { f, square, c } => self.sphere(f, square, c, r),
            Surface::Triangle {
                vertices,
                normal,
                height,
                scale,
            } => self
                .plane(normal, height, r)
                .filter(|t| self.is_in_triangle(vertices, normal, scale, &self.point(t, r)))
                .into_iter()
                .collect(),
            Surface::Box { lo, hi } => self.cuboid(lo, hi, r),
            Surface::Checkerboard { height, .. } => {
                let up = [0.0, 1.0, 0.0].map(|x| self.number.exact(x));
                self.plane(&up, height, r).into_iter().collect()
            }
        }
    }

    /// The roots of a t² + 2 b t + c, of which only those count that are > 0.
    fn sphere(&self, f: &V, square: &N, c: &N, r: &V) -> Vec<N> {
        let (a, b) = (dot(r, r), dot(f, r));
        let bb = &b * &b;
        let discriminant = &bb - &a * c;
        if self.sign(&discriminant, &bb) != Ordering::Greater {
            return Vec::new();
        }
        let root = discriminant.sqrt();
        let inside = self.sign(c, square);
        [(-&b - &root) / &a, (-&b + &root) / &a]
            .into_iter()
            .enumerate()
            // On the surface itself one root is zero, whatever its rounding.
            .filter(|(i, t)| match inside {
                Ordering::Equal => *i == 1 && self.sign(&-&b, &square.sqrt()) == Ordering::Greater,
                _ => *t > N::ZERO,
            })
            .map(|(_, t)| t)
            .collect()
    }

    /// Where the ray meets the plane n·(p − eye) = height.
    fn plane(&self, n: &V, height: &N, r: &V) -> Option<N> {
        let slope = dot(n, r);
        if *height == N::ZERO || self.sign(&slope, &(size(n) * size(r))) == Ordering::Equal {
            return None;
        }
        let t = height / slope;
        (t > N::ZERO).then_some(t)
    }

    /// Whether a point of a triangle's plane lies on the inner side of each edge, or on it.
    fn is_in_triangle(&self, [a, b, c]: &[V; 3], normal: &V, scale: &N, p: &V) -> bool {
        let scale = scale + size(normal) * dot(p, p);
        [(a, b), (b, c), (c, a)].iter().all(|(a, b)| {
            let area = dot(normal, &cross(&sub(b, a), &sub(p, a)));
            self.sign(&area, &scale) != Ordering::Less
        })
    }

    /// The greatest t of the slabs' entries to the least of their exits.
    fn cuboid(&self, lo: &V, hi: &V, r: &V) -> Vec<N> {
        let mut enter: Option<N> = None;
        let mut leave: Option<N> = None;
        for axis in 0..3 {
            if self.sign(&r[axis], &size(r)) == Ordering::Equal {
                if lo[axis] > N::ZERO || hi[axis] < N::ZERO {
                    return Vec::new();
                }
                continue;
            }
            let (mut near, mut far) = (&lo[axis] / &r[axis], &hi[axis] / &r[axis]);
            if near > far {
                std::mem::swap(&mut near, &mut far);
            }
            if enter.as_ref().is_none_or(|enter| near > *enter) {
                enter = Some(near);
            }
            if leave.as_ref().is_none_or(|leave| far < *leave) {
                leave = Some(far);
            }
        }
        let (Some(enter), Some(leave)) = (enter, leave) else {
            return Vec::new();
        };
        if self.order(&enter, &leave) == Ordering::Greater {
            return Vec::new();
        }
        let mut crossings = vec![enter, leave];
        crossings.retain(|t| *t > N::ZERO);
        crossings
    }

    /// The order of two numbers, which are equal if they are equal up to a certain part of the larger one.
    fn order(&self, a: &N, b: &N) -> Ordering {
        self.sign(&(a - b), &(abs(a) + abs(b)))
    }

    fn sign(&self, x: &N, size: &N) -> Ordering {
        self.number.sign(x, size)
    }
}

impl Surface {
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
                    Outline::Centered(triangle) => (
                        number.vertices(triangle),
                        number.vector(triangle.normal),
                        number.vector(triangle.centroid),
                    ),
                    Outline::Vertices(vertices) => {
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
