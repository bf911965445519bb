//! Arcs of conics.

use glam::DVec2;

/// Half the width in which the area's series is used, in 1 − w².
const NEAR_PARABOLA: f64 = 0.36;

/// An arc of a conic: the rational quadratic Bézier curve of the weights 1, w and 1.
///
/// Its tangents at the ends meet at `control`; it is of an ellipse for w < 1, of a parabola for w = 1 and of a hyperbola for
/// w > 1 (Farin, "Curves and Surfaces for CAGD", chapter 12).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arc {
    pub start: DVec2,
    pub control: DVec2,
    pub end: DVec2,
    /// w, above 0.
    pub weight: f64,
}

impl Arc {
    /// The area between the arc and its chord, never negative.
    ///
    /// Of the triangle start, control, end it is the part w·(θ − sin θ cos θ)/sin³θ with cos θ = w: what a circle's segment
    /// of half-angle θ is of its triangle, for an affine map takes every ellipse to a circle. For w > 1 θ is imaginary.
    pub(crate) fn area(&self) -> f64 {
        let triangle = 0.5
            * (self.control - self.start)
                .perp_dot(self.end - self.start)
                .abs();
        triangle * part(self.weight)
    }

    /// The point of the parameter t, from 0 to 1.
    pub(crate) fn at(&self, t: f64) -> DVec2 {
        let (point, weight) = self.blossom(t, t);
        point / weight
    }

    /// The arc between two parameters.
    pub(crate) fn between(&self, t0: f64, t1: f64) -> Self {
        let (start, w0) = self.blossom(t0, t0);
        let (control, w) = self.blossom(t0, t1);
        let (end, w1) = self.blossom(t1, t1);
        Self {
            start: start / w0,
            control: control / w,
            end: end / w1,
            weight: w / (w0 * w1).sqrt(),
        }
    }

    /// The curve's polar form in homogeneous coordinates.
    fn blossom(&self, s: f64, t: f64) -> (DVec2, f64) {
        let (first, last) = ((1.0 - s) * (1.0 - t), s * t);
        let middle = self.weight * (s * (1.0 - t) + t * (1.0 - s));
        (
            self.start * first + self.control * middle + self.end * last,
            first + middle + last,
        )
    }
}

/// The part of its triangle that lies between an arc of weight w and its chord.
fn part(w: f64) -> f64 {
    let z = (1.0 - w) * (1.0 + w);
    if z.abs() < NEAR_PARABOLA {
        return w * series(z);
    }
    let s = (1.0 - w).abs().sqrt() * (1.0 + w).sqrt();
    if w < 1.0 {
        return w * (libm::atan2(s, w) - s * w) / (s * s * s);
    }
    (w / s) * (w / s - libm::log(w + s) / s / s)
}

/// (θ − sin θ cos θ)/sin³θ = Σ 2/(2k + 3)·C(2k, k)/4^k·z^k with z = sin²θ, the integral of 2x²/√(1 − x²).
fn series(z: f64) -> f64 {
    const TERMS: usize = 34;
    const COEFFICIENTS: [f64; TERMS] = {
        let mut all = [0.0; TERMS];
        let mut binomial = 1.0;
        let mut k = 0;
        while k < TERMS {
            all[k] = 2.0 * binomial / (2 * k + 3) as f64;
            binomial *= (2 * k + 1) as f64 / (2 * k + 2) as f64;
            k += 1;
        }
        all
    };
    COEFFICIENTS.iter().rev().fold(0.0, |sum, c| sum * z + c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn circle_segments() {
        for degrees in 3..90 {
            let theta = f64::from(degrees) * PI / 180.0;
            let (sin, cos) = (libm::sin(theta), libm::cos(theta));
            let arc = Arc {
                start: DVec2::new(cos, -sin),
                control: DVec2::new(1.0 / cos, 0.0),
                end: DVec2::new(cos, sin),
                weight: cos,
            };
            let expected = if degrees < 20 {
                // x = 2θ: (x − sin x)/2 = x³/12 − x⁵/240 + …
                let x = 2.0 * theta;
                let mut term = x * x * x / 6.0;
                let mut sum = 0.0;
                for k in 2..20 {
                    sum += term;
                    term *= -x * x / f64::from(2 * k * (2 * k + 1));
                }
                0.5 * sum
            } else {
                theta - sin * cos
            };
            assert!(
                // 1/cos θ is a coordinate, and the triangle's height its difference to cos θ.
                (arc.area() / expected - 1.0).abs() < 4e-15 + 2.0 * f64::EPSILON / (theta * theta),
                "{degrees}: {} {expected}",
                arc.area()
            );
            let at = arc.at(0.3);
            assert!((at.length() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn parabola_and_hyperbola() {
        assert_eq!(part(1.0), 2.0 / 3.0);
        // x·y = 1 from x = 1 to x = k: the tangents meet at (2k, 2)/(k + 1), and w² = (k + 1)²/4k.
        for k in [1.5_f64, 2.0, 3.0, 4.0, 5.0, 10.0, 1e3, 1e6, 1e12] {
            let weight = (k + 1.0) / (2.0 * k.sqrt());
            let arc = Arc {
                start: DVec2::new(1.0, 1.0),
                control: DVec2::new(2.0 * k, 2.0) / (k + 1.0),
                end: DVec2::new(k, 1.0 / k),
                weight,
            };
            let expected = 0.5 * (k - 1.0) * (1.0 + 1.0 / k) - libm::log(k);
            assert!(
                (arc.area() / expected - 1.0).abs() < 2e-14,
                "{k}: {} {expected}",
                arc.area()
            );
        }
        assert!((part(1e200) - 1.0).abs() < 1e-15);
        assert!((part(1e-200) / 1e-200 - PI / 2.0).abs() < 1e-15);
    }

    #[test]
    fn the_formulas_meet() {
        for edge in [NEAR_PARABOLA, -NEAR_PARABOLA] {
            let w = (1.0 - edge).sqrt();
            let (below, above) = (part(w * (1.0 - 1e-13)), part(w * (1.0 + 1e-13)));
            assert!((below / above - 1.0).abs() < 3e-15 + 3e-13);
        }
    }

    #[test]
    fn a_part_of_an_arc_is_an_arc() {
        let arc = Arc {
            start: DVec2::new(0.1, 0.2),
            control: DVec2::new(0.4, 0.5),
            end: DVec2::new(-0.3, 0.4),
            weight: 0.7,
        };
        let (left, right) = (arc.between(0.0, 0.35), arc.between(0.35, 1.0));
        let triangle = 0.5 * (left.end - arc.start).perp_dot(arc.end - arc.start).abs();
        assert!((left.area() + right.area() + triangle - arc.area()).abs() < 1e-16);
    }
}
