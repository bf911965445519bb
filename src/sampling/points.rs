//! Sample points, stored as one list per coordinate.

use glam::DVec2;

/// Number of `f64` in the widest SIMD vectors. Lists of coordinates are padded to a multiple of
/// this number.
const LANES: usize = 8;

/// Sample points of a pixel, stored as one list per coordinate, so that loops over the points can
/// be vectorized. One value is reused for all pixels, so that memory is allocated only once.
#[derive(Clone, Debug, Default)]
pub struct Points {
    len: usize,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Points {
    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Iterates over all points.
    pub fn iter(&self) -> impl Iterator<Item = DVec2> {
        let [x, y] = [&self.x, &self.y].map(|lane| lane[..self.len].iter());
        x.zip(y).map(|(&x, &y)| DVec2::new(x, y))
    }

    /// Returns the lists of x and y coordinates. They are padded to a multiple of eight numbers by
    /// arbitrary coordinates within the pixel.
    pub fn lanes(&self) -> [&[f64]; 2] {
        let end = self.len.next_multiple_of(LANES);
        [&self.x[..end], &self.y[..end]]
    }

    /// Sets the number of points. Returns the lists of x and y coordinates, which contain arbitrary
    /// numbers. The caller must overwrite them.
    pub(super) fn resized(&mut self, count: usize) -> [&mut [f64]; 2] {
        self.len = count;
        let needed = count.next_multiple_of(LANES);
        if self.x.len() < needed {
            self.x.resize(needed, 0.0);
            self.y.resize(needed, 0.0);
        }
        [&mut self.x[..count], &mut self.y[..count]]
    }
}
