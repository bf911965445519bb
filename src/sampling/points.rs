//! Points by coordinate.

use glam::DVec2;

/// Lists of coordinates are filled up to a multiple of so many, the widest vectors' numbers.
const LANES: usize = 8;

/// Some points of a pixel, as a list of each coordinate: loops over them become vectors. Kept from
/// pixel to pixel for their room.
#[derive(Clone, Debug, Default)]
pub struct Points {
    len: usize,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl Points {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// All of them in their order.
    pub fn iter(&self) -> impl Iterator<Item = DVec2> {
        let [x, y] = [&self.x, &self.y].map(|lane| lane[..self.len].iter());
        x.zip(y).map(|(&x, &y)| DVec2::new(x, y))
    }

    /// Their coordinates. Behind the last there may be more, up to a multiple of eight, that lie
    /// anywhere in the pixel.
    pub fn lanes(&self) -> [&[f64]; 2] {
        let end = self.len.next_multiple_of(LANES);
        [&self.x[..end], &self.y[..end]]
    }

    /// The places of the coordinates of so many points, which take the place of those before.
    pub(super) fn room(&mut self, count: usize) -> [&mut [f64]; 2] {
        self.len = count;
        let needed = count.next_multiple_of(LANES);
        if self.x.len() < needed {
            self.x.resize(needed, 0.0);
            self.y.resize(needed, 0.0);
        }
        [&mut self.x[..count], &mut self.y[..count]]
    }
}
