//! The downloads of a page: a text's picture as a file, rendered as the scene asks for.

use std::{
    error::Error,
    sync::atomic::{AtomicBool, Ordering},
};

use base64::prelude::{BASE64_STANDARD, Engine as _};
use lsp_server::{Message, Request};
use serde_json::{Value, json};

use crate::{
    area::Area,
    film::{self, Film, Recipe},
    lsp::{Answer, Refusal, response, unharmed},
    render::{self, Control, RenderError},
    sampling::Sampling,
    scene::{self, Scene},
    source::{Source, Sources},
    tracer::World,
};

/// The requests for a picture's file.
const PNG: &str = "studio/png";
const EXR: &str = "studio/exr";

/// Whether a request is for a picture's file.
pub fn is_asked_for(request: &Request) -> bool {
    [PNG, EXR].contains(&&*request.method)
}

/// The answer to such a request: the file of the picture that `pinhole render` makes of the text.
pub fn answer(request: Request, cancel: &AtomicBool) -> Message {
    let Request { id, method, params } = request;
    response(id, unharmed(|| file(&method, &params, cancel)))
}

fn file(method: &str, params: &Value, cancel: &AtomicBool) -> Answer {
    let text = params.get("text").and_then(Value::as_str);
    let text = text.ok_or_else(|| Refusal::invalid("there is no `text`"))?;
    let reading = scene::read(&Sources::new(Source::from_text("scene.scn", text)));
    let scene = reading.scene;
    let scene = scene.ok_or_else(|| Refusal::failed("the scene has errors"))?;
    let made = match method {
        EXR => exr(&scene, cancel),
        _ => png(&scene, text, cancel),
    };
    let file = made.map_err(|error| match cancel.load(Ordering::SeqCst) {
        true => Refusal::cancelled(),
        false => Refusal::failed(error),
    })?;
    let name = method.trim_start_matches("studio/");
    Ok(json!({ name: BASE64_STANDARD.encode(file) }))
}

type Made = Result<Vec<u8>, Box<dyn Error>>;

fn png(scene: &Scene, text: &str, cancel: &AtomicBool) -> Made {
    let film: Film<[u8; 3]> = rendered(scene, cancel)?;
    let recipe = Recipe {
        scene: text.to_owned(),
        overrides: Vec::new(),
        crop: None,
    };
    let mut file = Vec::new();
    film::write_png(&film, Some(&recipe), &mut file)?;
    Ok(file)
}

/// For the host on this machine alone: the tables of the format's compressions are a quarter of what a browser would have to load.
#[cfg(feature = "studio")]
fn exr(scene: &Scene, cancel: &AtomicBool) -> Made {
    let film: Film<[f32; 3]> = rendered(scene, cancel)?;
    let whole = Area::whole(film.width(), film.height());
    let mut file = std::io::Cursor::new(Vec::new());
    film::write_exr(&film, whole, whole, &mut file)?;
    Ok(file.into_inner())
}

#[cfg(not(feature = "studio"))]
fn exr(_: &Scene, _: &AtomicBool) -> Made {
    Err("no EXR is written here".into())
}

fn rendered<P: film::Pixel>(scene: &Scene, cancel: &AtomicBool) -> Result<Film<P>, RenderError> {
    let world = World::new_unless(scene, cancel)?;
    let (width, height) = (scene.image.width, scene.image.height);
    let sampling = Sampling::new(&scene.sampler, width, height);
    let whole = Area::whole(width, height);
    let control = Control {
        cancel,
        ..Control::default()
    };
    let rendered = render::render_as_asked(&world, &sampling, whole, &control)?;
    Ok(rendered.into_film())
}
