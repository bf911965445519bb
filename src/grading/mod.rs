//! What is wrong with a picture of a scene.
//!
//! In: a picture that somebody made of a scene, the scene, and its exact picture. Out: a verdict: right, right but for sampling noise, wrong by mistakes that
//! are named, or wrong for an unknown reason; and how far each object is off.
//!
//! `mistakes` is the table of what a class gets wrong, `parameters` are the numbers of the scene; a `candidate` is a program that has some of them wrong,
//! in its scene, in its `layout`, in what it does to `light`, or in how it behaves. What it shows on a `grid` is `made` exactly, or by the tracer in `textbook`
//! where it behaves as no scene can say, both from the same `axes`; `score` says how likely somebody's picture is then, and `fit` finds `numbers`. A `search`
//! holds the picture, but for its `empty_pixels`, a `level` for each grid; `select` chooses mistakes, a `patch` being the last of them, and `number_text` writes
//! their numbers. `work` is what is spent on a picture.

mod axes;
mod candidate;
mod changes;
mod empty_pixels;
mod fit;
mod grid;
mod jpeg;
mod layout;
mod level;
mod light;
mod made;
mod mistakes;
mod number_text;
mod numbers;
mod objects;
mod parameters;
mod patch;
mod score;
mod search;
mod select;
mod textbook;
mod work;

use std::{
    borrow::Cow,
    sync::{Arc, Mutex, PoisonError, atomic::AtomicBool},
};

use serde_json::{Map, Value, json};

use crate::{
    area::Area,
    cancel,
    color::srgb_to_linear,
    exact::Integrator,
    film::{Comparison, Film},
    render::{Control, Exact, RenderError, render_numbers},
    scene::Scene,
    tracer::World,
};

use self::{
    candidate::Candidate,
    empty_pixels::without_empty,
    light::Average,
    made::Made,
    score::WRONG,
    search::{Found, Search},
    textbook::Moments,
};
pub use self::{jpeg::Jpeg, objects::ObjectVerdict};

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
    /// The objects.
    pub objects: Vec<ObjectVerdict>,
    /// Whether the background is right.
    pub is_background_right: bool,
    /// Whether the picture's file is a JPEG, which changes colours.
    pub is_coded: bool,
    /// Whether not all mistakes were tried, as the scene has too much in it.
    pub is_cut: bool,
}

/// What pictures of a part of a scene's are judged by: made once for a whole class.
pub struct Reference<'a> {
    /// The exact picture.
    pub exact: Exact,
    scene: &'a Scene,
    part: Area,
    right: Arc<Made>,
    /// The work of making it.
    work: f64,
}

impl<'a> Reference<'a> {
    /// Makes the exact picture of a part of a scene's.
    ///
    /// # Errors
    ///
    /// It is cancelled, or too large.
    pub fn new(scene: &'a Scene, part: Area, control: &Control) -> Result<Self, RenderError> {
        let world = World::new_unless(scene, control.cancel)?;
        let integrator = Integrator::of(&world, light::numbers(Average::Light));
        let none = vec![[0.0; 3]; part.pixels() as usize];
        let all = Mutex::new(Moments {
            mean: none.clone(),
            variance: none,
        });
        let exact = render_numbers(&integrator, part, control, &|tile, pixels| {
            let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
            for ((x, y), pixel) in tile.iter().zip(pixels) {
                let at = part.index(x, y);
                (all.mean[at], all.variance[at]) = light::moments(pixel);
            }
        })?;
        let moments = all.into_inner().unwrap_or_else(PoisonError::into_inner);
        let work = work::of_exact(integrator.work(), scene.objects.len(), part.pixels());
        Ok(Self {
            exact,
            scene,
            part,
            right: Arc::new(Made::new(Candidate::right(scene), part, moments)),
            work,
        })
    }

    /// Judges a picture; `comparison` is that with the exact one, and `jpeg` is how its file is coded, if it is one.
    ///
    /// # Errors
    ///
    /// It is not wanted any more.
    pub fn judge(
        &self,
        film: &Film,
        jpeg: Option<Jpeg>,
        comparison: &Comparison,
        cancel: &AtomicBool,
    ) -> Result<Verdict, RenderError> {
        if comparison.is_equal() {
            return Ok(Verdict::of(Kind::Right, self.scene));
        }
        let empties = [self.scene.image.background.to_linear(), [0.0; 3]];
        let mut without = empties
            .iter()
            .filter_map(|empty| without_empty(film, self.right.moments(), *empty));
        let without = jpeg.is_none().then(|| without.next()).flatten();
        let film = without.map_or(Cow::Borrowed(film), Cow::Owned);
        let search = Search::new(self, &film, jpeg, cancel);
        judged(&search, &film, cancel)
    }
}

