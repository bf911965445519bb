//! Answers the protocol's own requests about a document: reads the parameters, calls the editor
//! module, and converts the result.

use lsp_server::Request;
use serde_json::{Value, json};

use super::{
    convert::{self, Converter, FIX_ALL, QUICK_FIX},
    params::{self, Answer, Refusal},
};
use crate::{
    diagnostic::{Diagnostic, Edit, Fix},
    editor::{self, Analysis},
};

/// Answers a request about a document. `known` contains the document's converter and analysis. It
/// is `None` if the document is not open.
pub fn answer(request: Request, known: Option<(Converter<'_>, &Analysis<'_>)>) -> Answer {
    let Request { method, params, .. } = request;
    let Some(about) = method.strip_prefix("textDocument/") else {
        return Err(Refusal::unknown(&method));
    };
    let Some((converter, analysis)) = known else {
        return Err(not_open());
    };
    let at = || params::at(&params, "/position").map(|at| converter.offset(at));
    let range = || params::at(&params, "/range").map(|range| converter.span(range));
    match about {
        "completion" => {
            let completions = editor::completions(analysis, at()?).into_iter().enumerate();
            list(completions, |(index, completion)| {
                converter.completion(index, completion)
            })
        }
        "hover" => Ok(editor::hover(analysis, at()?)
            .map(|it| converter.hover(it))
            .into()),
        "signatureHelp" => {
            let found = editor::signature(analysis, at()?);
            Ok(found.map(|it| converter.signature(it)).into())
        }
        "definition" => {
            let found = editor::definition(analysis, at()?);
            Ok(found.map(|it| converter.location(it)).into())
        }
        "references" => {
            let all: bool = params::at(&params, "/context/includeDeclaration")?;
            let mut found = editor::occurrences(analysis, at()?);
            found.retain(|found| all || !found.is_definition);
            list(found, |found| converter.location(found.span))
        }
        "documentHighlight" => list(editor::occurrences(analysis, at()?), |found| {
            converter.highlight(found)
        }),
        "prepareRename" => {
            let span = editor::renamable(analysis, at()?).map_err(Refusal::failed)?;
            Ok(json!({ "range": converter.range(span), "placeholder": analysis.slice(span) }))
        }
        "rename" => {
            let new: String = params::at(&params, "/newName")?;
            let spans = editor::rename(analysis, at()?, &new).map_err(Refusal::failed)?;
            let edits = spans.into_iter().map(|span| Edit::new(span, &*new));
            Ok(converter.edit(edits))
        }
        "documentSymbol" => list(editor::symbols(analysis), |symbol| converter.symbol(symbol)),
        "foldingRange" => list(editor::folds(analysis), |fold| converter.fold(fold)),
        "inlayHint" => {
            let hints = editor::hints(analysis, range()?.range());
            list(hints, |hint| converter.hint(hint))
        }
        "documentColor" => list(editor::swatches(analysis), |swatch| {
            converter.swatch(swatch)
        }),
        "colorPresentation" => {
            let (color, span) = (params::at(&params, "/color")?, range()?);
            let labels = editor::presentations(analysis, span, convert::color(color));
            list(labels, |label| converter.presentation(span, label))
        }
        "codeAction" => code_actions(converter, analysis, &params),
        // A text with syntax errors gets the answer null rather than an error. An editor that
        // formats on every save would otherwise show an error each time, although the syntax errors
        // are reported already.
        "formatting" => {
            let edits = editor::formatting(analysis);
            Ok(edits.map(|edits| converter.text_edits(edits)).into())
        }
        "semanticTokens/full" => Ok(converter.semantic_tokens(&editor::semantic_tokens(analysis))),
        _ => Err(Refusal::unknown(&method)),
    }
}

/// Returns the error for a request about a document that is not open.
pub fn not_open() -> Refusal {
    Refusal::invalid("the document is not open")
}

fn list<T>(items: impl IntoIterator<Item = T>, convert: impl FnMut(T) -> Value) -> Answer {
    Ok(items.into_iter().map(convert).collect())
}

fn code_actions(converter: Converter<'_>, analysis: &Analysis<'_>, params: &Value) -> Answer {
    let range = params::at(params, "/range")?;
    let only: Option<Vec<String>> = params::at(params, "/context/only")?;
    let is_wanted = |wanted: &[&str]| {
        let mut only = only.iter().flatten();
        only.any(|kind| kind.is_empty() || wanted.contains(&kind.as_str()))
    };
    let mut actions = Vec::new();
    if only.is_none() || is_wanted(&[QUICK_FIX]) {
        let fixes = editor::fixes(analysis, converter.span(range));
        actions.extend(fixes.map(|(diagnostic, fix)| converter.action(fix, Some(diagnostic))));
    }
    // If there are quick fixes at the cursor, and several diagnostics of the text have safe fixes,
    // a fix of all diagnostics is offered, too.
    let all = analysis.diagnostics().iter();
    let has_safe = |it: &&Diagnostic| it.fixes.iter().any(Fix::is_safe);
    let is_more = !actions.is_empty() && all.filter(has_safe).count() > 1;
    if is_more || is_wanted(&["source", FIX_ALL]) {
        actions.extend(editor::fix_all(analysis).map(|fix| converter.action(&fix, None)));
    }
    Ok(Value::Array(actions))
}

/// Returns the diagnostics of a document, converted to the protocol's type.
pub fn diagnostics(converter: Converter<'_>, analysis: &Analysis<'_>) -> Vec<Value> {
    let diagnostics = analysis.diagnostics().iter();
    diagnostics
        .map(|diagnostic| converter.diagnostic(diagnostic))
        .collect()
}
