//! What is said over the web socket.

use std::{fs, io::Write};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use serde_json::{Value, json};
use tungstenite::{Error, Message, protocol::frame::coding::CloseCode};

use super::client::{Page, serve, studio};
use crate::{interrupt::long_pixel, program::command};

const SCENE: &str = "\
image { width 64  height 36 }
camera { eye (0, 2, 5)  lookat (0, 1, 0) }
sphere Ball { center (0, 1, 0)   radius 1 }
checkerboard {}
";

/// Opens the text; what is wrong with it.
fn begin(page: &mut Page, uri: &str, text: &str) -> Value {
    page.ask("initialize", json!({ "capabilities": {} }));
    page.tell("initialized", json!({}));
    let document = json!({ "uri": uri, "languageId": "scn", "version": 1, "text": text });
    page.tell("textDocument/didOpen", json!({ "textDocument": document }));
    page.told("textDocument/publishDiagnostics")["diagnostics"].clone()
}

#[test]
fn a_page_talks_to_a_language_server() {
    let (_folder, studio) = serve("a b.scn", SCENE);
    let (mut page, file) = studio.page();
    assert_eq!(
        file,
        json!({ "name": "a b.scn", "text": SCENE, "reason": null, "saved": true })
    );
    let uri = "studio:///scene.scn";
    assert_eq!(begin(&mut page, uri, SCENE), json!([]));
    let options = json!({ "tabSize": 2, "insertSpaces": true });
    let about = json!({ "textDocument": { "uri": uri }, "options": options });
    let edits = page.ask("textDocument/formatting", about);
    assert_eq!(edits.as_array().unwrap().len(), 1, "{edits}");
    let about = json!({ "uri": uri, "version": 2 });
    let changes = json!([{ "text": SCENE.replace("radius", "radus") }]);
    page.tell(
        "textDocument/didChange",
        json!({ "textDocument": about, "contentChanges": changes }),
    );
    let told = page.told("textDocument/publishDiagnostics");
    assert_eq!(told["diagnostics"][0]["code"], "unknown_field");
}

#[test]
fn what_is_no_message_gets_an_answer_and_the_conversation_goes_on() {
    let (_folder, studio) = studio();
    let (mut page, _) = studio.page();
    for (wrong, code) in [
        ("", -32700),
        ("{", -32700),
        ("[]", -32600),
        ("{\"id\":1}", -32600),
        ("{\"id\":1,\"method\":2}", -32600),
    ] {
        page.write(wrong);
        assert_eq!(page.read()["error"]["code"], code, "{wrong}");
    }
    for (method, params, code) in [
        ("studio/x", json!({ "text": "" }), -32601),
        ("studio/save", json!({}), -32602),
        ("studio/png", json!({ "text": 1 }), -32602),
        ("studio/png", Value::Null, -32602),
        ("x", Value::Null, -32002),
    ] {
        assert_eq!(
            page.respond(method, params)["error"]["code"],
            code,
            "{method}"
        );
    }
    page.socket.send(Message::Ping("x".into())).unwrap();
    assert_eq!(page.socket.read().unwrap(), Message::Pong("x".into()));
    begin(&mut page, "studio:///a", SCENE);
}

#[test]
fn a_picture_is_the_one_that_render_writes() {
    let (folder, studio) = studio();
    let (mut page, _) = studio.page();
    for sampler in [
        "",
        "sampler { method exact }\n",
        "sampler { method sobol  per_pixel 3 }\n",
    ] {
        let text = format!("{SCENE}{sampler}");
        fs::write(folder.path().join("c.scn"), &text).unwrap();
        for format in ["png", "exr"] {
            let name = format!("c.{format}");
            let rendered = command(folder.path(), &["render", "c.scn", "-o", &name]).status();
            assert!(rendered.unwrap().success());
            let answer = page.ask(&format!("studio/{format}"), json!({ "text": text }));
            let bytes = STANDARD.decode(answer[format].as_str().unwrap()).unwrap();
            assert!(
                bytes == fs::read(folder.path().join(name)).unwrap(),
                "{format} {sampler}"
            );
        }
    }
    let error = &page.respond("studio/png", json!({ "text": "sphere {" }))["error"];
    assert_eq!(error["message"], "the scene has errors");
    let huge = SCENE.replace("width 64  height 36", "width 1000000  height 1000000");
    let error = &page.respond("studio/exr", json!({ "text": huge }))["error"];
    assert_eq!(error["code"], -32803, "{error}");
}

