//! The evaluation of samples, chunk by chunk: loops over plain arrays, which the compiler
//! vectorizes.
//!
//! In: a prepared pixel, and a chunk of its samples. Out: what each sample sees, and how often each
//! colour is seen. For each surface in turn, its boundary forms are evaluated at all samples, then
//! its colour pattern and its depth. A sample is uncertain if a form's value differs from 0 by at
//! most the form's error bound, or if two depths differ by at most their errors. Uncertain samples
//! are traced again one by one.

use multiversion::multiversion;

use super::{
    super::{
        checker_corners::CheckerForms,
        local_form::{LOCAL_ROUNDING, LocalForm, LocalQuadratic, ScaledLine},
    },
    pixel::{
        BACKGROUND, CHUNK_SAMPLES, ColorPattern, DOUBT, Depth, Lanes, PixelSurface, PreparedPixel,
    },
};
use crate::math::{HAS_WIDER, ROUND, SimdWidth, UP};

#[multiversion(targets(
    "x86_64+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+fma+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+fma+lzcnt+popcnt",
))]
fn see_simd(pixel: &mut PreparedPixel, points: At, count: usize) {
    pixel.see(points, count);
}

/// Offsets of samples from the pixel's centre, as one list for each coordinate. The length of a
/// list is a multiple of eight, the number of `f64` in the widest vectors.
pub(super) type At<'a> = [&'a [f64]; 2];

impl PreparedPixel {
    /// Finds what the first `count` samples of a chunk see, counts how often each colour is seen,
    /// and sets `doubts` to the number of uncertain samples.
    pub(super) fn chunk(&mut self, points: At, count: usize, vectors: SimdWidth) {
        match vectors {
            SimdWidth::Widest if HAS_WIDER => see_simd(self, points, count),
            _ => self.see(points, count),
        }
    }

    #[inline(always)]
    fn see(&mut self, points: At, count: usize) {
        let length = points[0].len();
        let lanes = &mut self.lanes;
        match self.surfaces.as_slice() {
            // A single surface that fills the pixel needs no test of its boundary.
            [surface] if surface.edges[0] == surface.edges[1] && surface.conic.is_none() => {
                surface.show(&self.lines, points, &mut lanes.sign, &mut lanes.seen);
            }
            surfaces => {
                lanes.seen[..length].fill(BACKGROUND);
                if self.apart.is_some() {
                    lanes.nearest[..length].fill(f64::NEG_INFINITY);
                }
                for surface in surfaces {
                    let [start, end] = surface.edges;
                    lanes.margin(&self.lines[start..end], surface.conic.as_ref(), points);
                    surface.show(&self.lines, points, &mut lanes.sign, &mut lanes.shown);
                    match self.apart {
                        None => lanes.cover(length),
                        Some(apart) => {
                            lanes.depths(&surface.depth, &self.planes, points);
                            lanes.merge(apart, length);
                        }
                    }
                }
            }
        }
        let mut left = count as u64;
        for color in &mut self.colors {
            if left == 0 {
                break;
            }
            let mut found = 0;
            for (index, &lane) in (0..).zip(&lanes.seen[..length]) {
                found += u64::from((lane == color.code) & (index < count as u64));
            }
            color.count += found;
            left -= found;
        }
        self.doubts = left;
    }
}

impl PixelSurface {
    /// Writes to `shown`, for each sample, the code of the colour that the sample sees if it hits
    /// the surface. Writes [`DOUBT`] if the colour is uncertain.
    #[inline(always)]
    fn show(
        &self,
        lines: &[ScaledLine],
        points: At,
        sign: &mut [f64; CHUNK_SAMPLES],
        shown: &mut [f64; CHUNK_SAMPLES],
    ) {
        let shown = &mut shown[..points[0].len()];
        match &self.pattern {
            ColorPattern::Plain(code) => shown.fill(*code),
            ColorPattern::Lines { end, odd } => {
                let codes = [*odd, !*odd].map(|odd| self.code(odd));
                between(&lines[self.edges[1]..*end], codes, points, sign, shown);
            }
            ColorPattern::Squares(squares) => {
                let codes = [squares.odd, !squares.odd].map(|odd| self.code(odd));
                in_squares(squares, codes, points, shown);
            }
        }
    }
}

