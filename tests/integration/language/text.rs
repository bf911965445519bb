//! Tests of white space in scenes, and of the limit of nested parentheses.

use proptest::{prelude::*, sample::subsequence};

use super::{CAMERA, codes};
use crate::format::any::{gaps, spaced};

proptest! {
    /// White space separates tokens and has no other meaning.
    #[test]
    fn white_space_only_separates_tokens(items in shuffled_items(), gaps in gaps()) {
        for text in [items.join(" "), spaced(&items.join(" "), &gaps)] {
            prop_assert_eq!(codes(&text), "", "{}", text);
        }
    }
}

/// Generates the items of a scene in random order. Many of their names are also names of blocks.
/// The definitions' values end in different kinds of tokens, such as a unit or a parenthesis.
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
    let whole = subsequence(items, 1..20).prop_map(move |mut items| {
        items.extend([camera, "sphere C { center ( 0 , 1 , 0 ) }"]);
        items
    });
    whole.prop_shuffle()
}

#[test]
fn nesting_beyond_256_levels_is_an_error() {
    // The value is tested in a definition, and in a field, where a minus sign may follow a name.
    let of = |open: &str, inner: &str, close: &str, depth: usize| {
        let value = format!("{}{inner}{}", open.repeat(depth), close.repeat(depth));
        let [of_let, of_field] =
            ["checkerboard {} let a = _", "checkerboard { y _ }"].map(|text| {
                let text = text.replace('_', &value);
                codes(&format!("{CAMERA}{text}"))
            });
        assert_eq!(of_let, of_field);
        of_let
    };
    for (open, inner, close, levels) in [
        ("(", "1", ")", 256),
        ("-", "1", "", 256),
        ("abs(", "1", ")", 256),
        ("- ", "(1)", "", 255),
        ("-(", "1", ")", 128),
    ] {
        assert_eq!(of(open, inner, close, levels), "", "{open}");
        assert_eq!(of(open, inner, close, levels + 1), "too_deep", "{open}");
    }
    // The terms of a sum are not nested, so any number of them is allowed.
    let wide = vec!["-(1)"; 5000].join(" + ");
    assert_eq!(of("", &wide, "", 0), "");
}
