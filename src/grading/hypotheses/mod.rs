//! Hypotheses about the program that made a picture. A hypothesis is a set of mistakes that the
//! program may make.
//!
//! In: a scene and some mistakes. Out: a `candidate`, i.e. a hypothesis with all effects of its
//! mistakes. There are six kinds of mistakes: rows of the table in `mistakes`, which functions of
//! `changes` apply; wrong numbers of the scene (`parameters`); an extra patch; exchanged colours; a
//! wrong pixel width; and samples shifted by less than half a pixel. A mistake changes one of four
//! things: the scene that is rendered, the `behaviour` of the ray tracer, the `layout` of the
//! pixels, or their `light`.

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
