//! A text with everything that the answers are made from.

use std::cell::OnceCell;

use super::tokens::{self, Token};
use crate::{
    diagnostic::Diagnostic,
    scene::{self, Parts, Scene, SemanticModel},
    schema::{self, Value},
    source::{Source, SourceId, Sources, Span},
    syntax::tree::{self, Block, Definition, Field, Item},
};

/// A text with its tokens, its tree, and what it means. Making one takes a few milliseconds for a
/// thousand objects, so that nobody has to keep it.
#[derive(Debug)]
pub struct Analysis<'s> {
    /// What is known of it.
    pub model: SemanticModel<'s>,
    /// Read when they are asked for: neither a picture nor a list of problems needs them.
    tokens: OnceCell<Vec<Token>>,
}

/// What stands at a place of the tree, from the whole to the smallest part.
#[derive(Debug, Default)]
pub(super) struct Path<'a, 's> {
    /// The definition.
    pub definition: Option<&'a Definition<'s>>,
    /// The block.
    pub block: Option<&'a Block<'s>>,
    /// The field in it.
    pub field: Option<&'a Field<'s>>,
    /// The values, each a part of the one before it.
    pub values: Vec<&'a tree::Value<'s>>,
}

impl<'s> Analysis<'s> {
    /// Reads a text.
    pub fn new(sources: &'s Sources) -> Self {
        Self {
            model: scene::analyze(sources),
            tokens: OnceCell::new(),
        }
    }

    /// The words and signs, by their places.
    pub fn tokens(&self) -> &[Token] {
        self.tokens.get_or_init(|| tokens::tokens(&self.model))
    }

    /// The file.
    pub fn source(&self) -> &'s Source {
        &self.model.sources().file
    }

    /// The text.
    pub fn text(&self) -> &'s str {
        self.source().text()
    }

    /// The text under a span.
    pub fn slice(&self, span: Span) -> &'s str {
        self.source().slice(span.range())
    }

    /// What is wrong with it: the same list as everywhere.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.model.diagnostics
    }

    /// What it means; none where it has errors.
    pub fn scene(&self) -> Option<Scene> {
        let has_errors = self.diagnostics().iter().any(Diagnostic::is_error);
        let parts = (!has_errors).then(|| self.model.parts.clone());
        parts.and_then(Parts::into_scene)
    }

    /// The comments.
    pub fn comments(&self) -> &[Span] {
        &self.model.parsed.comments
    }

    /// The items of the tree.
    pub(super) fn items(&self) -> &[Item<'s>] {
        &self.model.parsed.tree.items
    }

    /// The blocks of the tree.
    pub(super) fn blocks(&self) -> impl Iterator<Item = &Block<'s>> {
        self.items().iter().filter_map(|item| match item {
            Item::Block(block) => Some(block),
            Item::Definition(_) | Item::Bad(_) => None,
        })
    }

    /// The word, number or sign that a place touches: of two that meet there a word before a sign,
    /// and the one behind it before the one that ends there.
    pub(super) fn token_at(&self, at: usize) -> Option<Token> {
        let index = self.tokens().partition_point(|token| token.span.end < at);
        let touching = self.tokens().iter().skip(index);
        let touching = touching.take_while(|token| token.span.start <= at);
        let touching: Vec<Token> = touching.copied().collect();
        let behind = touching.iter().rev();
        let is_sign = |token: &&Token| !self.starts_with_letter(token.span);
        let word = behind.clone().find(|token| !is_sign(token));
        word.or_else(|| behind.clone().next()).copied()
    }

    fn starts_with_letter(&self, span: Span) -> bool {
        let text = self.slice(span);
        text.starts_with(|c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '#' | '.'))
    }

    /// What stands at a place of the tree.
    pub(super) fn path(&self, at: usize) -> Path<'_, 's> {
        Path::new(self.items(), at)
    }

    /// What a value of a definition or a field is.
    pub(super) fn value(&self, value: &tree::Value<'s>, path: &Path<'_, 's>) -> Option<Value> {
        let takes = path.row().and_then(|row| row.field(path.field?.name.text));
        self.model.value(value, takes.map(|field| field.takes))
    }

    /// The line of a span, counted from 1.
    pub(super) fn line(&self, span: Span) -> usize {
        self.source().line(span.start)
    }
}

impl<'a, 's> Path<'a, 's> {
    /// What stands at a place of a tree.
    pub fn new(items: &'a [Item<'s>], at: usize) -> Self {
        let mut path = Self::default();
        let first = items.partition_point(|item| item.span().end < at);
        for item in items.iter().skip(first) {
            let span = item.span();
            if span.start <= at {
                path = item_at(item, at);
                // Where two items meet, the one behind the place counts.
                if at < span.end {
                    break;
                }
            } else if matches!(item, Item::Block(_)) {
                // Definitions within a block come before it.
                break;
            }
        }
        path
    }

    /// The row of the block's kind.
    pub fn row(&self) -> Option<&'static schema::Block> {
        schema::block(self.block?.kind?.text)
    }

    /// The row of the field.
    pub fn field_row(&self) -> Option<&'static schema::Field> {
        self.row()?.field(self.field?.name.text)
    }
}

fn item_at<'a, 's>(item: &'a Item<'s>, at: usize) -> Path<'a, 's> {
    match item {
        Item::Definition(definition) => Path {
            definition: Some(definition),
            values: values_at(&definition.value, at),
            ..Path::default()
        },
        Item::Block(block) => {
            let mut fields = block.fields.iter().rev();
            let field = fields.find(|field| field.span.start <= at && at <= field.span.end);
            Path {
                block: Some(block),
                field,
                values: field
                    .map(|field| values_at(&field.value, at))
                    .unwrap_or_default(),
                ..Path::default()
            }
        }
        Item::Bad(_) => Path::default(),
    }
}

/// A value and those parts of it that hold a place, from the whole to the smallest one.
fn values_at<'a, 's>(value: &'a tree::Value<'s>, at: usize) -> Vec<&'a tree::Value<'s>> {
    let mut values = Vec::new();
    let mut next = Some(value);
    while let Some(value) = next.filter(|value| holds(value, at)) {
        values.push(value);
        // Where two parts meet, the one behind the place counts.
        next = value.parts().into_iter().rev().find(|part| holds(part, at));
    }
    values
}

fn holds(value: &tree::Value<'_>, at: usize) -> bool {
    value.span.source == SourceId::File && value.span.start <= at && at <= value.span.end
}
