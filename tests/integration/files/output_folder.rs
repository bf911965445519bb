//! Tests of output folders: a command replaces a file there only if a command has written it.

use std::fs;

use pinhole::files::OutputFolder;

use super::folder;
use crate::program::{Folder, names};

/// Commands that write into the folder `out`, each with some of the files that it writes there.
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

#[test]
fn own_output_files_are_replaced_and_listed_with_their_hashes() {
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
        // The command writes a removed file again, and does not touch foreign files in the folder.
        fs::remove_file(folder.path(&format!("out/{}", files[0]))).unwrap();
        folder.write("out/other.html", "mine");
        folder.told(command, 0);
        assert_eq!(folder.text("out/other.html"), "mine");
    }
}

#[test]
fn foreign_or_changed_output_files_are_refused_before_anything_is_written() {
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
            // The changed file is huge. The test would take very long if the program read the file
            // to its end.
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
fn concurrent_runs_both_list_their_files() {
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

/// If a command writes every file with the same content as before, it does not write its list of
/// files.
#[cfg(unix)]
#[test]
fn an_unchanged_file_list_is_not_rewritten() {
    use std::os::unix::fs::MetadataExt;

    let folder = Folder::with([]);
    let path = folder.path("out");
    let inode = || fs::metadata(folder.path("out/.pinhole")).unwrap().ino();
    let write = || {
        let mut out = OutputFolder::open(&path, ["a"]).unwrap();
        out.write(&[("a".to_owned(), "text".to_owned())]).unwrap();
    };
    write();
    // The hard link keeps the inode of the old file in use, so a rewritten file would get another
    // inode number.
    fs::hard_link(folder.path("out/.pinhole"), folder.path("first")).unwrap();
    let before = inode();
    write();
    assert_eq!(inode(), before);
}

#[test]
fn an_invalid_file_list_is_refused() {
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
