//! What can be wrong with a text before anything is known of its meaning.

use miette::Diagnostic;
use thiserror::Error;

use super::{NESTING_LIMIT, fix::Way};
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

    #[error("this looks like {what}, not like a scene of Pinhole")]
    #[diagnostic(
        code(pinhole::foreign_file),
        help(
            "the smallest scene is `camera {{ eye (0, 2, 8)  lookat (0, 1, 0) }}` and `sphere {{ center (0, 1, 0) }}`"
        )
    )]
    ForeignFile {
        what: &'static str,
        #[label("no scene starts like this")]
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

    #[error("comments do not nest: the first `*/` ends this one")]
    #[diagnostic(code(pinhole::nested_comment), help("{way}"))]
    NestedComment {
        #[label("this opens no other comment")]
        span: Span,
        #[label("so this closes none")]
        close: Span,
        way: Way,
    },

    #[error("a comment begins with `//`, not with `{sign}`{}", and_below(places.len() - 1))]
    #[diagnostic(code(pinhole::comment_sign), help("write `{right}`"))]
    ForeignComment {
        sign: String,
        /// Whether it is meant as a comment for sure.
        is_sure: bool,
        /// The comment as it should be, for a message.
        right: String,
        #[label("`//` should stand here")]
        span: Span,
        /// This sign, and those in the lines below that hold nothing else.
        places: Vec<Span>,
    },

    #[error("the language has no {what}")]
    #[diagnostic(code(pinhole::not_in_language), help("{help}"))]
    NotInLanguage {
        what: &'static str,
        help: &'static str,
        #[label("not a part of the language")]
        span: Span,
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
    #[diagnostic(code(pinhole::unclosed_parenthesis), help("{way}"))]
    UnclosedParenthesis {
        #[label("opened here")]
        span: Span,
        way: Way,
    },

    #[error("this `{sign}` closes nothing")]
    #[diagnostic(code(pinhole::stray_closing), help("{way}"))]
    StrayClosing {
        sign: String,
        #[label("nothing is open here")]
        span: Span,
        way: Way,
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

    #[error("a value is missing beside this comma")]
    #[diagnostic(
        code(pinhole::missing_value),
        help("write a value on both sides of it, such as `(1, 0, 3)`")
    )]
    MissingPart {
        #[label("something is missing here")]
        span: Span,
    },

    #[error("this `--set` gives no value")]
    #[diagnostic(code(pinhole::missing_value), help("write a value after the `=`"))]
    SetWithoutValue {
        #[label("a value should follow")]
        span: Span,
    },

    #[error("nothing stands {side} this `{operator}`")]
    #[diagnostic(code(pinhole::missing_operand), help("{way}"))]
    MissingOperand {
        operator: String,
        side: &'static str,
        #[label("a value is missing {side} this")]
        span: Span,
        way: Way,
    },

    #[error("a field takes its value without `{sign}`{}", times(way.places() - 1))]
    #[diagnostic(code(pinhole::needless_equals), help("{way}"))]
    NeedlessEquals {
        sign: String,
        #[label("not needed")]
        span: Span,
        way: Way,
    },

    #[error("no `{sign}` stands between {between}{}", times(way.places() - 1))]
    #[diagnostic(code(pinhole::needless_separator), help("{way}"))]
    NeedlessSeparator {
        sign: String,
        between: &'static str,
        #[label("not needed")]
        span: Span,
        way: Way,
    },

    #[error("`let {name}` lacks its `=`")]
    #[diagnostic(code(pinhole::missing_equals), help("{way}"))]
    MissingEquals {
        name: String,
        #[label("`=` should stand here")]
        span: Span,
        way: Way,
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

    #[error("{what} is missing between `{left}` and `{right}`")]
    #[diagnostic(code(pinhole::missing_operator), help("{way}"))]
    MissingOperator {
        what: &'static str,
        left: String,
        right: String,
        #[label("{label}")]
        span: Span,
        label: &'static str,
        way: Way,
    },

    #[error("a comma is missing between `{left}` and `{right}`")]
    #[diagnostic(code(pinhole::missing_comma), help("{way}"))]
    MissingComma {
        left: String,
        right: String,
        #[label("a comma should stand before this")]
        span: Span,
        way: Way,
    },

    #[error("a space is missing between `{left}` and `{right}`")]
    #[diagnostic(code(pinhole::missing_space), help("{way}"))]
    MissingSpace {
        left: String,
        right: String,
        #[label("a field and its value")]
        span: Span,
        way: Way,
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
        way: Way,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::decimal_comma), help("{way}"))]
    DecimalComma {
        message: &'static str,
        #[label("a comma separates the parts of a vector")]
        span: Span,
        way: Way,
    },

    #[error("values that belong together stand in parentheses")]
    #[diagnostic(code(pinhole::missing_parentheses), help("{way}"))]
    MissingParentheses {
        #[label("these belong together")]
        span: Span,
        way: Way,
    },

    #[error("{what} stands in round parentheses")]
    #[diagnostic(code(pinhole::brackets), help("{way}"))]
    Brackets {
        what: &'static str,
        #[label("not in these")]
        span: Span,
        way: Way,
    },

    #[error("there is no operator `{sign}`")]
    #[diagnostic(code(pinhole::unknown_operator), help("{way}"))]
    UnknownOperator {
        sign: String,
        #[label("not one of `+`, `-`, `*` and `/`")]
        span: Span,
        way: Way,
    },

    #[error("no `+` stands before a value")]
    #[diagnostic(code(pinhole::plus_sign), help("{way}"))]
    PlusSign {
        #[label("not needed")]
        span: Span,
        way: Way,
    },

    #[error("{what} is written without quotation marks")]
    #[diagnostic(code(pinhole::quoted), help("{way}"))]
    Quoted {
        what: &'static str,
        #[label("without the quotation marks")]
        span: Span,
        way: Way,
    },

    #[error("`{written}` is no number")]
    #[diagnostic(code(pinhole::bad_number), help("{way}"))]
    BadNumber {
        written: String,
        #[label("{label}")]
        span: Span,
        label: String,
        way: Way,
    },

    #[error("a unit stands right behind its number")]
    #[diagnostic(code(pinhole::spaced_unit), help("{way}"))]
    SpacedUnit {
        #[label("no space between the two")]
        span: Span,
        way: Way,
    },

    #[error("`{written}` is no colour")]
    #[diagnostic(code(pinhole::bad_color_code), help("{way}"))]
    BadColorCode {
        written: String,
        #[label("{label}")]
        span: Span,
        label: String,
        way: Way,
    },

    #[error("`{written}` is a function of another language")]
    #[diagnostic(code(pinhole::foreign_function), help("{way}"))]
    ForeignFunction {
        written: String,
        #[label("not a function of this language")]
        span: Span,
        way: Way,
    },

    #[error("a `let` stands within a block")]
    #[diagnostic(code(pinhole::misplaced_let), help("write it before the block"))]
    MisplacedLet {
        #[label("only fields stand here")]
        span: Span,
        /// Whether nothing else is wrong with its block.
        is_alone: bool,
        /// All definitions in this place.
        definitions: Span,
        /// Where the block starts.
        block: Span,
    },

    #[error("the block `{head}` lacks its braces")]
    #[diagnostic(code(pinhole::unopened_block), help("{way}"))]
    UnopenedBlock {
        head: String,
        #[label("the block's fields stand between `{{` and `}}`")]
        span: Span,
        way: Way,
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
    #[diagnostic(code(pinhole::bad_head), help("{way}"))]
    BadHead {
        #[label("this does not belong here")]
        span: Span,
        way: Way,
    },

    #[error("{what}")]
    #[diagnostic(
        code(pinhole::nested_braces),
        help("a block holds fields only; write each block by itself")
    )]
    NestedBraces {
        what: String,
        #[label("not in a block, or around one")]
        span: Span,
    },

    #[error("a value stands here without the name of its field")]
    #[diagnostic(code(pinhole::missing_field_name), help("{way}"))]
    MissingFieldName {
        #[label("which field is this for?")]
        span: Span,
        way: Way,
    },

    #[error("a value is given to `{name}` without `let`")]
    #[diagnostic(code(pinhole::missing_let), help("{way}"))]
    MissingLet {
        name: String,
        #[label("`let {name}` should stand here")]
        span: Span,
        way: Way,
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

    #[error("expected {expected}, found `{written}`")]
    #[diagnostic(code(pinhole::unexpected), help("{help}"))]
    Unexpected {
        expected: &'static str,
        written: String,
        help: &'static str,
        #[label("not here")]
        span: Span,
    },
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
