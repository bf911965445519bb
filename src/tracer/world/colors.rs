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
    /// The distinct ones, and the background.
    pub palette: Vec<Color>,
    /// The distinct pairs of slots of the palette: an object's colour, and a checkerboard's second one.
    pub pairs: Vec<[usize; 2]>,
    /// For each object its pair.
    pub of_objects: Vec<u32>,
}

impl Colors {
    /// The distinct colours of all objects in file order with the background behind them, and the places of the objects' among them.
    pub(super) fn new(objects: &[scene::Object], background: Color) -> Self {
        let mut palette = Vec::new();
        let mut places = HashMap::new();
        let mut place = |color: Color| {
            *places
                .entry(color.srgb.map(f64::to_bits))
                .or_insert_with(|| {
                    palette.push(color);
                    palette.len() - 1
                })
        };
        let mut pairs = Vec::new();
        let mut places_of_pairs = HashMap::new();
        let pair = |object: &scene::Object| {
            let pair = match object.shape {
                Shape::Sphere(scene::Sphere { color, .. })
                | Shape::Triangle(scene::Triangle { color, .. })
                | Shape::Box(scene::Cuboid { color, .. }) => [place(color); 2],
                Shape::Checkerboard(scene::Checkerboard { colors, .. }) => colors.map(&mut place),
            };
            *places_of_pairs.entry(pair).or_insert_with(|| {
                pairs.push(pair);
                // No more than objects.
                (pairs.len() - 1) as u32
            })
        };
        let of_objects = objects.iter().map(pair).collect();
        palette.push(background);
        Self {
            palette,
            pairs,
            of_objects,
        }
    }
}
