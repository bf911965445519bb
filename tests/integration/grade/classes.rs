//! Classes as they are handed in: folders and zip files of Gradescope, GitHub Classroom and Moodle,
//! with what else there is in them.

use std::{
    fs::File,
    io::{Cursor, Write},
    time::{Duration, SystemTime},
};

use serde_json::{Value, json};
use zip::{ZipWriter, write::SimpleFileOptions};

use crate::{program::Folder, table::rows};

/// A scene with a picture that is found out at once.
pub const SCENE: &str = "image { width 24 height 16 background navy }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sphere Ball { center (-1, 1, 0) }
box { center (2.2, 0.75, -0.5) }
";

/// Pictures and how they are rendered.
const PICTURES: &str = "
    right.png -> --set sampler.method=exact
    red.png -> --set sampler.method=exact --set image.background=red
    size.png -> --set sampler.method=exact --set Ball.radius=1.5
    noise.png -> --set sampler.method=random --set sampler.per_pixel=4
";

/// The scene and the pictures.
pub fn folder() -> Folder {
    let folder = Folder::with([("a.scn", SCENE)]);
    for [name, arguments] in rows(PICTURES) {
        folder.told(&format!("render a.scn -o {name} {arguments}"), 0);
    }
    folder
}

/// Puts files into a folder: where, and what is copied there; other words are the content.
pub fn put(folder: &Folder, files: &[(&str, &str)]) {
    for (path, content) in files {
        match content.ends_with(".png") {
            true => folder.write(path, folder.read(content)),
            false => folder.write(path, content),
        }
    }
}

/// Makes a file so many hours older.
fn age(folder: &Folder, path: &str, hours: u64) {
    let file = File::options().write(true).open(folder.path(path)).unwrap();
    let time = SystemTime::now() - Duration::from_secs(3600 * hours);
    file.set_modified(time).unwrap();
}

/// The lines of a class, by student.
fn graded(folder: &Folder, arguments: &str, status: i32) -> Vec<Value> {
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

/// What is compared of each: the student, the file, the verdict, and what is not.
#[track_caller]
fn assert_lines(found: &[Value], expected: &[(&str, &str, &str, &[&str])]) {
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

const METADATA: &str = "---
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
            &["main.py"],
        ),
        (
            "Ben <b>, Cy",
            "export/submission_2/Render.PNG",
            "wrong",
            &["photo.heic"],
        ),
        // The template is in every folder, and is nobody's.
        ("Dora", "export/submission_3", "error", &[]),
        ("eve@example.org", "export/submission_4", "error", &[]),
    ];
    assert_lines(&graded(&folder, "export", 1), &expected);
    assert_lines(&graded(&folder, "export/", 1), &expected);
}

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
    // One of a clone is older, which says nothing there.
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
            ("anna", "hw1-submissions/hw1-anna/render.png", "right", &[]),
            ("ben", "hw1-submissions/hw1-ben/tries/2.png", "right", &[]),
            ("cy", "hw1-submissions/hw1-cy/render.png", "wrong", &[]),
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
                &["tries/1.png"],
            ),
            (
                "ben",
                "hw1-submissions/hw1-ben/render.png",
                "wrong",
                &["tries/1.png", "tries/2.png"],
            ),
            (
                "cy",
                "hw1-submissions/hw1-cy/render.png",
                "wrong",
                &["tries/1.png"],
            ),
        ],
    );
    // They have the same picture, and it is not the right one.
    let equal: Vec<_> = chosen.iter().map(|line| &line["equal_to"]).collect();
    assert_eq!(equal, [&Value::Null, &json!(["cy"]), &json!(["ben"])]);
}

/// What Moodle hands out: names of folders and of files.
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
fn what_moodle_hands_out_is_a_class() {
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
    // On a terminal and in a table a name does nothing.
    let table = folder.told("grade a.scn 'handed in' -o out", 1);
    assert!(table.contains("=1+1\\u{202e}  "), "{table}");
    assert!(folder.text("out/grade.csv").contains("\"'=1+1\\u{202e}\""));
    assert!(!folder.text("out/index.html").contains('\u{202e}'));
}

