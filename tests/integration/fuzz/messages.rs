//! Sends random valid and invalid messages, as from editors and pages. Each request gets exactly
//! one answer, and the server's text stays equal to the client's.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::{any_text, each, flip};
use crate::{
    lsp::{client::Transport, local_client::LocalClient},
    random::Random,
};

const METHODS: [&str; 26] = [
    "textDocument/completion",
    "textDocument/hover",
    "textDocument/documentSymbol",
    "textDocument/codeAction",
    "textDocument/semanticTokens/full",
    "textDocument/inlayHint",
    "textDocument/formatting",
    "textDocument/definition",
    "textDocument/references",
    "textDocument/rename",
    "textDocument/prepareRename",
    "textDocument/documentHighlight",
    "textDocument/documentColor",
    "textDocument/colorPresentation",
    "textDocument/foldingRange",
    "textDocument/selectionRange",
    "textDocument/signatureHelp",
    "pinhole/frame",
    "pinhole/overlays",
    "pinhole/drag",
    "pinhole/limits",
    "pinhole/objects",
    "pinhole/probe",
    "pinhole/at",
    "workspace/symbol",
    "$/nothing",
];

/// Returns a random JSON value that is nested at most `depth` levels deep.
fn value(random: &mut Random, depth: usize) -> Value {
    match random.below(if depth == 0 { 12 } else { 14 }) {
        0 => Value::Null,
        1 => json!(true),
        2 => json!(-1),
        3 => json!(4_294_967_296_u64),
        4 => json!(1e300),
        5 => json!("file:///a.scn"),
        6 => json!("center"),
        7 => json!("\u{0}\u{202e}\u{1f600}"),
        8 => json!(0.5),
        9 => json!(3),
        10 => json!([]),
        11 => json!({}),
        12 => (0..random.below(4))
            .map(|_| value(random, depth - 1))
            .collect(),
        _ => params(random, depth - 1),
    }
}

fn position(random: &mut Random) -> Value {
    let [line, character] = [0; 2].map(|_| {
        let far = *random.one_of(&[7, 40, 2_147_483_647]);
        random.below(far)
    });
    json!({ "line": line, "character": character })
}

/// Returns parameters that fit most requests. Some of them are removed or replaced by random
/// values.
fn params(random: &mut Random, depth: usize) -> Value {
    let [start, end] = [0; 2].map(|_| position(random));
    let mut params = json!({
        "position": start, "range": { "start": start, "end": end }, "positions": [end],
        "context": { "diagnostics": [], "includeDeclaration": true },
        "options": { "tabSize": 2, "insertSpaces": true }, "newName": *random.one_of(&["b", "", "let", "a b"]),
        "color": { "red": 0.5, "green": 1, "blue": 0, "alpha": 1 },
        "scale": *random.one_of(&[1, 2, 8, 0, -1]), "object": random.below(5), "handle": *random.one_of(&["center", "orbit", "radius", ""]),
        "from": [10.5, 3], "to": [random.below(900), 1e9], "at": [0.5, random.below(400)], "x": 1, "y": 2, "version": 1,
    });
    for _ in 0..random.below(3) {
        let keys: Vec<String> = params.as_object().unwrap().keys().cloned().collect();
        let key = random.one_of(&keys).clone();
        match random.below(3) {
            0 => drop(params.as_object_mut().unwrap().remove(&key)),
            _ => params[key] = value(random, depth),
        }
    }
    params
}

/// Returns a random byte offset in `text` and the equivalent position, whose column is counted in
/// UTF-16 code units.
fn place(random: &mut Random, text: &str) -> (usize, Value) {
    let places: Vec<usize> = (0..=text.len())
        .filter(|at| text.is_char_boundary(*at))
        .collect();
    // The protocol has no position between the CR and the LF of a line end. If the random offset
    // lies there, the position before the CR is taken.
    let is_within = |at: usize| text[..at].ends_with('\r') && text[at..].starts_with('\n');
    let mut at = *random.one_of(&places);
    if is_within(at) {
        at -= 1;
    }
    let before = text[..at].replace("\r\n", "\n").replace('\r', "\n");
    let line = before.matches('\n').count();
    let column = before.rsplit('\n').next().unwrap_or_default();
    let character = column.encode_utf16().count();
    (at, json!({ "line": line, "character": character }))
}

