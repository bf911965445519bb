//! Floors, faces and triangles: far away, in common planes, and seen edge on.

use glam::{DVec3, dvec2, dvec3};

use super::*;

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
        let mut random = Random::new(1);
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
            outline: Outline::Centered(CenteredTriangle {
                centroid: random.point(3),
                normal,
                sides: dvec3(5.0, 5.0, 6.0),
                spin: Angle::from_degrees(random.half(4) * 90.0),
            }),
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
    let mut random = Random::new(11);
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
fn triangles_in_one_plane_are_one_surface_whatever_their_normals_lengths() {
    let shape = |normal: DVec3, spin: f64| {
        Shape::Triangle(Triangle {
            outline: Outline::Centered(CenteredTriangle {
                centroid: DVec3::ZERO,
                normal,
                sides: DVec3::splat(6.0),
                spin: Angle::from_degrees(spin),
            }),
            color: Color::BLACK,
        })
    };
    let shapes = [
        shape(dvec3(1.0, 2.0, 3.0), 0.0),
        shape(dvec3(3.0, 6.0, 9.0), 180.0),
    ];
    let scene = scene(camera(dvec3(3.0, 3.5, 8.0), DVec3::ZERO), &shapes);
    assert_eq!(agrees(&scene, 30), 30);
}
