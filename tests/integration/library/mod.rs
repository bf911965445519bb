//! Tests of the library's public functions and types, as another program uses them.

mod pictures;
mod wrong_data;

#[allow(dead_code, reason = "its main function is another program's")]
#[path = "../../../examples/library/dolly_zoom.rs"]
mod dolly_zoom;
#[allow(dead_code, reason = "its main function is another program's")]
#[path = "../../../examples/library/problems_as_json.rs"]
mod problems_as_json;

use std::{
    fs,
    path::{Path, PathBuf},
};

use pinhole::{Color, Error, Method, Picture, Scene, SceneData, source::Sources};

use crate::{program::Folder, scenes::example_text};

/// Collects the texts of all scenes in a folder of the repository and in its subfolders.
fn texts_in(folder: &Path, texts: &mut Vec<(PathBuf, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            texts_in(&path, texts);
        } else if path.extension().is_some_and(|ending| ending == "scn") {
            // Some files are deliberately not UTF-8.
            if let Ok(text) = fs::read_to_string(&path) {
                texts.push((path, text));
            }
        }
    }
}

/// Returns the data of a scene without everything that depends on its text: spans, and the names of
/// repeated objects.
fn without_text(data: &SceneData) -> SceneData {
    let mut data = data.clone();
    for object in data.objects_mut() {
        let kept = pinhole::scene::Object::new(object.shape);
        let name = object.name.take().filter(|_| object.indices.is_empty());
        *object = pinhole::scene::Object { name, ..kept };
    }
    data
}

#[test]
fn a_scene_written_from_its_data_has_the_same_data() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut texts = Vec::new();
    for folder in ["examples", "grammar", "tests", "benches", "docs"] {
        texts_in(&root.join(folder), &mut texts);
    }
    let mut read = 0;
    for (path, text) in &texts {
        let Ok(scene) = Scene::parse(text) else {
            continue;
        };
        read += 1;
        let again = Scene::from_data(scene.data());
        let again = again.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let (mut there, back) = (without_text(scene.data()), without_text(again.data()));
        // In the new text, objects of a repeated block are written one by one and so get names.
        for (object, again) in there.objects_mut().iter_mut().zip(back.objects.iter()) {
            if object.name.is_none() {
                object.name.clone_from(&again.name);
            }
        }
        assert_eq!(there, back, "{}", path.display());
        let text = again.to_string();
        assert_eq!(Scene::parse(&text).unwrap().data(), again.data());
    }
    assert!(read > 50, "{read} of {} texts", texts.len());
}

#[test]
fn extreme_numbers_are_written_to_the_last_bit() {
    let numbers = [
        0.1,
        -0.0,
        5e-324,
        f64::MAX,
        1e21,
        123_456_789.125,
        1.0 / 3.0,
    ];
    let mut data = Scene::parse(&example_text("figure_9_9"))
        .unwrap()
        .data()
        .clone();
    for (number, other) in numbers.into_iter().zip(numbers.into_iter().rev()) {
        data.camera.up = glam::DVec3::new(number, other, 1.0);
        data.camera.roll = pinhole::Angle {
            degrees: number,
            radians: other,
        };
        data.image.background = Color {
            srgb: [1.0 / 3.0, 254.5, number.clamp(0.0, 255.0)],
        };
        let again = Scene::from_data(&data).unwrap();
        assert_eq!(without_text(again.data()), without_text(&data));
    }
}

#[test]
fn equality_of_data_ignores_where_they_stand_in_a_text() {
    let text = example_text("figure_9_9");
    let scene = Scene::parse(&text).unwrap();
    let below = Scene::parse(&format!("\n\n{text}")).unwrap();
    assert_eq!(scene.data(), below.data());
    assert_eq!(Scene::from_data(scene.data()).unwrap().data(), scene.data());
    let mut other = scene.data().clone();
    other.objects_mut()[0].name = Some("Other".to_owned());
    assert_ne!(&other, scene.data());
    let repeated = Scene::parse(
        "camera { eye (0, 2, 8)  lookat (0, 1, 0) }  sphere A for i < 2 { center (i, 1, 0) }",
    );
    let repeated = repeated.unwrap();
    let objects = &repeated.data().objects;
    assert!(objects[0].is_beside(&objects[1]) && objects[0] != objects[1]);
}

