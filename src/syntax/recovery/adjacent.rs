//! Reads several values where one is expected: the parts of a list without parentheses, a product
//! without its operator, a number with commas, or the value of a field whose name is missing.

use super::{Recovery, example, is_plain_number};
use crate::{
    color::{are_shares, whole_parts},
    diagnostic::{Edit, Fix},
    schema::{self, Type},
    source::Span,
    syntax::{
        messages as say,
        problem::replace,
        tokens::{Lexer, TokenKind, numeric_part},
        tree::{Operator, Step, Value, ValueKind, bad},
    },
};

impl<'s> Recovery<'_, 's> {
    /// Returns the texts of `values`, separated by commas.
    pub(super) fn list_of(&self, values: &[Value<'s>]) -> String {
        let texts = values.iter().map(|value| self.written(value.span));
        texts.collect::<Vec<_>>().join(", ")
    }

    /// Reports several values that stand where one is expected. Returns the single value that the
    /// author probably meant, or a value marked as bad if the meaning is uncertain. If `values` has
    /// one element, returns it and reports nothing.
    pub(super) fn adjacent_values(
        &mut self,
        mut values: Vec<Value<'s>>,
        commas: usize,
    ) -> Value<'s> {
        let (first, second, span) = match values.as_slice() {
            [] => return bad(self.behind()),
            [_] => return values.swap_remove(0),
            [first, second, rest @ ..] => {
                // A comment of another language may follow the values, so the reported span ends
                // with the last value.
                let last = rest.last().unwrap_or(second);
                (first.clone(), second.clone(), first.span.to(last.span))
            }
        };
        let (takes, whole) = (self.context.takes, self.written(span));
        let numbers = values.iter().all(is_plain_number);
        let right = format!("({})", self.list_of(&values));
        if values.iter().any(|value| value.kind == ValueKind::Bad) {
            return bad(span);
        }
        let are_parts = values.iter().all(|value| match takes {
            Some(Type::Colors | Type::FaceColors) => !matches!(value.kind, ValueKind::Tuple(_)),
            _ => is_plain_number(value) || self.is_factor(value),
        });
        match (takes, values.len()) {
            // In `dark red` and `multi jittered`, two words are one misspelt name.
            (Some(Type::Color | Type::Method), _)
                if are_names(&values) && commas == 0 && !whole.contains(['\n', '/']) =>
            {
                let kind = ValueKind::Name(whole);
                return Value { kind, span };
            }
            (None | Some(Type::Number | Type::Angle), _)
                if numbers && commas > 0 && self.comma_in_number(span) => {}
            (Some(Type::Color), 3) if numbers => {
                let said = say::MISSING_PARENTHESES.safe_if(!are_shares(&[whole]));
                let parts = whole_parts(&self.list_of(&values));
                let fix = replace(span, format!("rgb({parts})"));
                self.report(&said, span, &[example(takes)], fix);
            }
            // Spaces in a number, as in `6 371 000`, are meant to group its digits.
            (None | Some(Type::Number), _) if numbers && commas == 0 && are_thousands(whole) => {
                let label = "no spaces stand in a number";
                let fix = replace(span, whole.replace(' ', ""));
                self.report(&say::BAD_NUMBER.safe_if(false), span, &[whole, label], fix);
            }
            // If the field requires a vector, `2 ball` is probably a product without its operator,
            // whether `ball` is a number or a vector.
            (Some(Type::Vector), 2) if commas == 0 && self.is_named_factor(&first, &second) => {
                self.missing_between(&first, &second);
            }
            (Some(Type::Vector | Type::FaceColors) | None, 3) | (Some(Type::Colors), 2)
                if are_parts =>
            {
                self.missing_parentheses(span, Some(replace(span, right)));
            }
            (Some(Type::Colors | Type::FaceColors), _)
                if values.iter().all(|it| self.is_color(it)) =>
            {
                self.missing_parentheses(span, None);
            }
            (Some(Type::Color), _) if commas > 0 && values.iter().all(|it| self.is_color(it)) => {
                let help = match (values.len(), self.is_field_name("colors")) {
                    (3, true) => format!("write `colors {right}`"),
                    _ => format!("write one colour, or `{right}` to take turns in a `for`"),
                };
                self.report(&say::MISSING_PARENTHESES, span, &[&help], None);
            }
            (Some(Type::Vector), 2)
                if commas == 0 && !values.iter().any(|it| self.is_number(it)) =>
            {
                self.missing_between(&first, &second);
            }
            (Some(Type::Vector), _) if !matches!(first.kind, ValueKind::Tuple(_)) => {
                self.missing_parentheses(span, None);
            }
            _ => self.missing_between(&first, &second),
        }
        bad(span)
    }

    /// Reports a list without parentheses. Offers `fix` unless a word ends directly before the
    /// list, as in `center1.6, 1, 0`, where it is uncertain at which character the list starts.
    pub(super) fn missing_parentheses(&mut self, span: Span, fix: Option<Fix>) {
        let help = example(self.context.takes);
        let before = self.line_before(span.start);
        let is_torn = before.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let fix = fix.filter(|_| !is_torn);
        self.report(&say::MISSING_PARENTHESES, span, &[help], fix);
    }

    /// Reports two values with nothing between them. Either an operator is missing, or the second
    /// value belongs to a field whose name is missing.
    pub(super) fn missing_between(&mut self, left: &Value<'s>, right: &Value<'s>) {
        let is_whole = self.is_color(left) || matches!(left.kind, ValueKind::Tuple(_));
        let (l, r) = (self.short(left.span), self.short(right.span));
        let is_method = self.context.takes == Some(Type::Method);
        if self.context.is_block && self.lists == 0 && (is_whole || is_method) {
            let takes_color = self.words.takes(self.context.kind, "color").is_some();
            let said = if takes_color && self.is_color(right) {
                &say::COLOR_WITHOUT_NAME
            } else {
                &say::MISSING_FIELD_NAME
            };
            return self.report(said, right.span, &[&r], None);
        }
        // Two values are a product, as in `2 pi`, if one is a number literal and the other probably
        // stands for a number.
        let sign = Span::new(self.id, left.span.end, right.span.start);
        let are_numbers = (is_plain_number(left) && self.is_factor(right))
            || (self.is_factor(left) && is_plain_number(right));
        // If the field requires a vector or an angle, a number before a name is a factor, as in `2
        // ball` and `(n * 0.28) ball`.
        let is_scaled = matches!(self.context.takes, Some(Type::Vector | Type::Angle))
            && self.is_named_factor(left, right);
        let is_product =
            is_scaled || are_numbers && matches!(self.context.takes, None | Some(Type::Number));
        let title = format!("write `{l} * {r}`");
        let fix = is_product.then(|| Fix::new(title, [Edit::new(sign, " * ")]));
        self.report(&say::MISSING_OPERATOR, right.span, &[&l, &r], fix);
    }

    /// Reports a missing `(`, as in `sin30deg * i)`, where the function's name is joined to its
    /// argument. The `)` is the next token. Reports the mistake only if exactly one such name
    /// stands between `start` and the `)`. Returns whether it was reported.
    pub(super) fn unopened_call(&mut self, start: usize) -> bool {
        let end = self.here().start;
        // Maximum length, in bytes, of the text between `start` and the `)`. A longer text is not
        // searched, and nothing is reported. The limit bounds the time, because a value is searched
        // once for each of its surplus `)`. Usual values are much shorter.
        const LONGEST: usize = 1000;
        if end - start > LONGEST {
            return false;
        }
        let mut lexer = Lexer::new(self.text.get(..end).unwrap_or_default(), start);
        let tokens = std::iter::repeat_with(|| lexer.token());
        let tokens = tokens.take_while(|token| token.kind != TokenKind::End);
        let names = tokens.filter(|token| token.kind == TokenKind::Name);
        let mut calls = names.filter_map(|token| {
            let word = self.text.get(token.start..token.end)?;
            let split = |row: &schema::Function| Some((row.name, word.strip_prefix(row.name)?));
            let mut rows = schema::FUNCTIONS.iter().filter_map(split);
            let is_argument = |rest: &str| {
                matches!(
                    rest.trim_start_matches(|c: char| c.is_ascii_digit()),
                    "" | "deg" | "rad"
                ) || self.words.is_value(rest)
            };
            let (name, rest) = rows.find(|(_, rest)| !rest.is_empty() && is_argument(rest))?;
            let is_known = self.words.is_value(word);
            (!is_known).then_some((token, name, rest))
        });
        let (Some((token, name, rest)), None) = (calls.next(), calls.next()) else {
            return false;
        };
        let span = Span::new(self.id, token.start, token.end);
        let edit = Edit::insert(self.id, token.start + name.len(), "(");
        let fix = Fix::new(format!("write `{name}({rest}`"), [edit]);
        self.report(&say::MISSING_OPEN, span, &[name, rest], fix);
        self.bump();
        true
    }

    /// Returns whether `value` is a name that probably stands for a number, or a chain of operators
    /// that starts with such a name and continues with number literals, such as `n * 2`.
    pub(super) fn is_factor(&self, value: &Value<'s>) -> bool {
        match &value.kind {
            ValueKind::Name(name) => self.words.is_factor(name),
            ValueKind::Chain { first, rest } => {
                self.is_factor(first) && rest.iter().all(|step| is_plain_number(&step.operand))
            }
            _ => false,
        }
    }

    fn is_color(&self, value: &Value<'s>) -> bool {
        match &value.kind {
            ValueKind::Call(call) => call.function.text == "rgb",
            ValueKind::Name(name) => self.words.is_color(name),
            kind => matches!(kind, ValueKind::ColorCode(_)),
        }
    }

    /// Returns whether a value probably consists of numbers.
    pub(super) fn is_number(&self, value: &Value<'s>) -> bool {
        match &value.kind {
            ValueKind::Number(_) => true,
            ValueKind::Name(name) => self.words.is_factor(name),
            ValueKind::Tuple(_) | ValueKind::Call(_) => false,
            _ => {
                let parts = value.parts();
                !parts.is_empty() && parts.into_iter().all(|part| self.is_number(part))
            }
        }
    }

    /// Returns whether `left` is a number, or a number in parentheses, and `right` is a name.
    fn is_named_factor(&self, left: &Value<'s>, right: &Value<'s>) -> bool {
        let is_factor = is_plain_number(left) || matches!(left.kind, ValueKind::Parentheses(_));
        is_factor && self.is_number(left) && matches!(right.kind, ValueKind::Name(_))
    }

    /// Reports a number with commas, such as `1,5` or `1,000,000`. Returns `false`, and reports
    /// nothing, if the text is not such a number.
    fn comma_in_number(&mut self, span: Span) -> bool {
        let parts: Vec<&str> = self.written(span).split(',').collect();
        let is_digits = |part: &&str| part.bytes().all(|byte| byte.is_ascii_digit());
        let Some((head, rest)) = parts.split_first() else {
            return false;
        };
        let is_whole = self.words.is_whole(self.context.kind, self.context.field);
        let are_thousands = rest.iter().all(|part| part.len() == 3);
        let is_single = rest.len() == 1;
        let is_decimal = is_single && numeric_part(head) == *head && !head.contains('.');
        let is_grouped = are_thousands && (!is_single || is_whole);
        if !(rest.iter().all(is_digits) && (is_grouped || is_decimal)) {
            return false;
        }
        // If exactly three digits follow the only comma, the comma is assumed to separate
        // thousands, because few decimal fractions have exactly three digits. A number such as
        // `0,125` is an exception.
        let is_whole_number = are_thousands && is_single && *head != "0";
        let (message, sign) = if is_grouped || is_whole_number {
            ("no commas stand in a number", "_")
        } else {
            ("a decimal point is written `.`, not `,`", ".")
        };
        let comma = span.start + head.len();
        let comma = Span::new(self.id, comma, comma + 1);
        let mut fix = replace(span, parts.join(sign));
        if is_whole_number {
            fix.title += ", or a `.` if the comma is a decimal point";
        }
        self.report(&say::DECIMAL_COMMA, comma, &[message], fix);
        true
    }
}

