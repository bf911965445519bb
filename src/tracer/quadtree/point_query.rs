//! The point query: the way down to the objects that one ray may meet.
//!
//! In: a place in the grid. Out: the lists of the cells that hold it, from the root down, each ended where the rest is hidden.

use super::{
    grid::{Item, LEVELS, Nearness},
    tree::Tree,
};

/// The way from the root to the smallest cell that holds a point.
#[derive(Debug)]
pub struct Descent<'a> {
    tree: &'a Tree,
    cell: Option<u32>,
    at: [u32; 2],
    level: u32,
}

impl<'a> Descent<'a> {
    pub(super) fn new(tree: &'a Tree, at: [u32; 2]) -> Self {
        Self {
            tree,
            cell: Some(0),
            at,
            level: LEVELS,
        }
    }

    /// The next list, unless all that is left is behind `bar`.
    #[inline]
    pub fn next(&mut self, bar: Nearness) -> Option<List<'a>> {
        let cell = self.tree.cells[self.cell? as usize];
        if cell.nearest <= bar {
            return None;
        }
        let list = List {
            entries: &self.tree.entries[cell.start as usize..cell.end as usize],
            at: self.at,
        };
        self.cell = (cell.quarters > 0).then(|| {
            self.level -= 1;
            let bit = |axis: usize| self.at[axis] >> self.level & 1;
            cell.quarters + bit(0) + 2 * bit(1)
        });
        Some(list)
    }
}

/// The list of a cell.
#[derive(Clone, Copy, Debug)]
pub struct List<'a> {
    entries: &'a [Item],
    at: [u32; 2],
}

impl<'a> List<'a> {
    /// The next object that the ray may meet, unless all that is left is behind `bar`.
    #[inline]
    pub fn next(&mut self, bar: Nearness) -> Option<usize> {
        while let [entry, rest @ ..] = self.entries {
            if entry.nearest <= bar {
                return None;
            }
            self.entries = rest;
            if entry.bounds.holds(self.at) {
                return Some(entry.object as usize);
            }
        }
        None
    }
}
