//! Frames: the pixels of a render, in slices, as long as they are wanted.

use base64::{Engine, prelude::BASE64_STANDARD};
use serde_json::{Value, json};

use super::talk::Talk;
use crate::{program::Folder, table::rows};

const SCENE: &str = "\
image { width 83  height 61 }
camera { eye (3, 3.5, 8)  lookat (0.2, 0.8, 0)  d 2.75 }
sampler { method multi_jittered  per_pixel 9  seed 3 }
sphere Ball { center (-1.6, 1, 0)  radius 1  color olive }
box { center (2, 0.75, -0.5)  size (0.5, 1.5, 2)  color orange }
checkerboard {}
";

const CONTENT_MODIFIED: i32 = -32801;
const CANCELLED: i32 = -32800;

/// The scene with another size.
fn sized(width: &str, height: &str) -> String {
    let size = format!("width {width}  height {height}");
    SCENE.replace("width 83  height 61", &size)
}

/// The code of the error that a request has got.
fn code(talk: &mut Talk, request: i32) -> Value {
    assert!(talk.has_answered(request));
    talk.response(request)["error"]["code"].take()
}

/// The bytes of a picture with its size.
fn pixels(png: &[u8]) -> (u32, u32, Vec<u8>) {
    let picture = image::load_from_memory(png).expect("a picture");
    let rgb = picture.to_rgb8();
    (rgb.width(), rgb.height(), rgb.into_raw())
}

fn shown(frame: &Value) -> (u32, u32, Vec<u8>) {
    let png = frame["png"].as_str().expect("a picture");
    let found = pixels(&BASE64_STANDARD.decode(png).expect("base64"));
    assert_eq!(
        (&frame["width"], &frame["height"]),
        (&found.0.into(), &found.1.into())
    );
    found
}

/// What `pinhole render` makes of a scene, with so many `--set`.
fn rendered(text: &str, sets: &str) -> (u32, u32, Vec<u8>) {
    let folder = Folder::with([("a.scn", text)]);
    let sets = sets.split_whitespace().map(|set| format!(" --set {set}"));
    folder.told(&format!("render a.scn{}", sets.collect::<String>()), 0);
    pixels(&folder.read("a.png"))
}

#[test]
fn a_frame_has_the_pixels_of_a_render() {
    let table = r#"
        scene -> {} ->
        scene -> { "scale": 1, "samples": null } ->
        scene -> { "scale": 4 } -> image.width=21 image.height=16
        scene -> { "scale": 1000 } -> image.width=1 image.height=1
        scene -> { "samples": 4 } -> sampler.method=regular sampler.per_pixel=4
        scene -> { "scale": 8, "samples": 1 } -> image.width=11 image.height=8 sampler.method=regular sampler.per_pixel=1
        exact -> {} ->
        exact -> { "scale": 3 } -> image.width=28 image.height=21
        scattered -> {} ->
        many -> { "scale": 2 } -> image.width=42 image.height=31
        wide -> {} ->
    "#;
    for [name, params, sets] in rows(table) {
        let (text, size) = match name {
            "exact" => (SCENE.replace("multi_jittered", "exact"), [83, 61]),
            "scattered" => (SCENE.replace("multi_jittered", "scatter"), [83, 61]),
            // So many that a slice is a small part of the picture.
            "many" => (SCENE.replace("per_pixel 9", "per_pixel 2000"), [83, 61]),
            "wide" => (sized("100_000", "2"), [100_000, 2]),
            _ => (SCENE.to_owned(), [83, 61]),
        };
        let params: Value = serde_json::from_str(params).expect("JSON");
        let frame = Talk::with(&text).ask("pinhole/frame", params);
        assert!(shown(&frame) == rendered(&text, sets), "{name} {sets}");
        assert_eq!(frame["version"], 1);
        assert_eq!(frame["size"], json!(size));
    }
}

#[test]
fn a_frame_is_made_of_the_newest_text_or_not_at_all() {
    let mut talk = Talk::with(SCENE);
    let old = talk.request("pinhole/frame", json!({}));
    // Its diagnostics, and what is begun of the frame.
    assert!(talk.carrier.step() && !talk.has_answered(old));
    let changed = SCENE.replace("olive", "teal");
    talk.change(2, json!({ "text": changed }));
    let new = talk.request("pinhole/frame", json!({}));
    assert_eq!(talk.response(old)["error"]["code"], CONTENT_MODIFIED);
    let frame = talk.response(new)["result"].clone();
    assert_eq!(frame["version"], 2);
    assert!(shown(&frame) == rendered(&changed, ""));
}

