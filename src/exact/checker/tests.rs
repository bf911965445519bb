//! Compares the board's integral over a polygon with an independent sum over squares, and with the
//! sum of the integrals over parts of the polygon. Some of the polygons reach the horizon.

mod bounds;

use std::sync::atomic::AtomicBool;

use glam::{DMat3, DVec2};
use proptest::prelude::*;

use super::{
    super::{DEFAULT_TOLERANCE, budget::PixelBudget, clip::PIXEL, conic_segment::Arc},
    BoundedSum, Homography,
};
use crate::cancel;

/// Returns a budget that is never cancelled.
fn budget() -> PixelBudget<'static> {
    PixelBudget::new(DEFAULT_TOLERANCE, &cancel::NEVER)
}

impl Homography {
    /// Integrates the board's sign over a polygon, with the default tolerance and without
    /// cancellation.
    pub(super) fn alone(&self, polygon: &[DVec2]) -> BoundedSum {
        self.over(polygon, &budget())
    }
}

/// One pixel in the picture of a level camera. `height` is the eye's height above the board in
/// squares, `focal` the focal length in pixels, and `degrees` the camera's direction. `place` is
/// the pixel's position, in pixels to the right of and below the centre of the horizon. `foot` is
/// the point of the board below the eye, in squares.
#[derive(Clone, Copy, Debug)]
struct PixelView {
    height: f64,
    focal: f64,
    degrees: f64,
    place: DVec2,
    foot: DVec2,
}

impl PixelView {
    fn forms(&self) -> [[f64; 3]; 3] {
        let Self {
            height,
            focal,
            place,
            foot,
            ..
        } = *self;
        let angle = self.degrees.to_radians();
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let below = [0.0, 1.0 / (focal * height), place.y / (focal * height)];
        let x = place.x / focal;
        let a = [
            -sin / focal,
            foot.x * below[1],
            cos - sin * x + foot.x * below[2],
        ];
        let b = [
            cos / focal,
            foot.y * below[1],
            sin + cos * x + foot.y * below[2],
        ];
        [a, b, below]
    }

    fn board(&self) -> Homography {
        let [a, b, below] = self.forms();
        Homography::new([a, b], below)
    }
}

fn value(form: [f64; 3], p: DVec2) -> f64 {
    form[0] * p.x + form[1] * p.y + form[2]
}

fn clip(polygon: &[DVec2], side: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::new();
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (d, e) = (side(p), side(q));
        if d >= 0.0 {
            kept.push(p);
        }
        if d * e < 0.0 {
            kept.push(p + (q - p) * (d / (d - e)));
        }
    }
    kept
}

fn area(polygon: &[DVec2]) -> f64 {
    let Some(&o) = polygon.first() else {
        return 0.0;
    };
    0.5 * polygon
        .windows(2)
        .map(|pair| (pair[0] - o).perp_dot(pair[1] - o))
        .sum::<f64>()
}

