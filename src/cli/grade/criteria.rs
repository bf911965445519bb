//! Criteria by which points are given: camera, each object, checkerboards, colours, sampling, and
//! ray hits. Each kind of mistake belongs to one criterion.

use std::collections::BTreeSet;

use crate::{
    grading::{self, NamedMistake},
    scene::Scene,
    schema,
};

/// Criterion to which a mistake in a picture belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// Mistakes in the camera, or in the part of the view plane that the picture shows.
    Camera,
    /// Mistakes in an object other than a checkerboard, given by the object's index in the scene.
    Object(usize),
    /// Mistakes in the checkerboards.
    Board,
    /// Mistakes in colours or their encoding.
    Colours,
    /// Mistakes in the positions of samples or in their average.
    Sampling,
    /// Mistakes in the choice of the visible hit among a ray's hits, and all mistakes that belong
    /// to no other criterion.
    Hits,
}

/// Criteria, each with the beginnings of the ids of its mistakes. The beginnings are separated by
/// spaces. For example, `board_` stands for all ids that begin with `board_`. An id that is not
/// found here is the name of a field of the camera or of an object.
const BEGINNINGS: &[(Criterion, &str)] = &[
    (Criterion::Board, "board_"),
    (
        Criterion::Sampling,
        "half_pixel averaged_ wider_ sharpened sample",
    ),
    (
        Criterion::Camera,
        "window_ u_not_normalised fisheye mirrored upside_down turned_ transposed stride squeezed \
         aspect looks_back w_not_normalised parallel_rays nothing_seen eye_and_lookat",
    ),
    (
        Criterion::Colours,
        "colors_exchanged video_range bytes_wrap bytes_scaled channels gray not_encoded encoded_ gamma_ \
         cut_off not_decoded decoded_twice inverted not_divided shaded black one_colour transparent \
         alpha background",
    ),
    (
        Criterion::Hits,
        "behind_seen depth_ignored sphere_ object_ box_ faces_ triangle_",
    ),
];

/// Returns the criterion that a mistake belongs to.
pub fn criterion(mistake: &NamedMistake, scene: &Scene) -> Criterion {
    if let Some(index) = mistake.object {
        return match scene.objects[index].shape.checkerboard() {
            Some(_) => Criterion::Board,
            None => Criterion::Object(index),
        };
    }
    of_id(mistake.id).unwrap_or(Criterion::Hits)
}

/// Returns the criterion of a mistake's id, or `None` if the id is the name of an object's field.
fn of_id(id: &str) -> Option<Criterion> {
    let is_among = |beginnings: &str| beginnings.split(' ').any(|it| id.starts_with(it));
    let found = BEGINNINGS
        .iter()
        .find(|(_, beginnings)| is_among(beginnings));
    let camera = schema::block("camera").map_or(&[][..], |block| block.fields);
    let is_of = |field: &str| {
        let rest = id.strip_prefix(field);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
    };
    match found {
        Some((criterion, _)) => Some(*criterion),
        None => (camera.iter().any(|field| is_of(field.name))).then_some(Criterion::Camera),
    }
}

/// Returns the ids of all kinds of mistakes in alphabetical order. The names of fields are among
/// them, because a field's value may be wrong.
pub fn ids() -> impl Iterator<Item = &'static str> {
    let blocks = schema::block_names().filter(|name| *name != "sampler");
    let fields = blocks
        .filter_map(schema::block)
        .flat_map(|block| block.fields);
    let all: BTreeSet<_> = grading::mistake_ids()
        .chain(fields.map(|field| field.name))
        .chain(["eye_and_lookat"])
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
