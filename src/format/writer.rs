//! Writes definitions, blocks and comments, aligned to their columns.

use super::{
    columns::shared,
    entries::{BlockEntry, Entry, EntryKind},
    token_stream::{Before, WIDTH, Word, column_after, ends_line, is_comment, width},
};

/// Number of blanks by which a block's fields, and the further lines of a value, are indented. The
/// language's reference states the number.
const INDENT: usize = 2;

/// Returns the formatted text of a file. `entries` are its definitions, blocks and comments.
pub fn written(entries: &[Entry<'_>]) -> String {
    let mut writer = LayoutWriter::default();
    for entry in entries {
        writer.entry(entry, 0);
    }
    writer.flush();
    writer.text
}

#[derive(Default)]
struct LayoutWriter {
    text: String,
    /// Lines that are not written yet, each with the comments at its end. The comments of
    /// neighbouring lines start in the same column, so the lines are written only when all of them
    /// are known.
    waiting: Vec<(String, String)>,
}

impl LayoutWriter {
    fn entry(&mut self, entry: &Entry<'_>, indent: usize) {
        if entry.blank {
            self.flush();
            self.text.push('\n');
        }
        let mut line = " ".repeat(indent);
        push_joined(&mut line, &entry.leading);
        if !entry.leading.is_empty() && !matches!(entry.what, EntryKind::Comments) {
            line.push(' ');
        }
        let start = column_after(0, &line);
        let margin = indent + INDENT;
        match &entry.what {
            EntryKind::Comments => {}
            EntryKind::Definition(head, rest) => {
                self.words(&mut line, head, margin);
                if entry.column > 0 {
                    pad(&mut line, start + entry.column - 1);
                }
                self.words(&mut line, rest, margin);
            }
            EntryKind::Field(name, value) => {
                line.push_str(name);
                if entry.column > 0 {
                    pad(&mut line, start + entry.column - 1);
                }
                self.words(&mut line, value, margin);
            }
            EntryKind::Block(block) => {
                self.head(&mut line, block, entry.column);
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

    /// Writes `words` after `line`, the start of the current line. Lines are broken where a line
    /// end is required or where they would be too long, and the further lines are indented to the
    /// column `margin`. Afterwards, `line` contains the last line, which has no line end yet.
    fn words(&mut self, line: &mut String, words: &[Word<'_>], margin: usize) {
        let last = self.lines(line, words, margin);
        push_flat(line, last);
    }

    /// Writes `words` over as many lines as they need, except the last line. Returns the words of
    /// the last line.
    fn lines<'w, 's>(
        &mut self,
        line: &mut String,
        words: &'w [Word<'s>],
        margin: usize,
    ) -> &'w [Word<'s>] {
        let mut rest = words;
        let mut written = 0;
        for start in line_starts(words, column_after(0, line), margin) {
            let (these, others) = rest.split_at(start - written);
            self.end_line(std::mem::take(line), these);
            line.extend(std::iter::repeat_n(' ', margin));
            (rest, written) = (others, start);
        }
        rest
    }

    /// Ends a line with `words`. The comments at the end of `words` are stored separately, to be
    /// aligned in a column.
    fn end_line(&mut self, mut line: String, words: &[Word<'_>]) {
        let is_behind = |word: &&Word<'_>| word.before == Before::Space && is_comment(word.text);
        let behind = words.iter().rev().take_while(is_behind).count();
        let (words, behind) = words.split_at(words.len() - behind);
        let behind: Vec<&str> = behind.iter().map(|word| word.text).collect();
        push_flat(&mut line, words);
        // In a line that consists only of comments, the comments are not aligned in a column, but
        // separated by single blanks.
        if words.len() == 1 && words.iter().all(|word| is_comment(word.text)) {
            for comment in &behind {
                line.push(' ');
                line.push_str(comment);
            }
            self.line(line, &[]);
        } else {
            self.line(line, &behind);
        }
    }

    /// Writes the part of a block before its `{`, and the blanks or the line end after this part.
    fn head(&mut self, line: &mut String, block: &BlockEntry<'_>, column: usize) {
        match (block.name, block.name_column) {
            (Some(name), 1..) => {
                line.push_str(block.kind);
                pad(line, block.name_column);
                line.push_str(name);
            }
            _ if block.open_on_new_line => {
                let last = self.lines(line, &block.head, 0);
                self.end_line(std::mem::take(line), last);
                return;
            }
            _ => self.words(line, &block.head, 0),
        }
        line.push(' ');
        if column > 0 {
            pad(line, column);
        }
    }

    /// Writes the stored lines, with the comments at their ends aligned in columns.
    fn flush(&mut self) {
        let waiting = std::mem::take(&mut self.waiting);
        let lines: Vec<usize> = (0..waiting.len()).collect();
        let width = |index: usize| column_after(0, &waiting[index].0);
        for (part, most) in shared(&lines, |index| Some(width(index))) {
            for &index in part {
                let (line, comments) = &waiting[index];
                self.text.push_str(line);
                let blanks = most + 2 - width(index);
                self.text.extend(std::iter::repeat_n(' ', blanks));
                self.text.push_str(comments);
                self.text.push('\n');
            }
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

/// Fills a line with blanks up to a column.
fn pad(line: &mut String, column: usize) {
    let blanks = column.saturating_sub(column_after(0, line));
    line.extend(std::iter::repeat_n(' ', blanks));
}

/// Appends a block's fields to its line, between braces.
fn push_fields(line: &mut String, entries: &[Entry<'_>]) {
    line.push_str("{ ");
    for (index, entry) in entries.iter().enumerate() {
        let start = column_after(0, line);
        let mut texts = entry.leading.clone();
        let mut field = String::new();
        if let EntryKind::Field(name, value) = &entry.what {
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

/// Appends words to a line, without line ends between them.
fn push_flat(line: &mut String, words: &[Word<'_>]) {
    let is_start = line.trim_start().is_empty();
    for (index, word) in words.iter().enumerate() {
        let is_apart = matches!(word.before, Before::Space | Before::Fold(_));
        if is_apart && (index > 0 || !is_start) {
            line.push(' ');
        }
        line.push_str(word.text);
    }
}

/// Returns the indices of the words that start new lines. A line that is too long is broken at a
/// word with the lowest number in [`Fold`](Before::Fold), i.e. within the fewest parentheses. If
/// several words have this number, it is broken at the last one that fits. The words start at the
/// column `start`, and new lines at the column `margin`.
fn line_starts(words: &[Word<'_>], start: usize, margin: usize) -> Vec<usize> {
    let mut starts = Vec::new();
    let mut column = start;
    let mut best: Option<(usize, usize)> = None;
    let mut index = 0;
    while let Some(word) = words.get(index) {
        match word.before {
            Before::Line => {
                column = margin;
                starts.push(index);
                best = None;
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
            starts.push(at);
            column = margin + width(&words[at..=at]).saturating_sub(1);
            index = at;
        }
        index += 1;
    }
    starts
}
