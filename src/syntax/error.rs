//! What can be wrong with a text before anything is known of its meaning.

use miette::Diagnostic;
use thiserror::Error;

use super::comments::NESTING_LIMIT;
use crate::source::Span;

/// A problem of syntax. The first label is the place to jump to.
#[allow(
    missing_docs,
    reason = "the messages say what the variants and their fields mean"
)]
#[derive(Clone, Debug, Error, Diagnostic, PartialEq)]
pub enum Problem {
    #[error("this file is not valid UTF-8{}", and_more(*more))]
    #[diagnostic(code(pinhole::invalid_utf8), help("save the file as UTF-8"))]
    InvalidUtf8 {
        #[label("this byte is part of no character")]
        span: Span,
        more: usize,
    },

    #[error("this file is UTF-16, not UTF-8")]
    #[diagnostic(code(pinhole::invalid_utf8), help("save the file as UTF-8"))]
    Utf16 {
        #[label("the byte order mark of UTF-16")]
        span: Span,
    },

    #[error("{what} is no white space here{}", times(*more))]
    #[diagnostic(
        code(pinhole::odd_space),
        help("write a plain space in its place, or take it away")
    )]
    OddSpace {
        what: String,
        more: usize,
        #[label("it cannot be seen")]
        span: Span,
        /// All of its sort.
        places: Vec<Span>,
    },

    #[error("a line of a comment ends at a carriage return alone, which ends no line")]
    #[diagnostic(
        code(pinhole::odd_space),
        help("end the lines at LF or CRLF; the comment takes what follows, up to the next LF")
    )]
    LoneReturn {
        #[label("here")]
        span: Span,
    },

    #[error("a comment is never closed")]
    #[diagnostic(
        code(pinhole::unclosed_comment),
        help("write `*/` where it ends, or begin it with `//` if it is one line")
    )]
    UnclosedComment {
        #[label("the comment starts here and takes the rest of the text")]
        span: Span,
    },

    #[error("a comment begins with `//`, not with `{sign}`{}", and_below(places.len() - 1))]
    #[diagnostic(code(pinhole::comment_sign), help("write `{right}`"))]
    ForeignComment {
        sign: String,
        /// The comment as it should be, for a message.
        right: String,
        #[label("`//` should stand here")]
        span: Span,
        /// This sign, and those in the lines below that hold nothing else.
        places: Vec<Span>,
    },

    #[error("this value nests more than {NESTING_LIMIT} levels deep")]
    #[diagnostic(
        code(pinhole::too_deep),
        help("give a part of it a name with `let`, and use the name here")
    )]
    TooDeep {
        #[label("level {}", NESTING_LIMIT + 1)]
        span: Span,
    },

    #[error("the block of `{kind}` is never closed")]
    #[diagnostic(code(pinhole::unclosed_block), help("write `}}` after its last field"))]
    UnclosedBlock {
        kind: String,
        #[label("opened here")]
        open: Span,
        /// Where what was read of it ends.
        end: Span,
        #[label("it should be closed before this")]
        before: Option<Span>,
    },

    #[error("a parenthesis is never closed")]
    #[diagnostic(code(pinhole::unclosed_parenthesis), help("write `)` where it ends"))]
    UnclosedParenthesis {
        #[label("opened here")]
        span: Span,
    },

    #[error("this `{sign}` closes nothing")]
    #[diagnostic(code(pinhole::stray_closing), help("{help}"))]
    StrayClosing {
        sign: String,
        #[label("nothing is open here")]
        span: Span,
        /// It, and others of its kind right behind it.
        all: Span,
        help: String,
    },

    #[error("`let {name}` has no value")]
    #[diagnostic(
        code(pinhole::missing_value),
        help("write `let {name} = ` and a value")
    )]
    MissingValue {
        name: String,
        #[label("a value should follow")]
        span: Span,
    },

    #[error("`{name}` has no value")]
    #[diagnostic(code(pinhole::missing_value), help("write a value after it"))]
    FieldWithoutValue {
        name: String,
        #[label("a value should follow this")]
        span: Span,
    },

    #[error("this `--set` gives no value")]
    #[diagnostic(code(pinhole::missing_value), help("write a value after the `=`"))]
    SetWithoutValue {
        #[label("a value should follow")]
        span: Span,
    },

    #[error("nothing stands {side} this `{operator}`")]
    #[diagnostic(
        code(pinhole::missing_operand),
        help("write a value {side} it, or take the `{operator}` away")
    )]
    MissingOperand {
        operator: String,
        side: &'static str,
        #[label("a value is missing {side} this")]
        span: Span,
    },

    #[error("a field takes its value without `{sign}`")]
    #[diagnostic(code(pinhole::needless_equals), help("write `{name} {value}`"))]
    NeedlessEquals {
        sign: String,
        name: String,
        value: String,
        #[label("not needed")]
        span: Span,
    },

    #[error("no `{sign}` stands between {between}")]
    #[diagnostic(
        code(pinhole::needless_separator),
        help("take it away; white space separates {between}")
    )]
    NeedlessSeparator {
        sign: String,
        between: &'static str,
        #[label("not needed")]
        span: Span,
    },

    #[error("`let {name}` lacks its `=`")]
    #[diagnostic(code(pinhole::missing_equals), help("write `let {name} = {value}`"))]
    MissingEquals {
        name: String,
        value: String,
        #[label("`=` should stand here")]
        span: Span,
    },

    #[error("a `let` lacks its name")]
    #[diagnostic(
        code(pinhole::missing_name),
        help("write a name of letters, digits and `_`, such as `let height = 2`")
    )]
    MissingName {
        #[label("a name should stand here")]
        span: Span,
    },

    #[error("`{written}` cannot be a name")]
    #[diagnostic(
        code(pinhole::bad_name),
        help(
            "a name is made of the letters a to z, digits and `_`, and does not start with a digit"
        )
    )]
    BadName {
        written: String,
        #[label("a name should stand here")]
        span: Span,
    },

    #[error("{} is missing between `{left}` and `{right}`", meant.missing())]
    #[diagnostic(code(pinhole::missing_operator), help("{help}"))]
    MissingOperator {
        left: String,
        right: String,
        help: String,
        #[label("{}", meant.question())]
        span: Span,
        /// What may be meant.
        meant: Meant,
    },

    #[error("a comma is missing between `{left}` and `{right}`")]
    #[diagnostic(code(pinhole::missing_comma), help("write `{whole}`"))]
    MissingComma {
        left: String,
        right: String,
        whole: String,
        #[label("a comma should stand before this")]
        span: Span,
        /// Where commas should stand.
        places: Vec<Span>,
    },

    #[error("this comma is one too many")]
    #[diagnostic(
        code(pinhole::needless_comma),
        help("take it away; a comma stands between two values only")
    )]
    NeedlessComma {
        #[label("{place}")]
        span: Span,
        place: &'static str,
    },

    #[error("a decimal point is written `.`, not `,`")]
    #[diagnostic(code(pinhole::decimal_comma), help("write `{number}`"))]
    DecimalComma {
        number: String,
        #[label("a comma separates the parts of a vector")]
        span: Span,
    },

    #[error("values that belong together stand in parentheses")]
    #[diagnostic(code(pinhole::missing_parentheses), help("write `({values})`"))]
    MissingParentheses {
        values: String,
        #[label("these belong together")]
        span: Span,
        /// How they are written together.
        together: String,
    },

    #[error("a vector stands in round parentheses")]
    #[diagnostic(code(pinhole::brackets), help("write `({inner})`"))]
    Brackets {
        inner: String,
        #[label("not in these")]
        span: Span,
    },

    #[error("there is no operator `{sign}`")]
    #[diagnostic(code(pinhole::unknown_operator), help("{help}"))]
    UnknownOperator {
        sign: String,
        help: String,
        #[label("not one of `+`, `-`, `*` and `/`")]
        span: Span,
        /// What can be written instead, and where.
        instead: Option<(Span, String)>,
    },

    #[error("no `+` stands before a value")]
    #[diagnostic(code(pinhole::plus_sign), help("write `{value}`"))]
    PlusSign {
        value: String,
        #[label("not needed")]
        span: Span,
    },

    #[error("{what} is written without quotation marks")]
    #[diagnostic(code(pinhole::quoted), help("write `{inner}`"))]
    Quoted {
        what: &'static str,
        inner: String,
        #[label("without the quotation marks")]
        span: Span,
    },

    #[error("`{written}` is no number")]
    #[diagnostic(code(pinhole::bad_number), help("{help}"))]
    BadNumber {
        written: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// What was meant, as a whole and what of it stands in this place.
        instead: Option<[String; 2]>,
    },

    #[error("a unit stands right behind its number")]
    #[diagnostic(code(pinhole::spaced_unit), help("write `{joined}`"))]
    SpacedUnit {
        joined: String,
        #[label("no space between the two")]
        span: Span,
    },

    #[error("`{written}` is no colour")]
    #[diagnostic(code(pinhole::bad_color_code), help("{help}"))]
    BadColorCode {
        written: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
    },

    #[error("a `let` stands within a block")]
    #[diagnostic(code(pinhole::misplaced_let), help("write it before the block"))]
    MisplacedLet {
        #[label("only fields stand here")]
        span: Span,
        /// All definitions in this place.
        definitions: Span,
        /// Where the block starts.
        block: Span,
    },

    #[error("{block} lacks its `{{`")]
    #[diagnostic(
        code(pinhole::unopened_block),
        help("write `{head} {{` before its fields")
    )]
    UnopenedBlock {
        block: String,
        head: String,
        #[label("`{{` should follow here")]
        span: Span,
    },

    #[error("a block lacks its kind")]
    #[diagnostic(
        code(pinhole::missing_kind),
        help("write what it is before the `{{`, such as `sphere {{`")
    )]
    MissingKind {
        #[label("what is this?")]
        span: Span,
    },

    #[error("only a kind and a name stand before a `{{`")]
    #[diagnostic(code(pinhole::bad_head), help("{help}"))]
    BadHead {
        help: String,
        #[label("this does not belong here")]
        span: Span,
        /// What can stand before the `{`, and in place of what.
        instead: Option<(Span, String)>,
    },

    #[error("braces within a block")]
    #[diagnostic(
        code(pinhole::nested_braces),
        help("a block holds fields only; write each block by itself")
    )]
    NestedBraces {
        #[label("no `{{` here")]
        span: Span,
    },

    #[error("a value is given to `{name}` without `let`")]
    #[diagnostic(code(pinhole::missing_let), help("write `let {name} = {value}`"))]
    MissingLet {
        name: String,
        value: String,
        /// Where the name stands.
        place: Span,
        #[label("`let {name}` should stand here")]
        span: Span,
    },

    #[error("`{name}` stands outside of every block")]
    #[diagnostic(
        code(pinhole::outside_block),
        help(
            "a file holds `let NAME = VALUE` and blocks such as `sphere {{ … }}`; fields stand between a block's braces"
        )
    )]
    OutsideBlock {
        name: String,
        #[label("this belongs to no block")]
        span: Span,
    },

    #[error("`{written}` cannot be understood here")]
    #[diagnostic(code(pinhole::unexpected), help("{help}"))]
    Unexpected {
        written: String,
        help: String,
        #[label("not here")]
        span: Span,
    },
}

/// What may be meant by two values with nothing between.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meant {
    /// Their product.
    Product,
    /// The call of a function.
    Call,
    /// The value of another field.
    Field,
    /// Nothing that can be told: two vectors have no product.
    Unclear,
}

impl Meant {
    fn missing(self) -> &'static str {
        match self {
            Self::Product | Self::Call | Self::Unclear => "an operator",
            Self::Field => "a field's name",
        }
    }

    fn question(self) -> &'static str {
        match self {
            Self::Product | Self::Call | Self::Unclear => "what is to be done with this?",
            Self::Field => "which field is this for?",
        }
    }
}

fn times(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", and at one more place".to_owned(),
        _ => format!(", and at {more} more places"),
    }
}

fn and_below(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", here and in the next line".to_owned(),
        _ => format!(", here and in the next {more} lines"),
    }
}

fn and_more(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", here and at one more byte".to_owned(),
        _ => format!(", here and at {more} more bytes"),
    }
}
