//! The segment of a conic between an arc and its chord: its area, and the integral of a
//! checkerboard's sign (1 on squares of one colour, −1 on the others) over it.
//!
//! In: an arc as a rational quadratic Bézier curve. Out: the segment's area in closed form, and the
//! integral of the board's sign over the segment. For the integral, the arc is cut wherever it
//! crosses a line of the board. The segment of each piece then lies in one square, and the chords
//! of the pieces bound a convex polygon. Near the horizon, an arc may cross very many lines.
//! Segments below a minimum area are therefore neglected. The error bound includes the neglected
//! areas and the rounding errors of positions.

use glam::DVec2;

use super::{
    budget::PixelBudget,
    checker::{BoundedSum, Homography, UNIT, form, square_wave},
};

/// Maximum of |1 − w²| at which the area of an arc of weight w is computed by a series. Above this
/// maximum, a closed formula is used, which loses digits near w = 1, a parabola. The first omitted
/// term of the series is at most 0.36³⁴ = 8e-16.
const NEAR_PARABOLA: f64 = 0.36;

/// Maximum number of lines of a board along which an arc is cut into pieces at once. If more lines
/// cross the arc, it is halved first. Measured: with 48 instead of 12, boards of small squares
/// behind spheres take up to 50 % longer.
const MAX_LINES: f64 = 12.0;
/// Maximum total area of the segments (between arc and chord) of an arc's two halves, divided by
/// the area of the whole arc's segment. A larger quotient shows that numbers are too large or too
/// small to represent the arc. The arc is then not halved, and its segment is added to the error
/// bound. The exact quotient is 1/4 for a parabola and less for a hyperbola. For an ellipse, it is
/// at most 0.37; this maximum is reached by half of an ellipse. The constant is about 2 · 0.37.
const MAX_HALVES_SHARE: f64 = 0.75;

/// An arc of a conic: the rational quadratic Bézier curve with weights 1, w and 1.
///
/// The tangents at its ends meet at `control`. The arc belongs to an ellipse if w < 1, to a
/// parabola if w = 1, and to a hyperbola if w > 1 (Farin, "Curves and Surfaces for CAGD", chapter
/// 12).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arc {
    pub start: DVec2,
    pub control: DVec2,
    pub end: DVec2,
    /// Weight w of the control point, greater than 0.
    pub weight: f64,
}

impl Arc {
    /// Returns the area between the arc and its chord, which is never negative.
    ///
    /// Divided by the area of the triangle of `start`, `control` and `end`, it is
    ///
    /// w·(θ − sin θ·cos θ)/sin³θ with cos θ = w.
    ///
    /// This is the ratio of a circle's segment of half-angle θ to its triangle; an affine map takes
    /// every ellipse to a circle. If w > 1, θ is imaginary.
    pub(crate) fn area(&self) -> f64 {
        self.bounded_area().value
    }

    /// Returns the area between the arc and its chord, with a bound on its rounding errors.
    fn bounded_area(&self) -> BoundedSum {
        let (side, chord) = (self.control - self.start, self.end - self.start);
        let products = [side.x * chord.y, side.y * chord.x];
        let share = triangle_share(self.weight);
        let area = 0.5 * (products[0] - products[1]).abs() * share;
        BoundedSum {
            value: area,
            // The area is half the difference of `products`, times `share`, the fraction of the
            // triangle that the segment covers. The first term of the bound covers the roundings of
            // `share`, at most ten. Where `share` is computed as a difference, such as θ − sin
            // θ·cos θ, |1 − w²| is at least `NEAR_PARABOLA`, and the difference is at least a
            // quarter of θ. The subtraction therefore makes relative errors at most four times as
            // large. The second term covers three roundings of each product. In a flat triangle,
            // the two products are nearly equal, and their roundings may be large compared with the
            // area.
            bound: UNIT * (48.0 * area + 2.0 * (products[0].abs() + products[1].abs()) * share),
        }
    }

    /// Returns the point of the arc at the curve's parameter `t`: 0 is the start, 1 the end.
    pub(crate) fn at(&self, t: f64) -> DVec2 {
        let (point, weight) = self.blossom(t, t);
        point / weight
    }

    /// Returns the part of the arc between the curve's parameters `t0` and `t1`.
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

    /// Evaluates the curve's polar form (blossom) at the parameters `s` and `t`. Returns the point
    /// in homogeneous coordinates: the point times its weight, and the weight.
    fn blossom(&self, s: f64, t: f64) -> (DVec2, f64) {
        let (first, last) = ((1.0 - s) * (1.0 - t), s * t);
        let middle = self.weight * (s * (1.0 - t) + t * (1.0 - s));
        (
            self.start * first + self.control * middle + self.end * last,
            first + middle + last,
        )
    }
}

