//! Mistakes of the picture, the camera and the objects.

use std::fs;

use image::{ImageBuffer, Rgb};
use tempfile::TempDir;

use super::{SCENE, diff, folder, json, mistake, open, pinhole, render, save};
use crate::effort::{Effort, sampled_and_exhaustive};

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
    // That the objects have other colours then is the same, said again.
    let found = json(&folder, &["b.png", "a.scn"]);
    assert_eq!(found["likely"].as_array().unwrap().len(), 1, "{found:#}");
}

#[test]
fn a_picture_that_is_turned_and_whose_light_is_wrong_is_named() {
    let folder = folder();
    render(&folder, &["-o", "a.exr"]);
    let light = open(&folder, "a.exr").to_rgb32f();
    let picture = ImageBuffer::from_fn(96, 64, |x, y| {
        let byte = |light: f32| (255.0 * light).round() as u8;
        Rgb(light.get_pixel(95 - x, y).0.map(byte))
    });
    save(&folder, "b.png", picture);
    for other in ["a.scn", "a.png"] {
        let found = json(&folder, &["b.png", other]);
        let first = &found["likely"][0];
        assert_eq!(first["mistake"], "mirrored", "{found:#}");
        let message = first["message"].as_str().unwrap();
        assert!(
            message.contains("; and the colours are too dark"),
            "{message}"
        );
    }
}

