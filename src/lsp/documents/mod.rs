//! The texts that are open in the editor, and places in them by line and column.

mod cursor;
mod places;

pub use places::Encoding;

use self::{cursor::Cursor, places::Places};
use crate::source::{Source, Sources};

/// A text that is open in the editor.
#[derive(Debug)]
pub struct Document {
    /// Which state of the text it is, as the editor counts.
    pub version: i32,
    /// The text.
    pub sources: Sources,
    encoding: Encoding,
    places: Places,
}

/// What takes the place of a part of a text; of all of it, if no range is given.
pub struct Change {
    /// The part, as line and column of its start and end.
    pub range: Option<[(usize, usize); 2]>,
    /// The new text.
    pub text: String,
}

impl Document {
    /// A text as it is opened, with its columns counted as the client does.
    pub fn new(name: &str, version: i32, text: String, encoding: Encoding) -> Self {
        Self {
            version,
            places: Places::new(&text, encoding),
            sources: Sources::new(Source::from_text(name, text)),
            encoding,
        }
    }

    /// Changes the text; each change counts on those before it.
    pub fn change(&mut self, version: i32, changes: Vec<Change>) {
        let first = changes.first().and_then(|change| change.range);
        let offset = first.map_or(0, |[(line, column), _]| self.offset(line, column));
        let mut cursor = Cursor::new(self.text(), offset, self.place(offset), self.encoding);
        for change in changes {
            match change.range {
                Some(range) => cursor.replace(range, &change.text),
                None => cursor = Cursor::new(&change.text, 0, (0, 0), self.encoding),
            }
        }
        let name = self.sources.file.name();
        *self = Self::new(name, version, cursor.into_text(), self.encoding);
    }

    fn text(&self) -> &str {
        self.sources.file.text()
    }

    /// The offset of a line and a column, both counted from 0. What lies behind a line's end counts as its end, what lies within a
    /// character as its start.
    pub fn offset(&self, line: usize, column: usize) -> usize {
        self.places.offset(self.text(), line, column)
    }

    /// The line and the column of an offset, both counted from 0.
    pub fn place(&self, offset: usize) -> (usize, usize) {
        let offset = self.sources.file.floor_char_boundary(offset);
        self.places.place(self.text(), offset)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_counted_as_the_editor_does() {
        let ends = [
            (Encoding::Utf8, [3, 5, 9, 10]),
            (Encoding::Utf16, [1, 2, 4, 5]),
            (Encoding::Utf32, [1, 2, 3, 4]),
        ];
        for (encoding, columns) in ends {
            let document = Document::new("a.scn", 1, "\u{feff}é🎱b\r\nc\rd\n".to_owned(), encoding);
            for (offset, column) in [3, 5, 9, 10].into_iter().zip(columns) {
                assert_eq!(document.place(offset), (0, column));
                assert_eq!(document.offset(0, column), offset);
            }
            // Behind the end of the line, and of the text.
            assert_eq!(document.offset(0, 99), 10);
            assert_eq!(document.offset(1, 1), 13);
            assert_eq!(document.offset(2, 0), 14);
            assert_eq!(document.offset(3, 0), 16);
            assert_eq!(document.offset(99, 99), 16);
            assert_eq!(document.place(14), (2, 0));
            assert_eq!(document.place(16), (3, 0));
            assert_eq!(document.place(99), (3, 0));
            // Within a character: its start.
            match encoding {
                Encoding::Utf8 => assert_eq!(document.offset(0, 6), 5),
                Encoding::Utf16 => assert_eq!(document.offset(0, 3), 5),
                Encoding::Utf32 => {}
            }
        }
    }

    /// The offset of a place, found by counting from the start of the text.
    fn counted(text: &str, (line, column): (usize, usize), encoding: Encoding) -> usize {
        let start = places::line_starts(text).get(line).copied();
        let mut at = start.unwrap_or(text.len());
        let mut columns = 0;
        for character in text[at..].chars() {
            columns += encoding.width(character);
            if columns > column || matches!(character, '\r' | '\n') {
                break;
            }
            at += character.len_utf8();
        }
        at
    }

    const ENCODINGS: [Encoding; 3] = [Encoding::Utf8, Encoding::Utf16, Encoding::Utf32];

    #[test]
    fn places_in_long_lines_agree_with_counting() {
        for encoding in ENCODINGS {
            for start in ["", "x\n", "é\r\n"] {
                let text = format!("{start}{}\r\nend", "aé🎱✓ 12345".repeat(90));
                let document = Document::new("a.scn", 1, text.clone(), encoding);
                let line = usize::from(!start.is_empty());
                for column in 0..encoding.columns(&text) + 2 {
                    let offset = document.offset(line, column);
                    assert_eq!(offset, counted(&text, (line, column), encoding));
                    let (found, before) = document.place(offset);
                    assert!(found == line && before <= column);
                    assert_eq!(document.offset(found, before), offset);
                }
            }
        }
    }

    fn change(range: Option<[(usize, usize); 2]>, text: &str) -> Change {
        Change {
            range,
            text: text.to_owned(),
        }
    }

    #[test]
    fn changes_count_on_those_before_them() {
        let text = "one\ntwo\n".to_owned();
        let mut document = Document::new("a.scn", 1, text, Encoding::Utf16);
        let changes = vec![
            change(Some([(0, 0), (0, 3)]), "🎱"),
            change(Some([(0, 2), (1, 0)]), " "),
            // Backwards, and far behind the end.
            change(Some([(0, 99), (0, 3)]), "!"),
            change(Some([(99, 99), (99, 99)]), "end"),
        ];
        document.change(7, changes);
        assert_eq!(document.text(), "🎱 !\nend");
        assert_eq!(document.version, 7);
        document.change(8, vec![change(None, "new")]);
        assert_eq!(document.text(), "new");
        document.change(9, Vec::new());
        assert_eq!((document.text(), document.version), ("new", 9));
    }

    /// Whatever the order of the changes, and wherever they cut or join the two halves of a line's end.
    #[test]
    fn many_changes_are_as_one_after_the_other() {
        let mut state = 1_u32;
        let mut random = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 16) % below) as usize
        };
        let pieces = ["", "a", "\n", "\r", "\r\n", "é🎱", "x\ny", "\rb", "\n\r"];
        for round in 0..30_000 {
            let encoding = ENCODINGS[round % 3];
            let start: String = (0..8).map(|_| pieces[random(9)]).collect();
            let mut document = Document::new("a.scn", 1, start.clone(), encoding);
            let mut expected = start.clone();
            let mut changes = Vec::new();
            for _ in 0..6 {
                let range = [(); 2].map(|()| (random(6), random(7)));
                let [a, b] = range.map(|place| counted(&expected, place, encoding));
                let text = pieces[random(9)];
                expected.replace_range(a.min(b)..a.max(b), text);
                changes.push(change(Some(range), text));
            }
            document.change(2, changes);
            assert_eq!(document.text(), expected, "{start:?}");
        }
    }
}
