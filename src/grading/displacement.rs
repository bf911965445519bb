//! Whether what a picture shows lies elsewhere than it should: the test of what edges show.
//!
//! To first order, a picture that lies elsewhere differs by its slope times how far. A field of
//! displacements, affine as a wrong place, size, turn or camera makes it, is fitted to the pixels
//! of each object by least squares. Sampling noise has no such field: the sums that tell it have
//! variances that are known, and so the square of their length in these units, which has six
//! degrees of freedom, is no greater than it may be by chance.

use glam::DVec3;

use super::{
    candidate::Candidate, judge::Judge, levenberg_marquardt::solve, objects::labels,
    prediction::Prediction, strays::Strays, work,
};

/// Of so many pixels one may show something else than samples of a program that behaves otherwise,
/// or than a JPEG.
const MISSED: usize = 4000;

/// Distance from an edge, in pixels, within which what lies two pixels off, or is seen through
/// pixels up to five times as wide, shows another colour; and of so many pixels that do one may lie
/// farther from it, as the wider the pixels, the less there is to see of another colour.
const BESIDE: usize = 3;
/// The same in a JPEG, which is coded in blocks of this side.
const BLOCK: usize = 8;
const INSIDE: usize = 10;

/// Greatest square that is taken for chance: of normal sums one in 10^8 is greater.
const CHANCE: f64 = 50.0;

/// Greatest displacement of all edges, in pixels, that is taken for none: numbers that are rounded
/// make it.
const NONE: f64 = 0.06;

/// Pixels added to `NONE` for one sample in the middle of each pixel, and an nth of them for n
/// samples.
const NONE_OF_FEW: f64 = 0.06;

/// How far few samples lie off the middles of all pixels alike, for each share of a sample's
/// variance that an error has, and at most: the mean of the n points (i/n, φ₂(i)) lies 1/(2n) off,
/// and so many points make less noise than as many random ones.
const OFF_MIDDLE: f64 = 0.75;
const MOST_OFF_MIDDLE: f64 = 0.15;

/// Greatest displacement of a single object's edges that is taken for none, in pixels: without
/// noise, and how much more with one sample in a pixel of a plain picture, and of a JPEG, most of
/// whose noise is from its coding. Samples of a regular grid move an edge that is parallel to it by
/// up to half of their distance.
const NONE_OF_OBJECT: [f64; 3] = [0.12, 0.5, 0.7];

/// Least displacement of all edges of a JPEG that is never taken for none, in pixels, and least
/// square of its length: coding hides most of a displacement, and three samples at the same places
/// in all pixels lie less than this off the middle.
const MOVED: f64 = 0.2;
const SURELY_MOVED: f64 = 150.0;

const COUNT: usize = 6;

/// Standard deviations beyond which another width of pixels is no chance.
const SURE: f64 = 8.0;

/// Squares of widths that are taken for a pixel's own: at most `WIDE`, and at least 1 less
/// `NARROW`. `WIDER` and `NARROWER` times the share of a sample's variance that an error has are
/// added to these margins, as few samples at the same places in all pixels make a picture sharper,
/// or less sharp.
const WIDE: f64 = 1.4;
const WIDER: f64 = 3.0;
const NARROW: f64 = 0.25;
const NARROWER: f64 = 5.0;

/// Greatest square of a width that is taken for a pixel's own in a JPEG, whose coding makes edges
/// less sharp: 80 right ones of qualities from 75 to 100 have 4.7 at most, and one seen through
/// pixels three times as wide has 7.
const WIDE_IN_CODED: f64 = 5.5;

/// Least and greatest width that is told, in pixels.
const LEAST_WIDTH: f64 = 0.1;
const MOST_WIDTH: f64 = 6.0;

/// A displacement that is no chance.
#[derive(Clone, Copy, Debug)]
pub struct Displacement {
    /// How far edges are displaced, in pixels along their slope.
    pub far: f64,
    /// By how much the middle is, to the right and down.
    pub by: [f64; 2],
    /// The square that is not chance.
    square: f64,
}

/// The sums of a group of pixels.
#[derive(Clone)]
struct Sums {
    normal: Vec<Vec<f64>>,
    variance: Vec<Vec<f64>>,
    right: Vec<f64>,
}

