//! What is likely wrong with a picture of a scene.
use crate::{
    film::Film,
    render::{Control, RenderError},
    scene::Scene,
};

/// A simple mistake that explains a difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// A word for programs.
    pub mistake: &'static str,
    /// What is likely wrong, for people.
    pub message: String,
    /// The way out.
    pub help: String,
    /// The root mean square of the differences that it leaves, in linear light; none where pictures differ in size.
    pub rmse: Option<f64>,
    /// The share of the squared difference that it explains, 0 to 1.
    pub explains: Option<f64>,
}

/// pictures
pub fn pictures(_a: &Film, _b: &Film) -> Vec<Verdict> {
    Vec::new()
}
/// scene
pub fn scene(
    _a: &Film,
    _scene: &Scene,
    _exact: &Film,
    _control: &Control,
) -> Result<Vec<Verdict>, RenderError> {
    Ok(Vec::new())
}
