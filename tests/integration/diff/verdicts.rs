//! Tests of the verdicts on a picture of a scene: right, right except for sampling noise, or wrong
//! because of a named mistake.

use std::fs;

use image::{Rgb, Rgba, codecs::jpeg::JpegEncoder};
use serde_json::Value;

use super::{folder, json, open, render, save};
use crate::{program::Folder, table::rows};

const RANDOM: &str = "--set sampler.method=random --set sampler.per_pixel=16";

/// Rows of four cells: the arguments of `render`, the arguments of `diff`, the exit status, and the
/// start of the first line of the output.
const VERDICTS: &str = "
    -> -> 0 -> right: equal to the exact picture
    -> --strict -> 0 -> right: no pixel differs by more than 0.5 steps
    RANDOM -> -> 0 -> right but for sampling noise: about
    RANDOM -> --strict -> 1 -> beyond the tolerance, but right but for sampling noise: about
    RANDOM -> --tolerance 1 -> 1 -> beyond the tolerance, but right but for sampling noise: about
    RANDOM -> --tolerance 255 -> 0 -> right: no pixel differs by more than 255 steps
    --set camera.roll=-10deg -> -> 1 -> wrong: the roll has the wrong sign: -10
    --set Ball.color=red -> --set Ball.color=red -> 0 -> right: equal to the exact picture
    --crop 10,5,40,30 -> -> 0 -> right: equal to the exact picture
    --crop 10,5,40,30 --set Ball.color=red -> -> 1 -> wrong:
";

#[test]
fn diff_prints_the_verdict_first() {
    let folder = folder();
    for [rendered, compared, status, first] in rows(VERDICTS) {
        for name in ["b.png", "b.exr"] {
            let rendered = rendered.replace("RANDOM", RANDOM);
            render(&folder, &format!("-o {name} {rendered}"));
            let compared = format!("diff {name} a.scn {compared}");
            let text = folder.told(&compared, status.parse().unwrap());
            // A picture of floats has no 8-bit steps, so its verdict does not mention half a step.
            let first = first.strip_suffix(" than 0.5 steps").unwrap_or(first);
            assert!(text.starts_with(first), "{rendered} {compared}: {text}");
        }
    }
}

#[test]
fn a_found_mistake_is_given_as_a_set_argument() {
    let folder = folder();
    let set = "Ball.radius=1.5";
    render(&folder, &format!("-o b.png --set {set}"));
    let text = folder.told("diff b.png a.scn", 1);
    let line = text.lines().next().unwrap();
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
    folder.told(&format!("diff b.png a.scn --set {set}"), 0);

    let found = json(&folder, "b.png a.scn");
    let keys: Vec<_> = found.as_object().unwrap().keys().cloned().collect();
    assert_eq!(
        keys.join(" "),
        "a b width height size_b rmse largest beyond undecided tolerance equal \
         verdict line samples_per_pixel mistakes guesses objects limited"
    );
    let (mistake, object) = (&found["mistakes"][0], &found["objects"][0]);
    for (is, expected) in [
        (&found["verdict"], "wrong".into()),
        (&found["line"], line.into()),
        (&mistake["id"], "radius".into()),
        (&mistake["set"][0], set.into()),
        (&object["index"], 0.into()),
        (&object["name"], "Ball".into()),
        (&object["right"], false.into()),
        (&found["objects"][2]["name"], Value::Null),
    ] {
        assert_eq!(*is, expected);
    }
    assert!(mistake["explains"].as_f64().unwrap() > 0.99, "{found:#}");
    assert!(object["off"].as_f64().unwrap() > 1.0, "{found:#}");
}

#[test]
fn jpeg_compression_is_not_reported_as_wrong() {
    let folder = folder();
    for (arguments, status) in [("", 0), (RANDOM, 0), ("--set Ball.radius=1.5", 1)] {
        render(&folder, &format!("-o b.png {arguments}"));
        let picture = open(&folder, "b.png").to_rgb8();
        for quality in [90, 100] {
            let file = fs::File::create(folder.path("b.jpg")).unwrap();
            let mut encoder = JpegEncoder::new_with_quality(file, quality);
            encoder.encode_image(&picture).unwrap();
            folder.told("diff b.jpg a.scn", status);
        }
    }
}

#[test]
fn a_mistake_is_found_in_front_of_pixel_sized_squares() {
    // Behind the box, the squares of the board are about as large as a pixel, so their colours
    // change from pixel to pixel. The wrong size of the box must be found nevertheless.
    let scene = "image { width 96 height 64 }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sampler { method exact }
box Crate { center (2, 0.75, -0.5) }
checkerboard { square 0.3 }
";
    let folder = Folder::with([("a.scn", scene)]);
    render(&folder, "-o a.png --set 'Crate.size=(0.5, 2, 2)'");
    let text = folder.told("diff a.png a.scn", 1);
    assert!(text.starts_with("wrong: the box Crate"), "{text}");
}

