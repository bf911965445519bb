//! Tests of editing in the picture: overlays of objects, adding objects, and drags.

use pinhole::schema::BLOCKS;
use serde_json::{Value, json};

use super::{
    frames::{SCENE, code},
    local_client::LocalClient,
};

pub const FAILED: i32 = -32803;

/// In a scene with very many objects, overlays are sent for the first 1000 objects and for the
/// requested one.
#[test]
fn at_most_1000_overlays_and_the_requested_object_are_sent() {
    let many = (0..1500).map(|i| format!("sphere {{ center ({i}, 0, 0) }}\n"));
    let mut client = LocalClient::with(&(SCENE.to_owned() + &many.collect::<String>()));
    for (further, count, last) in [
        (None, 1000, 999),
        (Some(1400), 1001, 1400),
        (Some(1), 1000, 999),
        (Some(1503), 1000, 999),
    ] {
        let found = client.ask("pinhole/overlays", json!({ "object": further }));
        let objects = found["objects"].as_array().expect("a list");
        let found = (objects.len(), &objects[count - 1]["index"]);
        assert_eq!(found, (count, &json!(last)));
        let listed = client.ask("pinhole/objects", json!({ "object": further }));
        assert_eq!(listed.as_array().map(Vec::len), Some(count));
        assert!(listed[0]["range"].is_object() && listed[0]["outline"].is_null());
    }
    // The first checkerboard is listed even if more than 1000 objects precede it in the text,
    // because new objects are placed on it.
    let many = (0..1500).map(|i| format!("sphere {{ center ({i}, 0, 0) }}\n"));
    let floor = many.collect::<String>() + "checkerboard {}\ncheckerboard { y 1 }\n";
    let camera = "camera { eye (0, 0, 5) lookat (0, 0, 0) }\n";
    let listed = LocalClient::with(&(camera.to_owned() + &floor)).ask("pinhole/objects", json!({}));
    let last = &listed.as_array().expect("a list")[1000..];
    assert_eq!(last.len(), 1);
    assert_eq!(last[0]["kind"], "checkerboard");
    for (only, indices) in [
        (json!([]), vec![]),
        (json!([1400, 3]), vec![3, 1400]),
        (json!([1504]), vec![]),
    ] {
        let found = client.ask("pinhole/overlays", json!({ "only": only }));
        let objects = found["objects"].as_array().expect("a list");
        let found: Vec<_> = objects.iter().map(|it| it["index"].as_u64()).collect();
        assert_eq!(found, indices.into_iter().map(Some).collect::<Vec<_>>());
    }
}

/// The outline of a board's square is hidden behind objects in front of the board.
#[test]
fn checkerboard_outlines_stop_at_objects_in_front_of_them() {
    let camera = "camera { eye (0, 1, 5) lookat (0, 0, 0) }";
    // Each row has the size of a square, objects, and the number of visible parts of the square's
    // outline.
    for (square, before, count) in [
        (2, "", 1),
        (2, "sphere { center (0, -5, 0) radius 1 }", 1),
        (2, "sphere { center (1, 0.3, 0) radius 0.6 }", 2),
        (2, "sphere { center (0.5, 0.5, 3) radius 1 }", 0),
        // The eye is above the large square, whose sides are partly far outside of the picture.
        (900, "sphere { center (0, 0.1, 3) radius 0.02 }", 3),
    ] {
        let board = format!("{camera} checkerboard {{ square {square} }}");
        let mut client = LocalClient::with(&format!("{board} {before}"));
        let overlays = client.ask("pinhole/overlays", json!({ "only": [0] }));
        let lines: Vec<Vec<[f64; 2]>> =
            serde_json::from_value(overlays["objects"][0]["outline"].clone()).expect("lines");
        assert_eq!(lines.len(), count, "{before}: {lines:?}");
        for ends in lines.iter().flat_map(|line| line.windows(2)) {
            for part in [0.1, 0.5, 0.9] {
                let at = [0, 1].map(|axis| ends[0][axis] + part * (ends[1][axis] - ends[0][axis]));
                let pick = client.ask("pinhole/pick", json!({ "point": at }));
                let object = &pick["object"];
                assert!(
                    object.is_null() || object["index"] == 0,
                    "{before}: {at:?} {pick}"
                );
            }
        }
    }
}

