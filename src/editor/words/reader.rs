//! What each word is by the words before it, and what could come next.

use std::collections::HashSet;

use super::{Expected, Role, Token, is_literal, is_word, slice};
use crate::{
    scene::{
        css,
        schema::{self, Type},
    },
    source::Span,
};

/// What is being read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Items,
    /// Behind `let`.
    Let,
    /// Behind `let NAME`.
    LetName,
    /// Behind `let NAME =`, or a part of the value.
    LetValue,
    /// Behind a block's kind, or its name.
    Head,
    /// In a block, before the first field.
    Fields,
    /// Behind a field's name, or a part of its value.
    FieldValue,
}

/// Reads token by token, and knows what comes next.
pub struct Reader<'t> {
    text: &'t str,
    /// The names that are defined somewhere: they are values where a field could stand.
    lets: &'t HashSet<&'t str>,
    state: State,
    /// Whether an operand is complete, so that an operator or something new follows.
    pub after_value: bool,
    /// Whether a block is open.
    pub in_block: bool,
    /// Blocks that were begun.
    pub blocks: usize,
    pub row: Option<&'static schema::Block>,
    pub given: Vec<&'static str>,
    pub field: Option<&'static schema::Field>,
    /// For each open parenthesis the function before it, and the commas in it.
    pub lists: Vec<(Option<Span>, usize)>,
    /// The name of the last `let`.
    pub defining: Option<Span>,
    pub last: Option<Token>,
}

impl<'t> Reader<'t> {
    pub fn new(text: &'t str, lets: &'t HashSet<&'t str>) -> Self {
        Self {
            text,
            lets,
            state: State::Items,
            after_value: false,
            in_block: false,
            blocks: 0,
            row: None,
            given: Vec::new(),
            field: None,
            lists: Vec::new(),
            defining: None,
            last: None,
        }
    }

    /// Takes the next token, and says what it is.
    pub fn step(&mut self, tokens: &[Token], index: usize) -> Role {
        let Some(&token) = tokens.get(index) else {
            return Role::Other;
        };
        let is_empty = token.span.range().is_empty();
        let role = match is_empty || is_word(self.text, token) {
            true => self.word(tokens, index, token),
            false => self.sign(token),
        };
        self.last = Some(Token { role, ..token });
        role
    }

    /// What could stand in the place of a word.
    pub fn expected(&self, tokens: &[Token], index: usize) -> Expected {
        match self.state {
            State::Items => Expected::Item,
            State::Let | State::LetName => Expected::Definition,
            State::Head => Expected::Head,
            State::Fields => Expected::Field,
            State::LetValue | State::FieldValue if !self.after_value || !self.lists.is_empty() => {
                match self.starts_anew(tokens, index) {
                    true if self.in_block => Expected::Field,
                    true => Expected::Item,
                    false => Expected::Value,
                }
            }
            State::LetValue if !self.in_block => Expected::Item,
            State::LetValue | State::FieldValue => Expected::Field,
        }
    }

    fn word(&mut self, tokens: &[Token], index: usize, token: Token) -> Role {
        let word = slice(self.text, token.span);
        if word == "let" {
            self.lists.clear();
            self.state = State::Let;
            return Role::Let;
        }
        let is_head = self.is_head(tokens, index);
        let is_open = !self.in_block && self.expected(tokens, index) != Expected::Value;
        if is_head && (is_open || schema::block(word).is_some()) {
            let is_name = self.state == State::Head && self.last_is(Role::Kind);
            let next_line = self.is_on_new_line(token);
            if !(is_name && !(next_line && schema::block(word).is_some())) {
                return self.kind(word);
            }
        }
        match self.expected(tokens, index) {
            Expected::Item => self.kind(word),
            Expected::Definition if self.state == State::Let => {
                self.state = State::LetName;
                self.defining = Some(token.span);
                Role::Defined
            }
            Expected::Head if self.last_is(Role::Kind) => {
                let next_block = schema::block(word).is_some() && self.is_on_new_line(token);
                match next_block {
                    true => self.kind(word),
                    false => Role::ObjectName,
                }
            }
            Expected::Head => self.kind(word),
            Expected::Field => {
                self.lists.clear();
                self.state = State::FieldValue;
                self.after_value = false;
                self.field = self.row.and_then(|row| row.field(word));
                self.given.extend(self.field.map(|field| field.name));
                Role::Field
            }
            Expected::Definition | Expected::Value => {
                if self.state == State::LetName {
                    self.state = State::LetValue;
                }
                self.operand(tokens, index, word)
            }
        }
    }

    fn operand(&mut self, tokens: &[Token], index: usize, word: &str) -> Role {
        self.after_value = true;
        let next = tokens.get(index + 1).map(|next| next.role);
        let is_called = next == Some(Role::OpenList) && schema::function(word).is_some();
        let takes = self.field.filter(|_| self.state == State::FieldValue);
        let takes = takes.map(|field| field.takes);
        match takes {
            Some(Type::Method) => Role::Method,
            _ if is_called => Role::Function,
            _ => Role::Name,
        }
    }

    fn kind(&mut self, word: &str) -> Role {
        self.lists.clear();
        self.state = State::Head;
        self.in_block = false;
        self.blocks += 1;
        self.row = schema::block(word).or_else(|| schema::nearest_block(word));
        self.given.clear();
        self.field = None;
        Role::Kind
    }

