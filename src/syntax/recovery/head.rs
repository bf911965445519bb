//! Finds mistakes in the indices of an object, such as `for i < 8, j < i`, with tables of patterns.
//!
//! In: the text from `for` to the `{` of the object. Out: the place of the first mistake, the
//! message, and the corrected text if the correction is certain.

use std::ops::Range;

use crate::syntax::tokens::{is_name_char, numeric_part};

/// First mistake in the indices of an object, such as `for i <= 7`.
pub(super) struct HeadSlip {
    /// Byte range of the mistake in the text that starts with `for`.
    pub at: Range<usize>,
    /// The message; empty if no pattern describes the mistake.
    pub said: &'static str,
    /// The help, for use if there is no correction.
    pub help: String,
    /// The corrected text from `for` on, if the correction is certain.
    pub right: Option<String>,
}

/// Row of a table of patterns for mistakes in `for i < 8`: pattern, message, correction, and help
/// for the case that the correction is not certain.
///
/// In a pattern, `I` and `W` stand for names, `N` and `M` for values, and `O` for an optional name
/// before another name. `$` is the end of the text, `|` separates alternatives, and the mistake is
/// between `«` and `»`. In the other texts, `{I}`, `{W}`, `{N}` and `{M}` stand for the matched
/// texts.
type HeadPattern = [&'static str; 4];

// Messages and help texts that several patterns for mistakes in `for i < 8` share.
const FROM_ZERO: &str = "an index begins at 0 by itself";
const NO_RANGE: &str = "an index has a count, and no range";
const EITHER: &str = "write `for {I} < {N}`, or `for {I} < {N+1}` if {N} is one of its values";
const TO: &str = "write `for {I} < {N-M+1}`, and `{I} + {M}` for `{I}` in the values";
const UP_TO: &str = "write `for {I} < {N-M}`, and `{I} + {M}` for `{I}` in the values";
const LACKS_COUNT: &str =
    "write `for {I} < 8` with the number of its values, or `for k < {I}` if `{I}` is that";
const STEP: &str = "write `for {I} < {N/M}`, and `{M} * {I}` for `{I}` in the values";
/// Mark in place of the correction in a [`HeadPattern`]. It says that the object's name is to be
/// moved before the `for`.
const NAME_FIRST: &str = "^";

/// Patterns of one index with its count, such as `i < 8`. The first one is correct, and the others
/// have mistakes.
#[rustfmt::skip]
const INDICES: [HeadPattern; 27] = [
    ["I < N", "", "{I} < {N}", ""],
    ["« 0 <= » I < N", FROM_ZERO, "{I} < {N}", ""],
    ["« 0 < » I < N", FROM_ZERO, "", "write `for {I} < {N} - 1`, and `{I} + 1` for `{I}` in the values"],
    ["« M <= » I < N", FROM_ZERO, "", UP_TO],
    ["I « <=|≤ » N", "an index ends before its count, and is never equal to it", "{I} < {N+1}", ""],
    ["I « in|=|:=|from range ( N ) »", NO_RANGE, "{I} < {N}", ""],
    ["I « in|=|:=|from range ( 0 , N ) »", NO_RANGE, "{I} < {N}", ""],
    ["I « in|=|:=|from range ( M , N ) »", NO_RANGE, "", UP_TO],
    ["I « in|=|:=|from range ( 0 , N , M ) »", NO_RANGE, "", STEP],
    ["I « in|=|:=|from 0 ..<|.. N step|by M »", NO_RANGE, "", STEP],
    ["I « in|=|:=|from 0 ..=|...|to|: N »", NO_RANGE, "", EITHER],
    ["I « in|=|:=|from 0 ..<|.. N »", NO_RANGE, "{I} < {N}", ""],
    ["I « in|=|:=|from [|( 0 ..|to|:|, N ]|) »", NO_RANGE, "", EITHER],
    ["I « in|=|:=|from M ..=|...|to|: N »", NO_RANGE, "", TO],
    ["I « in|=|:=|from M ..<|..|until N »", NO_RANGE, "", UP_TO],
    ["« O I = 0 ;|, » I < N", FROM_ZERO, "{I} < {N}", ""],
    ["« O I = 0 ;|, » I <=|≤ N", FROM_ZERO, "{I} < {N+1}", ""],
    ["« O I = M ;|, » I < N", FROM_ZERO, "", UP_TO],
    ["« O I = M ;|, » I <=|≤ N", FROM_ZERO, "", TO],
    ["« I = 0 » , W < N", "an index lacks its count", "", LACKS_COUNT],
    ["I « = 0 , N , M »", NO_RANGE, "", STEP],
    ["I « = 0 , N »", NO_RANGE, "", EITHER],
    ["« W » I < N", "an index is a name alone", "{I} < {N}", ""],
    ["I « in|==|=|:=|:|to|until » N", "`<` stands between an index and its count", "", "write `for {I} < {N}`"],
    ["« I » $", "an index lacks its count", "", LACKS_COUNT],
    ["« W » , I < N", "each index has its own count", "", "write `for {W} < {N}, {I} < {N}`, if both count to {N}"],
    ["« N » $", "an index lacks its name", "", "write `for i < {N}`, and use `i` in the values"],
];

const COMMA: &str = "a comma separates two indices";

/// Patterns, with and without mistakes, of the text after an index and its count, such as the comma
/// after `i < 8` in `for i < 8, j < i`.
#[rustfmt::skip]
const BEHIND: [HeadPattern; 9] = [
    ["« , » $", "no comma stands behind the last index", "", ""],
    [",", "", ", ", ""],
    ["« ; I ++|+=1 »", "an index counts by 1 by itself", "", ""],
    ["« ; ++ I »", "an index counts by 1 by itself", "", ""],
    ["« ; I += 1 »", "an index counts by 1 by itself", "", ""],
    ["« ;|and|&&|&|for|x|× »", COMMA, ", ", ""],
    ["« step|by M »", "an index counts by 1", "", STEP],
    ["« :|do|then|=>|, » $", "nothing stands between a count and the `{`", "", ""],
    ["« W » $", "the name of an object stands before the `for`", NAME_FIRST, ""],
];

/// Finds the first mistake in `head`, the indices of an object, such as `for i <= 7`. The text
/// starts with `for`, or with another word that was written in its place, such as `foreach`.
/// `has_name` says whether the object has a name before the `for`.
pub(super) fn slip(head: &str, has_name: bool) -> HeadSlip {
    let mut found = Captures::default();
    let keyword = name_length(head);
    let behind =
        |text: &str, at: usize| text.len() - text.get(at..).unwrap_or_default().trim_start().len();
    let (mut text, mut at, mut slip) = (head, keyword, None);
    let open = behind(text, at);
    let close = open + group_length(text.get(open..).unwrap_or_default());
    let is_in_parentheses = close > open && behind(text, close) == text.len();
    if is_in_parentheses {
        (text, at) = (text.get(..close - 1).unwrap_or_default(), open + 1);
    }
    let (mut is_sure, mut is_index, mut name) = (true, true, "");
    let mut right = String::from("for ");
    while is_index || behind(text, at) < text.len() {
        let mut find = |rows: &'static [HeadPattern]| {
            rows.iter()
                .find_map(|row| Some((row, found.read(row[0], text, at)?)))
        };
        let mut row = find(if is_index { &INDICES } else { &BEHIND });
        if row.is_none() && !is_index && find(&INDICES[..1]).is_some() {
            let start = behind(text, at);
            row = Some((&["", COMMA, ", ", ""], (at, start..start + found.i.len())));
        }
        let Some(([_, said, written, help], (end, under))) = row else {
            slip.get_or_insert((behind(text, at)..text.len(), "", String::new()));
            is_sure = false;
            break;
        };
        let mut help = found.filled(help);
        match *written {
            NAME_FIRST if has_name => help = found.filled("take `{W}` away"),
            NAME_FIRST => name = found.w,
            _ => right += &found.filled(written),
        }
        is_sure &= help.is_empty();
        if !said.is_empty() {
            slip.get_or_insert((under, said, help));
        }
        (at, is_index) = (end, *written == ", ");
    }
    if is_in_parentheses {
        let said = "indices stand without parentheses";
        slip.get_or_insert((open..open + 1, said, String::new()));
    }
    let (mut at, mut said, help) = slip.unwrap_or((0..head.len(), "", String::new()));
    if head.get(..keyword) != Some("for") {
        (at, said) = (0..keyword, "an object is repeated by `for`");
    }
    let right = is_sure.then(|| format!("{name} {right}").trim_start().to_owned());
    HeadSlip {
        at,
        said,
        help,
        right,
    }
}

