//! `pinhole fmt` from outside: files, standard input, exit status.

use std::{
    fs,
    path::Path,
    process::Command,
    time::{Duration, SystemTime},
};

use tempfile::TempDir;

use crate::program::{command, reading};

const UNTIDY: &str = "let a=1\nsphere {center (a,2,3)} // c\n";
const TIDY: &str = "let a = 1\nsphere { center (a, 2, 3) }  // c\n";
const BROKEN: &str = "let a=1;\nsphere {center (a,2,3)}\n";

/// Runs `pinhole fmt`: its status, standard output and standard error.
fn fmt(folder: &Path, input: &str, arguments: &[&str]) -> (i32, String, String) {
    let arguments = [&["fmt"], arguments].concat();
    let mut command = command(folder, &arguments);
    command.env("NO_COLOR", "1");
    let output = reading(command, input.as_bytes());
    (
        output.status.code().unwrap(),
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    )
}

fn silent(status: i32) -> (i32, String, String) {
    (status, String::new(), String::new())
}

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn read(folder: &TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join(name)).unwrap()
}

#[test]
fn files_are_laid_out_in_place() {
    let folder = folder(&[("a.scn", UNTIDY), ("b.scn", TIDY), ("c.scn", "")]);
    let long_ago = SystemTime::now() - Duration::from_secs(1000);
    let tidy = fs::File::options()
        .write(true)
        .open(folder.path().join("b.scn"))
        .unwrap();
    tidy.set_modified(long_ago).unwrap();
    assert_eq!(
        fmt(folder.path(), "", &["a.scn", "b.scn", "c.scn"]),
        silent(0)
    );
    assert_eq!(read(&folder, "a.scn"), TIDY);
    assert_eq!(read(&folder, "c.scn"), "");
    // What is canonical already is not touched.
    assert_eq!(tidy.metadata().unwrap().modified().unwrap(), long_ago);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
    assert_eq!(fmt(folder.path(), "", &["a.scn", "--check"]), silent(0));
}

#[test]
fn check_prints_a_diff_and_writes_nothing() {
    let folder = folder(&[("a.scn", UNTIDY), ("b.scn", TIDY), ("c.scn", "sphere  {}")]);
    let (status, output, errors) = fmt(folder.path(), "", &["--check", "a.scn", "b.scn", "c.scn"]);
    assert_eq!((status, output.as_str()), (1, ""));
    assert_eq!(
        errors,
        "\
--- a.scn
+++ a.scn, formatted
@@ -1,2 +1,2 @@
-let a=1
-sphere {center (a,2,3)} // c
+let a = 1
+sphere { center (a, 2, 3) }  // c
--- c.scn
+++ c.scn, formatted
@@ -1 +1 @@
-sphere  {}
\\ No newline at end of file
+sphere {}
"
    );
    assert_eq!(read(&folder, "a.scn"), UNTIDY);
}

#[test]
fn check_shows_line_ends_where_they_are_all_that_changes() {
    let text = "let a = 1\r\nlet b = 2\n";
    let (status, _, errors) = fmt(Path::new("."), text, &["--check", "-"]);
    assert_eq!(status, 1);
    assert!(errors.contains("\n-let a = 1␍\n+let a = 1\n"), "{errors}");
    // Where all lines have one, there is nothing to show.
    let text = "let  a = 1\r\nlet b = 2\r\n";
    let (status, _, errors) = fmt(Path::new("."), text, &["--check", "-"]);
    assert_eq!(status, 1);
    assert!(!errors.contains('␍'), "{errors}");
}

/// What is written into a pipe comes back to nobody, and one that nobody writes to is waited for without end.
#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused() {
    let refused = |path: &str| {
        let hint = "fmt takes files, or standard input as `-`";
        let errors = format!("error: {path} is not a file: {hint}\n");
        (2, String::new(), errors)
    };
    for path in ["/dev/stdin", "/dev/null"] {
        assert_eq!(fmt(Path::new("."), UNTIDY, &[path]), refused(path));
        assert_eq!(
            fmt(Path::new("."), UNTIDY, &["--check", path]),
            refused(path)
        );
    }
    let folder = folder(&[]);
    let made = Command::new("mkfifo")
        .arg(folder.path().join("pipe"))
        .status();
    assert!(made.unwrap().success());
    assert_eq!(fmt(folder.path(), "", &["pipe"]), refused("pipe"));
}

