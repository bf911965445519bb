//! Definitions of the command line's arguments. Their doc comments are the help texts.

mod judging;

use std::{num::NonZero, path::PathBuf};

use clap::{
    Parser, Subcommand, ValueEnum,
    builder::{PossibleValuesParser, TypedValueParser},
    value_parser,
};
use clap_complete::Shell;

use super::{help, shard::Shard, sweep::Sweep};
use crate::{
    area::Area,
    figure::{KINDS, Kind},
    scene::Method,
};

pub use self::judging::{DiffArgs, GradeArgs, GradeFormat, LargeArgs};

/// Renders small declarative scene files through a virtual pinhole camera
#[derive(Debug, Parser)]
#[command(name = "pinhole", version, after_help = help::EXAMPLES, propagate_version = true)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands, such as `render`.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to a picture file
    #[command(after_help = help::RENDER_EXAMPLES)]
    Render(RenderArgs),
    /// Report the problems of scenes
    #[command(after_help = help::CHECK_EXAMPLES)]
    Check(CheckArgs),
    /// Write the smallest scene that shows something
    #[command(after_help = help::NEW_EXAMPLES)]
    New(NewArgs),
    /// Render a scene whenever its file is saved
    #[command(after_help = help::WATCH_EXAMPLES)]
    Watch(WatchArgs),
    /// Show what a scene means: camera, field of view, vanishing points, objects
    #[command(after_help = help::INSPECT_EXAMPLES)]
    Inspect(InspectArgs),
    /// Follow one ray, surface by surface
    #[command(after_help = help::PROBE_EXAMPLES)]
    Probe(ProbeArgs),
    /// Compare two pictures, a picture with a scene's exact one, or two scenes exactly
    #[command(after_help = help::DIFF_EXAMPLES)]
    Diff(DiffArgs),
    /// Judge a class's pictures of a scene
    #[command(after_help = help::GRADE_EXAMPLES)]
    Grade(GradeArgs),
    /// Report speed against error for each method, or how accurate the arithmetic is
    #[command(after_help = help::REPORT_EXAMPLES)]
    Report(ReportArgs),
    /// Put the parts of one picture together, as a single render would have written it
    #[command(after_help = help::MERGE_EXAMPLES)]
    Merge(MergeArgs),
    /// Make a contact sheet: the pictures of scenes side by side, each with its name
    #[command(after_help = help::SHEET_EXAMPLES)]
    Sheet(SheetArgs),
    /// Draw a figure of a scene for a page of a course, as SVG
    #[command(after_help = help::FIGURE_EXAMPLES)]
    Figure(FigureArgs),
    /// Tell whether a scene solves a lesson
    #[command(after_help = help::LESSON_EXAMPLES)]
    Lesson {
        /// What to do.
        #[command(subcommand)]
        command: LessonCommand,
    },
    /// Explain a kind of mistake, or a word of the language
    #[command(after_help = help::EXPLAIN_EXAMPLES)]
    Explain(ExplainArgs),
    /// Lay out scene files in the one canonical way
    #[command(after_help = help::FMT_EXAMPLES)]
    Fmt(FmtArgs),
    /// Serve an editor: the Language Server Protocol on standard input and output
    #[cfg(feature = "lsp")]
    #[command(after_help = help::LSP_HELP)]
    Lsp {
        /// Use standard input and output, which is the default; some editors pass this option
        #[arg(long)]
        stdio: bool,
    },
    /// Edit a scene as a page in the browser: text, picture, mouse
    #[cfg(feature = "studio")]
    #[command(after_help = help::STUDIO_EXAMPLES)]
    Studio(StudioArgs),
    /// Print a completion script for a shell
    #[command(after_help = help::COMPLETIONS_EXAMPLES)]
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page
    #[command(after_help = help::MAN_EXAMPLES)]
    Man,
}

impl Command {
    /// Returns the number of threads in `--threads`, if the command has this option and the user
    /// gave it.
    pub fn threads(&self) -> Option<NonZero<usize>> {
        match self {
            Self::Render(args) => args.threads.count(),
            Self::Watch(args) => args.threads.count(),
            Self::Diff(args) => args.threads.count(),
            Self::Grade(args) => args.threads.count(),
            Self::Report(args) => args.threads.count(),
            Self::Sheet(args) => args.threads.count(),
            _ => None,
        }
    }
}

