//! Caches the scene of one version of a text, and the tracer's data for this scene ([`World`]).
//!
//! Each is computed only once per version. Without the cache, each click on a picture of many
//! thousand spheres would first prepare all spheres for tracing.

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

/// Maximum number of picture sizes for which the tracer's data ([`World`]) are cached. If another
/// size is requested, the oldest entry is dropped. A web page needs only a few sizes at a time:
/// that of the scene, and some smaller ones, which it shows until the full picture is finished. A
/// larger number would use more memory.
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
    /// Object that was dragged last, by its index, and a copy of the scene's text without the other
    /// objects. If the camera was dragged, the index is `None`, and the copy contains no objects.
    /// Before the first drag, the whole field is `None`.
    alone: Option<(Option<usize>, Sources)>,
}

/// A picture of the scene that may be requested, with the tracer's data for it. It shows the scene
/// as its own camera sees it or, if there is an `observer`, as this second camera sees it.
#[derive(Debug)]
struct Pictured {
    observer: Option<Observer>,
    /// Factor by which the width and height of the picture are divided.
    scale: u32,
    /// The scene with the camera of this picture. Its width and height are not divided by `scale`.
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

    /// Returns the scene and the tracer's data for its picture, from the cache if possible. An
    /// `observer` replaces the scene's own camera. `scale` divides the width and the height of the
    /// picture. Only the newest observer's data are kept, since the observer changes with each
    /// movement of the pointer.
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

    /// Returns the scene, and a copy of its text in which all objects are removed except `object`.
    /// If `object` is `None`, all objects are removed.
    ///
    /// A drag is computed from this copy, because a shorter text is faster to evaluate. The copy is
    /// cached, since each movement of the pointer needs it.
    pub fn alone(&mut self, sources: &Sources, object: Option<usize>) -> (&Scene, &Sources) {
        let known = self.alone.take_if(|(known, _)| *known == object);
        let made = || (object, viewport::alone(sources, &self.scene, object));
        let (_, alone) = self.alone.insert(known.unwrap_or_else(made));
        (&self.scene, alone)
    }

    /// Returns the width and height of the observer's picture or, without an observer, of the
    /// scene's picture. Both are divided by `scale` and rounded up.
    pub fn size(&self, observer: Option<&Observer>, scale: u32) -> (u32, u32) {
        let image = &self.scene.image;
        let [width, height] = observer.map_or([image.width, image.height], |it| it.size);
        (width.div_ceil(scale), height.div_ceil(scale))
    }
}
