//! One picture to judge, and how ideas of mistakes are tried on it.
//!
//! In: the picture, the scene and its exact picture; ideas. Out: those that explain the difference. A mistake is tried in the small picture
//! first, if it means the same there, and in the whole one then.

use std::cell::{Cell, OnceCell};

use glam::DVec3;

use super::{
    FEW, HOPE, Idea, LEFT, Make, Off, SMALL_HOPE,
    alike::Alike,
    bias::{Errors, SIGMAS},
    choice::{self, Explanation},
    evidence,
    extent::{Differences, View},
    level::{self, Level},
    noise::{self, Noise},
    objects::{self, Slope},
    origin::{self, Origin},
    seen::Seen,
    size,
};
use crate::{
    area::Area,
    film::{Film, rmse},
    render::{Control, RenderError},
    scene::{Scene, Shape},
};

/// A picture and what it should be.
pub struct Case<'a> {
    pub full: Level<'a>,
    pub small: Level<'a>,
    pub tiny: Level<'a>,
    /// Of the whole picture, root mean square.
    pub difference: f64,
    /// Of the small one, and of the tiny one.
    pub small_difference: f64,
    pub tiny_difference: f64,
    /// Where in the whole picture the difference is, and where noise would be.
    pub differences: Differences,
    pub expected: Differences,
    /// Pixels of one colour that have another one.
    pub strays: Differences,
    /// The difference, less roundings, and that of the small picture.
    pub errors: Errors,
    pub small_errors: Errors,
    /// Of one sample in each pixel of the right picture.
    pub variance: Film,
    /// What the objects change when they are moved a little.
    pub slopes: OnceCell<Vec<Slope>>,
    /// What single samples see.
    seen: OnceCell<Seen>,
    origin: OnceCell<Origin>,
    pub view: View,
    /// A mistake was passed over of which too few pixels tell.
    pub is_thin: Cell<bool>,
    /// Noise would make the difference, though too few pixels tell of it to say so.
    pub may_be_noise: Cell<bool>,
    /// A mistake was passed over that would show itself in more pixels where one colour should be seen.
    pub is_belied: Cell<bool>,
    /// The samples at the same places in all pixels that leave least, where some may have made the picture.
    pub alike: Cell<Option<Alike>>,
    pub control: Control<'a>,
}

impl<'a> Case<'a> {
    pub fn new(
        a: &'a Film,
        scene: &'a Scene,
        exact: &'a Film,
        control: &'a Control,
    ) -> Result<Self, RenderError> {
        let control = Control {
            threads: control.threads,
            progress: control.progress,
            cancel: control.cancel,
        };
        let small = Level::small(a, scene, exact, level::SMALL)?;
        let tiny = Level::small(a, scene, exact, level::TINY)?;
        let variance = noise::variance(scene, exact, &control)?;
        let whole = size(a);
        let square = |x: u32, y: u32| {
            let (p, q) = (DVec3::from(a.pixel(x, y)), DVec3::from(exact.pixel(x, y)));
            (p - q).length_squared()
        };
        Ok(Self {
            full: Level::full(a, scene, exact),
            small_difference: rmse(&small.a, &small.exact),
            difference: rmse(a, exact),
            differences: Differences::new(whole, square),
            expected: Differences::new(whole, |x, y| {
                variance.pixel(x, y).iter().map(|one| one.max(0.0)).sum()
            }),
            strays: Differences::new(whole, |x, y| {
                let is_flat = noise::is_flat(&variance.pixel(x, y));
                let is_stray = is_flat && noise::is_off((&a.pixel(x, y), &exact.pixel(x, y)));
                f64::from(u8::from(is_stray))
            }),
            errors: Errors::new(a, exact)?,
            small_errors: Errors::new(&small.a, &small.exact)?,
            small,
            tiny_difference: rmse(&tiny.a, &tiny.exact),
            tiny,
            variance,
            slopes: OnceCell::new(),
            seen: OnceCell::new(),
            origin: OnceCell::new(),
            view: View::of(scene),
            is_thin: Cell::new(false),
            may_be_noise: Cell::new(false),
            is_belied: Cell::new(false),
            alike: Cell::new(None),
            control,
        })
    }

