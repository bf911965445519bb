//! Numbers that are some others: of the camera, of the checkerboard, of an object, several at once.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use super::{SCENE, folder, json, pinhole, render};

fn verdict(folder: &TempDir) -> (String, String, Value) {
    let found = json(folder, &["b.png", "a.scn"]);
    let first = &found["likely"][0];
    let text = |key: &str| first[key].as_str().unwrap_or("none").to_owned();
    (text("mistake"), text("message"), first["off"].clone())
}

/// The first verdict on the picture of the scene with these overrides.
fn first(folder: &TempDir, sets: &[&str]) -> (String, String, Value) {
    let sets = sets.iter().flat_map(|set| ["--set", *set]);
    let arguments: Vec<_> = ["-o", "b.png"].into_iter().chain(sets).collect();
    render(folder, &arguments);
    verdict(folder)
}

#[test]
#[ignore = "exhaustive"]
fn several_coordinates_of_the_eye_are_named() {
    let folder = folder();
    for (set, words) in [
        (
            "camera.eye=(3.6, 4.2, 9.6)",
            "as if eye were (3.6, 4.2, 9.6) instead of (3, 3.5, 8), 1.2 times as large",
        ),
        (
            "camera.eye=(4.4, 4.85, 12)",
            "instead of (3, 3.5, 8), 1.5 times as far from lookat",
        ),
        (
            "camera.eye=(2.2, 3.9, 8.5)",
            "as if eye were (2.2, 3.9, 8.5)",
        ),
    ] {
        let (mistake, message, _) = first(&folder, &[set]);
        assert_eq!(mistake, "eye", "{set}: {message}");
        assert!(message.contains(words), "{set}: {message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn coordinates_that_are_off_by_little_are_all_named() {
    let folder = folder();
    for (set, words) in [
        (
            "camera.eye=(3.004, 3.503, 8)",
            "eye were (3.004, 3.503, 8) instead",
        ),
        (
            "camera.eye=(3.006, 3.5, 8.005)",
            "eye were (3.006, 3.5, 8.005) instead",
        ),
        (
            "camera.lookat=(0.203, 0.796, 0)",
            "lookat were (0.203, 0.796, 0) instead",
        ),
    ] {
        let (_, message, _) = first(&folder, &[set]);
        assert!(message.contains(words), "{set}: {message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn one_thing_is_said_of_one_object() {
    let folder = folder();
    for set in ["Ball.center=(-1.3, 1, 0)", "Crate.center=(2.2, 0.75, -0.5)"] {
        render(&folder, &["-o", "b.png", "--set", set]);
        let found = json(&folder, &["b.png", "a.scn"]);
        assert_eq!(found["likely"].as_array().unwrap().len(), 1, "{found:#}");
        let message = found["likely"][0]["message"].as_str().unwrap();
        // One coordinate explains it, and so is the simplest.
        assert!(message.contains("the x of its middle"), "{message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_picture_of_few_rows_is_no_trap() {
    let folder = folder();
    let sizes = ["--set", "image.width=300", "--set", "image.height=3"];
    let eye = ["-o", "b.png", "--set", "camera.eye=(3.3, 3.7, 8)"];
    render(&folder, &[&eye[..], &sizes].concat());
    let found = json(&folder, &[&["b.png", "a.scn"], &sizes[..]].concat());
    let message = found["likely"][0]["message"].as_str().unwrap_or("none");
    assert!(
        message == "none" || message.contains("eye were (3.3, 3.7, 8) "),
        "{found:#}"
    );
}

#[test]
#[ignore = "exhaustive"]
fn a_camera_that_looks_elsewhere_is_named() {
    let folder = folder();
    for set in [
        "camera.lookat=(0.7, 1.1, 0)",
        "camera.lookat=(-0.9, 1.9, 0.4)",
    ] {
        let (mistake, message, _) = first(&folder, &[set]);
        assert_eq!(mistake, "lookat", "{set}: {message}");
        assert!(message.contains(" pixels from where"), "{set}: {message}");
    }
    let (mistake, message, _) = first(&folder, &["camera.direction=(-2.5, -2.6, -8)"]);
    assert_eq!(mistake, "lookat", "{message}");
}

#[test]
#[ignore = "exhaustive; `pairs` has a sample"]
fn two_fields_of_the_camera_are_named_and_no_other() {
    let folder = folder();
    let sets = ["camera.roll=16deg", "camera.d=2.4"];
    let (mistake, message, _) = first(&folder, &sets);
    assert_eq!(mistake, "camera", "{message}");
    for words in [
        "roll were 16 degrees instead of 10",
        "d were 2.4 instead of 2.75",
    ] {
        assert!(message.contains(words), "{message}");
    }
    for other in ["eye were", "lookat were"] {
        assert!(!message.contains(other), "{message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_checkerboard_elsewhere_is_named() {
    let folder = folder();
    for (board, expected, words) in [
        (
            "y -0.3",
            "board_height",
            "as if its y were -0.3 instead of 0",
        ),
        ("y 0.2", "board_height", "as if its y were 0.2 instead of 0"),
        ("square 1.1", "board_square", "the side 1.1 instead of 1"),
        ("square 0.85", "board_square", "the side 0.85 instead of 1"),
    ] {
        let text = SCENE.replace("checkerboard {}", &format!("checkerboard {{ {board} }}"));
        fs::write(folder.path().join("b.scn"), text).unwrap();
        assert!(
            pinhole(folder.path(), &["render", "b.scn"])
                .status
                .success()
        );
        let (mistake, message, _) = verdict(&folder);
        assert_eq!(mistake, expected, "{board}: {message}");
        assert!(message.contains(words), "{board}: {message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_checkerboard_that_begins_elsewhere_is_named() {
    let folder = folder();
    // All else is moved by half a square, and a quarter of one.
    let other = "image { width 96 height 64 background navy }
camera { eye (3.5, 3.5, 8.25) lookat (0.7, 0.8, 0.25) roll 10deg d 2.75 }
sampler { method exact }
sphere Ball { center (-1.1, 1, 0.25) }
triangle Sail { centroid (0.7, 1, 0.85) normal (0.3, 0, 1) sides (2, 2, 1) }
box Crate { center (2.5, 0.75, -0.25) }
checkerboard {}
";
    fs::write(folder.path().join("b.scn"), other).unwrap();
    assert!(
        pinhole(folder.path(), &["render", "b.scn"])
            .status
            .success()
    );
    let (mistake, message, _) = verdict(&folder);
    assert_eq!(mistake, "board_origin", "{message}");
    assert!(
        message.ends_with("as if they began at (-0.5, -0.25) instead of (0, 0)"),
        "{message}"
    );
}

/// Where a point is seen, in pixels from the middle to the right and down.
fn seen(folder: &TempDir, point: [f64; 3]) -> [f64; 2] {
    let output = pinhole(folder.path(), &["inspect", "a.scn", "--format", "json"]);
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let camera = &found["camera"];
    let number = |value: &Value| value.as_f64().unwrap();
    let along = |axis: &str| -> f64 {
        (0..3)
            .map(|i| (point[i] - number(&camera["eye"][i])) * number(&camera[axis][i]))
            .sum()
    };
    let pixels = 64.0 * number(&camera["d"]) / number(&camera["view_height"]) / -along("w");
    [along("u") * pixels, -along("v") * pixels]
}

#[test]
#[ignore = "exhaustive"]
fn an_object_in_a_wrong_place_is_off_by_pixels() {
    let folder = folder();
    let name = |set: &str| set.split('.').next().unwrap().to_owned();
    for (set, from, to) in [
        (
            "Ball.center=(-1.3, 1, 0)",
            [-1.6, 1.0, 0.0],
            [-1.3, 1.0, 0.0],
        ),
        (
            "Ball.center=(-1.3, 1.3, 0.6)",
            [-1.6, 1.0, 0.0],
            [-1.3, 1.3, 0.6],
        ),
        (
            "Crate.center=(2.3, 0.9, 0.2)",
            [2.0, 0.75, -0.5],
            [2.3, 0.9, 0.2],
        ),
        (
            "Sail.centroid=(0.5, 1.2, 0.1)",
            [0.2, 1.0, 0.6],
            [0.5, 1.2, 0.1],
        ),
    ] {
        let (mistake, message, off) = first(&folder, &[set]);
        assert_eq!(mistake, "object_place", "{set}: {message}");
        assert!(
            message.contains(&name(set)) && message.contains(" pixel"),
            "{message}"
        );
        let (from, to) = (seen(&folder, from), seen(&folder, to));
        for (key, expected) in [("right", to[0] - from[0]), ("down", to[1] - from[1])] {
            let found = off[key].as_f64().unwrap();
            assert!((found - expected).abs() < 0.1, "{set}: {expected}, {off}");
        }
    }
    let set = "Sail.spin=25deg";
    let (mistake, message, _) = first(&folder, &[set]);
    assert_eq!(mistake, "object_orientation", "{set}: {message}");
    assert!(
        message.contains("as if its spin were 25 degrees instead of 0"),
        "{message}"
    );
    // Three of its numbers at once.
    let set = "Crate.size=(1, 2.2, 1.5)";
    let (mistake, message, _) = first(&folder, &[set]);
    assert_eq!(mistake, "object", "{set}: {message}");
    assert!(message.contains(&name(set)), "{message}");
    let rest = message.split("or near it, in ").nth(1).unwrap();
    let pixels: u32 = rest.split(' ').next().unwrap().parse().unwrap();
    assert!(pixels >= 20, "{message}");
}

#[test]
#[ignore = "exhaustive"]
fn a_displaced_picture_is_named_through_noise() {
    let folder = folder();
    for method in ["random", "multi_jittered", "sobol"] {
        let method = format!("sampler.method={method}");
        // A column more on either side, of which one is left out: the middle is one pixel farther to the left.
        let sets = ["sampler.per_pixel=16", "image.width=98", &method];
        let sets: Vec<_> = sets.iter().flat_map(|set| ["--set", *set]).collect();
        render(
            &folder,
            &[&["-o", "b.png", "--crop", "2,0,96,64"], &sets[..]].concat(),
        );
        let (mistake, message, _) = verdict(&folder);
        assert_eq!(mistake, "shifted", "{method}: {message}");
        assert!(
            message.ends_with("displaced by 1 pixel to the left"),
            "{message}"
        );
    }
}

#[test]
#[ignore = "exhaustive"]
fn two_mistakes_at_once_are_no_other_one() {
    let folder = folder();
    // Of these none explains the picture, and what is said is true of it.
    for (sets, allowed) in [
        (
            ["Ball.center=(-1.3, 1, 0)", "Crate.color=red"],
            ["none", "none"],
        ),
        (["camera.roll=14deg", "Ball.color=red"], ["none", "roll"]),
    ] {
        let (mistake, message, _) = first(&folder, &sets);
        assert!(allowed.contains(&mistake.as_str()), "{sets:?}: {message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn planes_at_another_depth_are_named() {
    let folder = folder();
    for (set, right, expected, says) in [
        (
            "camera.far=9.7",
            None,
            "far",
            "which the scene does not have: as if far were 9.7",
        ),
        (
            "camera.far=9.7",
            Some("camera.far=12"),
            "far",
            "as if far were 9.7 instead of 12",
        ),
        (
            "camera.near=8.2",
            None,
            "near",
            "which the scene does not have: as if near were 8.2",
        ),
        (
            "camera.near=8.2",
            Some("camera.near=5.5"),
            "near",
            "as if near were 8.2 instead of 5.5",
        ),
    ] {
        render(&folder, &["-o", "b.png", "--set", set]);
        let right = right.map_or(Vec::new(), |set| vec!["--set", set]);
        let found = json(&folder, &[&["b.png", "a.scn"], right.as_slice()].concat());
        let first = &found["likely"][0];
        assert_eq!(first["mistake"], expected, "{set}: {found:#}");
        let message = first["message"].as_str().unwrap();
        assert!(message.contains(says), "{set}: {message}");
    }
}

/// Near the horizon no pixel has one colour, so that none is plainly wrong; and what is dark there adds up to as much as a curve brightens all edges.
#[test]
#[ignore = "exhaustive"]
fn rays_that_end_before_the_horizon_are_neither_noise_nor_gamma() {
    let folder = folder();
    let level = ["image.width=320", "image.height=180", "camera.roll=0deg"];
    let level: Vec<_> = level.iter().flat_map(|set| ["--set", set]).collect();
    for (far, sampler) in [
        (300.0, "method=jittered"),
        (1000.0, "method=multi_jittered"),
        (1000.0, "method=random"),
        (2000.0, "method=exact"),
    ] {
        let sets = [format!("camera.far={far}"), format!("sampler.{sampler}")];
        let sets: Vec<_> = sets.iter().flat_map(|set| ["--set", set]).collect();
        render(
            &folder,
            &[&["-o", "b.png"], sets.as_slice(), &level].concat(),
        );
        let found = json(&folder, &[&["b.png", "a.scn"], level.as_slice()].concat());
        let first = &found["likely"][0];
        assert_eq!(first["mistake"], "far", "{sets:?}: {found:#}");
        let message = first["message"].as_str().unwrap();
        // Noise moves it a little.
        let named = message.split("as if far were ").nth(1).unwrap();
        let named: f64 = named.parse().unwrap();
        assert!((named / far - 1.0).abs() < 0.1, "{sets:?}: {message}");
    }
}

/// As samples at the same places in all pixels may be, and as no single sample shows where one colour is seen.
#[test]
#[ignore = "exhaustive; `faint` has a sample"]
fn a_hundredth_of_a_pixel_without_noise_is_no_noise() {
    let folder = folder();
    let size = ["--set", "image.width=240", "--set", "image.height=136"];
    let set = ["--set", "camera.lookat=(0.201, 0.8, 0)"];
    render(&folder, &[&["-o", "b.png"], size.as_slice(), &set].concat());
    let found = json(&folder, &[&["b.png", "a.scn"], size.as_slice()].concat());
    let first = &found["likely"][0];
    assert_eq!(first["mistake"], "lookat", "{found:#}");
    let message = first["message"].as_str().unwrap();
    assert!(message.contains("its x were 0.201 "), "{message}");
}
