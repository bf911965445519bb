//! Two simple mistakes at once, of which neither explains a picture.
//!
//! In: a picture, and mistakes of it as a whole, which can be undone: in the picture, if it was turned or its light is wrong, or in the scene,
//! if its roll has the wrong sign or its floor is the other way round. Out: those with which one more explains it. What is left when the first
//! is undone is a case like any other, in which the second is found as if it were the only one; but most of the first ones are ruled out
//! before, in a tiny picture.

use super::{
    Case, Curve, Idea, Look, Make, Verdict, board, camera,
    choice::{Explanation, RIVAL, ROUNDING},
    exact, explained_share,
    fit::fit,
    level::{self, Level},
    noise, objects,
    search::Change,
    whole,
};
use crate::{
    film::{Film, rmse},
    render::RenderError,
    scene::Scene,
};

/// Both have to leave less than this share of what one leaves, in a tiny picture, to be looked at. It is a choice, for time: of two mistakes
/// that are seen each leaves more than what noise and roundings do there.
const SHARE: f64 = 0.5;

/// So many pairs are looked at, those that leave least in the tiny picture, and so many with a number are fitted there, those that come
/// nearest before. These are choices, for time, too.
const TRIED: usize = 3;
const FITTED: usize = 8;

/// Those of another scene beside which numbers are looked for, as each takes a hundred pictures of its own: signs, and what was not minded.
const SIGNS: [&str; 4] = ["roll_sign", "roll_ignored", "up_negated", "board_swapped"];

/// What a mistake is about. Two mistakes about the same are one.
#[derive(Clone, Copy, PartialEq)]
enum About {
    Turn,
    Order,
    Light,
    Roll,
    View,
    Lens,
    Depth,
    Board,
}

impl About {
    fn of(mistake: &str) -> Self {
        match mistake {
            "mirrored" | "upside_down" | "turned_180" => Self::Turn,
            "channels" => Self::Order,
            "not_encoded" | "encoded_twice" | "gamma_22" => Self::Light,
            // A negated up vector is a roll by 180 degrees.
            "roll" | "roll_sign" | "roll_ignored" | "roll_unit" | "up_negated" => Self::Roll,
            "distance" | "field_of_view" | "view_height_ignored" | "distance_ignored" => Self::Lens,
            "near" | "far" | "near_ignored" | "far_ignored" | "not_clipped" => Self::Depth,
            _ if mistake.starts_with("board") => Self::Board,
            _ => Self::View,
        }
    }
}

/// A mistake of the whole picture, which is known without a search.
struct First {
    mistake: &'static str,
    message: String,
    help: String,
    about: About,
    undo: Undo,
}

/// How a mistake is undone: in the picture, or by taking its scene for the right one.
enum Undo {
    Look(Look),
    Scene(Box<Scene>),
}

impl First {
    fn of_scene(idea: Idea) -> Option<Self> {
        match idea.make {
            Make::Scene(scene) => Some(Self {
                mistake: idea.mistake,
                about: About::of(idea.mistake),
                message: idea.message,
                help: idea.help,
                undo: Undo::Scene(scene),
            }),
            _ => None,
        }
    }

    /// Whether one is about what the other is, or both together are about it.
    fn is_alike(&self, mistake: &str) -> bool {
        let other = About::of(mistake);
        let is_turn = |one: &str, about: About| one == "turned_180" && about == About::Roll;
        self.about == other || is_turn(self.mistake, other) || is_turn(mistake, self.about)
    }

    /// The scene that is right when this is undone, in the whole picture's size.
    fn scene<'a>(&'a self, case: &'a Case) -> &'a Scene {
        match &self.undo {
            Undo::Look(_) => &case.full.scene,
            Undo::Scene(scene) => scene,
        }
    }

    fn idea(&self) -> Idea {
        Idea {
            mistake: self.mistake,
            message: self.message.clone(),
            help: self.help.clone(),
            make: match &self.undo {
                Undo::Look(look) => look.make(),
                Undo::Scene(scene) => Make::Scene(scene.clone()),
            },
        }
    }

