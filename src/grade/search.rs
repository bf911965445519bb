//! Numbers of a scene that are some others: a camera's or a checkerboard's.
//!
//! In: changes of a scene, each by a few numbers. Out: those that came nearest to the picture. A change is tried at some places, and fitted
//! from the best of them and from none: first in a tiny picture, in which what is far off still overlaps with what it should be, and then in
//! a small one. Of a scene with many objects these are sampled, and the last fit is in some rows of the exact picture.

use super::{
    Case, Idea, Make,
    fit::{Fit, fit},
    level::{Level, SMALL},
};
use crate::{film::rmse, render::RenderError, scene::Scene};

/// So many places are fitted from, the best ones, and none. A fit takes as long as some dozen places, so that with two the fits and the
/// places share the time; the second is for valleys that look alike in a tiny picture, on either side of an object.
const STARTS: usize = 2;

/// So many changes are fitted in the small picture, those that came nearest in the tiny one: of a wrong coordinate of the eye the same
/// coordinate of lookat and the distance come as near there.
const FITTED: usize = 3;

/// So many of them are fitted once more where the small picture is sampled. It is a choice, for time: as many as whole pictures are made of
/// then.
const REFINED: usize = 2;

type With = dyn Fn(&Scene, &[f64]) -> Option<Scene>;
type Message = dyn Fn(&Scene, &Scene) -> String;

/// Some numbers of a scene that may be wrong, as how far they are off.
pub struct Change {
    /// Which of the camera's numbers they are, if they are some of those.
    pub numbers: Vec<usize>,
    pub mistake: &'static str,
    pub help: &'static str,
    /// The scene with them, if that is one.
    pub with: Box<With>,
    /// Of the right scene and the other one.
    pub message: Box<Message>,
    /// Where to try, beside where nothing is changed.
    pub starts: Vec<Vec<f64>>,
    /// Steps that move the whole picture by half a pixel.
    pub widths: Vec<f64>,
}

impl Change {
    fn make(&self, scene: &Scene, at: &[f64]) -> Option<Make> {
        Some(Make::Scene(Box::new((self.with)(scene, at)?)))
    }

    /// The numbers that come nearest to a picture from a start on.
    pub fn fit(
        &self,
        case: &Case,
        level: &Level,
        start: &[f64],
    ) -> Result<Option<Fit>, RenderError> {
        let make = |at: &[f64]| self.make(&case.full.scene, at);
        fit(level, &case.control, start, &self.widths, &make)
    }

    /// The same in rows of the exact picture, those with most of the difference: as many as have the pixels of a small picture.
    pub fn refined(&self, case: &Case, start: &[f64]) -> Result<Option<Fit>, RenderError> {
        let rows = (SMALL[0] * SMALL[1]).div_ceil(case.full.a.width());
        let level = case.full.rows(case.worst_rows(rows))?;
        self.fit(case, &level, start)
    }

    /// As an idea, with these numbers.
    pub fn idea(&self, scene: &Scene, at: &[f64]) -> Option<Idea> {
        let other = (self.with)(scene, at)?;
        Some(Idea {
            mistake: self.mistake,
            message: (self.message)(scene, &other),
            help: self.help.to_owned(),
            make: Make::Scene(Box::new(other)),
        })
    }
}

/// What is found of some changes.
pub struct Found {
    /// Those that come nearest to the picture.
    pub ideas: Vec<Idea>,
    /// What comes nearest to the tiny picture with each that is of the camera's numbers: which they are, and the fit.
    pub starts: Vec<(Vec<usize>, Fit)>,
    /// The least that one of them leaves there.
    pub least: f64,
}

/// The changes that come nearest to the picture.
pub fn nearest(case: &Case, changes: &[Change]) -> Result<Found, RenderError> {
    let mut best = Vec::new();
    for change in changes {
        let start = start(case, change)?;
        best.extend(start.map(|start| (change, nothing_in_noise(case, start))));
    }
    let least = best.iter().map(|(_, start)| start.left);
    let least = least.fold(case.tiny_difference, f64::min);
    let is_of_camera = |(change, _): &&(&Change, Fit)| !change.numbers.is_empty();
    let starts = best.iter().filter(is_of_camera);
    let starts = starts
        .map(|(change, start)| (change.numbers.clone(), start.clone()))
        .collect();
    let mut fits = Vec::new();
    for (change, start) in in_order(best).into_iter().take(FITTED) {
        let fit = change.fit(case, &case.small, &start.at)?;
        fits.extend(fit.map(|fit| (change, fit)));
    }
    if case.small.is_heavy {
        fits = refined(case, in_order(fits))?;
    }
    let ideas = fits
        .iter()
        .filter_map(|(change, fit)| change.idea(&case.full.scene, &fit.at));
    Ok(Found {
        ideas: ideas.collect(),
        starts,
        least,
    })
}

/// What leaves more than there is was fitted to the noise of a sampled picture, and tells nothing.
fn nothing_in_noise(case: &Case, start: Fit) -> Fit {
    match start.left <= case.tiny_difference {
        true => start,
        false => Fit {
            at: vec![0.0; start.at.len()],
            left: case.tiny_difference,
        },
    }
}

/// The nearest first; of those that are as near the one thought of first.
fn in_order(mut fits: Vec<(&Change, Fit)>) -> Vec<(&Change, Fit)> {
    fits.sort_by(|p, q| p.1.left.total_cmp(&q.1.left));
    fits
}

/// The first few, refined.
fn refined<'a>(
    case: &Case,
    fits: Vec<(&'a Change, Fit)>,
) -> Result<Vec<(&'a Change, Fit)>, RenderError> {
    let mut refined = Vec::new();
    for (change, fit) in fits.into_iter().take(REFINED) {
        let fit = change.refined(case, &fit.at)?;
        refined.extend(fit.map(|fit| (change, fit)));
    }
    Ok(refined)
}

/// The numbers of a change that come nearest to the tiny picture, from the best places and from none.
fn start(case: &Case, change: &Change) -> Result<Option<Fit>, RenderError> {
    let tiny = &case.tiny;
    let none = vec![0.0; change.widths.len()];
    let mut starts = vec![(case.tiny_difference, none.clone())];
    for at in &change.starts {
        if let Some(make) = change.make(&case.full.scene, at) {
            let left = rmse(&tiny.a, &tiny.made(&make, &case.control)?);
            starts.push((left, at.clone()));
        }
    }
    starts.sort_by(|p, q| p.0.total_cmp(&q.0));
    if case.full.is_heavy {
        // Each takes many pictures.
        starts.truncate(1);
    } else {
        starts.truncate(STARTS);
        if starts.iter().all(|(_, at)| *at != none) {
            starts.push((case.tiny_difference, none));
        }
    }
    let mut found: Option<Fit> = None;
    for (_, at) in starts {
        if let Some(fit) = change.fit(case, tiny, &at)?
            && found.as_ref().is_none_or(|found| fit.left < found.left)
        {
            found = Some(fit);
        }
    }
    Ok(found)
}
