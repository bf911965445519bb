//! Checks whether a scene solves a lesson. The conditions of a lesson are about numbers of the
//! scene, not about its picture.
//!
//! In: a lesson, which is Markdown with conditions in fenced blocks `check`; its start scene; and a
//! student's scene. Out: for each condition whether it holds, and the value that was found.
//! [`parse`] describes the conditions. The caller shows the text of the lesson.

mod facts;
mod parser;

use glam::DVec2;
use serde_json::Value;

pub use self::{facts::Facts, parser::parse};
use crate::{
    diagnostic::{Diagnostic, Severity},
    numbers::short,
    source::Span,
};

/// The conditions of a lesson.
#[derive(Debug)]
#[non_exhaustive]
pub struct Lesson {
    /// A list of conditions for each block `check`, in the order of the text.
    pub checks: Vec<Vec<Condition>>,
}

/// A condition on a scene.
#[derive(Debug)]
#[non_exhaustive]
pub struct Condition {
    /// The condition as it is written.
    pub text: String,
    /// The comment after the condition, which explains the condition; empty if there is none.
    pub words: String,
    /// The line of the condition, counted from 1.
    pub line: usize,
    base: Base,
    /// JSON pointer to the value within the output that `base` names; empty for [`Base::Error`].
    pointer: String,
    /// Span of the pointer in the text of the lesson.
    place: Span,
    operator: &'static str,
    expected: Expected,
}

/// Source of the value that a condition checks.
#[derive(Clone, Copy, Debug)]
enum Base {
    /// The output of `pinhole inspect` for the student's scene.
    Inspect,
    /// The output of `pinhole inspect` for the lesson's start scene.
    Start,
    /// The output of `pinhole probe` for this point of the student's picture, in pixels.
    Probe(DVec2),
    /// The sampling error of the student's picture, which `Facts::error` computes.
    Error,
}

/// The right side of a condition.
#[derive(Debug)]
enum Expected {
    Value(Value),
    Range(f64, f64),
    /// The value v at the same path for the lesson's start scene. If the variant contains a number
    /// s, every value from v − s·|v| to v + s·|v| is accepted; otherwise, only v itself.
    Start(Option<f64>),
}

/// Result of checking a condition.
#[derive(Debug)]
#[non_exhaustive]
pub struct Judged<'l> {
    /// The condition.
    pub condition: &'l Condition,
    /// The value at the condition's path; `None` if there is none.
    pub found: Option<Value>,
    /// The value at the same path of the start scene, if the condition compares with it.
    pub at_start: Option<Value>,
    /// Whether the condition holds; `false` if there is no value at the condition's path.
    pub holds: bool,
}

impl Lesson {
    /// Returns a warning for each path with a part that is probably misspelt: the lesson's start
    /// scene has no value or object of this name, but one with a similar name.
    pub fn warnings(&self, start: &Facts<'_>) -> Vec<Diagnostic> {
        let conditions = self.checks.iter().flatten();
        let warning = |it: &Condition| {
            let (token, near) = match it.base {
                Base::Inspect | Base::Start => facts::misspelt(start.inspected(), &it.pointer)?,
                Base::Probe(point) => facts::misspelt(&start.probed(point), &it.pointer)?,
                Base::Error => return None,
            };
            Some(parser::diagnostic(
                Severity::Warning,
                it.place,
                format!("the lesson's own scene has no `{token}` here"),
                format!("did you mean `{near}`?"),
            ))
        };
        conditions.filter_map(warning).collect()
    }

    /// Judges a student's scene. Returns the conditions of each block.
    pub fn judge(&self, scene: &Facts<'_>, start: &Facts<'_>) -> Vec<Vec<Judged<'_>>> {
        let judge = |it| Condition::judge(it, scene, start);
        let blocks = self.checks.iter();
        blocks
            .map(|block| block.iter().map(judge).collect())
            .collect()
    }
}

impl Condition {
    fn judge(&self, scene: &Facts<'_>, start: &Facts<'_>) -> Judged<'_> {
        let found = self.find(scene, start);
        let is_compared = matches!(self.expected, Expected::Start(_));
        let at_start = is_compared.then(|| self.find(start, start)).flatten();
        let holds = self.holds(found.as_ref(), at_start.as_ref());
        Judged {
            condition: self,
            holds: holds.unwrap_or_default(),
            found,
            at_start,
        }
    }

    /// Returns the value at the condition's path, or `None` if there is none.
    fn find(&self, scene: &Facts<'_>, start: &Facts<'_>) -> Option<Value> {
        let at = |value: &Value| facts::at(value, &self.pointer).cloned();
        match self.base {
            Base::Inspect => at(scene.inspected()),
            Base::Start => at(start.inspected()),
            Base::Probe(point) => at(&scene.probed(point)),
            Base::Error => scene.error().map(Value::from),
        }
    }

    /// Returns whether the condition holds for the value `found`; `at_start` is the value at the
    /// same path for the lesson's start scene. Returns `None` if a value is missing, or if a
    /// comparison requires numbers and a value is not a number.
    fn holds(&self, found: Option<&Value>, at_start: Option<&Value>) -> Option<bool> {
        let expected = match &self.expected {
            Expected::Value(value) => value,
            Expected::Range(low, high) => return Some((*low..=*high).contains(&found?.as_f64()?)),
            Expected::Start(share) => {
                if let Some(share) = share {
                    let (x, middle) = (found?.as_f64()?, at_start?.as_f64()?);
                    return Some((x - middle).abs() <= (middle * share).abs());
                }
                at_start?
            }
        };
        let numbers = || Some((found?.as_f64()?, expected.as_f64()?));
        match self.operator {
            "=" => Some(is_same(found?, expected)),
            "in" => Some(
                expected
                    .as_array()?
                    .iter()
                    .any(|it| found.is_some_and(|found| is_same(found, it))),
            ),
            "<" => numbers().map(|(a, b)| a < b),
            "<=" => numbers().map(|(a, b)| a <= b),
            ">" => numbers().map(|(a, b)| a > b),
            _ => numbers().map(|(a, b)| a >= b),
        }
    }
}

/// Returns whether two JSON values are equal. `2` and `2.0` are equal numbers.
fn is_same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => a.as_f64() == b.as_f64(),
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_same(a, b))
        }
        _ => a == b,
    }
}

/// Returns a value for people: numbers are rounded, and a long value is cut. Returns `nothing` if
/// there is no value.
pub fn value_text(value: Option<&Value>) -> String {
    /// Maximum number of characters of a value. More would not fit into a line of the page.
    const LONGEST: usize = 40;
    let text = match value {
        None => "nothing".to_owned(),
        Some(Value::Null) => "none".to_owned(),
        Some(Value::Number(number)) => number.as_f64().map(short).unwrap_or_default(),
        Some(Value::String(text)) => text.clone(),
        Some(Value::Array(values)) => {
            let texts: Vec<_> = values.iter().map(|it| value_text(Some(it))).collect();
            format!("({})", texts.join(", "))
        }
        Some(value) => value.to_string(),
    };
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
