//! Compares pixels of exact pictures of a checkerboard with rational arithmetic, which has no
//! rounding errors.

use std::{array, iter::successors};

use dashu_int::IBig;
use dashu_ratio::RBig;

use super::{exact, pixel, read};

/// A camera with rational axes, above a checkerboard at height 0 whose squares have side 1.
struct RationalView {
    eye: [RBig; 3],
    /// Unit axes of the camera: right, up, and back, i.e. against the view direction.
    axes: [[RBig; 3]; 3],
    d: RBig,
}

/// A linear form a·X + b·Y + c, stored as `[a, b, c]`. The point (X, Y) is in the view plane.
type Linear = [RBig; 3];
type Polygon = Vec<[RBig; 2]>;

impl RationalView {
    /// Returns one component of the ray through the point (X, Y) of the view plane, as a linear
    /// form of X and Y. `axis` is the index of the component.
    fn ray(&self, axis: usize) -> Linear {
        let [right, top, back] = [0, 1, 2].map(|of| self.axes[of][axis].clone());
        [right, top, -(back * &self.d)]
    }

    /// Returns two linear forms N and L such that the ray through a point of the view plane hits
    /// the board at the coordinate N/L. `axis` is the index of the coordinate: 0 for x, or 2 for z.
    /// L is positive below the horizon.
    fn place(&self, axis: usize) -> [Linear; 2] {
        let below = self.ray(1).map(|factor| -factor);
        let along = self.ray(axis);
        let place = array::from_fn(|i| &self.eye[1] * &along[i] + &self.eye[axis] * &below[i]);
        [place, below]
    }

    /// Returns the white fraction of a pixel below the horizon. A square of the board is white if
    /// the sum of its two indices is even.
    fn white(&self, pixel: &Polygon) -> RBig {
        let [across, along] = [self.place(0), self.place(2)];
        let mut white = RBig::ZERO;
        for row in square_indices(&along, pixel) {
            let in_row = strip(&along, &row, pixel);
            if in_row.is_empty() {
                continue;
            }
            for column in square_indices(&across, &in_row) {
                if (&row + &column) % IBig::from(2) == IBig::ZERO {
                    white += area(&strip(&across, &column, &in_row));
                }
            }
        }
        white / area(pixel)
    }
}

fn value([a, b, c]: &Linear, [x, y]: &[RBig; 2]) -> RBig {
    a * x + b * y + c
}

/// Returns the indices of the board's rows, or columns, that overlap a polygon in the view plane. A
/// row or column is a strip of squares.
fn square_indices([place, below]: &[Linear; 2], polygon: &Polygon) -> Vec<IBig> {
    let places = polygon
        .iter()
        .map(|at| (value(place, at) / value(below, at)).floor());
    let places: Vec<_> = places.collect();
    let (first, last) = (places.iter().min().unwrap(), places.iter().max().unwrap());
    successors(Some(first.clone()), |n| (n < last).then(|| n + IBig::ONE)).collect()
}

/// Returns the part of a polygon of the view plane that shows the row or column `n` of the board's
/// squares. In this part, the coordinate on the board, the quotient `place` / `below`, is between
/// `n` and `n + 1`.
fn strip([place, below]: &[Linear; 2], n: &IBig, polygon: &Polygon) -> Polygon {
    let line = |n: IBig| -> Linear {
        let n = RBig::from(n);
        array::from_fn(|i| &place[i] - &n * &below[i])
    };
    let beyond = line(n + IBig::ONE).map(|factor| -factor);
    cut(&cut(polygon, &line(n.clone())), &beyond)
}

/// Returns the part of `polygon` in which the linear form `line` is not negative. Uses the
/// algorithm of Sutherland and Hodgman (1974).
fn cut(polygon: &Polygon, line: &Linear) -> Polygon {
    let mut rest = Vec::new();
    for (i, to) in polygon.iter().enumerate() {
        let from = &polygon[(i + polygon.len() - 1) % polygon.len()];
        let [before, here] = [from, to].map(|at| value(line, at));
        if (before < RBig::ZERO) != (here < RBig::ZERO) {
            let t = &before / (&before - &here);
            rest.push(array::from_fn(|axis| {
                &from[axis] + (&to[axis] - &from[axis]) * &t
            }));
        }
        if here >= RBig::ZERO {
            rest.push(to.clone());
        }
    }
    rest
}

