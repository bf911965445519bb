//! Tests with special files, such as pipes, at the paths that a command reads or writes. The
//! command refuses them at once, with a message of one line, and changes no other file.

use std::{
    fs,
    io::Write,
    os::unix::{ffi::OsStringExt, fs::symlink, net::UnixListener},
    path::Path,
    process::Stdio,
    thread,
    time::{Duration, Instant},
};

use super::{SCENE, folder};
use crate::program::{Folder, Outcome, command};

/// Kinds of special files, each with the error message of a command that reads such a file.
const HOSTILE: [(&str, &str); 9] = [
    ("pipe", "it is a pipe, not a file"),
    ("link to a pipe", "it is a pipe, not a file"),
    ("link to a device", "it is a device, not a file"),
    ("link to a full device", "it is a device, not a file"),
    ("socket", "it is a socket, not a file"),
    ("folder", "it is a folder, not a file"),
    ("dangling link", "there is no such file or folder"),
    ("loop of links", "symbolic links"),
    ("nothing", "there is no such file or folder"),
];

/// Creates a special file of the kind `what`, with the name `name`, in a folder.
fn create_special_file(what: &str, name: &str, folder: &Folder) {
    let path = &folder.path(name);
    match what {
        "pipe" => folder.make_pipe(name),
        "link to a pipe" => {
            folder.make_pipe("elsewhere");
            symlink("elsewhere", path).unwrap();
        }
        "link to a device" => symlink("/dev/zero", path).unwrap(),
        "link to a full device" => symlink("/dev/full", path).unwrap(),
        "socket" => drop(UnixListener::bind(path).unwrap()),
        "folder" => fs::create_dir(path).unwrap(),
        "dangling link" => symlink("no/such/file", path).unwrap(),
        "loop of links" => symlink(path.file_name().unwrap(), path).unwrap(),
        "nothing" => {}
        other => panic!("{other}"),
    }
}

/// Returns the path and kind of every entry below a folder, together with the target of a link or
/// the content of a file.
fn entries(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let found = fs::symlink_metadata(&path).unwrap();
        let name = format!("{path:?} {:?}", found.file_type());
        if found.is_dir() {
            all.extend(entries(&path));
        }
        let content = if found.is_symlink() {
            fs::read_link(&path).unwrap().into_os_string().into_vec()
        } else if found.is_file() {
            fs::read(&path).unwrap()
        } else {
            Vec::new()
        };
        all.push((name, content));
    }
    all.sort();
    all
}

/// Runs a command. Kills it if it has not ended after ten seconds.
#[track_caller]
pub(super) fn run_with_deadline(folder: &Folder, arguments: &[&str]) -> Outcome {
    let mut command = command(folder.path("").as_path(), arguments);
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The command takes at most a second on an idle machine. A busy machine may need more time.
    let end = Instant::now() + Duration::from_secs(10);
    while child.try_wait().unwrap().is_none() {
        if Instant::now() > end {
            child.kill().unwrap();
            panic!("{arguments:?} hangs");
        }
        thread::sleep(Duration::from_millis(5));
    }
    child.wait_with_output().unwrap().into()
}

/// Asserts that a command fails with one line that mentions `about`, and changes no file.
#[track_caller]
fn assert_refused(folder: &Folder, arguments: &[&str], about: &str) {
    let before = entries(&folder.path(""));
    let said = run_with_deadline(folder, arguments);
    let told = (said.status, said.errors.lines().count());
    assert_eq!(told, (2, 1), "{arguments:?}: {}", said.errors);
    assert!(said.output.is_empty(), "{arguments:?}");
    let is_right = said.errors.starts_with("error: ") && said.errors.contains(about);
    assert!(is_right, "{arguments:?}: {}", said.errors);
    assert!(!said.errors.contains("os error"), "{}", said.errors);
    assert_eq!(entries(&folder.path("")), before, "{arguments:?}");
}

#[test]
fn an_output_folder_that_cannot_be_made_is_explained_without_error_numbers() {
    let folder = folder();
    let long = "x".repeat(300);
    for out in ["/proc/pinhole", &long, &format!("{long}/x")] {
        for line in [
            "grade a.scn a.png -o",
            "report a.scn --samples 1 --runs 1 -o",
        ] {
            let arguments: Vec<_> = line.split(' ').chain([out]).collect();
            assert_refused(&folder, &arguments, "cannot write to ");
        }
    }
}

