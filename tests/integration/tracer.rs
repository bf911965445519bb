//! The tracer against the oracle, above all within the last bits of every boundary.

use std::sync::atomic::AtomicBool;

use glam::{DVec2, DVec3, dvec2, dvec3};
pub use pinhole::report::numerics::scenes::{camera, cuboid, scene, sphere};
use pinhole::{
    area::Area,
    color::Color,
    math::Angle,
    render::{Control, render, render_exact},
    report::numerics::{
        oracle::{ALL_SIZES, Oracle},
        scenes::{self, SIZE},
    },
    sampling::Sampling,
    scene::{Checkerboard, Lens, Scene, Shape, Triangle, View},
    source::{Source, Sources},
    tracer::{Precision, World},
};

use crate::exact::read;

pub fn triangle(centroid: DVec3, normal: DVec3) -> Shape {
    scenes::triangle(centroid, normal, dvec3(2.0, 2.0, 1.0))
}

pub fn floor() -> Shape {
    scenes::board(0.0, 1.0)
}

/// Reproducible numbers (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A multiple of 1/2, at most `limit` halves from 0.
    fn half(&mut self, limit: i64) -> f64 {
        (self.bits() as i64 % (limit + 1)) as f64 / 2.0
    }

    fn point(&mut self, limit: i64) -> DVec3 {
        dvec3(self.half(limit), self.half(limit), self.half(limit))
    }

    pub fn offset(&mut self) -> DVec2 {
        dvec2(self.within(-0.5, 0.5), self.within(-0.5, 0.5))
    }

    pub fn vector(&mut self, size: f64) -> DVec3 {
        let mut one = || self.within(-size, size);
        dvec3(one(), one(), one())
    }
}

/// The colour that the oracle sees, in the numbering of [`scene`].
fn expected(oracle: &Oracle, x: u32, y: u32, offset: DVec2) -> [f64; 3] {
    match oracle.seen(&oracle.direction(x, y, offset)) {
        None => [0.0; 3],
        Some(seen) => [seen.object as f64 + 1.0, f64::from(u8::from(seen.odd)), 0.0],
    }
}

/// Compares the tracer with the oracle: at random points, and at the points of `f64` on both sides of the boundaries that
/// random segments within pixels cross. Returns how many boundaries it found, so that a test can say that there were some.
fn agrees(scene: &Scene, points: usize) -> usize {
    let world = World::new(scene);
    let oracle = Oracle::new(scene, ALL_SIZES);
    let mut random = Random(points as u64);
    let color = |x, y, offset| world.palette()[world.slot_at(x, y, offset)].srgb;
    let check = |x, y, offset: DVec2| {
        assert_eq!(
            color(x, y, offset),
            expected(&oracle, x, y, offset),
            "pixel {x}, {y} at {offset:?} of {scene:?}"
        );
    };
    let mut boundaries = 0;
    let mut tries = 0;
    while boundaries < points && tries < 40 * points + 4000 {
        tries += 1;
        let (x, y) = (random.bits() as u32 % SIZE, random.bits() as u32 % SIZE);
        let (mut a, mut b) = (random.offset(), random.offset());
        if tries % 16 == 0 {
            check(x, y, a);
        }
        if color(x, y, a) == color(x, y, b) {
            continue;
        }
        // Along x or y alone, down to neighbouring numbers.
        let axis = usize::from(tries % 2 == 0);
        let mut corner = a;
        corner[axis] = b[axis];
        if color(x, y, corner) == color(x, y, a) {
            continue;
        }
        b = corner;
        loop {
            let mut middle = a;
            middle[axis] = a[axis] + (b[axis] - a[axis]) / 2.0;
            if middle == a || middle == b {
                break;
            }
            if color(x, y, middle) == color(x, y, a) {
                a = middle;
            } else {
                b = middle;
            }
        }
        check(x, y, a);
        check(x, y, b);
        boundaries += 1;
    }
    boundaries
}

#[test]
fn f64_alone_decides_nearly_everything() {
    let shapes = [
        sphere(dvec3(-1.6, 1.0, 0.0), 1.0),
        triangle(dvec3(0.2, 1.0, 0.6), dvec3(0.3, 0.0, 1.0)),
        cuboid(dvec3(1.75, 0.0, -1.5), dvec3(2.25, 1.5, 0.5)),
        floor(),
    ];
    let scene = scene(camera(dvec3(3.0, 3.5, 8.0), dvec3(0.2, 0.8, 0.0)), &shapes);
    let world = World::new(&scene);
    let mut random = Random(2);
    let mut doubts = 0;
    for _ in 0..20_000 {
        let (x, y) = (random.bits() as u32 % SIZE, random.bits() as u32 % SIZE);
        let offset = random.offset();
        let double = world.slot_in(Precision::Double, x, y, offset);
        match world.slot_in(Precision::Single, x, y, offset) {
            None => doubts += 1,
            single => assert_eq!(single, double),
        }
    }
    // The rows at the horizon leave doubts of about 1e-10 of the samples.
    assert_eq!(doubts, 0);
}

