//! A completion, and what is put in by it.

use gen_lsp_types as lsp;

use super::converter::{Converter, markup};
use crate::editor::{Completion, CompletionKind, Piece};

impl Converter<'_> {
    pub fn completion(&self, index: usize, completion: Completion) -> lsp::CompletionItem {
        let (kind, documentation) = match completion.kind {
            CompletionKind::Keyword => (lsp::CompletionItemKind::Keyword, None),
            CompletionKind::Block => (lsp::CompletionItemKind::Struct, None),
            CompletionKind::Field => (lsp::CompletionItemKind::Property, None),
            CompletionKind::Definition => (lsp::CompletionItemKind::Variable, None),
            CompletionKind::Function => (lsp::CompletionItemKind::Function, None),
            CompletionKind::Method => (lsp::CompletionItemKind::EnumMember, None),
            CompletionKind::Constant => (lsp::CompletionItemKind::Constant, None),
            CompletionKind::Value => (lsp::CompletionItemKind::Value, None),
            // Editors show a swatch of a colour's code that stands here by itself.
            CompletionKind::Color(color) => {
                let code = lsp::Documentation::String(color.to_string());
                (lsp::CompletionItemKind::Color, Some(code))
            }
        };
        let markup = || lsp::Documentation::MarkupContent(markup(completion.help));
        let has_holes = completion
            .insert
            .iter()
            .any(|piece| matches!(piece, Piece::Hole(_)));
        let is_snippet = self.client.snippets && has_holes;
        lsp::CompletionItem {
            label: completion.label,
            kind: Some(kind),
            detail: Some(completion.detail).filter(|detail| !detail.is_empty()),
            documentation: Some(documentation.unwrap_or_else(markup)),
            // Editors sort by this text, and the list is in its order.
            sort_text: Some(format!("{index:04}")),
            insert_text_format: Some(match is_snippet {
                true => lsp::InsertTextFormat::Snippet,
                false => lsp::InsertTextFormat::PlainText,
            }),
            text_edit: Some(lsp::CompletionItemTextEdit::TextEdit(lsp::TextEdit {
                range: self.range(completion.replaces),
                new_text: match is_snippet {
                    true => snippet(&completion.insert),
                    false => plain(&completion.insert),
                },
            })),
            ..Default::default()
        }
    }
}

/// What is put in, as it is.
fn plain(pieces: &[Piece]) -> String {
    let texts = pieces.iter().map(|piece| match piece {
        Piece::Text(text) | Piece::Hole(text) => text.as_str(),
    });
    texts.collect()
}

/// What is put in, with holes to type over.
fn snippet(pieces: &[Piece]) -> String {
    let mut text = String::new();
    let mut holes = 0;
    for piece in pieces {
        match piece {
            Piece::Text(piece) => text.push_str(&escaped(piece)),
            Piece::Hole(value) => {
                holes += 1;
                text.push_str(&format!("${{{holes}:{}}}", escaped(value)));
            }
        }
    }
    text
}

fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\")
        .replace('$', "\\$")
        .replace('}', "\\}")
}
