//! The texts that are open in the editor, and places in them by line and column.

use line_index::{LineCol, LineIndex, WideEncoding, WideLineCol};

use crate::source::{Source, Sources};

/// In what the columns of a line are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// In bytes.
    Utf8,
    /// In units of UTF-16, or in characters.
    Wide(WideEncoding),
}

impl Encoding {
    /// How many columns a text takes.
    pub fn columns(self, text: &str) -> usize {
        match self {
            Self::Utf8 => text.len(),
            Self::Wide(encoding) => encoding.measure(text),
        }
    }
}

/// A line and a column, both counted from 0.
pub type Place = (u32, u32);

/// A text that is open in the editor.
#[derive(Debug)]
pub struct Document {
    /// Which state of the text it is, as the editor counts.
    pub version: i32,
    /// The text.
    pub sources: Sources,
    encoding: Encoding,
}

/// What takes the place of a part of a text; of all of it, if no range is given.
pub struct Change {
    /// The part, as the places of its start and end.
    pub range: Option<[Place; 2]>,
    /// The new text.
    pub text: String,
}

impl Document {
    /// A text as it is opened, with its columns counted as the client does.
    pub fn new(name: &str, version: i32, text: String, encoding: Encoding) -> Self {
        Self {
            version,
            sources: Sources::new(Source::from_text(name, text)),
            encoding,
        }
    }

    /// Changes the text; each change counts on those before it. If one of them is none, the text
    /// stays as it is.
    ///
    /// # Errors
    ///
    /// A change begins or ends below the text.
    pub fn change(&mut self, version: i32, changes: &[Change]) -> Result<(), String> {
        let mut text = self.text().to_owned();
        let mut lines = self.sources.file.lines().clone();
        for change in changes {
            let Some([start, end]) = change.range else {
                text.clone_from(&change.text);
                lines = LineIndex::new(&text);
                continue;
            };
            let offset = |place| {
                offset(&text, &lines, self.encoding, place).ok_or_else(|| {
                    let (line, _) = place;
                    format!("the text has no line {line}, counted from 0")
                })
            };
            let (start_at, end_at) = (offset(start)?, offset(end)?);
            text.replace_range(start_at.min(end_at)..end_at.max(start_at), &change.text);
            lines = LineIndex::new(&text);
        }
        let name = self.sources.file.name();
        *self = Self::new(name, version, text, self.encoding);
        Ok(())
    }

    fn text(&self) -> &str {
        self.sources.file.text()
    }

    /// The offset of a place. What lies behind a line's end counts as its end, what lies within a
    /// character as its start, and what lies below the text as its end.
    pub fn offset(&self, place: Place) -> usize {
        let text = self.text();
        offset(text, self.sources.file.lines(), self.encoding, place).unwrap_or(text.len())
    }

    /// The place of an offset.
    pub fn place(&self, offset: usize) -> Place {
        let place = self.sources.file.line_col(offset);
        match self.encoding {
            Encoding::Utf8 => (place.line, place.col),
            Encoding::Wide(encoding) => match self.sources.file.lines().to_wide(encoding, place) {
                Some(place) => (place.line, place.col),
                None => (place.line, place.col),
            },
        }
    }
}

/// The offset of a place in a text that has these lines; none below the text. The line behind the
/// last one is the text's end.
fn offset(text: &str, lines: &LineIndex, encoding: Encoding, (line, col): Place) -> Option<usize> {
    let Some(range) = lines.line(line) else {
        let last = lines.try_line_col(lines.len())?;
        return (line == last.line + 1).then_some(text.len());
    };
    let (start, end) = (usize::from(range.start()), usize::from(range.end()));
    let written = text.get(start..end)?.trim_end_matches(['\r', '\n']);
    let place = match encoding {
        Encoding::Utf8 => Some(LineCol { line, col }),
        Encoding::Wide(encoding) => lines.to_utf8(encoding, WideLineCol { line, col }),
    };
    let column = place.map_or(usize::MAX, |place| place.col as usize);
    let columns = 0..=column.min(written.len());
    let column = columns.rev().find(|at| written.is_char_boundary(*at));
    column.map(|column| start + column)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENCODINGS: [Encoding; 3] = [
        Encoding::Utf8,
        Encoding::Wide(WideEncoding::Utf16),
        Encoding::Wide(WideEncoding::Utf32),
    ];

    #[test]
    fn columns_are_counted_as_the_editor_does() {
        for (encoding, columns) in
            ENCODINGS
                .into_iter()
                .zip([[3, 5, 9, 10], [1, 2, 4, 5], [1, 2, 3, 4]])
        {
            let document = Document::new("a.scn", 1, "\u{feff}é🎱b\r\nd\n".to_owned(), encoding);
            for (offset, column) in [3, 5, 9, 10].into_iter().zip(columns) {
                assert_eq!(document.place(offset), (0, column));
                assert_eq!(document.offset((0, column)), offset);
            }
            // Behind the end of the line, and of the text.
            for (place, offset) in [((0, 99), 10), ((1, 1), 13), ((2, 0), 14), ((99, 99), 14)] {
                assert_eq!(document.offset(place), offset);
            }
            assert_eq!(document.place(99), (2, 0));
        }
        // Within a character: its start.
        let document = Document::new("a.scn", 1, "é🎱b".to_owned(), Encoding::Utf8);
        assert_eq!(document.offset((0, 4)), 2);
    }

    fn change(range: [Place; 2], text: &str) -> Change {
        Change {
            range: Some(range),
            text: text.to_owned(),
        }
    }

    #[test]
    fn changes_count_on_those_before_them() {
        let text = "one\ntwo\n".to_owned();
        let mut document = Document::new("a.scn", 1, text, ENCODINGS[1]);
        let changes = [
            change([(0, 0), (0, 3)], "🎱"),
            change([(0, 2), (1, 0)], " "),
            // Backwards, and far behind the end of the line; then the line behind the last one.
            change([(0, 99), (0, 3)], "!"),
            change([(2, 0), (2, 0)], "end"),
        ];
        assert_eq!(document.change(7, &changes), Ok(()));
        assert_eq!(document.text(), "🎱 !\nend");
        assert_eq!(document.version, 7);
        let whole = Change {
            range: None,
            text: "new".to_owned(),
        };
        let changes = [
            whole,
            change([(0, 0), (0, 0)], "a "),
            change([(9, 0), (9, 0)], "b"),
        ];
        assert!(document.change(8, &changes).is_err());
        assert_eq!((document.text(), document.version), ("🎱 !\nend", 7));
        assert_eq!(document.change(8, &changes[..2]), Ok(()));
        assert_eq!((document.text(), document.version), ("a new", 8));
    }
}
