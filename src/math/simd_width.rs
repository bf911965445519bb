//! How wide the vectors are that loops over plain arrays are made of.
//!
//! A program for any processor of a kind may use the vectors that all of them have, which on x86-64
//! are two numbers wide. So the few loops that matter are compiled for wider ones, too, and the
//! processor is asked once which of them it has: four numbers (AVX2), and eight (AVX-512)
//! where that gains a tenth. Vectors of any width compute the
//! same bits: IEEE 754 rounds each sum and each product on its own, and nothing here may fuse two
//! operations into one.

/// Which vectors a loop is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SimdWidth {
    /// The widest that the processor has.
    #[default]
    Widest,
    /// Those that every processor of its kind has, which are quicker where there are few numbers.
    Baseline,
}

/// Whether loops are compiled for wider vectors, too. Elsewhere a second copy of them would only
/// make the program larger.
pub const HAS_WIDER: bool = cfg!(target_arch = "x86_64");
