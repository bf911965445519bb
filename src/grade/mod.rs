//! What is likely wrong with a picture of a scene.
//!
//! In: a picture that somebody made of a scene, the scene, and its exact picture. Out: the simple mistakes that explain the difference,
//! best first; none, if none does. A mistake is a function: of the exact picture, or of the scene, whose exact picture is then made. It is
//! named only if the picture that it makes leaves a small part of the difference, or nothing but sampling noise.
//!
//! Mistakes of the whole picture are in `whole` and `gray`, of the camera in `camera`, of objects in `objects` and `board`, of what hides what in
//! `order`, of samples in `noise` and `shift`. Numbers that are some others, a camera's or a checkerboard's, are looked for by `search`. `fixed` and
//! `alike` know samples whose errors are not independent, `seen` what single ones see, `origin` whether any may have made a picture, `truncated` bytes that are not rounded, `rounded` numbers
//! that are coarser than their file, `bias` errors that add up to something. `case` tries mistakes, `explained` says whether one explains the
//! difference, `evidence` how many pixels it takes to name one, and `choice` which of several it is. `pairs` finds two mistakes at once. `light`
//! undoes curves. `level` makes pictures smaller, so that `fit` can afford to search, and `extent` says in which part of one an object can make a
//! difference, and how far it is off there.

mod alike;
mod bias;
mod board;
mod camera;
mod case;
mod choice;
mod evidence;
mod explained;
mod extent;
mod fit;
mod fixed;
mod gray;
mod level;
mod light;
mod noise;
mod objects;
mod order;
mod origin;
mod pairs;
mod rounded;
mod search;
mod seen;
mod shift;
mod truncated;
mod whole;

use glam::DVec2;

use crate::{
    area::Area,
    film::{Film, TooLarge, rmse},
    render::{self, Control, RenderError},
    scene::{Scene, Shape},
    threads,
    tracer::World,
};

pub use self::extent::Off;

use self::{
    alike::Alike,
    case::Case,
    choice::{Explanation, RIVAL, ROUNDING},
    order::Order,
    origin::Origin,
    pairs::Pairs,
};

/// A mistake explains a difference if it leaves less than this share of its root mean square: a twenty-fifth of the squares.
const LEFT: f64 = 0.2;

/// A mistake that leaves less than this share is looked at further: the rest may be noise, of four times the squares of what it explains.
/// What leaves more has to go with the errors beyond all chance.
const HOPE: f64 = 0.9;

/// The same in a picture that is smaller by [`FEW`] or more, in each of whose pixels the noise of nine or more is averaged: a third of it is
/// left, and half of the share with some room.
const SMALL_HOPE: f64 = 0.5;
const FEW: u32 = 3;

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

impl Verdict {
    /// Whether it explains at least as much as it leaves. If not, what is left may be the cause of all.
    pub fn is_sure(&self) -> bool {
        self.explains.is_none_or(|share| share >= 0.5)
    }
}

/// What is found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grade {
    /// The mistakes that explain the difference, best first; none, if none does.
    pub likely: Vec<Verdict>,
    /// Whether a mistake, or noise, would explain it that too few pixels tell of.
    pub is_thin: bool,
    /// Whether noise would: then nothing need be wrong. If it is not for want of pixels that it is not called so, it is noise of samples
    /// that hang together.
    pub may_be_noise: bool,
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

/// A picture turned in some way.
type Turn = fn(&Film) -> Result<Film, TooLarge>;

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
    /// The exact picture turned, and its light taken through a curve.
    Turned(Turn, Curve),
    /// That of a scene, its light taken through a curve.
    Curved(Box<Scene>, Curve),
    /// The exact picture of another scene in those pixels whose centre sees a point (x, z) of the floor, in squares, for which this holds.
    Floor(Box<Scene>, fn(DVec2) -> bool),
    /// That of a scene whose objects are drawn in an order, whatever is nearer.
    Ordered(Order),
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
            likely: whole::sizes(a, exact, whole::OF_SCENE),
            ..Grade::default()
        });
    }
    let one_color = whole::one_color(a, exact, Some(scene));
    // Hundreds of pictures may be made, all by the same threads.
    threads::install(control.threads, || {
        let case = Case::new(a, scene, exact, control)?;
        let likely = match one_color {
            Some(verdict) => with_nothing_in_sight(&case, verdict)?,
            None => likely(&case)?,
        };
        // Noise that few pixels tell of is one thing, and samples at the same places, which many may tell of, another.
        let is_few = case.may_be_noise.get();
        let may_be_noise = is_few
            || case.is_alike()
            || case.may_be_alike()
            || case.are_many_off() && case.origin() == Origin::Perhaps;
        let is_thin = is_few || case.is_thin.get() && !may_be_noise;
        Ok(Grade {
            is_thin: likely.is_empty() && is_thin,
            may_be_noise: likely.is_empty() && may_be_noise,
            likely,
        })
    })?
}

