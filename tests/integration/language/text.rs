//! What of a text has a meaning, and what has none.

use proptest::{
    collection::vec,
    prelude::*,
    sample::{select, subsequence},
};

use super::{CAMERA, codes};

#[test]
fn text() {
    let scene = "\u{feff}camera{eye(0,2,8)lookat(0,1,0)}sphere{center(0,1,0)}";
    assert_eq!(codes(scene), [""; 0]);
    let scene = "// a\r\ncamera/* { */{\r\n\teye (0, 2, 8) // (\r\n lookat (0, 1, 0) }/**/sphere\nBall\n{center(0,1,0)}//";
    assert_eq!(codes(scene), [""; 0]);
    assert_eq!(
        codes("/* camera */ // */"),
        ["missing_camera", "no_objects"]
    );
}

#[test]
fn a_kind_may_stand_in_the_line_of_a_value() {
    let ball = "{ center (0, 1, 0) }";
    for scene in [
        "let a = 2 sphere\nB",
        "let a = 2 sphere B",
        "let a = 2\nsphere\nB",
        "let b = 2 let a = b\nsphere",
        "let b = 2 let a = b sphere",
        "let b = 2 let a = b sphere\nbox",
        "let sphere = 2 let a = sphere\nsphere",
        "let sphere = 2 let a = sphere sphere\nsphere",
    ] {
        assert_eq!(
            codes(&format!("{CAMERA}{scene} {ball}")),
            [""; 0],
            "{scene}"
        );
    }
    // Here the text is wrong, and the word is the rest of the value.
    for scene in ["let a = 2 pi\nsphere", "let b = 2 let a = 2 b\nsphere"] {
        let found = codes(&format!("{CAMERA}{scene} {ball}"));
        assert_eq!(found, ["missing_operator"], "{scene}");
    }
    // Neither word is a kind: that is one mistake, not two.
    assert_eq!(
        codes(&format!("{CAMERA}let a = 2 spere\nB {ball}")),
        ["unknown_kind"]
    );
}

proptest! {
    /// White space separates, and otherwise means nothing.
    #[test]
    fn white_space_means_nothing_else(items in shuffled_items(), gaps in vec(gap(), 40)) {
        let plain = items.join(" ");
        let mut text = String::new();
        for (token, gap) in plain.split(' ').zip(gaps.iter().cycle()) {
            text += token;
            // Or else a comment would start with the sign.
            text += if token == "/" { " " } else { "" };
            text += gap;
        }
        prop_assert_eq!(codes(&plain), [""; 0], "{}", plain);
        prop_assert_eq!(codes(&text), [""; 0], "{}", text);
    }
}

fn gap() -> impl Strategy<Value = &'static str> {
    let gaps = " | |  |\n|\r\n|\t|\n\n|/**/| /* a\n */ | // b\n";
    select(gaps.split('|').collect::<Vec<_>>())
}

/// Items of which a scene can be made in any order. Their names are often those of kinds, and the values of the definitions
/// end in every way that there is.
fn shuffled_items() -> impl Strategy<Value = Vec<&'static str>> {
    let items = vec![
        "let a = 2",
        "let b = 2 * pi",
        "let c = - pi",
        "let d = ( 1 + 2 )",
        "let e = max ( 1 , 2 )",
        "let f = 30deg let g = f let h = - g",
        "let i = #fa0",
        "let j = olive",
        "let sphere = 2 let k = sphere",
        "let box = ( 1 , 2 , 3 ) let camera = box",
        "let radius = 1 let method = radius",
        "image { width 64 height 36 background #000 }",
        "sampler { method sobol per_pixel 4 seed 7 }",
        "sphere { center ( 0 , 1 , 0 ) }",
        "sphere Ball { radius max ( 1 , 2 ) center - ( 0 , 1 , 0 ) color red }",
        "box sphere { min ( 0 , 0 , 0 ) max ( 1 , 1 , 1 ) }",
        "box Crate { center ( 0 , 0 , - 1 ) color gray }",
        "checkerboard box { colors ( gray , white ) y - 1 }",
        "triangle triangle { centroid ( 0 , 1 , 0 ) normal ( 0 , 0 , 1 ) spin 30deg * 2 }",
        "triangle { normal ( 0 , 0 , 1 ) centroid ( 0 , 1 , 0 ) / 2 sides ( 1 , 1 , 1 ) }",
    ];
    let camera = "camera { eye ( 0 , 2 , 8 ) lookat ( 0 , 1 , 0 ) fov 40deg }";
    subsequence(items, 1..20)
        .prop_map(move |mut items| {
            items.push(camera);
            items.push("sphere C { center ( 0 , 1 , 0 ) }");
            items
        })
        .prop_shuffle()
}

#[test]
fn names_are_known_by_their_place() {
    let scene = "let radius = 2 let camera = (0, 2, 8) let sphere = (0, 1, 0) let jittered = 3
        camera { eye camera lookat sphere } sampler { method jittered per_pixel jittered }
        sphere sphere { center sphere radius radius }
        box min { min (0, 0, 0) max (min(1, 2), max(1, 2), 1) }";
    assert_eq!(codes(scene), [""; 0]);
}

#[test]
fn nesting() {
    let ends = |open: &str, inner: &str, close: &str, depth: usize| {
        let value = format!("{}{inner}{}", open.repeat(depth), close.repeat(depth));
        codes(&format!(
            "{CAMERA} sphere {{ center (0, 0, 0) }} let a = {value}"
        ))
    };
    for (open, inner, close) in [
        ("(", "1", ")"),
        ("-", "1", ""),
        ("abs(", "1", ")"),
        ("- ", "(1)", ""),
    ] {
        let levels = 256 - inner.matches('(').count();
        assert_eq!(ends(open, inner, close, levels), [""; 0], "{open}");
        assert_eq!(ends(open, inner, close, levels + 1), ["too_deep"], "{open}");
    }
    // Two levels at a time, and as the value of a field, where the first minus follows a name.
    let field = |signs: usize| {
        codes(&format!(
            "{CAMERA} sphere {{ center (0, 0, 0) radius {}1 }}",
            "-".repeat(signs)
        ))
    };
    assert_eq!(field(256), [""; 0]);
    assert_eq!(field(258), ["too_deep"]);
    assert_eq!(ends("-(", "1", ")", 128), [""; 0]);
    assert_eq!(ends("-(", "1", ")", 129), ["too_deep"]);
    // What stands beside does not add up.
    let wide = vec!["-(1)"; 5000].join(" + ");
    assert_eq!(
        codes(&format!(
            "{CAMERA} sphere {{ center (0, 0, 0) }} let a = {wide}"
        )),
        [""; 0]
    );
}
