//! Pictures in memory.

use std::sync::Arc;

use super::Error;
use crate::{
    film::{self, AsBytes, Encoder, Film, Rounding},
    source::Sources,
};

/// A picture in memory: one that was rendered, or one of any program that was read from a file.
///
/// ```
/// let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }")?;
/// let picture = scene.with_set("image.width=80")?.with_set("image.height=45")?.render()?;
/// assert_eq!((picture.width(), picture.height()), (80, 45));
/// assert_eq!(picture.to_rgb8().len(), 80 * 45 * 3);
/// assert_eq!(picture.pixels()[0], [0.0; 3]); // black in the top left corner
/// # Ok::<(), pinhole::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The pixels, and how a file of them is coded.
    pub(super) coded: film::Picture,
    /// The coding of a JPEG file.
    #[cfg(feature = "read")]
    pub(super) jpeg: Option<film::Jpeg>,
    /// The scene's text and its settings, if they are known.
    pub(super) sources: Option<Arc<Sources>>,
}

impl Picture {
    /// Makes a picture of a film that was rendered of a scene.
    pub(super) fn rendered(film: Film, sources: &Arc<Sources>) -> Self {
        Self {
            coded: film::Picture::new(film, Rounding::Float),
            #[cfg(feature = "read")]
            jpeg: None,
            sources: Some(Arc::clone(sources)),
        }
    }

    /// Returns the number of columns.
    pub fn width(&self) -> u32 {
        self.film().width()
    }

    /// Returns the number of rows.
    pub fn height(&self) -> u32 {
        self.film().height()
    }

    /// Returns the means of red, green and blue of each pixel, row by row from the top, in linear
    /// light from 0 to 1.
    pub fn pixels(&self) -> &[[f64; 3]] {
        self.film().pixels()
    }

    /// Returns the same means without copying them.
    pub fn into_pixels(self) -> Vec<[f64; 3]> {
        self.coded.film.into_pixels()
    }

    /// Returns the bytes of red, green and blue of each pixel, row by row from the top, as sRGB:
    /// those that a PNG file has.
    pub fn to_rgb8(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        AsBytes::bytes(self.pixels(), &Encoder::default(), &mut bytes);
        bytes
    }

    /// Returns the text and the settings of the scene that the picture shows, if they are known: of
    /// a picture that was rendered, and of a PNG that carries them.
    pub fn sources(&self) -> Option<&Sources> {
        self.sources.as_deref()
    }

    /// Returns the film, which the stages work with.
    pub fn film(&self) -> &Film {
        &self.coded.film
    }

    /// Returns the root mean square of the differences to another picture over all pixels and
    /// channels, in linear light from 0 to 1.
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
    /// The sizes differ.
    pub fn rmse(&self, other: &Self) -> Result<f64, Error> {
        Ok(film::rmse(self.film(), other.film())?)
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
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Exact {
    /// The means.
    pub picture: Picture,
    /// For each pixel, row by row, how far a channel's mean in linear light may be from the true
    /// one.
    pub bounds: Vec<f32>,
}

impl Exact {
    /// Returns the greatest bound.
    pub fn bound(&self) -> f64 {
        f64::from(self.bounds.iter().copied().fold(0.0, f32::max))
    }
}
