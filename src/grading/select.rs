//! Forward selection: the mistake that explains most, then the table once more on what is left, at most four times; then what is not needed any more
//! goes.
//!
//! A tiny grid and a coarse one tell which mistakes are worth a look, a finer one fits their numbers and judges them. What shows only where
//! colours meet is judged on the pixels.

use std::{
    cell::{Cell, OnceCell, RefCell},
    collections::HashMap,
    sync::atomic::AtomicBool,
};

use glam::DVec2;

use super::{
    candidate::{Candidate, Cause, Curve, Look, Made, Named, is_near},
    fit::{Fitted, Trial, absolute, fit},
    grid::Grid,
    mistakes::{OBJECT_ROWS, ROWS, Row, Shows},
    parameters::{self, Owner, Parameter},
    score::{Model, Score, Strays, score},
    textbook::Textbook,
    words,
};
use crate::{
    area::Area,
    cancel::Cancelled,
    color::{Color, linear_to_srgb},
    film::Film,
    scene::Scene,
};

/// So many mistakes are named at most.
const MOST_MISTAKES: usize = 4;

/// So many are fitted and judged at a time, of those that leave least on the coarse grid.
const FINALISTS: usize = 3;

/// From so many starts numbers are fitted on the tiny grid.
const STARTS: usize = 3;

/// Of so many parameters of objects, and of so many others, numbers are fitted on the coarse grid.
const FITTED: usize = 4;

/// So many objects are looked at, those around which most is wrong.
const SUSPECTS: usize = 12;

/// The part of what the best one explains that another may leave to be as good.
const AS_GOOD: f64 = 1e-3;

/// Fewer pixels than this are not taken for something too many.
const SMALLEST: usize = 4;

/// A sample in the middle of a pixel makes as little noise as two random ones; more than this come of several.
const ONE: f64 = 3.0;

/// A move of less than this, in pixels, is not named.
pub const HALF_PIXEL: f64 = 0.5;

/// The longest sides of the grids, in cells, and the samples in a cell of the tiny one, on which starts are looked for.
const TINY: (u32, usize) = (32, 5);
const COARSE: u32 = 48;
const MIDDLE: u32 = 128;

/// Of so many pixels in the middle of a picture, those tell of edges.
const PIXELS_OF_EDGES: u64 = 20_000;

/// A search looks for no more after so much work: cells that were computed, times the objects and so many more. Measured: a unit takes 0.05 to 0.1 μs in scenes with a
/// checkerboard.
const MOST_WORK: f64 = 3e7;
const OBJECTS: usize = 4;

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

    fn model(&self, made: &Made) -> Model {
        made.model(&self.grid, self.seen(made.candidate.curve))
    }
}

/// A picture that is compared with a scene.
pub struct Search<'a> {
    pub scene: &'a Scene,
    tiny: Level<'a>,
    coarse: Level<'a>,
    middle: Level<'a>,
    fine: Level<'a>,
    /// The pixels in the middle of the picture.
    edges: Level<'a>,
    /// What was made last of all pixels.
    last: Cell<Option<Made>>,
    work: Cell<f64>,
    /// Whether something was left out for that.
    pub is_cut: Cell<bool>,
    cancel: &'a AtomicBool,
}

/// What was found.
pub struct Found {
    pub candidate: Candidate,
    pub score: Score,
    pub cost: f64,
    /// What it makes on the grid that it was judged on.
    made: Made,
}

impl<'a> Search<'a> {
    /// For a picture of a part of a scene's.
    pub fn new(scene: &'a Scene, film: &'a Film, part: Area, cancel: &'a AtomicBool) -> Self {
        let level = |area: Area, longest, samples| Level {
            grid: Grid::new(&scene.image, area, longest),
            film,
            corner: [area.x - part.x, area.y - part.y],
            seen: std::array::from_fn(|_| OnceCell::new()),
            samples,
        };
        Self {
            scene,
            tiny: level(part, TINY.0, Some(TINY.1)),
            coarse: level(part, COARSE, None),
            middle: level(part, MIDDLE, None),
            fine: level(part, u32::MAX, None),
            edges: level(middle(part), u32::MAX, None),
            last: Cell::new(None),
            work: Cell::new(0.0),
            is_cut: Cell::new(false),
            cancel,
        }
    }

