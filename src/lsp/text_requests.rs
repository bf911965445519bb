//! A request about a document, and its answer: the parameters read, the editor asked, the answer converted.

use gen_lsp_types as lsp;
use lsp_server::Request;
use serde_json::json;

use super::{
    convert::{self, Converter},
    params::{Answer, Refusal, parsed, written},
};
use crate::{
    diagnostic::Edit,
    editor::{self, Analysis},
};

/// The answer to a request about a document.
pub fn answer(request: Request, known: Option<(Converter<'_>, &Analysis<'_>)>) -> Answer {
    let Request { method, params, .. } = request;
    let Some(about) = method.strip_prefix("textDocument/") else {
        return Err(Refusal::unknown(&method));
    };
    let Some((converter, analysis)) = known else {
        return Err(not_open());
    };
    let at = || {
        let position = params.get("position").cloned().unwrap_or_default();
        parsed(position).map(|position| converter.offset(position))
    };
    let range = || {
        let range = params.get("range").cloned().unwrap_or_default();
        parsed(range).map(|range| converter.span(range))
    };
    match about {
        "completion" => {
            let completions = editor::completions(analysis, at()?).into_iter().enumerate();
            list(completions.map(|(index, completion)| converter.completion(index, completion)))
        }
        "hover" => written(&editor::hover(analysis, at()?).map(|it| converter.hover(it))),
        "signatureHelp" => {
            written(&editor::signature(analysis, at()?).map(|it| converter.signature(it)))
        }
        "definition" => {
            written(&editor::definition(analysis, at()?).map(|it| converter.location(it)))
        }
        "references" => {
            let context = params.get("context").cloned().unwrap_or_default();
            let context: lsp::ReferenceContext = parsed(context)?;
            let all = context.include_declaration;
            let found = editor::occurrences(analysis, at()?).into_iter();
            let found = found.filter(|found| all || !found.is_definition);
            list(found.map(|found| converter.location(found.span)))
        }
        "documentHighlight" => {
            let found = editor::occurrences(analysis, at()?).into_iter();
            list(found.map(|found| converter.highlight(found)))
        }
        "prepareRename" => {
            let span = editor::renamable(analysis, at()?).map_err(Refusal::failed)?;
            written(&json!({ "range": converter.range(span), "placeholder": analysis.slice(span) }))
        }
        "rename" => {
            let new: String = parsed(params.get("newName").cloned().unwrap_or_default())?;
            let spans = editor::rename(analysis, at()?, &new).map_err(Refusal::failed)?;
            let edits = spans.into_iter().map(|span| Edit::new(span, &*new));
            written(&converter.edit(edits))
        }
        "documentSymbol" => {
            let symbols = editor::symbols(analysis).into_iter();
            list(symbols.map(|symbol| converter.symbol(symbol)))
        }
        "foldingRange" => list(
            editor::folds(analysis)
                .into_iter()
                .map(|fold| converter.fold(fold)),
        ),
        "inlayHint" => {
            let hints = editor::hints(analysis, range()?.range()).into_iter();
            list(hints.map(|hint| converter.hint(hint)))
        }
        "documentColor" => {
            let swatches = editor::swatches(analysis).into_iter();
            list(swatches.map(|swatch| converter.swatch(swatch)))
        }
        "colorPresentation" => {
            let color: lsp::Color = parsed(params.get("color").cloned().unwrap_or_default())?;
            let span = range()?;
            let labels = editor::presentations(analysis, span, convert::color(&color));
            list(
                labels
                    .into_iter()
                    .map(|label| converter.presentation(span, label)),
            )
        }
        "codeAction" => code_actions(converter, analysis, parsed(params)?),
        // Nothing for a text with mistakes of syntax: they are told already, and an editor that formats on every save must not
        // complain each time.
        "formatting" => {
            let edits = editor::formatting(analysis);
            let edits = edits.map(|edits| converter.text_edits(edits).collect::<Vec<_>>());
            written(&edits)
        }
        "semanticTokens/full" => {
            written(&converter.semantic_tokens(&editor::semantic_tokens(analysis)))
        }
        _ => Err(Refusal::unknown(&method)),
    }
}

/// A request about a document of which the client has not said that it is open.
pub fn not_open() -> Refusal {
    Refusal::invalid("the document is not open")
}

fn list<T: serde::Serialize>(items: impl Iterator<Item = T>) -> Answer {
    written(&items.collect::<Vec<T>>())
}

fn code_actions(
    converter: Converter<'_>,
    analysis: &Analysis<'_>,
    params: lsp::CodeActionParams,
) -> Answer {
    use lsp::CodeActionKind as Kind;
    let only = params.context.only;
    let is_wanted = |wanted: &[Kind]| {
        let mut only = only.iter().flatten();
        only.any(|kind| *kind == Kind::Empty || wanted.contains(kind))
    };
    let mut actions = Vec::new();
    if only.is_none() || is_wanted(&[Kind::QuickFix]) {
        let fixes = editor::fixes(analysis, converter.span(params.range));
        actions.extend(fixes.map(|(diagnostic, fix)| converter.action(fix, Some(diagnostic))));
    }
    // Beside a fix it is offered where there are others.
    let all = analysis.diagnostics().iter();
    let is_more = !actions.is_empty() && all.filter(|it| !it.fixes.is_empty()).count() > 1;
    if is_more || is_wanted(&[Kind::Source, Kind::SourceFixAll]) {
        actions.extend(editor::fix_all(analysis).map(|fix| converter.action(&fix, None)));
    }
    written(&actions)
}

/// What is wrong with a document.
pub fn diagnostics(converter: Converter<'_>, analysis: &Analysis<'_>) -> Vec<lsp::Diagnostic> {
    let diagnostics = analysis.diagnostics().iter();
    diagnostics
        .map(|diagnostic| converter.diagnostic(diagnostic))
        .collect()
}
