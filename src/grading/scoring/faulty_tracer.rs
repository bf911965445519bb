//! A sampling ray tracer that follows the formulas of textbooks. Mistakes in it can be switched on.
//!
//! In: a scene, the mistakes, a part of its picture, and a number of samples per pixel. Out: the
//! mean of each pixel in the part, and the variance of one sample in it, both estimated from
//! samples at fixed places. The tracer is fast enough to compare hundreds of faulty programs with a
//! picture in a second. It does not decide what is correct; the exact picture does.

use glam::{DVec2, DVec3};

use super::moments::Moments;
use crate::{
    area::Area,
    color::Color,
    grading::hypotheses::{Behaviour, Curve, HitFault, Rays, SeenSurface, Shading, Spheres},
    projection::Projection,
    reference::formulas::{by_vertices, corners, crossings, radians, vertices},
    scene::{Checkerboard, Cuboid, Scene, Shape, Sphere},
};

/// Distance from the origin, in metres, to which a box reaches along an axis if two of its faces
/// are missing. It should reach to infinity, so any value far beyond the scene works.
const FAR: f64 = 1e9;

/// Stride between the samples that are tested first, to find out whether a cell has one colour. A
/// smaller stride tests more samples, which takes longer; a larger one misses more small details.
const EACH: usize = 4;

/// Places near the corners of a cell, in units of its side. A cell counts as having one colour if
/// these places and every fourth sample (`EACH`) show one colour. In most directions, an edge that
/// misses all of them cuts off less than 0.5 % of the cell. An edge parallel to a side may cut off
/// 4 %.
const CORNERS: [DVec2; 4] = [
    DVec2::new(0.04, 0.04),
    DVec2::new(0.96, 0.96),
    DVec2::new(0.96, 0.04),
    DVec2::new(0.04, 0.96),
];

/// An object, prepared for tracing.
struct Traced {
    shape: Shape,
    /// Fault in how rays are intersected with the object.
    hit: Option<HitFault>,
    /// Bounding rectangle in the picture, in pixels. No ray outside of it hits the object.
    bounds: [DVec2; 2],
    /// Decoded colours of the object. A shape with fewer than three colours repeats them.
    colors: [DVec3; 3],
}

/// A scene, prepared for tracing.
pub struct FaultyTracer {
    projection: Projection,
    behaviour: Behaviour,
    near: f64,
    far: f64,
    objects: Vec<Traced>,
    /// Decoded colour of the background.
    background: DVec3,
}

impl FaultyTracer {
    /// Prepares a scene for tracing. `behaviour` says which mistakes the tracer makes. `decoding`
    /// is the curve by which the tracer decodes colours.
    pub fn new(scene: &Scene, behaviour: Behaviour, decoding: Curve) -> Self {
        let mut projection = Projection::quick(&scene.camera, &scene.image);
        let right_projection = projection;
        let is_in_place = matches!(behaviour.rays, Rays::Correct)
            && behaviour.aspect == 1.0
            && !matches!(behaviour.spheres, Spheres::UnitRays(_));
        let angle = radians(scene.camera.roll);
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let unrolled = cos * projection.right + sin * projection.top;
        let top = cos * projection.top - sin * projection.right;
        match behaviour.rays {
            Rays::Correct | Rays::Parallel(_) | Rays::Fisheye => {}
            Rays::RightAlone => projection.top = top,
            Rays::UpAsTop => {
                let up = scene.camera.up.normalize_or(top);
                projection.right = cos * unrolled - sin * up;
                projection.top = sin * unrolled + cos * up;
            }
            Rays::NewRight => projection.top = sin * projection.right + cos * top,
        }
        let decoding =
            |color: Color| DVec3::from(color.to_linear()).map(|light| decoding.light(light));
        let objects = scene.objects.iter().enumerate().map(|(at, object)| {
            let mut shape = by_vertices(object.shape);
            let hit = behaviour.hit.filter(|hit| hit.0 == at).map(|hit| hit.1);
            if let (Some(HitFault::WithoutAxis(axis)), Shape::Box(cuboid)) = (hit, &mut shape) {
                (cuboid.min[axis], cuboid.max[axis]) = (-FAR, FAR);
            }
            let bounds = bounds(&shape, &right_projection).filter(|_| is_in_place && hit.is_none());
            Traced {
                shape,
                hit,
                bounds: bounds.unwrap_or([DVec2::NEG_INFINITY, DVec2::INFINITY]),
                colors: shape.colors().map(decoding),
            }
        });
        Self {
            projection,
            behaviour,
            near: scene.camera.near,
            far: scene.camera.far.unwrap_or(f64::INFINITY),
            objects: objects.collect(),
            background: decoding(scene.image.background),
        }
    }

