//! A hypothesis about the program that made a picture: the scene that it renders, how it behaves,
//! and what it does to the picture's light.

use std::sync::Arc;

use super::{
    behaviour::{Behaviour, Rays},
    layout::Layout,
    light::{Curve, Effect},
    parameters::{Owner, Parameter},
};
use crate::scene::{FieldOwner as Part, Scene};

/// One mistake of a program.
#[derive(Clone, Debug, PartialEq)]
pub enum Mistake {
    /// A row of the table of mistakes. The number is the index of an object, if the row is about a
    /// single object.
    Row(&'static MistakeRow, Option<usize>),
    /// The program uses wrong numbers for a field of the scene. The values are the field and these
    /// numbers.
    Numbers(Parameter, Vec<f64>),
    /// The picture has an extra patch, i.e. an area of one colour that is not in the scene. The
    /// values are its colour, in linear light, and its bounding rectangle in pixels: the least
    /// column and row, then the greatest.
    Patch([f64; 3], [[f64; 2]; 2]),
    /// Two objects of one colour each have exchanged their colours. The numbers are the objects'
    /// indices.
    ColorsExchanged(usize, usize),
    /// The pixel filter is too wide or too narrow. The number is its width, in pixels.
    Filter(f64),
    /// All samples are shifted by less than half a pixel. The numbers are the shift to the right
    /// and down, in pixels of the picture's file.
    Shift([f64; 2]),
}

/// A row of the table of known mistakes (module `mistakes`).
#[derive(Debug)]
pub struct MistakeRow {
    /// Stable identifier, for programs. Variants of a mistake share it.
    pub id: &'static str,
    /// Where in the picture the mistake is visible.
    pub shows: Shows,
    /// Message that says what is wrong. If the row is about a single object, the object's name is
    /// put before the message.
    pub message: &'static str,
    /// Advice on how to correct the mistake.
    pub help: &'static str,
    /// Function that applies the mistake to a hypothesis. Its second argument is the object's
    /// index. Rows that are not about an object ignore it.
    pub change: fn(&mut Candidate, usize),
}

impl PartialEq for MistakeRow {
    fn eq(&self, other: &Self) -> bool {
        (self.id, self.message) == (other.id, other.message)
    }
}

/// Where in a picture a mistake is visible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// The mistake is visible inside areas of one colour.
    InAreas,
    /// The mistake is visible only at edges, where colours meet.
    AtEdges,
    /// The mistake is weakly visible both inside areas of one colour and at edges. It is tried
    /// together with the mistakes at edges, but only if areas of one colour differ from the
    /// prediction.
    Everywhere,
}

impl Mistake {
    /// Returns whether two mistakes are the same except for their numbers.
    pub fn is_same_kind(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Numbers(one, _), Self::Numbers(other, _)) => one == other,
            (Self::Patch(..), Self::Patch(..))
            | (Self::Filter(_), Self::Filter(_))
            | (Self::Shift(_), Self::Shift(_)) => true,
            _ => self == other,
        }
    }

    /// Returns the index of the object that the mistake is about. If the mistake changes all
    /// objects of a block of the scene's file, returns the index of the first. Returns `None` if
    /// the mistake is about no object, or about two objects whose colours are exchanged.
    pub fn object(&self) -> Option<usize> {
        match self {
            Self::Row(_, object) => *object,
            Self::Numbers(parameter, _) => match parameter.owner {
                Owner::Object(index) => Some(index),
                Owner::Image | Owner::Camera => None,
            },
            Self::Patch(..) | Self::Filter(_) | Self::Shift(_) | Self::ColorsExchanged(..) => None,
        }
    }

    /// Returns whether the mistake is a wrong number in a field that sets how much the camera sees:
    /// the angle of view, the distance of the view plane, or its height.
    pub fn is_size(&self) -> bool {
        const SIZES: [&str; 4] = ["d", "fov", "hfov", "view_height"];
        matches!(self, Self::Numbers(parameter, _)
            if parameter.owner == Owner::Camera && SIZES.contains(&parameter.fields[0]))
    }

    /// Returns the number of parameters that describe the mistake. The more parameters a hypothesis
    /// has, the better it must explain the picture to be chosen.
    pub fn parameter_count(&self) -> usize {
        match self {
            Self::Row(..) | Self::ColorsExchanged(..) => 1,
            // One parameter for the choice of the field, and one for each of its numbers.
            Self::Numbers(_, numbers) => 1 + numbers.len(),
            // One parameter for the choice of the mistake, three for a colour, and four for a
            // rectangle.
            Self::Patch(..) => 8,
            Self::Filter(_) | Self::Shift(_) => 2,
        }
    }
}

