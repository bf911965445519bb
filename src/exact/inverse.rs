//! The inverse of a board's three forms, which says how deep a point of the floor is.

use super::board::UNIT;
use crate::math::{Double, Real, two_product};

/// A linear form c0·x + c1·y + c2.
type Form<T> = [T; 3];

/// Forms of about the same size have no smaller determinant.
const LEAST: f64 = 1e-100;

/// An inverse that is off by no more than this part of it is as good as any.
const GOOD: f64 = 1e-13;

/// det M·M⁻¹ and det M, for M of three forms whose largest factors are between 1 and 2.
#[derive(Clone, Debug)]
pub(super) struct Inverse {
    /// The columns of det M·M⁻¹.
    pub columns: [[f64; 3]; 3],
    pub det: f64,
    /// How far the last parts of the first two columns may be from those of the true forms, relative to them.
    pub minors_off: [f64; 2],
    /// The same for det M.
    pub det_off: f64,
    /// How far that may be from det M of the very forms, relative to it.
    pub det_misfit: f64,
}

impl Inverse {
    /// Of forms as they are rounded.
    pub fn of_rounded(rounded: &[Form<f64>; 3]) -> Self {
        let [a, b, l] = rounded;
        let columns = [cross(b, l), cross(l, a), cross(a, b)];
        let det = minors(a, b)
            .iter()
            .zip(l)
            .fold(Double::from_f64(0.0), |sum, ([plus, minus], &l)| {
                sum.plus(&plus.minus(minus).times(&Double::from_f64(l)))
            })
            .to_f64();
        // A factor of a product is off by a rounding each, and what that leaves is rounded.
        Self::with(columns, det, rounded, UNIT)
    }

    /// Of forms in double-double, whose values are off by so much at most.
    pub fn of_fine(forms: &[Form<Double>; 3], rad: f64) -> Self {
        let rounded = forms.map(|form| form.map(|c| c.hi));
        let [a, b, l] = forms;
        let columns = [cross_of(b, l), cross_of(l, a), cross_of(a, b)];
        let det = (0..3).fold(Double::from_f64(0.0), |sum, i| {
            sum.plus(&columns[2][i].times(&l[i]))
        });
        let columns = columns.map(|column| column.map(|c| c.hi));
        Self::with(columns, det.hi, &rounded, Double::UNIT + 8.0 * rad)
    }

    /// Whether no better forms are needed.
    pub fn is_good(&self) -> bool {
        let [of_a, of_b] = self.minors_off;
        of_a.max(of_b).max(self.det_off) <= GOOD
    }

    /// Whether better forms would make it better.
    pub fn is_doubtful(&self) -> bool {
        self.det_off > GOOD
    }

    /// The factor, of which form and which in it, that det M depends on most.
    pub fn strongest(&self) -> [usize; 2] {
        let size = |&[form, factor]: &[usize; 2]| self.columns[form][factor].abs();
        let factors = (0..9).map(|i| [i / 3, i % 3]);
        factors
            .max_by(|a, b| size(a).total_cmp(&size(b)))
            .unwrap_or_default()
    }

    /// With how far each factor may be off and each product of double-double numbers is, relative to it.
    fn with(columns: [Form<f64>; 3], det: f64, [a, b, l]: &[Form<f64>; 3], unit: f64) -> Self {
        // Where nothing is left of it, next to nothing will do: nothing is known of it then.
        let is_singular = det.abs() <= LEAST;
        let det = if is_singular { LEAST } else { det };
        let minor_off = |column: &Form<f64>, form: &Form<f64>| {
            let terms = (form[0] * l[1]).abs() + (form[1] * l[0]).abs();
            3.0 * unit * terms / column[2].abs() + 4.0 * UNIT
        };
        let products: f64 = (0..3)
            .map(|i| {
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                l[i].abs() * ((a[j] * b[k]).abs() + (a[k] * b[j]).abs())
            })
            .sum();
        let off = |unit: f64| match is_singular {
            true => f64::INFINITY,
            false => 8.0 * unit * products / det.abs() + 4.0 * UNIT,
        };
        Self {
            minors_off: [minor_off(&columns[0], b), minor_off(&columns[1], a)],
            det_off: off(unit),
            det_misfit: off(Double::UNIT),
            columns,
            det,
        }
    }
}

/// A cross product, each part to within two roundings of itself.
fn cross(a: &Form<f64>, b: &Form<f64>) -> Form<f64> {
    minors(a, b).map(|[plus, minus]| (plus.hi - minus.hi) + (plus.lo - minus.lo))
}

/// The products, without an error, of which a cross product's parts are the differences.
fn minors(a: &Form<f64>, b: &Form<f64>) -> [[Double; 2]; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| [two_product(a[i], b[j]), two_product(a[j], b[i])])
}

fn cross_of(a: &Form<Double>, b: &Form<Double>) -> Form<Double> {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i].times(&b[j]).minus(&a[j].times(&b[i])))
}
