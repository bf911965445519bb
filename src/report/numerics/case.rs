//! A hard case: a generator of inputs, and the points of the picture that are tested.

use super::{
    inputs::{CaseRng, SamplePoint},
    trial::{CaseTally, Trial, axes},
};
use crate::{
    reference::{oracle::USUAL_SIZES, scenes::scene},
    scene::{Camera, Scene, Shape},
};

/// A hard case of the catalogue in [`cases`](super::cases).
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Case {
    /// Name of the case in tables, such as `C3a`.
    pub id: &'static str,
    /// Description of what is difficult in the case.
    pub title: &'static str,
    /// Maximum error that Pinhole guarantees, in the case's [`unit`](Self::unit). In addition, no
    /// decision may be wrong.
    pub bound: f64,
    pub(super) subject: Question,
}

/// The quantity that a case tests.
#[derive(Clone, Copy, Debug)]
pub(super) enum Question {
    /// What is seen at many points of a scene. Errors of distances and points are counted in units
    /// in the last place.
    Seen(fn(&mut CaseRng) -> CaseScene),
    /// The axes of a camera. Errors of the components of unit vectors are counted in units of
    /// 2^−53.
    Axes(fn(&mut CaseRng) -> Camera),
}

impl Case {
    /// Returns whether the case tests decisions about what is seen, besides numbers.
    pub fn decides(&self) -> bool {
        matches!(self.subject, Question::Seen(_))
    }

    /// Returns the unit of the case's errors: `ulp`, the unit in the last place, or `u`, 2^−53.
    pub fn unit(&self) -> &'static str {
        if self.decides() { "ulp" } else { "u" }
    }

    /// Tests `count` inputs of the case and adds the results to `tally`.
    pub(super) fn ask(&self, random: &mut CaseRng, count: u64, tally: &mut CaseTally) {
        let input = match self.subject {
            Question::Seen(input) => input(random),
            Question::Axes(camera) => return (0..count).for_each(|_| axes(&camera(random), tally)),
        };
        let trial = Trial::new(input.scene, input.bits);
        let at_points = count * input.halves / 2;
        for _ in 0..at_points {
            trial.decide((input.points)(random), tally);
        }
        trial.boundaries(random, count - at_points, tally);
    }
}

/// A scene, and the points of its picture that are tested.
pub(super) struct CaseScene {
    pub scene: Scene,
    /// Precision of the oracle's arithmetic for this scene, in bits.
    bits: usize,
    /// Generator of points of the picture. By default, they are uniform over the picture.
    points: Box<dyn Fn(&mut CaseRng) -> SamplePoint>,
    /// Number of halves of the inputs, 0, 1 or 2, that are tested at points from `points`. The
    /// other inputs lie close to boundaries between colours.
    halves: u64,
}

/// Returns a scene that is tested close to the boundaries between its colours.
pub(super) fn input(camera: Camera, shapes: &[Shape]) -> CaseScene {
    CaseScene {
        scene: scene(camera, shapes),
        bits: USUAL_SIZES,
        points: Box::new(CaseRng::point),
        halves: 0,
    }
}

impl CaseScene {
    /// Sets the number of bits of the oracle's arithmetic.
    pub fn bits(self, bits: usize) -> Self {
        Self { bits, ..self }
    }

    /// Makes all inputs of the case lie at points that are uniform over the picture.
    pub fn anywhere(self) -> Self {
        Self { halves: 2, ..self }
    }

    /// Makes all inputs of the case lie at points that `point` generates.
    pub fn at(self, point: impl Fn(&mut CaseRng) -> SamplePoint + 'static) -> Self {
        Self {
            points: Box::new(point),
            ..self.anywhere()
        }
    }

    /// Makes half of the case's inputs lie at points anywhere in the picture, or at those of
    /// [`at`](Self::at), and half close to boundaries.
    pub fn mixed(self) -> Self {
        Self { halves: 1, ..self }
    }
}
