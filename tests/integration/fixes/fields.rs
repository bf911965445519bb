//! Fixes that add fields.

use super::offers;

#[test]
fn fields_are_added_where_the_author_would() {
    offers(
        "camera {\n  d 2 // far\n}\nsphere { center (0, 1, 0) }",
        &[
            (
                "add `eye` and `lookat`",
                "camera {\n  d 2 // far\n  eye (0, 2, 8)\n  lookat (0, 1, 0)\n}\nsphere { center (0, 1, 0) }",
            ),
            (
                "add `eye` and `direction`",
                "camera {\n  d 2 // far\n  eye (0, 2, 8)\n  direction (0, 0, -1)\n}\nsphere { center (0, 1, 0) }",
            ),
        ],
    );
    offers(
        "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\nbox {}",
        &[
            (
                "add `center`",
                "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\nbox { center (0, 1, 0) }",
            ),
            (
                "add `min` and `max`",
                "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\nbox { min (-1, 0, -1)  max (1, 1, 1) }",
            ),
        ],
    );
    // Of a map: what up is was not said.
    offers(
        "camera {\r\n  eye (0, 9, 0)\r\n  direction (0, -1, 0)\r\n}\r\ncheckerboard {}",
        &[(
            "add `up (0, 0, -1)`",
            "camera {\r\n  eye (0, 9, 0)\r\n  direction (0, -1, 0)\r\n  up (0, 0, -1)\r\n}\r\ncheckerboard {}",
        )],
    );
}

#[test]
fn what_is_added_is_laid_out_as_the_rest() {
    offers(
        "sphere { center (0, 1, 0) }\r\n",
        &[(
            "add a camera",
            "sphere { center (0, 1, 0) }\r\ncamera { eye (0, 2, 8)  lookat (0, 1, 0) }\r\n",
        )],
    );
    let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n";
    for (first, indent) in [("sphere { // ball", ""), ("sphere { radius 2", "  ")] {
        offers(
            &format!("{camera}{indent}{first}\n{indent}}}"),
            &[(
                "add `center`",
                &format!("{camera}{indent}{first}\n{indent}  center (0, 1, 0)\n{indent}}}"),
            )],
        );
    }
    for indent in ["\t", "    "] {
        offers(
            &format!("{camera}sphere {{\n{indent}radius 2\n}}"),
            &[(
                "add `center`",
                &format!("{camera}sphere {{\n{indent}radius 2\n{indent}center (0, 1, 0)\n}}"),
            )],
        );
    }
}

#[test]
fn of_two_alternatives_one_that_is_whole_may_be_kept() {
    let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n";
    offers(
        &format!("{camera}box {{ center (0, 1, 0)  min (1, 1, 1) }}"),
        &[(
            "keep `center`, remove `min`",
            &format!("{camera}box {{ center (0, 1, 0) }}"),
        )],
    );
}
