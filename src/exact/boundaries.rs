//! The boundaries of what is seen in a sub-pixel (a pixel or a square part of one).
//!
//! In: a sub-pixel and its candidates, the objects that may be seen in it. Out: the lines and
//! conics that may separate colours in it: silhouettes, intersections of surfaces, and
//! intersections with the near and far planes. They are computed in double-double. If the error is
//! then too large, they are computed again in the highest precision ([`Big`]).

use std::{cell::OnceCell, ops::ControlFlow};

use crate::{
    math::{Big, Double},
    tracer::{
        Boundary, BoundaryLine, CACHE_SLOTS, Conic, InverseDepth, LOOSE_LINE, Object, ObjectRef,
        Patch, Precision, SubPixel, SubPixelFrame, VisibilityCandidate, World, candidates,
    },
};

use super::budget::PixelBudget;

/// Minimum doubtful area of a conic, in square pixels, at which the conic is computed again in the
/// highest precision. The doubtful area is the area that the conic's error may put on the wrong
/// side of the conic. The value is eight unit roundoffs, about the rounding error of a pixel's mean
/// in `f64`. A smaller area therefore does not matter.
const LOOSE_CONIC: f64 = 1.0 / (1u64 << 50) as f64;

/// Approximate time to compare the depths of two objects, in units of about 50 ns. It is charged to
/// the pixel's budget, and need not be precise, because the budget only stops computations that
/// take too long.
const PAIR_WORK: f64 = 1.0 / 16.0;
/// Approximate time to compute the curves of an object or of a pair of objects, in units of about
/// 50 ns. It is charged to the pixel's budget, and need not be precise, because the budget only
/// stops computations that take too long.
const CURVES_WORK: f64 = 8.0;
/// Approximate time to prepare a triangle or cuboid, in units of about 50 ns. It is charged to the
/// pixel's budget only if there are more candidate objects than [`CACHE_SLOTS`], because the
/// world's cache of prepared objects then cannot keep all of them.
const PREPARATION_WORK: f64 = 140.0;
/// Approximate additional time to compute the curves of an object or of a pair of surfaces in the
/// highest precision ([`Big`]), in units of about 50 ns. It is charged to the pixel's budget, and
/// need not be precise, because the budget only stops computations that take too long.
const BIG_CURVE_WORK: f64 = 1500.0;

/// Source of boundary curves: one object or a pair of objects, given by their indices in the list
/// of candidates.
#[derive(Clone, Copy, Debug)]
enum BoundarySource {
    /// The silhouette of an object.
    Outline(usize),
    /// The intersections of an object with the near and far planes.
    Clips(usize),
    /// The intersections of two objects.
    Pair(usize, usize),
}

/// State for computing the boundaries of candidates in a sub-pixel, in the precision `T`.
struct Boundaries<'a, T: Precision> {
    world: &'a World,
    candidates: &'a [VisibilityCandidate],
    /// Geometry of each candidate object, prepared on first use.
    objects: Vec<OnceCell<ObjectRef<'a, T>>>,
    frame: SubPixelFrame<T>,
    budget: &'a PixelBudget<'a>,
}

/// Returns the objects in `among` that may be seen in the sub-pixel, in file order.
pub fn visible(
    world: &World,
    sub_pixel: SubPixel,
    among: &[VisibilityCandidate],
) -> Vec<VisibilityCandidate> {
    let patch = Patch::of_sub_pixel(&world.geometry.fast.camera, sub_pixel);
    let objects = among.iter().map(|candidate| candidate.object);
    let mut visible = Vec::new();
    candidates::visible_among(world, &patch, objects, &mut visible);
    visible
}

