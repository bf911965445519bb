//! The regions of a sub-pixel, and what is seen in each.
//!
//! In: regions between boundaries, with a point in each. Out: how much of the sub-pixel each colour
//! has, with a bound. One ray through the point says what is seen; a checkerboard is divided
//! further by `checker` and `conic_segment`. The bound adds what those say, what was said to be in
//! doubt, and by how much the regions together are not the whole sub-pixel.

use glam::DVec2;

use crate::{
    math::{Big, Double, Real},
    tracer::{LOOSE_LINE, Object, Precision, SubPixel, VisibilityCandidate, World, candidates},
};

use super::{
    budget::Budget,
    checker::{Homography, size},
    conic_segment::Arc,
};

/// Units of work of a region: for itself, and for each object that its ray may meet.
const REGION_WORK: f64 = 4.0;
const RAY_WORK: f64 = 0.5;
/// The same for an object that is asked in the last precision.
const BIG_RAY_WORK: f64 = 200.0;

/// How much of a sub-pixel each colour has.
#[derive(Clone, Debug, Default)]
pub struct Shares {
    /// Slots of the palette with the area that shows them, 1 together but for rounding.
    pub by_slot: Vec<(usize, f64)>,
    /// How much area may be with the wrong colour.
    pub bound: f64,
}

/// Collects the regions of one sub-pixel.
pub struct Regions<'a> {
    world: &'a World,
    sub_pixel: SubPixel,
    candidates: &'a [VisibilityCandidate],
    /// The boards that were met so far, by object.
    boards: Vec<(usize, Checkered)>,
    shares: Shares,
    /// What may still be computed of the pixel.
    budget: &'a Budget<'a>,
}

/// A checkerboard as a sub-pixel sees it.
pub struct Checkered {
    pub board: Homography,
    /// Whether the square [0, 1)² has the second colour.
    pub odd: bool,
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
    /// For a sub-pixel in which no other objects are seen than some.
    pub fn new(
        world: &'a World,
        sub_pixel: SubPixel,
        candidates: &'a [VisibilityCandidate],
        budget: &'a Budget<'a>,
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

    /// The bound that is asked for, in area.
    pub fn tolerance(&self) -> f64 {
        self.budget.tolerance
    }

    /// Whether nothing more should be computed.
    pub fn is_given_up(&self) -> bool {
        self.budget.is_spent()
    }

    /// Adds a region in which no boundary lies.
    pub fn add(&mut self, region: &Region) {
        let Some(object) = self.seen(region) else {
            return self.shares.add(self.world.background(), region.area);
        };
        let [first, second] = self.world.slots(object);
        if first == second {
            return self.shares.add(first, region.area);
        }
        let Some(at) = self.board(object) else {
            // Nothing else has two colours.
            self.doubt(region.area);
            return self.shares.add(first, region.area);
        };
        let checkered = &self.boards[at].1;
        let mut sum = checkered.board.over(region.polygon, self.budget);
        for (bulge, arc) in region.arcs {
            let sliver = checkered.board.sliver(arc, self.budget);
            sum.value += bulge * sliver.value;
            sum.bound += sliver.bound;
        }
        let half = if checkered.odd { -0.5 } else { 0.5 } * sum.value;
        // The board's own bound is for forms with a rounding in each factor. Whatever they are, no
        // share is greater than the area.
        let bound = 0.5 * sum.bound * (1.0 + checkered.doubt / f64::UNIT);
        let bound = bound.min(0.5 * region.area + half.abs());
        self.shares.add(first, 0.5 * region.area + half);
        self.shares.add(second, 0.5 * region.area - half);
        self.shares.bound += bound;
    }

    /// The object that is seen in a region. Where double-double leaves it in doubt, so that the
    /// point may lie next to a boundary, all of the region counts as doubtful.
    fn seen(&mut self, region: &Region) -> Option<usize> {
        let (seen, is_sure) = seen(
            self.world,
            self.sub_pixel,
            region.inside,
            self.candidates,
            self.budget,
        );
        if !is_sure {
            self.doubt(region.area);
        }
        seen
    }

    /// Says that so much of the pixel's area may be with a wrong region, or with none.
    pub fn doubt(&mut self, area: f64) {
        self.shares.bound += area;
    }

    /// The shares of all that was added.
    pub fn finish(self) -> Shares {
        let mut shares = self.shares;
        // What the regions leave out of the sub-pixel, or count twice, may have any colour.
        let total: f64 = shares.by_slot.iter().map(|(_, share)| share).sum();
        shares.bound += (1.0 - total).abs();
        if !(shares.bound.is_finite() && total > 0.0 && total < 2.0) {
            // Out of the range of numbers.
            return Shares::unknown(self.world, self.sub_pixel, self.candidates, self.budget);
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
                let checkered = Checkered::new(self.world, object, self.sub_pixel)?;
                self.boards.push((object, checkered));
                self.boards.len() - 1
            }
        };
        Some(at)
    }
}

