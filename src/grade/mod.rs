//! What is likely wrong with a picture of a scene.
//!
//! In: a picture that somebody made of a scene, the scene, and its exact picture. Out: the simple mistakes that explain the difference,
//! best first; none, if none does. A mistake is a function: of the exact picture, or of the scene, whose exact picture is then made. It is
//! named only if the picture that it makes leaves a small part of the difference, or nothing but sampling noise.
//!
//! Mistakes of the whole picture are in `whole`, of the camera in `camera`, of objects in `objects` and `board`, of samples in `noise` and
//! `shift`. Numbers that are some others, a camera's or a checkerboard's, are looked for by `search`. `fixed` knows samples whose errors are
//! not independent, `bias` errors that add up to something. `case` tries mistakes, and `evidence` says how many pixels it takes to name
//! one. `level` makes pictures smaller, so that `fit` can afford to search, and `extent` says in which part of one an object can make a
//! difference, and how far it is off there.

mod bias;
mod board;
mod camera;
mod case;
mod evidence;
mod extent;
mod fit;
mod fixed;
mod level;
mod noise;
mod objects;
mod search;
mod shift;
mod whole;

use std::sync::atomic::Ordering;

use glam::DVec2;
use rayon::prelude::*;

use crate::{
    area::Area,
    film::{Film, TooLarge, rmse},
    render::{self, Control, RenderError},
    scene::{Scene, Shape},
    tracer::World,
};

pub use self::extent::Off;

use self::case::Case;

/// A mistake explains a difference if it leaves less than this share of its root mean square.
const LEFT: f64 = 0.2;

/// A mistake that leaves less than this share is looked at further: the rest may be noise.
const HOPE: f64 = 0.9;

/// The same in a picture that is smaller by [`FEW`] or more, in whose pixels noise is averaged away.
const SMALL_HOPE: f64 = 0.5;
const FEW: u32 = 3;

/// Of several explanations, those that leave more than so many times what the best one leaves are not named.
const RIVAL: f64 = 1.5;

/// So many explanations are named at most.
const NAMED: usize = 3;

/// A simple mistake that explains a difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// A word for programs.
    pub mistake: &'static str,
    /// What is likely wrong, for people.
    pub message: String,
    /// The way out.
    pub help: String,
    /// The root mean square of the differences that it leaves, in linear light; none where pictures differ in size.
    pub rmse: Option<f64>,
    /// The share of the squared difference that it explains, 0 to 1.
    pub explains: Option<f64>,
    /// How far the object is off in the picture, if one is.
    pub off: Option<Off>,
}

/// What is found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grade {
    /// The mistakes that explain the difference, best first; none, if none does.
    pub likely: Vec<Verdict>,
    /// Whether a mistake would explain it that too few pixels tell of.
    pub is_thin: bool,
}

/// A mistake that somebody may have made.
struct Idea {
    mistake: &'static str,
    message: String,
    help: String,
    make: Make,
}

/// What a mistake makes of the exact picture.
type Change = dyn Fn(&Film) -> Result<Film, TooLarge>;

/// From the right picture to the one that a mistake makes.
enum Make {
    /// From the exact picture.
    Film(Box<Change>),
    /// The exact picture of another scene.
    Scene(Box<Scene>),
    /// That of a scene with one shape changed, which was and is one of these.
    Object(Box<Scene>, Box<[Option<Shape>; 2]>),
    /// The exact picture, its light taken through a curve.
    Light(Curve),
    /// That of a scene, its light taken through a curve.
    Curved(Box<Scene>, Curve),
    /// The exact picture of another scene in those pixels whose centre sees a point (x, z) of the floor, in squares, for which this holds.
    Floor(Box<Scene>, fn(DVec2) -> bool),
    /// This picture, of which one sample in each pixel has this variance.
    Is(Film, Film),
    /// One sample in each pixel, at this offset from its centre.
    Sample(DVec2),
    /// The whole square window squeezed into the picture.
    Squeezed,
}

