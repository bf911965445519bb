//! What is wrong with a picture of a scene.
//!
//! In: a picture that somebody made of a scene, the scene, and its exact picture. Out: a verdict:
//! right, right but for sampling noise, wrong by mistakes that are named, or wrong for an unknown
//! reason; and how far each object is off.
//!
//! 1. A `Reference` is the exact picture, and the variance of a sample in each pixel (`moments`):
//!    made once for a class. `empty_pixels` are taken out of a picture.
//! 2. A `candidate` is a program with mistakes: rows of the table in `mistakes`, numbers of the
//!    scene (`parameters`), or a `patch` that no object explains. They change its scene, its
//!    `layout`, what it does to `light`, or how it behaves.
//! 3. A `level` is the picture on a `grid`. What a candidate's program traces there is a
//!    `rendering`: exact, or by the `faulty_tracer` where it behaves as no scene can say, and on
//!    the tiny grid. Laid out, with its light changed, and with what `jpeg` does, it is a
//!    `prediction`.
//! 4. A prediction says how likely what is seen is (`likelihood`), what no sampling explains
//!    (`strays`), and whether it lies elsewhere (`displacement`).
//! 5. The `judge` of a picture has a level for each grid, and asks these of candidates; `work` is
//!    what it may spend. `levenberg_marquardt` fits numbers, `numeric_mistakes` says which, `joint`
//!    which rows were made together. `forward_selection` looks at the few best sets of mistakes, of
//!    one more each time, and `edge_rows` at what explains the picture beside them.
//! 6. A `verdict` says what was found, in the words of `wording`, and what it leaves of the
//!    `objects`.

mod candidate;
mod changes;
mod displacement;
mod edge_rows;
mod empty_pixels;
mod faulty_tracer;
mod forward_selection;
mod grid;
mod joint;
mod jpeg;
mod judge;
mod layout;
mod level;
mod levenberg_marquardt;
mod light;
mod likelihood;
mod mistakes;
mod moments;
mod numeric_mistakes;
mod objects;
mod parameters;
mod patch;
mod plain_facts;
mod plain_numbers;
mod prediction;
mod rendering;
mod strays;
mod verdict;
mod wording;
mod work;

use std::{
    borrow::Cow,
    sync::{Arc, Mutex, atomic::AtomicBool},
};

use crate::{
    area::Area,
    cancel,
    color::srgb_to_linear,
    exact::Integrator,
    film::{
        self, Comparison, Film, Jpeg, Picture, Rounding, SizesDiffer, Tolerance, reserve_memory,
    },
    lock::{lock, unpoisoned},
    render::{Control, Exact, RenderError, render_numbers},
    scene::Scene,
    tracer::World,
};

use self::{
    candidate::{Candidate, Mistake, Shows},
    empty_pixels::without_empty,
    judge::{Judge, Judged},
    light::Curve,
    moments::Moments,
    plain_facts::EmptyRows,
    rendering::Rendering,
    strays::WRONG,
};
pub use self::{
    objects::ObjectVerdict,
    verdict::{Kind, NamedMistake, Verdict},
};

/// What pictures of a part of a scene's are judged by: made once for a whole class.
pub struct Reference<'a> {
    /// The exact picture.
    pub exact: Exact,
    /// The part.
    pub part: Area,
    scene: &'a Scene,
    right: Arc<Rendering>,
    /// How pictures are rounded that it can judge.
    rounding: Rounding,
    /// The work of making it.
    work: f64,
    /// What the work is multiplied by that may be spent on a picture.
    effort: f64,
}

/// What a reference takes for each pixel: the exact mean, and the mean, its doubt and the variance,
/// of which there are two while they are made.
const BYTES_A_PIXEL: u64 = 7 * size_of::<[f64; 3]>() as u64;

