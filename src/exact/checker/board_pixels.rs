//! Batches of eight pixels that show only a checkerboard and are crossed by few of its lines. Most
//! pixels with more than one colour are of this kind.
//!
//! In: pixels one by one, in any order, each with the column and row numbers of the squares that
//! its corners show. Out: the integral of the board's sign (1 on squares of one colour, −1 on the
//! others) over each pixel. A board has two families of lines, those between columns and those
//! between rows of squares. All pixels of a batch are crossed by the same numbers of lines of the
//! two families. When a batch has eight pixels, `strips_simd` computes them at once and bounds the
//! errors. The result for a pixel depends neither on the other pixels of its batch nor on the part
//! of the picture that is rendered.

use super::{
    homography::BoundedSum,
    strips_simd::{BoardLanes, MAX_STRIP_LINES, PIXELS, StripBuffer},
};
use crate::tracer::{CheckerPixel, VisibilityCandidate};

/// Maximum number of lines of one family (those between a board's columns, or those between its
/// rows) that may cross a pixel of a batch. A pixel that more lines cross is rare and is computed
/// alone. Not critical: with 8 or 128, the measured running time changes by at most about 10 %.
const MAX_LINES: usize = 32;

/// A pixel that shows only a checkerboard.
#[derive(Clone, Copy, Debug)]
pub(in crate::exact) struct BoardPixel {
    /// Column of the pixel.
    pub x: u32,
    /// Row of the pixel.
    pub y: u32,
    /// The surface with the checkerboard.
    pub candidate: VisibilityCandidate,
}

/// Queues of checkerboard pixels. All pixels of one queue are crossed by the same number of lines
/// between the board's columns, and by the same number of lines between its rows.
#[derive(Debug)]
pub(in crate::exact) struct BoardBatches {
    batches: Vec<Batch>,
    buffer: StripBuffer,
}

/// A queue of pixels that are crossed by the same number of lines between the board's columns, and
/// by the same number of lines between its rows.
#[derive(Debug, Default)]
struct Batch {
    /// The queued pixels. A queue of [`PIXELS`] pixels is computed and emptied at once.
    pixels: Vec<BoardPixel>,
    lines: BoardLanes,
}

impl BoardBatches {
    /// Creates empty queues.
    pub fn new() -> Self {
        let batches = (0..=MAX_STRIP_LINES).flat_map(|_| (0..=MAX_LINES).map(|_| Batch::default()));
        Self {
            batches: batches.collect(),
            buffer: StripBuffer::default(),
        }
    }

    /// Adds a pixel to the batch of pixels that equally many lines cross. If the batch is then
    /// full, computes it and calls `emit` for each of its pixels, with the area of the board's
    /// first colour minus that of the second. If too many lines cross the pixel, calls `emit` at
    /// once, without a result.
    pub fn push(
        &mut self,
        pixel: BoardPixel,
        checks: &CheckerPixel,
        emit: &mut impl FnMut(BoardPixel, Option<BoundedSum>),
    ) {
        let ranges = checks.ranges();
        let [a, b] = ranges.map(|(low, high)| high - low);
        let families = if a <= b { [0, 1] } else { [1, 0] };
        let [few, many] = families.map(|family| [a, b][family]);
        if few > MAX_STRIP_LINES as f64 || many > MAX_LINES as f64 {
            return emit(pixel, None);
        }
        let crossing = [few as usize, many as usize];
        let batch = &mut self.batches[crossing[0] * (MAX_LINES + 1) + crossing[1]];
        let first = ranges.map(|(low, _)| low);
        let lines = &mut batch.lines;
        lines.set(batch.pixels.len(), checks, families, first);
        batch.pixels.push(pixel);
        if batch.pixels.len() == PIXELS {
            batch.compute(crossing, &mut self.buffer, emit);
        }
    }

    /// Computes all pixels that are still queued. Calls `emit` for each, with the area of the
    /// board's first colour minus that of the second.
    pub fn finish(mut self, emit: &mut impl FnMut(BoardPixel, Option<BoundedSum>)) {
        for (i, batch) in self.batches.iter_mut().enumerate() {
            let crossing = [i / (MAX_LINES + 1), i % (MAX_LINES + 1)];
            batch.compute(crossing, &mut self.buffer, emit);
        }
    }
}

impl Batch {
    /// Computes and empties this batch. Calls `emit` for each pixel, with the area of the board's
    /// first colour minus that of the second. `crossing` contains the number of crossed lines in
    /// each of the board's two families, which is the same for all pixels. The smaller number comes
    /// first.
    fn compute(
        &mut self,
        crossing: [usize; 2],
        buffer: &mut StripBuffer,
        emit: &mut impl FnMut(BoardPixel, Option<BoundedSum>),
    ) {
        if self.pixels.is_empty() {
            return;
        }
        let sums = self.lines.sums(crossing, buffer);
        for (i, pixel) in self.pixels.drain(..).enumerate() {
            emit(pixel, Some(sums.pixel(i)));
        }
    }
}

