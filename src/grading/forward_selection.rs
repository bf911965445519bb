//! Forward selection with a beam: the table is tried on what each of the few best sets of mistakes
//! leaves, one mistake more at a time, until one of them explains the picture.
//!
//! A tiny grid tells which sets are worth a look. These have their numbers fitted to a coarse grid,
//! and those that leave little to a middle one, which judges them. What shows only where colours
//! meet is judged on the pixels.

use std::collections::BTreeSet;

use super::{
    candidate::{Candidate, Mistake, Shows},
    displacement::Left,
    edge_rows::{ROUNDS, explained_with, refitted, rows_in_areas},
    joint,
    judge::{Judge, Judged, least},
    level::Level,
    numeric_mistakes::numeric_mistakes,
    objects::labels,
    patch::patch,
    plain_numbers::plain,
};
use crate::cancel::{self, Cancelled};

/// Maximum number of mistakes that are looked for, beside those that show at edges.
const MOST_MISTAKES: usize = 3;

/// Number of sets of mistakes that are looked at, and from which it goes on, of each size.
const BEAM: usize = 6;

/// Factors by which a set of mistakes has to leave less on the tiny grid, for each of them and for
/// each number that tells it, to be as good as one without.
const MISTAKE: f64 = 1.05;
const NUMBER: f64 = 1.03;

/// Number of rows that are looked at in an exact picture, those that leave least on the tiny grid:
/// to look at all of them there took as long as to find a single mistake otherwise takes.
const EXACT_ROWS: usize = 24;

/// Maximum number of sets of rows that were made together that are told of.
const TOGETHER: usize = 2;

/// A set of mistakes is looked at at once if it leaves less than this part of what the set that it
/// is made from leaves.
const LESS: f64 = 0.5;

/// Share of what is wrong for certain with a right program's picture, in squares, below which a
/// candidate is near the picture.
const NEAR_SQUARES: f64 = 0.1;

/// So many objects are looked at, those in and beside which most is wrong.
const SUSPECTS: usize = 12;

/// An object is not looked at if less than this part of what is wrong at another is wrong at it:
/// what is left of noise there is no more.
const LITTLE: f64 = 0.03;

/// The mistakes that explain a picture best, from what a program without mistakes would have made,
/// and whether they explain it.
pub fn run(judge: &Judge) -> Result<Option<(Judged, bool)>, Cancelled> {
    let mut search = Search {
        judge,
        known: Vec::new(),
        nearest: None,
        explained: None,
    };
    search.run();
    // The last set may have been found when nothing was left to fit its numbers.
    if search.explained.is_none() && judge.work.is_cut() {
        let nearest = search.nearest.clone();
        judge
            .work
            .without_limit(|| nearest.and_then(|(_, nearest)| search.look_at(&nearest)));
    }
    let Some((_, nearest)) = search.nearest else {
        return Ok(None);
    };
    let is_explained = search.explained.is_some();
    let last = match search.explained.map(|(_, explained)| explained) {
        None => nearest,
        Some(right) if right.mistakes.is_empty() => right,
        Some(explained) => {
            // What explains the picture is told as plainly as can be, however much work that is.
            judge.work.without_limit(|| {
                let fewest = fewest(judge, &explained);
                let plainest = plain(judge, &fewest);
                match judge.explains(&plainest) {
                    true => plainest,
                    false => fewest,
                }
            })
        }
    };
    let found = judge
        .work
        .without_limit(|| judge.judged(&last, judge.edges()));
    let found = found.map(|found| (found, is_explained));
    cancel::unless_set(judge.cancel, found)
}

/// A search for mistakes.
struct Search<'a> {
    judge: &'a Judge<'a>,
    /// The candidates that were looked at.
    known: Vec<Candidate>,
    /// The candidate of least cost, and that.
    nearest: Option<(f64, Candidate)>,
    /// The candidate of fewest numbers, and of these of least cost, that explains the picture, and
    /// that cost.
    explained: Option<(f64, Candidate)>,
}

