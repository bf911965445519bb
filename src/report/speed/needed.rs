//! What an error takes: samples and time, how far they can be trusted, and which method is the fastest.

use super::{
    fit::{log_error, median},
    measure::{Measurement, Point, Series},
    notes::spread,
    plan::LEAST_SHARE,
};
use crate::scene::Method;

/// Between two counts of samples whose logarithms are h apart, the logarithm of what an error takes is taken to be off by up to h²/4 times this from
/// the straight line: of counts four times as large as the one before by 0.38 half-way. Of seven examples, powers of four and the powers of two
/// between them, no method but regular was off by more (hammersley 0.31 and scatter 0.30; sobol 0.09).
const SAG: f64 = 0.8;

/// Samples on a grid fall into step with the lines of a picture: the errors of regular fall by leaps, also between counts that are next to each other.
/// Where they were not measured nothing is known of them.
const LEAPING: Method = Method::Regular;

/// So many standard errors count: 19 times of 20 no more than that is missed.
const CERTAINTY: f64 = 2.0;

/// How errors fall further on, whatever was seen before: an exponent of −1/2 is that of independent samples, ...
const INDEPENDENT: f64 = -0.5;

/// ... and this one that of a slanted edge in a pixel whose samples are spread evenly.
const EVEN: f64 = -0.75;

/// What an error takes of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needed {
    /// Samples per pixel.
    pub per_pixel: f64,
    /// How far it may be off as a factor, 1 or more: it may be so many times as many or as few. None where it was not computed from
    /// points, or nothing is known of that.
    pub factor: Option<f64>,
    /// Seconds.
    pub seconds: f64,
    /// How far the measured times spread from which these seconds are: (greatest − least) / median; infinite if that is not known.
    pub spread: f64,
    /// Whether it lies beyond what was measured.
    pub is_extrapolated: bool,
    /// Whether fewer may do: of fewer none were measured, or none between those that leave an error and these, which leave none.
    pub is_at_most: bool,
    /// Between two points, how much its logarithm may be off because the line between them sags; else 0.
    pub sag: f64,
}

/// Samples taken because an error should take them.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The error that was asked for.
    pub wanted: f64,
    /// What came of it, in a single run.
    pub point: Point,
}

/// Which method is the fastest.
#[derive(Clone, Debug, PartialEq)]
pub enum Fastest {
    /// With the fewest samples that were measured every method comes there: nothing is known of fewer.
    All,
    /// These, the one with the least time first: those whose times cannot be told apart from its.
    Of(Vec<(Method, Needed)>),
}

impl Needed {
    /// What was measured at a point that is enough.
    fn of_point(series: &Series, point: &Point, is_at_most: bool) -> Self {
        Self {
            per_pixel: point.per_pixel as f64,
            factor: None,
            seconds: point.seconds(),
            spread: series.time_spread(point),
            is_extrapolated: false,
            is_at_most,
            sag: 0.0,
        }
    }

    /// The time may be so many times as long or as short: the samples' factor and half of the spread.
    fn doubt(&self) -> f64 {
        let samples = match self.is_unknown() {
            true => f64::INFINITY,
            false => self.factor.unwrap_or(1.0),
        };
        samples * (1.0 + self.spread / 2.0)
    }

    /// Whether nothing is known of how far it may be off: it was computed from points that do not tell, or fewer were not measured.
    pub(super) fn is_unknown(&self) -> bool {
        self.factor.is_none() && (self.is_extrapolated || self.is_at_most || self.sag > 0.0)
    }
}

