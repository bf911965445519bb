//! Lists: values between parentheses, or between what people write for them.

use std::ops::RangeInclusive;

use super::{Recovery, foreign::Place, is_plain_number};
use crate::{
    diagnostic::{Edit, Fix},
    schema::Type,
    source::Span,
    syntax::{
        problem::{problem, replace, shorten},
        tokens::TokenKind,
        tree::{Element, Name, Value, ValueKind, bad},
    },
};

/// A list as it was read.
struct List<'s> {
    elements: Vec<Element<'s>>,
    /// From its `(` to its `)`.
    span: Span,
    /// Whether it stands in round parentheses.
    is_round: bool,
    /// The values before which a comma is missing.
    gaps: Vec<usize>,
    /// A comma without a value on one side.
    needless: Option<Span>,
}

impl<'s> Recovery<'_, 's> {
    /// Whether braces in place of a value hold a list, rather than fields.
    pub(super) fn is_flat_list(&mut self) -> bool {
        let sign = 1 + usize::from(self.is(1, "-"));
        let is_number = self.kind(sign) == TokenKind::Number;
        self.is(0, "{") && (is_number || (self.is_name(sign) && self.is(sign + 1, ",")))
    }

    /// A vector, a pair, or a value in parentheses.
    pub(super) fn group(&mut self, close: &'static str) -> Value<'s> {
        let takes = self.within.takes;
        let (parts, count) = match takes {
            Some(Type::Vector) => (Some(Type::Number), 3),
            Some(Type::Colors) => (Some(Type::Color), 2),
            Some(Type::Color) => (takes, 3),
            Some(Type::Method) => (None, 1),
            Some(Type::Number | Type::Angle) => (takes, 1),
            None => (None, 3),
        };
        let told = self.problems.len();
        let (start, takes_all) = (self.here(), self.lists == 0);
        let Some(list) = self.list(close, parts, &(count..=count)) else {
            return bad(start.to(self.behind()));
        };
        if !list.is_round && self.problems.len() == told {
            return self.brackets(list);
        }
        let span = list.span;
        let is_vector = takes == Some(Type::Vector) && takes_all;
        if is_vector && list.elements.len() == 4 && self.decimal_comma(&list.elements) {
            return bad(span);
        }
        match self.checked(list, &(count..=count)) {
            None => bad(span),
            Some(elements) => {
                let kind = match <[Element<'s>; 1]>::try_from(elements) {
                    Ok([only]) => ValueKind::Parentheses(Box::new(only.value)),
                    Err(elements) => ValueKind::Tuple(elements),
                };
                Value { kind, span }
            }
        }
    }

    /// The call of a function whose name was read.
    pub(super) fn call(&mut self, function: Name<'s>) -> Value<'s> {
        let (told, count) = (self.problems.len(), self.words.arguments(function.text));
        let start = self.here();
        let list = self.list(")", None, &count);
        let span = function.span.to(start.to(self.behind()));
        let Some(list) = list else { return bad(span) };
        if self.words.is_foreign_function(function.text) && self.problems.len() == told {
            return self.foreign_function(function, list.elements, span);
        }
        let parentheses = list.span;
        match self.checked(list, &count) {
            Some(elements) => self.call_of(function, elements, parentheses),
            None => bad(span),
        }
    }

    /// `vec3(1, 2, 3)` and `rgba(255, 0, 0, 1)`
    fn foreign_function(
        &mut self,
        name: Name<'s>,
        elements: Vec<Element<'s>>,
        span: Span,
    ) -> Value<'s> {
        let values = elements.into_iter().map(|element| element.value);
        let mut values: Vec<Value<'s>> = values.collect();
        let is_color = matches!(name.text, "rgba" | "color" | "Color");
        if is_color && values.len() == 4 {
            values.truncate(3);
        }
        let (function, takes, help) = match is_color {
            true => (
                "rgb",
                Type::Color,
                "write a colour as `rgb(255, 165, 0)`, `#ffa500` or `orange`",
            ),
            false => ("", Type::Vector, "write a vector as `(1, 2, 3)`"),
        };
        let fits = values.len() == 3 && self.within.takes.is_none_or(|t| t == takes);
        let right = format!("{function}({})", self.list_of(&values));
        let fix = fits.then(|| replace(span, right));
        let message = format!("`{}` is a function of another language", name.text);
        let label = "not a function of this language";
        self.problems
            .push(problem("foreign_function", message, name.span, label).with_fix_or(fix, help));
        bad(span)
    }

    /// What is between parentheses, however it is separated; none if its end is missing.
    fn list(
        &mut self,
        close: &'static str,
        parts: Option<Type>,
        count: &RangeInclusive<usize>,
    ) -> Option<List<'s>> {
        if self.is_too_deep() {
            self.pass_over();
            return None;
        }
        let open = self.bump();
        let takes = std::mem::replace(&mut self.within.takes, parts);
        self.depth += 1;
        self.lists += 1;
        let list = self.parts(open, close, count);
        self.lists -= 1;
        self.depth -= 1;
        self.within.takes = takes;
        list.filter(|_| !self.too_deep)
    }

    fn parts(
        &mut self,
        open: Span,
        close: &'static str,
        count: &RangeInclusive<usize>,
    ) -> Option<List<'s>> {
        let mut elements: Vec<Element<'s>> = Vec::new();
        let (mut gaps, mut needless) = (Vec::new(), None);
        loop {
            let is_value_next = elements.last().is_none_or(|last| last.comma.is_some());
            self.comments(match is_value_next {
                true => Place::Value,
                false => Place::Operator,
            });
            if self.too_deep {
                return None;
            }
            let word = self.word(0);
            if word == close || (matches!(word, ")" | "]") && close != "}") {
                let end = self.bump();
                if let Some(comma) = elements.last().and_then(|last| last.comma) {
                    needless = needless.or(Some(comma));
                }
                return Some(List {
                    elements,
                    span: open.to(end),
                    is_round: close == ")" && word == ")",
                    gaps,
                    needless,
                });
            }
            if word == "," {
                let comma = self.bump();
                match elements.last_mut() {
                    Some(last) if last.comma.is_none() => last.comma = Some(comma),
                    _ => needless = needless.or(Some(comma)),
                }
            } else if self.ends_list() {
                let is_plain = gaps.is_empty() && needless.is_none() && !is_value_next;
                let is_fixed = is_plain && count.contains(&elements.len());
                self.unclosed(open, close, is_fixed);
                let span = open.to(self.behind());
                return is_fixed.then_some(List {
                    elements,
                    span,
                    is_round: true,
                    gaps,
                    needless,
                });
            } else {
                if !is_value_next {
                    gaps.push(elements.len());
                }
                let at = self.last_end;
                let value = self.expression();
                if self.last_end == at {
                    self.bump();
                }
                elements.push(Element { value, comma: None });
            }
        }
    }

    /// Whether a list must have ended before this: a brace, the end, `let`, or the name of a field.
    fn ends_list(&mut self) -> bool {
        let word = self.word(0);
        match self.kind(0) {
            TokenKind::End => true,
            TokenKind::Name => {
                word == "let"
                    || (self.is_field_name(word) && !self.words.is_value(word))
                    || (self.is_on_new_line(0) && (self.is_head(0) || !self.within.is_block))
            }
            TokenKind::Sign if word == "{" => !self.is_flat_list(),
            TokenKind::Sign => matches!(word, "}" | ";" | "="),
            _ => false,
        }
    }

    fn unclosed(&mut self, open: Span, close: &str, is_fixed: bool) {
        let (word, at) = (self.word(0), self.last_end);
        // A field's name behind which no value stands does not end a list, nor does a sign.
        let is_end = matches!(word, "" | "}") || (self.is_name(0) && self.starts_value(1));
        let before = match word {
            "" => "at the end".to_owned(),
            word => format!("before `{}`", shorten(word)),
        };
        let fix = (is_fixed && is_end).then(|| match close {
            ")" => Fix::new(
                format!("write `)` {before}"),
                [Edit::insert(self.id, at, ")")],
            ),
            _ => Fix::new(
                format!("write `(…)` {before}"),
                [Edit::new(open, "("), Edit::insert(self.id, at, ")")],
            ),
        });
        let message = "a parenthesis is never closed";
        self.problems.push(
            problem("unclosed_parenthesis", message, open, "opened here")
                .with_fix_or(fix, "write `)` where it ends"),
        );
    }

    /// The values of a list, if it is known how many they are.
    fn checked(
        &mut self,
        list: List<'s>,
        count: &RangeInclusive<usize>,
    ) -> Option<Vec<Element<'s>>> {
        let fits = count.contains(&list.elements.len());
        if let Some(comma) = list.needless {
            self.comma_without_value(comma, fits);
            return fits.then_some(list.elements);
        }
        let Some(&first) = list.gaps.first() else {
            return Some(list.elements);
        };
        let elements = list.elements;
        if elements
            .iter()
            .any(|element| element.value.kind == ValueKind::Bad)
        {
            return None;
        }
        let (left, right) = (elements.get(first - 1)?, elements.get(first)?);
        if !fits && is_plain_number(&left.value) && self.is_factor(&right.value) {
            self.product(left.value.clone(), right.value.clone());
            return None;
        }
        let (l, r) = (self.short(left.value.span), self.short(right.value.span));
        let message = format!("a comma is missing between `{l}` and `{r}`");
        let span = right.value.span;
        let fix = fits.then(|| {
            let before = list.gaps.iter().filter_map(|&gap| elements.get(gap - 1));
            let edits = before.map(|e| Edit::insert(self.id, e.value.span.end, ","));
            let texts: Vec<String> = elements.iter().map(|e| self.short(e.value.span)).collect();
            Fix::new(format!("write `({})`", shorten(&texts.join(", "))), edits)
        });
        let help = "write a comma or an operator between them, or take one away";
        self.problems.push(
            problem(
                "missing_comma",
                message,
                span,
                "a comma should stand before this",
            )
            .with_fix_or(fix, help),
        );
        fits.then_some(elements)
    }

    fn comma_without_value(&mut self, comma: Span, fits: bool) {
        let found = match fits {
            true => {
                let label = "no value stands on one side of it";
                let edit = Edit::remove_in(comma, self.text);
                let mut found =
                    problem("needless_comma", "this comma is one too many", comma, label)
                        .with_help("take it away; a comma stands between two values only")
                        .with_fix(Fix::new("remove this comma", [edit]));
                found.is_needless = true;
                found
            }
            false => {
                let message = "a value is missing beside this comma";
                problem("missing_value", message, comma, "something is missing here")
                    .with_help("write a value on both sides of it, such as `(1, 0, 3)`")
            }
        };
        self.problems.push(found);
    }

    /// A list in other brackets.
    fn brackets(&mut self, list: List<'s>) -> Value<'s> {
        let span = list.span;
        let takes = self.within.takes;
        let (what, function, count) = match takes {
            Some(Type::Color) => ("a colour", "rgb", 3),
            Some(Type::Colors) => ("a pair of colours", "", 2),
            _ => ("a vector", "", 3),
        };
        let fits = list.elements.len() == count && list.needless.is_none();
        let values: Vec<Value<'s>> = list.elements.into_iter().map(|e| e.value).collect();
        let right = format!("{function}({})", self.list_of(&values));
        let message = format!("{what} stands in round parentheses");
        let help = self.example();
        self.problems.push(
            problem("brackets", message, span, "not in these")
                .with_fix_or(fits.then(|| replace(span, right)), help),
        );
        match (fits, function) {
            (false, _) => bad(span),
            (true, "") => Value {
                kind: ValueKind::Tuple(super::values::elements(values)),
                span,
            },
            (true, text) => {
                self.call_of(Name { text, span }, super::values::elements(values), span)
            }
        }
    }

    /// `(3, 3,5, 8)`: a comma right between two digits, where blanks follow the others.
    fn decimal_comma(&mut self, elements: &[Element<'s>]) -> bool {
        let is_number = |value: &Value<'s>| matches!(value.kind, ValueKind::Number(_));
        let tight = elements.windows(2).filter_map(|pair| {
            let [a, b] = pair else { return None };
            let comma = a.comma?;
            let gap = b.value.span.start - a.value.span.end;
            (gap == 1 && is_number(&b.value)).then_some((a.value.span, comma, b.value.span))
        });
        let tight: Vec<(Span, Span, Span)> = tight.collect();
        let &[(left, comma, right)] = tight.as_slice() else {
            return false;
        };
        let number = format!("{}.{}", self.written(left), self.written(right));
        let fix = Fix::new(format!("write `{number}`"), [Edit::new(comma, ".")]);
        let message = "a decimal point is written `.`, not `,`";
        let label = "a comma separates the parts of a vector";
        self.problems
            .push(problem("decimal_comma", message, comma, label).with_fix(fix));
        true
    }
}
