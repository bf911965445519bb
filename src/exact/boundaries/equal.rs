//! Curves that are one: of objects in one plane, or side by side, many are.
//!
//! In: the curves of a sub-pixel. Out: the same without repetitions. Two are one if their forms, divided by the leading factor, differ by no more
//! than roundings; the one that is left takes over the other's error and the difference.

use crate::{
    math::{Double, Real},
    tracer::{Conic, Curve, Line},
};

/// Lines are one if no factor of their forms differs by more than this: each is divided, and so rounded twice, on both sides.
const SAME_LINE: f64 = 4.0 * f64::UNIT;

/// Conics are if their forms differ nowhere in the pixel by more than this: six differences of two products have 18 roundings, and the factors 12.
const SAME_CONIC: f64 = 32.0 * Double::UNIT;

/// A curve by its form divided by the leading factor: those of equal curves are the same.
struct Scaled<'a> {
    /// Which of the curves it is.
    at: usize,
    curve: &'a Curve,
    /// The leading factor's place.
    leading: usize,
    /// The form, rounded.
    form: [f64; 6],
}

/// Leaves one of the curves that are equal. What it is off is as much as it was of any of them.
pub(super) fn merge(curves: &mut Vec<Curve>) {
    if curves.len() < 2 {
        return;
    }
    let mut rads: Vec<f64> = curves.iter().map(Curve::rad).collect();
    let mut is_left_out = vec![false; curves.len()];
    let scaled = curves.iter().enumerate();
    let mut scaled: Vec<_> = scaled
        .filter_map(|(at, curve)| Scaled::new(at, curve))
        .collect();
    scaled.sort_by(|a, b| {
        a.leading
            .cmp(&b.leading)
            .then(a.last().total_cmp(&b.last()))
    });
    let mut kept: Vec<&Scaled> = Vec::with_capacity(scaled.len());
    for one in &scaled {
        let mut near = kept.iter().rev().take_while(|other| {
            other.leading == one.leading && one.last() - other.last() <= SAME_LINE
        });
        let same = near.find_map(|other| Some((other.at, one.rad_from(other)?)));
        let Some((other, rad)) = same else {
            kept.push(one);
            continue;
        };
        is_left_out[one.at] = true;
        rads[other] = rads[other].max(rad);
    }
    for (curve, rad) in curves.iter_mut().zip(rads) {
        curve.set_rad(rad);
    }
    let mut left_out = is_left_out.into_iter();
    curves.retain(|_| left_out.next() != Some(true));
}

impl<'a> Scaled<'a> {
    /// None of a form without a leading factor.
    fn new(at: usize, curve: &'a Curve) -> Option<Self> {
        let (factors, candidates) = match curve {
            // A line's direction leads it.
            Curve::Line(Line {
                factors: [a, b, c], ..
            }) => ([*a, *b, 0.0, 0.0, 0.0, *c], 0..2),
            Curve::Conic(conic) => (conic.factors.map(|factor| factor.hi), 0..6),
        };
        let size = |i: &usize| factors[*i].abs();
        let leading = candidates.max_by(|i, j| size(i).total_cmp(&size(j)))?;
        let form = factors.map(|factor| factor / factors[leading]);
        form.iter()
            .all(|factor| factor.is_finite())
            .then_some(Self {
                at,
                curve,
                leading,
                form,
            })
    }

    fn last(&self) -> f64 {
        self.form[5]
    }

    /// If another curve is the same as this, how far that one's form may be from the true one of this.
    fn rad_from(&self, other: &Self) -> Option<f64> {
        let pairs = || self.form.iter().zip(&other.form);
        if pairs().any(|(a, b)| (a - b).abs() > SAME_LINE) {
            return None;
        }
        // No factor is multiplied by more than 1 in the pixel.
        let (by, other_by, off) = match (self.curve, other.curve) {
            (Curve::Line(one), Curve::Line(another)) => {
                let off =
                    pairs().map(|(a, b)| (a - b).abs() + 2.0 * f64::UNIT * (a.abs() + b.abs()));
                (
                    one.factors[self.leading],
                    another.factors[self.leading],
                    off.sum(),
                )
            }
            (Curve::Conic(one), Curve::Conic(another)) => {
                let (p, q) = (&one.factors[self.leading], &another.factors[self.leading]);
                let products = one.factors.iter().zip(&another.factors);
                let off = products.map(|(a, b)| a.times(q).minus(&b.times(p)).hi.abs());
                let off = off.sum::<f64>() / (p.hi * q.hi).abs();
                if off > SAME_CONIC {
                    return None;
                }
                (p.hi, q.hi, off + SAME_CONIC)
            }
            _ => return None,
        };
        Some((self.curve.rad() / by.abs() + off) * other_by.abs())
    }
}

impl Curve {
    fn rad(&self) -> f64 {
        match self {
            Self::Line(Line { rad, .. }) | Self::Conic(Conic { rad, .. }) => *rad,
        }
    }

    fn set_rad(&mut self, new: f64) {
        match self {
            Self::Line(Line { rad, .. }) | Self::Conic(Conic { rad, .. }) => *rad = new,
        }
    }
}
