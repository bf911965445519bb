//! A request about a document, and its answer: the parameters read, the editor asked, the answer converted.

use gen_lsp_types as lsp;
use lsp_server::{ErrorCode, Request};
use serde_json::json;

use super::{
    convert::{self, Page},
    params::{Answer, Refusal, parsed, written},
};
use crate::editor::{self, Analysis};

/// The answer to a request about a document.
pub fn answer(request: Request, known: Option<(Page<'_>, &Analysis<'_>)>) -> Answer {
    let params = request.params;
    let known = known.ok_or_else(|| {
        Refusal(
            ErrorCode::InvalidParams,
            "the document is not open".to_owned(),
        )
    });
    match request.method.as_str() {
        "textDocument/completion" => completion(known?, parsed(params)?),
        "textDocument/hover" => hover(known?, parsed(params)?),
        "textDocument/signatureHelp" => signature(known?, parsed(params)?),
        "textDocument/definition" => definition(known?, parsed(params)?),
        "textDocument/references" => references(known?, parsed(params)?),
        "textDocument/documentHighlight" => highlights(known?, parsed(params)?),
        "textDocument/prepareRename" => prepare_rename(known?, parsed(params)?),
        "textDocument/rename" => rename(known?, parsed(params)?),
        "textDocument/documentSymbol" => symbols(known?),
        "textDocument/foldingRange" => folds(known?),
        "textDocument/inlayHint" => hints(known?, parsed(params)?),
        "textDocument/documentColor" => colors(known?),
        "textDocument/colorPresentation" => presentations(known?, parsed(params)?),
        "textDocument/codeAction" => code_actions(known?, parsed(params)?),
        "textDocument/formatting" => formatting(known?),
        "textDocument/semanticTokens/full" => semantic_tokens(known?),
        method => Err(Refusal(
            ErrorCode::MethodNotFound,
            format!("`{method}` is not known here"),
        )),
    }
}

