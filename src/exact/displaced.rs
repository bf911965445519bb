//! By how much roundings may change what a polygon shows of the board.

use glam::DVec2;

use super::{
    board::{Board, UNIT, form, measure, size},
    inverse::Inverse,
};

/// A displacement of no more area than this is not looked at closely.
const LITTLE: f64 = 1e-14;
/// Nor one of no more than this line by line.
const SMALL: f64 = 1e-13;

impl Board {
    /// By how much rounding may change what a polygon shows of the board: the displacement of its boundary.
    ///
    /// A displacement v = M⁻¹e by errors e of the forms has L(v) = e_L: near the horizon points hardly move across it,
    /// however far they may move along it in the widest of views.
    pub(super) fn displaced(&self, points: impl Iterator<Item = DVec2> + Clone) -> f64 {
        let (_, perimeter) = measure(points.clone());
        let anyhow = self.displacement * perimeter;
        if anyhow <= LITTLE {
            return anyhow;
        }
        let level = points
            .clone()
            .fold(0.0, |m: f64, p| m.max(form(&self.below, p)));
        let [least, more] = self.upwards;
        let across = (least + more * level).min(self.displacement);
        let mut before = points.clone().last().unwrap_or_default();
        let sides = points.fold(0.0, |sum, point| {
            let step = point - before;
            before = point;
            let [along, up] = [self.horizon.dot(step), self.horizon.perp_dot(step)].map(f64::abs);
            sum + across * along + self.displacement * up
        });
        anyhow.min(sides)
    }

    /// The same, or less: line by line of the board, which counts in the widest of views, where the forms of a and b are so
    /// nearly parallel that points are displaced far along them, but no line is.
    ///
    /// Let corners be off by e_a, e_b and e_L of the forms, and what is between them by what is between. Moving every point up by
    /// e_L/|∇L| is the same as to change L by e_L, and N by e_L·(∇N·∇L)/|∇L|². On any straight way up e_L grows and falls as
    /// often as sides of triangles between corners are crossed, so that the motion changes the integral by up to
    /// 2·corners·E_L/|∇L| for every 1 of width. N that is off by up to E changes the signs of points where |N − iL| ≤ E, a strip
    /// along the line i, as wide as 2E/|∇N − i∇L|; that gradient is at least |i − i_0|·|∇L|, and at least |∇N × ∇L|/|∇L|,
    /// where i_0 = ∇N·∇L/|∇L|² is where the eye is, which may be far from all lines that there are, and is mostly between two of them. Lines
    /// beyond 2^60 are all within E of the horizon.
    pub(super) fn blurred(&self, points: impl Iterator<Item = DVec2> + Clone) -> f64 {
        // Of 2^60 lines.
        const MOST: f64 = 100.0;
        let displaced = self.displaced(points.clone());
        if displaced <= SMALL {
            return displaced;
        }
        let off = |form: &[f64; 3]| 8.0 * UNIT * size(form);
        let gradient = |[x, y, _]: [f64; 3]| DVec2::new(x, y);
        let up = gradient(self.below);
        let (steepness, of_l) = (up.length(), off(&self.below));
        let levels = points.clone().map(|p| form(&self.below, p));
        let least = levels.fold(f64::INFINITY, f64::min);
        let strips = self.across.each_ref().map(|across| {
            let n = gradient(*across);
            let middle = n.dot(up) / (steepness * steepness);
            let off = off(across) + of_l * middle.abs();
            let places = points.clone().map(|p| {
                let (n, level) = (form(across, p), form(&self.below, p));
                match level > 0.0 {
                    true => n / level,
                    false => n / 0.0,
                }
            });
            let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| {
                (low.min(t), high.max(t))
            });
            let away = (low - middle).max(middle - high) - 1.0;
            // i_0 is a quotient of |∇N||∇L| at most and |∇L|²: two roundings above, five below, and its own.
            let roundings = 8.0 * UNIT * n.length() / steepness;
            let between = (middle - middle.round()).abs() - roundings;
            // Σ 1/max(|i − i_0|, k), of which those next to i_0 are 3 at most by 1/k, and the others twice a logarithm of their number:
            // a place is off by no more than itself where L is by no more than half of it, and by what N is.
            let k = n.perp_dot(up).abs() / (steepness * steepness);
            let number = 2.0 * (low.abs() + high.abs()) + 4.0 * off / least + 4.0;
            let others = match least > 2.0 * of_l {
                true => (2.0 + 2.0 * libm::log(number)).min(MOST),
                false => MOST,
            };
            4.0 * off * (3.0 / k.max(away).max(between).min(1.0) + others)
        });
        let (_, perimeter) = measure(points.clone());
        let widest = 0.5 * perimeter / steepness;
        let lines = widest * (2.0 * points.count() as f64 * of_l + strips[0] + strips[1]);
        displaced.min(lines)
    }
}

/// By how much errors of the forms displace points of the picture, by the inverse of those forms: any way, and across the horizon there and more
/// for every 1 of L. Coordinates themselves are rounded, too.
pub(super) fn displacements(
    errors: &[f64; 3],
    inverse: &Inverse,
    steepness: f64,
) -> (f64, [f64; 2]) {
    // No less than it may be.
    let volume = inverse.det.abs() * (1.0 - inverse.det_off).max(0.0);
    let (mut displacement, mut tilt) = (4.0 * UNIT, 0.0);
    for (error, column) in errors.iter().zip(&inverse.columns) {
        let column = column.map(f64::abs);
        displacement += error * column.iter().sum::<f64>() / volume;
        tilt += error * column[2] / volume;
    }
    let upwards = [errors[2] / steepness + 4.0 * UNIT, tilt / steepness];
    (displacement, upwards)
}
