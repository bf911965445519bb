//! `report SCENE…`: speed against error, for a terminal, for programs, and as files.

use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    time::Duration,
};

use serde_json::json;

use super::{
    Status, Trouble,
    args::{Format, ReportArgs, methods},
    input::{Input, check_standard, is_same_file, is_standard, shown},
    interrupt::Interrupt,
    output, progress,
};
use crate::{
    film,
    render::{Control, RenderError},
    report::speed::{
        self, Measurement, Request, Subject, against_samples, against_time, to_csv, to_json,
    },
    scene::{Method, Scene},
};

/// The progress bar has so many steps.
const STEPS: u64 = 1000;

/// The page on everything.
const INDEX: &str = "index.html";

/// What a folder holds, the page at the end.
const FILES: [&str; 5] = [
    "report.csv",
    "report.json",
    "error-against-time.svg",
    "error-against-samples.svg",
    INDEX,
];

/// Reports on each scene in turn. After Ctrl-C, what was measured is reported all the same.
pub fn run(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    check_standard(&args.scenes)?;
    let request = request(args);
    check_methods(&request)?;
    if let Some(folder) = &args.output {
        make_folder(folder)?;
        let index = folder.join(INDEX);
        refuse_link(&index)?;
        film::check_writable(&index).map_err(|error| cannot_write(&index, &error))?;
    }
    let mut subjects = Vec::new();
    let mut status = Status::Done;
    for path in &args.scenes {
        let input = Input::read(path, &args.overrides)?;
        match input.scene().scene {
            Some(scene) => {
                check_samples(&scene, &request)?;
                let subject = Subject {
                    name: shown(path),
                    overrides: input.recipe(None).overrides,
                };
                subjects.push((subject, scene));
            }
            None => status = Status::SceneErrors,
        }
    }
    if status != Status::Done {
        return Ok(status);
    }
    let folders = args
        .output
        .as_deref()
        .map(|folder| folders(folder, &args.scenes));
    let folders = folders.transpose()?;
    let mut measured = Vec::new();
    for (subject, scene) in &subjects {
        let Some(found) = measure(subject, scene, &request, interrupt)? else {
            break;
        };
        if args.format.format == Format::Human {
            let gap = if measured.is_empty() { "" } else { "\n" };
            output::to_people(&format!("{gap}{}", speed::text(&found)));
        }
        measured.push(found);
        if interrupt.pressed() {
            break;
        }
    }
    // What was measured is kept, so Ctrl-C does not end the writing of it.
    if let (Some(folder), Some(folders), false) = (&args.output, folders, measured.is_empty()) {
        for (folder, measured) in folders.iter().zip(&measured) {
            write_one(folder, measured)?;
        }
        if args.scenes.len() > 1 {
            write_page(folder, &measured)?;
        }
    }
    if args.format.format == Format::Json && !measured.is_empty() {
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
        methods: match args.methods.is_empty() {
            true => methods().collect(),
            false => args.methods.clone(),
        },
        samples: args.samples.clone(),
        runs: args.runs,
        errors: errors(&args.errors),
        budget: Duration::from_secs(args.budget),
    }
}

/// The error that everybody wants to know of, and those that are asked for, each once.
fn errors(asked: &[f64]) -> Vec<f64> {
    let mut errors = vec![1.0 / 256.0];
    for &error in asked {
        if !errors.contains(&error) {
            errors.push(error);
        }
    }
    errors
}

/// Samples are for those who take them.
fn check_methods(request: &Request) -> Result<(), Trouble> {
    let is_exact = |method: &Method| *method == Method::Exact;
    match !request.samples.is_empty() && request.methods.iter().all(is_exact) {
        true => Err(Trouble(
            "`--samples` is for methods that take samples, and `--methods` names `exact` alone, which takes none"
                .to_owned(),
        )),
        false => Ok(()),
    }
}

/// The language's limit on samples holds here too.
fn check_samples(scene: &Scene, request: &Request) -> Result<(), Trouble> {
    let pixels = u64::from(scene.image.width) * u64::from(scene.image.height);
    let most = request.samples.iter().copied().max().unwrap_or(0);
    match most.checked_mul(pixels) {
        Some(total) if total <= 1 << 53 => Ok(()),
        _ => Err(Trouble(format!(
            "{most} samples in each of {pixels} pixels are more than 2^53"
        ))),
    }
}

