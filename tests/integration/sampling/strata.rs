//! Where points lie: each method's strata, offsets taken apart with whole numbers.

use super::*;

/// Which of n strata an offset lies in: ⌊(offset + 1/2)·n⌋, without rounding.
fn stratum(offset: f64, n: u64) -> u64 {
    ((fraction(offset) * u128::from(n)) >> 54) as u64
}

/// offset + 1/2 in units of 2^−54. Every offset but the regular ones is a whole number of them.
fn fraction(offset: f64) -> u128 {
    assert!((-0.5..0.5).contains(&offset), "{offset}");
    let scaled = offset * (1_u64 << 54) as f64;
    assert_eq!(scaled, scaled.floor());
    (scaled as i64 + (1 << 53)) as u128
}

/// Whether these numbers are 0, 1 … in some order.
fn each_once(numbers: impl Iterator<Item = u64>) -> bool {
    let mut numbers: Vec<_> = numbers.collect();
    numbers.sort_unstable();
    numbers.iter().enumerate().all(|(i, &n)| i as u64 == n)
}

/// The lengths of the rows of `n` cells, as the reference describes them.
fn rows(n: u64) -> Vec<u64> {
    let root = (n as f64).sqrt();
    let count = (1..=n)
        .filter(|rows| n.is_multiple_of(2) || rows % 2 == 1)
        .min_by(|a, b| f64::total_cmp(&(*a as f64 - root).abs(), &(*b as f64 - root).abs()))
        .unwrap();
    let points = points(Method::Regular, n, 0, [0, 0]);
    let mut rows: Vec<u64> = Vec::new();
    let mut last = f64::NAN;
    for point in points {
        if point.y == last {
            *rows.last_mut().unwrap() += 1;
        } else {
            rows.push(1);
            last = point.y;
        }
    }
    assert_eq!(rows.len() as u64, count, "{n}");
    rows
}

#[test]
fn rows_of_cells_are_as_even_as_they_can_be() {
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
    for n in counts() {
        let points = points(Method::Regular, n, 0, [5, 7]);
        let mut first = 0;
        for cells in rows(n) {
            for i in 0..cells {
                let point = points[(first + i) as usize];
                let middle = |first: u64, parts: u64, n: u64| {
                    (2.0 * first as f64 + parts as f64 - n as f64) / (2.0 * n as f64)
                };
                assert_eq!(point.x, middle(i, 1, cells));
                assert_eq!(point.y, middle(first, cells, n));
            }
            first += cells;
        }
        for mirrored in [DVec2::new(-1.0, 1.0), DVec2::new(1.0, -1.0)] {
            for &point in &points {
                assert!(points.contains(&(point * mirrored)), "{n}: {point}");
            }
        }
    }
}

#[test]
fn jittered_has_one_point_in_each_cell() {
    for n in counts() {
        for (seed, pixel) in [(0, [0, 0]), (1, [3, 5]), (2, [63, 63])] {
            let mut points = points(Method::Jittered, n, seed, pixel).into_iter();
            let mut first = 0;
            for cells in rows(n) {
                let row: Vec<_> = points.by_ref().take(cells as usize).collect();
                assert!(each_once(row.iter().map(|point| stratum(point.x, cells))));
                assert!(
                    row.iter()
                        .all(|point| (first..first + cells).contains(&stratum(point.y, n)))
                );
                first += cells;
            }
        }
    }
}

#[test]
fn rooks_do_not_take_each_other() {
    for method in [Method::NRooks, Method::MultiJittered] {
        for n in counts() {
            for (seed, pixel) in [(0, [0, 0]), (1, [3, 5]), (2, [63, 63])] {
                let points = points(method, n, seed, pixel);
                assert!(each_once(points.iter().map(|point| stratum(point.x, n))));
                assert!(each_once(points.iter().map(|point| stratum(point.y, n))));
            }
        }
    }
}

#[test]
fn multi_jittered_has_one_point_in_each_cell_too() {
    for n in counts() {
        let rows = (1..=n).filter(|b| n % b == 0 && b * b <= n).max().unwrap();
        let columns = n / rows;
        let points = points(Method::MultiJittered, n, 9, [2, 1]);
        assert!(each_once(points.iter().map(|point| {
            stratum(point.y, rows) * columns + stratum(point.x, columns)
        })));
    }
}

