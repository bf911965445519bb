//! Recognizes constructs of other languages: statements, comments that start with `#`, `--` and the
//! like, and whole files.

use memchr::memmem;

use super::Recovery;
use crate::{
    diagnostic::{Diagnostic, Edit, Fix, Label},
    schema::{self, Type},
    source::Span,
    syntax::{
        messages::{self as say, FOREIGN_FILES, statement},
        problem::replace,
        tokens::{Lexer, is_color_code, line_end},
        tree::{Item, Name, Value, bad},
    },
};

/// Maximum number of tokens that are searched for the `?` of a conditional expression, such as `a >
/// b ? c : d`. An expression whose `?` comes later is not recognized as a condition. The limit
/// bounds the time of the search; the text before a `?` is usually shorter.
const CONDITION_TOKENS: usize = 24;

/// Position where a comment of another language may start. The position decides which tokens start
/// a comment: a `#` before a value, for example, may also start a colour code.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum CommentPosition {
    /// Before an item or a field.
    Start,
    /// Before a value.
    Value,
    /// After a value, where an operator may follow.
    Operator,
}

/// Characters of mathematical notation and of other languages. A row holds several characters, the
/// help for a character in place of a value, and the help for a character after a value.
#[rustfmt::skip]
const NOTATION: &[(&str, [&str; 2])] = &[
    ("π", ["write `pi`", "write `* pi`"]),
    ("√", ["write `sqrt(2)` for the square root of 2", "write `* sqrt(2)` for times the square root of 2"]),
    ("²³⁴ⁿ", ["write a product, such as `r * r`"; 2]),
    ("½", ["write `0.5`", "write `+ 0.5`"]),
    ("|", ["write `abs(x)` for the size of x, or `length(v)`"; 2]),
    ("\\", ["write formulas as in `1 / 2` and `2 * pi`, without `\\`"; 2]),
    ("?", ["there are no conditions: `pinhole explain condition` says what to write instead"; 2]),
];

/// Help for the operator `%`. The part after the colon is also the help for a condition such as `i
/// % 2 == 0 ? red : blue`, which chooses between colours.
pub(super) const TURNS: &str = "there is no remainder: of objects with indices, a pair of colours, `color (gray, white)`, takes turns, and `for i < 8, j < 2` counts in rows";

/// Returns the help for `word` if it contains a character of mathematical notation or of another
/// language, such as `π`. Otherwise, returns `None`. `is_behind` says that the word follows a
/// value.
pub(super) fn help_for_notation(word: &str, is_behind: bool) -> Option<&'static str> {
    let is_in = |row: &&(&str, _)| row.0.chars().any(|character| word.contains(character));
    let (_, [value, behind]) = NOTATION.iter().find(is_in)?;
    Some(if is_behind { behind } else { value })
}

