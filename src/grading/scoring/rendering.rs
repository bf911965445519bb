//! Renders the scene of a hypothesis about the program in the cells of a grid. Wrong arrangements
//! of pixels and effects on light are applied later. The result is exact if the program traces rays
//! correctly. If it does not, or if the grid is the coarsest one, [`FaultyTracer`] takes samples.

use std::{cell::OnceCell, sync::Arc};

use glam::DVec2;

use super::{
    faulty_tracer::{FaultyTracer, bounds, lattice},
    grid::Grid,
    moments::Moments,
    work::Work,
};
use crate::{
    area::Area,
    grading::hypotheses::{Behaviour, Candidate},
    projection::Projection,
    scene::Scene,
};

/// Number of samples per cell for a program that traces rays wrongly, because its picture cannot be
/// rendered exactly. It is a Fibonacci number, because the samples form a Fibonacci lattice. With
/// more samples, pictures are less noisy, but take longer.
const SAMPLES: usize = 34;

/// Fraction of a cell's area whose colour [`FaultyTracer`] may overlook. The tracer assumes that a
/// cell has one colour if some tested positions show one colour. An edge that passes by all these
/// positions cuts off about 0.1 % of the cell on average.
const MISSED: f64 = 1e-3;

/// Means and variances of the cells that a hypothesis about the program renders.
#[derive(Clone)]
pub struct Rendering {
    pub candidate: Candidate,
    pub part: Area,
    /// Means and variances if the scene of the hypothesis is traced correctly. Only on the coarsest
    /// grid, the scene is traced with the faults of the hypothesis.
    pub correct: Arc<Moments>,
    /// Means and variances if the scene is traced with the faults of the hypothesis. `None` if
    /// there are no faults, and always on the coarsest grid, where `correct` contains them.
    behaved: Option<Arc<Moments>>,
}

impl Rendering {
    /// Creates the rendering of a hypothesis in the area `part`. The hypothesis must trace rays
    /// correctly.
    pub fn new(candidate: Candidate, part: Area, moments: Arc<Moments>) -> Self {
        Self {
            candidate,
            part,
            correct: moments,
            behaved: None,
        }
    }

    /// Returns the part of the rendering that lies in `grid`, which must have the same resolution.
    pub fn cropped(&self, grid: &Grid) -> Self {
        let part = self.candidate.layout.sources(grid.cells, grid.size);
        let order: Vec<usize> = part.iter().map(|(x, y)| self.part.index(x, y)).collect();
        let cropped = |all: &Arc<Moments>| Arc::new(all.select(&order));
        Self {
            candidate: self.candidate.clone(),
            part,
            correct: cropped(&self.correct),
            behaved: self.behaved.as_ref().map(cropped),
        }
    }

    /// Returns the means and variances in the cells of a grid, after the hypothesis has rearranged
    /// its pixels.
    pub fn laid_out(&self, grid: &Grid) -> Arc<Moments> {
        let moments = self.behaved.as_ref().unwrap_or(&self.correct);
        let layout = self.candidate.layout;
        if layout == Default::default() {
            return Arc::clone(moments);
        }
        let index = |pixel| {
            let (x, y) = layout.source(pixel, grid.size);
            self.part.index(x, y)
        };
        let order: Vec<usize> = grid.cells.iter().map(index).collect();
        Arc::new(moments.select(&order))
    }
}

impl Candidate {
    /// Returns the hypothesis's scene, with a camera and an image for which each pixel is a cell of
    /// the grid. Objects that the hypothesis does not draw are left out.
    pub fn drawn(&self, grid: &Grid) -> Scene {
        let (camera, image) = grid.view(&self.scene);
        let mut scene = Scene {
            camera,
            image,
            ..self.scene.clone()
        };
        if self.is_drawn.contains(&false) {
            let mut is_drawn = self.is_drawn.iter();
            scene
                .objects_mut()
                .retain(|_| is_drawn.next() == Some(&true));
        }
        scene
    }

