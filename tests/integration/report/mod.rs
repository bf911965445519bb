//! Speed against error: the binary's tables, files and page.

mod files;
mod fit;
#[cfg(unix)]
mod interrupted;

use std::{
    fs,
    process::{Command, Output},
    sync::atomic::AtomicBool,
};

use pinhole::{
    film::Recipe,
    render::Control,
    report::speed::{self, Checks, Plan, Request, Subject, measure},
    scene::{self, Method, Scene},
    source::{Source, Sources},
};
use serde_json::Value;
use tempfile::TempDir;

use crate::program;

const SCENE: &str =
    "image { width 48 height 32 } camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sampler { method sobol per_pixel 4 seed 7 } sphere Ball { center (-1.6, 1, 0) color olive } checkerboard {}
";

/// A fresh folder with the scene in `a.scn`.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.scn"), SCENE).unwrap();
    folder
}

fn command(folder: &TempDir, arguments: &[&str]) -> Command {
    let arguments = [&["report"], arguments].concat();
    program::command(folder.path(), &arguments)
}

fn report(folder: &TempDir, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

fn words(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

fn fails(folder: &TempDir, arguments: &[&str], status: i32) -> String {
    let output = report(folder, arguments);
    let errors = words(&output.stderr).to_owned();
    assert_eq!(
        output.status.code(),
        Some(status),
        "{arguments:?}: {errors}"
    );
    assert_eq!(output.stdout, b"", "{arguments:?}");
    errors
}

fn read(folder: &TempDir, name: &str) -> String {
    let path = folder.path().join(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Parses XML, or HTML that is written as XML.
fn parsed(text: &str) -> roxmltree::Document<'_> {
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..Default::default()
    };
    roxmltree::Document::parse_with_options(text, options).unwrap()
}

#[test]
fn people_get_a_table() {
    let folder = folder();
    let output = report(&folder, &["a.scn", "--samples", "1,4,16", "--runs", "2"]);
    let text = words(&output.stderr);
    assert!(
        output.status.success() && output.stdout.is_empty(),
        "{text}"
    );
    assert!(text.starts_with("a.scn: 48 × 32 pixels, 2 runs of each, seeds from 7\n"));
    for word in [
        "regular",
        "random",
        "jittered",
        "n_rooks",
        "multi_jittered",
        "hammersley",
        "halton",
        "sobol",
        "scatter",
        "exact",
        "for 1/256",
        "× ÷",
        "extrapolated",
        "note: What is extrapolated",
        "note: scatter",
        "the slope (*) has the errors of those in it",
        "the fastest sampled method",
        "million samples/s: all samples by the time that they take, traced or not",
        "slope: of the line through the logarithms of samples and error; ± covers",
    ] {
        let is_there = text.contains(word) || text.replace("\n ", " ").contains(word);
        assert!(is_there, "{word}:\n{text}");
    }
    let marked = |line: &&str| line.ends_with(" *");
    let marked: Vec<_> = text.lines().filter(marked).collect();
    assert!(
        matches!(marked.as_slice(), [one] if one.starts_with("scatter")),
        "{marked:?}"
    );
    for line in text.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
}

#[test]
fn programs_get_json_and_errors_fall() {
    let folder = folder();
    let arguments = [
        "a.scn",
        "--format",
        "json",
        "--samples",
        "64,1,16,4,16",
        "--runs",
        "3",
        "--error",
        "1/256",
        "--error",
        "0.5",
        "--error",
        "1e-6",
        "--threads",
        "1",
    ];
    let output = report(&folder, &arguments);
    assert_eq!((output.status.code(), words(&output.stderr)), (Some(0), ""));
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(answer["complete"], true);
    let report = &answer["reports"][0];
    assert_eq!(report["scene"], "a.scn");
    assert_eq!(
        report["image"],
        serde_json::json!({"width": 48, "height": 32})
    );
    assert_eq!(
        (&report["seed"], &report["threads"]),
        (&7.into(), &1.into())
    );
    assert_eq!(report["per_pixel"], serde_json::json!([1, 4, 16, 64]));
    assert_eq!(report["runs"], 3);
    assert!(report["exact"]["bound"].as_f64().unwrap() < 1e-8);
    assert!(report["machine"]["processors"].as_u64().unwrap() >= 1);
    let methods = report["methods"].as_array().unwrap();
    assert_eq!(methods.len(), 9);
    for method in methods {
        let name = method["method"].as_str().unwrap();
        let measured = method["measured"].as_array().unwrap();
        assert_eq!(measured.len(), 4);
        for pair in measured.windows(2) {
            let [coarse, fine] = [0, 1].map(|at: usize| pair[at]["rmse"].as_f64().unwrap());
            assert!(fine < 0.75 * coarse, "{name}: {coarse} to {fine}");
            assert_eq!(pair[0]["rmse_runs"].as_array().unwrap().len(), 3);
            assert!(pair[1]["time"]["min"].as_f64().unwrap() > 0.0);
        }
        let slope = method["fit"]["slope"].as_f64().unwrap();
        let expected = match name {
            "random" => -0.53..-0.47,
            "regular" => -0.8..-0.4,
            "scatter" => -1.0..-0.5,
            _ => -0.85..-0.55,
        };
        assert!(expected.contains(&slope), "{name}: {slope}");
        let needed = method["needed"].as_array().unwrap();
        assert_eq!(needed[1]["per_pixel"], 1.0, "{name}");
        assert_eq!(needed[1]["extrapolated"], false);
        assert_eq!(needed[1]["factor"], Value::Null);
        assert_eq!(needed[2]["extrapolated"], true, "{name}");
        // Nothing is known of a grid that falls into step with the picture.
        let factor = needed[2]["factor"].as_f64();
        assert_eq!(factor.is_none(), name == "regular", "{name}");
        assert!(factor.is_none_or(|factor| factor > 2.0), "{name}");
        // Whoever says how many samples are taken gets no others.
        assert_eq!(needed[2]["tried"], Value::Null);
    }
    // Independent samples: each run draws its own seed's, and the errors of the seeds differ.
    let random = methods
        .iter()
        .find(|method| method["method"] == "random")
        .unwrap();
    let runs = random["measured"][3]["rmse_runs"].as_array().unwrap();
    assert!(runs[0] != runs[1] && runs[1] != runs[2]);
}

#[test]
fn a_picture_of_one_colour_has_no_error() {
    let folder = folder();
    let empty =
        "image { width 4 height 4 } camera { eye (0, 1, 0) direction (0, 1, 0) up (0, 0, 1) }";
    fs::write(folder.path().join("empty.scn"), empty).unwrap();
    let output = report(
        &folder,
        &["empty.scn", "-o", "out", "--samples", "1,4", "--runs", "1"],
    );
    let text = words(&output.stderr);
    assert!(output.status.success(), "{text}");
    assert!(
        text.contains("no slope is fitted to an error of 0"),
        "{text}"
    );
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        text.contains("; every sampled method has no error at all with 1 sample per pixel already, so that none is the fastest"),
        "{text}"
    );
    parsed(&read(&folder, "out/index.html"));
    parsed(&read(&folder, "out/error-against-time.svg"));
}

#[test]
fn without_samples_nothing_is_said_of_them() {
    let folder = folder();
    let output = report(&folder, &["a.scn", "--methods", "exact", "-o", "out"]);
    let text = words(&output.stderr);
    assert!(output.status.success(), "{text}");
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(
        lines[4].split_whitespace().collect::<Vec<_>>(),
        ["error", "largest"]
    );
    assert!(!text.contains("1024") && !text.contains("slope"), "{text}");
    let json: Value = serde_json::from_str(&read(&folder, "out/report.json")).unwrap();
    assert_eq!(json["per_pixel"], serde_json::json!([]));
    parsed(&read(&folder, "out/index.html"));
    parsed(&read(&folder, "out/error-against-samples.svg"));
}

#[test]
fn wrong_arguments_are_told() {
    let folder = folder();
    fs::write(folder.path().join("file"), "kept").unwrap();
    fs::write(folder.path().join("bad.scn"), "sphere { radus 2 }").unwrap();
    let errors = fails(&folder, &["a.scn", "--methods", "sobol,jitered"], 2);
    assert!(
        errors.contains("jitered") && errors.contains("'jittered'"),
        "{errors}"
    );
    for arguments in [
        &["a.scn", "--samples", "0"][..],
        &["a.scn", "--samples", "1,x"],
        &["a.scn", "--runs", "0"],
        &["a.scn", "--error", "0"],
        &["a.scn", "--error", "1/0"],
        &["a.scn", "--error", "nan"],
        &["a.scn", "--error", "2"],
        &["a.scn", "--budget", "0"],
        &["a.scn", "--numerics"],
        &["--numerics", "--runs", "3"],
        &["none.scn"],
        &["-", "-"],
    ] {
        fails(&folder, arguments, 2);
    }
    let errors = fails(
        &folder,
        &["a.scn", "--methods", "exact", "--samples", "4", "-o", "new"],
        2,
    );
    assert!(
        errors.starts_with("error: `--samples` is for methods that take samples"),
        "{errors}"
    );
    assert!(!folder.path().join("new").exists());
    let errors = fails(&folder, &["a.scn", "-o", "file"], 2);
    assert_eq!(
        errors,
        "error: file is a file, and the report is a folder of files\n"
    );
    assert_eq!(read(&folder, "file"), "kept");
    let errors = fails(&folder, &["a.scn", "--samples", "9007199254740992"], 2);
    assert!(errors.contains("more than 2^53"), "{errors}");
    let errors = fails(&folder, &["a.scn", "bad.scn", "--samples", "1"], 1);
    assert!(
        errors.contains("pinhole::unknown_field") && !errors.contains("rays"),
        "{errors}"
    );
}

/// A picture that takes no time.
fn small() -> (Subject, Scene) {
    let text = SCENE.replace("width 48 height 32", "width 12 height 8");
    let sources = Sources::new(Source::from_text("a.scn", text.as_str()));
    let scene = scene::read(&sources).scene.unwrap();
    let subject = Subject {
        name: "a.scn".to_owned(),
        recipe: Recipe {
            scene: text,
            overrides: Vec::new(),
            crop: None,
        },
    };
    (subject, scene)
}

#[test]
fn noisy_times_get_more_runs_where_time_is_left() {
    let (subject, scene) = small();
    let request = Request {
        methods: vec![Method::Sobol, Method::Exact],
        samples: vec![1, 4],
        runs: None,
        errors: Vec::new(),
        budget: std::time::Duration::from_secs(600),
        threads: None,
    };
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let plan = Plan::new(&subject, &scene, &request, &control).unwrap();
    let mut measured = measure(&plan, &control).unwrap();
    // There was time for as many as are made at most.
    assert_eq!((measured.runs, measured.rounds()), (9, 9));
    assert_eq!(speed::further(&plan, &measured).0, 0);
    // As if there had been time for three.
    let three = |times: &mut Vec<f64>, slow: f64| *times = vec![0.001, 0.001, 0.001 * slow];
    let mut as_if = |slow| {
        measured.runs = 3;
        for point in &mut measured.series[0].points {
            three(&mut point.times, slow);
            point.rmse.truncate(3);
        }
        three(&mut measured.exact.as_mut().unwrap().times, slow);
        speed::further(&plan, &measured).0
    };
    assert_eq!(as_if(1.1), 0);
    assert_eq!(as_if(1.5), 6);
    speed::measure_further(6, &plan, &control, &mut measured).unwrap();
    assert_eq!((measured.runs, measured.rounds()), (9, 9));
    let points = &measured.series[0].points;
    assert!(points.iter().all(|point| point.rmse.len() == 9));
    // Each has a seed of its own.
    let mut errors = points[1].rmse.clone();
    errors.sort_by(f64::total_cmp);
    errors.dedup();
    assert_eq!(errors.len(), 9);
    // Whoever says how many runs there are gets no others.
    let request = Request {
        runs: Some(3),
        ..request.clone()
    };
    let plan = Plan::new(&subject, &scene, &request, &control).unwrap();
    let mut measured = measure(&plan, &control).unwrap();
    measured.series[0].points[0].times[0] = 9.0;
    assert_eq!(speed::further(&plan, &measured).0, 0);
}

#[test]
fn answers_are_tried_where_time_is_left() {
    let (subject, scene) = small();
    let request = Request {
        methods: vec![Method::Sobol, Method::Exact],
        samples: Vec::new(),
        runs: Some(1),
        errors: vec![2e-4],
        budget: std::time::Duration::from_secs(30),
        threads: None,
    };
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let plan = Plan::new(&subject, &scene, &request, &control).unwrap();
    let mut measured = measure(&plan, &control).unwrap();
    let sobol = || {
        measured
            .series
            .iter()
            .find(|series| series.method == Method::Sobol)
    };
    let needed = sobol().unwrap().needed(2e-4).unwrap();
    assert!(
        needed.is_extrapolated && needed.per_pixel > 1024.0,
        "{needed:?}"
    );
    let points = &sobol().unwrap().points;
    let [.., before, last] = points.as_slice() else {
        panic!("{points:?}");
    };
    let between = (before.error() * last.error()).sqrt();
    let line = sobol().unwrap().needed(between).unwrap();
    assert!(!line.is_extrapolated && line.sag > 0.05, "{line:?}");
    measured.errors.push(between);
    let checks = Checks::new(&plan, &measured);
    assert!(checks.total() > 0);
    checks.run(&mut measured, &control).unwrap();
    let sobol = measured
        .series
        .iter()
        .find(|series| series.method == Method::Sobol);
    // A tenth more than the line said; or another try after that.
    let first = &sobol.unwrap().checks[0];
    assert_eq!(first.wanted, 2e-4);
    assert!(first.point.per_pixel as f64 >= 1.1 * needed.per_pixel);
    let needed = sobol.unwrap().needed(2e-4).unwrap();
    let most = sobol.unwrap().curve().last().unwrap().per_pixel;
    assert!(
        !needed.is_extrapolated && needed.per_pixel <= most as f64,
        "{needed:?}"
    );
    // Between two points, what the line says is taken, until a point is close.
    let needed = sobol.unwrap().needed(between).unwrap();
    let tries: Vec<_> = sobol.unwrap().checks.iter().collect();
    let tries: Vec<_> = tries.iter().filter(|it| it.wanted == between).collect();
    assert_eq!(tries[0].point.per_pixel as f64, line.per_pixel);
    assert!(needed.sag <= 0.01 || tries.len() == 3, "{needed:?}");
    assert!(needed.sag < line.sag, "{needed:?}");
    let check = sobol.unwrap().check(2e-4).unwrap();
    let text = speed::table(&measured);
    assert!(text.contains("  tried: "), "{text}");
    let rmse = check.point.error();
    let json = &speed::to_json(&measured)["methods"];
    let sobol = json
        .as_array()
        .unwrap()
        .iter()
        .find(|method| method["method"] == "sobol");
    assert_eq!(sobol.unwrap()["needed"][0]["tried"]["rmse"], rmse);
    // What the charts draw has a row.
    let csv = speed::to_csv(&measured);
    let mut tried = csv.lines().filter(|line| line.ends_with(",0.0002"));
    let row = format!("sobol,{},", check.point.per_pixel);
    assert!(tried.next_back().unwrap().starts_with(&row), "{csv}");
    assert!(
        speed::page(&[measured])
            .unwrap()
            .contains("tried: samples, error, time")
    );
}