/// Writes to `shown` the code `even` for each sample at which an even number of the lines' forms is
/// negative, and the code `odd` for each other sample. Writes [`DOUBT`] if a form's sign is
/// uncertain. `sign` is a buffer for intermediate results.
#[inline(always)]
fn between(
    lines: &[ScaledLine],
    [even, odd]: [f64; 2],
    [x, y]: At,
    sign: &mut [f64; CHUNK_SAMPLES],
    shown: &mut [f64],
) {
    let side = |value: f64| {
        let beyond = if value < -1.0 { odd } else { DOUBT };
        if value > 1.0 { even } else { beyond }
    };
    if let [[a, b, c]] = lines {
        for ((shown, &x), &y) in shown.iter_mut().zip(x).zip(y) {
            *shown = side(a * x + b * y + c);
        }
        return;
    }
    let least = shown;
    let sign = &mut sign[..least.len()];
    sign.fill(1.0);
    least.fill(f64::INFINITY);
    for [a, b, c] in lines {
        let samples = x.iter().zip(y);
        for ((sign, least), (&x, &y)) in sign.iter_mut().zip(&mut *least).zip(samples) {
            let value = a * x + b * y + c;
            *sign *= value;
            let size = value.abs();
            *least = if size < *least { size } else { *least };
        }
    }
    for (&sign, shown) in sign.iter().zip(least) {
        let code = if sign > 0.0 { even } else { odd };
        *shown = if *shown > 1.0 { code } else { DOUBT };
    }
}

/// Writes to `shown`, for each sample, the code of the colour of the square that it hits: `even` or
/// `odd`, by the parity of the square's indices. Writes [`DOUBT`] if the square is uncertain.
#[inline(always)]
fn in_squares(squares: &CheckerForms, [even, odd]: [f64; 2], [x, y]: At, shown: &mut [f64]) {
    const ONE: u64 = 1.0f64.to_bits();
    let LocalForm { factors: l, rad } = squares.denominator;
    let [n0, n1] = squares.numerators.map(|across| across.factors);
    let rads = squares.numerators.map(|across| across.rad);
    for ((shown, &x), &y) in shown.iter_mut().zip(x).zip(y) {
        let below = l[0] * x + l[1] * y + l[2];
        let inverse = 1.0 / below;
        let double = 2.0 * UP * inverse;
        let square = |n: [f64; 3], own: f64| {
            let value = (n[0] * x + n[1] * y + n[2]) * inverse;
            // Let N/ℓ be the computed coordinate, and let N' and ℓ' be the true values of its
            // numerator and denominator. Then |N'/ℓ' − N/ℓ| ≤ (|N' − N| + |N/ℓ|·|ℓ' − ℓ|)/ℓ'. ℓ' is
            // at least ℓ/2, because a sample is marked uncertain unless ℓ exceeds twice its error
            // bound.
            let error = (own + value.abs() * rad) * double + (value.abs() + 1.0) * LOCAL_ROUNDING;
            let middle = value - 0.5;
            let rounded = middle + ROUND;
            let margin = 0.5 - (middle - (rounded - ROUND)).abs();
            (rounded.to_bits(), margin - error * UP)
        };
        let ((bits0, margin0), (bits1, margin1)) = (square(n0, rads[0]), square(n1, rads[1]));
        let parity = f64::from_bits(ONE | (bits0 ^ bits1) << 63);
        let code = if parity > 0.0 { even } else { odd };
        // A coordinate may be NaN, or too large to be rounded by adding `ROUND`. Its error bound is
        // then NaN or large, so the comparisons are false, and the sample is uncertain.
        let first = if margin0 > 0.0 { code } else { DOUBT };
        let second = if margin1 > 0.0 { first } else { DOUBT };
        *shown = if below > 2.0 * UP * rad {
            second
        } else {
            DOUBT
        };
    }
}

