//! The verdict on a picture, for people and for programs.

use std::fmt;

use super::objects::{self, ObjectVerdict};
use crate::{
    numbers::{short, significant},
    scene::Scene,
};

/// The result of judging a picture, in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// The picture equals the exact one within its tolerance.
    Right,
    /// The picture is right except for sampling noise.
    Noise,
    /// The picture is wrong, and the mistakes are named.
    Wrong,
    /// The picture is wrong, and no known mistake explains it.
    Unknown,
}

impl Kind {
    /// Returns the result as a word, for programs.
    pub fn word(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Noise => "noise",
            Self::Wrong => "wrong",
            Self::Unknown => "unknown",
        }
    }
}

/// A mistake, described in words.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NamedMistake {
    /// Stable identifier, for programs.
    pub id: &'static str,
    /// Index of the object that the mistake is about. `None` if the mistake is not about a single
    /// object.
    pub object: Option<usize>,
    /// Message that says what is wrong.
    pub message: String,
    /// Advice on how to correct the mistake.
    pub help: String,
    /// `--set` arguments by which a correct program reproduces the mistake.
    pub set: Vec<String>,
    /// Fraction of the squared difference between the picture and the exact one that the mistake
    /// explains. Noise is subtracted from this difference first.
    pub explains: f64,
}

/// The verdict on a picture.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Verdict {
    /// The result in one word.
    pub kind: Kind,
    /// Number of independent samples per pixel that would cause as much noise as the picture has;
    /// `None` if it is unknown.
    pub samples: Option<f64>,
    /// The mistakes that together explain the picture.
    pub mistakes: Vec<NamedMistake>,
    /// Mistakes that come closest to the picture without explaining it, or explain it but are
    /// implausible. Empty if plausible mistakes explain the picture, or if no known mistakes come
    /// close to it.
    pub guesses: Vec<NamedMistake>,
    /// Fraction of the squared difference between the picture and the exact one that the guesses do
    /// not explain. Differences that noise can explain are ignored. `None` if the guesses leave
    /// only noise, or if there are none.
    pub rest: Option<f64>,
    /// The verdict on each object.
    pub objects: Vec<ObjectVerdict>,
    /// Whether the picture shows the background correctly.
    pub is_background_right: bool,
    /// Whether the picture's file is a JPEG or a lossy WebP, whose coding changes colours.
    pub is_coded: bool,
    /// Whether the search used up its budget of work before it tried all mistakes.
    pub is_cut: bool,
}

impl Verdict {
    /// Returns a verdict without mistakes.
    pub fn without_mistakes(kind: Kind, scene: &Scene) -> Self {
        Self {
            kind,
            samples: None,
            mistakes: Vec::new(),
            guesses: Vec::new(),
            rest: None,
            objects: objects::right(scene),
            is_background_right: true,
            is_coded: false,
            is_cut: false,
        }
    }

    /// Adds an obvious fact, such as transparency, before all mistakes or guesses. The verdict's
    /// kind becomes [`Kind::Wrong`], unless it is [`Kind::Unknown`].
    pub fn with_fact(mut self, fact: NamedMistake) -> Self {
        match self.kind {
            Kind::Unknown => self.guesses.insert(0, fact),
            Kind::Right | Kind::Noise | Kind::Wrong => {
                self.kind = Kind::Wrong;
                self.mistakes.insert(0, fact);
            }
        }
        self
    }

    /// Returns the verdict as one line of text.
    pub fn line(&self) -> String {
        match (self.kind, self.samples) {
            (Kind::Right, _) => "right: equal to the exact picture".to_owned(),
            (Kind::Noise, Some(samples)) => {
                let count = about(samples);
                format!("right but for sampling noise: about {count} random samples per pixel")
            }
            (Kind::Noise, None) if self.is_coded => {
                "right but for sampling noise and what lossy compression changes".to_owned()
            }
            (Kind::Noise, None) => "right but for sampling noise".to_owned(),
            (Kind::Wrong, _) => format!("wrong: {}", messages(&self.mistakes)),
            (Kind::Unknown, _) => {
                let nearest = match &self.guesses[..] {
                    [] => String::new(),
                    guesses => {
                        let left = self.unexplained();
                        format!("; this comes nearest{left}: {}", messages(guesses))
                    }
                };
                let limit = if self.is_cut {
                    "; the search stopped at its limit"
                } else {
                    ""
                };
                format!("wrong, and not by a mistake known here{nearest}{limit}")
            }
        }
    }

    /// Returns in words how much the guesses leave unexplained.
    fn unexplained(&self) -> String {
        match self.rest.map(|rest| (100.0 * rest).round()) {
            Some(percent) if percent > 0.0 => format!(", and leaves {percent} % unexplained"),
            _ => String::new(),
        }
    }
}

/// Writes the verdict in one line.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line())
    }
}

/// Formats an estimated number of samples with two significant digits, because the estimate is
/// hardly more precise.
pub fn about(samples: f64) -> String {
    short(significant(samples, 2))
}

/// Joins the messages of mistakes.
fn messages(mistakes: &[NamedMistake]) -> String {
    let messages: Vec<_> = mistakes.iter().map(|one| &one.message[..]).collect();
    messages.join("; ")
}
