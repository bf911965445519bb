//! Many objects in a part of the picture, told by the hierarchy's bounds alone.
//!
//! Bounds lie side by side in memory, objects anywhere. So a part with many is cut by bounds until few are left, and of these the objects
//! themselves are asked.

use std::hint::black_box;

use glam::DVec2;

use super::{Seen, World};
use crate::{
    area::Area,
    math::Doubt,
    tracer::{
        camera::Point,
        cover::Patch,
        hierarchy::{Item, Nearness},
        object::Object,
    },
};

/// So many objects stay in the nearest part of a processor's memory until they are needed.
const NEARBY: usize = 128;

impl World {
    /// All objects whose bounds meet a part of the picture, the one that may be nearest first.
    pub fn crowd_in(&self, part: Area, out: &mut Vec<Item>) {
        out.clear();
        let patch = Patch::new(&self.fast.camera, part);
        if let Some(rectangle) = self.hierarchy.rectangle(&patch) {
            self.hierarchy.within(&rectangle, out);
        }
    }

    /// Of a crowd those whose bounds meet a part of the picture and are not behind an object that fills it, in the same order. Only of
    /// those that may fill it the objects themselves are asked.
    pub fn crowd(&self, part: Area, among: &[Item], out: &mut Vec<Item>) {
        out.clear();
        let patch = Patch::new(&self.fast.camera, part);
        let Some(rectangle) = self.hierarchy.rectangle(&patch) else {
            return;
        };
        // About one of four is kept, and no processor guesses which: so each is put where it would be, and stays there or not.
        let mut kept = 0;
        out.extend_from_slice(among);
        for item in among {
            out[kept] = *item;
            kept += usize::from(item.meets(&rectangle));
        }
        out.truncate(kept);
        let [near, far] = self.clips_over(&patch);
        let mut hidden = Nearness::NONE;
        for item in out.iter().filter(|item| item.may_fill(&rectangle)) {
            if item.nearest <= hidden {
                break;
            }
            if let Some(live) = self.cover(item.object as usize, &patch, near, far)
                && live.is_whole
            {
                hidden = hidden.max(Nearness::below(live.inverse_depth.low));
            }
        }
        out.truncate(out.partition_point(|item| item.nearest > hidden));
        if out.len() < NEARBY && among.len() >= NEARBY {
            self.fetch(out);
        }
    }

    /// Asks for all objects of a crowd and for their colours, which are anywhere in memory, so that they come side by side and not one after
    /// the other, each when a ray asks for it.
    fn fetch(&self, crowd: &[Item]) {
        let first = |item: &Item| match self.objects[item.object as usize] {
            Object::EdgeOn => 0,
            _ => self.slots(item.object as usize)[0],
        };
        black_box(crowd.iter().map(first).sum::<usize>());
    }

    /// What [`slot_at`](World::slot_at) answers where a crowd, the one that may be nearest first, holds all that may be seen.
    pub fn slot_in_crowd(&self, x: u32, y: u32, offset: DVec2, crowd: &[Item]) -> usize {
        let point = self.fast.camera.sample_point(x, y, offset);
        match self.seen_in_crowd(&point, crowd) {
            Ok(seen) => self.slot(seen),
            Err(Doubt) => self.slot(self.seen_after_doubt(&point)),
        }
    }

    /// What is seen as far as `f64` can tell.
    #[inline]
    fn seen_in_crowd(&self, point: &Point, crowd: &[Item]) -> Result<Option<Seen>, Doubt> {
        let r = self.fast.camera.direction(point);
        let Some(unit) = self.hierarchy.unit(&r) else {
            return self.seen::<f64>(point);
        };
        let (mut nearest, mut bar) = (None, Nearness::NONE);
        for item in crowd {
            if item.nearest <= bar {
                break;
            }
            if item.is_at(unit) {
                self.raise(&r, item.object as usize, &mut nearest, &mut bar)?;
            }
        }
        self.with_color(&r, nearest)
    }
}