/// A curve and its inverse.
#[derive(Clone, Copy)]
struct Curve {
    to: fn(f64) -> f64,
    back: fn(f64) -> f64,
}

/// Names the mistakes that explain why `a` is not the exact picture of a scene.
pub fn scene(
    a: &Film,
    scene: &Scene,
    exact: &Film,
    control: &Control,
) -> Result<Grade, RenderError> {
    if size(a) != size(exact) {
        return Ok(Grade {
            likely: whole::sizes(a, exact),
            is_thin: false,
        });
    }
    let case = Case::new(a, scene, exact, control)?;
    let likely = explained(&case)?;
    Ok(Grade {
        is_thin: likely.is_empty() && case.is_thin.get(),
        likely,
    })
}

/// The mistakes that explain a difference, from the likeliest kind on.
fn explained(case: &Case) -> Result<Vec<Verdict>, RenderError> {
    let (a, exact, scene) = (&case.full.a, &case.full.exact, &case.full.scene);
    // One sample at a fixed place makes errors at edges alone, as noise does, and is the better answer.
    let found = case.named(noise::ideas())?;
    if !found.is_empty() {
        return Ok(found);
    }
    if let Some(noise) = noise::judge(a, exact, &case.variance)
        && !case.is_biased(a, exact, &case.variance, noise)?
    {
        return Ok(vec![noise.verdict(case.difference)]);
    }
    if let Some(samples) = fixed::grid(case)? {
        return Ok(vec![noise::verdict_of_grid(case.difference, samples)]);
    }
    if let Some((share, noise)) = fixed::empty(case)? {
        return Ok(vec![noise.verdict_with_empty(case.difference, share)]);
    }
    let ideas = whole::ideas(scene)
        .into_iter()
        .chain(camera::ideas(scene))
        .chain(board::ideas(scene))
        .chain(objects::ideas(case))
        .chain(objects::colors(case));
    let mut found = case.named(ideas.collect())?;
    if let [first, others @ ..] = found.as_slice()
        && first.mistake != "colors"
        && others.iter().any(|other| other.mistake == "colors")
    {
        // What explains the whole picture explains all of its colours.
        found.retain(|verdict| verdict.mistake != "colors");
    }
    if !found.is_empty() {
        return Ok(found);
    }
    if case.differences.pixels < evidence::FEWEST {
        // Too few for any.
        return Ok(found);
    }
    // What has to be searched for takes longer, what comes last longest.
    let found = case.named(objects::search(case)?)?;
    if !found.is_empty() {
        return Ok(found);
    }
    // A camera that moved a little displaces the picture, nearly.
    let mut ideas = shift::search(case)?;
    let changes = camera::single(scene).into_iter();
    let changes: Vec<_> = changes.chain(board::changes(scene)).collect();
    let single = search::nearest(case, &changes)?;
    ideas.extend(single.ideas);
    let found = case.named(ideas)?;
    if !found.is_empty() {
        return Ok(found);
    }
    // A camera that is off in several ways is seen all over the picture.
    if let Some(found) = objects::confined(case)? {
        return Ok(vec![found]);
    }
    let several = search::nearest(case, &camera::several(scene))?;
    let found = case.named(several.ideas)?;
    if !found.is_empty() {
        return Ok(found);
    }
    let any = camera::any(case, &single.starts, &several.starts)?;
    case.named(any.into_iter().collect())
}

/// Names the mistakes that explain why one picture is not another, of which no scene is known.
pub fn pictures(a: &Film, b: &Film) -> Grade {
    if size(a) != size(b) {
        return Grade {
            likely: whole::sizes(a, b),
            is_thin: false,
        };
    }
    let difference = rmse(a, b);
    let mut is_thin = false;
    let found = whole::films().into_iter().filter_map(|idea| {
        let made = match &idea.make {
            Make::Film(make) => make(b),
            Make::Light(curve) => level::map(b, curve.to),
            _ => return None,
        };
        let made = made.ok()?;
        let left = rmse(a, &made);
        if left >= LEFT * difference {
            return None;
        }
        if !evidence::is_enough(a, b, &made) {
            is_thin = true;
            return None;
        }
        Some(idea.verdict(left, difference, None))
    });
    let likely = best(found.collect(), difference);
    Grade {
        is_thin: likely.is_empty() && is_thin,
        likely,
    }
}

