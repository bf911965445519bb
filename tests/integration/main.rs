//! The tests of the whole from outside, in one binary.

mod sampling;