/// Replaces the content of `out` by the curves that may separate colours in the sub-pixel. Only the
/// objects in `candidates` may be seen there. Returns `true` if `out` contains all of these curves.
/// Returns `false` as soon as more than `max_curves` unequal curves are found or the budget is
/// spent.
pub fn curves(
    world: &World,
    sub_pixel: SubPixel,
    candidates: &[VisibilityCandidate],
    max_curves: usize,
    budget: &PixelBudget,
    out: &mut Vec<Boundary>,
) -> bool {
    out.clear();
    let boundaries = Boundaries::<Double>::new(world, sub_pixel, candidates, budget);
    // A source is an object or a pair of objects. `imprecise` lists the sources with a curve whose
    // error is too large in double-double. `incomplete` lists the sources with two surfaces whose
    // intersection cannot be computed in double-double. Only the highest precision decides whether
    // such surfaces intersect.
    let (mut imprecise, mut incomplete) = (Vec::new(), Vec::new());
    let mut incomplete_curves = Vec::new();
    let mut room = max_curves;
    let mut take = |source| {
        budget.charge(CURVES_WORK);
        let before = out.len();
        let is_whole = boundaries.push(source, out);
        if !out[before..].iter().all(Boundary::is_tight) {
            out.truncate(before);
            imprecise.push(source);
        } else if !is_whole {
            incomplete_curves.extend(out.drain(before..));
            incomplete.push(source);
        }
        if out.len() > room {
            merge_equal_curves(out);
            room = out.len() + max_curves;
        }
        // Equal curves are merged whenever `out` has more than `room` curves. After a merge, `room`
        // is the number of remaining curves plus `max_curves`. If `room` exceeds twice
        // `max_curves`, there are therefore more than `max_curves` unequal curves, and the search
        // stops.
        if room > 2 * max_curves || budget.is_spent() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    };
    // Silhouettes are computed before the curves of pairs. If there are very many objects, their
    // silhouettes alone exceed `max_curves`, so the search stops early.
    let outlines = boundaries.outlines(&mut take);
    if outlines.is_break() || boundaries.pairs(&mut take).is_break() {
        return false;
    }
    if imprecise.is_empty() {
        out.append(&mut incomplete_curves);
    } else {
        let boundaries = Boundaries::<Big>::new(world, sub_pixel, candidates, budget);
        for source in imprecise.into_iter().chain(incomplete) {
            if budget.is_spent() {
                return false;
            }
            boundaries.push(source, out);
        }
    }
    merge_equal_curves(out);
    out.len() <= max_curves
}

/// Merges curves with equal equations, such as those of objects that share planes or edges. A
/// merged curve gets the largest error of the curves that it replaces.
fn merge_equal_curves(curves: &mut Vec<Boundary>) {
    curves.sort_by_cached_key(Boundary::key);
    curves.dedup_by(|again, curve| {
        let is_equal = again.key() == curve.key();
        if is_equal {
            let again = *again.rad_mut();
            let rad = curve.rad_mut();
            *rad = rad.max(again);
        }
        is_equal
    });
}

impl<'a, T: Precision> Boundaries<'a, T> {
    fn new(
        world: &'a World,
        sub_pixel: SubPixel,
        candidates: &'a [VisibilityCandidate],
        budget: &'a PixelBudget,
    ) -> Self {
        let objects = candidates.iter().map(|_| OnceCell::new());
        Self {
            world,
            candidates,
            objects: objects.collect(),
            frame: SubPixelFrame::new(&T::frame(&world.geometry).camera, sub_pixel),
            budget,
        }
    }

