//! `grade`: a class's pictures against one scene.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::atomic::Ordering,
};

use pinhole::{
    area::Area,
    diagnostic::visible,
    film::{self, CHANNELS, Comparison, Film, Tolerance},
    grading::{self, Kind, Reference, Verdict},
    numbers::short,
    render::{Control, Exact, RenderError},
    scene::Scene,
};
use serde_json::{Map, Value, json};

use super::{
    Status, Trouble,
    args::{Format, GradeArgs},
    diff,
    grade_page::page,
    input::{self, Input, shown},
    interrupt::Interrupt,
    output, progress,
};

/// Judges them.
pub fn run(args: &GradeArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let input = Input::read(&args.scene, &args.overrides)?;
    let Some(scene) = input.scene().scene else {
        return Ok(Status::SceneErrors);
    };
    let paths = pictures(&args.pictures)?;
    if let Some(folder) = &args.output {
        let made = fs::create_dir_all(folder);
        made.map_err(|error| Trouble(format!("cannot make {}: {error}", shown(folder))))?;
    }
    let cancel = interrupt.watch();
    let exact = match diff::exact(&scene, cancel) {
        Ok(exact) => exact,
        Err(RenderError::Cancelled) => return Ok(Status::Interrupted),
        Err(error) => return Err(Trouble(error.to_string())),
    };
    let whole = Area::whole(scene.image.width, scene.image.height);
    let reference = Reference::new(&scene, whole, &exact.film);
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel,
    };
    let graded: Result<Vec<Graded>, RenderError> = progress::watched(paths.len() as u64, |done| {
        paths
            .iter()
            .map(|path| {
                let graded = grade(path, &scene, &exact, &reference, &control);
                done.fetch_add(1, Ordering::Relaxed);
                graded
            })
            .collect()
    });
    let graded = match graded {
        Ok(graded) => graded,
        Err(RenderError::Cancelled) => return Ok(Status::Interrupted),
        Err(error) => return Err(Trouble(error.to_string())),
    };
    let lines: String = graded
        .iter()
        .map(|one| format!("{}\n", one.json()))
        .collect();
    match args.format.format {
        Format::Human => output::to_people(&table(&graded)),
        Format::Json => output::to_programs(lines.as_bytes())?,
    }
    if let Some(folder) = &args.output {
        let html = page(&shown(&args.scene), &graded, &exact.film)
            .map_err(|error| Trouble(format!("cannot make the page: {error}")))?;
        for (name, text) in [
            ("index.html", html),
            ("grade.csv", csv(&graded)),
            ("grade.jsonl", lines),
        ] {
            let path = folder.join(name);
            fs::write(&path, text)
                .map_err(|error| Trouble(format!("cannot write to {}: {error}", shown(&path))))?;
        }
    }
    Ok(graded
        .iter()
        .map(Graded::status)
        .max()
        .unwrap_or(Status::Done))
}

/// A picture that was judged, or why it could not be.
pub struct Graded {
    pub name: String,
    pub result: Result<Judged, String>,
}

/// What is known of a picture.
pub struct Judged {
    pub film: Film,
    pub comparison: Comparison,
    pub verdict: Verdict,
    /// Whether it carries the text that Pinhole writes into its pictures.
    pub is_ours: bool,
}

fn grade(
    path: &Path,
    scene: &Scene,
    exact: &Exact,
    reference: &Reference,
    control: &Control,
) -> Result<Graded, RenderError> {
    let name = shown(path);
    let read = input::whole(path)
        .map_err(|error| error.to_string())
        .and_then(|bytes| {
            let picture = film::read_picture(&bytes).map_err(|error| error.to_string())?;
            Ok((picture, film::read_recipe(&bytes).is_ok()))
        });
    let (picture, is_ours) = match read {
        Ok(read) => read,
        Err(error) => {
            return Ok(Graded {
                name,
                result: Err(error),
            });
        }
    };
    let tolerance = Tolerance {
        steps: picture.rounding.steps(),
        bounds: Some(&exact.bounds),
    };
    let comparison = match film::compare(&picture.film, &exact.film, tolerance) {
        Ok(comparison) => comparison,
        Err(_) => {
            let error = format!(
                "it has {} x {} pixels, and the scene's picture {} x {}",
                picture.film.width(),
                picture.film.height(),
                scene.image.width,
                scene.image.height
            );
            return Ok(Graded {
                name,
                result: Err(error),
            });
        }
    };
    let verdict = reference.judge(&picture.film, &comparison, control)?;
    let judged = Judged {
        film: picture.film,
        comparison,
        verdict,
        is_ours,
    };
    Ok(Graded {
        name,
        result: Ok(judged),
    })
}

