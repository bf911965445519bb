//! Renders pictures of scenes and writes them.

use std::{
    io::{self, IsTerminal},
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use super::{
    CommandError, command_error,
    input::{self, shown},
    output, progress,
};
use crate::{
    area::Area,
    files::{self, Purpose, Sink},
    film::{self, Film, Recipe},
    numbers,
    render::{Control, Exact, RenderError, Rendered, render_as_asked, render_bands},
    sampling::Sampling,
    scene::Scene,
    tracer::World,
};

/// Renders the area `part` of a scene's picture to pixels of type `P`. Shows a progress bar if
/// standard error is a terminal.
pub fn render_part<P: film::Pixel>(
    scene: &Scene,
    world: &World,
    part: Area,
    cancel: &AtomicBool,
) -> Result<Rendered<P>, RenderError> {
    with_progress(scene, part, cancel, |sampling, control| {
        render_as_asked(world, sampling, part, control)
    })
}

/// Runs `work`, which renders the area `part` of a scene's picture. Shows a progress bar if
/// standard error is a terminal.
fn with_progress<T>(
    scene: &Scene,
    part: Area,
    cancel: &AtomicBool,
    work: impl FnOnce(&Sampling, &Control) -> T,
) -> T {
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
    progress::rendering(expected, None, cancel, |control| work(&sampling, control))
}

/// Error bound of a pixel's mean, in linear light, above which a note tells the user that the pixel
/// is less accurate than usual. Usual bounds are below 1e-9, and an error of 1e-6 is still
/// invisible. With a much larger limit, a visible error could go without a note; with a smaller
/// one, there would be more notes about invisible errors.
const VAGUE: f32 = 1e-6;

/// Phrase for the rounding to bytes of sRGB, used in notes to the user about a PNG.
const BYTES: &str = "the 8-bit rounding";

/// Phrase for the rounding to 32-bit floats, used in notes to the user about an EXR file.
const FLOATS: &str = "the 32-bit rounding";

/// Accuracy of an exact picture, i.e. one computed without samples. The numbers are added up over
/// the picture's parts.
#[derive(Default)]
pub struct Certificate {
    pixels: u64,
    /// Number of pixels whose rounded values are proven right.
    certain: u64,
    /// Number of pixels whose error bound exceeds [`VAGUE`].
    vague: u64,
    /// Greatest error bound of a pixel's mean, in linear light, with the pixel's column and row in
    /// the whole picture.
    worst: Option<(f32, [u32; 2])>,
}

impl Certificate {
    /// Adds the error bounds of a part of the picture, `rendered`, to the certificate. Does nothing
    /// if the part was rendered with samples. `certain` returns the number of the part's pixels
    /// whose rounded values are proven right.
    fn add<P>(&mut self, rendered: &Rendered<P>, area: Area, certain: impl Fn(&Exact<P>) -> u64) {
        let Rendered::Exact(exact) = rendered else {
            return;
        };
        self.pixels += area.pixels();
        self.certain += certain(exact);
        for ((x, y), &bound) in area.iter().zip(&exact.bounds) {
            self.vague += u64::from(bound > VAGUE);
            if self.worst.is_none_or(|(worst, _)| bound > worst) {
                self.worst = Some((bound, [x, y]));
            }
        }
    }

    /// Returns a note for the user: the largest error bound of the pixels' means, and for how many
    /// pixels the rounded values are proven right. `what` is the phrase for the rounding, [`BYTES`]
    /// or [`FLOATS`]. The note is empty if the picture was rendered with samples.
    fn note(&self, what: &str) -> String {
        let Some((worst, [x, y])) = self.worst else {
            return String::new();
        };
        let rounding = match self.pixels - self.certain {
            0 => format!("{what} of every pixel is certain"),
            1 => format!("{what} of all pixels but one is certain"),
            others => format!(
                "{what} of all pixels but {} is certain",
                numbers::grouped(others)
            ),
        };
        let bound = numbers::at_most(f64::from(worst));
        let mean = if worst == 0.0 {
            // If the largest bound is 0, nothing was averaged: each pixel has only one colour.
            "its pixel's only colour".to_owned()
        } else {
            format!("within {bound} of its true mean")
        };
        let mut text = format!("exact: every channel is {mean}; {rounding}\n");
        if self.vague > 0 {
            let pixels = match self.vague {
                1 => "one pixel is".to_owned(),
                more => format!("{} pixels are", numbers::grouped(more)),
            };
            text += &format!(
                "exact: {pixels} known less well than to a millionth, least of all the one at column {x}, row {y}: within {bound}\n"
            );
        }
        text
    }
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
    /// The program, which derived the path from the scene's name. If the path is a link that leads
    /// out of the scene's folder, writing fails.
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
    /// scene. Returns an error if the file's extension is not that of a picture, or if the scene
    /// comes from standard input and no output is named.
    pub fn of(scene: &Path, output: Option<&Path>) -> Result<Self, CommandError> {
        let path = match output {
            Some(path) if input::is_standard(path) => return Ok(Self::Standard),
            Some(path) => path,
            None if input::is_standard(scene) => {
                return Err(command_error(
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
    pub fn check(&self, scene: &Path) -> Result<(), CommandError> {
        match self {
            Self::Standard if io::stdout().is_terminal() => Err(command_error(
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

    /// Renders the area `part` of a scene's picture and writes it, band by band. Returns a note for
    /// the user about the accuracy of an exact picture, or an empty text for a sampled picture.
    /// Shows a progress bar if standard error is a terminal. Fails if `cancel` is set.
    pub fn render(
        &self,
        scene: &Scene,
        world: &World,
        part: Area,
        recipe: &Recipe,
        path_of_scene: &Path,
        cancel: &AtomicBool,
    ) -> Result<String, CommandError> {
        let whole = Area::whole(scene.image.width, scene.image.height);
        match self {
            Self::File(_, FileFormat::Exr, _) => {
                let write = |out: &mut dyn Sink, bands: &mut Bands<[f32; 3]>| {
                    film::write_exr_bands(part, whole, Some(&recipe.digest()), out, bands)
                };
                self.write_bands(scene, world, part, path_of_scene, cancel, write)
            }
            _ => {
                let write = |out: &mut dyn Sink, bands: &mut Bands<[u8; 3]>| {
                    let size = [part.width, part.height];
                    film::write_png_bands(size, Some(recipe), out, bands)
                };
                self.write_bands(scene, world, part, path_of_scene, cancel, write)
            }
        }
    }

    fn write_bands<P: film::Pixel>(
        &self,
        scene: &Scene,
        world: &World,
        part: Area,
        path_of_scene: &Path,
        cancel: &AtomicBool,
        write: impl FnOnce(&mut dyn Sink, &mut Bands<P>) -> io::Result<()>,
    ) -> Result<String, CommandError> {
        let mut certificate = Certificate::default();
        let mut failed = None;
        let written = with_progress(scene, part, cancel, |sampling, control| {
            let bands = render_bands(world, sampling, part, control)?;
            let mut rendered = bands.map(|band| {
                let (area, rendered) = band?;
                certificate.add(&rendered, area, |exact| exact.certain);
                Ok::<_, RenderError>(rendered.into_film())
            });
            // The first band is rendered before the file is opened. If it is the only band, as in
            // all but very large pictures, no temporary file is left if this process is killed
            // while it renders.
            let first = rendered.next();
            let mut all = first.into_iter().chain(rendered).map(|band| {
                band.map_err(|error| {
                    failed = Some(error);
                    io::Error::from(io::ErrorKind::Other)
                })
            });
            self.write(path_of_scene, cancel, |out| write(out, &mut all))
        });
        match (failed, written) {
            (Some(error), _) => Err(error.into()),
            (None, written) => written.map(|()| certificate.note(self.rounding())),
        }
    }

    /// Writes a picture that was rendered already, with the note about its accuracy. Fails if
    /// `cancel` is set.
    pub fn write_rendered(
        &self,
        scene: &Path,
        rendered: &Rendered,
        recipe: &Recipe,
        cancel: &AtomicBool,
    ) -> Result<String, CommandError> {
        let film = rendered.film();
        let whole = Area::whole(film.width(), film.height());
        let mut certificate = Certificate::default();
        self.write(scene, cancel, |out| match self {
            Self::File(_, FileFormat::Exr, _) => {
                certificate.add(rendered, whole, |exact| exact.certain);
                film::write_exr(film, whole, whole, Some(&recipe.digest()), out)
            }
            _ => {
                let certain = |exact: &Exact| film::certified(&exact.film, &exact.bounds);
                certificate.add(rendered, whole, certain);
                film::write_png(film, Some(recipe), out)
            }
        })?;
        Ok(certificate.note(self.rounding()))
    }

    /// Returns the phrase for the rounding of pixels in the output.
    fn rounding(&self) -> &'static str {
        match self {
            Self::File(_, FileFormat::Exr, _) => FLOATS,
            _ => BYTES,
        }
    }

    /// Writes the content that the function `write` produces. Fails if `cancel` is set.
    pub fn write(
        &self,
        scene: &Path,
        cancel: &AtomicBool,
        write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
    ) -> Result<(), CommandError> {
        let written = match self {
            Self::Standard => files::write_stream(output::StandardOutput::new(), cancel, |out| {
                write(&mut Unseekable(out))
            }),
            Self::File(path, _, path_choice) => {
                // The path is checked again, since it may have become a link to the scene during
                // rendering.
                check_is_not(path, scene)?;
                files::write(path, path_choice.purpose(path), cancel, write)
            }
        };
        written.map_err(|error| command_error(format!("cannot write to {self}: {error}")))
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

/// The pictures of a part's bands, or the error that ended the render.
type Bands<'a, P> = dyn Iterator<Item = io::Result<Film<P>>> + 'a;

/// Adapter for a stream that cannot seek. It makes the stream a [`Sink`], which requires the
/// trait `Seek`. Only formats that write their bytes in order can be written to it.
struct Unseekable<'a>(&'a mut dyn io::Write);

impl io::Write for Unseekable<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl io::Seek for Unseekable<'_> {
    fn seek(&mut self, _: io::SeekFrom) -> io::Result<u64> {
        Err(io::ErrorKind::NotSeekable.into())
    }
}

/// Rejects a picture that would overwrite its scene.
fn check_is_not(path: &Path, scene: &Path) -> Result<(), CommandError> {
    if input::is_same_file(path, scene) {
        return Err(command_error(format!(
            "{} is the scene itself: say with `-o FILE` where the picture goes",
            shown(path)
        )));
    }
    Ok(())
}

impl std::fmt::Display for PictureOutput {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File(path, ..) => f.write_str(&shown(path)),
            Self::Standard => f.write_str("standard output"),
        }
    }
}

/// Returns the format that belongs to a file's extension, or an error if it is neither `.png` nor
/// `.exr`.
fn format(path: &Path) -> Result<FileFormat, CommandError> {
    let name = path.to_string_lossy().to_ascii_lowercase();
    if name.ends_with(".png") {
        Ok(FileFormat::Png)
    } else if name.ends_with(".exr") {
        Ok(FileFormat::Exr)
    } else {
        Err(command_error(format!(
            "the ending of {} stands for no format: a picture's file ends in .png or .exr",
            shown(path)
        )))
    }
}
