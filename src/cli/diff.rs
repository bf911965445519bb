//! `diff`: compares two pictures, a picture with a scene, or two scenes. A scene is compared by its
//! exact picture, which is computed without sampling noise.

use std::{fmt::Write, path::Path, sync::atomic::AtomicBool};

use serde_json::{Map, Value, json};

use super::{
    CommandError, Status,
    args::{AnswerFormat, DiffArgs, LargeArgs},
    command_error,
    exact_pictures::{self, EXACT_STEPS, is_scene},
    input::{
        self, FileBytes, IfNotPicture, SceneInput, is_standard, shown, unreadable, unwritable,
    },
    interrupt::Interrupt,
    judge::{self, quoted},
    output, progress,
};
use crate::{
    diagnostic::{visible, visible_line},
    files::{self, Purpose},
    film::{self, CHANNELS, Comparison, Film, HEAT_LEGEND, Jpeg, Picture, SizesDiffer, Tolerance},
    grading::{self, Kind, ObjectVerdict, Reference, Verdict},
    numbers::{grouped, short, significant},
};

/// Compares the files of the arguments A and B. If A is a picture and B a scene, the verdict on A
/// decides the exit status, unless `--strict` or `--tolerance` is given. Otherwise, the status is
/// [`Status::Done`] if all differences are within the tolerance.
pub fn run(args: &DiffArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    if is_standard(&args.a) && is_standard(&args.b) {
        let message = "standard input can be read once only, and `-` is given twice";
        return Err(command_error(message));
    }
    if let Some(path) = &args.output {
        check_heat_map(path, args)?;
    }
    let a = input::read_picture_or(&args.a, &args.large, IfNotPicture::ReadStart);
    let a = match a.map_err(|error| unreadable(&args.a, &error))? {
        FileBytes::Other(_) if is_scene(&args.a) && is_scene(&args.b) => {
            let cancel = interrupt.watch();
            let [a, b] = exact_pictures::of_scenes(args, cancel)?;
            return compare(args, [&a, &b], EXACT_STEPS, cancel);
        }
        FileBytes::Other(_) if is_scene(&args.a) => {
            return Err(command_error(format!(
                "{} is a scene: the picture comes first, `pinhole diff PICTURE SCENE`; `pinhole render` makes one",
                shown(&args.a)
            )));
        }
        FileBytes::Picture(bytes) | FileBytes::Other(bytes) => bytes,
    };
    let jpeg = Jpeg::of(&a);
    let a = read(&args.a, &a, &args.large)?;
    // If B has the extension of a picture format, it is read as a picture, even if it is damaged
    // and looks like a text.
    let is_named = judge::is_named_as_picture(&args.b);
    let most = if is_named {
        IfNotPicture::ReadStart
    } else {
        IfNotPicture::ReadScene
    };
    let b = input::read_picture_or(&args.b, &args.large, most);
    let (b, is_picture) = match b.map_err(|error| unreadable(&args.b, &error))? {
        FileBytes::Picture(bytes) => (bytes, true),
        FileBytes::Other(bytes) => (bytes, is_named),
    };
    let cancel = interrupt.watch();
    if is_picture {
        if !args.overrides.sets.is_empty() {
            let message = format!(
                "`--set` changes a scene, and {} is a picture",
                shown(&args.b)
            );
            return Err(command_error(message));
        }
        let b = read(&args.b, &b, &args.large)?;
        let steps = a.rounding.steps() + b.rounding.steps();
        return compare(args, [&a.film, &b.film], steps, cancel);
    }

    let input = SceneInput::of(&args.b, b, &args.overrides);
    let scene = input.scene()?;
    let part = judge::part(&a, &scene, args.crop)
        .map_err(|misfit| command_error(format!("{} {misfit}", shown(&args.a))))?;
    let reference = progress::rendering(part.pixels(), None, cancel, |control| {
        let reference = Reference::new(&scene, part, a.rounding, control);
        reference.map(|reference| reference.with_effort(args.effort.effort))
    })?;
    let steps = args.tolerance.unwrap_or_else(|| a.rounding.steps());
    let comparison = reference
        .compare(&a.film, steps)
        .map_err(|error| command_error(error.to_string()))?;
    let verdict = reference.judge(&a, jpeg, &comparison, cancel)?;
    let is_equal = comparison.is_equal();
    let is_right = matches!(verdict.kind, Kind::Right | Kind::Noise);
    let is_strict = args.strict || args.tolerance.is_some();
    let report = DiffReport {
        names: [&args.a, &args.b].map(|path| path.display().to_string()),
        sizes: [[part.width, part.height]; 2],
        comparison: Ok(comparison),
        tolerance: steps,
        verdict: Some(verdict),
        is_strict,
    };
    report.print(args.format.format)?;
    let films = [&a.film, &reference.exact.film];
    write_heat_map(args, films, reference.tolerance(steps), is_equal, cancel)?;
    Ok(status(if is_strict { is_equal } else { is_right }))
}