    /// Takes samples in each pixel of a part of the picture, and returns their means and variances.
    pub fn moments(&self, part: Area, samples: usize) -> Moments {
        // The faulty program may spread its samples over more or less than a pixel, so their
        // distances from the pixel's middle are scaled.
        let of_pixel = |place: DVec2| 0.5 + (place - 0.5) * self.behaviour.pixel;
        let places: Vec<DVec2> = lattice(samples).into_iter().map(of_pixel).collect();
        let corners = CORNERS.map(of_pixel);
        let count = places.len() as f64;
        // Whether the cell that was computed last in each column shows one colour. Cells are
        // computed row by row. So the entry of a cell's own column belongs to the cell above, and
        // the entry of the column before to the cell on the left.
        let mut is_flat = vec![false; part.width as usize];
        let pixel = |(x, y): (u32, u32)| {
            let corner = DVec2::new(f64::from(x), f64::from(y));
            // Differences from the first sample are summed, so that the mean of equal samples is
            // exact and their variance is 0.
            let first = self.color(corner + places[0]);
            let column = (x - part.x) as usize;
            let is_beside = is_flat[column] || column > 0 && is_flat[column - 1];
            // A cell is assumed to have one colour if all tested places show this colour, and the
            // cell above or to the left has one colour. This neighbour is required because the
            // squares of a board may be half as large as a cell, and all tested places may then
            // show one colour by chance. With up to 8 samples, all of them are taken, because the
            // test would cost more.
            let mut probes = corners.iter().chain(places.iter().step_by(EACH));
            let is_first = |probe: &DVec2| self.color(corner + *probe) == first;
            if is_beside && places.len() > 8 && probes.all(is_first) {
                is_flat[column] = true;
                return (first, DVec3::ZERO);
            }
            let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
            for &place in &places[1..] {
                let more = self.color(corner + place) - first;
                (sum, squares) = (sum + more, squares + more * more);
            }
            let more = sum / count;
            is_flat[column] = squares == DVec3::ZERO;
            (
                first + more,
                (squares / count - more * more).max(DVec3::ZERO),
            )
        };
        Moments::exact(part.iter().map(pixel))
    }

    fn color(&self, place: DVec2) -> DVec3 {
        let [spread, offset] = [self.behaviour.spread, self.behaviour.offset].map(DVec2::from);
        let place = place * spread + offset;
        let middle = self.projection.size.x / 2.0;
        let x = match self.behaviour.aspect {
            1.0 => place.x,
            aspect => middle + (place.x - middle) * aspect,
        };
        let moved = DVec2::new(x, place.y);
        self.color_at(moved).unwrap_or(self.background)
    }