/// Integrates the sign of the board with the linear forms `forms` over a polygon, square by square.
/// Projects the corners of each square to the picture and clips the square to the polygon.
fn brute(forms: [[f64; 3]; 3], polygon: &[DVec2]) -> f64 {
    let m = DMat3::from_cols_array_2d(&forms).transpose();
    let inverse = m.inverse();
    let inside = area(polygon).signum();
    let floor: Vec<DVec2> = polygon
        .iter()
        .map(|&p| DVec2::new(value(forms[0], p), value(forms[1], p)) / value(forms[2], p))
        .collect();
    let low = floor.iter().fold(DVec2::INFINITY, |m, &p| m.min(p)).floor();
    let high = floor
        .iter()
        .fold(DVec2::NEG_INFINITY, |m, &p| m.max(p))
        .floor();
    let nearest = polygon
        .iter()
        .fold(f64::INFINITY, |m, &p| m.min(1.0 / value(forms[2], p)));
    let mut sum = 0.0;
    let mut i = low.x;
    while i <= high.x {
        let strip = clip(&clip(&floor, |p| p.x - i + 1e-9), |p| i + 1.0 + 1e-9 - p.x);
        let first = strip.iter().fold(f64::INFINITY, |m, p| m.min(p.y)).floor() - 1.0;
        let last = strip
            .iter()
            .fold(f64::NEG_INFINITY, |m, p| m.max(p.y))
            .floor()
            + 1.0;
        let mut j = first;
        while j <= last {
            let seen = |q: DVec2| inverse * q.extend(1.0);
            // A square may reach behind the eye, where the depth m is negative. So it is clipped at
            // half the least depth of the polygon.
            let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
                .map(|(x, y)| DVec2::new(i + x, j + y));
            let before = clip(&corners, |q| seen(q).z - 0.5 * nearest);
            let mut square: Vec<DVec2> = before
                .iter()
                .map(|&q| seen(q).truncate() / seen(q).z)
                .collect();
            for (k, &p) in polygon.iter().enumerate() {
                let along = polygon[(k + 1) % polygon.len()] - p;
                square = clip(&square, |q| inside * along.perp_dot(q - p));
            }
            sum += if (i + j) % 2.0 == 0.0 {
                area(&square).abs()
            } else {
                -area(&square).abs()
            };
            j += 1.0;
        }
        i += 1.0;
    }
    sum
}

fn view(degrees: f64, depth: f64) -> PixelView {
    PixelView {
        height: 3.5,
        focal: 704.0,
        degrees,
        place: DVec2::new(40.0, 3.5 * 704.0 / depth),
        foot: DVec2::new(0.3, 0.45),
    }
}

fn agree(found: BoundedSum, expected: f64, most: f64, what: impl std::fmt::Debug) {
    agree_in_size(found, expected, 1.0, most, what);
}

/// Asserts that the error of `found` is within its bound and at most `most`. `size` is twice the
/// largest coordinate in the computation of `expected`. The rounding errors of `expected` are
/// proportional to `size`.
fn agree_in_size(
    found: BoundedSum,
    expected: f64,
    size: f64,
    most: f64,
    what: impl std::fmt::Debug,
) {
    const ROUNDINGS: f64 = 64.0 * f64::EPSILON;
    let error = (found.value - expected).abs();
    assert!(
        error <= found.bound + ROUNDINGS * size && error <= most,
        "{what:?}: {found:?}, not {expected}: {error:e}"
    );
}

#[test]
fn pixels_of_many_squares() {
    for degrees in [0.0, 90.0, 45.0, 3.0, 30.0, 71.3, 135.0, 200.0, 289.0] {
        for depth in [5.0, 20.0, 60.0, 120.0, 250.0, 500.0, 800.0, 1200.0, 1700.0] {
            let view = view(degrees, depth);
            agree(
                view.board().alone(&PIXEL),
                brute(view.forms(), &PIXEL),
                // A colour's share is half of the integral of signs plus a half, so the integral's
                // tolerance is twice that of a mean.
                2.0 * DEFAULT_TOLERANCE,
                view,
            );
        }
    }
}

/// In a very wide view, a pixel shows near squares far to the side. They form rows of hundreds of
/// squares, which the pixel's sides cut at all angles.
#[test]
fn wide_views() {
    for degrees in [0.0, 0.3, 2.0, 30.0, 45.0, 89.9, 90.0, 135.0, 200.0] {
        for (focal, across, depth) in [(0.5, 6.0, 30.0), (0.05, 2.0, 9.0), (0.02, 40.0, 0.6)] {
            let view = PixelView {
                height: 1.7,
                focal,
                degrees,
                place: DVec2::new(across, 0.5 + 1.7 * focal / depth),
                foot: DVec2::new(0.3, 0.45),
            };
            let found = view.board().alone(&PIXEL);
            // The expected value is computed with coordinates as large as the pixel's distance from
            // the centre of the horizon. Its rounding errors are proportional to this distance.
            let size = view.place.length();
            agree_in_size(found, brute(view.forms(), &PIXEL), size, 1e-10, view);
            assert!(found.bound < 1e-10, "{view:?}: {found:?}");
        }
    }
}

