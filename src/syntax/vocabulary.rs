//! The known words by which recovery tells what was meant.
//!
//! The grammar takes any name for a field, a kind or a value. What a text says that does not follow
//! it can only be told by which of them are known: in `radius color olive` a value is missing. They
//! are looked up in the schema and among the names that the text defines.

use std::{collections::HashMap, sync::OnceLock};

use super::{
    tokens::{Lexer, TokenKind, numeric_part},
    tree::{Field, ValueKind},
};
use crate::schema::{self, Condition, Type, predefined};

/// Functions of other languages that stand for a vector or a colour.
const FOREIGN_FUNCTIONS: &str = "vec vec3 Vec3 vector Vector vector3 Vector3 Vector3D point Point point3 Point3 Point3D rgba color Color";

/// The words of the language and of a text.
#[derive(Debug)]
pub struct Vocabulary<'s> {
    text: &'s str,
    /// The names behind every `let`, once somebody asks.
    lets: OnceLock<HashMap<&'s str, bool>>,
}

impl<'s> Vocabulary<'s> {
    /// Those of a text.
    pub fn new(text: &'s str) -> Self {
        Self {
            text,
            lets: OnceLock::new(),
        }
    }

    /// Whether a block can start with a word.
    pub fn is_kind(&self, word: &str) -> bool {
        schema::block(word).is_some()
    }

    /// What a field of a block takes; a mistyped kind is the nearest one.
    pub fn takes(&self, kind: &str, field: &str) -> Option<Type> {
        let row = schema::block_or_nearest(kind)?;
        row.field(field).map(|field| field.takes)
    }

    /// Whether a field takes a whole number.
    pub fn is_whole(&self, kind: &str, field: &str) -> bool {
        let row = schema::block(kind).and_then(|row| row.field(field));
        row.is_some_and(|row| row.must.contains(&Condition::Whole))
    }

    /// Whether all parts of what a field takes are more than 0.
    pub fn is_positive(&self, kind: &str, field: &str) -> bool {
        let row = schema::block(kind).and_then(|row| row.field(field));
        row.is_some_and(|row| row.must.contains(&Condition::EachMoreThanZero))
    }

    /// The names of a block's fields; of the nearest block, if it is mistyped.
    pub fn fields(&self, kind: &str) -> impl Iterator<Item = &'static str> + use<> {
        let row = schema::block_or_nearest(kind);
        row.into_iter().flat_map(|row| row.field_names())
    }

    /// Whether a name is defined somewhere in the text.
    pub fn is_let(&self, name: &str) -> bool {
        self.lets().contains_key(name)
    }

    /// The names behind every `let`, each with whether its value starts with a plain number, and
    /// those of the indices.
    fn lets(&self) -> &HashMap<&'s str, bool> {
        self.lets.get_or_init(|| {
            let mut lets = HashMap::new();
            let mut lexer = Lexer::new(self.text, 0);
            // The last three tokens but comments.
            let mut last = ["", "", ""];
            loop {
                let token = lexer.token();
                let word = self.text.get(token.start..token.end).unwrap_or_default();
                match (token.kind, last) {
                    (TokenKind::End, _) => return lets,
                    (TokenKind::Comment, _) => continue,
                    (TokenKind::Name, [.., "let"]) if word != "let" => {
                        lets.entry(word).or_insert(false);
                    }
                    (TokenKind::Sign, [_, "for" | ",", index]) if word == "<" => {
                        lets.entry(index).or_insert(true);
                    }
                    (TokenKind::Number, ["let", name, "="]) => {
                        lets.insert(name, numeric_part(word) == word);
                    }
                    _ => {}
                }
                let [_, second, third] = last;
                last = [second, third, word];
            }
        })
    }

    /// Whether a name stands for a value: one that is defined, a colour, a unit, pi or a function.
    pub fn is_value(&self, name: &str) -> bool {
        predefined(name).is_some() || self.is_let(name)
    }

    /// Whether a name is that of a colour.
    pub fn is_color(&self, name: &str) -> bool {
        schema::css::color(name).is_some()
    }

    /// Whether a name is surely that of a number: pi, or one that is defined so.
    pub fn is_factor(&self, name: &str) -> bool {
        name == "pi" || self.lets().get(name).copied().unwrap_or(false)
    }

    /// Whether a function of another language stands for a vector or a colour.
    pub fn is_foreign_function(&self, name: &str) -> bool {
        FOREIGN_FUNCTIONS.split(' ').any(|word| word == name) && !self.is_let(name)
    }

    /// Whether a field that follows the grammar may have been meant otherwise: its block does not
    /// know it, its value is the name of a field, or it takes a word and has something else.
    pub fn is_doubtful(&self, kind: &str, field: &Field<'_>) -> bool {
        let row = schema::block_or_nearest(kind);
        let takes = row.and_then(|row| Some(row.field(field.name.text)?.takes));
        let (Some(row), Some(takes)) = (row, takes) else {
            return true;
        };
        match &field.value.kind {
            ValueKind::Name(name) => {
                takes != Type::Method && row.field(name).is_some() && !self.is_value(name)
            }
            ValueKind::Call(call) => {
                row.field(call.function.text).is_some() && !self.is_value(call.function.text)
            }
            _ => takes == Type::Method,
        }
    }
}
