//! A picture that is compared with a scene: what it shows on grids, and how well candidates explain it.

use std::{
    cell::{Cell, OnceCell, RefCell},
    collections::HashMap,
    sync::{Arc, atomic::AtomicBool},
};

use super::{
    Reference,
    candidate::{Candidate, Cause, Named},
    class_cache::ClassCache,
    fit::{Fitted, Trial, fit},
    grid::Grid,
    jpeg::Jpeg,
    light::Curve,
    made::Made,
    mistakes::{ROWS, Shows},
    parameters::Parameter,
    score::{Model, Score, Strays, gain, score},
};
use crate::{
    area::Area,
    film::Film,
    scene::{Object, Scene, Shape},
};

/// The longest sides of the grids, in cells, and the samples in a cell of the tiny one, on which starts are looked for.
pub const TINY: (u32, usize) = (32, 5);
const COARSE: u32 = 48;
const MIDDLE: u32 = 128;

/// Of so many pixels in the middle of a picture, those tell of edges.
const PIXELS_OF_EDGES: u64 = 20_000;

/// A search looks for no more after so much work: cells that were computed, times the boards and so many more; every other object takes as long as so many cells,
/// if there are as many. Measured: a unit takes 0.05 to 0.1 μs, with 4 objects, 50 boards and 200 boxes.
const MOST_WORK: f64 = 1e7;
const BESIDE_BOARDS: f64 = 4.0;
const CELLS_OF_AN_OBJECT: f64 = 800.0;

/// A grid over a part of a picture.
pub struct Level<'a> {
    pub grid: Grid,
    film: &'a Film,
    /// The part's corner in the film.
    corner: [u32; 2],
    /// What it shows in the cells, as light that was encoded in each way, where that was asked for.
    seen: [OnceCell<Vec<[f64; 3]>>; Curve::ALL.len()],
    /// How many samples a cell has; none if it is computed exactly.
    samples: Option<usize>,
    pub jpeg: Option<Jpeg>,
    coded: OnceCell<Vec<[f64; 3]>>,
}

impl Level<'_> {
    /// What the picture shows in the cells, as light that was encoded in a way.
    pub fn seen(&self, curve: Curve) -> &[[f64; 3]] {
        self.seen[curve as usize].get_or_init(|| {
            let [left, top] = self.corner;
            let pixel = |x, y| self.film.pixel(left + x, top + y);
            if curve == Curve::Right {
                return self.grid.reduce(pixel);
            }
            // Most pixels have one of a few bytes.
            let known: RefCell<HashMap<u64, f64>> = RefCell::default();
            let light = |seen: f64| {
                let mut known = known.borrow_mut();
                *known
                    .entry(seen.to_bits())
                    .or_insert_with(|| curve.light(seen))
            };
            self.grid.reduce(|x, y| pixel(x, y).map(light))
        })
    }

    /// What a candidate shows on it.
    pub fn model(&self, made: &Made) -> Model {
        let mut model = made.model(&self.grid, self.seen(made.candidate.curve));
        if let Some(jpeg) = self.jpeg {
            let (width, factor) = (self.grid.width(), self.grid.factor as usize);
            let own = || jpeg.variances(&model.moments, width, factor);
            // On cells of several pixels it is about the same for all candidates.
            let variances = match factor {
                1 => &own(),
                _ => self.coded.get_or_init(own),
            };
            model.doubt.resize(variances.len(), [0.0; 3]);
            for (doubt, more) in model.doubt.iter_mut().zip(variances) {
                *doubt = [0, 1, 2].map(|i| doubt[i] + more[i]);
            }
        }
        model
    }
}

