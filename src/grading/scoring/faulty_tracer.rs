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

/// Places near the corners of a cell, in units of its side. A cell is assumed to have one colour if
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
    /// Fault in how rays are intersected with the object; `None` if there is no fault.
    hit: Option<HitFault>,
    /// Bounding rectangle in the picture, in pixels. No ray outside of it hits the object.
    bounds: [DVec2; 2],
    /// Decoded colours of the object. A shape with fewer than three colours repeats them.
    colors: [DVec3; 3],
}

/// A ray through a place of the picture, and what it hits.
pub struct Ray<'a> {
    place: DVec2,
    eye: DVec3,
    direction: DVec3,
    /// Depth or distance per unit of the ray's parameter t, whichever is compared with the near and
    /// far planes.
    length: f64,
    /// Object that the ray sees, and the ray's parameter t where it hits the object; `None` for the
    /// background.
    hit: Option<(&'a Traced, f64)>,
    /// Sort key of `hit`. The hit with the least key is seen.
    order: f64,
}

impl Ray<'_> {
    /// Returns the point with the parameter t.
    fn at(&self, t: f64) -> DVec3 {
        self.eye + t * self.direction
    }
}

/// A scene, prepared for tracing.
pub struct FaultyTracer {
    projection: Projection,
    behaviour: Behaviour,
    /// Distance of the samples of neighbouring pixels along x and y, in pixels of the scene.
    spacing: DVec2,
    /// Place of the scene's picture that the top left corner of the program's picture shows.
    offset: DVec2,
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
        let mut spacing = DVec2::from(behaviour.spread);
        let mut offset = DVec2::from(behaviour.offset);
        if behaviour.aspect != 1.0 {
            // The picture is stretched from the middle of its rows.
            let middle = projection.size.x / 2.0;
            spacing.x *= behaviour.aspect;
            offset.x = middle + (offset.x - middle) * behaviour.aspect;
        }
        Self {
            projection,
            behaviour,
            spacing,
            offset,
            near: scene.camera.near,
            far: scene.camera.far.unwrap_or(f64::INFINITY),
            objects: objects.collect(),
            background: decoding(scene.image.background),
        }
    }

    /// Takes samples in each pixel of a part of the picture, and returns their means and variances.
    pub fn moments(&self, part: Area, samples: usize) -> Moments {
        let places = self.places(&lattice(samples));
        let corners = self.places(&CORNERS);
        let probes: Vec<DVec2> = places
            .iter()
            .copied()
            .step_by(EACH)
            .chain(corners)
            .collect();
        let mut rays = Vec::new();
        // Whether the cell that was computed last in each column shows one colour. Cells are
        // computed row by row, from left to right. So the entry of a cell's column describes the
        // cell above, and the entry of the column to the left describes the cell to the left.
        let mut is_flat = vec![false; part.width as usize];
        let pixel = |(x, y): (u32, u32)| {
            let column = (x - part.x) as usize;
            let is_beside = is_flat[column] || column > 0 && is_flat[column - 1];
            // A cell is assumed to have one colour if all tested places show this colour, and the
            // cell above or to the left has one colour. This neighbour is required because the
            // squares of a board may be half as large as a cell, and all tested places may then
            // show one colour by chance. With up to 8 samples, all of them are taken, because the
            // test would cost more.
            let moments = (is_beside && places.len() > 8)
                .then(|| self.cell((x, y), &probes, &mut rays))
                .filter(|probed| probed.1 == DVec3::ZERO)
                .unwrap_or_else(|| self.cell((x, y), &places, &mut rays));
            is_flat[column] = moments.1 == DVec3::ZERO;
            moments
        };
        Moments::exact(part.iter().map(pixel))
    }

    /// Returns places of a pixel where the program takes samples, given where it should. A faulty
    /// program may spread its samples over more or less than a pixel, so their distances from the
    /// pixel's middle are scaled.
    pub fn places(&self, places: &[DVec2]) -> Vec<DVec2> {
        let of_pixel = |place: &DVec2| 0.5 + (place - 0.5) * self.behaviour.pixel;
        places.iter().map(of_pixel).collect()
    }

    /// Returns the mean and the variance of samples at some places of a pixel. `rays` is a buffer.
    pub fn cell<'a>(
        &'a self,
        (x, y): (u32, u32),
        places: &[DVec2],
        rays: &mut Vec<Ray<'a>>,
    ) -> (DVec3, DVec3) {
        let corner = DVec2::new(f64::from(x), f64::from(y));
        rays.clear();
        rays.extend(places.iter().map(|place| self.ray(corner + place)));
        self.trace(rays);
        // Differences from the first sample are summed, so that the mean of equal samples is
        // exact and their variance is 0.
        let first = self.color(&rays[0]);
        let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
        for ray in &rays[1..] {
            let more = self.color(ray) - first;
            (sum, squares) = (sum + more, squares + more * more);
        }
        let count = places.len() as f64;
        let more = sum / count;
        let variance = (squares / count - more * more).max(DVec3::ZERO);
        (first + more, variance)
    }

    /// Returns the ray through a place of the picture.
    fn ray(&self, place: DVec2) -> Ray<'_> {
        let place = place * self.spacing + self.offset;
        let (mut eye, mut ray) = (self.projection.eye, self.projection.ray(place));
        let ahead = self.projection.ahead;
        match self.behaviour.rays {
            Rays::Parallel(distance) => (eye, ray) = (eye + distance * (ray - ahead), ahead),
            Rays::Fisheye => {
                let across = ray - ahead;
                let angle = across.length();
                let (sin, cos) = (libm::sin(angle), libm::cos(angle));
                ray = cos * ahead + sin * across.normalize_or_zero();
            }
            _ => {}
        }
        let length = match (self.behaviour.clips_distances, self.behaviour.rays) {
            (true, _) => ray.length(),
            // Depth per unit of the ray's parameter t. In these two projections, the direction
            // vector may have any depth; in all others, it has the depth 1.
            (false, Rays::UpAsTop | Rays::Fisheye) => ray.dot(ahead),
            (false, _) => 1.0,
        };
        Ray {
            place,
            eye,
            direction: ray,
            length,
            hit: None,
            order: f64::INFINITY,
        }
    }

    /// Finds what the rays of a cell hit. All rays are intersected with one object before the next
    /// object, which is faster than the other way round.
    fn trace<'a>(&'a self, rays: &mut [Ray<'a>]) {
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for ray in &*rays {
            (least, most) = (least.min(ray.place), most.max(ray.place));
        }
        for (at, object) in self.objects.iter().enumerate() {
            let [low, high] = object.bounds;
            if most.cmplt(low).any() || least.cmpgt(high).any() {
                continue;
            }
            match (object.hit, &object.shape) {
                (_, Shape::Sphere(sphere)) => {
                    self.hit(rays, at, |ray| {
                        self.on_sphere(sphere, ray.eye, ray.direction)
                    });
                }
                (_, Shape::Checkerboard(board)) => {
                    let normal = self.behaviour.board_normal;
                    let reach = self.behaviour.board_reach;
                    self.hit(rays, at, |ray| {
                        let t = (board.y - ray.eye[normal]) / ray.direction[normal];
                        let is_on_it = || {
                            let [x, z] = self.on_board(ray.at(t));
                            x.abs().max(z.abs()) < reach
                        };
                        (reach.is_infinite() || is_on_it()).then_some([t; 2])
                    });
                }
                (Some(hit), Shape::Triangle(triangle)) => {
                    let vertices = vertices(&triangle.outline);
                    self.hit(rays, at, |ray| {
                        on_plane(&vertices, hit, ray.eye, ray.direction)
                    });
                }
                (_, shape) => {
                    self.hit(rays, at, |ray| {
                        crossings(shape, ray.eye, ray.direction, 0.0)
                    });
                }
            }
        }
    }

    /// Intersects rays with the object at an index. Rays that see it before the objects that they
    /// hit so far hit it now.
    fn hit<'a>(
        &'a self,
        rays: &mut [Ray<'a>],
        at: usize,
        crossings: impl Fn(&Ray) -> Option<[f64; 2]>,
    ) {
        let object = &self.objects[at];
        for ray in rays {
            let first = |crossings| self.first(crossings, ray.length);
            let Some(t) = crossings(ray).and_then(first) else {
                continue;
            };
            let order = match self.behaviour.visible {
                SeenSurface::First => at as f64,
                SeenSurface::Last => -(at as f64),
                SeenSurface::Farthest => -t,
                _ => self.order(t),
            };
            if order < ray.order {
                (ray.hit, ray.order) = (Some((object, t)), order);
            }
        }
    }

    /// Returns the colour that a ray sees.
    fn color(&self, ray: &Ray) -> DVec3 {
        let Some((object, t)) = ray.hit else {
            return self.background;
        };
        let color = match object.shape {
            Shape::Checkerboard(Checkerboard { square, .. }) => {
                let [x, z] = self.on_board(ray.at(t)).map(|at| at / square);
                usize::from(!(self.behaviour.square_rule.0)(x, z))
            }
            Shape::Box(ref cuboid) => face(cuboid, ray.at(t)),
            Shape::Sphere(_) | Shape::Triangle(_) => 0,
        };
        let normal = || self.normal(&object.shape, ray.at(t));
        let shade = match self.behaviour.shading {
            Shading::None => return object.colors[color],
            Shading::OfRay => normal().dot(ray.direction.normalize()).abs(),
            Shading::To(light) => {
                let normal = normal();
                -normal.dot(ray.direction).signum() * normal.dot(light)
            }
        };
        shade.max(0.0) * object.colors[color]
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
    /// parameters t at both intersections, the lesser first. Returns `None` if the formula gives no
    /// intersection.
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
    /// visible. `crossings` contains t at both hits, the lesser first. `length` is the depth or the
    /// distance per unit of t, whichever the program compares with the near and far planes.
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
/// view plane, which is `distance` from the eye. Returns the ray's parameters t at both roots, the
/// lesser first, or `None` if there is no real root.
fn with_unit_rays(sphere: &Sphere, distance: f64, eye: DVec3, ray: DVec3) -> Option<[f64; 2]> {
    let from = eye - sphere.center;
    let b = from.dot(distance * ray);
    let c = from.length_squared() - sphere.radius * sphere.radius;
    let discriminant = b * b - c;
    (discriminant >= 0.0)
        .then(|| [-1.0, 1.0].map(|sign| distance * (sign * discriminant.sqrt() - b)))
}

/// Intersects a ray with the plane of a triangle, without the tests against the triangle's edges
/// that `hit` omits. Returns the ray's parameter t twice, or `None` if the program misses the
/// triangle.
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
pub fn lattice(samples: usize) -> Vec<DVec2> {
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
