//! Which colours come and go where a picture is wrong: whose they are, and whether something in the scene has them.

use std::{cmp::Ordering, collections::HashMap};

use glam::DVec3;

use super::{
    colors::{Near, color},
    confined::{PART, around},
    search::Blob,
};
use crate::{
    area::Area,
    color::{Color, linear_to_srgb},
    film::{Film, rmse},
    grade::{Case, LEFT, Verdict, evidence::FEWEST, explained_share, noise},
    numbers::short,
    scene::Shape,
};

/// An object takes the blame if its colour comes or goes in no less than this share of the pixels in which the one does that does most: where
/// an object is not what it should be, something else is seen or hidden, of which there may be more than of it in pixels that it shares.
const OWN: f64 = 0.8;

/// Of a scene with more colours any other is nearly a mixture of two.
const MIXED: usize = 64;

/// The colours of a scene, and the pixels that are wrong.
pub struct Palette {
    colors: Vec<[f64; 3]>,
    /// What they are, and what they should be.
    wrong: Vec<[[f64; 3]; 2]>,
    /// In how many of them the colour comes or goes that does so in most.
    most: usize,
}

impl Palette {
    pub fn of(case: &Case) -> Self {
        let mut colors = vec![case.full.scene.image.background.to_linear()];
        for object in &case.full.scene.objects {
            let mut shape = object.shape;
            colors.extend(color(&mut shape).into_iter().map(|color| color.to_linear()));
        }
        colors.sort_by(|p, q| p.partial_cmp(q).unwrap_or(Ordering::Equal));
        colors.dedup();
        let pairs = case.full.a.pixels().iter().zip(case.full.exact.pixels());
        let pairs = pairs.zip(case.variance.pixels());
        // Where one colour should be seen there is no noise.
        let is_wrong = |(pair, variance): &((&[f64; 3], &[f64; 3]), &[f64; 3])| {
            noise::is_off(*pair) && (case.strays.pixels == 0 || noise::is_flat(variance))
        };
        let wrong = pairs.filter(is_wrong).map(|((p, q), _)| [*p, *q]);
        let mut palette = Self {
            colors,
            wrong: wrong.collect(),
            most: 0,
        };
        if palette.is_small() {
            let changed = palette.colors.iter().map(|color| palette.changed(color));
            palette.most = changed.max().unwrap_or(0);
        }
        palette
    }

    /// Whether the colours are so few that they tell of whom they are.
    fn is_small(&self) -> bool {
        self.colors.len() <= MIXED
    }

    /// Whether an object's colour comes and goes where the picture is wrong, and no other colour does so in many more pixels.
    pub fn is_of(&self, shape: &Shape) -> bool {
        let mut shape = *shape;
        let own = color(&mut shape).into_iter();
        let own = own.map(|color| self.changed(&color.to_linear())).max();
        own.unwrap_or(0) as f64 >= OWN * self.most as f64
    }

    /// In how many of the wrong pixels a colour comes or goes.
    fn changed(&self, light: &[f64; 3]) -> usize {
        let near = Near::to(light);
        let changes = |[p, q]: &&[[f64; 3]; 2]| near.holds(p) != near.holds(q);
        self.wrong.iter().filter(changes).count()
    }

