//! Many objects in a part of the picture, told by the hierarchy's bounds alone.
//!
//! Bounds lie side by side in memory, objects anywhere. So a part with many is cut by bounds until few are left, and of these the objects
//! themselves are asked.

use glam::DVec2;

use super::{Nearest, World};
use crate::{
    area::Area,
    math::Doubt,
    tracer::{
        camera::Direction,
        cover::{Patch, Range},
        hierarchy::{Item, Nearness},
    },
};

impl World {
    /// All objects whose bounds meet a part of the picture and that are not behind one which fills it, the one that may be nearest first;
    /// whether that is so. If they seem to be more than `most`, it is not, and they are neither all of them nor in order.
    #[must_use]
    pub fn crowd_in(&self, part: Area, most: usize, out: &mut Vec<Item>) -> bool {
        out.clear();
        let patch = Patch::new(&self.fast.camera, part);
        let Some(rectangle) = self.hierarchy.rectangle(&patch) else {
            return true;
        };
        let clips = self.clips_over(&patch);
        let behind = |object: u32| self.behind(object as usize, &patch, clips);
        self.hierarchy.within(&rectangle, most, behind, out)
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
        let clips = self.clips_over(&patch);
        let mut hidden = Nearness::NONE;
        for item in out.iter().filter(|item| item.may_fill(&rectangle)) {
            if item.nearest <= hidden {
                break;
            }
            hidden = hidden.max(self.behind(item.object as usize, &patch, clips));
        }
        out.truncate(out.partition_point(|item| item.nearest > hidden));
    }

    /// About how many forms some objects have together.
    pub fn forms(&self, objects: impl Iterator<Item = usize>) -> usize {
        objects.map(|object| self.objects[object].forms()).sum()
    }

    /// Whether no more than `most` of a crowd have bounds that meet a part of the picture.
    pub fn is_met_by(&self, part: Area, crowd: &[Item], most: usize) -> bool {
        let patch = Patch::new(&self.fast.camera, part);
        self.hierarchy.rectangle(&patch).is_none_or(|rectangle| {
            let met = crowd.iter().filter(|item| item.meets(&rectangle));
            met.take(most + 1).count() <= most
        })
    }

    /// Whether one of a crowd has bounds that hold all of a part of the picture.
    pub fn may_fill(&self, part: Area, crowd: &[Item]) -> bool {
        let patch = Patch::new(&self.fast.camera, part);
        let rectangle = self.hierarchy.rectangle(&patch);
        rectangle.is_some_and(|rectangle| crowd.iter().any(|item| item.may_fill(&rectangle)))
    }

    /// Whether bounds of a crowd meet one of the quarters of a part of the picture and more than a third of the others, in the mean: to cut by them does
    /// not tell objects apart.
    pub fn is_hardly_cut(&self, part: Area, crowd: &[Item]) -> bool {
        let met = |quarter: Area| {
            let patch = Patch::new(&self.fast.camera, quarter);
            let rectangle = self.hierarchy.rectangle(&patch);
            let met = |rectangle| crowd.iter().filter(|item| item.meets(&rectangle)).count();
            rectangle.map_or(0, met)
        };
        // A part of one row or column has two.
        let (quarters, met) = part.quarters().fold((0, 0), |(count, sum), quarter| {
            (count + 1, sum + met(quarter))
        });
        3 * met > (quarters + 2) * crowd.len()
    }

    /// What [`slot_at`](World::slot_at) answers in a part of the picture with this crowd.
    #[inline]
    pub fn slot_in_crowd(&self, x: u32, y: u32, offset: DVec2, crowd: &[Item]) -> usize {
        let point = self.fast.camera.sample_point(x, y, offset);
        let r = self.fast.camera.direction(&point);
        let Some(at) = self.hierarchy.units(&r) else {
            return self.slot_at(x, y, offset);
        };
        let seen = self.nearest_in_crowd(crowd, at, &r);
        match seen.and_then(|nearest| self.with_color(&r, nearest)) {
            Ok(seen) => self.slot(seen),
            Err(Doubt) => self.slot(self.seen_after_doubt(&point)),
        }
    }

    #[inline]
    fn nearest_in_crowd(
        &self,
        crowd: &[Item],
        at: [u32; 2],
        r: &Direction<f64>,
    ) -> Result<Option<Nearest<f64>>, Doubt> {
        let mut nearest = None;
        // All farther than this is hidden.
        let mut bar = Nearness::NONE;
        for item in crowd {
            if item.nearest <= bar {
                break;
            }
            if item.holds(at) {
                self.raise(r, item.object as usize, &mut nearest, &mut bar)?;
            }
        }
        Ok(nearest)
    }

    /// All that is not nearer than this is behind an object, if that fills a patch.
    fn behind(&self, object: usize, patch: &Patch, [near, far]: [Option<Range>; 2]) -> Nearness {
        match self.cover(object, patch, near, far) {
            Some(live) if live.is_whole => Nearness::below(live.inverse_depth.low),
            _ => Nearness::NONE,
        }
    }
}
