//! Tests of the messages between a page and the host over a WebSocket.

use std::io::{Cursor, Write};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use serde_json::{Value, json};
use tungstenite::{Error, Message, protocol::frame::coding::CloseCode};

use super::client::{Page, studio};
use crate::{
    interrupt::long_pixel,
    lsp::client::{Client, Transport},
};

const SCENE: &str = "\
image { width 64  height 36 }
camera { eye (0, 2, 5)  lookat (0, 1, 0) }
sphere Ball { center (0, 1, 0)   radius 1 }
checkerboard {}
";

/// Opens a text on a page and returns its diagnostics.
fn open(page: &mut Client<Page>, text: &str) -> Value {
    page.open(json!({}), text);
    page.diagnostics()["diagnostics"].take()
}

#[test]
fn invalid_messages_get_errors_and_the_conversation_continues() {
    let (_folder, studio) = studio();
    let (mut page, _) = studio.page();
    for (wrong, code) in [("", -32700), (r#"{"id":1}"#, -32600)] {
        page.transport.write(wrong);
        assert_eq!(page.read()["error"]["code"], code, "{wrong}");
    }
    for (method, params, code) in [
        ("studio/x", json!({ "text": "" }), -32601),
        ("studio/save", json!({}), -32602),
        ("studio/png", json!({ "text": 1 }), -32602),
        ("studio/png", Value::Null, -32602),
        ("x", Value::Null, -32002),
    ] {
        let found = page.respond(method, params);
        assert_eq!(found["error"]["code"], code, "{method}");
    }
    // No text can contain half of a surrogate pair, so the request is answered with an error.
    let text = r#"{ "id": "page-7", "method": "studio/save", "params": { "text": "\ud800" } }"#;
    page.transport.write(text);
    let answer = page.read();
    assert_eq!(
        (&answer["id"], &answer["error"]["code"]),
        (&json!("page-7"), &json!(-32700))
    );
    let socket = &mut page.transport.0;
    socket.send(Message::Ping("x".into())).unwrap();
    assert_eq!(socket.read().unwrap(), Message::Pong("x".into()));
    open(&mut page, SCENE);
}

#[test]
fn studio_pictures_equal_those_of_render() {
    let (folder, studio) = studio();
    let (mut page, _) = studio.page();
    for sampler in ["", "method exact", "method sobol  per_pixel 3"] {
        let text = format!("{SCENE}sampler {{ {sampler} }}\n");
        folder.write("c.scn", &text);
        for format in ["png", "exr"] {
            let name = format!("c.{format}");
            let rendered = folder.run(&format!("render c.scn -o {name}"));
            assert_eq!(rendered.status, 0, "{}", rendered.errors);
            let answer = page.ask(&format!("studio/{format}"), json!({ "text": text }));
            let bytes = STANDARD.decode(answer[format].as_str().unwrap()).unwrap();
            assert!(bytes == folder.read(&name), "{format} {sampler}");
        }
    }
    let error = &page.respond("studio/png", json!({ "text": "sphere {" }))["error"];
    assert_eq!(error["message"], "the scene has errors");
    let huge = SCENE.replace("width 64  height 36", "width 1000000  height 1000000");
    let error = &page.respond("studio/exr", json!({ "text": huge }))["error"];
    assert_eq!(error["code"], -32803, "{error}");
}

/// An animation has a picture of the text with each value, and shows each picture equally long.
#[test]
fn an_animation_has_a_picture_for_each_value() {
    let (_folder, studio) = studio();
    let (mut page, _) = studio.page();
    let pixels = |file: &Value| {
        let file = STANDARD.decode(file["png"].as_str().expect("a file"));
        let mut reader = png::Decoder::new(Cursor::new(file.unwrap()))
            .read_info()
            .unwrap();
        let count = reader
            .info()
            .animation_control()
            .map_or(1, |it| it.num_frames);
        let frames = (0..count).map(|_| {
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
            let pause = reader.info().frame_control();
            (pixels, pause.map(|it| (it.delay_num, it.delay_den)))
        });
        frames.collect::<Vec<_>>()
    };
    let (before, after) = SCENE.split_once("radius 1").unwrap();
    let before = format!("{before}radius ");
    let of = |values: &[&str]| {
        let time = 2000;
        json!({ "before": before, "values": values, "after": after, "time": time })
    };
    let values = ["0.5", "1", "1.5", "1"];
    let found = pixels(&page.ask("studio/png", of(&values)));
    assert_eq!(found.len(), 4);
    for ((frame, pause), value) in found.iter().zip(values) {
        let text = [&*before, value, after].concat();
        let alone = pixels(&page.ask("studio/png", json!({ "text": text })));
        assert!(*frame == alone[0].0, "{value}");
        assert_eq!(*pause, Some((500, 1000)));
    }
    assert!(found[0].0 != found[1].0 && found[1].0 == found[3].0);
    // Each invalid request gets an error, and the next request is still answered.
    for (params, message) in [
        (of(&["1", "0"]), "with 0 the scene has errors"),
        (of(&[]), "an animation needs `values`"),
        (json!({ "values": ["1"] }), "there is no `before`"),
    ] {
        let error = &page.respond("studio/png", params)["error"];
        assert_eq!(error["message"], message);
    }
    let (head, rest) = SCENE.split_once("64").unwrap();
    let params = json!({ "before": head, "values": ["64", "65"], "after": rest, "time": 2000 });
    let error = &page.respond("studio/png", params)["error"];
    assert_eq!(error["message"], "the size of the picture changes");
    assert_eq!(pixels(&page.ask("studio/png", of(&["2"]))).len(), 1);
}

#[test]
fn a_message_that_is_too_long_ends_the_conversation() {
    let (_folder, studio) = studio();
    // The head of a text frame consists of two bytes with the mask bit, a length of 64 bits, and
    // the mask.
    let head = [
        &[0x81, 0xff],
        &((64_u64 << 20) + 1).to_be_bytes()[..],
        &[0; 4],
    ]
    .concat();
    // A binary message is not allowed, so it also ends the WebSocket connection.
    let mut bytes = studio.page().0.transport.0;
    bytes.send(Message::binary(vec![1])).unwrap();
    let mut long = studio.page().0.transport.0;
    long.get_mut().write_all(&head).unwrap();
    for (mut socket, code) in [(long, CloseCode::Size), (bytes, CloseCode::Unsupported)] {
        match socket.read() {
            Ok(Message::Close(Some(frame))) => assert_eq!(frame.code, code),
            other => panic!("{other:?}"),
        }
        if code == CloseCode::Unsupported {
            assert!(matches!(socket.read(), Err(Error::ConnectionClosed)));
        }
    }
    studio.page();
}

#[test]
fn exit_and_a_close_frame_end_the_conversation() {
    let (_folder, studio) = studio();
    let (mut page, _) = studio.page();
    open(&mut page, SCENE);
    assert_eq!(page.ask("shutdown", Value::Null), Value::Null);
    page.notify("exit", Value::Null);
    let (mut closing, _) = studio.page();
    closing.transport.0.close(None).unwrap();
    for mut page in [page, closing] {
        let last = page.transport.0.read().unwrap();
        assert!(matches!(last, Message::Close(_)), "{last}");
    }
}

#[test]
fn pages_are_independent_and_do_not_block_each_other() {
    let (_folder, studio) = studio();
    let (mut first, _) = studio.page();
    let (mut second, _) = studio.page();
    // The picture takes more than a minute to render. A second picture for this page is refused
    // meanwhile.
    let long = first.request("studio/png", json!({ "text": long_pixel() }));
    let refused = first.respond("studio/png", json!({ "text": SCENE }));
    assert_eq!(refused["error"]["message"], "another picture is being made");
    let wrong = SCENE.replace("sphere", "spher");
    assert_ne!(open(&mut first, &wrong), json!([]));
    assert_eq!(open(&mut second, SCENE), json!([]));
    second.ask("studio/png", json!({ "text": SCENE }));
    // The first cancellation names another request, so it has no effect. The second cancels the
    // picture, so the next one is accepted, even if it is requested at once.
    first.notify("$/cancelRequest", json!({ "id": long + 100 }));
    first.notify("$/cancelRequest", json!({ "id": long }));
    let next = first.request("studio/png", json!({ "text": SCENE }));
    assert_eq!(first.response(long)["error"]["code"], -32800);
    assert!(first.response(next)["result"]["png"].is_string());
}

/// The host stops the work for a page when the page closes, in whatever way it closes.
#[cfg(target_os = "linux")]
#[test]
fn closing_a_page_cancels_its_work() {
    use std::{fs, thread, time::Duration};

    let (_folder, studio) = studio();
    let tasks = format!("/proc/{}/task", studio.child.id());
    // Waits until a thread called `name` runs, or until none does. Rendering threads are included:
    // each has the name of the thread that has started it.
    let wait = |name: &str, is_there: bool| {
        for _ in 0..500 {
            let tasks = fs::read_dir(&tasks)
                .unwrap()
                .map(|task| task.unwrap().path());
            let mut names = tasks.filter_map(|task| fs::read_to_string(task.join("comm")).ok());
            if names.any(|found| found.trim() == name) == is_there {
                return;
            }
            thread::sleep(Duration::from_millis(20));
        }
        panic!("is there a thread called {name}? {}", !is_there);
    };
    let (mut page, _) = studio.page();
    open(&mut page, SCENE);
    page.request("studio/png", json!({ "text": long_pixel() }));
    for name in ["picture", "connection"] {
        wait(name, true);
    }
    drop(page);
    for name in ["picture", "connection"] {
        wait(name, false);
    }
    studio.page();
}
