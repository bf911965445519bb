//! What rays that lie close together may meet, looked for once for all of them.

use std::slice;

use super::{
    descent::{Descent, List},
    grid::{Item, Nearness, Rectangle},
    tree::{Place, Tree, part_of},
};

/// Where rays lie in several quarters of a cell, what these list is looked at if it is no more than so many entries for each ray, which passes
/// by about twice as many on its own way,
const A_RAY: usize = 8;

/// and no more than so many in all: of more, more would be left for each ray than it passes by on its own way.
const MOST: usize = 64;

/// What some rays may meet, kept for its room.
#[derive(Debug, Default)]
pub struct Shared {
    items: Vec<Item>,
    /// How many entries were looked at.
    entries: usize,
    /// The cell from whose quarters on the rays go their own ways, if the objects are not all, and its level.
    fork: Option<(u32, u32)>,
}

/// The objects that a ray may meet.
#[derive(Debug)]
pub struct Asked<'a> {
    shared: slice::Iter<'a, Item>,
    at: [u32; 2],
    rest: Option<Descent<'a>>,
    list: List<'a>,
}

impl Shared {
    /// Whether so few objects are left of what is listed that it was worth a look: where a quarter or more is left, pictures take longer than
    /// with each ray on its own way.
    pub fn is_worth_it(&self) -> bool {
        self.fork.is_none() && 4 * self.items.len() <= self.entries
    }

    /// Finds what so many rays in a rectangle may meet.
    pub(super) fn find(&mut self, tree: &Tree, rectangle: &Rectangle, rays: usize) {
        self.items.clear();
        (self.entries, self.fork) = (0, None);
        let (mut index, mut place) = (0, Place::ROOT);
        loop {
            self.list(tree, index, place, rectangle);
            let quarters = tree.cells[index as usize].quarters;
            if quarters == 0 {
                return;
            }
            let Some(quarter) = place.quarter_with(rectangle) else {
                break;
            };
            (index, place) = (quarters + quarter, place.quarter(quarter));
        }
        let mut left = MOST.min(rays * A_RAY);
        if is_little(tree, index, place, rectangle, &mut left) {
            self.below(tree, index, place, rectangle);
        } else {
            self.fork = Some((index, place.level));
        }
    }

    /// What one of the rays may meet.
    #[inline]
    pub(super) fn of<'a>(&'a self, tree: &'a Tree, at: [u32; 2]) -> Asked<'a> {
        let rest = |(cell, level)| Descent::below(tree, cell, level, at);
        Asked {
            shared: self.items.iter(),
            at,
            rest: self.fork.map(rest),
            list: List::EMPTY,
        }
    }

    /// Adds what the cells below one list in a rectangle.
    fn below(&mut self, tree: &Tree, index: u32, place: Place, rectangle: &Rectangle) {
        for (index, place) in quarters_in(tree, index, place, rectangle) {
            self.list(tree, index, place, rectangle);
            self.below(tree, index, place, rectangle);
        }
    }

    /// Adds what a cell itself lists in a rectangle.
    #[inline]
    fn list(&mut self, tree: &Tree, index: u32, place: Place, rectangle: &Rectangle) {
        let cell = tree.cells[index as usize];
        if cell.start == cell.end {
            return;
        }
        let entries = &tree.entries[cell.start as usize..cell.end as usize];
        self.entries += entries.len();
        let within = rectangle.within(&place.bounds());
        let parts = |at: [u32; 2]| at.map(|x| part_of(place.level, x));
        let (low, high) = (parts(within.low), parts(within.high));
        for entry in entries {
            let meets = |i: usize| (entry.low[i] <= high[i]) & (low[i] <= entry.high[i]);
            if meets(0) & meets(1) {
                self.items.push(place.item(entry));
            }
        }
    }
}

impl Asked<'_> {
    /// The next of them, unless all that is left is behind `bar`.
    #[inline]
    pub fn next(&mut self, bar: Nearness) -> Option<usize> {
        for item in self.shared.by_ref() {
            if item.nearest > bar && item.holds(self.at) {
                return Some(item.object as usize);
            }
        }
        loop {
            if let Some(index) = self.list.next(bar) {
                return Some(index);
            }
            self.list = self.rest.as_mut()?.next(bar)?;
        }
    }
}

/// Whether the cells below one list no more than so much in a rectangle.
fn is_little(
    tree: &Tree,
    index: u32,
    place: Place,
    rectangle: &Rectangle,
    left: &mut usize,
) -> bool {
    quarters_in(tree, index, place, rectangle).all(|(index, place)| {
        let cell = tree.cells[index as usize];
        // To look at the cell takes as long as at an entry, too.
        let cost = 1 + (cell.end - cell.start) as usize;
        *left = left.saturating_sub(cost);
        *left > 0 && is_little(tree, index, place, rectangle, left)
    })
}

/// The quarters of a cell that lie in a rectangle, if there is anything in them.
fn quarters_in<'a>(
    tree: &'a Tree,
    index: u32,
    place: Place,
    rectangle: &'a Rectangle,
) -> impl Iterator<Item = (u32, Place)> + 'a {
    let first = tree.cells[index as usize].quarters;
    let quarters = if first > 0 { 0..4 } else { 0..0 };
    quarters
        .map(move |quarter| (first + quarter, place.quarter(quarter)))
        .filter(move |(index, place)| {
            tree.cells[*index as usize].nearest > Nearness::NONE && place.bounds().meets(rectangle)
        })
}