    /// What a candidate makes on a level; none if it is cancelled.
    fn made(&self, candidate: &Candidate, level: &Level, like: Option<&Made>) -> Option<Made> {
        let made = candidate.made(&level.grid, level.samples, like, self.cancel)?;
        self.work
            .set(self.work.get() + made.work * (OBJECTS + self.scene.objects.len()) as f64);
        Some(made)
    }

    /// What a candidate makes on a level, if there was not too much work before.
    fn tried(&self, candidate: &Candidate, level: &Level, like: Option<&Made>) -> Option<Made> {
        let may = self.work.get() < MOST_WORK;
        self.is_cut.set(self.is_cut.get() || !may);
        let made = may.then(|| self.made(candidate, level, like))??;
        let objects = (OBJECTS + self.scene.objects.len()) as f64;
        self.work.set(self.work.get() + made.work * objects);
        Some(made)
    }

    fn differences(&self, made: &Made, level: &Level) -> Vec<f64> {
        level
            .model(made)
            .differences(level.seen(made.candidate.curve))
    }

    /// Judges a candidate.
    pub fn judged(&self, candidate: Candidate) -> Option<Found> {
        self.judged_on(&self.middle, candidate, None)
    }

    fn judged_on(&self, level: &Level, candidate: Candidate, like: Option<&Made>) -> Option<Found> {
        let made = self.made(&candidate, level, like)?;
        let score = score(level.seen(candidate.curve), &level.model(&made));
        let cost = score.cost(candidate.fitted(), level.grid.count());
        Some(Found {
            candidate,
            score,
            cost,
            made,
        })
    }

    /// The mistakes that explain a picture, from what a program without mistakes would have made.
    pub fn run(&self) -> Result<Option<Found>, Cancelled> {
        let right = Candidate::right(self.scene);
        let Some(mut best) = self.judged_on(&self.middle, right, None) else {
            return Ok(None);
        };
        while best.candidate.named.len() < MOST_MISTAKES && !self.is_explained(&best.candidate) {
            let Some(next) = self.step(&best) else { break };
            best = next;
        }
        if best.candidate.named.len() > 1 {
            best = self.without_needless(best);
        }
        let short = self.shortened(best);
        let mut best = self.with_edges(short)?;
        // A shift by half a pixel may be taken for a camera that looks a little elsewhere.
        if let Some(found) = &best
            && found.candidate.named.len() == 1
        {
            let other = self.with_edges(Candidate::right(self.scene))?;
            let other = other.filter(|other| self.strays(&other.candidate).is_negligible());
            best = best
                .into_iter()
                .chain(other)
                .min_by(|one, other| one.cost.total_cmp(&other.cost));
        }
        crate::cancel::unless_set(self.cancel, best)
    }

    /// A candidate, or the same with a row that shows only where colours meet, if that is better on the pixels.
    pub fn with_edges(&self, candidate: Candidate) -> Result<Option<Found>, Cancelled> {
        let Some(null) = self.judged_on(&self.edges, candidate, None) else {
            return Ok(None);
        };
        // What is done to light makes other noise at edges, of which too little is known to tell these. One sample is its own mean, wherever in a pixel it lies.
        let may = null.candidate.looks.is_empty() && null.candidate.curve == Curve::Right;
        let is_one = null.score.samples < ONE;
        let shows = |row: &&Row| match row.shows {
            Shows::InAreas => false,
            Shows::AtEdges => may && !is_one,
            Shows::Everywhere => may,
        };
        let rows = ROWS.iter().filter(shows);
        let candidates = rows.filter_map(|row| null.candidate.with(row.named()));
        let judged = candidates
            .filter_map(|candidate| self.judged_on(&self.edges, candidate, Some(&null.made)));
        let judged: Vec<Found> = judged.collect();
        // Where areas are not explained yet, that comes first.
        let is_open = !self.strays(&null.candidate).is_negligible();
        let best = judged
            .into_iter()
            .filter(|found| !is_open || self.strays(&found.candidate).is_negligible())
            .min_by(|one, other| one.cost.total_cmp(&other.cost));
        let is_better = |best: &Found| best.cost < null.cost;
        crate::cancel::unless_set(self.cancel, Some(best.filter(is_better).unwrap_or(null)))
    }

