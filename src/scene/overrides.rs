//! `--set TARGET=VALUE`.
//!
//! In: the arguments as they were typed. Out: what each names, and the tree of its value. Whether there is such a target,
//! and what the value is there, is for lowering to find out.

use super::{
    error::{Found, Problem},
    fix, schema,
};
use crate::{
    diagnostic::Diagnostic,
    source::{SourceId, Sources, Span},
    suggest::{self, Budget},
    syntax::{
        self, shorten,
        tree::{Name, Value},
    },
};

/// One argument.
#[derive(Clone, Debug)]
pub struct Override<'s> {
    /// Which argument it is.
    pub id: SourceId,
    /// The block, of `BLOCK.FIELD`.
    pub block: Option<Name<'s>>,
    /// The field, or the name of a `let`.
    pub name: Name<'s>,
    /// What it is to be.
    pub value: Value<'s>,
}

/// Reads the arguments.
pub fn read<'s>(sources: &'s Sources, diagnostics: &mut Vec<Diagnostic>) -> Vec<Override<'s>> {
    let mut overrides: Vec<Override<'s>> = Vec::new();
    for (id, source) in sources.sets() {
        match one(source.text(), id) {
            Err(problem) => diagnostics.push(Found::from(*problem).diagnostic(sources)),
            Ok((block, name, start)) => {
                let (value, problems) = syntax::parse_value(source, id, start);
                diagnostics.extend(problems);
                overrides.push(Override {
                    id,
                    block,
                    name,
                    value,
                });
            }
        }
    }
    overrides
}

/// The block, the field or `let`, and where the value starts.
fn one(text: &str, id: SourceId) -> Result<(Option<Name<'_>>, Name<'_>, usize), Box<Problem>> {
    let whole = Span::new(id, 0, text.len());
    let Some((target, value)) = text.split_once('=') else {
        return Err(Box::new(Problem::SetWithoutEquals { span: whole }));
    };
    let bad = || {
        let start = target.len() - target.trim_start().len();
        let end = target.trim_end().len().max(start);
        let written = shorten(target);
        let span = match written.is_empty() {
            true => Span::new(id, 0, target.len() + 1),
            false => Span::new(id, start, end),
        };
        let message = match written.is_empty() {
            true => "nothing is named before this `=`".to_owned(),
            false => format!("`{written}` cannot be set"),
        };
        Box::new(Problem::BadTarget { message, span })
    };
    let (block, name) = match target.split_once('.') {
        Some((block, field)) => {
            let block_name = name(block, 0, id).ok_or_else(bad)?;
            let field = name(field, block.len() + 1, id).ok_or_else(bad)?;
            (Some(block_name), field)
        }
        None => (None, name(target, 0, id).ok_or_else(bad)?),
    };
    if value.trim().is_empty() {
        let span = Span::new(id, target.len(), target.len() + 1);
        return Err(Box::new(Problem::SetWithoutValue { span }));
    }
    Ok((block, name, target.len() + 1))
}

fn name(text: &str, start: usize, id: SourceId) -> Option<Name<'_>> {
    let trimmed = text.trim();
    let start = start + text.len() - text.trim_start().len();
    let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let starts_well = !trimmed.starts_with(|c: char| c.is_ascii_digit());
    let is_name = !trimmed.is_empty() && starts_well && trimmed.chars().all(letters);
    (is_name && trimmed != "let").then(|| Name {
        text: trimmed,
        span: Span::new(id, start, start + trimmed.len()),
    })
}

/// What is wrong with a target whose block is neither in the file nor one that can be added.
pub fn no_such_block(block: &Name<'_>, objects: &[&str], budget: &Budget) -> Found {
    let listed = |names: &[&str]| match names.len() {
        0 => "The scene's objects have no names.".to_owned(),
        1..=8 => format!("The scene has {}.", suggest::list(names.iter().copied())),
        count => format!("The scene has {count} named objects."),
    };
    let blocks = schema::BLOCKS.iter().filter(|block| !block.is_object);
    let blocks = blocks.map(|block| block.name);
    let near = match budget.spend(objects.len() + schema::BLOCKS.len()) {
        true => suggest::nearest(block.text, objects.iter().copied().chain(blocks)),
        false => None,
    };
    let kind = schema::block(block.text).filter(|kind| kind.is_object);
    let help = match (kind, near) {
        (Some(kind), _) => format!(
            "an object is set by its own name, such as `{} Big {{ … }}` by `Big.FIELD`. {}",
            kind.name,
            listed(objects)
        ),
        (None, Some(near)) if objects == [near] => format!("did you mean `{near}`?"),
        (None, Some(near)) => format!("did you mean `{near}`? {}", listed(objects)),
        (None, None) => format!(
            "{} image, camera and sampler can be set too",
            listed(objects)
        ),
    };
    Problem::NoSuchTarget {
        message: format!("there is no object named `{}`", block.text),
        help,
        span: block.span,
        label: "no object, and not image, camera or sampler",
    }
    .with(fix::written(block.span, near.filter(|_| kind.is_none())))
}

/// What is wrong with a target that is no `let` of the file, but may be a block.
pub fn no_such_let(name: &Name<'_>, lets: &[&str], is_block: bool, budget: &Budget) -> Found {
    let fields = schema::BLOCKS.iter().filter(|block| !block.is_object);
    let of_block = fields
        .filter(|block| block.field(name.text).is_some())
        .map(|block| block.name)
        .next();
    let near = match budget.spend(lets.len()) {
        true => suggest::nearest(name.text, lets.iter().copied()),
        false => None,
    };
    let meant = match of_block {
        Some(block) => Some(format!("{block}.{}", name.text)),
        None => near.map(str::to_owned),
    };
    let help = match (near, of_block) {
        _ if is_block => format!("name a field of it as well: `{}.FIELD=…`", name.text),
        (_, Some(block)) => format!("did you mean `{block}.{}`?", name.text),
        (Some(near), None) => format!("did you mean `{near}`?"),
        (None, None) => match lets.len() {
            0 => "the scene defines no names; a field is set by `BLOCK.FIELD=…`".to_owned(),
            1..=8 => format!("the scene defines {}", suggest::list(lets.iter().copied())),
            _ => "a field is set by `BLOCK.FIELD=…`".to_owned(),
        },
    };
    Problem::NoSuchTarget {
        message: format!("the scene defines no `{}`", name.text),
        help,
        span: name.span,
        label: "no `let` of this name",
    }
    .with(fix::written(name.span, meant.filter(|_| !is_block)))
}
