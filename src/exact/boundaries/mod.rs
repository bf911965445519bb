//! The boundaries of what is seen in a pixel, or in a part of one.
//!
//! In: a sub-pixel and its candidates. Out: the lines and conics that may pass through it: outlines, where surfaces cross each other, and where the
//! near and the far plane cut them. They are computed in double-double, and again in the last precision where that leaves too much in doubt. Candidates that
//! are hidden all over a sub-pixel are dropped first ([`narrowed`]).

mod equal;
mod reach;

use std::{
    cmp,
    ops::ControlFlow,
    sync::atomic::{AtomicBool, Ordering},
};

use glam::DVec2;

use self::reach::Reach;
use crate::{
    math::{Big, Double},
    tracer::{
        Candidate, Crossing, Crossings, Curve, Held, LOOSE_LINE, Object, Patch, Precision,
        SubPixel, SubPixelFrame, Surface, World, candidates,
    },
};

/// The doubtful area of a conic, in pixels, from which on double-double was not enough: eight roundings of a mean in `f64`.
const LOOSE_CONIC: f64 = 1.0 / (1u64 << 50) as f64;

/// With more objects than so many for each curve that there may be, no curves are asked for: to prepare the objects takes longer than to quarter the sub-pixel.
/// (Fewer may be equal. Measured: a quarter and four times as many change times by about a tenth at most.)
const HEAP: usize = 16;

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

/// The boundaries of what may be seen in a sub-pixel, in one precision.
struct Boundaries<'a, T: Precision> {
    world: &'a World,
    candidates: &'a [Candidate],
    objects: Vec<Held<'a, T>>,
    frame: SubPixelFrame<T>,
    /// Where each object is met, as double-double tells.
    reaches: &'a [Reach],
}

/// Of some candidates, in file order, those that may be seen in a sub-pixel.
pub fn narrowed(world: &World, sub_pixel: SubPixel, among: &[Candidate], out: &mut Vec<Candidate>) {
    let patch = Patch::of_sub_pixel(&world.geometry.fast.camera, sub_pixel);
    candidates::visible_among(
        world,
        &patch,
        among.iter().map(|candidate| candidate.object),
        out,
    );
    drop_behind_middle(world, sub_pixel, &patch, out);
}

