//! The binary from outside: arguments, files, output and exit status.

mod render;
mod terminal;

use std::{
    fs,
    process::{Output, Stdio},
};

use pinhole::film;
use serde_json::Value;
use tempfile::TempDir;

#[cfg(unix)]
use crate::interrupt::interrupted;
use crate::program::{self, command};
use crate::table::{list, rows};

/// A small scene that sees something of everything.
const SCENE: &str = "\u{feff}// A ball on a floor.\r
let h = 1
image { width 64 height 36 }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sampler { method sobol per_pixel 4 seed 7 }
sphere Ball { center (-1.6, h, 0) }
checkerboard {}
";

/// A fresh folder with the scene in `a.scn`.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.scn"), SCENE).unwrap();
    folder
}

fn pinhole(folder: &TempDir, arguments: &[&str]) -> Output {
    command(folder.path(), arguments).output().unwrap()
}

/// With something on standard input.
fn pinhole_reading(folder: &TempDir, input: &[u8], arguments: &[&str]) -> Output {
    program::reading(command(folder.path(), arguments), input)
}

fn status(output: &Output) -> i32 {
    output.status.code().expect("the process was not killed")
}

fn errors(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Runs the binary, which has to be done without a word.
fn done(folder: &TempDir, arguments: &[&str]) -> Vec<u8> {
    let output = pinhole(folder, arguments);
    assert_eq!((status(&output), errors(&output)), (0, String::new()));
    output.stdout
}

/// Runs the binary, which has to fail with this status and nothing on standard output.
fn fails(folder: &TempDir, arguments: &[&str], expected: i32) -> String {
    let output = pinhole(folder, arguments);
    let errors = errors(&output);
    assert_eq!(status(&output), expected, "{arguments:?}: {errors}");
    assert_eq!(output.stdout, b"", "{arguments:?}");
    errors
}

fn names(folder: &TempDir) -> Vec<String> {
    program::names(folder.path())
}

fn read(folder: &TempDir, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap()
}

fn size(picture: &[u8]) -> (u32, u32) {
    let film = film::read_picture(picture).unwrap().film;
    (film.width(), film.height())
}

#[test]
fn a_scene_with_errors_is_status_1_and_trouble_with_files_2() {
    let folder = folder();
    fs::write(folder.path().join("bad.scn"), "sphere { radus 2 }").unwrap();
    fs::write(folder.path().join("latin.scn"), b"// \xe9\n").unwrap();
    fs::write(folder.path().join("old.png"), b"old").unwrap();

    let errors = fails(&folder, &["render", "bad.scn", "-o", "old.png"], 1);
    assert!(errors.contains("error[pinhole::unknown_field]"), "{errors}");
    assert_eq!(read(&folder, "old.png"), b"old");
    fails(&folder, &["render", "latin.scn"], 1);
    fails(&folder, &["render", "a.scn", "--set", "Bal.radius=2"], 1);

    let table = "
        none.scn -> cannot read none.scn: No such file or directory (os error 2)
        . -> cannot read .: Is a directory (os error 21)
        a.scn -o no/b.png -> cannot write to no/b.png: No such file or directory (os error 2)
    ";
    for [arguments, error] in rows(table) {
        let arguments: Vec<&str> = ["render"].into_iter().chain(arguments.split(' ')).collect();
        assert_eq!(fails(&folder, &arguments, 2), format!("error: {error}\n"));
    }
    // Trouble with the file outweighs errors of the scene; both are told.
    let errors = fails(&folder, &["render", "bad.scn", "-o", "no/b.png"], 2);
    assert!(errors.contains("error[pinhole::unknown_field]"), "{errors}");
    assert!(
        errors
            .ends_with("error: cannot write to no/b.png: No such file or directory (os error 2)\n")
    );
    let errors = fails(&folder, &["check", "bad.scn", "none.scn", "a.scn"], 2);
    assert!(errors.contains("error[pinhole::unknown_field]"), "{errors}");
    assert_eq!(names(&folder), ["a.scn", "bad.scn", "latin.scn", "old.png"]);
}

#[test]
fn pictures_without_a_scene_are_trouble() {
    let folder = folder();
    image::DynamicImage::new_rgb8(4, 4)
        .save(folder.path().join("foreign.png"))
        .unwrap();
    assert_eq!(
        fails(&folder, &["render", "foreign.png", "-o", "b.png"], 2),
        "error: cannot read foreign.png: the picture carries no scene: another program wrote it, or its scene had more than 1 MiB of text\n"
    );
    for rest in [&b""[..], b"0123456789abcdef"] {
        let cut = [b"\x89PNG\r\n\x1a\n", rest].concat();
        fs::write(folder.path().join("cut.png"), cut).unwrap();
        assert_eq!(
            fails(&folder, &["check", "cut.png"], 2),
            "error: cannot read cut.png: it begins as a PNG does, but is damaged or no picture\n"
        );
    }
}

#[test]
fn standard_input_is_read_once() {
    let output = pinhole_reading(&folder(), SCENE.as_bytes(), &["check", "-", "-"]);
    assert_eq!(status(&output), 2);
    assert_eq!(
        errors(&output),
        "error: standard input can be read once only, and `-` is given twice\n"
    );
}

#[test]
fn check_reports_to_people_or_to_programs() {
    let folder = folder();
    fs::write(folder.path().join("bad.scn"), "sphere { radus 2 }").unwrap();
    assert_eq!(done(&folder, &["check", "a.scn"]), b"");
    assert_eq!(done(&folder, &["check", "a.scn", "--format", "json"]), b"");
    fails(&folder, &["check", "bad.scn"], 1);
    let output = pinhole(&folder, &["check", "a.scn", "bad.scn", "--format", "json"]);
    assert_eq!((status(&output), errors(&output)), (1, String::new()));
    for line in String::from_utf8(output.stdout).unwrap().lines() {
        let problem: Value = serde_json::from_str(line).unwrap();
        assert_eq!(problem["file"], "bad.scn");
    }
    let output = pinhole_reading(&folder, b"nonsense", &["check", "-", "--format=json"]);
    assert_eq!(status(&output), 1);
    assert!(output.stdout.starts_with(b"{\"file\":\"-\","));
}

#[test]
fn check_fixes_what_it_can_and_says_so() {
    let folder = folder();
    let path = folder.path().join("bad.scn");
    let wrong = "camera { eye (0, 1, 8)  look_at (0, 1, 0)  roll 10 }\nspere { centr (0, 1, 0)  radus 2  colour oliv }\n";
    let right = "camera { eye (0, 1, 8)  lookat (0, 1, 0)  roll 10deg }\nsphere { center (0, 1, 0)  radius 2  color olive }\n";
    fs::write(&path, wrong).unwrap();
    let output = pinhole(&folder, &["check", "--fix", "bad.scn"]);
    assert_eq!((status(&output), output.stdout.as_slice()), (0, &b""[..]));
    assert_eq!(fs::read_to_string(&path).unwrap(), right);
    let said = errors(&output);
    assert!(said.contains("bad.scn:1:25: write `lookat`\n"), "{said}");
    assert_eq!(said.lines().count(), 7, "{said}");
    // From standard input to standard output, changed or not.
    for text in [wrong, right] {
        let output = pinhole_reading(&folder, text.as_bytes(), &["check", "--fix", "-"]);
        assert_eq!(status(&output), 0);
        assert_eq!(String::from_utf8(output.stdout).unwrap(), right);
    }
    // What has no fix stays, and is reported; what is no scene's text is refused.
    fs::write(
        &path,
        "camera { eye (0, 1, 8)  look_at (0, 1, 0) }\nsphere { center (0, 1, 0)  shininess 3 }\n",
    )
    .unwrap();
    let output = pinhole(&folder, &["check", "--fix", "bad.scn", "--format", "json"]);
    assert_eq!(status(&output), 1);
    assert!(errors(&output).ends_with("write `lookat`\n"));
    let left = String::from_utf8(output.stdout).unwrap();
    assert_eq!(left.lines().count(), 1, "{left}");
    assert!(fs::read_to_string(&path).unwrap().contains("lookat"));
    done(&folder, &["render", "a.scn"]);
    fails(&folder, &["check", "--fix", "a.png"], 2);
    fs::write(&path, b"// \xff\nsphere { centr (0, 1, 0) }\n").unwrap();
    fails(&folder, &["check", "--fix", "bad.scn"], 1);
    assert_eq!(
        fs::read(&path).unwrap(),
        b"// \xff\nsphere { centr (0, 1, 0) }\n"
    );
}

#[test]
fn a_program_is_told_of_a_thousand_problems_and_how_many_more_there_are() {
    let many = "sphere { center (0, 1, 0) radus 1 }\n".repeat(1234);
    let many = format!("{SCENE}{many}");
    let output = pinhole_reading(
        &folder(),
        many.as_bytes(),
        &["check", "-", "--format", "json"],
    );
    assert_eq!(status(&output), 1);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().count(), 1001);
    let last: Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();
    assert_eq!(
        [&last["code"], &last["severity"]],
        ["pinhole::more", "error"]
    );
    assert_eq!(last["labels"][0]["line"], 1008);
    let message = last["message"].as_str().unwrap();
    assert!(
        message.starts_with("there are 234 more problems"),
        "{message}"
    );
}

