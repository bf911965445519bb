//! Makes entries: the definitions, blocks, fields and comments that start lines of their own.
//!
//! This module decides to which entry a comment belongs, and which blocks stay on one line.

use std::borrow::Borrow;

use super::token_stream::{Before, Gap, TokenReader, WIDTH, Word, width};
use crate::{
    source::{Source, Span},
    syntax::tree::{self, Item},
};

/// An entry of a file or a block: a definition, a block, a field or a line of comments.
#[derive(Debug)]
pub struct Entry<'s> {
    /// Whether a blank line precedes the entry.
    pub blank: bool,
    /// The comments that stand before the entry on its line. If the entry is a line of comments,
    /// these are all of its comments.
    pub leading: Vec<&'s str>,
    /// The kind of the entry, with its parts.
    pub what: EntryKind<'s>,
    /// The comments after the entry on its line.
    pub trailing: Vec<&'s str>,
    /// Column of the second part (`=`, `{` or value), in characters from the entry's start; 0 if
    /// the part is not aligned.
    pub column: usize,
    /// Column of the next field on the same line, in characters from this field's start; 0 if the
    /// next field is not aligned.
    pub next: usize,
}

/// Kind of an entry.
#[derive(Debug)]
pub enum EntryKind<'s> {
    /// A line of comments.
    Comments,
    /// A definition: the tokens and comments of `let NAME`, and those of `= VALUE`.
    Definition(Vec<Word<'s>>, Vec<Word<'s>>),
    /// A field: its name, and the tokens and comments of its value.
    Field(&'s str, Vec<Word<'s>>),
    /// A block.
    Block(BlockEntry<'s>),
}

/// A block of a scene, with its layout.
#[derive(Debug)]
pub struct BlockEntry<'s> {
    /// Tokens and comments before the `{`.
    pub head: Vec<Word<'s>>,
    /// Kind of the block, such as `sphere`.
    pub kind: &'s str,
    /// Name of the block, if it has one.
    pub name: Option<&'s str>,
    /// Column of the name, in characters from the block's start; 0 if the name is not aligned.
    pub name_column: usize,
    /// Whether the `{` must stand on a new line, because a `//` comment precedes it.
    pub open_on_new_line: bool,
    /// The comments after the `{`, on its line.
    pub after_open: Vec<&'s str>,
    /// The fields, and the lines of comments between them.
    pub entries: Vec<Entry<'s>>,
    /// Whether the block is laid out on one line.
    pub on_one_line: bool,
    /// Whether the block was written on one line and is at most a fifth wider than allowed. Such a
    /// block stays on one line if it is part of a table, i.e. if at least three such blocks of one
    /// kind follow each other.
    pub is_nearly_one_line: bool,
}

impl BlockEntry<'_> {
    /// Returns whether the block is `{}`: without fields and without comments.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty() && self.after_open.is_empty()
    }
}

impl Entry<'_> {
    /// Returns the width that the entry has, in characters, on the line of a block that is laid out
    /// on one line.
    pub fn width_in_line(&self) -> usize {
        let comments = self.leading.iter().chain(&self.trailing);
        let comments: usize = comments.map(|comment| comment.chars().count() + 1).sum();
        match &self.what {
            EntryKind::Field(name, value) => comments + name.len() + width(value),
            _ => comments.saturating_sub(1),
        }
    }
}

/// Returns the entries of a file. If `items` owns its elements, each item is dropped as soon as its
/// entry is made, because a tree needs much memory.
pub fn of_file<'s, 't>(
    source: &'s Source,
    comments: &[Span],
    items: impl IntoIterator<Item = impl Borrow<Item<'t>>>,
) -> Vec<Entry<'s>> {
    let mut reader = TokenReader::new(source, comments);
    let end = source.text().len();
    let (entries, _) = reader.entries(items, Container::File, end, Item::span, TokenReader::item);
    entries
}

/// Container of entries: a file or a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Container {
    File,
    Block,
}

