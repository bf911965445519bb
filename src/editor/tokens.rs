//! Splits a text into words, numbers and signs, and determines the role of each.
//!
//! In: a text and its syntax tree. Out: the lexer's tokens in order. The role of a word follows
//! from its place in the tree; a word that is not in the tree has the role [`Role::Other`].

use crate::{
    scene::SemanticModel,
    schema::{self, Type},
    source::{SourceId, Span},
    syntax::{
        tokens::{Lexer, TokenKind},
        tree::{Block, Item, Value, ValueKind},
    },
};

/// A word, number or sign of a text, with its role.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RoleToken {
    /// Span of the token in the text.
    pub span: Span,
    /// What the token is for, such as the name of a field.
    pub role: Role,
}

/// Role of a word, number or sign in the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Role {
    /// The keyword `let`.
    Let,
    /// The keyword `for` of a repeated block.
    Repeat,
    /// A name in its own definition: the name of a `let` or a `for` index.
    Defined,
    /// The keyword of a block.
    Kind,
    /// The name of an object.
    ObjectName,
    /// The name of a field.
    Field,
    /// A name that is used as a value, e.g. the name of a `let`, a `for` index, a colour or a
    /// constant.
    Name,
    /// A function's name before its `(`.
    Function,
    /// The name of a sampling method.
    Method,
    /// A number, with its unit.
    Number,
    /// A colour code: `#rgb` or `#rrggbb`.
    ColorCode,
    /// One of the signs `+ - * / = <`.
    Operator,
    /// Any other text: a brace, a comma, or a word that is not in the tree.
    Other,
}

/// Returns the span of the bytes `start..end` of the scene file.
pub fn file(start: usize, end: usize) -> Span {
    Span::new(SourceId::File, start, end)
}

/// Returns the tokens of a text with their roles, without comments.
pub fn tokens(model: &SemanticModel<'_>) -> Vec<RoleToken> {
    let text = model.sources().file.text();
    let mut roles = Roles(scanned(text, &model.parsed.comments));
    for item in &model.parsed.tree.items {
        match item {
            Item::Definition(definition) => {
                roles.set(definition.keyword, Role::Let);
                if let Some(name) = definition.name {
                    roles.set(name.span, Role::Defined);
                }
                roles.value(&definition.value, None);
            }
            Item::Block(block) => roles.block(block),
            Item::Bad(_) => {}
        }
    }
    roles.0
}

/// Returns the tokens outside of `comments`. They have the roles that the lexer can tell without
/// the syntax tree: number, colour code, operator, or other.
fn scanned(text: &str, comments: &[Span]) -> Vec<RoleToken> {
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let mut comments = comments.iter().peekable();
    let mut lexer = Lexer::new(text, 0);
    loop {
        let token = lexer.token();
        // Comments are skipped. The parser also recognizes comments of other languages, such as
        // `--`, so a comment may start with any token.
        if let Some(comment) = comments.next_if(|comment| comment.start <= token.start)
            && comment.end > token.start
        {
            lexer = Lexer::new(text, comment.end);
            continue;
        }
        let role = match token.kind {
            TokenKind::Number => Role::Number,
            TokenKind::Color => Role::ColorCode,
            TokenKind::Sign => match text.get(token.start..token.end) {
                Some("+" | "-" | "*" | "/" | "=" | "<") => Role::Operator,
                _ => Role::Other,
            },
            TokenKind::Name | TokenKind::Quoted | TokenKind::Word => Role::Other,
            TokenKind::Comment | TokenKind::OddSpace => continue,
            TokenKind::End => return tokens,
        };
        let span = file(token.start, token.end);
        tokens.push(RoleToken { span, role });
    }
}

/// The tokens of a text, while their roles are set from the syntax tree.
struct Roles(Vec<RoleToken>);

impl Roles {
    /// Sets the role of the token with the span `span`. Does nothing if there is no such token.
    fn set(&mut self, span: Span, role: Role) {
        let index = self.0.partition_point(|it| it.span.start < span.start);
        let token = self.0.get_mut(index);
        if let Some(token) = token.filter(|token| token.span == span) {
            token.role = role;
        }
    }

    fn block(&mut self, block: &Block<'_>) {
        if let Some(kind) = block.kind {
            self.set(kind.span, Role::Kind);
        }
        if let Some(name) = block.name {
            self.set(name.span, Role::ObjectName);
        }
        if let Some(repetition) = &block.repetition {
            self.set(repetition.keyword, Role::Repeat);
            for index in &repetition.indices {
                self.set(index.name.span, Role::Defined);
                self.value(&index.count, None);
            }
        }
        let row = block.kind.and_then(|kind| schema::block(kind.text));
        for field in &block.fields {
            self.set(field.name.span, Role::Field);
            let known = row.and_then(|row| row.field(field.name.text));
            self.value(&field.value, known.map(|known| known.takes));
        }
    }

    fn value(&mut self, value: &Value<'_>, takes: Option<Type>) {
        match &value.kind {
            ValueKind::Name(_) if takes == Some(Type::Method) => self.set(value.span, Role::Method),
            ValueKind::Name(_) => self.set(value.span, Role::Name),
            ValueKind::Call(call) => {
                let is_known = schema::function(call.function.text).is_some();
                let role = if is_known { Role::Function } else { Role::Name };
                self.set(call.function.span, role);
            }
            _ => {}
        }
        for part in value.parts() {
            self.value(part, None);
        }
    }
}