    /// Returns the colour that is seen at a place of the picture. Returns `None` for the
    /// background.
    fn color_at(&self, place: DVec2) -> Option<DVec3> {
        let (mut eye, mut ray) = (self.projection.eye, self.projection.ray(place));
        if let Rays::Parallel(distance) = self.behaviour.rays {
            let ahead = self.projection.ahead;
            (eye, ray) = (eye + distance * (ray - ahead), ahead);
        }
        if self.behaviour.rays == Rays::Fisheye {
            let across = ray - self.projection.ahead;
            let angle = across.length();
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            ray = cos * self.projection.ahead + sin * across.normalize_or_zero();
        }
        let length = match (self.behaviour.clips_distances, self.behaviour.rays) {
            (true, _) => ray.length(),
            // Depth per unit of the ray's parameter t. The direction vectors of all other kinds of
            // rays have the depth 1.
            (false, Rays::UpAsTop | Rays::Fisheye) => ray.dot(self.projection.ahead),
            (false, _) => 1.0,
        };
        let mut best: Option<(&Traced, f64, f64)> = None;
        for (at, object) in self.objects.iter().enumerate() {
            let [least, most] = object.bounds;
            if place.x < least.x || place.x > most.x || place.y < least.y || place.y > most.y {
                continue;
            }
            let crossings = match (object.hit, &object.shape) {
                (_, Shape::Sphere(sphere)) => self.on_sphere(sphere, eye, ray),
                (_, Shape::Checkerboard(board)) => {
                    let normal = self.behaviour.board_normal;
                    let t = (board.y - eye[normal]) / ray[normal];
                    let [x, z] = self.on_board(eye + t * ray);
                    let is_on_it = x.abs().max(z.abs()) < self.behaviour.board_reach;
                    is_on_it.then_some([t; 2])
                }
                (Some(hit), Shape::Triangle(triangle)) => {
                    on_plane(&vertices(&triangle.outline), hit, eye, ray)
                }
                _ => crossings(&object.shape, eye, ray, 0.0),
            };
            let first = |crossings| self.first(crossings, length);
            let Some(t) = crossings.and_then(first) else {
                continue;
            };
            let order = match self.behaviour.visible {
                SeenSurface::First => at as f64,
                SeenSurface::Last => -(at as f64),
                SeenSurface::Farthest => -t,
                _ => self.order(t),
            };
            if best.is_none_or(|(_, _, least)| order < least) {
                best = Some((object, t, order));
            }
        }
        let (object, t, _) = best?;
        let point = eye + t * ray;
        let color = match object.shape {
            Shape::Checkerboard(Checkerboard { square, .. }) => {
                let [x, z] = self.on_board(point).map(|at| at / square);
                usize::from(!(self.behaviour.square_rule.0)(x, z))
            }
            Shape::Box(ref cuboid) => face(cuboid, point),
            Shape::Sphere(_) | Shape::Triangle(_) => 0,
        };
        let shade = match self.behaviour.shading {
            Shading::None => return Some(object.colors[color]),
            Shading::OfRay => self.normal(&object.shape, point).dot(ray.normalize()).abs(),
            Shading::To(light) => {
                let normal = self.normal(&object.shape, point);
                -normal.dot(ray).signum() * normal.dot(light)
            }
        };
        Some(shade.max(0.0) * object.colors[color])
    }

    /// Returns a unit normal of a shape at a point of its surface. It may point to either side.
    fn normal(&self, shape: &Shape, point: DVec3) -> DVec3 {
        match shape {
            Shape::Sphere(Sphere { center, .. }) => (point - center).normalize(),
            Shape::Triangle(triangle) => {
                let [a, b, c] = vertices(&triangle.outline);
                (b - a).cross(c - a).normalize()
            }
            Shape::Box(cuboid) => DVec3::AXES[face(cuboid, point)],
            Shape::Checkerboard(_) => DVec3::AXES[self.behaviour.board_normal],
        }
    }

    /// Returns the two coordinates of a point along the axes of a checkerboard, in metres.
    fn on_board(&self, point: DVec3) -> [f64; 2] {
        let [x, z] = [0, 3 - self.behaviour.board_normal];
        [point[x], point[z]]
    }

    /// Intersects a ray with a sphere by the formula of the faulty program. Returns the ray's
    /// parameters t at both intersections, the lesser first.
    fn on_sphere(&self, sphere: &Sphere, eye: DVec3, ray: DVec3) -> Option<[f64; 2]> {
        let roots = || crossings(&Shape::Sphere(*sphere), eye, ray, 0.0);
        match self.behaviour.spheres {
            Spheres::Correct => roots(),
            Spheres::UnitRays(distance) => with_unit_rays(sphere, distance, eye, ray),
            Spheres::LesserRoot => roots().map(|[lesser, _]| [lesser; 2]),
            Spheres::GreaterRoot => roots().map(|[_, greater]| [greater; 2]),
            Spheres::TimesA(distance) => {
                let a = distance * distance * ray.length_squared();
                roots().map(|roots| roots.map(|t| a * a * t))
            }
        }
    }

    /// Returns whether a hit at the ray's parameter t can be seen. `length` is the depth or the
    /// distance per unit of t, whichever is compared with the near and far planes.
    fn counts(&self, t: f64, length: f64) -> bool {
        let is_ahead = t > 0.0 && t * length > self.near && t * length < self.far;
        is_ahead || (self.behaviour.sees_behind() && t < 0.0 && -t < self.far)
    }

