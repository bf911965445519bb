//! The picture cut into parts that show one colour for certain, and pixels of which that is not known.
//!
//! Sampled and exact pictures share it: what is certain of a part is so for every ray through it, and for every decision about
//! one.

use std::ops::ControlFlow;

use super::{hierarchy::Item, outlook::Live, pixel::Checks, world::World};
use crate::area::Area;

/// A part with so many candidates is cut by their bounds alone, without a look at most of them.
const CROWD: usize = 64;

/// The same of a scene with many objects; and where few samples are traced in crowds. Objects that are few may well be large, or slivers
/// of whose bounds they fill but a small part.
const MANY: usize = 1 << 14;
const CROWD_OF_MANY: usize = 8;
const KEPT_CROWD: usize = 4;

/// A tile with so many objects for each of its pixels has many for a few samples, too.
const MANY_A_PIXEL: f64 = 0.25;

/// Cuts the parts of one picture.
#[derive(Debug)]
pub struct Quartering<'a> {
    world: &'a World,
    /// Parts of so few pixels are not cut.
    grain: u64,
    /// Whether crowds, where there are many objects, stay crowds in parts that are not cut.
    keeps_crowds: bool,
}

/// A part of the picture.
#[derive(Clone, Copy, Debug)]
pub enum Part<'a> {
    /// One colour is seen in all of it.
    Flat {
        /// Where it lies.
        area: Area,
        /// The colour's slot in the palette.
        slot: usize,
    },
    /// A pixel in which more than one colour may be seen; or one of a few together in which that is so.
    Open {
        /// Its column.
        x: u32,
        /// Its row.
        y: u32,
        /// The objects that may be seen there, in file order.
        live: &'a [Live],
    },
    /// The same where there are many objects, at which nobody has looked themselves.
    Crowd {
        /// Its column.
        x: u32,
        /// Its row.
        y: u32,
        /// The objects whose bounds meet the pixel, the one that may be nearest first.
        crowd: &'a [Item],
    },
}

/// How the crowd of a tile is dispersed.
#[derive(Clone, Copy)]
struct Dispersal {
    /// So many candidates are a crowd.
    crowd: usize,
    /// Whether it stays one in parts that are not cut.
    keeps: bool,
}

/// The candidates at each depth of the quartering, kept from tile to tile for their room.
#[derive(Debug, Default)]
pub struct Room {
    crowds: Vec<Vec<Item>>,
    live: Vec<Vec<Live>>,
}

impl<'a> Quartering<'a> {
    /// For a prepared scene.
    pub fn new(world: &'a World) -> Self {
        Self {
            world,
            grain: 1,
            keeps_crowds: false,
        }
    }

    /// The same, but parts of so few pixels are not cut any more: it would cost more than it saves.
    pub fn down_to(self, pixels: u64) -> Self {
        Self {
            grain: pixels,
            ..self
        }
    }

    /// The same, but where there are many objects those of a pixel are told by their bounds alone: to look at each of them would cost more than
    /// it saves a few samples.
    pub fn for_few_samples(self) -> Self {
        Self {
            keeps_crowds: true,
            ..self
        }
    }

    /// Shows `visit` the parts of an area, until it has seen enough. They cover the area, and each pixel once.
    pub fn parts(
        &self,
        area: Area,
        room: &mut Room,
        visit: &mut impl FnMut(Part) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.parts_and_checks(area, room, &mut |part, _| visit(part))
    }

    /// The same, with what an open pixel shows of a board, where that is known.
    pub fn parts_and_checks(
        &self,
        area: Area,
        room: &mut Room,
        visit: &mut impl FnMut(Part, Option<&Checks>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut crowd = take(&mut room.crowds, 0);
        self.world.crowd_in(area, &mut crowd);
        let is_dense = crowd.len() as f64 >= MANY_A_PIXEL * area.pixels() as f64;
        let are_many = self.world.len() >= MANY || self.keeps_crowds && is_dense;
        let way = Dispersal {
            crowd: match (are_many, self.keeps_crowds) {
                (false, _) => CROWD,
                (true, false) => CROWD_OF_MANY,
                (true, true) => KEPT_CROWD,
            },
            keeps: are_many && self.keeps_crowds,
        };
        let flow = self.disperse(area, &crowd, way, 0, room, visit);
        room.crowds[0] = crowd;
        flow
    }

    /// Cuts a part by its candidates' bounds until they are few.
    fn disperse(
        &self,
        area: Area,
        crowd: &[Item],
        way: Dispersal,
        depth: usize,
        room: &mut Room,
        visit: &mut impl FnMut(Part, Option<&Checks>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let is_fine = area.pixels() <= self.grain;
        if is_fine && depth > 0 && way.keeps && !crowd.is_empty() {
            return area
                .iter()
                .try_for_each(|(x, y)| visit(Part::Crowd { x, y, crowd }, None));
        }
        if crowd.len() < way.crowd || is_fine {
            let mut live = take(&mut room.live, depth);
            self.world.live_of(area, crowd, &mut live);
            let flow = self.cut(area, &live, depth + 1, room, visit);
            room.live[depth] = live;
            return flow;
        }
        let mut below = take(&mut room.crowds, depth + 1);
        let flow = area.quarters().try_for_each(|quarter| {
            self.world.crowd(quarter, crowd, &mut below);
            self.disperse(quarter, &below, way, depth + 1, room, visit)
        });
        room.crowds[depth + 1] = below;
        flow
    }

    fn cut(
        &self,
        area: Area,
        live: &[Live],
        depth: usize,
        room: &mut Room,
        visit: &mut impl FnMut(Part, Option<&Checks>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if let Some(slot) = self.only_slot(area, live) {
            return visit(Part::Flat { area, slot }, None);
        }
        if area.pixels() <= self.grain {
            return area
                .iter()
                .try_for_each(|(x, y)| visit(Part::Open { x, y, live }, None));
        }
        if let [only] = live
            && only.is_whole
        {
            if let Some(flow) = self.world.checks(area, live, visit) {
                return flow;
            }
            // What hides all else in the whole does so in its quarters.
            return area
                .quarters()
                .try_for_each(|quarter| self.cut(quarter, live, depth + 1, room, visit));
        }
        let mut below = take(&mut room.live, depth);
        let flow = area.quarters().try_for_each(|quarter| {
            self.world.live(quarter, live, &mut below);
            self.cut(quarter, &below, depth + 1, room, visit)
        });
        room.live[depth] = below;
        flow
    }

    /// The only colour in an area, if it is certain that there is but one.
    fn only_slot(&self, area: Area, live: &[Live]) -> Option<usize> {
        let world = self.world;
        match live {
            [] => Some(world.background()),
            [only] if only.is_whole => {
                let [first, second] = world.slots(only.object);
                if first == second {
                    Some(first)
                } else {
                    let odd = world.only_square(area, only.object)?;
                    Some(if odd { second } else { first })
                }
            }
            _ => None,
        }
    }
}

/// The list of a depth, to be put back there.
fn take<T>(lists: &mut Vec<Vec<T>>, depth: usize) -> Vec<T> {
    if lists.len() <= depth {
        lists.resize_with(depth + 1, Vec::new);
    }
    std::mem::take(&mut lists[depth])
}
