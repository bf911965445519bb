//! What a candidate shows on a grid: exactly, but for behaviour that no scene can say, which the textbook's tracer samples.

use std::sync::{Arc, atomic::AtomicBool};

use glam::DVec2;

use super::{
    axes::Axes,
    candidate::Candidate,
    grid::Grid,
    layout::Layout,
    light::{Average, Look, STEP, is_near},
    score::Model,
    textbook::{Behaviour, Behind, Moments, Textbook, bounds},
};
use crate::{
    area::Area,
    color::Color,
    exact::{ExactPixel, Integrator},
    scene::{Camera, Scene},
    tracer::World,
};

/// Samples in a cell of what no scene can say.
const SAMPLES: usize = 34;

/// The share of a cell that may be missed where the textbook takes it for one of a single colour.
const MISSED: f64 = 1e-3;

/// What a candidate makes, before it is laid out and its light is changed.
pub struct Made {
    pub candidate: Candidate,
    part: Area,
    /// How many cells were computed for it, exactly or by all samples.
    pub work: f64,
    /// What it would make if it behaved as a right program.
    right: Moments,
    /// How far the means are off of what is told from it by samples, where it was made for that.
    error: Option<Arc<[[f64; 3]]>>,
    /// What it makes, and the variance of these means.
    behaved: Option<(Moments, Vec<[f64; 3]>)>,
}

impl Made {
    /// What it would make if it behaved as a right program.
    pub fn moments(&self) -> &Moments {
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
        let (moments, doubt) = match &self.behaved {
            Some((moments, doubt)) => (moments, ordered(doubt)),
            None => (&self.right, Vec::new()),
        };
        let mut model = Model {
            moments: Moments {
                mean: ordered(&moments.mean),
                variance: ordered(&moments.variance),
            },
            doubt,
            cut: 0.0,
            curve: self.candidate.curve,
        };
        model.look(&self.candidate.looks, grid, seen);
        model
    }
}

/// The exact means and variances of what a part of a scene's picture shows.
pub fn exact_moments(
    scene: &Scene,
    average: Average,
    part: Area,
    cancel: &AtomicBool,
) -> Option<Moments> {
    let world = World::new_unless(scene, cancel).ok()?;
    // Each channel and its square.
    let numbers = |color: Color| {
        let [r, g, b] = color.to_linear().map(|light| average.of(light));
        [r, g, b, r * r, g * g, b * b]
    };
    let pixels = Integrator::of(&world, numbers).pixels(part, cancel)?;
    let moments = |pixel: ExactPixel<6>| {
        let [r, g, b, rr, gg, bb] = pixel.mean;
        let doubt = pixel.bound * pixel.bound;
        let variance = |mean: f64, square: f64| (square - mean * mean).max(0.0) + doubt;
        (
            [r, g, b],
            [variance(r, rr), variance(g, gg), variance(b, bb)],
        )
    };
    let (mean, variance) = pixels.into_iter().map(moments).unzip();
    Some(Moments { mean, variance })
}

impl Model {
    /// Does to the light what is done to it.
    pub fn look(&mut self, looks: &[Look], grid: &Grid, seen: &[[f64; 3]]) {
        let Moments { mean, variance } = &mut self.moments;
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
        let mut scene = grid.scene(&self.scene, self.layout.half_pixels != [0, 0]);
        let mut is_drawn = self.is_drawn.iter();
        scene.objects.retain(|_| is_drawn.next() == Some(&true));
        scene
    }

