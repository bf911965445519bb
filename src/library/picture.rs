//! Pictures in memory.

use std::{io, path::Path, sync::Arc};

use super::Error;
use crate::{
    area::Area,
    cancel,
    files::{self, Purpose},
    film::{self, AsBytes, Encoder, Film, Jpeg, Recipe},
    source::Sources,
};

/// A picture in memory. It was rendered, or read from a file that any program may have written.
///
/// ```
/// let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }")?;
/// let picture = scene.with_set("image.width=80")?.with_set("image.height=45")?.render()?;
/// assert_eq!((picture.width(), picture.height()), (80, 45));
/// assert_eq!(picture.to_rgb8().len(), 80 * 45 * 3);
/// assert_eq!(picture.pixels()[0], [0.0; 3]); // black in the top left corner
/// # Ok::<(), pinhole::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Picture {
    pub(super) content: Content,
    /// The text of the scene that the picture shows, and its settings in the form of `--set`.
    /// `None` if they are unknown.
    pub(super) sources: Option<Arc<Sources>>,
}

/// The pixels of a picture, by their origin.
#[derive(Clone, Debug)]
pub(super) enum Content {
    /// Pixels that were rendered.
    Rendered(Film),
    /// Pixels that were read from a file.
    Read(Box<FromFile>),
}

/// A picture that was read from a file, with the file's compression.
#[derive(Clone, Debug)]
pub(super) struct FromFile {
    pub(super) picture: film::Picture,
    /// Compression of the file; `None` unless it is a JPEG or a lossy WebP.
    pub(super) jpeg: Option<Jpeg>,
}

impl Picture {
    /// Makes a picture from pixels that were rendered, and the sources of their scene.
    pub(super) fn rendered(film: Film, sources: &Arc<Sources>) -> Self {
        Self {
            content: Content::Rendered(film),
            sources: Some(Arc::clone(sources)),
        }
    }

    /// Returns the number of columns of pixels.
    pub fn width(&self) -> u32 {
        self.film().width()
    }

    /// Returns the number of rows of pixels.
    pub fn height(&self) -> u32 {
        self.film().height()
    }

    /// Returns the pixels, row by row from the top. Each has the means of red, green and blue, in
    /// linear light from 0 to 1.
    pub fn pixels(&self) -> &[[f64; 3]] {
        self.film().pixels()
    }

    /// Returns the pixels as [`pixels`](Self::pixels) does, without copying them.
    pub fn into_pixels(self) -> Vec<[f64; 3]> {
        match self.content {
            Content::Rendered(film) => film.into_pixels(),
            Content::Read(file) => file.picture.film.into_pixels(),
        }
    }

    /// Returns the bytes of red, green and blue of each pixel, row by row from the top, in sRGB. A
    /// PNG file contains the same bytes.
    pub fn to_rgb8(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        AsBytes::bytes(self.pixels(), &Encoder::default(), &mut bytes);
        bytes
    }

    /// Returns the pixels as a [`Film`], the type that other modules work with.
    pub fn film(&self) -> &Film {
        match &self.content {
            Content::Rendered(film) => film,
            Content::Read(file) => &file.picture.film,
        }
    }

    /// Returns the root mean square of the differences between two pictures, over all pixels and
    /// channels. It is in linear light and from 0 to 1.
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

    /// Writes the picture to a file, completely or not at all. The path's extension selects the
    /// format: `.png` for 8-bit sRGB, with the scene's text in the file, or `.exr` for linear
    /// light in floats. The program `pinhole` writes the same bytes.
    ///
    /// ```
    /// # let folder = tempfile::tempdir().unwrap();
    /// # let path = folder.path().join("a.png");
    /// # let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }
    /// #     checkerboard {}  image { width 40  height 30 }")?;
    /// scene.render()?.save(&path)?;
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The path has another extension, or the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let ending = path.extension().unwrap_or_default();
        let written = if ending.eq_ignore_ascii_case("png") {
            files::write(path, Purpose::Named, &cancel::NEVER, |out| {
                film::write_png(self.film(), self.recipe().as_ref(), out)
            })
        } else if ending.eq_ignore_ascii_case("exr") {
            let whole = Area::whole(self.width(), self.height());
            files::write(path, Purpose::Named, &cancel::NEVER, |out| {
                film::write_exr(self.film(), whole, whole, out)
            })
        } else {
            let message = "a picture's file ends in .png or .exr";
            Err(io::Error::new(io::ErrorKind::InvalidInput, message))
        };
        written.map_err(|error| Error::Write {
            path: path.to_owned(),
            error,
        })
    }

    /// Returns the scene's text and its settings (as of `--set`) in the form in which a PNG stores
    /// them. Returns `None` if they are unknown.
    fn recipe(&self) -> Option<Recipe> {
        let sources = self.sources.as_ref()?;
        let crop = match &self.content {
            Content::Rendered(_) => None,
            Content::Read(file) => file.picture.crop,
        };
        Some(Recipe {
            scene: sources.file.text().to_owned(),
            overrides: sources
                .sets
                .iter()
                .map(|set| set.text().to_owned())
                .collect(),
            crop,
        })
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
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Exact {
    /// Mean colour of each pixel, without sampling noise.
    pub picture: Picture,
    /// Error bound of each pixel, row by row: how far the mean of a channel may be from its true
    /// value, in linear light.
    pub bounds: Vec<f32>,
}

impl Exact {
    /// Returns the greatest of the error bounds of all pixels.
    pub fn bound(&self) -> f64 {
        f64::from(self.bounds.iter().copied().fold(0.0, f32::max))
    }
}
