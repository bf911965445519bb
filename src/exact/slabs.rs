//! Pixels with conics: cut into slabs in which the curves are graphs that do not cross, one above
//! the other.
//!
//! In: the lines and conics that pass through a sub-pixel. Out: the regions between neighbouring
//! branches in each slab, which are told to [`Regions`].
//!
//! Nothing relies on finding every crossing. Each curve lies between its chord and its tangents; if
//! by that two neighbours might cross within a slab, the slab is cut, where they cross if that can
//! be seen, else in the middle. What cannot be told apart when slabs have become too narrow is
//! added to the bound as doubtful area.

use std::{cmp::Ordering, collections::BinaryHeap};

use glam::DVec2;

use crate::{math::Real, tracer::Boundary};

use super::{
    branches::{Graph, Section, Track},
    by_key::ByKey,
    conic_segment::Arc,
    region::{Region, Regions, Shares},
};

/// Curves may be out of order by so much: two y of at most 1, good to eight roundings each.
const TIE: f64 = 16.0 * f64::UNIT;

/// Curves that are nowhere farther apart than this, in pixels, are not told apart: a thousand
/// roundings of a coordinate, and 10⁻¹³ of area.
const CLOSE: f64 = 1.0 / (1u64 << 43) as f64;

/// Slabs narrower than this, in pixels, are not cut, nor any once `MANY` have been added to the
/// first ones, counting those still queued: what is left in doubt then is in the bound. (Measured:
/// a quarter and four times as much of either change bounds by a fiftieth and times by about a
/// tenth at most.)
const NARROW: f64 = 1.0 / (1u64 << 48) as f64;
const MANY: usize = 4096;

/// Steps of the false position: halving alone gets from a pixel to a rounding in 53.
const STEPS: usize = 60;

/// What rounding may do to the area of a region in a slab, for each part of its width: two y of at
/// most 1/2, good to eight roundings each, and as much for products and sums.
const ROUNDING: f64 = 16.0 * f64::UNIT;

/// The shares of a pixel that is cut by some curves.
pub fn shares(curves: &[Boundary], mut regions: Regions) -> Shares {
    let (mut lines, mut graphs) = (Vec::new(), Vec::new());
    let mut cuts = vec![-0.5, 0.5];
    for curve in curves {
        match curve {
            Boundary::Line(line) => {
                // As in `arrangement`, but that here it is y that is rounded, which `ROUNDING`
                // counts.
                regions.doubt(3.0 * line.rad);
                match Track::of_line(line) {
                    Some(track) => lines.push(track),
                    None => {
                        let [a, b, c] = line.factors;
                        // Else it is too far away, or no line at all.
                        if b.abs() < a.abs() {
                            regions.doubt((b / a).abs());
                            cuts.push(-c / a);
                        }
                    }
                }
            }
            Boundary::Conic(conic) => {
                regions.doubt(conic.doubtful_area());
                let graph = Graph::new(conic);
                cuts.extend(graph.ends());
                graphs.push(graph);
            }
        }
    }
    cuts.retain(|x| x.abs() <= 0.5);
    cuts.sort_unstable_by(f64::total_cmp);
    cuts.dedup();
    // As many slabs as may be added leave no more in doubt together than what is asked for, if each
    // leaves one pair.
    let crumb = regions.tolerance() / MANY as f64;
    let mut all = Slabs {
        lines,
        graphs,
        regions,
        slabs: 0,
        crumb,
    };
    // The widest first: where there are too many, narrow ones are left.
    let many = MANY + cuts.len();
    let slab = |left: f64, right: f64| ByKey(right - left, [left, right]);
    let mut slabs: BinaryHeap<_> = cuts.windows(2).map(|pair| slab(pair[0], pair[1])).collect();
    while let Some(ByKey(_, [left, right])) = slabs.pop() {
        if all.regions.is_given_up() {
            break;
        }
        if let Some(at) = all.slab(left, right, many.saturating_sub(slabs.len())) {
            slabs.extend([slab(left, at), slab(at, right)]);
        }
    }
    all.regions.finish()
}

struct Slabs<'a> {
    lines: Vec<Track<'a>>,
    graphs: Vec<Graph>,
    regions: Regions<'a>,
    slabs: usize,
    /// So much area, in square pixels, may be doubtful between two neighbours before their slab is
    /// cut.
    crumb: f64,
}

impl Slabs<'_> {
    /// Adds a slab's regions, or returns where to cut it. A slab that is too narrow, or beyond the
    /// limit, is never cut.
    fn slab(&mut self, left: f64, right: f64, may_be: usize) -> Option<f64> {
        let (middle, width) = (0.5 * (left + right), right - left);
        let is_last = width < NARROW || self.slabs >= may_be;
        let mut doubtful = 0.0;
        let mut sections: Vec<(Track, Section)> =
            Vec::with_capacity(self.lines.len() + self.graphs.len());
        let lines = self.lines.iter();
        sections.extend(lines.map(|line| (*line, line.straight(left, right))));
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
        // The pixel's sides in order with what lies outside of them, and neighbours inside with
        // each other.
        let [bottom, top] = [-0.5, 0.5].map(|y| (Track::Level(y), Section::level(y)));
        let below = sections[..first].iter().map(|below| (below, &bottom));
        let above = sections[end..].iter().map(|above| (&top, above));
        let mut inside = vec![&bottom];
        inside.extend(&sections[first..end]);
        inside.push(&top);
        let neighbors = inside.windows(2).map(|pair| (pair[0], pair[1]));
        for ((lower, a), (upper, b)) in below.chain(neighbors).chain(above) {
            let overlap = a.overlap(b, left, right).clamp(0.0, 1.0);
            if overlap <= TIE || overlap * width <= self.crumb {
                doubtful += overlap * width;
                continue;
            }
            let distance = a.distance(b);
            if distance <= CLOSE || is_last {
                doubtful += overlap.min(distance) * width;
                continue;
            }
            return Some(crossing(lower, upper, a, b, left, right));
        }
        self.slabs += 1;
        self.regions.doubt(doubtful);
        for pair in inside.windows(2) {
            add(&mut self.regions, &pair[0].1, &pair[1].1, left, right);
        }
        None
    }
}

/// Adds the region between two neighbours.
fn add(regions: &mut Regions, lower: &Section, upper: &Section, left: f64, right: f64) {
    // What is steep may leave the pixel in a slab that is cut no more.
    let area = (upper.integral(left, right) - lower.integral(left, right)).min(right - left);
    regions.doubt((right - left) * (ROUNDING + lower.slack + upper.slack));
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
    if upper.y[1] - lower.y[1] <= TIE {
        regions.doubt(area);
    }
    regions.add(&Region {
        polygon: &polygon,
        arcs: &arcs,
        area,
        inside,
    });
}

/// Where to cut a slab in which two tracks may cross: at their crossing, if the order at one end is
/// not that in the middle.
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
    // The Illinois variant of the false position: an end that stays twice has its value halved.
    for _ in 0..STEPS {
        let mut at = inside - gap_in * (inside - out) / (gap_in - gap_out);
        if !((at > out.min(inside)) && (at < out.max(inside))) {
            at = 0.5 * (out + inside);
        }
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
    // Nearer to an end nothing would be gained.
    if inside > left + 0.5 * NARROW && inside < right - 0.5 * NARROW {
        inside
    } else {
        middle
    }
}
