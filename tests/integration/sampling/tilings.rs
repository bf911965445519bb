//! Tests that each cell of a tiling contains one sample. A tiling is a division of a pixel into
//! equal cells; [`tilings`] lists the tilings of each sampling method.

use pinhole::sampling::tilings;

use super::*;

/// Returns the cell that contains a point if a pixel is divided into rows with the given numbers of
/// cells: the cell's row, and its index in the row.
fn cell(rows: &[u64], point: DVec2) -> (usize, u64) {
    let n: u64 = rows.iter().sum();
    let height = ((point.y + 0.5) * n as f64).floor() as u64;
    let mut above = 0;
    let row = rows.iter().position(|cells| {
        above += cells;
        height < above
    });
    let row = row.expect("the point lies in the pixel");
    (row, ((point.x + 0.5) * rows[row] as f64).floor() as u64)
}

#[test]
fn each_cell_of_a_tiling_holds_one_sample() {
    for method in Method::SAMPLED {
        let mut told = 0;
        for n in (1..40).chain([49, 64, 81, 100, 128]) {
            for tiling in tilings(method, n) {
                told += 1;
                assert_eq!(tiling.rows.iter().sum::<u64>(), n, "{method:?} {n}");
                for (seed, pixel) in [(0, [0, 0]), (1, [3, 5]), (2, [63, 63])] {
                    let points = points(method, n, seed, pixel);
                    let cells = points.iter().map(|point| cell(&tiling.rows, *point));
                    let cells: std::collections::HashSet<_> = cells.collect();
                    assert_eq!(cells.len() as u64, n, "{method:?} {n} {tiling:?}");
                }
            }
        }
        let has_none = matches!(method, Method::Random | Method::Scatter);
        assert_eq!(told == 0, has_none, "{method:?}");
    }
}
