//! Tests of lessons: their conditions, the lessons of the repository with their solutions, and the
//! command and the request that judge them.

use std::{fs, path::Path};

use pinhole::{
    diagnostic::Diagnostic,
    lesson::{Facts, Lesson, parse},
    scene,
    source::Source,
};
use serde_json::json;

use crate::{
    diagnostics::diagnose,
    format::formatted,
    lsp::local_client::LocalClient,
    program::{Folder, names},
    random::Random,
    scenes::{read, sources},
};

/// A lesson of the repository.
struct Example {
    name: String,
    text: String,
    start: String,
    solution: String,
}

fn examples() -> Vec<Example> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/lessons");
    let read = |name: &str, ending| fs::read_to_string(folder.join(format!("{name}.{ending}")));
    let files = names(&folder);
    let lessons = files.iter().filter_map(|file| file.strip_suffix(".md"));
    let lessons = lessons.filter(|name| *name != "README");
    let lessons = lessons.map(|name| Example {
        name: name.to_owned(),
        text: read(name, "md").unwrap(),
        start: read(name, "scn").unwrap(),
        solution: read(name, "solution.scn").unwrap(),
    });
    lessons.collect()
}

fn parsed(text: &str) -> Result<Lesson, Vec<Diagnostic>> {
    parse(&Source::from_text("lesson.md", text))
}

/// Returns for each condition of a lesson whether it holds for a scene.
fn judged(lesson: &Lesson, text: &str, start: &str) -> Vec<bool> {
    let (scene, start) = ((sources(text), read(text)), (sources(start), read(start)));
    let facts = Facts::new(&scene.1, &scene.0.file);
    let judged = lesson.judge(&facts, &Facts::new(&start.1, &start.0.file));
    judged.iter().flatten().map(|it| it.holds).collect()
}

fn solves(lesson: &Lesson, text: &str, start: &str) -> bool {
    judged(lesson, text, start).into_iter().all(|holds| holds)
}

#[test]
fn there_are_eight_lessons_whose_scenes_have_no_problems() {
    let examples = examples();
    assert_eq!(examples.len(), 8);
    for Example {
        name,
        start,
        solution,
        ..
    } in &examples
    {
        for text in [start, solution] {
            assert_eq!(diagnose(text, &[]), [], "{name}");
            assert_eq!(formatted(text).as_ref(), Ok(text), "{name}");
        }
    }
}

#[test]
fn a_lesson_is_solved_by_its_solution_alone() {
    let examples = examples();
    for lesson in &examples {
        let conditions = parsed(&lesson.text).unwrap();
        let found = judged(&conditions, &lesson.start, &lesson.start);
        assert!(found.contains(&false), "{}: {found:?}", lesson.name);
        for other in &examples {
            let found = judged(&conditions, &other.solution, &lesson.start);
            let is_own = other.name == lesson.name;
            let all = found.iter().all(|holds| *holds);
            assert_eq!(all, is_own, "{} by {}: {found:?}", lesson.name, other.name);
        }
    }
}

/// Returns a scene with one random change: a number or a sampling method is replaced, or a line is
/// removed. The comment in the first line stays.
fn edited(text: &str, random: &mut Random) -> String {
    let (comment, scene) = text.split_once('\n').unwrap();
    let is_digit = |at: usize| scene.as_bytes()[at].is_ascii_digit();
    let is_part = |at: usize| is_digit(at) || b"._".contains(&scene.as_bytes()[at]);
    let is_name = |at: usize| scene.as_bytes()[at].is_ascii_alphabetic();
    let starts =
        (1..scene.len()).filter(|&at| is_digit(at) && !is_part(at - 1) && !is_name(at - 1));
    let starts: Vec<usize> = starts.collect();
    let changed = match random.below(8) {
        0 => {
            let lines: Vec<_> = scene.lines().collect();
            let out = random.below(lines.len());
            let kept = lines.iter().enumerate().filter(|(i, _)| *i != out);
            kept.map(|(_, line)| format!("{line}\n")).collect()
        }
        1 if scene.contains("method ") => {
            let (before, after) = scene.split_once("method ").unwrap();
            let (_, after) = after.split_once(' ').unwrap();
            let methods = [
                "regular", "jittered", "sobol", "halton", "exact", "random", "scatter",
            ];
            format!("{before}method {} {after}", random.one_of(&methods))
        }
        _ => {
            let start = *random.one_of(&starts);
            let end = (start..scene.len()).find(|&at| !is_part(at)).unwrap();
            let number: f64 = scene[start..end].replace('_', "").parse().unwrap();
            let factor = *random.one_of(&[0.0, 0.1, 0.25, 0.5, 0.9, 1.1, 2.0, 3.0, 4.0, 10.0]);
            let sum =
                *random.one_of(&[-10.0, -5.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 5.0, 10.0]);
            format!(
                "{}{}{}",
                &scene[..start],
                number * factor + sum,
                &scene[end..]
            )
        }
    };
    format!("{comment}\n{changed}")
}