/// What is measured of a scene; nothing if Ctrl-C comes before anything is.
fn measure(
    subject: &Subject,
    scene: &Scene,
    request: &Request,
    interrupt: &Interrupt,
) -> Result<Option<Measurement>, Trouble> {
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: interrupt.watch(),
    };
    let measured = progress::watched(STEPS, |done| {
        let tell = |share| done.store((share * STEPS as f64) as u64, Ordering::Relaxed);
        speed::measure(subject, scene, request, &control, &tell)
    });
    match measured {
        Ok(measured) if measured.runs() == 0 => Ok(None),
        Ok(measured) => Ok(Some(measured)),
        Err(RenderError::Cancelled) => Ok(None),
        Err(error) => Err(Trouble(error.to_string())),
    }
}

/// Where the report of each scene goes: of one into the folder itself, of several each into a folder there, under a page on all. What cannot be
/// written, or would write over a scene, is refused before anything is measured.
fn folders(folder: &Path, scenes: &[PathBuf]) -> Result<Vec<PathBuf>, Trouble> {
    let mut names = Vec::new();
    if scenes.len() > 1 {
        for scene in scenes {
            names.push(name(scene, &names));
        }
    }
    let mut folders: Vec<_> = names.iter().map(|name| folder.join(name)).collect();
    for folder in &folders {
        refuse_link(folder)?;
        check_folder(folder)?;
    }
    if folders.is_empty() {
        folders.push(folder.to_owned());
    }
    let files = folders
        .iter()
        .flat_map(|folder| FILES.map(|file| folder.join(file)));
    for file in files.chain([folder.join(INDEX)]) {
        refuse_link(&file)?;
        if let Some(scene) = scenes.iter().find(|scene| is_same_file(&file, scene)) {
            return Err(Trouble(format!(
                "the report would write over the scene {}",
                shown(scene)
            )));
        }
    }
    Ok(folders)
}

fn write_one(folder: &Path, measured: &Measurement) -> Result<(), Trouble> {
    make_folder(folder)?;
    let csv = folder.join("report.csv");
    let texts = [
        to_csv(measured).map_err(|error| cannot_write(&csv, &error))?,
        format!("{:#}\n", to_json(measured)),
        against_time(measured),
        against_samples(measured),
    ];
    for (name, text) in FILES.into_iter().zip(texts) {
        write_file(&folder.join(name), &text)?;
    }
    write_page(folder, std::slice::from_ref(measured))
}

fn write_page(folder: &Path, measured: &[Measurement]) -> Result<(), Trouble> {
    let path = folder.join(INDEX);
    let page = speed::page(measured).map_err(|error| cannot_write(&path, &error))?;
    write_file(&path, &page)
}

fn write_file(path: &Path, text: &str) -> Result<(), Trouble> {
    let go_on = AtomicBool::new(false);
    film::write_whole(path, &go_on, |out| out.write_all(text.as_bytes()))
        .map_err(|error| cannot_write(path, &error))
}

/// A report writes nothing outside of its folder, whatever links there are in it.
fn refuse_link(path: &Path) -> Result<(), Trouble> {
    match path.is_symlink() {
        true => Err(Trouble(format!(
            "{} is a symbolic link, and a report writes nothing outside of its folder",
            shown(path)
        ))),
        false => Ok(()),
    }
}

fn check_folder(folder: &Path) -> Result<(), Trouble> {
    match folder.is_file() {
        true => Err(Trouble(format!(
            "{} is a file, and the report is a folder of files",
            shown(folder)
        ))),
        false => Ok(()),
    }
}

fn make_folder(folder: &Path) -> Result<(), Trouble> {
    check_folder(folder)?;
    fs::create_dir_all(folder).map_err(|error| cannot_write(folder, &error))
}

fn cannot_write(path: &Path, error: &io::Error) -> Trouble {
    Trouble(format!("cannot write to {}: {error}", shown(path)))
}

/// A scene's folder: its file's name without the ending, with a number if another one has that, or the page. It is a name within the report's
/// folder, whatever the file is called: no dots at its ends, and nothing but letters, digits and what is usual between them.
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
    // There are file systems that do not tell capital letters from small ones.
    let is_taken = |name: &String| {
        let is_same = |other: &str| other.to_lowercase() == name.to_lowercase();
        is_same(INDEX) || taken.iter().any(|other| is_same(other))
    };
    let numbered = (2..).map(|number| format!("{stem}-{number}"));
    let mut names = [stem.to_owned()].into_iter().chain(numbered);
    names.find(|name| !is_taken(name)).unwrap_or_default()
}
