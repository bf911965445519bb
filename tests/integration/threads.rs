//! How many threads the program starts.

use std::{
    fmt::Write,
    fs,
    process::{Child, Stdio},
    thread,
    time::Duration,
};

use tempfile::TempDir;

use crate::program::command;

/// The most threads that a process was seen with until it ended. It may have had more: one looks only now and then.
fn most(process: &mut Child) -> usize {
    let tasks = format!("/proc/{}/task", process.id());
    let mut most = 0;
    while process.try_wait().expect("a status").is_none() {
        most = most.max(fs::read_dir(&tasks).map_or(0, Iterator::count));
        thread::sleep(Duration::from_micros(200));
    }
    most
}

fn most_of(folder: &TempDir, arguments: &[&str]) -> usize {
    let mut process = command(folder.path(), arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program");
    most(&mut process)
}

/// Holds the program to one thread, and to six when it is asked for six, beside the first one and those that wait for Ctrl-C.
fn hold_to_the_number_asked_for(folder: &TempDir, arguments: &[&str]) {
    let most = |threads: &str| most_of(folder, &[arguments, &["--threads", threads]].concat());
    let one = most("1");
    assert!(one <= 4, "{one}");
    // On a busy machine it may be over before all that it starts are seen.
    assert!((0..20).any(|_| most("6") >= 6));
}

#[test]
fn no_more_than_were_asked_for_prepare_objects_and_render() {
    let folder = TempDir::new().expect("a folder");
    let mut text = String::from(
        "image { width 640 height 360 } camera { eye (0, 0, 5) direction (0, 0, -1) }\n",
    );
    for index in 0..30_000 {
        let (x, y) = (index % 173, index / 173);
        let _ = writeln!(
            text,
            "sphere {{ center ({x}, {y}, -9.5) radius 0.25 color olive }}"
        );
    }
    fs::write(folder.path().join("a.scn"), text).expect("a scene");
    hold_to_the_number_asked_for(&folder, &["render", "a.scn"]);
}

#[test]
#[ignore = "exhaustive"]
fn no_more_than_were_asked_for_look_for_a_mistake() {
    let folder = TempDir::new().expect("a folder");
    let scene = |roll: f64| {
        format!(
            "image {{ width 320 height 180 }}
             camera {{ eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll {roll}deg d 2.75 }}
             sampler {{ per_pixel 4 }}
             sphere {{ center (-1.6, 1, 0) color olive }}
             checkerboard {{}}"
        )
    };
    for (name, roll) in [("right.scn", 0.0), ("wrong.scn", 7.0)] {
        fs::write(folder.path().join(name), scene(roll)).expect("a scene");
    }
    most_of(&folder, &["render", "wrong.scn", "-o", "wrong.png"]);
    hold_to_the_number_asked_for(&folder, &["diff", "wrong.png", "right.scn"]);
}
