//! The colours that can be seen, and which of them an object has.
//!
//! In: the objects and the background. Out: the palette of distinct colours, and each object's
//! slots in it.

use std::collections::HashMap;

use crate::{color::Color, scene};

/// The colours of the objects.
#[derive(Debug)]
pub(super) struct Colors {
    /// The distinct ones in file order, and the background behind them.
    pub palette: Vec<Color>,
    /// The slots of each object's colour, and of a checkerboard's second one.
    pub of_objects: Vec<[u32; 2]>,
}

impl Colors {
    pub(super) fn new(objects: &[scene::Object], background: Color) -> Self {
        let mut palette = Vec::new();
        let mut slots = HashMap::new();
        let mut slot = |color: Color| {
            *slots
                .entry(color.srgb.map(f64::to_bits))
                .or_insert_with(|| {
                    palette.push(color);
                    // No more than twice the objects, which fit into memory.
                    (palette.len() - 1) as u32
                })
        };
        let of_objects = objects.iter();
        let of_objects = of_objects.map(|object| {
            let [first, second, _] = object.shape.colors();
            [first, second].map(&mut slot)
        });
        let of_objects = of_objects.collect();
        palette.push(background);
        Self {
            palette,
            of_objects,
        }
    }

    /// Gives each object a slot of its own; a piece has that of the object that it belongs to.
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
