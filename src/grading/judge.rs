//! A picture under judgement: its grids, its work, and how well candidates explain it.

use std::{
    cell::RefCell,
    collections::VecDeque,
    iter,
    sync::{Arc, atomic::AtomicBool},
};

use super::{
    Reference,
    candidate::{Candidate, Mistake, Shows},
    grid::Grid,
    jpeg::Jpeg,
    level::Level,
    levenberg_marquardt::{Fitted, absolute, fit},
    likelihood::Score,
    mistakes::ROWS,
    rendering::Rendering,
    strays::Strays,
    textbook::Behaviour,
    work::{self, Work},
};
use crate::{area::Area, film::Film, scene::Scene};

/// The longest sides of the grids, in cells.
const TINY: u32 = 32;
const COARSE: u32 = 48;
const MIDDLE: u32 = 96;

/// The samples in a cell of the tiny grid, on which starts are looked for.
const SAMPLES: usize = 5;

/// So many pictures of all pixels are kept, those that were made last: one candidate's, and one's that it is compared with.
const LAST: usize = 2;

/// Of so many pixels in the middle of a picture, those tell of edges.
const PIXELS_OF_EDGES: u64 = 20_000;

/// A picture that is compared with a scene.
pub struct Judge<'a> {
    pub scene: &'a Scene,
    reference: &'a Reference<'a>,
    tiny: Level<'a>,
    pub coarse: Level<'a>,
    pub middle: Level<'a>,
    pub fine: Level<'a>,
    /// The pixels in the middle of the picture.
    pub edges: Level<'a>,
    /// What was made last of all pixels.
    last: RefCell<VecDeque<Arc<Rendering>>>,
    pub work: Work<'a>,
    pub cancel: &'a AtomicBool,
}

