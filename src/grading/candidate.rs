//! A program with mistakes: the scene that it makes a picture of, how it behaves, and what it does to the picture's light.

use super::{
    grid::Grid,
    parameters::Parameter,
    score::{Model, STEP},
    textbook::{Behaviour, Moments, Textbook},
};
use crate::{color::linear_to_srgb, scene::Scene};

/// What is done to a picture's light.
#[derive(Clone, Copy, Debug)]
pub enum Look {
    /// Its channels are in another order.
    Channels([usize; 3]),
    /// All channels are a mean of them.
    Gray([f64; 3]),
    /// Each channel goes through a curve.
    Curve(fn(f64) -> f64),
    /// Its bytes are cut off instead of rounded.
    CutOff,
    /// Pixels between two places that have a colour are no part of the scene.
    Patch {
        /// The colour in linear light.
        light: [f64; 3],
        /// The least and the greatest column and row.
        area: [[f64; 2]; 2],
    },
}

/// A mistake that a candidate has.
#[derive(Clone, Debug)]
pub struct Named {
    /// A word for programs.
    pub id: &'static str,
    /// What it is, but for numbers.
    pub message: String,
    /// The way out.
    pub help: String,
    /// What it does.
    pub cause: Cause,
}

/// What a mistake does.
#[derive(Clone, Debug)]
pub enum Cause {
    /// A row of the table that does this, if it can.
    Row(fn(&mut Candidate) -> Option<()>),
    /// A row that does this to an object.
    ObjectRow(fn(&mut Candidate, usize) -> Option<()>, usize),
    /// Numbers that are others.
    Numbers(Parameter, Vec<f64>),
    /// Something too many.
    Patch(Look),
}

impl Cause {
    /// How many numbers are fitted.
    pub fn fitted(&self) -> usize {
        match self {
            Self::Row(_) | Self::ObjectRow(..) => 1,
            Self::Numbers(_, numbers) => numbers.len(),
            // A colour and a rectangle.
            Self::Patch(_) => 7,
        }
    }
}

/// A program.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The scene.
    pub scene: Scene,
    /// Whether each of the scene's objects is drawn.
    pub is_drawn: Vec<bool>,
    /// How it behaves.
    pub behaviour: Behaviour,
    /// What it does to the light.
    pub looks: Vec<Look>,
    /// Its mistakes.
    pub named: Vec<Named>,
}

impl Candidate {
    /// A program without mistakes.
    pub fn right(scene: &Scene) -> Self {
        Self {
            scene: scene.clone(),
            is_drawn: vec![true; scene.objects.len()],
            behaviour: Behaviour::RIGHT,
            looks: Vec::new(),
            named: Vec::new(),
        }
    }

    /// The same with one more mistake.
    pub fn with(&self, named: Named) -> Option<Self> {
        let mut candidate = self.clone();
        match &named.cause {
            Cause::Row(change) => change(&mut candidate)?,
            Cause::ObjectRow(change, object) => change(&mut candidate, *object)?,
            Cause::Numbers(parameter, numbers) => {
                candidate.scene = parameter.put(&candidate.scene, numbers)?
            }
            Cause::Patch(look) => candidate.looks.push(*look),
        }
        candidate.named.push(named);
        Some(candidate)
    }

    /// One with these mistakes, one after the other.
    pub fn of(scene: &Scene, named: &[Named]) -> Option<Self> {
        named.iter().try_fold(Self::right(scene), |candidate, one| {
            candidate.with(one.clone())
        })
    }

    /// How many numbers were fitted.
    pub fn fitted(&self) -> usize {
        self.named.iter().map(|named| named.cause.fitted()).sum()
    }

    /// What it shows in the cells of a grid, of which a picture shows something.
    pub fn model(&self, grid: &Grid, seen: &[[f64; 3]], samples: usize) -> Model {
        let mut scene = self.scene.clone();
        let mut is_drawn = self.is_drawn.iter();
        scene.objects.retain(|_| is_drawn.next() == Some(&true));
        let moments = Textbook::new(&scene, self.behaviour.clone()).moments(grid, samples);
        let mut model = Model {
            moments,
            from: Some(samples),
            cut: 0.0,
        };
        model.look(&self.looks, grid, seen);
        model
    }
}

impl Model {
    /// Does to the light what is done to it.
    pub fn look(&mut self, looks: &[Look], grid: &Grid, seen: &[[f64; 3]]) {
        let Moments { mean, variance } = &mut self.moments;
        for look in looks {
            match *look {
                Look::Channels(order) => {
                    for one in mean.iter_mut().chain(variance.iter_mut()) {
                        *one = order.map(|i| one[i]);
                    }
                }
                Look::Gray(weights) => {
                    for one in mean.iter_mut() {
                        *one = [(0..3).map(|i| weights[i] * one[i]).sum(); 3];
                    }
                    for one in variance.iter_mut() {
                        let deviation: f64 = (0..3).map(|i| weights[i] * one[i].sqrt()).sum();
                        *one = [deviation * deviation; 3];
                    }
                }
                Look::Curve(curve) => {
                    let mut last = [(f64::NAN, 0.0, 0.0); 3];
                    for (mean, variance) in mean.iter_mut().zip(variance.iter_mut()) {
                        for i in 0..3 {
                            if mean[i] != last[i].0 {
                                // The slope over what noise of a sample or a step may reach.
                                let by = variance[i].sqrt().max(STEP) / 4.0;
                                let (low, high) = ((mean[i] - by).max(0.0), mean[i] + by);
                                let slope = (curve(high) - curve(low)) / (high - low);
                                last[i] = (mean[i], curve(mean[i]), slope);
                            }
                            variance[i] *= last[i].2 * last[i].2;
                            mean[i] = last[i].1;
                        }
                    }
                }
                Look::CutOff => self.cut = -0.5,
                Look::Patch {
                    light,
                    area: [[left, top], [right, bottom]],
                } => {
                    for at in 0..mean.len() {
                        let place =
                            grid.place(at % grid.width, at / grid.width, glam::DVec2::splat(0.5));
                        let is_within =
                            (left..right).contains(&place.x) && (top..bottom).contains(&place.y);
                        if is_within && is_near(seen[at], light) {
                            mean[at] = light;
                            variance[at] = [0.0; 3];
                        }
                    }
                }
            }
        }
    }
}

/// Whether two colours are within a step of each other.
pub fn is_near(one: [f64; 3], other: [f64; 3]) -> bool {
    (0..3).all(|i| (linear_to_srgb(one[i]) - linear_to_srgb(other[i])).abs() < 1.5 * STEP)
}
