//! Folders in which only what was made there is replaced.

use std::fs;

use pinhole::files::OutputFolder;

use crate::program::{Folder, names};

const SCENE: &str = "image { width 6 height 4 }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sphere Ball { center (-1, 1, 0) }
";

/// The commands that fill a folder `out`, each with the files that it makes there.
const COMMANDS: [(&str, &[&str]); 3] = [
    (
        "grade a.scn a.png -o out",
        &["index.html", "grade.csv", "grade.jsonl"],
    ),
    (
        "report a.scn -o out --samples 1 --runs 1 --methods sobol",
        &["index.html", "report.csv", "error-against-time.svg"],
    ),
    (
        "report a.scn b.scn -o out --samples 1 --runs 1 --methods sobol",
        &["index.html", "b/index.html", "a/report.json"],
    ),
];

fn folder() -> Folder {
    let folder = Folder::with([("a.scn", SCENE), ("b.scn", SCENE)]);
    folder.told("render a.scn", 0);
    folder
}

#[test]
fn what_was_made_is_replaced_and_listed_with_its_hashes() {
    for (command, files) in COMMANDS {
        let folder = folder();
        for _ in 0..2 {
            folder.told(command, 0);
        }
        let list = folder.text("out/.pinhole");
        for file in files {
            assert!(list.contains(&format!("  {file}\n")), "{list}");
        }
        let checked = folder.shell("cd out; sha256sum --check --strict --quiet .pinhole");
        assert_eq!((checked.status, &*checked.errors), (0, ""), "{list}");
        // One that is gone is made again, and what stands beside is left alone.
        fs::remove_file(folder.path(&format!("out/{}", files[0]))).unwrap();
        folder.write("out/other.html", "mine");
        folder.told(command, 0);
        assert_eq!(folder.text("out/other.html"), "mine");
    }
}

#[test]
fn what_somebody_else_made_or_changed_is_refused_before_anything_is_written() {
    for (command, files) in COMMANDS {
        for file in files {
            let folder = folder();
            let path = format!("out/{file}");
            folder.write(&path, "mine");
            let told = folder.told(command, 2);
            let expected = format!("error: cannot write to {path}: pinhole did not make this file");
            assert!(told.starts_with(&expected), "{told}");
            assert_eq!(told.lines().count(), 1, "{told}");
            assert_eq!(folder.text(&path), "mine");
            let there = names(&folder.path("out"));
            assert_eq!(there, [file.split('/').next().unwrap()]);

            fs::remove_dir_all(folder.path("out")).unwrap();
            folder.told(command, 0);
            folder.write(&path, "changed");
            // Nor is it read to its end if it has none.
            let huge = fs::OpenOptions::new().write(true).open(folder.path(&path));
            huge.unwrap().set_len(1 << 40).unwrap();
            assert!(folder.told(command, 2).contains("was changed since"));
            folder.write(&path, "changed");
            let before = fs::read(folder.path("out/.pinhole")).unwrap();
            let told = folder.told(command, 2);
            assert!(told.contains("was changed since pinhole made it"), "{told}");
            assert_eq!(folder.text(&path), "changed");
            assert_eq!(fs::read(folder.path("out/.pinhole")).unwrap(), before);
        }
    }
}

#[test]
fn runs_at_the_same_time_list_what_each_of_them_made() {
    let folder = Folder::with([]);
    let path = folder.path("out");
    let open = |name| OutputFolder::open(&path, [name]).unwrap();
    let mut runs = ["a", "b/c"].map(|name| (name, open(name)));
    for (name, run) in &mut runs {
        let file = (name.to_string(), format!("made as {name}"));
        run.write(&[file]).unwrap();
    }
    let list = folder.text("out/.pinhole");
    assert!(list.contains("  a\n") && list.contains("  b/c\n"), "{list}");
}

/// What is written again as it was has one hash, so nothing in the list changes, and it stays.
#[cfg(unix)]
#[test]
fn a_list_to_which_nothing_is_added_is_not_written() {
    use std::os::unix::fs::MetadataExt;

    let folder = Folder::with([]);
    let path = folder.path("out");
    let inode = || fs::metadata(folder.path("out/.pinhole")).unwrap().ino();
    let write = || {
        let mut out = OutputFolder::open(&path, ["a"]).unwrap();
        out.write(&[("a".to_owned(), "text".to_owned())]).unwrap();
    };
    write();
    // So that no later file gets its number.
    fs::hard_link(folder.path("out/.pinhole"), folder.path("first")).unwrap();
    let before = inode();
    write();
    assert_eq!(inode(), before);
}

#[test]
fn a_list_that_is_none_is_refused() {
    for list in ["", "x", "# Files\n", "\0"] {
        let folder = folder();
        folder.write("out/.pinhole", list);
        for (command, _) in COMMANDS {
            let told = folder.told(command, 2);
            assert!(told.contains("out/.pinhole: it is no list"), "{told}");
        }
        assert_eq!(names(&folder.path("out")), [".pinhole"]);
    }
}
