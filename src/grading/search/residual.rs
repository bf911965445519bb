//! What a hypothesis about the program leaves unexplained in the pixels of a picture.

use super::{judge::Judge, labels::labels};
use crate::grading::{
    hypotheses::Candidate,
    scoring::{Displacement, Prediction, Strays, work},
};

/// Number n such that one in n pixels may be wrong if the prediction is not exact, i.e. if it was
/// sampled or the picture is a JPEG. Chosen by trial on pictures with known mistakes.
const PIXELS_PER_MISS: usize = 4000;

/// Distance from an edge, in pixels, within which a wrong pixel is attributed to the edge. It
/// covers edges that are displaced by two pixels, and pixels up to five times too wide.
const EDGE_REACH: usize = 3;
/// Distance from an edge, in pixels, within which a wrong pixel of a JPEG is attributed to the
/// edge. It is the side of a JPEG's blocks.
const CODED_EDGE_REACH: usize = 8;
/// Number n such that one in n wrong pixels may lie far from all edges, while the others are still
/// attributed to edges. A wide pixel filter leaves weak traces far from an edge. Chosen by trial.
const PIXELS_PER_INSIDE: usize = 10;

/// Greatest displacement of all edges together that is ignored, in pixels. Rounded numbers in a
/// scene cause as much.
const IGNORED: f64 = 0.06;

/// Addition to the greatest displacement of all edges that is ignored ([`IGNORED`]), in pixels, if
/// each pixel has one sample in its middle. For n samples per pixel, an nth of it is added. Chosen
/// by trial.
const IGNORED_WITH_ONE_SAMPLE: f64 = 0.06;

/// Greatest displacement of the edges of a single object that is ignored, in pixels. The first
/// number holds without noise. The second is added with one sample per pixel; with n samples, it is
/// divided by √n. The third takes its place in a JPEG, most of whose noise is from coding. Samples
/// on a regular grid move an edge parallel to the grid by up to half of their distance.
const IGNORED_OF_OBJECT: [f64; 3] = [0.12, 0.5, 0.7];

/// Displacement of all edges of a JPEG, in pixels to the right or down, above which it is reported,
/// provided that it is significant (see `SURELY_MOVED`). JPEG coding hides most of a displacement.
/// Three samples at the same places in all pixels lie less than this off the middle.
const MOVED: f64 = 0.2;
/// Squared length of a displacement of a JPEG's edges, in squared standard deviations, above which
/// it is significant enough to be reported. Chosen by trial.
const SURELY_MOVED: f64 = 150.0;

impl Judge<'_> {
    /// Returns whether a hypothesis explains the picture: no pixel that should have one colour
    /// shows another one, and edges lie in their places and are as sharp as they should be.
    ///
    /// The middle grid is tested first because this costs less: if the prediction is exact, a cell
    /// that is certainly wrong contains a wrong pixel. Pixels of one colour follow, and edges come
    /// last.
    pub fn explains(&self, candidate: &Candidate) -> bool {
        let is_possible = !self.is_exact(candidate)
            || self
                .predicted(candidate, &self.middle)
                .is_some_and(|prediction| prediction.strays().are_no_more(0));
        let is_explained = || {
            let prediction = self.predicted(candidate, &self.fine)?;
            let strays = prediction.strays();
            let are_areas_right = strays.are_no_more(self.missed(candidate));
            Some(are_areas_right && Residual::of(self, candidate, &prediction, &strays).is_noise())
        };
        is_possible && is_explained() == Some(true)
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

/// What a hypothesis leaves unexplained in the pixels of a picture.
#[derive(Clone, Copy, Debug)]
pub struct Residual {
    /// Number of pixels that should show one colour and show another one.
    pub strays: usize,
    /// Whether areas of one colour are right, except for a few pixels that samples may miss, and
    /// errors in pixels that mix several colours look like noise.
    pub are_areas_right: bool,
    /// Whether almost all wrong pixels lie near edges.
    pub is_at_edges: bool,
    /// Whether errors in pixels that mix several colours look like sampling noise.
    pub is_noise_everywhere: bool,
    /// Displacement of edges; `None` if it may be chance. Tested only if the wrong pixels lie near
    /// edges.
    pub displacement: Option<Displacement>,
    /// Width of the pixel filter, in pixels; `None` if it may be 1. Tested only if the wrong pixels
    /// lie near edges.
    pub width: Option<f64>,
}

impl Residual {
    /// Computes what a hypothesis leaves unexplained. Returns `None` if the budget of work is used
    /// up.
    pub fn of_candidate(judge: &Judge, candidate: &Candidate) -> Option<Self> {
        let prediction = judge.predicted(candidate, &judge.fine)?;
        Some(Self::of(
            judge,
            candidate,
            &prediction,
            &prediction.strays(),
        ))
    }

    /// Computes what a prediction leaves unexplained. `strays` are the errors that no sampling can
    /// explain.
    fn of(judge: &Judge, candidate: &Candidate, prediction: &Prediction, strays: &Strays) -> Self {
        let level = &judge.fine;
        judge.work.spend(work::RESIDUAL * level.grid.count() as f64);
        let missed = judge.missed(candidate);
        let reach = level.jpeg.map_or(EDGE_REACH, |_| CODED_EDGE_REACH);
        let is_inside = |at: &&usize| {
            level
                .grid
                .around(**at, reach)
                .all(|at| prediction.is_flat(at))
        };
        let inside = strays.pixels.iter().filter(is_inside).count();
        let is_at_edges = inside <= missed + strays.pixels.len() / PIXELS_PER_INSIDE;
        let (displacement, width) = if is_at_edges {
            displacement_and_width(judge, candidate, prediction)
        } else {
            (None, None)
        };
        Self {
            strays: strays.pixels.len(),
            are_areas_right: strays.are_no_more(missed),
            is_at_edges,
            is_noise_everywhere: candidate.is_filtered() || prediction.is_noise_everywhere(),
            displacement,
            width,
        }
    }

    /// Returns whether sampling noise explains all errors.
    pub fn is_noise(&self) -> bool {
        self.are_areas_right
            && self.displacement.is_none()
            && self.width.is_none()
            && self.is_noise_everywhere
    }
}

/// Returns the displacement of the picture, or of the object that is displaced most, and the width
/// of the pixel filter. Each is `None` if chance or few samples may explain it.
fn displacement_and_width(
    judge: &Judge,
    candidate: &Candidate,
    prediction: &Prediction,
) -> (Option<Displacement>, Option<f64>) {
    let level = &judge.fine;
    let labels = labels(judge, candidate, candidate.layout, &level.grid);
    let background = judge.scene.objects.len();
    let groups: Vec<usize> = labels.iter().map(|one| one.unwrap_or(background)).collect();
    let share = match level.jpeg {
        // In a JPEG, the effect of coding on edges would otherwise be attributed to few samples.
        Some(_) => prediction.share(),
        None => {
            let score = prediction.score();
            score.samples.map_or(score.share, |n| 1.0 / n)
        }
    };
    let deviations = prediction.deviations();
    let beyond = |groups: &[usize], is_beyond: &dyn Fn(&Displacement) -> bool| {
        let all = prediction
            .displacements(&deviations, share, groups)
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
    // A wrong width is reported only once. After an effect on light, a pixel is no longer a mean of
    // light, so its width is unknown.
    let is_width_explained = candidate.is_filtered() || !candidate.keeps_light();
    let width = (!is_width_explained)
        .then(|| prediction.pixel_width(&deviations, share, level.jpeg.is_some()));
    (
        off.or_else(|| beyond(&groups, &|one| one.length > of_object)),
        width.flatten(),
    )
}
