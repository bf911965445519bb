//! The regions of a spot, and what is seen in each.

use std::{
    mem,
    sync::atomic::{AtomicBool, Ordering},
};

use glam::DVec2;

use crate::{
    math::Real,
    tracer::{self, Candidate, SubPixel, World, board, candidates},
};

use super::{
    arc::Arc,
    board::Board,
    care::Care,
    sides::{Known, Sides},
};

/// How much of a spot each colour has.
#[derive(Clone, Debug, Default)]
pub struct Shares {
    /// Slots of the palette with the area that shows them, 1 together but for rounding.
    pub by_slot: Vec<(usize, f64)>,
    /// How much area may be with the wrong colour.
    pub bound: f64,
    /// How much of that boards leave, by what is not known of their squares.
    pub of_boards: f64,
    /// Whether very many squares are among it, or squares without end.
    pub is_crowded: bool,
}

/// About so many pieces of a pixel may be looked at together: in one that is smaller than such a part of it as much may be neglected as in one of
/// those.
const PIECES: f64 = 4.0;

/// Collects the regions of one spot.
pub struct Regions<'a> {
    world: &'a World,
    spot: SubPixel,
    live: &'a [Candidate],
    /// Sides of pixels that are known.
    sides: &'a mut Sides,
    /// The boards that were met so far, by object.
    boards: Vec<(usize, Checkered)>,
    /// How closely boards are looked at.
    care: Care,
    shares: Shares,
    cancel: &'a AtomicBool,
}

struct Checkered {
    board: Board,
    odd: bool,
    /// How far its forms' values may be off, by the size of their terms.
    doubt: f64,
}

/// A region: a polygon, and arcs over some of its sides that bulge out of it or into it.
pub struct Region<'a> {
    /// Convex, its vertices in order.
    pub polygon: &'a [DVec2],
    /// Each with 1 if it bulges outwards, −1 if inwards.
    pub arcs: &'a [(f64, Arc)],
    /// Its area.
    pub area: f64,
    /// A point in it.
    pub inside: DVec2,
}

impl<'a> Regions<'a> {
    /// For a spot in which no other objects are seen than some.
    pub fn new(
        world: &'a World,
        spot: SubPixel,
        live: &'a [Candidate],
        sides: &'a mut Sides,
        care: Care,
        cancel: &'a AtomicBool,
    ) -> Self {
        Self {
            world,
            spot,
            live,
            sides,
            boards: Vec::new(),
            care,
            shares: Shares::default(),
            cancel,
        }
    }

    /// Whether nobody wants the shares any more.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// Adds a region in which no boundary lies.
    pub fn add(&mut self, region: &Region) {
        let Some(object) = self.seen(region) else {
            let background = self.world.palette().len() - 1;
            return self.shares.add(background, region.area);
        };
        let [first, second] = self.world.slots(object);
        if first == second {
            return self.shares.add(first, region.area);
        }
        let Some(at) = self.board(object) else {
            return self.shares.add(first, region.area);
        };
        let checkered = &self.boards[at].1;
        let world = self.world;
        let mut known = Known {
            sides: self.sides,
            board: object,
            x: self.spot.x,
            y: self.spot.y,
            odd: checkered.odd,
            elsewhere: &|x, y| {
                let Checkered { board, odd, .. } =
                    Checkered::new(world, object, SubPixel::pixel(x, y))?;
                Some((board, odd))
            },
        };
        let is_pixel = self.spot.side == 1.0;
        let known = is_pixel.then_some(&mut known);
        let mut sum = checkered.board.over(region.polygon, known, self.cancel);
        for (bulge, arc) in region.arcs {
            let sliver = checkered.board.sliver(arc, self.cancel);
            sum.value += bulge * sliver.value;
            sum.bound += sliver.bound;
        }
        let half = if checkered.odd { -0.5 } else { 0.5 } * sum.value;
        // The board's own bound is for forms with a rounding in each factor. Whatever they are, no share is greater than the area.
        let bound = 0.5 * sum.bound * (1.0 + checkered.doubt / f64::UNIT);
        let bound = bound.min(0.5 * region.area + half.abs());
        self.shares.add(first, 0.5 * region.area + half);
        self.shares.add(second, 0.5 * region.area - half);
        self.shares.bound += bound;
        self.shares.of_boards += bound;
        self.shares.is_crowded |= checkered.board.is_crowded(region.polygon);
    }

