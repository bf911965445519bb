//! A sampling ray tracer that uses the usual textbook formulas, and can make the mistakes of a
//! faulty program.
//!
//! In: a scene, the mistakes, an area of the picture, and a number of samples per pixel. Out: the
//! mean of each pixel in the area, and the variance of one sample in it. Both are estimated from
//! samples at fixed positions. The tracer is fast enough to compare hundreds of faulty programs
//! with a picture in a second. What is correct is decided by the exact picture, not by this tracer.

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

/// Distance from the origin, in metres, to which a box without end extends along an axis. Any value
/// far beyond the scene works.
const FAR: f64 = 1e9;

/// Stride between the samples that are tested first, to find out whether a cell has one colour. A
/// smaller stride tests more samples and takes longer. A larger one misses more small details.
const EACH: usize = 4;

/// Positions near the corners of a cell, in units of its side. A cell is assumed to have one colour
/// if these positions and every fourth sample ([`EACH`]) show one colour. An edge that passes by
/// all of these positions usually cuts off less than 0.5 % of the cell. If it is parallel to a
/// side, it may cut off 4 %.
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
    /// Bounding rectangle of the object in the picture, in pixels. No ray outside of it hits the
    /// object.
    bounds: [DVec2; 2],
    /// Decoded colours of the object. A shape with fewer than three colours repeats them.
    colors: [DVec3; 3],
}

/// A ray through a place of the picture, and what it hits.
pub struct Ray<'a> {
    place: DVec2,
    eye: DVec3,
    direction: DVec3,
    /// Factor by which the ray's parameter t is multiplied before it is compared with the near and
    /// far planes. The product is a depth, or in some faulty programs a distance from the eye.
    length: f64,
    /// Object that the ray sees, and the ray's parameter t where it hits the object; `None` for the
    /// background.
    hit: Option<(&'a Traced, f64)>,
    /// Sort key of `hit`. Of all hits of the ray, the one with the least key is seen.
    order: f64,
}

impl Ray<'_> {
    /// Returns the point with the parameter t.
    fn at(&self, t: f64) -> DVec3 {
        self.eye + t * self.direction
    }
}

/// A ray tracer with the mistakes of a faulty program, and a scene that is prepared for it.
pub struct FaultyTracer {
    projection: Projection,
    behaviour: Behaviour,
    /// Distance between corresponding samples of neighbouring pixels along x and y, in pixels of
    /// the correct picture.
    spacing: DVec2,
    /// Point of the correct picture that the top left corner of the program's picture shows, in
    /// pixels.
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
            // The picture is stretched horizontally about its middle, so the middle of each row
            // stays in place.
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

    /// Takes samples in each pixel of the area `part` of the picture. Returns their means and
    /// variances.
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
        // For each column, whether the last computed cell in it shows one colour. Cells are
        // computed row by row, from left to right. So when a cell is computed, the entry of its
        // column describes the cell above, and the entry before it describes the cell to the left.
        let mut is_flat = vec![false; part.width as usize];
        let pixel = |(x, y): (u32, u32)| {
            let column = (x - part.x) as usize;
            let is_beside = is_flat[column] || column > 0 && is_flat[column - 1];
            // A cell is assumed to have one colour if two conditions hold. All tested positions
            // (`probes`) show one colour, and the cell above or to the left has one colour, too.
            // Without the second condition, a checkerboard whose squares are half as large as a
            // cell could show one colour at all tested positions. With up to 8 samples, the test
            // would cost more than taking all samples.
            let moments = (is_beside && places.len() > 8)
                .then(|| self.cell((x, y), &probes, &mut rays))
                .filter(|probed| probed.1 == DVec3::ZERO)
                .unwrap_or_else(|| self.cell((x, y), &places, &mut rays));
            is_flat[column] = moments.1 == DVec3::ZERO;
            moments
        };
        Moments::exact(part.iter().map(pixel))
    }

    /// Converts the correct sample positions in a pixel to those of the faulty program. It may
    /// spread its samples over more or less than a pixel, so their distances from the pixel's
    /// middle are scaled.
    pub fn places(&self, places: &[DVec2]) -> Vec<DVec2> {
        let of_pixel = |place: &DVec2| 0.5 + (place - 0.5) * self.behaviour.pixel;
        places.iter().map(of_pixel).collect()
    }

    /// Returns the mean and the variance of the samples at the positions `places` of a pixel.
    /// `rays` is a buffer that is reused.
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

    /// Returns the ray through the position `place` of the picture, in pixels.
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
            // The depth at the ray's parameter t is t times the depth of the direction vector. With
            // these two kinds of rays, that depth varies. With all others, it is 1.
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
    /// object, because this is faster than the opposite order.
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

    /// Intersects rays with the object at the index `at`. Each ray keeps the hit that is seen: the
    /// one so far, or the hit of this object.
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

    /// Returns the unit normal of a shape at a point of its surface. It may point to either side of
    /// the surface.
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

    /// Intersects a ray with a sphere as the faulty program does. Returns the ray's parameters t at
    /// both intersections, the lesser first. Returns `None` if the formula gives no intersection.
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

    /// Returns whether a hit at the ray's parameter t can be seen. The product t · `length` is what
    /// the program compares with the near and far planes.
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
    /// visible. `crossings` contains t at both hits, the lesser first. The product t · `length` is
    /// what the program compares with the near and far planes.
    fn first(&self, crossings: [f64; 2], length: f64) -> Option<f64> {
        let counting = crossings.map(|t| Some(t).filter(|t| self.counts(*t, length)));
        match counting {
            [Some(one), Some(other)] if self.order(other) < self.order(one) => Some(other),
            [one, other] => one.or(other),
        }
    }
}

/// Finds the face of a box that is nearest to a point. Returns the index of the axis perpendicular
/// to the face.
fn face(Cuboid { min, max, .. }: &Cuboid, point: DVec3) -> usize {
    let off = (point - min).abs().min((point - max).abs());
    off.min_position()
}

/// Intersects a ray with a sphere by a formula that is correct only for direction vectors of length
/// 1: t = −b ± √(b² − c), the roots of t² + 2 b t + c = 0. The direction vector of the faulty
/// program reaches from the eye to the view plane, at the distance `distance`. Returns the ray's
/// parameters t at both roots, the lesser first, or `None` if there is no real root.
fn with_unit_rays(sphere: &Sphere, distance: f64, eye: DVec3, ray: DVec3) -> Option<[f64; 2]> {
    let from = eye - sphere.center;
    let b = from.dot(distance * ray);
    let c = from.length_squared() - sphere.radius * sphere.radius;
    let discriminant = b * b - c;
    (discriminant >= 0.0)
        .then(|| [-1.0, 1.0].map(|sign| distance * (sign * discriminant.sqrt() - b)))
}

/// Intersects a ray with a triangle as a faulty program does. `hit` says which tests against the
/// triangle's edges the program omits. Returns the ray's parameter t twice, because a triangle is
/// hit only once. Returns `None` if the program sees no hit.
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
/// is unbounded, or lies partly ahead of the eye and partly behind it.
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
    // The rectangle gets a margin of 1e-6 pixels for rounding errors.
    Some([least - 1e-6, most + 1e-6])
}

/// Returns a Fibonacci lattice of at least `samples` points in the unit square. If the square is
/// divided into as many rows as there are points, each row contains one point. The same is true of
/// columns. So horizontal and vertical edges are sampled evenly.
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
