//! Curves as functions y(x): over a range of x, a line is the graph of one function, and a conic
//! consists of the graphs of two, its branches.
//!
//! In: lines and conics of a sub-pixel. Out: for each line or branch over a range of x, a
//! [`Section`] and its error bound. A section is a chord, or an arc that has the branch's tangents
//! at its ends. If the rounding errors of `f64` are too large for an arc, its ends and tangents are
//! computed in double-double.

use glam::DVec2;

use crate::{
    math::{Double, Real},
    tracer::{BoundaryLine, Conic},
};

use super::conic_segment::Arc;

/// Maximum error of an arc's area, as computed in `f64`, divided by the arc's width in pixels.
/// Above it, the arc is computed again in double-double. With this value, all arcs of a curve
/// across the pixel contribute at most 4e-15 square pixels to the error, far below the default
/// tolerance of 9e-10.
const ARC_TOLERANCE: f64 = 32.0 * f64::UNIT;

/// Maximum |dy/dx| of a line that is treated as a function y(x). A steeper line is treated as
/// vertical, because its x changes by less than eight unit roundoffs across the pixel.
const MAX_SLOPE: f64 = (1u64 << 50) as f64;

/// Relative distance from the pixel beyond which a branch of a conic (one of its two functions
/// y(x)) is ignored. The unit is the branch's largest |y|, but at least one pixel. The value is
/// millions of times the rounding errors of y, so that no branch inside the pixel is ignored.
const OUTSIDE_MARGIN: f64 = 1.0 / (1u64 << 30) as f64;

/// A curve as a function y(x).
#[derive(Clone, Copy, Debug)]
pub enum Track<'a> {
    /// A horizontal line, y = const.
    Level(f64),
    /// A line that is not vertical, y = slope·x + start.
    Line {
        /// Slope dy/dx.
        slope: f64,
        /// Value of y at x = 0.
        start: f64,
    },
    /// One of the two functions of a conic: its upper or lower branch.
    Branch {
        /// The conic.
        graph: &'a ConicGraph,
        /// Sign of the square root in the branch's formula y = (−b ± √Δ)/C ([`ConicGraph`]): 1 or
        /// −1.
        side: f64,
    },
}

/// A conic Ax² + 2Bxy + Cy² + 2Dx + 2Ey + F = 0 as two functions of x, its branches:
///
/// y = (−b ± √Δ)/C with b = Bx + E, Δ = b² − C·g, g = Ax² + 2Dx + F
#[derive(Clone, Copy, Debug)]
pub struct ConicGraph {
    factors: [Double; 6],
    /// Coefficients of x², 2x and 1 in Δ, the polynomial in x under the root in the formula for y.
    delta: [Double; 3],
}

/// The two functions y(x) of a conic over a range of x.
#[derive(Debug)]
pub struct ConicSpan<'a> {
    graph: &'a ConicGraph,
    /// Values of x at the left end, in the middle and at the right end of the range.
    x: [f64; 3],
    /// Values of √Δ in the formula y = (−b ± √Δ)/C ([`ConicGraph`]), at the left end, in the middle
    /// and at the right end of the range of x.
    roots: [f64; 3],
}

/// Approximation of a [`Track`] over a range of x: its chord, or an arc with the same ends and end
/// tangents.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// Values of y at the left end, in the middle and at the right end of the range.
    pub y: [f64; 3],
    /// The arc, and the side to which it bulges: 1 for greater y, −1 for smaller y. `None` if the
    /// section is straight.
    pub arc: Option<(f64, Arc)>,
    /// Maximum distance in y between the curve ([`Track`]) and this approximation.
    pub error: f64,
}

impl ConicGraph {
    /// Derives the two functions of a conic.
    pub fn new(conic: &Conic) -> Self {
        let [a, b, c, d, e, f] = conic.factors;
        let minor = |p: Double, q: Double, r: Double, s: Double| p.times(&q).minus(&r.times(&s));
        Self {
            factors: conic.factors,
            delta: [minor(b, b, a, c), minor(b, e, c, d), minor(e, e, c, f)],
        }
    }

