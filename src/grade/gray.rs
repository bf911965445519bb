//! Pictures without colours: gray, where the right one has colours.

use super::{Idea, Make, evidence::FEWEST};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    film::{Film, TooLarge, rmse},
};

/// Channels that are apart by more than this make a colour, in steps of 8-bit sRGB: gray light is the same in all of them but for roundings.
const APART: f64 = 1.0;

/// A way to make one number of a colour's three.
#[derive(Clone, Copy)]
struct Way {
    weights: [f64; 3],
    /// Whether it is made of the encoded numbers, not of the light.
    is_encoded: bool,
    what: &'static str,
}

/// The weights of Rec. 709, whose primaries are those of sRGB; those of Rec. 601, of which programs make gray bytes; and none.
const WAYS: [Way; 5] = [
    Way {
        weights: [0.2126, 0.7152, 0.0722],
        is_encoded: false,
        what: "the luminance of its light",
    },
    Way {
        weights: [0.299, 0.587, 0.114],
        is_encoded: true,
        what: "0.299 R + 0.587 G + 0.114 B of its encoded colour",
    },
    Way {
        weights: [1.0 / 3.0; 3],
        is_encoded: true,
        what: "the mean of its encoded colour's channels",
    },
    Way {
        weights: [1.0 / 3.0; 3],
        is_encoded: false,
        what: "the mean of its light's channels",
    },
    Way {
        weights: [0.2126, 0.7152, 0.0722],
        is_encoded: true,
        what: "0.2126 R + 0.7152 G + 0.0722 B of its encoded colour",
    },
];

impl Way {
    fn gray(&self, light: [f64; 3]) -> f64 {
        let sum = |numbers: [f64; 3]| -> f64 {
            let products = numbers.into_iter().zip(self.weights);
            products.map(|(number, weight)| number * weight).sum()
        };
        match self.is_encoded {
            true => srgb_to_linear(sum(light.map(linear_to_srgb))),
            false => sum(light),
        }
    }

    fn done(&self, film: &Film) -> Result<Film, TooLarge> {
        Film::from_fn(film.width(), film.height(), |x, y| {
            [self.gray(film.pixel(x, y)); 3]
        })
    }
}

/// The way in which a gray picture may have been made of one with colours: the one that leaves least.
pub fn ideas(a: &Film, right: &Film) -> Result<Vec<Idea>, TooLarge> {
    let colored = right.pixels().iter().filter(|light| !is_gray(light));
    if (colored.count() as u64) < FEWEST || !a.pixels().iter().all(is_gray) {
        return Ok(Vec::new());
    }
    let mut nearest: Option<(f64, Way)> = None;
    for way in WAYS {
        let left = rmse(a, &way.done(right)?);
        if nearest.is_none_or(|(least, _)| left < least) {
            nearest = Some((left, way));
        }
    }
    let idea = |(_, way): (f64, Way)| {
        Idea {
        mistake: "gray",
        message: format!("the picture is gray: each pixel has {} in place of a colour", way.what),
        help: "write the three channels, red, green and blue, of each pixel, into a file that has three".to_owned(),
        make: Make::Film(Box::new(move |film| way.done(film))),
    }
    };
    Ok(nearest.map(idea).into_iter().collect())
}

fn is_gray(light: &[f64; 3]) -> bool {
    let [red, green, blue] = light.map(|light| 255.0 * linear_to_srgb(light));
    red.max(green).max(blue) - red.min(green).min(blue) <= APART
}