/// A new object is valid, has an unused name, and is visible in the picture.
#[test]
fn an_added_object_is_visible_and_has_an_unused_name() {
    let camera = "camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) }\n";
    for before in [
        "",
        camera,
        "let Sphere1 = 2\n",
        "camera { eye (0, 0, 5) lookat (0, -1, 0) }\nsphere Sphere1 { center (0, 0, 0) }\n\
         checkerboard { y -2 }",
        "sphere { center (0, 1, 0) radios 1 }",
    ] {
        for kind in BLOCKS.iter().filter(|row| row.is_object) {
            let kind = kind.name;
            let mut client = LocalClient::with(before);
            let found = client.ask("pinhole/add", json!({ "kind": kind }));
            let written = found["edits"][0]["newText"].as_str().expect("a text");
            let name = |number| format!("{}{}{number}", kind[..1].to_uppercase(), &kind[1..]);
            let is_first = !before.contains(&name(1));
            assert_eq!(found["name"], name(if is_first { 1 } else { 2 }), "{found}");
            let camera = if before.contains("camera") {
                ""
            } else {
                camera
            };
            let text = format!(
                "{camera}{}{written}\n",
                before.trim_end().replace("radios", "radius")
            );
            let mut client = LocalClient::with(&text);
            let overlays = client.ask("pinhole/overlays", json!({}));
            let objects = overlays["objects"]
                .as_array()
                .unwrap_or_else(|| panic!("{text}"));
            let [x, y] = [0, 1].map(|i| objects[objects.len() - 1]["handles"][0]["at"][i].as_f64());
            assert!(
                (0.0..800.0).contains(&x.unwrap()) && (0.0..450.0).contains(&y.unwrap()),
                "{text}"
            );
        }
    }
}

/// Objects added one after another have different positions, even if the text has errors.
#[test]
fn objects_added_one_after_another_get_distinct_positions() {
    let camera = "camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) }\n";
    for before in [
        "",
        camera,
        "sphere { radios 1 }\n",
        "camera { eye (0, 0, 5) }\n",
        "camera { eye (0, 0, 5) lookat (0, 0, 0) }\nbox { sice 1 }\n",
        "image { width 0 }\n",
    ] {
        let mut text = before.to_owned();
        let mut places = Vec::new();
        for i in 0..12 {
            let kind = ["sphere", "box", "triangle"][i % 3];
            let found = LocalClient::with(&text).ask("pinhole/add", json!({ "kind": kind }));
            let written = found["edits"][0]["newText"].as_str().expect("a text");
            let (_, place) = written.split_once('(').expect("a place");
            let (place, _) = place.split_once(')').expect("a vector");
            assert!(!places.contains(&place.to_owned()), "{text}{written}");
            places.push(place.to_owned());
            text = format!("{}{written}\n", text.trim_end());
        }
    }
}

