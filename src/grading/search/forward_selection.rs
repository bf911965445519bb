//! Forward selection with a beam: extends the few best sets of mistakes by one mistake at a time,
//! until one of them explains the picture.
//!
//! The tiny grid selects the sets that are worth examining. Their numbers are fitted to a coarse
//! grid, and to the middle one if little remains, on which they are judged. Mistakes that are
//! visible only at edges are judged on the pixels.

use std::collections::BTreeSet;

use super::{
    edge_rows::{ROUNDS, explained_with, refitted, rows_in_areas},
    joint,
    judge::{Judge, Judged, least},
    labels::labels,
    numeric_mistakes::{numeric_mistakes, slightly_wrong},
    patch::patch,
    plain_numbers::plain,
    residual::Residual,
};
use crate::{
    cancel::{self, Cancelled},
    grading::{
        hypotheses::{Candidate, Mistake, Shows},
        scoring::Level,
    },
};

/// Maximum number of mistakes in a set, besides those that are visible only at edges.
const MAX_MISTAKES: usize = 3;

/// Maximum number of sets of each size that are examined and extended. A wider beam finds more at
/// proportionally more work.
const BEAM_WIDTH: usize = 6;

/// Factor by which a set's difference on the tiny grid is multiplied for each mistake, so that a
/// larger set must explain more.
const MISTAKE_PENALTY: f64 = 1.05;
/// Factor by which a set's difference on the tiny grid is multiplied for each fitted number.
const NUMBER_PENALTY: f64 = 1.03;

/// Number of rows that are compared on an exact picture, with the least difference on the tiny grid
/// first. Comparing all of them takes as long as finding a single mistake does otherwise.
const EXACT_ROWS: usize = 32;

/// Maximum number of combinations of mistakes that are examined because they may explain the
/// picture only together (see `joint_rows`); those with the least difference come first.
const JOINT_SETS: usize = 2;

/// Ratio of a set's difference to that of the set it extends, below which it is examined at once,
/// before other kinds of mistakes are tried.
const PROMISING: f64 = 0.5;

/// Share of a correct program's certain error, in squares, below which a candidate is near the
/// picture.
const NEAR_RATIO: f64 = 0.1;

/// Maximum number of objects that are suspected, those with the largest error in and beside them
/// first. The work of a search grows with this number.
const MAX_SUSPECTS: usize = 12;

/// Share of the largest error at an object below which an object is not suspected: smaller errors
/// are mostly noise.
const SUSPECT_RATIO: f64 = 0.03;

/// Searches for the mistakes that explain a picture best. Returns the best candidate, and whether
/// it explains the picture.
pub fn run(judge: &Judge) -> Result<Option<(Judged, bool)>, Cancelled> {
    let mut search = Search {
        judge,
        examined: Vec::new(),
        nearest: None,
        explained: None,
    };
    search.run();
    // The budget may have run out before the last set's numbers were fitted.
    if search.explained.is_none() && judge.work.is_cut() {
        let nearest = search.nearest.clone();
        judge
            .work
            .without_limit(|| nearest.and_then(|(_, nearest)| search.examine(&nearest)));
    }
    let Some((_, nearest)) = search.nearest else {
        return Ok(None);
    };
    let is_explained = search.explained.is_some();
    let last = match search.explained.map(|(_, explained)| explained) {
        None => nearest,
        Some(right) if right.mistakes.is_empty() => right,
        Some(explained) => {
            // A candidate that explains the picture is simplified even if the budget is used up.
            judge.work.without_limit(|| {
                let fewest = fewest(judge, &explained);
                let plainest = plain(judge, &fewest);
                if judge.explains(&plainest) {
                    plainest
                } else {
                    fewest
                }
            })
        }
    };
    let found = judge
        .work
        .without_limit(|| judge.judged(&last, judge.central_crop()));
    let found = found.map(|found| (found, is_explained));
    cancel::unless_set(judge.work.cancel, found)
}

