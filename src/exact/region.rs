//! The regions of a sub-pixel (a pixel or a square part of one), and what is seen in each.
//!
//! In: regions between boundaries, with a point inside each. Out: the fraction of the sub-pixel's
//! area that shows each colour, with an error bound. One ray through the point decides which object
//! is seen in the region; a checkerboard is then integrated by `checker` and `conic_segment`. The
//! error bound is the sum of three terms: the bounds of the integrals; the areas whose colour is
//! uncertain (`Regions::add_doubtful_area`); and the difference between the regions' total area and
//! the sub-pixel's area.

use std::mem;

use glam::DVec2;

use crate::{
    math::{Big, Double, Real},
    tracer::{LOOSE_LINE, Object, Precision, SubPixel, VisibilityCandidate, World, candidates},
};

use super::{
    budget::PixelBudget,
    checker::{BoundedSum, Homography, size},
    clip::PIXEL,
    conic_segment::Arc,
};

/// Work charged to the pixel's budget per region, in units of about 50 ns. A rough value is enough,
/// because the budget only stops computations that take too long.
const REGION_WORK: f64 = 4.0;
/// Work charged to the pixel's budget per candidate object that a region's ray may hit, in units of
/// about 50 ns. A rough value is enough, because the budget only stops computations that take too
/// long.
const RAY_WORK: f64 = 0.5;
/// Work charged to the pixel's budget per candidate object that a region's ray may hit, in units of
/// about 50 ns. It is charged only if the highest precision ([`Big`]) has to decide what the ray
/// hits. Each object then takes hundreds of times as long.
const BIG_RAY_WORK: f64 = 200.0;

/// Fractions of the area of a pixel or sub-pixel that show each colour.
#[derive(Clone, Debug, Default)]
pub struct Shares {
    /// Indices into the world's palette, each with the fraction of the sub-pixel's area that shows
    /// its colour. The fractions add up to 1 except for rounding.
    pub by_slot: Vec<(usize, f64)>,
    /// Maximum fraction of the sub-pixel's area that may have the wrong colour.
    pub bound: f64,
}

/// Sums of the fractions of a sub-pixel's area that show each colour, to which the regions of the
/// sub-pixel are added one by one.
pub struct Regions<'a> {
    world: &'a World,
    sub_pixel: SubPixel,
    candidates: &'a [VisibilityCandidate],
    /// Checkerboards that regions have shown so far, each with the index of its object.
    boards: Vec<(usize, LocalBoard)>,
    shares: Shares,
    /// Work that may still be spent on the pixel.
    pub budget: &'a PixelBudget<'a>,
}

/// A checkerboard in the coordinates of a sub-pixel.
pub struct LocalBoard {
    pub board: Homography,
    /// Whether the square 0 ≤ a < 1, 0 ≤ b < 1 has the second colour. Here, a and b are the
    /// coordinates on the board, as computed by `board`.
    pub odd: bool,
    /// Maximum error of a value of one of the board's linear forms c0·x + c1·y + c2, divided by the
    /// maximum of |c0·x| + |c1·y| + |c2| in the sub-pixel.
    relative_error: f64,
}

/// A region: a polygon, with arcs over some of its sides.
pub struct Region<'a> {
    /// Vertices of the polygon, which is convex, in order.
    pub polygon: &'a [DVec2],
    /// Arcs over sides of the polygon, each with 1 if it bulges out of the polygon or −1 if it
    /// bulges into it.
    pub arcs: &'a [(f64, Arc)],
    /// Area, in square pixels.
    pub area: f64,
    /// A point inside the region.
    pub inside: DVec2,
}

impl Region<'static> {
    /// The whole sub-pixel.
    pub const PIXEL: Self = Self {
        polygon: &PIXEL,
        arcs: &[],
        area: 1.0,
        inside: DVec2::ZERO,
    };
}

