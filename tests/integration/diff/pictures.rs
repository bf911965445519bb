//! How far pictures differ, said to people and programs, and drawn.

use std::fs;

use image::{DynamicImage, GenericImageView, ImageBuffer, Rgb, Rgba};
use serde_json::Value;

use super::{diff, folder, json, open, render, save};
use crate::effort::{Effort, sampled_and_exhaustive};

sampled_and_exhaustive!(pictures_of_all_kinds_are_equal);

fn pictures_of_all_kinds_are_equal(effort: Effort) {
    let folder = folder();
    render(&folder, &["-o", "a.exr"]);
    let picture = open(&folder, "a.png");
    save(&folder, "alpha.png", picture.to_rgba8());
    save(&folder, "wide.png", picture.to_rgb16());
    save(&folder, "wide_alpha.png", picture.to_rgba16());
    let everything = ["a.png", "a.exr", "alpha.png", "wide.png", "wide_alpha.png"];
    for a in effort.first(2, everything) {
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
    for (a, b) in effort.of([
        ("a.png", "a.exr"),
        ("a.exr", "a.png"),
        ("a.exr", "a.scn"),
        ("a.png", "a.scn"),
    ]) {
        assert_eq!(diff(&folder, &[a, b]).0, 0, "{a}, {b}");
    }
    if effort == Effort::Sample {
        return;
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
fn a_format_that_changes_colours_is_told() {
    let folder = folder();
    let picture = open(&folder, "a.png");
    for (name, words) in [
        ("b.jpg", "warning: b.jpg: its coding is lossy"),
        ("b.gif", "warning: b.gif: it has 256 colours at most"),
    ] {
        picture.save(folder.path().join(name)).unwrap();
        let (_, text) = diff(&folder, &[name, "a.png", "--tolerance", "255"]);
        assert!(text.starts_with(words), "{text}");
    }
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
fn palettes_and_few_bits_are_read() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let write =
        |name: &str, color, depth, edit: &dyn Fn(&mut png::Encoder<fs::File>), data: &[u8]| {
            let mut encoder = png::Encoder::new(fs::File::create(path(name)).unwrap(), 4, 2);
            encoder.set_color(color);
            encoder.set_depth(depth);
            edit(&mut encoder);
            let mut writer = encoder.write_header().unwrap();
            writer.write_image_data(data).unwrap();
        };
    let none = |_: &mut png::Encoder<fs::File>| {};
    let palette = vec![0, 0, 0, 255, 0, 0, 0, 128, 255, 255, 255, 255];
    let indices = [0u8, 1, 2, 3, 3, 2, 1, 0];
    let rgb: Vec<u8> = indices
        .iter()
        .flat_map(|&i| palette[3 * usize::from(i)..][..3].to_vec())
        .collect();
    let (color, depth) = (png::ColorType::Indexed, png::BitDepth::Eight);
    write("rgb.png", png::ColorType::Rgb, depth, &none, &rgb);
    let paint = |encoder: &mut png::Encoder<fs::File>| encoder.set_palette(palette.clone());
    write("byte.png", color, depth, &paint, &indices);
    let packed = [0b00_01_10_11, 0b11_10_01_00];
    write("packed.png", color, png::BitDepth::Two, &paint, &packed);
    let opaque = |encoder: &mut png::Encoder<fs::File>| {
        paint(encoder);
        encoder.set_trns(vec![0, 255, 255, 255]);
    };
    // Black that is not seen is seen as black.
    write("seen.png", color, depth, &opaque, &indices);
    for name in ["byte.png", "packed.png", "seen.png"] {
        let (status, text) = diff(&folder, &[name, "rgb.png", "--tolerance", "0"]);
        assert_eq!(status, 0, "{name}: {text}");
    }
    let through = |encoder: &mut png::Encoder<fs::File>| {
        paint(encoder);
        encoder.set_trns(vec![255, 0, 0, 0]);
    };
    write("through.png", color, depth, &through, &indices);
    write("black.png", png::ColorType::Rgb, depth, &none, &[0; 24]);
    assert_eq!(
        diff(&folder, &["through.png", "black.png", "--tolerance", "0"]).0,
        0
    );
    // 0 to 3 of 2 bits, and the same of 16, with and without alpha.
    let gray: Vec<u8> = indices.iter().map(|&i| 85 * i).collect();
    write("gray.png", png::ColorType::Grayscale, depth, &none, &gray);
    write(
        "gray2.png",
        png::ColorType::Grayscale,
        png::BitDepth::Two,
        &none,
        &packed,
    );
    let wide: Vec<u8> = gray.iter().flat_map(|&byte| [byte, byte]).collect();
    write(
        "gray16.png",
        png::ColorType::Grayscale,
        png::BitDepth::Sixteen,
        &none,
        &wide,
    );
    let alpha: Vec<u8> = gray
        .iter()
        .flat_map(|&byte| [byte, byte, 255, 255])
        .collect();
    let both = png::ColorType::GrayscaleAlpha;
    write("gray16a.png", both, png::BitDepth::Sixteen, &none, &alpha);
    for name in ["gray2.png", "gray16.png", "gray16a.png"] {
        let (status, text) = diff(&folder, &[name, "gray.png", "--tolerance", "0"]);
        assert_eq!(status, 0, "{name}: {text}");
    }
}

#[test]
fn pixels_that_cannot_be_judged_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let scene = "image { width 6 height 3 } camera { eye (0.31, 1.7, 2.2) direction (1, 0, -2) }
                 sampler { method exact } checkerboard { y 0 square 5e-324 }";
    fs::write(folder.path().join("a.scn"), scene).unwrap();
    render(&folder, &["-o", "a.exr"]);
    let found = json(&folder, &["a.exr", "a.scn", "--tolerance", "0"]);
    let undecided = found["undecided"].as_u64().unwrap();
    assert!(undecided > 0, "{found:#}");
    let (_, text) = diff(&folder, &["a.exr", "a.scn", "--tolerance", "0"]);
    assert!(
        text.contains(&format!("\nopen      {undecided} pixel")),
        "{text}"
    );
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
            "undecided",
            "tolerance",
            "equal",
            "likely",
            "thin",
            "may_be_noise"
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
    assert_eq!(found["undecided"], 0);
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
    let (status, text) = diff(&folder, &["a.png", "a.scn", "-o", "heat.png"]);
    assert_eq!(status, 0);
    assert!(
        text.ends_with("\nheat.png: black all over: nothing differs by more than the tolerance\n"),
        "{text}"
    );
    assert!(
        open(&folder, "heat.png")
            .to_rgb8()
            .pixels()
            .all(|pixel| pixel.0 == [0; 3])
    );
    for (wrong, words) in [
        ("heat.exr", "a heat map is a PNG"),
        ("b.png", "b.png is compared"),
        ("no/heat.png", "cannot write to"),
    ] {
        let (status, text) = diff(&folder, &["b.png", "a.scn", "-o", wrong]);
        assert!(status == 2 && text.contains(words), "{text}");
    }
}

sampled_and_exhaustive!(sizes_that_differ_are_named);

fn sizes_that_differ_are_named(effort: Effort) {
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
    render(&folder, &["-o", "b.png", "--set", "image.width=48"]);
    for (other, help) in effort.of([
        ("a.scn", "help: render it in the size that the scene says"),
        (
            "a.png",
            "help: pictures can be compared that have the same size",
        ),
    ]) {
        let (_, text) = diff(&folder, &["b.png", other]);
        let words = "another shape: 48 × 64 pixels where 96 × 64 are wanted";
        assert!(text.contains(words) && text.contains(help), "{text}");
    }
    if effort == Effort::Sample {
        return;
    }
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
    write("a.hdr", b"#?RADIANCE\n");
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
    write("empty.EXR", b"");
    for (arguments, words) in [
        (
            ["a.jpg", "a.png"],
            "it begins as a JPEG file does, but is damaged",
        ),
        (["a.png", "a.hdr"], "but seems to be HDR"),
        (["text.png", "a.png"], "it is no picture in PNG, OpenEXR"),
        (
            ["nan.exr", "a.png"],
            "its pixel (0, 0) holds a value that is no finite number",
        ),
        (["absurd.png", "a.png"], "cannot read absurd.png"),
        (["none.png", "a.png"], "cannot read none.png"),
        (
            ["a.png", "text.png"],
            "cannot read text.png: it is no picture in PNG, OpenEXR",
        ),
        (
            ["a.png", "empty.EXR"],
            "cannot read empty.EXR: it is no picture in PNG, OpenEXR",
        ),
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
fn pictures_of_two_sizes_have_no_scene_to_set() {
    let folder = folder();
    let size = ["--set", "image.width=48", "--set", "image.height=32"];
    render(&folder, &[&["-o", "b.png"], &size[..]].concat());
    let help = |other: &str| {
        let found = json(&folder, &["b.png", other]);
        assert_eq!(found["likely"][0]["mistake"], "resolution");
        found["likely"][0]["help"].as_str().unwrap().to_owned()
    };
    assert!(help("a.scn").contains("the size that the scene says"));
    assert!(!help("a.png").contains("scene") && !help("a.png").contains("--set"));
}

#[test]
fn a_picture_of_one_colour_is_no_matter_of_the_camera() {
    let folder = folder();
    let ball = Rgb([128u8, 128, 0]);
    let cases = [
        (Rgb([0, 0, 0]), "one colour, #000000: nothing was drawn"),
        (
            Rgb([0, 0, 128]),
            "one colour, the background's #000080: nothing was drawn, or no ray hits anything",
        ),
        (
            ball,
            "one colour, #808000: the sphere `Ball` hides all else, or the eye is in it",
        ),
    ];
    for (color, words) in cases {
        save(&folder, "b.png", ImageBuffer::from_pixel(96, 64, color));
        let found = json(&folder, &["b.png", "a.scn"]);
        let first = &found["likely"][0];
        assert_eq!(first["mistake"], "one_color");
        assert_eq!(first["message"], format!("the whole picture is {words}"));
        // A camera that looks past everything shows the background.
        let is_alone = found["likely"].as_array().unwrap().len() == 1;
        assert_eq!(is_alone, color != Rgb([0, 0, 128]), "{found:#}");
        let found = json(&folder, &["b.png", "a.png"]);
        assert_eq!(found["likely"][0]["mistake"], "one_color", "{found:#}");
    }
    // Where the scene has one colour, too, something was drawn, of another one.
    let inside = ["--set", "camera.eye=(-1.6, 1, 0.1)"];
    save(
        &folder,
        "b.png",
        ImageBuffer::from_pixel(96, 64, Rgb([0u8; 3])),
    );
    let found = json(&folder, &[&["b.png", "a.scn"], &inside[..]].concat());
    assert_ne!(found["likely"][0]["mistake"], "one_color", "{found:#}");
}

#[test]
fn a_byte_is_written_as_a_whole_number() {
    let folder = folder();
    save(
        &folder,
        "b.png",
        ImageBuffer::from_pixel(96, 64, Rgb([255u8; 3])),
    );
    save(
        &folder,
        "c.png",
        ImageBuffer::from_pixel(96, 64, Rgb([254u8, 3, 7])),
    );
    let found = json(&folder, &["b.png", "c.png"]);
    let largest = &found["largest"];
    assert_eq!(
        (&largest["a"], &largest["b"], &largest["error"]),
        (&255.0.into(), &3.0.into(), &252.0.into())
    );
}