/// A hypothesis about the program that made a picture: the mistakes that it makes, and their
/// effects on the scene, on the traced rays and on the picture's light.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Scene that the program renders.
    pub scene: Scene,
    /// Whether the program draws each of the scene's objects.
    pub is_drawn: Vec<bool>,
    /// How the program traces rays and places samples.
    pub behaviour: Behaviour,
    /// Encoding curve that the program inverts to decode the scene's colours, before it averages
    /// them.
    pub decoding: Curve,
    /// Curve by which the program encodes averaged colours in the picture's file.
    pub curve: Curve,
    /// How the program arranges pixels in the picture.
    pub layout: Layout,
    /// Changes that the program makes to the picture's light after tracing, in order of
    /// application.
    pub effects: Vec<Effect>,
    /// Mistakes that turn a correct program into this one.
    pub mistakes: Vec<Mistake>,
}

impl Candidate {
    /// Returns the hypothesis that the program has no mistakes.
    pub fn correct(scene: &Scene) -> Self {
        Self {
            scene: scene.clone(),
            is_drawn: vec![true; scene.objects.len()],
            behaviour: Behaviour::default(),
            decoding: Curve::Correct,
            curve: Curve::Correct,
            layout: Layout::default(),
            effects: Vec::new(),
            mistakes: Vec::new(),
        }
    }

    /// Returns a hypothesis with the given mistakes, added in this order. Returns `None` if
    /// [`Self::with`] rejects one of them.
    pub fn of(scene: &Scene, mistakes: impl IntoIterator<Item = Mistake>) -> Option<Self> {
        let mut mistakes = mistakes.into_iter();
        mistakes.try_fold(Self::correct(scene), |candidate, one| candidate.with(one))
    }

    /// Returns the hypothesis of a program that renders the same scene without mistakes. Objects
    /// that this hypothesis does not draw are not drawn either.
    pub fn drawn_correctly(&self) -> Self {
        Self {
            is_drawn: self.is_drawn.clone(),
            ..Self::correct(&self.scene)
        }
    }

    /// Returns a copy of the hypothesis with one more mistake. Returns `None` if the mistake is
    /// impossible in the scene, or if it is a row of the table or an exchange of colours that
    /// changes nothing.
    pub fn with(&self, mistake: Mistake) -> Option<Self> {
        let mut candidate = self.clone();
        match &mistake {
            Mistake::Row(row, object) => {
                (row.change)(&mut candidate, object.unwrap_or_default());
                let camera = Part::Camera(candidate.scene.camera);
                let shape = object.map(|object| Part::Shape(candidate.scene.objects[object].shape));
                let is_possible = camera.is_possible() && shape.is_none_or(|it| it.is_possible());
                let is_same =
                    candidate.shows_as(self) && candidate.effects.len() == self.effects.len();
                if !is_possible || is_same {
                    return None;
                }
            }
            Mistake::Numbers(parameter, numbers) => {
                candidate.scene = parameter.put(&candidate.scene, numbers)?
            }
            Mistake::Filter(width) if *width > 1.0 => candidate.effects.push(Effect::Blur(*width)),
            Mistake::Filter(width) => candidate.behaviour.pixel = *width,
            Mistake::Shift(by) => {
                candidate.behaviour.offset = candidate.layout.source_direction(*by);
            }
            Mistake::ColorsExchanged(one, other) => {
                let shapes =
                    [*one, *other].map(|at| Part::Shape(candidate.scene.objects[at].shape));
                let [first, second] = shapes.map(|shape| shape.value("color"));
                if first == second {
                    return None;
                }
                let objects = candidate.scene.objects_mut();
                for (at, shape, color) in [(*one, shapes[0], second?), (*other, shapes[1], first?)]
                {
                    if let Part::Shape(shape) = shape.with("color", color)? {
                        objects[at].shape = shape;
                    }
                }
            }
            Mistake::Patch(light, area) => candidate.effects.push(Effect::Patch {
                light: *light,
                area: *area,
            }),
        }
        candidate.mistakes.push(mistake);
        Some(candidate)
    }

