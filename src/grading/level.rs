//! The picture that is judged, at one resolution: what it shows in the cells of a grid, and what
//! candidates should show there.

use std::{
    cell::{OnceCell, RefCell},
    collections::HashMap,
    sync::Arc,
};

use glam::DVec3;

use super::{
    candidate::Candidate,
    grid::Grid,
    jpeg::{coded, variances},
    light::Curve,
    moments::Moments,
    prediction::Prediction,
    rendering::Rendering,
    work::Work,
};
use crate::film::{Film, Jpeg};

/// A grid over a part of a picture.
pub struct Level<'a> {
    pub grid: Grid,
    film: &'a Film,
    /// The part's corner in the film.
    corner: [u32; 2],
    /// What it shows in the cells, as light that was encoded in each way, where that was asked
    /// for.
    seen: [OnceCell<Vec<DVec3>>; Curve::COUNT],
    /// How many samples a cell has; none if it is computed exactly.
    samples: Option<usize>,
    pub jpeg: Option<Jpeg>,
    /// What others are compared with, to make anew only where they differ.
    base: RefCell<Option<Arc<Rendering>>>,
    /// What was made last.
    last: RefCell<Option<Arc<Rendering>>>,
}

impl<'a> Level<'a> {
    /// Of a grid over the part of a film that has this corner.
    pub fn new(
        grid: Grid,
        film: &'a Film,
        corner: [u32; 2],
        samples: Option<usize>,
        jpeg: Option<Jpeg>,
    ) -> Self {
        Self {
            grid,
            film,
            corner,
            seen: std::array::from_fn(|_| OnceCell::new()),
            samples,
            jpeg,
            base: RefCell::default(),
            last: RefCell::default(),
        }
    }

    /// The same, where all that is compared is off by what one prediction differs from an exact
    /// one.
    pub fn with_error(&self, sampled: &Prediction, exact: &Prediction) -> Self {
        let mut level = Self::new(self.grid, self.film, self.corner, self.samples, self.jpeg);
        level.base = self.base.clone();
        let means = sampled.moments.mean.iter().zip(&exact.moments.mean);
        let errors: Vec<DVec3> = means.map(|(sampled, exact)| sampled - exact).collect();
        for (at, curve) in Curve::ALL.into_iter().enumerate() {
            let seen = self.seen(curve).iter().zip(&errors);
            level.seen[at].get_or_init(|| seen.map(|(seen, error)| seen + error).collect());
        }
        level
    }

    /// What a candidate makes on it; none if it is cancelled, or takes too much work.
    pub fn render(&self, candidate: &Candidate, work: &Work) -> Option<Arc<Rendering>> {
        let known = [&self.base, &self.last];
        let known = known.map(|one| one.borrow().clone());
        let known: Vec<_> = known.into_iter().flatten().collect();
        let rendering = candidate.render(&self.grid, self.samples, &known, work)?;
        let rendering = Arc::new(rendering);
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

    /// Others will be compared with this.
    pub fn compare_with(&self, rendering: Arc<Rendering>) {
        self.base.replace(Some(rendering));
    }

    /// What the picture shows in the cells, as light that was encoded in a way.
    pub fn seen(&self, curve: Curve) -> &[DVec3] {
        self.seen[curve as usize].get_or_init(|| {
            let [left, top] = self.corner;
            let pixel = |x, y| DVec3::from(self.film.pixel(left + x, top + y));
            if curve == Curve::Right {
                return self.grid.reduce(pixel);
            }
            // Most pixels have one of a few bytes.
            let lights: RefCell<HashMap<u64, f64>> = RefCell::default();
            let light = |seen: f64| {
                let mut lights = lights.borrow_mut();
                let light = lights.entry(seen.to_bits());
                *light.or_insert_with(|| curve.light(seen))
            };
            self.grid.reduce(|x, y| pixel(x, y).map(light))
        })
    }

    /// What the cells show of something whose pixels are known, all of those of a part.
    pub fn reduced(&self, rendering: &Arc<Rendering>) -> Arc<Rendering> {
        let (pixels, part) = (&rendering.right, rendering.part);
        if part == self.grid.cells {
            return Arc::clone(rendering);
        }
        let [left, top] = self.corner;
        let index = |x: u32, y: u32| ((top + y) * part.width + left + x) as usize;
        let mean = self.grid.reduce(|x, y| pixels.mean[index(x, y)]);
        let squares = self.grid.reduce(|x, y| {
            let (mean, variance) = (pixels.mean[index(x, y)], pixels.variance[index(x, y)]);
            mean * mean + variance
        });
        let variance =
            |(mean, square): (DVec3, DVec3)| (mean, (square - mean * mean).max(DVec3::ZERO));
        let moments = Moments::exact(mean.into_iter().zip(squares).map(variance));
        let candidate = rendering.candidate.clone();
        Arc::new(Rendering::new(
            candidate,
            self.grid.cells,
            Arc::new(moments),
        ))
    }

    /// What it should show if a candidate is right.
    pub fn predict(&self, rendering: &Rendering) -> Prediction<'_> {
        let candidate = &rendering.candidate;
        let (seen, moments) = (self.seen(candidate.curve), rendering.laid_out(&self.grid));
        let mut prediction = Prediction::new(seen, self.grid.width(), moments, candidate.curve);
        prediction.look(&candidate.looks, &self.grid);
        if let Some(jpeg) = self.jpeg {
            let factor = self.grid.factor as usize;
            let variances = variances(&jpeg, &prediction, factor);
            let coded = match factor {
                1 => coded(&jpeg, &prediction, self.grid.cells),
                _ => None,
            };
            let moments = Arc::make_mut(&mut prediction.moments);
            moments.add_doubt(&variances);
            if let Some(coded) = coded {
                moments.mean = coded;
            }
        }
        prediction
    }
}
