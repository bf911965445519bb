//! Reads the capabilities of the client (the editor), and declares the capabilities of the server.

use serde_json::{Value, json};

use crate::{editor::SemanticKind, lsp::documents::Encoding};

/// Name in the protocol for code actions that fix one mistake.
pub const QUICK_FIX: &str = "quickfix";
/// Name in the protocol for the code action that fixes all mistakes of a text.
pub const FIX_ALL: &str = "source.fixAll";

/// The features of the language server protocol that the client, i.e. the editor, supports.
#[derive(Clone, Copy, Debug)]
pub struct Client {
    /// Unit in which the columns of a line are counted.
    pub encoding: Encoding,
    /// Whether the client accepts completions that are snippets, i.e. texts with placeholders.
    pub snippets: bool,
    /// Whether the client accepts edits that state the version of the document to which they apply.
    pub versioned_edits: bool,
    /// Whether the client accepts edits that insert snippets, i.e. texts with placeholders.
    pub snippet_edits: bool,
}

impl Client {
    /// Reads the client's capabilities from the parameters of `initialize`. The fields are looked
    /// up one by one, because generated types for all of them would lengthen compilation by about 5
    /// percent.
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
            snippet_edits: can("/capabilities/workspace/workspaceEdit/documentChanges")
                && can("/capabilities/workspace/workspaceEdit/snippetEditSupport"),
        }
    }
}

/// Returns the unit in which columns are counted: the first unit in `offered` that the server
/// supports. `offered` is the client's list, in its order of preference. Returns UTF-16 if the list
/// contains no such unit.
fn encoding<'a>(mut offered: impl Iterator<Item = &'a str>) -> Encoding {
    let known = offered.find_map(|kind| match kind {
        "utf-8" => Some(Encoding::Utf8),
        "utf-16" => Some(Encoding::Utf16),
        "utf-32" => Some(Encoding::Utf32),
        _ => None,
    });
    known.unwrap_or(Encoding::Utf16)
}

/// Returns the capabilities of the server.
pub fn capabilities(client: &Client) -> Value {
    json!({
        "positionEncoding": match client.encoding {
            Encoding::Utf8 => "utf-8",
            Encoding::Utf32 => "utf-32",
            Encoding::Utf16 => "utf-16",
        },
        // In the protocol, 2 stands for `Incremental`: changes are sent as edits of the text.
        "textDocumentSync": { "openClose": true, "change": 2 },
        "completionProvider": { "triggerCharacters": ["("] },
        "hoverProvider": true,
        "signatureHelpProvider": { "triggerCharacters": ["(", ","] },
        "definitionProvider": true,
        "referencesProvider": true,
        "documentHighlightProvider": true,
        "documentSymbolProvider": true,
        "documentFormattingProvider": true,
        "codeActionProvider": { "codeActionKinds": [QUICK_FIX, FIX_ALL] },
        "colorProvider": true,
        "renameProvider": { "prepareProvider": true },
        "foldingRangeProvider": true,
        "inlayHintProvider": true,
        "semanticTokensProvider": {
            "legend": {
                "tokenTypes": SemanticKind::ALL.map(token_type),
                "tokenModifiers": ["declaration"],
            },
            "full": true,
        },
        // Version of Pinhole's own requests; see docs/protocol.md.
        "experimental": { "pinhole": 1 },
    })
}

/// Returns the name that the protocol defines for a kind of semantic token.
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
