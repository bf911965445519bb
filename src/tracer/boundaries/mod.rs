//! The curves in a spot that bound what is seen there: outlines, where surfaces cross each other, and where the near and the far plane
//! cut them.

mod equal;
mod reach;

use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicBool, Ordering},
};

use crate::math::{Big, Double};

use self::reach::Reach;
use super::{
    curve::{Curve, Place, Surface},
    object::Object,
    outlook::{LOOSE_LINE, Live, Spot},
    world::{Held, Level, World},
};

/// The doubtful area of a conic from which on double-double was not enough.
const LOOSE_CONIC: f64 = 1.0 / (1u64 << 50) as f64;

/// Of more objects than so many times as many as there may be curves, no curves are asked for: to prepare the objects takes longer than to quarter the spot.
/// (Fewer may be equal.)
const HEAP: usize = 16;

/// What a boundary belongs to, of the objects that may be seen, by their places among these.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// An object's outline.
    Outline(usize),
    /// An object and the near or the far plane.
    Clips(usize),
    /// Two objects.
    Pair(usize, usize),
}

/// The boundaries of what may be seen in a spot, in one precision.
struct Boundaries<'a, T: Level> {
    world: &'a World,
    live: &'a [Live],
    objects: Vec<Held<'a, T>>,
    place: Place<T>,
    /// Where each object is met, as double-double tells.
    reaches: &'a [Reach],
}

impl World {
    /// The curves in a spot that may bound what is seen there of some objects; and how many objects and pairs of objects were looked at. It is an error if
    /// there are more than `most`, equal ones counted once: the search ends there, and once it is cancelled.
    pub fn curves(
        &self,
        spot: Spot,
        live: &[Live],
        most: usize,
        cancel: &AtomicBool,
        out: &mut Vec<Curve>,
    ) -> Result<usize, usize> {
        out.clear();
        if live.len() > HEAP * most {
            return Err(0);
        }
        let reaches = self.reaches(spot, live);
        let boundaries = Boundaries::<Double>::new(self, spot, live, &reaches);
        // What is known better in the last precision; and what lacks a curve in double-double, which may be too little to tell.
        let (mut loose, mut lacking) = (Vec::new(), Vec::new());
        let mut of_lacking = Vec::new();
        let mut looks = 0;
        let mut room = most;
        let mut take = |source| {
            looks += 1;
            let before = out.len();
            let is_whole = boundaries.push(source, out);
            if !out[before..].iter().all(Curve::is_tight) {
                out.truncate(before);
                loose.push(source);
            } else if !is_whole {
                of_lacking.extend(out.drain(before..));
                lacking.push(source);
            }
            if out.len() > room {
                equal::merge(out);
                room = out.len() + most;
            }
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
            let boundaries = Boundaries::<Big>::new(self, spot, live, &reaches);
            for source in loose.into_iter().chain(lacking) {
                if cancel.load(Ordering::Relaxed) {
                    return Err(looks);
                }
                boundaries.push(source, out);
            }
        }
        equal::merge(out);
        match out.len() <= most {
            true => Ok(looks),
            false => Err(looks),
        }
    }

    /// Whether surfaces of two objects may cross each other in a spot, or be one there.
    pub(super) fn may_cross(&self, spot: Spot, a: Live, b: Live) -> bool {
        let mut curves = Vec::new();
        let live = [a, b];
        let reaches = self.reaches(spot, &live);
        let boundaries = Boundaries::<Double>::new(self, spot, &live, &reaches);
        !boundaries.push(Source::Pair(0, 1), &mut curves) || !curves.is_empty()
    }

    /// Where each of some objects is met in a spot, at most.
    fn reaches(&self, spot: Spot, live: &[Live]) -> Vec<Reach> {
        let place = Place::new(&Double::frame(self).camera, spot);
        let reach = |live: &Live| {
            let object = Double::object(self, live.object);
            // Of a sphere no line bounds more than what lies behind the eye.
            match live.is_whole || matches!(*object, Object::Sphere(_)) {
                true => Reach::whole(),
                false => Reach::within(object.outline(&place)),
            }
        };
        live.iter().map(reach).collect()
    }
}

impl<'a, T: Level> Boundaries<'a, T> {
    fn new(world: &'a World, spot: Spot, live: &'a [Live], reaches: &'a [Reach]) -> Self {
        let objects = live.iter().map(|live| T::object(world, live.object));
        Self {
            world,
            live,
            objects: objects.collect(),
            place: Place::new(&T::frame(world).camera, spot),
            reaches,
        }
    }

    /// The outlines, and what the near and the far plane cut, until one says that it is enough.
    fn outlines(&self, mut take: impl FnMut(Source) -> ControlFlow<()>) -> ControlFlow<()> {
        for (i, live) in self.live.iter().enumerate() {
            if !live.is_whole {
                take(Source::Outline(i))?;
                take(Source::Clips(i))?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Where surfaces of two objects cross, until one says that it is enough, or it is cancelled.
    fn pairs(
        &self,
        cancel: &AtomicBool,
        mut take: impl FnMut(Source) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        for (i, a) in self.live.iter().enumerate() {
            if cancel.load(Ordering::Relaxed) {
                return ControlFlow::Break(());
            }
            for (j, b) in self.live.iter().enumerate().skip(i + 1) {
                let apart = a.inverse_depth.high < b.inverse_depth.low
                    || b.inverse_depth.high < a.inverse_depth.low;
                if !apart {
                    take(Source::Pair(i, j))?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Adds a source's curves that may pass through the spot, and through where its objects are met. Says whether all surfaces of it that are
    /// seen there cross each other somewhere, as all do that are not equal.
    fn push(&self, source: Source, out: &mut Vec<Curve>) -> bool {
        let met = match source {
            Source::Outline(_) => [None; 2],
            Source::Clips(i) => [Some(i), None],
            Source::Pair(i, j) => [Some(i), Some(j)],
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
        let mut cross = |a: &Surface<T>, b: &Surface<T>| match self.place.crossing(a, b) {
            Some(curve) => push(curve),
            None => all = false,
        };
        match source {
            Source::Outline(i) => {
                let outline = self.objects[i].outline(&self.place);
                outline.into_iter().for_each(push);
            }
            Source::Clips(i) => {
                let frame = T::frame(self.world);
                for clip in [&frame.near, &frame.far].into_iter().flatten() {
                    for surface in &self.surfaces(i) {
                        cross(surface, &Surface::Plane(clip));
                    }
                }
            }
            Source::Pair(i, j) => {
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
        self.objects[at].surfaces(self.live[at].crossings)
    }
}

impl Curve {
    /// Whether it may pass through the spot.
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
