//! What the planned points say of an error: where the line through them comes down to it, and in what time.

use super::{
    fit::{certainty, log_error, square},
    measure::{Point, Series},
    needed::Needed,
    notes::spread,
    plan::LEAST_SHARE,
};
use crate::scene::Method;

/// Between two counts of samples whose logarithms are h apart, the logarithm of what an error takes is taken to be off by up to h²/4 times this from
/// the straight line: of counts four times as large as the one before by 0.38. Of seven examples, powers of four and the powers of two
/// between them, scatter was off by 0.30, because of the pixels that it leaves empty.
const SAG: f64 = 0.8;

/// How errors of independent samples fall further on, whatever was seen before.
const INDEPENDENT: f64 = -0.5;

/// What planned points say of an error.
pub(super) enum Found {
    Point(Needed),
    Line(Line),
}

/// A place on the line through planned points, in logarithms.
pub(super) struct Line {
    /// ln of the samples.
    pub(super) x: f64,
    /// Negative.
    pub(super) slope: f64,
    /// How far x may be off, if that is known.
    pub(super) doubt: Option<f64>,
    pub(super) is_extrapolated: bool,
}

impl Series {
    /// All points that there are, whether planned or tried, by samples.
    pub fn curve(&self) -> Vec<&Point> {
        let tried = self.tries.iter().map(|it| &it.point);
        let mut points: Vec<_> = self.points.iter().chain(tried).collect();
        points.sort_by_key(|point| point.per_pixel);
        points
    }

    /// The slopes of the logarithms of error against samples within the curve: between any two points that are [apart](is_apart).
    pub(super) fn slopes(&self) -> Vec<f64> {
        let mut curve = self.curve();
        // An error of 0 has no logarithm.
        curve.retain(|point| point.error() > 0.0);
        let to = |last: &&Point| {
            let last = *last;
            let others = curve.iter().filter(|point| is_apart(point, last));
            let slope = |point: &&Point| {
                let samples = last.per_pixel as f64 / point.per_pixel as f64;
                libm::log(last.error() / point.error()) / libm::log(samples)
            };
            others.map(slope).collect::<Vec<_>>()
        };
        curve.iter().flat_map(to).collect()
    }

    /// What the planned points say.
    ///
    /// With standard errors ε of the logarithms of both errors, the place x = (1 − s)·a + s·b on the line has one of up to
    /// |1 − s|·ε_a + s·ε_b by its slope: runs of one seed are wrong together. A single render differs by the deviation of one from the next besides. Beyond the
    /// last point the truth may bend away: there it counts, too, how far off x is if the errors fall with any other slope that was
    /// seen, or that of theory. Between two it may sag: `SAG` says how much counts. But most methods like powers of two better than any other count, or
    /// squares, and even the next one less: of what lies between them such points tell nothing. Only independent samples do not care how many they are.
    pub(super) fn by_points(&self, error: f64) -> Option<Found> {
        let points = &self.points;
        let first = points.first()?;
        if first.error() <= error {
            let is_sure = self.keeps(first, error);
            let is_at_most = first.per_pixel > 1;
            let needed = Needed::of_point(self, first, is_at_most, is_sure);
            return Some(Found::Point(needed));
        }
        let enough = points.iter().position(|point| point.error() <= error);
        let (a, b) = match enough {
            Some(next) => (&points[next - 1], &points[next]),
            None => {
                let last = points.last()?;
                let mut apart = points.iter().rev().filter(|point| is_apart(point, last));
                (apart.next()?, last)
            }
        };
        // No error at all has no logarithm, and no line goes there: its samples are enough, and fewer may be, too.
        if b.error() == 0.0 {
            let is_at_most = b.per_pixel > a.per_pixel + 1;
            let needed = Needed::of_point(self, b, is_at_most, true);
            return Some(Found::Point(needed));
        }
        let [x_a, x_b] = [a, b].map(ln_samples);
        let [y_a, y_b] = [a, b].map(|point| libm::log(point.error()));
        let slope = (y_b - y_a) / (x_b - x_a);
        if slope >= 0.0 {
            return None;
        }
        let share = (libm::log(error) - y_a) / (y_b - y_a);
        let x = x_a + share * (x_b - x_a);
        let off = match enough {
            Some(_) => SAG * square((x_b - x_a) / 2.0),
            None => (x - x_b) * self.bend(slope),
        };
        let noise = log_error(&a.rmse)
            .zip(log_error(&b.rmse))
            .map(|(e_a, e_b)| {
                let fewest = a.rmse.len().min(b.rmse.len());
                let line = (1.0 - share).abs() * e_a + share * e_b;
                let render = e_a.max(e_b) * (fewest as f64).sqrt();
                certainty(fewest - 1) * libm::hypot(line, render) / slope.abs()
            });
        Some(Found::Line(Line {
            x,
            slope,
            doubt: noise
                .filter(|_| self.is_independent())
                .map(|noise| libm::hypot(noise, off)),
            is_extrapolated: enough.is_none(),
        }))
    }

