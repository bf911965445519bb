//! The picture's answers to one who is writing a scene.

use super::analysis::Analysis;
use crate::{scene::Scene, source::Span};

/// For each object the place that stands for it: its name, or the keyword of its block.
pub fn selections(analysis: &Analysis<'_>, scene: &Scene) -> Vec<Span> {
    let mut blocks = analysis.blocks();
    let selection = |object: &crate::scene::Object| {
        let block = blocks.find(|block| block.span == object.span);
        block.map_or(object.span, |block| {
            block.name.map_or(block.keyword(), |name| name.span)
        })
    };
    scene.objects.iter().map(selection).collect()
}
