//! The parser: from pest's pairs to the tree.
//!
//! In: a source. Out: its tree, comments and problems. The functions that build nodes carry the names of the grammar's
//! rules, one each; what a slip is called and what the junk rules ate is explained in `junk`.
//!
//! Spans are taken from tokens: pest's own span of a rule may end after the white space behind it. Only byte offsets are
//! used (a line and a column from pest would take a walk over the text each).

use std::{borrow::Cow, collections::BTreeMap, ops::Range, thread};

use pest::{Parser as _, iterators::Pair};

use super::{
    Parsed, Problem,
    comments::{self, Deep, Start, Walk},
    grammar::{Grammar, Rule},
    junk,
    tree::{
        Block, Definition, Element, Field, Item, Name, Operator, Step, Tree, Unit, Value, ValueKind,
    },
};
use crate::{
    diagnostic::Diagnostic,
    source::{Source, SourceId, Span},
};

/// The stack that pest gets: it takes some ten kilobytes for each level of nesting without optimization.
const STACK: usize = 64 << 20;

/// Parses a file.
pub fn parse(source: &Source, id: SourceId) -> Parsed<'_> {
    with_stack(|| {
        let start = source.bom_len();
        let (mut parser, walk) = Parser::new(source.text(), id, start..source.text().len());
        parser.file();
        parser.finish(walk)
    })
}

/// Parses the part of a text from an offset on as one value: a `--set` argument's. The tree has one item, a definition
/// without a name.
pub fn parse_value(source: &Source, id: SourceId, start: usize) -> (Value<'_>, Vec<Problem>) {
    with_stack(|| {
        let (mut parser, walk) = Parser::new(source.text(), id, start..source.text().len());
        let value = parser.whole_value();
        (value, parser.finish(walk).problems)
    })
}

/// Runs on a thread with a stack of known size, so that the nesting limit holds in every build and on every thread.
fn with_stack<T: Send>(work: impl Fn() -> T + Sync) -> T {
    thread::scope(|scope| {
        let builder = thread::Builder::new().stack_size(STACK);
        match builder
            .spawn_scoped(scope, &work)
            .map(|handle| handle.join())
        {
            Ok(Ok(result)) => result,
            Ok(Err(panic)) => std::panic::resume_unwind(panic),
            // No thread to be had: the caller's stack holds the limit in an optimized build.
            Err(_) => work(),
        }
    })
}

struct Parser<'s> {
    id: SourceId,
    /// The text as it was written.
    text: &'s str,
    /// The text as pest reads it: values that nest too deep are a 0 and blanks there.
    read: Cow<'s, str>,
    /// Where the piece that pest is reading starts: its offsets count from there.
    base: usize,
    /// Where the text ends.
    end: usize,
    deep: Vec<Deep>,
    items: Vec<Item<'s>>,
    problems: Vec<Problem>,
    /// Whether the last item was lines without meaning.
    in_odd_lines: bool,
    /// Blocks without their `}` that another block followed at once.
    nesting: usize,
}

type Pairs<'p> = Pair<'p, Rule>;

impl<'s> Parser<'s> {
    fn new(text: &'s str, id: SourceId, part: Range<usize>) -> (Self, Walk) {
        let start = match id {
            SourceId::File => Start::Items,
            SourceId::Set(_) => Start::Value,
        };
        let mut walk = comments::walk(text.get(part.clone()).unwrap_or_default(), start);
        walk.shift(part.start);
        let parser = Self {
            id,
            text,
            read: without_odd_spaces(without_deep(text, &walk.deep), &walk.odd_spaces),
            base: part.start,
            end: part.end,
            deep: std::mem::take(&mut walk.deep),
            items: Vec::new(),
            problems: Vec::new(),
            in_odd_lines: false,
            nesting: 0,
        };
        (parser, walk)
    }

