//! Tests of the command `figure`: the bytes of some figures, rules for all figures, and refused
//! arguments.
//!
//! `PINHOLE_BLESS=1 cargo test figure` writes the current figures into `tests/figures` and
//! `docs/handout`. Before you commit them, look at them on a light and on a dark background, and at
//! a small size.

use std::path::Path;

use glam::DVec2;
use pinhole::figure::{Choice, KINDS, Kind, figure};

use crate::{
    generated::{Numbers, generated},
    program::Folder,
    scenes::{example_names, example_text, read, read_with},
    snapshot::assert_file,
};

/// Draws a figure of an example with the default options.
fn drawn(example: &str, kind: Kind, sets: &[&str]) -> Result<String, String> {
    let scene = read_with(&example_text(example), sets.iter().copied());
    figure(&scene, kind, Choice::default())
}

/// Compares figures with stored files. Figures that the handout shows are stored beside its pages,
/// and all other figures in `tests/figures`.
#[test]
fn figures_keep_their_bytes() {
    const VERTICES: [&str; 3] = [
        "Sail.v0=(0, 0, 0)",
        "Sail.v1=(2, 0, 0)",
        "Sail.v2=(1, 1, 1)",
    ];
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut expected = Vec::new();
    for (file, example, kind, sets) in [
        ("docs/handout/camera", "figure_9_9", Kind::Camera, &[][..]),
        ("docs/handout/methods", "figure_9_9", Kind::Methods, &[]),
        ("docs/handout/pixel", "figure_9_9", Kind::Pixel, &[]),
        (
            "docs/handout/roll",
            "figure_9_9",
            Kind::Roll,
            &["camera.roll=20deg"],
        ),
        (
            "docs/handout/triangle",
            "figure_9_9",
            Kind::Triangle,
            &["Sail.spin=50deg"],
        ),
        (
            "tests/figures/camera_down",
            "straight_down",
            Kind::Camera,
            &[],
        ),
        (
            "tests/figures/methods_12",
            "figure_9_9",
            Kind::Methods,
            &["sampler.per_pixel=12"],
        ),
        (
            "tests/figures/pixel_exact",
            "figure_9_9",
            Kind::Pixel,
            &["sampler.method=exact"],
        ),
        (
            "tests/figures/triangle_vertices",
            "figure_9_9",
            Kind::Triangle,
            &VERTICES,
        ),
    ] {
        let figure = drawn(example, kind, sets).unwrap();
        assert_file(&root.join(format!("{file}.svg")), &figure);
        expected.extend(
            file.strip_prefix("tests/figures/")
                .map(|name| format!("{name}.svg")),
        );
    }
    assert_eq!(crate::program::names(&root.join("tests/figures")), expected);
}

/// Returns each text of a figure with its bounding box. The box is computed with the letter width
/// that the program assumes.
fn texts(svg: &str) -> Vec<(String, [DVec2; 2])> {
    let mut found = Vec::new();
    for element in svg.split("<text ").skip(1) {
        let attribute = |name: &str| {
            let (_, rest) = element.split_once(&format!(" {name}=\"")).unwrap();
            rest.split('"').next().unwrap()
        };
        let number = |name: &str| attribute(name).parse::<f64>().unwrap();
        let (_, text) = element.split_once('>').unwrap();
        let (text, _) = text.split_once("</text>").unwrap();
        let text = text.replace("<tspan>", "").replace("</tspan>", "");
        let width = 10.0 * text.chars().count() as f64;
        let left = match attribute("text-anchor") {
            "start" => 0.0,
            "middle" => -0.5 * width,
            _ => -width,
        };
        let min = DVec2::new(number("x") + left, number("y") - 15.0);
        found.push((text, [min, min + DVec2::new(width, 18.0)]));
    }
    found
}

