//! Right pictures in a file that could tell more of them than it does: of 8 bits in 16, or whose 16 bits are cut off.

use super::{Case, Verdict, evidence::FEWEST, explained_share, noise};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    film::{Film, rmse},
};

/// How a channel's number was made of its colour, 0 to 1.
struct Way {
    mistake: &'static str,
    message: &'static str,
    help: &'static str,
    /// The number of the last one, of which the first is 0.
    last: f64,
    /// How much of the right number they are all together.
    part: f64,
    /// How far it may be off, in steps from one number to the next.
    off: [f64; 2],
}

/// 257 of them are a step of 8 bits, and 65 535 white.
const FINE: f64 = 65_535.0;

const WAYS: [Way; 3] = [
    Way {
        mistake: "rounded",
        message: "the picture is right, rounded to 8 bits: each channel is one of the 256 numbers of a byte, though finer ones are compared",
        help: "nothing is wrong with the scene or the camera: `--tolerance 0.5` lets 8 bits pass; a file of 16 bits is to hold round(65535 c) of each \
               colour c",
        last: 255.0,
        part: 1.0,
        off: [-0.5, 0.5],
    },
    Way {
        mistake: "rounded",
        message: "8 bits were made 16 by a shift: each channel is 256 times a byte where it should be 257 times that, so that white is 65280 \
                  of 65535",
        help: "a file of 16 bits is to hold round(65535 c) of each colour c; a byte b is 257 b there",
        last: 255.0,
        part: 256.0 / 257.0,
        off: [-0.5, 0.5],
    },
    Way {
        mistake: "truncated",
        message: "the 16 bits of each channel are cut off instead of rounded, as int(65535 c) does: they are too dark by up to a step",
        help: "a channel's number is round(65535 c), which is floor(65535 c + 0.5), of its encoded colour c",
        last: FINE,
        part: 1.0,
        off: [-1.0, 0.0],
    },
];

/// Room for light that was rounded, in steps.
const SLACK: f64 = 0.01;

/// A number of a file, decoded and encoded, is a whole one of its numbers but for this share of white.
const WHOLE: f64 = 1e-8;

impl Way {
    /// How far a channel is off, in steps, if it may have been made in this way.
    fn off(&self, is: f64, should: f64) -> Option<f64> {
        let number = self.last / self.part * linear_to_srgb(is);
        let off = number.round() - self.last * linear_to_srgb(should);
        let is_whole = (number - number.round()).abs() <= WHOLE * self.last;
        let [least, most] = self.off;
        (is_whole && (least - SLACK..=most + SLACK).contains(&off)).then_some(off)
    }

    /// The picture without what rounding does, if it was made in this way and enough pixels tell of it.
    fn made(&self, case: &Case) -> Option<Film> {
        let (a, exact) = (&case.full.a, &case.full.exact);
        let mut telling = 0;
        let pixels = a.pixels().iter().zip(exact.pixels());
        for ((p, q), variance) in pixels.zip(case.variance.pixels()) {
            let mut is_off = false;
            for i in 0..3 {
                // Where the right number is no whole one, it is no chance that this one is.
                is_off |= self.off(p[i], q[i])?.abs() > SLACK;
            }
            telling += u64::from(is_off && !noise::is_flat(variance));
        }
        let [least, most] = self.off;
        let middle = 0.5 * (least + most) / self.last;
        let light = |light: f64| {
            let color = self.part * (linear_to_srgb(light) + middle).max(0.0);
            srgb_to_linear(color)
        };
        let made = Film::from_fn(a.width(), a.height(), |x, y| exact.pixel(x, y).map(light));
        made.ok().filter(|_| telling >= FEWEST)
    }
}

/// What is said of a right picture whose numbers are fewer than those of its file.
pub fn verdict(case: &Case) -> Option<Verdict> {
    WAYS.iter().find_map(|way| {
        let left = rmse(&case.full.a, &way.made(case)?);
        let is_right = way.part == 1.0 && way.mistake == "rounded";
        Some(Verdict {
            mistake: way.mistake,
            message: way.message.to_owned(),
            help: way.help.to_owned(),
            rmse: Some(if is_right { case.difference } else { left }),
            explains: (!is_right).then(|| explained_share(left, case.difference)),
            off: None,
        })
    })
}
