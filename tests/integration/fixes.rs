//! What diagnostics offer to do: over every fixture of `tests/diagnostics`, each fix does away with its problem and makes no
//! new error.

use std::{collections::BTreeMap, fs, path::Path};

use pinhole::{
    diagnostic::{Diagnostic, Fix, apply},
    scene,
    source::{Source, SourceId, Sources},
};

fn sources(text: &str, sets: &[String]) -> Sources {
    Sources::new(Source::from_text("a.scn", text)).with_sets(sets)
}

fn diagnostics(sources: &Sources) -> Vec<Diagnostic> {
    scene::read(sources).diagnostics
}

/// The texts with a fix.
fn fixed(sources: &Sources, fix: &Fix) -> Sources {
    let sets = (0_u32..).zip(&sources.sets);
    let sets: Vec<String> = sets
        .map(|(index, set)| apply(fix, SourceId::Set(index), set.text()))
        .collect();
    let file = apply(fix, SourceId::File, sources.file.text());
    Sources::new(Source::from_text("a.scn", file)).with_sets(sets)
}

/// How often each thing is said.
fn counted(diagnostics: &[Diagnostic]) -> BTreeMap<(String, String), usize> {
    let mut counted = BTreeMap::new();
    for diagnostic in diagnostics {
        let said = (diagnostic.code.clone(), diagnostic.message.clone());
        *counted.entry(said).or_default() += 1;
    }
    counted
}

/// What a fix leaves to do, and why that is right: the fixture, the fix, and the code of the error that appears.
const EXCEPTIONS: &[(&str, &str, &str)] = &[
    // What the comment took is read again; the other fix leaves it in the comment.
    ("unclosed_comment", "begin it with `//`", "missing_field"),
    ("unclosed_comment", "begin it with `//`", "unknown_field"),
];

/// Every fixture that is a text, with its name and the arguments that it gives.
fn fixtures() -> Vec<(String, Sources)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/diagnostics");
    let mut fixtures = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if let Ok(text) = fs::read_to_string(&path) {
            let sets = text.lines().filter_map(|l| l.strip_prefix("// --set "));
            let sets: Vec<String> = sets.map(str::to_owned).collect();
            fixtures.push((name, sources(&text, &sets)));
        }
    }
    fixtures
}

