//! The syntax tree.
//!
//! The tree records what was written and where, but not what it means. In a text without mistakes,
//! every token lies in the span of a node, so the formatter can rebuild the text from the tree and
//! the comments. A `Bad` node stands for text that could not be understood and was reported.

use crate::{math::Angle, source::Span};

/// The tree of a whole file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tree<'s> {
    /// The items in their order.
    pub items: Vec<Item<'s>>,
}

/// An item of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Item<'s> {
    /// A definition: `let NAME = VALUE`.
    Definition(Definition<'s>),
    /// A block: `KIND NAME? { FIELD VALUE … }`.
    Block(Block<'s>),
    /// Text that is neither a definition nor a block; a problem was reported.
    Bad(Span),
}

impl Item<'_> {
    /// Returns the span of the whole item.
    pub fn span(&self) -> Span {
        match self {
            Self::Definition(definition) => definition.span,
            Self::Block(block) => block.span,
            Self::Bad(span) => *span,
        }
    }
}

/// A name and its place in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name<'s> {
    /// The name's text.
    pub text: &'s str,
    /// The name's place in the text.
    pub span: Span,
}

/// A definition: `let NAME = VALUE`.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition<'s> {
    /// The place of `let`.
    pub keyword: Span,
    /// The name that is defined; `None` if it is missing.
    pub name: Option<Name<'s>>,
    /// The place of `=`; `None` if it is missing.
    pub equals: Option<Span>,
    /// The value that the name gets.
    pub value: Value<'s>,
    /// The whole definition, from `let` to the value's end.
    pub span: Span,
}

impl Definition<'_> {
    /// Makes a definition that has only its keyword `let` so far.
    pub fn begun(keyword: Span) -> Self {
        Self {
            keyword,
            name: None,
            equals: None,
            value: bad(keyword),
            span: keyword,
        }
    }
}

/// A block: `KIND NAME? { FIELD VALUE … }`, or with indices
/// `KIND NAME? for INDEX < COUNT, … { FIELD VALUE … }`. The part before the `{` is its head.
#[derive(Clone, Debug, PartialEq)]
pub struct Block<'s> {
    /// The kind; `None` if it is missing.
    pub kind: Option<Name<'s>>,
    /// The name of the object, if it has one.
    pub name: Option<Name<'s>>,
    /// The indices of a repeated object. Few blocks have indices, so they are boxed to keep the
    /// other blocks small.
    pub repetition: Option<Box<Repetition<'s>>>,
    /// The place of `{`; `None` if it is missing.
    pub open: Option<Span>,
    /// The fields, in the order of the text.
    pub fields: Vec<Field<'s>>,
    /// Spans of text in the block that could not be read as fields. A problem was reported for
    /// each.
    pub bad: Vec<Span>,
    /// The place of `}`; `None` if it is missing.
    pub close: Option<Span>,
    /// The whole block.
    pub span: Span,
}

impl<'s> Block<'s> {
    /// Makes a block that has only its kind, its name and its span so far.
    pub fn new(span: Span, kind: Option<Name<'s>>, name: Option<Name<'s>>) -> Self {
        Self {
            kind,
            name,
            repetition: None,
            open: None,
            fields: Vec::new(),
            bad: Vec::new(),
            close: None,
            span,
        }
    }

    /// Returns the span that represents the block in messages: its kind, or else its `{`, or else
    /// the whole block.
    pub fn keyword(&self) -> Span {
        match (&self.kind, self.open) {
            (Some(kind), _) => kind.span,
            (None, Some(open)) => open,
            (None, None) => self.span,
        }
    }
}

/// The indices of a repeated object: `for INDEX < COUNT, …`.
#[derive(Clone, Debug, PartialEq)]
pub struct Repetition<'s> {
    /// The place of `for`.
    pub keyword: Span,
    /// The indices, in the order of the text; empty if they could not be understood.
    pub indices: Vec<Index<'s>>,
}

impl Repetition<'_> {
    /// Returns the span from `for` to the last count.
    pub fn span(&self) -> Span {
        let last = self.indices.last();
        self.keyword
            .to(last.map_or(self.keyword, |last| last.count.span))
    }
}

