//! The objects that may be met at a point of the view plane: a quadtree over their bounds there.
//!
//! All rays share the eye, so a ray is a point of the view plane and lies in exactly one cell of
//! each level: the way down has no branches. An object is listed in the cells that it overlaps on
//! the level where cells are about as large as itself. They are four at most, so that the lists
//! have at most four entries per object, whatever the objects look like. Each list is sorted by
//! nearness; a ray that has met something stops where the rest of the list lies behind it.
//!
//! Cells are counted in whole numbers, and the conversion of coordinates is monotone: its rounding
//! never separates a point from bounds that contain it by more than one unit, and bounds are one
//! unit wider.

mod grid;
mod point_query;
mod rectangle_query;
mod tree;

use std::{cmp::Reverse, sync::atomic::AtomicBool};

use self::{point_query::visit_list, rectangle_query::Search, tree::Cells};
use super::{camera::Direction, local_form::Patch};

pub use self::grid::{BoundedObject, CellGrid, Nearness, Rectangle};
pub use self::tree::OBJECTS_A_CELL;

/// The visible objects, by their bounds in the view plane.
#[derive(Debug)]
pub struct Quadtree {
    grid: CellGrid,
    tree: Cells,
}

impl Quadtree {
    /// Builds a quadtree over some objects. If it is cancelled, some of them are missing.
    pub fn new(grid: CellGrid, items: Vec<BoundedObject>, cancel: &AtomicBool) -> Self {
        let tree = Cells::new(items, cancel);
        Self { grid, tree }
    }

    /// Calls `visit` with the objects that a ray may meet, the largest first, until it fails.
    /// Objects that are not nearer than its last answer are skipped. Returns `None` for a direction
    /// outside of the window.
    #[inline]
    pub fn visit<E>(
        &self,
        r: &Direction<f64>,
        visit: impl FnMut(usize) -> Result<Nearness, E>,
    ) -> Option<Result<(), E>> {
        Some(self.tree.visit(self.grid.units(r)?, visit))
    }

    /// Finds the objects that rays through a patch may meet, in file order, except those hidden by
    /// an object that fills the patch: `behind` returns the nearness at and below which an object
    /// hides the rest. Returns `None` if there seem to be more than `most`.
    pub fn within(
        &self,
        patch: &Patch,
        most: usize,
        behind: impl FnMut(u32) -> Nearness,
    ) -> Option<Vec<BoundedObject>> {
        match self.rectangle(patch) {
            Some(rectangle) => Search::new(&self.tree, &rectangle, most, behind).run(),
            None => Some(Vec::new()),
        }
    }

    /// Finds the objects that rays through a patch may meet, the nearest first. Returns `None` if
    /// there seem to be more than a cell lists.
    pub fn nearby(&self, patch: &Patch) -> Option<Vec<BoundedObject>> {
        let mut items = self.within(patch, OBJECTS_A_CELL, |_| Nearness::NONE)?;
        items.sort_by_key(|item| Reverse(item.nearest));
        Some(items)
    }

    /// Visits objects as [`visit`](Self::visit) does, for a ray through a patch whose objects were
    /// found by [`nearby`](Self::nearby).
    #[inline]
    pub fn visit_nearby<E>(
        &self,
        r: &Direction<f64>,
        nearby: &[BoundedObject],
        mut visit: impl FnMut(usize) -> Result<Nearness, E>,
    ) -> Option<Result<(), E>> {
        let at = self.grid.units(r)?;
        Some(visit_list(nearby, at, &mut { Nearness::NONE }, &mut visit))
    }

    /// Returns the rectangle that contains all rays through a patch. Returns `None` outside of the
    /// window.
    #[inline]
    pub fn rectangle(&self, patch: &Patch) -> Option<Rectangle> {
        self.grid.rectangle(patch)
    }
}
