//! Evaluates calls of functions, and reports calls that are wrong.

use super::{
    evaluator::{Evaluator, LARGEST},
    suggestion::{Meaning, Suggestion},
};
use crate::{
    color::{Color, in_bytes},
    diagnostic::{Applicability, Diagnostic},
    numbers,
    scene::{
        error::{error, warning},
        value,
    },
    schema::{self, Function, Type, Value, css, predefined},
    source::Span,
    suggest,
    syntax::{
        shorten,
        tree::{self, Call, Element, Name, ValueKind},
    },
};

/// Names of functions in other languages. A row holds names, separated by spaces, and the help that
/// says what to write instead.
#[rustfmt::skip]
const OTHER_FUNCTIONS: &[(&str, &str)] = &[
    ("pow power sq square", "write a product, such as `x * x`"),
    ("norm magnitude mag len", "write `length(v)`, or `normalize(v)` for the direction"),
    ("radians to_radians deg2rad", "write the unit behind the number, as in `30deg`, or `x * 1deg`"),
    ("degrees to_degrees rad2deg", "an angle divided by `1deg` is a number"),
    ("mod fmod floor ceil round int", "nothing is rounded: count with indices, as in `for i < 8, j < 2`"),
    ("hypot distance dist", "write `length(a - b)` of two points"),
    ("clamp saturate", "write `max(0, min(1, x))`"),
    ("lerp mix", "write `a + (b - a) * t`"),
    ("cot", "write `1 / tan(a)`"),
    ("hsl hsv hsla", "write the colour as `rgb(r, g, b)` or `#rrggbb`"),
    ("exp log ln random rand noise", "write the number itself"),
];

/// Number of previous problems that are examined before an unknown function is reported. If the
/// help of one of them lists all functions, the new report refers to `pinhole explain functions`
/// instead of repeating the list. Any small number works. Examining all problems, up to ten
/// thousand, would be slow.
const LOOKED_BACK: usize = 8;

