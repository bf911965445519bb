//! What is wrong with a picture of a scene.
//!
//! In: a picture that somebody made of a scene, the scene, and its exact picture. Out: a verdict: right, right but for sampling noise, wrong by mistakes that
//! are named, or wrong for an unknown reason; and how far each object is off.
//!
//! `mistakes` is the table of what a class gets wrong, `parameters` are the numbers of the scene; a `candidate` is a program that has some of them wrong,
//! in its scene, in its `layout`, in what it does to `light`, or in how it behaves. What it shows on a `grid` is `made` exactly, or by the tracer in `textbook`
//! where it behaves as no scene can say; `score` says how likely somebody's picture is then, and `fit` finds `numbers`. A `search` holds
//! the picture, `select` chooses mistakes, a `patch` being the last of them, and `words` says them.

mod candidate;
mod changes;
mod fit;
mod grid;
mod layout;
mod light;
mod made;
mod mistakes;
mod numbers;
mod parameters;
mod patch;
mod score;
mod search;
mod select;
mod textbook;
mod words;

use std::sync::OnceLock;

use serde_json::{Map, Value, json};

use crate::{
    area::Area,
    film::{Comparison, Film},
    render::{Control, RenderError},
    scene::Scene,
};

use self::{
    candidate::Candidate,
    light::{Average, Curve},
    made::exact_moments,
    score::{Model, Strays, score},
    search::{Found, Search},
    textbook::Moments,
};

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

/// A mistake.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
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

/// An object.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectVerdict {
    /// Its place in the file.
    pub index: usize,
    /// Its name.
    pub name: Option<String>,
    /// What it is called.
    pub title: String,
    /// Whether it is right.
    pub is_right: bool,
    /// By how many pixels it is off.
    pub off: f64,
}

/// What is said of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// What it is.
    pub kind: Kind,
    /// How many independent samples in a pixel leave as much noise; none where it is not known.
    pub samples: Option<f64>,
    /// The mistakes.
    pub mistakes: Vec<Mistake>,
    /// The share of the squared difference beyond noise that mistakes leave, if it is more than noise.
    pub rest: Option<f64>,
    /// The objects, where something is known of them.
    pub objects: Vec<ObjectVerdict>,
    /// Whether the background is right.
    pub is_background_right: bool,
    /// Whether not all mistakes were tried, as the scene has too much in it.
    pub is_cut: bool,
}

/// What pictures of a part of a scene's are judged by: made once, for a whole class.
pub struct Reference<'a> {
    scene: &'a Scene,
    part: Area,
    /// The exact means and variances, made when they are asked for.
    moments: OnceLock<Moments>,
}

impl<'a> Reference<'a> {
    /// Of a part of a scene's picture.
    pub fn new(scene: &'a Scene, part: Area) -> Self {
        Self {
            scene,
            part,
            moments: OnceLock::new(),
        }
    }

    /// Judges a picture; `comparison` is that with the exact one.
    ///
    /// # Errors
    ///
    /// There is no memory for another picture, or it is not wanted any more.
    pub fn judge(
        &self,
        film: &Film,
        comparison: &Comparison,
        control: &Control,
    ) -> Result<Verdict, RenderError> {
        if comparison.is_equal() {
            return Ok(Verdict::of(Kind::Right, self.scene));
        }
        let moments = match self.moments.get() {
            Some(moments) => moments,
            None => {
                let moments = exact_moments(self.scene, Average::Light, self.part, control.cancel)
                    .ok_or(RenderError::Cancelled)?;
                self.moments.get_or_init(|| moments)
            }
        };
        judged(film, self, moments, control)
    }
}

fn judged(
    film: &Film,
    reference: &Reference,
    moments: &Moments,
    control: &Control,
) -> Result<Verdict, RenderError> {
    let Reference { scene, part, .. } = *reference;
    let model = Model {
        moments: moments.clone(),
        doubt: Vec::new(),
        cut: 0.0,
        curve: Curve::Right,
    };
    let width = film.width() as usize;
    let noise = score(film.pixels(), &model);
    let search = Search::new(scene, film, part, control.cancel);
    let strays = Strays::new(film.pixels(), &model, width);
    let found = match strays.is_empty() {
        // All that differs lies where colours meet. Only what shows there can be wrong.
        true => select::with_edges(&search, Candidate::right(scene))?,
        false => select::run(&search)?,
    };
    let mut verdict = match found {
        Some(found) if !found.candidate.named.is_empty() => wrong(&search, &found),
        _ if strays.is_negligible() => Verdict {
            samples: noise.samples,
            ..Verdict::of(Kind::Noise, scene)
        },
        _ => Verdict::of(Kind::Unknown, scene),
    };
    verdict.is_cut = search.is_cut.get();
    Ok(verdict)
}

