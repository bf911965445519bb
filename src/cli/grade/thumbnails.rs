//! A picture, and where it differs from the exact one: small ones that stand in a page, and whole
//! ones beside it.

use std::io;

use crate::film::{self, Film, Tolerance};

/// The longer side of a thumbnail, in pixels.
const LONGEST: u32 = 320;

/// What a page shows of a picture.
pub struct Pictures {
    /// The picture and its heat map, as `data:` URIs.
    pub thumbnails: [String; 2],
    /// The same as files.
    pub whole: [Vec<u8>; 2],
    /// The exact one, where it is another than that of the whole scene.
    pub exact: Option<Vec<u8>>,
}

impl Pictures {
    /// Of a picture and the exact one.
    pub fn new(
        film: &Film,
        exact: &Film,
        tolerance: Tolerance,
        is_whole: bool,
    ) -> io::Result<Self> {
        let heat = film::heat_map(film, exact, tolerance).map_err(io::Error::other)?;
        Ok(Self {
            thumbnails: [data(film)?, data(&heat)?],
            whole: [png(film)?, png(&heat)?],
            exact: if is_whole { None } else { Some(png(exact)?) },
        })
    }
}

/// A picture as a `data:` URI, of some pixels' means where it is large.
fn data(film: &Film) -> io::Result<String> {
    let small = film::reduced(film, [LONGEST; 2]).map_err(io::Error::other)?;
    film::data_uri(&small)
}

/// A picture as a file.
pub fn png(film: &Film) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    film::write_png(film, None, &mut bytes)?;
    Ok(bytes)
}
