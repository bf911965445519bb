//! The warnings of cameras that see nothing, or do not know which way is up: when they come, and that they are never false.

use pinhole::{
    area::Area,
    render::{Control, render_exact},
    sampling::CounterRng,
    tracer::World,
};
use rand::{RngExt, SeedableRng};

use super::{codes, read};

/// What is warned of, of a camera with these fields and some objects.
fn warned(camera: &str, objects: &str) -> Vec<String> {
    codes(&format!("camera {{ {camera} }}\n{objects}"))
}

const BALL: &str = "sphere { center (0, 1, 0) }";

#[test]
fn a_camera_that_sees_nothing_is_warned_of() {
    for (camera, objects) in [
        ("eye (0, 1, 8)  direction (0, 0, 1)", BALL),
        ("eye (0, 1, 8)  direction (1, 0, 0)", BALL),
        ("eye (0, 1, 8)  lookat (0, 1, 0)  near 9.01", BALL),
        ("eye (0, 1, 8)  lookat (0, 1, 0)  far 6.99", BALL),
        ("eye (0, 1, 8)  lookat (0, 1, 0)  near 2  far 3", BALL),
        ("eye (0, 1, 8)  lookat (0, 5, 0)  hfov 10deg", BALL),
        ("eye (0, 1, 8)  direction (0, 1, 0.1)", "checkerboard {}"),
        (
            "eye (0, 1, 8)  direction (0, 0.5, -1)  fov 50deg",
            "checkerboard {}",
        ),
        ("eye (0, 0, 8)  direction (0, -1, -1)", "checkerboard {}"),
        (
            "eye (0, 1, 8)  direction (0, -0.1, -1)  fov 5deg  far 5",
            "checkerboard {}",
        ),
        (
            "eye (0, 1, 8)  direction (0, 0, 1)",
            "box { min (-1, 0, -1)  max (1, 2, 1) }",
        ),
        (
            "eye (0, 1, 8)  direction (0, 0, 1)",
            "triangle { v0 (0, 0, 0)  v1 (1, 0, 0)  v2 (0, 1, 0) }",
        ),
        (
            "eye (0, 1, 8)  direction (0, 0, 1)",
            "triangle { centroid (0, 0, 0)  normal (0, 0, 1) }",
        ),
    ] {
        assert_eq!(
            warned(camera, objects),
            ["nothing_seen"],
            "{camera}: {objects}"
        );
    }
}

#[test]
fn what_is_hardly_seen_is_not_warned_of() {
    for (camera, objects) in [
        ("eye (0, 1, 8)  lookat (0, 1, 0)  near 8.9", BALL),
        ("eye (0, 1, 8)  lookat (0, 1, 0)  far 7.1", BALL),
        // Within.
        ("eye (0, 1, 0)  direction (0, 0, 1)", BALL),
        (
            "eye (0, 1, 8)  direction (0, 0, 1)",
            "sphere { center (0, 1, 8.5) }",
        ),
        (
            "eye (0, 1, 8)  direction (0, 0.4, -1)  fov 50deg",
            "checkerboard {}",
        ),
        (
            "eye (0, 1, 8)  direction (0, -0.1, -1)  fov 5deg",
            "checkerboard {}",
        ),
        ("eye (0, 1, 8)  direction (0, 0, 1)", "checkerboard {}"),
        // One of them.
        (
            "eye (0, 1, 8)  direction (0, 0, 1)",
            "sphere { center (0, 1, 0) } sphere { center (0, 1, 12) }",
        ),
    ] {
        assert_eq!(warned(camera, objects), [""; 0], "{camera}: {objects}");
    }
    // A mistake is enough: what is missing may be what would be seen.
    let two = "sphere { center (0, 1, 0) } sphere { centre (0, 1, 12) }";
    assert_eq!(
        warned("eye (0, 1, 8)  direction (0, 0, 1)", two),
        ["unknown_field"]
    );
}

/// Numbers that are the same in each run.
struct Random(CounterRng);

impl Random {
    fn new(seed: u64) -> Self {
        Self(CounterRng::seed_from_u64(seed))
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    fn vector(&mut self, size: f64) -> String {
        let mut one = || self.within(-size, size);
        format!("({}, {}, {})", one(), one(), one())
    }
}

#[test]
fn a_warning_is_never_false_and_comes_often_enough() {
    let mut random = Random::new(3);
    let (mut warned, mut black) = (0, 0);
    for round in 0..450 {
        let objects = match round % 5 {
            0 => format!(
                "sphere {{ center {}  radius {}  color white }}",
                random.vector(3.0),
                random.within(0.1, 1.5)
            ),
            1 => format!(
                "triangle {{ v0 {}  v1 {}  v2 {}  color white }}",
                random.vector(3.0),
                random.vector(3.0),
                random.vector(3.0)
            ),
            2 => format!("box {{ center {}  color white }}", random.vector(3.0)),
            3 => format!(
                "triangle {{ centroid {}  normal {}  color white }}",
                random.vector(3.0),
                random.vector(1.0)
            ),
            _ => "checkerboard { colors (white, white) }".to_owned(),
        };
        let clip = match round % 3 {
            0 => format!(
                "near {}  far {}",
                random.within(0.1, 3.0),
                random.within(3.0, 6.0)
            ),
            _ => String::new(),
        };
        let lens = ["fov", "hfov"][round % 2];
        let text = format!(
            "image {{ width 12  height 8 }}\n\
             camera {{ eye {}  lookat {}  roll {}deg  {lens} {}deg  {clip} }}\n{objects}",
            random.vector(4.0),
            random.vector(2.0),
            random.within(-180.0, 180.0),
            random.within(10.0, 120.0)
        );
        let is_warned = codes(&text) == ["nothing_seen"];
        let control = Control::default();
        let exact = render_exact(&World::new(&read(&text)), Area::whole(12, 8), &control).unwrap();
        let is_black = (0..8).all(|y| exact.film.row(y).iter().all(|pixel| pixel[0] <= 1e-9));
        assert!(is_black || !is_warned, "{text}");
        warned += u32::from(is_warned);
        black += u32::from(is_black);
    }
    // Bounds are larger than what they bound, and what is left of the window may be below the pixels' own.
    assert!(black > 150 && warned * 2 > black, "{warned} of {black}");
}

#[test]
fn an_up_vector_hardly_off_the_view_is_warned_of() {
    let up = |x: &str| {
        warned(
            &format!("eye (0, 9, 0)  direction ({x}, -1, 0)"),
            "checkerboard {}",
        )
    };
    for x in ["0", "1e-300", "1e-16", "9e-7"] {
        assert_eq!(up(x), ["up_parallel"], "{x}");
    }
    assert_eq!(up("1.1e-6"), [""; 0]);
    assert_eq!(
        warned("eye (0, -9, 0)  lookat (1e-9, 0, 0)", "checkerboard {}"),
        ["up_parallel"]
    );
}
