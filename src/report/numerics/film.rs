//! The mean of a pixel, and its byte.

use super::{Case, Claim, inputs::Random, oracle::N, trial::Tally};
use crate::{
    color::{Color, linear_to_srgb, srgb_to_linear},
    film::{self, Encoder},
};

/// The cases.
pub const CASES: &[Case] = &[
    Case::new(
        "F1",
        "the mean of up to 4096 samples of 4 colours",
        Claim::UlpsAlone(1.0),
        means,
    ),
    Case::new(
        "F2",
        "8-bit rounding close to a step",
        Claim::Decisions,
        bytes,
    ),
];

/// Counts of colours against a running mean, the samples in the order of the colours.
fn means(random: &mut Random, count: u64, tally: &mut Tally) {
    for _ in 0..count {
        let seen = [0; 4].map(|_: u32| {
            let byte = random.below(256) as u8;
            let light = Color::from_bytes([byte; 3]).to_linear()[0];
            let most = 1 << random.below(11);
            (1 + random.below(most), light)
        });
        let mut running = 0.0;
        let mut samples = 0.0;
        for (count, light) in seen {
            for _ in 0..count {
                samples += 1.0;
                running += (light - running) / samples;
            }
        }
        let [ours, ..] = film::mean(seen.map(|(count, light)| (count, [light; 3])).into_iter());
        let exact = |x| exact(x, 256);
        let mut sum = exact(0.0);
        for (count, light) in seen {
            sum += exact(count as f64) * exact(light);
        }
        let truth = sum / exact(samples);
        let unit = ours.next_up() - ours;
        let error = |x: f64| (exact(x) - &truth).to_f64().value().abs() / unit;
        tally.inputs += 1;
        tally.errors([error(running), error(ours)].map(Some));
    }
}

/// The byte of light close to that of k + 1/2, against the curve of sRGB in f64, rounded.
fn bytes(random: &mut Random, count: u64, tally: &mut Tally) {
    let encoder = Encoder::new();
    for at in 0..count {
        let half = srgb_to_linear((random.below(255) as f64 + 0.5) / 255.0);
        let ulps = match at % 12 {
            near @ 0..8 => near as f64 - 4.0,
            _ => random.sign() * libm::exp2(random.within(1.0, 48.0)).floor(),
        };
        let light = half + ulps * (half.next_up() - half);
        let textbook = (255.0 * linear_to_srgb(light)).round() as u8;
        let truth = nearest_byte(light, textbook);
        tally.inputs += 1;
        tally.wrong[0] += u64::from(textbook != truth);
        tally.wrong[1] += u64::from(encoder.encode(light) != truth);
    }
}

/// The byte nearest to light, and a byte near it: the standard's curve 1.055 L^(1/2.4) − 0.055, where it holds, raised to the power of 12.
/// Every product has all its bits.
fn nearest_byte(light: f64, near: u8) -> u8 {
    let exact = |x: f64| exact(x, 2048);
    let powers = |x: N, count: u32| (1..count).fold(x.clone(), |power, _| power * &x);
    let is_above_half = |byte: u8| {
        let halves = 2.0 * f64::from(byte) + 1.0;
        if light <= 0.003_130_8 {
            // 12.92 L ≥ halves/510
            exact(light) * exact(658_920.0) >= exact(100.0 * halves)
        } else {
            // 1.055^12 L^5 ≥ (halves/510 + 0.055)^12, both times (1000 · 510)^12
            let curve = powers(exact(light), 5) * powers(exact(1055.0 * 510.0), 12);
            curve >= powers(exact(1000.0 * halves + 55.0 * 510.0), 12)
        }
    };
    let mut byte = near;
    while byte < 255 && is_above_half(byte) {
        byte += 1;
    }
    while byte > 0 && !is_above_half(byte - 1) {
        byte -= 1;
    }
    byte
}

/// A number with room for so many bits.
fn exact(x: f64, bits: usize) -> N {
    let x = N::try_from(x).unwrap_or(N::ZERO);
    x.with_precision(bits).value()
}
