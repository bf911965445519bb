//! Fixes, i.e. edits of the text that solve a problem.

use crate::source::{SourceId, Sources, Span, sort_by_span};

/// Certainty of a fix. It decides whether a tool may apply the fix without asking. The variants are
/// ordered: a tool that applies fixes of one variant also applies those of the variants before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Applicability {
    /// The fix keeps everything that was written, and only one meaning is plausible. It can be
    /// applied without asking.
    Safe,
    /// The fix chooses one of several meanings, or removes or changes something that was written.
    /// The author decides.
    Unsafe,
    /// The fix contains an example value that the author must replace.
    Placeholder,
}

impl Applicability {
    /// Returns [`Self::Safe`] if `is_safe`, and otherwise [`Self::Unsafe`].
    pub const fn safe_if(is_safe: bool) -> Self {
        if is_safe { Self::Safe } else { Self::Unsafe }
    }

    /// Returns the word for the variant in JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Safe => "safe",
            Self::Unsafe => "unsafe",
            Self::Placeholder => "placeholder",
        }
    }
}

/// A way to solve a problem by edits.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Fix {
    /// What the fix does, as an imperative such as "write `30deg`".
    pub title: String,
    /// Certainty of the fix, which decides whether it may be applied without asking.
    pub applicability: Applicability,
    /// The edits, sorted by place; their spans do not overlap.
    pub edits: Vec<Edit>,
}

/// Replacement of a part of a text, which is either the scene file or a `--set` argument.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Edit {
    /// The place to replace; if it is empty, the text is inserted there.
    pub span: Span,
    /// The new text.
    pub text: String,
}

impl Fix {
    /// Makes a fix of edits. The fix is unsafe unless the caller changes its applicability.
    pub fn new(title: impl Into<String>, edits: impl IntoIterator<Item = Edit>) -> Self {
        Self::sorted(title.into(), edits.into_iter().collect())
    }

    /// Makes a fix of edits, which are sorted first. Unlike [`Self::new`], this function is not
    /// generic, so that it is compiled only once.
    fn sorted(title: String, mut edits: Vec<Edit>) -> Self {
        sort_by_span(&mut edits, |edit| edit.span);
        // A removal includes the adjacent white space. White space between two removals may be in
        // both spans. It is then left only in the first one, so that the spans do not overlap.
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

    /// Returns the fix with another applicability.
    pub fn with_applicability(self, applicability: Applicability) -> Self {
        Self {
            applicability,
            ..self
        }
    }

    /// Marks the fix as safe: it keeps everything that was written, and only one meaning is
    /// possible.
    pub fn safe(self) -> Self {
        self.with_applicability(Applicability::Safe)
    }

    /// Marks the fix as containing an example value.
    pub fn placeholder(self) -> Self {
        self.with_applicability(Applicability::Placeholder)
    }

    /// Marks the fix as unsafe if one of its edits removes a comment together with other text, or
    /// joins two words.
    pub fn make_careful(&mut self, sources: &Sources) {
        let mut edits = self.edits.iter();
        if self.is_safe()
            && edits.any(|edit| edit.is_careless(sources.get(edit.span.source).text()))
        {
            self.applicability = Applicability::Unsafe;
        }
    }

    /// Returns whether the fix can be applied without asking.
    pub fn is_safe(&self) -> bool {
        self.applicability == Applicability::Safe
    }

    /// Makes the fix that replaces `span` by `text`, with a title that says so.
    pub fn write(span: Span, text: impl Into<String>) -> Self {
        let text = text.into();
        Self::new(format!("write `{text}`"), [Edit::new(span, text)])
    }

    /// Makes the fix that removes the text at `span`. As with [`Edit::remove`], adjacent white
    /// space or the whole line is removed, too.
    pub fn remove(title: impl Into<String>, span: Span, sources: &Sources) -> Self {
        Self::new(title, [Edit::remove(span, sources)])
    }

    /// Makes the fix that removes a whole field or item. If nothing else stands on its lines, also
    /// removes the comments after it, which belong to it.
    pub fn remove_whole(title: impl Into<String>, span: Span, sources: &Sources) -> Self {
        let whole = with_comments(span, sources);
        let title = if whole == span {
            title.into()
        } else {
            title.into() + ", with its comment"
        };
        Self::remove(title, whole, sources)
    }
}

/// Extends a span to the comments after it, if nothing else stands on its lines.
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

/// Characters of white space within a line: space and tab.
const BLANK: [char; 2] = [' ', '\t'];

/// Returns whether the last line of `before` contains only spaces and tabs, or a byte order mark
/// and spaces and tabs.
fn starts_line(before: &str) -> bool {
    let outer = before.trim_end_matches(BLANK);
    outer.is_empty() || outer.ends_with(['\n', '\u{feff}'])
}

/// Returns whether `rest`, the text after an offset, is empty or starts with a line end.
fn ends_line(rest: &str) -> bool {
    rest.is_empty() || rest.starts_with(['\n', '\r'])
}

/// Returns `text` without the spaces, tabs and comments at its start. A line end is skipped only if
/// it lies within a `/* */` comment.
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
    /// Makes the edit that replaces `span` by `text`.
    pub fn new(span: Span, text: impl Into<String>) -> Self {
        let text = text.into();
        Self { span, text }
    }

