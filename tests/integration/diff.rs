//! `diff`: pictures compared, and the mistakes in them named.

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

use image::{DynamicImage, GenericImageView, ImageBuffer, Rgb, Rgba};
use serde_json::Value;
use tempfile::TempDir;

/// A small scene that sees something of everything.
const SCENE: &str = "image { width 96 height 64 background navy }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sampler { method exact }
sphere Ball { center (-1.6, 1, 0) }
triangle Sail { centroid (0.2, 1, 0.6) normal (0.3, 0, 1) sides (2, 2, 1) }
box Crate { center (2, 0.75, -0.5) }
checkerboard {}
";

/// A fresh folder with the scene in `a.scn` and its exact picture in `a.png`.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.scn"), SCENE).unwrap();
    render(&folder, &["-o", "a.png"]);
    folder
}

fn pinhole(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pinhole"))
        .args(arguments)
        .current_dir(folder)
        .env("LC_ALL", "C.UTF-8")
        .env_remove("NO_COLOR")
        .env_remove("NO_GRAPHICS")
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn render(folder: &TempDir, arguments: &[&str]) {
    let arguments = [&["render", "a.scn"], arguments].concat();
    let output = pinhole(folder.path(), &arguments);
    assert!(output.status.success(), "{output:?}");
}

fn diff(folder: &TempDir, arguments: &[&str]) -> (i32, String) {
    let output = pinhole(folder.path(), &[&["diff"], arguments].concat());
    assert_eq!(output.stdout, b"", "{arguments:?}");
    let text = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), text)
}

fn json(folder: &TempDir, arguments: &[&str]) -> Value {
    let all = [&["diff"], arguments, &["--format", "json"]].concat();
    let output = pinhole(folder.path(), &all);
    assert!(output.stderr.is_empty(), "{output:?}");
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    let status = if value["equal"] == true { 0 } else { 1 };
    assert_eq!(output.status.code(), Some(status), "{value}");
    value
}

/// The name of the first mistake that is found in `b.png`.
fn mistake(folder: &TempDir) -> String {
    let found = json(folder, &["b.png", "a.scn"]);
    found["likely"][0]["mistake"]
        .as_str()
        .unwrap_or("none")
        .to_owned()
}

fn open(folder: &TempDir, name: &str) -> DynamicImage {
    image::open(folder.path().join(name)).unwrap()
}

fn save(folder: &TempDir, name: &str, picture: impl Into<DynamicImage>) {
    picture.into().save(folder.path().join(name)).unwrap();
}

#[test]
fn pictures_of_all_kinds_are_equal() {
    let folder = folder();
    render(&folder, &["-o", "a.exr"]);
    let picture = open(&folder, "a.png");
    save(&folder, "alpha.png", picture.to_rgba8());
    save(&folder, "wide.png", picture.to_rgb16());
    save(&folder, "wide_alpha.png", picture.to_rgba16());
    let everything = ["a.png", "a.exr", "alpha.png", "wide.png", "wide_alpha.png"];
    for a in everything {
        // What is said to have 16 bits here has but 8.
        let (status, text) = diff(&folder, &[a, "a.scn", "--tolerance", "0.5"]);
        assert_eq!(status, 0, "{a}: {text}");
        for b in everything {
            let (status, text) = diff(&folder, &[a, b, "--tolerance", "0.501"]);
            assert_eq!(status, 0, "{a}, {b}: {text}");
            assert!(
                text.starts_with(&format!("{a} and {b} are equal: ")),
                "{text}"
            );
        }
    }
    for (a, b) in [
        ("a.png", "a.exr"),
        ("a.exr", "a.png"),
        ("a.exr", "a.scn"),
        ("a.png", "a.scn"),
    ] {
        assert_eq!(diff(&folder, &[a, b]).0, 0, "{a}, {b}");
    }
    // Bytes that were rounded the other way.
    let mut other = picture.to_rgb8();
    other
        .pixels_mut()
        .for_each(|pixel| pixel.0 = pixel.0.map(|byte| byte ^ 1));
    save(&folder, "b.png", other);
    assert_eq!(diff(&folder, &["a.png", "b.png"]).0, 0);
    assert_eq!(diff(&folder, &["b.png", "a.scn"]).0, 1);
    assert_eq!(
        diff(&folder, &["a.png", "b.png", "--tolerance", "0.9"]).0,
        1
    );
}