    /// What it shows in the cells of a grid: exactly, or by so many samples in a cell where these are given. What it shows as one of others does is taken from
    /// that which shows most of it. None if it is cancelled.
    pub fn made(
        &self,
        grid: &Grid,
        samples: Option<usize>,
        likes: &[&Made],
        cancel: &AtomicBool,
    ) -> Option<Made> {
        let part = self.layout.sources(grid.cells, grid.size());
        let scene = self.drawn(grid);
        let sampled = |behaviour, area, samples| {
            Textbook::new(&scene, behaviour, |light| self.average.of(light)).moments(area, samples)
        };
        let render = |area| match samples {
            None => exact_moments(&scene, self.average, area, cancel),
            Some(samples) => Some(sampled(self.behaviour, area, samples)),
        };
        let is_alike = |like: &&Made| {
            let other = &like.candidate;
            let behaves = samples.is_none()
                || other.behaviour == self.behaviour && self.is_seen_where_it_is();
            let is_in_place = other.layout.half_pixels == self.layout.half_pixels;
            like.part == part && is_in_place && behaves
        };
        let likes = likes.iter().copied().filter(is_alike);
        let likes =
            likes.filter_map(|like| Some((like, self.changed(&like.candidate, grid, part)?)));
        let nearest = likes.min_by_key(|(like, changed)| {
            let behaves = like.candidate.behaviour == self.behaviour;
            (!behaves, changed.pixels())
        });
        let (like, changed) = nearest.unzip();
        // A sample takes less time than a cell.
        let cost = if samples.is_none() { 1.0 } else { 0.1 };
        let mut work = cost * changed.unwrap_or(part).pixels() as f64;
        let right = match (like, changed) {
            (Some(like), Some(area)) => {
                let mut moments = like.right.clone();
                if area.pixels() > 0 {
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
                }
                moments
            }
            _ => render(part)?,
        };
        // No scene says what a program does that behaves otherwise. Where its samples show something else than those of a right one, their difference comes on top.
        let behaved = (samples.is_none() && self.behaviour != Behaviour::RIGHT).then(|| {
            let is_near = |like: &&Made| {
                like.candidate.behaviour == self.behaviour && self.is_seen_where_it_is()
            };
            let near = like
                .filter(is_near)
                .and_then(|like| Some((like.behaved.clone()?, changed?)));
            let ((mut behaved, mut doubt), area) =
                near.unwrap_or_else(|| ((right.clone(), vec![[0.0; 3]; right.mean.len()]), part));
            work += 2.0 * area.pixels() as f64;
            let other = sampled(self.behaviour, area, SAMPLES);
            let own = sampled(Behaviour::RIGHT, area, SAMPLES);
            for (from, (x, y)) in area.iter().enumerate() {
                let at = part.index(x, y);
                let is_alike = other.mean[from] == own.mean[from]
                    && other.variance[from] == own.variance[from];
                let is_flat = other.variance[from] == [0.0; 3];
                let sum = |i: usize| match is_flat {
                    true => other.mean[from][i],
                    false => (right.mean[at][i] + other.mean[from][i] - own.mean[from][i])
                        .clamp(0.0, 1.0),
                };
                let variances = |i: usize| {
                    (other.variance[from][i] + if is_flat { 0.0 } else { own.variance[from][i] })
                        / SAMPLES as f64
                        + MISSED * MISSED
                };
                (behaved.mean[at], behaved.variance[at], doubt[at]) = match is_alike {
                    true => (right.mean[at], right.variance[at], [0.0; 3]),
                    false => (
                        [0, 1, 2].map(sum),
                        other.variance[from],
                        [0, 1, 2].map(variances),
                    ),
                };
            }
            (behaved, doubt)
        });
        Some(Made {
            candidate: self.clone(),
            part,
            work,
            right,
            behaved,
            error: like.and_then(|like| like.error.clone()),
        })
    }

    /// What it shows exactly in the cells of a grid, from which others will be told by so many samples in a cell: what these are off here is taken from all
    /// that differ from it in a part of the picture.
    pub fn made_to_compare(
        &self,
        grid: &Grid,
        samples: usize,
        cancel: &AtomicBool,
    ) -> Option<Made> {
        let sampled = self.made(grid, Some(samples), &[], cancel)?;
        if self.behaviour != Behaviour::RIGHT {
            return Some(sampled);
        }
        let exact = self.made(grid, None, &[], cancel)?;
        let pairs = sampled.right.mean.iter().zip(&exact.right.mean);
        let error = pairs.map(|(sampled, exact)| [0, 1, 2].map(|i| sampled[i] - exact[i]));
        Some(Made {
            error: Some(error.collect()),
            ..exact
        })
    }

    /// Whether objects are seen only where they are.
    fn is_seen_where_it_is(&self) -> bool {
        self.behaviour.behind == Behind::Unseen && !self.behaviour.is_squeezed
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
        let scenes =
            [self, other].map(|one| grid.scene(&one.scene, self.layout.half_pixels != [0, 0]));
        let axes = Axes::new(&scenes[0].camera, &scenes[0].image);
        let (mut least, mut most) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for object in 0..self.scene.objects.len() {
            let states = [(self, 0), (other, 1)]
                .map(|(one, i)| (one.is_drawn[object], scenes[i].objects[object].shape));
            if states[0] == states[1] {
                continue;
            }
            for (is_drawn, shape) in states {
                if is_drawn {
                    let [low, high] = bounds(&shape, &axes)?;
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
