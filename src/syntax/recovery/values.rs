//! Reads values: operators and operands.

use super::{
    Context, Recovery,
    adjacent::{are_names, is_same_in_parentheses},
    example,
    foreign::{self, CommentPosition},
    is_name, unquoted,
};
use crate::{
    diagnostic::{Edit, Fix},
    schema::Type,
    source::Span,
    syntax::{
        NESTING_LIMIT, messages as say,
        problem::{replace, shorten},
        tokens::{TokenKind, is_color_code},
        tree::{Operator, Value, ValueKind, bad, chain, negation},
    },
};

/// Operators with the precedence of `*`, and characters that people write in their place.
const PRODUCT: &[&str] = &["*", "/", "×", "·", "∗", "⋅", "÷", "∕", "⁄", "^", "**", "%"];
/// Operators with the precedence of `+`, and characters that people write in their place.
const SUM: &[&str] = &["+", "-", "−", "–", "—"];

impl<'s> Recovery<'_, 's> {
    /// Reads the value of a field, a definition or a `--set` argument. Reports any other text in
    /// its place and returns a value marked as bad.
    pub(super) fn value(&mut self) -> Value<'s> {
        let start = self.here();
        let (values, commas) = self.values();
        if self.too_deep {
            return bad(start.to(self.behind()));
        }
        if values.len() > 1 && self.is_stray_closing() {
            return self.unopened_list(start, &values, commas);
        }
        let value = self.adjacent_values(values, commas);
        self.stray_closings(start.start, value)
    }

    /// Reads values until the next token cannot continue a list of values. Returns the values and
    /// the number of commas between them.
    fn values(&mut self) -> (Vec<Value<'s>>, usize) {
        let (mut values, mut commas) = (Vec::new(), 0);
        self.too_deep = false;
        self.comments(CommentPosition::Value);
        loop {
            let at = self.last_end;
            let is_method = self.context.takes == Some(Type::Method);
            values.push(if is_method && self.is_name(0) && !self.is(1, "(") {
                self.hyphenated()
            } else {
                self.expression()
            });
            if self.too_deep || self.last_end == at {
                return (values, commas);
            }
            self.comments(CommentPosition::Operator);
            if self.is(0, ",") && self.goes_on_behind_comma() {
                self.bump();
                commas += 1;
            } else if !self.goes_on(&values) {
                return (values, commas);
            }
        }
    }

    /// Reports a list that lacks its `(`; its `)` is the next token. Returns a value marked as bad.
    fn unopened_list(&mut self, start: Span, values: &[Value<'s>], commas: usize) -> Value<'s> {
        let (sign, span) = (self.word(0), self.bump());
        let parts = self.context.takes.and_then(Type::parts);
        let is_list = parts.is_some_and(|(_, count)| count == values.len());
        let is_list = is_list && commas + 1 == values.len();
        let Context { kind, field, .. } = self.context;
        let is_positive = self.words.is_positive(kind, field);
        let is_sure = values.iter().all(|value| match &value.kind {
            ValueKind::Name(name) => self.words.is_value(name),
            ValueKind::Negation { .. } if is_positive => false,
            _ => self.is_number(value),
        });
        let fix = (is_list && is_sure && sign == ")").then(|| {
            let title = format!("write `({})`", self.list_of(values));
            Fix::new(title, [Edit::insert(self.id, start.start, "(")])
        });
        self.report(&say::STRAY_CLOSING, span, &[sign], fix);
        self.operations(bad(start.to(span)));
        bad(start.to(self.behind()))
    }

    /// Reports closing brackets after a value that starts at offset `start`, and reads the
    /// operators that follow each of them.
    fn stray_closings(&mut self, start: usize, mut value: Value<'s>) -> Value<'s> {
        while self.is_stray_closing() {
            let is_needless = is_same_in_parentheses(&value);
            let is_call = self.unopened_call(start);
            if !is_call {
                self.stray_parenthesis(is_needless);
            }
            if is_call || !is_needless {
                value = bad(value.span);
            }
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

    fn is_stray_closing(&mut self) -> bool {
        let word = self.word(0);
        // A bracket in place of the block's `}` is not reported here, because `body` reports it
        // when the block ends.
        let is_end = |this: &mut Self| this.context.is_block && this.is_end_of_block();
        matches!(word, ")" | "]") && word != self.context.close && !is_end(self)
    }

    /// Returns whether the next token continues a list, whose values so far are `values`, rather
    /// than ending it.
    pub(super) fn goes_on(&mut self, values: &[Value<'s>]) -> bool {
        let (word, next, is_new) = (self.word(0), self.word(1), self.is_on_new_line(0));
        match self.kind(0) {
            _ if is_new && !self.context.is_block => false,
            TokenKind::Name => {
                // Two words may together be the name of one colour or method, as in `dark red`.
                let is_words = matches!(self.context.takes, Some(Type::Color | Type::Method))
                    && are_names(values)
                    && (!self.starts_value(1) || self.is_field_name(next));
                !is_new
                    && word != "let"
                    && !self.is_field_name(word)
                    && !self.starts_block()
                    && (is_words || self.words.is_value(word))
            }
            TokenKind::Number | TokenKind::Quoted | TokenKind::Color => true,
            TokenKind::Sign => matches!(word, "(" | "[" | "<"),
            _ => false,
        }
    }

    /// Returns whether the next token, a comma, separates values rather than fields.
    fn goes_on_behind_comma(&mut self) -> bool {
        let word = self.word(1);
        matches!(self.kind(1), TokenKind::Number | TokenKind::Color)
            || matches!(word, "-" | "(")
            || (self.is_name(1) && self.words.is_value(word))
            || (self.is_name(1) && matches!(self.word(2), "," | ")"))
    }

    /// Reads a name with hyphens, such as `multi-jittered`. No spaces, comments or line ends may
    /// stand around the hyphens.
    fn hyphenated(&mut self) -> Value<'s> {
        let mut span = self.bump();
        while self.is(0, "-") && self.is_name(1) && self.is_adjacent(0) && self.is_adjacent(1) {
            self.bump();
            span = span.to(self.bump());
        }
        let kind = ValueKind::Name(self.written(span));
        Value { kind, span }
    }

    // The methods below read operators.

    /// Reads a value with its operators.
    pub(super) fn expression(&mut self) -> Value<'s> {
        let first = self.signed();
        self.operations(first)
    }

    pub(super) fn operations(&mut self, left: Value<'s>) -> Value<'s> {
        let left = self.chain(left, PRODUCT, Self::signed);
        let left = self.chain(left, SUM, |this| {
            let first = this.signed();
            this.chain(first, PRODUCT, Self::signed)
        });
        // A comparison starts a condition such as `a > b ? c : d`. A condition that starts with
        // `if` is handled in `operand`.
        let compares = matches!(self.word(0), ">" | "<" | "!" | "&" | "|" | "?" | "=");
        if compares && !self.is_on_new_line(0) && self.condition() {
            return bad(left.span.to(self.behind()));
        }
        left
    }

    /// Reads the operators after `left` that are in `signs`, and their right operands. Returns the
    /// value of the whole chain.
    fn chain(
        &mut self,
        mut left: Value<'s>,
        signs: &[&str],
        operand: fn(&mut Self) -> Value<'s>,
    ) -> Value<'s> {
        loop {
            self.comments(CommentPosition::Operator);
            let written = self.word(0);
            if self.too_deep || !signs.contains(&written) {
                return left;
            }
            let sign = self.bump();
            self.comments(CommentPosition::Value);
            if PRODUCT.contains(&self.word(0)) {
                self.report(&say::MISSING_OPERAND, sign, &["after", written], None);
                left = bad(left.span.to(self.passed_operators()));
            } else if self.ends_value() {
                left = self.without_operand(left, written, sign);
            } else {
                let right = operand(self);
                left = self.operation(left, written, sign, right);
            }
        }
    }

    fn operation(
        &mut self,
        left: Value<'s>,
        written: &str,
        sign: Span,
        right: Value<'s>,
    ) -> Value<'s> {
        let Some(operator) = Operator::of(written) else {
            let meant = ["−-", "–-", "—-", "×*", "·*", "∗*", "⋅*", "÷/", "∕/", "⁄/"].into_iter();
            let meant = meant.filter_map(|row| row.strip_prefix(written)).next();
            let fix = meant.map(|meant| replace(sign, meant));
            let fix = fix.or_else(|| self.power(written, &left, &right));
            let is_between = right.kind != ValueKind::Bad;
            self.unknown_operator(written, sign, is_between, fix);
            return bad(left.span.to(right.span));
        };
        chain(left, operator, sign, right)
    }

    /// Returns the fix that writes `r^2` or `r**2` as the product `r * r`. Returns `None` unless
    /// the base is a number or a name and the exponent is 2.
    fn power(&self, sign: &str, base: &Value<'s>, exponent: &Value<'s>) -> Option<Fix> {
        let is_square = matches!(sign, "^" | "**") && exponent.kind == ValueKind::Number("2");
        let is_one = matches!(base.kind, ValueKind::Number(_) | ValueKind::Name(_));
        let factor = self.written(base.span);
        let product = format!("{factor} * {factor}");
        (is_square && is_one).then(|| replace(base.span.to(exponent.span), product))
    }

    fn unknown_operator(&mut self, written: &str, span: Span, is_between: bool, fix: Option<Fix>) {
        let help = match written {
            "%" if is_between => foreign::TURNS,
            "%" => "write the number itself, such as `0.5`",
            _ => "write a product, such as `a * a`, or `sqrt(a)`",
        };
        let said = say::UNKNOWN_OPERATOR.safe_if(!matches!(written, "^" | "**"));
        self.report(&said, span, &[written, help], fix);
    }

    /// Reports an operator that lacks its right operand, and returns a value marked as bad.
    fn without_operand(&mut self, left: Value<'s>, written: &str, sign: Span) -> Value<'s> {
        if written == "%" {
            self.unknown_operator(written, sign, false, None);
        } else {
            self.report(&say::MISSING_OPERAND, sign, &["after", written], None);
        }
        bad(left.span.to(sign))
    }

    /// Skips operators that lack a left operand, and the value after them. Returns the empty span
    /// where reading stopped.
    fn passed_operators(&mut self) -> Span {
        while PRODUCT.contains(&self.word(0)) {
            self.bump();
        }
        if !self.ends_value() {
            let problems_before = self.problems.len();
            self.signed();
            self.problems.truncate(problems_before);
        }
        self.behind()
    }

    /// Returns whether no value can start at the next token, because the token is a closing bracket
    /// or a separator, names a field, or starts an item.
    pub(super) fn ends_value(&mut self) -> bool {
        let word = self.word(0);
        match self.kind(0) {
            TokenKind::End => true,
            TokenKind::Name => {
                word == "let"
                    || (self.is_field_name(word) && !self.words.is_value(word))
                    || (self.is_on_new_line(0) && self.is_head(0))
                    || self.starts_item()
            }
            _ if word == "{" => !self.is_flat_list(),
            _ => matches!(word, "}" | ")" | "]" | "," | ";" | "="),
        }
    }

    pub(super) fn signed(&mut self) -> Value<'s> {
        self.comments(CommentPosition::Value);
        let written = self.word(0);
        if !SUM.contains(&written) {
            return self.operand();
        }
        if self.depth >= self.limit {
            return self.pass_over();
        }
        let (sign, problems_before) = (self.bump(), self.problems.len());
        self.depth += 1;
        let operand = self.signed();
        self.depth -= 1;
        if written == "+" {
            if self.problems.len() == problems_before {
                let edit = Edit::new(Span::new(self.id, sign.start, operand.span.start), "");
                let fix = Fix::new(format!("write `{}`", self.short(operand.span)), [edit]);
                self.report(&say::PLUS_SIGN, sign, &[], fix);
            }
            return operand;
        }
        if written != "-" {
            self.unknown_operator(written, sign, false, Some(replace(sign, "-")));
        }
        match operand.kind {
            ValueKind::Bad => bad(sign.to(operand.span)),
            _ => negation(sign, operand),
        }
    }

    // The methods below read operands.

    fn operand(&mut self) -> Value<'s> {
        let word = self.word(0);
        match (self.kind(0), word) {
            (TokenKind::Number, _) => self.number(),
            (TokenKind::Name, "if") if self.condition() => bad(self.behind()),
            (TokenKind::Name, _) if !self.ends_value() => self.reference(),
            (TokenKind::Color, _) | (_, "#") => self.color(),
            (TokenKind::Quoted, _) => self.quoted(),
            (_, "(") => self.group(")"),
            (_, "[") => self.group("]"),
            (_, "<") => self.group(">"),
            (_, "{") if self.is_flat_list() => self.group("}"),
            _ if PRODUCT.contains(&word) => {
                let sign = self.here();
                self.report(&say::MISSING_OPERAND, sign, &["before", word], None);
                bad(sign.to(self.passed_operators()))
            }
            _ => {
                let start = self.behind();
                self.unexpected("a value", example(self.context.takes));
                // The groups of a LaTeX command, as in `\frac{1}{2}`, are skipped, so that the
                // whole command is reported as one mistake.
                if word == "\\" {
                    self.bump();
                    self.bump();
                    while self.is(0, "{") && self.is_adjacent(0) {
                        self.bump();
                        self.skip_block();
                    }
                } else if self.lists == 0 {
                    self.resync();
                } else if !self.ends_value() {
                    self.bump();
                }
                bad(start.to(self.behind()))
            }
        }
    }

    /// Returns whether a value can start at the token `ahead` tokens after the next one.
    pub(super) fn starts_value(&mut self, ahead: usize) -> bool {
        match self.kind(ahead) {
            TokenKind::Number | TokenKind::Color | TokenKind::Quoted | TokenKind::Word => true,
            TokenKind::Name => !self.is(ahead, "let"),
            TokenKind::Sign => matches!(
                self.word(ahead),
                "(" | "[" | "<" | "-" | "+" | "−" | "–" | "—"
            ),
            _ => false,
        }
    }

    fn color(&mut self) -> Value<'s> {
        let sign = self.word(0);
        let mut span = self.bump();
        let digits = sign.trim_start_matches('#');
        if is_color_code(digits) {
            let kind = ValueKind::ColorCode(sign);
            return Value { kind, span };
        }
        let next = self.word(0);
        let is_named = self.words.is_color(next);
        let is_apart = digits.is_empty() && !self.is_on_new_line(0);
        let (label, fix) = if is_apart && (is_named || is_color_code(next)) {
            span = span.to(self.bump());
            let mark = if is_named { "" } else { "#" };
            let label = "a `#` stands right before digits, and before no name".to_owned();
            (label, Some(replace(span, format!("{mark}{next}"))))
        } else {
            match digits.chars().find(|digit| !digit.is_ascii_hexdigit()) {
                Some(other) => (format!("`{other}` is no hexadecimal digit"), None),
                None => (format!("{} digits", digits.len()), None),
            }
        };
        let words = [&*self.short(span), &label];
        self.report(&say::BAD_COLOR_CODE, span, &words, fix);
        bad(span)
    }

    fn quoted(&mut self) -> Value<'s> {
        let span = self.bump();
        let inner = unquoted(self.written(span));
        let is_code = inner.strip_prefix('#').is_some_and(is_color_code);
        let fix = (is_name(inner) || is_code).then(|| replace(span, inner));
        self.report(&say::QUOTED, span, &[&shorten(inner)], fix);
        bad(span)
    }

    /// Reports a value that nests deeper than [`NESTING_LIMIT`], and skips the rest of it.
    pub(super) fn pass_over(&mut self) -> Value<'s> {
        let first = self.here();
        self.report(&say::TOO_DEEP, first, &[&NESTING_LIMIT.to_string()], None);
        self.too_deep = true;
        self.has_passed_over = true;
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
}
