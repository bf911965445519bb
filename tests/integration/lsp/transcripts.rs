//! Runs transcripts in `tests/lsp`. They contain messages to the server, each followed by the
//! server's answers.
//!
//! `> METHOD PARAMS` is a request, `! METHOD PARAMS` a notification, and `= TEXT` any other
//! message. The test adds the document's URI to the parameters. Messages without an empty line
//! between them arrive before the server starts to work. `#` begins a comment.
//! `PINHOLE_BLESS=1 cargo test` rewrites the server's answers (`<`) and its log (`?`).

use std::path::Path;

use serde_json::Value;

use super::{
    client::{Client, Transport},
    local_client::{InProcess, logged},
};
use crate::{program::names, snapshot::assert_file};

/// Returns a message as one line. Leaves out the JSON-RPC version, pictures, and the program's
/// version.
fn line(message: &str) -> String {
    let mut message: Value = serde_json::from_str(message).expect("JSON");
    let members = message.as_object_mut().expect("a message");
    assert_eq!(members.remove("jsonrpc"), Some("2.0".into()));
    if let Some(png) = message.pointer_mut("/result/png") {
        assert!(png.is_string());
        *png = "…".into();
    }
    let version = concat!("\"version\":\"", env!("CARGO_PKG_VERSION"), "\"");
    format!("< {message}\n").replace(version, "\"version\":\"…\"")
}

/// Runs a transcript again. Returns it with the server's current answers in place of the old ones.
fn replayed(transcript: &str) -> String {
    let mut client = Client::new(InProcess::default());
    let block = |block: &str| {
        let mut text = String::new();
        for said in block.lines().filter(|said| !said.starts_with(['<', '?'])) {
            text += &format!("{said}\n");
            let (sign, rest) = said.split_once(' ').expect("a sign, and what is said");
            let (method, params) = rest.split_once(' ').unwrap_or((rest, "{}"));
            let params = || serde_json::from_str(params).expect(said);
            match sign {
                ">" => drop(client.request(method, params())),
                "!" => client.notify(method, params()),
                "=" => client.transport.write(rest),
                _ => assert_eq!(sign, "#", "{said}"),
            }
        }
        while client.transport.step() {}
        text.extend(client.transport.said.drain(..).map(|said| line(&said)));
        text.extend(logged().iter().map(|said| format!("? {said}\n")));
        text
    };
    transcript
        .split("\n\n")
        .map(block)
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn lsp_transcripts_match_the_server() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lsp");
    for name in names(&folder).iter().filter(|name| name.ends_with(".txt")) {
        let path = folder.join(name);
        let transcript = std::fs::read_to_string(&path).expect("a transcript");
        assert_file(&path, &replayed(&transcript));
    }
}
