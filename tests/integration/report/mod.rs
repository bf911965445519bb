//! Speed against error: the binary's tables, files and page.

mod files;
#[cfg(unix)]
mod interrupted;
mod statistics;

use pinhole::scene::Method;
use serde_json::{Value, json};

use crate::{
    program::Folder,
    table::{list, rows},
};

const SCENE: &str =
    "image { width 48 height 32 } camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sampler { method sobol per_pixel 4 seed 7 } sphere Ball { center (-1.6, 1, 0) color olive } checkerboard {}
";

/// A folder with the scene in `a.scn`.
fn folder() -> Folder {
    Folder::with([("a.scn", SCENE)])
}

/// What people are told of the scene.
fn table(arguments: &str) -> String {
    folder().told(&format!("report a.scn {arguments}"), 0)
}

/// The report of the scene for programs, and whether it is complete.
fn report(arguments: &str) -> Value {
    let answer = folder().done(&format!("report a.scn --format json {arguments}"));
    assert_eq!(answer.json()["complete"], true);
    answer.json()["reports"][0].clone()
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
    let text = table("--samples 1,2,4,16 --runs 2");
    let start = "a.scn: 48 × 32 pixels, 2 runs, ";
    assert!(text.starts_with(start), "{text}");
    let row = |name: &str| -> Vec<&str> {
        let mut rows = text.lines().map(|line| line.split_whitespace().collect());
        rows.find(|row: &Vec<&str>| row.first() == Some(&name))
            .unwrap()
    };
    for method in Method::SAMPLED {
        let row = row(method.name());
        // Slope, ±, its error, samples, two times with their units.
        assert_eq!((row.len(), row[2]), (9, "±"), "{row:?}");
        assert!(row[1].starts_with('−'), "{row:?}");
        // So few samples do not come to 1/256.
        assert!(
            row[4].starts_with('~') && row[5].starts_with('~'),
            "{row:?}"
        );
    }
    assert!(!row("exact").concat().contains('~'), "{text}");
    for words in ["samples", "for 1/256", "~ extrapolated; – not known"] {
        assert!(text.contains(words), "{text}");
    }
    let answers = text.lines().filter(|line| line.starts_with("Use "));
    assert_eq!(answers.count(), 1, "{text}");
    assert!(is_narrow(&text), "{text}");
}

fn is_narrow(text: &str) -> bool {
    text.lines().all(|line| line.chars().count() <= 100)
}

#[test]
fn each_error_has_a_table_that_fits_a_terminal() {
    let text = table("--samples 1,4 --runs 1 --error 0.0101 --error 0.0104");
    for error in ["1/256", "0.0101", "0.0104"] {
        for words in [
            format!("use exact for an error of {error}: "),
            format!(" for {error}\n"),
        ] {
            assert_eq!(text.matches(&words).count(), 1, "{text}");
        }
    }
    assert!(is_narrow(&text), "{text}");
    // A slope through two points has no standard error.
    assert!(!text.contains('±'), "{text}");
}

#[test]
fn the_answer_is_the_method_with_the_least_time() {
    let report = report("--samples 1,16,256 --runs 3 --error 0.02");
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
        let fastest = times.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        let verdict = report["verdicts"][at].as_str().unwrap();
        let start = format!("Use {}", fastest.unwrap().1);
        let rest = verdict.strip_prefix(&start).expect(verdict);
        assert!(rest.starts_with([',', ' ']), "{verdict}");
    }
}

#[test]
fn programs_get_json_and_errors_fall() {
    let report = report("--samples 64,1,16,4,16 --runs 3 --error 0.5 --error 1e-6 --threads 1");
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
        // That of which everybody is told, and those that were asked for.
        let needed = [0, 1, 2].map(|at| &method["needed"][at]);
        let errors = needed.map(|needed| needed["error"].as_f64());
        assert_eq!(errors, [1.0 / 256.0, 0.5, 1e-6].map(Some));
        assert_eq!(needed[1]["per_pixel"], 1.0, "{name}");
        let extrapolated = [1, 2].map(|at| needed[at]["extrapolated"].as_bool());
        assert_eq!(extrapolated, [Some(false), Some(true)], "{name}");
    }
    // Each run draws its own seed's samples, and the errors of the seeds differ.
    let mut random = methods.iter().filter(|method| method["method"] == "random");
    let runs = random.next().unwrap()["measured"][3]["runs"]["rmse"].clone();
    assert!(runs[0] != runs[1] && runs[1] != runs[2]);
}

