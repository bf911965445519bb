//! A version of a text as its picture needs it: the scene, and the worlds that pictures and rays
//! ask.
//!
//! All is made once for a version, so that a pick in a scene of 100 000 spheres reads none of them
//! again.

use std::collections::VecDeque;

use crate::{
    editor::{
        Analysis,
        viewport::{self, selections},
    },
    scene::Scene,
    source::{Sources, Span},
    tracer::World,
};

/// Worlds are kept for so many sizes: the picture's own, and those of the frames that are shown
/// until it is done.
const WORLDS: usize = 4;

/// A version of a text that has a picture.
#[derive(Debug)]
pub struct SceneVersion {
    /// Which version it is, as the client counts.
    pub number: i32,
    /// What it means.
    pub scene: Scene,
    /// For each object the name or the keyword that stands for it.
    pub selections: Vec<Span>,
    worlds: VecDeque<(u32, World)>,
    /// The text with the object that was dragged last alone.
    alone: Option<(Option<usize>, Sources)>,
}

impl SceneVersion {
    /// None where the text has errors.
    pub fn new(analysis: &Analysis<'_>, number: i32) -> Option<Self> {
        let scene = analysis.scene()?;
        Some(Self {
            number,
            selections: selections(analysis, &scene),
            scene,
            worlds: VecDeque::new(),
            alone: None,
        })
    }

    /// The scene, and its world for a picture of which width and height are divided by `scale`.
    pub fn world(&mut self, scale: u32) -> (&Scene, &World) {
        let found = self.worlds.iter().position(|(known, _)| *known == scale);
        let index = found.unwrap_or_else(|| {
            if self.worlds.len() == WORLDS {
                self.worlds.pop_front();
            }
            let world = match scale {
                1 => World::new(&self.scene),
                _ => {
                    let mut scaled = self.scene.clone();
                    (scaled.image.width, scaled.image.height) = self.size(scale);
                    World::new(&scaled)
                }
            };
            self.worlds.push_back((scale, world));
            self.worlds.len() - 1
        });
        (&self.scene, &self.worlds[index].1)
    }

    /// The text with an object alone, or with none, by which drags are read: each step asks for it.
    pub fn alone(&mut self, sources: &Sources, object: Option<usize>) -> (&Scene, &Sources) {
        let known = self.alone.take_if(|(known, _)| *known == object);
        let made = || (object, viewport::alone(sources, &self.scene, object));
        let (_, alone) = self.alone.insert(known.unwrap_or_else(made));
        (&self.scene, alone)
    }

    /// Width and height divided by `scale`, rounded up.
    pub fn size(&self, scale: u32) -> (u32, u32) {
        let image = &self.scene.image;
        (image.width.div_ceil(scale), image.height.div_ceil(scale))
    }
}
