//! Speed against error: the binary's tables, files and page.

mod files;
#[cfg(unix)]
mod interrupted;
mod statistics;

use std::{
    fs,
    process::{Command, Output},
};

use pinhole::scene::Method;
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
fn people_get_a_table_and_an_answer() {
    let folder = folder();
    let output = report(&folder, &["a.scn", "--samples", "1,2,4,16", "--runs", "2"]);
    let text = words(&output.stderr);
    assert!(
        output.status.success() && output.stdout.is_empty(),
        "{text}"
    );
    assert!(
        text.starts_with("a.scn: 48 × 32 pixels, 2 runs, "),
        "{text}"
    );
    for method in Method::SAMPLED {
        let mut rows = text.lines().map(str::split_whitespace);
        let row = rows.find_map(|mut row| (row.next() == Some(method.name())).then_some(row));
        let row: Vec<_> = row.unwrap().collect();
        // Slope, ±, its error, samples, two times with their units.
        assert_eq!((row.len(), row[1]), (8, "±"), "{row:?}");
        assert!(row[0].starts_with('−'), "{row:?}");
        // So few samples do not come to 1/256.
        assert!(
            row[3].starts_with('~') && row[4].starts_with('~'),
            "{row:?}"
        );
    }
    let exact = text
        .lines()
        .find(|line| line.trim_start().starts_with("exact "));
    assert!(!exact.unwrap().contains('~'), "{text}");
    assert!(
        text.contains("samples") && text.contains("for 1/256"),
        "{text}"
    );
    assert!(text.contains("~ extrapolated; – not known"), "{text}");
    let answer = text.lines().filter(|line| line.starts_with("Use "));
    assert_eq!(answer.count(), 1, "{text}");
    for line in text.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
}

#[test]
fn each_error_has_a_table_that_fits_a_terminal() {
    let folder = folder();
    let arguments = "a.scn --samples 1,4 --runs 1 --error 0.0101 --error 0.0104";
    let output = report(&folder, &arguments.split(' ').collect::<Vec<_>>());
    let text = words(&output.stderr);
    for error in ["1/256", "0.0101", "0.0104"] {
        assert_eq!(
            text.matches(&format!("use exact for an error of {error}: "))
                .count(),
            1,
            "{text}"
        );
        assert_eq!(
            text.matches(&format!(" for {error}\n")).count(),
            1,
            "{text}"
        );
    }
    assert!(
        text.lines().all(|line| line.chars().count() <= 100),
        "{text}"
    );
    // A slope through two points has no standard error.
    assert!(!text.contains('±'), "{text}");
}

#[test]
fn the_answer_is_the_method_with_the_least_time() {
    let folder = folder();
    let arguments = "a.scn --format json --samples 1,16,256 --runs 3 --error 0.02";
    let output = report(&folder, &arguments.split(' ').collect::<Vec<_>>());
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    let report = &answer["reports"][0];
    for at in 0..2 {
        let mut times = vec![(report["exact"]["time"].as_f64().unwrap(), "exact")];
        for method in report["methods"].as_array().unwrap() {
            let needed = &method["needed"][at];
            let [time, least, most] =
                ["time", "least_time", "greatest_time"].map(|key| needed[key].as_f64().unwrap());
            assert!(least <= time && time <= most, "{needed}");
            if needed["extrapolated"] == false {
                times.push((time, method["method"].as_str().unwrap()));
            }
        }
        let (_, fastest) = times
            .into_iter()
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap();
        let verdict = report["verdicts"][at].as_str().unwrap();
        let start = format!("Use {fastest}");
        let rest = verdict.strip_prefix(&start).expect(verdict);
        assert!(rest.starts_with([',', ' ']), "{verdict}");
    }
}

#[test]
fn programs_get_json_and_errors_fall() {
    let folder = folder();
    let arguments =
        "a.scn --format json --samples 64,1,16,4,16 --runs 3 --error 0.5 --error 1e-6 --threads 1";
    let output = report(&folder, &arguments.split(' ').collect::<Vec<_>>());
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
            assert_eq!(pair[0]["runs"]["rmse"].as_array().unwrap().len(), 3);
        }
        for point in measured {
            for time in ["time", "wall"] {
                let median = point[time].as_f64().unwrap();
                let runs = point["runs"][time].as_array().unwrap();
                let mut runs: Vec<_> = runs.iter().map(|run| run.as_f64().unwrap()).collect();
                runs.sort_by(f64::total_cmp);
                assert_eq!((runs.len(), runs[1]), (3, median), "{name}");
                assert!(runs[0] > 0.0, "{name}");
            }
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
        // That of which everybody is told, and those that were asked for.
        let errors: Vec<_> = needed
            .iter()
            .map(|needed| needed["error"].as_f64())
            .collect();
        assert_eq!(errors, [1.0 / 256.0, 0.5, 1e-6].map(Some));
        let found = (&needed[1]["per_pixel"], &needed[1]["extrapolated"]);
        assert_eq!(found, (&1.0.into(), &false.into()), "{name}");
        assert_eq!(needed[2]["extrapolated"], true, "{name}");
    }
    // Each run draws its own seed's samples, and the errors of the seeds differ.
    let mut random = methods.iter().filter(|method| method["method"] == "random");
    let runs = random.next().unwrap()["measured"][3]["runs"]["rmse"].clone();
    assert!(runs[0] != runs[1] && runs[1] != runs[2]);
}

