//! Several values where one should stand: the parts of a list without parentheses, a product
//! without its sign, a number with commas, or the value of a field without a name.

use super::{Recovery, example, is_plain_number};
use crate::{
    color::are_shares,
    diagnostic::{Edit, Fix},
    schema::{self, Type},
    source::Span,
    syntax::{
        messages as say,
        problem::replace,
        tokens::numeric_part,
        tree::{Value, ValueKind, bad},
    },
};

impl<'s> Recovery<'_, 's> {
    /// The parts of a list, for a text.
    pub(super) fn list_of(&self, values: &[Value<'s>]) -> String {
        let texts = values.iter().map(|value| self.written(value.span));
        texts.collect::<Vec<_>>().join(", ")
    }

    /// One value of several that were written behind each other.
    pub(super) fn joined(&mut self, mut values: Vec<Value<'s>>, commas: usize) -> Value<'s> {
        let (first, second, span) = match values.as_slice() {
            [] => return bad(self.behind()),
            [_] => return values.swap_remove(0),
            [first, second, rest @ ..] => {
                // A comment of another language may stand behind the last one.
                let last = rest.last().unwrap_or(second);
                (first.clone(), second.clone(), first.span.to(last.span))
            }
        };
        let (takes, whole) = (self.within.takes, self.written(span));
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
            // `dark red` and `multi jittered` are one name, written wrongly.
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
                let fix = replace(span, format!("rgb{right}"));
                self.report(&said, span, &[example(takes)], fix);
            }
            // `6 371 000`
            (None | Some(Type::Number), _) if numbers && commas == 0 && are_thousands(whole) => {
                let label = "no spaces stand in a number";
                let fix = replace(span, whole.replace(' ', ""));
                self.report(&say::BAD_NUMBER.safe_if(false), span, &[whole, label], fix);
            }
            // `2 ball`, where a vector should stand: times whatever it is.
            (Some(Type::Vector), 2) if commas == 0 && is_named_factor(&first, &second) => {
                self.missing_between(&first, &second);
            }
            (Some(Type::Vector | Type::FaceColors) | None, 3) | (Some(Type::Colors), 2)
                if are_parts =>
            {
                self.missing_parentheses(span, Some(replace(span, right)));
            }
            (Some(Type::Vector), _) if !matches!(first.kind, ValueKind::Tuple(_)) => {
                self.missing_parentheses(span, None);
            }
            _ => self.missing_between(&first, &second),
        }
        bad(span)
    }

    /// Values that begin within a torn word, as in `center1.6, 1, 0`, are not the author's.
    pub(super) fn missing_parentheses(&mut self, span: Span, fix: Option<Fix>) {
        let help = example(self.within.takes);
        let is_torn = self
            .line_before(span.start)
            .ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let fix = fix.filter(|_| !is_torn);
        self.report(&say::MISSING_PARENTHESES, span, &[help], fix);
    }

    /// Two values with nothing between: an operator is missing, or the name of a field.
    pub(super) fn missing_between(&mut self, left: &Value<'s>, right: &Value<'s>) {
        let is_color = |value: &Value<'s>| match &value.kind {
            ValueKind::Call(call) => call.function.text == "rgb",
            ValueKind::Name(name) => self.words.is_color(name),
            kind => matches!(kind, ValueKind::ColorCode(_)),
        };
        let is_whole = is_color(left) || matches!(left.kind, ValueKind::Tuple(_));
        let (l, r) = (self.short(left.span), self.short(right.span));
        let is_method = self.within.takes == Some(Type::Method);
        if self.within.is_block && self.lists == 0 && (is_whole || is_method) {
            let takes_color = self.words.takes(self.within.kind, "color").is_some();
            let said = match takes_color && is_color(right) {
                true => &say::COLOR_WITHOUT_NAME,
                false => &say::MISSING_FIELD_NAME,
            };
            return self.report(said, right.span, &[&r], None);
        }
        // `2 pi`, if both are surely numbers.
        let sign = Span::new(self.id, left.span.end, right.span.start);
        let are_numbers = (is_plain_number(left) && self.is_factor(right))
            || (self.is_factor(left) && is_plain_number(right));
        // `2 ball` and `(n * 0.28) ball`, in the place of a vector.
        let is_scaled = self.within.takes == Some(Type::Vector) && is_named_factor(left, right);
        let is_product =
            is_scaled || are_numbers && matches!(self.within.takes, None | Some(Type::Number));
        if let ValueKind::Name(name) = left.kind
            && schema::function(name).is_some()
        {
            // `cos a`
            let title = format!("write `{l}({r})`");
            let open = Edit::new(sign, "(");
            let close = Edit::insert(self.id, right.span.end, ")");
            let fix = Fix::new(title, [open, close]);
            return self.report(
                &say::MISSING_PARENTHESES.safe_if(false),
                left.span.to(right.span),
                &[""],
                fix,
            );
        }
        let title = format!("write `{l} * {r}`");
        let fix = is_product.then(|| Fix::new(title, [Edit::new(sign, " * ")]));
        self.report(&say::MISSING_OPERATOR, right.span, &[&l, &r], fix);
    }

    /// Whether a value starts with a name that is surely that of a number.
    pub(super) fn is_factor(&self, value: &Value<'s>) -> bool {
        match &value.kind {
            ValueKind::Name(name) => self.words.is_factor(name),
            ValueKind::Chain { first, rest } => {
                self.is_factor(first) && rest.iter().all(|step| is_plain_number(&step.operand))
            }
            _ => false,
        }
    }

    /// `1,5` and `1,000,000`
    fn comma_in_number(&mut self, span: Span) -> bool {
        let parts: Vec<&str> = self.written(span).split(',').collect();
        let is_digits = |part: &&str| part.bytes().all(|byte| byte.is_ascii_digit());
        let Some((head, rest)) = parts.split_first() else {
            return false;
        };
        let is_whole = self.words.is_whole(self.within.kind, self.within.field);
        let are_thousands = rest.iter().all(|part| part.len() == 3);
        let (message, right) = if !rest.iter().all(is_digits) {
            return false;
        } else if are_thousands && (rest.len() > 1 || is_whole) {
            ("no commas stand in a number", parts.join("_"))
        } else if rest.len() == 1 && numeric_part(head) == *head && !head.contains('.') {
            ("a decimal point is written `.`, not `,`", parts.join("."))
        } else {
            return false;
        };
        let comma = span.start + head.len();
        let comma = Span::new(self.id, comma, comma + 1);
        self.report(&say::DECIMAL_COMMA, comma, &[message], replace(span, right));
        true
    }
}

/// Whether a number, or an expression in parentheses, stands before a name.
fn is_named_factor(left: &Value<'_>, right: &Value<'_>) -> bool {
    let is_factor = is_plain_number(left) || matches!(left.kind, ValueKind::Parentheses(_));
    is_factor && matches!(right.kind, ValueKind::Name(_))
}

/// Whether digits stand in groups of three.
fn are_thousands(text: &str) -> bool {
    let mut groups = text.split(' ');
    let is_head = |head: &str| (1..=3).contains(&head.len());
    groups.next().is_some_and(is_head)
        && groups.all(|group| group.len() == 3)
        && text
            .bytes()
            .all(|byte| byte.is_ascii_digit() || byte == b' ')
}

pub(super) fn are_names(values: &[Value<'_>]) -> bool {
    let is_name = |value: &Value<'_>| matches!(value.kind, ValueKind::Name(_));
    values.iter().all(is_name)
}
