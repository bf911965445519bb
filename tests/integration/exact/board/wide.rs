//! The board in views of nearly 180 degrees.

use glam::{DVec2, dvec3};
use pinhole::{
    area::Area,
    inspect::{CameraFacts, inspect_camera},
};

use super::super::{exact, part, part_adds_up, read};
use super::bound_at;
use crate::effort::{Effort, sampled_and_exhaustive};
use crate::tracer::Random;

/// A board seen aslant in views of nearly 180 degrees: any pixel sees a strip of it that is narrower than a square.
#[test]
fn the_widest_views_of_a_board() {
    for lens in [
        "fov 179.99999deg",
        "fov 179.9999999deg",
        "fov 179.99999999999997deg",
        "d 1e-100",
        "d 5e-324",
    ] {
        for (direction, roll) in [
            ("(1, 0, -1)", 0.0),
            ("(1, 0, -2)", 0.0),
            ("(3, -1, -1)", 20.0),
            ("(1, 1e-9, -1)", 45.0),
        ] {
            let scene = read(&format!(
                "image {{ width 3 height 3 }}
                 camera {{ eye (0.3, 1.7, 8) direction {direction} roll {roll}deg {lens} }}
                 sampler {{ method exact }}
                 checkerboard {{ y 0 square 1 }}"
            ));
            let bound = exact(&scene).bound();
            assert!(bound <= 1e-8, "{lens} {direction} {roll}: {bound:e}");
        }
    }
}

/// In very wide views a pixel may see thousands of squares one behind another, and no horizon.
#[test]
fn up_to_a_hundred_thousand_squares_in_wide_views() {
    for (camera, square, x, y) in [
        (
            "eye (0, 157.4019629802236, 0) direction (-0.24392, 0, 0.14156) d 5.394e-6 far 11.7184",
            73.5,
            [0, 6],
            [2, 3],
        ),
        (
            "eye (-3.761, 73.0078700358, -1.4975) direction (-0.76386, -0.028555, 0.09058) roll 90deg d 1.1174e-4",
            642.0,
            [3, 4],
            [0, 4],
        ),
        (
            "eye (3.4158975, 0.0422285609, -1.3490885) direction (1, 0, -1) d 3.1924e-4",
            2.8656e-5,
            [0, 6],
            [3, 4],
        ),
        (
            "eye (0, 0.107641568, -4.564254) direction (0.079364, -1, 0.066323) d 2e-3",
            0.04485549,
            [0, 1],
            [2, 3],
        ),
    ] {
        let scene = read(&format!(
            "image {{ width 6 height 4 }}
             camera {{ {camera} }}
             sampler {{ method exact }}
             checkerboard {{ y 0 square {square} }}"
        ));
        let area = Area {
            x: x[0],
            y: y[0],
            width: x[1] - x[0],
            height: y[1] - y[0],
        };
        let bound = part(&scene, area).bound();
        assert!(bound <= 1e-12, "{camera}: {bound:e}");
    }
}

/// At the horizon, thousands of columns off the middle of a wide view, what a pixel sees of the floor is a ray of it, but for one part in
/// many millions.
#[test]
#[ignore = "exhaustive"]
fn columns_far_off_in_wide_views() {
    for (direction, roll, d, square, [width, height], [x, y]) in [
        (
            "(1, -0.4, 0.7)",
            0.0,
            "1e-5",
            0.001,
            [12000, 2000],
            [11996, 999],
        ),
        (
            "(1, -0.4, 0.7)",
            0.0,
            "1e-8",
            0.001,
            [12000, 2000],
            [11996, 999],
        ),
        (
            "(0.04, 0, -0.86)",
            45.0,
            "1.8e-10",
            0.02,
            [6000, 4000],
            [4825, 172],
        ),
        ("(1, 0.3, 2)", 0.0, "2.6e-20", 0.017, [3000, 2000], [2, 999]),
        (
            "(0.64, -0.1, -0.8)",
            20.762,
            "9e-14",
            0.13,
            [6000, 2000],
            [5628, 2],
        ),
        (
            "(1, -8e-5, 2)",
            -39.632,
            "1e-10",
            0.0013,
            [3000, 4000],
            [346, 1044],
        ),
    ] {
        let scene = read(&format!(
            "image {{ width {width} height {height} }}
             camera {{ eye (0.3, 0.8, 0.2) direction {direction} roll {roll}deg d {d} }}
             sampler {{ method exact }}
             checkerboard {{ y 0 square {square} }}"
        ));
        let area = Area {
            x,
            y,
            width: 3,
            height: 3,
        };
        let bound = part_adds_up(&scene, area, direction).bound();
        assert!(bound <= 1e-6, "{direction} {d}: {bound:e}");
    }
}

