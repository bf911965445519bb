//! Ways out of a problem that a program can take: edits of the text.

use crate::source::{SourceId, Sources, Span, sort_by_span};

/// What a fix does to what the author wrote, and so who may apply it. The later ones include what
/// the earlier ones may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Applicability {
    /// All that was written stays, and there is one plausible meaning: it can be applied without
    /// being asked.
    Safe,
    /// One of several meanings is chosen, or something that was written is removed or changed.
    Unsafe,
    /// A value is made up, which the author is to replace.
    Placeholder,
}

impl Applicability {
    /// Safe or not.
    pub const fn safe_if(is_safe: bool) -> Self {
        match is_safe {
            true => Self::Safe,
            false => Self::Unsafe,
        }
    }

    /// Its word in JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Safe => "safe",
            Self::Unsafe => "unsafe",
            Self::Placeholder => "placeholder",
        }
    }
}

/// One way out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// What it does, as a request: "write `30deg`".
    pub title: String,
    /// Who may apply it.
    pub applicability: Applicability,
    /// What has to be changed; the places do not overlap.
    pub edits: Vec<Edit>,
}

/// A change of a text. As spans do, it says which: the file, or a `--set` argument.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Edit {
    /// What is replaced; an empty span is a place to insert at.
    pub span: Span,
    /// What stands there afterwards.
    pub text: String,
}

impl Fix {
    /// A way out that takes these edits. It is unsafe unless whoever makes it says otherwise.
    pub fn new(title: impl Into<String>, edits: impl IntoIterator<Item = Edit>) -> Self {
        Self::sorted(title.into(), edits.into_iter().collect())
    }

    /// Apart from what is generic, so that sorting is compiled once.
    fn sorted(title: String, mut edits: Vec<Edit>) -> Self {
        sort_by_span(&mut edits, |edit| edit.span);
        // Removals take the space beside them along; two neighbours take it once.
        for index in 1..edits.len() {
            let before = edits[index - 1].span;
            let span = &mut edits[index].span;
            if span.source == before.source {
                span.start = span.start.max(before.end);
                span.end = span.end.max(span.start);
            }
        }
        Self {
            title,
            applicability: Applicability::Unsafe,
            edits,
        }
    }

    /// The same with another applicability.
    pub fn being(self, applicability: Applicability) -> Self {
        Self {
            applicability,
            ..self
        }
    }

    /// The same, which keeps all that was written and has one meaning.
    pub fn safe(self) -> Self {
        self.being(Applicability::Safe)
    }

    /// The same, whose value is made up.
    pub fn placeholder(self) -> Self {
        self.being(Applicability::Placeholder)
    }

    /// Makes it unsafe if it takes a comment of the text away with something else, or joins two
    /// words.
    pub fn mind(&mut self, sources: &Sources) {
        let mut edits = self.edits.iter();
        if self.is_safe()
            && edits.any(|edit| edit.is_careless(sources.get(edit.span.source).text()))
        {
            self.applicability = Applicability::Unsafe;
        }
    }

    /// Whether it can be applied without being asked.
    pub fn is_safe(&self) -> bool {
        self.applicability == Applicability::Safe
    }

    /// Writes something else in a place; the title is what is written.
    pub fn write(span: Span, text: impl Into<String>) -> Self {
        let text = text.into();
        Self::new(format!("write `{text}`"), [Edit::new(span, text)])
    }

    /// Takes away what stands in a place.
    pub fn remove(title: impl Into<String>, span: Span, sources: &Sources) -> Self {
        Self::new(title, [Edit::remove(span, sources)])
    }

    /// Takes away a field or an item as a whole: with the comments on its lines where nothing else
    /// stands on them, as they speak of it.
    pub fn remove_whole(title: impl Into<String>, span: Span, sources: &Sources) -> Self {
        let whole = with_comments(span, sources);
        let title = match whole == span {
            true => title.into(),
            false => title.into() + ", with its comment",
        };
        Self::remove(title, whole, sources)
    }
}

/// A place with the comments behind it, if there is nothing else on its lines.
fn with_comments(span: Span, sources: &Sources) -> Span {
    let text = sources.get(span.source).text();
    let after = text.get(span.end..).unwrap_or_default();
    let rest = past_comments(after);
    if !starts_line(text.get(..span.start).unwrap_or_default()) || !ends_line(rest) {
        return span;
    }
    let behind = after.get(..after.len() - rest.len()).unwrap_or_default();
    Span::new(span.source, span.start, span.end + behind.trim_end().len())
}

const BLANK: [char; 2] = [' ', '\t'];

/// Whether nothing stands in a line before what follows this text.
fn starts_line(before: &str) -> bool {
    let outer = before.trim_end_matches(BLANK);
    outer.is_empty() || outer.ends_with(['\n', '\u{feff}'])
}

/// Whether nothing stands in a line before this rest of the text.
fn ends_line(rest: &str) -> bool {
    rest.is_empty() || rest.starts_with(['\n', '\r'])
}

