//! What values mean.

use glam::DVec3;
use pinhole::{
    color::Color,
    scene::{Count, Lens, Method, Outline, Shape, Sphere, Triangle},
};

use super::{assert_codes, number, object, sphere};
use crate::{scenes::read, table::rows};

#[test]
fn defaults() {
    let scene = read(super::CAMERA);
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
    let olive = Color::from_bytes([128, 128, 0]);
    let is = Sphere {
        center: DVec3::Y,
        radius: 1.0,
        color: olive,
    };
    assert_eq!(sphere("center (0, 1, 0)"), is);
    let triangle = object("triangle { centroid (0, 0, 0) normal (0, 0, 3) }");
    let Shape::Triangle(Triangle {
        outline: Outline::Centered(outline),
        ..
    }) = triangle.shape
    else {
        panic!("{triangle:?}");
    };
    let is = (outline.sides, outline.normal);
    assert_eq!(is, (DVec3::new(2.0, 2.0, 1.0), DVec3::Z * 3.0));
}

#[test]
fn numbers() {
    let table = "
        2 -> 2
        .5 -> 0.5
        5. -> 5
        1e-3 -> 0.001
        1E+2 -> 100
        1_000_000 -> 1000000
        1_0.0_1e1_0 -> 10.01e10
        5e-324 -> 5e-324
        1.7976931348623157e308 -> 1.7976931348623157e308
        2 + 3 * 4 -> 14
        (2 + 3) * 4 -> 20
        2 - 3 - 4 -> -5
        24 / 4 / 2 -> 3
        -2 * -3 -> 6
        --2 -> 2
        2 - -2 -> 4
        -(1 + 2) -> -3
        1 -1 -> 0
        90deg / 30deg -> 3
        1rad / 1rad -> 1
        30 * deg / deg -> 30
        min(3, 1, 2) + max(1, 2) -> 3
        abs(-2) -> 2
        sqrt(2) * sqrt(2) - 2 -> 4.440892098500626e-16
        length((3, 4, 0)) -> 5
        dot((1, 2, 3), (4, 5, 6)) -> 32
        length(cross((1, 0, 0), (0, 1, 0)) - (0, 0, 1)) -> 0
        length(normalize((0, 0, 9)) - (0, 0, 1)) -> 0
        sin(30deg) -> 0.5
        cos(90deg) -> 0
        sin(360000000000180deg) -> 0
        tan(45deg) -> 1
        sin(asin(0.5)) -> 0.5
        pi -> 3.141592653589793
        atan2(0, 1) / 1rad -> 0
        (atan2(sin(180deg), -1) / 1deg) -> 180
        1/3 -> 0.3333333333333333
    ";
    for [text, value] in rows(table) {
        let value: f64 = value.parse().unwrap();
        assert_eq!(number(text), value, "{text}");
    }
    assert_codes(
        "
        sphere { center (1__0, 0, 0) } -> bad_number
        sphere { center (_1, 0, 0) } -> unknown_name
        sphere { center (1_, 0, 0) } -> bad_number
        sphere { center (1_.5, 0, 0) } -> bad_number
        sphere { center (1._5, 0, 0) } -> bad_number
        sphere { center (1e_5, 0, 0) } -> bad_number
        sphere { center (1.2.3, 0, 0) } -> bad_number
        sphere { center (0x1, 0, 0) } -> bad_number
        sphere { center (2e, 0, 0) } -> bad_number
        sphere { center (1e400, 0, 0) } -> number_too_large
        sphere { center (1/0, 0, 0) } -> not_finite
        sphere { center (0/0, 0, 0) } -> not_finite
        sphere { center (sqrt(-1), 0, 0) } -> not_finite
        sphere { center (asin(2), 0, 0) } -> not_finite
        sphere { center (tan(90deg), 0, 0) } -> not_finite
        sphere { center (tan(-270deg), 0, 0) } -> not_finite
        sphere { center (1e200 * 1e200, 0, 0) } -> not_finite
        sphere { center (1 + red, 0, 0) } -> operand_types
        sphere { center (1 + 1deg, 0, 0) } -> operand_types
        sphere { center (1deg * 1deg, 0, 0) } -> operand_types
        sphere { center (1 / 1deg, 0, 0) } -> operand_types
        sphere { center (30deg, 0, 0) } -> part_type
        sphere { center ((1, 2, 3), 0, 0) } -> part_type
        sphere { center (red, 0, 0) } -> part_type
        sphere { center (-red, 0, 0) } -> operand_types
        sphere { center (length(normalize((0, 0, 0))), 0, 0) } -> not_finite
        sphere { center (min(1), 0, 0) } -> argument_count
        sphere { center (sin(1), 0, 0) } -> bare_angle
        sphere { center (sin, 0, 0) } -> function_without_arguments
        sphere { center (nothing, 0, 0) } -> unknown_name
        sphere { center (foo(1), 0, 0) } -> unknown_function
        sphere { center (1deg / 0deg, 0, 0) } -> not_finite
    ",
    );
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
    assert_codes(
        "
        sphere { center (0, 0, 0) color transparent } -> unknown_color
        sphere { center (0, 0, 0) color #ff } -> bad_color_code
        sphere { center (0, 0, 0) color #ffff } -> bad_color_code
        sphere { center (0, 0, 0) color rgb(256, 0, 0) } -> color_range
        sphere { center (0, 0, 0) color rgb(0, -1, 0) } -> color_range
        sphere { center (0, 0, 0) color (1, 2, 3) } -> wrong_type
        sphere { center (0, 0, 0) color rgb(1, 2) } -> argument_count
    ",
    );
}
