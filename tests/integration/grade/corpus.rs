//! The pictures by which grading is judged: the two scenes, right or with up to three mistakes, in several sizes and ways of sampling;
//! and how an answer of `diff --format json` is judged.

use image::RgbImage;
use serde_json::Value;

use super::{
    mistakes::{
        Mistake, OF_THE_BOARD, OF_THE_CAMERA, OF_THE_OBJECTS, OF_THE_PICTURE, figure, street,
    },
    textbook::{Program, Sampling},
};

/// A picture, and what is wrong with it.
#[derive(Clone)]
pub struct Case {
    /// The right program.
    pub right: Program,
    /// Those that were made, in this order.
    pub mistakes: Vec<&'static Mistake>,
    /// Which scene, mistakes, size and sampling these are.
    pub title: String,
}

impl Case {
    /// Its picture.
    pub fn picture(&self) -> RgbImage {
        self.program(|_| true).render()
    }

    /// Whether each of the mistakes shows: the picture without it differs by more than the step that rounding may cost.
    pub fn is_seen(&self) -> bool {
        let program = self.program(|_| true);
        let picture = program.render();
        // Bytes that are cut off differ by one step.
        let least = u8::from(!program.cuts_bytes);
        (0..self.mistakes.len()).all(|left_out| {
            let other = self.program(|index| index != left_out).render();
            let mut bytes = picture.as_raw().iter().zip(other.as_raw());
            bytes.any(|(a, b)| a.abs_diff(*b) > least)
        })
    }

    /// The program with some of its mistakes.
    fn program(&self, is_made: impl Fn(usize) -> bool) -> Program {
        let mut program = self.right.clone();
        for (_, mistake) in self
            .mistakes
            .iter()
            .enumerate()
            .filter(|one| is_made(one.0))
        {
            (mistake.make)(&mut program);
        }
        program
    }

    /// Judges what `diff` says.
    pub fn judge(&self, answer: &Value) -> Judgement {
        let said = answer["mistakes"].as_array().map_or(&[][..], Vec::as_slice);
        if self.mistakes.is_empty() {
            return match answer["verdict"].as_str() {
                Some("right" | "noise") => Judgement::Right,
                _ => Judgement::False,
            };
        }
        if answer["verdict"] == "right" || answer["verdict"] == "noise" {
            return Judgement::Missed;
        }
        let found = self
            .mistakes
            .iter()
            .filter(|mistake| is_said(mistake, said));
        match found.count() {
            count if count == self.mistakes.len() && said.len() == count => Judgement::Right,
            count if count == self.mistakes.len() => Judgement::TooMany,
            0 if said.is_empty() => Judgement::Unknown,
            0 => Judgement::False,
            _ => Judgement::Partly,
        }
    }
}

/// Whether a mistake is among those that were said.
fn is_said(mistake: &Mistake, said: &[Value]) -> bool {
    mistake.name.split('|').any(|name| {
        let (id, object) = name.split_once(' ').unwrap_or((name, ""));
        said.iter().any(|said| {
            let sets = said["set"].as_array().map_or(&[][..], Vec::as_slice);
            let message = said["message"].as_str().unwrap_or_default();
            let is_set = |set: &Value| {
                set.as_str()
                    .and_then(|set| set.split_once('='))
                    .is_some_and(|set| set.0 == name)
            };
            sets.iter().any(is_set) || (said["id"] == id && message.contains(object))
        })
    })
}

/// How well an answer describes a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Judgement {
    /// All mistakes and nothing else.
    Right,
    /// All mistakes, and others.
    TooMany,
    /// Some of the mistakes.
    Partly,
    /// Wrong, but why is not known.
    Unknown,
    /// A wrong picture is called right.
    Missed,
    /// Something else.
    False,
}

/// The sizes of pictures.
pub const SIZES: [[u32; 2]; 3] = [[96, 64], [320, 180], [640, 360]];

/// The ways of sampling: 256 samples stand for the exact mean.
pub fn samplings() -> impl Iterator<Item = (Sampling, u32)> {
    use Sampling::{Hammersley, Jittered, Random, Regular};
    let few = [1, 4, 16].into_iter().flat_map(|samples| {
        [Random, Jittered, Regular, Hammersley].map(|sampling| (sampling, samples))
    });
    few.chain([(Regular, 256)])
}

/// Every kind of mistake.
pub fn kinds() -> impl Iterator<Item = &'static Mistake> {
    [OF_THE_PICTURE, OF_THE_CAMERA, OF_THE_BOARD, OF_THE_OBJECTS]
        .into_iter()
        .flatten()
}

/// Sets of mistakes: none, each, and pairs and triples of different groups.
pub fn sets(count: usize) -> Vec<Vec<&'static Mistake>> {
    let of = |group: &'static [Mistake], index: usize| group.get(index % group.len());
    let pairs = |(index, object)| {
        [
            vec![Some(object), of(OF_THE_CAMERA, index)],
            vec![Some(object), of(OF_THE_BOARD, index)],
            vec![Some(object), of(OF_THE_OBJECTS, index + 9)],
            vec![Some(object), of(OF_THE_PICTURE, index)],
        ]
    };
    let triples = |(index, object)| {
        vec![
            Some(object),
            of(OF_THE_CAMERA, index),
            of(OF_THE_OBJECTS, index + 9),
        ]
    };
    let objects = OF_THE_OBJECTS.iter().enumerate();
    let sets: Vec<Vec<Option<&Mistake>>> = match count {
        0 => vec![Vec::new()],
        1 => kinds().map(|kind| vec![Some(kind)]).collect(),
        2 => objects.flat_map(pairs).collect(),
        _ => objects.map(triples).collect(),
    };
    sets.into_iter()
        .map(|set| set.into_iter().flatten().collect())
        .collect()
}

/// The pictures with so many mistakes, of a size and a way of sampling; also those in which a mistake is not seen.
pub fn cases(count: usize, size: [u32; 2], (sampling, samples): (Sampling, u32)) -> Vec<Case> {
    let mut cases = Vec::new();
    for (scene, program) in [("figure", figure()), ("street", street())] {
        let right = Program {
            size,
            sampling,
            samples,
            ..program
        };
        for mistakes in sets(count) {
            let names = mistakes
                .iter()
                .map(|mistake| mistake.name.split('|').next());
            let names: Vec<&str> = names.flatten().collect();
            let names = match names.as_slice() {
                [] => "right".to_owned(),
                names => names.join(", "),
            };
            let title = format!(
                "{scene} {}x{} {samples} {sampling:?}: {names}",
                size[0], size[1],
            );
            let right = right.clone();
            cases.push(Case {
                right,
                mistakes,
                title,
            });
        }
    }
    cases
}
