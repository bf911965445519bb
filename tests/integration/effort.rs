//! Tests with long tables of cases: a normal run tries a sample, an exhaustive run all cases.
//!
//! `cargo test -- --ignored` runs all cases, as the continuous integration does. It also needs
//! Neovim, QEMU and Chromium.

/// How many cases of its table a test tries.
#[derive(Clone, Copy, PartialEq)]
pub enum Effort {
    /// The first case of each table, or a given number of first cases.
    Sample,
    /// All cases of each table.
    Exhaustive,
}

impl Effort {
    /// Returns the cases to try: only the first one for [`Self::Sample`], else the whole table.
    pub fn of<T>(self, table: impl IntoIterator<Item = T>) -> impl Iterator<Item = T> {
        self.first(1, table)
    }

    /// Returns the cases to try: the first `sample` for [`Self::Sample`], else the whole table.
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

    /// Returns the length of a text or the number of repetitions that a test tries: `whole / 64`
    /// for [`Self::Sample`], else `whole`.
    pub fn part_of(self, whole: usize) -> usize {
        match self {
            Self::Sample => whole / 64,
            Self::Exhaustive => whole,
        }
    }
}

/// Defines two tests of a function that takes an [`Effort`]: `NAME::sample`, and
/// `NAME::exhaustive`, which is ignored by default.
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
