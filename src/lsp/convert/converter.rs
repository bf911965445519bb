//! Converts diagnostics, edits and other facts about a document to the types of the protocol. Also
//! converts positions and changes from the protocol to byte offsets and spans.

use serde_json::{Value, json};

use super::client::{Client, FIX_ALL, QUICK_FIX};
use crate::{
    color::Color,
    diagnostic::{Applicability, Diagnostic, Edit, Fix, Severity},
    editor::{
        self, Fold, FoldKind, Hint, Hover, Occurrence, Signature, Swatch, Symbol, SymbolKind,
    },
    lsp::{
        documents::{Document, LineColumn, TextChange},
        params::{Refusal, at},
        protocol::{self, Position, Range, Uri, without_nulls},
    },
    source::{Encoding, SourceId, Span},
};

/// A document and the client in which it is open. Converts between the types of the protocol and
/// those of the editor module.
#[derive(Clone, Copy)]
pub struct Converter<'d> {
    /// The client in which the document is open.
    pub client: &'d Client,
    /// URI of the document.
    pub uri: &'d Uri,
    /// The document itself.
    pub document: &'d Document,
}

pub(super) fn count(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

impl Converter<'_> {
    /// Converts a position in the protocol to a byte offset.
    pub fn offset(&self, position: Position) -> usize {
        self.document.offset(line_column(position))
    }

    /// Converts a range in the protocol to a span. If the end of the range precedes its start, they
    /// are swapped.
    pub fn span(&self, range: Range) -> Span {
        let (start, end) = (self.offset(range.start), self.offset(range.end));
        Span::new(SourceId::File, start.min(end), end.max(start))
    }

    pub fn position(&self, offset: usize) -> Position {
        let (line, character) = self.document.line_column(offset);
        Position { line, character }
    }

    pub fn range(&self, span: Span) -> Range {
        Range {
            start: self.position(span.start),
            end: self.position(span.end),
        }
    }

    pub fn location(&self, span: Span) -> Value {
        json!({ "uri": self.uri, "range": self.range(span) })
    }

    pub(super) fn columns(&self, text: &str) -> u32 {
        count(self.client.encoding.columns(text))
    }

    /// Converts a diagnostic to the protocol's type. The diagnostic's help text is appended to its
    /// message, and all labels except the first become related information.
    pub fn diagnostic(&self, diagnostic: &Diagnostic) -> Value {
        let mut labels = diagnostic.labels.iter();
        let place = labels.next().map(|label| self.range(label.span));
        let related = labels.map(
            |label| json!({ "location": self.location(label.span), "message": label.message }),
        );
        let related: Vec<_> = related.collect();
        let message = match &diagnostic.help {
            Some(help) => format!("{}\nhelp: {help}", diagnostic.message),
            None => diagnostic.message.clone(),
        };
        without_nulls(json!({
            "range": place.unwrap_or_default(),
            "severity": match diagnostic.severity {
                Severity::Error => 1,
                Severity::Warning => 2,
            },
            // The prefix `pinhole::` is removed from the code, because the field `source` already
            // names Pinhole.
            "code": diagnostic.code.trim_start_matches("pinhole::"),
            "source": "pinhole",
            "message": message,
            // In the protocol, 1 stands for `Unnecessary`; editors show such text in grey.
            "tags": diagnostic.is_needless.then_some([1]),
            "relatedInformation": Some(related).filter(|related| !related.is_empty()),
        }))
    }

    pub fn hover(&self, hover: Hover) -> Value {
        json!({ "contents": markup(hover.markdown), "range": self.range(hover.span) })
    }

    pub fn signature(&self, signature: Signature) -> Value {
        let parameters = signature.parameters.iter().map(|range| {
            // The protocol demands UTF-16 for offsets within the label of a signature, even if the
            // client counts columns in another unit.
            let before = |end: usize| {
                let before = signature.label.get(..end).unwrap_or_default();
                count(Encoding::Utf16.columns(before))
            };
            json!({ "label": [before(range.start), before(range.end)] })
        });
        let parameters: Vec<_> = parameters.collect();
        let active = count(signature.active);
        json!({
            "signatures": [{
                "label": signature.label,
                "documentation": signature.help,
                "parameters": parameters,
                "activeParameter": active,
            }],
            "activeSignature": 0,
            "activeParameter": active,
        })
    }

    pub fn highlight(&self, occurrence: Occurrence) -> Value {
        // In the protocol, 3 stands for `Write` and 2 for `Read`.
        let kind = if occurrence.is_definition { 3 } else { 2 };
        json!({ "range": self.range(occurrence.span), "kind": kind })
    }

    /// Converts edits to the protocol's type `TextEdit`.
    pub fn text_edits(&self, edits: impl IntoIterator<Item = Edit>) -> Vec<Value> {
        let edit = |edit: Edit| json!({ "range": self.range(edit.span), "newText": edit.text });
        edits.into_iter().map(edit).collect()
    }

    /// Converts edits of the document to the protocol's type `WorkspaceEdit`. Includes the
    /// document's version if the client supports it.
    pub fn edit(&self, edits: impl IntoIterator<Item = Edit>) -> Value {
        let edits = self.text_edits(edits);
        if !self.client.versioned_edits {
            return json!({ "changes": { self.uri.0.as_str(): edits } });
        }
        // The version lets an editor reject the edits if its text has changed in the meantime.
        let document = json!({ "uri": self.uri, "version": self.document.version });
        json!({ "documentChanges": [{ "textDocument": document, "edits": edits }] })
    }

    /// Converts a fix to a code action. `of` is the diagnostic that the fix belongs to, or `None`
    /// for a fix of all diagnostics.
    ///
    /// If the client supports snippets in edits, the example values in a fix of one line become
    /// placeholders, which the user replaces.
    pub fn action(&self, fix: &Fix, of: Option<&Diagnostic>) -> Value {
        let is_made_up = fix.applicability == Applicability::Placeholder;
        let edit = match (is_made_up, fix.edits.as_slice()) {
            // A fix of several lines does not become a snippet: its lines are indented already,
            // and an editor would indent those after the first again.
            (true, [only]) if self.client.snippet_edits && !only.text.trim().contains('\n') => {
                self.snippet(only)
            }
            _ => self.edit(fix.edits.iter().cloned()),
        };
        let values = fix.edits.first().filter(|_| is_made_up);
        let values = values.map(|edit| editor::made_up_values(&edit.text));
        let values = values.into_iter().flatten();
        let values: Vec<[usize; 2]> = values.map(|value| [value.start, value.end]).collect();
        let title = if is_made_up {
            format!("{}, then type over its value", fix.title)
        } else {
            fix.title.clone()
        };
        without_nulls(json!({
            "title": title,
            "kind": if of.is_some() { QUICK_FIX } else { FIX_ALL },
            "diagnostics": of.map(|diagnostic| [self.diagnostic(diagnostic)]),
            // Editors may apply a preferred fix without asking. So a fix is preferred only if it is
            // safe and is the only fix of its diagnostic.
            "isPreferred": of.map(|diagnostic| diagnostic.fixes.len() == 1 && fix.is_safe()),
            "edit": edit,
            // This field is Pinhole's extension of code actions; see docs/protocol.md.
            "data": of.map(|_| json!({
                "applicability": fix.applicability.word(),
                "values": values,
            })),
        }))
    }

    /// Converts an edit to a snippet. The example values in its text, which the user is to replace,
    /// become placeholders.
    fn snippet(&self, edit: &Edit) -> Value {
        let mut template = String::new();
        let mut at = 0;
        for (index, value) in (1..).zip(editor::made_up_values(&edit.text)) {
            let part = |range| edit.text.get(range).unwrap_or_default();
            let (before, value_text) =
                (escaped(part(at..value.start)), escaped(part(value.clone())));
            template += &format!("{before}${{{index}:{value_text}}}");
            at = value.end;
        }
        template += &escaped(edit.text.get(at..).unwrap_or_default());
        let snippet = json!({ "kind": "snippet", "value": template });
        let edit = json!({ "range": self.range(edit.span), "snippet": snippet });
        let document = json!({ "uri": self.uri, "version": self.document.version });
        json!({ "documentChanges": [{ "textDocument": document, "edits": [edit] }] })
    }

    /// Converts an entry of the outline, with its children.
    pub fn symbol(&self, symbol: Symbol) -> Value {
        let children = symbol.children.into_iter().map(|child| self.symbol(child));
        let children: Vec<_> = children.collect();
        without_nulls(json!({
            "name": symbol.name,
            "detail": Some(symbol.detail).filter(|detail| !detail.is_empty()),
            "kind": match symbol.kind {
                // 2 is the number of the kind `Module` in the protocol.
                SymbolKind::Setting => 2,
                // 7 is the number of the kind `Property` in the protocol.
                SymbolKind::Field => 7,
                // 13 is the number of the kind `Variable` in the protocol.
                SymbolKind::Definition => 13,
                SymbolKind::Object => 19,
            },
            "range": self.range(symbol.span),
            "selectionRange": self.range(symbol.selection),
            "children": Some(children).filter(|children| !children.is_empty()),
        }))
    }

    pub fn fold(&self, fold: Fold) -> Value {
        let range = self.range(fold.span);
        without_nulls(json!({
            "startLine": range.start.line,
            "endLine": range.end.line,
            "kind": match fold.kind {
                FoldKind::Comment => Some("comment"),
                FoldKind::Block => None,
            },
        }))
    }

    pub fn hint(&self, hint: Hint) -> Value {
        // 1 is the number of the kind `Type` of hints in the protocol.
        let kind = 1;
        json!({
            "position": self.position(hint.at), "label": hint.text, "kind": kind, "paddingLeft": true
        })
    }

    pub fn swatch(&self, swatch: Swatch) -> Value {
        let [red, green, blue] = swatch.color.srgb.map(|channel| (channel / 255.0) as f32);
        let color = protocol::Color {
            red,
            green,
            blue,
            alpha: 1.0,
        };
        json!({ "range": self.range(swatch.span), "color": color })
    }

    pub fn presentation(&self, span: Span, label: String) -> Value {
        let edit = json!({ "range": self.range(span), "newText": label });
        json!({ "label": label, "textEdit": edit })
    }
}

