//! Rectangles of pixels.

use std::{fmt, str::FromStr};

/// A rectangle of pixels. Columns and rows are counted from the picture's top left corner.
///
/// [`lies_in`](Self::lies_in), [`meets`](Self::meets), [`common`](Self::common) and
/// [`with`](Self::with) work for any numbers. The other methods may panic or return wrong areas if
/// `x + width` or `y + height` exceeds `u32::MAX`. In every part of a picture, these sums are
/// smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// Leftmost column.
    pub x: u32,
    /// Topmost row.
    pub y: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
}

impl Area {
    /// Returns the area of a whole picture.
    pub fn whole(width: u32, height: u32) -> Self {
        Self {
            x: 0,
            y: 0,
            width,
            height,
        }
    }

    /// Returns the area of a single pixel.
    pub fn pixel(x: u32, y: u32) -> Self {
        let area = Self::whole(1, 1);
        Self { x, y, ..area }
    }

    /// Returns the number of pixels.
    pub fn pixels(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Returns whether the area lies within `other`.
    pub fn lies_in(self, other: Self) -> bool {
        self.common(other) == self
    }

    /// Returns whether the two areas have a pixel in common.
    pub fn meets(self, other: Self) -> bool {
        self.columns().start < other.columns().end
            && other.columns().start < self.columns().end
            && self.rows().start < other.rows().end
            && other.rows().start < self.rows().end
    }

    /// Returns the smallest area that contains both areas. Its width and height are limited to
    /// `u32::MAX`.
    pub fn with(self, other: Self) -> Self {
        let (x, y) = (self.x.min(other.x), self.y.min(other.y));
        let length = |end: u64, other_end: u64, start: u32| {
            let length = end.max(other_end) - u64::from(start);
            u32::try_from(length).unwrap_or(u32::MAX)
        };
        Self {
            x,
            y,
            width: length(self.columns().end, other.columns().end, x),
            height: length(self.rows().end, other.rows().end, y),
        }
    }

    /// Returns the column and row of each pixel, row by row.
    pub fn iter(self) -> impl Iterator<Item = (u32, u32)> {
        (0..self.height)
            .flat_map(move |row| (0..self.width).map(move |column| (self.x + column, self.y + row)))
    }

    /// Returns the index of a pixel within the area, counted row by row. `x` and `y` are the
    /// pixel's column and row in the picture. The pixel must lie in the area; otherwise, the index
    /// is wrong.
    ///
    /// # Panics
    ///
    /// May panic if the pixel lies to the left of the area or above it.
    pub fn index(self, x: u32, y: u32) -> usize {
        (y - self.y) as usize * self.width as usize + (x - self.x) as usize
    }

    /// Divides the area into tiles, squares of side `side` in pixels, and returns them row by row.
    /// The first tile lies in the area's top left corner. Tiles at the right and bottom edges are
    /// clipped to the area.
    ///
    /// # Panics
    ///
    /// Panics if `side` is 0.
    pub fn tiles(self, side: u32) -> impl Iterator<Item = Self> {
        let starts = move |length: u32| (0..length).step_by(side as usize);
        starts(self.height).flat_map(move |top| {
            starts(self.width).map(move |left| Self {
                x: self.x + left,
                y: self.y + top,
                width: side.min(self.width - left),
                height: side.min(self.height - top),
            })
        })
    }

    /// Divides the whole picture into squares of side `side`, in pixels, starting at its top left
    /// corner. Returns the squares that overlap the area, row by row. The squares are not clipped.
    ///
    /// # Panics
    ///
    /// Panics if `side` is 0.
    pub fn grid(self, side: u32) -> impl Iterator<Item = Self> {
        let starts = move |start: u32, length: u32| {
            (start - start % side..start + length).step_by(side as usize)
        };
        let square = Self::whole(side, side);
        starts(self.y, self.height)
            .flat_map(move |y| starts(self.x, self.width).map(move |x| Self { x, y, ..square }))
    }

    /// Returns the intersection of two areas. It has no pixels if they do not overlap.
    pub fn common(self, other: Self) -> Self {
        let (x, y) = (self.x.max(other.x), self.y.max(other.y));
        let length = |end: u64, other_end: u64, start: u32| {
            end.min(other_end).saturating_sub(u64::from(start)) as u32
        };
        Self {
            x,
            y,
            width: length(self.columns().end, other.columns().end, x),
            height: length(self.rows().end, other.rows().end, y),
        }
    }

    /// Returns the same area with columns and rows counted from the top left corner of `outer`,
    /// which must contain it.
    ///
    /// # Panics
    ///
    /// Panics if `outer` does not contain the area.
    pub fn within(self, outer: Self) -> Self {
        assert!(
            self.lies_in(outer),
            "the area {self} does not lie in {outer}"
        );
        Self {
            x: self.x - outer.x,
            y: self.y - outer.y,
            ..self
        }
    }

    /// Divides the area into quarters of nearly equal size. An area of one row or one column is
    /// divided into two parts, and a single pixel is not divided.
    pub fn quarters(self) -> impl Iterator<Item = Self> {
        let halves = |length: u32| [(0, length / 2), (length / 2, length - length / 2)];
        let (columns, rows) = (halves(self.width), halves(self.height));
        let quarters = rows.into_iter().flat_map(move |(y, height)| {
            columns.into_iter().map(move |(x, width)| Self {
                x: self.x + x,
                y: self.y + y,
                width,
                height,
            })
        });
        quarters.filter(|quarter| quarter.width > 0 && quarter.height > 0)
    }

    /// Returns the pixel in the middle of the area. If two columns or two rows are equally close to
    /// the middle, chooses the second.
    pub fn middle(self) -> Self {
        Self::pixel(self.x + self.width / 2, self.y + self.height / 2)
    }

    // The range is in `u64`, because its end, `x + width`, may exceed `u32::MAX` if a user has
    // typed the area.
    fn columns(self) -> std::ops::Range<u64> {
        u64::from(self.x)..u64::from(self.x) + u64::from(self.width)
    }

    fn rows(self) -> std::ops::Range<u64> {
        u64::from(self.y)..u64::from(self.y) + u64::from(self.height)
    }
}

/// Writes an area as `X,Y,W,H`: leftmost column, topmost row, width and height, in pixels.
impl fmt::Display for Area {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{},{}", self.x, self.y, self.width, self.height)
    }
}

