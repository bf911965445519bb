//! Tests that untrusted names and texts cannot forge a line of output, a table cell or a
//! spreadsheet formula, and cannot control a terminal.

use std::fs;

use super::{SCENE, folder, hostile::run_with_deadline};
use crate::program::Folder;

/// Runs each command once in a pipe, and once in the terminal that the system's command `script`
/// imitates. If `script` is not installed, the test ends.
#[test]
fn scene_text_is_escaped_on_a_terminal_and_unchanged_in_a_pipe() {
    let hostile = "sphere  {} // \u{1b}]0;x\u{7} \u{9b}2J \u{202e}\n";
    for line in [
        "pinhole check --fix --diff - < a.scn",
        "pinhole check --fix - < a.scn",
        "pinhole check --fix --diff a.scn",
        "pinhole fmt - < a.scn",
    ] {
        let folder = Folder::with([("a.scn", &*format!("sphere {{ radus 1 }} {hostile}"))]);
        let piped = folder.shell(&format!("{line} | cat"));
        assert!(piped.text().contains("\u{1b}]0;x\u{7} \u{9b}2J"), "{line}");
        let quoted = line.replace("pinhole", env!("CARGO_BIN_EXE_pinhole"));
        let script = format!("script -qec '{quoted} 2> errors' typescript < /dev/null");
        let shown = folder.shell(&script);
        if shown.status == 127 {
            return;
        }
        let shown = String::from_utf8(shown.output).unwrap();
        assert!(
            shown.contains("\\u{1b}]0;x\\u{7} \\u{9b}2J \\u{202e}"),
            "{line}: {shown:?}"
        );
        assert!(
            !shown.contains(['\u{1b}', '\u{9b}', '\u{202e}']),
            "{line}: {shown:?}"
        );
    }
}

#[test]
fn file_names_cannot_forge_lines_or_table_cells() {
    let names = [
        "a\nerror: b",
        "a\tb",
        "a\r\x1b[2Kb",
        "\u{202e}gnp.a",
        "a\u{2028}b",
        "a\u{200b}\u{200d}\u{2060}b\u{feff}\u{ad}\u{e0041}",
        "=cmd|' /C calc'!A0",
        "+1",
        "@a",
        "-a",
    ];
    let forged = [
        '\t',
        '\r',
        '\x1b',
        '\u{202e}',
        '\u{2028}',
        '\u{200b}',
        '\u{200d}',
        '\u{2060}',
        '\u{feff}',
        '\u{ad}',
        '\u{e0041}',
    ];
    for name in names {
        let folder = folder();
        let [scene, picture, other] =
            ["scn", "png", "none.png"].map(|ending| format!("./{name}.{ending}"));
        let dashed = name.replace('-', "m");
        folder.write(&scene, SCENE);
        folder.write(&picture, folder.read("a.png"));
        let calls: &[&[&str]] = &[
            &["check", &other],
            &["check", "--fix", &other],
            &["render", &other, "-o", "b.png"],
            &["render", &scene, "-o", &other, "--crop", "9,9,9,9"],
            &["render", &scene, "-o", "no/b.png"],
            &["render", &scene, "-o", &scene],
            &["new", &scene],
            &["fmt", &other],
            &["inspect", &other],
            &["probe", &other, "1", "1"],
            &["watch", &other],
            &["studio", "--no-open", &other],
            &["diff", &other, &picture],
            &["diff", &picture, &other],
            &["diff", &picture, &picture, "-o", &other, "--set", "a=1"],
            &["grade", &other, &picture],
            &["grade", &scene, &picture, "-o", &scene],
            &["report", &other],
            &["report", &scene, "-o", &scene],
            &["explain", &dashed],
        ];
        for arguments in calls {
            let said = run_with_deadline(&folder, arguments);
            assert_eq!(said.status, 2, "{arguments:?}: {}", said.errors);
            assert_eq!(said.errors.lines().count(), 1, "{:?}", said.errors);
            assert!(!said.errors.contains(forged), "{:?}", said.errors);
        }
        // If a name could forge a line, the message would have an additional line.
        for arguments in [
            &["rendr", name][..],
            &["render", "a.scn", name],
            &["render", "a.scn", "--crop", name],
            &["check", "a.scn", "--format", name],
        ] {
            let plain: Vec<_> = arguments
                .iter()
                .map(|argument| if *argument == name { "x" } else { argument })
                .collect();
            let [said, plain] =
                [arguments, &plain].map(|line| run_with_deadline(&folder, line).errors);
            assert!(!said.contains(forged), "{said:?}");
            let lines = [&said, &plain].map(|text| text.lines().count());
            if name != "-a" {
                assert_eq!(lines[0], lines[1], "{said:?}");
            }
        }
        let bad = format!("./{name}.bad.scn");
        folder.write(&bad, "sphere { radus 1 }");
        for arguments in [
            &["check", &*bad][..],
            &["check", "--fix", &bad],
            &["fmt", "--check", &bad],
        ] {
            let said = run_with_deadline(&folder, arguments);
            assert!(!said.errors.contains(forged), "{:?}", said.errors);
            assert!(!said.errors.contains("\nerror: b"), "{:?}", said.errors);
        }
        // File names also appear in the tables and pages of `diff`, `grade` and `report`, so these
        // outputs are tested, too.
        let said = run_with_deadline(&folder, &["diff", &picture, "a.scn"]);
        assert!(!said.errors.contains("\nerror: b"), "{:?}", said.errors);
        let said = run_with_deadline(&folder, &["grade", &scene, &picture, &other, "-o", "out"]);
        assert_eq!(said.status, 2, "{}", said.errors);
        assert_eq!(said.errors.lines().count(), 3, "{:?}", said.errors);
        let told = ["out/index.html", "out/grade.csv"].map(|file| folder.text(file));
        let report = "--samples 1 --runs 1 --methods sobol -o out".split(' ');
        let arguments: Vec<_> = ["report", &scene].into_iter().chain(report).collect();
        fs::remove_dir_all(folder.path("out")).unwrap();
        let said = run_with_deadline(&folder, &arguments);
        assert_eq!(said.status, 0, "{}", said.errors);
        let page = folder.text("out/index.html");
        let csv = folder.text("out/report.csv");
        for text in [&said.errors, &told[0], &told[1], &page, &csv] {
            assert!(!text.contains(forged), "{text:?}");
            assert!(!text.contains("\nerror: b"), "{text:?}");
        }
    }
}

#[test]
fn csv_cells_never_start_a_spreadsheet_formula() {
    for start in ["=1+1", "+1", "-1", "@a", "\ta", "\ra", "'a", "a"] {
        let folder = folder();
        let name = format!("{start}.png");
        folder.write(&name, folder.read("a.png"));
        let arguments = ["grade", "a.scn", "-o", "out", "--", &name];
        assert_eq!(run_with_deadline(&folder, &arguments).status, 0);
        let csv = folder.text("out/grade.csv");
        let (_, row) = csv.trim_end().split_once('\n').unwrap();
        let is_guarded = row.starts_with("\"'");
        assert_eq!(is_guarded, start != "a", "{row}");
        let mut table = csv::Reader::from_reader(csv.as_bytes());
        let cells = table.records().next().unwrap().unwrap();
        assert!(cells[2].parse::<f64>().is_ok(), "{row}");
        // The first column has the name of the file, and the seventh the name of the student. The
        // student's name is taken from the file's name, so the cells are equal.
        assert_eq!(cells[0], cells[6], "{row}");
    }
}
