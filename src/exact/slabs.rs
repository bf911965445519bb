//! Sub-pixels with conics are cut into slabs, vertical strips in which the curves do not cross.
//!
//! In: the lines and conics that pass through a sub-pixel. Out: the regions between neighbouring
//! curves in each slab, added to [`Regions`].
//!
//! Within a slab, each curve lies between its chord and its tangents. If two neighbouring curves
//! may cross according to these bounds, the slab is cut. If the order of the curves at one end of
//! the slab differs from that in the middle, the cut is at their crossing. Otherwise, it is in the
//! middle of the slab. Not every crossing has to be found: if a slab is too narrow to cut, the area
//! between its unseparated curves is added to the error bound.

use std::{cmp::Ordering, collections::BinaryHeap};

use glam::DVec2;

use crate::{math::Real, tracer::Boundary};

use super::{
    branches::{ConicGraph, Section, Track},
    by_key::ByKey,
    conic_segment::Arc,
    region::{Region, Regions, Shares},
};

/// Maximum distance in y, in pixels, by which a curve may lie on the wrong side of its neighbour
/// without the slab being cut. It is the maximum rounding error of the distance, which is the
/// difference of two values of at most 1, each with an error of at most eight unit roundoffs.
const ORDER_TOLERANCE: f64 = 16.0 * f64::UNIT;

/// Maximum distance in y, in pixels, between neighbouring curves that may cross in a slab (a
/// vertical strip) without the slab being cut. The area between the curves is added to the error
/// bound instead. The value is a thousand unit roundoffs, so the area is at most about 10⁻¹³ square
/// pixels.
const MIN_DISTANCE: f64 = 1.0 / (1u64 << 43) as f64;

/// Minimum width of a slab (a vertical strip) that is cut, in pixels. In a narrower slab, the area
/// between curves that may cross is added to the error bound. Not critical: with 2^−50 or 2^−46,
/// the measured bounds change by at most 2 % and the running time by at most about 10 %.
const MIN_WIDTH: f64 = 1.0 / (1u64 << 48) as f64;
/// Maximum number of slabs (vertical strips) of a sub-pixel, done or queued, in addition to the
/// initial ones. At this number, no slab is cut any more, and the area between curves that may
/// cross is added to the error bound. Not critical: with 1024 or 16,384, the measured bounds change
/// by at most 2 % and the running time by at most 10 %.
const MAX_ADDED_SLABS: usize = 4096;

/// Maximum number of steps of the false position method that searches where two curves cross. The
/// estimate of the last step is used. Bisection would need 53 steps to narrow an interval from a
/// pixel's side to the unit roundoff; the value is a little more.
const MAX_STEPS: usize = 60;

/// Maximum rounding error of the area of a region in a slab, divided by the slab's width. The two
/// values of y are at most 1/2, and each has a relative error of eight unit roundoffs; together
/// they contribute eight unit roundoffs. Products and sums contribute at most another eight.
const ROUNDING: f64 = 16.0 * f64::UNIT;

