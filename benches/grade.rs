//! Measures how well `pinhole diff` names the mistakes in wrong pictures. The pictures, whose
//! mistakes are known, come from `tests/integration/grade`.
//!
//! `cargo bench --bench grade` tests pictures of 320 × 180 pixels; with `-- --all`, pictures of all
//! sizes and ways of sampling. `-- --write FOLDER` writes the pictures, their scenes and
//! `truth.json` without testing them. `--program FILE` tests FILE instead of the `pinhole` built
//! here.
#![allow(
    clippy::disallowed_methods,
    reason = "a benchmark reads and writes files of its own"
)]

#[path = "../tests/integration/grade/case.rs"]
mod case;
#[path = "../tests/integration/grade/hits.rs"]
mod hits;
#[path = "../tests/integration/grade/mistakes.rs"]
mod mistakes;
#[path = "../tests/integration/grade/scenes.rs"]
mod scenes;
#[allow(dead_code, reason = "one of the samplings is for a test alone")]
#[path = "../tests/integration/grade/textbook.rs"]
mod textbook;

use std::{
    env, fs,
    path::Path,
    process::Command,
    time::{Duration, Instant},
};

use case::Case;
use mistakes::{GROUPS, Mistake, OF_THE_OBJECTS};
use serde_json::{Value, json};
use textbook::{SAMPLINGS, Sampling};

/// Widths and heights of the pictures that are judged, in pixels: a small, a usual and a large
/// picture. Without the option `--all`, only pictures of the second size are judged, which saves
/// time.
const SIZES: [[u32; 2]; 3] = [[96, 64], [320, 180], [640, 360]];

fn main() {
    let arguments: Vec<String> = env::args().collect();
    let after = |name: &str| {
        let at = arguments.iter().position(|argument| argument == name)?;
        arguments.get(at + 1).cloned()
    };
    let is_all = arguments.iter().any(|argument| argument == "--all");
    let few = [
        (Sampling::Random, 1),
        (Sampling::Jittered, 4),
        (Sampling::Regular, 16),
        (Sampling::Regular, 256),
    ];
    let (sizes, samplings) = if is_all {
        let all = [1, 4, 16].into_iter();
        let all = all.flat_map(|samples| SAMPLINGS.map(|sampling| (sampling, samples)));
        (SIZES.to_vec(), all.chain([few[3]]).collect())
    } else {
        (vec![SIZES[1]], few.to_vec())
    };
    let program = after("--program").unwrap_or(env!("CARGO_BIN_EXE_pinhole").to_owned());
    let mut truth = Vec::new();
    println!("| mistakes | size | sampling | right | seconds |\n| --- | --- | --- | --- | --- |");
    for count in 0..4 {
        for &size in &sizes {
            for &sampling in &samplings {
                // Pairs and triples of mistakes are tested only in pictures of the usual size, to
                // save time.
                if count > 1 && size != SIZES[1] {
                    continue;
                }
                let cases = cases(count, size, sampling);
                if let Some(folder) = after("--write") {
                    truth.extend(cases.iter().map(|case| write(case, Path::new(&folder))));
                    continue;
                }
                let of = format!(
                    "{count} | {} × {} | {} {:?}",
                    size[0], size[1], sampling.1, sampling.0
                );
                judge(&program, &of, &cases);
            }
        }
    }
    if let Some(folder) = after("--write") {
        let text = serde_json::to_string_pretty(&truth).expect("a list");
        fs::write(Path::new(&folder).join("truth.json"), text).expect("a file");
    }
}

/// Returns combinations of `count` mistakes that a renderer may make.
///
/// - 0: the empty combination.
/// - 1: each mistake alone.
/// - 2: each mistake of an object, combined in turn with a mistake of the camera, of the board, of
///   another object, and of the whole picture. These are four combinations.
/// - 3: each mistake of an object, combined with one of the camera and one of another object.
fn sets(count: usize) -> Vec<Vec<&'static Mistake>> {
    let objects = OF_THE_OBJECTS.iter().enumerate();
    let sets = objects.flat_map(|(index, object)| {
        let [picture, camera, board, ..] = GROUPS.map(|group| &group[index % group.len()]);
        let other = &OF_THE_OBJECTS[(index + 9) % OF_THE_OBJECTS.len()];
        match count {
            2 => [camera, board, other, picture]
                .map(|one| vec![object, one])
                .to_vec(),
            _ => vec![vec![object, camera, other]],
        }
    });
    match count {
        0 => vec![Vec::new()],
        1 => GROUPS.into_iter().flatten().map(|one| vec![one]).collect(),
        _ => sets.collect(),
    }
}

