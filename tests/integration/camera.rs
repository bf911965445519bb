//! The camera: its axes, singular views, roll and lenses.

use glam::{DVec3, dvec3};
use pinhole::{
    math::{Angle, Big, Real},
    report::numerics::scenes::{self, along},
    scene::{Camera, Lens},
    tracer::Basis,
};

fn basis(camera: &Camera) -> Basis {
    Basis::new(camera, &scenes::scene(*camera, &[]).image)
}

fn axes(camera: &Camera) -> [DVec3; 3] {
    let basis = basis(camera);
    [&basis.u, &basis.v, &basis.w].map(|v| DVec3::from(v.each_ref().map(Big::to_f64)))
}

/// A camera at the origin that looks along −z, rolled.
fn rolled(roll: Angle) -> Camera {
    Camera {
        roll,
        ..along(DVec3::ZERO, DVec3::NEG_Z)
    }
}

/// Along (1, 1, 1), u and v have in x the ratio that the sine and the cosine of 60 degrees have:
/// equal products take each other away, and not all but a rounding of each other.
#[test]
fn a_roll_that_ends_in_a_plane_of_the_axes_is_in_it() {
    for (x, degrees) in [(1.0, 60.0), (1.0, -120.0), (-1.0, -60.0)] {
        let mut camera = along(DVec3::ZERO, dvec3(x, 1.0, 1.0));
        camera.roll = Angle::from_degrees(degrees);
        let u = basis(&camera).u;
        assert!(u[0].is_zero(), "{x} {degrees}: {u:?}");
    }
}

#[test]
fn straight_up_and_down_read_like_a_map() {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    // (direction, up) to (right, top)
    let cases = [
        ((-y, y), (x, -z)),
        ((y, y), (x, z)),
        ((-y, -y), (-x, z)),
        ((y, -y), (-x, -z)),
        // The same rule about the other axes.
        ((-z, z), (x, y)),
        ((z, z), (x, -y)),
        ((-x, x), (-y, -z)),
        ((x, x), (-y, z)),
    ];
    for ((direction, up), (right, top)) in cases {
        for length in [1.0, 3.0, 1e-300, 1e300] {
            let mut camera = along(DVec3::ZERO, direction * length);
            camera.up = up * 7.0;
            assert_eq!(axes(&camera), [right, top, -direction], "up {up}");
        }
    }
}

/// A positive roll dips the right side.
#[test]
fn quarter_rolls_are_exact_however_many() {
    let (x, y) = (DVec3::X, DVec3::Y);
    for turns in [0.0, 4.0, -4.0, 4e20] {
        for (quarter, right, top) in [(0.0, x, y), (1.0, -y, x), (2.0, -x, -y), (3.0, y, -x)] {
            if turns > 1e15 && quarter > 0.0 {
                continue; // 90 is lost in the sum of such degrees
            }
            let roll = Angle::from_degrees(turns * 90.0) + Angle::from_degrees(quarter * 90.0);
            assert_eq!(axes(&rolled(roll)), [right, top, DVec3::Z]);
        }
    }
    let [u, v, _] = axes(&rolled(Angle::from_degrees(30.0)));
    assert_eq!((u.y, v.x), (-0.5, 0.5));
}

#[test]
fn the_field_of_view_is_the_windows_height() {
    for (degrees, d) in [(90.0, 1.0), (179.999_999, 8.726_646_259_971_647e-9)] {
        let mut camera = rolled(Angle::default());
        camera.lens = Lens::Fov(Angle::from_degrees(degrees));
        let found = basis(&camera).d.to_f64();
        assert!((found / d - 1.0).abs() < 1e-8, "{found}");
    }
}
