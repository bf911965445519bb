//! A pixel's mean without samples: the area integral itself.
//!
//! In: the prepared scene, and which part of the picture is wanted. Out: for each pixel its mean in
//! linear light, with a bound on its error. In ordinary views (a vertical field of view of 1 to 170
//! degrees, squares of 1e-4 to 1e6 times the eye's height, numbers within 1e±9 or 0) the bound is
//! at most 1e-9, if not less is asked for; in others it is what it is, up to 1 for the mean colour.
//! The work on a pixel is limited: to about a second on the machine where it was measured
//! (`budget`).
//!
//! What is seen is bounded by straight lines and conics, and of one colour (or of one checkerboard)
//! between them. So:
//!
//! 1. The picture is quartered until a part shows one colour for certain, or is a single pixel.
//!    Pixels that show nothing but a checkerboard, and few of its lines, are computed eight at a
//!    time (`checker::board_pixels`).
//! 2. In any other pixel the boundaries of what may be seen there cut it into regions: convex
//!    polygons where all are lines (`arrangement`), slabs between neighbouring curves where some
//!    are conics (`slabs`). A pixel with too many curves is quartered first.
//! 3. One ray into each region, decided without a mistake as every sample's is, says what is seen
//!    there (`region`). Boundaries that are hidden do no harm: both sides of them get the same
//!    colour. (Catmull, "A hidden-surface algorithm with anti-aliasing", 1978, integrates a pixel's
//!    polygons so; conics and the board are added here.)
//! 4. Areas have closed forms: `conic_segment` for what lies between arcs and chords. What a region
//!    shows of a checkerboard is `checker`'s to say.
//!
//! The bound adds up what each step may be off: rounding, what could not be told apart, and what is
//! cut off of infinite sums.

mod arrangement;
mod boundaries;
mod branches;
mod budget;
mod by_key;
mod checker;
mod clip;
mod conic_segment;
mod part_pixels;
mod region;
mod slabs;

use std::{
    array,
    collections::BinaryHeap,
    ops::ControlFlow,
    sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed},
};

use glam::DVec2;

use crate::{
    area::Area,
    cancel,
    color::Color,
    tracer::{Boundary, PicturePart, Quartering, Scratch, SubPixel, VisibilityCandidate, World},
};

use self::{
    budget::Budget,
    by_key::ByKey,
    checker::{
        Sum, UNIT,
        board_pixels::{BoardBatches, BoardPixel},
    },
    part_pixels::PartPixels,
    region::{Regions, Shares},
};

/// A pixel whose bound is no greater than this, in area, is known well enough if nothing else is
/// said: 1e-9 is asked for, roundings of sums included.
const ENOUGH: f64 = 9e-10;
/// A piece with more curves than this is quartered before anything is computed of it: n curves
/// cross in some n² places, and at each of them all have to be looked at, while about half of them
/// pass through a quarter. (Measured: a heap of 300 objects takes half the time with 6 that it
/// takes with 24, and with 96 seven times as long; a dozen objects take a tenth longer with 6.)
const MOST_CURVES: usize = 12;
/// With each quartering so many more are allowed: curves that stay together in small pieces are not
/// likely to part in smaller ones. (Measured: of a heap 1 more takes two thirds of the time, and 16
/// more four times as long.)
const MORE_CURVES: usize = 4;
/// Maximum number of computed pieces of a pixel that are quartered, the worst first, where the
/// bound is above what is asked for. Near a point that a few curves share each takes the bound to a
/// quarter, so that 16 take it to 2^−32 of itself.
const MOST_QUARTERINGS: usize = 16;
/// Maximum memory of the open pieces of a pixel, in bytes, unless the whole pixel as one piece
/// takes more. A pixel that needs more is not divided any further, and its bound says how much of
/// it is in doubt. What one piece takes while it is computed, which grows with its objects, is not
/// counted.
const MOST_MEMORY: usize = 64 << 20;
/// Pieces of a smaller side than this are told to be in doubt: their area is less than a rounding.
const SMALLEST: f64 = 1.0 / (1 << 28) as f64;
/// Units of work of a piece, for itself and for each object in it. What they are is not critical:
/// they only end what takes too long.
const PIECE_WORK: f64 = 100.0;
const OBJECT_WORK: f64 = 4.0;
/// The work of a pair of curves of which one is a conic (measured: a heap of 10⁴ spheres takes
/// twice as long as its regions alone tell).
const SLABS_WORK: f64 = 60.0;
/// The work of a pixel that shows nothing but a few squares of a checkerboard.
const BOARD_PIXEL_WORK: u64 = 10;

