//! `grade`: a class's pictures against one scene.

use std::{
    fs,
    num::NonZero,
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
    thread,
};

use rayon::{ThreadPoolBuilder, prelude::*};
use serde_json::json;

use super::{
    Status, Trouble,
    args::{Format, GradeArgs, LargeArgs},
    diff,
    grade_page::page,
    graded::{Graded, Judged, csv, table},
    input::{self, Compared, Input, Most, not_written, shown, unreadable},
    interrupt::Interrupt,
    judge, output, progress,
    thumbnails::Thumbnails,
};
use crate::{
    area::Area,
    diagnostic::visible_line,
    files::OutputFolder,
    film::{self, Jpeg, Picture, Rounding},
    grading::Reference,
    render::{Control, RenderError},
    scene::Scene,
};

/// What a folder gets.
const FILES: [&str; 3] = ["index.html", "grade.csv", "grade.jsonl"];

/// Judges them.
pub fn run(args: &GradeArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let input = Input::read(&args.scene, &args.overrides)?;
    let Some(scene) = input.scene().scene else {
        return Ok(Status::SceneErrors);
    };
    let paths = pictures(&args.pictures)?;
    let folder = args.output.as_deref();
    let folder = folder.map(|folder| OutputFolder::open(folder, FILES));
    let folder = folder.transpose().map_err(not_written)?;
    let cancel = interrupt.watch();
    let graded = match graded(args, &scene, &paths, cancel) {
        Ok(Ok(graded)) => graded,
        Ok(Err(RenderError::Cancelled)) => return Ok(Status::Interrupted),
        Ok(Err(error)) => return Err(Trouble(error.to_string())),
        Err(error) => return Err(Trouble(format!("cannot start threads: {error}"))),
    };
    for (name, judged) in graded.iter().filter_map(Graded::judged) {
        if let Some(warning) = judged.warning {
            output::warning(&format!("{}: {warning}", visible_line(name)));
        }
    }
    let lines: String = graded
        .iter()
        .map(|one| format!("{}\n", one.json()))
        .collect();
    match args.format.format {
        Format::Human => output::to_people(&table(&graded)),
        Format::Json => output::to_programs(lines.as_bytes())?,
    }
    if let Some(mut folder) = folder {
        let html = page(&shown(&args.scene), &graded)
            .map_err(|error| Trouble(format!("cannot make the page: {error}")))?;
        let [page, table, answers] = FILES.map(str::to_owned);
        folder
            .write(&[(page, html), (table, csv(&graded)), (answers, lines)])
            .map_err(not_written)?;
    }
    Ok(graded
        .iter()
        .map(Graded::status)
        .max()
        .unwrap_or(Status::Done))
}

/// Each picture by itself, on as many threads as there are processors.
fn graded(
    args: &GradeArgs,
    scene: &Scene,
    paths: &[PathBuf],
    cancel: &AtomicBool,
) -> Result<Result<Vec<Graded>, RenderError>, rayon::ThreadPoolBuildError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let processors = || thread::available_parallelism().map_or(1, NonZero::get);
    let threads = args.threads.count().map_or_else(processors, NonZero::get);
    let reference = progress::watched(whole.pixels(), |done| {
        let control = Control {
            threads: NonZero::new(threads),
            progress: &|more| {
                done.fetch_add(more, Ordering::Relaxed);
            },
            cancel,
        };
        let reference = Reference::new(scene, whole, Rounding::Byte, &control);
        reference.map(|reference| reference.with_effort(args.effort.effort))
    });
    let reference = match reference {
        Ok(reference) => reference,
        Err(error) => return Ok(Err(error)),
    };
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads.min(paths.len()))
        .build()?;
    Ok(progress::watched(paths.len() as u64, |done| {
        let grade = |path: &PathBuf| {
            let result = grade(path, scene, &reference, args, cancel)?;
            done.fetch_add(1, Ordering::Relaxed);
            let name = path.display().to_string();
            Ok(Graded { name, result })
        };
        pool.install(|| paths.par_iter().map(grade).collect())
    }))
}

/// A picture judged, or why it cannot be.
fn grade(
    path: &Path,
    scene: &Scene,
    whole: &Reference,
    args: &GradeArgs,
    cancel: &AtomicBool,
) -> Result<Result<Judged, String>, RenderError> {
    let read = read(path, scene, &args.large);
    let (picture, jpeg, part, is_ours) = match read {
        Ok(read) => read,
        Err(error) => return Ok(Err(error)),
    };
    let own;
    let reference = if whole.is_for(part, picture.rounding) {
        whole
    } else {
        let control = Control {
            // Pictures are judged in parallel, each on one thread.
            threads: NonZero::new(1),
            progress: &|_| {},
            cancel,
        };
        let made = Reference::new(scene, part, picture.rounding, &control)?;
        own = made.with_effort(args.effort.effort);
        &own
    };
    let steps = picture.rounding.steps();
    let comparison = match reference.compare(&picture.film, steps) {
        Ok(comparison) => comparison,
        Err(error) => return Ok(Err(error.to_string())),
    };
    let verdict = reference.judge(&picture, jpeg, &comparison, cancel)?;
    let thumbnails = match args.output {
        Some(_) => {
            let (film, exact) = (&picture.film, &reference.exact.film);
            match Thumbnails::new(film, exact, reference.tolerance(steps)) {
                Ok(thumbnails) => Some(thumbnails),
                Err(error) => return Ok(Err(error.to_string())),
            }
        }
        None => None,
    };
    let mut fields = diff::json(
        [path, &args.scene].map(|path| path.display().to_string()),
        [[part.width, part.height]; 2],
        Some(&comparison),
        steps,
        Some(&verdict),
    );
    fields.insert("rendered_by_pinhole".to_owned(), json!(is_ours));
    Ok(Ok(Judged {
        comparison,
        verdict,
        fields,
        warning: picture.coding.warning(),
        is_ours,
        thumbnails,
    }))
}

/// A picture, how it is coded if it is a JPEG, the part of the scene that it shows, and whether Pinhole rendered it.
fn read(
    path: &Path,
    scene: &Scene,
    large: &LargeArgs,
) -> Result<(Picture, Option<Jpeg>, Area, bool), String> {
    let read = input::compared(path, large, Most::Start);
    let (Compared::Picture(bytes) | Compared::Other(bytes)) =
        read.map_err(|error| error.to_string())?;
    let picture = judge::picture(&bytes, large)?;
    let part = judge::part(&picture, scene).map_err(|misfit| format!("it {misfit}"))?;
    let is_ours = film::read_recipe(&bytes).is_ok();
    Ok((picture, Jpeg::of(&bytes), part, is_ours))
}

/// The pictures, and those in folders by name.
fn pictures(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Trouble> {
    let mut pictures = Vec::new();
    for path in paths {
        if !path.is_dir() {
            pictures.push(path.clone());
            continue;
        }
        let unreadable = |error| unreadable(path, &error);
        let mut found = Vec::new();
        for entry in fs::read_dir(path).map_err(unreadable)? {
            let entry = entry.map_err(unreadable)?.path();
            if judge::is_named_as_picture(&entry) && !entry.is_dir() {
                found.push(entry);
            }
        }
        found.sort();
        pictures.extend(found);
    }
    match pictures.is_empty() {
        true => Err(Trouble("there are no pictures in what is named".to_owned())),
        false => Ok(pictures),
    }
}
