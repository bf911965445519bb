//! The palette: the colours that can be seen, and the colours of each object.
//!
//! In: the objects and the background. Out: the palette, which is the list of distinct colours, and
//! for each object the palette indices of its colours.

use std::collections::HashMap;

use crate::{color::Color, scene};

/// The palette of a picture, and the indices of each object's colours in it.
#[derive(Debug)]
pub(super) struct Colors {
    /// The distinct colours: those of the objects in file order, then the background.
    pub palette: Vec<Color>,
    /// For each object, the palette indices of its two colours. They are equal unless the object is
    /// a checkerboard.
    pub of_objects: Vec<[u32; 2]>,
}

impl Colors {
    pub(super) fn new(objects: &[scene::Object], background: Color) -> Self {
        let mut palette = Vec::new();
        let mut color_indices = HashMap::new();
        let mut color_index = |color: Color| {
            *color_indices
                .entry(color.srgb.map(f64::to_bits))
                .or_insert_with(|| {
                    palette.push(color);
                    // The index fits into 32 bits, because there are at most two colours per
                    // object, and 2^31 objects do not fit into memory.
                    (palette.len() - 1) as u32
                })
        };
        let color_indices_of = |object: &scene::Object| {
            let [first, second, _] = object.shape.colors();
            [first, second].map(&mut color_index)
        };
        let of_objects = objects.iter().map(color_indices_of).collect();
        palette.push(background);
        Self {
            palette,
            of_objects,
        }
    }

    /// Gives each owner a palette entry of its own, with an arbitrary colour. `owners` yields the
    /// index of the owner of each prepared object. If the owners are objects of the file, all faces
    /// of a box have the same owner, the box.
    pub(super) fn by_object(owners: impl Iterator<Item = usize>) -> Self {
        let of_objects: Vec<_> = owners.map(|owner| [owner as u32; 2]).collect();
        let count = of_objects
            .iter()
            .map(|[owner, _]| *owner as usize + 1)
            .max();
        Self {
            palette: vec![Color::BLACK; count.unwrap_or(0) + 1],
            of_objects,
        }
    }
}