    /// What one more mistake explains of the picture in which this one is undone.
    fn then(
        &self,
        case: &Case,
        search: impl FnOnce(&Case) -> Result<Vec<Idea>, RenderError>,
    ) -> Result<Option<Verdict>, RenderError> {
        let full = &case.full;
        let (a, scene, right) = match &self.undo {
            Undo::Look(look) => (look.undone(&full.a)?, &*full.scene, None),
            Undo::Scene(scene) => (
                Film::clone(&full.a),
                scene.as_ref(),
                Some(exact(scene, &case.control)?),
            ),
        };
        let right = right.as_ref().unwrap_or(&full.exact);
        let rest = Case::new(&a, scene, right, &case.control)?;
        if noise::possible(&a, right, &rest.variance).is_some() {
            // The first mistake is the only one, and all else may be right.
            return Ok(None);
        }
        let ideas = search(&rest)?;
        let Some(second) = rest.named(ideas)?.into_iter().next() else {
            return Ok(None);
        };
        let made = match &self.undo {
            Undo::Look(look) => look.done(&second.made)?,
            Undo::Scene(_) => second.made,
        };
        let left = rmse(&full.a, &made);
        let is_turned = matches!(self.undo, Undo::Look(Look::Turned { .. }));
        Ok((left < case.difference).then(|| Verdict {
            mistake: self.mistake,
            message: format!("{}; and {}", self.message, second.verdict.message),
            help: format!("{}; and {}", self.help, second.verdict.help),
            rmse: Some(left),
            explains: Some(explained_share(left, case.difference)),
            // It is off by so much in the picture that is turned back.
            off: second.verdict.off.filter(|_| !is_turned),
        }))
    }
}

/// Those that can be undone in any picture, in the order in which they are undone: what happened to the light is least surely undone.
fn firsts(scene: &Scene) -> Vec<First> {
    let mut firsts = of_scene(scene);
    for (mistake, message, help, look) in whole::looks() {
        firsts.push(First {
            mistake,
            message,
            help: help.to_owned(),
            about: About::of(mistake),
            undo: Undo::Look(look),
        });
    }
    firsts
}

fn of_scene(scene: &Scene) -> Vec<First> {
    let ideas = camera::ideas(scene).into_iter().chain(board::ideas(scene));
    ideas.filter_map(First::of_scene).collect()
}

/// A first mistake in the tiny picture: that picture with it undone, its scene and that one's picture; and what it leaves.
struct Tiny<'a> {
    level: Level<'a>,
    /// All shares are of how much the picture varies, as light that went through a curve has another scale.
    spread: f64,
    left: f64,
}

impl<'a> Tiny<'a> {
    fn new(case: &'a Case, first: Option<&'a First>) -> Result<Self, RenderError> {
        let tiny = &case.tiny;
        let level = match first.map(|first| &first.undo) {
            None => tiny.beside(Film::clone(&tiny.a), None),
            Some(Undo::Look(Look::Curved(curve))) => {
                tiny.beside(undone_before(case, *curve)?, None)
            }
            Some(Undo::Look(look)) => tiny.beside(look.undone(&tiny.a)?, None),
            Some(Undo::Scene(scene)) => {
                let make = Make::Scene(scene.clone());
                let right = tiny.made(&make, &case.control)?;
                tiny.beside(Film::clone(&tiny.a), Some((scene, right)))
            }
        };
        let spread = spread(&level.a);
        Ok(Self {
            left: rmse(&level.a, &level.exact) / spread,
            spread,
            level,
        })
    }

    /// What is left of the difference to another picture.
    fn left_by(&self, made: &Film) -> f64 {
        rmse(&self.level.a, made) / self.spread
    }
}

/// The tiny picture before a curve: a mean of what was before it.
fn undone_before(case: &Case, curve: Curve) -> Result<Film, RenderError> {
    let before = level::map(&case.full.a, curve.back)?;
    let tiny = Level::small(&before, &case.full.scene, &case.full.exact, level::TINY)?;
    Ok(tiny.a.into_owned())
}

/// The root mean square of what a picture is off its mean.
fn spread(film: &Film) -> f64 {
    let pixels = film.pixels();
    let count = pixels.len() as f64;
    let mean = [0, 1, 2].map(|i| pixels.iter().map(|p| p[i]).sum::<f64>() / count);
    let squares = |p: &[f64; 3]| -> f64 {
        (0..3)
            .map(|i| (p[i] - mean[i]) * (p[i] - mean[i]))
            .sum::<f64>()
    };
    let sum: f64 = pixels.iter().map(squares).sum();
    (sum / (3.0 * count)).sqrt().max(f64::MIN_POSITIVE)
}