    /// Returns the values of x inside the pixel at which the conic has a vertical tangent. Its two
    /// functions y(x) begin or end there.
    pub fn ends(&self) -> impl Iterator<Item = f64> {
        let [p, q, r] = self.delta;
        // Δ, the polynomial under the root in the formula for y, is px² + 2qx + r. Its zeros are
        // computed without cancellation.
        let discriminant = q.times(&q).minus(&p.times(&r));
        let roots = (discriminant.hi >= 0.0).then(|| {
            let root = discriminant.sqrt().hi;
            let sum = -(q.hi + root.copysign(q.hi));
            [sum / p.hi, r.hi / sum]
        });
        roots.into_iter().flatten().filter(|x| x.abs() < 0.5)
    }

    /// Returns √Δ, the root in the conic's formula for y ([`ConicGraph`]), at `x`. Returns 0 if Δ
    /// is negative.
    fn root(&self, x: f64) -> f64 {
        let [p, q, r] = &self.delta;
        let at = Double::from_f64(x);
        let twice = q.plus(q);
        let delta = p.times(&at).plus(&twice).times(&at).plus(r);
        delta.hi.max(0.0).sqrt()
    }

    /// Returns the conic's two functions y(x) over the range of x from `left` to `right`. Returns
    /// `None` if the conic has no point at the middle x.
    pub fn span(&self, left: f64, right: f64) -> Option<ConicSpan<'_>> {
        let x = [left, 0.5 * (left + right), right];
        let middle = self.root(x[1]);
        (middle > 0.0).then(|| ConicSpan {
            graph: self,
            x,
            roots: [self.root(left), middle, self.root(right)],
        })
    }

    /// Returns the value y(x) of the conic's branch with the sign `side` (1 or −1). `root` is the
    /// value of √Δ ([`ConicGraph`]) at `x`.
    fn y(&self, x: f64, root: f64, side: f64) -> f64 {
        let [a, b, c, d, e, f] = &self.factors;
        let root = root * side;
        let at = Double::from_f64(x);
        let minus = b.times(&at).plus(e).negated().hi;
        // In exact arithmetic, (−b ± √Δ)/C and g/(−b ∓ √Δ) give the same y (`ConicGraph`). The
        // formula in which nothing cancels is used. If the computed Δ is 0, nothing cancels in
        // either formula. The exact Δ may then be slightly negative, because x is rounded at the
        // end of a branch. Only the first formula is then accurate: it gives −b/C.
        if minus * side >= 0.0 || root == 0.0 {
            (minus + root) / c.hi
        } else {
            let twice = d.plus(d);
            let g = a.times(&at).plus(&twice).times(&at).plus(f);
            g.hi / (minus - root)
        }
    }

    /// Returns the point at `x` of the conic's branch with the sign `side` (1 or −1), computed in
    /// double-double. Also returns the root ±√Δ ([`ConicGraph`]) there, with the same sign.
    fn end_in_double(&self, x: f64, side: f64) -> ArcEnd<Double> {
        let [a, b, c, d, e, f] = &self.factors;
        let [p, q, r] = &self.delta;
        let at = Double::from_f64(x);
        let quadratic = |square: &Double, half: &Double, one: &Double| {
            square
                .times(&at)
                .plus(&half.plus(half))
                .times(&at)
                .plus(one)
        };
        let delta = quadratic(p, q, r);
        let root = if delta.is_negative() {
            Double::from_f64(0.0)
        } else {
            delta.sqrt()
        };
        let root = if side < 0.0 { root.negated() } else { root };
        let minus = b.times(&at).plus(e).negated();
        let y = if minus.hi * side >= 0.0 || root.hi == 0.0 {
            minus.plus(&root).over(c)
        } else {
            quadratic(a, d, f).over(&minus.minus(&root))
        };
        ArcEnd { at: [at, y], root }
    }
}

