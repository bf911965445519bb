//! A picture and its heat map, small enough to stand in a page.

use std::io;

use crate::film::{self, Film, Tolerance};

/// The longer side of a thumbnail, in pixels.
const LONGEST: u32 = 320;

/// A picture and its heat map, as `data:` URIs.
pub struct Thumbnails {
    pub picture: String,
    pub heat: String,
}

impl Thumbnails {
    /// Of a picture and the exact one.
    pub fn new(film: &Film, exact: &Film, tolerance: Tolerance) -> io::Result<Self> {
        let heat = film::heat_map(film, exact, tolerance).map_err(io::Error::other)?;
        Ok(Self {
            picture: data(film)?,
            heat: data(&heat)?,
        })
    }
}

/// A picture as a `data:` URI, of some pixels' means where it is large.
fn data(film: &Film) -> io::Result<String> {
    let small = film::reduced(film, [LONGEST; 2]).map_err(io::Error::other)?;
    film::data_uri(&small)
}