/// Returns the area between an arc of weight `w` and its chord, divided by the area of the triangle
/// of the chord and the control point.
fn triangle_share(w: f64) -> f64 {
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

/// Evaluates the series in z = sin²θ, where cos θ is the weight of an arc:
///
/// (θ − sin θ·cos θ)/sin³θ = Σ 2/(2k + 3)·C(2k, k)/4^k·z^k.
///
/// It follows from the binomial series of 2x²/√(1 − x²), whose integral from 0 to sin θ is θ − sin
/// θ·cos θ.
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
    // Because |z| < 2^−`bits`, the omitted terms add up to less than a unit roundoff.
    let bits = (-1 - libm::ilogb(z)).max(1);
    let terms = (f64::MANTISSA_DIGITS as usize / bits as usize + 1).min(TERMS);
    let terms = COEFFICIENTS[..terms].iter().rev();
    terms.fold(0.0, |sum, c| sum * z + c)
}

impl Homography {
    /// Integrates the board's sign (1 on squares of one colour, −1 on the others) over the region
    /// between an arc and its chord, in square pixels.
    pub(super) fn over_segment(&self, arc: &Arc, budget: &PixelBudget) -> BoundedSum {
        let segment = arc.bounded_area();
        let area = segment.value;
        // The arc is cut where it crosses a line of the board, so that the segment of each piece
        // lies in one square. The chords of the pieces enclose the rest of the region, a convex
        // polygon.
        //
        // A piece whose segment is smaller than `neglected` is replaced by its chord. Let A be the
        // area of the arc's segment and t the tolerance. If the arc is cut into n pieces, a piece's
        // segment has about the area A/n³, and all of them together have A/n². For n = √(A/t), this
        // total is t, and a piece's segment has the area t^(3/2)/√A, the value of `neglected`.
        if let Some(sign) = self.square_of(arc) {
            return over_one_square(segment, sign);
        }
        let mut chords = Chords {
            points: vec![arc.start],
            sum: BoundedSum::default(),
            neglected: budget.tolerance * (budget.tolerance / area).sqrt(),
        };
        self.cut(arc, segment, &mut chords);
        chords.sum.add(self.over(&chords.points, budget));
        chords.sum.or_unknown(area)
    }

    /// Cuts an arc whose segment has the area `segment`. Adds the integrals over the pieces'
    /// segments to `chords.sum`, and the pieces' ends to `chords.points`.
    fn cut(&self, arc: &Arc, segment: BoundedSum, chords: &mut Chords) {
        if let Some(sign) = self.square_of(arc) {
            chords.sum.add(over_one_square(segment, sign));
            chords.points.push(arc.end);
            return;
        }
        let area = segment.value;
        if area <= chords.neglected {
            chords.sum.bound += area;
            chords.points.push(arc.end);
            return;
        }
        let lines = [0, 1].map(|i| self.lines(arc, i));
        if let [Some(a), Some(b)] = lines
            && a.1 - a.0 + b.1 - b.0 <= MAX_LINES
        {
            return self.cut_at_lines(arc, [a, b], chords);
        }
        let halves = [arc.between(0.0, 0.5), arc.between(0.5, 1.0)];
        let areas = [0, 1].map(|i| halves[i].bounded_area());
        // If numbers are too large or too small to represent the arc, the sum of the halves' areas
        // is not below the limit, or is NaN. The arc is then not halved.
        let is_halved = areas[0].value + areas[1].value < MAX_HALVES_SHARE * area;
        if !is_halved {
            chords.sum.bound += if area.is_nan() { 1.0 } else { area };
            chords.points.push(arc.end);
            return;
        }
        for (half, area) in halves.iter().zip(areas) {
            self.cut(half, area, chords);
        }
    }

    fn cut_at_lines(&self, arc: &Arc, lines: [(f64, f64); 2], chords: &mut Chords) {
        let points = [arc.start, arc.control, arc.end];
        let below = points.map(|p| form(&self.denominator, p));
        let mut cuts = vec![1.0];
        for (across, (first, last)) in self.numerators.iter().zip(lines) {
            let values = points.map(|p| form(across, p));
            let mut line = first;
            while line <= last {
                let f = [0, 1, 2].map(|i| values[i] - line * below[i]);
                let roots = roots(f[0], 2.0 * arc.weight * f[1], f[2]);
                cuts.extend(roots.into_iter().flatten());
                line += 1.0;
            }
        }
        cuts.sort_unstable_by(f64::total_cmp);
        let mut before = 0.0;
        for cut in cuts {
            if cut > before {
                let piece = arc.between(before, cut);
                let middle = piece.at(0.5);
                let depth = 1.0 / form(&self.denominator, middle);
                let [a, b] = self
                    .numerators
                    .map(|across| square_wave(form(&across, middle) * depth));
                let mut segment = over_one_square(piece.bounded_area(), a * b);
                // Rounding errors of the forms displace the lines of the board, which changes the
                // integral.
                segment.bound += self.displacement_error(&[piece.start, piece.control, piece.end]);
                chords.sum.add(segment);
                chords.points.push(piece.end);
            }
            before = cut;
        }
    }