/// The curves in a sub-pixel that may bound what is seen there of some objects; and how many objects and pairs of objects were looked at. It is an error if
/// there are more than `most`, equal ones counted once: the search ends there, and once it is cancelled.
pub fn curves(
    world: &World,
    sub_pixel: SubPixel,
    candidates: &[Candidate],
    most: usize,
    cancel: &AtomicBool,
    out: &mut Vec<Curve>,
) -> Result<usize, usize> {
    out.clear();
    if candidates.len() > HEAP * most {
        return Err(0);
    }
    let reaches = reaches(world, sub_pixel, candidates);
    let boundaries = Boundaries::<Double>::new(world, sub_pixel, candidates, &reaches);
    // What is known better in the last precision; and what lacks a curve in double-double, which may be too little to tell.
    let (mut loose, mut lacking) = (Vec::new(), Vec::new());
    let mut of_lacking = Vec::new();
    let mut looks = 0;
    let mut room = most;
    let mut take = |origin| {
        looks += 1;
        let before = out.len();
        let is_whole = boundaries.push(origin, out);
        if !out[before..].iter().all(Curve::is_tight) {
            out.truncate(before);
            loose.push(origin);
        } else if !is_whole {
            of_lacking.extend(out.drain(before..));
            lacking.push(origin);
        }
        if out.len() > room {
            equal::merge(out);
            room = out.len() + most;
        }
        // Equal ones were merged, and more are left than may be.
        match room > 2 * most {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    // Outlines come first: of a heap there are too many of them, long before all pairs have been looked at.
    let outlines = boundaries.outlines(&mut take);
    let are_few = outlines.is_continue() && boundaries.pairs(cancel, &mut take).is_continue();
    if !are_few {
        return Err(looks);
    }
    if loose.is_empty() {
        out.append(&mut of_lacking);
    } else {
        let boundaries = Boundaries::<Big>::new(world, sub_pixel, candidates, &reaches);
        for origin in loose.into_iter().chain(lacking) {
            if cancel.load(Ordering::Relaxed) {
                return Err(looks);
            }
            boundaries.push(origin, out);
        }
    }
    equal::merge(out);
    match out.len() <= most {
        true => Ok(looks),
        false => Err(looks),
    }
}

/// Whether surfaces of two objects may cross each other in a sub-pixel, or be one there.
fn may_cross(world: &World, sub_pixel: SubPixel, a: Candidate, b: Candidate) -> bool {
    let mut curves = Vec::new();
    let candidates = [a, b];
    let reaches = reaches(world, sub_pixel, &candidates);
    let boundaries = Boundaries::<Double>::new(world, sub_pixel, &candidates, &reaches);
    !boundaries.push(Origin::Pair(0, 1), &mut curves) || !curves.is_empty()
}

/// Where each of some objects is met in a sub-pixel, at most.
fn reaches(world: &World, sub_pixel: SubPixel, candidates: &[Candidate]) -> Vec<Reach> {
    let frame = SubPixelFrame::new(&Double::frame(&world.geometry).camera, sub_pixel);
    let reach = |candidate: &Candidate| {
        let object = Double::object(&world.geometry, candidate.object);
        // Of a sphere no line bounds more than what lies behind the eye.
        match candidate.is_whole || matches!(*object, Object::Sphere(_)) {
            true => Reach::whole(),
            false => Reach::within(object.outline(&frame)),
        }
    };
    candidates.iter().map(reach).collect()
}

/// Removes objects that lie all over a sub-pixel behind the one that is seen in its middle, if every ray through the sub-pixel meets that.
fn drop_behind_middle(
    world: &World,
    sub_pixel: SubPixel,
    patch: &Patch,
    candidates: &mut Vec<Candidate>,
) {
    let (Some(middle), _) = candidates::object_at(world, sub_pixel, DVec2::ZERO, candidates) else {
        return;
    };
    let front = candidates
        .iter()
        .find(|candidate| candidate.object == middle)
        .copied();
    let Some(front) = front.filter(|front| front.is_whole) else {
        return;
    };
    let r = sub_pixel.middle(&world.geometry.fast.camera);
    let is_met = |back: &Candidate| {
        let object = f64::object(&world.geometry, back.object);
        let first = || object.first(&r).ok().flatten();
        let is_beyond_near = |crossing: Crossing<f64>| match &world.geometry.fast.near {
            Some(near) => crossing.inverse_depth.compare(&near.at(&r)) == Ok(cmp::Ordering::Less),
            None => true,
        };
        match back.crossings {
            Crossings::First => first().is_some(),
            Crossings::Both => first().is_some_and(is_beyond_near),
            Crossings::Second => first().and(object.second(&r)).is_some_and(is_beyond_near),
        }
    };
    candidates.retain(|back| {
        let are_uncut = !front.is_cut() && !back.is_cut();
        back.object == middle
            || !(are_uncut && candidates::covers(world, middle, back.object, patch)
                    // What is met there is behind it there; and so it is wherever it is met, which is in one piece, as it is convex.
                    || is_met(back) && !may_cross(world, sub_pixel, front, *back))
    });
}

impl<'a, T: Precision> Boundaries<'a, T> {
    fn new(
        world: &'a World,
        sub_pixel: SubPixel,
        candidates: &'a [Candidate],
        reaches: &'a [Reach],
    ) -> Self {
        let objects = candidates
            .iter()
            .map(|candidate| T::object(&world.geometry, candidate.object));
        Self {
            world,
            candidates,
            objects: objects.collect(),
            frame: SubPixelFrame::new(&T::frame(&world.geometry).camera, sub_pixel),
            reaches,
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

    /// Where surfaces of two objects cross, until one says that it is enough, or it is cancelled.
    fn pairs(
        &self,
        cancel: &AtomicBool,
        mut take: impl FnMut(Origin) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        for (i, a) in self.candidates.iter().enumerate() {
            if cancel.load(Ordering::Relaxed) {
                return ControlFlow::Break(());
            }
            for (j, b) in self.candidates.iter().enumerate().skip(i + 1) {
                let apart = a.inverse_depth.high < b.inverse_depth.low
                    || b.inverse_depth.high < a.inverse_depth.low;
                if !apart {
                    take(Origin::Pair(i, j))?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Adds a origin's curves that may pass through the sub-pixel, and through where its objects are met. Says whether all surfaces of it that are
    /// seen there cross each other somewhere, as all do that are not equal.
    fn push(&self, origin: Origin, out: &mut Vec<Curve>) -> bool {
        let met = match origin {
            Origin::Outline(_) => [None; 2],
            Origin::Clips(i) => [Some(i), None],
            Origin::Pair(i, j) => [Some(i), Some(j)],
        };
        let mut push = |curve: Curve| {
            let is_met = |i: &usize| match &curve {
                Curve::Line(line) => self.reaches[*i].is_crossed_by(line),
                Curve::Conic(_) => true,
            };
            if curve.may_pass() && met.iter().flatten().all(is_met) {
                out.push(curve);
            }
        };
        let mut all = true;
        let mut cross = |a: &Surface<T>, b: &Surface<T>| match self.frame.crossing(a, b) {
            Some(curve) => push(curve),
            None => all = false,
        };
        match origin {
            Origin::Outline(i) => {
                let outline = self.objects[i].outline(&self.frame);
                outline.into_iter().for_each(push);
            }
            Origin::Clips(i) => {
                let frame = T::frame(&self.world.geometry);
                for clip in [&frame.near, &frame.far].into_iter().flatten() {
                    for surface in &self.surfaces(i) {
                        cross(surface, &Surface::Plane(clip));
                    }
                }
            }
            Origin::Pair(i, j) => {
                if self.reaches[i].is_apart(&self.reaches[j]) {
                    return true;
                }
                let others = self.surfaces(j);
                for surface in &self.surfaces(i) {
                    others.iter().for_each(|other| cross(surface, other));
                }
            }
        }
        all
    }

    fn surfaces(&self, at: usize) -> Vec<Surface<'_, T>> {
        self.objects[at].surfaces(self.candidates[at].crossings)
    }
}

impl Curve {
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
}
