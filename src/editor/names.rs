//! The names that a text defines: where each is defined, where it is used, and what it could be
//! called instead.
//!
//! A `let` and an object may have the same name, and have nothing to do with each other then. An
//! index is known in its block alone.

use super::{
    analysis::Analysis,
    tokens::{Role, Token},
};
use crate::{
    schema::{self, predefined},
    source::Span,
};

/// A place where a name stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// The name.
    pub span: Span,
    /// Whether it is defined here.
    pub is_definition: bool,
}

/// What a name is the name of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Space {
    Lets,
    Objects,
}

/// Where the name at a place is defined.
pub fn definition(analysis: &Analysis<'_>, at: usize) -> Option<Span> {
    let mut occurrences = occurrences(analysis, at).into_iter();
    let first = occurrences.find(|occurrence| occurrence.is_definition);
    first.map(|occurrence| occurrence.span)
}

/// Every place where the name at a place stands, in order; nothing where there is no name of the
/// scene's own.
pub fn occurrences(analysis: &Analysis<'_>, at: usize) -> Vec<Occurrence> {
    let Some((name, space)) = name_at(analysis, at) else {
        return Vec::new();
    };
    let tokens = analysis.tokens().iter();
    let word = analysis.slice(name.span);
    let scope = |at| analysis.index_at(word, at).map(|(block, _)| block.span);
    let own_scope = scope(at);
    let same = tokens.filter(|token| analysis.slice(token.span) == word);
    let same = same.filter(|token| space == Space::Objects || scope(token.span.start) == own_scope);
    let occurrences: Vec<Occurrence> = same
        .filter(|token| space_of(token.role) == Some(space))
        .map(|token| Occurrence {
            span: token.span,
            is_definition: matches!(token.role, Role::Defined | Role::ObjectName),
        })
        .collect();
    let is_defined = occurrences.iter().any(|found| found.is_definition);
    match is_defined {
        true => occurrences,
        false => Vec::new(),
    }
}

/// The name at a place, if it can be changed; otherwise why not.
pub fn renamable(analysis: &Analysis<'_>, at: usize) -> Result<Span, String> {
    let Some(token) = analysis.token_at(at) else {
        return Err("no name stands here".to_owned());
    };
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

/// The places that take a new name instead of the one at a place; or why it will not do.
pub fn rename(analysis: &Analysis<'_>, at: usize, new: &str) -> Result<Vec<Span>, String> {
    renamable(analysis, at)?;
    let occurrences = occurrences(analysis, at);
    let Some((name, space)) = name_at(analysis, at) else {
        return Err("no name stands here".to_owned());
    };
    let starts_well = new.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let is_name = starts_well && new.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if !is_name {
        return Err(format!(
            "`{new}` is no name: a name is made of the letters a to z, digits and `_`, and does not start with a digit"
        ));
    }
    if matches!(new, "let" | "for") {
        return Err(format!("`{new}` is a word of the language"));
    }
    let is_reserved = |name: &str| schema::block(name).is_some_and(|row| !row.is_object);
    match (space, predefined(new)) {
        (Space::Lets, Some(what)) => {
            return Err(format!("`{new}` is {} of the language", what.noun()));
        }
        (Space::Objects, _) if is_reserved(new) => {
            return Err(format!("`{new}` is the name of the {new} block"));
        }
        _ => {}
    }
    // An index of another block is known there alone, and no index of this one.
    let block = |name: &str, at| analysis.index_at(name, at).map(|(block, _)| block.span);
    let own = block(analysis.slice(name.span), name.span.start);
    let is_elsewhere = |token: &Token| {
        let other = block(new, token.span.start);
        own.is_some() && other.is_some() && own != other
    };
    let is_taken = |token: &&Token| {
        space_of(token.role) == Some(space)
            && analysis.slice(token.span) == new
            && !is_elsewhere(token)
    };
    // One that nothing defines would be this one from then on.
    let taken = analysis.tokens().iter().find(is_taken);
    match taken.filter(|_| analysis.slice(name.span) != new) {
        Some(taken) => Err(format!(
            "`{new}` is taken: it stands in line {}",
            analysis.line(taken.span)
        )),
        None => Ok(occurrences.into_iter().map(|found| found.span).collect()),
    }
}

fn name_at(analysis: &Analysis<'_>, at: usize) -> Option<(Token, Space)> {
    let token = analysis.token_at(at)?;
    Some((token, space_of(token.role)?))
}

fn space_of(role: Role) -> Option<Space> {
    match role {
        Role::Defined | Role::Name => Some(Space::Lets),
        Role::ObjectName => Some(Space::Objects),
        _ => None,
    }
}
