//! The width of the vectors into which loops over plain arrays are compiled.
//!
//! A program for all processors of an architecture may only use the vectors that all of them have,
//! which on x86-64 hold two numbers. The few loops that matter are therefore also compiled for
//! wider vectors, four numbers (AVX2) and, where it gains a tenth, eight (AVX-512), and the
//! processor is asked once which of them it has. Vectors of any width compute the same bits: IEEE
//! 754 rounds each sum and each product on its own, and nothing here may fuse two operations into
//! one.

/// Width of the vectors that a loop uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SimdWidth {
    /// The widest vectors that the processor has.
    #[default]
    Widest,
    /// The vectors that every processor of the architecture has, which are faster for few numbers.
    Baseline,
}

/// Whether loops are also compiled for wider vectors. On other architectures a second copy would
/// only enlarge the program.
pub const HAS_WIDER: bool = cfg!(target_arch = "x86_64");
