//! What users type.

use std::{num::NonZero, path::PathBuf};

use clap::{
    Parser, Subcommand, ValueEnum,
    builder::{PossibleValuesParser, TypedValueParser},
    value_parser,
};
use clap_complete::Shell;
use pinhole::{area::Area, scene::Method};

/// Renders small declarative scene files through a virtual pinhole camera
#[derive(Debug, Parser)]
#[command(name = "pinhole", version, after_help = EXAMPLES, propagate_version = true)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXAMPLES: &str = "\
Examples:
  pinhole render figure.scn                      writes figure.png beside it
  pinhole render figure.scn -o big.exr --set image.width=3840 --set image.height=2160
  pinhole watch figure.scn                       and again whenever it is saved
  pinhole check *.scn
  pinhole inspect figure.scn --format json
  pinhole probe figure.scn 640.5 360.5
  pinhole diff mine.png figure.scn               is it the right picture, and if not, why?
  pinhole fmt *.scn

Exit status: 0 done, warnings or not; 1 the scene has errors, diff found more than its tolerance, or
fmt --check would change something; 2 usage, a file that cannot be read or written, a picture too large for memory; 130 after Ctrl-C.";

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to a picture file
    #[command(after_help = RENDER_EXAMPLES)]
    Render(RenderArgs),
    /// Report the problems of scenes
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckArgs),
    /// Write the smallest scene that shows something
    #[command(after_help = NEW_EXAMPLES)]
    New(NewArgs),
    /// Render a scene whenever its file is saved
    #[cfg(feature = "preview")]
    #[command(after_help = WATCH_EXAMPLES)]
    Watch(WatchArgs),
    /// Show what a scene means: camera, field of view, vanishing points, objects
    #[command(after_help = INSPECT_EXAMPLES)]
    Inspect(InspectArgs),
    /// Follow one ray, surface by surface
    #[command(after_help = PROBE_EXAMPLES)]
    Probe(ProbeArgs),
    /// Compare two pictures, or a picture with a scene's exact one
    #[command(after_help = DIFF_EXAMPLES)]
    Diff(DiffArgs),
    /// Judge a class's pictures of a scene
    #[command(after_help = GRADE_EXAMPLES)]
    Grade(GradeArgs),
    /// Report speed against error, method by method, or how right the arithmetic is
    #[command(after_help = REPORT_EXAMPLES)]
    Report(ReportArgs),
    /// Explain a kind of mistake, or a word of the language
    #[command(after_help = EXPLAIN_EXAMPLES)]
    Explain(ExplainArgs),
    /// Lay out scene files in the one canonical way
    #[command(after_help = FMT_EXAMPLES)]
    Fmt(FmtArgs),
    /// Serve an editor: the Language Server Protocol on standard input and output
    #[cfg(feature = "lsp")]
    #[command(after_help = LSP_HELP)]
    Lsp {
        /// What it does in any case; some editors say it
        #[arg(long)]
        stdio: bool,
    },
    /// Edit a scene as a page in the browser: text, picture, mouse
    #[cfg(feature = "studio")]
    #[command(after_help = STUDIO_EXAMPLES)]
    Studio(StudioArgs),
    /// Print a completion script for a shell
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page
    #[command(after_help = MAN_EXAMPLES)]
    Man,
}

impl Command {
    /// How many threads are asked for.
    pub fn threads(&self) -> Option<NonZero<usize>> {
        let wanted = match self {
            Self::Render(args) => args.threads,
            #[cfg(feature = "preview")]
            Self::Watch(args) => args.threads,
            Self::Diff(args) => args.threads,
            Self::Grade(args) => args.threads,
            Self::Report(args) => args.threads,
            _ => None,
        };
        NonZero::new(usize::try_from(wanted?).unwrap_or(usize::MAX))
    }
}

const RENDER_EXAMPLES: &str = "\
Examples:
  pinhole render figure.scn
  pinhole render figure.scn -o half.png --set camera.roll=30deg --set Ball.center='(0, 2, 0)'
  pinhole render figure.scn -o eyes.png --crop 600,200,80,40
  pinhole render figure.png -o again.png         renders the scene that the picture carries
  generate | pinhole render - -o - | view        from standard input to standard output";

