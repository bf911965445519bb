//! How closely a board is looked at where roundings leave something in doubt.

use glam::DVec2;

use super::board::{UNIT, measure};

/// A sum with no greater bound than this is good enough for a pixel in which there are several.
pub(super) const FINE: f64 = 1e-12;

/// How closely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Care {
    /// As is enough for nearly all pixels.
    Usual,
    /// Of a pixel in which so many regions show squares without number that what is neglected of each is too much together.
    Many,
    /// Of a pixel with so few squares that its mean must be known well, which it is not with the usual care.
    Great,
}

impl Care {
    /// What a polygon may be off by.
    pub fn enough(self, polygon: &[DVec2]) -> f64 {
        match self {
            Self::Usual | Self::Many => FINE,
            // All polygons of a pixel together by half as much as that; and each by a few roundings, which nothing spares it.
            Self::Great => {
                let (area, _) = measure(polygon.iter().copied());
                (0.5 * FINE * area.abs()).max(4.0 * UNIT)
            }
        }
    }

    /// Whether long and narrow polygons are cut in halves, which takes less time than to look at all sides by all lines.
    pub fn cuts_long_ones(self) -> bool {
        self == Self::Great
    }

    /// By what part of the usual as much may be neglected.
    pub fn part_neglected(self) -> f64 {
        match self {
            Self::Usual | Self::Great => 1.0,
            Self::Many => 1.0 / 64.0,
        }
    }

    /// How many sides of strips by lines of the board may be looked at, one after the other, some dozens to a microsecond. The greater number is
    /// enough for any polygon that is not crowded.
    pub fn patience(self) -> f64 {
        match self {
            Self::Usual | Self::Many => 8e4,
            Self::Great => 4e6,
        }
    }
}
