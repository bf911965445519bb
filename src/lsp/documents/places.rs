//! Lines and columns of a text, as an editor counts them.

use std::ops::Range;

/// In what the columns of a line are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// In bytes.
    Utf8,
    /// In units of UTF-16: a character beyond the first 65 536 counts twice.
    Utf16,
    /// In characters.
    Utf32,
}

impl Encoding {
    /// How many columns a text takes.
    pub fn columns(self, text: &str) -> usize {
        self.columns_of_bytes(text.as_bytes())
    }

    /// How many columns a character takes.
    pub fn width(self, character: char) -> usize {
        match self {
            Self::Utf8 => character.len_utf8(),
            Self::Utf16 => character.len_utf16(),
            Self::Utf32 => 1,
        }
    }

    /// A character counts where it starts, so that a text may be cut anywhere and its pieces counted one by one.
    fn columns_of_bytes(self, bytes: &[u8]) -> usize {
        let starts = || bytes.iter().filter(|&&byte| byte & 0xc0 != 0x80).count();
        // Four bytes of UTF-8 are two units of UTF-16.
        let fours = || bytes.iter().filter(|&&byte| byte >= 0xf0).count();
        match self {
            Self::Utf8 => bytes.len(),
            Self::Utf16 => starts() + fours(),
            Self::Utf32 => starts(),
        }
    }
}

/// Where lines start, and how many columns there are before every [`Places::STEP`]th byte: finding a place takes the same short
/// time in a line of a megabyte.
#[derive(Debug)]
pub struct Places {
    encoding: Encoding,
    /// Where lines start. To an editor they also end at a CR by itself.
    lines: Vec<usize>,
    /// The columns of the text before each step, as if it were one line.
    columns: Vec<usize>,
}

impl Places {
    /// A step takes about as long to count as a line to find.
    const STEP: usize = 256;

    pub fn new(text: &str, encoding: Encoding) -> Self {
        let mut before = 0;
        let mut columns = vec![0];
        for piece in text.as_bytes().chunks(Self::STEP) {
            before += encoding.columns_of_bytes(piece);
            columns.push(before);
        }
        Self {
            encoding,
            lines: line_starts(text),
            columns,
        }
    }

    /// The line and the column of an offset between characters, both counted from 0.
    pub fn place(&self, text: &str, offset: usize) -> (usize, usize) {
        let line = self.lines.partition_point(|&start| start <= offset);
        let line = line.saturating_sub(1);
        let start = self.lines.get(line).copied().unwrap_or(0);
        (line, self.columns_between(text, start..offset))
    }

    /// The offset of a line and a column, both counted from 0. What lies behind a line's end counts as its end, what lies within a
    /// character as its start.
    pub fn offset(&self, text: &str, line: usize, column: usize) -> usize {
        let Some(&start) = self.lines.get(line) else {
            return text.len();
        };
        let end = self.lines.get(line + 1).copied().unwrap_or(text.len());
        let written = text.get(start..end).unwrap_or_default();
        let end = start + written.trim_end_matches(['\r', '\n']).len();

        // The last step in the line that is not behind the column; from there on, characters are counted.
        let steps = start.div_ceil(Self::STEP)..end / Self::STEP + 1;
        let first = self.columns_between(text, start..(steps.start * Self::STEP).min(end));
        let known = self.columns.get(steps.clone()).unwrap_or_default();
        let origin = known.first().copied().unwrap_or(0);
        let passed = known.partition_point(|before| first + before - origin <= column);
        let (mut at, mut before) = match passed.checked_sub(1) {
            Some(last) => {
                let at = (steps.start + last) * Self::STEP;
                (
                    at,
                    first + known.get(last).map_or(0, |known| known - origin),
                )
            }
            None => (start, 0),
        };
        // A step may lie within a character, which was counted where it starts.
        while !text.is_char_boundary(at) {
            at += 1;
        }
        for character in text.get(at..end).unwrap_or_default().chars() {
            before += self.encoding.width(character);
            if before > column {
                return at;
            }
            at += character.len_utf8();
        }
        end
    }

    fn columns_between(&self, text: &str, range: Range<usize>) -> usize {
        if range.len() <= Self::STEP {
            let bytes = text.as_bytes().get(range).unwrap_or_default();
            return self.encoding.columns_of_bytes(bytes);
        }
        self.columns_before(text, range.end) - self.columns_before(text, range.start)
    }

    fn columns_before(&self, text: &str, offset: usize) -> usize {
        let step = offset / Self::STEP;
        let rest = text.as_bytes().get(step * Self::STEP..offset);
        let before = self.columns.get(step).copied().unwrap_or(0);
        before + self.encoding.columns_of_bytes(rest.unwrap_or_default())
    }
}

pub(super) fn line_starts(text: &str) -> Vec<usize> {
    let bytes = text.as_bytes();
    let mut starts = vec![0];
    for (at, byte) in bytes.iter().enumerate() {
        let is_end = match byte {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        if is_end {
            starts.push(at + 1);
        }
    }
    starts
}