impl<'s> Evaluator<'_, 's> {
    /// Returns the result of a call. If the call is wrong, reports why and returns `None`.
    pub(super) fn call(&mut self, call: &Call<'s>) -> Option<Value> {
        let Call {
            function,
            arguments,
            parentheses,
        } = call;
        let row = schema::function(function.text).or_else(|| {
            match self.names.suggestions.meaning(function.text) {
                Some(Meaning::Function(row)) => Some(row),
                _ => None,
            }
        });
        let mut values = Vec::with_capacity(arguments.len());
        for (index, argument) in arguments.iter().enumerate() {
            let takes = row.and_then(|row| row.parameter(index));
            values.push((&argument.value, takes, self.value(&argument.value, takes)));
        }
        let Some(row) = row else {
            let kinds = values.iter().map(|(_, _, value)| value.map(|it| it.kind()));
            let kinds: Vec<Option<Type>> = kinds.collect();
            self.unknown_function(function, &kinds);
            return None;
        };
        let span = function.span.to(*parentheses);
        if !row.accepts(arguments.len()) {
            self.argument_count(row, span, arguments);
            return None;
        }
        let mut known = Vec::with_capacity(values.len());
        for (argument, takes, value) in values {
            match (takes, value) {
                (Some(takes), Some(value)) if takes != value.kind() => {
                    self.argument_type(row, takes, argument, value);
                }
                _ => known.extend(value),
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
            self.unit_parts(span, color, arguments);
        }
        if !result.is_finite() {
            self.not_finite(row, arguments, function.span, &known);
            return None;
        }
        Some(result)
    }

    /// Reports an unknown function. Suggests the function with the nearest name among those that
    /// accept arguments of the types `arguments`. An element `None` stands for an unknown type.
    fn unknown_function(&mut self, function: &Name<'s>, arguments: &[Option<Type>]) {
        if self.names.suggestions.is_trying() {
            return;
        }
        let name = function.text;
        let is_value = self.names.place(name).is_some() || predefined(name).is_some();
        let fits = |row: &&Function| {
            let mut kinds = arguments.iter().enumerate();
            let mut are_right =
                kinds.all(|(at, kind)| kind.is_none() || *kind == row.parameter(at));
            are_right &= row.accepts(arguments.len());
            are_right && !is_value
        };
        let rows = schema::FUNCTIONS.iter().filter(fits);
        let mut elsewhere = OTHER_FUNCTIONS.iter();
        let elsewhere = elsewhere.find(|row| suggest::is_among(name, row.0));
        let near = suggest::nearest_name(name, rows.map(|row| row.name));
        let near = near.filter(|_| elsewhere.is_none());
        let all_names = || schema::FUNCTIONS.iter().map(|row| row.name);
        let is_sure = near.is_some_and(|near| suggest::is_only_near(name, near, all_names()));
        let all = match elsewhere {
            Some((_, instead)) => (*instead).to_owned(),
            None => format!("the functions are {}", suggest::list(all_names())),
        };
        // If one of the latest reports lists all functions, the list is not repeated.
        let has_list = |it: &Diagnostic| it.help.as_ref() == Some(&all);
        let mut last = self.problems.iter().rev().take(LOOKED_BACK);
        let all = if last.any(has_list) && elsewhere.is_none() {
            "`pinhole explain functions` lists them".to_owned()
        } else {
            all
        };
        if let Some(row) = near.and_then(schema::function) {
            self.names.suggestions.push(Suggestion {
                name,
                means: Meaning::Function(row),
                report: function.span,
                otherwise: all.clone(),
            });
        }
        let (label, help) = match near {
            _ if is_value => {
                let left = self.meaning(name);
                let left = left.map(|value| value.kind());
                let right = match arguments {
                    [only] => *only,
                    [_, _, _] => Some(Type::Vector),
                    _ => None,
                };
                let help = match left.zip(right).and_then(operator_between) {
                    Some(sign) => {
                        format!("write an operator between, such as `{name} {sign} (…)`")
                    }
                    None => {
                        format!("take `{name}` away, or what stands behind it")
                    }
                };
                ("a value, not a function", help)
            }
            Some(near) => ("not a function", format!("did you mean `{near}`?")),
            None => ("not a function", all),
        };
        error("unknown_function", format!("there is no function `{name}`"))
            .at(function.span, label)
            .help(help)
            .writing(function.span, Applicability::safe_if(is_sure), near)
            .report(self.problems);
    }

    /// Reports a call with a wrong number of arguments.
    fn argument_count(&mut self, row: &Function, span: Span, arguments: &[Element<'s>]) {
        // A text that could not be parsed may contain several arguments, so their number is
        // unknown.
        if arguments.iter().any(|it| it.value.kind == ValueKind::Bad) {
            return;
        }
        let more = if row.more { " or more" } else { "" };
        let (takes, found) = (row.takes.len(), arguments.len());
        let plural = if takes == 1 && !row.more { "" } else { "s" };
        let message = format!(
            "`{}` takes {takes}{more} value{plural}, and here it has {found}",
            row.name
        );
        let text = |element: &Element<'_>| self.sources.text(element.value.span).to_owned();
        let is_color = |name| css::color(name).is_some();
        let is_rgb = row.gives == Type::Color;
        // The call that was probably meant is suggested. In `length(1, 2, 3)`, parentheses around
        // the coordinates are missing, so they are added. In `rgb((255, 0, 0))`, the inner
        // parentheses are wrong, so they are removed.
        let meant = match (row.takes, arguments) {
            // The language has no transparency, so a fourth channel is removed. `rgb(red)` becomes
            // `red`.
            (_, [r, g, b, _]) if is_rgb => Some(format!("rgb({})", [r, g, b].map(text).join(", "))),
            (_, [only])
                if is_rgb
                    && match only.value.kind {
                        ValueKind::Name(name) => is_color(name),
                        ref kind => matches!(kind, ValueKind::ColorCode(_)),
                    } =>
            {
                Some(text(only))
            }
            ([Type::Vector], [x, y, z]) => {
                let parts = [x, y, z].map(text).join(", ");
                Some(format!("{}(({parts}))", row.name))
            }
            (takes, [only]) if takes.len() == only.value.parts().len() => {
                let is_list = matches!(only.value.kind, ValueKind::Tuple(_));
                is_list.then(|| format!("{}{}", row.name, text(only)))
            }
            _ => None,
        };
        let shown = meant.clone().unwrap_or_else(|| row.call());
        let is_opaque = is_rgb && found == 4;
        let is_safe = Applicability::safe_if(
            !is_rgb || meant.as_ref().is_some_and(|it| it.contains('(')) && !is_opaque,
        );
        error("argument_count", message)
            .at(span, format!("{found} given"))
            .help(match arguments {
                [only] if row.more => format!(
                    "write `{}` alone, or give `{}` another number",
                    shorten(&text(only)),
                    row.name
                ),
                _ if is_opaque => {
                    format!("write `{}`: there is no transparency", shorten(&shown))
                }
                _ if found > takes && meant.is_none() => {
                    format!("give it {takes} value{plural} alone")
                }
                _ => format!("write `{}`", shorten(&shown)),
            })
            .writing(span, is_safe, meant)
            .report(self.problems);
    }

    /// Reports an argument of a type that the function does not take.
    fn argument_type(
        &mut self,
        row: &Function,
        takes: Type,
        argument: &tree::Value<'s>,
        found: Value,
    ) {
        let name = row.name;
        let problem = match (takes, found) {
            (Type::Angle, Value::Number(number)) => {
                let what = format!("the argument of `{name}`");
                self.bare_angle(&what, argument, number, |_| true)
            }
            _ => {
                let all = match row.takes {
                    [_, _] => format!("two {}", takes.plural()),
                    [_, _, _] => format!("three {}", takes.plural()),
                    _ => takes.noun().to_owned(),
                };
                let (written, found) = (self.quoted(argument.span), found.kind());
                let message = format!("`{name}` takes {all}, and {written} is {}", found.noun());
                let help = format!("call it with {}, such as `{}`", takes.noun(), row.call());
                error("argument_type", message)
                    .at(argument.span, self.described(argument, found))
                    .help(help)
            }
        };
        self.problems.push(problem);
    }

    /// Returns whether all channels of a colour are between 0 and 255. Reports each channel that is
    /// not.
    fn in_range(&mut self, color: Color, arguments: &[Element<'s>]) -> bool {
        let mut fits = true;
        let names = ["red", "green", "blue"];
        for ((channel, name), argument) in color.srgb.into_iter().zip(names).zip(arguments) {
            if (0.0..=255.0).contains(&channel) {
                continue;
            }
            fits = false;
            let (bound, label) = if channel > 255.0 {
                ("255", "too much")
            } else {
                ("0", "too little")
            };
            let found = numbers::comparable(channel, &[0.0, 255.0]);
            let message = format!("the {name} of a colour is from 0 to 255, and this is {found}");
            error("color_range", message)
                .at(argument.value.span, label)
                .help(format!("write `{bound}`, or a number that lies between"))
                .writing(argument.value.span, Applicability::Unsafe, [bound])
                .report(self.problems);
        }
        fits
    }

    /// Warns of an `rgb` whose channels seem to be scaled from 0 to 1 instead of 0 to 255: all are
    /// at most 1, and one is not whole.
    fn unit_parts(&mut self, span: Span, color: Color, arguments: &[Element<'s>]) {
        let parts = color.srgb;
        if parts.iter().any(|part| *part > 1.0) || parts.iter().all(|part| part.fract() == 0.0) {
            return;
        }
        let is_number = |it: &Element<'_>| matches!(it.value.kind, ValueKind::Number(_));
        let meant = format!("rgb({})", parts.map(in_bytes).join(", "));
        let meant = arguments.iter().all(is_number).then_some(meant);
        let message = "the parts of a colour go from 0 to 255, and none of these is more than 1";
        warning("unit_color", message)
            .at(span, "almost black")
            .help(match &meant {
                Some(meant) => format!("write `{meant}`, if 1 is to be full light"),
                None => "multiply each by 255, if 1 is to be full light".to_owned(),
            })
            .writing(span, Applicability::Unsafe, meant)
            .report(self.problems);
    }

    /// Reports a call whose result is infinite or NaN.
    fn not_finite(
        &mut self,
        row: &Function,
        arguments: &[Element<'s>],
        span: Span,
        known: &[Value],
    ) {
        let name = row.name;
        let written = match arguments {
            [only] => shorten(self.sources.text(only.value.span)),
            _ => "…".to_owned(),
        };
        let (message, help) = match name {
            "sqrt" => (
                "a negative number has no square root".to_owned(),
                format!("write `sqrt(abs({written}))` if its size is meant"),
            ),
            "tan" => (
                format!("`tan({written})` is infinite"),
                "a tangent has a value only away from 90deg, 270deg and so on".to_owned(),
            ),
            "asin" | "acos" => (
                format!("`{name}` takes a number from -1 to 1"),
                match known {
                    // The argument is outside of the range from −1 to 1, by more than a rounding
                    // error, so no angle has this sine or cosine. If the argument is a quotient,
                    // the next case also asks whether its operands are in the right order.
                    [Value::Number(x)] if x.abs() > 1.0 + 1e-9 && !written.contains('/') => {
                        "no angle has that".to_owned()
                    }
                    [Value::Number(x)] if x.abs() > 1.0 + 1e-9 => {
                        format!("no angle has that; see whether `{written}` is the right way round")
                    }
                    _ => format!("write `{name}(max(-1, min(1, {written})))` to keep it in range"),
                },
            ),
            "normalize" => (
                "the zero vector has no direction".to_owned(),
                "normalize a vector other than (0, 0, 0)".to_owned(),
            ),
            _ => (
                format!("`{name}` gives a number that is too large"),
                LARGEST.to_owned(),
            ),
        };
        let label = match known {
            [only] => format!("its argument is {only}"),
            _ => "too large".to_owned(),
        };
        self.problems
            .push(error("not_finite", message).at(span, label).help(help));
    }
}

/// Returns the operator that was probably left out between values of these types, if there is one.
fn operator_between(kinds: (Type, Type)) -> Option<char> {
    match kinds {
        (Type::Vector, Type::Vector) | (Type::Angle, Type::Angle) => Some('+'),
        (Type::Number, Type::Number | Type::Vector | Type::Angle)
        | (Type::Vector | Type::Angle, Type::Number) => Some('*'),
        _ => None,
    }
}
