//! Analyzes a text: its tree, its meaning and its tokens. All answers to editors use the result.

use std::cell::OnceCell;

use super::tokens::{self, RoleToken};
use crate::{
    diagnostic::Diagnostic,
    scene::{self, Object, Parts, Scene, SemanticModel},
    schema::{self, Value},
    source::{Source, SourceId, Sources, Span},
    syntax::tree::{self, Block, Definition, Field, Index, Item},
};

/// A text with its syntax tree, its meaning and its tokens. Analyzing a scene of a thousand objects
/// takes only a few milliseconds, so every request analyzes the text again.
#[derive(Debug)]
pub struct Analysis<'s> {
    /// The syntax tree, and the meaning: the scene, the values of definitions, and the problems.
    pub model: SemanticModel<'s>,
    /// The tokens. They are computed on first use, because rendering and diagnostics do not need
    /// them.
    tokens: OnceCell<Vec<RoleToken>>,
}

/// Nodes of the syntax tree that contain a given offset of the text: a definition or a block, a
/// field of the block, and values. Each node lies within the one before it.
#[derive(Debug, Default)]
pub(super) struct Path<'a, 's> {
    /// The definition that contains the offset.
    pub definition: Option<&'a Definition<'s>>,
    /// The block that contains the offset.
    pub block: Option<&'a Block<'s>>,
    /// The field of the block that contains the offset.
    pub field: Option<&'a Field<'s>>,
    /// The values that contain the offset, from the largest to the smallest: `1 + x` comes before
    /// its part `1`.
    pub values: Vec<&'a tree::Value<'s>>,
}

impl<'s> Analysis<'s> {
    /// Parses a text and computes its meaning.
    pub fn new(sources: &'s Sources) -> Self {
        Self {
            model: scene::analyze(sources),
            tokens: OnceCell::new(),
        }
    }

    /// Returns the words, numbers and signs in the order of the text, without comments.
    pub fn tokens(&self) -> &[RoleToken] {
        self.tokens.get_or_init(|| tokens::tokens(&self.model))
    }

    /// Returns the analyzed source file.
    pub fn source(&self) -> &'s Source {
        &self.model.sources().file
    }

    /// Returns the analyzed text.
    pub fn text(&self) -> &'s str {
        self.source().text()
    }

    /// Returns the text of a span.
    pub fn slice(&self, span: Span) -> &'s str {
        self.source().slice(span.range())
    }

    /// Returns the problems of the text. The command line reports the same ones.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.model.diagnostics
    }

    /// Returns the scene that the text describes; `None` if the text has errors.
    pub fn scene(&self) -> Option<Scene> {
        let has_errors = self.diagnostics().iter().any(Diagnostic::is_error);
        let parts = (!has_errors).then(|| self.model.parts.clone());
        parts.and_then(Parts::into_scene)
    }

    /// Returns the spans of the comments.
    pub fn comments(&self) -> &[Span] {
        &self.model.parsed.comments
    }

    /// Returns the items of the syntax tree, i.e. the definitions and blocks of the text.
    pub(super) fn items(&self) -> &[Item<'s>] {
        &self.model.parsed.tree.items
    }

    /// Returns the blocks of the tree.
    pub(super) fn blocks(&self) -> impl Iterator<Item = &Block<'s>> {
        self.items().iter().filter_map(|item| match item {
            Item::Block(block) => Some(block),
            Item::Definition(_) | Item::Bad(_) => None,
        })
    }

    /// Returns the word, number or sign at the offset `at`. If two tokens touch at `at`, a word or
    /// a number is preferred to a sign. Otherwise the later token is returned. Returns `None` if no
    /// token touches `at`.
    pub(super) fn token_at(&self, at: usize) -> Option<RoleToken> {
        let index = self.tokens().partition_point(|token| token.span.end < at);
        let touching = self.tokens().iter().skip(index);
        let touching = touching.take_while(|token| token.span.start <= at);
        let touching: Vec<RoleToken> = touching.copied().collect();
        let behind = touching.iter().rev();
        let is_sign = |token: &&RoleToken| !self.starts_with_letter(token.span);
        let word = behind.clone().find(|token| !is_sign(token));
        word.or_else(|| behind.clone().next()).copied()
    }

    fn starts_with_letter(&self, span: Span) -> bool {
        let text = self.slice(span);
        text.starts_with(|c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '#' | '.'))
    }

    /// Returns the nodes of the tree that contain the offset `at`.
    pub(super) fn path(&self, at: usize) -> Path<'_, 's> {
        Path::new(self.items(), at)
    }

    /// Returns the block that contains the offset `at`, and this block's `for` index with the given
    /// name, such as `i` in `for i < 3`. Returns `None` if the block has no such index.
    pub(super) fn index_at(&self, name: &str, at: usize) -> Option<(&Block<'s>, &Index<'s>)> {
        let block = self.path(at).block?;
        let mut indices = block.repetition.iter().flat_map(|it| &it.indices);
        Some((block, indices.find(|index| index.name.text == name)?))
    }

    /// Returns the objects that a block describes. A repeated block describes several objects. A
    /// block with errors, and a block such as `camera`, describes none.
    pub(super) fn objects_of(&self, block: &Block<'_>) -> &[Object] {
        let objects = &self.model.parts.objects;
        let first = objects.partition_point(|it| it.span.start < block.span.start);
        let objects = objects.get(first..).unwrap_or_default();
        let count = objects.partition_point(|it| it.span.start == block.span.start);
        objects.get(..count).unwrap_or_default()
    }

    /// Returns the value of an expression in the field or definition of `path`. Returns `None` if
    /// the expression has errors.
    pub(super) fn value(&self, value: &tree::Value<'s>, path: &Path<'_, 's>) -> Option<Value> {
        let takes = path.row().and_then(|row| row.field(path.field?.name.text));
        self.model.value(value, takes.map(|field| field.takes))
    }

    /// Returns the number of the line in which a span starts, counted from 1.
    pub(super) fn line(&self, span: Span) -> usize {
        self.source().line(span.start)
    }
}

