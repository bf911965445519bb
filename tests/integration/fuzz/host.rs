//! What is said to `pinhole studio` over the web socket of a page that has shown its token.

use serde_json::{Value, json};
use tungstenite::Message;

use super::{any_text, below, each, flip, one};
use crate::{lsp::client::Carrier, studio::client::studio};

const METHODS: [&str; 6] = [
    "studio/save",
    "studio/png",
    "studio/exr",
    "studio/x",
    "$/cancelRequest",
    "textDocument/hover",
];

/// Whatever is said, the conversation goes on, and the file is what was saved last or what it was.
#[test]
fn no_message_ends_the_conversation() {
    let (folder, studio) = studio();
    let (mut page, _) = studio.page();
    let before = folder.text("a.scn");
    each(40, |random| {
        let any = [
            json!(1),
            json!(null),
            json!([]),
            json!({}),
            json!("x"),
            json!(1e300),
        ];
        let text = any_text(random);
        let mut params = json!({ "text": text, "base": text, "name": "b.scn", "id": 7 });
        for key in ["text", "base", "name"] {
            if below(random, 3) == 0 {
                params[key] = one(random, &any).clone();
            }
        }
        // Nothing that is in the file is said to be known, so nothing is saved over it.
        assert_ne!(params["base"], json!(before));
        let method = *one(random, &METHODS);
        let message = json!({ "jsonrpc": "2.0", "id": "fuzz", "method": method, "params": params });
        let mut bytes = message.to_string().into_bytes();
        if below(random, 3) > 0 {
            flip(random, &mut bytes);
        }
        let text = String::from_utf8_lossy(&bytes).into_owned();
        page.carrier.0.send(Message::text(text)).unwrap();
        // It still answers: what comes before that is the answer to the message.
        let last = json!({ "jsonrpc": "2.0", "id": "last", "method": "studio/x", "params": {} });
        page.carrier.write(&last.to_string());
        while page.read()["id"] != "last" {}
    });
    assert_eq!(folder.text("a.scn"), before);
    // What is saved under another name is a new scene beside it.
    let names = folder.names();
    assert!(names.iter().all(|name| name.ends_with(".scn")), "{names:?}");
    let _: Value = page.respond("studio/x", json!({}));
}
