//! Computes what a hypothesis about the program leaves unexplained in the pixels of a picture.

use std::sync::Arc;

use super::judge::{Judge, Residual};
use crate::grading::{
    hypotheses::{Candidate, Mistake},
    scoring::{Displacement, Prediction, work},
};

/// Reciprocal of the fraction of pixels that may be wrong although a hypothesis is correct: 1/4000.
/// The fraction is 0 if the prediction is exact, i.e. if it was not sampled and the picture is no
/// JPEG. Chosen by trial on pictures with known mistakes.
const PIXELS_PER_MISS: usize = 4000;

/// Distance from an edge, in pixels, within which a wrong pixel is attributed to the edge. Edges
/// that are displaced by two pixels, and pixels up to five times too wide, cause errors within this
/// distance.
const EDGE_REACH: usize = 3;
/// Distance from an edge, in pixels, within which a wrong pixel of a JPEG is attributed to the
/// edge. It is the side of a JPEG's blocks.
const CODED_EDGE_REACH: usize = 8;
/// Reciprocal of a fraction of the wrong pixels, 1/10. If at most this fraction lies far from all
/// edges, all errors are attributed to edges. A few pixels far from edges are allowed, because a
/// wide pixel filter changes them slightly. Chosen by trial.
const PIXELS_PER_INSIDE: usize = 10;

/// Reciprocal of a fraction of the pixels, 1/50. If a greater fraction is wrong, mistakes that are
/// weakly visible everywhere are tried even if the wrong pixels do not lie at edges. With a smaller
/// number, such mistakes would be overlooked in more pictures.
const MUCH_WRONG: usize = 50;

/// Maximum number of wrong cells of the grid `middle` that may lie away from all edges. If there
/// are more, a hypothesis is rejected without rendering its pixels. A few are allowed, because
/// numbers that are not yet fitted well may cause them. With a larger number, the pixels of more
/// hypotheses are rendered.
const FEW_INSIDE: usize = 10;

/// Greatest displacement of all edges together, in pixels, that is ignored if each pixel has very
/// many samples. Rounded numbers in a scene may displace edges by this distance.
const IGNORED: f64 = 0.06;

/// Amount, in pixels, that is added to [`IGNORED`] if each pixel has one sample. For n samples per
/// pixel, it is divided by n. Chosen by trial.
const IGNORED_WITH_ONE_SAMPLE: f64 = 0.06;

/// Coefficients a, b and c of a limit in pixels. A displacement of a single object's edges by less
/// than the limit is ignored. For n samples per pixel, the limit is a + b/√n. In a JPEG, it is a +
/// c/√n, because coding adds noise. Samples on a regular grid are 1/√n apart, so an edge parallel
/// to the grid may seem displaced by up to 0.5/√n.
const IGNORED_OF_OBJECT: [f64; 3] = [0.12, 0.5, 0.7];

/// Threshold for a displacement of all edges of a JPEG, in pixels along a row or a column. A
/// greater displacement is reported if it is also significant ([`SURELY_MOVED`]). JPEG coding hides
/// most of a displacement, so the threshold is low. It is greater than 1/6, because three sample
/// positions that all pixels share may have a mean that is 1/6 pixel from the middle.
const MOVED: f64 = 0.2;
/// Threshold for the squared length of a displacement of a JPEG's edges, in squared standard
/// deviations. A displacement with a greater squared length is significant. Chosen by trial.
const SURELY_MOVED: f64 = 150.0;

/// Number of hypotheses whose residuals are remembered. The search needs the residual of a
/// hypothesis several times, with few other hypotheses in between.
const RESIDUALS: usize = 4;

impl Judge<'_> {
    /// Returns whether a hypothesis explains the picture. It does if all pixels that should have
    /// one colour show this colour, and if edges have the right position and sharpness.
    ///
    /// The cells of the grid `middle` are tested first, because this is faster than testing single
    /// pixels. A wrong cell contains at least one wrong pixel, so if cells are wrong, the pixels
    /// need not be tested. For a JPEG, only pixels are tested, because JPEG coding is predicted
    /// only for pixels.
    pub fn explains(&self, candidate: &Candidate) -> bool {
        let is_possible = self.middle.jpeg.is_some()
            || self
                .predicted(candidate, &self.middle)
                .is_some_and(|it| it.unexplained_errors().are_no_more(self.missed(candidate)));
        is_possible
            && self
                .residual(candidate)
                .is_some_and(|residual| residual.is_noise())
    }

    /// Returns what a hypothesis leaves unexplained. Results for the last few hypotheses are
    /// remembered. Returns `None` if the budget of work is used up.
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

    /// Returns what a hypothesis leaves unexplained if this can be seen without rendering its
    /// pixels: on the grid `middle`, most wrong cells lie away from all edges, and they are more
    /// than a few ([`FEW_INSIDE`]). Returns `None` otherwise, and for a JPEG, because JPEG coding
    /// is predicted only for pixels.
    fn far_from_edges(&self, candidate: &Candidate) -> Option<Residual> {
        let grid = &self.middle.grid;
        let prediction = self.predicted(candidate, &self.middle)?;
        let unexplained_errors = prediction.unexplained_errors().pixels;
        let is_inside = |at: &&usize| grid.around(**at, 1).all(|at| prediction.is_flat(at));
        let inside = unexplained_errors.iter().filter(is_inside).count();
        let is_far =
            2 * inside > unexplained_errors.len() && inside > FEW_INSIDE + self.missed(candidate);
        (is_far && self.fine.jpeg.is_none()).then_some(Residual {
            are_areas_right: false,
            is_at_edges: false,
            is_much_wrong: unexplained_errors.len() * MUCH_WRONG > grid.count(),
            is_noise_everywhere: true,
            displacement: None,
            width: None,
        })
    }

    /// Returns how many pixels that should have one colour may be wrong although the hypothesis is
    /// correct. Samples may miss the corner of an object, and JPEG coding may change a pixel more
    /// than predicted.
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

