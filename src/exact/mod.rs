//! Exact pixel means: a pixel's mean is integrated exactly over its area, not sampled.
//!
//! In: the prepared scene and the part of the picture to compute. Out: the mean of each pixel in
//! linear light, with a bound on the mean's error. In ordinary views, the bound is at most 1e-9
//! unless the caller asks for less accuracy. A view is ordinary if the vertical field of view is 1
//! to 170 degrees, squares are 1e-4 to 1e6 times the eye's height, and every number is 0 or between
//! 1e-9 and 1e9 in absolute value. In other views, the bound may be larger, up to 1 for a pixel
//! that cannot be computed. The work on a pixel is limited: no pixel takes more than about a second
//! (`budget`).
//!
//! Lines and conics divide a pixel into regions, each of which shows one colour or one
//! checkerboard. The means are therefore computed in four steps:
//!
//! 1. The picture is quartered repeatedly, until each part certainly shows one colour or is a
//!    single pixel. Pixels that show only a checkerboard, and few of its lines, are computed eight
//!    at a time (`checker::board_pixels`).
//! 2. Any other pixel is cut into regions along the boundaries of the objects that may be seen
//!    there. If all boundaries are lines, the regions are convex polygons (`arrangement`). If some
//!    are conics, the pixel is cut into vertical strips, and each strip between neighbouring curves
//!    (`slabs`). A pixel with too many curves is quartered first.
//! 3. One ray into each region determines what is seen there (`region`). The ray is traced with the
//!    same exact decisions as in a sampled picture. Hidden boundaries do no harm, because both
//!    sides of them get the same colour. (Catmull, "A hidden-surface algorithm with anti-aliasing",
//!    1978, integrates a pixel's polygons this way; conics and the board are added here.)
//! 4. Areas have closed forms. `conic_segment` computes the area between an arc and its chord;
//!    `checker` integrates a checkerboard over a region.
//!
//! The error bound is the sum of the errors of all steps: rounding, decisions that remained
//! uncertain, and the truncation of infinite sums.

mod arrangement;
mod boundaries;
mod branches;
mod budget;
mod by_key;
mod checker;
mod clip;
mod conic_segment;
mod means;
mod part_pixels;
mod region;
mod slabs;

use std::{
    collections::BinaryHeap,
    ops::ControlFlow,
    sync::atomic::{AtomicBool, Ordering::Relaxed},
};

use glam::DVec2;

use crate::{
    area::Area,
    cancel,
    color::Color,
    tracer::{Boundary, PicturePart, Quartering, Scratch, SubPixel, VisibilityCandidate, World},
};

use self::{
    budget::{PictureWork, PixelBudget},
    by_key::ByKey,
    checker::{
        BoundedSum, UNIT,
        board_pixels::{BoardBatches, BoardPixel},
    },
    means::rounding,
    part_pixels::PartPixels,
    region::{LocalBoard, Region, Regions, Shares},
};

