//! Words of the language by which slips are told apart.
//!
//! What they mean is no matter of the syntax. But `let a = 2 pi`, with `sphere {` in the next line, can be told from
//! `let a = 2 sphere`, with `B {` there, by nothing else; and so can `sin 30deg` from `a 30deg`. A test holds them
//! against the tables of the scene.

/// The words that blocks start with.
const KINDS: &[&str] = &[
    "image",
    "camera",
    "sampler",
    "sphere",
    "triangle",
    "box",
    "checkerboard",
];

const FUNCTIONS: &[&str] = &[
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sqrt",
    "abs",
    "min",
    "max",
    "length",
    "dot",
    "cross",
    "normalize",
    "rgb",
];

/// Whether a block can start with a word.
pub fn is_kind(word: &str) -> bool {
    KINDS.contains(&word)
}

/// Whether a word is a function's name.
pub fn is_function(word: &str) -> bool {
    FUNCTIONS.contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::schema;

    #[test]
    fn the_words_are_those_of_the_tables() {
        assert!(schema::block_names().eq(KINDS.iter().copied()));
        let mut functions: Vec<&str> = schema::FUNCTIONS.iter().map(|row| row.name).collect();
        let mut words = FUNCTIONS.to_vec();
        functions.sort_unstable();
        words.sort_unstable();
        assert_eq!(words, functions);
    }
}
