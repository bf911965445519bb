//! The scene of a version of a text, and the worlds by which its pictures and rays are traced.
//!
//! Everything is computed once for a version, so that a pick in a scene of 100 000 spheres reads
//! none of them again.

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

/// Maximum number of picture sizes whose worlds are kept: the picture's own size, and those of the
/// coarse frames that are shown until it is finished.
const WORLDS: usize = 4;

/// A version of a text without errors.
#[derive(Debug)]
pub struct SceneVersion {
    /// The version's number, as the client counts.
    pub number: i32,
    /// The scene.
    pub scene: Scene,
    /// For each object, the span of its name or keyword.
    pub selections: Vec<Span>,
    worlds: VecDeque<(u32, World)>,
    /// The text with only the object that was dragged last.
    alone: Option<(Option<usize>, Sources)>,
}

impl SceneVersion {
    /// Makes the version of a text; `None` if it has errors.
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

    /// Returns the scene, and its world for a picture whose width and height are divided by
    /// `scale`.
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

    /// Returns the scene, and the text with only one object or none, in which a drag is evaluated.
    /// It is cached, as each step of a drag needs it.
    pub fn alone(&mut self, sources: &Sources, object: Option<usize>) -> (&Scene, &Sources) {
        let known = self.alone.take_if(|(known, _)| *known == object);
        let made = || (object, viewport::alone(sources, &self.scene, object));
        let (_, alone) = self.alone.insert(known.unwrap_or_else(made));
        (&self.scene, alone)
    }

    /// Returns width and height divided by `scale`, rounded up.
    pub fn size(&self, scale: u32) -> (u32, u32) {
        let image = &self.scene.image;
        (image.width.div_ceil(scale), image.height.div_ceil(scale))
    }
}