#[test]
fn every_fix_helps() {
    let (mut fixes, mut complaints) = (0, Vec::new());
    let mut used = Vec::new();
    for (name, before_sources) in fixtures() {
        let before = diagnostics(&before_sources);
        let said_before = counted(&before);
        for diagnostic in &before {
            for fix in &diagnostic.fixes {
                fixes += 1;
                let after_sources = fixed(&before_sources, fix);
                let after = diagnostics(&after_sources);
                let said = counted(&after);
                let this = (diagnostic.code.clone(), diagnostic.message.clone());
                let text = after_sources.file.text();
                if said.get(&this) >= said_before.get(&this) {
                    complaints.push(format!("{name}: {} stays: {this:?}\n{text}", fix.title));
                }
                for new in after.iter().filter(|d| d.is_error()) {
                    let new_said = (new.code.clone(), new.message.clone());
                    if said.get(&new_said) <= said_before.get(&new_said) {
                        continue;
                    }
                    let code = new.code.trim_start_matches("pinhole::");
                    let exception = (name.as_str(), fix.title.as_str(), code);
                    if let Some(exception) = EXCEPTIONS.iter().find(|e| **e == exception) {
                        used.push(exception);
                    } else {
                        complaints.push(format!("{name}: `{}`: new {new_said:?}", fix.title));
                    }
                }
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(EXCEPTIONS.iter().all(|exception| used.contains(&exception)));
    assert!(fixes > 100, "{fixes} fixes");
}

/// The edits lie in the text, between characters, and do not overlap, whatever the text.
#[test]
fn edits_fit_into_any_text() {
    let mut edits = 0;
    for (_, whole) in fixtures() {
        let text = whole.file.text();
        for (end, _) in text.char_indices().step_by(5) {
            let sources = sources(&text[..end], &[]);
            for diagnostic in diagnostics(&sources) {
                for fix in &diagnostic.fixes {
                    let mut at = 0;
                    for edit in &fix.edits {
                        let range = edit.span.range();
                        assert!(range.start >= at, "{fix:?} in {:?}", &text[..end]);
                        assert!(text[..end].get(range.clone()).is_some(), "{fix:?}");
                        at = range.end;
                        edits += 1;
                    }
                }
            }
        }
    }
    assert!(edits > 1000, "{edits} edits");
}

/// The titles of the fixes for the first problem of a text, each with what it makes of the text.
fn offered(text: &str) -> Vec<(String, String)> {
    let sources = sources(text, &[]);
    let first = diagnostics(&sources).into_iter().next().unwrap();
    let fixes = first.fixes.into_iter();
    fixes
        .map(|fix| {
            let text = apply(&fix, SourceId::File, text);
            (fix.title, text)
        })
        .collect()
}

fn offers(text: &str, expected: &[(&str, &str)]) {
    let offered = offered(text);
    let offered: Vec<_> = offered
        .iter()
        .map(|(title, text)| (title.as_str(), text.as_str()))
        .collect();
    assert_eq!(offered, expected);
}

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

/// A message shortens what is long; an edit does not.
#[test]
fn edits_keep_all_that_is_written() {
    let sum = "1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9 + 10 + 11 + 12 + 13 + 14 + 15";
    let text = |roll: &str| {
        format!("checkerboard {{}} camera {{ eye (0, 1, 5)  lookat (0, 1, 0)  roll {roll} }}")
    };
    let fixes = offered(&text(sum));
    assert_eq!(fixes[0].1, text(&format!("({sum}) * 1deg")));
    assert_eq!(fixes[1].1, text(&format!("({sum}) * 1rad")));
    // Nothing that would be cut is offered.
    assert!(offered(&text(&format!("sqrt({sum}, 2)"))).is_empty());
    assert!(offered(&text("atan2(0.25)")).is_empty());
}

#[test]
fn a_function_is_called_and_all_else_multiplied() {
    for (written, meant) in [
        ("sin 30deg", "sin(30deg)"),
        ("sqrt 2", "sqrt(2)"),
        ("b 2", "b * 2"),
        ("pi 2", "pi * 2"),
        ("2 b", "2 * b"),
    ] {
        let title = format!("write `{meant}`");
        let text = |value: &str| {
            format!(
                "let b = 2\nlet a = {value}\ncheckerboard {{}} camera {{ eye (0, 1, 5)  lookat (0, 1, 0) }}"
            )
        };
        offers(&text(written), &[(&title, &text(meant))]);
        if written == "sin 30deg" {
            continue;
        }
        let text = |value: &str| {
            format!(
                "let b = 2\ncamera {{ eye (0, 1, 5)  lookat (0, 1, 0)  d {value} }} checkerboard {{}}"
            )
        };
        offers(&text(written), &[(&title, &text(meant))]);
    }
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

#[test]
fn a_definition_moves_before_its_block() {
    offers(
        "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n  sphere {\n    let r = 2 // why\n    center (0, 1, 0)  radius r\n  }",
        &[(
            "move it before the block",
            "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n  let r = 2\n  sphere {\n    // why\n    center (0, 1, 0)  radius r\n  }",
        )],
    );
}

#[test]
fn what_an_unclosed_comment_took_may_stay_in_it() {
    offers(
        "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\r\ncheckerboard {} /* a\r\nb\r\nc\r\n",
        &[
            (
                "close it at the end of the text",
                "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\r\ncheckerboard {} /* a\r\nb\r\nc */\r\n",
            ),
            (
                "begin it with `//`",
                "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\r\ncheckerboard {} // a\r\nb\r\nc\r\n",
            ),
        ],
    );
    offers(
        "let a = 1 /* a\n",
        &[("begin it with `//`", "let a = 1 // a\n")],
    );
}

#[test]
fn a_corner_lies_on_the_right_side_of_the_other() {
    let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n";
    for (given, title, added) in [
        ("max (-5, -5, -5)", "add `min`", "min (-6, -6, -6)"),
        ("min 2 * (1, 0.3, -4)", "add `max`", "max (3, 1.6, -7)"),
        // 1 is lost beside it.
        ("max (1e20, 0, 0)", "add `min`", "min (-1, 0, -1)"),
    ] {
        offers(
            &format!("{camera}box {{ {given} }}"),
            &[(title, &format!("{camera}box {{ {given}  {added} }}"))],
        );
    }
    offers(
        &format!("{camera}box {{ min (1, 2, 3)  max (-1, 0, -1) }}"),
        &[(
            "swap `min` and `max`",
            &format!("{camera}box {{ min (-1, 0, -1)  max (1, 2, 3) }}"),
        )],
    );
    // They would be as wrong the other way round.
    assert!(offered(&format!("{camera}box {{ min (0, 0, 0)  max (1, 0, 1) }}")).is_empty());
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
    for indent in ["\t", "    "] {
        let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n";
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
fn what_a_help_says_is_done() {
    let end = "\ncamera { eye (0, 1, 5)  lookat (0, 1, 0) }\ncheckerboard {}";
    for (text, title, fixed) in [
        (
            "sphere Big Ball { center (0, 1, 0) }",
            "write `sphere Big {`",
            "sphere Big { center (0, 1, 0) }",
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
        ("let a = 1_000_", "write `1000`", "let a = 1000"),
        ("let a = 1__000", "write `1000`", "let a = 1000"),
        ("let a = 2 m", "write `2`", "let a = 2"),
        ("let a = 30degrees", "write `30deg`", "let a = 30deg"),
        (
            "let a = sqrt(1 - 2)",
            "write `sqrt(abs(1 - 2))`",
            "let a = sqrt(abs(1 - 2))",
        ),
        (
            "let a = asin(2)",
            "write `asin(max(-1, min(1, 2)))`",
            "let a = asin(max(-1, min(1, 2)))",
        ),
        (
            "let c = 2 let a = c (1)",
            "write `c * (…)`",
            "let c = 2 let a = c * (1)",
        ),
        (
            "let ball = (0, 1, 0) sphere { centerball }",
            "write `center ball`",
            "let ball = (0, 1, 0) sphere { center ball }",
        ),
    ] {
        offers(
            &format!("{text}{end}"),
            &[(title, &format!("{fixed}{end}"))],
        );
    }
    // Numbers may be what a field was to have.
    assert!(offered(&format!("sphere (0, 1, 0) {{ radius 2 }}{end}")).is_empty());
}
