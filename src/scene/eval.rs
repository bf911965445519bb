//! The value of an expression.
//!
//! In: a value's tree and the names that are defined. Out: what it is, or problems. A value that failed is unknown (`None`),
//! and what uses it stays silent. What a value is for is not known here, beyond the type that is wanted.

use std::{
    cell::{Cell, RefCell},
    collections::{HashMap, HashSet, hash_map::Entry},
};

use glam::DVec3;

use super::{
    css,
    error::Problem,
    schema::{self, Function, Type},
    value::{self, Value},
};
use crate::{
    color::Color,
    math::Angle,
    numbers,
    source::{SourceId, Sources, Span},
    suggest::{self, Budget},
    syntax::{
        shorten,
        tree::{self, Call, Element, Name, Operator, Step, Unit, ValueKind},
    },
};

/// The names that are defined at some place.
#[derive(Debug, Default)]
pub struct Names<'s> {
    /// The `let`s so far.
    defined: HashMap<&'s str, Defined>,
    /// The same names, in order.
    order: Vec<&'s str>,
    /// The names of the whole file; none while it is still being read.
    whole: Option<Whole<'s>>,
    /// Whether something was asked about the whole file before it was read.
    asked_early: Cell<bool>,
    /// The comparisons that are left in search of the nearest name.
    budget: Budget,
    /// The names that were reported, with the problem's index: the next use of the same name is another label of it.
    reported: RefCell<HashMap<&'s str, usize>>,
}

/// The names that stand in a file, wherever.
#[derive(Debug, Default)]
struct Whole<'s> {
    /// Every `let`.
    definitions: HashMap<&'s str, Span>,
    /// The names of objects, which are no values.
    objects: HashSet<&'s str>,
}

#[derive(Clone, Copy, Debug)]
struct Defined {
    /// None if it failed.
    value: Option<Value>,
    /// The name in the definition.
    place: Span,
    /// The argument that set it, if one did.
    set: Option<SourceId>,
}

impl<'s> Names<'s> {
    /// No name is defined yet; these will be.
    pub fn new(
        everywhere: impl IntoIterator<Item = Name<'s>>,
        objects: impl IntoIterator<Item = &'s str>,
    ) -> Self {
        let mut whole = Whole {
            objects: objects.into_iter().collect(),
            definitions: HashMap::new(),
        };
        for name in everywhere {
            whole.definitions.entry(name.text).or_insert(name.span);
        }
        Self {
            whole: Some(whole),
            ..Self::default()
        }
    }

    /// Whether something was asked about the names of the whole file, which are not known: what was made of the answers
    /// does not count.
    pub fn were_asked_early(&self) -> bool {
        self.asked_early.get()
    }

    fn whole(&self) -> Option<&Whole<'s>> {
        if self.whole.is_none() {
            self.asked_early.set(true);
        }
        self.whole.as_ref()
    }

    /// Defines a name; a second time it keeps its value.
    pub fn define(&mut self, name: Name<'s>, value: Option<Value>, set: Option<SourceId>) {
        if let Entry::Vacant(free) = self.defined.entry(name.text) {
            self.order.push(name.text);
            free.insert(Defined {
                value,
                place: name.span,
                set,
            });
        }
    }

    /// Where a name was defined, if it was.
    pub fn place(&self, name: &str) -> Option<Span> {
        self.defined.get(name).map(|defined| defined.place)
    }

    /// The first `let` of the file that defines it.
    fn definition(&self, name: &str) -> Option<Span> {
        self.whole()?.definitions.get(name).copied()
    }

    /// Whether it is the name of an object.
    fn is_object(&self, name: &str) -> bool {
        self.whole()
            .is_some_and(|whole| whole.objects.contains(name))
    }

    /// Whether any `let` of the file defines it.
    pub fn knows(&self, name: &str) -> bool {
        self.definition(name).is_some()
    }

    /// The names that are defined so far, to search for the nearest; none if there was enough of searching.
    fn to_compare(&self) -> Option<&[&'s str]> {
        const PREDEFINED: usize = 200;
        let enough = self.budget.spend(self.order.len() + PREDEFINED);
        enough.then_some(&self.order)
    }

    /// The comparisons that are left in search of the nearest name.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Every name that the file defines.
    pub fn all(&self) -> impl Iterator<Item = &'s str> {
        let whole = self.whole().into_iter();
        whole.flat_map(|whole| whole.definitions.keys().copied())
    }
}