    /// Iterates over the mistakes that are wrong numbers ([`Mistake::Numbers`]). Each item is a
    /// field of the scene and the wrong numbers of the field.
    pub fn numeric(&self) -> impl Iterator<Item = (&Parameter, &[f64])> {
        self.mistakes.iter().filter_map(|mistake| match mistake {
            Mistake::Numbers(parameter, numbers) => Some((parameter, &numbers[..])),
            _ => None,
        })
    }

    /// Returns the wrong numbers of all mistakes, one after another.
    pub fn numbers(&self) -> Vec<f64> {
        self.numeric()
            .flat_map(|(_, numbers)| numbers.to_vec())
            .collect()
    }

    /// Returns for each wrong number, in the order of [`Self::numbers`], by how much it must be
    /// changed to move the picture by about `pixels` pixels.
    pub fn steps(&self, pixels: f64) -> Vec<f64> {
        let steps = |(parameter, _): (&Parameter, _)| parameter.steps(&self.scene, pixels);
        self.numeric().flat_map(steps).collect()
    }

    /// Replaces the wrong numbers of all mistakes by `numbers`, which are in the order of
    /// [`Self::numbers`]. Returns `None` if a number is impossible in the scene, such as a negative
    /// radius.
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

    /// Returns whether the program keeps the mean light of an area, apart from mixing or exchanging
    /// channels. It does so if it encodes light correctly, and if it changes light at most by
    /// mixing or exchanging channels, blurring or sharpening.
    pub fn keeps_light(&self) -> bool {
        let mut effects = self.effects.iter();
        let keeps = |effect: &Effect| {
            matches!(
                effect,
                Effect::Channels(_) | Effect::Gray(_) | Effect::Blur(_) | Effect::Sharpened
            )
        };
        self.curve == Curve::Correct && effects.all(keeps)
    }

    /// Returns whether the pixel filter is wider or narrower than a pixel.
    pub fn is_filtered(&self) -> bool {
        let mut mistakes = self.mistakes.iter();
        mistakes.any(|one| matches!(one, Mistake::Filter(_)))
    }

    pub fn has_parallel_rays(&self) -> bool {
        matches!(self.behaviour.rays, Rays::Parallel(_))
    }

    /// Returns whether the program's picture can be computed exactly, without samples.
    pub fn is_exact(&self) -> bool {
        self.behaviour.is_correct() && !self.is_filtered()
    }

    /// Returns whether both hypotheses have the same mistakes, except for the mistakes' numbers.
    /// Also returns `true` if different mistakes lead to equal programs ([`Self::shows_as`])
    /// without `effects` on light.
    pub fn is_same_kind(&self, other: &Self) -> bool {
        if self.effects.is_empty() && other.effects.is_empty() && self.shows_as(other) {
            return true;
        }
        let mut own = self.mistakes.iter();
        let has = |one: &Mistake| other.mistakes.iter().any(|it| it.is_same_kind(one));
        self.mistakes.len() == other.mistakes.len() && own.all(has)
    }

    /// Returns whether both programs are equal, apart from their `effects` on the picture's light.
    pub fn shows_as(&self, other: &Self) -> bool {
        self.traces_as(other)
            && self.behaviour == other.behaviour
            && self.curve == other.curve
            && self.layout == other.layout
    }

    /// Returns whether both hypotheses render the same scene and decode colours in the same way.
    /// They may differ in how they trace rays, arrange pixels and encode light.
    pub fn traces_as(&self, other: &Self) -> bool {
        let (one, two) = (&self.scene, &other.scene);
        one.camera == two.camera
            && one.image == two.image
            && self.decoding == other.decoding
            && self.is_drawn == other.is_drawn
            && (Arc::ptr_eq(&one.objects, &two.objects) || one.objects == two.objects)
    }

    /// Returns the number of parameters that describe all mistakes.
    pub fn parameter_count(&self) -> usize {
        self.mistakes.iter().map(Mistake::parameter_count).sum()
    }
}