/// Arguments that override values in a scene.
#[derive(Debug, clap::Args)]
pub struct Overrides {
    /// Override a field or a `let`: TARGET is BLOCK.FIELD (image, camera, sampler or an object's
    /// name) or the name of a `let`, VALUE an expression of the language; may be given any number
    /// of times
    #[arg(long = "set", value_name = "TARGET=VALUE", allow_hyphen_values = true)]
    pub sets: Vec<String>,
}

/// Arguments that set the number of threads.
#[derive(Debug, clap::Args)]
pub struct ThreadArgs {
    /// How many threads to use [default: one for each processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..))]
    pub threads: Option<u64>,
}

impl ThreadArgs {
    /// Returns the number of threads in `--threads`, or `None` if the user did not give it.
    pub fn count(&self) -> Option<NonZero<usize>> {
        NonZero::new(usize::try_from(self.threads?).unwrap_or(usize::MAX))
    }
}

/// Arguments of `render`.
#[derive(Debug, clap::Args)]
pub struct RenderArgs {
    /// The scene: a .scn file, a PNG that Pinhole wrote, or `-` for standard input
    pub scene: PathBuf,
    /// Where the picture goes: a file that ends in .png or .exr, which selects the format, or `-`
    /// for PNG on standard output [default: SCENE with the ending .png]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub overrides: Overrides,
    /// Render only this part of the picture, in pixels from its top left. It must lie within the
    /// picture, and replaces a crop that a PNG stores
    #[arg(long, value_name = "X,Y,W,H", allow_hyphen_values = true)]
    pub crop: Option<Area>,
    /// Render the I-th of N bands of rows, so that several machines can share a picture; `merge`
    /// puts the files together
    #[arg(long, value_name = "I/N", conflicts_with_all = ["crop", "sweep"])]
    pub shard: Option<Shard>,
    /// Render N pictures, a field or a `let` going from one value to another: two numbers, angles
    /// or vectors. FILE has a place for the number of the picture, from 0, such as `roll-%03d.png`
    #[arg(long, value_name = "TARGET=FROM..TO/N", allow_hyphen_values = true)]
    pub sweep: Option<Sweep>,
    /// Skip pictures of the sweep that are there already, of this scene
    #[arg(long, requires = "sweep")]
    pub resume: bool,
    #[command(flatten)]
    pub threads: ThreadArgs,
}

/// Arguments of `merge`.
#[derive(Debug, clap::Args)]
pub struct MergeArgs {
    /// The parts: PNG or EXR files that `render` wrote with --shard or --crop
    #[arg(required = true, value_name = "PART")]
    pub parts: Vec<PathBuf>,
    /// Where the whole picture goes: a file with the ending of the parts
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: PathBuf,
}

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
pub struct CheckArgs {
    /// The scenes: .scn files, PNGs that Pinhole wrote, or `-` for standard input
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Apply the safe fixes of errors: those that delete nothing and leave no doubt what was meant
    #[arg(long)]
    pub fix: bool,
    /// With --fix, also apply fixes that guess what was meant, or that remove or change something
    #[arg(long = "unsafe", requires = "fix")]
    pub unsafe_fixes: bool,
    /// With --fix, print the changes as a unified diff, and write nothing
    #[arg(long, requires = "fix")]
    pub diff: bool,
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub format: FormatArgs,
}

/// Arguments of `new`.
#[derive(Debug, clap::Args)]
pub struct NewArgs {
    /// The file, which must not be there yet, or `-` for standard output
    pub file: PathBuf,
}

/// Arguments of `watch`.
#[derive(Debug, clap::Args)]
pub struct WatchArgs {
    /// The scene: a .scn file
    pub scene: PathBuf,
    /// Where the picture goes: a file that ends in .png or .exr, which selects the format [default:
    /// SCENE with the ending .png]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Draw the picture in the terminal too
    #[arg(long)]
    pub show: bool,
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub threads: ThreadArgs,
}

/// Arguments of `studio`.
#[cfg(feature = "studio")]
#[derive(Debug, clap::Args)]
pub struct StudioArgs {
    /// The scene: a .scn file [default: a new scene, or that of the lesson]
    pub scene: Option<PathBuf>,
    /// Show a lesson beside the text: a Markdown file, beside its scene, which has the same name
    /// with the ending .scn
    #[arg(long, value_name = "FILE")]
    pub lesson: Option<PathBuf>,
    /// Print the address only; open no browser
    #[arg(long)]
    pub no_open: bool,
    /// The port to serve at [default: one that is free]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u16).range(1..))]
    pub port: Option<u16>,
}

