//! Keeps the texts that are open in the editor. Converts between byte offsets and positions, i.e.
//! lines and columns.

pub use crate::source::Encoding;
use crate::source::{Lines, Source, Sources};

/// A position in a text: line and column, both counted from 0.
pub type LineColumn = (u32, u32);

/// A text that is open in the editor.
#[derive(Debug)]
pub struct Document {
    /// Version number that the client has given to the text.
    pub version: i32,
    /// Source texts of the scene. The scene file is this text. There are no `--set` arguments,
    /// since only the command line passes them.
    pub sources: Sources,
    encoding: Encoding,
}

/// A change that replaces a part of a text, or the whole text.
pub struct TextChange {
    /// Start and end of the replaced part; `None` if the whole text is replaced.
    pub range: Option<[LineColumn; 2]>,
    /// The new text for the replaced part.
    pub text: String,
}

impl Document {
    /// Creates a document from a text that the client has opened. `encoding` is the unit in which
    /// the client counts columns.
    pub fn new(name: &str, version: i32, text: String, encoding: Encoding) -> Self {
        Self {
            version,
            sources: Sources::new(Source::from_text(name, text)),
            encoding,
        }
    }

    /// Applies changes in order. The positions of a change refer to the text after the previous
    /// changes. If one change is invalid, none is applied.
    ///
    /// # Errors
    ///
    /// Returns a message if a change begins or ends after the last line.
    pub fn change(&mut self, version: i32, changes: &[TextChange]) -> Result<(), String> {
        let mut text = self.text().to_owned();
        let mut lines = self.sources.file.lines().clone();
        for change in changes {
            let Some([start, end]) = change.range else {
                text.clone_from(&change.text);
                lines = Lines::new(&text);
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
            lines = Lines::new(&text);
        }
        let name = self.sources.file.name();
        *self = Self::new(name, version, text, self.encoding);
        Ok(())
    }

    fn text(&self) -> &str {
        self.sources.file.text()
    }

    /// Returns the byte offset of any position, even of an invalid one. A column beyond the end of
    /// its line yields the end of the line. A column within a character yields the start of the
    /// character. A line beyond the last one yields the end of the text.
    pub fn offset(&self, place: LineColumn) -> usize {
        let text = self.text();
        offset(text, self.sources.file.lines(), self.encoding, place).unwrap_or(text.len())
    }

    /// Returns the line and column of a byte offset.
    pub fn line_column(&self, offset: usize) -> LineColumn {
        let (file, lines) = (&self.sources.file, self.sources.file.lines());
        let offset = file.floor_char_boundary(offset);
        let column = lines.column(offset, self.encoding);
        (lines.line(offset) as u32, column as u32)
    }
}

/// Returns the byte offset of a position in `text`. `lines` is the index of the text's lines. The
/// start of the line after the last one is the end of the text. Returns `None` for later lines.
fn offset(text: &str, lines: &Lines, encoding: Encoding, (line, col): LineColumn) -> Option<usize> {
    let (line, col) = (line as usize, col as usize);
    let Some(range) = lines.range(line) else {
        return (line == lines.line(text.len()) + 1).then_some(text.len());
    };
    let start = range.start;
    let written = text.get(range)?.trim_end_matches(['\r', '\n']);
    let mut columns = 0;
    let mut characters = written.char_indices();
    let reached = characters.find(|&(_, character)| {
        columns += encoding.columns_of(character);
        columns > col
    });
    Some(start + reached.map_or(written.len(), |(at, _)| at))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENCODINGS: [Encoding; 3] = [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32];

    #[test]
    fn columns_are_counted_as_the_editor_does() {
        for (encoding, columns) in
            ENCODINGS
                .into_iter()
                .zip([[3, 5, 9, 10], [1, 2, 4, 5], [1, 2, 3, 4]])
        {
            let document = Document::new("a.scn", 1, "\u{feff}é🎱b\r\nd\n".to_owned(), encoding);
            for (offset, column) in [3, 5, 9, 10].into_iter().zip(columns) {
                assert_eq!(document.line_column(offset), (0, column));
                assert_eq!(document.offset((0, column)), offset);
            }
            // A position after the end of its line is treated as the line's end, and a position
            // after the last line as the end of the text.
            for (place, offset) in [((0, 99), 10), ((1, 1), 13), ((2, 0), 14), ((99, 99), 14)] {
                assert_eq!(document.offset(place), offset);
            }
            assert_eq!(document.line_column(99), (2, 0));
        }
        // A position within a character is treated as the character's start.
        let document = Document::new("a.scn", 1, "é🎱b".to_owned(), Encoding::Utf8);
        assert_eq!(document.offset((0, 4)), 2);
    }

    fn change(range: [LineColumn; 2], text: &str) -> TextChange {
        TextChange {
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
            // The first range ends before its start and reaches beyond the end of its line. The
            // second range is in the line after the last one, where an insertion appends to the
            // text.
            change([(0, 99), (0, 3)], "!"),
            change([(2, 0), (2, 0)], "end"),
        ];
        assert_eq!(document.change(7, &changes), Ok(()));
        assert_eq!(document.text(), "🎱 !\nend");
        assert_eq!(document.version, 7);
        let whole = TextChange {
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
