//! Reads lists: values in parentheses, or in other brackets that stand for parentheses.

use std::ops::RangeInclusive;

use super::{Recovery, example, foreign::CommentPosition, is_plain_number};
use crate::{
    color::{are_shares, whole_parts},
    diagnostic::{Edit, Fix},
    schema::{self, Type},
    source::Span,
    syntax::{
        messages as say,
        problem::{replace, shorten},
        tokens::TokenKind,
        tree::{Element, Name, Value, ValueKind, bad, call, group},
    },
};

/// Permitted numbers of values in a list.
type PartCount = RangeInclusive<usize>;

/// A list as it was written.
struct List<'s> {
    elements: Vec<Element<'s>>,
    /// Span from the opening to the closing bracket.
    span: Span,
    /// Whether the list is in parentheses rather than other brackets.
    is_round: bool,
    /// Indices of the values that lack a comma before them.
    gaps: Vec<usize>,
    /// A comma that lacks a value before or after it.
    needless: Option<Span>,
}

impl<'s> Recovery<'_, 's> {
    /// Returns whether the next token, a `{` in place of a value, opens a list of values, as in
    /// `{1, 2, 3}`, rather than fields.
    pub(super) fn is_flat_list(&mut self) -> bool {
        let sign = 1 + usize::from(self.is(1, "-"));
        let is_number = self.kind(sign) == TokenKind::Number;
        self.is(0, "{") && (is_number || (self.is_name(sign) && self.is(sign + 1, ",")))
    }

    /// Reads a vector, a pair or triple of colours, or a value in parentheses. `close` is the
    /// bracket that ends it.
    pub(super) fn group(&mut self, close: &'static str) -> Value<'s> {
        let takes = self.context.takes;
        let (parts, count) = match takes {
            Some(Type::Vector) => (Some(Type::Number), 3..=3),
            Some(Type::Colors) => (Some(Type::Color), 2..=2),
            Some(Type::FaceColors) => (Some(Type::Color), 3..=3),
            Some(Type::Number | Type::Angle) => (takes, 1..=1),
            Some(Type::Color) => (takes, 3..=3),
            Some(Type::Method) | None => (None, 3..=3),
        };
        let (start, problems_before) = (self.here(), self.problems.len());
        let Some(list) = self.list(close, parts, &count) else {
            return bad(start.to(self.behind()));
        };
        let span = list.span;
        if !list.is_round && self.problems.len() == problems_before {
            return self.brackets(list, None);
        }
        let Some(elements) = self.checked(list, &count) else {
            return bad(span);
        };
        Value::new(group(elements), span)
    }

    /// Reads the arguments of the function `function`, whose name was just read.
    pub(super) fn call(&mut self, function: Name<'s>) -> Value<'s> {
        let problems_before = self.problems.len();
        let count = match schema::function(function.text) {
            Some(row) if row.more => row.takes.len()..=usize::MAX,
            Some(row) => row.takes.len()..=row.takes.len(),
            None => 0..=0,
        };
        let Some(list) = self.list(")", None, &count) else {
            return bad(function.span.to(self.behind()));
        };
        let parentheses = list.span;
        if self.words.is_foreign_function(function.text) && self.problems.len() == problems_before {
            return self.foreign_function(function, list);
        }
        // If a call has several problems and contains a `%`, as in `rgb(100%, 0%, 0%)`, these
        // problems are replaced by one report about the `%`. For an unknown function, they are only
        // removed, because the function itself will be reported.
        let is_known = schema::function(function.text).is_some();
        if self.problems.len() > problems_before + 1 && self.written(parentheses).contains('%') {
            self.problems.truncate(problems_before);
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

    /// Returns whether the next token starts a call of another language's function, such as
    /// `vec3(1, 2, 3)`. Even on a new line, such a call is the value of the field or definition
    /// before it, rather than the start of a field or an item.
    pub(super) fn is_foreign_call(&mut self) -> bool {
        self.words.is_foreign_function(self.word(0)) && self.is(1, "(")
    }

    /// Reports a call of another language's function, such as `vec3(1, 2, 3)`. The arguments were
    /// read already. Returns a value marked as bad.
    fn foreign_function(&mut self, name: Name<'s>, list: List<'s>) -> Value<'s> {
        let span = name.span.to(list.span);
        let mut values: Vec<Value<'s>> = list.elements.into_iter().map(|e| e.value).collect();
        let (function, takes) = match (name.text, self.context.takes) {
            ("rgba" | "color" | "Color", _) | (_, Some(Type::Color)) => ("rgb", Type::Color),
            _ => ("", Type::Vector),
        };
        if takes == Type::Color && values.len() == 4 {
            values.truncate(3);
        }
        let fits = values.len() == 3 && self.context.takes.is_none_or(|t| t == takes);
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

    /// Reads a list, whatever separates its values. Returns `None` if the list nests too deep, or
    /// if it lacks its closing bracket and it is unclear where the bracket belongs.
    fn list(
        &mut self,
        close: &'static str,
        parts: Option<Type>,
        count: &PartCount,
    ) -> Option<List<'s>> {
        if self.depth >= self.limit {
            self.pass_over();
            return None;
        }
        let takes = std::mem::replace(&mut self.context.takes, parts);
        self.depth += 1;
        self.lists += 1;
        let list = self.parts(close, count);
        self.lists -= 1;
        self.depth -= 1;
        self.context.takes = takes;
        list.filter(|_| !self.too_deep)
    }

    fn parts(&mut self, close: &'static str, count: &PartCount) -> Option<List<'s>> {
        let open = self.bump();
        let mut list = List {
            elements: Vec::new(),
            span: open,
            is_round: close == ")",
            gaps: Vec::new(),
            needless: None,
        };
        // Semicolons, and names of elements as in `(x = 3, …)`, are reported once for the whole
        // list.
        let (mut semicolons, mut labels, problems_before) =
            (Vec::new(), Vec::new(), self.problems.len());
        loop {
            let is_value_next = list.elements.last().is_none_or(|last| last.comma.is_some());
            self.comments(if is_value_next {
                CommentPosition::Value
            } else {
                CommentPosition::Operator
            });
            if self.too_deep {
                return None;
            }
            let word = self.word(0);
            if word == close || (matches!(word, ")" | "]") && close != "}") {
                list.span = open.to(self.bump());
                list.is_round &= word == ")";
                let is_plain = self.problems.len() == problems_before;
                self.semicolons(&semicolons, is_plain);
                self.names_of_parts(&labels, is_plain);
                let last = list.elements.last().and_then(|last| last.comma);
                list.needless = list.needless.or(last);
                return Some(list);
            }
            if self.is_exchanged_brace(close) {
                let brace = self.bump();
                let fix = Fix::write(brace, ")");
                self.report(&say::UNCLOSED_PARENTHESIS, open, &[], fix);
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
            } else if self.ends_value() {
                return self.unclosed_list(list, close, count);
            } else {
                if !is_value_next {
                    list.gaps.push(list.elements.len());
                }
                // Skip the name of an element of the list, as in `(x = 3, …)`.
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

    /// Returns whether the next token, a `}`, was probably exchanged with the `)` that ends the
    /// block, as in `(0, 1, 0} radius 1 )`.
    fn is_exchanged_brace(&mut self, close: &str) -> bool {
        let next = self.word(1);
        (self.word(0), close) == ("}", ")")
            && self.lists == 1
            && self.context.is_block
            && self.is_name(1)
            && !self.is_on_new_line(1)
            && self.is_field_name(next)
    }

    /// Reports a list that lacks its closing bracket. Returns the list if it is clear where the
    /// bracket belongs: the number of values is allowed, no comma is missing or needless, and the
    /// last value is not a sum or a product. Otherwise returns `None`.
    fn unclosed_list(
        &mut self,
        mut list: List<'s>,
        close: &str,
        count: &PartCount,
    ) -> Option<List<'s>> {
        let last = list.elements.last();
        let is_whole = last.is_some_and(|last| last.comma.is_none())
            && list.gaps.is_empty()
            && list.needless.is_none();
        let last = last.map(|element| &element.value);
        let last = last.filter(|value| value.kind != ValueKind::Bad);
        // If the last value is a sum or a product, the missing bracket may belong after any of its
        // operands, so the list is uncertain.
        let is_sure = last.is_none_or(|it| !matches!(it.kind, ValueKind::Chain { .. }));
        let fits = is_whole && is_sure && count.contains(&list.elements.len());
        let end = last.filter(|_| fits).map(|last| last.span.end);
        self.unclosed(list.span, close, end);
        list.span = list.span.to(self.behind());
        list.is_round = true;
        fits.then_some(list)
    }

    /// Reports semicolons in place of commas. There is a fix only if the list has no other mistakes
    /// (`is_plain`).
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

    /// Reports a list whose elements are named with `=` or `:`. The fix removes the names if they
    /// are x, y, z or r, g, b, in this order. Other names have an uncertain meaning and get no fix.
    fn names_of_parts(&mut self, labels: &[Span], is_plain: bool) {
        let Some(&first) = labels.first() else {
            return;
        };
        let name = |label: &Span| &self.written(*label)[..1];
        let names: String = labels.iter().map(name).collect();
        let is_usual = matches!(names.as_str(), "xyz" | "rgb");
        let fix = (is_usual && is_plain).then(|| {
            let edits = labels.iter().map(|it| Edit::remove_in(*it, self.text));
            Fix::new("take the names away", edits)
        });
        let help = "write the values alone, in the order x, y, z";
        self.report(&say::NOT_IN_LANGUAGE, first, &["names of parts", help], fix);
    }

    /// Reports a list that opens at `open` and lacks its closing bracket. `end` is the offset where
    /// the bracket belongs, if that is known.
    fn unclosed(&mut self, open: Span, close: &str, end: Option<usize>) {
        let word = self.word(0);
        // A field's name ends a list only if a value follows the name.
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

    /// Reports a needless or missing comma, or a missing value beside a comma. Returns the values
    /// of `list`. Returns `None` if a comma is wrong and the values are uncertain, for example
    /// because their number is not in the range `count`.
    fn checked(&mut self, list: List<'s>, count: &PartCount) -> Option<Vec<Element<'s>>> {
        let elements = list.elements;
        let fits = count.contains(&elements.len());
        if let Some(comma) = list.needless {
            let said = if fits {
                &say::NEEDLESS_COMMA
            } else {
                &say::MISSING_PART
            };
            let fix = fits.then(|| self.remove("remove this comma", comma));
            self.report(said, comma, &[], fix);
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
        // Two values without white space between them, as in `min1.6`, may have been meant as
        // something else, so the fix that writes a comma is not safe.
        let are_apart = left.span.end < right.span.start;
        self.report(
            &say::MISSING_COMMA.safe_if(are_apart),
            right.span,
            &[&l, &r],
            fix,
        );
        fits.then_some(elements)
    }

    /// Reports a call with other brackets than parentheses, such as `rgb [255, 0, 0]` or `normalize
    /// <1, 2, 3>`, and reads its arguments.
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
        let problems_before = self.problems.len();
        if let Some(list) = self.list(close, None, &(3..=3))
            && self.problems.len() == problems_before
        {
            let outside = self.context.takes.replace(takes);
            self.brackets(list, Some((name, row)));
            self.context.takes = outside;
        }
        bad(name.span.to(self.behind()))
    }

    /// Reports a list in other brackets than parentheses. If the list follows a function's name,
    /// `behind` is that function.
    fn brackets(
        &mut self,
        list: List<'s>,
        behind: Option<(Name<'s>, &schema::Function)>,
    ) -> Value<'s> {
        let takes = self.context.takes;
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
        let kind = if fits && function.is_empty() {
            ValueKind::Tuple(list.elements)
        } else {
            ValueKind::Bad
        };
        Value { kind, span }
    }
}
