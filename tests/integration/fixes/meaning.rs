//! What was meant by words of other programs and other habits: one report, and a fix after which nothing is wrong.

use pinhole::{diagnostic::apply, scene, source::SourceId};

use super::{diagnostics, sources};
use crate::table::rows;

/// Checks that a text has one error, and that its first fix makes of the text what is expected, in which nothing is wrong.
fn becomes(wrong: &str, right: &str) {
    let camera = "camera { eye (0, 0, 9)  lookat (0, 0, 0) }\n";
    let ball = "sphere { center (0, 0, 0) }\n";
    let more = match (
        wrong.contains("camera"),
        wrong.starts_with("camera") || wrong.starts_with("image") || wrong.starts_with("sampler"),
    ) {
        (true, _) => ball.to_owned(),
        (false, true) => format!("{camera}{ball}"),
        (false, false) => camera.to_owned(),
    };
    let text = format!("{more}{wrong}\n");
    let before = sources(&text, &[]);
    let found = diagnostics(&before);
    let errors: Vec<_> = found.iter().filter(|found| found.is_error()).collect();
    assert_eq!(errors.len(), 1, "{wrong}: {errors:#?}");
    let fix = errors[0]
        .fixes
        .first()
        .unwrap_or_else(|| panic!("{wrong}: {:#?}", errors[0]));
    let fixed = apply(fix, SourceId::File, &text);
    assert_eq!(fixed, format!("{more}{right}\n"), "{wrong}");
    let left = diagnostics(&sources(&fixed, &[]));
    assert!(
        !left.iter().any(|found| found.is_error()),
        "{right}: {left:#?}"
    );
}

#[test]
fn fields_by_their_meaning() {
    for [wrong, right] in rows("
        sphere { location (0, 0, 0) } -> sphere { center (0, 0, 0) }
        sphere { center (0, 0, 0)  diameter 2 } -> sphere { center (0, 0, 0)  radius 1 }
        sphere { center (0, 0, 0)  radius2 } -> sphere { center (0, 0, 0)  radius 2 }
        sphere { center (0, 0, 0)  colorred } -> sphere { center (0, 0, 0)  color red }
        sphere { center (0, 0, 0)  color ff0000 } -> sphere { center (0, 0, 0)  color #ff0000 }
        image { backgroundblack } -> image { background black }
        triangle { center (0, 1, 0)  normal (0, 0, 1) } -> triangle { centroid (0, 1, 0)  normal (0, 0, 1) }
        triangle { vertices ((0, 0, 0), (1, 0, 0), (0, 1, 0)) } -> triangle { v0 (0, 0, 0)  v1 (1, 0, 0)  v2 (0, 1, 0) }
        image { resolution (640, 480) } -> image { width 640  height 480 }
        sampler { total_samples 1_000_000 } -> sampler { total 1_000_000 }
        sampler { jittered } -> sampler { method jittered }
        camera { location (0, 0, 9)  lookat (0, 0, 0) } -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
        camera { look_from (0, 0, 9)  lookat (0, 0, 0) } -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
        camera { eyepoint (0, 0, 9)  lookat (0, 0, 0) } -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
        camera { position (0, 0, 9)  lookat (0, 0, 0) } -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
        camera { eye (0, 0, 9)  look_at (0, 0, 0) } -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
        camera { eye (0, 0, 9)  view_direction (0, 0, -1) } -> camera { eye (0, 0, 9)  direction (0, 0, -1) }
    ") {
        becomes(wrong, right);
    }
    let table = "
        view_distance 3 -> d 3
        view_plane_distance 2 -> d 2
        near_clip 1 -> near 1
        nearClip 1 -> near 1
        fov_axis 40deg -> fov 40deg
        angle 90deg -> hfov 90deg
        angle 90 -> hfov 90deg
        fov 40 -> fov 40deg
        fov 40deg  hfov 60deg -> fov 40deg
        roll pi / 2 -> roll pi / 2 * 1rad
    ";
    for [wrong, right] in rows(table) {
        let camera = |field: &str| format!("camera {{ eye (0, 0, 9)  lookat (0, 0, 0)  {field} }}");
        becomes(&camera(wrong), &camera(right));
    }
}

#[test]
fn values_in_other_ways() {
    let table = r"
        sampler { method stratified } -> sampler { method jittered }
        sampler { method grid } -> sampler { method regular }
        sampler { method latin_hypercube } -> sampler { method n_rooks }
        sampler { method monte_carlo } -> sampler { method random }
        checkerboard { square (1, 1) } -> checkerboard { square 1 }
        triangle { centroid (0, 0, 0)  normal (0, 0, 1)  sides (3, 4) } -> triangle { centroid (0, 0, 0)  normal (0, 0, 1)  sides (3, 4, 4) }
        box { min (-15, 0, -15)  max (15, -1, 15) } -> box { min (-15, -1, -15)  max (15, 0, 15) }
        sphere { center (0, 0, 0)  color (0.5, 0.5, 0) } -> sphere { center (0, 0, 0)  color rgb(128, 128, 0) }
        sphere { center (0, 0, 0)  color (128, 128, 0) } -> sphere { center (0, 0, 0)  color rgb(128, 128, 0) }
        sphere { center (0, 0, 0)  color (255, 0, 0, 1) } -> sphere { center (0, 0, 0)  color rgb(255, 0, 0) }
        sphere { center (0, 0,5, 8) } -> sphere { center (0, 0.5, 8) }
        let a = cos(pi/4)\ncheckerboard {} -> let a = cos(pi/4 * 1rad)\ncheckerboard {}
        let b = (0, 1, 0)\nsphere { center b + 1 } -> let b = (0, 1, 0)\nsphere { center b + (1, 1, 1) }
    ";
    for [wrong, right] in rows(table) {
        becomes(wrong, right);
    }
}

/// A name that is near, but whose value would be the next mistake, is told and not offered.
#[test]
fn a_field_is_renamed_only_where_its_value_will_do() {
    for fields in [
        "eye (0, 0, 9)  lookat (0, 0, 0)  eye_x 3",
        "eye (0, 0, 9)  lookat (0, 0, 0)  fov 40deg  angle 90deg",
        "eye (0, 0, 9)  lookat (0, 0, 0)  d 2  view_distance 2",
        "eye (0, 0, 9)  lookat (0, 0, 0)  view_distance -2",
    ] {
        let text = format!("camera {{ {fields} }}\ncheckerboard {{}}\n");
        let found = diagnostics(&sources(&text, &[]));
        assert_eq!(found.len(), 1, "{found:#?}");
        assert_eq!(found[0].code, "pinhole::unknown_field");
        assert!(
            found[0]
                .help
                .as_deref()
                .unwrap()
                .starts_with("did you mean"),
            "{found:#?}"
        );
        assert!(found[0].fixes.is_empty(), "{found:#?}");
    }
}

#[test]
fn an_empty_file_becomes_the_smallest_scene() {
    for text in ["", "// A scene.\n", "\u{feff}"] {
        let found = diagnostics(&sources(text, &[]));
        let fixed = apply(&found[0].fixes[0], SourceId::File, text);
        assert_eq!(fixed, format!("{text}{}", scene::SMALLEST));
        assert!(diagnostics(&sources(&fixed, &[])).is_empty());
    }
}