/// A new object is wholly in the picture, however many objects there are, and its colour is not
/// used yet.
#[test]
fn added_objects_lie_within_the_picture_in_distinct_colours() {
    let board = "checkerboard { y 0 }\n";
    let figure = "camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) }\n";
    for before in [
        figure.to_owned(),
        format!("{figure}{board}"),
        format!("image {{ width 300 height 500 }}\n{figure}{board}"),
        format!("camera {{ eye (0, 1, 6) lookat (0, 1, 0) fov 30deg }}\n{board}"),
        // The camera looks up, so that the board is not in the picture.
        format!("camera {{ eye (0, 2, 6) lookat (0, 9, 0) }}\n{board}"),
    ] {
        let mut text = before.clone();
        let mut colors = vec!["gray".to_owned(), "white".to_owned()];
        for i in 0..9 {
            let kind = ["box", "sphere", "triangle"][i % 3];
            let found = LocalClient::with(&text).ask("pinhole/add", json!({ "kind": kind }));
            let written = found["edits"][0]["newText"].as_str().expect("a text");
            text = format!("{}{written}\n", text.trim_end());
            let (_, color) = written.split_once("color ").expect("a colour");
            let color = color.trim_end_matches(" }").to_owned();
            assert!(!colors.contains(&color), "{text}");
            colors.push(color);
            let overlays = LocalClient::with(&text).ask("pinhole/overlays", json!({}));
            let size: [f64; 2] = serde_json::from_value(overlays["size"].clone()).expect("a size");
            let objects = overlays["objects"].as_array().expect("a list");
            let lines = objects[objects.len() - 1]["outline"].as_array();
            let lines = lines.expect("a list").iter();
            let points: Vec<[f64; 2]> = lines
                .flat_map(|line| line.as_array().expect("a line"))
                .map(|point| serde_json::from_value(point.clone()).expect("a point"))
                .collect();
            let is_within =
                |[x, y]: &[f64; 2]| (0.0..=size[0]).contains(x) && (0.0..=size[1]).contains(y);
            assert!(!points.is_empty(), "{text}");
            assert!(points.iter().all(is_within), "{text}{points:?}");
        }
    }
}

/// The first object of a kind gets the default colour of this kind, unless the colour is in use.
#[test]
fn an_added_object_takes_a_colour_that_is_not_in_use() {
    for (before, kind, color) in [
        ("", "sphere", "olive"),
        ("", "triangle", "teal"),
        ("", "box", "orange"),
        ("sphere { center (0, 1, 0) }", "sphere", "teal"),
        ("sphere { center (0, 1, 0) color #818203 }", "box", "orange"),
        (
            "sphere { center (0, 1, 0) color #818203 }",
            "sphere",
            "teal",
        ),
        (
            "box { center (0, 1, 0) size (1, 1, 1) colors (olive, teal, red) }",
            "sphere",
            "orange",
        ),
        ("checkerboard { colors (olive, white) }", "sphere", "teal"),
        ("image { background olive }", "sphere", "teal"),
    ] {
        let camera = "camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) }";
        let mut client = LocalClient::with(&format!("{camera}\n{before}"));
        let found = client.ask("pinhole/add", json!({ "kind": kind }));
        let written = found["edits"][0]["newText"].as_str().expect("a text");
        let end = format!("  color {color} }}");
        assert!(written.ends_with(&end), "{before}: {written}");
    }
}

/// A new object touches the checkerboard, whatever the board's height is. If the text has no
/// checkerboard, a board that is added afterwards touches the object.
#[test]
fn an_added_object_stands_on_the_checkerboard() {
    let camera = "camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) }\n";
    for (before, floor) in [
        ("", 0.0),
        ("checkerboard { y 0 }", 0.0),
        ("checkerboard { y 0.25 }", 0.25),
        ("checkerboard { y -1.37 }", -1.37),
        ("checkerboard { y -0.2 }\ncheckerboard { y -3 }", -0.2),
    ] {
        for kind in ["sphere", "box"] {
            let mut client = LocalClient::with(&format!("{camera}{before}"));
            let found = client.ask("pinhole/add", json!({ "kind": kind }));
            let written = found["edits"][0]["newText"].as_str().expect("a text");
            let text = format!("{camera}{before}{written}");
            let found =
                LocalClient::with(&text).ask("pinhole/add", json!({ "kind": "checkerboard" }));
            let board = found["edits"][0]["newText"].as_str().expect("a text");
            // The numbers are, in this order, the number in the name, the centre, and the radius or
            // the size.
            let parts = written.split(|it: char| !matches!(it, '0'..='9' | '.' | '-'));
            let numbers: Vec<f64> = parts.filter_map(|it| it.parse().ok()).collect();
            let half = numbers[4] / if kind == "box" { 2.0 } else { 1.0 };
            assert!((numbers[2] - half - floor).abs() < 1e-9, "{text}");
            if before.is_empty() {
                assert!(board.ends_with("{ y 0 }"), "{board}");
            }
        }
    }
}

