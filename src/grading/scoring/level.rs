//! A picture at one resolution, divided into the cells of a grid. This module predicts what the
//! cells would show if a hypothesis about the program were correct.

use std::{
    cell::{OnceCell, RefCell},
    collections::HashMap,
    sync::Arc,
};

use glam::DVec3;

use super::{
    grid::Grid,
    jpeg::{coded, variances},
    moments::Moments,
    prediction::Prediction,
    rendering::Rendering,
    work::Work,
};
use crate::{
    area::Area,
    film::{Film, Jpeg},
    grading::hypotheses::{Candidate, Curve},
};

/// A picture, or a rectangle of it, at one resolution. Hypotheses about the program that made the
/// picture are compared with it.
pub struct Level<'a> {
    pub grid: Grid,
    film: &'a Film,
    /// The rectangle of the whole picture that the film shows.
    part: Area,
    /// Observed light of the cells, for each encoding curve that the program may have used.
    /// Computed on demand.
    observed: [OnceCell<Vec<DVec3>>; Curve::COUNT],
    /// Number of samples per cell with which hypotheses are rendered; `None` if they are rendered
    /// exactly.
    samples: Option<usize>,
    pub jpeg: Option<Jpeg>,
    /// Rendering of an earlier hypothesis, chosen by [`Level::compare_with`]. A new hypothesis is
    /// rendered only where its picture differs from this rendering.
    base: RefCell<Option<Arc<Rendering>>>,
    /// Rendering of the last hypothesis. Like `base`, it is reused: the next hypothesis is compared
    /// with both, and rendered only where it differs from the more similar one.
    last: RefCell<Option<Arc<Rendering>>>,
}

impl<'a> Level<'a> {
    /// Creates a level from a picture and a grid. The film shows the rectangle `part` of the whole
    /// picture. `samples` is the number of samples per cell with which hypotheses about the program
    /// are rendered, or `None` to render them exactly.
    pub fn new(
        grid: Grid,
        film: &'a Film,
        part: Area,
        samples: Option<usize>,
        jpeg: Option<Jpeg>,
    ) -> Self {
        Self {
            grid,
            film,
            part,
            observed: std::array::from_fn(|_| OnceCell::new()),
            samples,
            jpeg,
            base: RefCell::default(),
            last: RefCell::default(),
        }
    }

    /// Returns a copy of the level in which the observed light can be compared with sampled
    /// predictions. Similar hypotheses have almost the same sampling error, so this error is added
    /// to the observed light, and cancels in comparisons. It is the difference of `sampled` and
    /// `exact`, two predictions of one hypothesis.
    pub fn with_error(&self, sampled: &Prediction, exact: &Prediction) -> Self {
        let mut level = Self::new(self.grid, self.film, self.part, self.samples, self.jpeg);
        level.base = self.base.clone();
        let means = sampled.moments.mean.iter().zip(&exact.moments.mean);
        let errors: Vec<DVec3> = means.map(|(sampled, exact)| sampled - exact).collect();
        for (at, curve) in Curve::ALL.into_iter().enumerate() {
            let seen = self.observed(curve).iter().zip(&errors);
            level.observed[at].get_or_init(|| seen.map(|(seen, error)| seen + error).collect());
        }
        level
    }

    /// Renders a hypothesis about the program in the cells of the level's grid. Returns `None` if
    /// the work is cancelled or exceeds its budget.
    pub fn render(&self, candidate: &Candidate, work: &Work) -> Option<Arc<Rendering>> {
        let known = [&self.base, &self.last].map(|one| one.borrow().clone());
        let known: Vec<_> = known.into_iter().flatten().collect();
        let rendering = Arc::new(candidate.render(&self.grid, self.samples, &known, work)?);
        let is_same = |one: &Arc<Rendering>| {
            one.part == rendering.part
                && one.candidate.traces_as(candidate)
                && one.candidate.behaviour == candidate.behaviour
        };
        if !known.iter().any(is_same) {
            self.last.replace(Some(Arc::clone(&rendering)));
        }
        Some(rendering)
    }

    /// Sets the rendering that later hypotheses reuse (`base`). They are rendered only where their
    /// pictures differ from this rendering.
    pub fn compare_with(&self, rendering: Arc<Rendering>) {
        self.base.replace(Some(rendering));
    }

    /// Returns the mean light of the pixels in each cell of the grid, assuming that the program
    /// that made the picture encoded light by `curve`.
    pub fn observed(&self, curve: Curve) -> &[DVec3] {
        self.observed[curve as usize].get_or_init(|| {
            let pixel = |x, y| DVec3::from(self.film.pixels()[self.part.index(x, y)]);
            if curve == Curve::Correct {
                return self.grid.reduce(pixel);
            }
            // Most pixels have one of a few values, so the decoded values are cached.
            let lights: RefCell<HashMap<u64, f64>> = RefCell::default();
            let light = |seen: f64| {
                let mut lights = lights.borrow_mut();
                let light = lights.entry(seen.to_bits());
                *light.or_insert_with(|| curve.light(seen))
            };
            self.grid.reduce(|x, y| pixel(x, y).map(light))
        })
    }

    /// Averages a rendering over the cells of the level's grid. The rendering contains all pixels
    /// of the compared rectangle.
    pub fn reduced(&self, rendering: &Arc<Rendering>) -> Arc<Rendering> {
        let (pixels, part) = (&rendering.correct, rendering.part);
        if part == self.grid.cells {
            return Arc::clone(rendering);
        }
        let mean = self.grid.reduce(|x, y| pixels.mean[part.index(x, y)]);
        let squares = self.grid.reduce(|x, y| {
            let at = part.index(x, y);
            let (mean, variance) = (pixels.mean[at], pixels.variance[at]);
            mean * mean + variance
        });
        let variance =
            |(mean, square): (DVec3, DVec3)| (mean, (square - mean * mean).max(DVec3::ZERO));
        let moments = Moments::exact(mean.into_iter().zip(squares).map(variance));
        let (candidate, moments) = (rendering.candidate.clone(), Arc::new(moments));
        Arc::new(Rendering::new(candidate, self.grid.cells, moments))
    }

    /// Predicts what the level's cells show if the rendered hypothesis about the program is
    /// correct.
    pub fn predict(&self, rendering: &Rendering) -> Prediction<'_> {
        let candidate = &rendering.candidate;
        let seen = self.observed(candidate.curve);
        let moments = rendering.laid_out(&self.grid);
        let mut prediction = Prediction::new(seen, self.grid.width(), moments, candidate.curve);
        prediction.apply(&candidate.effects, &self.grid);
        if let Some(jpeg) = self.jpeg {
            let factor = self.grid.factor as usize;
            let variances = variances(&jpeg, &prediction, factor);
            let is_single = factor == 1;
            let coded = is_single.then(|| coded(&jpeg, &prediction, self.grid.cells));
            let moments = Arc::make_mut(&mut prediction.moments);
            moments.add_mean_variance(&variances);
            if let Some(coded) = coded.flatten() {
                moments.mean = coded;
            }
        }
        prediction
    }
}
