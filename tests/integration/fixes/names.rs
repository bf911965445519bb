//! Tests that a suggested name is valid where it is suggested. The tests misspell every name of the
//! language and of the text in many ways, in every place.

use pinhole::schema::{BLOCKS, CONSTANTS, FUNCTIONS, css, method_names};

use super::{Trial, diagnostics};
use crate::scenes::sources;

/// Places in which a value can be written; `@` stands for the value.
const PLACES: [&str; 22] = [
    "let x = @",
    "let x = -@",
    "let x = @ + 1",
    "let x = 2 * @",
    "let x = @ - 1e-266",
    "let x = (@, 1, 2)",
    "let x = (red, @)",
    "let x = (1deg + @) / @",
    "let x = sin(@)",
    "let x = max(1, @)",
    "let x = dot(vector, @)",
    "let x = rgb(@, 1, 2)",
    "sphere { center @ }",
    "sphere { center @ * 2 }",
    "sphere { center vector  radius @ }",
    "sphere { center vector  color @ }",
    "sphere { center vector  color @-1e-266 }",
    "sphere { center @  color @ }",
    "triangle { centroid vector  normal vector  spin @ }",
    "checkerboard { colors @ }",
    "sampler { per_pixel @ }",
    "sampler { method @ }",
];

const LETS: &str = "let number = 2\nlet angle = 30deg\nlet vector = (1, 2, 3)\nlet shade = red\nlet pair = (red, blue)\nlet negative = -2\nlet k1 = 7\n";

/// Returns misspellings of a name. Letters are dropped, added, doubled, swapped, changed or
/// capitalized.
fn mistyped(name: &str) -> Vec<String> {
    let mut slips = vec![
        name.to_uppercase(),
        format!("{name}x"),
        format!("x{name}"),
        name[..1].to_uppercase() + &name[1..],
    ];
    for at in 0..name.len().min(4) {
        let (before, rest) = name.split_at(at);
        let (letter, after) = rest.split_at(1);
        slips.extend([
            format!("{before}{after}"),
            format!("{before}{letter}{letter}{after}"),
            format!("{before}q{after}"),
        ]);
        if let Some(next) = after.get(..1) {
            slips.push(format!("{before}{next}{letter}{}", &after[1..]));
        }
    }
    let is_name = |slip: &String| slip.starts_with(|c: char| c.is_ascii_alphabetic());
    slips.retain(is_name);
    slips
}

fn is_meant(problem: &pinhole::diagnostic::Diagnostic) -> bool {
    let codes = ["unknown_", "no_such_target", "function_without_arguments"];
    codes.iter().any(|code| problem.code.contains(code))
}

#[test]
fn suggested_names_are_valid_where_they_are_suggested() {
    let lets = [
        "number", "angle", "vector", "shade", "pair", "negative", "k1",
    ];
    let colors = css::names().step_by(23).chain(["lime", "red"]);
    let mut names: Vec<String> = lets.into_iter().chain(colors).flat_map(mistyped).collect();
    names.extend(CONSTANTS.iter().flat_map(|(name, ..)| mistyped(name)));
    names.extend(method_names().step_by(3).flat_map(mistyped));
    names.extend(["line", "in", "ff0000", "po", "sin"].map(str::to_owned));
    // The values are calls of each function with arguments of each type, and with each number of
    // arguments.
    for function in FUNCTIONS {
        let arguments = [
            "",
            "2",
            "2, 3",
            "30deg",
            "vector",
            "vector, vector",
            "1, 2, 3",
            "red",
        ];
        let slips = mistyped(function.name).into_iter().step_by(3);
        names.extend(
            slips.flat_map(|name| arguments.map(|arguments| format!("{name}({arguments})"))),
        );
    }
    let mut trial = Trial::default();
    for name in &names {
        for place in PLACES {
            let camera = "camera { eye (0, 2, 8)  lookat (0, 1, 0) }\n";
            let text = format!("{LETS}{camera}{}\n", place.replace('@', name));
            trial.apply_fixes(&sources(&text), |problem, _| is_meant(problem));
        }
    }
    trial.finish_with_more_than(1000);
}

#[test]
fn suggested_fields_and_targets_are_valid_where_they_are_suggested() {
    let values = [
        "3",
        "1e15",
        "-1",
        "0.5",
        "30deg",
        "(0, 1, 0)",
        "(1, 1, 9)",
        "(1e300, 1, 1)",
        "red",
        "(red, blue)",
        "exact",
        "vector",
        "nothing",
        "1/0",
    ];
    let mut trial = Trial::default();
    for block in BLOCKS {
        for name in block.field_names().flat_map(mistyped) {
            for value in values {
                for (others, others_set) in [
                    ("", "near 4  fov 30deg"),
                    ("eye (0, 1, 0)", "lookat (0, 1, 0)  far 3"),
                    ("min (0, 0, 0)", "centroid (0, 0, 0)"),
                ] {
                    let is_of = |other: &str| {
                        let words = other
                            .split([' ', '(', ',', ')'])
                            .filter(|word| word.starts_with(|c: char| c.is_ascii_alphabetic()));
                        words
                            .filter(|word| *word != "deg")
                            .all(|word| block.field(word).is_some())
                    };
                    let others: String = [others, others_set]
                        .into_iter()
                        .filter(|other| is_of(other))
                        .map(|other| format!("{other}  "))
                        .collect();
                    let camera = if block.name == "camera" {
                        ""
                    } else {
                        "camera { eye (0, 2, 8)  lookat (0, 1, 0) }\n"
                    };
                    let text = format!(
                        "{LETS}{} {{ {others}{name} {value} }}\n{camera}",
                        block.name
                    );
                    trial.apply_fixes(&sources(&text), |problem, _| is_meant(problem));
                }
            }
        }
    }
    let scene = format!(
        "{LETS}camera {{ eye (0, 2, 8)  lookat (0, 1, 0) }}\nsphere Ball {{ center vector }}\nbox Bale {{ center vector }}\n"
    );
    for target in [
        "Bal.radius",
        "Bal.size",
        "bale.center",
        "Ballx.radius",
        "camra.eye",
        "sampler2.seed",
        "eye",
        "roll",
        "numbr",
        "EYE",
        "k2",
        "negativ",
    ] {
        // Lists other than (1, 1, 9) are left out, because they may contradict the scene: for
        // example, an eye at (0, 1, 0) would be at the `lookat` point.
        let values = values
            .into_iter()
            .filter(|value| !value.starts_with('(') || *value == "(1, 1, 9)");
        for value in values {
            let sources = sources(&scene).with_sets([format!("{target}={value}")]);
            trial.apply_fixes(&sources, |problem, _| is_meant(problem));
        }
    }
    // `Bal` is near the sphere's name `Ball`, but a sphere has no field `size`, so this is an
    // error.
    assert!(!diagnostics(&sources(&scene).with_sets(["Bal.size=3"])).is_empty());
    trial.finish_with_more_than(500);
}
