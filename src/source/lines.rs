//! Lines and columns of offsets.

use std::ops::Range;

/// Unit in which columns of a line are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// UTF-16 code units.
    Utf16,
    /// Characters.
    Utf32,
}

impl Encoding {
    /// Returns the number of columns of a character in this unit.
    pub fn columns_of(self, character: char) -> usize {
        match self {
            Self::Utf8 => character.len_utf8(),
            Self::Utf16 => character.len_utf16(),
            Self::Utf32 => 1,
        }
    }

    /// Returns the number of columns of `text` in this unit.
    pub fn columns(self, text: &str) -> usize {
        text.chars().map(|it| self.columns_of(it)).sum()
    }
}

/// Tables from which the line and column of an offset are computed: the starts of the lines, and
/// the characters that have more than one byte.
#[derive(Clone, Debug)]
pub struct Lines {
    starts: Vec<usize>,
    /// One entry for each character that has more than one byte, in the order of the text. The
    /// first number is the offset of the character's end, in bytes. The second number is this
    /// offset minus the number of UTF-16 code units up to the character's end. The third number is
    /// the offset minus the number of characters up to there.
    wide: Vec<[usize; 3]>,
    length: usize,
}

impl Lines {
    /// Makes the tables for a text.
    pub fn new(text: &str) -> Self {
        let ends = memchr::memchr_iter(b'\n', text.as_bytes());
        let (mut wide, mut excess) = (Vec::new(), [0; 2]);
        let characters = (!text.is_ascii()).then(|| text.char_indices());
        for (at, character) in characters.into_iter().flatten() {
            if let bytes @ 2.. = character.len_utf8() {
                excess = [
                    excess[0] + bytes - character.len_utf16(),
                    excess[1] + bytes - 1,
                ];
                wide.push([at + bytes, excess[0], excess[1]]);
            }
        }
        Self {
            starts: [0].into_iter().chain(ends.map(|end| end + 1)).collect(),
            wide,
            length: text.len(),
        }
    }

    /// Returns the index of the line that contains an offset.
    pub fn line(&self, offset: usize) -> usize {
        self.starts.partition_point(|&start| start <= offset) - 1
    }

    /// Returns the byte range of a line, including its line end. Returns `None` if there is no such
    /// line.
    pub fn range(&self, line: usize) -> Option<Range<usize>> {
        let end = self.starts.get(line + 1).unwrap_or(&self.length);
        Some(*self.starts.get(line)?..*end)
    }

    /// Returns the number of columns before an offset in its line. The offset must be a character
    /// boundary.
    pub fn column(&self, offset: usize, encoding: Encoding) -> usize {
        let start = self.starts[self.line(offset)];
        let excess = |offset| {
            let before = self.wide.partition_point(|&[end, ..]| end <= offset);
            match (before.checked_sub(1), encoding) {
                (None, _) | (_, Encoding::Utf8) => 0,
                (Some(last), Encoding::Utf16) => self.wide[last][1],
                (Some(last), Encoding::Utf32) => self.wide[last][2],
            }
        };
        offset - start - (excess(offset) - excess(start))
    }
}