/// The squares are so small that an edge crosses a million lines. The boards are seen from above,
/// straight down or tilted. The integral over the pixel is compared with the sum over parts whose
/// edges cross fewer lines.
#[test]
fn a_million_lines() {
    for (turn, tilt) in [
        (0.0, 0.0),
        (0.3, 0.0),
        (0.25, 1e-9),
        (0.785, 1e-7),
        (0.7, 1e-3),
    ] {
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        let squares = 1.1e6;
        let a = [squares * cos, -squares * sin, 0.25 * squares];
        let b = [squares * sin, squares * cos, 0.15 * squares];
        let board = Homography::new([a, b], [tilt, 0.3 * tilt, 1.0]);
        let whole = board.alone(&PIXEL);
        let strips = 16;
        let mut pieces = BoundedSum::default();
        for i in 0..strips * strips {
            let low = DVec2::new(f64::from(i / strips), f64::from(i % strips)) / f64::from(strips);
            let square = PIXEL.map(|p| low + (p + 0.5) / f64::from(strips) - 0.5);
            pieces.add(board.alone(&square));
        }
        let error = (whole.value - pieces.value).abs();
        assert!(
            error <= whole.bound + pieces.bound,
            "{turn}: {whole:?} {pieces:?}"
        );
        assert!(whole.bound < 1e-9, "{turn} {tilt}: {whole:?}");
    }
}

#[test]
fn the_horizon() {
    for degrees in [
        0.0,
        90.0,
        44.9,
        45.0,
        41.7446,
        71.565_051_177,
        18.43,
        30.0,
        133.0,
        225.0,
    ] {
        for y in [0.0, 0.2, 0.5, 0.8] {
            let mut view = view(degrees, 1000.0);
            view.place = DVec2::new(0.5, y);
            let board = view.board();
            let found = board.alone(&PIXEL);
            // A colour's share is half of the integral of signs plus a half, so the integral's
            // bound may be twice that of a mean.
            assert!(found.bound < 1.8e-9, "{view:?}: {found:?}");
            // Five vertical slices make up the pixel. Their edges cross the lines of the board at
            // other points than the pixel's edges, so their integrals are independent computations.
            // Within the error bounds, the integrals must add up to the integral over the whole
            // pixel.
            let mut slices = BoundedSum::default();
            for i in 0..5 {
                let [low, high] = [i, i + 1].map(|i| f64::from(i) / 5.0 - 0.5);
                slices
                    .add(board.alone(
                        &PIXEL.map(|p| DVec2::new(if p.x < 0.0 { low } else { high }, p.y)),
                    ));
            }
            let error = (found.value - slices.value).abs();
            assert!(
                error <= found.bound + slices.bound,
                "{view:?}: {found:?} {slices:?} {error:e}"
            );
        }
    }
}

/// The pixel lies on the horizon, and a line divides it into an upper and a lower part. The
/// integral over the pixel minus the integral over the upper part must equal the sum over the
/// squares of the lower part.
#[test]
fn the_end_is_the_limit() {
    for degrees in [0.0, 45.0, 30.0, 71.565_051_177, 44.999] {
        let mut view = view(degrees, 1000.0);
        view.place = DVec2::new(0.5, 0.5);
        let board = view.board();
        let line = -0.5 + 2464.0 / 5000.0;
        let [a, b, c, d] = PIXEL;
        let upper = board.alone(&[a, b, DVec2::new(0.5, line), DVec2::new(-0.5, line)]);
        let lower = [DVec2::new(-0.5, line), DVec2::new(0.5, line), c, d];
        let expected = brute(view.forms(), &lower);
        let all = board.alone(&PIXEL);
        let difference = BoundedSum {
            value: all.value - upper.value,
            bound: all.bound + upper.bound,
        };
        agree(difference, expected, 1e-9, view);
    }
}

