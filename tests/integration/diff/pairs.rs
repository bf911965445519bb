//! Two mistakes at once.

use std::fs;

use image::RgbImage;
use tempfile::TempDir;

use super::{SCENE, folder, json, open, pinhole, save};
use crate::effort::{Effort, sampled_and_exhaustive};

/// The first thing that is said of the picture of the scene with some of its text replaced, edited then.
fn said(folder: &TempDir, replaced: &[(&str, &str)], edit: &dyn Fn(&mut RgbImage)) -> String {
    let mut text = SCENE.to_owned();
    for (from, to) in replaced {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    fs::write(folder.path().join("b.scn"), text).unwrap();
    let output = pinhole(folder.path(), &["render", "b.scn"]);
    assert!(output.status.success(), "{output:?}");
    let mut picture = open(folder, "b.png").to_rgb8();
    edit(&mut picture);
    save(folder, "b.png", picture);
    let found = json(folder, &["b.png", "a.scn"]);
    assert!(found["likely"].as_array().unwrap().len() < 2, "{found:#}");
    let first = &found["likely"][0]["message"];
    first.as_str().unwrap_or("nothing").to_owned()
}

const ROLLED: (&str, &str) = ("roll 10deg", "roll -10deg");
const NEARER: (&str, &str) = ("d 2.75", "d 2.1");
const SWAPPED: (&str, &str) = ("checkerboard {}", "checkerboard { colors (white, gray) }");
const MOVED: (&str, &str) = ("center (-1.6, 1, 0)", "center (-1.3, 1, 0)");

const OF_ROLL: &str = "the roll has the wrong sign: -10 degrees instead of 10";
const OF_DISTANCE: &str = "as if d were 2.1 instead of 2.75";
const OF_BOARD: &str = "the checkerboard's two colours are exchanged";
const OF_BALL: &str =
    "the sphere `Ball` is in a wrong place: as if the x of its middle were -1.3 instead of -1.6";
const OF_MIRROR: &str = "the picture is mirrored: left and right are exchanged";
const OF_LIGHT: &str = "the colours are too dark";
const OF_ORDER: &str = "the colour channels are in the order blue, green, red";

fn mirrored(picture: &mut RgbImage) {
    image::imageops::flip_horizontal_in_place(picture);
}

fn reversed(picture: &mut RgbImage) {
    picture.pixels_mut().for_each(|pixel| pixel.0.reverse());
}

/// Light that is written where sRGB is expected.
fn dark(picture: &mut RgbImage) {
    let decoded = |byte: u8| {
        let encoded = f64::from(byte) / 255.0;
        let light = match encoded <= 0.04045 {
            true => encoded / 12.92,
            false => libm::pow((encoded + 0.055) / 1.055, 2.4),
        };
        (255.0 * light).round() as u8
    };
    for pixel in picture.pixels_mut() {
        pixel.0 = pixel.0.map(decoded);
    }
}

fn as_it_is(_: &mut RgbImage) {}

sampled_and_exhaustive!(two_mistakes_are_both_named);

fn two_mistakes_are_both_named(effort: Effort) {
    let folder = folder();
    type Edit = fn(&mut RgbImage);
    type Both = (
        &'static [(&'static str, &'static str)],
        Edit,
        [&'static str; 2],
    );
    let cases: [Both; 10] = [
        (
            &[],
            |picture| {
                mirrored(picture);
                dark(picture)
            },
            [OF_MIRROR, OF_LIGHT],
        ),
        (&[ROLLED, NEARER], as_it_is, [OF_ROLL, OF_DISTANCE]),
        (&[ROLLED, SWAPPED], as_it_is, [OF_ROLL, OF_BOARD]),
        (&[ROLLED], mirrored, [OF_ROLL, OF_MIRROR]),
        (&[SWAPPED], dark, [OF_BOARD, OF_LIGHT]),
        (&[SWAPPED], reversed, [OF_BOARD, OF_ORDER]),
        (&[NEARER], mirrored, [OF_MIRROR, OF_DISTANCE]),
        (&[MOVED], dark, [OF_LIGHT, OF_BALL]),
        (&[MOVED], mirrored, [OF_MIRROR, OF_BALL]),
        (&[MOVED, SWAPPED], as_it_is, [OF_BOARD, OF_BALL]),
    ];
    for (replaced, edit, expected) in effort.of(cases) {
        let said = said(&folder, replaced, &edit);
        for expected in expected {
            assert!(said.contains(expected), "{replaced:?}: {said}");
        }
    }
}

sampled_and_exhaustive!(noise_is_no_second_mistake);

fn noise_is_no_second_mistake(effort: Effort) {
    let folder = folder();
    type One = (
        &'static [(&'static str, &'static str)],
        fn(&mut RgbImage),
        &'static str,
    );
    let cases: [One; 3] = [
        (&[], dark, OF_LIGHT),
        (&[ROLLED], as_it_is, OF_ROLL),
        (&[], mirrored, OF_MIRROR),
    ];
    for (replaced, edit, expected) in effort.of(cases) {
        for samples in effort.of([4, 16]) {
            let sampler = format!("method random per_pixel {samples}");
            let replaced = [replaced, &[("method exact", &*sampler)]].concat();
            let said = said(&folder, &replaced, &edit);
            assert!(said.starts_with(expected), "{samples}: {said}");
            assert!(!said.contains("; and "), "{samples}: {said}");
        }
    }
}

#[test]
#[ignore = "exhaustive"]
fn what_one_mistake_explains_is_not_laid_on_two() {
    let folder = folder();
    for (replaced, expected) in [
        (MOVED, OF_BALL),
        (
            ("center (-1.6, 1, 0)", "center (-1.6, 1, 1.5)"),
            "the sphere `Ball` is in a wrong place: as if the z",
        ),
        (NEARER, "the view plane is at the wrong distance"),
        (
            ("d 2.75", "d 1.43"),
            "the view plane is at the wrong distance: as if d were 1.43",
        ),
        (
            ("d 2.75", "d 5.2"),
            "the view plane is at the wrong distance: as if d were 5.2",
        ),
        (("roll 10deg", "roll -6deg"), "the camera is rolled wrongly"),
        (
            ("eye (3, 3.5, 8)", "eye (3, 3.5, 6.5)"),
            "eye is in a wrong place: as if its z",
        ),
        (
            ("eye (3, 3.5, 8)", "eye (-2, 3.5, 8)"),
            "eye is in a wrong place: as if its x",
        ),
    ] {
        let said = said(&folder, &[replaced], &as_it_is);
        assert!(said.starts_with(expected), "{replaced:?}: {said}");
        assert!(!said.contains("; and "), "{replaced:?}: {said}");
    }
}

#[test]
#[ignore = "exhaustive"]
fn a_wrong_distance_is_told_once() {
    let folder = folder();
    for distance in ["2.1", "2.6", "3.4"] {
        let replaced = [("d 2.75", &*format!("d {distance}"))];
        let said = said(&folder, &replaced, &as_it_is);
        let expected = format!("at the wrong distance: as if d were {distance} instead of 2.75");
        assert!(said.contains(&expected), "{said}");
    }
}
