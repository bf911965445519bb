//! What other languages write and this one has not: statements, comments by `#` and `--`, and whole files.

use super::Recovery;
use crate::{
    diagnostic::{Edit, Fix},
    source::Span,
    syntax::{
        problem::{problem, shorten},
        tokens::{Lexer, line_end},
    },
};

/// A comment of another language.
pub(super) struct Comment {
    /// `#` or `--`.
    sign: Span,
    /// With its sign.
    pub(super) whole: Span,
    /// Whether it is known where it ends.
    is_sure: bool,
}

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
const STATEMENTS: &[(&[&str], &str, &str)] = &[
    (
        &["if", "else", "switch", "case"],
        "conditions",
        "write what holds; `min` and `max` choose between two numbers",
    ),
    (
        &["for", "while", "loop", "repeat", "foreach"],
        "loops",
        "write each object by itself, or write the file by a program",
    ),
    (
        &["import", "include", "require", "use", "#include"],
        "including of other files",
        "write all of a scene into one file",
    ),
    (
        &[
            "#version", "#declare", "#local", "#macro", "#define", "#if", "#end",
        ],
        "directives",
        "name a value with `let NAME = VALUE`; a comment begins with `//`",
    ),
    (
        &["print", "echo", "printf", "console"],
        "output",
        "take it away; `pinhole inspect` shows what a scene's values are",
    ),
    (
        &[
            "function", "fn", "def", "fun", "lambda", "return", "class", "struct",
        ],
        "functions of one's own",
        "give each result a name with `let NAME = VALUE`",
    ),
];

/// What a statement of another language is, and what to do instead.
pub(super) fn statement(word: &str) -> Option<(&'static str, &'static str)> {
    let row = STATEMENTS.iter().find(|(words, ..)| words.contains(&word));
    row.map(|&(_, what, help)| (what, help))
}

impl Recovery<'_, '_> {
    pub(super) fn not_in_language(&mut self, what: &str, help: &str, span: Span) {
        let message = format!("the language has no {what}");
        let label = "not a part of the language";
        self.problems
            .push(problem("not_in_language", message, span, label).with_help(help));
    }

    /// `if (a > 0) {`, `for i in 0..10 {`, `import "x"`, `print(r)`: passed over, with what stands in braces behind it.
    pub(super) fn foreign_statement(&mut self, what: &str, help: &str) {
        let span = self.bump();
        self.not_in_language(what, help, span);
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
        let is_dashed = word == "-" && self.is(1, "-") && self.is_adjacent(1);
        is_dashed
            && match place {
                Place::Start => true,
                Place::Value => false,
                // `1 -- big`, but a difference in `1 --b` and `1 -- b`.
                Place::Operator => {
                    let name = self.word(2);
                    self.is_name(2)
                        && !self.is_adjacent(2)
                        && !self.is_on_new_line(2)
                        && !self.is(3, "(")
                        && !self.words.is_value(name)
                }
            }
    }

    /// Whether words follow a `#` that stands in place of a value, rather than the digits or the name of a colour.
    fn is_remark(&mut self) -> bool {
        let word = self.word(1);
        let is_lone_color = self.words.is_color(word) && !self.is_on_new_line(2);
        self.is(1, "#") || (self.is_name(1) && !is_color_code(word) && !is_lone_color)
    }

    /// It ends with its line, or before the `}` of a block that was opened in its line.
    fn foreign_comment(&mut self) {
        let token = self.peek(0);
        let rest = self.text.get(token.start..).unwrap_or_default();
        let first = rest.chars().next().unwrap_or('#');
        let length = rest.len() - rest.trim_start_matches(first).len();
        let end = line_end(self.text, token.start);
        let line = self.text.get(token.start..end).unwrap_or_default();
        let before = self.text.get(..token.start).unwrap_or_default();
        let before = before.rsplit('\n').next().unwrap_or_default();
        let kept = match before.matches('{').count() > before.matches('}').count() {
            true => line.trim_end_matches([' ', '\t', '}']),
            false => line,
        };
        let end = token.start + kept.len();
        self.comments.push(Comment {
            sign: Span::new(self.id, token.start, token.start + length.min(kept.len())),
            whole: Span::new(self.id, token.start, end),
            is_sure: kept.len() == line.len() || self.lists == 0,
        });
        self.seek(end);
    }

    pub(super) fn comment_end(&self) -> usize {
        self.comments.last().map_or(0, |comment| comment.whole.end)
    }

