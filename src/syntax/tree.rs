//! The syntax tree.
//!
//! It says what was written and where, and nothing of what it means. Every token of a right file
//! has its place in a node's span, so that a formatter can put the text together again from the
//! tree and the comments. What could not be understood is `Bad`, and a problem was reported for it.

use crate::{math::Angle, source::Span};

/// A whole file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tree<'s> {
    /// The items in their order.
    pub items: Vec<Item<'s>>,
}

/// What a file is a list of.
#[derive(Clone, Debug, PartialEq)]
pub enum Item<'s> {
    /// `let NAME = VALUE`
    Definition(Definition<'s>),
    /// `KIND NAME? { FIELD VALUE … }`
    Block(Block<'s>),
    /// Something that is neither.
    Bad(Span),
}

impl Item<'_> {
    /// The whole item.
    pub fn span(&self) -> Span {
        match self {
            Self::Definition(definition) => definition.span,
            Self::Block(block) => block.span,
            Self::Bad(span) => *span,
        }
    }
}

/// A name where it stands in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name<'s> {
    /// The name.
    pub text: &'s str,
    /// Its place.
    pub span: Span,
}

/// `let NAME = VALUE`
#[derive(Clone, Debug, PartialEq)]
pub struct Definition<'s> {
    /// `let`
    pub keyword: Span,
    /// What is defined; none if it was left out.
    pub name: Option<Name<'s>>,
    /// `=`; none if it was left out.
    pub equals: Option<Span>,
    /// What it is.
    pub value: Value<'s>,
    /// From `let` to the value's end.
    pub span: Span,
}

impl Definition<'_> {
    /// A definition of which nothing is known yet but its `let`.
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

/// `KIND NAME? { FIELD VALUE … }`, or `KIND NAME? for INDEX < COUNT, … { FIELD VALUE … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Block<'s> {
    /// What it is a block of; none if it was left out.
    pub kind: Option<Name<'s>>,
    /// The name of the object.
    pub name: Option<Name<'s>>,
    /// The indices of several objects; it lies apart, as few blocks have one.
    pub repetition: Option<Box<Repetition<'s>>>,
    /// `{`; none if it was left out.
    pub open: Option<Span>,
    /// The fields in their order.
    pub fields: Vec<Field<'s>>,
    /// What stands among the fields and is none.
    pub bad: Vec<Span>,
    /// `}`; none if it was left out.
    pub close: Option<Span>,
    /// The whole block.
    pub span: Span,
}

impl<'s> Block<'s> {
    /// A block of which no more is known yet than its place, its kind and its name.
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

    /// The place that stands for the block as a whole: its kind, or what comes first.
    pub fn keyword(&self) -> Span {
        match (&self.kind, self.open) {
            (Some(kind), _) => kind.span,
            (None, Some(open)) => open,
            (None, None) => self.span,
        }
    }
}

/// `for INDEX < COUNT, …`
#[derive(Clone, Debug, PartialEq)]
pub struct Repetition<'s> {
    /// `for`
    pub keyword: Span,
    /// The indices in their order; none if they were not understood.
    pub indices: Vec<Index<'s>>,
}

impl Repetition<'_> {
    /// From `for` to the last count.
    pub fn span(&self) -> Span {
        let last = self.indices.last();
        self.keyword
            .to(last.map_or(self.keyword, |last| last.count.span))
    }
}

/// `INDEX < COUNT`
#[derive(Clone, Debug, PartialEq)]
pub struct Index<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// `<`
    pub less: Span,
    /// How many values it has.
    pub count: Value<'s>,
    /// The comma after it.
    pub comma: Option<Span>,
}

impl<'s> Index<'s> {
    /// An index of which no more is known yet than its name.
    pub(super) fn begun(name: Name<'s>) -> Self {
        Self {
            name,
            less: name.span,
            count: bad(name.span),
            comma: None,
        }
    }
}

/// `FIELD VALUE`
#[derive(Clone, Debug, PartialEq)]
pub struct Field<'s> {
    /// Its name.
    pub name: Name<'s>,
    /// Its value.
    pub value: Value<'s>,
    /// Both.
    pub span: Span,
}

/// A value with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Value<'s> {
    /// What it is.
    pub kind: ValueKind<'s>,
    /// Its place.
    pub span: Span,
}

impl<'s> Value<'s> {
    pub(super) fn new(kind: ValueKind<'s>, span: Span) -> Self {
        Self { kind, span }
    }