/// What follows the comments and blanks at the start of a text, up to the end of their line.
fn past_comments(text: &str) -> &str {
    let mut rest = text.trim_start_matches([' ', '\t']);
    loop {
        let end = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(0, |end| end + "*/".len())
        } else {
            0
        };
        if end == 0 {
            return rest;
        }
        let after = rest.get(end..).unwrap_or_default();
        rest = after.trim_start_matches([' ', '\t']);
    }
}

impl Edit {
    /// Replaces what stands in a place.
    pub fn new(span: Span, text: impl Into<String>) -> Self {
        let text = text.into();
        Self { span, text }
    }

    /// Inserts before a byte of the text.
    pub fn insert(source: SourceId, at: usize, text: impl Into<String>) -> Self {
        Self::new(Span::new(source, at, at), text)
    }

    /// Adds fields at the end of a block that stands in the file: on its line, or on lines of their
    /// own.
    pub fn add_fields(block: Span, sources: &Sources, fields: &[String]) -> Option<Self> {
        if block.source != SourceId::File {
            return None;
        }
        let inside = sources.text(block).strip_suffix('}')?;
        let tight = inside.trim_end();
        let gap = inside.get(tight.len()..)?;
        let at = block.start + tight.len();
        let line_end = sources.file.line_end();
        let (end, added) = match gap.rsplit_once('\n') {
            Some((_, indent)) => {
                let last = tight.lines().next_back()?;
                // On the line that the block starts on, a comment or a field may stand behind the
                // `{`.
                let deeper = match last.ends_with('{') || !tight.contains('\n') {
                    true => format!("{indent}  "),
                    false => last.chars().take_while(|c| c.is_whitespace()).collect(),
                };
                let lines = fields.iter();
                let lines = lines.map(|field| format!("{line_end}{deeper}{field}"));
                (at, lines.collect())
            }
            None if tight.ends_with('{') => (at + gap.len(), format!(" {} ", fields.join("  "))),
            None => (at + gap.len(), format!("  {} ", fields.join("  "))),
        };
        Some(Self::new(Span::new(SourceId::File, at, end), added))
    }

    /// Takes away what stands in a place: the whole line if nothing else stands on it, or else the
    /// blanks on one side too. What stood on both sides of it stays apart.
    pub fn remove(span: Span, sources: &Sources) -> Self {
        Self::remove_in(span, sources.get(span.source).text())
    }

    /// The same in a text.
    pub fn remove_in(span: Span, text: &str) -> Self {
        let Span { source, start, end } = span;
        let (before, after) = (
            text.get(..start).unwrap_or_default(),
            text.get(end..).unwrap_or_default(),
        );
        let (outer, rest) = (
            before.trim_end_matches(BLANK),
            after.trim_start_matches(BLANK),
        );
        let (line_starts, line_ends) = (starts_line(before), ends_line(rest));
        if line_starts && line_ends {
            let line_end = rest.find('\n').map_or(rest.len(), |at| at + 1);
            let to = text.len() - rest.len() + line_end;
            return Self::new(Span::new(source, outer.len(), to), "");
        }
        if line_starts || outer.ends_with(['{', '(', '[']) {
            return Self::new(Span::new(source, start, text.len() - rest.len()), "");
        }
        let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '#');
        let is_begin = |c: char| is_word(c) || matches!(c, '"' | '\'');
        let joins = outer.ends_with(is_word) && after.starts_with(is_begin);
        let length = text.len();
        let text = if joins { " " } else { "" };
        let end = match rest.starts_with([')', ']', ',']) {
            true => length - rest.len(),
            false => end,
        };
        Self::new(Span::new(source, outer.len(), end), text)
    }
}

impl Edit {
    /// Whether it takes a comment away with something else, or joins two words.
    fn is_careless(&self, text: &str) -> bool {
        let is_comment = |sign: &str| {
            let rest = |text: &str| text.find(sign).map(|at| text.len() - at - sign.len());
            let taken = rest(text.get(self.span.range()).unwrap_or_default());
            taken.is_some_and(|rest| rest > 0) && !self.text.contains(sign)
        };
        let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '#');
        let before = text.get(..self.span.start).unwrap_or_default();
        let after = text.get(self.span.end..).unwrap_or_default();
        let taken = text.get(self.span.range()).unwrap_or_default();
        let joins = |middle: &str| match middle.is_empty() {
            true => [before.ends_with(is_word) && after.starts_with(is_word); 2],
            false => [
                before.ends_with(is_word) && middle.starts_with(is_word),
                middle.ends_with(is_word) && after.starts_with(is_word),
            ],
        };
        let (old, new) = (joins(taken), joins(&self.text));
        ["//", "/*", "# ", "--"].into_iter().any(is_comment)
            || (0..2).any(|side| new[side] && !old[side])
    }
}

/// A text with the edits of a fix that are for it.
pub fn apply(fix: &Fix, source: SourceId, text: &str) -> String {
    let mut applied = String::with_capacity(text.len());
    let mut at = 0;
    for edit in fix.edits.iter().filter(|edit| edit.span.source == source) {
        applied.push_str(text.get(at..edit.span.start).unwrap_or_default());
        applied.push_str(&edit.text);
        at = edit.span.end.max(at);
    }
    applied.push_str(text.get(at..).unwrap_or_default());
    applied
}