impl<'a> Regions<'a> {
    /// Starts the sum of the colours' shares for a sub-pixel. `candidates` are the objects that may
    /// be seen in it.
    pub fn new(
        world: &'a World,
        sub_pixel: SubPixel,
        candidates: &'a [VisibilityCandidate],
        budget: &'a PixelBudget<'a>,
    ) -> Self {
        Self {
            world,
            sub_pixel,
            candidates,
            boards: Vec::new(),
            shares: Shares::default(),
            budget,
        }
    }

    /// Adds the area of a region to the share of its colour, or divides it between the two colours
    /// of a checkerboard. No boundary may cross the region.
    pub fn add(&mut self, region: &Region) {
        let Some(object) = self.seen(region) else {
            return self.shares.add(self.world.background(), region.area);
        };
        let [first, second] = self.world.color_indices(object);
        if first == second {
            return self.shares.add(first, region.area);
        }
        let Some(at) = self.board(object) else {
            // This is unreachable: only checkerboards have two colours.
            self.add_doubtful_area(region.area);
            return self.shares.add(first, region.area);
        };
        let sum = self.boards[at].1.sum(region, self.budget);
        let half = 0.5 * sum.value;
        // The true share of a colour lies between 0 and the region's area. The error of a computed
        // share is therefore at most the larger of the two computed shares.
        let bound = (0.5 * sum.bound).min(0.5 * region.area + half.abs());
        self.shares.add(first, 0.5 * region.area + half);
        self.shares.add(second, 0.5 * region.area - half);
        self.shares.bound += bound;
    }

    /// Returns the object that is seen in a region, or `None` for the background. One ray through a
    /// point of the region decides. If double-double arithmetic does not decide with certainty, the
    /// point may lie next to a boundary, and the region's area is added to the error bound.
    fn seen(&mut self, region: &Region) -> Option<usize> {
        let (object, is_certain) = self.object_at(region.inside);
        if !is_certain {
            self.add_doubtful_area(region.area);
        }
        object
    }

    /// Returns the object that is seen at a point (`None` for the background), and whether
    /// double-double arithmetic decides this with certainty. If not, the highest precision decides.
    /// Returns `None` and `false` if too little of the budget is left for the highest precision.
    fn object_at(&self, at: DVec2) -> (Option<usize>, bool) {
        let (budget, count) = (self.budget, self.candidates.len() as f64);
        budget.charge(REGION_WORK + RAY_WORK * count);
        if !budget.affords(BIG_RAY_WORK * count) {
            return (None, false);
        }
        let wanted = self
            .candidates
            .iter()
            .take_while(|_| !budget.is_cancelled());
        let found = candidates::object_at(self.world, self.sub_pixel, at, wanted);
        if !found.1 {
            budget.charge(BIG_RAY_WORK * count);
        }
        found
    }

    /// Adds to the error bound an area whose colour is uncertain. `area` is a fraction of the
    /// sub-pixel's area.
    pub fn add_doubtful_area(&mut self, area: f64) {
        self.shares.bound += area;
    }

    /// Returns the shares of the colours in all regions, with a bound of at most 1.
    pub fn finish(mut self) -> Shares {
        let mut shares = mem::take(&mut self.shares);
        // Area that the regions omit or cover twice may have any colour, so it is added to the
        // error bound.
        let total: f64 = shares.by_slot.iter().map(|(_, share)| share).sum();
        shares.bound += (1.0 - total).abs();
        if !(shares.bound.is_finite() && total > 0.0 && total < 2.0) {
            // The bound is infinite or NaN, or the total is far from 1, only if intermediate
            // results have overflowed. The shares are then meaningless.
            return self.unknown();
        }
        // Channels lie between 0 and 1, so a channel of the pixel's mean colour cannot have an
        // error above 1.
        shares.bound = shares.bound.min(1.0);
        shares
    }

    /// Returns shares with the bound 1, for a sub-pixel that is not computed. The whole area is
    /// given to the object that is seen in the middle of the sub-pixel. If this object has two
    /// colours, each gets half of the area.
    pub fn unknown(&self) -> Shares {
        let (object, _) = self.object_at(DVec2::ZERO);
        let background = [self.world.background(); 2];
        let [first, second] = object.map_or(background, |object| self.world.color_indices(object));
        Shares {
            by_slot: vec![(first, 0.5), (second, 0.5)],
            bound: 1.0,
        }
    }

