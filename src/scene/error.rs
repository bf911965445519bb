//! What can be wrong with what a scene means.

use std::ops::{Deref, DerefMut};

use miette::Diagnostic;
use thiserror::Error;

use super::schema::Type;
use crate::{
    diagnostic::{self, Edit, Fix},
    source::{Sources, Span},
};

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
    },

    #[error("{noun} has no field `{written}`")]
    #[diagnostic(code(pinhole::unknown_field), help("{help}"))]
    UnknownField {
        noun: &'static str,
        written: String,
        help: String,
        #[label("not a field of {noun}")]
        span: Span,
    },

    #[error("`{name}` has no value")]
    #[diagnostic(code(pinhole::missing_value), help("{help}"))]
    MissingValue {
        name: String,
        help: String,
        #[label("a value should follow this")]
        span: Span,
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
    },

    #[error("`{name}` is given twice")]
    #[diagnostic(code(pinhole::duplicate_field), help("remove one of them"))]
    DuplicateField {
        name: String,
        #[label("and again here")]
        second: Span,
        #[label("first here")]
        first: Span,
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
    },

    #[error("the scene has no camera")]
    #[diagnostic(
        code(pinhole::missing_camera),
        help("add one, such as `camera {{ eye (0, 2, 8)  lookat (0, 1, 0) }}`")
    )]
    MissingCamera {
        #[label("no `camera` in this text")]
        span: Span,
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
    },

    #[error("there is no function `{name}`")]
    #[diagnostic(code(pinhole::unknown_function), help("{help}"))]
    UnknownFunction {
        name: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
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
    },

    #[error("there is no method `{written}`")]
    #[diagnostic(code(pinhole::unknown_method), help("{help}"))]
    UnknownMethod {
        written: String,
        help: String,
        #[label("not a method")]
        span: Span,
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
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::not_finite), help("{help}"))]
    NotFinite {
        message: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
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
    },

    #[error("the parts of a colour go from 0 to 255, and none of these is more than 1")]
    #[diagnostic(code(pinhole::unit_color), severity(Warning), help("{help}"))]
    UnitColor {
        help: String,
        #[label("almost black")]
        span: Span,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::out_of_range), help("{help}"))]
    OutOfRange {
        message: String,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
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
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::nothing_seen), severity(Warning), help("{help}"))]
    NothingSeen {
        message: &'static str,
        help: String,
        #[label("{label}")]
        span: Span,
        label: &'static str,
    },

    #[error("{message}")]
    #[diagnostic(code(pinhole::up_parallel), severity(Warning), help("{help}"))]
    UpParallel {
        message: &'static str,
        help: String,
        #[label("{label}")]
        span: Span,
        label: String,
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
    },
}

/// A problem with what can be done about it, the likeliest first.
#[derive(Clone, Debug)]
pub struct Found {
    /// The problem.
    pub problem: Problem,
    /// The ways out that are edits. None of them needs another one.
    pub fixes: Vec<Fix>,
}

impl From<Problem> for Found {
    fn from(problem: Problem) -> Self {
        problem.with([])
    }
}

impl Found {
    /// For the list that all stages add to.
    pub fn diagnostic(&self, sources: &Sources) -> diagnostic::Diagnostic {
        diagnostic::Diagnostic {
            fixes: self.fixes.clone(),
            // Only reading the scene tells what a field without a value is called.
            is_of_syntax: matches!(self.problem, Problem::MissingValue { .. }),
            ..diagnostic::Diagnostic::from_problem(&self.problem, sources)
        }
    }

    /// Adds another place where the same name is used.
    pub fn and_here(&mut self, span: Span) {
        // More places than these would hide the first.
        const MOST: usize = 20;
        let (Problem::UnknownName { more, .. }
        | Problem::UnknownColor { more, .. }
        | Problem::UsedBeforeDefinition { more, .. }) = &mut self.problem
        else {
            return;
        };
        if more.len() < MOST {
            more.push(span);
            for fix in &mut self.fixes {
                let text = fix.edits.first().map(|edit| edit.text.clone());
                fix.edits.extend(text.map(|text| Edit::new(span, text)));
                fix.edits.sort_by_key(|edit| edit.span);
            }
        }
    }
}

/// All that was found.
#[derive(Clone, Debug, Default)]
pub struct Problems(Vec<Found>);

impl Problems {
    /// Adds a problem, with fixes or without.
    pub fn push(&mut self, found: impl Into<Found>) {
        self.0.push(found.into());
    }
}

impl Deref for Problems {
    type Target = Vec<Found>;
    fn deref(&self) -> &Vec<Found> {
        &self.0
    }
}

impl DerefMut for Problems {
    fn deref_mut(&mut self) -> &mut Vec<Found> {
        &mut self.0
    }
}

impl Problem {
    /// The problem with what can be done about it.
    pub fn with(self, fixes: impl IntoIterator<Item = Fix>) -> Found {
        Found {
            problem: self,
            fixes: fixes.into_iter().collect(),
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
