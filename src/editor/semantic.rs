//! Classifies the words of a text, so that editors can colour them.

use super::{
    analysis::Analysis,
    tokens::{Role, RoleToken},
};
use crate::{
    schema::{self, css},
    source::{Span, sort_by_span},
};

/// A word, number, sign or comment of the text, with the kind by which editors colour it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SemanticToken {
    /// Span of the token. A comment may span several lines.
    pub span: Span,
    /// Kind by which editors colour the token.
    pub kind: SemanticKind,
    /// Whether the token defines a name, i.e. is the name of a `let` or a `for` index where it is
    /// introduced.
    pub is_declaration: bool,
}

/// Kind of a token, by which editors colour it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SemanticKind {
    /// `let`, `for`, or the keyword of a block.
    Keyword,
    /// The name of a field.
    Property,
    /// The name of a `let` or a `for` index.
    Variable,
    /// The name of an object.
    Class,
    /// The name of a function.
    Function,
    /// A predefined word that stands for a value: a sampling method, a named colour or a constant.
    EnumMember,
    /// A number with its unit, or a colour code.
    Number,
    /// An operator or `=`.
    Operator,
    /// A comment.
    Comment,
}

impl SemanticKind {
    /// All kinds in the order of the token legend that the language server sends. The language
    /// server protocol identifies a kind by its index in the legend.
    pub const ALL: [Self; 9] = [
        Self::Keyword,
        Self::Property,
        Self::Variable,
        Self::Class,
        Self::Function,
        Self::EnumMember,
        Self::Number,
        Self::Operator,
        Self::Comment,
    ];
}

/// Returns the words, numbers, signs and comments of the text with their kinds, in order.
pub fn semantic_tokens(analysis: &Analysis<'_>) -> Vec<SemanticToken> {
    let words = analysis.tokens().iter();
    let words = words.filter_map(|token| classified(analysis, token));
    let comments = analysis.comments().iter().map(|&span| SemanticToken {
        span,
        kind: SemanticKind::Comment,
        is_declaration: false,
    });
    let mut tokens: Vec<SemanticToken> = words.chain(comments).collect();
    sort_by_span(&mut tokens, |token| token.span);
    tokens
}

fn classified(analysis: &Analysis<'_>, token: &RoleToken) -> Option<SemanticToken> {
    let word = analysis.slice(token.span);
    let kind = match token.role {
        Role::Let | Role::Repeat | Role::Kind => SemanticKind::Keyword,
        Role::Field => SemanticKind::Property,
        Role::Defined => SemanticKind::Variable,
        Role::ObjectName => SemanticKind::Class,
        Role::Function => SemanticKind::Function,
        Role::Method => SemanticKind::EnumMember,
        Role::Name if css::color(word).is_some() || is_constant(word) => SemanticKind::EnumMember,
        Role::Name if schema::function(word).is_some() => SemanticKind::Function,
        Role::Name => SemanticKind::Variable,
        Role::Number | Role::ColorCode => SemanticKind::Number,
        Role::Operator => SemanticKind::Operator,
        Role::Other => return None,
    };
    Some(SemanticToken {
        span: token.span,
        kind,
        is_declaration: token.role == Role::Defined,
    })
}

fn is_constant(word: &str) -> bool {
    schema::CONSTANTS.iter().any(|&(name, ..)| name == word)
}