#[test]
fn a_repeated_object_gets_a_name_that_is_free() {
    let text = "camera { eye (0, 2, 8)  lookat (0, 1, 0) }
        sphere Ball for i < 2, j < 2 { center (i, j, 0) }  sphere Ball_1_0 { center (0, 5, 0) }";
    let scene = Scene::from_data(Scene::parse(text).unwrap().data()).unwrap();
    let names = scene
        .data()
        .objects
        .iter()
        .filter_map(|it| it.name.as_deref());
    let expected = ["Ball_0_0", "Ball_0_1", "Ball_1_0_", "Ball_1_1", "Ball_1_0"];
    assert!(names.eq(expected), "{scene}");

    let mut data = Scene::parse(text).unwrap().data().clone();
    let other = data.objects[0].clone().named("Other");
    data.objects_mut()[0] = other;
    let scene = Scene::from_data(&data).unwrap();
    assert_eq!(scene.data().objects[0].name.as_deref(), Some("Other"));
}

#[test]
fn mistakes_are_displayed_as_the_program_reports_them() {
    let wrong = example_text("figure_9_9").replace("radius 1", "radus -1");
    let folder = Folder::with([("scene", &wrong[..])]);
    let said = folder.run("check scene");
    let mistakes = Scene::parse(&wrong).unwrap_err();
    assert_eq!(format!("{mistakes}\n"), said.errors);
    assert_eq!(format!("{mistakes:?}\n"), said.errors);
    assert_eq!(mistakes.len(), 1);
    let all: Vec<pinhole::Diagnostic> = mistakes.clone().into_iter().collect();
    assert!(all.iter().eq(mistakes.iter()));
    let set = Scene::parse(&example_text("figure_9_9")).unwrap();
    let said = set.with_set("camera.rol=8deg").unwrap_err().to_string();
    assert!(said.contains("did you mean `roll`"), "{said}");
}

#[test]
fn a_later_setting_replaces_an_earlier_one_of_the_same_target() {
    let scene = Scene::parse(
        "let h = 1
        camera { eye (0, 2, 8)  lookat (0, 1, 0) }
        box B { min (0, 0, 0)  max (1, h, 1) }",
    );
    let scene = scene.unwrap();
    let texts = |scene: &Scene| {
        let sets = scene.sources().sets.iter();
        sets.map(|set| format!("{}: {}", set.name(), set.text()))
            .collect::<Vec<_>>()
    };
    let mut frame = scene.clone();
    for step in 1..=3 {
        let h = format!("h={step}");
        let eye = format!("camera.eye=(0, {step}, 9)");
        frame = frame.with_set(&h).unwrap().with_set(&eye).unwrap();
    }
    assert_eq!(
        texts(&frame),
        ["--set #1: h=3", "--set #2: camera.eye=(0, 3, 9)"]
    );
    // Adding settings one by one must give the same scene as reading the text with all of them at
    // once.
    let steps = [
        "B.center=(5, 5, 5)",
        "B.size=(2, 2, 2)",
        "camera.direction=(0, 0, -1)",
        " B . center = (6, 5, 5)",
        "h=2",
        "camera.lookat=(0, 0, 0)",
        "B.size=(1, 2, 3)",
        "camera.direction=(0, 1, -1)",
    ];
    let sizes = ["B.center=(0, 0, 0)", "B.size=(1, 1, 1)"];
    let start = scene.with_sets(sizes).unwrap();
    let one_by_one = steps
        .iter()
        .fold(start.clone(), |scene, set| scene.with_set(set).unwrap());
    let all = Sources::new(scene.sources().file.clone());
    let all = pinhole::scene::read(&all.with_sets(sizes).with_sets(steps)).scene;
    assert_eq!(one_by_one.data(), &all.unwrap());
    assert_eq!(one_by_one.data(), start.with_sets(steps).unwrap().data());
    assert_eq!(texts(&one_by_one).len(), 5);
    let wrong = scene
        .with_sets(["camera.near=-1", "camera.rol=2deg"])
        .unwrap_err();
    assert_eq!(wrong.iter().count(), 2, "{wrong}");
}

#[test]
fn a_scene_is_read_from_a_file_or_a_picture() {
    let wrong = example_text("figure_9_9").replace("radius 1", "radus 1");
    let folder = Folder::with([
        ("a.scn", &example_text("figure_9_9")[..]),
        ("wrong.scn", &wrong),
    ]);
    let scene = Scene::open(folder.path("a.scn")).unwrap();
    let sets = ["image.width=8", "image.height=4", "camera.roll=8deg"];
    let rolled = scene.with_sets(sets).unwrap();
    let picture = rolled.render().unwrap();
    picture.save(folder.path("a.png")).unwrap();
    picture.save(folder.path("a.exr")).unwrap();
    let opened = Picture::open(folder.path("a.png")).unwrap();
    for again in [
        Scene::open(folder.path("a.png")),
        opened.scene(),
        picture.scene(),
    ] {
        assert_eq!(again.unwrap().data(), rolled.data());
    }
    assert_eq!(picture.pixel(7, 3), *picture.pixels().last().unwrap());
    let object = |name: &str| scene.data().object(name).map(|it| it.name.clone().unwrap());
    assert_eq!(object("Ball").as_deref(), Some("Ball"));
    assert_eq!(object("Bell"), None);

    let error = Scene::open(folder.path("wrong.scn"))
        .unwrap_err()
        .to_string();
    let path = folder.path("wrong.scn");
    assert!(error.contains(path.to_str().unwrap()), "{error}");
    let other = Picture::open(folder.path("a.exr")).unwrap();
    let told = other.scene().unwrap_err().to_string();
    assert_eq!(told, "the picture carries no scene");
    let error = Scene::open(folder.path("none.scn")).unwrap_err();
    let told = error.to_string();
    assert!(
        told.ends_with("none.scn: there is no such file or folder"),
        "{told}"
    );
}