#[test]
fn standard_input_goes_to_standard_output() {
    let folder = folder(&[]);
    assert_eq!(
        fmt(folder.path(), UNTIDY, &["-"]),
        (0, TIDY.to_owned(), String::new())
    );
    assert_eq!(
        fmt(folder.path(), TIDY, &["-"]),
        (0, TIDY.to_owned(), String::new())
    );
    assert_eq!(fmt(folder.path(), TIDY, &["-", "--check"]), silent(0));
    let (status, output, errors) = fmt(folder.path(), UNTIDY, &["-", "--check"]);
    assert_eq!((status, output.as_str()), (1, ""));
    assert!(errors.starts_with("--- -\n+++ -, formatted\n"), "{errors}");
    let (status, output, errors) = fmt(folder.path(), BROKEN, &["-"]);
    assert_eq!((status, output.as_str()), (1, ""));
    assert!(errors.contains("pinhole::needless_separator"), "{errors}");
    let (status, _, errors) = fmt(folder.path(), "", &["-", "-"]);
    assert_eq!(status, 2, "{errors}");
}

#[test]
fn a_broken_file_stays_and_the_others_are_laid_out() {
    let folder = folder(&[("a.scn", BROKEN), ("b.scn", UNTIDY), ("c.scn", UNTIDY)]);
    let (status, output, errors) = fmt(folder.path(), "", &["a.scn", "b.scn"]);
    assert_eq!((status, output.as_str()), (1, ""));
    assert!(errors.contains("pinhole::needless_separator") && errors.contains("\n1 error\n"));
    assert_eq!(read(&folder, "a.scn"), BROKEN);
    assert_eq!(read(&folder, "b.scn"), TIDY);
    let (status, _, errors) = fmt(folder.path(), "", &["none.scn", "a.scn", "c.scn"]);
    assert_eq!(status, 2);
    assert!(errors.contains("cannot read none.scn"), "{errors}");
    assert_eq!(read(&folder, "c.scn"), TIDY);
    // Errors of meaning do not hinder.
    fs::write(folder.path().join("d.scn"), "sphere{radus b}").unwrap();
    assert_eq!(fmt(folder.path(), "", &["d.scn"]), silent(0));
    assert_eq!(read(&folder, "d.scn"), "sphere { radus b }\n");
}

#[test]
fn pictures_are_refused() {
    let folder = folder(&[("a.scn", "camera { eye (0, 1, 5) lookat (0, 1, 0) }")]);
    let picture = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/figure_9_9.png");
    fs::copy(&picture, folder.path().join("a.png")).unwrap();
    assert_eq!(
        fmt(folder.path(), "", &["a.png"]),
        (
            2,
            String::new(),
            "error: a.png is a picture; fmt takes the scene's text\n".to_owned()
        )
    );
    assert_eq!(
        fs::read(picture).unwrap(),
        fs::read(folder.path().join("a.png")).unwrap()
    );
    let (status, _, errors) = fmt(folder.path(), "", &["a.scn", "--set", "h=1"]);
    assert_eq!(status, 2, "{errors}");
    assert_eq!(fmt(folder.path(), "", &[]).0, 2);
}

#[cfg(unix)]
#[test]
fn the_owner_stays_and_nothing_runs_as_him() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};

    let folder = folder(&[("a.scn", UNTIDY)]);
    let file = folder.path().join("a.scn");
    // Only root may do that; to everybody else the file stays his own.
    let _ = chown(&file, Some(1234), Some(1234));
    fs::set_permissions(&file, fs::Permissions::from_mode(0o4755)).unwrap();
    let before = fs::metadata(&file).unwrap();
    assert_eq!(fmt(folder.path(), "", &["a.scn"]), silent(0));
    let after = fs::metadata(&file).unwrap();
    assert_eq!((after.uid(), after.gid()), (before.uid(), before.gid()));
    assert_eq!(after.mode() & 0o7777, 0o755);
    assert_eq!(read(&folder, "a.scn"), TIDY);
}
