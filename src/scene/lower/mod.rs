//! Tree → scene.
//!
//! In: the tree of a file, with the values of arguments in it. Out: the scene, or what is wrong
//! with it. The items are walked once, in order: every name is defined, every field evaluated and
//! every object built where it stands; then image, camera and sampler are built. A problem of one
//! field never hides one of another.

mod block;
mod build;
mod camera;
mod field_value;
mod fixes;
mod items;
mod lowering;
mod missing;
mod objects;
mod read;
mod repetition;
mod suggestions;
mod unknown;

pub use read::{analyze, read, read_in_parts, read_unless};
