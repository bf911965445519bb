//! The examples as small pictures, byte for byte.
//!
//! `PINHOLE_BLESS=1 cargo test images` writes the real pictures into `tests/images`: look at them before they are kept.

use std::{fs, path::Path, sync::atomic::AtomicBool};

use pinhole::{
    area::Area,
    film::{Recipe, write_png},
    render::{Control, render},
    sampling::Sampling,
    scene,
    source::{Source, Sources},
    tracer::World,
};

fn rendered(text: &str) -> image::RgbImage {
    let sources = Sources::new(Source::from_text("example.scn", text)).with_sets([
        "image.width=160",
        "image.height=90",
        "sampler.total=160 * 90 * 4",
    ]);
    let reading = scene::read(&sources);
    let scene = reading
        .scene
        .unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let (width, height) = (scene.image.width, scene.image.height);
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let film = render(
        &World::new(&scene),
        &Sampling::new(&scene.sampler, width, height),
        Area::whole(width, height),
        &control,
    )
    .unwrap();
    let recipe = Recipe {
        scene: String::new(),
        overrides: Vec::new(),
        crop: None,
    };
    let mut png = Vec::new();
    write_png(&film, &recipe, &mut png).unwrap();
    image::load_from_memory(&png).unwrap().into_rgb8()
}

#[test]
fn the_examples_look_as_they_did() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let bless = std::env::var_os("PINHOLE_BLESS").is_some();
    let mut examples = 0;
    for entry in fs::read_dir(root.join("examples")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "scn") {
            continue;
        }
        examples += 1;
        let text = fs::read_to_string(&path).unwrap();
        assert!(
            text.starts_with("// "),
            "{}: the first line says what it shows",
            path.display()
        );
        let picture = rendered(&text);
        let name = path.file_stem().unwrap().to_string_lossy();
        let kept = root.join(format!("tests/images/{name}.png"));
        if bless {
            picture.save(&kept).unwrap();
        }
        let kept = image::open(&kept).unwrap_or_else(|error| panic!("{}: {error}", kept.display()));
        let kept = kept.into_rgb8();
        let differing = picture
            .pixels()
            .zip(kept.pixels())
            .filter(|(a, b)| a != b)
            .count();
        assert_eq!(
            (picture.dimensions(), differing),
            (kept.dimensions(), 0),
            "{name}"
        );
    }
    let kept = fs::read_dir(root.join("tests/images")).unwrap().count();
    assert_eq!(examples, kept, "a picture for each example and no other");
}
