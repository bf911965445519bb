//! Fits the numbers of a model to a picture, first by least squares, then by a robust loss.
//!
//! The method is that of Levenberg and Marquardt (Marquardt, An algorithm for least-squares
//! estimation of nonlinear parameters, 1963). For the robust loss, squared differences get weights
//! by which they become absolute values (Schlossmacher, 1973). So errors that the model cannot
//! explain do not distort the fit. Derivatives are first found by varying each number. After each
//! change of the numbers, they are updated by Broyden's method (Broyden, A class of methods for
//! solving nonlinear simultaneous equations, 1965).

use crate::grading::scoring::solve;

/// Maximum change of a number in a round at which the fit is treated as converged. The unit is the
/// step by which the number is varied to find its derivative. With a smaller value, the fit takes
/// more rounds. With a larger one, it may stop before the numbers are best.
const CLOSE: f64 = 0.05;

/// The result of a fit.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The fitted numbers.
    pub numbers: Vec<f64>,
    /// Sum of the absolute differences that remain.
    pub left: f64,
    /// Standard deviation of each fitted number. It is computed from the argument `deviations` of
    /// [`fit`], and is meaningful only if a round minimised Huber's loss.
    pub errors: Vec<f64>,
}

/// Returns the sum of absolute differences.
pub fn absolute(differences: &[f64]) -> f64 {
    differences.iter().map(|d| d.abs()).sum()
}

/// The function that the fit minimises. Without standard deviations, it is the sum of squared
/// differences. With standard deviations, it is Huber's loss, which is linear for differences of
/// more than one standard deviation (Huber, Robust estimation of a location parameter, 1964).
struct Loss(Option<Vec<f64>>);

impl Loss {
    fn of(&self, differences: &[f64]) -> f64 {
        let weights = (0..).zip(differences);
        weights.map(|(at, d)| self.weight(at, *d) * d * d).sum()
    }

    /// Returns the weight by which the loss multiplies a squared difference.
    fn weight(&self, at: usize, difference: f64) -> f64 {
        match &self.0 {
            None => 1.0,
            Some(units) => (units[at] / difference.abs()).min(1.0) / (units[at] * units[at]),
        }
    }
}

