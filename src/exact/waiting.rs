//! Pixels that show nothing but a checkerboard: they wait for others that as many of its lines cross, and are computed together with them
//! (`together`); one by one where that is too many lines (`grid`).
//!
//! A pixel's sum is made of its own numbers, by the same operations whichever others it is computed with: so it does not matter in what
//! order pixels come, nor which part of a picture is wanted.

use super::{
    board::Sum,
    grid,
    groups::{Corners, Group, Groups},
};
use crate::tracer::{Board, Boards, Candidate, PIXELS, SubPixel, Views, World, board};

/// A pixel that shows nothing but a checkerboard.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoardPixel {
    /// Its column.
    pub x: u32,
    /// Its row.
    pub y: u32,
    /// The checkerboard.
    pub live: Candidate,
}

/// The pixels that wait.
#[derive(Debug)]
pub(super) struct Waiting<'a> {
    world: &'a World,
    /// Pixels not looked at so far, all of one checkerboard.
    next: Vec<BoardPixel>,
    /// That checkerboard, as an object of the scene, and what its pixels have in common.
    boards: Option<(usize, Boards)>,
    views: Views,
    corners: Corners,
    groups: Groups<BoardPixel>,
}

impl<'a> Waiting<'a> {
    /// None so far.
    pub fn new(world: &'a World) -> Self {
        Self {
            world,
            next: Vec::with_capacity(PIXELS),
            boards: None,
            views: Views::default(),
            corners: Corners::default(),
            groups: Groups::default(),
        }
    }

    /// Has a pixel wait. Of all that are computed now the integrals are told, positive for the first colour; none where something else has to be
    /// tried.
    pub fn push(&mut self, pixel: BoardPixel, tell: &mut impl FnMut(BoardPixel, Option<Sum>)) {
        let object = pixel.live.object;
        if !matches!(self.boards, Some((known, _)) if known == object) {
            self.look(tell);
            self.boards = board::boards(self.world, object).map(|boards| (object, boards));
        }
        self.next.push(pixel);
        if self.next.len() == PIXELS {
            self.look(tell);
        }
    }

    /// Computes all that still wait.
    pub fn finish(mut self, tell: &mut impl FnMut(BoardPixel, Option<Sum>)) {
        self.look(tell);
        for group in self.groups.all() {
            compute(group, tell);
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
            let Some(group) = self.groups.of(&self.corners, i) else {
                let board = match self.views.rad[i] < f64::INFINITY {
                    true => Some(of_several(&self.views, i)),
                    false => board::board(
                        self.world,
                        pixel.live.object,
                        SubPixel::pixel(pixel.x, pixel.y),
                    ),
                };
                tell(pixel, board.as_ref().and_then(alone));
                continue;
            };
            if group.push(pixel, &self.views, &self.corners, i) {
                compute(group, tell);
            }
        }
    }
}

/// The integrals of a group's pixels, after which it is empty.
fn compute(group: &mut Group<BoardPixel>, tell: &mut impl FnMut(BoardPixel, Option<Sum>)) {
    if group.pixels.is_empty() {
        return;
    }
    let sums = group.sums();
    for (i, pixel) in group.pixels.drain(..).enumerate() {
        tell(pixel, Some(sums.of(i)));
    }
}

/// A pixel's integral on its own, positive for the first colour.
pub(super) fn alone(board: &Board) -> Option<Sum> {
    let Sum { value, bound } = grid::sum(board)?;
    let value = if board.odd { -value } else { value };
    Some(Sum { value, bound })
}

/// One pixel's board of several. What rounding has left of its factors nobody asks for here.
pub(super) fn of_several(views: &Views, pixel: usize) -> Board {
    Board {
        across: views
            .across
            .each_ref()
            .map(|form| form.map(|factor| factor[pixel])),
        below: views.below.map(|factor| factor[pixel]),
        low: [[0.0; 3]; 3],
        rads: [views.rad[pixel]; 3],
        odd: views.sign[pixel] < 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scene,
        source::{Source, Sources},
    };
    use proptest::prelude::*;
    use std::collections::HashMap;

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
        let live = crate::tracer::candidates::everything(world)[0];
        let mut waiting = Waiting::new(world);
        let mut known = HashMap::new();
        let mut tell = |pixel: BoardPixel, sum| {
            assert!(known.insert((pixel.x, pixel.y), sum).is_none());
        };
        for (x, y) in order {
            waiting.push(BoardPixel { x, y, live }, &mut tell);
        }
        waiting.finish(&mut tell);
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
        fn it_is_what_each_pixel_gives_for_itself(
            place in prop::array::uniform2(-9.0..9.0_f64),
            offset in prop::sample::select(vec![0.0, 1e6, -1e12]),
            // As powers of ten.
            height in -1.0..2.0_f64,
            square in -3.0..3.0_f64,
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
            for ((x, y), sum) in sums(&world, pixels()) {
                let other = board::board(&world, 0, SubPixel::pixel(x, y)).as_ref().and_then(alone);
                let what = format!("{camera} at {x}, {y}: {sum:?} and {other:?}");
                match (sum, other) {
                    (Some(sum), Some(other)) => {
                        let off = (sum.value - other.value).abs();
                        prop_assert!(off <= sum.bound + other.bound, "{what}");
                        // The same terms, none of which is negative, in another order; and together the greatest error of the three forms in
                        // double-double is taken for all of them, which is next to nothing of a rounding.
                        prop_assert!(sum.bound <= other.bound * (1.0 + 1e-9), "{what}");
                    }
                    // Too uncertain for either.
                    (Some(sum), None) => {
                        prop_assert!(sum.bound.is_nan() || sum.bound > 0.9e-10, "{what}");
                    }
                    (None, other) => prop_assert!(other.is_none(), "{what}"),
                }
            }
        }
    }
}
