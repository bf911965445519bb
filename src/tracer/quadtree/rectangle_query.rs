//! The rectangle query: the objects that rays through a rectangle may meet.
//!
//! In: a rectangle of the grid. Out: the objects whose bounds meet it, in file order, but for those
//! behind one that fills it.

use super::{
    grid::{Item, Nearness, Rectangle},
    tree::{CellSquare, Tree},
};

/// An object is listed in no more cells than this: it is no longer than the cells that list it, and
/// meets two of them along each axis.
const CELLS: usize = 4;

/// A search for the objects that rays through a rectangle may meet.
pub(super) struct Search<'a, F> {
    tree: &'a Tree,
    rectangle: &'a Rectangle,
    /// More entries than this are of too many objects.
    most: usize,
    /// What is not nearer than this is behind an object, if that fills the rectangle.
    behind: F,
    /// What is not nearer than this is hidden.
    hidden: Nearness,
    found: Vec<Item>,
}

impl<'a, F: FnMut(u32) -> Nearness> Search<'a, F> {
    pub(super) fn new(tree: &'a Tree, rectangle: &'a Rectangle, most: usize, behind: F) -> Self {
        Self {
            tree,
            rectangle,
            most: most.saturating_mul(CELLS),
            behind,
            hidden: Nearness::NONE,
            found: Vec::new(),
        }
    }

    /// The objects, in file order; none if they are too many.
    pub(super) fn run(mut self) -> Option<Vec<Item>> {
        self.below(0, CellSquare::ROOT)?;
        let mut items = self.found;
        items.retain(|item| item.nearest > self.hidden);
        items.sort_unstable_by_key(|item| item.object);
        // Those that lie in several cells.
        items.dedup_by_key(|item| item.object);
        Some(items)
    }

    /// Adds what a cell lists, and then what those below it do: the large objects come first, which
    /// may hide the others. None if that is too much.
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