impl Sums {
    /// The displacement, if it is no chance, less what samples that lie so far off make of it.
    fn displacement(&self, off_middle: f64) -> Option<Displacement> {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        // What no edge tells is taken for 0.
        let solved = |matrix: &[Vec<f64>]| {
            let mut matrix = matrix.to_vec();
            let most = (0..COUNT).map(|i| matrix[i][i]).fold(0.0, f64::max);
            (0..COUNT).for_each(|i| matrix[i][i] += 1e-3 * most + 1e-30);
            solve(matrix, self.right.clone())
        };
        let square = dot(&self.right, &solved(&self.variance)?);
        let mut fitted = solved(&self.normal)?;
        let by = [fitted[0], fitted[3]];
        for at in [0, 3] {
            fitted[at] -= fitted[at].clamp(-off_middle, off_middle);
        }
        let product = fitted.iter().zip(&self.normal);
        let product: f64 = product.map(|(x, row)| x * dot(&fitted, row)).sum();
        // Along the slope of edges.
        let far = (product / (self.normal[0][0] + self.normal[3][3])).sqrt();
        (square > CHANCE).then_some(Displacement { far, by, square })
    }
}

impl Prediction<'_> {
    /// Whether what it shows of several colours, of what is known exactly, is all noise: where most
    /// of it is exact, there is none, and what is not exact is something else.
    pub fn is_even(&self) -> bool {
        /// Share of a sample's variance that an error has in an exact picture, at most, and where
        /// something else is seen, at least; and the number of such pixels that is no chance.
        const EXACT: f64 = 1e-4;
        const OTHER: f64 = 0.5;
        const CHANCE: usize = 4;
        /// The variance from which rounding is little beside it.
        const LEAST: f64 = 1e-3;
        let share = |at: usize| {
            let variance = self.moments.variance[at].element_sum();
            let is_known = self.moments.doubt[at] == DVec3::ZERO;
            let is_told = variance > LEAST && is_known && !self.seen[at].x.is_nan();
            let (difference, rounding) = (self.difference(at), self.error(at, 0.0));
            let beyond = difference * difference - rounding;
            is_told.then(|| beyond.element_sum() / variance)
        };
        let mut shares: Vec<f64> = (0..self.seen.len()).filter_map(share).collect();
        shares.sort_by(f64::total_cmp);
        // Of three quarters of them.
        let is_exact = shares
            .get(shares.len() * 3 / 4)
            .is_some_and(|most| *most < EXACT);
        let others = shares.iter().rev().take_while(|share| **share > OTHER);
        !is_exact || others.count() < CHANCE
    }

    /// The share of a sample's variance that the squared differences are, of pixels of several
    /// colours.
    fn share(&self) -> f64 {
        let (mut squares, mut variances) = (0.0, 0.0);
        for at in (0..self.seen.len()).filter(|&at| !self.is_flat(at)) {
            squares += self.difference(at).length_squared();
            variances += self.moments.variance[at].element_sum();
        }
        f64::min(squares / f64::max(variances, 1e-12), 1.0)
    }

    /// How many times as wide as a pixel the square seems that each is the mean of, if that is
    /// another width than 1 where an error has this share of a sample's variance.
    ///
    /// To second order, a mean over a square of the width w differs from one over a pixel by
    /// (w² − 1)/24 times the sum of the second derivatives.
    fn pixel_width(&self, deviations: &[f64], share: f64, is_coded: bool) -> Option<f64> {
        let (width, height) = (self.width, self.seen.len() / self.width);
        let mean = &self.moments.mean;
        let (mut seen, mut all, mut variance) = (0.0, 0.0, 0.0);
        for y in 1..height.max(2) - 1 {
            for at in y * width + 1..(y + 1) * width - 1 {
                let around = [at - 1, at + 1, at - width, at + width];
                if around
                    .iter()
                    .chain([&at])
                    .any(|&at| self.seen[at].x.is_nan())
                {
                    continue;
                }
                let beside: DVec3 = around.iter().map(|&near| mean[near]).sum();
                let bend = beside - 4.0 * mean[at];
                if bend == DVec3::ZERO {
                    continue;
                }
                let deviation = DVec3::from_slice(&deviations[3 * at..]);
                let weighted = bend / (deviation * deviation);
                seen += weighted.dot(self.difference(at));
                all += weighted.dot(bend);
                variance += (weighted * weighted).dot(self.error(at, share));
            }
        }
        let square = 1.0 + 24.0 * seen / all.max(1e-300);
        let is_sure = seen.abs() > SURE * variance.sqrt();
        let is_other = match is_coded {
            true => square > WIDE_IN_CODED,
            false => {
                let is_narrow = square < 1.0 - NARROW - NARROWER * share;
                is_narrow || square > WIDE + WIDER * share
            }
        };
        (is_sure && is_other).then(|| square.max(0.0).sqrt().clamp(LEAST_WIDTH, MOST_WIDTH))
    }

    /// How far each of some groups of pixels lies from where it should, if that is no chance where
    /// an error has this share of a sample's variance.
    fn displacements(
        &self,
        deviations: &[f64],
        share: f64,
        groups: &[usize],
    ) -> Vec<Option<Displacement>> {
        let off_middle = (OFF_MIDDLE * share).min(MOST_OFF_MIDDLE);
        let (width, count) = (self.width, self.seen.len());
        let height = count / width;
        let mean = &self.moments.mean;
        let all = groups.iter().max().map_or(0, |most| most + 1);
        // The middle and the reach of each group.
        let mut boxes = vec![[f64::INFINITY, -f64::INFINITY, f64::INFINITY, -f64::INFINITY]; all];
        let place = |at: usize| [(at % width) as f64, (at / width) as f64];
        for (at, group) in groups.iter().enumerate() {
            let ([x, y], own) = (place(at), &mut boxes[*group]);
            *own = [own[0].min(x), own[1].max(x), own[2].min(y), own[3].max(y)];
        }
        let empty = Sums {
            normal: vec![vec![0.0; COUNT]; COUNT],
            variance: vec![vec![0.0; COUNT]; COUNT],
            right: vec![0.0; COUNT],
        };
        let mut sums = vec![empty; all];
        for (at, group) in groups.iter().enumerate() {
            let (x, y) = (at % width, at / width);
            let is_inside = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
            if !is_inside || self.seen[at].x.is_nan() {
                continue;
            }
            let difference = self.difference(at);
            let error = self.error(at, share);
            let [x0, x1, y0, y1] = boxes[*group];
            let reach = ((x1 - x0).max(y1 - y0) / 2.0).max(1.0);
            let [x, y] = place(at);
            let (x, y) = ((x - (x0 + x1) / 2.0) / reach, (y - (y0 + y1) / 2.0) / reach);
            for i in 0..3 {
                let right = (mean[at + 1][i] - mean[at - 1][i]) / 2.0;
                let down = (mean[at + width][i] - mean[at - width][i]) / 2.0;
                if right == 0.0 && down == 0.0 {
                    continue;
                }
                let row = [right, right * x, right * y, down, down * x, down * y];
                let deviation = deviations[3 * at + i];
                let weight = 1.0 / (deviation * deviation);
                let own = &mut sums[*group];
                for j in 0..COUNT {
                    own.right[j] += weight * row[j] * difference[i];
                    for k in 0..COUNT {
                        let product = weight * row[j] * row[k];
                        own.normal[j][k] += product;
                        own.variance[j][k] += weight * product * error[i];
                    }
                }
            }
        }
        sums.iter()
            .map(|sums| sums.displacement(off_middle))
            .collect()
    }
}

