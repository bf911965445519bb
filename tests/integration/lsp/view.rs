//! Tests of requests with the parameter `view`, by which the scene is seen from outside.

use serde_json::{Value, json};

use super::{
    frames::{CANCELLED, SCENE, code, rendered, shown},
    local_client::LocalClient,
    viewport::FAILED,
};

const INVALID: i32 = -32602;

/// The `--set` arguments that give a scene the camera of [`view`].
const SETS: &str = "camera.eye=(9,4,3) camera.lookat=(0.5,1,2) camera.up=(0.1,1,0) camera.fov=33deg image.width=90 image.height=51";

fn view() -> Value {
    json!({ "eye": [9, 4, 3], "lookat": [0.5, 1, 2], "up": [0.1, 1, 0], "fov": 33, "size": [90, 51] })
}

/// Returns the test scene with the camera of [`view`] in its text.
fn scene_of_view() -> String {
    let image = SCENE.replace("width 83  height 61", "width 90  height 51");
    let camera = "eye (9, 4, 3)  lookat (0.5, 1, 2)  up (0.1, 1, 0)  fov 33deg";
    image.replace("eye (3, 3.5, 8)  lookat (0.2, 0.8, 0)  d 2.75", camera)
}

#[test]
fn a_view_answers_what_the_scene_with_that_camera_answers() {
    let mut client = LocalClient::with(SCENE);
    let mut other = LocalClient::with(&scene_of_view());
    let with_view = |mut params: Value| {
        params["view"] = view();
        params
    };
    for (params, sets) in [
        (json!({}), ""),
        (
            json!({ "samples": 4 }),
            " sampler.method=regular sampler.per_pixel=4",
        ),
        (
            json!({ "scale": 3, "samples": 1 }),
            " sampler.method=regular sampler.per_pixel=1 image.width=30 image.height=17",
        ),
    ] {
        let frame = client.ask("pinhole/frame", with_view(params));
        assert_eq!(frame["size"], json!([90, 51]));
        assert!(
            shown(&frame) == rendered(SCENE, &format!("{SETS}{sets}")),
            "{sets}"
        );
    }
    // Ranges in the texts are not compared, because the blocks have different positions in the two
    // texts.
    let without_ranges = |answer: &Value| {
        let mut answer = answer.clone();
        let objects = answer["objects"].as_array_mut().into_iter().flatten();
        for object in objects {
            object["range"].take();
            object["selection"].take();
        }
        if let Some(object) = answer["object"].as_object_mut() {
            object["range"].take();
            object["selection"].take();
        }
        for own in ["view", "camera"] {
            answer.as_object_mut().expect("an object").remove(own);
        }
        answer
    };
    for (method, params) in [
        ("pinhole/overlays", json!({})),
        ("pinhole/overlays", json!({ "only": [1, 2] })),
        ("pinhole/pick", json!({ "point": [45, 25] })),
        ("pinhole/pick", json!({ "point": [3.5, 50] })),
        ("pinhole/pick", json!({ "point": [1, 1] })),
        ("pinhole/pick", json!({ "point": [95, 1] })),
    ] {
        let [own, expected] = [
            client.ask(method, with_view(params.clone())),
            other.ask(method, params.clone()),
        ];
        assert_eq!(
            without_ranges(&own),
            without_ranges(&expected),
            "{method} {params}"
        );
    }
    // The requests for a view must not change the picture by the scene's own camera.
    assert!(shown(&client.ask("pinhole/frame", json!({}))) == rendered(SCENE, ""));
}

#[test]
fn a_view_that_is_not_given_is_chosen_and_serves_further_requests() {
    let mut client = LocalClient::with(SCENE);
    let chosen = client.ask(
        "pinhole/overlays",
        json!({ "view": { "size": [500, 240] } }),
    );
    assert_eq!(chosen["view"]["size"], json!([500, 240]));
    let given = client.ask("pinhole/overlays", json!({ "view": chosen["view"] }));
    assert_eq!(given, chosen);
    let names = |answer: &Value| {
        let handles = answer["camera"]["handles"]
            .as_array()
            .expect("a list")
            .iter();
        handles
            .map(|it| it["label"].as_str().expect("a label").to_owned())
            .collect::<Vec<_>>()
    };
    let expected = [
        "eye",
        "lookat",
        "window, d 2.75",
        "view_height 2, angle 40.0°",
        "up",
        "near 0",
    ];
    assert_eq!(names(&chosen), expected);
    // The view is from above, so x points to the right and z downwards. The eye has a larger x and
    // a larger z than `lookat`.
    let view = json!({ "from": [0, 1, 0.001], "size": [500, 240] });
    let top = client.ask("pinhole/overlays", json!({ "view": view }));
    let at = |label: usize, axis: usize| top["camera"]["handles"][label]["at"][axis].as_f64();
    assert!(at(0, 0) > at(1, 0) && at(0, 1) > at(1, 1), "{top}");
}

