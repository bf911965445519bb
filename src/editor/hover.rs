//! Describes the word at an offset of the text.

use super::{
    analysis::{Analysis, Path},
    tokens::{Role, RoleToken},
};
use crate::{
    color::Color,
    diagnostic::{Diagnostic, Severity},
    explain, inspect,
    math::Angle,
    numbers::{grouped, short},
    scene::describe::{ABOUT_FOR, ABOUT_LET, about_block, about_field, about_function},
    schema::{self, BlockKind, BlockRow, Value, css},
    source::Span,
    syntax::{
        shorten,
        tree::{self, Definition, Index, ValueKind},
    },
    tracer::vertices,
};

/// Description of a word or a value.
#[derive(Clone, Debug, PartialEq)]
pub struct Hover {
    /// Span of the described word or value.
    pub span: Span,
    /// The description, in Markdown.
    pub markdown: String,
}

/// Returns the description of the word at the offset `at`. If a problem is reported at `at`, the
/// problem's message precedes the description, and a longer explanation of the problem follows it.
/// Returns `None` if there is neither a description nor a problem.
pub fn hover(analysis: &Analysis<'_>, at: usize) -> Option<Hover> {
    let meaning = meaning(analysis, at);
    let Some((span, problem)) = mistake(analysis, at) else {
        return meaning;
    };
    let severity = match problem.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let mut parts = vec![format!("**{severity}:** {}", problem.message)];
    parts.extend(problem.help.as_ref().map(|help| format!("help: {help}")));
    let mut markdown = parts.join("\n\n");
    let page = explain::page(&problem.code).map(|page| page.text.trim_end());
    let about = meaning.as_ref().map(|meaning| meaning.markdown.as_str());
    for more in [about, page].into_iter().flatten() {
        markdown += "\n\n---\n\n";
        markdown += more;
    }
    let span = meaning.map_or(span, |meaning| meaning.span);
    Some(Hover { span, markdown })
}

/// Returns the first problem whose first label contains the offset `at`, together with the span of
/// this label. Returns `None` if there is no such problem.
fn mistake<'a>(analysis: &'a Analysis<'_>, at: usize) -> Option<(Span, &'a Diagnostic)> {
    analysis.diagnostics().iter().find_map(|diagnostic| {
        let span = diagnostic.labels.first()?.span;
        let holds = span.start <= at && at <= span.end && !span.range().is_empty();
        holds.then_some((span, diagnostic))
    })
}

fn meaning(analysis: &Analysis<'_>, at: usize) -> Option<Hover> {
    let token = analysis.token_at(at)?;
    let path = analysis.path(at);
    let word = analysis.slice(token.span);
    let plain = |markdown: String| Hover {
        span: token.span,
        markdown,
    };
    match token.role {
        Role::Let => Some(plain(ABOUT_LET.to_owned())),
        Role::Kind => Some(plain(kind(analysis, schema::block(word)?))),
        Role::ObjectName => Some(plain(object(analysis, &path)?)),
        Role::Field => {
            let row = path.row()?;
            Some(plain(about_field(row, row.field(word)?)))
        }
        Role::Method => {
            let mut methods = schema::METHODS.iter();
            let (_, help) = methods.find(|(method, _)| method.name() == word)?;
            Some(plain(format!("`{word}`: {help}")))
        }
        Role::Defined => Some(plain(match analysis.index_at(word, at) {
            Some((_, index)) => about_index(analysis, index),
            None => about_definition(analysis, path.definition?),
        })),
        Role::Repeat => Some(plain(ABOUT_FOR.to_owned())),
        _ => value(analysis, &path, token),
    }
}

/// Describes a colour in all its notations: as a code, as a call of `rgb`, and in linear light.
pub(super) fn about_color(color: Color) -> String {
    let [r, g, b] = color.srgb.map(short);
    let [red, green, blue] = color.to_linear().map(short);
    format!("`{color}`, `rgb({r}, {g}, {b})`; in linear light ({red}, {green}, {blue})")
}

/// Describes a definition: its text, its line and its value.
pub(super) fn about_definition<'s>(analysis: &Analysis<'s>, definition: &Definition<'s>) -> String {
    let name = definition.name.map_or("", |name| name.text);
    let written = shorten(analysis.slice(definition.value.span));
    let line = analysis.line(definition.span);
    let value = match analysis.model.defined(definition) {
        Some(value) => described(value),
        None => "it has no value: see what is reported there".to_owned(),
    };
    format!("`let {name} = {written}` (line {line})\n\n{value}")
}

/// Describes a value with its type.
fn described(value: Value) -> String {
    let noun = value.kind().noun();
    match value {
        Value::Color(color) => format!("{noun}: {}", about_color(color)),
        Value::Colors(colors) => {
            let [first, second] = colors.map(about_color);
            format!("{noun}: {first}\n\nand {second}")
        }
        Value::FaceColors(colors) => {
            let colors = colors.map(about_color);
            format!("{noun}: {}", colors.join("\n\nand "))
        }
        Value::Angle(angle) => {
            let degrees = Value::Angle(Angle::from_degrees(angle.in_degrees()));
            format!("{noun}: `{degrees}`, `{}rad`", short(angle.in_radians()))
        }
        Value::Number(_) | Value::Vector(_) | Value::Method(_) => format!("{noun}: `{value}`"),
    }
}

