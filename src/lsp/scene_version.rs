//! Caches the scene of one version of a text, and the worlds in which its pictures and rays are
//! traced.
//!
//! Each is computed once for a version, so that picking an object in a scene of 100 000 spheres
//! does not read the spheres again.

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

/// Maximum number of picture sizes for which the traced worlds are cached. For a further size, the
/// oldest world is dropped. Four suffice for the picture's own size and for the coarse frames that
/// are shown until the picture is finished.
const WORLDS: usize = 4;

/// A version of a text that has no errors.
#[derive(Debug)]
pub struct SceneVersion {
    /// The version's number, as the client numbers them.
    pub number: i32,
    /// The scene.
    pub scene: Scene,
    /// The span of each object's name or, if it has none, of its keyword.
    pub selections: Vec<Span>,
    worlds: VecDeque<(u32, World)>,
    /// The object that was dragged last, by its index (`None` for the camera), and the text in
    /// which it is the only object. It is `None` before the first drag.
    alone: Option<(Option<usize>, Sources)>,
}

impl SceneVersion {
    /// Makes the version of an analyzed text; returns `None` if the text has errors.
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

    /// Returns the scene, and the world for a picture whose width and height are divided by
    /// `scale`. Worlds are cached.
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

    /// Returns the scene, and the text with only the object `object` or, for `None`, without any
    /// object. A drag is evaluated in this text. The text is cached, since each step of a drag
    /// needs it.
    pub fn alone(&mut self, sources: &Sources, object: Option<usize>) -> (&Scene, &Sources) {
        let known = self.alone.take_if(|(known, _)| *known == object);
        let made = || (object, viewport::alone(sources, &self.scene, object));
        let (_, alone) = self.alone.insert(known.unwrap_or_else(made));
        (&self.scene, alone)
    }

    /// Returns the picture's width and height divided by `scale`, rounded up.
    pub fn size(&self, scale: u32) -> (u32, u32) {
        let image = &self.scene.image;
        (image.width.div_ceil(scale), image.height.div_ceil(scale))
    }
}
