//! Numbers of a scene that are some others: a camera's or a checkerboard's.
//!
//! In: changes of a scene, each by a few numbers. Out: those that came nearest to the picture. A change is tried at some places, and fitted
//! from the best of them and from none: first in a tiny picture, in which what is far off still overlaps with what it should be, and then in
//! a small one.

use super::{
    Case, Idea, Make,
    fit::{Fit, fit},
    level::Level,
};
use crate::{film::rmse, render::RenderError, scene::Scene};

/// So many places are fitted from, the best ones.
const STARTS: usize = 2;

/// So many changes are fitted in the small picture, those that came nearest in the tiny one.
const FITTED: usize = 3;

type With = dyn Fn(&Scene, &[f64]) -> Option<Scene>;
type Message = dyn Fn(&Scene, &Scene) -> String;

/// Some numbers of a scene that may be wrong, as how far they are off.
pub struct Change {
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
    /// The numbers of each that come nearest to the tiny picture.
    pub starts: Vec<Option<Fit>>,
}

/// The changes that come nearest to the picture.
pub fn nearest(case: &Case, changes: &[Change]) -> Result<Found, RenderError> {
    let starts = changes.iter().map(|change| start(case, change));
    let starts: Vec<_> = starts.collect::<Result<_, _>>()?;
    let mut best: Vec<_> = changes
        .iter()
        .zip(&starts)
        .filter_map(|(change, start)| Some((change, start.as_ref()?)))
        .collect();
    best.sort_by(|p, q| p.1.left.total_cmp(&q.1.left));
    let mut ideas = Vec::new();
    for (change, start) in best.into_iter().take(FITTED) {
        if let Some(Fit { at, .. }) = change.fit(case, &case.small, &start.at)? {
            ideas.extend(change.idea(&case.full.scene, &at));
        }
    }
    Ok(Found { ideas, starts })
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
