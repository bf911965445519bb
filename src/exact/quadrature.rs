//! Integrals by Gauss's nodes.

/// Of six nodes a half of them and their weights: those of Gauss and Legendre.
const NODES: [[f64; 2]; 3] = [
    [0.238_619_186_083_196_9, 0.467_913_934_572_691],
    [0.661_209_386_466_264_5, 0.360_761_573_048_138_6],
    [0.932_469_514_203_152, 0.171_324_492_379_170_36],
];

/// The integral between two places, with six nodes.
pub(super) fn integral(from: f64, to: f64, of: impl Fn(f64) -> f64) -> f64 {
    let [middle, half] = [0.5 * (from + to), 0.5 * (to - from)];
    let sum: f64 = NODES
        .iter()
        .map(|[x, weight]| weight * (of(middle - half * x) + of(middle + half * x)))
        .sum();
    half * sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_and_weights_are_those_of_gauss() {
        for power in 0..6 {
            let even = |x: f64| libm::pow(x, f64::from(2 * power));
            let expected = 2.0 / f64::from(2 * power + 1);
            assert!((integral(-1.0, 1.0, even) - expected).abs() < 1e-15);
        }
    }
}