/// Two mistakes that are known without a search.
pub fn known(case: &Case) -> Result<Vec<Verdict>, RenderError> {
    if is_hopeless(case) {
        return Ok(Vec::new());
    }
    let firsts = firsts(&case.full.scene);
    let none = Tiny::new(case, None)?;
    let tiny = each(case, &firsts)?;
    let mut pairs: Vec<(f64, usize, Idea)> = Vec::new();
    for (i, first) in firsts.iter().enumerate() {
        let least = none.left.min(tiny[i].left);
        let mut add = |left: f64, second: Idea| {
            if left <= SHARE * least {
                pairs.push((left, i, second));
            }
        };
        match &first.undo {
            Undo::Scene(scene) => {
                for second in of_scene(scene) {
                    if !first.is_alike(second.mistake) {
                        let idea = second.idea();
                        let made = tiny[i].level.made(&idea.make, &case.control)?;
                        add(tiny[i].left_by(&made), idea);
                    }
                }
                for (second, tiny_second) in firsts.iter().zip(&tiny) {
                    if matches!(second.undo, Undo::Look(_)) && !first.is_alike(second.mistake) {
                        add(tiny_second.left_by(&tiny[i].level.exact), second.idea());
                    }
                }
            }
            Undo::Look(look) => {
                for (second, tiny_second) in firsts.iter().zip(&tiny).skip(i + 1) {
                    if !first.is_alike(second.mistake) {
                        let undone = look.undone(&tiny_second.level.a)?;
                        let left = rmse(&undone, &none.level.exact) / tiny_second.spread;
                        add(left, second.idea());
                    }
                }
            }
        }
    }
    pairs.sort_by(|p, q| p.0.total_cmp(&q.0));
    let mut found = Vec::new();
    for (_, i, second) in pairs.into_iter().take(TRIED) {
        found.extend(firsts[i].then(case, |_| Ok(vec![second]))?);
    }
    Ok(best(found))
}

/// An object that is off in a picture that is wrong as a whole, too, or a number.
pub fn searched(case: &Case) -> Result<Vec<Verdict>, RenderError> {
    if is_hopeless(case) {
        return Ok(Vec::new());
    }
    let firsts = firsts(&case.full.scene);
    let none = Tiny::new(case, None)?;
    let tiny = each(case, &firsts)?;
    let mut hopeful: Vec<_> = (0..firsts.len())
        .filter(|i| tiny[*i].left <= SHARE * none.left)
        .collect();
    hopeful.sort_by(|p, q| tiny[*p].left.total_cmp(&tiny[*q].left));
    let mut found = Vec::new();
    for i in hopeful.into_iter().take(TRIED) {
        found.extend(firsts[i].then(case, of_objects)?);
    }
    if found.is_empty() {
        found = numbers(case, &firsts, &none, &tiny)?;
    }
    Ok(best(found))
}

/// An object that is off, too, in a picture that one mistake explains but for that.
pub fn beside(case: &Case, first: &Explanation) -> Result<Option<Verdict>, RenderError> {
    if is_hopeless(case) {
        return Ok(None);
    }
    let known = firsts(&case.full.scene);
    let known = known
        .into_iter()
        .find(|known| known.message == first.verdict.message);
    let first = match (known, &first.make) {
        (Some(known), _) => known,
        (None, Make::Scene(scene)) => First {
            mistake: first.verdict.mistake,
            message: first.verdict.message.clone(),
            help: first.verdict.help.clone(),
            about: About::of(first.verdict.mistake),
            undo: Undo::Scene(scene.clone()),
        },
        _ => return Ok(None),
    };
    first.then(case, of_objects)
}

fn of_objects(case: &Case) -> Result<Vec<Idea>, RenderError> {
    let mut ideas = objects::ideas(case);
    ideas.extend(objects::search(case)?);
    Ok(ideas)
}

/// Where a picture may be right, or takes too long, nothing is said of two mistakes.
fn is_hopeless(case: &Case) -> bool {
    case.may_be_noise.get() || case.full.is_heavy || case.tiny.is_heavy
}

fn each<'a>(case: &'a Case, firsts: &'a [First]) -> Result<Vec<Tiny<'a>>, RenderError> {
    firsts
        .iter()
        .map(|first| Tiny::new(case, Some(first)))
        .collect()
}

/// The numbers that may be others beside a first mistake: of the camera alone, if each of them takes pictures of its own.
fn changes(first: &First, scene: &Scene) -> Vec<Change> {
    let mut changes = camera::single(scene);
    match first.undo {
        Undo::Look(_) => changes.extend(board::changes(scene)),
        Undo::Scene(_) => changes.retain(|change| change.mistake != "lookat"),
    }
    changes
}

