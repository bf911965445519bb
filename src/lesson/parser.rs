//! Parses the conditions of a lesson.

use serde_json::Value;

use super::{Base, Condition, Expected, Lesson};
use crate::{
    diagnostic::{Diagnostic, Label, Severity},
    source::{Source, SourceId, Span},
    suggest,
};

const BASES: [&str; 4] = ["inspect", "start", "probe", "error"];
const OPERATORS: [&str; 6] = ["=", "<", "<=", ">", ">=", "in"];

/// Parses the conditions of a lesson, which is Markdown. The conditions are in fenced code blocks
/// with the info string `check`. Each line of such a block is empty, a comment that starts with
/// `//`, or a condition `PATH OP VALUE`. A comment may follow the condition.
///
/// - PATH is a JSON pointer below `inspect`, `start` or `probe X Y`, or the word `error`. The
///   pointer may contain the name of a list's element in place of its index:
///   `inspect/objects/Ball/radius`.
/// - OP is `=`, `<`, `<=`, `>`, `>=` or `in`.
/// - VALUE is a JSON value, or the word `start`, which stands for the value at the same path of the
///   lesson's own scene. After `in`, it is a range `20..30`, a list, or `start ± 2%`.
///
/// # Errors
///
/// Returns a diagnostic for each line that is no condition. Returns one diagnostic if there are no
/// conditions at all.
pub fn parse(source: &Source) -> Result<Lesson, Vec<Diagnostic>> {
    let text = source.text();
    let mut checks: Vec<Vec<Condition>> = Vec::new();
    let mut problems = Vec::new();
    // The characters that opened the current fenced block, and whether it is a `check` block.
    let mut fence: Option<(&str, bool)> = None;
    for (line, number) in text.lines().zip(1..) {
        let words = line.trim();
        match fence {
            None => {
                fence = opened_by(line);
                checks.extend(fence.filter(|(_, is_check)| *is_check).map(|_| Vec::new()));
            }
            Some((mark, _)) if words.trim_start_matches(&mark[..1]).is_empty() => {
                fence = fence.filter(|_| !words.starts_with(mark));
            }
            Some((_, true)) if !words.starts_with("//") => {
                match (condition(text, words, number), checks.last_mut()) {
                    (Ok(condition), Some(block)) => block.push(condition),
                    (Ok(_), None) => {}
                    (Err(problem), _) => problems.push(problem),
                }
            }
            Some(_) => {}
        }
    }
    if problems.is_empty() && checks.iter().all(Vec::is_empty) {
        let help = "conditions stand in a fenced block `check`, such as `inspect/camera/d > 3`";
        problems.push((
            &text[..0],
            "the lesson has no condition".into(),
            help.into(),
        ));
    }
    if problems.is_empty() {
        return Ok(Lesson { checks });
    }
    Err(problems
        .into_iter()
        .map(|(part, message, help)| diagnostic(Severity::Error, span(text, part), message, help))
        .collect())
}

/// Returns the characters of the fence that a line opens, and whether its block is a `check`.
/// Returns `None` if the line opens no fence.
fn opened_by(line: &str) -> Option<(&str, bool)> {
    let sign = ['`', '~'].into_iter().find(|it| line.starts_with(*it))?;
    let info = line.trim_start_matches(sign);
    let mark = &line[..line.len() - info.len()];
    // A line with more backticks after the first ones is not a fence, but code within a line.
    let is_fence = mark.len() >= 3 && !(sign == '`' && info.contains(sign));
    is_fence.then(|| (mark, info.trim() == "check"))
}

/// A mistake: the wrong part of the lesson's text, the message and the help.
type Problem<'t> = (&'t str, String, String);

pub fn diagnostic(severity: Severity, span: Span, message: String, help: String) -> Diagnostic {
    Diagnostic {
        severity,
        code: "pinhole::lesson".to_owned(),
        message,
        help: Some(help),
        labels: vec![Label {
            span,
            message: "here".to_owned(),
        }],
        fixes: Vec::new(),
        is_needless: false,
        is_of_syntax: false,
    }
}

/// Returns the span of `part`, a slice of `text`.
fn span(text: &str, part: &str) -> Span {
    let start = part.as_ptr() as usize - text.as_ptr() as usize;
    Span::new(SourceId::File, start, start + part.len())
}

