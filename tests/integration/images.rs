//! The examples as small pictures, byte for byte, and the gallery that shows them.
//!
//! `PINHOLE_BLESS=1 cargo test images` writes the real pictures into `examples/pictures`: look at them before they are kept.

use std::{
    fs,
    path::{Path, PathBuf},
};

use pinhole::{
    area::Area,
    film::{Recipe, write_png},
    scene,
    source::{Source, Sources},
};

use crate::scenes::sampled;

fn rendered(text: &str) -> image::RgbImage {
    let sources = Sources::new(Source::from_text("example.scn", text)).with_sets([
        "image.width=160",
        "image.height=90",
        "sampler.total=160 * 90 * 4",
    ]);
    let scene = scene::read(&sources).scene.expect("the example is right");
    let film = sampled(&scene, Area::whole(160, 90));
    let recipe = Recipe {
        scene: String::new(),
        overrides: Vec::new(),
        crop: None,
    };
    let mut png = Vec::new();
    write_png(&film, Some(&recipe), &mut png).unwrap();
    image::load_from_memory(&png).unwrap().into_rgb8()
}

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")
}

/// The names of the files in `folder` that have such an ending, without it, sorted.
fn names(folder: &Path, ending: &str) -> Vec<String> {
    let names = crate::program::names(folder).into_iter();
    let names = names.filter_map(|name| Some(name.strip_suffix(ending)?.to_owned()));
    names.collect()
}

#[test]
fn the_examples_look_as_they_did() {
    let bless = std::env::var_os("PINHOLE_BLESS").is_some();
    let scenes = names(&examples(), ".scn");
    for name in &scenes {
        let text = fs::read_to_string(examples().join(format!("{name}.scn"))).unwrap();
        assert!(
            text.starts_with("// "),
            "{name}: the first line says what it shows"
        );
        let picture = rendered(&text);
        let kept = examples().join(format!("pictures/{name}.png"));
        if bless {
            picture.save(&kept).unwrap();
        }
        let kept = image::open(&kept).unwrap_or_else(|error| panic!("{}: {error}", kept.display()));
        let kept = kept.into_rgb8();
        let pairs = picture.pixels().zip(kept.pixels());
        let differing = pairs.filter(|(a, b)| a != b).count();
        assert_eq!(picture.dimensions(), kept.dimensions(), "{name}");
        assert_eq!(differing, 0, "{name}");
    }
    let kept = names(&examples().join("pictures"), ".png");
    assert_eq!(scenes, kept, "a picture for each example and no other");
}

#[test]
fn the_gallery_shows_every_example_with_its_picture_and_no_other() {
    let gallery = fs::read_to_string(examples().join("README.md")).unwrap();
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
    assert_eq!(shown, names(&examples(), ".scn"));
}