/// Parses an area in the form `X,Y,W,H`, four whole numbers. Fails if the text has another form, or
/// if W or H is 0.
impl FromStr for Area {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers: Option<Vec<u32>> = text
            .split(',')
            .map(|number| number.trim().parse().ok())
            .collect();
        match numbers.as_deref() {
            Some(&[_, _, 0, _] | &[_, _, _, 0]) => {
                Err("width and height are at least 1".to_owned())
            }
            Some(&[x, y, width, height]) => Ok(Self {
                x,
                y,
                width,
                height,
            }),
            _ => Err("four whole numbers are wanted: X,Y,W,H".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_every_pixel_once() {
        let whole = Area::whole(10, 7);
        let area = Area {
            x: 3,
            y: 5,
            ..whole
        };
        let mut hits = vec![0; area.pixels() as usize];
        for tile in area.tiles(4) {
            assert!(tile.lies_in(area) && tile.meets(area));
            for (x, y) in tile.iter() {
                hits[area.index(x, y)] += 1;
            }
        }
        assert!(hits.iter().all(|&n| n == 1));
    }

    #[test]
    fn neighbours_do_not_meet() {
        let [left, right] = [0, 4].map(|x| Area {
            x,
            ..Area::whole(4, 4)
        });
        assert!(!left.meets(right) && !right.meets(left) && left.meets(left));
        assert!(!right.lies_in(left) && left.lies_in(left));
        let huge = Area {
            x: u32::MAX,
            y: 1,
            width: u32::MAX,
            height: 1,
        };
        assert!(!huge.lies_in(left) && !huge.meets(left));
        let both = huge.with(left);
        assert_eq!(
            (both.x, both.y, both.width, both.height),
            (0, 0, u32::MAX, 4)
        );
    }

    #[test]
    #[should_panic(expected = "the area 0,0,4,4 does not lie in 1,0,4,4")]
    fn an_area_is_not_within_another_beside_it() {
        let area = Area::whole(4, 4);
        area.within(Area { x: 1, ..area });
    }
}