/// Texts that a pattern ([`HeadPattern`]) matched: the names `I` and `W`, and the values `N` and
/// `M`. A text is empty if the pattern does not contain its letter.
#[derive(Default)]
struct Captures<'t> {
    i: &'t str,
    n: &'t str,
    m: &'t str,
    w: &'t str,
}

impl<'t> Captures<'t> {
    /// Matches `row`, a pattern such as `« 0 <= » I < N` ([`HeadPattern`]), with the text from the
    /// offset `from` on. Returns the offset where the match ends, and the range of the text between
    /// `«` and `»`, which is the mistake to report. Returns `None` if the text does not match.
    fn read(&mut self, row: &str, text: &'t str, from: usize) -> Option<(usize, Range<usize>)> {
        let (mut at, mut under, mut index) = (from, from..from, "");
        for item in row.split(' ') {
            let rest = text.get(at..)?.trim_start();
            let start = text.len() - rest.len();
            let (slot, length) = match item {
                "«" => {
                    under.start = start;
                    continue;
                }
                "»" => {
                    under.end = at;
                    continue;
                }
                "$" if rest.is_empty() => continue,
                "$" => return None,
                "O" => {
                    let length = name_length(rest);
                    let other = rest.get(length..)?.trim_start();
                    at = if name_length(other) > 0 {
                        start + length
                    } else {
                        start
                    };
                    continue;
                }
                "I" => (Some(&mut self.i), name_length(rest)),
                "W" => (Some(&mut self.w), name_length(rest)),
                "N" => (Some(&mut self.n), value_length(rest)),
                "M" => (Some(&mut self.m), value_length(rest)),
                _ => {
                    let is_it = |word: &&str| {
                        let behind = rest.strip_prefix(word);
                        let is_word = word.ends_with(|c: char| c.is_alphanumeric());
                        let goes_on = |it: &str| it.bytes().next().is_some_and(is_name_char);
                        behind.is_some_and(|it| !is_word || !goes_on(it))
                    };
                    (None, item.split('|').find(is_it)?.len())
                }
            };
            if length == 0 {
                return None;
            }
            if let Some(slot) = slot {
                *slot = rest.get(..length)?;
                // Both occurrences of `I` in a pattern must be the same name.
                if item == "I" && !index.is_empty() && index != *slot {
                    return None;
                }
                index = if item == "I" { *slot } else { index };
            }
            at = start + length;
        }
        Some((at, under))
    }

