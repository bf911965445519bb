//! Which objects may be met at a point of the view plane: a quadtree over their bounds there.
//!
//! Since all rays share the eye, a ray is a point of the view plane, and lies in one cell of each level alone: the way down has no
//! branches. An object is listed in the cells that it overlaps of the level where it is about as large as they are, four of them at most,
//! so that the lists have no more entries than four times the objects, whatever these look like. Each list begins with what may be
//! nearest and ends, for a ray that met something already, where the rest is behind that.
//!
//! Cells are counted in whole numbers, into which a coordinate's conversion is monotone: what it rounds never separates a point from
//! bounds that hold it by more than one, and bounds are one wider.

use std::cmp::Reverse;

use rayon::{ThreadPool, prelude::*};

use super::{
    camera::{Direction, Window},
    cover::{Patch, Range},
    extent::Extent,
};

/// The side of the root is 2 to this power: units are far smaller than pixels in a picture of any common size.
const LEVELS: u32 = 24;

/// A cell with no more objects is not divided.
const FEW: usize = 32;

/// A cell with more objects is divided by several threads.
const MANY: usize = 1 << 14;

/// The objects that may be seen, by where in the view plane they are.
#[derive(Debug)]
pub struct Hierarchy {
    grid: Grid,
    tree: Tree,
}

/// An object's bounds in the units of the grid, ends included, and how near it is at most.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    low: [u32; 2],
    high: [u32; 2],
    nearest: Nearness,
    object: u32,
}

/// An object in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Above what its inverse depths may be.
    nearest: Nearness,
    /// Its index in the file.
    pub object: u32,
    /// Its bounds in parts of the cell, ends included.
    low: [u8; 2],
    high: [u8; 2],
}

/// An inverse depth with 20 bits of its fraction: the upper half of an `f64`, which is ordered as the number is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Nearness(u32);

/// From X and Y to the units of the grid.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    least: f64,
    per_unit: f64,
    /// The window, ends included: no point outside of it can be asked for.
    low: [u32; 2],
    high: [u32; 2],
}

/// Cells, the first of which holds the others.
#[derive(Debug)]
struct Tree {
    cells: Vec<Cell>,
    entries: Vec<Entry>,
}

#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Where its four quarters are, or 0 if it is not divided.
    quarters: u32,
    /// Its list among the entries.
    start: u32,
    end: u32,
    /// The nearest of its own list and of all below it.
    nearest: Nearness,
}

impl Nearness {
    /// Nothing is as far as this.
    pub const NONE: Self = Self(0);

    /// More than a number that is not negative; infinite for NaN.
    fn above(x: f64) -> Self {
        if x >= 0.0 {
            Self((x.to_bits() >> 32) as u32 + 1)
        } else {
            Self(u32::MAX)
        }
    }

    /// A number or less; none for NaN.
    pub fn below(x: f64) -> Self {
        if x > 0.0 {
            Self((x.to_bits() >> 32) as u32)
        } else {
            Self::NONE
        }
    }
}

impl Grid {
    /// The grid of a window.
    pub fn new(window: &Window<f64>) -> Self {
        let half = window.x.max(window.y) * 1.125;
        let mut grid = Self {
            least: -half,
            per_unit: f64::from(1 << LEVELS) / (2.0 * half),
            low: [0; 2],
            high: [0; 2],
        };
        let reach = [window.x, window.y];
        grid.low = reach.map(|reach| grid.unit(-reach).saturating_sub(1));
        grid.high = reach.map(|reach| grid.unit(reach) + 1);
        grid
    }

    /// The unit that a coordinate lies in, or the nearest one; the first for NaN.
    #[inline]
    fn unit(&self, x: f64) -> u32 {
        const LAST: u32 = (1 << LEVELS) - 2;
        (((x - self.least) * self.per_unit) as u32).min(LAST)
    }

    /// The units of a direction that lies in the window.
    #[inline]
    fn units(&self, r: &Direction<f64>) -> Option<[u32; 2]> {
        let at = [self.unit(r.x), self.unit(r.y)];
        let is_within = |axis: usize| self.low[axis] <= at[axis] && at[axis] <= self.high[axis];
        (is_within(0) && is_within(1)).then_some(at)
    }

    /// The ends of some ranges within the window; none if one of them lies outside.
    fn ends(&self, ranges: [Range; 2]) -> Option<([u32; 2], [u32; 2])> {
        let low = [0, 1].map(|i| {
            let low = self.unit(ranges[i].low).saturating_sub(1);
            low.max(self.low[i])
        });
        let high = [0, 1].map(|i| (self.unit(ranges[i].high) + 1).min(self.high[i]));
        (low[0] <= high[0] && low[1] <= high[1]).then_some((low, high))
    }

    /// An object in the grid; none outside of the window.
    pub fn item(&self, object: usize, extent: &Extent) -> Option<Item> {
        let (low, high) = self.ends(extent.across)?;
        Some(Item {
            low,
            high,
            nearest: Nearness::above(extent.nearest),
            // More would not fit into memory.
            object: object as u32,
        })
    }
}

