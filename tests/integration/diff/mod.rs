//! `diff`: two pictures compared, and a picture judged by a scene (`verdicts`).

mod verdicts;

use std::{fs, io::Write, path::Path, process::Stdio};

use image::{DynamicImage, GenericImageView, ImageBuffer, Rgb, Rgba};
use serde_json::Value;
use tempfile::TempDir;

use crate::program::command;

/// A small scene, of which mistakes are found at once.
const SCENE: &str = "image { width 60 height 40 background navy }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sampler { method exact }
sphere Ball { center (-1, 1, 0) }
triangle Sail { centroid (0.8, 1, 0.6) normal (0.3, 0, 1) sides (2, 2, 1) }
box { center (2.2, 0.75, -0.5) }
";

/// A fresh folder with the scene in `a.scn` and its exact picture in `a.png`.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.scn"), SCENE).unwrap();
    render(folder.path(), &["-o", "a.png"]);
    folder
}

fn render(folder: &Path, arguments: &[&str]) {
    let arguments = [&["render", "a.scn"], arguments].concat();
    let output = command(folder, &arguments).output().unwrap();
    assert!(output.status.success(), "{output:?}");
}

/// The exit status, and what is said to people.
fn diff(folder: &Path, arguments: &[&str]) -> (i32, String) {
    let arguments = [&["diff"], arguments].concat();
    let output = command(folder, &arguments).output().unwrap();
    assert_eq!(output.stdout, b"", "{arguments:?}");
    let text = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), text)
}

