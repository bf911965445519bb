//! Sample points, stored as one list per coordinate.

use glam::DVec2;

/// Number of lanes of the widest SIMD vectors. Lists of sample points' coordinates are padded to a
/// multiple of this.
const LANES: usize = 8;

/// Points of a pixel, as one list per coordinate, so that loops over the points are vectorized. One
/// value is reused for all pixels, to keep its allocations.
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

    /// Returns all points in their order.
    pub fn iter(&self) -> impl Iterator<Item = DVec2> {
        let [x, y] = [&self.x, &self.y].map(|lane| lane[..self.len].iter());
        x.zip(y).map(|(&x, &y)| DVec2::new(x, y))
    }

    /// Returns the lists of coordinates. They are padded to a multiple of eight by arbitrary
    /// coordinates within the pixel.
    pub fn lanes(&self) -> [&[f64]; 2] {
        let end = self.len.next_multiple_of(LANES);
        [&self.x[..end], &self.y[..end]]
    }

    /// Sets the number of points to `count`. Returns the lists of coordinates, with arbitrary
    /// content, for the caller to overwrite.
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
