//! The warning of cameras that see nothing: it is never false, and comes often enough.

use pinhole::{color::Color, scene};

use super::codes;
use crate::{
    generated::{Numbers, generated},
    scenes::{exact, sources},
};

/// The first objects of generated scenes, by themselves.
#[test]
fn a_warning_is_never_false_and_comes_often_enough() {
    let (mut warned, mut black) = (0, 0);
    for (text, _) in generated(Numbers::Wild(0), [12, 8], 3).take(500) {
        let (settings, objects) = text.split_once('\n').unwrap();
        let Some(object) = objects.lines().next() else {
            continue;
        };
        let text = format!("{settings}\n{}", object.replace("black", "white"));
        let Some(mut scene) = scene::read(&sources(&text)).scene else {
            continue;
        };
        scene.image.background = Color::BLACK;
        let is_warned = codes(&text).contains("nothing_seen");
        let film = exact(&scene).film;
        let is_dark = |pixel: &[f64; 3]| pixel.iter().all(|&part| part <= 1e-9);
        let is_black = (0..8).all(|y| film.row(y).iter().all(is_dark));
        assert!(is_black || !is_warned, "{text}");
        warned += u32::from(is_warned);
        black += u32::from(is_black);
    }
    // Bounds are larger than what they bound, and what is left of the window may be below the pixels' own.
    assert!(black > 75 && warned * 2 > black, "{warned} of {black}");
}
