//! What `--set` arguments change in the blocks.

use std::collections::HashSet;

use super::{Block, Given, Lowering};
use crate::scene::{
    overrides::{self, Override},
    schema,
};

impl<'s> Lowering<'s> {
    /// The fields of a block that an override replaces, alternatives included. Of several blocks of one name it is the first
    /// that is meant.
    pub(super) fn replaced_fields(&self, block: &Block<'s>) -> Vec<&'static str> {
        let mut replaced = Vec::new();
        let target = target(block).filter(|target| !self.first_blocks.contains_key(target));
        if target.is_none() || self.overrides.is_empty() {
            return replaced;
        }
        for row in block.row.fields {
            if self.targets.contains_key(&(target, row.name)) {
                replaced.push(row.name);
                replaced.extend(block.row.excludes(row.name));
            }
        }
        replaced
    }

    /// Adds a block, the first of its name or not. An object is built at once if no argument can change it.
    pub(super) fn push(&mut self, block: Block<'s>) {
        self.has_objects |= block.row.is_object;
        if block.row.is_object && !self.sets_by_name {
            self.build_object(&block);
            return;
        }
        if let Some(target) = target(&block) {
            let index = self.blocks.len();
            self.first_blocks.entry(target).or_insert(index);
        }
        self.blocks.push(block);
    }

    /// Sets what the overrides set, now that every name is defined.
    pub(super) fn override_blocks(&mut self) {
        self.override_fields();
        self.override_targets();
    }

    /// Of several overrides of one field, or of fields that exclude each other, only the last counts.
    fn override_fields(&mut self) {
        let overrides = std::mem::take(&mut self.overrides);
        let mut later = HashSet::new();
        for set in overrides.iter().rev() {
            let Some(target) = set.block else { continue };
            let addable = schema::block(target.text).filter(|row| !row.is_object);
            if !self.first_blocks.contains_key(target.text)
                && let Some(row) = addable
            {
                self.push(Block {
                    row,
                    keyword: target.span,
                    span: target.span,
                    name: None,
                    given: vec![None; row.fields.len()],
                    meant: Vec::new(),
                    unfinished: false,
                });
            }
            let index = self.first_blocks.get(target.text).copied();
            let Some(row) = index.and_then(|i| self.blocks.get(i)).map(|b| b.row) else {
                continue;
            };
            if !later.insert((target.text, set.name.text)) {
                continue;
            }
            let others = row.excludes(set.name.text);
            later.extend(others.map(|other| (target.text, other)));
            let mut fields = row.fields.iter().enumerate();
            let Some((at, field)) = fields.find(|(_, field)| field.name == set.name.text) else {
                let blocks = std::mem::take(&mut self.blocks);
                if let Some(block) = index.and_then(|index| blocks.get(index)) {
                    self.unknown_target(block, &set.name, &set.value);
                }
                self.blocks = blocks;
                continue;
            };
            let value = self.typed(field, &set.value);
            let given = Given::new(set.name.span, &set.value, value);
            let block = index.and_then(|index| self.blocks.get_mut(index));
            if let Some(slot) = block.and_then(|block| block.given.get_mut(at)) {
                *slot = Some(given);
            }
        }
        self.overrides = overrides;
    }

    /// Reports overrides whose target does not exist.
    fn override_targets(&mut self) {
        // All other targets are there, or were added.
        if !self.sets_by_name {
            return;
        }
        let objects: Vec<&str> = self
            .blocks
            .iter()
            .filter_map(|b| Some(b.name?.text))
            .collect();
        let mut lets: Vec<&str> = self.names.all().collect();
        lets.sort_unstable();
        let budget = self.names.budget();
        for set in &self.overrides {
            let problem = match &set.block {
                Some(block) => {
                    let found = self.first_blocks.contains_key(block.text);
                    (!found).then(|| overrides::no_such_block(block, &objects, budget))
                }
                None => {
                    let name = &set.name;
                    let is_block = self.first_blocks.contains_key(name.text)
                        || schema::block(name.text).is_some();
                    let found = self.names.definition(name.text).is_some();
                    (!found).then(|| overrides::no_such_let(name, &lets, is_block, budget))
                }
            };
            self.problems.extend(problem);
        }
    }
}

/// Whether an argument names what it sets by a name of the file: a `let`, or an object.
pub(super) fn is_by_name(set: &Override<'_>) -> bool {
    set.block
        .is_none_or(|block| schema::block(block.text).is_none_or(|row| row.is_object))
}

/// The name by which `--set` names a block.
fn target<'s>(block: &Block<'s>) -> Option<&'s str> {
    if !block.row.is_object {
        return Some(block.row.name);
    }
    let is_reserved = |name: &str| schema::block(name).is_some_and(|row| !row.is_object);
    block.name.map(|name| name.text).filter(|n| !is_reserved(n))
}
