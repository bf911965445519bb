//! Mistakes of objects that look like others.

use std::fs;

use super::{SCENE, folder, json, open, render, save};
use crate::effort::{Effort, sampled_and_exhaustive};

/// The first mistake that is found in `b.png`, and what is said of it.
fn first(folder: &tempfile::TempDir) -> [String; 2] {
    let found = json(folder, &["b.png", "a.scn"]);
    let first = &found["likely"][0];
    ["mistake", "message"].map(|key| first[key].as_str().unwrap_or("none").to_owned())
}

sampled_and_exhaustive!(a_wrong_colour_is_named_where_others_have_the_right_one);

fn a_wrong_colour_is_named_where_others_have_the_right_one(effort: Effort) {
    let folder = tempfile::tempdir().unwrap();
    let other = "sphere Other { center (-0.2, 0.5, 2.5) radius 0.5 }\n";
    let third = "sphere Third { center (1.5, 2.4, -1) radius 0.6 }\n";
    fs::write(folder.path().join("a.scn"), [SCENE, other, third].concat()).unwrap();
    for name in effort.of(["Ball", "Other", "Third"]) {
        for method in effort.of(["exact", "multi_jittered"]) {
            let [color, method] = [
                format!("{name}.color=magenta"),
                format!("sampler.method={method}"),
            ];
            render(&folder, &["-o", "b.png", "--set", &color, "--set", &method]);
            let expected = format!("the sphere `{name}` has the colour #ff00ff instead of #808000");
            assert_eq!(first(&folder), ["color".to_owned(), expected], "{method}");
        }
    }
}

sampled_and_exhaustive!(a_colour_that_is_a_little_off_is_named_through_noise);

fn a_colour_that_is_a_little_off_is_named_through_noise(effort: Effort) {
    let folder = folder();
    for (set, name) in effort.of([
        ("Sail.color=#0080a0", "Sail"),
        ("Ball.color=#808030", "Ball"),
    ]) {
        let size = ["--set", "image.width=240", "--set", "image.height=160"];
        for (method, samples) in effort.of([("multi_jittered", "16"), ("random", "4")]) {
            let [method, samples] = [
                format!("sampler.method={method}"),
                format!("sampler.per_pixel={samples}"),
            ];
            let sets = ["--set", set, "--set", &method, "--set", &samples];
            render(&folder, &[&["-o", "b.png"], &size[..], &sets].concat());
            let found = json(&folder, &[&["b.png", "a.scn"], &size[..]].concat());
            let first = &found["likely"][0];
            assert_eq!(first["mistake"], "color", "{set}, {method}: {found:#}");
            let message = first["message"].as_str().unwrap();
            assert!(message.contains(name), "{set}, {method}: {message}");
        }
    }
}

#[test]
#[ignore = "exhaustive"]
fn only_what_grows_all_round_is_said_to() {
    let folder = folder();
    for (set, expected) in [
        (
            "Sail.sides=(2, 2, 2)",
            "the triangle `Sail` has a wrong size: as if its side c were 2 instead of 1",
        ),
        (
            "Crate.size=(0.5, 1.2, 2)",
            "the box `Crate` has a wrong size: as if its size along y were 1.2 instead of 1.5",
        ),
    ] {
        render(&folder, &["-o", "b.png", "--set", set]);
        assert_eq!(first(&folder)[1], expected);
    }
    render(&folder, &["-o", "b.png", "--set", "Ball.radius=1.3"]);
    let [_, message] = first(&folder);
    assert!(message.ends_with("pixels larger all round"), "{message}");
}

