//! The words and signs of a text, each with what it is by its place.
//!
//! In: a text. Out: its tokens in order, and what could stand at any place of it. A tree says more of a text that is right;
//! this says something of every text, also of the half of a field that is being typed. Both agree on texts without mistakes
//! of syntax, which a test holds them to.

use std::collections::HashSet;

use crate::{
    scene::{
        css,
        schema::{self, Type},
    },
    source::{SourceId, Span},
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
    /// The name that a `let` defines.
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
    /// `+ - * /`
    Operator,
    /// `=`
    Equals,
    /// `{`
    Open,
    /// `}`
    Close,
    /// `(`
    OpenList,
    /// `)`
    CloseList,
    /// `,`
    Comma,
    /// Nothing of the language.
    Other,
}

/// What could stand at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// `let`, or a block.
    Item,
    /// The name of a new `let`, or what follows it.
    Definition,
    /// The name of an object, or `{`.
    Head,
    /// A field of the block, or whatever else goes on behind a value.
    Field,
    /// A value, or a part of one.
    Value,
}

/// A place in a text, with what stands around it.
#[derive(Clone, Debug)]
pub struct Situation {
    /// What could stand here.
    pub expected: Expected,
    /// The block around it, if its kind is known.
    pub block: Option<&'static schema::Block>,
    /// The fields that are given in that block, the word at the place excepted.
    pub given: Vec<&'static str>,
    /// The field whose value it is.
    pub field: Option<&'static schema::Field>,
    /// The type that would fit, if it is known.
    pub wanted: Option<Type>,
    /// The functions that are being called, the innermost last: the place of the name, and how many commas stand before.
    pub calls: Vec<(Span, usize)>,
    /// The name that is being defined: it cannot use itself.
    pub defining: Option<Span>,
    /// Whether it is within parentheses.
    pub is_nested: bool,
    /// The word that is being typed, or nothing.
    pub word: Span,
    /// What stands behind the word.
    pub next: Option<Token>,
}

/// The tokens of a text.
pub fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = scan(text);
    let lets = defined_names(text, &tokens);
    let mut reader = Reader::new(text, &lets);
    for index in 0..tokens.len() {
        let role = reader.step(&tokens, index);
        if let Some(token) = tokens.get_mut(index) {
            token.role = role;
        }
    }
    tokens
}

/// What could stand at a place, where a word is being typed or none yet; none within comments and numbers.
pub fn situation(text: &str, tokens: &[Token], comments: &[Span], at: usize) -> Option<Situation> {
    if is_in_comment(text, comments, at) {
        return None;
    }
    let lets = defined_names(text, tokens);
    let mut tokens = tokens.to_vec();
    let index = tokens.partition_point(|token| token.span.end < at);
    let word = match tokens.get(index) {
        Some(token) if token.span.start < at && is_word(text, *token) => token.span,
        Some(token) if token.span.start < at && at < token.span.end => return None,
        Some(token) if is_literal(*token) && token.span.end == at => return None,
        _ => file(at, at),
    };
    let index = match word.range().is_empty() {
        // Behind the token that ends here.
        true => {
            let index = tokens.partition_point(|token| token.span.end <= at);
            let empty = Token {
                span: word,
                role: Role::Name,
            };
            tokens.insert(index, empty);
            index
        }
        false => index,
    };
    let mut reader = Reader::new(text, &lets);
    for before in 0..index {
        reader.step(&tokens, before);
    }
    let mut expected = reader.expected(&tokens, index);
    let placed = tokens.get(index).copied();
    if expected == Expected::Value
        && reader.after_value
        && placed.is_some_and(|token| reader.is_on_new_line(token))
    {
        // A list that was not closed in the line before: what comes next is no value.
        expected = match reader.in_block {
            true => Expected::Field,
            false => Expected::Item,
        };
    }
    let mut situation = Situation {
        expected,
        block: reader.row,
        given: reader.given.clone(),
        field: reader.field.filter(|_| expected == Expected::Value),
        wanted: reader.wanted(expected),
        calls: reader.calls(),
        defining: reader.defining,
        is_nested: !reader.lists.is_empty(),
        word,
        next: tokens.get(index + 1).copied(),
    };
    // What is given behind the place, in the same block.
    reader.step(&tokens, index);
    let mut later = Vec::new();
    let depth = reader.blocks;
    for after in index + 1..tokens.len() {
        let role = reader.step(&tokens, after);
        if role == Role::Close || reader.blocks != depth {
            break;
        }
        let token = tokens.get(after).filter(|_| role == Role::Field);
        let name = token.map(|token| slice(text, token.span));
        later.extend(name.and_then(|name| Some(situation.block?.field(name)?.name)));
    }
    situation.given.extend(later);
    Some(situation)
}

/// A place in the file.
pub fn file(start: usize, end: usize) -> Span {
    Span::new(SourceId::File, start, end)
}

fn is_in_comment(text: &str, comments: &[Span], at: usize) -> bool {
    let next = comments.partition_point(|comment| comment.end < at);
    comments.get(next).is_some_and(|comment| {
        // Behind `*/` the comment is over; a comment to the end of the line is not over before it.
        let is_closed = comment.end == at && slice(text, *comment).ends_with("*/");
        comment.start < at && !is_closed
    })
}

fn slice(text: &str, span: Span) -> &str {
    text.get(span.range()).unwrap_or_default()
}

fn is_word(text: &str, token: Token) -> bool {
    slice(text, token.span).starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
}

fn is_literal(token: Token) -> bool {
    matches!(token.role, Role::Number | Role::ColorCode)
}