type Known<'a, 's> = (Page<'a>, &'a Analysis<'s>);

fn completion((page, analysis): Known<'_, '_>, params: lsp::CompletionParams) -> Answer {
    let at = page.offset(params.text_document_position_params.position);
    let completions = editor::completions(analysis, at).into_iter().enumerate();
    let items = completions.map(|(index, completion)| page.completion(index, completion));
    let items: Vec<_> = items.collect();
    written(&items)
}

fn hover((page, analysis): Known<'_, '_>, params: lsp::HoverParams) -> Answer {
    let at = page.offset(params.text_document_position_params.position);
    written(&editor::hover(analysis, at).map(|hover| page.hover(hover)))
}

fn signature((page, analysis): Known<'_, '_>, params: lsp::SignatureHelpParams) -> Answer {
    let at = page.offset(params.text_document_position_params.position);
    written(&editor::signature(analysis, at).map(|signature| page.signature(signature)))
}

fn definition((page, analysis): Known<'_, '_>, params: lsp::DefinitionParams) -> Answer {
    let at = page.offset(params.text_document_position_params.position);
    written(&editor::definition(analysis, at).map(|span| page.location(span)))
}

fn references((page, analysis): Known<'_, '_>, params: lsp::ReferenceParams) -> Answer {
    let at = page.offset(params.text_document_position_params.position);
    let found = editor::occurrences(analysis, at).into_iter();
    let found = found.filter(|found| params.context.include_declaration || !found.is_definition);
    let locations: Vec<_> = found.map(|found| page.location(found.span)).collect();
    written(&locations)
}

fn highlights((page, analysis): Known<'_, '_>, params: lsp::DocumentHighlightParams) -> Answer {
    let at = page.offset(params.text_document_position_params.position);
    let found = editor::occurrences(analysis, at).into_iter();
    let highlights: Vec<_> = found.map(|found| page.highlight(found)).collect();
    written(&highlights)
}

fn prepare_rename((page, analysis): Known<'_, '_>, params: lsp::PrepareRenameParams) -> Answer {
    let at = page.offset(params.text_document_position_params.position);
    let span = editor::renamable(analysis, at).map_err(refused)?;
    written(&json!({ "range": page.range(span), "placeholder": analysis.slice(span) }))
}

fn rename((page, analysis): Known<'_, '_>, params: lsp::RenameParams) -> Answer {
    let at = page.offset(params.text_document_position_params.position);
    let spans = editor::rename(analysis, at, &params.new_name).map_err(refused)?;
    let edits = spans
        .into_iter()
        .map(|span| (span, params.new_name.clone()));
    written(&page.edit(edits))
}

/// A request that was right, and cannot be done; editors show the reason.
fn refused(reason: String) -> Refusal {
    Refusal(ErrorCode::RequestFailed, reason)
}

fn symbols((page, analysis): Known<'_, '_>) -> Answer {
    let symbols = editor::symbols(analysis).into_iter();
    let symbols: Vec<_> = symbols.map(|symbol| page.symbol(symbol)).collect();
    written(&symbols)
}

fn folds((page, analysis): Known<'_, '_>) -> Answer {
    let folds = editor::folds(analysis).into_iter();
    let folds: Vec<_> = folds.map(|fold| page.fold(fold)).collect();
    written(&folds)
}

fn hints((page, analysis): Known<'_, '_>, params: lsp::InlayHintParams) -> Answer {
    let within = page.span(params.range).range();
    let hints = editor::hints(analysis, within).into_iter();
    let hints: Vec<_> = hints.map(|hint| page.hint(hint)).collect();
    written(&hints)
}

fn colors((page, analysis): Known<'_, '_>) -> Answer {
    let swatches = editor::swatches(analysis).into_iter();
    let colors: Vec<_> = swatches.map(|swatch| page.swatch(swatch)).collect();
    written(&colors)
}

fn presentations((page, analysis): Known<'_, '_>, params: lsp::ColorPresentationParams) -> Answer {
    let span = page.span(params.range);
    let color = convert::color(&params.color);
    let labels = editor::presentations(analysis, span, color).into_iter();
    let presentations = labels.map(|label| lsp::ColorPresentation {
        text_edit: Some(lsp::TextEdit {
            range: page.range(span),
            new_text: label.clone(),
        }),
        label,
        additional_text_edits: None,
    });
    let presentations: Vec<_> = presentations.collect();
    written(&presentations)
}

fn code_actions((page, analysis): Known<'_, '_>, params: lsp::CodeActionParams) -> Answer {
    use lsp::CodeActionKind as Kind;
    let only = params.context.only;
    let is_wanted = |wanted: &[Kind]| {
        let mut only = only.iter().flatten();
        only.any(|kind| *kind == Kind::Empty || wanted.contains(kind))
    };
    let mut actions = Vec::new();
    if only.is_none() || is_wanted(&[Kind::QuickFix]) {
        let fixes = editor::fixes(analysis, page.span(params.range));
        actions.extend(fixes.map(|(diagnostic, fix)| page.action(fix, Some(diagnostic))));
    }
    // Beside a fix it is offered where there are others.
    let all = analysis.diagnostics().iter();
    let is_more = !actions.is_empty() && all.filter(|it| !it.fixes.is_empty()).count() > 1;
    if is_more || is_wanted(&[Kind::Source, Kind::SourceFixAll]) {
        actions.extend(editor::fix_all(analysis).map(|fix| page.action(&fix, None)));
    }
    written(&actions)
}

/// Nothing for a text with mistakes of syntax: they are told already, and an editor that formats on every save must not complain
/// each time.
fn formatting((page, analysis): Known<'_, '_>) -> Answer {
    let changes = editor::formatting(analysis);
    let edits: Option<Vec<_>> = changes.map(|changes| page.text_edits(changes).collect());
    written(&edits)
}

fn semantic_tokens((page, analysis): Known<'_, '_>) -> Answer {
    written(&page.semantic_tokens(&editor::semantic_tokens(analysis)))
}

/// What is wrong with a document.
pub fn diagnostics(page: Page<'_>, analysis: &Analysis<'_>) -> Vec<lsp::Diagnostic> {
    let diagnostics = analysis.diagnostics().iter();
    diagnostics
        .map(|diagnostic| page.diagnostic(diagnostic))
        .collect()
}
