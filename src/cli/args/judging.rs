//! Definitions of the arguments of `diff` and `grade`. Their doc comments are the help texts.

use std::path::PathBuf;

use clap::ValueEnum;

use super::{FormatArgs, Overrides, ThreadArgs, finite};
use crate::{area::Area, film::DECODED_LIMIT};

/// Arguments of `diff`.
#[derive(Debug, clap::Args)]
pub struct DiffArgs {
    /// A picture (PNG, EXR, PPM, PGM, PAM, BMP, TIFF, WebP, GIF or JPEG) or `-` for standard
    /// input; whole numbers count as sRGB and floats as linear light, and what is transparent
    /// is seen on black
    pub a: PathBuf,
    /// Another picture, or a scene whose exact picture A is compared with
    pub b: PathBuf,
    /// Write a heat map of the differences to this PNG file: black, red, yellow, white, linear in
    /// steps of sRGB
    #[arg(short, long = "output", value_name = "HEATMAP")]
    pub output: Option<PathBuf>,
    /// How much a pixel may differ, in steps of 8-bit sRGB [default: what rounding explains, 0.5
    /// for each picture of 8 bits, 0.002 for one of 16, 0.06 for an EXR of half floats and next to
    /// nothing for one of floats; the exact picture's own bound, as good as nothing, always comes
    /// on top]
    #[arg(long, value_name = "STEPS", allow_negative_numbers = true, value_parser = not_negative)]
    pub tolerance: Option<f64>,
    /// The part of the scene's picture that A shows, unless A says so itself
    #[arg(long, value_name = "X,Y,W,H")]
    pub crop: Option<Area>,
    /// Let the tolerance alone decide the exit status, so that sampling noise counts; --tolerance
    /// implies it
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub effort: EffortArgs,
    #[command(flatten)]
    pub large: LargeArgs,
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub threads: ThreadArgs,
    #[command(flatten)]
    pub format: FormatArgs,
}

/// Arguments of `grade`.
#[derive(Debug, clap::Args)]
pub struct GradeArgs {
    /// The scene: a .scn file, or a PNG that Pinhole wrote
    pub scene: PathBuf,
    /// The pictures, or folders or zip files with a folder or a file per student, as Moodle,
    /// Gradescope and GitHub Classroom hand them out
    #[arg(required = true, value_name = "PICTURE")]
    pub pictures: Vec<PathBuf>,
    /// The folder for index.html, its pictures, grade.csv and grade.jsonl; it is made if it is
    /// missing, and keeps a list `.pinhole` of what was made there: any other file in the way is
    /// refused
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Which files of a student may be the picture, such as `render*.png` or `out/**`; of
    /// several, the newest [default: every file with a picture's ending]
    #[arg(long, value_name = "GLOB")]
    pub picture: Option<String>,
    /// The part of the scene's picture that pictures of its size show, unless they say so
    /// themselves
    #[arg(long, value_name = "X,Y,W,H")]
    pub crop: Option<Area>,
    /// A JSON file that says what a right picture gets and what each mistake takes off
    #[arg(long, value_name = "FILE")]
    pub points: Option<PathBuf>,
    /// Moodle's worksheet of grades, to be filled in by --format moodle
    #[arg(long, value_name = "FILE")]
    pub worksheet: Option<PathBuf>,
    /// A column's heading in the worksheet, such as `Grade=Bewertung`; may be given several times
    #[arg(long, value_name = "COLUMN=HEADING")]
    pub columns: Vec<String>,
    #[command(flatten)]
    pub effort: EffortArgs,
    #[command(flatten)]
    pub large: LargeArgs,
    #[command(flatten)]
    pub overrides: Overrides,
    #[command(flatten)]
    pub threads: ThreadArgs,
    /// For people, on standard error, or for programs, on standard output
    #[arg(long, value_enum, default_value_t = GradeFormat::Human)]
    pub format: GradeFormat,
}

/// Output format of `grade`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GradeFormat {
    /// Text for people
    Human,
    /// JSON for programs, a line per student
    Json,
    /// A table for other programs
    Csv,
    /// JUnit XML, as systems of continuous integration show it
    Junit,
    /// Gradescope's results.json: of one student on standard output, of several in DIR/STUDENT/
    Gradescope,
    /// Moodle's worksheet, filled in: on standard output, or in DIR
    Moodle,
}

/// Arguments that set how much work is spent on judging a picture.
#[derive(Debug, clap::Args)]
pub struct EffortArgs {
    /// Spend up to N times as much work on a picture before the search for its mistakes ends
    #[arg(long, value_name = "N", default_value_t = 1.0, value_parser = effort)]
    pub effort: f64,
}

fn effort(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(effort) if (0.1..=1000.0).contains(&effort) => Ok(effort),
        _ => Err("it is a number from 0.1 to 1000".to_owned()),
    }
}

/// Arguments that set how large pictures may be.
#[derive(Debug, clap::Args)]
pub struct LargeArgs {
    /// Read pictures of more than 256 MiB, or of more than 2^28 bytes once they are decoded, as
    /// long as there is memory for them
    #[arg(long)]
    pub large: bool,
}

impl LargeArgs {
    /// Returns the maximum length of a picture's file, in bytes: 4 GiB with `--large`, otherwise
    /// 256 MiB.
    pub fn file_limit(&self) -> u64 {
        if self.large { 4 << 30 } else { 256 << 20 }
    }

    /// Returns the maximum length of a decoded picture, in bytes. With `--large`, only the
    /// available memory limits it.
    pub fn decoded_limit(&self) -> u64 {
        if self.large { u64::MAX } else { DECODED_LIMIT }
    }

    /// Returns the message that a picture has more than `limit` bytes or pixels (`what`). It ends
    /// with advice to use `--large`, unless the user has done so.
    pub fn hint(&self, what: &str, limit: u64) -> String {
        let way_out = if self.large {
            ""
        } else {
            ": `--large` reads it"
        };
        format!("it has more than {limit} {what}{way_out}")
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        number if number >= 0.0 => Ok(number),
        _ => Err("a tolerance is not negative".to_owned()),
    }
}
