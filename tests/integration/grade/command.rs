//! Tests of the command `grade`: it prints a line for each picture, and writes a page.

use std::fs;

use serde_json::Value;

use crate::{program::Folder, table::rows};

const SCENE: &str = "image { width 60 height 40 background navy }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sphere Ball { center (-1, 1, 0) }
triangle Sail { centroid (0.8, 1, 0.6) normal (0.3, 0, 1) sides (2, 2, 1) }
box { center (2.2, 0.75, -0.5) }
";

/// Rows: a file name, the arguments of `render` that make the file, its verdict, and the identifier
/// of its mistake. `scatter.png` has one sample per pixel on average; 1/e of the pixels, i.e. 37 %,
/// have none.
const PICTURES: &str = "
    crop.png -> --set sampler.method=exact --crop 8,4,40,30 -> right ->
    exact.exr -> --set sampler.method=exact -> right ->
    random.png -> --set sampler.method=random --set sampler.per_pixel=4 -> noise ->
    scatter.png -> --set sampler.method=scatter --set sampler.total=2400 -> noise ->
    size.png -> --set sampler.method=exact --set Ball.radius=1.5 -> wrong -> radius
    sky.png -> --set sampler.method=exact --set image.background=red -> wrong -> background
";

/// Creates a folder with the scene in `a.scn`, and with pictures in the folder `class`.
fn class() -> Folder {
    let folder = Folder::with([("a.scn", SCENE)]);
    fs::create_dir(folder.path("class")).unwrap();
    for [name, arguments, _, _] in rows(PICTURES) {
        folder.told(&format!("render a.scn -o class/{name} {arguments}"), 0);
    }
    // A PNG file can contain its scene. This picture is decoded and saved again, so it must be
    // graded without a scene in the file.
    let sky = folder.path("class/sky.png");
    image::open(&sky).unwrap().to_rgb8().save(&sky).unwrap();
    folder
}

fn lines(text: &str) -> Vec<Value> {
    text.lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

#[test]
fn each_picture_has_a_line_in_every_form() {
    let folder = class();
    let said = folder.run("grade a.scn class -o graded --format json");
    assert_eq!((said.status, said.errors.as_str()), (1, ""));
    let graded = lines(said.text());
    let pictures = rows(PICTURES);
    assert_eq!(graded.len(), pictures.len());
    for (line, [name, _, verdict, id]) in graded.iter().zip(&pictures) {
        assert_eq!(line["file"], format!("class/{name}"));
        assert_eq!(line["verdict"], *verdict, "{line:#}");
        let mistakes = line["mistakes"].as_array().unwrap();
        let found: Vec<_> = mistakes.iter().map(|mistake| &mistake["id"]).collect();
        let ids: Vec<_> = Some(*id).filter(|id| !id.is_empty()).into_iter().collect();
        assert_eq!(found, ids, "{line:#}");
        let is_ours = name.ends_with(".png") && *name != "sky.png";
        assert_eq!(line["rendered_by_pinhole"], is_ours, "{name}");
    }
    let read = |name: &str| folder.text(&format!("graded/{name}"));
    assert_eq!(read("grade.jsonl"), said.text());
    let csv = read("grade.csv");
    let rows: Vec<_> = csv.lines().collect();
    assert_eq!(rows.len(), 1 + pictures.len());
    let head = "file,verdict,rmse,samples_per_pixel,line,set,student,number,mistakes,explains,help,\
        guesses,rest,limited,not_compared,equal_to,score";
    assert_eq!(rows[0], head);
    assert!(
        rows[5].starts_with("\"class/size.png\",wrong,0.")
            && rows[5].contains(",\"Ball.radius=1.5\",\"size.png\",\"\",\"radius\","),
        "{}",
        rows[5]
    );
    // All rows of the CSV table have equally many cells.
    let mut table = csv::Reader::from_reader(csv.as_bytes());
    assert_eq!(
        table.records().filter(Result::is_ok).count(),
        pictures.len()
    );
    let page = read("index.html");
    assert_eq!(page.matches("<td class=\"picture\">").count(), 6);
    let whole = ["1", "1-difference", "1-exact", "6", "exact"];
    for name in whole.map(|name| format!("pictures/{name}.png")) {
        assert!(
            name == "pictures/exact.png" || page.contains(&name),
            "{name}"
        );
        image::load_from_memory(&folder.read(&format!("graded/{name}"))).unwrap();
    }
    assert_eq!(page.matches("data:image/png;base64,").count(), 12);
    assert!(
        page.contains("<code>--set image.background='#ff0000'</code>"),
        "{page}"
    );
    // The commands `diff` and `grade` give the same answer.
    let diff = folder.run("diff class/size.png a.scn --format json").json();
    for (key, value) in diff.as_object().unwrap() {
        assert_eq!(&graded[4][key], value, "{key}");
    }

    let table = folder.told("grade a.scn class", 1);
    let words = [
        "student",
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
    folder.told(
        "grade a.scn class/exact.exr class/random.png --threads 1",
        0,
    );
    // A file on the command line is always read as a picture, even if it has no extension.
    folder.write("picture", folder.read("class/exact.exr"));
    folder.told("grade a.scn picture --picture x.png", 0);
    let read = folder.run_reading("grade a.scn -", folder.read("class/exact.exr"));
    assert_eq!((read.status, read.text()), (0, ""));
}

#[test]
fn a_picture_that_cannot_be_compared_is_a_line_of_its_own() {
    let folder = class();
    folder.write("broken.png", "no picture");
    let small = image::RgbImage::new(48, 32);
    small.save(folder.path("small.png")).unwrap();
    let cases = rows(
        "
        broken.png -> it is no picture in PNG
        small.png -> it has 48 × 32 pixels, and the scene's picture 60 × 40
        none.png -> there is no such file
    ",
    );
    let said = folder
        .run("grade a.scn broken.png small.png none.png class/exact.exr --format json -o graded");
    // A file on the command line that does not exist is an error.
    assert_eq!(said.status, 2);
    let graded = lines(said.text());
    assert_eq!(graded.len(), 4);
    for (line, [name, words]) in graded.iter().zip(cases) {
        assert_eq!(line["file"], name);
        assert_eq!(line["student"], name);
        assert_eq!(line.as_object().unwrap().len(), 3);
        assert!(line["error"].as_str().unwrap().contains(words), "{line}");
    }
    assert_eq!(graded[3]["verdict"], "right");
    let page = folder.text("graded/index.html");
    assert_eq!(page.matches("<tr class=\"error\"").count(), 3);
    // The exit status is 2 if no picture can be compared, and 1 if only some can.
    folder.told("grade a.scn broken.png", 2);
    let table = folder.told("grade a.scn class/exact.exr broken.png", 1);
    assert!(table.contains("not compared: it is no picture"), "{table}");
}

#[test]
fn without_a_scene_or_pictures_there_is_nothing_to_grade() {
    let folder = Folder::with([("a.scn", SCENE), ("bad.scn", "sphere {}")]);
    fs::create_dir(folder.path("empty")).unwrap();
    let told = folder.told("grade a.scn empty", 2);
    assert!(told.contains("there are no pictures"), "{told}");
    folder.told("grade bad.scn empty", 1);
}