#[test]
fn a_message_that_is_too_long_ends_the_conversation() {
    let (_folder, studio) = studio();
    let (mut page, _) = studio.page();
    // The head of a frame of text, with the bit that says masked, a length in 64 bits and a mask.
    let mut head = vec![0x81, 0xff];
    head.extend(((64_u64 << 20) + 1).to_be_bytes());
    head.extend([0; 4]);
    page.socket.get_mut().write_all(&head).unwrap();
    let closed = page.socket.read().unwrap();
    let Message::Close(Some(frame)) = closed else {
        panic!("{closed:?}");
    };
    assert_eq!(frame.code, CloseCode::Size);
    // So do bytes, as there is nothing that they could say.
    let (mut page, _) = studio.page();
    page.socket.send(Message::binary(vec![1])).unwrap();
    let closed = page.socket.read().unwrap();
    let Message::Close(Some(frame)) = closed else {
        panic!("{closed:?}");
    };
    assert_eq!(frame.code, CloseCode::Unsupported);
    assert!(matches!(page.socket.read(), Err(Error::ConnectionClosed)));
    studio.page();
}

#[test]
fn a_conversation_ends_as_the_protocol_says() {
    let (_folder, studio) = studio();
    let (mut page, _) = studio.page();
    begin(&mut page, "studio:///a", SCENE);
    assert_eq!(page.ask("shutdown", Value::Null), Value::Null);
    page.tell("exit", Value::Null);
    assert!(matches!(page.socket.read().unwrap(), Message::Close(_)));
    let (mut page, _) = studio.page();
    page.socket.close(None).unwrap();
    assert!(matches!(page.socket.read().unwrap(), Message::Close(_)));
}

#[test]
fn pages_know_nothing_of_each_other_and_do_not_wait_for_each_other() {
    let (_folder, studio) = studio();
    let (mut first, _) = studio.page();
    let (mut second, _) = studio.page();
    // It takes more than a minute.
    let long = first.request("studio/png", json!({ "text": long_pixel() }));
    let refused = first.respond("studio/png", json!({ "text": SCENE }));
    assert_eq!(refused["error"]["message"], "another picture is being made");
    let wrong = SCENE.replace("sphere", "spher");
    assert_ne!(begin(&mut first, "studio:///a", &wrong), json!([]));
    assert_eq!(begin(&mut second, "studio:///a", SCENE), json!([]));
    second.ask("studio/png", json!({ "text": SCENE }));
    // Nor is a picture waited for that nobody wants any more.
    first.tell("$/cancelRequest", json!({ "id": long + 100 }));
    first.tell("$/cancelRequest", json!({ "id": long }));
    assert_eq!(first.response(long)["error"]["code"], -32800);
    first.ask("studio/png", json!({ "text": SCENE }));
}

/// What is done for a page ends with it, however it ends.
#[cfg(target_os = "linux")]
#[test]
fn a_page_that_is_gone_leaves_no_work() {
    use std::{thread, time::Duration};

    let (_folder, studio) = studio();
    let tasks = format!("/proc/{}/task", studio.child.id());
    let threads = |name: &str| {
        let tasks = fs::read_dir(&tasks)
            .unwrap()
            .map(|task| task.unwrap().path());
        let names = tasks.filter_map(|task| fs::read_to_string(task.join("comm")).ok());
        names.filter(|found| found.trim() == name).count()
    };
    // Those that render a picture are called as the one that asks them to.
    let wait = |name, is_there| {
        for _ in 0..500 {
            if (threads(name) > 0) == is_there {
                return;
            }
            thread::sleep(Duration::from_millis(20));
        }
        panic!("{} threads called {name}", threads(name));
    };
    let (mut page, _) = studio.page();
    begin(&mut page, "studio:///a", SCENE);
    page.request("studio/png", json!({ "text": long_pixel() }));
    wait("picture", true);
    wait("connection", true);
    drop(page);
    for name in ["picture", "connection"] {
        wait(name, false);
    }
    studio.page();
}
