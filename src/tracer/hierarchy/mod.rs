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
mod search;
mod tree;

use std::sync::atomic::AtomicBool;

use self::{grid::Rectangle, search::Search, tree::Tree};
use super::{camera::Direction, cover::Patch};
use crate::threads::Threads;

pub use self::descent::Descent;
pub use self::grid::{Grid, Item, Nearness};

/// The objects that may be seen, by where in the view plane they are.
#[derive(Debug)]
pub struct Hierarchy {
    grid: Grid,
    tree: Tree,
}

impl Hierarchy {
    /// A hierarchy over some objects, built by some threads, or by this one alone. Cancelled, it lacks some of them.
    pub fn new(
        grid: Grid,
        items: Vec<Item>,
        threads: Option<&Threads>,
        cancel: &AtomicBool,
    ) -> Self {
        let tree = match threads {
            Some(threads) => threads.install(|| Tree::of_many(items, cancel)),
            None => Tree::of(items, cancel),
        };
        Self { grid, tree }
    }

    /// The way down to the objects that a ray may meet; none for a direction outside of the window.
    #[inline]
    pub fn at(&self, r: &Direction<f64>) -> Option<Descent<'_>> {
        Some(Descent::new(&self.tree, self.grid.units(r)?))
    }

    /// Where a direction lies in the units of bounds; none outside of the window.
    #[inline]
    pub fn units(&self, r: &Direction<f64>) -> Option<[u32; 2]> {
        self.grid.units(r)
    }

    /// What holds all rays through a patch; none outside of the window.
    #[inline]
    pub fn rectangle(&self, patch: &Patch) -> Option<Rectangle> {
        self.grid.rectangle(patch)
    }

    /// The objects that rays through a rectangle may meet, the one that may be nearest first, with bounds of what they are in it. Left out are
    /// those that one hides which fills the rectangle: `behind` tells what is not nearer than one that may. Whether that is so: if they seem to
    /// be more than `most`, it is not, and they are neither all of them nor in order.
    #[must_use]
    pub fn within(
        &self,
        rectangle: &Rectangle,
        most: usize,
        behind: impl FnMut(u32) -> Nearness,
        out: &mut Vec<Item>,
    ) -> bool {
        Search::new(&self.tree, rectangle, most, behind, out).run()
    }

    /// How many bytes it takes.
    #[cfg(test)]
    pub fn bytes(&self) -> usize {
        self.tree.bytes()
    }
}
