//! Renders the picture of a text to a file that a page downloads. Uses the scene's own sampler. The
//! file may also be an animation. Its pictures show the text with one value after another at the
//! same position.
//!
//! The host on this machine renders the file on several threads (`threaded_download`). The engine
//! that runs in the browser has only one thread, so it renders the file in slices ([`Sliced`]).

use std::{io, mem};

use base64::prelude::{BASE64_STANDARD, Engine as _};
use lsp_server::{Message, Notification, Request, RequestId};
use serde_json::{Value, json};

use crate::{
    film::{self, Animation, Film, Recipe},
    lsp::{Refusal, catch_panics, optional, response},
    render::Slices,
    sampling::Sampling,
    scene::{self, Scene},
    source::{Source, Sources},
    tracer::World,
};

/// Method of a request for a picture as a PNG file.
const PNG: &str = "studio/png";
/// Method of a request for a picture as an EXR file.
pub(super) const EXR: &str = "studio/exr";

/// Returns whether a request asks for a picture as a file.
pub fn is_asked_for(request: &Request) -> bool {
    [PNG, EXR].contains(&&*request.method)
}

/// Makes the message about the progress of a render. `share` is the fraction of the work that is
/// done, from 0 to 1.
pub fn progress(share: f64) -> Message {
    let params = json!({ "share": share });
    Notification::new("studio/progress".to_owned(), params).into()
}

/// The pictures that a request asks for: one, or those of an animation.
#[derive(Debug)]
pub(super) struct Asked {
    before: String,
    /// The text between `before` and `after`, for each picture.
    values: Vec<String>,
    after: String,
    /// Time for which a picture of an animation is shown, in milliseconds. `None` if there is no
    /// animation.
    pause: Option<u16>,
}

impl Asked {
    /// Reads a request's parameters: `text` for a picture, or `before`, `values`, `after` and
    /// `time` for an animation.
    pub fn read(params: &Value) -> Result<Self, Refusal> {
        let text = |key: &str| {
            let text: Option<String> = optional(params, key)?;
            text.ok_or_else(|| Refusal::invalid(format!("there is no `{key}`")))
        };
        let Some(values) = optional::<Vec<String>>(params, "values")? else {
            return Ok(Self {
                before: text("text")?,
                values: vec![String::new()],
                after: String::new(),
                pause: None,
            });
        };
        let time: usize = optional(params, "time")?.unwrap_or_default();
        let pause = time.checked_div(values.len());
        let pause = pause.ok_or_else(|| Refusal::invalid("an animation needs `values`"))?;
        Ok(Self {
            before: text("before")?,
            values,
            after: text("after")?,
            pause: Some(u16::try_from(pause).unwrap_or(u16::MAX)),
        })
    }

    /// Returns the number of pictures.
    pub fn count(&self) -> usize {
        self.values.len()
    }

    /// Returns the scene of the picture with the given index, and its text.
    pub fn scene(&self, index: usize) -> Result<(Scene, String), Refusal> {
        let value = &self.values[index];
        let text = [&*self.before, value, &self.after].concat();
        let reading = scene::read(&Sources::new(Source::from_text("scene.scn", &*text)));
        let scene = reading.scene.ok_or_else(|| {
            let with = self
                .pause
                .map_or_else(String::new, |_| format!("with {value} "));
            Refusal::failed(format!("{with}the scene has errors"))
        })?;
        Ok((scene, text))
    }

    /// Begins the animation, whose first picture is `first`. Returns `None` if the request asks for
    /// a single picture.
    pub fn animation(&self, first: &Film<[u8; 3]>) -> io::Result<Option<Animation>> {
        let size = [first.width(), first.height()];
        let count = u32::try_from(self.count()).map_err(io::Error::other)?;
        let begun = self.pause.map(|pause| Animation::new(size, count, pause));
        begun.transpose()
    }
}

pub(super) fn sampling(scene: &Scene) -> Sampling {
    Sampling::new(&scene.sampler, scene.image.width, scene.image.height)
}

pub(super) fn recipe(scene: String) -> Recipe {
    Recipe {
        scene,
        overrides: Vec::new(),
        crop: None,
        size: None,
    }
}

/// A file that is rendered in slices.
#[derive(Debug)]
pub struct Sliced {
    /// Identifier of the request for the file.
    pub request: RequestId,
    asked: Asked,
    /// Index of the picture that is being rendered.
    index: usize,
    picture: UnfinishedPicture,
    /// The animation, to which finished pictures are added. `None` before the first picture is
    /// finished, and if the file is a single picture.
    animation: Option<Animation>,
}

/// A picture that is being rendered.
#[derive(Debug)]
struct UnfinishedPicture {
    text: String,
    world: World,
    slices: Slices<[u8; 3]>,
}

impl UnfinishedPicture {
    fn new(asked: &Asked, index: usize) -> Result<Self, Refusal> {
        let (scene, text) = asked.scene(index)?;
        let size = [scene.image.width, scene.image.height];
        Ok(Self {
            text,
            world: World::new(&scene),
            slices: Slices::new(sampling(&scene), size).map_err(Refusal::failed)?,
        })
    }
}

impl Sliced {
    /// Begins to render the file that a request asks for. Refuses to make an EXR file: support for
    /// EXR's compression methods would be a quarter of the code that a browser loads.
    ///
    /// # Errors
    ///
    /// Returns the reason if the request is refused.
    pub fn new(request: &Request) -> Result<Self, Refusal> {
        catch_panics(|| {
            if request.method == EXR {
                return Err(Refusal::failed("no EXR is written here"));
            }
            let asked = Asked::read(&request.params)?;
            Ok(Self {
                request: request.id.clone(),
                picture: UnfinishedPicture::new(&asked, 0)?,
                asked,
                index: 0,
                animation: None,
            })
        })
    }

    /// Renders a slice. Returns the message to send, and whether this message is the final answer.
    pub fn advance(&mut self) -> (Message, bool) {
        match catch_panics(|| self.slice()) {
            Ok(None) => (progress(self.share()), false),
            Ok(Some(file)) => {
                let file = json!({ "png": BASE64_STANDARD.encode(file) });
                (response(self.request.clone(), Ok(file)), true)
            }
            Err(refusal) => (response(self.request.clone(), Err(refusal)), true),
        }
    }

    fn share(&self) -> f64 {
        (self.index as f64 + self.picture.slices.share()) / self.asked.count() as f64
    }

    /// Renders a slice. Returns the file if the slice was the last one, and otherwise `None`.
    fn slice(&mut self) -> Result<Option<Vec<u8>>, Refusal> {
        let UnfinishedPicture {
            text,
            world,
            slices,
        } = &mut self.picture;
        if !slices.advance(world).map_err(Refusal::failed)? {
            return Ok(None);
        }
        let film = slices.film();
        if self.index == 0 {
            self.animation = self.asked.animation(film).map_err(Refusal::failed)?;
        }
        let Some(animation) = &mut self.animation else {
            let mut file = Vec::new();
            let recipe = recipe(mem::take(text));
            film::write_png(film, Some(&recipe), &mut file).map_err(Refusal::failed)?;
            return Ok(Some(file));
        };
        animation.add(film).map_err(Refusal::failed)?;
        self.index += 1;
        if self.index < self.asked.count() {
            self.picture = UnfinishedPicture::new(&self.asked, self.index)?;
            return Ok(None);
        }
        let animation = self.animation.take();
        let file = animation.map(Animation::finish).transpose();
        file.map_err(Refusal::failed)
    }
}