#[test]
fn the_examples_are_the_same_without_the_hierarchy() {
    let folder = format!("{}/examples", env!("CARGO_MANIFEST_DIR"));
    let files = std::fs::read_dir(folder).unwrap();
    let paths = files.map(|entry| entry.unwrap().path());
    let mut random = Random(3);
    for path in paths.filter(|path| path.extension().is_some_and(|ending| ending == "scn")) {
        let text = std::fs::read_to_string(&path).unwrap();
        let sources = Sources::new(Source::from_text("a.scn", text));
        let scene = pinhole::scene::read(&sources).scene.unwrap();
        let world = World::new(&scene);
        let size = [scene.image.width, scene.image.height].map(u64::from);
        for _ in 0..3000 {
            let [x, y] = size.map(|size| (random.bits() % size) as u32);
            let offset = random.offset();
            let plain = [Precision::Single, Precision::Double, Precision::Big]
                .into_iter()
                .find_map(|precision| world.slot_in(precision, x, y, offset));
            let found = world.slot_at(x, y, offset);
            assert_eq!(Some(found), plain, "{path:?}, pixel {x}, {y} at {offset}");
        }
    }
}

#[test]
fn the_figure_agrees_with_the_oracle() {
    let shapes = [
        sphere(dvec3(-1.6, 1.0, 0.0), 1.0),
        triangle(dvec3(0.2, 1.0, 0.6), dvec3(0.3, 0.0, 1.0)),
        cuboid(dvec3(1.75, 0.0, -1.5), dvec3(2.25, 1.5, 0.5)),
        floor(),
    ];
    for (roll, near, far) in [(0.0, 0.0, None), (90.0, 0.0, None), (33.0, 7.0, Some(10.0))] {
        let mut camera = camera(dvec3(3.0, 3.5, 8.0), dvec3(0.2, 0.8, 0.0));
        camera.roll = Angle::from_degrees(roll);
        (camera.near, camera.far) = (near, far);
        assert_eq!(agrees(&scene(camera, &shapes), 60), 60);
    }
}

#[test]
fn random_objects_agree_with_the_oracle() {
    let mut random = Random(7);
    let mut found = 0;
    for round in 0..24 {
        let eye = random.vector(4.0);
        let mut camera = camera(eye, random.vector(1.0));
        camera.up = random.vector(1.0);
        camera.roll = Angle {
            degrees: random.within(-400.0, 400.0),
            radians: random.within(-10.0, 10.0),
        };
        camera.lens = Lens::Fov(Angle::from_degrees(random.within(1.0, 179.0)));
        if round % 2 == 0 {
            (camera.near, camera.far) = (2.0, Some(6.0));
        }
        let mut shapes = vec![floor()];
        for _ in 0..2 {
            let corner = random.vector(2.0);
            shapes.push(sphere(random.vector(2.0), random.within(0.1, 3.0)));
            shapes.push(Shape::Triangle(Triangle {
                centroid: random.vector(2.0),
                normal: random.vector(1.0),
                sides: dvec3(2.0, random.within(1.1, 3.9), 2.0),
                spin: Angle::from_degrees(random.within(0.0, 360.0)),
                color: Color::BLACK,
            }));
            shapes.push(cuboid(
                corner,
                corner + DVec3::splat(random.within(0.1, 2.0)),
            ));
        }
        found += agrees(&scene(camera, &shapes), 16);
    }
    assert!(found > 200);
}

#[test]
fn nearly_parallel_up_vectors_agree_with_the_oracle() {
    for tilt in [1e-4, 1e-8, 1e-12, 1e-15, 1e-16, 1e-30, 1e-200] {
        let mut camera = camera(dvec3(0.3, 10.0, 0.1), DVec3::ZERO);
        camera.view = View::Direction(dvec3(tilt, -1.0, tilt / 3.0));
        camera.lens = Lens::Distance(1.0);
        assert_eq!(agrees(&scene(camera, &[floor()]), 20), 20);
    }
}

