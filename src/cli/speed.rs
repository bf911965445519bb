//! `report SCENE…`: reports how the error of each sampling method falls with time. The report is a
//! text, JSON, or a folder of files.

use std::{
    io,
    path::{Path, PathBuf},
    slice,
    sync::atomic::Ordering,
    time::Duration,
};

use serde_json::json;

use super::{
    CommandError, Status,
    args::{AnswerFormat, ReportArgs, methods},
    command_error,
    input::{SceneInput, check_standard, is_standard, not_written},
    interrupt::Interrupt,
    output, progress,
};
use crate::{
    files::OutputFolder,
    render::{Control, RenderError},
    report::speed::{
        self, MeasuredScene, Measurement, Request, against_samples, against_time, to_csv, to_json,
    },
    scene::{Method, Scene},
};

/// Number of steps of the progress bar. The bar shows whole per cents, so 1000 steps are more than
/// enough.
const STEPS: u64 = 1000;

/// File name of a report's HTML page.
const INDEX: &str = "index.html";

/// Names of a report's files. The HTML page comes last, since it refers to the others.
const FILES: [&str; 5] = [
    "report.csv",
    "report.json",
    "error-against-time.svg",
    "error-against-samples.svg",
    INDEX,
];

/// Measures each scene in turn and reports the results. After Ctrl-C, the measurements made so far
/// are reported.
pub fn run(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    check_standard(&args.scenes)?;
    let request = request(args);
    check_methods(&request)?;
    let folders = folders(&args.scenes);
    let output = args.output.as_deref();
    let output = output.map(|output| {
        let files = folders.iter().flat_map(|folder| files(folder));
        let names: Vec<_> = files.chain([INDEX.to_owned()]).collect();
        OutputFolder::open(output, names.iter().map(String::as_str))
    });
    let output = output.transpose().map_err(not_written)?;
    let mut subjects = Vec::new();
    let mut status = Status::Done;
    for path in &args.scenes {
        let input = SceneInput::read(path, &args.overrides)?;
        match input.scene() {
            Ok(scene) => {
                check_samples(&scene, &request)?;
                let subject = MeasuredScene {
                    name: path.display().to_string(),
                    overrides: input.overrides(),
                };
                subjects.push((subject, scene));
            }
            Err(_) => status = Status::Negative,
        }
    }
    if status != Status::Done {
        return Ok(status);
    }
    let mut measured = Vec::new();
    for (subject, scene) in &subjects {
        let Some(found) = measure(subject, scene, &request, interrupt)? else {
            break;
        };
        if args.format.format == AnswerFormat::Human {
            let gap = if measured.is_empty() { "" } else { "\n" };
            output::answer(&format!("{gap}{}", speed::text(&found)))?;
        }
        measured.push(found);
        if interrupt.pressed() {
            break;
        }
    }
    // Ctrl-C does not stop the writing of files, so that measurements are not lost.
    if let (Some(mut output), false) = (output, measured.is_empty()) {
        let mut contents = Vec::new();
        for (folder, measured) in folders.iter().zip(&measured) {
            contents.extend(files(folder).into_iter().zip(texts(measured)?));
        }
        if args.scenes.len() > 1 {
            contents.push((INDEX.to_owned(), page(&measured)?));
        }
        output.write(&contents).map_err(not_written)?;
    }
    if args.format.format == AnswerFormat::Json && !measured.is_empty() {
        let all = measured.iter().all(|measured| !measured.interrupted);
        let is_complete = all && measured.len() == subjects.len();
        let reports: Vec<_> = measured.iter().map(to_json).collect();
        let answer = json!({"complete": is_complete, "reports": reports});
        output::to_programs(format!("{answer}\n").as_bytes())?;
    }
    let is_interrupted = interrupt.pressed();
    if is_interrupted && measured.is_empty() {
        output::warning(
            &"interrupted before anything was measured: the exact picture comes first, then the methods",
        );
    }
    Ok(if is_interrupted {
        Status::Interrupted
    } else {
        Status::Done
    })
}

fn request(args: &ReportArgs) -> Request {
    Request {
        methods: if args.methods.is_empty() {
            methods().collect()
        } else {
            args.methods.clone()
        },
        samples: args.samples.clone(),
        runs: args.runs,
        errors: errors(&args.errors),
        budget: Duration::from_secs(args.budget),
    }
}

