//! Lowers a syntax tree, i.e. converts it to a scene.
//!
//! In: the tree of a file, in which `--set` arguments have replaced values. Out: the scene, or
//! problems. Every item is processed once. A definition gives a value to its name. The fields of a
//! block are evaluated, and the block of an object is built. Then image, camera and sampler are
//! built. A problem of one field never hides a problem of another.

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
