//! The boundaries of what is seen in a pixel, or in a part of one.
//!
//! In: a sub-pixel and its candidates. Out: the lines and conics that may pass through it:
//! outlines, where surfaces cross each other, and where the near and the far plane cut them. They
//! are computed in double-double, and again in the last precision where that leaves too much in
//! doubt.

use std::{cell::OnceCell, ops::ControlFlow};

use crate::{
    math::{Big, Double},
    tracer::{
        Boundary, BoundaryLine, CACHE_SLOTS, Conic, InverseDepth, LOOSE_LINE, Object, ObjectRef,
        Patch, Precision, SubPixel, SubPixelFrame, VisibilityCandidate, World, candidates,
    },
};

use super::budget::Budget;

/// The doubtful area of a conic, in pixels, from which on double-double was not enough: eight
/// roundings of a mean in `f64`.
const LOOSE_CONIC: f64 = 1.0 / (1u64 << 50) as f64;

/// Units of work: of a pair of objects whose depths are compared, of an object or a pair that is
/// asked for curves, and of an object, and of each two surfaces that may cross, in the last
/// precision. A triangle or a box that is not kept is prepared anew.
const PAIR_WORK: f64 = 1.0 / 16.0;
const LOOK_WORK: f64 = 8.0;
const PREPARATION_WORK: f64 = 140.0;
const BIG_CURVE_WORK: f64 = 1500.0;

/// What a boundary belongs to, of the objects that may be seen, by their places among these.
#[derive(Clone, Copy, Debug)]
enum Origin {
    /// An object's outline.
    Outline(usize),
    /// An object and the near or the far plane.
    Clips(usize),
    /// Two objects.
    Pair(usize, usize),
}

/// Asks some objects for their boundaries in a sub-pixel, in one precision.
struct Boundaries<'a, T: Precision> {
    world: &'a World,
    candidates: &'a [VisibilityCandidate],
    /// The objects that were asked.
    objects: Vec<OnceCell<ObjectRef<'a, T>>>,
    frame: SubPixelFrame<T>,
    budget: &'a Budget<'a>,
}

/// Of some candidates, in file order, those that may be seen in a sub-pixel.
pub fn narrowed(
    world: &World,
    sub_pixel: SubPixel,
    among: &[VisibilityCandidate],
    out: &mut Vec<VisibilityCandidate>,
) {
    let patch = Patch::of_sub_pixel(&world.geometry.fast.camera, sub_pixel);
    let objects = among.iter().map(|candidate| candidate.object);
    candidates::visible_among(world, &patch, objects, out);
}

