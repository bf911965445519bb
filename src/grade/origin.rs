//! What may have made a picture of a scene, beside mistakes.
//!
//! Samples see what is in a pixel and on its sides. Where an edge runs along a side, a sample on it sees what is on one side of the edge or on the
//! other, as the program rounds: in some rows so and in others not. Then pixels of one colour have another one, though nothing is wrong but where the
//! samples are. Where that is so nearly the same may be made by an object that is off.

use std::{array, sync::atomic::Ordering};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{
    Case, Verdict, alike, noise,
    seen::{PLACES, ROUNDED, Seen, is_outside, range, sides},
    size,
};
use crate::area::Area;

/// What may have made a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Samples: all that is off has several colours, or what a sample at one of a pixel's corners sees.
    Samples,
    /// Samples on several of the pixels' sides.
    OnSides,
    /// The same, if roundings seldom show them: an object that is off does the same along one of its edges.
    Perhaps,
    /// No samples, wherever they are.
    Mistakes,
}

/// So many pixels of each kind are looked at, at most, all over the picture.
const PIXELS: usize = 2048;

/// What may have made a picture. No samples have, where pixels of one colour have another one that samples on their sides do not explain, or pixels
/// of several colours are beyond all of them, and more than chance has it.
pub fn origin(case: &Case) -> Origin {
    let (a, exact, seen) = (&case.full.a, &case.full.exact, case.seen());
    let [width, height] = size(a);
    let is_off = |&(x, y): &(u32, u32)| noise::is_off((&a.pixel(x, y), &exact.pixel(x, y)));
    let is_flat = |&(x, y): &(u32, u32)| noise::is_flat(&case.variance.pixel(x, y));
    let is_beside = |&(x, y): &(u32, u32)| noise::is_beside_another(exact, [x, y]);
    let whole = || Area::whole(width, height).iter();
    if whole().any(|at| is_flat(&at) && is_off(&at) && !is_beside(&at)) {
        return Origin::Mistakes;
    }
    let mixed: Vec<_> = whole().filter(|at| is_off(at) && !is_flat(at)).collect();
    let (some, _) = some_of(&mixed);
    let beyond = some
        .par_iter()
        .filter(|(x, y)| seen.is_beyond([*x, *y], &a.pixel(*x, *y)));
    if beyond.count() > noise::STRAYS {
        return Origin::Mistakes;
    }
    if case.strays.pixels == 0 {
        return Origin::Samples;
    }
    let flat = whole().filter(|at| is_flat(at) && is_beside(at));
    let (wrong, right): (Vec<_>, Vec<_>) = flat.partition(is_off);
    let mut corners = CORNERS.iter();
    if corners.any(|corner| explains(case, corner, &wrong, &right)) {
        return Origin::Samples;
    }
    Sides::of(case, &wrong, &right).origin()
}

/// Some of them, all over the picture, and for how many each of these stands.
fn some_of(pixels: &[(u32, u32)]) -> (Vec<(u32, u32)>, f64) {
    let step = pixels.len().div_ceil(PIXELS).max(1);
    (pixels.iter().copied().step_by(step).collect(), step as f64)
}

/// What pixels of one colour tell of samples on their sides.
#[derive(Debug, Default)]
struct Sides {
    /// How many have something else beyond one of their sides, along all of it, and not beyond the others: the left one, the right, the upper and
    /// the lower one.
    along: [f64; 4],
    /// How many of them are wrong.
    wrong: [f64; 4],
    /// The greatest share of the other colour in one of these.
    shares: [f64; 4],
    /// Wrong ones of which samples on the sides are no explanation.
    strays: usize,
    /// Whether one of these has nothing else on its sides.
    is_impossible: bool,
}

/// What a pixel of one colour tells.
enum Told {
    Nothing,
    /// It has something else beyond one of its sides, and this share of it.
    Side(usize, f64),
    Stray,
    Impossible,
}

/// How far a share may be off that is told by bytes.
const BYTES: f64 = 1.0 / 16.0;

/// A sample on a side is seen in half of the pixels that have something else there if a program sees edges as their objects' own, or if roundings
/// are chance; this is less, as edges are of different lengths.
const MANY: f64 = 0.4;

