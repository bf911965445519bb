//! How well `diff` names mistakes: the corpus of `tests/integration/grade`, by the program that is built.
//!
//! `cargo bench --bench grade` judges pictures of 320 × 180 pixels; `-- --all` those of every size and way of sampling. `-- --write FOLDER`
//! writes the pictures, their scenes and `truth.json` in place of judging them. `--program FILE` asks another program.

#[path = "../tests/integration/grade/corpus.rs"]
mod corpus;
#[path = "../tests/integration/grade/mistakes.rs"]
mod mistakes;
#[path = "../tests/integration/grade/rarer.rs"]
mod rarer;
#[path = "../tests/integration/grade/textbook.rs"]
mod textbook;

use std::{
    collections::BTreeMap,
    env, fs,
    path::Path,
    process::Command,
    time::{Duration, Instant},
};

use corpus::{Case, SIZES, cases, samplings};
use serde_json::{Value, json};
use textbook::Sampling;

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
    let (sizes, samplings) = match is_all {
        true => (SIZES.to_vec(), samplings().collect::<Vec<_>>()),
        false => (vec![SIZES[1]], few.to_vec()),
    };
    let program = after("--program").unwrap_or(env!("CARGO_BIN_EXE_pinhole").to_owned());
    let mut truth = Vec::new();
    println!(
        "| mistakes | size | sampling | right | judged otherwise | seconds |\n| --- | --- | --- | --- | --- | --- |"
    );
    for count in 0..4 {
        for &size in &sizes {
            for &sampling in &samplings {
                // Pairs and triples of one size.
                if count > 1 && size != SIZES[1] {
                    continue;
                }
                let cases: Vec<Case> = cases(count, size, sampling)
                    .into_iter()
                    .filter(Case::is_seen)
                    .collect();
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
        return;
    }
    let cases: Vec<Case> = rarer::cases().collect();
    judge(&program, "1, rarer | 96 × 54 | 16 Regular", &cases);
}

/// A row of the table: how cases are judged.
fn judge(program: &str, of: &str, cases: &[Case]) {
    let folder = tempfile::tempdir().expect("a folder for pictures");
    let (mut table, mut time) = (BTreeMap::new(), Duration::ZERO);
    for case in cases {
        let (answer, taken) = ask(program, case, folder.path());
        time += taken;
        let judgement = case.judge(&answer);
        *table.entry(judgement).or_insert(0) += 1;
        if judgement != corpus::Judgement::Right {
            eprintln!("{judgement:?} {}: {}", case.title, told(&answer));
        }
    }
    let right = table.remove(&corpus::Judgement::Right).unwrap_or(0);
    let (count, seconds) = (cases.len(), time.as_secs_f64());
    println!("| {of} | {right} of {count} | {table:?} | {seconds:.2} |");
}

/// What the program says of a picture, and how long it takes.
fn ask(program: &str, case: &Case, folder: &Path) -> (Value, Duration) {
    let (picture, scene) = (folder.join("a.png"), folder.join("a.scn"));
    case.picture().save(&picture).expect("a picture");
    fs::write(&scene, case.right.scene()).expect("a scene");
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

fn told(answer: &Value) -> String {
    let mistakes = answer["mistakes"].as_array().map_or(&[][..], Vec::as_slice);
    let told: Vec<String> = mistakes
        .iter()
        .map(|m| format!("{} {}", m["id"], m["set"]))
        .collect();
    format!("{} {}", answer["verdict"], told.join("; "))
}

/// Writes a picture and its scene; answers what is wrong with it.
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
    fs::write(folder.join(&scene), case.right.scene()).expect("a scene");
    let names: Vec<&str> = case.mistakes.iter().map(|mistake| mistake.name).collect();
    json!({ "file": format!("{name}.png"), "scene": scene, "mistakes": names })
}