/// Compares two films and prints the result without a verdict. `steps` is the default tolerance, in
/// steps of 8-bit sRGB (1/255 of the way from black to white).
fn compare(
    args: &DiffArgs,
    films: [&Film; 2],
    steps: f64,
    cancel: &AtomicBool,
) -> Result<Status, CommandError> {
    let steps = args.tolerance.unwrap_or(steps);
    let bounds = None;
    let tolerance = Tolerance { steps, bounds };
    let comparison = film::compare(films[0], films[1], tolerance);
    let is_equal = comparison.as_ref().is_ok_and(Comparison::is_equal);
    let report = DiffReport {
        names: [&args.a, &args.b].map(|path| path.display().to_string()),
        sizes: films.map(|film| [film.width(), film.height()]),
        comparison,
        tolerance: steps,
        verdict: None,
        is_strict: true,
    };
    report.print(args.format.format)?;
    write_heat_map(args, films, tolerance, is_equal, cancel)?;
    Ok(status(is_equal))
}

fn status(is_accepted: bool) -> Status {
    if is_accepted {
        Status::Done
    } else {
        Status::Negative
    }
}

/// Decodes the picture `bytes` of the file `path`. Warns if its file format changes colours, as
/// JPEG does. Returns an error if the picture cannot be decoded.
fn read(path: &Path, bytes: &[u8], large: &LargeArgs) -> Result<Picture, CommandError> {
    let picture = judge::picture(bytes, large).map_err(|error| unreadable(path, &error))?;
    if let Some(warning) = picture.coding.warning() {
        output::warning(&format!("{}: {warning}", shown(path)));
    }
    Ok(picture)
}

/// Checks, before the comparison, that the heat map can be written to `path`.
fn check_heat_map(path: &Path, args: &DiffArgs) -> Result<(), CommandError> {
    if !path
        .to_string_lossy()
        .to_ascii_lowercase()
        .ends_with(".png")
    {
        return Err(command_error(format!(
            "the ending of {} is not .png, and a heat map is a PNG",
            shown(path)
        )));
    }
    check_is_not_compared(path, args)?;
    files::check_writable(path, Purpose::Named).map_err(|error| unwritable(path, &error))
}

/// Rejects a heat map's path that names one of the compared files.
fn check_is_not_compared(path: &Path, args: &DiffArgs) -> Result<(), CommandError> {
    for other in [&args.a, &args.b] {
        if input::is_same_file(path, other) {
            return Err(command_error(format!(
                "{} is compared: say with `-o HEATMAP` where else the heat map goes",
                shown(path)
            )));
        }
    }
    Ok(())
}

fn write_heat_map(
    args: &DiffArgs,
    [a, b]: [&Film; 2],
    tolerance: Tolerance,
    is_equal: bool,
    cancel: &AtomicBool,
) -> Result<(), CommandError> {
    let Some(path) = &args.output else {
        return Ok(());
    };
    if [a.width(), a.height()] != [b.width(), b.height()] {
        output::warning(&"pictures of different sizes have no heat map");
        return Ok(());
    }
    let map = film::heat_map(a, b, tolerance).map_err(|error| command_error(error.to_string()))?;
    // The path is checked again, since it may have become a link to a compared file during the
    // comparison.
    check_is_not_compared(path, args)?;
    files::write(path, Purpose::Named, cancel, |out| {
        film::write_png(&map, None, out)
    })
    .map_err(|error| unwritable(path, &error))?;
    let legend = if is_equal {
        "black all over: nothing differs by more than the tolerance"
    } else {
        HEAT_LEGEND
    };
    output::to_people(&format!("{}: {legend}\n", shown(path)));
    Ok(())
}

/// Result of `diff`, which is printed as text or as JSON.
struct DiffReport {
    names: [String; 2],
    sizes: [[u32; 2]; 2],
    comparison: Result<Comparison, SizesDiffer>,
    tolerance: f64,
    /// Verdict on picture A: whether it is right and, if not, which mistakes explain the
    /// differences. `None` unless A is a picture and B a scene.
    verdict: Option<Verdict>,
    /// Whether the tolerance decides the exit status, not the verdict. It is `true` if there is no
    /// verdict.
    is_strict: bool,
}

impl DiffReport {
    fn print(&self, format: AnswerFormat) -> Result<(), CommandError> {
        match format {
            AnswerFormat::Human => output::answer(&self.human())?,
            AnswerFormat::Json => output::to_programs(format!("{}\n", self.json()).as_bytes())?,
        }
        Ok(())
    }

