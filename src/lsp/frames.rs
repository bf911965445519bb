//! Frames: pictures of an open text, made in slices, so that other messages are answered in between.
//!
//! A slice is a rectangle of the picture with a fixed number of samples: what a pixel shows does not depend on the rectangle that is asked for, and
//! no clock is needed, which a web worker's Rust does not have. A frame that is not wanted any more is dropped between two slices.

use std::{
    collections::{HashMap, VecDeque},
    mem,
};

use base64::{Engine, prelude::BASE64_STANDARD};
use lsp_server::RequestId;
use serde_json::{Value, json};

use super::{
    params::{Refusal, optional},
    protocol::Uri,
    scene_version::SceneVersion,
};
use crate::{
    area::Area,
    film::{self, Film},
    render::{Control, RenderError, render_as_asked},
    sampling::Sampling,
    scene::{Count, Method, Sampler, Scene},
    tracer::World,
};

/// The samples of a slice: some 10 ms of two processors for a few objects. No pixel may have more, since a pixel is not divided.
const SLICE: u64 = 1 << 20;

/// A pixel without samples takes as long as so many samples, for figure 9.9.
const EXACT: u64 = 64;

/// The most pixels of a frame. More than a page can show is a file's business.
const MOST_PIXELS: u64 = 1 << 24;

/// The frames that are asked for and not done, the oldest first. Only that one has pixels.
#[derive(Debug, Default)]
pub struct Frames(VecDeque<Frame>);

#[derive(Debug)]
struct Frame {
    id: RequestId,
    uri: Uri,
    wanted: Wanted,
    begun: Option<Begun>,
}

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    scale: u32,
    /// What the scene asks for if it is none.
    samples: Option<u64>,
}

/// A frame of which some slices are done.
#[derive(Debug)]
struct Begun {
    film: Film<[u8; 3]>,
    sampling: Sampling,
    slices: VecDeque<Area>,
}

impl Wanted {
    /// Reads the parameters of a request.
    pub fn new(params: &Value) -> Result<Self, Refusal> {
        let invalid = |name| {
            let message = format!("`{name}` is a whole number of at least 1");
            Err(Refusal::invalid(message))
        };
        let scale = optional(params, "scale")?.unwrap_or(1);
        let samples = optional(params, "samples")?;
        match (scale, samples) {
            (0, _) => invalid("scale"),
            (_, Some(0)) => invalid("samples"),
            _ => Ok(Self { scale, samples }),
        }
    }

    fn sampler(&self, scene: &Scene) -> Sampler {
        match self.samples {
            None => scene.sampler,
            Some(samples) => Sampler {
                method: Method::Regular,
                count: Count::PerPixel(samples),
                ..scene.sampler
            },
        }
    }
}

impl Frames {
    /// Takes a frame in. Returns the requests that it supersedes.
    pub fn push(&mut self, id: RequestId, uri: Uri, wanted: Wanted) -> Vec<RequestId> {
        let superseded = self.remove(|frame| frame.uri == uri && frame.wanted == wanted);
        self.0.push_back(Frame {
            id,
            uri,
            wanted,
            begun: None,
        });
        superseded
    }

    /// Whether any is to be made.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Drops the frame that a request asked for. Says whether there was one.
    pub fn cancel(&mut self, id: &RequestId) -> bool {
        !self.remove(|frame| frame.id == *id).is_empty()
    }

    /// Drops the frames of a text, or of all if it is none. Returns who asked for them.
    pub fn drop_of(&mut self, uri: Option<&Uri>) -> Vec<RequestId> {
        self.remove(|frame| uri.is_none_or(|uri| frame.uri == *uri))
    }

    fn remove(&mut self, is_meant: impl Fn(&Frame) -> bool) -> Vec<RequestId> {
        let frames = mem::take(&mut self.0).into_iter();
        let (removed, kept): (VecDeque<_>, _) = frames.partition(is_meant);
        self.0 = kept;
        removed.into_iter().map(|frame| frame.id).collect()
    }

    /// Who asked for the oldest one.
    pub fn oldest(&self) -> Option<RequestId> {
        self.0.front().map(|frame| frame.id.clone())
    }

    /// Makes a slice of the oldest one. Returns its answer once it is done.
    pub fn advance(
        &mut self,
        scenes: &mut HashMap<Uri, Option<SceneVersion>>,
    ) -> Result<Option<Value>, Refusal> {
        let Some(frame) = self.0.front_mut() else {
            return Ok(None);
        };
        match scenes.get_mut(&frame.uri) {
            Some(Some(version)) => frame.advance(version),
            _ => Ok(Some(Value::Null)),
        }
    }
}

impl Frame {
    fn advance(&mut self, version: &mut SceneVersion) -> Result<Option<Value>, Refusal> {
        let begun = match &mut self.begun {
            Some(begun) => begun,
            none => none.insert(Begun::new(self.wanted, version)?),
        };
        let (_, world) = version.world(self.wanted.scale);
        begun.advance(world).map_err(Refusal::failed)?;
        if !begun.slices.is_empty() {
            return Ok(None);
        }
        let mut png = Vec::new();
        film::write_png(&begun.film, None, &mut png).map_err(Refusal::failed)?;
        let image = &version.scene.image;
        Ok(Some(json!({
            "version": version.number,
            "width": begun.film.width(),
            "height": begun.film.height(),
            "size": [image.width, image.height],
            "png": BASE64_STANDARD.encode(png),
        })))
    }
}

impl Begun {
    fn new(wanted: Wanted, version: &SceneVersion) -> Result<Self, Refusal> {
        let (width, height) = version.size(wanted.scale);
        let whole = Area::whole(width, height);
        if whole.pixels() > MOST_PIXELS {
            let message = format!(
                "a frame of {width} × {height} pixels is more than a page can show; at most {MOST_PIXELS} pixels can be asked for, by a larger `scale`"
            );
            return Err(Refusal::failed(message));
        }
        let sampler = wanted.sampler(&version.scene);
        let sampling = Sampling::new(&sampler, width, height);
        let work = match sampling.is_exact() {
            true => EXACT,
            false => sampling.samples_per_pixel().max(1),
        };
        if work > SLICE {
            let message = format!(
                "{work} samples a pixel take too long for a frame; at most {SLICE} can be asked for, by `samples`"
            );
            return Err(Refusal::failed(message));
        }
        Ok(Self {
            film: Film::new(width, height).map_err(Refusal::failed)?,
            sampling,
            // A square with a power of two as its side: whole tiles of the tracer's grid, or a part of one.
            slices: whole.tiles(1 << ((SLICE / work).ilog2() / 2)).collect(),
        })
    }

    /// Makes the next slice.
    fn advance(&mut self, world: &World) -> Result<(), RenderError> {
        let Some(part) = self.slices.pop_front() else {
            return Ok(());
        };
        let made = render_as_asked(world, &self.sampling, part, &Control::default())?;
        self.film.put(part, made.film().pixels());
        Ok(())
    }
}
