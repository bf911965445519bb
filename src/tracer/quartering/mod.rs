//! The picture divided into parts that certainly show one colour, pixels that may show several, and
//! parts with too many candidates.
//!
//! In: the world, and an area of its picture. Out: the parts of that area, one after the other. The
//! method is Warnock's subdivision ("A hidden surface algorithm for computer generated halftone
//! pictures", 1969): an area is quartered until it shows one colour, is a single pixel, or has more
//! candidates than its samples are worth. The samples of a pixel are then tested only against its
//! candidates. If there are too many candidates, each sample is tested against the objects nearby.
//! Sampled and exact pictures share this method: what is certain for a part holds for every ray
//! through it.
//!
//! Areas are those of one fixed grid over the whole picture, whatever part of it is wanted, so that
//! a pixel's candidates do not depend on the part.

#[cfg(test)]
mod tests;

use std::ops::ControlFlow;

use super::{
    candidates::{self, VisibilityCandidate},
    checker_corners::{self, CheckerPixel, ShownSquares},
    quadtree::OBJECTS_A_CELL,
    world::World,
};
use crate::area::Area;

/// Side of the squares that quartering begins with, in pixels: a power of two, so that quarters are
/// squares.
pub const GRID: u32 = checker_corners::SIDE as u32;

/// Minimum number of samples per candidate in an area that is quartered further. Measured: with 8,
/// the time for 10³ and 10⁵ spheres changes by less than a tenth, and 3000 slivers with one sample
/// per pixel take twice as long. With 2, the time rises by up to a quarter.
const SAMPLES_A_CANDIDATE: f64 = 4.0;

/// Cost of finding where one candidate is seen, from a square of the grid down. The unit is one
/// object test of a sample that is traced one by one. Such a sample tests the objects whose bounds
/// contain it; its search of the quadtree counts as one more test. Measured: with 80, 10⁴ spheres
/// on 320×180 pixels take a tenth longer; with 200, on 640×360 pixels a fiftieth longer.
const ASKED_A_CANDIDATE: f64 = 120.0;

/// Divides one picture into parts.
#[derive(Debug)]
pub struct Quartering<'a> {
    world: &'a World,
    /// Mean number of samples per pixel; infinite for a picture that must be computed exactly at
    /// any cost.
    samples: f64,
}

/// A part of the picture, by what is seen in it.
#[derive(Clone, Copy, Debug)]
pub enum PicturePart<'a> {
    /// One colour is seen in all of it.
    OneColor {
        /// The part's area.
        area: Area,
        /// The colour's slot in the palette.
        slot: usize,
    },
    /// A pixel in which more than one colour may be seen.
    Pixel {
        /// The pixel's column.
        x: u32,
        /// The pixel's row.
        y: u32,
        /// The objects that may be seen in the pixel, in file order.
        candidates: &'a [VisibilityCandidate],
        /// The squares of a checkerboard that the pixel shows, if nothing else is seen there and
        /// the squares are known.
        checks: Option<&'a CheckerPixel>,
    },
    /// An area with more candidates than it is worth to tell apart. Its samples are traced one by
    /// one.
    Crowded {
        /// The part's area.
        area: Area,
    },
}

/// Buffers that are reused from area to area: the list of candidates at each depth of the
/// quartering.
#[derive(Debug, Default)]
pub struct Scratch {
    candidates: Vec<Vec<VisibilityCandidate>>,
}

impl<'a> Quartering<'a> {
    /// Prepares the quartering of a picture that must be computed exactly: no part is
    /// [`Crowded`](PicturePart::Crowded).
    pub fn new(world: &'a World) -> Self {
        Self::for_samples(world, f64::INFINITY)
    }

    /// Prepares the quartering of a picture with `samples` samples per pixel on average.
    pub fn for_samples(world: &'a World, samples: f64) -> Self {
        Self { world, samples }
    }

