//! The board's integral against a sum over squares that shares nothing with it, against itself in pieces, and at the horizon.

use glam::DVec2;
use proptest::prelude::*;

use super::{Arc, Board, Sum};

const PIXEL: [DVec2; 4] = [
    DVec2::new(-0.5, -0.5),
    DVec2::new(0.5, -0.5),
    DVec2::new(0.5, 0.5),
    DVec2::new(-0.5, 0.5),
];

/// What a level camera sees: its height in squares, its focal length in pixels, where it looks in degrees, and the pixel's
/// place from the centre of the horizon, rightwards and downwards.
#[derive(Clone, Copy, Debug)]
struct View {
    height: f64,
    focal: f64,
    degrees: f64,
    place: DVec2,
    foot: DVec2,
}

impl View {
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

    fn board(&self) -> Board {
        let [a, b, below] = self.forms();
        Board::new([a, b], below)
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

/// Every square on its own: its corners brought to the picture, and what is left of it between the polygon's sides.
fn brute(forms: [[f64; 3]; 3], polygon: &[DVec2]) -> f64 {
    let m = glam::DMat3::from_cols_array_2d(&forms).transpose();
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
            let mut square: Vec<DVec2> = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
                .iter()
                .map(|&(x, y)| {
                    let p = inverse * glam::DVec3::new(i + x, j + y, 1.0);
                    DVec2::new(p.x, p.y) / p.z
                })
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

fn view(degrees: f64, depth: f64) -> View {
    View {
        height: 3.5,
        focal: 704.0,
        degrees,
        place: DVec2::new(40.0, 3.5 * 704.0 / depth),
        foot: DVec2::new(0.3, 0.45),
    }
}

fn agree(found: Sum, expected: f64, most: f64, what: impl std::fmt::Debug) {
    let error = (found.value - expected).abs();
    assert!(
        error <= found.bound && error <= most,
        "{what:?}: {found:?}, not {expected}: {error:e}"
    );
}

#[test]
fn pixels_of_many_squares() {
    for degrees in [0.0, 90.0, 45.0, 3.0, 30.0, 71.3, 135.0, 200.0, 289.0] {
        for depth in [5.0, 20.0, 60.0, 120.0, 250.0, 500.0, 800.0, 1200.0, 1700.0] {
            let view = view(degrees, depth);
            agree(
                view.board().over(&PIXEL),
                brute(view.forms(), &PIXEL),
                1e-12,
                view,
            );
        }
    }
}