    /// What is seen of a colour that nothing in the scene has, or nothing near, if all else is right.
    pub fn foreign(&self, case: &Case) -> Option<Verdict> {
        let (a, exact) = (&case.full.a, &case.full.exact);
        let (pixels, light) = self.commonest()?;
        let near = Near::to(&light);
        let whole = Area::whole(a.width(), a.height());
        let is_known = self.mixes(&light);
        if pixels < FEWEST
            || !self.is_small()
            || is_known && !self.is_of_object_elsewhere(case, &near)
        {
            return None;
        }
        // What should have the colour has it elsewhere.
        let pairs = a.pixels().iter().zip(exact.pixels());
        let new: Vec<_> = pairs
            .map(|(p, q)| near.holds(p) && !near.holds(q))
            .collect();
        let is_new = |(x, y): (u32, u32)| new[y as usize * a.width() as usize + x as usize];
        let blob = Blob::where_that(whole, is_new);
        // What is off by a step or two is near the colour that it should be, and so not new.
        if blob.pixels < FEWEST || blob.pixels as f64 >= PART * whole.pixels() as f64 {
            return None;
        }
        // All that is left is in pixels that do not have it, near none that does: little, or nothing but noise.
        let mut made = Film::clone(exact);
        let mut is_noise = true;
        for (x, y) in whole.iter() {
            // An edge may cover a little of a pixel that is next to one of which it covers a part.
            let mut around = around(around(Area::pixel(x, y), a), a).iter();
            let (p, q) = (a.pixel(x, y), exact.pixel(x, y));
            if around.any(is_new) {
                made.put(Area::pixel(x, y), &[p]);
            } else {
                let is_flat = noise::is_flat(&case.variance.pixel(x, y));
                is_noise &= !(is_flat && noise::is_off((&p, &q)));
            }
        }
        let left = rmse(a, &made);
        if !is_noise && left >= LEFT * case.difference {
            return None;
        }
        let color = Color {
            srgb: light.map(|light| (255.0 * linear_to_srgb(light)).clamp(0.0, 255.0)),
        };
        let but = match is_known {
            true => "where nothing that has it should be",
            false => "which nothing in the scene has",
        };
        Some(Verdict {
            mistake: "object_extra",
            message: format!(
                "something of the colour {color}, {but}, is seen in {} pixels around ({}, {})",
                blob.pixels,
                short(blob.middle.x.round()),
                short(blob.middle.y.round())
            ),
            help:
                "draw the objects of the scene and no other; each has the colour that it is given"
                    .to_owned(),
            rmse: Some(left),
            explains: Some(explained_share(left, case.difference)),
            off: None,
        })
    }

    /// Whether a colour is that of objects, none of which, nor anything else that has it, may be seen in a pixel that is wrong in having it.
    fn is_of_object_elsewhere(&self, case: &Case, near: &Near) -> bool {
        let scene = &case.full.scene;
        let (a, exact) = (&case.full.a, &case.full.exact);
        if near.holds(&scene.image.background.to_linear()) {
            return false;
        }
        let mut parts = Vec::new();
        for object in &scene.objects {
            let mut shape = object.shape;
            let has_it = |color: &mut Color| near.holds(&color.to_linear());
            if color(&mut shape).into_iter().any(has_it) {
                match shape {
                    Shape::Checkerboard(_) => return false,
                    _ => parts.extend(case.view.extent(&shape)),
                }
            }
        }
        let is_wrong =
            |(x, y): &(u32, u32)| near.holds(&a.pixel(*x, *y)) && !near.holds(&exact.pixel(*x, *y));
        let whole = Area::whole(a.width(), a.height());
        let mut wrong = whole.iter().filter(is_wrong);
        let is_beside = |(x, y): (u32, u32)| {
            let pixel = around(Area::pixel(x, y), a);
            parts
                .iter()
                .all(|part| pixel.iter().all(|(x, y)| !Area::pixel(x, y).lies_in(*part)))
        };
        !parts.is_empty() && wrong.all(is_beside)
    }

    /// What most of the wrong pixels are, and how many are so.
    fn commonest(&self) -> Option<(u64, [f64; 3])> {
        let mut counts: HashMap<[u64; 3], u64> = HashMap::new();
        for [p, _] in &self.wrong {
            *counts.entry(p.map(f64::to_bits)).or_default() += 1;
        }
        // Of as many the same in every run.
        let (bits, pixels) = counts
            .into_iter()
            .max_by_key(|(bits, pixels)| (*pixels, *bits))?;
        Some((pixels, bits.map(f64::from_bits)))
    }

    /// Whether light is that of one of the colours, or of two in one pixel.
    fn mixes(&self, light: &[f64; 3]) -> bool {
        let near = Near::to(light);
        let light = DVec3::from(*light);
        let pairs = self.colors.iter().enumerate();
        let mut pairs = pairs.flat_map(|(at, one)| {
            let others = self.colors[at..].iter();
            others.map(move |other| (DVec3::from(*one), DVec3::from(*other)))
        });
        pairs.any(|(one, other)| {
            let way = other - one;
            let share = (light - one).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
            near.holds(&(one + way * share.clamp(0.0, 1.0)).to_array())
        })
    }
}