/// Integrates the board's sign over `polygon` in the limit of a view of 180 degrees, where a pixel
/// far to the side shows only one straight line of the floor. Integrates up to the distance `most`
/// along the line. Returns the integral, and the area of the part of the polygon that shows greater
/// distances.
fn brute_limit(view: &PixelView, polygon: &[DVec2], most: f64) -> (f64, f64) {
    // The point (x, y) of the picture, relative to the middle of the horizon, shows the point of
    // the line at the distance q = height·x/y from the foot. The board's two coordinates are linear
    // in q. The polygon is cut at each q at which one of them is an integer, because the colour of
    // the board changes there.
    let angle = view.degrees.to_radians();
    let factors = [-libm::sin(angle), libm::cos(angle)];
    let q = |p: DVec2| view.height * (p.x + view.place.x) / (p.y + view.place.y);
    let places = polygon.iter().map(|&p| q(p)).filter(|q| q.is_finite());
    let low = places.clone().fold(f64::INFINITY, f64::min);
    let high = places.fold(f64::NEG_INFINITY, f64::max).min(most);
    let foot = [view.foot.x, view.foot.y];
    let mut cuts = vec![low, high];
    for (factor, foot) in factors.into_iter().zip(foot) {
        let ends = [low, high].map(|q| factor * q + foot);
        let mut i = ends[0].min(ends[1]).ceil();
        while i < ends[0].max(ends[1]) {
            cuts.push((i - foot) / factor);
            i += 1.0;
        }
    }
    cuts.sort_by(f64::total_cmp);
    let before = |cut: f64| {
        let side = |p: DVec2| cut * (p.y + view.place.y) - view.height * (p.x + view.place.x);
        area(&clip(polygon, side)).abs()
    };
    let (mut sum, mut area_before) = (0.0, before(low));
    for pair in cuts.windows(2) {
        let middle = 0.5 * (pair[0] + pair[1]);
        let [a, b] = [0, 1].map(|i| (factors[i] * middle + foot[i]).floor());
        let area = before(pair[1]);
        let sign = if (a + b) % 2.0 == 0.0 { 1.0 } else { -1.0 };
        sum += sign * (area - area_before);
        area_before = area;
    }
    (sum, area(polygon).abs() - area_before)
}

fn widest(focal: f64, degrees: f64) -> PixelView {
    PixelView {
        height: 1.7,
        focal,
        degrees,
        place: DVec2::new(21.3, 0.0),
        foot: DVec2::new(0.31, -0.77),
    }
}

/// In the widest views, the board's coordinates a and b are nearly proportional. A pixel shows a
/// strip of very many squares. The strip is so narrow that rounding errors displace it noticeably.
/// Some polygons reach the horizon, others stay below it.
#[test]
fn the_widest_views() {
    for degrees in [30.0, 71.565_051_177, 135.0, 224.9] {
        for focal in [1e-7, 1e-10, 1e-16, 1e-300] {
            for (y, low, most) in [(0.5, 5e-4, f64::INFINITY), (0.2, 0.0, 5e4)] {
                let mut view = widest(focal, degrees);
                view.place.y = y;
                let polygon = clip(&PIXEL, |p| p.y + y - low);
                let found = view.board().alone(&polygon);
                let (expected, left) = brute_limit(&view, &polygon, most);
                let error = (found.value - expected).abs();
                // `brute_limit` is exact only for a focal length of 0. A greater focal length
                // displaces lines, so the assertion tolerates an error proportional to it.
                assert!(
                    error <= found.bound + left + 1e-11 + 1e3 * focal,
                    "{degrees} {focal:e} {y}: {found:?}, not {expected} to {left:e}: {error:e}"
                );
            }
        }
    }
}

