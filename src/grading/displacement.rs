//! Whether what a picture shows lies elsewhere than it should: the test of what edges show.
//!
//! To first order, a picture that lies elsewhere differs by its slope times how far. A field of
//! displacements, affine as a wrong place, size, turn or camera makes it, is fitted to the pixels
//! of each object by least squares. Sampling noise has no such field: the sums that tell it have
//! variances that are known, and so the square of their length in these units, which has six
//! degrees of freedom, is no greater than it may be by chance.

use super::{
    candidate::Candidate, judge::Judge, levenberg_marquardt::solve, objects::labels,
    prediction::Prediction,
};

/// Greatest square that is taken for chance: of normal sums one in 10^8 is greater.
const CHANCE: f64 = 50.0;

/// Greatest displacement of all edges, in pixels, that is taken for none: numbers that are rounded
/// make it.
const NONE: f64 = 0.06;

/// How far few samples lie off the middles of all pixels alike, for each share of a sample's
/// variance that an error has, and at most: the mean of the n points (i/n, φ₂(i)) lies 1/(2n) off,
/// and so many points make less noise than as many random ones.
const OFF_MIDDLE: f64 = 0.75;
const MOST_OFF_MIDDLE: f64 = 0.15;

/// The same of a single object, without and with one sample in a pixel: those of a regular grid
/// move an edge that is parallel to it by up to half of their distance.
const NONE_OF_OBJECT: [f64; 2] = [0.12, 0.5];

const COUNT: usize = 6;

/// A displacement that is no chance.
#[derive(Clone, Copy, Debug)]
pub struct Displacement {
    /// How far edges are displaced, in pixels along their slope.
    pub far: f64,
    /// By how much the middle is, to the right and down.
    pub by: [f64; 2],
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
        (square > CHANCE).then_some(Displacement { far, by })
    }
}

impl Prediction<'_> {
    /// Whether what it shows of several colours is all noise: where most of it is exact, there is
    /// none, and what is not exact is something else.
    pub fn is_even(&self) -> bool {
        /// Share of a sample's variance that an error has in an exact picture, at most, and where
        /// something else is seen, at least; and the number of such pixels that is no chance.
        const EXACT: f64 = 1e-4;
        const OTHER: f64 = 0.5;
        const CHANCE: usize = 4;
        /// The variance from which rounding is little beside it.
        const LEAST: f64 = 1e-3;
        let share = |at: usize| {
            let variance: f64 = self.moments.variance[at].iter().sum();
            let is_told = variance > LEAST && !self.seen[at][0].is_nan();
            let (difference, rounding) = (self.difference(at), self.error(at, 0.0));
            let squares = (0..3).map(|i| difference[i] * difference[i] - rounding[i]);
            is_told.then(|| squares.sum::<f64>() / variance)
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

    /// How far each of some groups of pixels lies from where it should, if that is no chance where
    /// an error has this share of a sample's variance.
    fn displacements(&self, share: f64, groups: &[usize]) -> Vec<Option<Displacement>> {
        let off_middle = (OFF_MIDDLE * share).min(MOST_OFF_MIDDLE);
        let (width, count) = (self.width, self.seen.len());
        let height = count / width;
        let mean = &self.moments.mean;
        let deviations = self.deviations();
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
            if !is_inside || self.seen[at][0].is_nan() {
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
    /// edges show lies where it should.
    pub fn explains(&self, candidate: &Candidate) -> bool {
        self.explains_all(candidate)
            && displaced(self, candidate).is_none()
            && self.is_even(candidate)
    }
}

/// How far the picture, or an object, lies from where a candidate shows it; none if that may be
/// chance, or due to where few samples lie.
pub fn displaced(judge: &Judge, candidate: &Candidate) -> Option<Displacement> {
    let level = &judge.fine;
    let judged = judge.judged(candidate, level)?;
    let labels = labels(judge, candidate, candidate.layout, &level.grid);
    let background = judge.scene.objects.len();
    let groups: Vec<usize> = labels.iter().map(|one| one.unwrap_or(background)).collect();
    let prediction = level.predict(&judged.rendering);
    let share = judged.score.samples.map_or(judged.score.share, |n| 1.0 / n);
    let beyond = |groups: &[usize], none: f64| {
        let all = prediction.displacements(share, groups).into_iter();
        let all = all.flatten().filter(|one| one.far > none);
        all.max_by(|one, other| one.far.total_cmp(&other.far))
    };
    let [none, more] = NONE_OF_OBJECT;
    beyond(&vec![0; groups.len()], NONE).or_else(|| beyond(&groups, none + more * share.sqrt()))
}
