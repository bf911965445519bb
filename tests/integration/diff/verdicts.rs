//! A picture judged by a scene: right, right but for noise, or wrong, and by which mistake.

use std::fs;

use image::{Rgb, codecs::jpeg::JpegEncoder};
use serde_json::Value;

use super::{diff, folder, json, open, render, save};

const RANDOM: [&str; 4] = [
    "--set",
    "sampler.method=random",
    "--set",
    "sampler.per_pixel=16",
];

/// What `a.png` or another rendered picture is, how it is compared with the scene, the exit status, and the first line.
const VERDICTS: &[(&[&str], &[&str], i32, &str)] = &[
    (&[], &[], 0, "right: equal to the exact picture"),
    (
        &[],
        &["--strict"],
        0,
        "right: no pixel differs by more than 0.5 steps",
    ),
    (&RANDOM, &[], 0, "right but for sampling noise: about "),
    (
        &RANDOM,
        &["--strict"],
        1,
        "beyond the tolerance, but right but for sampling noise: about ",
    ),
    (
        &RANDOM,
        &["--tolerance", "1"],
        1,
        "beyond the tolerance, but right but for sampling noise: about ",
    ),
    (
        &RANDOM,
        &["--tolerance", "255"],
        0,
        "right: no pixel differs by more than 255 steps",
    ),
    (
        &["--set", "camera.roll=-10deg"],
        &[],
        1,
        "wrong: the roll has the wrong sign: -10",
    ),
    (
        &["--set", "Ball.color=red"],
        &["--set", "Ball.color=red"],
        0,
        "right: equal to the exact picture",
    ),
    (
        &["--crop", "10,5,40,30"],
        &[],
        0,
        "right: equal to the exact picture",
    ),
    (
        &["--crop", "10,5,40,30", "--set", "Ball.color=red"],
        &[],
        1,
        "wrong: ",
    ),
];

#[test]
fn the_verdict_comes_first() {
    let folder = folder();
    let path = folder.path();
    for (rendered, compared, status, first) in VERDICTS {
        for name in ["b.png", "b.exr"] {
            render(path, &[&["-o", name], *rendered].concat());
            let (found, text) = diff(path, &[&[name, "a.scn"], *compared].concat());
            // A float has no rounding of half a step.
            let first = first.strip_suffix(" than 0.5 steps").unwrap_or(first);
            assert!(
                found == *status && text.starts_with(first),
                "{name} {rendered:?} {compared:?}: {found}\n{text}"
            );
        }
    }
}

#[test]
fn a_mistake_is_what_can_be_set() {
    let folder = folder();
    let path = folder.path();
    let set = "Ball.radius=1.5";
    render(path, &["-o", "b.png", "--set", set]);
    let (status, text) = diff(path, &["b.png", "a.scn"]);
    let line = text.lines().next().unwrap();
    assert_eq!(status, 1);
    assert_eq!(
        line,
        "wrong: the sphere Ball has a wrong size: its radius is 1.5 instead of 1"
    );
    for words in [
        "\nmistake   the sphere Ball has a wrong size: ",
        "\n          --set Ball.radius=1.5\n",
        "\nobjects   Ball off by ",
        ", Sail right, box with the index 2 right, background right\n",
        "\nb.png and the exact picture of a.scn differ\n",
        "\nrmse      ",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(!text.contains("something else"), "{text}");
    assert_eq!(diff(path, &["b.png", "a.scn", "--set", set]).0, 0);

    let found = json(path, &["b.png", "a.scn"]);
    let keys: Vec<_> = found.as_object().unwrap().keys().cloned().collect();
    assert_eq!(
        keys.join(" "),
        "a b width height size_b rmse largest beyond undecided tolerance equal \
         verdict line samples_per_pixel mistakes objects limited"
    );
    assert_eq!(found["verdict"], "wrong");
    assert_eq!(found["line"], line);
    let mistake = &found["mistakes"][0];
    assert_eq!(
        (&mistake["id"], &mistake["set"][0]),
        (&"radius".into(), &set.into())
    );
    assert!(mistake["explains"].as_f64().unwrap() > 0.99, "{found:#}");
    let object = &found["objects"][0];
    assert_eq!(
        (&object["index"], &object["name"], &object["right"]),
        (&0.into(), &"Ball".into(), &false.into())
    );
    assert!(object["off"].as_f64().unwrap() > 1.0, "{found:#}");
    assert_eq!(found["objects"][2]["name"], Value::Null);
}

#[test]
fn what_jpeg_changes_is_not_wrong() {
    let folder = folder();
    let path = folder.path();
    for (arguments, expected) in [
        (&[][..], 0),
        (&RANDOM, 0),
        (&["--set", "Ball.radius=1.5"], 1),
    ] {
        render(path, &[&["-o", "b.png"], arguments].concat());
        let picture = open(path, "b.png").to_rgb8();
        for quality in [90, 95, 100] {
            let file = fs::File::create(path.join("b.jpg")).unwrap();
            JpegEncoder::new_with_quality(file, quality)
                .encode_image(&picture)
                .unwrap();
            let (status, text) = diff(path, &["b.jpg", "a.scn"]);
            assert_eq!(status, expected, "{arguments:?} {quality}: {text}");
        }
    }
}

#[test]
fn a_mistake_is_found_where_every_pixel_shows_several_colours() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    // Behind the box there are squares of about a pixel.
    let scene = "image { width 96 height 64 }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sampler { method exact }
box Crate { center (2, 0.75, -0.5) }
checkerboard { square 0.3 }
";
    fs::write(path.join("a.scn"), scene).unwrap();
    render(path, &["-o", "a.png", "--set", "Crate.size=(0.5, 2, 2)"]);
    let (status, text) = diff(path, &["a.png", "a.scn"]);
    assert!(
        status == 1 && text.starts_with("wrong: the box Crate"),
        "{text}"
    );
}

#[test]
fn objects_are_told_by_the_pixels() {
    let folder = folder();
    let path = folder.path();
    save(path, "b.png", open(path, "a.png").fliph());
    let found = json(path, &["b.png", "a.scn"]);
    assert_eq!(found["mistakes"][0]["id"], "mirrored", "{found:#}");
    for object in found["objects"].as_array().unwrap() {
        assert_eq!(object["right"], false, "{object:#}");
    }
    // A blot on the sky.
    let mut picture = open(path, "a.png").to_rgb8();
    for (x, y) in [(3, 3), (5, 3), (9, 4), (4, 7)] {
        picture.put_pixel(x, y, Rgb([(20 * x) as u8, 255, 7]));
    }
    save(path, "b.png", picture);
    let found = json(path, &["b.png", "a.scn"]);
    assert_ne!(found["verdict"], "noise");
    for object in found["objects"].as_array().unwrap() {
        assert_eq!(object["right"], true, "{object:#}");
    }
}

#[test]
fn no_known_mistake_explains_a_blot() {
    let folder = folder();
    let path = folder.path();
    let mut picture = open(path, "a.png").to_rgb8();
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        if (x / 3 + y / 2) % 5 == 0 {
            *pixel = Rgb([(x * y) as u8, (7 * x) as u8, (5 * y) as u8]);
        }
    }
    save(path, "b.png", picture);
    let (status, text) = diff(path, &["b.png", "a.scn"]);
    assert!(status == 1 && text.starts_with("wrong"), "{text}");
    assert_ne!(json(path, &["b.png", "a.scn"])["verdict"], "noise");
}
