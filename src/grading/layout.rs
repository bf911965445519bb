//! How a program may lay out its picture.

use crate::area::Area;

/// How a picture is laid out otherwise than it should be: in place of a pixel that of another place
/// is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Left and right are exchanged.
    pub is_mirrored: bool,
    /// Top and bottom are.
    pub is_upside_down: bool,
    /// Then rows and columns are, in a square picture.
    pub is_transposed: bool,
}

impl Layout {
    /// The pixel that is shown in the place of one, in a picture of a size.
    pub fn source(self, (x, y): (u32, u32), [width, height]: [u32; 2]) -> (u32, u32) {
        let (x, y) = if self.is_transposed { (y, x) } else { (x, y) };
        let x = if self.is_mirrored { width - 1 - x } else { x };
        let y = if self.is_upside_down {
            height - 1 - y
        } else {
            y
        };
        (x, y)
    }

    /// The direction in the source of a direction in the picture, to the right and down.
    pub fn source_direction(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = if self.is_transposed { [y, x] } else { [x, y] };
        let sign = |is_turned: bool| if is_turned { -1.0 } else { 1.0 };
        [sign(self.is_mirrored) * x, sign(self.is_upside_down) * y]
    }

    /// The part of a picture of a size that is shown in the place of a part.
    pub fn sources(self, part: Area, size: [u32; 2]) -> Area {
        let last = (part.x + part.width - 1, part.y + part.height - 1);
        let (ax, ay) = self.source((part.x, part.y), size);
        let (bx, by) = self.source(last, size);
        Area {
            x: ax.min(bx),
            y: ay.min(by),
            width: ax.abs_diff(bx) + 1,
            height: ay.abs_diff(by) + 1,
        }
    }
}
