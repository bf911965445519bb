//! Fixes of the text: what is left open, line ends, what stands in the wrong place.

use super::{diagnostics, of_scene, offered, offers, sources};

#[test]
fn what_is_left_open_is_closed() {
    for (before, title, after) in [
        ("let b = 2pi", "write `2 * pi`", "let b = 2 * pi"),
        (
            "let h = 2 let b = 3h",
            "write `3 * h`",
            "let h = 2 let b = 3 * h",
        ),
        (
            "sphere Round ( center (0, 1, 0) )",
            "write `sphere Round {`",
            "sphere Round { center (0, 1, 0) }",
        ),
        (
            "sphere { center (0, 1, 0 radius 2 }",
            "write `)` before `radius`",
            "sphere { center (0, 1, 0) radius 2 }",
        ),
        (
            "sphere { center (0, 1, 0)  radius (2 }",
            "write `)` before `}`",
            "sphere { center (0, 1, 0)  radius (2) }",
        ),
    ] {
        offers(&of_scene(before), &[(title, &of_scene(after))]);
    }
    // The product would be no angle, or of nothing.
    let camera = "checkerboard {} camera { eye (0, 1, 5)  lookat (0, 1, 0)  fov 2pi }";
    assert_eq!(offered(camera), []);
    assert_eq!(offered(&of_scene("let b = 2what")), []);
}

#[test]
fn vectors_side_by_side_are_two_fields() {
    let said = |code: &str, text: &str| {
        let found = diagnostics(&sources(&of_scene(text), &[]));
        let found = found.into_iter().find(|d| d.code == code);
        let found = found.unwrap();
        assert!(found.fixes.is_empty());
        found.help.unwrap()
    };
    let field = "pinhole::missing_field_name";
    let name = "write the name of the field that `(0, 6, 0)` is for before it";
    assert_eq!(
        said(field, "sphere { center (0, 6, 1)  (0, 6, 0)  radius 2 }"),
        name
    );
    assert_eq!(
        said(field, "sphere { center (0, 6, 1)  color #f00  (0, 6, 0) }"),
        name
    );
    assert_eq!(
        said(field, "sphere { center (0, 6, 1)  red  radius 2 }"),
        "write `color red`"
    );
    assert_eq!(
        said("pinhole::missing_operator", "let a = (0, 6, 1)  (0, 6, 0)"),
        "write an operator between them, or take one of them away"
    );
}

#[test]
fn what_a_help_says_is_done() {
    let end = "\ncamera { eye (0, 1, 5)  lookat (0, 1, 0) }\ncheckerboard {}";
    for (text, title, fixed) in [
        (
            "sphere Big Ball { center (0, 1, 0) }",
            "write `sphere Big_Ball {`",
            "sphere Big_Ball { center (0, 1, 0) }",
        ),
        (
            "sphere my-ball { center (0, 1, 0) }",
            "write `sphere my_ball {`",
            "sphere my_ball { center (0, 1, 0) }",
        ),
        (
            "Tail = sphere { center (0, 1, 0) }",
            "write `sphere Tail {`",
            "sphere Tail { center (0, 1, 0) }",
        ),
        (
            "let Head = sphere { center (0, 1, 0) }",
            "write `sphere Head {`",
            "sphere Head { center (0, 1, 0) }",
        ),
        ("let a = 2 m", "write `2`", "let a = 2"),
        ("let a = 30degrees", "write `30deg`", "let a = 30deg"),
    ] {
        offers(
            &format!("{text}{end}"),
            &[(title, &format!("{fixed}{end}"))],
        );
    }
    // The numbers are what a field was to have.
    assert!(offered(&format!("sphere (0, 1, 0) {{ radius 2 }}{end}")).is_empty());
}

#[test]
fn comments_of_other_languages_get_their_sign() {
    offers(
        &of_scene("# a\n  ## b\nlet c = 1"),
        &[("write `//`", &of_scene("// a\n  // b\nlet c = 1"))],
    );
    offers(
        &of_scene("let a = 1 -- big"),
        &[("write `//`", &of_scene("let a = 1 // big"))],
    );
    // A difference, whatever it looks like.
    for text in [
        "let a = 1 let b = 2 -- a",
        "let a = 1 --2",
        "let a = 2 -- pi",
        "let a = 2\n-- sqrt(4)",
        "let a = (#fff, # f00\n)",
        "let a = \"# no comment\"",
        "sphere { radus #ff }",
        "sphere { fill #orange }",
    ] {
        let found = diagnostics(&sources(&of_scene(text), &[]));
        let found = found.iter().map(|d| d.code.as_str());
        assert!(
            !found.into_iter().any(|code| code.ends_with("comment_sign")),
            "{text}"
        );
    }
}

#[test]
fn an_argument_may_start_with_two_minuses() {
    let sources = sources(&of_scene("let a = 1"), &["a=--2".to_owned()]);
    assert_eq!(diagnostics(&sources), []);
}

#[test]
fn what_is_open_at_the_end_is_closed_there() {
    let scene = of_scene("");
    offers(
        &format!("{scene}let v = (1, 2, 3 // far\n"),
        &[(
            "write `)` at the end",
            &format!("{scene}let v = (1, 2, 3) // far\n"),
        )],
    );
    // Where a comment should have ended, nobody can tell.
    offers(&format!("{scene}/* far\naway\n"), &[]);
}

#[test]
fn a_block_is_closed_behind_the_comment_of_its_last_field() {
    let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n";
    for (rest, closed) in [
        ("  radius 2 // big\n", "  radius 2 // big\n}\n"),
        ("  radius 2 // big", "  radius 2 // big\n}"),
        (
            "  radius 2 /* very\n big */\n",
            "  radius 2\n} /* very\n big */\n",
        ),
    ] {
        let begun = format!("{camera}sphere {{ center (0, 1, 0)\n");
        let fix = ("close the block of `sphere`", format!("{begun}{closed}"));
        offers(&format!("{begun}{rest}"), &[(fix.0, &fix.1)]);
    }
}
