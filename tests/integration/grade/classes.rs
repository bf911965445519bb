//! Tests of grading whole classes, in the form in which Gradescope, GitHub Classroom and Moodle
//! export them. The exports contain unrelated files, too.

use std::{
    fs::File,
    time::{Duration, SystemTime},
};

use serde_json::{Value, json};

use crate::{program::Folder, table::rows};

/// Text of a small scene, so that the mistakes in its pictures are found quickly.
pub const SCENE: &str = "image { width 24 height 16 background navy }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sphere Ball { center (-1, 1, 0) }
box { center (2.2, 0.75, -0.5) }
";

/// Rows: the file name of a picture, and the arguments of `render` that make it.
const PICTURES: &str = "
    right.png -> --set sampler.method=exact
    red.png -> --set sampler.method=exact --set image.background=red
    size.png -> --set sampler.method=exact --set Ball.radius=1.5
    noise.png -> --set sampler.method=random --set sampler.per_pixel=4
";

/// Creates a folder with the scene in `a.scn` and the pictures in [`PICTURES`].
pub fn folder() -> Folder {
    let folder = Folder::with([("a.scn", SCENE)]);
    for [name, arguments] in rows(PICTURES) {
        folder.told(&format!("render a.scn -o {name} {arguments}"), 0);
    }
    folder
}

/// Writes files into a folder. Each is given by its path, and by a text or the name of a picture to
/// copy.
pub fn put(folder: &Folder, files: &[(&str, &str)]) {
    for (path, content) in files {
        if content.ends_with(".png") {
            folder.write(path, folder.read(content))
        } else {
            folder.write(path, content)
        }
    }
}

/// Sets a file's modification time to `hours` hours ago.
fn age(folder: &Folder, path: &str, hours: u64) {
    let file = File::options().write(true).open(folder.path(path)).unwrap();
    let time = SystemTime::now() - Duration::from_secs(3600 * hours);
    file.set_modified(time).unwrap();
}

