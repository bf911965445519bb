//! Tests of the camera: its axes, views along the up vector, rolls and lenses.

use glam::{DVec3, dvec3};
use pinhole::{
    math::{Angle, Big, Real},
    reference::scenes::{self, along},
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

/// Returns a camera at the origin that looks along −z, rolled by the angle `roll`.
fn rolled(roll: Angle) -> Camera {
    Camera {
        roll,
        ..along(DVec3::ZERO, DVec3::NEG_Z)
    }
}

/// For the view direction (1, 1, 1), a roll of 60° turns the camera's right axis so that its x
/// component is 0. This component is computed as the difference of two equal products. If each
/// product were rounded before the subtraction, an error would remain.
#[test]
fn a_roll_into_a_coordinate_plane_is_exact() {
    for (x, degrees) in [(1.0, 60.0), (1.0, -120.0), (-1.0, -60.0)] {
        let mut camera = along(DVec3::ZERO, dvec3(x, 1.0, 1.0));
        camera.roll = Angle::from_degrees(degrees);
        let u = basis(&camera).u;
        assert!(u[0].is_zero(), "{x} {degrees}: {u:?}");
    }
}

#[test]
fn views_along_the_up_vector_are_oriented_like_a_map() {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    // Each case gives the view direction and the up vector, and then the world directions that
    // appear to the right and upwards in the picture. The first four cases have an up vector along
    // the y axis.
    let cases = [
        ((-y, y), (x, -z)),
        ((y, y), (x, z)),
        ((-y, -y), (-x, z)),
        ((y, -y), (-x, -z)),
        // The up vector is along the z axis in the next two cases, and along the x axis in the last
        // two.
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

/// A positive roll turns the right side of the picture's frame downwards. A roll by any whole
/// number of quarter turns gives camera axes without rounding errors.
#[test]
fn any_number_of_quarter_rolls_is_exact() {
    let (x, y) = (DVec3::X, DVec3::Y);
    for turns in [0.0, 4.0, -4.0, 4e20] {
        for (quarter, right, top) in [(0.0, x, y), (1.0, -y, x), (2.0, -x, -y), (3.0, y, -x)] {
            if turns > 1e15 && quarter > 0.0 {
                continue; // In such a large number of degrees, adding 90 changes nothing.
            }
            let roll = Angle::from_degrees(turns * 90.0) + Angle::from_degrees(quarter * 90.0);
            assert_eq!(axes(&rolled(roll)), [right, top, DVec3::Z]);
        }
    }
    let [u, v, _] = axes(&rolled(Angle::from_degrees(30.0)));
    assert_eq!((u.y, v.x), (-0.5, 0.5));
}

#[test]
fn fov_spans_the_height_of_the_window() {
    for (degrees, d) in [(90.0, 1.0), (179.999_999, 8.726_646_259_971_647e-9)] {
        let mut camera = rolled(Angle::default());
        camera.lens = Lens::Fov(Angle::from_degrees(degrees));
        let found = basis(&camera).d.to_f64();
        assert!((found / d - 1.0).abs() < 1e-8, "{found}");
    }
}
