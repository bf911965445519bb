//! `grade`: grades the submissions of a class for one scene.
//!
//! 1. The module `class` finds the students and their files. It uses `tree`, which lists folders
//!    and zip files, `archive`, which reads zip files, `names`, which knows the naming schemes of
//!    Moodle, Gradescope and GitHub Classroom, and `glob`, which matches file names.
//! 2. The module `submission` chooses each student's newest pictures. They are compared with the
//!    exact picture of the scene, and `graded` contains the verdicts. The module `points` computes
//!    a score from the verdict; `criteria` assigns each mistake to an object or a topic.
//! 3. The modules `table`, `page`, `junit`, `gradescope` and `moodle` write the results, each in
//!    its format. The HTML page contains `thumbnails`.

mod archive;
mod class;
mod criteria;
mod glob;
mod graded;
mod gradescope;
mod junit;
mod moodle;
mod names;
mod page;
mod points;
mod submission;
mod table;
mod thumbnails;
mod tree;

use std::{
    collections::BTreeMap,
    num::NonZero,
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
    thread,
};

use hmac_sha256::Hash;
use rayon::{ThreadPoolBuilder, prelude::*};
use serde_json::json;

use self::{
    class::Class,
    glob::Glob,
    graded::{ComparedPicture, GradedStudent, JudgedPicture},
    points::PointScheme,
    submission::{Student, SubmittedFile},
    thumbnails::Pictures,
};
use super::{
    CommandError, Status,
    args::{GradeArgs, GradeFormat},
    command_error, diff,
    input::{SceneInput, check_standard, not_written, shown},
    interrupt::Interrupt,
    judge, output, progress,
};
use crate::{
    area::Area,
    diagnostic::visible_line,
    files::OutputFolder,
    film::{self, Film, Jpeg, Rounding},
    grading::{self, Reference},
    render::{Control, RenderError},
    scene::Scene,
};

/// Names of the files that `grade` writes into the output folder, besides the pictures.
const FILES: [&str; 3] = ["index.html", "grade.csv", "grade.jsonl"];

/// Grades the submissions that the arguments name, and writes the results.
pub fn run(args: &GradeArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let scene = input.scene()?;
    let points = args.points.as_deref().map(PointScheme::read).transpose()?;
    let class = class(args)?;
    let names = output_names(args, &class);
    let folder = args.output.as_deref();
    let folder = folder.map(|folder| OutputFolder::open(folder, names.iter().map(String::as_str)));
    let folder = folder.transpose().map_err(not_written)?;
    let cancel = interrupt.watch();
    let (mut graded, exact) = graded(args, &scene, &class, cancel)?;
    mark_equal(&mut graded);
    for one in &mut graded {
        let judged = one.best().ok();
        one.score = points.as_ref().and_then(|points| points.score(judged?));
    }
    for one in &graded {
        if let Some(warning) = one.best().ok().and_then(|judged| judged.warning) {
            output::warning(&format!("{}: {warning}", visible_line(one.file())));
        }
    }
    let mut files = print_results(args, &scene, &graded, points.as_ref())?;
    if let Some(mut folder) = folder {
        let total = points.map(|points| points.total);
        files.extend(page_files(args, &graded, exact, total));
        folder.write(&files).map_err(not_written)?;
    }
    let has_compared = graded.iter().any(|one| one.best().is_ok());
    if class.is_one_missing || !has_compared {
        return Ok(Status::Failed);
    }
    let status = graded.iter().map(GradedStudent::status).max();
    Ok(status.unwrap_or(Status::Done))
}

/// Reads the students and their files. The teacher's own files are left out.
fn class(args: &GradeArgs) -> Result<Class, CommandError> {
    let own = [
        Some(&args.scene),
        args.output.as_ref(),
        args.points.as_ref(),
        args.worksheet.as_ref(),
    ];
    let own: Vec<&Path> = own.into_iter().flatten().map(AsRef::as_ref).collect();
    let mut read = args.pictures.clone();
    read.push(args.scene.clone());
    check_standard(&read)?;
    let chosen = args.picture.as_deref().map(Glob::new);
    let class = Class::read(&args.pictures, &own, chosen.as_ref())?;
    if class.students.is_empty() {
        return Err(class::no_students(&args.pictures));
    }
    let needs_one = args.format == GradeFormat::Gradescope && args.output.is_none();
    if needs_one && class.students.len() > 1 {
        return Err(command_error(format!(
            "there are {} students, and each has a results.json: say with `-o DIR` where they go",
            class.students.len()
        )));
    }
    if args.format == GradeFormat::Moodle && args.worksheet.is_none() {
        return Err(command_error(
            "Moodle takes back the worksheet of grades that it gave: name it with `--worksheet FILE`",
        ));
    }
    Ok(class)
}

