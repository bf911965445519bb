//! Each method's defining property, exactly: offsets are taken apart with whole numbers.

use glam::DVec2;
use pinhole::{
    area::Area,
    sampling::Sampling,
    scene::{Count, Method, Sampler},
};

/// The counts that every property is tested on: small ones, primes, powers and their neighbours.
fn counts() -> impl Iterator<Item = u64> {
    (1..=72).chain([
        97, 100, 101, 127, 128, 144, 210, 243, 251, 256, 257, 509, 1000, 1024, 4093, 4096, 4097,
        4099,
    ])
}

fn sampling(method: Method, n: u64, seed: u64) -> Sampling {
    let sampler = Sampler {
        method,
        count: Count::PerPixel(n),
        seed,
    };
    Sampling::new(&sampler, 64, 64)
}

/// The points of one pixel.
fn points(method: Method, n: u64, seed: u64, [x, y]: [u32; 2]) -> Vec<DVec2> {
    let mut points = Vec::new();
    sampling(method, n, seed).points(x, y, n, 0..n, &mut points);
    assert_eq!(points.len() as u64, n);
    points
}

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
    for n in [1, 4096, 5000, 65_536] {
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
        let mut points = Vec::new();
        sampling.points(3, 4, 1 << 41, first..first + 4096, &mut points);
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
    let whole = Sampling::new(
        &Sampler {
            method: Method::Sobol,
            count: Count::PerPixel(n),
            seed: 0,
        },
        1,
        1,
    );
    let mut points = Vec::new();
    whole.points(0, 0, n, n - 1024..n, &mut points);
    assert!(each_once(points.iter().map(|point| stratum(point.x, 1024))));
}

