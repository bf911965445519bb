//! Each handle and each way in which a number can be written, in rows.

use glam::{DVec2, DVec3};
use pinhole::editor::viewport::Drag;

use super::{dragged, near, object, seen};
use crate::scenes::read;

/// A camera that looks along −z from (0, 0, 10): a metre at z = 0 has 40 pixels, y = 0 is row 50.
const LEVEL: &str =
    "image { width 200 height 100 } camera { eye (0, 0, 10) direction (0, 0, -1) d 8 }";

/// Field by field in every way in which a number can be written.
#[rustfmt::skip]
#[test]
fn a_number_changes_where_it_is_written() {
    for (scene, handle, to, word, expected) in [
        // A literal, number by number; comments and spaces stay.
        ("sphere { center (0,  0, 0) /* c */ radius 1 }", "center", [140.0, 50.0], "", "sphere { center (1,  0, 0) /* c */ radius 1 }"),
        ("sphere { center (0.0, 0.25, 0e1) }", "center", [100.0, 10.0], "", "sphere { center (0.0, 1, 0e1) }"),
        ("sphere { center (-0.5, 0, 0) }", "center", [76.0, 50.0], "", "sphere { center (-0.6, 0, 0) }"),
        // A pixel is 0.025 m: two decimals, or one where that is near enough.
        ("sphere { center (0, 0, 0) }", "center", [101.0, 50.0], "", "sphere { center (0.03, 0, 0) }"),
        ("sphere { center (0, 0, 0) }", "center", [100.25, 50.25], "", "sphere { center (0, 0, 0) }"),
        ("sphere { center (0, 0, 0) }", "center", [1e5, 50.0], "", "sphere { center (2497.5, 0, 0) }"),
        // A name, of a name; and what else has it changes too.
        ("let a = (0, 0, 0)\nlet b = a\nsphere { center b }", "center", [140.0, 50.0], "", "let a = (1, 0, 0)\nlet b = a\nsphere { center b }"),
        ("let x = 0\nsphere { center (x, 0, 0) }", "center", [140.0, 30.0], "", "let x = 1\nsphere { center (x, 0.5, 0) }"),
        ("let a = ((0, 0, 0)) // here\nsphere { center a } sphere { center a }", "center", [140.0, 50.0], "", "let a = ((1, 0, 0)) // here\nsphere { center a } sphere { center a }"),
        // Expressions: an offset, which is not added twice.
        ("let a = (0, 0, 0)\nsphere { center a * 2 }", "center", [140.0, 50.0], "", "let a = (0, 0, 0)\nsphere { center a * 2 + (1, 0, 0) }"),
        ("let a = (0, 0, 0)\nsphere { center a * 2 + (1, 0, 0) }", "center", [140.0, 30.0], "", "let a = (0, 0, 0)\nsphere { center a * 2 + (1, 0.5, 0) }"),
        ("let a = (0, 0, 0)\nsphere { center a - (1, 0, 0) }", "center", [40.0, 50.0], "", "let a = (0, 0, 0)\nsphere { center a - (1.5, 0, 0) }"),
        ("sphere { center (sqrt(4), 2 * 0.5, -sqrt(0)) }", "center", [140.0, 30.0], "", "sphere { center (sqrt(4) - 1, 2 * 0.5 - 0.5, -sqrt(0)) }"),
        ("sphere { center (sqrt(4) - 1, 0, 0) }", "center", [220.0, 50.0], "", "sphere { center (sqrt(4) + 1, 0, 0) }"),
        ("sphere { center (sqrt(4) - 1, 0, 0) }", "center", [180.0, 50.0], "", "sphere { center (sqrt(4) - 0, 0, 0) }"),
        ("sphere { center normalize((3, 0, 0)) }", "center", [100.0, 50.0], "", "sphere { center normalize((3, 0, 0)) + (-1, 0, 0) }"),
        ("sphere { center (0, 0, 0) radius 2 * 0.5 }", "radius", [100.0, 0.0], "", "sphere { center (0, 0, 0) radius 2 * 0.5 + 0.24 }"),
        ("sphere { center (0, 0, 0) radius pi }", "radius", [160.0, 50.0], "", "sphere { center (0, 0, 0) radius pi - 1.66 }"),
        // A field that is left out.
        ("sphere { center (0, 0, 0) }", "radius", [160.0, 50.0], "", "sphere { center (0, 0, 0)  radius 1.48 }"),
        ("sphere {\n  center (0, 0, 0) // c\n}", "radius", [160.0, 50.0], "", "sphere {\n  center (0, 0, 0) // c\n  radius 1.48\n}"),
        ("checkerboard {}", "y", [100.0, 60.0], "", "the handle `y` is not in front of the eye"),
        // Along an axis, or on a floor.
        ("sphere { center (0, 0, 0) }", "center", [140.0, 90.0], "x", "sphere { center (1, 0, 0) }"),
        ("sphere { center (0, 0, 0) }", "center", [140.0, 90.0], "y", "sphere { center (0, -1, 0) }"),
        ("sphere { center (1, 0, 0) }", "center", [180.0, 90.0], "z", "sphere { center (1, 0, 5) }"),
        // Just in front of the eye a pixel is 0.000 000 000 04 m.
        ("sphere { center (1, 0, 0) }", "center", [3_000_100.0, 50.0], "z", "sphere { center (1, 0, 9.99986666667) }"),
        ("sphere { center (0, 0, 0) }", "center", [180.0, 90.0], "z", "not seen there"),
        ("sphere { center (1, 0, 0) }", "center", [99.0, 50.0], "z", "not seen there"),
        ("sphere { center (0, -1, 0) }", "center", [140.0, 70.0], "floor", "sphere { center (2, -1, -10) }"),
        ("sphere { center (0, -1, 0) }", "center", [140.0, 50.0], "floor", "not seen there"),
        // Boxes in both forms: the other face stays.
        ("box { center (0, 0, 0) size (1, 1, 1) }", "center", [140.0, 50.0], "", "box { center (1, 0, 0) size (1, 1, 1) }"),
        ("box { min (0, 0, 0) max (1, 1, 1) }", "center", [160.0, 30.0], "", "box { min (0.93, -0.02, 0) max (1.93, 0.98, 1) }"),
        ("box { min (0, 0, -1) max (1, 1, 1) }", "max_x", [180.0, 80.0], "", "box { min (0, 0, -1) max (2, 1, 1) }"),
        ("box { center (0, 0, 0) size (1, 1, 1) }", "max_x", [140.0, 80.0], "", "box { center (0.25, 0, 0) size (1.5, 1, 1) }"),
        ("box { center (0, 0, 0) size (1, 1, 1) }", "max_x", [60.0, 80.0], "", "the scene would not be right any more: "),
        ("box { center (0, 0, 0) }", "min_y", [100.0, 90.0], "", "box { center (0, -0.12, 0)  size (0.5, 1.75, 2) }"),
        // Triangles in both forms.
        ("triangle { centroid (0, 0, 0) normal (0, 0, 2) }", "centroid", [140.0, 50.0], "", "triangle { centroid (1, 0, 0) normal (0, 0, 2) }"),
        ("triangle { centroid (0, 0, 0) normal (0, 0, 2) }", "spin", [140.0, 50.0], "", "triangle { centroid (0, 0, 0) normal (0, 0, 2)  spin -90deg }"),
        ("triangle { centroid (0, 0, 0) normal (0, 0, 2) spin 1rad }", "spin", [100.0, 10.0], "", "triangle { centroid (0, 0, 0) normal (0, 0, 2) spin 0rad }"),
        ("triangle { v0 (0, 0, 0) v1 (1, 0, 0) v2 (0, 1, 0) }", "v1", [180.0, 50.0], "", "triangle { v0 (0, 0, 0) v1 (2, 0, 0) v2 (0, 1, 0) }"),
        ("triangle { v0 (0, 0, 0) v1 (1, 0, 0) v2 (0, 1, 0) }", "v1", [100.0, 50.0], "", "the scene would not be right any more: the vertices lie on one line, and form no triangle"),
        ("triangle { v0 (0, 0, 0) v1 (1, 0, 0) v2 (0, 1, 0) }", "center", [153.0, 36.0], "", "triangle { v0 (0.99, 0.02, 0) v1 (1.99, 0.02, 0) v2 (0.99, 1.02, 0) }"),
        // What is behind the eye, or too far away, or tied.
        ("sphere { center (0, 0, 20) }", "center", [140.0, 50.0], "", "not in front of the eye"),
        ("sphere { center (0, 0, 0) }", "radius", [1e300, 50.0], "", "cannot come so far"),
        ("let a = 0\nsphere { center (a, a, 0) }", "center", [140.0, 50.0], "", "ties"),
        ("let a = 0\nsphere { center (a, a, 0) }", "center", [140.0, 30.0], "", "ties"),
        ("let a = 1\nsphere { center (0, 0, 0) radius a }\nsphere { center (a, a, a) radius 2 - a }", "radius", [190.0, 50.0], "", "the scene would not be right any more: `radius` must be more than 0, and it is "),
        ("sphere { center (0, 0, 0) }", "apex", [140.0, 50.0], "", "has no handle `apex`"),
    ] {
        let text = format!("{LEVEL}\n{scene}");
        let found = match dragged(&text, object(handle, to, word)) {
            Ok(text) => text[LEVEL.len() + 1..].to_owned(),
            Err(why) => why,
        };
        match expected.contains('{') {
            true => assert_eq!(found, expected, "{scene} {handle} {to:?} {word}"),
            false => assert!(
                found.contains(expected),
                "{scene} {handle} {to:?} {word}: {found}"
            ),
        }
    }
}

