//! Tests of the command `pinhole diff`: comparing two pictures, and judging a picture of a scene
//! (`verdicts`).

mod verdicts;

use std::{fs, io::Cursor};

use image::{DynamicImage, ImageBuffer, Rgb, Rgba};
use pinhole::{
    area::Area,
    color::srgb_to_linear,
    film::{Film, write_exr},
};
use serde_json::{Value, json};

use crate::{program::Folder, table::rows};

/// Small scene in which `diff` finds mistakes quickly.
const SCENE: &str = "image { width 60 height 40 background navy }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sampler { method exact }
sphere Ball { center (-1, 1, 0) }
triangle Sail { centroid (0.8, 1, 0.6) normal (0.3, 0, 1) sides (2, 2, 1) }
box { center (2.2, 0.75, -0.5) }
";

/// Returns a folder that has [`SCENE`] in `a.scn` and its exact picture in `a.png`.
fn folder() -> Folder {
    let folder = Folder::with([("a.scn", SCENE)]);
    render(&folder, "-o a.png");
    folder
}

fn render(folder: &Folder, arguments: &str) {
    folder.told(&format!("render a.scn {arguments}"), 0);
}

/// Returns the JSON output of `diff` with the arguments `compared`.
fn json(folder: &Folder, compared: &str) -> Value {
    let said = folder.run(&format!("diff {compared} --format json"));
    assert_eq!(said.errors, "");
    said.json()
}

fn open(folder: &Folder, name: &str) -> DynamicImage {
    image::open(folder.path(name)).unwrap()
}

fn save(folder: &Folder, name: &str, picture: impl Into<DynamicImage>) {
    picture.into().save(folder.path(name)).unwrap();
}

/// Runs `diff` for each row of `table`: the arguments, the exit status, and the expected start of
/// the output. If the last cell begins with `…`, the output must contain the rest of the cell
/// anywhere.
#[track_caller]
fn compare(folder: &Folder, table: &'static str) {
    for [compared, status, words] in rows(table) {
        let text = folder.told(&format!("diff {compared}"), status.parse().unwrap());
        let is_told = match words.strip_prefix('…') {
            Some(part) => text.contains(part),
            None => text.starts_with(words),
        };
        assert!(is_told, "{compared}: {text}");
    }
}

#[test]
fn two_pictures_have_figures_and_no_verdict() {
    let folder = Folder::with([]);
    let mut picture = ImageBuffer::from_pixel(2, 1, Rgb([10u8, 20, 30]));
    save(&folder, "b.png", picture.clone());
    picture.put_pixel(1, 0, Rgb([10, 20, 50]));
    save(&folder, "c.png", picture);
    assert_eq!(
        folder.told("diff b.png c.png", 1),
        "b.png and c.png differ

size      2 x 1 pixels
beyond    1 of 2 pixels (50 %) differ by more than 1 step of 8-bit sRGB
largest   20 steps: blue of pixel (1, 0) is 30 in A and 50 in B, of 255
rmse      0.00772 in linear light, where white is 1
"
    );
    let found = json(&folder, "b.png c.png");
    let expected = json!({
        "a": "b.png", "b": "c.png", "width": 2, "height": 1, "size_b": [2, 1],
        "rmse": found["rmse"],
        "largest": { "error": 20.0, "x": 1, "y": 0, "channel": "blue", "a": 30.0, "b": 50.0 },
        "beyond": { "pixels": 1, "share": 0.5 }, "undecided": 0, "tolerance": 1.0, "equal": false,
    });
    assert_eq!(found, expected);
    folder.told("diff b.png c.png --tolerance 20", 0);
}