/// A pixel computed: of N numbers from 0 to 1 that each colour has, its channels in linear light if
/// nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactPixel<const N: usize = 3> {
    /// Their means.
    pub mean: [f64; N],
    /// How far each may be from the true mean.
    pub bound: f64,
}

/// Computes pixels of one picture.
#[derive(Debug)]
pub struct Integrator<'a, const N: usize = 3> {
    world: &'a World,
    quartering: Quartering<'a>,
    /// Of the palette.
    colors: Vec<[f64; N]>,
    /// The bound that is asked for, in area.
    tolerance: f64,
    /// Units of work that were spent on pixels, and how many may be.
    work: AtomicU64,
    most_work: u64,
}

/// A part of a pixel.
struct Piece {
    sub_pixel: SubPixel,
    /// What may be seen there.
    candidates: Vec<VisibilityCandidate>,
    shares: Shares,
    state: State,
}

/// How a piece of a pixel stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    /// Too many curves pass through it: nothing is computed of it yet.
    Crowded,
    Computed,
    /// Computed; quartering its parent did not halve the bound.
    Final,
}

impl Piece {
    /// Its share of the pixel.
    fn area(&self) -> f64 {
        self.sub_pixel.side * self.sub_pixel.side
    }

    /// How far it may put the pixel off.
    fn bound(&self) -> f64 {
        self.area() * self.shares.bound
    }

    /// Its memory in bytes, apart from its place in the heap.
    fn memory(&self) -> usize {
        let candidates = self.candidates.capacity() * size_of::<VisibilityCandidate>();
        let shares = self.shares.by_slot.capacity() * size_of::<(usize, f64)>();
        candidates + shares
    }
}

impl<'a> Integrator<'a> {
    /// For the pixels of a prepared scene.
    pub fn new(world: &'a World) -> Self {
        Self::of(world, Color::to_linear)
    }
}

impl<'a, const N: usize> Integrator<'a, N> {
    /// For the means of other numbers than its light that a colour has.
    pub fn of(world: &'a World, numbers: impl Fn(Color) -> [f64; N]) -> Self {
        Self {
            world,
            quartering: Quartering::new(world),
            colors: world.palette().iter().copied().map(numbers).collect(),
            tolerance: ENOUGH,
            work: AtomicU64::new(0),
            most_work: u64::MAX,
        }
    }

    /// The same, for which it is enough that pixels are known to within so much.
    pub fn known_to(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// The same, which gives up once it has spent so many units of work; [`shares`](Self::shares)
    /// goes on by the middles of pixels.
    pub fn within(mut self, most_work: u64) -> Self {
        self.most_work = most_work;
        self
    }

    /// The units of work that were spent, of some 50 ns each: the same for the same pixels,
    /// whatever the machine.
    pub fn work(&self) -> u64 {
        self.work.load(Relaxed)
    }

    /// The pixels of a part of the picture, row by row; none once it is cancelled, which ends
    /// within a pixel, too, or given up.
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
        // Pixels of a checkerboard for which that is not enough.
        let mut others = Vec::new();
        let is_ended = || cancel.load(Relaxed) || self.work() > self.most_work;
        let flow = self.quartering.parts(part, &mut scratch, &mut |part| {
            if is_ended() {
                return ControlFlow::Break(());
            }
            match part {
                PicturePart::OneColor { area, slot } => film.fill(area, self.colors[slot]),
                PicturePart::Pixel {
                    x,
                    y,
                    candidates,
                    checks,
                } => match (candidates, checks) {
                    ([candidate], Some(checks)) => {
                        let candidate = *candidate;
                        let pixel = BoardPixel { x, y, candidate };
                        self.work.fetch_add(BOARD_PIXEL_WORK, Relaxed);
                        let mut set = |pixel, sum| self.set(pixel, sum, &mut film, &mut others);
                        batches.push(pixel, checks, &mut set);
                    }
                    _ => film.set(x, y, self.pixel(x, y, candidates, &mut curves, cancel)),
                },
                // `Quartering::new` allows any number of candidates.
                PicturePart::Crowded { .. } => {
                    unreachable!("every part of an exact picture is quartered")
                }
            }
            ControlFlow::Continue(())
        });
        batches.finish(&mut |pixel, sum| self.set(pixel, sum, &mut film, &mut others));
        for BoardPixel { x, y, candidate } in others {
            if is_ended() {
                break;
            }
            film.set(x, y, self.pixel(x, y, &[candidate], &mut curves, cancel));
        }
        (flow.is_continue() && !is_ended()).then_some(film.pixels)
    }

