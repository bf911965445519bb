//! Speed against error: the binary's tables, files and page.

mod fit;

use std::{
    fs,
    path::Path,
    process::{Command, Output},
    sync::atomic::AtomicBool,
};

use base64::{Engine, prelude::BASE64_STANDARD};
use pinhole::{
    film::Recipe,
    render::Control,
    report::speed::{self, Checks, Plan, Request, Subject, measure},
    scene::{self, Method},
    source::{Source, Sources},
};
use serde_json::Value;
use tempfile::TempDir;

#[cfg(unix)]
use crate::interrupt::interrupted;
use crate::program;

const SCENE: &str =
    "image { width 48 height 32 } camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sampler { method sobol per_pixel 4 seed 7 } sphere Ball { center (-1.6, 1, 0) color olive } checkerboard {}
";

const SLOW: &str = "image { width 400 height 400 } camera { eye (0, 1, 5) lookat (0, 1, 0) } sphere { center (0, 1, 0) }";

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
        "million rays/s: all samples by the time that they take",
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
        assert!(needed[2]["factor"].as_f64().unwrap() > 1.0, "{name}");
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

/// What `sha256sum` says of a file, where there is one.
fn sha256sum(path: &Path) -> Option<String> {
    let output = Command::new("sha256sum").arg(path).output().ok()?;
    words(&output.stdout).split(' ').next().map(str::to_owned)
}

