//! A picture under judgement: its grids, its work, and how well candidates explain it.

use std::sync::{Arc, atomic::AtomicBool};

use super::{
    Reference,
    candidate::Candidate,
    grid::Grid,
    level::Level,
    levenberg_marquardt::{Fitted, fit},
    likelihood::Score,
    prediction::Prediction,
    rendering::Rendering,
    work::{self, Work},
};
use crate::{
    area::Area,
    film::{Film, Jpeg},
    scene::Scene,
};

/// The longest sides of the grids, in cells.
const TINY: u32 = 32;
const COARSE: u32 = 48;
const MIDDLE: u32 = 96;

/// By how much of a cell numbers are varied on the middle grid.
pub const CELL_STEP: f64 = 0.25;

/// The samples in a cell of the tiny grid, on which starts are looked for.
const SAMPLES: usize = 5;

/// Of so many pixels one may show something else than samples of a program that behaves otherwise,
/// or than a JPEG.
const MISSED: usize = 4000;

/// Of so many pixels in the middle of a picture, those tell of edges.
const PIXELS_OF_EDGES: u64 = 20_000;

/// A picture that is compared with a scene.
pub struct Judge<'a> {
    pub scene: &'a Scene,
    tiny: Level<'a>,
    pub coarse: Level<'a>,
    pub middle: Level<'a>,
    pub fine: Level<'a>,
    /// The pixels in the middle of the picture.
    pub edges: Level<'a>,
    pub work: Work<'a>,
    pub cancel: &'a AtomicBool,
}

/// A candidate that was judged.
pub struct Judged {
    /// What it makes on the level that it was judged on.
    pub rendering: Arc<Rendering>,
    pub score: Score,
    /// Half a logarithm of the number of pixels for each number that was fitted, less the logarithm
    /// of the likelihood.
    pub cost: f64,
}

impl Judged {
    /// The candidate.
    pub fn candidate(&self) -> &Candidate {
        &self.rendering.candidate
    }
}

impl<'a> Judge<'a> {
    /// For a picture of a part of a scene's.
    pub fn new(
        reference: &'a Reference,
        film: &'a Film,
        jpeg: Option<Jpeg>,
        cancel: &'a AtomicBool,
    ) -> Self {
        let Reference { scene, part, .. } = *reference;
        let level = |area: Area, longest, samples| {
            let grid = Grid::new(&scene.image, area, longest);
            let corner = [area.x - part.x, area.y - part.y];
            Level::new(grid, film, corner, samples, jpeg)
        };
        let judge = Self {
            scene,
            tiny: level(part, TINY, Some(SAMPLES)),
            coarse: level(part, COARSE, None),
            middle: level(part, MIDDLE, None),
            fine: level(part, u32::MAX, None),
            edges: level(central(part), u32::MAX, None),
            work: Work::new(part.pixels(), reference.work, reference.effort, cancel),
            cancel,
        };
        for level in [&judge.coarse, &judge.middle, &judge.fine, &judge.edges] {
            level.compare_with(level.reduced(&reference.right));
        }
        judge
    }

    /// Others will be compared with this candidate.
    pub fn compare_with(&self, candidate: &Candidate) {
        for level in [&self.coarse, &self.middle, &self.fine] {
            if let Some(rendering) = level.render(candidate, &self.work) {
                level.compare_with(rendering);
            }
        }
    }

