//! A program with mistakes: the scene that it makes a picture of, how it behaves, and what it does
//! to the picture's light.

use std::sync::Arc;

use super::{
    faulty_tracer::Behaviour,
    layout::Layout,
    light::{Curve, Look},
    parameters::Parameter,
};
use crate::scene::{FieldOwner as Part, Scene};

/// A mistake of a program.
#[derive(Clone, Debug)]
pub enum Mistake {
    /// A row of the table, and the object that it is about, if it is about one.
    Row(&'static Row, Option<usize>),
    /// Numbers that are others.
    Numbers(Parameter, Vec<f64>),
    /// Something too many: pixels of a colour, in linear light, between the least and the greatest
    /// column and row.
    Patch([f64; 3], [[f64; 2]; 2]),
    /// Two objects of one colour each have each other's.
    ColorsExchanged(usize, usize),
    /// Pixels are seen as through pixels so many times as wide.
    Filter(f64),
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
    /// Whether it is another one, but for its numbers.
    pub fn is_alike(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Row(row, object), Self::Row(other, of)) => {
                row.message == other.message && object == of
            }
            (Self::Numbers(one, _), Self::Numbers(other, _)) => one == other,
            (Self::ColorsExchanged(one, two), Self::ColorsExchanged(first, second)) => {
                [one, two] == [first, second]
            }
            (Self::Patch(..), Self::Patch(..)) | (Self::Filter(_), Self::Filter(_)) => true,
            _ => false,
        }
    }

    /// How many numbers tell it.
    pub fn fitted(&self) -> usize {
        match self {
            Self::Row(..) | Self::ColorsExchanged(..) => 1,
            // Which numbers they are, and they themselves.
            Self::Numbers(_, numbers) => 1 + numbers.len(),
            // A row, a colour and a rectangle.
            Self::Patch(..) => 8,
            Self::Filter(_) => 2,
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

    /// A program with these mistakes; none if they cannot be, or if one of them changes nothing.
    pub fn of(scene: &Scene, mistakes: impl IntoIterator<Item = Mistake>) -> Option<Self> {
        let mut mistakes = mistakes.into_iter();
        mistakes.try_fold(Self::right(scene), |candidate, one| candidate.with(one))
    }

    /// What a right program makes of what it draws of its scene.
    pub fn shown_rightly(&self) -> Self {
        Self {
            is_drawn: self.is_drawn.clone(),
            ..Self::right(&self.scene)
        }
    }

    /// The same with one more mistake; none if that cannot be, or if it is a row that changes
    /// nothing.
    pub fn with(&self, mistake: Mistake) -> Option<Self> {
        let mut candidate = self.clone();
        match &mistake {
            Mistake::Row(row, object) => {
                (row.change)(&mut candidate, object.unwrap_or_default());
                let camera = Part::Camera(candidate.scene.camera);
                let shape = object.map(|object| Part::Shape(candidate.scene.objects[object].shape));
                let is_possible = camera.is_possible() && shape.is_none_or(|it| it.is_possible());
                let is_same = candidate.shows_as(self) && candidate.looks.len() == self.looks.len();
                (is_possible && !is_same).then_some(())?;
            }
            Mistake::Numbers(parameter, numbers) => {
                candidate.scene = parameter.put(&candidate.scene, numbers)?
            }
            Mistake::Filter(width) if *width > 1.0 => candidate.looks.push(Look::Blur(*width)),
            Mistake::Filter(width) => candidate.behaviour.pixel = *width,
            Mistake::ColorsExchanged(one, other) => {
                let shapes =
                    [*one, *other].map(|at| Part::Shape(candidate.scene.objects[at].shape));
                let [first, second] = shapes.map(|shape| shape.value("color"));
                (first != second).then_some(())?;
                let objects = Arc::make_mut(&mut candidate.scene.objects);
                for (at, shape, color) in [(*one, shapes[0], second?), (*other, shapes[1], first?)]
                {
                    if let Part::Shape(shape) = shape.with("color", color)? {
                        objects[at].shape = shape;
                    }
                }
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
        Self::of(scene, mistakes)
    }

    /// Whether it does nothing to light but exchange channels, and mix it with that beside it.
    pub fn keeps_light(&self) -> bool {
        let mut looks = self.looks.iter();
        let keeps = |look: &Look| {
            matches!(
                look,
                Look::Channels(_) | Look::Gray(_) | Look::Blur(_) | Look::Sharpened
            )
        };
        self.curve == Curve::Right && looks.all(keeps)
    }

    /// Whether what is seen is moved by pixels or parts of them.
    pub fn is_shifted(&self) -> bool {
        self.behaviour.offset != [0.0; 2] || self.behaviour.spread != [1.0; 2]
    }

    /// Whether pixels are wider or narrower than they should be.
    pub fn is_filtered(&self) -> bool {
        let mut mistakes = self.mistakes.iter();
        mistakes.any(|one| matches!(one, Mistake::Filter(_)))
    }

    /// Whether what it shows is known exactly.
    pub fn is_exact(&self) -> bool {
        self.behaviour.is_right() && !self.is_filtered()
    }

    /// Whether it has the same mistakes as another one, but for their numbers, or is the same
    /// program.
    pub fn is_alike(&self, other: &Self) -> bool {
        if self.looks.is_empty() && other.looks.is_empty() && self.shows_as(other) {
            return true;
        }
        let mut own = self.mistakes.iter();
        let has = |one: &Mistake| other.mistakes.iter().any(|it| it.is_alike(one));
        self.mistakes.len() == other.mistakes.len() && own.all(has)
    }

    /// Whether it is the same program as another one, but for what they do to light.
    pub fn shows_as(&self, other: &Self) -> bool {
        self.traces_as(other)
            && self.behaviour == other.behaviour
            && self.curve == other.curve
            && self.layout == other.layout
    }

    /// Whether it traces what another one does, but for how they behave, and for what they do then.
    pub fn traces_as(&self, other: &Self) -> bool {
        let (one, two) = (&self.scene, &other.scene);
        one.camera == two.camera
            && one.image == two.image
            && self.averaged == other.averaged
            && self.is_drawn == other.is_drawn
            && (Arc::ptr_eq(&one.objects, &two.objects) || one.objects == two.objects)
    }

    /// How many numbers were fitted.
    pub fn fitted(&self) -> usize {
        self.mistakes.iter().map(Mistake::fitted).sum()
    }
}
