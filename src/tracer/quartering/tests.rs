//! Tests of the parts that a picture is divided into, and of their candidates.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3, dvec3};

use super::{PicturePart, Quartering, Scratch, candidates};
use crate::{
    area::Area,
    reference::scenes::{SIZE, along, board, cuboid, scene, sphere, triangle},
    scene::Shape,
    tracer::{World, nearby},
};

fn world(shapes: &[Shape]) -> World {
    World::new(&scene(along(DVec3::ZERO, DVec3::NEG_Z), shapes))
}

/// Returns a thousand spheres at one depth, all over the picture.
fn thousand_spheres(depth: f64) -> Vec<Shape> {
    let sphere = |index: i32| {
        let x = (f64::from(index % 40) - 19.5) * 0.02 * depth;
        let y = (f64::from(index / 40) - 12.0) * 0.02 * depth;
        sphere(dvec3(x, y, -depth), depth * 0.004)
    };
    (0..1000).map(sphere).collect()
}

/// Returns a world of large triangles in parallel planes, in arbitrary order. Each triangle hides
/// all triangles behind it.
fn triangles_in_layers(count: usize) -> World {
    let layer = |index: usize| {
        let depth = 10.0 + (index * 37 % count) as f64 / 64.0;
        let normal = dvec3(0.3, 0.2, 1.0);
        triangle(dvec3(0.0, 0.0, -depth), normal, DVec3::splat(400.0))
    };
    world(&(0..count).map(layer).collect::<Vec<_>>())
}

/// Returns a world of single-coloured boards, some above the eye and some below, in arbitrary
/// order. The horizon lies in the picture.
fn boards_in_layers(count: usize) -> World {
    let layer = |index: usize| {
        let height = 1.0 + (index * 37 % count) as f64 / 64.0;
        board([height, -height][index % 2], 1.0)
    };
    let layers: Vec<_> = (0..count).map(layer).collect();
    let mut scene = scene(along(DVec3::ZERO, DVec3::NEG_Z), &layers);
    for object in std::sync::Arc::make_mut(&mut scene.objects) {
        if let Shape::Checkerboard(board) = &mut object.shape {
            board.colors[1] = board.colors[0];
        }
    }
    World::new(&scene)
}

#[test]
fn of_layers_only_those_that_are_seen_are_candidates() {
    for count in [9, 33, 101, 1001] {
        for world in [triangles_in_layers(count), boards_in_layers(count)] {
            let parts = Quartering::new(&world);
            let flow = parts.parts(
                Area::whole(SIZE, SIZE),
                &mut Scratch::default(),
                &mut |part| {
                    let few = match part {
                        PicturePart::OneColor { .. } => 0,
                        // All boards meet at the horizon, which lies between these two rows of
                        // pixels. The pixels of these rows may have many candidates and are not
                        // checked.
                        PicturePart::Pixel { y: 31 | 32, .. } => 0,
                        PicturePart::Pixel { candidates, .. } => candidates.len(),
                        PicturePart::Crowded { .. } => usize::MAX,
                    };
                    assert!(few <= 2, "{count}: {part:?}");
                    ControlFlow::Continue(())
                },
            );
            assert!(flow.is_continue());
        }
    }
}

#[test]
fn what_a_wall_hides_is_not_found() {
    let wall = cuboid(dvec3(-9.0, -9.0, -5.0), dvec3(9.0, 9.0, -4.0));
    let mut found = Vec::new();
    for (depth, behind) in [(8.0, true), (3.0, false)] {
        let mut shapes = thousand_spheres(depth);
        shapes.push(wall);
        let world = world(&shapes);
        let all_within = |part, most, found: &mut Vec<_>| {
            candidates::within(&world, part, most, |_, _| true, found)
        };
        let whole = Area::whole(SIZE, SIZE);
        assert_eq!(all_within(whole, 1, &mut found), behind);
        assert!(all_within(whole, usize::MAX, &mut found));
        assert_eq!(found.len() == 1, behind);
        assert!(behind || found.len() == 1001, "{}", found.len());
        // Several cells of the quadtree list the wall. In each part of the picture, the wall must
        // hide the spheres if it is in front of them.
        for part in whole.tiles(7) {
            assert!(all_within(part, usize::MAX, &mut found));
            assert!(found.len() == 1 || !behind, "{part:?}");
        }
    }
}

/// Checks the colours of sample points of a crowded scene. Testing only the objects that `nearby`
/// finds must give the same colours as searching the quadtree. Some pixels must be recognized as
/// single-coloured.
#[test]
fn of_a_crowd_the_objects_nearby_are_enough() {
    let mut shapes = thousand_spheres(9.0);
    for shape in &mut shapes {
        if let Shape::Sphere(sphere) = shape {
            sphere.radius *= 4.0;
        }
    }
    shapes.extend(thousand_spheres(3.0));
    let world = world(&shapes);
    let (mut known, mut several, mut narrowed) = (0, 0, Vec::new());
    for part in Area::whole(SIZE, SIZE).grid(4) {
        let near = nearby::nearby(&world, part).unwrap();
        for (x, y) in part.iter() {
            let only = nearby::in_part(&world, Area::pixel(x, y), &near, &mut narrowed);
            known += usize::from(only.is_some());
            several += usize::from(only.is_none());
            for step in 0..9 {
                let offset = DVec2::new(f64::from(step % 3 - 1), f64::from(step / 3 - 1)) * 0.49;
                let seen = world.color_index_at(x, y, offset);
                assert_eq!(world.color_index_near(x, y, offset, Some(&near)), seen);
                match only {
                    Some(only) => assert_eq!(only, seen),
                    None => assert_eq!(world.color_index_near(x, y, offset, Some(&narrowed)), seen),
                }
            }
        }
    }
    assert!(known > 100 && several > 100, "{known}, {several}");
}

/// Checks that one pixel with three hundred spheres, each as wide as the pixel, is crowded if it
/// has fewer samples than spheres. Finding the candidates of each pixel would then take longer than
/// tracing the samples one by one.
#[test]
fn a_pixel_of_more_objects_than_samples_is_crowded() {
    let pixel = 10.0 / f64::from(SIZE);
    let sphere = |index: i32| {
        let [x, y] = [index % 20, index / 20].map(|at| 8.5 + 0.02 * f64::from(at));
        sphere(pixel * dvec3(x, y, -f64::from(SIZE)), 0.5 * pixel)
    };
    let world = world(&(0..300).map(sphere).collect::<Vec<_>>());
    for samples in [100, 200, 1000] {
        let (mut crowded, mut most) = (0, 0);
        let mut visit = |part: PicturePart| {
            match part {
                PicturePart::Pixel { candidates, .. } => most = most.max(candidates.len()),
                PicturePart::Crowded { .. } => crowded += 1,
                PicturePart::OneColor { .. } => {}
            }
            ControlFlow::Continue(())
        };
        let parts = Quartering::for_samples(&world, f64::from(samples));
        let flow = parts.parts(Area::whole(SIZE, SIZE), &mut Scratch::default(), &mut visit);
        assert!(flow.is_continue());
        assert_eq!(crowded > 0, samples < 300, "{samples}");
        assert!(most <= samples as usize, "{samples}: {most}");
    }
}
