//! A hard case: a kind of scene or camera for which rounding errors easily cause wrong answers. A
//! case generates random scenes or cameras. For scenes, it tests what Pinhole sees at points of the
//! picture. For cameras, it tests the axes that Pinhole computes.

use super::{
    inputs::{CaseRng, SamplePoint},
    trial::{CaseTally, Trial, axes},
};
use crate::{
    reference::{oracle::USUAL_SIZES, scenes::scene},
    scene::{Camera, Scene, Shape},
};

/// A hard case: a kind of scene or camera for which rounding errors easily cause wrong answers.
/// [`cases`](super::cases) returns all cases.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Short name of the case in tables, such as `C3a`.
    pub id: &'static str,
    /// Description of what is difficult in the case, for tables.
    pub title: &'static str,
    /// Guaranteed upper bound of the errors of the numbers that Pinhole computes, in the unit
    /// [`unit`](Self::unit). Decisions, such as which object is seen, must always be right.
    pub bound: f64,
    pub(super) subject: Question,
}

/// What a case tests. Each variant contains a function that generates random inputs.
#[derive(Clone, Copy, Debug)]
pub(super) enum Question {
    /// Tests points of a scene's picture: which object is seen there, at which distance, and at
    /// which point in space. Errors of the distance and of the point are in units in the last place
    /// (ulp).
    Seen(fn(&mut CaseRng) -> CaseScene),
    /// Tests the axes of a camera, which are unit vectors. Errors of their components are in units
    /// of 2^−53.
    Axes(fn(&mut CaseRng) -> Camera),
}

impl Case {
    /// Returns whether the case tests which object is seen. Other cases test only the axes of
    /// cameras.
    pub fn decides(&self) -> bool {
        matches!(self.subject, Question::Seen(_))
    }

    /// Returns the unit of the case's errors: `ulp` (unit in the last place) or `u` (2^−53).
    pub fn unit(&self) -> &'static str {
        if self.decides() { "ulp" } else { "u" }
    }

    /// Tests `count` random inputs of the case, and adds the results to `tally`.
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

/// A scene, and a rule for choosing the points of its picture that are tested.
pub(super) struct CaseScene {
    pub scene: Scene,
    /// Precision, in bits, of the oracle's arithmetic. The oracle is the reference that Pinhole is
    /// compared with.
    bits: usize,
    /// Generator of random points of the picture. By default, all points are equally likely.
    points: Box<dyn Fn(&mut CaseRng) -> SamplePoint>,
    /// Number of halves of the tests that use points from the generator `points`: 0 for no tests, 1
    /// for half of the tests, 2 for all. The other tests use points close to boundaries between
    /// colours.
    halves: u64,
}

/// Returns a scene that is tested only close to boundaries between colours.
pub(super) fn input(camera: Camera, shapes: &[Shape]) -> CaseScene {
    CaseScene {
        scene: scene(camera, shapes),
        bits: USUAL_SIZES,
        points: Box::new(CaseRng::point),
        halves: 0,
    }
}

impl CaseScene {
    /// Sets the precision of the oracle's arithmetic, in bits. The oracle is the reference that
    /// Pinhole is compared with.
    pub fn bits(self, bits: usize) -> Self {
        Self { bits, ..self }
    }

    /// Tests the scene at random points of the picture, which are all equally likely.
    pub fn anywhere(self) -> Self {
        Self { halves: 2, ..self }
    }

    /// Tests the scene at the points that the function `point` generates.
    pub fn at(self, point: impl Fn(&mut CaseRng) -> SamplePoint + 'static) -> Self {
        Self {
            points: Box::new(point),
            ..self.anywhere()
        }
    }

    /// Tests half of the inputs at points from the generator `points`, and the other half close to
    /// boundaries between colours.
    pub fn mixed(self) -> Self {
        Self { halves: 1, ..self }
    }
}
