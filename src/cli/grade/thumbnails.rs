//! The pictures of a student on the HTML page: thumbnails, which are embedded in it, and full
//! pictures, which are files beside it.

use std::io;

use crate::film::{self, Film, Tolerance};

/// Maximum width and height of a thumbnail, in pixels. A larger picture is reduced. The page shows
/// thumbnails 160 CSS pixels wide. With twice as many picture pixels, they are sharp on screens
/// with two pixels per CSS pixel.
const LONGEST: u32 = 320;

/// The pictures of a student that the HTML page shows.
pub struct Pictures {
    /// Thumbnails of the student's picture and of the heat map that shows its differences from the
    /// exact picture, as `data:` URIs.
    pub thumbnails: [String; 2],
    /// The student's picture and the heat map that shows its differences from the exact picture, as
    /// PNG files.
    pub whole: [Vec<u8>; 2],
    /// The exact picture of the part of the scene that the student's picture shows, as a PNG file.
    /// `None` if the picture shows the whole scene.
    pub exact: Option<Vec<u8>>,
}

impl Pictures {
    /// Makes the pictures. `film` is the student's picture, and `exact` the exact picture of the
    /// same part of the scene.
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

/// Encodes a picture as a `data:` URI. A large picture is reduced first, by averaging blocks of
/// pixels.
fn data(film: &Film) -> io::Result<String> {
    let small = film::reduced(film, [LONGEST; 2]).map_err(io::Error::other)?;
    film::data_uri(&small)
}

/// Encodes a picture as a PNG file.
pub fn png(film: &Film) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    film::write_png(film, None, &mut bytes)?;
    Ok(bytes)
}