    fn human(&self) -> String {
        let mut text = String::new();
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, out: &mut String) -> std::fmt::Result {
        let [a, b] = self.names.each_ref().map(|name| visible_line(name));
        let b = match self.verdict {
            Some(_) => format!("the exact picture of {b}"),
            None => b.into_owned(),
        };
        let tolerance = match self.tolerance {
            1.0 => "1 step".to_owned(),
            steps => format!("{} steps", short(steps)),
        };
        if let Some(verdict) = &self.verdict {
            let line = match (verdict.kind, self.is_strict) {
                (Kind::Right, true) => format!("right: no pixel differs by more than {tolerance}"),
                (Kind::Noise, true) => format!("beyond the tolerance, but {}", verdict.line()),
                _ => verdict.line(),
            };
            writeln!(out, "{}", visible(&line))?;
            write_mistakes(verdict, out)?;
            writeln!(out)?;
        }
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
        Ok(())
    }

    fn json(&self) -> Value {
        let figures = grading::figures(
            self.sizes,
            self.comparison.as_ref().ok(),
            self.tolerance,
            self.verdict.as_ref(),
        );
        Value::Object(json(self.names.clone(), figures))
    }
}

/// Returns the fields of the JSON output: the names of A and B, and then `figures`, the results of
/// the comparison.
pub fn json([a, b]: [String; 2], figures: Map<String, Value>) -> Map<String, Value> {
    let names = [("a", json!(a)), ("b", json!(b))];
    let names = names.map(|(name, value)| (name.to_owned(), value));
    names.into_iter().chain(figures).collect()
}

/// Writes the mistakes that the verdict names, and those that it only guesses. If the picture is
/// wrong, also lists which objects of the scene are drawn right.
fn write_mistakes(verdict: &Verdict, out: &mut String) -> std::fmt::Result {
    let named = verdict.mistakes.iter().map(|mistake| ("mistake", mistake));
    let guessed = verdict.guesses.iter().map(|guess| ("guess  ", guess));
    for (title, mistake) in named.chain(guessed) {
        writeln!(out)?;
        writeln!(out, "{title}   {}", visible(&mistake.message))?;
        writeln!(
            out,
            "          explains {} % of the squared difference beyond noise",
            percent(mistake.explains)
        )?;
        writeln!(out, "          help: {}", visible(&mistake.help))?;
        if !mistake.set.is_empty() {
            let sets = mistake.set.iter();
            let sets: Vec<_> = sets.map(|set| format!("--set {}", quoted(set))).collect();
            writeln!(out, "          {}", visible(&sets.join(" ")))?;
        }
    }
    if let Some(rest) = verdict.rest {
        writeln!(out)?;
        writeln!(out, "rest      {} % is something else", percent(rest))?;
    }
    if verdict.is_cut {
        writeln!(out)?;
        writeln!(
            out,
            "limit     the search stopped at its limit, and not all mistakes were tried: a greater --effort tries more"
        )?;
    }
    if matches!(verdict.kind, Kind::Wrong | Kind::Unknown) {
        writeln!(out)?;
        writeln!(out, "objects   {}", visible(&objects(verdict)))?;
    }
    Ok(())
}

/// Lists the scene's objects, and says which of them are drawn right. If the scene has more than 12
/// objects, names at most 12 wrong objects, and only counts further wrong objects and all right
/// ones.
fn objects(verdict: &Verdict) -> String {
    /// Maximum number of objects that are listed. If the scene has more, objects that are right are
    /// only counted. Chosen so that the list takes a few lines; any similar number works.
    const MOST: usize = 12;
    let all = &verdict.objects;
    let is_all = all.len() <= MOST;
    let is_listed = |object: &&ObjectVerdict| is_all || !object.is_right;
    let listed: Vec<_> = all.iter().filter(is_listed).take(MOST).collect();
    let mut parts: Vec<String> = listed.iter().map(|object| state(object)).collect();
    let right = all.iter().filter(|object| object.is_right).count();
    let unlisted = all.len() - right - listed.iter().filter(|object| !object.is_right).count();
    if unlisted > 0 {
        parts.push(format!("{} others not right", grouped(unlisted as u64)));
    }
    if !is_all {
        parts.push(format!("{} right", grouped(right as u64)));
    }
    parts.push(if verdict.is_background_right {
        "background right".to_owned()
    } else {
        "background wrong".to_owned()
    });
    parts.join(", ")
}

fn state(object: &ObjectVerdict) -> String {
    let title = || object.title.trim_start_matches("the ").to_owned();
    let name = object.name.clone().unwrap_or_else(title);
    match (object.is_right, object.off.round()) {
        (true, _) => format!("{name} right"),
        (false, 0.0) => format!("{name} wrong"),
        (false, 1.0) => format!("{name} off by 1 pixel"),
        (false, pixels) => format!("{name} off by {} pixels", short(pixels)),
    }
}

/// Formats a share as a percentage with one decimal. A share just above 0 becomes `less than 0.1`,
/// and a share just below 1 becomes `more than 99.9`.
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
    if steps < 0.1 {
        short(significant(steps, 3))
    } else {
        short((100.0 * steps).round() / 100.0)
    }
}