#[test]
fn pipes_devices_sockets_and_folders_are_refused_as_input() {
    for (what, about) in HOSTILE {
        let folder = folder();
        for name in ["x.scn", "x.png"] {
            let _ = fs::remove_file(folder.path("elsewhere"));
            create_special_file(what, name, &folder);
            for line in [
                "render X -o out.png",
                "check X",
                "check X --format json",
                "check --fix X",
                "fmt X",
                "fmt --check X",
                "inspect X",
                "probe X 1 1",
                "report X --samples 1 --runs 1",
                "report X --samples 1 --runs 1 -o a",
                "watch X -o out.png",
                "studio --no-open X",
                "diff X a.scn",
                "diff X a.png -o out.png",
                "diff a.png X",
                "grade X a.png",
            ] {
                let arguments: Vec<_> = line
                    .split(' ')
                    .map(|word| if word == "X" { name } else { word })
                    .collect();
                if line.ends_with("-o a") {
                    fs::create_dir_all(folder.path("a")).unwrap();
                }
                assert_refused(&folder, &arguments, about);
            }
            let before = entries(&folder.path(""));
            let said = run_with_deadline(&folder, &["grade", "a.scn", "a.png", name]);
            if what != "folder" {
                assert_eq!(said.status, 2, "{}", said.errors);
                assert!(said.errors.contains(about), "{}", said.errors);
                assert_eq!(said.errors.lines().count(), 3, "{}", said.errors);
            }
            assert_eq!(entries(&folder.path("")), before, "{what}");
        }
        if what != "nothing" {
            assert_refused(&folder, &["new", "x.scn"], "x.scn: ");
        }
    }
}

