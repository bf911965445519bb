//! The scene nearest to a picture, among those that a few numbers make.
//!
//! Exact pictures are smooth functions of the scene, without any noise of samples, so that the method of Gauss and Newton works: a few
//! pictures beside the current one give the slopes, and the linear problem's solution the next point.

use super::{Make, level::Level};
use crate::{
    film::{Film, rmse},
    render::{Control, RenderError},
};

/// So many steps are taken at most.
const STEPS: usize = 8;

/// A step that brings less than this share ends the search.
const GAIN: f64 = 1e-3;

/// Finds the numbers from a start on; `widths` are steps that move the picture by a part of a pixel. `make` is of mistakes in the whole
/// picture's size. Nothing, if no step from the start is downhill.
pub fn fit(
    level: &Level,
    control: &Control,
    start: &[f64],
    widths: &[f64],
    make: &dyn Fn(&[f64]) -> Option<Make>,
) -> Result<Option<Vec<f64>>, RenderError> {
    let film = |at: &[f64]| match make(at) {
        Some(make) => level.made(&make, control).map(Some),
        None => Ok(None),
    };
    let Some(mut current) = film(start)? else {
        return Ok(None);
    };
    let mut at = start.to_vec();
    let mut left = rmse(&level.a, &current);
    for _ in 0..STEPS {
        let mut slopes = Vec::new();
        for i in 0..at.len() {
            let mut beside = at.clone();
            beside[i] += widths[i];
            match film(&beside)? {
                Some(film) => slopes.push(film),
                None => return Ok(Some(at)),
            }
        }
        let Some(way) = solve(&level.a, &current, &slopes) else {
            break;
        };
        // Where the problem is far from linear, a part of the way is better than all of it.
        let mut better = None;
        for part in [1.0, 0.5, 0.25, 0.1] {
            let next: Vec<_> = (0..at.len())
                .map(|i| at[i] + part * way[i] * widths[i])
                .collect();
            let Some(film) = film(&next)? else { continue };
            let left_there = rmse(&level.a, &film);
            if left_there < left {
                better = Some((next, film, left_there));
                break;
            }
        }
        let Some((next, film, left_there)) = better else {
            break;
        };
        let gain = 1.0 - left_there / left;
        (at, current, left) = (next, film, left_there);
        if gain < GAIN {
            break;
        }
    }
    Ok(Some(at))
}

/// The least-squares solution of a ≈ current + Σ way · (slope − current), by Gauss's elimination of the normal equations.
fn solve(a: &Film, current: &Film, slopes: &[Film]) -> Option<Vec<f64>> {
    let n = slopes.len();
    let mut matrix = vec![vec![0.0; n + 1]; n];
    for (at, (p, q)) in a.pixels().iter().zip(current.pixels()).enumerate() {
        for channel in 0..3 {
            let slope = |i: usize| slopes[i].pixels()[at][channel] - q[channel];
            for (i, row) in matrix.iter_mut().enumerate() {
                let own = slope(i);
                if own == 0.0 {
                    continue;
                }
                for (j, sum) in row.iter_mut().enumerate() {
                    *sum += own
                        * if j < n {
                            slope(j)
                        } else {
                            p[channel] - q[channel]
                        };
                }
            }
        }
    }
    for i in 0..n {
        let pivot = matrix[i][i];
        if pivot <= 1e-12 {
            return None;
        }
        let above = matrix[i].clone();
        for (j, row) in matrix.iter_mut().enumerate() {
            if i != j {
                let factor = row[i] / pivot;
                for (x, above) in row.iter_mut().zip(&above) {
                    *x -= factor * above;
                }
            }
        }
    }
    Some((0..n).map(|i| matrix[i][n] / matrix[i][i]).collect())
}