    /// Returns the sign of the square that certainly contains the triangle of the arc's start,
    /// control point and end. Returns `None` if a line of the board may cross the triangle.
    fn square_of(&self, arc: &Arc) -> Option<f64> {
        let mut sign = 1.0;
        for i in 0..2 {
            let (first, last) = self.lines(arc, i)?;
            if first <= last {
                return None;
            }
            sign *= square_wave(last);
        }
        Some(sign)
    }

    /// Returns the numbers of the first and the last line of one of the board's two families that
    /// may cross an arc. If `family` is 0, the lines are a = i; if it is 1, they are b = i. If no
    /// line crosses the arc, the first number exceeds the last. Returns `None` if the arc's
    /// triangle may reach the horizon.
    fn lines(&self, arc: &Arc, family: usize) -> Option<(f64, f64)> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in [arc.start, arc.control, arc.end] {
            let level = form(&self.denominator, p);
            if level <= 0.0 {
                return None;
            }
            let (t, off) = self.place(family, p, level);
            low = low.min(t - off);
            high = high.max(t + off);
        }
        Some((low.floor() + 1.0, high.floor()))
    }
}

/// Integrates the board's sign over a segment of area `area` within one square of sign `sign`.
fn over_one_square(area: BoundedSum, sign: f64) -> BoundedSum {
    BoundedSum {
        value: sign * area.value,
        ..area
    }
}

/// The ends of the pieces into which an arc is cut, and the sum of the integrals over the segments
/// between the pieces and their chords.
struct Chords {
    points: Vec<DVec2>,
    sum: BoundedSum,
    /// Area, in square pixels, up to which the segment between a piece of the arc and its chord is
    /// neglected.
    neglected: f64,
}

/// Returns the roots between 0 and 1 of f0·(1 − t)² + f1·t·(1 − t) + f2·t². Each entry is `None` if
/// there is no such root.
fn roots(f0: f64, f1: f64, f2: f64) -> [Option<f64>; 2] {
    // If the squares of the board are extremely large, f0, f1 and f2 are tiny. Their products would
    // underflow without scaling.
    let scale = 1.0 / f0.abs().max(f1.abs()).max(f2.abs());
    let [f0, f1, f2] = [f0 * scale, f1 * scale, f2 * scale];
    let discriminant = f1 * f1 - 4.0 * f0 * f2;
    if discriminant < 0.0 {
        return [None, None];
    }
    // The polynomial is proportional to f2·r² + f1·r + f0, where r = t/(1 − t) and so t = r/(1 +
    // r). Neither root is computed as a difference of nearly equal numbers.
    let q = -0.5 * (f1 + discriminant.sqrt().copysign(f1));
    [(q, f2), (f0, q)].map(|(above, below)| {
        let t = above / (above + below);
        (t > 0.0 && t < 1.0).then_some(t)
    })
}

#[cfg(test)]
mod tests {
    mod bounds;

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
                // For small θ, θ − sin θ·cos θ loses digits. With x = 2θ, it equals (x − sin x)/2,
                // whose series is x³/12 − x⁵/240 + …
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
                // The height of the triangle of chord and control point is 1/cos θ − cos θ, which
                // loses digits for small θ.
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
        assert_eq!(triangle_share(1.0), 2.0 / 3.0);
        // The arc is x·y = 1 from x = 1 to x = k. Its tangents meet at (2k, 2)/(k + 1), and w² = (k
        // + 1)²/4k.
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
        assert!((triangle_share(1e200) - 1.0).abs() < 1e-15);
        assert!((triangle_share(1e-200) / 1e-200 - PI / 2.0).abs() < 1e-15);
    }

    #[test]
    fn the_formulas_meet() {
        for edge in [NEAR_PARABOLA, -NEAR_PARABOLA] {
            let w = (1.0 - edge).sqrt();
            let [below, above] = [1.0 - 1e-13, 1.0 + 1e-13].map(|by| triangle_share(w * by));
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
