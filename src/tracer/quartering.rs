//! The picture cut into parts that show one colour for certain, and pixels of which that is not known.
//!
//! Sampled and exact pictures share it: what is certain of a part is so for every ray through it, and for every decision about
//! one.

use std::ops::ControlFlow;

use super::{outlook::Live, pixel::Checks, world::World};
use crate::area::Area;

/// Of so many candidates those of a quarter are asked of the hierarchy, which looks at a few bytes of each, and not at those of other quarters.
const MANY: usize = 64;

/// Cuts the parts of one picture.
#[derive(Debug)]
pub struct Quartering<'a> {
    world: &'a World,
    /// Parts of so few pixels are not cut.
    grain: u64,
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
}

/// The candidates at each depth of the quartering, kept from tile to tile for their room.
#[derive(Debug, Default)]
pub struct Room(Vec<Vec<Live>>);

impl<'a> Quartering<'a> {
    /// For a prepared scene.
    pub fn new(world: &'a World) -> Self {
        Self { world, grain: 1 }
    }

    /// The same, but parts of so few pixels are not cut any more: it would cost more than it saves.
    pub fn down_to(self, pixels: u64) -> Self {
        Self {
            grain: pixels,
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
        let mut live = Vec::new();
        self.world.live_in(area, &mut live);
        self.cut(area, &live, 0, room, visit)
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
        if room.0.len() <= depth {
            room.0.push(Vec::new());
        }
        let mut below = std::mem::take(&mut room.0[depth]);
        let flow = area.quarters().try_for_each(|quarter| {
            match live.len() {
                ..MANY => self.world.live(quarter, live, &mut below),
                _ => self.world.live_in(quarter, &mut below),
            }
            self.cut(quarter, &below, depth + 1, room, visit)
        });
        room.0[depth] = below;
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