#[test]
fn small_and_distant_spheres_agree_with_the_oracle() {
    for distance in [1e3, 1e6, 1e9, 1e12, 1e15] {
        let mut camera = camera(DVec3::ZERO, dvec3(1.0, 2.0, -3.0));
        let center = dvec3(1.0, 2.0, -3.0) * distance;
        camera.lens = Lens::Distance(center.length());
        camera.view_height = 3.0;
        assert_eq!(agrees(&scene(camera, &[sphere(center, 1.0)]), 20), 20);
    }
}

#[test]
fn huge_spheres_agree_with_the_oracle() {
    for radius in [1e6, 1e9, 1e12, 1e15] {
        let camera = camera(dvec3(0.1, 1.0, 0.2), dvec3(3.0, 0.9, -4.0));
        let shapes = [
            sphere(dvec3(0.0, -radius, 0.0), radius),
            sphere(dvec3(3.0, 1.0, -4.0), 0.8),
        ];
        assert_eq!(agrees(&scene(camera, &shapes), 20), 20);
    }
}

#[test]
fn concentric_and_equal_spheres_agree_with_the_oracle() {
    let camera = camera(dvec3(0.0, 0.0, 5.0), DVec3::ZERO);
    let next = 1.0 + f64::EPSILON;
    for radii in [[1.0, 1.0], [1.0, next], [next, 1.0]] {
        let shapes = radii.map(|radius| sphere(DVec3::ZERO, radius));
        assert_eq!(agrees(&scene(camera, &shapes), 20), 20);
    }
}

#[test]
fn an_eye_on_or_near_a_surface_agrees_with_the_oracle() {
    let mut found = 0;
    for above in [1e-3, 1e-8, 1e-14, 0.0, -1e-14, -1e-8, -1e-3] {
        let camera = camera(dvec3(0.0, 1.0 + above, 0.0), dvec3(3.0, 0.8, 0.4));
        let shapes = [
            sphere(DVec3::ZERO, 1.0),
            cuboid(dvec3(-4.0, 0.0, -4.0), dvec3(4.0, 1.0, 4.0)),
            triangle(dvec3(2.0, 1.0, 0.0), DVec3::Y),
            Shape::Checkerboard(Checkerboard {
                y: 1.0,
                square: 0.3,
                colors: [Color::BLACK; 2],
            }),
        ];
        found += agrees(&scene(camera, &shapes), 20);
    }
    assert!(found > 40);
}

#[test]
fn the_floor_far_away_agrees_with_the_oracle() {
    for (height, x) in [
        (1e-9, 0.0),
        (1e9, 0.0),
        (1e15, 0.0),
        (2.0, 1e9),
        (2.0, 4e15),
        (2.0, -1e12),
    ] {
        let eye = dvec3(x, height, x / 3.0);
        let mut camera = camera(eye, DVec3::ZERO);
        camera.view = View::Direction(dvec3(0.2, -0.1, -1.0));
        agrees(&scene(camera, &[floor()]), 20);
        // Within a millionth of a pixel of the horizon: a distance of 10^7 eye heights and more.
        camera.view = View::Direction(dvec3(0.2, 0.0, -1.0));
        let scene = scene(camera, &[floor()]);
        let world = World::new(&scene);
        let oracle = Oracle::new(&scene, ALL_SIZES);
        let mut random = Random(1);
        for exponent in 1..16 {
            let below = libm::pow(10.0, -f64::from(exponent));
            let offset = dvec2(random.within(-0.5, 0.5), -0.5 + below);
            let (x, y) = (random.bits() as u32 % SIZE, SIZE / 2);
            let color = world.palette()[world.slot_at(x, y, offset)].srgb;
            assert_eq!(color, expected(&oracle, x, y, offset));
        }
    }
}

#[test]
fn coincident_surfaces_agree_with_the_oracle() {
    let below = camera(dvec3(0.4, -3.0, 0.2), dvec3(0.0, 0.0, 0.1));
    let surfaces = [
        floor(),
        cuboid(dvec3(-1.0, 0.0, -1.0), dvec3(0.2, 1.0, 0.7)),
        triangle(dvec3(0.3, 0.0, 0.3), dvec3(0.0, 3.0, 0.0)),
        cuboid(dvec3(-2.0, -1.0, 0.3), dvec3(-0.3, 0.0, 0.9)),
    ];
    let mut reversed = surfaces;
    reversed.reverse();
    assert_eq!(agrees(&scene(below, &surfaces), 60), 60);
    assert_eq!(agrees(&scene(below, &reversed), 60), 60);
}

