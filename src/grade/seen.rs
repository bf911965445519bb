//! What single samples see of a pixel.
//!
//! A mean of samples lies between the colours that they see, channel by channel. Where a picture does not, no samples made it, however they hang
//! together: a far plane that cuts rows of squares off at the horizon, of which no pixel has one colour, shows itself so.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{Case, Verdict, alike, noise, size};
use crate::{area::Area, scene::Scene, tracer::World};

/// Places along each side of a pixel: as fine as the samples of which errors are seen at all, which are some hundreds.
pub const PLACES: usize = 16;

/// So many pixels of several colours are looked at, at most, all over the picture.
const PIXELS: usize = 2048;

/// What lies on an edge is seen on either side of it by programs that round; this is more than they do, in pixels, and less than anything that
/// is seen.
const ROUNDED: f64 = 1e-7;

/// No more of a pixel's samples than this are on those of its sides that have something else beyond: three of four at its corners.
const ON_SIDES: f64 = 0.75;

/// What may have made a picture of a scene, beside mistakes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Samples: all that is off has several colours, or what a sample at one of a pixel's corners sees.
    Samples,
    /// Samples on pixels' sides only, as it is off where edges run along these. What is on an edge programs that round see on one side of it or on
    /// the other, in some rows so and in others not.
    OnSides,
    /// No samples, wherever they are.
    Mistakes,
}

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
    fn is_beyond(&self, pixel: [u32; 2], light: &[f64; 3]) -> bool {
        let [low, high] = self.range(pixel);
        is_outside(light, [low - self.margin, high + self.margin])
    }

    /// The least and the greatest light that samples on a pixel's sides see, or what is seen all over the pixel.
    fn on_sides(&self, pixel: [u32; 2], own: DVec3) -> [DVec3; 2] {
        let beyond = sides().map(|offset| self.at(pixel, offset));
        range(beyond.chain([own]))
    }
}

fn is_outside(light: &[f64; 3], [low, high]: [DVec3; 2]) -> bool {
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
fn sides() -> impl Iterator<Item = DVec2> {
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

fn range(colors: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    colors.fold(
        [DVec3::INFINITY, DVec3::NEG_INFINITY],
        |[low, high], color| [low.min(color), high.max(color)],
    )
}

/// What may have made a picture. No samples have, where pixels of one colour have another one that samples on their sides do not explain, or pixels
/// of several colours are beyond all of them, and more than chance has it.
pub fn origin(case: &Case) -> Origin {
    let (a, exact, seen) = (&case.full.a, &case.full.exact, case.seen());
    let [width, height] = size(a);
    let is_off = |&(x, y): &(u32, u32)| noise::is_off((&a.pixel(x, y), &exact.pixel(x, y)));
    let is_flat = |&(x, y): &(u32, u32)| noise::is_flat(&case.variance.pixel(x, y));
    let whole = || Area::whole(width, height).iter();
    let mixed = || whole().filter(|at| is_off(at) && !is_flat(at));
    let step = mixed().count().div_ceil(PIXELS).max(1);
    let some: Vec<_> = mixed().step_by(step).collect();
    let beyond = some
        .par_iter()
        .filter(|(x, y)| seen.is_beyond([*x, *y], &a.pixel(*x, *y)));
    if beyond.count() > noise::STRAYS {
        return Origin::Mistakes;
    }
    if case.strays.pixels == 0 {
        return Origin::Samples;
    }
    let is_beside = |&(x, y): &(u32, u32)| noise::is_beside_another(exact, [x, y]);
    let flat = whole().filter(|at| is_flat(at) && (is_off(at) || is_beside(at)));
    let (wrong, right): (Vec<_>, Vec<_>) = flat.partition(is_off);
    let mut strays = 0;
    for &(x, y) in &wrong {
        let own = DVec3::from(exact.pixel(x, y));
        let ends = seen.on_sides([x, y], own);
        if is_outside(&a.pixel(x, y), ends.map(|end| own.lerp(end, ON_SIDES))) {
            // Where edges meet at a pixel's corner a program that rounds may see what is behind them all.
            strays += 1;
            let is_other = |end: &DVec3| noise::is_off((&end.to_array(), &own.to_array()));
            if !ends.iter().any(is_other) || strays > noise::STRAYS {
                return Origin::Mistakes;
            }
        }
    }
    let mut corners = CORNERS.iter();
    match corners.any(|corner| explains(case, corner, &wrong, &right)) {
        true => Origin::Samples,
        false => Origin::OnSides,
    }
}

/// A pixel's corners. Of sets of samples that begin at 0, as Hammersley's does, one is at one of them, and so sees what is beyond an edge that
/// runs along a side.
const CORNERS: [DVec2; 4] = [
    DVec2::new(-0.5, -0.5),
    DVec2::new(0.5, -0.5),
    DVec2::new(-0.5, 0.5),
    DVec2::new(0.5, 0.5),
];

/// A sample at a corner is seen wherever something else is, but for what lies on an edge there: in more than half as many pixels, as an edge
/// that is off along one of a box's sides has along two.
const MOST: f64 = 0.75;

/// Whether a sample at a corner makes those pixels of one colour wrong that are, and would make few of those wrong that are right.
fn explains(case: &Case, corner: &DVec2, wrong: &[(u32, u32)], right: &[(u32, u32)]) -> bool {
    let (a, exact, seen) = (&case.full.a, &case.full.exact, case.seen());
    // On an edge, or on one side of it.
    let beside = CORNERS.map(|way| *corner + way * (2.0 * ROUNDED));
    let places = || beside.into_iter().chain([*corner]);
    let is_made = |&(x, y): &(u32, u32)| {
        let colors = places().map(|place| seen.at([x, y], place));
        let [low, high] = range(colors.chain([DVec3::from(exact.pixel(x, y))]));
        let light = a.pixel(x, y);
        let nearest = DVec3::from(light).clamp(low, high);
        !noise::is_off((&light, &nearest.to_array()))
    };
    if !wrong.iter().all(is_made) {
        return false;
    }
    places().any(|place| {
        let shows = |&&(x, y): &&(u32, u32)| {
            let other = seen.at([x, y], place).to_array();
            noise::is_off((&other, &exact.pixel(x, y)))
        };
        let [shown, missing] =
            [wrong, right].map(|pixels| pixels.iter().filter(shows).count() as f64);
        shown > 0.0 && shown >= MOST * (shown + missing)
    })
}

/// What is said of samples on pixels' sides.
pub fn verdict(difference: f64) -> Verdict {
    let message = "the picture is wrong only where colours meet, and where edges run along pixels' sides, as it is with samples on these: what is \
                   on an edge is seen on one side of it or on the other";
    alike::verdict(difference, message, alike::HELP.to_owned())
}
