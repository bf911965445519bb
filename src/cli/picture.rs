//! Renders pictures of scenes and writes them.

use std::{
    io::{self, IsTerminal},
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use super::{
    Trouble,
    input::{self, shown},
    output, progress, trouble,
};
use crate::{
    area::Area,
    files::{self, Purpose},
    film::{self, LinearFilm, Recipe},
    numbers,
    render::{Exact, RenderError, Rendered, render_as_asked},
    sampling::Sampling,
    scene::Scene,
    tracer::World,
};

/// A rendered picture. Its pixels have the precision that the output needs.
pub enum RenderedPicture {
    /// Means of pixels in linear light, as 64-bit floats.
    Light(Rendered),
    /// Means of pixels in linear light, rounded to 32-bit floats, as an EXR file stores them.
    Floats(Rendered<[f32; 3]>),
    /// Pixels rounded to bytes of sRGB, as a PNG file stores them.
    Bytes(Rendered<[u8; 3]>),
}

impl RenderedPicture {
    /// Returns the picture as 64-bit floats, or `None` if the pixels were rounded.
    pub fn into_film(self) -> Option<film::Film> {
        match self {
            Self::Light(light) => Some(light.into_film()),
            Self::Floats(_) | Self::Bytes(_) => None,
        }
    }

    /// Returns a note for the user about the accuracy of an exact picture, i.e. one computed
    /// without samples. The note is empty for a sampled picture. `part` is the area that was
    /// rendered.
    pub fn notes(&self, part: Area, output: &PictureOutput) -> String {
        match self {
            Self::Light(Rendered::Sampled(_))
            | Self::Floats(Rendered::Sampled(_))
            | Self::Bytes(Rendered::Sampled(_)) => String::new(),
            Self::Light(Rendered::Exact(exact)) => match output {
                PictureOutput::File(_, FileFormat::Exr, _) => {
                    certificate(exact, part, exact.certain, FLOATS)
                }
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

/// Precision in which pixels are kept in memory. The lowest precision that the file format allows
/// is used, since it takes the least memory. If the picture is also shown in the terminal, 64-bit
/// floats are used.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum KeptPixels {
    /// Means of pixels in linear light, as 64-bit floats.
    Light,
    /// Means of pixels in linear light, rounded to 32-bit floats, as an EXR file stores them.
    Floats,
    /// Pixels rounded to bytes of sRGB, as a PNG file stores them.
    Bytes,
}

/// Renders the area `part` of a scene's picture. Shows a progress bar if standard error is a
/// terminal.
pub fn picture(
    scene: &Scene,
    world: &World,
    part: Area,
    keep: KeptPixels,
    cancel: &AtomicBool,
) -> Result<RenderedPicture, RenderError> {
    Ok(match keep {
        KeptPixels::Light => RenderedPicture::Light(render_part(scene, world, part, cancel)?),
        KeptPixels::Floats => RenderedPicture::Floats(render_part(scene, world, part, cancel)?),
        KeptPixels::Bytes => RenderedPicture::Bytes(render_part(scene, world, part, cancel)?),
    })
}

/// Renders the area `part` of a scene's picture to pixels of type `P`. Shows a progress bar if
/// standard error is a terminal.
pub fn render_part<P: film::Pixel>(
    scene: &Scene,
    world: &World,
    part: Area,
    cancel: &AtomicBool,
) -> Result<Rendered<P>, RenderError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let sampling = Sampling::new(&scene.sampler, whole.width, whole.height);
    let expected = if sampling.is_exact() {
        part.pixels()
    } else {
        // The progress bar needs only an estimate. If the scene gives a total number of samples,
        // the part may contain slightly more or fewer than its share, which does not matter.
        let share = part.pixels() as f64 / whole.pixels() as f64;
        (sampling.total() as f64 * share) as u64
    };
    progress::rendering(expected, None, cancel, |control| {
        render_as_asked(world, &sampling, part, control)
    })
}

/// Error bound of a pixel's mean, in linear light, above which the user gets a note that the pixel
/// is known less well than usual. Usual bounds are below 1e-9, and an error of 1e-6 is still
/// invisible. With a much larger limit, a visible error could go without a note; with a smaller
/// one, there would be more notes about invisible errors.
const VAGUE: f32 = 1e-6;

/// Phrase for the rounding to bytes of sRGB, used in notes to the user about a PNG.
const BYTES: &str = "the 8-bit rounding";

/// Phrase for the rounding to 32-bit floats, used in notes to the user about an EXR file.
const FLOATS: &str = "the 32-bit rounding";

/// Returns a note for the user about the accuracy of an exact picture: the largest error bound of
/// its pixels' means, and for how many pixels (`certain`) the rounded values are proven right.
/// `what` is the phrase for the rounding.
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
        // The bound is 0 only if every pixel has a single colour, so nothing was averaged and the
        // note says that the value is exact.
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
        // The user is told the column and row in the whole picture, not in the rendered part.
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

/// Destination and format of a picture.
pub enum PictureOutput {
    /// A file, with its format, and how its path was chosen.
    File(PathBuf, FileFormat, PathChoice),
    /// Standard output, as PNG.
    Standard,
}

/// Who chose the path of a file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum PathChoice {
    /// The user, on the command line.
    Explicit,
    /// The program, which derived the path from the scene's name. An existing file is replaced only
    /// if it is in the scene's folder.
    BesideScene,
}

/// Format of a picture's file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum FileFormat {
    /// PNG with bytes of sRGB. The file also contains the scene's text.
    Png,
    /// OpenEXR with floats in linear light.
    Exr,
}

impl PathChoice {
    fn purpose(self, path: &Path) -> Purpose<'_> {
        match self {
            Self::Explicit => Purpose::Named,
            Self::BesideScene => Purpose::Within(files::folder(path)),
        }
    }
}

