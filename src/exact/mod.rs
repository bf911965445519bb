//! A pixel's mean without samples: the area integral itself.
//!
//! In: the prepared scene, and which part of the picture is wanted. Out: for each pixel its mean in linear light, with a bound on
//! its error. What is seen is bounded by straight lines and conics, and of one colour (or of one checkerboard) between them. So:
//!
//! 1. The picture is quartered until a part shows one colour for certain, or is a single pixel.
//!    A pixel that shows nothing but a checkerboard, and few of its lines, is one of several that are computed at once (`waiting`, `groups`,
//!    `together`) or by itself (`grid`).
//! 2. In any other pixel the boundaries of what may be seen there cut it into regions: convex polygons where all are lines
//!    (`polygon`), slabs between neighbouring curves where some are conics (`sweep`).
//! 3. One ray into each region, decided without a mistake as every sample's is, says what is seen there. Boundaries that
//!    are hidden do no harm: both sides of them get the same colour.
//! 4. Areas have closed forms: `arc` for conics. What a region shows of a checkerboard (`board`) is summed row by row where it is
//!    near (`cells`), very many rows at once (`block`), and along the region's boundary where it is far (`edge`). Sums over the
//!    lines that a side crosses are sums of waves (`euler`): in `horizon` where lines never end, in `level` where the side hardly
//!    recedes, and in `modes` at any distance; but along diagonals, where too many of those are in step, they go from one of their `kinks` to the
//!    next. Where roundings of `f64` would leave too much in doubt, forms and corners are taken
//!    in double-double (`closely`), up to the horizon, and near lines, which are few, one by one (`finely`); how long that may take is a
//!    matter of `care`. Of squares too small to be seen it is told only how little they leave (`small`, `aslant`), and along a diagonal
//!    what they do in the mean (`diagonal`).
//!
//! The bound adds up what each step may be off: rounding, what could not be told apart, and what is cut off of infinite sums.

mod ahead;
mod arc;
mod aslant;
mod block;
mod board;
mod bulk;
mod care;
mod cells;
mod closely;
mod complex;
mod cutter;
mod diagonal;
mod displaced;
mod edge;
mod euler;
mod exponential;
mod finely;
mod floor;
mod grid;
mod groups;
mod horizon;
mod inverse;
mod kinks;
mod level;
mod modes;
mod polygon;
mod quadrature;
mod region;
mod resonance;
mod sides;
mod sliver;
mod small;
mod strip;
mod sweep;
#[cfg(test)]
mod tests;
mod together;
mod track;
mod waiting;

use std::{
    ops::ControlFlow,
    sync::atomic::{AtomicBool, Ordering},
};

use glam::DVec2;

use crate::{
    area::Area,
    tracer::{Candidate, Curve, Part, Quartering, Room, SubPixel, World, boundaries, candidates},
};

use self::{
    board::{Sum, UNIT},
    care::Care,
    region::{Regions, Shares},
    sides::Sides,
    waiting::{BoardPixel, Waiting},
};

/// A spot whose bound is no greater than this is not cut into quarters; nor one with so many squares, or the horizon, that of sums over them
/// something is neglected, which quarters would neglect, too, and take five times as long.
const ENOUGH: f64 = 1e-12;
const ENOUGH_CROWDED: f64 = 9e-10;
/// Quarters are cut further only where they are off by more than this together: that takes as long again for each of them.
const TOLERABLE: f64 = 1e-7;
/// Pieces of a spot are quartered until that has taken so many times as long as the whole may: quarters of quarters of the one that holds a
/// difficult point take half as long each time, so that these may be as small as they like.
const MOST_EFFORT: f64 = 12.0;

/// Not so where no more than this part of what is off could be mended: the rest is known no better in quarters, and smaller and smaller
/// pieces beside it would take no end.
const WORTHWHILE: f64 = 1.0 / 64.0;

/// A pixel computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Its mean in linear light.
    pub mean: [f64; 3],
    /// How far each channel may be from the true mean.
    pub bound: f64,
}

/// Computes pixels of one picture.
#[derive(Debug)]
pub struct Integrator<'a> {
    world: &'a World,
    quartering: Quartering<'a>,
    /// Of the palette, in linear light.
    colors: Vec<[f64; 3]>,
}

/// A part of a pixel.
#[derive(Debug)]
struct Piece {
    spot: SubPixel,
    shares: Shares,
    /// Whether it is not worth while to quarter it: its quarters, or those of what it is a quarter of, leave more than half as much in doubt.
    is_final: bool,
}