/// The names that stand behind a `let`, wherever.
fn defined_names<'t>(text: &'t str, tokens: &[Token]) -> HashSet<&'t str> {
    let pairs = tokens.iter().zip(tokens.iter().skip(1));
    let lets = pairs.filter(|(first, _)| slice(text, first.span) == "let");
    lets.map(|(_, name)| slice(text, name.span)).collect()
}

/// The tokens without their roles, as far as those follow from places.
fn scan(text: &str) -> Vec<Token> {
    let bytes = text.as_bytes();
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let rest = bytes.get(at..).unwrap_or_default();
        let run = |of: fn(&u8) -> bool| rest.iter().take_while(|byte| of(byte)).count();
        let (length, role) = match byte {
            b' ' | b'\t' | b'\r' | b'\n' => (run(u8::is_ascii_whitespace).max(1), None),
            b'/' if rest.starts_with(b"//") => (run(|byte| *byte != b'\n'), None),
            b'/' if rest.starts_with(b"/*") => {
                let inner = text.get(at + 2..).unwrap_or_default();
                (inner.find("*/").map_or(rest.len(), |end| end + 4), None)
            }
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => (run(is_word_byte), Some(Role::Name)),
            b'0'..=b'9' => (number_length(rest), Some(Role::Number)),
            b'.' if rest.get(1).is_some_and(u8::is_ascii_digit) => {
                (number_length(rest), Some(Role::Number))
            }
            b'#' => {
                let digits = rest.iter().skip(1);
                let count = digits
                    .take_while(|byte| byte.is_ascii_alphanumeric())
                    .count();
                (1 + count, Some(Role::ColorCode))
            }
            b'"' | b'\'' => {
                let inner = rest.iter().skip(1);
                let count = inner
                    .take_while(|b| !matches!(**b, b'\n') && **b != byte)
                    .count();
                let is_closed = rest.get(1 + count) == Some(&byte);
                (1 + count + usize::from(is_closed), Some(Role::Other))
            }
            b'+' | b'-' | b'*' | b'/' => (1, Some(Role::Operator)),
            b'=' => (1, Some(Role::Equals)),
            b'{' => (1, Some(Role::Open)),
            b'}' => (1, Some(Role::Close)),
            b'(' => (1, Some(Role::OpenList)),
            b')' => (1, Some(Role::CloseList)),
            b',' => (1, Some(Role::Comma)),
            _ => {
                let character = text.get(at..).and_then(|rest| rest.chars().next());
                let length = character.map_or(1, char::len_utf8);
                let is_blank = character.is_some_and(|c| c.is_whitespace() || c == '\u{feff}');
                (length, Some(Role::Other).filter(|_| !is_blank))
            }
        };
        let span = file(at, at + length);
        tokens.extend(role.map(|role| Token { span, role }));
        at += length;
    }
    tokens
}

fn is_word_byte(byte: &u8) -> bool {
    byte.is_ascii_alphanumeric() || *byte == b'_'
}

/// A number with its unit; the sign of an exponent belongs to it.
fn number_length(rest: &[u8]) -> usize {
    let run = |from: usize| {
        let rest = rest.iter().skip(from);
        rest.take_while(|byte| is_word_byte(byte) || **byte == b'.')
            .count()
    };
    let length = run(0);
    let is_exponent = matches!(rest.get(length.saturating_sub(1)), Some(b'e' | b'E'))
        && matches!(rest.get(length), Some(b'+' | b'-'))
        && rest.get(length + 1).is_some_and(u8::is_ascii_digit);
    match is_exponent {
        true => length + 1 + run(length + 1),
        false => length,
    }
}

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
struct Reader<'t> {
    text: &'t str,
    /// The names that are defined somewhere: they are values where a field could stand.
    lets: &'t HashSet<&'t str>,
    state: State,
    /// Whether an operand is complete, so that an operator or something new follows.
    after_value: bool,
    /// Whether a block is open.
    in_block: bool,
    /// Blocks that were begun.
    blocks: usize,
    row: Option<&'static schema::Block>,
    given: Vec<&'static str>,
    field: Option<&'static schema::Field>,
    /// For each open parenthesis the function before it, and the commas in it.
    lists: Vec<(Option<Span>, usize)>,
    /// The name of the last `let`.
    defining: Option<Span>,
    last: Option<Token>,
}

impl<'t> Reader<'t> {
    fn new(text: &'t str, lets: &'t HashSet<&'t str>) -> Self {
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
    fn step(&mut self, tokens: &[Token], index: usize) -> Role {
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
    fn expected(&self, tokens: &[Token], index: usize) -> Expected {
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
                let is_field = self.row.is_some_and(|row| row.field(word).is_some());
                is_field && !is_value && !is_method
            }
            false => self.is_on_new_line(token) && schema::block(word).is_some() && !is_value,
        }
    }

    /// Whether a word starts `KIND {` or `KIND NAME {`.
    fn is_head(&self, tokens: &[Token], index: usize) -> bool {
        let mut next = tokens.iter().skip(index + 1);
        match next.next() {
            Some(token) if token.role == Role::Open => true,
            Some(token) if is_word(self.text, *token) => {
                next.next().is_some_and(|token| token.role == Role::Open)
            }
            _ => false,
        }
    }

    fn last_is(&self, role: Role) -> bool {
        self.last.is_some_and(|last| last.role == role)
    }

    fn is_on_new_line(&self, token: Token) -> bool {
        let start = self.last.map_or(0, |last| last.span.end);
        let between = self.text.get(start..token.span.start).unwrap_or_default();
        between.contains('\n')
    }

    /// The type that would fit in the innermost list.
    fn wanted(&self, expected: Expected) -> Option<Type> {
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

    fn calls(&self) -> Vec<(Span, usize)> {
        let calls = self.lists.iter();
        calls
            .filter_map(|&(function, commas)| Some((function?, commas)))
            .collect()
    }
}