/// What is said of a picture that is not of one colour.
fn likely(case: &Case) -> Result<Vec<Verdict>, RenderError> {
    let found = samples(case)?;
    if !found.is_empty() {
        return Ok(found);
    }
    // Samples at the same places in all pixels look like something that is displaced by a part of a pixel. Only what explains nearly all is a
    // mistake then, and nothing can where they explain most.
    let alike = match case.may_be_noise.get() {
        true => None,
        false => alike::find(case)?,
    };
    let is_told = alike.as_ref().is_some_and(Alike::is_all);
    let verdict = |alike: &Alike| vec![alike.verdict(case.difference)];
    if let Some(alike) = &alike
        && is_told
        && case.may_be_right()
    {
        return Ok(verdict(alike));
    }
    case.alike.set(alike);
    let found = mistakes(case)?;
    if let Some(alike) = &alike
        && is_told
        && found.is_empty()
    {
        return Ok(verdict(alike));
    }
    // Some pixels of one colour have not their own, but may have what samples on their sides see.
    let may_be_on_sides = case.strays.pixels > 0
        && case.are_many_off()
        && matches!(case.origin(), Origin::Samples | Origin::OnSides);
    if !may_be_on_sides {
        return Ok(found);
    }
    // What explains most of it comes before that, and what does not after it.
    let (mut found, unsure): (Vec<_>, Vec<_>) = found.into_iter().partition(Verdict::is_sure);
    found.push(origin::verdict(case.difference));
    found.extend(unsure);
    Ok(found)
}

/// What is said of a picture of one colour. If it is the background's the camera may look past everything, as any that does makes the same
/// picture, which is why none is named first.
fn with_nothing_in_sight(case: &Case, verdict: Verdict) -> Result<Vec<Verdict>, RenderError> {
    let mut likely = vec![verdict];
    let background = case.full.scene.image.background.to_linear();
    if !noise::is_off((&case.full.a.pixel(0, 0), &background)) {
        likely.extend(verdicts(case.named(camera::ideas(&case.full.scene))?));
    }
    Ok(likely)
}

/// What is said of a picture in which nothing but its samples is wrong.
fn samples(case: &Case) -> Result<Vec<Verdict>, RenderError> {
    let (a, exact) = (&case.full.a, &case.full.exact);
    if let Some(verdict) = rounded::verdict(case) {
        return Ok(vec![verdict]);
    }
    // One sample at a fixed place makes errors at edges alone, as noise does, and is the better answer. They may be so many that something
    // wrong away from them is a small part of the squares.
    if !noise::has_strays(a, exact, &case.full.scene, |light| light)
        && let Some(first) = case.named(noise::ideas())?.into_iter().next()
    {
        return Ok(vec![first.verdict]);
    }
    let truncated = truncated::flat(case)?;
    if !truncated.is_empty() {
        return Ok(truncated);
    }
    if let Some(noise) = noise::possible(a, exact, &case.variance)
        && !case.is_biased(a, exact, &case.variance, noise)?
        && !objects::is_in_one_part(case)
    {
        if noise.is_told() {
            return Ok(vec![noise.verdict(case.difference)]);
        }
        case.may_be_noise.set(true);
    }
    if let Some(grid) = fixed::grid(case)? {
        if grid.is_told {
            return Ok(vec![grid.verdict(case.difference)]);
        }
        case.may_be_noise.set(true);
    }
    if let Some((share, noise)) = fixed::empty(case)? {
        return Ok(vec![noise.verdict_with_empty(case.difference, share)]);
    }
    // What a right picture may be is said before what a wrong one is.
    match case.may_be_noise.get() {
        true => Ok(Vec::new()),
        false => truncated::mixed(case),
    }
}

/// The mistakes that explain a difference, from the likeliest kind on.
fn mistakes(case: &Case) -> Result<Vec<Verdict>, RenderError> {
    let scene = &case.full.scene;
    let ideas = whole::ideas(scene)
        .into_iter()
        .chain(gray::ideas(&case.full.a, &case.full.exact)?)
        .chain(camera::ideas(scene))
        .chain(board::ideas(scene))
        .chain(order::ideas(scene))
        .chain(objects::ideas(case))
        .chain(objects::colors(case)?);
    let mut found = case.named(ideas.collect())?;
    if let [first, others @ ..] = found.as_slice()
        && first.verdict.mistake != "colors"
        && others.iter().any(|other| other.verdict.mistake == "colors")
    {
        // What explains the whole picture explains all of its colours.
        found.retain(|one| one.verdict.mistake != "colors");
    }
    if found.is_empty() {
        found = case.named(whole::pairs())?;
    }
    let is_too_small = case.differences.pixels < evidence::FEWEST;
    let is_of_colors = (found.first()).is_some_and(|first| first.verdict.mistake == "colors");
    let pairs = match (found.is_empty() || is_of_colors) && !is_too_small {
        true => Pairs::new(case)?,
        false => None,
    };
    let both = match &pairs {
        Some(pairs) => pairs.known()?,
        None => None,
    };
    let left = found.first().and_then(|first| first.verdict.rmse);
    if let Some(both) = &both
        && left.map_or(both.is_all, |left| both.left <= RIVAL * left.max(ROUNDING))
    {
        // Two mistakes of which each is known are simpler than a list of colours, and than what is searched for if they explain all.
        return Ok(vec![both.verdict.clone()]);
    }
    if !found.is_empty() {
        return and_beside(case, found);
    }
    if is_too_small {
        return Ok(Vec::new());
    }
    // What has to be searched for takes longer, what comes last longest.
    let mut found = verdicts(case.named(objects::search(case)?)?);
    if found.is_empty() {
        found = numbers(case, pairs.as_ref())?;
    }
    // One mistake is simpler than two, unless these leave less.
    Ok(match both {
        Some(both) if both.is_better_than(&found) => vec![both.verdict],
        _ => found,
    })
}

