//! The board at its horizon, and with squares of any size; in ordinary views, and in views of any width.

mod narrow;
mod ordinary;
mod wide;

use pinhole::{area::Area, scene::Scene};

use super::{exact, part_adds_up, read};

/// Where the horizon passes next to the centres of pixels, level or along their diagonals.
#[test]
fn a_horizon_anywhere_in_a_pixel() {
    for side in [8, 9, 65] {
        for lift in [0.0, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16] {
            for (lift, roll) in [(lift, 0), (-lift, 0), (lift, 45), (-lift, 45)] {
                let scene = read(&format!(
                    "image {{ width {side} height {side} }}
                     camera {{ eye (0.3, 0.3, 8) direction (0.7, {lift}, -8) roll {roll}deg fov 50deg }}
                     sampler {{ method exact }}
                     checkerboard {{ y 0 square 1 }}"
                ));
                let bound = exact(&scene).bound();
                assert!(bound <= 1e-9, "{side} {lift:e} {roll}: {bound:e}");
            }
        }
    }
}

/// Of squares too small to be seen, however small, next to nothing is left but their mean.
#[test]
fn squares_too_small_to_be_seen() {
    for lens in ["fov 40deg", "fov 1deg", "fov 170deg"] {
        for square in ["1e-12", "1e-30"] {
            let scene = read(&format!(
                "image {{ width 6 height 4 }}
                 camera {{ eye (0.3, 1.7, 8) direction (1, -0.1, -2) roll 20deg {lens} }}
                 sampler {{ method exact }}
                 checkerboard {{ y 0 square {square} colors (white, black) }}"
            ));
            let film = exact(&scene);
            assert!(film.bound() <= 1e-9, "{lens} {square}: {:e}", film.bound());
        }
    }
}

/// A board of one colour in its even squares and another one in its odd ones.
fn floor(eye: &str, square: &str, colors: [&str; 2]) -> Scene {
    let [even, odd] = colors;
    read(&format!(
        "image {{ width 16 height 12 }}
         camera {{ eye {eye} direction (3, -0.5, -1) fov 40deg }}
         sampler {{ method exact }}
         checkerboard {{ square {square} colors ({even}, {odd}) }}"
    ))
}

/// An eye so close to the floor that it sees nothing else of it than the square that it is above.
#[test]
fn an_eye_close_above_a_square() {
    for height in ["1e-16", "1e-20", "1e-28", "1e-100", "1e-300"] {
        let eye = format!("(0.3, {height}, 0.1)");
        let seen = exact(&floor(&eye, "1", ["white", "black"]));
        let wanted = exact(&floor(&eye, "1", ["white", "white"]));
        let bound = seen.bound() + wanted.bound();
        for (seen, wanted) in seen.film.pixels().iter().zip(wanted.film.pixels()) {
            assert!((seen[0] - wanted[0]).abs() <= bound, "{height}");
        }
    }
}

/// Squares so small that only their mean is seen.
#[test]
fn squares_without_number() {
    for square in ["1e-20", "1e-100", "1e-298", "1e-300", "1e-303"] {
        let eye = "(0.3, 2, 0.1)";
        let seen = exact(&floor(eye, square, ["white", "black"]));
        let wanted = exact(&floor(eye, square, ["white", "white"]));
        for (seen, wanted) in seen.film.pixels().iter().zip(wanted.film.pixels()) {
            assert!((seen[0] - 0.5 * wanted[0]).abs() <= 1e-9, "{square}");
        }
    }
}

/// A part of a picture by its column, row, width and height.
fn area_of([x, y, width, height]: [u32; 4]) -> Area {
    Area {
        x,
        y,
        width,
        height,
    }
}

/// The bound of one pixel, which is its quarters.
fn bound_at(text: &str, [x, y]: [u32; 2]) -> f64 {
    let area = Area {
        x,
        y,
        width: 1,
        height: 1,
    };
    part_adds_up(&read(text), area, text).bound()
}

/// Pixels in which dozens, hundreds and tens of thousands of squares are seen grazing.
#[test]
fn up_to_a_hundred_thousand_squares() {
    for (width, height, camera, square, pixel) in [
        (
            320,
            180,
            "eye (-0.3488148447570367, 2.5900015558522904, -8.76682891846906)
             direction (-0.027389310392911884, 0.13115354314265615, 0.999624842466513)
             roll -157.29834963014758deg fov 93.9975380211119deg",
            5.39160487872474,
            [318, 9],
        ),
        (
            320,
            180,
            "eye (4.918628264192188, 0.15946355078389055, -3.8589507148609563)
             direction (0.8916570988964138, -0.2596388906275535, 0.45271140695550305)
             roll 138.32002422982464deg fov 21.787283475892654deg",
            4.240487815030449,
            [0, 109],
        ),
        (
            320,
            180,
            "eye (8.732111456074009, 0.4295383923166356, 0.5144079772281369)
             direction (0.48249015414759905, -0.3413573201534203, 0.8759013935087819)
             roll -105.49165426771366deg fov 59.882053203194424deg",
            1.1985721916332637,
            [221, 65],
        ),
        (
            1280,
            720,
            "eye (4.527348078067337, 0.23514827519707254, -5.726406467802494)
             direction (0.1581907951679423, -0.1719185027449236, -0.9874085640322015)
             roll -28.189315897525404deg fov 61.475202194998914deg",
            0.5203814582797203,
            [1253, 571],
        ),
    ] {
        let text = format!(
            "image {{ width {width} height {height} }}
             camera {{ {camera} }}
             sampler {{ method exact }}
             checkerboard {{ y 0 square {square} }}"
        );
        let bound = bound_at(&text, pixel);
        assert!(bound <= 1e-9, "{camera}: {bound:e}");
    }
}

/// Sixty million squares before a far plane, which none of the pixel's sides goes beyond.
#[test]
fn very_many_squares_before_a_far_plane() {
    let bound = bound_at(
        "image { width 320 height 180 }
         camera {
           eye (-9.798578714407686, 20.914091910712283, -4.726230065882557)
           direction (0.5592784481701565, -0.5805387892708961, 0.8289798655048153)
           roll -46.805482127968816deg fov 45.68959051857685deg far 63669.91495392451
         }
         sampler { method exact }
         checkerboard { y 0 square 0.4422006222130169 }",
        [250, 5],
    );
    assert!(bound <= 1e-9, "{bound:e}");
}

/// Squares as large as numbers: four of them are seen, however large they are.
#[test]
fn squares_of_the_greatest_numbers() {
    let seen = |square: &str| {
        exact(&read(&format!(
            "image {{ width 16 height 12 }}
             camera {{ eye (0.3, 2, 5) lookat (0, 1, 0) }}
             checkerboard {{ square {square} }}"
        )))
    };
    let large = seen("1e100");
    for square in ["1e160", "1e300", "1e301", "1e305", "1.7e308"] {
        let larger = seen(square);
        let bound = large.bound() + larger.bound();
        for (one, other) in large.film.pixels().iter().zip(larger.film.pixels()) {
            for channel in 0..3 {
                let off = (one[channel] - other[channel]).abs();
                assert!(off <= bound, "{square}: {one:?} and {other:?}");
            }
        }
    }
}
