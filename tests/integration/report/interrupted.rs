//! Tests of reports that Ctrl-C ends early.

use super::{SCENE, folder, parsed};
use crate::interrupt::interrupted;

const SLOW: &str = "image { width 100 height 100 } camera { eye (0, 1, 5) lookat (0, 1, 0) } sphere { center (0, 1, 0) }";

#[test]
fn ctrl_c_keeps_what_was_measured() {
    let folder = folder();
    folder.write("slow.scn", SLOW);
    // A run ends soon, but ten thousand runs take long enough to be interrupted.
    let line = "report slow.scn -o out --format json --samples 1,2 --runs 10000 --methods sobol,exact --threads 1";
    let answer = interrupted(&mut folder.command(line), 1000).json();
    assert_eq!(answer["complete"], false);
    let report = &answer["reports"][0];
    assert_eq!(report["complete"], false);
    assert!(report["runs"].as_u64().unwrap() >= 1);
    let page = folder.text("out/index.html");
    assert!(page.contains("Interrupted: these are the runs that were made until then."));
    parsed(&page);
    folder.text("out/report.csv");
}

#[test]
fn ctrl_c_before_the_exact_picture_says_that_nothing_was_measured() {
    let folder = folder();
    let large = SCENE.replace("width 48 height 32", "width 6000 height 4000");
    folder.write("large.scn", large);
    let line = "report large.scn --methods sobol --samples 1 --threads 1";
    assert_eq!(
        interrupted(&mut folder.command(line), 700).errors,
        "warning: interrupted before anything was measured: the exact picture comes first, then the methods\n"
    );
}
