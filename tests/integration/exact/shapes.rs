//! Compares exact pixels with values from closed formulas.

use std::f64::consts::PI;

use super::*;

const AHEAD: &str = "eye (0, 0, 0) direction (0, 0, -1) d 1";

/// Asserts that a white object covers the fraction `expected` of a picture of one pixel.
#[track_caller]
fn assert_coverage(camera: &str, object: &str, expected: f64) {
    let scene = read(&format!(
        "image {{ width 1 height 1 }} camera {{ {camera} }} {object}"
    ));
    let ([found, ..], bound) = pixel(&exact(&scene), 0, 0);
    let difference = (found - expected).abs();
    assert!(
        bound <= 1e-12 && difference <= bound + 4.0 * f64::EPSILON,
        "{object}: {found} for {expected}, {difference:e} of {bound:e}"
    );
}

#[test]
fn half_plane_coverage_matches_the_closed_form() {
    // The view plane has the distance 1 and shows x from −1 to 1. The right face of the box reaches
    // from depth 4 to depth 5. The box ends at x = edge/5 in the picture if this face is visible,
    // and otherwise at x = edge/4.
    for edge in [-3.5f64, -0.25, 0.0, 1.0, 3.0] {
        let object = format!("box {{ min (-100, -100, -5) max ({edge}, 100, -4) color white }}");
        let expected = 0.5 + edge / if edge < 0.0 { 10.0 } else { 8.0 };
        assert_coverage(AHEAD, &object, expected);
        assert_coverage(&format!("{AHEAD} roll 90deg"), &object, expected);
    }
    // If the edge of a plane surface passes through the pixel's centre, the surface covers half of
    // the pixel, whatever the roll is.
    for object in list(
        "
        box { min (-100, -100, -5) max (0, 100, -4) color white }
        triangle { v0 (0, 1e97, -4) v1 (0, -9, -4) v2 (-9, -9, -4) color white }
        triangle { v0 (0, 1e308, -4) v1 (0, -1e307, -4) v2 (-9, -9, -4) color white }
        ",
    ) {
        for roll in [45.0, 1e-9, 17.0, 89.999999] {
            assert_coverage(&format!("{AHEAD} roll {roll}deg"), object, 0.5);
        }
    }
}

/// The silhouette of a sphere of radius R is an ellipse of the area πR²√C/(z² − R²)^(3/2). In this
/// formula, z is the depth of the centre, and C = c·c − R², where c is the vector from the eye to
/// the centre. If the centre is on the view axis, the ellipse is a circle.
#[test]
fn sphere_coverage_matches_the_area_of_an_ellipse() {
    for (x, y, z, radius) in [
        (0.0, 0.0, 1.0, 0.7f64),
        (0.0, 0.0, 1.0, 0.1),
        (0.0, 0.0, 1.0, 1e-3),
        (0.0, 0.0, 1.0, 1e-6),
        (0.3, 0.2, 1.0, 0.25),
        (-0.5, 0.4, 1.0, 0.2),
        (2.0, -1.0, 4.0, 1.0),
    ] {
        let power: f64 = x * x + y * y + z * z - radius * radius;
        let depth: f64 = z * z - radius * radius;
        let area = PI * radius * radius * power.sqrt() / (depth * depth.sqrt());
        let object = format!("sphere {{ center ({x}, {y}, -{z}) radius {radius} color white }}");
        assert_coverage(AHEAD, &object, area / 4.0);
    }
}

#[test]
fn board_coverage_from_above_matches_the_closed_form() {
    // In the first two rows, the eye is at the height 1 and the pixel shows the area [−1, 1]² of
    // the board. Mirroring this area in the z axis exchanges the two colours, so half of it is
    // white.
    for (eye, square, expected) in [
        ("(0, 1, 0)", 1.0, 0.5),
        ("(0, 1, 0)", 0.125, 0.5),
        // Let s be 1 and −1 in alternate squares along an axis. A square is white if s(x)·s(z) = 1.
        // The pixel shows x from −3/4 to 5/4 and z from −1/2 to 3/2. This is a whole period of s
        // along each axis, so both integrals of s are 0, and half of the pixel is white.
        ("(0.25, 1, 0.5)", 1.0, 0.5),
        // Let s be 1 and −1 in alternate squares along an axis. The pixel shows the part of the
        // board with x from −1/2 to 1 and z from −1/4 to 5/4. The integral of s over x is −1/2 + 1,
        // and over z it is −1/4 + 1 − 1/4. The area of the part is (3/2)².
        ("(0.25, 0.75, 0.5)", 1.0, 0.5 + 0.5 * (0.5 * 0.5) / 2.25),
    ] {
        let camera = format!("eye {eye} direction (0, -1, 0) up (0, 0, -1) d 1");
        let board = format!("checkerboard {{ square {square} colors (white, black) }}");
        assert_coverage(&camera, &board, expected);
    }
}

#[test]
fn nearly_vertical_lines_are_known_and_add_up() {
    // The camera looks at an edge of the box, which appears in the middle of the picture. The
    // silhouette of a sphere crosses this edge.
    for [camera, objects] in rows("
        eye (2, 0, 3) lookat (1, -1, 0) d 0.5 near 3 -> sphere { center (-1, 2, -1.5) radius 1.5 color white } box { min (1, -2, -1) max (2, -1.5, 0) color white }
        eye (1, 3.5, 7.5) lookat (-1.5, 1, 1) d 1 -> box { min (-1.5, 0, -1) max (-0.5, 3, 1) color white } sphere { center (-1, 1, 1) radius 1.5 color black }
    ") {
        // If the number of columns is odd, the edge of the box runs through the middle of pixels.
        for (width, height) in [(4, 3), (12, 9), (64, 36), (13, 7)] {
            let text = format!("image {{ width {width} height {height} }} camera {{ {camera} }} {objects}");
            let bound = assert_part_adds_up(&read(&text), Area::whole(width, height)).bound();
            assert!(bound <= 1e-12, "{text}: {bound:e}");
        }
    }
}
