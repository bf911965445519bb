//! Tests of grading zip files, both well-formed and malicious ones.

use std::io::{Cursor, Write};

use zip::{ZipWriter, write::SimpleFileOptions};

use super::classes::{METADATA, assert_lines, folder, graded};

/// Returns a zip file with the given entries, i.e. names and contents. If a name begins with
/// `link:`, the entry is a symbolic link.
fn zip(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in entries {
        let options = SimpleFileOptions::default().large_file(false);
        match name.strip_prefix("link:") {
            Some(name) => zip
                .add_symlink(name, str::from_utf8(content).unwrap(), options)
                .unwrap(),
            None if name.ends_with('/') => zip.add_directory(*name, options).unwrap(),
            None => {
                zip.start_file(*name, options).unwrap();
                zip.write_all(content).unwrap();
            }
        }
    }
    zip.finish().unwrap().into_inner()
}

/// Replaces the bytes `from` by `to`. They must occur twice: a zip file contains each name before
/// its entry and in the list of entries.
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
fn a_zip_file_is_graded_as_a_class_and_no_entry_escapes_it() {
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
    // The name is in code page 437, in which 0x81 is ü and 0x82 is é.
    patch(&mut file, b"fXnn/", b"f\x81nn/");
    // Marks an entry as encrypted, by a bit of its flags. A zip file has two headers for an entry:
    // one before its contents, and one in the list of entries. Each contains the flags and, at a
    // fixed distance, the name.
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
fn a_students_zip_file_is_a_folder_and_a_folder_around_a_class_is_skipped() {
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
    // A folder belongs to a student even if it is empty or contains only files that operating
    // systems create.
    let files: [(&str, &[u8]); 7] = [
        ("anna/render.png", &right),
        ("ben/", b""),
        ("cy/.DS_Store", b"junk"),
        ("__MACOSX/", b""),
        ("__MACOSX/cy/._.DS_Store", b"junk"),
        ("._anna", b"junk"),
        ("Thumbs.DB", b"junk"),
    ];
    folder.write("plain.zip", zip(&files));
    let names = files.map(|(name, _)| format!("class/{name}"));
    let inner = names
        .iter()
        .zip(files)
        .map(|(name, (_, content))| (&**name, content));
    folder.write("around.zip", zip(&inner.collect::<Vec<_>>()));
    for place in ["plain.zip", "around.zip/class"] {
        let [anna, ben, cy] =
            ["anna/render.png", "ben", "cy"].map(|name| format!("{place}/{name}"));
        assert_lines(
            &graded(&folder, place.split('/').next().unwrap(), 1),
            &[
                ("anna", &anna, "right", &[]),
                ("ben", &ben, "error", &[]),
                ("cy", &cy, "error", &[]),
            ],
        );
    }
}

#[test]
fn zip_bombs_are_rejected_at_the_stated_limits() {
    let folder = folder();
    let right = folder.read("right.png");
    let mut bomb = zip(&[
        ("anna/a.png", &vec![0; (256 << 20) + 1]),
        ("ben/b.png", &right),
    ]);
    // Changes the headers of the first entry, so that they falsely announce ten bytes of contents.
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
    // The file lists 300 names of 60 kB each. A longer list would fill the memory, so the program
    // limits how much of a list it reads.
    let name = "x".repeat(60_000);
    let names: Vec<String> = (0..300).map(|index| format!("{index}{name}")).collect();
    let long: Vec<(&str, &[u8])> = names.iter().map(|name| (&**name, &b""[..])).collect();
    folder.write("long.zip", zip(&long));
    let told = folder.told("grade a.scn long.zip", 2);
    assert!(told.contains("or lists more than 10000 entries"), "{told}");
}
