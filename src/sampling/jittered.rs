//! `jittered`: one random point in each of n cells of equal area (Cook, Porter and Carpenter 1984,
//! "Distributed ray tracing"). The cells are [`Bricks`], which exist for every n.

use std::ops::Range;

use super::{
    bricks::Bricks,
    lattice::{self, Strata},
    rng::{Key, scale},
};

/// Cells of equal area in a pixel, and the divisions of the pixel's width and height from which the
/// cells are made.
#[derive(Debug)]
pub struct Jittered {
    bricks: Bricks,
    /// Two divisions of the pixel's width into equal columns: one for short rows of cells, and one
    /// for longer rows.
    columns: [Strata; 2],
    /// Division of the pixel's height into n equal parts. A row of k cells is k of these parts
    /// tall.
    rows: Strata,
}

impl Jittered {
    /// Divides a pixel into cells for `n` points.
    pub fn new(n: u64) -> Self {
        let bricks = Bricks::new(n);
        Self {
            columns: bricks.lengths().map(Strata::new),
            rows: Strata::new(n),
            bricks,
        }
    }

    /// Places the points whose indices are in `range`; points are counted row by row. Writes their
    /// offsets from the pixel's centre to the lists `x` and `y`.
    #[inline(always)]
    pub fn place(&self, key: Key, range: Range<u64>, [x, y]: [&mut [f64]; 2]) {
        let [short, _] = self.bricks.lengths();
        let mut points = x.iter_mut().zip(y);
        key.pairs(range, |first, mut pairs| {
            let end = first + pairs.len() as u64;
            for (row, columns) in self.bricks.parts(first..end) {
                let strata = &self.columns[(row.cells - short) as usize];
                let top = self.rows.get(row.first).start();
                let height = self.rows.get(row.first + row.cells).start() - top;
                let (here, rest) = pairs.split_at((columns.end - columns.start) as usize);
                pairs = rest;
                for ((column, bits), (x, y)) in columns.zip(here).zip(&mut points) {
                    *x = strata.choose(column, bits[0]);
                    *y = lattice::offset(top + scale(bits[1], height));
                }
            }
        });
    }
}
