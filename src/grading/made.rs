//! What a candidate shows in the cells of a grid, means and variances: exactly, or sampled by the textbook's tracer, on the tiny grid and for behaviour that no
//! scene can say.

use std::{cell::OnceCell, sync::Arc};

use glam::DVec2;

use super::{
    axes::Axes,
    candidate::Candidate,
    grid::Grid,
    layout::Layout,
    light::{Look, STEP, is_near},
    score::Model,
    textbook::{Behaviour, Behind, Moments, Textbook, bounds},
    work::Work,
};
use crate::{
    area::Area,
    scene::{Camera, Scene},
};

/// Samples in a cell of what no scene can say.
const SAMPLES: usize = 34;

/// The share of a cell that may be missed where the textbook takes it for one of a single colour.
const MISSED: f64 = 1e-3;

/// What a candidate makes, before it is laid out and its light is changed.
#[derive(Clone)]
pub struct Made {
    pub candidate: Candidate,
    pub part: Area,
    /// What it would make if it behaved as a right program; in samples, what it makes as it behaves.
    right: Arc<Moments>,
    /// How far the means are off of what is told from it by samples, where it was made for that.
    error: Option<Arc<[[f64; 3]]>>,
    /// What it makes, and the variance of these means.
    behaved: Option<Arc<(Moments, Vec<[f64; 3]>)>>,
}

impl Made {
    /// What a candidate that behaves as a right program makes in a part of the picture.
    pub fn new(candidate: Candidate, part: Area, moments: Moments) -> Self {
        Self {
            candidate,
            part,
            right: Arc::new(moments),
            error: None,
            behaved: None,
        }
    }

    /// What it would make if it behaved as a right program.
    pub fn moments(&self) -> &Arc<Moments> {
        &self.right
    }

    /// As it is shown in the cells of a grid, of which a picture shows something.
    pub fn model(&self, grid: &Grid, seen: &[[f64; 3]]) -> Model {
        let layout = self.candidate.layout;
        let index = |pixel| {
            let (x, y) = layout.source(pixel, grid.size());
            self.part.index(x, y)
        };
        let order: Vec<usize> = match layout == Layout::default() {
            true => Vec::new(),
            false => grid.cells.iter().map(index).collect(),
        };
        let ordered = |all: &[[f64; 3]]| match order.is_empty() {
            true => all.to_vec(),
            false => order.iter().map(|&at| all[at]).collect(),
        };
        let all = |moments: &Moments| {
            Arc::new(Moments {
                mean: ordered(&moments.mean),
                variance: ordered(&moments.variance),
            })
        };
        let (moments, doubt) = match self.behaved.as_deref() {
            Some((moments, doubt)) => (all(moments), ordered(doubt)),
            None if order.is_empty() => (Arc::clone(&self.right), Vec::new()),
            None => (all(&self.right), Vec::new()),
        };
        let mut model = Model {
            moments,
            doubt,
            cut: 0.0,
            curve: self.candidate.curve,
        };
        model.look(&self.candidate.looks, grid, seen);
        model
    }
}

