//! What stands on a line by itself: definitions, blocks, fields and comments.
//!
//! It is decided here which line a comment belongs to, and which blocks stay on one line.

use std::borrow::Borrow;

use super::token_stream::{Before, Gap, Reader, WIDTH, Word, width};
use crate::{
    source::{Source, Span},
    syntax::tree::{self, Item},
};

/// A line, or several, of a file or of a block.
#[derive(Debug)]
pub struct Entry<'s> {
    /// Whether a blank line stands before it.
    pub blank: bool,
    /// The comments at its start; for a line of comments, all of it.
    pub leading: Vec<&'s str>,
    /// What it is.
    pub what: What<'s>,
    /// The comments at its end.
    pub trailing: Vec<&'s str>,
    /// The column that the second part is aligned to, counted from the entry's start: the `=`, the
    /// `{`, the value. 0 where it follows right behind the first.
    pub column: usize,
    /// Of a field on its block's line, the column of the field behind it, counted from its own
    /// start; or 0.
    pub next: usize,
}

/// What an entry is.
#[derive(Debug)]
pub enum What<'s> {
    /// Comments alone.
    Comments,
    /// `let NAME`, and `= VALUE`.
    Definition(Vec<Word<'s>>, Vec<Word<'s>>),
    /// A field's name, and its value.
    Field(&'s str, Vec<Word<'s>>),
    /// A block.
    Block(Block<'s>),
}

/// A block.
#[derive(Debug)]
pub struct Block<'s> {
    /// What stands before its `{`.
    pub head: Vec<Word<'s>>,
    /// Its kind.
    pub kind: &'s str,
    /// Its name.
    pub name: Option<&'s str>,
    /// The column that its name is aligned to.
    pub name_column: usize,
    /// Whether its `{` has to stand on a new line, behind a comment to the end of the line.
    pub open_on_new_line: bool,
    /// Comments behind the `{`.
    pub after_open: Vec<&'s str>,
    /// Its fields.
    pub entries: Vec<Entry<'s>>,
    /// Whether it stands on one line.
    pub on_one_line: bool,
    /// Whether it was written on one line, which is just too wide.
    pub is_nearly_one_line: bool,
}

impl Block<'_> {
    /// Whether it is `{}`.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty() && self.after_open.is_empty()
    }
}

impl Entry<'_> {
    /// How wide it is as a part of its block's line.
    pub fn width_in_line(&self) -> usize {
        let comments = self.leading.iter().chain(&self.trailing);
        let comments: usize = comments.map(|comment| comment.chars().count() + 1).sum();
        match &self.what {
            What::Field(name, value) => comments + name.len() + width(value),
            _ => comments.saturating_sub(1),
        }
    }
}

/// The entries of a file. Items that are handed over are gone as soon as their entries are made:
/// trees take much memory.
pub fn of_file<'s, 't>(
    source: &'s Source,
    comments: &[Span],
    items: impl IntoIterator<Item = impl Borrow<Item<'t>>>,
) -> Vec<Entry<'s>> {
    let mut reader = Reader::new(source, comments);
    let end = source.text().len();
    let (entries, _) = reader.entries(items, In::File, end, Item::span, Reader::item);
    entries
}

/// Where entries stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum In {
    File,
    Block,
}

impl<'s> Reader<'_, 's> {
    /// The entries up to an offset, and the comments behind the `{` before them.
    fn entries<N>(
        &mut self,
        nodes: impl IntoIterator<Item = impl Borrow<N>>,
        place: In,
        end: usize,
        span: fn(&N) -> Span,
        what: fn(&mut Self, &N) -> Option<What<'s>>,
    ) -> (Vec<Entry<'s>>, Vec<&'s str>) {
        let nodes = nodes.into_iter();
        let mut entries = Vec::with_capacity(nodes.size_hint().0);
        let mut after_open = Vec::new();
        for node in nodes {
            let node = node.borrow();
            let gap = self.gap(span(node).start);
            let breaks = gap.breaks;
            let lines = comments(gap, place, &mut entries, &mut after_open);
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
        let line = comments(gap, place, &mut entries, &mut after_open);
        push_comments(line, &mut entries);
        (entries, after_open)
    }

    fn item(&mut self, item: &Item<'_>) -> Option<What<'s>> {
        match item {
            Item::Definition(definition) => self.definition(definition),
            Item::Block(block) => self.block(block),
            Item::Bad(_) => None,
        }
    }

    fn definition(&mut self, definition: &tree::Definition<'_>) -> Option<What<'s>> {
        let (mut head, mut rest) = (Vec::new(), Vec::new());
        self.token(definition.keyword, Before::Nothing, &mut head);
        self.token(definition.name?.span, Before::Space, &mut head);
        let equals = definition.equals?;
        let before = self.comments(equals.start, Before::Space, &mut head);
        self.token(equals, before, &mut rest);
        self.value(&definition.value, Before::Space, 0, &mut rest);
        Some(What::Definition(head, rest))
    }

    fn block(&mut self, block: &tree::Block<'_>) -> Option<What<'s>> {
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
            In::Block,
            close.start,
            |f| f.span,
            Self::field,
        );
        self.skip(close);
        // ` { `, ` }`, and two blanks between two fields.
        let fields: usize = entries.iter().map(|entry| entry.width_in_line() + 2).sum();
        let is_empty = entries.is_empty() && after_open.is_empty();
        let width = width(&head) + 3 + fields;
        let on_one_line = is_empty || (is_on_one_line && width <= WIDTH);
        Some(What::Block(Block {
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

    fn field(&mut self, field: &tree::Field<'_>) -> Option<What<'s>> {
        let (mut name, mut value) = (Vec::new(), Vec::new());
        self.token(field.name.span, Before::Nothing, &mut name);
        self.value(&field.value, Before::Space, 0, &mut value);
        Some(What::Field(name.last()?.text, value))
    }
}

fn entry(what: What<'_>) -> Entry<'_> {
    Entry {
        blank: false,
        leading: Vec::new(),
        what,
        trailing: Vec::new(),
        column: 0,
        next: 0,
    }
}

/// Comments of one line, and whether a blank line stands before them.
type Line<'s> = (bool, Vec<&'s str>);

/// Gives the comments of a gap to the lines that they stand on: those on the line of what came
/// before to its end, the others lines of their own. The last of these is left, as it may be the
/// start of what follows.
fn comments<'s>(
    gap: Gap<'s>,
    place: In,
    entries: &mut Vec<Entry<'s>>,
    after_open: &mut Vec<&'s str>,
) -> Option<Line<'s>> {
    let joined = gap.comments.iter().take_while(|c| c.breaks == 0).count();
    let joined = match (entries.last_mut(), place) {
        (Some(last), _) => {
            let texts = gap.comments.iter().take(joined);
            last.trailing.extend(texts.map(|comment| comment.text));
            joined
        }
        // Between a `{` and what stands on its line, they are the start of that.
        (None, In::Block) if joined < gap.comments.len() || gap.breaks > 0 => {
            let texts = gap.comments.iter().take(joined);
            after_open.extend(texts.map(|comment| comment.text));
            joined
        }
        (None, _) => 0,
    };
    let mut line: Option<Line<'s>> = None;
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

fn push_comments<'s>(line: Option<Line<'s>>, entries: &mut Vec<Entry<'s>>) {
    if let Some((blank, leading)) = line {
        entries.push(Entry {
            blank,
            leading,
            ..entry(What::Comments)
        });
    }
}