/// Blocks of rows before a far plane, of which no line is in step with the next one: of a million modes and more hardly any matter.
#[test]
#[ignore = "exhaustive"]
fn wide_views_of_rows_out_of_step() {
    for (eye, direction, rest, square) in [
        (
            "(3.67781, 0.4274597778298454, 4.73775)",
            "(-0.69039717130416323, -1.4522932231249908, 0.72343053975845528)",
            "roll 114.989deg d 7.4402685803163599e-10 far 67.84454308348414",
            "0.00046218548648654239",
        ),
        (
            "(3.62649, 2.3878766417696382, -3.4582)",
            "(0.45471697234418118, 0.29139485980872415, 0.8906359947038639)",
            "roll -75.3042deg d 3.1554404151444887e-12 far 67739.063243978497",
            "0.0045885699584194573",
        ),
    ] {
        let scene = read(&format!(
            "image {{ width 6 height 4 }}
             camera {{ eye {eye} direction {direction} {rest} }}
             sampler {{ method exact }}
             checkerboard {{ square {square} }}"
        ));
        let bound = exact(&scene).bound();
        assert!(bound <= 1e-9, "{eye}: {bound:e}");
    }
}

sampled_and_exhaustive!(wide_views_along_diagonals);

/// Along the diagonals of a board, and where it goes on by such fractions as 3/5, no line is displaced much against the one before, or every fifth
/// not: all modes are in step, and what lies between kinks is summed at once.
fn wide_views_along_diagonals(effort: Effort) {
    for (eye, direction, rest, square) in effort.of([
        (
            "(4.87134, 18.40485726953807, 4.46713)",
            "(1, 0.71976775250559488, 1)",
            "d 1.3171781702432199e-11 far 797.58757025253317",
            "0.031639511055832632",
        ),
        (
            "(1.6949, 0.12267287093656334, -0.461423)",
            "(1, -1.1116745184314281, 1)",
            "d 1.0796698885081493e-12 far 1.8189856477370419",
            "0.0052924187593660597",
        ),
        (
            "(0.225893, 0.26353742865178387, 4.97195)",
            "(5, 0.66067817927256389, 7)",
            "d 2.2123853269590468e-13 far 6254.97292550573",
            "0.00066089163104929554",
        ),
        (
            "(-2.49873, 15.649840368095996, 2.82093)",
            "(0.70710678118654746, 0.17355538029455023, 0.70710678118654757)",
            "roll 42.7528deg d 4.6458604893516569e-19 far 7839315.5516397618",
            "0.029677007846249021",
        ),
    ]) {
        let scene = read(&format!(
            "image {{ width 4 height 2 }}
             camera {{ eye {eye} direction {direction} {rest} }}
             sampler {{ method exact }}
             checkerboard {{ square {square} }}"
        ));
        let whole = Area::whole(4, 2);
        let bound = part_adds_up(&scene, whole, eye).bound();
        assert!(bound <= 1e-9, "{eye}: {bound:e}");
    }
}

/// The horizon anywhere in views of any width beyond 179 degrees.
#[test]
#[ignore = "exhaustive"]
fn wide_views_at_random() {
    let mut random = Random(23);
    for i in 0..24 {
        let mut number = |low: f64, high: f64| random.within(low, high);
        let (width, height) = [(3000, 2000), (2000, 3000), (12_000, 2000)][i % 3];
        let d = match i {
            0 => 5e-324,
            1 => 1e-100,
            _ => libm::exp10(number(-22.0, -3.0)),
        };
        let square = libm::exp10(number(-3.0, 1.0));
        let pitch = [0.0, number(-1e-4, 1e-4), number(-1.0, 1.0)][i / 3 % 3];
        let direction = dvec3(number(-1.0, 1.0), pitch, number(-1.0, 1.0));
        let roll = [0.0, number(-90.0, 90.0)][i / 9 % 2];
        let scene = read(&format!(
            "image {{ width {width} height {height} }}
             camera {{ eye (0.3, 0.8, 0.2) direction ({}, {}, {}) roll {roll}deg d {d:e} }}
             sampler {{ method exact }}
             checkerboard {{ y 0 square {square} }}",
            direction.x, direction.y, direction.z
        ));
        // The horizon is where the ray x·u + y·v, to which hardly anything of w is added, is level.
        let (CameraFacts { u, v, .. }, _) = inspect_camera(&scene.camera, &scene.image);
        let (right, top) = (0.5 * f64::from(width), 0.5 * f64::from(height));
        let far_off = number(-1.0, 1.0);
        let place = match (u.y * right).abs() < (v.y * top).abs() {
            true => DVec2::new(far_off * right, -far_off * right * u.y / v.y),
            false => DVec2::new(-far_off * top * v.y / u.y, far_off * top),
        };
        let column = (right + place.x).clamp(2.0, 2.0 * right - 2.0) as u32;
        let row = (top - place.y).clamp(2.0, 2.0 * top - 2.0) as u32;
        let area = Area {
            x: column - 1,
            y: row - 1,
            width: 3,
            height: 3,
        };
        let name = format!("{direction} {roll} {d:e} {square}");
        let bound = part_adds_up(&scene, area, &name).bound();
        assert!(bound <= 1e-6, "{name}: {bound:e}");
    }
}

