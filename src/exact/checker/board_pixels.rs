//! Pixels that show nothing but a checkerboard and few of its lines: most pixels of most pictures. They are computed in batches of eight.
//!
//! In: such pixels one by one, in any order. Out: their integrals of the board's sign. Pixels are sorted by how many lines of either family cross them; eight with
//! the same two numbers are computed at once by `strips_simd`, which bounds the errors. A pixel's sum is made of its own numbers, by the same operations whichever
//! others it is computed with, so that it depends neither on their order nor on which part of a picture is wanted.

use super::{
    board_forms::{self, Boards, PIXELS, Views},
    homography::Sum,
    strips_simd::{Corners, Lines, Room, STRIPS},
};
use crate::tracer::{Candidate, World};

/// At most so many lines cross the strips. For each pair of numbers there is a batch of pixels, and pixels with more lines are few. (Measured: with 8 or 128 times differ by about a tenth at most.)
const MOST: usize = 32;

/// A pixel that shows nothing but a checkerboard.
#[derive(Clone, Copy, Debug)]
pub(in crate::exact) struct BoardPixel {
    /// Its column.
    pub x: u32,
    /// Its row.
    pub y: u32,
    /// The checkerboard.
    pub candidate: Candidate,
}

/// The pixels that wait.
#[derive(Debug)]
pub(in crate::exact) struct BoardBatches<'a> {
    world: &'a World,
    /// Pixels not looked at so far, all of one checkerboard.
    next: Vec<BoardPixel>,
    /// That checkerboard, as an object of the scene, and what its pixels have in common.
    boards: Option<(usize, Boards)>,
    views: Views,
    corners: Corners,
    batches: Batches,
    room: Room,
}

impl<'a> BoardBatches<'a> {
    /// None so far.
    pub fn new(world: &'a World) -> Self {
        Self {
            world,
            next: Vec::with_capacity(PIXELS),
            boards: None,
            views: Views::default(),
            corners: Corners::default(),
            batches: Batches::default(),
            room: Room::default(),
        }
    }

    /// Has a pixel wait. Of all that are computed now the integrals are told, positive for the first colour; none where something else has to be
    /// tried.
    pub fn push(&mut self, pixel: BoardPixel, tell: &mut impl FnMut(BoardPixel, Option<Sum>)) {
        let object = pixel.candidate.object;
        if !matches!(self.boards, Some((known, _)) if known == object) {
            self.look(tell);
            self.boards = board_forms::boards(self.world, object).map(|boards| (object, boards));
        }
        self.next.push(pixel);
        if self.next.len() == PIXELS {
            self.look(tell);
        }
    }

    /// Computes all that still wait.
    pub fn finish(mut self, tell: &mut impl FnMut(BoardPixel, Option<Sum>)) {
        self.look(tell);
        for batch in self.batches.all() {
            compute(batch, &mut self.room, tell);
        }
    }

    /// Sorts the pixels that come next by what crosses them.
    fn look(&mut self, tell: &mut impl FnMut(BoardPixel, Option<Sum>)) {
        let Some(&last) = self.next.last() else {
            return;
        };
        let Some((_, boards)) = &self.boards else {
            self.next.drain(..).for_each(|pixel| tell(pixel, None));
            return;
        };
        let (mut columns, mut rows) = ([last.x; PIXELS], [last.y; PIXELS]);
        for (i, pixel) in self.next.iter().enumerate() {
            (columns[i], rows[i]) = (pixel.x, pixel.y);
        }
        boards.at(&columns, &rows, &mut self.views);
        self.corners.look(&self.views);
        for (i, pixel) in self.next.drain(..).enumerate() {
            let Some(batch) = self.batches.of(&self.corners, i) else {
                tell(pixel, None);
                continue;
            };
            if batch.push(pixel, &self.views, &self.corners, i) {
                compute(batch, &mut self.room, tell);
            }
        }
    }
}

/// The integrals of a batch's pixels, after which it is empty.
fn compute(batch: &mut Batch, room: &mut Room, tell: &mut impl FnMut(BoardPixel, Option<Sum>)) {
    if batch.pixels.is_empty() {
        return;
    }
    let sums = batch.lines.sums(batch.crossing, room);
    for (i, pixel) in batch.pixels.drain(..).enumerate() {
        tell(pixel, Some(sums.of(i)));
    }
}

/// Pixels that the same numbers of lines cross.
#[derive(Debug)]
struct Batch {
    /// Which pixels they are: no more than are computed together.
    pub pixels: Vec<BoardPixel>,
    lines: Lines,
    /// How many lines of either family cross each of them, fewer first.
    crossing: [usize; 2],
}

/// All batches there may be.
#[derive(Debug)]
struct Batches(Vec<Batch>);

impl Default for Batches {
    fn default() -> Self {
        let crossings = (0..=STRIPS).flat_map(|few| (0..=MOST).map(move |many| [few, many]));
        let batch = |crossing| Batch {
            pixels: Vec::new(),
            lines: Lines::default(),
            crossing,
        };
        Self(crossings.map(batch).collect())
    }
}

impl Batches {
    /// All of them.
    pub fn all(&mut self) -> impl Iterator<Item = &mut Batch> {
        self.0.iter_mut()
    }

