//! A text that is being changed at many places.
//!
//! Editors send the changes of one act in the order of the text or against it. So the text is held in two halves, and the place
//! between them walks from change to change: all of them together take as long as one walk through the text, and no line or
//! column is looked up anew.

use super::places::Encoding;

/// A text and a place in it.
pub struct Cursor {
    encoding: Encoding,
    before: String,
    /// What stands behind the place, the last character first.
    behind: Vec<char>,
    line: usize,
    column: usize,
}

impl Cursor {
    /// A text with the cursor at an offset between characters, whose line and column are known.
    pub fn new(
        text: &str,
        offset: usize,
        (line, column): (usize, usize),
        encoding: Encoding,
    ) -> Self {
        let (before, behind) = text.split_at_checked(offset).unwrap_or((text, ""));
        Self {
            encoding,
            before: before.to_owned(),
            behind: behind.chars().rev().collect(),
            line,
            column,
        }
    }

    /// Replaces the text between two places, which are lines and columns in the text as it is now. The cursor then stands
    /// before the new text: whether the next change lies before or behind it, the way there is short.
    pub fn replace(&mut self, [start, end]: [(usize, usize); 2], text: &str) {
        let (start, end) = (start.min(end), start.max(end));
        self.go(start);
        let mut here = (self.line, self.column);
        while let Some(step) = self.step(here, end) {
            here = step;
            self.behind.pop();
        }
        self.behind.extend(text.chars().rev());
        // A CR and an LF that came together end one line, and the cursor must not stand within its end.
        if self.before.ends_with('\r') && self.behind.last() == Some(&'\n') {
            self.back();
            self.line = self.line.saturating_sub(1);
            self.column = self.column_here();
        }
    }

    /// The whole text.
    pub fn into_text(self) -> String {
        let mut text = self.before;
        text.extend(self.behind.iter().rev());
        text
    }

    /// Goes to a line and a column; what lies behind a line's end counts as its end, what lies within a character as its start.
    fn go(&mut self, to: (usize, usize)) {
        while (self.line, self.column) > to {
            match self.before.chars().next_back() {
                None => break,
                Some('\n' | '\r') if self.column == 0 => {
                    self.back();
                    if self.behind.last() == Some(&'\n') && self.before.ends_with('\r') {
                        self.back();
                    }
                    self.line = self.line.saturating_sub(1);
                    // Of a line that is only passed, nobody needs the column.
                    self.column = match self.line == to.0 {
                        true => self.column_here(),
                        false => self.back_to_start(),
                    };
                }
                Some(character) => {
                    self.back();
                    self.column = self.column.saturating_sub(self.encoding.width(character));
                }
            }
        }
        while let Some((line, column)) = self.step((self.line, self.column), to) {
            (self.line, self.column) = (line, column);
            self.before.extend(self.behind.pop());
        }
    }

    fn back(&mut self) {
        self.behind.extend(self.before.pop());
    }

    /// Goes to the start of the line, which is column 0.
    fn back_to_start(&mut self) -> usize {
        while self.before.ends_with(|last| last != '\n' && last != '\r') {
            self.back();
        }
        0
    }

    fn column_here(&self) -> usize {
        let line = self.before.rsplit(['\n', '\r']).next().unwrap_or_default();
        self.encoding.columns(line)
    }

    /// Where one stands behind the next character; nowhere if that is beyond the aim.
    fn step(&self, (line, column): (usize, usize), aim: (usize, usize)) -> Option<(usize, usize)> {
        let mut next = self.behind.iter().rev();
        let character = *next.next()?;
        let is_end = match character {
            '\n' => true,
            '\r' => next.next() != Some(&'\n'),
            _ => false,
        };
        let after = match character {
            _ if is_end => (line + 1, 0),
            // It belongs to the end of the line.
            '\r' if line < aim.0 => (line, column),
            '\r' => return None,
            other => (line, column + self.encoding.width(other)),
        };
        (after <= aim).then_some(after)
    }
}
