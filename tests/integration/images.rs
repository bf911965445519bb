//! Compares small pictures of the examples byte for byte with stored files, and tests the gallery
//! that shows them.
//!
//! `PINHOLE_BLESS=1 cargo test images` writes the current pictures into `examples/pictures`. Look
//! at them before you keep them.

use std::{fs, path::Path};

use pinhole::film::Encoder;
use png::{BitDepth, ColorType};

use crate::{
    program::Folder,
    scenes::{example_names, example_text, read_with, sampled},
};

fn rendered(text: &str) -> image::RgbImage {
    let scene = read_with(
        text,
        [
            "image.width=160",
            "image.height=90",
            "sampler.total=160 * 90 * 4",
        ],
    );
    let (film, encoder) = (sampled(&scene), Encoder::default());
    image::RgbImage::from_fn(160, 90, |x, y| image::Rgb(encoder.pixel(film.pixel(x, y))))
}

/// Returns a PNG file of any colour type. The crate `png` is used, because an encoder of the crate
/// `image` would make the tests take longer to compile.
pub fn png([width, height]: [u32; 2], color: ColorType, depth: BitDepth, data: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(data).unwrap();
    writer.finish().unwrap();
    file
}

#[test]
fn the_examples_match_their_stored_pictures() {
    let bless = std::env::var_os("PINHOLE_BLESS").is_some();
    let pictures = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/pictures");
    let names = example_names();
    for name in &names {
        let text = example_text(name);
        assert!(
            text.starts_with("// "),
            "{name}: the first line says what it shows"
        );
        let picture = rendered(&text);
        let kept = pictures.join(format!("{name}.png"));
        if bless {
            picture.save(&kept).unwrap();
        }
        let kept = image::open(&kept).unwrap_or_else(|error| panic!("{}: {error}", kept.display()));
        assert!(picture == kept.into_rgb8(), "{name}");
    }
    let kept = names.iter().map(|name| format!("{name}.png"));
    let kept: Vec<_> = kept.collect();
    assert_eq!(
        crate::program::names(&pictures),
        kept,
        "a picture for each example and no other"
    );
}

#[test]
fn the_gallery_shows_every_example_with_its_picture_and_no_other() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/README.md");
    let gallery = fs::read_to_string(gallery).unwrap();
    let mut shown = Vec::new();
    for line in gallery.lines().filter(|line| line.starts_with("| ![")) {
        let (_, rest) = line.split_once("](pictures/").expect("a picture");
        let (name, rest) = rest.split_once(".png) | ").expect("a PNG file");
        let sentence = rest
            .strip_prefix(&format!("[{name}]({name}.scn): "))
            .unwrap_or_else(|| panic!("the scene beside its picture: {line}"));
        assert!(sentence.len() > 20, "what it shows: {line}");
        shown.push(name.to_owned());
    }
    shown.sort();
    assert_eq!(shown, example_names());
}

/// The course's scenes are short, valid and formatted, and the sheet of the course shows all of
/// them.
#[test]
fn the_course_is_short_valid_formatted_and_matches_its_sheet() {
    let course = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/course");
    let names = crate::program::names(&course);
    let scenes: Vec<&String> = names.iter().filter(|name| name.ends_with(".scn")).collect();
    assert_eq!(scenes.len(), 12);
    let folder = Folder::with([]);
    let mut lines = 0;
    for name in &scenes {
        let text = fs::read_to_string(course.join(name)).unwrap();
        lines += text.lines().count();
        folder.write(name, &text);
        for command in ["check", "fmt --check"] {
            let said = folder.run(&format!("{command} {name}"));
            assert_eq!(
                (said.status, said.errors),
                (0, String::new()),
                "{command} {name}"
            );
        }
    }
    assert!(lines <= 150, "{lines} lines");
    let scenes: Vec<&str> = scenes.iter().map(|name| name.as_str()).collect();
    let scenes = scenes.join(" ");
    folder.done(&format!(
        "sheet {scenes} --columns 4 --width 240 -o sheet.png"
    ));
    let kept = course.join("sheet.png");
    if std::env::var_os("PINHOLE_BLESS").is_some() {
        fs::write(&kept, folder.read("sheet.png")).unwrap();
    }
    assert!(fs::read(&kept).unwrap() == folder.read("sheet.png"));
}