/// The verdict on a picture with mistakes.
fn wrong(search: &Search, found: &Found) -> Verdict {
    let scene = search.scene;
    let named = &found.candidate.named;
    // The squared difference on the same grid for all, less what noise leaves of it in the end.
    let last = search.judged(found.candidate.clone());
    let noise = last.as_ref().map_or(0.0, |last| last.score.noise);
    let beyond =
        |found: Option<Found>| found.map_or(0.0, |found| (found.score.squares - noise).max(0.0));
    let at_last = beyond(last);
    let mut before = Candidate::right(scene);
    let all = beyond(search.judged(before.clone())).max(1e-12);
    let mut left = all;
    let mut mistakes = Vec::new();
    for one in named {
        let Some(after) = before.with(one.clone()) else {
            continue;
        };
        let now = match after.named.len() == named.len() {
            true => at_last,
            false => beyond(search.judged(after.clone())),
        };
        let set = parameters::arguments(&before.scene, &after.scene);
        let mut message = words::message(scene, one);
        if let (candidate::Cause::Row(_), [set]) = (&one.cause, set.as_slice())
            && let Some((target, value)) = set.split_once('=')
            && let Some(should) = parameters::arguments(&after.scene, &before.scene)
                .first()
                .and_then(|set| set.split_once('='))
            && should.0 == target
        {
            message = format!("{message}: {value} instead of {}", should.1);
        }
        mistakes.push(Mistake {
            id: one.id,
            message,
            help: one.help.clone(),
            set,
            explains: ((left - now) / all).clamp(0.0, 1.0),
        });
        (left, before) = (now, after);
    }
    let rest = (!search.strays(&found.candidate).is_negligible()).then(|| (at_last / all).min(1.0));
    let of = |object: usize| {
        let (own, other) = (&scene.objects[object], &before.scene.objects[object]);
        let off = words::off(scene, &before.scene, object);
        ObjectVerdict {
            is_right: own.shape == other.shape
                && before.is_drawn[object]
                && off < words::HALF_PIXEL,
            off: if before.is_drawn[object] { off } else { 0.0 },
            ..ObjectVerdict::right(scene, object)
        }
    };
    Verdict {
        samples: found.score.samples,
        rest: rest.filter(|rest| *rest > 0.0),
        mistakes,
        objects: (0..scene.objects.len()).map(of).collect(),
        is_background_right: scene.image.background == before.scene.image.background,
        ..Verdict::of(Kind::Wrong, scene)
    }
}

impl ObjectVerdict {
    fn right(scene: &Scene, index: usize) -> Self {
        Self {
            index,
            name: scene.objects[index].name.clone(),
            title: parameters::Owner::Object(index).name(scene),
            is_right: true,
            off: 0.0,
        }
    }
}

impl Verdict {
    fn of(kind: Kind, scene: &Scene) -> Self {
        let is_known = matches!(kind, Kind::Right | Kind::Noise);
        let objects = (0..scene.objects.len()).map(|object| ObjectVerdict::right(scene, object));
        Self {
            kind,
            samples: None,
            mistakes: Vec::new(),
            rest: None,
            objects: if is_known {
                objects.collect()
            } else {
                Vec::new()
            },
            is_background_right: is_known,
            is_cut: false,
        }
    }

    /// The verdict in one line.
    pub fn line(&self) -> String {
        match self.kind {
            Kind::Right => "right: equal to the exact picture".to_owned(),
            Kind::Noise => match self.samples {
                Some(samples) => {
                    let count = crate::numbers::short(if samples < 9.5 {
                        (2.0 * samples).round() / 2.0
                    } else {
                        samples.round()
                    });
                    format!("right but for sampling noise: about {count} samples per pixel")
                }
                None => "right but for sampling noise".to_owned(),
            },
            Kind::Wrong => {
                let mistakes: Vec<_> = self
                    .mistakes
                    .iter()
                    .map(|mistake| mistake.message.as_str())
                    .collect();
                format!("wrong: {}", mistakes.join("; "))
            }
            Kind::Unknown => "wrong, and not by a mistake known here".to_owned(),
        }
    }
}

/// A verdict for programs, field by field.
pub fn json(verdict: &Verdict) -> Map<String, Value> {
    let mistakes = verdict.mistakes.iter().map(|mistake| {
        json!({
            "id": mistake.id,
            "message": mistake.message,
            "help": mistake.help,
            "set": mistake.set,
            "explains": mistake.explains,
        })
    });
    let objects = verdict.objects.iter().map(|object| {
        json!({ "index": object.index, "name": object.name, "right": object.is_right, "off": object.off })
    });
    let mut fields = Map::new();
    fields.insert("verdict".to_owned(), json!(verdict.kind.word()));
    fields.insert("line".to_owned(), json!(verdict.line()));
    fields.insert("samples_per_pixel".to_owned(), json!(verdict.samples));
    fields.insert("mistakes".to_owned(), mistakes.collect());
    fields.insert("objects".to_owned(), objects.collect());
    if let Some(rest) = verdict.rest {
        fields.insert("rest".to_owned(), json!(rest));
    }
    fields.insert("limited".to_owned(), json!(verdict.is_cut));
    fields
}
