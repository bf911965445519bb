//! A grid over the part of a picture that is compared, of cells of some pixels each: a coarse one to search on, a fine one to judge on.

use glam::DVec2;

use crate::{area::Area, film::Film};

/// The grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The pixels along a cell's side.
    pub factor: u32,
    /// The cells in a row.
    pub width: usize,
    /// The rows.
    pub height: usize,
    /// The top left corner in the whole picture.
    corner: DVec2,
}

impl Grid {
    /// The grid over a part whose longer side has so many cells at most. What is left over at the right and at the bottom is not looked at.
    pub fn new(part: Area, longest: u32) -> Self {
        let factor = part.width.max(part.height).div_ceil(longest).max(1);
        // A picture of a single row has a row of cells, too.
        let factor = factor.min(part.width).min(part.height);
        Self {
            factor,
            width: (part.width / factor) as usize,
            height: (part.height / factor) as usize,
            corner: DVec2::new(f64::from(part.x), f64::from(part.y)),
        }
    }

    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.width * self.height
    }

    /// A place in a cell, as one of the whole picture.
    pub fn place(&self, x: usize, y: usize, inside: DVec2) -> DVec2 {
        self.corner + (DVec2::new(x as f64, y as f64) + inside) * f64::from(self.factor)
    }

    /// The means of a film of the part.
    pub fn reduce(&self, film: &Film) -> Vec<[f64; 3]> {
        let factor = self.factor as usize;
        let share = 1.0 / (factor * factor) as f64;
        let cell = |at: usize| {
            let (x, y) = (at % self.width * factor, at / self.width * factor);
            let mut sum = [0.0; 3];
            for row in y..y + factor {
                for pixel in &film.row(row as u32)[x..x + factor] {
                    for i in 0..3 {
                        sum[i] += share * pixel[i];
                    }
                }
            }
            sum
        };
        if factor == 1 {
            return film.pixels().to_vec();
        }
        (0..self.cells()).map(cell).collect()
    }
}
