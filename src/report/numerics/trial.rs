//! Compares what the oracle (a reference tracer of at least 512 bits), textbook formulas and
//! Pinhole see at points of a picture.

use dashu_float::ops::Abs;
use glam::{DVec2, DVec3, dvec2};

use super::inputs::{CaseRng, SamplePoint};
use crate::{
    color::Color,
    math::Real,
    reference::{
        formulas,
        oracle::{ALL_SIZES, N, Oracle, V, length},
        scenes::{color, scene},
        textbook::Textbook,
    },
    scene::{Camera, Scene},
    tracer::{Basis, World, ray},
};

/// Results of testing a case. In each pair, the first element is for the textbook formulas, and the
/// second for Pinhole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CaseTally {
    /// Number of inputs tested.
    pub inputs: u64,
    /// Numbers of wrong answers of the textbook formulas and of Pinhole. An answer is wrong if it
    /// differs from that of the oracle, a reference tracer of at least 512 bits.
    pub wrong: [u64; 2],
    /// Largest measured errors of the textbook formulas and of Pinhole, in the case's unit; `None`
    /// if nothing was measured.
    pub error: [Option<f64>; 2],
}

impl CaseTally {
    /// Combines the results of two tests: adds their counts, and keeps the larger errors.
    pub fn plus(self, other: Self) -> Self {
        Self {
            inputs: self.inputs + other.inputs,
            wrong: [0, 1].map(|i| self.wrong[i] + other.wrong[i]),
            error: [0, 1].map(|i| greater(self.error[i], other.error[i])),
        }
    }

    /// Records the errors of the textbook formulas and of Pinhole for one input, if they are larger
    /// than those recorded before. `None` stands for an error that was not measured.
    pub fn errors(&mut self, errors: [Option<f64>; 2]) {
        self.error = [0, 1].map(|i| greater(self.error[i], errors[i]));
    }
}

/// Returns the greater of two optional numbers, or the only one. Returns `None` if both are `None`.
fn greater(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    a.into_iter().chain(b).reduce(f64::max)
}

/// Measures the errors of a camera's axes, in units of 2^−53, for the textbook formulas and for
/// Pinhole. Counts one input in `tally`, and records the largest errors there.
pub(super) fn axes(camera: &Camera, tally: &mut CaseTally) {
    let scene = scene(*camera, &[]);
    let oracle = Oracle::new(&scene, ALL_SIZES);
    let basis = Basis::new(camera, &scene.image);
    let ours = [&basis.u, &basis.v, &basis.w].map(|v| v.each_ref().map(Real::to_f64));
    let theirs = formulas::axes(camera).map(|v| v.to_array());
    let errors = [theirs, ours].map(|axes| {
        let pairs = axes.iter().flatten().zip(oracle.axes.iter().flatten());
        let errors = pairs.map(|(x, truth)| {
            if x.is_finite() {
                (oracle.number.exact(*x) - truth).to_f64().value().abs()
            } else {
                f64::INFINITY
            }
        });
        errors.fold(0.0, f64::max) / (f64::EPSILON / 2.0)
    });
    tally.inputs += 1;
    tally.errors(errors.map(Some));
}

/// A scene that was prepared for the oracle, for the textbook formulas, and for Pinhole.
#[derive(Debug)]
pub(super) struct Trial {
    scene: Scene,
    world: World,
    textbook: Textbook,
    oracle: Oracle,
}

/// Number of inputs, one of which is used to measure errors. At every input, it is tested whether
/// the right object is seen. At every 16th input, the errors of the distance and of the seen
/// point's coordinates are also measured, which is slow. A smaller number would give more
/// measurements, but take more time.
const INPUTS_PER_MEASUREMENT: u64 = 16;

/// Number of searches for a boundary between colours, one of which asks the oracle, a slow
/// reference tracer. The others ask Pinhole. The oracle also finds boundaries that Pinhole does not
/// see, but searching with it takes about six times as long as testing the inputs beside the
/// boundary. With one search in 8, the oracle's searches take less than half of the time.
const BOUNDARIES_PER_ORACLE_SEARCH: u64 = 8;

