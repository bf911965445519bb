//! A text's picture as a file, rendered as the scene asks for.

use std::{io::Cursor, sync::atomic::AtomicBool};

use crate::{
    area::Area,
    film::{self, Film, Recipe},
    render::{self, Control, RenderError},
    sampling::Sampling,
    scene::{self, Method, Scene},
    source::{Source, Sources},
    tracer::World,
};

/// A format of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Bytes of sRGB, and the scene.
    Png,
    /// Linear light.
    Exr,
}

/// The file of the picture that `pinhole render` makes of a text.
///
/// # Errors
///
/// The text has errors, the picture is too large, or `cancel` was set: why there is none, in words.
pub fn file(text: &str, format: Format, cancel: &AtomicBool) -> Result<Vec<u8>, String> {
    let sources = Sources::new(Source::from_text("scene.scn", text));
    let scene = scene::read(&sources).scene.ok_or("the scene has errors")?;
    let whole = Area::whole(scene.image.width, scene.image.height);
    let mut bytes = Vec::new();
    let out = Cursor::new(&mut bytes);
    let written = match format {
        Format::Png => {
            let film = bytes_of(&scene, whole, cancel).map_err(|error| error.to_string())?;
            let recipe = Recipe {
                scene: text.to_owned(),
                overrides: Vec::new(),
                crop: None,
            };
            film::write_png(&film, &recipe, out)
        }
        Format::Exr => {
            let film = light_of(&scene, whole, cancel).map_err(|error| error.to_string())?;
            film::write_exr(&film, whole, whole, out)
        }
    };
    written.map_err(|error| error.to_string())?;
    Ok(bytes)
}

fn bytes_of(scene: &Scene, whole: Area, cancel: &AtomicBool) -> Result<Film<[u8; 3]>, RenderError> {
    let world = World::new_unless(scene, cancel)?;
    match scene.sampler.method {
        Method::Exact => {
            render::render_exact_bytes(&world, whole, &control(cancel)).map(|exact| exact.film)
        }
        _ => render::render_bytes(&world, &sampling(scene), whole, &control(cancel)),
    }
}

fn light_of(scene: &Scene, whole: Area, cancel: &AtomicBool) -> Result<Film, RenderError> {
    let world = World::new_unless(scene, cancel)?;
    match scene.sampler.method {
        Method::Exact => {
            render::render_exact(&world, whole, &control(cancel)).map(|exact| exact.film)
        }
        _ => render::render(&world, &sampling(scene), whole, &control(cancel)),
    }
}

fn sampling(scene: &Scene) -> Sampling {
    Sampling::new(&scene.sampler, scene.image.width, scene.image.height)
}

fn control(cancel: &AtomicBool) -> Control<'_> {
    Control {
        threads: None,
        progress: &|_| {},
        cancel,
    }
}