impl Hierarchy {
    /// A hierarchy over some objects, built by some threads, or by this one alone.
    pub fn new(grid: Grid, items: Vec<Item>, threads: Option<&ThreadPool>) -> Self {
        let tree = match threads {
            Some(threads) => threads.install(|| Tree::of_many(Place::ROOT, items)),
            None => Tree::new(Place::ROOT, items),
        };
        Self { grid, tree }
    }

    /// The way down to the objects that a ray may meet; none for a direction outside of the window.
    #[inline]
    pub fn at(&self, r: &Direction<f64>) -> Option<Descent<'_>> {
        Some(Descent {
            tree: &self.tree,
            cell: Some(0),
            at: self.grid.units(r)?,
            level: LEVELS,
        })
    }

    /// The objects that rays through a patch may meet, in file order.
    pub fn within(&self, patch: &Patch, out: &mut Vec<usize>) {
        out.clear();
        let center = [patch.center.x, patch.center.y];
        let ranges = [0, 1].map(|i| Range::about(center[i], patch.half[i]));
        if let Some((low, high)) = self.grid.ends(ranges) {
            self.tree.within(0, Place::ROOT, (low, high), out);
        }
        out.sort_unstable();
        out.dedup();
    }

    /// How many bytes it takes.
    #[cfg(test)]
    pub fn bytes(&self) -> usize {
        self.tree.cells.capacity() * size_of::<Cell>()
            + self.tree.entries.capacity() * size_of::<Entry>()
    }
}

/// The way from the root to the smallest cell that holds a point.
#[derive(Debug)]
pub struct Descent<'a> {
    tree: &'a Tree,
    cell: Option<u32>,
    at: [u32; 2],
    level: u32,
}

impl<'a> Descent<'a> {
    /// The next list, unless all that is left is behind `bar`.
    #[inline]
    pub fn next(&mut self, bar: Nearness) -> Option<List<'a>> {
        let cell = self.tree.cells[self.cell? as usize];
        if cell.nearest <= bar {
            return None;
        }
        let list = List {
            entries: &self.tree.entries[cell.start as usize..cell.end as usize],
            at: self.at.map(|x| part_of(self.level, x)),
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
    entries: &'a [Entry],
    /// Where the point is, in parts of the cell.
    at: [u8; 2],
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
            let holds = |axis: usize| {
                (entry.low[axis] <= self.at[axis]) & (self.at[axis] <= entry.high[axis])
            };
            if holds(0) & holds(1) {
                return Some(entry.object as usize);
            }
        }
        None
    }
}

/// Which of 256 parts of a cell with a side of 2^level holds a coordinate in the cell; of the smallest cells not all parts are used.
#[inline]
fn part_of(level: u32, x: u32) -> u8 {
    let within = x & ((1 << level) - 1);
    match level {
        0..8 => (within << (8 - level)) as u8,
        _ => (within >> (level - 8)) as u8,
    }
}

impl Tree {
    /// The tree of a cell.
    fn new(place: Place, items: Vec<Item>) -> Self {
        // The items of a cell are the last ones; on the way down those of a quarter are put behind them.
        let mut stack = items;
        let mut tree = Self::empty();
        tree.divide(0, place, &mut stack, 0);
        tree.cells.shrink_to_fit();
        tree.entries.shrink_to_fit();
        tree
    }

    /// The tree of a cell, by several threads.
    fn of_many(place: Place, items: Vec<Item>) -> Self {
        if items.len() <= MANY || place.level == 0 {
            return Self::new(place, items);
        }
        let mut tree = Self::empty();
        let (own, below): (Vec<_>, _) = items.into_iter().partition(|item| place.keeps(item));
        tree.list(0, place, &own);
        let quarters = [0, 1, 2, 3].map(|quarter| {
            let place = place.quarter(quarter);
            let items = below.iter().filter(|item| place.meets(item));
            (place, items.copied().collect::<Vec<_>>())
        });
        drop((own, below));
        let quarters = quarters.into_par_iter();
        let quarters = quarters.map(|(place, items)| Self::of_many(place, items));
        tree.join(quarters.collect());
        tree
    }

    fn empty() -> Self {
        Self {
            cells: vec![Cell::EMPTY],
            entries: Vec::new(),
        }
    }

    /// Fills a cell and all below it with the items from `start` on.
    fn divide(&mut self, cell: usize, place: Place, stack: &mut Vec<Item>, start: usize) {
        if stack.len() - start <= FEW || place.level == 0 {
            return self.list(cell, place, &stack[start..]);
        }
        stack[start..].sort_by_key(|item| !place.keeps(item));
        let own = stack[start..].partition_point(|item| place.keeps(item));
        self.list(cell, place, &stack[start..start + own]);
        let (start, end) = (start + own, stack.len());
        let quarters = self.cells.len();
        self.cells.extend([Cell::EMPTY; 4]);
        self.cells[cell].quarters = quarters as u32;
        for quarter in 0..4 {
            let below = place.quarter(quarter);
            for index in start..end {
                let item = stack[index];
                if below.meets(&item) {
                    stack.push(item);
                }
            }
            let child = quarters + quarter as usize;
            self.divide(child, below, stack, end);
            stack.truncate(end);
            self.cells[cell].nearest = self.cells[cell].nearest.max(self.cells[child].nearest);
        }
    }