impl<'a, 's> Path<'a, 's> {
    /// Returns the nodes in `items` that contain the offset `at`.
    pub fn new(items: &'a [Item<'s>], at: usize) -> Self {
        let mut path = Self::default();
        let first = items.partition_point(|item| item.span().end < at);
        for item in items.iter().skip(first) {
            let span = item.span();
            if span.start <= at {
                path = item_at(item, at);
                // If two items touch at `at`, the later one is chosen.
                if at < span.end {
                    break;
                }
            } else if matches!(item, Item::Block(_)) {
                // The items are in the order of the text, with one exception: a `let` within a
                // block precedes the block in the list. After such a `let`, the block that contains
                // `at` is still to come. So the search ends only at a block that starts after `at`.
                break;
            }
        }
        path
    }

    /// Returns the language's description of the path's block: its kind and its fields. Returns
    /// `None` if the path contains no block, or one of an unknown kind.
    pub fn row(&self) -> Option<&'static schema::BlockRow> {
        schema::block(self.block?.kind?.text)
    }

    /// Returns the language's description of the path's field, e.g. its type. Returns `None` if the
    /// path contains no field, or an unknown one.
    pub fn field_row(&self) -> Option<&'static schema::FieldRow> {
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
            let indices = block.repetition.iter().flat_map(|it| &it.indices);
            let count = indices
                .map(|index| &index.count)
                .find(|count| holds(count, at));
            let value = field.map(|field| &field.value).or(count);
            Path {
                block: Some(block),
                field,
                values: value.map(|value| values_at(value, at)).unwrap_or_default(),
                ..Path::default()
            }
        }
        Item::Bad(_) => Path::default(),
    }
}

/// Returns `value` and its nested parts that contain the offset `at`, from the largest to the
/// smallest.
fn values_at<'a, 's>(value: &'a tree::Value<'s>, at: usize) -> Vec<&'a tree::Value<'s>> {
    let mut values = Vec::new();
    let mut next = Some(value);
    while let Some(value) = next.filter(|value| holds(value, at)) {
        values.push(value);
        // If two parts touch at `at`, the later one is chosen.
        next = value.parts().into_iter().rev().find(|part| holds(part, at));
    }
    values
}

fn holds(value: &tree::Value<'_>, at: usize) -> bool {
    value.span.source == SourceId::File && value.span.start <= at && at <= value.span.end
}
