//! `--set TARGET=VALUE`.
//!
//! In: the arguments as they were typed, and the tree of the file. Out: the tree with their values in it. What a value is in its place is for lowering to find
//! out.

use super::{error::error, schema};
use crate::{
    diagnostic::Diagnostic,
    source::{SourceId, Sources, Span},
    suggest::{self, Budget},
    syntax::{
        self, shorten,
        tree::{Block, Field, Item, Name, Value},
    },
};

/// One argument.
#[derive(Clone, Debug)]
pub struct Override<'s> {
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
                overrides.push(Override { block, name, value });
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

/// Puts the values of the arguments into the items of a file, in the place of what stands there. Of several things of one name the first is meant.
pub fn apply<'s>(
    overrides: Vec<Override<'s>>,
    items: &mut Vec<Item<'s>>,
    budget: &Budget,
) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    for Override { block, name, value } in overrides {
        let Some(target) = block else {
            let found = items.iter_mut().find_map(|item| match item {
                Item::Definition(it) if it.name.is_some_and(|it| it.text == name.text) => Some(it),
                _ => None,
            });
            match found {
                Some(definition) => definition.value = value,
                None => problems.push(no_such_let(&name, items, budget)),
            }
            continue;
        };
        let setting = schema::block(target.text).filter(|row| !row.is_object);
        let has_target = |item: &Item<'s>| is_target(item, target.text, setting);
        let mut found = items.iter().position(has_target);
        if found.is_none() && setting.is_some() {
            found = Some(items.len());
            items.push(Item::Block(Block {
                kind: Some(target),
                open: Some(target.span),
                close: Some(target.span),
                ..Block::empty(target.span)
            }));
        }
        match found.and_then(|index| items.get_mut(index)) {
            Some(Item::Block(block)) => set_field(block, name, value),
            _ => problems.push(no_such_block(&target, items, budget)),
        }
    }
    problems
}

/// The row of a block; for a mistyped kind that of the nearest one.
fn row(block: &Block<'_>) -> Option<&'static schema::Block> {
    let kind = block.kind?.text;
    schema::block(kind).or_else(|| schema::nearest_block(kind))
}

fn is_target(item: &Item<'_>, target: &str, setting: Option<&schema::Block>) -> bool {
    let Item::Block(block) = item else {
        return false;
    };
    match (row(block), setting) {
        (Some(row), Some(setting)) => row.kind == setting.kind,
        (Some(row), None) => row.is_object && block.name.is_some_and(|name| name.text == target),
        _ => false,
    }
}

/// Gives a block a field, in the place of the same one and of those that it excludes.
fn set_field<'s>(block: &mut Block<'s>, name: Name<'s>, value: Value<'s>) {
    let excluded = row(block)
        .into_iter()
        .flat_map(|row| row.excludes(name.text));
    let excluded: Vec<&str> = excluded.collect();
    let stays =
        |field: &Field<'_>| field.name.text != name.text && !excluded.contains(&field.name.text);
    block.fields.retain(stays);
    let span = name.span;
    block.fields.push(Field { name, value, span });
}

/// The names of the objects, in order.
fn objects<'s>(items: &[Item<'s>]) -> Vec<&'s str> {
    let names = items.iter().filter_map(|item| match item {
        Item::Block(block) if row(block)?.is_object => Some(block.name?.text),
        _ => None,
    });
    names.collect()
}

/// What is wrong with a target whose block is neither in the file nor one that can be added.
fn no_such_block(block: &Name<'_>, items: &[Item<'_>], budget: &Budget) -> Diagnostic {
    let objects = objects(items);
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
fn no_such_let(name: &Name<'_>, items: &[Item<'_>], budget: &Budget) -> Diagnostic {
    let lets = items.iter().filter_map(|item| match item {
        Item::Definition(definition) => Some(definition.name?.text),
        Item::Block(_) | Item::Bad(_) => None,
    });
    let is_unnamed = |block: &schema::Block| !block.is_object;
    let is_block =
        schema::block(name.text).is_some_and(is_unnamed) || objects(items).contains(&name.text);
    let mut blocks = schema::BLOCKS.iter().filter(|block| !block.is_object);
    let of_block = blocks.find(|block| block.field(name.text).is_some());
    let near = || suggest::nearest(name.text, lets).map(str::to_owned);
    let meant = match of_block {
        _ if is_block => None,
        Some(block) => Some(format!("{}.{}", block.name, name.text)),
        None => budget.spend(items.len()).then(near).flatten(),
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
