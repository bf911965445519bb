//! Writes a student's `results.json` in the format of Gradescope's autograder,
//! <https://gradescope-autograders.readthedocs.io/en/latest/specs/#output-format>.

use serde_json::{Value, json};

use super::{
    criteria::{Criterion, criterion},
    graded::GradedStudent,
    points::PointScheme,
};
use crate::{
    diagnostic::visible,
    grading::{Kind, NamedMistake},
    scene::{Scene, Shape},
};

/// Returns the content of `results.json` for a student. Each criterion, such as the camera or an
/// object, is a test in Gradescope.
///
/// Without `--points`, each test is worth one point. With `--points`, only the whole submission has
/// a score, and the tests pass or fail without points. If the tests had points, a mistake could
/// cost more points than its test is worth, and the points would not add up to the score.
///
/// If the picture is wrong for unknown reasons, no scores are written, so that the teacher decides.
pub fn results(one: &GradedStudent, scene: &Scene, points: Option<&PointScheme>) -> Value {
    let Ok(judged) = one.best() else {
        return whole(one, None, Vec::new());
    };
    let is_known = judged.verdict.kind != Kind::Unknown;
    let mistakes = &judged.verdict.mistakes;
    let mut passed = 0;
    let tests = criteria(scene).into_iter().map(|(of, name)| {
        let is_about = |mistake: &&NamedMistake| criterion(mistake, scene) == of;
        let about: Vec<&NamedMistake> = mistakes.iter().filter(is_about).collect();
        let output = about
            .iter()
            .map(|one| format!("{}\n{}\n", one.message, one.help));
        let output: String = output.collect();
        let mut test = json!({
            "name": visible(&name),
            "output": visible(&output),
            "visibility": "visible",
        });
        let score = u32::from(about.is_empty());
        passed += score;
        if points.is_none() {
            test["max_score"] = json!(1.0);
        }
        if points.is_none() && is_known {
            test["score"] = json!(f64::from(score));
        }
        if is_known {
            test["status"] = json!(if about.is_empty() { "passed" } else { "failed" });
        }
        test
    });
    let tests = tests.collect();
    let score = match points {
        Some(points) => points.score(judged),
        None => is_known.then(|| f64::from(passed)),
    };
    whole(one, score, tests)
}

fn whole(one: &GradedStudent, score: Option<f64>, tests: Vec<Value>) -> Value {
    let mut results = json!({
        "output": visible(&one.comment()),
        "output_format": "text",
        "visibility": "visible",
        "tests": tests,
    });
    if let Some(score) = score {
        results["score"] = json!(score);
    }
    results
}

/// Returns the criteria of grading with their names. Each criterion is a test in Gradescope.
fn criteria(scene: &Scene) -> Vec<(Criterion, String)> {
    let objects = scene.objects.iter().enumerate();
    let is_board = |shape: &Shape| shape.checkerboard().is_some();
    let own = objects.filter(|(_, object)| !is_board(&object.shape));
    let own = own.map(|(index, object)| {
        let kind = object.shape.kind();
        let name = match &object.name {
            Some(name) => format!("{kind} {name}"),
            None => format!("{kind} with the index {index}"),
        };
        (Criterion::Object(index), name)
    });
    let camera = (Criterion::Camera, "camera".to_owned());
    let mut all: Vec<_> = [camera].into_iter().chain(own).collect();
    if scene.objects.iter().any(|object| is_board(&object.shape)) {
        all.push((Criterion::Board, "board".to_owned()));
    }
    all.extend([
        (Criterion::Colours, "colours".to_owned()),
        (Criterion::Sampling, "sampling".to_owned()),
        (Criterion::Hits, "hits".to_owned()),
    ]);
    all
}

/// Returns a folder name for each student, made from the student's name. All names are valid on all
/// systems, and they are distinct even if upper and lower case are not distinguished.
pub fn folders(graded: &[GradedStudent]) -> Vec<String> {
    let mut taken = std::collections::BTreeSet::new();
    let name = |one: &GradedStudent| {
        let plain = |c: char| {
            if c.is_alphanumeric() || "-_.@".contains(c) {
                c
            } else {
                '_'
            }
        };
        let name: String = one.name.chars().map(plain).take(60).collect();
        let name = name.trim_matches('.');
        // Windows reserves names such as `con`, so an underscore is put before them.
        let base = match name {
            "" => "student".to_owned(),
            name if is_reserved(name) => format!("_{name}"),
            name => name.to_owned(),
        };
        let mut numbered = (2..).map(|number| format!("{base}-{number}"));
        let mut free = base.clone();
        while !taken.insert(free.to_lowercase()) {
            free = numbered.next().unwrap_or_default();
        }
        free
    };
    graded.iter().map(name).collect()
}

fn is_reserved(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().to_lowercase();
    let is_numbered = |word: &str| {
        let rest = stem.strip_prefix(word);
        rest.is_some_and(|rest| rest.len() == 1 && rest != "0")
    };
    // Windows does not allow files with the names `con`, `prn`, `aux` and `nul`. `pictures`,
    // `index` and `grade` are rejected, too, since `grade` writes files or a folder of these names
    // beside the students' folders.
    matches!(
        &*stem,
        "con" | "prn" | "aux" | "nul" | "pictures" | "index" | "grade"
    ) || is_numbered("com")
        || is_numbered("lpt")
}
