//! Handles of a picture that are moved, and what becomes of the text.

use glam::{DVec2, DVec3, dvec2};
use pinhole::{
    diagnostic::{Fix, apply},
    editor::{
        Analysis,
        picture::{Along, Drag, Overlays, drag, overlays},
    },
    inspect::inspect,
    probe::probe,
    scene::{self, Scene, Shape, View},
    source::SourceId,
};
use proptest::prelude::*;

use super::sources;

/// A text after a handle was moved, and what is said of it; or why it cannot be.
fn dragged(text: &str, moved: Drag<'_>) -> Result<(String, String), String> {
    let sources = sources(text);
    let analysis = Analysis::new(&sources);
    let scene = analysis
        .scene()
        .unwrap_or_else(|| panic!("no scene: {text}"));
    let dragged = drag(&analysis, &scene, &moved)?;
    let fix = Fix::new("", dragged.edits);
    let text = apply(&fix, SourceId::File, text);
    Ok((text, dragged.values.join("; ")))
}

fn scene_of(text: &str) -> Scene {
    let reading = scene::read(&sources(text));
    let scene = reading.scene;
    scene.unwrap_or_else(|| panic!("{text}: {:?}", reading.diagnostics))
}

fn along(word: &str) -> Option<Along> {
    match word {
        "x" => Some(Along::Axis(0)),
        "y" => Some(Along::Axis(1)),
        "z" => Some(Along::Axis(2)),
        "floor" => Some(Along::Floor),
        _ => None,
    }
}

fn object<'a>(handle: &'a str, to: [f64; 2], word: &str) -> Drag<'a> {
    Drag {
        object: Some(0),
        handle,
        from: DVec2::from(to),
        to: DVec2::from(to),
        along: along(word),
    }
}

fn camera(handle: &str, from: [f64; 2], to: [f64; 2]) -> Drag<'_> {
    Drag {
        object: None,
        handle,
        from: DVec2::from(from),
        to: DVec2::from(to),
        along: None,
    }
}

/// Where a point is seen, by the numbers of `pinhole inspect`.
fn seen(scene: &Scene, point: DVec3) -> DVec2 {
    let camera = inspect(scene, &sources("").file).camera;
    let from_eye = point - camera.eye;
    let (width, height) = (f64::from(scene.image.width), f64::from(scene.image.height));
    let scale = camera.d * height / camera.view_height / -from_eye.dot(camera.w);
    dvec2(
        width / 2.0 + from_eye.dot(camera.u) * scale,
        height / 2.0 - from_eye.dot(camera.v) * scale,
    )
}

fn near(a: DVec2, b: DVec2, text: &str) {
    assert!(a.distance(b) <= 0.5 + 1e-6, "{a} is not near {b}\n{text}");
}

/// A camera that looks along −z from (0, 0, 10): a metre at z = 0 has 40 pixels, y = 0 is row 50.
const LEVEL: &str =
    "image { width 200 height 100 } camera { eye (0, 0, 10) direction (0, 0, -1) d 8 }";

