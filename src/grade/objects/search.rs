//! Objects in a wrong place or of a wrong size.

mod fields;

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

use super::{
    ENOUGH, SEARCHED, called,
    colors::{Near, color, share},
    likeliest, moved, with_shape,
};
use crate::{
    area::Area,
    film::{Film, rmse},
    grade::{
        Case, Idea, LEFT, Make,
        bias::SIGMAS,
        extent::ball,
        fit::{Fit, fit},
        level::axes,
    },
    numbers::{found, found_near, found_vector, short, short_vector},
    render::RenderError,
    scene::{Scene, Shape},
};

/// A search for an object's place is worth its time if the pixels of its colour have this share of the squared difference: what is wrong
/// is where it is and is not, so that nearly all of it is theirs; others of its colour and noise leave less.
const OWN: f64 = 0.4;

/// And if the part of the picture in which it should be has this share: if it is elsewhere, that has as much, unless what is there is of
/// about its colour. Of a white object on a white and black floor half is lost on each side, and less than a half of the rest.
const OWN_PART: f64 = 0.1;

/// What moves an object, or its outline, by less than this, in pixels, is seen best by what a smaller step changes: a step's half pixel and the pixel's own
/// width on either side overlap with it.
const LITTLE: f64 = 3.0;

/// Objects in a wrong place or of a wrong size, found by what a small step of them changes, or by their colours.
pub fn search(case: &Case) -> Result<Vec<Idea>, RenderError> {
    let mut all = steps(case)?;
    for step in blobs(case) {
        let is_known = all.iter().any(|known| known.index == step.index);
        // Of more than a little a small step tells less than a colour.
        let is_large = || Sought::new(case, &step).is_some_and(|object| !object.is_little);
        if !is_known || is_large() {
            all.push(step);
        }
    }
    if case.full.is_heavy {
        // Each is fitted many times.
        all.truncate(case.most(SEARCHED));
    } else {
        all.extend(unknown(case, &all));
    }
    let mut ideas = Vec::new();
    let mut explained = None;
    for step in all {
        // What explains the picture need not be found again from another start.
        if explained != Some(step.index)
            && let Some(object) = Sought::new(case, &step)
        {
            let found = object.ideas(&step)?;
            if found.iter().any(|(left, _)| *left < LEFT * case.difference) {
                explained = Some(step.index);
            }
            ideas.extend(found.into_iter().map(|(_, idea)| idea));
        }
    }
    Ok(ideas)
}

/// Objects that may be off in some way that neither a small step nor a colour shows, as all that is wrong is near them: the likeliest ones.
fn unknown(case: &Case, known: &[Step]) -> Vec<Step> {
    let indices = likeliest(case, ROOM).into_iter().map(|(_, index)| index);
    let steps = indices.take(SEARCHED).map(|index| Step {
        index,
        by: DVec2::ZERO,
        factor: 1.0,
        is_known: false,
    });
    let is_new = |step: &Step| known.iter().all(|known| known.index != step.index);
    let is_sought = |step: &Step| is_new(step) && Sought::new(case, step).is_some();
    steps.filter(is_sought).take(UNKNOWN).collect()
}

/// So many of those. It is a choice, for time: the likeliest, and one that is seen in the same part of the picture.
const UNKNOWN: usize = 2;

/// An object that is searched for may be so many times as large as it seems. It is a choice: what is seen of it may be half of it, and what
/// is in a larger part of the picture may be another one's.
const ROOM: f64 = 1.5;

/// How far an object seems to be moved, in pixels to the right and down, and how much larger it seems to be.
struct Step {
    index: usize,
    by: DVec2,
    factor: f64,
    /// Whether the picture says so, or nothing is known.
    is_known: bool,
}

/// One place is better than another that is nearer to none if it leaves less than this share of what that leaves: what looks the same leaves
/// the same but for roundings. It is a choice; a fit's last steps gain less than this.
const CLEARLY: f64 = 0.99;

/// By what factors an object's size may be off: slopes tell little of more.
const GROWTH: RangeInclusive<f64> = 0.125..=8.0;