    /// The values that it is made of, in order.
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

/// The ways to write a value.
#[derive(Clone, Debug, PartialEq)]
pub enum ValueKind<'s> {
    /// A number by its spelling, without a unit.
    Number(&'s str),
    /// A number with a unit.
    Angle {
        /// The number's spelling.
        number: &'s str,
        /// Its unit.
        unit: Unit,
    },
    /// `#rgb` or `#rrggbb`: the spelling, with the `#`; the number of digits is right.
    ColorCode(&'s str),
    /// A name.
    Name(&'s str),
    /// `FUNCTION(ARGUMENT, …)`; its parts lie apart, as they would make every value twice as large.
    Call(Box<Call<'s>>),
    /// `(VALUE)`
    Parentheses(Box<Value<'s>>),
    /// `(VALUE, VALUE, …)` with two or more values, or none.
    Tuple(Vec<Element<'s>>),
    /// `-VALUE`
    Negation {
        /// `-`
        sign: Span,
        /// What follows it.
        operand: Box<Value<'s>>,
    },
    /// `VALUE + VALUE - VALUE` or `VALUE * VALUE / VALUE`: operators of one precedence, done from
    /// left to right. A chain rather than a tree, so that a long sum is no deeper than a short one.
    Chain {
        /// The first value.
        first: Box<Value<'s>>,
        /// What is done to it, in order.
        rest: Vec<Step<'s>>,
    },
    /// A field's name without a value after it. It is for the next stage to report, which knows the
    /// fields' names and so whether the value is missing or the name of a field.
    Missing,
    /// Something that was reported.
    Bad,
}

/// `FUNCTION(ARGUMENT, …)`
#[derive(Clone, Debug, PartialEq)]
pub struct Call<'s> {
    /// The function.
    pub function: Name<'s>,
    /// Its arguments.
    pub arguments: Vec<Element<'s>>,
    /// `(` to `)`
    pub parentheses: Span,
}

/// An operator and what stands after it.
#[derive(Clone, Debug, PartialEq)]
pub struct Step<'s> {
    /// What is done.
    pub operator: Operator,
    /// Its sign.
    pub sign: Span,
    /// With what.
    pub operand: Value<'s>,
}

/// A value in a list of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Element<'s> {
    /// The value.
    pub value: Value<'s>,
    /// The comma after it.
    pub comma: Option<Span>,
}

/// The unit of an angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// `deg`
    Degrees,
    /// `rad`
    Radians,
}

impl Unit {
    /// How it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Degrees => "deg",
            Self::Radians => "rad",
        }
    }

    /// The angle of so many.
    pub fn of(self, number: f64) -> Angle {
        match self {
            Self::Degrees => Angle::from_degrees(number),
            Self::Radians => Angle::from_radians(number),
        }
    }
}

/// What stands between two operands.
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
    /// The one that is written so.
    pub fn of(sign: &str) -> Option<Self> {
        let mut all = [Self::Add, Self::Subtract, Self::Multiply, Self::Divide].into_iter();
        all.find(|operator| sign.chars().eq([operator.sign()]))
    }

    /// Whether it is `*` or `/`, which come before `+` and `-`.
    pub fn is_of_product(self) -> bool {
        matches!(self, Self::Multiply | Self::Divide)
    }

    /// How it is written.
    pub fn sign(self) -> char {
        match self {
            Self::Add => '+',
            Self::Subtract => '-',
            Self::Multiply => '*',
            Self::Divide => '/',
        }
    }
}

/// A number that is right, with its unit if it has one.
pub(super) fn number(written: &str) -> ValueKind<'_> {
    let units = [("deg", Unit::Degrees), ("rad", Unit::Radians)];
    let angle = units.into_iter().find_map(|(word, unit)| {
        let number = written.strip_suffix(word)?;
        Some(ValueKind::Angle { number, unit })
    });
    angle.unwrap_or(ValueKind::Number(written))
}

/// `-VALUE`
pub(super) fn negation(sign: Span, operand: Value<'_>) -> Value<'_> {
    let span = sign.to(operand.span);
    let operand = Box::new(operand);
    Value::new(ValueKind::Negation { sign, operand }, span)
}

/// `FUNCTION(ARGUMENT, …)`
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

/// `(VALUE)`, or `(VALUE, VALUE, …)`
pub(super) fn group(elements: Vec<Element<'_>>) -> ValueKind<'_> {
    match <[Element<'_>; 1]>::try_from(elements) {
        Ok([only]) => ValueKind::Parentheses(Box::new(only.value)),
        Err(elements) => ValueKind::Tuple(elements),
    }
}

/// `VALUE OPERATOR VALUE`; operators of one precedence make one chain.
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

/// A value that cannot be told.
pub(super) fn bad<'s>(span: Span) -> Value<'s> {
    Value::new(ValueKind::Bad, span)
}
