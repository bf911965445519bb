//! What other languages write and this one has not: statements, comments by `#` and `--`, and whole files.

use super::Recovery;
use crate::{
    diagnostic::{Edit, Fix, Label},
    source::Span,
    syntax::{
        messages as say,
        problem::shorten,
        tokens::{Lexer, line_end},
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

/// What other languages say: the words that start it, what it is, and what to do instead.
const STATEMENTS: &[[&str; 3]] = &[
    [
        "if else switch case",
        "conditions",
        "write what holds; `min` and `max` choose between two numbers",
    ],
    [
        "for while loop repeat foreach",
        "loops",
        "write each object by itself, or write the file by a program",
    ],
    [
        "import include require use #include",
        "including of other files",
        "write all of a scene into one file",
    ],
    [
        "#version #declare #local #macro #define #if #end",
        "directives",
        "name a value with `let NAME = VALUE`; a comment begins with `//`",
    ],
    [
        "print echo printf console",
        "output",
        "take it away; `pinhole inspect` shows what a scene's values are",
    ],
    [
        "function fn def fun lambda return class struct",
        "functions of one's own",
        "give each result a name with `let NAME = VALUE`",
    ],
];

/// What a statement of another language is, and what to do instead.
pub(super) fn statement(word: &str) -> Option<[&'static str; 2]> {
    let is_one = |row: &&[&str; 3]| row[0].split(' ').any(|start| start == word);
    STATEMENTS.iter().find(is_one).map(|row| [row[1], row[2]])
}

/// Whether these are the digits of a colour.
pub(super) fn is_color_code(digits: &str) -> bool {
    matches!(digits.len(), 3 | 6) && digits.bytes().all(|digit| digit.is_ascii_hexdigit())
}

impl Recovery<'_, '_> {
    /// `if (a > 0) {`, `for i in 0..10 {`, `import "x"`, `print(r)`: passed over, with what stands in braces behind it.
    pub(super) fn foreign_statement(&mut self, said: [&str; 2]) {
        let span = self.bump();
        self.report(&say::NOT_IN_LANGUAGE, span, &said, None);
        while !(self.is_on_new_line(0) || self.is(0, "{") || self.is(0, "}")) {
            self.bump();
        }
        if self.is(0, "{") {
            self.bump();
            self.skip_block();
        }
    }

    // Comments.

    /// Passes over comments of other languages.
    pub(super) fn comments(&mut self, place: Place) {
        while self.starts_comment(place) {
            self.foreign_comment();
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

    /// Whether words follow a `#` that stands in place of a value, rather than the digits or the name of a colour.
    fn is_remark(&mut self) -> bool {
        let word = self.word(1);
        let is_lone_color = self.words.is_color(word) && !self.is_on_new_line(2);
        self.is(1, "#") || (self.is_name(1) && !is_color_code(word) && !is_lone_color)
    }

    /// It ends with its line, or before the `}` of a block that was opened in its line.
    fn foreign_comment(&mut self) {
        let start = self.here().start;
        let line = self.text.get(start..line_end(self.text, start));
        let line = line.unwrap_or_default();
        let sign = if line.starts_with('#') { "#" } else { "--" };
        let before = self.text.get(..start).unwrap_or_default();
        let before = before.rsplit('\n').next().unwrap_or_default();
        let is_open = before.matches('{').count() > before.matches('}').count();
        let kept = match is_open {
            true => line.trim_end_matches([' ', '\t', '}']),
            false => line,
        };
        let end = start + kept.len().max(sign.len());
        self.comments.push(Span::new(self.id, start, end));
        let place = Span::new(self.id, start, start + sign.len());
        // Within a list it may have taken the end of that.
        match self.lists > 0 && kept.len() < line.len() {
            true => self.report(&say::COMMENT_SIGN, place, &[sign, ""], None),
            false => self.slip(place),
        }
        self.seek(end);
    }

    pub(super) fn comment_end(&self) -> usize {
        self.comments.last().map_or(0, |comment| comment.end)
    }

    /// Gives comments their sign; those that end before the end of their line get an end.
    pub(super) fn with_right_signs(&self, signs: &[Span]) -> Fix {
        let mut edits = Vec::new();
        let mut first = String::new();
        for sign in signs {
            let next = self
                .comments
                .partition_point(|comment| comment.start < sign.start);
            let Some(comment) = self.comments.get(next) else {
                continue;
            };
            let written = self.written(*comment).trim_start_matches(['#', '-']);
            let start = Span::new(self.id, sign.start, comment.end - written.len());
            let is_to_end = line_end(self.text, comment.end) == comment.end;
            let (open, close) = if is_to_end { ("//", "") } else { ("/*", " */") };
            edits.push(Edit::new(start, open));
            if !is_to_end {
                edits.push(Edit::insert(self.id, comment.end, close));
            }
            if first.is_empty() {
                first = shorten(&format!("{open}{written}{close}"));
            }
        }
        Fix::new(format!("write `{first}`"), edits)
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
        let is_end = |ahead: &usize| self.is(*ahead, "*") && self.is(ahead + 1, "/");
        let Some(ahead) = (0..ENOUGH).find(is_end).filter(|_| outer.contains("/*")) else {
            return false;
        };
        let close = self.peek(ahead).start;
        let [inner, inner_close, close] =
            [second, comment.len(), close].map(|at| Span::new(self.id, at, at + 2));
        let edits = [Edit::new(inner, ""), Edit::new(inner_close, "")];
        let fix = Fix::new("take the inner `/*` and `*/` away", edits);
        let mut found = say::NESTED_COMMENT.at(inner, &[], fix);
        found.labels.push(Label {
            span: close,
            message: "so this closes none".to_owned(),
        });
        self.problems.push(found);
        while self.here().start < close.end {
            self.bump();
        }
        true
    }

    /// A whole file of another program is one mistake.
    pub(super) fn foreign_file(&mut self) -> bool {
        let Some(what) = kind_of_file(self.text) else {
            return false;
        };
        let first = Lexer::past_comments(self.text, 0);
        self.items.clear();
        self.report(&say::FOREIGN_FILE, self.span_of(first), &[what], None);
        self.cut = Some(0);
        true
    }
}

/// The kind of file that a text looks like which is no scene at all, by its start.
fn kind_of_file(text: &str) -> Option<&'static str> {
    const ENOUGH: usize = 1 << 14;
    const POV: &str = "light_source #declare #version #include pigment global_settings";
    const PBRT: &str = "LookAt Camera WorldBegin Shape Film Integrator Sampler AttributeBegin";
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let end = (0..=ENOUGH.min(text.len()))
        .rev()
        .find(|&end| text.is_char_boundary(end))?;
    let text = text.get(..end)?;
    let lines = || text.lines().map(str::trim_start).filter(|l| !l.is_empty());
    let starting = |words: &str| {
        let starts = |line: &&str| words.split(' ').any(|word| line.starts_with(word));
        lines().filter(starts).count()
    };
    let mut ink = text.chars().filter(|c| !c.is_whitespace());
    let (first, second) = (ink.next()?, ink.next()?);
    let angular = text.matches("location <").count() + text.matches("look_at <").count();
    let is_key = |line: &&str| {
        let key = line.split_once(':').map_or("", |(key, _)| key);
        let key = key.trim_start_matches("- ");
        !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
    };
    let keys = lines().filter(is_key).count();
    if text.starts_with("<?xml") || (first == '<' && text.contains("</")) {
        Some("XML")
    } else if matches!((first, second), ('{', '"') | ('[', '{' | '"')) {
        Some("JSON")
    } else if starting(POV) + angular > 2 {
        Some("a scene of POV-Ray")
    } else if starting(PBRT) > 1 && text.contains('"') {
        Some("a scene of pbrt")
    } else if keys > 2 && keys * 3 >= lines().count() * 2 && !text.contains(['{', '=']) {
        Some("YAML")
    } else {
        None
    }
}