/// Returns whether a text consists of digits in groups of three, separated by spaces; the first
/// group may be shorter.
fn are_thousands(text: &str) -> bool {
    let mut groups = text.split(' ');
    let is_head = |head: &str| (1..=3).contains(&head.len());
    groups.next().is_some_and(is_head)
        && groups.all(|group| group.len() == 3)
        && text.bytes().all(|it| it.is_ascii_digit() || it == b' ')
}

/// Returns whether a surplus `)` after `value` can be removed safely. It can if `value` keeps its
/// meaning wherever the missing `(` may be inserted.
pub(super) fn is_same_in_parentheses(value: &Value<'_>) -> bool {
    match &value.kind {
        ValueKind::Chain { first, rest } => {
            let is_plain = |value: &Value<'_>| value.parts().is_empty();
            let keeps = |step: &Step<'_>| {
                is_plain(&step.operand)
                    && matches!(step.operator, Operator::Add | Operator::Multiply)
            };
            rest.split_last().is_none_or(|(last, before)| {
                is_plain(first) && before.iter().all(keeps) && is_same_in_parentheses(&last.operand)
            })
        }
        ValueKind::Negation { .. } => is_plain_number(value),
        // If the call has a wrong number of arguments, as in `normalize(1, 0, 0))`, the `)` may
        // belong to a `(` that is missing in the call.
        ValueKind::Call(call)
            if schema::function(call.function.text)
                .is_some_and(|row| !row.accepts(call.arguments.len())) =>
        {
            false
        }
        _ => value
            .parts()
            .last()
            .is_none_or(|last| is_same_in_parentheses(last)),
    }
}

pub(super) fn are_names(values: &[Value<'_>]) -> bool {
    let is_name = |value: &Value<'_>| matches!(value.kind, ValueKind::Name(_));
    values.iter().all(is_name)
}
