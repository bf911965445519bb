//! Whether errors add up along what a mistake changes.
//!
//! Noise has no mean: its sum, weighted by what some mistake would change in each pixel, is 0 within its own standard deviation, and that is
//! known twice. The errors say it themselves: of independent errors that are as often e as −e the sum Σ e is beyond z √(Σ e²) with a
//! probability of at most exp(−z²/2) to each side (Efron, Student's t-test under symmetry conditions, 1969). Where errors are not symmetric, as
//! where a pixel holds a thousandth of another colour and no sample of it, it is the variance of samples that says it. The larger one counts.

use super::noise::Noise;
use crate::{
    area::Area,
    color::{linear_to_srgb, srgb_to_linear},
    film::{Film, TooLarge},
};

/// A sum beyond so many standard deviations is no chance: exp(−18) to each side, which for some hundreds of sums is one picture in
/// a hundred thousand. As a sum is at most √n deviations, it takes 36 pixels.
pub const SIGMAS: f64 = 6.0;

/// What a number that is off by a little changes: the changed picture less the right one, in the pixels where they differ.
pub struct Trend(pub Vec<([u32; 2], [f64; 3])>);

/// How errors go with a change.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sum {
    /// In standard deviations.
    pub sigmas: f64,
    /// How many times the change explains most of the errors.
    pub times: f64,
}

/// What a picture is off, less what rounding to bytes may have done.
pub struct Errors {
    film: Film,
}

impl Errors {
    /// Of a picture against another one.
    pub fn new(a: &Film, right: &Film) -> Result<Self, TooLarge> {
        let error = |p: f64, q: f64| {
            if p == q {
                return 0.0;
            }
            // Rounding is the same wherever the same is seen, and so adds up.
            let step = linear_to_srgb(p.max(q)) + 0.5 / 255.0;
            let rounding = srgb_to_linear(step) - p.max(q);
            (p - q).signum() * ((p - q).abs() - rounding).max(0.0)
        };
        let film = Film::from_fn(a.width(), a.height(), |x, y| {
            let (p, q) = (a.pixel(x, y), right.pixel(x, y));
            [0, 1, 2].map(|i| error(p[i], q[i]))
        })?;
        Ok(Self { film })
    }

    /// Their sum along a change of pixels. `noise` is the variance of one sample, and how many there are.
    pub fn sum(
        &self,
        change: impl Iterator<Item = ([u32; 2], [f64; 3])>,
        noise: Option<(&Film, Noise)>,
    ) -> Sum {
        let (mut sum, mut squares, mut variances, mut changes) = (0.0, 0.0, 0.0, 0.0);
        for ([x, y], change) in change {
            if change == [0.0; 3] {
                continue;
            }
            let error = self.film.pixel(x, y);
            let own: f64 = (0..3).map(|i| change[i] * error[i]).sum();
            sum += own;
            squares += own * own;
            changes += change.iter().map(|change| change * change).sum::<f64>();
            if let Some((variance, _)) = noise {
                let variance = variance.pixel(x, y);
                // However the channels hang together.
                let deviation: f64 = (0..3)
                    .map(|i| change[i].abs() * variance[i].max(0.0).sqrt())
                    .sum();
                variances += deviation * deviation;
            }
        }
        if squares == 0.0 {
            return Sum::default();
        }
        let expected = noise.map_or(0.0, |(_, noise)| variances / noise.samples);
        Sum {
            sigmas: sum / squares.max(expected).sqrt(),
            times: sum / changes,
        }
    }

    /// The same along a trend.
    pub fn along(&self, trend: &Trend, noise: Option<(&Film, Noise)>) -> Sum {
        self.sum(trend.0.iter().copied(), noise)
    }

    /// The same along the way from a picture to another one.
    pub fn towards(&self, from: &Film, to: &Film, noise: Option<(&Film, Noise)>) -> Sum {
        let places = Area::whole(from.width(), from.height()).iter();
        let films = places.zip(from.pixels().iter().zip(to.pixels()));
        let change = films.map(|((x, y), (p, q))| ([x, y], [0, 1, 2].map(|i| q[i] - p[i])));
        self.sum(change, noise)
    }

    /// Whether they add up as if the whole picture were displaced, larger or turned, by little.
    pub fn is_picture_moved(&self, right: &Film, noise: Option<(&Film, Noise)>) -> bool {
        let (width, height) = (right.width(), right.height());
        if width < 3 || height < 3 {
            return false;
        }
        let inside = Area {
            x: 1,
            y: 1,
            width: width - 2,
            height: height - 2,
        };
        let middle = [width, height].map(|side| 0.5 * f64::from(side - 1));
        type Way = fn([f64; 2]) -> [f64; 2];
        let ways: [Way; 4] = [|_| [1.0, 0.0], |_| [0.0, 1.0], |at| at, |[x, y]| [-y, x]];
        ways.into_iter().any(|way| {
            let change = |(x, y): (u32, u32)| {
                let [right_by, down_by] = way([f64::from(x) - middle[0], f64::from(y) - middle[1]]);
                let (left, other) = (right.pixel(x - 1, y), right.pixel(x + 1, y));
                let (above, below) = (right.pixel(x, y - 1), right.pixel(x, y + 1));
                let change = [0, 1, 2]
                    .map(|i| right_by * (other[i] - left[i]) + down_by * (below[i] - above[i]));
                ([x, y], change)
            };
            let sum = self.sum(inside.iter().map(change), noise);
            sum.sigmas.abs() > SIGMAS
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_takes_more_than_36_errors_of_one_sign() {
        let right = Film::from_fn(64, 1, |_, _| [0.2; 3]).unwrap();
        for (pixels, odd, expected) in [
            (36, 0, false),
            (37, 0, true),
            (64, 0, true),
            (64, 20, false),
        ] {
            let a = Film::from_fn(64, 1, |x, _| {
                let sign = if x < odd { -1.0 } else { 1.0 };
                [if x < pixels { 0.2 + 0.1 * sign } else { 0.2 }; 3]
            });
            // By hand, as rounding takes a little of each error.
            let errors = Errors::new(&a.unwrap(), &right).unwrap();
            let red = (0..64).map(|x| ([x, 0], [1.0, 0.0, 0.0]));
            let sum = errors.sum(red, None);
            assert_eq!(sum.sigmas > SIGMAS, expected, "{pixels}, {odd}: {sum:?}");
        }
    }

    #[test]
    fn what_rounding_does_is_no_error() {
        let right = Film::from_fn(64, 64, |_, _| [0.2; 3]).unwrap();
        let byte = srgb_to_linear(linear_to_srgb(0.2) + 0.49 / 255.0);
        let a = Film::from_fn(64, 64, |_, _| [byte; 3]).unwrap();
        let errors = Errors::new(&a, &right).unwrap();
        let all = Area::whole(64, 64).iter().map(|(x, y)| ([x, y], [1.0; 3]));
        let sum = errors.sum(all, None);
        assert_eq!(sum.sigmas, 0.0);
    }
}