#[test]
fn no_lesson_is_solved_by_one_random_change_of_its_scene() {
    let mut random = Random::new(54);
    for lesson in examples() {
        let conditions = parsed(&lesson.text).unwrap();
        let mut tried = 0;
        while tried < 50 {
            let text = edited(&lesson.start, &mut random);
            if text == lesson.start || scene::read(&sources(&text)).scene.is_none() {
                continue;
            }
            tried += 1;
            let is_solved = solves(&conditions, &text, &lesson.start);
            assert!(!is_solved, "{}:\n{text}", lesson.name);
        }
    }
}

const SCENE: &str = "camera { eye (0, 1, 8)  lookat (0, 1, 0)  fov 40deg }
sphere { center (9, 1, 0) }
sphere Ball { center (0, 1, 0) }
box Tile for i < 2 { center (i, 5, 0) }
";

/// Returns whether a condition holds for [`SCENE`], in which Ball has the radius `radius`.
fn holds(condition: &str, radius: &str) -> bool {
    let lesson = parsed(&format!("# Title\n\n```check\n{condition}\n```\n"));
    let lesson = lesson.unwrap_or_else(|found| panic!("{condition}: {found:#?}"));
    let text = SCENE.replace("Ball { ", &format!("Ball {{ radius {radius} "));
    solves(&lesson, &text, SCENE)
}

#[test]
fn conditions_compare_values_ranges_lists_and_the_start() {
    for (condition, expected) in [
        ("inspect/camera/eye = [0, 1.0, 8]", true),
        ("inspect/camera/eye = [0, 1, 9]", false),
        ("inspect/camera/eye = [0, 1]", false),
        ("inspect/camera/far = null", true),
        // A path to a value that does not exist is not equal to null, and no condition about it
        // holds.
        ("inspect/camera/farther = null", false),
        ("inspect/camera/farther < 1", false),
        ("inspect/camera/looks = \"level\" // words", true),
        ("inspect/camera/looks < 5", false),
        ("inspect/camera/fov_deg < 40", false),
        ("inspect/camera/fov_deg <= 40", true),
        ("inspect/camera/fov_deg > 40", false),
        ("inspect/camera/fov_deg >= 40", true),
        ("inspect/camera/fov_deg in 40..40", true),
        ("inspect/camera/fov_deg in -90 .. 39.9", false),
        ("inspect/camera/looks in [\"up\", \"level\"]", true),
        ("inspect/camera/looks in [\"up\", \"down\"]", false),
        // In a path, the name of an object or of an axis stands for its index.
        ("inspect/objects/1/radius = 1.1", true),
        ("inspect/objects/Ball/radius = 1.1", true),
        ("inspect/objects/Tile[1]/min/0 = 0.75", true),
        ("inspect/objects/Sail/radius = 1.1", false),
        ("inspect/vanishing_points/z/inside = true", true),
        ("inspect/vanishing_points/x/inside = false", true),
        ("inspect/objects/Ball/radius = start", false),
        ("inspect/objects/Ball/radius > start", true),
        ("inspect/objects/Ball/radius in start ± 11%", true),
        ("inspect/objects/Ball/radius in start ±9.5%", false),
        ("inspect/objects/Ball/center = start", true),
        ("inspect/objects/Ball/seen/pixels in start ± 15%", false),
        ("inspect/objects/Ball/seen/pixels in start ± 30%", true),
        ("start/objects/Ball/radius = 1", true),
        ("probe 400 225/hits/0/object = \"Ball\"", true),
        ("probe 400.5 -1e2 /hits/0/object = \"Ball\"", false),
        ("error > 0", true),
        ("error in 0..0.1", true),
        ("error < 0.0001", false),
    ] {
        assert_eq!(holds(condition, "1.1"), expected, "{condition}");
    }
}