    /// Shows areas of one colour, and of each other pixel how much of it each colour has, by slots
    /// of the palette. Wants a world made by [`World::by_object`]. Beyond the work that may be
    /// spent, the middle of a pixel stands for it. Says whether each share is known to a millionth.
    pub fn shares(&self, part: Area, mut show: impl FnMut(Area, &[(usize, f64)])) -> bool {
        let mut is_exact = true;
        let mut curves = Vec::new();
        let scratch = &mut Scratch::default();
        let _ = self.quartering.parts(part, scratch, &mut |part| {
            match part {
                PicturePart::OneColor { area, slot } => show(area, &[(slot, 1.0)]),
                PicturePart::Pixel { x, y, .. } if self.work() > self.most_work => {
                    let slot = self.world.slot_at(x, y, DVec2::ZERO);
                    is_exact = false;
                    show(Area::pixel(x, y), &[(slot, 1.0)]);
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

    /// The mean of one pixel, of what may be seen in it.
    fn pixel(
        &self,
        x: u32,
        y: u32,
        candidates: &[VisibilityCandidate],
        curves: &mut Vec<Boundary>,
        cancel: &AtomicBool,
    ) -> ExactPixel<N> {
        let together = self.pixel_shares(x, y, candidates, curves, cancel);
        let rounding = rounding(together.by_slot.len());
        let pixel = self.mean(&together.by_slot, (together.bound + rounding).min(1.0));
        match pixel.bound <= self.tolerance {
            true => pixel,
            false => self.centered(&pixel, candidates),
        }
    }

    /// How much of one pixel each colour has: in pieces where the whole has too many curves, or is
    /// not known well enough.
    fn pixel_shares(
        &self,
        x: u32,
        y: u32,
        candidates: &[VisibilityCandidate],
        curves: &mut Vec<Boundary>,
        cancel: &AtomicBool,
    ) -> Shares {
        let budget = Budget::of_pixel(self.tolerance, cancel);
        let mut piece = |sub_pixel, candidates| self.piece(sub_pixel, candidates, curves, &budget);
        let whole = piece(SubPixel::pixel(x, y), candidates.to_vec());
        let mut bound = whole.bound();
        let mut together = Shares::default();
        let mut memory = whole.memory();
        let mut open = BinaryHeap::from([ByKey(bound, whole)]);
        let mut quarterings = 0;
        while bound > self.tolerance
            && !budget.is_spent()
            && open.peek().is_some_and(|ByKey(_, worst)| {
                // A heap that is full has its old places beside twice as many new ones for a
                // moment.
                let copies = if open.len() + 3 > open.capacity() {
                    3
                } else {
                    1
                };
                let places = copies * open.capacity() * size_of::<ByKey<Piece>>();
                memory + places + 4 * worst.memory() <= MOST_MEMORY
            })
            && let Some(ByKey(_, worst)) = open.pop()
        {
            memory -= worst.memory();
            let may_be_better = match worst.state {
                State::Crowded => worst.sub_pixel.side > SMALLEST,
                State::Computed => quarterings < MOST_QUARTERINGS,
                State::Final => false,
            };
            if !may_be_better {
                together.add_part(&worst.shares, worst.area());
                continue;
            }
            let mut quarters = worst.sub_pixel.quarters().map(|sub_pixel| {
                let mut seen = Vec::new();
                boundaries::narrowed(self.world, sub_pixel, &worst.candidates, &mut seen);
                piece(sub_pixel, seen)
            });
            let after: f64 = quarters.iter().map(Piece::bound).sum();
            if worst.state == State::Computed {
                quarterings += 1;
                if after > 0.5 * worst.bound() {
                    quarters
                        .iter_mut()
                        .for_each(|quarter| quarter.state = State::Final);
                }
                if after >= worst.bound() {
                    together.add_part(&worst.shares, worst.area());
                    continue;
                }
            }
            bound += after - worst.bound();
            memory += quarters.iter().map(Piece::memory).sum::<usize>();
            open.extend(quarters.map(|quarter| ByKey(quarter.bound(), quarter)));
        }
        for ByKey(_, piece) in open {
            together.add_part(&piece.shares, piece.area());
        }
        self.work.fetch_add(budget.spent() as u64, Relaxed);
        together
    }

    /// Moves the mean of a pixel to the middle of what is possible: within its bound, and between
    /// the least and the greatest number of all colours that may be seen there.
    fn centered(&self, pixel: &ExactPixel<N>, candidates: &[VisibilityCandidate]) -> ExactPixel<N> {
        let is_covered = candidates.iter().any(|candidate| candidate.is_whole);
        let background = (!is_covered).then(|| self.world.background());
        let slots = candidates.iter();
        let slots = slots.flat_map(|candidate| self.world.slots(candidate.object));
        let (mut low, mut high) = ([f64::INFINITY; N], [f64::NEG_INFINITY; N]);
        for slot in slots.chain(background) {
            let color = self.colors[slot];
            low = array::from_fn(|i| low[i].min(color[i]));
            high = array::from_fn(|i| high[i].max(color[i]));
        }
        let ExactPixel { mean, bound } = *pixel;
        let least: [f64; N] = array::from_fn(|i| (mean[i] - bound).max(low[i]));
        let greatest: [f64; N] = array::from_fn(|i| (mean[i] + bound).min(high[i]));
        let widths = (0..N).map(|i| greatest[i] - least[i]);
        ExactPixel {
            mean: array::from_fn(|i| least[i].midpoint(greatest[i])),
            // The numbers are at most 1, and have been rounded twice.
            bound: 0.5 * widths.fold(0.0, f64::max) + 4.0 * UNIT,
        }
    }

    /// Sets a pixel of a checkerboard by its integral, if that is known well enough; else it is one
    /// of the others.
    fn set(
        &self,
        pixel: BoardPixel,
        sum: Option<Sum>,
        film: &mut PartPixels<N>,
        others: &mut Vec<BoardPixel>,
    ) {
        // A share is rounded once, and the mean of two.
        let roundings = UNIT + rounding(2);
        let half = sum.map(|Sum { value, bound }| (0.5 * value, 0.5 * bound + roundings));
        let Some((half, bound)) = half.filter(|(_, bound)| *bound <= self.tolerance) else {
            return others.push(pixel);
        };
        let [first, second] = self.world.slots(pixel.candidate.object);
        let shares = [(first, 0.5 + half), (second, 0.5 - half)];
        film.set(pixel.x, pixel.y, self.mean(&shares, bound));
    }

    /// A piece of a pixel with what is seen there, if there are not too many curves.
    fn piece(
        &self,
        sub_pixel: SubPixel,
        candidates: Vec<VisibilityCandidate>,
        curves: &mut Vec<Boundary>,
        budget: &Budget,
    ) -> Piece {
        let quarterings = libm::ilogb(sub_pixel.side).unsigned_abs() as usize;
        let most = MOST_CURVES + MORE_CURVES * quarterings;
        budget.charge(PIECE_WORK + candidates.len() as f64 * OBJECT_WORK);
        let are_all = boundaries::curves(self.world, sub_pixel, &candidates, most, budget, curves);
        let is_computed = are_all && !budget.is_spent();
        let shares = match is_computed {
            true => {
                let regions = Regions::new(self.world, sub_pixel, &candidates, budget);
                let lines = curves.iter().map(|curve| match curve {
                    Boundary::Line(line) => Some(*line),
                    Boundary::Conic(_) => None,
                });
                match lines.collect::<Option<Vec<_>>>() {
                    Some(lines) => arrangement::shares(&lines, regions),
                    None => {
                        // Each conic is followed past all others.
                        budget.charge(SLABS_WORK * (curves.len() * curves.len()) as f64);
                        slabs::shares(curves, regions)
                    }
                }
            }
            false => Shares::unknown(self.world, sub_pixel, &candidates, budget),
        };
        let state = match is_computed {
            true => State::Computed,
            false => State::Crowded,
        };
        Piece {
            sub_pixel,
            candidates,
            shares,
            state,
        }
    }

    fn mean(&self, by_slot: &[(usize, f64)], bound: f64) -> ExactPixel<N> {
        let mut mean = [0.0; N];
        match by_slot {
            [(slot, _)] => mean = self.colors[*slot],
            by_slot => {
                let total: f64 = by_slot.iter().map(|(_, share)| share).sum();
                for (slot, share) in by_slot {
                    for (sum, channel) in mean.iter_mut().zip(self.colors[*slot]) {
                        *sum += share * channel;
                    }
                }
                mean = mean.map(|sum| (sum / total).clamp(0.0, 1.0));
            }
        }
        ExactPixel { mean, bound }
    }
}

/// What the mean of so many colours is rounded by at most: the sum of its products and that of the
/// shares have as many roundings as there are colours, a product has one, and so has the quotient.
/// One colour has none.
fn rounding(colors: usize) -> f64 {
    match colors {
        0..=1 => 0.0,
        _ => (2 * colors + 2) as f64 * UNIT,
    }
}
