//! Definitions of the arguments of `diff` and `grade`. Their doc comments are the help texts.

use std::path::PathBuf;

use clap::ValueEnum;

use super::{FormatArgs, Overrides, ThreadArgs, finite};
use crate::{area::Area, film::DECODED_LIMIT};

/// Arguments of `diff`.
#[derive(Debug, clap::Args)]
pub struct DiffArgs {
    /// A picture (PNG, EXR, PPM, PGM, PAM, BMP, TIFF, WebP, GIF or JPEG) or `-` for standard input;
    /// integers are read as sRGB, floats as linear light, and transparent pixels are shown on black
    pub a: PathBuf,
    /// Another picture, or a scene; the exact picture of a scene is compared with A
    pub b: PathBuf,
    /// Write a heat map of the differences to this PNG file: black within the tolerance, then red,
    /// yellow and white, linear in sRGB
    #[arg(short, long = "output", value_name = "HEATMAP")]
    pub output: Option<PathBuf>,
    /// Maximum difference of a pixel, in steps of 8-bit sRGB [default: the rounding error of the
    /// files: 0.5 for each 8-bit picture, 0.002 for a 16-bit one, 0.06 for an EXR of half floats
    /// and 0.00001 for other floats; the error bound of an exact picture, usually tiny, is always
    /// added]
    #[arg(long, value_name = "STEPS", allow_negative_numbers = true, value_parser = not_negative)]
    pub tolerance: Option<f64>,
    /// The part of the scene that picture A shows, if A's file does not store its crop
    #[arg(long, value_name = "X,Y,W,H")]
    pub crop: Option<Area>,
    /// Let the tolerance alone decide the exit status: a picture that differs only by sampling
    /// noise fails, too; --tolerance implies --strict
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
    /// The folder for index.html, its pictures, grade.csv and grade.jsonl. It is created if it is
    /// missing. Its file `.pinhole` lists what Pinhole wrote; other files are never overwritten
    #[arg(short, long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Which files of a student may be the picture, such as `render*.png` or `out/**`. If several
    /// match, the newest is judged [default: every file with the extension of a picture]
    #[arg(long, value_name = "GLOB")]
    pub picture: Option<String>,
    /// The part of the scene that pictures of this size show, unless their files store another crop
    #[arg(long, value_name = "X,Y,W,H")]
    pub crop: Option<Area>,
    /// A JSON file that says what a right picture gets and what each mistake takes off
    #[arg(long, value_name = "FILE")]
    pub points: Option<PathBuf>,
    /// Moodle's worksheet of grades, to be filled in by --format moodle
    #[arg(long, value_name = "FILE")]
    pub worksheet: Option<PathBuf>,
    /// A column's heading in the worksheet, if it is translated, such as `Grade=Bewertung`; may be
    /// given several times
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
    /// Gradescope's results.json: for one student on standard output, for several in DIR/STUDENT/
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
    /// Read pictures whose file, or whose decoded pixels, take more than 256 MiB, as long as there
    /// is memory for them
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

    /// Returns the message that a picture has more than `limit` units. `what` names the unit, such
    /// as `bytes`. Unless the user gave `--large`, the message advises to use it.
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
