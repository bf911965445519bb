//! Searches for mistakes by forward selection with a beam: the few best sets of mistakes are
//! extended by one mistake at a time, until a set explains the picture.
//!
//! On the coarsest grid (`tiny`), promising sets are selected. Their numbers are fitted on a finer
//! grid (`coarse`) and, if little error remains, on the next finer grid (`middle`), where sets are
//! judged. Mistakes that are visible only at edges are judged on single pixels.

use std::collections::BTreeSet;

use super::{
    edge_rows::{ROUNDS, explained_with, rows_in_areas},
    joint,
    judge::{Judge, JudgedCandidate, least},
    numeric_mistakes::{numeric_mistakes, slightly_wrong, suspects},
    patch::patch,
    plain_numbers::plain,
};
use crate::{
    cancel::{self, Cancelled},
    grading::{
        hypotheses::{Candidate, Mistake, Shows, Spheres},
        scoring::Level,
    },
};

/// Maximum number of mistakes in a set, not counting those that are visible only at edges. Each
/// further mistake takes another round of the search, so a larger number takes longer.
pub const MAX_MISTAKES: usize = 3;

/// Maximum number of sets of mistakes of one size that are examined and extended. With a wider
/// beam, the search finds more mistakes, but needs proportionally more work.
const BEAM_WIDTH: usize = 6;

/// Factor by which a set's difference from the picture is multiplied, once for each of its
/// mistakes. With a smaller factor, sets would get mistakes that explain nothing. With a larger
/// one, mistakes with small effects would be missed.
const MISTAKE_PENALTY: f64 = 1.05;
/// Factor by which a set's difference from the picture is multiplied, once for each parameter of
/// its mistakes. So a set with more parameters must explain more. With a smaller factor, wrong
/// numbers would be preferred to simpler mistakes. With a larger one, wrong numbers would be
/// missed.
const NUMBER_PENALTY: f64 = 1.03;

/// Maximum number of rows of the table of mistakes for which an exact picture is rendered. Rows
/// with the least difference from the picture on the coarsest grid are chosen. With exact pictures
/// for all rows, finding a single mistake would take twice as long.
const EXACT_ROWS: usize = 32;

/// Maximum number of sets from `joint` that are examined, i.e. of sets whose mistakes explain the
/// picture only together. The best ones are chosen. A larger number takes longer.
const JOINT_SETS: usize = 2;

/// Threshold below which an extended set of mistakes is examined at once: its difference from the
/// picture, divided by that of the set before the extension. If it explains the picture, no other
/// kinds of mistakes are tried. With a larger threshold, more sets would be examined in vain.
const PROMISING: f64 = 0.5;

/// Threshold up to which a hypothesis is close to the student's picture: its squared difference
/// from this picture, divided by that of a correct program. Differences that sampling can explain
/// are ignored. Only close hypotheses are fitted completely, because complete fitting takes long.
const NEAR_RATIO: f64 = 0.1;

/// Maximum squared difference of a hypothesis from the student's picture, divided by the least
/// squared difference of all hypotheses so far. If the quotient is larger, the hypothesis's numbers
/// are not fitted further, because it is unlikely to become the best.
const WORSE: f64 = 4.0;
/// Threshold up to which [`WORSE`] does not apply: a hypothesis's squared difference from the
/// student's picture, divided by that of a correct program. Without this threshold, a hypothesis
/// with a difference of 0 would exclude all others from further fitting.
const NEGLIGIBLE: f64 = 1e-3;

/// Maximum squared difference from the student's picture, divided by that of a correct program, at
/// which a set of two mistakes is extended by a third. If two mistakes leave more than half of the
/// difference, the picture most likely shows another scene. For a picture of another scene,
/// extending such sets in vain took a third of the time.
const EXTENDED: f64 = 0.5;

