//! `diff`: two pictures, or a picture and a scene's exact one.

use std::{
    fmt::Write,
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
};

use pinhole::{
    area::Area,
    diagnostic::visible,
    film::{self, CHANNELS, Comparison, Film, HEAT_LEGEND, Picture, SizesDiffer, Tolerance},
    grade::{self, Grade},
    numbers::{grouped, short, significant},
    render::{self, Control, Exact, RenderError},
    scene::Scene,
    tracer::World,
};
use serde_json::{Value, json};

use super::{
    Status, Trouble,
    args::{DiffArgs, Format},
    input::{self, Input, is_standard, shown},
    interrupt::Interrupt,
    output, progress,
};

/// Compares.
pub fn run(args: &DiffArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    if is_standard(&args.a) && is_standard(&args.b) {
        let message = "standard input can be read once only, and `-` is given twice";
        return Err(Trouble(message.to_owned()));
    }
    if let Some(path) = &args.output {
        check_heat_map(path, args)?;
    }
    let a = input::whole(&args.a).map_err(|error| unreadable(&args.a, &error))?;
    if !film::is_picture(&a) && is_scene(&args.a) {
        return Err(Trouble(format!(
            "{} is a scene: the picture comes first, `pinhole diff PICTURE SCENE`; `pinhole render` makes one",
            shown(&args.a)
        )));
    }
    let a = read(&args.a, &a)?;
    let b = input::whole(&args.b).map_err(|error| unreadable(&args.b, &error))?;
    let cancel = interrupt.watch();
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel,
    };
    let other = if film::is_picture(&b) || is_named_as_picture(&args.b) {
        if !args.overrides.sets.is_empty() {
            let message = format!(
                "`--set` changes a scene, and {} is a picture",
                shown(&args.b)
            );
            return Err(Trouble(message));
        }
        Other::Picture(read(&args.b, &b)?)
    } else {
        let input = Input::of(&args.b, b, &args.overrides);
        let Some(scene) = input.scene().scene else {
            return Ok(Status::SceneErrors);
        };
        match exact(&scene, cancel) {
            Ok(exact) => Other::Scene(Box::new(scene), exact),
            Err(error) => return ended(error),
        }
    };

    let steps = args
        .tolerance
        .unwrap_or_else(|| a.rounding.steps() + other.rounding_steps());
    let tolerance = Tolerance {
        steps,
        bounds: other.bounds(),
    };
    let comparison = film::compare(&a.film, other.film(), tolerance);
    let is_equal = comparison.as_ref().is_ok_and(Comparison::is_equal);
    let grade = match (&other, is_equal) {
        (_, true) => Ok(Grade::default()),
        (Other::Picture(b), false) => Ok(grade::pictures(&a.film, &b.film)),
        (Other::Scene(scene, exact), false) => grade::scene(&a.film, scene, &exact.film, &control),
    };
    let grade = match grade {
        Ok(grade) => grade,
        Err(error) => return ended(error),
    };
    let report = Report {
        names: [shown(&args.a), shown(&args.b)],
        sizes: [&a.film, other.film()].map(|film| [film.width(), film.height()]),
        is_scene: matches!(other, Other::Scene(..)),
        comparison,
        tolerance: steps,
        grade,
    };
    match args.format.format {
        Format::Human => output::to_people(&report.human()),
        Format::Json => output::to_programs(format!("{}\n", report.json()).as_bytes())?,
    }
    if let Some(path) = &args.output {
        match film::heat_map(&a.film, other.film(), tolerance) {
            Ok(map) => write_heat_map(path, &map, legend(is_equal), cancel)?,
            Err(film::HeatError::Sizes(_)) => {
                output::warning(&"pictures of different sizes have no heat map");
            }
            Err(error) => return Err(Trouble(error.to_string())),
        }
    }
    Ok(match is_equal {
        true => Status::Done,
        false => Status::SceneErrors,
    })
}

/// What A is compared with.
enum Other {
    Picture(Picture),
    Scene(Box<Scene>, Exact),
}

impl Other {
    fn film(&self) -> &Film {
        match self {
            Self::Picture(picture) => &picture.film,
            Self::Scene(_, exact) => &exact.film,
        }
    }

    fn rounding_steps(&self) -> f64 {
        match self {
            Self::Picture(picture) => picture.rounding.steps(),
            Self::Scene(..) => 0.0,
        }
    }

    fn bounds(&self) -> Option<&[f32]> {
        match self {
            Self::Picture(_) => None,
            Self::Scene(_, exact) => Some(&exact.bounds),
        }
    }
}

/// Reads a picture, and warns of what its format does to colours.
fn read(path: &Path, bytes: &[u8]) -> Result<Picture, Trouble> {
    let picture = film::read_picture(bytes).map_err(|error| unreadable(path, &error))?;
    if let Some(warning) = picture.coding.warning() {
        output::warning(&format!("{}: {warning}", shown(path)));
    }
    Ok(picture)
}