#[cfg(test)]
mod tests {
    mod bounds;

    use super::*;
    use crate::{
        area::Area,
        exact::{DEFAULT_TOLERANCE, budget::PixelBudget, clip::PIXEL, region::LocalBoard},
        math::Angle,
        reference::scenes::{along, board, camera, scene},
        scene::{Camera, Lens},
        tracer::{PicturePart, Quartering, SubPixel, World},
    };
    use glam::{DVec3, dvec2, dvec3};
    use proptest::prelude::*;
    use std::{ops::ControlFlow, sync::atomic::AtomicBool};

    const SIZE: [u32; 2] = [24, 18];

    fn world(camera: Camera, square: f64) -> World {
        let mut scene = scene(camera, &[board(0.25, square)]);
        [scene.image.width, scene.image.height] = SIZE;
        World::new(&scene)
    }

    /// Returns the pixels that show only the board, each with the area of the first colour minus
    /// that of the second. The difference is `None` if too many lines of the board cross the pixel.
    /// Omits pixels in which the squares at the corners could not be determined.
    fn sums(world: &World) -> Vec<(BoardPixel, Option<BoundedSum>)> {
        let [width, height] = SIZE;
        let mut batches = BoardBatches::new();
        let mut known = Vec::new();
        let mut emit = |pixel, sum| known.push((pixel, sum));
        let mut visit = |part: PicturePart| {
            if let PicturePart::Pixel {
                x,
                y,
                candidates: [candidate],
                checks: Some(checks),
            } = part
            {
                let candidate = *candidate;
                batches.push(BoardPixel { x, y, candidate }, checks, &mut emit);
            }
            ControlFlow::Continue(())
        };
        let whole = Area::whole(width, height);
        let _ = Quartering::new(world).parts(whole, &mut Default::default(), &mut visit);
        batches.finish(&mut emit);
        known
    }

    #[test]
    fn most_pixels_of_few_lines_are_known() {
        let camera = Camera {
            lens: Lens::Distance(2.75),
            ..camera(dvec3(3.0, 3.5, 8.0), dvec3(0.2, 0.8, 0.0))
        };
        let world = world(camera, 0.7);
        let known = sums(&world).into_iter().filter_map(|(_, sum)| sum);
        let sharp = known.filter(|sum| sum.bound < 1e-9).count();
        // More than half of the picture's 24 × 18 = 432 pixels are below the horizon and may show
        // the board, so at least 100 results with a small error bound are expected.
        assert!(sharp > 100, "{sharp}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn it_is_what_clipping_square_by_square_gives(
            place in prop::array::uniform2(-9.0..9.0_f64),
            offset in prop::sample::select(vec![0.0, 1e6, -1e12]),
            // The test draws the camera's height and the side of a square as powers of ten.
            // `height` and `square` are the exponents.
            height in -1.0..2.0_f64,
            square in -1.0..3.0_f64,
            yaw in 0.0..360.0_f64,
            down in 0.0..89.0_f64,
            roll in 0.0..360.0_f64,
            fov in prop::sample::select(vec![0.01, 1.0, 20.0, 60.0, 120.0, 170.0]),
        ) {
            let [x, z] = place;
            let (yaw, down) = (yaw.to_radians(), down.to_radians());
            let eye = dvec3(x + offset, 0.25 + libm::pow(10.0, height), z);
            let ahead = 1e3 * dvec3(libm::cos(yaw), -libm::tan(down), libm::sin(yaw));
            let camera = Camera {
                roll: Angle::from_degrees(roll),
                lens: Lens::Fov(Angle::from_degrees(fov)),
                ..camera(eye, eye + ahead)
            };
            let world = world(camera, libm::pow(10.0, square));
            let (sums, mut compared) = (sums(&world), 0);
            let are_all_flat = sums.is_empty();
            for (BoardPixel { x, y, .. }, sum) in sums {
                // Skips pixels without a usable sum: it is `None` if too many lines cross the
                // pixel, and NaN if a square of the board is nearly as large as the largest `f64`.
                let Some(sum) = sum.filter(|sum| sum.bound < 1.0) else {
                    continue;
                };
                let seen = LocalBoard::new(&world, 0, SubPixel::pixel(x, y)).expect("a board");
                let cancel = AtomicBool::new(false);
                let budget = PixelBudget::new(DEFAULT_TOLERANCE, &cancel);
                let other = seen.board.over(&PIXEL, &budget);
                let value = if seen.odd { -other.value } else { other.value };
                let off = (sum.value - value).abs();
                prop_assert!(off <= sum.bound + other.bound, "{camera:?} at {x}, {y}: {sum:?} and {other:?}");
                compared += 1;
            }
            prop_assert!(compared > 0 || are_all_flat || fov < 1.0 || square < 0.0, "{camera:?}");
        }
    }
}
