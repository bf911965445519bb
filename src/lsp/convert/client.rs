//! What the client understands, and what the server offers it.

use gen_lsp_types as lsp;
use line_index::WideEncoding;
use serde_json::{Value, json};

use crate::{editor::SemanticKind, lsp::documents::Encoding};

/// What the client understands.
#[derive(Clone, Copy, Debug)]
pub struct Client {
    /// In what columns are counted.
    pub encoding: Encoding,
    /// Whether a completion may have values to type over.
    pub snippets: bool,
    /// Whether changes may name the version that they are for.
    pub versioned_edits: bool,
}

impl Client {
    /// What a client says of itself in the parameters of `initialize`. The fields are looked up one by one: to read all that a client may say
    /// would take a twentieth of the whole program's compilation.
    pub fn new(params: &Value) -> Self {
        let field = |path: &str| params.pointer(path);
        let can = |path: &str| field(path) == Some(&Value::Bool(true));
        let words = |path: &str| {
            let words = field(path).and_then(Value::as_array).into_iter().flatten();
            words.filter_map(Value::as_str)
        };
        Self {
            encoding: encoding(words("/capabilities/general/positionEncodings")),
            snippets: can("/capabilities/textDocument/completion/completionItem/snippetSupport"),
            versioned_edits: can("/capabilities/workspace/workspaceEdit/documentChanges"),
        }
    }
}

/// The first of the client's encodings that is known: it wants them in this order. UTF-16 if it says nothing.
fn encoding<'a>(mut offered: impl Iterator<Item = &'a str>) -> Encoding {
    let known = offered.find_map(|kind| match kind {
        "utf-8" => Some(Encoding::Utf8),
        "utf-16" => Some(Encoding::Wide(WideEncoding::Utf16)),
        "utf-32" => Some(Encoding::Wide(WideEncoding::Utf32)),
        _ => None,
    });
    known.unwrap_or(Encoding::Wide(WideEncoding::Utf16))
}

/// What the server offers.
pub fn capabilities(client: &Client) -> lsp::ServerCapabilities {
    let words = |words: &[&str]| Some(words.iter().map(|word| (*word).to_owned()).collect());
    lsp::ServerCapabilities {
        position_encoding: Some(match client.encoding {
            Encoding::Utf8 => lsp::PositionEncodingKind::UTF8,
            Encoding::Wide(WideEncoding::Utf32) => lsp::PositionEncodingKind::UTF32,
            Encoding::Wide(_) => lsp::PositionEncodingKind::UTF16,
        }),
        text_document_sync: Some(lsp::TextDocumentSync::Options(
            lsp::TextDocumentSyncOptions {
                open_close: Some(true),
                change: Some(lsp::TextDocumentSyncKind::Incremental),
                ..Default::default()
            },
        )),
        completion_provider: Some(lsp::CompletionOptions::default()),
        hover_provider: Some(lsp::HoverProvider::Bool(true)),
        signature_help_provider: Some(lsp::SignatureHelpOptions {
            trigger_characters: words(&["(", ","]),
            ..Default::default()
        }),
        definition_provider: Some(lsp::DefinitionProvider::Bool(true)),
        references_provider: Some(lsp::ReferencesProvider::Bool(true)),
        document_highlight_provider: Some(lsp::DocumentHighlightProvider::Bool(true)),
        document_symbol_provider: Some(lsp::DocumentSymbolProvider::Bool(true)),
        document_formatting_provider: Some(lsp::DocumentFormattingProvider::Bool(true)),
        code_action_provider: Some(lsp::CodeActionProvider::CodeActionOptions(
            lsp::CodeActionOptions {
                code_action_kinds: Some(vec![
                    lsp::CodeActionKind::QuickFix,
                    lsp::CodeActionKind::SourceFixAll,
                ]),
                ..Default::default()
            },
        )),
        color_provider: Some(lsp::ColorProvider::Bool(true)),
        rename_provider: Some(lsp::RenameProvider::RenameOptions(lsp::RenameOptions {
            prepare_provider: Some(true),
            ..Default::default()
        })),
        folding_range_provider: Some(lsp::FoldingRangeProvider::Bool(true)),
        inlay_hint_provider: Some(lsp::InlayHintProvider::Bool(true)),
        semantic_tokens_provider: Some(lsp::SemanticTokensProvider::SemanticTokensOptions(
            lsp::SemanticTokensOptions {
                legend: lsp::SemanticTokensLegend {
                    token_types: SemanticKind::ALL.map(token_type).map(str::to_owned).into(),
                    token_modifiers: vec!["declaration".to_owned()],
                },
                full: Some(lsp::Full::Bool(true)),
                ..Default::default()
            },
        )),
        // docs/protocol.md
        experimental: Some(json!({ "pinhole": 1 })),
        ..Default::default()
    }
}

/// The legend's word for a kind of token.
fn token_type(kind: SemanticKind) -> &'static str {
    match kind {
        SemanticKind::Keyword => "keyword",
        SemanticKind::Property => "property",
        SemanticKind::Variable => "variable",
        SemanticKind::Class => "class",
        SemanticKind::Function => "function",
        SemanticKind::EnumMember => "enumMember",
        SemanticKind::Number => "number",
        SemanticKind::Operator => "operator",
        SemanticKind::Comment => "comment",
    }
}
