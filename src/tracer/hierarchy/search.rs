//! The objects in a part of the view plane.

use std::{cmp::Reverse, ops::ControlFlow};

use super::{
    grid::{Item, Nearness, Rectangle},
    tree::{Place, Tree},
};

/// Most objects that are smaller than their cell are listed in two or three.
const CELLS: usize = 2;

/// To ask an object whether it fills the rectangle takes as long as so many entries.
const A_LOOK: usize = 4;

/// A search for the objects that rays through a rectangle may meet.
pub(super) struct Search<'a, F> {
    tree: &'a Tree,
    rectangle: &'a Rectangle,
    /// It is given up when it has cost more than as many entries do.
    left: usize,
    /// What is not nearer than this is behind an object, if that fills the rectangle.
    behind: F,
    /// What is not nearer than this is hidden.
    hidden: Nearness,
    found: &'a mut Vec<Item>,
}

impl<'a, F: FnMut(u32) -> Nearness> Search<'a, F> {
    pub(super) fn new(
        tree: &'a Tree,
        rectangle: &'a Rectangle,
        most: usize,
        behind: F,
        found: &'a mut Vec<Item>,
    ) -> Self {
        Self {
            tree,
            rectangle,
            left: most.saturating_mul(CELLS),
            behind,
            hidden: Nearness::NONE,
            found,
        }
    }

    /// Finds them, the one that may be nearest first, with bounds of what they are in the rectangle; whether that is so. If they seem to be too
    /// many, it is not.
    pub(super) fn run(mut self) -> bool {
        self.found.clear();
        if self.below(0, Place::ROOT).is_break() {
            return false;
        }
        let hidden = self.hidden;
        self.found.retain(|item| item.nearest > hidden);
        self.found
            .sort_unstable_by_key(|item| (Reverse(item.nearest), item.object));
        // Those that lie in several cells.
        self.found.dedup_by(|next, item| {
            let is_same = next.object == item.object;
            if is_same {
                item.add(next);
            }
            is_same
        });
        true
    }

    /// Whether it may go on after another cost.
    fn pay(&mut self, cost: usize) -> ControlFlow<()> {
        match self.left.checked_sub(cost) {
            Some(left) => {
                self.left = left;
                ControlFlow::Continue(())
            }
            None => ControlFlow::Break(()),
        }
    }

    /// Adds what a cell lists, and then what those below it do: the large objects come first, which may hide the others.
    fn below(&mut self, cell: u32, place: Place) -> ControlFlow<()> {
        let cell = self.tree.cells[cell as usize];
        if cell.nearest <= self.hidden || !place.bounds().meets(self.rectangle) {
            return ControlFlow::Continue(());
        }
        // An object in a smaller cell is too small to hide anything. One that lies in several cells may fill what the rectangle has of this one.
        let part =
            (place.side() >= self.rectangle.side()).then(|| self.rectangle.within(&place.bounds()));
        for entry in &self.tree.entries[cell.start as usize..cell.end as usize] {
            if entry.nearest <= self.hidden {
                break;
            }
            let item = place.item(entry);
            if item.meets(self.rectangle) {
                let may_fill = part.is_some_and(|part| item.may_fill(&part));
                self.pay(if may_fill { A_LOOK } else { 1 })?;
                self.found.push(item);
                if may_fill {
                    self.hidden = self.hidden.max((self.behind)(entry.object));
                }
            }
        }
        if cell.quarters > 0 {
            for quarter in 0..4 {
                self.below(cell.quarters + quarter, place.quarter(quarter))?;
            }
        }
        ControlFlow::Continue(())
    }
}
