//! Reports that are ended by Ctrl-C.

use std::fs;

use serde_json::Value;

use super::{SCENE, command, folder, parsed, read, words};
use crate::interrupt::interrupted;

const SLOW: &str = "image { width 400 height 400 } camera { eye (0, 1, 5) lookat (0, 1, 0) } sphere { center (0, 1, 0) }";

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
    assert_eq!(report["complete"], false);
    assert!(report["runs"].as_u64().unwrap() >= 1);
    let page = read(&folder, "out/index.html");
    assert!(page.contains("Interrupted: these are the runs that were made until then."));
    parsed(&page);
    read(&folder, "out/report.csv");
}

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
