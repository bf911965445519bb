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
                    complaints.push(format!("{name}: `{}`: new {new_said:?}", fix.title));
                }
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
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
                "keep `center`, remove `min` and `max`, with their comments",
                &block("  center (0, 1, 0)\n"),
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
            "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n  let r = 2 // why\n  sphere {\n    center (0, 1, 0)  radius r\n  }",
        )],
    );
}

#[test]
fn an_unclosed_comment_ends_in_its_line() {
    let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\r\n";
    let fixes = |before: &str, after: &[(&str, &str)]| {
        let after: Vec<(&str, String)> = after
            .iter()
            .map(|(title, after)| (*title, format!("{camera}{after}")))
            .collect();
        let after: Vec<_> = after.iter().map(|(t, text)| (*t, text.as_str())).collect();
        offers(&format!("{camera}{before}"), &after);
    };
    let (close, line) = ("close it in its line", "begin it with `//`");
    fixes(
        "checkerboard {} /* a \r\nsphere { center (0, 1, 0) }\r\n",
        &[
            (
                close,
                "checkerboard {} /* a */ \r\nsphere { center (0, 1, 0) }\r\n",
            ),
            (
                line,
                "checkerboard {} // a \r\nsphere { center (0, 1, 0) }\r\n",
            ),
        ],
    );
    // The block was opened before it, and closed in it.
    fixes(
        "sphere { center (0, 1, 0) /* round }\n",
        &[(close, "sphere { center (0, 1, 0) /* round */ }\n")],
    );
    // What follows may be a part of it, and is no scene.
    fixes("checkerboard {} /* a\r\nb\r\nc\r\n", &[]);
    fixes("checkerboard {} /* a\nsphere { radus 2 }\n", &[]);
}

#[test]
fn carriage_returns_alone_become_ends_of_lines() {
    let camera = "camera { eye (0, 1, 5)  lookat (0, 1, 0) }";
    let title = "end these lines as text files do";
    offers(
        &format!("// A floor.\r{camera}\rcheckerboard {{}} // flat\r"),
        &[(
            title,
            &format!("// A floor.\n{camera}\ncheckerboard {{}} // flat\n"),
        )],
    );
    offers(
        &format!("{camera}\r\n// A\r// floor.\r\ncheckerboard {{}}\r\n"),
        &[(
            title,
            &format!("{camera}\r\n// A\r\n// floor.\r\ncheckerboard {{}}\r\n"),
        )],
    );
    // One mistake is one report: what the comment took is not missed.
    let found = diagnostics(&sources(
        &format!("// A floor.\r{camera}\rcheckerboard {{}}\r"),
        &[],
    ));
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!(found[0].code, "pinhole::odd_space");
    // Outside of comments they are white space as any.
    let text = format!("{camera}\rcheckerboard {{}}\r");
    assert_eq!(diagnostics(&sources(&text, &[])), []);
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
    // The numbers are what a field was to have.
    assert!(offered(&format!("sphere (0, 1, 0) {{ radius 2 }}{end}")).is_empty());
}