#[test]
fn a_difference_is_told_to_three_digits_below_a_tenth_of_a_step_and_else_to_hundredths() {
    let folder = Folder::with([]);
    let whole = Area::whole(1, 1);
    let write = |name: &str, steps: f64| {
        let film = Film::from_fn(1, 1, |_, _| [srgb_to_linear(steps / 255.0); 3]).unwrap();
        let mut bytes = Cursor::new(Vec::new());
        write_exr(&film, whole, whole, &mut bytes).unwrap();
        folder.write(name, bytes.into_inner());
    };
    write("black.exr", 0.0);
    for (steps, told) in [
        (0.000_123_45, "0.000123"),
        (0.098_76, "0.0988"),
        (0.123_45, "0.12"),
        (7.654_32, "7.65"),
    ] {
        write("a.exr", steps);
        let text = folder.run("diff a.exr black.exr").errors;
        let line = format!("{told} steps: red of pixel (0, 0) is {told} in A and 0 in B, of 255");
        assert!(text.contains(&line), "{steps}: {text}");
    }
}

#[test]
fn pictures_are_compared_by_content_across_formats() {
    let folder = folder();
    render(&folder, "-o a.exr");
    let picture = open(&folder, "a.png");
    save(&folder, "alpha.png", picture.to_rgba8());
    save(&folder, "wide.png", picture.to_rgb16());
    for name in ["a.ppm", "a.bmp", "a.tiff", "a.webp", "b.jpg", "b.gif"] {
        save(&folder, name, picture.to_rgb8());
    }
    // The picture is white with half opacity, and `diff` shows it on black. Opacity mixes linear
    // light, and half of the light of white is 187.5 as an sRGB value, rounded to 188 as a byte.
    let half = ImageBuffer::from_pixel(96, 64, Rgba([65535u16, 65535, 65535, 32768]));
    save(&folder, "half.png", half);
    let mixed = ImageBuffer::from_pixel(96, 64, Rgb([188u8; 3]));
    save(&folder, "mixed.png", mixed);
    compare(
        &folder,
        "
        a.png a.exr --tolerance 0.501 -> 0 -> a.png and a.exr are equal:
        a.exr a.exr --tolerance 0.501 -> 0 -> a.exr and a.exr are equal:
        alpha.png a.exr --tolerance 0.501 -> 0 -> alpha.png and a.exr are equal:
        wide.png a.exr --tolerance 0.501 -> 0 -> wide.png and a.exr are equal:
        a.ppm a.exr --tolerance 0.501 -> 0 -> a.ppm and a.exr are equal:
        a.bmp a.exr --tolerance 0.501 -> 0 -> a.bmp and a.exr are equal:
        a.tiff a.exr --tolerance 0.501 -> 0 -> a.tiff and a.exr are equal:
        a.webp a.exr --tolerance 0.501 -> 0 -> a.webp and a.exr are equal:
        half.png mixed.png -> 0 -> half.png and mixed.png are equal:
        b.jpg a.png --tolerance 255 -> 0 -> warning: b.jpg: its coding is lossy
        b.gif a.png --tolerance 255 -> 0 -> warning: b.gif: it has 256 colours at most
    ",
    );
}

#[test]
fn a_transfer_curve_other_than_srgb_gives_a_warning() {
    let folder = Folder::with([]);
    // Returns an ICC profile with a single tag: the transfer curve `curve` of the red channel.
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
        let file = fs::File::create(folder.path("b.png")).unwrap();
        let encoder = png::Encoder::with_info(file, info).unwrap();
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(&[77]).unwrap();
        writer.finish().unwrap();
        let text = folder.told("diff b.png b.png", 0);
        let words = "warning: b.png: its gAMA or iCCP says";
        assert_eq!(text.starts_with(words), is_told, "{gamma:?} {curve:?}");
    }
}

#[test]
fn standard_input_is_a_picture_or_a_scene() {
    let folder = folder();
    for (line, input) in [
        ("diff - a.scn", "a.png"),
        ("diff a.png -", "a.scn"),
        ("diff a.png -", "a.png"),
    ] {
        let said = folder.run_reading(line, folder.read(input));
        assert_eq!(said.status, 0, "{line}: {}", said.errors);
    }
}