#[test]
fn default_and_folder_outputs_never_follow_links_or_special_files() {
    let outside = Folder::with([("secret", "secret"), ("deep/secret", "secret")]);
    for (what, _) in HOSTILE.into_iter().chain([
        ("link to a file outside", ""),
        ("link to a folder outside", ""),
    ]) {
        // If no output is named, the commands `render` and `watch` derive its name from the scene's
        // name.
        let lines = ["render b.scn", "watch b.scn"].map(|line| (line, "b.png"));
        // The commands `grade` and `report` write their files into an output folder.
        let grade = "grade a.scn a.png -o out";
        let report = "report a.scn -o out --samples 1 --runs 1 --methods sobol";
        let both = "report a.scn b.scn -o out --samples 1 --runs 1 --methods sobol";
        let in_folder = [
            (grade, "out/index.html"),
            (grade, "out/grade.csv"),
            (grade, "out/grade.jsonl"),
            (grade, "out/.pinhole"),
            (report, "out/report.json"),
            (report, "out/.pinhole"),
            (both, "out/b"),
            (both, "out/a/index.html"),
            (both, "out/index.html"),
        ];
        for (line, name) in lines.into_iter().chain(in_folder) {
            let folder = folder();
            let path = folder.path(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            match what {
                "link to a file outside" => symlink(outside.path("secret"), &path).unwrap(),
                "link to a folder outside" => symlink(outside.path("deep"), &path).unwrap(),
                _ => create_special_file(what, name, &folder),
            }
            // Two cases are skipped, because the command succeeds in them. In one, nothing exists
            // at the path. In the other, the path is `out/b`, where `report` needs a folder, and
            // there is one.
            if what == "nothing" || (what, name) == ("folder", "out/b") {
                continue;
            }
            let arguments: Vec<_> = line.split(' ').collect();
            assert_refused(&folder, &arguments, name);
        }
    }
    assert_eq!(outside.text("secret"), "secret");
    assert_eq!(outside.text("deep/secret"), "secret");
}

#[test]
fn an_output_path_to_a_special_file_is_refused_without_waiting() {
    for (what, about) in [
        ("pipe", "it is a pipe that nobody reads"),
        ("link to a pipe", "it is a pipe that nobody reads"),
        ("link to a full device", "there is no room left for it"),
        ("socket", "it is a socket, not a file"),
        ("folder", "it is a folder, not a file"),
        ("dangling link", "there is no such file or folder"),
        ("loop of links", "symbolic links"),
    ] {
        let folder = folder();
        folder.told("render b.scn --set Ball.radius=2", 0);
        create_special_file(what, "x.png", &folder);
        assert_refused(&folder, &["render", "a.scn", "-o", "x.png"], about);
        let before = entries(&folder.path(""));
        let said = run_with_deadline(&folder, &["diff", "a.png", "b.png", "-o", "x.png"]);
        assert_eq!(said.status, 2, "{}", said.errors);
        let last = said.errors.lines().last().unwrap();
        let is_right = last.starts_with("error: cannot write to x.png: ") && last.contains(about);
        assert!(is_right, "{}", said.errors);
        assert_eq!(entries(&folder.path("")), before);
        for line in ["grade a.scn a.png -o x.png", "report a.scn -o x.png"] {
            let arguments: Vec<_> = line.split(' ').collect();
            if !["dangling link", "folder"].contains(&what) {
                assert_refused(&folder, &arguments, "x.png: ");
            }
        }
    }
}

#[test]
fn oversized_files_and_pictures_are_refused_unless_large_is_given() {
    let folder = folder();
    let grow = |name: &str, to: u64| {
        let mut options = fs::OpenOptions::new();
        let file = options.append(true).create(true).open(folder.path(name));
        file.unwrap().set_len(to).unwrap();
    };
    fs::copy(folder.path("a.png"), folder.path("large.png")).unwrap();
    grow("large.png", (256 << 20) + 1);
    grow("none.png", 1 << 40);
    grow("none.scn", 1 << 40);
    let black = vec![0; 2500 * 20_000];
    let one_bit = (png::ColorType::Grayscale, png::BitDepth::One);
    let huge = crate::images::png([20_000; 2], one_bit.0, one_bit.1, &black);
    folder.write("huge.png", huge);
    for (name, about) in [
        (
            "large.png",
            "it has more than 268435456 bytes: `--large` reads it",
        ),
        ("none.png", "it is no picture in PNG"),
        ("none.scn", "256 MiB, too much for a scene"),
        (
            "huge.png",
            "more than the 268435456 bytes that are read: `--large` reads it",
        ),
    ] {
        assert_refused_without_comparing(&folder, &["diff", "a.png", name], about);
        if name != "none.scn" {
            assert_refused_without_comparing(&folder, &["diff", name, "a.png"], about);
            let said = run_with_deadline(&folder, &["grade", "a.scn", name]);
            assert!(
                said.status == 2 && said.errors.contains(about),
                "{}",
                said.errors
            );
        }
    }
    let said = run_with_deadline(&folder, &["diff", "--large", "a.png", "large.png"]);
    assert_eq!(said.status, 0, "{}", said.errors);
}

/// Asserts that a command fails with one line that mentions `about`. The files are not compared,
/// because they are too large.
#[track_caller]
fn assert_refused_without_comparing(folder: &Folder, arguments: &[&str], about: &str) {
    let said = run_with_deadline(folder, arguments);
    let told = (said.status, said.errors.lines().count());
    assert_eq!(told, (2, 1), "{arguments:?}: {}", said.errors);
    assert!(
        said.errors.contains(about),
        "{arguments:?}: {}",
        said.errors
    );
}

#[test]
fn standard_input_paths_and_pipes_of_a_shell_are_read() {
    let folder = folder();
    for line in [
        "cat a.scn | pinhole render /dev/stdin -o b.png",
        "cat a.scn | pinhole render /dev/fd/0 -o b.png",
        "cat a.png | pinhole render /dev/fd/0 -o b.png",
        "pinhole render /dev/stdin -o b.png < a.scn",
        "cat a.png | pinhole diff /dev/stdin a.png 2> told && cp a.png b.png",
    ] {
        let said = folder.shell(line);
        assert_eq!((said.status, &*said.errors), (0, ""), "{line}");
        assert!(folder.read("b.png") == folder.read("a.png"), "{line}");
        fs::remove_file(folder.path("b.png")).unwrap();
    }
}

#[test]
fn render_never_overwrites_its_own_input() {
    let folder = folder();
    fs::copy(folder.path("a.png"), folder.path("c.png")).unwrap();
    symlink("c.png", folder.path("d.png")).unwrap();
    let about = "is the scene itself: say with `-o FILE` where the picture goes";
    for line in [
        "render c.png",
        "render c.png -o c.png",
        "render c.png -o d.png",
        "render ./c.png -o c.png --crop 0,0,2,2",
    ] {
        let arguments: Vec<_> = line.split(' ').collect();
        assert_refused(&folder, &arguments, about);
    }
}

/// While a command renders or waits for its input, a link to one of its inputs is created at its
/// output path. The command has already checked this path, so it must check it again before it
/// writes.
#[test]
fn a_link_created_while_rendering_cannot_redirect_output_onto_an_input() {
    for (line, input, target, about) in [
        (
            "render a.scn -o out.png --threads 1 --set image.width=250 --set image.height=250",
            None,
            "a.scn",
            "is the scene itself",
        ),
        (
            "diff /dev/stdin a.png -o out.png",
            Some("a.png"),
            "a.png",
            "is compared",
        ),
        (
            "diff /dev/stdin a.scn -o out.png",
            Some("a.png"),
            "a.scn",
            "is compared",
        ),
    ] {
        let folder = folder();
        // Most pixels show a line of the board, so that rendering takes seconds.
        let slow = format!("{SCENE} checkerboard {{}} sampler {{ method sobol per_pixel 4096 }}");
        folder.write("a.scn", if input.is_none() { &slow } else { SCENE });
        let before = ["a.scn", "a.png"].map(|name| folder.read(name));
        let mut command = folder.command(line);
        let command = command.stdin(Stdio::piped());
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        thread::sleep(Duration::from_millis(300));
        assert!(
            child.try_wait().unwrap().is_none(),
            "{line} is done already"
        );
        symlink(target, folder.path("out.png")).unwrap();
        let mut pipe = child.stdin.take().unwrap();
        if let Some(input) = input {
            pipe.write_all(&folder.read(input)).unwrap();
        }
        drop(pipe);
        let said = Outcome::from(child.wait_with_output().unwrap());
        assert_eq!(said.status, 2, "{line}: {}", said.errors);
        assert!(said.errors.contains(about), "{line}: {}", said.errors);
        assert_eq!(["a.scn", "a.png"].map(|name| folder.read(name)), before);
    }
}
