//! Tests of strata, i.e. equal parts of a pixel that contain one point each. The stratum of a point
//! is computed in integer arithmetic.

use std::collections::HashSet;

use super::*;

/// Seeds, each with the coordinates of a pixel whose points are tested. The choice is arbitrary:
/// corners of a picture and a pixel between them.
const PLACES: [(u64, [u32; 2]); 3] = [(0, [0, 0]), (1, [3, 5]), (2, [63, 63])];

/// Returns the index of the part in which `offset` lies if a pixel's side, from −1/2 to 1/2, is
/// divided into `n` equal parts. The index is ⌊(offset + 1/2) · n⌋, computed without rounding.
fn stratum(offset: f64, n: u64) -> u64 {
    ((fraction(offset) * u128::from(n)) >> 54) as u64
}

/// Returns offset + 1/2 in units of 2^−54. This is an integer for all methods except `regular`.
fn fraction(offset: f64) -> u128 {
    assert!((-0.5..0.5).contains(&offset), "{offset}");
    let scaled = offset * (1_u64 << 54) as f64;
    assert_eq!(scaled, scaled.floor());
    (scaled as i64 + (1 << 53)) as u128
}

/// Returns whether `numbers` are 0, 1, 2 and so on, each once, in any order.
fn each_once(numbers: impl Iterator<Item = u64>) -> bool {
    let mut numbers: Vec<_> = numbers.collect();
    numbers.sort_unstable();
    (0..).zip(numbers).all(|(i, number)| number == i)
}

/// Asserts that each cell of a grid of `columns` and `rows` contains exactly one point.
#[track_caller]
fn assert_one_in_each_cell(points: &[DVec2], columns: u64, rows: u64) {
    assert_eq!(points.len() as u64, columns * rows);
    let cell = |point: &DVec2| stratum(point.y, rows) * columns + stratum(point.x, columns);
    assert!(each_once(points.iter().map(cell)), "{columns} × {rows}");
}

/// Returns the number of cells in each row of the grid of the method `regular` with `n` samples.
/// Asserts that the grid has as many rows as the language's reference specifies.
fn rows(n: u64) -> Vec<u64> {
    let root = (n as f64).sqrt();
    let count = (1..=n)
        .filter(|rows| n.is_multiple_of(2) || rows % 2 == 1)
        .min_by(|a, b| f64::total_cmp(&(*a as f64 - root).abs(), &(*b as f64 - root).abs()))
        .unwrap();
    let points = points(Method::Regular, n, 0, [0, 0]);
    let rows = points.chunk_by(|one, next| one.y == next.y);
    let rows: Vec<_> = rows.map(|row| row.len() as u64).collect();
    assert_eq!(rows.len() as u64, count, "{n}");
    rows
}

#[test]
fn rows_of_the_regular_grid_have_nearly_equal_lengths() {
    for (n, lengths) in [
        (1, &[1][..]),
        (2, &[2]),
        (3, &[3]),
        (5, &[2, 1, 2]),
        (7, &[2, 3, 2]),
        (12, &[4, 4, 4]),
        (14, &[3, 4, 4, 3]),
        (16, &[4, 4, 4, 4]),
        (25, &[5, 5, 5, 5, 5]),
    ] {
        assert_eq!(rows(n), lengths);
    }
}

#[test]
fn regular_is_an_even_grid_symmetric_to_the_bit() {
    let middle = |first: u64, parts: u64, n: u64| {
        (2.0 * first as f64 + parts as f64 - n as f64) / (2.0 * n as f64)
    };
    for n in counts() {
        let points = points(Method::Regular, n, 0, [5, 7]);
        let mut expected = Vec::new();
        for cells in rows(n) {
            let y = middle(expected.len() as u64, cells, n);
            expected.extend((0..cells).map(|i| DVec2::new(middle(i, 1, cells), y)));
        }
        assert_eq!(points, expected);
        for mirrored in [DVec2::new(-1.0, 1.0), DVec2::new(1.0, -1.0)] {
            let is_in = |point: &DVec2| points.contains(&(*point * mirrored));
            assert!(points.iter().all(is_in), "{n}");
        }
    }
}

#[test]
fn jittered_has_one_point_in_each_cell() {
    for n in counts() {
        for (seed, pixel) in PLACES {
            let points = points(Method::Jittered, n, seed, pixel);
            let mut first = 0;
            for cells in rows(n) {
                let row = &points[first as usize..(first + cells) as usize];
                assert_one_in_each_cell(row, cells, 1);
                let rows = first..first + cells;
                assert!(row.iter().all(|point| rows.contains(&stratum(point.y, n))));
                first += cells;
            }
        }
    }
}