impl<'a> ConicSpan<'a> {
    /// Returns the conic's branch with the sign `side` (1 or −1) as a function y(x) ([`Track`]),
    /// and an arc or chord that approximates it ([`Section`]). Returns `None` if the branch is not
    /// finite or lies outside the pixel. The section is `None` if the branch turns too much to be
    /// represented by one arc; the caller then halves the range.
    pub fn branch(&self, side: f64) -> Option<(Track<'a>, Option<Section>)> {
        let Self { graph, x, roots } = self;
        let y = [0, 1, 2].map(|i| graph.y(x[i], roots[i], side));
        if !y[1].is_finite() {
            return None;
        }
        // If the branch is curved in one direction only, its distance from the chord is at most
        // twice `sagitta`, the distance in the middle. So if its two ends and its middle are all
        // outside the pixel by more than twice `sagitta`, the whole branch is outside.
        let sagitta = y[1] - 0.5 * (y[0] + y[2]);
        let size = y.iter().fold(1.0, |size: f64, y| size.max(y.abs()));
        let beyond = 0.5 + 2.0 * sagitta.abs() + OUTSIDE_MARGIN * size;
        if y.iter().all(|y| *y > beyond) || y.iter().all(|y| *y < -beyond) {
            return None;
        }
        let straight = Section::straight(y);
        let (start, end) = (DVec2::new(x[0], y[0]), DVec2::new(x[2], y[2]));
        let width = end.x - start.x;
        let section = match self.arc([start, end], side) {
            Some((arc, off)) => {
                let bulge = 1f64.copysign((end - start).perp_dot(arc.control - start));
                Some(Section {
                    arc: Some((bulge, arc)),
                    error: off / width,
                    ..straight
                })
            }
            // A branch may be so flat that rounding errors prevent the computation of an arc. It is
            // treated as straight if the distance between its middle and the chord is at most the
            // rounding error `flat`: six roundings of each y, and two of the mean of two y.
            None => {
                let flat = 8.0 * f64::UNIT * (1.0 + y[0].abs() + y[2].abs());
                (sagitta.abs() <= flat).then_some(Section {
                    error: 2.0 * sagitta.abs() + flat,
                    ..straight
                })
            }
        };
        Some((Track::Branch { graph, side }, section))
    }

    /// Returns the arc with the ends `ends` and the end tangents of the conic's branch with the
    /// sign `side` (1 or −1), and an error bound of the area between arc and chord. Returns `None`
    /// if the tangents do not intersect between the ends, or if the arc turns by more than 120°.
    fn arc(&self, ends: [DVec2; 2], side: f64) -> Option<(Arc, f64)> {
        let Self { graph, roots, .. } = self;
        let [start, end] = ends;
        let factors = graph.factors.map(|factor| factor.hi);
        let rounded = [(start, roots[0]), (end, roots[2])].map(|(at, root)| ArcEnd {
            at: [at.x, at.y],
            root: side * root,
        });
        let mut tangents = Tangents::new(&factors, &rounded);
        // If the conic is almost a line, its gradient in `f64` is hardly more than rounding error.
        // The tangents are then computed again in double-double.
        let is_good = tangents.off <= ARC_TOLERANCE * (end.x - start.x);
        if !is_good {
            let ends = ends.map(|at| graph.end_in_double(at.x, side));
            tangents = Tangents::new(&graph.factors, &ends);
        }
        let Tangents { control, w2, off } = tangents;
        let arc = Arc {
            start,
            control: start + control,
            end,
            weight: w2.sqrt(),
        };
        // Minimum weight of an arc, and the reciprocal of the maximum. For a circle, the weight is
        // the cosine of half the arc's turn, so a weight below 1/2 means a turn of more than 120°.
        // An arc beyond these limits is rejected, and the caller halves it.
        const MIN_WEIGHT: f64 = 0.5;
        let turns_little = arc.weight > MIN_WEIGHT && arc.weight < 1.0 / MIN_WEIGHT;
        (control.x >= 0.0 && control.x <= end.x - start.x && turns_little).then_some((arc, off))
    }
}