#[test]
fn gray_and_transparent_pictures_are_what_is_seen() {
    let folder = folder();
    let gray = open(&folder, "a.png").to_luma8();
    save(&folder, "gray.png", gray.clone());
    save(
        &folder,
        "color.png",
        DynamicImage::from(gray.clone()).to_rgb8(),
    );
    save(&folder, "wide.png", DynamicImage::from(gray).to_luma16());
    for (a, b) in [("gray.png", "color.png"), ("wide.png", "gray.png")] {
        assert_eq!(diff(&folder, &[a, b, "--tolerance", "0"]).0, 0);
    }
    // Half of white light is 187.5 in sRGB: alpha mixes light.
    save(
        &folder,
        "half.png",
        ImageBuffer::from_pixel(1, 1, Rgba([65535u16, 65535, 65535, 32768])),
    );
    save(
        &folder,
        "mixed.png",
        ImageBuffer::from_pixel(1, 1, Rgb([188u8; 3])),
    );
    assert_eq!(diff(&folder, &["half.png", "mixed.png"]).0, 0);
    // A float picture of another program, with alpha.
    save(
        &folder,
        "half.exr",
        ImageBuffer::from_pixel(1, 1, Rgba([0.5f32, 0.5, 0.5, 0.5])),
    );
    assert_eq!(diff(&folder, &["half.exr", "half.png"]).0, 0);
}

#[test]
fn json_says_everything() {
    let folder = folder();
    let mut picture = open(&folder, "a.png").to_rgb8();
    let [red, green, blue] = picture.get_pixel(5, 7).0;
    picture.put_pixel(5, 7, Rgb([red, green ^ 128, blue]));
    save(&folder, "b.png", picture);
    let found = json(&folder, &["b.png", "a.png"]);
    let keys: Vec<_> = found.as_object().unwrap().keys().cloned().collect();
    assert_eq!(
        keys,
        [
            "a",
            "b",
            "width",
            "height",
            "size_b",
            "rmse",
            "largest",
            "beyond",
            "tolerance",
            "equal",
            "likely"
        ]
    );
    assert_eq!(
        (&found["a"], &found["b"]),
        (&"b.png".into(), &"a.png".into())
    );
    assert_eq!(
        (&found["width"], &found["height"]),
        (&96.into(), &64.into())
    );
    let largest = &found["largest"];
    assert_eq!(
        (&largest["x"], &largest["y"], &largest["channel"]),
        (&5.into(), &7.into(), &"green".into())
    );
    assert!((largest["error"].as_f64().unwrap() - 128.0).abs() < 1e-6);
    assert!((largest["b"].as_f64().unwrap() - f64::from(green)).abs() < 1e-6);
    assert_eq!(found["beyond"]["pixels"], 1);
    assert_eq!(found["tolerance"], 1.0);
    assert_eq!(found["likely"], Value::Array(Vec::new()));
    assert!(found["rmse"].as_f64().unwrap() > 0.0);
}

#[test]
fn people_read_where_the_largest_difference_is() {
    let folder = folder();
    save(
        &folder,
        "b.png",
        ImageBuffer::from_pixel(2, 1, Rgb([10u8, 20, 30])),
    );
    let mut other = ImageBuffer::from_pixel(2, 1, Rgb([10u8, 20, 30]));
    other.put_pixel(1, 0, Rgb([10, 20, 50]));
    save(&folder, "c.png", other);
    let (status, text) = diff(&folder, &["b.png", "c.png"]);
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
}

#[test]
fn a_heat_map_is_a_picture_of_the_size() {
    let folder = folder();
    render(&folder, &["-o", "b.png", "--set", "Ball.color=red"]);
    let (status, text) = diff(&folder, &["b.png", "a.scn", "-o", "heat.png"]);
    assert_eq!(status, 1);
    assert!(
        text.contains("\nheat.png: black: within the tolerance; "),
        "{text}"
    );
    let map = open(&folder, "heat.png");
    assert_eq!(map.dimensions(), (96, 64));
    let heat = map.to_rgb8();
    assert!(heat.pixels().any(|pixel| pixel.0[0] == 255));
    assert_eq!(heat.get_pixel(0, 0).0, [0; 3]);
    for (wrong, words) in [
        ("heat.exr", "a heat map is a PNG"),
        ("b.png", "b.png is compared"),
        ("no/heat.png", "cannot write to"),
    ] {
        let (status, text) = diff(&folder, &["b.png", "a.scn", "-o", wrong]);
        assert!(status == 2 && text.contains(words), "{text}");
    }
}

