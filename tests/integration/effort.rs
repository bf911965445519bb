//! Tests whose tables take long: a sample of each in every run, the whole table where somebody asks
//! for it.
//!
//! `cargo test -- --ignored` tries the whole tables, as the continuous integration does; it wants
//! Neovim, QEMU and Chromium, too.

/// How much of its tables a test tries.
#[derive(Clone, Copy, PartialEq)]
pub enum Effort {
    /// The first case of each table.
    Sample,
    /// All cases.
    Exhaustive,
}

impl Effort {
    /// The cases of a table that are tried.
    pub fn of<T>(self, table: impl IntoIterator<Item = T>) -> impl Iterator<Item = T> {
        self.first(1, table)
    }

    /// The cases of a table of which a sample has as many.
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

    /// How long a text is, or how often something is tried: a sample takes a 64th.
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