/// Of the objects along whose slopes the errors add up, those for which they do so most.
fn steps(case: &Case) -> Result<Vec<Step>, RenderError> {
    let mut steps: Vec<(f64, Step)> = Vec::new();
    for slope in case.slopes()? {
        let sum = case.errors.along(&slope.trend, None);
        let (by, factor) = (slope.by * sum.times, libm::pow(slope.factor, sum.times));
        match steps.last_mut() {
            Some((most, step)) if step.index == slope.index => {
                *most = most.max(sum.sigmas.abs());
                step.by += by;
                step.factor *= factor;
            }
            _ => {
                let index = slope.index;
                let step = Step {
                    index,
                    by,
                    factor,
                    is_known: true,
                };
                steps.push((sum.sigmas.abs(), step));
            }
        }
    }
    let is_small = |step: &Step| step.by.length() < LITTLE && GROWTH.contains(&step.factor);
    steps.retain(|(sigmas, step)| *sigmas > SIGMAS && is_small(step));
    steps.sort_by(|p, q| q.0.total_cmp(&p.0));
    let steps = steps.into_iter().take(SEARCHED);
    Ok(steps.map(|(_, step)| step).collect())
}

/// Objects whose colour is elsewhere, or in more or fewer pixels.
fn blobs(case: &Case) -> Vec<Step> {
    let (a, exact, scene) = (&case.full.a, &case.full.exact, &case.full.scene);
    let whole = Area::whole(a.width(), a.height());
    let mut steps = Vec::new();
    let likely = likeliest(case, 1.0).into_iter();
    for (_, index) in likely
        .take_while(|(share, _)| *share > OWN_PART)
        .take(SEARCHED)
    {
        let object = &scene.objects[index];
        let mut shape = object.shape;
        let colors = color(&mut shape);
        let [color] = colors.as_slice() else { continue };
        let near = Near::to(&color.to_linear());
        let (is, should) = (Blob::of(a, whole, &near), Blob::of(exact, whole, &near));
        if is.pixels < ENOUGH || should.pixels < ENOUGH {
            continue;
        }
        if share(a, exact, &near) < OWN {
            continue;
        }
        let by = is.middle - should.middle;
        let factor = (is.pixels as f64 / should.pixels as f64).sqrt();
        if by.length() < 0.05 && (factor - 1.0).abs() < 0.002 {
            continue;
        }
        steps.push(Step {
            index,
            by,
            factor,
            is_known: true,
        });
    }
    steps
}

/// Where and how large a colour is in a picture, in pixels.
pub(super) struct Blob {
    pub middle: DVec2,
    pub pixels: u64,
}

impl Blob {
    pub fn of(film: &Film, part: Area, near: &Near) -> Self {
        Self::where_that(part, |(x, y)| near.holds(&film.pixel(x, y)))
    }

    /// Where something holds.
    pub fn where_that(part: Area, holds: impl Fn((u32, u32)) -> bool) -> Self {
        let (mut sum, mut pixels) = (DVec2::ZERO, 0);
        for (x, y) in part.iter() {
            if holds((x, y)) {
                sum += DVec2::new(f64::from(x), f64::from(y));
                pixels += 1;
            }
        }
        Self {
            middle: sum / pixels as f64,
            pixels,
        }
    }
}

/// An object in front of the camera whose place and size are searched for.
struct Sought<'a> {
    case: &'a Case<'a>,
    index: usize,
    shape: Shape,
    name: String,
    middle: DVec3,
    radius: f64,
    /// The camera's u, v and w.
    axes: [DVec3; 3],
    depth: f64,
    /// What a pixel is at its depth, in metres.
    pixel: f64,
    is_little: bool,
}

/// What an idea leaves of the difference, and the idea.
type Found = (f64, Idea);

impl<'a> Sought<'a> {
    /// Nothing, if too much else is wrong.
    fn new(case: &'a Case<'a>, step: &Step) -> Option<Self> {
        let &Step {
            index, by, factor, ..
        } = step;
        let scene: &Scene = &case.full.scene;
        let shape = scene.objects[index].shape;
        let (middle, radius) = ball(&shape)?;
        let (axes, pitch) = axes(scene);
        let depth = (scene.camera.eye - middle).dot(axes[2]);
        if depth <= 0.0 {
            return None;
        }
        let pixel = depth * pitch;
        // With room for what the search may find beside that.
        let there = moved(&shape, (axes[0] * by.x - axes[1] * by.y) * pixel, factor);
        let around = [shape, there].map(|shape| Some(moved(&shape, DVec3::ZERO, ROOM)));
        if case.is_wrong_outside(case.view.extents(&around)) {
            return None;
        }
        Some(Self {
            case,
            index,
            shape,
            name: called(scene, index),
            middle,
            radius,
            axes,
            depth,
            pixel,
            is_little: step.is_known
                && by.length() < LITTLE
                && (factor - 1.0).abs() * radius < LITTLE * pixel,
        })
    }

