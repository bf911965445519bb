//! A picture under judgement: its grids, its work, and how well candidates explain it.

use std::{
    cell::RefCell,
    collections::VecDeque,
    sync::{Arc, atomic::AtomicBool},
};

use super::{
    Reference,
    candidate::{Candidate, Cause, Named},
    fit::{Fitted, Trial, fit},
    grid::Grid,
    jpeg::Jpeg,
    level::Level,
    light::Curve,
    made::Made,
    mistakes::{ROWS, Shows},
    parameters::Parameter,
    score::{Model, Score, Strays, gain, score},
    textbook::Behaviour,
    work::{self, Work},
};
use crate::{area::Area, film::Film, scene::Scene};

/// The longest sides of the grids, in cells, and the samples in a cell of the tiny one, on which starts are looked for.
pub const TINY: (u32, usize) = (32, 5);
const COARSE: u32 = 48;
const MIDDLE: u32 = 96;

/// So many pictures of all pixels are kept, those that were made last: one candidate's, and one's that it is compared with.
const LAST: usize = 2;

/// Of so many pixels in the middle of a picture, those tell of edges.
const PIXELS_OF_EDGES: u64 = 20_000;

/// A picture that is compared with a scene.
pub struct Search<'a> {
    pub scene: &'a Scene,
    reference: &'a Reference<'a>,
    pub tiny: Level<'a>,
    pub coarse: Level<'a>,
    pub middle: Level<'a>,
    pub fine: Level<'a>,
    /// The pixels in the middle of the picture.
    pub edges: Level<'a>,
    /// What was made last of all pixels.
    last: RefCell<VecDeque<Arc<Made>>>,
    pub work: Work<'a>,
    pub cancel: &'a AtomicBool,
}

/// What was found.
pub struct Found {
    pub candidate: Candidate,
    pub score: Score,
    pub cost: f64,
    /// What it makes on the grid that it was judged on.
    pub made: Arc<Made>,
}

