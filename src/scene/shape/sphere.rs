//! The shape `sphere`. This file builds it from its block, gives access to its fields, computes its
//! extent, and describes it.

use glam::DVec3;

use crate::{
    color::Color,
    numbers::{short, short_vector},
    scene::lowered_block::LoweredBlock,
    schema::{FieldValue, SPHERE, SphereFields},
};

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Position of the sphere's centre, in metres.
    pub center: DVec3,
    /// Radius in metres, > 0.
    pub radius: f64,
    /// Colour of the sphere.
    pub color: Color,
}

impl Sphere {
    pub(super) fn lower(block: &LoweredBlock<'_>) -> Option<Self> {
        let SphereFields {
            center,
            radius,
            color,
        } = SPHERE;
        Some(Self {
            center: block.value(center)?,
            radius: block.value(radius)?,
            color: block.value(color)?,
        })
    }

    pub(super) fn field_mut(&mut self, name: &str) -> Option<&mut dyn FieldValue> {
        let field = SPHERE.center.of(name, &mut self.center);
        let field = field.or(SPHERE.radius.of(name, &mut self.radius));
        field.or(SPHERE.color.of(name, &mut self.color))
    }

    pub(super) fn is_possible(&self) -> bool {
        self.radius > 0.0 && self.radius.is_finite() && self.center.is_finite()
    }

    pub(super) fn colors(&self) -> [Color; 3] {
        [self.color; 3]
    }

    pub(super) fn bounding_box(&self) -> [DVec3; 2] {
        [self.center - self.radius, self.center + self.radius]
    }

    pub(super) fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        Some((self.center, self.radius))
    }

    pub(super) fn greatest_length(&self, from: DVec3) -> f64 {
        (self.center - from).abs().max_element().max(self.radius)
    }

    pub(super) fn summary(&self) -> String {
        let (center, radius) = (short_vector(self.center), short(self.radius));
        format!("center {center}, radius {radius}, {}", self.color)
    }
}