/// A spot with more objects than this is quartered, if that pays, down to spots of such a side; of smaller ones it is only told what they leave
/// in doubt, which is less than a rounding.
const SEVERAL: usize = 4;
const SMALLEST: f64 = 1.0 / (1 << 28) as f64;
/// It does not pay with fewer curves.
const FEW_CURVES: usize = 16;
/// With no more than so many it pays if it does with the first quarters.
const SOME_CURVES: usize = 48;
/// With more, quarters and their own quarters may take so many times as long as all of the spot at once: often only parts of parts have fewer
/// curves.
const HOPE: f64 = 8.0;
/// Of more objects than this it takes too long to look for where each two of them cross. A spot is quartered then until each of its objects was looked
/// at so many times.
const CROWD: usize = 24;
const PATIENCE: f64 = 2048.0;

/// A quarter of a spot, with what may be seen there, and how long it may take.
struct Quarter {
    spot: SubPixel,
    live: Vec<Candidate>,
    allowed: Allowed,
}

/// How long the parts of a spot may take.
#[derive(Clone, Copy, Debug)]
struct Allowed {
    /// How many times they may look at an object.
    looks: f64,
    /// With fewer objects than a crowd, about how long they may take.
    time: f64,
    /// About how long it takes at once, where that is known.
    whole: Option<f64>,
}

/// Room for what a pixel needs, kept from pixel to pixel.
#[derive(Debug, Default)]
struct Scratch {
    curves: Vec<Curve>,
    sides: Sides,
}

impl Piece {
    /// Its share of a spot that it is a part of.
    fn area(&self, of: SubPixel) -> f64 {
        let side = self.spot.side / of.side;
        side * side
    }

    /// How far it may put that spot off.
    fn bound(&self, of: SubPixel) -> f64 {
        self.area(of) * self.shares.bound
    }
}

impl<'a> Integrator<'a> {
    /// For the pixels of a prepared scene.
    pub fn new(world: &'a World) -> Self {
        Self {
            world,
            quartering: Quartering::new(world),
            colors: world
                .palette()
                .iter()
                .map(|color| color.to_linear())
                .collect(),
        }
    }

    /// The pixels of a part of the picture, row by row; none once it is cancelled, which ends within a pixel, too.
    pub fn pixels(&self, part: Area, cancel: &AtomicBool) -> Option<Vec<Pixel>> {
        let black = Pixel {
            mean: [0.0; 3],
            bound: 0.0,
        };
        let mut film = Film {
            part,
            pixels: vec![black; part.pixels() as usize],
        };
        let mut scratch = Scratch::default();
        let mut room = Room::default();
        let mut waiting = Waiting::new(self.world);
        // Pixels of a checkerboard for which that is not enough.
        let mut others = Vec::new();
        let flow = self.quartering.parts(part, &mut room, &mut |part| {
            if cancel.load(Ordering::Relaxed) {
                return ControlFlow::Break(());
            }
            match part {
                Part::Flat { area, slot } => film.fill(area, self.colors[slot]),
                Part::Open {
                    x,
                    y,
                    candidates: live,
                    ..
                } => match live {
                    [only] if self.is_floor(only) => {
                        waiting.push(BoardPixel { x, y, live: *only }, &mut |floor, sum| {
                            self.set(floor, sum, &mut film, &mut others);
                        });
                    }
                    _ => film.set(x, y, self.pixel(x, y, live, &mut scratch, cancel)),
                },
                // Does not come: whatever it costs, the picture is to be known.
                Part::Plain { area } => {
                    let live = candidates::everything(self.world);
                    for (x, y) in area.iter() {
                        film.set(x, y, self.pixel(x, y, &live, &mut scratch, cancel));
                    }
                }
            }
            ControlFlow::Continue(())
        });
        waiting.finish(&mut |floor, sum| self.set(floor, sum, &mut film, &mut others));
        for BoardPixel { x, y, live } in others {
            if cancel.load(Ordering::Relaxed) {
                break;
            }
            film.set(x, y, self.pixel(x, y, &[live], &mut scratch, cancel));
        }
        (flow.is_continue() && !cancel.load(Ordering::Relaxed)).then_some(film.pixels)
    }

    fn pixel(
        &self,
        x: u32,
        y: u32,
        live: &[Candidate],
        scratch: &mut Scratch,
        cancel: &AtomicBool,
    ) -> Pixel {
        let allowed = Allowed {
            looks: PATIENCE * live.len() as f64,
            time: f64::INFINITY,
            whole: None,
        };
        let Shares { by_slot, bound, .. } =
            self.shares(SubPixel::pixel(x, y), live, allowed, scratch, cancel);
        // Of one colour it is that; else a mean of some, which parts of it may be known better than.
        let rounding = if by_slot.len() > 1 { 4.0 * UNIT } else { 0.0 };
        self.mean(&by_slot, (bound + rounding).min(1.0))
    }

