//! Renders a picture to a file on several threads. Meanwhile, the connection continues and sends
//! the progress.

use std::{
    error::Error,
    io::Cursor,
    sync::atomic::{AtomicBool, AtomicU64, Ordering},
};

use base64::prelude::{BASE64_STANDARD, Engine as _};
use lsp_server::{Message, Request};
use serde_json::{Value, json};

use super::download::{EXR, recipe, sampling, scene};
use crate::{
    area::Area,
    files,
    film::{self, Film},
    lsp::{Answer, Refusal, catch_panics, response},
    render::{self, Control, RenderError},
    scene::Scene,
    tracer::World,
};

/// Progress and cancellation of a render, shared between its threads and the connection.
#[derive(Debug, Default)]
pub struct Watch {
    pub cancel: AtomicBool,
    /// Number of samples that are done or, for a picture that is computed exactly, number of
    /// pixels.
    done: AtomicU64,
    expected: AtomicU64,
}

impl Watch {
    /// Returns the fraction of the work that is done, from 0 to 1.
    pub fn share(&self) -> f64 {
        let [done, expected] = [&self.done, &self.expected].map(|it| it.load(Ordering::Relaxed));
        (done as f64 / expected.max(1) as f64).min(1.0)
    }
}

/// Answers a request for a picture as a file. The file is identical to the one that
/// `pinhole render` writes.
pub fn answer(request: Request, watch: &Watch) -> Message {
    let Request { id, method, params } = request;
    response(id, catch_panics(|| file(&method, &params, watch)))
}

fn file(method: &str, params: &Value, watch: &Watch) -> Answer {
    let (scene, text) = scene(params)?;
    let made = match method {
        EXR => exr(&scene, text, watch),
        _ => png(&scene, text, watch),
    };
    let file = made.map_err(|error| {
        if watch.cancel.load(Ordering::SeqCst) {
            Refusal::cancelled()
        } else {
            Refusal::failed(error)
        }
    })?;
    let name = method.trim_start_matches("studio/");
    Ok(json!({ name: BASE64_STANDARD.encode(file) }))
}

type Made = Result<Vec<u8>, Box<dyn Error>>;

fn png(scene: &Scene, text: String, watch: &Watch) -> Made {
    let film: Film<[u8; 3]> = rendered(scene, watch)?;
    let mut file = Vec::new();
    files::write_stream(&mut file, &watch.cancel, |out| {
        film::write_png(&film, Some(&recipe(text)), out)
    })?;
    Ok(file)
}

fn exr(scene: &Scene, text: String, watch: &Watch) -> Made {
    let film: Film<[f32; 3]> = rendered(scene, watch)?;
    let whole = Area::whole(film.width(), film.height());
    let mut file = Cursor::new(Vec::new());
    film::write_exr(&film, whole, whole, Some(&recipe(text).digest()), &mut file)?;
    Ok(file.into_inner())
}

fn rendered<P: film::Pixel>(scene: &Scene, watch: &Watch) -> Result<Film<P>, RenderError> {
    let cancel = &watch.cancel;
    let world = World::new_unless(scene, cancel)?;
    let sampling = sampling(scene);
    let whole = Area::whole(scene.image.width, scene.image.height);
    let expected = if sampling.is_exact() {
        whole.pixels()
    } else {
        sampling.total()
    };
    watch.expected.store(expected, Ordering::Relaxed);
    let control = Control {
        progress: &|more| {
            watch.done.fetch_add(more, Ordering::Relaxed);
        },
        cancel,
        ..Control::default()
    };
    let rendered = render::render_as_asked(&world, &sampling, whole, &control)?;
    Ok(rendered.into_film())
}
