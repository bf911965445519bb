//! Clipping of convex polygons by lines. All of `exact` uses these functions, except `strips_simd`,
//! which cuts eight pixels at once.
//!
//! In: a convex polygon and a linear form. Out: the parts on both sides of the line where the form
//! is 0 (Sutherland and Hodgman, "Reentrant polygon clipping", 1974). A new corner lies where a
//! side of the polygon crosses this line. Rounding displaces the corner by a few unit roundoffs
//! along the side. Callers add this error to their bounds.

use glam::DVec2;

/// Corners of the pixel, or of a sub-pixel in its own coordinates, where the middle is (0, 0) and
/// the side is 1. They are in order around the pixel, from (−½, −½) first along the x axis.
pub(super) const PIXEL: [DVec2; 4] = [
    DVec2::new(-0.5, -0.5),
    DVec2::new(0.5, -0.5),
    DVec2::new(0.5, 0.5),
    DVec2::new(-0.5, 0.5),
];

/// Segment of the cutting line inside a polygon; `None` if the line misses the polygon.
pub(super) type Chord = Option<[DVec2; 2]>;

/// Splits a convex polygon by a linear form. Appends the vertices of the part where `form` is not
/// positive to `negative`, and of the part where it is not negative to `positive`. Returns the
/// chord between the parts, or `None` if the line misses the polygon.
pub(super) fn split(
    polygon: &[DVec2],
    form: impl Fn(DVec2) -> f64,
    negative: &mut Vec<DVec2>,
    positive: &mut Vec<DVec2>,
) -> Chord {
    let mut before = polygon.last().map(|&last| (last, form(last)))?;
    let mut chord: Chord = None;
    let mut meet = |at: DVec2| chord = Some([chord.map_or(at, |[first, _]| first), at]);
    for &point in polygon {
        let side = form(point);
        if (side > 0.0 && before.1 < 0.0) || (side < 0.0 && before.1 > 0.0) {
            let at = before.0 + (point - before.0) * (before.1 / (before.1 - side));
            negative.push(at);
            positive.push(at);
            meet(at);
        }
        if side <= 0.0 {
            negative.push(point);
        }
        if side >= 0.0 {
            positive.push(point);
        }
        if side == 0.0 {
            meet(point);
        }
        before = (point, side);
    }
    chord
}

/// Returns the signed area of a polygon, and its perimeter. In the perimeter, the length of a side
/// is measured as |dx| + |dy|.
pub(super) fn measure(polygon: &[DVec2]) -> (f64, f64) {
    let Some((&origin, others)) = polygon.split_first() else {
        return (0.0, 0.0);
    };
    let (mut twice, mut perimeter, mut before) = (0.0, 0.0, DVec2::ZERO);
    for point in others.iter().map(|&p| p - origin) {
        twice += before.perp_dot(point);
        perimeter += (point.x - before.x).abs() + (point.y - before.y).abs();
        before = point;
    }
    (0.5 * twice, perimeter + before.x.abs() + before.y.abs())
}