/// A picture that is compared with a scene.
pub struct Search<'a> {
    pub scene: &'a Scene,
    shared: &'a ClassCache,
    pub tiny: Level<'a>,
    pub coarse: Level<'a>,
    pub middle: Level<'a>,
    pub fine: Level<'a>,
    /// The pixels in the middle of the picture.
    pub edges: Level<'a>,
    /// What was made last of all pixels.
    last: Cell<Option<Arc<Made>>>,
    /// How many boards the scene has, and other objects.
    boards: f64,
    others: f64,
    work: Cell<f64>,
    /// Whether something was left out for that.
    pub is_cut: Cell<bool>,
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
        let Reference {
            scene,
            part,
            shared,
        } = reference;
        let part = *part;
        let level = |area: Area, longest, samples| Level {
            grid: Grid::new(&scene.image, area, longest),
            film,
            corner: [area.x - part.x, area.y - part.y],
            seen: std::array::from_fn(|_| OnceCell::new()),
            samples,
            jpeg,
            coded: OnceCell::new(),
        };
        let (boards, others): (Vec<&Object>, Vec<&Object>) = scene
            .objects
            .iter()
            .partition(|object| matches!(object.shape, Shape::Checkerboard(_)));
        Self {
            scene,
            shared,
            tiny: level(part, TINY.0, Some(TINY.1)),
            coarse: level(part, COARSE, None),
            middle: level(part, MIDDLE, None),
            fine: level(part, u32::MAX, None),
            edges: level(middle(part), u32::MAX, None),
            last: Cell::new(None),
            boards: boards.len() as f64,
            others: others.len() as f64,
            work: Cell::new(0.0),
            is_cut: Cell::new(false),
            cancel,
        }
    }

    /// What a candidate makes on a level; none if it is cancelled.
    pub fn made(
        &self,
        candidate: &Candidate,
        level: &Level,
        like: Option<&Made>,
    ) -> Option<Arc<Made>> {
        let make = |candidate: &Candidate, likes: &[&Made]| {
            let made = candidate.made(&level.grid, level.samples, likes, self.cancel)?;
            let cells = made.work;
            let work =
                cells * (BESIDE_BOARDS + self.boards) + cells.min(CELLS_OF_AN_OBJECT) * self.others;
            self.work.set(self.work.get() + work);
            Some(made)
        };
        // What a program shows that has the scene's own numbers is the same for all pictures; most often it differs in a part from what this one shows.
        let rows = candidate.named.iter().filter(|named| named.is_row());
        let rows: Vec<Named> = rows.cloned().collect();
        let is_small = level.grid.count() as u64 <= PIXELS_OF_EDGES;
        let may_share = level.samples.is_none() && rows.len() <= usize::from(is_small);
        let base = may_share
            .then(|| Candidate::of(self.scene, &rows))
            .flatten();
        let base = base.filter(|base| {
            let (one, other) = (&base.scene, &candidate.scene);
            one.camera == other.camera && one.image == other.image
        });
        let likes: Vec<&Made> = like.into_iter().collect();
        let base = base.and_then(|base| {
            let mistake = rows.first().map_or("", |row| &row.message);
            self.shared
                .get(&level.grid, mistake, || make(&base, &likes))
        });
        if let Some(base) = &base
            && candidate.looks.len() == base.candidate.looks.len()
            && candidate.is_drawn == base.candidate.is_drawn
            && candidate.scene.objects == base.candidate.scene.objects
        {
            return Some(Arc::clone(base));
        }
        let likes: Vec<&Made> = like.into_iter().chain(base.as_deref()).collect();
        Some(Arc::new(make(candidate, &likes)?))
    }

    /// What a candidate shows on the tiny grid, for others to be compared with it.
    pub fn made_to_compare(&self, candidate: &Candidate) -> Option<Arc<Made>> {
        let grid = &self.tiny.grid;
        let make = || candidate.made_to_compare(grid, TINY.1, self.cancel);
        match candidate.named.is_empty() {
            true => self.shared.get(grid, "", make),
            false => make().map(Arc::new),
        }
    }

    /// What a candidate makes on a level, if there was not too much work before.
    pub fn tried(
        &self,
        candidate: &Candidate,
        level: &Level,
        like: Option<&Made>,
    ) -> Option<Arc<Made>> {
        self.may_go_on()
            .then(|| self.made(candidate, level, like))?
    }

    /// Whether there was not too much work yet; if there was, something is left out.
    pub fn may_go_on(&self) -> bool {
        let may = self.work.get() < MOST_WORK;
        self.is_cut.set(self.is_cut.get() || !may);
        may
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
        let rows = rows.take_while(|_| self.may_go_on());
        let mut all = std::iter::once(candidate.clone())
            .chain(rows.filter_map(|row| candidate.with(row.named())));
        all.any(|candidate| self.strays(&candidate).is_empty())
    }

    /// What shows something else than a candidate for certain.
    pub fn strays(&self, candidate: &Candidate) -> Strays {
        let model = self.pixels(candidate);
        let seen = self.fine.seen(candidate.curve);
        model.map_or_else(Strays::default, |model| {
            Strays::new(seen, &model, self.fine.grid.width())
        })
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

    /// What a candidate shows in the pixels; none if it is cancelled.
    fn pixels(&self, candidate: &Candidate) -> Option<Model> {
        let like = self.last.take();
        let made = self.made(candidate, &self.fine, like.as_deref())?;
        let model = self.fine.model(&made);
        self.last.set(Some(made));
        Some(model)
    }

    /// What differs if a parameter has other numbers than in what was made.
    pub fn changed<'l>(
        &self,
        like: &Made,
        parameter: &Parameter,
        numbers: &[f64],
        level: &'l Level,
    ) -> Option<Shown<'l>> {
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
