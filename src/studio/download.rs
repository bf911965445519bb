//! The downloads of a page: a text's picture as a file, rendered as the scene asks for.

use std::{
    error::Error,
    io::Cursor,
    sync::atomic::{AtomicBool, Ordering},
};

use base64::prelude::{BASE64_STANDARD, Engine as _};
use lsp_server::{Message, Request};
use serde_json::{Value, json};

use crate::{
    area::Area,
    film::{self, Film, Recipe},
    lsp::{Answer, Refusal, response},
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
    response(id, file(&method, &params, cancel))
}

fn file(method: &str, params: &Value, cancel: &AtomicBool) -> Answer {
    let text = params.get("text").and_then(Value::as_str);
    let text = text.ok_or_else(|| Refusal::invalid("there is no `text`"))?;
    let reading = scene::read(&Sources::new(Source::from_text("scene.scn", text)));
    let scene = reading.scene;
    let scene = scene.ok_or_else(|| Refusal::failed("the scene has errors"))?;
    let mut file = Cursor::new(Vec::new());
    let written = match method {
        EXR => write_exr(&scene, cancel, &mut file),
        _ => write_png(&scene, text, cancel, &mut file),
    };
    written.map_err(|error| match cancel.load(Ordering::SeqCst) {
        true => Refusal::cancelled(),
        false => Refusal::failed(error),
    })?;
    let name = method.trim_start_matches("studio/");
    Ok(json!({ name: BASE64_STANDARD.encode(file.into_inner()) }))
}

type Written = Result<(), Box<dyn Error>>;

fn write_png(
    scene: &Scene,
    text: &str,
    cancel: &AtomicBool,
    file: &mut Cursor<Vec<u8>>,
) -> Written {
    let film: Film<[u8; 3]> = rendered(scene, cancel)?;
    let recipe = Recipe {
        scene: text.to_owned(),
        overrides: Vec::new(),
        crop: None,
    };
    Ok(film::write_png(&film, Some(&recipe), file)?)
}

/// For the host on this machine alone: the tables of the format's compressions are a quarter of what a browser would have to load.
#[cfg(feature = "studio")]
fn write_exr(scene: &Scene, cancel: &AtomicBool, file: &mut Cursor<Vec<u8>>) -> Written {
    let film = rendered(scene, cancel)?;
    let whole = Area::whole(film.width(), film.height());
    Ok(film::write_exr(&film, whole, whole, file)?)
}

#[cfg(not(feature = "studio"))]
fn write_exr(_: &Scene, _: &AtomicBool, _: &mut Cursor<Vec<u8>>) -> Written {
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
