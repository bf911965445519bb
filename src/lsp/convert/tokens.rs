//! Tokens, each as far from the one before it as the protocol counts.

use gen_lsp_types as lsp;

use super::converter::{Converter, count};
use crate::editor::{SemanticKind, SemanticToken};

impl Converter<'_> {
    /// Each token relative to the one before it; comments of several lines in pieces, a line each.
    pub fn semantic_tokens(&self, tokens: &[SemanticToken]) -> lsp::SemanticTokens {
        let mut data = Vec::with_capacity(tokens.len());
        let mut last = lsp::Position::default();
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
                data.push(lsp::SemanticToken {
                    delta_line: at.line - last.line,
                    delta_start: match at.line == last.line {
                        true => at.character - last.character,
                        false => at.character,
                    },
                    length: self.columns(piece),
                    token_type: kind.map_or(0, count),
                    token_modifiers_bitset: u32::from(token.is_declaration),
                });
                last = at;
            }
        }
        lsp::SemanticTokens {
            result_id: None,
            data,
        }
    }
}