#[test]
fn a_drag_from_outside_changes_the_text() {
    let mut client = LocalClient::with(SCENE);
    let view = json!({ "from": [1, 0, 0], "size": [500, 240] });
    let seen = client.ask(
        "pinhole/overlays",
        json!({ "view": view, "point": [41.5, 30.5] }),
    );
    let handle = |place: usize| seen["camera"]["handles"][place]["at"].clone();
    let [x, y] = [0, 1].map(|axis| handle(2)[axis].as_f64().expect("a number"));
    let answer = client.ask("pinhole/drag", json!({ "object": null, "handle": "d", "to": [x + 20.0, y], "step": 8, "view": seen["view"] }));
    let values: Vec<String> = serde_json::from_value(answer["values"].clone()).expect("texts");
    assert!(
        values[0].starts_with("camera.d = 3") && values[1].starts_with("d 3"),
        "{answer}"
    );
    assert_eq!(answer["edits"].as_array().map(Vec::len), Some(1));
    assert_eq!(seen["camera"]["met"].as_array().map(Vec::len), Some(2));
    let refused = client.request(
        "pinhole/drag",
        json!({ "handle": "orbit", "to": [1, 1], "view": seen["view"] }),
    );
    assert_eq!(client.response(refused)["error"]["code"], FAILED);
}

#[test]
fn views_that_are_no_cameras_are_refused() {
    let mut client = LocalClient::with(SCENE);
    for change in [
        json!({ "lookat": [9, 4, 3] }),
        json!({ "lookat": null }),
        json!({ "eye": null }),
        json!({ "up": [0, 0, 0] }),
        json!({ "fov": 0 }),
        json!({ "fov": 180 }),
        json!({ "fov": "30deg" }),
        json!({ "size": [0, 10] }),
        json!({ "size": [10, 1_048_577] }),
        json!({ "size": null }),
        json!({ "eye": null, "lookat": null, "fov": -1 }),
    ] {
        let mut wrong = view();
        for (name, value) in change.as_object().expect("an object") {
            wrong[name] = value.clone();
        }
        for method in ["frame", "overlays", "pick", "drag"] {
            let params = json!({ "view": wrong, "point": [1, 1], "to": [1, 1], "handle": "eye" });
            let request = client.request(&format!("pinhole/{method}"), params);
            let answer = client.response(request);
            assert_eq!(
                answer["error"]["code"], INVALID,
                "{method} {change}: {answer}"
            );
        }
    }
    let mut client = LocalClient::with("sphere { center (0, 1, 0) }");
    for method in ["frame", "overlays", "pick", "drag"] {
        let params = json!({ "view": view(), "point": [1, 1], "to": [1, 1], "handle": "eye" });
        assert_eq!(
            client.ask(&format!("pinhole/{method}"), params),
            Value::Null,
            "{method}"
        );
    }
}

/// A request for a picture from a view cancels the unfinished picture from the previous view, but
/// not the picture by the scene's own camera. A picture from a view with few samples is finished
/// before the slow picture by the scene's own camera.
#[test]
fn a_frame_of_a_newer_view_takes_the_place_of_an_older_one() {
    let text = SCENE.replace("width 83  height 61", "width 1000  height 1000");
    let mut client = LocalClient::with(&text.replace("per_pixel 9", "per_pixel 64"));
    let own = client.request("pinhole/frame", json!({}));
    client.transport.step();
    client.transport.step();
    let mut slow = view();
    slow["size"] = json!([1000, 1000]);
    let old = client.request("pinhole/frame", json!({ "view": slow, "samples": 64 }));
    for _ in 0..3 {
        client.transport.step();
    }
    assert!(!client.has_answered(own) && !client.has_answered(old));
    let new = client.request("pinhole/frame", json!({ "view": view(), "samples": 1 }));
    client.transport.step();
    assert_eq!(code(&mut client, old), CANCELLED);
    while !client.has_answered(new) {
        assert!(client.transport.step());
    }
    assert!(!client.has_answered(own));
    assert_eq!(client.response(new)["result"]["size"], json!([90, 51]));
    client.notify("$/cancelRequest", json!({ "id": own }));
    assert_eq!(code(&mut client, own), CANCELLED);
}