    fn finish(mut self, walk: Walk) -> Parsed<'s> {
        for deep in &self.deep {
            let span = Span::new(self.id, deep.at, deep.at + 1);
            self.problems.push(Problem::TooDeep { span });
        }
        self.odd_spaces(&walk.odd_spaces);
        let cut = walk.comments.last().filter(|_| walk.unclosed);
        let cut = cut.map(|comment| comment.start);
        if let Some(start) = cut {
            // What the comment took is no second mistake.
            self.problems
                .retain(|problem| starts_before(problem, start));
            let span = Span::new(self.id, start, start + 2);
            self.problems.push(Problem::UnclosedComment { span });
        }
        let comments = walk.comments.into_iter();
        Parsed {
            tree: Tree { items: self.items },
            comments: comments
                .map(|range| Span::new(self.id, range.start, range.end))
                .collect(),
            problems: self.problems,
            cut,
        }
    }

    /// One report for each sort of character, at the first one.
    fn odd_spaces(&mut self, places: &[Range<usize>]) {
        let mut sorts: BTreeMap<&str, (Span, usize)> = BTreeMap::new();
        for place in places {
            let span = Span::new(self.id, place.start, place.end);
            let (_, count) = sorts.entry(self.written(span)).or_insert((span, 0));
            *count += 1;
        }
        for (text, (span, count)) in sorts {
            self.problems.push(Problem::OddSpace {
                what: junk::name_of_space(text),
                more: count - 1,
                span,
            });
        }
    }

    fn file(&mut self) {
        let read = std::mem::take(&mut self.read);
        while self.base < self.end {
            let rest = read.get(self.base..).unwrap_or_default();
            let next = Grammar::parse(Rule::next, rest).ok();
            let Some(pair) = next.and_then(|mut pairs| pairs.next()) else {
                // The junk rules take everything but white space; nothing comes here.
                break;
            };
            let length = pair.as_span().end();
            match pair.as_rule() {
                Rule::definition => {
                    let definition = self.definition(pair);
                    self.items.push(Item::Definition(definition));
                }
                Rule::block => {
                    let block = self.block(pair);
                    self.items.push(Item::Block(block));
                }
                Rule::bad_definition => self.bad_definition(pair),
                Rule::stray_close => self.stray_close(pair),
                Rule::bad_item => self.bad_item(pair),
                _ => break,
            }
            if matches!(self.items.last(), Some(Item::Definition(_))) {
                self.nesting = 0;
            }
            self.in_odd_lines &= matches!(self.items.last(), Some(Item::Bad(_)));
            if length == 0 {
                break;
            }
            self.base += length;
        }
    }

    fn whole_value(&mut self) -> Value<'s> {
        let read = std::mem::take(&mut self.read);
        let rest = read.get(self.base..).unwrap_or_default();
        if let Ok(mut pairs) = Grammar::parse(Rule::whole_value, rest)
            && let Some(pair) = pairs.next()
        {
            return self.value(pair);
        }
        let span = self.trimmed(self.base, self.end);
        let problem = match span.range().is_empty() {
            true => Problem::SetWithoutValue {
                span: Span::new(self.id, self.base.saturating_sub(1), self.base),
            },
            false => junk::value(self.text, span),
        };
        self.problems.push(problem);
        bad(span)
    }

    fn definition(&mut self, pair: Pairs<'_>) -> Definition<'s> {
        let mut definition = Definition {
            keyword: self.span(&pair),
            name: None,
            equals: None,
            value: bad(self.span(&pair)),
            span: self.span(&pair),
        };
        let mut separator = None;
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::let_word => definition.keyword = span,
                Rule::name => definition.name = Some(self.name(&part)),
                Rule::equals => definition.equals = Some(span),
                Rule::value => definition.value = self.value(part),
                Rule::separator => separator = Some(self.tight(span)),
                _ => {}
            }
        }
        definition.span = definition.keyword.to(definition.value.span);
        let wrong = match definition.equals {
            None => Some(definition.value.span),
            Some(equals) if self.written(equals) == ":" => Some(equals),
            Some(_) => None,
        };
        if let (Some(span), Some(name)) = (wrong, definition.name) {
            self.problems.push(Problem::MissingEquals {
                name: name.text.to_owned(),
                value: self.short(definition.value.span),
                span,
            });
        }
        self.needless_separator(separator, "items");
        definition
    }

    fn block(&mut self, pair: Pairs<'_>) -> Block<'s> {
        let whole = self.span(&pair);
        let mut block = Block {
            kind: None,
            name: None,
            open: None,
            fields: Vec::new(),
            bad: Vec::new(),
            close: None,
            span: whole,
        };
        self.defined_block(&mut block);
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::let_word => self.problems.push(Problem::BadName {
                    written: "let".to_owned(),
                    span,
                }),
                Rule::name if block.kind.is_none() => block.kind = Some(self.name(&part)),
                Rule::name => block.name = Some(self.name(&part)),
                _ => self.body(part, span, &mut block),
            }
        }
        self.close_block(&mut block);
        self.kind_of_the_next_line(&mut block);
        block
    }

    /// `let Ball = sphere {`: what was meant is a block with a name.
    fn defined_block(&mut self, block: &mut Block<'s>) {
        let (Some(Item::Definition(before)), Some(Problem::MissingValue { span, .. })) =
            (self.items.last(), self.problems.last())
        else {
            return;
        };
        let between = self.text.get(span.end..block.span.start);
        let same_line = between.is_some_and(|text| !text.contains('\n'));
        if let Some(name) = before.name
            && same_line
            && self.written(*span).ends_with('=')
        {
            let kind = self.word_at(block.span.start);
            let problem = Problem::BadHead {
                help: format!("write `{} {} {{`", self.short(kind), self.short(name.span)),
                span: before.keyword.to(*span),
            };
            self.problems.pop();
            self.problems.push(problem);
            block.name = Some(name);
        }
    }

    /// `let a = 2 pi`, and `sphere {` in the next line: the kind is the rest of the value, and the name the kind.
    fn kind_of_the_next_line(&mut self, block: &mut Block<'s>) {
        let (Some(Item::Definition(before)), Some(kind), Some(name)) =
            (self.items.last(), block.kind, block.name)
        else {
            return;
        };
        let value = before.value.span;
        let apart = |from, to| self.text.get(from..to).unwrap_or_default().contains('\n');
        if !apart(value.end, kind.span.start) && apart(kind.span.end, name.span.start) {
            let problem = junk::missing_operator(self.written(value), kind.text, kind.span);
            self.problems.push(problem);
            block.kind = Some(name);
            block.name = None;
            block.span.start = name.span.start;
        }
    }

    /// One part of a body.
    fn body(&mut self, part: Pairs<'_>, span: Span, block: &mut Block<'s>) {
        match part.as_rule() {
            Rule::open => block.open = Some(span),
            Rule::close => block.close = Some(span),
            Rule::field => {
                let field = self.field(part);
                block.fields.push(field);
            }
            Rule::lets_in_block => self.lets_in_block(part),
            Rule::bad_field => self.bad_field(part, block),
            _ => {}
        }
    }

    fn close_block(&mut self, block: &mut Block<'s>) {
        let (Some(open), None) = (block.open, block.close) else {
            if let Some(close) = block.close {
                block.span = block.span.to(close);
            }
            return;
        };
        let next = block.span.end;
        let before = (next < self.end).then(|| self.word_at(next));
        block.span = self.trimmed(block.span.start, next);
        let again = match self.items.last() {
            Some(Item::Block(last)) => last.close.is_none() && last.fields.is_empty(),
            _ => false,
        };
        if again && block.fields.is_empty() {
            // One block after the other that is only begun is one mistake.
            return;
        }
        let followed = before.is_some_and(|before| !matches!(self.written(before), "let" | "}"));
        self.nesting += usize::from(followed);
        let kind = block.kind.map_or("this block", |kind| kind.text);
        self.problems.push(Problem::UnclosedBlock {
            kind: kind.to_owned(),
            open,
            before,
        });
    }

    fn field(&mut self, pair: Pairs<'_>) -> Field<'s> {
        let whole = self.span(&pair);
        let (mut name, mut value) = (None, bad(whole));
        let (mut equals, mut separator) = (None, None);
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::name => name = Some(self.name(&part)),
                Rule::equals => equals = Some(span),
                Rule::value => value = self.value(part),
                Rule::separator => separator = Some(self.tight(span)),
                _ => {}
            }
        }
        let name = name.unwrap_or(Name {
            text: "",
            span: whole,
        });
        if let Some(span) = equals {
            self.problems.push(Problem::NeedlessEquals {
                sign: self.written(span).to_owned(),
                name: name.text.to_owned(),
                value: self.short(value.span),
                span,
            });
        }
        self.needless_separator(separator, "fields");
        Field {
            name,
            span: name.span.to(value.span),
            value,
        }
    }

    fn lets_in_block(&mut self, pair: Pairs<'_>) {
        let mut first = true;
        for part in pair.into_inner() {
            if first {
                let span = self.word_at(self.span(&part).start);
                self.problems.push(Problem::MisplacedLet { span });
                first = false;
            }
            match part.as_rule() {
                Rule::definition => {
                    let definition = self.definition(part);
                    self.items.push(Item::Definition(definition));
                }
                Rule::bad_definition => self.bad_definition(part),
                _ => {}
            }
        }
    }

    fn value(&mut self, pair: Pairs<'_>) -> Value<'s> {
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
            self.problems.push(junk::unknown_operator(written, span));
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
                        Some(arguments) => ValueKind::Call {
                            function: name,
                            arguments,
                            parentheses,
                        },
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
        let mut elements: Vec<Element<'s>> = Vec::new();
        let mut missing = None;
        let mut needless = None;
        for part in pair.into_inner() {
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
            ValueKind::Name(_) | ValueKind::Call { .. } | ValueKind::Parentheses(_)
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
            Problem::MissingComma {
                left: left_text,
                right: right_text,
                whole,
                span,
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

    fn bad_definition(&mut self, pair: Pairs<'_>) {
        let whole = self.span(&pair);
        let span = self.trimmed(whole.start, whole.end);
        let keyword = self.word_at(span.start);
        let (name, problem) = junk::definition(self.text, span);
        if let Problem::BadName { span, .. } = &problem {
            self.parts_of_bad_name(*span);
        }
        let again = match self.items.last() {
            Some(Item::Definition(last)) => {
                last.value.span.range().is_empty() && !last.keyword.range().is_empty()
            }
            _ => false,
        };
        // One definition after the other that is only begun is one mistake, on one line.
        if !(again && self.is_on_line_of_last(span.start)) {
            self.problems.push(problem);
        }
        let value = bad(Span::new(self.id, span.end, span.end));
        self.items.push(Item::Definition(Definition {
            keyword,
            name,
            equals: None,
            value,
            span,
        }));
    }

    /// `let my-x = 5`: where `my-x` is used, `my` and `x` are names that are known.
    fn parts_of_bad_name(&mut self, span: Span) {
        const ENOUGH: usize = 8;
        let mut at = span.start;
        for word in self.written(span).split('-').take(ENOUGH) {
            let place = Span::new(self.id, at, at + word.len());
            at = place.end + 1;
            let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
            if word.starts_with(|c: char| c.is_ascii_alphabetic()) && word.chars().all(letters) {
                self.items.push(Item::Definition(Definition {
                    keyword: Span::new(self.id, span.start, span.start),
                    name: Some(Name {
                        text: word,
                        span: place,
                    }),
                    equals: None,
                    value: bad(Span::new(self.id, span.end, span.end)),
                    span: place,
                }));
            }
        }
    }

    fn bad_field(&mut self, pair: Pairs<'_>, block: &mut Block<'s>) {
        let whole = self.span(&pair);
        let span = self.trimmed(whole.start, whole.end);
        match junk::field(self.text, span) {
            (
                Some(name),
                Some(Problem::MissingOperand {
                    side: "before",
                    span: operator,
                    ..
                }),
            ) if self
                .trimmed(name.span.end, operator.start)
                .range()
                .is_empty()
                && !block.fields.is_empty() =>
            {
                // `center middle ring * 2`: no field's name stands before an operator.
                let before = block.fields.last().map_or(span, |field| field.value.span);
                let problem = junk::missing_operator(self.written(before), name.text, name.span);
                self.problems.push(problem);
                block.bad.push(span);
            }
            (Some(name), problem) => {
                let after = self.text.get(name.span.end..span.end).unwrap_or_default();
                let kind = match matches!(after.trim(), "" | "=" | ":") {
                    true => ValueKind::Missing,
                    false => ValueKind::Bad,
                };
                let rest = self.text.get(whole.end..).unwrap_or_default();
                // Braces that follow are reported themselves.
                let braces = problem.is_none() && rest.trim_start().starts_with('{');
                if kind == ValueKind::Bad && !braces {
                    let unexpected = || junk::unexpected_value(self.text, span);
                    let problem = problem.unwrap_or_else(unexpected);
                    self.problems.push(problem);
                    block.bad.push(span);
                }
                let value = Value {
                    kind,
                    span: Span::new(self.id, name.span.end, span.end),
                };
                block.fields.push(Field { name, value, span });
            }
            (None, problem) => {
                let again = block
                    .bad
                    .last()
                    .is_some_and(|last| self.trimmed(last.end, span.start).range().is_empty());
                // What follows junk without a field between is the same mistake.
                if !again {
                    self.problems.extend(problem);
                }
                block.bad.push(span);
            }
        }
    }

    fn stray_close(&mut self, pair: Pairs<'_>) {
        let whole = self.span(&pair);
        let start = whole.start;
        let span = Span::new(self.id, start, start + 1);
        let braces = self.written(whole).matches('}').count();
        let closed = (0..braces).take_while(|_| self.nested()).count();
        if closed == braces {
            self.items.push(Item::Bad(span));
            return;
        }
        self.problems.push(Problem::StrayClosing {
            sign: "}".to_owned(),
            span,
            help: "take it away, or write the `{` that it is to close".to_owned(),
        });
        self.items.push(Item::Bad(span));
    }

    /// Whether a `}` closes a block that other blocks stand in: these are the mistake, and the block is closed.
    fn nested(&mut self) -> bool {
        if self.nesting == 0 {
            return false;
        }
        self.nesting -= 1;
        let unclosed = self
            .problems
            .iter_mut()
            .rfind(|problem| matches!(problem, Problem::UnclosedBlock { .. }));
        if let Some(problem) = unclosed
            && let Problem::UnclosedBlock {
                before: Some(before),
                ..
            } = problem
        {
            let rest = self.text.get(before.start..).unwrap_or_default();
            let brace = before.start + rest.find('{').unwrap_or(0);
            let span = Span::new(self.id, brace, brace + 1);
            *problem = Problem::NestedBraces { span };
        }
        true
    }

    fn bad_item(&mut self, pair: Pairs<'_>) {
        let whole = self.span(&pair);
        let mut block = Block {
            kind: None,
            name: None,
            open: None,
            fields: Vec::new(),
            bad: Vec::new(),
            close: None,
            span: whole,
        };
        let mut odd = Span::new(self.id, whole.start, whole.start);
        let at = self.problems.len();
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::odd_lines => odd = self.trimmed(span.start, span.end),
                _ => self.body(part, span, &mut block),
            }
        }
        let previous = self.items.last().and_then(|item| match item {
            Item::Definition(definition) => Some(definition.value.span),
            Item::Block(_) | Item::Bad(_) => None,
        });
        if let Some(open) = block.open {
            self.close_block(&mut block);
            let (kind, name, problem) = junk::head(self.text, odd, open);
            block.kind = kind;
            block.name = name;
            let again = match self.items.last() {
                Some(Item::Block(last)) => last.kind.is_none(),
                _ => false,
            };
            if !(again && kind.is_none() && self.is_on_line_of_last(whole.start)) {
                self.problems.insert(at, problem);
            }
            block.bad.push(odd);
            self.items.push(Item::Block(block));
        } else {
            if block.close.is_some() && self.nested() {
                self.items.push(Item::Bad(odd));
                return;
            }
            let problem = junk::lines(self.text, odd, block.close, previous);
            // Lines without meaning, one after the other, are one mistake.
            let vague = matches!(
                problem,
                Problem::OutsideBlock { .. } | Problem::Unexpected { .. }
            );
            // A name that was to be defined is known from here on.
            let item = match &problem {
                Problem::MissingLet { place, .. } => Item::Definition(Definition {
                    keyword: Span::new(self.id, odd.start, odd.start),
                    name: Some(Name {
                        text: self.written(*place),
                        span: *place,
                    }),
                    equals: None,
                    value: bad(Span::new(self.id, odd.end, odd.end)),
                    span: odd,
                }),
                _ => Item::Bad(odd),
            };
            if !(vague && self.in_odd_lines) {
                self.problems.insert(at, problem);
            }
            self.in_odd_lines = vague && block.close.is_none();
            self.items.push(item);
        }
    }

    /// Whether no line ends between the last item and an offset.
    fn is_on_line_of_last(&self, start: usize) -> bool {
        let end = self.items.last().map_or(start, |item| item.span().end);
        let between = self.text.get(end..start).unwrap_or_default();
        !between.contains('\n')
    }

    fn needless_separator(&mut self, separator: Option<Span>, between: &'static str) {
        if let Some(span) = separator {
            self.problems.push(Problem::NeedlessSeparator {
                sign: self.short(span),
                between,
                span,
            });
        }
    }

    fn name(&self, pair: &Pairs<'_>) -> Name<'s> {
        let span = self.span(pair);
        Name {
            text: self.written(span),
            span,
        }
    }

    fn span(&self, pair: &Pairs<'_>) -> Span {
        let span = pair.as_span();
        Span::new(self.id, self.base + span.start(), self.base + span.end())
    }

    fn written(&self, span: Span) -> &'s str {
        self.text.get(span.range()).unwrap_or_default()
    }

    /// What stands under a span, for a message.
    fn short(&self, span: Span) -> String {
        junk::shorten(self.written(span))
    }

    fn rest_of_value(&self, start: usize) -> String {
        let rest = self.text.get(start..).unwrap_or_default().trim_start();
        let end = rest.find(|c: char| c.is_whitespace() || "{}(),;".contains(c));
        junk::shorten(rest.get(..end.unwrap_or(rest.len())).unwrap_or_default())
    }

    /// The word or sign that stands at an offset.
    fn word_at(&self, start: usize) -> Span {
        let rest = self.text.get(start..).unwrap_or_default();
        let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
        let first = rest.chars().next().map_or(0, char::len_utf8);
        let length = rest.find(other).unwrap_or(rest.len()).max(first);
        Span::new(self.id, start, start + length)
    }

    /// The same span without white space and comments at its end.
    fn trimmed(&self, start: usize, end: usize) -> Span {
        let text = self.text.get(start..end).unwrap_or_default();
        Span::new(self.id, start, start + junk::written_length(text))
    }

    /// The same span without white space at its end.
    fn tight(&self, span: Span) -> Span {
        let length = self.written(span).trim_end().len();
        Span::new(self.id, span.start, span.start + length)
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

fn bad<'s>(span: Span) -> Value<'s> {
    Value {
        kind: ValueKind::Bad,
        span,
    }
}

/// The text with each value that nests too deep replaced by a 0 and blanks.
fn without_deep<'s>(text: &'s str, deep: &[Deep]) -> Cow<'s, str> {
    if deep.is_empty() {
        return Cow::Borrowed(text);
    }
    let mut read = String::with_capacity(text.len());
    for Deep { value, .. } in deep {
        read.push_str(text.get(read.len()..value.start).unwrap_or_default());
        read.push('0');
        let blanks = value.end.saturating_sub(read.len());
        read.extend(std::iter::repeat_n(' ', blanks));
    }
    read.push_str(text.get(read.len()..).unwrap_or_default());
    Cow::Owned(read)
}

/// The text with plain blanks for characters that cannot be seen.
fn without_odd_spaces<'s>(text: Cow<'s, str>, places: &[Range<usize>]) -> Cow<'s, str> {
    if places.is_empty() {
        return text;
    }
    let mut read = String::with_capacity(text.len());
    for place in places {
        read.push_str(text.get(read.len()..place.start).unwrap_or_default());
        read.extend(std::iter::repeat_n(' ', place.len()));
    }
    read.push_str(text.get(read.len()..).unwrap_or_default());
    Cow::Owned(read)
}

fn starts_before(problem: &Problem, offset: usize) -> bool {
    if matches!(problem, Problem::UnclosedBlock { .. }) {
        return false;
    }
    let diagnostic = Diagnostic::from_problem(problem);
    let first = diagnostic.labels.first();
    first.is_none_or(|label| label.span.end < offset)
}
