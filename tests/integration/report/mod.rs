//! Tests of reports of speed against error: tables, files and the page.

mod files;
#[cfg(unix)]
mod interrupted;
mod statistics;

use pinhole::{report::speed::Mixture, scene::Method};
use serde_json::{Value, json};

use crate::{program::Folder, scenes::read};

const SCENE: &str =
    "image { width 48 height 32 } camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sampler { method sobol per_pixel 4 seed 7 } sphere Ball { center (-1.6, 1, 0) color olive } checkerboard {}
";

/// Returns a folder that has [`SCENE`] in `a.scn`.
fn folder() -> Folder {
    Folder::with([("a.scn", SCENE)])
}

/// Returns the report of the scene as text for a terminal.
fn table(arguments: &str) -> String {
    folder().told(&format!("report a.scn {arguments}"), 0)
}

/// Returns the report of the scene as JSON. Asserts that the report is complete.
fn report(arguments: &str) -> Value {
    let answer = folder().done(&format!("report a.scn --format json {arguments}"));
    assert_eq!(answer.json()["complete"], true);
    answer.json()["reports"][0].clone()
}

/// Parses XML, or HTML that is also valid XML.
fn parsed(text: &str) -> roxmltree::Document<'_> {
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..Default::default()
    };
    roxmltree::Document::parse_with_options(text, options).unwrap()
}

#[test]
fn a_report_prints_a_table_and_one_recommendation() {
    let text = table("--samples 1,2,4,16 --runs 3");
    let start = "a.scn: 48 × 32 pixels, 3 runs, ";
    assert!(text.starts_with(start), "{text}");
    let row = |name: &str| -> Vec<&str> {
        let mut rows = text.lines().map(|line| line.split_whitespace().collect());
        rows.find(|row: &Vec<&str>| row.first() == Some(&name))
            .unwrap()
    };
    let (bent, rows): (Vec<_>, Vec<_>) = Method::SAMPLED
        .map(|method| row(method.name()))
        .into_iter()
        .partition(|row| row[1] == "bends");
    // `scatter` leaves pixels empty if there are few samples. Its points in the logarithmic chart
    // of the error over the number of samples are then not near a straight line, so no slope is
    // given.
    assert!(bent.iter().all(|row| row[2..4] == ["–", "–"]), "{text}");
    assert!(bent.iter().any(|row| row[0] == "scatter"), "{text}");
    assert!(rows.len() >= 5 && text.contains("\nbends: "), "{text}");
    for row in rows {
        // Rows are split at white space, so the signs `±` and `×` are two of the twelve words. `±`
        // precedes the error of the slope. `×` follows the factor by which the number of samples
        // must grow for a tenth of the error.
        assert_eq!((row.len(), row[2], row[6]), (12, "±", "×"), "{row:?}");
        // The slope is negative. The measured samples are too few for an error of 1/256, so `~`
        // marks the needed number of samples and the time as extrapolated.
        let are_first = [(1, '−'), (7, '~'), (8, '~')].map(|(at, c)| row[at].starts_with(c));
        assert_eq!(are_first, [true; 3], "{row:?}");
    }
    assert!(!row("exact").concat().contains('~'), "{text}");
    for words in ["samples", "for 1/256", "~ extrapolated; – not known"] {
        assert!(text.contains(words), "{text}");
    }
    let answers = text.lines().filter(|line| line.starts_with("Use "));
    assert_eq!(answers.count(), 1, "{text}");

    // The report has a table for each requested error.
    let several = table("--samples 1,4 --runs 1 --error 0.0101 --error 0.0104");
    for error in ["1/256", "0.0101", "0.0104"] {
        let answer = format!("use exact for an error of {error}: ");
        for words in [answer, format!(" for {error}\n")] {
            assert_eq!(several.matches(&words).count(), 1, "{several}");
        }
    }
    // The slope of a single run has no standard error.
    assert!(!several.contains('±'), "{several}");
    for line in text.lines().chain(several.lines()) {
        assert!(line.chars().count() <= 100, "it fits a terminal: {line}");
    }
}