/// Default of the requested error bound: the fraction of a pixel's area that may have a wrong
/// colour. It is a little below 1e-9, to leave room for the rounding of sums.
const DEFAULT_TOLERANCE: f64 = 9e-10;
/// Maximum number of curves that pass through a whole pixel. With more curves, the pixel is
/// quartered before anything is computed. n curves cross at about n² points, and the work at each
/// of them is proportional to n. In a quarter, there are only about half as many curves. Measured:
/// with 6 instead of 12, a dozen objects take 10 % longer. A heap of 300 objects takes twice as
/// long with 24 as with 6, and seven times as long with 96 as with 24.
const MAX_CURVES: usize = 12;
/// Number by which the maximum number of curves in a square part of a pixel grows with each
/// quartering. Curves that still pass through the same small part are unlikely to be separated in
/// smaller parts, so further quartering hardly helps. Measured: with 1, a heap of objects takes two
/// thirds of the time; with 16, it takes four times as long.
const MAX_CURVES_PER_QUARTERING: usize = 4;
/// Maximum number of times per pixel that an already computed part of the pixel is quartered to
/// reduce its error bound. Near a point where several curves meet, each quartering reduces the
/// bound to a quarter; 16 quarterings reduce it by a factor of 2^32.
const MAX_QUARTERINGS: usize = 16;
/// Maximum memory of a pixel's queued parts, in bytes. Temporary memory for computing a part is not
/// included. Above the maximum, no part is quartered any more, and the areas of parts that are not
/// computed are added to the error bound. A smaller maximum would cause this error more often.
const MAX_MEMORY: usize = 64 << 20;
/// Minimum side, in pixels, of a square part of a pixel that is quartered because too many curves
/// pass through it. A smaller part is not quartered. Its area, at most 2⁻⁵⁶ of the pixel's area, is
/// added to the error bound.
const MIN_SIDE: f64 = 1.0 / (1 << 28) as f64;
/// Work charged to a pixel's budget per square part of the pixel ([`PixelPiece`]), in units of
/// about 50 ns. A rough value is enough, because the budget only stops computations that take too
/// long.
const PIECE_WORK: f64 = 100.0;
/// Work charged per object that may be seen in a part of a pixel, in units of about 50 ns. A rough
/// value is enough, because the budget only stops computations that take too long.
const OBJECT_WORK: f64 = 4.0;
/// Work charged per ordered pair of curves in a part of a pixel, in units of about 50 ns. It is
/// charged only if one of the curves is a conic. Without this charge, half of the time measured for
/// a heap of 10⁴ spheres would not be counted.
const SLABS_WORK: f64 = 60.0;
/// Work charged per pixel that shows only a few squares of a checkerboard, in units of about 50 ns.
const BOARD_PIXEL_WORK: u64 = 10;

/// A computed pixel. Each colour is described by N values from 0 to 1, by default its three
/// channels in linear light. The pixel contains the mean of each value over its area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactPixel<const N: usize = 3> {
    /// Mean of each value over the pixel's area.
    pub mean: [f64; N],
    /// Maximum absolute error of each mean.
    pub bound: f64,
}

/// Integrator that computes the exact pixels of a picture.
#[derive(Debug)]
pub struct Integrator<'a, const N: usize = 3> {
    pub(crate) world: &'a World,
    quartering: Quartering<'a>,
    /// The N values of each colour of the world's palette, in the order of the palette.
    colors: Vec<[f64; N]>,
    /// Requested error bound: the fraction of a pixel's area that may have a wrong colour.
    tolerance: f64,
    work: PictureWork,
}

/// A square part of a pixel (a piece). The fraction of its area that shows each colour is computed
/// separately from that of other pieces.
struct PixelPiece {
    sub_pixel: SubPixel,
    /// Objects that may be seen in this part of the pixel.
    candidates: Vec<VisibilityCandidate>,
    shares: Shares,
    state: PieceState,
}

/// State of the computation of a part of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PieceState {
    /// Nothing is computed yet, because too many curves pass through this part of the pixel or the
    /// budget is spent.
    Crowded,
    Computed,
    /// Computed, and not to be quartered, since the last quartering hardly reduced the bound.
    Final,
}

impl PixelPiece {
    /// Returns the area of this part as a fraction of the pixel.
    fn area(&self) -> f64 {
        self.sub_pixel.side * self.sub_pixel.side
    }

    /// Returns the maximum error of the pixel's mean that this part of the pixel may cause.
    fn bound(&self) -> f64 {
        self.area() * self.shares.bound
    }

    /// Returns the memory of this part's vectors, in bytes, without that of the struct itself.
    fn memory(&self) -> usize {
        let candidates = self.candidates.capacity() * size_of::<VisibilityCandidate>();
        let shares = self.shares.by_slot.capacity() * size_of::<(usize, f64)>();
        candidates + shares
    }
}

impl<'a> Integrator<'a> {
    /// Prepares to integrate the linear light of a prepared scene.
    pub fn new(world: &'a World) -> Self {
        Self::for_values(world, Color::to_linear)
    }
}

impl<'a, const N: usize> Integrator<'a, N> {
    /// Prepares to integrate N values per colour, which `values` computes from the colour.
    pub fn for_values(world: &'a World, values: impl Fn(Color) -> [f64; N]) -> Self {
        Self {
            world,
            quartering: Quartering::new(world),
            colors: world.palette().iter().copied().map(values).collect(),
            tolerance: DEFAULT_TOLERANCE,
            work: PictureWork::new(u64::MAX),
        }
    }

