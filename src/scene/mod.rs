//! What a scene file means: plain data with everything resolved.
//!
//! In: the texts of a file and of its overrides, which are parsed here. Out: a [`Scene`], or
//! problems. Defaults are filled in, alternatives decided and expressions evaluated; every
//! condition of the language's table holds. What the tracer makes of it is not known here.

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
mod error;
mod eval;
mod examples;
mod fields;
mod fix_all;
mod lower;
mod model;
mod overrides;
mod pixel_size;
mod semantic_model;
mod unseen;
mod value;

pub use crate::schema::Method;
pub use examples::example_beside;
pub use fields::Part;
pub use fix_all::{Done, Fixed, fix_all};
pub use lower::{analyze, read, read_in_parts, read_unless};
pub use model::*;
pub use pixel_size::pixel_size;
pub use semantic_model::{Parts, SemanticModel};
pub use unseen::{Place, Sight, sphere_around};
pub use value::operate;
