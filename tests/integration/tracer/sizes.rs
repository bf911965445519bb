//! The very small, large, near and far, up to the range of numbers.

use glam::{DVec3, dvec3};

use super::*;
use crate::table::rows;

#[test]
fn scenes_of_extreme_sizes_agree_with_the_oracle() {
    for size in [1e-300, 1e-160, 1e-5, 1e160, 1e300] {
        let camera = camera(dvec3(1.0, 2.0, 3.0) * size, DVec3::ZERO);
        let shapes = [
            sphere(DVec3::ZERO, 0.7 * size),
            cuboid(DVec3::splat(0.1 * size), DVec3::splat(0.6 * size)),
            turned(
                dvec3(0.1, 0.4, 0.9) * size,
                dvec3(0.2, 0.3, 1.0) * size,
                dvec3(2.0, 2.0, 1.0) * size,
                0.0,
            ),
            scenes::board(-0.5 * size, size),
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
        let mut random = Random::new(4);
        // The boxes' common face is seen edge-on in the middle of the picture.
        for (x, expected) in [0, 31, 32, 63].into_iter().zip(expected) {
            let color = world.palette()[world.slot_at(x, 31, random.offset())].srgb;
            assert_eq!(color, [expected, 0.0, 0.0], "{d:e}, {view_height:e}: {x}");
        }
    }
}

#[test]
fn triangles_too_small_or_far_away_to_be_seen_are_not_seen() {
    let table = "
        centroid (1e10, 1e100, -1e100) sides (1, 1, 1) -> (0.1, 0.7, -1)
        centroid (0.1, 0.2, -1.7) sides (1e-95, 1e-95, 1e-95) -> (0.01, 0, -1)
        centroid (0.1, 0.2, -1.7) sides (2e-300, 2e-300, 1e-300) -> (0.01, 0, -1)
        centroid (0.1, 0.2, -1e160) sides (2, 2, 1) -> (0.01, 0, -1)
    ";
    for [triangle, direction] in rows(table) {
        let scene = read(&format!(
            "image {{ width 300 height 200 background black }}
             camera {{ eye (0.1, 0.2, 0.3) direction {direction} }}
             sampler {{ per_pixel 1 }}
             triangle {{ {triangle} normal (-0.3, 0.2, 1) color lime }}"
        ));
        let world = World::new(&scene);
        let whole = Area::whole(300, 200);
        let control = Control::default();
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