impl Judge<'_> {
    /// Whether a candidate explains the picture: no pixel of one colour shows another, and what
    /// edges show lies where it should, and is as sharp.
    ///
    /// The middle grid is asked first, as it costs less: what is wrong for certain in one of its
    /// cells is so in a pixel, if what the cells show is exact. Then pixels of one colour are, and
    /// edges last.
    pub fn explains(&self, candidate: &Candidate) -> bool {
        let is_possible = !self.is_exact(candidate)
            || self
                .predicted(candidate, &self.middle)
                .is_some_and(|shown| shown.strays().are_no_more(0));
        let is_explained = || {
            let shown = self.predicted(candidate, &self.fine)?;
            let strays = shown.strays();
            let are_areas_right = strays.are_no_more(self.missed(candidate));
            Some(are_areas_right && Left::of(self, candidate, &shown, &strays).is_noise())
        };
        is_possible && is_explained() == Some(true)
    }

    /// How many pixels of one colour may show another: samples miss corners of a square here and
    /// there, and a JPEG is coded otherwise.
    fn missed(&self, candidate: &Candidate) -> usize {
        if self.is_exact(candidate) {
            0
        } else {
            self.fine.grid.count().div_ceil(MISSED)
        }
    }

    /// Whether it is known exactly what a candidate shows: what samples make, or a JPEG, is not.
    fn is_exact(&self, candidate: &Candidate) -> bool {
        candidate.is_exact() && self.fine.jpeg.is_none()
    }
}

