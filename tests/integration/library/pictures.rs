//! Tests of the library's pictures: rendering, saving and reading them, making them from pixels,
//! and judging them.

use std::{fs, sync::atomic::AtomicBool};

use pinhole::{Picture, Scene, area::Area, render::Control};

use crate::{program::Folder, scenes::example_text};

#[test]
fn saved_pictures_have_the_bytes_that_the_program_writes() {
    let text = example_text("figure_9_9");
    let folder = Folder::with([("a.scn", &text[..])]);
    let sets = ["image.width=64", "image.height=36"];
    for method in ["multi_jittered", "scatter", "exact"] {
        let sets = sets.map(str::to_owned).into_iter();
        let sets = sets
            .chain([format!("sampler.method={method}")])
            .collect::<Vec<_>>();
        let mut scene: Scene = text.parse().unwrap();
        for set in &sets {
            scene = scene.with_set(set).unwrap();
        }
        let picture = scene.render().unwrap();
        for ending in ["png", "exr"] {
            let sets = sets.iter().map(|set| format!("--set {set}"));
            let sets = sets.collect::<Vec<_>>().join(" ");
            let said = folder.run(&format!("render a.scn {sets} -o program.{ending}"));
            assert_eq!(said.status, 0, "{}", said.errors);
            let path = folder.path(&format!("library.{ending}"));
            picture.save(&path).unwrap();
            let program = fs::read(folder.path(&format!("program.{ending}"))).unwrap();
            assert!(fs::read(&path).unwrap() == program, "{method} {ending}");
            let read = Picture::open(&path).unwrap();
            assert!(read.rmse(&picture).unwrap() < 0.01);
            assert_eq!(read.to_rgb8(), picture.to_rgb8());
            // A picture that was read from a file can be saved again, together with its scene.
            read.save(&path).unwrap();
            assert!(fs::read(&path).unwrap() == program, "{method} {ending}");
        }
    }
}

#[test]
fn a_part_that_is_read_and_saved_again_is_still_a_part() {
    let folder = Folder::with([("a.scn", &example_text("figure_9_9")[..])]);
    for ending in ["png", "exr"] {
        let size = "--set image.width=64 --set image.height=36";
        folder.done(&format!("render a.scn {size} --shard 2/3 -o part.{ending}"));
        let path = folder.path(&format!("part.{ending}"));
        let written = fs::read(&path).unwrap();
        Picture::open(&path).unwrap().save(&path).unwrap();
        assert!(fs::read(&path).unwrap() == written, "{ending}");
    }
}

#[test]
fn a_changed_scene_is_in_its_picture() {
    let mut data = Scene::parse(&example_text("figure_9_9"))
        .unwrap()
        .data()
        .clone();
    (data.image.width, data.image.height) = (32, 18);
    data.camera.eye.y = 7.5;
    let scene = Scene::from_data(&data).unwrap();
    let folder = Folder::with([]);
    scene.render().unwrap().save(folder.path("a.png")).unwrap();
    folder.done("render a.png -o again.png");
    let [first, again] = ["a.png", "again.png"].map(|name| fs::read(folder.path(name)).unwrap());
    assert!(first == again);
}

#[test]
fn an_exact_scene_is_computed_by_either_way_to_render() {
    let set = "sampler.method=exact";
    let scene = Scene::parse(&example_text("figure_9_9")).unwrap();
    let sizes = ["image.width=32", "image.height=18"];
    let scene = sizes
        .iter()
        .fold(scene, |scene, set| scene.with_set(set).unwrap());
    let exact = scene.render_exact().unwrap();
    let rendered = scene.with_set(set).unwrap().render().unwrap();
    assert_eq!(rendered.pixels(), exact.picture.pixels());
    assert_eq!(exact.bounds.len(), 32 * 18);
    assert!(exact.bound() < 1e-9, "{}", exact.bound());
}

