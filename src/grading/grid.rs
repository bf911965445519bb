//! A grid over the part of a picture that is compared, of cells of some pixels each: a coarse one
//! to search on, the pixels themselves to judge on.
//!
//! The cells are the pixels of a smaller picture of the scene, around the same middle, so whatever
//! makes pictures makes that of the cells.

use glam::{DVec2, DVec3};

use crate::{
    area::Area,
    projection::Projection,
    scene::{Camera, Image, Lens, Scene},
};

/// The grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The pixels along a cell's side.
    pub factor: u32,
    /// The cells that lie in the part, of those of the whole picture.
    pub cells: Area,
    /// How many cells the whole picture has in a row and in a column.
    size: [u32; 2],
    /// What is left over of the whole picture on each side, in pixels.
    margin: DVec2,
    /// The part's corner.
    corner: DVec2,
}

impl Grid {
    /// The grid over a part of a picture, of which the longer side has so many cells at most.
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

    /// How many cells lie in the part.
    pub fn count(&self) -> usize {
        self.cells.pixels() as usize
    }

    /// How many of them lie in a row.
    pub fn width(&self) -> usize {
        self.cells.width as usize
    }

    /// How many cells the whole picture has in a row and in a column.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The pixel of the whole picture in the middle of the cell of an index.
    pub fn middle(&self, index: usize) -> DVec2 {
        let (x, y) = (index % self.width(), index / self.width());
        let cell = DVec2::new(
            f64::from(self.cells.x) + x as f64,
            f64::from(self.cells.y) + y as f64,
        );
        self.margin + (cell + 0.5) * f64::from(self.factor)
    }

    /// The indices of a cell and of those so far around it.
    pub fn around(&self, index: usize, reach: usize) -> impl Iterator<Item = usize> {
        let (width, height) = (self.width(), self.cells.height as usize);
        let near = |at: usize, most: usize| at.saturating_sub(reach)..(at + reach + 1).min(most);
        let columns = near(index % width, width);
        let rows = near(index / width, height);
        rows.flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }

    /// The view of a scene whose pixels the cells are.
    pub fn view(&self, scene: &Scene) -> (Camera, Image) {
        let (mut image, mut camera) = (scene.image, scene.camera);
        if self.factor > 1 {
            let pitch = Projection::quick(&camera, &image).pitch;
            [image.width, image.height] = self.size;
            camera.lens = Lens::Distance(1.0);
            // Within the range of numbers, however long or short the lens is.
            let view_height = f64::from(image.height * self.factor) * pitch;
            camera.view_height = view_height.clamp(f64::MIN_POSITIVE, f64::MAX);
        }
        (camera, image)
    }

    /// The means of the part's pixels, told by column and row in it, but for those without a
    /// number.
    pub fn reduce(&self, pixel: impl Fn(u32, u32) -> DVec3) -> Vec<DVec3> {
        let factor = f64::from(self.factor);
        // The pixels that a cell has a share of, in columns or in rows, and how much of each.
        let shares = |cell: u32, margin: f64, corner: f64| {
            let start = margin + f64::from(cell) * factor - corner;
            let end = start + factor;
            let share = move |at: u32| (f64::from(at) + 1.0).min(end) - f64::from(at).max(start);
            (start.floor() as u32..end.ceil() as u32).map(move |at| (at, share(at)))
        };
        let cell = |(x, y): (u32, u32)| {
            // From the first on, so that what is one everywhere is not rounded.
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