#[test]
fn rook_methods_have_one_point_in_each_row_and_column() {
    for method in [Method::NRooks, Method::MultiJittered, Method::Hammersley] {
        for n in counts() {
            for (seed, pixel) in PLACES {
                let points = points(method, n, seed, pixel);
                assert_one_in_each_cell(&points, n, 1);
                if method != Method::Hammersley || n.is_power_of_two() {
                    assert_one_in_each_cell(&points, 1, n);
                }
            }
        }
    }
}

#[test]
fn multi_jittered_has_one_point_in_each_cell() {
    for n in counts() {
        let rows = (1..=n).filter(|b| n % b == 0 && b * b <= n).max().unwrap();
        assert_one_in_each_cell(&points(Method::MultiJittered, n, 9, [2, 1]), n / rows, rows);
    }
}

#[test]
fn halton_is_the_shifted_halton_sequence() {
    let n = 4_u64.pow(4) * 3_u64.pow(3);
    let points = points(Method::Halton, n, 0, [3, 5]);
    let origin = points[0];
    // Returns how far a coordinate of a point is beyond the coordinate of the first point, in units
    // of 2^−53, rounded down. A negative distance wraps around: the pixel's side, 1, is added.
    let from = |offset: f64, origin: f64| {
        (((fraction(offset) + (1 << 54) - fraction(origin)) & ((1 << 54) - 1)) >> 1) as u64
    };
    for (i, point) in (0..).zip(&points) {
        let inverse = |base: u64| {
            let (mut rest, mut digits, mut power) = (i, 0, 1);
            while rest > 0 {
                (digits, power, rest) = (digits * base + rest % base, power * base, rest / base);
            }
            ((u128::from(digits) << 53) / u128::from(power)) as u64
        };
        assert!(from(point.x, origin.x).abs_diff(inverse(2)) <= 1);
        assert!(from(point.y, origin.y).abs_diff(inverse(3)) <= 1);
    }
}

#[test]
fn sobol_has_one_point_in_each_elementary_interval() {
    for n in (0..=12).map(|m| 1 << m).chain([5000, 16_384]) {
        for (seed, pixel) in PLACES {
            let points = points(Method::Sobol, n, seed, pixel);
            for m in 0..=n.ilog2() {
                for block in points.chunks_exact(1 << m).take(3) {
                    (0..=m).for_each(|a| assert_one_in_each_cell(block, 1 << a, 1 << (m - a)));
                }
            }
        }
    }
}

#[test]
fn sobol_keeps_its_strata_beyond_2_to_the_32() {
    let sampling = sampling(Method::Sobol, 1 << 41, 0);
    for first in [1_u64 << 32, (1 << 41) - 4096] {
        let mut points = points_at(&sampling, [3, 4], first..first + 4096);
        (0..=12).for_each(|a| assert_one_in_each_cell(&points, 1 << a, 1 << (12 - a)));
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        points.dedup_by_key(|point| point.x);
        assert_eq!(points.len(), 4096);
    }
    let n = 1 << 53;
    let whole = sampling_with_total(Method::Sobol, n, 0, [1, 1]);
    assert_one_in_each_cell(&points_at(&whole, [0, 0], n - 1024..n), 1024, 1);
}

#[test]
fn the_largest_counts_keep_their_strata() {
    // There are too many points to compute all of them. Instead, 3000 points with successive
    // indices, and the last point, must be in different strata.
    for n in [(1 << 53) - 111, 1 << 53, 1 << 33] {
        for method in [Method::NRooks, Method::MultiJittered, Method::Hammersley] {
            let sampling = sampling_with_total(method, n, 4, [1, 1]);
            let parts = [n / 2..n / 2 + 3000, n - 1..n];
            let points = parts
                .map(|part| points_at(&sampling, [0, 0], part))
                .concat();
            let columns: HashSet<_> = points.iter().map(|point| stratum(point.x, n)).collect();
            assert_eq!(columns.len(), 3001);
        }
        for method in Method::SAMPLED {
            let sampling = sampling_with_total(method, n, 4, [1, 1]);
            let points = points_at(&sampling, [0, 0], n - 10..n);
            assert_eq!(points.len(), 10);
            let half = DVec2::splat(0.5);
            let is_inside = |point: &DVec2| point.cmpge(-half).all() && point.cmplt(half).all();
            assert!(points.iter().all(is_inside));
        }
    }
}