/// A scene of 8 × 8 pixels all of whose numbers are small multiples of 1/2, so that there are eyes on surfaces, rays in planes, through
/// corners and along edges, faces in common planes and at the depth of the near and the far plane.
pub fn scene_full_of_ties(random: &mut Random) -> Scene {
    let (eye, direction, up) = (random.point(4), random.point(2), random.point(1));
    let mut camera = camera(eye, DVec3::ZERO);
    let direction = if direction == DVec3::ZERO {
        DVec3::NEG_Z
    } else {
        direction
    };
    camera.view = View::Direction(direction);
    camera.up = if up.cross(direction) == DVec3::ZERO {
        direction.any_orthogonal_vector()
    } else {
        up
    };
    camera.roll = Angle::from_degrees(random.half(2) * 90.0);
    camera.view_height = 4.0;
    camera.near = random.half(2).abs();
    camera.far = (random.half(1) > 0.0).then(|| camera.near + random.half(6).abs() + 0.5);
    let mut shapes = Vec::new();
    for _ in 0..2 {
        let corner = random.point(4);
        let size = dvec3(
            random.half(2).abs() + 0.5,
            random.half(2).abs() + 0.5,
            random.half(2).abs() + 0.5,
        );
        shapes.push(cuboid(corner, corner + size));
        shapes.push(sphere(random.point(4), random.half(3).abs() + 0.5));
        let normal = random.point(1);
        let normal = if normal == DVec3::ZERO {
            DVec3::Y
        } else {
            normal
        };
        shapes.push(Shape::Triangle(Triangle {
            centroid: random.point(3),
            normal,
            sides: dvec3(5.0, 5.0, 6.0),
            spin: Angle::from_degrees(random.half(4) * 90.0),
            color: Color::BLACK,
        }));
    }
    shapes.insert(
        2,
        Shape::Checkerboard(Checkerboard {
            y: random.half(2),
            square: 0.5,
            colors: [Color::BLACK; 2],
        }),
    );
    let mut scene = scene(camera, &shapes);
    (scene.image.width, scene.image.height) = (8, 8);
    scene
}

#[test]
fn scenes_full_of_ties_agree_with_the_oracle() {
    // All sample points are multiples of 1/8 pixel.
    let mut random = Random(11);
    for _ in 0..150 {
        let scene = scene_full_of_ties(&mut random);
        let world = World::new(&scene);
        let oracle = Oracle::new(&scene, ALL_SIZES);
        for _ in 0..30 {
            let (x, y) = (random.bits() as u32 % 8, random.bits() as u32 % 8);
            let eighth = |bits: u64| (bits % 8) as f64 / 8.0 - 0.5;
            let offset = dvec2(eighth(random.bits()), eighth(random.bits()));
            let color = world.palette()[world.slot_at(x, y, offset)].srgb;
            assert_eq!(
                color,
                expected(&oracle, x, y, offset),
                "pixel {x}, {y} at {offset} of {scene:?}"
            );
        }
    }
}

#[test]
fn just_outside_the_edge_of_a_box_the_floor_that_it_stands_on_is_seen() {
    // From below, between the point where the ray meets the common plane and the one where it enters the box.
    let camera = camera(dvec3(0.4, -3.0, 0.2), dvec3(0.0, 0.0, 0.1));
    let shapes = [
        cuboid(dvec3(-1.0, 0.0, -1.0), dvec3(0.2, 1.0, 0.7)),
        floor(),
    ];
    let scene = scene(camera, &shapes);
    let world = World::new(&scene);
    let oracle = Oracle::new(&scene, ALL_SIZES);
    let offset = dvec2(-0.253_993_261_381_526_67, 0.204_492_435_315_224_93);
    let color = world.palette()[world.slot_at(48, 31, offset)].srgb;
    assert_eq!(color, [2.0, 1.0, 0.0]);
    assert_eq!(color, expected(&oracle, 48, 31, offset));
}

