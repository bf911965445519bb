//! The rectangle query: the objects that rays through a rectangle may hit.
//!
//! In: a rectangle of the grid. Out: the objects whose bounds intersect the rectangle, in file
//! order, except those behind an object that fills the rectangle.

use super::{
    grid::{BoundedObject, Nearness, Rectangle},
    tree::{CellSquare, Cells},
};

/// Maximum number of cells that list one object. The bounds of an object are shorter than the sides
/// of the cells that list it. They therefore intersect at most two such cells along each axis.
const MAX_CELLS: usize = 4;

/// A search for the objects that rays through a rectangle may hit.
pub(super) struct Search<'a, F> {
    tree: &'a Cells,
    rectangle: &'a Rectangle,
    /// Maximum number of entries in `found`. An object has an entry for each cell that lists it.
    most: usize,
    /// Function that is called with an object whose bounds contain the rectangle. If every ray
    /// through the rectangle hits the object, it returns the least of the object's inverse depths
    /// there. This number is rounded down, so that the object certainly hides every object whose
    /// inverse depths are all smaller. Otherwise, it returns a number that hides nothing.
    behind: F,
    /// Greatest inverse depth that `behind` has returned so far. An object is hidden if its maximum
    /// inverse depth, rounded up, is not greater than this value.
    hidden: Nearness,
    found: Vec<BoundedObject>,
}

impl<'a, F: FnMut(u32) -> Nearness> Search<'a, F> {
    pub(super) fn new(tree: &'a Cells, rectangle: &'a Rectangle, most: usize, behind: F) -> Self {
        Self {
            tree,
            rectangle,
            most: most.saturating_mul(MAX_CELLS),
            behind,
            hidden: Nearness::NONE,
            found: Vec::new(),
        }
    }

    /// Returns the objects in file order, each once. Returns `None` if more than `most` list
    /// entries are found.
    pub(super) fn run(mut self) -> Option<Vec<BoundedObject>> {
        self.below(0, CellSquare::ROOT)?;
        let mut items = self.found;
        items.retain(|item| item.nearest > self.hidden);
        items.sort_unstable_by_key(|item| item.object);
        // An object that lies in several cells has several entries, which are now next to each
        // other. All but one are removed.
        items.dedup_by_key(|item| item.object);
        Some(items)
    }

    /// Adds the objects that a cell lists, and then those of its quarters. Large objects, which may
    /// hide others, therefore come first. Returns `None` if more than `most` list entries are
    /// found.
    fn below(&mut self, cell: u32, square: CellSquare) -> Option<()> {
        let cell = self.tree.cells[cell as usize];
        if cell.nearest <= self.hidden || !square.bounds().meets(self.rectangle) {
            return Some(());
        }
        for item in &self.tree.entries[cell.start as usize..cell.end as usize] {
            if item.nearest <= self.hidden {
                break;
            }
            if item.bounds.meets(self.rectangle) {
                if self.found.len() == self.most {
                    return None;
                }
                self.found.push(*item);
                if item.bounds.contains(self.rectangle) {
                    self.hidden = self.hidden.max((self.behind)(item.object));
                }
            }
        }
        if cell.quarters > 0 {
            for quarter in 0..4 {
                self.below(cell.quarters + quarter, square.quarter(quarter))?;
            }
        }
        Some(())
    }
}