#[test]
fn errors_name_the_file_and_the_reason() {
    let folder = Folder::with([("text.png", "camera {}"), ("a.pdf", "%PDF-1.7")]);
    let scene = Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }").unwrap();
    let picture = scene.with_set("image.width=4").unwrap().render().unwrap();
    let path = |name: &str| folder.path(name);
    let told = |error: Error| error.to_string().replace(path("").to_str().unwrap(), "");
    for (error, expected) in [
        (
            picture.save(path("a.jpg")).unwrap_err(),
            "cannot write to a.jpg: a picture's file ends in .png or .exr",
        ),
        (
            picture.save(path("none/a.png")).unwrap_err(),
            "cannot write to none/a.png: there is no such folder",
        ),
        (
            Picture::open(path("none.png")).unwrap_err(),
            "cannot read none.png: there is no such file or folder",
        ),
        (
            Picture::open(path("text.png")).unwrap_err(),
            "cannot read text.png: it is no picture in PNG",
        ),
        (
            Picture::open(path("a.pdf")).unwrap_err(),
            "cannot read a.pdf: it is no picture, but a PDF: use the picture in it, as a PNG",
        ),
    ] {
        let told = told(error);
        assert!(told.starts_with(expected), "{told}");
    }
}

#[test]
fn colours_and_methods_are_read_as_the_language_writes_them() {
    for (text, expected) in [
        ("olive", "#808000"),
        ("#fa0", "#ffaa00"),
        ("rgb(255, 165, 0)", "#ffa500"),
        ("OLIVE", "#808000"),
    ] {
        assert_eq!(text.parse::<Color>().unwrap().to_string(), expected);
    }
    for (text, part) in [
        ("oliv", "did you mean `olive`"),
        ("2", "a colour is wanted, and this is a number"),
        ("rgb(300, 0, 0)", "300"),
        ("olive teal", "teal"),
        ("", "colour"),
        ("#ff", "#ff"),
        ("let", "let"),
    ] {
        let told = text.parse::<Color>().unwrap_err().to_string();
        assert!(told.contains(part), "{text}: {told}");
    }
    assert!(Method::ALL.starts_with(&Method::SAMPLED));
    assert_eq!(Method::ALL.len(), pinhole::schema::METHODS.len());
    for method in Method::ALL {
        assert_eq!(method.to_string().parse::<Method>(), Ok(*method));
    }
    let told = "jitter".parse::<Method>().unwrap_err().to_string();
    assert!(
        told.starts_with("there is no method `jitter`; the methods are"),
        "{told}"
    );
}

#[test]
fn the_two_example_programs_do_what_they_say() {
    let folder = Folder::with([]);
    dolly_zoom::dolly_zoom(&folder.path("")).unwrap();
    let table = fs::read_to_string(folder.path("errors.csv")).unwrap();
    let errors = table.lines().skip(1).map(|line| {
        let error = line.rsplit(',').next().unwrap();
        error.parse::<f64>().unwrap()
    });
    let errors: Vec<f64> = errors.collect();
    assert!(
        errors.iter().all(|error| (0.001..0.1).contains(error)),
        "{table}"
    );
    for (frame, _) in errors.iter().enumerate() {
        let picture = Picture::open(folder.path(&format!("frame_{frame}.png"))).unwrap();
        assert_eq!((picture.width(), picture.height()), (320, 180));
    }

    let text = "camera { eye (0, 2, 8)  lookt (0, 1, 0) }  checkerboard {}";
    let found = problems_as_json::problems(text);
    assert_eq!(found[0]["line"], 1, "{found:#}");
    assert_eq!(found[0]["column"], 25);
    assert_eq!(found[0]["instead"], "write `lookat`");
    let right = problems_as_json::problems(&example_text("figure_9_9"));
    assert_eq!(right, serde_json::json!([]));
}
