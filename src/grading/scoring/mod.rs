//! Scores how well a hypothesis about the program explains a picture.
//!
//! In: a hypothesis, and a picture at one resolution (`level`), which is divided into cells
//! (`grid`). Out: a `prediction` of what the cells show.
//!
//! First, a `rendering` of the hypothesis computes the mean and the variance of each cell
//! (`moments`). They are exact if the program traces the rays of its scene correctly. If it does
//! not, or on the coarsest grid, the `faulty_tracer` estimates them from samples. Next, pixels are
//! rearranged, and effects on light and `jpeg` coding are applied.
//!
//! A prediction says how likely the picture is (`likelihood`), which pixels are wrong for reasons
//! other than sampling noise (`strays`), and whether edges are displaced (`displacement`). `work`
//! counts the cost.

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