/// A first mistake and a number that is another one, by their places in lists, and what is left with it.
struct Pair {
    left: f64,
    first: usize,
    change: usize,
    at: Vec<f64>,
}

/// Numbers that are others in a picture that is wrong as a whole, too.
fn numbers(
    case: &Case,
    firsts: &[First],
    none: &Tiny,
    tiny: &[Tiny],
) -> Result<Vec<Verdict>, RenderError> {
    let mut pairs = Vec::new();
    for group in groups(firsts) {
        pairs.extend(nearest(case, firsts, tiny, &group)?);
    }
    pairs.sort_by(|p, q| p.left.total_cmp(&q.left));
    pairs.truncate(FITTED);
    for pair in &mut pairs {
        let (first, tiny) = (&firsts[pair.first], &tiny[pair.first]);
        let scene = first.scene(case);
        let change = &changes(first, scene)[pair.change];
        let make = |at: &[f64]| Some(Make::Scene(Box::new((change.with)(scene, at)?)));
        let widths = &change.widths;
        if let Some(found) = fit(&tiny.level, &case.control, &pair.at, widths, &make)? {
            pair.left = found.left / tiny.spread;
            pair.at = found.at;
        }
    }
    pairs.retain(|pair| pair.left <= SHARE * none.left.min(tiny[pair.first].left));
    pairs.sort_by(|p, q| p.left.total_cmp(&q.left));
    let mut found = Vec::new();
    for pair in pairs.into_iter().take(TRIED) {
        let first = &firsts[pair.first];
        found.extend(first.then(case, |rest| {
            let scene: &Scene = &rest.full.scene;
            let change = &changes(first, scene)[pair.change];
            let fit = change.fit(rest, &rest.small, &pair.at)?;
            let idea = fit.and_then(|fit| change.idea(scene, &fit.at));
            Ok(idea.into_iter().collect())
        })?);
    }
    Ok(found)
}

/// The first mistakes that share the pictures of places: what was done to the picture leaves its scene as it was.
fn groups(firsts: &[First]) -> Vec<Vec<usize>> {
    let all = 0..firsts.len();
    let (looks, scenes): (Vec<_>, Vec<_>) =
        all.partition(|i| matches!(firsts[*i].undo, Undo::Look(_)));
    let scenes = scenes.into_iter();
    let signs = scenes.filter(|i| SIGNS.contains(&firsts[*i].mistake));
    signs.map(|i| vec![i]).chain([looks]).collect()
}

/// The nearest place of each number, of first mistakes that share a scene.
fn nearest(
    case: &Case,
    firsts: &[First],
    tiny: &[Tiny],
    group: &[usize],
) -> Result<Vec<Pair>, RenderError> {
    let Some(one) = group.first().map(|i| &firsts[*i]) else {
        return Ok(Vec::new());
    };
    let scene = one.scene(case);
    let mut pairs = Vec::new();
    for (number, change) in changes(one, scene).iter().enumerate() {
        let mut near: Vec<Option<Pair>> = Vec::new();
        near.resize_with(group.len(), || None);
        if group.iter().all(|i| firsts[*i].is_alike(change.mistake)) {
            continue;
        }
        for at in &change.starts {
            let Some(other) = (change.with)(scene, at) else {
                continue;
            };
            let make = Make::Scene(Box::new(other));
            let made = case.tiny.made(&make, &case.control)?;
            for (near, first) in near.iter_mut().zip(group) {
                let left = tiny[*first].left_by(&made);
                if near.as_ref().is_none_or(|near| left < near.left) {
                    *near = Some(Pair {
                        left,
                        first: *first,
                        change: number,
                        at: at.clone(),
                    });
                }
            }
        }
        let near = near.into_iter().flatten();
        pairs.extend(near.filter(|pair| !firsts[pair.first].is_alike(change.mistake)));
    }
    Ok(pairs)
}

/// The one that leaves least, the first of those that leave about as much.
fn best(found: Vec<Verdict>) -> Vec<Verdict> {
    let left = |verdict: &Verdict| verdict.rmse.unwrap_or(0.0).max(ROUNDING);
    let least = found.iter().map(left).fold(f64::INFINITY, f64::min);
    let first = found.into_iter().find(|one| left(one) <= RIVAL * least);
    first.into_iter().collect()
}