    /// Whether a candidate explains all pixels of one colour, or one does that has a mistake more that shows at edges, too, and is told by them.
    fn is_explained(&self, candidate: &Candidate) -> bool {
        let rows = ROWS.iter().filter(|row| row.shows == Shows::Everywhere);
        let mut all = std::iter::once(candidate.clone())
            .chain(rows.filter_map(|row| candidate.with(row.named())));
        all.any(|candidate| self.strays(&candidate).is_negligible())
    }

    /// The pixels that show something else than a candidate for certain.
    pub fn strays(&self, candidate: &Candidate) -> Strays {
        let like = self.last.take();
        let Some(made) = self.made(candidate, &self.fine, like.as_ref()) else {
            return Strays::default();
        };
        let seen = self.fine.seen(candidate.curve);
        let strays = Strays::new(seen, &self.fine.model(&made), self.fine.grid.width());
        self.last.set(Some(made));
        strays
    }

    /// The best candidate with one more mistake, if it is better.
    fn step(&self, from: &Found) -> Option<Found> {
        let coarse = self.made(&from.candidate, &self.coarse, None)?;
        let mut tried = self.rows(from, &coarse);
        tried.extend(self.numbers(from, &coarse));
        tried.sort_by(|one, other| one.0.total_cmp(&other.0));
        let finalists = tried
            .into_iter()
            .take(FINALISTS)
            .map(|(_, candidate)| candidate);
        let judged = finalists.filter_map(|candidate| {
            let like = self.made(&candidate, &self.middle, Some(&from.made))?;
            let candidate = self.fitted(candidate, &self.middle, like, [3, 3])?;
            let found = self.judged_on(&self.middle, candidate, Some(&from.made))?;
            Some(found)
        });
        let judged: Vec<Found> = judged.collect();
        let least = judged
            .iter()
            .map(|found| found.cost)
            .fold(f64::INFINITY, f64::min);
        // A row says more than a number that makes as good as the same picture.
        let is_row = |found: &Found| {
            !matches!(
                found.candidate.named.last().map(|named| &named.cause),
                Some(Cause::Numbers(..))
            )
        };
        let enough = least + AS_GOOD * (from.cost - least);
        let best = judged.into_iter().min_by(|one, other| {
            let rank = |found: &Found| (!(is_row(found) && found.cost <= enough), found.cost);
            let (one, other) = (rank(one), rank(other));
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
        });
        let is_better = |best: &Found| {
            best.cost < from.cost && words::is_seen(self.scene, &from.candidate, &best.candidate)
        };
        // Something too many would explain anything; it is thought of where nothing else explains more than before.
        best.filter(is_better).or_else(|| {
            let patched = from.candidate.with(self.patch(from)?)?;
            let found = self.judged_on(&self.middle, patched, Some(&from.made))?;
            (found.cost < from.cost).then_some(found)
        })
    }

    /// The rows of the table, and how much each leaves on the coarse grid.
    fn rows(&self, from: &Found, like: &Made) -> Vec<(f64, Candidate)> {
        let rows = ROWS.iter().filter(|row| row.shows == Shows::InAreas);
        let mut named: Vec<Named> = rows.map(Row::named).collect();
        for object in self.suspects(from) {
            let name = Owner::Object(object).name(self.scene);
            named.extend(OBJECT_ROWS.iter().map(|row| Named {
                id: row.id,
                message: format!("{name} {}", row.message),
                help: row.help.to_owned(),
                cause: Cause::ObjectRow(row.change, object),
            }));
        }
        let candidates = named
            .into_iter()
            .filter_map(|named| from.candidate.with(named));
        let judged = candidates.filter_map(|candidate| {
            let made = self.tried(&candidate, &self.coarse, Some(like))?;
            Some((absolute(&self.differences(&made, &self.coarse)), candidate))
        });
        judged.collect()
    }

