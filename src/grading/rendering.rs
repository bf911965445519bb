//! What a candidate makes in the cells of a grid, before it is laid out and its light is changed:
//! exactly, or sampled by the faulty tracer, on the tiny grid and for behaviour that no scene can
//! say.

use std::{cell::OnceCell, sync::Arc};

use glam::DVec2;

use super::{
    candidate::Candidate,
    faulty_tracer::{Behaviour, FaultyTracer, bounds},
    grid::Grid,
    moments::Moments,
    work::Work,
};
use crate::{area::Area, projection::Projection, scene::Scene};

/// Samples in a cell of what no scene can say.
const SAMPLES: usize = 34;

/// The share of a cell that may be missed where the faulty tracer takes it for one of a single
/// colour.
const MISSED: f64 = 1e-3;

/// What a candidate makes.
#[derive(Clone)]
pub struct Rendering {
    pub candidate: Candidate,
    pub part: Area,
    /// What it would make if it behaved as a right program; in samples, what it makes as it
    /// behaves.
    pub right: Arc<Moments>,
    /// What it makes, if it behaves otherwise.
    behaved: Option<Arc<Moments>>,
    /// What as many samples show of a right program, if that was needed.
    sampled: Option<Arc<Moments>>,
}

impl Rendering {
    /// What a candidate that behaves as a right program makes in a part of the picture.
    pub fn new(candidate: Candidate, part: Area, moments: Arc<Moments>) -> Self {
        Self {
            candidate,
            part,
            right: moments,
            behaved: None,
            sampled: None,
        }
    }

    /// As it is laid out in the cells of a grid.
    pub fn laid_out(&self, grid: &Grid) -> Arc<Moments> {
        let moments = self.behaved.as_ref().unwrap_or(&self.right);
        let layout = self.candidate.layout;
        if layout == Default::default() {
            return Arc::clone(moments);
        }
        let index = |pixel| {
            let (x, y) = layout.source(pixel, grid.size());
            self.part.index(x, y)
        };
        let order: Vec<usize> = grid.cells.iter().map(index).collect();
        Arc::new(moments.select(&order))
    }
}

impl Candidate {
    /// The scene that a grid's cells are pixels of, without what it does not draw.
    pub fn drawn(&self, grid: &Grid) -> Scene {
        let (camera, image) = grid.view(&self.scene);
        let mut scene = Scene {
            camera,
            image,
            ..self.scene.clone()
        };
        if self.is_drawn.contains(&false) {
            let mut is_drawn = self.is_drawn.iter();
            Arc::make_mut(&mut scene.objects).retain(|_| is_drawn.next() == Some(&true));
        }
        scene
    }

    /// What it makes in the cells of a grid: exactly, or by so many samples in a cell where these
    /// are given. What it makes as one of others does is taken from that which makes most of it.
    /// None if it is cancelled, or takes too much work.
    pub fn render(
        &self,
        grid: &Grid,
        samples: Option<usize>,
        known: &[Arc<Rendering>],
        work: &Work,
    ) -> Option<Rendering> {
        let part = self.layout.sources(grid.cells, grid.size());
        let is_alike = |one: &&Arc<Rendering>| {
            let behaves = one.candidate.behaviour == self.behaviour;
            one.part == part && (samples.is_none() || behaves)
        };
        let alike = known.iter().filter(is_alike);
        let alike = alike.map(|one| (one, self.changed(&one.candidate, grid, part)));
        let nearest = alike.min_by_key(|(one, changed)| {
            let behaves_otherwise = one.candidate.behaviour != self.behaviour;
            (changed.pixels(), behaves_otherwise)
        });
        let scene = OnceCell::new();
        let scene = || scene.get_or_init(|| self.drawn(grid));
        let sampled = |behaviour: Behaviour, area: Area, samples: usize| {
            work.pay_for_samples(self.scene.objects.len(), samples, area)?;
            // Objects are told by their place among those that are drawn.
            let drawn = |at: usize| self.is_drawn[..at].iter().filter(|is| **is).count();
            let hit = behaviour.hit.filter(|(at, _)| self.is_drawn[*at]);
            let behaviour = Behaviour {
                hit: hit.map(|(at, hit)| (drawn(at), hit)),
                offset: behaviour.offset.map(|by| by / f64::from(grid.factor)),
                pixel: 1.0 + (behaviour.pixel - 1.0) / f64::from(grid.factor),
                ..behaviour
            };
            let tracer = FaultyTracer::new(scene(), behaviour, self.averaged);
            Some(tracer.moments(area, samples))
        };
        let traced = |area| match samples {
            None => work.exact_moments(scene(), self.averaged, area),
            Some(samples) => sampled(self.behaviour, area, samples),
        };
        let right = nearest.map(|(one, area)| (&one.right, area));
        let right = completed(right, part, traced)?;
        let mut behaved = None;
        let is_same = |one: &&Arc<Rendering>| one.part == part && one.candidate.traces_as(self);
        let mut same = known.iter().filter(is_same);
        let mut of_right = same.find_map(|one| one.sampled.clone());
        if samples.is_none() && !self.behaviour.is_right() {
            let nearest = nearest.filter(|(one, _)| one.candidate.behaviour == self.behaviour);
            let nearest = nearest.and_then(|(one, area)| Some((one.behaved.as_ref()?, area)));
            behaved = Some(completed(nearest, part, |area| {
                let indices: Vec<usize> = area.iter().map(|(x, y)| part.index(x, y)).collect();
                let own = match &of_right {
                    Some(known) => known.select(&indices),
                    None => sampled(Behaviour::default(), area, SAMPLES)?,
                };
                let other = sampled(self.behaviour, area, SAMPLES)?;
                let right = right.select(&indices);
                let replaced = replaced_where_they_differ(right, &own, &other);
                if area == part {
                    of_right = Some(Arc::new(own));
                }
                Some(replaced)
            })?);
        }
        Some(Rendering {
            candidate: self.clone(),
            part,
            right,
            behaved,
            sampled: of_right,
        })
    }