    /// Those that explain the difference, best first.
    pub fn named(&self, ideas: Vec<Idea>) -> Result<Vec<Explanation>, RenderError> {
        self.best_of(Vec::new(), ideas)
    }

    /// The same beside others, which are simpler.
    pub fn best_of(
        &self,
        mut found: Vec<Explanation>,
        ideas: Vec<Idea>,
    ) -> Result<Vec<Explanation>, RenderError> {
        let mut hopeful = Vec::new();
        for idea in ideas {
            if let Some(left) = self.hope(&idea.make)? {
                hopeful.push((left, idea));
            }
        }
        if self.full.is_heavy {
            hopeful = with_few_pictures(hopeful);
        }
        let mut is_curved = false;
        for (_, idea) in hopeful {
            if let Some((left, made)) = self.tried(&idea.make)? {
                is_curved |= matches!(idea.make, Make::Light(_));
                let off = self.off(&idea.make);
                found.push(Explanation {
                    verdict: idea.verdict(left, self.difference, off),
                    make: idea.make,
                    made,
                });
            }
        }
        if is_curved {
            // Of single samples a curve makes other colours, which is the same, said less simply.
            found.retain(|one| one.verdict.mistake != "colors");
        }
        Ok(choice::best(found, &self.full.a, self.difference)?)
    }

    /// Whether the first of some explanations leaves nothing but roundings or noise.
    pub fn is_all(&self, found: &[Explanation]) -> Result<bool, RenderError> {
        let Some(Explanation { make, made, .. }) = found.first() else {
            return Ok(false);
        };
        // What comes in at the edges of a displaced picture may be anything.
        if matches!(make, Make::Is(..)) {
            return Ok(true);
        }
        // Numbers that were found are not known to the last digit, which may round a byte the other way.
        if self.is_rounding(made, evidence::APART) {
            return Ok(true);
        }
        if let Some(is_curved) = self.is_of_light(make, made)? {
            return Ok(is_curved);
        }
        Ok(match self.noise_in(make, made)? {
            // Small errors of another number would pass for noise of many samples.
            Some((variance, noise)) => {
                noise.is_coarse() && !self.is_biased(&self.full.a, made, &variance, noise)?
            }
            None => false,
        })
    }

    /// How far an object that a mistake changes is off.
    fn off(&self, make: &Make) -> Option<Off> {
        match make {
            Make::Object(_, shapes) => match shapes.as_ref() {
                [Some(right), Some(wrong)] => self.view.off(right, wrong),
                _ => None,
            },
            _ => None,
        }
    }

    /// What a mistake leaves of the difference in the small picture, if it may explain it; 0, if that cannot be said of it there.
    fn hope(&self, make: &Make) -> Result<Option<f64>, RenderError> {
        match make {
            Make::Object(_, shapes) if self.is_wrong_outside(self.view.extents(shapes)) => {
                return Ok(None);
            }
            // A part of the picture costs less than its small picture where that has many objects in each pixel.
            Make::Object(..) if self.full.is_heavy => return Ok(Some(0.0)),
            // Neither single samples nor curves mean the same in a small picture; and what is known need not be guessed.
            Make::Sample(_)
            | Make::Light(_)
            | Make::Turned(..)
            | Make::Curved(..)
            | Make::Is(..) => return Ok(Some(0.0)),
            _ => {}
        }
        let small = self.small.made(make, &self.control)?;
        let left = rmse(&self.small.a, &small);
        let hope = self.hopeful();
        let difference = self.small_difference;
        // A part of the picture costs little, so that what is left is seen there.
        let is_part = matches!(make, Make::Object(..));
        let right = &self.small.exact;
        let is_near = left <= hope * difference
            || left < difference
                && (is_part || self.small_errors.towards(right, &small, None).sigmas > SIGMAS);
        Ok(is_near.then_some(left))
    }

