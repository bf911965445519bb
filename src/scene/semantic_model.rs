//! A scene as far as it can be told: for editors, which show what is there while the rest is being
//! typed.
//!
//! In: what lowering read. Out: the tree beside what it means, and the value of any part of it.

use std::sync::Arc;

use super::{
    eval::{Evaluator, Names},
    model::{Camera, Image, Object, Sampler, Scene},
};
use crate::{
    diagnostic::{Diagnostic, Problems},
    schema::{Type, Value},
    source::Sources,
    syntax::{
        Parsed,
        tree::{self, Definition, Item},
    },
};

/// The parts of a scene; those that failed are missing.
#[derive(Clone, Debug)]
pub struct Parts {
    /// The picture.
    pub image: Option<Image>,
    /// The camera.
    pub camera: Option<Camera>,
    /// The samples.
    pub sampler: Option<Sampler>,
    /// The objects, those that did not fail, in the order of the file.
    pub objects: Vec<Object>,
}

impl Parts {
    /// The scene, if no part is missing.
    pub fn into_scene(self) -> Option<Scene> {
        Some(Scene {
            image: self.image?,
            camera: self.camera?,
            sampler: self.sampler?,
            objects: Arc::new(self.objects),
        })
    }
}

/// A text with everything that is known of it.
#[derive(Debug)]
pub struct SemanticModel<'s> {
    pub(super) sources: &'s Sources,
    /// The tree and the comments.
    pub parsed: Parsed<'s>,
    /// Errors and warnings, the same as [`super::read`] gives.
    pub diagnostics: Vec<Diagnostic>,
    /// What it means.
    pub parts: Parts,
    pub(super) names: Names<'s>,
}

impl<'s> SemanticModel<'s> {
    /// The texts.
    pub fn sources(&self) -> &'s Sources {
        self.sources
    }

    /// The definitions of the file, in order.
    pub fn definitions(&self) -> impl Iterator<Item = &Definition<'s>> {
        self.parsed.tree.items.iter().filter_map(|item| match item {
            Item::Definition(definition) => Some(definition),
            Item::Block(_) | Item::Bad(_) => None,
        })
    }

    /// The definition that a name means at a place: one that stands before it, and is the first of
    /// its name.
    pub fn definition_at(&self, name: &str, at: usize) -> Option<&Definition<'s>> {
        let place = self.names.place(name)?;
        let items = &self.parsed.tree.items;
        let next = items.partition_point(|item| item.span().end <= place.start);
        let found = match items.get(next) {
            Some(Item::Definition(definition)) => Some(definition),
            _ => None,
        };
        found.filter(|definition| definition.span.end <= at)
    }

    /// The value that a definition gives its name; none if it failed, or is not the first of its
    /// name.
    pub fn defined(&self, definition: &Definition<'s>) -> Option<Value> {
        let name = definition.name?;
        let is_first = self.names.place(name.text) == Some(name.span);
        is_first.then(|| self.names.value(name.text)).flatten()
    }

    /// What a value of the tree is; `wanted` is the type that would fit, if one is known. None if
    /// it failed, or means nothing by itself, such as the word of a method.
    pub fn value(&self, value: &tree::Value<'s>, wanted: Option<Type>) -> Option<Value> {
        let mut problems = Problems::default();
        let mut evaluator = Evaluator {
            sources: self.sources,
            names: &self.names,
            problems: &mut problems,
        };
        evaluator.value(value, wanted)
    }
}
