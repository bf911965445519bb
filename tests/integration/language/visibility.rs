//! Tests of the warnings about cameras that see nothing, and about squares too small to be visible.
//! A warning must never be false. Most pictures to which a warning applies must cause it.

use std::collections::BTreeSet;

use pinhole::{color::Color, scene};

use super::codes;
use crate::{
    generated::{Numbers, generated},
    scenes::{exact, read, sampled, sources},
};

/// Each tested scene contains only the first object of a generated scene, so that many of the
/// pictures are black.
#[test]
fn nothing_seen_is_never_false_and_found_for_half_the_black_pictures() {
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
    // Some black pictures get no warning, for two reasons. The bounds from which the warning is
    // derived are larger than the objects, and the visible part of an object may be smaller than
    // the error bound of a pixel.
    assert!(black > 75 && warned * 2 > black, "{warned} of {black}");
}

/// The boards have smaller and smaller squares. They are seen from several points and rendered by
/// several methods.
#[test]
fn squares_too_small_is_never_false_and_found_for_most_plain_boards() {
    let (mut warned, mut one_colored) = (0, 0);
    for (eye, view, nearness) in [
        ("(0.3, 1, 2)", "lookat (0.1, 0, -3)", 1.0),
        ("(0, 2, 8)", "direction (0, 0, -1)", 1.0),
        ("(0.1, 9, 0.2)", "direction (0, -1, 0)  up (1, 0, -3)", 1.0),
        ("(0.1, 5, 0.2)", "direction (0, -1, 0)", 1.0),
        ("(0.1, -5, 0.2)", "direction (0, 1, 0)  roll 30deg", 1.0),
        ("(-5e9, 1e-6, 7)", "direction (3, -1, -2)  roll 40deg", 1e-6),
        ("(1, -1e100, 1)", "direction (3, 1, -2)  fov 170deg", 1e100),
    ] {
        for exponent in [-20, -60, -90, -94, -97, -99, -100, -101, -103, -110, -150] {
            for method in ["jittered", "regular", "scatter"] {
                let square = libm::pow(10.0, f64::from(exponent)) * nearness;
                let text = format!(
                    "image {{ width 24  height 16  background red }} camera {{ eye {eye}  {view} }}
                     sampler {{ method {method} per_pixel 4 }} checkerboard {{ square {square:e}  colors (black, white) }}"
                );
                let film = sampled(&read(&text));
                let pixels = (0..16).flat_map(|y| film.row(y)).copied();
                // Pixels that show a part of the red background have more red than green, and are
                // left out. In the others, green is the fraction of the board's second colour,
                // white.
                let seen = pixels.filter(|[red, green, _]| red - green < 0.01);
                let greens: Vec<f64> = seen.map(|[_, green, _]| green).collect();
                let first = greens.iter().filter(|&&green| green < 0.5).count();
                let others = first.min(greens.len() - first);
                let shades: BTreeSet<u64> = greens.iter().map(|green| green.to_bits()).collect();
                let is_warned = codes(&text).contains("squares_too_small");
                assert!(!is_warned || others * 50 <= greens.len(), "{text}");
                assert!(greens.len() > 50, "{text}");
                warned += usize::from(is_warned);
                one_colored += usize::from(shades.len() == 1);
            }
            let exact =
                format!("sampler {{ method exact }} checkerboard {{ square 1e{exponent} }}");
            let view = format!("image {{ width 4 height 3 }} camera {{ eye {eye}  {view} }}");
            let codes = codes(&format!("{view} {exact}"));
            assert!(!codes.contains("squares_too_small"), "{view} {exact}");
        }
    }
    assert!(
        warned > 50 && warned * 10 > one_colored * 9,
        "{warned} of {one_colored}"
    );
}