/// Searches for the mistakes that explain a picture best. Tries sets of at most `most` mistakes,
/// and adds a few that are visible only at edges. Returns the best set, as a hypothesis, and
/// whether it explains the picture.
pub fn run(judge: &Judge, most: usize) -> Result<Option<(JudgedCandidate, bool)>, Cancelled> {
    let mut search = Search {
        judge,
        examined: Vec::new(),
        completed: Vec::new(),
        least_left: f64::INFINITY,
        cost_of_correct: f64::INFINITY,
        nearest: None,
        explained: None,
    };
    search.run(most);
    // If the budget of work ran out before the numbers of the nearest hypothesis were fitted, they
    // are fitted now.
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
            // A hypothesis that explains the picture is simplified even if the budget of work is
            // used up.
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

/// State of a search for mistakes.
struct Search<'a> {
    judge: &'a Judge<'a>,
    /// Hypotheses, i.e. sets of mistakes, that were examined so far.
    examined: Vec<Candidate>,
    /// Sets of mistakes with completely fitted numbers that do not explain the picture, not even
    /// with a further mistake at edges.
    completed: Vec<Vec<Mistake>>,
    /// Least squared difference from the student's picture among all hypotheses so far, divided by
    /// that of a correct program.
    least_left: f64,
    /// Cost ([`JudgedCandidate::cost`]) of a correct program.
    cost_of_correct: f64,
    /// Hypothesis with the least cost so far, and its cost; `None` at the start.
    nearest: Option<(f64, Candidate)>,
    /// Hypothesis that explains the picture, and its cost; `None` if none is known. If several
    /// hypotheses explain the picture, this is the one with the fewest parameters and, among these,
    /// with the least cost.
    explained: Option<(f64, Candidate)>,
}

