//! A picture under judgement: its levels, its budget of work, and the operations of the search.

use std::sync::Arc;

use super::levenberg_marquardt::{Fitted, absolute, fit};
use crate::{
    area::Area,
    film::{Film, Jpeg},
    grading::{
        hypotheses::{Candidate, Effect},
        scoring::{Grid, Level, Prediction, Rendering, Score, Work, work},
    },
    scene::Scene,
};

/// Longest side of the grid on which mistakes are selected, in cells.
const TINY: u32 = 32;
/// Longest side of the grid on which numbers are first fitted, in cells.
const COARSE: u32 = 48;
/// Longest side of the grid on which candidates are judged, in cells.
const MIDDLE: u32 = 96;

/// Change of the picture, in cells, by which numbers are varied to find their derivatives.
pub const CELL_STEP: f64 = 0.25;

/// Number of samples in each cell of the tiny grid (`TINY`), on which mistakes are selected.
const SAMPLES: usize = 5;

/// Number of pixels in the central crop of a picture on which edges are judged. More pixels
/// determine edges better, at proportionally more work.
const CENTRAL_PIXELS: u64 = 20_000;

/// A picture that is compared with a scene.
pub struct Judge<'a> {
    pub scene: &'a Scene,
    tiny: Level<'a>,
    pub coarse: Level<'a>,
    pub middle: Level<'a>,
    pub fine: Level<'a>,
    /// The central crop at full resolution, if it is not the whole picture.
    central: Option<Level<'a>>,
    pub work: Work<'a>,
}

/// A candidate that was judged on a level.
pub struct Judged {
    /// Its rendering on that level.
    pub rendering: Arc<Rendering>,
    pub score: Score,
    /// Cost: `price` of the candidate's parameters, less the logarithm of the likelihood.
    pub cost: f64,
}

impl Judged {
    /// Returns the candidate.
    pub fn candidate(&self) -> &Candidate {
        &self.rendering.candidate
    }
}

impl<'a> Judge<'a> {
    /// Prepares a picture for judging; `exact` is what a correct program renders of its part.
    pub fn new(
        scene: &'a Scene,
        exact: &Arc<Rendering>,
        film: &'a Film,
        jpeg: Option<Jpeg>,
        work: Work<'a>,
    ) -> Self {
        let part = exact.part;
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
            central: central(part).map(|part| level(part, u32::MAX, None)),
            work,
        };
        let levels = [&judge.coarse, &judge.middle, &judge.fine];
        for level in levels.into_iter().chain(&judge.central) {
            level.compare_with(level.reduced(exact));
        }
        judge
    }

    /// Returns the level on which numbers are fitted: the middle one, or pixels if a curve is
    /// applied to light, because a curve of a mean is not the mean of the curve.
    pub fn fitting(&self, candidate: &Candidate) -> &Level<'a> {
        let is_curve = |effect: &Effect| {
            matches!(
                effect,
                Effect::PerChannel(_) | Effect::Gain(_) | Effect::CutOff
            )
        };
        if candidate.effects.iter().any(is_curve) {
            self.central_crop()
        } else {
            &self.middle
        }
    }

    /// Returns the level on which edges are judged.
    pub fn central_crop(&self) -> &Level<'a> {
        self.central.as_ref().unwrap_or(&self.fine)
    }

    /// Makes a candidate the base of the levels, so that later ones are rendered only where they
    /// differ.
    pub fn compare_with(&self, candidate: &Candidate) {
        for level in [&self.coarse, &self.middle, &self.fine] {
            if let Some(rendering) = level.render(candidate, &self.work) {
                level.compare_with(rendering);
            }
        }
    }

    /// Returns the tiny level for comparisons with a candidate. If the candidate's exact picture is
    /// known, the error of its samples is added to the observed light, so that it cancels.
    pub fn tiny(&self, candidate: &Candidate) -> Option<Level<'a>> {
        let level = &self.tiny;
        let sampled = level.render(candidate, &self.work)?;
        level.compare_with(Arc::clone(&sampled));
        let mut exact = Arc::clone(&sampled);
        if candidate.behaviour.is_correct() {
            let fine = self.fine.render(candidate, &self.work)?;
            if fine.part == self.fine.grid.cells {
                exact = level.reduced(&fine);
            }
        }
        Some(level.with_error(&level.predict(&sampled), &level.predict(&exact)))
    }

    /// Predicts what a level shows if a candidate is correct. Returns `None` if the budget is used
    /// up.
    pub fn predicted<'b>(&self, candidate: &Candidate, level: &'b Level) -> Option<Prediction<'b>> {
        let rendering = level.render(candidate, &self.work)?;
        self.work
            .spend(work::COMPARISON * level.grid.count() as f64);
        Some(level.predict(&rendering))
    }

    /// Returns the differences of a level from a candidate's prediction, channel by channel.
    /// Returns `None` if the budget is used up.
    pub fn differences(&self, candidate: &Candidate, level: &Level) -> Option<Vec<f64>> {
        self.work.check()?;
        Some(self.predicted(candidate, level)?.differences())
    }

    /// Returns a candidate with the sum of its absolute differences on a level.
    pub fn with_difference(&self, candidate: Candidate, level: &Level) -> Option<(f64, Candidate)> {
        let differences = self.differences(&candidate, level)?;
        Some((absolute(&differences), candidate))
    }

    /// Judges a candidate on a level.
    pub fn judged(&self, candidate: &Candidate, level: &Level) -> Option<Judged> {
        let rendering = level.render(candidate, &self.work)?;
        let score = level.predict(&rendering).score();
        let cost = price(level, candidate.parameter_count()) - score.likelihood;
        Some(Judged {
            rendering,
            score,
            cost,
        })
    }

    /// Fits the numbers of a candidate at the indices `free`. Each is varied so that the picture
    /// moves by about `cells` cells.
    pub fn fit(
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
            for (&at, x) in free.iter().zip(numbers) {
                changed[at] = *x;
            }
            candidate.with_numbers(self.scene, &changed)
        };
        let trial = |numbers: &[f64]| self.differences(&with(numbers)?, level);
        let start_on_level = level.render(candidate, &self.work)?;
        let deviations = || level.predict(&start_on_level).deviations();
        let fitted = fit(of(&all), &of(&steps), rounds, &deviations, &trial)?;
        Some((with(&fitted.numbers)?, fitted))
    }
}

/// Returns the cost of `fitted` parameters: half a logarithm of the number of cells each. A part of
/// a picture is judged like the whole, because anything can be fitted to a few pixels.
pub fn price(level: &Level, fitted: usize) -> f64 {
    let [width, height] = level.grid.size().map(f64::from);
    0.5 * fitted as f64 * libm::log(width * height)
}

/// Returns at most `most` items, least first.
pub fn least<T>(all: impl Iterator<Item = (f64, T)>, most: usize) -> Vec<(f64, T)> {
    let mut all: Vec<_> = all.collect();
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    all.truncate(most);
    all
}

/// Returns the central crop of a part, with its aspect ratio. Returns `None` if the part has no
/// more pixels than the crop.
fn central(part: Area) -> Option<Area> {
    if part.pixels() <= CENTRAL_PIXELS {
        return None;
    }
    let by = (CENTRAL_PIXELS as f64 / part.pixels() as f64).sqrt();
    let [width, height] =
        [part.width, part.height].map(|length| ((f64::from(length) * by) as u32).max(1));
    // A multiple of the side of a JPEG's blocks.
    let aligned = |left: u32| left / 2 / 16 * 16;
    Some(Area {
        x: part.x + aligned(part.width - width),
        y: part.y + aligned(part.height - height),
        width,
        height,
    })
}
