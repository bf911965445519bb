//! Forward selection: the mistake that explains most, then the table once more on what is left, at most four times; then what is not needed any more
//! goes.
//!
//! A coarse grid tells which mistakes are worth a look, a finer one fits their numbers, and the finest one judges them. Work is counted in rays times
//! objects, so that it does not depend on the machine.

use std::{
    cell::Cell,
    sync::atomic::{AtomicBool, Ordering},
};

use glam::DVec2;

use super::{
    candidate::{Candidate, Cause, Look, Named, is_near},
    fit::{Fitted, absolute, fit},
    grid::Grid,
    mistakes::{OBJECT_ROWS, ROWS, Row},
    parameters::{self, Owner, Parameter},
    score::{Score, score},
    textbook::{Moments, Textbook},
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

/// So many are fitted and judged at a time, of those that explain most on the coarse grid.
const FINALISTS: usize = 3;

/// Of so many parameters numbers are fitted on the coarse grid.
const FITTED: usize = 8;

/// A move of less than this, in pixels, is not named.
pub const HALF_PIXEL: f64 = 0.5;

/// The longest sides of the four grids, in cells, and the samples in a cell.
const TINY: (u32, usize) = (32, 5);
const COARSE: (u32, usize) = (64, 8);
const MIDDLE: (u32, usize) = (160, 8);
const FINE: (u32, usize) = (640, 21);

/// Rays times objects: for any picture, and for each of its pixels. Measured: 4 to 8 nanoseconds each.
const WORK: f64 = 1.3e8;
const WORK_OF_A_PIXEL: f64 = 200.0;

/// A grid, and what a picture shows in it.
pub struct Level {
    pub grid: Grid,
    pub seen: Vec<[f64; 3]>,
    pub samples: usize,
}

/// A picture that is compared with a scene.
pub struct Search<'a> {
    pub scene: &'a Scene,
    pub tiny: Level,
    pub coarse: Level,
    pub middle: Level,
    pub fine: Level,
    /// What may still be done, and what of it is kept for later.
    work: Cell<f64>,
    kept: Cell<f64>,
    /// Whether something was left out for that.
    pub is_cut: Cell<bool>,
    cancel: &'a AtomicBool,
}

/// What was found.
pub struct Found {
    pub candidate: Candidate,
    pub score: Score,
    pub cost: f64,
}

impl<'a> Search<'a> {
    /// For a picture of a part of a scene's.
    pub fn new(scene: &'a Scene, film: &Film, part: Area, cancel: &'a AtomicBool) -> Self {
        let level = |(longest, samples)| {
            let grid = Grid::new(part, longest);
            Level {
                grid,
                seen: grid.reduce(film),
                samples,
            }
        };
        Self {
            scene,
            tiny: level(TINY),
            coarse: level(COARSE),
            middle: level(MIDDLE),
            fine: level(FINE),
            work: Cell::new(WORK + WORK_OF_A_PIXEL * part.pixels() as f64),
            kept: Cell::new(0.0),
            is_cut: Cell::new(false),
            cancel,
        }
    }

    /// Whether a picture of the scene may be made on a level.
    fn may(&self, level: &Level) -> bool {
        // A ray is asked for an object in earnest only within its bounds, which takes much longer than to see that it is not.
        let objects = 0.25 * self.scene.objects.len() as f64 + 8.0;
        let samples = 5.0 + level.samples as f64 / 3.0;
        let left = self.work.get() - objects * level.grid.cells() as f64 * samples;
        let may = left >= self.kept.get() && !self.cancel.load(Ordering::Relaxed);
        match may {
            true => self.work.set(left),
            false => self.is_cut.set(true),
        }
        may
    }

    fn differences(&self, candidate: &Candidate, level: &Level) -> Option<Vec<f64>> {
        self.may(level).then(|| {
            let model = candidate.model(&level.grid, &level.seen, level.samples);
            let Moments { mean, variance } = &model.moments;
            let cells = level.seen.iter().zip(mean).zip(variance);
            cells
                .flat_map(|((seen, mean), variance)| {
                    [0, 1, 2].map(|i| model.difference(seen[i], mean[i], *variance))
                })
                .collect()
        })
    }

