//! Two simple mistakes at once, of which neither explains a picture.
//!
//! In: a picture, and mistakes of it as a whole, which can be undone: in the picture, if it was turned or its light is wrong, or in the scene,
//! if its roll has the wrong sign or its floor is the other way round. Out: those with which one more explains it. What is left when the first
//! is undone is a case like any other, in which the second is found as if it were the only one; but most of the first ones are ruled out
//! before, in a tiny picture.

use super::{
    Case, Curve, Idea, LEFT, Make, Verdict, board, camera,
    choice::{Explanation, RIVAL, ROUNDING},
    evidence, exact, explained_share,
    fit::fit,
    level::{self, Level},
    objects,
    search::Change,
    whole::{self, Look},
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
#[derive(Clone, Copy, PartialEq, PartialOrd)]
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
            "not_encoded" | "encoded_twice" | "gamma_22" | "gamma_2" => Self::Light,
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
    ) -> Result<Option<Both>, RenderError> {
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
        let curve = match &self.undo {
            Undo::Look(Look::Curved(curve)) => Some(*curve),
            _ => None,
        };
        let is_alone = match curve {
            // Of roundings it makes larger ones.
            Some(curve) => case.is_light(curve, &level::map(right, curve.to)?)?,
            None => false,
        };
        if is_alone || rest.may_be_right() {
            // The first mistake is the only one, and all else may be right.
            return Ok(None);
        }
        let ideas = search(&rest)?;
        let found = rest.named(ideas)?;
        case.is_thin.set(case.is_thin.get() | rest.is_thin.get());
        let is_all = rest.is_all(&found)?;
        let Some(second) = found.into_iter().next() else {
            return Ok(None);
        };
        let is_all =
            is_all || curve.is_some_and(|curve| case.is_rounding_before(curve, &second.made));
        // What the second one alone makes.
        let alone = match (&self.undo, &second.make) {
            (Undo::Look(_), _) => Some(second.made.clone()),
            (Undo::Scene(_), Make::Film(_) | Make::Light(_)) => {
                Some(full.made(&second.make, &case.control)?)
            }
            _ => None,
        };
        let made = match &self.undo {
            Undo::Look(look) => look.done(&second.made)?,
            Undo::Scene(_) => second.made,
        };
        if alone.is_some_and(|alone| !evidence::is_enough(&full.a, &alone, &made)) {
            return Ok(None);
        }
        let left = rmse(&full.a, &made);
        let is_turned = matches!(self.undo, Undo::Look(Look::Turned { .. }));
        let verdict = Verdict {
            mistake: self.mistake,
            message: format!("{}; and {}", self.message, second.verdict.message),
            help: format!("{}; and {}", self.help, second.verdict.help),
            rmse: Some(left),
            explains: Some(explained_share(left, case.difference)),
            // It is off by so much in the picture that is turned back.
            off: second.verdict.off.filter(|_| !is_turned),
        };
        let explains = is_all || left < LEFT * case.difference;
        Ok(explains.then_some(Both {
            verdict,
            left,
            is_all,
        }))
    }
}

/// Two mistakes that explain a picture together.
pub struct Both {
    pub verdict: Verdict,
    /// The root mean square of what they leave.
    pub left: f64,
    /// Whether that is nothing but roundings or noise.
    pub is_all: bool,
}