/// A point of a conic on one of its two branches, and the root ±√Δ ([`ConicGraph`]) there, with the
/// sign of the branch. The root is half of the y component of the conic's gradient at the point.
struct ArcEnd<T> {
    at: [T; 2],
    root: T,
}

/// The control point of an arc of a conic: the intersection of the tangents at its two ends.
struct Tangents {
    /// Position of the control point relative to the arc's start.
    control: DVec2,
    /// Square of the arc's weight. If the arc is written as a rational quadratic Bézier curve whose
    /// end points have the weight 1, the weight of its control point is the arc's weight.
    w2: f64,
    /// Maximum error of the area between the arc and its chord.
    off: f64,
}

impl Tangents {
    /// Intersects the tangents of the conic with the coefficients `factors` at the points `ends`,
    /// and bounds the error of the area between the arc and its chord.
    fn new<T: Real<Radius = f64>>(factors: &[T; 6], ends: &[ArcEnd<T>; 2]) -> Self {
        // The area between arc and chord is part of the triangle of the chord and the two tangents.
        // It has an error from the tangents' directions and one from the arc's weight.
        //
        // Directions: let κ be 1 plus the sum of the absolute values of the terms of the conic's
        // gradient, divided by the gradient's length. The gradient has a relative error of κ
        // roundings, so a tangent's direction has an error of κ roundings, in radians. If a side of
        // length l turns by a small angle φ, the triangle's area changes by at most l²·φ/2. The
        // area between arc and chord changes no more.
        //
        // Weight: its square is the quotient of two values of the conic's quadratic part Q. Each
        // value of Q has two errors: the roundings of its terms, and the error of its argument, a
        // vector. The area between arc and chord grows no faster than the weight. An error of √Δ
        // (`ConicGraph`) is not included: it moves points and tangents together, like an error of
        // the conic itself.
        let [a, b, c, d, ..] = factors;
        let product = |[x, y]: &[T; 2], [z, w]: &[T; 2]| x.times(z).plus(&y.times(w));
        let length = |[x, y]: &[T; 2]| libm::hypot(x.to_f64(), y.to_f64());
        let gradients = ends.each_ref().map(|ArcEnd { at: [x, y], root }| {
            let by_x = a.times(x).plus(&b.times(y)).plus(d);
            [by_x, root.clone()]
        });
        let kappa = [0, 1].map(|i| {
            let [x, y] = ends[i].at.each_ref().map(Real::magnitude);
            let terms = a.magnitude() * x + b.magnitude() * y + d.magnitude();
            1.0 + terms / length(&gradients[i])
        });
        let kappa = kappa[0].max(kappa[1]);
        // Returns Q(v), the conic's quadratic part at the vector `v`, and the relative error of
        // Q(v) in roundings. `off` is the relative error of `v` in roundings.
        let quadratic = |v: &[T; 2], off: f64| {
            let half = [
                product(&[a.clone(), b.clone()], v),
                product(&[b.clone(), c.clone()], v),
            ];
            let value = product(v, &half).to_f64();
            let [x, y] = v.each_ref().map(Real::magnitude);
            let [a, b, c] = [a, b, c].map(Real::magnitude);
            let terms = [a * x + b * y, b * x + c * y];
            let by_vector = length(&half) + 4.0 * T::UNIT * (terms[0] + terms[1]);
            let all = x * terms[0] + y * terms[1] + 2.0 * by_vector * off;
            (value, all / value.abs())
        };
        let [[x, y], [far_x, far_y]] = ends.each_ref().map(|end| &end.at);
        let chord = [far_x.minus(x), far_y.minus(y)];
        let [here, there] = &gradients;
        // The control point is the intersection of two tangents: `along` is a vector along the
        // tangent at the start, and `way` times this vector leads to the tangent at the end.
        let along = [here[1].negated(), here[0].clone()];
        let way = product(there, &chord).over(&product(there, &along));
        let control = along.map(|x| x.times(&way));
        let (of_chord, chord_off) = quadratic(&chord, 1.0);
        let (of_control, control_off) = quadratic(&control, kappa * length(&control));
        let other = [0, 1].map(|i| chord[i].minus(&control[i]));
        let legs = length(&control) * length(&control) + length(&other) * length(&other);
        let [[control_x, control_y], [chord_x, chord_y]] =
            [&control, &chord].map(|v| v.each_ref().map(Real::to_f64));
        let triangle = 0.5 * (control_x * chord_y - control_y * chord_x).abs();
        Self {
            control: DVec2::new(control_x, control_y),
            w2: of_chord / (4.0 * of_control),
            off: 4.0 * T::UNIT * (kappa * legs + triangle * (chord_off + control_off)),
        }
    }
}

