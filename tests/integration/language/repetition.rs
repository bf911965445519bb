//! Compares repeated objects with equal objects that are written one by one.

use pinhole::{format, inspect, scene};

use super::{CAMERA, overrides::meaning};
use crate::{
    diagnostics::codes,
    scenes::{json_of, sources},
    table::rows,
};

/// Rows of three cells: a repeated block, the names of its objects, and equal objects written one
/// by one.
const REPEATED: &str = "
    sphere B for i < 3 { center (i, 1, 0) } -> B[0] B[1] B[2] \
        -> sphere { center (0, 1, 0) } sphere { center (1, 1, 0) } sphere { center (2, 1, 0) }
    -- The last index counts fastest, and a count may depend on those before it.
    sphere B for i < 3, j < i { center (i, j, 0) } -> B[1,0] B[2,0] B[2,1] \
        -> sphere { center (1, 0, 0) } sphere { center (2, 0, 0) } sphere { center (2, 1, 0) }
    sphere for i < 2, j < 1, k < 2 - i { center (i, j, k) radius i + k + 1 } -> - - - \
        -> sphere { center (0, 0, 0) radius 1 } sphere { center (0, 0, 1) radius 2 } sphere { center (1, 0, 0) radius 2 }
    -- Nothing at all.
    sphere B for i < 0 { center (1 / i, 0, 0) } checkerboard {} -> - -> checkerboard {}
    sphere B for i < 3, j < 0 { center (i, j, 0) } checkerboard {} -> - -> checkerboard {}
    sphere B for i < 2, j < 3 * i - 3 * i, k < j { center (i, j, k) } checkerboard {} -> - -> checkerboard {}
    -- Two colours in turn: by a pair, or by a name of one.
    box C for i < 2, j < 2 { center (i, 1, j) color (red, #00f) } -> C[0,0] C[0,1] C[1,0] C[1,1] \
        -> box { center (0, 1, 0) color red } box { center (0, 1, 1) color blue } box { center (1, 1, 0) color blue } box { center (1, 1, 1) color red }
    let both = (red, blue) sphere for i < 2 { center (i, 1, 0) color both } -> - - \
        -> sphere { center (0, 1, 0) color red } sphere { center (1, 1, 0) color blue }
    -- Indices are known in their block alone, and others can have the same name.
    sphere A for i < 1 { center (i, 1, 0) } sphere B for i < 1 { center (2, i, 0) } let i = 7 sphere { center (i, 0, 0) } -> A[0] B[0] - \
        -> sphere { center (0, 1, 0) } sphere { center (2, 0, 0) } sphere { center (7, 0, 0) }
    -- Every kind; a count by a name; a value that does not depend on an index.
    let n = 2 let h = n / 2 triangle T for k < n { v0 (k, 0, 0) v1 (k + 1, 0, 0) v2 (0, h, 0) } -> T[0] T[1] \
        -> triangle { v0 (0, 0, 0) v1 (1, 0, 0) v2 (0, 1, 0) } triangle { v0 (1, 0, 0) v1 (2, 0, 0) v2 (0, 1, 0) }
    checkerboard F for k < 2 { y 1 - k square k + 1 colors (red, blue) } -> F[0] F[1] \
        -> checkerboard { y 1 colors (red, blue) } checkerboard { y 0 square 2 colors (red, blue) }
    -- A head may stand on several lines, with comments.
    sphere/**/B\\nfor // how often\\n i<2,\\nj< 1{center(i,j,0)} -> B[0,0] B[1,0] \
        -> sphere { center (0, 0, 0) } sphere { center (1, 0, 0) }
    sphere fore { center (0, 0, 0) } -> fore -> sphere { center (0, 0, 0) }
";

#[test]
fn a_repeated_object_equals_its_copies_written_out() {
    for [repeated, names, written] in rows(REPEATED) {
        let repeated = CAMERA.to_owned() + &repeated.replace("\\n", "\n");
        let found = sources(&repeated);
        assert_eq!(
            meaning(&found),
            meaning(&sources(&(CAMERA.to_owned() + written))),
            "{repeated}"
        );
        let scene = scene::read(&found).scene.unwrap();
        let own: Vec<String> = scene
            .objects
            .iter()
            .map(|it| match &it.name {
                Some(name) => name.replace(", ", ","),
                None => "-".to_owned(),
            })
            .collect();
        assert_eq!(own.join(" "), names, "{repeated}");
        let json = json_of(&inspect::inspect(&scene, &found.file));
        for (object, facts) in scene
            .objects
            .iter()
            .zip(json["objects"].as_array().unwrap())
        {
            let listed = facts
                .get("indices")
                .map_or(Vec::new(), |it| it.as_array().unwrap().clone());
            let listed: Vec<u32> = listed
                .iter()
                .map(|it| it.as_u64().unwrap() as u32)
                .collect();
            assert_eq!(*listed, *object.indices, "{repeated}");
        }
    }
}

#[test]
fn set_changes_every_copy_of_a_repeated_object() {
    let text = CAMERA.to_owned() + "let n = 2 sphere B for i < n { center (i, 1, 0) radius 1 }";
    for (set, before, after) in [
        ("B.radius=2", "radius 1", "radius 2"),
        ("B.radius=i + 1", "radius 1", "radius i + 1"),
        (
            "B.color=(red, blue)",
            "radius 1",
            "radius 1 color (red, blue)",
        ),
        ("n=4", "n = 2", "n = 4"),
    ] {
        let written = meaning(&sources(&text.replacen(before, after, 1)));
        assert_eq!(meaning(&sources(&text).with_sets([set])), written, "{set}");
    }
}

/// Each row has a mistake in a repeated object, and then the expected code and the texts of all
/// labels.
#[test]
fn a_mistake_in_a_repeated_object_is_reported_once() {
    let table = "
        sphere for i < 9 { center (i, 1, 0) radius 3 - i } -> out_of_range: 3 - i, for i < 9 here i = 3
        sphere for i < 9, j < 9 { center (1 / (i - j), 1, 0) } -> not_finite: /, for i < 9, j < 9 here i = 0, j = 0
        sphere for i < 9 { center (i, 1, 0) radius 0 } -> out_of_range: 0
        sphere for i < 9 { center (i, 1, 0) radus 3 } -> unknown_field: radus
        sphere for i < 0 { center (i, 1, 0) radus 3 } -> unknown_field: radus
        sphere for i < 9 { center (i, 1, x) radius x } -> unknown_name: x, x and here
        triangle for i < 9 { v0 (0, 0, 0) v1 (1, 1, i) v2 (2, 2, 8) } -> on_one_line: (2, 2, 8), (1, 1, i) the second, (0, 0, 0) the first, for i < 9 here i = 4
        sphere for i < 9 { center (i, 1, 0) radius max(1e-999, i + 1) } -> number_underflow: 1e-999, for i < 9 here i = 0
        sphere for red < 9 { center (red, 1, 0) } -> predefined_name: red
        sphere for i < 9, i < 3 { center (i, 1, 0) } -> duplicate_let: i, i first here
        let i = 2 sphere for i < 9 { center (i, 1, 0) } -> duplicate_let: i, i first here
        sphere for i < 9 { center (i, 1, 0) color (red, 2) } -> part_type: 2
        sphere for i < 9 { center (j, 1, 0) } -> unused_index: i; unknown_name: j
        sphere B for i < 9, j < { center (i, j, 0) } -> unexpected: {
        sphere B for i < 9 j < 9 { center (i, j, 0) } -> bad_repetition: j
        sphere B for { center (0, 1, 0) } -> bad_head: B for
        sphere B repeat i < 8 { center (i, 1, 0) } -> bad_repetition: repeat
        sphere B for 8 { center (0, 1, 0) } -> bad_repetition: 8
        let n = i sphere for i < 9 { center (i, 1, 0) } -> unknown_name: i
        sphere for i < 9 { center (i, 1, 0) } sphere { center (i, 1, 0) } -> unknown_name: i
    ";
    for [text, expected] in rows(table) {
        let sources = sources(&(CAMERA.to_owned() + text));
        let found: Vec<String> = scene::read(&sources)
            .diagnostics
            .iter()
            .map(|problem| {
                let labels = problem.labels.iter().enumerate().map(|(at, label)| {
                    let text = sources.text(label.span);
                    match at {
                        0 => text.to_owned(),
                        _ => format!("{text} {}", label.message),
                    }
                });
                let code = problem.code.trim_start_matches("pinhole::");
                format!("{code}: {}", labels.collect::<Vec<_>>().join(", "))
            })
            .collect();
        assert_eq!(found.join("; "), expected, "{text}");
    }
}

/// If a fix replaces a value that contains the index `i` of a repeated block, the new value must
/// contain `i`, too.
#[test]
fn fixes_in_repeated_objects_keep_their_index() {
    let fields = "
        sphere -> center | radius | color
        triangle -> centroid | normal | sides | spin | v0 | color
        box -> center | size | min | max | color | colors
        checkerboard -> y | square | colors
    ";
    let values = "(i - 2) * 1e-6 | i - 1 | i * 100 | 30 * i | i * 30deg | (i, i) | (i, 1, i) | (i - 1, i, -i) \
        | rgb(i * 300, 0, 0) | rgb(i / 9, 0.5, 1) | acos(i) | sqrt(i - 1) | 1 / i | normalize((0, 0, i)) | tan(i * 90deg) \
        | sin(i) | (red, i) | (rgb(i * 300, 0, 0), red, red) | i, 2 | i 2 | max(i)";
    let has_index = |text: &str| {
        text.split(|c: char| !c.is_alphanumeric())
            .any(|it| it == "i")
    };
    let mut fixes = 0;
    for [kind, fields] in rows(fields) {
        for (field, value) in fields
            .split(" | ")
            .flat_map(|field| values.split(" | ").map(move |it| (field, it)))
        {
            let text = format!("{CAMERA}{kind} for i < 5 {{ {field} {value} }}");
            let sources = sources(&text);
            let found = scene::read(&sources).diagnostics;
            for edit in found
                .iter()
                .flat_map(|it| &it.fixes)
                .flat_map(|fix| &fix.edits)
            {
                fixes += 1;
                let keeps = !has_index(sources.text(edit.span)) || has_index(&edit.text);
                assert!(keeps, "{text}: {}", edit.text);
            }
        }
    }
    assert!(fixes > 50, "{fixes}");
}

/// Tests three cases. A mistake after the `for` of a block does not affect the next block. A
/// repeated checkerboard causes only one warning. A `let` after a block may have the same name as
/// the block's index, even if `--set` overrides a value.
#[test]
fn a_repetition_does_not_affect_the_text_around_it() {
    for (text, set, expected) in [
        (
            "sphere for i in 5\nbox { min (0, 0, 0) max (1, 1, 1) }",
            &[][..],
            "bad_repetition",
        ),
        (
            "checkerboard for i < 9 { y -i square 1e-200 }",
            &[],
            "squares_too_small",
        ),
        (
            "sphere for i < 3 { center (i, 0, 0) }\nlet i = 5\nsphere B { center (i, 1, 0) }",
            &["B.color=red"],
            "",
        ),
    ] {
        let codes = codes(&(CAMERA.to_owned() + text), set);
        assert_eq!(codes.join(" "), expected, "{text}");
    }
}

#[test]
fn repetition_heads_are_formatted_like_values() {
    for (written, laid_out) in [
        (
            "sphere   B for   i<3,j<2*i{center(i,j,0)}",
            "sphere B for i < 3, j < 2 * i { center (i, j, 0) }\n",
        ),
        (
            "sphere for\ni\n<3 , j<(i) {}",
            "sphere for i < 3, j < (i) {}\n",
        ),
        (
            "sphere for i /* a */ < 3 {}",
            "sphere for i /* a */ < 3 {}\n",
        ),
    ] {
        assert_eq!(
            format::format(&sources(written).file).unwrap(),
            laid_out,
            "{written}"
        );
    }
}
