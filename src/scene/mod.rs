//! Reads a scene file into a [`Scene`], which is plain data.
//!
//! In: the texts of a file and of its `--set` arguments, which are parsed here. Out: a [`Scene`],
//! or problems. In a [`Scene`], defaults are filled in and expressions are evaluated. Alternative
//! fields, such as `lookat` and `direction` of a camera, are reduced to the one that the file uses.
//! Every condition of the schema holds. Nothing here depends on the tracer.

#![cfg_attr(
    not(test),
    deny(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::indexing_slicing,
        clippy::unreachable
    )
)]

pub mod describe;
mod display;
mod error;
mod eval;
mod examples;
mod fields;
mod fix_all;
mod lower;
mod lowered_block;
mod model;
mod overrides;
mod semantic_model;
mod shape;
mod unseen;
mod value;

pub use crate::schema::Method;
pub use examples::example_beside;
pub use fields::FieldOwner;
pub use fix_all::{Done, Fixed, fix_all};
pub use lower::{analyze, read, read_in_parts, read_unless};
pub use model::*;
pub use semantic_model::{Parts, SemanticModel};
pub use shape::*;
pub use unseen::{Outside, Sight};
pub use value::operate;