    /// The numbers of the scene, each with what comes nearest on the coarse grid, those first of which a start on the tiny grid leaves least.
    fn numbers(&self, from: &Found, like: &Made) -> Vec<(f64, Candidate)> {
        let candidate = &from.candidate;
        let suspects = self.suspects(from);
        let is_suspect = |parameter: &Parameter| match parameter.owner {
            Owner::Object(object) => suspects.contains(&object),
            _ => true,
        };
        let all = parameters::all(&candidate.scene).into_iter();
        let all = all.filter(|parameter| is_suspect(parameter) && !is_named(candidate, parameter));
        let Some(tiny) = candidate.made_to_compare(&self.tiny.grid, TINY.1, self.cancel) else {
            return Vec::new();
        };
        let shown = self.middle.model(&from.made);
        let is_read = |parameter: &Parameter| parameter.is_color() && candidate.looks.is_empty();
        let tried = all.map(|parameter| {
            let numbers = parameter.numbers(&candidate.scene);
            let starts = match parameter.is_color() {
                true => vec![self.colors(&numbers, &shown)],
                false => {
                    let steps = steps(candidate, &parameter, &self.coarse);
                    starts(&parameter, &numbers, &steps)
                }
            };
            let tried = starts.into_iter().filter_map(|start| {
                let shown = self.changed(&tiny, &parameter, &start, &self.tiny)?;
                Some((absolute(&shown.differences()), start))
            });
            let mut tried: Vec<_> = tried.collect();
            tried.sort_by(|one, other| one.0.total_cmp(&other.0));
            tried.truncate(STARTS);
            (parameter, tried)
        });
        let on_tiny = tried.filter_map(|(parameter, tried)| {
            let rounds = if is_read(&parameter) { 0 } else { 4 };
            let fitted = tried.into_iter().filter_map(|(_, start)| {
                self.fit_one(&tiny, &parameter, &self.tiny, start, [rounds, 0])
            });
            let best = fitted.min_by(|one, other| one.left.total_cmp(&other.left))?;
            Some((best.left, (parameter, best.numbers)))
        });
        let (local, others): (Vec<_>, Vec<_>) =
            on_tiny.partition(|(_, (parameter, _))| parameter.is_local(&candidate.scene));
        let on_coarse = [local, others]
            .into_iter()
            .flat_map(|fitted| least(fitted.into_iter(), FITTED));
        let on_coarse = on_coarse.filter_map(|(parameter, start)| {
            let rounds = if is_read(&parameter) { [0, 0] } else { [5, 2] };
            let fitted = self.fit_one(like, &parameter, &self.coarse, start, rounds)?;
            let named = words::numbers(self.scene, &parameter, fitted.numbers);
            Some((fitted.left, candidate.with(named)?))
        });
        on_coarse.collect()
    }

    /// The colours that a picture has where these colours alone should be seen: the medians of their channels.
    fn colors(&self, numbers: &[f64], model: &Model) -> Vec<f64> {
        let seen = self.middle.seen(model.curve);
        let color = |own: &[f64]| {
            let light = Color {
                srgb: [own[0], own[1], own[2]],
            }
            .to_linear();
            let cells = seen
                .iter()
                .zip(&model.moments.mean)
                .zip(&model.moments.variance);
            let alone =
                cells.filter(|((_, mean), variance)| **mean == light && **variance == [0.0; 3]);
            let mut seen: Vec<[f64; 3]> = alone.map(|((seen, _), _)| *seen).collect();
            let mut median = |i: usize| {
                seen.sort_by(|one, other| one[i].total_cmp(&other[i]));
                let middle = seen.get(seen.len() / 2)?;
                // A byte, if the picture has bytes.
                Some((255.0 * linear_to_srgb(middle[i]) * 1024.0).round() / 1024.0)
            };
            [0, 1, 2].map(|i| median(i).unwrap_or(own[i]))
        };
        numbers.chunks_exact(3).flat_map(color).collect()
    }

