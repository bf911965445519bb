//! A picture that is judged, at several resolutions, with a budget of work. Contains the operations
//! by which the search compares hypotheses with it.

use std::{
    cell::{OnceCell, RefCell},
    collections::VecDeque,
    sync::Arc,
};

use super::levenberg_marquardt::{Fitted, absolute, fit};
use crate::{
    area::Area,
    film::{Film, Jpeg},
    grading::{
        hypotheses::{Candidate, Effect, Layout, Mistake},
        scoring::{Displacement, Grid, Level, Prediction, Rendering, Score, Work, work},
    },
    scene::Scene,
    tracer::World,
};

/// Number of cells along the longer side of the coarsest grid, on which promising mistakes are
/// selected among hundreds. A finer grid takes longer for each mistake. A coarser one hides small
/// objects.
const TINY: u32 = 32;
/// Number of cells along the longer side of the grid on which numbers are fitted first. A finer
/// grid takes longer. A coarser one determines the numbers less well.
const COARSE: u32 = 48;
/// Number of cells along the longer side of the grid on which sets of mistakes are judged. A finer
/// grid takes longer. A coarser one distinguishes similar mistakes less well. The final decision
/// does not depend on this grid, because it is made on single pixels.
const MIDDLE: u32 = 96;

/// Distance, in cells, by which the picture should move when a number is varied to find the
/// picture's derivative with respect to the number. The effect of a smaller movement is harder to
/// measure. A larger movement makes the derivative less exact.
pub const CELL_STEP: f64 = 0.25;

/// Number of samples per cell of the coarsest grid, on which promising mistakes are selected. It is
/// a Fibonacci number, because the samples form a Fibonacci lattice. With more samples, pictures
/// are less noisy, but take longer.
const SAMPLES: usize = 5;

/// Number of pixels in the central crop of a picture, on which edges are judged. With more pixels,
/// edges are determined better, but the work grows in proportion.
const CENTRAL_PIXELS: u64 = 20_000;

/// A picture at several resolutions, with which hypotheses about the program that made it are
/// compared.
pub struct Judge<'a> {
    pub scene: &'a Scene,
    tiny: Level<'a>,
    pub coarse: Level<'a>,
    pub middle: Level<'a>,
    pub fine: Level<'a>,
    /// The central crop at full resolution; `None` if the crop would be the whole picture.
    pub central: Option<Level<'a>>,
    pub work: Work<'a>,
    /// Residuals of the last few hypotheses. A hypothesis is identified by its mistakes.
    pub residuals: RefCell<VecDeque<(Vec<Mistake>, Residual)>>,
    /// Squared difference between the picture and that of a correct program, on the grid `middle`.
    /// Differences that sampling can explain are ignored. The squared differences of hypotheses are
    /// divided by this value. Computed on demand.
    pub square_of_correct: OnceCell<f64>,
}

/// The differences between a picture and a hypothesis's prediction that remain in single pixels.
#[derive(Clone, Copy, Debug)]
pub struct Residual {
    /// Whether areas of one colour are right, and errors in all other pixels look like noise. If
    /// the prediction was sampled, a few wrong pixels in the areas are ignored, because samples may
    /// have missed small details.
    pub are_areas_right: bool,
    /// Whether almost all wrong pixels lie near edges.
    pub is_at_edges: bool,
    /// Whether so many pixels that should show one colour are wrong that a mistake may be visible
    /// everywhere.
    pub is_much_wrong: bool,
    /// Whether errors in pixels that mix several colours look like sampling noise.
    pub is_noise_everywhere: bool,
    /// Displacement of edges; `None` if it may be chance, or if the wrong pixels do not lie near
    /// edges.
    pub displacement: Option<Displacement>,
    /// Width of the pixel filter, in pixels; `None` if it may be 1, or if the wrong pixels do not
    /// lie near edges.
    pub width: Option<f64>,
}

impl Residual {
    /// Returns whether sampling noise explains all errors.
    pub fn is_noise(&self) -> bool {
        self.are_areas_right
            && self.displacement.is_none()
            && self.width.is_none()
            && self.is_noise_everywhere
    }
}

/// A hypothesis about the program, with its score at one resolution.
pub struct JudgedCandidate {
    /// Rendering of the hypothesis at this resolution.
    pub rendering: Arc<Rendering>,
    pub score: Score,
    /// Cost of the hypothesis: the penalty for its parameters ([`price`]), minus the logarithm of
    /// the picture's likelihood. The hypothesis with the least cost is the best.
    pub cost: f64,
}