/// Behind some text stands what makes a scene of it.
fn of_scene(text: &str) -> String {
    format!("{text}\ncheckerboard {{}}\ncamera {{ eye (0, 1, 5)  lookat (0, 1, 0) }}\n")
}

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
fn operands_that_do_not_go_together_are_made_to() {
    let of = |value: &str, rest: &str| {
        of_scene(&format!(
            "let v = (0, 1, 2)\nlet w = (1, 2, 3)\n{rest}{value}"
        ))
    };
    let fixed = |rest: &str, before: &str, after: &[&str]| {
        let offered = offered(&of(before, rest));
        let texts: Vec<&str> = offered.iter().map(|(_, text)| text.as_str()).collect();
        let after: Vec<String> = after.iter().map(|after| of(after, rest)).collect();
        assert_eq!(texts, after);
    };
    let value = "let a = ";
    fixed(value, "v + 2", &["v + (2, 2, 2)", "v * 2"]);
    fixed(value, "2 - v", &["(2, 2, 2) - v", "2 * v"]);
    fixed(value, "1 + 2 + v", &["(1 + 2, 1 + 2, 1 + 2) + v"]);
    fixed(value, "v + w - 2 * 3", &["v + w - (2 * 3, 2 * 3, 2 * 3)"]);
    fixed(value, "v * w", &["dot(v, w)", "cross(v, w)"]);
    fixed(value, "2 * v * w", &["dot(2 * v, w)", "cross(2 * v, w)"]);
    fixed(value, "1 / w", &["1 / length(w)"]);
    fixed(value, "1 / (0 * w)", &[]);
    fixed(value, "30deg * 2deg", &["30deg * (2deg / 1deg)"]);
    fixed(value, "3 / 2deg", &["3 / (2deg / 1deg)"]);
    fixed(
        value,
        "v + // two\n2",
        &["v + // two\n(2, 2, 2)", "v * // two\n2"],
    );
    // What is wanted decides.
    let center = "sphere { center (0, 1, 0)  radius length(w) }\nsphere { center ";
    fixed(center, "v * w }", &["cross(v, w) }"]);
    fixed("sphere { center v  radius ", "v * w }", &["dot(v, w) }"]);
    fixed("sphere { center v  radius ", "v + 2 }", &[]);
    fixed("let a = ", "red + blue", &[]);
    // No comment is lost.
    fixed("let a = ", "v * /* dot */ w", &[]);
    assert!(offered(&of_scene("let a = 3 /* squared */ ^ 2")).is_empty());
}

#[test]
fn powers_parts_and_degrees_are_written_out() {
    for (before, after) in [
        ("let r = 2 let a = r^2", "let r = 2 let a = r * r"),
        (
            "let r = 2 let a = 3 - -r ** 3",
            "let r = 2 let a = 3 - -r * r * r",
        ),
        ("let a = 6 / (1 + 2) ^ 2", "let a = 6 / ((1 + 2) * (1 + 2))"),
        (
            "let a = 2 * sqrt(3)^2 / 4",
            "let a = 2 * sqrt(3) * sqrt(3) / 4",
        ),
        ("let a = (1, 2)", "let a = (1, 2, 1)"),
        (
            "let a = 10deg sphere { center (0, 1, 0)  radius a + 2deg }",
            "let a = 10deg sphere { center (0, 1, 0)  radius (a + 2deg) / 1deg }",
        ),
        (
            "let a = 10deg sphere { center (0, 1, 0)  radius a }",
            "let a = 10deg sphere { center (0, 1, 0)  radius a / 1deg }",
        ),
    ] {
        let offered = offered(&of_scene(before));
        let texts: Vec<&str> = offered.iter().map(|(_, text)| text.as_str()).collect();
        assert_eq!(texts, [of_scene(after)]);
    }
    for before in [
        "let a = 2^0.5",
        "let a = 30deg^2",
        "let a = 2^3^2",
        "let a = 2^-1",
    ] {
        let offered = offered(&of_scene(before));
        assert!(
            offered.iter().all(|(title, _)| title.contains("2 * 2 * 2")),
            "{before}"
        );
    }
}

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
            "sphere (0, 1, 0) { center (0, 1, 0) }",
            "write `sphere {`",
            "sphere { center (0, 1, 0) }",
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
    let said = |text: &str| {
        let found = diagnostics(&sources(&of_scene(text), &[]));
        let found = found
            .into_iter()
            .find(|d| d.code == "pinhole::missing_operator");
        let found = found.unwrap();
        assert!(found.fixes.is_empty());
        found.help.unwrap()
    };
    let name = "write the name of the field that `(0, 6, 0)` is for before it";
    assert_eq!(
        said("sphere { center (0, 6, 1)  (0, 6, 0)  radius 2 }"),
        name
    );
    assert_eq!(
        said("sphere { center (0, 6, 1)  color #f00  (0, 6, 0) }"),
        name
    );
    assert_eq!(
        said("sphere { center (0, 6, 1)  red  radius 2 }"),
        "write the name of the field that `red` is for before it"
    );
    assert_eq!(
        said("let a = (0, 6, 1)  (0, 6, 0)"),
        "write `+` or `-` between them, or take one of them away"
    );
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