#[test]
#[ignore = "exhaustive"]
fn a_size_that_is_off_by_some_pixels_is_measured() {
    let folder = folder();
    let size = ["--set", "image.width=240", "--set", "image.height=160"];
    for radius in ["0.85", "0.8"] {
        let set = format!("Ball.radius={radius}");
        render(
            &folder,
            &[&["-o", "b.png", "--set", &set], &size[..]].concat(),
        );
        let found = json(&folder, &[&["b.png", "a.scn"], &size[..]].concat());
        let message = found["likely"][0]["message"].as_str().unwrap_or("none");
        let words = format!("`Ball` is {radius} times as large as it should be");
        assert!(message.contains(&words), "{message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_triangle_that_is_turned_is_said_to_be() {
    let folder = folder();
    let size = ["--set", "image.width=240", "--set", "image.height=160"];
    for (set, expected) in [
        (
            "Sail.spin=10deg",
            "the triangle `Sail` is spun wrongly: as if its spin were 10 degrees instead of 0",
        ),
        (
            "Sail.spin=-35deg",
            "the triangle `Sail` is spun wrongly: as if its spin were -35 degrees instead of 0",
        ),
        (
            "Sail.normal=(0.3, 0.4, 1)",
            "the triangle `Sail` faces a wrong way: as if the y of its normal were 0.4 instead of 0",
        ),
        (
            "Sail.normal=(0.7, 0, 1)",
            "the triangle `Sail` faces a wrong way: as if the x of its normal were 0.7 instead of 0.3",
        ),
        (
            "Sail.sides=(1.7, 2, 1)",
            "the triangle `Sail` has a wrong size: as if its side a were 1.7 instead of 2",
        ),
    ] {
        render(
            &folder,
            &[&["-o", "b.png", "--set", set], &size[..]].concat(),
        );
        let found = json(&folder, &[&["b.png", "a.scn"], &size[..]].concat());
        let message = found["likely"][0]["message"].as_str().unwrap_or("none");
        assert!(message.starts_with(expected), "{set}: {message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_triangle_with_equal_sides_is_spun_by_the_least() {
    let folder = folder();
    let scene = SCENE.replace("sides (2, 2, 1)", "sides (2, 2, 2)");
    fs::write(folder.path().join("a.scn"), scene).unwrap();
    for spin in ["10", "-10", "25"] {
        let set = format!("Sail.spin={spin}deg");
        render(&folder, &["-o", "b.png", "--set", &set]);
        let expected = format!(
            "the triangle `Sail` is spun wrongly: as if its spin were {spin} degrees instead of 0"
        );
        let [_, message] = first(&folder);
        assert!(message.starts_with(&expected), "{message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn edges_that_are_a_step_or_two_off_are_no_object() {
    let folder = folder();
    let right = open(&folder, "a.png").to_rgb8();
    let orange = [255, 165, 0];
    for by in [1, 2] {
        let mut picture = right.clone();
        for (x, y, pixel) in picture.enumerate_pixels_mut() {
            // At the left and the right edge of the box.
            let beside = |x: u32| right.get_pixel_checked(x, y).is_some_and(|p| p.0 != orange);
            if pixel.0 == orange && (beside(x.wrapping_sub(1)) || beside(x + 1)) {
                pixel.0 = orange.map(|byte: u8| byte.saturating_sub(by).max(by));
            }
        }
        save(&folder, "b.png", picture);
        let [mistake, message] = first(&folder);
        assert_ne!(mistake, "object_extra", "{by}: {message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn an_object_that_is_not_in_the_scene_is_nobody_elses_fault() {
    let folder = folder();
    for (text, color) in [
        ("sphere { center (0.9, 0.4, 1.8) radius 0.4 }\n", "#808000"),
        ("box { center (-0.6, 0.4, 2.6) }\n", "#ffa500"),
    ] {
        fs::write(folder.path().join("b.scn"), [SCENE, text].concat()).unwrap();
        let output = super::pinhole(folder.path(), &["render", "b.scn"]);
        assert!(output.status.success(), "{output:?}");
        let [mistake, message] = first(&folder);
        assert_eq!(mistake, "object_extra", "{message}");
        let expected =
            format!("something of the colour {color}, where nothing that has it should be");
        assert!(message.starts_with(&expected), "{message}");
    }
}

/// What is seen beyond an edge along a pixel's side is what a sample at the corner sees. No single corner sees it on all sides of a box.
#[test]
#[ignore = "exhaustive"]
fn what_grows_beyond_the_sides_of_pixels_is_no_sample() {
    let folder = folder();
    let scene = "image { width 96 height 64 }
camera { eye (0, 0, 10) lookat (0, 0, 0) view_height 64 d 10 }
box Plate { min (-20, -10, -1) max (10, 20, 0) color orange }
";
    fs::write(folder.path().join("a.scn"), scene).unwrap();
    for (set, method) in [("camera.d=10.1", "exact"), ("camera.d=10.1", "jittered")] {
        let method = format!("sampler.method={method}");
        render(&folder, &["-o", "b.png", "--set", set, "--set", &method]);
        let found = json(&folder, &["b.png", "a.scn"]);
        let first = &found["likely"][0];
        let mistakes = ["distance", "object_place", "object_size", "eye"];
        let mistake = first["mistake"].as_str().unwrap_or("none");
        assert!(mistakes.contains(&mistake), "{method}: {found:#}");
    }
}
