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

/// Index with which lines and columns of offsets are found: the starts of the lines, and the
/// characters with more than one byte.
#[derive(Clone, Debug)]
pub struct Lines {
    starts: Vec<usize>,
    wide: Vec<Wide>,
    length: usize,
}

/// A character with more than one byte.
#[derive(Clone, Copy, Debug)]
struct Wide {
    /// Offset of its end.
    end: usize,
    /// Number of UTF-16 code units, and of characters, of the text up to its end.
    columns: [usize; 2],
}

impl Lines {
    /// Makes the index of a text.
    pub fn new(text: &str) -> Self {
        let ends = memchr::memchr_iter(b'\n', text.as_bytes());
        let (mut wide, mut last) = (Vec::new(), Wide::START);
        if !text.is_ascii() {
            for (at, character) in text.char_indices().filter(|(_, it)| !it.is_ascii()) {
                let columns = [Encoding::Utf16, Encoding::Utf32].map(|it| it.columns_of(character));
                last = Wide {
                    end: at + character.len_utf8(),
                    columns: [0, 1].map(|i| last.columns[i] + at - last.end + columns[i]),
                };
                wide.push(last);
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

    /// Returns the byte range of a line with its end; `None` beyond the last line.
    pub fn range(&self, line: usize) -> Option<Range<usize>> {
        let end = self.starts.get(line + 1).unwrap_or(&self.length);
        Some(*self.starts.get(line)?..*end)
    }

    /// Returns the number of columns before an offset in its line. The offset must be a character
    /// boundary.
    pub fn column(&self, offset: usize, encoding: Encoding) -> usize {
        let start = self.starts[self.line(offset)];
        let unit = match encoding {
            Encoding::Utf8 => return offset - start,
            Encoding::Utf16 => 0,
            Encoding::Utf32 => 1,
        };
        let columns = |offset| {
            let before = self.wide.partition_point(|wide| wide.end <= offset);
            let last = before
                .checked_sub(1)
                .map_or(Wide::START, |at| self.wide[at]);
            last.columns[unit] + offset - last.end
        };
        columns(offset) - columns(start)
    }
}

impl Wide {
    /// The start of a text.
    const START: Self = Self {
        end: 0,
        columns: [0; 2],
    };
}