impl Search<'_> {
    fn run(&mut self, most: usize) {
        let judge = self.judge;
        let mut beam = Vec::from_iter(self.examine(&Candidate::correct(judge.scene)));
        if let [correct] = &beam[..] {
            self.cost_of_correct = correct.cost;
        }
        for size in 1..=most {
            let mut examined: Vec<JudgedCandidate> = Vec::new();
            let mut next: Vec<(f64, Candidate)> = Vec::new();
            for from in &beam {
                if self.is_explained_by(size) {
                    break;
                }
                let Some(extension) = Extension::from(judge, from) else {
                    break;
                };
                let enough =
                    PROMISING * penalised(extension.difference, extension.from.candidate());
                for kind in Extension::KINDS {
                    if self.is_explained_by(size) || !judge.work.may_go_on() {
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
            // If a set explains the picture, less promising sets need not be examined.
            if !self.is_explained_by(size) {
                for (_, one) in least(next.into_iter(), BEAM_WIDTH - examined.len()) {
                    examined.extend(self.examine(&one));
                }
            }
            if let Some(best) = beam.first() {
                self.refine(best, &mut examined);
            }
            // A patch can explain almost any picture, so it is tried last, and only if no other
            // mistake explains the picture.
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
            if size > 1 {
                let left = |one: &JudgedCandidate| left(judge, one.candidate());
                examined.retain(|one| left(one).is_some_and(|left| left <= EXTENDED));
            }
            beam = examined;
        }
    }

    /// Extends the best set of mistakes by numbers of the scene that are slightly wrong, examines
    /// the results, and adds them to `examined`. Does nothing if the picture is explained already.
    fn refine(&mut self, best: &JudgedCandidate, examined: &mut Vec<JudgedCandidate>) {
        let judge = self.judge;
        if self.explained.is_some() || !judge.work.may_go_on() {
            return;
        }
        judge.compare_with(best.candidate());
        for one in slightly_wrong(judge, best.candidate(), &suspects(judge, best)) {
            // A set with the same mistakes, but other numbers, may have been examined before. The
            // set is examined nevertheless, because the other numbers were fitted to few samples.
            examined.extend(self.examine(&one));
        }
    }

    /// Returns whether the picture is explained by at most `size` mistakes, so that the search can
    /// end. The search goes on if a larger set explains the picture, because a single wrong number
    /// may explain it, too. It also goes on if the program intersects spheres wrongly, because such
    /// a picture is only sampled, and may agree by chance.
    fn is_explained_by(&self, size: usize) -> bool {
        let explained = self.explained.as_ref();
        explained.is_some_and(|(_, explained)| {
            explained.mistakes.len() <= size && !hits_spheres_wrongly(explained)
        })
    }

    /// Returns whether a known hypothesis (`explained`) explains the picture with fewer parameters
    /// than `candidate`, or with equally many and at most the cost `cost`. If the known program
    /// intersects spheres wrongly, mistakes are counted instead of parameters. Otherwise, it would
    /// exclude the mistake of a single wrong vector, which has several parameters.
    fn has_better(&self, candidate: &Candidate, cost: f64) -> bool {
        let explained = self.explained.as_ref();
        explained.is_some_and(|(least, explained)| {
            let count = |one: &Candidate| {
                if hits_spheres_wrongly(explained) {
                    one.mistakes.len()
                } else {
                    one.parameter_count()
                }
            };
            (count(explained), *least) <= (count(candidate), cost)
        })
    }

    /// Fits a hypothesis's numbers, and judges it on the grid `middle`. Remembers it if it has the
    /// least cost so far, or explains the picture. Returns `None` if a simpler hypothesis is known
    /// to explain the picture, or if the budget of work is used up.
    fn examine(&mut self, candidate: &Candidate) -> Option<JudgedCandidate> {
        let judge = self.judge;
        if self.has_better(candidate, f64::NEG_INFINITY) {
            return None;
        }
        self.examined.push(candidate.clone());
        let fitted = judge.fit_all(candidate, &judge.coarse, [2, 1]);
        let fitted = fitted.map_or_else(|| candidate.clone(), |(fitted, _)| fitted);
        let mut judged = judge.judged(&fitted, &judge.middle)?;
        // A hypothesis is not fitted further if its difference is large, or much larger than that
        // of another one. The same holds if it traces rays wrongly and is no better than a correct
        // program, because sampling its picture takes long.
        let left = left(judge, judged.candidate()).unwrap_or(f64::INFINITY);
        self.least_left = self.least_left.min(left);
        let most = NEAR_RATIO.min(f64::max(WORSE * self.least_left, NEGLIGIBLE));
        let is_idle = !candidate.behaviour.is_correct() && judged.cost >= self.cost_of_correct;
        if candidate.mistakes.is_empty() || left <= most && !is_idle {
            let level = judge.fitting(judged.candidate());
            if let Some((fitted, _)) = judge.fit_all(judged.candidate(), level, [0, ROUNDS]) {
                judged = judge.judged(&fitted, &judge.middle)?;
            }
            // A better hypothesis explains the picture already.
            if self.has_better(judged.candidate(), judged.cost) {
                return Some(judged);
            }
            // Slightly wrong numbers leave errors at edges. A mistake at edges would seem to
            // explain these errors, so the numbers are corrected before such mistakes are tried.
            let has_numbers = judged.candidate().numeric().next().is_some();
            let residual = || judge.residual(judged.candidate());
            if has_numbers && residual().is_some_and(|residual| residual.is_at_edges) {
                let plain = plain(judge, judged.candidate());
                judged = judge.judged(&plain, &judge.middle).unwrap_or(judged);
            }
            if !self.completed.contains(&judged.candidate().mistakes) {
                match explained_with(judge, judged.candidate()) {
                    Some(explained) if !self.has_better(&explained, judged.cost) => {
                        self.explained = Some((judged.cost, explained));
                    }
                    None if !judge.work.is_cut() => {
                        self.completed.push(judged.candidate().mistakes.clone());
                    }
                    _ => {}
                }
            }
        }
        if self.nearest.as_ref().is_none_or(|one| judged.cost < one.0) {
            self.nearest = Some((judged.cost, judged.candidate().clone()));
        }
        Some(judged)
    }
}

/// Returns whether the program of a hypothesis intersects spheres by a wrong formula.
fn hits_spheres_wrongly(candidate: &Candidate) -> bool {
    candidate.behaviour.spheres != Spheres::Correct
}

/// Adds an extra area of one colour. Returns `None` if this does not explain the picture.
fn patched(judge: &Judge, from: &JudgedCandidate) -> Option<Candidate> {
    if !is_near(judge, from.candidate()) {
        return None;
    }
    let patched = from.candidate().with(patch(judge, from)?)?;
    explained_with(judge, &patched)
}

/// Returns whether a hypothesis is close to the student's picture: it has no mistakes, or leaves at
/// most a tenth ([`NEAR_RATIO`]) of the squared difference of a correct program.
fn is_near(judge: &Judge, candidate: &Candidate) -> bool {
    candidate.mistakes.is_empty() || left(judge, candidate).is_some_and(|left| left <= NEAR_RATIO)
}

/// Returns a hypothesis's squared difference from the student's picture, divided by that of a
/// correct program. Ignores what sampling can explain. Returns `None` if the budget of work is used
/// up.
fn left(judge: &Judge, candidate: &Candidate) -> Option<f64> {
    let all = match judge.square_of_correct.get() {
        Some(all) => *all,
        None => {
            let all = judge.square(&Candidate::correct(judge.scene))?;
            *judge
                .square_of_correct
                .get_or_init(|| all.max(f64::MIN_POSITIVE))
        }
    };
    Some(judge.square(candidate)? / all)
}

/// Removes mistakes from a hypothesis that explains the picture, as long as the remaining mistakes
/// explain it, too.
fn fewest(judge: &Judge, all: &Candidate) -> Candidate {
    let without = |candidate: &Candidate, at: usize| {
        let mut mistakes = candidate.mistakes.clone();
        mistakes.remove(at);
        Candidate::of(judge.scene, mistakes)
    };
    let mut fewest = all.clone();
    for left_out in (0..fewest.mistakes.len()).rev() {
        // Mistakes at edges are kept, because they are certain. A single mistake is kept even if a
        // correct program would explain the picture, because it was found by a more sensitive test.
        let is_sole = fewest.mistakes.len() == 1;
        if is_sole || fewest.mistakes.get(left_out).is_none_or(shows_at_edges) {
            continue;
        }
        let Some(fewer) = without(&fewest, left_out) else {
            continue;
        };
        // Without the removed mistake, other numbers may be better, so the numbers are fitted
        // again. The removed mistake may also have hidden a mistake at edges, so mistakes at edges
        // are tried again.
        let fitted = || {
            let (fitted, _) = judge.fit_all(&fewer, judge.fitting(&fewer), [0, ROUNDS])?;
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
        Mistake::Filter(_) | Mistake::Shift(_) => true,
        _ => false,
    }
}

/// Hypotheses, each with its difference from the picture on the coarsest grid.
type Rated = Vec<(f64, Candidate)>;

/// Extends a set of mistakes by further mistakes.
struct Extension<'a> {
    judge: &'a Judge<'a>,
    from: &'a JudgedCandidate,
    tiny: Level<'a>,
    suspects: Vec<usize>,
    /// Difference between the picture and the prediction of `from`, on the coarsest grid (`tiny`).
    /// Only extensions with a smaller difference are improvements.
    difference: f64,
}

impl<'a> Extension<'a> {
    /// Functions that extend a set of mistakes, one for each kind of mistakes, the fastest first.
    /// Each returns hypotheses with their differences from the picture on the coarsest grid.
    const KINDS: [fn(&Self) -> Rated; 3] = [Self::rows, Self::numbers, Self::joint];

    /// Prepares the extension of a set of mistakes. Returns `None` if the budget of work is used
    /// up.
    fn from(judge: &'a Judge, from: &'a JudgedCandidate) -> Option<Self> {
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

    /// Returns the extensions of one kind whose difference from the picture is less than that of
    /// the set itself. Each comes with its difference, multiplied by the penalties for its mistakes
    /// and parameters. They are sorted by this product.
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
        // The few samples of the coarsest grid cannot show where a checkerboard with small squares
        // ends. So single mistakes are also compared on the grid `coarse`, which is rendered
        // exactly. Its differences are scaled to be comparable with those of the coarsest grid.
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

/// Keeps only the best of several variants of one mistake, so that the variants do not fill the
/// beam. Hypotheses are variants if their last mistakes are rows of the table of mistakes with the
/// same identifier and object. The best one has the least difference from the picture.
fn best_of_each_id(rows: Rated) -> Rated {
    let mut known = BTreeSet::new();
    let mut best = least(rows.into_iter(), usize::MAX);
    best.retain(|(_, one)| match one.mistakes.last() {
        Some(Mistake::Row(row, object)) => known.insert((row.id, *object)),
        _ => true,
    });
    best
}

/// Multiplies a hypothesis's difference from the picture by the penalties [`MISTAKE_PENALTY`] and
/// [`NUMBER_PENALTY`].
fn penalised(difference: f64, candidate: &Candidate) -> f64 {
    let [mistakes, numbers] =
        [candidate.mistakes.len(), candidate.parameter_count()].map(|count| count as f64);
    difference * libm::pow(MISTAKE_PENALTY, mistakes) * libm::pow(NUMBER_PENALTY, numbers)
}