    /// Lists items in a cell, behind all lists so far.
    fn list(&mut self, cell: usize, place: Place, items: &[Item]) {
        let start = self.entries.len();
        self.entries
            .extend(items.iter().map(|item| place.entry(item)));
        let list = &mut self.entries[start..];
        list.sort_unstable_by_key(|entry| (Reverse(entry.nearest), entry.object));
        self.cells[cell] = Cell {
            nearest: list.first().map_or(Nearness::NONE, |entry| entry.nearest),
            start: start as u32,
            end: self.entries.len() as u32,
            ..self.cells[cell]
        };
    }

    /// Puts the trees of its quarters below the only cell so far: their own cells together, then what is below each of them.
    fn join(&mut self, quarters: Vec<Self>) {
        self.cells[0].quarters = 1;
        let mut rest = Vec::new();
        for quarter in quarters {
            let (cells, entries) = (4 + rest.len() as u32, self.entries.len() as u32);
            self.entries.extend_from_slice(&quarter.entries);
            let mut moved = quarter.cells.into_iter().map(|cell| Cell {
                quarters: match cell.quarters {
                    0 => 0,
                    own => own + cells,
                },
                start: cell.start + entries,
                end: cell.end + entries,
                nearest: cell.nearest,
            });
            if let Some(cell) = moved.next() {
                self.cells[0].nearest = self.cells[0].nearest.max(cell.nearest);
                self.cells.push(cell);
            }
            rest.extend(moved);
        }
        self.cells.append(&mut rest);
        self.cells.shrink_to_fit();
        self.entries.shrink_to_fit();
    }

    /// Adds the objects of a cell, and of those below it, that may overlap a rectangle.
    fn within(
        &self,
        cell: u32,
        place: Place,
        rectangle: ([u32; 2], [u32; 2]),
        out: &mut Vec<usize>,
    ) {
        let (low, high) = rectangle;
        if (0..2).any(|axis| high[axis] < place.corner[axis] || low[axis] > place.last(axis)) {
            return;
        }
        let cell = self.cells[cell as usize];
        let list = &self.entries[cell.start as usize..cell.end as usize];
        let (low, high) = (place.parts(low), place.parts(high));
        let may_overlap = |entry: &&Entry| {
            (0..2).all(|axis| entry.low[axis] <= high[axis] && low[axis] <= entry.high[axis])
        };
        let overlapping = list.iter().filter(may_overlap);
        out.extend(overlapping.map(|entry| entry.object as usize));
        if cell.quarters > 0 {
            for quarter in 0..4 {
                let below = place.quarter(quarter);
                self.within(cell.quarters + quarter, below, rectangle, out);
            }
        }
    }
}

impl Cell {
    const EMPTY: Self = Self {
        quarters: 0,
        start: 0,
        end: 0,
        nearest: Nearness::NONE,
    };
}

/// Where a cell is, and that its side is 2^level.
#[derive(Clone, Copy, Debug)]
struct Place {
    corner: [u32; 2],
    level: u32,
}

impl Place {
    const ROOT: Self = Self {
        corner: [0; 2],
        level: LEVELS,
    };

    /// The last coordinate in the cell.
    fn last(self, axis: usize) -> u32 {
        self.corner[axis] + ((1 << self.level) - 1)
    }

    /// Whether an object is larger than the cell's quarters, and so not listed below it.
    fn keeps(self, item: &Item) -> bool {
        (0..2).any(|axis| item.high[axis] - item.low[axis] > 1 << (self.level - 1))
    }

    fn meets(self, item: &Item) -> bool {
        (0..2).all(|axis| item.low[axis] <= self.last(axis) && item.high[axis] >= self.corner[axis])
    }

    /// A quarter: right of the first for 1 and 3, below it for 2 and 3.
    fn quarter(self, quarter: u32) -> Self {
        let level = self.level - 1;
        let [x, y] = self.corner;
        Self {
            corner: [x + ((quarter & 1) << level), y + ((quarter >> 1) << level)],
            level,
        }
    }

    /// The parts of the cell that hold two coordinates, or are the nearest to them.
    fn parts(self, at: [u32; 2]) -> [u8; 2] {
        [0, 1].map(|axis| {
            part_of(
                self.level,
                at[axis].clamp(self.corner[axis], self.last(axis)),
            )
        })
    }

    fn entry(self, item: &Item) -> Entry {
        Entry {
            nearest: item.nearest,
            object: item.object,
            low: self.parts(item.low),
            high: self.parts(item.high),
        }
    }
}