#[test]
fn new_writes_a_scene_and_no_file_twice() {
    let folder = folder();
    assert_eq!(done(&folder, &["new", "new.scn"]), b"");
    assert_eq!(done(&folder, &["check", "new.scn"]), b"");
    let scene = fs::read_to_string(folder.path().join("new.scn")).unwrap();
    assert_eq!(scene, pinhole::scene::SMALLEST);
    assert_eq!(done(&folder, &["fmt", "--check", "new.scn"]), b"");
    let errors = fails(&folder, &["new", "a.scn"], 2);
    assert!(errors.contains("a.scn"), "{errors}");
    assert_eq!(
        fs::read_to_string(folder.path().join("a.scn")).unwrap(),
        SCENE
    );
    fails(&folder, &["new", "no/folder.scn"], 2);
    assert_eq!(done(&folder, &["new", "-"]), scene.as_bytes());
}

#[test]
fn a_label_in_an_override_names_it_as_the_command_line_does() {
    let folder = folder();
    done(&folder, &["render", "a.scn", "-o", "b.png", "--set", "h=2"]);
    for scene in ["a.scn", "b.png"] {
        let sets = ["--set", "h=3", "--set", "Bal.radius=2"];
        let arguments = [&["check", scene, "--format", "json"][..], &sets].concat();
        let output = pinhole(&folder, &arguments);
        assert_eq!(status(&output), 1);
        let problem: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(problem["file"], scene);
        assert_eq!(problem["labels"][0]["file"], "--set #2");
    }
}