    /// Calls `visit` with the parts of the area `wanted` until it breaks. The parts cover each
    /// pixel of the area exactly once.
    pub fn parts(
        &self,
        wanted: Area,
        scratch: &mut Scratch,
        visit: &mut impl FnMut(PicturePart) -> ControlFlow<()>,
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
            let flow = if candidates::within(self.world, area, most, is_worth, list) {
                cut.cut(area, &candidates, 1, scratch)
            } else {
                cut.show(PicturePart::Crowded { area })
            };
            scratch.candidates[0] = candidates;
            flow
        })
    }

    /// Returns whether it costs less to tell the objects of an area apart than to trace the area's
    /// samples one by one. `objects` is their number, and `asked` the mean number of objects that
    /// one sample tests.
    fn is_worth_cutting(&self, area: Area, objects: usize, asked: f64) -> bool {
        let samples = self.samples * area.pixels() as f64;
        objects <= OBJECTS_A_CELL || samples * (1.0 + asked) >= ASKED_A_CANDIDATE * objects as f64
    }

    /// Returns the maximum number of candidates that are worth telling apart in an area. In a
    /// single pixel, where quartering ends, it is one candidate per sample.
    fn most(&self, area: Area) -> usize {
        let shared = area.pixels() as f64 / SAMPLES_A_CANDIDATE;
        (self.samples * shared.max(1.0)) as usize
    }
}

/// One square of the grid while it is divided.
struct Cut<'a, 'b, V> {
    quartering: &'a Quartering<'a>,
    /// The part of the picture that is wanted.
    wanted: Area,
    /// Whether the whole square is wanted.
    is_all_wanted: bool,
    visit: &'b mut V,
}

impl<V: FnMut(PicturePart) -> ControlFlow<()>> Cut<'_, '_, V> {
    /// Shows an area, or quarters it, depending on the candidates in it. Stops if `visit` breaks.
    fn cut(
        &mut self,
        area: Area,
        candidates: &[VisibilityCandidate],
        depth: usize,
        scratch: &mut Scratch,
    ) -> ControlFlow<()> {
        let world = self.quartering.world;
        match candidates {
            [] => {
                let slot = world.background();
                return self.show(PicturePart::OneColor { area, slot });
            }
            [only] if only.is_whole => {
                let slots = world.slots(only.object);
                let [slot, second] = slots;
                if slot == second {
                    return self.show(PicturePart::OneColor { area, slot });
                }
                let show = &mut |area: Area, seen: ShownSquares| {
                    let checks = match seen {
                        ShownSquares::One(odd) => {
                            let slot = slots[usize::from(odd)];
                            return self.show(PicturePart::OneColor { area, slot });
                        }
                        // Samples need certain squares; exact areas allow for uncertain ones.
                        ShownSquares::Squares(checks) => {
                            let is_exact = self.quartering.samples.is_infinite();
                            (checks.is_certain || is_exact).then_some(checks)
                        }
                        ShownSquares::Unknown => None,
                    };
                    self.show(PicturePart::Pixel {
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
        // Up to as many candidates as a cell of the quadtree lists, testing the candidates is no
        // slower, since each sample would otherwise test that list.
        if !is_worth_more && candidates.len() > OBJECTS_A_CELL {
            return self.show(PicturePart::Crowded { area });
        }
        if !is_worth_more || area.pixels() == 1 {
            let mut pixels = area.iter();
            return pixels.try_for_each(|(x, y)| {
                self.show(PicturePart::Pixel {
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

    /// Calls `visit` with the wanted pixels of a part, if there are any.
    #[inline]
    fn show(&mut self, part: PicturePart) -> ControlFlow<()> {
        if self.is_all_wanted {
            return (self.visit)(part);
        }
        self.show_wanted(part)
    }

    fn show_wanted(&mut self, part: PicturePart) -> ControlFlow<()> {
        let area = match part {
            PicturePart::OneColor { area, .. } | PicturePart::Crowded { area } => area,
            PicturePart::Pixel { x, y, .. } => Area::pixel(x, y),
        };
        let area = area.common(self.wanted);
        if area.pixels() == 0 {
            return ControlFlow::Continue(());
        }
        (self.visit)(match part {
            PicturePart::OneColor { slot, .. } => PicturePart::OneColor { area, slot },
            PicturePart::Crowded { .. } => PicturePart::Crowded { area },
            PicturePart::Pixel { .. } => part,
        })
    }
}

/// Takes the list of a depth out of `scratch`. The caller puts it back after use.
fn take(scratch: &mut Scratch, depth: usize) -> Vec<VisibilityCandidate> {
    if scratch.candidates.len() <= depth {
        scratch.candidates.resize_with(depth + 1, Vec::new);
    }
    std::mem::take(&mut scratch.candidates[depth])
}
