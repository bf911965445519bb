//! The objects that rays through a point of the view plane may hit: a quadtree over the objects'
//! bounds in the view plane.
//!
//! All rays start at the eye, so each ray is a point of the view plane and lies in exactly one cell
//! of each level. The search for a ray therefore follows a single path from the root cell down. An
//! object is listed in the cells that it overlaps on the level where cells are about as large as
//! the object. There are at most four such cells, so the lists have at most four entries per
//! object, whatever its shape. Each list is sorted by the objects' maximum inverse depth
//! ([`Nearness`]), the greatest first. If the ray has hit an object, the search stops reading a
//! list at the first entry behind this object.
//!
//! Coordinates of cells are whole numbers. Rounding to whole numbers keeps the order of
//! coordinates, but may move a point of an object out of the object's bounds, by at most one unit.
//! Bounds are therefore widened by one unit.

mod grid;
mod point_query;
mod rectangle_query;
mod tree;

use std::{cmp::Reverse, sync::atomic::AtomicBool};

use self::{point_query::visit_list, rectangle_query::Search, tree::Cells};
use super::{camera::Direction, local_form::Patch};

pub use self::grid::{BoundedObject, CellGrid, Nearness, Rectangle};
pub use self::tree::OBJECTS_PER_CELL;

/// Quadtree over the bounds, in the view plane, of all objects that rays may hit.
#[derive(Debug)]
pub struct Quadtree {
    grid: CellGrid,
    tree: Cells,
}

impl Quadtree {
    /// Builds a quadtree over `items`. If `cancel` is set during the build, some of the objects are
    /// missing.
    pub fn new(grid: CellGrid, items: Vec<BoundedObject>, cancel: &AtomicBool) -> Self {
        let tree = Cells::new(items, cancel);
        Self { grid, tree }
    }

    /// Calls `visit` with the objects that a ray may hit, from the largest cell down. `visit`
    /// returns the inverse depth of the nearest crossing so far, rounded down; objects entirely
    /// behind this crossing are skipped. If `visit` fails, stops and returns its error. Returns
    /// `None` if the direction is outside of the window.
    #[inline]
    pub fn visit<E>(
        &self,
        r: &Direction<f64>,
        visit: impl FnMut(usize) -> Result<Nearness, E>,
    ) -> Option<Result<(), E>> {
        Some(self.tree.visit(self.grid.units(r)?, visit))
    }

    /// Returns the objects that rays through the rectangle `patch` of the view plane may hit, in
    /// file order. `behind` is called with an object whose bounds contain the rectangle. It returns
    /// an inverse depth, rounded down: everything farther away is hidden by the object, and is left
    /// out. Returns `None` if more than four times `most` list entries are found. An object has at
    /// most four entries, so there are then more than `most` objects.
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

    /// Returns the objects that rays through the rectangle `patch` of the view plane may hit, the
    /// nearest first. Returns `None` if [`within`](Self::within) finds more than
    /// [`OBJECTS_PER_CELL`] objects.
    pub fn nearby(&self, patch: &Patch) -> Option<Vec<BoundedObject>> {
        let mut items = self.within(patch, OBJECTS_PER_CELL, |_| Nearness::NONE)?;
        items.sort_by_key(|item| Reverse(item.nearest));
        Some(items)
    }

    /// Calls `visit` with the objects of `nearby` that a ray may hit, the nearest first. If `visit`
    /// fails, stops and returns its error. `visit` returns the inverse depth of the nearest
    /// crossing so far, rounded down; objects entirely behind this crossing are skipped. `nearby`
    /// is the result of [`nearby`](Self::nearby) for a rectangle that contains the ray. Returns
    /// `None` if the direction is outside of the window.
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

    /// Returns a rectangle of the grid that contains all rays through the rectangle `patch` of the
    /// view plane. Returns `None` if `patch` lies outside of the window.
    #[inline]
    pub fn rectangle(&self, patch: &Patch) -> Option<Rectangle> {
        self.grid.rectangle(patch)
    }
}
