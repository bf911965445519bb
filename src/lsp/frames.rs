//! Renders frames, i.e. pictures of an open text that are shown on a web page. A frame is rendered
//! in slices, so that other messages are answered between two slices.

use std::{collections::HashMap, mem};

use base64::{Engine, prelude::BASE64_STANDARD};
use lsp_server::RequestId;
use serde_json::{Value, json};

use super::{
    params::{Refusal, optional},
    protocol::Uri,
    scene_version::SceneVersion,
    view::observer,
};
use crate::{
    area::Area,
    editor::viewport::Observer,
    film::{self, Film},
    render::{SLICE, Slices, pixel_work},
    sampling::Sampling,
    scene::{Count, Method, Sampler},
};

/// Maximum number of pixels of a frame, i.e. of a picture that a web page shows. A request for a
/// larger frame is refused. The limit is 16 million pixels, more than most screens have.
const MOST_PIXELS: u64 = 1 << 24;

/// Queue of the requested frames that are not finished yet, in the order of their rendering.
#[derive(Debug, Default)]
pub struct Frames(Vec<Frame>);

#[derive(Debug)]
struct Frame {
    id: RequestId,
    uri: Uri,
    /// Version of the text that the frame shows.
    version: i32,
    /// Second camera that looks at the scene from outside and whose picture is rendered; `None` for
    /// the picture of the scene's own camera.
    observer: Option<Observer>,
    /// Factor by which the picture's width and height are divided.
    scale: u32,
    /// Number of samples per pixel; `None` to use the scene's own sampler.
    samples: Option<u64>,
    /// Work of rendering one pixel, in samples.
    work: u64,
    slices: Slices<[u8; 3]>,
}

impl Frames {
    /// Adds the frame that a request asks for. If the queue contains an equal frame, the new
    /// request replaces the earlier request for it. Otherwise, frames of other versions of the text
    /// are dropped. If the new frame shows the scene as an observer (a second camera) sees it,
    /// frames of other observers are dropped, too. Returns the identifiers of the requests that are
    /// replaced or dropped.
    ///
    /// A frame of an observer is put before frames with more samples per pixel. An observer's frame
    /// is small, so it delays the other frames little. Behind them, it would have to wait long.
    pub fn push(
        &mut self,
        id: RequestId,
        uri: Uri,
        params: &Value,
        version: &SceneVersion,
    ) -> Result<Vec<RequestId>, Refusal> {
        let new = Frame::new(id, uri, params, version)?;
        let what = |frame: &Frame| (frame.version, frame.observer, frame.scale, frame.samples);
        let mut of_text = self.0.iter_mut().filter(|frame| frame.uri == new.uri);
        // The queue contains the same frame already, and a part of it may be rendered. So this
        // frame stays in the queue, and answers the new request instead of the earlier request.
        if let Some(known) = of_text.find(|frame| what(frame) == what(&new)) {
            return Ok(vec![mem::replace(&mut known.id, new.id)]);
        }
        let is_superseded = |frame: &Frame| {
            let is_moved = frame.observer.is_some() && new.observer.is_some();
            frame.version != new.version || (is_moved && frame.observer != new.observer)
        };
        let superseded = self.remove(|frame| frame.uri == new.uri && is_superseded(frame));
        let takes_longer = |frame: &Frame| new.observer.is_some() && frame.work > new.work;
        let place = self.0.iter().position(takes_longer);
        self.0.insert(place.unwrap_or(self.0.len()), new);
        Ok(superseded)
    }

    /// Returns whether no frame is left to render.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Drops the frame of the request `id`. Returns whether there was such a frame.
    pub fn cancel(&mut self, id: &RequestId) -> bool {
        !self.remove(|frame| frame.id == *id).is_empty()
    }

    /// Drops the frames of the text `uri`, or of all texts if `uri` is `None`. Returns the
    /// identifiers of the requests for the dropped frames.
    pub fn drop_of(&mut self, uri: Option<&Uri>) -> Vec<RequestId> {
        self.remove(|frame| uri.is_none_or(|uri| frame.uri == *uri))
    }

    fn remove(&mut self, is_meant: impl Fn(&Frame) -> bool) -> Vec<RequestId> {
        let removed = self.0.extract_if(.., |frame| is_meant(frame));
        removed.map(|frame| frame.id).collect()
    }

