//! Puts mistakes into correct scenes in systematic ways, and applies the fixes that are offered.
//! Each fix must remove the diagnostic that offers it, and must cause no new error.

use std::ops::Range;

use pinhole::syntax::tokens::{Lexer, TokenKind};

use super::{Trial, diagnostics};
use crate::scenes::{examples, sources};

/// A scene with those parts of the language that the examples do not use.
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

/// Returns the ranges of a scene's tokens, except comments.
fn tokens(text: &str) -> Vec<Range<usize>> {
    let mut lexer = Lexer::new(text, 0);
    let tokens = std::iter::repeat_with(|| lexer.token());
    let tokens = tokens.take_while(|token| token.kind != TokenKind::End);
    let tokens = tokens.filter(|token| token.kind != TokenKind::Comment);
    tokens.map(|token| token.start..token.end).collect()
}

/// In each tested text, one token is missing, doubled or replaced, or another token follows it.
#[test]
fn fixes_of_syntax_slips_remove_their_problem_and_add_no_error() {
    let others = "radius 2 , = ( ) { } let red - * deg # \" ;".split(' ');
    let mut others = others.cycle();
    let mut trial = Trial::default();
    let mut examples = examples();
    examples.retain(|text| text.len() <= 3000 && diagnostics(&sources(text)).is_empty());
    for text in &examples {
        for Range { start, end } in tokens(text).into_iter().step_by(3) {
            let (token, other) = (&text[start..end], others.next().unwrap());
            let twice = format!("{token} {token}");
            for slip in ["", &twice, other, &format!("{token} {other}")] {
                let wrong = format!("{}{slip}{}", &text[..start], &text[end..]);
                // A missing value is also a syntax problem, but the translation to a scene reports
                // it, not the parser. It is not tested here.
                trial.apply_fixes(&sources(&wrong), |d, _| {
                    d.is_of_syntax && d.code != "pinhole::missing_value"
                });
            }
        }
    }
    trial.finish_with_more_than(500);
}

/// In each tested text, one word, number or list is replaced by another one. A list that contains
/// lists is not replaced as a whole.
#[test]
fn fixes_of_semantic_slips_remove_their_problem_and_add_no_error() {
    let mut trial = Trial::default();
    for text in [
        include_str!("../../../examples/language_tour.scn"),
        include_str!("../../../examples/near_and_far.scn"),
        include_str!("../../../examples/straight_down.scn"),
        SCENE,
    ] {
        let mut end = 0;
        for mut piece in tokens(text) {
            if piece.start < end {
                continue;
            }
            let rest = &text[piece.end..];
            let close = rest
                .find(['(', ')'])
                .filter(|&at| rest[at..].starts_with(')'));
            if let (true, Some(close)) = (text[piece.start..].starts_with('('), close) {
                piece.end += close + 1;
            }
            end = piece.end;
            for slip in slips_in_meaning(&text[piece.clone()]) {
                let wrong = format!("{}{slip}{}", &text[..piece.start], &text[end..]);
                trial.apply_fixes(&sources(&wrong), |d, found| {
                    d.is_error() && !found.iter().any(|d| d.is_of_syntax)
                });
            }
        }
    }
    trial.finish_with_more_than(500);
}

/// Returns wrong replacements of `piece`, which is a word, a number or a list without inner lists.
fn slips_in_meaning(piece: &str) -> Vec<String> {
    let (mut slips, fixed) = match piece.chars().next() {
        Some('(') if piece.len() > 1 => {
            let mut parts: Vec<&str> = piece[1..piece.len() - 1].split(", ").collect();
            let more = format!("({}, 2)", parts.join(", "));
            let fewer = format!("({})", parts[..parts.len() - 1].join(", "));
            parts.reverse();
            let reversed = format!("({})", parts.join(", "));
            (
                vec![more, fewer, reversed],
                "3|(0, 0, 0)|(-5, -7, -9)|30deg|red",
            )
        }
        Some('0'..='9') => {
            let number = piece.trim_end_matches("deg");
            let unit = if number == piece { "deg" } else { "" };
            let slips = vec![format!("-{piece}"), format!("{number}{unit}")];
            (slips, "0|0.5|(1, 2, 3)|(1, 1)|pi/2|red")
        }
        Some('a'..='z' | 'A'..='Z' | '_') => {
            let dropped = piece[..1].to_owned() + piece.get(2..).unwrap_or_default();
            (
                vec![dropped, format!("{piece}_x"), format!("view{piece}")],
                "nothing",
            )
        }
        _ => return Vec::new(),
    };
    slips.extend(fixed.split('|').map(str::to_owned));
    slips
}
