//! What can be summed at once of a polygon on the board, and the rest.

use glam::DVec2;

use super::board::{Board, form};
use super::cutter::{Chord, Cutter, Tally};

/// What much of a polygon between two lines of the board is summed as, at once.
pub(super) trait Bulk {
    /// The part of it that can be.
    fn smooth(&self) -> [f64; 2];
    /// Adds its part between two lines, which is `piece`.
    fn add(&self, ends: [f64; 2], piece: &[DVec2], tally: &mut Tally);
}

/// Where vertices lie along an axis of the board, in order, and how uncertain that is.
pub(super) fn vertices(board: &Board, axis: usize, points: &[DVec2]) -> Vec<(f64, f64)> {
    // Far away a vertex is uncertain by more than a square, and which side a line there crosses.
    let vertex = |&at: &DVec2| board.place(axis, at, form(&board.below, at));
    let mut ends: Vec<(f64, f64)> = points.iter().map(vertex).collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    ends
}

/// The two sides between two lines of an axis of the board, of which the latter counts more squares, each from line to line; and whether
/// places along the lines grow (1) or fall (−1) from the first side to the second.
///
/// That is told by points of the picture: in the widest of views rows are so narrow that in coordinates of the floor it is a matter of
/// roundings, even which end of one line is on the same side as which end of the other.
pub(super) fn sides(
    board: &Board,
    axis: usize,
    [from, to]: &[Chord; 2],
) -> Option<([[DVec2; 2]; 2], f64)> {
    let (from, to) = ((*from)?, (*to)?);
    let middle = |[s, t]: [DVec2; 2]| 0.5 * (s + t);
    let onwards = middle(to) - middle(from);
    // Both lines run so that the way from one to the other is on their left.
    let ends = |[s, t]: [DVec2; 2]| match (t - s).perp_dot(onwards) >= 0.0 {
        true => [s, t],
        false => [t, s],
    };
    let ([a, b], [c, d]) = (ends(from), ends(to));
    // Where nothing is mirrored, that is a quarter turn from the second axis back to the first.
    let ahead = if axis == 1 { 1.0 } else { -1.0 };
    Some(([[a, c], [b, d]], ahead * board.fine.floor.handed))
}

/// Adds the polygon with which a cutter has begun: in bulk what lies between two vertices with more than `least` lines
/// between them, and the rest by another way.
///
/// Between two vertices it is bounded by one side above and by one below.
pub(super) fn in_bulk<B: Bulk>(
    cutter: &mut Cutter,
    vertices: &[(f64, f64)],
    least: f64,
    bulk: impl Fn([f64; 2], &[Chord; 2]) -> Option<B>,
    mut add_rest: impl FnMut(&[DVec2], &mut Tally),
    tally: &mut Tally,
) {
    for ends in vertices.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let first = (from.0 + from.1).ceil();
        let last = (to.0 - to.1).floor();
        let are_many = last - first > least;
        if !are_many {
            continue;
        }
        cutter.cut(first, tally);
        add_rest(&cutter.piece, tally);
        cutter.cut(last, tally);
        let Some(bulk) = bulk([first, last], &cutter.chords) else {
            add_rest(&cutter.piece, tally);
            continue;
        };
        let [first, last] = bulk.smooth();
        let are_many = last - first > least;
        if !are_many {
            add_rest(&cutter.piece, tally);
            continue;
        }
        let mut parts = cutter.again();
        parts.cut(first, tally);
        add_rest(&parts.piece, tally);
        parts.cut(last, tally);
        bulk.add([first, last], &parts.piece, tally);
        add_rest(&parts.rest, tally);
    }
    add_rest(&cutter.rest, tally);
}
