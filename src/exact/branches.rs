//! Curves as x-monotone branches: over a range of x, a line is the graph of one function y(x) and a
//! conic that of two.
//!
//! In: lines and conics of a sub-pixel. Out: over a range of x each branch as a chord with an arc
//! between its tangents, and how far the branch may be from that. Where the roundings of `f64`
//! leave too much of an arc in doubt, its ends and tangents are taken in double-double.

use glam::DVec2;

use crate::{
    math::{Double, Real},
    tracer::{BoundaryLine, Conic},
};

use super::conic_segment::Arc;

/// In f64 the area of an arc is good enough if it is off by no more than this for each part of its
/// width: 4e-15 for a pixel, far below what is asked for.
const GOOD: f64 = 32.0 * f64::UNIT;

/// A steeper line is as good as vertical: from one side of the pixel to the other it moves by less
/// than eight roundings of x.
const STEEP: f64 = (1u64 << 50) as f64;

/// A branch is outside of the pixel if it is so far from it by the size of its values: millions of
/// times the roundings that these have.
const OUTSIDE: f64 = 1.0 / (1u64 << 30) as f64;

/// A curve followed from left to right.
#[derive(Clone, Copy, Debug)]
pub enum Track<'a> {
    /// The line y = const.
    Level(f64),
    /// A line that is not vertical: y = slope · x + start.
    Line {
        /// dy/dx.
        slope: f64,
        /// y at x = 0.
        start: f64,
    },
    /// The upper or the lower one of a conic's two functions.
    Branch {
        /// The conic.
        graph: &'a Graph,
        /// 1 or −1: the sign of the root.
        side: f64,
    },
}

/// A conic Ax² + 2Bxy + Cy² + 2Dx + 2Ey + F = 0 as functions: y = (−b ± √Δ)/C with b = Bx + E, Δ =
/// b² − Cg and g = Ax² + 2Dx + F.
#[derive(Clone, Copy, Debug)]
pub struct Graph {
    factors: [Double; 6],
    /// Δ as a polynomial in x: the factors of x², 2x and 1.
    delta: [Double; 3],
}

/// A conic's functions over a range of x.
#[derive(Debug)]
pub struct Span<'a> {
    graph: &'a Graph,
    /// Left, middle and right.
    x: [f64; 3],
    /// √Δ at these.
    roots: [f64; 3],
}

/// A track over a range of x, between its chord and two of its tangents.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// y at the left, in the middle, and at the right.
    pub y: [f64; 3],
    /// The arc, where it is not straight; and 1 if it bulges to greater y, −1 if to smaller.
    pub arc: Option<(f64, Arc)>,
    /// How far it may be from what this says of it.
    pub slack: f64,
}

impl Graph {
    /// The graph of a conic.
    pub fn new(conic: &Conic) -> Self {
        let [a, b, c, d, e, f] = conic.factors;
        let minor = |p: Double, q: Double, r: Double, s: Double| p.times(&q).minus(&r.times(&s));
        Self {
            factors: conic.factors,
            delta: [minor(b, b, a, c), minor(b, e, c, d), minor(e, e, c, f)],
        }
    }

    /// Where its functions begin and end: the x of its vertical tangents.
    pub fn ends(&self) -> impl Iterator<Item = f64> {
        let [p, q, r] = self.delta;
        // px² + 2qx + r = 0 without cancellation.
        let discriminant = q.times(&q).minus(&p.times(&r));
        let roots = (discriminant.hi >= 0.0).then(|| {
            let root = discriminant.sqrt().hi;
            let sum = -(q.hi + root.copysign(q.hi));
            [sum / p.hi, r.hi / sum]
        });
        roots.into_iter().flatten().filter(|x| x.abs() < 0.5)
    }

    /// The square root of Δ, if it is not negative but for its rounding.
    fn root(&self, x: f64) -> f64 {
        let [p, q, r] = &self.delta;
        let at = Double::from_f64(x);
        let twice = q.plus(q);
        let delta = p.times(&at).plus(&twice).times(&at).plus(r);
        delta.hi.max(0.0).sqrt()
    }

    /// Its functions from `left` to `right`, where it is there at all.
    pub fn span(&self, left: f64, right: f64) -> Option<Span<'_>> {
        let x = [left, 0.5 * (left + right), right];
        let middle = self.root(x[1]);
        (middle > 0.0).then(|| Span {
            graph: self,
            x,
            roots: [self.root(left), middle, self.root(right)],
        })
    }

    /// y at an x at which Δ has a root.
    fn y(&self, x: f64, root: f64, side: f64) -> f64 {
        let [a, b, c, d, e, f] = &self.factors;
        let root = root * side;
        let at = Double::from_f64(x);
        let minus = b.times(&at).plus(e).negated().hi;
        // Of the two ways to write the root the one that does not cancel.
        if minus * side >= 0.0 {
            (minus + root) / c.hi
        } else {
            let twice = d.plus(d);
            let g = a.times(&at).plus(&twice).times(&at).plus(f);
            g.hi / (minus - root)
        }
    }

    /// The same of the place and the root, in double-double.
    fn end_in_double(&self, x: f64, side: f64) -> End<Double> {
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
        let root = match delta.is_negative() {
            true => Double::from_f64(0.0),
            false => delta.sqrt(),
        };
        let root = if side < 0.0 { root.negated() } else { root };
        let minus = b.times(&at).plus(e).negated();
        let y = match minus.hi * side >= 0.0 {
            true => minus.plus(&root).over(c),
            false => quadratic(a, d, f).over(&minus.minus(&root)),
        };
        End { at: [at, y], root }
    }
}

