//! Tests of whole sessions of the language server over pipes.

use serde_json::{Value, json};

use super::client::Client;

const SCENE: &str = "let ball = (0, 1, 0)
camera { eye (0, 1, 5)  lookat ball  d 1 }
sphere Ball { center ball  color olive }
";

/// Sends each letter of a scene as a change of the text, and then the requests that an editor would
/// send.
#[test]
fn a_scene_is_typed_letter_by_letter() {
    let mut client = Client::start();
    client.open(json!({}), "");
    let (mut line, mut character) = (0, 0);
    for (index, letter) in SCENE.chars().enumerate() {
        let place = json!({ "line": line, "character": character });
        let change = json!({ "range": { "start": place, "end": place }, "text": letter });
        client.change(index + 2, change);
        match letter {
            '\n' => (line, character) = (line + 1, 0),
            _ => character += 1,
        }
        let position = json!({ "line": line, "character": character });
        client.ask("textDocument/completion", json!({ "position": position }));
        client.ask("textDocument/semanticTokens/full", json!({}));
    }
    let mut told = client.diagnostics();
    while told["version"] != SCENE.chars().count() + 1 {
        told = client.diagnostics();
    }
    assert_eq!(told["diagnostics"], json!([]));
    client.shut_down();
}

#[test]
fn a_client_that_leaves_without_shutdown_ends_the_server_with_status_1() {
    assert_eq!(Client::start().end().0, Some(1));
    let mut client = Client::start();
    client.ask("initialize", json!({ "capabilities": {} }));
    client.notify("exit", Value::Null);
    assert_eq!(client.end(), (Some(1), String::new()));
}

#[test]
fn malformed_lsp_input_is_logged_and_skipped() {
    let mut client = Client::start();
    client.transport.put("hello\r\n\r\n");
    // A response that belongs to no request of the server is ignored.
    client.send(&json!({ "jsonrpc": "2.0", "id": null, "error": { "code": 1, "message": "" } }));
    client.ask("initialize", json!({ "capabilities": {} }));
    client.change(2, json!({ "text": "" }));
    client.notify("textDocument/didOpen", json!({}));
    client.ask("shutdown", Value::Null);
    client.notify("exit", Value::Null);
    let (status, log) = client.end();
    assert_eq!(status, Some(0));
    assert!(log.contains("malformed"), "{log}");
    assert!(log.contains("is not open"), "{log}");
}

/// A range of `null` does not say whether the change replaces a part of the text or the whole text,
/// so the change is ignored.
#[test]
fn a_change_with_an_invalid_range_leaves_the_text_unchanged() {
    let mut client = Client::start();
    client.open(json!({}), SCENE);
    assert_eq!(client.diagnostics()["diagnostics"], json!([]));
    for range in [json!(null), json!(1), json!({}), json!({ "start": null })] {
        client.change(2, json!({ "range": range, "text": "x" }));
        let position = json!({ "line": 1, "character": 32 });
        let found = client.ask("textDocument/definition", json!({ "position": position }));
        assert_ne!(found, Value::Null, "{range}");
    }
    // A change without a range replaces the whole text.
    client.change(2, json!({ "text": "x" }));
    assert_ne!(client.diagnostics()["diagnostics"], json!([]));
    client.ask("shutdown", Value::Null);
    client.notify("exit", Value::Null);
    let (_, log) = client.end();
    let refused = log.matches("textDocument/didChange: invalid type: null");
    assert_eq!(refused.count(), 2, "{log}");
}

#[test]
fn invalid_json_gets_a_parse_error_response() {
    let mut client = Client::start();
    // The name of a header field may be written in upper or lower case.
    for (header, text) in [
        ("Content-Length", "not JSON!"),
        ("content-length", "{\"id\":1,"),
    ] {
        let length = text.len();
        client
            .transport
            .put(&format!("{header}: {length}\r\n\r\n{text}"));
        let answer = client.read();
        assert_eq!(
            (&answer["id"], &answer["error"]["code"]),
            (&Value::Null, &json!(-32700))
        );
    }
    client.ask("initialize", json!({ "capabilities": {} }));
    client.shut_down();
}

#[test]
fn an_oversized_or_unfinished_message_ends_the_server_with_a_reason() {
    for (length, expected) in [
        ("99999999999999", "is announced"),
        ("2000000000", "is announced"),
        // The header announces an allowed length. The input ends after two bytes of the message.
        ("1000000000", "after 2 of 1000000000 bytes"),
    ] {
        let mut client = Client::start();
        client
            .transport
            .put(&format!("Content-Length: {length}\r\n\r\n{{}}"));
        let (status, log) = client.end();
        assert_eq!(status, Some(1));
        assert!(log.contains(expected), "{log}");
    }
}
