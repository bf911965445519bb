//! What may be seen in a part of the picture: the objects that are not certain to be missed or hidden there, and which of them is seen at
//! a point.

use std::cmp::Ordering;

use glam::DVec2;

use crate::{
    area::Area,
    math::{Big, Double, Doubt},
};

use super::{
    cover::{Patch, Range},
    crossing::Crossing,
    curve::{Crossings, Place, Surface},
    hierarchy::Nearness,
    object::Object,
    world::{Level, World},
};

/// An object that may be seen in a part of the picture.
#[derive(Clone, Copy, Debug)]
pub struct Live {
    /// Its index in the file.
    pub object: usize,
    /// Whether every ray through the part meets it, between the near and the far plane.
    pub is_whole: bool,
    /// Holds the inverse depths of what may be seen of it.
    pub(super) inverse_depth: Range,
    /// Where it may be seen: not only where rays meet it first if the near plane may cut it there.
    pub(super) crossings: Crossings,
}

impl Live {
    /// Whether the near plane may cut it.
    pub(super) fn is_cut(&self) -> bool {
        self.crossings != Crossings::First
    }
}

/// A pixel, or a square part of one. Its own coordinates (x, y) are in units of its side from its centre, x to the right and y
/// down.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// The pixel's column.
    pub x: u32,
    /// The pixel's row.
    pub y: u32,
    /// Its centre, as an offset from the pixel's.
    center: DVec2,
    /// Its side, in pixels: a power of two.
    pub side: f64,
}

impl Spot {
    /// A whole pixel.
    pub fn pixel(x: u32, y: u32) -> Self {
        Self {
            x,
            y,
            center: DVec2::ZERO,
            side: 1.0,
        }
    }

    /// Its four quarters.
    pub fn quarters(self) -> [Self; 4] {
        [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)].map(|(x, y)| Self {
            center: self.offset(DVec2::new(x, y)),
            side: 0.5 * self.side,
            ..self
        })
    }

    /// A point of it as an offset from the pixel's centre.
    pub(super) fn offset(&self, at: DVec2) -> DVec2 {
        self.center + at * self.side
    }
}

/// A checkerboard in a spot: the point (x, y) shows the board's point (N₀/ℓ, N₁/ℓ), in squares from
/// a corner of squares near to the spot, where ℓ > 0.
#[derive(Clone, Copy, Debug)]
pub struct Board {
    /// The factors of x, y and 1 in N₀ and N₁.
    pub across: [[f64; 3]; 2],
    /// Those of ℓ.
    pub below: [f64; 3],
    /// What their rounding has left of these factors: of N₀, N₁ and ℓ.
    pub low: [[f64; 3]; 3],
    /// How far a value of each of these forms may be from the true one, but for the rounding of the factors.
    pub rads: [f64; 3],
    /// Whether the square [0, 1)² has the second colour.
    pub odd: bool,
}

/// As many objects as lie above each other in pictures that people make. Of more it takes too long to compare each two: only the nearest is compared
/// with the others.
const LAYERS: usize = 8;

/// Heights of checkerboards above or below the eye that differ by this factor are in this order, whatever their rounding.
const APART: f64 = 1.0 + 1e-12;

/// The error of a line's form from which on double-double was not enough.
pub(super) const LOOSE_LINE: f64 = 8.0 / (1u64 << 53) as f64;

impl World {
    /// All objects, as candidates for any part of the picture.
    pub fn everything(&self) -> Vec<Live> {
        let live = |object| Live {
            object,
            is_whole: false,
            inverse_depth: Range::ALL,
            crossings: match self.fast.near {
                Some(_) => Crossings::Both,
                None => Crossings::First,
            },
        };
        (0..self.len()).map(live).collect()
    }

    /// Of some candidates, in file order, those that may be seen in a part of the picture.
    pub fn live(&self, part: Area, among: &[Live], out: &mut Vec<Live>) {
        let patch = Patch::new(&self.fast.camera, part);
        self.live_among(&patch, among.iter().map(|live| live.object), out);
    }

