//! Source texts and positions in them.
//!
//! A [`Source`] is made from bytes and a name. Inside the program, positions are byte ranges
//! ([`Span`]). Lines and columns are needed only for output, and [`Source::place`] computes them. A
//! scene has one file and any number of `--set` arguments. A diagnostic may refer to each of these
//! texts, so a [`Span`] contains the identifier of its source.

mod lines;

use std::{fmt, ops::Range, sync::OnceLock};

#[doc(hidden)]
pub use lines::{Encoding, Lines};

/// Identifier of a source text. In the order of identifiers, the file comes first, then the `--set`
/// arguments by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SourceId {
    /// The scene file (or standard input).
    File,
    /// The `--set` argument with this index, counted from 0.
    Set(u32),
}

/// A half-open range of bytes in one source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// The source of the span.
    pub source: SourceId,
    /// Offset of the first byte.
    pub start: usize,
    /// Offset after the last byte.
    pub end: usize,
}

impl Span {
    /// Makes the span of the bytes from `start` to before `end` in `source`.
    pub fn new(source: SourceId, start: usize, end: usize) -> Self {
        Self { source, start, end }
    }

    /// Returns the byte range without its source.
    pub fn range(self) -> Range<usize> {
        self.start..self.end
    }

    /// Returns the smallest span that contains both spans, which must lie in one source.
    pub fn to(self, other: Self) -> Self {
        debug_assert_eq!(self.source, other.source);
        Self::new(
            self.source,
            self.start.min(other.start),
            self.end.max(other.end),
        )
    }
}

/// Sorts a list by the spans of its elements; elements with equal spans keep their order.
///
/// The sorting itself is done by a function that is not generic. If it were compiled for each
/// element type, the code that a browser loads would be about 2 % larger.
pub fn sort_by_span<T>(list: &mut Vec<T>, span: impl Fn(&T) -> Span) {
    let order = order(&list.iter().map(span).collect::<Vec<_>>());
    let mut taken: Vec<Option<T>> = list.drain(..).map(Some).collect();
    list.extend(order.into_iter().filter_map(|at| taken[at].take()));
}

/// Returns the indices of spans, sorted by span; equal spans keep their order.
fn order(spans: &[Span]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..spans.len()).collect();
    order.sort_by_key(|&at| spans[at]);
    order
}

/// The source texts of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sources {
    /// The scene file.
    pub file: Source,
    /// The `--set` arguments in their order, as they were typed (`TARGET=VALUE`).
    pub sets: Vec<Source>,
}

impl Sources {
    /// Makes the sources of a file, without `--set` arguments.
    pub fn new(file: Source) -> Self {
        Self {
            file,
            sets: Vec::new(),
        }
    }

    /// Appends a `--set` argument. The arguments are named `--set #1`, `--set #2` and so on.
    pub fn push_set(&mut self, argument: &str) {
        let name = format!("--set #{}", self.sets.len() + 1);
        self.sets.push(Source::from_text(name, argument));
    }

    /// Appends `--set` arguments.
    pub fn with_sets<S: AsRef<str>>(mut self, arguments: impl IntoIterator<Item = S>) -> Self {
        for argument in arguments {
            self.push_set(argument.as_ref());
        }
        self
    }

    /// Returns the `--set` arguments with their identifiers.
    pub fn sets(&self) -> impl Iterator<Item = (SourceId, &Source)> {
        let sets = (0..).zip(&self.sets);
        sets.map(|(index, set)| (SourceId::Set(index), set))
    }

    /// Returns the source with the identifier `id`, or the file if there is no such `--set`
    /// argument.
    pub fn get(&self, id: SourceId) -> &Source {
        let set = match id {
            SourceId::File => None,
            SourceId::Set(index) => self.sets.get(index as usize),
        };
        set.unwrap_or(&self.file)
    }

    /// Returns line and column of the start of a span.
    pub fn place(&self, span: Span) -> LineColumn {
        self.get(span.source).place(span.start)
    }

    /// Returns the text at a span.
    pub fn text(&self, span: Span) -> &str {
        self.get(span.source).slice(span.range())
    }
}

/// A line and a column, both counted from 1; columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct LineColumn {
    /// The line, counted from 1.
    pub line: usize,
    /// The column, in characters, counted from 1.
    pub column: usize,
}

/// A source text with its name.
#[derive(Clone)]
pub struct Source {
    name: String,
    text: String,
    invalid: Vec<usize>,
    lines: OnceLock<Lines>,
}

/// Two sources are equal if their names and their bytes are equal.
impl PartialEq for Source {
    fn eq(&self, other: &Self) -> bool {
        let (own, others) = ((&self.text, &self.invalid), (&other.text, &other.invalid));
        self.name == other.name && own == others
    }
}

impl Eq for Source {}

/// Writes the name and the text.
impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = f.debug_struct("Source");
        fields.field("name", &self.name);
        fields.field("text", &self.text).finish_non_exhaustive()
    }
}