    /// A mistake that leaves less than this share of the small picture's difference may explain it.
    pub fn hopeful(&self) -> f64 {
        match self.small.factor {
            FEW.. => SMALL_HOPE,
            _ => HOPE,
        }
    }

    /// What a mistake leaves of the difference, and what it makes, if it explains it, and enough pixels tell of it.
    fn tried(&self, make: &Make) -> Result<Option<(f64, Film)>, RenderError> {
        if self.full.is_heavy && !self.is_near_in_a_part(make)? {
            return Ok(None);
        }
        let made = self.full.made(make, &self.control)?;
        let left = rmse(&self.full.a, &made);
        let sigmas = self.errors.towards(&self.full.exact, &made, None).sigmas;
        let is_nearer = left <= HOPE * self.difference || left < self.difference && sigmas > SIGMAS;
        if !is_nearer || !self.explains(make, &made, left)? {
            return Ok(None);
        }
        // A curve changes all pixels of several colours, and something else may be wrong in a few that add up to more. Where it leaves single
        // colours as they are it makes no pixel darker or lighter than all that is seen there, nor does it leave a row that is.
        let is_of_light = matches!(make, Make::Light(_) | Make::Turned(..) | Make::Curved(..));
        if is_of_light
            && self.strays.pixels == 0
            && left > HOPE * self.difference
            && (self.is_likelier_a_mistake()
                || Errors::new(&self.full.a, &made)?.is_picture_moved(&made, None))
        {
            return Ok(None);
        }
        let is_enough = !is_of_light && sigmas > SIGMAS
            || evidence::is_enough(&self.full.a, &self.full.exact, &made);
        if !is_enough {
            self.is_thin.set(true);
        }
        Ok(is_enough.then_some((left, made)))
    }

    /// Whether a mistake leaves less than [`HOPE`] of the rows with most of the difference; of those that make the whole picture anew.
    fn is_near_in_a_part(&self, make: &Make) -> Result<bool, RenderError> {
        let part = self.worst_rows(BAND);
        let Some(made) = self.full.part(make, part, &self.control)? else {
            return Ok(true);
        };
        let cut =
            |film: &Film| Film::from_fn(part.width, part.height, |x, y| film.pixel(x, part.y + y));
        let (a, exact) = (cut(&self.full.a)?, cut(&self.full.exact)?);
        Ok(rmse(&a, &made) <= HOPE * rmse(&a, &exact))
    }

    /// So many rows, those with most of the difference among the picture's bands of as many.
    pub fn worst_rows(&self, rows: u32) -> Area {
        let [width, height] = size(&self.full.a);
        let rows = rows.min(height);
        let mut worst = Area::whole(width, rows);
        for band in 1..height.div_ceil(rows) {
            let y = (band * rows).min(height - rows);
            let other = Area { y, ..worst };
            if self.differences.share(other) > self.differences.share(worst) {
                worst = other;
            }
        }
        worst
    }

    /// Whether so much is wrong outside of a part of the picture that nothing in it explains that: more of the difference than an explanation
    /// may leave, and a pixel of one colour, which noise has none of.
    pub fn is_wrong_outside(&self, part: Option<Area>) -> bool {
        let outside = |of: &Differences| 1.0 - part.map_or(0.0, |part| of.share(part));
        let strays = outside(&self.strays) * self.strays.pixels as f64;
        // The number of them, but for roundings.
        outside(&self.differences) > LEFT * LEFT && strays > 0.5
    }

    /// Whether most of the difference is where an object cannot be seen, and there is no more of it where it can be than noise makes: no pixel
    /// of one colour, for one.
    pub fn is_elsewhere(&self, shape: &Shape) -> bool {
        let Some(part) = self.view.extent(shape) else {
            return true;
        };
        (1.0 - self.differences.share(part)).sqrt() > HOPE
            && self.excess(part) <= SIGMAS
            && self.strays.share(part) == 0.0
    }