/// A candidate that was judged.
pub struct Judged {
    /// What it makes on the level that it was judged on.
    pub rendering: Arc<Rendering>,
    pub score: Score,
    /// Half a logarithm of the number of pixels for each number that was fitted, less the logarithm of the likelihood.
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
        let Reference { scene, part, .. } = reference;
        let part = *part;
        let level = |area: Area, longest, samples| {
            let grid = Grid::new(&scene.image, area, longest);
            let corner = [area.x - part.x, area.y - part.y];
            Level::new(grid, film, corner, samples, jpeg)
        };
        Self {
            scene,
            reference,
            tiny: level(part, TINY, Some(SAMPLES)),
            coarse: level(part, COARSE, None),
            middle: level(part, MIDDLE, None),
            fine: level(part, u32::MAX, None),
            edges: level(central(part), u32::MAX, None),
            last: RefCell::default(),
            work: Work::new(part.pixels(), reference.work, cancel),
            cancel,
        }
    }

    /// What a candidate makes on a level; none if it is cancelled, or takes too much work.
    pub fn render(
        &self,
        candidate: &Candidate,
        level: &Level,
        like: Option<&Rendering>,
    ) -> Option<Arc<Rendering>> {
        let is_fine = level.grid == self.fine.grid && level.samples.is_none();
        let mut known: Vec<Arc<Rendering>> = Vec::new();
        if is_fine {
            known.extend(self.last.borrow().iter().map(Arc::clone));
            known.push(Arc::clone(&self.reference.right));
        } else if level.samples.is_none() {
            let right = Candidate::right(self.scene);
            let reduced = [candidate, &right].map(|one| self.reduced(one, level));
            known.extend(reduced.into_iter().flatten().map(Arc::new));
        }
        let known = known.iter().map(|one| &**one);
        let likes: Vec<&Rendering> = like.into_iter().chain(known).collect();
        let rendering = candidate.render(&level.grid, level.samples, &likes, &self.work)?;
        let rendering = Arc::new(rendering);
        let mut last = self.last.borrow_mut();
        let is_known = |one: &Arc<Rendering>| {
            one.candidate.traces_as(candidate) && one.candidate.behaviour == candidate.behaviour
        };
        if is_fine && !last.iter().any(is_known) {
            last.push_front(Arc::clone(&rendering));
            last.truncate(LAST);
        }
        Some(rendering)
    }

    /// What a candidate makes on a level, from what was made of the same program of all pixels.
    fn reduced(&self, candidate: &Candidate, level: &Level) -> Option<Rendering> {
        let fine = self.fine.grid.cells;
        let is_same =
            |one: &&Arc<Rendering>| one.part == fine && one.candidate.traces_as(candidate);
        let reduce = |one: &Rendering| Arc::new(level.reduced(&one.right, fine));
        let right = &self.reference.right;
        let moments = match is_same(&right) {
            true => Arc::clone(level.right.get_or_init(|| reduce(right))),
            false => reduce(self.last.borrow().iter().find(is_same)?),
        };
        Some(Rendering::new(candidate.clone(), level.grid.cells, moments))
    }

    /// The tiny level, and what a candidate makes there by samples, for others to be compared with it: where it is known what it makes exactly, all that is
    /// compared is off by what its samples are off.
    pub fn around(&self, candidate: &Candidate) -> Option<(Level<'a>, Arc<Rendering>)> {
        let level = &self.tiny;
        let sampled = self.render(candidate, level, None)?;
        let exact = match candidate.behaviour == Behaviour::RIGHT {
            true => self.reduced(candidate, level),
            false => None,
        };
        let exact = exact.filter(|exact| exact.part == sampled.part);
        let exact = level.predict(exact.as_ref().unwrap_or(&sampled));
        Some((level.with_error(&level.predict(&sampled), &exact), sampled))
    }

    /// The absolute differences that a candidate leaves on a level; none if there was too much work before.
    pub fn left(&self, candidate: &Candidate, level: &Level, like: &Rendering) -> Option<f64> {
        let differences = self.differences(candidate, level, like)?;
        Some(absolute(&differences))
    }

    fn differences(
        &self,
        candidate: &Candidate,
        level: &Level,
        like: &Rendering,
    ) -> Option<Vec<f64>> {
        self.work.may_go_on().then_some(())?;
        let rendering = self.render(candidate, level, Some(like))?;
        Some(level.predict(&rendering).differences())
    }

    /// Judges a candidate on a level.
    pub fn judged(
        &self,
        candidate: &Candidate,
        level: &Level,
        like: Option<&Rendering>,
    ) -> Option<Judged> {
        let rendering = self.render(candidate, level, like)?;
        let score = level.predict(&rendering).score();
        let cost = price(level, candidate.fitted()) - score.likelihood;
        Some(Judged {
            rendering,
            score,
            cost,
        })
    }

    /// How much likelier than a null model another one is that was judged on the same level, less what the numbers cost that it has more.
    pub fn gain(&self, level: &Level, null: &Judged, other: &Judged) -> f64 {
        let [one, two] = [null, other].map(|found| level.predict(&found.rendering));
        let more = other.candidate().fitted() - null.candidate().fitted();
        one.gain(&null.score, &two) - price(level, more)
    }

    /// Whether a candidate explains all pixels of one colour, or one does that has a mistake more that shows at edges, too, and is told by them.
    pub fn is_explained(&self, candidate: &Candidate) -> bool {
        let rows = ROWS.iter().filter(|row| row.shows == Shows::Everywhere);
        let rows = rows.take_while(|_| self.work.may_go_on());
        let mut all = iter::once(candidate.clone())
            .chain(rows.filter_map(|row| candidate.with(Mistake::Row(row, None))));
        all.any(|candidate| self.explains_all(&candidate, None))
    }

    /// What shows something else than a candidate for certain; none if it is not known.
    pub fn strays(
        &self,
        candidate: &Candidate,
        level: &Level,
        like: Option<&Rendering>,
    ) -> Option<Strays> {
        let rendering = self.render(candidate, level, like)?;
        self.work.spend(work::of_exact(0, 0, level.grid.count()));
        Some(level.predict(&rendering).strays())
    }

    /// Whether it is known that nothing shows something else than a candidate for certain, of which may be known what it makes on the middle grid.
    ///
    /// The middle grid is asked first, as it costs less: what is wrong for certain in one of its cells is so in a pixel, if what the cells show is exact.
    pub fn explains_all(&self, candidate: &Candidate, like: Option<&Rendering>) -> bool {
        let has_none = |level: &Level| {
            let strays = self.strays(candidate, level, like);
            strays.is_some_and(|strays| strays.is_empty())
        };
        let is_exact = candidate.behaviour == Behaviour::RIGHT
            && !candidate.layout.is_shifted()
            && self.fine.jpeg.is_none();
        (!is_exact || has_none(&self.middle)) && has_none(&self.fine)
    }

    /// Whether what was found beside another candidate can be seen.
    pub fn is_seen(&self, found: &Judged, beside: &Candidate) -> bool {
        let count = f64::from(self.middle.grid.factor * self.middle.grid.factor);
        let samples = found.score.samples.unwrap_or(f64::INFINITY) / count;
        let predict = |candidate| {
            let rendering = self.render(candidate, &self.fine, None)?;
            self.work
                .spend(work::of_exact(0, 0, self.fine.grid.count()));
            Some(self.fine.predict(&rendering))
        };
        let (Some(one), Some(other)) = (predict(found.candidate()), predict(beside)) else {
            return false;
        };
        one.is_seen_beside(&other, samples.max(1.0))
    }

    /// The last numbers of a candidate, so many, fitted on a level, where something like it was made; each is varied so as to change the picture by about so much
    /// of a cell.
    pub fn fit(
        &self,
        candidate: &Candidate,
        free: usize,
        (level, like): (&Level, &Rendering),
        cells: f64,
        rounds: [usize; 2],
    ) -> Option<(Candidate, Fitted)> {
        let start = candidate.numbers();
        let (fixed, start) = start.split_at(start.len() - free);
        let steps = candidate.steps(cells * f64::from(level.grid.factor));
        let with = |free: &[f64]| candidate.with_numbers(self.scene, &[fixed, free].concat());
        let deviations = || level.predict(like).deviations();
        let trial = |numbers: &[f64]| self.differences(&with(numbers)?, level, like);
        let steps = &steps[fixed.len()..];
        let fitted = fit(start.to_vec(), steps, rounds, &deviations, &trial)?;
        Some((with(&fitted.numbers)?, fitted))
    }
}

/// What so many numbers cost that are fitted to a level. A part of a picture is judged as the whole is: of a few pixels anything can be fitted.
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
    Area {
        x: part.x + (part.width - width) / 2,
        y: part.y + (part.height - height) / 2,
        width,
        height,
    }
}
