//! Tests of laws of pictures: how a picture changes, to the bit, if the whole scene is moved,
//! turned, scaled or mirrored together with its camera.
//!
//! Coordinates are multiples of 1/128, so moving and turning them is exact.

use std::{collections::HashSet, sync::Arc};

use glam::{DVec2, DVec3, Vec3Swizzles, dvec3};
use pinhole::{
    math::Angle,
    scene::{
        CenteredTriangle, Checkerboard, Count, Cuboid, Method, Scene, Shape, Sphere, Triangle,
        TriangleOutline, View,
    },
};

use crate::{
    exact::{difference, pixel},
    generated::{Numbers, generated},
    random::Random,
    scenes::{exact, resized, sampled, whole, with_samples},
    tracer::is_upright,
};

/// Generates the scenes on which a law is tested. Their sampling method is `method`, with 9 samples
/// per pixel.
fn worlds(seed: u64, method: Method) -> impl Iterator<Item = Scene> {
    let scenes = generated(Numbers::MultiplesOf(1.0 / 64.0), [24, 24], seed);
    let scenes = scenes.map(move |(_, scene)| {
        let mut scene = with_samples(&scene, method, Count::PerPixel(9));
        // The eye is moved away from all surfaces, so that no ray lies in a surface.
        scene.camera.eye.y += 1.0 / 128.0;
        for board in shapes(&mut scene).filter_map(board) {
            board.square = 1.0;
        }
        scene
    });
    // Only scenes that have a checkerboard and more than two colours in the picture are used.
    let is_full = |scene: &Scene| {
        let mut objects = scene.objects.iter();
        let has_board = objects.any(|object| matches!(object.shape, Shape::Checkerboard(_)));
        let seen = sampled(scene);
        let colors: HashSet<_> = seen
            .pixels()
            .iter()
            .map(|pixel| pixel.map(f64::to_bits))
            .collect();
        has_board && colors.len() > 2
    };
    scenes.filter(is_upright).filter(is_full).take(32)
}

fn shapes(scene: &mut Scene) -> impl Iterator<Item = &mut Shape> {
    let objects = Arc::make_mut(&mut scene.objects).iter_mut();
    objects.map(|object| &mut object.shape)
}

fn board(shape: &mut Shape) -> Option<&mut Checkerboard> {
    match shape {
        Shape::Checkerboard(board) => Some(board),
        _ => None,
    }
}

fn centered(shape: &mut Shape) -> Option<&mut CenteredTriangle> {
    match shape {
        Shape::Triangle(Triangle {
            outline: TriangleOutline::Centered(triangle),
            ..
        }) => Some(triangle),
        _ => None,
    }
}

/// Maps all points of a scene by `place` and all directions by `direction`, and multiplies all
/// lengths by `scale`.
fn mapped(
    scene: &Scene,
    place: impl Fn(DVec3) -> DVec3,
    direction: impl Fn(DVec3) -> DVec3,
    scale: f64,
) -> Scene {
    let mut scene = scene.clone();
    let camera = &mut scene.camera;
    (camera.eye, camera.up) = (place(camera.eye), direction(camera.up));
    camera.view = match camera.view {
        View::Lookat(at) => View::Lookat(place(at)),
        View::Direction(along) => View::Direction(direction(along)),
    };
    camera.near *= scale;
    camera.far = camera.far.map(|far| far * scale);
    for shape in shapes(&mut scene) {
        match shape {
            Shape::Sphere(Sphere {
                center,
                radius,
                color: _,
            }) => {
                *center = place(*center);
                *radius *= scale;
            }
            Shape::Triangle(triangle) => match &mut triangle.outline {
                TriangleOutline::Centered(CenteredTriangle {
                    centroid,
                    normal,
                    sides,
                    spin: _,
                }) => {
                    *centroid = place(*centroid);
                    *normal = direction(*normal);
                    *sides *= scale;
                }
                TriangleOutline::Vertices(vertices) => *vertices = vertices.map(&place),
            },
            Shape::Box(Cuboid {
                min,
                max,
                color: _,
                faces: _,
            }) => {
                let (a, b) = (place(*min), place(*max));
                (*min, *max) = (a.min(b), a.max(b));
            }
            Shape::Checkerboard(Checkerboard {
                y,
                square,
                colors: _,
            }) => {
                *y = place(DVec3::Y * *y).y;
                *square *= scale;
            }
            other => panic!("how {other:?} scales is not said"),
        }
    }
    scene
}

fn swap_colors(scene: &mut Scene) {
    for board in shapes(scene).filter_map(board) {
        board.colors.swap(0, 1);
    }
}

