//! Renders tiles (rectangles of pixels) of a picture with samples.
//!
//! A pixel's samples are counted by colour, so their order does not matter. If all samples of a
//! pixel are certain to see the same colour, they are neither placed nor traced. In other pixels,
//! many samples are traced at a time, against only those objects that may be seen there. If finding
//! these objects would take longer than it saves, samples are traced one by one.

use std::{
    ops::{ControlFlow, Range},
    sync::atomic::Ordering,
};

use super::{
    Control,
    tally::PixelTally,
    tile::{SampleCounts, Tile},
};
use crate::{
    area::Area,
    film::{self, Encoder},
    math::SimdWidth,
    sampling::Sampling,
    tracer::{
        BoundedObject, CheckerPixel, PicturePart, Quartering, Scratch, VisibilityCandidate, World,
        nearby, samples,
    },
};

/// Minimum number of a pixel's samples that are traced with the widest vectors of the processor,
/// which have up to 8 lanes. Fewer samples would leave lanes unused, so they are traced with the
/// narrower vectors that every processor has.
const WIDE_SAMPLES: u64 = 8;

/// Limit on the ratio of a pixel's samples to the objects that may be seen in the pixel. Up to this
/// ratio, samples are traced one by one. Above it, the pixel is first prepared, so that many
/// samples can be traced at a time. The value is not critical: by measurement, a picture takes up
/// to 2 % longer with 1 or 4.
const ONE_BY_ONE_RATIO: u64 = 2;

/// Maximum number of a pixel's samples that are traced between two checks for cancellation. 4096
/// samples take 40 µs if many are traced at a time, and 0.3 ms one by one, so cancellation is
/// quick.
const SAMPLES_PER_CHUNK: u64 = 1 << 12;

/// Side, in pixels, of the squares into which crowded areas are divided. An area is crowded if so
/// many objects may be seen in it that preparing its pixels would take too long. For each square,
/// the objects near it are searched once and serve all of its samples. Smaller squares would need
/// more searches. In larger squares, each sample would be tested against more objects.
const CROWD_SIDE: u32 = 4;

/// Minimum number of samples for which a pixel gets its own list of nearby objects, selected from
/// the list of its square ([`CROWD_SIDE`]). With fewer samples, the selection would take longer
/// than testing each sample against the square's list.
const SAMPLES_WORTH_A_LOOK: u64 = 3;

/// Renders the tiles (rectangles of pixels) of a picture. All threads share this data.
pub(super) struct Renderer<'a, P> {
    pub(super) world: &'a World,
    pub(super) sampling: &'a Sampling,
    /// The scene's colours (its palette), in linear light.
    pub(super) colors: &'a [[f64; 3]],
    /// The scene's colours (its palette), converted to the film's type of pixel.
    pub(super) shown: &'a [P],
    pub(super) encoder: &'a Encoder,
    pub(super) control: &'a Control<'a>,
    pub(super) quartering: Quartering<'a>,
}