    /// Judges a candidate on the finest grid, if that may be done.
    pub fn judged(&self, candidate: Candidate) -> Option<Found> {
        self.may(&self.fine).then(|| self.judge(candidate))
    }

    /// Judges a candidate on the finest grid.
    pub fn judge(&self, candidate: Candidate) -> Found {
        self.judge_on(&self.fine, candidate)
    }

    fn judge_on(&self, level: &Level, candidate: Candidate) -> Found {
        let model = candidate.model(&level.grid, &level.seen, level.samples);
        let score = score(&level.seen, &model, level.grid.width);
        let cost = score.cost(candidate.fitted(), level.seen.len());
        Found {
            candidate,
            score,
            cost,
        }
    }

    /// The mistakes that explain a picture, from what a program without mistakes would have made.
    pub fn run(&self, right: Found) -> Result<Found, Cancelled> {
        let mut best = right;
        while best.candidate.named.len() < MOST_MISTAKES {
            let Some(next) = self.step(&best) else { break };
            best = next;
        }
        if best.candidate.named.len() > 1 {
            best = self.without_needless(best);
        }
        crate::cancel::unless_set(self.cancel, best)
    }

    /// The best candidate with one more mistake, if it is better.
    fn step(&self, from: &Found) -> Option<Found> {
        // Half of what may be done is kept for those that are worth a closer look.
        self.kept.set(self.work.get() / 2.0);
        let mut tried = self.rows(from);
        tried.extend(self.numbers(from));
        self.kept.set(0.0);
        tried.sort_by(|one, other| one.0.total_cmp(&other.0));
        let finalists = tried.into_iter().take(FINALISTS);
        let fitted = finalists.filter_map(|(_, candidate)| {
            let candidate = self.fitted(candidate, &self.middle, 2)?.0;
            self.may(&self.middle)
                .then(|| self.judge_on(&self.middle, candidate))
        });
        let mut fitted: Vec<Found> = fitted.collect();
        // Something too many would explain anything; it is thought of where nothing else explains more than before.
        let rank = |found: &Found| {
            let is_patch = matches!(
                found.candidate.named.last().map(|named| &named.cause),
                Some(Cause::Patch(_))
            );
            (is_patch, found.cost)
        };
        let before = self.judge_on(&self.middle, from.candidate.clone()).cost;
        fitted.retain(|found| found.cost < before);
        fitted.sort_by(|one, other| {
            let (one, other) = (rank(one), rank(other));
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
        });
        let best = self.refined(fitted.into_iter().next()?.candidate)?;
        let is_better = best.cost < from.cost;
        (is_better && words::is_seen(self.scene, &from.candidate, &best.candidate)).then_some(best)
    }

    /// The rows of the table, and how much each leaves on the coarse grid.
    fn rows(&self, from: &Found) -> Vec<(f64, Candidate)> {
        let mut named: Vec<Named> = ROWS.iter().map(Row::named).collect();
        for object in self
            .suspects(from)
            .into_iter()
            .filter(|&object| from.candidate.is_drawn[object])
        {
            let name = Owner::Object(object).name(self.scene);
            named.extend(OBJECT_ROWS.iter().map(|row| Named {
                id: row.id,
                message: format!("{name} {}", row.message),
                help: row.help.to_owned(),
                cause: Cause::ObjectRow(row.change, object),
            }));
        }
        named.extend(self.patch(from));
        let candidates = named
            .into_iter()
            .filter_map(|named| from.candidate.with(named));
        candidates
            .filter_map(|candidate| {
                let differences = self.differences(&candidate, &self.coarse)?;
                Some((absolute(&differences), candidate))
            })
            .collect()
    }