const CHECK_EXAMPLES: &str = "\
Examples:
  pinhole check figure.scn
  pinhole check *.scn --format json              one line for each problem
  pinhole check figure.scn --fix                 and correct what can be corrected

--fix applies the first fix of each error that has one, again until nothing changes, says what it did, and reports what is \
left. A file is written whole or not at all; with -, the text goes to standard output.

JSON, an object a line: file, severity, code, message, help, labels [{offset, length, line, column, end_line, \
end_column, message}], fixes [{title, edits [{offset, length, text}]}]. The first label is the place to jump to. A fix \
is a way out that needs no other: each of its edits replaces length bytes at offset by text; offsets count in the text as it \
was. A label or an edit within a --set argument has a file of its own. Of a file with more than 1000 problems the last line says how many more there are.";

#[cfg(feature = "preview")]
const WATCH_EXAMPLES: &str = "\
Examples:
  pinhole watch figure.scn                       writes figure.png at once and after every save
  pinhole watch figure.scn --show                and draws it in the terminal
  pinhole watch figure.scn -o draft.png --set sampler.per_pixel=4

While the text has mistakes, they are reported, and the last picture stays. A picture that is not done when \
the text changes again is given up. Ctrl-C ends it, with status 130.";

const NEW_EXAMPLES: &str = "\
Examples:
  pinhole new figure.scn                         a ball on a floor; a file that is there already is left as it is
  pinhole new figure.scn && pinhole watch figure.scn --show";

const INSPECT_EXAMPLES: &str = "\
Examples:
  pinhole inspect figure.scn
  pinhole inspect figure.scn --set camera.roll=30deg --format json";

const PROBE_EXAMPLES: &str = "\
Examples:
  pinhole probe figure.scn 640 360               the middle of a picture of 1280 × 720 pixels
  pinhole probe figure.scn -10 0.5               left of the picture";

const DIFF_EXAMPLES: &str = "\
Examples:
  pinhole diff a.png b.exr                       two pictures
  pinhole diff mine.png figure.scn               a picture with what the scene means, without noise
  pinhole diff mine.png figure.scn -o where.png  also a heat map of the differences
  pinhole diff mine.png figure.scn --strict --format json

Where B is a scene, the verdict comes first: the picture is right, right but for sampling noise, or wrong. Mistakes that explain \
the difference are named, with the --set arguments that make the scene give that picture; then what is right and what is not, \
object by object. A picture that carries a crop is compared with that part of the scene.

Differences are counted in steps of 8-bit sRGB: 1 is 1/255 of the way from black to white.