impl<'a> Reference<'a> {
    /// Makes the exact picture of a part of a scene's, as well as pictures that are rounded so are
    /// to be judged by it.
    ///
    /// # Errors
    ///
    /// It is cancelled, or too large.
    pub fn new(
        scene: &'a Scene,
        part: Area,
        rounding: Rounding,
        control: &Control,
    ) -> Result<Self, RenderError> {
        reserve_memory(part.width, part.height, BYTES_A_PIXEL)?;
        let world = World::new_unless(scene, control.cancel)?;
        let integrator = Integrator::for_values(&world, moments::numbers(Curve::Right));
        let integrator = match rounding {
            Rounding::Byte => integrator.with_tolerance(work::KNOWN),
            _ => integrator,
        };
        let all = Mutex::new(Moments::zero(part.pixels() as usize));
        let exact = render_numbers(&integrator, part, control, &|tile, pixels| {
            let mut all = lock(&all);
            let pixels = pixels.iter().map(moments::moments);
            all.put(part, tile, &Moments::exact(pixels));
        })?;
        let moments = unpoisoned(all.into_inner());
        let pixels = part.pixels() as usize;
        let work = work::of_exact(integrator.work(), scene.objects.len(), pixels);
        Ok(Self {
            exact,
            scene,
            part,
            rounding,
            right: Arc::new(Rendering::new(
                Candidate::right(scene),
                part,
                Arc::new(moments),
            )),
            work,
            effort: 1.0,
        })
    }

    /// Whether it can judge a picture of a part that is rounded so.
    pub fn is_for(&self, part: Area, rounding: Rounding) -> bool {
        self.part == part && self.rounding == rounding
    }

    /// How far a picture is from the exact one.
    ///
    /// # Errors
    ///
    /// Their sizes differ.
    pub fn compare(&self, film: &Film, steps: f64) -> Result<Comparison, SizesDiffer> {
        film::compare(film, &self.exact.film, self.tolerance(steps))
    }

    /// So many steps, and the exact picture's own bound on top.
    pub fn tolerance(&self, steps: f64) -> Tolerance<'_> {
        Tolerance {
            steps,
            bounds: Some(&self.exact.bounds),
        }
    }

    /// The same, which multiplies by this what work may be spent on a picture.
    #[must_use]
    pub fn with_effort(self, effort: f64) -> Self {
        Self { effort, ..self }
    }

    /// Judges a picture; `comparison` is that with the exact one, and `jpeg` is how its file is
    /// coded, if it is one.
    ///
    /// # Errors
    ///
    /// It is not wanted any more.
    pub fn judge(
        &self,
        picture: &Picture,
        jpeg: Option<Jpeg>,
        comparison: &Comparison,
        cancel: &AtomicBool,
    ) -> Result<Verdict, RenderError> {
        if comparison.is_equal() {
            return Ok(Verdict::of(Kind::Right, self.scene));
        }
        let Some(opacity) = &picture.opacity else {
            return self.judge_opaque(&picture.film, jpeg, cancel);
        };
        // What is transparent is seen on black: that may be right if nothing else is transparent,
        // and else its colours are judged as they are without alpha.
        let verdict = self.judge_opaque(&picture.film, jpeg, cancel)?;
        let is_right = matches!(verdict.kind, Kind::Right | Kind::Noise);
        if is_right && opacity.range[1] == 1.0 {
            return Ok(verdict);
        }
        let told = plain_facts::transparent(opacity.range);
        if opacity.range[1] == 0.0 {
            return Ok(Verdict::of(Kind::Right, self.scene).beside(told));
        }
        let steps = picture.rounding.steps();
        let is_equal = self.compare(&opacity.film, steps);
        let verdict = match is_equal.is_ok_and(|comparison| comparison.is_equal()) {
            true => Verdict::of(Kind::Right, self.scene),
            false => self.judge_opaque(&opacity.film, jpeg, cancel)?,
        };
        Ok(verdict.beside(told))
    }

    fn judge_opaque(
        &self,
        film: &Film,
        jpeg: Option<Jpeg>,
        cancel: &AtomicBool,
    ) -> Result<Verdict, RenderError> {
        let exact = &self.exact.film;
        if let Some(fact) = plain_facts::nothing_in_it(film, exact, self.scene) {
            let mut verdict = Verdict::of(Kind::Wrong, self.scene).beside(fact);
            verdict
                .objects
                .iter_mut()
                .for_each(|one| one.is_right = false);
            return Ok(verdict);
        }
        let Some(empty) = EmptyRows::of(film, exact) else {
            return self.judge_full(film, jpeg, cancel);
        };
        // Rows of one colour may be those of a camera that looks elsewhere.
        let rest = self.judge_full(&empty.left_out(film), jpeg, cancel)?;
        match rest.kind {
            Kind::Right | Kind::Noise => Ok(rest.beside(empty.told())),
            Kind::Wrong | Kind::Unknown => self.judge_full(film, jpeg, cancel),
        }
    }

    /// Judges a picture that has something in it.
    fn judge_full(
        &self,
        film: &Film,
        jpeg: Option<Jpeg>,
        cancel: &AtomicBool,
    ) -> Result<Verdict, RenderError> {
        let empties = [self.scene.image.background.to_linear(), [0.0; 3]];
        let mut without = empties
            .iter()
            .filter_map(|empty| without_empty(film, &self.right.right, *empty));
        let without = jpeg.is_none().then(|| without.next()).flatten();
        let film = without.map_or(Cow::Borrowed(film), Cow::Owned);
        let judge = Judge::new(self, &film, jpeg, cancel);
        let found = forward_selection::run(&judge)?;
        // What was found is told, however much work that is.
        let tell = || told(&judge, &film, found);
        let verdict = judge.work.without_limit(tell);
        Ok(cancel::unless_set(cancel, verdict)?)
    }
}