/// What a predefined name is, if it is one.
pub fn predefined(name: &str) -> Option<&'static str> {
    if css::color(name).is_some() {
        Some("a colour")
    } else if schema::function(name).is_some() {
        Some("a function")
    } else {
        let constant = schema::CONSTANTS
            .iter()
            .any(|&(constant, _)| constant == name);
        match name {
            "pi" if constant => Some("a number"),
            _ if constant => Some("a unit"),
            _ => None,
        }
    }
}

/// Evaluates values, and collects what is wrong with them.
#[derive(Debug)]
pub struct Evaluator<'a, 's> {
    /// The texts.
    pub sources: &'s Sources,
    /// The names that can be used.
    pub names: &'a Names<'s>,
    /// What is wrong.
    pub problems: &'a mut Vec<Problem>,
}

impl<'s> Evaluator<'_, 's> {
    /// The value of an expression; `wanted` is the type that would fit, if one is known.
    pub fn value(&mut self, value: &tree::Value<'s>, wanted: Option<Type>) -> Option<Value> {
        match &value.kind {
            ValueKind::Number(written) => Some(Value::Number(self.number(written, value.span)?)),
            ValueKind::Angle { number, unit } => {
                let number = self.number(number, value.span)?;
                Some(Value::Angle(match unit {
                    Unit::Degrees => Angle::from_degrees(number),
                    Unit::Radians => Angle::from_radians(number),
                }))
            }
            ValueKind::ColorCode(written) => color_code(written).map(Value::Color),
            ValueKind::Name(name) => self.name(name, value.span, wanted),
            ValueKind::Call(call) => self.call(call, wanted),
            ValueKind::Parentheses(inner) => self.value(inner, wanted),
            ValueKind::Tuple(elements) => self.tuple(elements, value.span, wanted),
            ValueKind::Negation { sign, operand } => self.negation(*sign, operand),
            ValueKind::Chain { first, rest } => self.chain(first, rest),
            ValueKind::Missing | ValueKind::Bad => None,
        }
    }

    fn number(&mut self, written: &str, span: Span) -> Option<f64> {
        let number: f64 = if written.contains('_') {
            written.replace('_', "").parse().ok()?
        } else {
            written.parse().ok()?
        };
        if number.is_infinite() {
            let written = shorten(written);
            self.problems
                .push(Problem::NumberTooLarge { written, span });
            return None;
        }
        let mantissa = written.split(['e', 'E']).next().unwrap_or_default();
        if number == 0.0 && mantissa.contains(|digit| matches!(digit, '1'..='9')) {
            let written = shorten(written);
            self.problems
                .push(Problem::NumberUnderflow { written, span });
        }
        Some(number)
    }

    fn name(&mut self, name: &'s str, span: Span, wanted: Option<Type>) -> Option<Value> {
        if let Some(defined) = self.names.defined.get(name) {
            return defined.value;
        }
        if let Some(color) = css::color(name) {
            return Some(Value::Color(color));
        }
        match name {
            "pi" => return Some(Value::Number(std::f64::consts::PI)),
            "deg" => return Some(Value::Angle(Angle::from_degrees(1.0))),
            "rad" => return Some(Value::Angle(Angle::from_radians(1.0))),
            _ => {}
        }
        if let Some(function) = schema::function(name) {
            self.problems.push(Problem::FunctionWithoutArguments {
                name: name.to_owned(),
                example: example(function),
                span,
            });
            return None;
        }
        let mut reported = self.names.reported.borrow_mut();
        if let Some(&index) = reported.get(name) {
            if let Some(problem) = self.problems.get_mut(index) {
                problem.and_here(span);
            }
            return None;
        }
        reported.insert(name, self.problems.len());
        drop(reported);
        let problem = match self.names.definition(name) {
            Some(definition) => self.used_before(name, span, definition),
            None => self.unknown_name(name, span, wanted),
        };
        self.problems.push(problem);
        None
    }

    fn used_before(&self, name: &str, span: Span, definition: Span) -> Problem {
        let own = span.source == SourceId::File
            && self.sources.file.line(span.start) == self.sources.file.line(definition.start)
            && definition.start < span.start;
        let help = match span.source {
            SourceId::Set(_) => format!("move `let {name}` before what is set"),
            SourceId::File if own => {
                "a `let` cannot use itself: write a value, or the name of an earlier `let`"
                    .to_owned()
            }
            SourceId::File => {
                let line = self.sources.file.line(span.start);
                format!("move `let {name}` up, before line {line}")
            }
        };
        Problem::UsedBeforeDefinition {
            name: name.to_owned(),
            help,
            line: self.sources.get(definition.source).line(definition.start),
            span,
            definition,
            more: Vec::new(),
        }
    }

    fn unknown_name(&self, name: &str, span: Span, wanted: Option<Type>) -> Problem {
        let colors = matches!(wanted, Some(Type::Color | Type::Colors));
        let lets = self.names.to_compare();
        let near = lets.and_then(|lets| nearest(name, lets, wanted));
        let name = name.to_owned();
        if colors {
            let help = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => "write a CSS colour's name, `#rrggbb` or `rgb(r, g, b)`".to_owned(),
            };
            return Problem::UnknownColor {
                name,
                help,
                span,
                more: Vec::new(),
            };
        }
        let help = match near {
            _ if self.names.is_object(&name) => {
                "an object is no value: define its place with `let`, and use that in both"
                    .to_owned()
            }
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("define it before it is used: `let {name} = …`"),
        };
        Problem::UnknownName {
            name,
            help,
            span,
            more: Vec::new(),
        }
    }

    fn call(&mut self, call: &Call<'s>, wanted: Option<Type>) -> Option<Value> {
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
        if let Value::Color(color) = result
            && !self.in_range(color, arguments)
        {
            return None;
        }
        self.finite_call(row, arguments, function.span, &known, result)
    }

    fn unknown_function(&mut self, function: &Name<'s>, arguments: &[Element<'s>]) {
        for argument in arguments {
            self.value(&argument.value, None);
        }
        let functions = schema::FUNCTIONS.iter().map(|function| function.name);
        let near = suggest::nearest(function.text, functions);
        let is_let = self.names.defined.contains_key(function.text);
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
        self.problems.push(Problem::UnknownFunction {
            name: function.text.to_owned(),
            help,
            span: function.span,
            label,
        });
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
        self.problems.push(Problem::ArgumentCount {
            name: row.name.to_owned(),
            takes,
            are,
            example: self.argument_example(row, arguments),
            span,
            label: match found {
                0 => "no value".to_owned(),
                count => values(count),
            },
        });
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
                None => example(row),
            },
        }
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
            let [degrees, radians] = self.with_units(argument);
            self.problems.push(Problem::BareAngle {
                what: format!("the argument of `{}`", row.name),
                written,
                help: format!("write `{0}({degrees})` (or `{0}({radians})`)", row.name),
                span: argument.span,
                label,
            });
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
            self.problems.push(Problem::ColorRange {
                channel: name,
                found: numbers::beside(channel, &[0.0, 255.0]),
                help: format!("write `{bound}`, or a number that lies between"),
                span: argument.value.span,
                label,
            });
        }
        fits
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
        self.problems.push(Problem::NotFinite {
            message,
            help,
            span,
            label,
        });
        None
    }

    fn tuple(
        &mut self,
        elements: &[Element<'s>],
        span: Span,
        wanted: Option<Type>,
    ) -> Option<Value> {
        let part = match wanted {
            Some(Type::Colors) => Some(Type::Color),
            Some(Type::Vector) => Some(Type::Number),
            _ if elements.len() == 3 => Some(Type::Number),
            _ => None,
        };
        let mut values = Vec::with_capacity(elements.len());
        for element in elements {
            values.push(self.value(&element.value, part));
        }
        if let &[
            Some(Value::Number(x)),
            Some(Value::Number(y)),
            Some(Value::Number(z)),
        ] = values.as_slice()
        {
            return Some(Value::Vector(DVec3::new(x, y, z)));
        }
        if let &[Some(Value::Color(first)), Some(Value::Color(second))] = values.as_slice() {
            return Some(Value::Colors([first, second]));
        }
        let colors = values.iter().flatten().any(|v| v.kind() == Type::Color);
        let pair = match elements.len() {
            2 => colors || wanted == Some(Type::Colors),
            _ => wanted == Some(Type::Colors),
        };
        self.wrong_part(elements, &values, pair);
        let fits = elements.len() == if pair { 2 } else { 3 };
        if !fits && values.iter().all(Option::is_some) {
            let kinds = if pair { Type::Color } else { Type::Number };
            if values.iter().flatten().all(|value| value.kind() == kinds) {
                self.tuple_size(elements, span, pair);
            }
        }
        None
    }

    /// Reports the first part of a vector that is no number, or of a pair that is no colour.
    fn wrong_part(&mut self, elements: &[Element<'s>], values: &[Option<Value>], pair: bool) {
        let (whole, parts, takes) = match pair {
            true => ("a pair of colours", "colours", Type::Color),
            false => ("a vector", "numbers", Type::Number),
        };
        let wrong = |value: &Option<Value>| value.is_some_and(|v| v.kind() != takes);
        let found = values.iter().zip(elements).find(|(value, _)| wrong(value));
        let Some((&Some(value), element)) = found else {
            return;
        };
        let help = match (pair, value.kind()) {
            (true, _) => "write two colours, such as `(gray, white)`",
            (false, Type::Vector) => "write `v + w` to add vectors; a vector has no parts to name",
            (false, Type::Angle) => "an angle divided by `1deg` is a number",
            _ => "write three numbers, such as `(0, 1, 0)`",
        };
        let label = self.described(&element.value, value.kind());
        let written = self.quoted(element.value.span);
        self.problems.push(Problem::PartType {
            whole,
            parts,
            written,
            found: value.kind().noun(),
            help: help.to_owned(),
            span: element.value.span,
            label,
        });
    }

    fn tuple_size(&mut self, elements: &[Element<'s>], span: Span, pair: bool) {
        let parts = |count: usize| match count {
            0 => "none".to_owned(),
            1 => "one".to_owned(),
            2 => "two".to_owned(),
            3 => "three".to_owned(),
            4 => "four".to_owned(),
            5 => "five".to_owned(),
            count => count.to_string(),
        };
        let texts: Vec<String> = elements
            .iter()
            .map(|element| shorten(self.sources.text(element.value.span)))
            .collect();
        if pair {
            self.problems.push(Problem::PartCount {
                whole: "a pair of colours has two parts",
                count: parts(elements.len()),
                help: match texts.as_slice() {
                    [first, second, ..] => format!("write `({first}, {second})`"),
                    _ => "write two colours, such as `(gray, white)`".to_owned(),
                },
                span,
                label: format!("{} colours", parts(elements.len())),
            });
            return;
        }
        let help = match texts.as_slice() {
            [] => "write three numbers, such as `(0, 1, 0)`".to_owned(),
            [x, y] => format!("write a third number, such as `({x}, {y}, 1)`"),
            [x, y, z, ..] => format!("write `({x}, {y}, {z})`"),
            [x] => format!("write `({x}, {x}, {x})`"),
        };
        self.problems.push(Problem::PartCount {
            whole: "a vector has three parts",
            count: parts(elements.len()),
            help,
            span,
            label: match elements.len() {
                0 => "nothing".to_owned(),
                count => format!("{} numbers", parts(count)),
            },
        });
    }

    fn negation(&mut self, sign: Span, operand: &tree::Value<'s>) -> Option<Value> {
        let value = self.value(operand, None)?;
        let negative = value::negate(value);
        if negative.is_none() {
            let right_label = self.described(operand, value.kind());
            self.problems.push(Problem::OperandTypes {
                message: format!("{} has no negative", value.kind().noun()),
                help: "take the `-` away; only numbers, angles and vectors have a sign".to_owned(),
                operator: sign,
                left: None,
                left_label: String::new(),
                right: operand.span,
                right_label,
            });
        }
        negative
    }

    fn chain(&mut self, first: &tree::Value<'s>, rest: &[Step<'s>]) -> Option<Value> {
        let mut left = self.value(first, None);
        let mut span = first.span;
        for (index, step) in rest.iter().enumerate() {
            let right = self.value(&step.operand, None);
            left = match (left, right) {
                (Some(a), Some(b)) => {
                    let named = (index == 0).then_some(first);
                    self.step(step, (a, span, named), b)
                }
                _ => None,
            };
            span = span.to(step.operand.span);
        }
        left
    }

    /// One operation; of the left operand its value, its place, and its tree if it is not a result itself.
    fn step(
        &mut self,
        step: &Step<'s>,
        (left, left_span, left_tree): (Value, Span, Option<&tree::Value<'s>>),
        right: Value,
    ) -> Option<Value> {
        let Some(result) = value::operate(step.operator, left, right) else {
            let left_label = match left_tree {
                Some(tree) => self.described(tree, left.kind()),
                None => left.kind().noun().to_owned(),
            };
            let right_label = self.described(&step.operand, right.kind());
            let help = self.operand_help(step, (left, left_span), right);
            self.problems.push(Problem::OperandTypes {
                message: cannot(step.operator, left.kind(), right.kind()),
                help,
                operator: step.sign,
                left: Some(left_span),
                left_label,
                right: step.operand.span,
                right_label,
            });
            return None;
        };
        if result.is_finite() {
            return Some(result);
        }
        let by_zero = step.operator == Operator::Divide
            && matches!(
                right,
                Value::Number(0.0)
                    | Value::Angle(Angle {
                        degrees: 0.0,
                        radians: 0.0
                    })
            );
        let problem = if by_zero {
            let written = shorten(self.sources.text(step.operand.span));
            let zero = matches!(&step.operand.kind, ValueKind::Number(_));
            Problem::NotFinite {
                message: "this divides by zero".to_owned(),
                help: match zero {
                    true => "divide by a number other than 0".to_owned(),
                    false => format!("make `{written}` other than 0; it is 0 here"),
                },
                span: step.sign,
                label: "the right side is 0".to_owned(),
            }
        } else {
            Problem::NotFinite {
                message: "the result of this is too large".to_owned(),
                help: "numbers go up to 1.7976931348623157e308".to_owned(),
                span: step.sign,
                label: "too large from here on".to_owned(),
            }
        };
        self.problems.push(problem);
        None
    }

    fn operand_help(&self, step: &Step<'s>, left: (Value, Span), right: Value) -> String {
        use Type::{Angle, Color, Colors, Number, Vector};
        let text = |span| shorten(self.sources.text(span));
        let (a, b) = (text(left.1), text(step.operand.span));
        let sign = step.operator.sign();
        let sum = matches!(step.operator, Operator::Add | Operator::Subtract);
        match (left.0.kind(), right.kind()) {
            (Color | Colors, _) | (_, Color | Colors) => {
                "colours are not computed with; `rgb(r, g, b)` takes computed numbers".to_owned()
            }
            (Vector, Number) if sum => format!(
                "add a vector, such as `{a} {sign} ({b}, {b}, {b})`, or scale it: `{a} * {b}`"
            ),
            (Number, Vector) if sum => format!(
                "write a vector, such as `({a}, {a}, {a}) {sign} {b}`, or scale it: `{a} * {b}`"
            ),
            (Vector, Vector) if step.operator == Operator::Multiply => {
                format!("write `dot({a}, {b})` for a number, or `cross({a}, {b})` for a vector")
            }
            (_, Vector) if step.operator == Operator::Divide => {
                format!("divide by a number, such as `length({b})`")
            }
            (Angle, Number) if sum => {
                let [degrees, radians] = self.with_units(&step.operand);
                format!("give it a unit: `{a} {sign} {degrees}` (or `{radians}`)")
            }
            (Number, Angle) if sum => {
                format!("give {a} a unit: `{a}deg {sign} {b}` (or `{a}rad`)")
            }
            (Angle, Angle) => {
                format!("an angle divided by `1deg` is a number: `{a} * ({b} / 1deg)`")
            }
            (Number, Angle) => {
                format!("an angle divided by `1deg` is a number: `{a} / ({b} / 1deg)`")
            }
            _ => "only numbers, angles and vectors of one kind go together".to_owned(),
        }
    }

    /// What a value is, and where its name was defined if it is one.
    pub fn described(&self, value: &tree::Value<'s>, kind: Type) -> String {
        let noun = kind.noun();
        let ValueKind::Name(name) = value.kind else {
            return noun.to_owned();
        };
        match self.names.defined.get(name) {
            Some(Defined { set: Some(set), .. }) => {
                format!("{noun} (from {})", self.sources.get(*set).name())
            }
            Some(defined) => {
                let line = self.sources.file.line(defined.place.start);
                format!("{noun} (defined in line {line})")
            }
            None => noun.to_owned(),
        }
    }

    /// A number's spelling as an angle, in degrees and in radians.
    pub fn with_units(&self, value: &tree::Value<'s>) -> [String; 2] {
        let written = shorten(self.sources.text(value.span));
        let literal = match &value.kind {
            ValueKind::Negation { operand, .. } => matches!(operand.kind, ValueKind::Number(_)),
            kind => matches!(kind, ValueKind::Number(_)),
        };
        ["deg", "rad"].map(|unit| match (literal, &value.kind) {
            (true, _) => format!("{written}{unit}"),
            (false, ValueKind::Chain { .. }) => format!("({written}) * 1{unit}"),
            (false, _) => format!("{written} * 1{unit}"),
        })
    }

    /// What stands under a span, for a message: a literal as it is, anything else in backquotes.
    pub fn quoted(&self, span: Span) -> String {
        let written = shorten(self.sources.text(span));
        let literal = written
            .starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '(' | '.'))
            && !written.contains(['`', '*', '/']);
        match literal {
            true => written,
            false => format!("`{written}`"),
        }
    }
}

