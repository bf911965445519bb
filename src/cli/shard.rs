//! `--shard I/N`: one of several bands of rows that a picture is divided into, so that several
//! machines can render it.

use std::{fmt, str::FromStr};

use crate::area::Area;

/// One of the bands of rows into which a picture is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number of the band, from 1.
    number: u32,
    /// Number of all bands.
    count: u32,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/');
        let numbers = numbers.map(|(number, count)| (number.parse(), count.parse()));
        match numbers {
            Some((Ok(number), Ok(count))) if (1..=count).contains(&number) => {
                Ok(Self { number, count })
            }
            _ => Err("write I/N with I from 1 to N, such as 3/8 for the third of eight".to_owned()),
        }
    }
}

impl Shard {
    /// Returns the band of a picture with the area `whole`; `None` if the picture has fewer rows
    /// than there are bands. The heights of bands differ by at most one row.
    pub fn band(self, whole: Area) -> Option<Area> {
        let start = |number: u32| {
            let rows = u64::from(whole.height) * u64::from(number);
            (rows / u64::from(self.count)) as u32
        };
        let (top, end) = (start(self.number - 1), start(self.number));
        (self.count <= whole.height).then(|| Area {
            y: whole.y + top,
            height: end - top,
            ..whole
        })
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}
