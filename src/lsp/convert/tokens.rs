//! Converts semantic tokens, i.e. words with their kinds, to the encoding of the protocol.

use serde_json::{Value, json};

use super::converter::{Converter, count};
use crate::{
    editor::{SemanticKind, SemanticToken},
    lsp::protocol::Position,
};

impl Converter<'_> {
    /// Encodes tokens as the protocol requires: the position of each token is relative to the
    /// previous one. A comment of several lines is split into one token per line.
    pub fn semantic_tokens(&self, tokens: &[SemanticToken]) -> Value {
        let mut data = Vec::with_capacity(5 * tokens.len());
        let mut last = Position::default();
        for token in tokens {
            let kind = SemanticKind::ALL
                .iter()
                .position(|kind| *kind == token.kind);
            let mut start = token.span.start;
            let text = self.document.sources.text(token.span);
            for piece in text.split(['\n', '\r']) {
                let at = self.position(start);
                start += piece.len() + 1;
                if piece.is_empty() {
                    continue;
                }
                let is_same_line = at.line == last.line;
                data.extend([
                    at.line - last.line,
                    at.character - if is_same_line { last.character } else { 0 },
                    self.columns(piece),
                    kind.map_or(0, count),
                    u32::from(token.is_declaration),
                ]);
                last = at;
            }
        }
        json!({ "data": data })
    }
}