    /// Returns a sort key for a hit at the ray's parameter t. The hit with the least key is seen.
    fn order(&self, t: f64) -> f64 {
        match self.behaviour.visible {
            SeenSurface::NearestBothWays => t.abs(),
            _ => t,
        }
    }

    /// Returns the ray's parameter t at the visible hit of one object, or `None` if no hit is
    /// visible. `crossings` contains t at both hits, the lesser first. `length` is the increase of
    /// depth per unit of t. If the near and far planes are compared with distances, it is the
    /// increase of distance.
    fn first(&self, crossings: [f64; 2], length: f64) -> Option<f64> {
        let counting = crossings.map(|t| Some(t).filter(|t| self.counts(*t, length)));
        match counting {
            [Some(one), Some(other)] if self.order(other) < self.order(one) => Some(other),
            [one, other] => one.or(other),
        }
    }
}

/// Returns the axis perpendicular to the face of a box that is nearest to a point.
fn face(Cuboid { min, max, .. }: &Cuboid, point: DVec3) -> usize {
    let off = (point - min).abs().min((point - max).abs());
    off.min_position()
}

/// Intersects a ray with a sphere as a faulty program does. Its formula −b ± √(b² − c), the roots
/// of t² + 2 b t + c = 0, is correct only for rays of length 1, but here the ray reaches to the
/// view plane, which is `distance` from the eye.
fn with_unit_rays(sphere: &Sphere, distance: f64, eye: DVec3, ray: DVec3) -> Option<[f64; 2]> {
    let from = eye - sphere.center;
    let b = from.dot(distance * ray);
    let c = from.length_squared() - sphere.radius * sphere.radius;
    let discriminant = b * b - c;
    (discriminant >= 0.0)
        .then(|| [-1.0, 1.0].map(|sign| distance * (sign * discriminant.sqrt() - b)))
}

/// Intersects a ray with a triangle. The fault says which tests against the triangle's edges are
/// missing.
fn on_plane([a, b, c]: &[DVec3; 3], hit: HitFault, eye: DVec3, ray: DVec3) -> Option<[f64; 2]> {
    let (one, other) = (b - a, c - a);
    let normal = one.cross(other);
    let t = (a - eye).dot(normal) / ray.dot(normal);
    let point = eye + t * ray - a;
    let x = point.cross(other).dot(normal) / normal.length_squared();
    let y = one.cross(point).dot(normal) / normal.length_squared();
    let is_within = match hit {
        HitFault::Parallelogram => (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y),
        HitFault::WithoutEdge(edge) => {
            let inside = [x, y, 1.0 - x - y];
            (0..3).all(|i| i == edge || inside[i] >= 0.0)
        }
        HitFault::WithoutAxis(_) => false,
    };
    is_within.then_some([t; 2])
}

/// Returns the bounding rectangle of a shape in the picture, in pixels. Returns `None` if the shape
/// is unbounded, or reaches from ahead of the eye to behind it.
pub fn bounds(shape: &Shape, projection: &Projection) -> Option<[DVec2; 2]> {
    let [min, max] = shape.bounding_box(|triangle| vertices(&triangle.outline))?;
    let corners = corners(min, max);
    let depths = corners.map(|corner| projection.depth(corner));
    let is_on_one_side = |depth: &f64| *depth != 0.0 && (depths[0] > 0.0) == (*depth > 0.0);
    let places = corners.map(|corner| projection.projected(corner));
    let are_finite = places.iter().all(|place| place.is_finite());
    if !depths.iter().all(is_on_one_side) || !are_finite {
        return None;
    }
    let least = places.into_iter().fold(DVec2::INFINITY, DVec2::min);
    let most = places.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
    // A margin for rounding errors is added on all sides.
    Some([least - 1e-6, most + 1e-6])
}

/// Returns a Fibonacci lattice of at least `samples` points in the unit square. If the square is
/// cut into as many rows, or columns, as there are points, each of them contains one point. So
/// edges along rows and columns are sampled evenly.
fn lattice(samples: usize) -> Vec<DVec2> {
    let (mut step, mut count) = (1, 1);
    while count < samples {
        (step, count) = (count, step + count);
    }
    let place = |i: usize| {
        let of = |k: usize| (k % count) as f64 + 0.5;
        DVec2::new(of(i), of(i * step)) / count as f64
    };
    (0..count).map(place).collect()
}