#[test]
fn the_error_keeps_the_number_of_samples_per_pixel_and_has_a_limit() {
    let sampled = |sampler: &str, condition: &str| {
        let lesson = parsed(&format!("```check\n{condition}\n```")).unwrap();
        solves(&lesson, &format!("{SCENE}sampler {{ {sampler} }}"), SCENE)
    };
    // Both samplers take 4 samples per pixel, because 4 · 800 · 450 = 1 440 000.
    for sampler in [
        "method regular per_pixel 4",
        "method regular total 1_440_000",
    ] {
        assert!(sampled(sampler, "error in 0.0025..0.0035"), "{sampler}");
        assert!(!sampled(sampler, "error in 0..0.0025"), "{sampler}");
    }
    assert!(sampled("method exact", "error = 0"));
    assert!(sampled("method exact per_pixel 1000", "error = 0"));
    assert!(!sampled("per_pixel 1000", "error >= 0"));
    // The condition does not hold, because an exact picture of so many edges takes too long.
    let many =
        "sphere for i < 60, j < 40 { center ((i - 30) / 9, (j - 20) / 9, -i / 9)  radius 0.9 }";
    let lesson = parsed("```check\nerror >= 0\n```").unwrap();
    assert!(!solves(&lesson, &format!("{SCENE}{many}"), SCENE));
}

#[test]
fn mistakes_in_conditions_have_a_place_and_help() {
    for (condition, place, help) in [
        (
            "inspct/camera/d > 3",
            "inspct/camera/d",
            "did you mean `inspect`?",
        ),
        ("inspect > 3", "inspect", "inspect/camera/d"),
        ("error/x > 3", "error/x", "a path is `error`"),
        ("probe 3/hits = 3", "probe", "probe 320 180"),
        ("probe 3 x/hits = 3", "probe", "probe 320 180"),
        ("inspect/camera/d", "inspect/camera/d", "`<=`"),
        ("inspect/camera/d == 3", "==", "`<=`"),
        (
            "inspect/camera/d =",
            "inspect/camera/d =",
            "quotation marks",
        ),
        ("inspect/camera/looks = level", "level", "quotation marks"),
        ("inspect/camera/d < \"a\"", "\"a\"", "such as `20`"),
        ("inspect/camera/d in 3", "3", "20..30"),
        ("inspect/camera/d in 3..2", "3..2", "the smaller end"),
        ("inspect/camera/d in start", "start", "start ± 2%"),
        (
            "inspect/camera/d = start ± 2%",
            "start ± 2%",
            "`in start ± 2%`",
        ),
        (
            "inspect/kind = \"a // b",
            "\"a // b // words",
            "quotation marks",
        ),
        (
            "inspect/camera/d in start ± -2%",
            "start ± -2%",
            "start ± 2%",
        ),
        ("inspect/camera/d in start ± 2", "start ± 2", "start ± 2%"),
    ] {
        let text = format!("# Lesson\n\n~~~ check\nerror < 1\n{condition} // words\n~~~\n");
        let found = parsed(&text).unwrap_err();
        let [problem] = &found[..] else {
            panic!("{condition}: {found:#?}")
        };
        let span = problem.labels[0].span;
        assert_eq!(&text[span.range()], place, "{condition}");
        let text = problem.help.as_deref().unwrap_or_default();
        assert!(text.contains(help), "{condition}: {text}");
    }
}

#[test]
fn conditions_are_those_of_check_blocks() {
    let nested = "```scn\nerror < 1\n```\n\n````check\n\n// a comment\nerror < 2\n```\nerror < 3\n````\n\
                  error < 4\n~~~check\n  error < 5 // five\n~~~\n ```check\nerror < 6\n```check of code```\n\
                  ```check twice\nerror < 7\n```\n";
    let checks = parsed(nested).unwrap().checks;
    let lines = checks.iter().map(|it| it.iter().map(|it| it.line));
    let lines: Vec<Vec<_>> = lines.map(Iterator::collect).collect();
    assert_eq!(lines, [vec![8, 10], vec![14]]);
    let lesson =
        parsed("```check\nerror < 2\n```\nerror < 4\r\n~~~check\r\n  error < 5\t// five\r\n");
    let checks = lesson.unwrap().checks;
    let read = checks
        .iter()
        .map(|it| it.iter().map(|it| (&*it.text, &*it.words, it.line)));
    let read: Vec<Vec<_>> = read.map(Iterator::collect).collect();
    assert_eq!(read, [[("error < 2", "", 2)], [("error < 5", "five", 6)]]);
    for empty in ["", "# Lesson\n", "```check\n```\n", "```scn\nerror < 1\n"] {
        let found = parsed(empty).unwrap_err();
        assert_eq!(found[0].message, "the lesson has no condition", "{empty}");
    }
}

