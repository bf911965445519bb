//! Pixels against closed forms, and pictures against samples.

use super::*;
use crate::table::rows;

/// A picture of one pixel: how much of it an object in white covers.
fn share(camera: &str, object: &str) -> (f64, f64) {
    let scene = read(&format!(
        "image {{ width 1 height 1 }} camera {{ {camera} }} {object}"
    ));
    let exact = exact(&scene);
    (exact.film.pixel(0, 0)[0], exact.bound())
}

fn is_share(camera: &str, object: &str, expected: f64) {
    let (found, bound) = share(camera, object);
    let difference = (found - expected).abs();
    assert!(bound <= 1e-12, "{object}: bound {bound:e}");
    assert!(
        difference <= bound + 4.0 * f64::EPSILON,
        "{object}: {found} for {expected}, {difference:e}"
    );
}

#[test]
fn half_planes() {
    // The pixel is 2 wide at distance 1; the box's right side is seen at x/4, or at x/5 where its side face is seen, too.
    for edge in [-3.5f64, -0.25, 0.0, 1.0, 3.0] {
        let object = format!("box {{ min (-100, -100, -5) max ({edge}, 100, -4) color white }}");
        let expected = 0.5 + edge / if edge < 0.0 { 10.0 } else { 8.0 };
        let camera = "eye (0, 0, 0) direction (0, 0, -1) d 1";
        is_share(camera, &object, expected);
        is_share(&format!("{camera} roll 90deg"), &object, expected);
    }
    // Rolled by 45° about an edge through the pixel's centre, and by any angle: half of it.
    for roll in [45.0, 1e-9, 17.0, 89.999999] {
        let camera = format!("eye (0, 0, 0) direction (0, 0, -1) d 1 roll {roll}deg");
        is_share(
            &camera,
            "box { min (-100, -100, -5) max (0, 100, -4) color white }",
            0.5,
        );
    }
}

#[test]
fn discs_and_ellipses() {
    // The silhouette of a sphere on the axis is a circle of radius R/√(D² − R²) at distance 1.
    for radius in [0.7f64, 0.1, 1e-3, 1e-6] {
        let circle = radius * radius / (1.0 - radius * radius);
        if circle < 1.0 {
            let object = format!("sphere {{ center (0, 0, -1) radius {radius} color white }}");
            is_share(
                "eye (0, 0, 0) direction (0, 0, -1) d 1",
                &object,
                PI * circle / 4.0,
            );
        }
    }
    // Off the axis it is an ellipse of area πR²√C/(z² − R²)^(3/2), C = c·c − R², z the centre's depth.
    for (x, y, z, radius) in [
        (0.3, 0.2, 1.0, 0.25),
        (-0.5, 0.4, 1.0, 0.2),
        (2.0, -1.0, 4.0, 1.0f64),
    ] {
        let power: f64 = x * x + y * y + z * z - radius * radius;
        let depth: f64 = z * z - radius * radius;
        let area = PI * radius * radius * power.sqrt() / (depth * depth.sqrt());
        let object = format!("sphere {{ center ({x}, {y}, -{z}) radius {radius} color white }}");
        is_share(
            "eye (0, 0, 0) direction (0, 0, -1) d 1",
            &object,
            area / 4.0,
        );
    }
}

#[test]
fn squares_from_above() {
    // From height 1 the pixel shows [−1, 1]²: 2 × 2 squares of side 1, and what is left of larger ones.
    let camera = "eye (0, 1, 0) direction (0, -1, 0) up (0, 0, -1) d 1";
    let board = |square: f64| format!("checkerboard {{ square {square} colors (white, black) }}");
    is_share(camera, &board(1.0), 0.5);
    is_share(camera, &board(0.125), 0.5);
    let moved = "eye (0.25, 1, 0.5) direction (0, -1, 0) up (0, 0, -1) d 1";
    // s integrates to −1/2 over x from −3/4 to 5/4, and to 1 · −1/2 … over z from −1/2 to 3/2.
    is_share(moved, &board(1.0), 0.5);
    let moved = "eye (0.25, 0.75, 0.5) direction (0, -1, 0) up (0, 0, -1) d 1";
    // x from −1/2 to 1: +1 − 1/2; z from −1/4 to 5/4: −1/4 + 1 − 1/4; of an area of (3/2)².
    is_share(moved, &board(1.0), 0.5 + 0.5 * (0.5 * 0.5) / 2.25);
}

#[test]
fn samples_agree_within_their_statistical_error() {
    let mut random = Random::new(20);
    for round in 0..24 {
        let scene = random_scene(&mut random, round % 3 != 0);
        agrees_with_samples(&scene, &exact(&scene), 1024, &format!("round {round}"));
    }
}

#[test]
fn lines_that_are_vertical_but_for_roundings() {
    // The camera looks at an edge of the box, which is the middle column's side, and a sphere's outline crosses it.
    for [camera, objects] in rows("
        eye (2, 0, 3) lookat (1, -1, 0) d 0.5 near 3 -> sphere { center (-1, 2, -1.5) radius 1.5 color white } box { min (1, -2, -1) max (2, -1.5, 0) color white }
        eye (1, 3.5, 7.5) lookat (-1.5, 1, 1) d 1 -> box { min (-1.5, 0, -1) max (-0.5, 3, 1) color white } sphere { center (-1, 1, 1) radius 1.5 color black }
    ") {
        // An odd number of columns has that line in the middle of pixels.
        for (width, height) in [(4, 3), (12, 9), (64, 36), (13, 7)] {
            let text = format!("image {{ width {width} height {height} }} camera {{ {camera} }} {objects}");
            let whole = Area::whole(width, height);
            let bound = part_adds_up(&read(&text), whole, &text).bound();
            assert!(bound <= 1e-12, "{text}: {bound:e}");
        }
    }
}
