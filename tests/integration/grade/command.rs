//! The command `grade`: a line for each picture, and a page.

use std::{fs, path::Path};

use serde_json::Value;
use tempfile::TempDir;

use crate::program::command;

const SCENE: &str = "image { width 60 height 40 background navy }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sphere Ball { center (-1, 1, 0) }
triangle Sail { centroid (0.8, 1, 0.6) normal (0.3, 0, 1) sides (2, 2, 1) }
box { center (2.2, 0.75, -0.5) }
";

/// A file, how it is rendered, its verdict, and the ids of its mistakes.
const PICTURES: &[(&str, &[&str], &str, &[&str])] = &[
    (
        "crop.png",
        &["--set", "sampler.method=exact", "--crop", "8,4,40,30"],
        "right",
        &[],
    ),
    (
        "exact.exr",
        &["--set", "sampler.method=exact"],
        "right",
        &[],
    ),
    (
        "random.png",
        &[
            "--set",
            "sampler.method=random",
            "--set",
            "sampler.per_pixel=4",
        ],
        "noise",
        &[],
    ),
    (
        // A third of the pixels has no sample.
        "scatter.png",
        &[
            "--set",
            "sampler.method=scatter",
            "--set",
            "sampler.total=2400",
        ],
        "noise",
        &[],
    ),
    (
        "size.png",
        &["--set", "sampler.method=exact", "--set", "Ball.radius=1.5"],
        "wrong",
        &["radius"],
    ),
    (
        "sky.png",
        &[
            "--set",
            "sampler.method=exact",
            "--set",
            "image.background=red",
        ],
        "wrong",
        &["background"],
    ),
];

/// The scene, and a folder `class` with the pictures.
fn class() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("a.scn"), SCENE).unwrap();
    fs::create_dir(path.join("class")).unwrap();
    for (name, arguments, ..) in PICTURES {
        let name = format!("class/{name}");
        let arguments = [&["render", "a.scn", "-o", &name], *arguments].concat();
        let output = command(path, &arguments).output().unwrap();
        assert!(output.status.success(), "{output:?}");
    }
    // No text of Pinhole's own is left in it.
    let picture = image::open(path.join("class/sky.png")).unwrap();
    picture.to_rgb8().save(path.join("class/sky.png")).unwrap();
    folder
}

fn grade(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let arguments = [&["grade", "a.scn"], arguments].concat();
    let output = command(folder, &arguments).output().unwrap();
    let [out, errors] =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    (output.status.code(), out, errors)
}

fn lines(text: &str) -> Vec<Value> {
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

#[test]
fn each_picture_has_a_line_in_every_form() {
    let folder = class();
    let path = folder.path();
    let (status, out, errors) = grade(path, &["class", "-o", "graded", "--format", "json"]);
    assert_eq!((status, errors.as_str()), (Some(1), ""));
    let graded = lines(&out);
    assert_eq!(graded.len(), PICTURES.len());
    for (line, (name, _, verdict, ids)) in graded.iter().zip(PICTURES) {
        assert_eq!(line["file"], format!("class/{name}"));
        assert_eq!(line["verdict"], *verdict, "{line:#}");
        let mistakes = line["mistakes"].as_array().unwrap();
        let found: Vec<_> = mistakes.iter().map(|mistake| &mistake["id"]).collect();
        assert_eq!(found, *ids, "{line:#}");
        let is_ours = name.ends_with(".png") && *name != "sky.png";
        assert_eq!(line["rendered_by_pinhole"], is_ours, "{name}");
    }
    let read = |name: &str| fs::read_to_string(path.join("graded").join(name)).unwrap();
    assert_eq!(read("grade.jsonl"), out);
    let csv = read("grade.csv");
    let rows: Vec<_> = csv.lines().collect();
    assert_eq!(rows.len(), 1 + PICTURES.len());
    assert_eq!(rows[0], "file,verdict,rmse,samples_per_pixel,line,set");
    assert!(
        rows[5].starts_with("\"class/size.png\",wrong,0.")
            && rows[5].ends_with("\"Ball.radius=1.5\""),
        "{}",
        rows[5]
    );
    let page = read("index.html");
    assert_eq!(page.matches("<td class=\"picture\">").count(), 6);
    assert_eq!(page.matches("data:image/png;base64,").count(), 12);
    assert!(
        page.contains("<code>--set image.background='#ff0000'</code>"),
        "{page}"
    );
    // What `diff` says of the same picture stands in its line.
    let arguments = ["diff", "class/size.png", "a.scn", "--format", "json"];
    let output = command(path, &arguments).output().unwrap();
    let diff: Value = serde_json::from_slice(&output.stdout).unwrap();
    for (key, value) in diff.as_object().unwrap() {
        assert_eq!(&graded[4][key], value, "{key}");
    }

    let (status, out, table) = grade(path, &["class"]);
    assert_eq!((status, out.as_str()), (Some(1), ""));
    let words = [
        "picture",
        "right: equal to the exact picture (rendered by Pinhole)",
        "right: equal to the exact picture",
        "right but for sampling noise",
        "right but for sampling noise",
        "wrong: the sphere Ball has a wrong size: its radius is 1.5 instead of 1",
        "wrong: the image has a wrong colour",
    ];
    assert_eq!(table.lines().count(), words.len());
    for (line, words) in table.lines().zip(words) {
        assert!(line.contains(words), "{table}");
    }
    let right = ["class/exact.exr", "class/random.png", "--threads", "1"];
    assert_eq!(grade(path, &right).0, Some(0));
}

#[test]
fn a_picture_that_cannot_be_compared_is_a_line_of_its_own() {
    let folder = class();
    let path = folder.path();
    fs::write(path.join("broken.png"), "no picture").unwrap();
    image::RgbImage::new(48, 32)
        .save(path.join("small.png"))
        .unwrap();
    let cases = [
        ("broken.png", "it is no picture in PNG"),
        (
            "small.png",
            "it has 48 × 32 pixels, and the scene's picture 60 × 40",
        ),
        ("none.png", "No such file"),
    ];
    let names = cases.map(|(name, _)| name);
    let exact = "class/exact.exr";
    let arguments = [&names[..], &[exact, "--format", "json", "-o", "graded"]].concat();
    let (status, out, _) = grade(path, &arguments);
    assert_eq!(status, Some(2));
    let graded = lines(&out);
    assert_eq!(graded.len(), 4);
    for (line, (name, words)) in graded.iter().zip(cases) {
        assert_eq!(line["file"], name);
        assert_eq!(line.as_object().unwrap().len(), 2);
        assert!(line["error"].as_str().unwrap().contains(words), "{line}");
    }
    assert_eq!(graded[3]["verdict"], "right");
    let page = fs::read_to_string(path.join("graded/index.html")).unwrap();
    assert_eq!(page.matches("<tr class=\"error\">").count(), 3);
    let (status, _, table) = grade(path, &[exact, "broken.png"]);
    assert_eq!(status, Some(2));
    assert!(table.contains("not compared: it is no picture"), "{table}");
}

#[test]
fn without_a_scene_or_pictures_there_is_nothing_to_grade() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::create_dir(path.join("empty")).unwrap();
    fs::write(path.join("a.scn"), SCENE).unwrap();
    let (status, _, errors) = grade(path, &["empty"]);
    assert_eq!(status, Some(2));
    assert!(errors.contains("there are no pictures"), "{errors}");
    fs::write(path.join("a.scn"), "sphere {}").unwrap();
    assert_eq!(grade(path, &["empty"]).0, Some(1));
}