#[test]
fn rays_in_the_planes_of_faces_agree_with_the_oracle() {
    // Odd sizes put the middle of a pixel on the axis, so that whole rows and columns of rays lie in faces' planes.
    let shape = cuboid(dvec3(0.0, 0.0, -5.0), dvec3(1.0, 1.0, -3.0));
    for eye in [
        DVec3::ZERO,
        DVec3::X,
        dvec3(0.5, 1.0, 0.0),
        dvec3(0.0, 0.0, -3.0),
        dvec3(0.0, 0.0, -4.0),
        dvec3(1.0, 0.5, -5.0),
    ] {
        let mut camera = camera(eye, DVec3::ZERO);
        camera.view = View::Direction(DVec3::NEG_Z);
        let mut scene = scene(camera, &[shape, floor()]);
        (scene.image.width, scene.image.height) = (33, 33);
        let world = World::new(&scene);
        let oracle = Oracle::new(&scene, ALL_SIZES);
        for i in 0..33 {
            for (x, y) in [(16, i), (i, 16), (i, i)] {
                let color = world.palette()[world.slot_at(x, y, DVec2::ZERO)].srgb;
                assert_eq!(
                    color,
                    expected(&oracle, x, y, DVec2::ZERO),
                    "eye {eye}, pixel {x}, {y}"
                );
            }
        }
    }
}

#[test]
fn extreme_lenses_and_sizes_agree_with_the_oracle() {
    let mut found = 0;
    for d in [5e-324, 1e-300, 1e-9, 1e9, 1e300] {
        let mut camera = camera(dvec3(0.1, 2.0, 3.0), dvec3(1.0, 0.0, 1.0));
        camera.lens = Lens::Distance(d);
        let shapes = [floor(), sphere(dvec3(-3.0, 1.0, 0.0), 1.0)];
        found += agrees(&scene(camera, &shapes), 10);
    }
    assert!(found >= 30, "{found}");
    for size in [1e-300, 1e-160, 1e-5, 1e160, 1e300] {
        let camera = camera(dvec3(1.0, 2.0, 3.0) * size, DVec3::ZERO);
        let shapes = [
            sphere(DVec3::ZERO, 0.7 * size),
            cuboid(DVec3::splat(0.1 * size), DVec3::splat(0.6 * size)),
            Shape::Triangle(Triangle {
                centroid: dvec3(0.1, 0.4, 0.9) * size,
                normal: dvec3(0.2, 0.3, 1.0) * size,
                sides: dvec3(2.0, 2.0, 1.0) * size,
                spin: Angle::default(),
                color: Color::BLACK,
            }),
            Shape::Checkerboard(Checkerboard {
                y: -0.5 * size,
                square: size,
                colors: [Color::BLACK; 2],
            }),
        ];
        assert_eq!(agrees(&scene(camera, &shapes), 10), 10);
    }
}

#[test]
fn nothing_is_too_near_or_too_far_for_the_range_of_numbers() {
    let at = |y: f64| {
        let mut camera = camera(dvec3(0.3, y, 5.3), DVec3::ZERO);
        camera.view = View::Direction(dvec3(0.0, -0.3, -1.0));
        camera
    };
    // A floor 5e-324 below the eye, and a box as close before it.
    for height in [5e-324, 1e-309, 1e-300] {
        let found = agrees(
            &scene(at(height), &[floor(), sphere(dvec3(0.0, 1.0, 0.0), 1.0)]),
            10,
        );
        assert_eq!(found, 10);
        let wall = cuboid(dvec3(-1.0, -1.0, -1.0), dvec3(1.0, 1.0, -height));
        let mut camera = at(0.0);
        camera.eye = dvec3(0.0, 0.1, 0.0);
        agrees(
            &scene(camera, &[sphere(dvec3(0.0, 0.0, -3.0), 0.5), wall, floor()]),
            10,
        );
    }
    // Just inside of a huge sphere, with something else before its far side.
    for radius in [1e20, 1e60, 1e100] {
        let mut camera = camera(dvec3(0.0, -1.0, 0.0), DVec3::ZERO);
        camera.view = View::Direction(DVec3::NEG_Z);
        let shapes = [
            sphere(dvec3(0.0, -radius, 0.0), radius),
            cuboid(dvec3(-1.0, -2.0, -11.0), dvec3(1.0, 1.0, -10.0)),
        ];
        assert_eq!(agrees(&scene(camera, &shapes), 10), 10);
    }
    // Lenses of all ranges.
    for (d, view_height, expected) in [
        (1e-300, 1e300, [0.0, 0.0, 0.0, 0.0]),
        (1e300, 1e-30, [1.0, 1.0, 2.0, 2.0]),
        (1e300, 1e300, [0.0, 1.0, 2.0, 0.0]),
        (1e-300, 1e-300, [0.0, 1.0, 2.0, 0.0]),
    ] {
        let mut camera = camera(dvec3(0.0, 0.0, 5.0), DVec3::ZERO);
        camera.view = View::Direction(DVec3::NEG_Z);
        (camera.lens, camera.view_height) = (Lens::Distance(d), view_height);
        let shapes = [
            cuboid(dvec3(-1.0, -1.0, -1.0), dvec3(0.0, 1.0, 0.0)),
            cuboid(dvec3(0.0, -1.0, -1.0), dvec3(1.0, 1.0, 0.0)),
        ];
        let scene = scene(camera, &shapes);
        let world = World::new(&scene);
        let mut random = Random(4);
        // The boxes' common face is seen edge-on in the middle of the picture.
        for (x, expected) in [0, 31, 32, 63].into_iter().zip(expected) {
            let color = world.palette()[world.slot_at(x, 31, random.offset())].srgb;
            assert_eq!(color, [expected, 0.0, 0.0], "{d:e}, {view_height:e}: {x}");
        }
    }
}

