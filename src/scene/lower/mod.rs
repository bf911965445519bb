//! Tree → scene.
//!
//! In: the tree of a file, with the values of arguments in it. Out: the scene, or problems. The
//! items are walked once, in order: each item defines its name, evaluates its fields and builds its
//! objects; then image, camera and sampler are built. A problem of one field never hides a problem
//! of another.

mod build;
mod camera;
mod field_value;
mod fixes;
mod items;
mod lowering;
mod missing;
mod read;
mod repetition;
mod suggestions;
mod unknown;

pub use read::{analyze, read, read_in_parts, read_unless};