#[test]
fn report_json_is_complete_and_errors_fall_with_samples() {
    let report =
        report("--samples 64,1,16,4,16 --runs 3 --error 0.5 --error 1e-6 --error 0.02 --threads 1");
    for (key, value) in [
        ("scene", json!("a.scn")),
        ("image", json!({ "width": 48, "height": 32 })),
        ("seed", json!(7)),
        ("threads", json!(1)),
        ("per_pixel", json!([1, 4, 16, 64])),
        ("runs", json!(3)),
    ] {
        assert_eq!(report[key], value, "{key}");
    }
    assert!(report["exact"]["bound"].as_f64().unwrap() < 1e-8);
    assert!(report["machine"]["processors"].as_u64().unwrap() >= 1);
    let methods = report["methods"].as_array().unwrap();
    assert_eq!(methods.len(), 9);
    for method in methods {
        let name = method["method"].as_str().unwrap();
        let measured = method["measured"].as_array().unwrap();
        assert_eq!(measured.len(), 4);
        for pair in measured.windows(2) {
            let [coarse, fine] = [0, 1].map(|at: usize| number(&pair[at]["rmse"]));
            assert!(fine < 0.75 * coarse, "{name}: {coarse} to {fine}");
            assert_eq!(pair[0]["runs"]["rmse"].as_array().unwrap().len(), 3);
        }
        for (point, time) in measured.iter().flat_map(|p| [(p, "time"), (p, "wall")]) {
            let runs = point["runs"][time].as_array().unwrap();
            let mut runs: Vec<_> = runs.iter().map(number).collect();
            runs.sort_by(f64::total_cmp);
            assert_eq!((runs.len(), runs[1]), (3, number(&point[time])), "{name}");
            assert!(runs[0] > 0.0, "{name}");
        }
        let slope = number(&method["fit"]["slope"]);
        let expected = match name {
            "random" => -0.53..-0.47,
            "regular" => -0.8..-0.4,
            "scatter" => -1.0..-0.5,
            _ => -0.85..-0.55,
        };
        assert!(expected.contains(&slope), "{name}: {slope}");
        // The first error is the default; the others were requested.
        for (at, error) in [1.0 / 256.0, 0.5, 1e-6, 0.02].into_iter().enumerate() {
            let needed = &method["needed"][at];
            assert_eq!(number(&needed["error"]), error);
            let times = ["least_time", "time", "greatest_time"].map(|key| number(&needed[key]));
            assert!(times.is_sorted(), "{needed}");
        }
        assert_eq!(method["needed"][1]["per_pixel"], 1.0, "{name}");
    }
    assert_eq!(report["verdicts"].as_array().unwrap().len(), 4);
    // Each run has its own seed, and different seeds cause different errors.
    let mut random = methods.iter().filter(|method| method["method"] == "random");
    let runs = &random.next().unwrap()["measured"][3]["runs"]["rmse"];
    assert!(runs[0] != runs[1] && runs[1] != runs[2]);
}

#[test]
fn the_inner_edges_of_a_box_are_edges_and_no_board() {
    const POST: &str = "image { width 48 height 32 } camera { eye (3, 2, 4) lookat (0, 0.7, 0) } box { center (0, 0.75, 0)";
    let shares = |objects: &str| {
        let folder = Folder::with([("a.scn", format!("{POST} {objects}").as_str())]);
        folder.told(
            "report a.scn --methods sobol --samples 1 --runs 1 -o out",
            0,
        );
        let json: Value = serde_json::from_str(&folder.text("out/report.json")).unwrap();
        let page = folder.text("out/index.html");
        let [edges, board] = ["edges", "board"].map(|key| number(&json["mixed_pixels"][key]));
        assert_eq!(page.contains("checkerboard alone"), board > 0.0);
        assert_eq!(page.contains("squares fall into one pixel"), board > 0.0);
        [edges, board]
    };
    let plain = shares("}");
    let faces = shares("colors (tan, wheat, peru) }");
    assert!(faces[0] > plain[0], "{faces:?} {plain:?}");
    assert_eq!([plain[1], faces[1]], [0.0; 2]);
    // Adds a board behind the box. The edges between the box's faces must not be attributed to the
    // board, so the number of edge pixels must not fall.
    let on_board = shares("colors (tan, wheat, peru) } checkerboard {}");
    assert!(on_board[0] >= faces[0] && on_board[1] > 0.0, "{on_board:?}");
}

