//! Mistakes that noise nearly hides, or that move the picture by a part of a pixel; and noise that looks like one.

use std::fs;

use image::{ImageBuffer, Rgb};
use pinhole::color::srgb_to_linear;
use serde_json::Value;
use tempfile::TempDir;

use super::{diff, folder, json, mistake, open, pinhole, render, save};
use crate::effort::{Effort, sampled_and_exhaustive};

/// No checkerboard, so that little but the mistake differs.
const PLAIN: &str = "image { width 200 height 200 background white }
camera { eye (4, 5, 6) lookat (0, 0, 0) roll -20deg fov 50deg }
sampler { method exact }
sphere Ball { center (-1, 0.5, 1) radius 0.7 color purple }
box Crate { center (1, 0, 0) size (1, 2, 1) color orange }
triangle Sail { centroid (-1, 1.2, -1) normal (0.3, 0.2, 1) sides (1.5, 2, 2) color teal }
";

/// Edges along rows and columns, each in the same place of all its pixels.
const LEVEL: &str = "image { width 100 height 76 background skyblue }
camera { eye (0, 1.5, 8) lookat (0, 1.5, 0) d 2 }
sampler { method exact }
box Tall { center (-1.3, 1.5, 0) size (1, 2.3, 1) color blue }
box Wide { center (1.21, 1.1, 0.2) size (1.4, 1, 1) color orange }
sphere { center (0.1, 2.2, -1) radius 0.6 color red }
";

fn plain(scene: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.scn"), scene).unwrap();
    folder
}

fn sampled(folder: &TempDir, method: &str, samples: u64, sets: &[&str]) {
    let sampler = [
        format!("sampler.method={method}"),
        format!("sampler.per_pixel={samples}"),
    ];
    let mut arguments = vec!["-o", "b.png"];
    let all = sampler
        .iter()
        .map(String::as_str)
        .chain(sets.iter().copied());
    all.for_each(|set| arguments.extend(["--set", set]));
    render(folder, &arguments);
}

fn first(folder: &TempDir, sets: &[&str]) -> [String; 2] {
    let sets: Vec<_> = sets.iter().flat_map(|set| ["--set", *set]).collect();
    let found = json(folder, &[&["b.png", "a.scn"], &sets[..]].concat());
    ["mistake", "message"].map(|key| {
        found["likely"][0][key]
            .as_str()
            .unwrap_or("none")
            .to_owned()
    })
}

