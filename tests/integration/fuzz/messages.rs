//! What editors and pages say, and what no editor would: each request is answered once, and the
//! server's text stays the client's.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::{any_text, below, each, flip, one};
use crate::{
    lsp::{client::Carrier, talk::Talk},
    tracer::Random,
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

/// A value that may stand anywhere.
fn value(random: &mut Random, depth: usize) -> Value {
    match below(random, if depth == 0 { 12 } else { 14 }) {
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
        12 => (0..below(random, 4))
            .map(|_| value(random, depth - 1))
            .collect(),
        _ => params(random, depth - 1),
    }
}

fn position(random: &mut Random) -> Value {
    let [line, character] = [0; 2].map(|_| {
        let far = *one(random, &[7, 40, 2_147_483_647]);
        below(random, far)
    });
    json!({ "line": line, "character": character })
}

/// Parameters that are right for most requests, but for some that are anything.
fn params(random: &mut Random, depth: usize) -> Value {
    let [start, end] = [0; 2].map(|_| position(random));
    let mut params = json!({
        "position": start, "range": { "start": start, "end": end }, "positions": [end],
        "context": { "diagnostics": [], "includeDeclaration": true },
        "options": { "tabSize": 2, "insertSpaces": true }, "newName": *one(random, &["b", "", "let", "a b"]),
        "color": { "red": 0.5, "green": 1, "blue": 0, "alpha": 1 },
        "scale": *one(random, &[1, 2, 8, 0, -1]), "object": below(random, 5), "handle": *one(random, &["center", "orbit", "radius", ""]),
        "from": [10.5, 3], "to": [below(random, 900), 1e9], "at": [0.5, below(random, 400)], "x": 1, "y": 2, "version": 1,
    });
    for _ in 0..below(random, 3) {
        let keys: Vec<String> = params.as_object().unwrap().keys().cloned().collect();
        let key = one(random, &keys).clone();
        match below(random, 3) {
            0 => drop(params.as_object_mut().unwrap().remove(&key)),
            _ => params[key] = value(random, depth),
        }
    }
    params
}

/// A place in a text as UTF-16 counts it, and where it is.
fn place(random: &mut Random, text: &str) -> (usize, Value) {
    let places: Vec<usize> = (0..=text.len())
        .filter(|at| text.is_char_boundary(*at))
        .collect();
    // Between the two characters of a line's end is no place.
    let is_within = |at: usize| text[..at].ends_with('\r') && text[at..].starts_with('\n');
    let mut at = *one(random, &places);
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
fn each_request_is_answered_once_and_the_text_is_the_clients() {
    each(12, |random| {
        let mut text = any_text(random).to_owned();
        let mut talk = Talk::with(&text);
        let mut asked = Vec::new();
        for version in 2..2 + below(random, 12) {
            let [(a, first), (b, second)] = [0; 2].map(|_| place(random, &text));
            let ((from, start), (to, end)) = match a <= b {
                true => ((a, first), (b, second)),
                false => ((b, second), (a, first)),
            };
            let new = String::from_utf8_lossy(&super::scene(random)).into_owned();
            let new: String = new.chars().take(below(random, 30)).collect();
            // Lines that end in the middle of an edit are counted otherwise before and after it.
            if !new.contains('\r') && !text.contains('\r') {
                text.replace_range(from..to, &new);
                let change = json!({ "range": { "start": start, "end": end }, "text": new });
                talk.change(version, change);
            }
            for _ in 0..below(random, 6) {
                let method = *one(random, &METHODS);
                asked.push(talk.request(method, params(random, 2)));
            }
            if below(random, 3) == 0 {
                talk.carrier.step();
            }
        }
        while talk.carrier.step() {}
        let mut answers = BTreeMap::<_, usize>::new();
        for said in talk.carrier.said.iter() {
            let message: Value = serde_json::from_str(said).unwrap();
            if message.get("method").is_none() {
                *answers.entry(message["id"].as_i64().unwrap()).or_default() += 1;
            }
        }
        for id in asked {
            assert_eq!(answers.get(&id.into()), Some(&1), "request {id}");
        }
        // The edited text has the words and the mistakes of the same text when it is opened.
        let mut again = Talk::with(&text);
        while again.carrier.step() {}
        let ask = |talk: &mut Talk| talk.ask("textDocument/semanticTokens/full", json!({}));
        assert_eq!(ask(&mut talk), ask(&mut again), "{text}");
        let told = |talk: &mut Talk| {
            let said = talk.heard.drain(..);
            let mut told = said.filter(|it| it["method"] == "textDocument/publishDiagnostics");
            told.next_back()
                .map(|mut told| told["params"]["diagnostics"].take())
        };
        assert_eq!(told(&mut talk), told(&mut again), "{text}");
    });
}

#[test]
fn any_bytes_are_a_message_or_get_an_error() {
    each(60, |random| {
        let mut talk = Talk::with(any_text(random));
        for _ in 0..20 {
            let method = *one(random, &METHODS);
            let id = value(random, 1);
            let message =
                json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": value(random, 2) });
            let mut bytes = message.to_string().into_bytes();
            if below(random, 2) == 0 {
                flip(random, &mut bytes);
            }
            // An answer to nothing, which nobody answers, makes the carrier panic.
            let text = String::from_utf8_lossy(&bytes);
            if text.contains("method") && !text.contains("exit") {
                talk.carrier.write(&text);
            }
        }
        while talk.carrier.step() {}
        // Whatever was said, it still answers.
        talk.carrier.said.clear();
        let document = json!({ "textDocument": { "uri": "file:///b.scn", "languageId": "scn", "version": 1, "text": "sphere {}" } });
        talk.send(
            &json!({ "jsonrpc": "2.0", "method": "textDocument/didOpen", "params": document }),
        );
        while talk.carrier.step() {}
        let is_told = |said: &String| said.contains("b.scn") && said.contains("missing_field");
        assert!(
            talk.carrier.said.iter().any(is_told),
            "{:?}",
            talk.carrier.said
        );
    });
}
