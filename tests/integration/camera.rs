//! The camera: its axes, singular views, roll and lenses.

use glam::{DVec2, DVec3, dvec3};
use pinhole::{
    math::{Angle, Big, Real},
    scene::{Camera, Lens, View},
    tracer::{Basis, World},
};

use crate::tracer::{Random, camera, cuboid, floor, scene, sphere, triangle};

fn axes(camera: &Camera) -> [DVec3; 3] {
    let image = scene(*camera, &[]).image;
    let basis = Basis::new(camera, &image);
    [&basis.u, &basis.v, &basis.w].map(|v| DVec3::from(v.each_ref().map(Big::to_f64)))
}

fn along(direction: DVec3, up: DVec3) -> Camera {
    Camera {
        view: View::Direction(direction),
        up,
        ..camera(DVec3::ZERO, DVec3::ZERO)
    }
}

/// Along (1, 1, 1), u and v have in x the ratio that the sine and the cosine of 60 degrees have: equal products take each other away, and not all
/// but a rounding of each other.
#[test]
fn a_roll_that_ends_in_a_plane_of_the_axes_is_in_it() {
    for (x, degrees) in [(1.0, 60.0), (1.0, -120.0), (-1.0, -60.0)] {
        let mut camera = along(dvec3(x, 1.0, 1.0), DVec3::Y);
        camera.roll = Angle::from_degrees(degrees);
        let basis = Basis::new(&camera, &scene(camera, &[]).image);
        assert!(basis.u[0].is_zero(), "{x} {degrees}: {:?}", basis.u);
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
            let [u, v, w] = axes(&along(direction * length, up * 7.0));
            assert_eq!(
                (u, v, w),
                (right, top, -direction),
                "along {direction}, up {up}"
            );
        }
    }
}

#[test]
fn tilting_down_or_up_ends_in_the_straight_view() {
    for (y, up) in [(-1.0, DVec3::Y), (1.0, DVec3::Y)] {
        let nearly = axes(&along(dvec3(0.0, y, -1e-200), up));
        let straight = axes(&along(dvec3(0.0, y, 0.0), up));
        for (a, b) in nearly.iter().zip(straight) {
            assert!((*a - b).abs().max_element() < 1e-15);
        }
    }
}

#[test]
fn positive_roll_dips_the_right_side() {
    let mut camera = along(DVec3::NEG_Z, DVec3::Y);
    camera.roll = Angle::from_degrees(30.0);
    let [u, v, _] = axes(&camera);
    assert!(u.y < 0.0 && v.x > 0.0);
    assert_eq!((u.y, v.x), (-0.5, 0.5));
}

#[test]
fn quarter_rolls_are_exact_however_many() {
    let (x, y) = (DVec3::X, DVec3::Y);
    for turns in [0.0, 4.0, -4.0, 4e20] {
        for (quarter, right, top) in [(0.0, x, y), (1.0, -y, x), (2.0, -x, -y), (3.0, y, -x)] {
            let mut camera = along(DVec3::NEG_Z, DVec3::Y);
            camera.roll = Angle::from_degrees(turns * 90.0) + Angle::from_degrees(quarter * 90.0);
            if turns > 1e15 && quarter > 0.0 {
                continue; // 90 is lost in the sum of such degrees
            }
            assert_eq!(axes(&camera), [right, top, DVec3::Z]);
        }
    }
}

#[test]
fn a_quarter_roll_turns_the_picture_exactly() {
    let shapes = [
        sphere(dvec3(-0.6, 0.3, 0.0), 1.0),
        triangle(dvec3(0.8, 1.0, 0.6), dvec3(0.3, 0.2, 1.0)),
        cuboid(dvec3(0.2, 0.0, -1.5), dvec3(1.1, 1.5, 0.5)),
        floor(),
    ];
    let upright = camera(dvec3(1.0, 2.5, 4.0), dvec3(0.2, 0.8, 0.0));
    let mut rolled = upright;
    rolled.roll = Angle::from_degrees(90.0);
    let (before, after) = (
        World::new(&scene(upright, &shapes)),
        World::new(&scene(rolled, &shapes)),
    );
    let mut random = Random::new(9);
    for y in 0..64 {
        for x in 0..64 {
            let offset = random.offset();
            // Counter-clockwise: what was at (p, q) from the middle, y down, is now at (q, −p).
            let turned = DVec2::new(offset.y, -offset.x);
            assert_eq!(
                before.slot_at(x, y, offset),
                after.slot_at(y, 63 - x, turned)
            );
        }
    }
}

#[test]
fn the_field_of_view_is_the_windows_height() {
    for (degrees, d) in [
        (90.0, 1.0),
        (2.0 * 45.0, 1.0),
        (179.999_999, 8.726_646_259_971_647e-9),
    ] {
        let mut camera = along(DVec3::NEG_Z, DVec3::Y);
        camera.lens = Lens::Fov(Angle::from_degrees(degrees));
        let basis = Basis::new(&camera, &scene(camera, &[]).image);
        assert!(
            (basis.d.to_f64() / d - 1.0).abs() < 1e-8,
            "{}",
            basis.d.to_f64()
        );
    }
}
