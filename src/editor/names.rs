//! Finds the definitions and uses of names, and renames them.
//!
//! `let`s and objects have separate namespaces, so a `let` and an object may have equal names. The
//! index of a repeated block, such as `i` in `for i < 3`, can be used only in this block.

use super::{
    analysis::Analysis,
    tokens::{Role, RoleToken},
};
use crate::{
    schema::{self, predefined},
    source::Span,
    syntax,
};

/// A definition or a use of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// Span of the name.
    pub span: Span,
    /// Whether this is the definition of the name rather than a use.
    pub is_definition: bool,
}

/// Namespace of a name: the namespace of `let`s and `for` indices, or the namespace of objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Namespace {
    Lets,
    Objects,
}

/// Returns the span of the name at the place where it is defined. The offset `at` is in the
/// definition or in a use of the name. Returns `None` if the text does not define the name.
pub fn definition(analysis: &Analysis<'_>, at: usize) -> Option<Span> {
    let mut occurrences = occurrences(analysis, at).into_iter();
    let first = occurrences.find(|occurrence| occurrence.is_definition);
    first.map(|occurrence| occurrence.span)
}

/// Returns the definition and all uses of the name at the offset `at`, in order. Returns an empty
/// list if the text does not define the name.
pub fn occurrences(analysis: &Analysis<'_>, at: usize) -> Vec<Occurrence> {
    let Some((name, space)) = name_at(analysis, at) else {
        return Vec::new();
    };
    let tokens = analysis.tokens().iter();
    let word = analysis.slice(name.span);
    let scope = |at| analysis.index_at(word, at).map(|(block, _)| block.span);
    let own_scope = scope(at);
    let same = tokens.filter(|token| analysis.slice(token.span) == word);
    let same =
        same.filter(|token| space == Namespace::Objects || scope(token.span.start) == own_scope);
    let occurrences: Vec<Occurrence> = same
        .filter(|token| space_of(token.role) == Some(space))
        .map(|token| Occurrence {
            span: token.span,
            is_definition: matches!(token.role, Role::Defined | Role::ObjectName),
        })
        .collect();
    let is_defined = occurrences.iter().any(|found| found.is_definition);
    if is_defined { occurrences } else { Vec::new() }
}

/// Returns the span of the name at the offset `at`.
///
/// # Errors
///
/// Returns a sentence that says why the name cannot be renamed.
pub fn renamable(analysis: &Analysis<'_>, at: usize) -> Result<Span, String> {
    let token = analysis.token_at(at).ok_or("no name stands here")?;
    let word = analysis.slice(token.span);
    if !occurrences(analysis, at).is_empty() {
        return Ok(token.span);
    }
    Err(match token.role {
        Role::Field | Role::Kind | Role::Let | Role::Repeat | Role::Function | Role::Method => {
            format!("`{word}` is a word of the language")
        }
        Role::Name | Role::Defined => match predefined(word) {
            Some(what) => format!("`{word}` is {} of the language", what.noun()),
            None => format!("`{word}` is not defined"),
        },
        _ => "no name stands here".to_owned(),
    })
}

/// Returns all spans that must be replaced to rename the name at the offset `at` to `new`.
///
/// # Errors
///
/// Returns a sentence that says why the name cannot be renamed to `new`.
pub fn rename(analysis: &Analysis<'_>, at: usize, new: &str) -> Result<Vec<Span>, String> {
    renamable(analysis, at)?;
    let occurrences = occurrences(analysis, at);
    let (name, space) = name_at(analysis, at).ok_or("no name stands here")?;
    if !syntax::is_name(new) {
        return Err(format!(
            "`{new}` is no name: a name is made of the letters a to z, digits and `_`, and does not start with a digit"
        ));
    }
    if matches!(new, "let" | "for") {
        return Err(format!("`{new}` is a word of the language"));
    }
    let is_reserved = |name: &str| schema::block(name).is_some_and(|row| !row.is_object);
    match (space, predefined(new)) {
        (Namespace::Lets, Some(what)) => {
            return Err(format!("`{new}` is {} of the language", what.noun()));
        }
        (Namespace::Objects, _) if is_reserved(new) => {
            return Err(format!("`{new}` is the name of the {new} block"));
        }
        _ => {}
    }
    // Indices of different blocks may have equal names. So an index can be renamed to `new` even if
    // another block has an index `new`.
    let block = |name: &str, at| analysis.index_at(name, at).map(|(block, _)| block.span);
    let own = block(analysis.slice(name.span), name.span.start);
    let is_elsewhere = |token: &RoleToken| {
        let other = block(new, token.span.start);
        own.is_some() && other.is_some() && own != other
    };
    let is_taken = |token: &&RoleToken| {
        space_of(token.role) == Some(space)
            && analysis.slice(token.span) == new
            && !is_elsewhere(token)
    };
    // If the text uses `new` without a definition, this use would refer to the renamed definition,
    // so it is a conflict, too.
    let taken = analysis.tokens().iter().find(is_taken);
    match taken.filter(|_| analysis.slice(name.span) != new) {
        Some(taken) => Err(format!(
            "`{new}` is taken: it stands in line {}",
            analysis.line(taken.span)
        )),
        None => Ok(occurrences.into_iter().map(|found| found.span).collect()),
    }
}

fn name_at(analysis: &Analysis<'_>, at: usize) -> Option<(RoleToken, Namespace)> {
    let token = analysis.token_at(at)?;
    Some((token, space_of(token.role)?))
}

fn space_of(role: Role) -> Option<Namespace> {
    match role {
        Role::Defined | Role::Name => Some(Namespace::Lets),
        Role::ObjectName => Some(Namespace::Objects),
        _ => None,
    }
}
