//! A grid over the part of a picture that is compared, whose cells span several pixels each: coarse
//! for searching, single pixels for judging.
//!
//! The cells are the pixels of a smaller picture of the scene around the same middle, so whatever
//! renders pictures renders cells.

use glam::{DVec2, DVec3};

use crate::{
    area::Area,
    projection::Projection,
    scene::{Camera, Image, Lens, Scene},
};

/// A grid of square cells over a part of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Number of pixels along a cell's side.
    pub factor: u32,
    /// The cells inside the part, among those of the whole picture.
    pub cells: Area,
    /// Number of cells in a row and in a column of the whole picture.
    size: [u32; 2],
    /// Width of the border of the whole picture without cells, on each side, in pixels.
    margin: DVec2,
    /// The part's upper left corner, in pixels.
    corner: DVec2,
}

impl Grid {
    /// Covers a part of a picture with at most `longest` cells along its longer side.
    pub fn new(image: &Image, part: Area, longest: u32) -> Self {
        let of = |factor: u32| {
            let size = [image.width / factor, image.height / factor];
            let left = |pixels: u32, cells: u32| f64::from(pixels - cells * factor) / 2.0;
            let margin = DVec2::new(left(image.width, size[0]), left(image.height, size[1]));
            let within = |start: u32, length: u32, margin: f64| {
                let cell = |at: u32| (f64::from(at) - margin) / f64::from(factor);
                let first = cell(start).ceil().max(0.0) as u32;
                first..(cell(start + length).floor() as u32).max(first)
            };
            let columns = within(part.x, part.width, margin.x);
            let rows = within(part.y, part.height, margin.y);
            Self {
                factor,
                cells: Area {
                    x: columns.start,
                    y: rows.start,
                    width: columns.len() as u32,
                    height: rows.len() as u32,
                },
                size,
                margin,
                corner: DVec2::new(f64::from(part.x), f64::from(part.y)),
            }
        };
        let factor = part.width.max(part.height).div_ceil(longest).max(1);
        let factor = factor.min(image.width).min(image.height);
        Some(of(factor))
            .filter(|grid| grid.count() > 0)
            .unwrap_or_else(|| of(1))
    }

    /// Returns the number of cells in the part.
    pub fn count(&self) -> usize {
        self.cells.pixels() as usize
    }

    /// Returns the number of the part's cells in a row.
    pub fn width(&self) -> usize {
        self.cells.width as usize
    }

    /// Returns the number of cells in a row and in a column of the whole picture.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the middle of a cell, given by its index, in pixels of the whole picture.
    pub fn middle(&self, index: usize) -> DVec2 {
        let (x, y) = (index % self.width(), index / self.width());
        let cell = DVec2::new(
            f64::from(self.cells.x) + x as f64,
            f64::from(self.cells.y) + y as f64,
        );
        self.margin + (cell + 0.5) * f64::from(self.factor)
    }

    /// Iterates over the indices of the cells within `reach` columns and rows of a cell, including
    /// it.
    pub fn around(&self, index: usize, reach: usize) -> impl Iterator<Item = usize> {
        let (width, height) = (self.width(), self.cells.height as usize);
        let near = |at: usize, most: usize| at.saturating_sub(reach)..(at + reach + 1).min(most);
        let columns = near(index % width, width);
        let rows = near(index / width, height);
        rows.flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }

    /// Returns the camera and image whose pixels are the cells.
    pub fn view(&self, scene: &Scene) -> (Camera, Image) {
        let (mut image, mut camera) = (scene.image, scene.camera);
        if self.factor > 1 {
            let pitch = Projection::quick(&camera, &image).pitch;
            [image.width, image.height] = self.size;
            camera.lens = Lens::Distance(1.0);
            // Clamped to positive finite numbers, for extreme lenses.
            let view_height = f64::from(image.height * self.factor) * pitch;
            camera.view_height = view_height.clamp(f64::MIN_POSITIVE, f64::MAX);
        }
        (camera, image)
    }

    /// Averages the part's pixels, given by column and row in the part, over each cell, ignoring
    /// NaN.
    pub fn reduce(&self, pixel: impl Fn(u32, u32) -> DVec3) -> Vec<DVec3> {
        let factor = f64::from(self.factor);
        // The columns or rows of a cell's pixels, and the length of each inside the cell.
        let shares = |cell: u32, margin: f64, corner: f64| {
            let start = margin + f64::from(cell) * factor - corner;
            let end = start + factor;
            let share = move |at: u32| (f64::from(at) + 1.0).min(end) - f64::from(at).max(start);
            (start.floor() as u32..end.ceil() as u32).map(move |at| (at, share(at)))
        };
        let cell = |(x, y): (u32, u32)| {
            // Differences from the first pixel are summed, so that a constant is not rounded.
            let mut first = None;
            let (mut sum, mut total) = (DVec3::ZERO, 0.0);
            for (row, height) in shares(y, self.margin.y, self.corner.y) {
                for (column, width) in shares(x, self.margin.x, self.corner.x) {
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
