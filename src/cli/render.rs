//! `render`: a scene becomes a picture file.

use std::{
    io::{self, IsTerminal},
    num::NonZero,
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    time::Instant,
};

use pinhole::{
    area::Area,
    film::{self, Film, Recipe},
    numbers,
    render::{self, Control, Exact, RenderError},
    sampling::Sampling,
    scene::{Method, Scene},
    tracer::World,
};

use super::{
    Status, Trouble,
    args::RenderArgs,
    input::{self, Input, shown},
    interrupt::Interrupt,
    output, progress,
};

/// Renders a scene.
pub fn run(args: &RenderArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let output = Output::of(args)?;
    let input = Input::read(&args.scene, &args.overrides)?;
    let reading = input.scene();
    // Before the hours of a render, not after them; and a file that cannot be written outweighs errors of the scene.
    output.check(args, &input)?;
    let Some(scene) = reading.scene else {
        return Ok(Status::SceneErrors);
    };
    // A crop on the command line takes the place of the one that a picture carries; both count in pixels of the whole picture.
    let crop = args.crop.or(input.crop);
    let whole = Area::whole(scene.image.width, scene.image.height);
    let part = crop.unwrap_or(whole);
    if !part.lies_in(whole) {
        let carried = match args.crop {
            Some(_) => String::new(),
            None => format!(", which {} carries,", shown(&args.scene)),
        };
        return Err(Trouble(format!(
            "the crop {part}{carried} does not lie within the picture, which has {} × {} pixels",
            whole.width, whole.height
        )));
    }
    let cancel = interrupt.watch();
    let started = Instant::now();
    let picture = match picture(&scene, part, args.threads, cancel) {
        Ok(picture) => picture,
        Err(RenderError::Cancelled) => return Ok(Status::Interrupted),
        Err(error) => return Err(Trouble(error.to_string())),
    };
    let recipe = input.recipe(crop);
    let film = picture.film();
    if let Err(error) = output.write(film, &recipe, cancel) {
        if interrupt.pressed() {
            return Ok(Status::Interrupted);
        }
        return Err(Trouble(format!("cannot write to {output}: {error}")));
    }
    if output.carries_recipe() && !recipe.fits() {
        output::warning(&format!(
            "the scene and its overrides have more than 1 MiB of text, so {output} does not carry them"
        ));
    }
    if let Picture::Exact(exact) = &picture {
        output::to_people(&certificate(exact, &output));
    }
    if output::is_watched() {
        let (width, height) = (film.width(), film.height());
        let seconds = started.elapsed().as_secs_f64();
        output::to_people(&format!(
            "wrote {output}: {width} × {height} pixels in {seconds:.2} s\n"
        ));
    }
    Ok(Status::Done)
}

enum Picture {
    Sampled(Film),
    Exact(Exact),
}

impl Picture {
    fn film(&self) -> &Film {
        match self {
            Self::Sampled(film) => film,
            Self::Exact(exact) => &exact.film,
        }
    }
}

fn picture(
    scene: &Scene,
    part: Area,
    threads: Option<u64>,
    cancel: &AtomicBool,
) -> Result<Picture, RenderError> {
    let threads =
        threads.and_then(|threads| NonZero::new(usize::try_from(threads).unwrap_or(usize::MAX)));
    let whole = Area::whole(scene.image.width, scene.image.height);
    let sampling = Sampling::new(&scene.sampler, whole.width, whole.height);
    let is_exact = scene.sampler.method == Method::Exact;
    let expected = match is_exact {
        true => part.pixels(),
        // The samples of the part, but for how the extra ones of a total fall: near enough for a bar.
        false => {
            let share = part.pixels() as f64 / whole.pixels() as f64;
            (sampling.total() as f64 * share) as u64
        }
    };
    progress::watched(expected, |done| {
        let control = Control {
            threads,
            progress: &|more| {
                done.fetch_add(more, Ordering::Relaxed);
            },
            cancel,
        };
        let world = World::new(scene);
        match is_exact {
            true => render::render_exact(&world, part, &control).map(Picture::Exact),
            false => render::render(&world, &sampling, part, &control).map(Picture::Sampled),
        }
    })
}