fn area(polygon: &Polygon) -> RBig {
    let mut twice = RBig::ZERO;
    for (i, [x, y]) in polygon.iter().enumerate() {
        let [next_x, next_y] = &polygon[(i + 1) % polygon.len()];
        twice += x * next_y - next_x * y;
    }
    let twice = if twice < RBig::ZERO { -twice } else { twice };
    twice / RBig::from(2)
}

/// Some cameras are level and unrolled. Others look down to the right, along (48, −25, −36)/65, and
/// are unrolled or rolled by the angle whose cosine is 3/5. All compared pixels are below the
/// horizon.
#[test]
fn board_pixels_agree_with_rational_arithmetic() {
    let (width, height) = (64u32, 48u32);
    let rational = |x: f64| RBig::try_from(x).unwrap();
    let over = |vector: [i32; 3], by: i32| vector.map(|x| RBig::from(x) / RBig::from(by));
    let level = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|axis| over(axis, 1));
    let back = over([-48, 25, 36], 65);
    let aslant = [over([3, 0, 4], 5), over([4, 12, -3], 13), back.clone()];
    let mixed = |a: i32, b: i32| -> [RBig; 3] {
        let [a, b] = [a, b].map(|x| RBig::from(x) / RBig::from(5));
        array::from_fn(|i| &aslant[0][i] * &a + &aslant[1][i] * &b)
    };
    let rolled = [mixed(3, 4), mixed(-4, 3), back];
    let far_down = "3,25 33,25 63,26 40,28 31,30 20,40 0,47";
    let anywhere = "32,24 3,40 60,20 31,47 63,47 20,18 40,30";
    let ahead = ("(0, 0, -1)", "(0, 1, 0)");
    let down = ("(48, -25, -36)", "(0, 1, 0)");
    let turned = ("(48, -25, -36)", "(-96, 180, -253)");
    for (axes, (direction, up), [ex, h, ez], d, pixels) in [
        (&level, ahead, [0.3, 1.75, 0.6], 1.5, far_down),
        (&level, ahead, [-7.1, 0.2, 1e6 + 0.1], 2.0, far_down),
        (&level, ahead, [0.0, 30.0, 0.0], 1.0, far_down),
        (&aslant, down, [0.3, 1.75, 0.6], 3.0, anywhere),
        (&aslant, down, [1e6 + 0.1, 9.3, -0.7], 4.0, anywhere),
        (&rolled, turned, [0.3, 1.75, 0.6], 3.0, anywhere),
        (&rolled, turned, [-3.3, 11.0, 1e5], 5.0, anywhere),
    ] {
        let scene = read(&format!(
            "image {{ width {width} height {height} }} camera {{ eye ({ex}, {h}, {ez}) direction {direction} up {up} d {d} }} \
             checkerboard {{ colors (white, black) }}"
        ));
        let exact = exact(&scene);
        let view = RationalView {
            eye: [ex, h, ez].map(rational),
            axes: axes.clone(),
            d: rational(d),
        };
        // Side of a pixel in the view plane: the height of the view plane's window is 2 by default.
        let pitch = RBig::from(2) / RBig::from(height);
        let [left, top] = [width, height].map(|size| RBig::from(size) / RBig::from(2));
        for at in pixels.split(' ') {
            let (x, y) = at.split_once(',').unwrap();
            let [x, y]: [u32; 2] = [x, y].map(|at| at.parse().unwrap());
            let corner = |right: u32, down: u32| {
                [
                    (RBig::from(x + right) - &left) * &pitch,
                    (&top - RBig::from(y + down)) * &pitch,
                ]
            };
            let corners = vec![corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let ([found, ..], bound) = pixel(&exact, x, y);
            let off = rational(found) - view.white(&corners);
            let difference = off.to_f64().value().abs();
            let limit = bound + 2.0 * f64::EPSILON;
            assert!(
                bound <= 1e-9 && difference <= limit,
                "{x}, {y}: {difference:e} of {bound:e}"
            );
        }
    }
}
