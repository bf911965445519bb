//! Which objects may be met at a point of the view plane: a quadtree over their bounds there.
//!
//! Since all rays share the eye, a ray is a point of the view plane, and lies in one cell of each level alone: the way down has no
//! branches. An object is listed in the cells that it overlaps of the level where it is about as large as they are, four of them at most,
//! so that the lists have no more entries than four times the objects, whatever these look like. Each list begins with what may be
//! nearest and ends, for a ray that met something already, where the rest is behind that.
//!
//! Cells are counted in whole numbers, into which a coordinate's conversion is monotone: what it rounds never separates a point from
//! bounds that hold it by more than one, and bounds are one wider.

use rayon::prelude::*;

use super::{
    camera::{Direction, Window},
    cover::{Patch, Range},
    extent::Extent,
};

/// The side of the root is 2 to this power.
const LEVELS: u32 = 30;

/// A cell with no more objects is not divided.
const FEW: usize = 8;

/// A cell with more objects is divided by several threads.
const MANY: usize = 1 << 12;

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
    entry: Entry,
}

/// An object in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Above what its inverse depths may be.
    nearest: Nearness,
    /// Its index in the file.
    pub object: u32,
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
#[derive(Debug, Default)]
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
            entry: Entry {
                nearest: Nearness::above(extent.nearest),
                // A text of so many objects would not fit into memory.
                object: u32::try_from(object).ok()?,
            },
        })
    }
}

impl Hierarchy {
    /// A hierarchy over some objects.
    pub fn new(grid: Grid, items: Vec<Item>) -> Self {
        Self {
            grid,
            tree: Tree::new([0; 2], LEVELS, items),
        }
    }

    /// The lists of objects that a ray may meet, as long as something in them may be nearer than what `bar` says when it is asked. None
    /// for a direction outside of the window.
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
            self.tree.within(0, [0; 2], LEVELS, (low, high), out);
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
    pub fn next(&mut self, bar: Nearness) -> Option<&'a [Entry]> {
        let cell = self.tree.cells[self.cell? as usize];
        if cell.nearest <= bar {
            return None;
        }
        self.cell = (cell.quarters > 0).then(|| {
            self.level -= 1;
            let bit = |axis: usize| self.at[axis] >> self.level & 1;
            cell.quarters + bit(0) + 2 * bit(1)
        });
        Some(&self.tree.entries[cell.start as usize..cell.end as usize])
    }
}

impl Entry {
    /// Whether all of the object is behind `bar`.
    #[inline]
    pub fn is_behind(self, bar: Nearness) -> bool {
        self.nearest <= bar
    }
}

impl Tree {
    /// The tree of a cell with a side of 2^level.
    fn new(corner: [u32; 2], level: u32, items: Vec<Item>) -> Self {
        if items.len() <= FEW || level == 0 {
            return Self::leaf(items);
        }
        let half = 1 << (level - 1);
        let middle = corner.map(|x| x + half);
        let mut own = Vec::new();
        let mut below: [Vec<Item>; 4] = Default::default();
        for item in &items {
            if (0..2).any(|axis| item.high[axis] - item.low[axis] > half) {
                own.push(*item);
                continue;
            }
            for (quarter, list) in below.iter_mut().enumerate() {
                let overlaps = |axis: usize| match quarter >> axis & 1 {
                    0 => item.low[axis] < middle[axis],
                    _ => item.high[axis] >= middle[axis],
                };
                if overlaps(0) && overlaps(1) {
                    list.push(*item);
                }
            }
        }
        let is_large = items.len() > MANY;
        drop(items);
        let tree = |(quarter, items): (usize, Vec<Item>)| {
            let side = |axis: usize| if quarter >> axis & 1 == 0 { corner } else { middle }[axis];
            Self::new([side(0), side(1)], level - 1, items)
        };
        let quarters = below.into_iter().enumerate();
        let quarters: Vec<Self> = match is_large {
            true => quarters
                .collect::<Vec<_>>()
                .into_par_iter()
                .map(tree)
                .collect(),
            false => quarters.map(tree).collect(),
        };
        Self::leaf(own).with_quarters(quarters)
    }

    /// A cell that is not divided.
    fn leaf(items: Vec<Item>) -> Self {
        let mut entries: Vec<_> = items.into_iter().map(|item| item.entry).collect();
        entries.sort_unstable_by_key(|entry| (std::cmp::Reverse(entry.nearest), entry.object));
        let cell = Cell {
            quarters: 0,
            start: 0,
            end: entries.len() as u32,
            nearest: entries
                .first()
                .map_or(Nearness::NONE, |entry| entry.nearest),
        };
        Self {
            cells: vec![cell],
            entries,
        }
    }

    /// A cell with its quarters: their own cells stand together, then what is below each of them.
    fn with_quarters(mut self, quarters: Vec<Self>) -> Self {
        self.cells[0].quarters = 1;
        let mut rest = Vec::new();
        for mut quarter in quarters {
            let (first, cells) = (4 + rest.len() as u32, self.entries.len() as u32);
            for cell in &mut quarter.cells {
                cell.start += cells;
                cell.end += cells;
                if cell.quarters > 0 {
                    cell.quarters += first;
                }
            }
            self.entries.append(&mut quarter.entries);
            let mut below = quarter.cells.into_iter();
            if let Some(cell) = below.next() {
                self.cells[0].nearest = self.cells[0].nearest.max(cell.nearest);
                self.cells.push(cell);
            }
            rest.extend(below);
        }
        self.cells.append(&mut rest);
        self
    }

    /// The objects of a cell and of those below it that overlap a rectangle.
    fn within(
        &self,
        cell: u32,
        corner: [u32; 2],
        level: u32,
        rectangle: ([u32; 2], [u32; 2]),
        out: &mut Vec<usize>,
    ) {
        let (low, high) = rectangle;
        let side = 1 << level;
        if (0..2).any(|axis| high[axis] < corner[axis] || low[axis] >= corner[axis] + side) {
            return;
        }
        let Cell {
            quarters,
            start,
            end,
            ..
        } = self.cells[cell as usize];
        let entries = &self.entries[start as usize..end as usize];
        out.extend(entries.iter().map(|entry| entry.object as usize));
        if quarters == 0 {
            return;
        }
        let half = side / 2;
        for quarter in 0..4 {
            let corner = [
                corner[0] + (quarter & 1) * half,
                corner[1] + (quarter >> 1) * half,
            ];
            self.within(quarters + quarter, corner, level - 1, rectangle, out);
        }
    }
}