/// Finds the curves in a sub-pixel that may bound what is seen there of some objects. Answers
/// whether these are all: the search ends where there are more than `most`, equal ones counted
/// once, and once the budget is spent, to which it is charged.
pub fn curves(
    world: &World,
    sub_pixel: SubPixel,
    candidates: &[VisibilityCandidate],
    most: usize,
    budget: &Budget,
    out: &mut Vec<Boundary>,
) -> bool {
    out.clear();
    let boundaries = Boundaries::<Double>::new(world, sub_pixel, candidates, budget);
    // Loose: whose curves are not known well enough in double-double. Lacking: pairs that have no
    // curve there, which only the last precision tells for certain.
    let (mut loose, mut lacking) = (Vec::new(), Vec::new());
    let mut of_lacking = Vec::new();
    let mut room = most;
    let mut take = |origin| {
        budget.charge(LOOK_WORK);
        let before = out.len();
        let is_whole = boundaries.push(origin, out);
        if !out[before..].iter().all(Boundary::is_tight) {
            out.truncate(before);
            loose.push(origin);
        } else if !is_whole {
            of_lacking.extend(out.drain(before..));
            lacking.push(origin);
        }
        if out.len() > room {
            leave_one_of_each(out);
            room = out.len() + most;
        }
        // Equal ones were merged, and more are left than may be.
        match room > 2 * most || budget.is_spent() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    // Outlines come first: of a heap there are too many of them, long before all pairs have been
    // looked at.
    let outlines = boundaries.outlines(&mut take);
    let are_few = outlines.is_continue() && boundaries.pairs(&mut take).is_continue();
    if !are_few {
        return false;
    }
    if loose.is_empty() {
        out.append(&mut of_lacking);
    } else {
        let boundaries = Boundaries::<Big>::new(world, sub_pixel, candidates, budget);
        for origin in loose.into_iter().chain(lacking) {
            if budget.is_spent() {
                return false;
            }
            boundaries.push(origin, out);
        }
    }
    leave_one_of_each(out);
    out.len() <= most
}

/// Leaves one of the curves whose forms are equal, as they are of objects that share planes or
/// edges. What it is off is as much as any of them was.
fn leave_one_of_each(curves: &mut Vec<Boundary>) {
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
        budget: &'a Budget,
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

    /// The outlines, and what the near and the far plane cut, until one says that it is enough.
    fn outlines(&self, mut take: impl FnMut(Origin) -> ControlFlow<()>) -> ControlFlow<()> {
        for (i, candidate) in self.candidates.iter().enumerate() {
            if !candidate.is_whole {
                take(Origin::Outline(i))?;
                take(Origin::Clips(i))?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Where surfaces of two objects cross, until one says that it is enough.
    fn pairs(&self, mut take: impl FnMut(Origin) -> ControlFlow<()>) -> ControlFlow<()> {
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
                // Boards are parallel: they meet at the horizon, which is the outline of both.
                let are_parallel = is_board(a) && is_board(b);
                if !apart && !are_parallel {
                    take(Origin::Pair(i, j))?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Adds an origin's curves that may pass through the sub-pixel. Says whether all surfaces of it
    /// that are seen there cross each other somewhere, as all do that are not equal.
    fn push(&self, origin: Origin, out: &mut Vec<Boundary>) -> bool {
        let mut push = |curve: Boundary| {
            if curve.may_pass() {
                out.push(curve);
            }
        };
        let mut all = true;
        let mut cross = |a: &InverseDepth<T>, b: &InverseDepth<T>| {
            self.charge_last();
            match self.frame.crossing(a, b) {
                Some(curve) => push(curve),
                None => all = false,
            }
        };
        match origin {
            Origin::Outline(i) => {
                let outline = self.object(i).outline(&self.frame);
                for curve in outline {
                    self.charge_last();
                    push(curve);
                }
            }
            Origin::Clips(i) => {
                let frame = T::frame(&self.world.geometry);
                for clip in [&frame.near, &frame.far].into_iter().flatten() {
                    for surface in &self.surfaces(i) {
                        cross(surface, &InverseDepth::Plane(clip));
                    }
                }
            }
            Origin::Pair(i, j) => {
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
            self.charge_last();
            let object = T::object(&self.world.geometry, self.candidates[at].object);
            // Of so many, few are kept.
            if self.candidates.len() > CACHE_SLOTS && matches!(*object, Object::Convex(_)) {
                self.budget.charge(PREPARATION_WORK);
            }
            object
        })
    }

    fn charge_last(&self) {
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
    /// Whether it may pass through the sub-pixel.
    fn may_pass(&self) -> bool {
        match self {
            Self::Line(line) => line.over_pixel().holds_zero(),
            Self::Conic(conic) => conic.over_pixel().holds_zero(),
        }
    }

    /// Whether a higher precision would tell next to nothing more.
    fn is_tight(&self) -> bool {
        match self {
            Self::Line(line) => line.rad < LOOSE_LINE,
            Self::Conic(conic) => conic.doubtful_area() < LOOSE_CONIC,
        }
    }

    /// Its form, which is the same of equal curves.
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
        // Of a form and its opposite one; and of 0 there is but one.
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
