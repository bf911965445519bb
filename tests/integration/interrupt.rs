//! Ctrl-C as a terminal sends it, and the signal by which a system ends a program.

use std::{
    fs,
    process::{Command, Output, Stdio},
    thread,
    time::{Duration, Instant},
};

use crate::program::{command, names};

/// A command that is interrupted after so many milliseconds: long enough to have begun, and far from long enough to be done. What it says then.
pub fn interrupted(command: &mut Command, after: u64) -> Output {
    let (output, time) = ended_by("INT", command, after);
    assert!(time < Duration::from_secs(5));
    output
}

/// The same by any signal, and how long it took to end.
fn ended_by(signal: &str, command: &mut Command, after: u64) -> (Output, Duration) {
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    thread::sleep(Duration::from_millis(after));
    assert!(
        child.try_wait().unwrap().is_none(),
        "it was over before it was interrupted"
    );
    let killed = Command::new("kill")
        .args([format!("-{signal}"), child.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success());
    let start = Instant::now();
    let output = child.wait_with_output().unwrap();
    let time = start.elapsed();
    assert_eq!(
        output.status.code(),
        Some(130),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    (output, time)
}

/// A picture of one pixel, in which so many spheres are nearly the same that its exact mean takes more than a minute.
pub fn long_pixel() -> String {
    let mut scene = "image { width 1  height 1 }\n\
                     camera { eye (0, 0, 100)  direction (0, 0, -1)  d 1 }\n\
                     sampler { method exact }\n"
        .to_owned();
    for i in 0..150 {
        scene += &format!("sphere {{ center (0, 0, {i}e-9)  radius 20 }}\n");
    }
    scene
}

#[test]
fn one_signal_ends_it_within_a_pixel() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("long.scn"), long_pixel()).unwrap();
    image::RgbImage::new(1, 1)
        .save(folder.path().join("black.png"))
        .unwrap();
    let before = ["black.png", "long.scn"];
    for arguments in [
        &["render", "long.scn", "-o", "long.png"][..],
        &["render", "long.scn", "-o", "long.exr"],
        &["diff", "black.png", "long.scn", "-o", "heat.png"],
        &["report", "long.scn"],
    ] {
        if arguments[0] == "report" && !cfg!(feature = "report") {
            continue;
        }
        for signal in ["INT", "TERM"] {
            let (_, time) = ended_by(signal, &mut command(folder.path(), arguments), 500);
            assert!(
                time < Duration::from_millis(900),
                "{arguments:?} took {time:?} to end"
            );
            assert_eq!(names(folder.path()), before, "{arguments:?}");
        }
    }
}