fn told(judge: &Judge, film: &Film, found: Option<(Judged, bool)>) -> Verdict {
    let (scene, jpeg) = (judge.scene, judge.fine.jpeg);
    let right = Candidate::right(scene);
    // What is told takes work, too. What explains a picture ends the search, not the bound.
    let is_explained = matches!(found, Some((_, true)));
    let is_cut = judge.work.is_cut() && !is_explained;
    let mut verdict = match found {
        Some((found, is_explained)) if !found.candidate().mistakes.is_empty() => {
            wrong(judge, &found, is_explained, is_cut)
        }
        Some((_, true)) if !has_other_colors(film, scene, jpeg) => {
            let judged = judge.judged(&right, &judge.fine);
            Verdict {
                samples: judged.and_then(|judged| judged.score.samples),
                ..Verdict::of(Kind::Noise, scene)
            }
        }
        _ => {
            let (objects, is_background_right) = objects::judged(judge, &right);
            Verdict {
                objects,
                is_background_right,
                is_cut,
                ..Verdict::of(Kind::Unknown, scene)
            }
        }
    };
    verdict.is_coded = jpeg.is_some();
    verdict
}

/// Whether a picture has a channel that is less or more than in all colours of the scene, which no
/// mean of them is.
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

/// The verdict on a picture with mistakes: they are named if together they explain it, and else
/// they are guesses.
fn wrong(judge: &Judge, found: &Judged, is_explained: bool, is_cut: bool) -> Verdict {
    let (scene, last) = (judge.scene, found.candidate());
    // The squared difference on the same grid for all, less what noise leaves of it in the end. Of
    // half a pixel only pixels tell.
    let level = match last.is_shifted() || last.is_filtered() {
        true => judge.edges(),
        false => &judge.middle,
    };
    let judged = |candidate: &Candidate| judge.judged(candidate, level);
    let noise = judged(last).map_or(0.0, |last| last.score.noise);
    let beyond = |candidate: &Candidate| {
        judged(candidate).map_or(0.0, |found| (found.score.squares - noise).max(0.0))
    };
    let mut before = Candidate::right(scene);
    let all = beyond(&before).max(1e-12);
    let mut left = all;
    let mut mistakes = Vec::new();
    // The one first that leaves least: one may make more difference where another hides it.
    let mut others: Vec<&Mistake> = last.mistakes.iter().collect();
    while !others.is_empty() {
        let with = |(at, mistake): (usize, &&Mistake)| {
            let after = before.with((*mistake).clone())?;
            Some((beyond(&after), at, after))
        };
        let with = others.iter().enumerate().filter_map(with);
        let Some((now, at, after)) = with.min_by(|one, other| one.0.total_cmp(&other.0)) else {
            break;
        };
        let mistake = others.remove(at);
        let set = parameters::arguments(&before.scene, &after.scene);
        let mut message = mistake.message(scene);
        if let (Mistake::Row(..), [_]) = (mistake, &set[..])
            && let [changed] = &parameters::changed(&before.scene, &after.scene)[..]
            && let Some((should, is)) = changed
                .value(&before.scene)
                .zip(changed.value(&after.scene))
        {
            message = format!("{message}: {is} instead of {should}");
        }
        for other in is_explained
            .then(|| equals(judge, last, mistake))
            .into_iter()
            .flatten()
        {
            message = format!(
                "{message}; or, in a picture like this, {}",
                other.message(scene)
            );
        }
        mistakes.push(NamedMistake {
            id: mistake.id(),
            message,
            help: mistake.help(scene),
            set,
            explains: ((left - now) / all).clamp(0.0, 1.0),
        });
        (left, before) = (now, after);
    }
    let square = |candidate: &Candidate| {
        let shown = judge.predicted(candidate, &judge.fine);
        shown.map_or(f64::INFINITY, |shown| shown.strays().square())
    };
    let rest = (!is_explained).then(|| square(last) / square(&Candidate::right(scene)));
    let rest = rest.filter(|rest| *rest > 0.0).map(|rest| rest.min(1.0));
    mistakes.retain(|mistake| is_explained || mistake.explains > 0.0);
    let is_told = !is_cut && !mistakes.is_empty() && is_explained;
    let (kind, mistakes, guesses) = match is_told {
        true => (Kind::Wrong, mistakes, Vec::new()),
        false => (Kind::Unknown, Vec::new(), mistakes),
    };
    // Of a guess nothing is known of single objects.
    let (objects, is_background_right) = match is_told {
        true => objects::judged(judge, last),
        false => objects::judged(judge, &Candidate::right(scene)),
    };
    Verdict {
        samples: found.score.samples,
        rest,
        mistakes,
        guesses,
        objects,
        is_background_right,
        is_cut,
        ..Verdict::of(kind, scene)
    }
}

/// Rows of the same word that explain the picture as well in the place of one: nobody knows which
/// of them it is.
fn equals(judge: &Judge, candidate: &Candidate, told: &Mistake) -> Vec<Mistake> {
    let Mistake::Row(row, object) = told else {
        return Vec::new();
    };
    let rows = mistakes::ROWS.iter().chain(mistakes::OBJECT_ROWS);
    let others = rows.filter(|other| other.id == row.id && other.message != row.message);
    let others = others.filter(|other| other.shows == Shows::InAreas);
    let others = others.map(|other| Mistake::Row(other, *object));
    let explains = |other: &Mistake| {
        let replaced = candidate
            .mistakes
            .iter()
            .map(|one| match one.is_alike(told) {
                true => other.clone(),
                false => one.clone(),
            });
        let replaced = Candidate::of(judge.scene, replaced);
        replaced.is_some_and(|replaced| judge.explains(&replaced))
    };
    others.filter(explains).collect()
}

/// The words for programs of all mistakes that the table has.
pub fn mistake_ids() -> impl Iterator<Item = &'static str> {
    let rows = mistakes::ROWS.iter().chain(mistakes::OBJECT_ROWS);
    rows.map(|row| row.id)
}
