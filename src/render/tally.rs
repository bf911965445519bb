//! What a thread counts with: how often each colour was seen in a pixel, and the means that come of
//! such counts.

use crate::{
    film::{self, Encoder, mean},
    sampling::Points,
    tracer::{Nearby, PreparedPixel},
};

/// What a thread counts with.
pub(super) struct Tally<P> {
    pub(super) counts: Counts,
    pub(super) means: Means<P>,
    /// The pixel, prepared.
    pub(super) pixel: PreparedPixel,
    /// Scratch for the points.
    pub(super) points: Points,
    /// Scratch for the objects that may be seen in a pixel, of those nearby.
    pub(super) narrowed: Vec<Nearby>,
}

impl<P> Tally<P> {
    pub(super) fn new(slots: usize) -> Self {
        Self {
            counts: Counts::new(slots),
            means: Means(Vec::new()),
            pixel: PreparedPixel::default(),
            points: Points::default(),
            narrowed: Vec::new(),
        }
    }
}

/// How often each colour was seen in a pixel.
pub(super) struct Counts {
    /// By slot of the palette.
    of: Vec<u64>,
    /// The slots whose count is not 0, in any order. A palette may be long, and a pixel sees
    /// little of it.
    seen: Vec<usize>,
}

impl Counts {
    pub(super) fn new(slots: usize) -> Self {
        Self {
            of: vec![0; slots],
            seen: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, slot: usize, count: u64) {
        if self.of[slot] == 0 {
            self.seen.push(slot);
        }
        self.of[slot] += count;
    }

    /// The slots that were seen, in their order, and how often.
    fn seen(&mut self) -> impl Iterator<Item = (usize, u64)> {
        self.seen.sort_unstable();
        self.seen.iter().map(|&slot| (slot, self.of[slot]))
    }

    fn clear(&mut self) {
        for slot in self.seen.drain(..) {
            self.of[slot] = 0;
        }
    }
}

/// Means of two colours, in the place that their counts choose: most pixels that see more than one
/// see two, and most of these see them as often as some pixel before.
pub(super) struct Means<P>(Vec<([(usize, u64); 2], P)>);

/// How many means are kept: 28 KiB of them, which fit into a first-level cache.
const KEPT: usize = 512;

impl<P: film::Pixel> Means<P> {
    /// The mean of what was counted, which is forgotten.
    pub(super) fn take(
        &mut self,
        counts: &mut Counts,
        colors: &[[f64; 3]],
        encoder: &Encoder,
    ) -> P {
        let pixel = match *counts.seen.as_slice() {
            [slot] => P::of(colors[slot], encoder),
            [a, b] => self.of_two(
                [a.min(b), a.max(b)].map(|slot| (slot, counts.of[slot])),
                colors,
                encoder,
            ),
            _ => {
                let seen = counts.seen();
                P::of(
                    mean(seen.map(|(slot, count)| (count, colors[slot]))),
                    encoder,
                )
            }
        };
        counts.clear();
        pixel
    }

    fn of_two(&mut self, seen: [(usize, u64); 2], colors: &[[f64; 3]], encoder: &Encoder) -> P {
        if self.0.is_empty() {
            // Nothing is seen 0 times.
            self.0.resize(KEPT, ([(0, 0); 2], P::default()));
        }
        let [(a, count), (b, other)] = seen;
        // Any hash will do; odd and prime factors spread counts and slots over the places.
        let place = (count as usize)
            .wrapping_add((other as usize).wrapping_mul(7))
            .wrapping_add(a * 67 + b * 131)
            % KEPT;
        let kept = &mut self.0[place];
        if kept.0 != seen {
            let light = mean(seen.into_iter().map(|(slot, count)| (count, colors[slot])));
            *kept = (seen, P::of(light, encoder));
        }
        kept.1
    }
}