    fn sign(&mut self, token: Token) -> Role {
        match token.role {
            Role::Number | Role::ColorCode => self.after_value = true,
            Role::Operator => self.after_value = false,
            Role::Equals => {
                if self.state == State::LetName {
                    self.state = State::LetValue;
                }
                self.after_value = false;
            }
            Role::Open => {
                if self.state != State::Head {
                    self.row = None;
                    self.given.clear();
                    self.blocks += 1;
                }
                self.lists.clear();
                self.state = State::Fields;
                self.in_block = true;
                self.field = None;
            }
            Role::Close => {
                self.lists.clear();
                self.state = State::Items;
                self.in_block = false;
                self.row = None;
                self.given.clear();
                self.field = None;
            }
            Role::OpenList => {
                let function = self.last.filter(|last| last.role == Role::Function);
                self.lists.push((function.map(|function| function.span), 0));
                self.after_value = false;
            }
            Role::CloseList => {
                self.lists.pop();
                self.after_value = true;
            }
            Role::Comma => {
                if let Some((_, commas)) = self.lists.last_mut() {
                    *commas += 1;
                    self.after_value = false;
                }
            }
            _ => {}
        }
        if self.state == State::LetName && is_literal(token) {
            self.state = State::LetValue;
        }
        token.role
    }

    /// Whether a word in the place of a value starts a field, or a block, as the value before it was left out: it is the name of
    /// one, and of nothing else.
    fn starts_anew(&self, tokens: &[Token], index: usize) -> bool {
        let Some(&token) = tokens.get(index) else {
            return false;
        };
        let word = slice(self.text, token.span);
        let is_value = self.lets.contains(word)
            || css::color(word).is_some()
            || schema::function(word).is_some();
        let is_method = self.field.is_some_and(|field| field.takes == Type::Method);
        if !self.lists.is_empty() && !self.is_on_new_line(token) {
            return false;
        }
        match self.in_block {
            true => {
                let field = self.row.and_then(|row| row.field(word));
                let is_field = match field {
                    // `min (0, 0, 0)`: a corner. The least of numbers is no field's whole value in a block with corners.
                    Some(field) if schema::function(word).is_some() => {
                        field.takes == Type::Vector && self.is_vector_next(tokens, index)
                    }
                    Some(_) => !is_value,
                    None => false,
                };
                is_field && !is_method
            }
            false => self.is_on_new_line(token) && schema::block(word).is_some() && !is_value,
        }
    }

    /// Whether a list of three stands behind a word, and no further sign of an expression: the value of a field.
    fn is_vector_next(&self, tokens: &[Token], index: usize) -> bool {
        let mut open = 0_usize;
        let mut commas = 0_usize;
        let mut next = tokens.iter().skip(index + 1);
        for token in next.by_ref() {
            match token.role {
                Role::OpenList => open += 1,
                Role::CloseList => open = open.saturating_sub(1),
                Role::Comma if open == 1 => commas += 1,
                Role::Open | Role::Close => return false,
                _ if open == 0 => return false,
                _ => {}
            }
            if open == 0 {
                break;
            }
        }
        let ends = next
            .next()
            .is_none_or(|token| token.role == Role::Close || is_word(self.text, *token));
        commas == 2 && ends
    }

    /// Whether a word starts `KIND {` or `KIND NAME {`. A value may have the name of a kind, with a block behind it: `box`, and
    /// then `sphere {`.
    fn is_head(&self, tokens: &[Token], index: usize) -> bool {
        let mut next = tokens.iter().skip(index + 1);
        match next.next() {
            Some(token) if token.role == Role::Open => true,
            Some(token) if is_word(self.text, *token) => {
                let word = |token: &Token| slice(self.text, token.span);
                let is_kind = schema::block(word(token)).is_some();
                let is_defined = tokens.get(index).map(word);
                let is_defined = is_defined.is_some_and(|word| self.lets.contains(word));
                let is_value = is_defined && self.expected(tokens, index) == Expected::Value;
                let is_open = next.next().is_some_and(|token| token.role == Role::Open);
                is_open && !(is_kind && is_value)
            }
            _ => false,
        }
    }

    fn last_is(&self, role: Role) -> bool {
        self.last.is_some_and(|last| last.role == role)
    }

    pub fn is_on_new_line(&self, token: Token) -> bool {
        let start = self.last.map_or(0, |last| last.span.end);
        let between = self.text.get(start..token.span.start).unwrap_or_default();
        between.contains('\n')
    }

    /// The type that would fit in the innermost list.
    pub fn wanted(&self, expected: Expected) -> Option<Type> {
        if expected != Expected::Value {
            return None;
        }
        let takes = self.field.filter(|_| self.state == State::FieldValue);
        let takes = takes.map(|field| field.takes);
        let Some((function, commas)) = self.lists.last() else {
            return takes;
        };
        if let Some(function) = function {
            let row = schema::function(slice(self.text, *function))?;
            return row.takes.get(*commas).or(row.takes.last()).copied();
        }
        match takes {
            Some(Type::Colors) => Some(Type::Color),
            // Parentheses around a part of an expression, or those of a vector: both hold numbers most of the time.
            Some(Type::Vector) => Some(Type::Number),
            takes => takes,
        }
    }

    pub fn calls(&self) -> Vec<(Span, usize)> {
        let calls = self.lists.iter();
        calls
            .filter_map(|&(function, commas)| Some((function?, commas)))
            .collect()
    }
}