JSON: a, b, width, height (of A), size_b, rmse (in linear light, 0 to 1), largest {error, x, y, channel, \
a, b} (in steps), beyond {pixels, share}, undecided (so many pixels cannot be judged, as the exact picture's bound is too \
large there), tolerance (in steps), equal (whether no pixel is beyond it). Of two pictures of different sizes rmse, largest, beyond and \
undecided are null. With a scene also verdict (right, noise, wrong, or unknown: wrong, and not by a mistake known here), line (the \
verdict in words), samples_per_pixel (independent ones that make as much noise), mistakes [{id, message, help, set, explains}] \
(explains is the share of the squared difference beyond noise, 0 to 1), rest (the share that mistakes leave, if that is more than \
noise), objects [{index, name, right, off}] (off in pixels), limited (whether not all mistakes were tried, as the scene has too \
much in it).

Exit status: 0 for pictures within the tolerance, and for one that is right, but for noise; 1 if not, or the scene has errors; \
2 trouble, also where a picture has another size than the scene's.";

const GRADE_EXAMPLES: &str = "\
Examples:
  pinhole grade figure.scn anna.png ben.png
  pinhole grade figure.scn handed_in/ -o graded  also writes graded/index.html, grade.csv and grade.jsonl
  pinhole grade figure.scn handed_in/ --format json

Each picture is compared with the scene's exact one, as diff does it, and has a line: its name, the verdict, the root mean \
square of its differences in linear light, and the samples in a pixel that make as much noise.

JSON, an object a line: what diff prints, with file in front; and rendered_by_pinhole, whether the picture carries the \
text that Pinhole writes into its own; error instead of the rest where a picture cannot be compared.

Exit status: 0 all are right, but for noise; 1 one is wrong, or the scene has errors; 2 one could not be compared, or other trouble.";

const REPORT_USAGE: &str = "\
pinhole report [OPTIONS] <SCENE>...
       pinhole report --numerics [--inputs <N>] [--threads <N>] [--format <FORMAT>]";

const REPORT_EXAMPLES: &str = "\
Renders the scenes by every method with more and more samples, several times and in mixed order, compares \
the pictures with the exact one, and tells which method comes to an error in the least CPU time. How many samples and \
runs there are follows from the time that --budget gives, unless --samples and --runs say it.

Examples:
  pinhole report figure.scn
  pinhole report figure.scn -o speed             writes speed/index.html, charts, CSV and JSON
  pinhole report figure.scn --set image.width=640 --set image.height=360 --methods sobol,halton,exact
  pinhole report figure.scn --samples 1,2,4,8,16 --runs 5 --error 1/256 --error 0.001
  pinhole report --numerics
  pinhole report --numerics --inputs 1000000     the full count: half an hour of a processor

In CSV and JSON, times are CPU times in seconds, unless they are called wall; errors (rmse) are in linear light.";

const EXPLAIN_EXAMPLES: &str = "\
Examples:
  pinhole explain bare_angle
  pinhole explain camera                         a block, a field, a method, a function
  pinhole explain language                       the whole reference
  pinhole explain                                all codes, by subject
  pinhole explain up_parallel | less             as Markdown";

const FMT_EXAMPLES: &str = "\
Replaces each file by its canonical layout, whole or not at all, and does not touch it where nothing would change. \
Tokens, comments, and blank lines between groups stay; of line ends it matters whether a block stands on one line. A \
file with errors of syntax is left as it is.

Examples:
  pinhole fmt figure.scn
  pinhole fmt *.scn --check                      writes nothing, prints a diff of what would change
  pinhole fmt - < figure.scn > tidy.scn          from standard input to standard output

Exit status: 0 done; 1 a file has errors of syntax, or --check would change something; 2 trouble.";
#[cfg(feature = "lsp")]
const LSP_HELP: &str = "\
Editors start it themselves; grammar/editors/ has what they need for that.

Exit status: 0 after shutdown and exit; 1 if the editor left without; 2 trouble.";

#[cfg(feature = "studio")]
const STUDIO_EXAMPLES: &str = "\
Examples:
  pinhole studio figure.scn                      opens a browser
  pinhole studio                                 a new scene; Save asks for a name in the current folder
  pinhole studio figure.scn --no-open --port 8000

Serves this machine alone, and a browser that was given the printed address; no file but the scene is read or written. \
Ctrl-C ends it, with status 130.";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  pinhole completions bash > ~/.local/share/bash-completion/completions/pinhole
  pinhole completions fish > ~/.config/fish/completions/pinhole.fish";

const MAN_EXAMPLES: &str = "\
Examples:
  pinhole man > pinhole.1
  pinhole man | man -l -";

/// Which scene, and what to change in it.
#[derive(Debug, clap::Args)]
pub struct Overrides {
    /// Override a field or a `let`: TARGET is BLOCK.FIELD (image, camera, sampler or an object's name)
    /// or the name of a `let`, VALUE an expression of the language; may be given any number of times
    #[arg(long = "set", value_name = "TARGET=VALUE", allow_hyphen_values = true)]
    pub sets: Vec<String>,
}

/// Arguments of `render`.
#[derive(Debug, clap::Args)]
pub struct RenderArgs {
    /// The scene: a .scn file, a PNG that Pinhole wrote, or `-` for standard input
    pub scene: PathBuf,
    /// Where the picture goes; its ending, .png or .exr, is the format, and `-` is standard output as PNG
    /// [default: SCENE with the ending .png]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub overrides: Overrides,
    /// Render this part only, in pixels from the top left of the whole picture, within which it must lie;
    /// takes the place of the crop that a PNG carries
    #[arg(long, value_name = "X,Y,W,H", allow_hyphen_values = true)]
    pub crop: Option<Area>,
    /// How many threads to use [default: one for each processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..))]
    pub threads: Option<u64>,
}

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
pub struct CheckArgs {
    /// The scenes: .scn files, PNGs that Pinhole wrote, or `-` for standard input
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Apply the first fix of each error that has one
    #[arg(long)]
    pub fix: bool,
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
#[cfg(feature = "preview")]
#[derive(Debug, clap::Args)]
pub struct WatchArgs {
    /// The scene: a .scn file
    pub scene: PathBuf,
    /// Where the picture goes; its ending, .png or .exr, is the format [default: SCENE with the ending .png]
    #[arg(short, long = "output", value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Draw the picture in the terminal too
    #[arg(long)]
    pub show: bool,
    #[command(flatten)]
    pub overrides: Overrides,
    /// How many threads to use [default: one for each processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..))]
    pub threads: Option<u64>,
}

/// Arguments of `studio`.
#[cfg(feature = "studio")]
#[derive(Debug, clap::Args)]
pub struct StudioArgs {
    /// The scene: a .scn file [default: a new scene]
    pub scene: Option<PathBuf>,
    /// Print the address only; open no browser
    #[arg(long)]
    pub no_open: bool,
    /// The port to serve at [default: one that is free]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u16).range(1..))]
    pub port: Option<u16>,
}

/// Arguments of `inspect`.
#[derive(Debug, clap::Args)]
pub struct InspectArgs {
    /// The scene: a .scn file, a PNG that Pinhole wrote, or `-` for standard input
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

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
#[command(override_usage = REPORT_USAGE)]
pub struct ReportArgs {
    /// The scenes: .scn files, PNGs that Pinhole wrote, or `-` for standard input
    #[arg(value_name = "SCENE", required_unless_present = "numerics")]
    pub scenes: Vec<PathBuf>,
    /// The folder for index.html (a page with charts, tables and pictures), both charts as SVG, report.csv and
    /// report.json; of several scenes each has a folder in it. It is made if it is missing; a symbolic link in it is refused
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// The methods [default: all]
    #[arg(long, value_delimiter = ',', value_parser = method())]
    pub methods: Vec<Method>,
    /// Samples per pixel [default: 1,4,16 and so on, until all methods have come to the errors or the time is up]
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = value_parser!(u64).range(1..=1 << 53))]
    pub samples: Vec<u64>,
    /// Runs of each method with each number of samples [default: up to 9, as the time goes]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..=1_000_000))]
    pub runs: Option<u64>,
    /// Tell the samples and the time that this error takes, too, in linear light, such as 0.01 or 1/1000: 1/256 is always among
    /// them; may be given any number of times
    #[arg(long = "error", value_name = "E", allow_negative_numbers = true, value_parser = error)]
    pub errors: Vec<f64>,
    /// About how long a scene may take, where --samples and --runs leave a choice
    #[arg(long, value_name = "SECONDS", default_value_t = 45, allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..=1_000_000))]
    pub budget: u64,
    #[command(flatten)]
    pub overrides: Overrides,
    /// Count the wrong decisions in a catalogue of hard cases instead, against arithmetic of hundreds of bits and beside
    /// the formulas of a textbook
    #[arg(long, conflicts_with_all = ["scenes", "output", "methods", "samples", "runs", "errors", "budget", "sets"])]
    pub numerics: bool,
    /// How many inputs to ask of each case [default: 10000]
    #[arg(long, value_name = "N", requires = "numerics", conflicts_with = "scenes", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..=1_000_000_000_000))]
    pub inputs: Option<u64>,
    #[command(flatten)]
    pub format: FormatArgs,
    /// How many threads to use [default: one for each processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..))]
    pub threads: Option<u64>,
}

/// Arguments of `fmt`.
#[derive(Debug, clap::Args)]
pub struct FmtArgs {
    /// The scenes: .scn files, or `-` for standard input, which is laid out to standard output
    #[arg(required = true, value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Write nothing; print what would change as a diff, and end with status 1 if anything would
    #[arg(long)]
    pub check: bool,
}

/// Arguments of `diff`.
#[derive(Debug, clap::Args)]
pub struct DiffArgs {
    /// A picture (PNG, EXR, PPM, PGM, PAM, BMP, TIFF, WebP, GIF or JPEG) or `-` for standard input; whole numbers
    /// count as sRGB and floats as linear light, and what is transparent is seen on black
    pub a: PathBuf,
    /// Another picture, or a scene whose exact picture A is compared with
    pub b: PathBuf,
    /// Write a heat map of the differences to this PNG file: black, red, yellow, white, linear in steps of sRGB
    #[arg(short, long = "output", value_name = "HEATMAP")]
    pub output: Option<PathBuf>,
    /// How much a pixel may differ, in steps of 8-bit sRGB
    /// [default: what rounding explains, 0.5 for each picture of 8 bits, 0.002 for one of 16, 0.06 for an
    /// EXR of half floats and next to nothing for one of floats; the exact picture's own bound, as good as
    /// nothing, always comes on top]
    #[arg(long, value_name = "STEPS", allow_negative_numbers = true, value_parser = not_negative)]
    pub tolerance: Option<f64>,
    /// Let the tolerance alone decide the exit status, so that sampling noise counts; --tolerance implies it
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub overrides: Overrides,
    /// How many threads to use [default: one for each processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..))]
    pub threads: Option<u64>,
    #[command(flatten)]
    pub format: FormatArgs,
}

/// Arguments of `grade`.
#[derive(Debug, clap::Args)]
pub struct GradeArgs {
    /// The scene: a .scn file, or a PNG that Pinhole wrote
    pub scene: PathBuf,
    /// The pictures, or folders of them
    #[arg(required = true, value_name = "PICTURE")]
    pub pictures: Vec<PathBuf>,
    /// The folder for index.html, grade.csv and grade.jsonl; it is made if it is missing
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub overrides: Overrides,
    /// How many threads to use [default: one for each processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..))]
    pub threads: Option<u64>,
    #[command(flatten)]
    pub format: FormatArgs,
}

/// Arguments of `explain`.
#[derive(Debug, clap::Args)]
pub struct ExplainArgs {
    /// The code that stands in the brackets of a report, with `pinhole::` or without, a word of the language, or `language`
    /// [default: list all codes]
    #[arg(value_name = "WORD")]
    pub word: Option<String>,
}

/// For whom the answer is.
#[derive(Debug, clap::Args)]
pub struct FormatArgs {
    /// For people, on standard error, or for programs, on standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
}

/// For whom an answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Text for people
    Human,
    /// JSON for programs
    Json,
}

fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err("not a finite number".to_owned()),
        Err(_) => Err("not a number".to_owned()),
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        number if number >= 0.0 => Ok(number),
        _ => Err("a tolerance is not negative".to_owned()),
    }
}

/// A method's word.
fn method() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(methods().map(Method::name)).map(|name| {
        methods()
            .find(|method| method.name() == name)
            .unwrap_or(Method::Exact)
    })
}

/// All methods.
pub fn methods() -> impl Iterator<Item = Method> {
    Method::SAMPLED.into_iter().chain([Method::Exact])
}

/// An error as a number or a fraction.
fn error(text: &str) -> Result<f64, String> {
    let error = match text.split_once('/') {
        None => finite(text)?,
        Some((above, below)) => finite(above)? / finite(below)?,
    };
    match error > 0.0 && error <= 1.0 {
        true => Ok(error),
        false => Err("an error is above 0 and at most 1, as linear light is".to_owned()),
    }
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
