//! How well a candidate explains a picture.
//!
//! In: a candidate, and a picture on a `level`, whose cells form a `grid`. Out: a `prediction`.
//! It starts as a `rendering` of the candidate's scene: exact `moments` of the cells, or moments
//! sampled by the `faulty_tracer` if the behaviour cannot be expressed as a scene, and on the tiny
//! grid. Layout, effects on light and `jpeg` coding follow. A prediction tells how likely the
//! picture is (`likelihood`), which pixels no sampling explains (`strays`), and whether edges are
//! displaced (`displacement`). `work` counts what all this costs.

mod displacement;
mod faulty_tracer;
mod grid;
mod jpeg;
mod level;
mod likelihood;
mod linear_system;
pub mod moments;
mod prediction;
mod rendering;
mod strays;
pub mod work;

pub use self::{
    displacement::Displacement,
    faulty_tracer::FaultyTracer,
    grid::Grid,
    level::Level,
    likelihood::Score,
    linear_system::solve,
    moments::Moments,
    prediction::{FLAT, Prediction},
    rendering::Rendering,
    strays::{DEVIATIONS, Strays, WRONG},
    work::Work,
};