/// Runs the binary, which has to print one line of JSON and nothing else.
fn json(folder: &TempDir, arguments: &[&str]) -> Value {
    let text = String::from_utf8(done(folder, arguments)).unwrap();
    assert!(text.ends_with('\n') && text.lines().count() == 1, "{text}");
    serde_json::from_str(&text).unwrap()
}

#[test]
fn inspect_says_what_a_scene_means() {
    let folder = folder();
    let arguments = [
        "inspect",
        "a.scn",
        "--format",
        "json",
        "--set",
        "camera.d=3",
    ];
    let found = json(&folder, &arguments);
    assert_eq!(found["camera"]["d"], 3.0);
    assert_eq!(found["objects"][0]["line"], 6);
    let output = pinhole(&folder, &["inspect", "a.scn"]);
    assert_eq!((status(&output), output.stdout), (0, Vec::new()));
    assert!(!output.stderr.is_empty());
}

#[test]
fn probe_follows_a_ray_anywhere() {
    let folder = folder();
    let at = |x, y| json(&folder, &["probe", "a.scn", x, y, "--format", "json"]);
    let found = at("32", "18");
    assert_eq!(found["pixel"], serde_json::json!([32.0, 18.0]));
    assert_eq!(found["hits"][0]["kind"], "checkerboard");
    for place in "-10 0.5, -.5 -1e3, 1e300 -1e300, -1.5e-7 +4, 0 -0".split(", ") {
        let (x, y) = place.split_once(' ').unwrap();
        assert_eq!(at(x, y)["pixel"][0], x.parse::<f64>().unwrap());
    }
    let output = pinhole(&folder, &["probe", "a.scn", "1", "2"]);
    assert_eq!((status(&output), output.stdout), (0, Vec::new()));
    assert!(!output.stderr.is_empty());
}

