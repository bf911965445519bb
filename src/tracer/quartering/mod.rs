//! The picture cut into parts that show one colour for certain, pixels of which that is not known, and parts where to know more is not worth
//! what it costs.
//!
//! Sampled and exact pictures share it: what is certain of a part is so for every ray through it, and for every decision about
//! one.

mod budget;
#[cfg(test)]
mod tests;
mod trust;

use std::ops::ControlFlow;

use self::{
    budget::{Budget, FEW_CANDIDATES},
    trust::Trust,
};
use super::{
    hierarchy::Item,
    outlook::Live,
    pixel::{Checks, Tiling},
    world::World,
};
use crate::area::Area;

/// A part with so many candidates is cut by their bounds alone, without a look at most of them, unless the bounds of the first ones hold most
/// of it. Fewer may well be large, or slivers of whose bounds they fill but a small part.
const CROWD_CANDIDATES: usize = 32;

/// So many bounds are looked at in less time than it takes to go down the hierarchy, whose lists have up to 32 in their last cell.
const SCANNED: usize = 16;

/// Cuts the parts of one picture.
#[derive(Debug)]
pub struct Quartering<'a> {
    world: &'a World,
    budget: Budget,
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
    /// A pixel in which more than one colour may be seen.
    Open {
        /// Its column.
        x: u32,
        /// Its row.
        y: u32,
        /// The objects that may be seen there, in file order.
        live: &'a [Live],
    },
    /// More than one colour may be seen, and to trace the samples one by one costs less than to know more; or it is not known what is seen, as
    /// that had gained nothing where it was looked for before.
    Plain {
        /// Where it lies.
        area: Area,
        /// What its rays may meet, as far as that is known.
        among: Among<'a>,
    },
}

/// What the rays of a part may meet.
#[derive(Clone, Copy, Debug)]
pub enum Among<'a> {
    /// What the hierarchy knows on their way.
    All,
    /// Objects whose bounds meet the part, the one that may be nearest first.
    Crowd(&'a [Item]),
    /// Objects that may be seen there, in file order.
    Live(&'a [Live]),
}

/// What is known of an area: the objects that may be seen there, in file order, which are some of a crowd there or in a larger one.
#[derive(Clone, Copy)]
struct Known<'a> {
    live: &'a [Live],
    crowd: &'a [Item],
}

/// What is kept from area to area: the candidates at each depth of the quartering, for their room, and whether it was worth to look for them.
#[derive(Debug, Default)]
pub struct Room {
    crowds: Vec<Vec<Item>>,
    live: Vec<Vec<Live>>,
    trust: Trust,
}

impl<'a> Quartering<'a> {
    /// For a prepared scene whose picture is to be known exactly: no part is [`Plain`](Part::Plain).
    pub fn new(world: &'a World) -> Self {
        let budget = Budget::ENDLESS;
        Self { world, budget }
    }

    /// The same for a picture with so many samples a pixel, on average.
    pub fn for_samples(world: &'a World, samples: f64) -> Self {
        let budget = Budget::of(samples);
        Self { world, budget }
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
        if self.budget.is_limited() && !room.trust.takes_a_look() {
            return visit(plain(area), None);
        }
        let mut plain = 0;
        let flow = self.whole(area, room, &mut |part, checks| {
            if let Part::Plain {
                area,
                among: Among::All,
            } = part
            {
                plain += area.pixels();
            }
            visit(part, checks)
        });
        room.trust.learn(plain, area.pixels());
        flow
    }