    /// Whether an object that is all that may be seen fills what it is seen in, in two colours.
    fn is_floor(&self, only: &Candidate) -> bool {
        let [first, second] = self.world.slots(only.object);
        only.is_whole && first != second
    }

    /// Sets a pixel of a checkerboard by its integral, if that is known well enough; else it is one of the others.
    fn set(
        &self,
        floor: BoardPixel,
        sum: Option<Sum>,
        film: &mut Film,
        others: &mut Vec<BoardPixel>,
    ) {
        let half = sum.map(|Sum { value, bound }| (0.5 * value, 0.5 * bound + 8.0 * UNIT));
        let Some((half, bound)) = half.filter(|(_, bound)| *bound <= ENOUGH) else {
            return others.push(floor);
        };
        let [first, second] = self.world.slots(floor.live.object);
        let shares = [(first, 0.5 + half), (second, 0.5 - half)];
        film.set(floor.x, floor.y, self.mean(&shares, bound));
    }

    /// The shares of a spot; of parts of it together where the whole is not computed well enough.
    ///
    /// Few squares are looked at more closely then. And a part has coordinates of its own, in which roundings are smaller: the widest views
    /// need that, in which a pixel sees squares both near and far. The part that is known worst is quartered: once if the whole is not known
    /// as well as it could be, and again as long as that helps much where far too little is known.
    fn shares(
        &self,
        spot: SubPixel,
        live: &[Candidate],
        allowed: Allowed,
        scratch: &mut Scratch,
        cancel: &AtomicBool,
    ) -> Shares {
        // What comes of a picture that was given up is thrown away.
        if cancel.load(Ordering::Relaxed) {
            return Shares::default();
        }
        let mut seen = Vec::new();
        let live = match live.len() > SEVERAL {
            true => {
                boundaries::narrowed(self.world, spot, live, &mut seen);
                &seen
            }
            false => live,
        };
        if live.len() > SEVERAL && spot.side <= SMALLEST {
            return self.in_doubt(spot, live);
        }
        if let Some(quarters) = self.with_fewer_curves(spot, live, allowed, cancel) {
            let mut together = Shares::default();
            for quarter in &quarters {
                let Quarter {
                    spot,
                    live,
                    allowed,
                } = quarter;
                let shares = self.shares(*spot, live, *allowed, scratch, cancel);
                together.add_part(&shares, 0.25);
            }
            return together;
        }
        let mut with = |care, spot| Piece {
            spot,
            shares: self.shares_at_once(spot, live, care, scratch, cancel),
            is_final: false,
        };
        let mut care = Care::Usual;
        let mut whole = with(care, spot);
        let enough = match whole.shares.is_crowded {
            true => ENOUGH_CROWDED,
            false => ENOUGH,
        };
        if whole.shares.of_boards > enough {
            let closer = match whole.shares.is_crowded {
                true => Care::Many,
                false => Care::Great,
            };
            let again = with(closer, spot);
            let is_worth_it =
                closer == Care::Great || again.shares.bound < 0.5 * whole.shares.bound;
            if is_worth_it {
                care = closer;
            }
            if again.shares.bound < whole.shares.bound {
                whole = again;
            }
        }
        let off = |piece: &Piece| piece.bound(spot);
        let mut pieces = vec![whole];
        let mut effort = 0.0;
        while effort < MOST_EFFORT {
            let bound: f64 = pieces.iter().map(off).sum();
            let enough = if effort == 0.0 { enough } else { TOLERABLE };
            if bound <= enough || cancel.load(Ordering::Relaxed) {
                break;
            }
            let uncertain = || pieces.iter().filter(|piece| !piece.is_final);
            if uncertain().map(off).sum::<f64>() <= WORTHWHILE * bound {
                break;
            }
            let uncertain = pieces.iter_mut().filter(|piece| !piece.is_final);
            let Some(worst) = uncertain.max_by(|one, other| off(one).total_cmp(&off(other))) else {
                break;
            };
            let before = off(worst);
            effort += 4.0 * (worst.spot.side / spot.side).min(1.0);
            let quarters = worst.spot.quarters().map(|quarter| with(care, quarter));
            let after: f64 = quarters.iter().map(off).sum();
            worst.is_final = after > 0.5 * before;
            if after < before {
                let is_final = worst.is_final;
                let [first, rest @ ..] = quarters.map(|piece| Piece { is_final, ..piece });
                *worst = first;
                pieces.extend(rest);
            }
        }
        let mut together = Shares::default();
        for piece in &pieces {
            together.add_part(&piece.shares, piece.area(spot));
        }
        together
    }

