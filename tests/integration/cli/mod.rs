//! The binary from outside: arguments, files, output and exit status.

mod render;
mod terminal;

use pinhole::film;
use serde_json::Value;

#[cfg(unix)]
use crate::interrupt::interrupted;
use crate::program::Folder;

/// A small scene that sees something of everything.
const SCENE: &str = "\u{feff}// A ball on a floor.\r
let h = 1
image { width 64 height 36 }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sampler { method sobol per_pixel 4 seed 7 }
sphere Ball { center (-1.6, h, 0) }
checkerboard {}
";

const BAD: &str = "sphere { radus 2 }";

/// A folder with the scene in `a.scn`.
fn folder() -> Folder {
    Folder::with([("a.scn", SCENE)])
}

pub fn size(picture: &[u8]) -> (u32, u32) {
    let film = film::read_picture(picture).unwrap().film;
    (film.width(), film.height())
}

#[test]
fn a_scene_with_errors_is_status_1_and_trouble_with_files_or_usage_2() {
    let folder = folder();
    folder.write("bad.scn", BAD);
    folder.write("latin.scn", b"// \xe9\n");
    folder.write("old.png", "old");
    folder.write("folder.png/kept", "");
    let foreign = image::DynamicImage::new_rgb8(4, 4);
    foreign.save(folder.path("foreign.png")).unwrap();
    folder.write("cut.png", b"\x89PNG\r\n\x1a\n");
    folder.write("damaged.png", b"\x89PNG\r\n\x1a\n0123456789abcdef");
    folder.write("scene.png", SCENE);
    let names = folder.names();
    folder.tells("
        render bad.scn -o old.png -> 1 -> …error[pinhole::unknown_field]…
        render latin.scn -> 1 -> …pinhole::invalid_utf8…
        render a.scn --set Bal.radius=2 -> 1 -> …pinhole::no_such_target…
        render none.scn -> 2 -> error: cannot read none.scn: No such file or directory (os error 2)
        render . -> 2 -> error: cannot read .: Is a directory (os error 21)
        render a.scn -o no/b.png -> 2 -> error: cannot write to no/b.png: No such file or directory (os error 2)
        render a.scn -o folder.png -> 2 -> error: cannot write to folder.png: is a directory
        -- Trouble with the file outweighs errors of the scene; both are told.
        render bad.scn -o no/b.png -> 2 -> …error[pinhole::unknown_field]…
        render bad.scn -o no/b.png -> 2 -> …error: cannot write to no/b.png: No such file or directory (os error 2)
        check bad.scn none.scn a.scn -> 2 -> …error[pinhole::unknown_field]…
        -- Answers about a scene with errors are nothing but the errors.
        inspect bad.scn --format json -> 1 -> …error[pinhole::unknown_field]…
        probe bad.scn 1 2 --format json -> 1 -> …error[pinhole::unknown_field]…
        -- Pictures without a scene, and a scene that is named as a picture.
        render foreign.png -o b.png -> 2 -> error: cannot read foreign.png: the picture carries no scene: another program wrote it, or its scene had more than 1 MiB of text
        check cut.png -> 2 -> error: cannot read cut.png: it begins as a PNG does, but is damaged or no picture
        check damaged.png -> 2 -> error: cannot read damaged.png: it begins as a PNG does, but is damaged or no picture
        render scene.png -> 2 -> error: scene.png is the scene itself: say with `-o FILE` where the picture goes
        check - - -> 2 -> error: standard input can be read once only, and `-` is given twice
        rendr a.scn -> 2 -> error: …
        render -> 2 -> error: …
        render a.scn b.scn -> 2 -> error: …
        render a.scn --set -> 2 -> error: …
        check -> 2 -> error: …
        check a.scn --format xml -> 2 -> error: …
        probe a.scn 1 -> 2 -> error: …
        probe a.scn 1 nan -> 2 -> error: …
        probe a.scn 1 inf -> 2 -> error: …
        report -> 2 -> error: …
        report a.scn --numerics -> 2 -> error: …
        report --inputs 5 -> 2 -> error: …
        report --numerics --inputs 0 -> 2 -> error: …
    ");
    folder.told("", 2);
    let texts = ["old.png", "scene.png"].map(|name| folder.text(name));
    assert_eq!(texts, ["old", SCENE]);
    assert_eq!(folder.names(), names);
}

#[test]
fn check_reports_to_people_or_to_programs() {
    let folder = folder();
    folder.write("bad.scn", BAD);
    assert_eq!(folder.done("check a.scn").text(), "");
    assert_eq!(folder.done("check a.scn --format json").text(), "");
    folder.told("check bad.scn", 1);
    let said = folder.run("check a.scn bad.scn --format json");
    assert_eq!((said.status, said.errors.as_str()), (1, ""));
    for line in said.text().lines() {
        let problem: Value = serde_json::from_str(line).unwrap();
        assert_eq!(problem["file"], "bad.scn");
    }
    let said = folder.run_reading("check - --format=json", "nonsense");
    assert_eq!(said.status, 1);
    assert!(said.text().starts_with("{\"file\":\"-\","));
}

#[test]
fn check_fixes_what_it_can_and_says_so() {
    let folder = folder();
    let wrong = "camera { eye (0, 1, 8)  look_at (0, 1, 0)  roll 10 }\nspere { centr (0, 1, 0)  radus 2  colour oliv }\n";
    let right = "camera { eye (0, 1, 8)  lookat (0, 1, 0)  roll 10deg }\nsphere { center (0, 1, 0)  radius 2  color olive }\n";
    folder.write("bad.scn", wrong);
    let said = folder.told("check --fix bad.scn", 0);
    assert_eq!(folder.text("bad.scn"), right);
    assert!(said.contains("bad.scn:1:25: write `lookat`\n"), "{said}");
    assert_eq!(said.lines().count(), 7, "{said}");
    // From standard input to standard output, changed or not.
    for text in [wrong, right] {
        let said = folder.run_reading("check --fix -", text);
        assert_eq!((said.status, said.text()), (0, right));
    }
    // What has no fix stays, and is reported; what is no scene's text is refused.
    let text =
        "camera { eye (0, 1, 8)  look_at (0, 1, 0) }\nsphere { center (0, 1, 0)  shininess 3 }\n";
    folder.write("bad.scn", text);
    let said = folder.run("check --fix bad.scn --format json");
    assert_eq!((said.status, said.text().lines().count()), (1, 1));
    assert!(said.errors.ends_with("write `lookat`\n"));
    assert!(folder.text("bad.scn").contains("lookat"));
    folder.done("render a.scn");
    folder.told("check --fix a.png", 2);
    let latin = b"// \xff\nsphere { centr (0, 1, 0) }\n";
    folder.write("bad.scn", latin);
    folder.told("check --fix bad.scn", 1);
    assert_eq!(folder.read("bad.scn"), latin);
}

#[test]
fn a_program_is_told_of_a_thousand_problems_and_how_many_more_there_are() {
    let many = "sphere { center (0, 1, 0) radus 1 }\n".repeat(1234);
    let said = folder().run_reading("check - --format json", format!("{SCENE}{many}"));
    assert_eq!((said.status, said.text().lines().count()), (1, 1001));
    let last: Value = serde_json::from_str(said.text().lines().last().unwrap()).unwrap();
    assert_eq!(last["code"], "pinhole::more");
    assert_eq!(last["severity"], "error");
    assert_eq!(last["labels"][0]["line"], 1008);
    let message = last["message"].as_str().unwrap();
    assert!(message.starts_with("there are 234 more problems"));
}

#[test]
fn new_writes_a_scene_and_no_file_twice() {
    let folder = folder();
    for line in ["new new.scn", "check new.scn", "fmt --check new.scn"] {
        assert_eq!(folder.done(line).text(), "");
    }
    assert_eq!(folder.text("new.scn"), pinhole::scene::SMALLEST);
    assert!(folder.told("new a.scn", 2).contains("a.scn"));
    assert_eq!(folder.text("a.scn"), SCENE);
    folder.told("new no/folder.scn", 2);
    assert_eq!(folder.done("new -").text(), pinhole::scene::SMALLEST);
}

#[test]
fn a_label_in_an_override_names_it_as_the_command_line_does() {
    let folder = folder();
    folder.done("render a.scn -o b.png --set h=2");
    for scene in ["a.scn", "b.png"] {
        let line = format!("check {scene} --format json --set h=3 --set Bal.radius=2");
        let said = folder.run(&line);
        assert_eq!(said.status, 1);
        assert_eq!(said.json()["file"], scene);
        assert_eq!(said.json()["labels"][0]["file"], "--set #2");
    }
}

#[test]
fn inspect_and_probe_say_what_a_scene_means() {
    let folder = folder();
    let found = folder.done("inspect a.scn --format json --set camera.d=3");
    assert_eq!(found.json()["camera"]["d"], 3.0);
    assert_eq!(found.json()["objects"][0]["line"], 6);
    assert!(!folder.told("inspect a.scn", 0).is_empty());
    let at = |place: &str| folder.done(&format!("probe a.scn {place} --format json"));
    let found = at("32 18").json();
    assert_eq!(found["pixel"], serde_json::json!([32.0, 18.0]));
    assert_eq!(found["hits"][0]["kind"], "checkerboard");
    for place in "-10 0.5, -.5 -1e3, 1e300 -1e300, -1.5e-7 +4, 0 -0".split(", ") {
        let (x, _) = place.split_once(' ').unwrap();
        assert_eq!(at(place).json()["pixel"][0], x.parse::<f64>().unwrap());
    }
    assert!(!folder.told("probe a.scn 1 2", 0).is_empty());
}

#[test]
fn help_has_examples_and_the_manual_all_commands() {
    let folder = folder();
    let commands = "render check new explain inspect probe diff grade report completions man";
    for command in commands.split(' ') {
        let help = folder.done(&format!("{command} --help"));
        let examples = format!("Examples:\n  pinhole {command}");
        assert!(help.text().contains(&examples), "{}", help.text());
    }
    assert!(folder.done("--help").text().contains("Examples:\n"));
    let version = concat!("pinhole ", env!("CARGO_PKG_VERSION"), "\n");
    assert_eq!(folder.done("--version").text(), version);
    let manual = folder.done("man");
    for command in ["RENDER", "CHECK", "INSPECT", "PROBE", "DIFF", "REPORT"] {
        let heading = format!(".SH \"PINHOLE {command}\"");
        assert!(manual.text().contains(&heading), "{command}");
    }
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.done(&format!("completions {shell}"));
        assert!(script.text().contains("inspect"));
    }
}

#[test]
fn report_counts_wrong_decisions_for_people_and_programs() {
    let folder = folder();
    let people = folder.told("report --numerics --inputs 20", 0);
    assert!(people.contains("S1a  rays that nearly touch a sphere"));
    assert!(people.contains("wrong decisions of Pinhole: 0."));
    let table = folder.done("report --numerics --inputs 20 --format json --threads 1");
    assert_eq!(table.json()["numerics"][0]["inputs"], 20);
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_the_hard_cases_have_shown() {
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
    let inputs = format!("{}_000_000_000 inputs", cases.len());
    let end = format!("it was interrupted before {inputs} were asked.\n");
    assert!(people.ends_with(&end), "{people}");
}