/// A row of many squares that runs into a point in which all lines of the board meet, but for what roundings do.
#[test]
#[ignore = "exhaustive"]
fn a_corner_where_all_lines_meet() {
    let scene = read(
        "image { width 40 height 8 }
         camera { eye (0.3, 0.8, 0.2) direction (0.87, 0.64, 0.34) d 1e-20 }
         sampler { method exact }
         checkerboard { y 0 square 5e-8 }",
    );
    let area = Area {
        x: 20,
        y: 4,
        width: 1,
        height: 1,
    };
    let bound = part_adds_up(&scene, area, "the middle").bound();
    assert!(bound <= 1e-6, "{bound:e}");
}

/// Where a sphere's outline meets the horizon in the widest views.
#[test]
fn outlines_at_a_wide_horizon() {
    for (camera, square, sphere) in [
        (
            "eye (137257.85, 0.0847, 0.2587) direction (-1, 1e-6, -1) roll 1deg fov 179.98935deg",
            687411.158,
            "center (137257.906, 0.0115, 0.288) radius 0.0909",
        ),
        (
            "eye (-2737810.5, 0.5214, 9.76) direction (1, 1.7e-5, -1) fov 179.99996deg",
            359.93,
            "center (-2737810.49, 0.6, 9.85) radius 0.0303",
        ),
    ] {
        let scene = read(&format!(
            "image {{ width 6 height 6 }}
             camera {{ {camera} }}
             sampler {{ method exact }}
             checkerboard {{ y 0 square {square} }}
             sphere {{ {sphere} color red }}"
        ));
        let bound = exact(&scene).bound();
        assert!(bound <= 1e-9, "{camera}: {bound:e}");
    }
}

/// A view so wide that the lines of the board in a pixel are too close for their corners to be told apart.
#[test]
fn lines_too_close_to_cut() {
    for camera in [
        "eye (4.74, 15.74, -4.32) direction (1, -0.3, 1) roll 96.3deg d 1 view_height 1202818974.9410524",
        "eye (0.3, 1.7, 8) direction (3, -1, -1) roll 20deg fov 179.9999999deg",
    ] {
        let scene = read(&format!(
            "image {{ width 3 height 2 }}
             camera {{ {camera} }}
             sampler {{ method exact }}
             checkerboard {{ square 6.3 }}"
        ));
        let bound = exact(&scene).bound();
        assert!(bound <= 1e-6, "{camera}: {bound:e}");
    }
}

/// The eye close above the board in as wide a view as can be: of a pixel with the middle of the picture at a corner, some quarters are known
/// exactly, and of others no quarters are known better.
#[test]
#[ignore = "exhaustive"]
fn a_pixel_next_to_the_middle_of_the_widest_views() {
    for (fov, square) in [("179.99999999", "2.9e-06"), ("179.9999999", "1e-7")] {
        let text = format!(
            "image {{ width 6 height 5 }}
             camera {{ eye (0, 0.0288, 5) direction (-0.985, -0.328, -1) roll 118.4deg fov {fov}deg }}
             sampler {{ method exact }}
             checkerboard {{ square {square} }}"
        );
        let bound = bound_at(&text, [1, 0]);
        assert!(bound <= 1e-7, "{fov}, {square}: {bound:e}");
    }
    let text = "image { width 6 height 4 }
        camera { eye (0.3, 2, 1) direction (0.2, -0.3, -1) roll 5deg d 1e-8 }
        sampler { method exact }
        checkerboard { square 1e-7 }";
    assert!(exact(&read(text)).bound() <= 1e-7);
}

/// Squares without number in views so wide that forms must be known better than they are rounded: each as well as it is large.
#[test]
fn squares_without_number_in_wide_views() {
    for lens in ["fov 179.5deg", "d 1e-3", "d 1e-5"] {
        for square in ["1e-89", "1e-100", "1e-200", "1e-300"] {
            let scene = read(&format!(
                "image {{ width 16 height 12 }}
                 camera {{ eye (0.3, 2, 0.1) direction (3, -0.5, -1) {lens} }}
                 sampler {{ method exact }}
                 checkerboard {{ square {square} }}"
            ));
            let bound = exact(&scene).bound();
            assert!(bound <= 1e-8, "{lens} {square}: {bound:e}");
        }
    }
}

/// A plane so close in front of the view plane that a row of the board has about one square of it, and the board a billion rows.
#[test]
fn rows_of_a_square_each_in_wide_views() {
    let text = |square: &str| {
        format!(
            "image {{ width 6 height 4 }}
             camera {{ eye (1, 2, 3) direction (-0.3, 0, 1) d 2e-9 far 4e6 }}
             sampler {{ method exact }}
             checkerboard {{ square {square} }}"
        )
    };
    for (square, pixel) in [("1e-1", [0, 2]), ("1e-3", [5, 2]), ("1e-5", [4, 3])] {
        let bound = bound_at(&text(square), pixel);
        assert!(bound <= 1e-9, "{square}: {bound:e}");
    }
}