impl JudgedCandidate {
    pub fn candidate(&self) -> &Candidate {
        &self.rendering.candidate
    }
}

impl<'a> Judge<'a> {
    /// Prepares a picture for judging. `exact` is the exact rendering by a correct program, in the
    /// same rectangle of the scene's picture.
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
            Level::new(grid, film, part, samples, jpeg)
        };
        let judge = Self {
            scene,
            tiny: level(part, TINY, Some(SAMPLES)),
            coarse: level(part, COARSE, None),
            middle: level(part, MIDDLE, None),
            fine: level(part, u32::MAX, None),
            central: central(part).map(|part| level(part, u32::MAX, None)),
            work,
            residuals: RefCell::default(),
            square_of_correct: OnceCell::new(),
        };
        let levels = [&judge.coarse, &judge.middle, &judge.fine];
        for level in levels.into_iter().chain(&judge.central) {
            level.compare_with(level.reduced(exact));
        }
        judge
    }

    /// Returns the resolution at which numbers are fitted. Usually, this is the grid `middle`. If
    /// the hypothesis applies a curve to light, single pixels are used, because a curve must be
    /// applied to pixels before they are averaged over a cell.
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

    /// Returns the central crop at full resolution, on which edges are judged.
    pub fn central_crop(&self) -> &Level<'a> {
        self.central.as_ref().unwrap_or(&self.fine)
    }

    /// Renders a hypothesis on the grids `coarse` and `middle`, so that later hypotheses are
    /// rendered only where they differ from it.
    pub fn compare_with(&self, candidate: &Candidate) {
        for level in [&self.coarse, &self.middle] {
            if let Some(rendering) = level.render(candidate, &self.work) {
                level.compare_with(rendering);
            }
        }
    }

    /// Returns the picture at the coarsest resolution, for comparisons with variants of a
    /// hypothesis. All variants are sampled in the same way, so they have almost the same sampling
    /// error. If the program traces rays correctly, this error is computed and added to the
    /// observed light, so that it cancels in comparisons. Returns `None` if the budget of work is
    /// used up.
    pub fn tiny(&self, candidate: &Candidate) -> Option<Level<'a>> {
        let level = &self.tiny;
        let sampled = level.render(candidate, &self.work)?;
        level.compare_with(Arc::clone(&sampled));
        let sampled = level.predict(&sampled);
        if !candidate.behaviour.is_correct() {
            return Some(level.with_error(&sampled, &sampled));
        }
        let exact = candidate.render(&level.grid, None, &[], &self.work)?;
        Some(level.with_error(&sampled, &level.predict(&exact)))
    }

    /// Predicts what the picture shows at one resolution if a hypothesis is correct. Returns `None`
    /// if the budget of work is used up.
    pub fn predicted<'b>(&self, candidate: &Candidate, level: &'b Level) -> Option<Prediction<'b>> {
        let rendering = level.render(candidate, &self.work)?;
        self.work
            .spend(work::COMPARISON * level.grid.count() as f64);
        Some(level.predict(&rendering))
    }

    /// Returns the squared difference that a hypothesis leaves on the grid `middle`. Differences
    /// that sampling can explain are ignored. Returns `None` if the budget of work is used up.
    pub fn square(&self, candidate: &Candidate) -> Option<f64> {
        Some(
            self.predicted(candidate, &self.middle)?
                .unexplained_errors()
                .square(),
        )
    }

    /// Returns the differences between the picture and a hypothesis's prediction, for each channel
    /// of each cell at one resolution. Returns `None` if the budget of work is used up.
    pub fn differences(&self, candidate: &Candidate, level: &Level) -> Option<Vec<f64>> {
        self.work.check()?;
        Some(self.predicted(candidate, level)?.differences())
    }

    /// Computes a hypothesis's difference from the picture at one resolution: the sum of the
    /// absolute differences of all cells. Returns it with the hypothesis. Returns `None` if the
    /// budget of work is used up.
    pub fn with_difference(&self, candidate: Candidate, level: &Level) -> Option<(f64, Candidate)> {
        let differences = self.differences(&candidate, level)?;
        Some((absolute(&differences), candidate))
    }

    /// Returns for each cell of a grid the index of the object that is seen in its middle, or
    /// `None` for the background. The hypothesis's scene is rendered by a correct program, and the
    /// cells are then arranged by `layout`. If the work is cancelled, all cells are `None`.
    pub fn labels(&self, candidate: &Candidate, layout: Layout, grid: &Grid) -> Vec<Option<usize>> {
        let scene = candidate.drawn_correctly().drawn(grid);
        let Ok(world) = World::new_unless(&scene, self.work.cancel) else {
            return vec![None; grid.count()];
        };
        let objects = 0..candidate.is_drawn.len();
        self.work
            .spend(work::of_exact(0, objects.len(), grid.count()));
        let drawn: Vec<usize> = objects.filter(|&i| candidate.is_drawn[i]).collect();
        let label = |cell| {
            let (x, y) = layout.source(cell, grid.size);
            world.object_at(x, y).map(|object| drawn[object])
        };
        grid.cells.iter().map(label).collect()
    }

    /// Computes the score and the cost of a hypothesis at one resolution. Returns `None` if the
    /// budget of work is used up.
    pub fn judged(&self, candidate: &Candidate, level: &Level) -> Option<JudgedCandidate> {
        let rendering = level.render(candidate, &self.work)?;
        let score = level.predict(&rendering).score();
        let cost = price(level, candidate.parameter_count()) - score.likelihood;
        Some(JudgedCandidate {
            rendering,
            score,
            cost,
        })
    }

    /// Fits all numbers of a hypothesis's mistakes. Returns `None` if it has no numbers, or if the
    /// budget of work is used up.
    pub fn fit_all(
        &self,
        candidate: &Candidate,
        level: &Level,
        rounds: [usize; 2],
    ) -> Option<(Candidate, Fitted)> {
        let all = Vec::from_iter(0..candidate.numbers().len());
        (!all.is_empty()).then_some(())?;
        self.fit(candidate, &all, level, CELL_STEP, rounds)
    }

    /// Fits only the numbers of the mistake that was added last. `from` is the hypothesis without
    /// this mistake, and `start` is the hypothesis with it. Returns the remaining difference from
    /// the picture and the fitted hypothesis. Returns `None` if the numbers of `start` are
    /// impossible, or if the budget of work is used up.
    pub fn fit_last(
        &self,
        from: &Candidate,
        start: &Candidate,
        level: &Level,
        cells: f64,
        rounds: [usize; 2],
    ) -> Option<(f64, Candidate)> {
        let free = Vec::from_iter(from.numbers().len()..start.numbers().len());
        let (fitted, found) = self.fit(start, &free, level, cells, rounds)?;
        Some((found.left, fitted))
    }

    /// Fits some numbers of a hypothesis's mistakes. `free` contains their indices among all its
    /// numbers. To find derivatives, each number is varied so that the picture moves by about
    /// `cells` cells. `rounds` contains two maximum numbers of rounds: for least squares, and then
    /// for a robust loss. Returns `None` if the hypothesis's numbers are impossible, or if the
    /// budget of work is used up.
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