fn unreadable(path: &Path, error: &dyn std::fmt::Display) -> Trouble {
    Trouble(format!("cannot read {}: {error}", shown(path)))
}

fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "scn")
}

/// Whether a file's ending is that of a picture, so that it is one, however broken.
fn is_named_as_picture(path: &Path) -> bool {
    path.extension().is_some_and(|ending| {
        [
            "png", "exr", "ppm", "pgm", "pbm", "pam", "bmp", "tif", "tiff", "webp", "gif", "jpg",
            "jpeg",
        ]
        .iter()
        .any(|own| ending.eq_ignore_ascii_case(own))
    })
}

fn ended(error: RenderError) -> Result<Status, Trouble> {
    match error {
        RenderError::Cancelled => Ok(Status::Interrupted),
        error => Err(Trouble(error.to_string())),
    }
}

pub(super) fn exact(scene: &Scene, cancel: &AtomicBool) -> Result<Exact, RenderError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    progress::watched(whole.pixels(), |done| {
        let control = Control {
            threads: None,
            progress: &|more| {
                done.fetch_add(more, Ordering::Relaxed);
            },
            cancel,
        };
        render::render_exact(&World::new_unless(scene, cancel)?, whole, &control)
    })
}

/// Whether the heat map may be written there, before the work and not after it.
fn check_heat_map(path: &Path, args: &DiffArgs) -> Result<(), Trouble> {
    if !path
        .to_string_lossy()
        .to_ascii_lowercase()
        .ends_with(".png")
    {
        return Err(Trouble(format!(
            "the ending of {} is not .png, and a heat map is a PNG",
            shown(path)
        )));
    }
    for other in [&args.a, &args.b] {
        if input::is_same_file(path, other) {
            return Err(Trouble(format!(
                "{} is compared: say with `-o HEATMAP` where else the heat map goes",
                shown(path)
            )));
        }
    }
    film::check_writable(path)
        .map_err(|error| Trouble(format!("cannot write to {}: {error}", shown(path))))
}

/// What the colours of a heat map mean.
fn legend(is_equal: bool) -> &'static str {
    match is_equal {
        true => "black all over: nothing differs by more than the tolerance",
        false => HEAT_LEGEND,
    }
}

fn write_heat_map(
    path: &Path,
    map: &Film,
    legend: &str,
    cancel: &AtomicBool,
) -> Result<(), Trouble> {
    film::write_whole(path, cancel, |out| film::write_plain_png(map, out))
        .map_err(|error| Trouble(format!("cannot write to {}: {error}", shown(path))))?;
    output::to_people(&format!("{}: {legend}\n", visible(&shown(path))));
    Ok(())
}

/// What is printed.
struct Report {
    names: [String; 2],
    sizes: [[u32; 2]; 2],
    is_scene: bool,
    comparison: Result<Comparison, SizesDiffer>,
    tolerance: f64,
    grade: Grade,
}

