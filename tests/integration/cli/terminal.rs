//! What reaches a terminal of texts that come from elsewhere.

use std::process::Stdio;

use pinhole::film::{self, Film, Recipe};

use super::{SCENE, folder};
#[cfg(unix)]
use crate::program::Said;

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
    let text = format!("let a = \"{EVIL}\"\n/* {EVIL} */ sphere {{ radius {EVIL} }}\n");
    folder.write("text.scn", text);
    let spaced = format!("sphere  {{ center (0, 1, 0) }} // {EVIL}\n");
    folder.write("spaced.scn", spaced);
    let name = format!("'{}.scn'", EVIL.replace('/', ""));
    for line in [
        "check text.scn",
        "fmt --check text.scn",
        "fmt --check spaced.scn",
        &format!("check a.scn --set 'Ball.radius={EVIL}'"),
        &format!("render a.scn '--crop={EVIL}'"),
        &format!("render {name}"),
        &format!("render a.scn -o '{EVIL}.png/x.png'"),
        &format!("diff {name} a.scn"),
        &format!("explain {name}"),
    ] {
        let said = folder.run(line);
        assert_ne!(said.status, 0, "{line:?}");
        assert_tame(&said.errors, line);
    }
    // Of what a picture carries, too.
    let recipe = Recipe {
        scene: SCENE.to_owned(),
        overrides: vec![format!("Ball.radius={EVIL}")],
        crop: None,
    };
    let film = Film::<[u8; 3]>::new(1, 1).unwrap();
    let mut picture = Vec::new();
    film::write_png(&film, Some(&recipe), &mut picture).unwrap();
    let said = folder.run_reading("check -", picture);
    assert_ne!(said.status, 0);
    assert_tame(&said.errors, "a picture");
}

#[cfg(unix)]
#[test]
fn output_that_nobody_can_take_is_said_and_one_that_nobody_wants_is_not() {
    let folder = folder();
    folder.write("bad.scn", "x y z ".repeat(5000));
    for (line, status) in [
        ("--help", 0),
        ("--version", 0),
        ("man", 0),
        ("explain bare_angle", 0),
        ("render a.scn -o -", 0),
        ("check bad.scn --format json", 1),
    ] {
        let to = |output: Stdio| {
            let output = folder.command(line).stdout(output).output().unwrap();
            Said::from(output)
        };
        let full = std::fs::File::options().write(true).open("/dev/full");
        let said = to(full.unwrap().into());
        assert_eq!(said.status, 2, "{line}");
        assert!(said.errors.contains("cannot write to standard output"));
        // As `head` does.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let said = to(writer.into());
        assert_eq!((said.status, said.errors.as_str()), (status, ""), "{line}");
    }
}
