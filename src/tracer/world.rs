//! The scene prepared for one picture.

use glam::DVec2;

use crate::{color::Color, scene::Scene};

/// The scene prepared for one picture: made once, then asked at any sample point from any thread.
#[derive(Debug)]
pub struct World {
    palette: Vec<Color>,
}

impl World {
    /// Prepares a scene.
    pub fn new(scene: &Scene) -> Self {
        Self {
            palette: vec![scene.image.background],
        }
    }

    /// The distinct colours that can be seen: the objects' in the order of the file, the background last.
    pub fn palette(&self) -> &[Color] {
        &self.palette
    }

    /// Which colour of the palette is seen at a sample point: the pixel in column `x` and row `y` from the top left, and
    /// the offset from that pixel's centre, x to the right and y down, each in [−1/2, 1/2).
    pub fn slot_at(&self, _x: u32, _y: u32, _offset: DVec2) -> usize {
        self.palette.len() - 1
    }
}