const LESSON: &str = "# Title\n\n```check\ninspect/camera/fov_deg < 30 // it is narrow
inspect/objects/Ball/radius = start\n```\n";

#[test]
fn lesson_check_prints_each_condition() {
    let narrow = SCENE.replace("40deg", "20deg");
    let folder = Folder::with([
        ("a.md", LESSON),
        ("a.scn", SCENE),
        ("narrow.scn", &*narrow),
        ("bad.scn", "camera {}"),
        ("alone.md", LESSON),
        ("none.md", "# None\n"),
        ("none.scn", SCENE),
        ("broken.md", LESSON),
        ("broken.scn", "camera {}"),
        (
            "typo.md",
            "```check\ninspect/camera/fov_dg < 30\ninspect/camera/far > 3\n\n\
             inspect/objects/Bal/radius = 1\n```\n",
        ),
        ("typo.scn", SCENE),
    ]);
    let said = folder.run("lesson check a.md a.scn");
    assert_eq!((said.status, said.text()), (1, ""));
    assert_eq!(
        said.errors,
        "no   it is narrow: 40\n\
         yes  inspect/objects/Ball/radius = start: 1, at the start 1\n\
         1 of 2 conditions hold\n"
    );
    assert_eq!(folder.run("lesson check a.md narrow.scn").status, 0);
    assert_eq!(
        folder
            .run("lesson check a.md a.scn --set camera.fov=20deg")
            .status,
        0
    );
    let said = folder.run("lesson check a.md narrow.scn --set Ball.radius=2 --format json");
    assert_eq!((said.status, &*said.errors), (1, ""));
    assert_eq!(
        said.json(),
        json!({ "lesson": "a.md", "scene": "narrow.scn", "holds": false, "conditions": [
            { "line": 4, "condition": "inspect/camera/fov_deg < 30", "words": "it is narrow",
              "found": 20.0, "start": null, "holds": true },
            { "line": 5, "condition": "inspect/objects/Ball/radius = start", "words": "",
              "found": 2.0, "start": 1.0, "holds": false },
        ] })
    );
    for (line, status, words) in [
        ("a.md bad.scn", 1, "missing_field"),
        ("missing.md a.scn", 2, "cannot read missing.md"),
        ("a.md missing.scn", 2, "cannot read missing.scn"),
        ("alone.md a.scn", 2, "cannot read alone.scn"),
        ("none.md a.scn", 2, "the lesson has no condition"),
        (
            "broken.md a.scn",
            2,
            "broken.scn, the scene of the lesson broken.md, has errors",
        ),
    ] {
        let said = folder.run(&format!("lesson check {line}"));
        assert_eq!(said.status, status, "{line}: {}", said.errors);
        assert!(said.errors.contains(words), "{line}: {}", said.errors);
    }
    let said = folder.run("lesson check typo.md a.scn");
    assert_eq!(said.status, 1, "{}", said.errors);
    for words in ["`fov_dg`", "`fov_deg`?", "`Bal`", "`Ball`?", "typo.md:5"] {
        assert!(said.errors.contains(words), "{words}: {}", said.errors);
    }
    for name in ["missing", "none", "broken"] {
        let said = folder.run(&format!("studio --no-open --lesson {name}.md"));
        assert_eq!(said.status, 2, "{name}: {}", said.errors);
    }
}

#[test]
fn a_page_has_its_scene_judged() {
    let mut client = LocalClient::with(&SCENE.replace("Ball {", "Ball { radius 2 "));
    let about = json!({ "lesson": LESSON, "start": SCENE });
    let answer = client.ask("pinhole/lesson", about.clone());
    assert_eq!(
        answer,
        json!({ "holds": false, "checks": [[
            { "condition": "inspect/camera/fov_deg < 30", "words": "it is narrow",
              "found": "40", "start": null, "holds": false },
            { "condition": "inspect/objects/Ball/radius = start", "words": "",
              "found": "2", "start": "1", "holds": false },
        ]] })
    );
    let narrow = SCENE.replace("40deg", "20deg");
    client.change(2, json!({ "text": narrow }));
    assert_eq!(client.ask("pinhole/lesson", about.clone())["holds"], true);
    client.change(3, json!({ "text": "camera {}" }));
    assert!(client.ask("pinhole/lesson", about).is_null());
    client.change(4, json!({ "text": SCENE }));
    for (lesson, start, words) in [
        (
            "# None",
            SCENE,
            "line 1 of the lesson: the lesson has no condition",
        ),
        (
            "```check\nx < 1\n```",
            SCENE,
            "line 2 of the lesson: `x` is no path",
        ),
        (LESSON, "camera {}", "the scene of the lesson has errors"),
    ] {
        let about = json!({ "lesson": lesson, "start": start });
        let refused = client.respond("pinhole/lesson", about);
        let message = refused["error"]["message"].as_str().unwrap_or_default();
        assert!(message.contains(words), "{refused}");
    }
}
