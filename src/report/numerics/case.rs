//! A hard case: how its inputs are generated, and at which points of the picture they are tested.

use super::{
    inputs::{CaseRng, SamplePoint},
    trial::{CaseTally, Trial, axes},
};
use crate::{
    reference::{oracle::USUAL_SIZES, scenes::scene},
    scene::{Camera, Scene, Shape},
};

/// A case of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name of the case.
    pub id: &'static str,
    /// Description of what makes the case hard.
    pub title: &'static str,
    /// Maximum error that Pinhole claims, in the case's [`unit`](Self::unit). No decision may be
    /// wrong.
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
    /// Returns whether the case tests decisions about what is seen, not only numbers.
    pub fn decides(&self) -> bool {
        matches!(self.subject, Question::Seen(_))
    }

    /// Returns the unit of the case's errors.
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
    /// Number of bits of the oracle's arithmetic.
    bits: usize,
    /// Generates points of the picture; by default they lie anywhere.
    points: Box<dyn Fn(&mut CaseRng) -> SamplePoint>,
    /// Number of halves of the inputs that are tested at these points: 0, 1 or 2. The other inputs
    /// lie close to boundaries.
    halves: u64,
}

/// Returns a scene of which points close to the boundaries of what is seen are tested.
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

    /// Makes the case test points anywhere.
    pub fn anywhere(self) -> Self {
        Self { halves: 2, ..self }
    }

    /// Makes the case test points that `point` generates.
    pub fn at(self, point: impl Fn(&mut CaseRng) -> SamplePoint + 'static) -> Self {
        Self {
            points: Box::new(point),
            ..self.anywhere()
        }
    }

    /// Makes the case test half of the inputs at points anywhere (or at those of `at`) and half
    /// close to boundaries.
    pub fn mixed(self) -> Self {
        Self { halves: 1, ..self }
    }
}