#[test]
fn each_request_is_answered_once_and_the_server_keeps_the_clients_text() {
    each(12, |random| {
        let mut text = any_text(random).to_owned();
        let mut client = LocalClient::with(&text);
        let mut asked = Vec::new();
        for version in 2..2 + random.below(12) {
            let [(a, first), (b, second)] = [0; 2].map(|_| place(random, &text));
            let ((from, start), (to, end)) = if a <= b {
                ((a, first), (b, second))
            } else {
                ((b, second), (a, first))
            };
            let new = String::from_utf8_lossy(&super::scene(random)).into_owned();
            let new: String = new.chars().take(random.below(30)).collect();
            // If an edit puts a CR before an LF, the two form one line end, and the number of lines
            // changes. Therefore, no edit is made if the edit or the text contains a CR.
            if !new.contains('\r') && !text.contains('\r') {
                text.replace_range(from..to, &new);
                let change = json!({ "range": { "start": start, "end": end }, "text": new });
                client.change(version, change);
            }
            for _ in 0..random.below(6) {
                let method = *random.one_of(&METHODS);
                asked.push(client.request(method, params(random, 2)));
            }
            if random.below(3) == 0 {
                client.transport.step();
            }
        }
        while client.transport.step() {}
        let mut answers = BTreeMap::<_, usize>::new();
        for said in client.transport.said.iter() {
            let message: Value = serde_json::from_str(said).unwrap();
            if message.get("method").is_none() {
                *answers.entry(message["id"].as_i64().unwrap()).or_default() += 1;
            }
        }
        for id in asked {
            assert_eq!(answers.get(&id.into()), Some(&1), "request {id}");
        }
        // After all edits, the tokens and diagnostics must be the same as those of a new client
        // that opens the resulting text.
        let mut again = LocalClient::with(&text);
        while again.transport.step() {}
        let ask =
            |client: &mut LocalClient| client.ask("textDocument/semanticTokens/full", json!({}));
        assert_eq!(ask(&mut client), ask(&mut again), "{text}");
        let told = |client: &mut LocalClient| {
            let said = client.unread.drain(..);
            let mut told = said.filter(|it| it["method"] == "textDocument/publishDiagnostics");
            told.next_back()
                .map(|mut told| told["params"]["diagnostics"].take())
        };
        assert_eq!(told(&mut client), told(&mut again), "{text}");
    });
}

#[test]
fn the_server_still_answers_after_any_message() {
    each(60, |random| {
        let mut client = LocalClient::with(any_text(random));
        for _ in 0..20 {
            let method = *random.one_of(&METHODS);
            let id = value(random, 1);
            let message =
                json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": value(random, 2) });
            let mut bytes = message.to_string().into_bytes();
            if random.below(2) == 0 {
                flip(random, &mut bytes);
            }
            // Two kinds of messages are not sent. A message without `method` may be a response,
            // which the server does not answer, and a message `exit` ends the server.
            let text = String::from_utf8_lossy(&bytes);
            if text.contains("method") && !text.contains("exit") {
                client.transport.write(&text);
            }
        }
        while client.transport.step() {}
        // After any message, the server must still answer.
        client.transport.said.clear();
        let document = json!({ "textDocument": { "uri": "file:///b.scn", "languageId": "scn", "version": 1, "text": "sphere {}" } });
        client.send(
            &json!({ "jsonrpc": "2.0", "method": "textDocument/didOpen", "params": document }),
        );
        while client.transport.step() {}
        let is_told = |said: &String| said.contains("b.scn") && said.contains("missing_field");
        assert!(
            client.transport.said.iter().any(is_told),
            "{:?}",
            client.transport.said
        );
    });
}