impl Search<'_> {
    fn run(&mut self) {
        let judge = self.judge;
        let mut beam = Vec::from_iter(self.look_at(&Candidate::right(judge.scene)));
        for _ in 0..MOST_MISTAKES {
            let mut looked_at: Vec<Judged> = Vec::new();
            let mut next: Vec<(f64, Candidate)> = Vec::new();
            for step in beam.iter().map_while(|from| Step::from(judge, from)) {
                let enough = LESS * weighed(step.left, step.from.candidate());
                for way in Step::WAYS {
                    if self.explained.is_some() || !judge.work.may_go_on() {
                        break;
                    }
                    for (less, one) in step.more(way) {
                        let is_known = |other: &Candidate| other.is_alike(&one);
                        if self.known.iter().any(is_known) {
                            continue;
                        }
                        match next.iter_mut().find(|(_, other)| is_known(other)) {
                            Some(other) if other.0 <= less => {}
                            Some(other) => *other = (less, one),
                            None if less < enough && looked_at.len() < BEAM => {
                                looked_at.extend(self.look_at(&one));
                            }
                            None => next.push((less, one)),
                        }
                    }
                }
            }
            for (_, one) in least(next.into_iter(), BEAM - looked_at.len()) {
                looked_at.extend(self.look_at(&one));
            }
            // Something too many would explain anything: it is thought of where nothing else
            // beside the mistakes of a set does.
            for from in beam {
                if self.explained.is_none() {
                    let patched = patched(judge, &from);
                    self.explained = patched.map(|patched| (from.cost, patched));
                }
            }
            if self.explained.is_some() {
                return;
            }
            looked_at.sort_by(|one, other| one.cost.total_cmp(&other.cost));
            beam = looked_at;
        }
    }

    /// Whether a candidate has more numbers than one that explains the picture.
    fn has_more(&self, candidate: &Candidate) -> bool {
        let explained = self.explained.as_ref();
        explained.is_some_and(|(_, explained)| explained.fitted() < candidate.fitted())
    }

    /// Whether one that explains the picture as well does so with fewer numbers, or at less cost.
    fn has_better(&self, candidate: &Candidate, cost: f64) -> bool {
        let explained = self.explained.as_ref();
        explained.is_some_and(|(least, explained)| {
            (explained.fitted(), *least) <= (candidate.fitted(), cost)
        })
    }

    /// A candidate with its numbers fitted, judged on the middle grid; it is kept if it is the
    /// nearest so far, or explains the picture.
    fn look_at(&mut self, candidate: &Candidate) -> Option<Judged> {
        let judge = self.judge;
        if self.has_more(candidate) {
            return None;
        }
        self.known.push(candidate.clone());
        let fitted = refitted(judge, candidate, &judge.coarse, [2, 1]);
        let mut judged = judge.judged(fitted.as_ref().unwrap_or(candidate), &judge.middle)?;
        // Of what is far from the picture nothing else is known.
        if is_near(judge, judged.candidate()) {
            let level = judge.fitting(judged.candidate());
            let fitted = refitted(judge, judged.candidate(), level, [0, ROUNDS]);
            if let Some(fitted) = fitted {
                judged = judge.judged(&fitted, &judge.middle)?;
            }
            // Numbers that are not the right ones leave a little at edges, which others would seem
            // to explain.
            let has_numbers = judged.candidate().numeric().next().is_some();
            let left = || Left::by(judge, judged.candidate());
            if has_numbers && left().is_some_and(|left| left.is_at_edges) {
                let plain = plain(judge, judged.candidate());
                judged = judge.judged(&plain, &judge.middle).unwrap_or(judged);
            }
            let explained = explained_with(judge, judged.candidate());
            if let Some(explained) =
                explained.filter(|explained| !self.has_better(explained, judged.cost))
            {
                self.explained = Some((judged.cost, explained));
            }
        }
        if self.nearest.as_ref().is_none_or(|one| judged.cost < one.0) {
            self.nearest = Some((judged.cost, judged.candidate().clone()));
        }
        Some(judged)
    }
}

/// A candidate with something too many beside it, if it explains the picture so.
fn patched(judge: &Judge, from: &Judged) -> Option<Candidate> {
    is_near(judge, from.candidate()).then_some(())?;
    let patched = from.candidate().with(patch(judge, from)?)?;
    explained_with(judge, &patched)
}

/// Whether a candidate leaves little of what is wrong for certain with a right program's picture.
fn is_near(judge: &Judge, candidate: &Candidate) -> bool {
    let square = |candidate: &Candidate| {
        let predicted = judge.predicted(candidate, &judge.middle);
        predicted.map(|predicted| predicted.strays().square())
    };
    let squares = square(candidate).zip(square(&Candidate::right(judge.scene)));
    candidate.mistakes.is_empty() || squares.is_some_and(|(own, all)| own <= NEAR_SQUARES * all)
}

/// The same with as few mistakes as explain the picture.
fn fewest(judge: &Judge, all: &Candidate) -> Candidate {
    let without = |candidate: &Candidate, at: usize| {
        let mut mistakes = candidate.mistakes.clone();
        mistakes.remove(at);
        Candidate::of(judge.scene, mistakes)
    };
    let mut fewest = all.clone();
    for left_out in (0..fewest.mistakes.len()).rev() {
        // What shows at edges was not told without being sure of it, and neither was what a picture
        // hints at that a right program would explain.
        let is_sole = fewest.mistakes.len() == 1;
        if is_sole || fewest.mistakes.get(left_out).is_none_or(shows_at_edges) {
            continue;
        }
        let Some(fewer) = without(&fewest, left_out) else {
            continue;
        };
        // What is left out may have made up for what numbers are off, or for a row that shows at
        // edges.
        let fitted = || {
            let fitted = refitted(judge, &fewer, judge.fitting(&fewer), [0, ROUNDS])?;
            is_near(judge, &fitted).then_some(())?;
            explained_with(judge, &plain(judge, &fitted))
        };
        let fewer = is_near(judge, &fewer).then(|| explained_with(judge, &fewer));
        let fewer = fewer.flatten().or_else(fitted);
        if let Some(fewer) = fewer.filter(|fewer| fewer.fitted() < fewest.fitted()) {
            fewest = fewer;
        }
    }
    fewest
}

