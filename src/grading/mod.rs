//! What is wrong with a picture of a scene.
//!
//! In: a picture that somebody made of a scene, the scene, and its exact picture. Out: a verdict:
//! right, right but for sampling noise, wrong by mistakes that are named, or wrong for an unknown
//! reason; and how far each object is off.
//!
//! A hypothesis (`hypotheses`) is a program with mistakes. It is scored by how well what it would
//! render explains the picture (`scoring`), and the search (`search`) looks for the one that
//! explains it best with the fewest mistakes. `plain_facts` and `empty_pixels` come before the
//! search; `conclusion` makes a `verdict` of what it finds, in the words of `wording`, with one for
//! each of the `objects`.

mod conclusion;
mod empty_pixels;
mod hypotheses;
#[cfg(feature = "json")]
mod json;
mod objects;
mod plain_facts;
mod scoring;
mod search;
mod verdict;
mod wording;

use std::{
    borrow::Cow,
    fmt,
    sync::{Arc, Mutex, atomic::AtomicBool},
};

use self::{
    empty_pixels::without_empty,
    hypotheses::{Candidate, Curve, mistakes},
    plain_facts::EmptyRows,
    scoring::{Moments, Rendering, Work, moments, work},
    search::{Judge, forward_selection},
};
pub use self::{
    objects::ObjectVerdict,
    verdict::{Kind, NamedMistake, Verdict},
};
use crate::{
    area::Area,
    cancel,
    exact::Integrator,
    film::{
        self, Comparison, Film, Jpeg, Picture, Rounding, SizesDiffer, Tolerance, reserve_memory,
    },
    lock::{lock, unpoisoned},
    render::{Control, Exact, RenderError, check_part, render_numbers},
    scene::Scene,
    tracer::World,
};

/// What pictures of a part of a scene are judged by; made once for a whole class.
pub struct Reference {
    /// The exact picture.
    pub exact: Exact,
    /// The part of the scene's picture.
    pub part: Area,
    scene: Scene,
    correct: Arc<Rendering>,
    /// Rounding of the pictures that it can judge.
    rounding: Rounding,
    /// Work that was spent on it.
    work: f64,
    /// Factor of the work that may be spent on a picture.
    effort: f64,
}

/// Bytes per pixel: the exact mean, and twice the moments (mean, its variance, variance), as there
/// are two while they are computed.
const BYTES_A_PIXEL: u64 = 7 * size_of::<[f64; 3]>() as u64;

impl fmt::Debug for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = f.debug_struct("Reference");
        fields.field("part", &self.part);
        fields
            .field("rounding", &self.rounding)
            .finish_non_exhaustive()
    }
}

impl Reference {
    /// Computes the exact picture of a part of a scene, for judging pictures with some rounding.
    ///
    /// # Errors
    ///
    /// It is cancelled, too large, or no part of the scene's picture.
    ///
    /// # Panics
    ///
    /// The scene was not read, but made in code, and breaks a condition of the language;
    /// [`Scene::check`] tells.
    pub fn new(
        scene: &Scene,
        part: Area,
        rounding: Rounding,
        control: &Control,
    ) -> Result<Self, RenderError> {
        check_part(part, Area::whole(scene.image.width, scene.image.height))?;
        reserve_memory(part.width, part.height, BYTES_A_PIXEL)?;
        let world = World::new_unless(scene, control.cancel)?;
        let integrator = Integrator::for_values(&world, moments::numbers(Curve::Correct));
        let integrator = match rounding {
            Rounding::Byte => integrator.with_tolerance(work::TOLERANCE),
            _ => integrator,
        };
        let all = Mutex::new(Moments::zero(part.pixels() as usize));
        let exact = render_numbers(&integrator, part, control, &|tile, pixels| {
            let mut all = lock(&all);
            let pixels = pixels.iter().map(moments::moments);
            all.put(part, tile, &Moments::exact(pixels));
        })?;
        let moments = unpoisoned(all.into_inner());
        let correct = Rendering::new(Candidate::correct(scene), part, Arc::new(moments));
        let pixels = part.pixels() as usize;
        let work = work::of_exact(integrator.work(), scene.objects.len(), pixels);
        Ok(Self {
            exact,
            scene: scene.clone(),
            part,
            rounding,
            correct: Arc::new(correct),
            work,
            effort: 1.0,
        })
    }

    /// Returns whether it can judge a picture of a part with some rounding.
    pub fn is_for(&self, part: Area, rounding: Rounding) -> bool {
        self.part == part && self.rounding == rounding
    }