/// An index and its count: `INDEX < COUNT`.
#[derive(Clone, Debug, PartialEq)]
pub struct Index<'s> {
    /// The name of the index.
    pub name: Name<'s>,
    /// The place of `<`.
    pub less: Span,
    /// The count: the number of values of the index.
    pub count: Value<'s>,
    /// The place of the comma after the count; `None` if there is none.
    pub comma: Option<Span>,
}

impl<'s> Index<'s> {
    /// Makes an index that has only its name so far.
    pub(super) fn begun(name: Name<'s>) -> Self {
        Self {
            name,
            less: name.span,
            count: bad(name.span),
            comma: None,
        }
    }
}

/// A field and its value: `FIELD VALUE`.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<'s> {
    /// The field's name.
    pub name: Name<'s>,
    /// The field's value.
    pub value: Value<'s>,
    /// The whole field, from its name to its value's end.
    pub span: Span,
}

/// A value with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Value<'s> {
    /// The form of the value, such as a number, a name or a call.
    pub kind: ValueKind<'s>,
    /// The value's place in the text.
    pub span: Span,
}

impl<'s> Value<'s> {
    pub(super) fn new(kind: ValueKind<'s>, span: Span) -> Self {
        Self { kind, span }
    }

    /// Returns the arguments, elements or operands of a value, in order. Returns an empty list for
    /// any other value, such as a number.
    pub fn parts(&self) -> Vec<&Self> {
        match &self.kind {
            ValueKind::Call(call) => call.arguments.iter().map(|e| &e.value).collect(),
            ValueKind::Tuple(elements) => elements.iter().map(|e| &e.value).collect(),
            ValueKind::Parentheses(inner) => vec![inner],
            ValueKind::Negation { operand, .. } => vec![operand],
            ValueKind::Chain { first, rest } => {
                let operands = rest.iter().map(|step| &step.operand);
                std::iter::once(&**first).chain(operands).collect()
            }
            _ => Vec::new(),
        }
    }
}

/// Forms of a value.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueKind<'s> {
    /// A number without a unit, as it is spelled.
    Number(&'s str),
    /// A number with a unit.
    Angle {
        /// The number's spelling.
        number: &'s str,
        /// The number's unit.
        unit: Unit,
    },
    /// A colour code with its `#`: `#rgb` or `#rrggbb`, with three or six hexadecimal digits.
    ColorCode(&'s str),
    /// A name.
    Name(&'s str),
    /// A call: `FUNCTION(ARGUMENT, …)`. It is boxed, because otherwise it would double the size of
    /// every value.
    Call(Box<Call<'s>>),
    /// A value in parentheses: `(VALUE)`.
    Parentheses(Box<Value<'s>>),
    /// A list in parentheses: `(VALUE, VALUE, …)` with at least two values, or the empty list `()`.
    Tuple(Vec<Element<'s>>),
    /// A negation: `-VALUE`.
    Negation {
        /// The place of `-`.
        sign: Span,
        /// The operand.
        operand: Box<Value<'s>>,
    },
    /// `VALUE + VALUE - VALUE` or `VALUE * VALUE / VALUE`: operators of one precedence, applied
    /// from left to right. They are a list rather than a binary tree, so that a long sum nests no
    /// deeper than a short one.
    Chain {
        /// The first value.
        first: Box<Value<'s>>,
        /// The operators and their right operands, in order.
        rest: Vec<Step<'s>>,
    },
    /// A missing value after a field's name. The parser does not report it, since it does not know
    /// which names are fields: either the value is missing, or the name was meant as a value.
    Missing,
    /// Text that was not understood; a problem was reported for it.
    Bad,
}

/// A call: `FUNCTION(ARGUMENT, …)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Call<'s> {
    /// The function's name.
    pub function: Name<'s>,
    /// The function's arguments.
    pub arguments: Vec<Element<'s>>,
    /// The span from `(` to `)`.
    pub parentheses: Span,
}

/// An operator and its right operand.
#[derive(Clone, Debug, PartialEq)]
pub struct Step<'s> {
    /// The operator.
    pub operator: Operator,
    /// The place of the operator.
    pub sign: Span,
    /// The right operand.
    pub operand: Value<'s>,
}

/// A value in a list of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Element<'s> {
    /// The value.
    pub value: Value<'s>,
    /// The place of the comma after the value; `None` if there is none.
    pub comma: Option<Span>,
}

/// Unit of an angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Degrees: `deg`.
    Degrees,
    /// Radians: `rad`.
    Radians,
}

impl Unit {
    /// Returns the spelling of the unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Degrees => "deg",
            Self::Radians => "rad",
        }
    }

    /// Converts `number`, which is in this unit, to an angle.
    pub fn of(self, number: f64) -> Angle {
        match self {
            Self::Degrees => Angle::from_degrees(number),
            Self::Radians => Angle::from_radians(number),
        }
    }
}

