//! Sends random messages to `pinhole studio`, over the WebSocket of a page with a valid token.

use serde_json::{Value, json};
use tungstenite::Message;

use super::{any_text, each, flip};
use crate::{lsp::client::Transport, studio::client::studio};

const METHODS: [&str; 6] = [
    "studio/save",
    "studio/png",
    "studio/exr",
    "studio/x",
    "$/cancelRequest",
    "textDocument/hover",
];

/// After any message, the host must still answer, and the file must be unchanged.
#[test]
fn no_studio_message_ends_the_conversation_or_changes_the_file() {
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
            if random.below(3) == 0 {
                params[key] = random.one_of(&any).clone();
            }
        }
        // A save overwrites the file only if `base`, the content that the page knows, is the file's
        // current content. No message has this content as `base`, so none may overwrite the file.
        assert_ne!(params["base"], json!(before));
        let method = *random.one_of(&METHODS);
        let message = json!({ "jsonrpc": "2.0", "id": "fuzz", "method": method, "params": params });
        let mut bytes = message.to_string().into_bytes();
        if random.below(3) > 0 {
            flip(random, &mut bytes);
        }
        let text = String::from_utf8_lossy(&bytes).into_owned();
        page.transport.0.send(Message::text(text)).unwrap();
        // Waits for the answer to one more request. The messages before this answer belong to the
        // random message and are skipped.
        let last = json!({ "jsonrpc": "2.0", "id": "last", "method": "studio/x", "params": {} });
        page.transport.write(&last.to_string());
        while page.read()["id"] != "last" {}
    });
    assert_eq!(folder.text("a.scn"), before);
    // Besides this file, the folder may contain new scenes: a text that is saved under another name
    // is written to a new file.
    let names = folder.names();
    assert!(names.iter().all(|name| name.ends_with(".scn")), "{names:?}");
    let _: Value = page.respond("studio/x", json!({}));
}