/// State of a search.
struct Search<'a> {
    judge: &'a Judge<'a>,
    /// The candidates that were examined.
    examined: Vec<Candidate>,
    /// The candidate of least cost, and its cost.
    nearest: Option<(f64, Candidate)>,
    /// The candidate that explains the picture with the fewest parameters, then at the least cost,
    /// and its cost.
    explained: Option<(f64, Candidate)>,
}

impl Search<'_> {
    fn run(&mut self) {
        let judge = self.judge;
        let mut beam = Vec::from_iter(self.examine(&Candidate::correct(judge.scene)));
        for _ in 0..MAX_MISTAKES {
            let mut examined: Vec<Judged> = Vec::new();
            let mut next: Vec<(f64, Candidate)> = Vec::new();
            for extension in beam.iter().map_while(|from| Extension::from(judge, from)) {
                let enough =
                    PROMISING * penalised(extension.difference, extension.from.candidate());
                for kind in Extension::KINDS {
                    if self.explained.is_some() || !judge.work.may_go_on() {
                        break;
                    }
                    for (less, one) in extension.improvements(kind) {
                        let is_examined = |other: &Candidate| other.is_same_kind(&one);
                        if self.examined.iter().any(is_examined) {
                            continue;
                        }
                        match next.iter_mut().find(|(_, other)| is_examined(other)) {
                            Some(other) if other.0 <= less => {}
                            Some(other) => *other = (less, one),
                            None if less < enough && examined.len() < BEAM_WIDTH => {
                                examined.extend(self.examine(&one));
                            }
                            None => next.push((less, one)),
                        }
                    }
                }
            }
            for (_, one) in least(next.into_iter(), BEAM_WIDTH - examined.len()) {
                examined.extend(self.examine(&one));
            }
            if let Some(best) = beam.first() {
                self.refine(best, &mut examined);
            }
            // An extra patch can explain anything, so it is tried only where no other mistake
            // completes a set.
            for from in beam {
                if self.explained.is_none() {
                    let patched = patched(judge, &from);
                    self.explained = patched.map(|patched| (from.cost, patched));
                }
            }
            if self.explained.is_some() {
                return;
            }
            examined.sort_by(|one, other| one.cost.total_cmp(&other.cost));
            examined.truncate(BEAM_WIDTH);
            beam = examined;
        }
    }

    /// Extends the best set of mistakes, unless the picture is explained, by numbers that are
    /// slightly wrong, examines the new sets, and adds them to `examined`.
    fn refine(&mut self, best: &Judged, examined: &mut Vec<Judged>) {
        let judge = self.judge;
        if self.explained.is_some() || !judge.work.may_go_on() {
            return;
        }
        judge.compare_with(best.candidate());
        for one in slightly_wrong(judge, best.candidate(), &suspects(judge, best)) {
            // An examined set of the same kind has numbers that were fitted to a few samples.
            examined.extend(self.examine(&one));
        }
    }

    /// Returns whether another candidate explains the picture with fewer parameters, or with as
    /// many at no more cost.
    fn has_better(&self, candidate: &Candidate, cost: f64) -> bool {
        let explained = self.explained.as_ref();
        explained.is_some_and(|(least, explained)| {
            (explained.parameter_count(), *least) <= (candidate.parameter_count(), cost)
        })
    }

    /// Fits and judges a candidate on the middle grid. Keeps it if it is the best so far, or
    /// explains the picture.
    fn examine(&mut self, candidate: &Candidate) -> Option<Judged> {
        let judge = self.judge;
        if self.has_better(candidate, f64::NEG_INFINITY) {
            return None;
        }
        self.examined.push(candidate.clone());
        let fitted = refitted(judge, candidate, &judge.coarse, [2, 1]);
        let mut judged = judge.judged(fitted.as_ref().unwrap_or(candidate), &judge.middle)?;
        // Far from the picture nothing more can be concluded.
        if is_near(judge, judged.candidate()) {
            let level = judge.fitting(judged.candidate());
            let fitted = refitted(judge, judged.candidate(), level, [0, ROUNDS]);
            if let Some(fitted) = fitted {
                judged = judge.judged(&fitted, &judge.middle)?;
            }
            // Slightly wrong numbers leave a residual at edges, which rows about edges would seem
            // to explain.
            let has_numbers = judged.candidate().numeric().next().is_some();
            let residual = || Residual::of_candidate(judge, judged.candidate());
            if has_numbers && residual().is_some_and(|residual| residual.is_at_edges) {
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

/// Returns a candidate with an extra patch, if it explains the picture.
fn patched(judge: &Judge, from: &Judged) -> Option<Candidate> {
    if !is_near(judge, from.candidate()) {
        return None;
    }
    let patched = from.candidate().with(patch(judge, from)?)?;
    explained_with(judge, &patched)
}

/// Returns whether a candidate leaves little of a correct program's certain error.
fn is_near(judge: &Judge, candidate: &Candidate) -> bool {
    let square = |candidate: &Candidate| {
        let predicted = judge.predicted(candidate, &judge.middle);
        predicted.map(|predicted| predicted.strays().square())
    };
    let squares = square(candidate).zip(square(&Candidate::correct(judge.scene)));
    candidate.mistakes.is_empty() || squares.is_some_and(|(own, all)| own <= NEAR_RATIO * all)
}

/// Removes mistakes as long as the rest explains the picture.
fn fewest(judge: &Judge, all: &Candidate) -> Candidate {
    let without = |candidate: &Candidate, at: usize| {
        let mut mistakes = candidate.mistakes.clone();
        mistakes.remove(at);
        Candidate::of(judge.scene, mistakes)
    };
    let mut fewest = all.clone();
    for left_out in (0..fewest.mistakes.len()).rev() {
        // A mistake at edges was added only with certainty, and so was a hinted row of a picture
        // that a correct program would explain.
        let is_sole = fewest.mistakes.len() == 1;
        if is_sole || fewest.mistakes.get(left_out).is_none_or(shows_at_edges) {
            continue;
        }
        let Some(fewer) = without(&fewest, left_out) else {
            continue;
        };
        // The mistake may have compensated for wrong numbers, or for a row about edges.
        let fitted = || {
            let fitted = refitted(judge, &fewer, judge.fitting(&fewer), [0, ROUNDS])?;
            if !is_near(judge, &fitted) {
                return None;
            }
            explained_with(judge, &plain(judge, &fitted))
        };
        let fewer = is_near(judge, &fewer).then(|| explained_with(judge, &fewer));
        let fewer = fewer.flatten().or_else(fitted);
        let is_fewer = |one: &Candidate| one.parameter_count() < fewest.parameter_count();
        if let Some(fewer) = fewer.filter(is_fewer) {
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

/// Candidates, each with its difference on the tiny grid.
type Rated = Vec<(f64, Candidate)>;

/// The extension of a set by one mistake.
struct Extension<'a> {
    judge: &'a Judge<'a>,
    from: &'a Judged,
    tiny: Level<'a>,
    suspects: Vec<usize>,
    /// The set's difference on the tiny grid.
    difference: f64,
}

impl<'a> Extension<'a> {
    /// The kinds of extensions, cheapest first. Each returns candidates with their differences on
    /// the tiny grid.
    const KINDS: [fn(&Self) -> Rated; 3] = [Self::rows, Self::numbers, Self::joint];

    /// Prepares the extension of a set. Returns `None` if the budget is used up.
    fn from(judge: &'a Judge, from: &'a Judged) -> Option<Self> {
        judge.compare_with(from.candidate());
        let tiny = judge.tiny(from.candidate())?;
        let (difference, _) = judge.with_difference(from.candidate().clone(), &tiny)?;
        Some(Self {
            judge,
            from,
            suspects: suspects(judge, from),
            difference,
            tiny,
        })
    }

    /// Returns the extensions of one kind that reduce the set's difference, with their penalised
    /// differences, least first.
    fn improvements(&self, kind: fn(&Self) -> Rated) -> Rated {
        let less = kind(self).into_iter().filter(|one| one.0 < self.difference);
        least(
            less.map(|(left, one)| (penalised(left, &one), one)),
            usize::MAX,
        )
    }

    fn rows(&self) -> Rated {
        let (judge, candidate) = (self.judge, self.from.candidate());
        let rows = rows_in_areas(&self.suspects).filter_map(|row| candidate.with(row));
        let rows = rows.filter_map(|one| judge.with_difference(one, &self.tiny));
        let rows: Rated = rows.collect();
        if !candidate.mistakes.is_empty() {
            return best_of_each_id(rows);
        }
        // Few samples cannot distinguish how far squares are visible, so a single mistake is
        // compared on an exact picture; its difference there is scaled to the tiny grid's.
        let Some((exactly, _)) = judge.with_difference(candidate.clone(), &judge.coarse) else {
            return best_of_each_id(rows);
        };
        let scale = self.difference / exactly.max(1e-12);
        let best = least(rows.into_iter(), EXACT_ROWS).into_iter();
        let best = best.filter_map(|(_, one)| judge.with_difference(one, &judge.coarse));
        best_of_each_id(best.map(|(left, one)| (scale * left, one)).collect())
    }

    fn numbers(&self) -> Rated {
        numeric_mistakes(self.judge, self.from, &self.suspects, &self.tiny)
    }

    fn joint(&self) -> Rated {
        let candidate = self.from.candidate();
        if !candidate.mistakes.is_empty() {
            return Vec::new();
        }
        let mut joint = joint::joint_rows(self.judge, candidate, &self.tiny);
        joint.truncate(JOINT_SETS);
        joint
    }
}

/// Keeps of the rows with one identifier and object the one with the least difference. Variants of
/// one row would fill the beam otherwise.
fn best_of_each_id(rows: Rated) -> Rated {
    let mut known = BTreeSet::new();
    let mut best = least(rows.into_iter(), usize::MAX);
    best.retain(|(_, one)| match one.mistakes.last() {
        Some(Mistake::Row(row, object)) => known.insert((row.id, *object)),
        _ => true,
    });
    best
}

/// Multiplies a difference by the penalties for a candidate's mistakes and parameters.
fn penalised(difference: f64, candidate: &Candidate) -> f64 {
    let [mistakes, numbers] =
        [candidate.mistakes.len(), candidate.parameter_count()].map(|count| count as f64);
    difference * libm::pow(MISTAKE_PENALTY, mistakes) * libm::pow(NUMBER_PENALTY, numbers)
}

/// Returns the objects that may be wrong, the largest error first.
fn suspects(judge: &Judge, from: &Judged) -> Vec<usize> {
    let grid = &judge.middle.grid;
    let labels = labels(judge, from.candidate(), from.candidate().layout, grid);
    let mut wrong = vec![0.0; judge.scene.objects.len()];
    for (at, off) in from.score.chi_squares.iter().enumerate() {
        // An object that grew is wrong beside the cells where it was seen.
        let near: BTreeSet<usize> = grid.around(at, 2).filter_map(|at| labels[at]).collect();
        near.into_iter()
            .for_each(|object| wrong[object] += libm::log1p(*off));
    }
    let most = wrong.iter().copied().fold(0.0, f64::max);
    let wrong = (0..).zip(wrong);
    let wrong = wrong.filter(|(_, wrong)| *wrong > SUSPECT_RATIO * most);
    let suspects = least(wrong.map(|(object, wrong)| (-wrong, object)), MAX_SUSPECTS);
    suspects.into_iter().map(|(_, object)| object).collect()
}
