//! Tests of the light of a pixel: the mean of its samples, and its encoding as bytes.

use pinhole::{
    color::{Color, half_byte},
    film::{Encoder, mean},
    math::{Double, Real, two_product},
    sampling::CounterRng,
};
use rand::{Rng, RngExt, SeedableRng};

use super::encoded;

#[test]
fn the_mean_of_equal_samples_is_their_colour() {
    for bytes in 0..=255 {
        let color = Color::from_bytes([bytes, 255 - bytes, 1]).to_linear();
        for count in [1, 3, 7, 16, 1_000_003, (1 << 53) - 1, 1 << 53] {
            assert_eq!(mean([(count, color)].into_iter()), color);
        }
    }
}

#[test]
fn a_mean_equals_the_quotient_in_extended_precision() {
    let mut rng = CounterRng::seed_from_u64(1);
    for round in 0..100_000 {
        let seen = [0; 3].map(|_: u32| {
            let count = rng.next_u64() >> 13 >> (rng.next_u64() % 51);
            let light = match round % 3 {
                0 => [1.0; 3],
                1 => [f64::from(rng.next_u32() % 256) / 256.0; 3],
                _ => [0; 3].map(|_: u32| rng.random::<f64>()),
            };
            (count.max(1), light)
        });
        let samples: u64 = seen.iter().map(|(count, _)| count).sum();
        let long = [0, 1, 2].map(|channel| {
            let terms = seen.map(|(count, light)| two_product(count as f64, light[channel]));
            let sum = terms[0].plus(&terms[1]).plus(&terms[2]);
            sum.over(&Double::from_f64(samples as f64)).to_f64()
        });
        assert_eq!(mean(seen.into_iter()), long, "{seen:?}");
    }
}

#[test]
fn a_mean_is_rounded_once() {
    // The mean is (3 · 0.1 + 7 · 0.3) / 10. As doubles, 0.1 is too large by 5.6e-18, and 0.3 is too
    // small by 11.1e-18. So the exact mean of the doubles is 0.24 − 6.1e-18. Doubles near 0.24 are
    // 28e-18 apart, so the double nearest to this mean is also the one nearest to 0.24.
    let found = mean([(3, [0.1; 3]), (7, [0.3; 3])].into_iter());
    assert_eq!(found, [0.24; 3]);
    // All of the 2^53 samples are white except one, which is black. So the mean is exactly 1 −
    // 2^−53, the largest double below 1.
    let found = mean([((1 << 53) - 1, [1.0; 3]), (1, [0.0; 3])].into_iter());
    assert_eq!(found, [1.0 - f64::EPSILON / 2.0; 3]);
}

#[test]
fn encoding_linear_light_returns_the_bytes_of_its_colour() {
    let encoder = Encoder::default();
    for step in 0..=255 * 64 {
        let channel = f64::from(step) / 64.0;
        let color = Color { srgb: [channel; 3] };
        let bytes = encoder.pixel(color.to_linear());
        assert_eq!(bytes, color.to_bytes(), "{channel}");
    }
}

#[test]
fn encoding_rounds_every_light_to_the_nearest_byte() {
    let encoder = Encoder::default();
    for step in 0..=200_000 {
        let light = f64::from(step) / 200_000.0;
        let error = (255.0 * encoded(light) - f64::from(encoder.encode(light))).abs();
        assert!(error < 0.5 + 1e-5, "{light}: off by {error}");
    }
    for k in 0..255_u8 {
        let light = half_byte(k);
        let around = [light.next_down(), light, light.next_up()];
        let bytes = around.map(|light| encoder.encode(light));
        assert_eq!(bytes, [k, k + 1, k + 1]);
    }
    assert_eq!([-1.0, 2.0].map(|light| encoder.encode(light)), [0, 255]);
}
