//! Finds an extra patch in a picture, i.e. an area of one colour that no object of the scene
//! explains.

use glam::DVec2;

use super::judge::{Judge, JudgedCandidate};
use crate::grading::hypotheses::{Mistake, is_near};

/// Least number of pixels in a patch. Fewer may be noise.
const SMALLEST: usize = 4;

/// Least fraction of its bounding rectangle that a patch must fill, so that thin or scattered areas
/// do not count as patches.
const FILLED: f64 = 0.25;
/// Greatest fraction of the picture that a patch's bounding rectangle may cover. A larger patch
/// would explain almost anything.
const MOST: f64 = 0.2;

/// Finds the largest connected area of one colour that the hypothesis `from` does not explain.
/// Returns `None` if the area is too small, too thin or too large, if it has a colour of the scene,
/// or if the hypothesis has a patch already.
pub fn patch(judge: &Judge, from: &JudgedCandidate) -> Option<Mistake> {
    let mut others = from.candidate().mistakes.iter();
    if others.any(|one| matches!(one, Mistake::Patch(..))) {
        return None;
    }
    let grid = &judge.fine.grid;
    let prediction = judge.predicted(from.candidate(), &judge.fine)?;
    let (seen, unexplained_errors) = (prediction.observed, prediction.unexplained_errors().pixels);
    let pairs = seen.iter().zip(&prediction.moments.mean);
    let mut is_left: Vec<bool> = pairs
        .map(|(seen, mean)| !is_near((*seen).into(), (*mean).into()))
        .collect();
    let mut largest: Vec<usize> = Vec::new();
    for start in unexplained_errors {
        if !std::mem::replace(&mut is_left[start], false) {
            continue;
        }
        let mut piece = vec![start];
        let mut at = 0;
        while at < piece.len() {
            for next in grid.around(piece[at], 1) {
                let is_beside = [1, grid.width()].contains(&next.abs_diff(piece[at]));
                if is_beside && is_left[next] && is_near(seen[next].into(), seen[start].into()) {
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
    let light = seen[*largest.first()?].to_array();
    // An area with a colour of the scene does not count as a patch, because it is more likely an
    // object in a wrong position.
    let scene = &from.candidate().scene;
    let objects = scene.objects.iter();
    let colors = objects.flat_map(|object| object.shape.colors());
    let mut colors = colors.chain([scene.image.background]);
    if colors.any(|color| is_near(color.to_linear(), light)) {
        return None;
    }
    let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for place in largest.iter().map(|&at| grid.middle(at)) {
        (least, most) = (least.min(place), most.max(place));
    }
    let rectangle = most - least + 1.0;
    let [own, all] = [rectangle.x * rectangle.y, grid.count() as f64];
    if (largest.len() as f64) < FILLED * own || own > MOST * all {
        return None;
    }
    let reach = f64::from(grid.factor);
    let area = [(least - reach).to_array(), (most + reach).to_array()];
    Some(Mistake::Patch(light, area))
}
