//! A picture under judgement: its grids, its work, and how well candidates explain it.

use std::sync::{Arc, atomic::AtomicBool};

use super::{
    Reference,
    candidate::Candidate,
    grid::Grid,
    level::Level,
    levenberg_marquardt::{Fitted, absolute, fit},
    light::Look,
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

/// Of so many pixels in the middle of a picture, those tell of edges.
const PIXELS_OF_EDGES: u64 = 20_000;

/// A picture that is compared with a scene.
pub struct Judge<'a> {
    pub scene: &'a Scene,
    tiny: Level<'a>,
    pub coarse: Level<'a>,
    pub middle: Level<'a>,
    pub fine: Level<'a>,
    /// The pixels in the middle of the picture, if these are not all.
    central: Option<Level<'a>>,
    pub work: Work<'a>,
    pub cancel: &'a AtomicBool,
}

/// A candidate that was judged.
pub struct Judged {
    /// What it makes on the level that it was judged on.
    pub rendering: Arc<Rendering>,
    pub score: Score,
    /// Half a logarithm of the number of pixels for each number that was fitted, less the
    /// logarithm of the likelihood.
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
            central: central(part).map(|part| level(part, u32::MAX, None)),
            work: Work::new(part.pixels(), reference.work, reference.effort, cancel),
            cancel,
        };
        let levels = [&judge.coarse, &judge.middle, &judge.fine];
        for level in levels.into_iter().chain(&judge.central) {
            level.compare_with(level.reduced(&reference.right));
        }
        judge
    }

    /// The level on which numbers are fitted: the middle one, but for a program that changes light
    /// by a curve, which does not make of the mean of pixels the mean of what it makes of them.
    pub fn fitting(&self, candidate: &Candidate) -> &Level<'a> {
        let is_curve = |look: &Look| matches!(look, Look::Curve(_) | Look::CutOff);
        match candidate.looks.iter().any(is_curve) {
            true => self.edges(),
            false => &self.middle,
        }
    }

    /// The pixels that tell of edges.
    pub fn edges(&self) -> &Level<'a> {
        self.central.as_ref().unwrap_or(&self.fine)
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
        if candidate.behaviour.is_right() {
            let fine = self.fine.render(candidate, &self.work)?;
            if fine.part == self.fine.grid.cells {
                exact = level.reduced(&fine);
            }
        }
        Some(level.with_error(&level.predict(&sampled), &level.predict(&exact)))
    }

    /// What a level should show if a candidate is right; none if that is not known.
    pub fn predicted<'b>(&self, candidate: &Candidate, level: &'b Level) -> Option<Prediction<'b>> {
        let rendering = level.render(candidate, &self.work)?;
        self.work.spend(work::PREDICTED * level.grid.count() as f64);
        Some(level.predict(&rendering))
    }

    /// By how much a level differs from what a candidate makes, channel by channel; none if there
    /// was too much work before.
    pub fn differences(&self, candidate: &Candidate, level: &Level) -> Option<Vec<f64>> {
        self.work.may_go_on().then_some(())?;
        Some(self.predicted(candidate, level)?.differences())
    }

    /// A candidate with the sum of the absolute differences that it leaves on a level.
    pub fn left(&self, candidate: Candidate, level: &Level) -> Option<(f64, Candidate)> {
        let differences = self.differences(&candidate, level)?;
        Some((absolute(&differences), candidate))
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

    /// The numbers of a candidate at these places, fitted on a level; each is varied so as to
    /// change the picture by about so much of a cell.
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

/// So many of those of which least is left, these first.
pub fn least<T>(all: impl Iterator<Item = (f64, T)>, most: usize) -> Vec<(f64, T)> {
    let mut all: Vec<_> = all.collect();
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    all.truncate(most);
    all
}

/// The middle of a part of a picture, of its proportions and of so many pixels; none if it has no
/// more.
fn central(part: Area) -> Option<Area> {
    (part.pixels() > PIXELS_OF_EDGES).then_some(())?;
    let by = (PIXELS_OF_EDGES as f64 / part.pixels() as f64).sqrt();
    let [width, height] =
        [part.width, part.height].map(|length| ((f64::from(length) * by) as u32).max(1));
    // A JPEG is coded in blocks of so many pixels, at most.
    let aligned = |left: u32| left / 2 / 16 * 16;
    Some(Area {
        x: part.x + aligned(part.width - width),
        y: part.y + aligned(part.height - height),
        width,
        height,
    })
}
