//! Tests with long tables of cases: every run tries a sample, and an exhaustive run all of them.
//!
//! `cargo test -- --ignored` tries the whole tables, as the continuous integration does. It needs
//! Neovim, QEMU and Chromium, too.

/// Share of its cases that a test tries.
#[derive(Clone, Copy, PartialEq)]
pub enum Effort {
    /// The first case of each table.
    Sample,
    /// All cases.
    Exhaustive,
}

impl Effort {
    /// Returns the cases of a table to try: the first one for a sample.
    pub fn of<T>(self, table: impl IntoIterator<Item = T>) -> impl Iterator<Item = T> {
        self.first(1, table)
    }

    /// Returns the cases of a table to try: a given number of them for a sample.
    pub fn first<T>(
        self,
        sample: usize,
        table: impl IntoIterator<Item = T>,
    ) -> impl Iterator<Item = T> {
        let count = match self {
            Self::Sample => sample,
            Self::Exhaustive => usize::MAX,
        };
        table.into_iter().take(count)
    }

    /// Scales a length or a number of repetitions: a sample takes 1/64 of it.
    pub fn part_of(self, whole: usize) -> usize {
        match self {
            Self::Sample => whole / 64,
            Self::Exhaustive => whole,
        }
    }
}

/// Makes two tests of a function that takes an [`Effort`]: `NAME::sample`, and `NAME::exhaustive`,
/// which is ignored by default.
macro_rules! sampled_and_exhaustive {
    ($name:ident) => {
        mod $name {
            use crate::effort::Effort;

            #[test]
            fn sample() {
                super::$name(Effort::Sample);
            }

            #[test]
            #[ignore = "exhaustive"]
            fn exhaustive() {
                super::$name(Effort::Exhaustive);
            }
        }
    };
}
pub(crate) use sampled_and_exhaustive;