#[test]
fn texts_lie_in_the_figure_and_none_upon_another() {
    let mut count = 0;
    for example in example_names() {
        for (name, kind) in KINDS {
            let Ok(svg) = drawn(&example, kind, &["camera.roll=20deg"]) else {
                assert_eq!(kind, Kind::Triangle, "{example}");
                continue;
            };
            let what = format!("{example}, {}", name);
            for part in [
                "<title id=",
                "<desc id=",
                "role=\"img\"",
                "prefers-color-scheme:dark",
            ] {
                assert!(svg.contains(part), "{what}: {part}");
            }
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{what}");
            let (_, view) = svg.split_once("viewBox=\"").unwrap();
            let numbers = view.split(['"', ' ']).take(4);
            let numbers = numbers.map(|number| number.parse::<f64>().unwrap());
            let view: Vec<f64> = numbers.collect();
            let corner = DVec2::new(view[0], view[1]);
            let size = DVec2::new(view[2], view[3]);
            let texts = texts(&svg);
            count += texts.len();
            for (at, (text, [min, max])) in texts.iter().enumerate() {
                assert!(
                    min.cmpge(corner).all() && max.cmple(corner + size).all(),
                    "{what}: {text}"
                );
                for (other, [from, to]) in &texts[..at] {
                    let is_upon = min.cmplt(*to).all() && max.cmpgt(*from).all();
                    assert!(!is_upon, "{what}: {text} upon {other}");
                }
            }
        }
    }
    assert!(count > 500, "{count}");
}

/// Tests that the description, which screen readers read, names the pixel that is drawn.
#[test]
fn a_figure_says_what_it_draws() {
    for sets in [&[][..], &["image.width=1", "image.height=1"]] {
        let svg = drawn("figure_9_9", Kind::Pixel, sets).unwrap();
        let (_, rest) = svg.split_once("Pixel (").unwrap();
        let (pixel, _) = rest.split_once(')').unwrap();
        assert!(svg.contains(&format!(">pixel ({pixel}), ")), "{svg}");
    }
}

#[test]
fn the_figure_of_the_camera_always_has_the_object_that_the_ray_meets() {
    // The figure draws at most 60 objects. The triangle is listed after 101 spheres, but must be
    // drawn, because the ray meets it. One of the spheres is behind the eye.
    let scene = read(
        "camera { eye (0, 1, 5) lookat (0, 1, 0) } sphere Behind { center (0, 1, 8) radius 0.5 }
sphere for i < 100 { center (i / 20 - 2.5, 3, 0) radius 0.1 } triangle Sail { centroid (0, 1, 0) normal (0, 0, 1) color red }",
    );
    let figure = figure(&scene, Kind::Camera, Choice::default()).unwrap();
    let texts: Vec<String> = texts(&figure).into_iter().map(|(text, _)| text).collect();
    for text in [
        "Sail, t = 5.01",
        "behind the eye",
        "60 of 102 objects are drawn.",
    ] {
        assert!(texts.iter().any(|it| it == text), "{text}: {texts:?}");
    }
    // The triangle `Sail` is drawn twice: in space, and as it appears in the picture.
    assert_eq!(figure.matches("fill:#ff0000").count(), 2);
}

#[test]
fn a_window_that_is_too_small_to_be_seen_is_said_to_be() {
    let figure = drawn("figure_9_9", Kind::Camera, &["camera.d=1000"]).unwrap();
    assert!(
        figure.contains(">window, too small to be seen here<"),
        "{figure}"
    );
}

#[test]
fn every_scene_has_figures_that_are_drawn_in_finite_numbers() {
    for numbers in [Numbers::MultiplesOf(0.5), Numbers::Wild(30)] {
        for (text, scene) in generated(numbers, [9, 7], 3).take(12) {
            for (_, kind) in KINDS {
                match figure(&scene, kind, Choice::default()) {
                    Ok(figure) => assert!(!figure.contains("NaN"), "{text}"),
                    Err(_) => assert_eq!(kind, Kind::Triangle, "{text}"),
                }
            }
        }
    }
}

