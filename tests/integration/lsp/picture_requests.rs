//! The requests about a text's picture.

use serde_json::{Value, json};

use super::talk::Talk;
use crate::table::rows;

const SCENE: &str = "\
let ball = (0, 0, 0)
image { width 200 height 100 }
camera { eye (0, 1, 10) direction (0, 0, -1) d 8 near 5 far 20 }
sampler { method regular per_pixel 4 }
sphere Ball { center ball + (0, 1, 0)  color olive }
box { center (2, 1, 0)  size (1, 1, 1)  color orange }
checkerboard { colors (black, white) }
";

fn range(line: u32, start: u32, end: u32) -> Value {
    let place = |character: u32| json!({ "line": line, "character": character });
    json!({ "start": place(start), "end": place(end) })
}

#[test]
fn what_is_seen_at_a_point_is_told_with_its_place_in_the_text() {
    let mut talk = Talk::with(SCENE);
    let mut pick = |point: Value| talk.ask("pinhole/pick", json!({ "point": point }));
    let ball = json!({ "index": 0, "kind": "sphere", "name": "Ball", "range": range(4, 0, 52), "selection": range(4, 7, 11) });
    assert_eq!(
        pick(json!([100, 50])),
        json!({ "object": ball, "point": [0.0, 1.0, 1.0], "distance": 9.0, "depth": 9.0, "color": "#808000" })
    );
    let object = pick(json!([180.0, 50.5]))["object"].take();
    let block = json!({ "index": 1, "kind": "box", "name": null, "range": range(5, 0, 54), "selection": range(5, 0, 3) });
    assert_eq!(object, block);
    for (point, color) in [
        (json!([3, 1]), json!("#000000")),
        (json!([-1, 0]), Value::Null),
        (json!([201, 3]), Value::Null),
        (json!([1e300, -1e300]), Value::Null),
    ] {
        let nothing = json!({ "object": null, "point": null, "distance": null, "depth": null, "color": color });
        assert_eq!(pick(point), nothing);
    }
    for wrong in [json!(null), json!([1]), json!([null, 1]), json!("1")] {
        let message = talk.refused("pinhole/pick", json!({ "point": wrong }));
        assert!(message.starts_with("`point`"), "{message}");
    }
    let broken = [
        "",
        "camera {",
        "sphere { center (0, 0, 0) }",
        &SCENE.replace("eye", "eys"),
    ];
    for (index, broken) in broken.into_iter().enumerate() {
        talk.change(2 * index + 2, json!({ "text": broken }));
        for request in ["pick", "overlays", "drag", "samples", "frame"] {
            let answer = talk.ask(&format!("pinhole/{request}"), json!({}));
            assert_eq!(answer, Value::Null);
        }
        talk.change(2 * index + 3, json!({ "text": SCENE }));
        let frame = talk.ask("pinhole/frame", json!({ "scale": 8 }));
        assert!(frame["png"].is_string());
    }
    let unknown = talk.refused("pinhole/paint", json!({}));
    assert_eq!(unknown, "`pinhole/paint` is not known here");
}

