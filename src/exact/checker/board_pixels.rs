//! Pixels that show nothing but a checkerboard and few of its lines: most pixels that are not of
//! one colour. They are computed in batches of eight.
//!
//! In: such pixels one by one, in any order, with the squares of their corners. Out: their
//! integrals of the board's sign. Pixels are sorted by how many lines of either family cross them;
//! eight with the same two numbers are computed at once by `strips_simd`, which bounds the errors.
//! A pixel's sum is made of its own numbers, by the same operations whichever others it is computed
//! with, so that it depends neither on their order nor on which part of a picture is wanted.

use super::{
    homography::Sum,
    strips_simd::{Lines, PIXELS, Room, STRIPS},
};
use crate::tracer::{CheckerPixel, VisibilityCandidate};

/// At most so many lines cross the strips. For each pair of numbers there is a batch of pixels, and
/// pixels with more lines are few. (Measured: with 8 or 128 times differ by about a tenth at most.)
const MOST: usize = 32;

/// A pixel that shows nothing but a checkerboard.
#[derive(Clone, Copy, Debug)]
pub(in crate::exact) struct BoardPixel {
    /// Its column.
    pub x: u32,
    /// Its row.
    pub y: u32,
    /// The checkerboard.
    pub candidate: VisibilityCandidate,
}

/// The pixels that wait, by the numbers of lines that cross them.
#[derive(Debug)]
pub(in crate::exact) struct BoardBatches {
    batches: Vec<Batch>,
    room: Room,
}

/// Pixels that the same numbers of lines cross.
#[derive(Debug, Default)]
struct Batch {
    /// Which pixels they are: no more than are computed together.
    pixels: Vec<BoardPixel>,
    lines: Lines,
}

impl BoardBatches {
    /// None so far.
    pub fn new() -> Self {
        let batches = (0..=STRIPS).flat_map(|_| (0..=MOST).map(|_| Batch::default()));
        Self {
            batches: batches.collect(),
            room: Room::default(),
        }
    }

    /// Queues a pixel. `tell` is called for each pixel of a batch that becomes full, with its
    /// integral, positive for the first colour; and at once, without one, for a pixel that too
    /// many lines cross.
    pub fn push(
        &mut self,
        pixel: BoardPixel,
        checks: &CheckerPixel,
        tell: &mut impl FnMut(BoardPixel, Option<Sum>),
    ) {
        let ranges = checks.ranges();
        let [a, b] = ranges.map(|(low, high)| high - low);
        let (few, many, families) = match a <= b {
            true => (a, b, [0, 1]),
            false => (b, a, [1, 0]),
        };
        if few > STRIPS as f64 || many > MOST as f64 {
            return tell(pixel, None);
        }
        let crossing = [few as usize, many as usize];
        let batch = &mut self.batches[crossing[0] * (MOST + 1) + crossing[1]];
        let first = ranges.map(|(low, _)| low);
        let lines = &mut batch.lines;
        lines.set(batch.pixels.len(), checks, families, first);
        batch.pixels.push(pixel);
        if batch.pixels.len() == PIXELS {
            batch.compute(crossing, &mut self.room, tell);
        }
    }

    /// Computes all that still wait.
    pub fn finish(mut self, tell: &mut impl FnMut(BoardPixel, Option<Sum>)) {
        for (i, batch) in self.batches.iter_mut().enumerate() {
            batch.compute([i / (MOST + 1), i % (MOST + 1)], &mut self.room, tell);
        }
    }
}

impl Batch {
    /// The integrals of the pixels, after which there are none.
    fn compute(
        &mut self,
        crossing: [usize; 2],
        room: &mut Room,
        tell: &mut impl FnMut(BoardPixel, Option<Sum>),
    ) {
        if self.pixels.is_empty() {
            return;
        }
        let sums = self.lines.sums(crossing, room);
        for (i, pixel) in self.pixels.drain(..).enumerate() {
            tell(pixel, Some(sums.of(i)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        area::Area,
        exact::{ENOUGH, budget::Budget, clip::PIXEL, region::Checkered},
        math::Angle,
        report::numerics::scenes::{board, camera, scene},
        scene::{Camera, Lens},
        tracer::{PicturePart, Quartering, SubPixel, World},
    };
    use glam::dvec3;
    use proptest::prelude::*;
    use std::{ops::ControlFlow, sync::atomic::AtomicBool};

    const SIZE: [u32; 2] = [24, 18];

    fn world(camera: Camera, square: f64) -> World {
        let mut scene = scene(camera, &[board(0.25, square)]);
        [scene.image.width, scene.image.height] = SIZE;
        World::new(&scene)
    }

    /// The sums of all pixels of which the squares of the corners are known.
    fn sums(world: &World) -> Vec<(BoardPixel, Option<Sum>)> {
        let [width, height] = SIZE;
        let mut batches = BoardBatches::new();
        let mut known = Vec::new();
        let mut tell = |pixel, sum| known.push((pixel, sum));
        let mut visit = |part: PicturePart| {
            if let PicturePart::Pixel {
                x,
                y,
                candidates: [candidate],
                checks: Some(checks),
            } = part
            {
                let candidate = *candidate;
                batches.push(BoardPixel { x, y, candidate }, checks, &mut tell);
            }
            ControlFlow::Continue(())
        };
        let whole = Area::whole(width, height);
        let _ = Quartering::new(world).parts(whole, &mut Default::default(), &mut visit);
        batches.finish(&mut tell);
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
        // Of 18 rows of 24 pixels more than half lie below the horizon.
        assert!(sharp > 100, "{sharp}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn it_is_what_clipping_square_by_square_gives(
            place in prop::array::uniform2(-9.0..9.0_f64),
            offset in prop::sample::select(vec![0.0, 1e6, -1e12]),
            // As powers of ten.
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
                // None where too many lines cross; not a number where squares are as large as numbers can be.
                let Some(sum) = sum.filter(|sum| sum.bound < 1.0) else {
                    continue;
                };
                let seen = Checkered::new(&world, 0, SubPixel::pixel(x, y)).expect("a board");
                let cancel = AtomicBool::new(false);
                let budget = Budget::of_pixel(ENOUGH, &cancel);
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