impl<P: film::Pixel> Renderer<'_, P> {
    /// Renders a tile, i.e. a rectangle of pixels. Returns the pixels row by row, or `None` if the
    /// render was cancelled.
    pub(super) fn tile(
        &self,
        tile: Area,
        tally: &mut PixelTally<P>,
        scratch: &mut Scratch,
    ) -> Option<Vec<P>> {
        let background = self.shown[self.world.background()];
        let mut film = Tile {
            area: tile,
            samples: match self.sampling.same_count() {
                Some(count) => SampleCounts::Same(count),
                None => SampleCounts::Each(self.sampling.counts(tile)),
            },
            // A pixel without a sample shows the background.
            pixels: vec![background; tile.pixels() as usize],
            unreported: 0,
        };
        let mut visit = |part: PicturePart| match part {
            PicturePart::OneColor { area, color_index } => {
                film.fill(area, self.shown[color_index]);
                self.go_on()
            }
            PicturePart::Pixel {
                x,
                y,
                candidates,
                checks,
            } => self.pixel([x, y], Trace::Batched(candidates, checks), &mut film, tally),
            PicturePart::Crowded { area } => area.grid(CROWD_SIDE).try_for_each(|square| {
                let nearby = nearby::nearby(self.world, square);
                let trace = Trace::AmongNearby(nearby.as_deref());
                let mut pixels = square.common(area).iter();
                pixels.try_for_each(|(x, y)| self.pixel([x, y], trace, &mut film, tally))
            }),
        };
        let flow = self.quartering.parts(tile, scratch, &mut visit);
        (self.control.progress)(film.unreported);
        flow.is_continue().then_some(film.pixels)
    }

    /// Returns `Break` if the render was cancelled, and `Continue` otherwise.
    fn go_on(&self) -> ControlFlow<()> {
        if self.control.cancel.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// Traces the samples of a pixel and stores their mean colour in `film`. Returns `Break` if the
    /// render was cancelled.
    fn pixel(
        &self,
        [x, y]: [u32; 2],
        trace: Trace,
        film: &mut Tile<P>,
        tally: &mut PixelTally<P>,
    ) -> ControlFlow<()> {
        let index = film.area.index(x, y);
        let samples = film.samples.of(index);
        if samples == 0 {
            return self.go_on();
        }
        let trace = match trace {
            // If there are few samples, they are traced one by one, because preparing the pixel
            // would take longer.
            Trace::Batched(candidates, _)
                if samples <= ONE_BY_ONE_RATIO * candidates.len() as u64 =>
            {
                Trace::AmongCandidates(candidates)
            }
            _ => trace,
        };
        let mut narrowed = std::mem::take(&mut tally.narrowed);
        let trace = match trace {
            Trace::AmongNearby(Some(nearby)) if samples >= SAMPLES_WORTH_A_LOOK => {
                let pixel = Area::pixel(x, y);
                if let Some(color_index) = nearby::in_part(self.world, pixel, nearby, &mut narrowed)
                {
                    tally.narrowed = narrowed;
                    film.fill(pixel, self.shown[color_index]);
                    return self.go_on();
                }
                Trace::AmongNearby(Some(&narrowed))
            }
            _ => trace,
        };
        if let Trace::Batched(candidates, checks) = trace {
            samples::prepare(self.world, [x, y], candidates, checks, &mut tally.pixel);
        }
        for first in (0..samples).step_by(SAMPLES_PER_CHUNK as usize) {
            let end = samples.min(first + SAMPLES_PER_CHUNK);
            self.chunk([x, y], samples, first..end, trace, tally);
            film.unreported += end - first;
            if film.unreported >= SAMPLES_PER_CHUNK {
                (self.control.progress)(std::mem::take(&mut film.unreported));
            }
            self.go_on()?;
        }
        tally.narrowed = narrowed;
        let PixelTally { counts, means, .. } = tally;
        film.pixels[index] = means.take(counts, self.colors, self.encoder);
        self.go_on()
    }

    /// Traces some of a pixel's samples, and counts their colours in `tally`. `some` is the range
    /// of these samples' indices, and `samples` is the number of all samples in the pixel.
    fn chunk(
        &self,
        [x, y]: [u32; 2],
        samples: u64,
        some: Range<u64>,
        trace: Trace,
        tally: &mut PixelTally<P>,
    ) {
        let PixelTally {
            counts,
            pixel,
            points,
            ..
        } = tally;
        let vectors = match trace {
            Trace::Batched(..) if some.end - some.start >= WIDE_SAMPLES => SimdWidth::Widest,
            // If there are few samples, or if they are traced one by one, their positions are
            // computed with the vectors that every processor has. Wide vectors take longer for few
            // samples, and would also slow down tracing one by one.
            _ => SimdWidth::Baseline,
        };
        self.sampling.place(vectors, [x, y], samples, some, points);
        // Cancellation is checked before every sample, because tracing one sample may take long.
        let wanted = points.iter().take_while(|_| self.go_on().is_continue());
        match trace {
            Trace::Batched(..) => samples::count(
                self.world,
                pixel,
                points.lanes(),
                points.len(),
                vectors,
                |color_index, samples| counts.add(color_index, samples),
            ),
            Trace::AmongCandidates(candidates) => {
                let objects = candidates.iter().map(|candidate| candidate.object);
                for offset in wanted {
                    counts.add(
                        self.world.color_index_among(x, y, offset, objects.clone()),
                        1,
                    );
                }
            }
            Trace::AmongNearby(nearby) => {
                for offset in wanted {
                    counts.add(self.world.color_index_near(x, y, offset, nearby), 1);
                }
            }
        }
    }
}

/// Method of tracing the samples of a pixel.
#[derive(Clone, Copy)]
enum Trace<'a> {
    /// Traces many samples at a time, against the objects that may be seen in the pixel. The second
    /// value describes a checkerboard's squares in the pixel. It is `None` if other objects may be
    /// seen too, or if the squares are not known.
    Batched(&'a [VisibilityCandidate], Option<&'a CheckerPixel>),
    /// Traces one sample at a time, against the objects that may be seen in the pixel.
    AmongCandidates(&'a [VisibilityCandidate]),
    /// Traces one sample at a time, against the given objects near the pixel. If they are `None`,
    /// searches the picture's quadtree for each sample.
    AmongNearby(Option<&'a [BoundedObject]>),
}