    /// Returns the index in `boards` of the board of `object`, and derives the board on first use.
    /// Returns `None` if the object is not a checkerboard.
    fn board(&mut self, object: usize) -> Option<usize> {
        let known = self.boards.iter().position(|(known, _)| *known == object);
        if known.is_some() {
            return known;
        }
        let local_board = LocalBoard::new(self.world, object, self.sub_pixel)?;
        self.boards.push((object, local_board));
        Some(self.boards.len() - 1)
    }
}

impl LocalBoard {
    /// Derives the board of `object` in the coordinates of the sub-pixel. Computes it in the
    /// highest precision if the double-double error is too large. Returns `None` if the object is
    /// not a checkerboard.
    pub fn new(world: &World, object: usize, sub_pixel: SubPixel) -> Option<Self> {
        let local_board = Self::in_precision::<Double>(world, object, sub_pixel)?;
        if local_board.relative_error < LOOSE_LINE {
            return Some(local_board);
        }
        Self::in_precision::<Big>(world, object, sub_pixel)
    }

    /// Integrates the board's sign over a region that shows only this board: the area of the first
    /// colour minus that of the second.
    pub fn sum(&self, region: &Region, budget: &PixelBudget) -> BoundedSum {
        let mut sum = self.board.over(region.polygon, budget);
        for (bulge, arc) in region.arcs {
            let segment = self.board.over_segment(arc, budget);
            sum.value += bulge * segment.value;
            sum.bound += segment.bound;
        }
        BoundedSum {
            value: if self.odd { -sum.value } else { sum.value },
            // `sum.bound` assumes that each factor of the board's forms has a relative error of
            // `UNIT`. The actual error, `relative_error`, may be many times as large, so the bound
            // is multiplied by 1 plus the ratio of the two errors.
            bound: sum.bound * (1.0 + self.relative_error / f64::UNIT),
        }
    }

    fn in_precision<T: Precision>(
        world: &World,
        object: usize,
        sub_pixel: SubPixel,
    ) -> Option<Self> {
        let Object::Checkerboard(board) = &*T::object(&world.geometry, object) else {
            return None;
        };
        let camera = &T::frame(&world.geometry).camera;
        let side = camera.pitch.times(&T::from_f64(sub_pixel.side));
        let seen = board.local(&sub_pixel.middle(camera), &[side.clone(), side]);
        let forms = [seen.numerators[0], seen.numerators[1], seen.denominator].into_iter();
        let errors = forms.zip(seen.rads).map(|(form, rad)| {
            // If squares are extremely small, the factors of the forms may overflow or underflow in
            // `f64`. The error is then infinite.
            let size = size(&form);
            let is_known = size.is_finite() && size > 0.0;
            if is_known { rad / size } else { f64::INFINITY }
        });
        Some(Self {
            board: Homography::new(seen.numerators, seen.denominator),
            odd: seen.odd,
            relative_error: errors.fold(0.0, f64::max),
        })
    }
}

impl Shares {
    /// Adds the shares of `part`, a part of this pixel or sub-pixel. `area` is the part's area as a
    /// fraction of the whole.
    pub fn add_part(&mut self, part: &Self, area: f64) {
        for &(color_index, share) in &part.by_slot {
            self.add(color_index, area * share);
        }
        self.bound += area * part.bound;
    }

    fn add(&mut self, color_index: usize, area: f64) {
        match self
            .by_slot
            .iter_mut()
            .find(|(known, _)| *known == color_index)
        {
            Some((_, share)) => {
                *share += area;
                // The sum of two shares of a colour is at most 1, so that its rounding error is at
                // most a unit roundoff.
                self.bound += f64::UNIT;
            }
            None => self.by_slot.push((color_index, area)),
        }
    }
}