fn judged(search: &Search, film: &Film, cancel: &AtomicBool) -> Result<Verdict, RenderError> {
    let (scene, jpeg) = (search.scene, search.fine.jpeg);
    let found = select::run(search)?;
    // What was found is told, however much work that is.
    search.work.lift();
    let right = Candidate::right(scene);
    let mut verdict = match found {
        Some(found) if !found.candidate.named.is_empty() => wrong(search, &found),
        _ if search.has_no_strays(&right) && !has_other_colors(film, scene, jpeg) => {
            let judged = search.judged_on(&search.fine, right, None);
            Verdict {
                samples: judged.and_then(|judged| judged.score.samples),
                ..Verdict::of(Kind::Noise, scene)
            }
        }
        _ => {
            let (objects, is_background_right) = objects::judged(search, &right);
            Verdict {
                objects,
                is_background_right,
                ..Verdict::of(Kind::Unknown, scene)
            }
        }
    };
    verdict.is_coded = jpeg.is_some();
    verdict.is_cut = search.work.is_cut();
    Ok(cancel::unless_set(cancel, verdict)?)
}

/// Whether a picture has a channel that is less or more than in all colours of the scene, which no mean of them is.
fn has_other_colors(film: &Film, scene: &Scene, jpeg: Option<Jpeg>) -> bool {
    let colors = scene.objects.iter();
    let colors = colors.flat_map(|object| object.shape.colors());
    let all = colors.chain([scene.image.background]);
    let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for srgb in all.map(|color| color.srgb) {
        for i in 0..3 {
            (least[i], most[i]) = (least[i].min(srgb[i]), most[i].max(srgb[i]));
        }
    }
    let least = least.map(|srgb| srgb_to_linear((srgb - WRONG) / 255.0));
    let most = most.map(|srgb| srgb_to_linear((srgb + WRONG) / 255.0));
    let is_other = |pixel: &[f64; 3]| (0..3).any(|i| pixel[i] < least[i] || pixel[i] > most[i]);
    // JPEG has colours overshoot where they meet.
    jpeg.is_none() && film.pixels().iter().any(is_other)
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
        let mut message = number_text::message(scene, one);
        if let (candidate::Cause::Row(_), [set]) = (&one.cause, set.as_slice())
            && set != parameters::UNLIMITED
            && let Some((target, value)) = set.split_once('=')
            && let Some(should) = parameters::arguments(&after.scene, &before.scene)
                .first()
                .and_then(|set| set.split_once('='))
            && should.0 == target
        {
            let written = |value: &str| {
                value
                    .parse()
                    .map_or(value.to_owned(), crate::numbers::short)
            };
            let [is, should] = [value, should.1].map(written);
            message = format!("{message}: {is} instead of {should}");
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
    let rest = (!search.has_no_strays(&found.candidate)).then(|| (at_last / all).min(1.0));
    let (objects, is_background_right) = objects::judged(search, &found.candidate);
    Verdict {
        samples: found.score.samples,
        rest: rest.filter(|rest| *rest > 0.0),
        mistakes,
        objects,
        is_background_right,
        ..Verdict::of(Kind::Wrong, scene)
    }
}

impl Verdict {
    fn of(kind: Kind, scene: &Scene) -> Self {
        Self {
            kind,
            samples: None,
            mistakes: Vec::new(),
            rest: None,
            objects: objects::right(scene),
            is_background_right: true,
            is_coded: false,
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
                    format!("right but for sampling noise: about {count} random samples per pixel")
                }
                None if self.is_coded => {
                    "right but for sampling noise and what JPEG changes".to_owned()
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

/// The words for programs of all mistakes that the table has.
pub fn mistake_ids() -> impl Iterator<Item = &'static str> {
    let rows = mistakes::ROWS.iter().map(|row| row.id);
    rows.chain(mistakes::OBJECT_ROWS.iter().map(|row| row.id))
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