/// The commands of `lesson`.
#[derive(Debug, Subcommand)]
pub enum LessonCommand {
    /// Print each condition of a lesson, and whether it holds for a scene
    #[command(after_help = help::LESSON_EXAMPLES)]
    Check(LessonArgs),
}

/// Arguments of `lesson check`.
#[derive(Debug, clap::Args)]
pub struct LessonArgs {
    /// The lesson: a Markdown file, beside its scene, which has the same name with the ending .scn
    pub lesson: PathBuf,
    /// The scene to judge: a .scn file, a PNG that Pinhole wrote, or `-` for standard input
    pub scene: PathBuf,
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub format: FormatArgs,
}

/// Arguments of `inspect`.
#[derive(Debug, clap::Args)]
pub struct InspectArgs {
    /// The scene: a .scn file, a PNG that Pinhole wrote, or `-` for standard input. The
    /// visible area is computed for at most 100 objects
    pub scene: PathBuf,
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub format: FormatArgs,
}

/// Arguments of `probe`.
#[derive(Debug, clap::Args)]
pub struct ProbeArgs {
    /// The scene: a .scn file, a PNG that Pinhole wrote, or `-` for standard input
    pub scene: PathBuf,
    /// Pixels to the right of the picture's left edge; may be fractional, negative or outside
    #[arg(allow_hyphen_values = true, value_parser = finite)]
    pub x: f64,
    /// Pixels down from the picture's top edge
    #[arg(allow_hyphen_values = true, value_parser = finite)]
    pub y: f64,
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub format: FormatArgs,
}

/// Arguments of `sheet`.
#[derive(Debug, clap::Args)]
pub struct SheetArgs {
    /// The scenes: .scn files, PNGs that Pinhole wrote, or `-` for standard input
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Where the sheet goes: a file that ends in .png, or `-` for standard output
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: PathBuf,
    /// Show each scene N times, while a field or a `let` changes evenly from one value to another;
    /// the values may be numbers, angles or vectors
    #[arg(long, value_name = "TARGET=FROM..TO/N", allow_hyphen_values = true)]
    pub sweep: Option<Sweep>,
    /// Number of pictures in a row [default: about as many as there are rows]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1000))]
    pub columns: Option<u32>,
    /// The greatest width and height of a picture in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 320, value_parser = value_parser!(u32).range(1..=4096))]
    pub width: u32,
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub threads: ThreadArgs,
}

/// Arguments of `figure`.
#[derive(Debug, clap::Args)]
pub struct FigureArgs {
    /// What it shows: the camera from outside, a pixel with its samples, a triangle with its
    /// measures, the frame before and after the roll, or the patterns of all methods
    #[arg(value_parser = kind())]
    pub kind: Kind,
    /// The scene: a .scn file, a PNG that Pinhole wrote, or `-` for standard input
    pub scene: PathBuf,
    /// Where the figure goes: a file that ends in .svg, or `-` [default: standard output]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// The pixel, by its column and row from 0 [default: for `pixel`, one with an edge between
    /// several colours; for `camera`, one that shows the largest object; for `methods`, 0,0]
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true, value_parser = pixel)]
    pub pixel: Option<[u32; 2]>,
    /// The triangle, by its name [default: the first one]
    #[arg(long, value_name = "NAME")]
    pub object: Option<String>,
    #[command(flatten)]
    pub overrides: Overrides,
}

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
#[command(override_usage = help::REPORT_USAGE)]
pub struct ReportArgs {
    /// The scenes: .scn files, PNGs that Pinhole wrote, or `-` for standard input
    #[arg(value_name = "SCENE", required_unless_present = "numerics")]
    pub scenes: Vec<PathBuf>,
    /// The folder for index.html (a page with charts, tables and pictures), both charts as SVG,
    /// report.csv and report.json; with several scenes, each has a subfolder. It is created if it
    /// is missing. Its file `.pinhole` lists what Pinhole wrote; other files are never overwritten
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// The methods [default: all]
    #[arg(long, value_delimiter = ',', value_parser = method())]
    pub methods: Vec<Method>,
    /// Samples per pixel [default: 1, 4, 16 and so on, until all methods have reached the errors of
    /// --error or the time is up]
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = value_parser!(u64).range(1..=1 << 53))]
    pub samples: Vec<u64>,
    /// Number of runs of each method with each number of samples [default: up to 9, as long as time
    /// is left]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..=1_000_000))]
    pub runs: Option<u64>,
    /// Also report how many samples and how much time are needed for this RMS error in linear
    /// light, such as 0.01 or 1/1000; 1/256 is always reported; may be given any number of times
    #[arg(long = "error", value_name = "E", allow_negative_numbers = true, value_parser = error)]
    pub errors: Vec<f64>,
    /// About how many seconds a scene may take; ignored if both --samples and --runs are given
    #[arg(long, value_name = "SECONDS", default_value_t = 45, allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..=1_000_000))]
    pub budget: u64,
    #[command(flatten)]
    pub overrides: Overrides,
    /// Test accuracy instead of speed: count how often decisions in hard cases differ from those of
    /// high-precision arithmetic; textbook formulas are counted, too
    #[arg(long, conflicts_with_all = ["scenes", "output", "methods", "samples", "runs", "errors", "budget", "sets"])]
    pub numerics: bool,
    /// Number of random inputs to test in each hard case [default: 10000]
    #[arg(long, value_name = "N", requires = "numerics", conflicts_with = "scenes", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..=1_000_000_000_000))]
    pub inputs: Option<u64>,
    #[command(flatten)]
    pub format: FormatArgs,
    #[command(flatten)]
    pub threads: ThreadArgs,
}

