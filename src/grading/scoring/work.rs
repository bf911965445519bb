//! The budget of work for judging a picture.
//!
//! Work is counted instead of timed, so that a picture always gets the same verdict. The unit is
//! that of the exact renderer ([`Integrator`]), about 30 ns.

use std::{cell::Cell, sync::atomic::AtomicBool};

use super::moments::{Moments, moments, numbers};
use crate::{
    area::Area, exact::Integrator, grading::hypotheses::Curve, scene::Scene, tracer::World,
};

/// Work that is allowed for a picture, in units of about 30 ns, in addition to the work for each
/// pixel ([`PIXEL`]). By measurement, judging a picture of 320 × 180 pixels then takes at most
/// about 3 s, which is enough to find two mistakes in four objects. A picture of 1280 × 720 pixels
/// takes at most about 4 s.
const PICTURE: f64 = 9.6e7;
/// Work that is allowed for each pixel of a picture, in units of about 30 ns, because large
/// pictures take longer to compare. With a larger value, more mistakes are found, but judging takes
/// longer.
const PIXEL: f64 = 41.0;

/// Approximate cost of preparing an object for an exact picture, in units of about 30 ns.
const WORLD_OBJECT: f64 = 20.0;
/// Approximate cost of preparing an object for a sampled picture, in units of about 30 ns.
const OBJECT: f64 = 6.0;
/// Approximate cost of making a ray, in units of about 30 ns.
const RAY: f64 = 0.6;
/// Approximate cost of intersecting a ray with a shape, in units of about 30 ns.
const TEST: f64 = 0.2;
/// Approximate cost of storing and comparing a cell of a picture, in units of about 30 ns.
const CELL: f64 = 2.0;

/// Approximate cost of comparing a predicted with an observed cell of a picture, in units of about
/// 30 ns.
pub const COMPARISON: f64 = 1.0;
/// Approximate cost per pixel of testing where edges lie and how sharp they are, in units of about
/// 30 ns.
pub const RESIDUAL: f64 = 8.0;

/// Tolerance of the exact pictures that 8-bit pictures are compared to, in light from 0 to 1. It is
/// about 1/300 of the smallest step of 8-bit sRGB, so it does not change a verdict.
pub const TOLERANCE: f64 = 1e-6;

/// Work spent on judging a picture, and its limit.
pub struct Work<'a> {
    spent: Cell<f64>,
    limit: Cell<f64>,
    /// Whether the judgement was cut short because the limit was reached.
    is_cut: Cell<bool>,
    pub cancel: &'a AtomicBool,
}

/// Returns the work of computing an exact picture. `units` is the work that the exact renderer
/// counted, to which the work of preparing objects and storing pixels is added.
pub fn of_exact(units: u64, objects: usize, pixels: usize) -> f64 {
    units as f64 + WORLD_OBJECT * objects as f64 + CELL * pixels as f64
}

impl<'a> Work<'a> {
    /// Creates the budget of work for judging a picture of `pixels` pixels. `effort` is a factor of
    /// the limit. `spent` is the work that was already spent on the exact picture.
    pub fn new(pixels: u64, spent: f64, effort: f64, cancel: &'a AtomicBool) -> Self {
        Self {
            spent: Cell::new(spent),
            limit: Cell::new(effort * (PICTURE + PIXEL * pixels as f64)),
            is_cut: Cell::new(false),
            cancel,
        }
    }

    /// Adds `work` to the work that was spent.
    pub fn spend(&self, work: f64) {
        self.spent.set(self.spent.get() + work);
    }

    /// Returns whether work may go on, i.e. whether the limit is not reached. If it is reached,
    /// records that the judgement was cut short.
    pub fn may_go_on(&self) -> bool {
        let may = self.remaining() > 0.0;
        self.is_cut.set(self.is_cut.get() || !may);
        may
    }

    /// Returns `None` if the limit on work is reached. In this case, records that the judgement was
    /// cut short.
    pub fn check(&self) -> Option<()> {
        self.may_go_on().then_some(())
    }

    /// Returns whether the judgement was cut short because the limit was reached.
    pub fn is_cut(&self) -> bool {
        self.is_cut.get()
    }

    /// Runs a function without a limit on work, because its result must be complete.
    pub fn without_limit<T>(&self, run: impl FnOnce() -> T) -> T {
        let before = self.limit.replace(f64::INFINITY);
        let result = run();
        self.limit.set(before);
        result
    }

    fn remaining(&self) -> f64 {
        (self.limit.get() - self.spent.get()).max(0.0)
    }

    /// Computes the exact means and variances of the pixels in the area `part` of a scene's
    /// picture. Returns `None` if the work is cancelled or exceeds its limit.
    pub fn exact_moments(&self, scene: &Scene, decoding: Curve, part: Area) -> Option<Moments> {
        let world = World::new_unless(scene, self.cancel).ok()?;
        let integrator = Integrator::for_values(&world, numbers(decoding))
            .with_tolerance(TOLERANCE)
            .with_work_limit(self.remaining() as u64);
        let pixels = integrator.pixels(part, self.cancel);
        let cells = part.pixels() as usize;
        self.spend(of_exact(integrator.work(), scene.objects.len(), cells));
        if pixels.is_none() {
            self.is_cut.set(true);
        }
        Some(Moments::exact(pixels?.iter().map(moments)))
    }

    /// Spends the work of sampling the area `part` of a picture. If the work would exceed the
    /// limit, spends only what is left of the budget, and returns `None`.
    pub fn pay_for_samples(&self, objects: usize, samples: usize, part: Area) -> Option<()> {
        let (objects, cells) = (objects as f64, part.pixels() as f64);
        let rays = samples as f64 * cells;
        let all = objects * OBJECT + rays * (RAY + TEST * objects) + CELL * cells;
        let fits = all <= self.remaining();
        self.spend(all.min(self.remaining()));
        self.is_cut.set(self.is_cut.get() || !fits);
        fits.then_some(())
    }
}