impl<'a> Span<'a> {
    /// One of the two functions as a track and its section, where it is a number at all and may be
    /// seen in the pixel; that is none if it turns too much to be followed at once.
    pub fn branch(&self, side: f64) -> Option<(Track<'a>, Option<Section>)> {
        let Self { graph, x, roots } = self;
        let y = [0, 1, 2].map(|i| graph.y(x[i], roots[i], side));
        if !y[1].is_finite() {
            return None;
        }
        // A function that bends one way only is nowhere farther from its chord than twice as far as
        // in the middle.
        let sagitta = y[1] - 0.5 * (y[0] + y[2]);
        let size = y.iter().fold(1.0, |size: f64, y| size.max(y.abs()));
        let beyond = 0.5 + 2.0 * sagitta.abs() + OUTSIDE * size;
        if y.iter().all(|y| *y > beyond) || y.iter().all(|y| *y < -beyond) {
            return None;
        }
        let straight = Section {
            y,
            arc: None,
            slack: 0.0,
        };
        let (start, end) = (DVec2::new(x[0], y[0]), DVec2::new(x[2], y[2]));
        let width = end.x - start.x;
        let section = match self.arc([start, end], side) {
            Some((arc, off)) => {
                let bulge = 1f64.copysign((end - start).perp_dot(arc.control - start));
                Some(Section {
                    arc: Some((bulge, arc)),
                    slack: off / width,
                    ..straight
                })
            }
            // Too flat for its tangents to be told apart: each y has six operations, and its middle
            // two.
            None => {
                let flat = 8.0 * f64::UNIT * (1.0 + y[0].abs() + y[2].abs());
                (sagitta.abs() <= flat).then_some(Section {
                    slack: 2.0 * sagitta.abs() + flat,
                    ..straight
                })
            }
        };
        Some((Track::Branch { graph, side }, section))
    }

    /// The arc from its first point to its last, if the two tangents meet between them; and by how
    /// much the area between it and its chord may be off.
    fn arc(&self, ends: [DVec2; 2], side: f64) -> Option<(Arc, f64)> {
        let Self { graph, roots, .. } = self;
        let [start, end] = ends;
        let factors = graph.factors.map(|factor| factor.hi);
        let rounded = [(start, roots[0]), (end, roots[2])].map(|(at, root)| End {
            at: [at.x, at.y],
            root: side * root,
        });
        let mut tangents = Tangents::new(&factors, &rounded);
        // Of a conic that is next to nothing but a line hardly more than roundings is left of the
        // gradient.
        let is_good = tangents.off <= GOOD * (end.x - start.x);
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
        // Arcs whose tangents turn by more than 120° are cut: the weight is the cosine of half of
        // that.
        const TURN: f64 = 0.5;
        let turns_little = arc.weight > TURN && arc.weight < 1.0 / TURN;
        (control.x >= 0.0 && control.x <= end.x - start.x && turns_little).then_some((arc, off))
    }
}

/// A point of a conic, and the root there with its sign, which is half the gradient by y.
struct End<T> {
    at: [T; 2],
    root: T,
}

/// Where the tangents at two points of a conic meet.
struct Tangents {
    /// From the first point on.
    control: DVec2,
    /// The square of the arc's weight.
    w2: f64,
    /// By how much the area between arc and chord may be off.
    off: f64,
}

