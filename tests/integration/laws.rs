//! Laws of pictures: what moving, turning, scaling and mirroring a world with its camera does to them, to the bit.
//!
//! Coordinates are multiples of 1/128, so that moving and turning them is exact.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3Swizzles, dvec3};
use pinhole::{
    math::Angle,
    scene::{CenteredTriangle, Checkerboard, Count, Method, Outline, Scene, Shape, Triangle, View},
};

use crate::{
    generated::{Numbers, generated},
    scenes::{exact, read, resized, sampled, whole, with_samples},
    tracer::{Random, is_upright},
};

/// The scenes of which a law is asked, sampled by a method.
fn worlds(seed: u64, method: Method) -> impl Iterator<Item = Scene> {
    let scenes = generated(Numbers::MultiplesOf(1.0 / 64.0), [24, 24], seed);
    let scenes = scenes.map(move |(_, scene)| {
        let mut scene = with_samples(&scene, method, Count::PerPixel(9));
        // On no surface.
        scene.camera.eye.y += 1.0 / 128.0;
        for board in shapes(&mut scene).filter_map(board) {
            board.square = 1.0;
        }
        scene
    });
    scenes.filter(is_upright).take(32)
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
            outline: Outline::Centered(triangle),
            ..
        }) => Some(triangle),
        _ => None,
    }
}

/// The same world with all places changed by one map, all directions and lengths by others.
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
            Shape::Sphere(sphere) => {
                sphere.center = place(sphere.center);
                sphere.radius *= scale;
            }
            Shape::Triangle(triangle) => match &mut triangle.outline {
                Outline::Centered(triangle) => {
                    triangle.centroid = place(triangle.centroid);
                    triangle.normal = direction(triangle.normal);
                    triangle.sides *= scale;
                }
                Outline::Vertices(vertices) => *vertices = vertices.map(&place),
            },
            Shape::Box(cuboid) => {
                let (a, b) = (place(cuboid.min), place(cuboid.max));
                (cuboid.min, cuboid.max) = (a.min(b), a.max(b));
            }
            Shape::Checkerboard(board) => {
                board.y = place(DVec3::Y * board.y).y;
                board.square *= scale;
            }
        }
    }
    scene
}

fn swap_colors(scene: &mut Scene) {
    for board in shapes(scene).filter_map(board) {
        board.colors.swap(0, 1);
    }
}

/// The pictures of two scenes are the same or each other's mirror images: sampled to the bit, and exactly as far as their bounds allow to say so.
#[track_caller]
fn agree(before: &Scene, after: &Scene, is_mirrored: bool) {
    let of = |width: u32, x: u32| if is_mirrored { width - 1 - x } else { x };
    let [one, other] = [before, after].map(sampled);
    for (x, y) in whole(before).iter() {
        let [one, other] = [one.pixel(x, y), other.pixel(of(one.width(), x), y)];
        assert_eq!(
            one.map(f64::to_bits),
            other.map(f64::to_bits),
            "{x}, {y} of {before:?}"
        );
    }
    let [before, after] = [before, after].map(|scene| resized(scene.clone(), 12, 12));
    let [one, other] = [&before, &after].map(exact);
    for (x, y) in whole(&before).iter() {
        let index = |x| (y * 12 + x) as usize;
        let (at, other_at) = (index(x), index(of(12, x)));
        let bounds = [one.bounds[at], other.bounds[other_at]].map(f64::from);
        // A rounding of each, besides.
        let most = bounds[0] + bounds[1] + f64::EPSILON;
        for (a, b) in one.film.pixels()[at]
            .iter()
            .zip(other.film.pixels()[other_at])
        {
            assert!((a - b).abs() <= most, "{x}, {y}: {a}, {b} of {before:?}");
        }
        assert!(bounds[0] <= 1e-6, "{x}, {y}: {bounds:?} of {before:?}");
    }
}

#[test]
fn quarter_turns_about_y_swap_the_boards_colours() {
    for (world, turns) in worlds(1, Method::MultiJittered).zip([1, 2, 3].into_iter().cycle()) {
        // The square at (i, j) becomes that at (j, −1 − i).
        let turn = |v: DVec3| (0..turns).fold(v, |v, _| dvec3(v.z, v.y, -v.x));
        let mut after = mapped(&world, turn, turn, 1.0);
        // A normal along the axis does not turn its triangle with it, whose base then is along the world's x: spin does.
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
        agree(&world, &after, false);
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
        agree(&world, &after, false);
    }
}

#[test]
fn scaling_by_a_power_of_two_changes_nothing() {
    let mut random = Random::new(3);
    for world in worlds(3, Method::MultiJittered) {
        let scale = libm::exp2(random.within(-900.0, 900.0).round());
        let after = mapped(&world, |p| p * scale, |v| v * scale, scale);
        agree(&world, &after, false);
    }
}

#[test]
fn a_mirror_in_x_mirrors_the_picture() {
    for world in worlds(4, Method::Regular) {
        let mirror = |v: DVec3| dvec3(-v.x, v.y, v.z);
        let mut after = mapped(&world, mirror, mirror, 1.0);
        after.camera.roll = -after.camera.roll;
        for triangle in shapes(&mut after).filter_map(centered) {
            std::mem::swap(&mut triangle.sides.x, &mut triangle.sides.y);
            triangle.spin = -triangle.spin;
        }
        swap_colors(&mut after);
        agree(&world, &after, true);
    }
}

#[test]
fn a_symmetric_scene_gives_a_symmetric_picture() {
    let mut random = Random::new(5);
    for count in (1..12).cycle().take(32) {
        let mut coordinate = || random.within(-256.0, 256.0).round() / 64.0;
        let [y, z, down, a, b, c, d] = [(); 7].map(|()| coordinate());
        let [radius, size, lens] = [(); 3].map(|()| coordinate().abs() + 0.25);
        let view = match count % 3 {
            0 => format!("lookat (0, {y} + {down} / 4, {z} + 7)"),
            _ => format!("direction (0, {down} / 4, -1)"),
        };
        // Odd and even numbers of columns and samples.
        let scene = read(&format!(
            "image {{ width {} height 24 }}
             camera {{ eye (0, {y}, {z} + 8) {view} d {lens} view_height 4 near 0.5 far 20 }}
             sampler {{ method regular per_pixel {count} }}
             sphere {{ center (0, {a}, {b}) radius {radius} color red }}
             box {{ min (-{size}, -1, {c}) max ({size}, {}, {c} + {radius}) color lime }}
             triangle {{ centroid (0, {d}, {c} + 1) normal (0, {down}, 1) color blue }}",
            24 - count % 2,
            a.abs()
        ));
        agree(&scene, &scene, true);
    }
}
