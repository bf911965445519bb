//! Pictures: made of a scene, and written where they go.

use std::{
    io::{self, IsTerminal},
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
};

use super::{
    Trouble,
    input::{self, shown},
    output, progress,
};
use crate::{
    area::Area,
    files::{self, Purpose},
    film::{self, Linear, Recipe},
    numbers,
    render::{self, Control, Exact, RenderError, Rendered},
    sampling::Sampling,
    scene::Scene,
    tracer::World,
};

/// A picture, as what is kept of it.
pub enum Picture {
    /// Its means.
    Light(Rendered),
    /// Means rounded to 32 bits.
    Floats(Rendered<[f32; 3]>),
    /// Bytes of sRGB.
    Bytes(Rendered<[u8; 3]>),
}

impl Picture {
    /// How many columns and rows it has.
    pub fn size(&self) -> (u32, u32) {
        match self {
            Self::Light(light) => (light.film().width(), light.film().height()),
            Self::Floats(floats) => (floats.film().width(), floats.film().height()),
            Self::Bytes(bytes) => (bytes.film().width(), bytes.film().height()),
        }
    }

    /// Its means alone, if they were kept.
    #[cfg(feature = "preview")]
    pub fn into_film(self) -> Option<film::Film> {
        match self {
            Self::Light(light) => Some(light.into_film()),
            Self::Floats(_) | Self::Bytes(_) => None,
        }
    }

    /// What is to be said of it, which is a part of the whole picture: how exact a computed one is.
    pub fn notes(&self, part: Area, output: &Output) -> String {
        match self {
            Self::Light(Rendered::Sampled(_))
            | Self::Floats(Rendered::Sampled(_))
            | Self::Bytes(Rendered::Sampled(_)) => String::new(),
            Self::Light(Rendered::Exact(exact)) => match output {
                Output::File(_, Format::Exr, _) => certificate(exact, part, exact.certain, FLOATS),
                _ => certificate(
                    exact,
                    part,
                    film::certified(&exact.film, &exact.bounds),
                    BYTES,
                ),
            },
            Self::Floats(Rendered::Exact(exact)) => certificate(exact, part, exact.certain, FLOATS),
            Self::Bytes(Rendered::Exact(exact)) => certificate(exact, part, exact.certain, BYTES),
        }
    }
}

/// What is kept of a picture's pixels; all of the means where something else asks for them, too.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// Their means.
    Light,
    /// Means rounded to 32 bits.
    Floats,
    /// Bytes of sRGB.
    Bytes,
}

/// Renders a part of the scene's picture, and shows on a terminal how far it is.
pub fn picture(
    scene: &Scene,
    world: &World,
    part: Area,
    keep: Keep,
    cancel: &AtomicBool,
) -> Result<Picture, RenderError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let sampling = Sampling::new(&scene.sampler, whole.width, whole.height);
    let expected = match sampling.is_exact() {
        true => part.pixels(),
        // The samples of the part, but for how the extra ones of a total fall: near enough for a
        // bar.
        false => {
            let share = part.pixels() as f64 / whole.pixels() as f64;
            (sampling.total() as f64 * share) as u64
        }
    };
    progress::watched(expected, |done| {
        let control = Control {
            threads: None,
            progress: &|more| {
                done.fetch_add(more, Ordering::Relaxed);
            },
            cancel,
        };
        Ok(match keep {
            Keep::Light => {
                Picture::Light(render::render_as_asked(world, &sampling, part, &control)?)
            }
            Keep::Floats => {
                Picture::Floats(render::render_as_asked(world, &sampling, part, &control)?)
            }
            Keep::Bytes => {
                Picture::Bytes(render::render_as_asked(world, &sampling, part, &control)?)
            }
        })
    })
}

/// A pixel with a greater bound on its error is worth a word.
const VAGUE: f32 = 1e-6;

/// What is certain of the pixels of a PNG.
const BYTES: &str = "the 8-bit rounding";

/// What is certain of those of an EXR.
const FLOATS: &str = "the 32-bit rounding";

/// What is certain of a computed part of the picture, and of the numbers in its file: of so many
/// pixels what is done to them.
fn certificate<P: film::Pixel>(exact: &Exact<P>, part: Area, certain: u64, what: &str) -> String {
    let pixels = exact.bounds.len() as u64;
    let rounding = match pixels - certain {
        0 => format!("{what} of every pixel is certain"),
        1 => format!("{what} of all pixels but one is certain"),
        others => format!(
            "{what} of all pixels but {} is certain",
            numbers::grouped(others)
        ),
    };
    let mean = match exact.bound() {
        // No mean of several colours, and so without an error beyond that of the colour's own
        // numbers.
        0.0 => "its pixel's only colour".to_owned(),
        bound => format!("within {} of its true mean", numbers::at_most(bound)),
    };
    let mut text = format!("exact: every channel is {mean}; {rounding}\n");
    let vague = |bound: &&f32| **bound > VAGUE;
    let count = exact.bounds.iter().filter(vague).count() as u64;
    if let Some(least) =
        (0..exact.bounds.len()).max_by(|&a, &b| exact.bounds[a].total_cmp(&exact.bounds[b]))
        && count > 0
    {
        let width = exact.film.width() as usize;
        // Places count in pixels of the whole picture.
        let (x, y) = (
            part.x as usize + least % width,
            part.y as usize + least / width,
        );
        let pixels = match count {
            1 => "one pixel is".to_owned(),
            more => format!("{} pixels are", numbers::grouped(more)),
        };
        text += &format!(
            "exact: {pixels} known less well than to a millionth, least of all the one at column {x}, row {y}: within {}\n",
            numbers::at_most(exact.bound())
        );
    }
    text
}

