//! The Lerch series V_s(θ) = Σ_j e^(iθj)·(w + j)^(−s), j = 0, 1, 2, … for s = 3, 4, 5. For an edge
//! of a polygon, w is the depth at the first line that it crosses, divided by the change of the
//! depth from line to line. The series equals an integral ([`tail`](super)), which is computed from
//! the pole of the integrand and an expansion of the rest of the integrand.

use super::super::special::{Complex, integrals};

/// Angle |θ|, in radians, below which [`rest_of_pole`] uses a Taylor series, because its closed
/// formula loses digits by cancellation. With this value, the first omitted term, θ⁹/47900160, is
/// about 100 unit roundoffs. The error bound of the Lerch series allows for 500 unit roundoffs.
const NEAR_POLE: f64 = 0.2;

/// Computes the Lerch series Σ_j e^(iθj)·(w + j)^(−s), j = 0, 1, 2, … for s = 3, 4 and 5. θ is
/// `theta`, with |θ| ≤ π, and w is positive. `rotation` must be e^iθ. The truncation error is at
/// most 0.04·s·(s + 1)·w^(−s−2).
pub(super) fn lerch(theta: f64, rotation: Complex, w: f64) -> [Complex; 3] {
    // The series is also an integral (`tail`), whose integrand is the sum of a pole and a regular
    // function. The pole gives an exponential integral. The regular function is replaced by its
    // first two Taylor terms (`rest_of_pole`).
    let (r, slope) = rest_of_pole(theta, rotation);
    let h = integrals(theta * w);
    let u = 1.0 / w;
    let mut power = u * u;
    [0, 1, 2].map(|i| {
        let s = (i + 3) as f64;
        let v = [
            power * (h[i][0] + u * (0.5 + slope * s * u)),
            power * (h[i][1] + u * r),
        ];
        power *= u;
        v
    })
}

/// Returns r and the derivative R′ of the function R(ζ) = 1/(1 − e^(−ζ)) − 1/ζ at ζ = −iθ. The
/// function is regular at 0. At ζ, R = ½ + i·r, and r and R′ are real:
///
/// r = ½·cot(θ/2) − 1/θ, R′ = 1/(4·sin²(θ/2)) − 1/θ²
///
/// `rotation` must be e^(iθ).
fn rest_of_pole(theta: f64, rotation: Complex) -> (f64, f64) {
    let square = theta * theta;
    if theta.abs() < NEAR_POLE {
        let r = -theta
            * (1.0 / 12.0 + square * (1.0 / 720.0 + square * (1.0 / 30240.0 + square / 1209600.0)));
        let slope =
            1.0 / 12.0 + square * (1.0 / 240.0 + square * (1.0 / 6048.0 + square / 172800.0));
        return (r, slope);
    }
    let gap = 1.0 / (1.0 - rotation[0]);
    let inverse = 1.0 / theta;
    (
        0.5 * rotation[1] * gap - inverse,
        0.5 * gap - inverse * inverse,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::oracle::Number;

    #[test]
    fn the_rest_of_the_pole_is_its_closed_formula() {
        let number = Number { bits: 256 };
        let [half, one] = [0.5, 1.0].map(|x| number.exact(x));
        for theta in [1e-6, 0.01, 0.05, 0.1, 0.19999, 0.20001, 0.5, 1.5, 3.1] {
            let exact = number.exact(theta);
            let (sin, cos) = (&exact * &half).sin_cos();
            let inverse = &one / &exact;
            let expected = [
                &half * cos / &sin - &inverse,
                &half * &half / (&sin * &sin) - &inverse * &inverse,
            ];
            for sign in [-1.0, 1.0] {
                let rotation = [libm::cos(theta), sign * libm::sin(theta)];
                let (r, slope) = rest_of_pole(sign * theta, rotation);
                let errors = [(sign * r, &expected[0]), (slope, &expected[1])]
                    .map(|(x, expected)| (number.exact(x) - expected).to_f64().value().abs());
                // The first omitted terms of the two series are θ⁹/47900160 and 9·θ⁸/47900160. They
                // are largest at `NEAR_POLE`. The factor 1.5 covers later terms and roundings.
                let omitted = 1.5 * libm::pow(NEAR_POLE, 8.0) / 47_900_160.0;
                assert!(errors[0] <= NEAR_POLE * omitted, "{theta}: {errors:?}");
                assert!(errors[1] <= 9.0 * omitted, "{theta}: {errors:?}");
            }
        }
    }
}