#[test]
fn a_frame_that_is_cancelled_ends_at_once() {
    // Ten thousand slices, which would take minutes.
    let text = sized("1000", "1000").replace("per_pixel 9", "per_pixel 10_000");
    let mut talk = Talk::with(&text);
    let frame = talk.request("pinhole/frame", json!({}));
    let hover = |talk: &mut Talk| {
        let position = json!({ "line": 0, "character": 1 });
        talk.request("textDocument/hover", json!({ "position": position }))
    };
    let early = hover(&mut talk);
    for _ in 0..4 {
        assert!(talk.carrier.step());
    }
    // What comes later is answered in between.
    assert!(talk.has_answered(early) && !talk.has_answered(frame));
    let later = hover(&mut talk);
    assert!(talk.carrier.step() && talk.has_answered(later));
    talk.tell("$/cancelRequest", json!({ "id": frame }));
    assert_eq!(code(&mut talk, frame), CANCELLED);
    assert!(!talk.carrier.step());

    let frame = talk.request("pinhole/frame", json!({}));
    talk.carrier.step();
    let shutdown = talk.request("shutdown", json!({}));
    assert_eq!(code(&mut talk, frame), CANCELLED);
    assert!(talk.has_answered(shutdown));
}

/// Of very many objects those that one can tell apart, and the one that is asked for.
#[test]
fn overlays_are_not_more_than_a_page_can_show() {
    let many = (0..1500).map(|i| format!("sphere {{ center ({i}, 0, 0) }}\n"));
    let mut talk = Talk::with(&(SCENE.to_owned() + &many.collect::<String>()));
    for (further, count, last) in [
        (None, 1000, 999),
        (Some(1400), 1001, 1400),
        (Some(1), 1000, 999),
        (Some(1503), 1000, 999),
    ] {
        let found = talk.ask("pinhole/overlays", json!({ "object": further }));
        let objects = found["objects"].as_array().expect("a list");
        let found = (objects.len(), &objects[count - 1]["index"]);
        assert_eq!(found, (count, &json!(last)));
        let listed = talk.ask("pinhole/objects", json!({ "object": further }));
        assert_eq!(listed.as_array().map(Vec::len), Some(count));
        assert!(listed[0]["range"].is_object() && listed[0]["outline"].is_null());
    }
    for (only, indices) in [
        (json!([]), vec![]),
        (json!([1400, 3]), vec![3, 1400]),
        (json!([1504]), vec![]),
    ] {
        let found = talk.ask("pinhole/overlays", json!({ "only": only }));
        let objects = found["objects"].as_array().expect("a list");
        let found: Vec<_> = objects.iter().map(|it| it["index"].as_u64()).collect();
        assert_eq!(found, indices.into_iter().map(Some).collect::<Vec<_>>());
    }
}

/// A slider need not offer what the language forbids.
#[test]
fn a_number_has_the_limits_of_its_field() {
    let text = "camera { eye (0, 0, 5) lookat (0, 0, 0) fov 1rad }\nsampler { per_pixel 16 }\nsphere { center (0, 0, 0) radius 1 }\nbox { center (0, 0, 0) size (1, 2, 3) }\nlet a = 3\nsphere { center (0, 0, 0) radius a + 1 }";
    let mut talk = Talk::with(text);
    let limits = |least: Value, most: Value, open: bool, whole: bool| json!({ "least": least, "most": most, "open": open, "whole": whole });
    let pi = std::f64::consts::PI;
    for (before, expected) in [
        ("radius 1", limits(json!(0.0), Value::Null, true, false)),
        ("per_pixel 16", limits(json!(1.0), Value::Null, false, true)),
        ("fov 1", limits(json!(0.0), json!(pi), true, false)),
        ("size (1, 2", limits(json!(0.0), Value::Null, true, false)),
        ("eye (0", limits(Value::Null, Value::Null, false, false)),
        ("let a = 3", Value::Null),
        ("radius a + 1", Value::Null),
    ] {
        let at = text.find(before).expect("it is there") + before.len();
        let lines: Vec<&str> = text[..at].split('\n').collect();
        let character = lines[lines.len() - 1].len();
        let position = json!({ "line": lines.len() - 1, "character": character });
        let found = talk.ask("pinhole/limits", json!({ "position": position }));
        assert_eq!(found, expected, "{before}");
    }
}

/// Who drags a ball that the camera looks at hears that the camera moves.
#[test]
fn a_drag_tells_what_else_moves() {
    let text = "let ball = (0, 0, 0)\ncamera { eye (0, 0, 5) lookat ball }\nsphere Ball { center ball }\nsphere { center (0, 2, 0) }";
    let mut talk = Talk::with(text);
    for (object, also) in [(0, json!(["camera.lookat"])), (1, json!([]))] {
        let about = json!({ "object": object, "handle": "center", "to": [430, 225] });
        let found = talk.ask("pinhole/drag", about);
        assert_eq!(found["also"], also, "{found}");
    }
}
