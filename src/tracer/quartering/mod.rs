//! The picture cut into parts that show one colour for certain, pixels of which that is not known,
//! and parts with too many candidates.
//!
//! In: the world, and an area of its picture. Out: the parts of that area, one after the other. The
//! method is Warnock's subdivision ("A hidden surface algorithm for computer generated halftone
//! pictures", 1969): an area is quartered until it shows one colour, is a pixel, or has more
//! candidates than its samples are worth. The samples of its pixels are traced among the candidates
//! then, or, if those are many, one by one among the objects nearby. Sampled and exact pictures
//! share it: what is certain of a part is so for every ray through it.
//!
//! Areas are those of one fixed grid over the whole picture, whatever part of it is asked for, so
//! that a pixel's candidates do not depend on that.

#[cfg(test)]
mod tests;

use std::ops::ControlFlow;

use super::{
    candidates::{self, Candidate},
    checker_corners::{self, Checks, Shown},
    quadtree::OBJECTS_A_CELL,
    world::World,
};
use crate::area::Area;

/// The side of the squares that quartering begins with, in pixels: a power of two, so that quarters
/// are squares.
pub const GRID: u32 = checker_corners::SIDE as u32;

/// A part is quartered while it has so many samples for each candidate. Measured: 4 and 8 are
/// within a tenth of each other on 10³ and 10⁵ spheres, where 2 is up to a quarter slower; 3000
/// slivers with one sample a pixel take half as long with 4 as with 8.
const SAMPLES_A_CANDIDATE: f64 = 4.0;

/// To find where a candidate is seen, from a square of the grid down, costs as much as so many
/// objects that samples are asked about one by one: for a sample, those whose bounds hold it, and
/// one more for its way down the quadtree. Measured: with 80, 10⁴ spheres on 320×180 pixels take a
/// tenth longer, and with 200 on 640×360 a fiftieth.
const ASKED_A_CANDIDATE: f64 = 120.0;

/// Cuts the parts of one picture.
#[derive(Debug)]
pub struct Quartering<'a> {
    world: &'a World,
    /// Samples a pixel; infinite for a picture that is to be known whatever it costs.
    samples: f64,
}

/// A part of the picture.
#[derive(Clone, Copy, Debug)]
pub enum Part<'a> {
    /// One colour is seen in all of it.
    OneColor {
        /// Where it lies.
        area: Area,
        /// The colour's slot in the palette.
        slot: usize,
    },
    /// A pixel in which more than one colour may be seen, as far as is known.
    Pixel {
        /// Its column.
        x: u32,
        /// Its row.
        y: u32,
        /// The objects that may be seen there, in file order.
        candidates: &'a [Candidate],
        /// What it shows of a board, where that is known.
        checks: Option<&'a Checks>,
    },
    /// More may be seen than is worth to know: its samples are traced one by one.
    Crowded {
        /// Where it lies.
        area: Area,
    },
}

/// Lists that are kept from area to area: the candidates at each depth of the quartering.
#[derive(Debug, Default)]
pub struct Scratch {
    candidates: Vec<Vec<Candidate>>,
}

impl<'a> Quartering<'a> {
    /// For a prepared scene whose picture is to be known exactly: no part is
    /// [`Crowded`](Part::Crowded).
    pub fn new(world: &'a World) -> Self {
        Self::for_samples(world, f64::INFINITY)
    }

    /// The same for a picture with so many samples a pixel, on average.
    pub fn for_samples(world: &'a World, samples: f64) -> Self {
        Self { world, samples }
    }

    /// Shows `visit` the parts of an area, until it has seen enough. They cover the area, and each
    /// pixel once.
    pub fn parts(
        &self,
        wanted: Area,
        scratch: &mut Scratch,
        visit: &mut impl FnMut(Part) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let whole = self.world.picture();
        wanted.grid(GRID).try_for_each(|square| {
            let area = square.common(whole);
            let mut cut = Cut {
                quartering: self,
                wanted,
                is_all_wanted: area.common(wanted) == area,
                visit,
            };
            let mut candidates = take(scratch, 0);
            let (most, list) = (self.most(area), &mut candidates);
            let is_worth = |objects, asked| self.is_worth_cutting(area, objects, asked);
            let flow = match candidates::within(self.world, area, most, is_worth, list) {
                true => cut.cut(area, &candidates, 1, scratch),
                false => cut.show(Part::Crowded { area }),
            };
            scratch.candidates[0] = candidates;
            flow
        })
    }