impl Track<'_> {
    /// Returns a line as a function y(x). Returns `None` if the line is vertical or steeper than
    /// [`MAX_SLOPE`].
    pub fn of_line(line: &BoundaryLine) -> Option<Self> {
        let [a, b, c] = line.factors;
        let (slope, start) = (-a / b, -c / b);
        (slope.abs() <= MAX_SLOPE && start.is_finite()).then_some(Self::Line { slope, start })
    }

    /// Computes y of the curve at `x`. If the curve is a branch of a conic, the branch must have a
    /// point at `x`.
    pub fn y(&self, x: f64) -> f64 {
        match self {
            Self::Level(y) => *y,
            Self::Line { slope, start } => slope * x + start,
            Self::Branch { graph, side } => graph.y(x, graph.root(x), *side),
        }
    }

    /// Returns the chord of the curve from x = `left` to x = `right`.
    pub fn straight(&self, left: f64, right: f64) -> Section {
        Section::straight([left, 0.5 * (left + right), right].map(|x| self.y(x)))
    }
}

impl Section {
    /// Returns a chord with the given y at the left end, in the middle, and at the right end.
    pub fn straight(y: [f64; 3]) -> Self {
        Self {
            y,
            arc: None,
            error: 0.0,
        }
    }

    /// Returns a bound of the curve's y at `x`: an upper bound if `up` is 1, and a lower bound if
    /// `up` is −1. On the side to which the arc bulges, the bound follows the arc's two end
    /// tangents; on the other side, it follows the chord. The approximation error is included. `x`
    /// must be `left`, `right`, or the x of a control point.
    fn hull(&self, up: f64, x: f64, left: f64, right: f64) -> f64 {
        let chord = |a: DVec2, b: DVec2| {
            if b.x > a.x {
                a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x)).clamp(0.0, 1.0)
            } else {
                up * (up * a.y).max(up * b.y)
            }
        };
        let (start, end) = (DVec2::new(left, self.y[0]), DVec2::new(right, self.y[2]));
        let at = match &self.arc {
            Some((bulge, arc)) if *bulge == up => {
                if x <= arc.control.x {
                    chord(start, arc.control)
                } else {
                    chord(arc.control, end)
                }
            }
            _ => chord(start, end),
        };
        at + up * self.error
    }

    /// Returns an upper bound of this curve's y minus that of `other` over the range of x from
    /// `left` to `right`. If the bound is negative, this curve is certainly below `other`.
    pub fn overlap(&self, other: &Self, left: f64, right: f64) -> f64 {
        let controls = [self, other].map(|section| section.arc.map(|(_, arc)| arc.control.x));
        let places = [Some(left), controls[0], controls[1], Some(right)];
        // The bounds of both curves are linear in x between the ends and the control points, so
        // that their difference is greatest at one of these x.
        let hulls = places
            .into_iter()
            .flatten()
            .map(|x| self.hull(1.0, x, left, right) - other.hull(-1.0, x, left, right))
            .fold(f64::NEG_INFINITY, f64::max);
        let rise = self.parallel_bounds(other).map(|[rise, _]| rise);
        hulls.min(rise.unwrap_or(f64::INFINITY))
    }

    /// Returns two bounds for arcs over the same range of x: how far this arc rises above `other`,
    /// and how far the two are apart in y. Returns `None` unless both curves are arcs that bulge to
    /// the same side. The bounds are tight if the arcs are nearly parallel or nearly coincide.
    fn parallel_bounds(&self, other: &Self) -> Option<[f64; 2]> {
        // Compares points of the two arcs with the same curve parameter. The height of a vector is
        // its y minus that of the vector along this arc's chord with the same x. If the weights are
        // equal, a point is the same weighted mean of the control points in each arc. The height
        // between the points is then at most that between two control points. Unequal weights move
        // a point by at most their difference times the length of a side of the control polygon. A
        // difference in x changes y by at most its product with the steepest slope.
        //
        // Rounding errors move a point by less than the sum of two terms. The first is eight times
        // the error of the arc's area, divided by the arc's width. The second is the rounding error
        // of x, times the slope of the steepest tangent. The second is needed because rounding may
        // move the control point of a narrow arc along the arc, which hardly changes the area.
        let ((up, a), (other_up, b)) = (self.arc.as_ref()?, other.arc.as_ref()?);
        if up != other_up {
            return None;
        }
        let chord = a.end - a.start;
        let slope = chord.y / chord.x;
        let height = |step: DVec2| step.y - slope * step.x;
        let legs = [a, b].map(|arc| [arc.control - arc.start, arc.end - arc.control]);
        let legs = legs.as_flattened();
        let most =
            |of: &dyn Fn(DVec2) -> f64| legs.iter().map(|&leg| of(leg).abs()).fold(0.0, f64::max);
        let (steepest, tallest) = (most(&|leg| height(leg) / leg.x), most(&height));
        let size = legs.iter().map(|leg| leg.length()).fold(0.0, f64::max);
        let weights = (a.weight - b.weight).abs();
        let aside = (a.control.x - b.control.x).abs() + weights * size;
        // The bound includes the rounding errors of about twenty operations in the points of each
        // arc and in the chord from which heights are measured.
        let rounding = 64.0 * f64::UNIT * (1.0 + size + slope.abs() * aside);
        let off = weights * tallest
            + (aside + rounding) * steepest
            + rounding
            + 8.0 * (self.error + other.error);
        let heights = [a.start - b.start, a.control - b.control, a.end - b.end].map(height);
        let rise = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let apart = heights.into_iter().map(f64::abs).fold(0.0, f64::max);
        Some([rise + off, apart + off])
    }

    /// Returns the integral of y over x from `left` to `right`, which must be the ends of the
    /// curve.
    pub fn integral(&self, left: f64, right: f64) -> f64 {
        let chord = 0.5 * (right - left) * (self.y[0] + self.y[2]);
        chord + self.arc.map_or(0.0, |(bulge, arc)| bulge * arc.area())
    }

    /// Returns an upper bound of the distance in y between two curves over the same range of x.
    /// Returns infinity unless both are straight or both are arcs that bulge to the same side. The
    /// bound is tight if the curves are nearly equal.
    pub fn distance(&self, other: &Self) -> f64 {
        let ends = (self.y[0] - other.y[0])
            .abs()
            .max((self.y[2] - other.y[2]).abs());
        match (&self.arc, &other.arc) {
            (None, None) => ends,
            (Some(_), Some(_)) => self
                .parallel_bounds(other)
                .map_or(f64::INFINITY, |[_, apart]| apart),
            _ => f64::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests;