/// Computes what the hypothesis `candidate` leaves unexplained. `prediction` is its prediction of
/// all pixels.
fn residual_of(judge: &Judge, candidate: &Candidate, prediction: &Prediction) -> Residual {
    let (level, unexplained_errors) = (&judge.fine, prediction.unexplained_errors());
    judge.work.spend(work::RESIDUAL * level.grid.count() as f64);
    let missed = judge.missed(candidate);
    let reach = level.jpeg.map_or(EDGE_REACH, |_| CODED_EDGE_REACH);
    let grid = &level.grid;
    let is_inside = |at: &&usize| grid.around(**at, reach).all(|at| prediction.is_flat(at));
    let inside = unexplained_errors.pixels.iter().filter(is_inside).count();
    let is_at_edges = inside <= missed + unexplained_errors.pixels.len() / PIXELS_PER_INSIDE;
    // Edges are tested only if almost all wrong pixels lie near them. If many lie elsewhere, whole
    // areas are wrong.
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
        are_areas_right: unexplained_errors.are_no_more(missed) && !is_tinted,
        is_at_edges,
        is_much_wrong: unexplained_errors.pixels.len() * MUCH_WRONG > grid.count(),
        is_noise_everywhere: candidate.is_filtered() || prediction.is_noise_everywhere(),
        displacement,
        width,
    }
}

/// Returns the displacement of all edges or, if this may be chance, of the most displaced object.
/// Also returns the width of the pixel filter. Each result is `None` if chance or few samples may
/// explain it. `groups` contains for each pixel the index of the object that is seen there.
fn displacement_and_width(
    judge: &Judge,
    candidate: &Candidate,
    prediction: &Prediction,
    groups: &[usize],
) -> (Option<Displacement>, Option<f64>) {
    let level = &judge.fine;
    let relative_variance = match level.jpeg {
        // The variance of a pixel's error, divided by that of one sample. For a JPEG, it is
        // computed in another way, because coding changes edges as if there were fewer samples.
        Some(_) => prediction.relative_variance(),
        None => {
            let score = prediction.score();
            score.samples.map_or(score.relative_variance, |n| 1.0 / n)
        }
    };
    let deviations = prediction.deviations();
    let beyond = |groups: &[usize], is_beyond: &dyn Fn(&Displacement) -> bool| {
        let all = prediction
            .displacements(&deviations, relative_variance, groups, level.jpeg.is_some())
            .into_iter();
        let all = all.flatten().filter(is_beyond);
        all.max_by(|one, other| one.length.total_cmp(&other.length))
    };
    let is_moved = |one: &Displacement| {
        let by = f64::max(one.by[0].abs(), one.by[1].abs());
        level.jpeg.is_some() && by > MOVED && one.square > SURELY_MOVED
    };
    let of_all = IGNORED + IGNORED_WITH_ONE_SAMPLE * relative_variance;
    let off = beyond(&vec![0; groups.len()], &|one| {
        one.length > of_all || is_moved(one)
    });
    let [none, of_one, of_coded] = IGNORED_OF_OBJECT;
    let more = level.jpeg.map_or(of_one, |_| of_coded);
    let of_object = none + more * relative_variance.sqrt();
    // The pixel width is not estimated in two cases: if the hypothesis already contains a wrong
    // width, or if an effect on light does not keep means. In the second case, pixels at edges
    // depend both on this effect and on the width.
    let is_width_explained = candidate.is_filtered() || !candidate.keeps_light();
    let width = (!is_width_explained)
        .then(|| prediction.pixel_width(&deviations, relative_variance, level.jpeg.is_some()));
    (
        off.or_else(|| beyond(groups, &|one| one.length > of_object)),
        width.flatten(),
    )
}