    /// Sets the requested error bound: the fraction of a pixel's area that may have a wrong colour.
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Limits the work on the picture, in units of about 50 ns. If the limit is exceeded,
    /// [`pixels`](Self::pixels) returns `None`. [`shares`](Self::shares) then examines only the
    /// middle of each remaining pixel and gives its colour to the whole pixel.
    pub fn with_work_limit(mut self, limit: u64) -> Self {
        self.work = PictureWork::new(limit);
        self
    }

    /// Returns the work spent so far, in units of about 50 ns. The same pixels require the same
    /// work on every machine.
    pub fn work(&self) -> u64 {
        self.work.spent()
    }

    /// Computes the pixels of a part of the picture, row by row. Returns `None` if `cancel` is set,
    /// even within a pixel, or if the work limit is exceeded.
    pub fn pixels(&self, part: Area, cancel: &AtomicBool) -> Option<Vec<ExactPixel<N>>> {
        let black = ExactPixel {
            mean: [0.0; N],
            bound: 0.0,
        };
        let mut film = PartPixels {
            part,
            pixels: vec![black; part.pixels() as usize],
        };
        let mut curves = Vec::new();
        let mut scratch = Scratch::default();
        let mut batches = BoardBatches::new();
        // Checkerboard pixels that are computed one at a time instead of eight together, because
        // too many lines cross them or the result of the eight was not accurate enough.
        let mut deferred = Vec::new();
        let is_over = || cancel.load(Relaxed) || self.work.is_exceeded();
        let flow = self.quartering.parts(part, &mut scratch, &mut |part| {
            if is_over() {
                return ControlFlow::Break(());
            }
            match part {
                PicturePart::OneColor { area, color_index } => {
                    film.fill(area, self.colors[color_index])
                }
                PicturePart::Pixel {
                    x,
                    y,
                    candidates,
                    checks,
                } => match (candidates, checks) {
                    ([candidate], Some(checks)) => {
                        let candidate = *candidate;
                        let pixel = BoardPixel { x, y, candidate };
                        self.work.add(BOARD_PIXEL_WORK);
                        let mut set = |pixel, sum| self.set(pixel, sum, &mut film, &mut deferred);
                        batches.push(pixel, checks, &mut set);
                    }
                    _ => film.set(x, y, self.pixel(x, y, candidates, &mut curves, cancel)),
                },
                // A part is `Crowded` only if it has more candidates than a limit, and
                // `Quartering::new` sets no limit.
                PicturePart::Crowded { .. } => {
                    unreachable!("every part of an exact picture is quartered")
                }
            }
            ControlFlow::Continue(())
        });
        batches.finish(&mut |pixel, sum| self.set(pixel, sum, &mut film, &mut deferred));
        for board_pixel @ BoardPixel { x, y, candidate } in deferred {
            if is_over() {
                break;
            }
            let pixel = self
                .board_mean(&board_pixel, self.board_sum(&board_pixel, cancel))
                .unwrap_or_else(|| self.pixel(x, y, &[candidate], &mut curves, cancel));
            film.set(x, y, pixel);
        }
        (flow.is_continue() && !is_over()).then_some(film.pixels)
    }

    /// Divides `part` into areas that show only one entry of the world's palette, and single
    /// pixels. Calls `show` with each of them and the fraction of its area that shows each entry.
    /// An entry is a colour or, in a world made by [`World::by_object`], an object. If the work
    /// limit is exceeded, each remaining pixel is treated as showing only the entry in its middle.
    /// Returns whether the errors of all fractions are at most 1e-6.
    pub fn shares(&self, part: Area, mut show: impl FnMut(Area, &[(usize, f64)])) -> bool {
        let mut is_exact = true;
        let mut curves = Vec::new();
        let scratch = &mut Scratch::default();
        let _ = self.quartering.parts(part, scratch, &mut |part| {
            match part {
                PicturePart::OneColor { area, color_index } => show(area, &[(color_index, 1.0)]),
                PicturePart::Pixel { x, y, .. } if self.work.is_exceeded() => {
                    let color_index = self.world.color_index_at(x, y, DVec2::ZERO);
                    is_exact = false;
                    show(Area::pixel(x, y), &[(color_index, 1.0)]);
                }
                PicturePart::Pixel {
                    x, y, candidates, ..
                } => {
                    let seen = self.pixel_shares(x, y, candidates, &mut curves, &cancel::NEVER);
                    is_exact &= seen.bound <= 1e-6;
                    show(Area::pixel(x, y), &seen.by_slot);
                }
                PicturePart::Crowded { .. } => {
                    unreachable!("every part of an exact picture is quartered")
                }
            }
            ControlFlow::Continue(())
        });
        is_exact
    }

