//! Values: operators, operands, and several values where one should stand.

use super::{
    Recovery,
    foreign::{Place, is_color_code},
    is_name, is_plain_number, unquoted,
};
use crate::{
    diagnostic::{Diagnostic, Edit, Fix},
    schema::Type,
    source::Span,
    syntax::{
        NESTING_LIMIT,
        problem::{problem, replace, shorten},
        tokens::{TokenKind, numeric_part},
        tree::{Call, Element, Name, Operator, Value, ValueKind, bad, chain, negation},
    },
};

/// The operators of a product, and what people write for them.
const PRODUCT: &[&str] = &["*", "/", "×", "·", "÷", "^", "**", "%"];
/// Those of a sum.
const SUM: &[&str] = &["+", "-", "−"];

impl<'s> Recovery<'_, 's> {
    /// The value of a field, of a definition, or of a `--set`, with whatever stands in place of it.
    pub(super) fn value(&mut self) -> Value<'s> {
        let start = self.here();
        let (mut values, mut commas) = (Vec::new(), Vec::new());
        self.too_deep = false;
        loop {
            if values.is_empty() {
                self.comments(Place::Value);
            } else {
                self.comments(Place::Operator);
                if self.is(0, ",") && self.goes_on_behind_comma() {
                    commas.push(self.bump());
                } else if !self.goes_on(&values) {
                    break;
                }
            }
            let at = self.last_end;
            let is_method = self.within.takes == Some(Type::Method);
            values.push(match is_method && self.is_name(0) && !self.is(1, "(") {
                true => self.hyphenated(),
                false => self.expression(),
            });
            if self.too_deep {
                return bad(start.to(self.behind()));
            }
            if self.last_end == at {
                break;
            }
        }
        if values.len() > 1 && self.closes_nothing() {
            let span = self.bump();
            let message = format!("this `{}` closes nothing", self.written(span));
            self.problems.push(
                problem("stray_closing", message, span, "nothing is open here")
                    .with_help("write the parenthesis that opens it, or take it away"),
            );
            return bad(start.to(span));
        }
        let mut value = self.joined(values, &commas);
        while self.closes_nothing() {
            self.stray_parenthesis();
            let goes_on = PRODUCT.contains(&self.word(0)) || SUM.contains(&self.word(0));
            if !(goes_on || self.ends_value() || self.is_boundary())
                && let Some(found) = self.problems.last_mut()
            {
                found.fixes.clear();
            }
            value = self.operations(value);
        }
        value
    }

    fn closes_nothing(&mut self) -> bool {
        let word = self.word(0);
        matches!(word, ")" | "]") && word != self.within.close
    }

    /// Whether what stands behind some values belongs to them.
    fn goes_on(&mut self, values: &[Value<'s>]) -> bool {
        let (word, is_new) = (self.word(0), self.is_on_new_line(0));
        if is_new && !self.within.is_block {
            return false;
        }
        match self.kind(0) {
            TokenKind::Name => {
                // The words of a colour or a method, written apart.
                let is_words = matches!(self.within.takes, Some(Type::Color | Type::Method))
                    && values.iter().all(|v| matches!(v.kind, ValueKind::Name(_)))
                    && !self.starts_value(1);
                !is_new
                    && word != "let"
                    && !self.is_field_name(word)
                    && !self.starts_block()
                    && (is_words || self.words.is_value(word))
            }
            TokenKind::Number | TokenKind::Quoted => true,
            TokenKind::Color => !is_new,
            TokenKind::Sign => matches!(word, "(" | "[" | "<"),
            _ => false,
        }
    }

    /// Whether a comma stands between values, rather than between two fields.
    fn goes_on_behind_comma(&mut self) -> bool {
        let (word, is_new) = (self.word(1), self.is_on_new_line(1));
        match self.kind(1) {
            TokenKind::Number | TokenKind::Color => self.within.is_block || !is_new,
            TokenKind::Name => !is_new && self.words.is_value(word) && !self.is_field_name(word),
            TokenKind::Sign => !is_new && matches!(word, "-" | "("),
            _ => false,
        }
    }

    /// `multi-jittered`
    fn hyphenated(&mut self) -> Value<'s> {
        let mut span = self.bump();
        while self.is(0, "-") && self.is_name(1) {
            self.bump();
            span = span.to(self.bump());
        }
        Value {
            kind: ValueKind::Name(self.written(span)),
            span,
        }
    }

    // Operators.

    /// A value with its operators.
    pub(super) fn expression(&mut self) -> Value<'s> {
        let first = self.signed();
        self.operations(first)
    }

    fn operations(&mut self, left: Value<'s>) -> Value<'s> {
        let left = self.chain(left, PRODUCT, Self::signed);
        self.chain(left, SUM, |this| {
            let first = this.signed();
            this.chain(first, PRODUCT, Self::signed)
        })
    }

    /// Goes on with a value as long as these operators follow.
    fn chain(
        &mut self,
        mut left: Value<'s>,
        signs: &[&str],
        operand: fn(&mut Self) -> Value<'s>,
    ) -> Value<'s> {
        loop {
            self.comments(Place::Operator);
            let written = self.word(0);
            if self.too_deep || !signs.contains(&written) {
                return left;
            }
            let sign = self.bump();
            let is_doubled = PRODUCT.contains(&self.word(0));
            left = if is_doubled || self.ends_value() {
                let left = self.without_operand(left, written, sign);
                self.skip_operators();
                if is_doubled && !self.ends_value() {
                    operand(self);
                }
                left
            } else {
                let right = operand(self);
                self.operation(left, written, sign, right)
            };
        }
    }

    fn skip_operators(&mut self) {
        while PRODUCT.contains(&self.word(0)) {
            self.bump();
        }
    }

    fn operation(
        &mut self,
        left: Value<'s>,
        written: &str,
        sign: Span,
        right: Value<'s>,
    ) -> Value<'s> {
        let (operator, is_right) = match written {
            "+" => (Operator::Add, true),
            "-" => (Operator::Subtract, true),
            "*" => (Operator::Multiply, true),
            "/" => (Operator::Divide, true),
            "−" => (Operator::Subtract, false),
            "×" | "·" => (Operator::Multiply, false),
            "÷" => (Operator::Divide, false),
            _ => return self.power(left, written, sign, right),
        };
        if !is_right {
            self.unknown_operator(
                written,
                sign,
                Some(replace(sign, operator.sign().to_string())),
            );
        }
        chain(left, operator, sign, right)
    }

    /// `r^2` is a product, if `r` is short.
    fn power(&mut self, left: Value<'s>, written: &str, sign: Span, right: Value<'s>) -> Value<'s> {
        let whole = left.span.to(right.span);
        let gap = self.written(Span::new(self.id, left.span.end, right.span.start));
        let is_short = matches!(
            left.kind,
            ValueKind::Number(_) | ValueKind::Name(_) | ValueKind::Call(_)
        );
        let count = match right.kind {
            ValueKind::Number("2") if is_short && written != "%" && !gap.contains('/') => 2,
            ValueKind::Number("3") if is_short && written != "%" && !gap.contains('/') => 3,
            _ => {
                self.unknown_operator(written, sign, None);
                return bad(whole);
            }
        };
        let product = vec![self.written(left.span); count].join(" * ");
        self.unknown_operator(written, sign, Some(replace(whole, product)));
        let factor = left.clone();
        (1..count).fold(left, |product, _| {
            chain(product, Operator::Multiply, sign, factor.clone())
        })
    }

    fn unknown_operator(&mut self, written: &str, span: Span, fix: Option<Fix>) {
        let help = match (written, self.within.takes) {
            ("%", Some(Type::Color)) => "write a part of a colour as a number from 0 to 255",
            ("%", _) => "write the number itself, such as `0.5`",
            _ => "write a product, such as `a * a`, or `sqrt(a)`",
        };
        let message = format!("there is no operator `{written}`");
        let label = "not one of `+`, `-`, `*` and `/`";
        self.problems
            .push(problem("unknown_operator", message, span, label).with_fix_or(fix, help));
    }

    /// An operator behind which nothing stands.
    fn without_operand(&mut self, left: Value<'s>, written: &str, sign: Span) -> Value<'s> {
        if written == "%" {
            self.unknown_operator(written, sign, None);
            return bad(left.span.to(sign));
        }
        // Without a factor the value would be of another type.
        let is_term = SUM.contains(&written) && self.ends_value();
        let edit = Edit::remove_in(sign, self.text);
        let fix = is_term.then(|| Fix::new(format!("remove this `{written}`"), [edit]));
        self.missing_operand("after", written, sign, fix);
        match is_term {
            true => left,
            false => bad(left.span.to(sign)),
        }
    }

    fn missing_operand(&mut self, side: &str, written: &str, sign: Span, fix: Option<Fix>) {
        let message = format!("nothing stands {side} this `{written}`");
        let label = format!("a value is missing {side} this");
        let help = format!("write a value {side} it, or take the `{written}` away");
        self.problems
            .push(problem("missing_operand", message, sign, label).with_fix_or(fix, help));
    }

    /// Whether no value can stand here: at what closes or separates, a field, or an item.
    fn ends_value(&mut self) -> bool {
        let word = self.word(0);
        match self.kind(0) {
            TokenKind::End => true,
            TokenKind::Name => {
                word == "let"
                    || (self.is_field_name(word) && !self.words.is_value(word))
                    || (self.is_on_new_line(0) && self.is_head(0))
            }
            _ if word == "{" => !self.is_flat_list(),
            _ => matches!(word, "}" | ")" | "]" | "," | ";" | "="),
        }
    }

    fn signed(&mut self) -> Value<'s> {
        self.comments(Place::Value);
        let written = self.word(0);
        if !SUM.contains(&written) {
            return self.operand();
        }
        if self.is_too_deep() {
            return self.pass_over();
        }
        let (sign, told) = (self.bump(), self.problems.len());
        self.depth += 1;
        let operand = self.signed();
        self.depth -= 1;
        if written == "+" {
            if self.problems.len() == told {
                let edit = Edit::new(Span::new(self.id, sign.start, operand.span.start), "");
                let title = format!("write `{}`", self.short(operand.span));
                let message = "no `+` stands before a value";
                let mut found = problem("plus_sign", message, sign, "not needed")
                    .with_fix(Fix::new(title, [edit]));
                found.is_needless = true;
                self.problems.push(found);
            }
            return operand;
        }
        if written != "-" {
            self.unknown_operator(written, sign, Some(replace(sign, "-")));
        }
        match operand.kind {
            ValueKind::Bad => bad(sign.to(operand.span)),
            _ => negation(sign, operand),
        }
    }

    // Operands.

    fn operand(&mut self) -> Value<'s> {
        let word = self.word(0);
        match self.kind(0) {
            TokenKind::Number => self.number(),
            TokenKind::Name if !self.ends_value() => self.reference(),
            TokenKind::Color => self.color(),
            TokenKind::Quoted => self.quoted(),
            TokenKind::Sign if word == "#" => self.color(),
            TokenKind::Sign if word == "(" => self.group(")"),
            TokenKind::Sign if word == "[" => self.group("]"),
            TokenKind::Sign if word == "<" => self.group(">"),
            TokenKind::Sign if word == "{" && self.is_flat_list() => self.group("}"),
            TokenKind::Sign if PRODUCT.contains(&word) => {
                let sign = self.here();
                self.missing_operand("before", word, sign, None);
                self.skip_operators();
                if !self.ends_value() {
                    self.number_or_else();
                }
                bad(sign.to(self.behind()))
            }
            _ => {
                let start = self.behind();
                self.unexpected("a value", self.example());
                if self.lists == 0 {
                    self.resync();
                } else if !self.ends_value() {
                    self.bump();
                }
                bad(start.to(self.behind()))
            }
        }
    }

    /// Passes over the value behind an operator that has none before it.
    fn number_or_else(&mut self) {
        let told = self.problems.len();
        match self.is_too_deep() {
            true => self.pass_over(),
            false => {
                self.depth += 1;
                let value = self.signed();
                self.depth -= 1;
                value
            }
        };
        self.problems.truncate(told);
    }

    /// Whether a value can start at a token ahead.
    pub(super) fn starts_value(&mut self, ahead: usize) -> bool {
        match self.kind(ahead) {
            TokenKind::Number | TokenKind::Color | TokenKind::Quoted | TokenKind::Word => true,
            TokenKind::Name => !self.is(ahead, "let"),
            TokenKind::Sign => matches!(self.word(ahead), "(" | "[" | "<" | "-" | "+" | "−"),
            _ => false,
        }
    }

    /// A name, the call of a function, or what people write for one.
    fn reference(&mut self) -> Value<'s> {
        let name = self.name();
        if self.is(0, ".") && self.is_adjacent(0) && self.is_name(1) {
            self.bump();
            let span = name.span.to(self.bump());
            let help =
                "give the value a name with `let NAME = VALUE`, and use the name in both places";
            self.not_in_language("reading of fields", help, span);
            return bad(span);
        }
        if self.is(0, "(") {
            return self.call(name);
        }
        let is_argument = self.kind(0) == TokenKind::Number
            || (self.is(0, "-") && self.kind(1) == TokenKind::Number);
        if self.words.is_function(name.text) && is_argument && !self.is_on_new_line(0) {
            return self.call_without_parentheses(name);
        }
        Value {
            kind: ValueKind::Name(name.text),
            span: name.span,
        }
    }

    /// `sin 30deg`, `rgb 255 0 0`
    fn call_without_parentheses(&mut self, name: Name<'s>) -> Value<'s> {
        let told = self.problems.len();
        let mut arguments = vec![self.signed()];
        while self.kind(0) == TokenKind::Number
            || (self.is(0, ",") && self.kind(1) == TokenKind::Number)
        {
            if self.is(0, ",") {
                self.bump();
            }
            arguments.push(self.signed());
        }
        let span = name.span.to(self.behind());
        if self.problems.len() > told {
            return bad(span);
        }
        let list = self.list_of(&arguments);
        let fix = replace(span, format!("{}({list})", name.text));
        self.missing_parentheses(span, Some(fix));
        self.call_of(name, elements(arguments), span)
    }

    pub(super) fn call_of(
        &self,
        function: Name<'s>,
        arguments: Vec<Element<'s>>,
        parentheses: Span,
    ) -> Value<'s> {
        let span = function.span.to(parentheses);
        let call = Call {
            function,
            arguments,
            parentheses,
        };
        Value {
            kind: ValueKind::Call(Box::new(call)),
            span,
        }
    }

    fn color(&mut self) -> Value<'s> {
        let sign = self.word(0);
        let mut span = self.bump();
        let digits = sign.trim_start_matches('#');
        if is_color_code(digits) {
            return Value {
                kind: ValueKind::ColorCode(sign),
                span,
            };
        }
        let next = self.word(0);
        let is_apart = digits.is_empty() && !self.is_on_new_line(0);
        let mut fix = None;
        let label = if is_apart && self.words.is_color(next) {
            span = span.to(self.bump());
            fix = Some(replace(span, next));
            "no `#` stands before the name of a colour".to_owned()
        } else if is_apart && is_color_code(next) {
            span = span.to(self.bump());
            fix = Some(replace(span, format!("#{next}")));
            "no space stands behind the `#`".to_owned()
        } else {
            match digits.chars().find(|digit| !digit.is_ascii_hexdigit()) {
                Some(other) => format!("`{other}` is no hexadecimal digit"),
                None => format!("{} digits", digits.len()),
            }
        };
        let help = "write three or six digits from 0 to 9 and a to f, such as `#fa0` or `#ffaa00`";
        let message = format!("`{}` is no colour", self.short(span));
        self.problems
            .push(problem("bad_color_code", message, span, label).with_fix_or(fix, help));
        bad(span)
    }

    fn quoted(&mut self) -> Value<'s> {
        let span = self.bump();
        let inner = unquoted(self.written(span));
        let (what, fix, kind) = match is_name(inner) {
            true => ("a name", Some(replace(span, inner)), ValueKind::Name(inner)),
            false => ("a value", None, ValueKind::Bad),
        };
        let help = match inner {
            "" => "write a value in place of the quotation marks".to_owned(),
            _ => format!("write `{}`", shorten(inner)),
        };
        let message = format!("{what} is written without quotation marks");
        let found = problem("quoted", message, span, "without the quotation marks");
        self.problems.push(found.with_fix_or(fix, help));
        Value { kind, span }
    }

    // Depth.

    pub(super) fn is_too_deep(&self) -> bool {
        self.depth >= NESTING_LIMIT
    }

    /// Passes over the rest of a value that nests too deep.
    pub(super) fn pass_over(&mut self) -> Value<'s> {
        let span = self.here();
        let first = Span::new(self.id, span.start, span.start + 1);
        if !self.too_deep {
            let message = format!("this value nests more than {NESTING_LIMIT} levels deep");
            let label = format!("level {}", NESTING_LIMIT + 1);
            self.problems.push(
                problem("too_deep", message, first, label)
                    .with_help("give a part of it a name with `let`, and use the name here"),
            );
        }
        self.too_deep = true;
        let mut open = self.lists;
        while !matches!(self.word(0), "" | "{" | "}" | "let") && (open > 0 || !self.is_boundary()) {
            match self.word(0) {
                "(" => open += 1,
                ")" => open = open.saturating_sub(1),
                _ => {}
            }
            self.bump();
        }
        bad(first)
    }

    // Several values where one should stand.

    /// The parts of a list, for a text.
    pub(super) fn list_of(&self, values: &[Value<'s>]) -> String {
        let texts: Vec<&str> = values
            .iter()
            .map(|value| self.written(value.span))
            .collect();
        texts.join(", ")
    }

    /// One value of several that were written behind each other.
    fn joined(&mut self, mut values: Vec<Value<'s>>, commas: &[Span]) -> Value<'s> {
        let (first, last) = match values.as_slice() {
            [] => return bad(self.behind()),
            [_] => return values.swap_remove(0),
            [first, .., last] => (first.span, last.span),
        };
        let span = first.to(last);
        if values.iter().any(|value| value.kind == ValueKind::Bad) {
            return bad(span);
        }
        let (takes, whole) = (self.within.takes, self.written(span));
        let are_names = values.iter().all(|v| matches!(v.kind, ValueKind::Name(_)));
        if matches!(takes, Some(Type::Color | Type::Method))
            && are_names
            && commas.is_empty()
            && !whole.contains(['\n', '/'])
        {
            // `dark red` and `multi jittered` are one name, written wrongly.
            return Value {
                kind: ValueKind::Name(whole),
                span,
            };
        }
        let numbers = values.iter().all(is_plain_number);
        if numbers
            && !commas.is_empty()
            && matches!(takes, None | Some(Type::Number | Type::Angle))
            && let Some(found) = self.comma_in_number(span)
        {
            self.problems.push(found);
            return bad(span);
        }
        let list = self.list_of(&values);
        let is_vector =
            matches!(values.first(), Some(first) if matches!(first.kind, ValueKind::Tuple(_)));
        match (takes, values.len()) {
            (Some(Type::Color), 3) if numbers => {
                self.missing_parentheses(span, Some(replace(span, format!("rgb({list})"))));
                let text = "rgb";
                self.call_of(Name { text, span: first }, elements(values), span)
            }
            (Some(Type::Vector) | None, 3) | (Some(Type::Colors), 2) => {
                self.missing_parentheses(span, Some(replace(span, format!("({list})"))));
                let kind = ValueKind::Tuple(elements(values));
                Value { kind, span }
            }
            (Some(Type::Vector), _) if !is_vector => {
                self.missing_parentheses(span, None);
                bad(span)
            }
            _ => self.missing_between(values, span),
        }
    }

    fn missing_parentheses(&mut self, span: Span, fix: Option<Fix>) {
        let message = "values that belong together stand in parentheses";
        let help = self.example();
        self.problems.push(
            problem(
                "missing_parentheses",
                message,
                span,
                "these belong together",
            )
            .with_fix_or(fix, help),
        );
    }

    /// Two values with nothing between: an operator is missing, or the name of a field.
    fn missing_between(&mut self, values: Vec<Value<'s>>, span: Span) -> Value<'s> {
        let is_whole = |value: &Value<'s>| match value.kind {
            ValueKind::Tuple(_) | ValueKind::ColorCode(_) => true,
            ValueKind::Name(name) => self.words.is_color(name),
            _ => false,
        };
        let (left, right) = match <[Value<'s>; 2]>::try_from(values) {
            Ok([left, right]) => (left, right),
            Err(mut values) => {
                values.truncate(2);
                match <[Value<'s>; 2]>::try_from(values) {
                    Ok([left, right]) => (left, bad(right.span)),
                    Err(_) => return bad(span),
                }
            }
        };
        let is_method = self.within.takes == Some(Type::Method);
        if self.within.is_block && (is_whole(&left) || is_method) {
            let text = self.short(right.span);
            let message = "a value stands here without the name of its field";
            let help = format!("write the name of the field that `{text}` is for before it");
            self.problems.push(
                problem(
                    "missing_field_name",
                    message,
                    right.span,
                    "which field is this for?",
                )
                .with_help(help),
            );
            return bad(span);
        }
        match self.product(left, right) {
            Some(product) => product,
            None => bad(span),
        }
    }

    /// `2 pi`: a product without its sign, if both are surely numbers.
    pub(super) fn product(&mut self, left: Value<'s>, right: Value<'s>) -> Option<Value<'s>> {
        let sign = Span::new(self.id, left.span.end, right.span.start);
        let are_numbers = (is_plain_number(&left) && self.is_factor(&right))
            || (self.is_factor(&left) && is_plain_number(&right));
        let is_sure = are_numbers && matches!(self.within.takes, None | Some(Type::Number));
        let (l, r) = (self.short(left.span), self.short(right.span));
        let message = format!("an operator is missing between `{l}` and `{r}`");
        let label = "what is to be done with this?";
        let found = problem("missing_operator", message, right.span, label);
        self.problems.push(match is_sure {
            true => found
                .with_fix(Fix::new(
                    format!("write `{l} * {r}`"),
                    [Edit::new(sign, " * ")],
                ))
                .with_help(format!("write `{l} * {r}` to multiply them")),
            false => found.with_help("write an operator between them, or take one of them away"),
        });
        is_sure.then(|| chain(left, Operator::Multiply, sign, right))
    }

    /// Whether a value starts with a name that is surely that of a number, or is one in parentheses.
    pub(super) fn is_factor(&self, value: &Value<'s>) -> bool {
        match &value.kind {
            ValueKind::Name(name) => self.words.is_factor(name),
            ValueKind::Parentheses(inner) => is_plain_number(inner) || self.is_factor(inner),
            ValueKind::Chain { first, rest } => {
                self.is_factor(first) && rest.iter().all(|step| is_plain_number(&step.operand))
            }
            _ => false,
        }
    }

    /// `1,5` and `1,000,000`
    fn comma_in_number(&self, span: Span) -> Option<Diagnostic> {
        let written = self.written(span);
        let comma = span.start + written.find(',')?;
        let parts: Vec<&str> = written.split(',').collect();
        let (head, rest) = parts.split_first()?;
        let is_digits = |part: &&str| part.bytes().all(|byte| byte.is_ascii_digit());
        if !rest.iter().all(is_digits) || numeric_part(head.trim_start_matches('-')).is_empty() {
            return None;
        }
        let is_whole = self.words.is_whole(self.within.kind, self.within.field);
        let are_thousands = rest.iter().all(|part| part.len() == 3);
        let (message, right) = if are_thousands && (rest.len() > 1 || is_whole) {
            ("no commas stand in a number", parts.join("_"))
        } else if rest.len() == 1 && !head.contains('.') {
            ("a decimal point is written `.`, not `,`", parts.join("."))
        } else {
            return None;
        };
        let place = Span::new(self.id, comma, comma + 1);
        let label = "a comma separates the parts of a vector";
        let found = problem("decimal_comma", message, place, label);
        Some(found.with_fix(replace(span, right)))
    }
}

/// Values as the parts of a list whose commas are not there.
pub(super) fn elements(values: Vec<Value<'_>>) -> Vec<Element<'_>> {
    let element = |value| Element { value, comma: None };
    values.into_iter().map(element).collect()
}
