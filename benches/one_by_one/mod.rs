//! Renders a picture sample by sample, without culling. Tests and benchmarks compare the result and
//! its time with those of culling, which traces the samples of a pixel together.

use pinhole::{
    area::Area,
    film::{Film, mean},
    math::SimdWidth,
    sampling::{Points, Sampling},
    tracer::World,
};

/// Renders the area `part` of the picture by tracing each sample alone.
pub fn one_by_one(world: &World, sampling: &Sampling, part: Area) -> Film {
    /// Maximum number of sample points that are generated at a time. It limits the memory for the
    /// points; the result does not depend on it.
    const CHUNK: u64 = 1 << 12;
    let palette = world.palette().iter();
    let colors: Vec<_> = palette.map(|color| color.to_linear()).collect();
    let mut offsets = Points::default();
    let mut counts = vec![0; colors.len()];
    let mut pixel = |(x, y): (u32, u32)| {
        counts.fill(0);
        let samples = sampling.count(x, y);
        let mut first = 0;
        while first < samples {
            let end = samples.min(first + CHUNK);
            let part = first..end;
            sampling.place(SimdWidth::Widest, [x, y], samples, part, &mut offsets);
            for offset in offsets.iter() {
                counts[world.color_index_at(x, y, offset)] += 1;
            }
            first = end;
        }
        match samples {
            0 => colors[world.background()],
            _ => mean(counts.iter().copied().zip(colors.iter().copied())),
        }
    };
    let pixels: Vec<_> = part.iter().map(&mut pixel).collect();
    let mut film = Film::new(part.width, part.height).expect("memory for a picture");
    film.put(Area::whole(part.width, part.height), &pixels);
    film
}