    /// Makes the edit that inserts a text at the byte offset `at`.
    pub fn insert(source: SourceId, at: usize, text: impl Into<String>) -> Self {
        Self::new(Span::new(source, at, at), text)
    }

    /// Makes the edit that adds fields at the end of a block: on the line of its `}`, or on lines
    /// of their own if the `}` starts a line. Returns `None` if the block is not in the file or not
    /// closed.
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
                // If no field stands on a line of its own, the new fields are indented by two
                // columns more than the `}`.
                let deeper = if last.ends_with('{') || !tight.contains('\n') {
                    format!("{indent}  ")
                } else {
                    last.chars().take_while(|c| c.is_whitespace()).collect()
                };
                let lines = fields.iter().map(|it| format!("{line_end}{deeper}{it}"));
                (at, lines.collect())
            }
            None if tight.ends_with('{') => (at + gap.len(), format!(" {} ", fields.join("  "))),
            None => (at + gap.len(), format!("  {} ", fields.join("  "))),
        };
        Some(Self::new(Span::new(SourceId::File, at, end), added))
    }

    /// Makes the edit that removes the text at `span`. If nothing else stands on its line, removes
    /// the whole line. Otherwise, also removes the white space on one side, so that the words on
    /// both sides remain separated.
    pub fn remove(span: Span, sources: &Sources) -> Self {
        Self::remove_in(span, sources.get(span.source).text())
    }

    /// Makes the same edit as [`Self::remove`], for callers that have no [`Sources`]. `text` is the
    /// whole text of the span's source.
    pub fn remove_in(span: Span, text: &str) -> Self {
        let Span { source, start, end } = span;
        let before = text.get(..start).unwrap_or_default();
        let after = text.get(end..).unwrap_or_default();
        let outer = before.trim_end_matches(BLANK);
        let rest = after.trim_start_matches(BLANK);
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
        let end = if rest.starts_with([')', ']', ',']) {
            length - rest.len()
        } else {
            end
        };
        Self::new(Span::new(source, outer.len(), end), text)
    }

    /// Returns whether the edit removes a comment together with other text, or joins two words.
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
        let joins = |middle: &str| {
            if middle.is_empty() {
                [before.ends_with(is_word) && after.starts_with(is_word); 2]
            } else {
                [
                    before.ends_with(is_word) && middle.starts_with(is_word),
                    middle.ends_with(is_word) && after.starts_with(is_word),
                ]
            }
        };
        let (old, new) = (joins(taken), joins(&self.text));
        ["//", "/*", "# ", "--"].into_iter().any(is_comment)
            || (0..2).any(|side| new[side] && !old[side])
    }
}

/// Applies the edits of `fix` that belong to `source` to `text`, the text of this source, and
/// returns the result.
///
/// The spans of all fixes refer to the text in which the problems were found, and do not fit the
/// result. So never apply a second fix to the result: parse the result again, or use
/// [`Mistakes::fixed`](super::Mistakes::fixed), which applies the fixes of all mistakes.
///
/// ```
/// use pinhole::{Scene, diagnostic::apply, source::SourceId};
///
/// let text = "camera { eye (0, 2, 8)  lookt (0, 1, 0) }  checkerboard {}";
/// let mistakes = Scene::parse(text).unwrap_err();
/// let fix = &mistakes.iter().next().unwrap().fixes[0];
/// let text = apply(fix, SourceId::File, text);
/// assert_eq!(text, "camera { eye (0, 2, 8)  lookat (0, 1, 0) }  checkerboard {}");
/// ```
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