#[test]
fn a_power_in_place_of_the_curve_is_named() {
    let folder = folder();
    render(&folder, &["-o", "a.exr"]);
    let light = open(&folder, "a.exr").to_rgb32f();
    for (power, expected) in [(1.0 / 2.2, "gamma_22"), (0.5, "gamma_2")] {
        let picture = ImageBuffer::from_fn(96, 64, |x, y| {
            let byte = |light: f32| (255.0 * libm::pow(f64::from(light), power)).round() as u8;
            Rgb(light.get_pixel(x, y).0.map(byte))
        });
        save(&folder, "b.png", picture);
        assert_eq!(mistake(&folder), expected);
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_power_both_ways_is_named() {
    let folder = folder();
    // Decoded and encoded by the power 2.2: flat colours are right.
    let power = |byte: u8| libm::pow(f64::from(byte) / 255.0, 2.2);
    render(&folder, &FINE);
    let fine = open(&folder, "fine.png").to_rgb8();
    let picture = ImageBuffer::from_fn(96, 64, |x, y| {
        let mut sum = [0.0; 3];
        for (i, j) in (0..256).map(|k| (k % 16, k / 16)) {
            for (sum, byte) in sum.iter_mut().zip(fine.get_pixel(16 * x + i, 16 * y + j).0) {
                *sum += power(byte) / 256.0;
            }
        }
        Rgb(sum.map(|light| (255.0 * libm::pow(light, 1.0 / 2.2)).round() as u8))
    });
    save(&folder, "b.png", picture);
    assert_eq!(mistake(&folder), "gamma_22_averaged");
}

/// 256 samples of each pixel, in a picture of them.
const FINE: [&str; 10] = [
    "-o",
    "fine.png",
    "--set",
    "image.width=1536",
    "--set",
    "image.height=1024",
    "--set",
    "sampler.method=regular",
    "--set",
    "sampler.per_pixel=1",
];

#[test]
#[ignore = "exhaustive"]
fn one_object_among_many_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = SCENE.split("sphere").next().unwrap().to_owned() + "checkerboard {}\n";
    for i in 0..40 {
        let (x, z) = (f64::from(i % 8) - 4.0, -f64::from(i / 8));
        // Each of the same colour.
        scene += &format!("sphere {{ center ({x}, 0.4, {z}) radius 0.4 color red }}\n");
    }
    fs::write(folder.path().join("a.scn"), &scene).unwrap();
    let changed = |from: &str, to: &str| {
        assert!(scene.contains(from));
        fs::write(folder.path().join("b.scn"), scene.replace(from, to)).unwrap();
        assert!(
            pinhole(folder.path(), &["render", "b.scn"])
                .status
                .success()
        );
        let found = json(&folder, &["b.png", "a.scn"]);
        let first = &found["likely"][0];
        let text = |key: &str| first[key].as_str().unwrap_or("none").to_owned();
        (text("mistake"), text("message"))
    };
    let one = "sphere { center (1, 0.4, -4) radius 0.4 color red }\n";
    let (mistake, message) = changed(one, "");
    assert_eq!(mistake, "object_missing");
    assert_eq!(message, "the sphere with the index 38 is missing");
    let (mistake, message) = changed(one, &one.replace("0.4 color", "0.2 color"));
    assert_eq!(mistake, "object_size", "{message}");
}

#[test]
fn several_wrong_colours_are_named_at_once() {
    let folder = folder();
    let colors = ["--set", "Ball.color=red", "--set", "Crate.color=lime"];
    render(&folder, &[&["-o", "b.png"], &colors[..]].concat());
    let found = json(&folder, &["b.png", "a.scn"]);
    let first = &found["likely"][0];
    assert_eq!(first["mistake"], "colors", "{found:#}");
    let message = first["message"].as_str().unwrap();
    assert!(
        message.contains("`Ball` has the colour #ff0000")
            && message.contains("`Crate` has the colour #00ff00")
    );
}

sampled_and_exhaustive!(mistakes_that_another_scene_makes_are_named);

fn mistakes_that_another_scene_makes_are_named(effort: Effort) {
    let folder = folder();
    for (set, expected) in effort.of([
        ("camera.roll=-10deg", "roll_sign"),
        ("camera.roll=0deg", "roll_ignored"),
        ("camera.roll=10rad", "roll_unit"),
        ("camera.roll=37deg", "roll"),
        ("camera.d=1.375", "field_of_view"),
        ("camera.d=4.125", "field_of_view"),
        ("camera.d=2.1", "distance"),
        ("camera.eye=(3, 3.5, 9)", "eye"),
        ("camera.eye=(3, 3.5, -8)", "eye"),
        ("camera.eye=(2, 3.5, 8)", "eye"),
        ("camera.eye=(3, 3.8, 8)", "eye"),
        ("camera.lookat=(0.9, 0.8, 0)", "lookat"),
        ("camera.lookat=(0.2, 0, 0)", "lookat"),
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
    ]) {
        render(&folder, &["-o", "b.png", "--set", set]);
        assert_eq!(mistake(&folder), expected, "{set}");
    }
    if effort == Effort::Sample {
        return;
    }
    // It sees the background alone, as many another camera would.
    let set = "camera.direction=(0.2, 0.8, 0)";
    render(&folder, &["-o", "b.png", "--set", set]);
    let found = json(&folder, &["b.png", "a.scn"]);
    let names = found["likely"].as_array().unwrap().iter();
    let names: Vec<_> = names.map(|one| one["mistake"].as_str().unwrap()).collect();
    assert_eq!(names[0], "one_color");
    assert!(names.contains(&"lookat_as_direction"), "{names:?}");
    for (set, expected) in effort.of([
        ("Sail.normal=(-0.3, 0, 1)", "whose x has the wrong sign"),
        ("Sail.normal=(1, 0, 0.3)", "whose x and z are exchanged"),
        ("Sail.sides=(1, 2, 2)", "`Sail` has its sides"),
        ("Crate.size=(1.5, 0.5, 2)", "sizes along x and y exchanged"),
        ("Crate.size=(2, 1.5, 0.5)", "sizes along x and z exchanged"),
        ("Crate.size=(1, 1.5, 2)", "twice as long along x"),
        ("Crate.size=(0.5, 1.5, 1)", "half as long along z"),
    ]) {
        render(&folder, &["-o", "b.png", "--set", set]);
        let (_, text) = diff(&folder, &["b.png", "a.scn"]);
        assert!(text.contains(expected), "{set}: {text}");
    }
    render(&folder, &["-o", "b.png", "--set", "camera.d=2.1"]);
    let (_, text) = diff(&folder, &["b.png", "a.scn"]);
    assert!(text.contains("as if d were 2.1 instead of 2.75"), "{text}");
    render(&folder, &["-o", "b.png", "--set", "camera.eye=(3, 3.5, 9)"]);
    let (_, text) = diff(&folder, &["b.png", "a.scn"]);
    assert!(
        text.contains("likely    eye is in a wrong place: as if its z were 9 instead of 8"),
        "{text}"
    );
}

sampled_and_exhaustive!(fields_that_are_not_minded_are_named);

fn fields_that_are_not_minded_are_named(effort: Effort) {
    let folder = folder();
    for (sets, expected) in effort.of([
        (&["camera.near=8"][..], "near_ignored"),
        (&["camera.far=9.5"], "far_ignored"),
        (&["camera.near=8", "camera.far=9.5"], "not_clipped"),
        (&["camera.view_height=2.7"], "view_height_ignored"),
    ]) {
        let sets: Vec<_> = sets.iter().flat_map(|set| ["--set", *set]).collect();
        let found = json(&folder, &[&["a.png", "a.scn"], sets.as_slice()].concat());
        assert_eq!(found["likely"][0]["mistake"], expected, "{sets:?}");
    }
    let both = ["--set", "camera.near=8", "--set", "camera.far=9.5"];
    for (set, expected) in effort.of([
        ("camera.near=8", "far_ignored"),
        ("camera.far=9.5", "near_ignored"),
    ]) {
        render(&folder, &["-o", "b.png", "--set", set]);
        let found = json(&folder, &[&["b.png", "a.scn"], &both[..]].concat());
        assert_eq!(found["likely"][0]["mistake"], expected, "{set}");
    }
}

#[test]
fn an_up_vector_of_the_wrong_sign_is_named() {
    let folder = folder();
    render(&folder, &["-o", "b.png", "--set", "camera.up=(0, -1, 0)"]);
    let found = json(&folder, &["b.png", "a.scn"]);
    let found: Vec<_> = found["likely"]
        .as_array()
        .unwrap()
        .iter()
        .map(|likely| &likely["mistake"])
        .collect();
    // It turns the picture, and nobody can tell from the picture which it was.
    assert_eq!(found, ["turned_180", "up_negated"]);
}

#[test]
fn a_square_window_in_a_wide_picture_is_named() {
    let folder = folder();
    // A square of twice the width, of which two columns and three rows are taken together.
    let square = ["--set", "image.width=192", "--set", "image.height=192"];
    render(&folder, &[&["-o", "fine.exr"], &square[..]].concat());
    let fine = open(&folder, "fine.exr").to_rgb32f();
    let picture = ImageBuffer::from_fn(96, 64, |x, y| {
        let mut sum = [0.0; 3];
        for (i, j) in (0..6).map(|k| (k % 2, k / 2)) {
            for (sum, light) in sum.iter_mut().zip(fine.get_pixel(2 * x + i, 3 * y + j).0) {
                *sum += light / 6.0;
            }
        }
        Rgb(sum)
    });
    save(&folder, "b.exr", picture);
    let found = json(&folder, &["b.exr", "a.scn"]);
    assert_eq!(found["likely"][0]["mistake"], "squeezed", "{found:#}");
}

/// A board from above, of whose squares each has 4 × 4 pixels; x grows to the right and z downwards, and both change their sign
/// in the middle.
const ABOVE: &str = "image { width 96 height 64 }
camera { eye (0, 4, 0) direction (0, -1, 0) up (0, 0, -1) d 4 view_height 16 }
sampler { method exact } checkerboard { colors (gray, white) }
";

#[test]
fn whole_numbers_that_went_wrong_in_the_board_are_named() {
    let folder = folder();
    fs::write(folder.path().join("a.scn"), ABOVE).unwrap();
    type IsFirst = fn(f64, f64) -> bool;
    let ways: [(IsFirst, &str); 4] = [
        (
            |x, z| (x.floor() as i32 + z.floor() as i32).rem_euclid(2) == 0,
            "none",
        ),
        (|x, z| (x as i32 + z as i32) % 2 == 0, "board_truncated"),
        (
            |x, z| (x.floor() as i32 + z.floor() as i32) % 2 != 1,
            "board_remainder",
        ),
        (
            |x, z| x.floor() as i32 % 2 == z.floor() as i32 % 2,
            "board_remainder",
        ),
    ];
    for (is_first, expected) in ways {
        let picture = ImageBuffer::from_fn(96, 64, |x, y| {
            let (x, z) = ((f64::from(x) - 47.5) / 4.0, (f64::from(y) - 31.5) / 4.0);
            Rgb([if is_first(x, z) { 128u8 } else { 255 }; 3])
        });
        save(&folder, "b.png", picture);
        assert_eq!(mistake(&folder), expected);
    }
}

sampled_and_exhaustive!(mistakes_of_the_checkerboard_are_named);

fn mistakes_of_the_checkerboard_are_named(effort: Effort) {
    let folder = folder();
    let swapped = SCENE.replace("checkerboard {}", "checkerboard { colors (white, gray) }");
    for (text, expected) in effort.of([
        (swapped.clone(), "board_swapped"),
        (
            SCENE.replace("checkerboard {}", "checkerboard { square 2 }"),
            "board_square",
        ),
        (SCENE.replace("checkerboard {}", ""), "object_missing"),
    ]) {
        fs::write(folder.path().join("b.scn"), text).unwrap();
        assert!(
            pinhole(folder.path(), &["render", "b.scn"])
                .status
                .success()
        );
        assert_eq!(mistake(&folder), expected);
    }
}

/// What a program shows that draws the objects of the scene one after the other, whatever is nearer: with 64 samples in each
/// pixel, at the same places for all of them.
fn painted(folder: &TempDir, objects: &[&str]) -> image::RgbImage {
    const FINE: u32 = 8;
    let header: Vec<_> = SCENE.lines().take(2).collect();
    let navy = Rgb([0, 0, 128]);
    let mut fine = image::RgbImage::from_pixel(96 * FINE, 64 * FINE, navy);
    for object in objects {
        let object = SCENE.lines().find(|line| line.starts_with(object)).unwrap();
        let alone = format!(
            "{}\nsampler {{ method jittered }}\n{object}\n",
            header.join("\n")
        );
        let alone = alone.replace("width 96 height 64", "width 768 height 512");
        fs::write(folder.path().join("alone.scn"), alone).unwrap();
        let arguments = ["render", "alone.scn", "-o", "alone.png"];
        assert!(pinhole(folder.path(), &arguments).status.success());
        for (x, y, pixel) in open(folder, "alone.png").to_rgb8().enumerate_pixels() {
            if *pixel != navy {
                fine.put_pixel(x, y, *pixel);
            }
        }
    }
    let decode = |byte: u8| pinhole::color::srgb_to_linear(f64::from(byte) / 255.0);
    ImageBuffer::from_fn(96, 64, |x, y| {
        Rgb([0, 1, 2].map(|channel| {
            let block = (0..FINE * FINE).map(|at| [FINE * x + at % FINE, FINE * y + at / FINE]);
            let light: f64 = block
                .map(|[x, y]| decode(fine.get_pixel(x, y)[channel]))
                .sum();
            let mean = light / f64::from(FINE * FINE);
            (255.0 * pinhole::color::linear_to_srgb(mean)).round() as u8
        }))
    })
}

sampled_and_exhaustive!(objects_drawn_in_a_wrong_order_are_named);

fn objects_drawn_in_a_wrong_order_are_named(effort: Effort) {
    let folder = folder();
    let (camera, objects): (Vec<_>, Vec<_>) = SCENE.lines().partition(|line| {
        ["image", "camera", "sampler"]
            .iter()
            .any(|block| line.starts_with(block))
    });
    let objects_of = |kinds: [&str; 4]| {
        let object = |kind| *objects.iter().find(|line| line.starts_with(kind)).unwrap();
        kinds.map(object)
    };
    // The last one drawn is seen. From the nearest to the farthest they are triangle, box, sphere and board.
    for (drawn, in_the_file, words) in effort.of([
        (
            ["sphere", "triangle", "box", "checkerboard"],
            ["sphere", "triangle", "box", "checkerboard"],
            "the last one in the file",
        ),
        (
            ["sphere", "triangle", "box", "checkerboard"],
            ["checkerboard", "box", "triangle", "sphere"],
            "the first one in the file",
        ),
        (
            ["triangle", "box", "sphere", "checkerboard"],
            ["box", "checkerboard", "sphere", "triangle"],
            "the farthest one",
        ),
    ]) {
        save(&folder, "b.png", painted(&folder, &drawn));
        let lines = [camera.as_slice(), &objects_of(in_the_file)].concat();
        fs::write(folder.path().join("a.scn"), lines.join("\n")).unwrap();
        let found = json(&folder, &["b.png", "a.scn"]);
        let first = &found["likely"][0];
        assert_eq!(first["mistake"], "depth_ignored", "{found:#}");
        let message = first["message"].as_str().unwrap();
        assert!(message.contains(words), "{message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn an_object_that_the_scene_does_not_have_is_named() {
    let folder = folder();
    let extra = format!("{SCENE}sphere {{ center (1, 1.2, 1.6) radius 0.4 color crimson }}\n");
    fs::write(folder.path().join("b.scn"), extra).unwrap();
    for samples in [None, Some("64")] {
        let mut arguments = vec!["render", "b.scn", "-o", "b.png"];
        let set = samples.map(|samples| format!("sampler.per_pixel={samples}"));
        if let Some(set) = &set {
            arguments.extend(["--set", "sampler.method=multi_jittered", "--set", set]);
        }
        assert!(pinhole(folder.path(), &arguments).status.success());
        let found = json(&folder, &["b.png", "a.scn"]);
        let first = &found["likely"][0];
        assert_eq!(first["mistake"], "object_extra", "{samples:?}: {found:#}");
        let message = first["message"].as_str().unwrap();
        assert!(message.contains("#dc143c"), "{message}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn one_size_that_is_wrong_is_named() {
    let folder = folder();
    for (set, words) in [
        (
            "Crate.size=(0.5, 1.8, 2)",
            "as if its size along y were 1.8 instead of 1.5",
        ),
        (
            "Sail.sides=(2, 2.3, 1)",
            "as if its side b were 2.3 instead of 2",
        ),
    ] {
        render(&folder, &["-o", "b.png", "--set", set]);
        let found = json(&folder, &["b.png", "a.scn"]);
        let first = &found["likely"][0];
        assert_eq!(first["mistake"], "object_size", "{set}: {found:#}");
        assert!(
            first["message"].as_str().unwrap().contains(words),
            "{found:#}"
        );
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_power_that_bytes_were_taken_through_is_named() {
    let folder = folder();
    for (sampler, power, expected) in [
        ("exact", 1.0 / 2.2, "gamma_22"),
        ("exact", 0.5, "gamma_2"),
        ("jittered", 0.5, "gamma_2"),
    ] {
        let method = format!("sampler.method={sampler}");
        render(&folder, &["-o", "b.png", "--set", &method]);
        let mut picture = open(&folder, "b.png").to_rgb8();
        for pixel in picture.pixels_mut() {
            pixel.0 = pixel.0.map(|byte| {
                let light = pinhole::color::srgb_to_linear(f64::from(byte) / 255.0);
                (255.0 * libm::pow(light, power)).round() as u8
            });
        }
        save(&folder, "b.png", picture);
        assert_eq!(mistake(&folder), expected, "{sampler}");
    }
}

#[test]
fn a_view_that_is_not_minded_is_named() {
    let folder = folder();
    render(
        &folder,
        &["-o", "b.png", "--set", "camera.lookat=(0, 0, 0)"],
    );
    assert_eq!(mistake(&folder), "view_ignored");
}
