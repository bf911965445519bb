//! How much work may be spent on a picture.
//!
//! Work is counted where it arises, not timed: the same picture gets the same verdict. A unit is that of the exact picture, some 30 ns.

use std::{cell::Cell, sync::atomic::AtomicBool};

use super::{
    light::{Average, moments, numbers},
    textbook::Moments,
};
use crate::{area::Area, exact::Integrator, scene::Scene, tracer::World};

/// Units for a picture, and for each of its pixels: together a second for one of 320 × 180 pixels, and three for one of 1280 × 720.
const PICTURE: f64 = 2.6e7;
const PIXEL: f64 = 41.0;

/// Units of preparing an object for an exact picture, and for a sampled one, of a ray and of asking whether it hits a shape, and of comparing a cell.
const WORLD_OBJECT: f64 = 20.0;
const OBJECT: f64 = 6.0;
const RAY: f64 = 0.3;
const TEST: f64 = 0.06;
const CELL: f64 = 2.0;

/// The work that was spent, and how much may be.
pub struct Work<'a> {
    spent: Cell<f64>,
    most: Cell<f64>,
    /// Whether something was left out for that.
    is_cut: Cell<bool>,
    cancel: &'a AtomicBool,
}

/// The work that may be spent on a picture of so many pixels.
pub fn most(pixels: u64) -> f64 {
    PICTURE + PIXEL * pixels as f64
}

/// The work of an exact picture of so many objects.
pub fn of_exact(units: u64, objects: usize, pixels: u64) -> f64 {
    units as f64 + WORLD_OBJECT * objects as f64 + CELL * pixels as f64
}

impl<'a> Work<'a> {
    /// None yet.
    pub fn new(most: f64, cancel: &'a AtomicBool) -> Self {
        Self {
            spent: Cell::new(0.0),
            most: Cell::new(most),
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
        let may = self.spent.get() < self.most.get();
        self.is_cut.set(self.is_cut.get() || !may);
        may
    }

    /// Whether something was left out.
    pub fn is_cut(&self) -> bool {
        self.is_cut.get()
    }

    /// Keeps a share of the work that is left, until it is restored to what is answered.
    pub fn keep(&self, share: f64) -> f64 {
        let most = self.most.get();
        let left = (most - self.spent.get()).max(0.0);
        self.most.replace(most - share * left)
    }

    /// Restores what was kept.
    pub fn restore(&self, most: f64) {
        self.most.set(most);
    }

    /// What follows has to be done, however much it is, until what is answered is restored.
    pub fn lift(&self) -> f64 {
        self.most.replace(f64::INFINITY)
    }

    /// The exact means and variances of what a part of a scene's picture shows; none if they take too much.
    pub fn exact_moments(&self, scene: &Scene, average: Average, part: Area) -> Option<Moments> {
        let world = World::new_unless(scene, self.cancel).ok()?;
        let left = (self.most.get() - self.spent.get()).max(0.0);
        let integrator = Integrator::of(&world, numbers(average)).within(left as u64);
        let pixels = integrator.pixels(part, self.cancel);
        self.spend(of_exact(
            integrator.work(),
            scene.objects.len(),
            part.pixels(),
        ));
        if pixels.is_none() {
            self.is_cut.set(true);
        }
        let (mean, variance) = pixels?.iter().map(moments).unzip();
        Some(Moments { mean, variance })
    }

    /// A part of a picture of so many objects is to be sampled; none if that takes more than is left, which is spent then.
    pub fn pay_for_samples(&self, objects: usize, samples: usize, part: Area) -> Option<()> {
        let (objects, cells) = (objects as f64, part.pixels() as f64);
        let rays = samples as f64 * cells;
        let all = objects * OBJECT + rays * (RAY + TEST * objects) + CELL * cells;
        let left = (self.most.get() - self.spent.get()).max(0.0);
        self.spend(all.min(left));
        let fits = all <= left;
        self.is_cut.set(self.is_cut.get() || !fits);
        fits.then_some(())
    }

    /// So many cells of a scene of so many objects are asked what they show.
    pub fn labelled(&self, objects: usize, cells: usize) {
        self.spend(of_exact(0, objects, cells as u64));
    }

    /// So many cells are compared.
    pub fn compared(&self, cells: usize) {
        self.spend(CELL * cells as f64);
    }
}