#[test]
fn an_area_is_rendered_under_control() {
    let folder = Folder::with([("a.scn", &example_text("figure_9_9")[..])]);
    let scene = Scene::parse(&example_text("figure_9_9")).unwrap();
    let scene = scene.with_set("image.width=96").unwrap();
    let scene = scene.with_set("image.height=54").unwrap();
    let area: Area = "40,20,30,20".parse().unwrap();
    for method in ["multi_jittered", "exact"] {
        let scene = scene.with_set(&format!("sampler.method={method}")).unwrap();
        let part = scene.render_with(area, &Control::default()).unwrap();
        let whole = scene.render().unwrap();
        assert_eq!(part.film(), &whole.film().part(area).unwrap());
        // The picture has stored its position in the whole picture, and so has its file.
        let verdict = scene.grade(&part).unwrap().to_string();
        assert!(verdict.starts_with("right"), "{verdict}");
        for ending in ["png", "exr"] {
            let sets = scene.sources().sets.iter();
            let sets: String = sets.map(|set| format!("--set {} ", set.text())).collect();
            let line = format!("render a.scn {sets} --crop {area} -o program.{ending}");
            assert_eq!(folder.run(&line).status, 0, "{line}");
            let [own, program] =
                ["library", "program"].map(|name| folder.path(&format!("{name}.{ending}")));
            part.save(&own).unwrap();
            let [own, program] = [own, program].map(|path| fs::read(path).unwrap());
            assert!(own == program, "{method} {ending}");
        }
    }
    let cancel = AtomicBool::new(true);
    let control = Control {
        cancel: &cancel,
        ..Control::default()
    };
    let whole = Area::whole(96, 54);
    let beyond = Area::whole(97, 54);
    for (area, control, expected) in [
        (whole, control, "interrupted"),
        (
            beyond,
            Control::default(),
            "the part 0,0,97,54 has no pixels, or does not lie in the picture of 96 × 54",
        ),
    ] {
        let error = scene.render_with(area, &control).unwrap_err();
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn pictures_are_judged() {
    let scene = Scene::parse(&example_text("figure_9_9")).unwrap();
    let sizes = ["image.width=96", "image.height=54"];
    let scene = sizes
        .iter()
        .fold(scene, |scene, set| scene.with_set(set).unwrap());
    let picture = scene.render().unwrap();
    let verdict = scene.grade(&picture).unwrap();
    assert!(
        verdict
            .to_string()
            .starts_with("right but for sampling noise")
    );
    let exact = scene.render_exact().unwrap().picture;
    assert_eq!(
        scene.grade(&exact).unwrap().to_string(),
        "right: equal to the exact picture"
    );
    let small = scene.with_set("image.width=95").unwrap().render().unwrap();
    for error in [scene.grade(&small).err(), small.rmse(&picture).err()] {
        let told = error.unwrap().to_string();
        assert_eq!(told, "the sizes differ: 95 × 54 pixels and 96 × 54");
    }
    // The file of a crop contains the crop's position in the whole picture.
    let folder = Folder::with([("a.scn", &example_text("figure_9_9")[..])]);
    folder.done(
        "render a.scn --set image.width=96 --set image.height=54 --crop 40,20,30,20 -o part.png",
    );
    let part = Picture::open(folder.path("part.png")).unwrap();
    let verdict = scene.grade(&part).unwrap();
    assert!(
        verdict.to_string().starts_with("right but for"),
        "{verdict}"
    );
}

#[test]
fn pixels_of_another_program_are_a_picture() {
    let scene = Scene::parse(&example_text("figure_9_9")).unwrap();
    let scene = scene.with_set("image.width=96").unwrap();
    let scene = scene.with_set("image.height=54").unwrap();
    let exact = scene.render_exact().unwrap().picture;
    let (bytes, pixels) = (exact.to_rgb8(), exact.pixels().to_vec());
    for picture in [
        Picture::from_rgb8(96, 54, &bytes).unwrap(),
        Picture::from_pixels(96, 54, pixels).unwrap(),
        exact.film().clone().into(),
    ] {
        assert_eq!(picture.to_rgb8(), bytes);
        assert!(picture.rmse(&exact).unwrap() < 0.01);
        let told = scene.grade(&picture).unwrap().to_string();
        assert_eq!(told, "right: equal to the exact picture");
        assert!(picture.sources().is_none());
    }
    let all: Vec<u8> = (0..=255).flat_map(|byte| [byte; 3]).collect();
    assert_eq!(Picture::from_rgb8(16, 16, &all).unwrap().to_rgb8(), all);
    for (error, expected) in [
        (
            Picture::from_rgb8(2, 1, &[0; 7]).unwrap_err(),
            "3 pixels do not make a picture of 2 × 1",
        ),
        (
            Picture::from_rgb8(2, 1, &[0; 3]).unwrap_err(),
            "1 pixels do not make a picture of 2 × 1",
        ),
        (
            Picture::from_pixels(0, 0, vec![]).unwrap_err(),
            "0 pixels do not make a picture of 0 × 0",
        ),
        (
            Picture::from_pixels(u32::MAX, u32::MAX, vec![[0.0; 3]]).unwrap_err(),
            "1 pixels do not make a picture of 4294967295 × 4294967295",
        ),
    ] {
        assert_eq!(error.to_string(), expected);
    }
}

#[test]
fn debug_texts_are_short() {
    let scene = Scene::parse(pinhole::scene::SMALLEST).unwrap();
    let scene = scene.with_set("image.width=64").unwrap();
    let scene = scene.with_set("image.height=36").unwrap();
    let exact = scene.render_exact().unwrap();
    assert_eq!(format!("{:?}", exact.picture), "Picture { 64 × 36, .. }");
    assert_eq!(
        format!("{:?}", exact.picture.film()),
        "Film { 64 × 36, .. }"
    );
    let world = pinhole::tracer::World::new(scene.data());
    for text in [format!("{exact:?}"), format!("{world:?}")] {
        assert!(text.len() < 500, "{text}");
    }
    let text = format!("{scene:?}");
    assert!(!text.contains("OnceLock"), "{text}");
}
