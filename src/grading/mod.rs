//! Finds out what is wrong with a picture of a scene.
//!
//! In: a scene, its exact picture, and a picture that somebody else's program made. Out: a verdict
//! on the picture, and how far each object is displaced. The verdict says that the picture is
//! right, right except for sampling noise, wrong by mistakes that are named, or wrong for an
//! unknown reason.
//!
//! A hypothesis (`hypotheses`) is a program with mistakes. Its score (`scoring`) says how well the
//! picture that it would render explains the given one. The search (`search`) looks for the
//! hypothesis that explains the picture best with the fewest mistakes. Before the search,
//! `plain_facts` reports what is obvious, such as an empty picture, and `empty_pixels` removes
//! pixels that the program took no sample in. After the search, `conclusion` computes the `verdict`
//! on the picture, and `objects` judges each object. The messages come from `wording`.

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

#[cfg(feature = "json")]
#[doc(hidden)]
pub use self::json::figures;
#[cfg(feature = "cli")]
pub(crate) use self::verdict::about;
use self::{
    empty_pixels::without_empty,
    hypotheses::{Candidate, Curve, mistakes},
    scoring::{Moments, Rendering, Work, moments, work},
    search::{
        Judge,
        forward_selection::{self, MAX_MISTAKES},
    },
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

/// The exact picture of a scene, or of a rectangle of it, with which other pictures are compared.
/// It is computed once, even if the pictures of a whole class of students are judged.
pub struct Reference {
    /// The exact picture.
    pub exact: Exact,
    /// Rectangle of the scene's picture that is judged.
    pub part: Area,
    scene: Scene,
    correct: Arc<Rendering>,
    /// How the colours of the judged pictures are rounded, for example to bytes.
    rounding: Rounding,
    /// Work that was spent on the exact picture, in the units of [`Work`].
    work: f64,
    /// Factor by which the work allowed for each picture is multiplied.
    effort: f64,
}

/// Number of bytes per pixel that computing the exact picture needs: seven colours of three numbers
/// each. One colour is the exact mean. The [`Moments`] of a pixel are three more: a mean, its
/// variance, and the variance of a sample. While they are collected, two copies of them exist.
const BYTES_PER_PIXEL: u64 = 7 * size_of::<[f64; 3]>() as u64;

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
    /// Computes the exact picture of the rectangle `part` of a scene's picture. `rounding` says how
    /// the pictures that will be judged are rounded.
    ///
    /// # Errors
    ///
    /// Fails if `control` cancels it, or if `part` is too large or extends beyond the scene's
    /// picture.
    ///
    /// # Panics
    ///
    /// Panics if the scene breaks a condition of the language. Only a scene that was made in code,
    /// instead of read from a file, can do so. [`Scene::check`] finds such scenes.
    pub fn new(
        scene: &Scene,
        part: Area,
        rounding: Rounding,
        control: &Control,
    ) -> Result<Self, RenderError> {
        check_part(part, Area::whole(scene.image.width, scene.image.height))?;
        reserve_memory(part.width, part.height, BYTES_PER_PIXEL)?;
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

    /// Returns whether the reference was computed for this part of the picture and this rounding.
    pub fn is_for(&self, part: Area, rounding: Rounding) -> bool {
        self.part == part && self.rounding == rounding
    }

    /// Compares a picture with the exact one. Pixels count as equal if they differ by at most
    /// `steps` 8-bit steps plus the error bound of the exact picture.
    ///
    /// # Errors
    ///
    /// Fails if their sizes differ.
    pub fn compare(&self, film: &Film, steps: f64) -> Result<Comparison, SizesDiffer> {
        film::compare(film, &self.exact.film, self.tolerance(steps))
    }

    /// Returns the tolerance of a comparison: `steps` 8-bit steps, plus the error bound of the
    /// exact picture.
    pub fn tolerance(&self, steps: f64) -> Tolerance<'_> {
        Tolerance {
            steps,
            bounds: Some(&self.exact.bounds),
        }
    }

    /// Sets the factor by which the limit on the work for each judged picture is multiplied.
    #[must_use]
    pub fn with_effort(self, effort: f64) -> Self {
        Self { effort, ..self }
    }

    /// Judges a picture. `comparison` is the result of [`compare`](Self::compare) for this picture.
    /// If the picture comes from a JPEG file, `jpeg` says how the file is coded.
    ///
    /// # Errors
    ///
    /// Fails if it is cancelled.
    ///
    /// # Panics
    ///
    /// Panics if the size of the picture or of the comparison differs from that of the exact
    /// picture.
    pub fn judge(
        &self,
        picture: &Picture,
        jpeg: Option<Jpeg>,
        comparison: &Comparison,
        cancel: &AtomicBool,
    ) -> Result<Verdict, RenderError> {
        let size = [self.part.width, self.part.height];
        let film = &picture.film;
        for given in [
            [film.width(), film.height()],
            [comparison.width, comparison.height],
        ] {
            assert_eq!(given, size, "the picture to judge has another size");
        }
        if comparison.is_equal() {
            return Ok(Verdict::without_mistakes(Kind::Right, &self.scene));
        }
        let Some(opacity) = &picture.opacity else {
            return self.judge_opaque(&picture.film, jpeg, cancel);
        };
        // A transparent picture is judged up to two times. First, it is judged as it appears on
        // black. If it is wrong, or if no pixel is opaque, its colours are then judged as if every
        // pixel were opaque. A picture whose alpha is 0 everywhere shows nothing, so its colours
        // are not judged.
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
        // If rows at the top or bottom have one colour, either the program never wrote them, or its
        // camera sees something else there. The rows are reported as never written if the rest of
        // the picture is right.
        if let Some((rest, fact)) = plain_facts::without_empty_rows(film, exact) {
            let rest = self.judge_full(&rest, jpeg, 0, cancel)?;
            if matches!(rest.kind, Kind::Right | Kind::Noise) {
                return Ok(rest.with_fact(fact));
            }
        }
        self.judge_full(film, jpeg, MAX_MISTAKES, cancel)
    }

    /// Judges a picture by a search for the mistakes of the program that made it. The search finds
    /// at most `most` mistakes. In addition, it may find a few that are visible only at edges.
    /// Pixels in which the program took no sample are ignored.
    fn judge_full(
        &self,
        film: &Film,
        jpeg: Option<Jpeg>,
        most: usize,
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
        let found = forward_selection::run(&judge, most)?;
        // The verdict must be complete, so the limit on work does not apply to it.
        let conclude = || conclusion::conclude(&judge, &film, found);
        let verdict = judge.work.without_limit(conclude);
        Ok(cancel::unless_set(cancel, verdict)?)
    }
}

/// Iterates over the identifiers of all rows of the table of mistakes.
pub fn mistake_ids() -> impl Iterator<Item = &'static str> {
    let rows = mistakes::ROWS.iter().chain(mistakes::OBJECT_ROWS);
    rows.map(|row| row.id)
}
