//! What an error takes: samples and time, how far they can be trusted, and which method is the fastest.

use super::{
    fit::median,
    ladder::Found,
    measure::{Measurement, Point, Series},
    tried::FEWEST_TRIES,
};
use crate::scene::Method;

/// What an error takes of a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needed {
    /// Samples per pixel.
    pub per_pixel: f64,
    /// How far it may be off as a factor, 1 or more: 19 times of 20, a render with so many times as many samples leaves no more than
    /// the error, and renders with so many times as few leave no less, in the mean of squares. 1 where these very samples were measured, are
    /// not enough by luck, and one fewer are too few or none; none where nothing is known of that.
    pub factor: Option<f64>,
    /// Seconds.
    pub seconds: f64,
    /// How far the measured times spread from which these seconds are: (greatest − least) / median; infinite if that is not known.
    pub spread: f64,
    /// Whether it lies beyond what was measured.
    pub is_extrapolated: bool,
    /// Whether fewer may do: of fewer none were measured, or none between those that leave an error and these, which leave none.
    pub is_at_most: bool,
    /// On how many tries it rests; 0 if on the line between the planned points.
    pub tries: usize,
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
    pub(super) fn of_point(
        series: &Series,
        point: &Point,
        is_at_most: bool,
        is_sure: bool,
    ) -> Self {
        Self {
            per_pixel: point.per_pixel as f64,
            factor: (is_sure && !is_at_most).then_some(1.0),
            seconds: point.seconds(),
            spread: series.time_spread(point),
            is_extrapolated: false,
            is_at_most,
            tries: 0,
        }
    }

    /// The time may be so many times as long or as short: the samples' factor and half of the spread.
    fn doubt(&self) -> f64 {
        self.factor.unwrap_or(f64::INFINITY) * (1.0 + self.spread / 2.0)
    }

    /// Whether nothing is known of how far it may be off: it was computed from points that do not tell, was measured too seldom, or fewer were not.
    pub(super) fn is_unknown(&self) -> bool {
        self.factor.is_none()
    }
}

impl Series {
    /// What an error takes; none if more samples do not help.
    ///
    /// If it was tried, that is where the tries near it say. If not, it is where the straight line through the logarithms of samples and error comes
    /// down to it: between the planned points on either side of the error, and beyond the last one through that and another with at
    /// most half its samples. Fewer samples than were measured are not asked for: they would not take less than the pixel's share of the rest.
    pub fn needed(&self, error: f64) -> Option<Needed> {
        let line = match self.by_points(error)? {
            Found::Point(needed) => return Some(needed),
            Found::Line(line) => line,
        };
        let tried = self.tried(error, &line);
        let tries = tried.near.len();
        let is_extrapolated = line.is_extrapolated && tries < FEWEST_TRIES;
        let (x, doubt) = match tries {
            0 => (line.x, line.doubt),
            _ => (tried.x, self.doubt(&tried, &line)),
        };
        let per_pixel = libm::exp(x).ceil();
        if !per_pixel.is_finite() {
            return None;
        }
        let (seconds, spread) = match tries {
            0 => self.seconds_at(per_pixel)?,
            _ => self.seconds_by(&tried.near, per_pixel),
        };
        Some(Needed {
            per_pixel,
            factor: doubt.map(libm::exp).filter(|factor| factor.is_finite()),
            seconds,
            spread,
            is_extrapolated,
            is_at_most: false,
            tries,
        })
    }
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
            first.is_some_and(|point| series.keeps(point, error))
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
