//! An extra patch of one colour in a picture, which no object of the scene explains.

use glam::DVec2;

use super::{
    candidate::Mistake,
    judge::{Judge, Judged},
    light::is_near,
};

/// Fewer pixels than this are not taken for something too many.
const SMALLEST: usize = 4;

/// A piece is compact: it fills at least this part of its rectangle, and at most that of the
/// picture. Something that takes all of it in explains nothing.
const FILLED: f64 = 0.25;
const MOST: f64 = 0.2;

/// Something of one colour where the picture shows what the scene does not: the largest piece of
/// such pixels that hang together.
pub fn patch(judge: &Judge, from: &Judged) -> Option<Mistake> {
    let mut others = from.candidate().mistakes.iter();
    let has_one = others.any(|one| matches!(one, Mistake::Patch(..)));
    (!has_one).then_some(())?;
    let grid = &judge.fine.grid;
    let shown = judge.predicted(from.candidate(), &judge.fine)?;
    let (seen, strays) = (shown.seen, shown.strays().pixels);
    let pairs = seen.iter().zip(&shown.moments.mean);
    let mut is_left: Vec<bool> = pairs
        .map(|(seen, mean)| !is_near((*seen).into(), (*mean).into()))
        .collect();
    let mut largest: Vec<usize> = Vec::new();
    for start in strays {
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
    // What has a colour of the scene is rather something of it that is elsewhere.
    let scene = &from.candidate().scene;
    let objects = scene.objects.iter();
    let mut own = objects.flat_map(|object| object.shape.colors());
    let is_own = own.any(|color| is_near(color.to_linear(), light));
    let is_background = is_near(scene.image.background.to_linear(), light);
    (!is_own && !is_background).then_some(())?;
    let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for place in largest.iter().map(|&at| grid.middle(at)) {
        (least, most) = (least.min(place), most.max(place));
    }
    let rectangle = most - least + 1.0;
    let [own, all] = [rectangle.x * rectangle.y, grid.count() as f64];
    (largest.len() as f64 >= FILLED * own && own <= MOST * all).then_some(())?;
    let reach = f64::from(grid.factor);
    let area = [(least - reach).to_array(), (most + reach).to_array()];
    Some(Mistake::Patch(light, area))
}
