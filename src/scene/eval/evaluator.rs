//! Evaluates expressions. This file handles literals and numbers that lack a unit; the other files
//! of `eval` handle the other kinds of expressions.

use super::{names::Names, origin::UnitOrigin};
use crate::{
    color::Color,
    diagnostic::{Applicability, Diagnostic, Edit, Fix, Problems},
    scene::error::{error, warning},
    schema::{self, Type, Value},
    source::{Source, SourceId, Sources, Span},
    syntax::{
        self, shorten,
        tree::{self, Unit, ValueKind},
    },
};

/// Evaluator of expressions, which collects their problems.
#[derive(Debug)]
pub struct Evaluator<'a, 's> {
    /// The scene file and the `--set` arguments of the command line.
    pub sources: &'s Sources,
    /// The names of the scene that are defined so far.
    pub names: &'a Names<'s>,
    /// The problems found so far.
    pub problems: &'a mut Problems,
}

/// Returns the value of an expression that uses no names of a scene, such as the default value of a
/// field. Returns `None` if the expression has errors.
pub fn literal(written: &str, takes: Type) -> Option<Value> {
    if takes == Type::Method {
        return schema::method(written).map(Value::Method);
    }
    let sources = Sources::new(Source::from_text("", written));
    let (tree, _) = syntax::parse_value(&sources.file, SourceId::File, 0);
    value_of(&tree, Some(takes), &sources, &Names::default())
}

/// Returns the value of an expression, or `None` if it has errors. Its problems are discarded.
/// `wanted` is the type that the context requires, if it is known.
pub fn value_of<'s>(
    tree: &tree::Value<'s>,
    wanted: Option<Type>,
    sources: &'s Sources,
    names: &Names<'s>,
) -> Option<Value> {
    let problems = &mut Problems::default();
    let mut evaluator = Evaluator {
        sources,
        names,
        problems,
    };
    evaluator.value(tree, wanted)
}

/// Returns whether the value of `tree` has the type of `field` and meets its conditions.
pub fn suits<'s>(
    field: &schema::FieldRow,
    tree: &tree::Value<'s>,
    sources: &'s Sources,
    names: &Names<'s>,
) -> bool {
    if let (Type::Method, ValueKind::Name(word)) = (field.takes, &tree.kind) {
        return schema::method(word).is_some();
    }
    let value = value_of(tree, Some(field.takes), sources, names);
    value.is_some_and(|value| value.kind() == field.takes && field.allows(value))
}

