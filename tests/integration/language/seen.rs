//! The warning of cameras that see nothing: when it comes, and that it is never false.

use pinhole::{color::Color, scene};

use super::codes;
use crate::{
    generated::{Numbers, generated},
    scenes::{exact, sources},
    table::rows,
};

/// Rows of a camera, objects, and what is said; where there are no objects, a ball is looked for.
#[test]
fn a_camera_that_sees_nothing_is_warned_of() {
    for [camera, objects, expected] in rows("
        eye (0, 1, 8)  direction (0, 0, 1) -> -> nothing_seen
        eye (0, 1, 8)  direction (1, 0, 0) -> -> nothing_seen
        eye (0, 1, 8)  lookat (0, 1, 0)  near 9.01 -> -> nothing_seen
        eye (0, 1, 8)  lookat (0, 1, 0)  far 6.99 -> -> nothing_seen
        eye (0, 1, 8)  lookat (0, 1, 0)  near 2  far 3 -> -> nothing_seen
        eye (0, 1, 8)  lookat (0, 5, 0)  hfov 10deg -> -> nothing_seen
        eye (0, 1, 8)  direction (0, 1, 0.1) -> checkerboard {} -> nothing_seen
        eye (0, 1, 8)  direction (0, 0.5, -1)  fov 50deg -> checkerboard {} -> nothing_seen
        eye (0, 0, 8)  direction (0, -1, -1) -> checkerboard {} -> nothing_seen
        eye (0, 1, 8)  direction (0, -0.1, -1)  fov 5deg  far 5 -> checkerboard {} -> nothing_seen
        eye (0, 1, 8)  direction (0, 0, 1) -> box { min (-1, 0, -1)  max (1, 2, 1) } -> nothing_seen
        eye (0, 1, 8)  direction (0, 0, 1) -> triangle { v0 (0, 0, 0)  v1 (1, 0, 0)  v2 (0, 1, 0) } -> nothing_seen
        eye (0, 1, 8)  direction (0, 0, 1) -> triangle { centroid (0, 0, 0)  normal (0, 0, 1) } -> nothing_seen
        eye (0, 1, 8)  lookat (0, 1, 0)  near 8.9 -> ->
        eye (0, 1, 8)  lookat (0, 1, 0)  far 7.1 -> ->
        -- Within, or one of them.
        eye (0, 1, 0)  direction (0, 0, 1) -> ->
        eye (0, 1, 8)  direction (0, 0, 1) -> sphere { center (0, 1, 8.5) } ->
        eye (0, 1, 8)  direction (0, 0, 1) -> sphere { center (0, 1, 0) } sphere { center (0, 1, 12) } ->
        eye (0, 1, 8)  direction (0, 0.4, -1)  fov 50deg -> checkerboard {} ->
        eye (0, 1, 8)  direction (0, -0.1, -1)  fov 5deg -> checkerboard {} ->
        eye (0, 1, 8)  direction (0, 0, 1) -> checkerboard {} ->
        -- A mistake is enough: what is missing may be what would be seen.
        eye (0, 1, 8)  direction (0, 0, 1) -> sphere { center (0, 1, 0) } sphere { centre (0, 1, 12) } -> unknown_field
    ") {
        let objects = if objects.is_empty() { "sphere { center (0, 1, 0) }" } else { objects };
        let found = codes(&format!("camera {{ {camera} }}\n{objects}"));
        assert_eq!(found, expected, "{camera}: {objects}");
    }
}

/// The first objects of generated scenes, by themselves.
#[test]
fn a_warning_is_never_false_and_comes_often_enough() {
    let (mut warned, mut black) = (0, 0);
    for (text, _) in generated(Numbers::Wild(0), [12, 8], 3).take(500) {
        let (settings, objects) = text.split_once('\n').unwrap();
        let Some(object) = objects.lines().next() else {
            continue;
        };
        let text = format!("{settings}\n{}", object.replace("black", "white"));
        let Some(mut scene) = scene::read(&sources(&text)).scene else {
            continue;
        };
        scene.image.background = Color::BLACK;
        let is_warned = codes(&text).contains("nothing_seen");
        let film = exact(&scene).film;
        let is_dark = |pixel: &[f64; 3]| pixel.iter().all(|&part| part <= 1e-9);
        let is_black = (0..8).all(|y| film.row(y).iter().all(is_dark));
        assert!(is_black || !is_warned, "{text}");
        warned += u32::from(is_warned);
        black += u32::from(is_black);
    }
    // Bounds are larger than what they bound, and what is left of the window may be below the pixels' own.
    assert!(black > 75 && warned * 2 > black, "{warned} of {black}");
}