    /// The same in a spot.
    pub fn live_in(&self, spot: Spot, among: &[Live], out: &mut Vec<Live>) {
        let patch = Patch::of_spot(&self.fast.camera, spot);
        self.live_among(&patch, among.iter().map(|live| live.object), out);
        if out.len() > LAYERS {
            self.drop_behind_middle(spot, &patch, out);
        }
    }

    /// All that may be seen in a part of the picture; whether that is so: of more than `most` it is not known.
    #[must_use]
    pub fn live_of(&self, part: Area, most: usize, out: &mut Vec<Live>) -> bool {
        let patch = Patch::new(&self.fast.camera, part);
        let [near, far] = self.clips_over(&patch);
        let behind = |object: u32| match self.cover(object as usize, &patch, near, far) {
            Some(live) if live.is_whole => Nearness::below(live.inverse_depth.low),
            _ => Nearness::NONE,
        };
        let Some(objects) = self.hierarchy.within(&patch, most, behind) else {
            return false;
        };
        self.live_among(&patch, objects.iter().map(|&object| object as usize), out);
        true
    }

    /// The inverse depths of the near and the far plane over a patch, where there are any.
    pub(super) fn clips_over(&self, patch: &Patch) -> [Option<Range>; 2] {
        [&self.fast.near, &self.fast.far].map(|clip| Some(clip.as_ref()?.over(patch).or_all()))
    }

    fn live_among(&self, patch: &Patch, among: impl Iterator<Item = usize>, out: &mut Vec<Live>) {
        out.clear();
        let [near, far] = self.clips_over(patch);
        // The nearest of what is met everywhere hides what is farther.
        let mut hidden = f64::NEG_INFINITY;
        for candidate in among {
            let Some(live) = self.cover(candidate, patch, near, far) else {
                continue;
            };
            if live.inverse_depth.high < hidden {
                continue;
            }
            if live.is_whole {
                hidden = hidden.max(live.inverse_depth.low);
            }
            out.push(live);
        }
        out.retain(|live| live.inverse_depth.high >= hidden);
        if out.len() > 1 {
            self.drop_covered(patch, out);
        }
    }

    /// The object in a part of the picture, if it may be seen there.
    pub(super) fn cover(
        &self,
        index: usize,
        patch: &Patch,
        near: Option<Range>,
        far: Option<Range>,
    ) -> Option<Live> {
        let object = f64::object(self, index);
        let cover = object.cover(patch)?;
        let mut live = Live {
            object: index,
            is_whole: cover.is_whole,
            inverse_depth: cover.inverse_depth.or_all(),
            crossings: Crossings::First,
        };
        if let Some(near) = near
            && live.inverse_depth.high >= near.low
        {
            let behind = match object.behind(patch) {
                Some(behind) => behind.or_all(),
                // It has but one surface, which the near plane takes away as a whole or in part.
                None if live.inverse_depth.low > near.high => return None,
                None => live.inverse_depth,
            };
            if behind.low > near.high {
                return None;
            }
            if live.inverse_depth.low > near.high {
                live.crossings = Crossings::Second;
                live.inverse_depth = behind;
                live.is_whole &= behind.high < near.low;
            } else {
                live.crossings = Crossings::Both;
                live.inverse_depth.low = live.inverse_depth.low.min(behind.low);
                live.is_whole = false;
            }
        }
        if let Some(far) = far {
            if live.inverse_depth.high < far.low {
                return None;
            }
            live.is_whole &= live.inverse_depth.low > far.high;
        }
        Some(live)
    }