#[test]
fn the_pixel_of_a_plain_picture_is_its_middle() {
    let scene = read("image { width 9 height 5 } camera { eye (0, 1, 5) direction (0, 0, 1) }");
    let figure = figure(&scene, Kind::Pixel, Choice::default()).unwrap();
    assert!(figure.contains("pixel (4, 2)"), "{}", figure);
}

#[test]
fn what_cannot_be_drawn_is_told_with_a_way_out() {
    let folder = Folder::with([(
        "a.scn",
        "image { width 32 height 18 } camera { eye (0, 1, 8) lookat (0, 1, 0) } sphere Ball { center (0, 1, 0) }",
    )]);
    folder.write("b.scn", "camera { eye (0, 1, 8) lookat (0, 1, 0) } sphere Ball { center (0, 1, 0) } triangle Sail { centroid (0, 1, 0) normal (0, 0, 1) }");
    for (line, status, told) in [
        ("figure camera a.scn -o a.png", 2, "should end in .svg"),
        ("figure camera none.scn", 2, "there is no such file"),
        (
            "figure camera a.scn -o no/a.svg",
            2,
            "there is no such folder",
        ),
        ("figure camara a.scn", 2, "'camera'"),
        ("figure camera a.scn --set Ball.radus=2", 1, "radius"),
        (
            "figure triangle a.scn",
            2,
            "the scene has no triangle: draw camera, pixel, roll or methods, or add one",
        ),
        (
            "figure triangle b.scn --object Sial",
            2,
            "did you mean `Sail`?",
        ),
        (
            "figure triangle b.scn --object Ball",
            2,
            "no triangle is named `Ball`: without `--object`, the first one is drawn",
        ),
        (
            "figure pixel a.scn --pixel 32,0",
            2,
            "X goes from 0 to 31, Y from 0 to 17",
        ),
        ("figure pixel a.scn --pixel 3", 2, "as in `200,150`"),
        (
            "figure roll a.scn --pixel 3,3",
            2,
            "`--pixel` is for the figures camera, pixel and methods",
        ),
        (
            "figure camera a.scn --object Ball",
            2,
            "`--object` is for the figure triangle",
        ),
        (
            "figure methods a.scn --set sampler.per_pixel=4096",
            2,
            "`--set sampler.per_pixel=16`",
        ),
        (
            "figure roll a.scn -o roll.svg",
            0,
            "`--set camera.roll=20deg`",
        ),
    ] {
        let said = folder.run(line);
        assert_eq!(said.status, status, "{line}: {}", said.errors);
        assert!(said.errors.contains(told), "{line}: {}", said.errors);
    }
    // The figure on standard output has the same bytes as the figure in a file.
    folder.done("figure camera a.scn -o camera.svg");
    for line in ["figure camera a.scn", "figure camera a.scn -o -"] {
        assert_eq!(
            folder.done(line).text().as_bytes(),
            folder.read("camera.svg")
        );
    }
    assert_eq!(folder.names(), ["a.scn", "b.scn", "camera.svg", "roll.svg"]);
}

/// A pixel with several colours is found wherever in the picture it is.
#[test]
fn the_whole_picture_is_searched_for_a_pixel_with_an_edge() {
    for (width, height) in [(160, 90), (100, 60), (400, 179), (128, 77), (65, 91)] {
        // The box is small and appears in the lower right corner of the picture. At the box's
        // depth, the picture is 4 m high.
        let aspect = f64::from(width) / f64::from(height);
        let (x, y) = (2.0 * aspect - 0.07, -2.0 + 0.07);
        let scene = read(&format!(
            "image {{ width {width} height {height} }} camera {{ eye (0, 0, 10) lookat (0, 0, 0) d 10 view_height 4 }}
            box {{ center ({x}, {y}, 0) size (0.1, 0.1, 0.1) }}"
        ));
        let svg = figure(&scene, Kind::Pixel, Choice::default()).unwrap();
        assert!(svg.contains("box ("), "{width} × {height}: {svg}");
    }
}
