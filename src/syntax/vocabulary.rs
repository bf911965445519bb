//! The words that error recovery knows.
//!
//! The grammar accepts any name as a field, a kind or a value. To explain a mistake, error recovery
//! must know which names exist: in `radius color olive`, `color` is a field, so the value of
//! `radius` is missing. Names are looked up in the schema and among the definitions of the text.

use std::{collections::HashMap, sync::OnceLock};

use super::{
    tokens::{Lexer, TokenKind, numeric_part},
    tree::{Field, ValueKind},
};
use crate::schema::{self, Condition, Type, predefined};

/// Functions of other languages that construct a vector, a point or a colour, separated by spaces.
const FOREIGN_FUNCTIONS: &str = "vec vec3 Vec3 vector Vector vector3 Vector3 Vector3D point Point point3 Point3 Point3D rgba color Color";

/// Words of the language, and names that a text defines.
#[derive(Debug)]
pub struct Vocabulary<'s> {
    text: &'s str,
    /// The names that the text defines. A name is mapped to `true` if it probably stands for a
    /// number. The map is computed on first use.
    lets: OnceLock<HashMap<&'s str, bool>>,
}

impl<'s> Vocabulary<'s> {
    /// Makes the vocabulary of a text.
    pub fn new(text: &'s str) -> Self {
        Self {
            text,
            lets: OnceLock::new(),
        }
    }

    /// Returns whether a word is a kind of block.
    pub fn is_kind(&self, word: &str) -> bool {
        schema::block(word).is_some()
    }

    /// Returns the type of the field `field` of the block `kind`. A mistyped `kind` stands for the
    /// nearest kind. Returns `None` if the kind or the field is unknown.
    pub fn takes(&self, kind: &str, field: &str) -> Option<Type> {
        let row = schema::block_or_nearest(kind)?;
        row.field(field).map(|field| field.takes)
    }

    /// Returns whether the values of a field must be whole numbers.
    pub fn is_whole(&self, kind: &str, field: &str) -> bool {
        let row = schema::block(kind).and_then(|row| row.field(field));
        row.is_some_and(|row| row.must.contains(&Condition::Whole))
    }

    /// Returns whether all coordinates of a field's value must be greater than 0.
    pub fn is_positive(&self, kind: &str, field: &str) -> bool {
        let row = schema::block(kind).and_then(|row| row.field(field));
        row.is_some_and(|row| row.must.contains(&Condition::EachMoreThanZero))
    }

    /// Returns the names of the fields of the block `kind`. A mistyped `kind` stands for the
    /// nearest kind.
    pub fn fields(&self, kind: &str) -> impl Iterator<Item = &'static str> + use<> {
        let row = schema::block_or_nearest(kind);
        row.into_iter().flat_map(|row| row.field_names())
    }

    /// Returns whether the text defines a name.
    pub fn is_let(&self, name: &str) -> bool {
        self.lets().contains_key(name)
    }

    /// Returns the names of definitions and indices. A name is mapped to `true` if it probably
    /// stands for a number: it is an index, or its definition starts with a number without a unit.
    fn lets(&self) -> &HashMap<&'s str, bool> {
        self.lets.get_or_init(|| {
            let mut lets = HashMap::new();
            let mut lexer = Lexer::new(self.text, 0);
            // The last three tokens that are not comments. They suffice to recognize a definition
            // or an index.
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

    /// Returns whether a name stands for a value: a defined name, a colour, a unit, pi or a
    /// function.
    pub fn is_value(&self, name: &str) -> bool {
        predefined(name).is_some() || self.is_let(name)
    }

    /// Returns whether a name is that of a colour.
    pub fn is_color(&self, name: &str) -> bool {
        schema::css::color(name).is_some()
    }

    /// Returns whether a name probably stands for a number: it is `pi`, an index, or a name whose
    /// definition starts with a number without a unit.
    pub fn is_factor(&self, name: &str) -> bool {
        name == "pi" || self.lets().get(name).copied().unwrap_or(false)
    }

    /// Returns whether a name is a function of another language that makes a vector or a colour.
    /// Returns `false` for a name that the text defines.
    pub fn is_foreign_function(&self, name: &str) -> bool {
        FOREIGN_FUNCTIONS.split(' ').any(|word| word == name) && !self.is_let(name)
    }

    /// Returns whether a field that follows the grammar was perhaps meant otherwise. This is the
    /// case if blocks of the kind `kind` have no such field, if the value or the function that it
    /// calls has the name of one of their fields, or if the field requires the name of a sampling
    /// method and its value is no name.
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