/// The pictures, and those in folders by name.
fn pictures(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Trouble> {
    let mut pictures = Vec::new();
    for path in paths {
        if !path.is_dir() {
            pictures.push(path.clone());
            continue;
        }
        let unreadable = |error| Trouble(format!("cannot read {}: {error}", shown(path)));
        let mut found = Vec::new();
        for entry in fs::read_dir(path).map_err(unreadable)? {
            let entry = entry.map_err(unreadable)?.path();
            let is_picture = entry
                .extension()
                .is_some_and(|ending| ENDINGS.iter().any(|own| ending.eq_ignore_ascii_case(own)));
            if is_picture && entry.is_file() {
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

/// What pictures in a folder end with.
const ENDINGS: [&str; 14] = [
    "png", "exr", "jpg", "jpeg", "ppm", "pgm", "pnm", "pam", "bmp", "tif", "tiff", "webp", "gif",
    "pbm",
];

impl Graded {
    fn status(&self) -> Status {
        match &self.result {
            Err(_) => Status::Trouble,
            Ok(judged) => match judged.verdict.kind {
                Kind::Right | Kind::Noise => Status::Done,
                Kind::Wrong | Kind::Unknown => Status::SceneErrors,
            },
        }
    }

    fn json(&self) -> Value {
        let mut fields = Map::new();
        fields.insert("file".to_owned(), json!(self.name));
        match &self.result {
            Err(error) => {
                fields.insert("error".to_owned(), json!(error));
            }
            Ok(Judged {
                comparison,
                verdict,
                is_ours,
                ..
            }) => {
                let largest = comparison.largest;
                let own = json!({
                    "width": comparison.width,
                    "height": comparison.height,
                    "rmse": comparison.rmse,
                    "largest": {
                        "error": largest.steps, "x": largest.x, "y": largest.y,
                        "channel": CHANNELS[largest.channel], "a": largest.a, "b": largest.b,
                    },
                    "beyond": { "pixels": comparison.beyond, "share": comparison.share() },
                    "equal": comparison.is_equal(),
                    "rendered_by_pinhole": is_ours,
                });
                fields.extend(own.as_object().cloned().unwrap_or_default());
                fields.extend(grading::json(verdict));
            }
        }
        Value::Object(fields)
    }

    /// Its cells in a table: name, verdict, error, samples.
    pub fn cells(&self) -> [String; 4] {
        match &self.result {
            Err(error) => [
                self.name.clone(),
                format!("not compared: {error}"),
                String::new(),
                String::new(),
            ],
            Ok(judged) => {
                let flag = if judged.is_ours {
                    " (rendered by Pinhole)"
                } else {
                    ""
                };
                let samples = judged.verdict.samples.filter(|samples| *samples < 1e5);
                [
                    self.name.clone(),
                    judged.verdict.line() + flag,
                    format!("{:.5}", judged.comparison.rmse),
                    samples.map_or_else(String::new, |samples| {
                        short((10.0 * samples).round() / 10.0)
                    }),
                ]
            }
        }
    }
}

fn table(graded: &[Graded]) -> String {
    let rows: Vec<[String; 4]> = graded
        .iter()
        .map(|one| one.cells().map(|cell| visible(&cell).into_owned()))
        .collect();
    let widest = rows
        .iter()
        .map(|row| row[0].chars().count())
        .max()
        .unwrap_or(0)
        .max("picture".len());
    let line = |[name, verdict, error, samples]: [&str; 4]| {
        format!("{name:<widest$}  {error:>8}  {samples:>8}  {verdict}\n")
    };
    let head = line(["picture", "verdict", "error", "samples"]);
    let rows = rows
        .iter()
        .map(|row| line(row.each_ref().map(String::as_str)));
    std::iter::once(head).chain(rows).collect()
}

fn csv(graded: &[Graded]) -> String {
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let row = |one: &Graded| {
        let [name, _, error, samples] = one.cells();
        let (verdict, line, set) = match &one.result {
            Err(error) => ("error", error.clone(), String::new()),
            Ok(judged) => {
                let sets = judged
                    .verdict
                    .mistakes
                    .iter()
                    .flat_map(|mistake| &mistake.set);
                let sets: Vec<_> = sets.map(String::as_str).collect();
                (
                    judged.verdict.kind.word(),
                    judged.verdict.line(),
                    sets.join(" "),
                )
            }
        };
        format!(
            "{},{verdict},{error},{samples},{},{}\n",
            quoted(&name),
            quoted(&line),
            quoted(&set)
        )
    };
    let rows = graded.iter().map(row);
    std::iter::once("file,verdict,rmse,samples_per_pixel,line,set\n".to_owned())
        .chain(rows)
        .collect()
}
