//! Lists: values between parentheses, or between what people write for them.

use std::ops::RangeInclusive;

use super::{Recovery, example, foreign::Place, is_plain_number};
use crate::{
    color::{are_shares, whole_parts},
    diagnostic::{Edit, Fix},
    schema::{self, Type},
    source::Span,
    syntax::{
        NESTING_LIMIT, messages as say,
        problem::{replace, shorten},
        tokens::TokenKind,
        tree::{Element, Name, Value, ValueKind, bad, call, group},
    },
};

/// How many values a list may have.
type Count = RangeInclusive<usize>;

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
            Some(Type::Vector) => (Some(Type::Number), 3..=3),
            Some(Type::Colors) => (Some(Type::Color), 2..=2),
            Some(Type::FaceColors) => (Some(Type::Color), 3..=3),
            Some(Type::Number | Type::Angle) => (takes, 1..=1),
            Some(Type::Color) => (takes, 3..=3),
            Some(Type::Method) | None => (None, 3..=3),
        };
        let (start, told) = (self.here(), self.problems.len());
        let Some(list) = self.list(close, parts, &count) else {
            return bad(start.to(self.behind()));
        };
        let span = list.span;
        if !list.is_round && self.problems.len() == told {
            return self.brackets(list, None);
        }
        let Some(elements) = self.checked(list, &count) else {
            return bad(span);
        };
        Value::new(group(elements), span)
    }

    /// The call of a function whose name was read.
    pub(super) fn call(&mut self, function: Name<'s>) -> Value<'s> {
        let told = self.problems.len();
        let count = match schema::function(function.text) {
            Some(row) if row.more => row.takes.len()..=usize::MAX,
            Some(row) => row.takes.len()..=row.takes.len(),
            None => 0..=0,
        };
        let Some(list) = self.list(")", None, &count) else {
            return bad(function.span.to(self.behind()));
        };
        let parentheses = list.span;
        if self.words.is_foreign_function(function.text) && self.problems.len() == told {
            return self.foreign_function(function, list);
        }
        // `rgb(100%, 0%, 0%)`, and what another function of colours takes
        let is_known = schema::function(function.text).is_some();
        if self.problems.len() > told + 1 && self.written(parentheses).contains('%') {
            self.problems.truncate(told);
            if is_known {
                let help = ["%", "write `255` for `100%`"];
                self.report(&say::UNKNOWN_OPERATOR, parentheses, &help, None);
            }
        }
        match self.checked(list, &count) {
            Some(elements) => call(function, elements, parentheses),
            None => bad(function.span.to(parentheses)),
        }
    }

    /// Whether the call of a function of another language starts here. It is a value on a new line,
    /// too.
    pub(super) fn is_foreign_call(&mut self) -> bool {
        self.words.is_foreign_function(self.word(0)) && self.is(1, "(")
    }

    /// `vec3(1, 2, 3)` and `rgba(255, 0, 0, 1)`
    fn foreign_function(&mut self, name: Name<'s>, list: List<'s>) -> Value<'s> {
        let span = name.span.to(list.span);
        let mut values: Vec<Value<'s>> = list.elements.into_iter().map(|e| e.value).collect();
        let (function, takes) = match (name.text, self.within.takes) {
            ("rgba" | "color" | "Color", _) | (_, Some(Type::Color)) => ("rgb", Type::Color),
            _ => ("", Type::Vector),
        };
        if takes == Type::Color && values.len() == 4 {
            values.truncate(3);
        }
        let fits = values.len() == 3 && self.within.takes.is_none_or(|t| t == takes);
        let mut list = self.list_of(&values);
        if takes == Type::Color {
            list = whole_parts(&list);
        }
        let right = format!("{function}({list})");
        let fix = fits.then(|| replace(span, right));
        let words = [name.text, example(Some(takes))];
        self.report(&say::FOREIGN_FUNCTION, name.span, &words, fix);
        bad(span)
    }

    /// What is between parentheses, however it is separated; none if its end is missing.
    fn list(
        &mut self,
        close: &'static str,
        parts: Option<Type>,
        count: &Count,
    ) -> Option<List<'s>> {
        if self.depth >= NESTING_LIMIT {
            self.pass_over();
            return None;
        }
        let takes = std::mem::replace(&mut self.within.takes, parts);
        self.depth += 1;
        self.lists += 1;
        let list = self.parts(close, count);
        self.lists -= 1;
        self.depth -= 1;
        self.within.takes = takes;
        list.filter(|_| !self.too_deep)
    }

    fn parts(&mut self, close: &'static str, count: &Count) -> Option<List<'s>> {
        let open = self.bump();
        let mut list = List {
            elements: Vec::new(),
            span: open,
            is_round: close == ")",
            gaps: Vec::new(),
            needless: None,
        };
        // Reported once, however many there are.
        let (mut semicolons, mut labels, told) = (Vec::new(), Vec::new(), self.problems.len());
        loop {
            let is_value_next = list.elements.last().is_none_or(|last| last.comma.is_some());
            self.comments(match is_value_next {
                true => Place::Value,
                false => Place::Operator,
            });
            if self.too_deep {
                return None;
            }
            let word = self.word(0);
            // A definition's line ended before this name.
            let is_next_item = !self.within.is_block && self.is_name(0) && self.is_on_new_line(0);
            if word == close || (matches!(word, ")" | "]") && close != "}") {
                list.span = open.to(self.bump());
                list.is_round &= word == ")";
                let is_plain = self.problems.len() == told;
                self.semicolons(&semicolons, is_plain);
                self.names_of_parts(&labels, is_plain);
                let last = list.elements.last().and_then(|last| last.comma);
                list.needless = list.needless.or(last);
                return Some(list);
            }
            // Of `(0, 1, 0} radius 1 )` two signs were exchanged.
            let next = self.word(1);
            let goes_on = self.within.is_block && self.is_name(1) && !self.is_on_new_line(1);
            if (word, close) == ("}", ")") && goes_on && self.is_field_name(next) && self.lists == 1
            {
                let brace = self.bump();
                self.report(
                    &say::UNCLOSED_PARENTHESIS,
                    open,
                    &[],
                    Fix::write(brace, ")"),
                );
                list.span = open.to(brace);
                return Some(list);
            }
            if word == "," || (word == ";" && !is_value_next) {
                if word == ";" {
                    semicolons.push(self.here());
                }
                let comma = self.bump();
                match list.elements.last_mut() {
                    Some(last) if last.comma.is_none() => last.comma = Some(comma),
                    _ => list.needless = list.needless.or(Some(comma)),
                }
            } else if self.ends_value() || is_next_item {
                let is_whole = !is_value_next && list.gaps.is_empty() && list.needless.is_none();
                let last = list.elements.last().map(|element| &element.value);
                let last = last.filter(|value| value.kind != ValueKind::Bad);
                // A sum or a product may end behind any part of it.
                let is_sure = last.is_none_or(|it| !matches!(it.kind, ValueKind::Chain { .. }));
                let fits = is_whole && is_sure && count.contains(&list.elements.len());
                self.unclosed(open, close, last.filter(|_| fits).map(|last| last.span.end));
                list.span = open.to(self.behind());
                list.is_round = true;
                return fits.then_some(list);
            } else {
                if !is_value_next {
                    list.gaps.push(list.elements.len());
                }
                // `x = 3`
                let is_path = self.is(1, ":") && self.is(2, ":");
                if self.is_name(0) && matches!(self.word(1), "=" | ":") && !is_path {
                    let name = self.bump();
                    labels.push(name.to(self.bump()));
                }
                let at = self.last_end;
                let value = self.expression();
                if self.last_end == at {
                    self.bump();
                }
                list.elements.push(Element { value, comma: None });
            }
        }
    }

    /// Semicolons in place of the commas of a list, which may be wrong in other ways, too.
    fn semicolons(&mut self, signs: &[Span], is_plain: bool) {
        if let Some(&first) = signs.first() {
            let commas = signs.iter().map(|sign| Edit::new(*sign, ","));
            let fix = is_plain.then(|| Fix::new("write commas", commas));
            self.report(
                &say::UNEXPECTED.safe(),
                first,
                &["`,`", ";", "write commas"],
                fix,
            );
        }
    }

    /// The names of parts, each with its `=`. In any other order than the usual one, nobody knows
    /// what is meant.
    fn names_of_parts(&mut self, labels: &[Span], is_plain: bool) {
        let Some(&first) = labels.first() else {
            return;
        };
        let name = |label: &Span| &self.written(*label)[..1];
        let names: String = labels.iter().map(name).collect();
        let is_usual = matches!(names.as_str(), "xyz" | "rgb");
        let fix = (is_usual && is_plain).then(|| {
            let edits = labels.iter();
            let edits = edits.map(|label| Edit::remove_in(*label, self.text));
            Fix::new("take the names away", edits)
        });
        let help = "write the values alone, in the order x, y, z";
        self.report(&say::NOT_IN_LANGUAGE, first, &["names of parts", help], fix);
    }

    /// A list without its end, and where that is missing if it is known.
    fn unclosed(&mut self, open: Span, close: &str, end: Option<usize>) {
        let word = self.word(0);
        // A field's name behind which no value stands does not end a list, nor does a sign.
        let is_end = matches!(word, "" | "}") || (self.is_name(0) && self.starts_value(1));
        let before = match word {
            "" => "at the end".to_owned(),
            word => format!("before `{}`", shorten(word)),
        };
        let fix = end.filter(|_| is_end).map(|end| {
            let end = Edit::insert(self.id, end, ")");
            match close {
                ")" => Fix::new(format!("write `)` {before}"), [end]),
                _ => Fix::new(format!("write `(…)` {before}"), [Edit::new(open, "("), end]),
            }
        });
        self.report(&say::UNCLOSED_PARENTHESIS, open, &[], fix);
    }

    /// The values of a list, if it is known how many they are.
    fn checked(&mut self, list: List<'s>, count: &Count) -> Option<Vec<Element<'s>>> {
        let elements = list.elements;
        let fits = count.contains(&elements.len());
        if let Some(comma) = list.needless {
            let fix = self.remove("remove this comma", comma);
            match fits {
                true => self.report(&say::NEEDLESS_COMMA, comma, &[], fix),
                false => self.report(&say::MISSING_PART, comma, &[], None),
            }
            return fits.then_some(elements);
        }
        let Some(&first) = list.gaps.first() else {
            return Some(elements);
        };
        let (left, right) = (&elements.get(first - 1)?.value, &elements.get(first)?.value);
        if elements.iter().any(|e| e.value.kind == ValueKind::Bad) {
            return None;
        }
        if !fits && is_plain_number(left) && self.is_factor(right) {
            self.missing_between(&left.clone(), &right.clone());
            return None;
        }
        let (l, r) = (self.short(left.span), self.short(right.span));
        let fix = fits.then(|| {
            let before = list.gaps.iter().filter_map(|&gap| elements.get(gap - 1));
            let edits = before.map(|e| Edit::insert(self.id, e.value.span.end, ","));
            Fix::new(format!("write `{l}, {r}`"), edits)
        });
        // `min1.6` is one word that was torn, rather than two values.
        let are_apart = left.span.end < right.span.start;
        self.report(
            &say::MISSING_COMMA.safe_if(are_apart),
            right.span,
            &[&l, &r],
            fix,
        );
        fits.then_some(elements)
    }

    /// `rgb [255, 0, 0]`, `normalize <1, 2, 3>`
    pub(super) fn call_in_brackets(
        &mut self,
        name: Name<'s>,
        row: &schema::Function,
        close: &'static str,
    ) -> Value<'s> {
        let takes = match row.gives {
            Type::Color => Type::Color,
            _ => Type::Vector,
        };
        let told = self.problems.len();
        if let Some(list) = self.list(close, None, &(3..=3))
            && self.problems.len() == told
        {
            let outside = self.within.takes.replace(takes);
            self.brackets(list, Some((name, row)));
            self.within.takes = outside;
        }
        bad(name.span.to(self.behind()))
    }

    /// A list in other brackets, perhaps behind the function that takes it.
    fn brackets(
        &mut self,
        list: List<'s>,
        behind: Option<(Name<'s>, &schema::Function)>,
    ) -> Value<'s> {
        let takes = self.within.takes;
        let span = behind.map_or(list.span, |(name, _)| name.span.to(list.span));
        let (what, function, count) = match takes {
            Some(Type::Color) => ("a colour", "rgb", 3),
            Some(Type::Colors) => ("a pair of colours", "", 2),
            Some(Type::FaceColors) => ("a list of colours", "", 3),
            _ => ("a vector", "", 3),
        };
        let fits = list.elements.len() == count
            && list.needless.is_none()
            && behind
                .is_none_or(|(_, row)| row.takes == [Type::Vector] || row.gives == Type::Color);
        let parts = list.elements.iter().map(|e| self.written(e.value.span));
        let parts = parts.collect::<Vec<_>>().join(", ");
        let right = match (function, behind) {
            ("", Some((name, _))) => format!("{}(({parts}))", name.text),
            ("", None) => format!("({parts})"),
            _ => format!("{function}({})", whole_parts(&parts)),
        };
        let fix = fits.then(|| replace(span, right));
        let said = say::BRACKETS.safe_if(function.is_empty() || !are_shares(&[&parts]));
        self.report(&said, span, &[what, example(takes)], fix);
        let kind = match fits && function.is_empty() {
            true => ValueKind::Tuple(list.elements),
            false => ValueKind::Bad,
        };
        Value { kind, span }
    }
}