#[test]
fn objects_are_judged_by_their_own_pixels() {
    let folder = folder();
    let all_are = |found: &Value, right: bool| {
        for object in found["objects"].as_array().unwrap() {
            assert_eq!(object["right"], right, "{object:#}");
        }
    };
    save(&folder, "b.png", open(&folder, "a.png").fliph());
    let found = json(&folder, "b.png a.scn");
    assert_eq!(found["mistakes"][0]["id"], "mirrored", "{found:#}");
    all_are(&found, false);
    // Only four pixels of the background are changed, so every object must be judged right.
    let mut picture = open(&folder, "a.png").to_rgb8();
    for (x, y) in [(3, 3), (5, 3), (9, 4), (4, 7)] {
        picture.put_pixel(x, y, Rgb([(20 * x) as u8, 255, 7]));
    }
    save(&folder, "b.png", picture);
    let found = json(&folder, "b.png a.scn");
    assert_ne!(found["verdict"], "noise");
    all_are(&found, true);
}

#[test]
fn a_scribbled_picture_is_wrong_and_not_noise() {
    let folder = folder();
    let mut picture = open(&folder, "a.png").to_rgb8();
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        if (x / 3 + y / 2) % 5 == 0 {
            *pixel = Rgb([(x * y) as u8, (7 * x) as u8, (5 * y) as u8]);
        }
    }
    save(&folder, "b.png", picture);
    let text = folder.told("diff b.png a.scn", 1);
    assert!(text.starts_with("wrong"), "{text}");
    assert_ne!(json(&folder, "b.png a.scn")["verdict"], "noise");
}

/// Change of a picture that imitates a mistake. The function gets a pixel's value and row, and
/// returns the pixel's new value.
type Change = fn(Rgba<u8>, u32) -> Rgba<u8>;

/// Obvious mistakes, each with the name that `diff` must report. The function changes every pixel
/// of a right picture as the mistake would.
const PLAIN: [(&str, Change); 7] = [
    ("black", |_, _| Rgba([0, 0, 0, 255])),
    ("one_colour", |_, _| Rgba([90, 120, 30, 255])),
    ("transparent", |_, _| Rgba([0; 4])),
    ("alpha", |Rgba([r, g, b, _]), _| Rgba([r, g, b, 254])),
    ("alpha", |Rgba([r, g, b, _]), _| Rgba([r, g, b, 1])),
    ("rows_missing", |pixel, y| {
        if y < 30 { pixel } else { Rgba([0, 0, 0, 255]) }
    }),
    ("inverted", |Rgba([r, g, b, a]), _| {
        Rgba([255 - r, 255 - g, 255 - b, a])
    }),
];

#[test]
fn an_obvious_defect_is_the_only_mistake_reported() {
    let folder = folder();
    render(&folder, "-o blue.png --set image.background=navy");
    let blue = "b.png a.scn --set image.background=navy";
    for (id, change) in PLAIN {
        let mut picture = open(&folder, "blue.png").to_rgba8();
        for (_, y, pixel) in picture.enumerate_pixels_mut() {
            *pixel = change(*pixel, y);
        }
        save(&folder, "b.png", picture);
        let found = json(&folder, blue);
        let mistakes = found["mistakes"].as_array().unwrap();
        let ids: Vec<_> = mistakes.iter().map(|mistake| &mistake["id"]).collect();
        assert_eq!(ids, [id], "{found:#}");
    }
    // If only background is visible in a picture, the first reported mistake is `nothing_seen`.
    render(
        &folder,
        "-o b.png --set 'camera.lookat=(3, 30, 8)' --set image.background=navy",
    );
    let found = json(&folder, blue);
    assert_eq!(found["mistakes"][0]["id"], "nothing_seen", "{found:#}");
}

#[test]
fn exhausted_effort_gives_an_unknown_verdict() {
    let folder = folder();
    render(
        &folder,
        "-o b.png --set Ball.radius=1.2 --set 'camera.lookat=(0, 1, 0)'",
    );
    let found = json(&folder, "b.png a.scn --effort 0.1");
    assert_eq!(found["limited"], true, "{found:#}");
    assert_eq!(found["verdict"], "unknown", "{found:#}");
    assert_eq!(found["mistakes"].as_array().unwrap().len(), 0);
    let text = folder.told("diff b.png a.scn --effort 0.1", 1);
    assert!(text.contains("--effort"), "{text}");
}
