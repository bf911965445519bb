//! What can be wrong with what a scene means.

use miette::Diagnostic;
use thiserror::Error;

use super::schema::Type;
use crate::{diagnostic::Fix, source::Span};

/// A problem of meaning. The first label is the place to jump to.
#[allow(
    missing_docs,
    reason = "the messages say what the variants and their fields mean"
)]
#[derive(Clone, Debug, Error, Diagnostic)]
pub enum Problem {
    #[error("there is no kind of block `{written}`")]
    #[diagnostic(code(pinhole::unknown_kind), help("{help}"))]
    UnknownKind {
        written: String,
        help: String,
        #[label("not a kind of block")]
        span: Span,
        /// The name that was probably meant.
        near: Option<String>,
    },

    #[error("{noun} has no field `{written}`")]
    #[diagnostic(code(pinhole::unknown_field), help("{help}"))]
    UnknownField {
        noun: &'static str,
        written: String,
        help: String,
        #[label("not a field of {noun}")]
        span: Span,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("`{name}` has no value")]
    #[diagnostic(code(pinhole::missing_value), help("{help}"))]
    MissingValue {
        name: String,
        help: String,
        #[label("a value should follow this")]
        span: Span,
        /// A value that it can have.
        example: Option<String>,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::missing_field), help("{help}"))]
    MissingField {
        message: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        #[label("not enough by itself")]
        half: Option<Span>,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("`{name}` is given twice")]
    #[diagnostic(code(pinhole::duplicate_field), help("remove one of them"))]
    DuplicateField {
        name: String,
        #[label("and again here")]
        second: Span,
        #[label("first here")]
        first: Span,
        /// Both, with their values.
        fields: [Span; 2],
    },

    #[error("`{later}` and `{earlier}` exclude each other")]
    #[diagnostic(code(pinhole::conflicting_fields), help("remove one of them: {why}"))]
    ConflictingFields {
        later: String,
        earlier: String,
        why: &'static str,
        #[label("this says it again, in another way")]
        second: Span,
        #[label("this says it already")]
        first: Span,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("there are two `{name}` blocks")]
    #[diagnostic(
        code(pinhole::duplicate_block),
        help("keep one, with the fields of both")
    )]
    DuplicateBlock {
        name: &'static str,
        #[label("and again here")]
        second: Span,
        #[label("first here")]
        first: Span,
        /// Both, as a whole.
        blocks: [Span; 2],
    },

    #[error("the scene has no camera")]
    #[diagnostic(
        code(pinhole::missing_camera),
        help("add one, such as `camera {{ eye (0, 2, 8)  lookat (0, 1, 0) }}`")
    )]
    MissingCamera {
        #[label("no `camera` in this text")]
        span: Span,
        /// Whether there is nothing else either.
        is_empty: bool,
    },

    #[error("the scene has no objects")]
    #[diagnostic(
        code(pinhole::no_objects),
        severity(Warning),
        help(
            "the picture shows the background only; add one, such as `sphere {{ center (0, 1, 0) }}`"
        )
    )]
    NoObjects {
        #[label("no sphere, triangle, box or checkerboard in this text")]
        span: Span,
    },

    #[error("{noun} takes no name")]
    #[diagnostic(
        code(pinhole::unexpected_name),
        help("take `{name}` away; only objects have names, for a scene has one `{kind}`")
    )]
    UnexpectedName {
        noun: &'static str,
        kind: &'static str,
        name: String,
        #[label("not here")]
        span: Span,
    },

    #[error("no object can be named `{name}`")]
    #[diagnostic(
        code(pinhole::reserved_name),
        help("choose another name: `--set {name}.…` is to reach the block `{name}`")
    )]
    ReservedName {
        name: String,
        #[label("this is the name of a block")]
        span: Span,
    },

    #[error("two objects are named `{name}`")]
    #[diagnostic(code(pinhole::duplicate_name), help("give one of them another name"))]
    DuplicateName {
        name: String,
        #[label("and again here")]
        second: Span,
        #[label("first here")]
        first: Span,
    },

    #[error("`{name}` is defined twice")]
    #[diagnostic(
        code(pinhole::duplicate_let),
        help("remove one of them, or give it another name; a name keeps its value")
    )]
    DuplicateLet {
        name: String,
        #[label("and again here")]
        second: Span,
        #[label("first here")]
        first: Span,
        /// The second one, as a whole.
        definition: Span,
    },

    #[error("`{name}` is {what} already")]
    #[diagnostic(
        code(pinhole::predefined_name),
        help("choose another name, such as `my_{name}`")
    )]
    PredefinedName {
        name: String,
        what: &'static str,
        #[label("this name is taken")]
        span: Span,
        /// What it was to stand for, if that is known.
        found: Option<Type>,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("there is nothing named `{name}`")]
    #[diagnostic(code(pinhole::unknown_name), help("{help}"))]
    UnknownName {
        name: String,
        help: String,
        #[label("not defined")]
        span: Span,
        #[label(collection, "and here")]
        more: Vec<Span>,
        /// The name that was probably meant.
        near: Option<String>,
    },

    #[error("there is no colour named `{name}`")]
    #[diagnostic(code(pinhole::unknown_color), help("{help}"))]
    UnknownColor {
        name: String,
        help: String,
        #[label("not a colour, and not defined")]
        span: Span,
        #[label(collection, "and here")]
        more: Vec<Span>,
        /// The name that was probably meant.
        near: Option<String>,
    },

    #[error("`{name}` is used before it is defined")]
    #[diagnostic(code(pinhole::used_before_definition), help("{help}"))]
    UsedBeforeDefinition {
        name: String,
        help: String,
        line: usize,
        #[label("used here")]
        span: Span,
        #[label("defined here, in line {line}")]
        definition: Span,
        #[label(collection, "and used here")]
        more: Vec<Span>,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("there is no function `{name}`")]
    #[diagnostic(code(pinhole::unknown_function), help("{help}"))]
    UnknownFunction {
        name: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// The name that was probably meant.
        near: Option<String>,
        /// Where an operator can stand before the parenthesis, if that was meant.
        arguments: Option<Span>,
    },

    #[error("`{name}` is a function, and stands here without its arguments")]
    #[diagnostic(code(pinhole::function_without_arguments), help("write `{example}`"))]
    FunctionWithoutArguments {
        name: String,
        example: String,
        #[label("a function")]
        span: Span,
    },

    #[error("`{name}` takes {takes}, and here {are}")]
    #[diagnostic(code(pinhole::argument_count), help("write `{example}`"))]
    ArgumentCount {
        name: String,
        takes: String,
        are: String,
        example: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// What can stand in its place.
        instead: Vec<String>,
    },

    #[error("`{name}` takes {takes}, and {written} is {found}")]
    #[diagnostic(code(pinhole::argument_type), help("{help}"))]
    ArgumentType {
        name: String,
        takes: &'static str,
        written: String,
        found: &'static str,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
    },

    #[error("{what} is an angle, and {written} has no unit")]
    #[diagnostic(code(pinhole::bare_angle), help("{help}"))]
    BareAngle {
        what: String,
        written: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// What can stand in its place.
        instead: Vec<String>,
    },

    #[error("`{name}` is {takes}, and {written} is {found}")]
    #[diagnostic(code(pinhole::wrong_type), help("{help}"))]
    WrongType {
        name: String,
        takes: &'static str,
        written: String,
        found: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// What can stand in its place.
        instead: Vec<String>,
    },

    #[error("there is no method `{written}`")]
    #[diagnostic(code(pinhole::unknown_method), help("{help}"))]
    UnknownMethod {
        written: String,
        help: String,
        #[label("not a method")]
        span: Span,
        /// The name that was probably meant.
        near: Option<String>,
    },

    #[error("{whole}, and this has {count}")]
    #[diagnostic(code(pinhole::part_count), help("{help}"))]
    PartCount {
        whole: &'static str,
        count: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// What can stand in its place.
        instead: Vec<String>,
    },

    #[error("the parts of {whole} are {parts}, and {written} is {found}")]
    #[diagnostic(code(pinhole::part_type), help("{help}"))]
    PartType {
        whole: &'static str,
        parts: &'static str,
        written: String,
        found: &'static str,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// What of the text decides that it is wrong.
        found_in: Span,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::operand_types), help("{help}"))]
    OperandTypes {
        message: String,
        help: String,
        #[label("here")]
        operator: Span,
        #[label("{left_label}")]
        left: Option<Span>,
        left_label: String,
        #[label("{right_label}")]
        right: Span,
        right_label: String,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::not_finite), help("{help}"))]
    NotFinite {
        message: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("the number {written} is too large")]
    #[diagnostic(
        code(pinhole::number_too_large),
        help("numbers go up to 1.7976931348623157e308")
    )]
    NumberTooLarge {
        written: String,
        #[label("too large")]
        span: Span,
    },

    #[error("the number {written} is too small, and becomes 0")]
    #[diagnostic(
        code(pinhole::number_underflow),
        severity(Warning),
        help("write 0 if that is meant; the least number above 0 is 5e-324")
    )]
    NumberUnderflow {
        written: String,
        #[label("becomes 0")]
        span: Span,
    },

    #[error("the {channel} of a colour is from 0 to 255, and this is {found}")]
    #[diagnostic(code(pinhole::color_range), help("{help}"))]
    ColorRange {
        channel: &'static str,
        found: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: &'static str,
        /// What can stand in its place.
        instead: Vec<String>,
    },

    #[error("the parts of a colour go from 0 to 255, and none of these is more than 1")]
    #[diagnostic(code(pinhole::unit_color), severity(Warning), help("{help}"))]
    UnitColor {
        help: String,
        #[label("almost black")]
        span: Span,
        /// What can stand in its place.
        instead: Vec<String>,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::out_of_range), help("{help}"))]
    OutOfRange {
        message: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// The whole value.
        whole: Span,
        /// What can stand in its place.
        instead: Vec<String>,
    },

    #[error("`far` must be more than `near`")]
    #[diagnostic(code(pinhole::empty_depth), help("{help}"))]
    EmptyDepth {
        help: String,
        #[label("{far_label}")]
        far: Span,
        far_label: String,
        #[label("{near_label}")]
        near: Option<Span>,
        near_label: String,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("the camera stands on the point that it looks at")]
    #[diagnostic(
        code(pinhole::view_undefined),
        help("move one of them, or give a `direction` instead of `lookat`")
    )]
    ViewUndefined {
        #[label("the same point as the eye")]
        lookat: Span,
        #[label("the eye")]
        eye: Span,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::nothing_seen), severity(Warning), help("{help}"))]
    NothingSeen {
        message: &'static str,
        help: String,
        #[label("{label}")]
        span: Span,
        label: &'static str,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::up_parallel), severity(Warning), help("{help}"))]
    UpParallel {
        message: &'static str,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("sides of {a}, {b} and {c} do not form a triangle")]
    #[diagnostic(code(pinhole::not_a_triangle), help("{help}"))]
    NotATriangle {
        a: String,
        b: String,
        c: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
    },

    #[error("{message}")]
    #[diagnostic(
        code(pinhole::on_one_line),
        help("move one of them, so that the three points are the corners of a triangle")
    )]
    OnOneLine {
        message: String,
        #[label("the third vertex")]
        span: Span,
        #[label("the second")]
        second: Span,
        #[label("the first")]
        first: Span,
    },

    #[error("the box has no extent along {axis}")]
    #[diagnostic(code(pinhole::empty_box), help("{help}"))]
    EmptyBox {
        axis: &'static str,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
        #[label("{other_label}")]
        other: Option<Span>,
        other_label: String,
        /// What can be done about it.
        fixes: Vec<Fix>,
    },

    #[error("the box reaches beyond the largest number")]
    #[diagnostic(
        code(pinhole::box_too_large),
        help("make it smaller, or move it nearer")
    )]
    BoxTooLarge {
        #[label("center ± size/2 is not finite")]
        span: Span,
    },

    #[error("{per_pixel} samples in each of {pixels} pixels are too many")]
    #[diagnostic(
        code(pinhole::too_many_samples),
        help("at most {most} samples per pixel keep the whole count within 2^53")
    )]
    TooManySamples {
        per_pixel: String,
        pixels: u64,
        most: u64,
        #[label("{per_pixel} in each pixel")]
        span: Span,
    },

    #[error("{total} samples leave some of the {pixels} pixels empty")]
    #[diagnostic(
        code(pinhole::few_samples),
        severity(Warning),
        help("a pixel without a sample shows the background; give a `total` of at least {pixels}")
    )]
    FewSamples {
        total: u64,
        pixels: u64,
        #[label("fewer than there are pixels")]
        span: Span,
    },

    #[error("this `--set` has no `=`")]
    #[diagnostic(
        code(pinhole::bad_set),
        help("write TARGET=VALUE, such as `--set camera.roll=30deg` or `--set h=1.5`")
    )]
    SetWithoutEquals {
        #[label("a target, `=` and a value should stand here")]
        span: Span,
    },

    #[error("{message}")]
    #[diagnostic(
        code(pinhole::bad_target),
        help("a target is `BLOCK.FIELD`, such as `camera.roll`, or the name of a `let`")
    )]
    BadTarget {
        message: String,
        #[label("not a target")]
        span: Span,
    },

    #[error("this `--set` gives no value")]
    #[diagnostic(code(pinhole::missing_value), help("write a value after the `=`"))]
    SetWithoutValue {
        #[label("a value should follow")]
        span: Span,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::no_such_target), help("{help}"))]
    NoSuchTarget {
        message: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: &'static str,
        /// The name that was probably meant.
        near: Option<String>,
    },
}