impl PictureOutput {
    /// Returns the output that the user named. If there is none, returns the PNG file beside the
    /// scene.
    pub fn of(scene: &Path, output: Option<&Path>) -> Result<Self, Trouble> {
        let path = match output {
            Some(path) if input::is_standard(path) => return Ok(Self::Standard),
            Some(path) => path,
            None if input::is_standard(scene) => {
                return Err(trouble(
                    "the scene comes from standard input: say with `-o FILE` where the picture goes",
                ));
            }
            None => {
                let path = scene.with_extension("png");
                return Ok(Self::File(path, FileFormat::Png, PathChoice::BesideScene));
            }
        };
        let format = format(path)?;
        Ok(Self::File(path.to_owned(), format, PathChoice::Explicit))
    }

    /// Checks, before rendering, that the picture can probably be written. Rejects an output that
    /// would replace the scene.
    pub fn check(&self, scene: &Path) -> Result<(), Trouble> {
        match self {
            Self::Standard if io::stdout().is_terminal() => Err(trouble(
                "standard output is a terminal, which shows no pictures: use `-o FILE`, or a pipe",
            )),
            Self::Standard => Ok(()),
            Self::File(path, _, path_choice) => {
                check_is_not(path, scene)?;
                files::check_writable(path, path_choice.purpose(path))
                    .map_err(|error| input::unwritable(path, &error))
            }
        }
    }

    /// Returns the lowest precision of pixels that suffices for the output.
    pub fn keep(&self) -> KeptPixels {
        match self {
            Self::File(_, FileFormat::Exr, _) => KeptPixels::Floats,
            _ => KeptPixels::Bytes,
        }
    }

    /// Writes the picture of a scene. Fails if `cancel` is set. The pixels must have at least the
    /// precision that [`Self::keep`] returns.
    pub fn write(
        &self,
        scene: &Path,
        picture: &RenderedPicture,
        recipe: &Recipe,
        whole: Area,
        cancel: &AtomicBool,
    ) -> Result<(), Trouble> {
        let written = match self {
            Self::Standard => files::write_stream(output::StandardOutput::new(), cancel, |out| {
                write_png(picture, recipe, out)
            }),
            Self::File(path, format, path_choice) => {
                // The path is checked again, since it may have become a link to the scene during
                // rendering.
                check_is_not(path, scene)?;
                files::write(path, path_choice.purpose(path), cancel, |out| {
                    let linear: LinearFilm = match (format, picture) {
                        (FileFormat::Exr, RenderedPicture::Light(light)) => light.film().into(),
                        (FileFormat::Exr, RenderedPicture::Floats(floats)) => floats.film().into(),
                        _ => return write_png(picture, recipe, out),
                    };
                    film::write_exr(linear, recipe.crop.unwrap_or(whole), whole, out)
                })
            }
        };
        written.map_err(|error| trouble(format!("cannot write to {self}: {error}")))
    }

    /// Returns a warning if the scene is too long to be stored in the PNG; otherwise an empty text.
    pub fn note_of_length(&self, recipe: &Recipe) -> String {
        let carries = !matches!(self, Self::File(_, FileFormat::Exr, _));
        if !carries || recipe.fits() {
            return String::new();
        }
        output::worded_warning(&format!(
            "the scene and its overrides have more than 1 MiB of text or 1000 overrides, so {self} does not carry them"
        ))
    }
}

/// Rejects a picture that would overwrite its scene.
fn check_is_not(path: &Path, scene: &Path) -> Result<(), Trouble> {
    if input::is_same_file(path, scene) {
        return Err(trouble(format!(
            "{} is the scene itself: say with `-o FILE` where the picture goes",
            shown(path)
        )));
    }
    Ok(())
}

fn write_png(
    picture: &RenderedPicture,
    recipe: &Recipe,
    out: &mut dyn io::Write,
) -> io::Result<()> {
    match picture {
        RenderedPicture::Light(light) => film::write_png(light.film(), Some(recipe), out),
        // This cannot occur, since only the output to an EXR file keeps 32-bit floats.
        RenderedPicture::Floats(_) => Err(io::ErrorKind::InvalidInput.into()),
        RenderedPicture::Bytes(bytes) => film::write_png(bytes.film(), Some(recipe), out),
    }
}

impl std::fmt::Display for PictureOutput {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File(path, ..) => f.write_str(&shown(path)),
            Self::Standard => f.write_str("standard output"),
        }
    }
}

/// Returns the format that belongs to a file's extension.
fn format(path: &Path) -> Result<FileFormat, Trouble> {
    let name = path.to_string_lossy().to_ascii_lowercase();
    if name.ends_with(".png") {
        Ok(FileFormat::Png)
    } else if name.ends_with(".exr") {
        Ok(FileFormat::Exr)
    } else {
        Err(trouble(format!(
            "the ending of {} stands for no format: a picture's file ends in .png or .exr",
            shown(path)
        )))
    }
}
