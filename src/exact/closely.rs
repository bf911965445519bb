//! The board's integral over a polygon from forms in double-double: for what roundings of `f64` would leave in doubt.
//!
//! What is far, up to the horizon, is summed along its boundary as in `edge`, whose terms are as good as its corners are; what is near, line by
//! line (`finely`). A narrow view needs that, whose pixels are so far away that neighbouring squares differ by less than a rounding of where
//! they are.

use std::{array, sync::atomic::AtomicBool};

use glam::DVec2;

use super::{
    board::{Board, Corner, DEEP, Sum, normalized, size},
    cells,
    cutter::split,
    displaced::displacements,
    edge, finely,
    floor::Fine,
};
use crate::math::{Double, Real};

/// What is further away than so many squares is summed along its boundary: there all terms of the series, of which `board` is content with
/// fewer, neglect less than roundings do.
const FARTHER: f64 = 24.0;

/// The integral, positive where squares are however the polygon is oriented; `None` where too many lines are near, or places cannot be told.
pub(super) fn sum(board: &Board, polygon: &[DVec2]) -> Option<Sum> {
    let sum = near_and_far(board, polygon);
    if let Some(sum) = sum.filter(|sum| sum.bound <= board.care.enough(polygon)) {
        return Some(sum);
    }
    // Of few squares not too far away series leave more than lines do.
    let lines = finely::sum(board, polygon);
    let sums = [sum, lines].into_iter().flatten();
    sums.min_by(|one, other| one.bound.total_cmp(&other.bound))
}

/// The same of a crowd of squares, and of the horizon. Where there are too many near lines as well, near squares are summed as rounded forms
/// have them: those displace them less.
pub(super) fn of_crowd(board: &Board, polygon: &[DVec2], cancel: &AtomicBool) -> Option<Sum> {
    parts(board, polygon, |closer, near| {
        let [p, q] = closer.floor.slope;
        let by_squares = || Some(cells::sum(board, &board.visible(near), cancel));
        finely::sum(closer, near).or_else(|| match FARTHER * (p.abs() + q.abs()) <= DEEP {
            true => by_squares(),
            false => None,
        })
    })
}

fn near_and_far(board: &Board, polygon: &[DVec2]) -> Option<Sum> {
    parts(board, polygon, finely::sum)
}

/// What is near, by a function of it, and what is far.
fn parts(
    board: &Board,
    polygon: &[DVec2],
    sum_near: impl Fn(&Board, &[DVec2]) -> Option<Sum>,
) -> Option<Sum> {
    if board.fine.nudge > 0.0 {
        return None;
    }
    let board = closer(board);
    let [p, q] = board.floor.slope;
    let mut line = board.below;
    line[2] -= 1.0 / (FARTHER * (p.abs() + q.abs()));
    let (mut far, mut near) = (Vec::new(), Vec::new());
    split(polygon, &line, &mut far, &mut near);
    let mut sum = Sum::default();
    let corners = visible(&board, &far);
    if corners.len() > 2 {
        sum.add(edge::sum(&board, &corners, None));
        // Next to the horizon corners are said to be on it, which displaces them once more.
        sum.bound += board.blurred(corners.iter().map(|corner| corner.at));
    }
    if near.len() > 2 {
        sum.add(sum_near(&board, &near)?);
    }
    Some(sum)
}

/// The board as it is where corners are told by its fine forms.
fn closer(board: &Board) -> Board {
    let [of_a, of_b] = board.across.map(|form| normalized(form).1);
    let (fine, inverse) = Fine::new(board.fine.forms, board.fine.rads, [of_a, of_b]);
    let scales = [of_a, of_b, 0];
    // With a rounding more than in `f64`: the factors themselves are rounded.
    let errors = array::from_fn(|i| {
        let form = fine.forms[i].map(|factor| factor.hi);
        let error = fine.rads[i] + 5.0 * Double::UNIT * size(&form);
        libm::ldexp(error, -scales[i])
    });
    let steepness = libm::hypot(board.below[0], board.below[1]);
    let (displacement, upwards) = displacements(&errors, &inverse, steepness);
    Board {
        floor: fine.floor.clone(),
        fine,
        horizon_off: errors[2],
        displacement,
        upwards,
        ..board.clone()
    }
}

