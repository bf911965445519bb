//! What a board's forms say of the floor: how deep it is, from their inverse.

use std::array;

use super::board::{Sum, UNIT};
use super::inverse::Inverse;
use crate::math::{Double, Real};

/// Forms whose determinant is known to no more than this part of it are made more independent, by this part of one of them.
const DEPENDENT: f64 = 1e-6;
const NUDGE: f64 = UNIT / (1 << 23) as f64;

/// A board's forms N_a, N_b and L in double-double, or next to them.
#[derive(Clone, Debug)]
pub(super) struct Fine {
    pub forms: [[Double; 3]; 3],
    /// The forms as they were given.
    pub given: [[Double; 3]; 3],
    /// How far the values of each may be from the true ones.
    pub rads: [f64; 3],
    pub floor: Floor,
    /// By how much more or less than the true ones they are on purpose, as a part of what rounding them once may be.
    pub nudge: f64,
    /// Whether rounded forms would not do, and whether better ones than these would do better.
    pub is_needed: bool,
    pub is_doubtful: bool,
}

/// What the inverse of a board's forms says of the floor.
#[derive(Clone, Debug)]
pub(super) struct Floor {
    /// ∂m/∂a and ∂m/∂b.
    pub slope: [f64; 2],
    /// m where a and b are 0.
    pub origin: f64,
    /// K.
    pub density: f64,
    /// K over |∂m/∂a| and over |∂m/∂b|, with bounds relative to them: well known even where K itself is not.
    pub per_slope: [Sum; 2],
    /// How far det M may be from the true one, relative to it.
    uncertain: f64,
    /// How far K may be from that of the very forms, relative to it: these fit the corners that they have been asked for.
    pub misfit: f64,
    /// Whether the floor is seen mirrored: the sign of det M.
    pub handed: f64,
}

impl Fine {
    /// Of forms that rounded ones are as good as.
    pub fn rounded(forms: [[Double; 3]; 3], rads: [f64; 3], floor: Floor) -> Self {
        Self {
            given: forms,
            forms,
            rads,
            floor,
            nudge: 0.0,
            is_needed: false,
            is_doubtful: false,
        }
    }

    /// With the inverse of the forms, divided by 2 to these powers.
    ///
    /// Where even double-double numbers hardly tell the forms from dependent ones, they are made more independent: the one factor that det M
    /// depends on most is changed by much less than a rounding, but by much more than the last digit.
    pub fn new(
        mut forms: [[Double; 3]; 3],
        rads: [f64; 3],
        [of_a, of_b]: [i32; 2],
    ) -> (Self, Inverse) {
        let given = forms;
        let scales = [of_a, of_b, 0];
        let inverse_of = |forms: &[[Double; 3]; 3]| {
            let forms = array::from_fn(|i| forms[i].map(|c| c.scaled(-scales[i])));
            let rad = (0..3).fold(0.0, |rad: f64, i| rad.max(libm::ldexp(rads[i], -scales[i])));
            Inverse::of_fine(&forms, rad)
        };
        let mut inverse = inverse_of(&forms);
        let is_doubtful = inverse.is_doubtful();
        let mut nudge = 0.0;
        if inverse.det_off > DEPENDENT {
            let [form, factor] = inverse.strongest();
            let sense = inverse.det.signum() * inverse.columns[form][factor].signum();
            let step = libm::ldexp(NUDGE * sense, scales[form]);
            forms[form][factor] = forms[form][factor].plus(&Double::from_f64(step));
            nudge = NUDGE / UNIT;
            inverse = inverse_of(&forms);
        }
        let fine = Self {
            forms,
            given,
            rads,
            floor: Floor::new(&inverse, [of_a, of_b]),
            nudge,
            is_needed: true,
            is_doubtful,
        };
        (fine, inverse)
    }
}

impl Floor {
    /// Of the inverse of forms of which those of a and b have been divided by 2 to these powers.
    pub fn new(inverse: &Inverse, [of_a, of_b]: [i32; 2]) -> Self {
        let Inverse { columns, det, .. } = inverse;
        let third = |column: usize, exponent: i32| libm::ldexp(columns[column][2] / det, -exponent);
        let per_slope = |column: usize, exponent: i32| Sum {
            value: libm::ldexp(1.0 / columns[column][2].abs(), -exponent),
            bound: inverse.minors_off[column],
        };
        Self {
            slope: [third(0, of_a), third(1, of_b)],
            origin: third(2, 0),
            density: libm::ldexp(1.0 / det.abs(), -of_a - of_b),
            per_slope: [per_slope(0, of_b), per_slope(1, of_a)],
            uncertain: inverse.det_off,
            misfit: inverse.det_misfit,
            handed: det.signum(),
        }
    }

    /// How far the inverse of ∂m/∂a or of ∂m/∂b may be from the true one: that is known even where those may have any size.
    pub fn flat(&self, axis: usize) -> f64 {
        let minor = self.per_slope[axis].bound;
        (self.uncertain + minor + 4.0 * UNIT) / self.slope[axis].abs()
    }
}
