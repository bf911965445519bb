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

use super::download::{Asked, EXR, recipe, sampling};
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

/// Answers a request for a picture as a file. Unless it is an animation, the file is identical to
/// the file that `pinhole render` writes.
pub fn answer(request: Request, watch: &Watch) -> Message {
    let Request { id, method, params } = request;
    response(id, catch_panics(|| file(&method, &params, watch)))
}

fn file(method: &str, params: &Value, watch: &Watch) -> Answer {
    let asked = Asked::read(params)?;
    let (scene, text) = asked.scene(0)?;
    let made = match method {
        EXR => exr(&scene, text, watch),
        _ => png(&asked, &scene, text, watch),
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

/// Makes a PNG file with one picture or, for an animation, several. The first picture shows
/// `scene`.
fn png(asked: &Asked, scene: &Scene, text: String, watch: &Watch) -> Made {
    let count = asked.count();
    let film = rendered(scene, watch, [0, count])?;
    if let Some(mut animation) = asked.animation(&film)? {
        animation.add(&film)?;
        for index in 1..count {
            let (scene, _) = asked.scene(index).map_err(|Refusal(_, why)| why)?;
            animation.add(&rendered(&scene, watch, [index, count])?)?;
        }
        return Ok(animation.finish()?);
    }
    let mut file = Vec::new();
    files::write_stream(&mut file, &watch.cancel, |out| {
        film::write_png(&film, Some(&recipe(text)), out)
    })?;
    Ok(file)
}

fn exr(scene: &Scene, text: String, watch: &Watch) -> Made {
    let film: Film<[f32; 3]> = rendered(scene, watch, [0, 1])?;
    let whole = Area::whole(film.width(), film.height());
    let mut file = Cursor::new(Vec::new());
    film::write_exr(&film, whole, whole, Some(&recipe(text).digest()), &mut file)?;
    Ok(file.into_inner())
}

/// Renders the picture with the index `index` among `count` pictures of a file.
fn rendered<P: film::Pixel>(
    scene: &Scene,
    watch: &Watch,
    [index, count]: [usize; 2],
) -> Result<Film<P>, RenderError> {
    let cancel = &watch.cancel;
    let world = World::new_unless(scene, cancel)?;
    let sampling = sampling(scene);
    let whole = Area::whole(scene.image.width, scene.image.height);
    let expected = if sampling.is_exact() {
        whole.pixels()
    } else {
        sampling.total()
    };
    // For the progress, every picture of an animation is assumed to be as much work as this one.
    let [before, all] = [index, count].map(|pictures| expected.saturating_mul(pictures as u64));
    watch.done.store(before, Ordering::Relaxed);
    watch.expected.store(all, Ordering::Relaxed);
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
