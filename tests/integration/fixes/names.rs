//! Fixes of definitions and of what uses them.

use super::{diagnostics, of_scene, offered, offers, sources};

#[test]
fn a_definition_moves_before_its_first_use() {
    let moves = |before: &str, after: &str| {
        let title = "move `let r` before its first use";
        offers(&of_scene(before), &[(title, &of_scene(after))]);
    };
    moves(
        "sphere { center (0, r, 0) }\nlet r = 2",
        "let r = 2\nsphere { center (0, r, 0) }",
    );
    // With its comments, and before those of what uses it.
    moves(
        "let a = 1\n\n// A ball,\n// a round one.\n  sphere {\n    center (0, r, 0)\n  }\n\n// How high\n/* it\n lies. */\nlet r = 2 // metres\nlet b = r",
        "let a = 1\n\n// How high\n/* it\n lies. */\nlet r = 2 // metres\n// A ball,\n// a round one.\n  sphere {\n    center (0, r, 0)\n  }\n\nlet b = r",
    );
    moves(
        "// A picture of a ball.\r\nsphere { center (0, r, 0) }\r\nlet r = 2\r\n",
        "// A picture of a ball.\r\nlet r = 2\r\nsphere { center (0, r, 0) }\r\n",
    );
    moves(
        "let a = 1 sphere { center (0, r, 0) } let r = max(a, pi) let b = 3",
        "let a = 1 let r = max(a, pi) sphere { center (0, r, 0) } let b = 3",
    );
    // It uses itself, or what would still be below.
    assert!(offered(&of_scene("let s = s + 1")).is_empty());
    let late = "sphere { center (0, r, 0) }\nlet a = 1\nlet r = a";
    assert!(offered(&of_scene(late)).is_empty());
}

#[test]
fn a_definition_of_a_taken_name_gets_another() {
    let renames = |before: &str, new: &str, after: &str| {
        let title = format!("call it `{new}`");
        offers(&of_scene(before), &[(&title, &of_scene(after))]);
    };
    renames(
        "let sin = 2\nlet a = sin(30deg) * 3\nsphere { center (0, 1, 0)  radius sin }",
        "my_sin",
        "let my_sin = 2\nlet a = sin(30deg) * 3\nsphere { center (0, 1, 0)  radius my_sin }",
    );
    // The value is still that of the language.
    renames(
        "let pi = pi / 2\nlet a = 2 * pi",
        "my_pi",
        "let my_pi = pi / 2\nlet a = 2 * my_pi",
    );
    // Where a colour is wanted, that is meant.
    renames(
        "let Red = 2\nsphere { center (0, Red, 0)  color Red }",
        "my_Red",
        "let my_Red = 2\nsphere { center (0, my_Red, 0)  color Red }",
    );
    renames(
        "let red = #f10\nlet b = red\nsphere { center (0, 1, 0)  color red }",
        "my_red",
        "let my_red = #f10\nlet b = my_red\nsphere { center (0, 1, 0)  color my_red }",
    );
    for unclear in [
        "let deg = 3\nlet a = 2 * deg",
        "let red = 3\nlet a = red",
        "let sin = 2\nlet my_sin = 3",
        "let sin = 2\nlet sin = 3",
    ] {
        assert!(offered(&of_scene(unclear)).is_empty(), "{unclear}");
    }
}

#[test]
fn a_definition_that_failed_explains_its_uses() {
    let codes = |text: &str| -> Vec<String> {
        let found = diagnostics(&sources(&of_scene(text), &[]));
        found.into_iter().map(|d| d.code).collect()
    };
    let only = ["pinhole::predefined_name"];
    let sphere = |name: &str, value: &str| {
        format!("let {name} = {value}  sphere {{ center (0, 1, 0)  radius {name} }}")
    };
    for name in ["max", "deg", "gray"] {
        assert_eq!(codes(&sphere(name, "3")), only, "{name}");
    }
    assert_eq!(
        codes("let gray = 2 let a = (0, gray, 0) let b = 1 + gray"),
        only
    );
    // Others, and what stands above, are mistakes of their own.
    let both = codes("let max = 3 sphere { center (0, 1, 0)  radius min }");
    assert_eq!(
        both,
        [
            "pinhole::predefined_name",
            "pinhole::function_without_arguments"
        ]
    );
    let above = codes("let a = max let max = 3");
    assert_eq!(
        above,
        [
            "pinhole::function_without_arguments",
            "pinhole::predefined_name"
        ]
    );
}
