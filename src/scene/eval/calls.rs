//! Functions and their arguments.

use super::Evaluator;
use crate::{
    color::Color,
    diagnostic::{Edit, Fix},
    numbers,
    scene::{
        css,
        error::Problem,
        fix, predefined,
        schema::{self, Function, Type},
        value::{self, Value},
    },
    source::Span,
    suggest,
    syntax::{
        shorten,
        tree::{self, Call, Element, Name, ValueKind},
    },
};

impl<'s> Evaluator<'_, 's> {
    pub(super) fn call(&mut self, call: &Call<'s>, wanted: Option<Type>) -> Option<Value> {
        let Call {
            function,
            arguments,
            parentheses,
        } = call;
        let Some(row) = schema::function(function.text) else {
            self.unknown_function(function, arguments);
            return None;
        };
        let mut values = Vec::with_capacity(arguments.len());
        for (index, argument) in arguments.iter().enumerate() {
            let takes = row.takes.get(index).or(row.takes.last()).copied();
            values.push(self.value(&argument.value, takes.or(wanted)));
        }
        let least = row.takes.len();
        if values.len() < least || (values.len() > least && !row.more) {
            self.argument_count(row, function.span.to(*parentheses), arguments);
            return None;
        }
        let mut known = Vec::with_capacity(values.len());
        for (index, (argument, value)) in arguments.iter().zip(values).enumerate() {
            let Some(value) = value else { continue };
            let takes = row.takes.get(index).or(row.takes.last()).copied();
            match takes {
                Some(takes) if takes != value.kind() => {
                    self.argument_type(row, takes, &argument.value, value);
                }
                _ => known.push(value),
            }
        }
        if known.len() < arguments.len() {
            return None;
        }
        let result = value::call(row.name, &known)?;
        if let Value::Color(color) = result {
            if !self.in_range(color, arguments) {
                return None;
            }
            if has_unit_parts(color) {
                self.unit_parts(function.span.to(*parentheses), color, arguments);
            }
        }
        self.finite_call(row, arguments, function.span, &known, result)
    }

    fn unknown_function(&mut self, function: &Name<'s>, arguments: &[Element<'s>]) {
        let values = arguments
            .iter()
            .map(|argument| self.value(&argument.value, None));
        let values: Vec<Option<Value>> = values.collect();
        // Of equally near ones, one that takes these arguments.
        let fits = |row: &&Function| {
            let takes = |at: usize| row.takes.get(at).or(row.takes.last()).copied();
            let mut kinds = values.iter().enumerate();
            let is_count =
                values.len() == row.takes.len() || row.more && values.len() > row.takes.len();
            is_count
                && kinds
                    .all(|(at, value)| value.is_none_or(|value| takes(at) == Some(value.kind())))
        };
        let named = |rows: &mut dyn Iterator<Item = &'static Function>| {
            suggest::nearest(function.text, rows.map(|row| row.name))
        };
        let fitting = named(&mut schema::FUNCTIONS.iter().filter(fits));
        let near = fitting.or_else(|| named(&mut schema::FUNCTIONS.iter()));
        let is_let = self.names.place(function.text).is_some();
        let is_value = is_let || predefined(function.text).is_some();
        let (help, label) = match near {
            _ if is_value => (
                format!(
                    "write an operator between, such as `{} * (…)`",
                    function.text
                ),
                "a value, not a function".to_owned(),
            ),
            Some(near) => (
                format!("did you mean `{near}`?"),
                "not a function".to_owned(),
            ),
            None => (
                format!(
                    "the functions are {}",
                    suggest::list(schema::FUNCTIONS.iter().map(|function| function.name))
                ),
                "not a function".to_owned(),
            ),
        };
        let place = match arguments.len() {
            1 | 3 if is_let => self.before_parenthesis(function.span),
            _ => None,
        };
        self.problems.push(
            Problem::UnknownFunction {
                name: function.text.to_owned(),
                help,
                span: function.span,
                label,
            }
            .with(match place {
                Some(place) => Some(Fix::new(
                    format!("write `{} * (…)`", function.text),
                    [Edit::new(place, " * ")],
                )),
                None => fix::written(function.span, fitting.filter(|_| !is_value)),
            }),
        );
    }

    /// What stands between a name and the `(` behind it, if that is nothing but white space.
    fn before_parenthesis(&self, name: Span) -> Option<Span> {
        let after = self.sources.get(name.source).text().get(name.end..)?;
        let blank = after.len() - after.trim_start().len();
        let is_next = after.get(blank..)?.starts_with('(');
        is_next.then(|| Span::new(name.source, name.end, name.end + blank))
    }

    fn argument_count(&mut self, row: &Function, span: Span, arguments: &[Element<'s>]) {
        let found = arguments.len();
        let values = |count: usize| match count {
            1 => "one value".to_owned(),
            2 => "two values".to_owned(),
            3 => "three values".to_owned(),
            count => format!("{count} values"),
        };
        let takes = match row.more {
            true => format!("{} or more", values(row.takes.len())),
            false => values(row.takes.len()),
        };
        let are = match found {
            0 => "there is none".to_owned(),
            1 => "there is one".to_owned(),
            2 => "there are two".to_owned(),
            count => format!("there are {count}"),
        };
        let written = self.argument_example(row, arguments);
        // What is written is not to be lost, but for the alpha of a colour.
        let keeps_all = found <= 1
            || found < row.takes.len()
            || row.takes == [Type::Vector]
            || row.gives == Type::Color;
        let is_example = written == example(row) && self.filled_up(row, arguments).is_none();
        let keeps_all = keeps_all && (found == 0 || !is_example);
        let instead = (is_whole(&written) && keeps_all).then(|| written.clone());
        self.problems.push(
            Problem::ArgumentCount {
                name: row.name.to_owned(),
                takes,
                are,
                example: written,
                span,
                label: match found {
                    0 => "no value".to_owned(),
                    count => values(count),
                },
            }
            .with(fix::written(span, instead)),
        );
    }

    /// The call with as many of its values as it takes; what a vector is made of stands in parentheses of its own, and what
    /// numbers are does not.
    fn argument_example(&self, row: &Function, arguments: &[Element<'s>]) -> String {
        let text = |e: &Element<'_>| shorten(self.sources.text(e.value.span));
        let texts: Vec<String> = arguments.iter().map(text).collect();
        match (row.takes, arguments) {
            ([Type::Vector], [_, _, _]) => format!("{}(({}))", row.name, texts.join(", ")),
            (takes, [only]) if matches!(&only.value.kind, ValueKind::Tuple(parts) if parts.len() == takes.len()) =>
            {
                format!("{}{}", row.name, texts.join(", "))
            }
            (takes, _) => match texts.get(..takes.len()) {
                Some(kept) => format!("{}({})", row.name, kept.join(", ")),
                None => self
                    .filled_up(row, arguments)
                    .unwrap_or_else(|| example(row)),
            },
        }
    }

    /// The call of numbers with those that are given, and examples of those that are not.
    fn filled_up(&self, row: &Function, arguments: &[Element<'s>]) -> Option<String> {
        let is_number = |argument: &Element<'_>| match argument.value.kind {
            ValueKind::Number(_) | ValueKind::Negation { .. } | ValueKind::Chain { .. } => true,
            ValueKind::Call(_) => true,
            ValueKind::Name(name) => css::color(name).is_none(),
            _ => false,
        };
        let takes_numbers = row.takes.iter().all(|takes| *takes == Type::Number);
        if arguments.is_empty() || !takes_numbers || !arguments.iter().all(is_number) {
            return None;
        }
        let example = example(row);
        let examples = example.split_once('(')?.1.strip_suffix(')')?.split(", ");
        let given = arguments.iter();
        let given = given.map(|argument| shorten(self.sources.text(argument.value.span)));
        let all: Vec<String> = given
            .chain(examples.skip(arguments.len()).map(str::to_owned))
            .collect();
        Some(format!("{}({})", row.name, all.join(", ")))
    }

    fn argument_type(
        &mut self,
        row: &Function,
        takes: Type,
        argument: &tree::Value<'s>,
        found: Value,
    ) {
        let label = self.described(argument, found.kind());
        let written = self.quoted(argument.span);
        if takes == Type::Angle && found.kind() == Type::Number {
            let [first, second] = self.units(argument);
            self.problems.push(
                Problem::BareAngle {
                    what: format!("the argument of `{}`", row.name),
                    written,
                    help: format!(
                        "write `{0}({1})` (or `{0}({2})`)",
                        row.name, first.shown, second.shown
                    ),
                    span: argument.span,
                    label,
                }
                .with(fix::instead(argument.span, [first.text, second.text])),
            );
            return;
        }
        self.problems.push(Problem::ArgumentType {
            name: row.name.to_owned(),
            takes: match row.takes {
                [_, _] => takes.two(),
                [_, _, _] => "three numbers",
                _ => takes.noun(),
            },
            written,
            found: found.kind().noun(),
            help: format!("call it with {}, such as `{}`", takes.noun(), example(row)),
            span: argument.span,
            label,
        });
    }

    /// Whether the channels of a colour lie from 0 to 255; what does not is reported.
    fn in_range(&mut self, color: Color, arguments: &[Element<'s>]) -> bool {
        let mut fits = true;
        let names = ["red", "green", "blue"];
        for ((channel, name), argument) in color.srgb.into_iter().zip(names).zip(arguments) {
            if (0.0..=255.0).contains(&channel) {
                continue;
            }
            fits = false;
            let (bound, label) = match channel > 255.0 {
                true => ("255", "too much"),
                false => ("0", "too little"),
            };
            self.problems.push(
                Problem::ColorRange {
                    channel: name,
                    found: numbers::beside(channel, &[0.0, 255.0]),
                    help: format!("write `{bound}`, or a number that lies between"),
                    span: argument.value.span,
                    label,
                }
                .with(fix::instead(argument.value.span, [bound])),
            );
        }
        fits
    }

    /// Warns of a colour whose parts seem to go from 0 to 1.
    fn unit_parts(&mut self, span: Span, color: Color, arguments: &[Element<'s>]) {
        let parts = color.srgb.into_iter().zip(arguments);
        let parts = parts.map(|(channel, argument)| match &argument.value.kind {
            ValueKind::Number(_) => in_bytes(channel),
            ValueKind::Chain { .. } => {
                format!("255 * ({})", self.sources.text(argument.value.span))
            }
            _ => format!("255 * {}", self.sources.text(argument.value.span)),
        });
        let parts: Vec<String> = parts.collect();
        let instead = format!("rgb({})", parts.join(", "));
        self.problems.push(
            Problem::UnitColor {
                help: format!("write `{}`, if 1 is to be full light", shorten(&instead)),
                span,
            }
            .with(fix::instead(span, is_whole(&instead).then_some(instead))),
        );
    }

    fn finite_call(
        &mut self,
        row: &Function,
        arguments: &[Element<'s>],
        span: Span,
        known: &[Value],
        result: Value,
    ) -> Option<Value> {
        if result.is_finite() {
            return Some(result);
        }
        let written = match arguments {
            [only] => shorten(self.sources.text(only.value.span)),
            _ => "…".to_owned(),
        };
        let (message, help, label) = match (row.name, known) {
            ("sqrt", _) => (
                "a negative number has no square root".to_owned(),
                format!("write `sqrt(abs({written}))` if its size is meant"),
                computed(known.first()),
            ),
            ("tan", _) => (
                format!("`tan({written})` is infinite"),
                "a tangent has a value only away from 90deg, 270deg and so on".to_owned(),
                "infinite here".to_owned(),
            ),
            ("asin" | "acos", _) => (
                format!("`{}` takes a number from -1 to 1", row.name),
                format!(
                    "write `{}(max(-1, min(1, {written})))` to keep it in range",
                    row.name
                ),
                computed(known.first()),
            ),
            ("normalize", _) => (
                "the zero vector has no direction".to_owned(),
                "normalize a vector other than (0, 0, 0)".to_owned(),
                "its argument is (0, 0, 0)".to_owned(),
            ),
            _ => (
                format!("`{}` gives a number that is too large", row.name),
                "numbers go up to 1.7976931348623157e308".to_owned(),
                "too large".to_owned(),
            ),
        };
        let kept = match (row.name, arguments) {
            ("sqrt", [only]) => Some(("abs(", ")", only.value.span)),
            ("asin" | "acos", [only]) => Some(("max(-1, min(1, ", "))", only.value.span)),
            _ => None,
        };
        let fix = kept.map(|(before, after, place)| {
            Fix::new(
                format!("write `{}({before}{written}{after})`", row.name),
                [
                    Edit::insert(place.source, place.start, before),
                    Edit::insert(place.source, place.end, after),
                ],
            )
        });
        self.problems.push(
            Problem::NotFinite {
                message,
                help,
                span,
                label,
            }
            .with(fix),
        );
        None
    }
}

/// Whether the parts of a colour seem to go from 0 to 1: all are at most 1, and one is a fraction.
fn has_unit_parts(color: Color) -> bool {
    color.srgb.iter().all(|part| *part <= 1.0) && color.srgb.iter().any(|part| part.fract() != 0.0)
}

/// The part from 0 to 255 that stands for one from 0 to 1.
pub fn in_bytes(part: f64) -> String {
    (part * 255.0).round().to_string()
}

/// Whether a text that was made for a message can be written as it is.
pub(super) fn is_whole(shortened: &str) -> bool {
    !shortened.contains('…') && !shortened.contains("//")
}

/// How a function is called.
pub fn example(function: &Function) -> String {
    let arguments = match function.takes {
        // Of those of the cross product it is 0, which few fields take.
        [Type::Vector, Type::Vector] if function.gives == Type::Number => "(1, 2, 3), (0, 1, 0)",
        [Type::Angle] => "30deg",
        [Type::Vector] => "(1, 2, 3)",
        [Type::Vector, Type::Vector] => "(1, 0, 0), (0, 1, 0)",
        [Type::Number] => "0.5",
        [Type::Number, Type::Number] => "1, 2",
        _ => "255, 165, 0",
    };
    format!("{}({arguments})", function.name)
}

fn computed(value: Option<&Value>) -> String {
    match value {
        Some(Value::Number(number)) => format!("its argument is {}", numbers::short(*number)),
        _ => "not finite".to_owned(),
    }
}