impl Trial {
    /// Prepares a scene. The oracle, the reference tracer, will compute with `bits` bits.
    pub fn new(scene: Scene, bits: usize) -> Self {
        Self {
            world: World::new(&scene),
            textbook: Textbook::new(&scene),
            oracle: Oracle::new(&scene, bits),
            scene,
        }
    }

    /// Compares what the oracle, the textbook formulas and Pinhole see at a point, and counts wrong
    /// answers in `tally`. At every 16th point ([`INPUTS_PER_MEASUREMENT`]), also measures the
    /// errors of the distance and of the seen point's coordinates.
    pub fn decide(&self, point: SamplePoint, tally: &mut CaseTally) {
        let truth = self.truth(point);
        let pixels = point.map(|(pixel, offset)| f64::from(pixel) + 0.5 + offset);
        let pixels = DVec2::from(pixels);
        let textbook = self.textbook.seen(pixels);
        let textbook = self.color(textbook.map(|seen| (seen.object, seen.odd)));
        let ours = self.ours(point);
        tally.inputs += 1;
        for (wrong, answer) in tally.wrong.iter_mut().zip([textbook, ours]) {
            *wrong += u64::from(answer != truth);
        }
        if tally.inputs.is_multiple_of(INPUTS_PER_MEASUREMENT) {
            self.measure(pixels, tally);
        }
    }

    fn truth(&self, [(x, dx), (y, dy)]: SamplePoint) -> Color {
        let r = self.oracle.direction(x, y, dvec2(dx, dy));
        let seen = self.oracle.seen(&r);
        self.color(seen.map(|seen| (seen.object, seen.odd)))
    }

    fn ours(&self, [(x, dx), (y, dy)]: SamplePoint) -> Color {
        self.world.palette()[self.world.color_index_at(x, y, dvec2(dx, dy))]
    }

    /// Returns the colour that identifies what is seen: an object, with one of its two colours if
    /// it is a checkerboard, or the background if `seen` is `None`.
    fn color(&self, seen: Option<(usize, bool)>) -> Color {
        let background = self.scene.image.background;
        seen.map_or(background, |(object, is_odd)| color(object, is_odd))
    }

    /// Measures two errors at the point `pixels` of the picture, in units in the last place (ulp):
    /// that of the distance, and that of the seen point's coordinates. For the coordinates, the
    /// unit is that of the largest coordinate. Records the larger of the two errors in `tally`, for
    /// the textbook formulas and for Pinhole.
    fn measure(&self, pixels: DVec2, tally: &mut CaseTally) {
        let r = self.oracle.direction_through(pixels, DVec2::ZERO);
        let Some(seen) = self.oracle.seen(&r) else {
            return;
        };
        let t = &seen.t * length(&r);
        let point = self.oracle.point(&seen.t, &r);
        let theirs = self.textbook.seen(pixels);
        let theirs = theirs.filter(|theirs| theirs.object == seen.object);
        let theirs = theirs.map(|theirs| self.distance(theirs.t, theirs.point, &t, &point));
        let (_, hits) = ray(&self.world, pixels);
        let ours = hits.iter().find(|hit| hit.visible);
        let ours = ours.filter(|hit| hit.object == seen.object);
        let ours = ours.map_or(f64::INFINITY, |hit| {
            self.distance(hit.t, hit.point, &t, &point)
        });
        tally.errors([theirs, Some(ours)]);
    }

    /// Returns the larger of two errors. The error of the distance `t` is in units in its last
    /// place. The error of `point` is in units in the last place of its largest coordinate.
    fn distance(&self, t: f64, point: DVec3, true_t: &N, true_point: &V) -> f64 {
        let coordinates = true_point.iter().map(|x| x.to_f64().value().abs());
        let greatest = coordinates.fold(0.0, f64::max);
        let of_t = self.ulps(t, true_t, true_t.to_f64().value());
        let of_point = [0, 1, 2].map(|i| self.ulps(point[i], &true_point[i], greatest));
        of_point.into_iter().fold(of_t, f64::max)
    }

