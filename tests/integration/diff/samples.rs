//! Mistakes of samples: too few, in the wrong place, averaged wrongly.

use std::fs;

use image::{ImageBuffer, Rgb};
use serde_json::Value;

use super::{SCENE, diff, folder, json, mistake, open, render, save};
use crate::effort::{Effort, sampled_and_exhaustive};

sampled_and_exhaustive!(mistakes_of_sampling_are_named);

fn mistakes_of_sampling_are_named(effort: Effort) {
    let folder = folder();
    let one = [
        "-o",
        "b.png",
        "--set",
        "sampler.method=regular",
        "--set",
        "sampler.per_pixel=1",
    ];
    render(&folder, &one);
    assert_eq!(mistake(&folder), "sample_at_center");
    // A picture with a column and a row more, whose pixels' centres are the corners of the other's.
    let corners = [
        &one[..],
        &["--set", "image.width=97", "--set", "image.height=65"],
        &["--set", "camera.view_height=2.03125", "--crop", "0,0,96,64"],
    ];
    render(&folder, &corners.concat());
    assert_eq!(mistake(&folder), "sample_at_corner");
    for method in effort.of(["random", "multi_jittered", "sobol", "jittered", "regular"]) {
        for count in effort.of([4, 16, 64]) {
            let (method, count) = (
                format!("sampler.method={method}"),
                format!("sampler.per_pixel={count}"),
            );
            render(&folder, &["-o", "b.png", "--set", &method, "--set", &count]);
            assert_eq!(mistake(&folder), "noise", "{method}, {count}");
        }
    }
    let noisy = [
        "-o",
        "b.png",
        "--set",
        "sampler.method=random",
        "--set",
        "sampler.per_pixel=16",
    ];
    render(&folder, &noisy);
    let (_, text) = diff(&folder, &["b.png", "a.scn"]);
    assert!(
        text.contains("as with about 1") && text.contains(" random samples per pixel"),
        "{text}"
    );
    // Noise hides no mistake.
    for (set, expected) in effort.of([
        ("camera.roll=-10deg", "roll_sign"),
        ("camera.d=2.1", "distance"),
        ("Ball.color=red", "color"),
    ]) {
        render(&folder, &[&noisy[..], &["--set", set]].concat());
        assert_eq!(mistake(&folder), expected, "{set}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_picture_displaced_by_half_a_pixel_is_named() {
    let folder = folder();
    // Twice the columns and rows, of which those a half of a pixel beside are taken together.
    render(
        &folder,
        &[
            "-o",
            "fine.exr",
            "--set",
            "image.width=192",
            "--set",
            "image.height=128",
        ],
    );
    let fine = open(&folder, "fine.exr").to_rgb32f();
    for (by, words) in [
        ([1, 1], "0.5 pixels to the left and 0.5 pixels up"),
        ([2, 0], "1 pixel to the left"),
    ] {
        let picture = ImageBuffer::from_fn(96, 64, |x, y| {
            let mut sum = [0.0; 3];
            for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let (column, row) = ((2 * x + i + by[0]).min(191), (2 * y + j + by[1]).min(127));
                for (sum, light) in sum.iter_mut().zip(fine.get_pixel(column, row).0) {
                    *sum += light / 4.0;
                }
            }
            Rgb(sum)
        });
        save(&folder, "b.exr", picture);
        let found = json(&folder, &["b.exr", "a.scn"]);
        assert_eq!(found["likely"][0]["mistake"], "shifted");
        let message = found["likely"][0]["message"].as_str().unwrap();
        assert!(message.ends_with(words), "{message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_picture_displaced_by_pixels_is_named_whatever_comes_in() {
    let folder = folder();
    let picture = open(&folder, "a.png").to_rgb8();
    let (width, height) = picture.dimensions();
    for (by, words) in [
        ((1, 0), "1 pixel to the right"),
        ((0, 1), "1 pixel down"),
        ((-2, 0), "2 pixels to the left"),
        ((-1, -1), "1 pixel to the left and 1 pixel up"),
    ] {
        let (right, down): (i32, i32) = by;
        let from = |x: u32, y: u32| (x as i32 - right, y as i32 - down);
        let empty = ImageBuffer::from_fn(width, height, |x, y| {
            let (x, y) = from(x, y);
            let is_in = (0..width as i32).contains(&x) && (0..height as i32).contains(&y);
            match is_in {
                true => *picture.get_pixel(x as u32, y as u32),
                false => Rgb([0; 3]),
            }
        });
        let wrapped = ImageBuffer::from_fn(width, height, |x, y| {
            let (x, y) = from(x, y);
            *picture.get_pixel(
                x.rem_euclid(width as i32) as u32,
                y.rem_euclid(height as i32) as u32,
            )
        });
        for (picture, rest) in [
            (empty, ", and black where it is missing then"),
            (
                wrapped,
                ", and what goes out at one edge comes in at the other",
            ),
        ] {
            save(&folder, "b.png", picture);
            let found = json(&folder, &["b.png", "a.scn"]);
            assert_eq!(found["likely"][0]["mistake"], "shifted", "{by:?}{rest}");
            let message = found["likely"][0]["message"].as_str().unwrap();
            assert_eq!(
                message,
                format!("the whole picture is displaced by {words}{rest}")
            );
        }
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_pixel_or_two_tell_of_no_mistake() {
    let folder = folder();
    for (size, most) in [("1", 1), ("2", 4), ("3", 9)] {
        let sizes = [
            format!("image.width={size}"),
            format!("image.height={size}"),
        ];
        let sets: Vec<_> = sizes.iter().flat_map(|set| ["--set", set]).collect();
        for wrong in [
            "sampler.per_pixel=1",
            "camera.roll=-10deg",
            "camera.d=5.5",
            "Ball.color=red",
            "camera.eye=(3, 3.5, 9)",
        ] {
            let method = ["--set", "sampler.method=regular", "--set", wrong];
            render(&folder, &[&["-o", "b.png"], &sets[..], &method].concat());
            let found = json(&folder, &[&["b.png", "a.scn"], &sets[..]].concat());
            assert_eq!(found["likely"], Value::Array(Vec::new()), "{size}, {wrong}");
            assert!(found["thin"].is_boolean(), "{found}");
            assert!(found["beyond"]["pixels"].as_u64().unwrap() <= most);
        }
    }
    let one = ["--set", "image.width=1", "--set", "image.height=1"];
    let sample = [
        "--set",
        "sampler.method=regular",
        "--set",
        "sampler.per_pixel=1",
    ];
    render(&folder, &[&["-o", "b.png"], &one[..], &sample].concat());
    let found = json(&folder, &[&["b.png", "a.scn"], &one[..]].concat());
    assert_eq!(found["thin"], true, "{found}");
    assert!(found["may_be_noise"].is_boolean(), "{found}");
    let (_, text) = diff(&folder, &[&["b.png", "a.scn"], &one[..]].concat());
    assert!(
        text.ends_with(
            "\nSampling noise would explain it, though so few pixels differ that they do not say that it is noise.\n"
        ),
        "{text}"
    );
}

#[test]
fn a_few_pixels_that_are_no_noise_are_not_said_to_be() {
    let folder = tempfile::tempdir().unwrap();
    let dot = "image { width 40 height 30 background black }
camera { eye (0, 0, 8) lookat (0, 0, 0) d 2 }
sampler { method exact }
sphere Dot { center (0.5, 0.3, 0) radius 0.4 color red }
";
    fs::write(folder.path().join("a.scn"), dot).unwrap();
    render(&folder, &["-o", "b.png", "--set", "Dot.color=lime"]);
    let found = json(&folder, &["b.png", "a.scn"]);
    assert_eq!(found["thin"], true, "{found}");
    let (_, text) = diff(&folder, &["b.png", "a.scn"]);
    assert!(
        text.ends_with(
            "\nA simple mistake would explain it, but so few pixels tell of it that chance would, too.\n"
        ),
        "{text}"
    );
}

#[test]
#[ignore = "exhaustive"]
fn one_sample_in_each_pixel_excuses_no_wrong_colour() {
    let folder = folder();
    let one = [
        "--set",
        "sampler.method=regular",
        "--set",
        "sampler.per_pixel=1",
    ];
    for (set, words) in [
        ("Ball.color=#808030", "`Ball` has the colour #808030"),
        ("Ball.color=#8c8000", "`Ball` has the colour #8c8000"),
        ("Sail.color=#0078a0", "`Sail` has the colour #0078a0"),
    ] {
        render(
            &folder,
            &[&["-o", "b.png", "--set", set], &one[..]].concat(),
        );
        let (_, text) = diff(&folder, &["b.png", "a.scn"]);
        assert!(text.contains(words), "{set}: {text}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_wrong_object_is_no_noise() {
    let folder = folder();
    let small = ["--set", "Ball.radius=0.4"];
    let moved = ["-o", "b.png", "--set", "Ball.center=(-1.4, 1, 0)"];
    render(&folder, &[&moved, &small[..]].concat());
    let found = json(&folder, &[&["b.png", "a.scn"], &small[..]].concat());
    assert_eq!(found["likely"][0]["mistake"], "object_place", "{found:#}");
}

#[test]
#[ignore = "exhaustive"]
fn a_band_of_wrong_colours_is_no_noise() {
    let folder = folder();
    let far = SCENE.replace("navy", "black").replace(
        "box Crate { center (2, 0.75, -0.5) }",
        "box Crate { center (1, 0.3, -6) size (0.6, 0.6, 0.6) color orange }",
    );
    let size = ["--set", "image.width=320", "--set", "image.height=180"];
    fs::write(folder.path().join("a.scn"), far).unwrap();
    for height in ["0.68", "0.76"] {
        let size_of_box = format!("Crate.size=(0.6, {height}, 0.6)");
        for method in ["random", "multi_jittered", "sobol"] {
            let method = format!("sampler.method={method}");
            let sets = [
                "--set",
                &size_of_box,
                "--set",
                &method,
                "--set",
                "sampler.per_pixel=16",
            ];
            render(&folder, &[&["-o", "b.png"], &size[..], &sets].concat());
            let found = json(&folder, &[&["b.png", "a.scn"], &size[..]].concat());
            let first = &found["likely"][0];
            assert_ne!(first["mistake"], "noise", "{height}, {method}");
            // A few pixels do not tell which object it is.
            if let Some(message) = first["message"].as_str() {
                assert!(message.contains("`Crate`"), "{height}, {method}: {message}");
            }
        }
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_few_wrong_edges_are_no_noise() {
    let folder = folder();
    // All but the pixels around the ball is right.
    render(
        &folder,
        &["-o", "b.png", "--set", "Ball.center=(-1.59, 1, 0)"],
    );
    assert_ne!(mistake(&folder), "noise");
}

#[test]
#[ignore = "exhaustive"]
fn samples_averaged_as_bytes_are_named() {
    let folder = folder();
    // The mean of 64 single samples in each pixel, of their bytes.
    render(
        &folder,
        &[
            "-o",
            "fine.png",
            "--set",
            "image.width=768",
            "--set",
            "image.height=512",
            "--set",
            "sampler.method=regular",
            "--set",
            "sampler.per_pixel=1",
        ],
    );
    let fine = open(&folder, "fine.png").to_rgb8();
    let picture = ImageBuffer::from_fn(96, 64, |x, y| {
        let mut sum = [0u32; 3];
        for (i, j) in (0..64).map(|k| (k % 8, k / 8)) {
            for (sum, byte) in sum.iter_mut().zip(fine.get_pixel(8 * x + i, 8 * y + j).0) {
                *sum += u32::from(byte);
            }
        }
        Rgb(sum.map(|sum| ((sum + 32) / 64) as u8))
    });
    save(&folder, "b.png", picture);
    assert_eq!(mistake(&folder), "averaged_encoded");
}
