//! The mean of a pixel.

use super::{Case, Claim, inputs::Random, oracle::N, trial::Tally};
use crate::{color::Color, film};

/// The cases.
pub const CASES: &[Case] = &[Case::new(
    "F1",
    "the mean of up to 4096 samples of 4 colours",
    Claim::UlpsAlone(1.0),
    means,
)];

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
        let exact = |x: f64| {
            let x = N::try_from(x).unwrap_or(N::ZERO);
            x.with_precision(256).value()
        };
        let mut sum = exact(0.0);
        for (count, light) in seen {
            sum += exact(count as f64) * exact(light);
        }
        let truth = sum / exact(samples);
        let unit = ours.next_up() - ours;
        let error = |x: f64| (exact(x) - &truth).to_f64().value().abs() / unit;
        tally.inputs += 1;
        tally.errors([error(running), error(ours)]);
    }
}