impl<'a> Search<'a> {
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
        let work = Work::new(work::most(part.pixels()), cancel);
        work.spend(reference.work);
        Self {
            scene,
            reference,
            tiny: level(part, TINY.0, Some(TINY.1)),
            coarse: level(part, COARSE, None),
            middle: level(part, MIDDLE, None),
            fine: level(part, u32::MAX, None),
            edges: level(middle(part), u32::MAX, None),
            last: RefCell::default(),
            work,
            cancel,
        }
    }

    /// What a candidate makes on a level; none if it is cancelled, or takes too much work.
    pub fn made(
        &self,
        candidate: &Candidate,
        level: &Level,
        like: Option<&Made>,
    ) -> Option<Arc<Made>> {
        let is_fine = level.grid == self.fine.grid && level.samples.is_none();
        let mut known: Vec<Arc<Made>> = Vec::new();
        if is_fine {
            known.extend(self.last.borrow().iter().map(Arc::clone));
            known.push(Arc::clone(&self.reference.right));
        } else if level.samples.is_none() {
            let right = Candidate::right(self.scene);
            known.extend(match self.reduced(candidate, level) {
                Some(same) => vec![same],
                None => self.reduced(&right, level).into_iter().collect(),
            });
        }
        let likes: Vec<&Made> = like
            .into_iter()
            .chain(known.iter().map(|one| &**one))
            .collect();
        let made = candidate.made(&level.grid, level.samples, &likes, &self.work)?;
        let made = Arc::new(made);
        let mut last = self.last.borrow_mut();
        let is_known = |one: &Arc<Made>| {
            one.candidate.traces_as(candidate) && one.candidate.behaviour == candidate.behaviour
        };
        if is_fine && !last.iter().any(is_known) {
            last.push_front(Arc::clone(&made));
            last.truncate(LAST);
        }
        Some(made)
    }

    /// What a candidate makes on a level, from what was made of the same program of all pixels.
    fn reduced(&self, candidate: &Candidate, level: &Level) -> Option<Arc<Made>> {
        let fine = self.fine.grid.cells;
        let is_same = |made: &&Arc<Made>| made.part == fine && made.candidate.traces_as(candidate);
        let reduce = |made: &Made| {
            let moments = level.reduced(made.moments(), fine);
            Arc::new(Made::new(made.candidate.clone(), level.grid.cells, moments))
        };
        let right = &self.reference.right;
        if is_same(&right) {
            return Some(Arc::clone(level.right.get_or_init(|| reduce(right))));
        }
        let last = self.last.borrow();
        last.iter().find(is_same).map(|made| reduce(made))
    }

    /// What a candidate shows on the tiny grid, for others to be compared with it.
    pub fn made_to_compare(&self, candidate: &Candidate) -> Option<Arc<Made>> {
        let level = &self.tiny;
        let exact = match candidate.behaviour == Behaviour::RIGHT {
            true => self.reduced(candidate, level),
            false => None,
        };
        let made = candidate.made_to_compare(exact.as_deref(), &level.grid, TINY.1, &self.work)?;
        Some(Arc::new(made))
    }

    /// What a candidate makes on a level, if there was not too much work before.
    pub fn tried(
        &self,
        candidate: &Candidate,
        level: &Level,
        like: Option<&Made>,
    ) -> Option<Arc<Made>> {
        self.work
            .may_go_on()
            .then(|| self.made(candidate, level, like))?
    }

    /// By how much the picture differs from what was made.
    pub fn differences(&self, made: &Made, level: &Level) -> Vec<f64> {
        level
            .model(made)
            .differences(level.seen(made.candidate.curve))
    }

    /// Judges a candidate.
    pub fn judged(&self, candidate: Candidate) -> Option<Found> {
        self.judged_on(&self.middle, candidate, None)
    }

    /// Judges a candidate on a level.
    pub fn judged_on(
        &self,
        level: &Level,
        candidate: Candidate,
        like: Option<&Made>,
    ) -> Option<Found> {
        let made = self.made(&candidate, level, like)?;
        let score = score(level.seen(candidate.curve), &level.model(&made));
        // A part is judged as the whole is: of a few pixels anything can be fitted.
        let [width, height] = level.grid.size().map(f64::from);
        let cost = score.cost(candidate.fitted(), width * height);
        Some(Found {
            candidate,
            score,
            cost,
            made,
        })
    }

    /// How much likelier than a null model another one is that was judged on the same level, less what the numbers cost that it has more.
    pub fn gain(&self, level: &Level, null: &Found, other: &Found) -> f64 {
        let models = [null, other].map(|found| level.model(&found.made));
        let gain = gain(level.seen(Curve::Right), models.each_ref(), &null.score);
        let [width, height] = level.grid.size().map(f64::from);
        let more = other.candidate.fitted() - null.candidate.fitted();
        gain - 0.5 * more as f64 * libm::log(width * height)
    }

    /// Whether a candidate explains all pixels of one colour, or one does that has a mistake more that shows at edges, too, and is told by them.
    pub fn is_explained(&self, candidate: &Candidate) -> bool {
        let rows = ROWS.iter().filter(|row| row.shows == Shows::Everywhere);
        let rows = rows.take_while(|_| self.work.may_go_on());
        let mut all = std::iter::once(candidate.clone())
            .chain(rows.filter_map(|row| candidate.with(row.named())));
        all.any(|candidate| self.has_no_strays(&candidate))
    }

    /// What shows something else than a candidate for certain; none if it is not known.
    pub fn strays(&self, candidate: &Candidate) -> Option<Strays> {
        self.strays_on(&self.fine, candidate, None)
    }

    fn strays_on(
        &self,
        level: &Level,
        candidate: &Candidate,
        like: Option<&Made>,
    ) -> Option<Strays> {
        let made = self.made(candidate, level, like)?;
        self.work.compared(level.grid.count());
        let seen = level.seen(candidate.curve);
        Some(Strays::new(seen, &level.model(&made), level.grid.width()))
    }

    /// Whether it is known that nothing shows something else than a candidate for certain.
    pub fn has_no_strays(&self, candidate: &Candidate) -> bool {
        self.has_none(candidate, None)
    }

    /// The same of something that was judged.
    pub fn explains_all(&self, found: &Found) -> bool {
        self.has_none(&found.candidate, Some(&found.made))
    }

    /// The middle grid is asked first, as it costs less: what is wrong for certain in one of its cells is so in a pixel, if what the cells show is exact.
    fn has_none(&self, candidate: &Candidate, like: Option<&Made>) -> bool {
        let is_none = |level: &Level| {
            let strays = self.strays_on(level, candidate, like);
            strays.is_some_and(|strays| strays.is_empty())
        };
        let is_exact = candidate.behaviour == Behaviour::RIGHT && self.fine.jpeg.is_none();
        (!is_exact || is_none(&self.middle)) && is_none(&self.fine)
    }

    /// Whether what was found beside another candidate can be seen.
    pub fn is_seen(&self, found: &Found, beside: &Candidate) -> bool {
        let count = f64::from(self.middle.grid.factor * self.middle.grid.factor);
        let samples = found
            .score
            .samples
            .map_or(f64::INFINITY, |samples| samples / count);
        let models = [&found.candidate, beside].map(|candidate| self.pixels(candidate));
        let [Some(one), Some(other)] = models else {
            return false;
        };
        one.is_seen_beside(&other, self.fine.grid.width(), samples.max(1.0))
    }

    /// What a candidate shows in the pixels; none if it is cancelled, or takes too much work.
    fn pixels(&self, candidate: &Candidate) -> Option<Model> {
        let made = self.made(candidate, &self.fine, None)?;
        self.work.compared(self.fine.grid.count());
        Some(self.fine.model(&made))
    }

    /// What differs if a parameter has other numbers than in what was made.
    pub fn changed<'l>(
        &self,
        like: &Made,
        parameter: &Parameter,
        numbers: &[f64],
        level: &'l Level,
    ) -> Option<Shown<'l>> {
        // Another scene of many objects is much work by itself.
        self.work.may_go_on().then_some(())?;
        let changed = Candidate {
            scene: parameter.put(&like.candidate.scene, numbers)?,
            ..like.candidate.clone()
        };
        self.trial(&changed, level, like)
    }

    fn trial<'l>(
        &self,
        candidate: &Candidate,
        level: &'l Level<'l>,
        like: &Made,
    ) -> Option<Shown<'l>> {
        let made = self.tried(candidate, level, Some(like))?;
        let model = level.model(&made);
        Some(Shown { level, model })
    }

    /// The numbers of a parameter fitted on a level, on which something else was made.
    pub fn fit_one(
        &self,
        like: &Made,
        parameter: &Parameter,
        level: &Level,
        start: Vec<f64>,
        rounds: [usize; 2],
    ) -> Option<Fitted> {
        let steps = steps(&like.candidate, parameter, level);
        let trial = |numbers: &[f64]| self.changed(like, parameter, numbers, level);
        fit(start, &steps, rounds, &trial)
    }

    /// All numbers of a candidate fitted together on a level, on which it was made.
    pub fn fitted(
        &self,
        candidate: Candidate,
        level: &Level,
        made: &Made,
        rounds: [usize; 2],
    ) -> Option<Candidate> {
        let (named, start) = (&candidate.named, joined(&candidate.named));
        if start.is_empty() {
            return Some(candidate);
        }
        let fitted = self.fit_all(&candidate, level, made, rounds)?;
        Candidate::of(self.scene, &split(named, &fitted.numbers))
    }

    /// The same, with how far each may be off.
    pub fn fit_all(
        &self,
        candidate: &Candidate,
        level: &Level,
        made: &Made,
        rounds: [usize; 2],
    ) -> Option<Fitted> {
        let named = &candidate.named;
        let of = |named: &Named| match &named.cause {
            Cause::Numbers(parameter, _) => steps(candidate, parameter, level),
            _ => Vec::new(),
        };
        let steps: Vec<f64> = named.iter().flat_map(of).map(|step| step / 2.0).collect();
        let trial = |numbers: &[f64]| {
            let candidate = Candidate::of(self.scene, &split(named, numbers))?;
            self.trial(&candidate, level, made)
        };
        fit(joined(named), &steps, rounds, &trial)
    }
}

