//! Each method's defining property.

mod errors;
mod strata;
mod totals;

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
        let expected = match method {
            Method::Scatter => 14,
            _ => 16,
        };
        assert_eq!((count, points[7]), (expected, point), "{method:?}");
    }
}
