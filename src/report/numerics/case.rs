//! A hard case: how its inputs are generated, and where in the scene they are tested.

use super::{
    inputs::{CaseRng, SamplePoint},
    trial::{CaseTally, Trial, axes},
};
use crate::{
    reference::{oracle::USUAL_SIZES, scenes::scene},
    scene::{Camera, Scene, Shape},
};

/// A row of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Name.
    pub id: &'static str,
    /// What makes the case hard.
    pub title: &'static str,
    /// Maximum error that is claimed; no decision is wrong.
    pub bound: f64,
    pub(super) subject: Question,
}

/// What a case tests.
#[derive(Clone, Copy, Debug)]
pub(super) enum Question {
    /// What is seen in a scene, which is tested at many points. Errors of distances and points are
    /// counted in units in the last place.
    Seen(fn(&mut CaseRng) -> CaseScene),
    /// The axes of a camera. Errors of the components of unit vectors are counted in units of
    /// 2^−53.
    Axes(fn(&mut CaseRng) -> Camera),
}

impl Case {
    /// Returns whether the case tests decisions, not only numbers.
    pub fn decides(&self) -> bool {
        matches!(self.subject, Question::Seen(_))
    }

    /// Returns the unit of its errors.
    pub fn unit(&self) -> &'static str {
        if self.decides() { "ulp" } else { "u" }
    }

    /// Tests `count` inputs.
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
    /// Number of inputs tested at these points, in halves of all inputs; the others lie close to
    /// boundaries.
    halves: u64,
}

/// Tests points close to the boundaries of what a camera sees of the shapes.
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

    /// Tests points anywhere.
    pub fn anywhere(self) -> Self {
        Self { halves: 2, ..self }
    }

    /// Tests points that `point` generates.
    pub fn at(self, point: impl Fn(&mut CaseRng) -> SamplePoint + 'static) -> Self {
        Self {
            points: Box::new(point),
            ..self.anywhere()
        }
    }

    /// Tests half of the inputs at points anywhere, or at those of `at`, and half close to
    /// boundaries.
    pub fn mixed(self) -> Self {
        Self { halves: 1, ..self }
    }
}