#[test]
fn sizes_that_differ_are_named() {
    let folder = folder();
    render(
        &folder,
        &[
            "-o",
            "b.png",
            "--set",
            "image.width=48",
            "--set",
            "image.height=32",
        ],
    );
    let (status, text) = diff(&folder, &["b.png", "a.scn"]);
    assert_eq!(status, 1);
    assert!(
        text.contains("A         48 x 32 pixels\nB         96 x 64 pixels\n"),
        "{text}"
    );
    let found = json(&folder, &["b.png", "a.scn"]);
    assert_eq!(found["rmse"], Value::Null);
    assert_eq!(found["likely"][0]["mistake"], "resolution");
    let turned = open(&folder, "a.png").rotate90();
    save(&folder, "b.png", turned);
    let found = json(&folder, &["b.png", "a.scn"]);
    assert_eq!(
        found["likely"][0]["message"],
        "the picture is turned by a quarter, clockwise"
    );
    let (status, _) = diff(
        &folder,
        &[
            "b.png",
            "a.scn",
            "--set",
            "image.width=64",
            "--set",
            "image.height=96",
        ],
    );
    assert_eq!(status, 1);
}

#[test]
fn files_that_are_no_pictures_are_trouble() {
    let folder = folder();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    render(&folder, &["-o", "a.exr"]);
    for name in ["a.png", "a.exr"] {
        let bytes = fs::read(folder.path().join(name)).unwrap();
        for share in 1..40 {
            write("cut", &bytes[..bytes.len() * share / 40]);
            let (status, text) = diff(&folder, &["cut", "a.scn"]);
            assert!(
                status == 2 && text.starts_with("error: cannot read cut: it "),
                "{name}, {share}: {text}"
            );
        }
    }
    write("a.jpg", b"\xff\xd8\xff\xe0");
    write("text.png", b"hello");
    save(
        &folder,
        "nan.exr",
        ImageBuffer::from_pixel(2, 2, Rgb([0.0, f32::NAN, 0.0])),
    );
    let mut absurd = fs::read(folder.path().join("a.png")).unwrap();
    // The width, in the header.
    absurd[16..20].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff]);
    write("absurd.png", &absurd);
    for (arguments, words) in [
        (["a.jpg", "a.png"], "but seems to be JPEG"),
        (["a.png", "a.jpg"], "but seems to be JPEG"),
        (["text.png", "a.png"], "it is no picture in PNG or OpenEXR"),
        (
            ["nan.exr", "a.png"],
            "its pixel (0, 0) holds a value that is no finite number",
        ),
        (["absurd.png", "a.png"], "cannot read absurd.png"),
        (["none.png", "a.png"], "cannot read none.png"),
        (
            ["a.scn", "a.png"],
            "a.scn is a scene: the picture comes first",
        ),
        (["-", "-"], "`-` is given twice"),
    ] {
        let (status, text) = diff(&folder, &arguments);
        assert!(status == 2 && text.contains(words), "{arguments:?}: {text}");
    }
    write("bad.scn", b"sphere {}");
    assert_eq!(diff(&folder, &["a.png", "bad.scn"]).0, 1);
    assert_eq!(
        diff(&folder, &["a.png", "a.png", "--set", "Ball.radius=2"]).0,
        2
    );
    assert_eq!(diff(&folder, &["a.png", "a.png", "--tolerance", "-1"]).0, 2);
}

