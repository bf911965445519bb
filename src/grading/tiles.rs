//! The shapes that may be seen in each tile of a picture, so that a ray is asked about few.

use glam::DVec2;

/// The shapes that may be seen in each tile of a picture, in their order.
pub struct Tiles {
    /// The corner of the first tile, and how many tiles there are in a pixel.
    corner: DVec2,
    scale: DVec2,
    columns: usize,
    rows: usize,
    /// Where those of each tile begin among all.
    starts: Vec<u32>,
    shapes: Vec<u32>,
}

/// So many tiles are in a row and in a column at most: as many as the cells of the smallest grid, which most scenes are compared on.
const MOST_TILES: f64 = 32.0;

impl Tiles {
    /// Tiles over a part of the picture, from the part that each shape lies in.
    pub fn new(bounds: &[[DVec2; 2]], corner: DVec2, size: DVec2) -> Self {
        let count = size.ceil().min(DVec2::splat(MOST_TILES));
        let (columns, rows) = (count.x as usize, count.y as usize);
        let scale = count / size;
        // Casts leave nothing below 0, nor of what is no number.
        let within = |least: f64, most: f64, count: usize| {
            least.floor() as usize..((most.floor() + 1.0) as usize).min(count)
        };
        let tiles = |[least, most]: &[DVec2; 2]| {
            let [least, most] = [least, most].map(|place| (place - corner) * scale);
            let columns_of = within(least.x, most.x, columns);
            within(least.y, most.y, rows)
                .flat_map(move |row| columns_of.clone().map(move |column| row * columns + column))
        };
        let mut starts = vec![0; columns * rows + 1];
        for tile in bounds.iter().flat_map(tiles) {
            starts[tile + 1] += 1;
        }
        for tile in 0..columns * rows {
            starts[tile + 1] += starts[tile];
        }
        let mut shapes = vec![0; starts[columns * rows] as usize];
        let mut ends = starts.clone();
        for (shape, bounds) in (0..).zip(bounds) {
            for tile in tiles(bounds) {
                shapes[ends[tile] as usize] = shape;
                ends[tile] += 1;
            }
        }
        Self {
            corner,
            scale,
            columns,
            rows,
            starts,
            shapes,
        }
    }

    /// Those that may be seen at a place.
    pub fn at(&self, place: DVec2) -> &[u32] {
        let tile = (place - self.corner) * self.scale;
        let column = (tile.x as usize).min(self.columns - 1);
        let row = (tile.y as usize).min(self.rows - 1);
        let at = row * self.columns + column;
        &self.shapes[self.starts[at] as usize..self.starts[at + 1] as usize]
    }
}
