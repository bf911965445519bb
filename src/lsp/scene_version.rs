//! Caches the scene of one version of a text, together with the data from which its pictures and
//! rays are traced ([`World`]).
//!
//! The scene and this data are computed only once for each version. Without the cache, each click
//! on a picture of 100 000 spheres would first prepare all spheres for tracing.

use std::collections::VecDeque;

use crate::{
    editor::{
        Analysis,
        viewport::{self, Observer, selections},
    },
    scene::Scene,
    source::{Sources, Span},
    tracer::World,
};

/// Maximum number of picture sizes for which the data of the tracer ([`World`]) are cached. For a
/// further size, the oldest entry is dropped. A page needs few sizes at a time: the scene's own and
/// some coarser ones, which it shows until the full picture is finished. A larger number would use
/// more memory.
const WORLDS: usize = 4;

/// A version of a text without errors, with its scene.
#[derive(Debug)]
pub struct SceneVersion {
    /// Number that the client has given to this version of the text.
    pub number: i32,
    /// The scene that this version of the text describes.
    pub scene: Scene,
    /// Span of each object's name or, if an object has no name, of its keyword.
    pub selections: Vec<Span>,
    worlds: VecDeque<Pictured>,
    /// Text of the scene without all objects except the one that was dragged last, with the index
    /// of this object. The index is `None` if the camera was dragged. The field is `None` before
    /// the first drag.
    alone: Option<(Option<usize>, Sources)>,
}

/// A picture of the scene: by its own camera, or by an observer's.
#[derive(Debug)]
struct Pictured {
    observer: Option<Observer>,
    /// Factor by which the width and height of the picture are divided.
    scale: u32,
    /// The scene with the camera and the size of the picture, before the division.
    scene: Scene,
    world: World,
}

impl SceneVersion {
    /// Builds the scene of an analyzed text. Returns `None` if the text has errors.
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

    /// Returns the scene as `observer` sees it (its own camera, if that is `None`), and the data of
    /// the tracer for a picture whose width and height are divided by `scale`. The data are cached.
    /// Of observers, only the newest one is kept, since they change with each step of the pointer.
    pub fn world(&mut self, observer: Option<&Observer>, scale: u32) -> (&Scene, &World) {
        let is_wanted = |it: &Pictured| it.observer.as_ref() == observer && it.scale == scale;
        let found = self.worlds.iter().position(is_wanted);
        let index = found.unwrap_or_else(|| {
            if observer.is_some() {
                self.worlds
                    .retain(|it| it.observer.is_none() || it.observer.as_ref() == observer);
            }
            if self.worlds.len() == WORLDS {
                self.worlds.pop_front();
            }
            let scene = match observer {
                Some(observer) => observer.scene(&self.scene),
                None => self.scene.clone(),
            };
            let mut scaled = scene.clone();
            (scaled.image.width, scaled.image.height) = self.size(observer, scale);
            self.worlds.push_back(Pictured {
                observer: observer.copied(),
                scale,
                scene,
                world: World::new(&scaled),
            });
            self.worlds.len() - 1
        });
        let Pictured { scene, world, .. } = &self.worlds[index];
        (scene, world)
    }

    /// Returns the scene, and a text that contains no other object than `object`, or no object at
    /// all if it is `None`. A drag is computed from the shorter text, which is faster to evaluate.
    /// The text is cached, since each movement of the pointer needs it.
    pub fn alone(&mut self, sources: &Sources, object: Option<usize>) -> (&Scene, &Sources) {
        let known = self.alone.take_if(|(known, _)| *known == object);
        let made = || (object, viewport::alone(sources, &self.scene, object));
        let (_, alone) = self.alone.insert(known.unwrap_or_else(made));
        (&self.scene, alone)
    }

    /// Returns the width and height of the picture, or of that of an observer, divided by `scale`,
    /// rounded up.
    pub fn size(&self, observer: Option<&Observer>, scale: u32) -> (u32, u32) {
        let image = &self.scene.image;
        let [width, height] = observer.map_or([image.width, image.height], |it| it.size);
        (width.div_ceil(scale), height.div_ceil(scale))
    }
}