#[test]
fn overlays_lie_where_their_things_are_seen() {
    let mut talk = Talk::with(SCENE);
    let found = talk.ask("pinhole/overlays", json!({}));
    for (path, expected) in [
        ("/size", json!([200, 100])),
        ("/axis", json!([100.0, 50.0])),
        // Level, so that the horizon is the row in the middle, grown by the picture's own size.
        ("/horizon", json!([[-200.0, 50.0], [400.0, 50.0]])),
        (
            "/vanishing/0",
            json!({ "axis": "x", "point": null, "lines": [] }),
        ),
        ("/vanishing/2/point", json!([100.0, 50.0])),
        // At depths of 9.5 and 10.5 a metre has 400/9.5 and 400/10.5 pixels.
        (
            "/vanishing/2/lines/0",
            json!([[163.16, 71.05], [157.14, 69.05], [100.0, 50.0]]),
        ),
        // The floor is a metre below the eye.
        ("/near", json!([[[-200.0, 130.0], [400.0, 130.0]]])),
        ("/far", json!([[[-200.0, 70.0], [400.0, 70.0]]])),
        (
            "/objects/0/handles/0",
            json!({ "handle": "center", "at": [100.0, 50.0], "label": "center" }),
        ),
        // A ball of 1 at a distance of 10 is seen as wide as a disc of 400/√99 pixels.
        (
            "/objects/0/handles/1",
            json!({ "handle": "radius", "at": [140.2, 50.0], "label": "radius" }),
        ),
        // The view axis is level and does not meet the floor.
        (
            "/objects/2/handles",
            json!([{ "handle": "y", "at": null, "label": "y" }]),
        ),
        ("/objects/2/outline", json!([])),
    ] {
        assert_eq!(found.pointer(path), Some(&expected), "{path}");
    }
    for (path, count) in [
        ("/vanishing/2/lines", 4),
        ("/objects", 3),
        ("/objects/1/outline", 12),
        ("/objects/1/handles", 7),
    ] {
        let list = found.pointer(path).and_then(Value::as_array);
        assert_eq!(list.map(Vec::len), Some(count), "{path}");
    }
    let line: Vec<[f64; 2]> =
        serde_json::from_value(found["objects"][0]["outline"][0].clone()).expect("a line");
    assert_eq!(line.first(), line.last());
    for [x, y] in line {
        let radius = ((x - 100.0) * (x - 100.0) + (y - 50.0) * (y - 50.0)).sqrt();
        assert!((radius - 400.0 / 99f64.sqrt()).abs() < 0.01, "{x} {y}");
    }

    // Of very many objects those that one can tell apart.
    let many = (0..1500).map(|i| format!("sphere {{ center ({i}, 0, 0) }}\n"));
    let text = SCENE.to_owned() + &many.collect::<String>();
    talk.change(2, json!({ "text": text }));
    for (further, count, last) in [
        (None, 1000, 999),
        (Some(1400), 1001, 1400),
        (Some(1), 1000, 999),
        (Some(1503), 1000, 999),
    ] {
        let found = talk.ask("pinhole/overlays", json!({ "object": further }));
        let objects = found["objects"].as_array().expect("a list");
        assert_eq!(
            (objects.len(), &objects[count - 1]["index"]),
            (count, &json!(last))
        );
    }
}

#[test]
fn a_drag_is_answered_with_edits_of_the_text() {
    let mut talk = Talk::with(SCENE);
    let params = json!({ "object": 0, "handle": "center", "from": [100, 50], "to": [140, 50] });
    assert_eq!(
        talk.ask("pinhole/drag", params),
        json!({ "edits": [{ "range": range(4, 29, 30), "newText": "1" }], "values": ["Ball.center = (1, 1, 0)"] })
    );
    let params =
        json!({ "object": null, "handle": "view_distance", "from": [100, 50], "to": [100, 100] });
    let dragged = talk.ask("pinhole/drag", params);
    assert_eq!(dragged["values"], json!(["camera.d = 4"]));
    for [params, message] in rows(
        r#"
        { "object": 7, "handle": "center", "to": [1, 1] } -> there is no object 7
        { "object": 0, "handle": "corner", "to": [1, 1] } -> a sphere of this form has no handle `corner`
        { "object": 0, "handle": "center", "to": [1, 1], "along": "w" } -> `along` is x, y, z or floor, and not `w`
        { "object": 0, "handle": "center", "to": null } -> `to` is a point of the picture, as [x, y]
        { "handle": "pan", "to": [1, 1] } -> `from` is a point of the picture, as [x, y]
    "#,
    ) {
        let params = serde_json::from_str(params).expect("JSON");
        assert_eq!(talk.refused("pinhole/drag", params), message);
    }
}

#[test]
fn the_samples_of_a_pixel_are_those_of_its_frame() {
    let mut talk = Talk::with(SCENE);
    let points = json!([[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]]);
    for (column, color) in [(139, "#808000"), (141, "#000000")] {
        let found = talk.ask("pinhole/samples", json!({ "pixel": [column, 49] }));
        assert_eq!(
            found,
            json!({ "points": points, "colors": vec![color; 4], "color": color })
        );
    }
    let exact = SCENE.replace("method regular", "method exact");
    talk.change(2, json!({ "text": exact }));
    let mut found = talk.ask("pinhole/samples", json!({ "pixel": [140, 49] }));
    let edge = found["color"].take();
    assert_eq!(found, json!({ "points": [], "colors": [], "color": null }));
    assert!(edge != "#000000" && edge != "#808000", "{edge}");
    let many = SCENE.replace("per_pixel 4", "per_pixel 1_000_000_000");
    talk.change(3, json!({ "text": many }));
    for (pixel, message) in [
        ([1, 1], "1000000000 samples of a pixel would take too long"),
        ([200, 0], "`pixel` is no pixel of the picture"),
        ([0, 100], "`pixel` is no pixel of the picture"),
    ] {
        let found = talk.refused("pinhole/samples", json!({ "pixel": pixel }));
        assert_eq!(found, message);
    }
}