    /// What differs if a parameter has other numbers than in what was made.
    fn changed<'l>(
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
        let model = level.model(&self.tried(candidate, level, Some(like))?);
        Some(Shown { level, model })
    }

    fn fit_one(
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

    /// The objects that may be wrong, those first around which most is.
    fn suspects(&self, from: &Found) -> Vec<usize> {
        let grid = &self.middle.grid;
        let candidate = &from.candidate;
        let textbook = Textbook::new(
            &grid.scene(&candidate.scene, false),
            candidate.behaviour,
            |light| light,
        );
        let labels = textbook.labels(grid.cells);
        let mut wrong = vec![0.0; self.scene.objects.len()];
        for (at, off) in from.score.off.iter().enumerate() {
            // An object that grew is wrong beside where it is seen.
            let reach = [0, 2, grid.width() * 2];
            let near = reach
                .iter()
                .flat_map(|by| [at.checked_sub(*by), Some(at + by)])
                .flatten();
            let mut objects: Vec<_> = near.filter_map(|at| *labels.get(at)?).collect();
            objects.sort_unstable();
            objects.dedup();
            objects
                .into_iter()
                .for_each(|object| wrong[object] += libm::log1p(*off));
        }
        let mut suspects: Vec<_> = (0..wrong.len())
            .filter(|&object| wrong[object] > 0.0 && candidate.is_drawn[object])
            .collect();
        suspects.sort_by(|&one, &other| wrong[other].total_cmp(&wrong[one]));
        suspects.truncate(SUSPECTS);
        suspects
    }

    /// Something of one colour where the picture shows what the scene does not: the largest piece of such pixels that hang together.
    fn patch(&self, from: &Found) -> Option<Named> {
        let (grid, seen) = (&self.fine.grid, self.fine.seen(from.candidate.curve));
        let made = self.made(&from.candidate, &self.fine, None)?;
        let model = self.fine.model(&made);
        let strays = Strays::new(seen, &model, grid.width()).inside;
        let pairs = seen.iter().zip(&model.moments.mean);
        let mut is_left: Vec<bool> = pairs.map(|(seen, mean)| !is_near(*seen, *mean)).collect();
        let mut largest: Vec<usize> = Vec::new();
        for start in strays {
            if !std::mem::replace(&mut is_left[start], false) {
                continue;
            }
            let mut piece = vec![start];
            let mut at = 0;
            while at < piece.len() {
                let (width, height) = (grid.width(), grid.cells.height as usize);
                let (x, y) = (piece[at] % width, piece[at] / width);
                let beside = [
                    (x > 0).then(|| piece[at] - 1),
                    (x + 1 < width).then_some(piece[at] + 1),
                    (y > 0).then(|| piece[at] - width),
                    (y + 1 < height).then_some(piece[at] + width),
                ];
                for next in beside.into_iter().flatten() {
                    if is_left[next] && is_near(seen[next], seen[start]) {
                        is_left[next] = false;
                        piece.push(next);
                    }
                }
                at += 1;
            }
            if piece.len() > largest.len().max(SMALLEST - 1) {
                largest = piece;
            }
        }
        let light = seen[*largest.first()?];
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for place in largest.iter().map(|&at| grid.middle(at)) {
            (least, most) = (least.min(place), most.max(place));
        }
        let reach = f64::from(grid.factor);
        let area = [(least - reach).to_array(), (most + reach).to_array()];
        let at = (least + most) / 2.0;
        let color = Color {
            srgb: light.map(|light| 255.0 * linear_to_srgb(light)),
        };
        Some(Named {
            id: "object_extra",
            message: format!(
                "there is something too many, of the colour {color}, around the pixel ({:.0}, {:.0})",
                at.x, at.y
            ),
            help: "the scene has nothing of the kind there".to_owned(),
            cause: Cause::Patch(Look::Patch { light, area }),
        })
    }

    /// All numbers of a candidate fitted together on a level, on which it was made.
    fn fitted(
        &self,
        candidate: Candidate,
        level: &Level,
        made: Made,
        rounds: [usize; 2],
    ) -> Option<Candidate> {
        let (named, start) = (&candidate.named, joined(&candidate.named));
        if start.is_empty() {
            return Some(candidate);
        }
        let fitted = self.fit_all(&candidate, level, &made, rounds)?;
        Candidate::of(self.scene, &split(named, &fitted.numbers))
    }

    fn fit_all(
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

    /// A candidate whose numbers have as few digits as do.
    fn shortened(&self, found: Found) -> Candidate {
        let named = &found.candidate.named;
        let fitted = match joined(named).is_empty() {
            true => None,
            false => self.fit_all(&found.candidate, &self.middle, &found.made, [0, 1]),
        };
        let Some(fitted) = fitted else {
            return found.candidate;
        };
        for digits in [8.0, 2.0] {
            let rounded = joined(named).into_iter().zip(&fitted.errors);
            let rounded: Vec<f64> = rounded
                .map(|(x, error)| words::rounded(x, digits * error))
                .collect();
            if let Some(candidate) = Candidate::of(self.scene, &split(named, &rounded))
                && let Some(judged) = self.judged_on(&self.middle, candidate, Some(&found.made))
                && judged.cost <= found.cost + rounded.len() as f64
            {
                return judged.candidate;
            }
        }
        found.candidate
    }

    /// Without those mistakes that are not needed beside the others.
    fn without_needless(&self, mut found: Found) -> Found {
        let mut at = 0;
        while found.candidate.named.len() > 1 && at < found.candidate.named.len() {
            let mut named = found.candidate.named.clone();
            named.remove(at);
            let without = Candidate::of(self.scene, &named).and_then(|candidate| {
                let made = self.made(&candidate, &self.middle, Some(&found.made))?;
                let candidate = self.fitted(candidate, &self.middle, made, [3, 3])?;
                self.judged_on(&self.middle, candidate, Some(&found.made))
            });
            match without {
                Some(without) if without.cost <= found.cost => found = without,
                _ => at += 1,
            }
        }
        found
    }
}

/// Those of which least is left, in this order.
fn least<T>(all: impl Iterator<Item = (f64, T)>, most: usize) -> impl Iterator<Item = T> {
    let mut all: Vec<(f64, T)> = all.collect();
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    all.into_iter().take(most).map(|(_, one)| one)
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
struct Shown<'l> {
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
fn steps(candidate: &Candidate, parameter: &Parameter, level: &Level) -> Vec<f64> {
    let steps = parameter.steps(&candidate.scene).into_iter();
    match parameter.is_color() {
        true => steps.collect(),
        false => steps
            .map(|step| step * f64::from(level.grid.factor) / 2.0)
            .collect(),
    }
}

fn is_named(candidate: &Candidate, parameter: &Parameter) -> bool {
    candidate
        .named
        .iter()
        .any(|named| matches!(&named.cause, Cause::Numbers(own, _) if own == parameter))
}

fn joined(named: &[Named]) -> Vec<f64> {
    let numbers = |named: &Named| match &named.cause {
        Cause::Numbers(_, numbers) => numbers.clone(),
        _ => Vec::new(),
    };
    named.iter().flat_map(numbers).collect()
}

fn split(named: &[Named], mut numbers: &[f64]) -> Vec<Named> {
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

/// Where to look for numbers: as they are, a little off, and what a slip makes of them, a sign, two exchanged, a double or a half.
fn starts(parameter: &Parameter, numbers: &[f64], steps: &[f64]) -> Vec<Vec<f64>> {
    let mut starts = vec![numbers.to_vec()];
    // A single number costs little: all within reach are tried.
    let far = match numbers.len() {
        1 => 10,
        _ => 3,
    };
    let mut with = |change: &dyn Fn(&mut Vec<f64>)| {
        let mut other = numbers.to_vec();
        change(&mut other);
        if !starts.contains(&other) {
            starts.push(other);
        }
    };
    if let (["normal"], [x, y, z]) = (&parameter.fields[..], numbers) {
        for turn in 1..12 {
            let angle = std::f64::consts::FRAC_PI_6 * f64::from(turn);
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            with(&|other| *other = vec![cos * x + sin * z, *y, cos * z - sin * x]);
        }
    }
    if let ["roll" | "spin"] = parameter.fields[..] {
        (1..12).for_each(|i| with(&|other| other[0] += 30.0 * f64::from(i)));
    }
    for i in 0..numbers.len() {
        with(&|other| other[i] = -other[i]);
        with(&|other| other[i] = 0.0);
        with(&|other| other[i] *= 2.0);
        with(&|other| other[i] *= 0.5);
        with(&|other| other.swap(i, (i + 1) % numbers.len()));
        for by in 1..=far {
            with(&|other| other[i] += 3.0 * f64::from(by) * steps[i]);
            with(&|other| other[i] -= 3.0 * f64::from(by) * steps[i]);
        }
    }
    starts
}
