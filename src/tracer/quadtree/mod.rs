//! Which objects may be met at a point of the view plane: a quadtree over their bounds there.
//!
//! Since all rays share the eye, a ray is a point of the view plane, and lies in one cell of each
//! level alone: the way down has no branches. An object is listed in the cells that it overlaps of
//! the level where it is about as large as they are, four of them at most, so that the lists have
//! no more entries than four times the objects, whatever these look like. Each list begins with
//! what may be nearest and ends, for a ray that met something already, where the rest is behind
//! that.
//!
//! Cells are counted in whole numbers, into which a coordinate's conversion is monotone: what it
//! rounds never separates a point from bounds that hold it by more than one, and bounds are one
//! wider.

mod grid;
mod point_query;
mod rectangle_query;
mod tree;

use std::{cmp::Reverse, sync::atomic::AtomicBool};

use self::{point_query::visit_list, rectangle_query::Search, tree::Tree};
use super::{camera::Direction, local_form::Patch};

pub use self::grid::{Grid, Item, Nearness, Rectangle};
pub use self::tree::OBJECTS_A_CELL;

/// The objects that may be seen, by where in the view plane they are.
#[derive(Debug)]
pub struct Quadtree {
    grid: Grid,
    tree: Tree,
}

impl Quadtree {
    /// A quadtree over some objects. Cancelled, it lacks some of them.
    pub fn new(grid: Grid, items: Vec<Item>, cancel: &AtomicBool) -> Self {
        let tree = Tree::new(items, cancel);
        Self { grid, tree }
    }

    /// Shows `visit` the objects that a ray may meet, the largest first, until it fails, but for
    /// those that are not nearer than it last answered; none for a direction outside of the
    /// window.
    #[inline]
    pub fn visit<E>(
        &self,
        r: &Direction<f64>,
        visit: impl FnMut(usize) -> Result<Nearness, E>,
    ) -> Option<Result<(), E>> {
        Some(self.tree.visit(self.grid.units(r)?, visit))
    }

    /// The objects that rays through a patch may meet, in file order, but for those that one hides
    /// which fills the patch: `behind` tells what is not nearer than one that may. None if they
    /// seem to be more than `most`.
    pub fn within(
        &self,
        patch: &Patch,
        most: usize,
        behind: impl FnMut(u32) -> Nearness,
    ) -> Option<Vec<Item>> {
        match self.rectangle(patch) {
            Some(rectangle) => Search::new(&self.tree, &rectangle, most, behind).run(),
            None => Some(Vec::new()),
        }
    }

    /// The objects that rays through a patch may meet, the nearest first; none if they seem to be
    /// more than a cell lists.
    pub fn nearby(&self, patch: &Patch) -> Option<Vec<Item>> {
        let mut items = self.within(patch, OBJECTS_A_CELL, |_| Nearness::NONE)?;
        items.sort_by_key(|item| Reverse(item.nearest));
        Some(items)
    }

    /// What [`visit`](Self::visit) does, for a ray through a patch of which these are the objects
    /// nearby.
    #[inline]
    pub fn visit_nearby<E>(
        &self,
        r: &Direction<f64>,
        nearby: &[Item],
        mut visit: impl FnMut(usize) -> Result<Nearness, E>,
    ) -> Option<Result<(), E>> {
        let at = self.grid.units(r)?;
        Some(visit_list(nearby, at, &mut { Nearness::NONE }, &mut visit))
    }

    /// What holds all rays through a patch; `None` outside of the window.
    #[inline]
    pub fn rectangle(&self, patch: &Patch) -> Option<Rectangle> {
        self.grid.rectangle(patch)
    }
}
