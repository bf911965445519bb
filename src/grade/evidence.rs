//! How many pixels it takes to name a mistake.
//!
//! Where the picture that a mistake makes and the right one can be told apart, each pixel sides with one of them. If the mistake had
//! nothing to do with the picture, a pixel would side with it as often as not, and of n pixels p more than half would with a probability of at most
//! exp(−2p²/n) (Hoeffding, Probability inequalities for sums of bounded random variables, 1963, theorem 2). Of all the mistakes that are
//! thought of, none may pass by chance more often than once in twenty pictures. So with all pixels on its side a mistake takes 20 of them.

use crate::{color::linear_to_srgb, film::Film};

/// More mistakes than this are not thought of before those that are searched for, in pictures of a dozen objects: some forty of the whole
/// picture, the camera and the board, up to sixteen of each object, and of the forty any two that are not about the same. A number that is
/// searched for is one mistake more.
const MISTAKES: f64 = 1024.0;

/// In so large a share of pictures one of them may be named by chance: as usual in statistics, where all of a picture's pixels that tell of
/// anything are as few as can be; each pixel more that agrees halves it, about.
const CHANCE: f64 = 0.05;

/// It takes so many pixels that agree, as many as [`MISTAKES`] and [`CHANCE`] ask for.
pub const FEWEST: u64 = 20;

/// Two pictures can be told apart where they are farther apart than this, in steps of 8-bit sRGB: when both are rounded.
pub const APART: f64 = 1.0;

/// Whether enough pixels of a picture side with what a mistake makes, against what is right.
pub fn is_enough(a: &Film, right: &Film, made: &Film) -> bool {
    let (mut pros, mut cons) = (0u64, 0u64);
    let films = a.pixels().iter().zip(right.pixels()).zip(made.pixels());
    for ((p, q), r) in films {
        if is_apart(q, r) {
            let far = |other: &[f64; 3]| -> f64 {
                (0..3).map(|i| (p[i] - other[i]) * (p[i] - other[i])).sum()
            };
            match far(r) < far(q) {
                true => pros += 1,
                false => cons += 1,
            }
        }
    }
    let all = (pros + cons) as f64;
    // Half of what they are more is what is more than half.
    let more = 0.5 * (pros as f64 - cons as f64);
    more > 0.0 && 2.0 * more * more >= all * libm::log(MISTAKES / CHANCE)
}

fn is_apart(p: &[f64; 3], q: &[f64; 3]) -> bool {
    (0..3).any(|i| {
        p[i] != q[i] && 255.0 * (linear_to_srgb(p[i]) - linear_to_srgb(q[i])).abs() > APART
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(pixels: u32, wrong: u32) -> Film {
        Film::from_fn(pixels, 1, |x, _| [if x < wrong { 0.5 } else { 0.0 }; 3]).unwrap()
    }

    #[test]
    fn it_takes_twenty_pixels_that_agree() {
        for pixels in 0..40 {
            // The mistake makes all of them gray, and so are they.
            let (a, right) = (row(64, pixels), row(64, 0));
            let expected = u64::from(pixels) >= FEWEST;
            assert_eq!(is_enough(&a, &right, &a), expected, "{pixels}");
        }
    }

    #[test]
    fn pixels_against_it_count() {
        let (right, made) = (row(1000, 0), row(1000, 1000));
        assert!(!is_enough(&row(1000, 500), &right, &made));
        // √(1000 ln(1024/0.05)/2) = 70.45 more than half.
        assert!(!is_enough(&row(1000, 570), &right, &made));
        assert!(is_enough(&row(1000, 571), &right, &made));
    }
}
