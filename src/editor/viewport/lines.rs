//! Lines of the world as lines of the picture.

use glam::{DVec2, DVec3};

use crate::projection::Projection;

/// Lines are cut off where they come nearer to the plane of the eye than this part of their size: a
/// point in it is infinitely far away in the picture.
const NEAREST: f64 = 1e-6;

/// Lines are cut off so many picture sizes outside of it: browsers draw in single precision, in
/// which a tenth of a pixel is kept up to 2^20 pixels, and a page shows a picture with up to 8192
/// in a row.
const REACH: f64 = 128.0;

/// A line through some points of the picture.
pub type Line = Vec<DVec2>;

impl Projection {
    /// What is seen of a line through some points: several lines where parts of it are not in front
    /// of the eye, or too far outside of the picture.
    pub fn line(&self, points: &[DVec3]) -> Vec<Line> {
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

    /// Segments of the picture, or what of them is not too far outside, as lines: one goes on where
    /// the next segment begins where it ends.
    pub fn joined(&self, segments: impl IntoIterator<Item = [DVec2; 2]>) -> Vec<Line> {
        let mut lines: Vec<Line> = Vec::new();
        let segments = segments.into_iter();
        for [from, to] in segments.filter_map(|segment| self.clip(segment, REACH)) {
            match lines.last_mut() {
                Some(line) if line.last() == Some(&from) => line.push(to),
                _ => lines.push(vec![from, to]),
            }
        }
        lines
    }

    /// The part of a segment in the picture grown by so many of its sizes on each side (Liang and
    /// Barsky's algorithm).
    pub(super) fn clip(&self, [from, to]: [DVec2; 2], grown: f64) -> Option<[DVec2; 2]> {
        let along = to - from;
        let (mut first, mut last): (f64, f64) = (0.0, 1.0);
        for axis in 0..2 {
            let ends = [-grown, 1.0 + grown].map(|end| end * self.size[axis] - from[axis]);
            if along[axis] != 0.0 {
                let [a, b] = ends.map(|end| end / along[axis]);
                (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
            } else if ends[0] > 0.0 || ends[1] < 0.0 {
                return None;
            }
        }
        (first < last).then(|| [first, last].map(|part| from.lerp(to, part)))
    }

    /// The image of all directions whose y, at a depth of 1, is this: a line from one edge to
    /// another of the picture grown by its own size on each side. None where there is none, or
    /// where it does not cross that.
    pub fn level(&self, height: f64) -> Option<[DVec2; 2]> {
        // The ray through (x, y) has the height ahead.y + (right.y (x − w/2) − top.y (y − h/2))
        // pitch.
        let normal = DVec2::new(self.right.y, -self.top.y) * self.pitch;
        let middle = self.size / 2.0;
        // The point of it that is nearest to the middle, and its direction.
        let foot = middle + normal * ((height - self.ahead.y) / normal.length_squared());
        let along = normal.perp().normalize_or_zero();
        let far = along * (foot.distance(middle) + 3.0 * self.size.length());
        let is_somewhere = far.is_finite() && along != DVec2::ZERO;
        is_somewhere.then(|| self.clip([foot - far, foot + far], 1.0))?
    }
}
