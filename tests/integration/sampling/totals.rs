//! Tests of the distribution of a total number of samples among the pixels: equally, or at random
//! by the method `scatter`.

use super::*;

#[test]
fn a_total_is_distributed_exactly_among_the_pixels() {
    for (width, height) in [(1, 1), (7, 3), (16, 16), (30, 17), (64, 1)] {
        let whole = Area::whole(width, height);
        let pixels = whole.pixels();
        for method in Method::SAMPLED {
            let around = [pixels.max(2) - 1, pixels, pixels + 1, 5 * pixels / 2];
            for total in [1, 2, 1000 * pixels + 7].into_iter().chain(around) {
                let sampling = sampling_with_total(method, total, 2, [width, height]);
                let counts = sampling.counts(whole);
                assert_eq!(counts.iter().sum::<u64>(), total, "{method:?}");
                assert_eq!(sampling.total(), total);
                for ((x, y), &count) in whole.iter().zip(&counts) {
                    assert_eq!(sampling.count(x, y), count);
                    if method != Method::Scatter {
                        assert!(count == total / pixels || count == total.div_ceil(pixels));
                    }
                    if count <= 2000 {
                        let points = points_at(&sampling, [x, y], 0..count);
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
                    assert_eq!(counts[whole.index(x, y)], count);
                }
            }
        }
    }
}

#[test]
fn the_extra_samples_are_spread_evenly_in_both_directions() {
    let (width, height) = (100, 60);
    for extra in [1, 37, 600, 1500, 3000, 4321, 5999] {
        let sampling = sampling_with_total(Method::Random, 6000 * 4 + extra, 0, [width, height]);
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
fn the_last_pixel_of_the_largest_picture_gets_the_extra_sample() {
    let side = 1 << 20;
    // The total is one more than a multiple of the number of pixels, so one pixel gets an extra
    // sample. This is the last pixel of the Hilbert curve. The curve ends in the top right corner.
    let sampling = sampling_with_total(Method::Random, (1 << 40) + 1, 0, [side, side]);
    let corners = [(0, 0), (0, side - 1), (side - 1, side - 1), (side - 1, 0)];
    assert_eq!(corners.map(|(x, y)| sampling.count(x, y)), [1, 1, 1, 2]);
}

#[test]
fn half_a_sample_per_pixel_gives_a_checkerboard() {
    let sampling = sampling_with_total(Method::Random, 64 * 64 / 2, 0, [64, 64]);
    let first = sampling.count(0, 0);
    for (x, y) in Area::whole(64, 64).iter() {
        assert_eq!(sampling.count(x, y), first ^ u64::from((x + y) % 2));
    }
}

#[test]
fn scattered_counts_follow_the_poisson_distribution() {
    // The numbers of points in the 1000 pixels (40 × 25) add up to 20 000, so the χ² statistic has
    // 999 degrees of freedom. It is computed for several seeds.
    let area = Area::whole(40, 25);
    let mut empty = 0;
    for seed in 0..20 {
        let of = |total| sampling_with_total(Method::Scatter, total, seed, [40, 25]).counts(area);
        let counts = of(20_000);
        let terms = counts
            .iter()
            .map(|&n| (n as f64 - 20.0) * (n as f64 - 20.0) / 20.0);
        let chi2: f64 = terms.sum();
        let most = 4.0 * (2.0 * 999.0_f64).sqrt();
        assert!((chi2 - 999.0).abs() < most, "{chi2}");
        empty += of(1000).iter().filter(|&&n| n == 0).count();
    }
    // If there are as many points as pixels, a fraction of 1/e of the pixels is empty. Of 20 000
    // pixels, these are 7358, with a standard deviation of 48. The assertion allows about four
    // standard deviations.
    assert!(empty.abs_diff(7358) < 200, "{empty}");
}

#[test]
fn the_largest_scatter_has_the_expected_mean_count() {
    let side = 1 << 20;
    let sampling = sampling_with_total(Method::Scatter, 1 << 53, 0, [side, side]);
    let corner = Area {
        x: side - 30,
        y: side - 20,
        width: 30,
        height: 20,
    };
    let counts = sampling.counts(corner);
    // A pixel has 8192 points on average. The standard deviation is 90.5 for the number in one
    // pixel, and 3.7 for the mean number in 600 pixels.
    let mean = counts.iter().sum::<u64>() as f64 / 600.0;
    assert!((mean - 8192.0).abs() < 15.0, "{mean}");
    assert!(counts.iter().all(|n| n.abs_diff(8192) < 450));
}