    /// The tiny level around a candidate that others are compared with. Where it is known what this
    /// makes exactly, the error of its samples is added to what is seen, so that it cancels.
    pub fn tiny(&self, candidate: &Candidate) -> Option<Level<'a>> {
        let level = &self.tiny;
        let sampled = level.render(candidate, &self.work)?;
        level.compare_with(Arc::clone(&sampled));
        let mut exact = Arc::clone(&sampled);
        let fine = self.fine.render(candidate, &self.work)?;
        if candidate.behaviour.is_right() && fine.part == self.fine.grid.cells {
            exact = level.reduced(&fine);
        }
        Some(level.with_error(&level.predict(&sampled), &level.predict(&exact)))
    }

    /// What a level should show if a candidate is right; none if that is not known.
    pub fn predicted<'b>(&self, candidate: &Candidate, level: &'b Level) -> Option<Prediction<'b>> {
        let rendering = level.render(candidate, &self.work)?;
        Some(level.predict(&rendering))
    }

    /// By how much a level differs from what a candidate makes, channel by channel; none if there
    /// was too much work before.
    pub fn differences(&self, candidate: &Candidate, level: &Level) -> Option<Vec<f64>> {
        self.work.may_go_on().then_some(())?;
        Some(self.predicted(candidate, level)?.differences())
    }

    /// Judges a candidate on a level.
    pub fn judged(&self, candidate: &Candidate, level: &Level) -> Option<Judged> {
        let rendering = level.render(candidate, &self.work)?;
        let score = level.predict(&rendering).score();
        let cost = price(level, candidate.fitted()) - score.likelihood;
        Some(Judged {
            rendering,
            score,
            cost,
        })
    }

    /// Whether what a candidate does not explain is noise wherever it is seen.
    pub fn is_even(&self, candidate: &Candidate) -> bool {
        // What samples make, or a JPEG, is never exact.
        let is_exact = candidate.behaviour.is_right() && self.fine.jpeg.is_none();
        let predicted = self.predicted(candidate, &self.fine);
        !is_exact || predicted.is_some_and(|predicted| predicted.is_even())
    }

    /// Whether it is known that nothing shows something else than a candidate for certain.
    ///
    /// The middle grid is asked first, as it costs less: what is wrong for certain in one of its
    /// cells is so in a pixel, if what the cells show is exact.
    pub fn explains_all(&self, candidate: &Candidate) -> bool {
        let is_exact = candidate.behaviour.is_right() && self.fine.jpeg.is_none();
        let has_none = |level: &Level| {
            self.work.spend(work::of_exact(0, 0, level.grid.count()));
            let predicted = self.predicted(candidate, level);
            let count = level.grid.count();
            // Samples miss corners of a square here and there, and a JPEG is coded otherwise.
            let missed = if is_exact { 0 } else { count / MISSED };
            predicted.is_some_and(|predicted| predicted.strays().are_no_more(missed))
        };
        (!is_exact || has_none(&self.middle)) && has_none(&self.fine)
    }

    /// The last numbers of a candidate, so many, fitted on a level; each is varied so as to change
    /// the picture by about so much of a cell.
    pub fn fit(
        &self,
        candidate: &Candidate,
        free: usize,
        level: &Level,
        cells: f64,
        rounds: [usize; 2],
    ) -> Option<(Candidate, Fitted)> {
        let count = candidate.numbers().len();
        let free: Vec<usize> = (count - free..count).collect();
        self.fit_numbers(candidate, &free, level, cells, rounds)
    }

    /// The numbers of a candidate at these places, fitted on the middle grid.
    pub fn fit_some(
        &self,
        candidate: &Candidate,
        free: &[usize],
        cells: f64,
        rounds: usize,
    ) -> Option<Candidate> {
        let fitted = self.fit_numbers(candidate, free, &self.middle, cells, [0, rounds]);
        fitted.map(|(candidate, _)| candidate)
    }

    fn fit_numbers(
        &self,
        candidate: &Candidate,
        free: &[usize],
        level: &Level,
        cells: f64,
        rounds: [usize; 2],
    ) -> Option<(Candidate, Fitted)> {
        let all = candidate.numbers();
        let steps = candidate.steps(cells * f64::from(level.grid.factor));
        let of = |all: &[f64]| free.iter().map(|&at| all[at]).collect::<Vec<f64>>();
        let with = |numbers: &[f64]| {
            let mut changed = all.clone();
            free.iter()
                .zip(numbers)
                .for_each(|(&at, x)| changed[at] = *x);
            candidate.with_numbers(self.scene, &changed)
        };
        let trial = |numbers: &[f64]| self.differences(&with(numbers)?, level);
        let start_on_level = level.render(candidate, &self.work)?;
        let deviations = || level.predict(&start_on_level).deviations();
        let fitted = fit(of(&all), &of(&steps), rounds, &deviations, &trial)?;
        Some((with(&fitted.numbers)?, fitted))
    }
}

/// What so many numbers cost that are fitted to a level. A part of a picture is judged as the whole
/// is: of a few pixels anything can be fitted.
pub fn price(level: &Level, fitted: usize) -> f64 {
    let [width, height] = level.grid.size().map(f64::from);
    0.5 * fitted as f64 * libm::log(width * height)
}

/// The middle of a part of a picture, of its proportions and of so many pixels at most.
fn central(part: Area) -> Area {
    let by = (PIXELS_OF_EDGES as f64 / part.pixels() as f64)
        .sqrt()
        .min(1.0);
    let [width, height] =
        [part.width, part.height].map(|length| ((f64::from(length) * by) as u32).max(1));
    // A JPEG is coded in blocks of so many pixels, at most.
    let aligned = |left: u32| left / 2 / 16 * 16;
    Area {
        x: part.x + aligned(part.width - width),
        y: part.y + aligned(part.height - height),
        width,
        height,
    }
}
