//! What fields must be, and what goes with what.

use glam::DVec3;
use pinhole::scene::{self, Cuboid, Lens, Shape, View};

use super::{CAMERA, camera, codes, read, sources};
use crate::table::{list, rows};

#[test]
fn alternatives() {
    let camera = |fields: &str| camera(&format!("eye (0, 0, 1) {fields}"));
    assert_eq!(
        camera("direction (0, 0, -1)").view,
        View::Direction(DVec3::NEG_Z)
    );
    assert_eq!(camera("lookat (0, 0, 0)").view, View::Lookat(DVec3::ZERO));
    assert!(matches!(
        camera("lookat (0, 0, 0) fov 40deg").lens,
        Lens::Fov(_)
    ));
    let found = |fields: &str| codes(&format!("{CAMERA} box {{ {fields} }}")).len();
    assert_eq!(found("min (0, 0, 0) max (1, 1, 1)"), 0);
    for fields in [
        "min (0, 0, 0)",
        "size (1, 1, 1)",
        "",
        "min (0, 0, 0) size (1, 1, 1)",
    ] {
        assert!(found(fields) > 0, "{fields}");
    }
}

#[test]
fn conditions_hold_at_their_bounds() {
    let table = "
        image { width 1048576 height 1 } -> 0
        image { width 1048577 height 1 } -> 1
        image { width 0 } -> 1
        image { width 1048576 height 1048576 } sampler { per_pixel 8192 } -> 0
        image { width 1048576 height 1048576 } sampler { per_pixel 8193 } -> 1
        sampler { total 9007199254740992 } -> 0
        sampler { total 9007199254740994 } -> 1
        sampler { seed 9007199254740991 } -> 0
        sampler { seed 9007199254740992 } -> 1
        camera { eye (0, 0, 1) lookat (0, 0, 0) fov 3.141592653589793rad } -> 0
        camera { eye (0, 0, 1) lookat (0, 0, 0) fov 3.1415926535897936rad } -> 1
        camera { eye (0, 0, 1) lookat (0, 0, 0) fov 180deg } -> 1
        camera { eye (0, 0, 1) lookat (0, 0, 0) fov 0deg } -> 1
        camera { eye (0, 0, 1) lookat (0, 0, 0) near 0 far 5e-324 } -> 0
        camera { eye (0, 0, 1) lookat (0, 0, 0) far 0 } -> 1
        camera { eye (0, 0, 1) lookat (0, 0, 0) near 2 far 2 } -> 1
        camera { eye (0, -0, 1) lookat (0, 0, 1) } -> 1
        triangle { centroid (0, 0, 0) normal (0, 0, 1e-300) sides (1, 2, 2.9999999999999996) } -> 0
        triangle { centroid (0, 0, 0) normal (0, 0, 1) sides (1, 2, 3) } -> 1
        triangle { centroid (0, 0, 0) normal (0, 0, 1) sides (1, 5e-17, 1) } -> 0
    ";
    for [text, problems] in rows(table) {
        let camera = if text.contains("camera") { "" } else { CAMERA };
        let found = codes(&format!("{camera}{text} sphere {{ center (0, 0, 0) }}"));
        assert_eq!(found.len().to_string(), problems, "{text}: {found:?}");
    }
    // Angles of degrees and radians are compared exactly.
    let of_fov = |fov: &str| {
        codes(&format!(
            "camera {{ eye (0, 2, 8) lookat (0, 1, 0) fov {fov} }} checkerboard {{}}"
        ))
    };
    let table = "
        179deg + 0.017453292519943295rad
        1e-20deg + 3.141592653589793rad
        1deg - 0.017453292519943295rad
        180deg - 1e-300rad
    ";
    for fov in list(table) {
        assert_eq!(of_fov(fov), [""; 0], "{fov}");
    }
    let table = "
        1e-10deg + 3.141592653589793rad
        1deg - 0.0174532925199433rad
        180deg + 1e-300rad
        180deg + 1rad - 1rad
    ";
    for fov in list(table) {
        assert_eq!(of_fov(fov), ["out_of_range"], "{fov}");
    }
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
        let text = format!("camera {{ {fields} }} sphere {{ center (0, 0, 0) }}");
        let found = scene::read(&sources(&text)).diagnostics;
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
    let scene = read(&format!(
        "{CAMERA} box {{ center (0.1, 0.2, 0.3) size (0.7, 0.1, 1e-3) }}"
    ));
    let Shape::Box(Cuboid { min, max, .. }) = scene.objects[0].shape else {
        panic!("{scene:?}");
    };
    assert_eq!(min, DVec3::new(0.1 - 0.35, 0.2 - 0.05, 0.3 - 0.0005));
    assert_eq!(max, DVec3::new(0.1 + 0.35, 0.2 + 0.05, 0.3 + 0.0005));
}