    /// The quarters of a spot with what may be seen in each, if they take less time than all of it at once: n curves cross in some n² places,
    /// at each of which all of them are looked at. Where curves go their own ways, half of them pass through a quarter; what is hidden there
    /// has none. A heap in one of the quarters is no less in there, but in the quarters of a quarter of that.
    fn with_fewer_curves(
        &self,
        spot: SubPixel,
        live: &[Candidate],
        allowed: Allowed,
        cancel: &AtomicBool,
    ) -> Option<[Quarter; 4]> {
        if live.len() <= SEVERAL {
            return None;
        }
        let quarters = || {
            spot.quarters().map(|spot| {
                let mut seen = Vec::new();
                boundaries::narrowed(self.world, spot, live, &mut seen);
                (spot, seen)
            })
        };
        let looks = 4.0 * live.len() as f64;
        if live.len() > CROWD && allowed.looks >= looks {
            let quarters = quarters();
            let together: usize = quarters.iter().map(|(_, live)| live.len()).sum();
            let left = (allowed.looks - looks) / together.max(1) as f64;
            return Some(quarters.map(|(spot, live)| Quarter {
                spot,
                allowed: Allowed {
                    looks: left * live.len() as f64,
                    ..allowed
                },
                live,
            }));
        }
        let curves = |spot, live: &[Candidate]| {
            time(boundaries::curves_about(self.world, spot, live, cancel))
        };
        let whole = allowed.whole.unwrap_or_else(|| curves(spot, live));
        if whole <= time(FEW_CURVES) {
            return None;
        }
        let quarters = quarters().map(|(spot, live)| (curves(spot, &live), spot, live));
        let together: f64 = quarters.iter().map(|(time, ..)| time).sum();
        let most = quarters.iter().map(|(time, ..)| *time).fold(0.0, f64::max);
        let is_less = together <= 0.75 * whole || together - most <= 0.25 * whole;
        let time_allowed = allowed.time.min(HOPE * whole);
        let is_allowed = whole > time(SOME_CURVES) && together <= time_allowed;
        (is_less || is_allowed).then(|| {
            quarters.map(|(time, spot, live)| Quarter {
                spot,
                live,
                allowed: Allowed {
                    time: time_allowed * time / together,
                    whole: Some(time),
                    ..allowed
                },
            })
        })
    }

    /// A spot that is smaller than matters.
    fn in_doubt(&self, spot: SubPixel, live: &[Candidate]) -> Shares {
        let (seen, _) = candidates::object_at(self.world, spot, DVec2::ZERO, live);
        let slot = seen.map_or(self.colors.len() - 1, |object| self.world.slots(object)[0]);
        Shares {
            by_slot: vec![(slot, 1.0)],
            bound: 1.0,
            ..Shares::default()
        }
    }

    fn shares_at_once(
        &self,
        spot: SubPixel,
        live: &[Candidate],
        care: Care,
        scratch: &mut Scratch,
        cancel: &AtomicBool,
    ) -> Shares {
        let Scratch { curves, sides, .. } = scratch;
        boundaries::curves(self.world, spot, live, cancel, curves);
        let regions = Regions::new(self.world, spot, live, sides, care, cancel);
        let lines_alone = curves.iter().all(|curve| matches!(curve, Curve::Line(_)));
        if lines_alone {
            polygon::shares(curves, regions)
        } else {
            sweep::shares(curves, regions)
        }
    }

    fn mean(&self, by_slot: &[(usize, f64)], bound: f64) -> Pixel {
        let mut mean = [0.0; 3];
        match by_slot {
            [(slot, _)] => mean = self.colors[*slot],
            by_slot => {
                let total: f64 = by_slot.iter().map(|(_, share)| share).sum();
                for (slot, share) in by_slot {
                    for (sum, channel) in mean.iter_mut().zip(self.colors[*slot]) {
                        *sum += share * channel;
                    }
                }
                mean = mean.map(|sum| (sum / total).clamp(0.0, 1.0));
            }
        }
        Pixel { mean, bound }
    }
}

/// About how long a spot with so many curves takes.
fn time(curves: usize) -> f64 {
    let curves = curves as f64;
    curves * curves * curves
}

/// The pixels of a part of the picture.
struct Film {
    part: Area,
    pixels: Vec<Pixel>,
}

impl Film {
    fn fill(&mut self, part: Area, mean: [f64; 3]) {
        for y in part.y..part.y + part.height {
            let start = self.part.index(part.x, y);
            self.pixels[start..start + part.width as usize].fill(Pixel { mean, bound: 0.0 });
        }
    }

    fn set(&mut self, x: u32, y: u32, pixel: Pixel) {
        let index = self.part.index(x, y);
        self.pixels[index] = pixel;
    }
}
