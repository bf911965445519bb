//! The words and signs of a text, each with what it is.
//!
//! In: a text and its tree. Out: the lexer's tokens in order. What a word is, the tree says; one
//! that the tree does not hold is nothing of the language.

use crate::{
    scene::SemanticModel,
    schema::{self, Type},
    source::{SourceId, Span},
    syntax::{
        tokens::{Lexer, TokenKind},
        tree::{Block, Item, Value, ValueKind},
    },
};

/// A word or sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// Its place.
    pub span: Span,
    /// What it is.
    pub role: Role,
}

/// What a word or sign is by its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// `let`
    Let,
    /// `for`
    Repeat,
    /// The name that a `let` defines, or a head's index.
    Defined,
    /// The word that a block starts with.
    Kind,
    /// The name of an object.
    ObjectName,
    /// The name of a field.
    Field,
    /// A name that is a value: of a `let`, a colour, a constant.
    Name,
    /// The name of a function, with its `(` after it.
    Function,
    /// The word of a sampling method.
    Method,
    /// A number, with its unit.
    Number,
    /// `#rgb` or `#rrggbb`.
    ColorCode,
    /// `+ - * / = <`
    Operator,
    /// Anything else: a brace, a comma, or nothing of the language.
    Other,
}

/// A place in the file.
pub fn file(start: usize, end: usize) -> Span {
    Span::new(SourceId::File, start, end)
}

/// The tokens of a text. None reaches into a comment.
pub fn tokens(model: &SemanticModel<'_>) -> Vec<Token> {
    let text = model.sources().file.text();
    let mut roles = Roles(scanned(text, &model.parsed.comments));
    for item in &model.parsed.tree.items {
        match item {
            Item::Definition(definition) => {
                roles.is(definition.keyword, Role::Let);
                if let Some(name) = definition.name {
                    roles.is(name.span, Role::Defined);
                }
                roles.value(&definition.value, None);
            }
            Item::Block(block) => roles.block(block),
            Item::Bad(_) => {}
        }
    }
    roles.0
}

/// The tokens with the roles that they have wherever they stand.
fn scanned(text: &str, comments: &[Span]) -> Vec<Token> {
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let mut comments = comments.iter().peekable();
    let mut lexer = Lexer::new(text, 0);
    loop {
        let token = lexer.token();
        // What recovery took for a comment need not begin as one.
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
        tokens.push(Token { span, role });
    }
}

/// Tokens that the tree gives their roles.
struct Roles(Vec<Token>);

impl Roles {
    fn is(&mut self, span: Span, role: Role) {
        let index = self.0.partition_point(|it| it.span.start < span.start);
        let token = self.0.get_mut(index);
        if let Some(token) = token.filter(|token| token.span == span) {
            token.role = role;
        }
    }

    fn block(&mut self, block: &Block<'_>) {
        if let Some(kind) = block.kind {
            self.is(kind.span, Role::Kind);
        }
        if let Some(name) = block.name {
            self.is(name.span, Role::ObjectName);
        }
        if let Some(repetition) = &block.repetition {
            self.is(repetition.keyword, Role::Repeat);
            for index in &repetition.indices {
                self.is(index.name.span, Role::Defined);
                self.value(&index.count, None);
            }
        }
        let row = block.kind.and_then(|kind| schema::block(kind.text));
        for field in &block.fields {
            self.is(field.name.span, Role::Field);
            let known = row.and_then(|row| row.field(field.name.text));
            self.value(&field.value, known.map(|known| known.takes));
        }
    }

    fn value(&mut self, value: &Value<'_>, takes: Option<Type>) {
        match &value.kind {
            ValueKind::Name(_) if takes == Some(Type::Method) => self.is(value.span, Role::Method),
            ValueKind::Name(_) => self.is(value.span, Role::Name),
            ValueKind::Call(call) => {
                let is_known = schema::function(call.function.text).is_some();
                let role = if is_known { Role::Function } else { Role::Name };
                self.is(call.function.span, role);
            }
            _ => {}
        }
        for part in value.parts() {
            self.value(part, None);
        }
    }
}