/// Asserts that two scenes have the same pixels at different positions. `goes` returns the new
/// position of a pixel; its arguments are the picture's width and the old position. Sampled
/// pictures must have the same bits. Exact pictures must agree within their error bounds.
#[track_caller]
fn assert_pictures_agree(before: &Scene, after: &Scene, goes: impl Fn(u32, [u32; 2]) -> [u32; 2]) {
    let [one, other] = [before, after].map(sampled);
    for (x, y) in whole(before).iter() {
        let [other_x, other_y] = goes(one.width(), [x, y]);
        let [one, other] = [one.pixel(x, y), other.pixel(other_x, other_y)];
        assert_eq!(
            one.map(f64::to_bits),
            other.map(f64::to_bits),
            "{x}, {y} of {before:?}"
        );
    }
    let [width, height] = [before.image.width, before.image.height].map(|pixels| pixels / 2);
    let [before, after] = [before, after].map(|scene| resized(scene.clone(), width, height));
    let [one, other] = [&before, &after].map(exact);
    for (x, y) in whole(&before).iter() {
        let [other_x, other_y] = goes(width, [x, y]);
        let (light, bound) = pixel(&one, x, y);
        let (other, other_bound) = pixel(&other, other_x, other_y);
        let difference = difference(light, other);
        // The light of each pixel is rounded, and the pixel's error bound need not include this
        // rounding. Therefore, `f64::EPSILON` is added for the two pixels.
        let most = bound + other_bound + f64::EPSILON;
        assert!(difference <= most, "{x}, {y}: {difference:e} of {before:?}");
        assert!(bound <= 1e-6, "{x}, {y}: {bound:e} of {before:?}");
    }
}

#[test]
fn quarter_turns_about_y_swap_the_boards_colours() {
    for (world, turns) in worlds(1, Method::MultiJittered).zip([1, 2, 3].into_iter().cycle()) {
        // A quarter turn moves the square of the board with the indices (i, j) to (j, −1 − i). The
        // sum of the indices then changes between even and odd, so the two colours are swapped.
        let turn = |v: DVec3| (0..turns).fold(v, |v, _| dvec3(v.z, v.y, -v.x));
        let mut after = mapped(&world, turn, turn, 1.0);
        // If the normal of a triangle is vertical, the base is by definition parallel to the x
        // axis. A turn about y does not change such a normal, so the triangle's spin is changed
        // instead.
        for triangle in shapes(&mut after).filter_map(centered) {
            if triangle.normal.xz() == DVec2::ZERO {
                let degrees = 90.0 * f64::from(turns);
                let turn = Angle::from_degrees(degrees.copysign(triangle.normal.y));
                triangle.spin = triangle.spin + turn;
            }
        }
        if turns % 2 == 1 {
            swap_colors(&mut after);
        }
        assert_pictures_agree(&world, &after, |_, at| at);
    }
}

#[test]
fn moving_by_squares_swaps_the_boards_colours_if_they_are_odd() {
    let mut random = Random::new(2);
    for world in worlds(2, Method::MultiJittered) {
        let [x, z] = [(); 2].map(|()| random.within(-1e6, 1e6).round());
        let by = dvec3(x, random.within(-256.0, 256.0).round() / 64.0, z);
        let mut after = mapped(&world, |p| p + by, |v| v, 1.0);
        if (x + z) % 2.0 != 0.0 {
            swap_colors(&mut after);
        }
        assert_pictures_agree(&world, &after, |_, at| at);
    }
}

#[test]
fn scaling_by_a_power_of_two_changes_nothing() {
    let mut random = Random::new(3);
    for world in worlds(3, Method::MultiJittered) {
        let scale = libm::exp2(random.within(-900.0, 900.0).round());
        let after = mapped(&world, |p| p * scale, |v| v * scale, scale);
        assert_pictures_agree(&world, &after, |_, at| at);
    }
}

#[test]
fn a_mirror_in_x_mirrors_the_picture() {
    // Pictures with an even and with an odd number of columns are tested in turn: with an odd
    // number, the middle column is its own mirror image.
    for (world, width) in worlds(4, Method::Regular).zip([24, 23].into_iter().cycle()) {
        let world = resized(world, width, 24);
        let mirror = |v: DVec3| dvec3(-v.x, v.y, v.z);
        let mut after = mapped(&world, mirror, mirror, 1.0);
        after.camera.roll = -after.camera.roll;
        for triangle in shapes(&mut after).filter_map(centered) {
            std::mem::swap(&mut triangle.sides.x, &mut triangle.sides.y);
            triangle.spin = -triangle.spin;
        }
        swap_colors(&mut after);
        assert_pictures_agree(&world, &after, |width, [x, y]| [width - 1 - x, y]);
    }
}

#[test]
fn a_quarter_roll_turns_the_picture() {
    for world in worlds(5, Method::Regular) {
        let mut after = world.clone();
        after.camera.roll.degrees += 90.0;
        // A camera that is rolled to the right sees the scene turned counter-clockwise.
        assert_pictures_agree(&world, &after, |width, [x, y]| [y, width - 1 - x]);
    }
}
