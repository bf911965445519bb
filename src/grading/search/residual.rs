//! What a hypothesis about the program leaves unexplained in the pixels of a picture.

use std::sync::Arc;

use super::judge::{Judge, Residual};
use crate::grading::{
    hypotheses::{Candidate, Mistake},
    scoring::{Displacement, Prediction, work},
};

/// Divisor of the number of pixels: up to 1/4000 of the pixels may be wrong although a hypothesis
/// is correct. It is used if the prediction is not exact, i.e. if it was sampled or the picture is
/// a JPEG. Chosen by trial on pictures with known mistakes.
const PIXELS_PER_MISS: usize = 4000;

/// Distance from an edge, in pixels, within which a wrong pixel is attributed to the edge. It
/// covers edges that are displaced by two pixels, and pixels up to five times too wide.
const EDGE_REACH: usize = 3;
/// Distance from an edge, in pixels, within which a wrong pixel of a JPEG is attributed to the
/// edge. It is the side of a JPEG's blocks.
const CODED_EDGE_REACH: usize = 8;
/// Divisor of the number of wrong pixels: errors are attributed to edges if at most 1/10 of the
/// wrong pixels lie far from all edges. A few such pixels are allowed, because a wide pixel filter
/// changes pixels slightly even far from an edge. Chosen by trial.
const PIXELS_PER_INSIDE: usize = 10;

/// Reciprocal of the fraction of a picture's pixels, 1/50 or 2 %, that may be wrong before mistakes
/// that are weakly visible everywhere are tried, even if the wrong pixels do not lie at edges. With
/// a smaller number, such mistakes would be overlooked in more pictures.
const MUCH_WRONG: usize = 50;

/// Number of wrong cells of the grid `middle` that may lie away from all edges before a hypothesis
/// is rejected without a look at its pixels. Fitted numbers that are not quite right yet may leave
/// a few. With a larger number, the pixels of more hypotheses are rendered.
const FEW_INSIDE: usize = 10;

/// Greatest displacement of all edges together that is ignored if each pixel has very many samples,
/// in pixels. Rounded numbers in a scene may displace edges this far.
const IGNORED: f64 = 0.06;

/// Amount that is added to [`IGNORED`] if each pixel has one sample, in pixels. For n samples per
/// pixel, it is divided by n. Chosen by trial.
const IGNORED_WITH_ONE_SAMPLE: f64 = 0.06;

/// Coefficients a, b and c of a limit in pixels. If the edges of a single object are displaced by
/// less than the limit, this is ignored. For n samples per pixel, the limit is a + b/√n, or a +
/// c/√n in a JPEG, because coding adds noise. Samples on a regular grid are 1/√n apart, so they may
/// displace an edge parallel to the grid by up to 0.5/√n.
const IGNORED_OF_OBJECT: [f64; 3] = [0.12, 0.5, 0.7];

/// Displacement of all edges of a JPEG, in pixels along a row or a column, above which it is
/// reported if it is also significant (see `SURELY_MOVED`). Coding hides most of a displacement, so
/// the value is small. It is greater than 1/6, because the mean of three samples at the same places
/// in all pixels may lie 1/6 pixel off the middle.
const MOVED: f64 = 0.2;
/// Squared length of a displacement of a JPEG's edges, in squared standard deviations, above which
/// it is significant enough to be reported. Chosen by trial.
const SURELY_MOVED: f64 = 150.0;

/// Number of hypotheses whose residuals are remembered. The search needs the residual of a
/// hypothesis several times, with few other hypotheses in between.
const RESIDUALS: usize = 4;

impl Judge<'_> {
    /// Returns whether a hypothesis explains the picture: no pixel that should have one colour
    /// shows another one, and edges lie in their places and are as sharp as they should be.
    ///
    /// The grid `middle` is tested first, because this is faster than testing single pixels. A
    /// wrong cell contains at least one wrong pixel, so the test of the pixels can then be skipped.
    /// JPEG coding is predicted only for single pixels, so the grid does not decide about a JPEG.
    pub fn explains(&self, candidate: &Candidate) -> bool {
        let is_possible = self.middle.jpeg.is_some()
            || self
                .predicted(candidate, &self.middle)
                .is_some_and(|it| it.strays().are_no_more(self.missed(candidate)));
        is_possible
            && self
                .residual(candidate)
                .is_some_and(|residual| residual.is_noise())
    }

    /// Returns what a hypothesis leaves unexplained. Remembers it for the last few hypotheses.
    /// Returns `None` if the budget of work is used up.
    pub fn residual(&self, candidate: &Candidate) -> Option<Residual> {
        let mut known = self.residuals.borrow_mut();
        let is_same = |(mistakes, _): &(Vec<Mistake>, Residual)| *mistakes == candidate.mistakes;
        if let Some((_, residual)) = known.iter().find(|one| is_same(one)) {
            return Some(*residual);
        }
        if let Some(residual) = self.far_from_edges(candidate) {
            return Some(residual);
        }
        let rendering = self.fine.render(candidate, &self.work)?;
        if let Some(central) = &self.central {
            central.compare_with(Arc::new(rendering.cropped(&central.grid)));
        }
        let residual = residual_of(self, candidate, &self.fine.predict(&rendering));
        if known.len() == RESIDUALS {
            known.pop_front();
        }
        known.push_back((candidate.mistakes.clone(), residual));
        Some(residual)
    }

    /// Returns what a hypothesis leaves unexplained if most wrong cells of the grid `middle` lie
    /// away from all edges, and they are more than a few. The pixels need not be rendered then.
    /// JPEG coding changes single pixels, so a JPEG's pixels are always tested.
    fn far_from_edges(&self, candidate: &Candidate) -> Option<Residual> {
        let grid = &self.middle.grid;
        let prediction = self.predicted(candidate, &self.middle)?;
        let strays = prediction.strays().pixels;
        let is_inside = |at: &&usize| grid.around(**at, 1).all(|at| prediction.is_flat(at));
        let inside = strays.iter().filter(is_inside).count();
        let is_far = 2 * inside > strays.len() && inside > FEW_INSIDE + self.missed(candidate);
        (is_far && self.fine.jpeg.is_none()).then_some(Residual {
            are_areas_right: false,
            is_at_edges: false,
            is_much_wrong: strays.len() * MUCH_WRONG > grid.count(),
            is_noise_everywhere: true,
            displacement: None,
            width: None,
        })
    }

    /// Returns how many pixels that should have one colour may show another one. Samples may miss
    /// the corner of an object, and JPEG coding may change a pixel more than predicted.
    fn missed(&self, candidate: &Candidate) -> usize {
        if self.is_exact(candidate) {
            0
        } else {
            self.fine.grid.count().div_ceil(PIXELS_PER_MISS)
        }
    }

    /// Returns whether the prediction of a hypothesis is exact: it is not sampled, and the picture
    /// is no JPEG.
    fn is_exact(&self, candidate: &Candidate) -> bool {
        candidate.is_exact() && self.fine.jpeg.is_none()
    }
}