impl<'s> TokenReader<'_, 's> {
    /// Makes the entries of `nodes` (a file's items or a block's fields), and of the comments
    /// between and after the nodes, up to the offset `end`. Also returns a list of the comments
    /// that stand after a block's `{` on the same line.
    fn entries<N>(
        &mut self,
        nodes: impl IntoIterator<Item = impl Borrow<N>>,
        container: Container,
        end: usize,
        span: fn(&N) -> Span,
        what: fn(&mut Self, &N) -> Option<EntryKind<'s>>,
    ) -> (Vec<Entry<'s>>, Vec<&'s str>) {
        let nodes = nodes.into_iter();
        let mut entries = Vec::with_capacity(nodes.size_hint().0);
        let mut after_open = Vec::new();
        for node in nodes {
            let node = node.borrow();
            let gap = self.gap(span(node).start);
            let breaks = gap.breaks;
            let lines = comments(gap, container, &mut entries, &mut after_open);
            let (blank, leading) = match lines {
                Some(line) if breaks == 0 => line,
                line => {
                    push_comments(line, &mut entries);
                    (breaks > 1 && !entries.is_empty(), Vec::new())
                }
            };
            if let Some(what) = what(self, node) {
                entries.push(Entry {
                    blank,
                    leading,
                    ..entry(what)
                });
            }
        }
        let gap = self.gap(end);
        let line = comments(gap, container, &mut entries, &mut after_open);
        push_comments(line, &mut entries);
        (entries, after_open)
    }

    fn item(&mut self, item: &Item<'_>) -> Option<EntryKind<'s>> {
        match item {
            Item::Definition(definition) => self.definition(definition),
            Item::Block(block) => self.block(block),
            Item::Bad(_) => None,
        }
    }

    fn definition(&mut self, definition: &tree::Definition<'_>) -> Option<EntryKind<'s>> {
        let (mut head, mut rest) = (Vec::new(), Vec::new());
        self.token(definition.keyword, Before::Nothing, &mut head);
        self.token(definition.name?.span, Before::Space, &mut head);
        let equals = definition.equals?;
        let before = self.comments(equals.start, Before::Space, &mut head);
        self.token(equals, before, &mut rest);
        self.value(&definition.value, Before::Space, 0, &mut rest);
        Some(EntryKind::Definition(head, rest))
    }

    fn block(&mut self, block: &tree::Block<'_>) -> Option<EntryKind<'s>> {
        let (open, close) = (block.open?, block.close?);
        let mut head = Vec::new();
        self.token(block.kind?.span, Before::Nothing, &mut head);
        let kind = head.last()?.text;
        let mut name = None;
        if let Some(written) = block.name {
            self.token(written.span, Before::Space, &mut head);
            name = head.last().map(|word| word.text);
        }
        if let Some(repetition) = &block.repetition {
            self.token(repetition.keyword, Before::Space, &mut head);
            for index in &repetition.indices {
                self.token(index.name.span, Before::Space, &mut head);
                self.token(index.less, Before::Space, &mut head);
                self.value(&index.count, Before::Space, 0, &mut head);
                if let Some(comma) = index.comma {
                    self.token(comma, Before::Nothing, &mut head);
                }
            }
        }
        let open_on_new_line = self.comments(open.start, Before::Space, &mut head) == Before::Line;
        self.skip(open);
        let is_on_one_line = !self.has_line_end(open.end, close.start);
        let (entries, after_open) = self.entries(
            &block.fields,
            Container::Block,
            close.start,
            |f| f.span,
            Self::field,
        );
        self.skip(close);
        // The width includes ` { `, which has three characters, and two characters after each
        // field: two blanks that separate it from the next field, or ` }` after the last field.
        let fields: usize = entries.iter().map(|entry| entry.width_in_line() + 2).sum();
        let is_empty = entries.is_empty() && after_open.is_empty();
        let width = width(&head) + 3 + fields;
        let on_one_line = is_empty || (is_on_one_line && width <= WIDTH);
        Some(EntryKind::Block(BlockEntry {
            head,
            kind,
            name,
            name_column: 0,
            open_on_new_line,
            after_open,
            entries,
            on_one_line,
            is_nearly_one_line: is_on_one_line && width <= WIDTH + WIDTH / 5,
        }))
    }

    fn field(&mut self, field: &tree::Field<'_>) -> Option<EntryKind<'s>> {
        let (mut name, mut value) = (Vec::new(), Vec::new());
        self.token(field.name.span, Before::Nothing, &mut name);
        self.value(&field.value, Before::Space, 0, &mut value);
        Some(EntryKind::Field(name.last()?.text, value))
    }
}

fn entry(what: EntryKind<'_>) -> Entry<'_> {
    Entry {
        blank: false,
        leading: Vec::new(),
        what,
        trailing: Vec::new(),
        column: 0,
        next: 0,
    }
}

/// The comments of one line, and whether a blank line precedes them.
type CommentLine<'s> = (bool, Vec<&'s str>);

/// Assigns comments to entries. `gap` contains the comments between two tokens. Comments on the
/// line of the previous entry are added to that entry. Each further line of comments becomes an
/// entry, except the last line. The comments of the last line are returned, because the next entry
/// may stand on this line, too. Returns `None` if there is no further line.
fn comments<'s>(
    gap: Gap<'s>,
    container: Container,
    entries: &mut Vec<Entry<'s>>,
    after_open: &mut Vec<&'s str>,
) -> Option<CommentLine<'s>> {
    let joined = gap.comments.iter().take_while(|c| c.breaks == 0).count();
    let joined = match (entries.last_mut(), container) {
        (Some(last), _) => {
            let texts = gap.comments.iter().take(joined);
            last.trailing.extend(texts.map(|comment| comment.text));
            joined
        }
        // Comments after a `{` belong to the `{` if a line end follows them. Otherwise, an entry
        // follows on the same line, and the comments belong to this entry.
        (None, Container::Block) if joined < gap.comments.len() || gap.breaks > 0 => {
            let texts = gap.comments.iter().take(joined);
            after_open.extend(texts.map(|comment| comment.text));
            joined
        }
        (None, _) => 0,
    };
    let mut line: Option<CommentLine<'s>> = None;
    for comment in gap.comments.iter().skip(joined) {
        match &mut line {
            Some((_, texts)) if comment.breaks == 0 => texts.push(comment.text),
            _ => {
                push_comments(line.take(), entries);
                let blank = comment.breaks > 1 && !entries.is_empty();
                line = Some((blank, vec![comment.text]));
            }
        }
    }
    line
}

fn push_comments<'s>(line: Option<CommentLine<'s>>, entries: &mut Vec<Entry<'s>>) {
    if let Some((blank, leading)) = line {
        entries.push(Entry {
            blank,
            leading,
            ..entry(EntryKind::Comments)
        });
    }
}
