//! Reads the indices of a block, such as `for i < 8`. They stand in its head, between the name of
//! the object and the `{`.

use super::{Recovery, head, is_name};
use crate::{
    diagnostic::{Edit, Fix},
    source::Span,
    syntax::{
        messages as say,
        problem::{replace, shorten},
        tokens::{TokenKind, is_name_char},
        tree::{Block, Index, Repetition, ValueKind},
    },
};

impl<'s> Recovery<'_, 's> {
    /// Returns whether indices, as in `for i < 8`, start at the token `ahead` tokens after the next
    /// one. A `for` at the start of a line is a statement of another language instead.
    pub(super) fn is_repetition(&mut self, ahead: usize) -> bool {
        let words = ["for", "foreach", "loop", "repeat", "while"];
        let is_word = words.contains(&self.word(ahead)) && !self.is_on_new_line(ahead);
        let next = ahead + 1;
        is_word
            && (self.kind(next) == TokenKind::Name
                || self.is(next, "(")
                || self.kind(next) == TokenKind::Number)
    }

    /// Reads the indices of a block, such as `for i < 8, j < i`, if there are any. If they contain
    /// a mistake, skips the text up to the `{` and reports it as one mistake. Returns `false` if
    /// the indices have a mistake and neither a `{` nor a field follows. The block then ends here.
    pub(super) fn indices(&mut self, block: &mut Block<'s>) -> bool {
        if !self.is_repetition(0) {
            return true;
        }
        let problems_before = self.problems.len();
        let kind = block.kind.map_or("", |kind| kind.text);
        let (is_for, keyword) = (self.is(0, "for"), self.bump());
        let mut repetition = Repetition {
            keyword,
            indices: Vec::new(),
        };
        let mut goes_on = is_for;
        while goes_on && self.is_name(0) && self.is(1, "<") {
            let index = self.index();
            goes_on = index.comma.is_some();
            repetition.indices.push(index);
        }
        let is_end = matches!(self.word(0), "{" | "}") || self.is_on_new_line(0);
        let is_right =
            !repetition.indices.is_empty() && !goes_on && (is_end || self.starts_fields(kind));
        if !is_right {
            while matches!(self.word(0), "(" | "let") {
                self.bump();
            }
            while !matches!(self.word(0), "{" | "}" | "let")
                && self.kind(0) != TokenKind::End
                && !self.starts_fields(kind)
                && !(self.is_on_new_line(0) && (self.is_head(0) || self.starts_item()))
            {
                self.bump();
            }
            let span = keyword.to(self.behind());
            if self.problems.len() == problems_before {
                self.bad_repetition(span, block.name.is_some());
            }
            block.bad.push(span);
            repetition.indices.clear();
        }
        block.repetition = Some(Box::new(repetition));
        is_right || self.is(0, "{") || self.starts_fields(kind)
    }

    /// Returns whether the next token starts a field of a block of kind `kind`, with its value. If
    /// so, the block's `{` is missing.
    pub(super) fn starts_fields(&mut self, kind: &str) -> bool {
        let is_field = self.is_name(0) && self.words.takes(kind, self.word(0)).is_some();
        is_field && self.starts_value(1) && !self.is(1, "<")
    }

    fn bad_repetition(&mut self, span: Span, has_name: bool) {
        let written = self.written(span);
        let slip = head::slip(written, has_name);
        let fix = slip.right.map(|right| replace(span, right));
        let is_char = |c: char| !c.is_ascii_alphanumeric();
        let words = |text| str::split(text, is_char).filter(|word| !word.is_empty());
        // The fix is safe if it keeps all words and only changes other characters.
        let mut edits = fix.iter().flat_map(|fix| &fix.edits);
        let is_safe = edits.all(|edit| words(&edit.text).eq(words(written)));
        let [start, end] = [slip.at.start, slip.at.end].map(|at| span.start + at);
        let at = Span::new(self.id, start, end);
        self.report_head(at, slip.said, &slip.help, fix, is_safe);
    }

    /// Reports a mistake in the indices of an object, such as `for i <= 7`. An empty `said` or
    /// `help` is replaced by a general explanation of indices.
    pub(super) fn report_head(
        &mut self,
        at: Span,
        said: &str,
        help: &str,
        fix: impl Into<Option<Fix>>,
        is_safe: bool,
    ) {
        let or = |text, other| if str::is_empty(text) { other } else { text };
        let words = [or(said, say::REPEATED), or(help, say::REPEATED_SO)];
        let said = say::BAD_REPETITION.safe_if(is_safe);
        self.report(&said, at, &words, fix);
    }

    /// Reports a name with a count: `Ball[8]`, `Ball[i] for i < 8`, or `i < 8` in place of a name.
    /// `rest` is the span of the text before the `for` or the `{`. Returns `false` and reports
    /// nothing if the text is none of these.
    pub(super) fn counted_name(&mut self, kind: &str, rest: Span) -> bool {
        let written = self.written(rest);
        let id = self.id;
        let part = |from, to| Span::new(id, rest.start + from, rest.start + to);
        if let Some(open) = written.find('[') {
            let (name, index) = written.split_at(open);
            let inner = index.trim_matches(['[', ']', ' ']);
            let (at, is_repeated) = (part(open, written.len()), self.is_repetition(0));
            let fix = Fix::new(format!("write `{kind} {name}`"), [Edit::new(at, "")]);
            let said = if is_repeated {
                "the objects of a head with indices are numbered by themselves"
            } else {
                "a count stands in a `for`"
            };
            let head = format!("{kind} {name}");
            let head = head.trim_end();
            let head = if is_name(inner) && !self.words.is_let(inner) {
                format!("write `{head} for {inner} < 8 {{` with the number of its values")
            } else {
                format!("write `{head} for i < {inner} {{`, and use `i` in the values")
            };
            self.report_head(at, said, &head, Some(fix).filter(|_| is_repeated), false);
            return true;
        }
        let Some((before, _)) = written.split_once('<').filter(|_| !self.is_repetition(0)) else {
            return false;
        };
        let before = before.trim_end();
        let name = before.bytes().rev().take_while(|byte| is_name_char(*byte));
        let start = before.len() - name.count();
        let index = format!("for {}", written.get(start..).unwrap_or_default());
        let slip = head::slip(&index, true);
        let fix = (slip.right.is_some() && slip.said.is_empty()).then(|| {
            let edit = Edit::insert(self.id, rest.start + start, "for ");
            Fix::new(format!("write `{}`", shorten(&index)), [edit])
        });
        self.report_head(
            part(start, written.len()),
            "an index stands behind a `for`",
            "",
            fix,
            true,
        );
        true
    }

    /// Reads an index with its count and the comma after it, as in `i < 8,`. Reports `<=`, as in `i
    /// <= 7`.
    pub(super) fn index(&mut self) -> Index<'s> {
        let (name, less) = (self.name(), self.bump());
        let equal = self.is(0, "=").then(|| self.bump());
        let count = self.expression();
        if let Some(equal) = equal {
            let sign = less.to(equal);
            let behind = match (&count.kind, self.written(count.span).parse::<u32>()) {
                (ValueKind::Number(_), Ok(last)) => format!("{}", u64::from(last) + 1),
                _ => format!("{} + 1", self.written(count.span)),
            };
            let right = format!("{} < {behind}", name.text);
            let title = format!("write `{}`: an index begins at 0", shorten(&right));
            let whole = name.span.to(count.span);
            let fix = Fix::new(title, [Edit::new(whole, right)]);
            self.report(&say::COUNT_WITH_LAST, sign, &[], fix);
        }
        let comma = self.is(0, ",").then(|| self.bump());
        Index {
            name,
            less,
            count,
            comma,
        }
    }
}
