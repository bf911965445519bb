//! Suggests similar names for misspelt ones.
//!
//! In: the written name, and candidates. Out: the candidate that was probably meant, if one is
//! similar enough.

use std::cell::Cell;

use strsim::osa_distance;

/// Remaining number of comparisons between misspelt names and known ones. When it is used up, no
/// further names are suggested. Without a limit, each misspelt name of a text would be compared
/// with each known name, and the time would grow with the square of the text's length.
#[derive(Debug)]
pub struct ComparisonBudget(Cell<usize>);

impl Default for ComparisonBudget {
    fn default() -> Self {
        Self(Cell::new(500_000))
    }
}

impl ComparisonBudget {
    /// Subtracts `names` comparisons from the remaining number. Returns `false`, and subtracts
    /// nothing, if fewer comparisons remain.
    pub fn spend(&self, names: usize) -> bool {
        let left = self.0.get().checked_sub(names);
        self.0.set(left.unwrap_or(self.0.get()));
        left.is_some()
    }
}

/// Returns the candidate that is most similar to `written`, or the first of several equally similar
/// ones. A candidate is similar if it is equal except for case, or if it differs by at most about
/// one typing error per three letters. Typing errors are counted as in the optimal string alignment
/// distance. Returns `None` if no candidate is similar.
pub fn nearest<'c>(
    written: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<&'c str> {
    nearest_of(written, &mut candidates.into_iter())
}

/// Returns the name of a value or a function that is most similar to `written`, as [`nearest`]
/// does. If `written` has at most two letters, returns only a name that is equal except for case,
/// because short names are seldom mistyped. Returns `None` if no name is found.
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

/// Returns whether `written` surely means `near`, the nearest candidate: no other candidate may be
/// equally near. Also returns `false` if
///
/// - the digits of the two names differ, because names such as `a1` and `a2` are different names
///   rather than misspellings;
/// - `written` has several words whose letters are not exactly those of `near`;
/// - `written` is `near` followed by three or more letters.
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
    // Letters after the name may be a value that was joined to it, as in `colorred`. The name alone
    // is then not what was meant.
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

/// Finds the nearest candidate. Returns `None` if no candidate is similar. Unlike [`nearest`], this
/// function is not generic, so that it is compiled only once.
fn nearest_of<'c>(written: &str, candidates: &mut dyn Iterator<Item = &'c str>) -> Option<&'c str> {
    // Maximum length, in characters, of a name that is compared. A longer text is not a mistyped
    // name, and comparing it would take long.
    const LONGEST: usize = 64;
    let length = written.chars().take(LONGEST + 1).count();
    if length == 0 || length > LONGEST {
        return None;
    }
    let written = written.to_ascii_lowercase();
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let other = candidate.chars().count();
        // The number of typing errors allowed is a third of the longer name's length, but at least
        // one, and at most half of the shorter name's length.
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

/// Returns whether `written` is one of the words in `words`, which white space separates. Case and
/// `_` are ignored: `lookAt` and `look_at` are equal.
pub fn is_among(written: &str, words: &str) -> bool {
    fn letters(word: &str) -> impl Iterator<Item = u8> {
        let letters = word.bytes().filter(|byte| *byte != b'_');
        letters.map(|byte| byte.to_ascii_lowercase())
    }
    let mut words = words.split_whitespace();
    words.any(|word| letters(word).eq(letters(written)))
}

/// Splits a name into words, at each `_` and before each capital letter: `near_clip` into `near`
/// and `clip`, and `nearClip` into `near` and `Clip`.
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

/// Formats names as part of a sentence: `a`, `a and b`, `a, b and c`.
pub fn list<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    join(names.into_iter().collect(), "and")
}

/// Formats alternatives as part of a sentence: `a`, `a or b`, `a, b or c`.
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
