//! Which fixes a mistake gets, each with its title and what it makes of the text.

use pinhole::scene::SMALLEST;

use super::{of_scene, offered};
use crate::{
    diagnostics::{codes, found},
    table::{lines, list, rows},
};

/// Each row has a text, and the title and the result of every fix of its first mistake. A camera and a board stand below.
const TABLE: &str = r##"
    -- Fields are added where the author would.
    camera {\n  d 2 // far\n} -> add `eye` and `lookat` -> camera {\n  d 2 // far\n  eye (0, 2, 8)\n  lookat (0, 1, 0)\n} -> add `eye` and `direction` -> camera {\n  d 2 // far\n  eye (0, 2, 8)\n  direction (0, 0, -1)\n}
    box {} -> add `center` -> box { center (0, 1, 0) } -> add `min` and `max` -> box { min (-1, 0, -1)  max (1, 1, 1) }
    -- Of a map: what up is was not said.
    camera {\n  eye (0, 9, 0)\n  direction (0, -1, 0)\n} -> add `up (0, 0, -1)` -> camera {\n  eye (0, 9, 0)\n  direction (0, -1, 0)\n  up (0, 0, -1)\n}
    sphere { // ball\n} -> add `center` -> sphere { // ball\n  center (0, 1, 0)\n}
    \n  sphere { radius 2\n  } -> add `center` -> \n  sphere { radius 2\n    center (0, 1, 0)\n  }
    sphere {\n\tradius 2\n} -> add `center` -> sphere {\n\tradius 2\n\tcenter (0, 1, 0)\n}
    sphere {\n    radius 2\n} -> add `center` -> sphere {\n    radius 2\n    center (0, 1, 0)\n}
    box { max (-5, -5, -5) } -> add `min` -> box { max (-5, -5, -5)  min (-6, -6, -6) }
    box { min 2 * (1, 0.3, -4) } -> add `max` -> box { min 2 * (1, 0.3, -4)  max (3, 1.6, -7) }
    -- 1 is lost beside it.
    box { max (1e20, 0, 0) } -> add `min` -> box { max (1e20, 0, 0)  min (-1, -1, -1) }

    -- Of two, either one is kept, if it is enough by itself.
    camera {\n  eye (0, 1, 5)\n  lookat (0, 1, 0)\n  direction (0, 0, -1)\n} -> keep `lookat`, remove `direction` -> camera {\n  eye (0, 1, 5)\n  lookat (0, 1, 0)\n} -> keep `direction`, remove `lookat` -> camera {\n  eye (0, 1, 5)\n  direction (0, 0, -1)\n}
    box { center (0, 1, 0)  min (1, 1, 1) } -> keep `center`, remove `min` -> box { center (0, 1, 0) }
    box { center (0, 1, 0)  size (1, 1, 1)  min (0, 0, 0) } -> keep `center` and `size`, remove `min` -> box { center (0, 1, 0)  size (1, 1, 1) }
    sphere { center (0, 1, 0)  radius 1  radius 2 } -> keep the first `radius`, remove the second -> sphere { center (0, 1, 0)  radius 1 } -> keep the second `radius`, remove the first -> sphere { center (0, 1, 0)  radius 2 }
    -- A comment goes with what it is about.
    sphere {\n  center (0, 1, 0)\n  radius 1 // once\n  radius 2 // again\n} -> keep the first `radius`, remove the second, with its comment -> sphere {\n  center (0, 1, 0)\n  radius 1 // once\n} -> keep the second `radius`, remove the first, with its comment -> sphere {\n  center (0, 1, 0)\n  radius 2 // again\n}
    box {\n  min (0, 0, 0)  // low\n  max (1, 1, 1)  // high\n  center (0, 1, 0)\n} -> keep `min` and `max`, remove `center` -> box {\n  min (0, 0, 0)  // low\n  max (1, 1, 1)  // high\n} -> keep `center`, remove `min` and `max`, with its comment -> box {\n  center (0, 1, 0)\n}
    let a = (0, +1, 0) -> write `1` -> let a = (0, 1, 0)
    let a: 4 -> write `let a = 4` -> let a = 4
    let a : 4 -> write `let a = 4` -> let a = 4
    let a = (2 + ) -> remove this `+` -> let a = (2)
    box { min (1, 2, 3)  max (-1, 0, -1) } -> put the corners in order -> box { min (-1, 0, -1)  max (1, 2, 3) }
    -- They would be as wrong the other way round.
    box { min (0, 0, 0)  max (1, 0, 1) }

    -- Angles: 45 radians are more than half a turn, and so are 200 degrees.
    camera { eye (0, 1, 5)  lookat (0, 1, 0)  fov 45 } -> write `45deg` -> camera { eye (0, 1, 5)  lookat (0, 1, 0)  fov 45deg }
    camera { eye (0, 1, 5)  lookat (0, 1, 0)  fov 1 } -> write `1deg` -> camera { eye (0, 1, 5)  lookat (0, 1, 0)  fov 1deg } -> write `1rad` -> camera { eye (0, 1, 5)  lookat (0, 1, 0)  fov 1rad }
    camera { eye (0, 1, 5)  lookat (0, 1, 0)  fov 200 }
    let a = 30degrees -> write `30deg` -> let a = 30deg
    let a = 2 m -> write `2` -> let a = 2

    -- What is left open is closed, and an opening sign is the right one.
    sphere Round ( center (0, 1, 0) ) -> write `sphere Round {` -> sphere Round { center (0, 1, 0) }
    sphere { center (0, 1, 0 radius 2 } -> write `)` before `radius` -> sphere { center (0, 1, 0) radius 2 }
    sphere { center (0, 1, 0)  radius (2 } -> write `)` before `}` -> sphere { center (0, 1, 0)  radius (2) }
    sphere Big Ball { center (0, 1, 0) } -> write `sphere Big_Ball {` -> sphere Big_Ball { center (0, 1, 0) }
    sphere my-ball { center (0, 1, 0) } -> write `sphere my_ball {` -> sphere my_ball { center (0, 1, 0) }
    Tail = sphere { center (0, 1, 0) } -> write `sphere Tail {` -> sphere Tail { center (0, 1, 0) }
    let Head = sphere { center (0, 1, 0) } -> write `sphere Head {` -> sphere Head { center (0, 1, 0) }
    -- The numbers are what a field was to have.
    sphere (0, 1, 0) { radius 2 }
    -- Comments of other languages.
    # a\n  ## b\nlet c = 1 -> write `//` -> // a\n  // b\nlet c = 1
    let a = 1 -- big -> write `//` -> let a = 1 // big

    -- A function is called, and all else multiplied, but not where the product would be no angle, or of nothing.
    let b = 2pi -> write `2 * pi` -> let b = 2 * pi
    let h = 2 let b = 3h -> write `3 * h` -> let h = 2 let b = 3 * h
    camera { eye (0, 1, 5)  lookat (0, 1, 0)  fov 2pi }
    let b = 2what
    let a = sin 30deg -> write `sin(30deg)` -> let a = sin(30deg)
    let a = sqrt 2 -> write `sqrt(2)` -> let a = sqrt(2)
    let b = 2 let a = b 2 -> write `b * 2` -> let b = 2 let a = b * 2
    let b = 2 let a = 2 b -> write `2 * b` -> let b = 2 let a = 2 * b
    let b = 2 camera { eye (0, 1, 5)  lookat (0, 1, 0)  d sqrt 2 } -> write `sqrt(2)` -> let b = 2 camera { eye (0, 1, 5)  lookat (0, 1, 0)  d sqrt(2) }
    let b = 2 camera { eye (0, 1, 5)  lookat (0, 1, 0)  d pi 2 } -> write `pi * 2` -> let b = 2 camera { eye (0, 1, 5)  lookat (0, 1, 0)  d pi * 2 }
    let b = 2 camera { eye (0, 1, 5)  lookat (0, 1, 0)  d 2 b } -> write `2 * b` -> let b = 2 camera { eye (0, 1, 5)  lookat (0, 1, 0)  d 2 * b }

    -- Operands are made to go together, as what is wanted decides; no comment is lost.
    let v = (0, 1, 2) let a = v + 2 -> write `(2, 2, 2)` -> let v = (0, 1, 2) let a = v + (2, 2, 2)
    let v = (0, 1, 2) let a = 2 - v -> write `(2, 2, 2)` -> let v = (0, 1, 2) let a = (2, 2, 2) - v
    let v = (0, 1, 2) let a = 1 + 2 + v -> write `(1 + 2, 1 + 2, 1 + 2)` -> let v = (0, 1, 2) let a = (1 + 2, 1 + 2, 1 + 2) + v
    let v = (0, 1, 2) let w = v let a = v + w - 2 * 3 -> write `(2 * 3, 2 * 3, 2 * 3)` -> let v = (0, 1, 2) let w = v let a = v + w - (2 * 3, 2 * 3, 2 * 3)
    let a = 30deg + 2 -> write `2deg` -> let a = 30deg + 2deg -> write `2rad` -> let a = 30deg + 2rad
    let v = (0, 1, 2) let a = v + // two\n2 -> write `(2, 2, 2)` -> let v = (0, 1, 2) let a = v + // two\n(2, 2, 2)
    let v = (0, 1, 2) let a = v * v
    let v = (0, 1, 2) let a = v * /* dot */ v
    let v = (0, 1, 2) sphere { center v  radius v + 2 }
    let a = red + blue
    sphere { center (1, 2) } -> write `(1, 2, 2)` -> sphere { center (1, 2, 2) }
    -- A message shortens what is long; an edit does not.
    camera { eye (0, 1, 5)  lookat (0, 1, 0)  roll 1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9 + 10 + 11 + 12 + 13 + 14 + 15 } -> write `(1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9 + 10 + 11 + 12 + 13 + 14 + 15) * 1deg` -> camera { eye (0, 1, 5)  lookat (0, 1, 0)  roll (1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9 + 10 + 11 + 12 + 13 + 14 + 15) * 1deg } -> write `(1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9 + 10 + 11 + 12 + 13 + 14 + 15) * 1rad` -> camera { eye (0, 1, 5)  lookat (0, 1, 0)  roll (1 + 2 + 3 + 4 + 5 + 6 + 7 + 8 + 9 + 10 + 11 + 12 + 13 + 14 + 15) * 1rad }
"##;

#[test]
fn a_mistake_gets_these_fixes() {
    for row in lines(TABLE) {
        let expected = row[1..].chunks(2);
        let expected = expected.map(|fix| (fix[0].to_owned(), of_scene(fix[1])));
        let expected: Vec<_> = expected.collect();
        assert_eq!(offered(&of_scene(row[0])), expected, "{}", row[0]);
    }
}

/// What is at the end of a text is open to its end, and line ends are those of the text.
#[test]
fn a_text_with_nothing_below_is_mended() {
    let before = of_scene("");
    let table = r"
        let v = (1, 2, 3 // far\n -> write `)` at the end -> let v = (1, 2, 3) // far\n
        sphere { center (0, 1, 0)\n  radius 2 // big\n -> close the block of `sphere` -> sphere { center (0, 1, 0)\n  radius 2 // big\n}\n
        sphere { center (0, 1, 0)\n  radius 2 // big -> close the block of `sphere` -> sphere { center (0, 1, 0)\n  radius 2 // big\n}
        sphere { center (0, 1, 0)\n  radius 2 /* very\n big */\n -> close the block of `sphere` -> sphere { center (0, 1, 0)\n  radius 2\n} /* very\n big */\n
        -- Where a comment should have ended, nobody can tell.
        /* far\naway\n
    ";
    for row in lines(table) {
        let fixes = offered(&format!("{before}{}", row[0]));
        let expected = row[1..].chunks(2);
        let expected = expected.map(|fix| (fix[0].to_owned(), format!("{before}{}", fix[1])));
        assert_eq!(fixes, expected.collect::<Vec<_>>(), "{}", row[0]);
    }
    let table = r"
        sphere { center (0, 1, 0) }\r\n -> sphere { center (0, 1, 0) }\r\ncamera { eye (0, 2, 8)  lookat (0, 1, 0) }\r\n
        camera {\r\n  eye (0, 9, 0)\r\n  direction (0, -1, 0)\r\n}\r\ncheckerboard {} -> camera {\r\n  eye (0, 9, 0)\r\n  direction (0, -1, 0)\r\n  up (0, 0, -1)\r\n}\r\ncheckerboard {}
    ";
    for [text, fixed] in rows(table) {
        assert_eq!(offered(text)[0].1, fixed);
    }
    for text in ["", "// A scene.\n", "\u{feff}"] {
        assert_eq!(offered(text)[0].1, format!("{text}{SMALLEST}"));
        assert_eq!(codes(&offered(text)[0].1, &[]), [""; 0]);
    }
}

#[test]
fn what_cannot_be_mended_gets_help() {
    for [text, code, help] in rows("
        sphere { center (0, 6, 1)  (0, 6, 0)  radius 2 } -> missing_field_name -> write the name of the field that `(0, 6, 0)` is for before it
        sphere { center (0, 6, 1)  color #f00  (0, 6, 0) } -> missing_field_name -> write the name of the field that `(0, 6, 0)` is for before it
        sphere { center (0, 6, 1)  red  radius 2 } -> missing_field_name -> write `color red`
        let a = (0, 6, 1)  (0, 6, 0) -> missing_operator -> write an operator between them, or take one of them away
        -- A name that is near, but whose value would be the next mistake, is told and not offered.
        camera { eye (0, 0, 9)  lookat (0, 0, 0)  eye_x 3 } -> unknown_field -> did you mean
        camera { eye (0, 0, 9)  lookat (0, 0, 0)  fov 40deg  angle 90deg } -> unknown_field -> did you mean
        camera { eye (0, 0, 9)  lookat (0, 0, 0)  d 2  view_distance 2 } -> unknown_field -> did you mean
        camera { eye (0, 0, 9)  lookat (0, 0, 0)  view_distance -2 } -> unknown_field -> did you mean
    ") {
        let found = found(&of_scene(text), &[]);
        let found = found.iter().find(|d| d.code == format!("pinhole::{code}")).expect(text);
        let said = found.help.as_deref().unwrap_or_default();
        assert!(said.starts_with(help) && found.fixes.is_empty(), "{text}: {found:?}");
    }
}

/// A difference is one, whatever it looks like.
#[test]
fn what_only_looks_like_a_comment_is_none() {
    let table = r##"
        let a = 1 let b = 2 -- a
        let a = 1 --2
        let a = 2 -- pi
        let a = 2\n-- sqrt(4)
        let a = (#fff, # f00\n)
        let a = "# no comment"
        sphere { radus #ff }
        sphere { fill #orange }
    "##;
    for text in list(table) {
        let codes = codes(&of_scene(text), &[]);
        assert!(!codes.contains(&"comment_sign".to_owned()), "{text}");
    }
    assert_eq!(codes(&of_scene("let a = 1"), &["a=--2"]), [""; 0]);
}