impl<'s> Recovery<'_, 's> {
    /// Reports and skips a statement of another language, such as `if (a > 0) {`, `for i in 0..10
    /// {`, `import "x"` or `print(r)`, and the block that follows it. `said` holds a plural noun
    /// for such statements and the help, from [`statement`].
    pub(super) fn foreign_statement(&mut self, said: [&str; 2]) {
        let span = self.bump();
        self.report(&say::NOT_IN_LANGUAGE, span, &said, None);
        while !(self.is_on_new_line(0) || self.is(0, "{") || self.is(0, "}")) {
            self.bump();
        }
        // The statement may define names, so it becomes a `Bad` item: names in such an item are not
        // reported as undefined later.
        self.items.push(Item::Bad(span.to(self.behind())));
        if self.is(0, "{") {
            self.bump();
            self.skip_block();
        }
    }

    /// Reads and reports a name from a library, such as `Math.sin(a)`, `np.cos(a)` or
    /// `std::f64::consts::PI`. `first` is the name's first word. The last word must be a function
    /// of the language or `pi`. Returns `None` for any other text, or if the file defines `first`.
    pub(super) fn library_name(&mut self, first: Name<'s>) -> Option<Value<'s>> {
        let mut last = 0;
        loop {
            let signs = match (self.word(last), self.word(last + 1)) {
                (".", _) => 1,
                (":", ":") => 2,
                _ => break,
            };
            if !(self.is_adjacent(last) && self.is_name(last + signs)) {
                break;
            }
            last += signs + 1;
        }
        let word = self.word(last.checked_sub(1)?).to_ascii_lowercase();
        let row = schema::function(&word);
        let text = row.map(|row| row.name).or((word == "pi").then_some("pi"))?;
        if self.words.is_let(first.text) {
            return None;
        }
        let mut span = first.span;
        for _ in 0..last {
            span = span.to(self.bump());
        }
        let words = [&*self.short(span), text];
        self.report(&say::FOREIGN_NAME, span, &words, replace(span, text));
        if row.is_some() && self.is(0, "(") {
            self.call(Name { text, span });
        }
        Some(bad(span.to(self.behind())))
    }

    /// Returns whether the next tokens contain a `?` that may belong to the current value. The
    /// value is then probably a condition such as `a > b ? c : d`.
    fn has_question_mark(&mut self) -> bool {
        for at in 0..CONDITION_TOKENS {
            match self.word(at) {
                "?" => return true,
                "" | "{" | "}" | "let" => return false,
                _ if at > 0 && self.is_on_new_line(at) => return false,
                _ => {}
            }
        }
        false
    }

    /// Reports and skips a condition, such as `> 1 ? a : b` after an operand, or `if n > 1 then a`.
    /// Returns `false`, and skips nothing, if no condition starts at the next token.
    pub(super) fn condition(&mut self) -> bool {
        let is_one = match self.word(0) {
            "if" => !self.words.is_let("if"),
            ">" | "<" | "!" | "&" | "|" | "?" => self.has_question_mark(),
            "=" => self.is(1, "=") && self.has_question_mark(),
            _ => false,
        };
        if !is_one {
            return false;
        }
        let (start, mut open) = (self.here(), 0_usize);
        loop {
            let word = self.word(0);
            let is_outside = self.lists == 0
                && (self.last_end > start.start && self.is_on_new_line(0)
                    || self.is_field_name(word) && self.starts_value(1));
            let is_end = self.lists > 0 && open == 0 && matches!(word, ")" | "]" | ",");
            match word {
                "" | "{" | "}" | "let" => break,
                _ if is_outside || is_end => break,
                "(" => open += 1,
                ")" => open = open.saturating_sub(1),
                _ => {}
            }
            self.bump();
        }
        let span = start.to(self.behind());
        // In `i % 2 == 0 ? red : blue`, the remainder and the condition are reported as one
        // mistake.
        let of_remainder = |it: &Diagnostic| it.message == "there is no operator `%`";
        let last = self.problems.last().filter(|it| of_remainder(it));
        let of_color = matches!(self.context.takes, Some(Type::Color | Type::Colors));
        let mut said = statement("if").unwrap_or_default();
        if of_color || last.is_some() {
            said[1] = TURNS.trim_start_matches("there is no remainder: ");
        }
        let is_new = |label: &Label| label.span.start < start.start;
        if last.and_then(|it| it.labels.first()).is_some_and(is_new) {
            self.problems.truncate(self.problems.len() - 1);
        }
        self.report(&say::NOT_IN_LANGUAGE, span, &said, None);
        true
    }

    /// Skips comments of other languages, and records their first characters, such as `#`, for a
    /// report. A comment ends at the end of its line. A `}` at the end of the line is not skipped
    /// if it closes a block that was opened on this line, as in `camera { # the eye }`.
    pub(super) fn comments(&mut self, place: CommentPosition) {
        while self.starts_comment(place) {
            let start = self.here().start;
            let line = self.written(Span::new(self.id, start, line_end(self.text, start)));
            let before = self.line_before(start);
            let kept = if before.matches('{').count() > before.matches('}').count() {
                line.trim_end_matches([' ', '\t', '}'])
            } else {
                line
            };
            let end = start + kept.len().max(1);
            let sign = if line.starts_with(['#', '%']) { 1 } else { 2 };
            let place = Span::new(self.id, start, start + sign);
            // If a `}` at the end of the line is not part of the comment, there is no fix: with
            // `//` in place of the characters that start the comment, the comment would include
            // that `}`.
            if kept.len() < line.len() {
                let words = [self.written(place), ""];
                self.report(&say::COMMENT_SIGN, place, &words, None);
            } else {
                self.note_sign(place);
            }
            self.seek(end);
        }
    }

    fn starts_comment(&mut self, place: CommentPosition) -> bool {
        let word = self.word(0);
        if let Some(digits) = word.strip_prefix('#') {
            return match place {
                CommentPosition::Start => statement(word).is_none(),
                CommentPosition::Operator => !(is_color_code(digits) && self.lists > 0),
                CommentPosition::Value => {
                    digits.is_empty() && !self.is_on_new_line(1) && self.is_remark()
                }
            };
        }
        if matches!(word, ";" | "%") {
            let is_place = place == CommentPosition::Start
                || (word == "%" && place == CommentPosition::Operator);
            return is_place && self.is_prose();
        }
        // Between values, `--` starts a comment if a blank and an unknown name follow, as in `1 --
        // big`. Otherwise, as in `1 --b`, the first `-` subtracts and the second one is a sign.
        let name = self.word(2);
        let is_remark = self.is_name(2)
            && !self.is_adjacent(2)
            && !self.is_on_new_line(2)
            && !self.is(3, "(")
            && !self.words.is_value(name);
        word == "-"
            && self.is(1, "-")
            && self.is_adjacent(1)
            && (place == CommentPosition::Start
                || (place == CommentPosition::Operator && is_remark))
    }

    /// Returns whether the next token starts a comment in plain words: it is `;;`, or unknown words
    /// follow it in its line, as in `; a comment`.
    fn is_prose(&mut self) -> bool {
        let mut is_word = |at| {
            let word = self.word(at);
            let is_known = self.words.is_value(word) || self.is_field_name(word);
            self.is_name(at) && !is_known && !self.is_kind(at)
        };
        let are_words = [is_word(1), is_word(2)];
        let is_end = self.is_on_new_line(2) && (self.is_name(2) || !self.starts_value(2));
        let is_double = self.is(0, ";") && self.is(1, ";") && self.is_adjacent(1);
        is_double
            || (are_words[0] && (are_words[1] || is_end))
                && !self.is_adjacent(1)
                && !self.is_on_new_line(1)
    }

    /// Returns whether the words after a `#` that stands in place of a value are a comment, rather
    /// than the digits or the name of a colour.
    fn is_remark(&mut self) -> bool {
        let word = self.word(1);
        let is_lone_color = self.words.is_color(word) && !self.is_on_new_line(2);
        self.is(1, "#") || (self.is_name(1) && !is_color_code(word) && !is_lone_color)
    }

    /// Reports and skips the rest of nested comments. In `/* /* */ c */`, the first `*/` ended the
    /// comment, so `c */` is the rest. Returns `false` and skips nothing if the text is not such a
    /// rest.
    pub(super) fn nested_comment(&mut self) -> bool {
        // Maximum number of tokens that are searched for a later `*/`, the intended end of the
        // comment. If no `*/` is found, the text is not recognized as the rest of a comment. The
        // limit bounds the time of the search.
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

    /// Reports a file of another program as one mistake. Returns whether the text is such a file.
    pub(super) fn foreign_file(&mut self) -> bool {
        // Number of bytes that are searched, from the start of the file, for strings typical of
        // other programs' files. Such strings usually occur near the start. The limit bounds the
        // time for a large file.
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