    /// The object that is seen in a region. Where the last precision says so, the point asked may be one of a few at which things are nearer to
    /// each other than it tells; elsewhere in the region more may be known.
    fn seen(&mut self, region: &Region) -> Option<usize> {
        let at = |point| candidates::object_at(self.world, self.spot, point, self.live);
        let (seen, is_sure) = at(region.inside);
        // A point between two of a polygon lies in it, but not if an arc takes off from that.
        if is_sure || region.arcs.iter().any(|(bulge, _)| *bulge < 0.0) {
            return seen;
        }
        let between = |vertex: &DVec2| at(region.inside.midpoint(*vertex));
        let others: Vec<_> = region.polygon.iter().map(between).collect();
        if let Some((sure, _)) = others.iter().find(|(_, is_sure)| *is_sure) {
            return *sure;
        }
        if others.iter().any(|(other, _)| *other != seen) {
            self.doubt(region.area);
        }
        seen
    }

    /// Says that so much of the pixel's area may be with a wrong region, or with none.
    pub fn doubt(&mut self, area: f64) {
        self.shares.bound += area;
    }

    /// The shares of all that was added.
    pub fn finish(mut self) -> Shares {
        let mut shares = mem::take(&mut self.shares);
        // What the regions leave out of the spot, or count twice, may have any colour.
        let total: f64 = shares.by_slot.iter().map(|(_, share)| share).sum();
        shares.bound += (1.0 - total).abs();
        if !(shares.bound.is_finite() && total > 0.0 && total < 2.0) {
            // Out of the range of numbers: nothing is known of the spot but what is in its middle.
            let (seen, _) = candidates::object_at(self.world, self.spot, DVec2::ZERO, self.live);
            let background = self.world.background();
            let [first, second] = seen.map_or([background; 2], |object| self.world.slots(object));
            shares.by_slot.clear();
            shares.add(first, 0.5);
            shares.add(second, 0.5);
            shares.bound = 1.0;
        }
        if let [_, _, ..] = shares.by_slot.as_slice() {
            // Sums and products of a few numbers below 1.
            shares.bound += 8.0 * f64::UNIT;
        }
        // No channel is off by more than all.
        shares.bound = shares.bound.min(1.0);
        shares
    }

    /// The place of an object's board, if it is a checkerboard.
    fn board(&mut self, object: usize) -> Option<usize> {
        let at = match self.boards.iter().position(|(known, _)| *known == object) {
            Some(at) => at,
            None => {
                let mut checkered = Checkered::new(self.world, object, self.spot)?;
                checkered.board.care = self.care;
                let side = self.spot.side;
                checkered.board.leeway = (PIECES * side * side).recip().max(1.0);
                self.boards.push((object, checkered));
                self.boards.len() - 1
            }
        };
        Some(at)
    }
}

impl Checkered {
    /// An object as a spot sees it, if it is a checkerboard; more closely where that is not enough.
    fn new(world: &World, object: usize, spot: SubPixel) -> Option<Self> {
        let of = |seen: tracer::Board| Self {
            board: Board::of(&seen),
            // From which square floors are counted is a matter of roundings, too.
            odd: seen.odd,
            doubt: seen.doubt(),
        };
        let checkered = of(board::board(world, object, spot)?);
        let closely = || board::board_closely(world, object, spot).map(of);
        let better = checkered.board.is_doubtful().then(closely).flatten();
        Some(better.unwrap_or(checkered))
    }
}

impl Shares {
    /// Adds those of a part that is so much of the whole.
    pub fn add_part(&mut self, part: &Self, area: f64) {
        if !self.by_slot.is_empty() {
            // Products and sums that are 1 together.
            self.bound += f64::UNIT;
        }
        for &(slot, share) in &part.by_slot {
            self.add(slot, area * share);
        }
        self.bound += area * part.bound;
        self.of_boards += area * part.of_boards;
        self.is_crowded |= part.is_crowded;
    }

    fn add(&mut self, slot: usize, area: f64) {
        match self.by_slot.iter_mut().find(|(known, _)| *known == slot) {
            Some((_, share)) => *share += area,
            None => self.by_slot.push((slot, area)),
        }
    }
}
