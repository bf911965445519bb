//! Lowers a syntax tree, i.e. converts it to a scene.
//!
//! In: the tree of a file, in which the values of `--set` arguments replace those of the file. Out:
//! the scene, or problems. The items are processed once, in order: each item defines its name,
//! evaluates its fields or builds its objects. Then image, camera and sampler are built. A problem
//! of one field never hides a problem of another.

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