/// A new checkerboard is below all objects, at a height at which there is no other checkerboard.
#[test]
fn an_added_checkerboard_lies_below_all_objects() {
    let camera = "camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) }\n";
    for (before, y) in [
        ("", "y 0 }"),
        ("sphere { center (0, 0.8, 0) radius 1 }", "y -0.2 }"),
        ("box { center (0, 0.5, 0) size (1, 3, 1) }", "y -1 }"),
        (
            "triangle { v0 (0, -2, 0) v1 (1, 0, 0) v2 (0, 1, 0) }",
            "y -2 }",
        ),
        ("sphere { center (0, 5, 0) radius 1 }", "y 0 }"),
        ("checkerboard { y 0 }", "y -1 }"),
        ("checkerboard { y 0 }\ncheckerboard { y -1 }", "y -2 }"),
    ] {
        let mut client = LocalClient::with(&format!("{camera}{before}"));
        let found = client.ask("pinhole/add", json!({ "kind": "checkerboard" }));
        let written = found["edits"][0]["newText"].as_str().expect("a text");
        assert!(written.ends_with(y), "{before}: {written}");
    }
}

/// If a block is copied, a comment after the block stays after the original.
#[test]
fn copying_a_block_does_not_move_its_trailing_comment() {
    let camera = "camera { eye (0, 0, 5) lookat (0, 0, 0) }\n";
    let block = "sphere Ball { center (0, 0, 0) }";
    for behind in [
        "",
        "  // the ball",
        " // π\n// of the next line\n",
        "  sphere { center (1, 1, 1) }",
    ] {
        let text = format!("{camera}{block}{behind}");
        let found = LocalClient::with(&text).ask("pinhole/add", json!({ "object": 0 }));
        let edit = &found["edits"][0];
        let at = &edit["range"]["start"];
        let own = behind.lines().next().unwrap_or_default();
        let stays = if own.contains("//") {
            own.chars().count()
        } else {
            0
        };
        assert_eq!(at["line"], 1, "{found}");
        assert_eq!(at["character"], block.len() + stays, "{found}");
        assert_eq!(
            found["cursor"],
            camera.len() + block.len() + stays + 1,
            "{found}"
        );
        let written = edit["newText"].as_str().expect("a text");
        assert!(written.starts_with("\nsphere Sphere1 {"), "{found}");
    }
}

/// A drag is refused if another field uses the number that the drag would change. This holds both
/// for drags that snap to round numbers (`step`) and for those that do not.
#[test]
fn dragging_a_number_shared_with_another_field_is_refused() {
    let text = "camera { eye (0, 0, 5) lookat (0, 0, 0) }\nlet r = 1\n\
                sphere { center (r, 0, 0) radius r }";
    for by in [3.0, 7.0, 12.0, 30.0, 100.0] {
        for step in [json!(8), Value::Null] {
            let mut client = LocalClient::with(text);
            let objects = client.ask("pinhole/overlays", json!({}));
            let at = &objects["objects"][0]["handles"][0]["at"];
            let to = [at[0].as_f64().expect("a number") + by, 225.0];
            let about = json!({ "object": 0, "handle": "center", "to": to, "step": step });
            let drag = client.request("pinhole/drag", about);
            client.transport.step();
            assert_eq!(code(&mut client, drag), FAILED, "{by} {step}");
        }
    }
}

/// A drag with a step yields round numbers. A drag that ends where it began does not change the
/// text.
#[test]
fn a_drag_with_a_step_snaps_to_round_numbers() {
    let text =
        "camera { eye (0, 0, 5) lookat (0, 0, 0) }\nsphere { center (0.123, 0, 0) radius 1 }";
    let mut client = LocalClient::with(text);
    let held = client.ask("pinhole/overlays", json!({}))["objects"][0]["handles"][0]["at"][0]
        .as_f64()
        .unwrap();
    for by in [-200.0, -35.0, -7.0, 0.0, 2.0, 4.9, 12.0, 81.0, 333.0] {
        let about = json!({ "object": 0, "handle": "center", "to": [held + by, 225], "step": 8 });
        let found = client.ask("pinhole/drag", about);
        let edits = found["edits"].as_array().expect("edits");
        let x: Option<f64> = edits.first().map(|edit| {
            edit["newText"]
                .as_str()
                .expect("a text")
                .parse()
                .expect("a number")
        });
        // In the picture, 1 m is 90 pixels. The new x must be a multiple of 0.01 m, and within 0.02
        // m of the x to which the pointer moved.
        match x {
            None => assert!(f64::abs(by) < 0.5, "{by}: {found}"),
            Some(x) => {
                assert!(
                    (x * 100.0 - (x * 100.0).round()).abs() < 1e-9,
                    "{by}: {found}"
                );
                assert!((x - 0.123 - by / 90.0).abs() < 0.02, "{by}: {found}");
            }
        }
    }
}

