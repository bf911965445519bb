//! What `--set` arguments change in the blocks.

use super::{Block, Given, Lowering, words::unknown_field};
use crate::scene::{
    overrides::{self, Override},
    schema,
};

impl<'s> Lowering<'s> {
    /// Of several overrides of one target, or of fields that exclude each other, only the last counts.
    pub(super) fn keep_last_overrides(&mut self) {
        let all = std::mem::take(&mut self.overrides);
        let mut kept: Vec<Override<'s>> = Vec::new();
        for next in all {
            kept.retain(|earlier| {
                let same_block = match (&earlier.block, &next.block) {
                    (Some(a), Some(b)) => a.text == b.text,
                    (None, None) => true,
                    _ => false,
                };
                let same = earlier.name.text == next.name.text;
                let excluded = next.block.is_some()
                    && schema::BLOCKS
                        .iter()
                        .filter_map(|row| row.field(next.name.text))
                        .any(|row| row.excludes.contains(&earlier.name.text));
                !(same_block && (same || excluded))
            });
            kept.push(next);
        }
        self.overrides = kept;
    }

    /// The fields of a block that an override replaces, alternatives included.
    pub(super) fn replaced_fields(&self, block: &Block<'s>) -> Vec<&'static str> {
        let mut replaced = Vec::new();
        for set in &self.overrides {
            if set
                .block
                .is_some_and(|target| is_target(block, target.text))
                && let Some(row) = block.row.field(set.name.text)
            {
                replaced.push(row.name);
                replaced.extend(row.excludes);
            }
        }
        replaced
    }

    /// Evaluates the overrides of fields, now that every name is defined.
    pub(super) fn override_fields(&mut self) {
        for set in self.overrides.clone() {
            let Some(target) = set.block else { continue };
            let addable = schema::block(target.text).filter(|row| !row.is_object);
            let mut index = self.blocks.iter().position(|b| is_target(b, target.text));
            if index.is_none()
                && let Some(row) = addable
            {
                index = Some(self.blocks.len());
                self.blocks.push(Block {
                    row,
                    keyword: target.span,
                    span: target.span,
                    name: None,
                    given: vec![None; row.fields.len()],
                    meant: Vec::new(),
                    unfinished: false,
                });
            }
            let Some(row) = index.and_then(|i| self.blocks.get(i)).map(|b| b.row) else {
                continue;
            };
            let at = row
                .fields
                .iter()
                .position(|field| field.name == set.name.text);
            let Some((at, field)) = at.and_then(|at| Some((at, row.fields.get(at)?))) else {
                self.problems.push(unknown_field(row, &set.name));
                continue;
            };
            let value = self.typed(field, &set.value);
            let given = Given {
                name: set.name.span,
                span: set.value.span,
                value,
            };
            let block = index.and_then(|index| self.blocks.get_mut(index));
            if let Some(slot) = block.and_then(|block| block.given.get_mut(at)) {
                *slot = Some(given);
            }
        }
    }

    /// Reports overrides whose target does not exist.
    pub(super) fn override_targets(&mut self) {
        if self.overrides.is_empty() {
            return;
        }
        let objects: Vec<&str> = self
            .blocks
            .iter()
            .filter_map(|b| Some(b.name?.text))
            .collect();
        let mut lets: Vec<&str> = self.names.all().collect();
        lets.sort_unstable();
        for set in &self.overrides {
            let problem = match &set.block {
                Some(block) => {
                    let found = self.blocks.iter().any(|b| is_target(b, block.text));
                    (!found).then(|| overrides::no_such_block(block, &objects))
                }
                None => {
                    let found = self.names.knows(set.name.text);
                    (!found).then(|| overrides::no_such_let(&set.name, &lets, &objects))
                }
            };
            self.problems.extend(problem);
        }
    }
}

fn is_target(block: &Block<'_>, target: &str) -> bool {
    match block.name {
        _ if !block.row.is_object => block.row.name == target,
        Some(name) => name.text == target,
        None => false,
    }
}