impl Report {
    fn human(&self) -> String {
        let mut text = String::new();
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, out: &mut String) -> std::fmt::Result {
        let [a, b] = self.names.each_ref().map(|name| visible(name));
        let b = match self.is_scene {
            true => format!("the exact picture of {b}"),
            false => b.into_owned(),
        };
        let tolerance = match self.tolerance {
            1.0 => "1 step".to_owned(),
            steps => format!("{} steps", short(steps)),
        };
        match &self.comparison {
            Err(SizesDiffer([w, h], [other_w, other_h])) => {
                writeln!(out, "{a} and {b} differ in size")?;
                writeln!(out)?;
                writeln!(out, "A         {w} x {h} pixels")?;
                writeln!(out, "B         {other_w} x {other_h} pixels")?;
            }
            Ok(found) => {
                let relation = match (found.is_equal(), found.undecided) {
                    (true, 0) => format!(
                        "are equal: no pixel differs by more than {tolerance} of 8-bit sRGB"
                    ),
                    (true, _) => format!(
                        "are equal where that is known: no pixel is known to differ by more than {tolerance} of 8-bit sRGB"
                    ),
                    (false, _) => "differ".to_owned(),
                };
                writeln!(out, "{a} and {b} {relation}")?;
                writeln!(out)?;
                writeln!(out, "size      {} x {} pixels", found.width, found.height)?;
                if !found.is_equal() {
                    let pixels = u64::from(found.width) * u64::from(found.height);
                    writeln!(
                        out,
                        "beyond    {} of {} pixels ({} %) differ by more than {tolerance} of 8-bit sRGB",
                        grouped(found.beyond),
                        grouped(pixels),
                        percent(found.share())
                    )?;
                }
                if found.undecided > 0 {
                    writeln!(
                        out,
                        "open      {} {} judged: the exact picture's bound there is too large to say that they are within the tolerance",
                        grouped(found.undecided),
                        match found.undecided {
                            1 => "pixel cannot be",
                            _ => "pixels cannot be",
                        }
                    )?;
                }
                let largest = found.largest;
                match largest.steps {
                    0.0 => writeln!(out, "largest   0: the same in every bit")?,
                    steps => writeln!(
                        out,
                        "largest   {} steps: {} of pixel ({}, {}) is {} in A and {} in B, of 255",
                        round(steps),
                        CHANNELS[largest.channel],
                        largest.x,
                        largest.y,
                        round(largest.a),
                        round(largest.b)
                    )?,
                }
                writeln!(
                    out,
                    "rmse      {} in linear light, where white is 1",
                    short(significant(found.rmse, 3))
                )?;
            }
        }
        for (place, verdict) in self.grade.likely.iter().enumerate() {
            let word = match (place, verdict.is_sure()) {
                (0, true) => "likely",
                (0, false) => "perhaps",
                _ => "or",
            };
            writeln!(out)?;
            writeln!(out, "{word:<9} {}", verdict.message)?;
            if let Some(explains) = verdict.explains {
                writeln!(
                    out,
                    "          explains {} % of the squared difference{}",
                    percent(explains),
                    match verdict.is_sure() {
                        true => "",
                        false => "; the rest is more, and something else",
                    }
                )?;
            }
            writeln!(out, "          help: {}", verdict.help)?;
        }
        let differs = self
            .comparison
            .as_ref()
            .is_ok_and(|found| !found.is_equal());
        if self.grade.may_be_noise && self.grade.is_thin {
            writeln!(out)?;
            writeln!(
                out,
                "Sampling noise would explain it, though so few pixels differ that they do not say that it is noise."
            )?;
        } else if self.grade.may_be_noise {
            writeln!(out)?;
            writeln!(
                out,
                "Samples at the same places in all pixels may explain it: it is wrong only where colours meet, and nothing says what else it is."
            )?;
        } else if self.grade.is_thin {
            writeln!(out)?;
            writeln!(
                out,
                "A simple mistake would explain it, but so few pixels tell of it that chance would, too."
            )?;
        } else if self.grade.likely.is_empty() && self.is_scene && differs {
            writeln!(out)?;
            writeln!(
                out,
                "No simple mistake explains it; `-o HEATMAP` shows where the pictures differ."
            )?;
        }
        Ok(())
    }

    fn json(&self) -> Value {
        let found = self.comparison.as_ref().ok();
        let largest = found.map(|found| {
            let largest = found.largest;
            json!({
                "error": plain(largest.steps),
                "x": largest.x,
                "y": largest.y,
                "channel": CHANNELS[largest.channel],
                "a": plain(largest.a),
                "b": plain(largest.b),
            })
        });
        let likely = self.grade.likely.iter().map(|verdict| {
            json!({
                "mistake": verdict.mistake,
                "message": verdict.message,
                "help": verdict.help,
                "rmse": verdict.rmse,
                "explains": verdict.explains,
                "sure": verdict.is_sure(),
                "off": verdict.off.map(|off| json!({
                    "right": off.right,
                    "down": off.down,
                    "outwards": off.outwards,
                })),
            })
        });
        json!({
            "a": self.names[0],
            "b": self.names[1],
            "width": self.sizes[0][0],
            "height": self.sizes[0][1],
            "size_b": self.sizes[1],
            "rmse": found.map(|found| found.rmse),
            "largest": largest,
            "beyond": found.map(|found| json!({ "pixels": found.beyond, "share": found.share() })),
            "undecided": found.map(|found| found.undecided),
            "tolerance": self.tolerance,
            "equal": found.is_some_and(Comparison::is_equal),
            "likely": likely.collect::<Vec<_>>(),
            "thin": self.grade.is_thin,
            "may_be_noise": self.grade.may_be_noise,
        })
    }
}

/// A share in per cent: few digits, but neither 0 nor 100 unless it is that.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let rounded = (10.0 * percent).round() / 10.0;
    if share > 0.0 && rounded == 0.0 {
        "less than 0.1".to_owned()
    } else if share < 1.0 && rounded == 100.0 {
        "more than 99.9".to_owned()
    } else {
        short(rounded)
    }
}

fn round(steps: f64) -> String {
    match steps < 0.1 {
        true => short(significant(steps, 3)),
        false => short((100.0 * steps).round() / 100.0),
    }
}

/// Steps without what decoding and encoding a byte leave at its end: some roundings of numbers up to 255.
fn plain(steps: f64) -> f64 {
    (1e9 * steps).round() / 1e9
}