/// The nearest name: of the colours where one is wanted, otherwise of what can be computed with.
fn nearest<'n>(name: &str, lets: &[&'n str], wanted: Option<Type>) -> Option<&'n str> {
    let lets = lets.iter().copied();
    let colors = css::names().map(|name| name as &str);
    if matches!(wanted, Some(Type::Color | Type::Colors)) {
        return suggest::nearest(name, lets.chain(colors));
    }
    let constants = schema::CONSTANTS.iter().map(|&(name, _)| name);
    let functions = schema::FUNCTIONS.iter().map(|function| function.name);
    let near = suggest::nearest(name, lets.chain(constants).chain(functions));
    near.or_else(|| match wanted {
        None => suggest::nearest(name, colors),
        Some(_) => None,
    })
}

/// How a function is called.
fn example(function: &Function) -> String {
    let arguments = match function.takes {
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

fn cannot(operator: Operator, left: Type, right: Type) -> String {
    let (a, b) = (left.noun(), right.noun());
    let both = match left == right {
        true => left.two().to_owned(),
        false => format!("{a} and {b}"),
    };
    match operator {
        Operator::Add => format!("{both} cannot be added"),
        Operator::Subtract => format!("{b} cannot be subtracted from {a}"),
        Operator::Multiply => format!("{both} cannot be multiplied"),
        Operator::Divide => format!("{a} cannot be divided by {b}"),
    }
}

/// A colour from its code; the parser checked the number of digits.
fn color_code(written: &str) -> Option<Color> {
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
