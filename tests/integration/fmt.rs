//! `pinhole fmt` from outside: files, standard input, exit status.

use std::{
    fs,
    path::Path,
    process::Command,
    time::{Duration, SystemTime},
};

use crate::program::Folder;

const UNTIDY: &str = "let a=1\nsphere {center (a,2,3)} // c\n";
const TIDY: &str = "let a = 1\nsphere { center (a, 2, 3) }  // c\n";
const BROKEN: &str = "let a=1;\nsphere {center (a,2,3)}\n";

/// The status of a command that reads this, its output, and what it tells.
fn piped(folder: &Folder, line: &str, input: &str) -> (i32, String, String) {
    let said = folder.run_reading(line, input);
    (said.status, said.text().to_owned(), said.errors)
}

#[test]
fn files_are_laid_out_in_place() {
    let folder = Folder::with([("a.scn", UNTIDY), ("b.scn", TIDY), ("c.scn", "")]);
    let long_ago = SystemTime::now() - Duration::from_secs(1000);
    let tidy = fs::File::options().write(true).open(folder.path("b.scn"));
    let tidy = tidy.unwrap();
    tidy.set_modified(long_ago).unwrap();
    assert_eq!(folder.done("fmt a.scn b.scn c.scn").text(), "");
    assert_eq!(folder.text("a.scn"), TIDY);
    assert_eq!(folder.text("c.scn"), "");
    // What is canonical already is not touched.
    assert_eq!(tidy.metadata().unwrap().modified().unwrap(), long_ago);
    assert_eq!(folder.names(), ["a.scn", "b.scn", "c.scn"]);
    assert_eq!(folder.done("fmt a.scn --check").text(), "");
}

#[test]
fn check_prints_a_diff_and_writes_nothing() {
    let folder = Folder::with([("a.scn", UNTIDY), ("b.scn", TIDY), ("c.scn", "sphere  {}")]);
    assert_eq!(
        folder.told("fmt --check a.scn b.scn c.scn", 1),
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
    assert_eq!(folder.text("a.scn"), UNTIDY);
    // Line ends are shown where they are all that changes, and not where every line has one.
    for (text, is_shown) in [
        ("let a = 1\r\nlet b = 2\n", true),
        ("let  a = 1\r\nlet b = 2\r\n", false),
    ] {
        let (status, _, errors) = piped(&folder, "fmt --check -", text);
        assert_eq!(status, 1);
        let shown = "\n-let a = 1␍\n+let a = 1\n";
        assert_eq!(errors.contains(shown), is_shown, "{errors}");
        assert_eq!(errors.contains('␍'), is_shown, "{errors}");
    }
}

/// What is written into a pipe comes back to nobody, and one that nobody writes to is waited for without end.
#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused() {
    let folder = Folder::with([("a.scn", "camera { eye (0, 1, 5) lookat (0, 1, 0) }")]);
    let made = Command::new("mkfifo").arg(folder.path("pipe")).status();
    assert!(made.unwrap().success());
    let hint = "is not a file: fmt takes files, or standard input as `-`";
    for path in ["/dev/stdin", "/dev/null", "pipe"] {
        for check in ["", "--check"] {
            let refused = piped(&folder, &format!("fmt {path} {check}"), UNTIDY);
            let errors = format!("error: {path} {hint}\n");
            assert_eq!(refused, (2, String::new(), errors));
        }
    }
    let picture = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/figure_9_9.png");
    fs::copy(&picture, folder.path("a.png")).unwrap();
    folder.tells(
        "
        fmt a.png -> 2 -> error: a.png is a picture; fmt takes the scene's text
        fmt -> 2 -> error: …
        fmt - - -> 2 -> error: …
        fmt a.scn --set h=1 -> 2 -> error: …
    ",
    );
    assert_eq!(fs::read(picture).unwrap(), folder.read("a.png"));
}

#[test]
fn standard_input_goes_to_standard_output() {
    let folder = Folder::with([]);
    for (line, input, status, output, told) in [
        ("fmt -", UNTIDY, 0, TIDY, ""),
        ("fmt -", TIDY, 0, TIDY, ""),
        ("fmt - --check", TIDY, 0, "", ""),
        ("fmt - --check", UNTIDY, 1, "", "--- -\n+++ -, formatted\n"),
        ("fmt -", BROKEN, 1, "", "error[pinhole::needless_separator]"),
    ] {
        let said = piped(&folder, line, input);
        assert_eq!((said.0, said.1.as_str()), (status, output), "{line}");
        assert!(said.2.starts_with(told) && said.2.is_empty() == told.is_empty());
    }
}

#[test]
fn a_broken_file_stays_and_the_others_are_laid_out() {
    let folder = Folder::with([("a.scn", BROKEN), ("b.scn", UNTIDY), ("c.scn", UNTIDY)]);
    folder.tells(
        r"
        fmt a.scn -> 1 -> …pinhole::needless_separator…
        fmt a.scn b.scn -> 1 -> …\n1 error\n…
        fmt none.scn a.scn c.scn -> 2 -> …cannot read none.scn…
    ",
    );
    // Errors of meaning do not hinder.
    folder.write("d.scn", "sphere{radus b}");
    folder.done("fmt d.scn");
    let texts = ["a.scn", "b.scn", "c.scn", "d.scn"].map(|name| folder.text(name));
    assert_eq!(texts, [BROKEN, TIDY, TIDY, "sphere { radus b }\n"]);
}

#[cfg(unix)]
#[test]
fn the_owner_stays_and_nothing_runs_as_him() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};

    let folder = Folder::with([("a.scn", UNTIDY)]);
    let file = folder.path("a.scn");
    // Only root may do that; to everybody else the file stays his own.
    let _ = chown(&file, Some(1234), Some(1234));
    fs::set_permissions(&file, fs::Permissions::from_mode(0o4755)).unwrap();
    let before = fs::metadata(&file).unwrap();
    folder.done("fmt a.scn");
    let after = fs::metadata(&file).unwrap();
    assert_eq!((after.uid(), after.gid()), (before.uid(), before.gid()));
    assert_eq!(after.mode() & 0o7777, 0o755);
    assert_eq!(folder.text("a.scn"), TIDY);
}
