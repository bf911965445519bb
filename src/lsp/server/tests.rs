//! The order of things, with messages that all wait already.

use serde_json::json;

use super::*;

fn request(id: i32, method: &str, params: Value) -> Message {
    Request::new(id.into(), method.to_owned(), params).into()
}

fn notification(method: &str, params: Value) -> Message {
    Notification::new(method.to_owned(), params).into()
}

fn open(text: &str) -> Message {
    let document =
        json!({ "uri": "file:///a.scn", "languageId": "scn", "version": 1, "text": text });
    notification("textDocument/didOpen", json!({ "textDocument": document }))
}

fn change(version: i32, text: &str) -> Message {
    let document = json!({ "uri": "file:///a.scn", "version": version });
    let changes = json!([{ "text": text }]);
    notification(
        "textDocument/didChange",
        json!({ "textDocument": document, "contentChanges": changes }),
    )
}

fn hover(id: i32) -> Message {
    let position = json!({ "line": 0, "character": 4 });
    let document = json!({ "uri": "file:///a.scn" });
    request(
        id,
        "textDocument/hover",
        json!({ "textDocument": document, "position": position }),
    )
}

/// What is said when all messages have come before the first piece of work is done.
fn answers(capabilities: Value, messages: Vec<Message>) -> Vec<Value> {
    let mut server = Server::new(|_| {});
    let hello = request(0, "initialize", json!({ "capabilities": capabilities }));
    assert_eq!(server.handle(hello).len(), 1);
    let mut said: Vec<Message> = messages
        .into_iter()
        .flat_map(|message| server.handle(message))
        .collect();
    while server.is_busy() {
        said.extend(server.advance());
    }
    said.iter()
        .map(|message| serde_json::to_value(message).expect("a value"))
        .collect()
}

#[test]
fn what_was_cancelled_in_the_meantime_is_not_answered() {
    let cancel = notification("$/cancelRequest", json!({ "id": 1 }));
    let found = answers(
        json!({}),
        vec![open("let a = 1"), hover(1), hover(2), cancel],
    );
    assert_eq!(found[0]["id"], 1);
    assert_eq!(found[0]["error"]["code"], -32800);
    assert_eq!(found[1]["id"], 2);
    assert_eq!(found[1]["result"]["range"]["start"]["character"], 4);
}

#[test]
fn of_several_states_the_last_is_judged_and_each_request_is_about_its_own() {
    let messages = vec![
        open("let a = 1"),
        hover(1),
        change(2, "let b = oops"),
        hover(2),
        change(3, "let c = 3"),
        // It comes too late to count.
        change(2, "let d = oops"),
        hover(3),
    ];
    let found = answers(json!({}), messages);
    for (answer, name) in found
        .iter()
        .zip(["`let a = 1`", "`let b = oops`", "`let c = 3`"])
    {
        let text = answer["result"]["contents"]["value"].to_string();
        assert!(text.contains(&name.replace('`', "")), "{answer}");
    }
    assert_eq!(found.len(), 4);
    assert_eq!(found[3]["method"], "textDocument/publishDiagnostics");
    assert_eq!(found[3]["params"]["version"], 3);
    let codes: Vec<&Value> = found[3]["params"]["diagnostics"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|diagnostic| &diagnostic["code"])
        .collect();
    assert_eq!(codes, ["missing_camera", "no_objects"]);
}

#[test]
fn an_answer_that_fails_is_an_answer() {
    let answer = unharmed::<Value>(|| panic!("on purpose"));
    let code = answer.err().map(|Refusal(code, _)| code as i32);
    assert_eq!(code, Some(ErrorCode::InternalError as i32));
}

#[test]
fn a_change_that_is_none_changes_nothing() {
    let change = |range: Value| {
        let document = json!({ "uri": "file:///a.scn", "version": 2 });
        let changes = json!([{ "range": range, "text": "oops" }]);
        let params = json!({ "textDocument": document, "contentChanges": changes });
        notification("textDocument/didChange", params)
    };
    let place = |line: i64, character: i64| json!({ "line": line, "character": character });
    for (line, character) in [(-1, 0), (0, -1), (0, 1 << 40), (1 << 32, 0), (99, 0)] {
        for (start, end) in [((0, 0), (line, character)), ((line, character), (0, 0))] {
            let range = json!({ "start": place(start.0, start.1), "end": place(end.0, end.1) });
            let found = answers(json!({}), vec![open("let a = 1"), change(range), hover(1)]);
            let text = found[0]["result"]["contents"]["value"].to_string();
            assert!(text.contains("let a = 1"), "{text}");
        }
    }
}
