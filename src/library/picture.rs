//! Pictures in memory.

use std::{fmt, sync::Arc};

use super::Error;
use crate::{
    color::Color,
    film::{self, AsBytes, Encoder, Film, Rounding},
    source::Sources,
};

/// A picture in memory. It was rendered, read from a file that any program may have written, or
/// made from pixels.
///
/// ```
/// let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }")?;
/// let picture = scene.with_set("image.width=80")?.with_set("image.height=45")?.render()?;
/// assert_eq!((picture.width(), picture.height()), (80, 45));
/// assert_eq!(picture.to_rgb8().len(), 80 * 45 * 3);
/// assert_eq!(picture.pixels()[0], [0.0; 3]); // black in the top left corner
/// # Ok::<(), pinhole::Error>(())
/// ```
#[derive(Clone, PartialEq)]
pub struct Picture {
    /// The pixels, and properties of the file from which they were read, such as its precision.
    pub(super) coded: film::Picture,
    /// Compression of the file; `None` unless it is a JPEG or a lossy WebP.
    #[cfg(feature = "read")]
    pub(super) jpeg: Option<film::Jpeg>,
    /// The text of the scene that the picture shows, and its settings in the form of `--set`.
    /// `None` if they are unknown.
    pub(super) sources: Option<Arc<Sources>>,
}

impl Picture {
    /// Makes a picture from pixels that were rendered, and the sources of their scene.
    pub(super) fn rendered(film: Film, sources: &Arc<Sources>) -> Self {
        let coded = film::Picture::new(film, Rounding::Float);
        Self::of(coded, Some(Arc::clone(sources)))
    }

    fn of(coded: film::Picture, sources: Option<Arc<Sources>>) -> Self {
        Self {
            coded,
            #[cfg(feature = "read")]
            jpeg: None,
            sources,
        }
    }

