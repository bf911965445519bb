//! Converts answers about a document into the types of the protocol, and the places and changes of the protocol into ours.

use gen_lsp_types as lsp;
use line_index::WideEncoding;
use serde_json::Value;

use super::client::Client;
use crate::{
    color::Color,
    diagnostic::{Diagnostic, Edit, Fix, Severity},
    editor::{Fold, FoldKind, Hint, Hover, Occurrence, Signature, Swatch, Symbol, SymbolKind},
    lsp::{
        documents::{Change, Document, Place},
        params::{Refusal, parsed},
    },
    source::{SourceId, Span},
};

/// A document with its address, for the client that has it open.
#[derive(Clone, Copy)]
pub struct Converter<'d> {
    /// Who has it open.
    pub client: &'d Client,
    /// Its address.
    pub uri: &'d lsp::Uri,
    /// The text.
    pub document: &'d Document,
}

pub(super) fn count(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}

impl Converter<'_> {
    /// The offset of a position.
    pub fn offset(&self, position: lsp::Position) -> usize {
        self.document.offset(place(position))
    }

    /// A span of the text from a range.
    pub fn span(&self, range: lsp::Range) -> Span {
        let (start, end) = (self.offset(range.start), self.offset(range.end));
        Span::new(SourceId::File, start.min(end), end.max(start))
    }

    pub fn position(&self, offset: usize) -> lsp::Position {
        let (line, character) = self.document.place(offset);
        lsp::Position { line, character }
    }

    pub fn range(&self, span: Span) -> lsp::Range {
        lsp::Range {
            start: self.position(span.start),
            end: self.position(span.end),
        }
    }

    pub fn location(&self, span: Span) -> lsp::Location {
        lsp::Location {
            uri: self.uri.clone(),
            range: self.range(span),
        }
    }

    pub(super) fn columns(&self, text: &str) -> u32 {
        count(self.client.encoding.columns(text))
    }

    /// A diagnostic: the help stands below the message, the labels but the first are its other places.
    pub fn diagnostic(&self, diagnostic: &Diagnostic) -> lsp::Diagnostic {
        let mut labels = diagnostic.labels.iter();
        let place = labels.next().map(|label| label.span);
        let related = labels.map(|label| lsp::DiagnosticRelatedInformation {
            location: self.location(label.span),
            message: label.message.clone(),
        });
        let related: Vec<_> = related.collect();
        let message = match &diagnostic.help {
            Some(help) => format!("{}\nhelp: {help}", diagnostic.message),
            None => diagnostic.message.clone(),
        };
        // The source says whose code it is.
        let code = diagnostic.code.trim_start_matches("pinhole::");
        lsp::Diagnostic {
            range: place.map(|span| self.range(span)).unwrap_or_default(),
            severity: Some(match diagnostic.severity {
                Severity::Error => lsp::DiagnosticSeverity::Error,
                Severity::Warning => lsp::DiagnosticSeverity::Warning,
            }),
            code: Some(lsp::Code::String(code.to_owned())),
            code_description: None,
            source: Some("pinhole".to_owned()),
            message: lsp::Message::String(message),
            // An editor shows it in grey.
            tags: diagnostic
                .is_needless
                .then(|| vec![lsp::DiagnosticTag::Unnecessary]),
            related_information: Some(related).filter(|related| !related.is_empty()),
            data: None,
        }
    }

    pub fn hover(&self, hover: Hover) -> lsp::Hover {
        lsp::Hover {
            contents: lsp::Contents::MarkupContent(markup(hover.markdown)),
            range: Some(self.range(hover.span)),
        }
    }

    pub fn signature(&self, signature: Signature) -> lsp::SignatureHelp {
        let parameters = signature.parameters.iter().map(|range| {
            // Counted in UTF-16 units whatever the encoding of positions.
            let before = |end: usize| {
                let before = signature.label.get(..end).unwrap_or_default();
                count(WideEncoding::Utf16.measure(before))
            };
            lsp::ParameterInformation {
                label: lsp::ParameterInformationLabel::Tuple((
                    before(range.start),
                    before(range.end),
                )),
                documentation: None,
            }
        });
        let active = lsp::ActiveParameter::Int(count(signature.active));
        lsp::SignatureHelp {
            signatures: vec![lsp::SignatureInformation {
                parameters: Some(parameters.collect()),
                documentation: Some(lsp::Documentation::String(signature.help.to_owned())),
                active_parameter: Some(active),
                label: signature.label,
            }],
            active_signature: Some(0),
            active_parameter: Some(active),
        }
    }

    pub fn highlight(&self, occurrence: Occurrence) -> lsp::DocumentHighlight {
        lsp::DocumentHighlight {
            range: self.range(occurrence.span),
            kind: Some(match occurrence.is_definition {
                true => lsp::DocumentHighlightKind::Write,
                false => lsp::DocumentHighlightKind::Read,
            }),
        }
    }

    /// Texts that take the place of others.
    pub fn text_edits(
        &self,
        edits: impl IntoIterator<Item = Edit>,
    ) -> impl Iterator<Item = lsp::TextEdit> {
        edits.into_iter().map(|edit| lsp::TextEdit {
            range: self.range(edit.span),
            new_text: edit.text,
        })
    }

    /// The same as one change of the document.
    pub fn edit(&self, edits: impl IntoIterator<Item = Edit>) -> lsp::WorkspaceEdit {
        let edits = self.text_edits(edits);
        if !self.client.versioned_edits {
            let changes = [(self.uri.clone(), edits.collect())];
            return lsp::WorkspaceEdit {
                changes: Some(changes.into()),
                ..Default::default()
            };
        }
        // With the version, an editor that is ahead of this text refuses it.
        let edit = lsp::TextDocumentEdit {
            text_document: lsp::OptionalVersionedTextDocumentIdentifier {
                version: Some(self.document.version),
                text_document_identifier: lsp::TextDocumentIdentifier {
                    uri: self.uri.clone(),
                },
            },
            edits: edits.map(lsp::Edit::TextEdit).collect(),
        };
        lsp::WorkspaceEdit {
            document_changes: Some(vec![lsp::DocumentChange::TextDocumentEdit(edit)]),
            ..Default::default()
        }
    }

    /// A way out of a diagnostic, or of all of them.
    pub fn action(&self, fix: &Fix, of: Option<&Diagnostic>) -> lsp::CodeAction {
        lsp::CodeAction {
            title: fix.title.clone(),
            kind: Some(match of {
                Some(_) => lsp::CodeActionKind::QuickFix,
                None => lsp::CodeActionKind::SourceFixAll,
            }),
            diagnostics: of.map(|diagnostic| vec![self.diagnostic(diagnostic)]),
            // The only way out is the one to take without asking.
            is_preferred: of.map(|diagnostic| diagnostic.fixes.len() == 1),
            edit: Some(self.edit(fix.edits.iter().cloned())),
            ..Default::default()
        }
    }

    /// An entry of the outline.
    #[allow(deprecated, reason = "a struct must be given all its fields")]
    pub fn symbol(&self, symbol: Symbol) -> lsp::DocumentSymbol {
        let children = symbol.children.into_iter().map(|child| self.symbol(child));
        let children: Vec<_> = children.collect();
        lsp::DocumentSymbol {
            name: symbol.name,
            detail: Some(symbol.detail).filter(|detail| !detail.is_empty()),
            kind: symbol_kind(symbol.kind),
            tags: None,
            deprecated: None,
            range: self.range(symbol.span),
            selection_range: self.range(symbol.selection),
            children: Some(children).filter(|children| !children.is_empty()),
        }
    }

    pub fn fold(&self, fold: Fold) -> lsp::FoldingRange {
        let range = self.range(fold.span);
        lsp::FoldingRange {
            start_line: range.start.line,
            start_character: None,
            end_line: range.end.line,
            end_character: None,
            kind: match fold.kind {
                FoldKind::Comment => Some(lsp::FoldingRangeKind::Comment),
                FoldKind::Block => None,
            },
            collapsed_text: None,
        }
    }

    pub fn hint(&self, hint: Hint) -> lsp::InlayHint {
        lsp::InlayHint {
            position: self.position(hint.at),
            label: lsp::Label::String(hint.text),
            kind: Some(lsp::InlayHintKind::Type),
            text_edits: None,
            tooltip: None,
            padding_left: Some(true),
            padding_right: None,
            data: None,
        }
    }

    pub fn swatch(&self, swatch: Swatch) -> lsp::ColorInformation {
        let [red, green, blue] = swatch.color.srgb.map(|channel| (channel / 255.0) as f32);
        lsp::ColorInformation {
            range: self.range(swatch.span),
            color: lsp::Color {
                red,
                green,
                blue,
                alpha: 1.0,
            },
        }
    }

    pub fn presentation(&self, span: Span, label: String) -> lsp::ColorPresentation {
        let mut edits = self.text_edits([Edit::new(span, &*label)]);
        lsp::ColorPresentation {
            text_edit: edits.next(),
            label,
            additional_text_edits: None,
        }
    }
}