    /// One report for comments in lines that follow each other without anything between.
    pub(super) fn report_comments(&mut self) {
        let is_next = |a: &Comment, b: &Comment| {
            let between = self.text.get(a.whole.end..b.whole.start);
            between.is_some_and(|between| between.trim().is_empty())
        };
        let mut found = Vec::new();
        for group in self.comments.chunk_by(is_next) {
            let Some(first) = group.first() else { continue };
            let below = match group.len() - 1 {
                0 => String::new(),
                1 => ", here and in the next line".to_owned(),
                more => format!(", here and in the next {more} lines"),
            };
            let sign = self.short(first.sign);
            let words = self.text.get(first.sign.end..first.whole.end);
            let words = words.unwrap_or_default().trim_end();
            let after = self.text.get(first.whole.end..).unwrap_or_default();
            let fix = match after.is_empty() || after.starts_with(['\n', '\r']) {
                true => Fix::new(
                    format!("write `{}`", shorten(&format!("//{words}"))),
                    group.iter().map(|comment| Edit::new(comment.sign, "//")),
                ),
                false => Fix::new(
                    format!("write `{}`", shorten(&format!("/*{words} */"))),
                    [
                        Edit::new(first.sign, "/*"),
                        Edit::insert(self.id, first.whole.end, " */"),
                    ],
                ),
            };
            let message = format!("a comment begins with `//`, not with `{sign}`{below}");
            let new = problem(
                "comment_sign",
                message,
                first.sign,
                "`//` should stand here",
            );
            let fix = Some(fix).filter(|_| first.is_sure);
            found.push(new.with_fix_or(
                fix,
                "write `//`, and the comment takes the rest of the line",
            ));
        }
        self.problems.extend(found);
    }

    /// `/* /* */ c */`: the first `*/` ended the comment.
    pub(super) fn nested_comment(&mut self) -> bool {
        const ENOUGH: usize = 64;
        let start = self.here().start;
        let before = self.text.get(..start).unwrap_or_default();
        let Some(comment) = before.trim_end().strip_suffix("*/") else {
            return false;
        };
        let Some(second) = comment.rfind("/*") else {
            return false;
        };
        let outer = comment.get(..second).unwrap_or_default();
        let is_end = |ahead: &usize| {
            self.is(*ahead, "*") && self.is(ahead + 1, "/") && self.is_adjacent(ahead + 1)
        };
        let Some(ahead) = (0..ENOUGH).find(is_end).filter(|_| outer.contains("/*")) else {
            return false;
        };
        let close = self.peek(ahead).start;
        let [inner, inner_close, close] =
            [second, comment.len(), close].map(|at| Span::new(self.id, at, at + 2));
        let message = "comments do not nest: the first `*/` ends this one";
        let edits = [Edit::new(inner, ""), Edit::new(inner_close, "")];
        self.problems.push(
            problem(
                "nested_comment",
                message,
                inner,
                "this opens no other comment",
            )
            .with_label(close, "so this closes none")
            .with_fix(Fix::new("take the inner `/*` and `*/` away", edits)),
        );
        while self.here().start < close.end {
            self.bump();
        }
        true
    }

    // Files.

    /// A whole file of another program is one mistake.
    pub(super) fn foreign_file(&mut self) -> bool {
        let Some(what) = kind_of_file(self.text) else {
            return false;
        };
        let first = Lexer::past_comments(self.text, 0);
        let message = format!("this looks like {what}, not like a scene of Pinhole");
        let help = "the smallest scene is `camera { eye (0, 2, 8)  lookat (0, 1, 0) }` and `sphere { center (0, 1, 0) }`";
        self.items.clear();
        self.problems.push(
            problem(
                "foreign_file",
                message,
                self.span_of(first),
                "no scene starts like this",
            )
            .with_help(help),
        );
        self.cut = Some(0);
        true
    }
}

/// Whether these are the digits of a colour.
pub(super) fn is_color_code(digits: &str) -> bool {
    matches!(digits.len(), 3 | 6) && digits.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// The kind of file that a text looks like which is no scene at all, by its start.
fn kind_of_file(text: &str) -> Option<&'static str> {
    const ENOUGH: usize = 1 << 14;
    const POV: &[&str] = &[
        "light_source",
        "#declare",
        "#version",
        "#include",
        "pigment",
        "global_settings",
    ];
    const PBRT: &[&str] = &[
        "LookAt ",
        "Camera \"",
        "WorldBegin",
        "Shape \"",
        "Film \"",
        "Integrator \"",
        "Sampler \"",
        "AttributeBegin",
    ];
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let mut end = ENOUGH.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let text = text.get(..end)?;
    let lines = || text.lines().map(str::trim_start).filter(|l| !l.is_empty());
    let starting = |words: &[&str]| {
        let starts = |line: &&str| words.iter().any(|word| line.starts_with(word));
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
    } else if starting(PBRT) > 1 {
        Some("a scene of pbrt")
    } else if keys > 2 && keys * 3 >= lines().count() * 2 && !text.contains(['{', '=']) {
        Some("YAML")
    } else {
        None
    }
}