    /// At most so many of something that takes a part of the picture each, or a small one: fewer of a scene with a great many objects.
    pub fn most(&self, many: usize) -> usize {
        match self.full.is_heavy {
            true => many.div_ceil(4),
            false => many,
        }
    }

    /// How much more of the difference than of noise lies in a part of the picture: about in standard deviations, if each of the pixels that
    /// differ has as much of it as noise gives it.
    pub fn excess(&self, part: Area) -> f64 {
        let pixels = self.differences.pixels.max(1) as f64;
        let expected = self.expected.share(part);
        (self.differences.share(part) - expected) * (pixels / (expected + 1.0 / pixels)).sqrt()
    }

    /// What the objects that are likeliest to be off change when they are moved a little.
    pub fn slopes(&self) -> Result<&[Slope], RenderError> {
        if self.slopes.get().is_none() {
            let slopes = objects::slopes(self)?;
            return Ok(self.slopes.get_or_init(|| slopes));
        }
        Ok(self.slopes.get().map_or(&[], Vec::as_slice))
    }

    /// What single samples see.
    pub fn seen(&self) -> &Seen {
        self.seen.get_or_init(|| Seen::of(&self.full.scene))
    }

    /// Whether as many pixels are off as tell of something.
    pub fn are_many_off(&self) -> bool {
        let pairs = self.full.a.pixels().iter().zip(self.full.exact.pixels());
        let off = pairs.filter(|pair| noise::is_off(*pair));
        off.take(evidence::FEWEST as usize).count() == evidence::FEWEST as usize
    }

    /// What may have made the picture, beside mistakes.
    pub fn origin(&self) -> Origin {
        *self.origin.get_or_init(|| origin::origin(self))
    }

    /// Whether a mistake is looked for as if no samples had made the picture: those on pixels' sides are said beside it.
    pub fn is_likelier_a_mistake(&self) -> bool {
        self.origin() != Origin::Samples
    }

    /// Whether what looks like noise adds up to something.
    pub fn is_biased(
        &self,
        a: &Film,
        made: &Film,
        variance: &Film,
        noise: Noise,
    ) -> Result<bool, RenderError> {
        let errors = Errors::new(a, made)?;
        let noise = Some((variance, noise));
        if errors.is_picture_moved(made, noise) {
            return Ok(true);
        }
        let slopes = self.slopes()?.iter();
        let mut sums = slopes.map(|slope| errors.along(&slope.trend, noise));
        Ok(sums.any(|sum| sum.sigmas.abs() > SIGMAS))
    }
}

/// So many rows of a picture tell whether a mistake makes it, before all of it is made of a scene with many objects.
const BAND: u32 = 32;

/// So many whole pictures are made at a time of a scene with many objects: those of the mistakes that leave least of the small picture.
const PICTURES: usize = 2;

/// The same mistakes without those whose pictures are too many.
fn with_few_pictures(hopeful: Vec<(f64, Idea)>) -> Vec<(f64, Idea)> {
    let is_whole = |idea: &Idea| {
        matches!(
            idea.make,
            Make::Scene(_) | Make::Curved(..) | Make::Floor(..) | Make::Squeezed
        )
    };
    let mut best: Vec<(f64, usize)> = hopeful
        .iter()
        .enumerate()
        .filter(|(_, (_, idea))| is_whole(idea))
        .map(|(at, (left, _))| (*left, at))
        .collect();
    best.sort_by(|p, q| p.0.total_cmp(&q.0));
    best.truncate(PICTURES);
    let is_kept = |at: usize| best.iter().any(|(_, kept)| *kept == at);
    hopeful
        .into_iter()
        .enumerate()
        .filter(|(at, (_, idea))| !is_whole(idea) || is_kept(*at))
        .map(|(_, one)| one)
        .collect()
}