/// Returns the errors for which the report estimates the necessary samples and time: 1/256, and
/// then the errors that the user asked for, without duplicates.
fn errors(asked: &[f64]) -> Vec<f64> {
    let mut errors = vec![1.0 / 256.0];
    for &error in asked {
        if !errors.contains(&error) {
            errors.push(error);
        }
    }
    errors
}

/// Rejects `--samples` if the exact method, which uses no samples, is the only chosen method.
fn check_methods(request: &Request) -> Result<(), CommandError> {
    let is_exact = |method: &Method| *method == Method::Exact;
    if !request.samples.is_empty() && request.methods.iter().all(is_exact) {
        return Err(command_error(
            "`--samples` is for methods that take samples, and `--methods` names `exact` alone, which takes none",
        ));
    }
    Ok(())
}

/// Rejects more than 2^53 samples in a picture, the limit of the scene language.
fn check_samples(scene: &Scene, request: &Request) -> Result<(), CommandError> {
    let pixels = u64::from(scene.image.width) * u64::from(scene.image.height);
    let most = request.samples.iter().copied().max().unwrap_or(0);
    match most.checked_mul(pixels) {
        Some(total) if total <= 1 << 53 => Ok(()),
        _ => Err(command_error(format!(
            "{most} samples in each of {pixels} pixels are more than 2^53"
        ))),
    }
}

/// Measures a scene. Returns `None` if Ctrl-C is pressed before the first measurement is complete.
fn measure(
    subject: &MeasuredScene,
    scene: &Scene,
    request: &Request,
    interrupt: &Interrupt,
) -> Result<Option<Measurement>, CommandError> {
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: interrupt.watch(),
    };
    let measured = progress::watched(STEPS, |done| {
        let show_share = |share| done.store((share * STEPS as f64) as u64, Ordering::Relaxed);
        speed::measure(subject, scene, request, &control, &show_share)
    });
    match measured {
        Ok(measured) if measured.runs() == 0 => Ok(None),
        Ok(measured) => Ok(Some(measured)),
        Err(RenderError::Cancelled) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// Returns the subfolder for each scene's report, with `/` at its end. If there is only one scene,
/// its files are in the output folder itself, so the text is empty.
fn folders(scenes: &[PathBuf]) -> Vec<String> {
    if scenes.len() == 1 {
        return vec![String::new()];
    }
    let mut names = Vec::new();
    for scene in scenes {
        names.push(name(scene, &names));
    }
    names.iter().map(|name| format!("{name}/")).collect()
}

/// Returns the paths of a report's files in the subfolder `folder`, which is empty or ends with
/// `/`.
fn files(folder: &str) -> [String; 5] {
    FILES.map(|name| format!("{folder}{name}"))
}

/// Returns the contents of a report's files, in the order of [`FILES`].
fn texts(measured: &Measurement) -> Result<[String; 5], CommandError> {
    Ok([
        to_csv(measured).map_err(report_error)?,
        format!("{:#}\n", to_json(measured)),
        against_time(measured),
        against_samples(measured),
        page(slice::from_ref(measured))?,
    ])
}

fn page(measured: &[Measurement]) -> Result<String, CommandError> {
    speed::page(measured).map_err(report_error)
}

fn report_error(error: io::Error) -> CommandError {
    command_error(format!("cannot make the report: {error}"))
}

/// Returns the name of a scene's subfolder: the name of its file without extension, with a number
/// if the name is taken. It contains only letters, digits and a few other characters, and no dots
/// at its ends, so that it cannot lead out of the output folder.
fn name(scene: &Path, taken: &[String]) -> String {
    let stem = match scene.file_stem() {
        Some(stem) if !is_standard(scene) => stem.to_string_lossy().into_owned(),
        _ => String::new(),
    };
    let is_usual = |letter: char| letter.is_alphanumeric() || " .-_()+=,".contains(letter);
    let stem = stem.replace(|letter| !is_usual(letter), "_");
    let stem = match stem.trim_matches(['.', ' ']) {
        "" => "scene",
        stem => stem,
    };
    // Names are compared in lower case, since a file system may not distinguish upper and lower
    // case.
    let is_taken = |name: &String| {
        let is_same = |other: &str| other.to_lowercase() == name.to_lowercase();
        is_same(INDEX) || taken.iter().any(|other| is_same(other))
    };
    let numbered = (2..).map(|number| format!("{stem}-{number}"));
    let mut names = [stem.to_owned()].into_iter().chain(numbered);
    names.find(|name| !is_taken(name)).unwrap_or_default()
}
