//! Criteria of grading: the camera, an object, the board, colours, sampling, and hits. Each mistake
//! belongs to one of them.

use std::collections::BTreeSet;

use super::graded::Finding;
use crate::{
    grading,
    scene::{Scene, Shape},
    schema,
};

/// Criterion that a mistake belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// Mistakes in the camera or the window.
    Camera,
    /// Mistakes in an object, given by its index.
    Object(usize),
    /// Mistakes in the checkerboards.
    Board,
    /// Mistakes in colours or their encoding.
    Colours,
    /// Mistakes in the positions of samples or in their average.
    Sampling,
    /// Mistakes in which hit of a ray is visible, and mistakes of no other criterion.
    Hits,
}

/// Criterion of each mistake, by the first prefix in this list with which the mistake's id begins.
/// An id with none of these prefixes is about a field of the camera or of an object, or its
/// criterion is [`Criterion::Hits`].
const BEGINNINGS: &[(&str, Criterion)] = &[
    ("board_", Criterion::Board),
    ("half_pixel", Criterion::Sampling),
    ("averaged_", Criterion::Sampling),
    ("wider_", Criterion::Sampling),
    ("sharpened", Criterion::Sampling),
    ("sample", Criterion::Sampling),
    ("window_", Criterion::Camera),
    ("u_not_normalised", Criterion::Camera),
    ("fisheye", Criterion::Camera),
    ("colors_exchanged", Criterion::Colours),
    ("video_range", Criterion::Colours),
    ("bytes_wrap", Criterion::Colours),
    ("channels", Criterion::Colours),
    ("gray", Criterion::Colours),
    ("not_encoded", Criterion::Colours),
    ("encoded_", Criterion::Colours),
    ("gamma_", Criterion::Colours),
    ("cut_off", Criterion::Colours),
    ("not_decoded", Criterion::Colours),
    ("decoded_twice", Criterion::Colours),
    ("inverted", Criterion::Colours),
    ("not_divided", Criterion::Colours),
    ("black", Criterion::Colours),
    ("one_colour", Criterion::Colours),
    ("transparent", Criterion::Colours),
    ("alpha", Criterion::Colours),
    ("background", Criterion::Colours),
    ("mirrored", Criterion::Camera),
    ("upside_down", Criterion::Camera),
    ("turned_", Criterion::Camera),
    ("transposed", Criterion::Camera),
    ("squeezed", Criterion::Camera),
    ("aspect", Criterion::Camera),
    ("looks_back", Criterion::Camera),
    ("w_not_normalised", Criterion::Camera),
    ("parallel_rays", Criterion::Camera),
    ("nothing_seen", Criterion::Camera),
    ("eye_and_lookat", Criterion::Camera),
    ("behind_seen", Criterion::Hits),
    ("depth_ignored", Criterion::Hits),
    ("sphere_", Criterion::Hits),
    // The message of a mistake with one of the prefixes below may name an object. Then this object
    // is the criterion instead.
    ("object_", Criterion::Hits),
    ("box_", Criterion::Hits),
    ("faces_", Criterion::Hits),
    ("triangle_", Criterion::Hits),
];

/// Returns the criterion that a mistake belongs to.
pub fn criterion(finding: &Finding, scene: &Scene) -> Criterion {
    if let Some(index) = object(finding, scene) {
        return match scene.objects[index].shape {
            Shape::Checkerboard(_) => Criterion::Board,
            Shape::Sphere(_) | Shape::Triangle(_) | Shape::Box(_) => Criterion::Object(index),
        };
    }
    of_id(finding.id).unwrap_or(Criterion::Hits)
}

/// Returns the criterion of a mistake's id, without regard to the object that the mistake is about.
/// Returns `None` for the field of an object.
fn of_id(id: &str) -> Option<Criterion> {
    let mut beginnings = BEGINNINGS.iter();
    let found = beginnings.find(|(beginning, _)| id.starts_with(beginning));
    let camera = schema::block("camera").map_or(&[][..], |block| block.fields);
    let is_of = |field: &str| {
        let rest = id.strip_prefix(field);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
    };
    match found {
        Some((_, criterion)) => Some(*criterion),
        None => (camera.iter().any(|field| is_of(field.name))).then_some(Criterion::Camera),
    }
}

/// Returns the index of the object that a mistake is about: the object with whose title the message
/// begins. Returns `None` if there is no such object.
pub fn object(finding: &Finding, scene: &Scene) -> Option<usize> {
    let title = |index: usize| {
        let object = &scene.objects[index];
        match &object.name {
            Some(name) => format!("the {} {name} ", object.shape.kind()),
            None => format!("the {} with the index {index} ", object.shape.kind()),
        }
    };
    (0..scene.objects.len()).find(|&index| finding.message.starts_with(&title(index)))
}

/// Returns the ids of all mistakes in alphabetical order: the ids in the table of mistakes, and the
/// names of fields whose values may be wrong.
pub fn ids() -> impl Iterator<Item = &'static str> {
    let blocks = schema::block_names().filter(|name| *name != "sampler");
    let fields = blocks
        .filter_map(schema::block)
        .flat_map(|block| block.fields);
    let named = ["eye_and_lookat", "object_extra"].into_iter();
    let all: BTreeSet<_> = grading::mistake_ids()
        .chain(fields.map(|field| field.name))
        .chain(named)
        .collect();
    all.into_iter()
}

/// Returns whether `id` is the id of a mistake.
pub fn is_id(id: &str) -> bool {
    ids().any(|own| own == id)
}

#[cfg(test)]
mod tests {
    use super::{grading, of_id};

    #[test]
    fn every_mistake_of_the_table_has_a_criterion() {
        for id in grading::mistake_ids() {
            assert!(of_id(id).is_some(), "{id}: add it to BEGINNINGS");
        }
    }
}