    /// The object displaced by about so many pixels, and about so many times as large as it should be.
    fn ideas(&self, step: &Step) -> Result<Vec<Found>, RenderError> {
        // One coordinate wrong is the simplest.
        let mut ideas = Vec::new();
        for (axis, letter) in [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")] {
            ideas.extend(self.along(axis, letter, step.by)?);
        }
        let width = self.width();
        // What is that much larger has its outline farther out by as much.
        let octaves = width / self.radius / std::f64::consts::LN_2;
        if self.explained(&ideas).is_none() {
            for side in 0..3 {
                ideas.extend(self.stretched(side, octaves)?);
            }
        }
        if self.explained(&ideas).is_none() {
            ideas.extend(self.spun()?);
            ideas.extend(self.facing()?);
        }
        let size = libm::log2(step.factor);
        let make = |p: &[f64]| self.with(DVec3::ZERO, libm::exp2(p[0]));
        ideas.extend(self.fit(&[size], &[octaves], &make)?.and_then(|fit| {
            let idea = self.displaced(DVec3::ZERO, libm::exp2(fit.at[0]), make(&fit.at)?);
            Some((fit.left, idea))
        }));
        let [u, v, _] = self.axes;
        let make = |p: &[f64]| self.with(u * p[0] + v * p[1], libm::exp2(p[2]));
        let start = [step.by.x * self.pixel, -step.by.y * self.pixel, size];
        let Some(Fit { at, left }) = self.fit(&start, &[width, width, octaves], &make)? else {
            return Ok(ideas);
        };
        let (aside, factor) = (u * at[0] + v * at[1], libm::exp2(at[2]));
        if aside.length() < 0.05 * self.pixel {
            return Ok(ideas);
        }
        let first = u * start[0] + v * start[1];
        ideas.extend(self.anywhere([(aside, factor), (first, step.factor)])?);
        if let Some(make) = make(&at) {
            ideas.push((left, self.displaced(aside, factor, make)));
        }
        Ok(ideas)
    }

    /// With one coordinate that is another one.
    fn along(&self, axis: DVec3, letter: &str, by: DVec2) -> Result<Option<Found>, RenderError> {
        let [u, v, w] = self.axes;
        let at = self.offset();
        // How far the middle moves in the picture: the derivative of depth · (at · u, −at · v)/depth.
        let slope = DVec2::new(
            axis.dot(u) + at.dot(u) * axis.dot(w) / self.depth,
            -axis.dot(v) - at.dot(v) * axis.dot(w) / self.depth,
        );
        let start = match slope.length_squared() {
            0.0 => 0.0,
            square => slope.dot(by * self.pixel) / square,
        };
        let make = |p: &[f64]| self.with(axis * p[0], 1.0);
        let Some(Fit { at, left }) = self.fit(&[start], &[self.width()], &make)? else {
            return Ok(None);
        };
        let there = self.middle + axis * at[0];
        let message = format!(
            "{} is in a wrong place: as if the {letter} of its middle were {} instead of {}",
            self.name,
            found_near(there.dot(axis), self.middle.dot(axis)),
            short(self.middle.dot(axis))
        );
        Ok(make(&at).map(|make| (left, self.idea("object_place", message, make))))
    }

