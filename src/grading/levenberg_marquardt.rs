//! Numbers for which a model comes nearest to a picture: by least squares, then by squares of small
//! differences and absolute values of large ones.
//!
//! Levenberg and Marquardt's method (Marquardt, An algorithm for least-squares estimation of
//! nonlinear parameters, 1963) with weights that make of squares absolute values (Schlossmacher,
//! 1973), so that what the numbers cannot explain does not draw them away from what they can.
//! Slopes are found by varying each number once, and then updated by what each move does (Broyden,
//! A class of methods for solving nonlinear simultaneous equations, 1965).

/// A round whose first move changes no number by more than this part of its step is the last.
const CLOSE: f64 = 0.05;

/// Numbers that were fitted.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The numbers.
    pub numbers: Vec<f64>,
    /// The sum of the absolute differences.
    pub left: f64,
    /// How far each may be off: a standard deviation, if an error is that of rounding.
    pub errors: Vec<f64>,
}

/// The sum of absolute differences.
pub fn absolute(differences: &[f64]) -> f64 {
    differences.iter().map(|d| d.abs()).sum()
}

/// What is to be small: the sum of squares of differences; or in units of their deviations, and of
/// absolute values of what is beyond one (Huber, Robust estimation of a location parameter, 1964).
struct Loss(Option<Vec<f64>>);

impl Loss {
    fn of(&self, differences: &[f64]) -> f64 {
        let weights = (0..).zip(differences);
        weights.map(|(at, d)| self.weight(at, *d) * d * d).sum()
    }

    /// The weight of a square.
    fn weight(&self, at: usize, difference: f64) -> f64 {
        match &self.0 {
            None => 1.0,
            Some(units) => (units[at] / difference.abs()).min(1.0) / (units[at] * units[at]),
        }
    }
}

/// Fits numbers from a start; `steps` are by how much each is varied to see what it does. `trial`
/// gives the differences from a picture; none for numbers that cannot be, and where no more work
/// may be done.
///
/// By squares first, which have one valley; then in standard deviations, of which more than one
/// counts by its absolute value, so that what the numbers cannot explain does not draw them away
/// from what they can. `rounds` are those of both.
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
                // In units of the step, so that all numbers are alike.
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
            // A move that fails with updated slopes is blamed on these: they are found anew before
            // damping is tried.
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
            match has_improved {
                true => round += 1,
                false => slopes.clear(),
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

/// Slopes that agree with what a move did, by Broyden's method: to vary each number once more would
/// take most of the time.
fn update(slopes: &mut [Vec<f64>], moves: &[f64], before: &[f64], after: &[f64]) {
    let square: f64 = moves.iter().map(|by| by * by).sum();
    for at in 0..before.len() {
        let told: f64 = slopes
            .iter()
            .zip(moves)
            .map(|(slope, by)| slope[at] * by)
            .sum();
        let missed = (after[at] - before[at] - told) / square;
        for (slope, by) in slopes.iter_mut().zip(moves) {
            slope[at] += missed * by;
        }
    }
}

/// Solves a small system of linear equations by elimination with the largest pivot.
pub fn solve(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let count = right.len();
    for i in 0..count {
        let pivot = (i..count).max_by(|&a, &b| rows[a][i].abs().total_cmp(&rows[b][i].abs()))?;
        rows.swap(i, pivot);
        right.swap(i, pivot);
        if rows[i][i].abs() < 1e-300 {
            return None;
        }
        for j in i + 1..count {
            let factor = rows[j][i] / rows[i][i];
            let (above, below) = rows.split_at_mut(j);
            for (to, from) in below[0][i..].iter_mut().zip(&above[i][i..]) {
                *to -= factor * from;
            }
            right[j] -= factor * right[i];
        }
    }
    for i in (0..count).rev() {
        for k in i + 1..count {
            right[i] -= rows[i][k] * right[k];
        }
        right[i] /= rows[i][i];
    }
    right.iter().all(|x| x.is_finite()).then_some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_among_points_of_which_some_are_elsewhere() {
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
        let fitted = fit(
            vec![0.0, 0.0],
            &[0.1, 0.1],
            [30, 30],
            &|| vec![1e-3; 40],
            &trial,
        )
        .unwrap();
        assert!(
            (fitted.numbers[0] - 2.0).abs() < 0.02 && (fitted.numbers[1] - 0.25).abs() < 0.002,
            "{fitted:?}"
        );
    }

    #[test]
    fn a_system_without_a_solution_has_none() {
        assert_eq!(
            solve(vec![vec![0.0, 2.0], vec![4.0, 0.0]], vec![2.0, 4.0]),
            Some(vec![1.0, 1.0])
        );
        assert_eq!(
            solve(vec![vec![0.0, 0.0], vec![0.0, 0.0]], vec![1.0, 1.0]),
            None
        );
    }
}
