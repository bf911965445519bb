//! Replaces values of a scene by those of `--set TARGET=VALUE` arguments.
//!
//! In: the arguments as they were typed, and all or some items of the file. Out: the items with the
//! new values, which are evaluated later.

use super::{
    error::error,
    eval::{Names, suits, value_of},
};
use crate::{
    diagnostic::{Applicability, Diagnostic, Problems},
    schema,
    source::{SourceId, Sources, Span},
    suggest::{self, ComparisonBudget},
    syntax::{
        self, shorten,
        tree::{Block, Field, Item, Name, Value},
    },
};

/// A `--set TARGET=VALUE` argument of the command line.
#[derive(Clone, Debug)]
pub struct Override<'s> {
    /// The block of a target `BLOCK.FIELD`; `None` if the target is a `let`.
    pub block: Option<Name<'s>>,
    /// The field of a target `BLOCK.FIELD`, or the name of a `let`.
    pub name: Name<'s>,
    /// The new value.
    pub value: Value<'s>,
}

/// Parses the `--set` arguments. Adds problems to `diagnostics` and leaves out arguments that
/// cannot be used.
pub fn read<'s>(
    sources: &'s Sources,
    diagnostics: &mut impl Extend<Diagnostic>,
) -> Vec<Override<'s>> {
    let mut overrides: Vec<Override<'s>> = Vec::new();
    for (id, source) in sources.sets() {
        match one(source.text(), id) {
            Err(problem) => diagnostics.extend([*problem]),
            Ok((block, name, start)) => {
                let (value, problems) = syntax::parse_value(source, id, start);
                diagnostics.extend(problems);
                overrides.push(Override { block, name, value });
            }
        }
    }
    overrides
}

/// Splits the argument `text`, such as `camera.roll=30deg`, into three parts: the block, or `None`
/// if the target is a `let`; the name of the field or of the `let`; and the offset of the value.
///
/// # Errors
///
/// Returns a diagnostic if the text has no `=`, no valid target or no value.
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
        let help = match target.split_once('[') {
            Some((block, rest)) => {
                let field = rest.split_once('.').map_or("color", |(_, field)| field);
                format!(
                    "objects with indices are set as a whole: `{}`",
                    shorten(&format!("{block}.{field}"))
                )
            }
            None => "a target is `BLOCK.FIELD`, such as `camera.roll`, or the name of a `let`"
                .to_owned(),
        };
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

/// Returns the name in `text`, which is a part of the argument and starts at its offset `start`.
/// Returns `None` if the text is not a name.
fn name(text: &str, start: usize, id: SourceId) -> Option<Name<'_>> {
    let trimmed = text.trim();
    let start = start + text.len() - text.trim_start().len();
    (syntax::is_name(trimmed) && trimmed != "let").then(|| Name {
        text: trimmed,
        span: Span::new(id, start, start + trimmed.len()),
    })
}

/// Replaces values in `items` by those of the arguments. Removes an argument from `overrides` when
/// its target is found. If several items have the target's name, changes only the first.
pub fn apply<'s>(overrides: &mut Vec<Override<'s>>, items: &mut [Item<'s>]) {
    overrides.retain(|it| !it.put_into(items));
}

/// Handles the arguments whose targets the file does not have. If a target is a field of the image,
/// the camera or the sampler, adds this block to `items`. Reports all other arguments.
pub fn add<'s>(
    overrides: Vec<Override<'s>>,
    items: &mut Vec<Item<'s>>,
    sources: &'s Sources,
    budget: &ComparisonBudget,
) -> Problems {
    let mut problems = Problems::default();
    for it in overrides {
        match it.block {
            // A preceding argument may have added the block to which this argument belongs.
            _ if it.put_into(items) => {}
            None => problems.push(no_such_let(&it, items, sources, budget)),
            Some(target) if setting(target.text).is_some() => {
                let mut block = Block {
                    open: Some(target.span),
                    close: Some(target.span),
                    ..Block::new(target.span, Some(target), None)
                };
                set_field(&mut block, it.name, it.value);
                items.push(Item::Block(block));
            }
            Some(target) => problems.push(no_such_block(&it, &target, items, sources, budget)),
        }
    }
    problems
}

/// Returns whether an item is a block with a field that a `--set` argument changed.
pub fn is_set(item: &Item<'_>) -> bool {
    let Item::Block(block) = item else {
        return false;
    };
    let mut fields = block.fields.iter();
    fields.any(|field| field.span.source != SourceId::File)
}

