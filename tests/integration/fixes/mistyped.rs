//! Slips made by a program in scenes that are right: each fix of a problem does away with it, and makes no new error.

use std::{fs, ops::Range};

use pinhole::{
    diagnostic::Diagnostic,
    syntax::tokens::{Lexer, Token, TokenKind},
};

use super::{diagnostics, type_in_fixes};
use crate::scenes::{examples, scenes, sources};

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

/// The tokens of a scene, without the comments.
fn tokens(text: &str) -> Vec<Token> {
    let mut lexer = Lexer::new(text, 0);
    let tokens = std::iter::repeat_with(|| lexer.token());
    let tokens = tokens.take_while(|token| token.kind != TokenKind::End);
    let is_comment = |token: &Token| token.kind == TokenKind::Comment;
    tokens.filter(|token| !is_comment(token)).collect()
}

/// Types in the fixes of the problems that are meant, of a text with a slip in place of a piece.
fn slip(
    text: &str,
    piece: &Range<usize>,
    slip: &str,
    is_meant: impl Fn(&Diagnostic) -> bool,
    complaints: &mut Vec<String>,
) -> usize {
    let wrong = format!("{}{slip}{}", &text[..piece.start], &text[piece.end..]);
    let name = format!("{slip} for {} at {piece:?}", &text[piece.clone()]);
    type_in_fixes(&name, &sources(&wrong), is_meant, complaints)
}

/// One token is taken away, written twice, replaced by another one, or followed by it.
#[test]
fn every_fix_of_a_slip_in_syntax_helps() {
    let others = "radius 2 , = ( ) { } let red - * deg # \" ;".split(' ');
    let mut others = others.cycle();
    // A field without a value is found when the scene is made.
    let is_meant = |d: &Diagnostic| d.is_of_syntax && d.code != "pinhole::missing_value";
    let (mut fixes, mut complaints) = (0, Vec::new());
    let mut examples = examples();
    examples.retain(|text| text.len() <= 3000 && diagnostics(&sources(text)).is_empty());
    for text in &examples {
        for Token { start, end, .. } in tokens(text).into_iter().step_by(3) {
            let (token, other) = (&text[start..end], others.next().unwrap());
            let twice = format!("{token} {token}");
            for wrong in ["", &twice, other, &format!("{token} {other}")] {
                fixes += slip(text, &(start..end), wrong, is_meant, &mut complaints);
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(fixes > 500, "{fixes} fixes");
}

/// A word, a number or a list becomes another one.
#[test]
fn every_fix_of_a_slip_in_meaning_helps() {
    let named = |name: &str| {
        scenes("examples")
            .into_iter()
            .find(|path| path.ends_with(name))
    };
    let examples = ["language_tour.scn", "near_and_far.scn", "straight_down.scn"].map(named);
    let texts = examples.map(|path| fs::read_to_string(path.unwrap()).unwrap());
    let (mut fixes, mut complaints) = (0, Vec::new());
    for text in texts.iter().map(String::as_str).chain([SCENE]) {
        let mut at = 0;
        for token in tokens(text) {
            let mut piece = token.start.max(at)..token.end;
            let close = text[token.end..].find(['(', ')']).unwrap_or_default() + token.end;
            if text[token.start..].starts_with('(') && text[close..].starts_with(')') {
                piece.end = close + 1;
            }
            let written = text.get(piece.clone()).unwrap_or_default();
            at = at.max(piece.end);
            for wrong in slips_in_meaning(written) {
                let syntax = format!("{}{wrong}{}", &text[..piece.start], &text[piece.end..]);
                if !diagnostics(&sources(&syntax))
                    .iter()
                    .any(|d| d.is_of_syntax)
                {
                    fixes += slip(text, &piece, &wrong, Diagnostic::is_error, &mut complaints);
                }
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(fixes > 500, "{fixes} fixes");
}

/// What could stand in place of a word, a number or an innermost list.
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