/// Returns the names of all files that may be written into the output folder. Before any picture is
/// judged, the folder is searched for the user's own files with these names, so that none is
/// replaced.
fn output_names(args: &GradeArgs, class: &Class) -> Vec<String> {
    let pictures = (0..class.students.len()).flat_map(page::names);
    let own = FILES.map(str::to_owned).into_iter().chain(pictures);
    own.chain([page::EXACT.to_owned()])
        .chain(worksheet_name(args))
        .collect()
}

fn worksheet_name(args: &GradeArgs) -> Option<String> {
    let name = args.worksheet.as_ref()?.file_name()?.to_string_lossy();
    // The worksheet gets another name if one of the command's own output files has its name.
    Some(if FILES.contains(&&*name) {
        format!("moodle-{name}")
    } else {
        name.into_owned()
    })
}

/// Prints the results in the format of `--format`. If there is an output folder, results for
/// Gradescope and Moodle are not printed, but returned as files to write into this folder.
fn print_results(
    args: &GradeArgs,
    scene: &Scene,
    graded: &[GradedStudent],
    points: Option<&PointScheme>,
) -> Result<Vec<(String, Vec<u8>)>, CommandError> {
    match args.format {
        GradeFormat::Human => output::answer(&table::table(graded))?,
        GradeFormat::Json => output::to_programs(lines(graded).as_bytes())?,
        GradeFormat::Csv => output::to_programs(table::csv(graded).as_bytes())?,
        GradeFormat::Junit => {
            let xml = junit::junit(&args.scene.display().to_string(), graded);
            output::to_programs(xml.as_bytes())?;
        }
        GradeFormat::Gradescope => {
            let results = |one| format!("{:#}\n", gradescope::results(one, scene, points));
            if args.output.is_none() {
                output::to_programs(results(&graded[0]).as_bytes())?;
                return Ok(Vec::new());
            }
            let names = gradescope::folders(graded).into_iter();
            let files = names
                .zip(graded)
                .map(|(name, one)| (format!("{name}/results.json"), results(one).into_bytes()));
            return Ok(files.collect());
        }
        GradeFormat::Moodle => {
            let (Some(path), Some(name)) = (&args.worksheet, worksheet_name(args)) else {
                return Ok(Vec::new());
            };
            let total = points.map(|points| points.total);
            let filled = moodle::filled(path, &args.columns, graded, total)?;
            if args.output.is_none() {
                output::to_programs(&filled)?;
                return Ok(Vec::new());
            }
            return Ok(vec![(name, filled)]);
        }
    }
    Ok(Vec::new())
}

fn lines(graded: &[GradedStudent]) -> String {
    graded
        .iter()
        .map(|one| format!("{}\n", one.json()))
        .collect()
}

/// Returns the HTML page, the pictures that it shows, and the CSV and JSON files, each with its
/// file name.
fn page_files(
    args: &GradeArgs,
    graded: &[GradedStudent],
    exact: Vec<u8>,
    total: Option<f64>,
) -> Vec<(String, Vec<u8>)> {
    let html = page::page(&shown(&args.scene), graded, total);
    let [page, table, answers] = FILES.map(str::to_owned);
    let mut files = vec![
        (page, html.into_bytes()),
        (table, table::csv(graded).into_bytes()),
        (answers, lines(graded).into_bytes()),
        (page::EXACT.to_owned(), exact),
    ];
    for (index, one) in graded.iter().enumerate() {
        let Some(pictures) = one.best().ok().and_then(|judged| judged.pictures.as_ref()) else {
            continue;
        };
        let [picture, heat] = pictures.whole.clone();
        let all = [Some(picture), Some(heat), pictures.exact.clone()];
        let named = page::names(index).into_iter().zip(all);
        files.extend(named.filter_map(|(name, bytes)| Some((name, bytes?))));
    }
    files
}

/// Records which students have pictures that are equal in every pixel. Exactly right pictures are
/// skipped, since they are naturally equal.
fn mark_equal(graded: &mut [GradedStudent]) {
    let mut same = BTreeMap::<[u8; 32], Vec<usize>>::new();
    for (index, one) in graded.iter().enumerate() {
        if let Ok(judged) = one.best()
            && judged.word() != "right"
        {
            same.entry(judged.hash).or_default().push(index);
        }
    }
    for group in same.values().filter(|group| group.len() > 1) {
        for &own in group {
            let others = group.iter().filter(|&&other| other != own);
            graded[own].equal_to = others.map(|&other| graded[other].name.clone()).collect();
        }
    }
}

/// The results of all students, and the scene's exact picture as a PNG file. The file is empty if
/// no HTML page is written.
type Answers = (Vec<GradedStudent>, Vec<u8>);