    /// Makes a picture from pixels of another program, row by row from the top, in linear light
    /// from 0 to 1. When the picture is graded, the pixels are assumed to be rounded to 32-bit
    /// floats. For pixels of 8-bit files, use [`from_rgb8`](Self::from_rgb8).
    ///
    /// ```
    /// use pinhole::{Picture, Scene};
    ///
    /// let gray = Picture::from_pixels(80, 45, vec![[0.2; 3]; 80 * 45])?;
    /// # let scene = Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }
    /// #     checkerboard {}  image { width 80  height 45 }")?;
    /// assert!(gray.rmse(&scene.render()?)? > 0.1);
    /// assert!(Picture::from_pixels(80, 44, gray.into_pixels()).is_err());
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The number of pixels is not `width` · `height`, or is 0.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<[f64; 3]>) -> Result<Self, Error> {
        Ok(Film::from_pixels(width, height, pixels)?.into())
    }

    /// Makes a picture from the bytes of red, green and blue of each pixel, row by row from the
    /// top, in sRGB. [`to_rgb8`](Self::to_rgb8) returns the same bytes.
    ///
    /// ```
    /// use pinhole::Picture;
    ///
    /// let picture = Picture::from_rgb8(2, 1, &[0, 0, 0, 255, 165, 0])?;
    /// assert_eq!(picture.pixels()[0], [0.0; 3]);
    /// assert_eq!(picture.to_rgb8(), [0, 0, 0, 255, 165, 0]);
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The number of bytes is not 3 · `width` · `height`, or is 0.
    pub fn from_rgb8(width: u32, height: u32, bytes: &[u8]) -> Result<Self, Error> {
        let (colors, rest) = bytes.as_chunks::<3>();
        // If there are one or two bytes at the end, a further pixel is added, so that the number of
        // pixels is wrong and an error is returned.
        let colors = colors.iter().copied().chain(rest.first().map(|_| [0; 3]));
        let light = colors.map(|color| Color::from_bytes(color).to_linear());
        let film = Film::from_pixels(width, height, light.collect())?;
        Ok(Self::of(film::Picture::new(film, Rounding::Byte), None))
    }

    /// Returns the number of columns of pixels.
    pub fn width(&self) -> u32 {
        self.film().width()
    }

    /// Returns the number of rows of pixels.
    pub fn height(&self) -> u32 {
        self.film().height()
    }

    /// Returns the pixels, row by row from the top. Each pixel consists of the means of red, green
    /// and blue, in linear light from 0 to 1.
    pub fn pixels(&self) -> &[[f64; 3]] {
        self.film().pixels()
    }

    /// Returns the means of red, green and blue of the pixel in column `x` and row `y`, in linear
    /// light.
    ///
    /// # Panics
    ///
    /// The column or the row is outside of the picture.
    pub fn pixel(&self, x: u32, y: u32) -> [f64; 3] {
        self.film().pixel(x, y)
    }

    /// Returns the pixels as [`pixels`](Self::pixels) does, without copying them.
    pub fn into_pixels(self) -> Vec<[f64; 3]> {
        self.coded.film.into_pixels()
    }

    /// Returns the bytes of red, green and blue of each pixel, row by row from the top, in sRGB. A
    /// PNG file contains the same bytes.
    pub fn to_rgb8(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        AsBytes::bytes(self.pixels(), Encoder::shared(), &mut bytes);
        bytes
    }

    /// Returns the text and the settings of the scene that the picture shows. Returns `None` if
    /// they are unknown, i.e. if the picture was made from pixels, or read from a file that does
    /// not contain them.
    pub fn sources(&self) -> Option<&Sources> {
        self.sources.as_deref()
    }

    /// Returns the pixels as a [`Film`], the type that other modules work with.
    pub fn film(&self) -> &Film {
        &self.coded.film
    }

    /// Returns the root mean square of the differences between two pictures, over all pixels and
    /// channels, in linear light. It is NaN if a value of a pixel is NaN.
    ///
    /// ```
    /// # let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }
    /// #     checkerboard {}  image { width 40  height 30 }")?;
    /// let exact = scene.render_exact()?.picture;
    /// let few = scene.with_set("sampler.per_pixel=4")?.render()?;
    /// let many = scene.with_set("sampler.per_pixel=64")?.render()?;
    /// assert!(many.rmse(&exact)? < few.rmse(&exact)?);
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The sizes of the pictures differ.
    pub fn rmse(&self, other: &Self) -> Result<f64, Error> {
        Ok(film::rmse(self.film(), other.film())?)
    }
}

/// Writes the size, without the pixels.
impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Picture {{ {} × {}, .. }}", self.width(), self.height())
    }
}

/// Makes a picture of the film's pixels. The picture's scene is unknown.
impl From<Film> for Picture {
    fn from(film: Film) -> Self {
        Self::of(film::Picture::new(film, Rounding::Float), None)
    }
}

/// A picture that was computed without samples, with a bound on the error of each pixel.
///
/// ```
/// # let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }
/// #     checkerboard {}  image { width 40  height 30 }")?;
/// let exact = scene.render_exact()?;
/// assert_eq!(exact.bounds.len(), exact.picture.pixels().len());
/// assert!(exact.bounds.iter().all(|&bound| bound < 1e-9));
/// # Ok::<(), pinhole::Error>(())
/// ```
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub struct Exact {
    /// Mean colour of each pixel, without sampling noise.
    pub picture: Picture,
    /// Error bound of each pixel, row by row: how far the mean of a channel may be from its true
    /// value, in linear light.
    pub bounds: Vec<f32>,
}

/// Writes the picture's size and the greatest error bound.
impl fmt::Debug for Exact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = f.debug_struct("Exact");
        fields.field("picture", &self.picture);
        fields.field("bound", &self.bound()).finish_non_exhaustive()
    }
}

impl Exact {
    /// Returns the greatest of the error bounds of all pixels.
    pub fn bound(&self) -> f64 {
        f64::from(self.bounds.iter().copied().fold(0.0, f32::max))
    }
}
