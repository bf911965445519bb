//! Tests of interrupting the program: Ctrl-C as a terminal sends it (SIGINT), and the signal that
//! asks a program to end (SIGTERM).

use std::{
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use crate::program::{Folder, Outcome};

/// Runs a command and interrupts it after `after` milliseconds. The caller chooses this time such
/// that the command has begun but is not nearly finished. Asserts that it ends within five seconds
/// of the interruption. Returns its output.
pub fn interrupted(command: &mut Command, after: u64) -> Outcome {
    let (said, time) = end_with_signal("INT", command, after);
    assert!(time < Duration::from_secs(5));
    said
}

/// Sends a signal, such as `INT`, to a process.
pub fn send_signal(signal: &str, child: &Child) {
    let mut kill = Command::new("kill");
    let sent = kill.args([format!("-{signal}"), child.id().to_string()]);
    assert!(sent.status().unwrap().success());
}

/// Runs a command and sends it a signal after `after` milliseconds. Returns its output, and the
/// time from the signal to the end of the command.
fn end_with_signal(signal: &str, command: &mut Command, after: u64) -> (Outcome, Duration) {
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    thread::sleep(Duration::from_millis(after));
    assert!(
        child.try_wait().unwrap().is_none(),
        "it was over before it was interrupted"
    );
    send_signal(signal, &child);
    let start = Instant::now();
    let output = child.wait_with_output().unwrap();
    let time = start.elapsed();
    let said = Outcome::from(output);
    assert_eq!(said.status, 130, "{}", said.errors);
    (said, time)
}

/// Returns a scene with a picture of one pixel. It contains so many nearly equal spheres that the
/// exact mean of the pixel takes more than a minute.
pub fn long_pixel() -> String {
    let spheres = (0..150).map(|i| format!("sphere {{ center (0, 0, {i}e-9)  radius 20 }}\n"));
    format!(
        "image {{ width 1  height 1 }} camera {{ eye (0, 0, 100)  direction (0, 0, -1)  d 1 }}
         sampler {{ method exact }}\n{}",
        spheres.collect::<String>()
    )
}

#[test]
fn a_signal_ends_a_command_within_one_pixel() {
    let folder = Folder::with([("long.scn", &*long_pixel())]);
    let black = image::RgbImage::new(1, 1);
    black.save(folder.path("black.png")).unwrap();
    for (signal, line) in [
        ("INT", "render long.scn -o long.png"),
        ("TERM", "render long.scn -o long.exr"),
        (
            "INT",
            "render long.scn --set sampler.method=random --set sampler.per_pixel=9007199254740992",
        ),
        (
            "INT",
            "render long.scn --set sampler.method=random --set sampler.per_pixel=8589934592 --set image.width=1024 --set image.height=1024",
        ),
        ("INT", "diff black.png long.scn -o heat.png"),
        ("INT", "report long.scn"),
    ] {
        let (_, time) = end_with_signal(signal, &mut folder.command(line), 500);
        assert!(time < Duration::from_millis(900), "{line}: {time:?}");
        assert_eq!(folder.names(), ["black.png", "long.scn"], "{line}");
    }
}