impl<'s> Evaluator<'_, 's> {
    /// Returns the value of an expression. `wanted` is the type that the context requires, if it is
    /// known; the result may have another type. If the expression has errors, reports them and
    /// returns `None`.
    pub fn value(&mut self, value: &tree::Value<'s>, wanted: Option<Type>) -> Option<Value> {
        match &value.kind {
            ValueKind::Number(written) => Some(Value::Number(self.number(written, value.span)?)),
            ValueKind::Angle { number, unit } => {
                let number = self.number(number, value.span)?;
                Some(Value::Angle(unit.of(number)))
            }
            ValueKind::ColorCode(written) => color_code(written).map(Value::Color),
            ValueKind::Name(name) => self.name(name, value.span, wanted),
            ValueKind::Call(call) => self.call(call),
            ValueKind::Parentheses(inner) => self.value(inner, wanted),
            ValueKind::Tuple(elements) => self.tuple(elements, value.span, wanted),
            ValueKind::Negation { sign, operand } => self.negation(*sign, operand),
            ValueKind::Chain { first, rest } => self.chain(first, rest, wanted),
            ValueKind::Missing | ValueKind::Bad => None,
        }
    }

    /// Parses a number. Warns if it is rounded to 0; if it is too large, reports an error and
    /// returns `None`.
    fn number(&mut self, written: &str, span: Span) -> Option<f64> {
        let number: f64 = if written.contains('_') {
            written.replace('_', "").parse().ok()?
        } else {
            written.parse().ok()?
        };
        if number.is_infinite() {
            let message = format!("the number {} is too large", shorten(written));
            error("number_too_large", message)
                .at(span, "too large")
                .help(LARGEST)
                .report(self.problems);
            return None;
        }
        let mantissa = written.split(['e', 'E']).next().unwrap_or_default();
        if number == 0.0 && mantissa.contains(|digit| matches!(digit, '1'..='9')) {
            let message = format!(
                "the number {} is too small, and becomes 0",
                shorten(written)
            );
            warning("number_underflow", message)
                .at(span, "becomes 0")
                .help("write 0 if that is meant; the least number above 0 is 5e-324")
                .writing(span, Applicability::Unsafe, ["0"])
                .report(self.problems);
        }
        Some(number)
    }

    /// Returns the error for `number`, which has no unit, although an angle is required. `what`
    /// describes the required angle in words, such as a field's name. The fixes add a unit. A unit
    /// is offered only if `fits` returns true for it.
    pub fn bare_angle(
        &self,
        what: &str,
        tree: &tree::Value<'s>,
        number: f64,
        fits: impl Fn(Unit) -> bool,
    ) -> Diagnostic {
        let message = |span| format!("{what} is an angle, and {} has no unit", self.quoted(span));
        if let Some((name, set)) = self.set_in(tree) {
            let text = self.sources.text(set);
            let fixes = [Unit::Degrees, Unit::Radians].map(|unit| {
                let angle = match text.trim().parse::<f64>() {
                    Ok(_) => format!("{text}{}", unit.name()),
                    Err(_) => format!("({text}) * 1{}", unit.name()),
                };
                Fix::new(format!("write `{name}={angle}`"), [Edit::new(set, angle)])
            });
            return error("bare_angle", message(set))
                .at(set, Type::Number.noun())
                .at(tree.span, "used here")
                .help(fixes[0].title.clone())
                .fixes(fixes);
        }
        let message = message(tree.span);
        let units = self.units(tree, number);
        let shown = units.each_ref().map(|(_, fix)| fix.title.clone());
        let mut fixes: Vec<Fix> = Vec::from(units)
            .into_iter()
            .filter_map(|(unit, fix)| fits(unit).then_some(fix))
            .collect();
        let help = match fixes.as_mut_slice() {
            [only] => {
                let is_plain = is_plain_number(tree);
                only.applicability = Applicability::safe_if(is_plain);
                only.title.clone()
            }
            _ => {
                let [first, second] = shown;
                let second = second.trim_start_matches("write ");
                if second.ends_with(')') {
                    format!("{first} or {second}")
                } else {
                    format!("{first} (or {second})")
                }
            }
        };
        let help = match self.number_without_unit(tree) {
            Some((name, number)) => format!(
                "{help}; or write the unit where `{name}` is defined, as in `let {name} = {number}deg`"
            ),
            None => help,
        };
        error("bare_angle", message)
            .at(tree.span, self.described(tree, Type::Number))
            .help(help)
            .fixes(fixes)
    }

    /// Searches `value`, a part of the file, for a name that a `--set` argument of the command line
    /// defines. Returns the first such name, and the span of its value in the argument. A mistake
    /// in `value` must then be corrected in the argument, not in the file. Returns `None` if
    /// `value` has no such name.
    pub(super) fn set_in(&self, value: &tree::Value<'s>) -> Option<(&'s str, Span)> {
        let ValueKind::Name(name) = value.kind else {
            return value.parts().into_iter().find_map(|part| self.set_in(part));
        };
        let from = self.names.defined.get(name)?.from;
        let is_set = from.source != SourceId::File && value.span.source == SourceId::File;
        is_set.then_some((name, from))
    }

    /// Finds the factor of a product that is a name for a plain number, such as `a` in `a * 2`
    /// after `let a = 30`. Returns the name, and the number as it is written. Returns `None` if
    /// `value` is not a product, or if it has no such factor or more than one.
    fn number_without_unit(&self, value: &tree::Value<'s>) -> Option<(&'s str, &'s str)> {
        let ValueKind::Chain { first, rest } = &value.kind else {
            return None;
        };
        let factors = [&**first]
            .into_iter()
            .chain(rest.iter().map(|step| &step.operand));
        let mut numbers = factors.filter_map(|factor| {
            let ValueKind::Name(name) = factor.kind else {
                return None;
            };
            let place = self.names.definition(name)?;
            let behind = self.sources.file.text().get(place.end..)?.lines().next()?;
            let written = behind.trim_start().strip_prefix('=')?;
            let written = written.split("//").next()?.trim();
            written.parse::<f64>().is_ok().then_some((name, written))
        });
        let is_product = rest.iter().all(|step| step.operator.is_of_product());
        numbers
            .next()
            .filter(|_| is_product && numbers.next().is_none())
    }

    /// Returns fixes that add a unit to a number, the likelier unit first.
    ///
    /// Radians come first if the formula of `value` suggests them, for example by using `pi`, or if
    /// it suggests no unit and the number is at most pi, but not 0. Otherwise, degrees come first.
    /// If the number is at most 2 pi, but not 0, the titles also give the angle in the other unit.
    /// If some parts of the formula suggest degrees and others radians, the fixes are marked as
    /// placeholders, so that the author must choose.
    pub fn units(&self, value: &tree::Value<'s>, number: f64) -> [(Unit, Fix); 2] {
        let text = self.sources.text(value.span);
        let is_literal = is_plain_number(value);
        let is_sum = match &value.kind {
            ValueKind::Chain { rest, .. } => rest.iter().any(|step| !step.operator.is_of_product()),
            _ => false,
        };
        let origin = self.names.origin(value);
        let is_small = number != 0.0 && number.abs() <= std::f64::consts::PI;
        let is_sure = number == 0.0 || number.abs() > 2.0 * std::f64::consts::PI;
        let mut units = [Unit::Degrees, Unit::Radians];
        if origin == UnitOrigin::In(Unit::Radians) || (origin == UnitOrigin::Plain && is_small) {
            units.reverse();
        }
        units.map(|unit| {
            let name = unit.name();
            let text = match (is_literal, is_sum) {
                (true, _) => format!("{text}{name}"),
                (false, true) => format!("({text}) * 1{name}"),
                (false, false) => format!("{text} * 1{name}"),
            };
            let mut title = format!("write `{}`", shorten(&text));
            if !is_sure {
                title += &match unit {
                    Unit::Degrees => format!(" (= {}rad)", rounded(number.to_radians())),
                    Unit::Radians => format!(" (= {}deg)", rounded(number.to_degrees())),
                };
            }
            let is_safe = is_literal && is_sure && unit == Unit::Degrees;
            let fix = Fix::new(title, [Edit::new(value.span, text)]);
            (
                unit,
                fix.with_applicability(match origin {
                    UnitOrigin::Unclear => Applicability::Placeholder,
                    _ => Applicability::safe_if(is_safe),
                }),
            )
        })
    }

    /// Returns the text at `span` for a message: a number or list literal as it is, any other text
    /// in backquotes.
    pub fn quoted(&self, span: Span) -> String {
        let written = shorten(self.sources.text(span));
        let literal = written
            .starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '(' | '.'))
            && !written.contains(['`', '*', '/']);
        if literal {
            written
        } else {
            format!("`{written}`")
        }
    }
}

