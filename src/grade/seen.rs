//! What single samples see of a pixel.
//!
//! A mean of samples lies between the colours that they see, channel by channel. Where a picture does not, no samples made it, however they hang
//! together (`origin`): a far plane that cuts rows of squares off at the horizon, of which no pixel has one colour, shows itself so.

use glam::{DVec2, DVec3};

use super::noise;
use crate::{scene::Scene, tracer::World};

/// Places along each side of a pixel: as fine as the samples of which errors are seen at all, which are some hundreds.
pub const PLACES: usize = 16;

/// What lies on an edge is seen on either side of it by programs that round; this is more than they do, in pixels, with numbers of 32 bits, and less
/// than anything that is seen.
pub const ROUNDED: f64 = 1e-4;

/// A scene whose single samples are asked for.
pub struct Seen {
    world: World,
    /// The colours of its palette, in linear light.
    colors: Vec<DVec3>,
    /// What a channel is beyond the colours that are seen at the places, if a sample sees one that is at none of them: a colour with a share
    /// below 1/256 of the pixel, of which hardly more than one sample in 16 is.
    margin: DVec3,
}

impl Seen {
    pub fn of(scene: &Scene) -> Self {
        let world = World::new(scene);
        let colors = world.palette().iter().map(|color| color.to_linear());
        let colors: Vec<_> = colors.map(DVec3::from).collect();
        let [low, high] = range(colors.iter().copied());
        Self {
            world,
            colors,
            margin: (high - low) / PLACES as f64,
        }
    }

    pub fn world(&self) -> &World {
        &self.world
    }

    /// The light of a sample at an offset from a pixel's centre.
    pub fn at(&self, [x, y]: [u32; 2], offset: DVec2) -> DVec3 {
        self.colors[self.world.slot_at(x, y, offset)]
    }

    /// The least and the greatest light of each channel that samples see in a pixel and on its sides.
    fn range(&self, pixel: [u32; 2]) -> [DVec3; 2] {
        let inside = (0..PLACES * PLACES).map(place);
        range(inside.chain(sides()).map(|offset| self.at(pixel, offset)))
    }

    /// Whether no samples at the places make a pixel of several colours, but for roundings.
    pub fn is_beyond(&self, pixel: [u32; 2], light: &[f64; 3]) -> bool {
        let [low, high] = self.range(pixel);
        is_outside(light, [low - self.margin, high + self.margin])
    }
}

/// Whether a light is not between two others in each channel, but for roundings.
pub fn is_outside(light: &[f64; 3], [low, high]: [DVec3; 2]) -> bool {
    let nearest = DVec3::from(*light).clamp(low, high);
    noise::is_off((light, &nearest.to_array()))
}

/// A place in a pixel, from its centre: the middle of one of [`PLACES`]² cells.
pub fn place(index: usize) -> DVec2 {
    let along = |at: usize| (at as f64 + 0.5) / PLACES as f64 - 0.5;
    DVec2::new(along(index % PLACES), along(index / PLACES))
}

/// Places on a pixel's sides, among them its corners, as they may be seen by programs that round: a little outside. A little inside is what the
/// places in it see.
pub fn sides() -> impl Iterator<Item = DVec2> {
    (0..=PLACES).flat_map(|index| {
        let along = index as f64 / PLACES as f64 - 0.5;
        // At a corner all four pixels that meet there may be seen.
        let beside = [1.0 - 2.0 * ROUNDED, 1.0 + 2.0 * ROUNDED].map(|times| along * times);
        beside.into_iter().flat_map(|along| {
            [-0.5 - ROUNDED, 0.5 + ROUNDED]
                .into_iter()
                .flat_map(move |side| [DVec2::new(along, side), DVec2::new(side, along)])
        })
    })
}

/// The least and the greatest of some colours, in each channel.
pub fn range(colors: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    colors.fold(
        [DVec3::INFINITY, DVec3::NEG_INFINITY],
        |[low, high], color| [low.min(color), high.max(color)],
    )
}