/// The changes of a text. They are taken apart here: to the protocol's type, a change whose range is none looks like one of the whole text.
pub fn changes(params: &Value) -> Result<Vec<Change>, Refusal> {
    let changes = params.get("contentChanges").cloned().unwrap_or_default();
    let changes: Vec<Value> = parsed(changes)?;
    let change = |change: Value| {
        let text = parsed(change.get("text").cloned().unwrap_or_default())?;
        let range: Option<lsp::Range> = parsed(change.get("range").cloned().unwrap_or_default())?;
        let range = range.map(|range| [place(range.start), place(range.end)]);
        Ok(Change { range, text })
    };
    changes.into_iter().map(change).collect()
}

fn place(position: lsp::Position) -> Place {
    (position.line, position.character)
}

/// A colour as a client picks it.
pub fn color(color: &lsp::Color) -> Color {
    let bytes = [color.red, color.green, color.blue];
    // A conversion of floats ends at the bounds.
    Color::from_bytes(bytes.map(|channel| (channel * 255.0).round() as u8))
}

fn symbol_kind(kind: SymbolKind) -> lsp::SymbolKind {
    match kind {
        SymbolKind::Definition => lsp::SymbolKind::Variable,
        SymbolKind::Setting => lsp::SymbolKind::Module,
        SymbolKind::Object => lsp::SymbolKind::Object,
        SymbolKind::Field => lsp::SymbolKind::Property,
    }
}

pub(super) fn markup(markdown: String) -> lsp::MarkupContent {
    lsp::MarkupContent {
        kind: lsp::MarkupKind::Markdown,
        value: markdown,
    }
}
