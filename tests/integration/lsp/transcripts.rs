//! Conversations, as `tests/lsp` has them: what is said to the server, and below it what the server
//! says.
//!
//! `> METHOD PARAMS` is a request, `! METHOD PARAMS` a notification, and `= TEXT` any other
//! message; the document is added to their parameters. What stands without an empty line between
//! has come before the server begins to work. `#` begins a remark. `PINHOLE_BLESS=1 cargo test`
//! writes anew what the server answers, `<`, and what its log says, `?`.

use std::path::Path;

use serde_json::Value;

use super::{
    client::{Carrier, Client},
    talk::{Inside, logged},
};
use crate::{program::names, snapshot::assert_file};

/// A message in a line: whole, but for what is the same in each, for pictures and for the version
/// of the program.
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

/// A conversation with what the server says now.
fn held(transcript: &str) -> String {
    let mut client = Client::new(Inside::default());
    let block = |block: &str| {
        let mut text = String::new();
        for said in block.lines().filter(|said| !said.starts_with(['<', '?'])) {
            text += &format!("{said}\n");
            let (sign, rest) = said.split_once(' ').expect("a sign, and what is said");
            let (method, params) = rest.split_once(' ').unwrap_or((rest, "{}"));
            let params = || serde_json::from_str(params).expect(said);
            match sign {
                ">" => drop(client.request(method, params())),
                "!" => client.tell(method, params()),
                "=" => client.carrier.write(rest),
                _ => assert_eq!(sign, "#", "{said}"),
            }
        }
        while client.carrier.step() {}
        text.extend(client.carrier.said.drain(..).map(|said| line(&said)));
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
fn conversations_go_as_they_stand_there() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lsp");
    for name in names(&folder).iter().filter(|name| name.ends_with(".txt")) {
        let path = folder.join(name);
        let transcript = std::fs::read_to_string(&path).expect("a transcript");
        assert_file(&path, &held(&transcript));
    }
}
