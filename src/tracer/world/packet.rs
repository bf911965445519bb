//! The rays of a pixel, traced one by one, but with one way down the hierarchy where that is worth it.

use glam::DVec2;

use super::{Nearest, Nearness, World};
use crate::{
    math::Doubt,
    tracer::{
        camera::{Direction, Point},
        hierarchy::{Rectangle, Shared},
        quartering::Trust,
    },
};

/// With fewer rays it takes no longer to look for what each of them may meet.
const FEW: u64 = 3;

/// What is kept from pixel to pixel: room, and whether it was worth it to look for what rays share.
#[derive(Debug, Default)]
pub struct Packet {
    rays: Vec<Ray>,
    shared: Shared,
    trust: Trust,
}

#[derive(Debug)]
struct Ray {
    point: Point,
    r: Direction<f64>,
    at: [u32; 2],
}

impl Packet {
    /// Whether it looks for what so many rays share; goes on to the next pixel.
    pub fn takes_a_look(&mut self, rays: u64) -> bool {
        rays >= FEW && self.trust.takes_a_look()
    }
}

impl World {
    /// Tells `see` what [`slot_at`](World::slot_at) answers for some offsets in a pixel.
    pub fn slots_in(
        &self,
        [x, y]: [u32; 2],
        offsets: impl Iterator<Item = DVec2>,
        packet: &mut Packet,
        mut see: impl FnMut(usize),
    ) {
        packet.rays.clear();
        let mut within: Option<Rectangle> = None;
        for offset in offsets {
            let point = self.fast.camera.sample_point(x, y, offset);
            let r = self.fast.camera.direction(&point);
            let Some(at) = self.hierarchy.units(&r) else {
                see(self.slot(self.seen_after_doubt(&point)));
                continue;
            };
            let here = Rectangle::of(at);
            within = Some(within.map_or(here, |within| within.with(&here)));
            packet.rays.push(Ray { point, r, at });
        }
        let Packet {
            rays,
            shared,
            trust,
        } = packet;
        let Some(within) = within else {
            return;
        };
        self.hierarchy.share(&within, rays.len(), shared);
        trust.learn(u64::from(!shared.is_worth_it()), 1);
        for ray in rays {
            let nearest = self.nearest_of(ray, shared);
            let seen = nearest.and_then(|nearest| self.with_color(&ray.r, nearest));
            see(self.slot(seen.unwrap_or_else(|Doubt| self.seen_after_doubt(&ray.point))));
        }
    }

    /// The nearest crossing of a ray with what it may meet.
    #[inline]
    fn nearest_of(&self, ray: &Ray, shared: &Shared) -> Result<Option<Nearest<f64>>, Doubt> {
        let (mut nearest, mut bar) = (None, Nearness::NONE);
        let mut asked = self.hierarchy.shared_of(shared, ray.at);
        while let Some(index) = asked.next(bar) {
            self.raise(&ray.r, index, &mut nearest, &mut bar)?;
        }
        Ok(nearest)
    }
}