impl Model {
    /// Does to the light what is done to it.
    pub fn look(&mut self, looks: &[Look], grid: &Grid, seen: &[[f64; 3]]) {
        if looks.is_empty() {
            return;
        }
        let Moments { mean, variance } = Arc::make_mut(&mut self.moments);
        for look in looks {
            match *look {
                Look::Channels(order) => {
                    for one in mean.iter_mut().chain(variance.iter_mut()) {
                        *one = order.map(|i| one[i]);
                    }
                }
                Look::Gray(weights) => {
                    for one in mean.iter_mut() {
                        *one = [(0..3).map(|i| weights[i] * one[i]).sum(); 3];
                    }
                    for one in variance.iter_mut() {
                        let deviation: f64 = (0..3).map(|i| weights[i] * one[i].sqrt()).sum();
                        *one = [deviation * deviation; 3];
                    }
                }
                Look::Curve(curve) => {
                    let mut last = [(f64::NAN, 0.0, 0.0); 3];
                    for (mean, variance) in mean.iter_mut().zip(variance.iter_mut()) {
                        for i in 0..3 {
                            if mean[i] != last[i].0 {
                                // The slope over what noise of a sample or a step may reach.
                                let by = variance[i].sqrt().max(STEP) / 4.0;
                                let (low, high) = ((mean[i] - by).max(0.0), mean[i] + by);
                                let slope = (curve(high) - curve(low)) / (high - low);
                                last[i] = (mean[i], curve(mean[i]), slope);
                            }
                            variance[i] *= last[i].2 * last[i].2;
                            mean[i] = last[i].1;
                        }
                    }
                }
                Look::CutOff => self.cut = -0.5,
                Look::Patch {
                    light,
                    area: [[left, top], [right, bottom]],
                } => {
                    let is_part = |at: usize| {
                        let place = grid.middle(at);
                        let is_within =
                            (left..right).contains(&place.x) && (top..bottom).contains(&place.y);
                        is_within && is_near(seen[at], light)
                    };
                    let width = grid.width();
                    for at in (0..mean.len()).filter(|&at| is_part(at)) {
                        // Its border is mixed with what is beside it.
                        let rows = [at.checked_sub(width), Some(at), Some(at + width)];
                        let cells = rows
                            .into_iter()
                            .flatten()
                            .flat_map(|at| at.saturating_sub(1)..at + 2);
                        for at in cells.filter(|&at| at < seen.len()) {
                            mean[at] = seen[at];
                            variance[at] = [0.0; 3];
                        }
                    }
                }
            }
        }
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

    /// What it shows in the cells of a grid: exactly, or by so many samples in a cell where these are given. What it shows as one of others does is taken from
    /// that which shows most of it. None if it is cancelled, or takes too much work.
    pub fn made(
        &self,
        grid: &Grid,
        samples: Option<usize>,
        likes: &[&Made],
        work: &Work,
    ) -> Option<Made> {
        let part = self.layout.sources(grid.cells, grid.size());
        // Objects are seen only where they are.
        let is_in_place = self.behaviour.behind == Behind::Unseen && !self.behaviour.is_squeezed;
        let is_alike = |like: &&Made| {
            let other = &like.candidate;
            let behaves = samples.is_none() || other.behaviour == self.behaviour && is_in_place;
            let are_shifted = other.layout.is_shifted() == self.layout.is_shifted();
            like.part == part && are_shifted && behaves
        };
        let likes = likes.iter().copied().filter(is_alike);
        let likes =
            likes.filter_map(|like| Some((like, self.changed(&like.candidate, grid, part)?)));
        let nearest = likes.min_by_key(|(_, changed)| changed.pixels());
        let (like, changed) = nearest.unzip();
        let scene = OnceCell::new();
        let scene = || scene.get_or_init(|| self.drawn(grid));
        let sampled = |behaviour: Behaviour, area: Area, samples: usize| {
            work.pay_for_samples(self.scene.objects.len(), samples, area)?;
            let textbook = Textbook::new(scene(), behaviour, self.average);
            Some(textbook.moments(area, samples))
        };
        let render = |area| match samples {
            None => work.exact_moments(scene(), self.average, area),
            Some(samples) => sampled(self.behaviour, area, samples),
        };
        let right = match (like, changed) {
            (Some(like), Some(area)) if area.pixels() == 0 => Arc::clone(&like.right),
            (Some(like), Some(area)) => {
                let mut moments = Moments::clone(&like.right);
                let mut own = render(area)?;
                if let Some(error) = &like.error {
                    for ((x, y), mean) in area.iter().zip(&mut own.mean) {
                        let error = error[part.index(x, y)];
                        *mean = [0, 1, 2].map(|i| mean[i] - error[i]);
                    }
                }
                for ((at, mean), variance) in area.iter().zip(own.mean).zip(own.variance) {
                    let index = part.index(at.0, at.1);
                    (moments.mean[index], moments.variance[index]) = (mean, variance);
                }
                Arc::new(moments)
            }
            _ => Arc::new(render(part)?),
        };
        let is_local = is_in_place || changed.is_some_and(|changed| changed.pixels() == 0);
        let is_near = |like: &&Made| like.candidate.behaviour == self.behaviour && is_local;
        let near = like.filter(is_near).and_then(|like| like.behaved.clone());
        let behaved = match samples.is_none() && self.behaviour != Behaviour::RIGHT {
            true => {
                let doubt = || vec![[0.0; 3]; right.mean.len()];
                let (mut behaved, area) = match near.zip(changed) {
                    Some((near, changed)) => (near, changed),
                    None => (Arc::new((Moments::clone(&right), doubt())), part),
                };
                let all = Arc::make_mut(&mut behaved);
                put_samples(all, &right, &sampled, self.behaviour, [area, part])?;
                Some(behaved)
            }
            false => None,
        };
        Some(Made {
            candidate: self.clone(),
            part,
            right,
            behaved,
            error: like.and_then(|like| like.error.clone()),
        })
    }

    /// What it shows exactly in the cells of a grid, from which others will be told by so many samples in a cell: what these are off here is taken from all
    /// that differ from it in a part of the picture.
    pub fn made_to_compare(
        &self,
        exact: Option<&Made>,
        grid: &Grid,
        samples: usize,
        work: &Work,
    ) -> Option<Made> {
        let sampled = self.made(grid, Some(samples), &[], work)?;
        let Some(exact) = exact else {
            return Some(sampled);
        };
        let pairs = sampled.right.mean.iter().zip(&exact.right.mean);
        let error = pairs.map(|(sampled, exact)| [0, 1, 2].map(|i| sampled[i] - exact[i]));
        Some(Made {
            candidate: self.clone(),
            error: Some(error.collect()),
            ..exact.clone()
        })
    }

    /// The part of a part of the picture, before it is laid out, outside of which two candidates show the same; none where that is not known.
    fn changed(&self, other: &Self, grid: &Grid, part: Area) -> Option<Area> {
        let (one, two) = (&self.scene, &other.scene);
        // Rays are the same, wherever they may end.
        let camera = Camera {
            near: two.camera.near,
            far: two.camera.far,
            ..one.camera
        };
        let is_alike = camera == two.camera && one.image == two.image;
        (is_alike && self.average == other.average).then_some(())?;
        if one.camera != two.camera {
            return Some(part);
        }
        let nothing = Area {
            width: 0,
            height: 0,
            ..part
        };
        if Arc::ptr_eq(&one.objects, &two.objects) && self.is_drawn == other.is_drawn {
            return Some(nothing);
        }
        let (camera, image) = grid.view(&self.scene, self.layout.is_shifted());
        let axes = Axes::new(&camera, &image);
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for object in 0..self.scene.objects.len() {
            let states =
                [self, other].map(|one| (one.is_drawn[object], one.scene.objects[object].shape));
            if states[0] == states[1] {
                continue;
            }
            for (is_drawn, shape) in states {
                if is_drawn {
                    let [low, high] = bounds(&shape, &axes, true)?;
                    (least, most) = (least.min(low), most.max(high));
                }
            }
        }
        let first = |at: f64, from: u32| (at.floor().max(f64::from(from)) as u32).max(from);
        let (x, y) = (first(least.x, part.x), first(least.y, part.y));
        let end = |at: f64, to: u32| (at.ceil().min(f64::from(to)).max(0.0) as u32).min(to);
        let (right, bottom) = (
            end(most.x, part.x + part.width),
            end(most.y, part.y + part.height),
        );
        Some(Area {
            x,
            y,
            width: right.saturating_sub(x),
            height: bottom.saturating_sub(y),
        })
    }
}

/// Puts what samples show of a program that behaves otherwise, which no scene can say, and the variance of these means, into an area of a part; where samples of
/// a right one show the same, it is what that shows exactly.
fn put_samples(
    (behaved, doubt): &mut (Moments, Vec<[f64; 3]>),
    right: &Moments,
    sampled: &dyn Fn(Behaviour, Area, usize) -> Option<Moments>,
    behaviour: Behaviour,
    [area, part]: [Area; 2],
) -> Option<()> {
    if area.pixels() == 0 {
        return Some(());
    }
    let own = sampled(Behaviour::RIGHT, area, SAMPLES)?;
    let other = sampled(behaviour, area, SAMPLES)?;
    for (from, (x, y)) in area.iter().enumerate() {
        let at = part.index(x, y);
        let is_alike = |one: &[[f64; 3]], other: &[[f64; 3]]| one[from] == other[from];
        (behaved.mean[at], behaved.variance[at], doubt[at]) =
            match is_alike(&own.mean, &other.mean) && is_alike(&own.variance, &other.variance) {
                true => (right.mean[at], right.variance[at], [0.0; 3]),
                false => {
                    let variance = other.variance[from];
                    let doubt = variance.map(|one| one / SAMPLES as f64 + MISSED * MISSED);
                    (other.mean[from], variance, doubt)
                }
            };
    }
    Some(())
}
