//! What fields must be, and what goes with what.

use glam::DVec3;
use pinhole::scene::{self, Cuboid, Lens, Shape, View};

use super::{CAMERA, camera, codes, read, sources};

#[test]
fn alternatives() {
    assert_eq!(
        camera("eye (0, 0, 1) direction (0, 0, -1)").view,
        View::Direction(DVec3::NEG_Z)
    );
    assert_eq!(
        camera("eye (0, 0, 1) lookat (0, 0, 0)").view,
        View::Lookat(DVec3::ZERO)
    );
    assert!(matches!(
        camera("eye (0, 0, 1) lookat (0, 0, 0) fov 40deg").lens,
        Lens::Fov(_)
    ));
    let scene = |fields: &str| format!("{CAMERA} box {{ {fields} }}");
    assert_eq!(codes(&scene("min (0, 0, 0) max (1, 1, 1)")), [""; 0]);
    for fields in [
        "min (0, 0, 0)",
        "size (1, 1, 1)",
        "",
        "min (0, 0, 0) size (1, 1, 1)",
    ] {
        assert!(!codes(&scene(fields)).is_empty(), "{fields}");
    }
}

#[test]
fn conditions_hold_at_their_bounds() {
    let ok = |text: &str| {
        let found = codes(&format!("{text} sphere {{ center (0, 0, 0) }}"));
        assert_eq!(found, [""; 0], "{text}");
    };
    let bad = |text: &str| {
        let found = codes(&format!("{text} sphere {{ center (0, 0, 0) }}"));
        assert_eq!(found.len(), 1, "{text}: {found:?}");
    };
    ok(&format!("{CAMERA} image {{ width 1048576 height 1 }}"));
    bad(&format!("{CAMERA} image {{ width 1048577 height 1 }}"));
    bad(&format!("{CAMERA} image {{ width 0 }}"));
    ok(&format!(
        "{CAMERA} image {{ width 1048576 height 1048576 }} sampler {{ per_pixel 8192 }}"
    ));
    bad(&format!(
        "{CAMERA} image {{ width 1048576 height 1048576 }} sampler {{ per_pixel 8193 }}"
    ));
    ok(&format!("{CAMERA} sampler {{ total 9007199254740992 }}"));
    bad(&format!("{CAMERA} sampler {{ total 9007199254740994 }}"));
    ok(&format!("{CAMERA} sampler {{ seed 9007199254740991 }}"));
    bad(&format!("{CAMERA} sampler {{ seed 9007199254740992 }}"));
    ok("camera { eye (0, 0, 1) lookat (0, 0, 0) fov 3.141592653589793rad }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) fov 3.1415926535897936rad }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) fov 180deg }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) fov 0deg }");
    ok("camera { eye (0, 0, 1) lookat (0, 0, 0) near 0 far 5e-324 }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) far 0 }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) near 2 far 2 }");
    bad("camera { eye (0, -0, 1) lookat (0, 0, 1) }");
    ok(&format!(
        "{CAMERA} triangle {{ centroid (0, 0, 0) normal (0, 0, 1e-300) sides (1, 2, 2.9999999999999996) }}"
    ));
    bad(&format!(
        "{CAMERA} triangle {{ centroid (0, 0, 0) normal (0, 0, 1) sides (1, 2, 3) }}"
    ));
    ok(&format!(
        "{CAMERA} triangle {{ centroid (0, 0, 0) normal (0, 0, 1) sides (1, 5e-17, 1) }}"
    ));
}

#[test]
fn up_along_the_view_is_a_warning_exactly_where_it_is() {
    let camera = |fields: &str| {
        codes(&format!(
            "camera {{ {fields} }} sphere {{ center (0, 0, 0) }}"
        ))
    };
    assert_eq!(
        camera("eye (0.1, 8, 0.3) lookat (0.1, -0.7, 0.3)"),
        ["up_parallel"]
    );
    assert_eq!(
        camera("eye (0.1, 8, 0.3) lookat (0.10001, -0.7, 0.3)"),
        [""; 0]
    );
    assert_eq!(
        camera("eye (0, 8, 0) direction (1, -20, 1) up (-2, 40, -2)"),
        ["up_parallel"]
    );
    let message = |fields: &str| {
        let text = format!("camera {{ {fields} }} sphere {{ center (0, 0, 0) }}");
        let found = scene::read(&sources(&text)).diagnostics;
        found[0].message.clone()
    };
    for (x, parallel) in [
        ("0.1", "straight along"),
        ("0.10000000000000002", "all but straight along"),
        ("0.100001", "all but straight along"),
    ] {
        let said = message(&format!("eye (0.1, 8, 0.3) lookat ({x}, -0.7, 0.3)"));
        assert_eq!(said, format!("the camera looks {parallel} its up vector"));
    }
    assert_eq!(
        camera("eye (0, 0, 0) lookat (1e-300, 1e300, 0)"),
        ["up_parallel"]
    );
    let help = |fields: &str| {
        let text = format!("camera {{ {fields} }} sphere {{ center (0, 0, 0) }}");
        let found = scene::read(&sources(&text)).diagnostics;
        found[0].help.clone().expect("a help")
    };
    for (fields, up) in [
        ("direction (0, -1, 0)", "(0, 0, -1)"),
        ("direction (0, 1, 0)", "(0, 0, 1)"),
        ("direction (0, -1, 0) up (0, -1, 0)", "(0, 0, 1)"),
        ("direction (0, 1, 0) up (0, -1, 0)", "(0, 0, -1)"),
        ("direction (0, 0, -1) up (0, 0, 1)", "(0, 1, 0)"),
        ("direction (-1, 0, 0) up (1, 0, 0)", "(0, 0, -1)"),
        ("direction (0, -1, 0) up (0, 1e300, 0)", "(0, 0, -1)"),
    ] {
        let help = help(&format!("eye (0, 0, 0) {fields}"));
        assert!(help.contains(up), "{fields}: {help}");
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