    /// Computes the mean of the pixel (`x`, `y`). `candidates` are the objects that may be seen in
    /// it.
    fn pixel(
        &self,
        x: u32,
        y: u32,
        candidates: &[VisibilityCandidate],
        curves: &mut Vec<Boundary>,
        cancel: &AtomicBool,
    ) -> ExactPixel<N> {
        let shares = self.pixel_shares(x, y, candidates, curves, cancel);
        let rounding = rounding(shares.by_slot.len());
        let pixel = self.mean(&shares.by_slot, (shares.bound + rounding).min(1.0));
        if pixel.bound <= self.tolerance {
            pixel
        } else {
            self.center_in_range(&pixel, candidates)
        }
    }

    /// Computes the fraction of the pixel (`x`, `y`) that shows each colour. While the total error
    /// bound of the pixel's parts exceeds the tolerance, quarters the part with the largest bound.
    /// A part is not quartered if it has reached a limit ([`MIN_SIDE`], [`MAX_QUARTERINGS`]) or if
    /// the last quartering hardly reduced the bound. Stops when the budget is spent or
    /// [`MAX_MEMORY`] would be exceeded.
    fn pixel_shares(
        &self,
        x: u32,
        y: u32,
        candidates: &[VisibilityCandidate],
        curves: &mut Vec<Boundary>,
        cancel: &AtomicBool,
    ) -> Shares {
        let budget = PixelBudget::new(self.tolerance, cancel);
        let mut piece = |sub_pixel, candidates| self.piece(sub_pixel, candidates, curves, &budget);
        let whole = piece(SubPixel::pixel(x, y), candidates.to_vec());
        let mut bound = whole.bound();
        let mut shares = Shares::default();
        let mut memory = whole.memory();
        let mut queue = BinaryHeap::from([ByKey(bound, whole)]);
        let mut quarterings = 0;
        while bound > self.tolerance
            && !budget.is_spent()
            && queue.peek().is_some_and(|ByKey(_, worst)| {
                // If the queue is full, adding parts copies it to twice as much memory. During the
                // copy, the old and the new memory both exist.
                let copies = 1 + 2 * usize::from(queue.len() + 3 > queue.capacity());
                let places = copies * queue.capacity() * size_of::<ByKey<PixelPiece>>();
                memory + places + 4 * worst.memory() <= MAX_MEMORY
            })
            && let Some(ByKey(_, worst)) = queue.pop()
        {
            memory -= worst.memory();
            let may_improve = match worst.state {
                PieceState::Crowded => worst.sub_pixel.side > MIN_SIDE,
                PieceState::Computed => quarterings < MAX_QUARTERINGS,
                PieceState::Final => false,
            };
            if !may_improve {
                shares.add_part(&worst.shares, worst.area());
                continue;
            }
            let mut quarters = worst.sub_pixel.quarters().map(|sub_pixel| {
                piece(
                    sub_pixel,
                    boundaries::visible(self.world, sub_pixel, &worst.candidates),
                )
            });
            let after: f64 = quarters.iter().map(PixelPiece::bound).sum();
            if worst.state == PieceState::Computed {
                quarterings += 1;
                if after > 0.5 * worst.bound() {
                    quarters
                        .iter_mut()
                        .for_each(|quarter| quarter.state = PieceState::Final);
                }
                if after >= worst.bound() {
                    shares.add_part(&worst.shares, worst.area());
                    continue;
                }
            }
            bound += after - worst.bound();
            memory += quarters.iter().map(PixelPiece::memory).sum::<usize>();
            queue.extend(quarters.map(|quarter| ByKey(quarter.bound(), quarter)));
        }
        for ByKey(_, piece) in queue {
            shares.add_part(&piece.shares, piece.area());
        }
        self.work.add(budget.spent() as u64);
        shares
    }