/// A binary operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
}

impl Operator {
    /// Returns the operator with the spelling `sign`; `None` if there is none.
    pub fn of(sign: &str) -> Option<Self> {
        let mut all = [Self::Add, Self::Subtract, Self::Multiply, Self::Divide].into_iter();
        all.find(|operator| sign.chars().eq([operator.sign()]))
    }

    /// Returns whether the operator is `*` or `/`, which bind more tightly than `+` and `-`.
    pub fn is_of_product(self) -> bool {
        matches!(self, Self::Multiply | Self::Divide)
    }

    /// Returns the spelling of the operator.
    pub fn sign(self) -> char {
        match self {
            Self::Add => '+',
            Self::Subtract => '-',
            Self::Multiply => '*',
            Self::Divide => '/',
        }
    }
}

/// Makes the node of a number, or of an angle if `written` ends with a unit.
pub(super) fn number(written: &str) -> ValueKind<'_> {
    let units = [("deg", Unit::Degrees), ("rad", Unit::Radians)];
    let angle = units.into_iter().find_map(|(word, unit)| {
        let number = written.strip_suffix(word)?;
        Some(ValueKind::Angle { number, unit })
    });
    angle.unwrap_or(ValueKind::Number(written))
}

/// Makes the node of `-VALUE`.
pub(super) fn negation(sign: Span, operand: Value<'_>) -> Value<'_> {
    let span = sign.to(operand.span);
    let operand = Box::new(operand);
    Value::new(ValueKind::Negation { sign, operand }, span)
}

/// Makes the node of `FUNCTION(ARGUMENT, …)`.
pub(super) fn call<'s>(
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
    Value::new(ValueKind::Call(Box::new(call)), span)
}

/// Makes the node of `(VALUE)` if there is one element, and of `(VALUE, VALUE, …)` otherwise.
pub(super) fn group(elements: Vec<Element<'_>>) -> ValueKind<'_> {
    match <[Element<'_>; 1]>::try_from(elements) {
        Ok([only]) => ValueKind::Parentheses(Box::new(only.value)),
        Err(elements) => ValueKind::Tuple(elements),
    }
}

/// Makes the node of `VALUE OPERATOR VALUE`. If `left` is a chain of operators of the same
/// precedence, appends the operator and its operand to that chain.
pub(super) fn chain<'s>(
    mut left: Value<'s>,
    operator: Operator,
    sign: Span,
    operand: Value<'s>,
) -> Value<'s> {
    let span = left.span.to(operand.span);
    let step = Step {
        operator,
        sign,
        operand,
    };
    let is_like = |last: &Step<'_>| last.operator.is_of_product() == operator.is_of_product();
    if let ValueKind::Chain { rest, .. } = &mut left.kind
        && rest.last().is_some_and(is_like)
    {
        rest.push(step);
        left.span = span;
        return left;
    }
    let (first, rest) = (Box::new(left), vec![step]);
    Value::new(ValueKind::Chain { first, rest }, span)
}

/// Makes the node of a value that was not understood.
pub(super) fn bad<'s>(span: Span) -> Value<'s> {
    Value::new(ValueKind::Bad, span)
}
