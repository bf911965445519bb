//! Forward selection: the mistake that explains most, then the table once more on what is left, at most four times; then what is not needed any more
//! goes.
//!
//! A coarse grid tells which mistakes are worth a look, a finer one fits their numbers, and the finest one judges them. Work is counted in rays times
//! objects, so that it does not depend on the machine.

use std::{
    cell::Cell,
    sync::atomic::{AtomicBool, Ordering},
};

use super::{
    candidate::{Candidate, Cause, Look, Named, is_near},
    fit::{absolute, fit},
    grid::Grid,
    mistakes::{OBJECT_ROWS, ROWS},
    parameters::{self, Parameter},
    score::{Score, score},
    words,
};
use crate::{area::Area, cancel::Cancelled, film::Film, scene::Scene};

/// So many mistakes are named at most.
const MOST_MISTAKES: usize = 4;

/// So many are fitted and judged at a time, of those that explain most on the coarse grid.
const FINALISTS: usize = 5;

/// A move of less than this, in pixels, is not named.
pub const HALF_PIXEL: f64 = 0.5;

/// The longest sides of the three grids, in cells, and the samples in a cell.
const COARSE: (u32, usize) = (64, 8);
const MIDDLE: (u32, usize) = (160, 8);
const FINE: (u32, usize) = (640, 21);