#[test]
fn triangles_in_one_plane_are_one_surface_whatever_their_normals_lengths() {
    let shape = |normal: DVec3, spin: f64| {
        Shape::Triangle(Triangle {
            centroid: DVec3::ZERO,
            normal,
            sides: DVec3::splat(6.0),
            spin: Angle::from_degrees(spin),
            color: Color::BLACK,
        })
    };
    let shapes = [
        shape(dvec3(1.0, 2.0, 3.0), 0.0),
        shape(dvec3(3.0, 6.0, 9.0), 180.0),
    ];
    let scene = scene(camera(dvec3(3.0, 3.5, 8.0), DVec3::ZERO), &shapes);
    assert_eq!(agrees(&scene, 30), 30);
    // Such a tie is no doubt, which would cost a hundred times as much as a decision.
    let world = World::new(&scene);
    let mut random = Random(6);
    let mut doubts = 0;
    for _ in 0..2000 {
        let (x, y) = (random.bits() as u32 % SIZE, random.bits() as u32 % SIZE);
        let seen = world.slot_in(Precision::Single, x, y, random.offset());
        doubts += usize::from(seen.is_none());
    }
    assert_eq!(doubts, 0);
}

#[test]
fn needles_and_tiny_triangles_agree_with_the_oracle() {
    for (scale, needle) in [
        (1e-3, 1.0),
        (1e-5, 1.0),
        (1e-9, 1.0),
        (1.0, 1e-3),
        (1.0, 1e-9),
    ] {
        let mut camera = camera(dvec3(0.3, 0.2, 3.0), DVec3::ZERO);
        camera.lens = Lens::Distance(2.0 / (scale * needle));
        let shape = Shape::Triangle(Triangle {
            centroid: DVec3::ZERO,
            normal: dvec3(1.0, 0.4, 2.0),
            sides: dvec3(1.0, 1.0, needle) * scale,
            spin: Angle::from_degrees(20.0),
            color: Color::BLACK,
        });
        assert!(agrees(&scene(camera, &[shape]), 20) > 10);
    }
}

#[test]
fn triangles_too_small_or_far_away_to_be_seen_are_not_seen() {
    for (triangle, toward) in [
        ("centroid (1e10, 1e100, -1e100) sides (1, 1, 1)", (0.1, 0.7)),
        (
            "centroid (0.1, 0.2, -1.7) sides (1e-95, 1e-95, 1e-95)",
            (0.01, 0.0),
        ),
        (
            "centroid (0.1, 0.2, -1.7) sides (2e-300, 2e-300, 1e-300)",
            (0.01, 0.0),
        ),
        ("centroid (0.1, 0.2, -1e160) sides (2, 2, 1)", (0.01, 0.0)),
    ] {
        let (x, y) = toward;
        let scene = read(&format!(
            "image {{ width 300 height 200 background black }}
             camera {{ eye (0.1, 0.2, 0.3) direction ({x}, {y}, -1) }}
             sampler {{ per_pixel 1 }}
             triangle {{ {triangle} normal (-0.3, 0.2, 1) color lime }}"
        ));
        let world = World::new(&scene);
        let whole = Area::whole(300, 200);
        let control = Control {
            threads: None,
            progress: &|_| {},
            cancel: &AtomicBool::new(false),
        };
        let sampling = Sampling::new(&scene.sampler, 300, 200);
        for film in [
            render(&world, &sampling, whole, &control).unwrap(),
            render_exact(&world, whole, &control).unwrap().film,
        ] {
            let most = film
                .pixels()
                .iter()
                .fold(0.0, |most: f64, pixel| most.max(pixel[1]));
            assert!(most < 1e-12, "{triangle}: {most}");
        }
    }
}