/// What explains a difference, and an object that is off beside that.
fn and_beside(case: &Case, found: Vec<Explanation>) -> Result<Vec<Verdict>, RenderError> {
    if let Some(first) = found.first()
        && !case.is_all(&found)?
        && let Some(both) = pairs::beside(case, first)?
    {
        return Ok(vec![both]);
    }
    Ok(verdicts(found))
}

/// The numbers of the camera or the checkerboard that explain a difference, as few of them as leave nothing but roundings and noise.
fn numbers(case: &Case, pairs: Option<&Pairs>) -> Result<Vec<Verdict>, RenderError> {
    let scene = &case.full.scene;
    // A camera that moved a little displaces the picture, nearly.
    let mut ideas = shift::search(case)?;
    let changes = camera::single(scene).into_iter();
    let changes = changes.chain(board::changes(scene));
    let changes: Vec<_> = changes.chain(camera::clips(scene)).collect();
    let single = search::nearest(case, &changes)?;
    ideas.extend(single.ideas);
    let mut found = case.named(ideas)?;
    if case.is_all(&found)? {
        return Ok(verdicts(found));
    }
    // A camera that is off in several ways is seen all over the picture. What noise may have done is nobody's fault.
    let needs_no_mistake = case.may_be_noise.get() || !case.is_likelier_a_mistake();
    if found.is_empty()
        && !needs_no_mistake
        && let Some(verdict) = objects::confined(case)?
    {
        return Ok(vec![verdict]);
    }
    let changes = match found.is_empty() {
        true => camera::several(scene),
        false => camera::several_near(scene, &single.starts),
    };
    let several = search::nearest(case, &changes)?;
    found = case.best_of(found, several.ideas)?;
    if case.is_all(&found)? {
        return Ok(verdicts(found));
    }
    if found.is_empty()
        && let Some(pairs) = pairs
        && let Some(both) = pairs.searched(single.least.min(several.least))?
    {
        return Ok(vec![both.verdict]);
    }
    let starts: Vec<_> = single.starts.into_iter().chain(several.starts).collect();
    let any = camera::any(case, &starts)?;
    found = case.best_of(found, any.into_iter().collect())?;
    match found.is_empty() && !needs_no_mistake {
        true => Ok(objects::reaching_out(case)?.into_iter().collect()),
        false => and_beside(case, found),
    }
}

fn verdicts(found: Vec<Explanation>) -> Vec<Verdict> {
    found.into_iter().map(|found| found.verdict).collect()
}

/// Names the mistakes that explain why one picture is not another, of which no scene is known.
pub fn pictures(a: &Film, b: &Film) -> Grade {
    if size(a) != size(b) {
        return Grade {
            likely: whole::sizes(a, b, whole::OF_PICTURES),
            ..Grade::default()
        };
    }
    if let Some(verdict) = whole::one_color(a, b, None) {
        return Grade {
            likely: vec![verdict],
            ..Grade::default()
        };
    }
    let mut ideas = whole::films();
    // A picture that is too large is none that was read.
    ideas.extend(gray::ideas(a, b).unwrap_or_default());
    let mut grade = best(a, b, ideas);
    if grade.likely.is_empty() {
        let pairs = best(a, b, whole::pairs());
        grade = Grade {
            is_thin: pairs.likely.is_empty() && (grade.is_thin || pairs.is_thin),
            ..pairs
        };
    }
    grade
}

/// Those that explain the difference of two pictures.
fn best(a: &Film, b: &Film, ideas: Vec<Idea>) -> Grade {
    let difference = rmse(a, b);
    let mut is_thin = false;
    let found = ideas.into_iter().filter_map(|idea| {
        let made = match &idea.make {
            Make::Film(make) => make(b),
            Make::Light(curve) => level::map(b, curve.to),
            Make::Turned(turn, curve) => level::turned(b, *turn, *curve),
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
        Some(Explanation {
            verdict: idea.verdict(left, difference, None),
            make: idea.make,
            made,
        })
    });
    let likely = choice::best(found.collect(), a, difference).map_or_else(|_| Vec::new(), verdicts);
    Grade {
        is_thin: likely.is_empty() && is_thin,
        may_be_noise: false,
        likely,
    }
}

fn size(film: &Film) -> [u32; 2] {
    [film.width(), film.height()]
}

/// The exact picture of a scene.
fn exact(scene: &Scene, control: &Control) -> Result<Film, RenderError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let world = World::new_unless(scene, control.cancel)?;
    Ok(render::render_exact(&world, whole, control)?.film)
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