    /// Compares a picture with the exact one.
    ///
    /// # Errors
    ///
    /// Their sizes differ.
    pub fn compare(&self, film: &Film, steps: f64) -> Result<Comparison, SizesDiffer> {
        film::compare(film, &self.exact.film, self.tolerance(steps))
    }

    /// Returns a tolerance of some steps, plus the exact picture's own bound.
    pub fn tolerance(&self, steps: f64) -> Tolerance<'_> {
        Tolerance {
            steps,
            bounds: Some(&self.exact.bounds),
        }
    }

    /// Multiplies the work that may be spent on a picture.
    #[must_use]
    pub fn with_effort(self, effort: f64) -> Self {
        Self { effort, ..self }
    }

    /// Judges a picture; `comparison` compares it with the exact one, and `jpeg` is the coding of
    /// its file, if that is a JPEG.
    ///
    /// # Errors
    ///
    /// It is cancelled.
    pub fn judge(
        &self,
        picture: &Picture,
        jpeg: Option<Jpeg>,
        comparison: &Comparison,
        cancel: &AtomicBool,
    ) -> Result<Verdict, RenderError> {
        if comparison.is_equal() {
            return Ok(Verdict::without_mistakes(Kind::Right, &self.scene));
        }
        let Some(opacity) = &picture.opacity else {
            return self.judge_opaque(&picture.film, jpeg, cancel);
        };
        // A transparent picture is seen on black, which may be right if nothing in it is opaque;
        // otherwise its colours are judged without alpha.
        let verdict = self.judge_opaque(&picture.film, jpeg, cancel)?;
        let is_right = matches!(verdict.kind, Kind::Right | Kind::Noise);
        if is_right && opacity.range[1] == 1.0 {
            return Ok(verdict);
        }
        let fact = plain_facts::transparent(opacity.range);
        if opacity.range[1] == 0.0 {
            return Ok(Verdict::without_mistakes(Kind::Right, &self.scene).with_fact(fact));
        }
        let steps = picture.rounding.steps();
        let is_equal = self.compare(&opacity.film, steps);
        let verdict = if is_equal.is_ok_and(|comparison| comparison.is_equal()) {
            Verdict::without_mistakes(Kind::Right, &self.scene)
        } else {
            self.judge_opaque(&opacity.film, jpeg, cancel)?
        };
        Ok(verdict.with_fact(fact))
    }

    fn judge_opaque(
        &self,
        film: &Film,
        jpeg: Option<Jpeg>,
        cancel: &AtomicBool,
    ) -> Result<Verdict, RenderError> {
        let exact = &self.exact.film;
        let fact = plain_facts::not_finite(film)
            .or_else(|| plain_facts::empty_or_noise(film, exact, &self.scene));
        if let Some(fact) = fact {
            let mut verdict = Verdict::without_mistakes(Kind::Wrong, &self.scene).with_fact(fact);
            for object in &mut verdict.objects {
                object.is_right = false;
            }
            return Ok(verdict);
        }
        let Some(empty) = EmptyRows::of(film, exact) else {
            return self.judge_full(film, jpeg, cancel);
        };
        // Rows of one colour may be due to a camera that looks elsewhere.
        let rest = self.judge_full(&empty.removed_from(film), jpeg, cancel)?;
        match rest.kind {
            Kind::Right | Kind::Noise => Ok(rest.with_fact(empty.fact())),
            Kind::Wrong | Kind::Unknown => self.judge_full(film, jpeg, cancel),
        }
    }

    /// Judges a picture that is not empty.
    fn judge_full(
        &self,
        film: &Film,
        jpeg: Option<Jpeg>,
        cancel: &AtomicBool,
    ) -> Result<Verdict, RenderError> {
        let empties = [self.scene.image.background.to_linear(), [0.0; 3]];
        let mut without = empties
            .iter()
            .filter_map(|empty| without_empty(film, &self.correct.correct, *empty));
        let without = jpeg.is_none().then(|| without.next()).flatten();
        let film = without.map_or(Cow::Borrowed(film), Cow::Owned);
        let work = Work::new(self.part.pixels(), self.work, self.effort, cancel);
        let judge = Judge::new(&self.scene, &self.correct, &film, jpeg, work);
        let found = forward_selection::run(&judge)?;
        // The conclusion is not cut short by the budget.
        let conclude = || conclusion::conclude(&judge, &film, found);
        let verdict = judge.work.without_limit(conclude);
        Ok(cancel::unless_set(cancel, verdict)?)
    }
}

/// Iterates over the identifiers of all mistakes in the table.
pub fn mistake_ids() -> impl Iterator<Item = &'static str> {
    let rows = mistakes::ROWS.iter().chain(mistakes::OBJECT_ROWS);
    rows.map(|row| row.id)
}
