//! A hard case: what makes its inputs, and where in a scene it asks.

use super::{
    inputs::{Point, Random},
    oracle::USUAL_SIZES,
    scenes::scene,
    trial::{Tally, Trial, axes},
};
use crate::scene::{Camera, Scene, Shape};

/// A row of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Its name.
    pub id: &'static str,
    /// What is hard about it.
    pub title: &'static str,
    /// The greatest error that is claimed; no decision is wrong.
    pub bound: f64,
    pub(super) subject: Subject,
}

/// What questions are asked of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Subject {
    /// What is seen in a scene, of which many questions are asked: errors of distances and points
    /// are counted in units in the last place.
    Seen(fn(&mut Random) -> Input),
    /// The axes of a camera: errors of the components of unit vectors are counted in units of
    /// 2^−53.
    Axes(fn(&mut Random) -> Camera),
}

impl Case {
    /// Whether something is decided, and not only computed.
    pub fn decides(&self) -> bool {
        matches!(self.subject, Subject::Seen(_))
    }

    /// What errors are counted in.
    pub fn unit(&self) -> &'static str {
        if self.decides() { "ulp" } else { "u" }
    }

    /// Asks so many questions.
    pub(super) fn ask(&self, random: &mut Random, count: u64, tally: &mut Tally) {
        let input = match self.subject {
            Subject::Seen(input) => input(random),
            Subject::Axes(camera) => return (0..count).for_each(|_| axes(&camera(random), tally)),
        };
        let trial = Trial::new(input.scene, input.bits);
        let at_points = count * input.halves / 2;
        for _ in 0..at_points {
            trial.decide((input.points)(random), tally);
        }
        trial.boundaries(random, count - at_points, tally);
    }
}

/// A scene and where in its picture questions are asked.
pub(super) struct Input {
    pub scene: Scene,
    /// Those that the oracle computes with.
    bits: usize,
    /// Makes points of the picture: anywhere if nothing is said.
    points: Box<dyn Fn(&mut Random) -> Point>,
    /// How many of the questions are asked there, in halves of all; the others close to
    /// boundaries.
    halves: u64,
}

/// Points close to boundaries of what a camera sees of some shapes.
pub(super) fn input(camera: Camera, shapes: &[Shape]) -> Input {
    Input {
        scene: scene(camera, shapes),
        bits: USUAL_SIZES,
        points: Box::new(Random::point),
        halves: 0,
    }
}

impl Input {
    /// So many bits for the oracle.
    pub fn bits(self, bits: usize) -> Self {
        Self { bits, ..self }
    }

    /// Points anywhere.
    pub fn anywhere(self) -> Self {
        Self { halves: 2, ..self }
    }

    /// These points.
    pub fn at(self, point: impl Fn(&mut Random) -> Point + 'static) -> Self {
        Self {
            points: Box::new(point),
            ..self.anywhere()
        }
    }

    /// Points anywhere, or those that were named, and as many close to boundaries.
    pub fn mixed(self) -> Self {
        Self { halves: 1, ..self }
    }
}