/// Grades the students in parallel. Unless `--threads` is given, there is a thread for each
/// processor.
fn graded(
    args: &GradeArgs,
    scene: &Scene,
    class: &Class,
    cancel: &AtomicBool,
) -> Result<Answers, CommandError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let threads = args.threads.count();
    let threads = threads.or_else(|| thread::available_parallelism().ok());
    let reference = progress::rendering(whole.pixels(), threads, cancel, |control| {
        let reference = Reference::new(scene, whole, Rounding::Byte, control);
        reference.map(|reference| reference.with_effort(args.effort.effort))
    })?;
    let exact = match args.output {
        // Writing into memory does not fail, so an error need not be handled.
        Some(_) => thumbnails::png(&reference.exact.film).unwrap_or_default(),
        None => Vec::new(),
    };
    let students = &class.students;
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads.map_or(1, NonZero::get).min(students.len()).max(1))
        .build()
        .map_err(|error| command_error(format!("cannot start threads: {error}")))?;
    let chosen = args.picture.as_deref().map(Glob::new);
    let graded = progress::watched(students.len() as u64, |done| {
        let grade = |student: &Student| {
            let choice = student.choice(chosen.as_ref());
            let grade = |file: &&SubmittedFile| {
                let result = grade(file, class, scene, &reference, args, cancel)?;
                Ok(ComparedPicture {
                    path: file.path.clone(),
                    shown: file.shown.clone(),
                    result,
                })
            };
            let compared: Result<Vec<_>, RenderError> = choice.pictures.iter().map(grade).collect();
            let mut compared = compared?;
            compared.sort_by(|a, b| {
                let order = a.rank().partial_cmp(&b.rank());
                order.unwrap_or(std::cmp::Ordering::Equal)
            });
            done.fetch_add(1, Ordering::Relaxed);
            Ok(GradedStudent {
                name: student.name.clone(),
                number: student.number.clone(),
                place: student.place.clone(),
                compared,
                chosen: args.picture.clone(),
                not_compared: choice.others,
                equal_to: Vec::new(),
                score: None,
            })
        };
        pool.install(|| {
            students
                .par_iter()
                .map(grade)
                .collect::<Result<Vec<_>, RenderError>>()
        })
    });
    Ok((graded?, exact))
}

/// Judges a picture. Returns an inner error if the picture cannot be judged, and an outer error if
/// rendering fails.
fn grade(
    file: &SubmittedFile,
    class: &Class,
    scene: &Scene,
    whole: &Reference,
    args: &GradeArgs,
    cancel: &AtomicBool,
) -> Result<Result<JudgedPicture, String>, RenderError> {
    let read = file.picture(&args.large, &class.budget);
    let read = read.and_then(|bytes| Ok((judge::picture(&bytes, &args.large)?, bytes)));
    let (picture, bytes) = match read {
        Ok(read) => read,
        Err(error) => return Ok(Err(error)),
    };
    let part = match judge::part(&picture, scene, args.crop) {
        Ok(part) => part,
        Err(misfit) => {
            let place = film::place_of_part(&picture.film, &whole.exact.film);
            let place = place.map_or_else(String::new, |place| {
                format!("; it fits best at `--crop {place}`")
            });
            return Ok(Err(format!("it {misfit}{place}")));
        }
    };
    let own;
    let reference = if whole.is_for(part, picture.rounding) {
        whole
    } else {
        let control = Control {
            // Several pictures are judged in parallel, so each of them gets one thread.
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
    let verdict = reference.judge(&picture, Jpeg::of(&bytes), &comparison, cancel)?;
    let pictures = args.output.is_some().then(|| {
        let is_whole = part == whole.part;
        let tolerance = reference.tolerance(steps);
        Pictures::new(&picture.film, &reference.exact.film, tolerance, is_whole)
    });
    let pictures = match pictures.transpose() {
        Ok(pictures) => pictures,
        Err(error) => return Ok(Err(error.to_string())),
    };
    let sizes = [[part.width, part.height]; 2];
    let figures = grading::figures(sizes, Some(&comparison), steps, Some(&verdict));
    let names = [file.shown.clone(), args.scene.display().to_string()];
    let mut fields = diff::json(names, figures);
    let is_ours = film::read_recipe(&bytes).is_ok();
    fields.insert("rendered_by_pinhole".to_owned(), json!(is_ours));
    Ok(Ok(JudgedPicture {
        verdict,
        rmse: comparison.rmse,
        is_ours,
        fields,
        warning: picture.coding.warning(),
        hash: hash(&picture.film),
        pictures,
    }))
}

/// Returns the SHA-256 of a picture's width and pixels. Equal pictures have equal hashes.
fn hash(film: &Film) -> [u8; 32] {
    let mut hash = Hash::new();
    hash.update(film.width().to_le_bytes());
    for pixel in film.pixels() {
        for light in pixel {
            hash.update(light.to_bits().to_le_bytes());
        }
    }
    hash.finalize()
}