impl Series {
    /// All points that there are, whether planned or tried, by samples.
    pub fn curve(&self) -> Vec<&Point> {
        let tried = self.checks.iter().map(|check| &check.point);
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

    /// What an error takes; none if more samples do not help.
    ///
    /// That is where the straight line through the logarithms of samples and error comes down to it: between the points on either side of
    /// the error, and beyond the last one through that and another with at most half its samples. Fewer samples than were measured are not
    /// asked for: they would not take less than the pixel's share of the rest.
    ///
    /// With standard errors ε of the logarithms of both errors, the place x = (1 − s)·a + s·b on the line has one of up to
    /// |1 − s|·ε_a + s·ε_b by its slope: runs of one seed are wrong together, and all tries are. Beyond the last point the truth may bend away: there it counts, too, how far off x is if the
    /// errors fall with any other slope that was seen, or that of theory. Between two it may sag, most half-way, and more than all points
    /// show where they are the counts that a method likes best: there `SAG` says how much counts. The answer is a count that suits the method.
    pub fn needed(&self, error: f64) -> Option<Needed> {
        let curve = self.curve();
        let first = *curve.first()?;
        if first.error() <= error {
            return Some(Needed::of_point(self, first, first.per_pixel > 1));
        }
        let enough = curve.iter().position(|point| point.error() <= error);
        let (a, b) = match enough {
            Some(next) => (curve[next - 1], curve[next]),
            None => {
                let last = *curve.last()?;
                let mut apart = curve.iter().rev().filter(|point| is_apart(point, last));
                (*apart.next()?, last)
            }
        };
        let [x_a, x_b] = [a, b].map(|point| libm::log(point.per_pixel as f64));
        let [y_a, y_b] = [a, b].map(|point| libm::log(point.error()));
        let slope = (y_b - y_a) / (x_b - x_a);
        let share = (libm::log(error) - y_a) / (y_b - y_a);
        let x = x_a + share * (x_b - x_a);
        // No error at all has no logarithm, and no line goes there: its samples are enough, and fewer may be, too.
        if b.error() == 0.0 {
            return Some(Needed::of_point(self, b, b.per_pixel > a.per_pixel + 1));
        }
        let exact = libm::exp(x);
        if slope >= 0.0 || !exact.is_finite() {
            return None;
        }
        let mut per_pixel = fitting(self.method, exact.ceil());
        let mut doubt = self.log_error(a).zip(self.log_error(b)).map(|(a, b)| {
            let error = (1.0 - share).abs() * a + share * b;
            CERTAINTY * error / slope.abs()
        });
        let mut sag = 0.0;
        let bend = if enough.is_some() {
            per_pixel = per_pixel.min(b.per_pixel as f64);
            sag = SAG * (x_b - x) * (x - x_a);
            sag
        } else {
            (x - x_b) * self.bend(slope)
        };
        doubt = doubt.map(|doubt| libm::hypot(doubt, bend));
        if self.method == LEAPING {
            doubt = None;
        }
        let (seconds, spread) = self.seconds_at(per_pixel)?;
        Some(Needed {
            per_pixel,
            factor: doubt.map(libm::exp).filter(|factor| factor.is_finite()),
            seconds,
            spread,
            is_extrapolated: enough.is_none(),
            is_at_most: false,
            sag,
        })
    }

    /// How much farther or nearer than by this slope an error lies, as a part of that distance, by the slope that is the least like it of those
    /// that were seen and of those of theory.
    fn bend(&self, slope: f64) -> f64 {
        let theory = match self.method {
            Method::Random | Method::Scatter => [INDEPENDENT; 2],
            _ => [INDEPENDENT, EVEN],
        };
        let others = self.slopes().into_iter().chain(theory);
        let off = others.map(|other| match other < 0.0 {
            true => (slope / other - 1.0).abs(),
            false => f64::INFINITY,
        });
        off.fold(0.0, f64::max)
    }

    /// The standard error of the logarithm of a point's error. Of a single run it is that of the last point with several, larger by
    /// the root of how many there were.
    fn log_error(&self, point: &Point) -> Option<f64> {
        let several = |point: &&Point| point.rmse.len() > 1;
        let like = Some(point).filter(several);
        let like = like.or_else(|| self.points.iter().rev().find(several))?;
        let runs = like.rmse.len() as f64 / point.rmse.len() as f64;
        Some(log_error(&like.rmse)? * runs.sqrt())
    }

    /// How far the times of a point spread. Of a single run that is as much as of any point with several, and unknown, which is any
    /// number, if there is none.
    fn time_spread(&self, point: &Point) -> f64 {
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

    /// What came of taking the samples that an error should take, if somebody did; the last time.
    pub fn check(&self, wanted: f64) -> Option<&Check> {
        let mut checks = self.checks.iter().rev();
        checks.find(|check| check.wanted == wanted)
    }
}

/// The least count that is no less and suits a method: `multi_jittered` has a grid, which is near a square of such counts only, and of a prime has a single
/// row. Other methods like all counts nearly as well.
pub(super) fn fitting(method: Method, count: f64) -> f64 {
    let side = count.sqrt().floor();
    let grids = [
        side * side,
        side * (side + 1.0),
        (side + 1.0) * (side + 1.0),
    ];
    match method {
        Method::MultiJittered => grids.into_iter().find(|&grid| grid >= count),
        _ => None,
    }
    .unwrap_or(count)
}

/// Whether a point has at most half the samples of another: what lies nearer tells more of noise than of a slope.
fn is_apart(point: &Point, last: &Point) -> bool {
    point.per_pixel <= last.per_pixel / 2
}

impl Measurement {
    /// What an error takes of a method; none if more samples do not help, or if that error cannot be told from none.
    pub fn needed(&self, series: &Series, error: f64) -> Option<Needed> {
        series.needed(error).filter(|_| self.tells(error))
    }

    /// Whether the reference is known well enough to tell such an error from none: by the root of the mean of its bounds' squares, since errors
    /// are such means.
    pub(super) fn tells(&self, error: f64) -> bool {
        error > self.reference.root_mean_square_bound()
    }

    /// How long the exact method takes for an error, if it was measured and is known to come there.
    pub(super) fn exact_seconds(&self, error: f64) -> Option<f64> {
        let exact = self.exact.as_ref().filter(|_| self.tells(error));
        exact.map(|exact| median(&exact.times))
    }

    /// The sampled methods that need the least time for an error; none if none comes there, or if that error cannot be told from none.
    pub fn fastest(&self, error: f64) -> Option<Fastest> {
        if !self.tells(error) {
            return None;
        }
        let is_first = |series: &Series| {
            let first = series.points.first();
            first.is_some_and(|point| point.error() <= error)
        };
        if self.series.len() > 1 && self.series.iter().all(is_first) {
            return Some(Fastest::All);
        }
        let needs = self.series.iter();
        let needs = needs.filter_map(|series| Some((series.method, self.needed(series, error)?)));
        let mut needs: Vec<_> = needs.collect();
        needs.sort_by(|(_, a), (_, b)| a.seconds.total_cmp(&b.seconds));
        let (_, best) = *needs.first()?;
        needs.retain(|(_, other)| {
            other.seconds / other.doubt() <= best.seconds * best.doubt() || *other == best
        });
        Some(Fastest::Of(needs))
    }
}