impl Both {
    /// Whether something that explains the picture, too, leaves clearly more.
    pub fn is_better_than(&self, found: &[Verdict]) -> bool {
        let left = match found.first() {
            Some(first) => first.rmse.unwrap_or(0.0),
            None => f64::INFINITY,
        };
        left > RIVAL * self.left.max(ROUNDING)
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
    fn new(case: &'a Case, first: Option<&First>) -> Result<Self, RenderError> {
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

/// The first mistakes of a picture, in its tiny one.
pub struct Pairs<'a> {
    case: &'a Case<'a>,
    firsts: Vec<First>,
    /// With none of them undone, and with each.
    none: Tiny<'a>,
    tiny: Vec<Tiny<'a>>,
    /// The least that one of them alone leaves, or none.
    least: f64,
}

impl<'a> Pairs<'a> {
    /// Nothing, where nothing is to be said of two mistakes.
    pub fn new(case: &'a Case<'a>) -> Result<Option<Self>, RenderError> {
        if is_hopeless(case) {
            return Ok(None);
        }
        let firsts = firsts(&case.full.scene);
        let none = Tiny::new(case, None)?;
        let tiny = firsts.iter().map(|first| Tiny::new(case, Some(first)));
        let tiny = tiny.collect::<Result<Vec<_>, _>>()?;
        Ok(Some(Self {
            least: tiny.iter().map(|one| one.left).fold(none.left, f64::min),
            case,
            firsts,
            none,
            tiny,
        }))
    }

    /// Two mistakes that are known without a search.
    pub fn known(&self) -> Result<Option<Both>, RenderError> {
        let (case, firsts) = (self.case, &self.firsts);
        let mut pairs: Vec<(f64, usize, Idea)> = Vec::new();
        for (i, (first, tiny)) in firsts.iter().zip(&self.tiny).enumerate() {
            let mut add = |left: f64, second: Idea| {
                if left <= SHARE * self.least {
                    pairs.push((left, i, second));
                }
            };
            match &first.undo {
                Undo::Scene(scene) => {
                    for second in of_scene(scene) {
                        // The same two are thought of the other way round, too.
                        if second.about > first.about && !first.is_alike(second.mistake) {
                            let idea = second.idea();
                            let made = tiny.level.made(&idea.make, &case.control)?;
                            add(tiny.left_by(&made), idea);
                        }
                    }
                    for (second, tiny_second) in firsts.iter().zip(&self.tiny) {
                        if matches!(second.undo, Undo::Look(_)) && !first.is_alike(second.mistake) {
                            add(tiny_second.left_by(&tiny.level.exact), second.idea());
                        }
                    }
                }
                Undo::Look(look) => {
                    for (second, tiny_second) in firsts.iter().zip(&self.tiny).skip(i + 1) {
                        if !first.is_alike(second.mistake) {
                            let undone = look.undone(&tiny_second.level.a)?;
                            let left = rmse(&undone, &self.none.level.exact) / tiny_second.spread;
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

    /// An object that is off in a picture that is wrong as a whole, too, or a number. What the best number alone leaves is given, in the tiny
    /// picture.
    pub fn searched(&self, least: f64) -> Result<Option<Both>, RenderError> {
        let left = |i: &usize| self.tiny[*i].left;
        let mut hopeful: Vec<_> = (0..self.firsts.len())
            .filter(|i| left(i) <= SHARE * self.none.left)
            .collect();
        hopeful.sort_by(|p, q| left(p).total_cmp(&left(q)));
        let mut found = Vec::new();
        for i in hopeful.into_iter().take(TRIED) {
            found.extend(self.firsts[i].then(self.case, of_objects)?);
        }
        if found.is_empty() {
            found = self.numbers(self.least.min(least / self.none.spread))?;
        }
        Ok(best(found))
    }

    /// Numbers that are others in a picture that is wrong as a whole, too.
    fn numbers(&self, least: f64) -> Result<Vec<Both>, RenderError> {
        let (case, firsts) = (self.case, &self.firsts);
        let mut pairs = Vec::new();
        for group in groups(firsts) {
            pairs.extend(self.nearest(&group)?);
        }
        pairs.sort_by(|p, q| p.left.total_cmp(&q.left));
        pairs.truncate(FITTED);
        for pair in &mut pairs {
            let (first, tiny) = (&firsts[pair.first], &self.tiny[pair.first]);
            let scene = first.scene(case);
            let change = &changes(first, scene)[pair.change];
            let make = |at: &[f64]| Some(Make::Scene(Box::new((change.with)(scene, at)?)));
            let widths = &change.widths;
            if let Some(found) = fit(&tiny.level, &case.control, &pair.at, widths, &make)? {
                pair.left = found.left / tiny.spread;
                pair.at = found.at;
            }
        }
        pairs.retain(|pair| pair.left <= SHARE * least);
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
        // A number comes near to much.
        found.retain(|both| both.is_all);
        Ok(found)
    }

    /// The nearest place of each number, of first mistakes that share a scene.
    fn nearest(&self, group: &[usize]) -> Result<Vec<Pair>, RenderError> {
        let (case, firsts) = (self.case, &self.firsts);
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
                    let left = self.tiny[*first].left_by(&made);
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
}

/// An object that is off, too, in a picture that one mistake explains but for that. It is named only if nothing but roundings or noise is left:
/// what is explained nearly leaves something of which an object may take a part.
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
    let both = first.then(case, of_objects)?;
    Ok(both.filter(|both| both.is_all).map(|both| both.verdict))
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

/// The first mistakes that share the pictures of places: what was done to the picture leaves its scene as it was.
fn groups(firsts: &[First]) -> Vec<Vec<usize>> {
    let all = 0..firsts.len();
    let (looks, scenes): (Vec<_>, Vec<_>) =
        all.partition(|i| matches!(firsts[*i].undo, Undo::Look(_)));
    let scenes = scenes.into_iter();
    let signs = scenes.filter(|i| SIGNS.contains(&firsts[*i].mistake));
    signs.map(|i| vec![i]).chain([looks]).collect()
}

/// The one that leaves least, the first of those that leave about as much.
fn best(found: Vec<Both>) -> Option<Both> {
    let left = |both: &Both| both.left.max(ROUNDING);
    let least = found.iter().map(left).fold(f64::INFINITY, f64::min);
    found.into_iter().find(|one| left(one) <= RIVAL * least)
}