impl Checkered {
    /// An object as a sub-pixel sees it, if it is a checkerboard.
    pub fn new(world: &World, object: usize, sub_pixel: SubPixel) -> Option<Self> {
        let checkered = Self::in_precision::<Double>(world, object, sub_pixel)?;
        match checkered.doubt < LOOSE_LINE {
            true => Some(checkered),
            false => Self::in_precision::<Big>(world, object, sub_pixel),
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
        let forms = [seen.across[0], seen.across[1], seen.below].into_iter();
        let doubt = forms.zip(seen.rads).fold(0.0, |doubt: f64, (form, rad)| {
            let size = size(&form);
            // Squares may be too small for the range of `f64`.
            match size.is_finite() && size > 0.0 {
                true => doubt.max(rad / size),
                false => f64::INFINITY,
            }
        });
        Some(Self {
            board: Homography::new(seen.across, seen.below),
            odd: seen.odd,
            doubt,
        })
    }
}

/// The object that is seen at a point of a sub-pixel, and whether double-double is certain of it.
/// None where the budget has nothing left for the last precision, which it may take.
fn seen(
    world: &World,
    sub_pixel: SubPixel,
    at: DVec2,
    candidates: &[VisibilityCandidate],
    budget: &Budget,
) -> (Option<usize>, bool) {
    let count = candidates.len() as f64;
    budget.charge(REGION_WORK + RAY_WORK * count);
    if !budget.affords(BIG_RAY_WORK * count) {
        return (None, false);
    }
    let wanted = candidates.iter().take_while(|_| !budget.is_cancelled());
    let (seen, is_sure) = candidates::object_at(world, sub_pixel, at, wanted);
    if !is_sure {
        budget.charge(BIG_RAY_WORK * count);
    }
    (seen, is_sure)
}

impl Shares {
    /// Of a sub-pixel of which nothing is known but what is in its middle.
    pub fn unknown(
        world: &World,
        sub_pixel: SubPixel,
        candidates: &[VisibilityCandidate],
        budget: &Budget,
    ) -> Self {
        let (seen, _) = seen(world, sub_pixel, DVec2::ZERO, candidates, budget);
        let [first, second] = seen.map_or([world.background(); 2], |object| world.slots(object));
        Self {
            by_slot: vec![(first, 0.5), (second, 0.5)],
            bound: 1.0,
        }
    }

    /// Adds those of a part that is so much of the whole.
    pub fn add_part(&mut self, part: &Self, area: f64) {
        for &(slot, share) in &part.by_slot {
            self.add(slot, area * share);
        }
        self.bound += area * part.bound;
    }

    fn add(&mut self, slot: usize, area: f64) {
        match self.by_slot.iter_mut().find(|(known, _)| *known == slot) {
            Some((_, share)) => {
                *share += area;
                // The rounding of a sum that is no greater than 1.
                self.bound += f64::UNIT;
            }
            None => self.by_slot.push((slot, area)),
        }
    }
}