    /// Whether to tell the objects of an area apart costs less than to trace its samples one by
    /// one, each of which is asked about so many of them.
    fn is_worth_cutting(&self, area: Area, objects: usize, asked: f64) -> bool {
        let samples = self.samples * area.pixels() as f64;
        objects <= OBJECTS_A_CELL || samples * (1.0 + asked) >= ASKED_A_CANDIDATE * objects as f64
    }

    /// The most candidates of an area that are worth to be told apart: a sample for each in a
    /// pixel, where the quartering ends.
    fn most(&self, area: Area) -> usize {
        let shared = area.pixels() as f64 / SAMPLES_A_CANDIDATE;
        (self.samples * shared.max(1.0)) as usize
    }
}

/// One square of the grid while it is cut.
struct Cut<'a, 'b, V> {
    quartering: &'a Quartering<'a>,
    /// The part that is wanted of it, and whether that is all of it.
    wanted: Area,
    is_all_wanted: bool,
    visit: &'b mut V,
}

impl<V: FnMut(Part) -> ControlFlow<()>> Cut<'_, '_, V> {
    /// Cuts an area by what may be seen in it.
    fn cut(
        &mut self,
        area: Area,
        candidates: &[Candidate],
        depth: usize,
        scratch: &mut Scratch,
    ) -> ControlFlow<()> {
        let world = self.quartering.world;
        match candidates {
            [] => {
                let slot = world.background();
                return self.show(Part::OneColor { area, slot });
            }
            [only] if only.is_whole => {
                let slots = world.slots(only.object);
                let [slot, second] = slots;
                if slot == second {
                    return self.show(Part::OneColor { area, slot });
                }
                let show = &mut |area: Area, seen: Shown| {
                    let checks = match seen {
                        Shown::One(odd) => {
                            let slot = slots[usize::from(odd)];
                            return self.show(Part::OneColor { area, slot });
                        }
                        // Samples tell certain squares apart, and exact areas need not.
                        Shown::Squares(checks) => {
                            let is_exact = self.quartering.samples.is_infinite();
                            (checks.is_certain || is_exact).then_some(checks)
                        }
                        Shown::Unknown => None,
                    };
                    self.show(Part::Pixel {
                        x: area.x,
                        y: area.y,
                        candidates,
                        checks,
                    })
                };
                if let Some(flow) = checker_corners::show(world, area, only.object, show) {
                    return flow;
                }
            }
            _ => {}
        }
        let is_worth_more = candidates.len() <= self.quartering.most(area);
        // A cell of the quadtree lists as many, of which each sample would be asked instead.
        if !is_worth_more && candidates.len() > OBJECTS_A_CELL {
            return self.show(Part::Crowded { area });
        }
        if !is_worth_more || area.pixels() == 1 {
            let mut pixels = area.iter();
            return pixels.try_for_each(|(x, y)| {
                self.show(Part::Pixel {
                    x,
                    y,
                    candidates,
                    checks: None,
                })
            });
        }
        let mut below = take(scratch, depth);
        let wanted = self.wanted;
        let mut quarters = area.quarters().filter(|quarter| quarter.meets(wanted));
        let flow = quarters.try_for_each(|quarter| {
            candidates::narrowed(world, quarter, candidates, &mut below);
            self.cut(quarter, &below, depth + 1, scratch)
        });
        scratch.candidates[depth] = below;
        flow
    }

    /// Shows what is wanted of a part.
    #[inline]
    fn show(&mut self, part: Part) -> ControlFlow<()> {
        match self.is_all_wanted {
            true => (self.visit)(part),
            false => self.show_wanted(part),
        }
    }

    fn show_wanted(&mut self, part: Part) -> ControlFlow<()> {
        let part = match part {
            Part::OneColor { area, slot } => Part::OneColor {
                area: area.common(self.wanted),
                slot,
            },
            Part::Crowded { area } => Part::Crowded {
                area: area.common(self.wanted),
            },
            Part::Pixel { .. } => part,
        };
        let is_wanted = match part {
            Part::OneColor { area, .. } | Part::Crowded { area } => area.pixels() > 0,
            Part::Pixel { x, y, .. } => Area::pixel(x, y).meets(self.wanted),
        };
        match is_wanted {
            true => (self.visit)(part),
            false => ControlFlow::Continue(()),
        }
    }
}

/// The list of a depth, to be put back there.
fn take(scratch: &mut Scratch, depth: usize) -> Vec<Candidate> {
    if scratch.candidates.len() <= depth {
        scratch.candidates.resize_with(depth + 1, Vec::new);
    }
    std::mem::take(&mut scratch.candidates[depth])
}
