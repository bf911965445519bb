//! Light that became bytes in a wrong way, and noise beside that.

use image::{DynamicImage, ImageBuffer, Luma, Rgb};
use pinhole::color::{linear_to_srgb, srgb_to_linear};
use tempfile::TempDir;

use super::{diff, folder, json, open, render, save};
use crate::effort::{Effort, sampled_and_exhaustive};

/// The picture `a.exr` with its light made bytes in some way, as `b.png`.
fn with_bytes(folder: &TempDir, byte: impl Fn(f64) -> f64) {
    let light = open(folder, "a.exr").to_rgb32f();
    let (width, height) = light.dimensions();
    let picture = ImageBuffer::from_fn(width, height, |x, y| {
        let pixel = light.get_pixel(x, y).0;
        Rgb(pixel.map(|light| byte(f64::from(light)).clamp(0.0, 255.0) as u8))
    });
    save(folder, "b.png", picture);
}

#[test]
fn bytes_that_are_cut_off_are_named() {
    let folder = folder();
    let noisy = [
        "--set",
        "sampler.method=random",
        "--set",
        "sampler.per_pixel=16",
    ];
    for (sets, white, words) in [
        (
            &[][..],
            255.0,
            "as int(255 c) does: they are too dark by up to a step",
        ),
        (&[], 256.0, "as int(256 c) and int(255.999 c) do"),
        (&[], 255.999, "as int(256 c) and int(255.999 c) do"),
        (&noisy, 255.0, "; all else is sampling noise"),
    ] {
        render(&folder, &[&["-o", "a.exr"], sets].concat());
        with_bytes(&folder, |light| (white * linear_to_srgb(light)).floor());
        let found = json(&folder, &["b.png", "a.scn"]);
        let first = &found["likely"][0];
        assert_eq!(first["mistake"], "truncated", "{white}: {found:#}");
        let message = first["message"].as_str().unwrap();
        assert!(message.contains(words), "{white}: {message}");
    }
}

/// A larger picture by some method, as `a.exr`, and the arguments that make it so large.
fn sampled(folder: &TempDir, method: &str, samples: u64) -> [&'static str; 4] {
    let size = ["--set", "image.width=240", "--set", "image.height=160"];
    let [method, samples] = [
        format!("sampler.method={method}"),
        format!("sampler.per_pixel={samples}"),
    ];
    let sampler = ["--set", &method, "--set", &samples];
    render(folder, &[&["-o", "a.exr"], &size[..], &sampler].concat());
    size
}

