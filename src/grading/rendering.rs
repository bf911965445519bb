//! What a candidate makes in the cells of a grid, before it is laid out and its light is changed: exactly, or sampled by the textbook's tracer, on the tiny grid
//! and for behaviour that no scene can say.

use std::{cell::OnceCell, sync::Arc};

use glam::DVec2;

use super::{
    axes::Axes,
    candidate::Candidate,
    grid::Grid,
    moments::Moments,
    textbook::{Behaviour, Behind, Textbook, bounds},
    work::Work,
};
use crate::{area::Area, scene::Scene};

/// Samples in a cell of what no scene can say.
const SAMPLES: usize = 34;

/// The share of a cell that may be missed where the textbook takes it for one of a single colour.
const MISSED: f64 = 1e-3;

/// What a candidate makes.
#[derive(Clone)]
pub struct Rendering {
    pub candidate: Candidate,
    pub part: Area,
    /// What it would make if it behaved as a right program; in samples, what it makes as it behaves.
    pub right: Arc<Moments>,
    /// What it makes, if it behaves otherwise.
    behaved: Option<Arc<Moments>>,
}

impl Rendering {
    /// What a candidate that behaves as a right program makes in a part of the picture.
    pub fn new(candidate: Candidate, part: Area, moments: Arc<Moments>) -> Self {
        Self {
            candidate,
            part,
            right: moments,
            behaved: None,
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
        let (camera, image) = grid.view(&self.scene, self.layout.is_shifted());
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

    /// What it makes in the cells of a grid: exactly, or by so many samples in a cell where these are given. What it makes as one of others does is taken from
    /// that which makes most of it. None if it is cancelled, or takes too much work.
    pub fn render(
        &self,
        grid: &Grid,
        samples: Option<usize>,
        likes: &[&Rendering],
        work: &Work,
    ) -> Option<Rendering> {
        let part = self.layout.sources(grid.cells, grid.size());
        let is_alike = |like: &&Rendering| {
            let behaves = like.candidate.behaviour == self.behaviour;
            like.part == part && (samples.is_none() || behaves)
        };
        let likes = likes.iter().copied().filter(is_alike);
        let likes = likes.map(|like| (like, self.changed(&like.candidate, grid, part)));
        let nearest = likes.min_by_key(|(_, changed)| changed.pixels());
        let scene = OnceCell::new();
        let scene = || scene.get_or_init(|| self.drawn(grid));
        let sampled = |behaviour: Behaviour, area: Area, samples: usize| {
            work.pay_for_samples(self.scene.objects.len(), samples, area)?;
            let textbook = Textbook::new(scene(), behaviour, self.averaged);
            Some(textbook.moments(area, samples))
        };
        let traced = |area| match samples {
            None => work.exact_moments(scene(), self.averaged, area),
            Some(samples) => sampled(self.behaviour, area, samples),
        };
        let right = match nearest {
            Some((like, area)) if area.pixels() == 0 => Arc::clone(&like.right),
            Some((like, area)) if area != part => {
                let mut moments = Moments::clone(&like.right);
                moments.put(part, area, &traced(area)?);
                Arc::new(moments)
            }
            _ => Arc::new(traced(part)?),
        };
        let mut behaved = None;
        if samples.is_none() && self.behaviour != Behaviour::RIGHT {
            let near = nearest.filter(|(like, _)| like.candidate.behaviour == self.behaviour);
            let near = near.and_then(|(like, area)| Some((like.behaved.clone()?, area)));
            let (mut all, area) = near.unwrap_or_else(|| (Arc::clone(&right), part));
            if area.pixels() > 0 {
                let [own, other] = [
                    sampled(Behaviour::RIGHT, area, SAMPLES)?,
                    sampled(self.behaviour, area, SAMPLES)?,
                ];
                put_samples(
                    Arc::make_mut(&mut all),
                    &right,
                    [&own, &other],
                    [area, part],
                );
            }
            behaved = Some(all);
        }
        Some(Rendering {
            candidate: self.clone(),
            part,
            right,
            behaved,
        })
    }

    /// The area of a part of the picture, before it is laid out, outside of which it is known that another candidate shows the same.
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
        let is_in_place = self.behaviour.behind == Behind::Unseen && !self.behaviour.is_squeezed;
        let is_same_view = one.camera == two.camera && one.image == two.image;
        if !is_in_place || !is_same_view || self.averaged != other.averaged {
            return part;
        }
        let (camera, image) = grid.view(one, self.layout.is_shifted());
        let axes = Axes::new(&camera, &image);
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for object in 0..one.objects.len() {
            let states =
                [self, other].map(|one| (one.is_drawn[object], one.scene.objects[object].shape));
            if states[0] == states[1] {
                continue;
            }
            for (_, shape) in states.iter().filter(|(is_drawn, _)| *is_drawn) {
                let Some([low, high]) = bounds(shape, &axes) else {
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

/// Puts what samples show of a program that behaves otherwise, and how far off these means may be, into an area of a part; where samples of a right one show the
/// same, it is what that shows exactly.
fn put_samples(
    all: &mut Moments,
    right: &Moments,
    [own, other]: [&Moments; 2],
    [area, part]: [Area; 2],
) {
    all.doubt.resize(all.mean.len(), [0.0; 3]);
    for (from, (x, y)) in area.iter().enumerate() {
        let at = part.index(x, y);
        let is_alike =
            own.mean[from] == other.mean[from] && own.variance[from] == other.variance[from];
        (all.mean[at], all.variance[at], all.doubt[at]) = match is_alike {
            true => (right.mean[at], right.variance[at], [0.0; 3]),
            false => {
                let variance = other.variance[from];
                let doubt = variance.map(|one| one / SAMPLES as f64 + MISSED * MISSED);
                (other.mean[from], variance, doubt)
            }
        };
    }
}