    /// Returns the difference between `x` and the exact value `truth`, in units in the last place
    /// of the number `of`. The result is infinite if `x` is not finite.
    fn ulps(&self, x: f64, truth: &N, of: f64) -> f64 {
        if !x.is_finite() {
            return f64::INFINITY;
        }
        let unit = of.abs().next_up() - of.abs();
        let error = (self.oracle.number.exact(x) - truth).abs() / self.oracle.number.exact(unit);
        error.to_f64().value()
    }

    /// Tests `count` inputs close to boundaries between colours: the neighbouring `f64`s on both
    /// sides, and points at distances that are uniform on a logarithmic scale. The boundaries are
    /// searched in random rows and columns. Most searches use Pinhole's answers. Some use the
    /// oracle's answers, since Pinhole may fail to see a boundary.
    pub fn boundaries(&self, random: &mut CaseRng, count: u64, tally: &mut CaseTally) {
        let end = tally.inputs + count;
        // A scene may have few boundaries. So after four searches per input, the search ends, and
        // the remaining inputs are tested anywhere in the picture.
        let mut patience = 4 * count;
        while tally.inputs < end && patience > 0 {
            patience -= 1;
            let axis = random.below(2) as usize;
            let found = match random.below(BOUNDARIES_PER_ORACLE_SEARCH) {
                0 => self.boundary(random, axis, &|point| self.truth(point)),
                _ => self.boundary(random, axis, &|point| self.ours(point)),
            };
            if let Some(boundary) = found {
                self.beside(random, axis, boundary, end - tally.inputs, tally);
            }
        }
        while tally.inputs < end {
            self.decide(random.point(), tally);
        }
    }

    /// Searches a random row (`axis` 0) or column (`axis` 1) for a point where the colour `seen`
    /// changes. Returns the last point before the change. Returns `None` if the two random ends of
    /// the search have the same colour.
    fn boundary(
        &self,
        random: &mut CaseRng,
        axis: usize,
        seen: &dyn Fn(SamplePoint) -> Color,
    ) -> Option<SamplePoint> {
        let size = [self.scene.image.width, self.scene.image.height];
        let mut point = random.point_of(size);
        let at = |index: u32, offset: f64| {
            let mut point = point;
            point[axis] = (index, offset);
            seen(point)
        };
        let mut ends = [0, 0].map(|_: u32| random.below(size[axis].into()) as u32);
        ends.sort_unstable();
        let first = at(ends[0], -0.5);
        if first == at(ends[1], -0.5) {
            return None;
        }
        while ends[1] - ends[0] > 1 {
            let middle = ends[0] + (ends[1] - ends[0]) / 2;
            ends[usize::from(at(middle, -0.5) != first)] = middle;
        }
        let (mut low, mut high) = (-0.5, 0.5_f64.next_down());
        if at(ends[0], high) == first {
            // The pixel has one colour from its start to its end, so the boundary lies between this
            // pixel and the next one. The last point before the boundary is the pixel's end.
            low = high;
        }
        // The interval is bisected until its ends are neighbouring `f64`s. Near 0, `f64`s are so
        // dense that this would take very long, so there are at most 130 bisections. Then, the
        // interval is shorter than any useful distance.
        for _ in 0..130 {
            let middle = low + (high - low) / 2.0;
            if middle == low || middle == high {
                break;
            }
            if at(ends[0], middle) == first {
                low = middle
            } else {
                high = middle
            }
        }
        point[axis] = (ends[0], low);
        Some(point)
    }

    /// Tests at most 12 inputs on and beside a boundary between colours, but not more than `count`.
    fn beside(
        &self,
        random: &mut CaseRng,
        axis: usize,
        boundary: SamplePoint,
        count: u64,
        tally: &mut CaseTally,
    ) {
        let (pixel, at) = boundary[axis];
        let unit = at.abs().next_up() - at.abs();
        for i in 0..count.min(12) {
            let step = match i {
                0 => 0.0,
                1 => 1.0,
                2 => -1.0,
                3 => 2.0,
                _ => random.sign() * libm::exp2(random.within(1.0, 48.0)).floor(),
            };
            let mut near = boundary;
            near[axis] = (pixel, (at + step * unit).clamp(-0.5, 0.5_f64.next_down()));
            self.decide(near, tally);
        }
    }
}
