//! The texts that are open in the editor, and places in them by line and column.

use std::ops::Range;

use crate::source::{Source, Sources};

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
        match self {
            Self::Utf8 => text.len(),
            Self::Utf16 => text.chars().map(char::len_utf16).sum(),
            Self::Utf32 => text.chars().count(),
        }
    }
}

/// A text that is open in the editor.
#[derive(Debug)]
pub struct Document {
    /// Which state of the text it is, as the editor counts.
    pub version: i32,
    /// The text.
    pub sources: Sources,
    /// Where lines start. To an editor they also end at a CR by itself.
    lines: Vec<usize>,
}

/// What takes the place of a part of a text; of all of it, if no range is given.
pub struct Change {
    /// The part, as line and column of its start and end.
    pub range: Option<[(usize, usize); 2]>,
    /// The new text.
    pub text: String,
}

impl Document {
    /// A text as it is opened.
    pub fn new(name: &str, version: i32, text: String) -> Self {
        Self {
            version,
            lines: line_starts(&text),
            sources: Sources::new(Source::from_text(name, text)),
        }
    }

    /// Changes the text; each change counts on those before it.
    pub fn change(&mut self, version: i32, changes: Vec<Change>, encoding: Encoding) {
        let name = self.sources.file.name().to_owned();
        for change in changes {
            let text = match change.range {
                None => change.text,
                Some([start, end]) => {
                    let [start, end] =
                        [start, end].map(|(line, column)| self.offset(line, column, encoding));
                    let mut text = self.text().to_owned();
                    text.replace_range(start.min(end)..start.max(end), &change.text);
                    text
                }
            };
            *self = Self::new(&name, version, text);
        }
        self.version = version;
    }

    fn text(&self) -> &str {
        self.sources.file.text()
    }

    /// The bytes of a line, without its end; nothing behind the last line.
    pub fn line(&self, line: usize) -> Range<usize> {
        let text = self.text();
        let Some(&start) = self.lines.get(line) else {
            return text.len()..text.len();
        };
        let end = self.lines.get(line + 1).copied().unwrap_or(text.len());
        let written = text.get(start..end).unwrap_or_default();
        start..start + written.trim_end_matches(['\r', '\n']).len()
    }

    /// The offset of a line and a column, both counted from 0. What lies behind a line's end counts as its end, what lies within a
    /// character as its start.
    pub fn offset(&self, line: usize, column: usize, encoding: Encoding) -> usize {
        let range = self.line(line);
        let mut before = 0;
        for (at, character) in self
            .text()
            .get(range.clone())
            .unwrap_or_default()
            .char_indices()
        {
            let mut buffer = [0; 4];
            before += encoding.columns(character.encode_utf8(&mut buffer));
            if before > column {
                return range.start + at;
            }
        }
        range.end
    }

    /// The line and the column of an offset, both counted from 0.
    pub fn place(&self, offset: usize, encoding: Encoding) -> (usize, usize) {
        let offset = self.sources.file.floor_char_boundary(offset);
        let line = self.lines.partition_point(|&start| start <= offset);
        let line = line.saturating_sub(1);
        let start = self.lines.get(line).copied().unwrap_or(0);
        let before = self.text().get(start..offset).unwrap_or_default();
        (line, encoding.columns(before))
    }
}

fn line_starts(text: &str) -> Vec<usize> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_counted_as_the_editor_does() {
        let document = Document::new("a.scn", 1, "\u{feff}é🎱b\r\nc\rd\n".to_owned());
        let ends = [
            (Encoding::Utf8, [3, 5, 9, 10]),
            (Encoding::Utf16, [1, 2, 4, 5]),
            (Encoding::Utf32, [1, 2, 3, 4]),
        ];
        for (encoding, columns) in ends {
            for (offset, column) in [3, 5, 9, 10].into_iter().zip(columns) {
                assert_eq!(document.place(offset, encoding), (0, column));
                assert_eq!(document.offset(0, column, encoding), offset);
            }
            // Behind the end of the line, and of the text.
            assert_eq!(document.offset(0, 99, encoding), 10);
            assert_eq!(document.offset(1, 1, encoding), 13);
            assert_eq!(document.offset(2, 0, encoding), 14);
            assert_eq!(document.offset(3, 0, encoding), 16);
            assert_eq!(document.offset(99, 99, encoding), 16);
            assert_eq!(document.place(14, encoding), (2, 0));
            assert_eq!(document.place(16, encoding), (3, 0));
            assert_eq!(document.place(99, encoding), (3, 0));
        }
        // Within a character: its start.
        assert_eq!(document.offset(0, 3, Encoding::Utf16), 5);
        assert_eq!(document.offset(0, 6, Encoding::Utf8), 5);
    }

    #[test]
    fn changes_count_on_those_before_them() {
        let mut document = Document::new("a.scn", 1, "one\ntwo\n".to_owned());
        let change = |range, text: &str| Change {
            range,
            text: text.to_owned(),
        };
        let changes = vec![
            change(Some([(0, 0), (0, 3)]), "🎱"),
            change(Some([(0, 2), (1, 0)]), " "),
            // Backwards, and far behind the end.
            change(Some([(0, 99), (0, 3)]), "!"),
            change(Some([(99, 99), (99, 99)]), "end"),
        ];
        document.change(7, changes, Encoding::Utf16);
        assert_eq!(document.text(), "🎱 !\nend");
        assert_eq!(document.version, 7);
        document.change(8, vec![change(None, "new")], Encoding::Utf16);
        assert_eq!(document.text(), "new");
    }
}