/// Fits the numbers of a model to a picture. `start` contains the numbers from which the fit
/// starts. To find derivatives, each number is changed by its entry in `steps`. `trial` returns the
/// differences between the model and the picture for given numbers. It returns `None` if the
/// numbers are impossible, or if the budget of work is used up.
///
/// First, the sum of squared differences is minimised, because it is less likely to have several
/// minima. Then Huber's loss is minimised, because large errors that no numbers can explain distort
/// it less. The loss is in units of the standard deviations `deviations`. `rounds` contains the
/// maximum numbers of rounds for the two losses. Returns `None` if `trial` returns `None` for
/// `start`.
pub fn fit(
    start: Vec<f64>,
    steps: &[f64],
    rounds: [usize; 2],
    deviations: &dyn Fn() -> Vec<f64>,
    trial: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
) -> Option<Fitted> {
    let count = start.len();
    let mut numbers = start;
    let mut now = trial(&numbers)?;
    let mut normal = vec![vec![0.0; count]; count];
    let mut slopes: Vec<Vec<f64>> = Vec::new();
    let mut are_new = true;
    let phases = [(rounds[0], false), (rounds[1], true)];
    'fitting: for (rounds, is_robust) in phases.into_iter().filter(|phase| phase.0 > 0) {
        let loss = Loss(is_robust.then(deviations));
        let mut left = loss.of(&now);
        let mut damping = 1e-3;
        let mut round = 0;
        while round < rounds {
            are_new |= slopes.is_empty();
            for i in slopes.len()..count {
                let varied = |by: f64| {
                    let mut other = numbers.clone();
                    other[i] += by;
                    Some((by, trial(&other)?))
                };
                let Some((by, other)) = varied(steps[i]).or_else(|| varied(-steps[i])) else {
                    break 'fitting;
                };
                // Each derivative is multiplied by the number's entry in `steps`, so that all
                // numbers have the same scale.
                let sign = steps[i] / by;
                let slope = other.iter().zip(&now).map(|(b, a)| sign * (b - a));
                slopes.push(slope.collect());
            }
            let weights = (0..).zip(&now).map(|(at, d)| loss.weight(at, *d));
            let weights: Vec<f64> = weights.collect();
            let product = |a: &[f64], b: &[f64]| -> f64 {
                let terms = a.iter().zip(b).zip(&weights);
                terms.map(|((a, b), weight)| a * b * weight).sum()
            };
            for i in 0..count {
                for j in 0..=i {
                    normal[i][j] = product(&slopes[i], &slopes[j]);
                    normal[j][i] = normal[i][j];
                }
            }
            let gradient: Vec<f64> = slopes.iter().map(|slope| -product(slope, &now)).collect();
            let (mut has_improved, mut is_far) = (false, None);
            // Newly computed derivatives are used for up to four attempts, with growing damping.
            // Updated derivatives are inexact, so they are computed again after one failed attempt.
            let attempts = if are_new { 4 } else { 1 };
            for _ in 0..attempts {
                let mut damped = normal.clone();
                for (i, row) in damped.iter_mut().enumerate() {
                    row[i] += damping * row[i] + 1e-12;
                }
                let Some(moves) = solve(damped, gradient.clone()) else {
                    break;
                };
                is_far.get_or_insert(moves.iter().any(|by| by.abs() > CLOSE));
                let moved = numbers.iter().zip(steps).zip(&moves);
                let moved: Vec<f64> = moved.map(|((x, step), by)| x + step * by).collect();
                if let Some(differences) = trial(&moved) {
                    let less = loss.of(&differences);
                    if less < left {
                        update(&mut slopes, &moves, &now, &differences);
                        (are_new, has_improved) = (false, true);
                        (left, now, numbers) = (less, differences, moved);
                        damping *= 0.1;
                        break;
                    }
                }
                damping *= 10.0;
            }
            if is_far != Some(true) || !has_improved && are_new {
                break;
            }
            if has_improved {
                round += 1
            } else {
                slopes.clear()
            }
        }
    }
    let error = |i: usize| {
        let mut unit = vec![0.0; count];
        unit[i] = 1.0;
        let column = solve(normal.clone(), unit);
        column.map_or(0.0, |column| column[i].max(0.0).sqrt() * steps[i].abs())
    };
    Some(Fitted {
        left: absolute(&now),
        numbers,
        errors: (0..count).map(error).collect(),
    })
}

/// Updates the derivatives by Broyden's method after the numbers were changed by `moves`. If each
/// number were varied again instead, this would take most of the time of a fit.
fn update(slopes: &mut [Vec<f64>], moves: &[f64], before: &[f64], after: &[f64]) {
    let square: f64 = moves.iter().map(|by| by * by).sum();
    for at in 0..before.len() {
        let terms = slopes.iter().zip(moves).map(|(slope, by)| slope[at] * by);
        let missed = (after[at] - before[at] - terms.sum::<f64>()) / square;
        for (slope, by) in slopes.iter_mut().zip(moves) {
            slope[at] += missed * by;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_fitted_despite_outliers() {
        let points: Vec<f64> = (0..40)
            .map(|x| {
                if x % 8 == 3 {
                    9.0
                } else {
                    2.0 + 0.25 * f64::from(x)
                }
            })
            .collect();
        let trial = |numbers: &[f64]| {
            let line = |(x, y): (usize, &f64)| numbers[0] + numbers[1] * x as f64 - y;
            Some(points.iter().enumerate().map(line).collect())
        };
        let (start, deviations) = (vec![0.0; 2], || vec![1e-3; 40]);
        let fitted = fit(start, &[0.1, 0.1], [30, 30], &deviations, &trial).unwrap();
        assert!(
            (fitted.numbers[0] - 2.0).abs() < 0.02 && (fitted.numbers[1] - 0.25).abs() < 0.002,
            "{fitted:?}"
        );
    }
}