/// Returns the fraction of a sub-pixel's area that shows each colour. `curves` cut the sub-pixel
/// into regions, and `regions` collects these.
pub fn shares(curves: &[Boundary], mut regions: Regions) -> Shares {
    let (mut lines, mut graphs) = (Vec::new(), Vec::new());
    let mut cuts = vec![-0.5, 0.5];
    for curve in curves {
        match curve {
            Boundary::Line(line) => {
                // The line is at most √2 long in the pixel. It is displaced by at most
                // 2·`line.rad`, because the larger of its factors of x and y is at least 1/2. The
                // doubtful area is at most the product, and 2·√2 < 3. `ROUNDING` covers the
                // rounding errors of areas.
                regions.add_doubtful_area(3.0 * line.rad);
                match Track::of_line(line) {
                    Some(track) => lines.push(track),
                    None => {
                        let [a, b, c] = line.factors;
                        // The line ax + by + c = 0 has no usable function y(x). If |b| < |a|, it is
                        // vertical or very steep, and the sub-pixel is cut at x = −c/a. Otherwise,
                        // the line is too far away or degenerate, and is ignored.
                        if b.abs() < a.abs() {
                            regions.add_doubtful_area((b / a).abs());
                            cuts.push(-c / a);
                        }
                    }
                }
            }
            Boundary::Conic(conic) => {
                regions.add_doubtful_area(conic.doubtful_area());
                let graph = ConicGraph::new(conic);
                cuts.extend(graph.ends());
                graphs.push(graph);
            }
        }
    }
    cuts.retain(|x| x.abs() <= 0.5);
    cuts.sort_unstable_by(f64::total_cmp);
    cuts.dedup();
    // Maximum area by which two neighbouring curves of a slab may overlap without the slab being
    // cut. If one pair of curves overlaps by this area in each of `MAX_ADDED_SLABS` slabs, the
    // areas add up to the pixel's tolerance.
    let doubtful_limit = regions.budget.tolerance / MAX_ADDED_SLABS as f64;
    let mut all = Slabs {
        lines,
        graphs,
        regions,
        slabs: 0,
        doubtful_limit,
    };
    // The widest slab is cut first, so that only narrow slabs are left uncut if the number of slabs
    // reaches its limit.
    let max_slabs = MAX_ADDED_SLABS + cuts.len();
    let slab = |left: f64, right: f64| ByKey(right - left, [left, right]);
    let mut slabs: BinaryHeap<_> = cuts.windows(2).map(|pair| slab(pair[0], pair[1])).collect();
    while let Some(ByKey(_, [left, right])) = slabs.pop() {
        if all.regions.budget.is_spent() {
            break;
        }
        if let Some(at) = all.slab(left, right, max_slabs.saturating_sub(slabs.len())) {
            slabs.extend([slab(left, at), slab(at, right)]);
        }
    }
    all.regions.finish()
}

struct Slabs<'a> {
    lines: Vec<Track<'a>>,
    graphs: Vec<ConicGraph>,
    regions: Regions<'a>,
    slabs: usize,
    /// Maximum area, in square pixels, by which the lower of two neighbouring curves may rise above
    /// the upper one in a slab that is not cut. The area is added to the error bound.
    doubtful_limit: f64,
}

impl Slabs<'_> {
    /// Adds the regions of the slab from `left` to `right` and returns `None`. If curves in the
    /// slab may cross, adds nothing and returns the x at which to cut the slab. If the slab is too
    /// narrow or there are already `max_slabs` slabs, it is not cut: the area between curves that
    /// may cross is added to the error bound.
    fn slab(&mut self, left: f64, right: f64, max_slabs: usize) -> Option<f64> {
        let (middle, width) = (0.5 * (left + right), right - left);
        let is_last = width < MIN_WIDTH || self.slabs >= max_slabs;
        let mut doubtful = 0.0;
        let mut sections: Vec<(Track, Section)> =
            Vec::with_capacity(self.lines.len() + self.graphs.len());
        for line in &self.lines {
            sections.push((*line, line.straight(left, right)));
        }
        for graph in &self.graphs {
            let Some(span) = graph.span(left, right) else {
                continue;
            };
            for (track, section) in [-1.0, 1.0].into_iter().filter_map(|side| span.branch(side)) {
                match section {
                    Some(section) => sections.push((track, section)),
                    None if is_last => doubtful += width.min(1.0),
                    None => return Some(middle),
                }
            }
        }
        sections.sort_by(|(_, a), (_, b)| a.y[1].total_cmp(&b.y[1]));
        let place = |y: f64| sections.partition_point(|(_, section)| section.y[1] < y);
        let (first, end) = (place(-0.5), place(0.5));
        // Curves below the pixel are compared with its lower side and curves above it with its
        // upper side; curves inside it are compared with their neighbours.
        let [bottom, top] = [-0.5, 0.5].map(|y| (Track::Level(y), Section::straight([y; 3])));
        let below = sections[..first].iter().map(|below| (below, &bottom));
        let above = sections[end..].iter().map(|above| (&top, above));
        let mut inside = vec![&bottom];
        inside.extend(&sections[first..end]);
        inside.push(&top);
        let neighbors = inside.windows(2).map(|pair| (pair[0], pair[1]));
        for ((lower, a), (upper, b)) in below.chain(neighbors).chain(above) {
            let overlap = a.overlap(b, left, right).clamp(0.0, 1.0);
            if overlap <= ORDER_TOLERANCE || overlap * width <= self.doubtful_limit {
                doubtful += overlap * width;
                continue;
            }
            let distance = a.distance(b);
            if distance <= MIN_DISTANCE || is_last {
                doubtful += overlap.min(distance) * width;
                continue;
            }
            return Some(crossing(lower, upper, a, b, left, right));
        }
        self.slabs += 1;
        self.regions.add_doubtful_area(doubtful);
        for pair in inside.windows(2) {
            add(&mut self.regions, &pair[0].1, &pair[1].1, left, right);
        }
        None
    }
}

