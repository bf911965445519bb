//! What values mean.

use glam::DVec3;
use pinhole::{
    color::Color,
    scene::{Checkerboard, Count, Cuboid, Lens, Method, Outline, Shape, Sphere, Triangle},
};

use super::{CAMERA, codes, color, number, read};

#[test]
fn defaults() {
    let scene = read(&format!(
        "{CAMERA} sphere {{ center (0, 1, 0) }} checkerboard {{}} \
        box {{ center (0, 0, 0) }} triangle {{ centroid (0, 0, 0) normal (0, 0, 3) }}"
    ));
    assert_eq!((scene.image.width, scene.image.height), (800, 450));
    assert_eq!(scene.image.background, Color::BLACK);
    assert_eq!(scene.sampler.method, Method::MultiJittered);
    assert_eq!(scene.sampler.count, Count::PerPixel(16));
    assert_eq!(scene.camera.lens, Lens::Distance(2.0));
    assert_eq!(scene.camera.up, DVec3::Y);
    assert_eq!((scene.camera.near, scene.camera.far), (0.0, None));
    let [sphere, board, cuboid, triangle] = &scene.objects[..] else {
        panic!("{scene:?}");
    };
    let olive = Color::from_bytes([128, 128, 0]);
    assert_eq!(
        sphere.shape,
        Shape::Sphere(Sphere {
            center: DVec3::Y,
            radius: 1.0,
            color: olive
        })
    );
    let gray = Color::from_bytes([128; 3]);
    let white = Color::from_bytes([255; 3]);
    assert_eq!(
        board.shape,
        Shape::Checkerboard(Checkerboard {
            y: 0.0,
            square: 1.0,
            colors: [gray, white]
        })
    );
    let half = DVec3::new(0.25, 0.75, 1.0);
    let orange = Color::from_bytes([255, 165, 0]);
    assert_eq!(
        cuboid.shape,
        Shape::Box(Cuboid {
            min: -half,
            max: half,
            color: orange
        })
    );
    let Shape::Triangle(Triangle {
        outline: Outline::Centered(triangle),
        ..
    }) = triangle.shape
    else {
        panic!("{triangle:?}");
    };
    let is = (triangle.sides, triangle.normal);
    assert_eq!(is, (DVec3::new(2.0, 2.0, 1.0), DVec3::Z * 3.0));
}

#[test]
fn numbers() {
    for (text, value) in [
        ("2", 2.0),
        (".5", 0.5),
        ("5.", 5.0),
        ("1e-3", 1e-3),
        ("1E+2", 100.0),
        ("1_000_000", 1e6),
        ("1_0.0_1e1_0", 10.01e10),
        ("5e-324", 5e-324),
        ("1.7976931348623157e308", f64::MAX),
        ("0.1", 0.1),
    ] {
        assert_eq!(number(text), value, "{text}");
    }
    for text in "1__0; _1; 1_; 1_.5; 1._5; 1e_5; 1.2.3; 0x1; 2e; 1e400".split("; ") {
        let scene = format!("{CAMERA} sphere {{ center ({text}, 0, 0) }}");
        assert_eq!(codes(&scene).len(), 1, "{text}: {:?}", codes(&scene));
    }
}

#[test]
fn operators() {
    for (text, value) in [
        ("2 + 3 * 4", 14.0),
        ("(2 + 3) * 4", 20.0),
        ("2 - 3 - 4", -5.0),
        ("24 / 4 / 2", 3.0),
        ("-2 * -3", 6.0),
        ("--2", 2.0),
        ("2 - -2", 4.0),
        ("-(1 + 2)", -3.0),
        ("1 -1", 0.0),
        ("90deg / 30deg", 3.0),
        ("1rad / 1rad", 1.0),
        ("30 * deg / deg", 30.0),
        ("min(3, 1, 2) + max(1, 2)", 3.0),
        ("abs(-2)", 2.0),
        ("sqrt(2) * sqrt(2) - 2", 4.440892098500626e-16),
        ("length((3, 4, 0))", 5.0),
        ("dot((1, 2, 3), (4, 5, 6))", 32.0),
        ("length(cross((1, 0, 0), (0, 1, 0)) - (0, 0, 1))", 0.0),
        ("length(normalize((0, 0, 9)) - (0, 0, 1))", 0.0),
        ("sin(30deg)", 0.5),
        ("cos(90deg)", 0.0),
        ("sin(360000000000180deg)", 0.0),
        ("tan(45deg)", 1.0),
        ("sin(asin(0.5))", 0.5),
        ("pi", std::f64::consts::PI),
        ("atan2(0, 1) / 1rad", 0.0),
        ("1/3", 1.0 / 3.0),
    ] {
        assert_eq!(number(text), value, "{text}");
    }
    for text in "1/0; 0/0; sqrt(-1); asin(2); tan(90deg); tan(-270deg); 1e200 * 1e200; 1 + red; 1 + 1deg; 1deg * 1deg; 1 / 1deg; 30deg; (1, 2, 3); red; -red; length(normalize((0, 0, 0))); min(1); sin(1); sin; nothing; foo(1); 1deg / 0deg".split("; ") {
        let scene = format!("{CAMERA} sphere {{ center ({text}, 0, 0) }}");
        assert_eq!(codes(&scene).len(), 1, "{text}: {:?}", codes(&scene));
    }
}

#[test]
fn colours() {
    let orange = Color::from_bytes([255, 165, 0]);
    for text in "orange; ORANGE; #ffa500; #FFA500; rgb(255, 165, 0); (orange)".split("; ") {
        assert_eq!(color(text), orange, "{text}");
    }
    assert_eq!(color("#fa0"), Color::from_bytes([255, 170, 0]));
    assert_eq!(color("rgb(0.5, 1/3, 0)").srgb, [0.5, 1.0 / 3.0, 0.0]);
    assert_eq!(color("grey"), color("gray"));
    for text in
        "transparent; #ff; #ffff; rgb(256, 0, 0); rgb(0, -1, 0); (1, 2, 3); rgb(1, 2)".split("; ")
    {
        let scene = format!("{CAMERA} sphere {{ center (0, 0, 0) color {text} }}");
        assert_eq!(codes(&scene).len(), 1, "{text}");
    }
}
