//! What may be wrong with the program that made a picture.
//!
//! In: a scene. Out: a `candidate`, which is a program with a set of mistakes: rows of the table in
//! `mistakes`, made by the functions in `changes`; numbers of the scene (`parameters`); an extra
//! patch, exchanged colours or another pixel width. They change the candidate's scene, its
//! `behaviour` as a tracer, the `layout` of its pixels, or their `light`.

mod behaviour;
mod candidate;
mod changes;
mod layout;
mod light;
pub mod mistakes;
pub mod parameters;

pub use self::{
    behaviour::{Behaviour, HitFault, Rays, SeenSurface, Shading, Spheres},
    candidate::{Candidate, Mistake, MistakeRow, Shows},
    layout::Layout,
    light::{Curve, Effect, STEP, Tabulated, encoded_quickly, is_near},
    mistakes::{OBJECT_ROWS, ROWS},
    parameters::{Owner, Parameter},
};
