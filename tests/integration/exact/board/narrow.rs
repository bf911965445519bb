//! The board in views of less than a millionth of a degree.

use super::*;

/// A corner of squares close up, an odd number of squares from the eye: the share is as good as in any view.
#[test]
fn a_corner_through_the_longest_lens() {
    for height in ["1", "1e-3", "1e-6", "1e-9", "1e-14"] {
        is_known(&format!(
            "image {{ width 1 height 1 }}
             camera {{ eye (-1, 1, -4) direction (-1, -1, 1) d 1 view_height {height} }}
             checkerboard {{ colors (white, black) }}"
        ));
    }
}

/// Through lenses so long that a pixel next to the horizon begins millions of millions of squares away, where a rounding of a place is as much as
/// the pixel is wide: alone, before a far plane, and next to an outline. The bound is honest there.
#[test]
fn the_horizon_through_the_longest_lenses() {
    for [camera, square, object] in rows("
        eye (-3.8129918102387705, 0.29933186775843634, 5.521568092661159) direction (0.29550764467648694, 2.7116391188331324e-13, -0.9553403749123949) roll -0.6189217287574991deg d 3.227743535403821e12 -> 1 ->
        eye (7.1258770808249885, 12113.985539197016, 5.887328052989606) direction (0.7595975955607975, 4.869620325463549e-13, 0.6503933370032746) d 7.253439800872538e11 -> 1 ->
        eye (7.1258770808249885, 12113.985539197016, 5.887328052989606) direction (0.7595975955607975, 4.869620325463549e-13, 0.6503933370032746) d 7.253439800872538e11 far 9e16 -> 1 ->
        eye (-2.3318247885590555, 4.993210617544962, -3.0751067711600903) direction (-0.6618112240074384, -3.894257679306732e-11, 0.7496705301515968) d 1.7887427203438065e10 -> 67.48587078763939 ->
        eye (2.052067170281884, 0.06772658040854719, 0.6815823813346729) direction (0.7965839558772344, 3.0892811389595033e-16, -0.6045279160129632) d 7.772098242578281e12 -> 1 -> sphere { center (3.0521083313962305, 0.06772658040854758, -0.06483719297703988) radius 0.009966941806214522 color red }
    ") {
        let scene = read(&format!(
            "image {{ width 6 height 4 }}
             camera {{ {camera} }}
             checkerboard {{ y 0 square {square} }}
             {object}"
        ));
        part_adds_up(&scene, "1,1,1,3".parse().unwrap());
    }
}

/// The same anywhere below the horizon of views narrower than a millionth of a degree.
#[test]
#[ignore = "exhaustive"]
fn narrow_views_at_random() {
    let mut random = Random::new(29);
    for i in 0..24 {
        let mut number = |low: f64, high: f64| random.within(low, high);
        let d = libm::exp10(number(8.0, 15.0));
        let height = libm::exp10(number(-1.0, 4.0));
        let square = [1.0, height * libm::exp10(number(-2.0, 2.0))][i % 2];
        let [pitch, turn] = [number(-0.5, 0.5) / d, number(0.0, 6.3)];
        let roll = [0.0, number(-180.0, 180.0)][i / 2 % 2];
        let far = height * d * number(0.5, 5.0);
        let far = match i % 3 {
            0 => format!("far {far:e}"),
            _ => String::new(),
        };
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        let text = format!(
            "image {{ width 6 height 4 }}
             camera {{ eye (0.3, {height}, 0.2) direction ({cos}, {pitch:e}, {sin}) roll {roll}deg d {d:e} {far} }}
             checkerboard {{ y 0 square {square} }}"
        );
        part_adds_up(&read(&text), "2,1,1,2".parse().unwrap());
    }
}
