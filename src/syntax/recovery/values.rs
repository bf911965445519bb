//! Values: operators, operands, and what stands between parentheses.

use super::{Place, Recovery};
use crate::{
    diagnostic::Edit,
    schema::Type,
    source::Span,
    syntax::{
        NESTING_LIMIT, Problem,
        fix::Way,
        messages::shorten,
        tokens::{TokenKind, numeric_part},
        tree::{Call, Element, Name, Operator, Step, Value, ValueKind, bad, chain, negation},
    },
};

impl<'s> Recovery<'_, 's> {
    /// A value with its operators.
    pub(super) fn expression(&mut self) -> Value<'s> {
        let left = self.product(None);
        let is_sum = |sign: &str| matches!(sign, "+" | "-" | "−");
        self.chain(left, &is_sum, |this, sign| this.product(Some(sign)))
    }

    fn product(&mut self, after: Option<Span>) -> Value<'s> {
        let left = self.signed(after);
        let is_product =
            |sign: &str| matches!(sign, "*" | "/" | "×" | "·" | "÷" | "^" | "**" | "%");
        self.chain(left, &is_product, |this, sign| this.signed(Some(sign)))
    }

    /// Goes on with a value as long as these operators follow.
    fn chain(
        &mut self,
        mut left: Value<'s>,
        is_operator: &dyn Fn(&str) -> bool,
        operand: impl Fn(&mut Self, Span) -> Value<'s>,
    ) -> Value<'s> {
        loop {
            self.comments(Place::Operator);
            if self.too_deep || !is_operator(self.word(0)) {
                return left;
            }
            let written = self.word(0);
            let sign = self.bump();
            let operator = match written {
                "+" => Operator::Add,
                "-" | "−" => Operator::Subtract,
                "/" | "÷" => Operator::Divide,
                _ => Operator::Multiply,
            };
            if written == "%" && !self.starts_value(0) {
                let way = Way::told(match self.within.takes {
                    Some(Type::Color) => "write a part of a colour as a number from 0 to 255",
                    _ => "write the share as a number, such as `0.5`",
                });
                self.unknown_operator("%", sign, way);
                left = bad(left.span.to(sign));
                continue;
            }
            let base = left.span;
            let right = operand(self, sign);
            let whole = base.to(right.span);
            if matches!(written, "+" | "-" | "*" | "/") {
                left = chain(left, operator, sign, right);
                continue;
            }
            let way = match written {
                "^" | "**" => self.power(&left, &right),
                "%" => Way::told("a remainder cannot be taken; write the number itself"),
                _ => Way::replace(sign, operator.sign().to_string()),
            };
            self.unknown_operator(written, sign, way);
            left = bad(whole);
        }
    }

    fn unknown_operator(&mut self, written: &str, span: Span, way: Way) {
        self.problems.push(Problem::UnknownOperator {
            sign: written.to_owned(),
            span,
            way,
        });
    }

    /// `a ^ 2` and `a ^ 3` are products, if `a` is short.
    fn power(&self, left: &Value<'s>, exponent: &Value<'s>) -> Way {
        let told = Way::told("write a product, such as `a * a`, or `sqrt(a)`");
        let (mut base, mut is_divisor) = (left, false);
        if let ValueKind::Chain { rest, .. } = &left.kind
            && let Some(last) = rest.last()
        {
            (base, is_divisor) = (&last.operand, last.operator == Operator::Divide);
        }
        if let ValueKind::Negation { operand, .. } = &base.kind {
            base = operand;
        }
        let times = match exponent.kind {
            ValueKind::Number("2") => 2,
            ValueKind::Number("3") => 3,
            _ => return told,
        };
        let is_plain = matches!(
            base.kind,
            ValueKind::Number(_)
                | ValueKind::Name(_)
                | ValueKind::Call(_)
                | ValueKind::Parentheses(_)
        );
        let whole = base.span.to(exponent.span);
        if !is_plain || self.written(whole).contains("/*") || self.written(whole).contains("//") {
            return told;
        }
        let product = vec![self.written(base.span); times].join(" * ");
        match is_divisor {
            true => Way::replace(whole, format!("({product})")),
            false => Way::replace(whole, product),
        }
    }

    fn signed(&mut self, after: Option<Span>) -> Value<'s> {
        self.comments(Place::Value);
        match self.word(0) {
            "-" | "−" => {
                if self.is_too_deep() {
                    return self.pass_over();
                }
                let is_right = self.is(0, "-");
                let sign = self.bump();
                self.prefix = sign.start;
                if !is_right {
                    self.unknown_operator("−", sign, Way::replace(sign, "-"));
                }
                self.depth += 1;
                let operand = self.signed(Some(sign));
                self.depth -= 1;
                match operand.kind {
                    ValueKind::Bad => bad(sign.to(operand.span)),
                    _ => negation(sign, operand),
                }
            }
            "+" => {
                if self.is_too_deep() {
                    return self.pass_over();
                }
                let sign = self.bump();
                let index = self.problems.len();
                self.depth += 1;
                let operand = self.signed(Some(sign));
                self.depth -= 1;
                let value = self.short(operand.span);
                let edit = Edit::new(Span::new(self.id, sign.start, operand.span.start), "");
                if self.problems.len() == index {
                    self.problems.push(Problem::PlusSign {
                        span: sign,
                        way: Way::write(format!("write `{value}`"), [edit]),
                    });
                }
                operand
            }
            _ => self.operand(after),
        }
    }

    fn operand(&mut self, after: Option<Span>) -> Value<'s> {
        match (self.kind(0), self.word(0)) {
            (TokenKind::Number, _) => self.number(),
            (TokenKind::Name, word) if word != "let" && !self.ends_value(after) => self.reference(),
            (TokenKind::Color, _) | (_, "#") => self.color(),
            (TokenKind::Quoted, _) => self.quoted(),
            (TokenKind::Sign, "(") => self.group(")"),
            (TokenKind::Sign, "[") => self.group("]"),
            (TokenKind::Sign, "<") => self.group(">"),
            (TokenKind::Sign, "{") if self.is_flat_list() => self.group("}"),
            (_, word) => {
                let here = Span::new(self.id, self.last_end, self.last_end);
                let is_operator = matches!(word, "*" | "/" | "^" | "**" | "%" | "×" | "·" | "÷");
                match after {
                    Some(operator) => self.missing_operand(operator, "after"),
                    None if is_operator => {
                        let operator = self.here();
                        self.missing_operand(operator, "before");
                    }
                    None => {
                        self.unexpected(
                            "a value",
                            "write a value, such as `2`, `30deg`, `(0, 1, 0)` or `olive`",
                        );
                        if self.kind(0) == TokenKind::Word || !self.ends_line() {
                            let span = self.bump();
                            return bad(span);
                        }
                    }
                }
                bad(here)
            }
        }
    }

    /// Whether a name behind an operator starts a field or an item, so that the operand is missing.
    fn ends_value(&mut self, after: Option<Span>) -> bool {
        let word = self.word(0);
        after.is_some()
            && ((self.within.is_block && self.is_field_name(word) && !self.words.is_value(word))
                || (self.is_on_new_line(0) && self.is_head(0)))
    }

    /// Whether what follows must not be passed over: a brace, a closing parenthesis, a comma, `let`, or the end.
    fn ends_line(&mut self) -> bool {
        let kind = self.kind(0);
        kind == TokenKind::End || matches!(self.word(0), "{" | "}" | ")" | "]" | "," | ";" | "let")
    }

    fn missing_operand(&mut self, operator: Span, side: &'static str) {
        let sign = self.short(operator);
        // Without a sign in front of a value nothing would be left.
        let is_between = self.prefix != operator.start;
        // Without a factor the value would be of another type.
        let is_term = matches!(sign.as_str(), "+" | "-");
        let way = match side == "after" && is_term && is_between && self.ends_line() {
            true => Way::remove(format!("remove this `{sign}`"), operator),
            false => Way::told(format!(
                "write a value {side} it, or take the `{sign}` away"
            )),
        };
        self.problems.push(Problem::MissingOperand {
            operator: self.short(operator),
            side,
            span: operator,
            way,
        });
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
        let value = Value {
            kind: ValueKind::Name(name.text),
            span: name.span,
        };
        if self.is(0, ".") && self.is_adjacent(0) && self.is_name(1) {
            self.bump();
            let span = name.span.to(self.bump());
            self.problems.push(Problem::NotInLanguage {
                what: "reading of fields",
                help: "give the value a name with `let NAME = VALUE`, and use the name in both places",
                span,
            });
            return bad(span);
        }
        if self.is(0, "(") {
            return self.call(name);
        }
        // `sin 30deg`, `rgb 255 0 0`.
        let is_argument = matches!(self.kind(0), TokenKind::Number)
            || (self.is(0, "-") && self.kind(1) == TokenKind::Number);
        if self.words.is_function(name.text) && is_argument && !self.is_on_new_line(0) {
            return self.call_without_parentheses(name);
        }
        value
    }

    fn call(&mut self, name: Name<'s>) -> Value<'s> {
        let index = self.problems.len();
        let start = self.here().start;
        let shape = Shape {
            parts: None,
            takes: None,
            function: Some(name.text),
        };
        let elements = self.list(")", shape);
        let parentheses = Span::new(self.id, start, self.last_end);
        let span = name.span.to(parentheses);
        if self.words.is_foreign_function(name.text) && self.problems.len() == index {
            return self.foreign_function(name, elements, span);
        }
        let kind = match elements {
            Some(arguments) if !self.too_deep => ValueKind::Call(Box::new(Call {
                function: name,
                arguments,
                parentheses,
            })),
            _ => ValueKind::Bad,
        };
        Value { kind, span }
    }

    /// `vec3(1, 2, 3)` and `rgba(255, 0, 0, 1)`.
    fn foreign_function(
        &mut self,
        name: Name<'s>,
        elements: Option<Vec<Element<'s>>>,
        span: Span,
    ) -> Value<'s> {
        let parts = elements.unwrap_or_default();
        let texts: Vec<&str> = parts.iter().map(|e| self.written(e.value.span)).collect();
        let is_color = matches!(name.text, "rgba" | "color" | "Color");
        let way = match (is_color, texts.as_slice(), self.within.takes) {
            (true, [r, g, b] | [r, g, b, _], None | Some(Type::Color)) => {
                Way::replace(span, format!("rgb({r}, {g}, {b})"))
            }
            (false, [x, y, z], None | Some(Type::Vector)) => {
                Way::replace(span, format!("({x}, {y}, {z})"))
            }
            (true, ..) => Way::told("write a colour as `rgb(255, 165, 0)`, `#ffa500` or `orange`"),
            (false, ..) => Way::told("write a vector as `(1, 2, 3)`"),
        };
        self.problems.push(Problem::ForeignFunction {
            written: name.text.to_owned(),
            span: name.span,
            way,
        });
        bad(span)
    }

    fn call_without_parentheses(&mut self, name: Name<'s>) -> Value<'s> {
        let index = self.problems.len();
        let mut arguments = vec![self.signed(None)];
        while matches!(self.kind(0), TokenKind::Number)
            || (self.is(0, ",") && self.kind(1) == TokenKind::Number)
        {
            if self.is(0, ",") {
                self.bump();
            }
            arguments.push(self.signed(None));
        }
        let texts: Vec<&str> = arguments.iter().map(|a| self.written(a.span)).collect();
        let last = arguments.last().map_or(name.span, |last| last.span);
        let whole = name.span.to(last);
        let way = Way::replace(whole, format!("{}({})", name.text, texts.join(", ")));
        let span = arguments.first().map_or(last, |first| first.span.to(last));
        if self.problems.len() == index {
            self.problems
                .push(Problem::MissingParentheses { span, way });
        }
        bad(whole)
    }

    fn color(&mut self) -> Value<'s> {
        let sign = self.word(0);
        let mut span = self.bump();
        let digits = sign.trim_start_matches('#');
        let is_right = |digits: &str| {
            matches!(digits.len(), 3 | 6) && digits.bytes().all(|digit| digit.is_ascii_hexdigit())
        };
        if is_right(digits) {
            return Value {
                kind: ValueKind::ColorCode(sign),
                span,
            };
        }
        let next = self.word(0);
        let is_color = self.words.is_color(next);
        let is_apart = digits.is_empty() && !self.is_on_new_line(0);
        let (label, way) = if is_apart && (is_right(next) || is_color) {
            span = span.to(self.bump());
            let sign = if is_color { "" } else { "#" };
            let label = match is_color {
                true => "no `#` stands before the name of a colour",
                false => "no space stands behind the `#`",
            };
            (
                label.to_owned(),
                Way::replace(span, format!("{sign}{next}")),
            )
        } else {
            let label = match digits.chars().find(|digit| !digit.is_ascii_hexdigit()) {
                Some(other) => format!("`{other}` is no hexadecimal digit"),
                None if digits.is_empty() => "no digits".to_owned(),
                None if digits.len() == 1 => "1 digit".to_owned(),
                None => format!("{} digits", digits.len()),
            };
            let help =
                "write three or six digits from 0 to 9 and a to f, such as `#fa0` or `#ffaa00`";
            (label, Way::told(help))
        };
        self.problems.push(Problem::BadColorCode {
            written: self.short(span),
            span,
            label,
            way,
        });
        bad(span)
    }

    fn quoted(&mut self) -> Value<'s> {
        let written = self.word(0);
        let span = self.bump();
        let inner = unquoted(written);
        let is_name = is_name(inner);
        let way = match inner {
            "" => Way::told("write a value in place of the quotation marks"),
            _ if is_name => Way::replace(span, inner),
            _ => Way::told(format!("write `{}`", shorten(inner))),
        };
        let what = if is_name { "a name" } else { "a value" };
        self.problems.push(Problem::Quoted { what, span, way });
        let kind = if is_name {
            ValueKind::Name(inner)
        } else {
            ValueKind::Bad
        };
        Value { kind, span }
    }

    // Lists.

    /// Whether braces in place of a value hold a list, rather than fields.
    pub(super) fn is_flat_list(&mut self) -> bool {
        let sign = usize::from(self.is(1, "-"));
        matches!(self.kind(1 + sign), TokenKind::Number | TokenKind::Name)
            && (self.is(2 + sign, ",") || self.kind(1 + sign) == TokenKind::Number)
    }

    /// Values between parentheses, or between what people write for them.
    fn group(&mut self, close: &'static str) -> Value<'s> {
        let index = self.problems.len();
        let (takes, field) = (self.within.takes, self.within.field);
        let start = self.here();
        let parts = match takes {
            Some(Type::Vector) => Some(Type::Number),
            Some(Type::Colors) => Some(Type::Color),
            Some(Type::Method) => None,
            takes => takes,
        };
        let shape = Shape {
            parts,
            takes,
            function: None,
        };
        let elements = self.list(close, shape);
        let span = Span::new(self.id, start.start, self.last_end);
        let Some(elements) = elements.filter(|_| !self.too_deep) else {
            return bad(span);
        };
        if close != ")" {
            if self.problems.len() == index {
                self.brackets(&elements, takes, span);
            }
        } else if elements.len() > 3 && takes == Some(Type::Vector) && !field.is_empty() {
            self.decimal_comma_in_vector(&elements);
        }
        let is_bad = match close {
            ")" => elements.len() > 3,
            _ => takes == Some(Type::Color),
        };
        let kind = match <[Element<'s>; 1]>::try_from(elements) {
            _ if is_bad && self.problems.len() > index => ValueKind::Bad,
            Ok([only]) => ValueKind::Parentheses(Box::new(only.value)),
            Err(elements) => ValueKind::Tuple(elements),
        };
        Value { kind, span }
    }

    fn brackets(&mut self, elements: &[Element<'s>], takes: Option<Type>, span: Span) {
        let texts: Vec<&str> = elements
            .iter()
            .map(|e| self.written(e.value.span))
            .collect();
        let (what, before) = match takes {
            Some(Type::Color) => ("a colour", "rgb"),
            Some(Type::Colors) => ("a pair of colours", ""),
            _ => ("a vector", ""),
        };
        self.problems.push(Problem::Brackets {
            what,
            span,
            way: Way::replace(span, format!("{before}({})", texts.join(", "))),
        });
    }

    /// `(3, 3,5, 8)`: a comma right between two digits, where blanks follow the others.
    fn decimal_comma_in_vector(&mut self, elements: &[Element<'s>]) {
        let is_tight = |pair: &&[Element<'s>]| match pair {
            [a, b] => {
                let is_number = |value: &Value<'s>| matches!(value.kind, ValueKind::Number(_));
                is_number(&b.value)
                    && a.comma.is_some_and(|comma| {
                        comma.start == a.value.span.end && comma.end == b.value.span.start
                    })
            }
            _ => false,
        };
        let tight: Vec<&[Element<'s>]> = elements.windows(2).filter(is_tight).collect();
        if elements.len() == 3 + tight.len()
            && let [pair] = tight.as_slice()
            && let [a, b] = pair
            && let Some(comma) = a.comma
        {
            let number = format!(
                "{}.{}",
                self.written(a.value.span),
                self.written(b.value.span)
            );
            self.problems.push(Problem::DecimalComma {
                message: "a decimal point is written `.`, not `,`",
                span: comma,
                way: Way::write(format!("write `{number}`"), [Edit::new(comma, ".")]),
            });
        }
    }

    /// The values of a list, a comma between two; none if something was wrong that makes their number doubtful.
    fn list(&mut self, close: &'static str, shape: Shape<'s>) -> Option<Vec<Element<'s>>> {
        if self.is_too_deep() {
            self.pass_over();
            return None;
        }
        let open = self.bump();
        let takes = std::mem::replace(&mut self.within.takes, shape.parts);
        self.depth += 1;
        self.open += 1;
        let elements = self.elements(open, close, shape);
        self.open -= 1;
        self.depth -= 1;
        self.within.takes = takes;
        elements
    }

    fn elements(
        &mut self,
        open: Span,
        close: &'static str,
        shape: Shape<'s>,
    ) -> Option<Vec<Element<'s>>> {
        let mut elements: Vec<Element<'s>> = Vec::new();
        let mut needless: Option<(Span, &'static str)> = None;
        let mut missing = Vec::new();
        let mut is_right = true;
        loop {
            let is_value_next = elements.last().is_none_or(|last| last.comma.is_some());
            self.comments(if is_value_next {
                Place::Value
            } else {
                Place::Operator
            });
            if self.too_deep {
                return None;
            }
            let word = self.word(0);
            if word == close || (word == ")" && close != "}") || (close == ")" && word == "]") {
                if word != close {
                    let span = self.here();
                    self.problems.push(Problem::Brackets {
                        what: "a list",
                        span,
                        way: match close {
                            ")" => Way::replace(span, ")"),
                            _ => Way::write("write `(` and `)`", [Edit::new(open, "(")]),
                        },
                    });
                }
                self.bump();
                break;
            }
            match word {
                ";" if !is_value_next => {
                    self.unexpected("`,`", "write a comma between the parts of a list");
                    let comma = self.bump();
                    if let Some(last) = elements.last_mut() {
                        last.comma = Some(comma);
                    }
                }
                "," => {
                    let comma = self.bump();
                    match elements.last_mut() {
                        Some(last) if last.comma.is_none() => last.comma = Some(comma),
                        _ => needless = needless.or(Some((comma, "no value stands before it"))),
                    }
                }
                _ if self.ends_list(is_value_next) => {
                    let is_told = missing.is_empty() && needless.is_none();
                    self.unclosed(open, &elements, close, is_told, shape);
                    return None;
                }
                _ => {
                    if !is_value_next {
                        missing.push(elements.len());
                    }
                    let before = self.problems.len();
                    let at = self.next;
                    let value = self.expression();
                    is_right &= self.problems.len() == before || value.kind != ValueKind::Bad;
                    if self.next == at && self.problems.len() > before && !self.is(0, close) {
                        // Nothing was taken: what stands here belongs to no value.
                        self.bump();
                    }
                    elements.push(Element { value, comma: None });
                }
            }
        }
        if let Some(comma) = elements.last().and_then(|last| last.comma) {
            needless = needless.or(Some((comma, "no value follows it")));
        }
        let count = elements.len();
        if let Some((span, place)) = needless {
            self.problems.push(match self.fits(shape, count) {
                true => Problem::NeedlessComma {
                    span,
                    place,
                    way: Way::remove("remove this comma", span),
                },
                false => Problem::MissingPart { span },
            });
        }
        // Where the parentheses are to be written anew, the commas are.
        if let Some(&first) = missing.first()
            && is_right
            && (close == ")" || count != 3)
        {
            self.missing_comma(&elements, first, &missing, shape);
        }
        let is_doubtful = !missing.is_empty() || needless.is_some();
        (!is_doubtful || count == 3).then_some(elements)
    }

    /// Whether a list must have ended before this: a brace, the end, `let`, or the name of a field.
    fn ends_list(&mut self, is_value_next: bool) -> bool {
        let word = self.word(0);
        match self.kind(0) {
            TokenKind::End => true,
            TokenKind::Name => {
                word == "let"
                    || (self.is_field_name(word) && !self.words.is_value(word))
                    || (self.is_on_new_line(0) && (self.is_head(0) || !self.within.is_block))
            }
            TokenKind::Sign if word == "{" => !(is_value_next && self.is_flat_list()),
            TokenKind::Sign => matches!(word, "}" | ";" | "="),
            _ => false,
        }
    }

    fn unclosed(
        &mut self,
        open: Span,
        elements: &[Element<'s>],
        close: &str,
        is_told: bool,
        shape: Shape<'s>,
    ) {
        let last = elements.last();
        let is_whole =
            last.is_some_and(|last| last.comma.is_none() && last.value.kind != ValueKind::Bad);
        let count = elements.len();
        let counts = self.fits(shape, count);
        let are_known = elements.iter().all(|e| self.is_known(&e.value));
        let are_numbers = count != 3 || elements.iter().all(|e| self.is_number(&e.value));
        let counts = counts && are_numbers && are_known;
        // A field's name with nothing behind it, or a sign, does not end a value.
        let is_end = match self.kind(0) {
            TokenKind::Name => !matches!(self.word(1), "," | ")"),
            TokenKind::End => true,
            _ => self.is(0, "}"),
        };
        let is_told = is_told && is_end;
        let right = if close == ">" { "(…)" } else { ")" };
        let way = match is_whole && counts && is_told {
            true => {
                let before = match self.word(0) {
                    "" => "at the end".to_owned(),
                    word => format!("before `{}`", shorten(word)),
                };
                let at = self.last_end;
                let mut edits = vec![Edit::insert(self.id, at, ")")];
                if close != ")" {
                    edits.insert(0, Edit::new(open, "("));
                }
                Way::write(format!("write `{right}` {before}"), edits)
            }
            false => Way::told("write `)` where it ends"),
        };
        self.problems
            .push(Problem::UnclosedParenthesis { span: open, way });
    }

    fn missing_comma(
        &mut self,
        elements: &[Element<'s>],
        index: usize,
        all: &[usize],
        shape: Shape<'s>,
    ) {
        let (Some(left), Some(right)) = (elements.get(index - 1), elements.get(index)) else {
            return;
        };
        let is_number = matches!(left.value.kind, ValueKind::Number(_));
        let is_factor = match right.value.kind {
            ValueKind::Name(name) => self.words.is_factor(name),
            _ => matches!(
                right.value.kind,
                ValueKind::Parentheses(_) | ValueKind::Call(_)
            ),
        };
        let (l, r) = (self.short(left.value.span), self.short(right.value.span));
        if (is_number && is_factor && elements.len() != 3) || left.value.kind == ValueKind::Bad {
            let gap = Span::new(self.id, left.value.span.end, right.value.span.start);
            self.problems
                .push(missing_operator(l, r, gap, right.value.span));
            return;
        }
        let places = all.iter().filter_map(|&index| elements.get(index - 1));
        let edits = places.map(|e| Edit::insert(self.id, e.value.span.end, ","));
        let edits: Vec<Edit> = edits.collect();
        let are_numbers = elements
            .iter()
            .all(|element| self.is_number(&element.value));
        if !self.fits(shape, elements.len()) || !are_numbers {
            self.problems.push(Problem::MissingComma {
                left: l,
                right: r,
                span: right.value.span,
                way: Way::told("write a comma or an operator between them, or take one away"),
            });
            return;
        }
        let texts: Vec<String> = elements.iter().map(|e| self.short(e.value.span)).collect();
        let whole = texts.join(", ");
        let help = match whole.len() {
            0..=60 => format!("write `({whole})`"),
            _ => format!("write `{l}, {r}`"),
        };
        self.problems.push(Problem::MissingComma {
            left: l,
            right: r,
            span: right.value.span,
            way: Way::write(help, edits),
        });
    }

    /// Whether so many values make a list of some shape.
    fn fits(&self, shape: Shape<'s>, count: usize) -> bool {
        match (shape.function, shape.takes) {
            (Some(function), _) => self.words.takes_arguments(function, count),
            (None, Some(Type::Vector)) => count == 3,
            (None, Some(Type::Colors)) => count == 2,
            (None, Some(Type::Method)) => false,
            (None, Some(_)) => count == 1,
            (None, None) => matches!(count, 1 | 3),
        }
    }

    /// Whether all names in a value are known, and its functions have as many arguments as they take.
    pub(super) fn is_known(&self, value: &Value<'s>) -> bool {
        let is_right = match &value.kind {
            ValueKind::Name(name) => self.words.is_value(name) && !self.words.is_function(name),
            ValueKind::Call(call) => {
                let count = call.arguments.len();
                self.words.takes_arguments(call.function.text, count)
            }
            ValueKind::Bad | ValueKind::Missing => false,
            _ => true,
        };
        is_right && value.parts().iter().all(|part| self.is_known(part))
    }

    /// Whether a value is a number, as far as can be told: what a name stands for is not known here.
    pub(super) fn is_number(&self, value: &Value<'s>) -> bool {
        match &value.kind {
            ValueKind::Number(_) => true,
            ValueKind::Name(name) => *name == "pi" || self.words.is_let(name),
            ValueKind::Call(call) => self.words.is_function(call.function.text),
            ValueKind::Negation { operand, .. } => self.is_number(operand),
            ValueKind::Parentheses(inner) => self.is_number(inner),
            ValueKind::Chain { first, rest } => {
                self.is_number(first) && rest.iter().all(|step| self.is_number(&step.operand))
            }
            _ => false,
        }
    }

    // Depth.

    fn is_too_deep(&self) -> bool {
        self.depth >= NESTING_LIMIT
    }

    /// Passes over the rest of a value that nests too deep.
    fn pass_over(&mut self) -> Value<'s> {
        let span = self.here();
        if !self.too_deep {
            self.problems.push(Problem::TooDeep {
                span: Span::new(self.id, span.start, span.start + 1),
            });
        }
        self.too_deep = true;
        let mut open = self.open;
        while self.kind(0) != TokenKind::End {
            match self.word(0) {
                "{" | "}" | "let" => break,
                "(" => open += 1,
                ")" => open = open.saturating_sub(1),
                "-" | "+" | "−" => {
                    self.bump();
                    continue;
                }
                _ => {}
            }
            self.bump();
            let is_call = self.is(0, "(");
            if open == 0 && !is_call {
                break;
            }
        }
        bad(span)
    }

    // Several values where one should stand.

    /// One value of several that were written behind each other.
    pub(super) fn joined(&mut self, mut values: Vec<Value<'s>>, commas: &[Span]) -> Value<'s> {
        let (first, last) = match values.as_slice() {
            [] => return bad(self.end_of_text()),
            [_] => return values.swap_remove(0),
            [first, .., last] => (first.span, last.span),
        };
        let span = first.to(last);
        if values.iter().any(|value| value.kind == ValueKind::Bad) {
            return bad(span);
        }
        let is_number = |value: &Value<'s>| {
            matches!(value.kind, ValueKind::Number(_))
                || matches!(&value.kind, ValueKind::Negation { operand, .. } if matches!(operand.kind, ValueKind::Number(_)))
        };
        let is_name = |value: &Value<'s>| matches!(value.kind, ValueKind::Name(_));
        let takes = self.within.takes;
        if takes == Some(Type::Vector) && commas.is_empty() && values.len() < 3 {
            values = values
                .into_iter()
                .flat_map(|value| self.parts_of_sum(value))
                .collect();
        }
        let texts: Vec<&'s str> = values
            .iter()
            .map(|value| self.written(value.span))
            .collect();
        let numbers = values.iter().all(is_number);
        let whole = self.written(span);
        let is_one_line = !whole.contains(['\n', '/']);
        if matches!(takes, Some(Type::Color | Type::Method))
            && values.iter().all(is_name)
            && commas.is_empty()
            && is_one_line
        {
            // `dark red` and `multi jittered` are one name, written wrongly.
            return Value {
                kind: ValueKind::Name(whole),
                span,
            };
        }
        if !commas.is_empty()
            && numbers
            && matches!(takes, None | Some(Type::Number | Type::Angle))
            && let Some(problem) = self.comma_in_number(&texts, commas, span)
        {
            self.problems.push(problem);
            return bad(span);
        }
        let list = texts.join(", ");
        let are_numbers = values.iter().all(|value| self.is_number(value));
        let problem = match (takes, values.len()) {
            (Some(Type::Color), 3) if numbers => Problem::MissingParentheses {
                span,
                way: Way::replace(span, format!("rgb({list})")),
            },
            (Some(Type::Colors), 2) if !values.iter().all(|value| self.is_color(value)) => {
                self.missing_between(&values)
            }
            (Some(Type::Vector) | None, 3) if !are_numbers => Problem::MissingParentheses {
                span,
                way: Way::told("write three numbers, such as `(0, 1, 0)`"),
            },
            (Some(Type::Vector) | None, 3) | (Some(Type::Colors), 2) => {
                Problem::MissingParentheses {
                    span,
                    way: Way::replace(span, format!("({list})")),
                }
            }
            (Some(Type::Method), _) => Problem::Unexpected {
                expected: "a field or `}`",
                written: texts.get(1).map_or_else(String::new, |text| shorten(text)),
                help: "write the method's name alone; `per_pixel 16` says how many samples there are",
                span: values.get(1).map_or(span, |second| second.span),
            },
            (Some(Type::Vector), _) if numbers => Problem::MissingParentheses {
                span,
                way: Way::told("write three numbers, such as `(0, 1, 0)`"),
            },
            _ => self.missing_between(&values),
        };
        self.problems.push(problem);
        bad(span)
    }

    fn is_color(&self, value: &Value<'s>) -> bool {
        match &value.kind {
            ValueKind::Name(name) => self.words.is_color(name) || self.words.is_let(name),
            ValueKind::ColorCode(_) => true,
            ValueKind::Call(call) => call.function.text == "rgb",
            _ => false,
        }
    }

    /// `0 -1`, where three numbers were to stand: a number, and a negative one.
    fn parts_of_sum(&self, value: Value<'s>) -> Vec<Value<'s>> {
        let ValueKind::Chain { first, rest } = value.kind else {
            return vec![value];
        };
        let is_sign = |step: &Step<'s>| {
            let before = step
                .sign
                .start
                .checked_sub(1)
                .and_then(|at| self.text.get(at..=at));
            step.operator == Operator::Subtract
                && step.sign.end == step.operand.span.start
                && before == Some(" ")
        };
        if !rest.iter().all(is_sign) {
            let kind = ValueKind::Chain { first, rest };
            return vec![Value { kind, ..value }];
        }
        let rest = rest
            .into_iter()
            .map(|step| negation(step.sign, step.operand));
        std::iter::once(*first).chain(rest).collect()
    }

    /// Two values with nothing between: an operator is missing, or the name of a field.
    fn missing_between(&self, values: &[Value<'s>]) -> Problem {
        let (Some(left), Some(right)) = (values.first(), values.get(1)) else {
            return Problem::MissingKind {
                span: self.end_of_text(),
            };
        };
        let is_whole = |value: &Value<'s>| match value.kind {
            ValueKind::Tuple(_) | ValueKind::ColorCode(_) => true,
            ValueKind::Name(name) => self.words.is_color(name),
            _ => false,
        };
        if self.within.is_block && is_whole(left) {
            let text = self.short(right.span);
            return Problem::MissingFieldName {
                span: right.span,
                way: Way::told(format!(
                    "write the name of the field that `{text}` is for before it"
                )),
            };
        }
        let (l, r) = (self.short(left.span), self.short(right.span));
        let is_factor = |value: &Value<'s>| match &value.kind {
            ValueKind::Name(name) => self.words.is_factor(name),
            ValueKind::Parentheses(_) | ValueKind::Call(_) => true,
            ValueKind::Chain { first, .. } => {
                matches!(first.kind, ValueKind::Name(name) if self.words.is_factor(name))
            }
            _ => false,
        };
        let is_number = matches!(right.kind, ValueKind::Number(_));
        let is_factor = is_factor(right) || (is_factor(left) && is_number);
        let takes_number = matches!(self.within.takes, None | Some(Type::Number));
        let gap = Span::new(self.id, left.span.end, right.span.start);
        match is_factor && takes_number && values.len() == 2 && !is_whole(left) {
            true => missing_operator(l, r, gap, right.span),
            false => Problem::MissingOperator {
                what: "an operator",
                left: l,
                right: r,
                span: right.span,
                label: "what is to be done with this?",
                way: Way::told("write an operator between them, or take one of them away"),
            },
        }
    }

    /// `1,5` and `1,000,000`.
    fn comma_in_number(&self, texts: &[&str], commas: &[Span], span: Span) -> Option<Problem> {
        let is_digit = |at: usize| self.text.as_bytes().get(at).is_some_and(u8::is_ascii_digit);
        let is_tight = |comma: &Span| is_digit(comma.start.wrapping_sub(1)) && is_digit(comma.end);
        let tight = commas.iter().all(is_tight);
        let first = *commas.first()?;
        let (head, rest) = texts.split_first()?;
        let thousands = rest
            .iter()
            .all(|part| part.len() == 3 && part.bytes().all(|b| b.is_ascii_digit()));
        let is_whole = self.words.is_whole(self.within.kind, self.within.field);
        if !tight {
            return None;
        }
        if thousands && head.trim_start_matches('-').len() <= 3 && (rest.len() > 1 || is_whole) {
            return Some(Problem::DecimalComma {
                message: "no commas stand in a number",
                span: first,
                way: Way::replace(span, texts.join("_")),
            });
        }
        match rest {
            [part]
                if numeric_part(part) == *part
                    && !part.contains(['.', 'e', 'E'])
                    && !head.contains('.') =>
            {
                let number = format!("{head}.{part}");
                Some(Problem::DecimalComma {
                    message: "a decimal point is written `.`, not `,`",
                    span: first,
                    way: Way::replace(span, number),
                })
            }
            _ => None,
        }
    }
}

/// What a list is: of which it depends how many values it has.
#[derive(Clone, Copy)]
struct Shape<'s> {
    /// What its values are, if that is known.
    parts: Option<Type>,
    /// What it is as a whole, if that is known.
    takes: Option<Type>,
    /// The function that it is the arguments of.
    function: Option<&'s str>,
}

/// A product without its sign.
fn missing_operator(left: String, right: String, gap: Span, span: Span) -> Problem {
    let help = format!("write `{left} * {right}`");
    let mut way = Way::write(help, [Edit::new(gap, " * ")]);
    way.note = " to multiply them";
    Problem::MissingOperator {
        what: "an operator",
        left,
        right,
        span,
        label: "what is to be done with this?",
        way,
    }
}

/// What stands between quotation marks.
pub(super) fn unquoted(written: &str) -> &str {
    let marks = ['"', '\'', '“', '”', '„', '‘', '’', '«', '»'];
    written.trim_matches(marks).trim()
}

/// Whether a text is a name.
pub(super) fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}