    /// The numbers of the scene, each with what comes nearest on the coarse grid, those first of which a start on the tiny grid leaves least.
    fn numbers(&self, from: &Found) -> Vec<(f64, Candidate)> {
        let candidate = &from.candidate;
        let suspects = self.suspects(from);
        let is_suspect = |parameter: &Parameter| match parameter.owner {
            Owner::Object(object) => suspects.contains(&object) && candidate.is_drawn[object],
            _ => true,
        };
        let all = parameters::all(&candidate.scene).into_iter();
        let all = all.filter(|parameter| is_suspect(parameter) && !is_named(candidate, parameter));
        let mut started: Vec<(f64, Parameter, Vec<f64>)> = all
            .filter_map(|parameter| {
                let steps = self.steps(candidate, &parameter, &self.coarse);
                let numbers = parameter.numbers(&candidate.scene);
                // What one round makes of the numbers as they are is a start, too.
                let near = self.fit_one(candidate, &parameter, &self.tiny, numbers.clone(), 2);
                let others = starts(&parameter, &numbers, &steps)
                    .into_iter()
                    .filter_map(|start| {
                        let differences =
                            self.changed(candidate, &parameter, &start, &self.tiny)?;
                        Some((absolute(&differences), start))
                    });
                let near = near.map(|fitted| (fitted.left, fitted.numbers));
                let best = others
                    .chain(near)
                    .min_by(|one, other| one.0.total_cmp(&other.0))?;
                Some((best.0, parameter, best.1))
            })
            .collect();
        started.sort_by(|one, other| one.0.total_cmp(&other.0));
        let fitted = started
            .into_iter()
            .take(FITTED)
            .filter_map(|(_, parameter, start)| {
                let fitted = self.fit_one(candidate, &parameter, &self.coarse, start, 4)?;
                let named = words::numbers(self.scene, &parameter, fitted.numbers);
                Some((fitted.left, candidate.with(named)?))
            });
        fitted.collect()
    }

    fn steps(&self, candidate: &Candidate, parameter: &Parameter, level: &Level) -> Vec<f64> {
        let steps = parameter.steps(&candidate.scene).into_iter();
        match parameter.is_color() {
            true => steps.collect(),
            false => steps
                .map(|step| step * f64::from(level.grid.factor) / 2.0)
                .collect(),
        }
    }

    fn changed(
        &self,
        from: &Candidate,
        parameter: &Parameter,
        numbers: &[f64],
        level: &Level,
    ) -> Option<Vec<f64>> {
        let scene = parameter.put(&from.scene, numbers)?;
        let changed = Candidate {
            scene,
            ..from.clone()
        };
        self.differences(&changed, level)
    }

    fn fit_one(
        &self,
        from: &Candidate,
        parameter: &Parameter,
        level: &Level,
        start: Vec<f64>,
        rounds: usize,
    ) -> Option<Fitted> {
        let steps = self.steps(from, parameter, level);
        let differences = |numbers: &[f64]| self.changed(from, parameter, numbers, level);
        fit(start, &steps, rounds, &differences)
    }

    /// The objects that may be wrong, those first around which most is.
    fn suspects(&self, from: &Found) -> Vec<usize> {
        let level = &self.fine;
        let textbook = Textbook::new(&from.candidate.scene, from.candidate.behaviour.clone());
        let labels = match self.may(level) {
            true => textbook.labels(&level.grid),
            false => return Vec::new(),
        };
        let mut wrong = vec![0u64; self.scene.objects.len()];
        let width = level.grid.width;
        for (at, _) in from
            .score
            .is_outlier
            .iter()
            .enumerate()
            .filter(|(_, is)| **is)
        {
            // An object that grew is wrong beside where it is seen.
            let reach = [0, 4, width * 4];
            let near = reach
                .iter()
                .flat_map(|by| [at.checked_sub(*by), Some(at + by)])
                .flatten();
            let mut objects: Vec<_> = near.filter_map(|at| *labels.get(at)?).collect();
            objects.sort_unstable();
            objects.dedup();
            objects.into_iter().for_each(|object| wrong[object] += 1);
        }
        let mut suspects: Vec<_> = (0..wrong.len())
            .filter(|&object| wrong[object] > 0)
            .collect();
        suspects.sort_by_key(|&object| std::cmp::Reverse(wrong[object]));
        suspects
    }

