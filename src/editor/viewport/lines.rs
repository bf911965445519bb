//! Projects lines in space into the picture.

use glam::{DVec2, DVec3};

use crate::projection::Projection;

/// Minimum depth of the visible part of a line, relative to the largest coordinate difference
/// between the eye and a point of the line. A part with less depth is cut off, since a point of
/// depth 0 would appear infinitely far away. Any small positive number would do; with a much larger
/// one, the cut would become visible.
const NEAREST: f64 = 1e-6;

/// Distance from the picture at which lines are cut off, as a multiple of the picture's width or
/// height. Browsers draw in single precision, which is exact to a tenth of a pixel up to 2^20
/// pixels. A page shows a picture with at most 8192 pixels in a row, and 128 · 8192 = 2^20.
const REACH: f64 = 128.0;

/// A polygonal line through points of the picture, in pixels.
pub type Polyline = Vec<DVec2>;

impl Projection {
    /// Returns the visible parts of a polygonal line through points in space. The line is divided
    /// if a part of it is behind the eye or too far outside of the picture.
    pub fn line(&self, points: &[DVec3]) -> Vec<Polyline> {
        let far = points
            .iter()
            .map(|point| (point - self.eye).abs().max_element());
        let nearest = NEAREST * far.fold(0.0, f64::max);
        let segments = points.windows(2).filter_map(|pair| {
            let depths = [self.depth(pair[0]), self.depth(pair[1])];
            let cut = || pair[0].lerp(pair[1], (nearest - depths[0]) / (depths[1] - depths[0]));
            let [from, to] = match depths.map(|depth| depth > nearest) {
                [true, true] => [pair[0], pair[1]],
                [true, false] => [pair[0], cut()],
                [false, true] => [cut(), pair[1]],
                [false, false] => return None,
            };
            Some([self.point(from)?, self.point(to)?])
        });
        self.joined(segments)
    }

    /// Joins segments in the picture to polygonal lines. A segment that starts where the previous
    /// one ends continues its line. Parts that are farther outside of the picture than 128 times
    /// its width or height are cut off, since browsers cannot draw them exactly.
    pub fn joined(&self, segments: impl IntoIterator<Item = [DVec2; 2]>) -> Vec<Polyline> {
        let mut lines: Vec<Polyline> = Vec::new();
        let segments = segments.into_iter();
        for [from, to] in segments.filter_map(|segment| self.clip(segment, REACH)) {
            match lines.last_mut() {
                Some(line) if line.last() == Some(&from) => line.push(to),
                _ => lines.push(vec![from, to]),
            }
        }
        lines
    }

    /// Clips a segment in the picture to a rectangle: the picture, enlarged on each side by `grown`
    /// times its width or height. Returns `None` if no part of the segment is left.
    pub(super) fn clip(&self, segment: [DVec2; 2], grown: f64) -> Option<[DVec2; 2]> {
        clip(segment, [-grown * self.size, (1.0 + grown) * self.size])
    }

    /// Returns the line in the picture at which rays from the eye rise by `height` metres per metre
    /// of depth. For 0, this is the horizon. The line is clipped to the picture, enlarged by its
    /// own size on each side. Returns `None` if no part of the line is left.
    pub fn level(&self, height: f64) -> Option<[DVec2; 2]> {
        // The ray through the pixel (x, y) of a picture of w × h pixels has, at depth 1, the height
        //
        //   ahead.y + pitch · (right.y · (x − w/2) − top.y · (y − h/2)).
        //
        // Here `ahead`, `right` and `top` are the camera's axes, and `pitch` is the side of a pixel
        // at depth 1. On the returned line, this height is `height`.
        let normal = DVec2::new(self.right.y, -self.top.y) * self.pitch;
        let middle = self.size / 2.0;
        // `foot` is the line's point nearest to the middle of the picture, and `along` is the
        // line's direction.
        let foot = middle + normal * ((height - self.ahead.y) / normal.length_squared());
        let along = normal.perp().normalize_or_zero();
        let far = along * (foot.distance(middle) + 3.0 * self.size.length());
        let is_somewhere = far.is_finite() && along != DVec2::ZERO;
        is_somewhere.then(|| self.clip([foot - far, foot + far], 1.0))?
    }
}

/// Clips a segment to a rectangle by the algorithm of Liang and Barsky. The rectangle is given by
/// two opposite corners: the one with the least coordinates, and the one with the greatest. Returns
/// `None` if no part of the segment is left.
pub fn clip([from, to]: [DVec2; 2], rectangle: [DVec2; 2]) -> Option<[DVec2; 2]> {
    let along = to - from;
    let (mut first, mut last): (f64, f64) = (0.0, 1.0);
    for axis in 0..2 {
        let ends = rectangle.map(|corner| corner[axis] - from[axis]);
        if along[axis] != 0.0 {
            let [a, b] = ends.map(|end| end / along[axis]);
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        } else if ends[0] > 0.0 || ends[1] < 0.0 {
            return None;
        }
    }
    (first < last).then(|| [first, last].map(|part| from.lerp(to, part)))
}
