//! Tests of exact pictures of a checkerboard in ordinary views: fields of view from 1° to 170°, and
//! squares from 1e-4 to 1e6 times the eye's height above the board. In such views, the error bound
//! of a pixel is at most 1e-9.

use std::fmt::Write;

use super::{super::assert_agrees_with_samples, *};
use crate::scenes::whole;

/// Returns the text of a random view of a checkerboard and up to three objects.
fn view(random: &mut Random) -> String {
    let which = random.bits() as usize;
    let mut number = |low: f64, high: f64| random.within(low, high);
    let fov = [number(1.0, 20.0), number(20.0, 150.0), number(150.0, 170.0)][which % 3];
    let height = libm::exp10(number(-2.0, 2.0));
    let square = height
        * [
            libm::exp10(number(-4.0, 6.0)),
            libm::exp10(number(-1.5, 1.0)),
        ][which / 4 % 2];
    let off = [0.0, number(-9.0, 9.0), number(-3e8, 3e8)][which / 8 % 3];
    let direction = [
        [1.0, 0.0, -1.0],
        [number(-1.0, 1.0), number(-1.0, 0.4), number(-1.0, 1.0)],
        [1.0, number(-1.0, 0.2), 3.0],
    ][which / 32 % 3];
    let roll = [0.0, 45.0, number(-180.0, 180.0)][which / 128 % 3];
    let [x, y, z] = direction;
    let mut text = format!(
        "image {{ width 24 height 16 background blue }}
         camera {{ eye ({off}, {height}, {off}) direction ({x}, {y}, {z}) roll {roll}deg fov {fov}deg }}
         checkerboard {{ y 0 square {square:e} colors (white, black) }}\n"
    );
    for shape in ["sphere", "box", "box"].iter().take(which / 512 % 4) {
        let distance = height * libm::exp10(number(0.0, 1.0)) / libm::sqrt(x * x + y * y + z * z);
        let mut near = |place: f64| place + 0.4 * distance * number(-1.0, 1.0);
        let [cx, cy, cz] = [
            off + x * distance,
            height + y * distance,
            off + z * distance,
        ]
        .map(&mut near);
        let size = 0.4 * distance * number(0.1, 1.0);
        let size = match *shape {
            "sphere" => format!("radius {size} color red"),
            _ => format!("size ({size}, {size}, {size}) color lime"),
        };
        let _ = writeln!(text, "{shape} {{ center ({cx}, {cy}, {cz}) {size} }}");
    }
    text
}

sampled_and_exhaustive!(ordinary_views_are_known_within_1e_9);

/// Compares exact pictures of random views with samples. In the first 30 views, also compares each
/// pixel with the mean of its four quarters. An exhaustive run compares 384 000 pixels. Prints how
/// many error bounds exceed 1e-11.
fn ordinary_views_are_known_within_1e_9(effort: Effort) {
    let mut random = Random::new(31);
    let (mut pixels, mut above) = (0, 0);
    for index in effort.first(40, 0..1000) {
        let text = view(&mut random);
        let scene = read(&text);
        let computed = match index {
            0..30 => assert_part_adds_up(&scene, whole(&scene)),
            _ => exact(&scene),
        };
        let (bound, bounds) = (computed.bound(), computed.bounds.iter());
        assert!(bound <= 1e-9, "{bound:e} of {text}");
        pixels += bounds.len();
        above += bounds.filter(|bound| **bound > 1e-11).count();
        assert_agrees_with_samples(&scene, &computed, 64);
    }
    let share = 100.0 * above as f64 / pixels as f64;
    println!("{above} of {pixels} bounds, {share:.2} %, are above 1e-11");
}