    /// Replaces placeholders such as `{I}` and `{N+1}` in `text` by the matched texts. Sums,
    /// differences and quotients in placeholders are computed if the matched texts are numbers.
    fn filled(&self, text: &str) -> String {
        let [n, m] = [self.n, self.m].map(|text| text.parse::<u32>().ok());
        let or = |number: Option<u32>, text: String| number.map_or(text, |it| it.to_string());
        let both = n.zip(m);
        let less = or(
            both.and_then(|(n, m)| n.checked_sub(m)),
            format!("{} - {}", self.n, self.m),
        );
        let plus = |text: &str| {
            or(
                text.parse::<u32>().ok().and_then(|n| n.checked_add(1)),
                format!("{text} + 1"),
            )
        };
        let of = both.filter(|(_, m)| *m > 0).map(|(n, m)| n.div_ceil(m));
        text.replace("{I}", self.i)
            .replace("{N}", self.n)
            .replace("{M}", self.m)
            .replace("{W}", self.w)
            .replace("{N+1}", &plus(self.n))
            .replace("{N-M}", &less)
            .replace("{N-M+1}", &plus(&less))
            .replace("{N/M}", &or(of, format!("{} / {}", self.n, self.m)))
    }
}

/// Returns the length, in bytes, of the name at the start of a text; 0 if there is none.
fn name_length(text: &str) -> usize {
    let is_name = !text.starts_with(|c: char| c.is_ascii_digit());
    let length = text.bytes().take_while(|&byte| is_name_char(byte)).count();
    if is_name { length } else { 0 }
}

/// Returns the length, in bytes, of the group in parentheses at the start of a text; 0 if there is
/// none.
fn group_length(text: &str) -> usize {
    if !text.starts_with('(') {
        return 0;
    }
    let mut depth = 0_usize;
    for (at, sign) in text.bytes().enumerate() {
        match sign {
            b'(' => depth += 1,
            b')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return if sign == b')' { at + 1 } else { 0 };
        }
    }
    0
}

/// Returns the length, in bytes, of the value at the start of a text: operands with operators
/// between them.
fn value_length(text: &str) -> usize {
    let mut end = 0;
    loop {
        let behind = text.get(end..).unwrap_or_default().trim_start();
        let operand = match (end, behind.strip_prefix(['+', '-', '*', '/'])) {
            (0, _) => behind,
            (_, Some(operand)) => operand,
            (_, None) => return end,
        };
        let operand = operand.trim_start();
        let operand = operand.strip_prefix('-').unwrap_or(operand);
        // In the range `0..8`, the number is `0` and not `0.`.
        let number = numeric_part(operand);
        let is_range = operand
            .get(number.len()..)
            .is_some_and(|rest| rest.starts_with('.'));
        let number = if is_range {
            number.trim_end_matches('.')
        } else {
            number
        };
        let name = name_length(operand);
        let called = name + group_length(operand.get(name..).unwrap_or_default());
        let is_value = |text: &str| !text.contains(['<', '=', ';']);
        let called = if operand.get(name..called).is_some_and(is_value) {
            called
        } else {
            name
        };
        let length = number.len().max(called);
        if length == 0 {
            return end;
        }
        end = text.len() - operand.len() + length;
    }
}
