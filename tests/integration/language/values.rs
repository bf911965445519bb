//! What values mean.

use glam::DVec3;
use pinhole::{
    color::Color,
    scene::{Count, Lens, Method},
};

use super::{CAMERA, codes, number, object, sphere};
use crate::{
    scenes::read,
    table::{list, rows},
};

#[test]
fn defaults() {
    let scene = read(CAMERA);
    assert_eq!((scene.image.width, scene.image.height), (800, 450));
    assert_eq!(scene.image.background, Color::BLACK);
    assert_eq!(scene.sampler.method, Method::MultiJittered);
    assert_eq!(scene.sampler.count, Count::PerPixel(16));
    assert_eq!(scene.camera.lens, Lens::Distance(2.0));
    assert_eq!(scene.camera.up, DVec3::Y);
    assert_eq!((scene.camera.near, scene.camera.far), (0.0, None));
    for [short, long] in rows("
        sphere { center (0, 1, 0) } -> sphere { center (0, 1, 0) radius 1 color #808000 }
        checkerboard {} -> checkerboard { y 0 square 1 colors (#808080, #fff) }
        box { center (0, 0, 0) } -> box { min (-0.25, -0.75, -1) max (0.25, 0.75, 1) color #ffa500 }
        triangle { centroid (0, 0, 0) normal (0, 0, 3) } -> triangle { centroid (0, 0, 0) normal (0, 0, 3) sides (2, 2, 1) spin 0deg color teal }
    ") {
        assert_eq!(object(short).shape, object(long).shape);
    }
}

#[test]
fn numbers() {
    let texts = "
        2 = 2; .5 = 0.5; 5. = 5; 1e-3 = 0.001; 1E+2 = 100; 1_000_000 = 1000000; 1_0.0_1e1_0 = 10.01e10
        5e-324 = 5e-324; 1.7976931348623157e308 = 1.7976931348623157e308; pi = 3.141592653589793
        2 + 3 * 4 = 14; (2 + 3) * 4 = 20; 2 - 3 - 4 = -5; 24 / 4 / 2 = 3; 1/3 = 0.3333333333333333
        -2 * -3 = 6; --2 = 2; 2 - -2 = 4; -(1 + 2) = -3; 1 -1 = 0
        90deg / 30deg = 3; 1rad / 1rad = 1; 30 * deg / deg = 30
        min(3, 1, 2) + max(1, 2) = 3; abs(-2) = 2; sqrt(2) * sqrt(2) - 2 = 4.440892098500626e-16
        length((3, 4, 0)) = 5; dot((1, 2, 3), (4, 5, 6)) = 32
        length(cross((1, 0, 0), (0, 1, 0)) - (0, 0, 1)) = 0; length(normalize((0, 0, 9)) - (0, 0, 1)) = 0
        sin(30deg) = 0.5; cos(90deg) = 0; sin(360000000000180deg) = 0; tan(45deg) = 1; sin(asin(0.5)) = 0.5
        atan2(0, 1) / 1rad = 0; (atan2(sin(180deg), -1) / 1deg) = 180";
    for line in list(texts) {
        for text in line.split("; ") {
            let (text, value) = text.split_once(" = ").unwrap();
            let value: f64 = value.parse().unwrap();
            assert_eq!(number(text), value, "{text}");
        }
    }
    assert_wrong("
        sphere { center (_, 0, 0) } -> bad_number -> 1__0; 1_; 1_.5; 1._5; 1e_5; 1.2.3; 0x1; 2e
        sphere { center (_, 0, 0) } -> number_too_large -> 1e400
        sphere { center (_, 0, 0) } -> not_finite -> 1/0; 0/0; sqrt(-1); asin(2); tan(90deg); tan(-270deg); 1e200 * 1e200
        sphere { center (_, 0, 0) } -> not_finite -> length(normalize((0, 0, 0))); 1deg / 0deg
        sphere { center (_, 0, 0) } -> operand_types -> 1 + red; 1 + 1deg; 1deg * 1deg; 1 / 1deg; -red
        sphere { center (_, 0, 0) } -> part_type -> 30deg; (1, 2, 3); red
        sphere { center (_, 0, 0) } -> argument_count -> min(1)
        sphere { center (_, 0, 0) } -> bare_angle -> sin(1)
        sphere { center (_, 0, 0) } -> function_without_arguments -> sin
        sphere { center (_, 0, 0) } -> unknown_name -> nothing; _1
        sphere { center (_, 0, 0) } -> unknown_function -> foo(1)
    ");
}

/// Rows of a text, the code of what is wrong, and what may stand for `_` in the text.
fn assert_wrong(table: &'static str) {
    for [text, code, values] in rows(table) {
        for value in values.split("; ") {
            let text = format!("{CAMERA}{}", text.replacen('_', value, 1));
            assert_eq!(codes(&text), code, "{text}");
        }
    }
}

#[test]
fn colours() {
    let color = |text: &str| sphere(&format!("center (0, 0, 0) color {text}")).color;
    let orange = Color::from_bytes([255, 165, 0]);
    for text in "orange; ORANGE; #ffa500; #FFA500; rgb(255, 165, 0); (orange)".split("; ") {
        assert_eq!(color(text), orange, "{text}");
    }
    assert_eq!(color("#fa0"), Color::from_bytes([255, 170, 0]));
    assert_eq!(color("rgb(0.5, 1/3, 0)").srgb, [0.5, 1.0 / 3.0, 0.0]);
    assert_eq!(color("grey"), color("gray"));
    assert_wrong(
        "
        sphere { center (0, 0, 0) color _ } -> unknown_color -> transparent; olivey
        sphere { center (0, 0, 0) color _ } -> bad_color_code -> #ff; #ffff
        sphere { center (0, 0, 0) color _ } -> color_range -> rgb(256, 0, 0); rgb(0, -1, 0)
        sphere { center (0, 0, 0) color _ } -> wrong_type -> (1, 2, 3)
        sphere { center (0, 0, 0) color _ } -> argument_count -> rgb(1, 2)
    ",
    );
}