impl Tangents {
    /// Of the conic that has such factors.
    ///
    /// Its gradient is off by a few roundings of its terms, κ times as many of itself, and so are
    /// both tangents' directions by as much of a radian. By an angle at its base a triangle's
    /// area grows by half the square of the leg there. What the control is off along its tangent
    /// changes the triangle and the weight, one up and the other down, by no more than that. The
    /// conic's quadratic part Q is off by as many of its own terms, and by what the vectors
    /// are, which are off by roundings of coordinates and by what the directions are; the
    /// weight's square is the quotient of two of it, and what lies between arc and chord grows no
    /// faster than the weight. The root is that of another conic as near as this one is known
    /// itself, which moves points and tangents together.
    fn new<T: Real<Radius = f64>>(factors: &[T; 6], ends: &[End<T>; 2]) -> Self {
        let [a, b, c, d, ..] = factors;
        let product = |[x, y]: &[T; 2], [z, w]: &[T; 2]| x.times(z).plus(&y.times(w));
        let length = |[x, y]: &[T; 2]| libm::hypot(x.to_f64(), y.to_f64());
        let gradients = ends.each_ref().map(|End { at: [x, y], root }| {
            let by_x = a.times(x).plus(&b.times(y)).plus(d);
            [by_x, root.clone()]
        });
        let kappa = [0, 1].map(|i| {
            let [x, y] = ends[i].at.each_ref().map(Real::magnitude);
            let terms = a.magnitude() * x + b.magnitude() * y + d.magnitude();
            1.0 + terms / length(&gradients[i])
        });
        let kappa = kappa[0].max(kappa[1]);
        // Q, and what it is off by, of itself, where the vector is off by so much.
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
        // From the start the control is along the tangent there, and from the end along the other
        // one.
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
    /// The track of a line; none if it is vertical, or so steep that it may be said to be.
    pub fn of_line(line: &BoundaryLine) -> Option<Self> {
        let [a, b, c] = line.factors;
        let (slope, start) = (-a / b, -c / b);
        (slope.abs() <= STEEP && start.is_finite()).then_some(Self::Line { slope, start })
    }

    /// y at an x where the track is.
    pub fn y(&self, x: f64) -> f64 {
        match self {
            Self::Level(y) => *y,
            Self::Line { slope, start } => slope * x + start,
            Self::Branch { graph, side } => graph.y(x, graph.root(x), *side),
        }
    }

    /// A straight track from `left` to `right`.
    pub fn straight(&self, left: f64, right: f64) -> Section {
        Section {
            y: [left, 0.5 * (left + right), right].map(|x| self.y(x)),
            arc: None,
            slack: 0.0,
        }
    }
}

impl Section {
    /// A section of the line y = const.
    pub fn level(y: f64) -> Self {
        Self {
            y: [y; 3],
            arc: None,
            slack: 0.0,
        }
    }

    /// The greatest y it may have at three places: left, where its tangents meet (or anywhere, if
    /// it is straight), right.
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
        at + up * self.slack
    }

    /// By how much this section may rise above another one over the same range of x, at most.
    pub fn overlap(&self, other: &Self, left: f64, right: f64) -> f64 {
        let controls = [self, other].map(|section| section.arc.map(|(_, arc)| arc.control.x));
        let places = [Some(left), controls[0], controls[1], Some(right)];
        // Both hulls are straight between these places.
        let hulls = places
            .into_iter()
            .flatten()
            .map(|x| self.hull(1.0, x, left, right) - other.hull(-1.0, x, left, right))
            .fold(f64::NEG_INFINITY, f64::max);
        let rise = self.between(other).map(|[rise, _]| rise);
        hulls.min(rise.unwrap_or(f64::INFINITY))
    }

    /// By how much it may rise above another one over the same range of x, and how far they may be
    /// apart, where both are arcs that are nearly parallel, however close: point by point of
    /// their parameter, with the first one's chord level.
    ///
    /// Of the same weights an arc's point is the same mean of its three control points as the
    /// other's of its own. An error in x counts by the steepest tangent; and a different weight
    /// moves a point by at most its distance from the control point. Of narrow arcs that place is
    /// uncertain along them, where little depends on it. A point is off by less than eight times
    /// what the area is by the width; and by what x is rounded, which moves no more area than
    /// roundings of it by the arc's height.
    fn between(&self, other: &Self) -> Option<[f64; 2]> {
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
        // Some twenty operations on coordinates of both arcs, and what those are off themselves;
        // the slack counts on both sides, for three points and the chord.
        let rounding = 64.0 * f64::UNIT * (1.0 + size + slope.abs() * aside);
        let off = weights * tallest
            + (aside + rounding) * steepest
            + rounding
            + 8.0 * (self.slack + other.slack);
        let heights = [a.start - b.start, a.control - b.control, a.end - b.end].map(height);
        let rise = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let apart = heights.into_iter().map(f64::abs).fold(0.0, f64::max);
        Some([rise + off, apart + off])
    }

    /// The integral of y over its range.
    pub fn integral(&self, left: f64, right: f64) -> f64 {
        let chord = 0.5 * (right - left) * (self.y[0] + self.y[2]);
        chord + self.arc.map_or(0.0, |(bulge, arc)| bulge * arc.area())
    }

    /// How far apart two pieces are at most, if they are nearly the same curve.
    pub fn distance(&self, other: &Self) -> f64 {
        let ends = (self.y[0] - other.y[0])
            .abs()
            .max((self.y[2] - other.y[2]).abs());
        match (&self.arc, &other.arc) {
            (None, None) => ends,
            (Some(_), Some(_)) => self
                .between(other)
                .map_or(f64::INFINITY, |[_, apart]| apart),
            _ => f64::INFINITY,
        }
    }
}
