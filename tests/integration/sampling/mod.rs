//! Tests of the defining property of each sampling method.

mod errors;
mod strata;
mod tilings;
mod totals;

use std::ops::Range;

use glam::DVec2;
use pinhole::{
    area::Area,
    math::SimdWidth,
    sampling::{Points, Sampling},
    scene::{Count, Method, Sampler},
};

/// Returns the numbers of samples per pixel for which properties are tested: small numbers, primes,
/// powers, and neighbours of powers.
fn counts() -> impl Iterator<Item = u64> {
    (1..=72).chain([
        97, 100, 101, 127, 128, 144, 210, 243, 251, 256, 257, 509, 1000, 1024, 4093, 4096, 4097,
        4099,
    ])
}

fn sampling(method: Method, n: u64, seed: u64) -> Sampling {
    sampling_with_total(method, 64 * 64 * n, seed, [64, 64])
}

/// Returns the sampling of a picture with `total` samples in the whole picture.
fn sampling_with_total(
    method: Method,
    total: u64,
    seed: u64,
    [width, height]: [u32; 2],
) -> Sampling {
    let count = Count::Total(total);
    let sampler = Sampler {
        method,
        count,
        seed,
    };
    Sampling::new(&sampler, width, height)
}

/// Returns those sample points of the pixel (x, y) whose indices are in `indices`.
pub fn points_at(sampling: &Sampling, [x, y]: [u32; 2], indices: Range<u64>) -> Vec<DVec2> {
    let mut points = Points::default();
    let count = sampling.count(x, y);
    sampling.place(SimdWidth::Widest, [x, y], count, indices, &mut points);
    points.iter().collect()
}

/// Returns all sample points of the pixel (x, y) of a picture with `n` samples per pixel.
fn points(method: Method, n: u64, seed: u64, [x, y]: [u32; 2]) -> Vec<DVec2> {
    let points = points_at(&sampling(method, n, seed), [x, y], 0..n);
    assert_eq!(points.len() as u64, n);
    points
}

#[test]
fn points_asked_for_in_parts_are_the_same() {
    for method in Method::SAMPLED {
        for n in [1, 7, 16, 100, 5003] {
            let sampling = sampling(method, n, 11);
            let n = sampling.count(9, 8);
            let whole = points_at(&sampling, [9, 8], 0..n);
            let parts = [0..n / 3, n / 3..n / 3, n / 3..n / 2, n / 2..n];
            let parts = parts.map(|part| points_at(&sampling, [9, 8], part));
            assert_eq!(whole, parts.concat());
        }
    }
}

#[test]
fn seeds_and_pixels_share_no_points() {
    for method in Method::SAMPLED {
        if matches!(method, Method::Regular) {
            continue;
        }
        // The method `scatter` gives different pixels different numbers of points, so the number is
        // determined for each pixel.
        let of = |seed, pixel: [u32; 2]| {
            let sampling = sampling(method, 5, seed);
            points_at(&sampling, pixel, 0..sampling.count(pixel[0], pixel[1]))
        };
        let base = of(1, [3, 4]);
        assert_eq!(base, of(1, [3, 4]));
        for (seed, pixel) in [(2, [3, 4]), (1, [4, 3]), (1, [3, 5]), (1 << 52, [3, 4])] {
            let other = of(seed, pixel);
            let is_own = base.iter().all(|point| !other.contains(point));
            assert!(is_own, "{method:?}");
        }
    }
}

#[test]
fn sample_points_match_stored_values() {
    // The eighth point of a pixel must be equal on all machines and in all versions, so that
    // pictures do not change.
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
        let sampling = sampling_with_total(method, 64 * 64 * 16 + 1000, 5, [64, 64]);
        let count = sampling.count(20, 30);
        let points = points_at(&sampling, [20, 30], 0..count);
        let expected = match method {
            Method::Scatter => 14,
            _ => 16,
        };
        assert_eq!((count, points[7]), (expected, point), "{method:?}");
    }
}