fn json(folder: &Path, arguments: &[&str]) -> Value {
    let arguments = [&["diff"], arguments, &["--format", "json"]].concat();
    let output = command(folder, &arguments).output().unwrap();
    assert!(output.stderr.is_empty(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn open(folder: &Path, name: &str) -> DynamicImage {
    image::open(folder.join(name)).unwrap()
}

fn save(folder: &Path, name: &str, picture: impl Into<DynamicImage>) {
    picture.into().save(folder.join(name)).unwrap();
}

#[test]
fn two_pictures_have_figures_and_no_verdict() {
    let folder = folder();
    let path = folder.path();
    let mut picture = ImageBuffer::from_pixel(2, 1, Rgb([10u8, 20, 30]));
    save(path, "b.png", picture.clone());
    picture.put_pixel(1, 0, Rgb([10, 20, 50]));
    save(path, "c.png", picture);
    let (status, text) = diff(path, &["b.png", "c.png"]);
    assert_eq!(status, 1);
    assert_eq!(
        text,
        "b.png and c.png differ

size      2 x 1 pixels
beyond    1 of 2 pixels (50 %) differ by more than 1 step of 8-bit sRGB
largest   20 steps: blue of pixel (1, 0) is 30 in A and 50 in B, of 255
rmse      0.00772 in linear light, where white is 1
"
    );
    let found = json(path, &["b.png", "c.png"]);
    let expected = serde_json::json!({
        "a": "b.png", "b": "c.png", "width": 2, "height": 1, "size_b": [2, 1],
        "rmse": found["rmse"],
        "largest": { "error": 20.0, "x": 1, "y": 0, "channel": "blue", "a": 30.0, "b": 50.0 },
        "beyond": { "pixels": 1, "share": 0.5 }, "undecided": 0, "tolerance": 1.0, "equal": false,
    });
    assert_eq!(found, expected);
    assert_eq!(diff(path, &["b.png", "c.png", "--tolerance", "20"]).0, 0);
}

#[test]
fn what_a_file_holds_is_compared_not_how() {
    let folder = folder();
    let path = folder.path();
    render(path, &["-o", "a.exr"]);
    let picture = open(path, "a.png");
    save(path, "alpha.png", picture.to_rgba8());
    save(path, "wide.png", picture.to_rgb16());
    for name in ["a.ppm", "a.bmp", "a.tiff", "a.webp"] {
        save(path, name, picture.to_rgb8());
    }
    // Half of white light is 187.5 in sRGB: alpha mixes light.
    let half = ImageBuffer::from_pixel(96, 64, Rgba([65535u16, 65535, 65535, 32768]));
    save(path, "half.png", half);
    save(
        path,
        "mixed.png",
        ImageBuffer::from_pixel(96, 64, Rgb([188u8; 3])),
    );
    for name in [
        "a.png",
        "a.exr",
        "alpha.png",
        "wide.png",
        "a.ppm",
        "a.bmp",
        "a.tiff",
        "a.webp",
    ] {
        let (status, text) = diff(path, &[name, "a.exr", "--tolerance", "0.501"]);
        assert!(
            status == 0 && text.starts_with(&format!("{name} and a.exr are equal: ")),
            "{text}"
        );
    }
    assert_eq!(diff(path, &["half.png", "mixed.png"]).0, 0);
    for (name, words) in [
        ("b.jpg", "warning: b.jpg: its coding is lossy"),
        ("b.gif", "warning: b.gif: it has 256 colours at most"),
    ] {
        picture.save(path.join(name)).unwrap();
        let (_, text) = diff(path, &[name, "a.png", "--tolerance", "255"]);
        assert!(text.starts_with(words), "{text}");
    }
}

#[test]
fn another_curve_than_srgb_is_told() {
    let folder = folder();
    let path = folder.path();
    // An ICC profile with one tag.
    let profile = |curve: &[u8]| {
        let place = [144, curve.len() as u32].map(u32::to_be_bytes).concat();
        [&[0; 128], &1u32.to_be_bytes()[..], b"rTRC", &place, curve].concat()
    };
    let fixed = |x: f64| ((65536.0 * x).round() as i32).to_be_bytes();
    let srgb = [2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045].map(fixed);
    let srgb = [&b"para\0\0\0\0\0\x03\0\0"[..], &srgb.concat()].concat();
    for (gamma, curve, is_told) in [
        (None, None, false),
        (Some(0.45455), None, false),
        (Some(1.0), None, true),
        (None, Some(&srgb[..]), false),
        (None, Some(b"curv\0\0\0\0\0\0\0\x01\x01\xcd"), true),
        (None, Some(b"curv\0\0\0\0\0\0\0\0"), true),
        (None, Some(b"curv"), false),
    ] {
        let mut info = png::Info::with_size(1, 1);
        info.source_gamma = gamma.map(png::ScaledFloat::new);
        info.icc_profile = curve.map(|curve| profile(curve).into());
        let file = fs::File::create(path.join("b.png")).unwrap();
        let mut writer = png::Encoder::with_info(file, info)
            .unwrap()
            .write_header()
            .unwrap();
        writer.write_image_data(&[77]).unwrap();
        writer.finish().unwrap();
        let (status, text) = diff(path, &["b.png", "b.png"]);
        let words = "warning: b.png: its gAMA or iCCP says";
        assert_eq!(
            (status, text.starts_with(words)),
            (0, is_told),
            "{gamma:?} {curve:?}"
        );
    }
}

#[test]
fn standard_input_is_a_picture_or_a_scene() {
    let folder = folder();
    let path = folder.path();
    for (arguments, input) in [
        (["diff", "-", "a.scn"], "a.png"),
        (["diff", "a.png", "-"], "a.scn"),
        (["diff", "a.png", "-"], "a.png"),
    ] {
        let mut child = command(path, &arguments)
            .stdin(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let bytes = fs::read(path.join(input)).unwrap();
        child.stdin.take().unwrap().write_all(&bytes).unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?} {output:?}");
    }
}

#[test]
fn sizes_that_differ_are_named() {
    let folder = folder();
    let path = folder.path();
    save(path, "b.png", image::RgbImage::new(48, 32));
    let (status, text) = diff(path, &["b.png", "a.scn"]);
    assert_eq!(status, 2);
    assert_eq!(
        text,
        "error: b.png has 48 × 32 pixels, and the scene's picture 60 × 40\n"
    );
    let (status, text) = diff(path, &["b.png", "a.png", "-o", "heat.png"]);
    assert_eq!(status, 1);
    assert!(
        text.contains("A         48 x 32 pixels\nB         60 x 40 pixels\n")
            && text.contains("pictures of different sizes have no heat map"),
        "{text}"
    );
    let found = json(path, &["b.png", "a.png"]);
    assert_eq!(
        (&found["rmse"], &found["equal"]),
        (&Value::Null, &false.into())
    );
    // A part of a larger picture than the scene's.
    let crop = ["--set", "image.width=200", "--crop", "150,5,40,30"];
    render(path, &[&["-o", "b.png"], &crop[..]].concat());
    let (status, text) = diff(path, &["b.png", "a.scn"]);
    assert!(
        status == 2 && text.contains("which does not lie within the scene's 60 × 40 pixels"),
        "{text}"
    );
}

#[test]
fn a_heat_map_is_a_picture_of_the_size() {
    let folder = folder();
    let path = folder.path();
    render(path, &["-o", "b.png", "--set", "Ball.color=red"]);
    let (status, text) = diff(path, &["b.png", "a.scn", "-o", "heat.png"]);
    assert_eq!(status, 1);
    assert!(
        text.contains("\nheat.png: black: within the tolerance; red: 85 steps"),
        "{text}"
    );
    let map = open(path, "heat.png");
    assert_eq!(map.dimensions(), (60, 40));
    let heat = map.to_rgb8();
    assert!(heat.pixels().any(|pixel| pixel.0[0] == 255));
    assert_eq!(heat.get_pixel(0, 0).0, [0; 3]);
    let (_, text) = diff(path, &["a.png", "a.scn", "-o", "heat.png"]);
    assert!(
        text.ends_with("\nheat.png: black all over: nothing differs by more than the tolerance\n"),
        "{text}"
    );
    let heat = open(path, "heat.png").to_rgb8();
    assert!(heat.pixels().all(|pixel| pixel.0 == [0; 3]));
    for (wrong, words) in [
        ("heat.exr", "a heat map is a PNG"),
        ("b.png", "b.png is compared"),
        ("no/heat.png", "cannot write to"),
    ] {
        let (status, text) = diff(path, &["b.png", "a.scn", "-o", wrong]);
        assert!(status == 2 && text.contains(words), "{text}");
    }
}

#[test]
fn pixels_that_cannot_be_judged_are_counted() {
    let folder = folder();
    let path = folder.path();
    let scene = "image { width 6 height 3 } camera { eye (0.31, 1.7, 2.2) direction (1, 0, -2) }
                 sampler { method exact } checkerboard { y 0 square 5e-324 }";
    fs::write(path.join("a.scn"), scene).unwrap();
    render(path, &["-o", "a.exr"]);
    let compared = ["a.exr", "a.scn", "--tolerance", "0"];
    let undecided = json(path, &compared)["undecided"].as_u64().unwrap();
    assert!(undecided > 0);
    let (_, text) = diff(path, &compared);
    let words = format!("\nopen      {undecided} pixel");
    assert!(text.contains(&words), "{text}");
}

#[test]
fn what_cannot_be_compared_is_trouble() {
    let folder = folder();
    let path = folder.path();
    let write = |name: &str, bytes: &[u8]| fs::write(path.join(name), bytes).unwrap();
    write("text.png", b"no picture");
    write("empty.EXR", b"");
    write("bad.scn", b"sphere {}");
    write("a.jpg", &[0xff, 0xd8, 0xff, 0xe0, 0, 1]);
    let nan = |_, _| (0.0_f32, f32::NAN, 0.0_f32);
    exr::prelude::write_rgb_file(path.join("nan.exr"), 2, 2, nan).unwrap();
    let cases: [(&[&str], i32, &str); 11] = [
        (
            &["text.png", "a.png"],
            2,
            "it is no picture in PNG, OpenEXR",
        ),
        (
            &["a.png", "text.png"],
            2,
            "cannot read text.png: it is no picture",
        ),
        (
            &["a.png", "empty.EXR"],
            2,
            "cannot read empty.EXR: it is no",
        ),
        (&["a.jpg", "a.png"], 2, "it begins as JPEG files do, but is"),
        (
            &["nan.exr", "a.png"],
            2,
            "its pixel (0, 0) holds a value that",
        ),
        (&["none.png", "a.png"], 2, "cannot read none.png"),
        (
            &["a.scn", "a.png"],
            2,
            "a.scn is a scene: the picture comes first",
        ),
        (&["-", "-"], 2, "`-` is given twice"),
        (
            &["a.png", "a.png", "--set", "Ball.radius=2"],
            2,
            "`--set` changes a scene",
        ),
        (&["a.png", "a.png", "--tolerance", "-1"], 2, "--tolerance"),
        (&["a.png", "bad.scn"], 1, "center"),
    ];
    for (arguments, status, words) in cases {
        let (found, text) = diff(path, arguments);
        assert!(
            found == status && text.contains(words),
            "{arguments:?}: {text}"
        );
    }
}
