//! The warning of cameras that see nothing: when it comes, and that it is never false.

use pinhole::{
    area::Area,
    render::{Control, render_exact},
    tracer::World,
};

use super::codes;
use crate::{scenes::read, table::rows, tracer::Random};

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

#[test]
fn a_warning_is_never_false_and_comes_often_enough() {
    let mut random = Random::new(3);
    let (mut warned, mut black) = (0, 0);
    for round in 0..250 {
        let mut number = |low: f64, high: f64| random.within(low, high);
        let mut vector = |size: f64| {
            let [x, y, z] = [(); 3].map(|()| number(-size, size));
            format!("({x}, {y}, {z})")
        };
        let (a, b, c) = (vector(3.0), vector(3.0), vector(3.0));
        let radius = [0.1, 0.5, 0.9, 1.5][round % 4];
        let objects = match round % 5 {
            0 => format!("sphere {{ center {a}  radius {radius}  color white }}"),
            1 => format!("triangle {{ v0 {a}  v1 {b}  v2 {c}  color white }}"),
            2 => format!("box {{ center {a}  color white }}"),
            3 => format!("triangle {{ centroid {a}  normal {b}  color white }}"),
            _ => "checkerboard { colors (white, white) }".to_owned(),
        };
        let (eye, lookat) = (vector(4.0), vector(2.0));
        let (roll, angle) = (number(-180.0, 180.0), number(10.0, 120.0));
        let clip = match round % 3 {
            0 => format!("near {}  far {}", number(0.1, 3.0), number(3.0, 6.0)),
            _ => String::new(),
        };
        let lens = ["fov", "hfov"][round % 2];
        let text = format!(
            "image {{ width 12  height 8 }}
             camera {{ eye {eye}  lookat {lookat}  roll {roll}deg  {lens} {angle}deg  {clip} }}
             {objects}"
        );
        let is_warned = codes(&text) == "nothing_seen";
        let control = Control::default();
        let exact = render_exact(&World::new(&read(&text)), Area::whole(12, 8), &control).unwrap();
        let is_black = (0..8).all(|y| exact.film.row(y).iter().all(|pixel| pixel[0] <= 1e-9));
        assert!(is_black || !is_warned, "{text}");
        warned += u32::from(is_warned);
        black += u32::from(is_black);
    }
    // Bounds are larger than what they bound, and what is left of the window may be below the pixels' own.
    assert!(black > 75 && warned * 2 > black, "{warned} of {black}");
}