    /// Calls `take` for the silhouette and the clip-plane intersections of each candidate that does
    /// not cover the whole sub-pixel. Stops as soon as `take` breaks.
    fn outlines(&self, mut take: impl FnMut(BoundarySource) -> ControlFlow<()>) -> ControlFlow<()> {
        for (i, candidate) in self.candidates.iter().enumerate() {
            if !candidate.is_whole {
                take(BoundarySource::Outline(i))?;
                take(BoundarySource::Clips(i))?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Calls `take` for each pair of objects that may intersect. Stops as soon as `take` breaks or
    /// the budget is spent.
    fn pairs(&self, mut take: impl FnMut(BoundarySource) -> ControlFlow<()>) -> ControlFlow<()> {
        let geometry = &self.world.geometry;
        let is_board = |candidate: &VisibilityCandidate| {
            matches!(
                *f64::object(geometry, candidate.object),
                Object::Checkerboard(_)
            )
        };
        for (i, a) in self.candidates.iter().enumerate() {
            let others = self.candidates.len() - i;
            self.budget.charge(PAIR_WORK * others as f64);
            if self.budget.is_spent() {
                return ControlFlow::Break(());
            }
            for (j, b) in self.candidates.iter().enumerate().skip(i + 1) {
                let apart = a.inverse_depth.high < b.inverse_depth.low
                    || b.inverse_depth.high < a.inverse_depth.low;
                // All checkerboards are horizontal, so two of them do not intersect. Their common
                // silhouette, the horizon, is among the outlines.
                let are_parallel = is_board(a) && is_board(b);
                if !apart && !are_parallel {
                    take(BoundarySource::Pair(i, j))?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Appends to `out` the boundary curves of `source` that may pass through the sub-pixel.
    /// Returns `false` if the intersection curve of two surfaces of the source cannot be computed
    /// in the precision `T`. The surfaces are then equal planes or concentric spheres, perhaps only
    /// because of rounding errors.
    fn push(&self, source: BoundarySource, out: &mut Vec<Boundary>) -> bool {
        let mut push = |curve: Boundary| {
            if curve.may_cross_pixel() {
                out.push(curve);
            }
        };
        let mut all = true;
        let mut cross = |a: &InverseDepth<T>, b: &InverseDepth<T>| {
            self.charge_big_curve();
            match self.frame.crossing(a, b) {
                Some(curve) => push(curve),
                None => all = false,
            }
        };
        match source {
            BoundarySource::Outline(i) => {
                for curve in self.object(i).outline(&self.frame) {
                    self.charge_big_curve();
                    push(curve);
                }
            }
            BoundarySource::Clips(i) => {
                let frame = T::frame(&self.world.geometry);
                for clip in [&frame.near, &frame.far].into_iter().flatten() {
                    for surface in &self.surfaces(i) {
                        cross(surface, &InverseDepth::Plane(clip));
                    }
                }
            }
            BoundarySource::Pair(i, j) => {
                let others = self.surfaces(j);
                for surface in &self.surfaces(i) {
                    others.iter().for_each(|other| cross(surface, other));
                }
            }
        }
        all
    }

    fn object(&self, at: usize) -> &Object<T> {
        self.objects[at].get_or_init(|| {
            self.charge_big_curve();
            let object = T::object(&self.world.geometry, self.candidates[at].object);
            // If there are more candidates than slots in the world's cache of prepared objects, an
            // object may have to be prepared again for every sub-pixel. The preparation is then
            // charged to the budget.
            let is_prepared_again = self.candidates.len() > CACHE_SLOTS;
            match *object {
                Object::Convex(_) if is_prepared_again => self.budget.charge(PREPARATION_WORK),
                Object::Convex(_) | Object::Sphere(_) | Object::Checkerboard(_) => {}
            }
            object
        })
    }

    fn charge_big_curve(&self) {
        if T::LAST {
            self.budget.charge(BIG_CURVE_WORK);
        }
    }

    fn surfaces(&self, at: usize) -> Vec<InverseDepth<'_, T>> {
        self.object(at)
            .inverse_depths(self.candidates[at].crossings)
    }
}

impl Boundary {
    /// Returns whether the curve may pass through the sub-pixel.
    fn may_cross_pixel(&self) -> bool {
        match self {
            Self::Line(line) => line.over_pixel().holds_zero(),
            Self::Conic(conic) => conic.over_pixel().holds_zero(),
        }
    }

    /// Returns whether the curve's error is below [`LOOSE_LINE`] or [`LOOSE_CONIC`]. The highest
    /// precision would then hardly improve the error bound of the pixel's mean.
    fn is_tight(&self) -> bool {
        match self {
            Self::Line(line) => line.rad < LOOSE_LINE,
            Self::Conic(conic) => conic.doubtful_area() < LOOSE_CONIC,
        }
    }

    /// Returns the coefficients of the curve's equation as bits, normalised so that equal curves
    /// have equal keys.
    fn key(&self) -> [u64; 12] {
        let mut factors = [0.0; 12];
        match self {
            Self::Line(line) => factors[..3].copy_from_slice(&line.factors),
            Self::Conic(conic) => {
                for (factor, Double { hi, lo }) in factors.chunks_exact_mut(2).zip(conic.factors) {
                    factor.copy_from_slice(&[hi, lo]);
                }
            }
        }
        // An equation and its negative describe the same curve, so the sign is chosen such that the
        // first coefficient that is not 0 is positive. Adding 0 turns −0 into 0, whose bits differ.
        let leading = factors.iter().find(|factor| **factor != 0.0);
        let sign = 1_f64.copysign(leading.copied().unwrap_or(1.0));
        factors.map(|factor| (factor * sign + 0.0).to_bits())
    }

    fn rad_mut(&mut self) -> &mut f64 {
        match self {
            Self::Line(BoundaryLine { rad, .. }) | Self::Conic(Conic { rad, .. }) => rad,
        }
    }
}