/// Where a picture goes, and as what.
pub enum Output {
    /// A file.
    File(PathBuf, Format, Origin),
    /// Standard output, as PNG.
    Standard,
}

/// Where a file's name comes from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The command line.
    Given,
    /// The scene's name: only a file in its folder is replaced.
    Scene,
}

/// What a picture's file holds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Bytes of sRGB, and the scene.
    Png,
    /// Linear light.
    Exr,
}

impl Origin {
    fn purpose(self, path: &Path) -> Purpose<'_> {
        match self {
            Self::Given => Purpose::Named,
            Self::Scene => Purpose::Within(files::folder(path)),
        }
    }
}

impl Output {
    /// What is asked for, or else the PNG file beside the scene.
    pub fn of(scene: &Path, output: Option<&Path>) -> Result<Self, Trouble> {
        let path = match output {
            Some(path) if input::is_standard(path) => return Ok(Self::Standard),
            Some(path) => path,
            None if input::is_standard(scene) => {
                return Err(Trouble(
                    "the scene comes from standard input: say with `-o FILE` where the picture goes"
                        .to_owned(),
                ));
            }
            None => {
                let path = scene.with_extension("png");
                return Ok(Self::File(path, Format::Png, Origin::Scene));
            }
        };
        let format = format(path)?;
        Ok(Self::File(path.to_owned(), format, Origin::Given))
    }

    /// Whether the picture can be written there, as far as that can be known before; not in the
    /// place of what it is made of.
    pub fn check(&self, scene: &Path) -> Result<(), Trouble> {
        match self {
            Self::Standard if io::stdout().is_terminal() => Err(Trouble(
                "standard output is a terminal, which shows no pictures: use `-o FILE`, or a pipe"
                    .to_owned(),
            )),
            Self::Standard => Ok(()),
            Self::File(path, _, origin) => {
                check_is_not(path, scene)?;
                files::check_writable(path, origin.purpose(path))
                    .map_err(|error| input::unwritable(path, &error))
            }
        }
    }

    /// What it takes of the pixels.
    pub fn keep(&self) -> Keep {
        match self {
            Self::File(_, Format::Exr, _) => Keep::Floats,
            _ => Keep::Bytes,
        }
    }

    /// Writes the picture of a scene, of which as much was kept as it takes, unless `cancel` is
    /// set.
    pub fn write(
        &self,
        scene: &Path,
        picture: &Picture,
        recipe: &Recipe,
        whole: Area,
        cancel: &AtomicBool,
    ) -> Result<(), Trouble> {
        let written = match self {
            Self::Standard => files::write_stream(output::Programs::new(), cancel, |out| {
                write_png(picture, recipe, out)
            }),
            Self::File(path, format, origin) => {
                // A link may lead to the scene by now.
                check_is_not(path, scene)?;
                files::write(path, origin.purpose(path), cancel, |out| {
                    let linear: Linear = match (format, picture) {
                        (Format::Exr, Picture::Light(light)) => light.film().into(),
                        (Format::Exr, Picture::Floats(floats)) => floats.film().into(),
                        _ => return write_png(picture, recipe, out),
                    };
                    film::write_exr(linear, recipe.crop.unwrap_or(whole), whole, out)
                })
            }
        };
        written.map_err(|error| Trouble(format!("cannot write to {self}: {error}")))
    }

    /// What is to be said where the picture should carry its scene and cannot.
    pub fn note_of_length(&self, recipe: &Recipe) -> String {
        let carries = !matches!(self, Self::File(_, Format::Exr, _));
        match carries && !recipe.fits() {
            true => output::worded_warning(&format!(
                "the scene and its overrides have more than 1 MiB of text or 1000 overrides, so {self} does not carry them"
            )),
            false => String::new(),
        }
    }
}

/// Refuses to write a picture over its scene.
fn check_is_not(path: &Path, scene: &Path) -> Result<(), Trouble> {
    match input::is_same_file(path, scene) {
        false => Ok(()),
        true => Err(Trouble(format!(
            "{} is the scene itself: say with `-o FILE` where the picture goes",
            shown(path)
        ))),
    }
}

fn write_png(picture: &Picture, recipe: &Recipe, out: &mut dyn io::Write) -> io::Result<()> {
    match picture {
        Picture::Light(light) => film::write_png(light.film(), Some(recipe), out),
        // `keep` asks for them where they go into an EXR.
        Picture::Floats(_) => Err(io::ErrorKind::InvalidInput.into()),
        Picture::Bytes(bytes) => film::write_png(bytes.film(), Some(recipe), out),
    }
}

impl std::fmt::Display for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File(path, ..) => f.write_str(&shown(path)),
            Self::Standard => f.write_str("standard output"),
        }
    }
}

/// The format that a file's ending stands for.
fn format(path: &Path) -> Result<Format, Trouble> {
    let name = path.to_string_lossy().to_ascii_lowercase();
    if name.ends_with(".png") {
        Ok(Format::Png)
    } else if name.ends_with(".exr") {
        Ok(Format::Exr)
    } else {
        Err(Trouble(format!(
            "the ending of {} stands for no format: a picture's file ends in .png or .exr",
            shown(path)
        )))
    }
}
