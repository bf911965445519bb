//! Renders the picture of a text to a file that a page downloads. Uses the scene's own sampler.
//!
//! The host on this machine renders the file on several threads (`threaded_download`). The engine
//! that runs in the browser has only one thread, so it renders the file in slices ([`Sliced`]).

use base64::prelude::{BASE64_STANDARD, Engine as _};
use lsp_server::{Message, Notification, Request, RequestId};
use serde_json::{Value, json};

use crate::{
    film::{self, Recipe},
    lsp::{Refusal, catch_panics, response},
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

/// Reads the scene in the field `text` of a request's parameters. Returns the scene and its text.
pub(super) fn scene(params: &Value) -> Result<(Scene, String), Refusal> {
    let text = params.get("text").and_then(Value::as_str);
    let text = text.ok_or_else(|| Refusal::invalid("there is no `text`"))?;
    let reading = scene::read(&Sources::new(Source::from_text("scene.scn", text)));
    let scene = reading.scene;
    let scene = scene.ok_or_else(|| Refusal::failed("the scene has errors"))?;
    Ok((scene, text.to_owned()))
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

/// A picture that is rendered to a file in slices.
#[derive(Debug)]
pub struct Sliced {
    /// Identifier of the request for the file.
    pub request: RequestId,
    text: String,
    world: World,
    slices: Slices<[u8; 3]>,
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
            let (scene, text) = scene(&request.params)?;
            let size = [scene.image.width, scene.image.height];
            Ok(Self {
                request: request.id.clone(),
                text,
                world: World::new(&scene),
                slices: Slices::new(sampling(&scene), size).map_err(Refusal::failed)?,
            })
        })
    }

    /// Renders a slice. Returns the message to send, and whether this message is the final answer.
    pub fn advance(&mut self) -> (Message, bool) {
        match catch_panics(|| self.slice()) {
            Ok(None) => (progress(self.slices.share()), false),
            Ok(Some(file)) => (response(self.request.clone(), Ok(file)), true),
            Err(refusal) => (response(self.request.clone(), Err(refusal)), true),
        }
    }

    fn slice(&mut self) -> Result<Option<Value>, Refusal> {
        if !self.slices.advance(&self.world).map_err(Refusal::failed)? {
            return Ok(None);
        }
        let mut file = Vec::new();
        let recipe = recipe(self.text.clone());
        let written = film::write_png(self.slices.film(), Some(&recipe), &mut file);
        written.map_err(Refusal::failed)?;
        Ok(Some(json!({ "png": BASE64_STANDARD.encode(file) })))
    }
}