    /// Renders the hypothesis in the cells of a grid: exactly, or with `samples` samples per cell.
    /// Cells that look the same in a rendering in `known` are copied from this rendering. Returns
    /// `None` if the work is cancelled or exceeds its budget.
    pub fn render(
        &self,
        grid: &Grid,
        samples: Option<usize>,
        known: &[Arc<Rendering>],
        work: &Work,
    ) -> Option<Rendering> {
        let part = self.layout.sources(grid.cells, grid.size);
        let is_reusable = |one: &&Arc<Rendering>| {
            let behaves = one.candidate.behaviour == self.behaviour;
            one.part == part && (samples.is_none() || behaves)
        };
        let reusable = known.iter().filter(is_reusable);
        let reusable = reusable.map(|one| (one, self.changed(&one.candidate, grid, part)));
        let nearest = reusable.min_by_key(|(one, changed)| {
            let behaves_otherwise = one.candidate.behaviour != self.behaviour;
            (changed.pixels(), behaves_otherwise)
        });
        let scene = OnceCell::new();
        let scene = || scene.get_or_init(|| self.drawn(grid));
        let tracer = |behaviour: Behaviour| {
            // The scene contains only the objects that the program draws. So the index of the
            // faulty object is converted to its index among the drawn objects.
            let drawn = |at: usize| self.is_drawn[..at].iter().filter(|is| **is).count();
            let hit = behaviour.hit.filter(|(at, _)| self.is_drawn[*at]);
            let behaviour = Behaviour {
                hit: hit.map(|(at, hit)| (drawn(at), hit)),
                offset: behaviour.offset.map(|by| by / f64::from(grid.factor)),
                pixel: 1.0 + (behaviour.pixel - 1.0) / f64::from(grid.factor),
                ..behaviour
            };
            FaultyTracer::new(scene(), behaviour, self.decoding)
        };
        let objects = self.scene.objects.len();
        let traced = |area| match samples {
            None => work.exact_moments(scene(), self.decoding, area),
            Some(samples) => {
                work.pay_for_samples(objects, samples, area)?;
                Some(tracer(self.behaviour).moments(area, samples))
            }
        };
        let correct = nearest.map(|(one, area)| (&one.correct, area));
        let correct = completed(correct, part, traced)?;
        let mut behaved = None;
        if samples.is_none() && !self.behaviour.is_correct() {
            let nearest = nearest.filter(|(one, _)| one.candidate.behaviour == self.behaviour);
            let nearest = nearest.and_then(|(one, area)| Some((one.behaved.as_ref()?, area)));
            behaved = Some(completed(nearest, part, |area| {
                work.pay_for_samples(objects, SAMPLES, area)?;
                let indices: Vec<usize> = area.iter().map(|(x, y)| part.index(x, y)).collect();
                let own = tracer(self.behaviour).moments(area, SAMPLES);
                let right = tracer(Behaviour::default());
                let correct = correct.select(&indices);
                Some(replaced_where_they_differ(correct, &own, &right, area))
            })?);
        }
        Some(Rendering {
            candidate: self.clone(),
            part,
            correct,
            behaved,
        })
    }

    /// Returns the area of `part` in which the pictures of two hypotheses may differ. Wrong
    /// arrangements of pixels are not yet applied to these pictures.
    fn changed(&self, other: &Self, grid: &Grid, part: Area) -> Area {
        if self.traces_as(other) {
            return Area::whole(0, 0);
        }
        let (one, two) = (&self.scene, &other.scene);
        // If no object is seen outside its correct outline, a changed object makes a difference
        // only inside its bounding rectangle.
        let is_in_place = self.behaviour.is_in_place();
        let is_same_view = one.camera == two.camera && one.image == two.image;
        if !is_in_place || !is_same_view || self.decoding != other.decoding {
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

/// Returns the means and variances of the cells of `part`. `known` contains means and variances
/// that can be copied, except in the area that it also contains. The cells in this area are
/// computed by `make`. If `known` is `None`, `make` computes all cells.
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

/// Replaces exact means and variances by sampled ones in those cells of `area` in which the
/// program's faults make a difference. `own` contains the sampled cells. The faults make no
/// difference in a cell if it equals the exact cell in `correct`, or the cell that `right`, a
/// tracer without faults, computes from the same samples.
fn replaced_where_they_differ(
    mut correct: Moments,
    own: &Moments,
    right: &FaultyTracer,
    area: Area,
) -> Moments {
    let (places, mut rays) = (lattice(SAMPLES), Vec::new());
    for (at, cell) in area.iter().enumerate() {
        let (mean, variance) = (own.mean[at], own.variance[at]);
        let is_same = (correct.mean[at], correct.variance[at]) == (mean, variance)
            || right.cell(cell, &places, &mut rays) == (mean, variance);
        if !is_same {
            (correct.mean[at], correct.variance[at]) = (mean, variance);
            correct.mean_variance[at] = variance / SAMPLES as f64 + MISSED * MISSED;
        }
    }
    correct
}