impl Lanes {
    /// Stores in `margin`, for each sample, the least value of the forms that bound the surface:
    /// the lines `edges` and a sphere's silhouette `conic`. The forms are already divided by their
    /// error bounds. Therefore, a sample hits the surface if its margin is above 1, misses it if
    /// the margin is below −1, and is uncertain otherwise.
    #[inline(always)]
    fn margin(&mut self, edges: &[ScaledLine], conic: Option<&LocalQuadratic>, [x, y]: At) {
        let margin = &mut self.margin[..x.len()];
        match conic {
            None => margin.fill(f64::INFINITY),
            Some(conic) => {
                for ((margin, &x), &y) in margin.iter_mut().zip(x).zip(y) {
                    *margin = conic.at(x, y);
                }
            }
        }
        for [a, b, c] in edges {
            for ((margin, &x), &y) in margin.iter_mut().zip(x).zip(y) {
                let value = a * x + b * y + c;
                *margin = if value < *margin { value } else { *margin };
            }
        }
    }

    /// Draws the current surface over everything seen so far at the samples that hit the surface.
    /// Samples near the surface's boundary become uncertain.
    #[inline(always)]
    fn cover(&mut self, length: usize) {
        let surface = self.margin[..length].iter().zip(&self.shown[..length]);
        for (seen, (&margin, &shown)) in self.seen[..length].iter_mut().zip(surface) {
            let missed = if margin < -1.0 { *seen } else { DOUBT };
            *seen = if margin > 1.0 { shown } else { missed };
        }
    }

    /// Computes the inverse depths of the current surface at each sample.
    #[inline(always)]
    fn depths(&mut self, depth: &Depth, planes: &[LocalForm], [x, y]: At) {
        let out = &mut self.depth[..x.len()];
        match *depth {
            Depth::Unknown => out.fill(f64::NAN),
            Depth::Least([start, end]) => {
                out.fill(f64::INFINITY);
                for plane in &planes[start..end] {
                    for ((out, &x), &y) in out.iter_mut().zip(x).zip(y) {
                        let value = plane.at(x, y);
                        *out = if value < *out { value } else { *out };
                    }
                }
            }
            Depth::Greatest([start, end]) => {
                out.fill(f64::NEG_INFINITY);
                for plane in &planes[start..end] {
                    for ((out, &x), &y) in out.iter_mut().zip(x).zip(y) {
                        let value = plane.at(x, y);
                        *out = if value > *out { value } else { *out };
                    }
                }
            }
            Depth::Sphere { q, b, factor } => {
                for ((out, &x), &y) in out.iter_mut().zip(x).zip(y) {
                    let q = q.at(x, y);
                    let q = if q > 0.0 { q } else { 0.0 };
                    *out = (b.at(x, y) + q.sqrt()) * factor;
                }
            }
        }
    }

    /// Merges the current surface with what is seen so far: the surface with the greater inverse
    /// depth is seen. `apart` is the minimum difference of inverse depths at which the order is
    /// certain.
    #[inline(always)]
    fn merge(&mut self, apart: f64, length: usize) {
        let surface = self.margin[..length]
            .iter()
            .zip(&self.shown[..length])
            .zip(&self.depth[..length]);
        let so_far = self.seen[..length]
            .iter_mut()
            .zip(&mut self.nearest[..length]);
        for ((seen, nearest), ((&margin, &shown), &depth)) in so_far.zip(surface) {
            let ahead = depth - *nearest;
            let shown = if margin > 1.0 { shown } else { DOUBT };
            let close = if ahead > apart { shown } else { DOUBT };
            let new = if ahead < -apart { *seen } else { close };
            let greatest = if depth > *nearest { depth } else { *nearest };
            *seen = if margin < -1.0 { *seen } else { new };
            *nearest = if margin < -1.0 { *nearest } else { greatest };
        }
    }
}