/// Returns test pictures, all of the same size and sampling, each with a set of `count` mistakes. A
/// picture is left out if one of its mistakes is invisible, i.e. if the picture without this
/// mistake has nearly the same bytes: rounding alone can change a byte by one 8-bit step. A picture
/// whose size was changed by its mistakes is left out, too.
fn cases(
    count: usize,
    [width, height]: [u32; 2],
    (sampling, samples): (Sampling, u32),
) -> Vec<Case> {
    let case = |scene: &str, names: &[&str]| {
        let names = if names.is_empty() {
            "right".to_owned()
        } else {
            names.join(" + ")
        };
        Case::of(&format!(
            "{scene} {width}x{height} {samples} {sampling:?}: {names}"
        ))
    };
    let seen = |scene: &str, set: Vec<&Mistake>| {
        let names: Vec<_> = set.iter().map(|one| one.title()).collect();
        let whole = case(scene, &names);
        let picture = whole.picture();
        // Largest difference of a byte, in 8-bit steps, that leaves a mistake invisible. It is
        // normally 1, since rounding can cause such a difference. In a picture with the mistake
        // `cut_off` it is 0: `cut_off` truncates bytes instead of rounding them, which changes a
        // byte by only one step.
        let least = u8::from(!names.contains(&"cut_off"));
        let is_seen = |left_out: usize| {
            let mut others = names.clone();
            others.remove(left_out);
            let other = case(scene, &others).picture();
            let mut bytes = picture.as_raw().iter().zip(other.as_raw());
            bytes.any(|(a, b)| a.abs_diff(*b) > least)
        };
        // The mistake of transposing a picture may change its size. A picture of another size than
        // the scene's is left out.
        let is_whole = picture.dimensions() == (width, height);
        (is_whole && (0..names.len()).all(is_seen)).then_some(whole)
    };
    let scenes = ["figure", "street"].into_iter();
    let sets = scenes.flat_map(|scene| sets(count).into_iter().map(move |set| (scene, set)));
    sets.filter_map(|(scene, set)| seen(scene, set)).collect()
}

/// Runs `diff` on the pictures of `cases`. Prints how many answers name exactly the right mistakes,
/// as a row of a Markdown table.
fn judge(program: &str, of: &str, cases: &[Case]) {
    let folder = tempfile::tempdir().expect("a folder for pictures");
    let (mut right, mut time) = (0, Duration::ZERO);
    for case in cases {
        let (answer, taken) = ask(program, case, folder.path());
        time += taken;
        if case.is_judged_correctly(&answer) {
            right += 1;
        } else {
            eprintln!("{}: {}", case.title, named_mistakes(&answer));
        }
    }
    let (count, seconds) = (cases.len(), time.as_secs_f64());
    println!("| {of} | {right} of {count} | {seconds:.2} |");
}

/// Returns the program's answer about a test picture, and the time that the program took.
fn ask(program: &str, case: &Case, folder: &Path) -> (Value, Duration) {
    let (picture, scene) = (folder.join("a.png"), folder.join("a.scn"));
    case.picture().save(&picture).expect("a picture");
    fs::write(&scene, &case.text).expect("a scene");
    let arguments = [picture.as_os_str(), scene.as_os_str()];
    let mut command = Command::new(program);
    command
        .arg("diff")
        .args(arguments)
        .args(["--format", "json"]);
    let begun = Instant::now();
    let output = command.output().expect("the program");
    let taken = begun.elapsed();
    let answer = serde_json::from_slice(&output.stdout);
    let answer = answer.unwrap_or_else(|_| panic!("{}: {output:?}", case.title));
    (answer, taken)
}

fn named_mistakes(answer: &Value) -> String {
    let mistakes = answer["mistakes"].as_array().map_or(&[][..], Vec::as_slice);
    let named: Vec<String> = mistakes
        .iter()
        .map(|m| format!("{} {}", m["id"], m["set"]))
        .collect();
    format!("{} {}", answer["verdict"], named.join("; "))
}

/// Writes a test picture and its scene into `folder`. Returns a JSON object that lists the mistakes
/// in the picture.
fn write(case: &Case, folder: &Path) -> Value {
    let name: String = case
        .title
        .chars()
        .map(|c| if c.is_alphanumeric() { c } else { '_' })
        .collect();
    fs::create_dir_all(folder).expect("a folder");
    case.picture()
        .save(folder.join(format!("{name}.png")))
        .expect("a picture");
    let scene = format!("{name}.scn");
    fs::write(folder.join(&scene), &case.text).expect("a scene");
    let names: Vec<&str> = case.mistakes.iter().map(|mistake| mistake.name).collect();
    json!({ "file": format!("{name}.png"), "scene": scene, "mistakes": names })
}