    /// Where a pixel goes; none if too many lines cross it.
    pub fn of(&mut self, corners: &Corners, pixel: usize) -> Option<&mut Batch> {
        let [a, b] = corners.lines.each_ref().map(|lines| lines[pixel]);
        let (few, many) = if a <= b { (a, b) } else { (b, a) };
        if !(few <= STRIPS as f64 && many <= MOST as f64) {
            return None;
        }
        self.0.get_mut(few as usize * (MOST + 1) + many as usize)
    }
}

impl Batch {
    /// Adds a pixel to those of which there are fewer than can be computed together; says whether there is no room for more.
    pub fn push(&mut self, at: BoardPixel, views: &Views, corners: &Corners, pixel: usize) -> bool {
        self.lines.set(self.pixels.len(), views, corners, pixel);
        self.pixels.push(at);
        self.pixels.len() == PIXELS
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        exact::{budget::Budget, checker::Homography, clip::PIXEL},
        scene,
        source::{Source, Sources},
        tracer::{SubPixel, candidates},
    };
    use proptest::prelude::*;
    use std::{collections::HashMap, sync::atomic::AtomicBool};

    const SIZE: [u32; 2] = [24, 18];

    fn world(camera: &str, square: f64) -> World {
        let [width, height] = SIZE;
        let text = format!(
            "image {{ width {width} height {height} background black }}\ncamera {{ {camera} }}\n\
             checkerboard {{ y 0.25 square {square} colors (gray, white) }}"
        );
        let sources = Sources::new(Source::from_text("a.scn", &text));
        World::new(&scene::read(&sources).scene.expect("a scene"))
    }

    fn pixels() -> Vec<(u32, u32)> {
        let [width, height] = SIZE;
        (0..height)
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .collect()
    }

    /// The sums of some pixels that come in this order.
    fn sums(
        world: &World,
        order: impl IntoIterator<Item = (u32, u32)>,
    ) -> HashMap<(u32, u32), Option<Sum>> {
        let mut all = Vec::new();
        assert!(candidates::within(world, world.picture(), 1, &mut all));
        let candidate = all[0];
        let mut batches = BoardBatches::new(world);
        let mut known = HashMap::new();
        let mut tell = |pixel: BoardPixel, sum| {
            assert!(known.insert((pixel.x, pixel.y), sum).is_none());
        };
        for (x, y) in order {
            batches.push(BoardPixel { x, y, candidate }, &mut tell);
        }
        batches.finish(&mut tell);
        known
    }

    #[test]
    fn no_pixel_depends_on_those_it_is_computed_with() {
        for camera in [
            "eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75",
            "eye (0.3, 40, 0.2) lookat (0, 0, 0.1) roll 20deg fov 5deg",
            "eye (-7, 2, 1e6) lookat (-6.4, 0, 1000001) fov 60deg",
        ] {
            let world = world(camera, 0.7);
            let all = sums(&world, pixels());
            assert_eq!(all.len(), pixels().len());
            let some = |step: usize| pixels().into_iter().step_by(step);
            let by_column = |(x, y): &(u32, u32)| (*x, *y);
            let mut columns = pixels();
            columns.sort_by_key(by_column);
            let orders = [
                pixels().into_iter().rev().collect(),
                columns,
                some(3).collect(),
                some(7).collect(),
                vec![(11, 17)],
            ];
            let bits = |sum: &Option<Sum>| sum.map(|sum| [sum.value, sum.bound].map(f64::to_bits));
            for order in orders {
                let count = order.len();
                let found = sums(&world, order);
                assert_eq!(found.len(), count);
                for (pixel, sum) in found {
                    assert_eq!(bits(&sum), bits(&all[&pixel]), "{camera} at {pixel:?}");
                }
            }
        }
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
            let (x, y, z) = (x + offset, 0.25 + libm::pow(10.0, height), z);
            let ahead = [libm::cos(yaw), -libm::tan(down), libm::sin(yaw)].map(|step| 1e3 * step);
            let camera = format!(
                "eye ({x}, {y}, {z}) lookat ({}, {}, {}) roll {roll}deg fov {fov}deg",
                x + ahead[0], y + ahead[1], z + ahead[2]
            );
            let world = world(&camera, libm::pow(10.0, square));
            let mut compared = 0;
            for ((x, y), sum) in sums(&world, pixels()) {
                // None where too many lines cross; not a number where squares are as large as numbers can be.
                let Some(sum) = sum.filter(|sum| sum.bound < 1.0) else {
                    continue;
                };
                let seen = board_forms::board(&world, 0, SubPixel::pixel(x, y)).expect("a board");
                let cancel = AtomicBool::new(false);
                let budget = Budget::of_pixel(1, &cancel);
                let other = Homography::of(&seen).over(&PIXEL, &budget);
                let value = if seen.odd { -other.value } else { other.value };
                let off = (sum.value - value).abs();
                prop_assert!(off <= sum.bound + other.bound, "{camera} at {x}, {y}: {sum:?} and {other:?}");
                compared += 1;
            }
            prop_assert!(compared > 0 || fov < 1.0 || square < 0.0, "{camera}");
        }
    }
}