#[test]
fn a_folder_gets_whole_files() {
    let folder = folder();
    let arguments = [
        "a.scn",
        "-o",
        "new/speed",
        "--samples",
        "1,4,16",
        "--runs",
        "2",
        "--methods",
        "sobol,random,exact",
        "--set",
        "Ball.radius=1.2",
    ];
    let output = report(&folder, &arguments);
    assert!(output.status.success(), "{}", words(&output.stderr));
    let mut names: Vec<_> = fs::read_dir(folder.path().join("new/speed"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let all = [
        "error-against-samples.svg",
        "error-against-time.svg",
        "index.html",
        "report.csv",
        "report.json",
    ];
    assert_eq!(names, all);

    let csv = read(&folder, "new/speed/report.csv");
    let columns = csv.lines().next().unwrap().split(',').count();
    assert_eq!(csv.lines().count(), 1 + 2 * 3 + 1);
    assert!(csv.lines().all(|line| line.split(',').count() == columns));
    assert!(csv.lines().last().unwrap().starts_with("exact,,,2,"));

    let json: Value = serde_json::from_str(&read(&folder, "new/speed/report.json")).unwrap();
    assert_eq!(json["overrides"], serde_json::json!(["Ball.radius=1.2"]));
    if let Some(sum) = sha256sum(&folder.path().join("a.scn")) {
        assert_eq!(json["sha256"], sum);
    }

    for name in ["error-against-samples.svg", "error-against-time.svg"] {
        let svg = read(&folder, &format!("new/speed/{name}"));
        let document = parsed(&svg);
        assert!(
            document
                .root_element()
                .has_tag_name(("http://www.w3.org/2000/svg", "svg"))
        );
        let text: Vec<_> = document
            .descendants()
            .filter(|node| node.has_tag_name("text"))
            .collect();
        let labelled = |word: &str| {
            text.iter().any(|node| {
                node.text()
                    .is_some_and(|text| text.trim().starts_with(word))
            })
        };
        assert!(
            labelled("sobol") && labelled("random") && labelled("1/256") || name.contains("time"),
            "{name}"
        );
        assert_eq!(labelled("exact:"), name.contains("time"));
    }

    let page = read(&folder, "new/speed/index.html");
    let document = parsed(&page);
    let elements = |name: &'static str| {
        document
            .descendants()
            .filter(move |node| node.tag_name().name() == name)
    };
    assert_eq!(elements("script").count(), 0);
    assert_eq!(elements("table").count(), 3);
    // The exact picture, and for each sampled method the picture and its errors.
    assert_eq!(elements("img").count(), 5);
    for image in elements("img") {
        assert!(!image.attribute("alt").unwrap().is_empty());
        let data = image.attribute("src").unwrap();
        let png = data.strip_prefix("data:image/png;base64,").unwrap();
        let picture = image::load_from_memory(&BASE64_STANDARD.decode(png).unwrap()).unwrap();
        assert_eq!((picture.width(), picture.height()), (48, 32));
    }
    // Nothing is fetched from elsewhere.
    for node in document.descendants() {
        for attribute in node
            .attributes()
            .filter(|attribute| ["src", "href"].contains(&attribute.name()))
        {
            assert!(attribute.value().starts_with("data:"));
        }
    }
}

#[test]
fn labels_of_a_chart_do_not_lie_upon_each_other() {
    let folder = folder();
    let output = report(
        &folder,
        &["a.scn", "-o", "out", "--samples", "1,4", "--runs", "1"],
    );
    assert!(output.status.success());
    for name in ["samples", "time"] {
        let svg = read(&folder, &format!("out/error-against-{name}.svg"));
        let document = parsed(&svg);
        let mut heights: Vec<i32> = document
            .descendants()
            .filter(|node| {
                let text = node.text().unwrap_or_default().trim();
                let first = text.split(' ').next().unwrap();
                node.has_tag_name("text")
                    && Method::SAMPLED.iter().any(|method| method.name() == first)
            })
            .map(|node| node.attribute("y").unwrap().parse().unwrap())
            .collect();
        assert_eq!(heights.len(), 9);
        heights.sort_unstable();
        assert!(
            heights.windows(2).all(|pair| pair[1] - pair[0] >= 15),
            "{heights:?}"
        );
        assert!(heights[0] > 0 && heights[8] < 540);
    }
}

#[test]
fn several_scenes_have_a_folder_each_and_one_page() {
    let folder = folder();
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("sub/a.scn"), SCENE).unwrap();
    let arguments = [
        "a.scn",
        "sub/a.scn",
        "-o",
        "out",
        "--samples",
        "1",
        "--runs",
        "1",
        "--methods",
        "halton",
    ];
    assert!(report(&folder, &arguments).status.success());
    for name in [
        "out/a/report.csv",
        "out/a-2/report.json",
        "out/a-2/index.html",
    ] {
        read(&folder, name);
    }
    let page = read(&folder, "out/index.html");
    assert!(page.contains(">a.scn</h2>") && page.contains(">sub/a.scn</h2>"));
    parsed(&page);
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

#[test]
fn answers_are_tried_where_time_is_left() {
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
    assert!(
        speed::page(&[measured])
            .unwrap()
            .contains("tried: samples, error, time")
    );
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_was_measured() {
    let folder = folder();
    fs::write(folder.path().join("slow.scn"), SLOW).unwrap();
    // Ten thousand runs: long enough, and the first ones are over soon.
    let arguments = [
        "slow.scn",
        "-o",
        "out",
        "--format",
        "json",
        "--samples",
        "1,2",
        "--runs",
        "10000",
        "--methods",
        "sobol,exact",
    ];
    let after = 2500;
    let output = interrupted(&mut command(&folder, &arguments), after);
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(answer["complete"], false);
    let report = &answer["reports"][0];
    assert_eq!(
        (&report["complete"], &report["warm_up"]),
        (&false.into(), &false.into())
    );
    assert!(report["runs"].as_u64().unwrap() >= 1);
    assert!(
        report["notes"][0]
            .as_str()
            .unwrap()
            .starts_with("Incomplete: it was interrupted in run ")
    );
    parsed(&read(&folder, "out/index.html"));
    read(&folder, "out/report.csv");
}

#[cfg(unix)]
#[test]
fn ctrl_c_before_the_first_run_keeps_the_warm_up() {
    let folder = folder();
    fs::write(folder.path().join("slow.scn"), SLOW).unwrap();
    // A run takes minutes, the warm-up does not.
    let arguments = [
        "slow.scn",
        "-o",
        "out",
        "--samples",
        "100000000",
        "--runs",
        "1",
        "--methods",
        "sobol,random,exact",
    ];
    let after = 2500;
    let output = interrupted(&mut command(&folder, &arguments), after);
    let text = words(&output.stderr);
    assert!(text.contains("\nrandom "), "{text}");
    assert!(
        text.contains("note: Incomplete: it was interrupted before the first run was over."),
        "{text}"
    );
    let json: Value = serde_json::from_str(&read(&folder, "out/report.json")).unwrap();
    assert_eq!(
        (&json["complete"], &json["warm_up"]),
        (&false.into(), &true.into())
    );
    assert_eq!(json["per_pixel"], serde_json::json!([4]));
    assert!(json["exact"]["time"]["median"].as_f64().unwrap() > 0.0);
    let measured = &json["methods"][0]["measured"];
    assert_eq!(measured[0]["time"]["runs"].as_array().unwrap().len(), 2);
    assert!(measured[0]["rmse"].as_f64().unwrap() > 0.0);
    parsed(&read(&folder, "out/index.html"));
    read(&folder, "out/report.csv");
}

#[cfg(unix)]
#[test]
fn ctrl_c_before_the_exact_picture_says_that_nothing_was_measured() {
    let folder = folder();
    let large = format!(
        "{SCENE} {}",
        "triangle { centroid (0, 1, 0) normal (0, 0, 1) }"
    )
    .replace("width 48 height 32", "width 6000 height 4000");
    fs::write(folder.path().join("large.scn"), large).unwrap();
    let arguments = ["large.scn", "--methods", "sobol", "--samples", "1"];
    let after = 700;
    let output = interrupted(&mut command(&folder, &arguments), after);
    assert_eq!(
        words(&output.stderr),
        "warning: interrupted before anything was measured: the exact picture comes first, then the methods\n"
    );
}