    /// Removes flat objects that lie behind another flat one all over the patch, though their depths there overlap, or in
    /// the same plane as one that comes before them in the file.
    fn drop_covered(&self, patch: &Patch, live: &mut Vec<Live>) {
        let drop_behind = |front: usize, live: &mut Vec<Live>| {
            live.retain(|back| {
                back.object == front || back.is_cut() || !self.covers(front, back.object, patch)
            });
        };
        let may_cover = |live: &&Live| live.is_whole && !live.is_cut();
        if live.len() > LAYERS {
            self.drop_boards_behind(live);
            // Of layers the nearest one hides all others; in one plane that is the first.
            let is_flat =
                |live: &&Live| !matches!(*f64::object(self, live.object), Object::Sphere(_));
            let fronts = live.iter().filter(may_cover).filter(is_flat);
            let nearest = fronts.max_by(|a, b| {
                let nearer = a.inverse_depth.low.total_cmp(&b.inverse_depth.low);
                nearer.then(b.object.cmp(&a.object))
            });
            if let Some(front) = nearest.map(|live| live.object) {
                drop_behind(front, live);
            }
        }
        if live.len() <= LAYERS {
            for front in live.clone().iter().filter(may_cover) {
                drop_behind(front.object, live);
            }
        }
    }

    /// Removes checkerboards that lie behind another one, above or below the eye: whatever ray meets them meets that one, too, and nearer, also
    /// where the horizon crosses the patch.
    fn drop_boards_behind(&self, live: &mut Vec<Live>) {
        for is_above in [false, true] {
            let height = |live: &Live| {
                // Numbers of the scene lie farther away in memory than what is prepared of them.
                let is_board = matches!(*f64::object(self, live.object), Object::Checkerboard(_));
                let height = is_board.then(|| self.board_height(live.object))??;
                ((height > 0.0) == is_above).then_some(height.abs())
            };
            let fronts = live.iter().filter(|live| !live.is_cut());
            let fronts = fronts.filter_map(|live| Some((height(live)?, live.object)));
            let nearest = fronts.min_by(|(a, i), (b, j)| a.total_cmp(b).then(i.cmp(j)));
            let Some((nearest, front)) = nearest else {
                continue;
            };
            live.retain(|back| match height(back) {
                // Heights that are hardly apart may be rounded otherwise, or be one.
                Some(height) => back.object == front || back.is_cut() || height <= nearest * APART,
                None => true,
            });
        }
    }

    /// Removes objects that lie all over a spot behind the one that is seen in its middle, if every ray through the spot meets that.
    fn drop_behind_middle(&self, spot: Spot, patch: &Patch, live: &mut Vec<Live>) {
        let (Some(middle), _) = self.object_at(spot, DVec2::ZERO, live) else {
            return;
        };
        let front = live.iter().find(|live| live.object == middle).copied();
        let Some(front) = front.filter(|front| front.is_whole) else {
            return;
        };
        let offset = spot.offset(DVec2::ZERO);
        let r = self
            .fast
            .camera
            .direction(&self.fast.camera.sample_point(spot.x, spot.y, offset));
        let is_met = |back: &Live| {
            let object = f64::object(self, back.object);
            let first = || object.first(&r).ok().flatten();
            let is_beyond_near = |crossing: Crossing<f64>| match &self.fast.near {
                Some(near) => crossing.inverse_depth.compare(&near.at(&r)) == Ok(Ordering::Less),
                None => true,
            };
            match back.crossings {
                Crossings::First => first().is_some(),
                Crossings::Both => first().is_some_and(is_beyond_near),
                Crossings::Second => first().and(object.second(&r)).is_some_and(is_beyond_near),
            }
        };
        live.retain(|back| {
            let are_uncut = !front.is_cut() && !back.is_cut();
            back.object == middle
                || !(are_uncut && self.covers(middle, back.object, patch)
                    // What is met there is behind it there; and so it is wherever it is met, which is in one piece, as it is convex.
                    || is_met(back) && !self.may_cross(spot, front, *back))
        });
    }