/// Grades a class with the arguments `arguments`. Returns the JSON object of each student.
pub fn graded(folder: &Folder, arguments: &str, status: i32) -> Vec<Value> {
    let said = folder.run(&format!("grade a.scn {arguments} --format json"));
    assert_eq!(
        (said.status, said.errors.as_str()),
        (status, ""),
        "{arguments}"
    );
    let lines = said.text().lines();
    lines
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

/// Compares the JSON objects of students by the student's name, the file, the verdict, and the
/// files that were not compared.
#[track_caller]
pub fn assert_lines(found: &[Value], expected: &[(&str, &str, &str, &[&str])]) {
    let said = |line: &Value| {
        let verdict = match line.get("error") {
            Some(_) => json!("error"),
            None => line["verdict"].clone(),
        };
        json!([line["student"], line["file"], verdict, line["not_compared"]])
    };
    let wanted = |&(student, file, verdict, others): &(&str, &str, &str, &[&str])| match others {
        [] => json!([student, file, verdict, null]),
        others => json!([student, file, verdict, others]),
    };
    let found: Vec<Value> = found.iter().map(said).collect();
    let expected: Vec<Value> = expected.iter().map(wanted).collect();
    assert_eq!(found, expected);
}

pub const METADATA: &str = "---
submission_1:
  :submitters:
  - :name: Anna Li
    :sid: '1'
  :created_at: 2026-04-26 17:34:00.861687000 Z
submission_2:
  :submitters:
  - :name: Ben <b>
  - :name: Cy
submission_3:
  :submitters:
  - :name: Dora
submission_4:
  :submitters:
  - :email: eve@example.org
";

const LOGO: &str = "starter/logo.png (equal in every folder: --picture chooses it)";

#[test]
fn an_export_of_gradescope_is_a_class() {
    let folder = folder();
    let files = [
        ("export/submission_metadata.yml", METADATA),
        ("export/submission_1/render.png", "right.png"),
        ("export/submission_1/starter/logo.png", "noise.png"),
        ("export/submission_1/main.py", "print()"),
        ("export/submission_2/Render.PNG", "red.png"),
        ("export/submission_2/starter/logo.png", "noise.png"),
        ("export/submission_2/photo.heic", "ftypheic"),
        ("export/submission_2/__MACOSX/._render.png", "junk"),
        ("export/submission_2/.DS_Store", "junk"),
        ("export/submission_2/Thumbs.db", "junk"),
        ("export/submission_3/starter/logo.png", "noise.png"),
    ];
    put(&folder, &files);
    folder.write("export/submission_2/Render.PNG", folder.read("red.png"));
    let expected: [(&str, &str, &str, &[&str]); 4] = [
        (
            "Anna Li",
            "export/submission_1/render.png",
            "right",
            &["main.py", LOGO],
        ),
        (
            "Ben <b>, Cy",
            "export/submission_2/Render.PNG",
            "wrong",
            &["photo.heic", LOGO],
        ),
        // Dora has handed in no picture: `starter/logo.png`, which is in every student's folder,
        // belongs to the assignment's template.
        ("Dora", "export/submission_3", "error", &[LOGO]),
        ("eve@example.org", "export/submission_4", "error", &[]),
    ];
    assert_lines(&graded(&folder, "export", 1), &expected);
    assert_lines(&graded(&folder, "export/", 1), &expected);
}

const GIVEN: &str = "given.png (equal in every folder: --picture chooses it)";

#[test]
fn clones_of_github_classroom_are_a_class() {
    let folder = folder();
    for (student, picture) in [("anna", "right.png"), ("ben", "red.png"), ("cy", "red.png")] {
        for (name, content) in [
            ("render.png", picture),
            ("tries/1.png", "size.png"),
            ("given.png", "noise.png"),
            (".git/HEAD", "ref: refs/heads/main"),
        ] {
            let path = format!("hw1-submissions/hw1-{student}/{name}");
            put(&folder, &[(&path, content)]);
        }
    }
    // Cloning a repository gives its files arbitrary times, so an older file must be graded like a
    // newer one.
    age(&folder, "hw1-submissions/hw1-anna/render.png", 5);
    put(
        &folder,
        &[("hw1-submissions/hw1-ben/tries/2.png", "right.png")],
    );
    put(
        &folder,
        &[("hw1-submissions/hw1-cy/tries/1.png", "red.png")],
    );
    let found = graded(&folder, "hw1-submissions", 1);
    assert_lines(
        &found,
        &[
            (
                "anna",
                "hw1-submissions/hw1-anna/render.png",
                "right",
                &[GIVEN],
            ),
            (
                "ben",
                "hw1-submissions/hw1-ben/tries/2.png",
                "right",
                &[GIVEN],
            ),
            ("cy", "hw1-submissions/hw1-cy/render.png", "wrong", &[GIVEN]),
        ],
    );
    let pictures = |line: &Value| line["pictures"].as_array().unwrap().len();
    assert_eq!(found.iter().map(pictures).collect::<Vec<_>>(), [2, 3, 2]);
    let table = folder.told("grade a.scn hw1-submissions", 1);
    let words = "(tries/2.png, the best of 3 pictures of the same time: --picture chooses)";
    assert!(table.contains(words), "{table}");
    let chosen = graded(&folder, "hw1-submissions --picture render.*", 1);
    assert_lines(
        &chosen,
        &[
            (
                "anna",
                "hw1-submissions/hw1-anna/render.png",
                "right",
                &[GIVEN, "tries/1.png"],
            ),
            (
                "ben",
                "hw1-submissions/hw1-ben/render.png",
                "wrong",
                &[GIVEN, "tries/1.png", "tries/2.png"],
            ),
            (
                "cy",
                "hw1-submissions/hw1-cy/render.png",
                "wrong",
                &[GIVEN, "tries/1.png"],
            ),
        ],
    );
    // The students ben and cy have handed in the same wrong picture.
    let equal: Vec<_> = chosen.iter().map(|line| &line["equal_to"]).collect();
    assert_eq!(equal, [&Value::Null, &json!(["cy"]), &json!(["ben"])]);
}

/// An export of Moodle: names of folders and files, and their contents.
const MOODLE: [(&str, &str); 9] = [
    ("Anna Li_11_assignsubmission_file_render.png", "right.png"),
    ("Ben_12_assignsubmission_file_/out/new.png", "red.png"),
    ("Ben_12_assignsubmission_file_/old.png", "right.png"),
    (
        "Ben_12_assignsubmission_onlinetext_/onlinetext.html",
        "<p>see file",
    ),
    ("Cy_13_assignsubmission_file_a.png", "right.png"),
    ("Cy_13_assignsubmission_file_report.pdf", "%PDF"),
    (
        "=1+1\u{202e}_14_assignsubmission_file_photo.heic",
        "ftypheic",
    ),
    ("Participant_15_assignsubmission_file_cut.png", "cut"),
    (".DS_Store", "junk"),
];

#[test]
fn an_export_of_moodle_is_a_class() {
    let folder = folder();
    let files = MOODLE.map(|(path, content)| (format!("handed in/{path}"), content));
    for (path, content) in &files {
        put(&folder, &[(path, content)]);
    }
    age(
        &folder,
        "handed in/Ben_12_assignsubmission_file_/old.png",
        5,
    );
    let cut = &folder.read("right.png")[..150];
    folder.write(
        "handed in/Participant_15_assignsubmission_file_cut.png",
        cut,
    );
    let found = graded(&folder, "'handed in'", 1);
    let in_folder = |name: &str| format!("handed in/{name}");
    assert_lines(
        &found,
        &[
            (
                "=1+1\u{202e}",
                &in_folder(MOODLE[6].0),
                "error",
                &["photo.heic"],
            ),
            ("Anna Li", &in_folder(MOODLE[0].0), "right", &[]),
            (
                "Ben",
                &in_folder(MOODLE[1].0),
                "wrong",
                &["onlinetext.html", "old.png (an older picture)"],
            ),
            ("Cy", &in_folder(MOODLE[4].0), "right", &["report.pdf"]),
            ("Participant 15", &in_folder(MOODLE[7].0), "error", &[]),
        ],
    );
    let numbers: Vec<_> = found.iter().map(|line| &line["number"]).collect();
    assert_eq!(numbers, ["14", "11", "12", "13", "15"]);
    // In a terminal, control characters in a name are escaped. In a table, a name that begins like
    // a formula is also preceded by a `'`.
    let table = folder.told("grade a.scn 'handed in' -o out", 1);
    assert!(table.contains("=1+1\\u{202e}  "), "{table}");
    assert!(folder.text("out/grade.csv").contains("\"'=1+1\\u{202e}\""));
    assert!(!folder.text("out/index.html").contains('\u{202e}'));
}

#[test]
fn loose_files_belong_to_students_and_the_output_folder_does_not() {
    let folder = folder();
    let files = [
        ("class/anna.png", "right.png"),
        ("class/anna.pdf", "%PDF"),
        ("class/ben.heic", "ftypheic"),
        ("class/cy/render.png", "red.png"),
        ("class/a.scn", SCENE),
    ];
    put(&folder, &files);
    std::fs::create_dir_all(folder.path("class/dora")).unwrap();
    let line = "class/a.scn class -o class/out --format json";
    let expected: [(&str, &str, &str, &[&str]); 4] = [
        ("anna.png", "class/anna.png", "right", &["anna.pdf"]),
        ("ben.heic", "class/ben.heic", "error", &["ben.heic"]),
        ("cy", "class/cy/render.png", "wrong", &[]),
        ("dora", "class/dora", "error", &[]),
    ];
    for _ in 0..2 {
        let said = folder.run(&format!("grade {line}"));
        assert_eq!((said.status, said.errors.as_str()), (1, ""));
        let lines = said
            .text()
            .lines()
            .map(|line| serde_json::from_str(line).unwrap());
        assert_lines(&lines.collect::<Vec<_>>(), &expected);
    }
}

/// A picture that is in every student's folder is regarded as part of the assignment's template.
/// This holds only if at least one student has another picture as well.
#[test]
fn a_picture_in_every_folder_is_a_template_only_beside_others() {
    let folder = folder();
    let files = [
        ("class/anna/render.png", "red.png"),
        ("class/ben/render.png", "red.png"),
        ("class/anna/README.md", "given"),
        ("class/ben/README.md", "given"),
    ];
    put(&folder, &files);
    assert_lines(
        &graded(&folder, "class", 1),
        &[
            ("anna", "class/anna/render.png", "wrong", &[]),
            ("ben", "class/ben/render.png", "wrong", &[]),
        ],
    );
    // Now one student has a second picture. Therefore, the picture that all students have is
    // regarded as part of the assignment's template, unless `--picture` names it.
    put(&folder, &[("class/ben/test.png", "size.png")]);
    let given = ["render.png (equal in every folder: --picture chooses it)"];
    let others: &[(&str, &str, &str, &[&str])] = &[
        ("anna", "class/anna", "error", &given),
        ("ben", "class/ben/test.png", "wrong", &given),
    ];
    assert_lines(&graded(&folder, "class", 1), others);
    assert_lines(
        &graded(&folder, "class --picture render.*", 1),
        &[
            ("anna", "class/anna/render.png", "wrong", &[]),
            ("ben", "class/ben/render.png", "wrong", &["test.png"]),
        ],
    );
    let none = folder.told("grade a.scn class --picture picture.*", 2);
    let words = "there is no picture called `picture.*` in what was handed in";
    assert_eq!(none.matches(words).count(), 2, "{none}");
}

/// A folder that contains an export of a class is graded as the class rather than as one student.
#[test]
fn a_folder_around_an_export_is_graded_as_the_export() {
    let folder = folder();
    let files = [
        ("g/export/submission_metadata.yml", METADATA),
        ("g/export/submission_1/a.png", "right.png"),
        ("g/export/submission_2/b.png", "red.png"),
        ("m/a/Li_1_assignsubmission_file/x.png", "right.png"),
        ("m/a/Li_2_assignsubmission_file/x.png", "red.png"),
        ("m/b/Li_3_assignsubmission_file_x.png", "red.png"),
        ("h/hw-submissions/hw-anna/x.png", "right.png"),
        ("h/hw-submissions/hw-anna/.git/HEAD", "ref"),
        ("h/hw-submissions/hw-ben/.git/HEAD", "ref"),
        // In the folder `s`, the folders `anna` and `ben` belong to two students. The folder `anna`
        // also contains the clone of a repository, and a file of `ben` is named after another
        // student, `Li`. Neither of these must change which students are found.
        ("s/anna/tracer/x.png", "right.png"),
        ("s/anna/tracer/.git/HEAD", "ref"),
        ("s/ben/Li_3_assignsubmission_file_x.png", "red.png"),
        ("s/ben/x.txt", "mine"),
    ];
    put(&folder, &files);
    let expected: [(&str, &[[&str; 2]]); 4] = [
        (
            "g",
            &[
                ["Anna Li", "g/export/submission_1/a.png"],
                ["Ben <b>, Cy", "g/export/submission_2/b.png"],
                ["Dora", "g/export/submission_3"],
                ["eve@example.org", "g/export/submission_4"],
            ],
        ),
        (
            "m",
            &[
                ["Li (1)", "m/a/Li_1_assignsubmission_file/x.png"],
                ["Li (2)", "m/a/Li_2_assignsubmission_file/x.png"],
                ["Li (3)", "m/b/Li_3_assignsubmission_file_x.png"],
            ],
        ),
        (
            "h",
            &[
                ["anna", "h/hw-submissions/hw-anna/x.png"],
                ["ben", "h/hw-submissions/hw-ben"],
            ],
        ),
        (
            "s",
            &[
                ["anna", "s/anna/tracer/x.png"],
                ["ben", "s/ben/Li_3_assignsubmission_file_x.png"],
            ],
        ),
    ];
    for (name, expected) in expected {
        let found = graded(&folder, name, 1);
        let found: Vec<_> = found
            .iter()
            .map(|line| [&line["student"], &line["file"]])
            .collect();
        assert_eq!(json!(found), json!(expected), "{name}");
    }
}

/// A shell expands `class/*` into a list of folders. This list is graded as the class.
#[test]
fn the_folders_of_a_class_may_be_listed() {
    let folder = folder();
    let files = [
        ("g/submission_metadata.yml", METADATA),
        ("g/submission_1/a.png", "right.png"),
        ("g/submission_2/b.png", "red.png"),
        ("m/Li_1_assignsubmission_file/x.png", "right.png"),
        ("m/Cy_2_assignsubmission_file/x.png", "red.png"),
        ("hw-submissions/hw-anna/x.png", "right.png"),
        ("hw-submissions/hw-anna/given.png", "noise.png"),
        ("hw-submissions/hw-anna/.git/HEAD", "ref"),
        ("hw-submissions/hw-ben/.git/HEAD", "ref"),
        ("hw-submissions/hw-ben/given.png", "noise.png"),
        ("class/anna/render.png", "right.png"),
        ("class/anna/main.c", "main"),
        ("class/ben/render.png", "red.png"),
        ("class/cy/out/x.png", "red.png"),
        ("class/dora.png", "right.png"),
        // The folders `one` and `two` are different classes.
        ("one/anna/x.png", "right.png"),
        ("two/anna/x.png", "red.png"),
        ("two/ben.png", "red.png"),
    ];
    put(&folder, &files);
    let cases = rows(
        "
        g/submission_metadata.yml g/submission_1 g/submission_2 -> Anna Li: right, Ben <b>, Cy: wrong, Dora: error, eve@example.org: error
        m/Cy_2_assignsubmission_file m/Li_1_assignsubmission_file/ -> Cy: wrong, Li: right
        hw-submissions/hw-anna hw-submissions/hw-ben -> anna: right, ben: error
        hw-submissions/hw-anna -> anna: right
        class/anna class/ben class/cy class/dora.png -> anna: right, ben: wrong, cy: wrong, class/dora.png: right
        class/anna/ class/ben -> anna: right, ben: wrong
        class/none class/anna class/ben -> anna: right, ben: wrong, class/none: error
        one two -> anna (one/anna): right, anna (two/anna): wrong, ben.png: wrong
        ",
    );
    for [arguments, expected] in cases {
        let said = folder.run(&format!("grade a.scn {arguments} --format json"));
        let lines = said.text().lines().map(|line| {
            let line: Value = serde_json::from_str(line).unwrap();
            let verdict = line["verdict"].as_str().unwrap_or("error");
            format!("{}: {verdict}", line["student"].as_str().unwrap())
        });
        assert_eq!(
            lines.collect::<Vec<_>>().join(", "),
            expected,
            "{arguments}"
        );
    }
}
