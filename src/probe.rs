//! Finds all surfaces that the ray through one point of the picture hits.

#[cfg(feature = "json")]
mod json;

use std::fmt;

use glam::{DVec2, DVec3};

use crate::{
    color::Color,
    numbers::{short, short_vector},
    scene::{Object, Scene},
    tracer::{Hit, World, ray},
};

/// The output of `pinhole probe`: the ray through a point of the picture, and all intersections of
/// the ray with surfaces. Every number is the correctly rounded exact value.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Probe {
    /// The point, in pixels from the picture's top left corner; it may lie outside the picture.
    pub pixel: DVec2,
    /// Number of columns and of rows of the picture.
    pub picture: [u32; 2],
    /// Position of the eye.
    pub origin: DVec3,
    /// The ray's direction, of length 1.
    pub direction: DVec3,
    /// All surfaces that the ray hits in front of the eye, the nearest hit first, each with its
    /// object.
    pub hits: Vec<(Hit, Object)>,
    /// The colour that is seen: of the nearest visible surface, or of the background.
    pub color: Color,
}

/// Traces the ray through the point `pixel` of the picture plane, given in pixels from the
/// picture's top left corner.
///
/// # Panics
///
/// Panics if a coordinate of the point is not finite, or if the scene was made in code rather than
/// read from a text, and breaks a condition of the language. [`Scene::check`] finds such scenes.
pub fn probe(scene: &Scene, pixel: DVec2) -> Probe {
    assert!(pixel.is_finite(), "the point {pixel} is not finite");
    let half = DVec2::new(f64::from(scene.image.width), f64::from(scene.image.height)) / 2.0;
    let world = World::for_rays(scene, (pixel - half).abs());
    let (direction, hits) = ray(&world, pixel);
    let visible = hits.iter().find(|hit| hit.visible);
    let color = visible.map_or(scene.image.background, |hit| hit.color);
    let of_object = |hit: Hit| (hit, scene.objects[hit.object].clone());
    Probe {
        pixel,
        picture: [scene.image.width, scene.image.height],
        origin: scene.camera.eye,
        direction,
        color,
        hits: hits.into_iter().map(of_object).collect(),
    }
}

/// Writes the readable output of `pinhole probe`.
impl fmt::Display for Probe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (x, y) = (short(self.pixel.x), short(self.pixel.y));
        let [width, height] = self.picture;
        let size = DVec2::new(f64::from(width), f64::from(height));
        let is_outside = self.pixel.cmplt(DVec2::ZERO).any() || self.pixel.cmpgt(size).any();
        write!(f, "pixel     ({x}, {y})")?;
        if is_outside {
            write!(f, ", outside of the picture of {width} by {height} pixels")?;
        }
        writeln!(f)?;
        writeln!(
            f,
            "ray       from {} along {}",
            short_vector(self.origin),
            short_vector(self.direction)
        )?;
        writeln!(f)?;
        if self.hits.is_empty() {
            writeln!(f, "It meets nothing: the background, {}.", self.color)?;
            return Ok(());
        }
        writeln!(
            f,
            "      t           depth       object                   color    point"
        )?;
        for (hit, object) in &self.hits {
            let kind = object.shape.kind();
            let mark = if hit.visible { "seen" } else { "" };
            let object = match &object.name {
                Some(name) => format!("{kind} {name}"),
                None => kind.to_owned(),
            };
            let (t, depth, point) = (short(hit.t), short(hit.depth), short_vector(hit.point));
            writeln!(
                f,
                "{mark:<5} {t:<11} {depth:<11} {object:<24} {}  {point}",
                hit.color
            )?;
        }
        if !self.hits.iter().any(|(hit, ..)| hit.visible) {
            writeln!(f)?;
            writeln!(
                f,
                "Nothing between the near and the far plane: the background, {}.",
                self.color
            )?;
        }
        Ok(())
    }
}