    /// Whether an object that every ray through a patch meets hides another there by the forms of their planes.
    fn covers(&self, front: usize, back: usize, patch: &Patch) -> bool {
        let ahead = |a: &Surface<f64>, i: usize, b: &Surface<f64>, j: usize| {
            let (Surface::Plane(a), Surface::Plane(b)) = (a, b) else {
                return false;
            };
            if a.minus(b).over(patch).low > 0.0 {
                return true;
            }
            // Only planes that are equal in `f64` can be one.
            front < back && a.equals(b) && {
                let part = |object, at| (object, f64::object(self, object).first_part(at));
                self.is_one_plane(part(front, i), part(back, j))
            }
        };
        let (a, b) = (f64::object(self, front), f64::object(self, back));
        let (planes_a, planes_b) = (a.surfaces(Crossings::First), b.surfaces(Crossings::First));
        let mut pairs = planes_b.iter().enumerate().map(|(j, b)| {
            let mut fronts = planes_a.iter().enumerate();
            match a.is_seen_from_inside() {
                true => fronts.any(|(i, a)| ahead(a, i, b, j)),
                false => fronts.all(|(i, a)| ahead(a, i, b, j)),
            }
        });
        match b.is_seen_from_inside() {
            true => pairs.all(|covered| covered),
            false => pairs.any(|covered| covered),
        }
    }

    /// The object that is seen at a point of a spot, of some that may be; and whether the last precision was not asked, in which what it does
    /// not tell apart counts as equal.
    pub fn object_at(&self, spot: Spot, at: DVec2, live: &[Live]) -> (Option<usize>, bool) {
        let offset = spot.offset(at);
        let point = self.fast.camera.sample_point(spot.x, spot.y, offset);
        let among = || live.iter().map(|live| live.object);
        let fast = self.nearest(&f64::frame(self).camera.direction(&point), among());
        let seen = fast.or_else(|Doubt| {
            let r = Double::frame(self).camera.direction(&point);
            self.nearest(&r, among())
        });
        let is_sure = seen.is_ok();
        let seen = seen.or_else(|Doubt| {
            let r = Big::frame(self).camera.direction(&point);
            self.nearest(&r, among())
        });
        // The last precision is never in doubt.
        let object = seen.unwrap_or_default().map(|(object, _)| object);
        (object, is_sure)
    }

    /// An object's squares in a spot, if it is a checkerboard.
    pub fn board(&self, object: usize, spot: Spot) -> Option<Board> {
        let board = self.board_in::<Double>(object, spot)?;
        match board.doubt() < LOOSE_LINE {
            true => Some(board),
            false => self.board_in::<Big>(object, spot),
        }
    }

    /// The same where more than one rounding of the factors matters.
    pub fn board_closely(&self, object: usize, spot: Spot) -> Option<Board> {
        self.board_in::<Big>(object, spot)
    }

    fn board_in<T: Level>(&self, object: usize, spot: Spot) -> Option<Board> {
        let object = T::object(self, object);
        let Object::Checkerboard(board) = &*object else {
            return None;
        };
        let place = Place::new(&T::frame(self).camera, spot);
        let [a, b] = &board.across;
        let (lines, is_moved) = place.together([a, b], &board.below);
        let rads = lines.each_ref().map(|line| line.rad);
        let factors = lines.map(|line| line.factors);
        let [a, b, below] = factors.map(|factors| factors.map(|c| c.hi));
        Some(Board {
            low: factors.map(|factors| factors.map(|c| c.lo)),
            across: [a, b],
            below,
            rads,
            odd: board.odd ^ is_moved,
        })
    }
}

impl Board {
    /// How far the value of a form may be from the true one, by the size of its terms; infinite where squares are too small for the range of
    /// `f64`.
    pub fn doubt(&self) -> f64 {
        let [a, b] = &self.across;
        let forms = [a, b, &self.below].into_iter().zip(self.rads);
        forms.fold(0.0, |doubt, ([x, y, z], rad)| {
            let size = 0.5 * (x.abs() + y.abs()) + z.abs();
            match size.is_finite() && size > 0.0 {
                true => doubt.max(rad / size),
                false => f64::INFINITY,
            }
        })
    }
}