#[test]
fn different_sizes_are_reported_with_a_remedy() {
    let folder = folder();
    save(&folder, "b.png", image::RgbImage::new(48, 32));
    // The crop comes from a picture that is wider than the scene's 60 pixels. Its position is
    // outside the scene's picture, so `diff` must refuse to compare the two.
    render(&folder, "-o c.png --set image.width=200 --crop 150,5,40,30");
    compare(
        &folder,
        r"
        b.png a.scn -> 2 -> error: b.png has 48 × 32 pixels, and the scene's picture 60 × 40: `--set image.width=48 --set image.height=32` compares
        b.png a.png -o heat.png -> 1 -> …A         48 x 32 pixels\nB         60 x 40 pixels\n
        b.png a.png -o heat.png -> 1 -> …pictures of different sizes have no heat map
        c.png a.scn -> 2 -> …which does not lie within the scene's 60 × 40 pixels
    ",
    );
    let found = json(&folder, "b.png a.png");
    assert_eq!(
        (&found["rmse"], &found["equal"]),
        (&json!(null), &json!(false))
    );
}

#[test]
fn a_heat_map_has_the_size_of_the_picture() {
    let folder = folder();
    render(&folder, "-o b.png --set Ball.color=red");
    compare(
        &folder,
        r"
        a.png a.scn -o black.png -> 0 -> …\nblack.png: black all over: nothing differs by more than the tolerance\n
        b.png a.scn -o heat.png -> 1 -> …\nheat.png: black: within the tolerance; red: 85 steps
        b.png a.scn -o heat.exr -> 2 -> …a heat map is a PNG
        b.png a.scn -o b.png -> 2 -> …b.png is compared
        b.png a.scn -o no/heat.png -> 2 -> …cannot write to
    ",
    );
    let [heat, black] = ["heat.png", "black.png"].map(|name| open(&folder, name).to_rgb8());
    assert_eq!(heat.dimensions(), (60, 40));
    assert!(heat.pixels().any(|pixel| pixel.0[0] == 255));
    assert_eq!(heat.get_pixel(0, 0).0, [0; 3]);
    assert!(black.pixels().all(|pixel| pixel.0 == [0; 3]));
}

#[test]
fn pixels_that_cannot_be_judged_are_counted() {
    let scene = "image { width 6 height 3 } camera { eye (0.31, 1.7, 2.2) direction (1, 0, -2) }
                 sampler { method exact } checkerboard { y 0 square 5e-324 }";
    let folder = Folder::with([("a.scn", scene)]);
    render(&folder, "-o a.exr");
    let compared = "a.exr a.scn --tolerance 0";
    let undecided = json(&folder, compared)["undecided"].as_u64().unwrap();
    assert!(undecided > 0);
    let text = folder.run(&format!("diff {compared}")).errors;
    let words = format!("\nopen      {undecided} pixel");
    assert!(text.contains(&words), "{text}");
}

#[test]
fn unreadable_or_mismatched_inputs_are_errors() {
    let folder = folder();
    folder.write("text.png", "no picture");
    folder.write("empty.EXR", "");
    folder.write("bad.scn", "sphere {}");
    folder.write("a.jpg", [0xff, 0xd8, 0xff, 0xe0, 0, 1]);
    let mut nan = include_bytes!("../../film/half_green.exr").to_vec();
    let halves = [0, 0x38, 0, 0x38];
    let green = nan.windows(4).position(|bytes| *bytes == halves).unwrap();
    nan[green + 1] = 0x7e;
    folder.write("nan.exr", nan);
    compare(
        &folder,
        "
        text.png a.png -> 2 -> …it is no picture in PNG, OpenEXR
        a.png text.png -> 2 -> …cannot read text.png: it is no picture
        a.png empty.EXR -> 2 -> …cannot read empty.EXR: it is no
        a.jpg a.png -> 2 -> …it begins as JPEG files do, but is
        nan.exr a.png -> 2 -> …its pixel (0, 0) holds a value that
        none.png a.png -> 2 -> …cannot read none.png
        a.scn a.png -> 2 -> …a.scn is a scene: the picture comes first
        - - -> 2 -> …`-` is given twice
        a.png a.png --set Ball.radius=2 -> 2 -> …`--set` changes a scene
        a.png a.png --tolerance -1 -> 2 -> …--tolerance
        a.png bad.scn -> 1 -> …center
    ",
    );
}