/// A pixel with a greater bound on its error is worth a word.
const VAGUE: f32 = 1e-6;

/// What is certain of a computed picture, and of the numbers in its file.
fn certificate(exact: &Exact, output: &Output) -> String {
    let (certified, what) = match output {
        Output::File(_, Format::Exr) => (
            film::certified_floats(&exact.film, &exact.bounds),
            "the 32-bit rounding",
        ),
        _ => (
            film::certified(&exact.film, &exact.bounds),
            "the 8-bit rounding",
        ),
    };
    let pixels = exact.bounds.len() as u64;
    let rounding = match pixels - certified {
        0 => format!("{what} of every pixel is certain"),
        1 => format!("{what} of all pixels but one is certain"),
        others => format!(
            "{what} of all pixels but {} is certain",
            numbers::grouped(others)
        ),
    };
    let bound = numbers::at_most(exact.bound());
    let mut text = format!("exact: every channel is within {bound} of its true mean; {rounding}\n");
    let vague = |bound: &&f32| **bound > VAGUE;
    let count = exact.bounds.iter().filter(vague).count() as u64;
    if let Some(least) =
        (0..exact.bounds.len()).max_by(|&a, &b| exact.bounds[a].total_cmp(&exact.bounds[b]))
        && count > 0
    {
        let width = exact.film.width() as usize;
        let (x, y) = (least % width, least / width);
        let pixels = match count {
            1 => "one pixel is".to_owned(),
            more => format!("{} pixels are", numbers::grouped(more)),
        };
        text += &format!(
            "exact: {pixels} known less well than to a millionth, least of all the one at column {x}, row {y}\n"
        );
    }
    text
}

/// Where a picture goes, and as what.
enum Output {
    /// A file.
    File(PathBuf, Format),
    /// Standard output, as PNG.
    Standard,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Png,
    Exr,
}

impl Output {
    fn of(args: &RenderArgs) -> Result<Self, Trouble> {
        let path = match &args.output {
            Some(path) if input::is_standard(path) => return Ok(Self::Standard),
            Some(path) => path.clone(),
            None if input::is_standard(&args.scene) => {
                return Err(Trouble(
                    "the scene comes from standard input: say with `-o FILE` where the picture goes"
                        .to_owned(),
                ));
            }
            None => return Ok(Self::File(args.scene.with_extension("png"), Format::Png)),
        };
        let format = format(&path)?;
        Ok(Self::File(path, format))
    }

    /// Whether the picture can be written there, as far as that can be known before.
    fn check(&self, args: &RenderArgs, input: &Input) -> Result<(), Trouble> {
        match self {
            Self::Standard if io::stdout().is_terminal() => Err(Trouble(
                "standard output is a terminal, which shows no pictures: use `-o FILE`, or a pipe"
                    .to_owned(),
            )),
            Self::Standard => Ok(()),
            Self::File(path, _) => {
                if !input.is_picture && input::is_same_file(path, &args.scene) {
                    return Err(Trouble(format!(
                        "{} is the scene itself: say with `-o FILE` where the picture goes",
                        shown(path)
                    )));
                }
                film::check_writable(path)
                    .map_err(|error| Trouble(format!("cannot write to {self}: {error}")))
            }
        }
    }

    fn write(&self, film: &Film, recipe: &Recipe, cancel: &AtomicBool) -> io::Result<()> {
        match self {
            Self::Standard => film::write_stream(io::stdout().lock(), cancel, |out| {
                film::write_png(film, recipe, out)
            }),
            Self::File(path, format) => film::write_whole(path, cancel, |out| match format {
                Format::Png => film::write_png(film, recipe, out),
                Format::Exr => film::write_exr(film, out),
            }),
        }
    }

    fn carries_recipe(&self) -> bool {
        !matches!(self, Self::File(_, Format::Exr))
    }
}

impl std::fmt::Display for Output {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File(path, _) => f.write_str(&shown(path)),
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