    /// Whether its samples do not know of each other.
    pub(super) fn is_independent(&self) -> bool {
        matches!(self.method, Method::Random | Method::Scatter)
    }

    /// Whether a point leaves no more than an error not only by luck: 19 times of 20 a further run does not either.
    pub(super) fn keeps(&self, point: &Point, error: f64) -> bool {
        // Without an error, or seeds, all runs are alike.
        if point.error() == 0.0 || self.method == Method::Regular {
            return point.error() <= error;
        }
        let runs = point.rmse.len();
        let deviation = log_error(&point.rmse).map(|mean| mean * (runs as f64 + 1.0).sqrt());
        let margin = libm::log(error / point.error());
        deviation.is_some_and(|deviation| certainty(runs - 1) * deviation <= margin)
    }

    /// How much farther or nearer than by this slope an error lies, as a part of that distance, by the slope that is the least like it of those
    /// that were seen and of those of theory.
    fn bend(&self, slope: f64) -> f64 {
        let others = self.slopes().into_iter().chain([INDEPENDENT]);
        let off = others.map(|other| match other < 0.0 {
            true => (slope / other - 1.0).abs(),
            false => f64::INFINITY,
        });
        off.fold(0.0, f64::max)
    }

    /// How far the times of a point spread. Of a single run that is as much as of any point with several, and unknown, which is any
    /// number, if there is none.
    pub(super) fn time_spread(&self, point: &Point) -> f64 {
        if point.times.len() > 1 {
            return spread(&point.times);
        }
        let several = self.points.iter().filter(|point| point.times.len() > 1);
        let spreads = several.map(|point| spread(&point.times));
        spreads.reduce(f64::max).unwrap_or(f64::INFINITY)
    }

    /// The time of a number of samples, and its spread: on the straight line between the points on either side, beyond the last one
    /// with the slope of that through the first and the last, but in proportion at most, and not much less than that whatever a noisy machine says.
    pub(super) fn seconds_at(&self, per_pixel: f64) -> Option<(f64, f64)> {
        let curve = self.curve();
        let (first, last) = (*curve.first()?, *curve.last()?);
        let samples = |point: &Point| point.per_pixel as f64;
        let is_enough = |point: &&Point| samples(point) >= per_pixel;
        Some(match curve.iter().position(is_enough) {
            None => {
                let rise = last.seconds() - first.seconds();
                let most = last.seconds() / samples(last);
                let rate = match last.per_pixel > first.per_pixel {
                    true => {
                        (rise / (samples(last) - samples(first))).clamp(LEAST_SHARE * most, most)
                    }
                    false => most,
                };
                let seconds = last.seconds() + rate * (per_pixel - samples(last));
                (seconds, self.time_spread(last))
            }
            Some(0) => (first.seconds(), self.time_spread(first)),
            Some(next) => {
                let (low, high) = (curve[next - 1], curve[next]);
                let share = (per_pixel - samples(low)) / (samples(high) - samples(low));
                let seconds = low.seconds() + share * (high.seconds() - low.seconds());
                (seconds, self.time_spread(low).max(self.time_spread(high)))
            }
        })
    }

    /// How many times as much tries left as the line between the planned points says for as many samples, from the least to the
    /// greatest; none if there are none between those.
    pub(super) fn beside_line(&self) -> Option<(f64, f64)> {
        let ratio = |point: &Point| {
            let next = self
                .points
                .iter()
                .position(|it| it.per_pixel >= point.per_pixel)?;
            let [a, b] = [self.points.get(next.checked_sub(1)?)?, &self.points[next]];
            let share = (ln_samples(point) - ln_samples(a)) / (ln_samples(b) - ln_samples(a));
            let [y_a, y_b] = [a, b].map(|point| libm::log(point.error()));
            let ratio = point.error() / libm::exp(y_a + share * (y_b - y_a));
            Some(ratio).filter(|ratio| ratio.is_finite())
        };
        let ratios = self.tries.iter().filter_map(|it| ratio(&it.point));
        ratios.fold(None, |ends, ratio| {
            let (least, greatest) = ends.unwrap_or((ratio, ratio));
            Some((ratio.min(least), ratio.max(greatest)))
        })
    }
}

/// ln of how many samples a point has.
pub(super) fn ln_samples(point: &Point) -> f64 {
    libm::log(point.per_pixel as f64)
}

/// Whether a point has at most half the samples of another: what lies nearer tells more of noise than of a slope.
fn is_apart(point: &Point, last: &Point) -> bool {
    point.per_pixel <= last.per_pixel / 2
}