#[test]
fn hammersley_keeps_one_point_in_each_column() {
    for n in counts() {
        for pixel in [[0, 0], [3, 5], [63, 63]] {
            let points = points(Method::Hammersley, n, 0, pixel);
            assert!(each_once(points.iter().map(|point| stratum(point.x, n))));
            if n.is_power_of_two() {
                assert!(each_once(points.iter().map(|point| stratum(point.y, n))));
            }
        }
    }
}

#[test]
fn halton_is_its_sequence_shifted() {
    let n = 4_u64.pow(4) * 3_u64.pow(3);
    let points = points(Method::Halton, n, 0, [3, 5]);
    let origin = points[0];
    // The distance from the first point, around the edge, in 2^−53, give or take one.
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
    // Elementary boxes of the first 2^a·3^b points, once the shift is undone.
    for (a, b) in [(1, 1), (3, 2), (4, 2), (5, 3), (8, 3)] {
        let (columns, rows) = (2_u64.pow(a), 3_u64.pow(b));
        assert!(each_once(
            points.iter().take((columns * rows) as usize).map(|point| {
                let place = |offset, origin, n: u64| {
                    // Two are added, since a value on an interval's edge may have come out one or two below it.
                    (((u128::from(from(offset, origin)) + 2) * u128::from(n)) >> 53) as u64 % n
                };
                place(point.y, origin.y, rows) * columns + place(point.x, origin.x, columns)
            })
        ));
    }
}

#[test]
fn sobol_has_one_point_in_each_elementary_interval() {
    for n in [1, 4096, 5000, 16_384] {
        for (seed, pixel) in [(0, [0, 0]), (1, [3, 5]), (2, [63, 63])] {
            let points = points(Method::Sobol, n, seed, pixel);
            for m in 0..=n.ilog2() {
                for block in points.chunks_exact(1 << m).take(3) {
                    for a in 0..=m {
                        let (columns, rows) = (1 << a, 1 << (m - a));
                        assert!(each_once(block.iter().map(|point| {
                            stratum(point.y, rows) * columns + stratum(point.x, columns)
                        })));
                    }
                }
            }
        }
    }
    for m in 0..=12 {
        let n = 1 << m;
        let points = points(Method::Sobol, n, 3, [1, 2]);
        assert!(each_once(points.iter().map(|point| stratum(point.x, n))));
        assert!(each_once(points.iter().map(|point| stratum(point.y, n))));
    }
}

#[test]
fn sobol_goes_on_beyond_2_to_the_32() {
    let n = 1 << 53;
    let sampling = sampling(Method::Sobol, 1 << 41, 0);
    for first in [1_u64 << 32, (1 << 41) - 4096] {
        let mut points = placed(&sampling, [3, 4], first..first + 4096);
        for a in 0..=12 {
            let (columns, rows) = (1 << a, 1 << (12 - a));
            assert!(each_once(points.iter().map(|point| {
                stratum(point.y, rows) * columns + stratum(point.x, columns)
            })));
        }
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        points.dedup_by_key(|point| point.x);
        assert_eq!(points.len(), 4096);
    }
    let whole = shared(Method::Sobol, n, 0, [1, 1]);
    let points = placed(&whole, [0, 0], n - 1024..n);
    assert!(each_once(points.iter().map(|point| stratum(point.x, 1024))));
}

#[test]
fn the_largest_counts_keep_their_strata() {
    // Too many to look at each: distinct strata among a run of indices.
    for n in [(1 << 53) - 111, 1 << 53, 1 << 33] {
        for method in [Method::NRooks, Method::MultiJittered, Method::Hammersley] {
            let sampling = shared(method, n, 4, [1, 1]);
            let points =
                [n / 2..n / 2 + 3000, n - 1..n].map(|part| placed(&sampling, [0, 0], part));
            let mut columns: Vec<_> = points
                .iter()
                .flatten()
                .map(|point| stratum(point.x, n))
                .collect();
            columns.sort_unstable();
            columns.dedup();
            assert_eq!(columns.len(), 3001);
        }
        for method in Method::SAMPLED {
            let sampling = shared(method, n, 4, [1, 1]);
            let points = placed(&sampling, [0, 0], n - 10..n);
            assert_eq!(points.len(), 10);
            assert!(
                points
                    .iter()
                    .all(|point| point.cmpge(DVec2::splat(-0.5)).all()
                        && point.cmplt(DVec2::splat(0.5)).all())
            );
        }
    }
}