/// Dragging one object of a repeated block moves all objects of the block.
#[test]
fn dragging_one_repeated_object_moves_its_whole_block() {
    for (blocks, object, handle, to, written, value, also) in [
        (
            "sphere Ball for i < 3 { center (i - 1, 0, 0) radius 0.3 }",
            1,
            "center",
            [430, 225],
            "0.67",
            "Ball[1].center = (0.33, 0, 0)",
            "Ball.center",
        ),
        (
            "sphere A { center (0, 0, -3) }\nsphere Ball for i < 3 { center (i, 0, 0) }\nsphere { center (0, 0, -4) }",
            2,
            "center",
            [520, 225],
            " + 0.33",
            "Ball[1].center = (1.33, 0, 0)",
            "Ball.center",
        ),
        (
            "sphere for i < 3, j < i { center (i, j, 0) }",
            2,
            "center",
            [610, 135],
            " + 0.33",
            "sphere.center = (2.33, 1, 0)",
            "sphere.center",
        ),
        (
            "let c = (0, 0, 0) sphere Ball for i < 2 { center c + (i, 0, 0) }",
            0,
            "center",
            [430, 225],
            " + 0.33",
            "Ball[0].center = (0.33, 0, 0)",
            "Ball.center",
        ),
        (
            "let x = 0 sphere Ball for i < 2 { center (x, i, 0) } sphere B { center (x, -1, 0) }",
            0,
            "center",
            [430, 225],
            "0.33",
            "Ball[0].center = (0.33, 0, 0)",
            "Ball.center, B.center",
        ),
        (
            "sphere for i < 2 { center (3 * i, 0, 0) }",
            0,
            "radius",
            [535, 225],
            "",
            "",
            "sphere.radius",
        ),
        (
            "sphere Ball for i < 1 { center (i, 0, 0) }",
            0,
            "center",
            [430, 225],
            " + 0.33",
            "Ball[0].center = (0.33, 0, 0)",
            "",
        ),
    ] {
        let mut client = LocalClient::with(&format!(
            "camera {{ eye (0, 0, 5) lookat (0, 0, 0) }}\n{blocks}"
        ));
        let about = json!({ "object": object, "handle": handle, "to": to });
        let found = client.ask("pinhole/drag", about);
        let list = |key: &str| {
            let texts = found[key].as_array().unwrap().iter();
            texts
                .map(|it| it.as_str().unwrap().to_owned())
                .collect::<Vec<_>>()
                .join(", ")
        };
        assert_eq!(list("also"), also, "{blocks}: {found}");
        if !written.is_empty() {
            assert_eq!(list("values"), value, "{blocks}: {found}");
            assert_eq!(found["edits"][0]["newText"], written, "{blocks}: {found}");
        }
    }
}

#[test]
fn a_drag_lists_what_else_moves() {
    let text = "let ball = (0, 0, 0)\ncamera { eye (0, 0, 5) lookat ball }\nsphere Ball { center ball }\nsphere { center (0, 2, 0) }";
    let mut client = LocalClient::with(text);
    for (object, also) in [(0, json!(["camera.lookat"])), (1, json!([]))] {
        let about = json!({ "object": object, "handle": "center", "to": [430, 225] });
        let found = client.ask("pinhole/drag", about);
        assert_eq!(found["also"], also, "{found}");
    }
}