    /// Something of one colour where the picture shows what the scene does not: the largest piece of such pixels that hang together.
    fn patch(&self, from: &Found) -> Option<Named> {
        let Level { grid, seen, .. } = &self.fine;
        let mut is_left = from.score.is_outlier.clone();
        let mut largest: Vec<usize> = Vec::new();
        for start in 0..seen.len() {
            if !std::mem::replace(&mut is_left[start], false) {
                continue;
            }
            let mut piece = vec![start];
            let mut at = 0;
            while at < piece.len() {
                let (x, y) = (piece[at] % grid.width, piece[at] / grid.width);
                let beside = [
                    (x > 0).then(|| piece[at] - 1),
                    (x + 1 < grid.width).then_some(piece[at] + 1),
                    (y > 0).then(|| piece[at] - grid.width),
                    (y + 1 < grid.height).then_some(piece[at] + grid.width),
                ];
                for next in beside.into_iter().flatten() {
                    if is_left[next] && is_near(seen[next], seen[start]) {
                        is_left[next] = false;
                        piece.push(next);
                    }
                }
                at += 1;
            }
            if piece.len() > largest.len() {
                largest = piece;
            }
        }
        let light = seen[*largest.first()?];
        let place = |at: usize| grid.place(at % grid.width, at / grid.width, DVec2::splat(0.5));
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for place in largest.iter().map(|&at| place(at)) {
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

    /// All numbers of a candidate fitted together on a level, and how far each may be off.
    fn fitted(
        &self,
        candidate: Candidate,
        level: &Level,
        rounds: usize,
    ) -> Option<(Candidate, Vec<f64>)> {
        let named = &candidate.named;
        let start = joined(named);
        if start.is_empty() {
            return Some((candidate, Vec::new()));
        }
        let of = |named: &Named| match &named.cause {
            Cause::Numbers(parameter, _) => self.steps(&candidate, parameter, level),
            _ => Vec::new(),
        };
        let steps: Vec<f64> = named.iter().flat_map(of).collect();
        let differences = |numbers: &[f64]| {
            let candidate = Candidate::of(self.scene, &split(named, numbers))?;
            self.differences(&candidate, level)
        };
        let fitted = fit(start, &steps, rounds, &differences)?;
        let candidate = Candidate::of(self.scene, &split(named, &fitted.numbers))?;
        Some((candidate, fitted.errors))
    }

    /// A candidate with its numbers fitted on the finest grid, and with as few digits as do.
    fn refined(&self, candidate: Candidate) -> Option<Found> {
        let (candidate, errors) = self
            .fitted(candidate.clone(), &self.fine, 1)
            .unwrap_or((candidate, Vec::new()));
        let (named, numbers) = (candidate.named.clone(), joined(&candidate.named));
        let fitted = self.judged(candidate)?;
        if errors.is_empty() {
            return Some(fitted);
        }
        for digits in [8.0, 2.0] {
            let rounded = numbers.iter().zip(&errors);
            let rounded: Vec<f64> = rounded
                .map(|(x, error)| words::rounded(*x, digits * error))
                .collect();
            if let Some(candidate) = Candidate::of(self.scene, &split(&named, &rounded))
                && let Some(judged) = self.judged(candidate)
                && judged.cost <= fitted.cost + rounded.len() as f64
            {
                return Some(judged);
            }
        }
        Some(fitted)
    }

    /// Without those mistakes that are not needed beside the others.
    fn without_needless(&self, mut found: Found) -> Found {
        let mut at = 0;
        while found.candidate.named.len() > 1 && at < found.candidate.named.len() {
            let mut named = found.candidate.named.clone();
            named.remove(at);
            let without =
                Candidate::of(self.scene, &named).and_then(|candidate| self.judged(candidate));
            match without {
                Some(without) if without.cost <= found.cost => found = without,
                _ => at += 1,
            }
        }
        found
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
    if parameter.is_color() {
        return starts;
    }
    let mut with = |change: &dyn Fn(&mut Vec<f64>)| {
        let mut other = numbers.to_vec();
        change(&mut other);
        if !starts.contains(&other) {
            starts.push(other);
        }
    };
    for i in 0..numbers.len() {
        with(&|other| other[i] = -other[i]);
        with(&|other| other[i] = 0.0);
        with(&|other| other[i] *= 2.0);
        with(&|other| other[i] *= 0.5);
        with(&|other| other.swap(i, (i + 1) % numbers.len()));
        for by in [-9.0, -3.0, 3.0, 9.0] {
            with(&|other| other[i] += by * steps[i]);
        }
    }
    starts
}