/// What a candidate leaves on the pixels.
#[derive(Clone, Copy, Debug)]
pub struct Left {
    /// How many pixels of one colour show another.
    pub strays: usize,
    /// Whether these are no more than are missed, and what edges show may be noise.
    pub are_areas_right: bool,
    /// Whether these lie beside edges.
    pub is_at_edges: bool,
    /// Whether what pixels of several colours show is all noise.
    pub is_even: bool,
    /// Where edges are, if not where they should; this and the next are asked only if strays lie
    /// at edges.
    pub off: Option<Displacement>,
    /// How wide the pixels are that edges are seen through, if not as they should.
    pub width: Option<f64>,
}

impl Left {
    /// What a candidate leaves; none if that is not known.
    pub fn by(judge: &Judge, candidate: &Candidate) -> Option<Self> {
        let shown = judge.predicted(candidate, &judge.fine)?;
        Some(Self::of(judge, candidate, &shown, &shown.strays()))
    }

    /// What a candidate leaves that shows this, and so many strays.
    fn of(judge: &Judge, candidate: &Candidate, shown: &Prediction, strays: &Strays) -> Self {
        let level = &judge.fine;
        judge.work.spend(work::LEFT * level.grid.count() as f64);
        let missed = judge.missed(candidate);
        let beside = level.jpeg.map_or(BESIDE, |_| BLOCK);
        let is_inside = |at: &&usize| level.grid.around(**at, beside).all(|at| shown.is_flat(at));
        let inside = strays.pixels.iter().filter(is_inside).count();
        let is_at_edges = inside <= missed + strays.pixels.len() / INSIDE;
        let (off, width) = match is_at_edges {
            true => edges(judge, candidate, shown),
            false => (None, None),
        };
        Self {
            strays: strays.pixels.len(),
            are_areas_right: strays.are_no_more(missed),
            is_at_edges,
            is_even: candidate.is_filtered() || shown.is_even(),
            off,
            width,
        }
    }

    /// Whether it is no more than sampling noise.
    pub fn is_noise(&self) -> bool {
        self.are_areas_right && self.off.is_none() && self.width.is_none() && self.is_even
    }
}

/// How far the picture, or an object, lies from where a candidate shows it, if that is no chance
/// and not due to where few samples lie; and how wide pixels are, if not as they should.
fn edges(
    judge: &Judge,
    candidate: &Candidate,
    shown: &Prediction,
) -> (Option<Displacement>, Option<f64>) {
    let level = &judge.fine;
    let labels = labels(judge, candidate, candidate.layout, &level.grid);
    let background = judge.scene.objects.len();
    let groups: Vec<usize> = labels.iter().map(|one| one.unwrap_or(background)).collect();
    let share = match level.jpeg {
        // What it does to an edge would be taken for all that few samples do.
        Some(_) => shown.share(),
        None => {
            let score = shown.score();
            score.samples.map_or(score.share, |n| 1.0 / n)
        }
    };
    let deviations = shown.deviations();
    let beyond = |groups: &[usize], is_beyond: &dyn Fn(&Displacement) -> bool| {
        let all = shown.displacements(&deviations, share, groups).into_iter();
        let all = all.flatten().filter(is_beyond);
        all.max_by(|one, other| one.far.total_cmp(&other.far))
    };
    let is_moved = |one: &Displacement| {
        let by = f64::max(one.by[0].abs(), one.by[1].abs());
        level.jpeg.is_some() && by > MOVED && one.square > SURELY_MOVED
    };
    let of_all = NONE + NONE_OF_FEW * share;
    let off = beyond(&vec![0; groups.len()], &|one| {
        one.far > of_all || is_moved(one)
    });
    let [none, of_one, of_coded] = NONE_OF_OBJECT;
    let more = level.jpeg.map_or(of_one, |_| of_coded);
    let of_object = none + more * share.sqrt();
    // A width is told once; and what is done to light is no mean of light.
    let is_width_told = candidate.is_filtered() || !candidate.keeps_light();
    let width =
        (!is_width_told).then(|| shown.pixel_width(&deviations, share, level.jpeg.is_some()));
    (
        off.or_else(|| beyond(&groups, &|one| one.far > of_object)),
        width.flatten(),
    )
}