fn mistakes(folder: &TempDir, sets: &[&str]) -> Vec<String> {
    let found = json(folder, &[&["b.png", "a.scn"], sets].concat());
    let likely = found["likely"].as_array().unwrap().iter();
    likely
        .map(|one| one["mistake"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
#[ignore = "exhaustive"]
fn mixtures_alone_tell_of_bytes_that_are_cut_off() {
    let folder = folder();
    // A little more than a whole number stays one: flat colours are right.
    for (white, more) in [(255.0, 1e-3), (256.0, 0.0)] {
        for (method, samples) in [("sobol", 256), ("random", 4)] {
            let size = sampled(&folder, method, samples);
            with_bytes(&folder, |light| {
                (white * linear_to_srgb(light) + more).floor()
            });
            // Beside the noise of few samples half a step is nothing.
            let expected = if samples == 4 { "noise" } else { "truncated" };
            assert_eq!(mistakes(&folder, &size), [expected], "{white}, {method}");
        }
    }
}

sampled_and_exhaustive!(a_power_is_told_from_bytes_that_are_cut_off);

fn a_power_is_told_from_bytes_that_are_cut_off(effort: Effort) {
    let folder = folder();
    for (method, samples) in effort.of([("random", 4), ("multi_jittered", 16), ("sobol", 256)]) {
        let size = sampled(&folder, method, samples);
        with_bytes(&folder, |light| {
            (255.0 * libm::pow(light, 1.0 / 2.2)).round()
        });
        let found = mistakes(&folder, &size);
        // Noise may hide which of the two it is.
        let both = ["truncated", "gamma_22"];
        assert!(
            found == ["gamma_22"] || samples == 4 && found == both,
            "{method}: {found:?}"
        );
    }
}

/// The picture `a.exr` with 16 bits in each channel, made of its encoded colour in some way, as `b.png`.
fn with_wide_numbers(folder: &TempDir, number: impl Fn(f64) -> f64) {
    let light = open(folder, "a.exr").to_rgb32f();
    let (width, height) = light.dimensions();
    let picture = ImageBuffer::from_fn(width, height, |x, y| {
        let pixel = light.get_pixel(x, y).0;
        Rgb(pixel.map(|light| number(linear_to_srgb(f64::from(light))) as u16))
    });
    save(folder, "b.png", DynamicImage::ImageRgb16(picture));
}

#[test]
#[ignore = "exhaustive"]
fn bytes_in_a_file_of_16_bits_are_told() {
    let folder = folder();
    render(&folder, &["-o", "a.exr"]);
    type Number = fn(f64) -> f64;
    let cases: [(Number, &str, &str); 3] = [
        (
            |color| 257.0 * (255.0 * color).round(),
            "rounded",
            "the picture is right, rounded to 8 bits",
        ),
        (
            |color| 256.0 * (255.0 * color).round(),
            "rounded",
            "8 bits were made 16 by a shift",
        ),
        (
            |color| (65535.0 * color).floor(),
            "truncated",
            "the 16 bits of each channel are cut off instead of rounded",
        ),
    ];
    for (number, mistake, words) in cases {
        with_wide_numbers(&folder, number);
        let found = json(&folder, &["b.png", "a.scn"]);
        let first = &found["likely"][0];
        assert_eq!(first["mistake"], mistake, "{words}: {found:#}");
        let message = first["message"].as_str().unwrap();
        assert!(message.starts_with(words), "{words}: {message}");
        assert_eq!(found["thin"], false, "{words}");
    }
    // A picture that is wrong, too, is not said to be right.
    let moved = ["-o", "a.exr", "--set", "Ball.center=(-1.5, 1, 0)"];
    render(&folder, &moved);
    with_wide_numbers(&folder, cases[0].0);
    assert_eq!(mistakes(&folder, &[]), ["object_place"]);
}

sampled_and_exhaustive!(gray_pictures_are_named);

fn gray_pictures_are_named(effort: Effort) {
    let folder = folder();
    let luma = |[r, g, b]: [f64; 3]| 0.299 * r + 0.587 * g + 0.114 * b;
    let mean = |[r, g, b]: [f64; 3]| (r + g + b) / 3.0;
    type Gray = fn([f64; 3]) -> f64;
    let cases: [(Gray, &str); 3] = [
        (
            luma,
            "0.299 R + 0.587 G + 0.114 B of its encoded colour in place of a colour",
        ),
        (mean, "the mean of its encoded colour's channels"),
        (
            |color| {
                let [r, g, b] = color.map(srgb_to_linear);
                linear_to_srgb(0.2126 * r + 0.7152 * g + 0.0722 * b)
            },
            "the luminance of its light",
        ),
    ];
    for sets in effort.of([
        &[][..],
        &[
            "--set",
            "sampler.method=random",
            "--set",
            "sampler.per_pixel=16",
        ],
    ]) {
        render(&folder, &[&["-o", "a.exr"], sets].concat());
        let light = open(&folder, "a.exr").to_rgb32f();
        let (width, height) = light.dimensions();
        for (gray, words) in effort.of(cases) {
            let picture = ImageBuffer::from_fn(width, height, |x, y| {
                let pixel = light.get_pixel(x, y).0;
                let color = pixel.map(|light| linear_to_srgb(f64::from(light)));
                Luma([(255.0 * gray(color)).round() as u8])
            });
            save(&folder, "b.png", DynamicImage::ImageLuma8(picture));
            let found = json(&folder, &["b.png", "a.scn"]);
            let likely = found["likely"].as_array().unwrap();
            assert_eq!(likely.len(), 1, "{words}: {found:#}");
            assert_eq!(likely[0]["mistake"], "gray", "{words}: {found:#}");
            let message = likely[0]["message"].as_str().unwrap();
            assert!(message.contains(words), "{words}: {message}");
            if sets.is_empty() {
                // Of pictures alone, too.
                let (_, text) = diff(&folder, &["b.png", "a.exr"]);
                assert!(text.contains("the picture is gray"), "{text}");
            }
        }
    }
}