    fn whole(
        &self,
        area: Area,
        room: &mut Room,
        visit: &mut impl FnMut(Part, Option<&Checks>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut crowd = take(&mut room.crowds, 0);
        let mut budget = self.budget;
        let mut is_found = self.find(area, budget.most_bounds(area), &mut crowd);
        if !is_found {
            budget = budget.probed(self.world, area);
            is_found = budget.most(area) > self.budget.most_bounds(area)
                && self.find(area, budget.most(area), &mut crowd);
        }
        let flow = match is_found {
            true => self.disperse(area, &crowd, budget, 0, room, visit),
            false => visit(plain(area), None),
        };
        room.crowds[0] = crowd;
        flow
    }

    /// Finds the candidates of an area, if they do not seem to be more than `most`.
    fn find(&self, area: Area, most: usize, crowd: &mut Vec<Item>) -> bool {
        most > 0 && self.world.crowd_in(area, most, crowd)
    }

    /// Cuts a part by its candidates' bounds until they are few.
    fn disperse(
        &self,
        area: Area,
        crowd: &[Item],
        mut budget: Budget,
        depth: usize,
        room: &mut Room,
        visit: &mut impl FnMut(Part, Option<&Checks>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if crowd.len() > budget.most_bounds(area) {
            budget = budget.probed(self.world, area);
        }
        let is_for_a_look = match area.pixels() {
            1 => {
                // Few enough to be counted, first.
                crowd.len() <= budget.most(area) && {
                    let objects = crowd.iter().map(|item| item.object as usize);
                    budget.is_for_forms(self.world.forms(objects))
                }
            }
            _ => {
                let is_large = match crowd.get(..CROWD_CANDIDATES) {
                    None => true,
                    Some(first) => self.world.is_hardly_cut(area, first),
                };
                if is_large && !budget.is_for_a_look(area, crowd.len()) {
                    // Rays ask them all.
                    budget = budget.probed(self.world, area);
                }
                is_large && budget.is_for_a_look(area, crowd.len())
            }
        };
        if is_for_a_look {
            let mut live = take(&mut room.live, depth);
            self.world.live_of(area, crowd, &mut live);
            let flow = self.cut(
                area,
                Known { live: &live, crowd },
                budget,
                depth + 1,
                room,
                visit,
            );
            room.live[depth] = live;
            return flow;
        }
        let is_small = area.pixels() == 1 || !budget.is_for_a_cut(area, crowd.len());
        if is_small || !self.is_worth_a_cut(area, crowd, budget) {
            return visit(plain_among(area, crowd), None);
        }
        let mut below = take(&mut room.crowds, depth + 1);
        let flow = area.quarters().try_for_each(|quarter| {
            self.world.crowd(quarter, crowd, &mut below);
            self.disperse(quarter, &below, budget, depth + 1, room, visit)
        });
        room.crowds[depth + 1] = below;
        flow
    }

    /// Whether an area may be cut by a crowd's bounds, and its quarters are likely to have so few of it that this is a gain, or something that
    /// hides others, as far as the middle tells.
    fn is_worth_a_cut(&self, area: Area, crowd: &[Item], budget: Budget) -> bool {
        // What was begun is carried on, though where objects are larger than the quarters there come to be more of them for each sample.
        let most = self.budget.most_bounds(area).saturating_mul(2);
        if crowd.len() > most.max(budget.most(area)) {
            return false;
        }
        let few = SCANNED.max(budget.most_in_a_crowd());
        crowd.len() <= few
            || self.world.is_met_by(area.middle(), crowd, few)
            || crowd.len() <= budget.most(area)
                && area
                    .quarters()
                    .any(|quarter| self.world.may_fill(quarter, crowd))
    }

    /// Cuts a part by what may be seen in it.
    fn cut(
        &self,
        area: Area,
        Known { live, crowd }: Known,
        mut budget: Budget,
        depth: usize,
        room: &mut Room,
        visit: &mut impl FnMut(Part, Option<&Checks>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let view = self.view(area, live);
        if let View::One(slot) = view {
            return visit(Part::Flat { area, slot }, None);
        }
        if live.len() > budget.most(area) {
            budget = budget.probed(self.world, area);
        }
        if live.len() > budget.most(area) {
            let part = match live.len() <= FEW_CANDIDATES {
                true => Part::Plain {
                    area,
                    among: Among::Live(live),
                },
                false => plain_among(area, crowd),
            };
            return visit(part, None);
        }
        if area.pixels() == 1 {
            let Area { x, y, .. } = area;
            return visit(Part::Open { x, y, live }, None);
        }
        if let [only] = live
            && only.is_whole
        {
            if budget.is_for_checks()
                && let Some(flow) = self.world.checks(area, live, visit)
            {
                return flow;
            }
            let is_dust = view == View::Dust && budget.is_limited();
            if is_dust || !budget.is_for_quarters(area) {
                let among = Among::Live(live);
                return visit(Part::Plain { area, among }, None);
            }
            // What hides all else in the whole does so in its quarters.
            return area.quarters().try_for_each(|quarter| {
                self.cut(
                    quarter,
                    Known { live, crowd },
                    budget,
                    depth + 1,
                    room,
                    visit,
                )
            });
        }
        let mut below = take(&mut room.live, depth);
        let flow = area.quarters().try_for_each(|quarter| {
            self.world.live(quarter, live, &mut below);
            self.cut(
                quarter,
                Known {
                    live: &below,
                    crowd,
                },
                budget,
                depth + 1,
                room,
                visit,
            )
        });
        room.live[depth] = below;
        flow
    }

    /// What is seen in an area of which these may be.
    fn view(&self, area: Area, live: &[Live]) -> View {
        let world = self.world;
        match live {
            [] => View::One(world.background()),
            [only] if only.is_whole => {
                let [first, second] = world.slots(only.object);
                if first == second {
                    return View::One(first);
                }
                match world.tiling(area, only.object) {
                    Tiling::One { odd } => View::One(if odd { second } else { first }),
                    Tiling::Several => View::Several,
                    Tiling::Dust => View::Dust,
                }
            }
            _ => View::Several,
        }
    }
}

/// What is seen in an area.
#[derive(Clone, Copy, PartialEq, Eq)]
enum View {
    /// One colour, which is certain.
    One(usize),
    /// Several, perhaps.
    Several,
    /// Squares of one board, several in nearly each pixel.
    Dust,
}

/// A part of which nothing is known.
fn plain<'a>(area: Area) -> Part<'a> {
    let among = Among::All;
    Part::Plain { area, among }
}

/// A part whose rays may meet some objects alone.
fn plain_among(area: Area, crowd: &[Item]) -> Part<'_> {
    match crowd.len() <= SCANNED {
        true => Part::Plain {
            area,
            among: Among::Crowd(crowd),
        },
        false => plain(area),
    }
}

/// The list of a depth, to be put back there.
fn take<T>(lists: &mut Vec<Vec<T>>, depth: usize) -> Vec<T> {
    if lists.len() <= depth {
        lists.resize_with(depth + 1, Vec::new);
    }
    std::mem::take(&mut lists[depth])
}