#[test]
#[ignore = "exhaustive"]
fn light_that_is_wrong_in_a_turned_picture_is_seen_through_noise() {
    let folder = folder();
    for (method, samples) in [("random", 4), ("regular", 1)] {
        sampled(&folder, method, samples, &[]);
        let picture = open(&folder, "b.png").to_rgb8();
        let decoded = |byte: u8| (255.0 * srgb_to_linear(f64::from(byte) / 255.0)).round() as u8;
        let (width, height) = picture.dimensions();
        let turned = ImageBuffer::from_fn(width, height, |x, y| {
            Rgb(picture.get_pixel(x, height - 1 - y).0.map(decoded))
        });
        save(&folder, "b.png", turned);
        let [mistake, message] = first(&folder, &[]);
        assert_eq!(mistake, "upside_down", "{method}");
        assert!(
            message.contains("; and the colours are too dark"),
            "{method}: {message}"
        );
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_mistake_within_the_noise_is_no_noise() {
    let folder = folder();
    let size = ["image.width=240", "image.height=160"];
    for (set, words) in [
        ("Ball.radius=1.04", "is 1.04 times as large"),
        (
            "Ball.center=(-1.53, 1, 0)",
            "is in a wrong place: as if the x",
        ),
    ] {
        for samples in [4, 16] {
            sampled(&folder, "random", samples, &[&size[..], &[set]].concat());
            let [mistake, message] = first(&folder, &size);
            assert!(
                mistake.starts_with("object_"),
                "{set}, {samples}: {message}"
            );
            let expected = format!("the sphere `Ball` {words}");
            assert!(
                message.starts_with(&expected),
                "{set}, {samples}: {message}"
            );
        }
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_mistake_of_part_of_a_pixel_is_named() {
    let folder = plain(PLAIN);
    for (set, expected) in [
        ("camera.roll=-19deg", "roll"),
        ("Ball.radius=0.721", "object_size"),
        ("Ball.radius=0.735", "object_size"),
        ("Ball.center=(-1, 0.45, 1)", "object_place"),
        ("Sail.centroid=(-0.95, 1.2, -1)", "object_place"),
    ] {
        render(&folder, &["-o", "b.png", "--set", set]);
        assert_eq!(mistake(&folder), expected, "{set}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn right_pictures_of_all_methods_are_noise() {
    let folders = [plain(PLAIN), plain(LEVEL), folder()];
    for folder in &folders {
        for method in [
            "regular",
            "random",
            "jittered",
            "n_rooks",
            "multi_jittered",
            "hammersley",
            "halton",
            "sobol",
            "scatter",
        ] {
            for samples in [4, 1, 3, 16] {
                sampled(folder, method, samples, &[]);
                let expected = match (method, samples) {
                    ("regular", 1) => "sample_at_center",
                    _ => "noise",
                };
                assert_eq!(mistake(folder), expected, "{method}, {samples}");
            }
        }
    }
}

#[test]
fn pixels_without_samples_are_told_of() {
    let folder = plain(PLAIN);
    sampled(&folder, "scatter", 1, &[]);
    let (_, text) = diff(&folder, &["b.png", "a.scn"]);
    assert!(
        text.contains("about 1 random sample per pixel, and of one colour where no sample fell"),
        "{text}"
    );
}

sampled_and_exhaustive!(gamma_is_named_through_noise);

fn gamma_is_named_through_noise(effort: Effort) {
    let decode = |c: f64| match c <= 0.04045 {
        true => c / 12.92,
        false => libm::pow((c + 0.055) / 1.055, 2.4),
    };
    let encode = |c: f64| match c <= 0.0031308 {
        true => 12.92 * c,
        false => 1.055 * libm::pow(c, 1.0 / 2.4) - 0.055,
    };
    type Change = fn(f64) -> f64;
    let changes: [(Change, &str); 2] = [(decode, "not_encoded"), (encode, "encoded_twice")];
    let folders = [
        (plain(&PLAIN.replace("white", "skyblue")), ""),
        (folder(), "image.background=skyblue"),
    ];
    for (folder, set) in effort.of(&folders) {
        let sets: Vec<_> = [*set].into_iter().filter(|set| !set.is_empty()).collect();
        for samples in effort.of([1, 16]) {
            for (change, expected) in effort.of(changes) {
                sampled(folder, "multi_jittered", samples, &sets);
                let mut picture = open(folder, "b.png").to_rgb8();
                for byte in picture.iter_mut() {
                    *byte = (255.0 * change(f64::from(*byte) / 255.0)).round() as u8;
                }
                save(folder, "b.png", picture);
                let [mistake, message] = first(folder, &sets);
                assert_eq!(mistake, expected, "{samples}: {message}");
            }
        }
    }
}

#[test]
#[ignore = "exhaustive"]
fn an_object_that_is_off_in_another_way_is_named() {
    let folder = plain(PLAIN);
    for (set, expected) in [
        ("Sail.spin=25deg", "object_orientation"),
        ("Sail.normal=(-0.5, 0.2, 1)", "object_orientation"),
        // Three of its numbers at once.
        ("Crate.size=(1.2, 1.8, 1.5)", "object"),
    ] {
        let name = set.split('.').next().unwrap();
        render(&folder, &["-o", "b.png", "--set", set]);
        let [mistake, message] = first(&folder, &[]);
        assert_eq!(mistake, expected, "{set}: {message}");
        assert!(message.contains(name), "{message}");
        sampled(&folder, "multi_jittered", 16, &[set]);
        assert!(first(&folder, &[])[1].contains(name), "{message}");
    }
}

#[test]
fn coordinates_of_the_eye_that_are_exchanged_are_named() {
    let folder = folder();
    render(&folder, &["-o", "b.png", "--set", "camera.eye=(8, 3.5, 3)"]);
    assert_eq!(mistake(&folder), "eye_swapped");
}

#[test]
#[ignore = "exhaustive"]
fn a_picture_of_many_objects_is_judged() {
    let mut scene = "image { width 96 height 64 } camera { eye (0, 12, 30) lookat (0, 0, 0) fov 50deg } sampler { method exact }\n".to_owned();
    for i in 0..600 {
        let (x, z) = (f64::from(i % 30) - 15.0, f64::from(i / 30) - 10.0);
        let color = ["red", "lime", "blue", "white"][i as usize % 4];
        scene += &format!(
            "sphere s{i} {{ center ({x}, {}, {z}) radius 0.4 color {color} }}\n",
            (i * 7 % 11) as f64 / 5.0
        );
    }
    let folder = plain(&scene);
    sampled(&folder, "multi_jittered", 16, &[]);
    assert_eq!(mistake(&folder), "noise");
    for (set, expected) in [
        ("s404.radius=1.1", "`s404`"),
        ("camera.roll=2deg", "roll were 2 degrees instead of 0"),
        (
            "camera.fov=52deg",
            "a field of view of 52 degrees instead of 50",
        ),
        (
            "camera.fov=50.3deg",
            "a field of view of 50.3 degrees instead of 50",
        ),
    ] {
        assert!(
            pinhole(
                folder.path(),
                &["render", "a.scn", "-o", "b.png", "--set", set]
            )
            .status
            .success()
        );
        let [_, message] = first(&folder, &[]);
        assert!(message.contains(expected), "{set}: {message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn cameras_are_judged_by_any_lens_and_along_up() {
    let level = "eye (0, 1, 4) lookat (0, 1, 0) fov 40deg";
    for (camera, set, expected) in [
        (level, "camera.fov=44deg", "distance"),
        (level, "camera.roll=7deg", "roll"),
        (
            "eye (0, 6, 0) lookat (0, 0, 0) d 2",
            "camera.roll=7deg",
            "roll",
        ),
    ] {
        let folder = plain(&format!(
            "image {{ width 96 height 64 }} camera {{ {camera} }} sampler {{ method exact }}
             sphere Ball {{ center (0.7, 1, 0) radius 0.6 color olive }}
             checkerboard {{ square 1 }}"
        ));
        render(&folder, &["-o", "b.png", "--set", set]);
        // Of a camera that looks along up there is a warning.
        let output = pinhole(
            folder.path(),
            &["diff", "b.png", "a.scn", "--format", "json"],
        );
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(
            found["likely"][0]["mistake"], expected,
            "{camera}, {set}: {found}"
        );
    }
}

#[test]
#[ignore = "exhaustive"]
fn no_other_object_is_blamed_through_noise() {
    let folder = plain(PLAIN);
    for samples in [1, 4] {
        sampled(&folder, "random", samples, &["Sail.spin=25deg"]);
        let [_, message] = first(&folder, &[]);
        assert!(!message.contains("Ball"), "{samples}: {message}");
    }
}