/// Spheres of the same colour and spheres of different colours must give the same result: an edge
/// between two objects is found even if their colours are equal.
#[test]
fn colors_of_objects_do_not_change_the_share_of_the_board() {
    let balls = |colors: [&str; 2]| {
        let ball = |i: usize| {
            let (x, color) = (0.8 * i as f64 - 2.0, colors[i % 2]);
            format!("sphere {{ center ({x}, 0.5, 0) radius 0.5 color {color} }}")
        };
        let balls: String = (0..6).map(ball).collect();
        Mixture::of(&read(&format!(
            "image {{ width 48 height 32 }} camera {{ eye (0, 1.5, 6) lookat (0, 0.5, 0) }} checkerboard {{}} {balls}"
        )))
    };
    let [same, different] = [["red", "red"], ["red", "blue"]].map(balls);
    assert_eq!(same, different);
    assert!(same.board > 0.05 && same.edges > 0.05, "{same:?}");
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn sample_counts_grow_until_the_error_is_reached() {
    let report = report(
        "--methods random,sobol --runs 1 --budget 600 --error 0.05 --set image.width=24 --set image.height=16",
    );
    for method in report["methods"].as_array().unwrap() {
        assert_eq!(method["needed"][0]["extrapolated"], false, "{method}");
    }
    // The number of samples is increased only until the error reaches 1/256.
    let random = report["methods"][0]["measured"].as_array().unwrap();
    let is_enough = |point: &Value| number(&point["rmse"]) <= 1.0 / 256.0;
    assert_eq!(random.iter().position(is_enough), Some(random.len() - 1));
}

#[test]
fn no_method_claims_an_error_below_the_reference_bound() {
    // An error below the error bound of the reference picture cannot be measured.
    let report = report("--methods exact,sobol --samples 1,4 --runs 1 --error 1e-17");
    let bound = number(&report["reference"]["root_mean_square_bound"]);
    let largest = number(&report["exact"]["bound"]);
    assert!(1e-17 < bound && bound <= largest, "{bound} {largest}");
    let needed = &report["methods"][0]["needed"];
    assert!(needed[0]["per_pixel"].is_number() && needed[1]["per_pixel"].is_null());
    let verdict = "No method is known to reach an error of 1e-17.";
    assert_eq!(report["verdicts"][1], verdict);
}

#[test]
fn a_picture_of_one_colour_has_no_error() {
    let empty =
        "image { width 4 height 4 } camera { eye (0, 1, 0) direction (0, 1, 0) up (0, 0, 1) }";
    let folder = Folder::with([("empty.scn", empty)]);
    let text = folder.told("report empty.scn -o out", 0);
    let mut lines = text.lines().map(str::split_whitespace);
    let sobol = lines.find_map(|mut line| (line.next() == Some("sobol")).then_some(line));
    assert!(sobol.unwrap().take(4).eq(["–", "–", "–", "1"]), "{text}");
    parsed(&folder.text("out/index.html"));
    parsed(&folder.text("out/error-against-time.svg"));
}

#[test]
fn a_report_of_exact_alone_has_times_and_no_samples() {
    let folder = folder();
    folder.told("report a.scn --methods exact -o out --runs 2", 0);
    let json: Value = serde_json::from_str(&folder.text("out/report.json")).unwrap();
    assert_eq!(json["per_pixel"], json!([]));
    assert_eq!(json["exact"]["runs"]["time"].as_array().unwrap().len(), 2);
    let page = folder.text("out/index.html");
    parsed(&page);
    for absent in ["<svg", "dashed line", "samples per pixel", "The slope"] {
        assert!(!page.contains(absent), "{absent}");
    }
    parsed(&folder.text("out/error-against-samples.svg"));
}
