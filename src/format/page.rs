//! Writes entries with their columns.

use super::{
    WIDTH,
    columns::SLACK,
    entries::{Block, Entry, What},
    words::{Before, Word, column_after, ends_line, width},
};

/// By how much a block's fields stand further to the right than itself, and the other lines of a value than its first.
const INDENT: usize = 2;

/// The text of a file.
pub fn written(entries: &[Entry<'_>]) -> String {
    let mut page = Page::default();
    for entry in entries {
        page.entry(entry, 0);
    }
    page.flush();
    page.text
}

#[derive(Default)]
struct Page {
    text: String,
    /// Lines with comments at their ends, which are not aligned yet.
    waiting: Vec<(String, String)>,
}

impl Page {
    fn entry(&mut self, entry: &Entry<'_>, indent: usize) {
        if entry.blank {
            self.flush();
            self.text.push('\n');
        }
        let mut line = " ".repeat(indent);
        push_joined(&mut line, &entry.leading);
        if !entry.leading.is_empty() && !matches!(entry.what, What::Comments) {
            line.push(' ');
        }
        let start = column_after(0, &line);
        match &entry.what {
            What::Comments => {}
            What::Definition(head, rest) => {
                push_folded(&mut line, head, indent + INDENT);
                if entry.column > 0 {
                    pad(&mut line, start + entry.column - 1);
                }
                push_folded(&mut line, rest, indent + INDENT);
            }
            What::Field(name, value) => {
                line.push_str(name);
                if entry.column > 0 {
                    pad(&mut line, start + entry.column - 1);
                }
                push_folded(&mut line, value, indent + INDENT);
            }
            What::Block(block) => {
                push_head(&mut line, block, entry.column);
                if block.is_empty() {
                    line.push_str("{}");
                } else if block.on_one_line {
                    push_fields(&mut line, &block.entries);
                } else {
                    line.push('{');
                    self.flush();
                    self.line(line, &block.after_open);
                    self.flush();
                    for entry in &block.entries {
                        self.entry(entry, indent + INDENT);
                    }
                    self.flush();
                    self.line("}".to_owned(), &entry.trailing);
                    self.flush();
                    return;
                }
            }
        }
        self.line(line, &entry.trailing);
    }

    fn line(&mut self, line: String, trailing: &[&str]) {
        if trailing.is_empty() || line.contains('\n') {
            self.flush();
        }
        if trailing.is_empty() {
            self.text.push_str(&line);
            self.text.push('\n');
            return;
        }
        let mut comments = String::new();
        push_joined(&mut comments, trailing);
        self.waiting.push((line, comments));
    }

    /// Writes the lines that wait, their comments in columns.
    fn flush(&mut self) {
        let waiting = std::mem::take(&mut self.waiting);
        let widths: Vec<usize> = waiting.iter().map(|(l, _)| column_after(0, l)).collect();
        let mut from = 0;
        while from < waiting.len() {
            let (mut to, mut least, mut most) = (from, usize::MAX, 0);
            while let Some(&width) = widths.get(to)
                && width.max(most) - width.min(least) <= SLACK
            {
                (least, most) = (width.min(least), width.max(most));
                to += 1;
            }
            for (line, comments) in &waiting[from..to] {
                self.text.push_str(line);
                let blanks = most + 2 - column_after(0, line);
                self.text.extend(std::iter::repeat_n(' ', blanks));
                self.text.push_str(comments);
                self.text.push('\n');
            }
            from = to;
        }
    }
}

fn push_joined(line: &mut String, texts: &[&str]) {
    for (index, text) in texts.iter().enumerate() {
        if index > 0 {
            line.push(' ');
        }
        line.push_str(text);
    }
}

/// Fills a line up to a column.
fn pad(line: &mut String, column: usize) {
    let blanks = column.saturating_sub(column_after(0, line));
    line.extend(std::iter::repeat_n(' ', blanks));
}

/// What stands before a block's `{`, and the blank there or the end of the line.
fn push_head(line: &mut String, block: &Block<'_>, column: usize) {
    match (block.name, block.name_column) {
        (Some(name), 1..) => {
            line.push_str(block.kind);
            pad(line, block.name_column);
            line.push_str(name);
        }
        _ => push_folded(line, &block.head, 0),
    }
    if block.open_on_new_line {
        line.push('\n');
        return;
    }
    line.push(' ');
    if column > 0 {
        pad(line, column);
    }
}

/// A block's fields on its line, between braces.
fn push_fields(line: &mut String, entries: &[Entry<'_>]) {
    line.push_str("{ ");
    for (index, entry) in entries.iter().enumerate() {
        let start = column_after(0, line);
        let mut texts = entry.leading.clone();
        let mut field = String::new();
        if let What::Field(name, value) = &entry.what {
            field.push_str(name);
            push_flat(&mut field, value);
            texts.push(&field);
        }
        texts.extend(&entry.trailing);
        push_joined(line, &texts);
        if index + 1 < entries.len() {
            line.push_str("  ");
            if entry.next > 0 {
                pad(line, start + entry.next);
            }
        }
    }
    line.push_str(" }");
}

fn push_flat(line: &mut String, words: &[Word<'_>]) {
    for word in words {
        if word.before != Before::Nothing {
            line.push(' ');
        }
        line.push_str(word.text);
    }
}

/// Words, with new lines where they have to be and where the line would be too long.
fn push_folded(line: &mut String, words: &[Word<'_>], indent: usize) {
    let ends = line_ends(words, column_after(0, line), indent);
    let mut ends = ends.into_iter().peekable();
    for (index, word) in words.iter().enumerate() {
        if ends.next_if_eq(&index).is_some() {
            line.push('\n');
            line.extend(std::iter::repeat_n(' ', indent));
        } else if word.before != Before::Nothing {
            line.push(' ');
        }
        line.push_str(word.text);
    }
}

/// The words that start a line, by their indices. A line that is too long is broken where it is least nested, and there as
/// late as may be.
fn line_ends(words: &[Word<'_>], start: usize, indent: usize) -> Vec<usize> {
    let mut ends = Vec::new();
    let mut column = start;
    let mut best: Option<(usize, usize)> = None;
    let mut index = 0;
    while let Some(word) = words.get(index) {
        match word.before {
            Before::Line => {
                ends.push(index);
                best = None;
                column = indent;
            }
            Before::Fold(depth) if best.is_none_or(|(least, _)| depth <= least) => {
                best = Some((depth, index));
            }
            _ => {}
        }
        column += usize::from(matches!(word.before, Before::Space | Before::Fold(_)));
        column = column_after(column, word.text);
        if column > WIDTH
            && !ends_line(word.text)
            && let Some((_, at)) = best.take()
        {
            ends.push(at);
            column = indent + width(&words[at..=at]).saturating_sub(1);
            index = at;
        }
        index += 1;
    }
    ends
}