#[test]
fn samples_go_on_until_the_error_is_reached() {
    let folder = folder();
    let arguments = "a.scn --format json --methods random,sobol --runs 1 --budget 600 --error 0.05";
    let output = report(&folder, &arguments.split(' ').collect::<Vec<_>>());
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    let report = &answer["reports"][0];
    for method in report["methods"].as_array().unwrap() {
        assert_eq!(method["needed"][0]["extrapolated"], false, "{method}");
    }
    // Not beyond.
    let random = report["methods"][0]["measured"].as_array().unwrap();
    let [.., before, last] = random.as_slice() else {
        panic!("{random:?}");
    };
    assert!(before["rmse"].as_f64() > Some(1.0 / 256.0), "{before}");
    assert!(last["rmse"].as_f64() <= Some(1.0 / 256.0), "{last}");
}

#[test]
fn no_method_comes_nearer_than_the_reference_is_known() {
    let folder = folder();
    // Where the bound is, and below what any number of samples is worth.
    let arguments =
        "a.scn --format json --methods exact,sobol --samples 1,4 --runs 1 --error 1e-17";
    let output = report(&folder, &arguments.split(' ').collect::<Vec<_>>());
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    let report = &answer["reports"][0];
    let bound = report["reference"]["root_mean_square_bound"]
        .as_f64()
        .unwrap();
    let largest = report["exact"]["bound"].as_f64().unwrap();
    assert!(1e-17 < bound && bound <= largest, "{bound} {largest}");
    let needed = &report["methods"][0]["needed"];
    assert!(needed[0]["per_pixel"].is_number() && needed[1]["per_pixel"].is_null());
    assert_eq!(
        report["verdicts"][1],
        "No method is known to come to an error of 1e-17."
    );
}

#[test]
fn a_picture_of_one_colour_has_no_error() {
    let folder = folder();
    let empty =
        "image { width 4 height 4 } camera { eye (0, 1, 0) direction (0, 1, 0) up (0, 0, 1) }";
    fs::write(folder.path().join("empty.scn"), empty).unwrap();
    let output = report(&folder, &["empty.scn", "-o", "out"]);
    let text = words(&output.stderr);
    assert!(output.status.success(), "{text}");
    let sobol = text
        .lines()
        .find(|line| line.trim_start().starts_with("sobol"));
    let cells: Vec<_> = sobol.unwrap().split_whitespace().collect();
    assert_eq!(cells[1..3], ["–", "1"], "{text}");
    parsed(&read(&folder, "out/index.html"));
    parsed(&read(&folder, "out/error-against-time.svg"));
}

#[test]
fn exact_alone_has_a_time_and_no_samples() {
    let folder = folder();
    let output = report(
        &folder,
        &["a.scn", "--methods", "exact", "-o", "out", "--runs", "2"],
    );
    let text = words(&output.stderr);
    assert!(output.status.success(), "{text}");
    let json: Value = serde_json::from_str(&read(&folder, "out/report.json")).unwrap();
    assert_eq!(json["per_pixel"], serde_json::json!([]));
    assert_eq!(json["exact"]["runs"]["time"].as_array().unwrap().len(), 2);
    let page = read(&folder, "out/index.html");
    parsed(&page);
    for absent in ["<svg", "dashed line", "samples per pixel", "The slope"] {
        assert!(!page.contains(absent), "{absent}");
    }
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
    assert!(errors.contains("pinhole::unknown_field"), "{errors}");
    // A report never writes over a scene.
    fs::copy(
        folder.path().join("a.scn"),
        folder.path().join("index.html"),
    )
    .unwrap();
    let kept = read(&folder, "index.html");
    let errors = fails(&folder, &["index.html", "--samples", "1", "-o", "."], 2);
    assert!(errors.contains("would write over the scene"), "{errors}");
    assert_eq!(read(&folder, "index.html"), kept);
}

/// Links that are there already lead nowhere: neither a file nor a scene's folder is written through one.
#[cfg(unix)]
#[test]
fn no_link_leads_out_of_the_folder() {
    use std::os::unix::fs::symlink;

    for (scenes, link) in [
        ("a.scn", "index.html"),
        ("a.scn", "report.csv"),
        ("a.scn a.scn", "a-2"),
        ("a.scn a.scn", "index.html"),
    ] {
        let folder = folder();
        let path = |name: &str| folder.path().join(name);
        fs::create_dir_all(path("outside/deep")).unwrap();
        fs::create_dir(path("out")).unwrap();
        symlink(path("outside/deep"), path("out").join(link)).unwrap();
        let arguments = format!("{scenes} -o out --samples 1 --runs 1 --methods sobol");
        let errors = fails(&folder, &arguments.split(' ').collect::<Vec<_>>(), 2);
        let expected = format!(
            "error: out/{link} is a symbolic link, and a report writes nothing outside of its folder\n"
        );
        assert_eq!(errors, expected);
        assert_eq!(fs::read_dir(path("outside/deep")).unwrap().count(), 0);
    }
    // What the user names may be a link.
    let folder = folder();
    fs::create_dir(folder.path().join("real")).unwrap();
    symlink("real", folder.path().join("out")).unwrap();
    let arguments = "a.scn -o out --samples 1 --runs 1 --methods sobol";
    let output = report(&folder, &arguments.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{}", words(&output.stderr));
    read(&folder, "real/index.html");
}
