//! Slips made by a program in scenes that are right: each fix of a problem of meaning does away with it, and makes no new error.

use std::fs;

use pinhole::diagnostic::Diagnostic;

use super::{diagnostics, sources, type_in_fixes};

/// A scene with what the examples lack.
const SCENE: &str = "\
camera { eye (0, 2, 8)  lookat (0, 1, 0)  hfov 60deg  near 1  far 100 }
sampler { method sobol  total 1_000_000 }
image { background rgb(10, 20, 30) }
let a = (0, 1, 0)
let k = 30deg
triangle A { v0 (0, 0, 0)  v1 (1, 0, 0)  v2 (0, 1, 0)  color red }
triangle B { centroid a + (0, 1, 0)  normal (sin(k), 0, 1)  sides (2, 2, 1)  spin 2 * k }
box C { min (-1, 0, -1)  max (1, 1, 1) }
box D { center (0, 1, 0)  size (1, 2, 3) }
checkerboard { square 1  colors (red, white) }
";

/// The words, numbers and lists of a scene without comments in them, each with its place.
fn pieces(text: &str) -> Vec<(usize, &str)> {
    let mut pieces = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.');
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if is_word(first) {
            rest.find(|c| !is_word(c)).unwrap_or(rest.len())
        } else if first == '(' {
            // The innermost lists.
            let end = rest[1..].find(['(', ')']).map(|end| end + 1);
            match end.filter(|&end| rest[end..].starts_with(')')) {
                Some(end) => end + 1,
                None => 1,
            }
        } else {
            first.len_utf8()
        };
        if is_word(first) || (first == '(' && length > 1) {
            pieces.push((at, &rest[..length]));
        }
        at += length;
    }
    pieces
}

/// What could stand in place of a piece by a slip.
fn slips(piece: &str) -> Vec<String> {
    let fixed = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
    if let Some(inner) = piece.strip_prefix('(').and_then(|p| p.strip_suffix(')')) {
        let parts: Vec<&str> = inner.split(", ").collect();
        let but_last = parts[..parts.len() - 1].join(", ");
        let reversed: Vec<&str> = parts.iter().rev().copied().collect();
        let mut slips: Vec<String> = fixed(&["3", "(0, 0, 0)", "(-5, -7, -9)", "30deg", "red"]);
        slips.extend([
            format!("({but_last})"),
            format!("({inner}, 2)"),
            format!("({})", reversed.join(", ")),
        ]);
        slips
    } else if piece.starts_with(|c: char| c.is_ascii_digit()) {
        let mut slips: Vec<String> = fixed(&["0", "0.5", "(1, 2, 3)", "(1, 1)", "pi/2", "red"]);
        let number = piece.trim_end_matches("deg");
        slips.push(format!("-{piece}"));
        slips.push(match number == piece {
            true => format!("{piece}deg"),
            false => number.to_owned(),
        });
        slips
    } else {
        let dropped = format!("{}{}", &piece[..1], piece.get(2..).unwrap_or_default());
        vec![
            dropped,
            format!("{piece}_x"),
            format!("view{piece}"),
            "nothing".to_owned(),
        ]
    }
}

#[test]
fn every_fix_of_a_slip_helps() {
    let example = |name: &str| {
        let path = format!("{}/examples/{name}", env!("CARGO_MANIFEST_DIR"));
        fs::read_to_string(path).unwrap()
    };
    let texts = [
        SCENE.to_owned(),
        example("language_tour.scn"),
        example("near_and_far.scn"),
        example("straight_down.scn"),
    ];
    let (mut fixes, mut complaints) = (0, Vec::new());
    for text in &texts {
        for (at, piece) in pieces(text) {
            for slip in slips(piece) {
                let wrong = format!("{}{slip}{}", &text[..at], &text[at + piece.len()..]);
                let wrong = sources(&wrong, &[]);
                if diagnostics(&wrong).iter().any(|found| found.is_of_syntax) {
                    continue;
                }
                let name = format!("{slip} for {piece}");
                fixes += type_in_fixes(&name, &wrong, Diagnostic::is_error, &mut complaints);
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(fixes > 500, "{fixes} fixes");
}
