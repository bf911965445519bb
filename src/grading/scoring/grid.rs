//! Divides a picture, or a rectangle of it, into cells. For the search, which must be fast, a cell
//! spans several pixels. For the final judgement, a cell is a single pixel.
//!
//! The cells are rendered as the pixels of a smaller picture of the same scene, whose camera has
//! the same eye and the same view direction.

use glam::{DVec2, DVec3};

use crate::{
    area::Area,
    projection::Projection,
    scene::{Camera, Image, Lens, Scene},
};

/// A grid of square cells over a picture, or over a rectangle of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Number of pixels along a cell's side.
    pub factor: u32,
    /// Columns and rows of the cells that lie inside the compared rectangle. They are counted from
    /// the top left of the whole picture.
    pub cells: Area,
    /// Number of cells in a row and in a column of the whole picture.
    pub size: [u32; 2],
    /// Width of the border of the whole picture that no cell covers, in pixels: x at the left and
    /// at the right, and y at the top and at the bottom.
    margin: DVec2,
}

impl Grid {
    /// Covers the rectangle `part` of a picture with a grid. The longer side of the rectangle has
    /// at most `longest` cells. If the rectangle contains no complete cell of this size, each pixel
    /// becomes a cell.
    pub fn new(image: &Image, part: Area, longest: u32) -> Self {
        let point = |x: u32, y: u32| DVec2::new(f64::from(x), f64::from(y));
        let of = |factor: u32| {
            let size = [image.width / factor, image.height / factor];
            let covered = f64::from(factor) * DVec2::from(size.map(f64::from));
            let margin = (point(image.width, image.height) - covered) / 2.0;
            let cell = |x, y| (point(x, y) - margin) / f64::from(factor);
            let first = cell(part.x, part.y).ceil().max(DVec2::ZERO);
            let end = cell(part.x + part.width, part.y + part.height).floor();
            let count = end.max(first) - first;
            let cells = Area {
                x: first.x as u32,
                y: first.y as u32,
                width: count.x as u32,
                height: count.y as u32,
            };
            Self {
                factor,
                cells,
                size,
                margin,
            }
        };
        let factor = part.width.max(part.height).div_ceil(longest).max(1);
        let factor = factor.min(image.width).min(image.height);
        Some(of(factor))
            .filter(|grid| grid.count() > 0)
            .unwrap_or_else(|| of(1))
    }

    /// Returns the number of cells in the compared rectangle.
    pub fn count(&self) -> usize {
        self.cells.pixels() as usize
    }

    /// Returns the number of cells in a row of the compared rectangle.
    pub fn width(&self) -> usize {
        self.cells.width as usize
    }

    /// Returns the middle of a cell, in pixels of the whole picture. `index` counts the cells of
    /// the compared rectangle, row by row.
    pub fn middle(&self, index: usize) -> DVec2 {
        let first = DVec2::new(f64::from(self.cells.x), f64::from(self.cells.y));
        let (x, y) = (index % self.width(), index / self.width());
        let cell = first + DVec2::new(x as f64, y as f64);
        self.margin + (cell + 0.5) * f64::from(self.factor)
    }

    /// Iterates over the indices of all cells that are at most `reach` columns and `reach` rows
    /// away from a cell. The cell itself is among them.
    pub fn around(&self, index: usize, reach: usize) -> impl Iterator<Item = usize> {
        let (width, height) = (self.width(), self.cells.height as usize);
        let near = |at: usize, most: usize| at.saturating_sub(reach)..(at + reach + 1).min(most);
        let columns = near(index % width, width);
        let rows = near(index / width, height);
        rows.flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }

    /// Returns the camera and the image with which a scene is rendered so that each pixel is a cell
    /// of the grid.
    pub fn view(&self, scene: &Scene) -> (Camera, Image) {
        let (mut image, mut camera) = (scene.image, scene.camera);
        if self.factor > 1 {
            let pitch = Projection::quick(&camera, &image).pitch;
            [image.width, image.height] = self.size;
            camera.lens = Lens::Distance(1.0);
            // Extreme lenses would make the height 0 or infinite, so it is clamped to positive
            // finite numbers.
            let view_height = f64::from(image.height * self.factor) * pitch;
            camera.view_height = view_height.clamp(f64::MIN_POSITIVE, f64::MAX);
        }
        (camera, image)
    }

    /// Averages the pixels in each cell, ignoring NaN. `pixel` returns the pixel in a given column
    /// and row of the whole picture.
    pub fn reduce(&self, pixel: impl Fn(u32, u32) -> DVec3) -> Vec<DVec3> {
        let factor = f64::from(self.factor);
        // Iterates over the columns (or rows) of pixels that a cell overlaps. Each item also
        // contains the width (or height) of the overlap, in pixels.
        let shares = |cell: u32, margin: f64| {
            let start = margin + f64::from(cell) * factor;
            let end = start + factor;
            let share = move |at: u32| (f64::from(at) + 1.0).min(end) - f64::from(at).max(start);
            (start.floor() as u32..end.ceil() as u32).map(move |at| (at, share(at)))
        };
        let cell = |(x, y): (u32, u32)| {
            // Differences from the first pixel are summed, so that the mean of equal pixels is
            // exact.
            let mut first = None;
            let (mut sum, mut total) = (DVec3::ZERO, 0.0);
            for (row, height) in shares(y, self.margin.y) {
                for (column, width) in shares(x, self.margin.x) {
                    let pixel = pixel(column, row);
                    if !pixel.x.is_nan() {
                        let first = *first.get_or_insert(pixel);
                        sum += width * height * (pixel - first);
                        total += width * height;
                    }
                }
            }
            first.unwrap_or(DVec3::NAN) + sum / total
        };
        self.cells.iter().map(cell).collect()
    }
}
