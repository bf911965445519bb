//! What other languages write and this one has not: statements, comments by `#` and `--`, and whole
//! files.

use memchr::memmem;

use super::Recovery;
use crate::{
    diagnostic::{Edit, Fix},
    source::Span,
    syntax::{
        messages::{self as say, FOREIGN_FILES, statement},
        tokens::{Lexer, is_color_code, line_end},
        tree::Item,
    },
};

/// What may stand in a place: what starts a comment differs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// An item or a field.
    Start,
    /// A value.
    Value,
    /// An operator, or what follows a value.
    Operator,
}

impl Recovery<'_, '_> {
    /// `if (a > 0) {`, `for i in 0..10 {`, `import "x"`, `print(r)`: passed over, with what stands
    /// in braces behind it.
    pub(super) fn foreign_statement(&mut self, said: [&str; 2]) {
        let span = self.bump();
        self.report(&say::NOT_IN_LANGUAGE, span, &said, None);
        while !(self.is_on_new_line(0) || self.is(0, "{") || self.is(0, "}")) {
            self.bump();
        }
        // What it may have defined is no second mistake.
        self.items.push(Item::Bad(span.to(self.behind())));
        if self.is(0, "{") {
            self.bump();
            self.skip_block();
        }
    }

    /// Passes over comments of other languages. They end with their line, or before the `}` of a
    /// block that was opened in it.
    pub(super) fn comments(&mut self, place: Place) {
        while self.starts_comment(place) {
            let start = self.here().start;
            let line = self.written(Span::new(self.id, start, line_end(self.text, start)));
            let before = self.line_before(start);
            let kept = match before.matches('{').count() > before.matches('}').count() {
                true => line.trim_end_matches([' ', '\t', '}']),
                false => line,
            };
            let end = start + kept.len().max(1);
            let sign = if line.starts_with('#') { 1 } else { 2 };
            let place = Span::new(self.id, start, start + sign);
            // A comment with the right sign would take the brace, too.
            if kept.len() < line.len() {
                let words = [self.written(place), ""];
                self.report(&say::COMMENT_SIGN, place, &words, None);
            } else {
                self.slip(place);
            }
            self.seek(end);
        }
    }

    fn starts_comment(&mut self, place: Place) -> bool {
        let word = self.word(0);
        if let Some(digits) = word.strip_prefix('#') {
            return match place {
                Place::Start => statement(word).is_none(),
                Place::Operator => !(is_color_code(digits) && self.lists > 0),
                Place::Value => digits.is_empty() && !self.is_on_new_line(1) && self.is_remark(),
            };
        }
        // `1 -- big`, but a difference in `1 --b` and `1 -- b`.
        let name = self.word(2);
        let is_remark = self.is_name(2)
            && !self.is_adjacent(2)
            && !self.is_on_new_line(2)
            && !self.is(3, "(")
            && !self.words.is_value(name);
        word == "-"
            && self.is(1, "-")
            && self.is_adjacent(1)
            && (place == Place::Start || (place == Place::Operator && is_remark))
    }

    /// Whether words follow a `#` that stands in place of a value, rather than the digits or the
    /// name of a colour.
    fn is_remark(&mut self) -> bool {
        let word = self.word(1);
        let is_lone_color = self.words.is_color(word) && !self.is_on_new_line(2);
        self.is(1, "#") || (self.is_name(1) && !is_color_code(word) && !is_lone_color)
    }

    /// `/* /* */ c */`: the first `*/` ended the comment.
    pub(super) fn nested_comment(&mut self) -> bool {
        const ENOUGH: usize = 64;
        let start = self.here().start;
        let before = self.text.get(..start).unwrap_or_default();
        let comment = before.trim_end().strip_suffix("*/").unwrap_or_default();
        let Some(second) = comment.rfind("/*") else {
            return false;
        };
        let outer = comment.get(..second).unwrap_or_default();
        let is_end = |i: &usize| self.is(*i, "*") && self.is(i + 1, "/") && self.is_adjacent(i + 1);
        let Some(ahead) = (0..ENOUGH).find(is_end).filter(|_| outer.contains("/*")) else {
            return false;
        };
        let close = self.peek(ahead).start;
        let [inner, inner_close, close] =
            [second, comment.len(), close].map(|at| Span::new(self.id, at, at + 2));
        let edits = [Edit::new(inner, ""), Edit::new(inner_close, "")];
        let fix = Fix::new("take the inner `/*` and `*/` away", edits);
        self.report(&say::NESTED_COMMENT, inner, &[], fix);
        self.seek(close.end);
        true
    }

    /// A whole file of another program is one mistake.
    pub(super) fn foreign_file(&mut self) -> bool {
        const ENOUGH: usize = 1 << 14;
        let text = self.text.get(..self.source.floor_char_boundary(ENOUGH));
        let text = text.unwrap_or_default().trim_start_matches('\u{feff}');
        let first = Lexer::new(self.text, 0).seen_token();
        let ink = self.text.get(first.start..).unwrap_or_default();
        let ink = ink.chars().filter(|c| !c.is_whitespace());
        let ink: String = ink.take(5).collect();
        let times = |mark: &str| memmem::find_iter(text.as_bytes(), mark).count();
        let count = |marks: &str| marks.split('|').map(times).sum::<usize>();
        let is_it = |row: &&(&str, &str, &str, usize, &str, &str)| {
            row.1.split(' ').any(|start| ink.starts_with(start))
                && !row.4.chars().any(|other| text.contains(other))
                && count(row.2) >= row.3
        };
        let Some((what, .., more)) = FOREIGN_FILES.iter().find(is_it) else {
            return false;
        };
        let place = Span::new(self.id, first.start, first.end);
        self.items.clear();
        self.report(&say::FOREIGN_FILE, place, &[what, more], None);
        self.is_cut = true;
        true
    }
}
