//! `--set TARGET=VALUE`.
//!
//! In: the arguments as they were typed. Out: what each names, and the tree of its value. Whether there is such a target,
//! and what the value is there, is for lowering to find out.

use super::{error::error, schema};
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
            Err(problem) => diagnostics.push(*problem),
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
fn one(text: &str, id: SourceId) -> Result<(Option<Name<'_>>, Name<'_>, usize), Box<Diagnostic>> {
    let Some((target, value)) = text.split_once('=') else {
        let help = "write TARGET=VALUE, such as `--set camera.roll=30deg` or `--set h=1.5`";
        return Err(Box::new(
            error("bad_set", "this `--set` has no `=`")
                .at(
                    Span::new(id, 0, text.len()),
                    "a target, `=` and a value should stand here",
                )
                .help(help),
        ));
    };
    let bad = || {
        let message = match shorten(target).as_str() {
            "" => "nothing is named before this `=`".to_owned(),
            written => format!("`{written}` cannot be set"),
        };
        let help = "a target is `BLOCK.FIELD`, such as `camera.roll`, or the name of a `let`";
        let span = Span::new(id, 0, target.len().max(1));
        Box::new(
            error("bad_target", message)
                .at(span, "not a target")
                .help(help),
        )
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
        return Err(Box::new(
            error("missing_value", "this `--set` gives no value")
                .at(span, "a value should follow")
                .help("write a value after the `=`"),
        ));
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
pub fn no_such_block(block: &Name<'_>, objects: &[&str], budget: &Budget) -> Diagnostic {
    let blocks = schema::BLOCKS.iter().filter(|block| !block.is_object);
    let names = objects
        .iter()
        .copied()
        .chain(blocks.map(|block| block.name));
    let near = budget.spend(objects.len() + schema::BLOCKS.len());
    let near = near.then(|| suggest::nearest(block.text, names)).flatten();
    let known = match objects.len() {
        0 => "The scene's objects have no names.".to_owned(),
        1..=8 => format!("The scene has {}.", suggest::list(objects.iter().copied())),
        count => format!("The scene has {count} named objects."),
    };
    let message = format!("there is no object named `{}`", block.text);
    error("no_such_target", message)
        .at(block.span, "no object, and not image, camera or sampler")
        .help(match near {
            Some(near) if objects == [near] => format!("did you mean `{near}`?"),
            Some(near) => format!("did you mean `{near}`? {known}"),
            None => format!("{known} image, camera and sampler can be set too"),
        })
        .writing(block.span, near)
}

/// What is wrong with a target that is no `let` of the file, but may be a block.
pub fn no_such_let(name: &Name<'_>, lets: &[&str], is_block: bool, budget: &Budget) -> Diagnostic {
    let mut blocks = schema::BLOCKS.iter().filter(|block| !block.is_object);
    let of_block = blocks.find(|block| block.field(name.text).is_some());
    let near = || suggest::nearest(name.text, lets.iter().copied()).map(str::to_owned);
    let meant = match of_block {
        _ if is_block => None,
        Some(block) => Some(format!("{}.{}", block.name, name.text)),
        None => budget.spend(lets.len()).then(near).flatten(),
    };
    let message = format!("the scene defines no `{}`", name.text);
    error("no_such_target", message)
        .at(name.span, "no `let` of this name")
        .help(match &meant {
            _ if is_block => format!("name a field of it as well: `{}.FIELD=…`", name.text),
            Some(meant) => format!("did you mean `{meant}`?"),
            None => "name a `let` of the scene, or a field by `BLOCK.FIELD=…`".to_owned(),
        })
        .writing(name.span, meant)
}
