//! `scatter`: points that are uniform over the whole picture, computed for each pixel alone.
//!
//! If n points are uniform in a rectangle, the number of points in one half is binomial. Given this
//! number, the two halves are independent. The picture is therefore divided into a fixed binary
//! tree of rectangles of pixels. At each node, one binomial draw divides the number of points
//! between the two children. This gives the numbers of points in all pixels their multinomial
//! distribution.
//!
//! The longer side of a rectangle is cut at the greatest power of two below its length. If both
//! sides are equal, the width is cut. Nearly all cuts therefore produce equal halves, for which a
//! binomial draw only counts random bits. Within its pixel, a point is uniform.

use super::{binomial, rng::Key};
use crate::area::Area;

/// A node of a binary tree: a rectangle of pixels, and the number of sample points in it.
#[derive(Clone, Copy)]
struct Node {
    /// Binary number that identifies the node by its path from the root of the tree: a leading 1,
    /// then for each cut the index of the half, 0 or 1.
    path: u64,
    area: Area,
    points: u64,
}

/// Draws how many of `total` points, uniform over `picture`, fall into each pixel of `part`.
/// Returns these numbers row by row.
pub fn counts(key: Key, total: u64, picture: Area, part: Area) -> Vec<u64> {
    let mut counts = vec![0; part.pixels() as usize];
    let root = Node {
        path: 1,
        area: picture,
        points: total,
    };
    fall(key, root, part, &mut counts);
    counts
}

fn fall(key: Key, node: Node, part: Area, counts: &mut [u64]) {
    if node.points == 0 || !node.area.meets(part) {
        return;
    }
    if node.area.pixels() == 1 {
        counts[part.index(node.area.x, node.area.y)] = node.points;
        return;
    }
    for half in split(key, node) {
        fall(key, half, part, counts);
    }
}

fn split(key: Key, node: Node) -> [Node; 2] {
    let area = node.area;
    let mut halves = [area; 2];
    if area.width >= area.height {
        halves[0].width = area.width.next_power_of_two() / 2;
        halves[1].width -= halves[0].width;
        halves[1].x += halves[0].width;
    } else {
        halves[0].height = area.height.next_power_of_two() / 2;
        halves[1].height -= halves[0].height;
        halves[1].y += halves[0].height;
    }
    let fallen = binomial::draw(
        &mut key.part(node.path).rng(),
        node.points,
        halves[0].pixels(),
        area.pixels(),
    );
    [(0, fallen), (1, node.points - fallen)].map(|(half, points)| Node {
        path: 2 * node.path + half,
        area: halves[half as usize],
        points,
    })
}