    /// The area of a part of the picture, before it is laid out, outside of which it is known that
    /// another candidate shows the same.
    fn changed(&self, other: &Self, grid: &Grid, part: Area) -> Area {
        let nothing = Area {
            width: 0,
            height: 0,
            ..part
        };
        if self.traces_as(other) {
            return nothing;
        }
        let (one, two) = (&self.scene, &other.scene);
        // Objects are seen only where they are.
        let is_in_place = self.behaviour.is_in_place();
        let is_same_view = one.camera == two.camera && one.image == two.image;
        if !is_in_place || !is_same_view || self.averaged != other.averaged {
            return part;
        }
        let (camera, image) = grid.view(one);
        let projection = Projection::quick(&camera, &image);
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for object in 0..one.objects.len() {
            let states =
                [self, other].map(|one| (one.is_drawn[object], one.scene.objects[object].shape));
            if states[0] == states[1] {
                continue;
            }
            for (_, shape) in states.iter().filter(|(is_drawn, _)| *is_drawn) {
                let Some([low, high]) = bounds(shape, &projection) else {
                    return part;
                };
                (least, most) = (least.min(low), most.max(high));
            }
        }
        let corner = DVec2::new(f64::from(part.x), f64::from(part.y));
        let size = DVec2::new(f64::from(part.width), f64::from(part.height));
        let least = (least.floor() - corner).clamp(DVec2::ZERO, size);
        let most = (most.ceil() - corner).clamp(least, size);
        Area {
            x: part.x + least.x as u32,
            y: part.y + least.y as u32,
            width: (most.x - least.x) as u32,
            height: (most.y - least.y) as u32,
        }
    }
}

/// What is made in a part of the picture, of which all is known but an area.
fn completed(
    known: Option<(&Arc<Moments>, Area)>,
    part: Area,
    make: impl FnOnce(Area) -> Option<Moments>,
) -> Option<Arc<Moments>> {
    match known {
        Some((known, area)) if area.pixels() == 0 => Some(Arc::clone(known)),
        Some((known, area)) if area != part => {
            let mut all = Moments::clone(known);
            all.put(part, area, &make(area)?);
            Some(Arc::new(all))
        }
        _ => Some(Arc::new(make(part)?)),
    }
}

/// What samples show of a program that behaves otherwise, and how far off these means may be; where
/// samples of a right one show the same, it is what that shows exactly.
fn replaced_where_they_differ(mut right: Moments, own: &Moments, other: &Moments) -> Moments {
    for at in 0..other.mean.len() {
        let variance = other.variance[at];
        if own.mean[at] != other.mean[at] || own.variance[at] != variance {
            (right.mean[at], right.variance[at]) = (other.mean[at], variance);
            right.doubt[at] = variance / SAMPLES as f64 + MISSED * MISSED;
        }
    }
    right
}
