//! The colours that can be seen, and which of them an object has.
//!
//! In: the objects and the background. Out: the palette of distinct colours, and each object's slots in it.

use std::collections::HashMap;

use crate::{
    color::Color,
    scene::{self, Shape},
};

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
        let of_object = |object: &scene::Object| match object.shape {
            Shape::Sphere(scene::Sphere { color, .. })
            | Shape::Triangle(scene::Triangle { color, .. })
            | Shape::Box(scene::Cuboid { color, .. }) => [slot(color); 2],
            Shape::Checkerboard(scene::Checkerboard { colors, .. }) => colors.map(&mut slot),
        };
        let of_objects = objects.iter().map(of_object).collect();
        palette.push(background);
        Self {
            palette,
            of_objects,
        }
    }
}