/// Computes what the prediction of a hypothesis leaves unexplained.
fn residual_of(judge: &Judge, candidate: &Candidate, prediction: &Prediction) -> Residual {
    let (level, strays) = (&judge.fine, prediction.strays());
    judge.work.spend(work::RESIDUAL * level.grid.count() as f64);
    let missed = judge.missed(candidate);
    let reach = level.jpeg.map_or(EDGE_REACH, |_| CODED_EDGE_REACH);
    let grid = &level.grid;
    let is_inside = |at: &&usize| grid.around(**at, reach).all(|at| prediction.is_flat(at));
    let inside = strays.pixels.iter().filter(is_inside).count();
    let is_at_edges = inside <= missed + strays.pixels.len() / PIXELS_PER_INSIDE;
    // Edges are tested only if almost all wrong pixels lie near them. Other wrong pixels show that
    // whole areas are wrong.
    let (displacement, width, is_tinted) = if is_at_edges {
        let labels = judge.labels(candidate, candidate.layout, &level.grid);
        let background = judge.scene.objects.len();
        let groups: Vec<usize> = labels.iter().map(|one| one.unwrap_or(background)).collect();
        let (displacement, width) = displacement_and_width(judge, candidate, prediction, &groups);
        let is_tinted = level.jpeg.is_some() && prediction.is_tinted(&groups);
        (displacement, width, is_tinted)
    } else {
        (None, None, false)
    };
    Residual {
        are_areas_right: strays.are_no_more(missed) && !is_tinted,
        is_at_edges,
        is_much_wrong: strays.pixels.len() * MUCH_WRONG > grid.count(),
        is_noise_everywhere: candidate.is_filtered() || prediction.is_noise_everywhere(),
        displacement,
        width,
    }
}

/// Returns the displacement of the picture, or of the object that is displaced most, and the width
/// of the pixel filter. Each is `None` if chance or few samples may explain it. `groups` contains
/// the index of the object that is seen in each pixel.
fn displacement_and_width(
    judge: &Judge,
    candidate: &Candidate,
    prediction: &Prediction,
    groups: &[usize],
) -> (Option<Displacement>, Option<f64>) {
    let level = &judge.fine;
    let share = match level.jpeg {
        // `share` is the variance of a pixel's error, divided by that of one sample. In a JPEG, it
        // is not derived from the number of samples in the score: coding also changes edges, which
        // would look like fewer samples.
        Some(_) => prediction.share(),
        None => {
            let score = prediction.score();
            score.samples.map_or(score.share, |n| 1.0 / n)
        }
    };
    let deviations = prediction.deviations();
    let beyond = |groups: &[usize], is_beyond: &dyn Fn(&Displacement) -> bool| {
        let all = prediction
            .displacements(&deviations, share, groups, level.jpeg.is_some())
            .into_iter();
        let all = all.flatten().filter(is_beyond);
        all.max_by(|one, other| one.length.total_cmp(&other.length))
    };
    let is_moved = |one: &Displacement| {
        let by = f64::max(one.by[0].abs(), one.by[1].abs());
        level.jpeg.is_some() && by > MOVED && one.square > SURELY_MOVED
    };
    let of_all = IGNORED + IGNORED_WITH_ONE_SAMPLE * share;
    let off = beyond(&vec![0; groups.len()], &|one| {
        one.length > of_all || is_moved(one)
    });
    let [none, of_one, of_coded] = IGNORED_OF_OBJECT;
    let more = level.jpeg.map_or(of_one, |_| of_coded);
    let of_object = none + more * share.sqrt();
    // The pixel width is not estimated if the hypothesis already contains a wrong width. It is not
    // estimated either if an effect on light does not keep means, because the pixels at edges then
    // depend on this effect as well as on the width.
    let is_width_explained = candidate.is_filtered() || !candidate.keeps_light();
    let width = (!is_width_explained)
        .then(|| prediction.pixel_width(&deviations, share, level.jpeg.is_some()));
    (
        off.or_else(|| beyond(groups, &|one| one.length > of_object)),
        width.flatten(),
    )
}
