//! What is seen at a sample point by the formulas of a textbook, in 1400-bit arithmetic.
//!
//! Nothing here is shared with the tracer: world coordinates instead of the view plane, the quadratic formula, barycentric
//! coordinates and slabs with divisions. A number below 2^−500 of its terms counts as zero.

use std::cmp::Ordering;

use dashu_float::{FBig, round::mode::HalfEven};
use glam::{DVec2, DVec3};
use pinhole::scene::{Checkerboard, Cuboid, Lens, Scene, Shape, Sphere, Triangle, View};

pub type N = FBig<HalfEven, 2>;
pub type V = [N; 3];

const PRECISION: usize = 1400;

fn n(x: f64) -> N {
    N::try_from(x).unwrap().with_precision(PRECISION).value()
}

fn v(x: DVec3) -> V {
    x.to_array().map(n)
}

fn sub(a: &V, b: &V) -> V {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

fn axpy(a: &V, k: &N, b: &V) -> V {
    [0, 1, 2].map(|i| &a[i] + k * &b[i])
}

fn scale(k: &N, a: &V) -> V {
    [0, 1, 2].map(|i| k * &a[i])
}

fn dot(a: &V, b: &V) -> N {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &V, b: &V) -> V {
    [
        &a[1] * &b[2] - &a[2] * &b[1],
        &a[2] * &b[0] - &a[0] * &b[2],
        &a[0] * &b[1] - &a[1] * &b[0],
    ]
}

/// The length of a vector.
pub fn length(a: &V) -> N {
    dot(a, a).sqrt()
}

fn unit(a: &V) -> V {
    let length = length(a);
    [0, 1, 2].map(|i| &a[i] / &length)
}

fn abs(x: &N) -> N {
    if *x < N::ZERO { -x.clone() } else { x.clone() }
}

/// The sign of a difference, with equality up to 2^−500 of the larger one.
fn order(a: &N, b: &N) -> Ordering {
    let difference = a - b;
    let size = abs(a) + abs(b);
    if abs(&difference) <= size >> 500 {
        Ordering::Equal
    } else {
        a.partial_cmp(b).unwrap()
    }
}

fn sign(x: &N, size: &N) -> Ordering {
    order(&(x + size), size)
}

/// Sine and cosine of an angle that is a plain number of degrees plus one of radians.
fn sin_cos(angle: pinhole::math::Angle) -> (N, N) {
    let (s, c) = n(angle.degrees).sin_cos_unit(360);
    if angle.radians == 0.0 {
        return (s, c);
    }
    let (t, d) = n(angle.radians).sin_cos();
    (&s * &d + &c * &t, c * d - s * t)
}

/// The eye and the direction of the ray through a sample point.
pub fn ray(scene: &Scene, x: u32, y: u32, offset: DVec2) -> (V, V) {
    let camera = &scene.camera;
    let eye = v(camera.eye);
    let forward = match camera.view {
        View::Lookat(at) => sub(&v(at), &eye),
        View::Direction(direction) => v(direction),
    };
    let w = scale(&n(-1.0), &unit(&forward));
    let across = cross(&v(camera.up), &w);
    let u = unit(&across);
    let top = cross(&w, &u);
    let (s, c) = sin_cos(camera.roll);
    let rolled_u = axpy(&scale(&c, &u), &-s.clone(), &top);
    let rolled_v = axpy(&scale(&s, &u), &c, &top);
    let d = match camera.lens {
        Lens::Distance(d) => n(d),
        Lens::Fov(angle) => {
            let (s, c) = sin_cos(angle * 0.5);
            n(camera.view_height) * c / (n(2.0) * s)
        }
    };
    let pixel = n(camera.view_height) / n(f64::from(scene.image.height));
    let half = n(0.5);
    let px = n(f64::from(x)) + &half + n(offset.x) - n(f64::from(scene.image.width)) * &half;
    let py = n(f64::from(scene.image.height)) * &half - n(f64::from(y)) - &half - n(offset.y);
    let direction = axpy(
        &axpy(&scale(&(&pixel * px), &rolled_u), &(&pixel * py), &rolled_v),
        &-d,
        &w,
    );
    (eye, direction)
}

/// All t > 0 at which the ray e + t·r meets a shape, in order.
pub fn crossings(shape: &Shape, e: &V, r: &V) -> Vec<N> {
    match *shape {
        Shape::Sphere(Sphere { center, radius, .. }) => {
            let f = sub(e, &v(center));
            let a = dot(r, r);
            let b = dot(&f, r);
            let ff = dot(&f, &f);
            let rr = n(radius) * n(radius);
            let c = &ff - &rr;
            let discriminant = &b * &b - &a * &c;
            if sign(&discriminant, &(&b * &b)) != Ordering::Greater {
                return Vec::new();
            }
            let root = discriminant.sqrt();
            let inside = sign(&c, &ff);
            [(-&b - &root) / &a, (-&b + &root) / &a]
                .into_iter()
                .enumerate()
                // On the surface itself one root is zero, whatever its rounding.
                .filter(|(i, t)| match inside {
                    Ordering::Equal => *i == 1 && sign(&-&b, &ff.sqrt()) == Ordering::Greater,
                    _ => *t > N::ZERO,
                })
                .map(|(_, t)| t)
                .collect()
        }
        Shape::Triangle(Triangle {
            centroid,
            normal,
            sides,
            spin,
            ..
        }) => {
            let [a, b, c] = vertices(centroid, normal, sides, spin);
            let normal = v(normal);
            let h = sub(&a, e);
            let (num, den) = (dot(&normal, &sub(&v(centroid), e)), dot(&normal, r));
            let size = dot(&normal, &normal).sqrt() * dot(&h, &h).sqrt();
            if sign(&num, &size) == Ordering::Equal
                || sign(&den, &(dot(&normal, &normal) * dot(r, r)).sqrt()) == Ordering::Equal
            {
                return Vec::new();
            }
            let t = num / den;
            if t <= N::ZERO {
                return Vec::new();
            }
            let p = axpy(e, &t, r);
            let scale = dot(&normal, &normal).sqrt()
                * (dot(&p, &p) + dot(&a, &a) + dot(&b, &b) + dot(&c, &c));
            let inside = [(&a, &b), (&b, &c), (&c, &a)].iter().all(|(a, b)| {
                let area = dot(&normal, &cross(&sub(b, a), &sub(&p, a)));
                sign(&area, &scale) != Ordering::Less
            });
            if inside { vec![t] } else { Vec::new() }
        }
        Shape::Box(Cuboid { min, max, .. }) => {
            let (mut enter, mut leave): (Option<N>, Option<N>) = (None, None);
            for axis in 0..3 {
                let (lo, hi) = (n(min[axis]) - &e[axis], n(max[axis]) - &e[axis]);
                if sign(&r[axis], &dot(r, r).sqrt()) == Ordering::Equal {
                    if lo > N::ZERO || hi < N::ZERO {
                        return Vec::new();
                    }
                    continue;
                }
                let (mut near, mut far) = (lo / &r[axis], hi / &r[axis]);
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
            let (enter, leave) = (enter.unwrap(), leave.unwrap());
            if order(&enter, &leave) == Ordering::Greater {
                return Vec::new();
            }
            [enter, leave]
                .into_iter()
                .filter(|t| *t > N::ZERO)
                .collect()
        }
        Shape::Checkerboard(Checkerboard { y, .. }) => {
            let h = n(y) - &e[1];
            if h == N::ZERO || sign(&r[1], &dot(r, r).sqrt()) == Ordering::Equal {
                return Vec::new();
            }
            let t = h / &r[1];
            if t > N::ZERO { vec![t] } else { Vec::new() }
        }
    }
}

/// A triangle's vertices: left base end, right base end, apex.
pub fn vertices(
    centroid: DVec3,
    normal: DVec3,
    sides: DVec3,
    spin: pinhole::math::Angle,
) -> [V; 3] {
    let unit_normal = unit(&v(normal));
    let reference = if normal.x == 0.0 && normal.z == 0.0 {
        v(DVec3::NEG_Z)
    } else {
        v(DVec3::Y)
    };
    let right = unit(&cross(&reference, &unit_normal));
    let top = cross(&unit_normal, &right);
    // The law of cosines at the left end, then a turn of everything about the centroid.
    let [a, b, c] = sides.to_array().map(n);
    let cos = (&a * &a + &c * &c - &b * &b) / (n(2.0) * &a * &c);
    let sin = (n(1.0) - &cos * &cos).sqrt();
    let corners = [(n(0.0), n(0.0)), (c, n(0.0)), (&a * cos, &a * sin)];
    let mean = |pick: fn(&(N, N)) -> &N| {
        (pick(&corners[0]) + pick(&corners[1]) + pick(&corners[2])) / n(3.0)
    };
    let (mean_x, mean_y) = (mean(|p| &p.0), mean(|p| &p.1));
    let (s, k) = sin_cos(spin);
    corners.map(|(x, y)| {
        let (x, y) = (x - &mean_x, y - &mean_y);
        let turned = (&k * &x - &s * &y, &s * &x + &k * &y);
        axpy(&axpy(&v(centroid), &turned.0, &right), &turned.1, &top)
    })
}

/// The object that is seen at a sample point, and whether a checkerboard shows its second colour there.
pub fn seen(scene: &Scene, x: u32, y: u32, offset: DVec2) -> Option<(usize, bool)> {
    let (e, r) = ray(scene, x, y, offset);
    let forward = match scene.camera.view {
        View::Lookat(at) => sub(&v(at), &e),
        View::Direction(direction) => v(direction),
    };
    let ahead = dot(&r, &unit(&forward));
    let mut best: Option<(usize, N)> = None;
    for (index, object) in scene.objects.iter().enumerate() {
        let visible = crossings(&object.shape, &e, &r).into_iter().find(|t| {
            let depth = t * &ahead;
            order(&depth, &n(scene.camera.near)) == Ordering::Greater
                && scene
                    .camera
                    .far
                    .is_none_or(|far| order(&depth, &n(far)) == Ordering::Less)
        });
        if let Some(t) = visible
            && best
                .as_ref()
                .is_none_or(|(_, nearest)| order(&t, nearest) == Ordering::Less)
        {
            best = Some((index, t));
        }
    }
    let (index, t) = best?;
    let odd = match scene.objects[index].shape {
        Shape::Checkerboard(Checkerboard { square, .. }) => {
            let p = axpy(&e, &t, &r);
            let parity = |x: &N| {
                // An integer up to 2^−300 is that integer: 1/3 + 2/3 is not 0.999….
                let cell = (x / n(square) + (n(1.0) >> 300)).floor();
                (cell.to_int().value() & dashu_int::IBig::ONE) == dashu_int::IBig::ONE
            };
            parity(&p[0]) != parity(&p[2])
        }
        _ => false,
    };
    Some((index, odd))
}
