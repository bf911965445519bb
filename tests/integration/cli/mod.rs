//! Tests of the program `pinhole` as a user runs it: arguments, files, output and exit status.

mod frames;
mod render;
mod shards;
mod sheet;
mod terminal;
#[cfg(unix)]
mod transcripts;

#[cfg(unix)]
use crate::interrupt::interrupted;
use crate::program::Folder;

/// Small scene with a byte order mark, a CRLF line end, a definition, and each kind of block.
const SCENE: &str = "\u{feff}// A ball on a floor.\r
let h = 1
image { width 64 height 36 }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sampler { method sobol per_pixel 4 seed 7 }
sphere Ball { center (-1.6, h, 0) }
checkerboard {}
";

/// Returns a folder that has [`SCENE`] in `a.scn`.
fn folder() -> Folder {
    Folder::with([("a.scn", SCENE)])
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_hard_cases_measured_so_far() {
    let folder = folder();
    let line = "report --numerics --inputs 1000000000 --threads 1";
    let in_json = format!("{line} --format json");
    let table = interrupted(&mut folder.command(&in_json), 1500).json();
    assert_eq!(table["complete"], false);
    let cases = table["numerics"].as_array().unwrap();
    let asked = cases[0]["inputs"].as_u64().unwrap();
    assert!((1..1_000_000_000).contains(&asked), "{asked}");
    let people = interrupted(&mut folder.command(line), 1500).errors;
    assert!(people.contains("S1a  rays that nearly touch a sphere"));
    // The expected message states the number of inputs of all cases together. The table of the
    // interrupted run may lack some cases, so the number of cases is taken from a complete run.
    let all = folder
        .done("report --numerics --inputs 1 --format json")
        .json();
    let inputs = format!(
        "{}_000_000_000 inputs",
        all["numerics"].as_array().unwrap().len()
    );
    let end = format!("it was interrupted before {inputs} were asked.\n");
    assert!(people.ends_with(&end), "{people}");
}
