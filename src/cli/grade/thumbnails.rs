//! The pictures of a student for the HTML page: embedded thumbnails, and full pictures beside the
//! page.

use std::io;

use crate::film::{self, Film, Tolerance};

/// Maximum side of a thumbnail, in pixels. A larger picture is reduced.
const LONGEST: u32 = 320;

/// The pictures of a student that the HTML page shows.
pub struct Pictures {
    /// Thumbnails of the picture and its heat map, as `data:` URIs.
    pub thumbnails: [String; 2],
    /// The picture and its heat map, as PNG files.
    pub whole: [Vec<u8>; 2],
    /// The exact picture of the part of the scene that the student's picture shows, as a PNG file.
    /// `None` if that part is the whole scene.
    pub exact: Option<Vec<u8>>,
}

impl Pictures {
    /// Makes the pictures from a student's film and the exact film of the same part of the scene.
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

/// Encodes a picture as a `data:` URI. A large picture is first reduced to the means of blocks of
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
