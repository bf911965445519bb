//! Small systems of linear equations.

/// Solves a system of linear equations by elimination with partial pivoting. Returns `None` if it
/// is singular.
pub fn solve(mut rows: Vec<Vec<f64>>, mut constants: Vec<f64>) -> Option<Vec<f64>> {
    let count = constants.len();
    for i in 0..count {
        let pivot = (i..count).max_by(|&a, &b| rows[a][i].abs().total_cmp(&rows[b][i].abs()))?;
        rows.swap(i, pivot);
        constants.swap(i, pivot);
        if rows[i][i].abs() < 1e-300 {
            return None;
        }
        for j in i + 1..count {
            let factor = rows[j][i] / rows[i][i];
            let (above, below) = rows.split_at_mut(j);
            for (to, from) in below[0][i..].iter_mut().zip(&above[i][i..]) {
                *to -= factor * from;
            }
            constants[j] -= factor * constants[i];
        }
    }
    for i in (0..count).rev() {
        for k in i + 1..count {
            constants[i] -= rows[i][k] * constants[k];
        }
        constants[i] /= rows[i][i];
    }
    constants.iter().all(|x| x.is_finite()).then_some(constants)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_singular_system_has_no_solution() {
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