/// Reads the changes of a text from a notification. A change without the field `range` replaces the
/// whole text. If `range` is null, returns an error, because the client may have meant to replace
/// only a part.
pub fn changes(params: &Value) -> Result<Vec<TextChange>, Refusal> {
    let changes: Vec<Value> = at(params, "/contentChanges")?;
    let change = |change: &Value| {
        let text = at(change, "/text")?;
        let range = match change.get("range") {
            None => None,
            Some(_) => {
                let range: Range = at(change, "/range")?;
                Some([line_column(range.start), line_column(range.end)])
            }
        };
        Ok(TextChange { range, text })
    };
    changes.iter().map(change).collect()
}

/// Escapes all characters that have a special meaning in a snippet.
pub(super) fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\")
        .replace('$', "\\$")
        .replace('}', "\\}")
}

fn line_column(position: Position) -> LineColumn {
    (position.line, position.character)
}

/// Converts a colour that the user has picked in the client. Its channels are rounded to 8 bits.
pub fn color(color: protocol::Color) -> Color {
    let bytes = [color.red, color.green, color.blue];
    // The conversion saturates, so channels outside of 0 to 1 are clamped.
    Color::from_bytes(bytes.map(|channel| (channel * 255.0).round() as u8))
}

pub(super) fn markup(markdown: String) -> Value {
    json!({ "kind": "markdown", "value": markdown })
}
