//! Converts completions and their inserted texts to the types of the protocol.

use serde_json::{Value, json};

use super::converter::{Converter, escaped, markup};
use crate::{
    editor::{Completion, CompletionKind, SnippetPart},
    lsp::protocol::without_nulls,
};

impl Converter<'_> {
    pub fn completion(&self, index: usize, completion: Completion) -> Value {
        let kind = match completion.kind {
            CompletionKind::Function => 3,
            // 6 is the number of the kind `Variable` in the protocol.
            CompletionKind::Definition => 6,
            // 10 is the number of the kind `Property` in the protocol.
            CompletionKind::Field => 10,
            CompletionKind::Value => 12,
            CompletionKind::Keyword => 14,
            CompletionKind::Color(_) => 16,
            // 20 is the number of the kind `EnumMember` in the protocol.
            CompletionKind::Method => 20,
            CompletionKind::Constant => 21,
            // 22 is the number of the kind `Struct` in the protocol.
            CompletionKind::Block => 22,
        };
        let documentation = match completion.kind {
            // Editors show the colour beside the completion if the documentation is only a
            // colour code.
            CompletionKind::Color(color) => json!(color.to_string()),
            _ => markup(completion.help),
        };
        let is_hole = |piece: &SnippetPart| matches!(piece, SnippetPart::Placeholder(_));
        let is_snippet = self.client.snippets && completion.insert.iter().any(is_hole);
        let text = if is_snippet {
            snippet(&completion.insert)
        } else {
            plain(&completion.insert)
        };
        without_nulls(json!({
            "label": completion.label,
            // If a completion has an edit but no `filterText`, Neovim assumes that the completions
            // are filtered already, and replaces the typed text by the first of them.
            "filterText": completion.label,
            "kind": kind,
            "detail": Some(completion.detail).filter(|detail| !detail.is_empty()),
            "documentation": documentation,
            // Editors sort completions by this text. It is the completion's index, so editors keep
            // the order in which the server lists the completions.
            "sortText": format!("{index:04}"),
            // In the protocol, 1 stands for `PlainText` and 2 for `Snippet`.
            "insertTextFormat": 1 + u8::from(is_snippet),
            "textEdit": { "range": self.range(completion.replaces), "newText": text },
        }))
    }
}

/// Joins the parts of a completion to plain text, for a client without snippets. The text of a
/// placeholder is inserted like any other text.
fn plain(pieces: &[SnippetPart]) -> String {
    let texts = pieces.iter().map(|piece| match piece {
        SnippetPart::Text(text) | SnippetPart::Placeholder(text) => text.as_str(),
    });
    texts.collect()
}

/// Converts the parts of a completion to a snippet. Placeholders are numbered from 1; a user jumps
/// from one to the next and types over its text.
fn snippet(pieces: &[SnippetPart]) -> String {
    let mut text = String::new();
    let mut holes = 0;
    for piece in pieces {
        match piece {
            SnippetPart::Text(piece) => text.push_str(&escaped(piece)),
            SnippetPart::Placeholder(value) => {
                holes += 1;
                text.push_str(&format!("${{{holes}:{}}}", escaped(value)));
            }
        }
    }
    text
}