    /// The first of some ideas that explains the picture, nearly.
    fn explained<'i>(&self, ideas: &'i [Found]) -> Option<&'i Found> {
        let enough = LEFT * self.case.difference;
        ideas.iter().find(|(left, _)| *left < enough)
    }

    /// Somewhere else: what looks displaced and larger may be nearer. From the better of two starts.
    fn anywhere(&self, starts: [(DVec3, f64); 2]) -> Result<Option<Found>, RenderError> {
        let make = |p: &[f64]| self.with(DVec3::from_slice(p), 1.0);
        let mut best: Option<Fit> = None;
        for (aside, factor) in starts {
            let start = (aside + self.offset()) / factor - self.offset();
            let found = self.fit(&start.to_array(), &[self.width(); 3], &make)?;
            if let Some(found) = found
                && best.as_ref().is_none_or(|best| found.left < best.left)
            {
                best = Some(found);
            }
            let left = best.as_ref().map_or(f64::INFINITY, |best| best.left);
            if left < LEFT * self.case.difference {
                break;
            }
        }
        let Some(Fit { at, left }) = best else {
            return Ok(None);
        };
        let there = self.middle + DVec3::from_slice(&at);
        let message = format!(
            "{} is in a wrong place: as if its middle were {} instead of {}",
            self.name,
            found_vector(there, self.middle, self.offset().length()),
            short_vector(self.middle)
        );
        Ok(make(&at).map(|make| (left, self.idea("object_place", message, make))))
    }

    /// Displaced in the picture, and larger.
    fn displaced(&self, aside: DVec3, factor: f64, make: Make) -> Idea {
        let name = &self.name;
        let size = format!(" is {} times as large as it should be", found(factor, 1.0));
        let is_sized = (factor - 1.0).abs() >= 0.01;
        let (mistake, message) = match (aside == DVec3::ZERO, is_sized) {
            (true, _) => ("object_size", format!("{name}{size}, or nearer or farther")),
            (false, false) => ("object_place", format!("{name} is in a wrong place")),
            (false, true) => (
                "object_place",
                format!("{name}{size} (or nearer or farther), and in a wrong place"),
            ),
        };
        self.idea(mistake, message, make)
    }

    fn idea(&self, mistake: &'static str, message: String, make: Make) -> Idea {
        Idea {
            mistake,
            message,
            help: format!(
                "its middle is {}; look at its place, its size and the field of view",
                short_vector(self.middle)
            ),
            make,
        }
    }

    fn with(&self, by: DVec3, factor: f64) -> Option<Make> {
        let other = moved(&self.shape, by, factor);
        (factor > 0.0 && factor.is_finite())
            .then(|| with_shape(&self.case.full.scene, self.index, other))
    }

    /// From the eye to its middle.
    fn offset(&self) -> DVec3 {
        self.middle - self.case.full.scene.camera.eye
    }

    /// Half a pixel.
    fn width(&self) -> f64 {
        0.5 * self.pixel
    }

    /// Fits in the small picture what is not little, and then in the whole one.
    fn fit(
        &self,
        start: &[f64],
        widths: &[f64],
        make: &dyn Fn(&[f64]) -> Option<Make>,
    ) -> Result<Option<Fit>, RenderError> {
        let Case {
            small,
            full,
            control,
            ..
        } = self.case;
        let mut at = start.to_vec();
        if !self.is_little && !full.is_heavy {
            match fit(small, control, start, widths, make)? {
                Some(found) => at = found.at,
                None => return Ok(None),
            }
        }
        fit(full, control, &at, widths, make)
    }

    /// Fits in the small picture from none and from the best of some places, and then in the whole one, if that is hopeful. Of places that are
    /// alike, as of a triangle that looks the same after a third of a turn, the nearest is taken.
    fn fit_from(
        &self,
        mut places: Vec<Vec<f64>>,
        widths: &[f64],
        make: &dyn Fn(&[f64]) -> Option<Make>,
    ) -> Result<Option<Fit>, RenderError> {
        let Case {
            small,
            full,
            control,
            ..
        } = self.case;
        let none = vec![0.0; widths.len()];
        if full.is_heavy {
            return fit(full, control, &none, widths, make);
        }
        places.retain(|at| *at != none);
        let square = |at: &[f64]| -> f64 { at.iter().map(|way| way * way).sum() };
        places.sort_by(|p, q| square(p).total_cmp(&square(q)));
        let mut nearest = (self.case.small_difference, None);
        for at in places {
            let Some(make) = make(&at) else { continue };
            let left = rmse(&small.a, &small.made(&make, control)?);
            if left < CLEARLY * nearest.0 {
                nearest = (left, Some(at));
            }
        }
        let mut found: Option<Fit> = None;
        for at in [Some(none), nearest.1].into_iter().flatten() {
            if let Some(fit) = fit(small, control, &at, widths, make)?
                && (found.as_ref()).is_none_or(|found| fit.left < CLEARLY * found.left)
            {
                found = Some(fit);
            }
        }
        match found {
            Some(found) if found.left <= self.case.hopeful() * self.case.small_difference => {
                fit(full, control, &found.at, widths, make)
            }
            _ => Ok(None),
        }
    }
}