/// Rays times objects: for any picture, and for each of its pixels. Measured: 4 to 8 nanoseconds each.
const WORK: f64 = 9e7;
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
    pub coarse: Level,
    pub middle: Level,
    pub fine: Level,
    /// What may still be done.
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
            coarse: level(COARSE),
            middle: level(MIDDLE),
            fine: level(FINE),
            work: Cell::new(WORK + WORK_OF_A_PIXEL * part.pixels() as f64),
            is_cut: Cell::new(false),
            cancel,
        }
    }

    /// Whether a picture of the scene may be made on a level.
    fn may(&self, level: &Level) -> bool {
        let objects = self.scene.objects.len() as f64 + 1.0;
        let left = self.work.get() - objects * (level.grid.cells() * level.samples) as f64;
        let may = left >= 0.0 && !self.cancel.load(Ordering::Relaxed);
        match may {
            true => self.work.set(left),
            false => self.is_cut.set(true),
        }
        may
    }

    fn differences(&self, candidate: &Candidate, level: &Level) -> Option<Vec<f64>> {
        self.may(level).then(|| {
            let model = candidate.model(&level.grid, &level.seen, level.samples);
            let pairs = model
                .moments
                .mean
                .iter()
                .flatten()
                .zip(level.seen.iter().flatten());
            pairs.map(|(mean, seen)| mean - seen).collect()
        })
    }

    /// Judges a candidate on the finest grid.
    pub fn judged(&self, candidate: Candidate) -> Option<Found> {
        let level = &self.fine;
        self.may(level).then(|| {
            let model = candidate.model(&level.grid, &level.seen, level.samples);
            let score = score(&level.seen, &model, level.grid.width);
            let cost = score.cost(candidate.fitted(), level.seen.len());
            Found {
                candidate,
                score,
                cost,
            }
        })
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
        let mut tried: Vec<(f64, Candidate)> = Vec::new();
        let mut add = |named: Named| {
            if let Some(candidate) = from.candidate.with(named)
                && let Some(differences) = self.differences(&candidate, &self.coarse)
            {
                tried.push((absolute(&differences), candidate));
            }
        };
        for row in ROWS {
            add(row.named());
        }
        let suspects = self.suspects(from);
        for &object in &suspects {
            for row in OBJECT_ROWS
                .iter()
                .filter(|_| from.candidate.is_drawn[object])
            {
                let message = format!(
                    "{} {}",
                    parameters::Owner::Object(object).name(self.scene),
                    row.message
                );
                let cause = Cause::ObjectRow(row.change, object);
                add(Named {
                    id: row.id,
                    message,
                    help: row.help.to_owned(),
                    cause,
                });
            }
        }
        if let Some(patch) = self.patch(from) {
            add(patch);
        }
        let rank = |parameter: &Parameter| match parameter.owner {
            parameters::Owner::Object(object) => suspects
                .iter()
                .position(|&one| one == object)
                .map(|at| at + 1),
            _ => Some(0),
        };
        let mut ranked: Vec<_> = parameters::all(&from.candidate.scene)
            .into_iter()
            .filter(|parameter| !is_named(&from.candidate, parameter))
            .filter_map(|parameter| Some((rank(&parameter)?, parameter)))
            .collect();
        ranked.sort_by_key(|(rank, _)| *rank);
        for (_, parameter) in ranked {
            tried.extend(self.fitted_coarsely(&from.candidate, &parameter));
        }
        tried.sort_by(|one, other| one.0.total_cmp(&other.0));
        let finalists = tried.into_iter().take(FINALISTS);
        let judged = finalists.filter_map(|(_, candidate)| self.judged(self.refined(candidate)?));
        let best = judged.min_by(|one, other| one.cost.total_cmp(&other.cost))?;
        (best.cost < from.cost && words::is_seen(self.scene, &from.candidate, &best.candidate))
            .then_some(best)
    }

    /// The objects that may be wrong, those first around which most is.
    fn suspects(&self, from: &Found) -> Vec<usize> {
        let level = &self.fine;
        let textbook =
            super::textbook::Textbook::new(&from.candidate.scene, from.candidate.behaviour.clone());
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

    /// Something of one colour where the picture shows what the scene does not.
    fn patch(&self, from: &Found) -> Option<Named> {
        let level = &self.fine;
        let outliers: Vec<usize> = (0..level.seen.len())
            .filter(|&at| from.score.is_outlier[at])
            .collect();
        let middle = *outliers.get(outliers.len() / 2)?;
        let light = level.seen[middle];
        let own: Vec<_> = outliers
            .iter()
            .filter(|&&at| is_near(level.seen[at], light))
            .collect();
        let places = own.iter().map(|&&at| {
            level.grid.place(
                at % level.grid.width,
                at / level.grid.width,
                glam::DVec2::splat(0.5),
            )
        });
        let (mut least, mut most) = (glam::DVec2::INFINITY, glam::DVec2::NEG_INFINITY);
        places.for_each(|place| (least, most) = (least.min(place), most.max(place)));
        let reach = f64::from(level.grid.factor);
        let area = [(least - reach).to_array(), (most + reach).to_array()];
        let at = (least + most) / 2.0;
        let color = crate::color::Color {
            srgb: light.map(|light| 255.0 * crate::color::linear_to_srgb(light)),
        };
        Some(Named {
            id: "object_extra",
            message: format!("there is something too many, of the colour {color}, around the pixel ({:.0}, {:.0})", at.x, at.y),
            help: "the scene has no such object; are all of its fields read, and none of another scene's?".to_owned(),
            cause: Cause::Patch(Look::Patch { light, area }),
        })
    }

    /// A parameter with the numbers that come nearest on the coarse grid.
    fn fitted_coarsely(&self, from: &Candidate, parameter: &Parameter) -> Option<(f64, Candidate)> {
        let numbers = parameter.numbers(&from.scene);
        let steps = parameter.steps(&from.scene);
        let coarse: Vec<f64> = steps
            .iter()
            .map(|step| step * f64::from(self.coarse.grid.factor) / 2.0)
            .collect();
        let differences = |numbers: &[f64]| {
            let mut changed = from.clone();
            changed.scene = parameter.put(&from.scene, numbers)?;
            self.differences(&changed, &self.coarse)
        };
        let mut starts: Vec<(f64, Vec<f64>)> = starts(parameter, &numbers, &coarse)
            .into_iter()
            .filter_map(|start| Some((absolute(&differences(&start)?), start)))
            .collect();
        starts.sort_by(|one, other| one.0.total_cmp(&other.0));
        let fitted = fit(starts.into_iter().next()?.1, &coarse, 6, &differences)?;
        let candidate = from.with(words::numbers(self.scene, parameter, fitted.numbers))?;
        Some((fitted.left, candidate))
    }

    /// All numbers of a candidate, fitted together: on the middle grid and on the finest one; with as few digits as do.
    fn refined(&self, candidate: Candidate) -> Option<Candidate> {
        let mut named = candidate.named;
        let start = joined(&named);
        if start.is_empty() {
            return Candidate::of(self.scene, &named);
        }
        let mut numbers = start;
        let steps: Vec<f64> = {
            let of = |named: &Named| match &named.cause {
                Cause::Numbers(parameter, _) => parameter.steps(&candidate.scene),
                _ => Vec::new(),
            };
            named.iter().flat_map(of).collect()
        };
        let mut errors = Vec::new();
        for (level, rounds) in [(&self.middle, 4), (&self.fine, 2)] {
            let differences = |numbers: &[f64]| {
                let candidate = Candidate::of(self.scene, &split(&named, numbers))?;
                self.differences(&candidate, level)
            };
            let own: Vec<f64> = steps
                .iter()
                .map(|step| step * f64::from(level.grid.factor) / 2.0)
                .collect();
            let Some(fitted) = fit(numbers.clone(), &own, rounds, &differences) else {
                continue;
            };
            (numbers, errors) = (fitted.numbers, fitted.errors);
        }
        named = split(&named, &numbers);
        let exact = self.judged(Candidate::of(self.scene, &named)?)?;
        for digits in [8.0, 2.0] {
            let rounded: Vec<f64> = numbers
                .iter()
                .zip(&errors)
                .map(|(x, error)| words::rounded(*x, digits * error))
                .collect();
            if let Some(candidate) = Candidate::of(self.scene, &split(&named, &rounded))
                && let Some(judged) = self.judged(candidate)
                && judged.cost <= exact.cost + rounded.len() as f64
            {
                return Some(judged.candidate);
            }
        }
        Some(exact.candidate)
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
        for by in [-12.0, -6.0, -3.0, 3.0, 6.0, 12.0] {
            with(&|other| other[i] += by * steps[i]);
        }
    }
    starts
}
