//! Fixes that take something away, and what they leave.

use super::{offered, offers};

#[test]
fn of_two_either_one_is_kept() {
    offers(
        "camera {\n  eye (0, 1, 5)\n  lookat (0, 1, 0)\n  direction (0, 0, -1)\n}\ncheckerboard {}",
        &[
            (
                "keep `lookat`, remove `direction`",
                "camera {\n  eye (0, 1, 5)\n  lookat (0, 1, 0)\n}\ncheckerboard {}",
            ),
            (
                "keep `direction`, remove `lookat`",
                "camera {\n  eye (0, 1, 5)\n  direction (0, 0, -1)\n}\ncheckerboard {}",
            ),
        ],
    );
    // A corner by itself would not be enough.
    let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n";
    offers(
        &format!("{camera}box {{ center (0, 1, 0)  size (1, 1, 1)  min (0, 0, 0) }}"),
        &[(
            "keep `center` and `size`, remove `min`",
            &format!("{camera}box {{ center (0, 1, 0)  size (1, 1, 1) }}"),
        )],
    );
    offers(
        &format!("{camera}sphere {{ center (0, 1, 0)  radius 1  radius 2 }}"),
        &[
            (
                "keep the first `radius`, remove the second",
                &format!("{camera}sphere {{ center (0, 1, 0)  radius 1 }}"),
            ),
            (
                "keep the second `radius`, remove the first",
                &format!("{camera}sphere {{ center (0, 1, 0)  radius 2 }}"),
            ),
        ],
    );
}

#[test]
fn a_comment_goes_with_what_it_is_about() {
    let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n";
    offers(
        &format!(
            "{camera}sphere {{\n  center (0, 1, 0)\n  radius 1 // once\n  radius 2 // again\n}}"
        ),
        &[
            (
                "keep the first `radius`, remove the second, with its comment",
                &format!("{camera}sphere {{\n  center (0, 1, 0)\n  radius 1 // once\n}}"),
            ),
            (
                "keep the second `radius`, remove the first, with its comment",
                &format!("{camera}sphere {{\n  center (0, 1, 0)\n  radius 2 // again\n}}"),
            ),
        ],
    );
    let block = |fields: &str| format!("{camera}box {{\n{fields}}}");
    offers(
        &block("  min (0, 0, 0)  // low\n  max (1, 1, 1)  // high\n  center (0, 1, 0)\n"),
        &[
            (
                "keep `min` and `max`, remove `center`",
                &block("  min (0, 0, 0)  // low\n  max (1, 1, 1)  // high\n"),
            ),
            (
                "keep `center`, remove `min` and `max`, with its comment",
                &block("  center (0, 1, 0)\n"),
            ),
        ],
    );
}

#[test]
fn what_a_fix_leaves_is_tidy() {
    let rest = "\ncheckerboard {} camera { eye (0, 1, 5)  lookat (0, 1, 0) }";
    for (written, title, fixed) in [
        ("let a = (0, +1, 0)", "write `1`", "let a = (0, 1, 0)"),
        ("let a: 4", "write `let a = 4`", "let a = 4"),
        ("let a : 4", "write `let a = 4`", "let a = 4"),
        ("let a = (2 + )", "remove this `+`", "let a = (2)"),
    ] {
        let fixed = format!("{fixed}{rest}");
        offers(&format!("{written}{rest}"), &[(title, &fixed)]);
    }
    // 45 radians are more than half a turn.
    let camera = |fov: &str| {
        format!("checkerboard {{}} camera {{ eye (0, 1, 5)  lookat (0, 1, 0)  fov {fov} }}")
    };
    offers(&camera("45"), &[("write `45deg`", &camera("45deg"))]);
    offers(
        &camera("1"),
        &[
            ("write `1deg`", &camera("1deg")),
            ("write `1rad`", &camera("1rad")),
        ],
    );
    offers(&camera("200"), &[]);
    let product = |sign: &str| {
        format!(
            "let b = 2 checkerboard {{}} camera {{ eye (0, 1, 5)  lookat (0, 1, 0)  d 2{sign}b * 2 }}"
        )
    };
    let fixes = offered(&product("  "));
    assert_eq!(fixes[0].1, product(" * "));
}
