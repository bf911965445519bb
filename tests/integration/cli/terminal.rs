//! Tests that untrusted texts reach a terminal without their control characters.

use std::process::Stdio;

use pinhole::film::{self, Film, Recipe};

use super::{SCENE, folder};
#[cfg(unix)]
use crate::program::Outcome;

/// Control characters that would set the terminal's title, colour the text, or reverse its
/// direction.
const CONTROLS: &str = "\x1b]0;pwn\x07 \u{9b}31m \u{202e}txet";

/// Asserts that the message `errors` contains the characters of [`CONTROLS`] only as escapes.
fn assert_escaped(errors: &str, what: &str) {
    assert!(errors.contains("\\u{202e}txet"), "{what}: {errors:?}");
    let is_control = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
    assert!(!errors.contains(is_control), "{what}: {errors:?}");
}

#[test]
fn messages_escape_control_characters_of_texts_names_and_pictures() {
    let folder = folder();
    let text = format!("let a = \"{CONTROLS}\"\n/* {CONTROLS} */ sphere {{ radius {CONTROLS} }}\n");
    folder.write("text.scn", text);
    let spaced = format!("sphere  {{ center (0, 1, 0) }} // {CONTROLS}\n");
    folder.write("spaced.scn", spaced);
    let name = format!("'{}.scn'", CONTROLS.replace('/', ""));
    for line in [
        "check text.scn",
        "fmt --check text.scn",
        "fmt --check spaced.scn",
        &format!("check a.scn --set 'Ball.radius={CONTROLS}'"),
        &format!("render a.scn '--crop={CONTROLS}'"),
        &format!("render {name}"),
        &format!("render a.scn -o '{CONTROLS}.png/x.png'"),
        &format!("diff {name} a.scn"),
        &format!("explain {name}"),
    ] {
        let said = folder.run(line);
        assert_ne!(said.status, 0, "{line:?}");
        assert_escaped(&said.errors, line);
    }
    // A picture file may contain a recipe: the scene and the overrides from which the picture was
    // made. If a message quotes the recipe, control characters must be escaped.
    let recipe = Recipe {
        scene: SCENE.to_owned(),
        overrides: vec![format!("Ball.radius={CONTROLS}")],
        crop: None,
        size: None,
    };
    let film = Film::<[u8; 3]>::new(1, 1).unwrap();
    let mut picture = Vec::new();
    film::write_png(&film, Some(&recipe), &mut picture).unwrap();
    let said = folder.run_reading("check -", picture);
    assert_ne!(said.status, 0);
    assert_escaped(&said.errors, "a picture");
}

#[cfg(unix)]
#[test]
fn a_full_device_is_an_error_and_a_closed_pipe_is_not() {
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
            Outcome::from(output)
        };
        let full = std::fs::File::options().write(true).open("/dev/full");
        let said = to(full.unwrap().into());
        assert_eq!(said.status, 2, "{line}");
        assert!(said.errors.contains("cannot write to standard output"));
        // The reading end of the pipe is closed, as the command `head` closes it when it has read
        // enough. The program must then end without an error message.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let said = to(writer.into());
        assert_eq!((said.status, said.errors.as_str()), (status, ""), "{line}");
    }
}