#[test]
fn loose_files_are_somebodys_and_a_folder_that_was_made_here_is_not() {
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

/// What all made alike is no template.
#[test]
fn a_picture_that_all_have_and_nothing_else_is_theirs() {
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
}

/// A zip file with these entries.
fn zip(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in entries {
        let options = SimpleFileOptions::default().large_file(false);
        match name.strip_prefix("link:") {
            Some(name) => zip
                .add_symlink(name, str::from_utf8(content).unwrap(), options)
                .unwrap(),
            None => {
                zip.start_file(*name, options).unwrap();
                zip.write_all(content).unwrap();
            }
        }
    }
    zip.finish().unwrap().into_inner()
}

/// Changes all places of some bytes.
fn patch(bytes: &mut [u8], from: &[u8], to: &[u8]) {
    let places: Vec<_> = (0..bytes.len() - from.len())
        .filter(|&at| bytes[at..].starts_with(from))
        .collect();
    assert_eq!(places.len(), 2, "a head in front and one in the list");
    for at in places {
        bytes[at..at + to.len()].copy_from_slice(to);
    }
}

#[test]
fn a_zip_file_is_a_class_and_nothing_in_it_leads_out() {
    let folder = folder();
    let [right, red] = ["right.png", "red.png"].map(|name| folder.read(name));
    let inner = zip(&[("render.png", &right)]);
    let mut file = zip(&[
        ("../up.png", &right),
        ("/etc/absolute.png", &red),
        ("anna/render.png", &right),
        ("anna/../../deep.pdf", b"%PDF"),
        ("ben/inner.zip", &inner),
        ("link:cy/render.png", b"/etc/passwd"),
        ("dora/Xecret.png", &red),
        ("fXnn/render.png", &red),
        ("gus\\render.png", &red),
        ("__MACOSX/._x.png", b"junk"),
    ]);
    // Code page 437, in which 0x81 is ü, and 0x82 é.
    patch(&mut file, b"fXnn/", b"f\x81nn/");
    // Encrypted: a bit before each name says so.
    for (head, flags) in [(30, 6), (46, 8)] {
        let name = b"dora/Xecret.png";
        let names: Vec<_> = (head..file.len() - name.len())
            .filter(|&at| file[at..].starts_with(name))
            .collect();
        let starts = names.iter().map(|at| at - head);
        let at = starts.into_iter().find(|&at| {
            file[at..].starts_with(if head == 30 {
                b"PK\x03\x04"
            } else {
                b"PK\x01\x02"
            })
        });
        file[at.unwrap() + flags] |= 1;
    }
    folder.write("class.zip", &file);
    let before = folder.names();
    let found = graded(&folder, "class.zip", 1);
    assert_lines(
        &found,
        &[
            ("anna", "class.zip/anna/render.png", "right", &["deep.pdf"]),
            (
                "ben",
                "class.zip/ben",
                "error",
                &["inner.zip (an archive in a zip file)"],
            ),
            ("cy", "class.zip/cy", "error", &["render.png (a link)"]),
            (
                "dora",
                "class.zip/dora",
                "error",
                &["Xecret.png (encrypted)"],
            ),
            ("etc", "class.zip/etc/absolute.png", "wrong", &[]),
            ("fünn", "class.zip/fünn/render.png", "wrong", &[]),
            ("gus", "class.zip/gus/render.png", "wrong", &[]),
            ("up.png", "class.zip/up.png", "right", &[]),
        ],
    );
    assert_eq!(folder.names(), before);
}

#[test]
fn a_zip_file_of_a_student_is_his_folder_and_one_around_a_class_is_left() {
    let folder = folder();
    let [right, red] = ["right.png", "red.png"].map(|name| folder.read(name));
    folder.write("class/anna.zip", zip(&[("out/render.png", &right)]));
    folder.write("class/ben/all.zip", zip(&[("render.png", &red)]));
    folder.write("class/cy.zip", b"PK\x03\x04 cut off");
    assert_lines(
        &graded(&folder, "class", 1),
        &[
            ("anna", "class/anna.zip/out/render.png", "right", &[]),
            ("ben", "class/ben/all.zip/render.png", "wrong", &[]),
            (
                "cy.zip",
                "class/cy.zip",
                "error",
                &["cy.zip (it is no zip file, or damaged or cut off)"],
            ),
        ],
    );
    let export = zip(&[
        (
            "assignment_1_export/submission_metadata.yml",
            METADATA.as_bytes(),
        ),
        ("assignment_1_export/submission_1/a.png", &right),
        ("assignment_1_export/submission_2/b.png", &red),
    ]);
    folder.write("export.zip", export);
    let found = graded(&folder, "export.zip", 1);
    let names: Vec<_> = found.iter().map(|line| &line["student"]).collect();
    assert_eq!(names, ["Anna Li", "Ben <b>, Cy", "Dora", "eve@example.org"]);
    assert_eq!(found[1]["verdict"], "wrong");
}

#[test]
fn a_zip_file_without_end_is_unpacked_to_its_bound() {
    let folder = folder();
    let right = folder.read("right.png");
    let mut bomb = zip(&[
        ("anna/a.png", &vec![0; (256 << 20) + 1]),
        ("ben/b.png", &right),
    ]);
    // It says that it has ten bytes.
    let length = ((256u32 << 20) + 1).to_le_bytes();
    let places: Vec<_> = (0..bomb.len() - 4)
        .filter(|&at| bomb[at..].starts_with(&length))
        .collect();
    assert!(!places.is_empty());
    for at in places {
        bomb[at..at + 4].copy_from_slice(&10u32.to_le_bytes());
    }
    folder.write("bomb.zip", bomb);
    let found = graded(&folder, "bomb.zip", 1);
    let error = found[0]["error"].as_str().unwrap();
    assert!(
        error.contains("unpacks to more than 256 MiB") || error.contains("damaged"),
        "{error}"
    );
    assert_eq!(found[1]["verdict"], "right");

    let names: Vec<String> = (0..10_001).map(|index| format!("{index}/a.txt")).collect();
    let many: Vec<(&str, &[u8])> = names.iter().map(|name| (&**name, &b""[..])).collect();
    folder.write("many.zip", zip(&many));
    let told = folder.told("grade a.scn many.zip", 2);
    assert!(
        told.contains("it has 10001 entries, and at most 10000 are read"),
        "{told}"
    );
}