/// From (0, 4, 4) half down, where the view axis meets the floor at the origin: a point s above it is seen 400 s/(8 − s) pixels higher.
#[test]
fn a_board_is_raised_and_lowered() {
    let view = "image { width 200 height 100 } camera { eye (0, 4, 4) direction (0, -1, -1) d 8 }";
    for (to, y) in [
        ([100.0, 30.0], "0.38"),
        ([150.0, 60.0], "-0.2"),
        ([100.0, 50.4], "0"),
    ] {
        let text = |y: &str| format!("{view}\ncheckerboard {{ y {y} }}");
        let found = dragged(&text("0"), object("y", to, ""));
        assert_eq!(found, Ok(text(y)));
    }
}

/// What the pointer does to each form of a camera, with roll and without; and that what is seen at a point goes with it.
#[rustfmt::skip]
#[test]
fn the_pointer_moves_the_camera() {
    let rest = "image { width 400 height 200 }\nsphere { center (0, 1, 0) }\ncheckerboard {}\n";
    for (before, handle, [from, to], after, seen_point) in [
        ("eye (0, 1, 8) lookat (0, 1, 0)", "orbit", [[200.0, 100.0], [250.0, 80.0]], "eye (-5.38, -1.47, 5.38) lookat (0, 1, 0)", Some([0.0, 1.0, 1.0])),
        ("eye (0, 1, 8) direction (0, 0, -3)", "orbit", [[200.0, 100.0], [250.0, 80.0]], "eye (-4.71, -1.16, 5.71) direction (2.02, 0.93, -2.02)", Some([0.0, 1.0, 2.0])),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "orbit", [[200.0, 100.0], [200.0, 1000.0]], "eye (0, 9, 0.14) lookat (0, 1, 0)", Some([0.0, 1.0, 1.0])),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "orbit", [[200.0, 100.0], [200.0, -1000.0]], "eye (0, -7, 0.14) lookat (0, 1, 0)", Some([0.0, 1.0, 1.0])),
        ("eye (0, 9, 0) lookat (0, 1, 0) up (0, 1, 0)", "orbit", [[200.0, 100.0], [200.0, 50.0]], "eye (0, 6.66, 5.66) lookat (0, 1, 0) up (0, 1, 0)", Some([0.0, 2.0, 0.0])),
        ("eye (0, 1, 8) lookat (0, 1, 0) roll 90deg", "orbit", [[200.0, 100.0], [200.0, 150.0]], "eye (5.66, 1, 5.66) lookat (0, 1, 0) roll 90deg", Some([0.0, 1.0, 1.0])),
        ("eye (3, 3.5, 8) lookat (0.2, 0.8, 0)", "pan", [[200.0, 100.0], [250.0, 80.0]], "eye (0.99, 2.65, 8.99) lookat (-1.81, -0.05, 0.99)", Some([0.2, 0.8, 0.0])),
        ("eye (3, 3.5, 8) direction (-3, -2.5, -8)", "pan", [[200.0, 100.0], [250.0, 80.0]], "eye (1.23, 2.74, 8.9) direction (-3, -2.5, -8)", Some([0.0, 1.0, 0.0])),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "dolly", [[0.0, 0.0], [0.0, 100.0]], "eye (0, 1, 4) lookat (0, 1, 0)", None),
        ("eye (0, 1, 8) direction (0, 0, -1)", "dolly", [[0.0, 100.0], [0.0, 0.0]], "eye (0, 1, 15) direction (0, 0, -1)", None),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "roll", [[300.0, 100.0], [200.0, 150.0]], "eye (0, 1, 8) lookat (0, 1, 0)  roll -90deg", Some([1.0, 1.0, 0.0])),
        ("eye (0, 1, 8) lookat (0, 1, 0) roll 1.5rad", "roll", [[300.0, 100.0], [300.0, 200.0]], "eye (0, 1, 8) lookat (0, 1, 0) roll 0.715rad", None),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "view_distance", [[0.0, 0.0], [0.0, 100.0]], "eye (0, 1, 8) lookat (0, 1, 0)  d 1", Some([0.0, 2.0, 0.0])),
        ("eye (0, 1, 8) lookat (0, 1, 0) fov 90deg", "view_distance", [[0.0, 0.0], [0.0, 100.0]], "eye (0, 1, 8) lookat (0, 1, 0) fov 126.9deg", Some([0.0, 2.0, 0.0])),
        ("eye (0, 1, 8) lookat (0, 1, 0) hfov 0.5rad", "view_distance", [[0.0, 100.0], [0.0, 0.0]], "eye (0, 1, 8) lookat (0, 1, 0) hfov 0.254rad", Some([0.0, 1.1, 0.0])),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "look", [[200.0, 100.0], [260.0, 100.0]], "eye (0, 1, 8) lookat (-6.47, 1, 3.3)", Some([0.0, 1.0, 0.0])),
        ("eye (0, 1, 8) direction (0, 0, -3)", "look", [[200.0, 100.0], [200.0, 50.0]], "eye (0, 1, 8) direction (0, -2, -2)", Some([0.0, 1.0, 0.0])),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "twist", [[200.0, 100.0], [200.0, 50.0]], "a camera has no handle `twist`", None),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "roll", [[200.0, 100.0], [200.0, 50.0]], "the middle of the picture has no direction to roll to", None),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "dolly", [[200.0, 0.0], [200.0, 1e9]], "that is too far away", None),
        ("eye (0, 1, 8) lookat (0, 1, 0)", "pan", [[200.0, 0.0], [200.0, f64::INFINITY]], "the pointer is nowhere", None),
    ] {
        let text = format!("{rest}camera {{ {before} }}");
        let [from, to] = [from, to].map(DVec2::from);
        let found = match dragged(&text, Drag { object: None, handle, from, to, along: None }) {
            Ok(text) => text,
            Err(why) => {
                assert_eq!(why, after);
                continue;
            }
        };
        assert_eq!(found, format!("{rest}camera {{ {after} }}"), "{before} {handle}");
        if let Some(point) = seen_point {
            let point = DVec3::from(point);
            let [before, after] = [&text, &found].map(|text| seen(&read(text), point));
            assert!((after - before).dot(to - from) > 0.0, "{found} {handle}: {before} {after}");
            if handle == "pan" && point.z == 0.0 && point.y == 0.8 {
                near(after, to, &found);
            }
        }
    }
}