impl Sides {
    fn of(case: &Case, wrong: &[(u32, u32)], right: &[(u32, u32)]) -> Self {
        let (a, exact, seen) = (&case.full.a, &case.full.exact, case.seen());
        let cancel = case.control.cancel;
        let told = |(x, y): (u32, u32)| match cancel.load(Ordering::Relaxed) {
            true => Told::Nothing,
            false => told(seen, [x, y], a.pixel(x, y), exact.pixel(x, y)),
        };
        let mut sides = Self::default();
        for (pixels, is_wrong) in [(wrong, true), (right, false)] {
            let (some, weight) = some_of(pixels);
            let all: Vec<_> = some.into_par_iter().map(told).collect();
            for told in all {
                match told {
                    Told::Nothing => {}
                    Told::Side(side, share) => {
                        sides.along[side] += weight;
                        if is_wrong {
                            sides.wrong[side] += weight;
                            sides.shares[side] = sides.shares[side].max(share);
                        }
                    }
                    Told::Stray => sides.strays += 1,
                    Told::Impossible => sides.is_impossible = true,
                }
            }
        }
        sides
    }

    /// Whether samples on the sides, at the same places in all pixels, may be all that is wrong.
    fn origin(&self) -> Origin {
        // No sample is on both of two sides.
        let [left, right, upper, lower] = self.shares;
        let are_too_many = left + right > 1.0 + BYTES || upper + lower > 1.0 + BYTES;
        if self.is_impossible || self.strays > noise::STRAYS || are_too_many {
            return Origin::Mistakes;
        }
        let wrong: f64 = self.wrong.iter().sum();
        let pairs = self.along.iter().zip(&self.wrong);
        let along: f64 = pairs
            .filter(|(_, wrong)| **wrong > 0.0)
            .map(|(along, _)| along)
            .sum();
        // Few may be where something else is rounded, too.
        match wrong <= noise::STRAYS as f64 || wrong >= MANY * along {
            true => Origin::OnSides,
            false => Origin::Perhaps,
        }
    }
}

/// What a pixel of one colour beside others tells of samples on its sides.
fn told(seen: &Seen, pixel: [u32; 2], light: [f64; 3], own: [f64; 3]) -> Told {
    let is_other = |color: &DVec3| noise::is_off((&color.to_array(), &own));
    if noise::is_off((&light, &own)) {
        let beyond = sides().map(|offset| seen.at(pixel, offset));
        let ends = range(beyond.chain([DVec3::from(own)]));
        if is_outside(&light, ends) {
            // Where edges meet at a pixel's corner a program that rounds may see what is behind them all.
            return match ends.iter().any(is_other) {
                true => Told::Stray,
                false => Told::Impossible,
            };
        }
    }
    // The colour beyond each side; none where there are several.
    let beyond: [Option<DVec3>; 4] = array::from_fn(|side| {
        let colors = (1..PLACES).map(|place| seen.at(pixel, beside(side, place)));
        let [low, high] = range(colors);
        (low == high).then_some(low)
    });
    let mut others = (0..4).filter(|side| beyond[*side].is_none_or(|color| is_other(&color)));
    let (Some(side), None) = (others.next(), others.next()) else {
        return Told::Nothing;
    };
    let Some(other) = beyond[side] else {
        return Told::Nothing;
    };
    let apart = other - DVec3::from(own);
    let most = apart.abs().max_position();
    Told::Side(side, (light[most] - own[most]) / apart[most])
}

/// A place on the far side of one of a pixel's sides: left, right, upper or lower.
fn beside(side: usize, place: usize) -> DVec2 {
    let along = place as f64 / PLACES as f64 - 0.5;
    let beyond = 0.5 + ROUNDED;
    match side {
        0 => DVec2::new(-beyond, along),
        1 => DVec2::new(beyond, along),
        2 => DVec2::new(along, -beyond),
        _ => DVec2::new(along, beyond),
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
        let ends = range(colors.chain([DVec3::from(exact.pixel(x, y))]));
        !is_outside(&a.pixel(x, y), ends)
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
    let message = "the picture is wrong only where colours meet, and where edges run along pixels' sides, as it may be with samples on these: \
                   what is on an edge is seen on one side of it or on the other";
    let help = "samples inside of the pixels (jittered, sobol) see what belongs to each; then nothing else is wrong";
    alike::verdict(difference, message, help.to_owned())
}
