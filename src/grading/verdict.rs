//! What is said of a picture, for people and for programs.

use serde_json::{Map, Value, json};

use super::objects::{self, ObjectVerdict};
use crate::{numbers::short, scene::Scene};

/// What a picture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Equal to the exact one within its tolerance.
    Right,
    /// Right but for sampling noise.
    Noise,
    /// Wrong, and mistakes are named.
    Wrong,
    /// Wrong, and no mistake that is known explains it.
    Unknown,
}

impl Kind {
    /// The word for programs.
    pub fn word(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Noise => "noise",
            Self::Wrong => "wrong",
            Self::Unknown => "unknown",
        }
    }
}

/// A mistake that is told.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMistake {
    /// A word for programs.
    pub id: &'static str,
    /// What it is.
    pub message: String,
    /// The way out.
    pub help: String,
    /// The `--set` arguments that make it.
    pub set: Vec<String>,
    /// The share of the squared difference beyond noise that it explains.
    pub explains: f64,
}

/// What is said of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// What it is.
    pub kind: Kind,
    /// How many independent samples in a pixel leave as much noise; none where it is not known.
    pub samples: Option<f64>,
    /// The mistakes: together they explain the picture.
    pub mistakes: Vec<NamedMistake>,
    /// The mistakes that come nearest, where none that are known explain the picture.
    pub guesses: Vec<NamedMistake>,
    /// The share of the squared difference beyond noise that mistakes or guesses leave, if it is
    /// more than noise.
    pub rest: Option<f64>,
    /// The objects.
    pub objects: Vec<ObjectVerdict>,
    /// Whether the background is right.
    pub is_background_right: bool,
    /// Whether the picture's file is a JPEG, which changes colours.
    pub is_coded: bool,
    /// Whether not all mistakes were tried, as the scene has too much in it.
    pub is_cut: bool,
}

impl Verdict {
    /// One without mistakes.
    pub fn of(kind: Kind, scene: &Scene) -> Self {
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

    /// The same of a picture of which something else is plain to see: it is told first.
    pub fn beside(mut self, fact: NamedMistake) -> Self {
        match self.kind {
            Kind::Unknown => self.guesses.insert(0, fact),
            Kind::Right | Kind::Noise | Kind::Wrong => {
                self.kind = Kind::Wrong;
                self.mistakes.insert(0, fact);
            }
        }
        self
    }

    /// The verdict in one line.
    pub fn line(&self) -> String {
        match (self.kind, self.samples) {
            (Kind::Right, _) => "right: equal to the exact picture".to_owned(),
            (Kind::Noise, Some(samples)) => {
                let count = match samples < 9.5 {
                    true => (2.0 * samples).round() / 2.0,
                    false => samples.round(),
                };
                let count = short(count);
                format!("right but for sampling noise: about {count} random samples per pixel")
            }
            (Kind::Noise, None) if self.is_coded => {
                "right but for sampling noise and what JPEG changes".to_owned()
            }
            (Kind::Noise, None) => "right but for sampling noise".to_owned(),
            (Kind::Wrong, _) => format!("wrong: {}", messages(&self.mistakes)),
            (Kind::Unknown, _) => {
                let nearest = match &self.guesses[..] {
                    [] => String::new(),
                    guesses => {
                        format!("; this comes nearest{}: {}", self.left(), messages(guesses))
                    }
                };
                let limit = match self.is_cut {
                    true => "; the search came to its bound (--effort 4 goes on)",
                    false => "",
                };
                format!("wrong, and not by a mistake known here{nearest}{limit}")
            }
        }
    }

    /// What guesses leave, in words.
    fn left(&self) -> String {
        match self.rest.map(|rest| (100.0 * rest).round()) {
            Some(percent) if percent > 0.0 => format!(", and leaves {percent} % unexplained"),
            _ => String::new(),
        }
    }

    /// The same for programs, field by field.
    pub fn to_json(&self) -> Map<String, Value> {
        let objects = self.objects.iter().map(|object| {
            json!({ "index": object.index, "name": object.name, "right": object.is_right, "off": object.off })
        });
        let fields = [
            ("verdict", json!(self.kind.word())),
            ("line", json!(self.line())),
            ("samples_per_pixel", json!(self.samples)),
            ("mistakes", json_of(&self.mistakes)),
            ("guesses", json_of(&self.guesses)),
            ("objects", objects.collect()),
        ];
        let rest = self.rest.map(|rest| ("rest", json!(rest)));
        let fields = fields.into_iter().chain(rest);
        fields
            .chain([("limited", json!(self.is_cut))])
            .map(|(name, value)| (name.to_owned(), value))
            .collect()
    }
}

/// What mistakes are, one after the other.
fn messages(mistakes: &[NamedMistake]) -> String {
    let messages: Vec<_> = mistakes.iter().map(|one| &one.message[..]).collect();
    messages.join("; ")
}

fn json_of(mistakes: &[NamedMistake]) -> Value {
    let fields = |mistake: &NamedMistake| {
        json!({
            "id": mistake.id,
            "message": mistake.message,
            "help": mistake.help,
            "set": mistake.set,
            "explains": mistake.explains,
        })
    };
    mistakes.iter().map(fields).collect()
}
