//! Least absolute differences: numbers for which a model comes nearest to a picture.
//!
//! Levenberg and Marquardt's method (Marquardt, An algorithm for least-squares estimation of nonlinear parameters, 1963) with weights that make of squares
//! absolute values (Schlossmacher, 1973), so that what the numbers cannot explain does not draw them away from what they can.

/// The difference below which a square counts as one: a step of 8-bit sRGB.
const SMALL: f64 = super::score::STEP;

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

/// Fits numbers from a start; `steps` are by how much each is varied to see what it does. `differences` gives none for numbers that cannot be.
pub fn fit(
    start: Vec<f64>,
    steps: &[f64],
    rounds: usize,
    differences: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
) -> Option<Fitted> {
    let count = start.len();
    let mut numbers = start;
    let mut now = differences(&numbers)?;
    let mut left = absolute(&now);
    let mut damping = 1e-3;
    let mut normal = vec![vec![0.0; count]; count];
    for _ in 0..rounds {
        let mut slopes = Vec::with_capacity(count);
        for i in 0..count {
            let varied = |by: f64| {
                let mut other = numbers.clone();
                other[i] += by;
                Some((by, differences(&other)?))
            };
            let (by, other) = varied(steps[i]).or_else(|| varied(-steps[i]))?;
            // In units of the step, so that all numbers are alike.
            let sign = steps[i] / by;
            slopes.push(
                other
                    .iter()
                    .zip(&now)
                    .map(|(b, a)| sign * (b - a))
                    .collect::<Vec<_>>(),
            );
        }
        let weights: Vec<f64> = now.iter().map(|d| 1.0 / d.abs().max(SMALL)).collect();
        let product = |a: &[f64], b: &[f64]| -> f64 {
            a.iter()
                .zip(b)
                .zip(&weights)
                .map(|((a, b), weight)| a * b * weight)
                .sum()
        };
        for i in 0..count {
            for j in 0..count {
                normal[i][j] = product(&slopes[i], &slopes[j]);
            }
        }
        let gradient: Vec<f64> = slopes.iter().map(|slope| -product(slope, &now)).collect();
        let mut is_better = false;
        for _ in 0..4 {
            let mut damped = normal.clone();
            for (i, row) in damped.iter_mut().enumerate() {
                row[i] += damping * row[i] + 1e-12;
            }
            let Some(moves) = solve(damped, gradient.clone()) else {
                break;
            };
            let moved: Vec<f64> = numbers
                .iter()
                .zip(steps)
                .zip(&moves)
                .map(|((x, step), by)| x + step * by)
                .collect();
            if let Some(other) = differences(&moved)
                && absolute(&other) < left
            {
                let gain = 1.0 - absolute(&other) / left;
                (left, now, numbers) = (absolute(&other), other, moved);
                damping *= 0.1;
                is_better = gain > 1e-3;
                break;
            }
            damping *= 10.0;
        }
        if !is_better {
            break;
        }
    }
    // The weights are 1/SMALL where all is right, so the normal matrix is that of errors of the variance SMALL²/12 times 1/SMALL.
    let errors = (0..count)
        .map(|i| {
            let mut unit = vec![0.0; count];
            unit[i] = 1.0;
            let inverse = solve(normal.clone(), unit).map_or(0.0, |column| column[i].max(0.0));
            steps[i].abs() * (inverse * SMALL / 12.0).sqrt()
        })
        .collect();
    Some(Fitted {
        numbers,
        left,
        errors,
    })
}

/// Solves a small system of linear equations by elimination with the largest pivot.
fn solve(mut rows: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
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
        let differences = |numbers: &[f64]| {
            let line = |(x, y): (usize, &f64)| numbers[0] + numbers[1] * x as f64 - y;
            Some(points.iter().enumerate().map(line).collect())
        };
        let fitted = fit(vec![0.0, 0.0], &[0.1, 0.1], 30, &differences).unwrap();
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