/// Adds the region between the neighbours `lower` and `upper` from `left` to `right`, and the error
/// of its area.
fn add(regions: &mut Regions, lower: &Section, upper: &Section, left: f64, right: f64) {
    // In a slab that is too narrow to cut, a steep curve may leave the pixel. The region's area is
    // therefore limited to that of the slab.
    let area = (upper.integral(left, right) - lower.integral(left, right)).min(right - left);
    regions.add_doubtful_area((right - left) * (ROUNDING + lower.error + upper.error));
    if area <= 0.0 {
        return;
    }
    let polygon = [
        DVec2::new(left, lower.y[0]),
        DVec2::new(right, lower.y[2]),
        DVec2::new(right, upper.y[2]),
        DVec2::new(left, upper.y[0]),
    ];
    let mut arcs: Vec<(f64, Arc)> = Vec::with_capacity(2);
    arcs.extend(upper.arc);
    arcs.extend(lower.arc.map(|(bulge, arc)| (-bulge, arc)));
    let middle = 0.5 * (left + right);
    let inside = DVec2::new(middle, 0.5 * (lower.y[1] + upper.y[1]));
    if upper.y[1] - lower.y[1] <= ORDER_TOLERANCE {
        regions.add_doubtful_area(area);
    }
    regions.add(&Region {
        polygon: &polygon,
        arcs: &arcs,
        area,
        inside,
    });
}

/// Returns the x at which to cut a slab (a vertical strip) in which two curves may cross. This is
/// the x of their crossing if their order at one end of the slab differs from the order in the
/// middle; otherwise, it is the middle.
fn crossing(lower: &Track, upper: &Track, a: &Section, b: &Section, left: f64, right: f64) -> f64 {
    let middle = 0.5 * (left + right);
    let gap = |x: f64| upper.y(x) - lower.y(x);
    let [gap_left, gap_middle, gap_right] = [0, 1, 2].map(|i| b.y[i] - a.y[i]);
    let (mut out, mut gap_out) = if gap_left < 0.0 {
        (left, gap_left)
    } else if gap_right < 0.0 {
        (right, gap_right)
    } else {
        return middle;
    };
    let (mut inside, mut gap_in) = (middle, gap_middle);
    let mut last = Ordering::Equal;
    // The crossing is searched by the Illinois variant of false position: if the same end of the
    // interval is kept twice, the stored gap at that end is halved. Since gap_out < 0 ≤ gap_in, the
    // estimate does not leave the interval. If rounding puts the estimate at an end, the halving
    // moves the next estimate away from it.
    for _ in 0..MAX_STEPS {
        let at = inside - gap_in * (inside - out) / (gap_in - gap_out);
        let gap_at = gap(at);
        if gap_at.abs() <= f64::UNIT || (inside - out).abs() <= f64::UNIT {
            inside = at;
            break;
        }
        if gap_at > 0.0 {
            (inside, gap_in) = (at, gap_at);
            if last.is_gt() {
                gap_out *= 0.5;
            }
            last = Ordering::Greater;
        } else {
            (out, gap_out) = (at, gap_at);
            if last.is_lt() {
                gap_in *= 0.5;
            }
            last = Ordering::Less;
        }
    }
    // If the crossing is closer to an end than half the minimum width, a cut there would leave a
    // slab that is too narrow. The slab is then cut in the middle.
    if inside > left + 0.5 * MIN_WIDTH && inside < right - 0.5 * MIN_WIDTH {
        inside
    } else {
        middle
    }
}