fn shows_at_edges(mistake: &Mistake) -> bool {
    match mistake {
        Mistake::Row(row, _) => row.shows != Shows::InAreas,
        Mistake::Filter(_) => true,
        _ => false,
    }
}

/// Candidates, each with how much it leaves.
type Found = Vec<(f64, Candidate)>;

/// Where a set of mistakes may be told more of.
struct Step<'a> {
    judge: &'a Judge<'a>,
    from: &'a Judged,
    tiny: Level<'a>,
    suspects: Vec<usize>,
    /// How much it leaves on the tiny grid.
    left: f64,
}

impl<'a> Step<'a> {
    /// Ways to find more mistakes, those first that take less work: each makes candidates, and says
    /// how much they leave on the tiny grid.
    const WAYS: [fn(&Self) -> Found; 3] = [Self::rows, Self::numbers, Self::together];

    /// None if there was too much work before.
    fn from(judge: &'a Judge, from: &'a Judged) -> Option<Self> {
        judge.compare_with(from.candidate());
        let tiny = judge.tiny(from.candidate())?;
        let (left, _) = judge.left(from.candidate().clone(), &tiny)?;
        Some(Self {
            judge,
            from,
            suspects: suspects(judge, from),
            left,
            tiny,
        })
    }

    /// Candidates that leave less than the set, those first that leave least, each with how much
    /// that is for the mistakes and the numbers that tell it.
    fn more(&self, way: fn(&Self) -> Found) -> Found {
        let less = way(self).into_iter().filter(|one| one.0 < self.left);
        least(
            less.map(|(left, one)| (weighed(left, &one), one)),
            usize::MAX,
        )
    }

    fn rows(&self) -> Found {
        let (judge, candidate) = (self.judge, self.from.candidate());
        let rows = rows(judge, candidate, &self.suspects, &self.tiny);
        if !candidate.mistakes.is_empty() {
            return rows;
        }
        // Few samples do not tell how far squares are seen: one mistake alone is looked for in an
        // exact picture, and what it leaves is told in parts of what is left without it.
        let Some((exactly, _)) = judge.left(candidate.clone(), &judge.coarse) else {
            return rows;
        };
        let scale = self.left / exactly.max(1e-12);
        let best = least(rows.into_iter(), EXACT_ROWS).into_iter();
        let best = best.filter_map(|(_, one)| judge.left(one, &judge.coarse));
        best.map(|(left, one)| (scale * left, one)).collect()
    }

    fn numbers(&self) -> Found {
        numeric_mistakes(self.judge, self.from, &self.suspects, &self.tiny)
    }

    fn together(&self) -> Found {
        let candidate = self.from.candidate();
        if !candidate.mistakes.is_empty() {
            return Vec::new();
        }
        let mut together = joint::rows_together(self.judge, candidate, &self.tiny);
        together.truncate(TOGETHER);
        together
    }
}

/// How much a candidate leaves, for the mistakes and the numbers that tell it.
fn weighed(left: f64, candidate: &Candidate) -> f64 {
    let [mistakes, numbers] =
        [candidate.mistakes.len(), candidate.fitted()].map(|count| count as f64);
    left * libm::pow(MISTAKE, mistakes) * libm::pow(NUMBER, numbers)
}

/// A candidate with each row of the table that shows in areas, and how much that leaves on a level.
fn rows(
    judge: &Judge,
    from: &Candidate,
    suspects: &[usize],
    level: &Level,
) -> Vec<(f64, Candidate)> {
    let rows = rows_in_areas(suspects).filter_map(|mistake| from.with(mistake));
    rows.filter_map(|one| judge.left(one, level)).collect()
}

/// The objects that may be wrong, those first in and beside which most is.
fn suspects(judge: &Judge, from: &Judged) -> Vec<usize> {
    let grid = &judge.middle.grid;
    let labels = labels(judge, from.candidate(), from.candidate().layout, grid);
    let mut wrong = vec![0.0; judge.scene.objects.len()];
    for (at, off) in from.score.off.iter().enumerate() {
        // An object that grew is wrong beside where it is seen.
        let near: BTreeSet<usize> = grid.around(at, 2).filter_map(|at| labels[at]).collect();
        near.into_iter()
            .for_each(|object| wrong[object] += libm::log1p(*off));
    }
    let most = wrong.iter().copied().fold(0.0, f64::max);
    let wrong = (0..).zip(wrong).filter(|(_, wrong)| *wrong > LITTLE * most);
    let suspects = least(wrong.map(|(object, wrong)| (-wrong, object)), SUSPECTS);
    suspects.into_iter().map(|(_, object)| object).collect()
}
