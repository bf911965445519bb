//! What reaches a terminal of texts that come from elsewhere.

use std::fs;

use pinhole::film::{self, Film, Recipe};

use super::{SCENE, errors, folder, pinhole, pinhole_reading, status};
#[cfg(unix)]
use crate::program::command;

/// It would set the window's title, colour the text, and turn it round.
const EVIL: &str = "\x1b]0;pwn\x07 \u{9b}31m \u{202e}txet";

/// The same as it may be shown, as far as it is.
fn assert_tame(errors: &str, what: &str) {
    assert!(errors.contains("\\u{202e}txet"), "{what}: {errors:?}");
    let is_evil = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
    assert!(!errors.contains(is_evil), "{what}: {errors:?}");
}

#[test]
fn nothing_acts_on_it() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    fs::write(
        path("text.scn"),
        format!("let a = \"{EVIL}\"\n/* {EVIL} */ sphere {{ radius {EVIL} }}\n"),
    )
    .unwrap();
    fs::write(
        path("spaced.scn"),
        format!("sphere  {{ center (0, 1, 0) }} // {EVIL}\n"),
    )
    .unwrap();
    let set = format!("Ball.radius={EVIL}");
    let crop = format!("--crop={EVIL}");
    let name = format!("{}.scn", EVIL.replace('/', ""));
    let to = format!("{EVIL}.png/x.png");
    for arguments in [
        vec!["check", "text.scn"],
        vec!["fmt", "--check", "text.scn"],
        vec!["fmt", "--check", "spaced.scn"],
        vec!["check", "a.scn", "--set", &set],
        vec!["render", "a.scn", &crop],
        vec!["render", &name],
        vec!["render", "a.scn", "-o", &to],
        vec!["diff", &name, "a.scn"],
        vec!["explain", &name],
    ] {
        let output = pinhole(&folder, &arguments);
        assert_ne!(status(&output), 0, "{arguments:?}");
        assert_tame(&errors(&output), &format!("{arguments:?}"));
    }
    // Of what a picture carries, too.
    let recipe = Recipe {
        scene: SCENE.to_owned(),
        overrides: vec![set],
        crop: None,
    };
    let film = Film::<[u8; 3]>::new(1, 1).unwrap();
    let mut picture = Vec::new();
    film::write_png(&film, Some(&recipe), &mut picture).unwrap();
    let output = pinhole_reading(&folder, &picture, &["check", "-"]);
    assert_ne!(status(&output), 0);
    assert_tame(&errors(&output), "a picture");
}

#[cfg(unix)]
#[test]
fn output_that_nobody_can_take_is_said_and_one_that_nobody_wants_is_not() {
    let folder = folder();
    for arguments in [["--help", ""], ["--version", ""], ["explain", "bare_angle"]] {
        let arguments: Vec<&str> = arguments
            .into_iter()
            .filter(|word| !word.is_empty())
            .collect();
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let output = command(folder.path(), &arguments)
            .stdout(full)
            .output()
            .unwrap();
        assert_eq!(status(&output), 2, "{arguments:?}");
        assert!(errors(&output).contains("cannot write to standard output"));
        // As `head` does.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = command(folder.path(), &arguments)
            .stdout(writer)
            .output()
            .unwrap();
        assert_eq!(
            (status(&output), errors(&output)),
            (0, String::new()),
            "{arguments:?}"
        );
    }
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let arguments = ["render", "a.scn", "-o", "-"];
    let output = command(folder.path(), &arguments)
        .stdout(writer)
        .output()
        .unwrap();
    assert_eq!((status(&output), errors(&output)), (0, String::new()));
}