#[test]
fn answers_about_a_scene_with_errors_are_nothing_but_the_errors() {
    let folder = folder();
    fs::write(folder.path().join("bad.scn"), "sphere { radus 2 }").unwrap();
    for arguments in [
        &["inspect", "bad.scn", "--format", "json"][..],
        &["probe", "bad.scn", "1", "2", "--format", "json"],
    ] {
        let errors = fails(&folder, arguments, 1);
        assert!(errors.contains("error[pinhole::unknown_field]"), "{errors}");
    }
}

#[test]
fn wrong_usage_is_status_2() {
    let folder = folder();
    fails(&folder, &[], 2);
    let table = "
        rendr a.scn
        render
        render a.scn b.scn
        render a.scn --set
        check
        check a.scn --format xml
        probe a.scn 1
        probe a.scn 1 nan
        probe a.scn 1 inf
        report
        report a.scn --numerics
        report --inputs 5
        report --numerics --inputs 0
    ";
    for arguments in list(table) {
        let arguments: Vec<&str> = arguments.split(' ').collect();
        assert!(!fails(&folder, &arguments, 2).is_empty());
    }
}

#[test]
fn help_has_examples_and_the_manual_all_commands() {
    let folder = folder();
    let commands = "render check new explain inspect probe diff grade report completions man";
    for command in commands.split(' ') {
        let help = String::from_utf8(done(&folder, &[command, "--help"])).unwrap();
        assert!(
            help.contains(&format!("Examples:\n  pinhole {command}")),
            "{help}"
        );
    }
    let help = String::from_utf8(done(&folder, &["--help"])).unwrap();
    assert!(help.contains("Examples:\n"));
    let version = done(&folder, &["--version"]);
    assert_eq!(
        version,
        concat!("pinhole ", env!("CARGO_PKG_VERSION"), "\n").as_bytes()
    );
    let manual = String::from_utf8(done(&folder, &["man"])).unwrap();
    for command in ["RENDER", "CHECK", "INSPECT", "PROBE", "DIFF", "REPORT"] {
        assert!(manual.contains(&format!(".SH \"PINHOLE {command}\"")));
    }
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = String::from_utf8(done(&folder, &["completions", shell])).unwrap();
        assert!(script.contains("inspect"));
    }
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_panic() {
    let folder = folder();
    fs::write(folder.path().join("bad.scn"), "x y z ".repeat(5000)).unwrap();
    for arguments in [
        &["check", "bad.scn", "--format", "json"][..],
        &["render", "a.scn", "-o", "-"],
        &["man"],
        &["--help"],
    ] {
        let mut child = command(folder.path(), arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(!errors(&output).contains("panicked"), "{arguments:?}");
        assert!(output.status.code().is_some(), "{arguments:?} was killed");
    }
}

#[test]
fn report_counts_wrong_decisions_for_people_and_programs() {
    let folder = folder();
    let arguments = ["report", "--numerics", "--inputs", "20"];
    let output = pinhole(&folder, &arguments);
    assert!(output.status.success() && output.stdout.is_empty());
    let people = errors(&output);
    assert!(people.contains("S1a  rays that nearly touch a sphere"));
    assert!(people.contains("wrong decisions of Pinhole: 0."));
    let arguments = [&arguments[..], &["--format", "json", "--threads", "1"]].concat();
    let table = json(&folder, &arguments);
    assert_eq!(table["numerics"][0]["inputs"], 20);
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_the_hard_cases_have_shown() {
    let folder = folder();
    let arguments = ["report", "--numerics", "--inputs", "1000000000"];
    let after = 1500;
    let in_json = [&arguments[..], &["--format", "json"]].concat();
    let output = interrupted(&mut command(folder.path(), &in_json), after);
    let table: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(table["complete"], false);
    let cases = table["numerics"].as_array().unwrap();
    let asked = cases[0]["inputs"].as_u64().unwrap();
    assert!((1..1_000_000_000).contains(&asked), "{asked}");

    let output = interrupted(&mut command(folder.path(), &arguments), after);
    let people = errors(&output);
    assert!(people.contains("S1a  rays that nearly touch a sphere"));
    let end = format!(
        "it was interrupted before {}_000_000_000 inputs were asked.\n",
        cases.len()
    );
    assert!(people.ends_with(&end), "{people}");
}
