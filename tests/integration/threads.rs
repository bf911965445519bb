//! How many threads the program starts.

use std::{
    fs,
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use crate::{cancel::spheres, program::Folder};

/// The most threads that a process was seen with until it ended. It may have had more: one looks
/// only now and then.
fn most(command: &mut Command) -> usize {
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

/// Holds the program to one thread, and to six when it is asked for six, beside the first one and
/// those that wait for Ctrl-C.
fn hold_to_the_number_asked_for(folder: &Folder, line: &str) {
    let most = |threads: u32| most(&mut folder.command(&format!("{line} --threads {threads}")));
    let one = most(1);
    assert!(one <= 4, "{one}");
    // On a busy machine it may be over before all that it starts are seen.
    assert!((0..20).any(|_| most(6) >= 6));
}

#[test]
fn no_more_than_were_asked_for_prepare_objects_and_render() {
    let folder = Folder::with([("a.scn", spheres(30_000).as_str())]);
    hold_to_the_number_asked_for(
        &folder,
        "render a.scn --set image.width=320 --set image.height=180",
    );
}

#[test]
#[ignore = "exhaustive"]
fn no_more_than_were_asked_for_look_for_a_mistake() {
    let text = "image { width 320 height 180 }
        camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 0deg d 2.75 }
        sampler { per_pixel 4 }
        sphere { center (-1.6, 1, 0) color olive }
        checkerboard {}";
    let folder = Folder::with([("a.scn", text)]);
    folder.done("render a.scn -o wrong.png --set camera.roll=7deg");
    hold_to_the_number_asked_for(&folder, "diff wrong.png a.scn");
}
