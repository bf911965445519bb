//! How a program arranges its pixels in the picture.

use crate::area::Area;

/// How a program arranges its pixels in the picture. If the arrangement is wrong, pixels are shown
/// in wrong places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Whether left and right are exchanged.
    pub is_mirrored: bool,
    /// Whether top and bottom are exchanged.
    pub is_upside_down: bool,
    /// Whether rows and columns are exchanged, after mirroring. Set only in a square picture.
    pub is_transposed: bool,
    /// Error of the row length, in pixels, with which the program computes where a row starts in
    /// memory. With 1, each row appears one pixel further left than the row above it. The error is
    /// applied after mirroring and transposition.
    pub stride: i32,
}

impl Layout {
    /// Returns the pixel of the correct picture that the program shows at the column x and the row
    /// y. The second argument is the size of the picture.
    pub fn source(self, (x, y): (u32, u32), [width, height]: [u32; 2]) -> (u32, u32) {
        let wide = i64::from(width);
        let all = wide * i64::from(height);
        let at = i64::from(y) * (wide + i64::from(self.stride)) + i64::from(x);
        let at = at.rem_euclid(all);
        let (x, y) = ((at % wide) as u32, (at / wide) as u32);
        let (x, y) = if self.is_transposed { (y, x) } else { (x, y) };
        let x = if self.is_mirrored { width - 1 - x } else { x };
        let y = if self.is_upside_down {
            height - 1 - y
        } else {
            y
        };
        (x, y)
    }

    /// Converts a direction in the program's picture to the same direction in the correct picture.
    /// Both are given by their parts to the right and down.
    pub fn source_direction(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = if self.is_transposed { [y, x] } else { [x, y] };
        let sign = |is_turned: bool| if is_turned { -1.0 } else { 1.0 };
        [sign(self.is_mirrored) * x, sign(self.is_upside_down) * y]
    }

    /// Returns an area of the correct picture that contains all pixels that the program shows in
    /// the area `part`. `size` is the size of the whole picture.
    pub fn sources(self, part: Area, size: [u32; 2]) -> Area {
        if self.stride != 0 {
            return Area::whole(size[0], size[1]);
        }
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