proptest! {
    // Each case takes 20 ms, so only a quarter of the usual number of cases is run.
    #![proptest_config(ProptestConfig { cases: ProptestConfig::default().cases / 4, ..ProptestConfig::default() })]

    #[test]
    fn pieces_add_up(degrees in 0.0..360.0, depth in 2.0_f64..40_000.0, s in -0.45..0.45, t in -0.45..0.45, w in 0.2..3.0, bend in 0.0..0.4) {
        let view = view(degrees, depth);
        let board = view.board();
        let whole = board.alone(&PIXEL);
        let arc = Arc { start: DVec2::new(s, -0.5), control: DVec2::new(0.5 * (s + t) + bend, 0.1 * bend), end: DVec2::new(t, 0.5), weight: w };
        let [a, b, c, d] = PIXEL;
        let left = board.alone(&[a, arc.start, arc.end, d]);
        let right = board.alone(&[arc.start, b, c, arc.end]);
        let pieces = left.value + right.value;
        let bound = whole.bound + left.bound + right.bound;
        prop_assert!((pieces - whole.value).abs() <= bound, "{} {} {bound}", whole.value, pieces);
        // The integral over the region between the arc and its chord is compared with the integral
        // over a polygon with 100 chords of the arc as sides.
        let segment = board.over_segment(&arc, &budget());
        let points: Vec<DVec2> = (0..=100).map(|i| arc.at(f64::from(i) / 100.0)).collect();
        let chords = board.alone(&points);
        let neglected: f64 = (0..100).map(|i| arc.between(f64::from(i) / 100.0, f64::from(i + 1) / 100.0).area()).sum();
        prop_assert!((segment.value - chords.value).abs() <= segment.bound + chords.bound + neglected, "{segment:?} {chords:?} {neglected}");
    }

}

proptest! {
    #[test]
    fn any_projection(m in prop::array::uniform6(-3.0..3.0), centre in prop::array::uniform2(-50.0..50.0), tilt in prop::array::uniform2(-0.9..0.9), scale in 0.1..100.0) {
        let below = [tilt[0], tilt[1], 1.0].map(|c| c / scale);
        let a = [m[0], m[1], m[2] + centre[0] * below[2]];
        let b = [m[3], m[4], m[5] + centre[1] * below[2]];
        let matrix = DMat3::from_cols_array_2d(&[a, b, below]);
        prop_assume!(matrix.determinant().abs() > 1e-3);
        let found = Homography::new([a, b], below).alone(&PIXEL);
        let expected = brute([a, b, below], &PIXEL);
        // `brute` maps the corners of squares to the picture by the inverse matrix. The accuracy of
        // `expected` therefore depends on the condition number of the matrix.
        let size = |matrix: DMat3| matrix.to_cols_array().map(f64::abs).iter().sum::<f64>();
        let roundings = 4.0 * f64::EPSILON * size(matrix) * size(matrix.inverse());
        prop_assert!((found.value - expected).abs() <= found.bound + roundings, "{found:?} {expected}");
    }
}

#[test]
fn from_straight_above() {
    // The side of a square is about 1/1000 pixel: each side of the pixel is 1000.5 squares long.
    let board = Homography::new(
        [[1000.5, 0.0, 500.25], [0.0, 1000.5, 500.25]],
        [0.0, 0.0, 1.0],
    );
    agree(
        board.alone(&PIXEL),
        0.25 / (1000.5 * 1000.5),
        1e-14,
        "above",
    );
}

/// If the budget is too small or the computation is cancelled, the integral is 0 and its bound is
/// the whole area.
#[test]
fn nothing_is_computed_beyond_the_budget() {
    let below = [0.0, 0.0, 1.0];
    let board = Homography::new([[31.0, 2.0, 0.3], [3.0, 29.0, 0.2]], below);
    let all = board.alone(&PIXEL);
    let cancelled = AtomicBool::new(true);
    let nothing = board.over(&PIXEL, &PixelBudget::new(DEFAULT_TOLERANCE, &cancelled));
    assert!(all.value != 0.0 && nothing.value == 0.0);
    assert!(nothing.bound > all.value.abs(), "{nothing:?} of {all:?}");
    // The pixel shows a row of a billion near squares, more than the budget affords.
    let board = Homography::new([[1e9, 1.0, 0.3], [0.0, 1e-9, 0.2]], [0.0, 2.1, 1.1]);
    assert_eq!(board.alone(&PIXEL).value, 0.0);
}
