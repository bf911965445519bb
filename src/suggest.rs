//! The nearest name.
//!
//! In: what was written and what could stand there. Out: the name that was probably meant, if one
//! is near.

use std::cell::Cell;

use strsim::osa_distance;

/// Number of comparisons that are left. Without a limit, a text with as many mistakes as names
/// would take time for all pairs.
#[derive(Debug)]
pub struct ComparisonBudget(Cell<usize>);

impl Default for ComparisonBudget {
    fn default() -> Self {
        Self(Cell::new(500_000))
    }
}

impl ComparisonBudget {
    /// Reserves comparisons with a number of names. Returns whether as many are left.
    pub fn spend(&self, names: usize) -> bool {
        let left = self.0.get().checked_sub(names);
        self.0.set(left.unwrap_or(self.0.get()));
        left.is_some()
    }
}

/// Returns the nearest of the candidates, if it is near: equal except for case, or about one slip
/// for every three letters. Of equally near ones, returns the first.
pub fn nearest<'c>(
    written: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<&'c str> {
    nearest_of(written, &mut candidates.into_iter())
}

/// Returns the nearest name of a value or a function, as [`nearest`] does. A name of one or two
/// letters is seldom a slip, so only its case may differ.
pub fn nearest_name<'c>(
    written: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<&'c str> {
    let mut candidates = candidates.into_iter();
    match written.len() {
        0..=2 => candidates.find(|candidate| candidate.eq_ignore_ascii_case(written)),
        _ => nearest_of(written, &mut candidates),
    }
}

/// Returns whether `near`, the nearest of the candidates, is nearer to what was written than every
/// other. Returns false if the digits differ, as that is another name, or if separate words do not
/// have the letters of the name.
pub fn is_only_near<'c>(
    written: &str,
    near: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> bool {
    let written = written.to_ascii_lowercase();
    let slips = |name: &str| osa_distance(&written, &name.to_ascii_lowercase());
    let least = slips(near);
    let letters = |name: &str| name.replace(|c: char| !c.is_ascii_alphanumeric(), "");
    let digits = |name: &str| name.replace(|c: char| !c.is_ascii_digit(), "");
    let near_letters = letters(near).to_ascii_lowercase();
    // The rest may be the value, without a space before it.
    let is_longer = written.starts_with(near) && written.len() >= near.len() + 3;
    if is_longer
        || digits(&written) != digits(near)
        || (written.contains(char::is_whitespace) && letters(&written) != near_letters)
    {
        return false;
    }
    let mut candidates = candidates.into_iter();
    least == 0 || candidates.all(|other| other == near || slips(other) > least)
}

/// Finds the nearest candidate. A function that is not generic, so that it is compiled once.
fn nearest_of<'c>(written: &str, candidates: &mut dyn Iterator<Item = &'c str>) -> Option<&'c str> {
    // Maximum length of a name, in characters: a longer one is no slip, and would take long to
    // compare.
    const LONGEST: usize = 64;
    let length = written.chars().take(LONGEST + 1).count();
    if length == 0 || length > LONGEST {
        return None;
    }
    let written = written.to_ascii_lowercase();
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let other = candidate.chars().count();
        // Half of a name of two letters is no longer the same name.
        let allowed = (length.max(other) / 3).max(1).min(length.min(other) / 2);
        if length.abs_diff(other) > allowed || best.is_some_and(|(least, _)| least == 0) {
            continue;
        }
        let slips = osa_distance(&written, &candidate.to_ascii_lowercase());
        if slips <= allowed && best.is_none_or(|(least, _)| slips < least) {
            best = Some((slips, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Returns whether a name is one of some words, except for case and `_`: `lookAt` and `look_at` are
/// one word.
pub fn is_among(written: &str, words: &str) -> bool {
    fn letters(word: &str) -> impl Iterator<Item = u8> {
        let letters = word.bytes().filter(|byte| *byte != b'_');
        letters.map(|byte| byte.to_ascii_lowercase())
    }
    let mut words = words.split_whitespace();
    words.any(|word| letters(word).eq(letters(written)))
}

/// Returns the words of a name: `near_clip` and `nearClip` both consist of near and clip.
pub fn words(name: &str) -> Vec<&str> {
    let mut words = Vec::new();
    for part in name.split('_') {
        let mut start = 0;
        let capitals = part
            .char_indices()
            .filter(|(_, letter)| letter.is_ascii_uppercase());
        for (at, _) in capitals.skip_while(|(at, _)| *at == 0) {
            words.push(part.get(start..at).unwrap_or_default());
            start = at;
        }
        words.push(part.get(start..).unwrap_or_default());
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Returns names as part of a sentence: `a`, `a and b`, `a, b and c`.
pub fn list<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    join(names.into_iter().collect(), "and")
}

/// Returns alternatives as part of a sentence: `a`, `a or b`, `a, b or c`.
pub fn choice<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    join(names.into_iter().collect(), "or")
}

fn join(mut names: Vec<&str>, word: &str) -> String {
    let Some(last) = names.pop() else {
        return String::new();
    };
    if names.is_empty() {
        return last.to_owned();
    }
    format!("{} {word} {last}", names.join(", "))
}
