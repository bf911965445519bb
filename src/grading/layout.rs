//! How a program may lay out its picture.

use crate::area::Area;

/// How a picture is laid out otherwise than it should be: in place of a pixel that of another place is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Left and right are exchanged.
    pub is_mirrored: bool,
    /// Top and bottom are.
    pub is_upside_down: bool,
    /// Then rows and columns are, in a square picture.
    pub is_transposed: bool,
    /// Then so many half pixels to the right and down of each place are shown.
    pub half_pixels: [i32; 2],
}

impl Layout {
    /// How many more pixels the picture has that it is taken from, half of them on each side.
    pub fn more(self) -> [u32; 2] {
        self.half_pixels.map(i32::unsigned_abs)
    }

    /// The pixel that is shown in the place of one, in a picture of a size.
    pub fn source(self, (x, y): (u32, u32), [width, height]: [u32; 2]) -> (u32, u32) {
        let (x, y) = if self.is_transposed { (y, x) } else { (x, y) };
        let x = if self.is_mirrored { width - 1 - x } else { x };
        let y = if self.is_upside_down {
            height - 1 - y
        } else {
            y
        };
        let [right, down] = self.half_pixels.map(|half| half.max(0).unsigned_abs());
        (x + right, y + down)
    }

    /// The part of a picture of a size that is shown in the place of a part; where it is shifted, all that any shift shows.
    pub fn sources(self, part: Area, size: [u32; 2]) -> Area {
        let [wider, taller] = self.more();
        let layout = Self {
            half_pixels: [0, 0],
            ..self
        };
        let last = (part.x + part.width - 1, part.y + part.height - 1);
        let (ax, ay) = layout.source((part.x, part.y), size);
        let (bx, by) = layout.source(last, size);
        Area {
            x: ax.min(bx),
            y: ay.min(by),
            width: ax.abs_diff(bx) + 1 + wider,
            height: ay.abs_diff(by) + 1 + taller,
        }
    }
}