/// Field by field in every way in which a number can be written.
#[rustfmt::skip]
#[test]
fn a_number_changes_where_it_is_written() {
    for (scene, handle, to, word, expected) in [
        // A literal, number by number; comments and spaces stay.
        (
            "sphere { center (0,  0, 0) /* c */ radius 1 }",
            "center",
            [140.0, 50.0],
            "",
            "sphere { center (1,  0, 0) /* c */ radius 1 }",
        ),
        (
            "sphere { center (0.0, 0.25, 0e1) }",
            "center",
            [100.0, 10.0],
            "",
            "sphere { center (0.0, 1, 0e1) }",
        ),
        (
            "sphere { center (-0.5, 0, 0) }",
            "center",
            [76.0, 50.0],
            "",
            "sphere { center (-0.6, 0, 0) }",
        ),
        // A pixel is 0.025 m: two decimals, or one where that is near enough.
        (
            "sphere { center (0, 0, 0) }",
            "center",
            [101.0, 50.0],
            "",
            "sphere { center (0.03, 0, 0) }",
        ),
        (
            "sphere { center (0, 0, 0) }",
            "center",
            [100.25, 50.25],
            "",
            "sphere { center (0, 0, 0) }",
        ),
        (
            "sphere { center (0, 0, 0) }",
            "center",
            [1e5, 50.0],
            "",
            "sphere { center (2497.5, 0, 0) }",
        ),
        // A name, of a name; and what else has it changes too.
        (
            "let a = (0, 0, 0)\nlet b = a\nsphere { center b }",
            "center",
            [140.0, 50.0],
            "",
            "let a = (1, 0, 0)\nlet b = a\nsphere { center b }",
        ),
        (
            "let x = 0\nsphere { center (x, 0, 0) }",
            "center",
            [140.0, 30.0],
            "",
            "let x = 1\nsphere { center (x, 0.5, 0) }",
        ),
        (
            "let a = ((0, 0, 0)) // here\nsphere { center a } sphere { center a }",
            "center",
            [140.0, 50.0],
            "",
            "let a = ((1, 0, 0)) // here\nsphere { center a } sphere { center a }",
        ),
        // Expressions: an offset, which is not added twice.
        (
            "let a = (0, 0, 0)\nsphere { center a * 2 }",
            "center",
            [140.0, 50.0],
            "",
            "let a = (0, 0, 0)\nsphere { center a * 2 + (1, 0, 0) }",
        ),
        (
            "let a = (0, 0, 0)\nsphere { center a * 2 + (1, 0, 0) }",
            "center",
            [140.0, 30.0],
            "",
            "let a = (0, 0, 0)\nsphere { center a * 2 + (1, 0.5, 0) }",
        ),
        (
            "let a = (0, 0, 0)\nsphere { center a - (1, 0, 0) }",
            "center",
            [40.0, 50.0],
            "",
            "let a = (0, 0, 0)\nsphere { center a - (1.5, 0, 0) }",
        ),
        (
            "sphere { center (sqrt(4), 2 * 0.5, -sqrt(0)) }",
            "center",
            [140.0, 30.0],
            "",
            "sphere { center (sqrt(4) - 1, 2 * 0.5 - 0.5, -sqrt(0)) }",
        ),
        (
            "sphere { center (sqrt(4) - 1, 0, 0) }",
            "center",
            [220.0, 50.0],
            "",
            "sphere { center (sqrt(4) + 1, 0, 0) }",
        ),
        (
            "sphere { center (sqrt(4) - 1, 0, 0) }",
            "center",
            [180.0, 50.0],
            "",
            "sphere { center (sqrt(4) + 0, 0, 0) }",
        ),
        (
            "sphere { center normalize((3, 0, 0)) }",
            "center",
            [100.0, 50.0],
            "",
            "sphere { center normalize((3, 0, 0)) + (-1, 0, 0) }",
        ),
        (
            "sphere { center (0, 0, 0) radius 2 * 0.5 }",
            "radius",
            [100.0, 0.0],
            "",
            "sphere { center (0, 0, 0) radius 2 * 0.5 + 0.24 }",
        ),
        (
            "sphere { center (0, 0, 0) radius pi }",
            "radius",
            [160.0, 50.0],
            "",
            "sphere { center (0, 0, 0) radius pi - 1.66 }",
        ),
        // A field that is left out.
        (
            "sphere { center (0, 0, 0) }",
            "radius",
            [160.0, 50.0],
            "",
            "sphere { center (0, 0, 0)  radius 1.48 }",
        ),
        (
            "sphere {\n  center (0, 0, 0) // c\n}",
            "radius",
            [160.0, 50.0],
            "",
            "sphere {\n  center (0, 0, 0) // c\n  radius 1.48\n}",
        ),
        ("checkerboard {}", "y", [100.0, 60.0], "", "the handle"),
        // Along an axis, or on a floor.
        (
            "sphere { center (0, 0, 0) }",
            "center",
            [140.0, 90.0],
            "x",
            "sphere { center (1, 0, 0) }",
        ),
        (
            "sphere { center (0, 0, 0) }",
            "center",
            [140.0, 90.0],
            "y",
            "sphere { center (0, -1, 0) }",
        ),
        (
            "sphere { center (1, 0, 0) }",
            "center",
            [180.0, 90.0],
            "z",
            "sphere { center (1, 0, 5) }",
        ),
        (
            "sphere { center (0, 0, 0) }",
            "center",
            [180.0, 90.0],
            "z",
            "end-on",
        ),
        (
            "sphere { center (1, 0, 0) }",
            "center",
            [99.0, 50.0],
            "z",
            "does not come so far",
        ),
        (
            "sphere { center (0, -1, 0) }",
            "center",
            [140.0, 70.0],
            "floor",
            "sphere { center (2, -1, -10) }",
        ),
        (
            "sphere { center (0, -1, 0) }",
            "center",
            [140.0, 50.0],
            "floor",
            "not seen there",
        ),
        // Boxes in both forms: the other face stays.
        (
            "box { center (0, 0, 0) size (1, 1, 1) }",
            "center",
            [140.0, 50.0],
            "",
            "box { center (1, 0, 0) size (1, 1, 1) }",
        ),
        (
            "box { min (0, 0, 0) max (1, 1, 1) }",
            "center",
            [160.0, 30.0],
            "",
            "box { min (0.93, -0.02, 0) max (1.93, 0.98, 1) }",
        ),
        (
            "box { min (0, 0, -1) max (1, 1, 1) }",
            "max_x",
            [180.0, 80.0],
            "",
            "box { min (0, 0, -1) max (2, 1, 1) }",
        ),
        (
            "box { center (0, 0, 0) size (1, 1, 1) }",
            "max_x",
            [140.0, 80.0],
            "",
            "box { center (0.25, 0, 0) size (1.5, 1, 1) }",
        ),
        (
            "box { center (0, 0, 0) size (1, 1, 1) }",
            "max_x",
            [60.0, 80.0],
            "",
            "no extent along x",
        ),
        (
            "box { center (0, 0, 0) }",
            "min_y",
            [100.0, 90.0],
            "",
            "box { center (0, -0.12, 0)  size (0.5, 1.75, 2) }",
        ),
        // Triangles in both forms.
        (
            "triangle { centroid (0, 0, 0) normal (0, 0, 2) }",
            "centroid",
            [140.0, 50.0],
            "",
            "triangle { centroid (1, 0, 0) normal (0, 0, 2) }",
        ),
        (
            "triangle { centroid (0, 0, 0) normal (0, 0, 2) }",
            "spin",
            [140.0, 50.0],
            "",
            "triangle { centroid (0, 0, 0) normal (0, 0, 2)  spin -90deg }",
        ),
        (
            "triangle { centroid (0, 0, 0) normal (0, 0, 2) spin 1rad }",
            "spin",
            [100.0, 10.0],
            "",
            "triangle { centroid (0, 0, 0) normal (0, 0, 2) spin 0rad }",
        ),
        (
            "triangle { v0 (0, 0, 0) v1 (1, 0, 0) v2 (0, 1, 0) }",
            "v1",
            [180.0, 50.0],
            "",
            "triangle { v0 (0, 0, 0) v1 (2, 0, 0) v2 (0, 1, 0) }",
        ),
        (
            "triangle { v0 (0, 0, 0) v1 (1, 0, 0) v2 (0, 1, 0) }",
            "v1",
            [100.0, 50.0],
            "",
            "the scene would not be right any more: the vertices lie on one line, and form no triangle",
        ),
        (
            "triangle { v0 (0, 0, 0) v1 (1, 0, 0) v2 (0, 1, 0) }",
            "center",
            [153.0, 36.0],
            "",
            "triangle { v0 (0.99, 0.02, 0) v1 (1.99, 0.02, 0) v2 (0.99, 1.02, 0) }",
        ),
        // What is behind the eye, or too far away, or tied.
        (
            "sphere { center (0, 0, 20) }",
            "center",
            [140.0, 50.0],
            "",
            "not in front of the eye",
        ),
        (
            "sphere { center (0, 0, 0) }",
            "radius",
            [1e300, 50.0],
            "",
            "cannot come so far",
        ),
        (
            "let a = 0\nsphere { center (a, a, 0) }",
            "center",
            [140.0, 50.0],
            "",
            "ties",
        ),
        (
            "let a = 0\nsphere { center (a, a, 0) }",
            "center",
            [140.0, 30.0],
            "",
            "ties",
        ),
        (
            "let a = 1\nsphere { center (0, 0, 0) radius a }\nsphere { center (a, a, a) radius 2 - a }",
            "radius",
            [190.0, 50.0],
            "",
            "the scene would not be right any more: `radius` must be more than 0, and it is ",
        ),
        (
            "sphere { center (0, 0, 0) }",
            "apex",
            [140.0, 50.0],
            "",
            "has no handle `apex`",
        ),
    ] {
        let text = format!("{LEVEL}\n{scene}");
        let found = match dragged(&text, object(handle, to, word)) {
            Ok((text, _)) => text[LEVEL.len() + 1..].to_owned(),
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
        let found = match dragged(&text, camera(handle, from, to)) {
            Ok((text, _)) => text,
            Err(why) => {
                assert_eq!(why, after);
                continue;
            }
        };
        assert_eq!(found, format!("{rest}camera {{ {after} }}"), "{before} {handle}");
        if let Some(point) = seen_point {
            let point = DVec3::from(point);
            let [before, after] = [&text, &found].map(|text| seen(&scene_of(text), point));
            let pointer = DVec2::from(to) - DVec2::from(from);
            assert!((after - before).dot(pointer) > 0.0, "{found} {handle}: {before} {after}");
            if handle == "pan" && point.z == 0.0 && point.y == 0.8 {
                near(after, DVec2::from(to), &found);
            }
        }
    }
}

/// A scene with one object in front of the camera, and a second one that may be anywhere.
fn any_scene() -> impl Strategy<Value = String> {
    let number = || -4.0..4.0;
    let vector = move || {
        (number(), number(), number()).prop_map(|(x, y, z)| format!("({x:.2}, {y:.2}, {z:.3})"))
    };
    let size =
        || (0.1..3.0, 0.1..3.0, 0.1..3.0).prop_map(|(x, y, z)| format!("({x:.2}, {y:.1}, {z:.3})"));
    let sphere = (vector(), 0.1..3.0)
        .prop_map(|(center, radius)| format!("sphere {{ center {center} radius {radius:.2} }}"));
    let block = (vector(), size())
        .prop_map(|(center, size)| format!("box {{ center {center} size {size} }}"));
    let corners = (vector(), size())
        .prop_map(|(min, size)| format!("let min = {min} box {{ min min max min + {size} }}"));
    let triangle = (vector(), vector(), -200.0..200.0).prop_map(|(centroid, normal, spin)| {
        format!("triangle {{ centroid {centroid} normal {normal} + (0, 0, 9) sides (2, 2, 1.5) spin {spin:.1}deg }}")
    });
    let vertices = (vector(), vector(), vector())
        .prop_map(|(a, b, c)| format!("triangle {{ v0 {a} v1 {b} v2 {c} }}"));
    let board = number().prop_map(|y| format!("checkerboard {{ y {y:.2} }}"));
    let object = prop_oneof![sphere, block, corners, triangle, vertices, board];
    let view = prop_oneof![
        vector().prop_map(|point| format!("lookat {point}")),
        vector().prop_map(|along| format!("direction {along} + (0, 0, -9)")),
    ];
    let lens = prop_oneof![Just(""), Just("d 5"), Just("fov 60deg"), Just("hfov 1rad")];
    let size = prop_oneof![
        Just((160, 90)),
        Just((30, 40)),
        Just((1, 1)),
        Just((1 << 20, 3))
    ];
    (object, vector(), view, lens, -200.0..200.0, size).prop_map(|(object, eye, view, lens, roll, (width, height))| {
        format!("{object} image {{ width {width} height {height} }} camera {{ eye {eye} + (0, 0, 9) {view} {lens} roll {roll:.0}deg }}")
    })
}

/// A point in the picture or near to it, or a foolish one, in parts of the picture.
fn any_point() -> impl Strategy<Value = (f64, f64)> {
    let part = || prop_oneof![8 => -0.5..1.5, 1 => Just(1e300), 1 => Just(-1e12)];
    (part(), part())
}

fn point_of(scene: &Scene, (x, y): (f64, f64)) -> DVec2 {
    dvec2(
        x * f64::from(scene.image.width),
        y * f64::from(scene.image.height),
    )
}

/// Where the handles of the first object are seen.
fn handles(scene: &Scene) -> Vec<(&'static str, Option<DVec2>)> {
    let Overlays { mut objects, .. } = overlays(scene, Some(0));
    objects
        .pop()
        .map(|outline| outline.handles)
        .unwrap_or_default()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// What is dragged is seen where it was dragged to, or there is a reason.
    #[test]
    fn a_handle_is_seen_where_it_was_dragged_to(
        text in any_scene(), to in any_point(), which in 0..7usize, word in prop_oneof![Just(""), Just("x"), Just("y"), Just("z"), Just("floor")],
    ) {
        let reading = scene::read(&sources(&text));
        let Some(before) = reading.scene else { return Ok(()) };
        let to = point_of(&before, to);
        let handles_before = handles(&before);
        let (handle, seen_before) = handles_before[which % handles_before.len()];
        let moved = Drag { object: Some(0), handle, from: to, to, along: along(word) };
        let Ok((changed, _)) = dragged(&text, moved) else { return Ok(()) };
        let mut after = scene_of(&changed);
        prop_assert_eq!(after.objects.len(), before.objects.len());
        // The camera may be tied to what was moved.
        after.camera = before.camera;
        let places = handles(&after);
        let (_, seen) = places[which % places.len()];
        let seen = seen.unwrap_or(DVec2::INFINITY);
        let is_free = matches!(handle, "center" | "centroid" | "v0" | "v1" | "v2") && matches!(word, "" | "floor");
        match handle {
            _ if is_free => near(seen, to, &changed),
            "radius" => {
                // Half a pixel inwards the sphere is hit, and half a pixel outwards it is not.
                let inwards = (seen_center(&after) - to).normalize_or_zero() * 0.75;
                let hits = |at: DVec2| probe(&after, at).hits.iter().any(|(hit, ..)| hit.object == 0);
                let is_near = to.abs().max_element() < 1e4 && before.image.width > 100 && before.image.width < 1000;
                prop_assert!(!is_near || hits(to + inwards) || seen_center(&after).distance(to) < 1.0, "{}", changed);
                prop_assert!(!is_near || !hits(to - inwards), "{}", changed);
            }
            "y" => {}
            // On a line it comes as near as it can.
            _ => {
                let before = seen_before.expect("it was seen");
                prop_assert!(handle == "spin" || seen.distance(to) <= before.distance(to) + 1.0, "{} {} {}", changed, handle, to);
            }
        }
    }

    /// What the pointer does to the camera never breaks a text.
    #[test]
    fn a_camera_is_moved_or_there_is_a_reason(
        text in any_scene(), from in any_point(), to in any_point(),
        handle in prop_oneof![Just("orbit"), Just("pan"), Just("dolly"), Just("roll"), Just("look"), Just("view_distance")],
    ) {
        let reading = scene::read(&sources(&text));
        let Some(before) = reading.scene else { return Ok(()) };
        let [from, to] = [from, to].map(|point| point_of(&before, point));
        let moved = Drag { object: None, handle, from, to, along: None };
        let Ok((changed, _)) = dragged(&text, moved) else { return Ok(()) };
        let after = scene_of(&changed);
        prop_assert_eq!(&after.objects, &before.objects);
        prop_assert_eq!(after.image, before.image);
        if let (View::Lookat(point), "orbit") = (before.camera.view, handle)
            && before.image.width > 1
        {
            let [a, b] = [&before, &after].map(|scene| scene.camera.eye.distance(point));
            prop_assert!((a - b).abs() < 0.1 * a, "{}", changed);
        }
    }
}

fn seen_center(scene: &Scene) -> DVec2 {
    match scene.objects[0].shape {
        Shape::Sphere(sphere) => seen(scene, sphere.center),
        _ => DVec2::ZERO,
    }
}
