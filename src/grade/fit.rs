//! The scene nearest to a picture, among those that a few numbers make.
//!
//! Exact pictures are smooth functions of the scene, without any noise of samples, so that the method of Gauss and Newton works: a few
//! pictures beside the current one give the slopes, and the linear problem's solution the next point.

use super::{Make, level::Level};
use crate::{
    film::{Film, rmse},
    render::{Control, RenderError},
};

/// So many steps are taken at most. Near the end each doubles the digits, so that three are enough there; the others are to get near.
const STEPS: usize = 8;

/// A step that brings less than this share ends the search: steps that double the digits bring more until there is nothing left to bring.
const GAIN: f64 = 1e-3;

/// Where the problem is far from linear, a step is damped (Marquardt, An algorithm for least-squares estimation of nonlinear parameters,
/// 1963): for a single number that is these parts of the way, 1, 1/2, 1/4 and 1/10.
const DAMPINGS: [f64; 4] = [0.0, 1.0, 3.0, 9.0];

/// Numbers whose slopes are alike but for this share of their squares cannot be told apart: the slopes are differences over half a pixel,
/// whose curvature alone makes them differ by more.
const ALIKE: f64 = 1e-9;

/// What is found.
#[derive(Clone)]
pub struct Fit {
    pub at: Vec<f64>,
    /// The root mean square of the differences that it leaves.
    pub left: f64,
}

/// Finds the numbers from a start on; `widths` are steps that move the whole picture by half a pixel. `make` is of mistakes in the whole
/// picture's size. Nothing, if there is no scene at the start.
pub fn fit(
    level: &Level,
    control: &Control,
    start: &[f64],
    widths: &[f64],
    make: &dyn Fn(&[f64]) -> Option<Make>,
) -> Result<Option<Fit>, RenderError> {
    let film = |at: &[f64]| match make(at) {
        Some(make) => level.made(&make, control).map(Some),
        None => Ok(None),
    };
    let Some(mut current) = film(start)? else {
        return Ok(None);
    };
    let widths: Vec<_> = (widths.iter())
        .map(|width| width * f64::from(level.factor))
        .collect();
    let mut at = start.to_vec();
    let mut left = rmse(&level.a, &current);
    for _ in 0..STEPS {
        let mut slopes = Vec::new();
        for i in 0..at.len() {
            let mut beside = at.clone();
            beside[i] += widths[i];
            match film(&beside)? {
                Some(film) => slopes.push(film),
                None => return Ok(Some(Fit { at, left })),
            }
        }
        let problem = Problem::new(&level.a, &current, &slopes);
        let mut better = None;
        for damping in DAMPINGS {
            let Some(mut way) = problem.solved(damping) else {
                continue;
            };
            // No step moves the picture by more than its own size, in halves of a pixel.
            let most = 2.0 * f64::from(level.a.width() + level.a.height());
            let far = way.iter().fold(0.0, |far: f64, way| far.max(way.abs()));
            if !far.is_finite() {
                continue;
            }
            way.iter_mut().for_each(|way| *way *= (most / far).min(1.0));
            let next: Vec<_> = (0..at.len()).map(|i| at[i] + way[i] * widths[i]).collect();
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
    Ok(Some(Fit { at, left }))
}

/// The normal equations of b ≈ Σ way · slope, a row for each number.
pub struct Problem(Vec<Vec<f64>>);

impl Problem {
    /// With so many numbers, and nothing known of them.
    pub fn of(numbers: usize) -> Self {
        Self(vec![vec![0.0; numbers + 1]; numbers])
    }

    /// That of which the products of all numbers are known with those before them and themselves; the last one is what they should make.
    pub fn of_products(half: Vec<Vec<f64>>) -> Self {
        let numbers = half.len().saturating_sub(1);
        let product = |i: usize, j: usize| half[i.max(j)][i.min(j)];
        let row = |i| (0..=numbers).map(|j| product(i, j)).collect();
        Self((0..numbers).map(row).collect())
    }

    /// That of a ≈ current + Σ way · (slope − current).
    fn new(a: &Film, current: &Film, slopes: &[Film]) -> Self {
        let n = slopes.len();
        let mut problem = Self::of(n);
        let mut own = vec![0.0; n + 1];
        for (at, (p, q)) in a.pixels().iter().zip(current.pixels()).enumerate() {
            for channel in 0..3 {
                for (own, slope) in own.iter_mut().zip(slopes) {
                    *own = slope.pixels()[at][channel] - q[channel];
                }
                own[n] = p[channel] - q[channel];
                problem.add(&own);
            }
        }
        problem
    }

    /// One more number that is known: the slopes, and it.
    pub fn add(&mut self, own: &[f64]) {
        for (row, slope) in self.0.iter_mut().zip(own) {
            if *slope != 0.0 {
                for (sum, other) in row.iter_mut().zip(own) {
                    *sum += slope * other;
                }
            }
        }
    }

    /// Their solution by Gauss's elimination, with so many times its square added to each number's. A number that changes nothing stays.
    pub fn solved(&self, damping: f64) -> Option<Vec<f64>> {
        let mut matrix = self.0.clone();
        let n = matrix.len();
        let squares: Vec<f64> = (0..n).map(|i| matrix[i][i]).collect();
        if squares.iter().all(|square| *square == 0.0) {
            return None;
        }
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] = match squares[i] {
                0.0 => 1.0,
                square => square * (1.0 + damping),
            };
        }
        for i in 0..n {
            let pivot = matrix[i][i];
            if pivot <= ALIKE * squares[i] {
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
}
