//! Surfaces in common planes, and rays in planes and along edges.

use glam::{DVec3, dvec2, dvec3};

use super::*;

/// A scene of 8 × 8 pixels all of whose numbers are small multiples of 1/2, so that there are eyes on surfaces, rays in planes, through
/// corners and along edges, faces in common planes and at the depth of the near and the far plane.
pub fn scene_full_of_ties(random: &mut Random) -> Scene {
    let (eye, direction, up) = (random.point(4), random.point(2), random.point(1));
    let mut camera = camera(eye, DVec3::ZERO);
    let or = |vector: DVec3, other| if vector == DVec3::ZERO { other } else { vector };
    let direction = or(direction, DVec3::NEG_Z);
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
        let normal = or(normal, DVec3::Y);
        shapes.push(turned(
            random.point(3),
            normal,
            dvec3(5.0, 5.0, 6.0),
            random.half(4) * 90.0,
        ));
    }
    shapes.insert(2, scenes::board(random.half(2), 0.5));
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