/// Help text for a number above the largest finite `f64`.
pub(super) const LARGEST: &str = "numbers go up to 1.7976931348623157e308";

/// Returns the colour of a code such as `#ff8000`. The code has three or six digits, which the
/// parser has checked. Returns `None` if it is not a `#` and hexadecimal digits.
pub(super) fn color_code(written: &str) -> Option<Color> {
    let digits = written.strip_prefix('#')?;
    let code = u32::from_str_radix(digits, 16).ok()?;
    Some(Color::from_bytes(if digits.len() == 3 {
        let digit = |shift: u32| ((code >> shift) & 0xf) as u8 * 0x11;
        [digit(8), digit(4), digit(0)]
    } else {
        let byte = |shift: u32| ((code >> shift) & 0xff) as u8;
        [byte(16), byte(8), byte(0)]
    }))
}

/// Returns whether a value is a number literal, with or without a minus.
fn is_plain_number(value: &tree::Value<'_>) -> bool {
    match &value.kind {
        ValueKind::Negation { operand, .. } => matches!(operand.kind, ValueKind::Number(_)),
        kind => matches!(kind, ValueKind::Number(_)),
    }
}

/// Formats an angle for a message. Numbers below 1, which are usual in radians, get three decimal
/// places, and others get one.
fn rounded(number: f64) -> String {
    if number.abs() < 1.0 {
        format!("{number:.3}")
    } else {
        format!("{number:.1}")
    }
}