/// The corners of the part of a convex polygon that is not beyond the horizon.
fn visible(board: &Board, polygon: &[DVec2]) -> Vec<Corner> {
    let values = |at: DVec2| {
        let [x, y] = [at.x, at.y].map(Double::from_f64);
        let value = |[a, b, c]: &[Double; 3]| a.times(&x).plus(&b.times(&y)).plus(c);
        board.fine.forms.each_ref().map(value)
    };
    let mut corners = Vec::with_capacity(polygon.len() + 2);
    let Some(&last) = polygon.last() else {
        return corners;
    };
    let mut before = (last, values(last));
    for &at in polygon {
        let here = values(at);
        let [from, to] = [before.1[2], here[2]];
        if (from.hi < 0.0 && to.hi > 0.0) || (from.hi > 0.0 && to.hi < 0.0) {
            let t = from.over(&from.minus(&to));
            let between = |i: usize| before.1[i].plus(&here[i].minus(&before.1[i]).times(&t));
            let point = before.0 + (at - before.0) * t.hi;
            let level = Double::from_f64(0.0);
            corners.push(corner(board, point, [between(0), between(1), level]));
        }
        if !to.is_negative() {
            corners.push(corner(board, at, here));
        }
        before = (at, here);
    }
    corners
}

/// The corner at a point where forms have such values.
fn corner(board: &Board, at: DVec2, [a, b, level]: [Double; 3]) -> Corner {
    let is_endless = level.hi <= board.horizon_off;
    let places = match is_endless {
        true => [a, b],
        false => [a, b].map(|n| n.over(&level)),
    };
    Corner {
        at,
        floor: places.map(|place| place.hi),
        low: places.map(|place| place.lo),
        depth: if is_endless {
            f64::INFINITY
        } else {
            1.0 / level.hi
        },
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exact::{care::FINE, polygon::PIXEL};

    /// What a level camera sees that is so many squares above the board, of so many pixels of focal length, in a pixel so far below the
    /// horizon.
    fn board(degrees: f64, height: f64, focal: f64, down: f64) -> Board {
        let (sin, cos) = (
            libm::sin(degrees.to_radians()),
            libm::cos(degrees.to_radians()),
        );
        let steep = 1.0 / (focal * height);
        let below = [0.0, steep, down * steep];
        let across = [[-sin / focal, 0.0, cos], [cos / focal, 0.0, sin]];
        // Squares are counted from a pair of them that the pixel sees, as they are in pictures.
        let across = across.map(|[x, y, one]| {
            let seen = 2.0 * (0.5 * one / below[2]).round();
            [x, y - seen * below[1], one - seen * below[2]]
        });
        Board::new(across, below)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn along_the_boundary_it_is_what_lines_one_by_one_give(
            degrees in 0.0..360.0_f64,
            height in 1.0..10.0_f64,
            focal in 20.0..800.0_f64,
            deepest in 40.0..400.0_f64,
        ) {
            // The upper side of the pixel sees what is so deep.
            let down = 0.5 + focal * height / deepest;
            let board = board(degrees, height, focal, down);
            for polygon in [&PIXEL[..], &PIXEL[1..]] {
                let lines = finely::sum(&board, polygon);
                prop_assume!(lines.is_some());
                let lines = lines.unwrap_or_default();
                let both = near_and_far(&board, polygon).unwrap_or_default();
                let off = (both.value - lines.value).abs();
                prop_assert!(both.bound > 0.0 && both.bound <= FINE, "{both:?}");
                prop_assert!(lines.bound <= 1e-15, "{lines:?}");
                prop_assert!(off <= both.bound + lines.bound, "{both:?}, not {lines:?}");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        /// In wide views rounded corners tell as much, if the near part is left to lines one by one; the latter say nothing of the whole.
        #[test]
        fn up_to_the_horizon_it_is_what_rounded_corners_give(
            degrees in 0.0..360.0_f64,
            height in 1.0..10.0_f64,
            focal in 20.0..800.0_f64,
            down in -0.45..0.45_f64,
        ) {
            let board = board(degrees, height, focal, down);
            prop_assert!(finely::sum(&board, &PIXEL).is_none());
            for polygon in [&PIXEL[..], &PIXEL[1..]] {
                let rounded = board.over(polygon, &AtomicBool::new(false));
                let close = of_crowd(&board, polygon, &AtomicBool::new(false)).unwrap_or_default();
                let off = (close.value - rounded.value).abs();
                prop_assert!(close.bound > 0.0 && close.bound <= 4e-9, "{close:?}");
                prop_assert!(off <= close.bound + rounded.bound, "{close:?}, not {rounded:?}");
            }
        }
    }
}