fn size(film: &Film) -> [u32; 2] {
    [film.width(), film.height()]
}

/// The exact picture of a scene.
fn exact(scene: &Scene, control: &Control) -> Result<Film, RenderError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    Ok(render::render_exact(&World::new(scene), whole, control)?.film)
}

/// The best of some verdicts on a difference, best first. Of those that leave the same, the one thought of first is the simplest.
fn best(mut found: Vec<Verdict>, difference: f64) -> Vec<Verdict> {
    let left = |verdict: &Verdict| verdict.rmse.unwrap_or(0.0);
    let Some(least) = found.iter().map(left).reduce(f64::min) else {
        return found;
    };
    // What rounding to bytes leaves is no difference between explanations.
    found.retain(|verdict| left(verdict) <= RIVAL * least.max(1e-3));
    // What the best one leaves may be noise, beside which the difference that a mistake makes is small.
    let rest = |left: f64| left * left - least * least;
    found.retain(|verdict| {
        let own = left(verdict);
        own <= 1e-3 || rest(own) <= LEFT * LEFT * rest(difference)
    });
    let is_level = |verdict: &Verdict| left(verdict) <= (1.05 * least).max(1e-3);
    found.sort_by(|p, q| match (is_level(p), is_level(q)) {
        (true, true) => std::cmp::Ordering::Equal,
        _ => left(p).total_cmp(&left(q)),
    });
    found.truncate(NAMED);
    found
}

impl Idea {
    fn verdict(&self, left: f64, difference: f64, off: Option<Off>) -> Verdict {
        let message = match off {
            Some(off) => format!("{}: {off}", self.message),
            None => self.message.clone(),
        };
        Verdict {
            mistake: self.mistake,
            message,
            help: self.help.clone(),
            rmse: Some(left),
            explains: Some(explained_share(left, difference)),
            off,
        }
    }
}

/// The share of a squared difference that is not left.
fn explained_share(left: f64, difference: f64) -> f64 {
    let share = left / difference;
    (1.0 - share * share).max(0.0)
}

/// One sample in each pixel, at an offset from its centre.
fn sampled(scene: &Scene, offset: DVec2, control: &Control) -> Result<Film, RenderError> {
    let world = World::new(scene);
    let colors: Vec<_> = world
        .palette()
        .iter()
        .map(|color| color.to_linear())
        .collect();
    let (width, height) = (scene.image.width, scene.image.height);
    let mut film = Film::new(width, height)?;
    let rows: Vec<Vec<_>> = (0..height)
        .into_par_iter()
        .map(|y| {
            if control.cancel.load(Ordering::Relaxed) {
                return Err(RenderError::Cancelled);
            }
            let row = (0..width).map(|x| colors[world.slot_at(x, y, offset)]);
            Ok(row.collect())
        })
        .collect::<Result<_, _>>()?;
    for (y, row) in (0..).zip(rows) {
        film.put(
            Area {
                x: 0,
                y,
                width,
                height: 1,
            },
            &row,
        );
    }
    Ok(film)
}

/// A scene and its exact picture, for tests.
#[cfg(test)]
fn scene_of(text: &str) -> (Scene, Film) {
    use crate::source::{Source, Sources};
    use std::sync::atomic::AtomicBool;

    let sources = Sources::new(Source::from_text("a.scn", text));
    let scene = crate::scene::read(&sources).scene.unwrap();
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let film = exact(&scene, &control).unwrap();
    (scene, film)
}