    /// Sets a checkerboard pixel in `film` from `sum`, the integral of the board's sign. Appends
    /// the pixel to `deferred` instead if `sum` is `None` or its bound exceeds the tolerance.
    fn set(
        &self,
        board_pixel: BoardPixel,
        sum: Option<BoundedSum>,
        film: &mut PartPixels<N>,
        deferred: &mut Vec<BoardPixel>,
    ) {
        match self.board_mean(&board_pixel, sum) {
            Some(pixel) => film.set(board_pixel.x, board_pixel.y, pixel),
            None => deferred.push(board_pixel),
        }
    }

    /// Integrates the board's sign over a pixel that shows only a checkerboard.
    fn board_sum(&self, pixel: &BoardPixel, cancel: &AtomicBool) -> Option<BoundedSum> {
        let sub_pixel = SubPixel::pixel(pixel.x, pixel.y);
        let board = LocalBoard::new(self.world, pixel.candidate.object, sub_pixel)?;
        let budget = PixelBudget::new(self.tolerance, cancel);
        budget.charge(PIECE_WORK);
        let sum = board.sum(&Region::PIXEL, &budget);
        self.work.add(budget.spent() as u64);
        Some(sum)
    }

    /// Returns the mean of a pixel that shows only a checkerboard from `sum`, the integral of the
    /// board's sign. Returns `None` if `sum` is `None` or its bound exceeds the tolerance.
    fn board_mean(&self, pixel: &BoardPixel, sum: Option<BoundedSum>) -> Option<ExactPixel<N>> {
        let BoundedSum { value, bound } = sum?;
        // `UNIT` bounds the rounding errors of the two colours' shares, and `rounding(2)` that of
        // the mean.
        let (half, bound) = (0.5 * value, 0.5 * bound + UNIT + rounding(2));
        let [first, second] = self.world.color_indices(pixel.candidate.object);
        (bound <= self.tolerance)
            .then(|| self.mean(&[(first, 0.5 + half), (second, 0.5 - half)], bound))
    }

    /// Computes the colours' shares in a part of a pixel. If too many curves pass through it or the
    /// budget is spent, the part is [`Crowded`](PieceState::Crowded), and its whole area is added
    /// to the error bound.
    fn piece(
        &self,
        sub_pixel: SubPixel,
        candidates: Vec<VisibilityCandidate>,
        curves: &mut Vec<Boundary>,
        budget: &PixelBudget,
    ) -> PixelPiece {
        let quarterings = libm::ilogb(sub_pixel.side).unsigned_abs() as usize;
        let most = MAX_CURVES + MAX_CURVES_PER_QUARTERING * quarterings;
        budget.charge(PIECE_WORK + candidates.len() as f64 * OBJECT_WORK);
        let are_all = boundaries::curves(self.world, sub_pixel, &candidates, most, budget, curves);
        let regions = Regions::new(self.world, sub_pixel, &candidates, budget);
        let (shares, state) = if are_all && !budget.is_spent() {
            let lines = curves.iter().map(|curve| match curve {
                Boundary::Line(line) => Some(*line),
                Boundary::Conic(_) => None,
            });
            let shares = match lines.collect::<Option<Vec<_>>>() {
                Some(lines) => arrangement::shares(&lines, regions),
                None => {
                    // The work grows with the number of pairs of curves, because each conic is
                    // compared with all other curves.
                    budget.charge(SLABS_WORK * (curves.len() * curves.len()) as f64);
                    slabs::shares(curves, regions)
                }
            };
            (shares, PieceState::Computed)
        } else {
            (regions.unknown(), PieceState::Crowded)
        };
        PixelPiece {
            sub_pixel,
            candidates,
            shares,
            state,
        }
    }
}