/// The middle of a part of a picture, of its proportions and of so many pixels at most.
fn middle(part: Area) -> Area {
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

/// What a candidate shows on a level.
pub struct Shown<'l> {
    level: &'l Level<'l>,
    model: Model,
}

impl Trial for Shown<'_> {
    fn differences(&self) -> Vec<f64> {
        self.model.differences(self.level.seen(self.model.curve))
    }

    fn deviations(&self) -> Vec<f64> {
        self.model.deviations(self.level.grid.width())
    }
}

/// By how much each number of a parameter is varied on a level.
pub fn steps(candidate: &Candidate, parameter: &Parameter, level: &Level) -> Vec<f64> {
    let steps = parameter.steps(&candidate.scene).into_iter();
    match parameter.is_color() {
        true => steps.collect(),
        false => steps
            .map(|step| step * f64::from(level.grid.factor) / 2.0)
            .collect(),
    }
}

/// All numbers of mistakes, one after the other.
pub fn joined(named: &[Named]) -> Vec<f64> {
    let numbers = |named: &Named| match &named.cause {
        Cause::Numbers(_, numbers) => numbers.clone(),
        _ => Vec::new(),
    };
    named.iter().flat_map(numbers).collect()
}

/// Mistakes with other numbers.
pub fn split(named: &[Named], mut numbers: &[f64]) -> Vec<Named> {
    let mut named = named.to_vec();
    for one in &mut named {
        if let Cause::Numbers(_, own) = &mut one.cause {
            let (first, rest) = numbers.split_at(own.len());
            own.copy_from_slice(first);
            numbers = rest;
        }
    }
    named
}