impl Problem {
    /// Adds another place where the same name is used.
    pub fn and_here(&mut self, span: Span) {
        // More places than these would hide the first.
        const MOST: usize = 20;
        let (Self::UnknownName { more, .. }
        | Self::UnknownColor { more, .. }
        | Self::UsedBeforeDefinition { more, .. }) = self
        else {
            return;
        };
        if more.len() < MOST {
            more.push(span);
        }
    }

    /// The value that it is about, if another value there could be right.
    pub fn place_of_value(&self) -> Option<Span> {
        match self {
            Self::FunctionWithoutArguments { span, .. }
            | Self::ArgumentType { span, .. }
            | Self::BareAngle { span, .. }
            | Self::WrongType { span, .. }
            | Self::PartType { found_in: span, .. }
            | Self::OutOfRange { whole: span, .. } => Some(*span),
            Self::OperandTypes { left, right, .. } => {
                Some(left.map_or(*right, |left| left.to(*right)))
            }
            _ => None,
        }
    }

    /// Whether it is about a name that stands for nothing.
    pub fn is_of_name(&self) -> bool {
        matches!(
            self,
            Self::UnknownName { .. }
                | Self::UnknownColor { .. }
                | Self::UnknownFunction { .. }
                | Self::UsedBeforeDefinition { .. }
        )
    }
}