    /// Returns the identifier of the request for the first frame, or `None` if there are no frames.
    pub fn first(&self) -> Option<RequestId> {
        self.0.first().map(|frame| frame.id.clone())
    }

    /// Renders a slice of the first frame. Returns the answer to its request when the frame is
    /// finished, and otherwise `None`. The answer is null if the scene of the frame's version of
    /// the text is no longer stored.
    pub fn advance(
        &mut self,
        scenes: &mut HashMap<Uri, Option<SceneVersion>>,
        last: &mut HashMap<Uri, Option<SceneVersion>>,
    ) -> Result<Option<Value>, Refusal> {
        let Some(frame) = self.0.first_mut() else {
            return Ok(None);
        };
        let versions = [scenes, last].map(|of| of.get_mut(&frame.uri)?.as_mut());
        let mut versions = versions.into_iter().flatten();
        match versions.find(|version| version.number == frame.version) {
            Some(version) => frame.advance(version),
            None => Ok(Some(Value::Null)),
        }
    }
}

impl Frame {
    fn new(
        id: RequestId,
        uri: Uri,
        params: &Value,
        version: &SceneVersion,
    ) -> Result<Self, Refusal> {
        let observer = observer(params, &version.scene)?;
        let scale = optional(params, "scale")?.unwrap_or(1);
        let samples = optional(params, "samples")?;
        let most: Option<u64> = optional(params, "pixels")?;
        let longest: Option<u32> = optional(params, "side")?;
        let zero = [
            ("scale", scale == 0),
            ("samples", samples == Some(0)),
            ("pixels", most == Some(0)),
            ("side", longest == Some(0)),
        ];
        if let Some((name, _)) = zero.iter().find(|(_, is_zero)| *is_zero) {
            let message = format!("`{name}` is a whole number of at least 1");
            return Err(Refusal::invalid(message));
        }
        let fits = |scale: &u32| {
            let (width, height) = version.size(observer.as_ref(), *scale);
            most.is_none_or(|most| Area::whole(width, height).pixels() <= most)
                && longest.is_none_or(|longest| width.max(height) <= longest)
        };
        // With the greatest scale, a frame has only one pixel, which satisfies the request's
        // limits. So a scale is always found.
        let scale = (scale..).find(fits).unwrap_or(u32::MAX);
        let (width, height) = version.size(observer.as_ref(), scale);
        let whole = Area::whole(width, height);
        if whole.pixels() > MOST_PIXELS {
            let message = format!(
                "a frame of {width} × {height} pixels is more than a page can show; at most {MOST_PIXELS} pixels can be asked for, by a larger `scale`"
            );
            return Err(Refusal::failed(message));
        }
        let own = version.scene.sampler;
        let regular = |samples| Sampler {
            method: Method::Regular,
            count: Count::PerPixel(samples),
            ..own
        };
        let sampling = Sampling::new(&samples.map_or(own, regular), width, height);
        let work = pixel_work(&sampling);
        if work > SLICE {
            let message = format!(
                "{work} samples a pixel take too long for a frame; at most {SLICE} can be asked for, by `samples`"
            );
            return Err(Refusal::failed(message));
        }
        Ok(Self {
            id,
            uri,
            version: version.number,
            observer,
            scale,
            samples,
            work,
            slices: Slices::new(sampling, [width, height]).map_err(Refusal::failed)?,
        })
    }

    /// Renders the next slice. Returns the answer after the last slice, and otherwise `None`.
    fn advance(&mut self, version: &mut SceneVersion) -> Result<Option<Value>, Refusal> {
        let (scene, world) = version.world(self.observer.as_ref(), self.scale);
        let size = [scene.image.width, scene.image.height];
        if !self.slices.advance(world).map_err(Refusal::failed)? {
            return Ok(None);
        }
        let film = self.slices.film();
        Ok(Some(json!({
            "version": version.number,
            "width": film.width(),
            "height": film.height(),
            "size": size,
            "png": encoded(film)?,
        })))
    }
}

/// Encodes a picture as a PNG file, and the file in base64.
pub fn encoded(film: &Film<[u8; 3]>) -> Result<String, Refusal> {
    let mut png = Vec::new();
    film::write_png(film, None, &mut png).map_err(Refusal::failed)?;
    Ok(BASE64_STANDARD.encode(png))
}
