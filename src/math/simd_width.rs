//! The widths of the SIMD vectors for which loops over plain arrays are compiled.
//!
//! A program for all processors of an architecture may only use the vectors that all of them have,
//! which hold two `f64` on x86-64. The few loops that take most of the time are therefore also
//! compiled for wider vectors of four numbers (AVX2). Loops that gain 10 % from vectors of eight
//! numbers (AVX-512) are compiled for these, too. At run time, the program detects once which
//! vectors the processor has. Vectors of any width give the same bits: IEEE 754 rounds each sum and
//! each product separately, and the compiler does not fuse a product and a sum into one operation.

/// Choice of the SIMD vectors that a loop uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SimdWidth {
    /// The widest vectors that the processor has.
    #[default]
    Widest,
    /// The vectors that every processor of the architecture has. They are faster if a loop handles
    /// few numbers.
    Baseline,
}

/// Whether loops are compiled again for vectors wider than the baseline, i.e. wider than those that
/// all processors of the architecture have. This is done only on x86-64. On other architectures,
/// the second copy would use the same vectors and only enlarge the program.
pub const HAS_WIDER: bool = cfg!(target_arch = "x86_64");
