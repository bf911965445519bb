//! A program with mistakes: the scene that it makes a picture of, how it behaves, and what it does to the picture's light.

use std::sync::Arc;

use super::{
    faulty_tracer::Behaviour,
    layout::Layout,
    light::{Curve, Look},
    parameters::Parameter,
};
use crate::scene::{Part, Scene};

/// A mistake of a program.
#[derive(Clone, Debug)]
pub enum Mistake {
    /// A row of the table, and the object that it is about, if it is about one.
    Row(&'static Row, Option<usize>),
    /// Numbers that are others.
    Numbers(Parameter, Vec<f64>),
    /// Something too many: pixels of a colour, in linear light, between the least and the greatest column and row.
    Patch([f64; 3], [[f64; 2]; 2]),
}

/// A row of the table of mistakes (`mistakes`).
#[derive(Debug)]
pub struct Row {
    /// A word for programs.
    pub id: &'static str,
    /// Where it shows.
    pub shows: Shows,
    /// What it is; of one about an object, what follows its name.
    pub message: &'static str,
    /// The way out.
    pub help: &'static str,
    /// What it changes; the second argument is the object that it is about, if it is about one.
    pub change: fn(&mut Candidate, usize),
}

/// Where a mistake shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// In areas of one colour.
    InAreas,
    /// Where colours meet, and nowhere else: it moves nothing by a pixel.
    AtEdges,
    /// In both: so little that it is told by edges, or where it explains what is left.
    Everywhere,
}

impl Mistake {
    /// How many numbers tell it.
    pub fn fitted(&self) -> usize {
        match self {
            Self::Row(..) => 1,
            // Which numbers they are, and they themselves.
            Self::Numbers(_, numbers) => 1 + numbers.len(),
            // A row, a colour and a rectangle.
            Self::Patch(..) => 8,
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
    /// By which curve it decodes the colours that it averages.
    pub averaged: Curve,
    /// How it encodes what it averaged.
    pub curve: Curve,
    /// How it lays out what it makes.
    pub layout: Layout,
    /// What it does to the light.
    pub looks: Vec<Look>,
    /// Its mistakes.
    pub mistakes: Vec<Mistake>,
}

impl Candidate {
    /// A program without mistakes.
    pub fn right(scene: &Scene) -> Self {
        Self {
            scene: scene.clone(),
            is_drawn: vec![true; scene.objects.len()],
            behaviour: Behaviour::default(),
            averaged: Curve::Right,
            curve: Curve::Right,
            layout: Layout::default(),
            looks: Vec::new(),
            mistakes: Vec::new(),
        }
    }

    /// What a right program makes of what it draws of its scene.
    pub fn shown_rightly(&self) -> Self {
        Self {
            is_drawn: self.is_drawn.clone(),
            ..Self::right(&self.scene)
        }
    }

    /// The same with one more mistake; none if that cannot be, or if it is a row that changes nothing.
    pub fn with(&self, mistake: Mistake) -> Option<Self> {
        let mut candidate = self.clone();
        match &mistake {
            Mistake::Row(row, object) => {
                (row.change)(&mut candidate, object.unwrap_or_default());
                let camera = Part::Camera(candidate.scene.camera);
                let shape = object.map(|object| Part::Shape(candidate.scene.objects[object].shape));
                let is_possible = camera.is_possible() && shape.is_none_or(|it| it.is_possible());
                let is_same = candidate.traces_as(self)
                    && candidate.behaviour == self.behaviour
                    && candidate.curve == self.curve
                    && candidate.layout == self.layout
                    && candidate.looks.len() == self.looks.len();
                (is_possible && !is_same).then_some(())?;
            }
            Mistake::Numbers(parameter, numbers) => {
                candidate.scene = parameter.put(&candidate.scene, numbers)?
            }
            Mistake::Patch(light, area) => candidate.looks.push(Look::Patch {
                light: *light,
                area: *area,
            }),
        }
        candidate.mistakes.push(mistake);
        Some(candidate)
    }

    /// Those of its mistakes that are numbers.
    pub fn numeric(&self) -> impl Iterator<Item = (&Parameter, &[f64])> {
        self.mistakes.iter().filter_map(|mistake| match mistake {
            Mistake::Numbers(parameter, numbers) => Some((parameter, &numbers[..])),
            _ => None,
        })
    }

    /// All these numbers, one after the other.
    pub fn numbers(&self) -> Vec<f64> {
        self.numeric()
            .flat_map(|(_, numbers)| numbers.to_vec())
            .collect()
    }

    /// The same, where a vector of which the direction alone counts has a length with which it is short: its greatest number is 1.
    pub fn leveled_numbers(&self) -> Vec<f64> {
        let leveled = |(parameter, numbers): (&Parameter, &[f64])| -> Vec<f64> {
            let greatest = match parameter.fields[..] {
                ["normal" | "direction"] => numbers.iter().fold(0.0, |most, x| x.abs().max(most)),
                _ => 1.0,
            };
            numbers.iter().map(|x| x / greatest).collect()
        };
        self.numeric().flat_map(leveled).collect()
    }

    /// By how much each of these changes the picture by about so many pixels.
    pub fn steps(&self, pixels: f64) -> Vec<f64> {
        let steps = |(parameter, _): (&Parameter, _)| parameter.steps(&self.scene, pixels);
        self.numeric().flat_map(steps).collect()
    }

    /// The same with other numbers.
    pub fn with_numbers(&self, scene: &Scene, mut numbers: &[f64]) -> Option<Self> {
        let mut mistakes = self.mistakes.clone();
        for mistake in &mut mistakes {
            if let Mistake::Numbers(_, own) = mistake {
                let (first, rest) = numbers.split_at(own.len());
                own.copy_from_slice(first);
                numbers = rest;
            }
        }
        let mut mistakes = mistakes.into_iter();
        mistakes.try_fold(Self::right(scene), |candidate, one| candidate.with(one))
    }

    /// Whether it traces what another one does, but for how they behave, and for what they do then.
    pub fn traces_as(&self, other: &Self) -> bool {
        let (one, two) = (&self.scene, &other.scene);
        one.camera == two.camera
            && one.image == two.image
            && self.averaged == other.averaged
            && self.layout.more() == other.layout.more()
            && self.is_drawn == other.is_drawn
            && (Arc::ptr_eq(&one.objects, &two.objects) || one.objects == two.objects)
    }

    /// How far its samples lie from where they should, to the right and down, in pixels.
    pub fn shift(&self) -> [f64; 2] {
        let (halves, parts) = (self.layout.half_pixels, self.behaviour.offset);
        [0, 1].map(|i| 0.5 * f64::from(halves[i]) + parts[i])
    }

    /// How many numbers were fitted.
    pub fn fitted(&self) -> usize {
        self.mistakes.iter().map(Mistake::fitted).sum()
    }
}
