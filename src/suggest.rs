//! The nearest name.
//!
//! In: what was written and what could stand there. Out: the one that was probably meant, if any is near.

use std::cell::Cell;

/// How many names may still be compared: a text with as many mistakes as names would take the time of all pairs.
#[derive(Debug)]
pub struct Budget(Cell<usize>);

impl Default for Budget {
    fn default() -> Self {
        Self(Cell::new(500_000))
    }
}

impl Budget {
    /// Whether so many names may be compared; if so, they count as compared.
    pub fn spend(&self, names: usize) -> bool {
        let left = self.0.get().checked_sub(names);
        self.0.set(left.unwrap_or(self.0.get()));
        left.is_some()
    }
}

/// The nearest of the candidates, if it is near: the same but for upper and lower case, or about one slip for every three
/// letters. Of equally near ones the first.
pub fn nearest<'c>(
    written: &str,
    candidates: impl IntoIterator<Item = &'c str>,
) -> Option<&'c str> {
    // A name that nobody would mistype so: comparing it would only take long.
    const LONGEST: usize = 64;
    let letters: Vec<char> = written.chars().take(LONGEST + 1).collect();
    if letters.is_empty() || letters.len() > LONGEST {
        return None;
    }
    let letters: Vec<char> = letters.iter().map(char::to_ascii_lowercase).collect();
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        let length = candidate.chars().count();
        let allowed = (letters.len().max(length) / 3).max(1);
        // Half of a name of two letters is no longer the same name.
        let allowed = allowed.min(letters.len().min(length) / 2);
        let allowed = best.map_or(allowed, |(least, _)| allowed.min(least.saturating_sub(1)));
        let best_already = best.is_some_and(|(least, _)| least == 0);
        if best_already || letters.len().abs_diff(length) > allowed {
            continue;
        }
        let other: Vec<char> = candidate
            .chars()
            .map(|letter| letter.to_ascii_lowercase())
            .collect();
        let slips = distance(&letters, &other);
        if slips <= allowed {
            best = Some((slips, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// The words that a name is made of: `near_clip` and `nearClip` are near and clip.
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

/// How many letters must be put in, taken out or changed, or neighbours swapped (the optimal string alignment distance;
/// Damerau, A technique for computer detection and correction of spelling errors, 1964).
fn distance(from: &[char], to: &[char]) -> usize {
    let mut above: Vec<usize> = Vec::new();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    let mut previous = None;
    for &a in from {
        let two_above = std::mem::replace(&mut above, std::mem::take(&mut row));
        let first = above.first().map_or(0, |d| d + 1);
        row.push(first);
        let mut left = first;
        let mut before = None;
        for (column, &b) in to.iter().enumerate() {
            let diagonal = above.get(column).copied().unwrap_or(usize::MAX);
            let up = above.get(column + 1).copied().unwrap_or(usize::MAX);
            let mut least = (left + 1).min(up + 1).min(diagonal + usize::from(a != b));
            if before == Some(a) && previous == Some(b) && column > 0 {
                let swap = two_above.get(column - 1).copied().unwrap_or(usize::MAX - 1);
                least = least.min(swap + 1);
            }
            row.push(least);
            left = least;
            before = Some(b);
        }
        previous = Some(a);
    }
    row.last().copied().unwrap_or(0)
}

/// Names in a sentence: `a`, `a and b`, `a, b and c`.
pub fn list<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    join(names, "and")
}

/// Names to choose from in a sentence: `a`, `a or b`, `a, b or c`.
pub fn choice<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    join(names, "or")
}

fn join<'n>(names: impl IntoIterator<Item = &'n str>, word: &str) -> String {
    let mut names: Vec<&str> = names.into_iter().collect();
    let Some(last) = names.pop() else {
        return String::new();
    };
    if names.is_empty() {
        return last.to_owned();
    }
    format!("{} {word} {last}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        let of = |a: &str, b: &str| {
            let letters = |s: &str| s.chars().collect::<Vec<_>>();
            distance(&letters(a), &letters(b))
        };
        assert_eq!(of("", "abc"), 3);
        assert_eq!(of("radus", "radius"), 1);
        assert_eq!(of("cneter", "center"), 1);
        assert_eq!(of("kitten", "sitting"), 3);
        assert_eq!(of("centre", "center"), 1);
    }

    #[test]
    fn near_names_only() {
        let fields = ["center", "radius", "color", "d", "up"];
        assert_eq!(nearest("radus", fields), Some("radius"));
        assert_eq!(nearest("colour", fields), Some("color"));
        assert_eq!(nearest("centre", fields), Some("center"));
        assert_eq!(nearest("UP", fields), Some("up"));
        assert_eq!(nearest("D", fields), Some("d"));
        assert_eq!(nearest("x", fields), None);
        assert_eq!(nearest("transparency", fields), None);
        assert_eq!(nearest("", fields), None);
    }

    #[test]
    fn lists() {
        assert_eq!(list(["a"]), "a");
        assert_eq!(list(["a", "b"]), "a and b");
        assert_eq!(choice(["a", "b", "c"]), "a, b or c");
    }
}