/// Parses the condition in `line`, a slice of the lesson's text `all`.
fn condition<'t>(all: &str, line: &'t str, number: usize) -> Result<Condition, Problem<'t>> {
    let (text, words) = without_comment(line);
    let Some((base, pointer, rest)) = path(text) else {
        let (name, _) = until_pointer(text);
        let near = suggest::nearest(name, BASES).filter(|near| *near != name);
        let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        let help = "a path is `error`, or such as `inspect/camera/d`, `start/camera/d` or \
                    `probe 320 180/hits/0/object`";
        let (path, _) = word(text);
        return Err((
            path,
            format!("`{path}` is no path to a value"),
            help.to_owned() + &near,
        ));
    };
    let (written, value) = word(rest);
    let Some(operator) = OPERATORS.into_iter().find(|it| *it == written) else {
        let help = "behind the path stands one of `=`, `<`, `<=`, `>`, `>=` and `in`";
        let place = if written.is_empty() { text } else { written };
        return Err((
            place,
            "a comparison is missing here".to_owned(),
            help.to_owned(),
        ));
    };
    let value = value.trim();
    let expected = expected(operator, value).ok_or_else(|| {
        let help = match operator {
            "=" if value.contains('±') => "a range is written `in start ± 2%`",
            "in" if value.contains("..") => "such as `20..30`: the smaller end comes first",
            "=" => {
                "such as `20`, `true`, `null`, `start`, or a name in quotation marks: `\"Ball\"`"
            }
            "in" => "such as `20..30`, `[\"sobol\", \"halton\"]` or `start ± 2%`",
            _ => "such as `20` or `start`",
        };
        let place = if value.is_empty() { text } else { value };
        let message = format!("`{value}` is no value for `{operator}`");
        (place, message, help.to_owned())
    })?;
    Ok(Condition {
        text: text.trim().to_owned(),
        words: words.trim().to_owned(),
        line: number,
        base,
        pointer: pointer.to_owned(),
        place: span(all, pointer),
        operator,
        expected,
    })
}

/// Parses a path. Returns its base, its JSON pointer, and the text after the path. Returns `None`
/// if the text does not start with a path.
fn path(text: &str) -> Option<(Base, &str, &str)> {
    let (name, rest) = until_pointer(text);
    let (base, rest) = match name {
        "inspect" => (Base::Inspect, rest),
        "start" => (Base::Start, rest),
        "error" => (Base::Error, rest),
        "probe" => {
            let (x, rest) = word(rest);
            let (y, rest) = until_pointer(rest.trim_start());
            (Base::Probe([finite(x)?, finite(y)?].into()), rest)
        }
        _ => return None,
    };
    let rest = rest.trim_start();
    let (pointer, rest) = rest.split_at(if rest.starts_with('/') {
        word(rest).0.len()
    } else {
        0
    });
    (matches!(base, Base::Error) == pointer.is_empty()).then_some((base, pointer, rest))
}

/// Parses the value behind an operator. Returns `None` if the operator cannot have such a value.
fn expected(operator: &str, value: &str) -> Option<Expected> {
    let is_in = operator == "in";
    if let Some(share) = value.strip_prefix("start") {
        if share.is_empty() {
            return (!is_in).then_some(Expected::Start(None));
        }
        let percent = finite(share.trim().strip_prefix('±')?.strip_suffix('%')?.trim())?;
        return (is_in && percent >= 0.0).then_some(Expected::Start(Some(percent / 100.0)));
    }
    if is_in && let Some((low, high)) = value.split_once("..") {
        let (low, high) = (finite(low.trim())?, finite(high.trim())?);
        return (low <= high).then_some(Expected::Range(low, high));
    }
    let value: Value = serde_json::from_str(value).ok()?;
    let fits = match operator {
        "=" => true,
        "in" => value.is_array(),
        _ => value.is_number(),
    };
    fits.then_some(Expected::Value(value))
}

/// Splits a line into its condition and the comment after it. A comment begins with `//` after
/// white space, but not within quotation marks.
fn without_comment(line: &str) -> (&str, &str) {
    let (mut before, mut is_quoted) = (' ', false);
    for (at, sign) in line.char_indices() {
        match sign {
            '"' if before != '\\' => is_quoted = !is_quoted,
            '/' if !is_quoted && before.is_whitespace() => {
                if let Some(comment) = line[at..].strip_prefix("//") {
                    return (line[..at].trim_end(), comment);
                }
            }
            _ => {}
        }
        before = sign;
    }
    (line, "")
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// Splits a text before its first white space. White space at its start is skipped.
fn word(text: &str) -> (&str, &str) {
    let text = text.trim_start();
    text.split_at(text.find(char::is_whitespace).unwrap_or(text.len()))
}

/// Splits a text before its first white space or slash.
fn until_pointer(text: &str) -> (&str, &str) {
    let end = text.find(|sign: char| sign == '/' || sign.is_whitespace());
    text.split_at(end.unwrap_or(text.len()))
}
