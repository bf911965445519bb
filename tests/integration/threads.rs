//! Tests of the number of threads that the program starts.

use std::{
    fs,
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use crate::{cancel::spheres, program::Folder};

/// Runs a command to its end. Returns the largest number of threads that was observed. Since it is
/// observed only at intervals, the real maximum may be larger.
fn peak_threads(command: &mut Command) -> usize {
    let command = command.stdout(Stdio::null()).stderr(Stdio::null());
    let mut process = command.spawn().expect("the program");
    let tasks = format!("/proc/{}/task", process.id());
    let mut most = 0;
    while process.try_wait().expect("a status").is_none() {
        most = most.max(fs::read_dir(&tasks).map_or(0, Iterator::count));
        thread::sleep(Duration::from_micros(200));
    }
    most
}

/// Asserts that the program renders with the requested number of threads. With `--threads 1`, up to
/// four threads are allowed in total, because the main thread and threads that wait for Ctrl-C are
/// counted, too. With `--threads 6`, at least six threads must be seen.
fn assert_thread_limit(folder: &Folder, line: &str) {
    let most =
        |threads: u32| peak_threads(&mut folder.command(&format!("{line} --threads {threads}")));
    let one = most(1);
    assert!(one <= 4, "{one}");
    // On a busy machine, the program may end before all its threads are observed, so one success in
    // 20 tries is enough.
    assert!((0..20).any(|_| most(6) >= 6));
}

#[test]
fn rendering_uses_no_more_threads_than_requested() {
    let folder = Folder::with([("a.scn", spheres(30_000).as_str())]);
    assert_thread_limit(
        &folder,
        "render a.scn --set image.width=320 --set image.height=180",
    );
}

#[test]
#[ignore = "exhaustive"]
fn diagnosing_a_picture_uses_no_more_threads_than_requested() {
    let text = "image { width 320 height 180 }
        camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 0deg d 2.75 }
        sampler { per_pixel 4 }
        sphere { center (-1.6, 1, 0) color olive }
        checkerboard {}";
    let folder = Folder::with([("a.scn", text)]);
    folder.done("render a.scn -o wrong.png --set camera.roll=7deg");
    assert_thread_limit(&folder, "diff wrong.png a.scn");
}