/// Describes a kind of block. For the camera, also describes its axes and its field of view.
fn kind(analysis: &Analysis<'_>, row: &BlockRow) -> String {
    let about = about_block(row);
    let facts = match row.kind {
        BlockKind::Camera => camera(analysis),
        _ => None,
    };
    match facts {
        Some(facts) => format!("{facts}\n\n{about}"),
        None => about,
    }
}

/// Describes the camera's axes, field of view and vanishing points, as `pinhole inspect` does.
/// Returns `None` if the camera or the image has errors.
fn camera(analysis: &Analysis<'_>) -> Option<String> {
    let parts = &analysis.model.parts;
    let (camera, points) = inspect::inspect_camera(parts.camera.as_ref()?, parts.image.as_ref()?);
    let summary = inspect::camera_summary(&camera, &points);
    Some(format!("```text\n{summary}```"))
}

/// Describes the object whose name is at the end of `path`, as `pinhole inspect` does. Returns
/// `None` if the path contains no block with a name.
fn object(analysis: &Analysis<'_>, path: &Path<'_, '_>) -> Option<String> {
    let block = path.block?;
    let (kind, name) = (block.kind?.text, block.name?.text);
    let objects = analysis.objects_of(block);
    Some(match objects {
        _ if block.repetition.is_some() => {
            let count = grouped(objects.len() as u64);
            let mut found = format!("`{name}`: {count} objects of the kind `{kind}`");
            if let [first, .., last] = objects {
                for object in [first, last] {
                    let name = object.name.as_deref().unwrap_or_default();
                    found += &format!("\n\n`{name}`: {}", object.shape.summary(vertices));
                }
            }
            found
        }
        [object] => format!("{kind} `{name}`: {}", object.shape.summary(vertices)),
        _ => format!("{kind} `{name}`"),
    })
}

/// Describes an index of a repeated block, such as `i` in `for i < 3`.
pub(super) fn about_index(analysis: &Analysis<'_>, index: &Index<'_>) -> String {
    let (name, count) = (index.name.text, shorten(analysis.slice(index.count.span)));
    format!(
        "`{name} < {count}`: an index, a whole number from 0 up to {count} - 1; the block stands for an object for each"
    )
}

/// Returns the index in `path.values` of the value that the hover describes. Usually this is the
/// last value, i.e. the innermost one. If the last value is a number, a list or a negation within
/// an operation or a call, the hover describes the innermost such operation or call instead.
/// Returns `None` if `path` contains no value.
fn depth_of_meaning(path: &Path<'_, '_>) -> Option<usize> {
    use ValueKind::{Call, Chain, Negation, Number, Parentheses, Tuple};
    let (value, around) = path.values.split_last()?;
    let is_part = matches!(
        value.kind,
        Number(_) | Tuple(_) | Parentheses(_) | Negation { .. }
    );
    let is_computed = |value: &&tree::Value<'_>| matches!(value.kind, Chain { .. } | Call(_));
    let computed = around.iter().rposition(is_computed);
    Some(computed.filter(|_| is_part).unwrap_or(around.len()))
}

/// Describes the value at the end of `path`, and its result. Returns `None` if the value has no
/// description, such as a number within a vector.
fn value<'s>(analysis: &Analysis<'s>, path: &Path<'_, 's>, token: RoleToken) -> Option<Hover> {
    let depth = depth_of_meaning(path)?;
    let value = *path.values.get(depth)?;
    let found = match depth {
        0 => analysis.value(value, path),
        _ => analysis.model.value(value, None),
    };
    let about = |span, markdown| Some(Hover { span, markdown });
    match &value.kind {
        ValueKind::Name(name) => {
            if let Some((_, index)) = analysis.index_at(name, value.span.start) {
                return about(value.span, about_index(analysis, index));
            }
            let definition = analysis.model.definition_at(name, value.span.start);
            if let Some(definition) = definition {
                return about(value.span, about_definition(analysis, definition));
            }
            if css::color(name).is_some() {
                return about(value.span, format!("`{name}` is {}", described(found?)));
            }
            let mut constants = schema::CONSTANTS.iter();
            let (name, _, help) = constants.find(|(constant, ..)| constant == name)?;
            about(value.span, format!("`{name}`: {help}"))
        }
        ValueKind::Call(call) if token.role == Role::Function => {
            let function = schema::function(call.function.text)?;
            let result = found.map(|found| format!("\n\nhere {}", described(found)));
            let markdown = about_function(function) + &result.unwrap_or_default();
            about(call.function.span, markdown)
        }
        ValueKind::Number(_) => {
            // The description of a number is that of its field. A number that is only a part of the
            // field's value, such as a component of a vector, has no description.
            let (row, field) = (path.row()?, path.field_row()?);
            if depth > 0 {
                return None;
            }
            about(value.span, about_field(row, field))
        }
        _ => {
            let written = shorten(analysis.slice(value.span));
            let is_literal = is_literal(value);
            let found = described(found?);
            about(
                value.span,
                if is_literal {
                    found
                } else {
                    format!("`{written}` is {found}")
                },
            )
        }
    }
}

/// Returns whether a value is a literal or a list of literals.
fn is_literal(value: &tree::Value<'_>) -> bool {
    match &value.kind {
        ValueKind::Number(_) | ValueKind::Angle { .. } | ValueKind::ColorCode(_) => true,
        ValueKind::Name(_) | ValueKind::Call(_) | ValueKind::Chain { .. } => false,
        _ => value.parts().into_iter().all(is_literal),
    }
}
