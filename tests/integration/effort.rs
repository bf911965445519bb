//! Tests with long tables of cases. A normal run tries only some cases of each table; an exhaustive
//! run tries all.
//!
//! `cargo test -- --ignored` runs all cases, as the continuous integration does. It also runs tests
//! that need other programs, such as Neovim, QEMU and Chromium.

/// Choice of the cases that a test tries from its table.
#[derive(Clone, Copy, PartialEq)]
pub enum Effort {
    /// Only the first cases of the table: one case, unless the test gives another number.
    Sample,
    /// All cases of the table.
    Exhaustive,
}

impl Effort {
    /// Returns the cases to try: only the first one for [`Self::Sample`], otherwise the whole
    /// table.
    pub fn of<T>(self, table: impl IntoIterator<Item = T>) -> impl Iterator<Item = T> {
        self.first(1, table)
    }

    /// Returns the cases to try: the first `sample` cases for [`Self::Sample`], otherwise the whole
    /// table.
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

    /// Returns the length of a text, or the number of repetitions, that a test tries: `whole / 64`
    /// for [`Self::Sample`], otherwise `whole`.
    pub fn part_of(self, whole: usize) -> usize {
        match self {
            Self::Sample => whole / 64,
            Self::Exhaustive => whole,
        }
    }
}

/// Defines two tests of a function that takes an [`Effort`]: `NAME::sample`, and
/// `NAME::exhaustive`, which runs only on request (`--ignored`).
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
