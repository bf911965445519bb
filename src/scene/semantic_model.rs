//! The meaning of a scene that may have errors. Editors use it to show the correct parts of a scene
//! while other parts are being typed.
//!
//! In: the tree of a file, the parts of the scene that could be built from the tree, and the
//! defined names. Out: the tree, the parts of the scene, and the value of any expression in the
//! tree.

use std::sync::Arc;

use super::{
    eval::{Names, value_of},
    model::{Camera, Image, Object, Sampler, Scene},
};
use crate::{
    diagnostic::Diagnostic,
    schema::{Type, Value},
    source::Sources,
    syntax::{
        Parsed,
        tree::{self, Definition, Item},
    },
};

/// Parts of a scene. An image, camera or sampler with errors is `None`, and an object with errors
/// is left out.
#[derive(Clone, Debug)]
pub struct Parts {
    /// The picture's size and background.
    pub image: Option<Image>,
    /// The camera.
    pub camera: Option<Camera>,
    /// The sampler.
    pub sampler: Option<Sampler>,
    /// The objects without errors, in the order of the file.
    pub objects: Vec<Object>,
}

impl Parts {
    /// Returns the scene, if no part is missing.
    pub fn into_scene(self) -> Option<Scene> {
        Some(Scene {
            image: self.image?,
            camera: self.camera?,
            sampler: self.sampler?,
            objects: Arc::new(self.objects),
        })
    }
}

/// A text with its tree, its problems and its meaning.
#[derive(Debug)]
pub struct SemanticModel<'s> {
    pub(super) sources: &'s Sources,
    /// The tree and the comments.
    pub parsed: Parsed<'s>,
    /// The errors and warnings that [`super::read`] returns.
    pub diagnostics: Vec<Diagnostic>,
    /// The parts of the scene.
    pub parts: Parts,
    pub(super) names: Names<'s>,
}

impl<'s> SemanticModel<'s> {
    /// Returns the file and the `--set` arguments.
    pub fn sources(&self) -> &'s Sources {
        self.sources
    }

    /// Returns the definitions of the file, in order.
    pub fn definitions(&self) -> impl Iterator<Item = &Definition<'s>> {
        self.parsed.tree.items.iter().filter_map(|item| match item {
            Item::Definition(definition) => Some(definition),
            Item::Block(_) | Item::Bad(_) => None,
        })
    }

    /// Returns the definition that `name` refers to at the offset `at`: the first definition of
    /// that name, if it stands before `at`.
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

    /// Returns the value of a definition. Returns `None` if it has errors, or if an earlier
    /// definition has the same name.
    pub fn defined(&self, definition: &Definition<'s>) -> Option<Value> {
        let name = definition.name?;
        let is_first = self.names.place(name.text) == Some(name.span);
        is_first.then(|| self.names.value(name.text)).flatten()
    }

    /// Evaluates an expression of the tree; `wanted` is the type that the context requires, if it
    /// is known. Returns `None` if the expression has errors, or has no value by itself, such as
    /// the name of a sampling method.
    pub fn value(&self, value: &tree::Value<'s>, wanted: Option<Type>) -> Option<Value> {
        value_of(value, wanted, self.sources, &self.names)
    }
}
