//! Compares the quadtree's answers with those of a plain loop over all objects. The scenes contain
//! hard cases for the objects' bounds.

use std::{cmp::Ordering, sync::Arc};

use glam::{DVec2, DVec3, dvec2, dvec3};
use rand::{Rng, RngExt, SeedableRng};

use super::{
    VisibilityCandidate, World,
    bounds2d::Extent,
    candidates,
    local_form::Patch,
    object::Object,
    world::{Geometry, Precision},
};
use crate::{
    area::Area,
    math::{Ball, Big, Double},
    reference::scenes::{SIZE, board, camera, cuboid, scene, sphere, spun, triangle},
    sampling::CounterRng,
    scene::{self, Camera, Scene, Shape},
};

/// A generator of random scenes and points, the same in each run.
struct SceneGenerator(CounterRng);

impl SceneGenerator {
    fn new(seed: u64) -> Self {
        Self(CounterRng::seed_from_u64(seed))
    }

    fn below(&mut self, end: usize) -> usize {
        (self.0.next_u64() % end as u64) as usize
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    fn vector(&mut self, size: f64) -> DVec3 {
        let mut one = || self.within(-size, size);
        dvec3(one(), one(), one())
    }

    /// Returns a random length from very small to very large.
    fn length(&mut self) -> f64 {
        libm::exp2(self.within(-12.0, 4.0))
    }

    /// Returns an object at a random position: in front of the eye, behind it, around it, or
    /// touching it.
    fn shape(&mut self, eye: DVec3) -> Shape {
        let at = eye + self.vector(12.0);
        let size = dvec3(self.length(), self.length(), self.length());
        match self.below(12) {
            0 => board(self.within(-3.0, 3.0), self.length()),
            1 => spun(
                at,
                self.vector(1.0),
                DVec3::splat(size.x),
                self.within(0.0, 360.0),
            ),
            // A triangle in a plane that contains the eye, so that it is seen edge-on.
            2 => triangle(
                eye + dvec3(1.0, 0.0, -2.0),
                dvec3(0.0, 1.0, 0.0),
                DVec3::splat(1.0),
            ),
            3 | 4 => triangle(at, self.vector(1.0), dvec3(2.0, 2.0, 1.0) * size.x),
            5 | 6 => cuboid(at - size, at + size),
            // The eye lies in the plane of a box's face in case 7, on the surface of a sphere in
            // case 8, and inside a sphere in case 9.
            7 => cuboid(dvec3(eye.x, at.y, at.z), dvec3(eye.x, at.y, at.z) + size),
            8 => sphere(eye + dvec3(0.0, 0.0, -size.x), size.x),
            9 => sphere(eye + size * 0.25, size.max_element()),
            _ => sphere(at, size.x),
        }
    }

    /// Returns a scene of random objects, some of them twice.
    fn scene(&mut self, objects: usize) -> Scene {
        let eye = self.vector(2.0);
        let mut shapes: Vec<Shape> = Vec::new();
        for _ in 0..objects {
            let shape = match self.below(4) {
                0 if !shapes.is_empty() => shapes[self.below(shapes.len())],
                _ => self.shape(eye),
            };
            // Most objects that would hide everything else are left out, because little would be
            // left to compare.
            let hides = matches!(shape, Shape::Sphere(shape) if shape.radius > 3.0);
            if !hides || self.below(8) == 0 {
                shapes.push(shape);
            }
        }
        let clipped = self.below(2) == 0;
        let camera = Camera {
            near: if clipped { 1.0 } else { 0.0 },
            far: clipped.then_some(9.0),
            ..camera(eye, eye + self.vector(1.0))
        };
        scene(camera, &shapes)
    }

    fn point(&mut self) -> Sample {
        let [x, y] = [0, 1].map(|_| self.below(SIZE as usize) as u32);
        let offset = dvec2(self.within(-0.5, 0.5), self.within(-0.5, 0.5));
        (x, y, offset)
    }
}

/// The column and row of a pixel, and an offset from its centre.
type Sample = (u32, u32, DVec2);

/// Returns the palette index of the colour that is seen at a sample point, by the plain loop over
/// all objects.
fn plain(world: &World, (x, y, offset): Sample) -> usize {
    world.color_index_among(x, y, offset, 0..world.object_count())
}

/// Returns the palette index of the colour that is seen at a sample point, decided in the precision
/// `T` alone. Returns `None` if the decision is uncertain in this precision.
fn color_index_by<T: Precision>(world: &World, (x, y, offset): Sample) -> Option<usize> {
    let point = world.geometry.fast.camera.sample_point(x, y, offset);
    let r = T::frame(&world.geometry).camera.direction(&point);
    let seen = world.seen(&r, 0..world.object_count()).ok()?;
    Some(world.color_index(seen))
}

/// Returns the sample at a point of the view plane. Returns `None` if the point is outside of the
/// picture.
fn sample_of(world: &World, at: DVec2) -> Option<Sample> {
    let pixels = at / world.geometry.fast.camera.pitch + f64::from(SIZE) / 2.0;
    let floor = pixels.floor();
    let is_within = floor.min_element() >= 0.0 && floor.max_element() < f64::from(SIZE);
    is_within.then(|| (floor.x as u32, floor.y as u32, pixels - floor - 0.5))
}

fn extents(world: &World, scene: &Scene) -> Vec<Option<Extent>> {
    let (double, fast) = (&world.geometry.double.camera, &world.geometry.fast.camera);
    let extent = |object: &scene::Object| Object::with_extent(double, fast, &object.shape, None).1;
    scene.objects.iter().map(extent).collect()
}

#[test]
fn the_quadtree_changes_nothing() {
    for seed in 0..60 {
        let mut random = SceneGenerator::new(seed);
        let scene = random.scene(3 + seed as usize * 4);
        let world = World::new(&scene);
        let mut points: Vec<_> = (0..150).map(|_| random.point()).collect();
        // The samples include points on the edges of the objects' bounds, or a few roundings away
        // from these edges.
        for Extent { across, .. } in extents(&world, &scene).into_iter().flatten() {
            for _ in 0..2 {
                let [x, y] = across.map(|range| match random.below(3) {
                    0 => range.low,
                    1 => range.high,
                    _ => random.within(range.low.max(-1.0), range.high.min(1.0)),
                });
                let nudge = 1.0 + random.within(-8.0, 8.0) * f64::EPSILON;
                points.extend(sample_of(&world, dvec2(x, y) * nudge));
            }
        }
        for point in points {
            let (x, y, offset) = point;
            let found = world.color_index_at(x, y, offset);
            assert_eq!(found, plain(&world, point), "seed {seed}, {point:?}");
        }
    }
}

/// Checks that `f64` alone decides all of many random samples. A higher precision would take a
/// hundred times as long. In the second scene, two objects lie in one plane. In general, `f64`
/// leaves at most about 1e-10 of all samples undecided, in the rows at the horizon, so no undecided
/// sample is expected among the 40,000 tested.
#[test]
fn f64_alone_decides_nearly_everything() {
    let figure = [
        sphere(dvec3(-1.6, 1.0, 0.0), 1.0),
        triangle(
            dvec3(0.2, 1.0, 0.6),
            dvec3(0.3, 0.0, 1.0),
            dvec3(2.0, 2.0, 1.0),
        ),
        cuboid(dvec3(1.75, 0.0, -1.5), dvec3(2.25, 1.5, 0.5)),
        board(0.0, 1.0),
    ];
    let in_one_plane = [
        spun(DVec3::ZERO, dvec3(1.0, 2.0, 3.0), DVec3::splat(6.0), 0.0),
        spun(DVec3::ZERO, dvec3(3.0, 6.0, 9.0), DVec3::splat(6.0), 180.0),
    ];
    let mut random = SceneGenerator::new(2);
    for shapes in [&figure[..], &in_one_plane] {
        let camera = camera(dvec3(3.0, 3.5, 8.0), dvec3(0.2, 0.8, 0.0));
        let world = World::new(&scene(camera, shapes));
        for _ in 0..20_000 {
            let point = random.point();
            let single = color_index_by::<f64>(&world, point);
            assert!(single.is_some(), "{point:?}");
            assert_eq!(single, color_index_by::<Double>(&world, point));
        }
    }
}

#[test]
fn what_a_ray_meets_is_within_bounds() {
    let mut met = 0;
    for seed in 1000..1040 {
        let mut random = SceneGenerator::new(seed);
        let scene = random.scene(40);
        let world = World::new(&scene);
        let extents = extents(&world, &scene);
        for _ in 0..40 {
            let (x, y, offset) = random.point();
            let point = world.geometry.fast.camera.sample_point(x, y, offset);
            let candidates = world.candidates(&point);
            assert!(candidates.is_sorted_by(|a, b| a < b));
            let r = Big::frame(&world.geometry).camera.direction(&point);
            for (index, extent) in extents.iter().enumerate() {
                let object = Big::object(&world.geometry, index);
                let Ok(Some(crossing)) = object.first(&r) else {
                    continue;
                };
                met += 1;
                let what = format!("seed {seed}: {index} at {point:?}");
                assert!(candidates.contains(&index), "{what}");
                let nearest = extent.expect("bounds of what is met").nearest;
                let nearer = |nearest| crossing.inverse_depth.compare(&Ball::exact(nearest));
                let is_nearer = nearest < f64::INFINITY && nearer(nearest) == Ok(Ordering::Greater);
                assert!(!is_nearer, "{what}");
            }
        }
    }
    assert!(met > 2000, "{met} crossings");
}

#[test]
fn bounds_are_tight() {
    // All tested rays lie in the horizontal plane through the eye. They reach the leftmost and the
    // rightmost points of each shape's picture, because the spheres' centres lie in this plane, and
    // the box's vertical edges cross it.
    for shape in [
        sphere(dvec3(0.4, 0.0, -8.0), 0.5),
        sphere(dvec3(-2.0, 0.0, -8.0), 1e-6),
        cuboid(dvec3(0.5, -1.0, -9.0), dvec3(1.5, 1.0, -8.0)),
    ] {
        let scene = scene(camera(DVec3::ZERO, dvec3(0.0, 0.0, -1.0)), &[shape]);
        let world = World::new(&scene);
        let [Some(Extent { across, .. })] = extents(&world, &scene)[..] else {
            panic!("no bounds of {shape:?}");
        };
        let step = 1e-6 * (across[0].high - across[0].low);
        for (end, inwards) in [(across[0].low, step), (across[0].high, -step)] {
            for (x, color_index) in [(end + inwards, 0), (end - inwards, 1)] {
                let point = sample_of(&world, dvec2(x, 0.0)).expect("a point of the picture");
                assert_eq!(plain(&world, point), color_index, "{shape:?} at {x}");
            }
        }
    }
}

#[test]
fn what_is_seen_in_a_part_is_a_candidate_there() {
    let mut seen = 0;
    for seed in 2000..2060 {
        let mut random = SceneGenerator::new(seed);
        let world = World::new(&random.scene(3 + (seed as usize - 2000) * 4));
        let camera = &world.geometry.fast.camera;
        let (mut some, mut all) = (Vec::new(), Vec::new());
        for _ in 0..20 {
            let ((x, y, _), (right, bottom, _)) = (random.point(), random.point());
            let part = Area {
                x: x.min(right),
                y: y.min(bottom),
                width: x.abs_diff(right) % 8 + 1,
                height: y.abs_diff(bottom) % 8 + 1,
            };
            let all_found = candidates::within(&world, part, usize::MAX, |_, _| true, &mut some);
            assert!(all_found);
            let patch = Patch::new(camera, part);
            candidates::visible_among(&world, &patch, 0..world.object_count(), &mut all);
            // The quadtree's bounds can exclude objects that the plain loop includes. The reverse
            // must not happen.
            let objects = |candidates: &[VisibilityCandidate]| -> Vec<_> {
                candidates
                    .iter()
                    .map(|candidate| candidate.object)
                    .collect()
            };
            let (some, all) = (objects(&some), objects(&all));
            assert!(some.is_sorted_by(|a, b| a < b));
            assert!(some.iter().all(|object| all.contains(object)));
            for (x, y) in part.iter() {
                let (_, _, offset) = random.point();
                let point = camera.sample_point(x, y, offset);
                let (expected, _) = world.object_among(&point, 0..world.object_count());
                let (found, _) = world.object_among(&point, some.iter().copied());
                assert_eq!(found, expected, "seed {seed}: {part:?}");
                seen += usize::from(expected.is_some());
            }
        }
    }
    assert!(seen > 1000, "{seen} points show an object");
}

/// Checks that the tracer prepares no objects in a higher precision to find out whether two objects
/// lie in one plane. If two objects lie in one plane, the tracer needs this fact at nearly every
/// sample point, so that preparing objects would make every point slow.
#[test]
fn nothing_is_prepared_to_tell_what_lies_in_one_plane() {
    let mut shapes = vec![
        board(0.0, 0.25),
        cuboid(dvec3(-2.0, -1.0, -1.0), dvec3(2.0, 0.0, 1.0)),
    ];
    let mut random = SceneGenerator::new(5);
    for _ in 0..80 {
        // The triangles lie in the planes y = 0, y = −z and z = 0.3 x. Their coordinates are
        // multiples of 1/64, and their normals have several lengths.
        let [a, b] = [0, 1].map(|_| (random.below(256) as f64 - 128.0) / 64.0);
        let length = random.below(9) as f64 - 4.5;
        for (at, normal) in [
            (dvec3(a, 0.0, b), DVec3::Y),
            (dvec3(a, b, -b), dvec3(0.0, 1.0, 1.0)),
            (dvec3(5.0 * a, b, 1.5 * a), dvec3(3.0, 0.0, -10.0)),
        ] {
            shapes.push(triangle(at, normal * length, dvec3(2.0, 2.5, 3.0)));
        }
    }
    let world = World::new(&scene(camera(dvec3(3.0, 3.5, 8.0), DVec3::ZERO), &shapes));
    let mut several = 0;
    for _ in 0..2000 {
        let (x, y, offset) = random.point();
        let point = world.geometry.fast.camera.sample_point(x, y, offset);
        several += usize::from(world.candidates(&point).len() > 2);
        world.color_index_at(x, y, offset);
    }
    assert!(several > 1000, "{several} points with several objects");
    let Geometry { double, big, .. } = &world.geometry;
    assert_eq!(double.cache.len() + big.cache.len(), 0);
}

#[test]
fn very_many_objects() {
    // There are enough objects for several threads to prepare them. Half of the objects are spread
    // over the whole picture, and half lie in a cluster far smaller than a pixel.
    let mut random = SceneGenerator::new(1);
    let eye = DVec3::ZERO;
    let mut stage = scene(camera(eye, dvec3(0.0, 0.0, -1.0)), &[sphere(eye, 1.0)]);
    let template = stage.objects[0].clone();
    let mut objects = Vec::new();
    for index in 0..40_000 {
        let depth = random.within(1.0, 10.0);
        let spread = if index % 2 == 0 { 0.5 } else { 1e-9 };
        let [x, y] = [0, 1].map(|_| random.within(-spread, spread));
        let radius = random.within(0.001, 0.01) * spread;
        let mut object = template.clone();
        object.shape = sphere(dvec3(x, y, -1.0) * depth, radius * depth);
        if let Shape::Sphere(sphere) = &mut object.shape {
            // Each sphere has its own colour, so that a wrong object is noticed.
            sphere.color.srgb[0] = f64::from(index) / 256.0;
        }
        objects.push(object);
    }
    stage.objects = Arc::new(objects);
    let world = World::new(&stage);
    assert!(
        size_of::<Object<f64>>() <= 96,
        "a sphere takes what it needs"
    );
    let mut seen = 0;
    for number in 0..160 {
        let mut point = random.point();
        if number % 4 == 0 {
            // Every fourth point lies in a cluster that is far smaller than a pixel, at the common
            // corner of the picture's four middle pixels.
            let [x, y] = [0, 1].map(|_| random.within(-1e-9, 1e-9));
            point = sample_of(&world, dvec2(x, y)).expect("the middle of the picture");
        }
        let (x, y, offset) = point;
        let found = world.color_index_at(x, y, offset);
        assert_eq!(found, plain(&world, point), "{point:?}");
        seen += usize::from(found < world.background());
    }
    assert!(seen > 40, "{seen} points show a sphere");
}