/// Arguments of `fmt`.
#[derive(Debug, clap::Args)]
pub struct FmtArgs {
    /// The scenes: .scn files, or `-` to format standard input and write it to standard output
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Write nothing; print what would change as a diff, and end with status 1 if anything would
    #[arg(long)]
    pub check: bool,
}

/// Arguments of `explain`.
#[derive(Debug, clap::Args)]
pub struct ExplainArgs {
    /// What to explain: a code in brackets from an error message, with `pinhole::` or without; a
    /// word of the language or of its reference; or `language` [default: list all codes]
    #[arg(value_name = "WORD")]
    pub words: Vec<String>,
}

/// Arguments that select the output format of an answer.
#[derive(Debug, clap::Args)]
pub struct FormatArgs {
    /// Output for people, on standard error, or for programs, on standard output
    #[arg(long, value_enum, default_value_t = AnswerFormat::Human)]
    pub format: AnswerFormat,
}

/// Output format of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AnswerFormat {
    /// Text for people
    Human,
    /// JSON for programs
    Json,
}

fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err("not a finite number".to_owned()),
        Err(_) if text.contains(',') => {
            Err("not a number: X and Y are two arguments, as in `200 150`".to_owned())
        }
        Err(_) => Err("not a number".to_owned()),
    }
}

/// Parses a pixel's column and row, such as `200,150`.
fn pixel(text: &str) -> Result<[u32; 2], String> {
    let parts = text.split_once(',');
    let parts = parts.map(|(x, y)| [x, y].map(|part| part.trim().parse().ok()));
    match parts {
        Some([Some(x), Some(y)]) => Ok([x, y]),
        _ => Err("a pixel is its column and its row, as in `200,150`".to_owned()),
    }
}

/// Returns clap's parser for the names of kinds of figures.
fn kind() -> impl TypedValueParser<Value = Kind> {
    PossibleValuesParser::new(KINDS.map(|(name, _)| name)).map(|name| {
        let kind = KINDS.into_iter().find(|(known, _)| *known == name);
        kind.map_or(Kind::Camera, |(_, kind)| kind)
    })
}

/// Returns clap's parser for the names of sampling methods, and of `exact`, which takes no samples.
fn method() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(methods().map(Method::name)).map(|name| {
        methods()
            .find(|method| method.name() == name)
            .unwrap_or(Method::Exact)
    })
}

/// Returns all sampling methods, followed by `exact`, which takes no samples.
pub fn methods() -> impl Iterator<Item = Method> {
    Method::SAMPLED.into_iter().chain([Method::Exact])
}

/// Parses an error in linear light, written as a number (`0.01`) or a fraction (`1/1000`).
fn error(text: &str) -> Result<f64, String> {
    let error = match text.split_once('/') {
        None => finite(text)?,
        Some((above, below)) => finite(above)? / finite(below)?,
    };
    if error > 0.0 && error <= 1.0 {
        return Ok(error);
    }
    Err("an error is above 0 and at most 1, as linear light is".to_owned())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_definitions_agree_with_each_other() {
        Args::command().debug_assert();
    }
}
