//! What fields must be, and what goes with what.

use glam::DVec3;
use pinhole::scene::{Cuboid, Lens, Shape, View};

use super::{assert_codes, object};
use crate::{diagnostics::found, scenes::read, table::rows};

#[test]
fn alternatives() {
    let camera = |fields: &str| read(&format!("camera {{ eye (0, 0, 1) {fields} }}")).camera;
    let direction = camera("direction (0, 0, -1)").view;
    assert_eq!(direction, View::Direction(DVec3::NEG_Z));
    assert_eq!(camera("lookat (0, 0, 0)").view, View::Lookat(DVec3::ZERO));
    let fov = camera("lookat (0, 0, 0) fov 40deg").lens;
    assert!(matches!(fov, Lens::Fov(_)));
    assert_codes(
        "
        box { min (0, 0, 0) max (1, 1, 1) } ->
        box { min (0, 0, 0) } -> missing_field
        box { size (1, 1, 1) } -> missing_field
        box {} -> missing_field
        box { min (0, 0, 0) size (1, 1, 1) } -> conflicting_fields
    ",
    );
}

#[test]
fn conditions_hold_at_their_bounds() {
    assert_codes("
        image { width 1048576 height 1 } ->
        image { width 1048577 height 1 } -> out_of_range
        image { width 0 } -> out_of_range
        image { width 1048576 height 1048576 } sampler { per_pixel 8192 } ->
        image { width 1048576 height 1048576 } sampler { per_pixel 8193 } -> too_many_samples
        sampler { total 9007199254740992 } ->
        sampler { total 9007199254740994 } -> out_of_range
        sampler { seed 9007199254740991 } ->
        sampler { seed 9007199254740992 } -> out_of_range
        camera { eye (0, 0, 1) lookat (0, 0, 0) fov 3.141592653589793rad } ->
        camera { eye (0, 0, 1) lookat (0, 0, 0) fov 3.1415926535897936rad } -> out_of_range
        camera { eye (0, 0, 1) lookat (0, 0, 0) fov 180deg } -> out_of_range
        camera { eye (0, 0, 1) lookat (0, 0, 0) fov 0deg } -> out_of_range
        camera { eye (0, 0, 1) lookat (0, 0, 0) near 0 far 5e-324 } ->
        camera { eye (0, 0, 1) lookat (0, 0, 0) far 0 } -> empty_depth
        camera { eye (0, 0, 1) lookat (0, 0, 0) near 2 far 2 } -> empty_depth
        camera { eye (0, -0, 1) lookat (0, 0, 1) } -> view_undefined
        triangle { centroid (0, 0, 0) normal (0, 0, 1e-300) sides (1, 2, 2.9999999999999996) } ->
        triangle { centroid (0, 0, 0) normal (0, 0, 1) sides (1, 2, 3) } -> not_a_triangle
        triangle { centroid (0, 0, 0) normal (0, 0, 1) sides (1, 5e-17, 1) } ->
        -- Angles of degrees and radians are compared exactly.
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 179deg + 0.017453292519943295rad } ->
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 1e-20deg + 3.141592653589793rad } ->
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 1deg - 0.017453292519943295rad } ->
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 180deg - 1e-300rad } ->
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 1e-10deg + 3.141592653589793rad } -> out_of_range
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 1deg - 0.0174532925199433rad } -> out_of_range
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 180deg + 1e-300rad } -> out_of_range
        camera { eye (0, 2, 8) lookat (0, 1, 0) fov 180deg + 1rad - 1rad } -> out_of_range
    ");
}

/// Each row has a camera, a part of the message, and a part of the help; or neither where nothing is said.
#[test]
fn up_along_the_view_is_a_warning_exactly_where_it_is() {
    for [fields, message, help] in rows("
        eye (0.1, 8, 0.3) lookat (0.1, -0.7, 0.3) -> looks straight along its up vector -> (0, 0, -1)
        eye (0.1, 8, 0.3) lookat (0.10000000000000002, -0.7, 0.3) -> looks all but straight along -> up
        eye (0.1, 8, 0.3) lookat (0.100001, -0.7, 0.3) -> looks all but straight along -> up
        eye (0.1, 8, 0.3) lookat (0.10001, -0.7, 0.3) -> ->
        eye (0, 9, 0) direction (1e-300, -1, 0) -> all but straight along -> up
        eye (0, 9, 0) direction (9e-7, -1, 0) -> all but straight along -> up
        eye (0, 9, 0) direction (1.1e-6, -1, 0) -> ->
        eye (0, -9, 0) lookat (1e-9, 0, 0) -> all but straight along -> up
        eye (0, 8, 0) direction (1, -20, 1) up (-2, 40, -2) -> straight along -> up
        eye (0, 0, 0) lookat (1e-300, 1e300, 0) -> straight along -> up
        eye (0, 0, 0) direction (0, -1, 0) -> straight along -> (0, 0, -1)
        eye (0, 0, 0) direction (0, 1, 0) -> straight along -> (0, 0, 1)
        eye (0, 0, 0) direction (0, -1, 0) up (0, -1, 0) -> straight along -> (0, 0, 1)
        eye (0, 0, 0) direction (0, 1, 0) up (0, -1, 0) -> straight along -> (0, 0, -1)
        eye (0, 0, 0) direction (0, 0, -1) up (0, 0, 1) -> straight along -> (0, 1, 0)
        eye (0, 0, 0) direction (-1, 0, 0) up (1, 0, 0) -> straight along -> (0, 0, -1)
        eye (0, 0, 0) direction (0, -1, 0) up (0, 1e300, 0) -> straight along -> (0, 0, -1)
    ") {
        let found = found(&format!("camera {{ {fields} }} sphere {{ center (0, 0, 0) }}"), &[]);
        let found = found.iter().find(|d| d.code == "pinhole::up_parallel");
        assert_eq!(found.is_some(), !message.is_empty(), "{fields}");
        if let Some(found) = found {
            let said = found.help.as_deref().unwrap_or_default();
            assert!(found.message.contains(message) && said.contains(help), "{fields}: {found:?}");
        }
    }
}

#[test]
fn a_box_is_rounded_once() {
    let written = object("box { center (0.1, 0.2, 0.3) size (0.7, 0.1, 1e-3) }");
    let Shape::Box(Cuboid { min, max, .. }) = written.shape else {
        panic!("{written:?}");
    };
    assert_eq!(min, DVec3::new(0.1 - 0.35, 0.2 - 0.05, 0.3 - 0.0005));
    assert_eq!(max, DVec3::new(0.1 + 0.35, 0.2 + 0.05, 0.3 + 0.0005));
}
