//! Values: operators, operands, and what stands between parentheses.

use super::{Pairs, Parser, bad};
use crate::{
    source::Span,
    syntax::{
        Problem,
        grammar::Rule,
        junk,
        tree::{Call, Element, Name, Operator, Step, Unit, Value, ValueKind},
    },
};

impl<'s> Parser<'s> {
    pub(super) fn value(&mut self, pair: Pairs<'_>) -> Value<'s> {
        let whole = self.span(&pair);
        let mut parts = Parts {
            pairs: pair.into_inner(),
            next: None,
            broken: false,
        };
        let mut value = self.chain(&mut parts, Precedence::Sum);
        if parts.broken {
            value.kind = ValueKind::Bad;
        }
        debug_assert!(whole.start <= value.span.start);
        value
    }

    fn chain(&mut self, parts: &mut Parts<'_>, precedence: Precedence) -> Value<'s> {
        let mut first = self.link(parts, precedence);
        let mut rest: Vec<Step<'s>> = Vec::new();
        while let Some((operator, sign)) = self.operator(parts, precedence) {
            let operand = self.link(parts, precedence);
            if matches!(self.written(sign), "**" | "^") {
                let before = rest.last();
                let base = before.map_or(&first, |step: &Step<'s>| &step.operand);
                let is_divisor = before.is_some_and(|step| step.operator == Operator::Divide);
                let power = junk::power(self.clean(), (base, sign, &operand), is_divisor);
                self.problems.push(power);
            }
            rest.push(Step {
                operator,
                sign,
                operand,
            });
        }
        match rest.last() {
            None => first,
            Some(last) => {
                let span = first.span.to(last.operand.span);
                first = Value {
                    kind: ValueKind::Chain {
                        first: Box::new(first),
                        rest,
                    },
                    span,
                };
                first
            }
        }
    }

    fn link(&mut self, parts: &mut Parts<'_>, precedence: Precedence) -> Value<'s> {
        match precedence {
            Precedence::Sum => self.chain(parts, Precedence::Product),
            Precedence::Product => self.signed(parts),
        }
    }

    /// The next operator, if it is of this precedence.
    fn operator(
        &mut self,
        parts: &mut Parts<'_>,
        precedence: Precedence,
    ) -> Option<(Operator, Span)> {
        let pair = parts.next()?;
        let span = self.span(&pair);
        let written = self.written(span);
        let operator = match written {
            "+" => Operator::Add,
            "-" | "−" => Operator::Subtract,
            "/" | "÷" => Operator::Divide,
            _ => Operator::Multiply,
        };
        let this = match operator {
            Operator::Add | Operator::Subtract => Precedence::Sum,
            Operator::Multiply | Operator::Divide => Precedence::Product,
        };
        if this != precedence {
            parts.next = Some(pair);
            return None;
        }
        if !matches!(written, "+" | "-" | "*" | "/") {
            parts.broken |= matches!(written, "**" | "^" | "%");
            // A power is reported when its exponent is read.
            if !matches!(written, "**" | "^") {
                self.problems.push(junk::unknown_operator(written, span));
            }
        }
        Some((operator, span))
    }

    fn signed(&mut self, parts: &mut Parts<'_>) -> Value<'s> {
        let mut signs: Vec<Span> = Vec::new();
        let mut operand = None;
        while let Some(pair) = parts.next() {
            let span = self.span(&pair);
            if pair.as_rule() != Rule::sign {
                operand = Some(self.operand(pair));
                break;
            }
            match self.written(span) {
                "-" => signs.push(span),
                "+" => {
                    let value = self.rest_of_value(span.end);
                    self.problems.push(Problem::PlusSign { value, span });
                }
                sign => {
                    self.problems.push(junk::unknown_operator(sign, span));
                    parts.broken = true;
                }
            }
        }
        let empty = || bad(Span::new(self.id, self.base, self.base));
        let operand = operand.unwrap_or_else(empty);
        signs
            .into_iter()
            .rev()
            .fold(operand, |operand, sign| Value {
                span: sign.to(operand.span),
                kind: ValueKind::Negation {
                    sign,
                    operand: Box::new(operand),
                },
            })
    }

    fn operand(&mut self, pair: Pairs<'_>) -> Value<'s> {
        let span = self.span(&pair);
        match pair.as_rule() {
            Rule::number => self.number(span),
            Rule::reference => self.reference(pair),
            Rule::group => self.group(pair, span),
            Rule::color_code => self.color_code(span),
            Rule::odd_number => {
                let problem = junk::odd_number(self.written(span), span);
                self.problems.push(problem);
                bad(span)
            }
            Rule::quoted => self.quoted(span),
            Rule::braces => {
                let span = self.tight(span);
                let inner = Span::new(self.id, span.start + 1, span.end.saturating_sub(1));
                let inner = self.short(inner);
                self.problems.push(Problem::Brackets { inner, span });
                bad(span)
            }
            Rule::brackets => self.brackets(pair, span),
            _ => bad(span),
        }
    }

    fn number(&mut self, span: Span) -> Value<'s> {
        if self.deep.iter().any(|deep| deep.value.start == span.start) {
            return bad(span);
        }
        let written = self.written(span);
        let units = [("deg", Unit::Degrees), ("rad", Unit::Radians)];
        let unit = units.into_iter().find_map(|(word, unit)| {
            let number = written.strip_suffix(word)?;
            Some((number, word, unit))
        });
        let kind = match unit {
            None => ValueKind::Number(written),
            Some((number, word, unit)) => {
                let tight = number.trim_end();
                if tight.len() < number.len() {
                    self.problems.push(Problem::SpacedUnit {
                        joined: format!("{tight}{word}"),
                        span,
                    });
                }
                ValueKind::Angle {
                    number: tight,
                    unit,
                }
            }
        };
        Value { kind, span }
    }

    fn reference(&mut self, pair: Pairs<'_>) -> Value<'s> {
        let mut name = Name {
            text: "",
            span: self.span(&pair),
        };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => name = self.name(&part),
                Rule::arguments => {
                    let parentheses = self.span(&part);
                    let span = name.span.to(parentheses);
                    let kind = match self.elements(part) {
                        Some(arguments) => ValueKind::Call(Box::new(Call {
                            function: name,
                            arguments,
                            parentheses,
                        })),
                        None => ValueKind::Bad,
                    };
                    return Value { kind, span };
                }
                _ => {}
            }
        }
        Value {
            kind: ValueKind::Name(name.text),
            span: name.span,
        }
    }

    fn group(&mut self, pair: Pairs<'_>, span: Span) -> Value<'s> {
        let Some(elements) = self.elements(pair) else {
            return bad(span);
        };
        let kind = match <[Element<'s>; 1]>::try_from(elements) {
            Ok([only]) => ValueKind::Parentheses(Box::new(only.value)),
            Err(elements) => ValueKind::Tuple(elements),
        };
        Value { kind, span }
    }

    fn brackets(&mut self, pair: Pairs<'_>, span: Span) -> Value<'s> {
        let inner = Span::new(self.id, span.start + 1, span.end.saturating_sub(1));
        self.problems.push(Problem::Brackets {
            inner: self.short(inner),
            span,
        });
        self.group(pair, span)
    }

    /// The values of a list, a comma between two; none if something was wrong that makes their number doubtful.
    fn elements(&mut self, pair: Pairs<'_>) -> Option<Vec<Element<'s>>> {
        let whole = self.span(&pair);
        let parts = pair.into_inner();
        // A comma between two values, as a rule.
        let mut elements: Vec<Element<'s>> = Vec::with_capacity(parts.len().div_ceil(2));
        let mut missing = None;
        let mut needless = None;
        for part in parts {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::comma => match elements.last_mut() {
                    Some(last) if last.comma.is_none() => last.comma = Some(span),
                    _ => needless = needless.or(Some((span, "no value stands before it"))),
                },
                Rule::value => {
                    let joined = elements.last().is_some_and(|last| last.comma.is_none());
                    if joined && missing.is_none() {
                        missing = Some(elements.len());
                    }
                    let value = self.value(part);
                    elements.push(Element { value, comma: None });
                }
                _ => {}
            }
        }
        if let Some(comma) = elements.last().and_then(|last| last.comma) {
            needless = needless.or(Some((comma, "no value follows it")));
        }
        if let Some((span, place)) = needless {
            self.problems.push(Problem::NeedlessComma { span, place });
        }
        if let Some(index) = missing {
            self.missing_comma(whole, &elements, index);
        }
        let doubtful = missing.is_some() || (needless.is_some() && elements.len() != 1);
        (!doubtful || elements.len() == 3).then_some(elements)
    }

    fn missing_comma(&mut self, whole: Span, elements: &[Element<'s>], index: usize) {
        let (Some(left), Some(right)) = (elements.get(index - 1), elements.get(index)) else {
            return;
        };
        let texts: Vec<String> = elements.iter().map(|e| self.short(e.value.span)).collect();
        let (left_text, right_text) = (self.short(left.value.span), self.short(right.value.span));
        let span = right.value.span;
        let number = matches!(left.value.kind, ValueKind::Number(_));
        let word = matches!(
            right.value.kind,
            ValueKind::Name(_) | ValueKind::Call(_) | ValueKind::Parentheses(_)
        );
        let problem = if number && word && elements.len() != 3 {
            junk::missing_operator(&left_text, &right_text, span)
        } else {
            let all = format!("({})", texts.join(", "));
            let function = self.text.get(..whole.start).unwrap_or_default();
            let function = function.rsplit(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            let function = function.into_iter().next().unwrap_or_default();
            let whole = match all.len() {
                0..=60 if self.written(whole).starts_with('(') => format!("{function}{all}"),
                _ => format!("{left_text}, {right_text}"),
            };
            let ends = elements.iter().zip(elements.iter().skip(1));
            let missing = ends.filter(|(before, _)| before.comma.is_none());
            let place = |end| Span::new(self.id, end, end);
            Problem::MissingComma {
                left: left_text,
                right: right_text,
                whole,
                span,
                places: missing.map(|(e, _)| place(e.value.span.end)).collect(),
            }
        };
        self.problems.push(problem);
    }

    fn color_code(&mut self, span: Span) -> Value<'s> {
        let written = self.written(span);
        let digits = written.strip_prefix('#').unwrap_or_default();
        let tight = digits.trim_start();
        let help = match tight.len() < digits.len() {
            true => format!("write `#{tight}`"),
            false => {
                "write three or six digits from 0 to 9 and a to f, such as `#fa0` or `#ffaa00`"
                    .to_owned()
            }
        };
        let label = match digits.chars().find(|digit| !digit.is_ascii_hexdigit()) {
            Some(' ' | '\t') => "no space stands behind the `#`".to_owned(),
            Some(other) => format!("`{other}` is no hexadecimal digit"),
            None if matches!(digits.len(), 3 | 6) => {
                return Value {
                    kind: ValueKind::ColorCode(written),
                    span,
                };
            }
            None if digits.is_empty() => "no digits".to_owned(),
            None if digits.len() == 1 => "1 digit".to_owned(),
            None => format!("{} digits", digits.len()),
        };
        self.problems.push(Problem::BadColorCode {
            written: self.short(span),
            help,
            span,
            label,
        });
        bad(span)
    }

    fn quoted(&mut self, span: Span) -> Value<'s> {
        let inner = self.written(span).trim_matches(['"', '\'']).trim();
        let is_name = inner.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && inner.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        self.problems.push(Problem::Quoted {
            what: if is_name { "a name" } else { "a value" },
            inner: junk::shorten(inner),
            span,
        });
        let kind = if is_name {
            ValueKind::Name(inner)
        } else {
            ValueKind::Bad
        };
        Value { kind, span }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Precedence {
    Sum,
    Product,
}

/// The signs, operands and operators of a value, with one that was taken back.
struct Parts<'p> {
    pairs: pest::iterators::Pairs<'p, Rule>,
    next: Option<Pairs<'p>>,
    /// An operator that does not exist makes the whole value unknown.
    broken: bool,
}

impl<'p> Parts<'p> {
    fn next(&mut self) -> Option<Pairs<'p>> {
        let next = self.next.take().or_else(|| self.pairs.next());
        next.filter(|pair| pair.as_rule() != Rule::EOI)
    }
}
