//! Which objects may be met at a point of the view plane: a quadtree over their bounds there.
//!
//! Since all rays share the eye, a ray is a point of the view plane, and lies in one cell of each level alone: the way down has no
//! branches. An object is listed in the cells that it overlaps of the level where it is about as large as they are, four of them at most,
//! so that the lists have no more entries than four times the objects, whatever these look like. Each list begins with what may be
//! nearest and ends, for a ray that met something already, where the rest is behind that.
//!
//! Cells are counted in whole numbers, into which a coordinate's conversion is monotone: what it rounds never separates a point from
//! bounds that hold it by more than one, and bounds are one wider.

mod descent;
mod grid;
mod tree;

use std::cmp::Reverse;

use rayon::ThreadPool;

use self::{
    descent::Descent,
    grid::{Rectangle, Unit},
    tree::Tree,
};
use super::{camera::Direction, cover::Patch};

pub use self::grid::{Grid, Item, Nearness};

/// The objects that may be seen, by where in the view plane they are.
#[derive(Debug)]
pub struct Hierarchy {
    grid: Grid,
    tree: Tree,
}

impl Hierarchy {
    /// A hierarchy over some objects, built by some threads, or by this one alone.
    pub fn new(grid: Grid, items: Vec<Item>, threads: Option<&ThreadPool>) -> Self {
        let tree = match threads {
            Some(threads) => threads.install(|| Tree::of_many(items)),
            None => Tree::of(items),
        };
        Self { grid, tree }
    }

    /// The way down to the objects that a ray may meet; none for a direction outside of the window.
    #[inline]
    pub fn at(&self, r: &Direction<f64>) -> Option<Descent<'_>> {
        Some(Descent::new(&self.tree, self.grid.units(r)?))
    }

    /// What holds all rays through a patch; none outside of the window.
    #[inline]
    pub fn rectangle(&self, patch: &Patch) -> Option<Rectangle> {
        self.grid.rectangle(patch)
    }

    /// Where a direction is; none outside of the window.
    #[inline]
    pub fn unit(&self, r: &Direction<f64>) -> Option<Unit> {
        self.grid.units(r).map(Unit)
    }

    /// The objects that rays through a rectangle may meet, the one that may be nearest first, with bounds of what they are in it.
    pub fn within(&self, rectangle: &Rectangle, out: &mut Vec<Item>) {
        out.clear();
        self.tree.within(rectangle, out);
        out.sort_unstable_by_key(|item| (Reverse(item.nearest), item.object));
        // Those that lie in several cells.
        out.dedup_by(|next, item| {
            let is_same = next.object == item.object;
            if is_same {
                item.bounds = item.bounds.with(&next.bounds);
            }
            is_same
        });
    }

    /// How many bytes it takes.
    #[cfg(test)]
    pub fn bytes(&self) -> usize {
        self.tree.bytes()
    }
}