#[test]
fn the_largest_counts_keep_their_strata() {
    // Too many to look at each: distinct strata among a run of indices.
    for n in [(1 << 53) - 111, 1 << 53, 1 << 33] {
        let sampler = |method| Sampler {
            method,
            count: Count::PerPixel(n),
            seed: 4,
        };
        for method in [Method::NRooks, Method::MultiJittered, Method::Hammersley] {
            let sampling = Sampling::new(&sampler(method), 1, 1);
            let mut points = Vec::new();
            sampling.points(0, 0, n, n / 2..n / 2 + 3000, &mut points);
            sampling.points(0, 0, n, n - 1..n, &mut points);
            let mut columns: Vec<_> = points.iter().map(|point| stratum(point.x, n)).collect();
            columns.sort_unstable();
            columns.dedup();
            assert_eq!(columns.len(), 3001);
        }
        for method in Method::SAMPLED {
            let sampling = Sampling::new(&sampler(method), 1, 1);
            let mut points = Vec::new();
            sampling.points(0, 0, n, n - 10..n, &mut points);
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

#[test]
fn points_asked_for_in_parts_are_the_same() {
    for method in Method::SAMPLED {
        for n in [1, 7, 16, 100, 5003] {
            let sampling = sampling(method, n, 11);
            let n = sampling.count(9, 8);
            let mut whole = Vec::new();
            sampling.points(9, 8, n, 0..n, &mut whole);
            let mut parts = Vec::new();
            for cut in [0..n / 3, n / 3..n / 3, n / 3..n / 2, n / 2..n] {
                sampling.points(9, 8, n, cut, &mut parts);
            }
            assert_eq!(whole, parts);
        }
    }
}

#[test]
fn seeds_and_pixels_have_points_of_their_own() {
    for method in Method::SAMPLED {
        if matches!(method, Method::Regular) {
            continue;
        }
        let of = |seed, pixel: [u32; 2]| {
            let mut out = Vec::new();
            sampling(method, 5, seed).points(pixel[0], pixel[1], 5, 0..5, &mut out);
            out
        };
        let base = of(1, [3, 4]);
        assert_eq!(base, of(1, [3, 4]));
        for other in [
            of(2, [3, 4]),
            of(1, [4, 3]),
            of(1, [3, 5]),
            of(1 << 52, [3, 4]),
        ] {
            assert!(
                base.iter().all(|point| !other.contains(point)),
                "{method:?}"
            );
        }
    }
}

#[test]
fn all_but_regular_are_unbiased() {
    // For each of some boxes, the mean share of the points within it over many pixels is its area.
    let boxes = [
        (DVec2::new(-0.5, -0.5), DVec2::new(-0.2, 0.1)),
        (DVec2::new(0.13, -0.5), DVec2::new(0.5, 0.5)),
        (DVec2::new(-0.31, 0.22), DVec2::new(0.17, 0.41)),
    ];
    for method in Method::SAMPLED {
        if matches!(method, Method::Regular | Method::Scatter) {
            continue;
        }
        for n in [1, 2, 3, 5, 7, 12, 17] {
            let sampling = sampling(method, n, 1);
            let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
            let mut points = Vec::new();
            for (x, y) in Area::whole(64, 64).iter() {
                points.clear();
                sampling.points(x, y, n, 0..n, &mut points);
                for (i, (min, max)) in boxes.iter().enumerate() {
                    let inside = points
                        .iter()
                        .filter(|point| point.cmpge(*min).all() && point.cmplt(*max).all())
                        .count();
                    let share = inside as f64 / n as f64;
                    sums[i] += share;
                    squares[i] += share * share;
                }
            }
            for (i, (min, max)) in boxes.iter().enumerate() {
                let pixels = 4096.0;
                let area = (*max - *min).element_product();
                let mean = sums[i] / pixels;
                let error = ((squares[i] / pixels - mean * mean) / pixels).sqrt();
                assert!(
                    (mean - area).abs() <= 4.0 * error + 1e-12,
                    "{method:?}, {n}: {mean} for {area} ± {error}"
                );
            }
        }
    }
}

#[test]
fn a_total_is_shared_out_to_the_last_sample() {
    for (width, height) in [(1, 1), (7, 3), (16, 16), (30, 17), (64, 1)] {
        let pixels = u64::from(width) * u64::from(height);
        for method in Method::SAMPLED {
            for total in [
                1,
                2,
                pixels - 1,
                pixels,
                pixels + 1,
                5 * pixels / 2,
                1000 * pixels + 7,
            ] {
                if total == 0 {
                    continue;
                }
                let sampler = Sampler {
                    method,
                    count: Count::Total(total),
                    seed: 2,
                };
                let sampling = Sampling::new(&sampler, width, height);
                let counts = sampling.counts(Area::whole(width, height));
                assert_eq!(counts.iter().sum::<u64>(), total, "{method:?}");
                assert_eq!(sampling.total(), total);
                for ((x, y), &count) in Area::whole(width, height).iter().zip(&counts) {
                    assert_eq!(sampling.count(x, y), count);
                    if method != Method::Scatter {
                        assert!(count == total / pixels || count == total.div_ceil(pixels));
                    }
                    if count <= 2000 {
                        let mut points = Vec::new();
                        sampling.points(x, y, count, 0..count, &mut points);
                        assert_eq!(points.len() as u64, count);
                    }
                }
                let part = Area {
                    x: width / 3,
                    y: height / 3,
                    width: width - width / 3,
                    height: height - height / 3,
                };
                for ((x, y), count) in part.iter().zip(sampling.counts(part)) {
                    assert_eq!(counts[Area::whole(width, height).index(x, y)], count);
                }
            }
        }
    }
}

#[test]
fn the_extra_samples_are_spread_evenly_in_both_directions() {
    let (width, height) = (100, 60);
    for extra in [1, 37, 600, 1500, 3000, 4321, 5999] {
        let sampler = Sampler {
            method: Method::Random,
            count: Count::Total(6000 * 4 + extra),
            seed: 0,
        };
        let sampling = Sampling::new(&sampler, width, height);
        let density = extra as f64 / 6000.0;
        for side in [2, 4, 8, 16, 32] {
            for tile in Area::whole(width, height).tiles(side) {
                let found: u64 = sampling.counts(tile).iter().map(|n| n - 4).sum();
                let expected = density * tile.pixels() as f64;
                assert!((found as f64 - expected).abs() < 1.0, "{extra}: {tile:?}");
            }
        }
    }
}

#[test]
fn half_a_sample_more_is_a_checkerboard_and_not_stripes() {
    let sampler = Sampler {
        method: Method::Random,
        count: Count::Total(64 * 64 / 2),
        seed: 0,
    };
    let sampling = Sampling::new(&sampler, 64, 64);
    let first = sampling.count(0, 0);
    for (x, y) in Area::whole(64, 64).iter() {
        assert_eq!(sampling.count(x, y), first ^ u64::from((x + y) % 2));
    }
}

#[test]
fn scattered_points_fall_like_rain() {
    // 40 × 25 pixels with 20 points each on average: χ² with 999 degrees of freedom, for some seeds.
    let area = Area::whole(40, 25);
    let mut empty = 0;
    for seed in 0..20 {
        let of = |total| {
            let sampler = Sampler {
                method: Method::Scatter,
                count: Count::Total(total),
                seed,
            };
            Sampling::new(&sampler, 40, 25).counts(area)
        };
        let chi2: f64 = of(20_000)
            .iter()
            .map(|&n| (n as f64 - 20.0) * (n as f64 - 20.0) / 20.0)
            .sum();
        assert!(
            (chi2 - 999.0).abs() < 4.0 * (2.0 * 999.0_f64).sqrt(),
            "{chi2}"
        );
        empty += of(1000).iter().filter(|&&n| n == 0).count();
    }
    // With as many points as pixels, a share of 1/e stays empty: 7358 ± 48 of 20 000.
    assert!(empty.abs_diff(7358) < 200, "{empty}");
}

#[test]
fn the_largest_scatter_sums_up() {
    let side = 1 << 20;
    let sampler = Sampler {
        method: Method::Scatter,
        count: Count::Total(1 << 53),
        seed: 0,
    };
    let sampling = Sampling::new(&sampler, side, side);
    let corner = Area {
        x: side - 30,
        y: side - 20,
        width: 30,
        height: 20,
    };
    let counts = sampling.counts(corner);
    // 8192 each on average; the standard deviation of one is 90.5, of the mean of 600 it is 3.7.
    let mean = counts.iter().sum::<u64>() as f64 / 600.0;
    assert!((mean - 8192.0).abs() < 15.0, "{mean}");
    assert!(counts.iter().all(|n| n.abs_diff(8192) < 450));
}

/// The root mean square error of the share of points on one side of a random edge, over many edges and pixels.
fn errors(method: Method, n: u64, edges: &[(DVec2, f64, f64)]) -> f64 {
    let sampling = sampling(method, n, n);
    let mut points = Vec::new();
    let mut sum = 0.0;
    for (i, &(normal, distance, area)) in (0_u32..).zip(edges) {
        points.clear();
        sampling.points(i % 64, i / 64, n, 0..n, &mut points);
        let inside = points
            .iter()
            .filter(|point| point.dot(normal) < distance)
            .count();
        let error = inside as f64 / n as f64 - area;
        sum += error * error;
    }
    (sum / edges.len() as f64).sqrt()
}

/// The area of the part of the pixel where normal · p < distance, by clipping.
fn area(normal: DVec2, distance: f64) -> f64 {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(DVec2::from);
    let mut clipped = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % 4];
        let (da, db) = (a.dot(normal) - distance, b.dot(normal) - distance);
        if da < 0.0 {
            clipped.push(a);
        }
        if (da < 0.0) != (db < 0.0) {
            clipped.push(a + (b - a) * (da / (da - db)));
        }
    }
    let next = clipped.iter().cycle().skip(1);
    clipped
        .iter()
        .zip(next)
        .map(|(a, b)| a.perp_dot(*b))
        .sum::<f64>()
        / 2.0
}

/// Edges at random angles through a random point of the pixel, or parallel to an axis.
fn edges(parallel: bool) -> Vec<(DVec2, f64, f64)> {
    let points = points(Method::Random, 4 * 900, 123, [1, 1]);
    points
        .chunks_exact(2)
        .enumerate()
        .take(if parallel { 1200 } else { 1800 })
        .map(|(i, pair)| {
            let normal = match (parallel, i % 2) {
                (true, 0) => DVec2::X,
                (true, _) => DVec2::Y,
                (false, _) => {
                    let angle = (pair[0].x + 0.5) * std::f64::consts::TAU;
                    DVec2::new(libm::cos(angle), libm::sin(angle))
                }
            };
            let distance = pair[1].dot(normal);
            (normal, distance, area(normal, distance))
        })
        .collect()
}

#[test]
fn errors_fall_as_fast_as_they_should() {
    // The error at 16, 256 and 4096 points and the slope of its logarithm, for edges at random angles and for edges parallel to an axis:
    // −1/2 for independent points, −3/4 where cells hold one point each (Mitchell 1996; He and Owen 2014), −1 where rows and columns do and
    // the edge is parallel to them (Singh and Jarosz 2017). The constants are measured; those of `random` are √(area·(1 − area)/n).
    #[rustfmt::skip]
    let table = [
        (Method::Random, [1.0e-1, 2.6e-2, 6.4e-3], -0.50, [1.0e-1, 2.6e-2, 6.4e-3], -0.50),
        (Method::Regular, [3.4e-2, 4.6e-3, 5.0e-4], -0.76, [7.1e-2, 1.8e-2, 4.5e-3], -0.50),
        (Method::Jittered, [5.1e-2, 6.1e-3, 7.7e-4], -0.76, [5.2e-2, 6.2e-3, 7.9e-4], -0.75),
        (Method::NRooks, [5.1e-2, 1.2e-2, 3.0e-3], -0.53, [2.5e-2, 1.6e-3, 1.0e-4], -1.00),
        (Method::MultiJittered, [4.0e-2, 4.7e-3, 5.9e-4], -0.76, [2.5e-2, 1.6e-3, 1.0e-4], -1.00),
        (Method::Hammersley, [4.9e-2, 5.5e-3, 6.2e-4], -0.79, [2.8e-2, 1.8e-3, 1.1e-4], -1.00),
        (Method::Halton, [4.9e-2, 6.3e-3, 8.2e-4], -0.74, [2.9e-2, 2.2e-3, 1.5e-4], -0.96),
        (Method::Sobol, [4.3e-2, 5.3e-3, 6.6e-4], -0.76, [2.5e-2, 1.6e-3, 1.0e-4], -1.00),
    ];
    for (method, slanted, slanted_slope, parallel, parallel_slope) in table {
        for (edges, expected, expected_slope) in [
            (edges(false), slanted, slanted_slope),
            (edges(true), parallel, parallel_slope),
        ] {
            let found = [16, 64, 256, 1024, 4096].map(|n| errors(method, n, &edges));
            // The slope of the least squares line through five equidistant logarithms.
            let weights = [-2.0, -1.0, 0.0, 1.0, 2.0];
            let slope: f64 = weights
                .iter()
                .zip(found)
                .map(|(weight, error)| weight * libm::log(error) / libm::log(4.0))
                .sum::<f64>()
                / 10.0;
            let case = format!("{method:?}: {found:?} for {expected:?}, slope {slope}");
            assert!((slope - expected_slope).abs() < 0.05, "{case}");
            for (found, expected) in [found[0], found[2], found[4]].into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 0.2, "{case}");
            }
        }
    }
}

#[test]
fn points_stay_where_they_are() {
    // The eighth point of a pixel, for the pictures that exist already, and for machines other than the one these come from.
    let expected = [
        DVec2::new(0.375, -0.125),
        DVec2::new(-0.48383530042028894, -0.350440702956024),
        DVec2::new(0.33086413552618416, -0.18731122673749362),
        DVec2::new(-0.026261189472254698, 0.332904757088134),
        DVec2::new(0.3498635108001498, -0.24466788748163554),
        DVec2::new(0.4249939274401054, 0.3896316565772859),
        DVec2::new(-0.37638754450630624, 0.44938597023759236),
        DVec2::new(0.29140786374970445, 0.38167815445024017),
        DVec2::new(0.49924405020095936, -0.3561122876778888),
    ];
    for (method, point) in Method::SAMPLED.into_iter().zip(expected) {
        let sampler = Sampler {
            method,
            count: Count::Total(64 * 64 * 16 + 1000),
            seed: 5,
        };
        let sampling = Sampling::new(&sampler, 64, 64);
        let count = sampling.count(20, 30);
        let mut points = Vec::new();
        sampling.points(20, 30, count, 0..count, &mut points);
        assert_eq!((count, points[7]), (16, point), "{method:?}");
    }
}
