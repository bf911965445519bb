//! Scores how well a hypothesis about the program, i.e. a set of mistakes, explains a picture.
//!
//! In: a hypothesis, and a picture at one resolution (`level`), which is divided into the cells of
//! a `grid`. Out: a `prediction`, i.e. the light that each cell should show and the light that it
//! does show.
//!
//! First, a `rendering` of the hypothesis computes the mean and the variance of each cell
//! (`moments`). These are exact if the program traces rays correctly. If it does not, or if the
//! grid is the coarsest one, the `faulty_tracer` estimates them from samples. Next, the cells are
//! rearranged if the program arranges pixels wrongly. Finally, effects on light and `jpeg` coding
//! are applied.
//!
//! A prediction says how likely the picture is (`likelihood`), which pixels are wrong for reasons
//! other than sampling noise (`unexplained_errors`), and whether edges are displaced
//! (`displacement`). `work` counts the work that is spent, and limits it.

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
mod unexplained_errors;
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
    unexplained_errors::{DEVIATIONS, UnexplainedErrors, WRONG},
    work::Work,
};
