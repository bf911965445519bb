//! `lesson check`: tells whether a scene solves a lesson.

use std::path::Path;

use serde_json::json;

use super::{
    CommandError, Status,
    args::{AnswerFormat, LessonCommand, Overrides},
    command_error,
    input::{SceneInput, shown},
    output,
};
use crate::{
    diagnostic::{Diagnostic, Report, visible_line},
    lesson::{Facts, Judged, Lesson, parse, value_text},
    scene::Scene,
};

/// Judges the scene and prints each condition. The exit status is 1 if a condition does not hold.
pub fn run(LessonCommand::Check(args): &LessonCommand) -> Result<Status, CommandError> {
    let (lesson, start_input, start) = read(&args.lesson)?;
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let scene = input.scene()?;
    let facts = Facts::new(&scene, &input.sources.file);
    let checks = lesson.judge(&facts, &Facts::new(&start, &start_input.sources.file));
    let judged: Vec<&Judged<'_>> = checks.iter().flatten().collect();
    let held = judged.iter().filter(|it| it.holds).count();
    match args.format.format {
        AnswerFormat::Human => {
            let lines: String = judged.iter().map(|it| line(it)).collect();
            let all = judged.len();
            output::answer(&format!("{lines}{held} of {all} conditions hold\n"))?;
        }
        AnswerFormat::Json => {
            let conditions = judged.iter().map(|it| {
                json!({
                    "line": it.condition.line,
                    "condition": it.condition.text,
                    "words": it.condition.words,
                    "found": it.found,
                    "start": it.at_start,
                    "holds": it.holds,
                })
            });
            let answer = json!({
                "lesson": args.lesson.display().to_string(),
                "scene": args.scene.display().to_string(),
                "holds": held == judged.len(),
                "conditions": conditions.collect::<Vec<_>>(),
            });
            output::to_programs(format!("{answer}\n").as_bytes())?;
        }
    }
    Ok(if held == judged.len() {
        Status::Done
    } else {
        Status::Negative
    })
}

/// Reads a lesson and its scene, which is in a file of the same name with the ending .scn. Warns of
/// paths that are probably misspelt. If the lesson or the scene has mistakes, prints the mistakes
/// and returns an error.
pub fn read(path: &Path) -> Result<(Lesson, SceneInput, Scene), CommandError> {
    let own = Overrides { sets: Vec::new() };
    let text = SceneInput::read(path, &own)?.sources;
    let report = |problems: &[Diagnostic]| {
        let report = Report::new(&text, output::style());
        for problem in problems {
            output::to_people(&report.one(problem));
        }
    };
    let lesson = parse(&text.file).map_err(|problems| {
        report(&problems);
        command_error(format!("{} is no lesson that can be judged", shown(path)))
    })?;
    let beside = path.with_extension("scn");
    let input = SceneInput::read(&beside, &own)?;
    let start = input.scene().map_err(|_| {
        let (scene, lesson) = (shown(&beside), shown(path));
        command_error(format!(
            "{scene}, the scene of the lesson {lesson}, has errors"
        ))
    })?;
    report(&lesson.warnings(&Facts::new(&start, &input.sources.file)));
    Ok((lesson, input, start))
}

/// Writes a condition as a line.
fn line(judged: &Judged<'_>) -> String {
    let condition = judged.condition;
    let mark = if judged.holds { "yes" } else { "no" };
    let said = match &*condition.words {
        "" => &condition.text,
        words => words,
    };
    let mut found = value_text(judged.found.as_ref());
    if let Some(start) = &judged.at_start {
        found += &format!(", at the start {}", value_text(Some(start)));
    }
    format!(
        "{mark:<5}{}: {}\n",
        visible_line(said),
        visible_line(&found)
    )
}
