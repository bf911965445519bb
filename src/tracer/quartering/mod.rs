//! The picture divided into parts that certainly show one colour, pixels that may show several, and
//! parts with too many candidates.
//!
//! In: the world, and an area of its picture. Out: the parts of this area, one after the other. The
//! method is Warnock's subdivision ("A hidden surface algorithm for computer generated halftone
//! pictures", 1969): an area is quartered until it shows one colour or is a single pixel. The
//! samples of a pixel are then tested only against its candidates, i.e. the objects that may be
//! seen in it.
//!
//! Quartering also ends if an area has too many candidates: finding out where each is seen would
//! take longer than tracing the area's samples one by one. Sampled and exact pictures share this
//! method: if an area certainly shows one colour, every ray through the area sees this colour.
//!
//! Areas belong to one fixed grid over the whole picture. A pixel's candidates therefore do not
//! depend on which part of the picture is wanted.

#[cfg(test)]
mod tests;

use std::ops::ControlFlow;

use super::{
    candidates::{self, VisibilityCandidate},
    checker_corners::{self, CheckerPixel, ShownSquares},
    quadtree::OBJECTS_PER_CELL,
    world::World,
};
use crate::area::Area;

/// Side of the squares into which a picture is divided first, in pixels. Each square is then
/// quartered recursively. The side is a power of two, so that all quarters are squares. It equals
/// the maximum side of a block of pixels whose checkerboard is computed at once.
pub const GRID: u32 = checker_corners::SIDE as u32;

/// Minimum ratio of samples to candidate objects at which an area of more than four pixels is
/// quartered further. The value was chosen by measuring render times. With 8, the time for 10³ and
/// 10⁵ spheres changes by less than 10 %, but 3000 slivers with one sample per pixel take twice as
/// long. With 2, the time rises by up to 25 %.
const MIN_QUARTERING_RATIO: f64 = 4.0;

/// Cost of finding out where one candidate object is seen within an area of pixels. The unit is the
/// cost of testing one sample against one object. An area with more than [`OBJECTS_PER_CELL`]
/// candidates is quartered only if the cost for all its candidates is at most the cost of tracing
/// all its samples one by one. Tracing a sample costs one unit for each object whose bounds contain
/// it, and one unit for the search of the quadtree. The value was chosen by measuring render times.
/// With 80, 10⁴ spheres on 320×180 pixels take 10 % longer; with 200, they take 2 % longer on
/// 640×360 pixels.
const ASKED_PER_CANDIDATE: f64 = 120.0;

/// Subdivision of one picture into parts.
#[derive(Debug)]
pub struct Quartering<'a> {
    world: &'a World,
    /// Mean number of samples per pixel of the picture. It is infinite for a picture that is
    /// computed exactly, so that no part becomes [`Crowded`](PicturePart::Crowded).
    samples: f64,
}

/// A part of the picture, classified by what may be seen in it.
#[derive(Clone, Copy, Debug)]
pub enum PicturePart<'a> {
    /// All of the part certainly shows one colour.
    OneColor {
        /// The part's area.
        area: Area,
        /// Index of the colour in the palette.
        color_index: usize,
    },
    /// A pixel in which more than one colour may be seen.
    Pixel {
        /// The pixel's column.
        x: u32,
        /// The pixel's row.
        y: u32,
        /// The objects that may be seen in the pixel, in file order.
        candidates: &'a [VisibilityCandidate],
        /// The squares that the pixel shows, if it shows only one checkerboard. `None` if something
        /// else may be seen in the pixel, if the squares could not be determined, or if they are
        /// too uncertain for sampling.
        checks: Option<&'a CheckerPixel>,
    },
    /// An area whose samples are traced one by one. It has so many candidates that finding out
    /// where each is seen would take longer.
    Crowded {
        /// The part's area.
        area: Area,
    },
}

/// Buffers that are reused from area to area: a list of candidates for each depth of the
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

    /// Calls `visit` with the parts of the area `wanted`, until `visit` returns `Break`. The parts
    /// cover each pixel of the area exactly once.
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

    /// Returns whether quartering an area is expected to take less time than tracing its samples
    /// one by one. With at most [`OBJECTS_PER_CELL`] objects, always returns `true`. `objects` is
    /// the number of objects that may be seen in the area. `asked` is the number of objects against
    /// which a sample would be tested, averaged over the area.
    fn is_worth_cutting(&self, area: Area, objects: usize, asked: f64) -> bool {
        let samples = self.samples * area.pixels() as f64;
        objects <= OBJECTS_PER_CELL
            || samples * (1.0 + asked) >= ASKED_PER_CANDIDATE * objects as f64
    }

    /// Returns the number of candidates above which an area is not quartered further. It is the
    /// number of the area's samples divided by [`MIN_QUARTERING_RATIO`], but at least the number of
    /// samples of one pixel.
    fn most(&self, area: Area) -> usize {
        let shared = area.pixels() as f64 / MIN_QUARTERING_RATIO;
        (self.samples * shared.max(1.0)) as usize
    }
}

/// State of the recursive division of one square of the picture into parts. The square's side is at
/// most [`GRID`] pixels.
struct Cut<'a, 'b, V> {
    quartering: &'a Quartering<'a>,
    /// The part of the picture that is wanted.
    wanted: Area,
    /// Whether the square that is being divided lies entirely within `wanted`.
    is_all_wanted: bool,
    visit: &'b mut V,
}

impl<V: FnMut(PicturePart) -> ControlFlow<()>> Cut<'_, '_, V> {
    /// Calls `visit` with an area, or quarters the area, depending on the candidates in it. Stops
    /// if `visit` returns `Break`.
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
                let color_index = world.background();
                return self.show(PicturePart::OneColor { area, color_index });
            }
            [only] if only.is_whole => {
                let color_indices = world.color_indices(only.object);
                let [color_index, second] = color_indices;
                if color_index == second {
                    return self.show(PicturePart::OneColor { area, color_index });
                }
                let show = &mut |area: Area, seen: ShownSquares| {
                    let checks = match seen {
                        ShownSquares::One(odd) => {
                            let color_index = color_indices[usize::from(odd)];
                            return self.show(PicturePart::OneColor { area, color_index });
                        }
                        // Samples can use the squares only if they are certain. Exact integration
                        // also accepts uncertain squares, whose errors it bounds.
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
        // A sample that is traced on its own is tested against the objects of a quadtree cell, up
        // to `OBJECTS_PER_CELL`. With at most this number of candidates, testing all of them is no
        // slower.
        if !is_worth_more && candidates.len() > OBJECTS_PER_CELL {
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

    /// Calls `visit` with the pixels of `part` that are wanted. Does nothing if there are none.
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
            PicturePart::OneColor { color_index, .. } => {
                PicturePart::OneColor { area, color_index }
            }
            PicturePart::Crowded { .. } => PicturePart::Crowded { area },
            PicturePart::Pixel { .. } => part,
        })
    }
}

/// Takes the candidate list of the quartering depth `depth` out of `scratch`. The caller puts it
/// back after use.
fn take(scratch: &mut Scratch, depth: usize) -> Vec<VisibilityCandidate> {
    if scratch.candidates.len() <= depth {
        scratch.candidates.resize_with(depth + 1, Vec::new);
    }
    std::mem::take(&mut scratch.candidates[depth])
}