#[test]
fn mistakes_of_the_whole_picture_are_named() {
    let folder = folder();
    let picture = open(&folder, "a.png").to_rgb8();
    let flipped = |edit: &dyn Fn(&mut image::RgbImage)| {
        let mut other = picture.clone();
        edit(&mut other);
        save(&folder, "b.png", other);
        let of_scene = mistake(&folder);
        let found = json(&folder, &["b.png", "a.png"]);
        assert_eq!(found["likely"][0]["mistake"], of_scene.as_str());
        of_scene
    };
    assert_eq!(
        flipped(&image::imageops::flip_horizontal_in_place),
        "mirrored"
    );
    assert_eq!(
        flipped(&image::imageops::flip_vertical_in_place),
        "upside_down"
    );
    assert_eq!(flipped(&image::imageops::rotate180_in_place), "turned_180");
    let bytes = |change: &'static dyn Fn(f64) -> f64| {
        move |picture: &mut image::RgbImage| {
            for pixel in picture.pixels_mut() {
                pixel.0 = pixel
                    .0
                    .map(|byte| (255.0 * change(f64::from(byte) / 255.0)).round() as u8);
            }
        }
    };
    let decode = |c: f64| {
        if c <= 0.04045 {
            c / 12.92
        } else {
            libm::pow((c + 0.055) / 1.055, 2.4)
        }
    };
    let encode = |c: f64| {
        if c <= 0.0031308 {
            12.92 * c
        } else {
            1.055 * libm::pow(c, 1.0 / 2.4) - 0.055
        }
    };
    assert_eq!(flipped(&bytes(Box::leak(Box::new(decode)))), "not_encoded");
    assert_eq!(
        flipped(&bytes(Box::leak(Box::new(encode)))),
        "encoded_twice"
    );
    let swap =
        |picture: &mut image::RgbImage| picture.pixels_mut().for_each(|pixel| pixel.0.reverse());
    assert_eq!(flipped(&swap), "channels");
}

#[test]
fn mistakes_that_another_scene_makes_are_named() {
    let folder = folder();
    for (set, expected) in [
        ("camera.roll=-10deg", "roll_sign"),
        ("camera.roll=0deg", "roll_ignored"),
        ("camera.roll=10rad", "roll_unit"),
        ("camera.roll=37deg", "roll"),
        ("camera.d=1.375", "field_of_view"),
        ("camera.d=4.125", "field_of_view"),
        ("camera.d=2.1", "distance"),
        ("camera.direction=(0.2, 0.8, 0)", "lookat_as_direction"),
        ("camera.direction=(2.8, 2.7, 8)", "looks_back"),
        ("Ball.color=red", "color"),
        ("image.background=black", "color"),
        ("Ball.radius=2", "object_size"),
        ("Ball.radius=1.3", "object_size"),
        ("Ball.center=(-1.6, 0, 0)", "object_place"),
        ("Ball.center=(-1.2, 1.3, 0)", "object_place"),
        ("Crate.center=(2.25, 1.5, 0.5)", "object_place"),
        ("Crate.center=(2.3, 0.75, -0.5)", "object_place"),
        ("Sail.spin=180deg", "object_orientation"),
        ("Sail.sides=(0.0001, 0.0001, 0.0001)", "object_missing"),
    ] {
        render(&folder, &["-o", "b.png", "--set", set]);
        assert_eq!(mistake(&folder), expected, "{set}");
    }
    render(&folder, &["-o", "b.png", "--set", "camera.d=2.1"]);
    let (_, text) = diff(&folder, &["b.png", "a.scn"]);
    assert!(text.contains("as if d were 2.1 instead of 2.75"), "{text}");
}

#[test]
fn mistakes_of_the_checkerboard_are_named() {
    let folder = folder();
    let swapped = SCENE.replace("checkerboard {}", "checkerboard { colors (white, gray) }");
    for (text, expected) in [
        (swapped.clone(), "board_swapped"),
        (
            SCENE.replace("checkerboard {}", "checkerboard { square 2 }"),
            "board_square",
        ),
        (SCENE.replace("checkerboard {}", ""), "object_missing"),
    ] {
        fs::write(folder.path().join("b.scn"), text).unwrap();
        assert!(
            pinhole(folder.path(), &["render", "b.scn"])
                .status
                .success()
        );
        assert_eq!(mistake(&folder), expected);
    }
}

#[test]
fn mistakes_of_sampling_are_named() {
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
    for method in ["random", "multi_jittered", "sobol", "jittered", "regular"] {
        for count in [4, 16, 64] {
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
    for (set, expected) in [
        ("camera.roll=-10deg", "roll_sign"),
        ("camera.d=2.1", "distance"),
        ("Ball.color=red", "color"),
    ] {
        render(&folder, &[&noisy[..], &["--set", set]].concat());
        assert_eq!(mistake(&folder), expected, "{set}");
    }
}

#[test]
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
