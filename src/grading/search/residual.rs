//! What a candidate leaves unexplained on the pixels.

use super::{judge::Judge, labels::labels};
use crate::grading::{
    hypotheses::Candidate,
    scoring::{Displacement, Prediction, Strays, work},
};

/// Number of pixels of which one may show something that samples of a faulty program, or a JPEG, do
/// not. Chosen by trial on pictures with known mistakes.
const PIXELS_PER_MISS: usize = 4000;

/// Distance from an edge, in pixels, within which a displacement by two pixels, or pixels up to
/// five times as wide, show another colour.
const EDGE_REACH: usize = 3;
/// Distance from an edge, in pixels, within which a JPEG shows another colour: the side of its
/// blocks.
const CODED_EDGE_REACH: usize = 8;
/// Number of wrong pixels of which one may lie farther from edges: the wider the pixel filter, the
/// weaker its trace far from an edge. Chosen by trial.
const PIXELS_PER_INSIDE: usize = 10;

/// Greatest displacement of all edges, in pixels, that is ignored: rounded numbers cause as much.
const IGNORED: f64 = 0.06;

/// Additional displacement, in pixels, that is ignored with one sample in the middle of each pixel;
/// with n samples it is an nth. Chosen by trial.
const IGNORED_WITH_ONE_SAMPLE: f64 = 0.06;

/// Greatest displacement of a single object's edges that is ignored, in pixels: without noise, and
/// the addition with one sample in a pixel, of a plain picture and of a JPEG, most of whose noise
/// is from its coding. Samples of a regular grid move an edge that is parallel to the grid by up to
/// half of their distance.
const IGNORED_OF_OBJECT: [f64; 3] = [0.12, 0.5, 0.7];

/// Displacement of all edges of a JPEG, in pixels to the right or down, beyond which it is reported
/// if it is significant, too (`SURELY_MOVED`). Coding hides most of a displacement, and three
/// samples at the same places in all pixels lie less than this off the middle.
const MOVED: f64 = 0.2;
/// Significance (`Displacement::square`, in squared standard deviations of the fit) above which a
/// displacement of a JPEG's edges by more than `MOVED` is reported. Chosen by trial.
const SURELY_MOVED: f64 = 150.0;

impl Judge<'_> {
    /// Returns whether a candidate explains the picture: no pixel of one colour shows another, and
    /// edges lie where they should and are as sharp.
    ///
    /// The middle grid is tested first because it costs less: what is certainly wrong in one of its
    /// cells is wrong in a pixel, if the prediction is exact. Pixels of one colour follow, and
    /// edges come last.
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

    /// Returns the number of pixels of one colour that may show another: samples miss a square's
    /// corner here and there, and a JPEG is coded otherwise.
    fn missed(&self, candidate: &Candidate) -> usize {
        if self.is_exact(candidate) {
            0
        } else {
            self.fine.grid.count().div_ceil(PIXELS_PER_MISS)
        }
    }

    /// Returns whether the prediction is exact, which it is neither for sampled behaviour nor for a
    /// JPEG.
    fn is_exact(&self, candidate: &Candidate) -> bool {
        candidate.is_exact() && self.fine.jpeg.is_none()
    }
}

/// What a candidate leaves unexplained on the pixels.
#[derive(Clone, Copy, Debug)]
pub struct Residual {
    /// Number of pixels of one colour that show another.
    pub strays: usize,
    /// Whether the wrong pixels are no more than samples miss, and pixels of several colours look
    /// like noise.
    pub are_areas_right: bool,
    /// Whether the wrong pixels lie near edges.
    pub is_at_edges: bool,
    /// Whether errors in pixels of several colours look like sampling noise.
    pub is_noise_everywhere: bool,
    /// Displacement of edges, if it is not chance; tested only if the wrong pixels lie near edges.
    pub displacement: Option<Displacement>,
    /// Width of the pixel filter, if it is not a pixel's; tested only if the wrong pixels lie near
    /// edges.
    pub width: Option<f64>,
}

impl Residual {
    /// Computes the residual of a candidate. Returns `None` if its prediction is not known.
    pub fn of_candidate(judge: &Judge, candidate: &Candidate) -> Option<Self> {
        let prediction = judge.predicted(candidate, &judge.fine)?;
        Some(Self::of(
            judge,
            candidate,
            &prediction,
            &prediction.strays(),
        ))
    }

    /// Computes the residual of a prediction with these strays.
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

    /// Returns whether the residual is sampling noise.
    pub fn is_noise(&self) -> bool {
        self.are_areas_right
            && self.displacement.is_none()
            && self.width.is_none()
            && self.is_noise_everywhere
    }
}

/// Returns the displacement of the picture, or of the object that is displaced most, unless chance
/// or few samples explain it; and the width of the pixel filter, unless it is a pixel's.
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
        // The coding's effect on an edge would be attributed to few samples.
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
    // A width is reported once; and after an effect on light a pixel is no mean of light.
    let is_width_explained = candidate.is_filtered() || !candidate.keeps_light();
    let width = (!is_width_explained)
        .then(|| prediction.pixel_width(&deviations, share, level.jpeg.is_some()));
    (
        off.or_else(|| beyond(&groups, &|one| one.length > of_object)),
        width.flatten(),
    )
}