impl<'s> Override<'s> {
    /// Replaces the value of the target if the target is among `items`. Returns whether the target
    /// was found.
    fn put_into(&self, items: &mut [Item<'s>]) -> bool {
        let setting = self.block.and_then(|block| setting(block.text));
        for item in items {
            match (item, self.block) {
                (Item::Definition(it), None)
                    if it.name.is_some_and(|name| name.text == self.name.text) =>
                {
                    it.value = self.value.clone();
                    return true;
                }
                (Item::Block(block), Some(target)) if is_target(block, target.text, setting) => {
                    set_field(block, self.name, self.value.clone());
                    return true;
                }
                _ => {}
            }
        }
        false
    }

    /// Returns whether the argument's value has no errors if it is assigned to `place`. If `place`
    /// is a field (`Ok`), the value must also meet the field's conditions. If `place` is the name
    /// of a `let` (`Err`), the value may use only names defined before this `let`. Returns `false`
    /// without a check if `budget`, the remaining number of name comparisons, is less than the
    /// number of items.
    fn suits(
        &self,
        place: Result<&schema::FieldRow, &str>,
        items: &[Item<'s>],
        sources: &'s Sources,
        budget: &ComparisonBudget,
    ) -> bool {
        if !budget.spend(items.len()) {
            return false;
        }
        let mut names = Names::default();
        let definitions = items.iter().filter_map(|item| match item {
            Item::Definition(definition) => Some((definition.name?, &definition.value)),
            Item::Block(_) | Item::Bad(_) => None,
        });
        let own = place.err();
        for (name, value) in definitions.take_while(|(name, _)| own != Some(name.text)) {
            let known = value_of(value, None, sources, &names);
            names.define(name, known, value);
        }
        match place {
            Ok(field) => suits(field, &self.value, sources, &names),
            Err(_) => value_of(&self.value, None, sources, &names).is_some(),
        }
    }
}

/// Returns the row of the field `name` in the language's table. `block` is the kind of the block or
/// an object's name. Returns `None` if there is no such block or field.
fn field(block: &str, name: &str, items: &[Item<'_>]) -> Option<&'static schema::FieldRow> {
    let object = || {
        items.iter().find_map(|item| match item {
            Item::Block(it) if it.name?.text == block => row(it),
            _ => None,
        })
    };
    setting(block).or_else(object)?.field(name)
}

/// Returns the row of the image, the camera or the sampler in the language's table. Returns `None`
/// if `name` is not one of these three keywords.
fn setting(name: &str) -> Option<&'static schema::BlockRow> {
    schema::block(name).filter(|row| !row.is_object)
}

/// Returns the row of a block's kind in the language's table. A mistyped kind stands for the
/// nearest one. Returns `None` if the kind is missing, or if no kind is similar to it.
fn row(block: &Block<'_>) -> Option<&'static schema::BlockRow> {
    schema::block_or_nearest(block.kind?.text)
}

/// Returns whether a `--set` argument for `target` sets fields of `block`. If `target` is the
/// keyword of a block that is not an object, such as `camera`, `setting` is the schema's row for
/// this keyword. Otherwise, `target` is an object's name.
fn is_target(block: &Block<'_>, target: &str, setting: Option<&schema::BlockRow>) -> bool {
    match (row(block), setting) {
        (Some(row), Some(setting)) => row.kind == setting.kind,
        (Some(row), None) => row.is_object && block.name.is_some_and(|name| name.text == target),
        _ => false,
    }
}

/// Sets a field of a block. Removes the field's old value, and all fields that exclude the field.
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

/// Returns the names of the objects, in the order of the file.
fn objects<'s>(items: &[Item<'s>]) -> Vec<&'s str> {
    let names = items.iter().filter_map(|item| match item {
        Item::Block(block) if row(block)?.is_object => Some(block.name?.text),
        _ => None,
    });
    names.collect()
}

/// Help text for a `--set` target that the scene does not have. It says which targets are possible.
const OTHERS: &str = "name a `let` of the scene, or a field by `BLOCK.FIELD=…`";

/// Maximum number of names that a help text lists. If there are more, the help lists none of them,
/// since nobody would read a longer list.
const FEW: usize = 8;

/// Returns the error for a `--set` target whose block is not in the file and cannot be added.
fn no_such_block<'s>(
    it: &Override<'s>,
    block: &Name<'s>,
    items: &[Item<'s>],
    sources: &'s Sources,
    budget: &ComparisonBudget,
) -> Diagnostic {
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
        1..=FEW => format!("The scene has {}.", suggest::list(objects.iter().copied())),
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
        .writing(
            block.span,
            Applicability::Unsafe,
            near.filter(|near| {
                let field = field(near, it.name.text, items);
                field.is_some_and(|field| it.suits(Ok(field), items, sources, budget))
            }),
        )
}

/// Returns the error that the scene has no `let` with the name of a target. The help also covers a
/// target that was meant as a block or a field.
fn no_such_let<'s>(
    it: &Override<'s>,
    items: &[Item<'s>],
    sources: &'s Sources,
    budget: &ComparisonBudget,
) -> Diagnostic {
    let name = &it.name;
    let lets = items.iter().filter_map(|item| match item {
        Item::Definition(definition) => Some(definition.name?.text),
        Item::Block(_) | Item::Bad(_) => None,
    });
    let few: Vec<&str> = lets.clone().take(FEW + 1).collect();
    let known = match few.len() {
        1..=FEW => format!(" It defines {}.", suggest::list(few.iter().copied())),
        _ => String::new(),
    };
    let is_block = setting(name.text).is_some() || objects(items).contains(&name.text);
    let mut blocks = schema::BLOCKS.iter().filter(|block| !block.is_object);
    let of_block = blocks.find(|block| block.field(name.text).is_some());
    let near = || suggest::nearest_name(name.text, lets).map(str::to_owned);
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
            Some(meant) if few == [meant.as_str()] => format!("did you mean `{meant}`?"),
            Some(meant) => format!("did you mean `{meant}`?{known}"),
            None if known.is_empty() => OTHERS.to_owned(),
            None => format!("{OTHERS}.{known}"),
        })
        .writing(
            name.span,
            Applicability::Unsafe,
            meant.filter(|meant| {
                let field = of_block.and_then(|block| block.field(name.text));
                it.suits(field.ok_or(meant), items, sources, budget)
            }),
        )
}