impl Source {
    /// Makes a source from a file's bytes. Each byte that is not valid UTF-8 becomes a `_`, so that
    /// all offsets stay the same; [`Source::invalid_utf8`] returns the offsets of these bytes.
    pub fn from_bytes(name: impl Into<String>, bytes: Vec<u8>) -> Self {
        let (text, invalid) = match String::from_utf8(bytes) {
            Ok(text) => (text, Vec::new()),
            Err(error) => without_invalid(error.as_bytes()),
        };
        Self {
            name: name.into(),
            text,
            invalid,
            lines: OnceLock::new(),
        }
    }

    /// Makes a source of a text.
    pub fn from_text(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self::from_bytes(name, text.into().into_bytes())
    }

    /// Returns the name in reports: the file's path as it was given, `-` for standard input, or
    /// `--set #1`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the text without copying it.
    pub fn into_text(self) -> String {
        self.text
    }

    /// Returns the text of a byte range. Returns an empty text if the range is not within the
    /// source, or not at character boundaries.
    pub fn slice(&self, range: Range<usize>) -> &str {
        self.text.get(range).unwrap_or_default()
    }

    /// Returns the offsets of the bytes that are not valid UTF-8, in ascending order.
    pub fn invalid_utf8(&self) -> &[usize] {
        &self.invalid
    }

    /// Returns whether the file is probably UTF-16, with or without a byte order mark. Most scenes
    /// contain only ASCII characters. In UTF-16, one of the two bytes of such a character is zero.
    pub fn is_utf16(&self) -> bool {
        const LOOKED_AT: usize = 256;
        let bytes = self.text.as_bytes();
        let has_mark = self.invalid.starts_with(&[0, 1]);
        let first = if has_mark { 2 } else { 0 };
        let end = bytes.len().min(first + LOOKED_AT);
        let start = bytes.get(first..end).unwrap_or_default();
        let zeros = |first| {
            let every_second = start.iter().skip(first).step_by(2);
            every_second.filter(|&&byte| byte == 0).count()
        };
        let (even, odd) = (zeros(0), zeros(1));
        start.len() >= 4 && even.min(odd) == 0 && even.max(odd) > start.len() / 4
    }

    /// Returns the length of the byte order mark at the start of the text, in bytes: 3 or 0.
    pub fn bom_len(&self) -> usize {
        usize::from(self.text.starts_with(BOM)) * BOM.len_utf8()
    }

    /// Returns the line end of the text: CRLF if its first line ends with CRLF, and otherwise LF.
    pub fn line_end(&self) -> &'static str {
        let rest = self.text.get(self.line_range(1).end..);
        if rest.is_some_and(|rest| rest.starts_with("\r\n")) {
            "\r\n"
        } else {
            "\n"
        }
    }

    /// Returns the byte range of a line, counted from 1, without the LF or CRLF at its end. A line
    /// beyond the last one has the empty range at the end of the text.
    pub fn line_range(&self, line: usize) -> Range<usize> {
        let Some(Range { start, end }) = self.lines().range(line.saturating_sub(1)) else {
            return self.text.len()..self.text.len();
        };
        let ended = self.slice(start..end);
        let line = ended.strip_suffix('\n').unwrap_or(ended);
        let line = line.strip_suffix('\r').unwrap_or(line);
        start..start + line.len()
    }

    /// Returns the line that contains an offset, counted from 1.
    pub fn line(&self, offset: usize) -> usize {
        self.lines().line(self.floor_char_boundary(offset)) + 1
    }

    /// Returns the line and column of an offset. A byte order mark is not counted as a column. An
    /// offset beyond the end is treated as the end, and an offset within a character as the
    /// character's start.
    pub fn place(&self, offset: usize) -> LineColumn {
        let line = self.line(offset);
        let offset = self.floor_char_boundary(offset);
        let before = self.lines().column(offset, Encoding::Utf32);
        let mark = usize::from(line == 1 && self.bom_len() > 0);
        LineColumn {
            line,
            column: before.saturating_sub(mark) + 1,
        }
    }

    /// Returns the tables from which the line and column of an offset are computed. They are made
    /// on first use.
    #[doc(hidden)]
    pub fn lines(&self) -> &Lines {
        self.lines.get_or_init(|| Lines::new(&self.text))
    }

    /// Clamps a span to this source, and moves its ends to character boundaries, so that the result
    /// can slice the text.
    pub fn clamped(&self, span: Span) -> Span {
        let start = self.floor_char_boundary(span.start);
        let end = self.floor_char_boundary(span.end.max(start));
        Span::new(span.source, start, end)
    }

    /// Returns the greatest character boundary that is at most `offset`.
    pub fn floor_char_boundary(&self, offset: usize) -> usize {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        offset
    }
}

const BOM: char = '\u{feff}';

fn without_invalid(bytes: &[u8]) -> (String, Vec<usize>) {
    let mut text = String::with_capacity(bytes.len());
    let mut invalid = Vec::new();
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        for _ in chunk.invalid() {
            invalid.push(text.len());
            text.push('_');
        }
    }
    (text, invalid)
}
