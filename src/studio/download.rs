//! The downloads of a page: a text's picture as a file, rendered as the scene asks for.
//!
//! The engine in the browser has one thread, and makes a file in slices ([`Sliced`]); the host on
//! this machine has threads for it (`watched`).

use base64::prelude::{BASE64_STANDARD, Engine as _};
use lsp_server::{Message, Notification, Request, RequestId};
use serde_json::{Value, json};

use crate::{
    film::{self, Recipe},
    lsp::{Refusal, response, unharmed},
    render::Slices,
    sampling::Sampling,
    scene::{self, Scene},
    source::{Source, Sources},
    tracer::World,
};

/// The requests for a picture's file.
const PNG: &str = "studio/png";
pub(super) const EXR: &str = "studio/exr";

/// Whether a request is for a picture's file.
pub fn is_asked_for(request: &Request) -> bool {
    [PNG, EXR].contains(&&*request.method)
}

/// Tells the page which part of a picture is made.
pub fn progress(share: f64) -> Message {
    let params = json!({ "share": share });
    Notification::new("studio/progress".to_owned(), params).into()
}

/// The scene that a request is about.
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
    }
}

/// A picture's file that is made in slices.
#[derive(Debug)]
pub struct Sliced {
    /// Who asked for it.
    pub request: RequestId,
    text: String,
    world: World,
    slices: Slices<[u8; 3]>,
}

impl Sliced {
    /// Begins with the file that a request asks for. It is no EXR: the tables of that format's
    /// compressions are a quarter of what a browser would have to load.
    ///
    /// # Errors
    ///
    /// Why there will be no file.
    pub fn new(request: &Request) -> Result<Self, Refusal> {
        unharmed(|| {
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

    /// Makes a slice. Returns what is to be said of it, and whether that is the answer.
    pub fn advance(&mut self) -> (Message, bool) {
        match unharmed(|| self.slice()) {
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
