//! Tests of frames, the pictures that the language server sends to a page. A frame has the same
//! pixels as a render, is computed in slices, and can be cancelled.

use base64::{Engine, prelude::BASE64_STANDARD};
use serde_json::{Value, json};

use super::local_client::LocalClient;
use crate::{program::Folder, table::rows};

pub const SCENE: &str = "\
image { width 83  height 61 }
camera { eye (3, 3.5, 8)  lookat (0.2, 0.8, 0)  d 2.75 }
sampler { method multi_jittered  per_pixel 9  seed 3 }
sphere Ball { center (-1.6, 1, 0)  radius 1  color olive }
box { center (2, 0.75, -0.5)  size (0.5, 1.5, 2)  color orange }
checkerboard {}
";

const CONTENT_MODIFIED: i32 = -32801;
pub const CANCELLED: i32 = -32800;

/// Returns the text of the test scene with another width and height.
fn sized(width: &str, height: &str) -> String {
    let size = format!("width {width}  height {height}");
    SCENE.replace("width 83  height 61", &size)
}

/// Returns the error code in the response to a request. Asserts that the response has arrived.
pub fn code(client: &mut LocalClient, request: i32) -> Value {
    assert!(client.has_answered(request));
    client.response(request)["error"]["code"].take()
}

/// Decodes a PNG file. Returns its width, its height and the bytes of its pixels.
fn pixels(png: &[u8]) -> (u32, u32, Vec<u8>) {
    let picture = image::load_from_memory(png).expect("a picture");
    let rgb = picture.to_rgb8();
    (rgb.width(), rgb.height(), rgb.into_raw())
}

pub fn shown(frame: &Value) -> (u32, u32, Vec<u8>) {
    let png = frame["png"].as_str().expect("a picture");
    let found = pixels(&BASE64_STANDARD.decode(png).expect("base64"));
    assert_eq!(
        (&frame["width"], &frame["height"]),
        (&found.0.into(), &found.1.into())
    );
    found
}

/// Returns the picture of a scene that `pinhole render` makes with the `--set` arguments `sets`.
pub fn rendered(text: &str, sets: &str) -> (u32, u32, Vec<u8>) {
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
            // With 2000 samples per pixel, a slice of work is only a small part of the picture.
            "many" => (SCENE.replace("per_pixel 9", "per_pixel 2000"), [83, 61]),
            "wide" => (sized("100_000", "2"), [100_000, 2]),
            _ => (SCENE.to_owned(), [83, 61]),
        };
        let params: Value = serde_json::from_str(params).expect("JSON");
        let frame = LocalClient::with(&text).ask("pinhole/frame", params);
        assert!(shown(&frame) == rendered(&text, sets), "{name} {sets}");
        assert_eq!(frame["version"], 1);
        assert_eq!(frame["size"], json!(size));
    }
}

#[test]
fn a_frame_of_an_outdated_text_is_refused() {
    let mut client = LocalClient::with(SCENE);
    let old = client.request("pinhole/frame", json!({}));
    // This step of the server publishes the diagnostics but does not complete the frame.
    assert!(client.transport.step() && !client.has_answered(old));
    let changed = SCENE.replace("olive", "teal");
    client.change(2, json!({ "text": changed }));
    let new = client.request("pinhole/frame", json!({}));
    assert_eq!(client.response(old)["error"]["code"], CONTENT_MODIFIED);
    let frame = client.response(new)["result"].clone();
    assert_eq!(frame["version"], 2);
    assert!(shown(&frame) == rendered(&changed, ""));
}

#[test]
fn a_frame_that_is_cancelled_ends_at_once() {
    // The frame consists of ten thousand slices, which would take minutes. The test computes only a
    // few of them.
    let text = sized("1000", "1000").replace("per_pixel 9", "per_pixel 10_000");
    let mut client = LocalClient::with(&text);
    let frame = client.request("pinhole/frame", json!({}));
    let hover = |client: &mut LocalClient| {
        let position = json!({ "line": 0, "character": 1 });
        client.request("textDocument/hover", json!({ "position": position }))
    };
    let early = hover(&mut client);
    for _ in 0..4 {
        assert!(client.transport.step());
    }
    // A request that arrives while the frame is computed is answered between two slices.
    assert!(client.has_answered(early) && !client.has_answered(frame));
    let later = hover(&mut client);
    assert!(client.transport.step() && client.has_answered(later));
    client.notify("$/cancelRequest", json!({ "id": frame }));
    assert_eq!(code(&mut client, frame), CANCELLED);
    assert!(!client.transport.step());

    let frame = client.request("pinhole/frame", json!({}));
    client.transport.step();
    let shutdown = client.request("shutdown", json!({}));
    assert_eq!(code(&mut client, frame), CANCELLED);
    assert!(client.has_answered(shutdown));
}
