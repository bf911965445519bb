//! What can be done about problems of meaning.

use super::{error::Problem, schema};
use crate::{
    diagnostic::{Edit, Fix, Fixable},
    source::{SourceId, Sources, Span},
};

impl Fixable for Problem {
    /// Only reading the scene tells what a field without a value is called.
    fn is_of_syntax(&self) -> bool {
        matches!(self, Self::MissingValue { .. })
    }

    fn fixes(&self, sources: &Sources) -> Vec<Fix> {
        match self {
            Self::UnknownFunction {
                name,
                arguments: Some(arguments),
                ..
            } => vec![Fix::new(
                format!("write `{name} * (…)`"),
                [Edit::new(*arguments, " * ")],
            )],
            Self::UnknownKind { span, near, .. }
            | Self::UnknownFunction { span, near, .. }
            | Self::UnknownMethod { span, near, .. }
            | Self::NoSuchTarget { span, near, .. } => everywhere(*span, &[], near.as_deref()),
            Self::UnknownName {
                span, more, near, ..
            }
            | Self::UnknownColor {
                span, more, near, ..
            } => everywhere(*span, more, near.as_deref()),
            Self::UnknownField { fixes, .. }
            | Self::MissingField { fixes, .. }
            | Self::ConflictingFields { fixes, .. }
            | Self::ViewUndefined { fixes, .. }
            | Self::UpParallel { fixes, .. }
            | Self::NothingSeen { fixes, .. }
            | Self::EmptyDepth { fixes, .. }
            | Self::EmptyBox { fixes, .. }
            | Self::NotFinite { fixes, .. }
            | Self::OperandTypes { fixes, .. }
            | Self::PredefinedName { fixes, .. }
            | Self::UsedBeforeDefinition { fixes, .. } => fixes.clone(),
            Self::BareAngle { span, instead, .. }
            | Self::WrongType { span, instead, .. }
            | Self::PartCount { span, instead, .. }
            | Self::ArgumentCount { span, instead, .. }
            | Self::ColorRange { span, instead, .. }
            | Self::UnitColor { span, instead, .. }
            | Self::OutOfRange {
                whole: span,
                instead,
                ..
            } => {
                let fixes = instead.iter().map(|text| Fix::write(*span, text));
                fixes.collect()
            }
            Self::MissingValue {
                name,
                span,
                example,
                ..
            } => {
                let value = example.as_ref();
                let fix = value.map(|value| {
                    Fix::new(
                        format!("write `{name} {value}`"),
                        [Edit::new(behind(*span, sources), format!(" {value}"))],
                    )
                });
                fix.into_iter().collect()
            }
            Self::DuplicateField { name, fields, .. } => one_of_two(name, "", *fields, sources),
            Self::DuplicateBlock { name, blocks, .. } => {
                one_of_two(name, " block", *blocks, sources)
            }
            Self::DuplicateLet {
                name, definition, ..
            } => vec![Fix::remove_whole(
                format!("remove this `let {name}`"),
                [*definition],
                sources,
            )],
            Self::UnexpectedName { name, span, .. }
            | Self::ReservedName { name, span }
            | Self::DuplicateName {
                name, second: span, ..
            } => vec![Fix::remove(
                format!("take the name `{name}` away"),
                *span,
                sources,
            )],
            Self::MissingCamera { is_empty: true, .. } => {
                let end = sources.file.text().len();
                let scene = at_end(super::SMALLEST, sources);
                let title = "write the smallest scene";
                vec![Fix::new(title, [Edit::insert(SourceId::File, end, scene)])]
            }
            Self::MissingCamera { .. } => add("camera", &["eye", "lookat"], sources),
            Self::NoObjects { .. } => add("sphere", &["center"], sources),
            Self::FunctionWithoutArguments { example, span, .. } => {
                vec![Fix::write(*span, example)]
            }
            Self::NumberUnderflow { span, .. } => vec![Fix::write(*span, "0")],
            Self::TooManySamples { most, span, .. } if !span.range().is_empty() => {
                vec![Fix::write(*span, most.to_string())]
            }
            Self::FewSamples { pixels, span, .. } => {
                vec![Fix::write(*span, pixels.to_string())]
            }
            // What is meant is for the author to say, or takes a look at more than this place.
            Self::ArgumentType { .. }
            | Self::PartType { .. }
            | Self::NumberTooLarge { .. }
            | Self::NotATriangle { .. }
            | Self::OnOneLine { .. }
            | Self::BoxTooLarge { .. }
            | Self::TooManySamples { .. }
            | Self::SetWithoutEquals { .. }
            | Self::BadTarget { .. }
            | Self::SetWithoutValue { .. } => Vec::new(),
        }
    }
}

/// Writes what was meant in all places of a name.
fn everywhere(span: Span, more: &[Span], near: Option<&str>) -> Vec<Fix> {
    let fix = near.map(|near| {
        let places = [span].into_iter().chain(more.iter().copied());
        let edits = places.map(|place| Edit::new(place, near));
        Fix::new(format!("write `{near}`"), edits)
    });
    fix.into_iter().collect()
}

/// Of a thing that is there twice, keeps the first or the second one.
fn one_of_two(name: &str, what: &str, [first, second]: [Span; 2], sources: &Sources) -> Vec<Fix> {
    let ways = [("first", "second", second), ("second", "first", first)];
    let fixes = ways.map(|(kept, removed, span)| {
        let title = format!("keep the {kept} `{name}`{what}, remove the {removed}");
        Fix::remove_whole(title, [span], sources)
    });
    fixes.to_vec()
}

/// Adds a block at the end of the file.
fn add(block: &str, fields: &[&str], sources: &Sources) -> Vec<Fix> {
    let Some(row) = schema::block(block) else {
        return Vec::new();
    };
    let rows = fields.iter().filter_map(|name| row.field(name));
    let fields: Vec<String> = rows
        .map(|field| format!("{} {}", field.name, field.example()))
        .collect();
    let added = at_end(&format!("{block} {{ {} }}\n", fields.join("  ")), sources);
    vec![Fix::new(
        format!("add {}", row.noun),
        [Edit::insert(
            SourceId::File,
            sources.file.text().len(),
            added,
        )],
    )]
}

/// Lines to add at the end of the file.
fn at_end(lines: &str, sources: &Sources) -> String {
    let text = sources.file.text();
    let line_end = sources.file.line_end();
    let apart = match text.ends_with('\n') || text.len() == sources.file.bom_len() {
        true => "",
        false => line_end,
    };
    format!("{apart}{}", lines.replace('\n', line_end))
}

/// The place behind a field's name, with a `=` or `:` that stands there.
fn behind(name: Span, sources: &Sources) -> Span {
    let text = sources.get(name.source).text();
    let after = text.get(name.end..).unwrap_or_default();
    let rest = after.trim_start_matches([' ', '\t']);
    let end = match rest.strip_prefix(['=', ':']) {
        Some(rest) => text.len() - rest.len(),
        None => name.end,
    };
    Span::new(name.source, name.end, end)
}
