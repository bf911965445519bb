//! A program with mistakes: the scene that it makes a picture of, how it behaves, and what it does to the picture's light.

use std::sync::Arc;

use super::{
    layout::Layout,
    light::{Average, Curve, Look},
    parameters::Parameter,
    textbook::Behaviour,
};
use crate::scene::{Scene, Shape};

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
    /// How many numbers tell it.
    pub fn fitted(&self) -> usize {
        match self {
            Self::Row(_) | Self::ObjectRow(..) => 1,
            // Which numbers they are, and they themselves.
            Self::Numbers(_, numbers) => 1 + numbers.len(),
            // A row, a colour and a rectangle.
            Self::Patch(_) => 8,
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
    /// What it averages.
    pub average: Average,
    /// How it encodes what it averaged.
    pub curve: Curve,
    /// How it lays out what it makes.
    pub layout: Layout,
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
            average: Average::Light,
            curve: Curve::Right,
            layout: Layout::default(),
            looks: Vec::new(),
            named: Vec::new(),
        }
    }

    /// What a right program makes of what it draws of its scene.
    pub fn shown_rightly(&self) -> Self {
        Self {
            is_drawn: self.is_drawn.clone(),
            ..Self::right(&self.scene)
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

    /// An object of its scene.
    pub fn shape(&mut self, object: usize) -> &mut Shape {
        &mut Arc::make_mut(&mut self.scene.objects)[object].shape
    }

    /// Whether it traces what another one does, but for how they behave, and for what they do then.
    pub fn traces_as(&self, other: &Self) -> bool {
        let (one, two) = (&self.scene, &other.scene);
        let is_one_view = one.camera == two.camera && one.image == two.image;
        let are_same_objects =
            Arc::ptr_eq(&one.objects, &two.objects) || one.objects == two.objects;
        is_one_view
            && self.average == other.average
            && self.layout.is_shifted() == other.layout.is_shifted()
            && self.is_drawn == other.is_drawn
            && are_same_objects
    }

    /// How many numbers were fitted.
    pub fn fitted(&self) -> usize {
        self.named.iter().map(|named| named.cause.fitted()).sum()
    }
}
