//! Divisions of a pixel into n cells such that a sampling method guarantees one sample in each
//! cell.
//!
//! In: a method and the number n of a pixel's samples. Out: the divisions in which each cell
//! contains one sample, in every pixel and with every seed. They follow from the methods' own
//! files. For example, `bricks` defines the cells of regular and jittered samples.

use super::{bricks::Bricks, multi_jittered::MultiJittered};
use crate::scene::Method;

/// A division of a pixel into n cells of equal area, each of which contains exactly one of n
/// samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tiling {
    /// Number of cells in each row, from the top. The height of a row of k cells is k/n of the
    /// pixel's height.
    pub rows: Vec<u64>,
}

impl Tiling {
    /// Returns a division into equal cells, given the numbers of columns and rows.
    fn grid([columns, rows]: [u64; 2]) -> Self {
        Self {
            rows: vec![columns; rows as usize],
        }
    }

    /// Returns whether the cells are columns, as tall as the pixel.
    pub fn is_columns(&self) -> bool {
        self.rows.len() == 1
    }

    /// Returns whether the cells are rows, as wide as the pixel.
    pub fn is_rows(&self) -> bool {
        self.rows.iter().all(|&cells| cells == 1)
    }
}

/// Returns the divisions of a pixel with `n` samples in which a method guarantees one sample per
/// cell. If the divisions into n columns or into n rows are among them, they come last. Returns no
/// divisions if `n` is 0.
pub fn tilings(method: Method, n: u64) -> Vec<Tiling> {
    if n == 0 {
        return vec![];
    }
    let (columns, rows) = ([n, 1], [1, n]);
    let is_power_of = |base: u64| {
        std::iter::successors(Some(1), |p| Some(p * base))
            .take_while(|&p| p <= n)
            .last()
            == Some(n)
    };
    let grids = match method {
        Method::Random | Method::Scatter | Method::Exact => vec![],
        Method::Regular | Method::Jittered => {
            let bricks = Bricks::new(n);
            let rows = bricks.parts(0..n).map(|(row, _)| row.cells);
            return vec![Tiling {
                rows: rows.collect(),
            }];
        }
        Method::NRooks => vec![columns, rows],
        Method::MultiJittered => vec![MultiJittered::new(n).grid(), columns, rows],
        // If n is a power of 2, the heights of the points are multiples of 1/n, plus a common
        // shift. Each of n rows then contains one point.
        Method::Hammersley if is_power_of(2) => vec![columns, rows],
        Method::Hammersley => vec![columns],
        // Each of n columns contains one point if n is a power of 2, and each of n rows if n is a
        // power of 3. In a grid of several columns and several rows, a cell may contain no point or
        // several points, because of the random shift.
        Method::Halton if is_power_of(2) => vec![columns],
        Method::Halton if is_power_of(3) => vec![rows],
        Method::Halton => vec![],
        Method::Sobol if is_power_of(2) => {
            let depth = n.trailing_zeros();
            let mut grids: Vec<_> = (0..=depth).map(|a| [1 << a, n >> a]).collect();
            // Grids whose cells are most nearly square come first.
            grids.sort_by_key(|[columns, rows]| columns.max(rows).to_owned());
            grids
        }
        Method::Sobol => vec![],
    };
    let mut grids: Vec<_> = grids.into_iter().map(Tiling::grid).collect();
    // A grid of one row or one column is listed only once.
    grids.dedup();
    grids
}
