//! How much work may be spent on a picture.
//!
//! Work is counted where it arises, not timed: the same picture gets the same verdict. A unit is
//! that of the exact picture, some 30 ns.

use std::{cell::Cell, sync::atomic::AtomicBool};

use super::{
    light::Curve,
    moments::{Moments, moments, numbers},
};
use crate::{area::Area, exact::Integrator, scene::Scene, tracer::World};

/// Units for a picture, and for each of its pixels: together about three seconds for one of 320 ×
/// 180 pixels, so that two mistakes in four objects are found, and four for one of 1280 × 720.
const PICTURE: f64 = 8e7;
const PIXEL: f64 = 41.0;

/// Units of preparing an object for an exact picture, and for a sampled one, of a ray and of asking
/// whether it hits a shape, and of comparing a cell.
const WORLD_OBJECT: f64 = 20.0;
const OBJECT: f64 = 6.0;
const RAY: f64 = 0.6;
const TEST: f64 = 0.2;
const CELL: f64 = 2.0;

/// Units for each cell of a prediction that is compared with what is seen, and for each pixel of
/// which it is asked where edges lie and how sharp they are.
pub const PREDICTED: f64 = 1.0;
pub const LEFT: f64 = 8.0;

/// To within so much of the light of white an exact picture is known that judges bytes: a three
/// hundredth of the smallest step of sRGB.
pub const KNOWN: f64 = 1e-6;

/// The work that was spent, and how much may be.
pub struct Work<'a> {
    spent: Cell<f64>,
    most: Cell<f64>,
    /// Whether something was left out for that.
    is_cut: Cell<bool>,
    cancel: &'a AtomicBool,
}

/// The work of an exact picture of so many objects that took the integrator so many units.
pub fn of_exact(units: u64, objects: usize, pixels: usize) -> f64 {
    units as f64 + WORLD_OBJECT * objects as f64 + CELL * pixels as f64
}

impl<'a> Work<'a> {
    /// What may be spent on a picture of so many pixels, so many times as much as usual, of which
    /// so much is spent.
    pub fn new(pixels: u64, spent: f64, effort: f64, cancel: &'a AtomicBool) -> Self {
        Self {
            spent: Cell::new(spent),
            most: Cell::new(effort * (PICTURE + PIXEL * pixels as f64)),
            is_cut: Cell::new(false),
            cancel,
        }
    }

    /// Spends so much.
    pub fn spend(&self, work: f64) {
        self.spent.set(self.spent.get() + work);
    }

    /// Whether not too much was spent yet; if it was, something is left out.
    pub fn may_go_on(&self) -> bool {
        let may = self.left() > 0.0;
        self.is_cut.set(self.is_cut.get() || !may);
        may
    }

    /// Whether something was left out.
    pub fn is_cut(&self) -> bool {
        self.is_cut.get()
    }

    /// Does something that has to be done, however much work it is.
    pub fn without_limit<T>(&self, run: impl FnOnce() -> T) -> T {
        let before = self.most.replace(f64::INFINITY);
        let result = run();
        self.most.set(before);
        result
    }

    fn left(&self) -> f64 {
        (self.most.get() - self.spent.get()).max(0.0)
    }

    /// The exact means and variances of what a part of a scene's picture shows; none if they take
    /// too much.
    pub fn exact_moments(&self, scene: &Scene, averaged: Curve, part: Area) -> Option<Moments> {
        let world = World::new_unless(scene, self.cancel).ok()?;
        let integrator = Integrator::for_values(&world, numbers(averaged))
            .with_tolerance(KNOWN)
            .with_work_limit(self.left() as u64);
        let pixels = integrator.pixels(part, self.cancel);
        let cells = part.pixels() as usize;
        self.spend(of_exact(integrator.work(), scene.objects.len(), cells));
        if pixels.is_none() {
            self.is_cut.set(true);
        }
        Some(Moments::exact(pixels?.iter().map(moments)))
    }

    /// A part of a picture of so many objects is to be sampled; none if that takes more than is
    /// left, which is spent then.
    pub fn pay_for_samples(&self, objects: usize, samples: usize, part: Area) -> Option<()> {
        let (objects, cells) = (objects as f64, part.pixels() as f64);
        let rays = samples as f64 * cells;
        let all = objects * OBJECT + rays * (RAY + TEST * objects) + CELL * cells;
        let fits = all <= self.left();
        self.spend(all.min(self.left()));
        self.is_cut.set(self.is_cut.get() || !fits);
        fits.then_some(())
    }
}