#[test]
fn samples_go_on_until_the_error_is_reached() {
    let report = report(
        "--methods random,sobol --runs 1 --budget 600 --error 0.05 --set image.width=24 --set image.height=16",
    );
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
    // Where the bound is, and below what any number of samples is worth.
    let report = report("--methods exact,sobol --samples 1,4 --runs 1 --error 1e-17");
    let bound = report["reference"]["root_mean_square_bound"].as_f64();
    let (bound, largest) = (bound.unwrap(), report["exact"]["bound"].as_f64().unwrap());
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
    let empty =
        "image { width 4 height 4 } camera { eye (0, 1, 0) direction (0, 1, 0) up (0, 0, 1) }";
    let folder = Folder::with([("empty.scn", empty)]);
    let text = folder.told("report empty.scn -o out", 0);
    let mut lines = text.lines().map(str::split_whitespace);
    let sobol = lines.find_map(|mut line| (line.next() == Some("sobol")).then_some(line));
    assert!(sobol.unwrap().take(2).eq(["–", "1"]), "{text}");
    parsed(&folder.text("out/index.html"));
    parsed(&folder.text("out/error-against-time.svg"));
}

#[test]
fn exact_alone_has_a_time_and_no_samples() {
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

#[test]
fn wrong_arguments_are_told() {
    let folder = folder();
    folder.write("file", "kept");
    folder.write("bad.scn", "sphere { radus 2 }");
    // A report never writes over a scene.
    folder.write("index.html", SCENE);
    for line in list(
        "
        a.scn --samples 0
        a.scn --samples 1,x
        a.scn --runs 0
        a.scn --error 0
        a.scn --error 1/0
        a.scn --error nan
        a.scn --error 2
        a.scn --budget 0
        a.scn --numerics
        --numerics --runs 3
        none.scn
        - -
    ",
    ) {
        folder.told(&format!("report {line}"), 2);
    }
    for [line, status, words] in rows("
        a.scn --methods sobol,jitered -> 2 -> 'jittered'
        a.scn --methods exact --samples 4 -o new -> 2 -> error: `--samples` is for methods that take samples
        a.scn -o file -> 2 -> error: file is a file, and the report is a folder of files\n
        a.scn --samples 9007199254740992 -> 2 -> more than 2^53
        a.scn bad.scn --samples 1 -> 1 -> pinhole::unknown_field
        index.html --samples 1 -o . -> 2 -> would write over the scene
    ") {
        let told = folder.told(&format!("report {line}"), status.parse().unwrap());
        assert!(told.contains(words), "{told}");
    }
    assert_eq!(folder.names(), ["a.scn", "bad.scn", "file", "index.html"]);
    assert_eq!(folder.text("file"), "kept");
    assert_eq!(folder.text("index.html"), SCENE);
}

/// Links that are there already lead nowhere: neither a file nor a scene's folder is written through one.
#[cfg(unix)]
#[test]
fn no_link_leads_out_of_the_folder() {
    use std::{fs, os::unix::fs::symlink};

    let line =
        |scenes: &str| format!("report {scenes} -o out --samples 1 --runs 1 --methods sobol");
    for (scenes, link) in [
        ("a.scn", "index.html"),
        ("a.scn", "report.csv"),
        ("a.scn a.scn", "a-2"),
        ("a.scn a.scn", "index.html"),
    ] {
        let folder = folder();
        fs::create_dir_all(folder.path("outside/deep")).unwrap();
        fs::create_dir(folder.path("out")).unwrap();
        symlink(folder.path("outside/deep"), folder.path("out").join(link)).unwrap();
        let expected = format!(
            "error: out/{link} is a symbolic link, and a report writes nothing outside of its folder\n"
        );
        assert_eq!(folder.told(&line(scenes), 2), expected);
        let mut written = fs::read_dir(folder.path("outside/deep")).unwrap();
        assert!(written.next().is_none());
    }
    // What the user names may be a link.
    let folder = folder();
    fs::create_dir(folder.path("real")).unwrap();
    symlink("real", folder.path("out")).unwrap();
    folder.told(&line("a.scn"), 0);
    folder.text("real/index.html");
}
