//! The tiles of a picture with samples.
//!
//! A pixel's samples are counted by colour, and counts know no order. Where it is certain that one
//! colour is seen, samples are neither placed nor traced: the mean of equal colours is that colour.
//! In the other pixels they are traced many at a time, and against those objects alone that may be
//! seen there; or one by one, where to know more would cost more.

use std::{
    ops::{ControlFlow, Range},
    sync::atomic::Ordering,
};

use super::{
    Control,
    tally::Tally,
    tile::{Samples, Tile},
};
use crate::{
    area::Area,
    film::{self, Encoder},
    math::SimdWidth,
    sampling::Sampling,
    tracer::{Candidate, Checks, Nearby, Part, Quartering, Scratch, World, nearby, samples},
};

/// Fewer samples than the widest vectors have numbers are placed and looked at by those that every
/// processor has.
const WIDE_SAMPLES: u64 = 8;

/// A pixel is prepared for its samples if it has more than so many for each candidate. Measured:
/// with 1 or 4 a picture takes up to a fiftieth longer.
const SAMPLES_A_CANDIDATE: u64 = 2;

/// A pixel's samples are taken so many at a time, which takes 40 µs together and 0.3 ms one by one.
const SAMPLES_A_CHUNK: u64 = 1 << 12;

/// Where there are crowds, the objects nearby are found for squares of this side, in pixels.
const CROWD_SIDE: u32 = 4;

/// With so many samples, a pixel's objects are told from those nearby before they are traced.
const SAMPLES_WORTH_A_LOOK: u64 = 3;

/// What all tiles have in common.
pub(super) struct Renderer<'a, P> {
    pub(super) world: &'a World,
    pub(super) sampling: &'a Sampling,
    /// Of the palette, in linear light.
    pub(super) colors: &'a [[f64; 3]],
    /// The same as the film has them.
    pub(super) shown: &'a [P],
    pub(super) encoder: &'a Encoder,
    pub(super) control: &'a Control<'a>,
    pub(super) quartering: Quartering<'a>,
}

impl<P: film::Pixel> Renderer<'_, P> {
    /// The pixels of a tile, row by row; none once the render is cancelled.
    pub(super) fn tile(
        &self,
        tile: Area,
        tally: &mut Tally<P>,
        scratch: &mut Scratch,
    ) -> Option<Vec<P>> {
        let background = self.shown[self.world.background()];
        let mut film = Tile {
            area: tile,
            samples: match self.sampling.same_count() {
                Some(count) => Samples::Same(count),
                None => Samples::Each(self.sampling.counts(tile)),
            },
            // A pixel without a sample shows the background.
            pixels: vec![background; tile.pixels() as usize],
            unreported: 0,
        };
        let mut visit = |part: Part| match part {
            Part::OneColor { area, slot } => {
                film.fill(area, self.shown[slot]);
                self.go_on()
            }
            Part::Pixel {
                x,
                y,
                candidates,
                checks,
            } => self.pixel(
                [x, y],
                Trace::Together(candidates, checks),
                &mut film,
                tally,
            ),
            Part::Crowded { area } => area.grid(CROWD_SIDE).try_for_each(|square| {
                let nearby = nearby::nearby(self.world, square);
                let trace = Trace::OneByOne(nearby.as_deref());
                let mut pixels = square.common(area).iter();
                pixels.try_for_each(|(x, y)| self.pixel([x, y], trace, &mut film, tally))
            }),
        };
        let flow = self.quartering.parts(tile, scratch, &mut visit);
        (self.control.progress)(film.unreported);
        flow.is_continue().then_some(film.pixels)
    }

    /// Whether anybody wants to see more.
    fn go_on(&self) -> ControlFlow<()> {
        match self.control.cancel.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Takes the samples of a pixel.
    fn pixel(
        &self,
        [x, y]: [u32; 2],
        trace: Trace,
        film: &mut Tile<P>,
        tally: &mut Tally<P>,
    ) -> ControlFlow<()> {
        let index = film.area.index(x, y);
        let samples = film.samples.of(index);
        if samples == 0 {
            return self.go_on();
        }
        let trace = match trace {
            // To prepare the pixel would take longer.
            Trace::Together(candidates, _)
                if samples <= SAMPLES_A_CANDIDATE * candidates.len() as u64 =>
            {
                Trace::Among(candidates)
            }
            _ => trace,
        };
        let mut narrowed = std::mem::take(&mut tally.narrowed);
        let trace = match trace {
            Trace::OneByOne(Some(nearby)) if samples >= SAMPLES_WORTH_A_LOOK => {
                let pixel = Area::pixel(x, y);
                if let Some(slot) = nearby::in_part(self.world, pixel, nearby, &mut narrowed) {
                    tally.narrowed = narrowed;
                    film.fill(pixel, self.shown[slot]);
                    return self.go_on();
                }
                Trace::OneByOne(Some(&narrowed))
            }
            _ => trace,
        };
        if let Trace::Together(candidates, checks) = trace {
            samples::prepare(self.world, [x, y], candidates, checks, &mut tally.pixel);
        }
        for first in (0..samples).step_by(SAMPLES_A_CHUNK as usize) {
            let end = samples.min(first + SAMPLES_A_CHUNK);
            self.chunk([x, y], samples, first..end, trace, tally);
            film.unreported += end - first;
            if film.unreported >= SAMPLES_A_CHUNK {
                (self.control.progress)(std::mem::take(&mut film.unreported));
            }
            self.go_on()?;
        }
        tally.narrowed = narrowed;
        let Tally { counts, means, .. } = tally;
        film.pixels[index] = means.take(counts, self.colors, self.encoder);
        self.go_on()
    }

    /// Counts some of a pixel's samples.
    fn chunk(
        &self,
        [x, y]: [u32; 2],
        samples: u64,
        some: Range<u64>,
        trace: Trace,
        tally: &mut Tally<P>,
    ) {
        let Tally {
            counts,
            pixel,
            points,
            ..
        } = tally;
        let vectors = match trace {
            Trace::Together(..) if some.end - some.start >= WIDE_SAMPLES => SimdWidth::Widest,
            // To choose others takes longer, and rays that are traced one by one afterwards are
            // slower for it.
            _ => SimdWidth::Baseline,
        };
        self.sampling.place(vectors, [x, y], samples, some, points);
        // One by one, each may take its time.
        let wanted = points.iter().take_while(|_| self.go_on().is_continue());
        match trace {
            Trace::Together(..) => samples::count(
                self.world,
                pixel,
                points.lanes(),
                points.len(),
                vectors,
                |slot, samples| counts.add(slot, samples),
            ),
            Trace::Among(candidates) => {
                let objects = candidates.iter().map(|candidate| candidate.object);
                for offset in wanted {
                    counts.add(self.world.slot_among(x, y, offset, objects.clone()), 1);
                }
            }
            Trace::OneByOne(nearby) => {
                for offset in wanted {
                    counts.add(self.world.slot_near(x, y, offset, nearby), 1);
                }
            }
        }
    }
}

/// How the samples of a pixel are traced.
#[derive(Clone, Copy)]
enum Trace<'a> {
    /// Many at a time, against what may be seen in the pixel; and what it shows of a board, where
    /// that is known.
    Together(&'a [Candidate], Option<&'a Checks>),
    /// One by one, against these.
    Among(&'a [Candidate]),
    /// One by one, against the objects nearby, or those that the quadtree knows on their way.
    OneByOne(Option<&'a [Nearby]>),
}
