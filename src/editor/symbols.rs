//! Builds the outline of a text: its definitions and blocks, with their fields.

use super::analysis::Analysis;
use crate::{
    schema,
    source::{Span, sort_by_span},
    syntax::{
        shorten,
        tree::{Block, Definition, Item},
    },
};

/// An entry of the outline: a definition, a block, or a field of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Name of the definition, field or object. A block without a name is listed under its keyword.
    pub name: String,
    /// Text shown beside the name. For a definition or field, it is the value. For a block, it is
    /// the keyword, unless the entry is listed under the keyword already. If the block is repeated,
    /// the repetition follows, such as `for i < 3`.
    pub detail: String,
    /// Whether the entry is a definition, a setting, an object or a field.
    pub kind: SymbolKind,
    /// Span of the whole definition, block or field.
    pub span: Span,
    /// Span of the name or the keyword, which editors select. It lies within `span`.
    pub selection: Span,
    /// Entries of the fields, if this is the entry of a block.
    pub children: Vec<Symbol>,
}

/// Kind of an entry of the outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SymbolKind {
    /// A definition with `let`.
    Definition,
    /// The block `image`, `camera` or `sampler`.
    Setting,
    /// The block of an object, such as `sphere`.
    Object,
    /// A field of a block.
    Field,
}

/// Returns the entries of the outline in the order of the text.
pub fn symbols(analysis: &Analysis<'_>) -> Vec<Symbol> {
    let items = analysis.items().iter();
    let mut symbols: Vec<Symbol> = items
        .filter_map(|item| match item {
            Item::Definition(definition) => defined(analysis, definition),
            Item::Block(block) => of_block(analysis, block),
            Item::Bad(_) => None,
        })
        .collect();
    sort_by_span(&mut symbols, |symbol| symbol.span);
    symbols
}

fn defined(analysis: &Analysis<'_>, definition: &Definition<'_>) -> Option<Symbol> {
    let name = definition.name?;
    let span = definition.span.to(name.span);
    Some(Symbol {
        name: name.text.to_owned(),
        detail: shorten(analysis.slice(definition.value.span)),
        kind: SymbolKind::Definition,
        span,
        selection: name.span,
        children: Vec::new(),
    })
}

fn of_block(analysis: &Analysis<'_>, block: &Block<'_>) -> Option<Symbol> {
    let kind = block.kind?;
    let row = schema::block(kind.text);
    let fields = block.fields.iter().map(|field| Symbol {
        name: field.name.text.to_owned(),
        detail: shorten(analysis.slice(field.value.span)),
        kind: SymbolKind::Field,
        span: field.span,
        selection: field.name.span,
        children: Vec::new(),
    });
    // An author may write the name before the keyword by mistake, as in `let Ball = sphere {`. This
    // name lies outside of the block's span, so it is left out of the outline.
    let name = block
        .name
        .filter(|name| name.span.start >= block.span.start);
    Some(Symbol {
        name: name.map_or(kind.text, |name| name.text).to_owned(),
        detail: match &block.repetition {
            Some(repetition) => {
                let repeated = shorten(analysis.slice(repetition.span()));
                [name.map_or("", |_| kind.text), &repeated]
                    .join(" ")
                    .trim_start()
                    .to_owned()
            }
            None => name.map_or("", |_| kind.text).to_owned(),
        },
        kind: if row.is_some_and(|row| row.is_object) {
            SymbolKind::Object
        } else {
            SymbolKind::Setting
        },
        span: block.span.to(kind.span),
        selection: name.map_or(kind.span, |name| name.span),
        children: fields.collect(),
    })
}