/// Returns the penalty for `fitted` parameters, which is part of a hypothesis's cost. It is half
/// the logarithm of the number of cells for each parameter. All cells of the whole picture are
/// counted even if only a crop is judged. With a small crop, the penalty would be so low that
/// almost anything could be fitted to it.
pub fn price(level: &Level, fitted: usize) -> f64 {
    let [width, height] = level.grid.size.map(f64::from);
    0.5 * fitted as f64 * libm::log(width * height)
}

/// Sorts items by their keys, the least first. Returns the first `most` of them.
pub fn least<T>(all: impl Iterator<Item = (f64, T)>, most: usize) -> Vec<(f64, T)> {
    let mut all: Vec<_> = all.collect();
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    all.truncate(most);
    all
}

/// Returns the central crop of the rectangle `part`, with the same aspect ratio. Returns `None` if
/// the rectangle has at most [`CENTRAL_PIXELS`] pixels.
fn central(part: Area) -> Option<Area> {
    if part.pixels() <= CENTRAL_PIXELS {
        return None;
    }
    let by = (CENTRAL_PIXELS as f64 / part.pixels() as f64).sqrt();
    let [width, height] =
        [part.width, part.height].map(|length| ((f64::from(length) * by) as u32).max(1));
    // The crop starts at a multiple of 16 pixels, as the blocks of a JPEG do.
    let aligned = |left: u32| left / 2 / 16 * 16;
    Some(Area {
        x: part.x + aligned(part.width - width),
        y: part.y + aligned(part.height - height),
        width,
        height,
    })
}
