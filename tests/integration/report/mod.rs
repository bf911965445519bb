//! Speed against error: the binary's tables, files and page.

mod files;
mod fit;
#[cfg(unix)]
mod interrupted;
mod planned;

use std::{
    fs,
    process::{Command, Output},
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
        "which sampled method is the fastest is not known",
        "million samples/s: all samples by the time that they take, traced or not",
        "million rays/s: those of the samples that are traced",
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
        for point in measured {
            let [samples, rays] = ["samples", "rays"].map(|key| point[key].as_u64().unwrap());
            // Neither is all of the picture in doubt, nor nothing of it.
            assert!(0 < rays && rays < samples, "{name}: {rays} of {samples}");
            let [samples_a_second, rays_a_second] =
                ["samples_per_second", "rays_per_second"].map(|key| point[key].as_f64().unwrap());
            let ratio = rays_a_second / samples_a_second;
            assert!(
                (ratio - rays as f64 / samples as f64).abs() < 1e-9,
                "{name}"
            );
        }
        let needed = method["needed"].as_array().unwrap();
        // That of which everybody is told, and those that were asked for.
        let errors: Vec<_> = needed
            .iter()
            .map(|needed| needed["error"].as_f64())
            .collect();
        assert_eq!(errors, [1.0 / 256.0, 0.5, 1e-6].map(Some));
        // There are no fewer than one.
        assert_eq!(needed[1]["at_most"], false, "{name}");
        assert_eq!(needed[1]["per_pixel"], 1.0, "{name}");
        assert_eq!(needed[1]["extrapolated"], false);
        assert_eq!(needed[1]["factor"], 1.0, "{name}");
        assert_eq!(needed[2]["extrapolated"], true, "{name}");
        // Untried, nothing is known of samples that know of each other.
        let factor = needed[2]["factor"].as_f64();
        let is_independent = ["random", "scatter"].contains(&name);
        assert_eq!(factor.is_some(), is_independent, "{name}");
        assert!(factor.is_none_or(|factor| factor > 2.0), "{name}");
        // Whoever says how many samples are taken gets no others.
        assert_eq!(needed[2]["tries"], serde_json::json!([]));
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
fn where_the_fewest_samples_are_enough_programs_are_told() {
    let folder = folder();
    let arguments = "a.scn --format json --methods random --samples 4,16 --runs 2 --error 0.5";
    let output = report(&folder, &arguments.split(' ').collect::<Vec<_>>());
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    let needed = &answer["reports"][0]["methods"][0]["needed"][1];
    assert_eq!(
        (&needed["per_pixel"], &needed["at_most"]),
        (&4.0.into(), &true.into())
    );
}

#[test]
fn single_runs_promise_nothing() {
    let folder = folder();
    let arguments = [
        "a.scn",
        "--samples",
        "1,4",
        "--runs",
        "1",
        "--methods",
        "sobol,random",
    ];
    let output = report(&folder, &arguments);
    let text = words(&output.stderr);
    let one_line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        one_line.contains("which sampled method is the fastest is not known"),
        "{text}"
    );
    let mut sobol = text.lines().filter(|line| line.starts_with("sobol"));
    let last: Vec<_> = sobol.next_back().unwrap().split_whitespace().collect();
    assert_eq!(
        (last[2], *last.last().unwrap()),
        ("?", "extrapolated"),
        "{text}"
    );
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
    let needed = report["methods"][0]["needed"].as_array().unwrap();
    let [common, least] = needed.as_slice() else {
        panic!("{needed:?}");
    };
    assert!(common["per_pixel"].is_number() && least["per_pixel"].is_null());
    // Nothing is known of the spread of a single run.
    assert!(report["exact"]["time"]["spread"].is_null());

    let text = report_text(
        &folder,
        "a.scn --methods exact,sobol --samples 1,4 --runs 1 --error 1e-17",
    );
    let (_, below) = text.split_once("for 1.0e-17").unwrap();
    let row = |name: &str| {
        let mut rows = below.lines().filter(|line| line.starts_with(name));
        let cells = rows.next().unwrap().split_whitespace();
        cells.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(row("exact"), ["exact", "-", "-"], "{text}");
    assert_eq!(row("sobol"), ["sobol", "-", "-"], "{text}");
    assert!(
        below.contains("An error of 1.0e-17 cannot be told from none"),
        "{text}"
    );
}

fn report_text(folder: &TempDir, arguments: &str) -> String {
    let output = report(folder, &arguments.split(' ').collect::<Vec<_>>());
    words(&output.stderr).to_owned()
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
        text.contains("; every sampled method had no error at all with 1 sample per pixel already, in 1 run, so that none is the fastest"),
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
